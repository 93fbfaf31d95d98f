//! Our passes against the driver's tessellation stages, in one run on one device: `cargo bench`.
//!
//! The peer draws the same patches: the control nets that our nets pass computed and the factors that our counts pass
//! took, by a hull shader, the fixed-function tessellator and a domain shader, through Vulkan. Times are medians; on
//! software drivers, whose timestamps are wrong, of whole submissions. It says what it finds and fails for none of it.

mod copy;
mod error;
mod growth;
mod memory;
mod numbers;
mod ours;
mod peer;
mod pipelines;
mod report;
mod rows;
mod subjects;
mod target;
mod versus;
mod vulkan;

use std::process::ExitCode;

use pnaen::internals::ARENA_BYTES;
use pnaen::internals::Engine;
use pnaen::tessellate::Partitioning::{FractionalOdd, Integer};

use copy::Copies;
use ours::Effort;
use peer::Peer;
use report::Report;
use subjects::Factors;
use versus::{BenchError, Versus};

/// How much is asked of a device.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    /// Triangles of the two sizes that are compared.
    pub triangles: [u64; 2],
    /// Of the picture, in px.
    pub size: [u32; 2],
    /// Room for our output: all of it at once.
    pub arena_bytes: u64,
    /// Of each of the two buffers of a copy.
    pub copy_bytes: u64,
    /// Tori along each axis of the field that LODs are compared in.
    pub field: usize,
    pub effort: Effort,
}

impl Scale {
    fn of(engine: &Engine) -> Self {
        let effort = Effort::on(engine);
        if engine.gpu.is_software() {
            let (triangles, size) = ([60_000, 20_000], [320, 180]);
            return Self { triangles, size, arena_bytes: ARENA_BYTES, copy_bytes: 32 << 20, field: 2, effort };
        }
        let (triangles, size) = ([28_000_000, 9_000_000], [1920, 1080]);
        Self { triangles, size, arena_bytes: 2 << 30, copy_bytes: 1 << 30, field: 8, effort }
    }
}

/// Triangles of a patch, about, where factors are 5 to 20, and where they are 10 to 40.
const TRIANGLES_A_PATCH: u64 = 300;
const MORE_TRIANGLES_A_PATCH: u64 = 1_100;
/// And where they are all 63.
const MOST_TRIANGLES_A_PATCH: u64 = 6_000;

const UNIFORM: Factors = Factors::Uniform(FractionalOdd);

fn main() -> ExitCode {
    let result = Engine::headless().map_err(BenchError::from).and_then(|engine| run(&engine));
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(engine: &Engine) -> Result<(), BenchError> {
    let scale = Scale::of(engine);
    let peer = Peer::new(&engine.gpu, scale.size);
    let mut report = Report::begin(engine, &scale, peer.as_ref().err());
    let peer = peer.ok();
    if let Some(peer) = &peer {
        report.copies(Copies::measure(&peer.vulkan, scale.copy_bytes, scale.effort)?);
    }
    for triangles in scale.triangles {
        for factors in
            [Factors::ByDistance(FractionalOdd), Factors::Hashed(FractionalOdd), Factors::ByDistance(Integer), UNIFORM]
        {
            let a_patch = if factors == UNIFORM { MOST_TRIANGLES_A_PATCH } else { TRIANGLES_A_PATCH };
            let patches = triangles / a_patch;
            let versus = compare(engine, peer.as_ref(), &scale, factors, [triangles, patches], scale.arena_bytes)?;
            report.versus(factors.name(), versus);
        }
    }
    let (factors, triangles) = (Factors::ByDistance(FractionalOdd), scale.triangles[0]);
    let larger = [triangles, triangles / MORE_TRIANGLES_A_PATCH];
    let larger = compare(engine, peer.as_ref(), &scale, factors, larger, scale.arena_bytes)?;
    report.versus("fractional, by distance, twice as large", larger);
    let as_before = [triangles, triangles / TRIANGLES_A_PATCH];
    let in_chunks = compare(engine, peer.as_ref(), &scale, factors, as_before, ARENA_BYTES)?;
    report.versus("the same in the window's arena", in_chunks);
    let mut subject = subjects::subject(engine, subjects::tori(16, 1), scale.size, ARENA_BYTES)?;
    report.end_versus(&subject.time_nothing(engine, scale.effort)?);
    report.growth(&growth::measure(engine, peer.as_ref(), &scale)?);
    report.equal_error(&error::measure(engine, peer.as_ref(), &scale)?);
    report.goals();
    Ok(())
}

/// One torus of about so many patches, tessellated to about so many triangles.
fn compare(
    engine: &Engine,
    peer: Option<&Peer>,
    scale: &Scale,
    factors: Factors,
    [triangles, patches]: [u64; 2],
    arena_bytes: u64,
) -> Result<Versus, BenchError> {
    let mesh = subjects::tori(subjects::columns(patches), 1);
    let mut subject = subjects::subject(engine, mesh, scale.size, arena_bytes)?;
    factors.take_for(engine, &mut subject, triangles)?;
    Versus::measure(engine, peer, &mut subject, scale.effort)
}
