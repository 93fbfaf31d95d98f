//! How large emitted triangles are on screen.
//!
//! The advice to keep triangles above a few px (McDonald, Tessellation on Any Budget, GDC 2011) is about what a GPU pays
//! for a triangle however small it is: setup, and whole quads of 2 x 2 px. How often that is paid for a given piece of the
//! screen depends on the triangles' area, so their size is taken from it: the side of the square that a triangle is half
//! of. A grid of points 3 px apart is cut into triangles of 3 px. The least height would flag every sliver too, also long
//! ones, of which few cover a lot.

use glam::{Vec2, Vec3, Vec4};

use super::visitor::{EmittedChunk, Visitor};
use crate::tessellate::{beyond_near, planes_outside};
use crate::view::ScreenView;

/// Triangles below this size cost more than they show, in px.
pub(crate) const SMALL_PX: f64 = 3.0;

/// Counts of triangles by their size, seen from one view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sizes {
    pub view: ScreenView,
    /// Triangles that are neither wholly outside one side of the view nor cut by its near plane.
    pub in_view: u64,
    /// Those of them that are below [`SMALL_PX`].
    pub small: u64,
}

impl Sizes {
    /// Nothing counted yet.
    pub fn new(view: ScreenView) -> Self {
        Self { view, in_view: 0, small: 0 }
    }
}

impl Visitor for Sizes {
    fn take(&mut self, chunk: &EmittedChunk) {
        let ScreenView { clip_from_object, viewport } = self.view;
        let clip: Vec<Vec4> =
            chunk.vertices.iter().map(|v| clip_from_object * Vec3::from(v.position).extend(1.0)).collect();
        for triangle in chunk.triangles {
            let corners = triangle.map(|index| clip[index as usize]);
            if corners.into_iter().fold(!0, |shared, corner| shared & planes_outside(corner)) != 0 {
                continue;
            }
            if let Some(size) = size_px(corners, viewport) {
                self.in_view += 1;
                self.small += u64::from(size < SMALL_PX);
            }
        }
    }
}

/// Side of the square that a triangle is half of, in px; none if the near plane cuts it. Corners in clip space.
/// `size_px` in `shaders/draw_surface.wgsl` is the same.
fn size_px(corners: [Vec4; 3], viewport: Vec2) -> Option<f64> {
    if !corners.into_iter().all(|corner| corner.w > 0.0 && beyond_near(corner)) {
        return None;
    }
    let [a, b, c] = corners.map(|corner| (corner.truncate().truncate() / corner.w * 0.5 * viewport).as_dvec2());
    Some((b - a).perp_dot(c - a).abs().sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tessellate::Vertex;
    use glam::{Mat4, vec3};

    /// Ten px a unit, the middle at the origin, 0 to 1 deep.
    fn view() -> ScreenView {
        ScreenView { clip_from_object: Mat4::from_scale(vec3(0.1, 0.2, 1.0)), viewport: Vec2::new(200.0, 100.0) }
    }

    fn counted(triangles: &[[Vec3; 3]]) -> (u64, u64) {
        let mut sizes = Sizes::new(view());
        let vertex = |position: &Vec3| Vertex { position: position.to_array(), ..bytemuck::Zeroable::zeroed() };
        let vertices: Vec<_> = triangles.as_flattened().iter().map(vertex).collect();
        let indices: Vec<_> = (0..triangles.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        sizes.take(&EmittedChunk::whole(&vertices, &indices));
        (sizes.in_view, sizes.small)
    }

    /// Half a square of this many px, in the middle of the view.
    fn half_square(px: f32) -> [Vec3; 3] {
        [vec3(0.0, 0.0, 0.5), vec3(px / 10.0, 0.0, 0.5), vec3(0.0, px / 10.0, 0.5)]
    }

    #[test]
    fn a_triangle_is_as_large_as_the_square_that_it_is_half_of() {
        let ScreenView { clip_from_object, viewport } = view();
        let size = |triangle: [Vec3; 3]| size_px(triangle.map(|p| clip_from_object * p.extend(1.0)), viewport);
        for px in [0.5, 3.0, 40.0] {
            let found = size(half_square(px)).expect("in front of the near plane");
            assert!((found - f64::from(px)).abs() < 1e-5, "{px}: {found}");
        }
        // 90 px long and 0.4 px high: its area is that of half a square of 6 px.
        let sliver = [vec3(0.0, 0.0, 0.5), vec3(9.0, 0.0, 0.5), vec3(4.0, 0.04, 0.5)];
        assert!((size(sliver).expect("in front of the near plane") - 6.0).abs() < 1e-5);
    }

    #[test]
    fn small_triangles_are_counted_among_those_in_view() {
        let moved = |by: Vec3| half_square(2.0).map(|p| p + by);
        let [small, large] = [half_square(2.99), half_square(3.01)];
        assert_eq!(counted(&[small, large]), (2, 1));
        let mut turned = small;
        turned.swap(1, 2);
        assert_eq!(counted(&[turned]), (1, 1), "seen from behind it is as large");
        assert_eq!(counted(&[moved(vec3(9.9, 0.0, 0.0))]), (1, 1), "across the right side");
        assert_eq!(counted(&[moved(vec3(10.1, 0.0, 0.0))]), (0, 0), "beyond it");
        let mut cut = small;
        cut[1].z = 1.5;
        assert_eq!(counted(&[cut]), (0, 0), "through the near plane");
        let around = [vec3(-90.0, -30.0, 0.5), vec3(90.0, -30.0, 0.5), vec3(0.0, 90.0, 0.5)];
        assert_eq!(counted(&[around]), (1, 0), "all corners outside, but of different sides");
    }
}
