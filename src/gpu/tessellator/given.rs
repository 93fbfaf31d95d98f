//! What takes the place of LOD's factors.

use super::Tessellator;
use crate::buffer::{empty, filled};
use crate::{Given, GpuError, UserReport};
use geometry::tessellate::HullFactors;

impl Tessellator {
    /// Takes factors, or what computes them, in place of LOD; none for LOD's. Takes effect with the next [`Self::set`].
    ///
    /// # Errors
    /// More patches than the adapter binds memory for.
    pub fn give(&mut self, given: Option<Given>) -> Result<(), GpuError> {
        let patches = self.buffers.patch_count as usize;
        self.given_buffer = match &given {
            Some(Given::Shader(_)) => empty::<HullFactors>(&self.gpu, "given factors", patches)?,
            Some(Given::Factors(factors)) => filled(&self.gpu, "given factors", factors)?,
            None => filled::<HullFactors>(&self.gpu, "given factors", &[])?,
        };
        self.user_report = match &given {
            Some(Given::Shader(_)) => Some(empty::<UserReport>(&self.gpu, "LOD report", 1)?),
            _ => None,
        };
        // Counts that are on their way belong to what was given before.
        (self.user_lod_report, self.pending) = (None, None);
        self.given = given;
        self.unbind();
        self.forget();
        Ok(())
    }

    /// What takes the place of LOD, if something does.
    pub fn given(&self) -> Option<&Given> {
        self.given.as_ref()
    }

    /// The factors that functions of the user's own have written, a [`HullFactors`] for each patch, if they give factors.
    pub fn user_factors(&self) -> Option<&wgpu::Buffer> {
        self.user_report.as_ref().map(|_| &self.given_buffer)
    }

    /// What functions of the user's own reported when the counts were last known, if they give factors.
    pub fn user_lod_report(&self) -> Option<UserReport> {
        self.user_lod_report.filter(|_| self.counts_done)
    }
}
