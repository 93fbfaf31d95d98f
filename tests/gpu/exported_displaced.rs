//! Exported shaders that displace: those of tessellation stages on the driver's own, and compute passes on the engine's device.

use documents::assert_part_of_page;
use geometry::mesh::adjacency::Layout;
use geometry::mesh::{Mesh, Shape, Topology};
use geometry::progress::Progress;
use geometry::tessellate::{
    Clip, Convention, Displacement, Edges, Inputs, Lod, LodView, Normals, Partitioning, PatchFactors, Tessellation,
    Vertex, corner_weights, displaced_corners, displacement_reach, tessellate, unpack_normal, usual_amount,
};
use gpu::read_buffer;
use inspect::shader_files::{Language, shader_files};
use wgpu::util::DeviceExt;

use crate::engine;
use crate::exported::{exported_corners, vulkan};
use crate::vulkan::agreement::Agreement;
use crate::vulkan::exported::{DISPLACEMENTS, LANGUAGES, Subject, constants, displaced_rows, displaced_table, wavy};

/// A shape under waves. Texture coordinates are shifted by `shift`, so that the image repeats where it isn't 0.
pub(super) fn shifted(shape: Shape, shift: f32) -> Mesh {
    let mut mesh = shape.build();
    mesh.corners.iter_mut().for_each(|corner| corner.uv += glam::vec2(shift, 0.5 * shift));
    wavy(mesh)
}

/// Same factors, same triangles, positions within 4 ULP: as our passes.
pub(super) fn assert_displaced_agrees(own: &Agreement, what: &str) {
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
    assert_part_of_page("docs/results/shaders.md", "table of displaced agreement", &displaced_table(&rows));
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
    assert_all_agree(&tried);
}

/// Holds exported shaders under each of these to our passes, on a closed mesh and on one of a single side.
pub(super) fn assert_all_agree(tried: &[Tessellation]) {
    for (shape, shift) in [(Shape::Torus, 0.37), (Shape::Moebius, 0.0)] {
        let mut subject = Subject::new(engine(), &vulkan(), shifted(shape, shift)).expect("a small mesh");
        for own in tried {
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
pub(super) struct Passes {
    buffers: Vec<(u32, wgpu::Buffer, wgpu::BufferBindingType)>,
    heights: wgpu::TextureView,
    patches: u32,
}

/// Room for vertices and triangles.
const ROOM: [u64; 2] = [20_000, 40_000];
/// The bindings of what each patch keeps, of the numbers of vertices and triangles, and of the levels that patches find for points.
const HULLS: u32 = 3;
const STATUS: u32 = 7;
const KEPT_LEVELS: u32 = 11;
/// The size of what each patch keeps, in numbers of 32 bits.
const HULL_WORDS: usize = 44;

impl Passes {
    /// Uploads a mesh, as it is seen.
    pub(super) fn new(mesh: &Mesh, topology: &Topology, own: &Tessellation, view: LodView) -> Self {
        let heights = mesh.heights.as_deref().expect("heights");
        let map = &heights.maps[0];
        let inputs = Inputs::new(own, view);
        let view = view.with_reach(displacement_reach(mesh, &inputs));
        let scale = usual_amount(heights, &inputs).scale.to_bits();
        let [width, height] = map.size;
        let height_constants = [
            width,
            height,
            map.levels,
            map.wrap[0] as u32 + 4 * map.wrap[1] as u32,
            scale,
            own.midlevel.to_bits(),
            0,
            0,
        ];
        let corners = exported_corners(mesh, topology);
        let relief = displaced_corners(mesh, topology).expect("one image everywhere");
        let indices = Layout::Eighteen.indices(topology);
        let patches = topology.patches.len() as u64;
        let (read, write) = (
            wgpu::BufferBindingType::Storage { read_only: true },
            wgpu::BufferBindingType::Storage { read_only: false },
        );
        // What other views have left.
        let kept = vec![u32::MAX; 3 * topology.patches.len() + corners.len()];
        let mut buffers = vec![
            (0, filled(bytemuck::bytes_of(&constants(own, &view))), wgpu::BufferBindingType::Uniform),
            (1, filled(bytemuck::cast_slice(&corners)), read),
            (2, filled(bytemuck::cast_slice(&indices)), read),
            (HULLS, empty(4 * HULL_WORDS as u64 * patches), write),
            (4, empty(8 * patches), write),
            (5, empty(32 * ROOM[0]), write),
            (6, empty(12 * ROOM[1]), write),
            (STATUS, empty(28), write),
            (8, filled(bytemuck::bytes_of(&height_constants)), wgpu::BufferBindingType::Uniform),
            (9, filled(bytemuck::cast_slice(&relief)), read),
        ];
        if own.used_lod() != Lod::Uniform {
            buffers.push((KEPT_LEVELS, filled(bytemuck::cast_slice(&kept)), write));
        }
        Self { buffers, heights: height_texture(map), patches: patches as u32 }
    }

    /// Runs the passes. Returns the vertices and the triangles.
    pub(super) fn run(&self, text: &str) -> (Vec<[f32; 8]>, Vec<[u32; 3]>) {
        let device = &engine().gpu.device;
        let source = wgpu::ShaderSource::Wgsl(text.into());
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        let mut encoder = device.create_command_encoder(&Default::default());
        if let Some((_, kept, _)) = self.buffers.iter().find(|(binding, _, _)| *binding == KEPT_LEVELS) {
            encoder.clear_buffer(kept, 0, None);
        }
        for (entry, workgroups) in
            [("hull_main", self.patches.div_ceil(64)), ("offsets_main", 1), ("emit_main", self.patches)]
        {
            let layout = self.layout(self.unused_by(entry));
            let bound = self.bound(&layout, self.unused_by(entry));
            let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                bind_group_layouts: &[Some(&layout)],
                ..Default::default()
            });
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
        let status: Vec<u32> = self.read(STATUS, 7);
        (self.read(5, status[5] as usize), self.read(6, status[6] as usize))
    }

    /// The factors that the tessellator worked with in the last run, in whole 1/65536: of the edges of every patch, and inside.
    pub(super) fn factors(&self) -> Vec<PatchFactors> {
        let words: Vec<u32> = self.read(HULLS, HULL_WORDS * self.patches as usize);
        let of = |words: &[u32]| PatchFactors { outside: [words[40], words[41], words[42]], inside: words[43] };
        words.chunks_exact(HULL_WORDS).map(of).collect()
    }

    /// The binding that a pass does without where all would be more storage buffers than WebGPU has by default.
    fn unused_by(&self, entry: &str) -> Option<u32> {
        let keeps_levels = self.buffers.iter().any(|(binding, _, _)| *binding == KEPT_LEVELS);
        keeps_levels.then_some(if entry == "offsets_main" { KEPT_LEVELS } else { STATUS })
    }

    fn bound(&self, layout: &wgpu::BindGroupLayout, without: Option<u32>) -> wgpu::BindGroup {
        let image = wgpu::BindingResource::TextureView(&self.heights);
        let mut entries = vec![wgpu::BindGroupEntry { binding: 10, resource: image }];
        for (binding, buffer, _) in self.buffers.iter().filter(|(binding, _, _)| Some(*binding) != without) {
            entries.push(wgpu::BindGroupEntry { binding: *binding, resource: buffer.as_entire_binding() });
        }
        let descriptor = wgpu::BindGroupDescriptor { label: None, layout, entries: &entries };
        engine().gpu.device.create_bind_group(&descriptor)
    }

    fn layout(&self, without: Option<u32>) -> wgpu::BindGroupLayout {
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty,
            count: None,
        };
        let of_buffer = |(binding, _, ty): &(u32, wgpu::Buffer, wgpu::BufferBindingType)| {
            entry(*binding, wgpu::BindingType::Buffer { ty: *ty, has_dynamic_offset: false, min_binding_size: None })
        };
        let used = self.buffers.iter().filter(|(binding, _, _)| Some(*binding) != without);
        let mut entries: Vec<_> = used.map(of_buffer).collect();
        // But for the two uniform buffers.
        let storage = entries.len() as u32 - 2;
        assert!(storage <= wgpu::Limits::default().max_storage_buffers_per_shader_stage, "{storage} storage buffers");
        let image = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        entries.push(entry(10, image));
        let device = &engine().gpu.device;
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
    }

    fn read<T: bytemuck::AnyBitPattern>(&self, binding: u32, count: usize) -> Vec<T> {
        let bytes = (count * size_of::<T>()) as u64;
        let (_, buffer, _) = self.buffers.iter().find(|(own, _, _)| *own == binding).expect("a binding");
        let bytes = read_buffer(&engine().gpu, buffer, 0, bytes).expect("a readback");
        bytes.chunks_exact(size_of::<T>()).map(bytemuck::pod_read_unaligned).collect()
    }
}

const USAGE: wgpu::BufferUsages = wgpu::BufferUsages::STORAGE
    .union(wgpu::BufferUsages::UNIFORM)
    .union(wgpu::BufferUsages::COPY_SRC)
    .union(wgpu::BufferUsages::COPY_DST);

fn filled(contents: &[u8]) -> wgpu::Buffer {
    let descriptor = wgpu::util::BufferInitDescriptor { label: None, contents, usage: USAGE };
    engine().gpu.device.create_buffer_init(&descriptor)
}

fn empty(size: u64) -> wgpu::Buffer {
    let descriptor = wgpu::BufferDescriptor { label: None, size, usage: USAGE, mapped_at_creation: false };
    engine().gpu.device.create_buffer(&descriptor)
}

/// One channel with all mip levels, which lie in the map as a texture takes them.
fn height_texture(map: &geometry::mesh::HeightMap) -> wgpu::TextureView {
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
            let view = LodView::new(glam::Mat4::IDENTITY, glam::Vec2::ONE);
            let (vertices, triangles) = Passes::new(&mesh, &topology, &own, view).run(&files[0].text);
            let inputs = Inputs::new(&own, view);
            let cpu = tessellate(&mesh, &topology, &inputs, None);
            let what = format!("{shape:?} {own:?}");
            assert!(triangles == cpu.triangles, "{what}: triangles");
            assert_near(&vertices, &cpu.vertices, size, &what);
        }
    }
}

/// Holds displaced vertices of compute passes on a mesh of this size to those of the CPU.
pub(super) fn assert_near(vertices: &[[f32; 8]], cpu: &[Vertex], size: f32, what: &str) {
    assert_eq!(vertices.len(), cpu.len(), "{what}");
    for (own, other) in vertices.iter().zip(cpu) {
        let [p, n] = [[own[0], own[1], own[2]], [own[3], own[4], own[5]]].map(glam::Vec3::from);
        // As of our passes: levels are logarithms, good to some 1e-6 of one, and a level is at most the whole height.
        assert!(p.distance(other.position.into()) <= 1e-5 * size, "{what}: {own:?} {other:?}");
        assert!(n.distance(unpack_normal(other.normal)) < 2e-3, "{what}: {own:?} {other:?}");
    }
}
