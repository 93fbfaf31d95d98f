//! Every option of [`Settings`], declared once.
//!
//! To add one: put a field into [`Settings`] or [`geometry::tessellate::Tessellation`], declare it here, and list it in
//! [`TESSELLATION`], [`PICTURE`] or [`IMPORT`].

use super::value::Field;
use super::{
    Access, Colors, Declaration, Description, DeviationUnit, FileLights, Kind, Lighting, Matcap, NormalMaps, NormalsAt,
    Overlay, Range, Settings, ToneCurve, Value, descriptions,
};
use geometry::mesh::UpAxis;
use geometry::tessellate::{Clip, Convention, Displacement, Edges, Lod, Normals, Partitioning, Surface, Tessellation};
use load::{LengthUnit, NormalSource, UNIT_METRES};

/// The options of every command that tessellates.
pub static TESSELLATION: [&Declaration; 16] = [
    &SURFACE,
    &ALPHA,
    &NORMALS,
    &EDGES,
    &FACTOR,
    &PARTITIONING,
    &LOD,
    &PIXELS,
    &TOLERANCE,
    &DISTANCES,
    &CLIP,
    &CULL_BACK_FACES,
    &CONVENTION,
    &DISPLACEMENT,
    &HEIGHT_SCALE,
    &MIDLEVEL,
];

/// The options of commands that draw a picture.
pub static PICTURE: [&Declaration; 16] = [
    &NORMALS_AT,
    &NORMAL_MAPS,
    &OVERLAY,
    &LIGHTING,
    &LIGHTS,
    &ENVIRONMENT_BRIGHTNESS,
    &ENVIRONMENT_BACKGROUND,
    &EXPOSURE,
    &TONE_CURVE,
    &LIGHT_ROTATION,
    &DEVIATION_IN,
    &CURVATURE_SCALE,
    &MATCAP,
    &SPLIT,
    &SPLIT_SURFACE,
    &BACKGROUND,
];

/// The options of commands that read a mesh.
pub static IMPORT: [&Declaration; 5] = [&MESH_NORMALS, &CREASE_ANGLE, &UP, &UNIT, &SHOW_HIDDEN];

/// Tessellation factors, as Direct3D 11 has them.
pub const FACTOR_RANGE: Range = Range::new(1.0, 64.0, "").decimals(3).logarithmic();
/// Tolerances of LOD by error, in px.
pub const TOLERANCE_RANGE: Range = Range::new(0.01, 100.0, "px").logarithmic();
/// Distances of LOD by distance, in bounding radii.
pub const DISTANCE_RANGE: Range = Range::new(0.1, 1000.0, "r");

/// All options.
pub fn all() -> impl Iterator<Item = &'static Declaration> {
    TESSELLATION.into_iter().chain(PICTURE).chain(IMPORT)
}

/// A field of settings, by its path.
macro_rules! field {
    ($($path:ident).+) => {
        Access {
            get: |settings| settings.$($path).+.value(),
            set: |settings, value| settings.$($path).+.put(value),
        }
    };
}

const fn always_has_effect(_: &Settings) -> Option<&'static str> {
    None
}

pub static SURFACE: Declaration = Declaration {
    name: "surface",
    label: "Surface",
    placeholder: "SURFACE",
    text: "The surface that each triangle becomes.",
    kind: Kind::Choice(descriptions::<Surface>),
    unset: None,
    saved_as: &["surface"],
    no_effect: always_has_effect,
    access: field!(tessellation.surface),
};

pub static ALPHA: Declaration = Declaration {
    name: "alpha",
    label: "Phong strength",
    placeholder: "A",
    text: "Strength of Phong tessellation: 0 is flat, and its authors use 0.75 (Boubekeur and Alexa 2008).",
    kind: Kind::Number(Range::new(0.0, 1.0, "")),
    unset: None,
    saved_as: &["alpha"],
    no_effect: |settings| {
        let left = settings.split_surface.filter(|_| settings.split.is_some());
        let is_phong = settings.tessellation.surface.is_phong() || left.is_some_and(Surface::is_phong);
        (!is_phong).then_some("Only Phong tessellation has a strength.")
    },
    access: field!(tessellation.alpha),
};

pub static NORMALS: Declaration = Declaration {
    name: "normals",
    label: "Shading",
    placeholder: "NORMALS",
    text: "The normals that the surface is shaded with.",
    kind: Kind::Choice(descriptions::<Normals>),
    unset: None,
    saved_as: &["normals"],
    no_effect: always_has_effect,
    access: field!(tessellation.normals),
};

pub static EDGES: Declaration = Declaration {
    name: "edges",
    label: "Shared edges",
    placeholder: "EDGES",
    text: "Shared edges are computed once (watertight), or by each patch (as published).",
    kind: Kind::Choice(descriptions::<Edges>),
    unset: None,
    saved_as: &["edges"],
    no_effect: always_has_effect,
    access: field!(tessellation.edges),
};

pub static FACTOR: Declaration = Declaration {
    name: "factor",
    label: "Factor",
    placeholder: "F",
    text: "Tessellation factor: the number of segments that each edge is cut into. Under LOD by distance, the largest factor.",
    kind: Kind::Number(FACTOR_RANGE),
    unset: None,
    saved_as: &["factor"],
    no_effect: |settings| {
        let is_used = matches!(settings.tessellation.used_lod(), Lod::Uniform | Lod::Distance);
        (!is_used).then_some("Adaptive LOD computes a factor for every edge.")
    },
    access: field!(tessellation.factor),
};

pub static PARTITIONING: Declaration = Declaration {
    name: "partitioning",
    label: "Partitioning",
    placeholder: "P",
    text: "How a factor between two whole numbers becomes segments.",
    kind: Kind::Choice(descriptions::<Partitioning>),
    unset: None,
    saved_as: &["partitioning"],
    no_effect: always_has_effect,
    access: field!(tessellation.partitioning),
};

/// Why LOD can't be chosen under subtriangulation.
pub const LOD_IS_FIXED: &str = "Subtriangulation has the same number of segments everywhere. Another \
                                       partitioning brings back the LOD that was chosen.";

pub static LOD: Declaration = Declaration {
    name: "lod",
    label: "LOD",
    placeholder: "LOD",
    text: "Level of detail: how the factors of edges are computed.",
    kind: Kind::Choice(descriptions::<Lod>),
    unset: None,
    saved_as: &["lod"],
    no_effect: |settings| {
        let is_fixed = settings.tessellation.partitioning == Partitioning::Subtriangulation;
        is_fixed.then_some(LOD_IS_FIXED)
    },
    access: field!(tessellation.lod),
};

pub static PIXELS: Declaration = Declaration {
    name: "pixels",
    label: "Segment length",
    placeholder: "P",
    text: "Length of a segment on screen under LOD by edge length and the white paper's LOD.",
    kind: Kind::Number(Range::new(1.0, 256.0, "px").decimals(1).logarithmic()),
    unset: None,
    saved_as: &["pixels"],
    no_effect: |settings| {
        let is_used = matches!(settings.tessellation.used_lod(), Lod::Paper | Lod::EdgeLength);
        (!is_used).then_some("Only LOD by edge length and the white paper's LOD have a segment length.")
    },
    access: field!(tessellation.pixels),
};

pub static TOLERANCE: Declaration = Declaration {
    name: "tolerance",
    label: "Tolerance",
    placeholder: "PX",
    text: "Largest distance on screen between the triangles and the surface under LOD by error. The overlay of excess \
           triangles and the gate above-tolerance compare with it under any LOD.",
    kind: Kind::Number(TOLERANCE_RANGE),
    unset: None,
    saved_as: &["tolerance"],
    no_effect: |settings| {
        let is_used = settings.tessellation.used_lod() == Lod::Error || settings.overlays.colors == Colors::Excess;
        (!is_used).then_some("Only LOD by error and the overlay of excess triangles have a tolerance.")
    },
    access: field!(tessellation.tolerance),
};

pub static DISTANCES: Declaration = Declaration {
    name: "distances",
    label: "Near, far",
    placeholder: "NEAR,FAR",
    text: "Distances to the eye under LOD by distance, in bounding radii of the mesh: the factor is --factor up to NEAR, 1 \
           from FAR on, and linear in between. FAR is larger than NEAR.",
    kind: Kind::Pair(DISTANCE_RANGE),
    unset: None,
    saved_as: &["near", "far"],
    no_effect: |settings| {
        (settings.tessellation.used_lod() != Lod::Distance).then_some("Only LOD by distance has distances.")
    },
    access: Access {
        get: |settings| Value::Pair([settings.tessellation.near, settings.tessellation.far]),
        set: |settings, value| {
            let Value::Pair([near, far]) = value else { return false };
            settings.tessellation = Tessellation { near, far, ..settings.tessellation };
            true
        },
    },
};

pub static CLIP: Declaration = Declaration {
    name: "clip",
    label: "Clipping",
    placeholder: "CLIP",
    text: "Which patches outside the view are left out.",
    kind: Kind::Choice(descriptions::<Clip>),
    unset: None,
    saved_as: &["clip"],
    no_effect: always_has_effect,
    access: field!(tessellation.clip),
};

pub static CULL_BACK_FACES: Declaration = Declaration {
    name: "cull-back-faces",
    label: "Cull back faces",
    placeholder: "",
    text: "Leaves out patches that show only their backs, if the mesh is closed, wound outward and single-sided.",
    kind: Kind::Switch,
    unset: None,
    saved_as: &["cull_back_faces"],
    no_effect: always_has_effect,
    access: field!(tessellation.cull_back_faces),
};

pub static CONVENTION: Declaration = Declaration {
    name: "convention",
    label: "Convention",
    placeholder: "NAME",
    text: "The order of the edge factors 0, 1, 2 and of the weights u, v, w. Hull and domain shader must agree on it.",
    kind: Kind::Choice(descriptions::<Convention>),
    unset: None,
    saved_as: &["convention"],
    no_effect: always_has_effect,
    access: field!(tessellation.convention),
};

/// It isn't saved: it depends on whether the open mesh has heights.
pub static DISPLACEMENT: Declaration = Declaration {
    name: "displacement",
    label: "Displace",
    placeholder: "DISPLACEMENT",
    text: "Whether heights displace the surface, and what patches agree on where they meet.",
    kind: Kind::Choice(descriptions::<Displacement>),
    unset: None,
    saved_as: &[],
    no_effect: always_has_effect,
    access: field!(tessellation.displacement),
};

fn not_displaced(settings: &Settings) -> Option<&'static str> {
    (settings.tessellation.displacement == Displacement::Off).then_some("The surface isn't displaced.")
}

pub static HEIGHT_SCALE: Declaration = Declaration {
    name: "height-scale",
    label: "Scale",
    placeholder: "S",
    text: "Distance between black and white of the height map, in bounding radii of the mesh at rest.",
    kind: Kind::Number(Range::new(-1.0, 1.0, "r").decimals(3)),
    unset: None,
    saved_as: &["height_scale"],
    no_effect: not_displaced,
    access: field!(tessellation.height_scale),
};

pub static MIDLEVEL: Declaration = Declaration {
    name: "midlevel",
    label: "Midlevel",
    placeholder: "H",
    text: "The height at which displacement moves nothing, from 0 (black) to 1 (white).",
    kind: Kind::Number(Range::new(0.0, 1.0, "")),
    unset: None,
    saved_as: &["midlevel"],
    no_effect: not_displaced,
    access: field!(tessellation.midlevel),
};

/// Why normals can't be evaluated at pixels under displacement.
pub const NORMALS_FOLLOW_TRIANGLES: &str =
    "The normals of a displaced surface follow its triangles, so they are at vertices.";

pub static NORMALS_AT: Declaration = Declaration {
    name: "normals-at",
    label: "Normals at",
    placeholder: "PLACES",
    text: "Where the normals that the surface is shaded with are evaluated. It changes no triangle.",
    kind: Kind::Choice(descriptions::<NormalsAt>),
    unset: None,
    saved_as: &["normals_at"],
    no_effect: |settings| (settings.tessellation.displacement != Displacement::Off).then_some(NORMALS_FOLLOW_TRIANGLES),
    access: field!(normals_at),
};

pub static NORMAL_MAPS: Declaration = Declaration {
    name: "normal-maps",
    label: "Normal maps",
    placeholder: "SWITCH",
    text: "Whether normal maps are drawn while the surface is displaced. Displacement alone shades the relief of the heights.",
    kind: Kind::Choice(descriptions::<NormalMaps>),
    unset: None,
    saved_as: &["normal_maps"],
    no_effect: |settings| not_displaced(settings).or(not_in_studio(settings)),
    access: field!(normal_maps),
};

pub(crate) static OVERLAY: Declaration = Declaration {
    name: "overlay",
    label: "Overlays",
    placeholder: "OVERLAY,..",
    text: "What is drawn over the surface. At most one of clay, matcap, zebra, shading-normals, surface-normals, \
           curvature, uv-checker, texel-density, barycentric, factors, triangle-size, low-factors, excess, deviation and silhouette, which colour all of it.",
    kind: Kind::Several(descriptions::<Overlay>),
    unset: None,
    saved_as: &["overlays"],
    no_effect: always_has_effect,
    access: field!(overlays),
};

pub static LIGHTING: Declaration = Declaration {
    name: "lighting",
    label: "Lighting",
    placeholder: "LIGHT",
    text: "The light that the mesh's own materials are seen in.",
    kind: Kind::Choice(descriptions::<Lighting>),
    unset: None,
    saved_as: &["lighting"],
    no_effect: |settings| {
        let is_idle = settings.overlays.colors != Colors::Material;
        is_idle.then_some("The overlay that colours the surface has a light of its own.")
    },
    access: field!(lighting),
};

fn not_in_studio(settings: &Settings) -> Option<&'static str> {
    (!settings.shows_materials()).then_some("Only the mesh's own materials in light from all around have it.")
}

pub static LIGHTS: Declaration = Declaration {
    name: "lights",
    label: "File's lights",
    placeholder: "SWITCH",
    text: "Whether the lights of the glTF file shine too: directional, point and spot lights, at most 16.",
    kind: Kind::Choice(descriptions::<FileLights>),
    unset: None,
    saved_as: &["lights"],
    no_effect: not_in_studio,
    access: field!(lights),
};

pub static ENVIRONMENT_BRIGHTNESS: Declaration = Declaration {
    name: "environment-brightness",
    label: "Environment",
    placeholder: "EV",
    text: "Brightness of the light from all around, of the studio or of a file, beside emission and the lights of the mesh's \
           file: each step of 1 EV doubles it.",
    kind: Kind::Number(Range::new(-10.0, 10.0, "EV")),
    unset: None,
    saved_as: &["environment_brightness"],
    no_effect: not_in_studio,
    access: field!(environment_brightness),
};

pub static ENVIRONMENT_BACKGROUND: Declaration = Declaration {
    name: "environment-background",
    label: "Show environment",
    placeholder: "",
    text: "Shows the light from all around behind the mesh, in place of the background's colour. Transparent pictures stay \
           transparent there.",
    kind: Kind::Switch,
    unset: None,
    saved_as: &["environment_background"],
    no_effect: not_in_studio,
    access: field!(environment_background),
};

pub static EXPOSURE: Declaration = Declaration {
    name: "exposure",
    label: "Exposure",
    placeholder: "EV",
    text: "Brightness of the picture in light from all around: each step of 1 EV doubles it.",
    kind: Kind::Number(Range::new(-10.0, 10.0, "EV")),
    unset: None,
    saved_as: &["exposure"],
    no_effect: not_in_studio,
    access: field!(exposure),
};

pub static TONE_CURVE: Declaration = Declaration {
    name: "tone-curve",
    label: "Tone curve",
    placeholder: "CURVE",
    text: "How light that is brighter than a picture can show becomes colours.",
    kind: Kind::Choice(descriptions::<ToneCurve>),
    unset: None,
    saved_as: &["tone_curve"],
    no_effect: not_in_studio,
    access: field!(tone_curve),
};

pub static LIGHT_ROTATION: Declaration = Declaration {
    name: "light-rotation",
    label: "Turn light",
    placeholder: "DEGREES",
    text: "How far the light from all around is turned about the vertical axis, counterclockwise as seen from above.",
    kind: Kind::Number(Range::new(0.0, 360.0, "°").decimals(0)),
    unset: None,
    saved_as: &["light_rotation"],
    no_effect: not_in_studio,
    access: field!(light_rotation),
};

pub static DEVIATION_IN: Declaration = Declaration {
    name: "deviation-in",
    label: "Distances in",
    placeholder: "UNIT",
    text: "The unit of the distances that the deviation overlay colours.",
    kind: Kind::Choice(descriptions::<DeviationUnit>),
    unset: None,
    saved_as: &["deviation_in"],
    no_effect: |settings| {
        (settings.overlays.colors != Colors::Deviation).then_some("Only the deviation overlay colours distances.")
    },
    access: field!(deviation_in),
};

pub static CURVATURE_SCALE: Declaration = Declaration {
    name: "curvature-scale",
    label: "Curvature up to",
    placeholder: "C",
    text: "The mean curvature at the ends of the curvature overlay's scale, in 1 / bounding radius of the mesh: a sphere has 1.",
    kind: Kind::Number(Range::new(0.1, 1000.0, "/r").logarithmic()),
    unset: None,
    saved_as: &["curvature_scale"],
    no_effect: |settings| {
        (settings.overlays.colors != Colors::Curvature).then_some("Only the curvature overlay colours curvature.")
    },
    access: field!(curvature_scale),
};

pub static MATCAP: Declaration = Declaration {
    name: "matcap",
    label: "Lit sphere",
    placeholder: "NAME",
    text: "The lit sphere whose colours the matcap overlay shows.",
    kind: Kind::Choice(descriptions::<Matcap>),
    unset: None,
    saved_as: &["matcap"],
    no_effect: |settings| {
        (settings.overlays.colors != Colors::Matcap).then_some("Only the matcap overlay shows a lit sphere.")
    },
    access: field!(matcap),
};

pub static SPLIT: Declaration = Declaration {
    name: "split",
    label: "Divider",
    placeholder: "FRACTION",
    text: "Splits the picture at this fraction of its width. The left half shows the untessellated mesh or another surface.",
    kind: Kind::Number(Range::new(0.0, 1.0, "")),
    unset: Some(Description::new("none", "None", "The picture isn't split.")),
    saved_as: &["split"],
    no_effect: always_has_effect,
    access: field!(split),
};

pub static SPLIT_SURFACE: Declaration = Declaration {
    name: "split-surface",
    label: "Left",
    placeholder: "SURFACE",
    text: "The surface left of the split; all other settings are the same, and so is the scale of the deviation overlay.",
    kind: Kind::Choice(descriptions::<Surface>),
    unset: Some(Description::new("none", "Untessellated", "The mesh itself, with no tessellation.")),
    saved_as: &["split_surface"],
    no_effect: |settings| settings.split.is_none().then_some("The view isn't split."),
    access: field!(split_surface),
};

pub static BACKGROUND: Declaration = Declaration {
    name: "background",
    label: "Background",
    placeholder: "RRGGBB",
    text: "The sRGB colour behind the mesh. Without it, the window's theme chooses, and commands draw on 2b2e33.",
    kind: Kind::Color,
    unset: Some(Description::new(
        "theme",
        "As the theme",
        "A dark grey in a dark theme, and a light one in a light theme.",
    )),
    saved_as: &["background"],
    no_effect: always_has_effect,
    access: field!(background),
};

pub static MESH_NORMALS: Declaration = Declaration {
    name: "mesh-normals",
    label: "Normals",
    placeholder: "NAME",
    text: "The normals that the corners of the mesh have. The shape of curved patches is made of them.",
    kind: Kind::Choice(descriptions::<NormalSource>),
    unset: None,
    saved_as: &["mesh_normals"],
    no_effect: always_has_effect,
    access: field!(import.normals),
};

pub static CREASE_ANGLE: Declaration = Declaration {
    name: "crease-angle",
    label: "Crease angle",
    placeholder: "DEGREES",
    text: "Where normals are made, triangles that meet at up to this angle are smooth, and others make a crease: 0 makes every \
           triangle flat, and 180 everything smooth.",
    kind: Kind::Number(Range::new(0.0, 180.0, "°").decimals(0)),
    unset: None,
    saved_as: &["crease_angle"],
    no_effect: always_has_effect,
    access: field!(import.crease_angle),
};

/// It is saved with the file, as the camera is.
pub static UP: Declaration = Declaration {
    name: "up",
    label: "Up axis",
    placeholder: "AXIS",
    text: "The axis of the file's coordinates that points up. The mesh is turned, with everything that belongs to it.",
    kind: Kind::Choice(descriptions::<UpAxis>),
    unset: Some(Description::new(
        "file",
        "As the file says",
        "FBX files say which axis points up. In glTF files it is Y. OBJ, STL and PLY files don't say, and count as Y up.",
    )),
    saved_as: &[],
    no_effect: always_has_effect,
    access: field!(import.up),
};

/// It is saved with the file too.
pub static UNIT: Declaration = Declaration {
    name: "unit",
    label: "Unit",
    placeholder: "UNIT",
    text: "The unit of the file's coordinates, by its name or as its length in metres. The mesh is scaled to metres, with everything \
           that belongs to it.",
    kind: Kind::NameOrNumber {
        names: descriptions::<LengthUnit>,
        number: Description::new("METRES", "Another length", "The row below says how many metres a unit is long."),
        row: "Unit length",
        range: Range::new(*UNIT_METRES.start(), *UNIT_METRES.end(), "m").decimals(9).logarithmic(),
    },
    unset: Some(Description::new(
        "file",
        "As the file says",
        "FBX files say what their unit is. In glTF files it is the metre. OBJ, STL and PLY files don't say, and their numbers are \
         taken as they are.",
    )),
    saved_as: &[],
    no_effect: always_has_effect,
    access: field!(import.unit),
};

pub static SHOW_HIDDEN: Declaration = Declaration {
    name: "show-hidden",
    label: "Show hidden",
    placeholder: "",
    text: "Also load the meshes that an FBX or glTF file hides, on nodes and layers that are switched off.",
    kind: Kind::Switch,
    unset: None,
    saved_as: &["show_hidden"],
    no_effect: always_has_effect,
    access: field!(import.show_hidden),
};

#[cfg(test)]
mod tests;
