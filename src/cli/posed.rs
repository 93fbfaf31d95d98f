//! A mesh in its pose, ready to be tessellated as a command's options say.

use std::path::Path;

use super::view_files::View;
use super::{CliError, SurfaceOptions, load_apart};
use geometry::mesh::{Bounds, Moment};
use geometry::tessellate::{self, HullFactors, Inputs, LodView, Tessellated, bounds_through};
use inspect::engine::Loaded;
use inspect::render::Camera;
use inspect::settings::Settings;
use load::Source;

pub(super) struct Posed<'a> {
    pub surface: &'a SurfaceOptions,
    /// At rest, and in the pose that is tessellated.
    pub loaded: Loaded,
    pub posed: Loaded,
    pub moment: Option<Moment>,
    /// Of the mesh through its clip.
    pub bounds: Bounds,
}

impl<'a> Posed<'a> {
    /// Loads a mesh. None of the files to be `written` may be one that its file refers to.
    pub(super) fn load(
        surface: &'a SurfaceOptions,
        file: &Source,
        written: &[Option<&Path>],
    ) -> Result<Self, CliError> {
        let loaded = load_apart(file, &surface.preparation(), written)?;
        let moment = surface.moment(&loaded)?;
        let bounds = bounds_through(&loaded.mesh, moment.map(|moment| moment.clip));
        Ok(Self { surface, posed: loaded.posed(moment), loaded, moment, bounds })
    }

    pub(super) fn camera(&self, view: &View) -> Result<Camera, CliError> {
        view.camera(self.surface, (&self.posed.mesh, self.moment, &self.bounds), self.surface.viewport())
    }

    /// What LOD and clipping are computed for.
    pub(super) fn lod_view(&self, camera: &Camera) -> LodView {
        camera.lod_view(self.surface.viewport(), &self.bounds)
    }

    /// What the CPU tessellates with, within the budget of triangles.
    pub(super) fn inputs(&self, view: LodView) -> Result<Inputs, CliError> {
        let Loaded { mesh, topology, .. } = &self.posed;
        let count = |settings: &Settings| Ok(tessellate::totals(mesh, topology, &settings.inputs(view)).1);
        Ok(self.surface.within_budget(count)?.inputs(view))
    }

    /// Tessellates on the CPU, once `check` has taken the numbers of vertices and triangles.
    pub(super) fn tessellated(
        &self,
        inputs: &Inputs,
        given: Option<&[HullFactors]>,
        check: impl FnOnce(u64, u64) -> Result<(), CliError>,
    ) -> Result<Tessellated, CliError> {
        let Loaded { mesh, topology, .. } = &self.posed;
        let (vertices, triangles) = match given {
            Some(given) => tessellate::given_totals(given, inputs),
            None => tessellate::totals(mesh, topology, inputs),
        };
        check(vertices, triangles)?;
        Ok(match given {
            Some(given) => tessellate::tessellate_given(mesh, topology, inputs, given),
            None => tessellate::tessellate(mesh, topology, inputs, None),
        })
    }
}
