//! Compares LOD by error with the fewest triangles that keep the same tolerance: `cargo bench --bench optimum`. Arguments after
//! `--` are mesh files that are measured too; `cameras=N`, the number of random cameras beside the default one; `close=yes`, which
//! brings them as near to a patch as a tenth of its size; and
//! `only=NAME,NAME`, which measures these meshes alone. Rows are compared with the optimum of integer partitioning. With `search=no` no
//! optimum is searched for: then all partitionings are measured that LOD by error has, and what the table tells is whether the
//! tolerance is kept, of all of them or of the one that `partitioning=NAME` names. With `device=gpu` the same is told of what
//! a GPU emits.

mod meshes;
mod search;

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use geometry::mesh::{Mesh, Topology};
use geometry::tessellate::hull_factors::HullFactors;
use geometry::tessellate::{Inputs, Lod, Partitioning, Tessellation};
use glam::{Vec2, Vec3};
use gpu::recorder::Timing;
use inspect::engine::Engine;
use inspect::engine::measurements::Measurements;
use inspect::render::camera::Camera;
use inspect::render::scene::Scene;
use inspect::settings::ARENA_BYTES;
use search::{Compared, Optimum, compare_with_optimum};

const VIEWPORT: Vec2 = Vec2::new(1280.0, 720.0);
/// In px.
const TOLERANCES: [f32; 4] = [0.25, 0.5, 1.0, 2.0];
/// Meshes of more patches are compared with the lower bound alone, since a search takes too long.
const MOST_PATCHES: usize = 1500;

/// One mesh under one view.
#[derive(Clone, Copy)]
struct Case {
    mesh: usize,
    /// 0 is the default camera.
    number: usize,
    camera: Camera,
    tolerance: f32,
    partitioning: Partitioning,
}

/// What was measured of a case.
struct Row {
    case: Case,
    compared: Compared,
}

impl Row {
    /// How many times as many triangles as the optimum LOD by error has; `None` if the optimum wasn't searched for, or a factor is
    /// capped.
    fn times(&self) -> Option<f64> {
        self.compared.error_px?;
        let best = self.compared.best.as_ref()?;
        Some(self.compared.triangles as f64 / best.triangles.max(1) as f64)
    }

    /// How many times as many triangles as its lower bound the optimum has.
    fn bound(&self) -> Option<f64> {
        let best = self.compared.best.as_ref()?;
        Some(best.triangles as f64 / best.lower_bound.max(1) as f64)
    }

    /// Whether one factor for all edges needs fewer triangles.
    fn exceeds_uniform(&self) -> bool {
        let uniform =
            self.compared.best.as_ref().and_then(|best| best.uniform).filter(|_| self.compared.error_px.is_some());
        uniform.is_some_and(|(_, triangles)| self.compared.triangles > triangles)
    }
}

/// The default camera, then random ones: around the mesh, close to it, inside, and without perspective.
fn cameras(mesh: &Mesh, count: usize) -> Vec<Camera> {
    let bounds = mesh.bounds();
    let framing = Camera::framing(&bounds, VIEWPORT);
    let mut random = fastrand::Rng::with_seed(1);
    let other = |index: usize| {
        let near = [2.5, 1.2, 0.6, 0.25, 4.0][index % 5];
        let part = |random: &mut fastrand::Rng| random.f32() * 2.0 - 1.0;
        let aside = Vec3::new(part(&mut random), part(&mut random), part(&mut random));
        Camera {
            target: bounds.center() + aside * (0.4 * bounds.radius()),
            azimuth: 360.0 * random.f32(),
            elevation: 80.0 * part(&mut random),
            distance: near * bounds.radius(),
            orthographic: index % 4 == 3,
            ..Camera::default()
        }
    };
    std::iter::once(framing).chain((0..count).map(other)).collect()
}

/// The default camera, then random ones that are as far from a point of a triangle as a tenth of its longest side.
fn close_cameras(mesh: &Mesh, count: usize) -> Vec<Camera> {
    let mut random = fastrand::Rng::with_seed(2);
    let close = |_| {
        let triangle = mesh.triangles[random.usize(..mesh.triangles.len())];
        let [a, b, c] = triangle.map(|corner| mesh.corners[corner as usize].position);
        let (along, across) = (random.f32(), random.f32());
        Camera {
            target: a.lerp(b.lerp(c, along), across),
            azimuth: 360.0 * random.f32(),
            elevation: 80.0 * (2.0 * random.f32() - 1.0),
            distance: 0.1 * a.distance(b).max(b.distance(c)).max(c.distance(a)),
            ..Camera::default()
        }
    };
    std::iter::once(Camera::framing(&mesh.bounds(), VIEWPORT)).chain((0..count).map(close)).collect()
}

fn cases(
    meshes: &[(String, Arc<Mesh>)],
    cameras: impl Fn(&Mesh) -> Vec<Camera>,
    partitionings: &[Partitioning],
) -> Vec<Case> {
    let mut cases = Vec::new();
    for (index, (_, mesh)) in meshes.iter().enumerate() {
        for (number, camera) in cameras(mesh).into_iter().enumerate() {
            for (k, tolerance) in TOLERANCES.into_iter().enumerate() {
                // The default camera with every tolerance, the others with one each.
                if number == 0 || number % 4 == k {
                    for &partitioning in partitionings {
                        cases.push(Case { mesh: index, number, camera, tolerance, partitioning });
                    }
                }
            }
        }
    }
    cases
}

fn inputs(mesh: &Mesh, case: &Case) -> Inputs {
    let Case { camera, tolerance, partitioning, .. } = *case;
    let tessellation = Tessellation { lod: Lod::Error, tolerance, partitioning, ..Tessellation::default() };
    Inputs::new(&tessellation, camera.lod_view(VIEWPORT, &mesh.bounds()))
}

fn measure(mesh: &Mesh, topology: &Topology, case: &Case, searches: bool) -> Row {
    let searches = searches && topology.patches.len() <= MOST_PATCHES && case.partitioning != Partitioning::Rows;
    Row { case: *case, compared: compare_with_optimum(mesh, topology, &inputs(mesh, case), searches) }
}

/// A GPU, and a mesh in its memory.
struct Device {
    engine: Engine,
    scene: Option<(usize, Scene)>,
}

impl Device {
    fn open() -> Self {
        Self { engine: Engine::headless().expect("a graphics adapter"), scene: None }
    }

    fn measure(&mut self, mesh: &Arc<Mesh>, topology: &Arc<Topology>, case: &Case) -> Row {
        if self.scene.as_ref().is_none_or(|(loaded, _)| *loaded != case.mesh) {
            let scene = self.engine.scene_of(mesh.clone(), topology.clone(), ARENA_BYTES).expect("room for a mesh");
            self.scene = Some((case.mesh, scene));
        }
        let Some((_, scene)) = &mut self.scene else { unreachable!("it was just made") };
        let inputs = inputs(mesh, case);
        self.engine.count(scene, &inputs, &mut Timing::Off).expect("room for factors");
        let (_, triangles) = scene.tessellator.totals();
        let written = scene.tessellator.hull_factors().expect("factors");
        let capped = |factors: &HullFactors| factors.is_capped(inputs.tessellation.partitioning);
        let error_px = (!written.iter().any(capped)).then(|| {
            let wanted = Measurements { screen_error: Some(&inputs), ..Measurements::default() };
            let measured = self.engine.measure_all(scene, &wanted).expect("room for what is emitted");
            measured.screen_error.map_or(0.0, |worst| worst.value)
        });
        Row { case: *case, compared: Compared { triangles, best: None, error_px } }
    }
}

/// The partitionings that LOD by error has.
const BY_ERROR: [Partitioning; 5] = [
    Partitioning::Integer,
    Partitioning::Pow2,
    Partitioning::FractionalOdd,
    Partitioning::FractionalEven,
    Partitioning::Rows,
];

/// Gives cases under rows the optimum of integer partitioning, and LOD by error under it in place of one factor for all edges.
fn compare_rows_with_integer(rows: &mut [Row]) {
    let key = |row: &Row| (row.case.mesh, row.case.number, row.case.tolerance.to_bits());
    let under = |wanted: Partitioning| move |row: &&Row| row.case.partitioning == wanted;
    let integer: HashMap<_, _> = rows
        .iter()
        .filter(under(Partitioning::Integer))
        .filter_map(|row| Some((key(row), (row.compared.best.clone()?, row.compared.triangles))))
        .collect();
    for row in rows.iter_mut().filter(|row| row.case.partitioning == Partitioning::Rows) {
        row.compared.best =
            integer.get(&key(row)).cloned().map(|(best, triangles)| Optimum { uniform: Some((0, triangles)), ..best });
    }
}

fn geometric_mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value.ln(), count + 1));
    (sum / f64::from(count.max(1))).exp()
}

fn print_row(name: &str, rows: &[&Row]) {
    let times: Vec<f64> = rows.iter().filter_map(|row| row.times()).collect();
    let bound = geometric_mean(rows.iter().filter_map(|row| row.bound()));
    let more = rows.iter().filter(|row| row.exceeds_uniform()).count();
    let part = |row: &&&Row| row.compared.error_px.map(|px| px / f64::from(row.case.tolerance));
    let error = rows.iter().filter_map(|row| part(&row)).fold(0.0, f64::max);
    let capped = rows.iter().filter(|row| row.compared.error_px.is_none()).count();
    let largest = times.iter().copied().fold(0.0, f64::max);
    let mean = geometric_mean(times.iter().copied());
    println!("| {name} | {} | {mean:.3} | {largest:.3} | {bound:.3} | {more} | {error:.3} | {capped} |", rows.len());
}

/// Cases that are listed one by one: with this many times as many triangles as the optimum, with more than one factor for all
/// edges has, or capped.
const LISTED: f64 = 1.5;

fn print_worst(meshes: &[(String, Arc<Mesh>)], rows: &[Row]) {
    println!("\nCases above {LISTED} times the optimum, above one factor for all, or capped\n");
    println!(
        "| mesh | camera | orthographic | partitioning | px | triangles | optimum | one factor for all, or under rows integer |"
    );
    println!("| --- | ---: | --- | --- | ---: | ---: | ---: | ---: |");
    let is_listed = |row: &&Row| {
        let is_capped = row.compared.error_px.is_none();
        let is_beyond = row.compared.error_px.is_some_and(|px| px > f64::from(row.case.tolerance));
        is_capped || is_beyond || row.exceeds_uniform() || row.times().is_some_and(|times| times > LISTED)
    };
    for row in rows.iter().filter(is_listed) {
        let Case { mesh, number, camera, tolerance, partitioning } = row.case;
        let best = row.compared.best.as_ref().map_or_else(|| "-".to_owned(), |best| best.triangles.to_string());
        let uniform = row.compared.best.as_ref().and_then(|best| best.uniform);
        let uniform = uniform.map_or_else(|| "-".to_owned(), |(_, triangles)| triangles.to_string());
        let capped = match row.compared.error_px {
            None => " (capped)".to_owned(),
            Some(px) if px > f64::from(tolerance) => format!(" ({px:.2} px)"),
            _ => String::new(),
        };
        let Compared { triangles, .. } = row.compared;
        println!(
            "| {} | {number} | {} | {partitioning:?} | {tolerance} | {triangles}{capped} | {best} | {uniform} |",
            meshes[mesh].0, camera.orthographic
        );
    }
}

/// Prints what the default camera sees, mesh by mesh and tolerance by tolerance: the triangles of LOD by error under integer
/// partitioning and under rows, and the optimum of Direct3D's pattern.
fn print_default_views(meshes: &[(String, Arc<Mesh>)], rows: &[Row]) {
    println!(
        "\nThe default view: triangles under integer / optimum of Direct3D's pattern / rows, and rows over that optimum\n"
    );
    let columns = TOLERANCES.map(|tolerance| format!(" {tolerance} px |")).concat();
    println!("| mesh |{columns}\n| --- |{}", " --- |".repeat(TOLERANCES.len()));
    let mut times = vec![Vec::new(); TOLERANCES.len()];
    for (index, (name, _)) in meshes.iter().enumerate() {
        let mut cells = String::new();
        for (tolerance, times) in TOLERANCES.into_iter().zip(&mut times) {
            let of = |partitioning| {
                let is_own = |row: &&Row| {
                    let Case { mesh, number, tolerance: own, partitioning: under, .. } = row.case;
                    (mesh, number, own, under) == (index, 0, tolerance, partitioning)
                };
                rows.iter().find(is_own)
            };
            let (Some(integer), Some(own)) = (of(Partitioning::Integer), of(Partitioning::Rows)) else { continue };
            let [here, there] = [integer.compared.triangles, own.compared.triangles];
            cells += &match (&integer.compared.best, own.times()) {
                (Some(best), Some(ratio)) => {
                    times.push(ratio);
                    format!(" {here} / {} / {there}: {ratio:.2} |", best.triangles)
                }
                _ => format!(" {here} / - / {there} |"),
            };
        }
        println!("| {name} |{cells}");
    }
    let means: String = times.into_iter().map(|own| format!(" {:.3} |", geometric_mean(own.into_iter()))).collect();
    println!("| geometric mean |{means}");
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with("--")).collect();
    let cameras_each =
        arguments.iter().find_map(|argument| argument.strip_prefix("cameras=")?.parse().ok()).unwrap_or(20);
    let files: Vec<PathBuf> = arguments.iter().filter(|argument| !argument.contains('=')).map(PathBuf::from).collect();
    let value = |name: &str| arguments.iter().find_map(|argument| argument.strip_prefix(name));
    let only = value("only=");
    let mut meshes = meshes::with_files(&files);
    meshes.retain(|(name, _)| only.is_none_or(|only| only.split(',').any(|only| name == only)));
    let topologies: Vec<Arc<Topology>> = meshes.iter().map(|(_, mesh)| Arc::new(Topology::new(mesh))).collect();
    let on_device = arguments.iter().any(|argument| argument == "device=gpu");
    let searches = !on_device && !arguments.iter().any(|argument| argument == "search=no");
    let partitionings: &[Partitioning] = match searches {
        true => &[Partitioning::Integer, Partitioning::FractionalOdd, Partitioning::Rows],
        false => &BY_ERROR,
    };
    let named = |partitioning: &&Partitioning| {
        value("partitioning=").is_none_or(|name| format!("{partitioning:?}").eq_ignore_ascii_case(name))
    };
    let partitionings: Vec<Partitioning> = partitionings.iter().filter(named).copied().collect();
    let is_close = arguments.iter().any(|argument| argument == "close=yes");
    let cameras = |mesh: &Mesh| match is_close {
        true => close_cameras(mesh, cameras_each),
        false => cameras(mesh, cameras_each),
    };
    let cases = cases(&meshes, cameras, &partitionings);
    let (next, rows) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, |cores| cores.get()) {
            scope.spawn(|| {
                let mut device = on_device.then(Device::open);
                while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let (mesh, topology) = (&meshes[case.mesh].1, &topologies[case.mesh]);
                    let row = match &mut device {
                        Some(device) => device.measure(mesh, topology, case),
                        None => measure(mesh, topology, case, searches),
                    };
                    rows.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).push(row);
                }
            });
        }
    });
    let mut rows = rows.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
    rows.sort_by_key(|row| (row.case.mesh, row.case.number));
    compare_rows_with_integer(&mut rows);
    for &partitioning in &partitionings {
        println!("\n{partitioning:?}, {}x{} px\n", VIEWPORT.x, VIEWPORT.y);
        let more_than = match partitioning {
            Partitioning::Rows => "integer partitioning",
            _ => "one factor for all",
        };
        println!(
            "| mesh | cases | triangles over the optimum, geometric mean | largest | optimum over its lower bound | cases with more than {more_than} | largest error over the tolerance | capped cases |"
        );
        println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
        for (index, (name, mesh)) in meshes.iter().enumerate() {
            let own: Vec<&Row> =
                rows.iter().filter(|row| row.case.mesh == index && row.case.partitioning == partitioning).collect();
            print_row(&format!("{name} ({})", mesh.triangles.len()), &own);
        }
        print_row("all", &rows.iter().filter(|row| row.case.partitioning == partitioning).collect::<Vec<_>>());
    }
    if searches {
        print_default_views(&meshes, &rows);
    }
    print_worst(&meshes, &rows);
}
