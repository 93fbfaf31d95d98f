//! Picking: what a picture shows at one of its pixels.

use std::sync::mpsc::{Receiver, TryRecvError, channel};

use glam::{DMat4, DVec4, Mat4, dvec2};
use wgpu::util::DeviceExt;

use super::Scene;
use super::layout::{FOUND_EMITTED, Pick};
use super::steps::halves;
use crate::gpu::layout::Vertex;
use crate::gpu::{
    DEPTH_FORMAT, Gpu, GpuError, Recorder, Timing, compute_pipeline, mapped_bytes, shader_module, staging_buffer, wait,
};

/// A number and a weight, see `pick_fragment`; four of them are what every adapter draws into.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;

/// A pixel of a picture, and how the mesh is seen in that picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pixel {
    pub clip_from_object: Mat4,
    /// Width and height of the picture, in px.
    pub size: [u32; 2],
    /// From the left and from the top.
    pub at: [u32; 2],
    /// Where the picture is split, as in [`crate::settings::Settings`]; 1 where input triangles are to be picked.
    pub split: Option<f32>,
}

impl Pixel {
    /// Whether it is left of the split.
    pub fn is_left(&self) -> bool {
        let [[.., width, _], _] = halves(self.size, self.split);
        self.at[0] < width
    }
}

/// What is in front at a pixel's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picked {
    /// Index into [`crate::mesh::Topology::patches`].
    pub patch: u32,
    /// The weight (u, v, w) that is fewest px from 0 there: that of the nearest edge.
    pub weight: u32,
    /// None left of the split, where input triangles are drawn.
    pub triangle: Option<PickedTriangle>,
}

/// An emitted triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PickedTriangle {
    /// Its number within its patch: see [`crate::tessellate::domain_triangle`].
    pub number: u32,
    pub vertices: [Vertex; 3],
}

/// Finds what is drawn at a pixel. Long-lived: the pipelines.
///
/// Everything is drawn into a target of that one pixel, which writes numbers in place of colours. A chunk's triangles are
/// looked up while the arena holds them, so what comes back is what was emitted.
pub struct Picker {
    emitted: Half,
    source: Half,
}

/// A draw into the pixel, and what takes its result.
struct Half {
    draw: wgpu::RenderPipeline,
    draw_bindings: &'static [u32],
    take: wgpu::ComputePipeline,
    take_bindings: &'static [u32],
}

/// A result on its way to the host.
pub struct Picking {
    staging: wgpu::Buffer,
    mapped: Receiver<Result<(), wgpu::BufferAsyncError>>,
}

impl Picker {
    pub fn new(gpu: &Gpu) -> Self {
        let module = shader_module(gpu, "pick");
        Self {
            emitted: Half {
                draw: pipeline(gpu, &module, "pick_emitted_vertex"),
                draw_bindings: &[0, 3, 4],
                take: compute_pipeline(gpu, &module, "pick_emitted_main"),
                take_bindings: &[3, 4, 5, 6],
            },
            source: Half {
                draw: pipeline(gpu, &module, "pick_source_vertex"),
                draw_bindings: &[0, 1, 2],
                take: compute_pipeline(gpu, &module, "pick_source_main"),
                take_bindings: &[5, 6],
            },
        }
    }

    /// Asks what is drawn at a pixel of a picture of the scene, whose counts must be known.
    pub fn start(&self, gpu: &Gpu, scene: &mut Scene, pixel: &Pixel) -> Picking {
        let run = Run::new(gpu, pixel);
        let mut timing = Timing::Off;
        let mut recorder = Recorder::new(gpu, &mut timing);
        if pixel.is_left() {
            run.record(&mut recorder, scene, &self.source, 3 * scene.tessellator.buffers().patch_count, true);
        } else {
            for index in 0..scene.tessellator.chunk_count() {
                scene.tessellator.emit(&mut recorder, index);
                let triangles = scene.tessellator.chunk(index).chunk.triangle_count;
                run.record(&mut recorder, scene, &self.emitted, 3 * triangles, index == 0);
            }
        }
        let staging = staging_buffer(gpu, run.pick.size());
        recorder.encoder().copy_buffer_to_buffer(&run.pick, 0, &staging, 0, run.pick.size());
        recorder.submit();
        let (sender, mapped) = channel();
        staging.map_async(wgpu::MapMode::Read, .., move |result| {
            let _ = sender.send(result);
        });
        Picking { staging, mapped }
    }
}

impl Picking {
    /// What was found, once it is here: nothing, where nothing is drawn.
    ///
    /// # Errors
    /// The device was lost.
    pub fn poll(&self) -> Result<Option<Option<Picked>>, GpuError> {
        match self.mapped.try_recv() {
            Err(TryRecvError::Empty) => Ok(None),
            Err(error @ TryRecvError::Disconnected) => Err(GpuError::Readback(error.to_string())),
            Ok(Err(error)) => Err(GpuError::Readback(error.to_string())),
            Ok(Ok(())) => self.take().map(Some),
        }
    }

    /// Waits for it.
    ///
    /// # Errors
    /// The device was lost.
    pub fn wait(&self, gpu: &Gpu) -> Result<Option<Picked>, GpuError> {
        wait(gpu);
        gpu.check()?;
        // Another thread that polls may still be running the callback.
        match self.mapped.recv() {
            Ok(Ok(())) => self.take(),
            Ok(Err(error)) => Err(GpuError::Readback(error.to_string())),
            Err(error) => Err(GpuError::Readback(error.to_string())),
        }
    }

    fn take(&self) -> Result<Option<Picked>, GpuError> {
        let bytes = mapped_bytes(&self.staging)?;
        let Pick { vertices, found, patch_index: patch, triangle: number, weight, .. } =
            bytemuck::pod_read_unaligned(&bytes);
        let triangle = (found == FOUND_EMITTED).then_some(PickedTriangle { number, vertices });
        Ok((found != 0).then_some(Picked { patch, weight, triangle }))
    }
}

/// What one search needs on the device.
struct Run<'a> {
    gpu: &'a Gpu,
    pixel_from_object: wgpu::Buffer,
    drawn: wgpu::TextureView,
    depth: wgpu::TextureView,
    pick: wgpu::Buffer,
}

impl<'a> Run<'a> {
    fn new(gpu: &'a Gpu, pixel: &Pixel) -> Self {
        let texture = |format, usage| {
            let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("pick"),
                size: wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        let buffer = |contents: &[u8], usage| {
            gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some("pick"), contents, usage })
        };
        let matrix = pixel_from_object(pixel).to_cols_array_2d();
        let pick: Pick = bytemuck::Zeroable::zeroed();
        Self {
            gpu,
            pixel_from_object: buffer(bytemuck::bytes_of(&matrix), wgpu::BufferUsages::UNIFORM),
            drawn: texture(FORMAT, wgpu::TextureUsages::TEXTURE_BINDING),
            depth: texture(DEPTH_FORMAT, wgpu::TextureUsages::empty()),
            pick: buffer(bytemuck::bytes_of(&pick), wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC),
        }
    }

    /// Draws so many corners, and takes what is in front of all that was drawn before.
    fn record(&self, recorder: &mut Recorder, scene: &Scene, half: &Half, corners: u32, first: bool) {
        let depth = if first { wgpu::LoadOp::Clear(0.0) } else { wgpu::LoadOp::Load };
        let color = wgpu::RenderPassColorAttachment {
            view: &self.drawn,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store },
        };
        let depth = wgpu::RenderPassDepthStencilAttachment {
            view: &self.depth,
            depth_ops: Some(wgpu::Operations { load: depth, store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        };
        let group = self.group(scene, &half.draw.get_bind_group_layout(0), half.draw_bindings);
        recorder.render("pick", color, depth, |pass| {
            pass.set_pipeline(&half.draw);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..corners, 0..1);
        });
        let group = self.group(scene, &half.take.get_bind_group_layout(0), half.take_bindings);
        recorder.compute("pick", |pass| {
            pass.set_pipeline(&half.take);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(1, 1, 1);
        });
    }

    fn group(&self, scene: &Scene, layout: &wgpu::BindGroupLayout, bindings: &[u32]) -> wgpu::BindGroup {
        let buffers = scene.tessellator.buffers();
        let (vertices, indices) = scene.tessellator.arena();
        // By their numbers in the shader.
        let all = [
            self.pixel_from_object.as_entire_binding(),
            buffers.points.as_entire_binding(),
            buffers.patches.as_entire_binding(),
            vertices.as_entire_binding(),
            indices.as_entire_binding(),
            wgpu::BindingResource::TextureView(&self.drawn),
            self.pick.as_entire_binding(),
        ];
        let entries = (0..).zip(all).filter(|(binding, _)| bindings.contains(binding));
        let entries: Vec<_> = entries.map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
        let descriptor = wgpu::BindGroupDescriptor { label: Some("pick"), layout, entries: &entries };
        self.gpu.device.create_bind_group(&descriptor)
    }
}

/// Object units to a clip space that is the pixel alone. In f64: the pixel is a thousandth of what it is cut out of.
fn pixel_from_object(pixel: &Pixel) -> Mat4 {
    let size = dvec2(pixel.size[0].into(), pixel.size[1].into());
    let at = dvec2(pixel.at[0].into(), pixel.at[1].into());
    // The pixel's middle, -1 to 1 and upwards.
    let middle = ((at + 0.5) / size * 2.0 - 1.0) * dvec2(1.0, -1.0);
    let narrow =
        DMat4::from_cols(DVec4::X * size.x, DVec4::Y * size.y, DVec4::Z, (-middle * size).extend(0.0).extend(1.0));
    (narrow * pixel.clip_from_object.as_dmat4()).as_mat4()
}

fn pipeline(gpu: &Gpu, module: &wgpu::ShaderModule, vertex: &str) -> wgpu::RenderPipeline {
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(vertex),
        layout: None,
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("pick_fragment"),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: FORMAT,
                blend: None,
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
