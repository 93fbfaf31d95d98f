//! Compares our passes with the driver's tessellation stages, in one run on one device: `cargo bench`.
//!
//! The peer draws the same patches with Vulkan's hull shader, fixed-function tessellator and domain shader. It gets the control
//! nets that our nets pass computed, and the factors that our counts pass used. Times are medians. On software drivers, whose
//! timestamps are wrong, they are times of whole submissions. The bench reports its results, and no result makes it fail.
//! `cargo bench --bench hardware -- emission` prints only how long rows take to emit beside rings, and `-- materials MESH...` only
//! how long pictures of mesh files take in the light of a studio, with layers and without. `-- shaders` compares exported shaders on the
//! driver's stages with our passes.
#![allow(
    unsafe_code,
    clippy::undocumented_unsafe_blocks,
    reason = "every call of Vulkan is; handles live as long as their owner"
)]

mod copy;
mod error;
mod growth;
mod materials;
mod numbers;
mod ours;
mod patterns;
mod peer;
mod pipelines;
mod report;
mod rows;
mod subjects;
mod target;
mod versus;
#[path = "../../vulkan/mod.rs"]
mod vulkan;

use std::process::ExitCode;

use geometry::mesh::shapes::Shape;
use geometry::tessellate::Partitioning::{FractionalOdd, Integer};
use inspect::engine::Engine;
use inspect::settings::ARENA_BYTES;

use copy::Copies;
use ours::Effort;
use peer::Peer;
use report::Report;
use subjects::Factors;
use versus::{BenchError, Versus};
use vulkan::{exported, memory};

/// The amount of work for a device.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    /// The numbers of triangles of the two sizes that are measured.
    pub triangles: [u64; 2],
    /// The width and height of the picture, in px.
    pub size: [u32; 2],
    /// The size of our arena: all output fits at once.
    pub arena_bytes: u64,
    /// The size of each of the two buffers of a copy.
    pub copy_bytes: u64,
    /// The number of tori along each axis of the field in which LODs are compared.
    pub field: usize,
    pub effort: Effort,
}

impl Scale {
    fn new(engine: &Engine) -> Self {
        let effort = Effort::on(engine);
        if engine.gpu.is_software() {
            let (triangles, size) = ([60_000, 20_000], [320, 180]);
            return Self { triangles, size, arena_bytes: ARENA_BYTES, copy_bytes: 32 << 20, field: 2, effort };
        }
        let (triangles, size) = ([28_000_000, 9_000_000], [1920, 1080]);
        Self { triangles, size, arena_bytes: 2 << 30, copy_bytes: 1 << 30, field: 8, effort }
    }
}

/// About the number of triangles in a patch with factors from 5 to 20, and from 10 to 40.
const TRIANGLES_A_PATCH: u64 = 300;
const MORE_TRIANGLES_A_PATCH: u64 = 1_100;
/// About the number of triangles in a patch with factors of 63.
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
    let scale = Scale::new(engine);
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with("--")).collect();
    if let Some(("materials", files)) = arguments.split_first().map(|(part, files)| (part.as_str(), files)) {
        Report::begin(engine, &scale, None).materials(&materials::measure(engine, &scale, files)?);
        return Ok(());
    }
    if std::env::args().any(|argument| argument == "shaders") {
        return shaders(engine);
    }
    if std::env::args().any(|argument| argument == "emission") {
        Report::begin(engine, &scale, None).patterns(&patterns::measure(engine, &scale)?);
        return Ok(());
    }
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
    report.patterns(&patterns::measure(engine, &scale)?);
    report.growth(&growth::measure(engine, peer.as_ref(), &scale)?);
    report.equal_error(&error::measure(engine, peer.as_ref(), &scale)?);
    report.goals();
    Ok(())
}

/// Compares exported shaders on the driver's tessellation stages with our passes.
fn shaders(engine: &Engine) -> Result<(), BenchError> {
    let vulkan = vulkan::Vulkan::new(&engine.gpu.info)?;
    let mut subject = exported::Subject::new(engine, &vulkan, Shape::CubeSplit.build())?;
    println!("# Exported shaders on {}\n\n{}", engine.gpu.info.name, exported::table(&exported::rows(&mut subject)?));
    let mut displaced = exported::Subject::new(engine, &vulkan, exported::wavy(Shape::CubeSplit.build()))?;
    println!("\nDisplaced:\n\n{}", exported::displaced_table(&exported::displaced_rows(&mut displaced)?));
    let by_view = exported::rows_by_view(&mut displaced)?;
    println!("\nDisplaced, by the view:\n\n{}", exported::table_by_view(&by_view));
    Ok(())
}

/// Measures one torus of about this many patches, tessellated to about this many triangles.
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
