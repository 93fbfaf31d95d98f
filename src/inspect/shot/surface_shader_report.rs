//! Where the control points of a surface shader of the user's own disagree.

use std::io::Write;

use serde::Serialize;

use super::factors_report::{LISTED, SAID, end_points, point_text};
use crate::engine::Engine;
use crate::measure::{PointsAgreement, PointsDisagreement};
use crate::render::Scene;
use geometry::mesh::Topology;
use geometry::numbers::short;
use gpu::GpuError;

/// Reports on standard error where the control points of a surface shader disagree, if the scene has one, and how many aren't
/// numbers. The counts must be known.
///
/// # Errors
/// The device was lost.
pub fn report_own_surface(engine: &Engine, scene: &Scene) -> Result<(), GpuError> {
    let Some(agreement) = engine.own_points_agreement(scene)? else { return Ok(()) };
    for line in lines(scene.tessellator.topology(), &agreement) {
        let _ = writeln!(std::io::stderr(), "pnaen: {line}");
    }
    if let Some(said) = straight_sides_said(not_numbers(scene)) {
        let _ = writeln!(std::io::stderr(), "pnaen: warning: {said}");
    }
    Ok(())
}

/// What is said about sides whose control points aren't numbers, if there are any.
pub fn straight_sides_said(count: u32) -> Option<String> {
    match count {
        0 => None,
        1 => Some(
            "1 side got a control point of the surface shader that is infinite or no number (NaN): it is straight."
                .to_owned(),
        ),
        _ => Some(format!(
            "{count} sides got control points of the surface shader that are infinite or no numbers (NaN): they are straight."
        )),
    }
}

fn not_numbers(scene: &Scene) -> u32 {
    scene.tessellator.own_surface_report().map_or(0, |report| report.not_numbers)
}

/// Which edges disagree, as lines for standard error.
fn lines(topology: &Topology, agreement: &PointsAgreement) -> Vec<String> {
    let (different, compared) = (agreement.edges.len(), agreement.edges_compared);
    let mut lines = vec![format!("{different} of {compared} edges have different control points on their sides")];
    if different > SAID {
        lines.push(format!("the {SAID} edges that differ the most:"));
    }
    lines.extend(agreement.edges.iter().take(SAID).map(|edge| edge_text(topology, edge)));
    lines
}

fn edge_text(topology: &Topology, edge: &PointsDisagreement) -> String {
    let ([a, b], [one, other]) = (end_points(topology, edge.edge).map(point_text), edge.triangles);
    format!(
        "{a} to {b}: {} object units between the control points of triangles {one} and {other}",
        short(edge.distance)
    )
}

/// The same as JSON.
#[derive(Debug, Serialize)]
pub struct SurfaceShaderStats {
    edges_compared: u64,
    edges_different: u64,
    /// The largest distance between control points that should be the same, in object units.
    max_distance: f64,
    /// Sides that are straight, because a control point is infinite or NaN.
    not_numbers: u32,
    /// The largest distances first, at most [`LISTED`].
    edges: Vec<EdgePointsStats>,
}

#[derive(Debug, Serialize)]
struct EdgePointsStats {
    /// The edge's ends, in object units.
    points: [[f32; 3]; 2],
    /// The triangles of the two sides that are farthest apart.
    triangles: [u32; 2],
    distance: f64,
}

impl SurfaceShaderStats {
    /// Of a scene with a surface shader; none of others. The counts must be known.
    ///
    /// # Errors
    /// The device was lost.
    pub fn of(engine: &Engine, scene: &Scene) -> Result<Option<Self>, GpuError> {
        let Some(agreement) = engine.own_points_agreement(scene)? else { return Ok(None) };
        let topology = scene.tessellator.topology();
        let edge = |edge: &PointsDisagreement| EdgePointsStats {
            points: end_points(topology, edge.edge),
            triangles: edge.triangles,
            distance: edge.distance,
        };
        Ok(Some(Self {
            edges_compared: agreement.edges_compared,
            edges_different: agreement.edges.len() as u64,
            max_distance: agreement.max_distance(),
            not_numbers: not_numbers(scene),
            edges: agreement.edges.iter().take(LISTED).map(edge).collect(),
        }))
    }
}
