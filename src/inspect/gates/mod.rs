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

use crate::settings::Overlay;
use geometry::choice::{Choice, choices};
use geometry::numbers::grouped;

choices! {
    /// What a gate counts, which its label says, and what passing it means, which its text says.
    pub enum GateKind {
        Cracks => "cracks", "Edges whose sides have points at different positions",
            "Both sides of every edge have the same points and the same factors.";
        Factors => "factors", "Edges whose sides were given different factors",
            "Both sides of every edge were given the same factor.";
        Leaks => "leaks", "Px through which one can see into a closed mesh",
            "No pixel shows the inside of a closed mesh.";
        Folds => "folds", "Triangles that face away from the side that their patch faces",
            "No triangle faces away from the side that its patch faces.";
        TJunctions => "t-junctions", "T-junctions of the mesh",
            "No point of the mesh lies between the ends of another triangle's open edge.";
        Warnings => "warnings", "Warnings of loading",
            "Loading repaired nothing and left nothing out.";
        AboveTolerance => "above-tolerance", "Patches whose error on screen is above --tolerance",
            "No patch is farther from its surface on screen than the tolerance.";
        Triangles => "triangles", "Emitted triangles",
            "There are no more triangles than allowed.";
        Bytes => "bytes", "Bytes of emitted vertices and indices",
            "Vertices and indices take no more memory than allowed.";
    }
}

impl GateKind {
    /// What it judges.
    pub const fn subject(self) -> GateSubject {
        match self {
            Self::TJunctions | Self::Warnings => GateSubject::Mesh,
            Self::Cracks | Self::Factors | Self::Leaks | Self::Folds => GateSubject::Survey,
            Self::AboveTolerance => GateSubject::Error,
            Self::Triangles | Self::Bytes => GateSubject::Budget,
        }
    }

    /// The overlays that show what it found. At most one of them colours the surface.
    pub(crate) const fn overlays(self) -> &'static [Overlay] {
        match self {
            Self::Cracks => &[Overlay::Wireframe, Overlay::Cracks],
            Self::Factors => &[Overlay::Wireframe, Overlay::Factors],
            Self::Leaks => &[Overlay::Cracks],
            Self::Folds => &[Overlay::Wireframe, Overlay::Folds],
            Self::TJunctions => &[Overlay::Patches, Overlay::TJunctions],
            Self::AboveTolerance => &[Overlay::Wireframe, Overlay::Patches],
            Self::Warnings | Self::Triangles | Self::Bytes => &[],
        }
    }

    /// How it is written on the command line: its name, and that of the number that it needs.
    pub fn placeholder(self) -> String {
        if self.is_budget() { format!("{}:N", self.name()) } else { self.name().to_owned() }
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
        let kind = GateKind::named(name).ok_or_else(|| format!("expected one of {}", names()))?;
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
    use crate::settings::Overlays;

    #[test]
    fn gates_are_read_as_they_are_written() {
        for kind in GateKind::ALL {
            assert!(Overlays::new(kind.overlays()).is_some(), "{kind:?}: two overlays colour the surface");
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
