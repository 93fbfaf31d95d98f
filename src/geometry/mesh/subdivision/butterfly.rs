//! The modified butterfly scheme: points stay where they are, and new ones lie on smooth surfaces and curves through those around.
//!
//! Source: Zorin, Schröder and Sweldens 1996, "Interpolating subdivision for meshes with arbitrary topology", with w = 0; Dyn,
//! Gregory and Levin 1987, "A 4-point interpolatory subdivision scheme for curve design", for boundaries. What an edge needs from
//! beyond a boundary is mirrored there, as the former say. Creases are treated as boundaries of both sides, and the points of
//! either as if they had the regular number of faces; sharp points are the ends of such curves.

use std::collections::HashMap;
use std::f64::consts::TAU;

use rayon::prelude::*;

use super::level::Spoke;
use super::values::{Fans, Values};
use super::{Linear, Scheme};
use crate::casts::to_u32;

impl<T: Linear> Values<'_, T> {
    pub(super) fn fans(&self) -> Fans<T> {
        let points = match self.scheme {
            Scheme::CatmullClark | Scheme::Loop => 0..0,
            Scheme::Butterfly => 0..to_u32(self.points.len()),
        };
        let creases = points.clone().into_par_iter().map(|point| self.crease_ends(point)).collect();
        let around: Vec<_> = points.into_par_iter().flat_map_iter(|point| self.around(point)).collect();
        let mut irregular = HashMap::new();
        for (edge, value) in around {
            let (sum, ends) = irregular.entry(edge).or_insert((T::default(), 0.0));
            (*sum, *ends) = (*sum + value, *ends + 1.0);
        }
        Fans { creases, irregular }
    }

    fn crease_ends(&self, point: u32) -> Option<[u32; 2]> {
        let level = self.level;
        let mut sharp = level.ring(level.first_side(point)?).filter(|spoke| level.edge_sharpness(spoke.edge) > 0.0);
        let ends = [sharp.next()?.far, sharp.next()?.far];
        (sharp.next().is_none() && level.point_sharpness(point) == 0.0).then_some(ends)
    }

    /// What a smooth point of other than six edges makes of each: 3/4 of itself, and of its neighbours j steps away from the edge
    /// (1/4 + cos(ja) + cos(2ja)/2) / n, where a is a turn divided by n. The published weights for four edges have half as much of
    /// the last term, and those for three nothing of it. The sums of all waves take time linear in the number of edges.
    fn around(&self, point: u32) -> Vec<(u32, T)> {
        let level = self.level;
        let spokes: Vec<Spoke> = level.first_side(point).into_iter().flat_map(|first| level.ring(first)).collect();
        if spokes.len() == 6 || spokes.iter().any(|spoke| level.edge_sharpness(spoke.edge) > 0.0) {
            return Vec::new();
        }
        let edges = f64::from(to_u32(spokes.len()));
        let waves = |k: u32| {
            let angle = TAU * f64::from(k) / edges;
            let [(sin, cos), (sin_twice, cos_twice)] = [angle, 2.0 * angle].map(f64::sin_cos);
            [1.0, cos, sin, cos_twice, sin_twice]
        };
        let mut sums = [T::default(); 5];
        for (k, spoke) in (0..).zip(&spokes) {
            let far = self.points[spoke.far as usize];
            sums.iter_mut().zip(waves(k)).for_each(|(sum, wave)| *sum = *sum + far * wave);
        }
        let twice = match spokes.len() {
            ..=3 => 0.0,
            4 => 0.25,
            _ => 0.5,
        };
        let own = self.points[point as usize] * 0.75;
        let on_edge = |k: u32| {
            let terms = waves(k).into_iter().zip([0.25, 1.0, 1.0, twice, twice]).zip(sums);
            terms.fold(own, |value, ((wave, weight), sum)| value + sum * (wave * weight / edges))
        };
        (0..).zip(&spokes).map(|(k, spoke)| (spoke.edge, on_edge(k))).collect()
    }

    /// The point that divides a boundary or a crease, by the four-point rule along it. At its end it goes on straight ahead.
    pub(super) fn on_crease(&self, side: u32, fans: &Fans<T>) -> T {
        let [a, b] = [self.level.origins[side as usize], self.level.end(side)];
        let value = |point: u32| self.points[point as usize];
        let beyond = |from: u32, other: u32| match fans.creases[from as usize] {
            Some([first, last]) => value(if first == other { last } else { first }),
            None => value(from) * 2.0 + value(other) * -1.0,
        };
        (value(a) + value(b)) * 0.5625 + (beyond(a, b) + beyond(b, a)) * -0.0625
    }

    /// The sum of the points opposite, beyond both other edges of a side's triangle.
    pub(super) fn wings(&self, side: u32) -> T {
        let (level, polygons) = (self.level, &self.level.polygons);
        let beyond = |side: u32| match level.twin(side) {
            Some(twin) if level.edge_sharpness(level.edges[side as usize]) == 0.0 => self.start(polygons.before(twin)),
            _ => self.start(side) + self.start(polygons.after(side)) + self.start(polygons.before(side)) * -1.0,
        };
        beyond(polygons.after(side)) + beyond(polygons.before(side))
    }
}
