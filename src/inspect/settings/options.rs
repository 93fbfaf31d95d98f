//! Every option of [`Settings`], declared once.
//!
//! To add one: put a field into [`Settings`] or [`geometry::tessellate::Tessellation`], declare it here, in
//! [`TESSELLATION`], [`LOOKS`], [`PICTURE`] or [`IMPORT`].

use super::value::Field;
use super::{
    Access, Colors, Declaration, Description, FileLights, Kind, Lighting, Matcap, NormalMaps, NormalsAt, Overlay,
    Range, SectionAxis, Settings, SplitView, SurfaceUnit, ToneCurve, Value, descriptions,
};
use geometry::mesh::UpAxis;
use geometry::mesh::subdivision::FaceVarying;
use geometry::tessellate::{
    Clip, Convention, CurvatureKind, Displacement, Edges, Lod, LodReads, Normals, Partitioning, Surface, Tessellation,
};
use load::import::{MOST_LEVELS, Subdivide};
use load::{LengthUnit, NormalSource, UNIT_METRES};

/// Tessellation factors, as Direct3D 11 has them.
pub const FACTOR_RANGE: Range = Range::new(1.0, 64.0, "").decimals(3).logarithmic();
/// Tolerances of LOD by error, in px.
pub const TOLERANCE_RANGE: Range = Range::new(0.01, 100.0, "px").logarithmic();
/// Distances of LOD by distance, in bounding radii.
pub const DISTANCE_RANGE: Range = Range::new(0.1, 1000.0, "r");

/// All options.
pub fn all() -> impl Iterator<Item = &'static Declaration> {
    TESSELLATION.into_iter().chain(LOOKS).chain(PICTURE).chain(IMPORT)
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

/// Declares options in a list, each with where settings have its value and what values it takes. Most always have a value, are saved
/// under their own name, and always have an effect, which isn't said. Switches have no placeholder.
macro_rules! options {
    (@or [] $usual:expr) => { $usual };
    (@or [$given:expr] $usual:expr) => { $given };
    ($(#[$of_list:meta])* pub static $list:ident; $(
        $(#[$doc:meta])*
        $option:ident: $access:expr, $kind:expr => {
            name: $name:literal,
            label: $label:literal,
            $(placeholder: $placeholder:literal,)?
            text: $text:literal,
            $(unset: $unset:expr,)?
            $(saved_as: $saved_as:expr,)?
            $(no_effect: $no_effect:expr,)?
        }
    )+) => {
        $(#[$of_list])*
        pub static $list: [&Declaration; [$($name),+].len()] = [$(&$option),+];

        $(
            $(#[$doc])*
            pub static $option: Declaration = Declaration {
                name: $name,
                label: $label,
                placeholder: options!(@or [$($placeholder)?] ""),
                text: $text,
                kind: $kind,
                unset: options!(@or [$(Some($unset))?] None),
                saved_as: options!(@or [$(Some($saved_as))?] None),
                no_effect: options!(@or [$($no_effect)?] |_| None),
                access: $access,
            };
        )+
    };
}

const NEAR_AND_FAR: Access = Access {
    get: |settings| Value::Pair([settings.tessellation.near, settings.tessellation.far]),
    set: |settings, value| {
        let Value::Pair([near, far]) = value else { return false };
        settings.tessellation = Tessellation { near, far, ..settings.tessellation };
        true
    },
};

/// All options of the tessellation left of the split. Those that aren't set are as in the right half.
const LEFT: Access = Access {
    get: |settings| values(&TESSELLATION, settings.has_left_tessellation().then(|| settings.with(settings.left))),
    set: |settings, value| {
        let Some(left) = with_values(&TESSELLATION, settings, value) else { return false };
        settings.left = left.map_or_else(Tessellation::untessellated, |left| left.tessellation);
        true
    },
};

/// The same for how it looks.
const LEFT_LOOKS: Access = Access {
    get: |settings| values(&LOOKS, settings.left_looks.map(|looks| settings.with_looks(looks))),
    set: |settings, value| {
        let Some(left) = with_values(&LOOKS, settings, value) else { return false };
        settings.left_looks = left.map(|left| left.looks());
        true
    },
};

/// The values that these options have in settings of the left half, if it has settings of its own.
fn values(options: &[&Declaration], left: Option<Settings>) -> Value {
    let all = |left: Settings| options.iter().map(|option| (option.name, option.get(&left))).collect();
    left.map_or(Value::Unset, |left| Value::Options(all(left)))
}

/// Settings with these values of options, or without any; none if one of them isn't taken.
fn with_values(options: &[&Declaration], settings: &Settings, value: Value) -> Option<Option<Settings>> {
    let Value::Options(values) = value else { return (value == Value::Unset).then_some(None) };
    let mut left = *settings;
    let mut set = |(name, value)| {
        options.iter().find(|option| option.name == name).is_some_and(|option| option.set(&mut left, value))
    };
    values.into_iter().all(&mut set).then_some(Some(left))
}

/// Why LOD can't be chosen under subtriangulation.
pub const LOD_IS_FIXED: &str = "Subtriangulation has the same number of segments everywhere. Another \
                                       partitioning brings back the LOD that was chosen.";

/// Why normals can't be evaluated at pixels under displacement.
pub const NORMALS_FOLLOW_TRIANGLES: &str =
    "The normals of a displaced surface follow its triangles, so they are at vertices.";

/// What the LOD that is used reads.
fn reads(settings: &Settings) -> LodReads {
    settings.tessellation.used_lod().reads()
}

/// Why an option has no effect, unless it is used.
fn only_if(is_used: bool, why: &'static str) -> Option<&'static str> {
    (!is_used).then_some(why)
}

fn not_displaced(settings: &Settings) -> Option<&'static str> {
    only_if(settings.tessellation.displacement.is_on(), "The surface isn't displaced.")
}

fn not_in_studio(settings: &Settings) -> Option<&'static str> {
    only_if(settings.shows_materials(), "Only the mesh's own materials in light from all around have it.")
}

fn not_split(settings: &Settings) -> Option<&'static str> {
    only_if(settings.split.is_some(), "The view isn't split.")
}

fn without_curvature(settings: &Settings) -> Option<&'static str> {
    only_if(settings.overlays.colors == Colors::Curvature, "Only the curvature overlay colours curvature.")
}

fn without_zebra(settings: &Settings) -> Option<&'static str> {
    only_if(settings.overlays.colors == Colors::Zebra, "Only the zebra overlay has stripes.")
}

options! {
    /// The options of every command that tessellates.
    pub static TESSELLATION;

    SURFACE: field!(tessellation.surface), Kind::Choice(descriptions::<Surface>) => {
        name: "surface",
        label: "Surface",
        placeholder: "SURFACE",
        text: "The surface that each triangle becomes.",
    }

    ALPHA: field!(tessellation.alpha), Kind::Number(Range::new(0.0, 1.0, "")) => {
        name: "alpha",
        label: "Phong strength",
        placeholder: "A",
        text: "Strength of Phong tessellation: 0 is flat, and its authors use 0.75 (Boubekeur and Alexa 2008).",
        no_effect: |settings| only_if(settings.tessellation.surface.is_phong(), "Only Phong tessellation has a strength."),
    }

    NORMALS: field!(tessellation.normals), Kind::Choice(descriptions::<Normals>) => {
        name: "normals",
        label: "Shading",
        placeholder: "NORMALS",
        text: "The normals that the surface is shaded with.",
    }

    EDGES: field!(tessellation.edges), Kind::Choice(descriptions::<Edges>) => {
        name: "edges",
        label: "Shared edges",
        placeholder: "EDGES",
        text: "Shared edges are computed once (watertight), or by each patch (as published).",
    }

    FACTOR: field!(tessellation.factor), Kind::Number(FACTOR_RANGE) => {
        name: "factor",
        label: "Factor",
        placeholder: "F",
        text: "Tessellation factor: the number of segments that each edge is cut into. Under LOD by distance, the largest factor.",
        no_effect: |settings| only_if(reads(settings).factor, "Adaptive LOD computes a factor for every edge."),
    }

    PARTITIONING: field!(tessellation.partitioning), Kind::Choice(descriptions::<Partitioning>) => {
        name: "partitioning",
        label: "Partitioning",
        placeholder: "P",
        text: "How a factor between two whole numbers becomes segments.",
    }

    LOD: field!(tessellation.lod), Kind::Choice(descriptions::<Lod>) => {
        name: "lod",
        label: "LOD",
        placeholder: "LOD",
        text: "Level of detail: how the factors of edges are computed.",
        no_effect: |settings| settings.tessellation.partitioning.has_one_factor().then_some(LOD_IS_FIXED),
    }

    PIXELS: field!(tessellation.pixels), Kind::Number(Range::new(1.0, 256.0, "px").decimals(1).logarithmic()) => {
        name: "pixels",
        label: "Segment length",
        placeholder: "P",
        text: "Length of a segment on screen under LOD by edge length and the white paper's LOD.",
        no_effect: |settings| {
            only_if(reads(settings).pixels, "Only LOD by edge length and the white paper's LOD have a segment length.")
        },
    }

    TOLERANCE: field!(tessellation.tolerance), Kind::Number(TOLERANCE_RANGE) => {
        name: "tolerance",
        label: "Tolerance",
        placeholder: "PX",
        text: "Largest distance on screen between the triangles and the surface under LOD by error. The overlay of excess \
               triangles and the gate above-tolerance compare with it under any LOD.",
        no_effect: |settings| {
            let is_used = reads(settings).tolerance || settings.overlays.colors == Colors::Excess;
            only_if(is_used, "Only LOD by error and the overlay of excess triangles have a tolerance.")
        },
    }

    DISTANCES: NEAR_AND_FAR, Kind::Pair(DISTANCE_RANGE) => {
        name: "distances",
        label: "Near, far",
        placeholder: "NEAR,FAR",
        text: "Distances to the eye under LOD by distance, in bounding radii of the mesh. The factor is --factor up to NEAR, 1 \
               from FAR on, and linear in between. FAR is larger than NEAR.",
        saved_as: &["near", "far"],
        no_effect: |settings| only_if(reads(settings).distances, "Only LOD by distance has distances."),
    }

    CLIP: field!(tessellation.clip), Kind::Choice(descriptions::<Clip>) => {
        name: "clip",
        label: "Clipping",
        placeholder: "CLIP",
        text: "Which patches outside the view are left out.",
    }

    CULL_BACK_FACES: field!(tessellation.cull_back_faces), Kind::Switch => {
        name: "cull-back-faces",
        label: "Cull back faces",
        text: "Leaves out patches that show only their backs, if the mesh is closed, wound outward and single-sided.",
    }

    CONVENTION: field!(tessellation.convention), Kind::Choice(descriptions::<Convention>) => {
        name: "convention",
        label: "Convention",
        placeholder: "NAME",
        text: "The order of the edge factors 0, 1, 2 and of the weights u, v, w. Hull and domain shader must agree on it.",
    }

    /// It isn't saved: it depends on whether the open mesh has heights.
    DISPLACEMENT: field!(tessellation.displacement), Kind::Choice(descriptions::<Displacement>) => {
        name: "displacement",
        label: "Displace",
        placeholder: "DISPLACEMENT",
        text: "Whether heights displace the surface, and what patches agree on where they meet.",
        saved_as: &[],
    }

    HEIGHT_SCALE: field!(tessellation.height_scale), Kind::Number(Range::new(-1.0, 1.0, "r").decimals(3)) => {
        name: "height-scale",
        label: "Scale",
        placeholder: "S",
        text: "Distance between black and white of the height map, in bounding radii of the mesh at rest.",
        no_effect: not_displaced,
    }

    MIDLEVEL: field!(tessellation.midlevel), Kind::Number(Range::new(0.0, 1.0, "")) => {
        name: "midlevel",
        label: "Midlevel",
        placeholder: "H",
        text: "The height at which displacement moves nothing, from 0 (black) to 1 (white).",
        no_effect: not_displaced,
    }
}

options! {
    /// The options of how the mesh looks in a picture. Halves of a split picture may differ in them, as in those of the tessellation.
    pub static LOOKS;

    OVERLAY: field!(overlays), Kind::Several(descriptions::<Overlay>) => {
        name: "overlay",
        label: "Overlays",
        placeholder: "OVERLAY,..",
        text: "What is drawn over the surface. At most one of clay, matcap, zebra, shading-normals, surface-normals, \
               curvature, uv-checker, texel-density, barycentric, factors, triangle-size, low-factors, excess, deviation and silhouette, which colour all of it.",
        saved_as: &["overlays"],
    }

    NORMALS_AT: field!(normals_at), Kind::Choice(descriptions::<NormalsAt>) => {
        name: "normals-at",
        label: "Normals at",
        placeholder: "PLACES",
        text: "Where the normals that the surface is shaded with are evaluated. It changes no triangle.",
        no_effect: |settings| settings.tessellation.displacement.is_on().then_some(NORMALS_FOLLOW_TRIANGLES),
    }

    NORMAL_MAPS: field!(normal_maps), Kind::Choice(descriptions::<NormalMaps>) => {
        name: "normal-maps",
        label: "Normal maps",
        placeholder: "SWITCH",
        text: "Whether normal maps are drawn while the surface is displaced. Displacement alone shades the relief of the heights.",
        no_effect: |settings| not_displaced(settings).or(not_in_studio(settings)),
    }

    LIGHTING: field!(lighting), Kind::Choice(descriptions::<Lighting>) => {
        name: "lighting",
        label: "Lighting",
        placeholder: "LIGHT",
        text: "The light that the mesh's own materials are seen in.",
        no_effect: |settings| {
            let is_used = settings.overlays.colors == Colors::Material;
            only_if(is_used, "The overlay that colours the surface has a light of its own.")
        },
    }

    LIGHTS: field!(lights), Kind::Choice(descriptions::<FileLights>) => {
        name: "lights",
        label: "File's lights",
        placeholder: "SWITCH",
        text: "Whether the lights of the glTF file shine too: directional, point and spot lights, at most 16.",
        no_effect: not_in_studio,
    }

    ENVIRONMENT_BRIGHTNESS: field!(environment_brightness), Kind::Number(Range::new(-10.0, 10.0, "EV")) => {
        name: "environment-brightness",
        label: "Environment",
        placeholder: "EV",
        text: "Brightness of the light from all around, but not of emission and the lights of the mesh's file: each step of 1 EV \
               doubles it.",
        no_effect: not_in_studio,
    }

    ENVIRONMENT_BACKGROUND: field!(environment_background), Kind::Switch => {
        name: "environment-background",
        label: "Show environment",
        text: "Shows the light from all around behind the mesh, in place of the background's colour. Transparent pictures stay \
               transparent there.",
        no_effect: not_in_studio,
    }

    EXPOSURE: field!(exposure), Kind::Number(Range::new(-10.0, 10.0, "EV")) => {
        name: "exposure",
        label: "Exposure",
        placeholder: "EV",
        text: "Brightness of the picture in light from all around: each step of 1 EV doubles it.",
        no_effect: not_in_studio,
    }

    TONE_CURVE: field!(tone_curve), Kind::Choice(descriptions::<ToneCurve>) => {
        name: "tone-curve",
        label: "Tone curve",
        placeholder: "CURVE",
        text: "How light that is brighter than a picture can show becomes colours.",
        no_effect: not_in_studio,
    }

    LIGHT_ROTATION: field!(light_rotation), Kind::Number(Range::new(0.0, 360.0, "°").decimals(0)) => {
        name: "light-rotation",
        label: "Turn light",
        placeholder: "DEGREES",
        text: "How far the light from all around is turned about the vertical axis, counterclockwise as seen from above.",
        no_effect: not_in_studio,
    }

    DEVIATION_IN: field!(deviation_in), Kind::Choice(descriptions::<SurfaceUnit>) => {
        name: "deviation-in",
        label: "Distances in",
        placeholder: "UNIT",
        text: "The unit of the distances that the deviation overlay colours.",
        no_effect: |settings| only_if(settings.overlays.colors == Colors::Deviation, "Only the deviation overlay colours distances."),
    }

    CURVATURE_KIND: field!(curvature_kind), Kind::Choice(descriptions::<CurvatureKind>) => {
        name: "curvature-kind",
        label: "Kind of curvature",
        placeholder: "KIND",
        text: "Which curvature the curvature overlay shows.",
        no_effect: without_curvature,
    }

    CURVATURE_SCALE: field!(curvature_scale), Kind::Number(Range::new(0.1, 1000.0, "/r").logarithmic()) => {
        name: "curvature-scale",
        label: "Curvature up to",
        placeholder: "C",
        text: "The curvature at the ends of the curvature overlay's scale, in 1 / bounding radius of the mesh: a sphere has 1. The \
               scale of Gaussian curvature ends at the square of that.",
        unset: Description::new(
            "mesh",
            "As suits the mesh",
            "One and a half times the curvature that nine in ten of the curved sides of triangles don't exceed.",
        ),
        no_effect: without_curvature,
    }

    ZEBRA_STRIPES: field!(zebra_stripes), Kind::Number(Range::new(2.0, 200.0, "").decimals(0).logarithmic()) => {
        name: "zebra-stripes",
        label: "Stripes",
        placeholder: "N",
        text: "How many stripes the zebra overlay has over half a turn of the normal: more of them show smaller kinks.",
        no_effect: without_zebra,
    }

    ZEBRA_DIRECTION: field!(zebra_direction), Kind::Number(Range::new(0.0, 180.0, "°").decimals(1)) => {
        name: "zebra-direction",
        label: "Stripes run",
        placeholder: "DEGREES",
        text: "The direction of the zebra overlay's stripes in the view, counterclockwise: at 0 they run from left to right.",
        no_effect: without_zebra,
    }

    CHECKER_SQUARES: field!(checker_squares), Kind::Number(Range::new(1.0, 256.0, "").decimals(0).logarithmic()) => {
        name: "checker-squares",
        label: "Squares across",
        placeholder: "N",
        text: "How many squares the checker has side by side in one unit of texture coordinates, an image's width.",
        no_effect: |settings| only_if(settings.overlays.colors == Colors::UvChecker, "Only the UV checker has squares."),
    }

    TEXEL_DENSITY_PER: field!(texel_density_per), Kind::Choice(descriptions::<SurfaceUnit>) => {
        name: "texel-density-per",
        label: "Texels per",
        placeholder: "UNIT",
        text: "What the texel density overlay counts texels along.",
        no_effect: |settings| only_if(settings.overlays.colors == Colors::TexelDensity, "Only texel density counts texels."),
    }

    MATCAP: field!(matcap), Kind::Choice(descriptions::<Matcap>) => {
        name: "matcap",
        label: "Matcap",
        placeholder: "NAME",
        text: "The lit sphere whose colours the matcap overlay shows.",
        no_effect: |settings| only_if(settings.overlays.colors == Colors::Matcap, "Only the matcap overlay shows a lit sphere."),
    }
}

options! {
    /// The options of a picture as a whole.
    pub static PICTURE;

    SPLIT: field!(split), Kind::Number(Range::new(0.0, 1.0, "")) => {
        name: "split",
        label: "Divider",
        placeholder: "FRACTION",
        text: "Splits the picture at this fraction of its width. The left half shows the untessellated mesh, another tessellation or another mesh.",
        unset: Description::new("none", "None", "The picture isn't split."),
    }

    SPLIT_VIEW: field!(split_view), Kind::Choice(descriptions::<SplitView>) => {
        name: "split-view",
        label: "Shown as",
        placeholder: "NAME",
        text: "How both halves of a split picture are shown.",
        no_effect: not_split,
    }

    SPLIT_LEFT: LEFT, Kind::Options(|| &TESSELLATION) => {
        name: "split-left",
        label: "Left",
        placeholder: "SURFACE[,NAME=VALUE]",
        text: "The tessellation left of the split: a surface, and whatever else differs from the right half, such as \
               pn,lod=uniform,factor=8. The names are those of these options, and the scale of the deviation overlay is the same.",
        unset: Description::new("none", "Untessellated", "The mesh itself, with no tessellation."),
        no_effect: not_split,
    }

    SPLIT_LOOKS: LEFT_LOOKS, Kind::Options(|| &LOOKS) => {
        name: "split-looks",
        label: "Left looks",
        placeholder: "OVERLAY,..[,NAME=VALUE]",
        text: "What is drawn left of the split, and in which light: overlays, and whatever else differs from the right half, such as \
               zebra,wireframe,zebra-stripes=40; overlay= draws none. Outlines of the silhouette are always those of the right half.",
        unset: Description::new("same", "The same", "The left half looks as the right one does."),
        no_effect: not_split,
    }

    SECTION: field!(section), Kind::Choice(descriptions::<SectionAxis>) => {
        name: "section",
        label: "Section",
        placeholder: "AXIS",
        text: "Cuts the picture open with a plane across this axis, and draws what is beyond it; with a minus, what is before it. \
               Measurements stay, but what faces away is then tessellated, too.",
        unset: Description::new("none", "None", "All of the mesh is drawn."),
    }

    SECTION_AT: field!(section_at), Kind::Number(Range::new(0.0, 1.0, "")) => {
        name: "section-at",
        label: "Section at",
        placeholder: "FRACTION",
        text: "Where the section is: 0 is the least coordinate of the mesh along its axis, and 1 the largest.",
        no_effect: |settings| only_if(settings.section.is_some(), "There is no section."),
    }

    BACKGROUND: field!(background), Kind::Color => {
        name: "background",
        label: "Background",
        placeholder: "RRGGBB",
        text: "The sRGB colour behind the mesh. Without it, the window's theme chooses, and commands draw on 2b2e33.",
        unset: Description::new(
            "theme",
            "As the theme",
            "A dark grey in a dark theme, and a light one in a light theme.",
        ),
    }
}

options! {
    /// The options of commands that read a mesh.
    pub static IMPORT;

    MESH_NORMALS: field!(import.normals), Kind::Choice(descriptions::<NormalSource>) => {
        name: "mesh-normals",
        label: "Normals",
        placeholder: "NAME",
        text: "The normals that the corners of the mesh have. The shape of curved patches is made of them.",
    }

    CREASE_ANGLE: field!(import.crease_angle), Kind::Number(Range::new(0.0, 180.0, "°").decimals(0)) => {
        name: "crease-angle",
        label: "Crease angle",
        placeholder: "DEGREES",
        text: "Where normals are made, triangles that meet at up to this angle are smooth, others make a crease: 0 makes all flat, and \
               180 all smooth.",
    }

    /// It is saved with the file, as the camera is.
    UP: field!(import.up), Kind::Choice(descriptions::<UpAxis>) => {
        name: "up",
        label: "Up axis",
        placeholder: "AXIS",
        text: "The axis of the file's coordinates that points up. The mesh is turned, with everything that belongs to it.",
        unset: Description::new(
            "file",
            "As the file says",
            "FBX files say which axis points up. In glTF it is Y, in 3MF Z. OBJ, STL, PLY and OFF files don't say, and count as Y up.",
        ),
        saved_as: &[],
    }

    /// It is saved with the file too.
    UNIT: field!(import.unit), LENGTH_UNIT => {
        name: "unit",
        label: "Unit",
        placeholder: "UNIT",
        text: "The unit of the file's coordinates, by its name or as its length in metres. The mesh is scaled to metres, with everything \
               that belongs to it.",
        unset: Description::new(
            "file",
            "As the file says",
            "FBX and 3MF files say what their unit is; in 3MF it is the millimetre unless the file says otherwise. In glTF it is the metre. OBJ, STL, PLY and OFF \
             files don't say, and their numbers are taken as they are.",
        ),
        saved_as: &[],
    }

    SHOW_HIDDEN: field!(import.show_hidden), Kind::Switch => {
        name: "show-hidden",
        label: "Show hidden",
        text: "Also load the meshes that an FBX or glTF file hides, on nodes and layers that are switched off.",
    }

    SUBDIVIDE: field!(import.subdivide), Kind::Choice(descriptions::<Subdivide>) => {
        name: "subdivide",
        label: "Subdivide",
        placeholder: "SCHEME",
        text: "Take the polygons of a file other than glTF as the cage of a subdivision surface, and refine it.",
    }

    LEVELS: field!(import.levels), Kind::Number(Range::new(0.0, MOST_LEVELS as f32, "").decimals(0)) => {
        name: "levels",
        label: "Levels",
        placeholder: "N",
        text: "How often cages are refined. Each level has four times as many faces.",
        unset: Description::new("file", "As the file says", "As often as an FBX file says for its preview, or else twice."),
    }

    SUBDIVIDE_UVS: field!(import.subdivide_uvs), Kind::Choice(descriptions::<FaceVarying>) => {
        name: "subdivide-uvs",
        label: "Cage UVs",
        placeholder: "RULE",
        text: "How texture coordinates of cages are refined.",
        unset: Description::new("file", "As the file says", "As tags in an OBJ file say, or else linearly."),
    }
}

const LENGTH_UNIT: Kind = Kind::NameOrNumber {
    names: descriptions::<LengthUnit>,
    number: Description::new("METRES", "Another length", "The row below says how many metres a unit is long."),
    row: "Unit length",
    range: Range::new(*UNIT_METRES.start(), *UNIT_METRES.end(), "m").decimals(9).logarithmic(),
};

#[cfg(test)]
mod tests;
