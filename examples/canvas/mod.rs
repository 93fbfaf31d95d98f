//! What a program that embeds pnaen already has: a device, a picture to draw in, and a shader of its own.

use std::error::Error;

use glam::camera::rh::{proj::directx::perspective_infinite_reverse, view::look_at_mat4};
use glam::{Mat4, Vec3};
use pnaen::embed::{NORMAL_WGSL, OutputStatus, TessellatedMesh, VERTEX_LAYOUTS};
use pnaen::tessellate::{DepthRange, LodView};

const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Shades a vertex by the light from the upper left, and tints every patch a little differently.
const SHADER: &str = "
    @group(0) @binding(0) var<uniform> clip_from_object: mat4x4<f32>;

    struct Shaded { @builtin(position) at: vec4<f32>, @location(0) normal: vec3<f32>, @location(1) tint: f32 }

    @vertex fn vertex(@location(0) position: vec3<f32>, @location(1) normal: u32, @location(2) key: vec2<u32>) -> Shaded {
        let patch_number = key.y >> 2;
        let tint = 0.8 + 0.2 * f32((patch_number * 7u) % 5u) / 4.0;
        return Shaded(clip_from_object * vec4(position, 1.0), unpack_normal(normal), tint);
    }

    @fragment fn fragment(shaded: Shaded) -> @location(0) vec4<f32> {
        let light = 0.04 + 0.96 * max(dot(normalize(shaded.normal), normalize(vec3(-2.0, 2.0, 1.5))), 0.0);
        return vec4(vec3(0.8, 0.42, 0.12) * light * shaded.tint, 1.0);
    }
";

/// A device without a window, and what the host draws with.
pub(crate) struct Canvas {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    /// Width and height of the picture, in px.
    size: [u32; 2],
    color: wgpu::Texture,
    depth: wgpu::TextureView,
    pipeline: wgpu::RenderPipeline,
    camera: wgpu::Buffer,
    bindings: wgpu::BindGroup,
    /// Buffers through which the host reads the output's status and the picture's px.
    status: wgpu::Buffer,
    pixels: wgpu::Buffer,
}

impl Canvas {
    /// Makes a canvas for pictures of this width (a multiple of 64) and height, in px.
    pub(crate) fn new(size: [u32; 2]) -> Result<Self, Box<dyn Error>> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;
        let texture = |format, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        };
        let buffer = |size, usage| {
            device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
        };
        let readable = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ;
        let pipeline = pipeline(&device);
        let camera = buffer(size_of::<Mat4>() as u64, wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST);
        let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: camera.as_entire_binding() }],
        });
        Ok(Self {
            color: texture(COLOR, wgpu::TextureUsages::COPY_SRC),
            depth: texture(DEPTH, wgpu::TextureUsages::empty()).create_view(&Default::default()),
            status: buffer(size_of::<OutputStatus>() as u64, readable),
            pixels: buffer(u64::from(4 * size[0] * size[1]), readable),
            pipeline,
            camera,
            bindings,
            device,
            queue,
            size,
        })
    }

    /// Looks from `eye` at `target`, both in object units; `radius` is the mesh's bounding radius.
    pub(crate) fn look(&self, eye: Vec3, target: Vec3, radius: f32) -> LodView {
        let [width, height] = self.size.map(|side| side as f32);
        let clip_from_view = perspective_infinite_reverse(0.7, width / height, 0.1);
        let clip_from_object = clip_from_view * look_at_mat4(eye, target, Vec3::Y);
        self.queue.write_buffer(&self.camera, 0, bytemuck::bytes_of(&clip_from_object));
        LodView::from_camera(clip_from_object, DepthRange::Reversed, glam::vec2(width, height), radius)
    }

    /// Draws the mesh in a render pass of the host's own.
    pub(crate) fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        mesh: &TessellatedMesh,
    ) -> Result<(), Box<dyn Error>> {
        let color = self.color.create_view(&Default::default());
        let background = wgpu::Color { r: 0.02, g: 0.02, b: 0.03, a: 1.0 };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &color,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(background), store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bindings, &[]);
        let [places, details] = mesh.vertex_buffers();
        pass.set_vertex_buffer(0, places);
        pass.set_vertex_buffer(1, details);
        pass.set_index_buffer(mesh.index_buffer(), wgpu::IndexFormat::Uint32);
        let (arguments, offset) = mesh.draw_arguments(0)?;
        pass.draw_indexed_indirect(arguments, offset);
        Ok(())
    }

    /// Submits the encoder, and waits for the picture and for what the passes say about their output.
    pub(crate) fn finish(
        &self,
        mut encoder: wgpu::CommandEncoder,
        mesh: &TessellatedMesh,
    ) -> Result<(image::RgbaImage, OutputStatus), Box<dyn Error>> {
        let (status, range) = mesh.status_buffer();
        encoder.copy_buffer_to_buffer(status, range.start, &self.status, 0, range.end - range.start);
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * self.size[0]), rows_per_image: None };
        encoder.copy_texture_to_buffer(
            self.color.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &self.pixels, layout },
            self.color.size(),
        );
        self.queue.submit([encoder.finish()]);
        let (status, pixels) = (self.read(&self.status)?, self.read(&self.pixels)?);
        let picture =
            image::RgbaImage::from_raw(self.size[0], self.size[1], pixels).ok_or("the picture lacks some of its px")?;
        Ok((picture, bytemuck::pod_read_unaligned(&status)))
    }

    fn read(&self, buffer: &wgpu::Buffer) -> Result<Vec<u8>, Box<dyn Error>> {
        buffer.map_async(wgpu::MapMode::Read, .., |_| {});
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        let bytes = buffer.get_mapped_range(..)?.to_vec();
        buffer.unmap();
        Ok(bytes)
    }
}

fn pipeline(device: &wgpu::Device) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl([SHADER, NORMAL_WGSL].concat().into()),
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &VERTEX_LAYOUTS,
        },
        primitive: wgpu::PrimitiveState { cull_mode: Some(wgpu::Face::Back), ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            // The view's depth is reversed: 1 at the near plane, 0 far away.
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fragment"),
            compilation_options: Default::default(),
            targets: &[Some(COLOR.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
