//! The option `--lod-shader`: factors from a WGSL function of the user's own in place of LOD, and a report on where they disagree.

use std::io::Write;
use std::path::PathBuf;

use serde::Serialize;

use super::factors_option::{EdgeStats, FactorsOption, LISTED, agreement_lines};
use super::{CliError, warn};
use geometry::tessellate::{Partitioning, Tessellation};
use gpu::{Given, GpuError};
use inspect::engine::Engine;
use inspect::measure::Agreement;
use inspect::own_shader::read_own_shader;
use inspect::render::Scene;

#[derive(Clone, Debug, Default, clap::Args)]
pub struct LodShaderOption {
    /// Compute factors on the GPU by functions of your own in place of LOD's: a WGSL file with the function edge_factor, and perhaps
    /// inside_factor. The manual's page on own shaders says what they get. Standard error lists edges whose two sides got different factors
    #[arg(
        long,
        value_name = "WGSL",
        conflicts_with_all = ["lod", "factor", "pixels", "distances", "max_triangles"]
    )]
    pub lod_shader: Option<PathBuf>,
}

impl LodShaderOption {
    /// Reads the file, if one was named.
    ///
    /// # Errors
    /// It can't be read or used, or the partitioning has the same number of segments everywhere.
    pub fn read(&self, tessellation: &Tessellation) -> Result<Option<Given>, CliError> {
        let Some(path) = &self.lod_shader else { return Ok(None) };
        if tessellation.partitioning == Partitioning::Subtriangulation {
            return Err(CliError::Usage(
                "--lod-shader can't be combined with --partitioning subtriangulation, which has the same number of segments everywhere",
            ));
        }
        Ok(Some(Given::Shader(read_own_shader(path)?)))
    }

    /// Checks that no file has factors as well.
    ///
    /// # Errors
    /// One has.
    pub(crate) fn check_alone(&self, factors: &FactorsOption) -> Result<(), CliError> {
        match self.lod_shader.is_some() && factors.given.is_some() {
            true => Err(CliError::Usage("--factors and --lod-shader both take the place of LOD: choose one")),
            false => Ok(()),
        }
    }

    /// Checks that nothing is to be computed on the CPU.
    ///
    /// # Errors
    /// It is.
    pub fn check(&self, is_on_cpu: bool) -> Result<(), CliError> {
        match self.lod_shader.is_some() && is_on_cpu {
            true => Err(CliError::Usage("--lod-shader runs on the graphics adapter: leave --device cpu away")),
            false => Ok(()),
        }
    }
}

/// Reports on standard error where the factors of an LOD shader disagree, if the scene has one, and how many aren't numbers. The
/// counts must be known.
///
/// # Errors
/// The device was lost.
pub(super) fn report_own_lod(engine: &Engine, scene: &Scene) -> Result<(), GpuError> {
    let Some(agreement) = agreement(engine, scene)? else { return Ok(()) };
    for line in agreement_lines(scene.tessellator.topology(), &agreement) {
        let _ = writeln!(std::io::stderr(), "pnaen: {line}");
    }
    if let Some(said) = not_numbers_said(not_numbers(scene)) {
        warn(&[said]);
    }
    Ok(())
}

/// What is said about factors that aren't numbers, if there are any.
pub(crate) fn not_numbers_said(count: u32) -> Option<String> {
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
    pub(super) fn of(engine: &Engine, scene: &Scene) -> Result<Option<Self>, GpuError> {
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
