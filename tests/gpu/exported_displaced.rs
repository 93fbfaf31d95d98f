//! Exported shaders that displace: those of tessellation stages on the driver's own, and compute passes on the engine's device.

use pnaen::gpu::read_buffer;
use pnaen::mesh::adjacency::Layout;
use pnaen::mesh::{Mesh, Shape, Topology};
use pnaen::progress::Progress;
use pnaen::shader_files::{Language, shader_files};
use pnaen::tessellate::{
    Clip, Convention, Displacement, Edges, Inputs, LodView, Normals, Partitioning, Tessellation, corner_weights,
    displaced_corners, height_units, tessellate, unpack_normal,
};
use wgpu::util::DeviceExt;

use crate::gpu_tests::engine;
use crate::gpu_tests::exported::{assert_part_of_page, exported_corners, vulkan};
use crate::gpu_tests::vulkan::agreement::Agreement;
use crate::gpu_tests::vulkan::exported::{DISPLACEMENTS, LANGUAGES, Subject, displaced_rows, displaced_table, wavy};

/// A shape under waves. Texture coordinates are shifted by `shift`, so that the image repeats where it isn't 0.
fn shifted(shape: Shape, shift: f32) -> Mesh {
    let mut mesh = shape.build();
    mesh.corners.iter_mut().for_each(|corner| corner.uv += glam::vec2(shift, 0.5 * shift));
    wavy(mesh)
}

/// Same factors, same triangles, positions within 4 ULP: as our passes.
fn assert_displaced_agrees(own: &Agreement, what: &str) {
    assert!(own.triangles > 0, "{what}: nothing came out");
    assert_eq!(own.other_triangles, 0, "{what}: {own:?}");
    assert!(own.factors <= 1e-5, "{what}: {own:?}");
    assert!(own.position_ulps <= 4.0, "{what}: {own:?}");
    // Slopes are differences of heights over a px, which enlarge what texture coordinates differ by; and ours tilt a normal that has
    // 32 bits.
    assert!(own.normals <= 1e-3, "{what}: {own:?}");
}

#[test]
fn every_displaced_surface_agrees_with_our_passes_and_the_page_says_so() {
    let mut subject = Subject::new(engine(), &vulkan(), wavy(Shape::CubeSplit.build())).expect("a small mesh");
    let rows = displaced_rows(&mut subject).expect("shaders that run");
    for row in &rows {
        let what = format!("{:?} {:?} {:?}", row.surface, row.displacement, row.language);
        assert_displaced_agrees(&row.agreement, &what);
        assert!(row.agreement.shared > 50, "{what}: {:?}", row.agreement);
        let tears = row.surface.tears() || row.displacement != Displacement::On;
        assert_eq!(row.agreement.torn > 0, tears, "{what}: {:?}", row.agreement);
    }
    assert_eq!(rows.len(), 48);
    assert_part_of_page("docs/manual/shaders.md", "table of displaced agreement", &displaced_table(&rows));
}

#[test]
fn displaced_partitionings_conventions_and_normals_agree_too() {
    let usual = Tessellation { factor: 5.3, height_scale: 0.2, midlevel: 0.3, ..Tessellation::default() };
    let mut tried = Vec::new();
    for displacement in DISPLACEMENTS {
        for normals in [Normals::Linear, Normals::Quadratic, Normals::Surface] {
            tried.push(Tessellation { displacement, normals, ..usual });
        }
    }
    let usual = Tessellation { displacement: Displacement::On, ..usual };
    for partitioning in [Partitioning::Integer, Partitioning::Pow2, Partitioning::FractionalEven] {
        tried.push(Tessellation { partitioning, ..usual });
    }
    for convention in [Convention::AmdPn, Convention::EdgeOrder] {
        tried.push(Tessellation { convention, ..usual });
    }
    tried.push(Tessellation { edges: Edges::AsPublished, ..usual });
    // Patches that only displacement moves into view stay, and back faces, too.
    tried.push(Tessellation { clip: Clip::Frustum, cull_back_faces: true, ..usual });
    for (shape, shift) in [(Shape::Torus, 0.37), (Shape::Moebius, 0.0)] {
        let mut subject = Subject::new(engine(), &vulkan(), shifted(shape, shift)).expect("a small mesh");
        for own in &tried {
            for language in LANGUAGES {
                let weights = |domain| corner_weights(own.convention, domain);
                let agreement = subject.agreement(language, own, &weights).expect("shaders that run");
                let what = format!("{shape:?} {own:?} {language:?}");
                assert_displaced_agrees(&agreement, &what);
                let is_whole = own.displacement == Displacement::On
                    && own.edges == Edges::PerEdge
                    && own.convention.is_consistent();
                assert!(!is_whole || agreement.torn == 0, "{what}: {agreement:?}");
            }
        }
    }
}

/// What exported compute passes read and write, in the order of their bindings.
struct Passes {
    buffers: Vec<(u32, wgpu::Buffer, wgpu::BufferBindingType)>,
    heights: wgpu::TextureView,
    patches: u32,
}

/// Room for vertices and triangles.
const ROOM: [u64; 2] = [20_000, 40_000];

impl Passes {
    fn new(mesh: &Mesh, topology: &Topology, own: &Tessellation) -> Self {
        let heights = mesh.heights.as_deref().expect("heights");
        let map = &heights.maps()[0];
        let inputs = Inputs::new(own, LodView::new(glam::Mat4::IDENTITY, glam::Vec2::ONE));
        let mut constants = [0.0f32; 48];
        constants[40] = own.factor;
        let scale = height_units(heights, &inputs).to_bits();
        let [width, height] = map.size;
        let height_constants = [width, height, map.levels, u32::from(map.repeats), scale, own.midlevel.to_bits(), 0, 0];
        let corners = exported_corners(mesh, topology);
        let relief = displaced_corners(mesh, topology).expect("one image everywhere");
        let indices = Layout::Eighteen.indices(topology);
        let patches = topology.patches.len() as u64;
        let (read, write) = (
            wgpu::BufferBindingType::Storage { read_only: true },
            wgpu::BufferBindingType::Storage { read_only: false },
        );
        let buffers = vec![
            (0, filled(bytemuck::bytes_of(&constants)), wgpu::BufferBindingType::Uniform),
            (1, filled(bytemuck::cast_slice(&corners)), read),
            (2, filled(bytemuck::cast_slice(&indices)), read),
            (3, empty(176 * patches), write),
            (4, empty(8 * patches), write),
            (5, empty(32 * ROOM[0]), write),
            (6, empty(12 * ROOM[1]), write),
            (7, empty(28), write),
            (8, filled(bytemuck::bytes_of(&height_constants)), wgpu::BufferBindingType::Uniform),
            (9, filled(bytemuck::cast_slice(&relief)), read),
        ];
        Self { buffers, heights: height_texture(map), patches: patches as u32 }
    }

    /// Runs the passes. Returns the vertices and the triangles.
    fn run(&self, text: &str) -> (Vec<[f32; 8]>, Vec<[u32; 3]>) {
        let device = &engine().gpu.device;
        let layout = self.layout();
        let image = wgpu::BindingResource::TextureView(&self.heights);
        let mut entries = vec![wgpu::BindGroupEntry { binding: 10, resource: image }];
        for (binding, buffer, _) in &self.buffers {
            entries.push(wgpu::BindGroupEntry { binding: *binding, resource: buffer.as_entire_binding() });
        }
        let bound =
            device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries });
        let source = wgpu::ShaderSource::Wgsl(text.into());
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            bind_group_layouts: &[Some(&layout)],
            ..Default::default()
        });
        let mut encoder = device.create_command_encoder(&Default::default());
        for (entry, workgroups) in
            [("hull_main", self.patches.div_ceil(64)), ("offsets_main", 1), ("emit_main", self.patches)]
        {
            let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry),
                layout: Some(&pipeline_layout),
                module: &module,
                entry_point: Some(entry),
                compilation_options: Default::default(),
                cache: None,
            });
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &bound, &[]);
            pass.dispatch_workgroups(workgroups, 1, 1);
        }
        engine().gpu.queue.submit([encoder.finish()]);
        let status: Vec<u32> = self.read(7, 7);
        (self.read(5, status[5] as usize), self.read(6, status[6] as usize))
    }

    fn layout(&self) -> wgpu::BindGroupLayout {
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty,
            count: None,
        };
        let of_buffer = |(binding, _, ty): &(u32, wgpu::Buffer, wgpu::BufferBindingType)| {
            entry(*binding, wgpu::BindingType::Buffer { ty: *ty, has_dynamic_offset: false, min_binding_size: None })
        };
        let mut entries: Vec<_> = self.buffers.iter().map(of_buffer).collect();
        let image = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        entries.push(entry(10, image));
        let device = &engine().gpu.device;
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
    }

    fn read<T: bytemuck::AnyBitPattern>(&self, buffer: usize, count: usize) -> Vec<T> {
        let bytes = (count * size_of::<T>()) as u64;
        let bytes = read_buffer(&engine().gpu, &self.buffers[buffer].1, 0, bytes).expect("a readback");
        bytes.chunks_exact(size_of::<T>()).map(bytemuck::pod_read_unaligned).collect()
    }
}

const USAGE: wgpu::BufferUsages =
    wgpu::BufferUsages::STORAGE.union(wgpu::BufferUsages::UNIFORM).union(wgpu::BufferUsages::COPY_SRC);

fn filled(contents: &[u8]) -> wgpu::Buffer {
    let descriptor = wgpu::util::BufferInitDescriptor { label: None, contents, usage: USAGE };
    engine().gpu.device.create_buffer_init(&descriptor)
}

fn empty(size: u64) -> wgpu::Buffer {
    let descriptor = wgpu::BufferDescriptor { label: None, size, usage: USAGE, mapped_at_creation: false };
    engine().gpu.device.create_buffer(&descriptor)
}

/// One channel with all mip levels, which lie in the map as a texture takes them.
fn height_texture(map: &pnaen::mesh::HeightMap) -> wgpu::TextureView {
    let [width, height] = map.size;
    let descriptor = wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: map.levels,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::R32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let (order, data) = (wgpu::util::TextureDataOrder::LayerMajor, bytemuck::cast_slice(&map.heights));
    let texture = engine().gpu.device.create_texture_with_data(&engine().gpu.queue, &descriptor, order, data);
    texture.create_view(&Default::default())
}

#[test]
fn exported_compute_passes_displace_as_the_cpu_does() {
    for (shape, shift) in [(Shape::CubeSplit, 0.0), (Shape::Torus, 0.37)] {
        let mesh = shifted(shape, shift);
        let topology = Topology::build(&mesh, &Progress::new()).expect("not cancelled");
        let size = mesh.bounds().radius();
        for (turn, partitioning) in Partitioning::ALL.into_iter().enumerate() {
            let own = Tessellation {
                partitioning,
                displacement: DISPLACEMENTS[turn % 3],
                normals: [Normals::Linear, Normals::Surface][turn % 2],
                factor: 5.3,
                height_scale: 0.2,
                midlevel: 0.3,
                ..Tessellation::default()
            };
            let files = shader_files(Language::Wgsl, &own, "a test").expect("WGSL of any pattern");
            let (vertices, triangles) = Passes::new(&mesh, &topology, &own).run(&files[0].text);
            let inputs = Inputs::new(&own, LodView::new(glam::Mat4::IDENTITY, glam::Vec2::ONE));
            let cpu = tessellate(&mesh, &topology, &inputs, None);
            let what = format!("{shape:?} {own:?}");
            assert!(triangles == cpu.triangles, "{what}: triangles");
            assert_eq!(vertices.len(), cpu.vertices.len(), "{what}");
            for (own, other) in vertices.iter().zip(&cpu.vertices) {
                let [p, n] = [[own[0], own[1], own[2]], [own[3], own[4], own[5]]].map(glam::Vec3::from);
                // As of our passes: levels are logarithms, good to some 1e-6 of one, and a level is at most the whole height.
                assert!(p.distance(other.position.into()) <= 1e-5 * size, "{what}: {own:?} {other:?}");
                assert!(n.distance(unpack_normal(other.normal)) < 2e-3, "{what}: {own:?} {other:?}");
            }
        }
    }
}
