//! What is printed, in Markdown.

use pnaen::internals::Engine;

use super::Scale;
use super::copy::Copies;
use super::error::{self, EqualError, PAPER_PIXELS};
use super::numbers::{Spread, table, whole};
use super::rows::{self, Named, rate_of};
use super::versus::Versus;
use super::vulkan::VulkanError;

/// Triangles by which the peer's count may differ from ours before it is said: a part of all.
const SAME_TRIANGLES: f64 = 0.001;
/// And pictures.
const SAME_PICTURE: f64 = 0.01;

/// Prints section by section, and keeps what goals are held against.
#[derive(Default)]
pub struct Report {
    copies: Option<Copies>,
    rows: Vec<Named>,
    /// Theirs by ours, by the GPU's clock and by the host's.
    equal_error: Vec<(f32, [f64; 2])>,
}

impl Report {
    /// The adapter, what is measured, and why there is no peer if there is none.
    pub fn begin(engine: &Engine, scale: &Scale, missing: Option<&VulkanError>) -> Self {
        let info = &engine.gpu.info;
        let clock = if engine.gpu.has_timestamps() {
            "the GPU's timestamps"
        } else {
            "whole submissions on the host's clock, as this adapter has no timestamps that can be trusted"
        };
        let [width, height] = scale.size;
        let (samples, runs) = (pnaen::internals::samples(&engine.gpu), scale.effort.runs);
        println!("# Tessellation in compute passes against the driver's tessellation stages\n");
        println!("- adapter: {} ({:?}, {:?})", info.name, info.device_type, info.backend);
        println!("- driver: {} {}", info.driver, info.driver_info);
        println!("- date: {}", pnaen::internals::utc(std::time::SystemTime::now()));
        println!("- pictures: {width} x {height} px, {samples} samples a px, cleared and resolved by both");
        println!("- times: ms, medians of {runs} runs after warm-up (least..most), by {clock}");
        println!("{METHOD}");
        if let Some(error) = missing {
            println!("\n**No peer here: {error}.** What follows is ours alone.");
        }
        Self::default()
    }

    pub fn copies(&mut self, copies: Copies) {
        let row = |name: &str, rate: f64| vec![name.to_owned(), format!("{:.1}", rate * 1e-9)];
        let rows = [row("copy command", copies.command), row("compute shader, 16 bytes an invocation", copies.shader)];
        let head = format!("copying {} bytes | GB/s, read and written", whole(copies.bytes));
        println!("\n## Memory\n\n{}", table(&head, &rows));
        self.copies = Some(copies);
    }

    /// One comparison, printed once all are there.
    pub fn versus(&mut self, name: &str, versus: Versus) {
        eprintln!("measured: {name}, {} triangles", whole(versus.triangles));
        self.rows.push((name.to_owned(), versus));
    }

    /// `nothing` is what a picture of nothing takes.
    pub fn end_versus(&self, nothing: &Spread) {
        println!("## Tessellation alone\n\n{}", rows::tessellation(&self.rows, self.copies.as_ref()));
        println!("{BYTES}\n");
        println!("## Whole frames\n\n{}", rows::frames(&self.rows));
        println!("Host: from the first call to the last pixel; ours waits for its counts on the way.");
        println!("Clearing and resolving a picture of nothing, which is part of every frame: {nothing} ms.\n");
        println!("## What was drawn\n\n{}", rows::drawn(&self.rows));
        self.rows.iter().for_each(warn);
        println!("## Our passes\n\n{}", rows::passes(&self.rows));
    }

    /// How cost grows.
    pub fn growth(&self, steps: &[Named]) {
        println!("## Growth\n\n{}", rows::growth(steps));
        steps.iter().for_each(warn);
    }

    pub fn equal_error(&mut self, scenes: &[EqualError]) {
        println!("## Equal error on screen\n");
        println!("Theirs: the white paper's LOD.{EQUAL}\n");
        println!("{}", error::table_of(scenes));
        self.equal_error = scenes.iter().filter_map(|scene| Some((scene.paper_pixels, scene.faster()?))).collect();
    }

    /// Whether what this bench is for was reached here.
    pub fn goals(&self) {
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
                    &format!("whole frames at equal error, theirs at {px} px a segment, {clock}: theirs / ours"),
                    4.0,
                    there,
                );
            }
        }
    }
}

const METHOD: &str = "\
- ours: factors (but where they are hashed: those are given), counts, scan, chunks and emit, added up; control nets are
  made once a mesh and pose, and are in neither
- theirs: hull shader, tessellator and domain shader, without rasteriser; control nets and factors are read from memory,
  where ours have computed them; the faster of two ways to read nets, each time";

const BYTES: &str = "\
Bytes are those that the passes can't do without: what they emit, their inputs once, and what one hands to another once
written and once read.";

const EQUAL: &str = " Its clipping and fractional-odd factors
are ready in memory. Ours: LOD by error, clipping and culling of backs, all in the frame, at the largest tolerance found
whose largest error is no more.";

fn goal(name: &str, asked: f64, found: impl Iterator<Item = f64>) {
    match found.reduce(f64::min) {
        Some(least) => {
            let word = if least >= asked { "reached" } else { "not reached" };
            println!("- {name}: {least:.2} in the worst row, {asked} asked: {word}");
        }
        None => println!("- {name}: not measured here, {asked} asked"),
    }
}

/// Says where the two don't draw the same.
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
