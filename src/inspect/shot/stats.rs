//! The JSON of `pnaen render --stats`.

use std::collections::BTreeMap;

use glam::{Mat4, Vec4};
use serde::{Serialize, Serializer};

use super::factors_report::FactorsFile;
use super::reference::ReferenceStats;
use super::reference_surface::{AccuracyStats, DeviationStats};
use super::user_shader_report::{LodShaderStats, SurfaceShaderStats};
use super::{Numbers, Shot, ShotError};
use crate::engine::{Engine, Loaded, Runs};
use crate::gates::{GateKind, Judgement};
use crate::measure::{Measured, OutlineDistance, SeamTurns, Seams, Silhouette};
use crate::render::{Camera, Scene};
use crate::settings::{Settings, SplitSide, Value, options};
use geometry::mesh::{Bounds, EdgeCounts, Topology};
use geometry::tessellate::{Inputs, Tessellation};
use geometry::view::{ScreenView, ulp};
use gpu::GpuError;

/// What was done and what it cost. Times are medians in ms.
#[derive(Debug, Serialize)]
pub struct Stats {
    /// The name of the view, if there are several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub view: Option<String>,
    adapter: String,
    #[serde(flatten)]
    right: HalfStats,
    points: u64,
    corners: u64,
    edges: EdgeCounts,
    degenerate: u32,
    /// Triangles' corners without a normal in the file, which are smooth up to the crease angle.
    normals_made: u32,
    bytes: Bytes,
    /// Px through which one can see into the mesh; none if it is open, reaches the near plane, or patches that face away were
    /// left out.
    leaks: Option<u64>,
    /// Patches that LOD by error shows as one triangle because their surface is flat, though its points slide: their error is
    /// the distance to the nearest point of the surface. None if errors weren't measured.
    patches_flat: Option<u64>,
    /// What LOD by error would have needed; none if the error wasn't measured, is 0, or is less than LOD by error reaches
    /// with the segments that there are.
    lod_comparison: Option<LodComparison>,
    /// Factors that ask for more segments than the partitioning has: those of edges, or of sides if factors are as published
    /// or from a file; under LOD by error, inside factors as well.
    factors_capped: u64,
    /// What was found about the factors of a file, if they came from one.
    pub factors_file: Option<FactorsFile>,
    /// What was found about the factors of an LOD shader, if they came from one.
    lod_shader: Option<LodShaderStats>,
    /// What was found about the control points of a surface shader, if they came from one.
    surface_shader: Option<SurfaceShaderStats>,
    /// How far the outline is from others, if the silhouette is shown.
    silhouette: Option<SilhouetteStats>,
    /// The left half of a split view; all else here is about the right half.
    left: Option<HalfStats>,
    /// Where it is seen from.
    camera: Option<ViewStats>,
    /// How the picture differs from its reference, if it has one.
    pub reference: Option<ReferenceStats>,
    /// How the gates of `--fail-on` judged.
    gates: Vec<Judgement>,
}

/// What was drawn, in the options' names: each with its value, or null if it has no effect.
#[derive(Debug)]
struct SettingsStats(Vec<(String, Value)>);

impl Serialize for SettingsStats {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, value)| (name, value)))
    }
}

impl SettingsStats {
    /// `has_shader`: a surface shader takes the place of the surface. One of the gates that `judged` may compare with a tolerance
    /// that LOD doesn't use.
    fn new(settings: &Settings, has_shader: bool, judged: &[Judgement]) -> Self {
        let own = settings.tessellation;
        let used = settings.with(Tessellation { lod: own.used_lod(), ..own });
        let is_compared = judged.iter().any(|gate| gate.kind == GateKind::AboveTolerance);
        // A factor that isn't used is known all the same.
        let always = [options::LOD.name, options::FACTOR.name];
        let mut all = Vec::new();
        for option in options::TESSELLATION {
            let is_used = (option.no_effect)(settings).is_none()
                || always.contains(&option.name)
                || is_compared && option.name == options::TOLERANCE.name;
            let shown = |value| if is_used { value } else { Value::Unset };
            all.extend(option.written(&used).into_iter().map(|(name, value)| (name, shown(value))));
            if option.name == options::SURFACE.name && has_shader {
                all[0].1 = Value::Name("surface-shader");
            }
            // It isn't saved with the others.
            if option.name == options::DISPLACEMENT.name {
                all.push((option.name.to_owned(), option.get(settings)));
            }
        }
        Self(all)
    }
}

#[derive(Debug, Serialize)]
struct AnimationStats {
    name: String,
    /// s.
    time: f64,
}

/// Memory, in bytes.
#[derive(Debug, Serialize)]
struct Bytes {
    /// Corners and triangles as loaded.
    input: u64,
    /// Points, patches, edges, nets, factors and counts on the device.
    topology: u64,
    /// Output on the device.
    arena: u64,
}

impl Bytes {
    fn new(Loaded { mesh, .. }: &Loaded, scene: &Scene) -> Self {
        Self {
            input: (size_of_val(&mesh.corners[..]) + size_of_val(&mesh.triangles[..])) as u64,
            topology: scene.tessellator.buffers().bytes() + scene.work_bytes(),
            arena: scene.tessellator.arena_bytes(),
        }
    }
}

#[derive(Debug, Serialize)]
pub(crate) struct CrackStats {
    edge_points: u64,
    edges_compared: u64,
    different_bits: u64,
    different_factors: u64,
    different_normals: u64,
    /// Object units.
    max_gap: f64,
    /// In units of the last place of the mesh's largest coordinate.
    max_gap_ulp: f64,
    max_gap_px: f64,
    edges: u64,
}

impl CrackStats {
    /// As seen from `view`.
    pub(crate) fn new(measured: &Measured, topology: &Topology, view: ScreenView) -> Self {
        let cracks = &measured.cracks;
        Self {
            edge_points: cracks.edge_points,
            edges_compared: cracks.edges_compared,
            different_bits: cracks.different_bits,
            different_factors: cracks.different_factors,
            different_normals: cracks.different_normals,
            max_gap: cracks.max_gap(),
            max_gap_ulp: cracks.max_gap() / ulp(topology),
            max_gap_px: cracks.max_gap_px(view.clip_from_object, view.viewport),
            edges: cracks.cracked().len() as u64,
        }
    }
}

/// Angles between the shading normals of both sides of uv seams and split normals.
#[derive(Debug, Serialize)]
struct SeamStats {
    #[serde(flatten)]
    shading: SeamTurnStats,
    /// The same under normal maps; null if no seam has one.
    mapped: Option<SeamTurnStats>,
}

#[derive(Debug, Serialize)]
struct SeamTurnStats {
    edges: u64,
    points: u64,
    max_degrees: f64,
    mean_degrees: f64,
    /// Of the mesh's own normals, at the same places.
    source_max_degrees: f64,
    source_mean_degrees: f64,
    /// The most by which the tessellation's angle at a point is larger than the mesh's.
    max_added_degrees: f64,
}

impl SeamStats {
    fn new(seams: &Seams) -> Self {
        let stats = |turns: &SeamTurns| SeamTurnStats {
            edges: turns.edges,
            points: turns.points,
            max_degrees: turns.emitted.most,
            mean_degrees: turns.mean(turns.emitted),
            source_max_degrees: turns.source.most,
            source_mean_degrees: turns.mean(turns.source),
            max_added_degrees: turns.most_added,
        };
        Self { shading: stats(&seams.shading), mapped: (seams.mapped.edges > 0).then(|| stats(&seams.mapped)) }
    }
}

/// The largest distances of the triangles' outline from others, in px; none where the picture doesn't show both outlines. Places
/// are in px from the picture's top left.
#[derive(Debug, Serialize)]
struct SilhouetteStats {
    from_source_px: Option<f64>,
    from_source_at: Option<[f64; 2]>,
    from_surface_px: Option<f64>,
    from_surface_at: Option<[f64; 2]>,
    /// Samples along a side of a px.
    samples_per_px: u32,
}

impl SilhouetteStats {
    /// `mirrored` is the width of the picture in px if it was mirrored after the outlines were found.
    fn new(silhouette: &Silhouette, mirrored: Option<u32>) -> Self {
        let shown = |[x, y]: [f64; 2]| [mirrored.map_or(x, |width| f64::from(width) - x), y];
        let place = |distance: Option<OutlineDistance>| distance.map(|distance| shown(distance.at.to_array()));
        let distances = &silhouette.distances;
        Self {
            from_source_px: distances.from_source.map(|distance| distance.px),
            from_source_at: place(distances.from_source),
            from_surface_px: distances.from_surface.map(|distance| distance.px),
            from_surface_at: place(distances.from_surface),
            samples_per_px: silhouette.grid.per_px,
        }
    }
}

/// A camera in numbers: the matrix that a picture was drawn with, as `--view-projection` takes it.
#[derive(Clone, Debug, Serialize)]
struct ViewStats {
    /// `perspective` or `orthographic`.
    kind: &'static str,
    /// In object units; none in an orthographic view.
    eye: Option<[f32; 3]>,
    /// The unit direction that it looks in.
    direction: [f32; 3],
    /// The size of the picture, in px.
    viewport: [u32; 2],
    /// From object units to clip space, listed as `matrix_order` says.
    view_projection: [f32; 16],
    matrix_order: &'static str,
    depth: &'static str,
    clip_y: &'static str,
}

impl ViewStats {
    /// The camera that draws a picture of a mesh with these bounds.
    fn new(camera: &Camera, viewport: [u32; 2], bounds: &Bounds) -> Self {
        let mut matrix = camera.clip_from_object(viewport.map(|side| side as f32).into(), bounds);
        if camera.is_mirrored() {
            // What was drawn was mirrored afterwards.
            matrix = Mat4::from_diagonal(Vec4::new(-1.0, 1.0, 1.0, 1.0)) * matrix;
        }
        let [_, _, back] = camera.axes();
        // Without the sign of zeros.
        let unsigned = |number: f32| 0.0 + number;
        Self {
            kind: if camera.orthographic { "orthographic" } else { "perspective" },
            eye: (!camera.orthographic).then(|| camera.eye().to_array()),
            direction: back.to_array().map(|number| unsigned(-number)),
            viewport,
            view_projection: matrix.to_cols_array().map(unsigned),
            matrix_order: "column-major",
            depth: "reversed",
            clip_y: "up",
        }
    }
}

/// What was emitted beside what LOD by error would have emitted for the same largest error.
#[derive(Clone, Copy, Debug, Serialize)]
struct LodComparison {
    /// The measured error, taken as LOD by error's tolerance, in px.
    tolerance_px: f32,
    /// What LOD by error emits.
    triangles: u64,
    /// How many times as many triangles were emitted; none if LOD by error emits none.
    times: Option<f64>,
}

impl LodComparison {
    /// Compares what the scene emits with what LOD by error would emit within this tolerance.
    ///
    /// # Errors
    /// The device was lost.
    fn new(engine: &Engine, scene: &mut Scene, inputs: &Inputs, tolerance_px: f32) -> Result<Option<Self>, GpuError> {
        let (_, triangles_out) = scene.tessellator.totals();
        let triangles = engine.triangles_by_error(scene, inputs, tolerance_px)?;
        let times = |triangles| (triangles > 0).then(|| triangles_out as f64 / triangles as f64);
        Ok(triangles.map(|triangles| Self { tolerance_px, triangles, times: times(triangles) }))
    }
}

/// What is measured of either half of a split picture.
#[derive(Debug, Serialize)]
struct HalfStats {
    /// The left half's mesh, if it is another one.
    #[serde(skip_serializing_if = "Option::is_none")]
    mesh: Option<String>,
    settings: SettingsStats,
    /// What parts and materials have in place of settings, as `--part` has it.
    parts: Vec<String>,
    #[serde(flatten)]
    numbers: Numbers,
    /// Patches that are left out for any reason.
    patches_culled: u32,
    patches_out_of_view: u32,
    patches_facing_away: u32,
    /// Patches drawn with factors that are all below 2, edges and inside.
    patches_below_factor_2: u32,
    /// Emitted triangles that are neither wholly outside one side of the view nor cut by its near plane.
    triangles_in_view: u64,
    /// Those of them that cover less than 4.5 px² (half of a square of 3 px).
    triangles_below_3_px: u64,
    cracks: CrackStats,
    seams: SeamStats,
    /// Triangles that face away from the side that their patch faces.
    folds: u64,
    /// Vertices with a position or uv that is no finite number.
    not_finite: u64,
    /// The largest distance on screen between what was emitted and its surface, in px; none if it wasn't measured, or
    /// nothing is in view.
    max_error_px: Option<f64>,
    /// The distance to the reference surface, if there is one.
    accuracy: Option<AccuracyStats>,
    /// What the deviation overlay shows, if it is on.
    deviation: Option<DeviationStats>,
    /// None at rest.
    animation: Option<AnimationStats>,
    /// What each pass takes if the half is drawn alone, in ms; of the right half also what loading took.
    ms: BTreeMap<&'static str, f64>,
}

impl Shot {
    /// The stats of the picture, which must have been drawn with stats wanted; none if nothing was measured. Draws it several
    /// times more to time it.
    ///
    /// # Errors
    /// The device was lost.
    pub fn stats(&mut self) -> Result<Option<Stats>, ShotError> {
        let mut halves = SplitSide::BOTH.map(|half| self.half_stats(half));
        let (engine, target, scene) = (&self.engine, &self.target, &mut self.scene);
        let (settings, camera, lod_view) = (&self.subject.settings, &self.view.camera, self.lod_view);
        let results = self.results[SplitSide::Right as usize].as_ref();
        let Some((results, measured)) = results.and_then(|own| Some((own, own.survey.as_ref()?))) else {
            return Ok(None);
        };
        for (half, stats) in SplitSide::BOTH.into_iter().zip(&mut halves) {
            let Some((scene, stats)) = scene.half_mut(half).zip(stats.as_mut()) else { continue };
            let alone = Settings { split: None, ..settings.half(half).unwrap_or(*settings) };
            let passes = engine.time(scene, target, camera, lod_view, &alone, Runs::default())?;
            stats.ms = passes.iter().map(|time| (time.pass, time.ms)).collect();
        }
        let [left, Some(mut right)] = halves else { return Ok(None) };
        let leaks = engine.leaks(scene, measured, target.size, camera)?;
        let factors_capped = engine.factors_capped(scene, &settings.tessellation)?;
        let lod_shader = LodShaderStats::new(engine, scene)?;
        let surface_shader = SurfaceShaderStats::new(engine, scene)?;
        let bytes = Bytes::new(&self.posed, scene);
        let lod_comparison = match right.max_error_px.map(|px| px as f32).filter(|px| *px > 0.0) {
            Some(px) => LodComparison::new(engine, scene, &settings.inputs(lod_view), px)?,
            None => None,
        };
        let Loaded { mesh, topology, .. } = &self.posed;
        right.ms.extend([("load", self.posed.load_ms), ("topology", self.posed.topology_ms)]);
        let mirrored = camera.is_mirrored().then_some(self.view.size[0]);
        Ok(Some(Stats {
            // The name of the view, the reference picture and the factors file are known to those who draw.
            view: None,
            reference: None,
            factors_file: None,
            adapter: engine.gpu.info.name.clone(),
            right,
            points: topology.points.len() as u64,
            corners: mesh.corners.len() as u64,
            edges: topology.edge_counts(),
            degenerate: topology.degenerate,
            normals_made: self.posed.read.repairs.normals_made,
            bytes,
            leaks,
            patches_flat: results.flat_patches,
            lod_comparison,
            factors_capped,
            lod_shader,
            surface_shader,
            silhouette: self.silhouette.as_ref().map(|silhouette| SilhouetteStats::new(silhouette, mirrored)),
            left,
            camera: Some(ViewStats::new(camera, self.view.size, &self.scene.bounds)),
            gates: self.judged.clone(),
        }))
    }

    fn half_stats(&self, half: SplitSide) -> Option<HalfStats> {
        let settings = self.subject.settings.half(half)?;
        let (scene, results) = self.scene.half(half).zip(self.results(half))?;
        let (tessellator, measured) = (&scene.tessellator, results.survey.as_ref()?);
        let is_right = half == SplitSide::Right;
        let judged = if is_right { &self.judged[..] } else { &[] };
        let topology = if is_right { &self.posed.topology } else { tessellator.topology() };
        let other = self.subject.left.as_ref().filter(|_| !is_right);
        Some(HalfStats {
            mesh: other.map(|left| left.source.to_string()),
            settings: SettingsStats::new(&settings, tessellator.surface_shader().is_some(), judged),
            parts: other.unwrap_or(&self.posed).preparation.parts.style_texts().collect(),
            numbers: Numbers::new(scene),
            patches_culled: measured.culled.total(),
            patches_out_of_view: measured.culled.out_of_view,
            patches_facing_away: measured.culled.facing_away,
            patches_below_factor_2: measured.patches_low,
            triangles_in_view: results.sizes.map_or(0, |sizes| sizes.in_view),
            triangles_below_3_px: results.sizes.map_or(0, |sizes| sizes.small),
            cracks: CrackStats::new(measured, topology, self.view()),
            seams: SeamStats::new(&measured.seams),
            folds: measured.folds,
            not_finite: measured.not_finite,
            max_error_px: results.screen_error.map(|worst| worst.value),
            accuracy: self.accuracy(half),
            deviation: self.deviation(half),
            animation: scene.clip_and_time().map(|(name, time)| AnimationStats { name, time }),
            ms: BTreeMap::new(),
        })
    }
}
