//! Ordinary files of any size load within four times their size, without the additional 512 MiB.

use std::sync::PoisonError;

use geometry::mesh::Topology;
use geometry::mesh::weld_preview::weld_previews;
use geometry::progress::Progress;

use super::counting::peak_of;
use super::glb::{blocks, indexed, loose};
use super::grid::Grid;
use super::{ALONE, taken};

/// Memory that doesn't depend on the file's size, in bytes.
const FIXED: usize = 1 << 20;

/// Numbers of triangles in small steps, so that tables that double their size are tried nearly empty and nearly full.
fn sizes() -> Vec<usize> {
    match std::env::var("PNAEN_TRIANGLES").ok().and_then(|count| count.parse().ok()) {
        Some(count) => vec![count],
        None => vec![57_000, 120_000],
    }
}

/// Loads a file of each of the sizes; it may take `times` the file's size.
fn assert_within(name: &str, times: usize, make: impl Fn(usize) -> Vec<u8>) {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    for triangles in sizes() {
        let bytes = make(triangles);
        let size = bytes.len();
        let (mesh, took) = taken(name, bytes);
        let mesh = mesh.expect("a file without a fault").mesh;
        let count = mesh.triangles.len();
        let (topology, more) = peak_of(|| Topology::build(&mesh, &Progress::new()));
        let [file, load, topology_too] = [size, took, more].map(|bytes| bytes / count);
        println!("    {count} triangles of {file} bytes: {load} bytes each, and {topology_too} for the topology");
        assert!(topology.is_ok() && took <= times * size + FIXED, "{name}: {took} bytes for {size}");
    }
}

#[test]
fn binary_stl() {
    assert_within("smooth.stl", 4, |count| Grid::new(count, 0.0).stl(0.0));
    assert_within("creased.stl", 4, |count| Grid::new(count, 40.0).stl(0.0));
    assert_within("apart.stl", 4, |count| Grid::new(count, 0.0).stl(0.1));
}

#[test]
fn ply() {
    assert_within("triangles.ply", 4, |count| Grid::new(count, 0.0).ply(false));
    assert_within("squares.ply", 4, |count| Grid::new(count, 0.0).ply(true));
    // With a corner for each face, the mesh itself is larger than that.
    assert_within("creased.ply", 9, |count| Grid::new(count, 40.0).ply(false));
}

#[test]
fn obj() {
    assert_within("plain.obj", 4, |count| Grid::new(count, 0.0).obj(false));
    assert_within("attributes.obj", 4, |count| Grid::new(count, 0.0).obj(true));
    // For the same reason as above.
    assert_within("creased.obj", 5, |count| Grid::new(count, 40.0).obj(false));
}

#[test]
fn off() {
    assert_within("plain.off", 4, |count| Grid::new(count, 0.0).off());
}

#[test]
fn gltf() {
    assert_within("floats.glb", 4, |count| indexed(Grid::new(count, 0.0), false));
    assert_within("quantised.glb", 4, |count| indexed(Grid::new(count, 0.0), true));
    assert_within("blocks.glb", 4, |count| blocks(Grid::new(count, 0.0)));
    assert_within("loose.glb", 4, |count| loose(Grid::new(count, 0.0), false));
    assert_within("loose-quantised.glb", 4, |count| loose(Grid::new(count, 0.0), true));
}

/// The memory that is taken between a load and the first picture, in bytes per triangle, as docs/results/files.md says.
#[test]
fn edges_and_previews_of_welds() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    for triangles in sizes() {
        let (mesh, _) = taken("edges.glb", indexed(Grid::new(triangles, 0.0), false));
        let mesh = mesh.expect("a file without a fault").mesh;
        let count = mesh.triangles.len();
        let (topology, edges) = peak_of(|| Topology::build(&mesh, &Progress::new()));
        let topology = topology.expect("nobody cancels");
        let (joins, welds) = peak_of(|| weld_previews(&mesh, Some(&topology), &Progress::new()));
        println!("    {count} triangles: {} bytes each for edges, {} for welds", edges / count, welds / count);
        assert!(joins.is_ok() && edges <= 65 * count + FIXED && welds <= 40 * count + FIXED, "{edges} {welds} {count}");
    }
}
