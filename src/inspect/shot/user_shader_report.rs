//! Where what shaders of the user's own give disagrees: factors of an LOD shader, control points of a surface shader.

use std::io::Write;

use serde::Serialize;

use super::factors_report::{EdgeStats, LISTED, agreement_lines, different_lines, end_points, point_text};
use crate::engine::Engine;
use crate::measure::{Agreement, PointsAgreement, PointsDisagreement};
use crate::render::Scene;
use geometry::mesh::Topology;
use geometry::numbers::{numbered, short};
use gpu::{GpuError, UserReport};

/// Reports on standard error where the factors of an LOD shader disagree, if the scene has one, and how many aren't numbers. The
/// counts must be known.
///
/// # Errors
/// The device was lost.
pub fn report_user_lod(engine: &Engine, scene: &Scene) -> Result<(), GpuError> {
    if let Some(agreement) = agreement(engine, scene)? {
        let lines = agreement_lines(scene.tessellator.topology(), &agreement);
        report(&lines, not_numbers_said(not_numbers(scene.tessellator.user_lod_report())));
    }
    Ok(())
}

/// Reports on standard error where the control points of a surface shader disagree, if the scene has one, and how many aren't
/// numbers. The counts must be known.
///
/// # Errors
/// The device was lost.
pub fn report_user_surface(engine: &Engine, scene: &Scene) -> Result<(), GpuError> {
    if let Some(agreement) = engine.user_points_agreement(scene)? {
        let topology = scene.tessellator.topology();
        let counts = [agreement.edges.len() as u64, agreement.edges_compared];
        let texts = agreement.edges.iter().map(|edge| edge_text(topology, edge));
        report(
            &different_lines("control points", counts, &[], texts),
            straight_sides_said(not_numbers(scene.tessellator.user_surface_report())),
        );
    }
    Ok(())
}

fn report(lines: &[String], warning: Option<String>) {
    for line in lines.iter().cloned().chain(warning.map(|said| format!("warning: {said}"))) {
        let _ = writeln!(std::io::stderr(), "pnaen: {line}");
    }
}

/// What is said about factors that aren't numbers, if there are any.
pub fn not_numbers_said(count: u32) -> Option<String> {
    let text = "# factor[|s] of the LOD shader [isn't a number|aren't numbers] (NaN): [it culls its patch|they cull their \
                patches], or inside count[s|] as 1.";
    (count > 0).then(|| numbered(count.into(), text))
}

/// What is said about sides whose control points aren't numbers, if there are any.
pub fn straight_sides_said(count: u32) -> Option<String> {
    let text = "# side[ got a control point|s got control points] of the surface shader that [is|are] infinite or no number[|s] \
                (NaN): [it is|they are] straight.";
    (count > 0).then(|| numbered(count.into(), text))
}

fn not_numbers(report: Option<UserReport>) -> u32 {
    report.map_or(0, |report| report.not_numbers)
}

/// How the factors of an LOD shader agree; none without one.
fn agreement(engine: &Engine, scene: &Scene) -> Result<Option<Agreement>, GpuError> {
    if scene.tessellator.user_factors().is_none() {
        return Ok(None);
    }
    let factors = engine.user_factors(scene)?;
    Ok(Some(Agreement::new(scene.tessellator.topology(), &factors, scene.tessellator.convention())))
}

fn edge_text(topology: &Topology, edge: &PointsDisagreement) -> String {
    let ([a, b], [one, other]) = (end_points(topology, edge.edge).map(point_text), edge.triangles);
    let distance = short(edge.distance);
    format!("{a} to {b}: {distance} object units between the control points of triangles {one} and {other}")
}

/// How the factors of an LOD shader disagree, as JSON.
#[derive(Debug, Serialize)]
pub(super) struct LodShaderStats {
    edges_compared: u64,
    edges_different: u64,
    patches_culled: u64,
    /// Factors that are NaN.
    not_numbers: u32,
    /// The largest differences first, at most [`LISTED`].
    edges: Vec<EdgeStats>,
}

impl LodShaderStats {
    /// Of a scene with an LOD shader; none of others. The counts must be known.
    ///
    /// # Errors
    /// The device was lost.
    pub(super) fn new(engine: &Engine, scene: &Scene) -> Result<Option<Self>, GpuError> {
        let topology = scene.tessellator.topology();
        Ok(agreement(engine, scene)?.map(|Agreement { edges_compared, patches_culled, edges, .. }| Self {
            edges_compared,
            edges_different: edges.len() as u64,
            patches_culled,
            not_numbers: not_numbers(scene.tessellator.user_lod_report()),
            edges: edges.iter().take(LISTED).map(|edge| EdgeStats::new(topology, edge)).collect(),
        }))
    }
}

/// How the control points of a surface shader disagree, as JSON.
#[derive(Debug, Serialize)]
pub(super) struct SurfaceShaderStats {
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
    pub(super) fn new(engine: &Engine, scene: &Scene) -> Result<Option<Self>, GpuError> {
        let topology = scene.tessellator.topology();
        let edge = |&PointsDisagreement { edge, distance, triangles }: &PointsDisagreement| EdgePointsStats {
            points: end_points(topology, edge),
            triangles,
            distance,
        };
        Ok(engine.user_points_agreement(scene)?.map(|agreement: PointsAgreement| Self {
            edges_compared: agreement.edges_compared,
            edges_different: agreement.edges.len() as u64,
            max_distance: agreement.max_distance(),
            not_numbers: not_numbers(scene.tessellator.user_surface_report()),
            edges: agreement.edges.iter().take(LISTED).map(edge).collect(),
        }))
    }
}
