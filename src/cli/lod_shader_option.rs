//! The option `--lod-shader`: factors from a WGSL function of the user's own in place of LOD, and a report on where they disagree.

use std::path::PathBuf;

use super::options::LOD_OPTIONS;
use super::{CliError, FactorsOption, refuse};
use geometry::tessellate::Tessellation;
use gpu::Given;
use inspect::user_shader::read_user_shader;

#[derive(Clone, Debug, Default, clap::Args)]
pub struct LodShaderOption {
    /// Compute factors on the GPU by functions of your own in place of LOD's: a WGSL file with the function edge_factor, and perhaps
    /// inside_factor. The manual's page on own shaders says what they get. Standard error lists edges whose two sides got different factors
    #[arg(long, value_name = "WGSL", conflicts_with_all = LOD_OPTIONS)]
    pub lod_shader: Option<PathBuf>,
}

impl LodShaderOption {
    /// Reads the file, if one was named.
    pub fn read(&self, tessellation: &Tessellation) -> Result<Option<Given>, CliError> {
        let Some(path) = &self.lod_shader else { return Ok(None) };
        refuse(
            tessellation.partitioning.has_one_factor(),
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
