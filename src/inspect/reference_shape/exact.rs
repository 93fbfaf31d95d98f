//! Exact surfaces, and which shape has which.

use std::sync::{Mutex, PoisonError};

use glam::{DVec2, DVec3};

use super::bicubic::Patches;
use super::ellipsoid::Ellipsoid;
use super::revolved::{Profile, Torus};
use super::saddle::Saddle;
use super::spread::{Spread, radical_inverse};
use super::{EXACT, Facets, Known, Nearest, Sample, Surface};
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
    let spread = Spread::new(surface.charts(), |chart, s, t| surface.at(chart, s, t).1);
    Some(Exact { spread, surface, facets: Mutex::default() })
}

impl Known for Exact {
    fn closest_facing(&self, p: DVec3, facing: DVec3) -> Nearest {
        self.surface.closest(p, facing)
    }

    fn proven(&self, p: DVec3) -> f64 {
        (self.closest(p).distance - EXACT * self.diagonal()).max(0.0)
    }

    fn is_exact(&self) -> bool {
        true
    }

    /// Triangles that are at most `sag` away, or somewhat less; or farther if they would be more than `most`.
    fn facets(&self, sag: f64, most: u64) -> Facets {
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

    /// A Hammersley set.
    fn samples(&self, count: usize) -> Vec<Sample> {
        let sample = |i: usize| {
            let (chart, s, t) = self.spread.place((i as f64 + 0.5) / count as f64, radical_inverse(2, i));
            self.surface.at(chart, s, t).0
        };
        (0..count).map(sample).collect()
    }

    fn area(&self) -> f64 {
        self.spread.area()
    }

    fn extent(&self) -> [DVec3; 2] {
        self.surface.extent()
    }
}
