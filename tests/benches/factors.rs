//! Measures how long patches take to find their factors while a camera turns around a mesh: `cargo bench --bench factors`. Arguments
//! after `--` are mesh files that are measured too.
//!
//! Each mesh is seen from 240 places around it, at 1920 x 1080, and every place is drawn as if nothing had been there before. The
//! built-in shapes are measured again under waves of heights. The times are those of the GPU (on a software driver those of the
//! host). The bench reports its results, and no result makes it fail.

use std::error::Error;
use std::f32::consts::TAU;
use std::path::PathBuf;
use std::sync::Arc;

use geometry::mesh::heights::{HeightMap, Heights};
use geometry::mesh::shapes::Shape;
use geometry::mesh::{Mesh, Topology};
use geometry::progress::Progress;
use geometry::tessellate::{Displacement, Lod, Partitioning, Tessellation};
use gpu::recorder::{DRAWING, PassTime, Timing, take_times};
use inspect::engine::Engine;
use inspect::render::camera::Camera;
use inspect::render::target::Target;
use inspect::settings::{ARENA_BYTES, Choice, Settings};
use load::files::Limits;
use load::source::Source;

const FRAMES: usize = 240;
const SIZE: [u32; 2] = [1920, 1080];
const TOLERANCES: [f32; 2] = [0.25, 1.0];
/// Texels of a side of the waves, which are as high as a hundredth of the mesh's size.
const TEXELS: u32 = 512;
const PARTITIONINGS: [Partitioning; 3] = [Partitioning::Integer, Partitioning::FractionalOdd, Partitioning::Rows];

/// What one frame took in ms.
struct Frame {
    factors: f64,
    drawing: f64,
    all: f64,
    triangles: u64,
}

impl Frame {
    fn new(times: &[PassTime], triangles: u64) -> Self {
        let sum = |is_counted: &dyn Fn(&str) -> bool| -> f64 {
            times.iter().filter(|time| is_counted(time.pass)).map(|time| time.ms).sum()
        };
        Self {
            factors: sum(&|pass| pass == "factors"),
            drawing: sum(&|pass| DRAWING.contains(&pass)),
            all: sum(&|_| true),
            triangles,
        }
    }
}

/// Returns the number below which this share of the numbers is.
fn percentile(numbers: impl Iterator<Item = f64>, share: f64) -> f64 {
    let mut numbers = Vec::from_iter(numbers);
    numbers.sort_by(f64::total_cmp);
    let last = numbers.len().saturating_sub(1);
    numbers.get(((share * numbers.len() as f64) as usize).min(last)).copied().unwrap_or(f64::NAN)
}

/// Draws a mesh from all places around it, and prints a row for each tolerance and partitioning.
fn measure(engine: &Engine, name: &str, mesh: Mesh) -> Result<(), Box<dyn Error>> {
    let mesh = Arc::new(mesh);
    let topology = Arc::new(Topology::build(&mesh, &Progress::new())?);
    let patches = topology.patches.len();
    let mut scene = engine.scene_of(mesh, topology, ARENA_BYTES)?;
    let target = Target::new(&engine.gpu, SIZE)?;
    let camera = Camera::framing(&scene.bounds, target.viewport());
    let mut timing = Timing::on(&engine.gpu);
    for tolerance in TOLERANCES {
        for partitioning in PARTITIONINGS {
            let displacement = Displacement::On;
            let height_scale = 0.01 * scene.bounds.radius();
            let tessellation = Tessellation {
                lod: Lod::Error,
                tolerance,
                partitioning,
                displacement,
                height_scale,
                ..Tessellation::default()
            };
            let settings = Settings::from(tessellation);
            let mut frames = Vec::new();
            // The first frame makes pipelines.
            for place in 0..=FRAMES {
                let azimuth = camera.azimuth + TAU * place as f32 / FRAMES as f32;
                let camera = Camera { azimuth, ..camera };
                engine.draw(&mut scene, &target, &camera, &settings, &mut timing)?;
                engine.gpu.wait();
                frames.push(Frame::new(&take_times(&engine.gpu, &mut timing), scene.tessellator.totals().1));
            }
            frames.remove(0);
            let of = |part: fn(&Frame) -> f64, share| percentile(frames.iter().map(part), share);
            let label = tessellation.partitioning.name();
            println!(
                "| {name}, {patches} | {tolerance} | {label} | {:.0} | {:.3}, {:.3} | {:.3} | {:.3} |",
                of(|frame| frame.triangles as f64, 0.5),
                of(|frame| frame.factors, 0.5),
                of(|frame| frame.factors, 0.99),
                of(|frame| frame.drawing, 0.5),
                of(|frame| frame.all, 0.5),
            );
        }
    }
    Ok(())
}

/// Lays four waves in either direction over a mesh, in steps of 8 bits as most files have them, or in steps of f32.
fn under_waves(mut mesh: Mesh, in_8_bits: bool) -> Mesh {
    let along = |texel: u32| (4.0 * TAU * texel as f32 / TEXELS as f32).sin();
    let height = |i: u32| {
        let height = 0.5 + 0.25 * (along(i % TEXELS) + along(i / TEXELS));
        if in_8_bits { (255.0 * height).round() / 255.0 } else { height }
    };
    let map = HeightMap::new([TEXELS; 2], (0..TEXELS * TEXELS).map(height).collect());
    mesh.heights = Some(Arc::new(Heights::everywhere(&mesh, map)));
    mesh
}

fn main() -> Result<(), Box<dyn Error>> {
    let engine = Engine::headless()?;
    let files = std::env::args().skip(1).filter(|argument| !argument.starts_with("--"));
    let files = files.map(|path| Source::File(PathBuf::from(path)));
    let shapes = [Shape::Torus, Shape::CubeSmooth, Shape::Icosahedron, Shape::Cylinder, Shape::Saddle];
    println!("{}, {FRAMES} frames of {} x {} px\n", engine.gpu.info.name, SIZE[0], SIZE[1]);
    println!("| mesh, patches | px | partitioning | triangles | factors, ms (median, 99 %) | drawing, ms | all, ms |");
    println!("| --- | ---: | --- | ---: | ---: | ---: | ---: |");
    for source in shapes.map(Source::Shape).into_iter().chain(files) {
        let mesh = source.load(&Limits::default(), &Progress::new())?.mesh;
        let title = source.title();
        let waves = [(", waves", false), (", waves in 8 bits", true)];
        let displaced = if matches!(source, Source::Shape(_)) { &waves[..] } else { &[] };
        let displaced = displaced.iter().map(|&(label, in_8_bits)| (label, under_waves(mesh.clone(), in_8_bits)));
        for (label, mesh) in [("", mesh.clone())].into_iter().chain(displaced) {
            measure(&engine, &format!("{title}{label}"), mesh)?;
        }
    }
    Ok(())
}
