//! The option `--reference-surface`, a reference surface, and the stats of the distance to it.

use std::sync::Arc;

use clap::Args;

use super::{CliError, SurfaceOptions, options, refuse};
use geometry::choice::Choice;
use inspect::engine::Loaded;
use inspect::reference_shape::ReferenceShape;
use inspect::shot::ReferenceSurface;
use load::Source;
use load::import::Subdivide;

#[derive(Clone, Debug, Default, Args)]
pub struct ReferenceSurfaceOption {
    /// Reference surface for the deviation overlay and the stats: a mesh file, such as the high-poly original, or a shape. By default the exact surface of a shape; for other meshes the overlay
    /// takes the surface that the tessellation converges to
    #[arg(long = "reference-surface", value_name = "FILE", value_parser = options::source())]
    pub reference_shape: Option<Source>,
    /// Take the polygons of the reference surface's file as the cage of a subdivision surface, and compare with the limit of that
    #[arg(long, value_name = "SCHEME", value_parser = options::choice::<Subdivide>(), default_value = Subdivide::File.name(), requires = "reference_shape")]
    pub reference_subdivide: Subdivide,
}

impl ReferenceSurfaceOption {
    /// The surface to compare with: that of `--reference-surface`, or if the overlay is shown the exact surface or the limit surface.
    pub(crate) fn reference_surface(
        &self,
        loaded: &Loaded,
        surface: &SurfaceOptions,
        is_shown: bool,
    ) -> Result<Option<ReferenceSurface>, CliError> {
        let moves = surface.animation.is_some();
        if let Some(source) = &self.reference_shape {
            refuse(
                moves,
                "--reference-surface can't be combined with --animation: the reference surface doesn't move",
            )?;
            let reference_shape = surface.weld.reference_shape(source, self.reference_subdivide)?;
            return Ok(Some(ReferenceSurface::ReferenceShape(source.to_string(), Arc::new(reference_shape))));
        }
        if !is_shown {
            return Ok(None);
        }
        let is_plain = !moves && !surface.tessellation().displacement.is_on();
        let exact = loaded.source.shape().filter(|_| is_plain).and_then(ReferenceShape::from_shape);
        let found = exact.map(|reference_shape| {
            ReferenceSurface::ReferenceShape(loaded.source.to_string(), Arc::new(reference_shape))
        });
        Ok(Some(found.unwrap_or(ReferenceSurface::Limit)))
    }
}
