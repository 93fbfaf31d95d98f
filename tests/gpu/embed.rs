//! Tessellation on a host program's own device, and the two examples.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use geometry::mesh::{Corner, Mesh, MeshSlices, Moment, Pose, Shape, Topology};
use geometry::tessellate::{Clip, Edges, Inputs, LodView, Surface, Tessellated, Tessellation, tessellate};
use glam::{Mat4, Vec2, Vec3};
use gpu::embed::{Capacity, Context, GpuError, OutputStatus, TessellatedMesh};
use gpu::{RecordPasses, Tessellator, put_together, read_buffer};
use inspect::engine::Engine;

use crate::engine;
use crate::pictures::differing;

// Each example is a crate of its own, and both have the same canvas.
#[allow(unreachable_pub, clippy::duplicate_mod)]
#[path = "../../examples/animate.rs"]
mod animate_example;
#[allow(unreachable_pub, clippy::duplicate_mod)]
#[path = "../../examples/embed.rs"]
mod embed_example;

/// A device as a host has it: with WebGPU's default limits and no features.
fn host() -> (wgpu::Device, wgpu::Queue) {
    host_with(wgpu::Limits::default())
}

/// A device with these limits and no features.
fn host_with(required_limits: wgpu::Limits) -> (wgpu::Device, wgpu::Queue) {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()));
    let descriptor = wgpu::DeviceDescriptor { required_limits, ..Default::default() };
    pollster::block_on(adapter.expect("an adapter").request_device(&descriptor)).expect("a device")
}

const ROOM: Capacity = Capacity { vertices: 40_000, triangles: 70_000 };

fn uniform(factor: f32) -> Tessellation {
    Tessellation { factor, ..Tessellation::default() }
}

/// Records and submits, and reads what was emitted.
fn emitted(queue: &wgpu::Queue, device: &wgpu::Device, mesh: &mut TessellatedMesh) -> (OutputStatus, Tessellated) {
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    mesh.record(&mut encoder).expect("passes");
    queue.submit([encoder.finish()]);
    let gpu = gpu::Gpu::borrowed(device, queue);
    let (buffer, range) = mesh.status_buffer();
    let status: OutputStatus =
        bytemuck::pod_read_unaligned(&read_buffer(&gpu, buffer, range.start, range.end - range.start).expect("status"));
    let read = |slice: wgpu::BufferSlice, bytes: u32| {
        read_buffer(&gpu, slice.buffer(), slice.offset(), u64::from(bytes)).expect("a readback")
    };
    let halves = mesh.vertex_buffers().map(|half| read(half, 16 * status.vertices)).concat();
    let triangles = bytemuck::pod_collect_to_vec(&read(mesh.index_buffer(), 12 * status.triangles));
    let mut vertices = Vec::new();
    put_together(&halves, &mut vertices);
    (status, Tessellated { vertices, triangles, ..Tessellated::default() })
}

/// The corners of a mesh as arrays.
fn from_arrays(mesh: &Mesh) -> Mesh {
    let array = |of: fn(&Corner) -> Vec3| mesh.corners.iter().map(|corner| of(corner).to_array()).collect::<Vec<_>>();
    let uvs: Vec<_> = mesh.corners.iter().map(|corner| corner.uv.to_array()).collect();
    let (positions, normals) = (array(|corner| corner.position), array(|corner| corner.normal));
    let indices = mesh.triangles.as_flattened();
    Mesh::from_slices(&MeshSlices { positions: &positions, normals: &normals, uvs: &uvs, indices }).expect("a mesh")
}

#[test]
fn another_view_of_a_mesh_shares_it_and_has_settings_and_output_of_its_own() {
    let (device, queue) = host();
    let context = Context::new(&device, &queue).expect("default limits");
    let shape = std::sync::Arc::new(Shape::Torus.build());
    let mut first = TessellatedMesh::new(&context, shape.clone(), ROOM).expect("small");
    let mut second = first.another_view(ROOM).expect("small");
    assert!(std::ptr::eq(first.mesh(), second.mesh()) && std::ptr::eq(first.topology(), second.topology()));
    for (mesh, factor) in [(&mut first, 2.0), (&mut second, 5.0)] {
        let tessellation = Tessellation { factor, ..Tessellation::default() };
        mesh.set(&tessellation, LodView::default()).expect("small");
        let (_, output) = emitted(&queue, &device, mesh);
        let inputs = Inputs::new(&tessellation, LodView::default());
        assert_eq!(output.triangles, tessellate(&shape, &Topology::new(&shape), &inputs, None).triangles, "{factor}");
    }
}

#[test]
fn a_host_gets_what_the_reference_emits() {
    let (device, queue) = host();
    let context = Context::new(&device, &queue).expect("default limits are enough");
    let shape = from_arrays(&Shape::CubeSplit.build());
    let mut mesh = TessellatedMesh::new(&context, shape.clone(), ROOM).expect("a small mesh");
    let (before, _) = emitted(&queue, &device, &mut mesh);
    assert_eq!((before.patches, before.triangles), (0, 0), "nothing was asked for yet");
    for factor in [1.0, 7.3, 12.0, 3.0] {
        let tessellation = uniform(factor);
        mesh.set(&tessellation, LodView::default()).expect("a small mesh");
        let (status, output) = emitted(&queue, &device, &mut mesh);
        let inputs = Inputs::new(&tessellation, LodView::default());
        let expected = tessellate(&shape, &Topology::new(&shape), &inputs, None);
        assert!(!mesh.has_overflowed(&status));
        let [first_patch, patches, first_vertex, first_triangle, ..] = bytemuck::cast::<_, [u32; 6]>(status);
        assert_eq!([first_patch, first_vertex, first_triangle, patches], [0, 0, 0, mesh.patches()]);
        assert_eq!(output.triangles, expected.triangles);
        assert_eq!(output.vertices.len(), expected.vertices.len());
        for (vertex, expected) in output.vertices.iter().zip(&expected.vertices) {
            assert_eq!(vertex.key, expected.key);
            // Drivers may fuse multiplications and additions.
            let [position, other] = [vertex, expected].map(|vertex| Vec3::from(vertex.position));
            assert!(position.distance(other) < 1e-6, "{position} {other}");
        }
    }
}

#[test]
fn output_that_does_not_fit_is_a_flag_and_whole_patches() {
    let (device, queue) = host();
    let context = Context::new(&device, &queue).expect("default limits are enough");
    let shape = Shape::Icosphere.build();
    let mut mesh =
        TessellatedMesh::new(&context, shape.clone(), Capacity { vertices: 0, triangles: 0 }).expect("small");
    mesh.set(&uniform(20.0), LodView::default()).expect("a small mesh");
    let (status, output) = emitted(&queue, &device, &mut mesh);
    assert!(mesh.has_overflowed(&status));
    let whole = tessellate(&shape, &Topology::new(&shape), &Inputs::new(&uniform(20.0), LodView::default()), None);
    assert!(status.patches > 0 && status.patches < mesh.patches(), "{status:?}");
    assert_eq!(output.triangles, whole.triangles[..output.triangles.len()]);
    assert!(output.vertices.iter().all(|vertex| vertex.patch() < status.patches));
    // The same room is enough for less.
    mesh.set(&uniform(1.0), LodView::default()).expect("a small mesh");
    let (status, _) = emitted(&queue, &device, &mut mesh);
    assert!(!mesh.has_overflowed(&status) && status.patches == mesh.patches());
}

#[test]
fn what_clipping_leaves_out_is_no_overflow() {
    let (device, queue) = host();
    let context = Context::new(&device, &queue).expect("default limits are enough");
    let mut mesh = TessellatedMesh::new(&context, Shape::CubeSplit.build(), ROOM).expect("a small mesh");
    // Everything is moved out of the view to the right.
    let view = LodView::new(Mat4::from_translation(Vec3::X * 100.0), Vec2::splat(100.0));
    mesh.set(&Tessellation { clip: Clip::Frustum, ..uniform(4.0) }, view).expect("a small mesh");
    let (status, _) = emitted(&queue, &device, &mut mesh);
    assert_eq!((status.triangles, mesh.has_overflowed(&status)), (0, false));
}

#[test]
fn a_mesh_without_triangles_draws_nothing() {
    let (device, queue) = host();
    let context = Context::new(&device, &queue).expect("default limits are enough");
    let nothing = Mesh::from_slices(&MeshSlices::default()).expect("no triangles");
    let mut mesh = TessellatedMesh::new(&context, nothing, ROOM).expect("a small mesh");
    mesh.set(&uniform(4.0), LodView::default()).expect("a small mesh");
    let (status, _) = emitted(&queue, &device, &mut mesh);
    assert_eq!((status.vertices, status.triangles, mesh.has_overflowed(&status)), (0, 0, false));
    let (arguments, offset) = mesh.draw_arguments(0).expect("its one material");
    let count = read_buffer(&gpu::Gpu::borrowed(&device, &queue), arguments, offset, 4).expect("a readback");
    assert_eq!(count, [0_u8; 4], "the number of indices");
}

#[test]
fn a_material_that_a_mesh_lacks_is_an_error() {
    let (device, queue) = host();
    let context = Context::new(&device, &queue).expect("default limits are enough");
    let mesh = TessellatedMesh::new(&context, Shape::Torus.build(), ROOM).expect("a small mesh");
    let materials = mesh.mesh().materials.len() as u32;
    assert!((0..materials).all(|material| mesh.draw_arguments(material).is_ok()));
    for material in [materials, u32::MAX] {
        let said = mesh.draw_arguments(material).expect_err("there is none").to_string();
        assert!(said.contains(&format!("no material {material}: it has {materials}")), "{said}");
    }
}

/// The names of passes, which don't run.
#[derive(Default)]
struct Names(Vec<&'static str>);

impl RecordPasses for Names {
    fn compute(&mut self, pass: &'static str, _: impl FnOnce(&mut wgpu::ComputePass)) {
        self.0.push(pass);
    }
}

#[test]
fn only_what_changed_is_recorded() {
    let Engine { gpu, pipelines, .. } = engine();
    let (mesh, topology) = (Arc::new(Shape::CubeSplit.build()), Arc::new(Topology::new(&Shape::CubeSplit.build())));
    let mut tessellator =
        Tessellator::with_capacity(gpu, pipelines.clone(), mesh, topology, Capacity { vertices: 0, triangles: 0 })
            .expect("a small mesh");
    let mut recorded = |tessellation: Option<Tessellation>| {
        let mut names = Names::default();
        if let Some(tessellation) = tessellation {
            tessellator.set(&Inputs::new(&tessellation, LodView::default())).expect("a small mesh");
        }
        tessellator.record_first_chunk(&mut names).expect("pipelines");
        names.0
    };
    let after_nets = ["factors", "counts", "scan", "chunks", "emit"];
    assert_eq!(recorded(None), Vec::<&str>::new(), "nothing was asked for yet");
    assert_eq!(recorded(Some(uniform(4.0))), [&["nets"], &after_nets[..]].concat());
    assert_eq!(recorded(None), Vec::<&str>::new());
    assert_eq!(recorded(Some(uniform(4.0))), Vec::<&str>::new());
    assert_eq!(recorded(Some(uniform(5.0))), after_nets);
    let flat = Tessellation { surface: Surface::Flat, ..uniform(5.0) };
    assert_eq!(recorded(Some(flat)), [&["nets"], &after_nets[..]].concat());
}

/// A mesh with a skin, and without morph targets.
fn tube() -> Mesh {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/tube.gltf");
    let tube = load::load(&path, &load::Limits::default(), &geometry::progress::Progress::new());
    tube.expect("a small file").mesh
}

#[test]
fn a_pose_moves_what_is_emitted_and_none_puts_it_back() {
    let tube = tube();
    assert_eq!(tube.triangles.len(), 160);
    let rig = tube.rig.clone().expect("a skin");
    let (device, queue) = host();
    let context = Context::new(&device, &queue).expect("default limits are enough");
    let mut mesh = TessellatedMesh::new(&context, tube, ROOM).expect("a small mesh");
    mesh.set(&uniform(3.0), LodView::default()).expect("a small mesh");
    let mut at = |time: Option<f64>| {
        mesh.set_pose(time.map(|time| rig.pose(Moment { clip: 0, time }))).expect("a small rig");
        emitted(&queue, &device, &mut mesh).1
    };
    let (rest, bent, rest_again) = (at(None), at(Some(0.5)), at(None));
    assert_eq!(rest.vertices, rest_again.vertices);
    assert_eq!(rest.triangles, bent.triangles);
    let top = |output: &Tessellated| output.vertices.iter().map(|vertex| vertex.position[1]).fold(0.0, f32::max);
    assert!((top(&rest) - 3.0).abs() < 1e-6);
    // The upper half, 1.5 long and 0.35 thick, leans by 1.2 radians.
    assert!((top(&bent) - (1.5 + 1.5 * 1.2_f32.cos() + 0.35 * 1.2_f32.sin())).abs() < 0.1, "{}", top(&bent));
}

#[test]
fn a_pose_of_another_rig_is_refused_with_both_numbers() {
    let tube = tube();
    let rig = tube.rig.clone().expect("a skin");
    let (device, queue) = host();
    let context = Context::new(&device, &queue).expect("default limits are enough");
    let mut mesh = TessellatedMesh::new(&context, tube, ROOM).expect("a small mesh");
    mesh.set(&uniform(3.0), LodView::default()).expect("a small mesh");
    let rest = emitted(&queue, &device, &mut mesh).1;

    let refused = mesh.set_pose(Some(Pose::default())).expect_err("it has no joints");
    let GpuError::OtherRig { what: "joint matrices", has: 0, needs } = refused else { panic!("{refused}") };
    assert!(needs > 1, "{refused}");
    let targets = Pose { weights: vec![0.5; 7], ..rig.rest() };
    let refused = mesh.set_pose(Some(targets)).expect_err("it has morph targets");
    assert!(matches!(refused, GpuError::OtherRig { what: "morph weights", has: 7, needs: 1 }), "{refused}");

    mesh.invalidate().expect("a small mesh");
    assert_eq!(emitted(&queue, &device, &mut mesh).1.vertices, rest.vertices, "nothing has moved");
    mesh.set_pose(Some(rig.rest())).expect("the mesh's own rig");
}

#[test]
fn the_hosts_own_handlers_stay() {
    let (device, queue) = host();
    let heard = Arc::new(AtomicUsize::new(0));
    let counter = heard.clone();
    device.on_uncaptured_error(Arc::new(move |_| {
        counter.fetch_add(1, Ordering::Relaxed);
    }));
    let context = Context::new(&device, &queue).expect("default limits are enough");
    let mut mesh = TessellatedMesh::new(&context, Shape::CubeSplit.build(), ROOM).expect("a small mesh");
    mesh.set(&uniform(4.0), LodView::default()).expect("a small mesh");
    emitted(&queue, &device, &mut mesh);
    assert_eq!(heard.load(Ordering::Relaxed), 0, "the passes are valid");
    // A buffer without a usage can't be made.
    let _ = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 4,
        usage: wgpu::BufferUsages::empty(),
        mapped_at_creation: false,
    });
    assert_eq!(heard.load(Ordering::Relaxed), 1);
}

#[test]
fn a_device_that_allows_too_little_is_refused_by_name() {
    let (device, queue) = host_with(wgpu::Limits { max_compute_invocations_per_workgroup: 128, ..Default::default() });
    let error = Context::new(&device, &queue).err().expect("too little");
    let GpuError::Limits { what, has: 128, needs: 256 } = error else { panic!("{error}") };
    assert!(what.contains("invocations"), "{what}");
}

/// A strip of so many triangles.
fn strip(count: u32) -> Mesh {
    let positions: Vec<_> = (0..count + 2).map(|i| [i as f32, (i % 2) as f32, 0.0]).collect();
    let indices: Vec<u32> = (0..count).flat_map(|i| [i, i + 1, i + 2]).collect();
    let normals = vec![[0.0, 0.0, 1.0]; positions.len()];
    let slices = MeshSlices { positions: &positions, normals: &normals, indices: &indices, ..Default::default() };
    Mesh::from_slices(&slices).expect("a strip")
}

#[test]
fn what_was_set_stays_when_more_is_refused() {
    // Curves take 32 bytes. There are 40,001 of them if each edge has one, and 60,000 if each side has one.
    let (device, queue) = host_with(wgpu::Limits { max_storage_buffer_binding_size: 1_500_000, ..Default::default() });
    let context = Context::new(&device, &queue).expect("these limits are enough");
    let mut mesh = TessellatedMesh::new(&context, strip(20_000), ROOM).expect("a mesh that fits");
    mesh.set(&uniform(1.0), LodView::default()).expect("a mesh that fits");
    let (before, _) = emitted(&queue, &device, &mut mesh);
    assert!(before.triangles > 10_000, "{before:?}");
    let published = Tessellation { edges: Edges::AsPublished, ..uniform(1.0) };
    let refused = mesh.set(&published, LodView::default()).expect_err("too many curves");
    assert!(matches!(refused, GpuError::TooLarge { bytes: 1_920_000, limit: 1_500_000, .. }), "{refused}");
    mesh.set_pose(None).expect("the edges are as they were");
    mesh.invalidate().expect("the edges are as they were");
    assert_eq!(emitted(&queue, &device, &mut mesh).0, before);
}

#[test]
fn a_mesh_of_too_many_patches_is_refused_with_their_number() {
    let (device, queue) = host();
    let context = Context::new(&device, &queue).expect("default limits are enough");
    let error = TessellatedMesh::new(&context, strip((1 << 18) + 1), ROOM).err();
    let Some(GpuError::TooManyPatches { patches, limit }) = error else { panic!("{error:?}") };
    assert_eq!((patches, limit), (262_145, 262_144));
}

#[test]
fn the_examples_draw_their_pictures() {
    let _ = engine();
    let (picture, status, has_overflowed) = embed_example::picture(0.5, ROOM).expect("a picture");
    assert!(!has_overflowed && status.triangles > 3_000, "{status:?}");
    let frames = animate_example::frames().expect("pictures");
    let triangles: Vec<_> = frames.iter().map(|(_, triangles)| *triangles).collect();
    assert_eq!(triangles[0], 160, "factor 1 is the mesh itself");
    assert!(triangles.is_sorted() && triangles[5] > 10_000, "{triangles:?}");
    let mut pictures = vec![("example-embed".to_owned(), picture)];
    for moment in [0, 2, 5] {
        pictures.push((format!("example-animate-{moment}"), frames[moment].0.clone()));
    }
    assert_eq!(differing(pictures), Vec::<String>::new());
}

#[test]
fn a_host_that_dropped_an_encoder_can_ask_for_everything_again() {
    let (device, queue) = host();
    let context = Context::new(&device, &queue).expect("default limits are enough");
    let mut mesh = TessellatedMesh::new(&context, Shape::CubeSplit.build(), ROOM).expect("a small mesh");
    mesh.set(&uniform(4.0), LodView::default()).expect("a small mesh");
    let mut dropped = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    mesh.record(&mut dropped).expect("passes");
    drop(dropped);
    let (status, _) = emitted(&queue, &device, &mut mesh);
    assert_eq!(status.triangles, 0, "nothing ran");
    mesh.invalidate().expect("a small mesh");
    let (status, output) = emitted(&queue, &device, &mut mesh);
    assert_eq!(status.patches, mesh.patches());
    let expected = tessellate(mesh.mesh(), mesh.topology(), &Inputs::new(&uniform(4.0), LodView::default()), None);
    assert_eq!(output.triangles, expected.triangles);
}
