//! What was found, as sentences: the most important first.

use glam::DVec3;
use thiserror::Error;

use super::corner_orders::CornerOrder;
use super::explanations::{Explanation, Rule};
use super::matching::Farthest;
use super::net_mistakes::NetMistake;
use super::spaces::{Alignment, Space, SpaceKind};
use geometry::numbers::{counted, exact, grouped, numbered, short};
use geometry::tessellate::{Convention, Displacement, Partitioning, Tessellation};
use inspect::settings::Choice;

/// Something about another program's tessellation that isn't as ours, with what is said of it in a sentence or two.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Finding {
    /// Most of it isn't near the surface.
    #[error(
        "It isn't a tessellation of this mesh: {} of {} vertices are farther than {} object units from the surface.",
        grouped(*far),
        grouped(*vertices),
        short(*distance)
    )]
    NotATessellation { far: u64, vertices: u64, distance: f64 },
    /// All coordinates are turned, mirrored, scaled or moved, or in another space.
    #[error("{}", space_text(.0))]
    Aligned(Space),
    /// Vertices lie on another of our surfaces.
    #[error("{}", surface_text(ours, theirs, *vertices, *of))]
    OtherSurface { ours: Tessellation, theirs: Tessellation, vertices: u64, of: u64 },
    /// Vertices lie where a mistake in control points puts them.
    #[error("{}", nets_text(*mistake, *vertices, *of))]
    OtherNets { mistake: NetMistake, vertices: u64, of: u64 },
    /// All vertices are off the surface.
    #[error("{}", displaced_text(.0))]
    Displaced(Displaced),
    /// A few vertices aren't where ours are.
    #[error(
        "{} moved, by up to {} object units: the farthest at {}, in triangle {triangle}.",
        numbered(*vertices, "# [vertex is|vertices are]"),
        short(*distance),
        point(*farthest)
    )]
    Moved { vertices: u64, farthest: DVec3, distance: f64, triangle: u32 },
    /// One change of the factors gives their points: the first of these, or any of the others.
    #[error("{}", factors_text(*ours, *convention, explanations, [*patches, *of]))]
    Factors { ours: Partitioning, convention: Convention, explanations: Vec<Explanation>, patches: u64, of: u64 },
    /// No change that is known gives their points.
    #[error("{}", unknown_text(.0))]
    UnknownFactors(UnknownFactors),
    /// Edges whose sides they cut differently.
    #[error(
        "{} of {} edges between patches are cut differently by their sides, so the mesh cracks there.",
        grouped(*edges),
        grouped(*of)
    )]
    Cracked { edges: u64, of: u64 },
    /// Patches without triangles of theirs, though we emit some.
    #[error(
        "{} of {} patches {} no triangles: {}.",
        grouped(*patches),
        grouped(*of),
        if *patches == 1 { "has" } else { "have" },
        listed(triangles, *patches)
    )]
    MissingPatches { patches: u64, of: u64, triangles: Vec<u32> },
    /// Patches with triangles of theirs, though we emit none.
    #[error(
        "{} triangles, though our tessellation leaves {} out: {}.",
        numbered(*patches, "# [patch has|patches have]"),
        if *patches == 1 { "it" } else { "them" },
        listed(triangles, *patches)
    )]
    AdditionalPatches { patches: u64, triangles: Vec<u32> },
    #[error("{} missing, in {}.", numbered(*count, "# [triangle is|triangles are]"), counted(*patches, "patch"))]
    MissingTriangles { count: u64, patches: u64 },
    #[error("{} there more than once, in {}.", numbered(*count, "# [triangle is|triangles are]"), counted(*patches, "patch"))]
    Doubled { count: u64, patches: u64 },
    #[error("{}", flipped_text(*count, *of))]
    Flipped { count: u64, of: u64 },
    /// The same points, but other triangles between them.
    #[error("{}", triangles_text(*count, *patches, *order))]
    OtherTriangles { count: u64, patches: u64, order: Option<CornerOrder> },
    #[error(
        "{} a coordinate that is NaN or infinite, and {} compared.",
        numbered(*count, "# [triangle has|triangles have]"),
        if *count == 1 { "isn't" } else { "aren't" }
    )]
    NotFinite { count: u64 },
    /// Our pattern starts at another corner, which changes nothing but the last bits of points inside.
    #[error(
        "Everything agrees but the last bits of points inside of patches, which are those of --convention {}, and not of {}.",
        theirs.name(),
        ours.name()
    )]
    Convention { ours: Convention, theirs: Convention },
    /// Coordinates are rounded to 16-bit floating-point numbers, and so farther from ours than is allowed.
    #[error(
        "Its coordinates are rounded to 16-bit floating-point numbers, so that vertices are up to {} object units ({} ULP) away. \
         {}",
        short(*distance),
        short(*ulps),
        allowance(*distance)
    )]
    HalfFloats { distance: f64, ulps: f64 },
    /// Nothing but distances that are larger than those allowed.
    #[error(
        "Everything agrees but the last digits: vertices differ by up to {} object units ({} ULP), at {} in triangle {triangle}. {}",
        short(farthest.distance),
        short(*ulps),
        point(farthest.ours),
        allowance(farthest.distance)
    )]
    Rounding { farthest: Farthest, ulps: f64, triangle: u32 },
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

/// How many patches have other points than ours, and what is known of them.
#[derive(Clone, Debug, PartialEq)]
pub struct UnknownFactors {
    pub patches: u64,
    pub of: u64,
    /// How many sides are cut differently, and how many patches differ inside alone.
    pub sides: u64,
    pub inside: u64,
    /// The partitionings that cut sides so.
    pub suits: Vec<Partitioning>,
    pub ours: Partitioning,
    /// Whether LOD gives other factors for another view.
    pub is_of_view: bool,
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
            Self::UnknownFactors(_) => "factors",
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
}

pub fn point(place: DVec3) -> String {
    let [x, y, z] = (place + DVec3::ZERO).to_array().map(|coordinate| exact(coordinate as f32));
    format!("({x}, {y}, {z})")
}

/// How to allow a distance: with the least number of two digits that isn't smaller, so that it can be typed.
fn allowance(distance: f64) -> String {
    let unit = 10.0_f64.powf(distance.log10().floor() - 1.0);
    let rounded_up = (distance / unit - 1e-6).ceil() * unit;
    format!("If that is as it should be, allow it with --within {rounded_up:.1e}.")
}

/// Names triangles of the mesh, of which there are `count`.
fn listed(triangles: &[u32], count: u64) -> String {
    let names = triangles.iter().map(u32::to_string).collect::<Vec<_>>().join(", ");
    let noun = if count == 1 { "triangle" } else { "triangles" };
    match count - triangles.len() as u64 {
        0 => format!("{noun} {names}"),
        more => format!("{noun} {names} and {more} more"),
    }
}

fn flipped_text(count: u64, of: u64) -> String {
    if count < of {
        return format!("{} of {} triangles are wound the other way.", grouped(count), grouped(of));
    }
    "All triangles are wound the other way: exchange two corners of each, or turn the tessellator's output winding."
        .into()
}

fn space_text(space: &Space) -> String {
    let by_camera = "in clip space, by this camera's matrix";
    let unapplied = |what: &str| format!(" Look whether {what} applied before they are written.");
    let (what, look) = match &space.kind {
        SpaceKind::Axes(alignment) => (alignment_text(alignment), axes_hint(alignment).to_owned()),
        SpaceKind::View => ("in view space, seen from this camera".to_owned(), unapplied("the view matrix is")),
        SpaceKind::Clip => (by_camera.to_owned(), unapplied("the view-projection matrix is")),
        SpaceKind::DividedClip => {
            let unapplied = unapplied("the view-projection matrix and the division by w are");
            (format!("{by_camera}, and divided by w"), unapplied)
        }
        SpaceKind::Turned { axis, degrees, scale, offset, is_mirrored } => {
            let mirrored = if *is_mirrored { "mirrored at the origin and " } else { "" };
            let turned = format!("{mirrored}turned by {} degrees about {}", short(*degrees), rounded(*axis));
            (turned + &moved_part(*scale, *offset), unapplied("a model matrix is"))
        }
    };
    format!("Its coordinates are {what}.{look} All that follows is in our coordinates.")
}

fn alignment_text(alignment: &Alignment) -> String {
    let Alignment { axes, scale, offset } = alignment;
    let mut parts = Vec::new();
    if alignment.turns() {
        let axis =
            |(axis, is_turned): (usize, bool)| format!("{}{}", if is_turned { "-" } else { "" }, ["x", "y", "z"][axis]);
        let doing = if alignment.mirrors() { "mirrored" } else { "turned" };
        parts.push(format!("{doing} (its x, y, z are our {})", axes.map(axis).join(", ")));
    }
    if *scale != 1.0 {
        parts.push(format!("scaled ({} times ours)", exact(*scale as f32)));
    }
    if *offset != DVec3::ZERO {
        parts.push(format!("moved (by {})", point(*offset)));
    }
    parts.join(" and ")
}

/// What usually turns or mirrors axes like this, in a sentence after a blank; empty if they aren't turned.
fn axes_hint(alignment: &Alignment) -> &'static str {
    let order = alignment.axes.map(|(axis, _)| axis);
    match (order, alignment.mirrors()) {
        _ if !alignment.turns() => "",
        ([0, 2, 1], false) => " Look at the axis that points up: one of the two has Y up, and the other Z up.",
        ([0, 2, 1], true) => " Look at the axis that points up and at the handedness: both differ.",
        ([0, 1, 2], true) => {
            " Look at the handedness: one of the two has left-handed coordinates, and the other right-handed ones."
        }
        _ => " Look at the convention of axes with which the mesh is imported.",
    }
}

/// Three numbers without what rounding leaves of 0.
fn rounded(numbers: DVec3) -> String {
    let [x, y, z] = numbers.to_array().map(|number| short((number * 1e6).round() / 1e6));
    format!("({x}, {y}, {z})")
}

fn moved_part(scale: f64, offset: DVec3) -> String {
    let mut text = String::new();
    if scale != 1.0 {
        text += &format!(", scaled ({} times ours)", short(scale));
    }
    if offset.length() > 1e-6 {
        text += &format!(", moved by {}", rounded(offset));
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
    let option = format!("--surface {}", tessellation.surface.name());
    if tessellation.surface.is_phong() { format!("{option} --alpha {}", tessellation.alpha) } else { option }
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
    let [largest, outward, inward] = [*largest, *outward, *inward].map(short);
    if *is_along_normals {
        return format!("{start}, along the normals, by up to {outward} object units outward and {inward} inward.");
    }
    format!("{start}, by up to {largest} object units, but not along the normals, and on none of our surfaces.")
}

fn factors_text(ours: Partitioning, convention: Convention, all: &[Explanation], patches: [u64; 2]) -> String {
    let [patches, of] = patches.map(grouped);
    let mut texts = all.iter().map(|explanation| explanation_text(*explanation, ours, convention));
    let first = texts.next().unwrap_or_default();
    // More than two others only happen where hardly anything tells them apart.
    let others = texts.take(2).map(|other| format!(" The same points would come from this: {}", lowered(&other)));
    format!("{first} ({patches} of {of} patches have other points than ours.){}", others.collect::<String>())
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
        Rule::Inside(rule) => Some(format!("Its inside factors are {}", rule.text())),
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

fn unknown_text(found: &UnknownFactors) -> String {
    let UnknownFactors { patches, of, sides, inside, suits, ours, is_of_view } = found;
    let [patches, of] = [*patches, *of].map(grouped);
    let where_ = match (*sides, *inside) {
        (0, inside) => format!(", inside {} and never on an edge", counted(inside, "patch")),
        (sides, 0) => format!(", with other cuts on {}", counted(sides, "side")),
        (sides, inside) => {
            let [sides, inside] = [counted(sides, "side"), numbered(inside, "# [patch differs|patches differ]")];
            format!(", with other cuts on {sides}; {inside} inside alone")
        }
    };
    let names: Vec<&str> = suits.iter().map(|own| own.name()).collect();
    let suited = match names[..] {
        [] => "Its sides are cut as under none of our partitionings".to_owned(),
        _ if suits.contains(ours) => format!("The cuts of its sides suit our partitioning, {}", ours.name()),
        _ => format!("The cuts of its sides suit {}, but not our partitioning, {}", names.join(" and "), ours.name()),
    };
    let view = " LOD depends on the view: the camera and --size must be the other program's, too.";
    let view = if *is_of_view { view } else { "" };
    format!("Its factors are others: {patches} of {of} patches have other points than ours{where_}. {suited}.{view}")
}

fn triangles_text(count: u64, patches: u64, order: Option<CornerOrder>) -> String {
    let (join, patches) = (numbered(count, "# [triangle joins|triangles join]"), counted(patches, "patch"));
    let start = format!("The points are the same, but {join} other points than ours, in {patches}");
    let turned = match order.map(CornerOrder::convention) {
        None => "diagonals are turned".to_owned(),
        Some(Some(own)) => format!("the tessellator's pattern is turned, as under --convention {}", own.name()),
        Some(None) => {
            "the tessellator's pattern is mirrored, as if two corners of each patch were exchanged".to_owned()
        }
    };
    format!("{start}: {turned}.")
}
