//! The largest number that passes a gate: how many of what it counts, or a length.

use std::fmt;
use std::str::FromStr;

use serde::{Serialize, Serializer};

use geometry::choice::Choice;
use geometry::numbers::grouped;
use load::LengthUnit;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    Count(u64),
    Length(Length),
    /// A distance on screen.
    Px(f64),
}

/// A length as it was given: a number of 0 or more, and its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Length {
    pub number: f64,
    pub unit: Unit,
}

/// What a length is given in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unit {
    /// Object units.
    Object,
    /// A unit of length; object units count as metres.
    Named(LengthUnit),
    /// Percent of the reference surface's diagonal.
    OfDiagonal,
}

impl Length {
    /// The length in object units, beside a surface with this diagonal.
    pub fn in_units(self, diagonal: f64) -> f64 {
        self.number
            * match self.unit {
                Unit::Object => 1.0,
                Unit::Named(unit) => unit.metres(),
                Unit::OfDiagonal => diagonal / 100.0,
            }
    }
}

/// Reads a number of 0 or more, with the name of a unit or `%` after it, or nothing.
impl FromStr for Length {
    type Err = ();

    fn from_str(text: &str) -> Result<Self, ()> {
        let number = text.trim_end_matches(|letter: char| letter.is_ascii_lowercase() || letter == '%');
        let unit = match text[number.len()..].trim() {
            "" => Unit::Object,
            "%" => Unit::OfDiagonal,
            name => Unit::Named(LengthUnit::named(name).ok_or(())?),
        };
        let number: f64 = number.trim().parse().map_err(drop)?;
        if number.is_finite() && number.is_sign_positive() { Ok(Self { number, unit }) } else { Err(()) }
    }
}

impl fmt::Display for Length {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = match self.unit {
            Unit::Object => "",
            Unit::Named(unit) => unit.name(),
            Unit::OfDiagonal => "%",
        };
        write!(f, "{}{unit}", self.number)
    }
}

/// Writes the limit as the command line takes it.
impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Count(count) => write!(f, "{count}"),
            Self::Length(length) => write!(f, "{length}"),
            Self::Px(px) => write!(f, "{px}px"),
        }
    }
}

impl Limit {
    /// Reads a number of 0 or more with `px` after it.
    pub(super) fn from_px(text: &str) -> Option<Self> {
        let px: f64 = text.strip_suffix("px")?.trim().parse().ok()?;
        (px.is_finite() && px.is_sign_positive()).then_some(Self::Px(px))
    }

    /// What the limit says, as the end of a clause.
    pub fn allowed(self) -> String {
        match self {
            Self::Count(1) => "where 1 is allowed".to_owned(),
            Self::Count(count) => format!("where {} are allowed", grouped(count)),
            Self::Length(length @ Length { unit: Unit::Object, .. }) => {
                format!("where {length} object units are allowed")
            }
            Self::Length(length) => format!("where {length} is allowed"),
            Self::Px(_) => format!("where {self} is allowed"),
        }
    }

    /// The largest count that passes; none if the limit is another.
    pub fn count(self) -> Option<u64> {
        match self {
            Self::Count(count) => Some(count),
            Self::Length(_) | Self::Px(_) => None,
        }
    }
}

/// A number, or a length or distance as text.
impl Serialize for Limit {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Count(count) => serializer.serialize_u64(*count),
            Self::Length(_) | Self::Px(_) => serializer.collect_str(self),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_units_and_are_read_as_they_are_written() {
        let units = |text: &str| text.parse::<Length>().expect("a length").in_units(50.0);
        let near = |a: f64, b: f64| (a - b).abs() < 1e-15;
        assert!(near(units("0.2mm"), 2e-4) && near(units("2 cm"), 0.02) && near(units("0.1%"), 0.05));
        assert!(near(units("1in"), 0.0254) && near(units("0"), 0.0) && near(units("1e-3"), 1e-3));
        for text in ["0.2mm", "0.1%", "3", "0.0254in"] {
            assert_eq!(text.parse::<Length>().expect("a length").to_string(), text);
        }
        assert_eq!(Limit::from_px("0.1px"), Some(Limit::Px(0.1)));
        for bad in ["0.1", "px", "-1px", "infpx", "1 pxx", "1mm"] {
            assert_eq!(Limit::from_px(bad), None, "{bad}");
        }
        for bad in ["", "mm", "-1", "-0", "inf", "NaN", "1px", "1 %%", "0.2mmm", "1e-3 e"] {
            assert!(bad.parse::<Length>().is_err(), "{bad}");
        }
    }
}
