//! What is printed, in Markdown.

use pnaen::engine::Engine;

use super::Scale;
use super::copy::Copies;
use super::error::{EqualError, PAPER_PIXELS};
use super::growth::STEPS;
use super::numbers::{ratio, table, whole};
use super::versus::Versus;
use super::vulkan::VulkanError;

/// Triangles by which the peer's count may differ from ours before it is said: a part of all.
const SAME_TRIANGLES: f64 = 0.001;
/// And pictures.
const SAME_PICTURE: f64 = 0.01;

/// Prints as numbers come in, and keeps what goals are held against.
#[derive(Default)]
pub struct Report {
    copies: Option<Copies>,
    rows: Vec<(String, Versus)>,
    least_equal_error: Vec<[f64; 2]>,
}

impl Report {
    /// The adapter, what is measured, and why there is no peer if there is none.
    pub fn begin(engine: &Engine, scale: &Scale, missing: Option<&VulkanError>) -> Self {
        let info = &engine.gpu.info;
        println!("# Tessellation in compute passes against the driver's tessellation stages\n");
        println!("- adapter: {} ({:?}, {:?})", info.name, info.device_type, info.backend);
        println!("- driver: {} {}", info.driver, info.driver_info);
        let [width, height] = scale.size;
        println!(
            "- pictures: {width} x {height} px, {} samples a px, cleared and resolved by both",
            engine.gpu.samples
        );
        let clock = if engine.gpu.has_timestamps() {
            "the GPU's timestamps"
        } else {
            "whole submissions on the host's clock: this adapter's timestamps are none, or not to be trusted"
        };
        println!("- times: ms, medians of {} runs after warm-up (least..most), by {clock}", scale.effort.runs);
        println!(
            "- ours: factors, counts, scan, chunks and emit, added up; control nets are made once a mesh and pose"
        );
        println!("- theirs: hull shader, tessellator and domain shader without rasteriser; control nets and factors");
        println!(
            "  are read from memory, where ours have computed them; the faster of two ways to read nets, each time"
        );
        if let Some(error) = missing {
            println!("\n**No peer here: {error}.** What follows is ours alone.");
        }
        Self::default()
    }

    pub fn copies(&mut self, copies: Copies) {
        println!("\n## Memory\n");
        let rate = |rate: f64| format!("{:.1}", rate * 1e-9);
        let row = |name: &str, found: f64| vec![name.to_owned(), rate(found)];
        let rows = [row("copy command", copies.command), row("compute shader, 16 bytes an invocation", copies.shader)];
        print!("{}", table(&[&format!("copying {} bytes", whole(copies.bytes)), "GB/s, read and written"], &rows));
        self.copies = Some(copies);
    }

    /// One comparison, printed when all are there.
    pub fn versus(&mut self, name: &str, versus: Versus) {
        eprintln!("measured: {name}, {} triangles", whole(versus.triangles));
        self.rows.push((name.to_owned(), versus));
    }

    pub fn end_versus(&mut self) {
        println!("\n## Tessellation alone\n");
        let rows: Vec<_> =
            self.rows.iter().map(|(name, row)| tessellation_row(name, row, self.copies.as_ref())).collect();
        let head = [
            "factors",
            "patches",
            "triangles",
            "ours",
            "theirs",
            "times faster",
            "ours Mtri/s",
            "theirs Mtri/s",
            "GB/s",
            "of copying",
        ];
        print!("{}", table(&head, &rows));
        println!(
            "\nBytes are those that the passes can't do without: what they emit, their inputs once, and what one hands to"
        );
        println!("another once written and once read.\n\n## Whole frames\n");
        let rows: Vec<_> = self.rows.iter().map(|(name, row)| frame_row(name, row)).collect();
        let head = [
            "factors",
            "triangles",
            "ours, drawing alone",
            "ours, GPU",
            "theirs, GPU",
            "theirs / ours",
            "ours, host",
            "theirs, host",
            "theirs / ours",
        ];
        print!("{}", table(&head, &rows));
        println!(
            "\nHost: from the first call to the last pixel, waiting included; ours waits for its counts on the way."
        );
        println!("\n## What was drawn\n");
        let rows: Vec<_> = self.rows.iter().map(|(name, row)| drawn_row(name, row)).collect();
        let head = [
            "factors",
            "ours, triangles",
            "theirs, triangles",
            "theirs, evaluations",
            "pictures differ by",
            "nets handed on: alone, frame",
            "nets in memory: alone, frame",
        ];
        print!("{}", table(&head, &rows));
        self.rows.iter().for_each(|(name, row)| warn(name, row));
        println!("\n## Our passes\n");
        let names = ["nets", "factors", "counts", "scan", "chunks", "emit", "draw"];
        let rows: Vec<_> = self.rows.iter().map(|(name, row)| passes_row(name, row, &names)).collect();
        print!("{}", table(&[&["factors", "triangles"][..], &names].concat(), &rows));
    }

    /// How cost grows.
    pub fn growth(&self, steps: &[Versus]) {
        let Some(base) = steps.first() else { return };
        println!("\n## Growth\n");
        let row = |(name, step): (&&str, &Versus)| {
            let theirs = |of: &Versus| of.peer.as_ref().map(|peer| peer.tessellation.median);
            vec![
                (*name).to_owned(),
                whole(step.patches.into()),
                whole(step.triangles),
                ratio(step.triangles as f64, base.triangles as f64),
                step.ours.tessellation.to_string(),
                ratio(step.ours.tessellation.median, base.ours.tessellation.median),
                step.peer.as_ref().map_or("none".to_owned(), |peer| peer.tessellation.to_string()),
                theirs(step).zip(theirs(base)).map_or("none".to_owned(), |(step, base)| ratio(step, base)),
            ]
        };
        let rows: Vec<_> = STEPS.iter().zip(steps).map(row).collect();
        let head = ["fractional, by distance", "patches", "triangles", "times", "ours", "times", "theirs", "times"];
        print!("{}", table(&head, &rows));
    }

    pub fn equal_error(&mut self, scenes: &[EqualError]) {
        println!("\n## Equal error on screen\n");
        println!(
            "Theirs with the white paper's LOD at {PAPER_PIXELS} px a segment, its clipping and fractional-odd factors, all"
        );
        println!(
            "ready in memory; ours with LOD by error, clipping and culling of backs, at the largest tolerance found whose"
        );
        println!("largest error is no more. Whole frames.\n");
        let mut rows = Vec::new();
        for scene in scenes {
            let theirs = scene.peer.as_ref();
            let faster = theirs
                .map(|peer| [peer.frame.median / scene.ours.frame.median, peer.wall.median / scene.ours.wall.median]);
            self.least_equal_error.extend(faster);
            let or_none = |text: Option<String>| text.unwrap_or("none".to_owned());
            rows.push(vec![
                scene.scene.clone(),
                whole(scene.triangles[0]),
                whole(scene.triangles[1]),
                format!("{:.3}", scene.px[0]),
                format!("{:.3}", scene.px[1]),
                format!("{:.3}", scene.tolerance),
                or_none(theirs.map(|peer| peer.frame.to_string())),
                scene.ours_paper.frame.to_string(),
                scene.ours.frame.to_string(),
                or_none(faster.map(|[gpu, _]| format!("{gpu:.2}"))),
                or_none(theirs.map(|peer| peer.wall.to_string())),
                scene.ours.wall.to_string(),
                or_none(faster.map(|[_, wall]| format!("{wall:.2}"))),
            ]);
        }
        let head = [
            "scene",
            "theirs, triangles",
            "ours, triangles",
            "theirs, px",
            "ours, px",
            "our tolerance, px",
            "theirs, GPU",
            "ours with their LOD, GPU",
            "ours, GPU",
            "theirs / ours",
            "theirs, host",
            "ours, host",
            "theirs / ours",
        ];
        print!("{}", table(&head, &rows));
    }

    /// Whether what this bench is for was reached here.
    pub fn goals(&self) {
        println!("\n## Goals\n");
        let fractional = || self.rows.iter().filter(|(name, _)| name.starts_with("fractional"));
        let least = |numbers: Vec<f64>| numbers.into_iter().reduce(f64::min);
        let speed = fractional().filter_map(|(_, row)| {
            row.peer.as_ref().map(|peer| peer.tessellation.median / row.ours.tessellation.median)
        });
        let bytes = fractional().filter_map(|(_, row)| self.copies.as_ref().map(|copies| rate_of(row) / copies.best()));
        let frames = self
            .rows
            .iter()
            .filter_map(|(_, row)| row.peer.as_ref().map(|peer| peer.frame.median / row.ours.frame.median));
        goal("tessellation, fractional factors: times their triangles a second", 40.0, least(speed.collect()));
        goal("bytes a second, fractional factors: part of copying", 0.5, least(bytes.collect()));
        goal("whole frames at equal triangles: theirs / ours", 1.0, least(frames.collect()));
        let equal = |which: usize| least(self.least_equal_error.iter().map(|both| both[which]).collect());
        goal("whole frames at equal error, GPU: theirs / ours", 4.0, equal(0));
        goal("whole frames at equal error, host: theirs / ours", 4.0, equal(1));
    }
}

fn goal(name: &str, asked: f64, least: Option<f64>) {
    match least {
        Some(found) => {
            let word = if found >= asked { "reached" } else { "not reached" };
            println!("- {name}: at least {found:.2} in every row, for {asked}: {word}");
        }
        None => println!("- {name}: not measured here, for {asked}"),
    }
}

fn rate_of(row: &Versus) -> f64 {
    row.bytes as f64 / (row.ours.tessellation.median * 1e-3)
}

fn tessellation_row(name: &str, row: &Versus, copies: Option<&Copies>) -> Vec<String> {
    let (ours, theirs) = (&row.ours.tessellation, row.peer.as_ref().map(|peer| peer.tessellation));
    let none = || "none".to_owned();
    let throughput = |ms: f64| format!("{:.0}", row.triangles as f64 / ms * 1e-3);
    vec![
        name.to_owned(),
        whole(row.patches.into()),
        whole(row.triangles),
        ours.to_string(),
        theirs.map_or_else(none, |theirs| theirs.to_string()),
        theirs.map_or_else(none, |theirs| ratio(theirs.median, ours.median)),
        throughput(ours.median),
        theirs.map_or_else(none, |theirs| throughput(theirs.median)),
        format!("{:.1}", rate_of(row) * 1e-9),
        copies.map_or_else(none, |copies| format!("{:.3}", rate_of(row) / copies.best())),
    ]
}

fn frame_row(name: &str, row: &Versus) -> Vec<String> {
    let none = || "none".to_owned();
    let (ours, theirs) = (&row.ours, row.peer.as_ref());
    vec![
        name.to_owned(),
        whole(row.triangles),
        ours.draw.to_string(),
        ours.frame.to_string(),
        theirs.map_or_else(none, |theirs| theirs.frame.to_string()),
        theirs.map_or_else(none, |theirs| ratio(theirs.frame.median, ours.frame.median)),
        ours.wall.to_string(),
        theirs.map_or_else(none, |theirs| theirs.wall.to_string()),
        theirs.map_or_else(none, |theirs| ratio(theirs.wall.median, ours.wall.median)),
    ]
}

fn drawn_row(name: &str, row: &Versus) -> Vec<String> {
    let none = || "none".to_owned();
    let peer = row.peer.as_ref();
    let counted = peer.and_then(|peer| peer.counted);
    let way = |index: usize| peer.map_or_else(none, |peer| peer.ways[index].map(super::numbers::ms).join(", "));
    vec![
        name.to_owned(),
        whole(row.triangles),
        counted.map_or_else(|| "not counted".to_owned(), |counted| whole(counted.triangles)),
        counted.map_or_else(|| "not counted".to_owned(), |counted| whole(counted.evaluations)),
        peer.map_or_else(none, |peer| format!("{:.5}", peer.difference)),
        way(0),
        way(1),
    ]
}

fn passes_row(name: &str, row: &Versus, passes: &[&str]) -> Vec<String> {
    let time = |pass: &&str| {
        let time = row.ours.passes.iter().find(|time| time.pass == *pass);
        time.map_or_else(|| "none".to_owned(), |time| super::numbers::ms(time.ms))
    };
    [name.to_owned(), whole(row.triangles)].into_iter().chain(passes.iter().map(time)).collect()
}

/// Says where the two don't draw the same.
fn warn(name: &str, row: &Versus) {
    let Some(peer) = &row.peer else { return };
    if let Some(counted) = peer.counted {
        let off = counted.triangles as f64 / row.triangles.max(1) as f64 - 1.0;
        if off.abs() > SAME_TRIANGLES {
            println!("\n**Warning: {name}: the peer's triangles are {:+.2} percent of ours.**", 100.0 * off);
        }
    }
    if peer.difference > SAME_PICTURE {
        println!("\n**Warning: {name}: the pictures differ by {:.4}.**", peer.difference);
    }
}
