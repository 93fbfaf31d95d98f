//! Picking: finds what a picture shows at a pixel.

use std::sync::Arc;

use glam::{DMat4, DVec4, Mat4, Vec2, dvec2};

use super::Scene;
use super::layout::{FOUND_EMITTED, Pick};
use super::render_pipeline::{PipelineParts, depth_state};
use super::target::{DEPTH_FORMAT, color_attachment, depth_attachment};
use geometry::view::ScreenView;
use gpu::layout::Vertex;
use gpu::{
    ComputePipeline, Gpu, GpuError, Lazy, Readback, RecordPasses, Recorder, ShaderModule, empty, flat_texture,
    submit_untimed, uniform_buffer, whole,
};

/// `pick_fragment` draws two numbers. Every adapter can draw into this format, which has four.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;

/// A pixel of a picture, and the picture's view of the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pixel {
    pub clip_from_object: Mat4,
    /// Width and height of the picture, in px.
    pub size: [u32; 2],
    /// The pixel's position in px from the left and from the top.
    pub at: [u32; 2],
    /// Whether the mesh's own triangles are looked at in place of those that are emitted, which takes less time.
    pub has_input: bool,
}

impl Pixel {
    /// The view, and where the pixel's middle is in it.
    pub fn seen(&self) -> (ScreenView, Vec2) {
        let [viewport, middle] = [self.size.map(|side| side as f32), self.at.map(|at| at as f32 + 0.5)].map(Vec2::from);
        (ScreenView { clip_from_object: self.clip_from_object, viewport }, middle)
    }
}

/// What is in front at a pixel's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picked {
    /// Index into [`geometry::mesh::Topology::patches`].
    pub patch: u32,
    /// The weight (0 u, 1 v, 2 w) of the nearest edge on screen.
    pub weight: u32,
    /// `None` if input triangles were looked at.
    pub triangle: Option<PickedTriangle>,
}

/// An emitted triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PickedTriangle {
    /// Its index in its patch: see [`geometry::tessellate::domain_triangle`].
    pub number: u32,
    pub vertices: [Vertex; 3],
}

/// Finds what is drawn at a pixel.
///
/// Everything is drawn into a target of one pixel, with numbers in place of colours. The triangles of a chunk are looked up
/// while the arena holds them, so the result has the vertices as they were emitted.
pub struct Picker {
    emitted: Search,
    source: Search,
}

/// A draw into the pixel, and the pass that takes its result. Their pipelines are made when they are first needed.
struct Search {
    module: Arc<ShaderModule>,
    vertex: &'static str,
    draw: Lazy<wgpu::RenderPipeline>,
    take: ComputePipeline,
}

/// A result on its way to the host.
pub struct Picking(Readback);

impl Default for Picker {
    /// Compiles nothing yet.
    fn default() -> Self {
        let module = Arc::new(ShaderModule::new("draw_pick"));
        let search = |vertex, take| Search {
            module: module.clone(),
            vertex,
            draw: Lazy::default(),
            take: ComputePipeline::new(&module, take),
        };
        Self {
            emitted: search("pick_emitted_vertex", "pick_emitted_main"),
            source: search("pick_source_vertex", "pick_source_main"),
        }
    }
}

impl Picker {
    /// Starts to look for what is drawn at a pixel of a picture of the scene. The scene must be counted.
    ///
    /// # Errors
    /// A pipeline can't be made: out of memory, or a lost device.
    pub fn start(&self, gpu: &Gpu, scene: &mut Scene, pixel: &Pixel) -> Result<Picking, GpuError> {
        let run = Run::new(gpu, pixel)?;
        let mut readback = submit_untimed(gpu, |recorder| {
            if pixel.has_input {
                run.record(recorder, scene, &self.source, 3 * scene.tessellator.buffers().patch_count, true)?;
            } else {
                for index in 0..scene.tessellator.chunk_count() {
                    scene.tessellator.emit(recorder, index)?;
                    let triangles = scene.tessellator.chunk(index).chunk.triangle_count;
                    run.record(recorder, scene, &self.emitted, 3 * triangles, index == 0)?;
                }
            }
            Ok(Readback::from_buffers(gpu, recorder.encoder(), [(&run.pick, 0..run.pick.size())]))
        })?;
        readback.request();
        Ok(Picking(readback))
    }
}

impl Picking {
    /// The result, once it has arrived; `Some(None)` if nothing is drawn at the pixel.
    ///
    /// # Errors
    /// The device was lost.
    pub fn poll(&mut self) -> Result<Option<Option<Picked>>, GpuError> {
        if self.0.poll()? { Ok(Some(found(&self.0.bytes()?))) } else { Ok(None) }
    }

    /// Waits for the result; `None` if nothing is drawn at the pixel.
    ///
    /// # Errors
    /// The device was lost.
    pub fn wait(&mut self, gpu: &Gpu) -> Result<Option<Picked>, GpuError> {
        self.0.wait(gpu).map(|bytes| found(&bytes))
    }
}

/// Decodes the bytes of a [`Pick`].
fn found(bytes: &[u8]) -> Option<Picked> {
    let Pick { vertices, found, patch_index: patch, triangle: number, weight, .. } =
        bytemuck::pod_read_unaligned(bytes);
    let triangle = (found == FOUND_EMITTED).then_some(PickedTriangle { number, vertices });
    (found != 0).then_some(Picked { patch, weight, triangle })
}

/// The resources of one search on the device.
struct Run<'a> {
    gpu: &'a Gpu,
    pixel_from_object: wgpu::Buffer,
    drawn: wgpu::TextureView,
    depth: wgpu::TextureView,
    pick: wgpu::Buffer,
}

impl<'a> Run<'a> {
    fn new(gpu: &'a Gpu, pixel: &Pixel) -> Result<Self, GpuError> {
        let texture = |format, usage| {
            let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | usage;
            whole(&gpu.device.create_texture(&flat_texture("pick", [1, 1], format, usage)))
        };
        let matrix = pixel_from_object(pixel).to_cols_array_2d();
        Ok(Self {
            gpu,
            pixel_from_object: uniform_buffer(gpu, "pick", bytemuck::bytes_of(&matrix)),
            drawn: texture(FORMAT, wgpu::TextureUsages::TEXTURE_BINDING),
            depth: texture(DEPTH_FORMAT, wgpu::TextureUsages::empty()),
            pick: empty::<Pick>(gpu, "pick", 1)?,
        })
    }

    /// Draws a number of corners, and takes the result if it is in front of everything that was drawn before.
    fn record(
        &self,
        recorder: &mut Recorder,
        scene: &Scene,
        search: &Search,
        corners: u32,
        first: bool,
    ) -> Result<(), GpuError> {
        let module = search.module.get(self.gpu)?;
        let draw = search.draw.get_or_make(self.gpu, || {
            let depth = Some(depth_state(true, wgpu::CompareFunction::Greater));
            let parts = PipelineParts::new(module, [search.vertex, "pick_fragment"], Some(FORMAT.into()));
            PipelineParts { depth, ..parts }.pipeline(self.gpu)
        })?;
        let color = color_attachment(&self.drawn, Some(wgpu::Color::TRANSPARENT));
        let depth = depth_attachment(&self.depth, first.then_some(0.0));
        let resource = |name: &str| self.resource(scene, name);
        let group = search.module.bind(self.gpu, search.vertex, &draw.get_bind_group_layout(0), resource);
        recorder.render("pick", Some(color), Some(depth), |pass| {
            pass.set_pipeline(draw);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..corners, 0..1);
        });
        let take = search.take.bind(self.gpu, resource)?;
        recorder.compute("pick", |pass| take.dispatch(pass, [1, 1, 1]));
        Ok(())
    }

    /// What a variable of the shaders stands for.
    fn resource<'b>(&'b self, scene: &'b Scene, name: &str) -> Option<wgpu::BindingResource<'b>> {
        let buffers = scene.tessellator.buffers();
        let (vertices, indices) = scene.tessellator.arena();
        Some(match name {
            "pixel_from_object" => self.pixel_from_object.as_entire_binding(),
            "points" => buffers.points.as_entire_binding(),
            "patches" => buffers.patches.as_entire_binding(),
            "vertex_halves" => vertices.as_entire_binding(),
            "indices" => indices.as_entire_binding(),
            "pick" => self.pick.as_entire_binding(),
            _ => wgpu::BindingResource::TextureView(&self.drawn),
        })
    }
}

/// The matrix from object space to a clip space that holds only this pixel. It is computed in f64, since the pixel is only
/// about a thousandth of the picture's width.
fn pixel_from_object(pixel: &Pixel) -> Mat4 {
    let size = dvec2(pixel.size[0].into(), pixel.size[1].into());
    let at = dvec2(pixel.at[0].into(), pixel.at[1].into());
    // The pixel's middle, from -1 to 1, with y upwards.
    let middle = ((at + 0.5) / size * 2.0 - 1.0) * dvec2(1.0, -1.0);
    let narrow =
        DMat4::from_cols(DVec4::X * size.x, DVec4::Y * size.y, DVec4::Z, (-middle * size).extend(0.0).extend(1.0));
    (narrow * pixel.clip_from_object.as_dmat4()).as_mat4()
}
