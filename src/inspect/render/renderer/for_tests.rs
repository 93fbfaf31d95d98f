//! What only tests and measurements want of a renderer.

use std::sync::Arc;

use super::Renderer;
use crate::render::Scene;
use crate::render::environment::Environment;
use gpu::layout::DrawArgs;
use gpu::{Gpu, GpuError, read_buffer};

impl Renderer {
    /// The same, with another light in place of the studio's.
    pub fn lit_by(gpu: &Gpu, environment: Environment) -> Self {
        let renderer = Self::new(gpu);
        // There is none yet, so that nothing fails.
        let _ = renderer.studio.get_or_try_make(|| Ok(Arc::new(environment)));
        renderer
    }
}

impl Scene {
    /// How many triangles of the last chunk were drawn, if those that cover no sample were removed; else `None`. Waits for the
    /// device.
    ///
    /// # Errors
    /// The device was lost.
    pub fn covering_triangles(&self) -> Result<Option<u64>, GpuError> {
        let Some(coverage) = &self.coverage else { return Ok(None) };
        let bytes = read_buffer(self.tessellator.gpu(), &coverage.draw_args, 0, coverage.draw_args.size())?;
        let draws: Vec<DrawArgs> = bytemuck::pod_collect_to_vec(&bytes);
        Ok(Some(draws.iter().map(|draw| u64::from(draw.index_count) / 3).sum()))
    }
}
