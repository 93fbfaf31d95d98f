//! The part of stats about outlines.

use serde::Serialize;

use crate::measure::{OutlineDistance, Silhouette};

/// The largest distances of the triangles' outline from others, in px; none where the picture doesn't show both outlines. Places
/// are in px from the picture's top left.
#[derive(Debug, Serialize)]
pub(super) struct SilhouetteStats {
    from_source_px: Option<f64>,
    from_source_at: Option<[f64; 2]>,
    from_surface_px: Option<f64>,
    from_surface_at: Option<[f64; 2]>,
    /// Samples along a side of a px.
    samples_per_px: u32,
}

impl SilhouetteStats {
    /// `mirrored` is the width of the picture in px if it was mirrored after the outlines were found.
    pub(super) fn new(silhouette: &Silhouette, mirrored: Option<u32>) -> Self {
        let shown = |[x, y]: [f64; 2]| [mirrored.map_or(x, |width| f64::from(width) - x), y];
        let place = |distance: Option<OutlineDistance>| distance.map(|distance| shown(distance.at.to_array()));
        let distances = &silhouette.distances;
        Self {
            from_source_px: distances.from_source.map(|distance| distance.px),
            from_source_at: place(distances.from_source),
            from_surface_px: distances.from_surface.map(|distance| distance.px),
            from_surface_at: place(distances.from_surface),
            samples_per_px: silhouette.grid.per_px,
        }
    }
}
