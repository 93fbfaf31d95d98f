//! The mesh that is open, with all that belongs to it and goes with it.

mod halves;
pub(super) mod loading;

use std::sync::Arc;

use super::jobs::companion_files::new_generation;
use super::jobs::deviation_job::DeviationJob;
use super::jobs::explain_job::Explanation;
use super::jobs::file_watch::Stamped;
use super::jobs::folder_job::Neighbours;
use super::jobs::given::FromFiles;
use super::jobs::job_list::Kept;
use super::jobs::leak_job::LeakJob;
use super::jobs::measure_job::MeasureJob;
use super::jobs::mesh_checks::Checks;
use super::jobs::silhouette_job::SilhouetteJob;
use super::jobs::stand_in::StandIn;
use super::panels::clip_moments::ClipMoments;
use super::panels::destinations::ShownFinding;
use super::viewport::highlight::Highlight;
use super::viewport::place::Showing;
use super::viewport::selection::Selection;
use geometry::mesh::{EdgeCounts, Moment};
use geometry::tessellate::Deformed;
use inspect::engine::Loaded;
use inspect::reference_shape::ReferenceShape;
use inspect::render::Scene;
use inspect::settings::SplitSide;

pub(crate) struct Document {
    pub loaded: Loaded,
    pub scene: Scene,
    /// What it was read from.
    pub files: Stamped,
    /// Whether it was loaded because it had changed on disk.
    pub has_changed: bool,
    /// The mesh before its file changed.
    pub before: Option<Arc<Kept>>,
    /// How often its file has changed.
    pub version: u64,
    pub neighbours: Option<Neighbours>,
    pub edges: EdgeCounts,
    /// The moment whose pose the scene has; none at rest.
    pub moment: Option<Moment>,
    /// What the scene has of files.
    pub from_files: FromFiles,
    pub checks: Arc<Checks>,
    /// What previews draw in place of a large mesh.
    pub stand_in: StandIn,
    /// The bounding diagonal at rest, in object units.
    pub diagonal: f32,
    /// See [`Mesh::has_texture_coordinates`](geometry::mesh::Mesh::has_texture_coordinates).
    pub has_texture_coordinates: bool,
    /// The exact surface, if the mesh is a shape that has one.
    pub exact: Option<Arc<ReferenceShape>>,
    /// A number of its own for each document, even if the same file is loaded again.
    pub generation: u64,
    /// What is measured of the left and of the right half of the view.
    pub halves: [Measurements; 2],
    pub leaks: LeakJob,
    pub silhouette: SilhouetteJob,
    pub explanation: Explanation,
    /// What was found in the clip that was measured last.
    pub clip_moments: Option<ClipMoments>,
    pub selection: Selection,
    pub shown_finding: Option<ShownFinding>,
    /// The place that is about to be shown.
    pub showing: Option<Showing>,
    /// What the lines over the mesh were last made from.
    pub highlight: Option<Highlight>,
    /// Counts the scenes that were made for the left half.
    pub left_made: u64,
    /// The number of the mesh there; 0 for this one.
    pub left_of: u64,
}

/// What is measured of a half of the view.
#[derive(Default)]
pub(crate) struct Measurements {
    pub measure: MeasureJob,
    pub deviation: DeviationJob,
}

impl Measurements {
    /// Forgets the measurements of a scene that no longer exists.
    pub(crate) fn forget(&mut self) {
        self.measure.forget();
        self.deviation.forget();
    }
}

impl Document {
    fn new(loaded: Loaded, scene: Scene, files: Stamped) -> Self {
        let exact = loaded.source.shape().and_then(ReferenceShape::from_shape).map(Arc::new);
        Self {
            files,
            has_changed: false,
            before: None,
            version: 0,
            neighbours: None,
            edges: loaded.topology.edge_counts(),
            moment: None,
            from_files: FromFiles::default(),
            checks: Arc::default(),
            stand_in: StandIn::default(),
            diagonal: scene.bounds.diagonal(),
            has_texture_coordinates: loaded.mesh.has_texture_coordinates(),
            exact,
            generation: new_generation(),
            halves: Default::default(),
            leaks: LeakJob::default(),
            silhouette: SilhouetteJob::default(),
            explanation: None,
            clip_moments: None,
            selection: Selection::default(),
            shown_finding: None,
            showing: None,
            highlight: None,
            left_made: 0,
            left_of: 0,
            loaded,
            scene,
        }
    }

    /// The mesh as it is now.
    pub(crate) fn kept(&self) -> Arc<Kept> {
        Arc::new(Kept { loaded: self.loaded.clone(), version: self.version })
    }

    /// What is measured of the right half, or of the whole view.
    pub(crate) fn right(&self) -> &Measurements {
        &self.halves[SplitSide::Right as usize]
    }

    /// Takes a scene on another device, for which everything is measured and made anew. What is selected stays.
    pub(in crate::app) fn move_to(&mut self, scene: Scene) {
        (self.scene, self.moment, self.stand_in) = (scene, None, StandIn::default());
        self.from_files = FromFiles::default();
        self.halves.iter_mut().for_each(Measurements::forget);
        (self.leaks, self.silhouette) = (LeakJob::default(), SilhouetteJob::default());
        self.highlight = None;
        self.selection.forget_tessellation();
    }

    /// Whether something of what is shown is being measured or found.
    pub(crate) fn is_busy(&self) -> bool {
        self.halves.iter().any(|half| half.measure.is_busy() || half.deviation.is_busy())
            || self.leaks.is_busy()
            || self.silhouette.is_busy()
            || self.selection.is_busy()
            || self.showing.is_some()
    }

    /// Stops all measurements. They aren't started again by themselves.
    pub(crate) fn give_up_measuring(&mut self) {
        for Measurements { measure, deviation } in &mut self.halves {
            measure.give_up();
            deviation.give_up();
        }
        self.leaks.give_up();
        self.silhouette.give_up();
    }

    /// The mesh and its topology in the pose that is shown; at rest as long as that pose isn't known on the CPU.
    pub(crate) fn shown(&self) -> Deformed {
        self.posed().unwrap_or_else(|| (self.loaded.mesh.clone(), self.loaded.topology.clone()))
    }

    /// The corners of a patch of the mesh in a half, in the pose that is shown.
    pub(crate) fn patch_positions(&self, half: SplitSide, patch: u32) -> [glam::Vec3; 3] {
        match self.scene.half(half).filter(|_| !self.scene.shares_pose(half)) {
            Some(other) => other.tessellator.posed().deformed().1.patch_positions(patch),
            None => self.shown().1.patch_positions(patch),
        }
    }

    /// The mesh and its topology in the pose that is shown; none as long as that pose isn't known on the CPU.
    pub(crate) fn posed(&self) -> Option<Deformed> {
        self.scene.tessellator.posed().deformed_if_quick()
    }

    /// Bytes on the device: topology and output, of both halves of a split view.
    pub(crate) fn bytes(&self) -> u64 {
        let of = |own: &Scene| own.tessellator.buffers().bytes() + own.work_bytes() + own.tessellator.arena_bytes();
        SplitSide::BOTH.into_iter().filter_map(|half| self.scene.half(half)).map(of).sum()
    }
}
