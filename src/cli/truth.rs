//! The option `--truth`, a reference surface, and the stats of the distance to it.

use std::sync::Arc;

use clap::Args;

use super::{CliError, SurfaceOptions, options, refuse};
use geometry::progress::Progress;
use inspect::engine::Loaded;
use inspect::shot::ReferenceSurface;
use inspect::truth::Truth;
use load::Source;

#[derive(Clone, Debug, Default, Args)]
pub struct TruthOption {
    /// Reference surface for the deviation overlay and the stats: a .gltf, .glb, .vrm, .fbx, .obj, .stl, .ply, .off or .3mf
    /// file, such as the high-poly original, or a shape. By default the exact surface of a shape; for other meshes the overlay
    /// takes the surface that the tessellation converges to
    #[arg(long, value_name = "FILE", value_parser = options::source())]
    pub truth: Option<Source>,
}

impl TruthOption {
    /// The surface to compare with: that of `--truth`, or if the overlay is shown the exact surface or the limit surface.
    pub(crate) fn reference_surface(
        &self,
        loaded: &Loaded,
        surface: &SurfaceOptions,
        is_shown: bool,
    ) -> Result<Option<ReferenceSurface>, CliError> {
        let moves = surface.animation.animation.is_some();
        if let Some(source) = &self.truth {
            refuse(moves, "--truth can't be combined with --animation: the reference surface doesn't move")?;
            let none = || CliError::NoTruth { file: source.to_string() };
            let truth = Truth::load(source, surface.weld.import.0, &surface.weld.limit.limits(), &Progress::new())?
                .ok_or_else(none)?;
            return Ok(Some(ReferenceSurface::Truth(source.to_string(), Arc::new(truth))));
        }
        if !is_shown {
            return Ok(None);
        }
        let is_plain = !moves && !surface.tessellation().displacement.is_on();
        let exact = loaded.source.shape().filter(|_| is_plain).and_then(Truth::from_shape);
        let found = exact.map(|truth| ReferenceSurface::Truth(loaded.source.to_string(), Arc::new(truth)));
        Ok(Some(found.unwrap_or(ReferenceSurface::Limit)))
    }
}
