//! Checks of a mesh that run on a thread of their own once it is loaded: bad normals, T-junctions,
//! what gates of the mesh find, and edges that nearly meet.

use std::sync::{Arc, OnceLock};

use super::job_list::Work;
use crate::app::App;
use geometry::mesh::{NormalFaults, TJunction, WeldPreview, t_junctions, weld_previews};
use geometry::progress::Progress;
use inspect::gates::{Judgement, found_in_mesh};

/// What the checks of a mesh have found so far.
#[derive(Default)]
pub(crate) struct Checks {
    /// Normals that are legal but suspicious.
    pub normal_faults: OnceLock<NormalFaults>,
    t_junctions: OnceLock<Vec<TJunction>>,
    found: OnceLock<Vec<Judgement>>,
    /// What each weld tolerance would join.
    pub joins: OnceLock<Vec<WeldPreview>>,
}

impl Checks {
    pub(crate) fn t_junctions(&self) -> Option<&[TJunction]> {
        self.t_junctions.get().map(Vec::as_slice)
    }

    /// What the gates of the mesh find in it; nothing until they are judged.
    pub(crate) fn found(&self) -> &[Judgement] {
        self.found.get().map(Vec::as_slice).unwrap_or_default()
    }
}

impl App {
    /// Starts the checks of the mesh that is open. Each result repaints the window.
    pub(in crate::app) fn check_mesh(&mut self, context: &egui::Context) {
        let Some(document) = &self.document else { return };
        let loaded = &document.loaded;
        let (read, mesh, topology) = (loaded.read.clone(), loaded.mesh.clone(), loaded.topology.clone());
        let (weld, found, repainted) = (loaded.preparation.weld, document.checks.clone(), context.clone());
        let check = move |wanted: &Progress| {
            let _ = found.normal_faults.set(NormalFaults::new(&mesh, &topology));
            if let Ok(all) = t_junctions(&topology, wanted) {
                let _ = found.t_junctions.set(all);
            }
            repainted.request_repaint();
            let _ = found.found.set(found_in_mesh(&mesh, &topology));
            repainted.request_repaint();
            let exact = (weld == 0.0 && Arc::ptr_eq(&read, &mesh)).then_some(&*topology);
            if let Ok(all) = weld_previews(&read, exact, wanted) {
                let _ = found.joins.set(all);
            }
        };
        self.jobs.start(context, Work::Checks, String::new(), check, |app, _, ended| {
            if let Err(stopped) = ended {
                app.dialogs.error = Some(format!("checking the mesh {stopped}; what it found until then is shown"));
            }
        });
    }
}
