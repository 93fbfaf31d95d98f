//! Where patches can be, whatever surface replaces their triangles. This needs no control nets, so that it is known at once in
//! every pose.

use glam::Vec3;

use super::{Surface, SurfaceFamily};
use crate::mesh::Bounds;

/// The bounds of some patches' corners, and the length of their longest side, in object units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchBounds {
    corners: Bounds,
    longest_side: f32,
}

impl PatchBounds {
    /// Returns the bounds of patches with these corners, or `None` if there are no patches.
    pub fn new(patches: impl Iterator<Item = [Vec3; 3]> + Clone) -> Option<Self> {
        patches.clone().next()?;
        let longest = |[a, b, c]: [Vec3; 3]| a.distance(b).max(b.distance(c)).max(c.distance(a));
        let is_finite = patches.clone().flatten().all(Vec3::is_finite);
        let longest_side = if is_finite { patches.clone().map(longest).fold(0.0, f32::max) } else { f32::INFINITY };
        Some(Self { corners: Bounds::new(patches.flatten()), longest_side })
    }

    /// Returns the bounds of the patches under a surface without displacement, or `None` if it has no limits: so
    /// that of some surfaces, and of corners that aren't finite.
    pub fn of_surface(&self, surface: Surface) -> Option<Bounds> {
        bulge(surface).map(|bulge| self.corners.grown(bulge * self.longest_side)).filter(Bounds::is_finite)
    }
}

/// Returns how far a patch leaves its triangle at most, as a part of the triangle's longest side; `None` if there is no such limit.
///
/// An edge's control points under PN, also those on a crease and means of several, are at most a third of the edge away from those
/// of the straight edge, and the centre is 1.5 times as far away as the six others are on average. Bernstein polynomials weigh the
/// seven with at most 8/9, and the centre with at most 2/9. The middle control point of an edge under Phong tessellation is at most
/// the edge's length away, and those of all three edges are weighed with at most 2/3. Nagata's have no limit.
fn bulge(surface: Surface) -> Option<f32> {
    match surface.family() {
        SurfaceFamily::Flat => Some(0.0),
        SurfaceFamily::Pn => Some(1.0 / 3.0),
        SurfaceFamily::Phong => Some(2.0 / 3.0),
        SurfaceFamily::Nagata => None,
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::mesh::mesh_builder::{InputCorner, MeshBuilder};
    use crate::mesh::{Material, Mesh, Topology};
    use crate::progress::Progress;
    use crate::tessellate::{FIXED_ONE, Inputs, LimitSurface, LodView, PosedMesh, Tessellation, patch_position};
    use proptest::prelude::*;

    /// Two triangles that share an edge, with normals of their own.
    fn two_triangles(points: [[f32; 3]; 4], normals: [[f32; 3]; 6]) -> Mesh {
        let mut builder = MeshBuilder::new();
        let material = builder.material(Material::plain("grey", [0.5; 4]));
        let corner = |point: usize, normal: usize| InputCorner {
            position: points[point].into(),
            normal: Some(Vec3::from(normals[normal]).normalize_or(Vec3::Z)),
            uv: glam::Vec2::ZERO,
        };
        builder.triangle(material, [corner(0, 0), corner(1, 1), corner(2, 2)]);
        builder.triangle(material, [corner(2, 3), corner(1, 4), corner(3, 5)]);
        builder.finish("two triangles".to_owned(), &Progress::default()).expect("nobody cancels")
    }

    proptest! {
        #[test]
        fn no_surface_leaves_the_bounds_of_its_patches(
            points: [[f32; 3]; 4],
            normals: [[f32; 3]; 6],
        ) {
            let small = |p: [f32; 3]| p.map(|x| if x.is_finite() { x.rem_euclid(2.0) } else { 0.0 });
            let mesh = two_triangles(points.map(small), normals.map(small));
            let topology = Topology::build(&mesh, &Progress::default()).expect("nobody cancels");
            let posed = PosedMesh::new(Arc::new(mesh.clone()), Arc::new(topology.clone()), None);
            for surface in Surface::ALL {
                let tessellation = Tessellation { surface, alpha: 1.0, ..Tessellation::default() };
                let inputs = Inputs::new(&tessellation, LodView::new(glam::Mat4::IDENTITY, glam::Vec2::ONE));
                let limit = LimitSurface::new(&mesh, &topology, &inputs);
                let bounds = posed.bounds_of(0..topology.patches.len() as u32);
                let Some(bounds) = bounds.and_then(|bounds| bounds.of_surface(surface)) else { continue };
                let bounds = bounds.grown(1e-5);
                for patch in 0..topology.patches.len() as u32 {
                    for step in 0..=44 {
                        let (u, v) = (step % 9 * FIXED_ONE / 8, step / 9 * FIXED_ONE / 8);
                        let p = patch_position(surface, &limit.net(patch), u, v.min(FIXED_ONE - u));
                        prop_assert!(p.cmpge(bounds.min).all() && p.cmple(bounds.max).all(), "{surface:?}: {p}");
                    }
                }
            }
        }
    }
}
