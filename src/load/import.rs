//! How the geometry of a file is taken: whose normals, which axis points up, and how long its unit is.

use geometry::casts::to_byte;
use geometry::choice::choices;
use geometry::defaults::with_defaults;
use geometry::mesh::normals::{CREASE_ANGLE, NormalSource};
use geometry::mesh::orientation::reorient;
use geometry::mesh::subdivision::{Boundary, FaceVarying, Scheme};
use geometry::mesh::{Mesh, PartStyle, UpAxis};

choices! {
    /// Whether polygons are taken as the cage of a subdivision surface.
    #[derive(Default, Hash)]
    pub enum Subdivide {
        #[default]
        File => "file", "As the file says",
            "What an FBX file marks as a subdivision surface is refined.";
        Off => "none", "None", "Polygons are drawn as they are.";
        CatmullClark => "catmull-clark", "Catmull-Clark",
            "Polygons are the cage of a Catmull-Clark surface. Refined points and their normals are those of its limit.";
        Loop => "loop", "Loop", "Triangles are the cage of a Loop surface. Refined points and their normals are those of its limit.";
        Butterfly => "butterfly", "Butterfly", "Triangles are the cage of a butterfly surface, which goes through their corners.";
    }
}

/// How often cages can be refined, and how often they are if nothing is said.
pub const MOST_LEVELS: u8 = 6;
const USUAL_LEVELS: u32 = 2;

/// How a cage is refined.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Subdivision {
    pub scheme: Scheme,
    pub levels: u8,
    pub boundary: Boundary,
    pub face_varying: FaceVarying,
}

choices! {
    /// A unit of length with a name.
    #[derive(Hash)]
    pub enum LengthUnit {
        Millimetre => "mm", "Millimetre", "Coordinates are in millimetres.";
        Centimetre => "cm", "Centimetre", "Coordinates are in centimetres.";
        Metre => "m", "Metre", "Coordinates are in metres.";
        Inch => "in", "Inch", "Coordinates are in inches of 2.54 cm.";
        Foot => "ft", "Foot", "Coordinates are in feet of 30.48 cm.";
    }
}

impl LengthUnit {
    /// Its length in metres. Inch and foot are the international ones (National Bureau of Standards 1959, "Refinement of values for
    /// the yard and the pound").
    pub fn metres(self) -> f64 {
        match self {
            Self::Millimetre => 0.001,
            Self::Centimetre => 0.01,
            Self::Metre => 1.0,
            Self::Inch => 0.0254,
            Self::Foot => 0.3048,
        }
    }
}

/// The lengths that a unit without a name may have, in metres.
pub const UNIT_METRES: std::ops::RangeInclusive<f32> = 1e-9..=1e9;

/// The unit of a file's coordinates, as it was chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FileUnit {
    Named(LengthUnit),
    /// Its length in metres, which is in [`UNIT_METRES`].
    Metres(f32),
}

impl FileUnit {
    /// A unit of this length; none if no unit may have it.
    pub fn from_metres(metres: f32) -> Option<Self> {
        UNIT_METRES.contains(&metres).then_some(Self::Metres(metres))
    }

    /// Its length in metres. A length that was written is taken as its shortest decimal form, so that 0.0254 is exactly an inch.
    pub fn metres(self) -> f64 {
        match self {
            Self::Named(unit) => unit.metres(),
            Self::Metres(metres) => metres.to_string().parse().unwrap_or(f64::from(metres)),
        }
    }
}

with_defaults! {
    /// How the geometry of a file is taken.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Import {
        pub normals: NormalSource = NormalSource::File,
        /// The angle up to which faces are smooth where normals are made, in degrees from 0 to 180.
        pub crease_angle: f32 = CREASE_ANGLE,
        /// The axis of the file's coordinates that points up; none for that which the file or its format says, or else Y.
        pub up: Option<UpAxis> = None,
        /// The unit of the file's coordinates; none for that which the file or its format says, or else the metre.
        pub unit: Option<FileUnit> = None,
        /// Whether what the file hides is loaded too.
        pub show_hidden: bool = false,
        pub subdivide: Subdivide = Subdivide::File,
        /// How often cages are refined, a whole number up to [`MOST_LEVELS`]; none for as often as the file says, or else twice.
        pub levels: Option<f32> = None,
        /// How texture coordinates of cages are refined; none for what the file says, or else linearly.
        pub subdivide_uvs: Option<FaceVarying> = None,
    }
}

/// What stands in the warning about normals that a file lacks, between what lacks them and what becomes of it.
const WHICH_ARE: &str = ", which are ";

/// Whether a warning is that about normals that a file lacks.
pub fn is_of_lacking_normals(warning: &str) -> bool {
    let are = |how: &str| warning.contains(&[WHICH_ARE, how].concat());
    warning.contains("without normals") && (are("flat") || are("smoothed below"))
}

impl Import {
    /// How all polygons are refined; none if none are, or the file says which.
    pub(super) fn subdivision(&self) -> Option<Subdivision> {
        let scheme = match self.subdivide {
            Subdivide::File | Subdivide::Off => return None,
            Subdivide::CatmullClark => Scheme::CatmullClark,
            Subdivide::Loop => Scheme::Loop,
            Subdivide::Butterfly => Scheme::Butterfly,
        };
        let face_varying = self.subdivide_uvs.unwrap_or_default();
        Some(Subdivision { scheme, levels: self.levels_or(USUAL_LEVELS), face_varying, ..Subdivision::default() })
    }

    /// Whether all polygons are refined, whatever the file says.
    pub fn refines_all(&self) -> bool {
        self.subdivision().is_some()
    }

    /// How often cages are refined of which the file says so many times.
    pub(super) fn levels_or(&self, of_file: u32) -> u8 {
        let of_file = u8::try_from(of_file).unwrap_or(MOST_LEVELS);
        self.levels.map_or(of_file, |levels| to_byte(levels.round())).min(MOST_LEVELS)
    }

    /// Whether the normals are made of what has this style.
    pub(super) fn makes_normals_of(self, own: PartStyle) -> bool {
        own.normals.unwrap_or(self.normals) == NormalSource::Made
    }

    /// Axis and unit alone, as another file of the same scene takes them.
    pub fn placement(self) -> Self {
        Self { up: self.up, unit: self.unit, ..Self::default() }
    }

    /// The warning about `count` parts of a file that lack normals, with what these are and what becomes of them. Where all normals are
    /// made, none is missed.
    pub(super) fn lacking_normals(&self, count: usize, what: &str) -> (usize, String) {
        let count = if self.normals == NormalSource::Made { 0 } else { count };
        let shown = match self.crease_angle {
            0.0 => "flat".to_owned(),
            angle => format!("smoothed below {angle} degrees"),
        };
        (count, format!("{what}{WHICH_ARE}{shown}"))
    }

    /// Turns and scales a mesh as the axis and the unit say that were chosen, so that Y points up and the unit is the metre.
    pub(super) fn place(&self, mesh: &mut Mesh) {
        reorient(mesh, self.up.unwrap_or_default(), self.unit.map_or(1.0, FileUnit::metres));
    }
}

#[cfg(test)]
mod tests;
