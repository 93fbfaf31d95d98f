//! Factors from a file in place of those of LOD, and where they disagree.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::companion_files::{OpenFile, absolute_path};
use super::job_list::Work;
use crate::app::App;
use crate::commands::CompanionFile;
use geometry::names::shown_path;
use geometry::tessellate::{Convention, HullFactors, Lod, Partitioning};
use inspect::engine::Loaded;
use inspect::measure::Agreement;
use inspect::shot::read_factors;

/// Factors that a file has for each patch of the mesh that is open.
pub(crate) struct GivenFactors {
    pub(super) factors: Arc<Vec<HullFactors>>,
    partitioning: Partitioning,
    /// Where they disagree under a convention; none while they are compared under another one than before.
    pub compared: Option<(Convention, Agreement)>,
    /// The LOD before.
    pub lod: Lod,
}

/// Whether the columns of a file that was read for one partitioning say the same under another.
fn are_alike(before: Partitioning, now: Partitioning) -> bool {
    use Partitioning::{Rows, Subtriangulation};
    before == now || ![before, now].iter().any(|partitioning| matches!(partitioning, Rows | Subtriangulation))
}

impl App {
    /// Starts to read a file of factors, which take the place of those of LOD. Until they are read, all stays as it is.
    pub fn open_factors(&mut self, context: &egui::Context, path: PathBuf) {
        let Some(document) = &self.document else { return };
        let Loaded { mesh, topology, .. } = &document.loaded;
        let (mesh, topology) = (mesh.clone(), topology.clone());
        let path = absolute_path(path);
        let own = self.settings.tessellation;
        let (wanted, partitioning) = (path.clone(), own.partitioning);
        let read = move |_: &_| {
            let factors = read_factors(&wanted, &mesh, &topology, partitioning).map_err(|error| error.to_string())?;
            let agreement = Agreement::new(&topology, &factors, own.convention);
            Ok((Arc::new(factors), (own.convention, agreement)))
        };
        let what = shown_path(&path);
        let take = move |app: &mut Self, (factors, compared)| {
            app.close_companion(CompanionFile::LodShader);
            // The file's factors take LOD's place: nothing follows the view.
            let lod = std::mem::replace(&mut app.settings.tessellation.lod, Lod::Uniform);
            let lod = app.given.as_ref().map_or(lod, |given| given.content.lod);
            let given = GivenFactors { factors, partitioning, compared: Some(compared), lod };
            app.given = Some(OpenFile::new(path, given));
        };
        self.read_companion(context, CompanionFile::Factors, String::new(), what, read, take);
    }

    pub fn factors_file(&self) -> Option<&Path> {
        self.given.as_ref().map(|given| &*given.from)
    }

    /// Puts the file's factors in the place of an LOD that was set while they are used.
    pub(in crate::app) fn replace_by_factors(&mut self) {
        if let Some(given) = &mut self.given {
            given.content.lod = std::mem::replace(&mut self.settings.tessellation.lod, Lod::Uniform);
        }
    }

    /// Goes back to the factors of LOD.
    pub(in crate::app) fn forget_factors(&mut self) {
        self.jobs.stop(Work::Companion(CompanionFile::Factors));
        if let Some(given) = self.given.take() {
            self.settings.tessellation.lod = given.content.lod;
        }
    }

    /// Reads the file again for a mesh that was loaded again.
    pub(in crate::app) fn keep_factors(&mut self, context: &egui::Context, keeps: bool) {
        let Some(path) = self.factors_file().map(Path::to_owned) else { return };
        self.forget_factors();
        if keeps {
            self.open_factors(context, path);
        }
    }

    /// Compares factors anew if the convention has changed, or reads their file anew if the partitioning reads it in another way.
    pub(in crate::app) fn compare_again(&mut self, context: &egui::Context) {
        let own = self.settings.tessellation;
        let Some((given, document)) = self.given.as_mut().zip(self.document.as_ref()) else { return };
        if self.jobs.has(Work::Companion(CompanionFile::Factors)) {
            return;
        }
        let path = given.from.clone();
        if !are_alike(given.content.partitioning, own.partitioning) {
            self.forget_factors();
            return self.open_factors(context, path);
        }
        if given.content.compared.as_ref().is_none_or(|(of, _)| *of == own.convention) {
            return;
        }
        given.content.compared = None;
        let (factors, topology) = (given.content.factors.clone(), document.loaded.topology.clone());
        let compare = move |_: &_| Ok((own.convention, Agreement::new(&topology, &factors, own.convention)));
        let take = |app: &mut Self, compared| {
            if let Some(given) = &mut app.given {
                given.content.compared = Some(compared);
            }
        };
        self.read_companion(context, CompanionFile::Factors, String::new(), shown_path(&path), compare, take);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_rows_and_subtriangulation_read_a_file_in_ways_of_their_own() {
        use Partitioning::{FractionalEven, FractionalOdd, Integer, Pow2, Rows, Subtriangulation};
        for (before, now) in [(Integer, Pow2), (FractionalOdd, FractionalEven), (Rows, Rows)] {
            assert!(are_alike(before, now), "{before:?} {now:?}");
        }
        for (before, now) in [(Integer, Rows), (Rows, Pow2), (Subtriangulation, Integer), (Integer, Subtriangulation)] {
            assert!(!are_alike(before, now), "{before:?} {now:?}");
        }
    }
}
