//! What scenes are given of files that are open beside the mesh.

use super::user_shader_job::OpenShader;
use crate::app::App;
use crate::app::jobs::job_list::Work;
use gpu::{Given, GpuError};
use inspect::settings::{Lighting, SplitSide};

/// The numbers of what a picture has of files; 0 where it has none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct FromFiles {
    /// What takes the place of LOD: functions of the user's own, or the factors of a file.
    pub factors: u64,
    /// The same of the left half.
    pub left_factors: u64,
    /// The function that gives control points.
    pub surface: u64,
    /// The picture of a lit sphere.
    pub matcap: u64,
    pub light: u64,
}

impl App {
    /// What the picture should have.
    pub(in crate::app) fn wanted_from_files(&self) -> FromFiles {
        let lod = self.lod_shader.as_ref().filter(|_| self.uses_lod_shader()).and_then(OpenShader::shader);
        let factors = self.given.as_ref().map_or(0, |given| given.generation);
        let surface = self.surface_shader.as_ref().and_then(OpenShader::shader);
        let uses_light = self.settings.halves().any(|own| own.lighting == Lighting::Environment);
        // A file's factors are for the triangles of this mesh.
        let takes_left = self.settings.has_left_tessellation() && (self.other_left().is_none() || lod.is_some());
        let factors = lod.map_or(factors, |(_, generation)| generation);
        FromFiles {
            factors,
            left_factors: if takes_left { factors } else { 0 },
            surface: surface.map_or(0, |(_, generation)| generation),
            matcap: self.matcap.as_ref().map_or(0, |chosen| chosen.generation),
            light: self.environment.as_ref().filter(|_| uses_light).map_or(0, |open| open.generation),
        }
    }

    /// Gives the scenes what the picture should have of files, or takes it back, while no picture is under way.
    ///
    /// # Errors
    /// More patches than the adapter binds memory for, out of memory, or a lost device.
    pub(in crate::app) fn give_from_files(&mut self) -> Result<(), GpuError> {
        let wanted = self.wanted_from_files();
        let Some(document) = self.document.as_mut().filter(|_| self.viewport.picture.is_free()) else { return Ok(()) };
        let (has, scene) = (&mut document.from_files, &mut document.scene);
        if !self.jobs.has(Work::LeftHalf) {
            if (has.factors, has.left_factors) != (wanted.factors, wanted.left_factors) {
                let file = self.given.as_ref().map(|given| Given::Factors(given.content.factors.to_vec()));
                let shader = self.lod_shader.as_ref().and_then(OpenShader::shader);
                let shader = shader.filter(|(_, generation)| *generation == wanted.factors);
                let given = shader.map(|(shader, _)| Given::Shader(shader)).or(file);
                scene.tessellator.give(given.clone())?;
                if let Some(left) = scene.half_mut(SplitSide::Left) {
                    left.tessellator.give(given.filter(|_| wanted.left_factors > 0))?;
                }
                (has.factors, has.left_factors) = (wanted.factors, wanted.left_factors);
            }
            if has.surface != wanted.surface {
                let shader = self.surface_shader.as_ref().and_then(OpenShader::shader);
                scene.tessellator.set_surface_shader(shader.map(|(shader, _)| shader))?;
                has.surface = wanted.surface;
            }
        }
        if has.light != wanted.light {
            let open = self.environment.as_ref().filter(|_| wanted.light > 0);
            scene.environment = open.map(|open| open.content.environment.clone());
            has.light = wanted.light;
        }
        if has.matcap != wanted.matcap {
            let picture = self.matcap.as_ref().map(|chosen| self.engine.renderer.matcap(&chosen.content)).transpose();
            has.matcap = if picture.is_ok() { wanted.matcap } else { 0 };
            scene.matcap = picture.unwrap_or_else(|error| {
                self.dialogs.error = Some(error.to_string());
                self.matcap = None;
                None
            });
        }
        Ok(())
    }
}
