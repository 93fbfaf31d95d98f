//! The engine that the window and the commands share: a device with its pipelines, and what can be done with a scene
//! without a window: upload it, tessellate it, draw it, read it back and time it.

pub(crate) mod measurements;
pub(crate) mod silhouette;

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use glam::Vec3;

use crate::files::Limits;
use crate::gpu::layout::CurveNet;
use crate::gpu::{
    AdapterChoice, ComputePipelines, Given, Gpu, GpuError, PassTime, Recorder, Timing, read_buffer, read_buffers,
    take_times, vertices_of,
};
use crate::load::parts::Part;
use crate::load::selection::Selection;
use crate::load::{
    Budget, HeightSource, Import, LoadError, LoadedMesh, Source, crease_band_warnings, untextured_warning,
};
use crate::measure::{AskedFactors, EmittedChunk, PointsAgreement, Visitor};
use crate::mesh::{BuildError, CreaseBand, Curves, Mesh, Moment, Topology, with_crease_band};
use crate::progress::{Progress, Stage};
use crate::render::{Camera, LeakCounter, Picker, Renderer, Scene, SilhouetteDrawer, Target};
use crate::settings::{Settings, SplitSide};
use crate::tessellate::{
    HullFactors, Inputs, Lod, LodView, Partitioning, PatchFactors, PosedMesh, Tessellated, Tessellation,
};

pub(crate) use measurements::{MeasurementResults, Measurements};
pub(crate) use silhouette::{SilhouetteDrawing, SilhouetteView};

/// A mesh with its topology, and how long both took.
#[derive(Clone, Debug)]
pub struct Loaded {
    pub source: Source,
    /// The preparation that was asked for. The crease band may have become narrower than that.
    pub preparation: Preparation,
    pub crease_band: CreaseBand,
    /// The mesh as it was read: the same as `mesh` unless that has a crease band.
    pub read: Arc<Mesh>,
    pub mesh: Arc<Mesh>,
    /// Sentences about what was left out or repaired.
    pub warnings: Vec<String>,
    /// The names of the material variants that the file has.
    pub variants: Vec<String>,
    /// The names of the scenes that the file has.
    pub scenes: Vec<String>,
    /// Which of them this is.
    pub scene: Option<usize>,
    /// The parts of the file, also those that are left out.
    pub parts: Arc<Vec<Part>>,
    /// Files that the mesh's own file names and that were read, with links resolved.
    pub files: Vec<PathBuf>,
    pub topology: Arc<Topology>,
    pub load_ms: f64,
    pub topology_ms: f64,
}

impl Loaded {
    /// A mesh that no file has.
    pub(crate) fn of_mesh(mesh: Arc<Mesh>, topology: Arc<Topology>) -> Self {
        Self {
            source: Source::default(),
            preparation: Preparation::default(),
            crease_band: CreaseBand::default(),
            read: mesh.clone(),
            mesh,
            warnings: Vec::new(),
            variants: Vec::new(),
            scenes: Vec::new(),
            scene: None,
            parts: Arc::default(),
            files: Vec::new(),
            topology,
            load_ms: 0.0,
            topology_ms: 0.0,
        }
    }

    /// Returns this mesh at a moment of one of its clips, deformed on the CPU. Without a moment it is at rest.
    pub fn posed(&self, moment: Option<Moment>) -> Self {
        let (mesh, topology) = (self.mesh.clone(), self.topology.clone());
        let pose = moment.zip(mesh.rig.as_ref()).map(|(moment, rig)| Arc::new(rig.pose(moment)));
        let (mesh, topology) = PosedMesh::new(mesh, topology, pose).deformed();
        Self { mesh, topology, ..self.clone() }
    }
}

/// How a mesh is read and prepared.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Preparation {
    /// The tolerance for welding points, relative to the bounding diagonal.
    pub weld: f32,
    /// The width of the crease band, relative to the bounding diagonal; 0 for none.
    pub crease_band: f32,
    /// The height images for displacement.
    pub heights: Option<HeightSource>,
    /// The material variant of the file, by name; none for each primitive's own material.
    pub variant: Option<String>,
    /// The scene of the file, by name or by number from 0; none for its default scene.
    pub scene: Option<String>,
    /// The names of parts of the file that are left out.
    pub hidden: Vec<String>,
    /// How the geometry of the file is taken.
    pub import: Import,
    pub limits: Limits,
}

/// Reads a mesh, prepares it, and builds its topology. Needs no device.
///
/// # Errors
/// The mesh or the height image can't be read, the mesh is too large, or `progress` was cancelled.
pub fn load(source: &Source, preparation: &Preparation, progress: &Progress) -> Result<Loaded, LoadError> {
    let start = Instant::now();
    // Large images take longer than most meshes.
    let of_mesh = if preparation.heights.is_some() { progress.part(0.0, 0.4) } else { progress.clone() };
    let selected = Selection {
        variant: preparation.variant.as_deref(),
        scene: preparation.scene.as_deref(),
        hidden: &preparation.hidden,
        import: preparation.import,
    };
    let LoadedMesh { mesh: mut read, mut warnings, variants, scenes, scene, parts, files, file_bytes } =
        source.load_selected(selected, &preparation.limits, &of_mesh)?;
    let loaded = Instant::now();
    let budget = Budget::of_mesh(&read, file_bytes, &preparation.limits);
    let too_large = |what| move |error| unfinished(source, what, error);
    let mut topology =
        Topology::build_afforded(&read, preparation.weld, &budget, progress).map_err(too_large("its edges"))?;
    let (mut cut, mut crease_band) = (None, CreaseBand::default());
    if preparation.crease_band > 0.0 {
        let made = with_crease_band(&read, &topology, preparation.crease_band, &budget, progress)
            .map_err(too_large("its crease band"))?;
        cut = Some(made.0);
        (topology, crease_band) = (made.1, made.2);
        warnings.extend(crease_band_warnings(&crease_band));
        if read.rig.is_some() {
            warnings.push("its animations are left out, since a mesh with a crease band can't be animated.".to_owned());
        }
    }
    let mesh = cut.as_mut().unwrap_or(&mut read);
    if let Some(heights) = &preparation.heights {
        progress.enter(Stage::Heights);
        let heights = heights.load(mesh, &warnings, &budget, &progress.part(0.4, 1.0))?;
        warnings.extend(untextured_warning(&heights, mesh));
        mesh.heights = Some(Arc::new(heights));
    }
    if topology.patches.is_empty() {
        warnings.push("there is nothing to show: every triangle has two corners on one point.".to_owned());
    }
    let read = Arc::new(read);
    Ok(Loaded {
        source: source.clone(),
        preparation: preparation.clone(),
        crease_band,
        mesh: cut.map_or_else(|| read.clone(), Arc::new),
        read,
        warnings,
        variants,
        scenes,
        scene,
        parts: Arc::new(parts),
        files,
        topology: Arc::new(topology),
        load_ms: (loaded - start).as_secs_f64() * 1e3,
        topology_ms: loaded.elapsed().as_secs_f64() * 1e3,
    })
}

/// Converts the error of a step after reading; `what` names what that step makes.
fn unfinished(source: &Source, what: &'static str, error: BuildError) -> LoadError {
    match error {
        BuildError::Cancelled(cancelled) => cancelled.into(),
        other => LoadError::TooMuch { path: source.to_string().into(), what, reason: other.to_string() },
    }
}

/// How many times something is timed: as many as fit into `within`, but at least `least` and at most `most`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Runs {
    pub least: u32,
    pub most: u32,
    pub within: Duration,
}

impl Default for Runs {
    /// Enough for one picture, without a long wait.
    fn default() -> Self {
        Self { least: 1, most: 5, within: Duration::from_secs(2) }
    }
}

/// A device and the pipelines on it, each of which is made when it is first needed. Cheap to clone; clones share everything.
#[derive(Clone)]
pub struct Engine {
    pub gpu: Gpu,
    pub pipelines: Arc<ComputePipelines>,
    pub renderer: Arc<Renderer>,
    pub picker: Arc<Picker>,
    leaks: Arc<LeakCounter>,
    silhouettes: Arc<SilhouetteDrawer>,
    /// See [`Self::chunks_read`].
    chunks_read: Arc<AtomicU64>,
}

impl Engine {
    pub fn new(gpu: Gpu) -> Self {
        let pipelines = Arc::new(ComputePipelines::new());
        let renderer = Arc::new(Renderer::new(&gpu));
        let (picker, leaks) = (Arc::new(Picker::new()), Arc::new(LeakCounter::new()));
        let silhouettes = Arc::new(SilhouetteDrawer::new());
        Self { gpu, pipelines, renderer, picker, leaks, silhouettes, chunks_read: Arc::default() }
    }

    /// Makes an engine on the machine's best adapter, without a window.
    ///
    /// # Errors
    /// There is no adapter, or it gives no device.
    pub fn headless() -> Result<Self, GpuError> {
        Gpu::headless().map(Self::new)
    }

    /// Makes an engine on the adapter that `choice` names, without a window.
    ///
    /// # Errors
    /// There is no such adapter, or it gives no device.
    pub fn chosen(choice: &AdapterChoice) -> Result<Self, GpuError> {
        Gpu::chosen(choice).map(Self::new)
    }

    /// Uploads a mesh; its output gets an arena of `arena_bytes`. Any thread may call this.
    ///
    /// # Errors
    /// The mesh needs a larger buffer than the adapter can bind.
    pub fn scene(&self, loaded: &Loaded, arena_bytes: u64) -> Result<Scene, GpuError> {
        self.scene_of(loaded.mesh.clone(), loaded.topology.clone(), arena_bytes)
    }

    /// As [`Self::scene`], for a mesh that was not loaded.
    ///
    /// # Errors
    /// The mesh needs a larger buffer than the adapter can bind.
    pub fn scene_of(&self, mesh: Arc<Mesh>, topology: Arc<Topology>, arena_bytes: u64) -> Result<Scene, GpuError> {
        Scene::new(&self.gpu, self.renderer.materials(), self.pipelines.clone(), mesh, topology, arena_bytes)
    }

    /// Makes the pipelines that a picture of the scene with these settings needs, as far as they are known before the scene is
    /// counted. The window's loading thread calls this, so that the window doesn't wait for the driver's compiler. Commands
    /// needn't call it.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn prepare(&self, scene: &Scene, settings: &Settings) -> Result<(), GpuError> {
        scene.tessellator.prepare(&settings.tessellation)?;
        self.renderer.prepare(scene, settings)
    }

    /// Adds the left half of a split view to a scene: a second tessellation, with an arena of `arena_bytes`.
    ///
    /// # Errors
    /// The mesh needs a larger buffer than the adapter can bind.
    pub fn split(&self, scene: &mut Scene, arena_bytes: u64) -> Result<(), GpuError> {
        let left = scene.beside(arena_bytes)()?;
        scene.set_left(Some(left))
    }

    /// Runs the passes that count vertices and triangles, and waits for their results.
    ///
    /// # Errors
    /// The device was lost, or a shader of the user's own took too long.
    pub fn count(&self, scene: &mut Scene, inputs: &Inputs, timing: &mut Timing) -> Result<(), GpuError> {
        scene.tessellator.set(inputs)?;
        if scene.tessellator.needs_count() {
            let mut recorder = Recorder::new(&self.gpu, timing);
            scene.tessellator.count(&mut recorder)?;
            recorder.submit();
        }
        scene.tessellator.read_counts()?;
        match scene.tessellator.stopped_shader() {
            Some(name) => Err(GpuError::OwnStopped(name)),
            None => Ok(()),
        }
    }

    /// Tessellates for the camera's view and draws it. Waits for the counts, but not for the picture.
    ///
    /// # Errors
    /// The device was lost.
    pub fn draw(
        &self,
        scene: &mut Scene,
        target: &Target,
        camera: &Camera,
        settings: &Settings,
        timing: &mut Timing,
    ) -> Result<(), GpuError> {
        let view = camera.lod_view(target.viewport(), &scene.bounds);
        self.draw_for(scene, target, camera, view, settings, timing)
    }

    /// Like [`Self::draw`], tessellated for the view of another camera.
    ///
    /// # Errors
    /// The same.
    pub fn draw_for(
        &self,
        scene: &mut Scene,
        target: &Target,
        camera: &Camera,
        view: LodView,
        settings: &Settings,
        timing: &mut Timing,
    ) -> Result<(), GpuError> {
        for half in SplitSide::BOTH {
            if let Some((scene, settings)) = scene.half_mut(half).zip(settings.half(half)) {
                self.count(scene, &settings.inputs(view), timing)?;
            }
        }
        let mut recorder = Recorder::new(&self.gpu, timing);
        self.renderer.draw(&mut recorder, scene, target, camera, settings)?;
        recorder.submit();
        Ok(())
    }

    /// Walks once over everything that is emitted: each chunk is emitted, read back once, and given to every visitor. Reads
    /// nothing without visitors. The counts must be known.
    ///
    /// # Errors
    /// The device was lost.
    pub fn visit(&self, scene: &mut Scene, visitors: &mut [&mut dyn Visitor]) -> Result<(), GpuError> {
        if visitors.is_empty() {
            return Ok(());
        }
        for index in 0..scene.tessellator.chunk_count() {
            self.visit_chunk(scene, index, visitors)?;
        }
        Ok(())
    }

    /// Gives one chunk of everything that is emitted to every visitor.
    ///
    /// # Errors
    /// The device was lost.
    pub fn visit_chunk(
        &self,
        scene: &mut Scene,
        index: usize,
        visitors: &mut [&mut dyn Visitor],
    ) -> Result<(), GpuError> {
        let mut timing = Timing::Off;
        let mut recorder = Recorder::new(&self.gpu, &mut timing);
        scene.tessellator.emit(&mut recorder, index)?;
        recorder.submit();
        let buffers = scene.tessellator.chunk(index);
        let [first, second] = buffers.vertices();
        let triangle_bytes = u64::from(buffers.chunk.triangle_count) * size_of::<[u32; 3]>() as u64;
        let bytes = read_buffers(&self.gpu, [first, second, (buffers.indices, 0..triangle_bytes)])?;
        self.chunks_read.fetch_add(1, Ordering::Relaxed);
        let (halves, indices) = bytes.split_at(bytes.len() - triangle_bytes as usize);
        let (first_patch, vertices, triangles) = (buffers.chunk.first_patch, vertices_of(halves), cast(indices));
        let chunk = EmittedChunk { first_patch, vertices: &vertices, triangles: &triangles };
        visitors.iter_mut().for_each(|visitor| visitor.take(&chunk));
        Ok(())
    }

    /// How many chunks of output this engine and its clones have read back so far.
    pub fn chunks_read(&self) -> u64 {
        self.chunks_read.load(Ordering::Relaxed)
    }

    /// The factors that every patch was emitted with.
    ///
    /// # Errors
    /// The device was lost.
    pub fn patch_factors(&self, scene: &Scene) -> Result<Vec<PatchFactors>, GpuError> {
        let item = size_of::<PatchFactors>() as u64;
        let parts = scene.tessellator.patch_factors().map(|(buffer, count)| (buffer, 0..u64::from(count) * item));
        Ok(cast(&read_buffers(&self.gpu, parts)?))
    }

    /// The factors that LOD, a file or an LOD shader gave, before the tessellator clamps and rounds them.
    ///
    /// # Errors
    /// The device was lost.
    pub fn asked_factors(&self, scene: &Scene) -> Result<AskedFactors, GpuError> {
        let convention = scene.tessellator.convention();
        match scene.tessellator.given() {
            Some(Given::Factors(given)) => return Ok(AskedFactors::given(convention, given)),
            Some(Given::Shader(_)) => return Ok(AskedFactors::given(convention, &self.own_factors(scene)?)),
            None => {}
        }
        let (buffer, edges) = scene.tessellator.edge_factors();
        let bytes = u64::from(scene.tessellator.buffers().factor_count) * size_of::<f32>() as u64;
        Ok(AskedFactors::new(edges, convention, cast::<f32>(&read_buffer(&self.gpu, buffer, 0, bytes)?)))
    }

    /// The factors that an LOD shader gave every patch, as it gave them; none without such a shader. The counts must be known.
    ///
    /// # Errors
    /// The device was lost.
    pub fn own_factors(&self, scene: &Scene) -> Result<Vec<HullFactors>, GpuError> {
        let Some(buffer) = scene.tessellator.own_factors() else { return Ok(Vec::new()) };
        let patches = scene.tessellator.topology().patches.len();
        let bytes = read_buffer(&self.gpu, buffer, 0, (patches * size_of::<HullFactors>()) as u64)?;
        Ok(cast(&bytes))
    }

    /// How the control points that a surface shader gave the sides of every edge agree; none without such a shader. The counts
    /// must be known.
    ///
    /// # Errors
    /// The device was lost.
    pub(crate) fn own_points_agreement(&self, scene: &Scene) -> Result<Option<PointsAgreement>, GpuError> {
        let (tessellator, topology) = (&scene.tessellator, scene.tessellator.topology());
        if tessellator.surface_shader().is_none() {
            return Ok(None);
        }
        let buffers = tessellator.buffers();
        let bytes = u64::from(buffers.curve_count) * size_of::<CurveNet>() as u64;
        let nets: Vec<CurveNet> = cast(&read_buffer(&self.gpu, &buffers.curve_nets, 0, bytes)?);
        let nets: Vec<_> = nets.iter().map(|net| [net.ab, net.ba].map(Vec3::from)).collect();
        let curves = Curves::build(tessellator.mesh(), topology, buffers.sharing);
        Ok(Some(PointsAgreement::of(topology, &curves, &nets)))
    }

    /// The number of triangles that LOD by error emits at a tolerance of `tolerance_px` px, with all other inputs as they are;
    /// none if the tessellator hasn't enough segments for it. Subtriangulation has one number of segments everywhere, so
    /// that integer partitioning stands in for it. The scene is counted with `inputs` again when this returns.
    ///
    /// # Errors
    /// The device was lost.
    pub fn triangles_by_error(
        &self,
        scene: &mut Scene,
        inputs: &Inputs,
        tolerance_px: f32,
    ) -> Result<Option<u64>, GpuError> {
        let own = inputs.tessellation;
        let partitioning = match own.partitioning {
            Partitioning::Subtriangulation => Partitioning::Integer,
            other => other,
        };
        let by_error = Tessellation { lod: Lod::Error, tolerance: tolerance_px, partitioning, ..own };
        let given = scene.tessellator.given().cloned();
        if given.is_some() {
            scene.tessellator.give(None)?;
        }
        self.count(scene, &Inputs { tessellation: by_error, ..*inputs }, &mut Timing::Off)?;
        let (_, triangles) = scene.tessellator.totals();
        let is_enough = self.factors_capped(scene, &by_error)? == 0;
        if given.is_some() {
            scene.tessellator.give(given)?;
        }
        self.count(scene, inputs, &mut Timing::Off)?;
        Ok(is_enough.then_some(triangles))
    }

    /// The number of factors that ask for more segments than the partitioning has: of edges (sides, if factors are as
    /// published or given), and under LOD by error of insides. The counts must be known.
    ///
    /// # Errors
    /// More patches than the adapter binds memory for, or a lost device.
    pub fn factors_capped(&self, scene: &Scene, tessellation: &Tessellation) -> Result<u64, GpuError> {
        let edges = self.asked_factors(scene)?.beyond(tessellation.partitioning);
        if tessellation.used_lod() != Lod::Error {
            return Ok(edges);
        }
        let written = scene.tessellator.hull_factors()?;
        Ok(edges + written.iter().filter(|factors| factors.inside_is_capped()).count() as u64)
    }

    /// The own least of every patch: the fewest triangles with which it alone would keep the tolerance of LOD by error,
    /// whichever LOD is used. The counts must be known.
    ///
    /// # Errors
    /// More patches than the adapter binds memory for, or a lost device.
    #[cfg(test)]
    pub fn own_least(&self, scene: &mut Scene) -> Result<Vec<u32>, GpuError> {
        let mut timing = Timing::Off;
        let mut recorder = Recorder::new(&self.gpu, &mut timing);
        scene.tessellator.record_own_least(&mut recorder)?;
        recorder.submit();
        let Some(buffer) = scene.tessellator.own_least() else { return Ok(Vec::new()) };
        let bytes = u64::from(scene.tessellator.buffers().patch_count) * size_of::<u32>() as u64;
        Ok(cast(&read_buffer(&self.gpu, buffer, 0, bytes)?))
    }

    /// The whole tessellated mesh, read back. The counts must be known.
    ///
    /// # Errors
    /// The device was lost.
    pub fn read_tessellated(&self, scene: &mut Scene) -> Result<Tessellated, GpuError> {
        let mut out = Tessellated {
            patch_factors: self.patch_factors(scene)?,
            edge_factors: self.asked_factors(scene)?.into_factors(),
            ..Tessellated::default()
        };
        self.visit(scene, &mut [&mut |chunk: &EmittedChunk| out.append(chunk.vertices, chunk.triangles)])?;
        Ok(out)
    }

    /// Times complete recomputations, after one to warm up, and returns each pass's median in ms.
    ///
    /// # Errors
    /// The device was lost.
    pub fn time(
        &self,
        scene: &mut Scene,
        target: &Target,
        camera: &Camera,
        settings: &Settings,
        runs: Runs,
    ) -> Result<Vec<PassTime>, GpuError> {
        let view = camera.lod_view(target.viewport(), &scene.bounds);
        self.time_for(scene, target, camera, view, settings, runs)
    }

    /// Like [`Self::time`], tessellated for the view of another camera.
    ///
    /// # Errors
    /// The same.
    pub fn time_for(
        &self,
        scene: &mut Scene,
        target: &Target,
        camera: &Camera,
        view: LodView,
        settings: &Settings,
        runs: Runs,
    ) -> Result<Vec<PassTime>, GpuError> {
        let mut timing = Timing::on(&self.gpu);
        let mut all: Vec<Vec<PassTime>> = Vec::new();
        let start = Instant::now();
        for run in 0..=runs.most {
            if run > runs.least && start.elapsed() > runs.within {
                break;
            }
            scene.tessellator.forget();
            self.draw_for(scene, target, camera, view, settings, &mut timing)?;
            self.gpu.wait();
            let times = take_times(&self.gpu, &mut timing);
            if run > 0 {
                all.push(times);
            }
        }
        Ok(medians(&all))
    }
}

/// The median of each pass over runs that all have the same passes.
fn medians(runs: &[Vec<PassTime>]) -> Vec<PassTime> {
    let Some(first) = runs.first() else { return Vec::new() };
    let median = |pass: &'static str| {
        let mut ms: Vec<f64> = runs.iter().flatten().filter(|time| time.pass == pass).map(|time| time.ms).collect();
        ms.sort_by(f64::total_cmp);
        PassTime { pass, ms: ms[ms.len() / 2] }
    };
    first.iter().map(|time| median(time.pass)).collect()
}

/// Copies bytes that were read back into values, since the bytes may not be aligned.
fn cast<T: bytemuck::AnyBitPattern + bytemuck::NoUninit>(bytes: &[u8]) -> Vec<T> {
    bytemuck::pod_collect_to_vec(bytes)
}
