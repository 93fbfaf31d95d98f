//! Factors from a file in place of those of LOD, and where they disagree.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::background_job::BackgroundJob;
use super::own_shader_job::{OpenShader, new_generation};
use crate::app::App;
use geometry::mesh::Topology;
use geometry::names::shown_path;
use geometry::tessellate::{Convention, HullFactors, Lod, Partitioning};
use gpu::{Given, GpuError, LodShader};
use inspect::engine::Loaded;
use inspect::measure::Agreement;
use inspect::settings::SplitSide;
use inspect::shot::read_factors;

/// Factors that a file has for each patch of the mesh that is open.
pub(crate) struct GivenFactors {
    pub path: PathBuf,
    /// A number of its own for each, from 1 on.
    pub generation: u64,
    factors: Arc<Vec<HullFactors>>,
    partitioning: Partitioning,
    /// None while they are compared under another convention than before.
    compared: Option<ComparedFactors>,
    /// The LOD before.
    pub lod: Lod,
}

/// Where factors of a file disagree under a convention.
pub(crate) struct ComparedFactors {
    convention: Convention,
    pub agreement: Agreement,
}

/// Reading a file of factors, or comparing its factors under another convention.
pub(crate) struct FactorsJob {
    path: PathBuf,
    job: BackgroundJob<Result<Read, String>>,
}

/// What the job's thread sends.
struct Read {
    factors: Arc<Vec<HullFactors>>,
    partitioning: Partitioning,
    compared: ComparedFactors,
}

impl GivenFactors {
    /// The file's name.
    pub(crate) fn name(&self) -> String {
        shown_path(Path::new(self.path.file_name().unwrap_or_default()))
    }

    pub(crate) fn compared(&self) -> Option<&ComparedFactors> {
        self.compared.as_ref()
    }
}

impl FactorsJob {
    /// Lets the job repaint another window when it ends.
    pub(crate) fn waking(self, context: &egui::Context) -> Self {
        Self { job: self.job.waking(context), ..self }
    }
}

fn compare(topology: &Topology, factors: &[HullFactors], convention: Convention) -> ComparedFactors {
    ComparedFactors { convention, agreement: Agreement::of(topology, factors, convention) }
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
        // A dash would be standard input, and the copied command needs the whole path.
        let path = std::path::absolute(&path).unwrap_or(path);
        let own = self.settings.tessellation;
        let (wanted, partitioning) = (path.clone(), own.partitioning);
        let read = move || {
            let factors = read_factors(&wanted, &mesh, &topology, partitioning).map_err(|error| error.to_string())?;
            let compared = compare(&topology, &factors, own.convention);
            Ok(Read { factors: Arc::new(factors), partitioning, compared })
        };
        self.jobs.factors = Some(FactorsJob { path, job: BackgroundJob::start(context, read) });
    }

    /// The file that factors were read from, if one was.
    pub fn factors_file(&self) -> Option<&Path> {
        self.given.as_ref().map(|given| &*given.path)
    }

    /// Puts the file's factors in the place of an LOD that was set while they are used.
    pub(in crate::app) fn replace_by_factors(&mut self) {
        if let Some(given) = &mut self.given {
            given.lod = std::mem::replace(&mut self.settings.tessellation.lod, Lod::Uniform);
        }
    }

    /// Goes back to the factors of LOD.
    pub(in crate::app) fn forget_factors(&mut self) {
        self.jobs.factors = None;
        if let Some(given) = self.given.take() {
            self.settings.tessellation.lod = given.lod;
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

    /// Takes factors that were read, and compares them anew if the convention has changed.
    pub(in crate::app) fn take_factors(&mut self, context: &egui::Context) {
        if let Some(ended) = self.jobs.factors.as_ref().and_then(|factors| factors.job.take())
            && let Some(FactorsJob { path, .. }) = self.jobs.factors.take()
        {
            match ended.unwrap_or_else(|stopped| Err(format!("reading {} {stopped}", shown_path(&path)))) {
                Ok(read) => self.take_read(path, read),
                Err(why) => self.dialogs.error = Some(why),
            }
        }
        self.compare_again(context);
    }

    fn take_read(&mut self, path: PathBuf, Read { factors, partitioning, compared }: Read) {
        self.forget_shader::<LodShader>();
        let same = self.given.take().filter(|given| Arc::ptr_eq(&given.factors, &factors));
        let lod = same.as_ref().map_or(self.settings.tessellation.lod, |given| given.lod);
        let generation = same.map_or_else(new_generation, |given| given.generation);
        // The file's factors take LOD's place: nothing follows the view.
        self.settings.tessellation.lod = Lod::Uniform;
        self.given = Some(GivenFactors { path, generation, factors, partitioning, compared: Some(compared), lod });
    }

    fn compare_again(&mut self, context: &egui::Context) {
        let own = self.settings.tessellation;
        let Some((given, document)) = self.given.as_mut().zip(self.document.as_ref()) else { return };
        if self.jobs.factors.is_some() {
            return;
        }
        if !are_alike(given.partitioning, own.partitioning) {
            let path = given.path.clone();
            self.forget_factors();
            return self.open_factors(context, path);
        }
        if given.compared.as_ref().is_none_or(|compared| compared.convention == own.convention) {
            return;
        }
        given.compared = None;
        let (factors, topology) = (given.factors.clone(), document.loaded.topology.clone());
        let (path, partitioning) = (given.path.clone(), given.partitioning);
        let again = move || {
            let compared = compare(&topology, &factors, own.convention);
            Ok(Read { factors, partitioning, compared })
        };
        self.jobs.factors = Some(FactorsJob { path, job: BackgroundJob::start(context, again) });
    }

    /// The number of what takes the place of LOD: functions of the user's own, or a file; 0 for LOD.
    pub(in crate::app) fn given_wanted(&self) -> u64 {
        let shader = self.lod_shader.as_ref().filter(|_| self.uses_lod_shader()).and_then(OpenShader::shader);
        let of_file = self.given.as_ref().map_or(0, |given| given.generation);
        shader.map_or(of_file, |(_, generation)| generation)
    }

    /// Gives the scenes the factors of the file or the functions of the user's own, or takes them back, while no picture is under way. Returns the number of those
    /// that the picture has; 0 for those of LOD.
    ///
    /// # Errors
    /// More patches than the adapter binds memory for.
    pub(in crate::app) fn give_factors(&mut self) -> Result<u64, GpuError> {
        let shader = self.lod_shader.as_ref().filter(|_| self.uses_lod_shader()).and_then(OpenShader::shader);
        let wanted = self.given_wanted();
        let Some(document) = &mut self.document else { return Ok(0) };
        if document.given != wanted && self.viewport.picture.is_free() && self.viewport.left.is_made() {
            let file = self.given.as_ref().map(|given| Given::Factors(given.factors.to_vec()));
            let given = shader.map(|(shader, _)| Given::Shader(shader)).or(file);
            for half in SplitSide::BOTH {
                if let Some(scene) = document.scene.half_mut(half) {
                    scene.tessellator.give(given.clone())?;
                }
            }
            document.given = wanted;
        }
        Ok(document.given)
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
