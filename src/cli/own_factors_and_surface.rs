//! The options `--factors`, `--lod-shader` and `--surface-shader`: factors of a file in place of LOD's, and WGSL functions of
//! the user's own in place of LOD and of a surface's control points; what can't be combined with them, and a report on where
//! they disagree.

use std::path::PathBuf;
use std::sync::Arc;

use super::options::{LOD_OPTIONS, PartOptions};
use super::{CliError, SurfaceOptions, note, refuse};
use geometry::mesh::{Mesh, Topology};
use geometry::tessellate::{HullFactors, Tessellation};
use gpu::{Given, SurfaceShader};
use inspect::gates::{Gate, GateKind};
use inspect::measure::Agreement;
use inspect::shot::{FactorsFile, read_factors, said};
use inspect::user_shader::read_user_shader;

#[derive(Clone, Debug, Default, clap::Args)]
pub struct FactorsOption {
    /// Tessellate with the factors of a CSV file in place of those that LOD computes (- for standard input). It has the header
    /// patch,e0,e1,e2,inside (under rows patch,e0,e1,e2,base,width,flipped) and a line for each triangle, as `pnaen factors`
    /// writes it. Standard error lists edges whose sides have different factors, and the convention under which all agree
    #[arg(long = "factors", value_name = "CSV", conflicts_with_all = LOD_OPTIONS)]
    pub given: Option<PathBuf>,
}

/// Factors from a file, checked against the mesh: one for each patch, and what was found about them.
type GivenFactors = (Vec<HullFactors>, FactorsFile);

impl FactorsOption {
    /// Reads the file, if one was named, and reports on standard error where its factors disagree.
    pub fn read(
        &self,
        mesh: &Mesh,
        topology: &Topology,
        surface: &SurfaceOptions,
    ) -> Result<Option<GivenFactors>, CliError> {
        let Tessellation { convention, partitioning, .. } = surface.tessellation();
        let Some(path) = &self.given else { return Ok(None) };
        let parts = &surface.weld.parts;
        parts.say_idle(|own| own.detail.is_some(), "the detail of --part has no effect under --factors");
        let factors = read_factors(path, mesh, topology, partitioning)?;
        let agreement = Agreement::new(topology, &factors, convention);
        said(topology, &agreement, convention).iter().for_each(|line| note(line));
        let about = FactorsFile::new(path, topology, &agreement, convention);
        Ok(Some((factors, about)))
    }
}

#[derive(Clone, Debug, Default, clap::Args)]
pub struct LodShaderOption {
    /// Compute factors on the GPU by functions of your own in place of LOD's. It is a WGSL file with the function edge_factor,
    /// and perhaps inside_factor. The manual's page on own shaders says what they get. Standard error lists edges whose sides got
    /// different factors
    #[arg(long, value_name = "WGSL", conflicts_with_all = LOD_OPTIONS)]
    pub lod_shader: Option<PathBuf>,
}

impl LodShaderOption {
    /// Reads the file, if one was named.
    pub fn read(&self, surface: &SurfaceOptions) -> Result<Option<Given>, CliError> {
        let Some(path) = &self.lod_shader else { return Ok(None) };
        let parts = &surface.weld.parts;
        parts.say_idle(|own| own.detail.is_some(), "the detail of --part has no effect under --lod-shader");
        refuse(
            surface.tessellation().partitioning.has_one_factor(),
            "--lod-shader can't be combined with --partitioning subtriangulation, which has the same number of segments everywhere",
        )?;
        Ok(Some(Given::Shader(read_user_shader(path)?)))
    }

    /// Checks that no file has factors as well.
    pub(crate) fn check_alone(&self, factors: &FactorsOption) -> Result<(), CliError> {
        let has_both = self.lod_shader.is_some() && factors.given.is_some();
        refuse(has_both, "--factors and --lod-shader both take the place of LOD: choose one")
    }

    /// Checks that nothing is to be computed on the CPU.
    pub fn check(&self, is_on_cpu: bool) -> Result<(), CliError> {
        refuse(self.lod_shader.is_some() && is_on_cpu, "--lod-shader runs on the graphics adapter: omit --device cpu")
    }
}

#[derive(Clone, Debug, Default, clap::Args)]
pub struct SurfaceShaderOption {
    /// Compute the control points of edges on the GPU by a function of your own in place of a surface's. It is a WGSL file with
    /// the function edge_points. The manual's page on own shaders says what it gets. Standard error lists edges whose sides got
    /// different control points
    #[arg(long, value_name = "WGSL", conflicts_with = "surface")]
    pub surface_shader: Option<PathBuf>,
}

impl SurfaceShaderOption {
    /// Reads the file, if one was named.
    pub fn read(&self, parts: &PartOptions) -> Result<Option<Arc<SurfaceShader>>, CliError> {
        if self.surface_shader.is_some() {
            parts.say_idle(|own| own.surface.is_some(), "the surface of --part has no effect under --surface-shader");
        }
        Ok(self.surface_shader.as_deref().map(read_user_shader).transpose()?)
    }

    /// Checks that nothing is to be computed on the CPU, and that no gate needs the surface there.
    pub fn check(&self, is_on_cpu: bool, gates: &[Gate]) -> Result<(), CliError> {
        if self.surface_shader.is_none() {
            return Ok(());
        }
        refuse(is_on_cpu, "--surface-shader runs on the graphics adapter: omit --device cpu")?;
        refuse(
            gates.iter().any(|gate| gate.kind == GateKind::AboveTolerance),
            "--fail-on above-tolerance measures on the CPU, where the surface of --surface-shader isn't known: choose other gates",
        )
    }
}
