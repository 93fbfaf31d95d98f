//! Makes pipelines before a picture needs them.

use std::collections::HashSet;

use super::Renderer;
use super::layer_passes::layer_draws;
use crate::render::Scene;
use crate::render::draws::{Draw, Faces, Occluded};
use crate::render::surface_draws::surface_draw;
use crate::settings::{ColorSource, Lighting, Settings};
use geometry::cores::each;
use gpu::GpuError;

/// The pipelines that draw the surfaces of a mesh in drafts of pictures with the same settings.
#[derive(Clone, Debug, PartialEq)]
pub struct DraftPipelines(Vec<Draw>);

impl Renderer {
    /// Makes the pipelines that a picture of the scene with these settings needs, as far as that is known before the scene is
    /// counted. It may run on any thread. A picture that needs one of these pipelines meanwhile waits for it.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn prepare(&self, scene: &Scene, settings: &Settings) -> Result<(), GpuError> {
        let settings = &settings.drawn();
        if settings.shows_materials() && settings.lighting == Lighting::Studio {
            self.studio()?;
        }
        if settings.overlays.colors.source() == ColorSource::LitSphere {
            self.matcaps.group(&self.gpu, &self.materials, settings.matcap)?;
        }
        if settings.overlays.colors.source() == ColorSource::MinimumTriangles {
            scene.tessellator.prepare_minimum(settings.tessellation.partitioning)?;
        }
        let mut draws = self.surface_draws(scene, settings, false);
        draws.extend(layer_draws(settings, scene.tessellator.mesh(), self.kind(false)));
        draws.extend(settings.shows_environment().then_some(Draw::Background));
        draws.extend(settings.overlays.grid.then_some(Draw::Ground));
        if settings.overlays.normals {
            draws.extend(Occluded::BOTH.map(Draw::Normals));
        }
        draws.extend(scene.lines.iter().flat_map(|_| Occluded::BOTH.map(Draw::Lines)));
        each(&Vec::from_iter(HashSet::<Draw>::from_iter(draws)), |&draw| self.get(draw).map(drop))
    }

    /// The pipelines for surfaces that a [draft](crate::render::Target::draft) of the scene needs, as far as that is known before the scene is
    /// counted.
    pub fn draft_pipelines(&self, scene: &Scene, settings: &Settings) -> DraftPipelines {
        let mut draws = self.surface_draws(scene, &settings.drawn(), true);
        draws.dedup();
        DraftPipelines(draws)
    }

    /// Makes these pipelines. It may run on any thread.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn prepare_draft(&self, DraftPipelines(draws): &DraftPipelines) -> Result<(), GpuError> {
        draws.iter().try_for_each(|&draw| self.get(draw).map(|_| ()))
    }

    /// How the surfaces of a scene are drawn, as far as that is known before it is counted.
    fn surface_draws(&self, scene: &Scene, settings: &Settings, is_draft: bool) -> Vec<Draw> {
        let culls = settings.tessellation.cull_back_faces && scene.tessellator.is_solid();
        let faces = if culls { Faces::Fronts } else { Faces::Both };
        let (mesh, kind) = (scene.tessellator.mesh(), self.kind(is_draft));
        mesh.materials.iter().map(|own| surface_draw(settings, mesh, own, faces, kind)).collect()
    }
}
