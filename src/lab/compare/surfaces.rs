//! Which of our surfaces another program's vertices lie on.

use glam::DVec3;

use super::assignment::{Overlaid, made_of_all};
use super::foreign::spread;
use super::locator::{COARSE, Locator, OurSurface};
use super::net_mistakes::{NetMistake, THIRD};
use geometry::mesh::Mesh;
use geometry::tessellate::{Inputs, Surface, Tessellation};

/// How many vertices of each kind are tried: those that lie on our surface, and those that don't.
const SAMPLE: usize = 400;
/// A surface is taken if at least this share of the tried vertices lies on it.
const FOUND: f64 = 0.9;
/// The strengths of Phong tessellation that are tried before others: its authors', the strongest, and halves.
const STRENGTHS: [f32; 4] = [0.75, 1.0, 0.5, 0.25];

/// The vertices that are tried on each surface.
pub(super) struct Trial<'a> {
    mesh: &'a Mesh,
    overlaid: &'a Overlaid<'a>,
    /// Our own inputs.
    inputs: Inputs,
    /// In our coordinates.
    sample: Vec<DVec3>,
    /// The share of these that lie on our own surface.
    own: f64,
}

/// How vertices fit a surface.
#[derive(Clone, Copy)]
struct Fitting {
    /// The share of the vertices that lie on it.
    share: f64,
    /// Their mean distance from it, in object units.
    mean: f64,
}

impl<'a> Trial<'a> {
    /// Chooses vertices.
    pub(super) fn new(mesh: &'a Mesh, overlaid: &'a Overlaid<'a>, inputs: &Inputs) -> Self {
        let is_stray = |index: &u32| overlaid.places[*index as usize].distance > overlaid.fit;
        let (strays, others): (Vec<u32>, Vec<u32>) = (0..overlaid.positions.len() as u32).partition(is_stray);
        let chosen = |list: &[u32]| -> Vec<DVec3> {
            spread(list.len(), SAMPLE).map(|place| overlaid.positions[list[place] as usize]).collect()
        };
        let (others, strays) = (chosen(&others), chosen(&strays));
        let own = others.len() as f64 / (others.len() + strays.len()).max(1) as f64;
        Self { mesh, overlaid, inputs: *inputs, sample: [others, strays].concat(), own }
    }

    /// Returns the surface of ours that the vertices lie on, or what a usual mistake makes of our own; `None` if they lie on none of these
    /// better than on our own.
    pub(super) fn other_surface(&self) -> Option<OurSurface> {
        let found = self.best(self.candidates()).or_else(|| self.other_strength()).or_else(|| self.mistake())?;
        let (surface, fitting) = found;
        let own = OurSurface::from(self.inputs);
        (surface != own && fitting.share > self.own + 0.01).then_some(surface)
    }

    /// The first of the surfaces that the most vertices lie on, if nearly all do.
    fn best(&self, among: Vec<OurSurface>) -> Option<(OurSurface, Fitting)> {
        let mut best: Option<(OurSurface, Fitting)> = None;
        for surface in among {
            let fitting = self.fitting(&surface);
            if best.is_none_or(|(_, other)| fitting.share > other.share + 0.005) {
                best = Some((surface, fitting));
            }
        }
        best.filter(|(_, fitting)| fitting.share >= FOUND)
    }

    /// Our own tessellation without displacement.
    fn undisplaced(&self) -> Tessellation {
        self.inputs.tessellation.undisplaced()
    }

    fn surface(&self, tessellation: Tessellation, mistake: Option<NetMistake>) -> OurSurface {
        OurSurface { inputs: Inputs { tessellation, ..self.inputs }, mistake }
    }

    /// The surfaces that are tried, without displacement. Our own comes first, if ours is displaced or has a strength.
    fn candidates(&self) -> Vec<OurSurface> {
        let own = self.undisplaced();
        let others = Surface::ALL.into_iter().flat_map(|surface| {
            let strengths = if surface.is_phong() { &STRENGTHS[..] } else { &STRENGTHS[..1] };
            strengths.iter().map(move |&alpha| {
                let alpha = if surface.is_phong() { alpha } else { own.alpha };
                Tessellation { surface, alpha, ..own }
            })
        });
        let others = others.filter(|other| *other != own);
        let all = std::iter::once(own).filter(|own| *own != self.inputs.tessellation).chain(others);
        all.map(|tessellation| self.surface(tessellation, None)).collect()
    }

    /// Seeks the strength of Phong tessellation at which the vertices are nearest to it.
    fn other_strength(&self) -> Option<(OurSurface, Fitting)> {
        let own = self.undisplaced();
        [Surface::PhongAen, Surface::Phong].into_iter().find_map(|surface| {
            let at = |alpha: f32| self.surface(Tessellation { surface, alpha: alpha.clamp(0.0, 1.0), ..own }, None);
            self.fitted([0.0, 1.0], at, plain)
        })
    }

    /// Seeks the usual mistake in the control points of our own surface that gives theirs.
    fn mistake(&self) -> Option<(OurSurface, Fitting)> {
        let own = self.undisplaced();
        if own.surface.is_flat() {
            return None;
        }
        let with = |mistake: NetMistake| self.surface(own, Some(mistake));
        let center = |x: f32| with(NetMistake::Center(x));
        let edges = |bend: f32| with(NetMistake::Edges { share: THIRD, bend });
        self.best(NetMistake::usual().map(with).collect())
            .or_else(|| self.fitted([-1.5, 2.0], center, plain))
            // Control points lie as far beside an edge as the square of a normal's length says.
            .or_else(|| self.fitted([0.0, 4.0], edges, |bend| plain(bend.max(0.0).sqrt()).powi(2)))
    }

    /// Seeks the number at which the vertices are nearest to the surface `at` it. Their distance from it is proportional to the difference
    /// of numbers, about, so that it is sought where two distances say that it is 0.
    fn fitted(
        &self,
        [mut least, mut most]: [f32; 2],
        at: impl Fn(f32) -> OurSurface,
        plain: impl Fn(f32) -> f32,
    ) -> Option<(OurSurface, Fitting)> {
        const STEPS: usize = 4;
        for _ in 0..STEPS {
            let [lower, upper] = [least, most].map(|number| self.fitting(&at(number)).mean);
            // On a flat mesh all are alike.
            if lower + upper == 0.0 {
                break;
            }
            let middle = least + (most - least) * (lower / (lower + upper)) as f32;
            let reach = (most - least) / 10.0;
            [least, most] = [middle - reach, middle + reach];
        }
        let found = at(plain(0.5 * (least + most)));
        let fitting = self.fitting(&found);
        (fitting.share >= FOUND).then_some((found, fitting))
    }

    fn fitting(&self, surface: &OurSurface) -> Fitting {
        let Some(locator) = Locator::from_surface(self.mesh, self.overlaid.topology, surface, COARSE) else {
            return Fitting { share: 0.0, mean: f64::INFINITY };
        };
        let distance = |index: usize| locator.place(self.sample[index]).map_or(f64::INFINITY, |place| place.distance);
        let distances = made_of_all(self.sample.len(), distance);
        let count = distances.len().max(1) as f64;
        let fits = distances.iter().filter(|distance| **distance <= self.overlaid.fit).count() as f64;
        Fitting { share: fits / count, mean: distances.iter().sum::<f64>() / count }
    }
}

/// A number without more digits than anybody means.
fn plain(number: f32) -> f32 {
    (number * 1000.0).round() / 1000.0
}
