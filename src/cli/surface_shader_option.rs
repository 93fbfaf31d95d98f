//! The option `--surface-shader`: control points from a WGSL function of the user's own in place of a surface's, what can't be
//! combined with it, and a report on where the sides of edges disagree.

use std::path::PathBuf;
use std::sync::Arc;

use super::{CliError, refuse};
use gpu::SurfaceShader;
use inspect::gates::{Gate, GateKind};
use inspect::user_shader::read_user_shader;

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
    pub fn read(&self) -> Result<Option<Arc<SurfaceShader>>, CliError> {
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

    /// Refuses to compare with the limit surface.
    pub(crate) fn check_deviation(&self) -> Result<(), CliError> {
        refuse(
            self.surface_shader.is_some(),
            "--overlay deviation compares with the surface on the CPU, where that of --surface-shader isn't known: name another \
             one with --reference-surface",
        )
    }
}
