//! The names of how the geometry of a file is taken.

use super::value::Field;
use super::{Choice, Value, choices};
use geometry::mesh::UpAxis;
use load::{FileUnit, LengthUnit, NormalSource};

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
