//! Transforms of texture coordinates (`KHR_texture_transform`).

use glam::Vec2;

use super::lenient::Members;

/// An affine map of texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct UvTransform {
    pub offset: Vec2,
    /// In radians.
    pub rotation: f32,
    pub scale: Vec2,
}

impl UvTransform {
    const IDENTITY: Self = Self { offset: Vec2::ZERO, rotation: 0.0, scale: Vec2::ONE };
    /// So large that nothing sensible is beyond, and that products of two such numbers are finite.
    const RANGE: [f32; 2] = [-1e18, 1e18];

    /// Reads a transform; none if it changes nothing.
    pub(super) fn new(members: &Members) -> Option<Self> {
        let transform = Self {
            offset: members.numbers("offset", [0.0; 2], Self::RANGE).into(),
            rotation: members.number("rotation", 0.0, Self::RANGE),
            scale: members.numbers("scale", [1.0; 2], Self::RANGE).into(),
        };
        (transform != Self::IDENTITY).then_some(transform)
    }

    /// Applies scale, then a counter-clockwise rotation as seen in the image, whose v points down, then the offset.
    pub(crate) fn apply(&self, uv: Vec2) -> Vec2 {
        let (sin, cos) = self.rotation.sin_cos();
        let Vec2 { x, y } = uv * self.scale;
        Vec2::new(x * cos + y * sin, y * cos - x * sin) + self.offset
    }

    /// Returns the same as six numbers (see [`MapUv`](geometry::mesh::MapUv)).
    pub(super) fn affine(transform: Option<Self>) -> [f32; 6] {
        let Self { offset, rotation, scale } = transform.unwrap_or(Self::IDENTITY);
        let (sin, cos) = rotation.sin_cos();
        [cos * scale.x, sin * scale.y, offset.x, -sin * scale.x, cos * scale.y, offset.y]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transforms_scale_then_turn_then_move() {
        let quarter = std::f32::consts::FRAC_PI_2;
        let transform = UvTransform { offset: Vec2::new(0.5, 0.25), rotation: quarter, scale: Vec2::new(2.0, 3.0) };
        // One to the right becomes two to the right, and then two upwards, where v is less.
        assert!(transform.apply(Vec2::X).abs_diff_eq(Vec2::new(0.5, -1.75), 1e-6), "{}", transform.apply(Vec2::X));
        assert!(transform.apply(Vec2::Y).abs_diff_eq(Vec2::new(3.5, 0.25), 1e-6), "{}", transform.apply(Vec2::Y));
        assert_eq!(UvTransform::IDENTITY.apply(Vec2::new(0.3, 0.7)), Vec2::new(0.3, 0.7));
        let [a, b, c, d, e, f] = UvTransform::affine(Some(transform));
        let uv = Vec2::new(0.3, 0.7);
        let same = Vec2::new(a * uv.x + b * uv.y + c, d * uv.x + e * uv.y + f);
        assert!(transform.apply(uv).abs_diff_eq(same, 1e-6), "{same}");
        assert_eq!(UvTransform::affine(None), [1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    }
}
