//! Which texture coordinates a map of a material has.

use glam::Vec2;

use geometry::defaults::with_defaults;
use geometry::mesh::MapUv;

with_defaults! {
    /// Texture coordinates of a map.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub(super) struct MapUvs {
        /// The index of the mesh's set.
        pub set: usize = 0,
        /// The affine map to texture coordinates that count from the top (see [`MapUv::Set`]).
        pub transform: [f32; 6] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0],
    }
}

impl MapUvs {
    /// Transforms texture coordinates of the set.
    pub(super) fn apply(&self, uv: Vec2) -> Vec2 {
        let [a, b, c, d, e, f] = self.transform;
        Vec2::new(a * uv.x + b * uv.y + c, d * uv.x + e * uv.y + f)
    }

    /// The same on corners that have `own` themselves. Only the first two sets are read: for another one `warn` is called, and the
    /// first is used.
    pub(super) fn on_corners(self, own: Self, warn: impl FnOnce()) -> MapUv {
        let Self { set, transform } = self;
        match set {
            _ if self == own => MapUv::Own,
            0 | 1 => MapUv::Set(set, transform),
            _ => {
                warn();
                MapUv::Set(0, transform)
            }
        }
    }
}

/// Returns the affine map that scales, then turns counter-clockwise as seen in the image, whose v points down, then moves. The angle
/// is in radians.
pub(super) fn affine(scale: [f32; 2], angle: f32, [u, v]: [f32; 2]) -> [f32; 6] {
    let (sin, cos) = angle.sin_cos();
    [cos * scale[0], sin * scale[1], u, -sin * scale[0], cos * scale[1], v]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transforms_scale_then_turn_then_move() {
        let transform = affine([2.0, 3.0], std::f32::consts::FRAC_PI_2, [0.5, 0.25]);
        let uvs = MapUvs { set: 0, transform };
        // One to the right becomes two to the right, and then two upwards, where v is less.
        assert!(uvs.apply(Vec2::X).abs_diff_eq(Vec2::new(0.5, -1.75), 1e-6), "{}", uvs.apply(Vec2::X));
        assert!(uvs.apply(Vec2::Y).abs_diff_eq(Vec2::new(3.5, 0.25), 1e-6), "{}", uvs.apply(Vec2::Y));
        assert_eq!(MapUvs::default().apply(Vec2::new(0.3, 0.7)), Vec2::new(0.3, 0.7));
        assert_eq!(affine([1.0; 2], 0.0, [0.0; 2]), MapUvs::default().transform);
    }
}
