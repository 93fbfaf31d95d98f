//! Values at the points of a level, such as positions, and how they are averaged.

use std::collections::HashMap;

use rayon::prelude::*;

use super::level::Level;
use super::masks::{CREASE, CREASE_LIMIT, Mask};
use super::split::decayed;
use super::{Linear, Scheme};
use crate::casts::to_u32;

/// Which rule a point follows. A dart, where a single sharp edge ends, is smooth. Source: Hoppe et al. 1994.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Rule {
    Smooth,
    Crease,
    Corner,
}

/// The values at the points of a level.
pub(super) struct Values<'a, T> {
    pub(super) level: &'a Level,
    pub(super) scheme: Scheme,
    pub(super) points: &'a [T],
    /// The mean of each face's points; empty but for Catmull-Clark.
    centers: Vec<T>,
}

/// What the butterfly scheme makes of the edges at each point; empty for other schemes.
pub(super) struct Fans<T> {
    /// For each point the far ends of the two sharp edges that go through it, if it isn't the end of any.
    pub(super) creases: Vec<Option<[u32; 2]>>,
    /// For each edge the sum of what its irregular ends make of it, and how many these are, if it has any.
    pub(super) irregular: HashMap<u32, (T, f64)>,
}

impl<'a, T: Linear> Values<'a, T> {
    pub(super) fn new(level: &'a Level, scheme: Scheme, points: &'a [T]) -> Self {
        let faces = if scheme == Scheme::CatmullClark { level.faces() } else { 0 };
        let center = |face| level.polygons.mean(face, |side| points[level.origins[side as usize] as usize]);
        Self { level, scheme, points, centers: (0..faces).into_par_iter().map(center).collect() }
    }

    /// The values at the points of the finer level.
    pub(super) fn refined(self) -> Vec<T> {
        let points = (0..to_u32(self.points.len())).into_par_iter().map(|point| self.at_point(point));
        let fans = self.fans();
        let edges = (0..to_u32(self.level.edge_sides.len())).into_par_iter().map(|edge| self.on_edge(edge, &fans));
        points.chain(edges).chain(self.centers.par_iter().copied()).collect()
    }

    /// What becomes of each point in the limit of infinitely many levels.
    pub(super) fn limit(&self) -> Vec<T> {
        let limit = |point| self.averaged(point, |sharpness| sharpness, Mask::limit, CREASE_LIMIT).1;
        (0..to_u32(self.points.len())).into_par_iter().map(limit).collect()
    }

    /// What becomes of a point on the finer level. Where its rule changes with that level, both rules are blended by the mean
    /// of the sharpnesses that become zero. Source: DeRose, Kass and Truong 1998; the mean is OpenSubdiv's.
    fn at_point(&self, point: u32) -> T {
        let (rule, now) = self.averaged(point, |sharpness| sharpness, Mask::smooth, CREASE);
        if rule == Rule::Smooth {
            return now;
        }
        let (next_rule, next) = self.averaged(point, decayed, Mask::smooth, CREASE);
        if rule == next_rule {
            return now;
        }
        let level = self.level;
        let around = level.first_side(point).into_iter().flat_map(|first| level.ring(first));
        let all = around.map(|spoke| level.edge_sharpness(spoke.edge)).chain([level.point_sharpness(point)]);
        let fading = all.filter(|&sharpness| sharpness > 0.0 && decayed(sharpness) == 0.0);
        let (count, sum) = fading.fold((0.0, 0.0), |(count, sum), sharpness| (count + 1.0, sum + f64::from(sharpness)));
        let weight = (sum / count).min(1.0);
        now * weight + next * (1.0 - weight)
    }

    /// A point's rule, and what it makes of the values around it with these masks. `sharpness` turns the edges' and the
    /// point's own into those that count.
    fn averaged(
        &self,
        point: u32,
        sharpness: impl Fn(f32) -> f32,
        smooth: impl Fn(Scheme, u32) -> Mask,
        crease: Mask,
    ) -> (Rule, T) {
        let (level, own) = (self.level, self.points[point as usize]);
        // The butterfly scheme moves no point.
        let first = level.first_side(point).filter(|_| self.scheme != Scheme::Butterfly);
        let Some(first) = first else { return (Rule::Corner, own) };
        let (mut edges, mut sharp_edges) = (0, 0);
        let [mut ends, mut sharp_ends, mut centers] = [T::default(); 3];
        for spoke in level.ring(first) {
            let end = self.points[spoke.far as usize];
            edges += 1;
            ends = ends + end;
            if sharpness(level.edge_sharpness(spoke.edge)) > 0.0 {
                sharp_edges += 1;
                sharp_ends = sharp_ends + end;
            }
            if let Some(side) = spoke.side {
                centers = centers + self.center(side);
            }
        }
        let is_sharp = sharpness(level.point_sharpness(point)) > 0.0;
        match sharp_edges {
            0 | 1 if !is_sharp => (Rule::Smooth, smooth(self.scheme, edges).blend(own, ends, centers)),
            2 if !is_sharp => (Rule::Crease, crease.blend(own, sharp_ends, T::default())),
            _ => (Rule::Corner, own),
        }
    }

    /// The point that divides an edge.
    fn on_edge(&self, edge: u32, fans: &Fans<T>) -> T {
        let (level, sides) = (self.level, self.level.edge_sides[edge as usize]);
        let ends = self.start(sides[0]) + self.start(level.polygons.after(sides[0]));
        let sharp = match self.scheme {
            Scheme::CatmullClark | Scheme::Loop => ends * 0.5,
            Scheme::Butterfly => self.on_crease(sides[0], fans),
        };
        // Edges without a second side are sharp.
        let sharpness = f64::from(level.edge_sharpness(edge));
        if sharpness >= 1.0 {
            return sharp;
        }
        let both = |value: &dyn Fn(u32) -> T| value(sides[0]) + value(sides[1]);
        let opposite = |side| self.start(level.polygons.before(side));
        let smooth = match self.scheme {
            Scheme::CatmullClark => (ends + both(&|side| self.center(side))) * 0.25,
            Scheme::Loop => ends * 0.375 + both(&opposite) * 0.125,
            Scheme::Butterfly => match fans.irregular.get(&edge) {
                Some((sum, ends)) => *sum * (1.0 / ends),
                None => ends * 0.5 + both(&opposite) * 0.125 + both(&|side| self.wings(side)) * -0.0625,
            },
        };
        sharp * sharpness + smooth * (1.0 - sharpness)
    }

    /// The value where a side starts.
    pub(super) fn start(&self, side: u32) -> T {
        self.points[self.level.origins[side as usize] as usize]
    }

    /// The center of a side's face; zero for schemes that have none.
    pub(super) fn center(&self, side: u32) -> T {
        match self.scheme {
            Scheme::CatmullClark => self.centers[self.level.polygons.face_of(side) as usize],
            Scheme::Loop | Scheme::Butterfly => T::default(),
        }
    }
}
