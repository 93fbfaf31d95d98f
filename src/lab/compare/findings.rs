//! What was found, as sentences: the most important first.

use glam::DVec3;

use super::alignment::{Alignment, Frame};
use super::corner_orders::CornerOrder;
use super::explanations::{Explanation, InsideRule, Rule};
use super::matching::Farthest;
use super::net_mistakes::NetMistake;
use super::spaces::{Space, SpaceKind};
use geometry::numbers::{exact, grouped, short};
use geometry::tessellate::{Convention, Displacement, Partitioning, Tessellation};
use inspect::settings::Choice;

/// Something about another program's tessellation that isn't as ours.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// Most of it isn't near the surface.
    NotATessellation {
        far: u64,
        vertices: u64,
        distance: f64,
    },
    /// All coordinates are turned, mirrored, scaled or moved, or in another space.
    Aligned(Frame),
    /// Vertices lie on another of our surfaces.
    OtherSurface {
        ours: Tessellation,
        theirs: Tessellation,
        vertices: u64,
        of: u64,
    },
    /// Vertices lie where a mistake in control points puts them.
    OtherNets {
        mistake: NetMistake,
        vertices: u64,
        of: u64,
    },
    /// All vertices are off the surface.
    Displaced(Displaced),
    /// A few vertices aren't where ours are.
    Moved {
        vertices: u64,
        farthest: DVec3,
        distance: f64,
        triangle: u32,
    },
    /// One change of the factors gives their points: the first of these, or any of the others.
    Factors {
        ours: Partitioning,
        convention: Convention,
        explanations: Vec<Explanation>,
        patches: u64,
        of: u64,
    },
    /// No change that is known gives their points.
    UnknownFactors {
        patches: u64,
        of: u64,
        sides: u64,
        inside: u64,
        suits: Vec<Partitioning>,
        ours: Partitioning,
        /// Whether LOD gives other factors for another view.
        is_of_view: bool,
    },
    /// Edges whose sides they cut differently.
    Cracked {
        edges: u64,
        of: u64,
    },
    /// Patches without triangles of theirs, though we emit some.
    MissingPatches {
        patches: u64,
        of: u64,
        triangles: Vec<u32>,
    },
    /// Patches with triangles of theirs, though we emit none.
    AdditionalPatches {
        patches: u64,
        triangles: Vec<u32>,
    },
    MissingTriangles {
        count: u64,
        patches: u64,
    },
    Doubled {
        count: u64,
        patches: u64,
    },
    Flipped {
        count: u64,
        of: u64,
    },
    /// The same points, but other triangles between them.
    OtherTriangles {
        count: u64,
        patches: u64,
        order: Option<CornerOrder>,
    },
    NotFinite {
        count: u64,
    },
    /// Our pattern starts at another corner, which changes nothing but the last bits of points inside.
    Convention {
        ours: Convention,
        theirs: Convention,
    },
    /// Coordinates are rounded to 16-bit floating-point numbers, and so farther from ours than is allowed.
    HalfFloats {
        distance: f64,
        ulps: f64,
    },
    /// Nothing but distances that are larger than those allowed.
    Rounding {
        farthest: Farthest,
        ulps: f64,
        triangle: u32,
    },
}

/// How vertices lie off the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Displaced {
    pub vertices: u64,
    pub of: u64,
    /// The largest distance, in object units.
    pub largest: f64,
    /// How far outward and inward they are along our normals, in object units.
    pub outward: f64,
    pub inward: f64,
    /// Whether they are moved along our normals.
    pub is_along_normals: bool,
    /// Our own displacement.
    pub ours: Displacement,
}

impl Finding {
    /// Whether it names points or triangles of patches that have as many points as ours.
    pub(super) fn is_about_few_points(&self) -> bool {
        matches!(self, Self::Moved { .. } | Self::OtherTriangles { .. })
    }

    /// What it is, as one word for programs.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::NotATessellation { .. } => "not_a_tessellation",
            Self::Aligned(_) => "coordinates",
            Self::OtherSurface { .. } => "surface",
            Self::OtherNets { .. } => "control_points",
            Self::Displaced(_) => "displaced",
            Self::Moved { .. } => "moved_vertices",
            Self::Factors { ours, explanations, .. } => match explanations.first() {
                Some(Explanation { rule: Rule::Sides(_), .. }) => "order_of_factors",
                Some(first) if first.partitioning != *ours => "partitioning",
                _ => "factors",
            },
            Self::UnknownFactors { .. } => "factors",
            Self::Cracked { .. } => "cracks",
            Self::MissingPatches { .. } => "missing_patches",
            Self::AdditionalPatches { .. } => "additional_patches",
            Self::MissingTriangles { .. } => "missing_triangles",
            Self::Doubled { .. } => "doubled_triangles",
            Self::Flipped { .. } => "winding",
            Self::OtherTriangles { .. } => "diagonals",
            Self::NotFinite { .. } => "not_finite",
            Self::Convention { .. } => "convention",
            Self::HalfFloats { .. } | Self::Rounding { .. } => "rounding",
        }
    }

    /// Whether it only says how coordinates are meant.
    pub(super) fn is_about_coordinates(&self) -> bool {
        matches!(self, Self::Aligned(_))
    }

    /// What it is, in a sentence or two.
    pub fn text(&self) -> String {
        match self {
            Self::NotATessellation { far, vertices, distance } => other_mesh_text(*far, *vertices, *distance),
            Self::Aligned(Frame::Axes(alignment)) => alignment_text(alignment),
            Self::Aligned(Frame::Space(space)) => space_text(space),
            Self::OtherSurface { ours, theirs, vertices, of } => surface_text(ours, theirs, *vertices, *of),
            Self::OtherNets { mistake, vertices, of } => nets_text(*mistake, *vertices, *of),
            Self::Displaced(displaced) => displaced_text(displaced),
            Self::Moved { vertices, farthest, distance, triangle } => {
                moved_text(*vertices, *farthest, *distance, *triangle)
            }
            Self::Factors { ours, convention, explanations, patches, of } => {
                factors_text(*ours, *convention, explanations, *patches, *of)
            }
            Self::UnknownFactors { patches, of, sides, inside, suits, ours, is_of_view } => {
                let text = unknown_text([*patches, *of, *sides, *inside], suits, *ours);
                let view = " LOD depends on the view: the camera and --size must be the other program's, too.";
                text + if *is_of_view { view } else { "" }
            }
            Self::Cracked { edges, of } => cracked_text(*edges, *of),
            Self::MissingPatches { patches, of, triangles } => missing_text(*patches, *of, triangles),
            Self::AdditionalPatches { patches, triangles } => additional_text(*patches, triangles),
            Self::MissingTriangles { count, patches } => {
                format!("{} missing, in {}.", plural(*count, "triangle is", "triangles are"), patches_text(*patches))
            }
            Self::Doubled { count, patches } => {
                format!("{} more than once, in {}.", plural(*count, "triangle is there", "triangles are there"), patches_text(*patches))
            }
            Self::Flipped { count, of } if count == of => {
                "All triangles are wound the other way: exchange two corners of each, or turn the tessellator's output winding."
                    .to_owned()
            }
            Self::Flipped { count, of } => {
                format!("{} of {} triangles are wound the other way.", grouped(*count), grouped(*of))
            }
            Self::OtherTriangles { count, patches, order } => triangles_text(*count, *patches, *order),
            Self::NotFinite { count } => format!(
                "{} a coordinate that is NaN or infinite, and {} compared.",
                plural(*count, "triangle has", "triangles have"),
                if *count == 1 { "isn't" } else { "aren't" }
            ),
            Self::Convention { ours, theirs } => format!(
                "Everything agrees but the last bits of points inside of patches, which are those of --convention {}, and not of {}.",
                theirs.name(),
                ours.name()
            ),
            Self::HalfFloats { distance, ulps } => half_floats_text(*distance, *ulps),
            Self::Rounding { farthest, ulps, triangle } => rounding_text(farthest, *ulps, *triangle),
        }
    }
}

fn other_mesh_text(far: u64, vertices: u64, distance: f64) -> String {
    format!(
        "It isn't a tessellation of this mesh: {} of {} vertices are farther than {} object units from the surface.",
        grouped(far),
        grouped(vertices),
        short(distance)
    )
}

fn moved_text(vertices: u64, farthest: DVec3, distance: f64, triangle: u32) -> String {
    format!(
        "{} moved, by up to {} object units: the farthest at {}, in triangle {triangle}.",
        plural(vertices, "vertex is", "vertices are"),
        short(distance),
        point(farthest)
    )
}

fn cracked_text(edges: u64, of: u64) -> String {
    format!(
        "{} of {} edges between patches are cut differently by their sides, so the mesh cracks there.",
        grouped(edges),
        grouped(of)
    )
}

fn missing_text(patches: u64, of: u64, triangles: &[u32]) -> String {
    format!(
        "{} of {} patches {} no triangles: {}.",
        grouped(patches),
        grouped(of),
        if patches == 1 { "has" } else { "have" },
        listed(triangles, patches)
    )
}

fn additional_text(patches: u64, triangles: &[u32]) -> String {
    format!(
        "{} triangles, though our tessellation leaves {} out: {}.",
        plural(patches, "patch has", "patches have"),
        if patches == 1 { "it" } else { "them" },
        listed(triangles, patches)
    )
}

fn half_floats_text(distance: f64, ulps: f64) -> String {
    format!(
        "Its coordinates are rounded to 16-bit floating-point numbers, so that vertices are up to {} object units ({} ULP) away. \
         If that is as it should be, allow it with --within {}.",
        short(distance),
        short(ulps),
        rounded_up(distance)
    )
}

fn rounding_text(farthest: &Farthest, ulps: f64, triangle: u32) -> String {
    format!(
        "Everything agrees but the last digits: vertices differ by up to {} object units ({} ULP), at {} in triangle {triangle}. \
         If that is as it should be, allow it with --within {}.",
        short(farthest.distance),
        short(ulps),
        point(farthest.ours),
        rounded_up(farthest.distance)
    )
}

/// A number and its noun.
pub fn plural(count: u64, one: &str, more: &str) -> String {
    format!("{} {}", grouped(count), if count == 1 { one } else { more })
}

fn patches_text(patches: u64) -> String {
    plural(patches, "patch", "patches")
}

pub fn point(place: DVec3) -> String {
    let [x, y, z] = (place + DVec3::ZERO).to_array().map(|coordinate| exact(coordinate as f32));
    format!("({x}, {y}, {z})")
}

/// The least number of two digits that isn't smaller, so that it can be typed.
fn rounded_up(number: f64) -> String {
    let unit = 10.0_f64.powf(number.log10().floor() - 1.0);
    format!("{:.1e}", (number / unit - 1e-6).ceil() * unit)
}

/// Names triangles of the mesh, of which there are `count`.
fn listed(triangles: &[u32], count: u64) -> String {
    let names: Vec<String> = triangles.iter().map(u32::to_string).collect();
    let more = count - triangles.len() as u64;
    let noun = if count == 1 { "triangle" } else { "triangles" };
    if more == 0 {
        format!("{noun} {}", names.join(", "))
    } else {
        format!("{noun} {} and {more} more", names.join(", "))
    }
}

fn alignment_text(alignment: &Alignment) -> String {
    let Alignment { axes, scale, offset } = alignment;
    let mut parts = Vec::new();
    if alignment.turns() {
        let axis = |(axis, is_turned): &(usize, bool)| {
            format!("{}{}", if *is_turned { "-" } else { "" }, ["x", "y", "z"][*axis])
        };
        let doing = if alignment.mirrors() { "mirrored" } else { "turned" };
        parts.push(format!("{doing} (its x, y, z are our {})", axes.iter().map(axis).collect::<Vec<_>>().join(", ")));
    }
    if *scale != 1.0 {
        parts.push(format!("scaled ({} times ours)", exact(*scale as f32)));
    }
    if *offset != DVec3::ZERO {
        parts.push(format!("moved (by {})", point(*offset)));
    }
    let look = axes_hint(alignment).map_or(String::new(), |hint| format!(" {hint}"));
    format!("Its coordinates are {}.{look} All that follows is in our coordinates.", parts.join(" and "))
}

/// What usually turns or mirrors axes like this, in a sentence.
fn axes_hint(alignment: &Alignment) -> Option<&'static str> {
    let order = alignment.axes.map(|(axis, _)| axis);
    match (order, alignment.mirrors()) {
        _ if !alignment.turns() => None,
        ([0, 2, 1], false) => Some("Look at the axis that points up: one of the two has Y up, and the other Z up."),
        ([0, 2, 1], true) => Some("Look at the axis that points up and at the handedness: both differ."),
        ([0, 1, 2], true) => {
            Some("Look at the handedness: one of the two has left-handed coordinates, and the other right-handed ones.")
        }
        _ => Some("Look at the convention of axes with which the mesh is imported."),
    }
}

fn space_text(space: &Space) -> String {
    const WRITTEN: &str = "before they are written";
    let by_camera = "in clip space, by this camera's matrix";
    let (what, look) = match space.kind {
        SpaceKind::View => ("in view space, seen from this camera".to_owned(), "the view matrix is applied"),
        SpaceKind::Clip => (by_camera.to_owned(), "the view-projection matrix is applied"),
        SpaceKind::DividedClip => {
            (format!("{by_camera}, and divided by w"), "the view-projection matrix and the division by w are applied")
        }
        SpaceKind::Turned { axis, degrees, scale, offset, is_mirrored } => {
            (turned_text(axis, degrees, is_mirrored) + &moved_part(scale, offset), "a model matrix is applied")
        }
    };
    format!("Its coordinates are {what}. Look whether {look} {WRITTEN}. All that follows is in our coordinates.")
}

fn turned_text(axis: DVec3, degrees: f64, is_mirrored: bool) -> String {
    let [x, y, z] = axis.to_array().map(plain);
    let mirrored = if is_mirrored { "mirrored at the origin and " } else { "" };
    format!("{mirrored}turned by {} degrees about ({x}, {y}, {z})", short(degrees))
}

/// A number without what rounding leaves of 0.
fn plain(number: f64) -> String {
    short((number * 1e6).round() / 1e6)
}

fn moved_part(scale: f64, offset: DVec3) -> String {
    let mut text = String::new();
    if scale != 1.0 {
        text += &format!(", scaled ({} times ours)", short(scale));
    }
    if offset.length() > 1e-6 {
        let [x, y, z] = offset.to_array().map(plain);
        text += &format!(", moved by ({x}, {y}, {z})");
    }
    text
}

fn nets_text(mistake: NetMistake, vertices: u64, of: u64) -> String {
    let [what, look] = mistake.text();
    format!(
        "Its control points are others: {} of {} vertices are off our surface, and lie on one {what}. {look}",
        grouped(vertices),
        grouped(of)
    )
}

/// The option that gives a surface.
fn surface_option(tessellation: &Tessellation) -> String {
    let name = tessellation.surface.name();
    match tessellation.surface.is_phong() {
        true => format!("--surface {name} --alpha {}", tessellation.alpha),
        false => format!("--surface {name}"),
    }
}

fn surface_text(ours: &Tessellation, theirs: &Tessellation, vertices: u64, of: u64) -> String {
    let (vertices, of) = (grouped(vertices), grouped(of));
    if ours.displacement.is_on() && surface_option(ours) == surface_option(theirs) {
        return format!(
            "It isn't displaced: {vertices} of {of} vertices are off our displaced surface, and lie on the surface without \
             --displacement and --height."
        );
    }
    let also = if ours.displacement.is_on() { ", without displacement" } else { "" };
    format!(
        "Its control points are others: {vertices} of {of} vertices are off our surface ({}), and lie on that of {}{also}.",
        surface_option(ours),
        surface_option(theirs)
    )
}

fn displaced_text(displaced: &Displaced) -> String {
    let Displaced { vertices, of, largest, outward, inward, is_along_normals, ours } = displaced;
    let other = if ours.is_on() { " otherwise than ours" } else { "" };
    let start =
        format!("It is displaced{other}: {} of {} vertices are off the surface", grouped(*vertices), grouped(*of));
    if *is_along_normals {
        return format!(
            "{start}, along the normals, by up to {} object units outward and {} inward.",
            short(*outward),
            short(*inward)
        );
    }
    format!(
        "{start}, by up to {} object units, but not along the normals, and on none of our surfaces.",
        short(*largest)
    )
}

fn factors_text(
    ours: Partitioning,
    convention: Convention,
    explanations: &[Explanation],
    patches: u64,
    of: u64,
) -> String {
    let Some((first, others)) = explanations.split_first() else { return String::new() };
    let count = format!("({} of {} patches have other points than ours.)", grouped(patches), grouped(of));
    let mut text = format!("{} {count}", explanation_text(*first, ours, convention));
    // More than two only happen where hardly anything tells them apart.
    for other in others.iter().take(2) {
        text +=
            &format!(" The same points would come from this: {}", lowered(&explanation_text(*other, ours, convention)));
    }
    text
}

fn lowered(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_lowercase().chain(letters).collect())
}

fn explanation_text(explanation: Explanation, ours: Partitioning, convention: Convention) -> String {
    let Explanation { partitioning, rule } = explanation;
    let cut = (partitioning != ours)
        .then(|| format!("Its partitioning is {}, and ours is {}", partitioning.name(), ours.name()));
    let rule = match rule {
        Rule::Same => None,
        Rule::Sides(sides) => Some(order_text(rule, sides, convention)),
        Rule::Down => Some("Its factors are rounded down to whole numbers".to_owned()),
        Rule::Nearest => Some("Its factors are rounded to the nearest whole numbers".to_owned()),
        Rule::Inside(InsideRule::Least) => Some("Its inside factors are the least of the edges' factors".to_owned()),
        Rule::Inside(InsideRule::Mean) => Some("Its inside factors are the mean of the edges' factors".to_owned()),
        Rule::Inside(InsideRule::Largest) => {
            Some("Its inside factors are the largest of the edges' factors".to_owned())
        }
        Rule::Inside(InsideRule::One) => Some("Its inside factors are 1".to_owned()),
        Rule::Times(times) => Some(format!("Its factors are {times} times ours")),
        Rule::AtMost(most) => Some(format!("Its factors are limited to {most}")),
        Rule::All(all) => Some(format!("All its factors are {all}")),
    };
    match (cut, rule) {
        (Some(cut), Some(rule)) => format!("{cut}; and {}.", lowered(&rule)),
        (Some(text), None) | (None, Some(text)) => format!("{text}."),
        (None, None) => "Its factors are ours.".to_owned(),
    }
}

fn order_text(rule: Rule, sides: [usize; 3], ours: Convention) -> String {
    let side = |k: usize| format!("({k}, {})", (k + 1) % 3);
    let order = sides.map(side).join(", ");
    let named = rule.convention().filter(|_| ours.is_consistent());
    let like = named.map_or(String::new(), |convention| format!(", as under --convention {}", convention.name()));
    format!("Edges have each other's factors: edges (0, 1), (1, 2), (2, 0) are cut with those of {order}{like}")
}

fn unknown_text([patches, of, sides, inside]: [u64; 4], suits: &[Partitioning], ours: Partitioning) -> String {
    let start =
        format!("Its factors are others: {} of {} patches have other points than ours", grouped(patches), grouped(of));
    let where_ = match (sides, inside) {
        (0, _) => format!(", inside {} and never on an edge", patches_text(inside)),
        (_, 0) => format!(", with other cuts on {}", plural(sides, "side", "sides")),
        _ => format!(
            ", with other cuts on {}; {} inside alone",
            plural(sides, "side", "sides"),
            plural(inside, "patch differs", "patches differ")
        ),
    };
    let names: Vec<&str> = suits.iter().map(|own| own.name()).collect();
    let suited = match names[..] {
        [] => "Its sides are cut as under none of our partitionings".to_owned(),
        _ if suits.contains(&ours) => format!("The cuts of its sides suit our partitioning, {}", ours.name()),
        _ => format!("The cuts of its sides suit {}, but not our partitioning, {}", names.join(" and "), ours.name()),
    };
    format!("{start}{where_}. {suited}.")
}

fn triangles_text(count: u64, patches: u64, order: Option<CornerOrder>) -> String {
    let start = format!(
        "The points are the same, but {} other points than ours, in {}",
        plural(count, "triangle joins", "triangles join"),
        patches_text(patches)
    );
    match order {
        Some(order) => match order.convention() {
            Some(convention) => {
                format!("{start}: the tessellator's pattern is turned, as under --convention {}.", convention.name())
            }
            None => format!(
                "{start}: the tessellator's pattern is mirrored, as if two corners of each patch were exchanged."
            ),
        },
        None => format!("{start}: diagonals are turned."),
    }
}
