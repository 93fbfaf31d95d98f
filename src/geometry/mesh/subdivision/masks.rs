//! The weights with which values around a point are added up.

use std::f64::consts::TAU;

use super::{Linear, Scheme};

/// The weights of a point, of the far end of each of its edges, and of the center of each of its faces.
#[derive(Clone, Copy)]
pub(super) struct Mask {
    pub(super) own: f64,
    pub(super) end: f64,
    pub(super) center: f64,
}

/// On a crease, whose sharp edges' ends count: a uniform cubic B-spline. Source: Hoppe et al. 1994.
pub(super) const CREASE: Mask = Mask { own: 0.75, end: 0.125, center: 0.0 };

/// The same for the limit.
pub(super) const CREASE_LIMIT: Mask = Mask { own: 2.0 / 3.0, end: 1.0 / 6.0, center: 0.0 };

/// Of a point that stays where it is.
const KEPT: Mask = Mask { own: 1.0, end: 0.0, center: 0.0 };

impl Mask {
    /// A point's own value and the sums over its edges' far ends and its faces' centers, each times its weight.
    pub(super) fn blend<T: Linear>(self, own: T, ends: T, centers: T) -> T {
        own * self.own + ends * self.end + centers * self.center
    }

    /// At a smooth point with n edges, for the next level. Source: Catmull and Clark 1978, for means of edges' middles written
    /// with their ends; Loop 1987.
    pub(super) fn smooth(scheme: Scheme, edges: u32) -> Self {
        let n = f64::from(edges);
        match scheme {
            Scheme::CatmullClark => Self { own: (n - 2.0) / n, end: 1.0 / (n * n), center: 1.0 / (n * n) },
            Scheme::Loop => {
                let end = loop_weight(n);
                Self { own: 1.0 - n * end, end, center: 0.0 }
            }
            Scheme::Butterfly => KEPT,
        }
    }

    /// At a smooth point with n edges, for the limit surface. Source: Halstead, Kass and DeRose 1993, (n²v + 4Σe + Σf)/(n(n + 5)) of
    /// the next level's points, written with those of this one, so that it holds for all polygons; Loop 1987.
    pub(super) fn limit(scheme: Scheme, edges: u32) -> Self {
        let n = f64::from(edges);
        match scheme {
            Scheme::CatmullClark => {
                let part = 1.0 / (n * (n + 5.0));
                Self { own: n * (n - 1.0) * part, end: 2.0 * part, center: 4.0 * part }
            }
            Scheme::Loop => {
                let end = 1.0 / (n + 0.375 / loop_weight(n));
                Self { own: 1.0 - n * end, end, center: 0.0 }
            }
            Scheme::Butterfly => KEPT,
        }
    }
}

/// The weight of each of a point's n neighbours.
fn loop_weight(n: f64) -> f64 {
    let beta = 0.375 + 0.25 * (TAU / n).cos();
    (0.625 - beta * beta) / n
}
