//! Control points from a function of the user's own, in place of those of the surface.

use std::sync::Arc;

use super::Tessellator;
use crate::buffer::empty;
use crate::mesh_buffers::Grouping;
use crate::{GpuError, LodShader, SurfaceShader, UserReport, UserShader};
use geometry::mesh::StylesUsed;
use geometry::tessellate::{Inputs, Surface, Tessellation, sharing, user_sharing};

/// A function that gives control points.
pub(super) struct UserSurface {
    pub(super) shader: Arc<SurfaceShader>,
    /// Where it reports, an [`UserReport`].
    pub(super) report: wgpu::Buffer,
    /// What it reported last.
    pub(super) last: Option<UserReport>,
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
        let own = |shader| -> Result<UserSurface, GpuError> {
            let report = empty::<UserReport>(&self.gpu, "surface report", 1)?;
            Ok(UserSurface { shader, report, last: None })
        };
        self.user_surface = shader.map(own).transpose()?;
        // Counts that are on their way belong to the surface before.
        self.pending = None;
        self.unbind();
        self.forget();
        Ok(())
    }

    /// The function that gives control points in place of the surface, if one does.
    pub fn surface_shader(&self) -> Option<&Arc<SurfaceShader>> {
        self.user_surface.as_ref().map(|own| &own.shader)
    }

    /// What that function reported when the counts were last known.
    pub fn user_surface_report(&self) -> Option<UserReport> {
        self.user_surface.as_ref()?.last.filter(|_| self.counts_done)
    }

    /// What a shader of the user's own is called whose loops took too long, if one's did when the counts were last known.
    pub fn stopped_shader(&self) -> Option<&'static str> {
        let reports = [
            (SurfaceShader::PURPOSE.name, self.user_surface_report()),
            (LodShader::PURPOSE.name, self.user_lod_report()),
        ];
        let is_stopped = |report: &Option<UserReport>| report.is_some_and(|report| report.stopped > 0);
        reports.iter().find(|(_, report)| is_stopped(report)).map(|(name, _)| *name)
    }

    /// These inputs with a surface that does what control points of the user's own need: a cubic one, which they may tear.
    pub(super) fn with_user_surface(&self, inputs: &Inputs) -> Inputs {
        let surface = if self.user_surface.is_some() { Surface::OF_USER_SHADER } else { inputs.tessellation.surface };
        Inputs { tessellation: Tessellation { surface, ..inputs.tessellation }, ..*inputs }
    }

    /// Which sides of an edge share its curve.
    pub(super) fn grouping(&self, inputs: &Inputs) -> Grouping {
        let own = inputs.tessellation;
        let (sharing, styles) = match self.user_surface {
            Some(_) => (user_sharing(own.edges), StylesUsed::Details),
            None => (sharing(own.surface, own.edges), inputs.styles()),
        };
        // A change of what no part has groups nothing anew.
        Grouping { sharing, styles: if self.mesh.has_styles() { styles } else { StylesUsed::Nothing } }
    }
}
