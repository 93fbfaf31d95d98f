//! Exact surfaces, and which shape has which.

use std::sync::{Mutex, PoisonError};

use glam::{DVec2, DVec3};

use super::bicubic::Patches;
use super::ellipsoid::Ellipsoid;
use super::revolved::{Profile, Torus};
use super::saddle::Saddle;
use super::spread::{Spread, radical_inverse};
use super::surface::Surface;
use super::{Facets, Nearest, Sample};
use geometry::mesh::Shape;
use geometry::mesh::shapes::polyhedra::ELLIPSOID;
use geometry::mesh::shapes::revolved::{HALF_HEIGHT, MAJOR, MINOR, RADIUS};
use geometry::mesh::shapes::sheets::SADDLE_HALF;

/// A surface whose nearest points are computed to about 1e-12 of its size.
pub struct Exact {
    surface: Box<dyn Surface>,
    spread: Spread,
    /// The triangles that stood for it last.
    facets: Mutex<Option<((f64, u64), Facets)>>,
}

/// Returns the surface that a shape's corners are samples of, for shapes that have [levels](Shape::has_levels).
pub fn of_shape(shape: Shape) -> Option<Exact> {
    let [radius, half] = [RADIUS, HALF_HEIGHT].map(f64::from);
    let (bottom, top) = (DVec2::new(0.0, -half), DVec2::new(0.0, half));
    let out = DVec2::new(radius, 0.0);
    let surface: Box<dyn Surface> = match shape {
        Shape::CubeSplit | Shape::CubeSmooth | Shape::Moebius => return None,
        Shape::Icosahedron | Shape::Icosphere => Box::new(Ellipsoid { radii: DVec3::ONE }),
        Shape::Ellipsoid => Box::new(Ellipsoid { radii: ELLIPSOID.as_dvec3() }),
        Shape::Torus => Box::new(Torus { major: MAJOR.into(), minor: MINOR.into() }),
        Shape::Cylinder => Box::new(Profile::new(&[bottom, out + bottom, out + top, top])),
        Shape::Cone => Box::new(Profile::new(&[bottom, out + bottom, top])),
        Shape::Saddle => Box::new(Saddle { half: SADDLE_HALF.into() }),
        Shape::Bicubic => Box::new(Patches::new(geometry::mesh::shapes::bicubic::patches())),
    };
    Some(Exact::new(surface))
}

impl Exact {
    fn new(surface: Box<dyn Surface>) -> Self {
        let spread = Spread::new(surface.charts(), |chart, s, t| surface.at(chart, s, t).1);
        Self { spread, surface, facets: Mutex::default() }
    }

    /// Returns the nearest point of the surface.
    pub fn closest(&self, p: DVec3) -> Nearest {
        self.closest_facing(p, DVec3::ZERO)
    }

    pub(super) fn closest_facing(&self, p: DVec3, facing: DVec3) -> Nearest {
        self.surface.closest(p, facing)
    }

    /// Returns the least and the greatest coordinates.
    pub fn extent(&self) -> [DVec3; 2] {
        self.surface.extent()
    }

    /// Returns the area in square object units, to about 1e-3.
    pub fn area(&self) -> f64 {
        self.spread.area()
    }

    /// Returns `count` points, spread evenly by area: a Hammersley set.
    pub fn samples(&self, count: usize) -> Vec<Sample> {
        let sample = |i: usize| {
            let (chart, s, t) = self.spread.place((i as f64 + 0.5) / count as f64, radical_inverse(2, i));
            self.surface.at(chart, s, t).0
        };
        (0..count).map(sample).collect()
    }

    /// Triangles that are at most `sag` away, or somewhat less; or farther if they would be more than `most`.
    pub(super) fn facets(&self, sag: f64, most: u64) -> Facets {
        // A comparison needs them twice.
        let sag = sag.log2().floor().exp2();
        let mut known = self.facets.lock().unwrap_or_else(PoisonError::into_inner);
        match &*known {
            Some((of, facets)) if *of == (sag, most) => facets.clone(),
            _ => {
                let facets = Facets::new(&*self.surface, sag, most);
                *known = Some(((sag, most), facets.clone()));
                facets
            }
        }
    }
}
