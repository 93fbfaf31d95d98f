//! Finds out whether another program's coordinates are ours, turned, mirrored, scaled or moved as a whole.

use glam::{DMat3, DVec3, Vec3};

use super::foreign::ForeignMesh;
use super::locator::Locator;

/// How another program's coordinates follow from ours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Alignment {
    /// For each of their axes, which of ours it is, and whether it points the other way.
    pub axes: [(usize, bool); 3],
    /// Their lengths are ours times this.
    pub scale: f64,
    /// What is then added, in their units.
    pub offset: DVec3,
}

/// The scales that files have for a reason: powers of ten, and inches and feet in cm and in m.
const USUAL_SCALES: [f64; 6] = [2.54, 0.0254, 25.4, 0.3048, 30.48, 12.0];
/// How many vertices are tried.
const SAMPLE: usize = 300;
/// A vertex is near if it is no farther from the surface than this part of the mesh's diagonal.
const NEAR: f64 = 0.01;
/// As they are, coordinates are kept if this share of their vertices is near.
const KEPT: f64 = 0.6;
/// Another alignment is taken if this share of their vertices becomes near.
const FOUND: f64 = 0.95;

impl Alignment {
    const NONE: Self = Self { axes: [(0, false), (1, false), (2, false)], scale: 1.0, offset: DVec3::ZERO };

    /// Whether it mirrors, so that triangles are wound the other way.
    pub(crate) fn mirrors(&self) -> bool {
        self.matrix().determinant() < 0.0
    }

    /// Whether axes are exchanged or turned.
    pub(crate) fn turns(&self) -> bool {
        self.axes != Self::NONE.axes
    }

    /// The rotation or reflection from our axes to theirs.
    fn matrix(&self) -> DMat3 {
        let row = |(axis, is_turned): (usize, bool)| DVec3::AXES[axis] * if is_turned { -1.0 } else { 1.0 };
        DMat3::from_cols_array_2d(&self.axes.map(|axis| row(axis).to_array())).transpose()
    }

    /// Returns the place in our coordinates of a position in theirs.
    pub(super) fn ours(&self, theirs: DVec3) -> DVec3 {
        self.matrix().transpose() * ((theirs - self.offset) / self.scale)
    }

    /// Finds the alignment under which their vertices lie near our surface, whose least and largest coordinates are given; `None` if
    /// they do as they are, or under none.
    pub(super) fn find(theirs: &ForeignMesh, ours: &Locator, [least, most]: [Vec3; 2]) -> Option<Self> {
        let [our_size, our_middle] = [most.as_dvec3() - least.as_dvec3(), (most.as_dvec3() + least.as_dvec3()) / 2.0];
        let near = NEAR * our_size.length();
        let share = |alignment: &Self| {
            let is_near =
                |&index: &u32| ours.rough_distance(alignment.ours(theirs.positions[index as usize].as_dvec3())) <= near;
            let sample = theirs.sample(SAMPLE);
            sample.clone().filter(is_near).count() as f64 / sample.count().max(1) as f64
        };
        let bounds = theirs.bounds();
        let (size, middle) = ((bounds.max - bounds.min).as_dvec3(), bounds.center().as_dvec3());
        // A mesh that is only a part of ours lies near it, too.
        if size.length() <= 1.2 * our_size.length() && share(&Self::NONE) >= KEPT {
            return None;
        }
        // Another surface, or displacement, makes boxes larger or smaller, too.
        let scale = usual(size.length() / our_size.length())?;
        let scale = if (0.75..1.33).contains(&scale) { 1.0 } else { scale };
        let candidates = orders().map(|axes| {
            let turned = Self { axes, scale, offset: DVec3::ZERO };
            let offset = middle - turned.matrix() * our_middle * scale;
            // The middles of boxes differ a little where points differ.
            let is_moved = offset.length() > 0.02 * size.length();
            Self { offset: if is_moved { offset } else { DVec3::ZERO }, ..turned }
        });
        let fits = candidates.filter(|alignment| {
            let turned = (alignment.matrix() * our_size).abs() * scale;
            (turned - size).abs().max_element() <= 0.1 * size.length()
        });
        let (best, share) = fits.map(|alignment| (alignment, share(&alignment))).reduce(better)?;
        let best = if best.offset == DVec3::ZERO { best } else { best.settled(theirs, ours) };
        (share >= FOUND && best != Self::NONE).then_some(best)
    }

    /// Moves the offset until vertices lie on the surface on average: boxes differ a little where points differ.
    fn settled(mut self, theirs: &ForeignMesh, ours: &Locator) -> Self {
        const STEPS: usize = 50;
        for _ in 0..STEPS {
            let apart = |index: u32| {
                let position = self.ours(theirs.positions[index as usize].as_dvec3());
                ours.point(position).map_or(DVec3::ZERO, |point| position - point)
            };
            let sum: DVec3 = theirs.sample(SAMPLE).map(apart).sum();
            let count = theirs.sample(SAMPLE).count().max(1) as f64;
            self.offset += self.matrix() * (sum / count) * self.scale;
        }
        // Nobody moves a mesh by so many digits as rounding leaves.
        let size = f64::from(theirs.bounds().diagonal());
        let unit = 10.0_f64.powf((1e-5 * size).log10().floor());
        let plain = (self.offset / unit).round() * unit + DVec3::ZERO;
        if plain.distance(self.offset) <= 5e-7 * size { Self { offset: plain, ..self } } else { self }
    }
}

/// Of two alignments the one that more vertices fit; if they are alike, one that moves nothing, and then the first.
fn better(a: (Alignment, f64), b: (Alignment, f64)) -> (Alignment, f64) {
    let rank = |(alignment, share): &(Alignment, f64)| {
        ((share * 50.0).round() as u64, alignment.offset == DVec3::ZERO, !alignment.mirrors())
    };
    if rank(&b) > rank(&a) { b } else { a }
}

/// The 48 ways in which axes can be exchanged and turned, the usual one first.
fn orders() -> impl Iterator<Item = [(usize, bool); 3]> {
    const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [2, 1, 0], [1, 2, 0], [2, 0, 1]];
    ORDERS
        .into_iter()
        .flat_map(|order| (0..8_u32).map(move |signs| [0, 1, 2].map(|axis| (order[axis], signs >> axis & 1 == 1))))
}

/// Returns the usual scale that a measured one is within 1% of; or else one of two digits within 0.5%, or the measured one. `None` if
/// it is no scale.
fn usual(measured: f64) -> Option<f64> {
    if !(measured.is_finite() && measured > 0.0) {
        return None;
    }
    let is_near = |scale: &f64| (measured / scale - 1.0).abs() < 0.01;
    let powers = (-6..=6).map(|exponent| 10.0_f64.powi(exponent));
    let others = USUAL_SCALES.into_iter().flat_map(|scale| [scale, scale.recip()]);
    let unit = 10.0_f64.powf(measured.log10().floor() - 1.0);
    let short = (measured / unit).round() * unit;
    let plain = if (measured / short - 1.0).abs() < 0.005 { short } else { measured };
    Some(powers.chain(others).find(is_near).unwrap_or(plain))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ours_undoes_what_was_done() {
        // Z up in cm, from Y up in m: their y is our -z, their z is our y.
        let made =
            Alignment { axes: [(0, false), (2, true), (1, false)], scale: 100.0, offset: DVec3::new(5.0, 0.0, 0.0) };
        assert!(!made.mirrors() && made.turns());
        let place = DVec3::new(1.0, 2.0, 3.0);
        let theirs = DVec3::new(105.0, -300.0, 200.0);
        assert!(made.ours(theirs).distance(place) < 1e-12);
        assert!(Alignment { axes: [(0, true), (1, false), (2, false)], ..Alignment::NONE }.mirrors());
    }

    #[test]
    fn all_orders_of_axes_are_there_once() {
        let all: Vec<_> = orders().collect();
        assert_eq!((all.len(), all[0]), (48, Alignment::NONE.axes));
        assert!(all.iter().enumerate().all(|(i, own)| !all[..i].contains(own)));
    }

    #[test]
    fn a_scale_near_a_usual_one_is_that() {
        assert_eq!([99.9, 0.0254, 0.01005, 3.001, 3.333].map(usual), [100.0, 0.0254, 0.01, 3.0, 3.333].map(Some));
        assert_eq!([0.0, f64::NAN, f64::INFINITY].map(usual), [None; 3]);
    }
}
