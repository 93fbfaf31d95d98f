//! What is found at moments all through a clip, so that its worst moment can be shown.

use super::Engine;
use crate::render::Scene;
use crate::settings::Settings;
use geometry::choice::choices;
use geometry::mesh::Moment;
use geometry::progress::{Cancelled, Progress};
use geometry::tessellate::LodView;
use gpu::{GpuError, Timing};

/// How many moments of a clip are measured at most, and how many a second.
const MOST: f64 = 60.0;
const A_SECOND: f64 = 30.0;

choices! {
    /// What is counted at each moment.
    pub enum ClipFinding {
        Folds => "folds", "folds", "Triangles that face away from the side that their patch faces.";
        Cracks => "cracks", "cracked edges", "Edges whose sides have points at different positions.";
        Triangles => "triangles", "triangles", "Emitted triangles.";
    }
}

/// What was found at a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MomentFound {
    /// In the clip, in s.
    pub time: f64,
    /// In the order of [`ClipFinding::ALL`].
    pub counts: [u64; ClipFinding::ALL.len()],
}

/// The first moment with the most of something.
pub fn worst_moment(found: &[MomentFound], finding: ClipFinding) -> Option<MomentFound> {
    let count = |moment: &MomentFound| moment.counts[finding as usize];
    found.iter().copied().reduce(|worst, next| if count(&next) > count(&worst) { next } else { worst })
}

impl Engine {
    /// Measures moments at nearly equal distances from the start to the end of a clip. The scene is left in the last one's pose.
    ///
    /// # Errors
    /// The mesh's rig needs larger buffers than the adapter can bind, or the device was lost; none if `progress` was cancelled.
    pub fn survey_clip(
        &self,
        scene: &mut Scene,
        settings: &Settings,
        view: LodView,
        clip: usize,
        progress: &Progress,
    ) -> Result<Result<Vec<MomentFound>, Cancelled>, GpuError> {
        let rig = scene.tessellator.mesh().rig.clone();
        let duration = rig.and_then(|rig| rig.clips.get(clip).map(|clip| clip.duration)).unwrap_or_default();
        let last = (A_SECOND * duration).ceil().clamp(1.0, MOST - 1.0) as u32;
        let mut found = Vec::new();
        for frame in 0..=last {
            if let Err(cancelled) = progress.check() {
                return Ok(Err(cancelled));
            }
            // In whole ms, which are what people read and type.
            let time = (1e3 * duration * f64::from(frame) / f64::from(last)).floor() / 1e3;
            scene.set_moment(Some(Moment { clip, time }))?;
            self.count(scene, &settings.inputs(view), &mut Timing::Off)?;
            let measured = self.measure(scene)?;
            let cracked = measured.cracks.cracked().len() as u64;
            found.push(MomentFound { time, counts: [measured.folds, cracked, scene.tessellator.totals().1] });
            progress.set(frame as f32 / last as f32);
        }
        Ok(Ok(found))
    }
}
