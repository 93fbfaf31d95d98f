//! What only tests and measurements want of a renderer.

use std::sync::Arc;

use super::Renderer;
use crate::render::Scene;
use crate::render::colors::Look;
use crate::render::draws::{Draw, Faces, LayerDraw, Occluded, Shading, SurfaceDraw, Triangles};
use crate::render::environment::Environment;
use crate::render::needs::{Cut, Needs};
use crate::settings::NormalsAt;
use geometry::names::every;
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

    /// Makes the pipelines of all draws, also of those that no picture has needed yet.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn prepare_all(&self) -> Result<(), GpuError> {
        all_draws().into_iter().try_for_each(|draw| self.get(draw).map(|_| ()))
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

/// Every pipeline that there is; of those that light materials, the ones with all that materials can need.
fn all_draws() -> Vec<Draw> {
    let masked = Needs { masked_samples: true, ..Needs::ALL };
    let cuts = [false, true].map(|samples| Shading::Cut(Cut { details: true, samples }));
    let looks = every![Look: SurfaceNormals, Curvature, Matcap, TexelDensity];
    let mut shadings = vec![Shading::Plain, Shading::Textured, Shading::Lit(Needs::ALL), Shading::Lit(masked)];
    shadings.extend(cuts.into_iter().chain(looks.map(Shading::Look)));
    let layers = every![LayerDraw: Over, Filter, Add, Away, Toward];
    let mut all = vec![Draw::Background, Draw::Ground];
    all.extend(Occluded::BOTH.into_iter().flat_map(|part| [Draw::Lines(part), Draw::Normals(part)]));
    for (at_infinity, has_colors) in [(false, false), (true, false), (false, true)] {
        all.push(Draw::LayerClear { at_infinity, has_colors });
    }
    let all_faces = [Faces::Both, Faces::Fronts];
    for triangles in [Triangles::Bare, Triangles::Indexed, Triangles::Pulled] {
        for (&normals, faces) in NormalsAt::ALL.iter().flat_map(|at| all_faces.map(|faces| (at, faces))) {
            for &shading in &shadings {
                let draws = [None].into_iter().chain(layers.map(Some)).map(|layer| SurfaceDraw {
                    triangles,
                    faces,
                    normals,
                    shading,
                    layer,
                });
                all.extend(draws.filter(is_common).map(Draw::Surface));
            }
        }
    }
    all
}

/// Whether pictures have such surfaces. Of those that are seldom culled, the fronts alone count as none.
fn is_common(draw: &SurfaceDraw) -> bool {
    let (is_bare, at_vertices) = (draw.triangles == Triangles::Bare, draw.normals == NormalsAt::Vertices);
    let is_shaded = match draw.shading {
        Shading::Plain => is_bare && at_vertices,
        Shading::Cut(_) | Shading::Look(_) => !is_bare,
        Shading::Textured | Shading::Lit(_) => true,
    };
    let is_layer = match draw.layer {
        Some(layer) => draw.shading == Shading::Lit(Needs::ALL) && (at_vertices || !layer.finds()),
        None => true,
    };
    let is_masked = matches!(draw.shading, Shading::Cut(_) | Shading::Lit(Needs { masked_samples: true, .. }));
    let has_fronts = !is_masked && draw.layer.is_none();
    is_shaded && is_layer && (has_fronts || draw.faces == Faces::Both)
}
