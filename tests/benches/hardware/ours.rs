//! Our side: times of our passes, and the data that the peer gets from them.

use std::time::{Duration, Instant};

use geometry::tessellate::{Clip, Tessellation, Vertex};
use glam::Vec3;
use gpu::embed::GpuError;
use gpu::layout::{CurveNet, Patch};
use gpu::readback::read_buffer;
use gpu::recorder::{DRAWING, PassTime, Timing, take_times};
use inspect::engine::Engine;
use inspect::render::camera::Camera;
use inspect::render::scene::Scene;
use inspect::render::target::Target;
use inspect::settings::Settings;

use super::numbers::Spread;
use super::peer::{NetCorner, PeerFrame};

/// The number of runs for a median, and the least time of the warm-up before them.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    pub runs: usize,
    pub warm_up: Duration,
}

impl Effort {
    /// The effort for an engine's device: less on software drivers.
    pub fn on(engine: &Engine) -> Self {
        if engine.gpu.is_software() {
            return Self { runs: 15, warm_up: Duration::ZERO };
        }
        Self { runs: 31, warm_up: Duration::from_millis(300) }
    }

    /// Calls `once` to warm up, and then for each run. Returns the results of the runs.
    ///
    /// # Errors
    /// The first error of `once`.
    pub fn repeat<T, E>(self, mut once: impl FnMut(usize) -> Result<T, E>) -> Result<Vec<T>, E> {
        let start = Instant::now();
        let mut warm = 0;
        while warm < 1 || start.elapsed() < self.warm_up {
            once(warm)?;
            warm += 1;
        }
        (warm..warm + self.runs).map(once).collect()
    }
}

/// The passes that run whenever the view changes, without drawing.
const TESSELLATING: [&str; 5] = ["factors", "counts", "scan", "chunks", "emit"];

/// The times of one run in ms.
#[derive(Clone, Debug)]
struct Run {
    passes: Vec<PassTime>,
}

impl Run {
    fn sum(&self, passes: &[&str]) -> f64 {
        self.passes.iter().filter(|time| passes.contains(&time.pass)).map(|time| time.ms).sum()
    }

    fn is_whole(&self) -> bool {
        ["counts", "scan", "chunks", "emit", "draw"].iter().all(|pass| self.sum(&[pass]) > 0.0)
    }
}

/// The times of our passes in ms.
pub(crate) struct OurTimes {
    /// All passes between the nets and drawing.
    pub tessellation: Spread,
    pub draw: Spread,
    /// Tessellation and drawing together.
    pub frame: Spread,
    /// From the first call to the last pixel on the host's clock, which includes waiting for the counts.
    pub wall: Spread,
    /// The median of each pass.
    pub passes: Vec<PassTime>,
}

/// A scene with a target, a camera, and the settings of its tessellation.
pub(crate) struct Subject {
    pub scene: Scene,
    pub target: Target,
    pub camera: Camera,
    pub settings: Settings,
}

impl Subject {
    /// Runs the passes up to the counts. Returns the numbers of vertices and triangles.
    ///
    /// # Errors
    /// The device was lost.
    pub(crate) fn count(&mut self, engine: &Engine) -> Result<(u64, u64), GpuError> {
        let view = self.camera.lod_view(self.target.viewport(), &self.scene.bounds);
        engine.count(&mut self.scene, &self.settings.inputs(view), &mut Timing::Off)?;
        Ok(self.scene.tessellator.totals())
    }

    /// Draws again as if the view had just changed: nets stay, and all other passes run.
    fn again(&mut self, engine: &Engine, run: usize, timing: &mut Timing) -> Result<(), GpuError> {
        // This doesn't change the picture, but it changes every parameter of the view. Given and uniform factors don't depend
        // on the view, so the tessellation is forgotten.
        let nudge = if run.is_multiple_of(2) { 0.0 } else { 1e-3 };
        if self.scene.tessellator.given().is_some()
            || self.settings.tessellation.used_lod() == geometry::tessellate::Lod::Uniform
        {
            self.scene.tessellator.forget();
        }
        let camera = Camera { azimuth: self.camera.azimuth + nudge, ..self.camera };
        engine.draw(&mut self.scene, &self.target, &camera, &self.settings, timing)?;
        engine.gpu.wait();
        Ok(())
    }

    /// Times all passes.
    ///
    /// # Errors
    /// The device was lost.
    pub(crate) fn time(&mut self, engine: &Engine, effort: Effort) -> Result<OurTimes, GpuError> {
        let mut timing = Timing::on(&engine.gpu);
        let runs = effort.repeat(|run| {
            self.again(engine, run, &mut timing)?;
            Ok::<_, GpuError>(Run { passes: take_times(&engine.gpu, &mut timing) })
        })?;
        // If a driver doesn't return a timestamp, the sum is too small, and the run doesn't count.
        let runs: Vec<Run> = runs.into_iter().filter(Run::is_whole).collect();
        let wall = effort.repeat(|run| {
            let start = Instant::now();
            self.again(engine, run, &mut Timing::Off)?;
            Ok::<_, GpuError>(start.elapsed().as_secs_f64() * 1e3)
        })?;
        engine.gpu.check()?;
        let spread = |passes: &[&str]| Spread::from_times(runs.iter().map(|run| run.sum(passes)));
        let passes = gpu::recorder::PASSES.map(|pass| PassTime { pass, ms: spread(&[pass]).median });
        let frame = [&TESSELLATING[..], &DRAWING].concat();
        Ok(OurTimes {
            tessellation: spread(&TESSELLATING),
            draw: spread(&DRAWING),
            frame: spread(&frame),
            wall: Spread::from_times(wall.into_iter()),
            passes: passes.into_iter().filter(|time| time.ms > 0.0).collect(),
        })
    }

    /// The time of an empty picture in ms: clearing and resolving, which are part of every frame.
    ///
    /// # Errors
    /// The device was lost.
    pub(crate) fn time_nothing(&mut self, engine: &Engine, effort: Effort) -> Result<Spread, GpuError> {
        let mut timing = Timing::on(&engine.gpu);
        let beside = self.camera.target + Vec3::splat(1e3 * self.scene.bounds.radius());
        let camera = Camera { target: beside, ..self.camera };
        let settings = self.settings.with(Tessellation { clip: Clip::Frustum, ..self.settings.tessellation });
        let runs = effort.repeat(|_| {
            engine.draw(&mut self.scene, &self.target, &camera, &settings, &mut timing)?;
            engine.gpu.wait();
            Ok::<_, GpuError>(Run { passes: take_times(&engine.gpu, &mut timing) })
        })?;
        Ok(Spread::from_times(runs.iter().map(|run| run.sum(&["draw"])).filter(|ms| *ms > 0.0)))
    }

    /// The time of drawing what was emitted before, in ms.
    ///
    /// # Errors
    /// The device was lost.
    pub(crate) fn time_drawing(&mut self, engine: &Engine, effort: Effort) -> Result<Spread, GpuError> {
        let mut timing = Timing::on(&engine.gpu);
        let runs = effort.repeat(|_| {
            engine.draw(&mut self.scene, &self.target, &self.camera, &self.settings, &mut timing)?;
            engine.gpu.wait();
            Ok::<_, GpuError>(Run { passes: take_times(&engine.gpu, &mut timing) })
        })?;
        Ok(Spread::from_times(runs.iter().map(|run| run.sum(&DRAWING)).filter(|ms| *ms > 0.0)))
    }

    /// The least number of bytes that our tessellation passes must move: their output; all data of the mesh that they read, once;
    /// and the factors and offsets of patches and factors of edges, which pass from one to the next, written once and read once.
    /// Repeated reads, and the data by which an invocation finds its patch, don't count.
    pub(crate) fn compulsory_bytes(&self) -> u64 {
        let (vertices, triangles) = self.scene.tessellator.totals();
        let b = self.scene.tessellator.buffers();
        let read = [&b.points, &b.corners, &b.patches, &b.curves, &b.factor_curves, &b.curve_nets, &b.edge_factors];
        let read: u64 = read.iter().map(|buffer| buffer.size()).sum();
        let handed = size_of::<geometry::tessellate::PatchFactors>() + size_of::<[u32; 2]>();
        vertices * size_of::<Vertex>() as u64
            + triangles * size_of::<[u32; 3]>() as u64
            + read
            + b.edge_factors.size()
            + 2 * u64::from(b.patch_count) * handed as u64
    }

    /// The control nets that the nets pass made, with the other data that the peer's domain shader needs.
    ///
    /// # Errors
    /// The device was lost.
    pub(crate) fn nets(&self, engine: &Engine) -> Result<Vec<NetCorner>, GpuError> {
        let b = self.scene.tessellator.buffers();
        let read = |buffer: &wgpu::Buffer| read_buffer(&engine.gpu, buffer, 0, buffer.size());
        let points: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&read(&b.points)?);
        let patches: Vec<Patch> = bytemuck::pod_collect_to_vec(&read(&b.patches)?);
        let curves: Vec<CurveNet> = bytemuck::pod_collect_to_vec(&read(&b.curve_nets)?);
        let mesh = self.scene.tessellator.mesh();
        let corner = |index: usize, k: usize| {
            let patch = &patches[index];
            let (own, center) = (&mesh.corners[patch.corners[k] as usize], points[b.point_count as usize + index]);
            let curve = &curves[(patch.curves[k] >> 1) as usize];
            let [near, far] = if patch.curves[k] & 1 == 1 { [curve.ba, curve.ab] } else { [curve.ab, curve.ba] };
            let with = |xyz: [f32; 3], w: f32| Vec3::from(xyz).extend(w).to_array();
            let [x, y, z, _] = points[patch.points[k] as usize];
            NetCorner {
                position_u: [x, y, z, own.uv.x],
                normal_v: own.normal.extend(own.uv.y).to_array(),
                near_center: with(near, center[k]),
                far: with(far, 0.0),
            }
        };
        let corners = (0..b.patch_count as usize).flat_map(|index| [0, 1, 2].map(|k| corner(index, k)));
        Ok(corners.collect())
    }

    /// The picture's constants, as in src/render/frame.rs.
    pub(crate) fn frame(&self) -> PeerFrame {
        let [right, up, back] = self.camera.axes();
        let base_color = self.scene.tessellator.mesh().materials.first().map_or([1.0; 4], |first| first.base_color);
        PeerFrame {
            clip_from_object: self.clip_from_object().to_cols_array_2d(),
            key_light: (up * 0.7 + back - right * 0.5).normalize().extend(0.0).to_array(),
            fill_light: (up * 0.8 + back * 0.4 + right * 0.5).normalize().extend(0.0).to_array(),
            viewport: self.target.viewport().extend(0.0).extend(0.0).to_array(),
            base_color,
        }
    }

    /// Whether our draw leaves out triangles that face away.
    pub(crate) fn fronts_only(&self) -> bool {
        self.scene.tessellator.shows_fronts_only(self.clip_from_object())
    }

    fn clip_from_object(&self) -> glam::Mat4 {
        self.camera.clip_from_object(self.target.viewport(), &self.scene.bounds)
    }
}
