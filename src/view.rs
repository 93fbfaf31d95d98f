//! Projects positions to the screen, and gives the size of a ULP.

use glam::{Mat4, Vec2, Vec3, vec2};

use crate::mesh::Topology;

/// A view of a mesh: what turns positions in object units into px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenView {
    pub clip_from_object: Mat4,
    /// Width and height in px.
    pub viewport: Vec2,
}

/// Projects a position to px from the viewport's top left. Returns `None` for a position behind the eye.
pub(crate) fn project(clip_from_object: Mat4, viewport: Vec2, position: Vec3) -> Option<Vec2> {
    let clip = clip_from_object * position.extend(1.0);
    (clip.w > 0.0).then(|| (vec2(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * viewport)
}

/// One unit in the last place of the largest coordinate of a mesh (in magnitude), in object units.
pub(crate) fn ulp(topology: &Topology) -> f64 {
    ulp_at(topology.points.iter().map(|p| p.abs().max_element()).fold(0.0, f32::max))
}

/// One unit in the last place of a coordinate, in the coordinate's own units.
pub(crate) fn ulp_at(coordinate: f32) -> f64 {
    f64::from(coordinate.next_up()) - f64::from(coordinate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ulp_is_that_of_the_largest_coordinate() {
        let mut topology = Topology::default();
        topology.points = vec![Vec3::new(0.1, -3.0, 0.2), Vec3::ONE];
        assert_eq!(ulp(&topology), 2f64.powi(-22));
    }
}
