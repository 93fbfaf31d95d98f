//! Finds out whether another program's coordinates are ours, turned, mirrored, scaled or moved as a whole.

use glam::{DVec3, Vec3};

use super::OurTessellation;
use super::foreign::ForeignMesh;
use super::locator::Locator;
use super::spaces::{Alignment, Space};
use geometry::mesh::Bounds;
use geometry::near::TriangleTree;

/// The scales that files have for a reason: powers of ten, and inches and feet in cm and in m.
const USUAL_SCALES: [f64; 6] = [2.54, 0.0254, 25.4, 0.3048, 30.48, 12.0];
/// How many vertices are tried.
const SAMPLE: usize = 300;
/// The same where the nearest place of the surface itself is sought, which takes longer.
const SURFACE_SAMPLE: usize = 100;
/// The most vertices of ours that theirs are looked for among, which takes about 200 bytes each.
const MOST_POSITIONS: usize = 1 << 20;
/// A vertex is near if it is no farther from the surface than this part of the mesh's diagonal.
const NEAR: f64 = 0.01;
/// As they are, coordinates are kept if this share of their vertices is near.
const KEPT: f64 = 0.6;
/// Another alignment is taken if this share of their vertices becomes near.
const FOUND: f64 = 0.95;

impl Alignment {
    /// Finds the alignment under which their vertices are ours, lie on our surface, or lie near it; the first of these under which
    /// nearly all do. `None` if they do as they are, or under none. A vertex lies on the surface within `fit` object units.
    ///
    /// Other spaces are tried after all ways to exchange and turn axes, and before places that are only near.
    pub(super) fn find(theirs: &ForeignMesh, own: &Locator, ours: &OurTessellation, fit: f64) -> Option<Space> {
        let emitted = &ours.emitted_positions()[..];
        let bounds_of_own = Bounds::new(emitted.iter().copied());
        let our_size = (bounds_of_own.max - bounds_of_own.min).as_dvec3();
        let our_middle = bounds_of_own.center().as_dvec3();
        let bounds = theirs.bounds();
        let (size, middle) = ((bounds.max - bounds.min).as_dvec3(), bounds.center().as_dvec3());
        // Another surface, or displacement, makes boxes larger or smaller, too.
        let measured = usual(size.length() / our_size.length())?;
        let plain = if (0.75..1.33).contains(&measured) { 1.0 } else { measured };
        let candidates = |scale: f64| {
            let all = orders().map(move |axes| {
                let turned = Self { axes, scale, offset: DVec3::ZERO };
                let offset = middle - turned.matrix() * our_middle * scale;
                // The middles of boxes differ a little where points differ.
                let is_moved = offset.length() > 0.02 * size.length();
                Self { offset: if is_moved { offset } else { DVec3::ZERO }, ..turned }
            });
            all.filter(move |alignment| {
                let turned = (alignment.matrix() * our_size).abs() * scale;
                (turned - size).abs().max_element() <= 0.1 * size.length()
            })
        };
        let near = NEAR * our_size.length();
        let sought = AlignmentSearch { theirs, ours: own, emitted: tree_of(emitted), fit, near };
        let of_camera = Space::from_camera(&ours.inputs.view, ours.matrix);
        for how in [How::AtVertices, How::OnSurface, How::NearSurface] {
            let kept = if how == How::NearSurface { KEPT } else { FOUND };
            // A mesh that is only a part of ours lies near it, too.
            if size.length() <= 1.2 * our_size.length() && sought.share(|position| position, how) >= kept {
                return None;
            }
            let scales: &[f64] = if how == How::AtVertices { &[plain, measured] } else { &[plain] };
            let all = scales
                .iter()
                .copied()
                .flat_map(candidates)
                .map(|alignment| (alignment, sought.share(|position| Space::from(alignment).ours(position), how)));
            if let Some((best, _)) = all.reduce(better).filter(|(_, share)| *share >= FOUND) {
                let best = if best.offset == DVec3::ZERO { best } else { best.settled(theirs, own) };
                return (best != Self::NONE).then_some(best.into());
            }
            if how == How::NearSurface {
                continue;
            }
            let is_found = |space: &Space| sought.share(|position| space.ours(position), how) >= FOUND;
            if let Some(found) = of_camera.iter().copied().find(is_found) {
                return Some(found);
            }
            if how == How::AtVertices {
                let found = Space::from_triangles(theirs, emitted, &ours.tessellated.triangles).find(is_found);
                if let Some(found) = found {
                    return Some(found.settled(&sought.pairs(&found)));
                }
            }
        }
        None
    }

    /// Moves the offset until vertices lie on the surface on average: boxes differ a little where points differ.
    fn settled(mut self, theirs: &ForeignMesh, ours: &Locator) -> Self {
        const STEPS: usize = 50;
        for _ in 0..STEPS {
            let apart = |index: u32| {
                let position = Space::from(self).ours(theirs.positions[index as usize].as_dvec3());
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

/// What vertices are asked for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum How {
    /// To be vertices of ours: only one alignment of a symmetric mesh does that, if its factors differ from patch to patch.
    AtVertices,
    OnSurface,
    NearSurface,
}

/// What an alignment is sought by.
struct AlignmentSearch<'a> {
    theirs: &'a ForeignMesh,
    ours: &'a Locator<'a>,
    /// The positions of our vertices.
    emitted: Option<TriangleTree>,
    /// In object units, as [`Alignment::find`] has it, and how near vertices must be to be near the surface.
    fit: f64,
    near: f64,
}

impl AlignmentSearch<'_> {
    /// The share of their vertices that are where they are asked for.
    fn share(&self, in_ours: impl Fn(DVec3) -> DVec3, how: How) -> f64 {
        let is_there = |&index: &u32| {
            let position = in_ours(self.theirs.positions[index as usize].as_dvec3());
            match how {
                How::AtVertices => self.vertex(position).is_some(),
                How::OnSurface => self.ours.place(position).is_some_and(|place| place.distance <= self.fit),
                How::NearSurface => self.ours.rough_distance(position) <= self.near,
            }
        };
        let sample = self.theirs.sample(if how == How::OnSurface { SURFACE_SAMPLE } else { SAMPLE });
        sample.clone().filter(is_there).count() as f64 / sample.count().max(1) as f64
    }

    /// The position of our vertex at a place, if there is one.
    fn vertex(&self, place: DVec3) -> Option<DVec3> {
        nearest(self.emitted.as_ref(), place, self.fit)
    }

    /// Positions of ours, each with that of one of their vertices at the same place in another space.
    fn pairs(&self, space: &Space) -> Vec<[DVec3; 2]> {
        let pair = |index: u32| {
            let theirs = self.theirs.positions[index as usize].as_dvec3();
            Some([self.vertex(space.ours(theirs))?, theirs])
        };
        self.theirs.sample(SAMPLE).filter_map(pair).collect()
    }
}

/// A tree of those positions that are finite. There is none of more than [`MOST_POSITIONS`].
fn tree_of(positions: &[Vec3]) -> Option<TriangleTree> {
    if positions.len() > MOST_POSITIONS {
        return None;
    }
    TriangleTree::new(positions.iter().filter(|position| position.is_finite()).map(|position| [*position; 3]))
}

/// The position in a tree that is nearest to a place; none if it is farther away than twice `fit`, since rounding moves coordinates
/// along all axes.
fn nearest(tree: Option<&TriangleTree>, place: DVec3, fit: f64) -> Option<DVec3> {
    let closest = tree.filter(|_| place.is_finite())?.closest(place, 2.0 * fit)?;
    Some(closest.point)
}

/// Of two alignments the one that more vertices fit; if they are alike, one that moves nothing, and then the first.
fn better(a: (Alignment, f64), b: (Alignment, f64)) -> (Alignment, f64) {
    let rank = |(alignment, share): &(Alignment, f64)| {
        ((share * 50.0).round() as u64, alignment.offset == DVec3::ZERO, !alignment.mirrors())
    };
    if rank(&b) > rank(&a) { b } else { a }
}

/// The 48 ways in which axes can be exchanged and turned. The usual ones come first: none, and another axis that points up, both
/// ways.
fn orders() -> impl Iterator<Item = [(usize, bool); 3]> {
    const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [2, 1, 0], [1, 2, 0], [2, 0, 1]];
    const USUAL: [[(usize, bool); 3]; 3] =
        [Alignment::NONE.axes, [(0, false), (2, true), (1, false)], [(0, false), (2, false), (1, true)]];
    let all = ORDERS
        .into_iter()
        .flat_map(|order| (0..8_u32).map(move |signs| [0, 1, 2].map(|axis| (order[axis], signs >> axis & 1 == 1))));
    USUAL.into_iter().chain(all.filter(|axes| !USUAL.contains(axes)))
}

/// Returns the usual scale that a measured one is within 1% of; or else one of two digits within 0.5%, one of three within 0.001%, or
/// the measured one. `None` if it is no scale.
fn usual(measured: f64) -> Option<f64> {
    if !(measured.is_finite() && measured > 0.0) {
        return None;
    }
    let is_near = |scale: &f64| (measured / scale - 1.0).abs() < 0.01;
    let powers = (-6..=6).map(|exponent| 10.0_f64.powi(exponent));
    let others = USUAL_SCALES.into_iter().flat_map(|scale| [scale, scale.recip()]);
    let digits = |count: i32| {
        let unit = 10.0_f64.powi(measured.log10().floor() as i32 + 1 - count);
        (measured / unit).round() * unit
    };
    let within = |scale: f64, share: f64| Some(scale).filter(|scale| (measured / scale - 1.0).abs() < share);
    let plain = within(digits(2), 0.005).or(within(digits(3), 1e-5)).unwrap_or(measured);
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
        assert!(Space::from(made).ours(theirs).distance(place) < 1e-12);
        assert!(Alignment { axes: [(0, true), (1, false), (2, false)], ..Alignment::NONE }.mirrors());
    }

    #[test]
    fn a_position_that_is_not_finite_is_near_none() {
        let origin = tree_of(&[Vec3::NAN, Vec3::ZERO]);
        let found = |place| nearest(origin.as_ref(), place, 0.1);
        assert_eq!([DVec3::splat(0.05), DVec3::NAN, DVec3::INFINITY].map(found), [Some(DVec3::ZERO), None, None]);
        assert!(tree_of(&[Vec3::NAN]).is_none());
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
