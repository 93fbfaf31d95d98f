//! Gates: limits that a result is held to, so that a script fails where a mesh or a setting got worse. The numbers come from
//! the measurements; this room compares them with the limits, and says where the worst place is.

mod judgement;
mod limit;
mod mesh_defects;
mod place;
mod standpoint;

use std::fmt;
use std::str::FromStr;

pub use judgement::{Deviation, Facts, Found, Judgement, found_in_mesh, judge};
pub use limit::{Length, Limit, Unit};
pub use place::{EdgeSpot, PatchSpot, Place, Spot};
pub use standpoint::Standpoints;

use crate::settings::Overlay;
use geometry::choice::{Choice, choices};

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
        NonManifold => "non-manifold", "Edges of three triangles or more",
            "Every edge of the mesh belongs to at most two triangles.";
        Boundary => "boundary", "Edges of only one triangle",
            "The mesh has no open edge: no hole and no border.";
        Winding => "winding", "Edges whose two triangles are wound opposite ways",
            "Triangles that meet at an edge of the mesh are wound the same way.";
        NormalsAgainstFaces => "normals-against-faces", "Triangles with a normal that points behind them",
            "No normal of the mesh points to the back of its triangle, where a curved surface would fold.";
        Degenerate => "degenerate", "Triangles without an area",
            "Every triangle of the mesh has an area.";
        Duplicates => "duplicates", "Triangles with the corners of an earlier one",
            "No two triangles of the mesh have the same three corners.";
        NearSeam => "near-seam", "Open edges that nearly meet another one",
            "No open edge of the mesh nearly meets another one: one that should be welded.";
        HardEdges => "hard-edges", "Edges whose triangles have different normals",
            "No edge of the mesh has two normals at an end, along which an engine that displaces would tear it open.";
        Inflated => "inflated", "Triangles that smooth normals blow up at a hard edge",
            "No triangle bulges because an edge of more than 60 degrees has smooth normals.";
        SelfIntersections => "self-intersections", "Pairs of patches that the curved surface makes cross",
            "No two patches cross each other whose triangles in the mesh don't.";
        Deviation => "deviation", "Largest distance from --reference-surface, or back, for certain",
            "No point is farther from the reference surface, or from what was emitted, than the limit.";
        Pops => "pops", "Farthest jump on screen as the camera flies to where it is",
            "No point of the surface jumps farther on screen than the limit while the camera comes nearer.";
        Triangles => "triangles", "Emitted triangles",
            "There are no more triangles than allowed.";
        Bytes => "bytes", "Bytes of emitted vertices and indices",
            "Vertices and indices take no more memory than allowed.";
    }
}

impl GateKind {
    /// What it judges, and the overlays that show what it found, of which at most one colours the surface.
    const fn declared(self) -> (GateSubject, &'static [Overlay]) {
        use GateSubject::{Budget, Distance, Flight, Mesh, Survey, Tessellation};
        use Overlay::{Adjacency, Normals, Patches, Wireframe};
        match self {
            Self::Cracks => (Survey, &[Wireframe, Overlay::Cracks]),
            Self::Factors => (Survey, &[Wireframe, Overlay::Factors]),
            Self::Leaks => (Survey, &[Overlay::Cracks]),
            Self::Folds => (Survey, &[Wireframe, Overlay::Folds]),
            Self::TJunctions => (Mesh, &[Patches, Overlay::TJunctions]),
            Self::NonManifold | Self::Boundary | Self::Winding | Self::NearSeam | Self::HardEdges => {
                (Mesh, &[Wireframe, Adjacency])
            }
            Self::NormalsAgainstFaces | Self::Inflated => (Mesh, &[Patches, Normals]),
            Self::Degenerate | Self::Duplicates => (Mesh, &[Patches]),
            Self::Warnings => (Mesh, &[]),
            Self::AboveTolerance | Self::SelfIntersections => (Tessellation, &[Wireframe, Patches]),
            Self::Deviation => (Distance, &[Wireframe, Overlay::Deviation]),
            Self::Pops => (Flight, &[Wireframe, Patches]),
            Self::Triangles | Self::Bytes => (Budget, &[]),
        }
    }

    pub const fn subject(self) -> GateSubject {
        self.declared().0
    }

    pub const fn overlays(self) -> &'static [Overlay] {
        self.declared().1
    }

    /// What stands for the limit on the command line; none if it may be left out, and then none of what it counts is allowed.
    const fn limit_name(self) -> Option<&'static str> {
        match self.subject() {
            GateSubject::Mesh | GateSubject::Survey | GateSubject::Tessellation => None,
            GateSubject::Budget => Some("N"),
            GateSubject::Distance => Some("LENGTH"),
            GateSubject::Flight => Some("LENGTHpx"),
        }
    }

    /// How it is written on the command line: its name, and that of the number that it needs.
    pub fn placeholder(self) -> String {
        self.limit_name().map_or_else(|| self.name().to_owned(), |limit| format!("{}:{limit}", self.name()))
    }

    /// Whether it judges the mesh as it was loaded.
    pub const fn is_of_mesh(self) -> bool {
        matches!(self.subject(), GateSubject::Mesh)
    }

    /// Whether what it counts belongs to many sound meshes.
    pub const fn is_often_meant(self) -> bool {
        matches!(self, Self::Boundary | Self::HardEdges)
    }

    /// The limit where none is given; none if one must be.
    fn usual_limit(self) -> Option<Limit> {
        self.limit_name().is_none().then_some(Limit::Count(0))
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
    /// One tessellation: how far its triangles are from their surface, or whether they cross.
    Tessellation,
    /// How much is emitted.
    Budget,
    /// The distance from a reference surface.
    Distance,
    /// The tessellations of a camera that moves.
    Flight,
}

/// A limit that a result is held to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gate {
    pub kind: GateKind,
    /// The largest number that passes.
    pub limit: Limit,
}

/// Reads `NAME`, which allows none, or `NAME:N`, which allows up to N. Budgets need their N, distances a length, and flights px.
impl FromStr for Gate {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let (name, limit) = text.split_once(':').map_or((text, None), |(name, limit)| (name, Some(limit)));
        let names = || GateKind::ALL.map(GateKind::name).join(", ");
        let kind = GateKind::named(name).ok_or_else(|| format!("expected one of {}", names()))?;
        let (read, expected): (fn(&str) -> Option<Limit>, _) = match kind.subject() {
            GateSubject::Distance => (
                |text| text.parse().ok().map(Limit::Length),
                format!("a length after {name}, such as {name}:0.2mm, {name}:0.1% (of the diagonal) or {name}:0.003"),
            ),
            GateSubject::Flight => (Limit::from_px, format!("a number of px after {name}, such as {name}:0.1px")),
            GateSubject::Mesh | GateSubject::Survey | GateSubject::Tessellation | GateSubject::Budget => (
                |text| text.parse().ok().map(Limit::Count),
                format!("a whole number after {name}, such as {name}:100000"),
            ),
        };
        let limit = limit.map_or(kind.usual_limit(), read).ok_or_else(|| format!("expected {expected}"))?;
        Ok(Self { kind, limit })
    }
}

/// Writes the gate as the command line takes it.
impl fmt::Display for Gate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = self.kind.name();
        if self.kind.usual_limit() == Some(self.limit) { f.write_str(name) } else { write!(f, "{name}:{}", self.limit) }
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
            let counts = [0, 7, u64::MAX].map(Limit::Count);
            let lengths = ["0", "0.2mm", "0.1%"].map(|text| Limit::Length(text.parse().expect("a length")));
            let px = ["0", "0.1", "20"].map(|text| Limit::Px(text.parse().expect("a number")));
            let limits = match kind {
                GateKind::Deviation => lengths,
                GateKind::Pops => px,
                _ => counts,
            };
            for limit in limits {
                let gate = Gate { kind, limit };
                assert_eq!(gate.to_string().parse(), Ok(gate));
            }
        }
        assert_eq!("cracks".parse(), Ok(Gate { kind: GateKind::Cracks, limit: Limit::Count(0) }));
        for bad in [
            "",
            "crack",
            "triangles",
            "bytes:",
            "cracks:-1",
            "cracks:1.5",
            "triangles:1e6",
            "cracks:0:0",
            "deviation",
            "deviation:-1",
            "deviation:1px",
            "pops",
            "pops:1",
        ] {
            assert!(bad.parse::<Gate>().is_err(), "{bad}");
        }
        let said = "odd".parse::<Gate>().expect_err("no such gate");
        assert!(said.contains("cracks, factors, leaks") && said.contains("bytes"), "{said}");
    }
}
