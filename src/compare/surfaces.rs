//! Which of our surfaces another program's vertices lie on.

use glam::DVec3;

use super::assignment::{Overlaid, made_of_all};
use super::foreign::spread;
use super::locator::{COARSE, Locator};
use crate::mesh::Mesh;
use crate::progress::{Cancelled, Progress};
use crate::tessellate::{Displacement, Inputs, Surface, Tessellation};

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
    /// Chooses vertices. `strays` are those that don't lie on our own surface.
    pub(super) fn new(mesh: &'a Mesh, overlaid: &'a Overlaid<'a>, inputs: &Inputs, strays: &[u32]) -> Self {
        let is_stray = |index: &u32| strays.binary_search(index).is_ok();
        let others: Vec<u32> = (0..overlaid.positions.len() as u32).filter(|index| !is_stray(index)).collect();
        let chosen = |list: &[u32]| -> Vec<DVec3> {
            spread(list.len(), SAMPLE).map(|place| overlaid.positions[list[place] as usize]).collect()
        };
        let (others, strays) = (chosen(&others), chosen(strays));
        let own = others.len() as f64 / (others.len() + strays.len()).max(1) as f64;
        Self { mesh, overlaid, inputs: *inputs, sample: [others, strays].concat(), own }
    }

    /// Returns our inputs with the surface that the vertices lie on; `None` if they lie on none of ours better than on our own.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn other_surface(&self, progress: &Progress) -> Result<Option<Inputs>, Cancelled> {
        let own = self.inputs.tessellation;
        let mut best: Option<(Tessellation, Fitting)> = None;
        for tessellation in self.candidates() {
            let fitting = self.fitting(&tessellation, progress)?;
            let is_better = best.is_none_or(|(_, other)| fitting.share > other.share + 0.005);
            if is_better {
                best = Some((tessellation, fitting));
            }
        }
        let found = best.filter(|(_, fitting)| fitting.share >= FOUND);
        let found = match found {
            Some(found) => Some(found),
            None => self.other_strength(progress)?,
        };
        let found = found.filter(|(tessellation, fitting)| *tessellation != own && fitting.share > self.own + 0.01);
        Ok(found.map(|(tessellation, _)| Inputs { tessellation, ..self.inputs }))
    }

    /// The surfaces that are tried, without displacement. Our own comes first, if ours is displaced or has a strength.
    fn candidates(&self) -> Vec<Tessellation> {
        let own = Tessellation { displacement: Displacement::Off, ..self.inputs.tessellation };
        let others = Surface::ALL.into_iter().flat_map(|surface| {
            let strengths = if surface.is_phong() { &STRENGTHS[..] } else { &STRENGTHS[..1] };
            strengths.iter().map(move |&alpha| {
                let alpha = if surface.is_phong() { alpha } else { own.alpha };
                Tessellation { surface, alpha, ..own }
            })
        });
        let others = others.filter(|other| *other != own);
        std::iter::once(own).filter(|own| *own != self.inputs.tessellation).chain(others).collect()
    }

    /// Seeks the strength of Phong tessellation at which the vertices are nearest to it. Their distance from it is proportional to the
    /// difference of strengths, about, so that it is sought where two distances say that it is 0.
    fn other_strength(&self, progress: &Progress) -> Result<Option<(Tessellation, Fitting)>, Cancelled> {
        const STEPS: usize = 4;
        let own = Tessellation { displacement: Displacement::Off, ..self.inputs.tessellation };
        for surface in [Surface::PhongAen, Surface::Phong] {
            let at = |alpha: f32| Tessellation { surface, alpha: alpha.clamp(0.0, 1.0), ..own };
            let [mut least, mut most] = [0.0_f32, 1.0];
            for _ in 0..STEPS {
                let [lower, upper] =
                    [self.fitting(&at(least), progress)?.mean, self.fitting(&at(most), progress)?.mean];
                // On a flat mesh all strengths are alike.
                if lower + upper == 0.0 {
                    break;
                }
                let middle = least + (most - least) * (lower / (lower + upper)) as f32;
                let reach = (most - least) / 10.0;
                [least, most] = [middle - reach, middle + reach];
            }
            // Nobody means a strength of so many digits.
            let found = at(((least + most) * 500.0).round() / 1000.0);
            let fitting = self.fitting(&found, progress)?;
            if fitting.share >= FOUND {
                return Ok(Some((found, fitting)));
            }
        }
        Ok(None)
    }

    fn fitting(&self, tessellation: &Tessellation, progress: &Progress) -> Result<Fitting, Cancelled> {
        let inputs = Inputs { tessellation: *tessellation, ..self.inputs };
        let Some(locator) = Locator::of_surface(self.mesh, self.overlaid.topology, &inputs, COARSE) else {
            return Ok(Fitting { share: 0.0, mean: f64::INFINITY });
        };
        let distance = |index: usize| locator.place(self.sample[index]).map_or(f64::INFINITY, |place| place.distance);
        let distances = made_of_all(self.sample.len(), progress, distance)?;
        let count = distances.len().max(1) as f64;
        let fits = distances.iter().filter(|distance| **distance <= self.overlaid.fit).count() as f64;
        Ok(Fitting { share: fits / count, mean: distances.iter().sum::<f64>() / count })
    }
}
