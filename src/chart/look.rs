//! How methods are told apart, also without colours: surfaces by their points, LODs by their lines.

use std::f64::consts::TAU;

use plotters::style::RGBColor;

use super::{LodKind, Method};
use crate::plot::{BLUE, BLUISH_GREEN, INK, ORANGE, REDDISH_PURPLE, SKY_BLUE, VERMILION};
use crate::tessellate::Surface;

/// What a method's points and lines look like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Look {
    pub color: RGBColor,
    pub shape: Shape,
    pub fill: Fill,
    /// Px drawn and px left out of a line; none for an unbroken one.
    pub dash: Option<[f64; 2]>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    Disc,
    /// So many corners, the first this many degrees from the top, to the right.
    Polygon(u32, u32),
    Star,
}

/// What tells partitionings and normals apart, where there are several of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fill {
    Full,
    Hollow,
    Pale,
}

impl Shape {
    /// Convex pieces that make it up, as corners around its middle, so large that all shapes look alike; none of a disc.
    pub(crate) fn pieces(self, radius: f64) -> Vec<Vec<[f64; 2]>> {
        let around = |degrees: f64, radius: f64| {
            let (sin, cos) = (TAU * degrees / 360.0).sin_cos();
            [radius * sin, -radius * cos]
        };
        match self {
            Self::Disc => Vec::new(),
            Self::Polygon(count, first) => {
                let radius = radius * if count == 3 { 1.35 } else { 1.2 };
                let step = 360.0 / f64::from(count);
                vec![(0..count).map(|k| around(f64::from(first) + f64::from(k) * step, radius)).collect()]
            }
            Self::Star => {
                let inner = |degrees: f64| around(degrees, 0.65 * radius);
                let tip = |k: u32| 72.0 * f64::from(k);
                let kite = |at: f64| vec![[0.0; 2], inner(at - 36.0), around(at, 1.5 * radius), inner(at + 36.0)];
                (0..5).map(|k| kite(tip(k))).collect()
            }
        }
    }
}

impl Look {
    /// `variant` counts methods of the same surface and LOD.
    pub(crate) fn of(method: Method, variant: usize) -> Self {
        let fill = [Fill::Full, Fill::Hollow, Fill::Pale][variant % 3];
        Self { fill, dash: dash(method.lod), ..Self::of_surface(method.surface) }
    }

    /// What a surface's points look like, and its lines under uniform LOD.
    pub(crate) fn of_surface(surface: Surface) -> Self {
        let (color, shape) = match surface {
            Surface::Flat => (INK, Shape::Disc),
            Surface::PnAen => (BLUE, Shape::Polygon(4, 45)),
            Surface::PhongAen => (VERMILION, Shape::Polygon(3, 0)),
            Surface::NagataAen => (BLUISH_GREEN, Shape::Polygon(4, 0)),
            Surface::Pn => (SKY_BLUE, Shape::Polygon(6, 0)),
            Surface::PnCrease => (REDDISH_PURPLE, Shape::Star),
            Surface::Phong => (ORANGE, Shape::Polygon(3, 180)),
            Surface::Nagata => (RGBColor(120, 120, 120), Shape::Polygon(3, 90)),
        };
        Self { color, shape, fill: Fill::Full, dash: None }
    }
}

pub(crate) fn dash(lod: LodKind) -> Option<[f64; 2]> {
    match lod {
        LodKind::Uniform => None,
        LodKind::Paper => Some([7.0, 4.0]),
        LodKind::Error => Some([2.0, 2.5]),
    }
}
