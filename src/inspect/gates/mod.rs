//! Gates: limits that a result is held to, so that a script fails where a mesh or a setting got worse. The numbers come from
//! the measurements; this room compares them with the limits, and says where the worst place is.

mod judgement;
mod place;
mod standpoint;

use std::fmt;
use std::str::FromStr;

pub use judgement::{Facts, Judgement, judge};
pub use place::{EdgeSpot, PatchSpot, Place, Spot};
pub use standpoint::Standpoints;

use geometry::names::every;
use geometry::numbers::grouped;

/// What a gate counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GateKind {
    /// Edges whose sides have points at different positions.
    Cracks,
    /// Edges whose sides were given different factors.
    Factors,
    /// Px through which one can see into a closed mesh.
    Leaks,
    /// Triangles that face away from the side that their patch faces.
    Folds,
    /// T-junctions of the mesh.
    TJunctions,
    /// Warnings that loading gave.
    Warnings,
    /// Patches that are farther from their surface than the tolerance, in px on screen.
    AboveTolerance,
    /// Emitted triangles.
    Triangles,
    /// The memory of emitted vertices and indices, in bytes.
    Bytes,
}

impl GateKind {
    pub const ALL: [Self; 9] = every![
        GateKind: Cracks, Factors, Leaks, Folds, TJunctions, Warnings, AboveTolerance, Triangles, Bytes
    ];

    /// The name on the command line and in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Cracks => "cracks",
            Self::Factors => "factors",
            Self::Leaks => "leaks",
            Self::Folds => "folds",
            Self::TJunctions => "t-junctions",
            Self::Warnings => "warnings",
            Self::AboveTolerance => "above-tolerance",
            Self::Triangles => "triangles",
            Self::Bytes => "bytes",
        }
    }

    /// What passing the gate means, in a sentence.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Cracks => "Both sides of every edge have the same points and the same factors.",
            Self::Factors => "Both sides of every edge were given the same factor.",
            Self::Leaks => "No pixel shows the inside of a closed mesh.",
            Self::Folds => "No triangle faces away from the side that its patch faces.",
            Self::TJunctions => "No point of the mesh lies between the ends of another triangle's open edge.",
            Self::Warnings => "Loading repaired nothing and left nothing out.",
            Self::AboveTolerance => "No patch is farther from its surface on screen than the tolerance.",
            Self::Triangles => "There are no more triangles than allowed.",
            Self::Bytes => "Vertices and indices take no more memory than allowed.",
        }
    }

    /// What it judges.
    pub const fn subject(self) -> GateSubject {
        match self {
            Self::TJunctions | Self::Warnings => GateSubject::Mesh,
            Self::Cracks | Self::Factors | Self::Leaks | Self::Folds => GateSubject::Survey,
            Self::AboveTolerance => GateSubject::Error,
            Self::Triangles | Self::Bytes => GateSubject::Budget,
        }
    }

    /// Whether it judges one tessellation, so that it says nothing of many.
    pub const fn is_of_one_tessellation(self) -> bool {
        matches!(self.subject(), GateSubject::Error | GateSubject::Budget)
    }

    /// Whether it judges the mesh as it was loaded.
    pub const fn is_of_mesh(self) -> bool {
        matches!(self.subject(), GateSubject::Mesh)
    }

    /// Whether it judges how much there is, so that a limit of 0 would make no sense.
    const fn is_budget(self) -> bool {
        matches!(self.subject(), GateSubject::Budget)
    }

    /// Whether it is judged by what a survey of the emitted mesh finds.
    pub const fn needs_survey(self) -> bool {
        matches!(self.subject(), GateSubject::Survey)
    }
}

/// What a gate judges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GateSubject {
    /// The mesh as it was loaded.
    Mesh,
    /// What a survey of the emitted mesh finds.
    Survey,
    /// How far triangles are from their surface on screen.
    Error,
    /// How much is emitted.
    Budget,
}

/// A limit that a result is held to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gate {
    pub kind: GateKind,
    /// The largest number that passes.
    pub limit: u64,
}

/// Reads `NAME`, which allows none, or `NAME:N`, which allows up to N. Budgets need their N.
impl FromStr for Gate {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let (name, limit) = text.split_once(':').map_or((text, None), |(name, limit)| (name, Some(limit)));
        let names = || GateKind::ALL.map(GateKind::name).join(", ");
        let kind = GateKind::ALL.into_iter().find(|kind| kind.name() == name);
        let kind = kind.ok_or_else(|| format!("expected one of {}", names()))?;
        let limit = match limit {
            Some(limit) => limit.parse().ok(),
            None if kind.is_budget() => None,
            None => Some(0),
        };
        let expected = || format!("expected a whole number after {name}, such as {name}:100000");
        Ok(Self { kind, limit: limit.ok_or_else(expected)? })
    }
}

/// What a limit says, as the end of a clause.
pub fn allowed(limit: u64) -> String {
    format!("where {} {} allowed", grouped(limit), if limit == 1 { "is" } else { "are" })
}

/// Writes the gate as the command line takes it.
impl fmt::Display for Gate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.limit {
            0 if !self.kind.is_budget() => f.write_str(self.kind.name()),
            limit => write!(f, "{}:{limit}", self.kind.name()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gates_are_read_as_they_are_written() {
        for kind in GateKind::ALL {
            for limit in [0, 7, u64::MAX] {
                let gate = Gate { kind, limit };
                assert_eq!(gate.to_string().parse(), Ok(gate));
            }
        }
        assert_eq!("cracks".parse(), Ok(Gate { kind: GateKind::Cracks, limit: 0 }));
        for bad in ["", "crack", "triangles", "bytes:", "cracks:-1", "cracks:1.5", "triangles:1e6", "cracks:0:0"] {
            assert!(bad.parse::<Gate>().is_err(), "{bad}");
        }
        let said = "odd".parse::<Gate>().expect_err("no such gate");
        assert!(said.contains("cracks, factors, leaks") && said.contains("bytes"), "{said}");
    }
}
