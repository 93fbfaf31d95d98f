//! Runs a case: every method with every partitioning, on every device asked for.

use std::collections::BTreeMap;
use std::num::NonZero;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use glam::{DVec2, Vec4};

use super::{Method, Probe, Quantity, Row, Subject, Tried, views};
use geometry::defaults::with_defaults;
use geometry::mesh::{Bounds, Mesh, Moment, Pose, Topology, t_junctions};
use geometry::progress::Progress;
use geometry::tessellate::{
    Clip, FACTOR_VALUE, FIXED_ONE, LodView, Partitioning, PosedMesh, Tessellation, bounds_through, tessellate,
};
use gpu::{GpuError, Timing};
use inspect::engine::Engine;
use inspect::measure::{Measured, RequestedFactors, SWEEP_STEP, sweep};
use inspect::render::{Camera, Scene, Target};
use inspect::settings::{ARENA_BYTES, Choice, Settings};

with_defaults! {
    /// How much is tried, and on which devices.
    #[derive(Clone, Debug)]
    pub struct Effort {
        /// The uniform factors that are tried.
        pub factors: Vec<f32> = vec![1.0, 2.4, 7.0, 16.0],
        /// How many cameras are tried for adaptive LOD and clipping: the first ones of a fixed sequence.
        pub cameras: u32 = 6,
        /// Whether the reference implementation on the CPU runs as well.
        pub cpu: bool = true,
        /// The last factor of a sweep, which starts at 1.
        pub sweep_to: f32 = 64.0,
        /// The methods that run.
        pub methods: Vec<Method> = Method::all(),
        /// Whether folds are counted on every mesh, and not only on the case that is about them.
        pub folds: bool = false,
    }
}

/// The segment length that adaptive LOD is asked for, in px.
const PIXELS: f32 = 8.0;

/// The worst number of each quantity over a method's factors and views, and the first tessellation that has it.
#[derive(Clone, Debug, Default)]
struct Worst(BTreeMap<Quantity, (f64, Option<Tried>)>);

impl Worst {
    fn take(&mut self, quantity: Quantity, measured: f64, tried: Option<Tried>) {
        let worst = self.0.entry(quantity).or_insert((measured, tried));
        if measured > worst.0 {
            *worst = (measured, tried);
        }
    }
}

/// A tessellation that is to be tried, and further cameras that leaks are counted from, if factors and clipping don't depend on the
/// camera.
type Trial = (Tried, Vec<Camera>);

/// A case that is being run: its mesh, and the same mesh on the device.
struct Running<'a> {
    case: &'a Subject,
    effort: &'a Effort,
    mesh: Arc<Mesh>,
    topology: Arc<Topology>,
    bounds: Bounds,
    /// The one that the case's picture is taken with.
    camera: Camera,
    device: Option<(&'a Engine, Scene, Target)>,
}

/// The most pairs of method and partitioning that run at the same time. Each has an arena of its own on the device.
const MOST_AT_A_TIME: usize = 8;

/// Runs a case on the CPU (if `effort` says so) and on the engine's device (if there is one).
///
/// # Errors
/// The device fails, or the mesh needs larger buffers than the adapter can bind.
pub fn run(case: &Subject, engine: Option<&Engine>, effort: &Effort) -> Result<Vec<Row>, GpuError> {
    let mesh = Arc::new(case.mesh.clone());
    // Nobody else holds these handles, so nobody can cancel.
    let topology = Arc::new(Topology::build_within(&mesh, case.weld, &Progress::new()).unwrap_or_default());
    let pairs = |method| Partitioning::ALL.map(move |partitioning| (method, partitioning));
    let jobs: Vec<_> = effort.methods.iter().copied().flat_map(pairs).collect();
    let (next, done) = (AtomicUsize::new(0), Mutex::new(BTreeMap::new()));
    let work = || -> Result<(), GpuError> {
        let mut running = Running::new(case, effort, (mesh.clone(), topology.clone()), engine)?;
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(&(method, partitioning)) = jobs.get(index) else { return Ok(()) };
            let rows = running.job(method, partitioning)?;
            done.lock().unwrap_or_else(PoisonError::into_inner).insert(index, rows);
        }
    };
    let cores = thread::available_parallelism().map_or(1, NonZero::get);
    thread::scope(|scope| {
        let workers: Vec<_> = (0..cores.min(MOST_AT_A_TIME)).map(|_| scope.spawn(work)).collect();
        workers.into_iter().try_for_each(|worker| worker.join().unwrap_or_else(|panic| resume_unwind(panic)))
    })?;
    let mut rows = topology_rows(case, &mesh, &topology);
    rows.extend(done.into_inner().unwrap_or_else(PoisonError::into_inner).into_values().flatten());
    Ok(rows)
}

impl<'a> Running<'a> {
    fn new(
        case: &'a Subject,
        effort: &'a Effort,
        (mesh, topology): (Arc<Mesh>, Arc<Topology>),
        engine: Option<&'a Engine>,
    ) -> Result<Self, GpuError> {
        let on = |engine: &'a Engine| -> Result<_, GpuError> {
            let scene = engine.scene_of(mesh.clone(), topology.clone(), ARENA_BYTES)?;
            Ok((engine, scene, Target::new(&engine.gpu, views::SIZE)?))
        };
        let device = engine.map(on).transpose()?;
        let bounds = bounds_through(&mesh, Some(0));
        let camera = views::camera(&bounds, &case.view, views::viewport());
        Ok(Self { case, effort, mesh, topology, bounds, camera, device })
    }

    /// Runs one method with one partitioning, on every device.
    fn job(&mut self, method: Method, partitioning: Partitioning) -> Result<Vec<Row>, GpuError> {
        let mut rows = Vec::new();
        if self.effort.cpu {
            let worst = self.on_cpu(method, partitioning);
            rows.extend(self.rows(method, partitioning, "cpu", &worst));
        }
        if let Some((engine, ..)) = self.device {
            let worst = self.on_device(method, partitioning)?;
            rows.extend(self.rows(method, partitioning, &engine.gpu.info.name, &worst));
        }
        Ok(rows)
    }

    /// The tessellations that a method is tried with: first uniform factors, then adaptive LOD.
    fn trials(&self, method: Method, partitioning: Partitioning) -> Vec<Trial> {
        let Self { effort, camera: case_camera, .. } = *self;
        let random = |index| views::random(&self.bounds, index);
        let seen = |settings, camera, also_from| (Tried { settings, camera, moment: None }, also_from);
        let uniform = effort.factors.iter().enumerate().map(|(turn, &factor)| {
            let settings = method.displacing(&self.mesh, method.settings(partitioning, factor));
            // Each camera is used with one of the factors.
            let also_from = (turn as u32..effort.cameras).step_by(effort.factors.len()).map(random).collect();
            seen(settings, case_camera, also_from)
        });
        let adaptive = method.displacing(&self.mesh, method.adaptive(partitioning, PIXELS));
        let unclipped = adaptive.with(Tessellation { clip: Clip::Off, ..adaptive.tessellation });
        // The paper's clip test drops whole patches, which would hide every other fault. It has cases of its own.
        let everywhere = if method == Method::AsPublished { unclipped } else { adaptive };
        let random = (0..effort.cameras).map(|index| seen(everywhere, random(index), Vec::new()));
        let views = [unclipped, adaptive].map(|settings| seen(settings, case_camera, Vec::new()));
        let views = views.into_iter().filter(|_| self.case.probe == Probe::View);
        let mut trials: Vec<_> = uniform.chain(random).chain(views).collect();
        trials.iter_mut().enumerate().for_each(|(index, (tried, _))| tried.moment = self.moment(index));
        trials
    }

    /// The moment of a trial of a mesh that moves. Trials use its clips in turn, at times that are spread evenly by the golden
    /// ratio.
    fn moment(&self, index: usize) -> Option<Moment> {
        const GOLDEN: f64 = 0.618_033_988_749_895;
        let rig = self.mesh.rig.as_deref()?;
        let clip = index % rig.clips.len().max(1);
        let time = rig.clips.get(clip)?.duration * (GOLDEN * (index + 1) as f64).fract();
        Some(Moment { clip, time })
    }

    /// The pose of the mesh at a moment.
    fn pose(&self, moment: Option<Moment>) -> Option<Arc<Pose>> {
        let rig = self.mesh.rig.as_deref()?;
        Some(Arc::new(rig.pose(moment?)))
    }

    fn on_cpu(&self, method: Method, partitioning: Partitioning) -> Worst {
        let mut worst = Worst::default();
        for (tried, _) in self.trials(method, partitioning) {
            let Tried { settings, camera, moment } = tried;
            let view = camera.lod_view(views::viewport(), &self.bounds);
            let pose = self.pose(moment);
            let (mesh, topology) = PosedMesh::new(self.mesh.clone(), self.topology.clone(), pose).deformed();
            let out = tessellate(&mesh, &topology, &settings.inputs(view), None);
            let own = settings.tessellation;
            let asked = RequestedFactors::new(own.edges, own.convention, out.edge_factors.clone());
            let measured = Measured::new(&mesh, &topology, asked, &out);
            self.take(&mut worst, &measured, tried, &view);
        }
        if self.case.probe == Probe::Sweep {
            let view = LodView::new(glam::Mat4::IDENTITY, views::viewport());
            let inputs = method.settings(partitioning, 1.0).inputs(view);
            let swept = sweep(&self.mesh, &self.topology, &inputs, 1.0..=self.effort.sweep_to, SWEEP_STEP);
            let largest = swept.largest().map_or(0.0, |step| step.jump);
            let quantity = if partitioning.is_fractional() { Quantity::Jump } else { Quantity::Pop };
            worst.take(quantity, largest / f64::from(self.bounds.diagonal()), None);
        }
        worst
    }

    fn on_device(&mut self, method: Method, partitioning: Partitioning) -> Result<Worst, GpuError> {
        let mut worst = Worst::default();
        for (tried, also_from) in self.trials(method, partitioning) {
            let Tried { settings, camera, moment } = tried;
            let view = camera.lod_view(views::viewport(), &self.bounds);
            let pose = self.pose(moment);
            let Some((engine, scene, _)) = &mut self.device else { break };
            scene.tessellator.set_pose(pose)?;
            engine.count(scene, &settings.inputs(view), &mut Timing::Off)?;
            let measured = engine.measure(scene)?;
            for camera in also_from.into_iter().chain([camera]) {
                if let Some(leaks) = engine.leaks(scene, &measured, views::SIZE, &camera)? {
                    worst.take(Quantity::Leaks, leaks as f64, Some(Tried { camera, ..tried }));
                }
            }
            self.take(&mut worst, &measured, tried, &view);
            if self.case.probe == Probe::View && settings.tessellation.clip != Clip::Off {
                let missing = self.missing(&settings, &camera)?;
                worst.take(Quantity::Missing, missing as f64, Some(tried));
            }
        }
        Ok(worst)
    }

    fn take(&self, worst: &mut Worst, measured: &Measured, tried: Tried, view: &LodView) {
        let has_folds = self.effort.folds || self.case.probe == Probe::Folds;
        let counts = [
            (Quantity::Points, measured.cracks.different_bits),
            (Quantity::Factors, measured.cracks.different_factors),
            (Quantity::Normals, measured.cracks.different_normals),
            (Quantity::NotFinite, measured.not_finite),
        ];
        let folds = has_folds.then_some((Quantity::Folds, measured.folds));
        counts.into_iter().chain(folds).for_each(|(what, count)| worst.take(what, count as f64, Some(tried)));
        // Clipped patches have no segments to measure, and a random camera may be anywhere.
        let own = tried.settings.tessellation;
        let is_measured = own.used_lod().follows_view() && own.clip == Clip::Off && tried.camera == self.camera;
        if self.case.probe == Probe::View && is_measured {
            let longest = longest_segment(&self.topology, measured, view) / f64::from(PIXELS);
            worst.take(Quantity::Segment, longest, Some(tried));
        }
    }

    /// The number of pixels that differ between the pictures with and without clipping.
    fn missing(&mut self, settings: &Settings, camera: &Camera) -> Result<u64, GpuError> {
        let Some((engine, scene, target)) = &mut self.device else { return Ok(0) };
        let mut picture = |settings: &Settings| {
            engine.draw(scene, target, camera, settings, &mut Timing::Off)?;
            target.read(&engine.gpu)
        };
        let clipped = picture(settings)?;
        let whole = picture(&settings.with(Tessellation { clip: Clip::Off, ..settings.tessellation }))?;
        Ok(clipped.pixels().zip(whole.pixels()).filter(|(a, b)| a != b).count() as u64)
    }

    fn rows(&self, method: Method, partitioning: Partitioning, device: &str, worst: &Worst) -> Vec<Row> {
        let row = |(&quantity, &(measured, tried)): (&Quantity, &(f64, Option<Tried>))| Row {
            promised: promised(method, quantity),
            tried,
            ..row(&self.case.name, method.name(), device, partitioning.name(), quantity, measured)
        };
        worst.0.iter().map(row).collect()
    }
}

/// The measurements on the mesh itself, which are the same for all methods.
fn topology_rows(case: &Subject, mesh: &Mesh, topology: &Topology) -> Vec<Row> {
    let edges = |topology: &Topology| f64::from(topology.edge_counts().boundary);
    match case.probe {
        Probe::TJunctions(made) => {
            let found = t_junctions(topology, &Progress::new()).map_or(0, |found| found.len());
            let missed = f64::from(made.abs_diff(found as u32));
            vec![row(&case.name, "search", "cpu", "any", Quantity::TJunctions, missed)]
        }
        Probe::Weld => {
            let exact = Topology::build(mesh, &Progress::new()).unwrap_or_default();
            let open = row(&case.name, "exact weld", "cpu", "any", Quantity::OpenEdges, edges(&exact));
            let closed = row(&case.name, "weld 1e-5", "cpu", "any", Quantity::OpenEdges, edges(topology));
            vec![Row { promised: false, ..open }, closed]
        }
        _ => Vec::new(),
    }
}

fn row(
    case: &str,
    method: &'static str,
    device: &str,
    partitioning: &'static str,
    quantity: Quantity,
    measured: f64,
) -> Row {
    Row {
        case: case.to_owned(),
        method,
        device: device.to_owned(),
        partitioning,
        measured,
        unit: quantity.unit(),
        promised: true,
        holds: measured <= quantity.limit(),
        quantity,
        tried: None,
    }
}

/// Whether this program promises that a quantity holds under a method.
fn promised(method: Method, quantity: Quantity) -> bool {
    match quantity {
        Quantity::NotFinite | Quantity::Jump => true,
        Quantity::Pop => false,
        // Any curved surface may fold.
        Quantity::Folds => method.surface().is_flat(),
        // Surfaces that follow each side's own normals tear at split normals by design.
        Quantity::Points | Quantity::Leaks => method != Method::AsPublished && !method.surface().tears(),
        _ => method != Method::AsPublished,
    }
}

/// The length of the longest segment on screen, in px, over edges that the tessellator could have cut finer.
fn longest_segment(topology: &Topology, measured: &Measured, view: &LodView) -> f64 {
    // Fractional odd partitioning makes at most 63 segments, the others 64.
    let most = 63 * FIXED_ONE;
    let mut longest = 0.0_f64;
    for edge in 0..topology.edges.len() as u32 {
        for side in measured.outlines.edge(topology, edge).iter().filter(|side| side.word & FACTOR_VALUE < most) {
            let clip: Vec<Vec4> = side.positions().map(|p| view.clip_from_object * p.extend(1.0)).collect();
            longest = clip.windows(2).map(|ends| visible_length(ends[0], ends[1], view)).fold(longest, f64::max);
        }
    }
    longest
}

/// The length in px of the part of a line that lies in the view volume.
fn visible_length(a: Vec4, b: Vec4, view: &LodView) -> f64 {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    let planes = |p: Vec4| [p.w + p.x, p.w - p.x, p.w + p.y, p.w - p.y, p.z, p.w - p.z].map(f64::from);
    for (inside_a, inside_b) in planes(a).into_iter().zip(planes(b)) {
        match (inside_a < 0.0, inside_b < 0.0) {
            (true, true) => return 0.0,
            (true, false) => from = from.max(inside_a / (inside_a - inside_b)),
            (false, true) => to = to.min(inside_a / (inside_a - inside_b)),
            (false, false) => {}
        }
    }
    if from >= to {
        return 0.0;
    }
    let (a, b) = (a.as_dvec4(), b.as_dvec4());
    let at = |t: f64| {
        let p = a.lerp(b, t);
        DVec2::new(p.x, p.y) / p.w * view.half_viewport.as_dvec2()
    };
    at(from).distance(at(to))
}
