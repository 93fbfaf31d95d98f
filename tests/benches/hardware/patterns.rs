//! The emission of rows beside that of rings, which Direct3D's integer partitioning has.

use geometry::tessellate::Partitioning::{Integer, Rows};
use inspect::engine::Engine;

use super::Scale;
use super::numbers::{ratio, table, whole};
use super::subjects::{self, Factors};
use super::versus::{BenchError, Versus};

/// The factors of all edges: of patches that share a workgroup, of patches that fill a few, and of the largest there are.
const FACTORS: [f32; 3] = [8.0, 16.0, 64.0];

/// The same mesh and factor under both patterns.
pub(crate) struct Pair {
    name: String,
    rings: Versus,
    rows: Versus,
}

/// Measures both patterns with each factor, on meshes that have about as many triangles each time.
///
/// # Errors
/// A device was lost, or has no memory.
pub(crate) fn measure(engine: &Engine, scale: &Scale) -> Result<Vec<Pair>, BenchError> {
    let pair = |factor: f32| {
        // A patch has about as many triangles as the square of its factor.
        let patches = (scale.triangles[1] as f64 / f64::from(factor * factor)) as u64;
        let mesh = || subjects::tori(subjects::columns(patches), 1);
        let versus = |partitioning| {
            let mut subject = subjects::subject(engine, mesh(), scale.size, scale.arena_bytes)?;
            Factors::Uniform(partitioning).take(engine, &mut subject, factor)?;
            Versus::measure(engine, None, &mut subject, scale.effort)
        };
        Ok(Pair { name: format!("{factor}"), rings: versus(Integer)?, rows: versus(Rows)? })
    };
    FACTORS.into_iter().map(pair).collect()
}

/// The time of emission, and of it divided by the number of triangles.
fn emission(versus: &Versus) -> (f64, f64) {
    let ms = versus.ours.passes.iter().find(|time| time.pass == "emit").map_or(0.0, |time| time.ms);
    (ms, ms * 1e9 / versus.triangles.max(1) as f64)
}

/// Returns the table of all pairs.
pub(crate) fn table_of(pairs: &[Pair]) -> String {
    let row = |pair: &Pair| {
        let ((rings_ms, rings_ps), (rows_ms, rows_ps)) = (emission(&pair.rings), emission(&pair.rows));
        vec![
            pair.name.clone(),
            whole(pair.rows.patches.into()),
            whole(pair.rings.triangles),
            whole(pair.rows.triangles),
            format!("{rings_ms:.4}"),
            format!("{rows_ms:.4}"),
            format!("{rings_ps:.1}"),
            format!("{rows_ps:.1}"),
            ratio(rows_ps, rings_ps),
        ]
    };
    let head = "factor | patches | rings, triangles | rows, triangles | rings, ms | rows, ms | rings, ps per triangle \
                | rows, ps per triangle | rows / rings";
    table(head, &pairs.iter().map(row).collect::<Vec<_>>())
}
