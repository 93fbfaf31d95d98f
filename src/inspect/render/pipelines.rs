//! The pipelines that draw a scene, each made when it is first needed, and their bind group layouts.

use std::collections::HashMap;
use std::sync::{Arc, Mutex};

use super::draws::{Draw, Shading, SurfaceDraw, Triangles};
use super::environment::Backdrop;
use super::group_layouts::{FRAGMENT, READ, UNIFORM, VERTEX, depths, group_layout};
use super::materials::Materials;
use super::render_pipeline::PipelineParts;
use super::target::samples;
use gpu::{Gpu, GpuError, Lazy, ShaderModules, made_once};

/// The pipeline of each [`Draw`], and the layouts of their bind groups but for those of materials, group 1.
pub(super) struct DrawPipelines {
    /// Group 0: the frame, points, corners, patches, the arena's vertices and indices, the frame once more as a uniform, curve
    /// nets, the parameters of the passes, and details of corners.
    pub scene_layout: wgpu::BindGroupLayout,
    /// Group 1 of the background: a panorama, its sampler, and how the light is shown.
    pub background_layout: wgpu::BindGroupLayout,
    /// Group 2: the slab of the chunk that is drawn, and the factors of the slab's patches.
    pub chunk_layout: wgpu::BindGroupLayout,
    /// Group 3: what was measured of a chunk's triangles, their distances to the reference surface, and of patches, their own
    /// least.
    pub measured_layout: wgpu::BindGroupLayout,
    /// Group 3 where layers are drawn: the same, and the depths of the layer that was found last.
    pub layer_layout: wgpu::BindGroupLayout,
    modules: ShaderModules,
    pipelines: Mutex<HashMap<Draw, Arc<Lazy<wgpu::RenderPipeline>>>>,
}

impl DrawPipelines {
    /// Makes the layouts. Compiles nothing yet.
    pub(super) fn new(gpu: &Gpu) -> Self {
        let both = VERTEX | FRAGMENT;
        // Vertex shaders have as many storage buffers as WebGPU allows.
        let scene = [
            [0, 1, 2, 3].map(|binding| (binding, both, READ)).to_vec(),
            vec![(4, VERTEX, READ), (5, VERTEX, READ), (6, both, UNIFORM)],
            vec![(7, FRAGMENT, READ), (8, FRAGMENT, UNIFORM), (9, FRAGMENT, READ)],
        ];
        let [measured, least] = [(0, FRAGMENT, READ), (1, VERTEX, READ)];
        Self {
            scene_layout: group_layout(gpu, "scene", &scene.concat()),
            background_layout: group_layout(gpu, "background", &Backdrop::BINDINGS),
            chunk_layout: group_layout(gpu, "chunk", &[(0, VERTEX, UNIFORM), (1, VERTEX, READ)]),
            measured_layout: group_layout(gpu, "measured", &[measured, least]),
            layer_layout: group_layout(gpu, "layer", &[measured, least, (2, FRAGMENT, depths(gpu))]),
            modules: ShaderModules::default(),
            pipelines: Default::default(),
        }
    }

    /// The pipeline of a draw. It is made at the first call.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub(super) fn get(&self, gpu: &Gpu, materials: &Materials, draw: Draw) -> Result<wgpu::RenderPipeline, GpuError> {
        let (module, entry_points) = draw.shaders(samples(gpu));
        let module = self.modules.get(module);
        let module = module.get(gpu)?;
        // Nothing is made while the lock is held, so that a picture doesn't wait for pipelines of another.
        let own = made_once(&self.pipelines, draw, Arc::default);
        let parts = || PipelineParts {
            constants: draw.constants(),
            layouts: Some(self.layouts(materials, draw)),
            vertex_buffers: draw.vertex_buffers(),
            cull_mode: draw.cull_mode(),
            depth: Some(draw.depth_stencil()),
            samples: samples(gpu),
            ..PipelineParts::new(module, entry_points, draw.color_target())
        };
        own.get_or_make(gpu, || parts().pipeline(gpu)).cloned()
    }

    /// The layouts of the groups that a pipeline binds.
    fn layouts<'a>(&'a self, materials: &'a Materials, draw: Draw) -> Vec<Option<&'a wgpu::BindGroupLayout>> {
        let (scene, chunk) = (Some(&self.scene_layout), Some(&self.chunk_layout));
        match draw {
            Draw::Surface(SurfaceDraw { triangles, shading, layer, .. }) => {
                let material = match (layer, shading) {
                    (Some(layer), _) if layer.finds() => &materials.found_layout,
                    (_, Shading::Lit(_)) => &materials.lit_layout,
                    _ => &materials.layout,
                };
                let last = if layer.is_some() { &self.layer_layout } else { &self.measured_layout };
                let has_overlays = layer.is_some() || triangles != Triangles::Bare;
                // Overlays read the factors of the patches in a chunk.
                let chunk = chunk.filter(|_| triangles != Triangles::Bare);
                let mut layouts = vec![scene, Some(material)];
                if has_overlays {
                    layouts.extend([chunk, Some(last)]);
                }
                layouts
            }
            Draw::LayerClear { .. } => Vec::new(),
            Draw::Background => vec![scene, Some(&self.background_layout)],
            Draw::Ground | Draw::Lines(_) => vec![scene],
            Draw::Normals(_) => vec![scene, None, chunk],
        }
    }
}
