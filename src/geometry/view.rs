//! Projects positions to the screen, and gives the size of a ULP.

use glam::{DVec4, Mat4, Vec2, Vec3, dvec3, vec2, vec4};

use crate::choice::choices;
use crate::mesh::Topology;
use crate::numbers::ulp_at;

choices! {
    /// What the depth of a clip space is on the near plane, after the division by w, and where it goes from there.
    pub enum DepthRange {
        ZeroToOne => "zero-to-one", "0 to 1", "0 on the near plane, 1 far away (Direct3D, Vulkan, Metal, WebGPU).";
        Reversed => "reversed", "1 to 0", "1 on the near plane, 0 far away (the same with depth reversed).";
        MinusOneToOne => "minus-one-to-one", "-1 to 1", "-1 on the near plane, 1 far away (OpenGL).";
    }
}

impl DepthRange {
    /// The row whose product with a point is 0 on the near plane and grows into the view, of the rows z and w of a matrix.
    pub fn near_plane(self, z: DVec4, w: DVec4) -> DVec4 {
        match self {
            Self::ZeroToOne => z,
            Self::Reversed => w - z,
            Self::MinusOneToOne => w + z,
        }
    }
}

/// A view of a mesh: what turns positions in object units into px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenView {
    pub clip_from_object: Mat4,
    /// Width and height in px.
    pub viewport: Vec2,
}

impl ScreenView {
    /// The view as a mirror shows it.
    pub fn mirrored(self) -> Self {
        let mirror = Mat4::from_diagonal(vec4(-1.0, 1.0, 1.0, 1.0));
        Self { clip_from_object: mirror * self.clip_from_object, ..self }
    }
}

/// Projects a position to px from the viewport's top left. Returns `None` for a position behind the eye.
pub fn project(clip_from_object: Mat4, viewport: Vec2, position: Vec3) -> Option<Vec2> {
    let clip = clip_from_object * position.extend(1.0);
    (clip.w > 0.0).then(|| (vec2(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * viewport)
}

/// The place of a triangle's plane that is seen at a position in px from the viewport's top left; none if the plane is seen from
/// its edge.
pub fn seen_on_plane(view: &ScreenView, px: Vec2, triangle: [Vec3; 3]) -> Option<Vec3> {
    let object_from_clip = view.clip_from_object.as_dmat4().inverse();
    let at = (px / view.viewport).as_dvec2() * 2.0 - 1.0;
    // Depth is reversed: it is 1 at the near plane.
    let [near, beyond] = [1.0, 0.5].map(|depth| object_from_clip.project_point3(dvec3(at.x, -at.y, depth)));
    let [a, b, c] = triangle.map(|corner| corner.as_dvec3());
    let (across, direction) = ((b - a).cross(c - a), beyond - near);
    let place = near + direction * (across.dot(a - near) / across.dot(direction));
    place.is_finite().then_some(place.as_vec3())
}

/// One unit in the last place of the largest coordinate of a mesh (in magnitude), in object units.
pub fn ulp(topology: &Topology) -> f64 {
    ulp_at(topology.points.iter().map(|p| p.abs().max_element()).fold(0.0, f32::max))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::camera::rh::proj::directx as proj;
    use glam::camera::rh::view as looking;
    use glam::vec3;

    #[test]
    fn a_place_on_a_plane_is_found_where_it_is_projected_to() {
        let triangle = [vec3(-1.0, 0.2, 0.0), vec3(1.0, -0.3, 0.4), vec3(0.1, 1.0, -0.5)];
        let viewport = vec2(640.0, 480.0);
        let looks = looking::look_at_mat4(vec3(1.0, 2.0, 4.0), Vec3::ZERO, Vec3::Y);
        let perspective = proj::perspective_infinite_reverse(0.7, viewport.x / viewport.y, 0.01);
        let orthographic = proj::orthographic(-2.0, 2.0, -1.5, 1.5, 9.0, 0.0);
        for projection in [perspective, orthographic] {
            let view = ScreenView { clip_from_object: projection * looks, viewport };
            let place = triangle[0] * 0.2 + triangle[1] * 0.5 + triangle[2] * 0.3;
            let px = project(view.clip_from_object, viewport, place).expect("in front of the eye");
            let found = seen_on_plane(&view, px, triangle).expect("not seen from its edge");
            assert!(found.distance(place) < 1e-4, "{found} and {place}");
        }
        let view = ScreenView { clip_from_object: Mat4::IDENTITY, viewport };
        let edge_on = [Vec3::ZERO, Vec3::X, Vec3::Z];
        assert_eq!(seen_on_plane(&view, vec2(10.0, 10.0), edge_on), None);
    }

    #[test]
    fn an_ulp_is_that_of_the_largest_coordinate() {
        let mut topology = Topology::default();
        topology.points = vec![Vec3::new(0.1, -3.0, 0.2), Vec3::ONE];
        assert_eq!(ulp(&topology), 2f64.powi(-22));
    }
}
