//! The names of how the geometry of a file is taken.

use super::value::Field;
use super::{Choice, Description, Value};
use geometry::mesh::UpAxis;
use geometry::names::every;
use load::{FileUnit, LengthUnit, NormalSource};

impl Choice for NormalSource {
    const ALL: &'static [Self] = &every![NormalSource: File, Made];

    fn description(self) -> Description {
        match self {
            Self::File => Description::new(
                "file",
                "Of the file",
                "Corners have the normals of the file. Where it has none, or one without a direction, they are made.",
            ),
            Self::Made => Description::new(
                "made",
                "Made anew",
                "All normals are made from the triangles around each point, weighted by angle, as if the file had none. Its \
                 smoothing groups and tangents aren't used then.",
            ),
        }
    }
}

impl Choice for UpAxis {
    const ALL: &'static [Self] = &every![UpAxis: Y, Z, X, NegX, NegY, NegZ];

    fn description(self) -> Description {
        let (name, label, text) = match self {
            Self::Y => ("y", "Y", "The y axis points up."),
            Self::Z => ("z", "Z", "The z axis points up, as in most programs for construction, printing and maps."),
            Self::X => ("x", "X", "The x axis points up."),
            Self::NegX => ("-x", "-X", "The x axis points down."),
            Self::NegY => ("-y", "-Y", "The y axis points down."),
            Self::NegZ => ("-z", "-Z", "The z axis points down."),
        };
        Description::new(name, label, text)
    }
}

impl Choice for LengthUnit {
    const ALL: &'static [Self] = &every![LengthUnit: Millimetre, Centimetre, Metre, Inch, Foot];

    fn description(self) -> Description {
        match self {
            Self::Millimetre => Description::new("mm", "Millimetre", "Coordinates are in millimetres."),
            Self::Centimetre => Description::new("cm", "Centimetre", "Coordinates are in centimetres."),
            Self::Metre => Description::new("m", "Metre", "Coordinates are in metres."),
            Self::Inch => Description::new("in", "Inch", "Coordinates are in inches of 2.54 cm."),
            Self::Foot => Description::new("ft", "Foot", "Coordinates are in feet of 30.48 cm."),
        }
    }
}

impl Field for FileUnit {
    fn value(&self) -> Value {
        match self {
            Self::Named(unit) => Value::Name(unit.name()),
            Self::Metres(metres) => Value::Number(*metres),
        }
    }

    fn of(value: Value) -> Option<Self> {
        match value {
            Value::Name(name) => LengthUnit::named(name).map(Self::Named),
            Value::Number(metres) => Self::of_metres(metres),
            _ => None,
        }
    }
}
