//! Compares the times in which we and meshoptimizer build index buffers for PN-AEN on one core: `cargo bench --bench indices`.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use geometry::mesh::adjacency::Layout;
use geometry::mesh::{Corner, Mesh, Topology};
use geometry::progress::Progress;
use glam::{Vec2, Vec3};

/// The number of runs of each, in turn.
const RUNS: usize = 9;

/// A torus of `n` by `2 n` quads. Its corners are shared except at one uv seam in each direction.
fn torus(n: u32) -> Mesh {
    let (rows, columns) = (n, 2 * n);
    let corner = |i: u32, j: u32| {
        let [a, b] =
            [(i % columns, columns), (j % rows, rows)].map(|(i, n)| std::f32::consts::TAU * i as f32 / n as f32);
        let out = Vec3::new(a.sin(), 0.0, a.cos());
        let normal = out * b.cos() + Vec3::Y * b.sin();
        let uv = Vec2::new(i as f32 / columns as f32, j as f32 / rows as f32);
        Corner { position: out * 0.7 + normal * 0.3, normal, uv }
    };
    let at = |i: u32, j: u32| i * (rows + 1) + j;
    let quad = |i, j| [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]];
    let triangles: Vec<_> = (0..columns).flat_map(|i| (0..rows).flat_map(move |j| quad(i, j))).collect();
    Mesh {
        corners: (0..=columns).flat_map(|i| (0..=rows).map(move |j| corner(i, j))).collect(),
        triangles: triangles.into(),
        ..Mesh::default()
    }
}

/// The mesh with its triangles in random order, as files may have them.
fn shuffled(mut mesh: Mesh) -> Mesh {
    let triangles: &mut Vec<_> = Arc::make_mut(&mut mesh.triangles);
    fastrand::Rng::with_seed(1).shuffle(triangles);
    mesh
}

fn ours(mesh: &Mesh) -> Vec<u32> {
    let topology = Topology::build(mesh, &Progress::new()).unwrap_or_default();
    Layout::Twelve.indices(&topology)
}

fn theirs(mesh: &Mesh) -> Vec<u32> {
    let positions: Vec<[f32; 3]> = mesh.corners.iter().map(|corner| corner.position.to_array()).collect();
    match meshopt::VertexDataAdapter::new(bytemuck::cast_slice(&positions), 12, 0) {
        Ok(vertices) => meshopt::generate_tessellation_indices(mesh.triangles.as_flattened(), &vertices),
        Err(_) => Vec::new(),
    }
}

fn main() {
    println!("| mesh | triangles | ours, ms | meshoptimizer, ms | meshoptimizer / ours | the same indices |");
    println!("| --- | ---: | ---: | ---: | ---: | --- |");
    for (name, mesh) in [("torus", torus(708)), ("torus, triangles in no order", shuffled(torus(708)))] {
        let mut times = [Vec::new(), Vec::new()];
        let mut found = [Vec::new(), Vec::new()];
        for _ in 0..RUNS {
            for (k, build) in [ours, theirs].into_iter().enumerate() {
                let start = Instant::now();
                found[k] = build(black_box(&mesh));
                times[k].push(start.elapsed().as_secs_f64() * 1e3);
            }
        }
        let [ours, theirs] = times.map(|mut times| {
            times.sort_by(f64::total_cmp);
            times[RUNS / 2]
        });
        let same = if found[0] == found[1] { "yes" } else { "no" };
        println!("| {name} | {} | {ours:.0} | {theirs:.0} | {:.2} | {same} |", mesh.triangles.len(), theirs / ours);
    }
}
