//! Control points from a function of the user's own, in place of those of the surface.

use std::sync::Arc;

use super::Tessellator;
use crate::buffer::empty;
use crate::{GpuError, LodShader, OwnReport, OwnShader, SurfaceShader};
use geometry::mesh::Sharing;
use geometry::tessellate::{Inputs, Surface, Tessellation, own_sharing, sharing};

/// A function that gives control points.
pub(super) struct OwnSurface {
    pub(super) shader: Arc<SurfaceShader>,
    /// Where it reports, an [`OwnReport`].
    pub(super) report: wgpu::Buffer,
    /// What it reported last.
    pub(super) last: Option<OwnReport>,
}

impl Tessellator {
    /// Takes a function that gives control points in place of the surface; none for the surface's own. Takes effect with the next
    /// [`Self::set`].
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn set_surface_shader(&mut self, shader: Option<Arc<SurfaceShader>>) -> Result<(), GpuError> {
        if self.surface_shader() == shader.as_ref() {
            return Ok(());
        }
        let own = |shader| -> Result<OwnSurface, GpuError> {
            let report = empty::<OwnReport>(&self.gpu, "surface report", 1)?;
            Ok(OwnSurface { shader, report, last: None })
        };
        self.own_surface = shader.map(own).transpose()?;
        // Counts that are on their way belong to the surface before.
        self.pending = None;
        self.unbind();
        self.forget();
        Ok(())
    }

    /// The function that gives control points in place of the surface, if one does.
    pub fn surface_shader(&self) -> Option<&Arc<SurfaceShader>> {
        self.own_surface.as_ref().map(|own| &own.shader)
    }

    /// What that function reported when the counts were last known.
    pub fn own_surface_report(&self) -> Option<OwnReport> {
        self.own_surface.as_ref()?.last.filter(|_| self.counts_done)
    }

    /// What a shader of the user's own is called whose loops took too long, if one's did when the counts were last known.
    pub fn stopped_shader(&self) -> Option<&'static str> {
        let reports = [
            (SurfaceShader::purpose().name, self.own_surface_report()),
            (LodShader::purpose().name, self.own_lod_report()),
        ];
        let is_stopped = |report: &Option<OwnReport>| report.is_some_and(|report| report.stopped > 0);
        reports.iter().find(|(_, report)| is_stopped(report)).map(|(name, _)| *name)
    }

    /// These inputs with a surface that does what control points of the user's own ask for: a cubic one, which they may tear.
    pub(super) fn with_own_surface(&self, inputs: &Inputs) -> Inputs {
        let surface = if self.own_surface.is_some() { Surface::OF_USER_SHADER } else { inputs.tessellation.surface };
        Inputs { tessellation: Tessellation { surface, ..inputs.tessellation }, ..*inputs }
    }

    /// Which sides of an edge share its curve.
    pub(super) fn sharing(&self, inputs: &Inputs) -> Sharing {
        let own = inputs.tessellation;
        if self.own_surface.is_some() { own_sharing(own.edges) } else { sharing(own.surface, own.edges) }
    }
}
