//! One tile: drawn, measured and timed.

use image::{DynamicImage, RgbImage};

use crate::engine::{Engine, Loaded, MeasurementResults, Measurements, Runs};
use crate::gpu::{DRAWING, GpuError, PassTime, Timing};
use crate::measure::{CrackedEdge, Measured};
use crate::render::layout::{CRACK_COLOR, linear};
use crate::render::{Camera, LineSegment, Scene, Target, crack_lines_in};
use crate::settings::{Overlays, Settings};
use crate::tessellate::{Displacement, Inputs, Lod, Tessellation};

/// Triangles in a tile, about: a mesh of many gets lower factors, since no tile has px for more.
const MOST_TRIANGLES: f32 = 2e6;

/// Gaps at least this wide, in px, are drawn as visible cracks.
const VISIBLE_PX: f64 = 0.5;
/// The sRGB colour of edges whose gaps are narrower than that.
const CALM_COLOR: [u8; 3] = [120, 160, 205];

/// Px to either side of the line of a crack that can be seen, and of one that can't: thinner than in the window, as tiles are
/// small.
const HALF_WIDTHS: [f32; 2] = [1.25, 0.75];

/// What an exhibit's tiles have in common.
pub(super) struct Wall<'a> {
    pub engine: &'a Engine,
    pub target: &'a Target,
    pub camera: &'a Camera,
    pub overlays: Overlays,
}

/// What one tile showed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Shown {
    pub factor: f32,
    pub triangles: u64,
    /// The largest distance on screen between what was drawn and its surface, in px; none if nothing is in view.
    pub error_px: Option<f64>,
    /// Edge points whose positions differ in at least one bit, and the widest gap in px and object units.
    pub different_bits: u64,
    pub max_gap_px: f64,
    pub max_gap: f64,
    /// Edge points whose normals differ though the mesh's agree.
    pub different_normals: u64,
    pub folds: u64,
    /// Of all passes but the draw, and of the draw without marks: medians.
    pub tessellation_ms: f64,
    pub draw_ms: f64,
}

/// The same with a factor that the mesh isn't too large for; a whole one, if it has to be lower than asked.
pub(super) fn affordable(inputs: &Inputs, scene: &Scene) -> Inputs {
    // The tessellator makes about 1.5 triangles a patch for each square of the factor.
    let most = (MOST_TRIANGLES / (1.5 * scene.tessellator.topology().patches.len().max(1) as f32)).sqrt();
    debug_assert!(inputs.tessellation.lod == Lod::Uniform);
    Inputs {
        tessellation: Tessellation {
            factor: if inputs.tessellation.factor > most { most.floor().max(1.0) } else { inputs.tessellation.factor },
            ..inputs.tessellation
        },
        ..*inputs
    }
}

pub(super) fn draw_tile(
    wall: &Wall,
    settings: Settings,
    loaded: &Loaded,
    scene: &mut Scene,
) -> Result<(RgbImage, Shown), GpuError> {
    let &Wall { engine, target, camera, overlays } = wall;
    let view = camera.lod_view(target.viewport(), &scene.bounds);
    let inputs = affordable(&settings.inputs(view), scene);
    let settings = settings.with(Tessellation { factor: inputs.tessellation.factor, ..settings.tessellation });
    scene.set_lines(&engine.gpu, &[]);
    let passes = engine.time(scene, target, camera, &settings, Runs::default())?;
    // What patches agree on isn't on the surface that each has by itself, which the error is measured against.
    let is_shared = matches!(settings.tessellation.displacement, Displacement::On | Displacement::AsPublished);
    let wanted =
        Measurements { survey: true, screen_error: (!is_shared).then_some(&inputs), ..Measurements::default() };
    let MeasurementResults { survey, screen_error, .. } = engine.measure_all(scene, &wanted)?;
    let (measured, error_px) = (survey.unwrap_or_default(), screen_error.map(|worst| worst.px));
    let clip_from_object = camera.clip_from_object(target.viewport(), &scene.bounds);
    if overlays.cracks {
        let gap_px = |crack: &CrackedEdge| crack.gap_px(clip_from_object, target.viewport());
        scene.set_lines(&engine.gpu, &crack_lines(&measured, loaded, gap_px));
    }
    engine.draw(scene, target, camera, &Settings { overlays, ..settings }, &mut Timing::Off)?;
    let shown = Shown {
        factor: settings.tessellation.factor,
        triangles: scene.tessellator.totals().1,
        error_px,
        different_bits: measured.cracks.different_bits,
        max_gap_px: measured.cracks.max_gap_px(clip_from_object, target.viewport()),
        max_gap: measured.cracks.max_gap(),
        different_normals: measured.cracks.different_normals,
        folds: measured.folds,
        tessellation_ms: ms(&passes, |pass| !DRAWING.contains(&pass)),
        draw_ms: ms(&passes, |pass| DRAWING.contains(&pass)),
    };
    Ok((DynamicImage::from(target.read(&engine.gpu)?).to_rgb8(), shown))
}

/// Cracked edges in two classes, those that can be seen over those that can't.
fn crack_lines(measured: &Measured, loaded: &Loaded, gap_px: impl Fn(&CrackedEdge) -> f64) -> Vec<LineSegment> {
    let is_calm = |crack: &CrackedEdge| gap_px(crack) < VISIBLE_PX;
    let color = |crack: &CrackedEdge| if is_calm(crack) { CALM_COLOR } else { CRACK_COLOR };
    let mut lines = crack_lines_in(measured, &loaded.topology, color);
    let calm = linear(CALM_COLOR);
    lines.sort_by_key(|line| line.color != calm);
    let [seen, unseen] = HALF_WIDTHS;
    lines.iter_mut().for_each(|line| line.half_width = if line.color == calm { unseen } else { seen });
    lines
}

fn ms(passes: &[PassTime], which: impl Fn(&str) -> bool) -> f64 {
    passes.iter().filter(|time| which(time.pass)).map(|time| time.ms).sum()
}
