//! The names of how the geometry of a file is taken.

use super::value::Field;
use super::{Choice, Value, choices};
use geometry::mesh::UpAxis;
use load::{FileUnit, LengthUnit, NormalSource};

choices! { NormalSource:
    File => "file", "Of the file",
        "Corners have the normals of the file. Where it has none, or one without a direction, they are made.";
    Made => "made", "Made anew",
        "All normals are made from the triangles around each point, weighted by angle, as if the file had none. Its \
         smoothing groups and tangents aren't used then.";
}

choices! { UpAxis:
    Y => "y", "Y", "The y axis points up.";
    Z => "z", "Z", "The z axis points up, as in most programs for construction, printing and maps.";
    X => "x", "X", "The x axis points up.";
    NegX => "-x", "-X", "The x axis points down.";
    NegY => "-y", "-Y", "The y axis points down.";
    NegZ => "-z", "-Z", "The z axis points down.";
}

choices! { LengthUnit:
    Millimetre => "mm", "Millimetre", "Coordinates are in millimetres.";
    Centimetre => "cm", "Centimetre", "Coordinates are in centimetres.";
    Metre => "m", "Metre", "Coordinates are in metres.";
    Inch => "in", "Inch", "Coordinates are in inches of 2.54 cm.";
    Foot => "ft", "Foot", "Coordinates are in feet of 30.48 cm.";
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
