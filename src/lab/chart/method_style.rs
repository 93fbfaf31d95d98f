//! The styles that tell methods apart, also without colours: each surface has its own markers, and each LOD its own lines.

use std::f64::consts::TAU;

use plotters::style::RGBColor;

use super::{LodKind, Method};
use geometry::tessellate::Surface;
use inspect::plot::{BLUE, BLUISH_GREEN, INK, ORANGE, REDDISH_PURPLE, SKY_BLUE, VERMILION};

/// How a method's points and lines are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MethodStyle {
    pub color: RGBColor,
    pub shape: Shape,
    pub fill: Fill,
    /// The lengths of a dash and of the gap after it, in px; `None` for a solid line.
    pub dash: Option<[f64; 2]>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    Disc,
    /// The number of corners, and the angle of the first one, in degrees clockwise from the top.
    Polygon(u32, u32),
    Star,
}

/// How a marker is filled. This tells partitionings and normals apart, if there are several.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fill {
    Full,
    Hollow,
    Pale,
}

impl Shape {
    /// The convex polygons that make up the shape, as corners in px around its middle; none for a disc. Sizes are such that all
    /// shapes look equally large as a disc of this radius.
    pub fn pieces(self, radius: f64) -> Vec<Vec<[f64; 2]>> {
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

impl MethodStyle {
    /// The style of a method. `variant` is its index among methods with the same surface and LOD.
    pub fn new(method: Method, variant: usize) -> Self {
        let fill = [Fill::Full, Fill::Hollow, Fill::Pale][variant % 3];
        Self { fill, dash: dash(method.lod), ..Self::from_surface(method.surface) }
    }

    /// The style of a surface under uniform LOD.
    pub fn from_surface(surface: Surface) -> Self {
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

/// The dashes of an LOD's lines: see [`MethodStyle::dash`].
pub fn dash(lod: LodKind) -> Option<[f64; 2]> {
    match lod {
        LodKind::Uniform => None,
        LodKind::Paper => Some([7.0, 4.0]),
        LodKind::Error => Some([2.0, 2.5]),
        LodKind::ErrorRows => Some([1.0, 5.0]),
    }
}
