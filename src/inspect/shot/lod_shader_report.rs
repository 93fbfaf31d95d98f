//! Where the factors of an LOD shader of the user's own disagree.

use std::io::Write;

use serde::Serialize;

use super::factors_report::{EdgeStats, LISTED, agreement_lines};
use crate::engine::Engine;
use crate::measure::Agreement;
use crate::render::Scene;
use gpu::GpuError;

/// Reports on standard error where the factors of an LOD shader disagree, if the scene has one, and how many aren't numbers. The
/// counts must be known.
///
/// # Errors
/// The device was lost.
pub fn report_own_lod(engine: &Engine, scene: &Scene) -> Result<(), GpuError> {
    let Some(agreement) = agreement(engine, scene)? else { return Ok(()) };
    for line in agreement_lines(scene.tessellator.topology(), &agreement) {
        let _ = writeln!(std::io::stderr(), "pnaen: {line}");
    }
    if let Some(said) = not_numbers_said(not_numbers(scene)) {
        let _ = writeln!(std::io::stderr(), "pnaen: warning: {said}");
    }
    Ok(())
}

/// What is said about factors that aren't numbers, if there are any.
pub fn not_numbers_said(count: u32) -> Option<String> {
    match count {
        0 => None,
        1 => Some(
            "1 factor of the LOD shader isn't a number (NaN): it culls its patch, or inside counts as 1.".to_owned(),
        ),
        _ => Some(format!(
            "{count} factors of the LOD shader aren't numbers (NaN): they cull their patches, or inside count as 1."
        )),
    }
}

fn not_numbers(scene: &Scene) -> u32 {
    scene.tessellator.own_lod_report().map_or(0, |report| report.not_numbers)
}

/// How the factors of an LOD shader agree; none without one.
fn agreement(engine: &Engine, scene: &Scene) -> Result<Option<Agreement>, GpuError> {
    if scene.tessellator.own_factors().is_none() {
        return Ok(None);
    }
    let factors = engine.own_factors(scene)?;
    Ok(Some(Agreement::of(scene.tessellator.topology(), &factors, scene.tessellator.convention())))
}

/// The same as JSON.
#[derive(Debug, Serialize)]
pub struct LodShaderStats {
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
    pub fn of(engine: &Engine, scene: &Scene) -> Result<Option<Self>, GpuError> {
        let Some(agreement) = agreement(engine, scene)? else { return Ok(None) };
        let topology = scene.tessellator.topology();
        Ok(Some(Self {
            edges_compared: agreement.edges_compared,
            edges_different: agreement.edges.len() as u64,
            patches_culled: agreement.patches_culled,
            not_numbers: not_numbers(scene),
            edges: agreement.edges.iter().take(LISTED).map(|edge| EdgeStats::new(topology, edge)).collect(),
        }))
    }
}
