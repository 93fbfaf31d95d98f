//! How cost grows: twice the patches, twice the factors, twice the output.

use pnaen::engine::Engine;
use pnaen::tessellate::Partitioning::FractionalOdd;

use super::peer::Peer;
use super::subjects::{self, Factors};
use super::versus::{BenchError, Versus};
use super::{Scale, TRIANGLES_A_PATCH};

/// The base of all growth, and then one thing doubled at a time.
pub const STEPS: [&str; 4] = ["as it is", "patches x 2", "factors x 2", "output x 2"];

/// One for each of [`STEPS`], from the smaller size that is compared.
///
/// # Errors
/// A device was lost, or has no memory.
pub fn measure(engine: &Engine, peer: Option<&Peer>, scale: &Scale) -> Result<Vec<Versus>, BenchError> {
    let triangles = scale.triangles[1];
    let columns = subjects::columns(triangles / TRIANGLES_A_PATCH);
    // Patches are the square of the columns.
    let more_columns = ((columns as f64 * 2f64.sqrt() / 2.0).round() * 2.0) as usize;
    let factors = Factors::ByDistance(FractionalOdd);
    let subject = |columns| subjects::subject(engine, subjects::tori(columns, 1), scale.size, scale.arena_bytes);
    let mut base = subject(columns)?;
    let found = factors.take_for(engine, &mut base, triangles)?;
    let greatest = base.settings.factor;
    let mut all = vec![Versus::measure(engine, peer, &mut base, scale.effort)?];
    let mut finer = subject(more_columns)?;
    factors.take(engine, &mut finer, greatest)?;
    all.push(Versus::measure(engine, peer, &mut finer, scale.effort)?);
    drop(finer);
    factors.take(engine, &mut base, 2.0 * greatest)?;
    all.push(Versus::measure(engine, peer, &mut base, scale.effort)?);
    factors.take_for(engine, &mut base, 2 * found)?;
    all.push(Versus::measure(engine, peer, &mut base, scale.effort)?);
    Ok(all)
}
