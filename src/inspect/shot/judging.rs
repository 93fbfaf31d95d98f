//! Holds what a shot emitted to gates, and draws the worst place that one found.

use image::RgbaImage;
use serde::{Deserialize, Serialize};

use super::{Shot, ShotError};
use crate::engine::Measurements;
use crate::gates::{Deviation, Facts, Gate, GateKind, Judgement, Limit, Spot, Standpoints, judge};
use crate::measure::{
    Accuracy, AccuracyOptions, CrossedPatches, CrossingMeasurement, MOST_KEPT, Narrow, Pop, Sight, farthest_pop,
};
use crate::render::{Camera, Leaks, Scene, worst_lines};
use crate::settings::{Overlays, Settings, SplitSide};
use geometry::mesh::t_junctions;
use geometry::progress::Progress;
use geometry::tessellate::{Inputs, Tessellated};
use gpu::{GpuError, Timing};

/// A flight begins so many times as far from the camera's target as the camera is, and takes so many frames of one ratio of
/// distances: a second.
const FLIGHT_FROM: f32 = 4.0;
const FLIGHT_FRAMES: u32 = 60;

/// How much there is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Numbers {
    pub triangles_in: u64,
    pub patches: u64,
    pub triangles_out: u64,
    pub vertices_out: u64,
}

impl Numbers {
    pub(super) fn new(Scene { tessellator, .. }: &Scene) -> Self {
        let [triangles_in, patches] = [tessellator.mesh().triangles.len(), tessellator.topology().patches.len()];
        let (vertices_out, triangles_out) = tessellator.totals();
        Self { triangles_in: triangles_in as u64, patches: patches as u64, triangles_out, vertices_out }
    }
}

impl Shot {
    /// Judges the right half, seen from the picture's camera, by each gate, and measures what they need. `tolerance_px` is what
    /// the error on screen is compared with. The stats have the judgements from now on.
    ///
    /// # Errors
    /// The device was lost, or `progress` was cancelled.
    pub fn judge(
        &mut self,
        gates: &[Gate],
        tolerance_px: f32,
        progress: &Progress,
    ) -> Result<Vec<Judgement>, ShotError> {
        let has = |kind| gates.iter().any(|gate| gate.kind == kind);
        let inputs = self.subject.settings.inputs(self.lod_view);
        let Self { engine, scene, .. } = self;
        let results = self.results[SplitSide::Right as usize].get_or_insert_default();
        if results.survey.is_none() && gates.iter().any(|gate| gate.kind.needs_survey()) {
            let wanted = Measurements { survey: true, ..Measurements::default() };
            results.survey = engine.measure_watched(scene, &wanted, progress)?.survey;
            progress.check()?;
        }
        let leaks = if has(GateKind::Leaks) { self.leaks(&inputs)? } else { None };
        let is_compared = has(GateKind::AboveTolerance);
        let above = || self.engine.patches_above(&mut self.scene, &inputs, tolerance_px);
        let above = is_compared.then(above).transpose()?;
        self.error_place = above.and_then(|above| above.worst);
        let deviation =
            has(GateKind::Deviation).then(|| self.deviation_both_ways(gates, &inputs, progress)).transpose()?;
        let crossed = has(GateKind::SelfIntersections).then(|| self.crossed_patches(progress)).transpose()?;
        let pop = has(GateKind::Pops).then(|| self.farthest_pop(progress)).transpose()?;
        let junctions = has(GateKind::TJunctions);
        let junctions = junctions.then(|| t_junctions(&self.subject.loaded.topology, progress)).transpose()?;
        // The picture is mirrored after it was drawn.
        let (view, is_mirrored) = (self.view(), self.view.camera.is_mirrored());
        let facts = Facts {
            topology: &self.posed.topology,
            warnings: Some(&self.subject.loaded.warnings),
            emitted: Some(self.scene.tessellator.totals()),
            measured: self.results(SplitSide::Right).and_then(|results| results.survey.as_ref()),
            mesh: Some((&self.subject.loaded.mesh, &self.subject.loaded.topology)),
            junctions: junctions.as_deref(),
            leaks: leaks.as_ref(),
            view: Some(if is_mirrored { view.mirrored() } else { view }),
            above: above.as_ref(),
            crossed: crossed.as_ref().map(Option::as_deref),
            deviation,
            pop,
        };
        self.judged = judge(gates, &facts);
        Ok(self.judged.clone())
    }

    /// The largest distance from the reference surface and back, or why there is none. It is measured until it is decided whether
    /// it is above the gates' limits, or as finely as is of use.
    ///
    /// # Errors
    /// The device was lost, or `progress` was cancelled.
    fn deviation_both_ways(
        &mut self,
        gates: &[Gate],
        inputs: &Inputs,
        progress: &Progress,
    ) -> Result<Result<Deviation, &'static str>, ShotError> {
        let Self { engine, scene, subject, .. } = self;
        let Some((_, reference_shape)) = &subject.reference_surface else {
            return Ok(Err("the distance isn't known without a reference surface: give one with --reference-surface"));
        };
        if engine.measure(scene)?.culled.total() > 0 {
            return Ok(Err(
                "the distance isn't known where patches are left out: judge it without clipping and culling",
            ));
        }
        let mut deviation = Err("nothing was emitted that a distance could be measured from");
        for narrow in [Narrow::default(), Narrow { relative: 1e-5, absolute: 1e-9, ..Narrow::default() }] {
            let options = AccuracyOptions { narrow, ..AccuracyOptions::default() };
            let accuracy = Some((&**reference_shape, &inputs.view, options));
            let wanted = Measurements { accuracy, ..Measurements::default() };
            let accuracy = engine.measure_watched(scene, &wanted, progress)?.accuracy;
            progress.check()?;
            let Some(Accuracy { diagonal, to_reference, worst_to_reference: mut worst, from_reference, .. }) = accuracy
            else {
                break;
            };
            let Some((back, place)) = from_reference else {
                return Ok(Err("the distance isn't known, since too many triangles were emitted to keep them"));
            };
            let [to, back] = [to_reference.largest, back.largest];
            if back.at_least > to.at_least {
                worst = place;
            }
            let distance = to.or(back);
            deviation = Ok(Deviation { distance, diagonal, worst });
            let lies_between = |gate: &Gate| match gate.limit {
                Limit::Length(length) => (distance.at_least..distance.at_most).contains(&length.in_units(diagonal)),
                Limit::Count(_) | Limit::Px(_) => false,
            };
            if !gates.iter().any(lies_between) {
                break;
            }
        }
        Ok(deviation)
    }

    /// The farthest jump while the camera flies to where it is, each frame seen from where it is then; or why there is none.
    ///
    /// # Errors
    /// The device was lost, or `progress` was cancelled.
    fn farthest_pop(&mut self, progress: &Progress) -> Result<Result<Option<Pop>, &'static str>, ShotError> {
        let Self { engine, scene, subject, view, target, .. } = self;
        if view.camera.rows.is_some() || view.lod_camera.is_some() {
            return Ok(Err("LOD can't follow this camera as it flies: judge from --camera, without one of LOD's own"));
        }
        let (mut before, mut farthest): (Option<Tessellated>, Option<Pop>) = (None, None);
        // The last frame is the picture's, which the scene is counted for again then.
        for frame in 0..=FLIGHT_FRAMES {
            progress.check()?;
            let left = 1.0 - frame as f32 / FLIGHT_FRAMES as f32;
            let camera = Camera { distance: view.camera.distance * FLIGHT_FROM.powf(left), ..view.camera };
            let lod_view = camera.lod_view(target.viewport(), &scene.bounds);
            engine.count(scene, &subject.settings.inputs(lod_view), &mut Timing::Off)?;
            if scene.tessellator.totals().1 > MOST_KEPT as u64 {
                engine.count(scene, &subject.settings.inputs(self.lod_view), &mut Timing::Off)?;
                return Ok(Err("too many triangles were emitted to follow the surface"));
            }
            let after = engine.read_tessellated(scene)?;
            let jumped = before.and_then(|before| farthest_pop(&before, &after, &lod_view));
            farthest = farthest.into_iter().chain(jumped).reduce(Pop::farther);
            before = Some(after);
        }
        Ok(Ok(farthest))
    }

    /// The patches that cross each other; none if there are too many triangles to find them.
    ///
    /// # Errors
    /// The device was lost, or `progress` was cancelled.
    fn crossed_patches(&mut self, progress: &Progress) -> Result<Option<Vec<CrossedPatches>>, ShotError> {
        let mut measurement = CrossingMeasurement::default();
        self.engine.visit_watched(&mut self.scene, &mut [&mut measurement], progress)?;
        progress.check()?;
        Ok(measurement.finish(&self.posed.topology, progress)?)
    }

    /// The leaks of the picture, which a survey must have been made for. The scene must have been counted with `inputs`.
    ///
    /// # Errors
    /// The device was lost.
    fn leaks(&mut self, inputs: &Inputs) -> Result<Option<Leaks>, GpuError> {
        let Self { engine, scene, results, target, view, .. } = self;
        let survey = results[SplitSide::Right as usize].as_ref().and_then(|results| results.survey.as_ref());
        let Some(measured) = survey else { return Ok(None) };
        let leaks = engine.find_leaks(scene, inputs, measured, target.size, &view.camera)?;
        let mirrored = view.camera.is_mirrored();
        Ok(Some(if mirrored { leaks.mirrored(target.viewport().x) } else { leaks }))
    }

    /// How much the mesh has, and how much was emitted.
    pub fn numbers(&self) -> Numbers {
        Numbers::new(&self.scene)
    }

    /// Draws the worst place that a gate found, with the overlay that shows it, as it was tessellated for the judged picture.
    /// None if the gate is about no place. The shot keeps its camera and settings.
    ///
    /// # Errors
    /// The device was lost, or `progress` was cancelled.
    pub fn evidence(&mut self, judgement: &Judgement, progress: &Progress) -> Result<Option<RgbaImage>, ShotError> {
        let Some(place) = &judgement.place else { return Ok(None) };
        let camera = self.standpoint(&place.spot)?;
        let (view, settings) = (self.view, self.subject.settings);
        let (results, silhouette) = (std::mem::take(&mut self.results), self.silhouette.take());
        let lines = self.subject.more_lines.clone();
        self.view.camera = camera;
        // So close, the frustum of the camera of LOD would only hide the place. Factors are computed for it all the same.
        self.view.lod_camera = None;
        let overlays = Overlays::new(judgement.kind.overlays()).unwrap_or_default();
        self.subject.settings = Settings { overlays, split: None, ..settings };
        if let Some(at) = place.spot.at() {
            // The error has a line to where the emitted point should be.
            let worst = self.error_place.filter(|_| judgement.kind == GateKind::AboveTolerance);
            let mark = worst_lines(at, worst.map_or(at, |worst| worst.reference_shape.as_vec3()));
            self.subject.more_lines[SplitSide::Right as usize].extend(mark);
        }
        let picture = self.picture(None, progress);
        (self.view, self.subject.settings) = (view, settings);
        (self.results, self.silhouette) = (results, silhouette);
        self.subject.more_lines = lines;
        picture.map(Some)
    }

    /// A camera that shows the worst place of a gate, from where nothing hides it.
    ///
    /// # Errors
    /// The device was lost.
    fn standpoint(&mut self, spot: &Spot) -> Result<Camera, GpuError> {
        let viewport = self.target.viewport();
        let standpoints = Standpoints::new(spot, &self.view.camera, viewport, &self.scene.bounds);
        let Some((at, eyes, near)) = standpoints.lines(|camera| camera) else { return Ok(standpoints.clearest(&[])) };
        let mut sight = Sight::new(at, eyes, near);
        self.engine.visit(&mut self.scene, &mut [&mut sight])?;
        Ok(standpoints.clearest(sight.clear()))
    }
}
