//! How cost grows with twice the patches, twice the factors, or twice the output.

use geometry::tessellate::Partitioning::FractionalOdd;
use inspect::engine::Engine;

use super::ours::Subject;
use super::peer::Peer;
use super::rows::Named;
use super::subjects::{self, Factors};
use super::versus::{BenchError, Versus};
use super::{Scale, TRIANGLES_A_PATCH};

/// Measures the smaller of the two sizes, and then each with one quantity doubled.
///
/// # Errors
/// A device was lost, or has no memory.
pub(crate) fn measure(engine: &Engine, peer: Option<&Peer>, scale: &Scale) -> Result<Vec<Named>, BenchError> {
    let triangles = scale.triangles[1];
    let columns = subjects::columns(triangles / TRIANGLES_A_PATCH);
    // Patches are the square of the columns.
    let more_columns = ((columns as f64 * 2f64.sqrt() / 2.0).round() * 2.0) as usize;
    let factors = Factors::ByDistance(FractionalOdd);
    let subject = |columns| subjects::subject(engine, subjects::tori(columns, 1), scale.size, scale.arena_bytes);
    let mut base = subject(columns)?;
    let found = factors.take_for(engine, &mut base, triangles)?;
    let greatest = base.settings.tessellation.factor;
    let mut all = Vec::new();
    let mut time = |name: &str, subject: &mut Subject| {
        let versus = Versus::measure(engine, peer, subject, scale.effort)?;
        all.push((name.to_owned(), versus));
        Ok::<_, BenchError>(())
    };
    time("base", &mut base)?;
    let mut finer = subject(more_columns)?;
    factors.take(engine, &mut finer, greatest)?;
    time("patches x 2", &mut finer)?;
    drop(finer);
    factors.take(engine, &mut base, 2.0 * greatest)?;
    time("factors x 2", &mut base)?;
    factors.take_for(engine, &mut base, 2 * found)?;
    time("output x 2", &mut base)?;
    Ok(all)
}
