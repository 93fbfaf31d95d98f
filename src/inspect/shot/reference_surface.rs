//! The stats of the distance to the surface that a picture is compared with.

use serde::Serialize;

use crate::measure::{Accuracy, Angles, DeviationField, Distances, Rms, WorstPoint};
use crate::reference_shape::ReferenceShape;
use crate::render::Scale;
use geometry::near::Interval;

/// The distance of everything that was emitted from the reference surface.
#[derive(Debug, Serialize)]
pub(super) struct AccuracyStats {
    reference_surface: String,
    /// The diagonal of the reference surface's bounding box, in object units.
    diagonal: f64,
    /// How far the last refinement moved a reference surface that is a refined cage at most, in object units; none for others.
    reference_step: Option<f64>,
    /// From what was emitted to the nearest points of the reference surface.
    to_reference: DistanceStats,
    /// From the reference surface to the nearest points of what was emitted; none if patches were left out, or too many
    /// triangles were emitted to keep them.
    from_reference: Option<DistanceStats>,
    /// The largest distance on screen, in px, of the samples and the worst place; none if none of these is in view.
    max_px: Option<f64>,
    /// Between shading normals and those of the reference surface, in degrees; the largest one of the samples.
    normals: Angles,
    /// The number of points that means and angles were sampled at.
    samples: u64,
}

/// In object units, and as parts of the reference surface's diagonal. The largest distance lies between two numbers for
/// certain; the root mean square has a standard error.
#[derive(Debug, Serialize)]
struct DistanceStats {
    max: Interval,
    rms: Rms,
    max_of_diagonal: Interval,
    rms_of_diagonal: Rms,
    /// Where the lower end of the largest distance was found.
    worst: WorstPoint,
}

impl AccuracyStats {
    /// `is_whole` says that no patch was left out.
    pub(super) fn new(name: &str, shape: &ReferenceShape, accuracy: &Accuracy, is_whole: bool) -> Self {
        let distances = |distances: Distances, worst: WorstPoint| {
            let (Distances { largest: max, rms }, relative) = (distances, accuracy.relative(distances));
            let (max_of_diagonal, rms_of_diagonal) = (relative.largest, relative.rms);
            DistanceStats { max, rms, max_of_diagonal, rms_of_diagonal, worst }
        };
        let from_reference = accuracy.from_reference.filter(|_| is_whole);
        Self {
            reference_surface: name.to_owned(),
            diagonal: accuracy.diagonal,
            reference_step: shape.step,
            to_reference: distances(accuracy.to_reference, accuracy.worst_to_reference),
            from_reference: from_reference.map(|(from, worst)| distances(from, worst)),
            max_px: accuracy.worst_px.map(|worst| worst.value),
            normals: accuracy.normals,
            samples: accuracy.samples,
        }
    }
}

/// What the deviation overlay shows, in object units.
#[derive(Debug, Serialize)]
pub(super) struct DeviationStats {
    /// The largest distance; its upper end is none where distances go to a limit surface, which are sampled.
    max: Interval,
    rms: f64,
    /// The distances of the first and the last colour, if distances are in object units; the scale is logarithmic.
    scale: [f32; 2],
    /// None if nothing was emitted.
    worst: Option<WorstPoint>,
    /// Triangles without a colour, because there were too many.
    triangles_left_out: u64,
}

impl DeviationStats {
    pub(super) fn new(field: &DeviationField, scale: Scale) -> Self {
        let (max, worst) = (field.largest(), field.worst());
        Self { max, rms: field.rms(), scale: [scale.least, scale.most], worst, triangles_left_out: field.left_out }
    }
}
