//! Times the passes.

use std::time::{Duration, Instant};

use super::Engine;
use crate::render::{Camera, Scene, Target};
use crate::settings::Settings;
use geometry::defaults::with_defaults;
use geometry::tessellate::LodView;
use gpu::{GpuError, PassTime, Timing, take_times};

with_defaults! {
    /// How many times something is timed: as many as fit into `within`, but at least `least` and at most `most`. By default that
    /// is enough for one picture, without a long wait.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Runs {
        pub least: u32 = 1,
        pub most: u32 = 5,
        pub within: Duration = Duration::from_secs(2),
    }
}

impl Engine {
    /// Times complete recomputations of a picture, tessellated for a view, which may be another camera's. The first, which warms up,
    /// doesn't count. Returns each pass's median in ms.
    ///
    /// # Errors
    /// The device was lost.
    pub fn time(
        &self,
        scene: &mut Scene,
        target: &Target,
        camera: &Camera,
        view: LodView,
        settings: &Settings,
        runs: Runs,
    ) -> Result<Vec<PassTime>, GpuError> {
        let mut timing = Timing::on(&self.gpu);
        let mut all: Vec<Vec<PassTime>> = Vec::new();
        let start = Instant::now();
        for run in 0..=runs.most {
            if run > runs.least && start.elapsed() > runs.within {
                break;
            }
            scene.tessellator.forget();
            self.draw_seen(scene, target, camera, view, settings, &mut timing)?;
            self.gpu.wait();
            let times = take_times(&self.gpu, &mut timing);
            if run > 0 {
                all.push(times);
            }
        }
        Ok(medians(&all))
    }
}

/// The median of each pass over runs that all have the same passes.
fn medians(runs: &[Vec<PassTime>]) -> Vec<PassTime> {
    let Some(first) = runs.first() else { return Vec::new() };
    let median = |pass: &'static str| {
        let mut ms: Vec<f64> = runs.iter().flatten().filter(|time| time.pass == pass).map(|time| time.ms).collect();
        ms.sort_by(f64::total_cmp);
        PassTime { pass, ms: ms[ms.len() / 2] }
    };
    first.iter().map(|time| median(time.pass)).collect()
}
