//! Prints the report in Markdown.

use inspect::engine::Engine;

use super::Scale;
use super::copy::Copies;
use super::error::{self, EqualError, PAPER_PIXELS};
use super::materials::{self, Drawn};
use super::numbers::{Spread, table, whole};
use super::patterns::{self, Pair};
use super::rows::{self, Named, rate_of};
use super::versus::Versus;
use super::vulkan::VulkanError;

/// The part by which the peer's number of triangles may differ from ours without a warning.
const SAME_TRIANGLES: f64 = 0.001;
/// The difference between pictures that causes no warning: see [`super::versus::PeerTimes::difference`].
const SAME_PICTURE: f64 = 0.005;

/// Prints section by section, and keeps the numbers that are compared with goals at the end.
#[derive(Default)]
pub(crate) struct Report {
    copies: Option<Copies>,
    rows: Vec<Named>,
    /// The px per segment, and their time divided by ours, by the GPU's clock and by the host's.
    equal_error: Vec<(f32, [f64; 2])>,
}

impl Report {
    /// Prints the adapter, what is measured, and if there is no peer, why.
    pub(crate) fn begin(engine: &Engine, scale: &Scale, missing: Option<&VulkanError>) -> Self {
        let info = &engine.gpu.info;
        let clock = if engine.gpu.has_timestamps() {
            "the GPU's timestamps"
        } else {
            "the host's clock for whole submissions, since this adapter has no reliable timestamps"
        };
        let [width, height] = scale.size;
        let (samples, runs) = (inspect::render::target::samples(&engine.gpu), scale.effort.runs);
        println!("# Tessellation in compute passes against the driver's tessellation stages\n");
        println!("- adapter: {} ({:?}, {:?})", info.name, info.device_type, info.backend);
        println!("- driver: {} {}", info.driver, info.driver_info);
        println!("- date: {}", geometry::numbers::utc(std::time::SystemTime::now()));
        println!("- pictures: {width} x {height} px, {samples} samples per px, cleared and resolved by both");
        println!("- times: ms, medians of {runs} runs after warm-up (least..most), by {clock}");
        println!("{METHOD}");
        if let Some(error) = missing {
            println!("\n**There is no peer here: {error}.** All numbers are ours.");
        }
        Self::default()
    }

    /// Prints the bandwidth of memory.
    pub(crate) fn copies(&mut self, copies: Copies) {
        let row = |name: &str, rate: f64| vec![name.to_owned(), format!("{:.1}", rate * 1e-9)];
        let rows = [row("copy command", copies.command), row("compute shader, 16 bytes per invocation", copies.shader)];
        let head = format!("copying {} bytes | GB/s, read and written", whole(copies.bytes));
        println!("\n## Memory\n\n{}", table(&head, &rows));
        self.copies = Some(copies);
    }

    /// Takes one comparison. All are printed at the end.
    pub(crate) fn versus(&mut self, name: &str, versus: Versus) {
        eprintln!("measured: {name}, {} triangles", whole(versus.triangles));
        self.rows.push((name.to_owned(), versus));
    }

    /// Prints all comparisons. `nothing` is the time of an empty picture.
    pub(crate) fn end_versus(&self, nothing: &Spread) {
        println!("## Tessellation alone\n\n{}", rows::tessellation(&self.rows, self.copies.as_ref()));
        println!("{BYTES}\n");
        println!("## Whole frames\n\n{}", rows::frames(&self.rows));
        println!("Host times go from the first call to the last pixel. Ours include waiting for the counts.");
        println!("Clearing and resolving an empty picture, which is part of every frame, takes {nothing} ms.\n");
        println!("## What was drawn\n\n{}", rows::drawn(&self.rows));
        self.rows.iter().for_each(warn);
        println!("## Our passes\n\n{}", rows::passes(&self.rows));
    }

    /// Prints the emission of rows beside that of rings.
    pub(crate) fn patterns(&self, pairs: &[Pair]) {
        println!("## Emission of rows and of rings\n\n{}", patterns::table_of(pairs));
        println!("One factor for all edges of a torus; rings are those of integer partitioning.\n");
    }

    /// Prints what materials cost.
    pub(crate) fn materials(&self, rows: &[Drawn]) {
        println!("## Materials\n\n{}", materials::table_of(rows));
        println!("Drawing alone: what is drawn was emitted before.");
    }

    /// Prints how cost grows.
    pub(crate) fn growth(&self, steps: &[Named]) {
        println!("## Growth\n\n{}", rows::growth(steps));
        steps.iter().for_each(warn);
    }

    /// Prints the comparisons at equal error.
    pub(crate) fn equal_error(&mut self, scenes: &[EqualError]) {
        println!("## Equal error on screen\n");
        println!("Theirs: the white paper's LOD.{EQUAL}\n");
        println!("{}", error::table_of(scenes));
        self.equal_error = scenes.iter().filter_map(|scene| Some((scene.paper_pixels, scene.faster()?))).collect();
    }

    /// Prints which goals were reached.
    pub(crate) fn goals(&self) {
        println!("## Goals\n");
        let fractional = || self.rows.iter().filter(|(name, _)| name.starts_with("fractional")).map(|(_, row)| row);
        let speed = fractional()
            .filter_map(|row| row.peer.as_ref().map(|peer| peer.tessellation.median / row.ours.tessellation.median));
        let bytes = fractional().filter_map(|row| self.copies.as_ref().map(|copies| rate_of(row) / copies.best()));
        let frames = self
            .rows
            .iter()
            .filter_map(|(_, row)| row.peer.as_ref().map(|peer| peer.frame.median / row.ours.frame.median));
        goal("tessellation alone, fractional factors: theirs / ours", 40.0, speed);
        goal("tessellation alone, fractional factors: part of copying", 0.5, bytes);
        goal("whole frames at equal triangles, GPU: theirs / ours", 1.0, frames);
        for px in PAPER_PIXELS {
            for (index, clock) in ["GPU", "host"].into_iter().enumerate() {
                let there = self.equal_error.iter().filter(|(of, _)| *of == px).map(|(_, faster)| faster[index]);
                goal(
                    &format!("whole frames at equal error, theirs at {px} px per segment, {clock}: theirs / ours"),
                    4.0,
                    there,
                );
            }
        }
    }
}

const METHOD: &str = "\
- ours: the sum of our passes factors (except where factors are hashed, which are given), counts, scan, chunks and emit;
  control nets are made once for each mesh and pose, and count for neither side
- theirs: the driver's hull shader, tessellator and domain shader, without rasterisation; control nets and factors are
  read from memory, where our passes have put them; nets are read in two ways, of which the faster counts each time";

const BYTES: &str = "\
Bytes are the least that the passes must move: their output, their input read once, and what passes from one to the next,
written once and read once.";

const EQUAL: &str = " Its clipping and fractional-odd factors
are computed before and read from memory. Ours: LOD by error with clipping and back-face culling, all computed in the
frame, at the largest tolerance found whose largest error is at most theirs.";

fn goal(name: &str, asked: f64, found: impl Iterator<Item = f64>) {
    match found.reduce(f64::min) {
        Some(least) => {
            let word = if least >= asked { "reached" } else { "not reached" };
            println!("- {name}: {least:.2} in the worst row, the goal is {asked}: {word}");
        }
        None => println!("- {name}: not measured here, the goal is {asked}"),
    }
}

/// Prints a warning if the two draw different triangles or pictures.
fn warn((name, row): &Named) {
    let Some(peer) = &row.peer else { return };
    if let Some(counted) = peer.counted {
        let off = counted.triangles as f64 / row.triangles.max(1) as f64 - 1.0;
        if off.abs() > SAME_TRIANGLES {
            println!("**Warning: {name}: the peer's triangles are {:+.2} percent of ours.**\n", 100.0 * off);
        }
    }
    if peer.difference > SAME_PICTURE {
        println!("**Warning: {name}: the pictures differ by {:.4}.**\n", peer.difference);
    }
}
