//! Tessellates an animated mesh with exported compute passes and wgpu alone: nothing here is of the crate.
//!
//! `cargo run --no-default-features --example exported [OUT.obj]` prints what four moments give, and writes the last. The passes are in
//! `exported/tessellate.wgsl`, which `pnaen shaders --language wgsl -o examples/exported` wrote.

use std::error::Error;
use std::fmt::Write;

use wgpu::util::DeviceExt;

const PASSES: &str = include_str!("exported/tessellate.wgsl");

/// A corner, or a vertex of the output: position, unit normal and texture coordinates.
pub type Corner = [f32; 8];

/// The vertices and the triangles of a tessellation.
pub type Emitted = (Vec<Corner>, Vec<[u32; 3]>);

/// The constant buffer. The exported file lists its members; those of LOD by the view stay 0 here.
pub type Constants = [f32; 48];

/// The place of the factor in the constants.
const FACTOR: usize = 160 / 4;

/// The size in bytes of what the passes keep of a patch.
const HULL_BYTES: u64 = 176;

/// The exported passes with the buffers of a mesh.
pub struct Passes {
    device: wgpu::Device,
    queue: wgpu::Queue,
    pipelines: Vec<(wgpu::ComputePipeline, u32)>,
    bindings: wgpu::BindGroup,
    /// In the order of their bindings.
    buffers: Vec<wgpu::Buffer>,
}

impl Passes {
    /// Uploads a mesh with nine indices a patch, and makes room for so many vertices and triangles.
    pub fn new(
        text: &str,
        corners: &[Corner],
        indices: &[u32],
        [vertices, triangles]: [u64; 2],
    ) -> Result<Self, Box<dyn Error>> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;
        let patches = (indices.len() / 9) as u32;
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        let filled = |contents: &[u8]| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
        };
        let empty = |size, usage| {
            device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
        };
        let buffers = vec![
            empty(size_of::<Constants>() as u64, wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST),
            filled(bytemuck::cast_slice(corners)),
            filled(bytemuck::cast_slice(indices)),
            empty(HULL_BYTES * u64::from(patches), usage),
            empty(8 * u64::from(patches), usage),
            empty(32 * vertices, usage | wgpu::BufferUsages::VERTEX),
            empty(12 * triangles, usage | wgpu::BufferUsages::INDEX),
            empty(28, usage | wgpu::BufferUsages::INDIRECT),
        ];
        let layout = layout(&device);
        let bound: Vec<_> = (0..)
            .zip(&buffers)
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        let bindings =
            device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &bound });
        let pipelines = [("hull_main", patches.div_ceil(64)), ("offsets_main", 1), ("emit_main", patches)];
        let pipelines = pipelines.map(|(entry, workgroups)| (pipeline(&device, &layout, text, entry), workgroups));
        Ok(Self { pipelines: pipelines.into(), device, queue, bindings, buffers })
    }

    /// Tessellates the mesh with its corners where they are now. Returns the vertices and the triangles.
    pub fn run(&self, corners: &[Corner], constants: &Constants) -> Result<Emitted, Box<dyn Error>> {
        self.queue.write_buffer(&self.buffers[0], 0, bytemuck::bytes_of(constants));
        self.queue.write_buffer(&self.buffers[1], 0, bytemuck::cast_slice(corners));
        let mut encoder = self.device.create_command_encoder(&Default::default());
        for (pipeline, workgroups) in &self.pipelines {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &self.bindings, &[]);
            pass.dispatch_workgroups(*workgroups, 1, 1);
        }
        self.queue.submit([encoder.finish()]);
        // A program that draws would stop here: buffer 7 has the arguments of an indirect draw of buffers 5 and 6.
        let status: Vec<u32> = self.read(7, 7)?;
        Ok((self.read(5, status[5] as usize)?, self.read(6, status[6] as usize)?))
    }

    /// Reads the first items of a buffer back.
    fn read<T: bytemuck::AnyBitPattern>(&self, buffer: usize, count: usize) -> Result<Vec<T>, Box<dyn Error>> {
        let size = (count * size_of::<T>()) as u64;
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let staging =
            self.device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(&self.buffers[buffer], 0, &staging, 0, size);
        self.queue.submit([encoder.finish()]);
        staging.map_async(wgpu::MapMode::Read, .., |_| {});
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        let bytes = staging.get_mapped_range(..)?.to_vec();
        Ok(bytes.chunks_exact(size_of::<T>()).map(bytemuck::pod_read_unaligned).collect())
    }
}

/// The layout of the eight buffers.
fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let kind = |binding: u32| match binding {
        0 => wgpu::BufferBindingType::Uniform,
        _ => wgpu::BufferBindingType::Storage { read_only: binding < 3 },
    };
    let entry = |binding| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer { ty: kind(binding), has_dynamic_offset: false, min_binding_size: None },
        count: None,
    };
    let entries: Vec<_> = (0..8).map(entry).collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
}

fn pipeline(device: &wgpu::Device, layout: &wgpu::BindGroupLayout, text: &str, entry: &str) -> wgpu::ComputePipeline {
    let source = wgpu::ShaderSource::Wgsl(text.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        bind_group_layouts: &[Some(layout)],
        ..Default::default()
    });
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry),
        layout: Some(&layout),
        module: &module,
        entry_point: Some(entry),
        compilation_options: Default::default(),
        cache: None,
    })
}

/// The corners of an octahedron that breathes: stretched upwards by `stretch`.
fn corners(stretch: f32) -> Vec<Corner> {
    let axes =
        [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    axes.map(|[x, y, z]: [f32; 3]| [x, y * stretch, z, x, y, z, 0.0, 0.0]).to_vec()
}

/// The indices of its patches. Neighbours share their corners here, so that the corners across a side are the side's own; where
/// normals are split they are others, which `pnaen adjacency` finds.
fn indices() -> Vec<u32> {
    let triangles = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    triangles.into_iter().flat_map(|[a, b, c]| [a, b, c, a, b, b, c, c, a]).collect()
}

/// Tessellates four moments, with a factor that grows. Returns the vertices and triangles of each.
pub fn moments() -> Result<Vec<Emitted>, Box<dyn Error>> {
    let passes = Passes::new(PASSES, &corners(1.0), &indices(), [10_000, 20_000])?;
    let moment = |moment: u8| {
        let mut constants = [0.0; 48];
        constants[FACTOR] = 2.0 + 3.0 * f32::from(moment);
        passes.run(&corners(1.0 + 0.2 * f32::from(moment)), &constants)
    };
    (0..4).map(moment).collect()
}

#[allow(dead_code, reason = "a test takes the moments")]
fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "exported.obj".to_owned());
    let moments = moments()?;
    for (vertices, triangles) in &moments {
        println!("{} vertices, {} triangles", vertices.len(), triangles.len());
    }
    let Some((vertices, triangles)) = moments.last() else { return Ok(()) };
    let mut text = String::new();
    for [x, y, z, ..] in vertices {
        writeln!(text, "v {x} {y} {z}")?;
    }
    for [a, b, c] in triangles.iter().map(|triangle| triangle.map(|corner| corner + 1)) {
        writeln!(text, "f {a} {b} {c}")?;
    }
    std::fs::write(&path, text)?;
    println!("{path}");
    Ok(())
}
