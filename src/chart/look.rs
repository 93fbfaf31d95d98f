//! How methods are told apart, also without colours: surfaces by their points, LODs by their lines.

use plotters::style::RGBColor;

use super::{LodKind, Method};
use crate::plot::{BLUE, BLUISH_GREEN, INK, ORANGE, REDDISH_PURPLE, SKY_BLUE, VERMILION};
use crate::tessellate::Surface;

/// What a method's points and lines look like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    pub color: RGBColor,
    pub shape: Shape,
    pub fill: Fill,
    /// Px drawn and px left out of a line; none for an unbroken one.
    pub dash: Option<[f64; 2]>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    Disc,
    /// So many corners, the first this many degrees from the top, to the right.
    Polygon(u32, u32),
    Star,
}

/// What tells partitionings and normals apart, where there are several of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fill {
    Full,
    Hollow,
    Pale,
}

impl Look {
    /// `variant` counts methods of the same surface and LOD.
    pub fn of(method: Method, variant: usize) -> Self {
        let (color, shape) = match method.surface {
            Surface::Flat => (INK, Shape::Disc),
            Surface::PnAen => (BLUE, Shape::Polygon(4, 45)),
            Surface::PhongAen => (VERMILION, Shape::Polygon(3, 0)),
            Surface::NagataAen => (BLUISH_GREEN, Shape::Polygon(4, 0)),
            Surface::Pn => (SKY_BLUE, Shape::Polygon(6, 0)),
            Surface::PnCrease => (REDDISH_PURPLE, Shape::Star),
            Surface::Phong => (ORANGE, Shape::Polygon(3, 180)),
            Surface::Nagata => (RGBColor(120, 120, 120), Shape::Polygon(3, 90)),
        };
        let fill = [Fill::Full, Fill::Hollow, Fill::Pale][variant % 3];
        Self { color, shape, fill, dash: dash(method.lod) }
    }
}

pub fn dash(lod: LodKind) -> Option<[f64; 2]> {
    match lod {
        LodKind::Uniform => None,
        LodKind::Paper => Some([7.0, 4.0]),
        LodKind::Error => Some([2.0, 2.5]),
    }
}
