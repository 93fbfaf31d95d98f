//! The search for the fewest triangles, which the bench of that name compares LOD by error with.

// The bench has the rest of it.
#[allow(dead_code)]
#[path = "../benches/optimum/search.rs"]
mod search;

use geometry::mesh::{Shape, Topology};
use geometry::progress::Progress;
use geometry::tessellate::{Inputs, Lod, Partitioning, Surface, Tessellation, tessellate};
use glam::Vec2;
use inspect::render::Camera;
use search::{Optimum, optimum};

/// The optimum, and the triangles of LOD by error.
fn compared(shape: Shape, tolerance: f32, partitioning: Partitioning) -> (Optimum, u64) {
    let (mesh, viewport) = (shape.build(), Vec2::new(640.0, 360.0));
    let topology = Topology::build(&mesh, &Progress::new()).expect("nobody cancels");
    let tessellation = Tessellation { lod: Lod::Error, tolerance, partitioning, ..Tessellation::default() };
    let view = Camera::framing(&mesh.bounds(), viewport).lod_view(viewport, &mesh.bounds());
    let inputs = Inputs::new(&tessellation, view);
    let own = tessellate(&mesh, &topology, &inputs, None);
    (optimum(&mesh, &topology, &inputs, &[]), own.triangles.len() as u64)
}

#[test]
fn lod_by_error_has_hardly_more_triangles_than_the_optimum_and_never_more_than_one_factor() {
    for (shape, tolerance, partitioning) in [
        (Shape::CubeSplit, 1.0, Partitioning::Integer),
        (Shape::Icosahedron, 2.0, Partitioning::Integer),
        (Shape::Cylinder, 0.5, Partitioning::Integer),
        (Shape::Saddle, 0.25, Partitioning::FractionalOdd),
        (Shape::Cone, 1.0, Partitioning::FractionalEven),
        (Shape::CubeSmooth, 1.0, Partitioning::Pow2),
    ] {
        let (best, own) = compared(shape, tolerance, partitioning);
        let what = format!("{shape:?} {tolerance} px {partitioning:?}: {own} triangles, {best:?}");
        assert!(own as f64 <= 1.2 * best.triangles as f64 && own as f64 >= 0.97 * best.triangles as f64, "{what}");
        assert!(best.lower_bound <= best.triangles && best.triangles as f64 <= 1.1 * best.lower_bound as f64, "{what}");
        assert!(best.uniform.is_none_or(|(_, triangles)| own <= triangles), "{what}");
    }
}

#[test]
fn what_is_flat_needs_one_triangle_a_patch() {
    let (mesh, viewport) = (Shape::CubeSplit.build(), Vec2::new(640.0, 360.0));
    let topology = Topology::build(&mesh, &Progress::new()).expect("nobody cancels");
    let tessellation = Tessellation { surface: Surface::Flat, lod: Lod::Error, ..Tessellation::default() };
    let view = Camera::framing(&mesh.bounds(), viewport).lod_view(viewport, &mesh.bounds());
    let best = optimum(&mesh, &topology, &Inputs::new(&tessellation, view), &[]);
    assert_eq!((best.triangles, best.lower_bound, best.uniform), (12, 12, Some((1, 12))));
}
