//! Checks of a mesh that run on a thread of their own once it is loaded: bad normals, T-junctions, and edges that nearly meet.

use std::sync::{Arc, OnceLock};

use super::background_job::{BackgroundJob, Stopped};
use geometry::mesh::{NormalFaults, TJunction, WeldPreview, t_junctions, weld_previews};
use geometry::progress::Progress;
use inspect::engine::Loaded;

/// The checks of a mesh and their results. Dropping them stops them.
#[derive(Default)]
pub(crate) struct Checks {
    found: Arc<CheckResults>,
    wanted: Progress,
    /// None once it has ended.
    job: Option<BackgroundJob<()>>,
}

#[derive(Default)]
struct CheckResults {
    normal_faults: OnceLock<NormalFaults>,
    t_junctions: OnceLock<Vec<TJunction>>,
    joins: OnceLock<Vec<WeldPreview>>,
}

impl Checks {
    /// Starts the checks on a thread of their own. Each result repaints the window.
    pub(crate) fn start(context: &egui::Context, loaded: &Loaded) -> Self {
        let mut checks = Self::default();
        let (read, mesh, topology) = (loaded.read.clone(), loaded.mesh.clone(), loaded.topology.clone());
        let weld = loaded.preparation.weld;
        let (found, wanted, repainted) = (checks.found.clone(), checks.wanted.clone(), context.clone());
        checks.job = Some(BackgroundJob::start(context, move || {
            let _ = found.normal_faults.set(NormalFaults::of(&mesh, &topology));
            if let Ok(all) = t_junctions(&topology, &wanted) {
                let _ = found.t_junctions.set(all);
            }
            repainted.request_repaint();
            let exact = (weld == 0.0 && Arc::ptr_eq(&read, &mesh)).then_some(&*topology);
            if let Ok(all) = weld_previews(&read, exact, &wanted) {
                let _ = found.joins.set(all);
            }
        }));
        checks
    }

    /// Normals that are legal but suspicious, once counted.
    pub(crate) fn normal_faults(&self) -> Option<&NormalFaults> {
        self.found.normal_faults.get()
    }

    /// All T-junctions, once found.
    pub(crate) fn t_junctions(&self) -> Option<&[TJunction]> {
        self.found.t_junctions.get().map(Vec::as_slice)
    }

    /// What each weld tolerance would join, once known.
    pub(crate) fn joins(&self) -> Option<&[WeldPreview]> {
        self.found.joins.get().map(Vec::as_slice)
    }

    pub(crate) fn is_busy(&self) -> bool {
        self.job.is_some()
    }

    /// Notices the end of the checks. Returns the reason, only once, if they stopped before they were done.
    pub(crate) fn take_stopped(&mut self) -> Option<Stopped> {
        let ended = self.job.as_ref()?.take()?;
        self.job = None;
        ended.err()
    }
}

impl Drop for Checks {
    fn drop(&mut self) {
        self.wanted.cancel();
    }
}
