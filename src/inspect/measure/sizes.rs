//! How large emitted triangles are on screen.
//!
//! Triangles should be larger than a few px (McDonald, Tessellation on Any Budget, GDC 2011), since each costs a GPU setup and
//! whole quads of 2 x 2 px, however small it is. How many triangles cover a part of the screen depends on their area, so a
//! triangle's size is the side of the square that has twice its area. A grid of points 3 px apart is cut into triangles of 3
//! px. The least height would be a worse measure: it is small for long slivers too, of which a few cover a large area.

use glam::{Vec2, Vec3, Vec4};

use super::visitor::{EmittedChunk, LEAST, Visitor};
use geometry::cores::in_ranges;
use geometry::tessellate::{Vertex, beyond_near, planes_outside};
use geometry::view::ScreenView;

/// The size in px below which triangles count as small: they cost more than they show.
pub(crate) const SMALL_PX: f64 = 3.0;

/// Counts of triangles by their size, seen from one view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sizes {
    pub view: ScreenView,
    /// The number of triangles that are neither wholly outside one side of the view nor cut by its near plane.
    pub in_view: u64,
    /// The number of these that are smaller than [`SMALL_PX`].
    pub small: u64,
    /// The number of triangles that the near plane cuts.
    cut: u64,
    /// The least and the greatest x and y of those in view, in px.
    extent: [Vec2; 2],
}

impl Sizes {
    /// Nothing counted yet.
    pub fn new(view: ScreenView) -> Self {
        Self { view, in_view: 0, small: 0, cut: 0, extent: [Vec2::INFINITY, Vec2::NEG_INFINITY] }
    }

    /// Whether nothing is in view, or what is there is smaller than a px.
    pub fn show_nothing(&self) -> bool {
        let [least, most] = self.extent;
        self.cut == 0 && (self.in_view == 0 || (most - least).max_element() < 1.0)
    }

    fn count(&mut self, vertices: &[Vertex], triangle: &[u32; 3]) {
        let ScreenView { clip_from_object, viewport } = self.view;
        let position = |index: u32| Vec3::from(vertices[index as usize].position);
        let corners = triangle.map(|index| clip_from_object * position(index).extend(1.0));
        if corners.into_iter().fold(!0, |shared, corner| shared & planes_outside(corner)) != 0 {
            return;
        }
        let Some(size) = size_px(corners, viewport) else {
            self.cut += 1;
            return;
        };
        self.in_view += 1;
        self.small += u64::from(size < SMALL_PX);
        for corner in corners {
            let px = corner.truncate().truncate() / corner.w * 0.5 * viewport;
            self.extent = [self.extent[0].min(px), self.extent[1].max(px)];
        }
    }
}

impl Visitor for Sizes {
    fn take(&mut self, chunk: &EmittedChunk) {
        for Self { in_view, small, cut, extent: [least, most], .. } in
            in_ranges(chunk.triangles.len(), LEAST, |range| {
                let mut own = Self::new(self.view);
                chunk.triangles[range].iter().for_each(|triangle| own.count(chunk.vertices, triangle));
                own
            })
        {
            self.in_view += in_view;
            self.small += small;
            self.cut += cut;
            self.extent = [self.extent[0].min(least), self.extent[1].max(most)];
        }
    }
}

/// The side of the square with twice the area of a triangle, in px; `None` if the near plane cuts it. Corners are in clip
/// space. `size_px` in `shaders/draw_surface_vertices.wgsl` is the same.
pub fn size_px(corners: [Vec4; 3], viewport: Vec2) -> Option<f64> {
    if !corners.into_iter().all(|corner| corner.w > 0.0 && beyond_near(corner)) {
        return None;
    }
    let [a, b, c] = corners.map(|corner| (corner.truncate().truncate() / corner.w * 0.5 * viewport).as_dvec2());
    Some((b - a).perp_dot(c - a).abs().sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Mat4, vec3};

    /// A view with 10 px per unit, the origin in the middle, and depths from 0 to 1.
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

    /// Half of a square with sides of this many px, in the middle of the view.
    fn half_square(px: f32) -> [Vec3; 3] {
        [vec3(0.0, 0.0, 0.5), vec3(px / 10.0, 0.0, 0.5), vec3(0.0, px / 10.0, 0.5)]
    }

    #[test]
    fn the_size_is_the_side_of_the_square_with_twice_the_area() {
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
