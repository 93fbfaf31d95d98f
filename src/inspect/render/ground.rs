//! The ground under a mesh, on which a grid is drawn, and the axes.

use glam::{Vec3, vec3};

use super::layout::AXIS_COLORS;
use super::{Camera, LineSegment};
use geometry::mesh::Bounds;

/// A horizontal plane under a mesh. Its lines are at multiples of a round number of object units from the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// Below the middle of the mesh, where two lines cross. In object units.
    pub middle: Vec3,
    /// How far apart the lines are, in object units: 1, 2 or 5 times a power of ten.
    pub spacing: f32,
}

/// How many cells a bounding radius has at least.
const CELLS_PER_RADIUS: f64 = 4.0;
/// The length of the axes, in cells.
const AXIS_CELLS: f32 = 2.0;

impl Ground {
    pub fn under(bounds: &Bounds) -> Self {
        let spacing = round_down(f64::from(bounds.radius()) / CELLS_PER_RADIUS);
        let snapped = |x: f32| ((f64::from(x) / spacing).round() * spacing) as f32;
        let center = bounds.center();
        Self { middle: vec3(snapped(center.x), bounds.min.y, snapped(center.z)), spacing: spacing as f32 }
    }

    /// Whether a camera looks at its upper side.
    pub(super) fn is_seen_from_above(&self, camera: &Camera) -> bool {
        if camera.orthographic { camera.axes()[2].y > 0.0 } else { camera.eye().y > self.middle.y }
    }
}

/// The axes x, y and z as lines from the origin.
pub fn axis_lines(bounds: &Bounds) -> Vec<LineSegment> {
    let length = AXIS_CELLS * Ground::under(bounds).spacing;
    let line = |(axis, color)| LineSegment { half_width: 1.25, ..LineSegment::new(Vec3::ZERO, axis * length, color) };
    Vec3::AXES.into_iter().zip(AXIS_COLORS).map(line).collect()
}

/// The largest number that is 1, 2 or 5 times a power of ten and not above this one; 1 for 0.
fn round_down(number: f64) -> f64 {
    if !(number > 0.0 && number.is_finite()) {
        return 1.0;
    }
    let exponent = number.log10().floor() as i32;
    let steps = [(10.0, exponent), (5.0, exponent), (2.0, exponent)].map(|(step, exponent)| step * power(exponent));
    // A logarithm may be off by a rounding.
    steps.into_iter().find(|step| *step <= number * (1.0 + 1e-9)).unwrap_or(power(exponent))
}

/// 10 to this power, rounded correctly where that is a whole number or 1 divided by one.
fn power(exponent: i32) -> f64 {
    if exponent < 0 { 1.0 / 10f64.powi(-exponent) } else { 10f64.powi(exponent) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spacings_are_round() {
        for (number, expected) in
            [(1.0, 1.0), (0.25, 0.2), (0.5, 0.5), (0.999, 0.5), (19.0, 10.0), (20.0, 20.0), (4e-7, 2e-7), (0.0, 1.0)]
        {
            assert_eq!(round_down(number) as f32, expected as f32, "{number}");
        }
        assert_eq!([round_down(f64::NAN), round_down(f64::INFINITY), round_down(-1.0)], [1.0; 3]);
    }

    #[test]
    fn the_ground_is_under_the_mesh_and_its_lines_are_at_multiples_of_the_spacing() {
        let bounds = Bounds::new([vec3(100.3, -2.0, -7.0), vec3(104.3, 1.0, -3.0)].into_iter());
        let Ground { middle, spacing } = Ground::under(&bounds);
        assert_eq!((spacing, middle), (0.5, vec3(102.5, -2.0, -5.0)));
        assert_eq!(Ground::under(&Bounds::default()), Ground { middle: Vec3::ZERO, spacing: 1.0 });
        assert_eq!(axis_lines(&bounds)[1].end, [0.0, 1.0, 0.0]);
    }
}
