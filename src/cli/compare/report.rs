//! What `compare` prints: sentences and numbers for people, or JSON.

use std::fmt::Write;

use glam::Vec3;
use serde::Serialize;
use serde_json::{Value, json};

use geometry::names::shown;
use geometry::numbers::{counted, grouped, numbered, short};
use lab::compare::{Comparison, Farthest, Finding, OurTessellation, SideDifference, Tolerances, point};

/// How many sides are printed, and how many JSON has.
const SAID: usize = 10;
const LISTED: usize = 10_000;

/// A comparison with the names of what was compared.
pub(super) struct Report<'a> {
    pub theirs: &'a str,
    pub mesh: &'a str,
    pub ours: &'a OurTessellation<'a>,
    pub comparison: &'a Comparison,
    pub exactness: Tolerances,
}

impl Report<'_> {
    /// Sentences, the most important first, and then numbers.
    pub(super) fn text(&self) -> String {
        let found = self.comparison;
        let mut text = String::new();
        // Writing into a String can't fail.
        if found.findings.is_empty() {
            let _ = writeln!(text, "{} is the same tessellation of {} as ours.", self.theirs, shown(self.mesh));
        }
        text.extend(found.findings.iter().map(|finding| format!("{finding}\n")));
        let _ = writeln!(
            text,
            "\n{} and {} on {} of {} patches; ours are {}.",
            counted(found.triangles, "triangle"),
            numbered(found.vertices, "# [vertex|vertices]"),
            grouped(found.patches),
            grouped(self.ours.topology.patches.len() as u64),
            counted(self.ours.tessellated.triangles.len() as u64, "triangle")
        );
        let _ = writeln!(text, "Largest distance of a vertex from the surface: {}.", self.distance(found.from_surface));
        if let Some(farthest) = found.farthest {
            let distance = self.distance(farthest.distance);
            let _ = writeln!(text, "Largest distance from our vertex at the same domain point: {distance}.");
        }
        let _ = writeln!(text, "Vertices are the same within {}.", self.distance(self.exactness.within));
        self.write_sides(&mut text);
        text
    }

    /// A distance in object units, ULP, and as a part of the diagonal.
    fn distance(&self, distance: f64) -> String {
        let Comparison { ulp, diagonal, .. } = self.comparison;
        let [units, ulps, part] = [distance, distance / ulp, distance / diagonal].map(short);
        format!("{units} object units ({ulps} ULP, {part} of the diagonal)")
    }

    /// Lists the sides that are cut differently.
    fn write_sides(&self, text: &mut String) {
        let sides = &self.comparison.sides;
        if sides.is_empty() {
            return;
        }
        let count = sides.len();
        let _ = match count > SAID {
            true => writeln!(text, "\nThe {SAID} sides that differ the most, of {}:", grouped(count as u64)),
            false => writeln!(text, "\nSides that are cut differently:"),
        };
        for side in sides.iter().take(SAID) {
            let SideDifference { triangle, side: k, ends, theirs, ours } = side;
            let [from, to] = ends.map(|end| point(Vec3::from(end).as_dvec3()));
            let _ = writeln!(
                text,
                "triangle {triangle}, corners {k} to {}, {from} to {to}: {} (factor {}), ours {} (factor {})",
                (k + 1) % 3,
                counted(theirs.segments, "segment"),
                short(theirs.factor),
                ours.segments,
                short(ours.factor)
            );
        }
    }

    pub(super) fn json(&self) -> Json<'_> {
        let found = self.comparison;
        let distance = |units: f64| Distance { units, ulp: units / found.ulp, of_diagonal: units / found.diagonal };
        let place = |farthest: Farthest| Place {
            triangle: self.ours.topology.patches[farthest.patch as usize].triangle,
            theirs: farthest.theirs.to_array(),
            ours: farthest.ours.to_array(),
            distance: distance(farthest.distance),
        };
        let finding = |finding: &Finding| json!({ "kind": finding.kind(), "text": finding.to_string() });
        let triangle = |patch: &u32| self.ours.topology.patches[*patch as usize].triangle;
        Json {
            theirs: self.theirs,
            mesh: self.mesh,
            same: found.findings.is_empty(),
            findings: found.findings.iter().map(finding).collect(),
            vertices: found.vertices,
            triangles: found.triangles,
            our_triangles: self.ours.tessellated.triangles.len() as u64,
            patches: self.ours.topology.patches.len() as u64,
            patches_with_triangles: found.patches,
            within: distance(self.exactness.within),
            from_surface: distance(found.from_surface),
            farthest: found.farthest.map(place),
            sides_different: found.sides.len() as u64,
            sides: &found.sides[..found.sides.len().min(LISTED)],
            triangles_different: found.different.iter().take(LISTED).map(triangle).collect(),
            triangles_missing: found.missing.iter().take(LISTED).map(triangle).collect(),
        }
    }
}

/// The comparison for programs.
#[derive(Debug, Serialize)]
pub(super) struct Json<'a> {
    theirs: &'a str,
    mesh: &'a str,
    same: bool,
    findings: Vec<Value>,
    vertices: u64,
    triangles: u64,
    our_triangles: u64,
    patches: u64,
    patches_with_triangles: u64,
    within: Distance,
    from_surface: Distance,
    farthest: Option<Place>,
    sides_different: u64,
    sides: &'a [SideDifference],
    /// Triangles of the mesh whose patches differ, and those whose patches have no triangles.
    triangles_different: Vec<u32>,
    triangles_missing: Vec<u32>,
}

#[derive(Debug, Serialize)]
struct Distance {
    units: f64,
    ulp: f64,
    of_diagonal: f64,
}

#[derive(Debug, Serialize)]
struct Place {
    triangle: u32,
    theirs: [f64; 3],
    ours: [f64; 3],
    distance: Distance,
}
