//! The option `--surface-shader`: control points from a WGSL function of the user's own in place of a surface's, what can't be
//! combined with it, and a report on where the sides of edges disagree.

use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;

use serde::Serialize;

use super::factors_option::{LISTED, SAID, end_points, point_text};
use super::{CliError, warn};
use geometry::mesh::Topology;
use geometry::numbers::short;
use gpu::{GpuError, SurfaceShader};
use inspect::engine::Engine;
use inspect::gates::{Gate, GateKind};
use inspect::measure::{PointsAgreement, PointsDisagreement};
use inspect::own_shader::read_own_shader;
use inspect::render::Scene;

#[derive(Clone, Debug, Default, clap::Args)]
pub struct SurfaceShaderOption {
    /// Compute the control points of edges on the GPU by a function of your own in place of a surface's: a WGSL file with the
    /// function edge_points. The manual's page on own shaders says what it gets. Standard error lists edges whose sides got
    /// different control points
    #[arg(long, value_name = "WGSL", conflicts_with = "surface")]
    pub surface_shader: Option<PathBuf>,
}

impl SurfaceShaderOption {
    /// Reads the file, if one was named.
    ///
    /// # Errors
    /// It can't be read or used.
    pub fn read(&self) -> Result<Option<Arc<SurfaceShader>>, CliError> {
        Ok(self.surface_shader.as_deref().map(read_own_shader).transpose()?)
    }

    /// Checks that nothing is to be computed on the CPU, and that no gate needs the surface there.
    ///
    /// # Errors
    /// Something is, or a gate does.
    pub fn check(&self, is_on_cpu: bool, gates: &[Gate]) -> Result<(), CliError> {
        if self.surface_shader.is_none() {
            return Ok(());
        }
        if is_on_cpu {
            return Err(CliError::Usage("--surface-shader runs on the graphics adapter: leave --device cpu away"));
        }
        if gates.iter().any(|gate| gate.kind == GateKind::AboveTolerance) {
            return Err(CliError::Usage(
                "--fail-on above-tolerance measures on the CPU, where the surface of --surface-shader isn't known: choose other gates",
            ));
        }
        Ok(())
    }

    /// Refuses to compare with the limit surface.
    ///
    /// # Errors
    /// There is a shader.
    pub(crate) fn check_deviation(&self) -> Result<(), CliError> {
        match self.surface_shader {
            Some(_) => Err(CliError::Usage(
                "--overlay deviation compares with the surface on the CPU, where that of --surface-shader isn't known: name another \
                 one with --truth",
            )),
            None => Ok(()),
        }
    }
}

/// Reports on standard error where the control points of a surface shader disagree, if the scene has one, and how many aren't
/// numbers. The counts must be known.
///
/// # Errors
/// The device was lost.
pub(super) fn report_own_surface(engine: &Engine, scene: &Scene) -> Result<(), GpuError> {
    let Some(agreement) = engine.own_points_agreement(scene)? else { return Ok(()) };
    for line in lines(scene.tessellator.topology(), &agreement) {
        let _ = writeln!(std::io::stderr(), "pnaen: {line}");
    }
    if let Some(said) = straight_sides_said(not_numbers(scene)) {
        warn(&[said]);
    }
    Ok(())
}

/// What is said about sides whose control points aren't numbers, if there are any.
pub(crate) fn straight_sides_said(count: u32) -> Option<String> {
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
    pub(super) fn of(engine: &Engine, scene: &Scene) -> Result<Option<Self>, GpuError> {
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
