//! Flat convex polygons with few corners, and how planes cut them.

use glam::DVec3;

/// A polygon with so many corners is cut through two of them.
const MANY: usize = 8;

/// The most corners that a polygon has. A cut adds one, and some more if rounding has made a flat corner concave.
const MOST: usize = 12;

/// A flat convex polygon with 3 to [`MOST`] corners, or with fewer while it is being made.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Polygon {
    corners: [DVec3; MOST],
    count: u8,
}

impl Polygon {
    pub(super) fn new(triangle: [DVec3; 3]) -> Self {
        let mut polygon = Self::default();
        triangle.into_iter().for_each(|corner| polygon.push(corner));
        polygon
    }

    fn push(&mut self, corner: DVec3) {
        self.corners[usize::from(self.count)] = corner;
        self.count += 1;
    }

    /// None if it has too few corners.
    fn made(self) -> Option<Self> {
        (self.count >= 3).then_some(self)
    }

    pub(super) fn corners(&self) -> &[DVec3] {
        &self.corners[..usize::from(self.count)]
    }

    pub(super) fn middle(&self) -> DVec3 {
        self.corners().iter().sum::<DVec3>() / f64::from(self.count)
    }

    /// The largest distance from a point to a corner.
    pub(super) fn radius(&self, from: DVec3) -> f64 {
        self.corners().iter().map(|corner| corner.distance_squared(from)).fold(0.0, f64::max).sqrt()
    }

    /// How far the polygon reaches above a plane, which is given by a point and a unit normal.
    pub(super) fn height(&self, at: DVec3, normal: DVec3) -> f64 {
        self.corners().iter().map(|corner| (corner - at).dot(normal)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// A plane that halves the polygon across its longest side or diagonal: a point, and a normal of any length.
    pub(super) fn across(&self) -> [DVec3; 2] {
        let corners = self.corners();
        let pairs = (1..corners.len()).flat_map(|i| (0..i).map(move |j| [corners[i], corners[j]]));
        let longest = pairs.max_by(|a, b| a[0].distance_squared(a[1]).total_cmp(&b[0].distance_squared(b[1])));
        longest.map_or([corners[0], DVec3::X], |[a, b]| [a.midpoint(b), b - a])
    }

    /// The parts below and above a plane, which is given by a point and a normal. A polygon with many corners is cut
    /// through two of these instead.
    pub(super) fn cut(&self, at: DVec3, normal: DVec3) -> [Option<Self>; 2] {
        let heights: [f64; MOST] = std::array::from_fn(|i| (self.corners[i] - at).dot(normal));
        let heights = &heights[..usize::from(self.count)];
        if !heights.iter().any(|height| *height > 0.0) {
            return [Some(*self), None];
        }
        if !heights.iter().any(|height| *height < 0.0) {
            return [None, Some(*self)];
        }
        if usize::from(self.count) >= MANY {
            return self.split();
        }
        let mut parts = [Self::default(); 2];
        for (i, (&corner, &height)) in self.corners().iter().zip(heights).enumerate() {
            if height <= 0.0 {
                parts[0].push(corner);
            }
            if height >= 0.0 {
                parts[1].push(corner);
            }
            let next = (i + 1) % heights.len();
            if height * heights[next] < 0.0 {
                let end = corner.lerp(self.corners[next], height / (height - heights[next]));
                parts.iter_mut().for_each(|part| part.push(end));
            }
        }
        parts.map(Self::made)
    }

    /// Cuts along the diagonal between the first corner and the one opposite to it.
    fn split(&self) -> [Option<Self>; 2] {
        let half = self.corners().len() / 2;
        let part = |corners: &mut dyn Iterator<Item = &DVec3>| {
            let mut part = Self::default();
            corners.for_each(|corner| part.push(*corner));
            part.made()
        };
        let corners = self.corners();
        [part(&mut corners[..=half].iter()), part(&mut corners[half..].iter().chain(&corners[..1]))]
    }
}
