//! The tessellator on the GPU against its twin on the CPU: factors, counts, every point and every triangle.

use std::path::Path;

use bytemuck::{Pod, Zeroable};
use geometry::tessellate::domain::{domain_plan, domain_point, domain_triangle};
use geometry::tessellate::factors::{
    MOST_ROWS, Partitioning, PatchFactors, ROW_BASE_STEP, point_count, process, round_pow2, triangle_count,
};
use gpu::wgsl::joined;
use wgpu::util::DeviceExt;

/// One workgroup a patch; its invocations take turns with the points and triangles.
const ENTRY: &str = "
struct Case {
    edges: vec3<f32>,
    inside: f32,
    partitioning: u32,
    first_point: u32,
    first_triangle: u32,
    unused: u32,
}

struct Result {
    factors: PatchFactors,
    points: u32,
    triangles: u32,
    power: u32,
    unused: u32,
}

@group(0) @binding(0) var<storage, read> cases: array<Case>;
@group(0) @binding(1) var<storage, read_write> results: array<Result>;
@group(0) @binding(2) var<storage, read_write> points: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read_write> triangles: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let case_ = cases[group.x];
    let factors = process(case_.partitioning, case_.edges, case_.inside);
    let point_total = point_count(factors);
    let triangle_total = triangle_count(factors);
    if lane == 0u {
        let power = bitcast<u32>(round_pow2(case_.inside));
        results[group.x] = Result(factors, point_total, triangle_total, power, 0u);
    }
    for (var i = lane; i < point_total; i += 64u) {
        points[case_.first_point + i] = domain_point(domain_plan(factors), i);
    }
    for (var t = lane; t < triangle_total; t += 64u) {
        let corners = domain_triangle(domain_plan(factors), t);
        let at = 3u * (case_.first_triangle + t);
        triangles[at] = corners.x;
        triangles[at + 1u] = corners.y;
        triangles[at + 2u] = corners.z;
    }
}
";

#[derive(Clone, Copy, Debug)]
struct Factors {
    partitioning: Partitioning,
    edges: [f32; 3],
    inside: f32,
}

/// A patch's tessellation.
#[derive(Debug, PartialEq)]
struct Patch {
    factors: PatchFactors,
    counts: [u32; 2],
    inside_power: u32,
    points: Vec<[u32; 2]>,
    triangles: Vec<[u32; 3]>,
}

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Case {
    edges: [f32; 3],
    inside: f32,
    partitioning: u32,
    first_point: u32,
    first_triangle: u32,
    unused: u32,
}

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct CaseResult {
    factors: PatchFactors,
    points: u32,
    triangles: u32,
    power: u32,
    unused: u32,
}

fn on_cpu(f: Factors) -> Patch {
    let factors = process(f.partitioning, f.edges, f.inside);
    let counts = [point_count(factors), triangle_count(factors)];
    let plan = domain_plan(factors);
    Patch {
        factors,
        counts,
        inside_power: round_pow2(f.inside).to_bits(),
        points: (0..counts[0]).map(|i| domain_point(&plan, i)).collect(),
        triangles: (0..counts[1]).map(|t| domain_triangle(&plan, t)).collect(),
    }
}

fn device() -> (wgpu::Device, wgpu::Queue) {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let options = wgpu::RequestAdapterOptions { force_fallback_adapter: false, ..Default::default() };
    let adapter = pollster::block_on(instance.request_adapter(&options)).expect("a GPU, or a software one");
    println!("adapter: {:?}", adapter.get_info());
    pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default())).expect("a device")
}

fn read(device: &wgpu::Device, buffer: &wgpu::Buffer) -> Vec<u8> {
    buffer.map_async(wgpu::MapMode::Read, .., |mapped| mapped.expect("a readable buffer"));
    device.poll(wgpu::PollType::wait_indefinitely()).expect("the GPU finishes");
    buffer.get_mapped_range(..).expect("a mapped buffer").to_vec()
}

/// Runs the shader over all cases; gives the bytes of its results, points and triangles.
fn dispatch(cases: &[Case], sizes: [usize; 3]) -> [Vec<u8>; 3] {
    let (device, queue) = device();
    let files = ["quotients", "factors", "domain_row", "rings", "rows", "domain", "connectivity", "subtriangulation"];
    let source = joined(&files) + ENTRY;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("domain parity"),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("domain parity"),
        layout: None,
        module: &module,
        entry_point: Some("main"),
        compilation_options: Default::default(),
        cache: None,
    });
    let buffer = |size: usize, usage| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: size as u64,
            usage,
            mapped_at_creation: false,
        })
    };
    let input = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: None,
        contents: bytemuck::cast_slice(cases),
        usage: wgpu::BufferUsages::STORAGE,
    });
    let outputs = sizes.map(|s| buffer(s, wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC));
    let readable = sizes.map(|s| buffer(s, wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST));
    let bound = [&input, &outputs[0], &outputs[1], &outputs[2]];
    let entries: Vec<_> = (0..)
        .zip(bound)
        .map(|(binding, b)| wgpu::BindGroupEntry { binding, resource: b.as_entire_binding() })
        .collect();
    let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &entries,
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &bind_group, &[]);
        pass.dispatch_workgroups(cases.len() as u32, 1, 1);
    }
    for (from, to) in outputs.iter().zip(&readable) {
        encoder.copy_buffer_to_buffer(from, 0, to, 0, from.size());
    }
    queue.submit([encoder.finish()]);
    readable.each_ref().map(|b| read(&device, b))
}

/// The same patches on the GPU. `expected` says how much room each one's points and triangles get.
fn on_gpu(factors: &[Factors], expected: &[Patch]) -> Vec<Patch> {
    let (mut first_point, mut first_triangle) = (0, 0);
    let mut cases = Vec::new();
    for (f, patch) in factors.iter().zip(expected) {
        cases.push(Case {
            edges: f.edges,
            inside: f.inside,
            partitioning: f.partitioning as u32,
            first_point,
            first_triangle,
            unused: 0,
        });
        first_point += patch.counts[0];
        first_triangle += patch.counts[1];
    }
    let sizes = [size_of::<CaseResult>() * cases.len(), 8 * first_point as usize, 12 * first_triangle as usize];
    let [results, points, triangles] = dispatch(&cases, sizes);
    let results: Vec<CaseResult> = bytemuck::pod_collect_to_vec(&results);
    let points: Vec<[u32; 2]> = bytemuck::pod_collect_to_vec(&points);
    let triangles: Vec<[u32; 3]> = bytemuck::pod_collect_to_vec(&triangles);
    let one = |((case, result), patch): ((&Case, &CaseResult), &Patch)| Patch {
        factors: result.factors,
        counts: [result.points, result.triangles],
        inside_power: result.power,
        points: points[case.first_point as usize..][..patch.counts[0] as usize].to_vec(),
        triangles: triangles[case.first_triangle as usize..][..patch.counts[1] as usize].to_vec(),
    };
    cases.iter().zip(&results).zip(expected).map(one).collect()
}

/// What classification, clamping and rounding must take apart. No signalling NaN: a load may quieten it.
fn special_values() -> Vec<f32> {
    let mut values = vec![0.0, -0.0, -1.0, f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    values.extend([f32::from_bits(1), f32::MIN_POSITIVE, f32::MAX, 0.5, 1.0, 1.5, 2.0, 3.0, 63.0, 64.0]);
    for around in [1.0, 1.0 + 1.0 / 131_072.0, 1.0 + 1.0 / 65_536.0, 2.0 + 1.0 / 131_072.0, 2.0, 63.0, 64.0f32] {
        values.extend([around.to_bits() - 1, around.to_bits(), around.to_bits() + 1].map(f32::from_bits));
    }
    values
}

fn all_cases() -> Vec<Factors> {
    let mut cases = Vec::new();
    let special = special_values();
    for partitioning in Partitioning::ALL {
        let mut add = |edges, inside| cases.push(Factors { partitioning, edges, inside });
        for &x in &special {
            add([x, 1.0, 1.0], 1.0);
            add([2.0, x, 5.0], x);
            add([3.5, 1.0, x], 4.25);
            add([1.0; 3], x);
            add([x; 3], 2.5);
        }
        for n in 1..=64 {
            let n = n as f32;
            add([n; 3], n);
            add([n - 0.37; 3], n - 0.61);
            add([n, 65.0 - n, 1.0], 33.0 - n / 2.0);
            add([1.0, n, 64.0], 1.0);
            add([64.0, 1.0, 17.3], n);
        }
    }
    // Rows beside every edge, as wide as LOD by error may find.
    for (n, base) in (1..=MOST_ROWS).flat_map(|n| [1, 2, 3].map(|base| (n, base))) {
        let width = (ROW_BASE_STEP * base + 1 + n * 37 % MOST_ROWS) as f32;
        for edges in [[n, MOST_ROWS + 1 - n, 7], [9, n, MOST_ROWS], [n, 1, n]] {
            cases.push(Factors { partitioning: Partitioning::Rows, edges: edges.map(|n| n as f32), inside: width });
        }
    }
    cases
}

#[test]
fn gpu_and_cpu_tessellate_alike() {
    let cases = all_cases();
    let expected: Vec<_> = cases.iter().map(|f| on_cpu(*f)).collect();
    let found = on_gpu(&cases, &expected);
    for ((case, cpu), gpu) in cases.iter().zip(&expected).zip(&found) {
        assert_eq!((gpu.factors, gpu.counts), (cpu.factors, cpu.counts), "{case:?}");
        assert_eq!(gpu.inside_power, cpu.inside_power, "{case:?}");
        assert!(gpu.points == cpu.points, "points of {case:?}");
        assert!(gpu.triangles == cpu.triangles, "triangles of {case:?}");
    }
}

/// The names of a file's functions, in order; methods and nested ones, which are indented, left out.
fn function_names(source: &str) -> Vec<&str> {
    let starts = ["fn ", "pub fn ", "pub(super) fn ", "pub(crate) fn "];
    let declared = source.lines().filter_map(|line| starts.iter().find_map(|start| line.strip_prefix(start)));
    declared.filter_map(|rest| rest.split('(').next()).collect()
}

#[test]
fn twins_have_the_same_functions_in_the_same_order() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut twins = 0;
    for shader in std::fs::read_dir(root.join("shaders")).expect("the folder of shaders") {
        let shader = shader.expect("a file").path();
        let name = shader.file_stem().expect("a name").to_string_lossy().into_owned();
        let Ok(rust) = std::fs::read_to_string(root.join("src/geometry/tessellate").join(format!("{name}.rs"))) else {
            continue;
        };
        let wgsl = std::fs::read_to_string(&shader).expect("a shader");
        assert!(!function_names(&wgsl).is_empty(), "{name}");
        assert_eq!(function_names(&rust), function_names(&wgsl), "{name}");
        twins += 1;
    }
    assert!(twins >= 17, "only {twins} shaders have a twin");
}
