//! Draws, measures and times one tile.

use image::{DynamicImage, RgbImage};

use geometry::tessellate::{Inputs, Tessellation};
use gpu::{GpuError, Timing, ms_of};
use inspect::engine::{Engine, Loaded, MeasurementResults, Measurements, Runs};
use inspect::measure::{CrackedEdge, Measured};
use inspect::render::layout::{CRACK_COLOR, linear};
use inspect::render::{Camera, LineSegment, Scene, Target, crack_lines_in};
use inspect::settings::{Overlays, Settings};

/// About the most triangles in a tile. Larger meshes get lower factors, since a tile has no pixels for more triangles.
const MOST_TRIANGLES: f32 = 2e6;

/// Gaps of at least this width, in px, are drawn as visible cracks.
const VISIBLE_PX: f64 = 0.5;
/// The sRGB colour of edges whose gaps are narrower.
const NARROW_COLOR: [u8; 3] = [120, 160, 205];

/// Half the width in px of the lines for visible and for narrower cracks. They are thinner than in the window, since tiles are
/// small.
const HALF_WIDTHS: [f32; 2] = [1.25, 0.75];

/// The measurements of one tile.
#[derive(Clone, Debug, PartialEq)]
pub struct TileResults {
    pub factor: f32,
    pub triangles: u64,
    /// The largest distance on screen between what was drawn and the surface that it approximates, in px; `None` if nothing is
    /// in view, or if patches agree on heights.
    pub error_px: Option<f64>,
    /// Edge points whose positions differ between sides in at least one bit, and the widest gap in px and in object units.
    pub different_bits: u64,
    pub max_gap_px: f64,
    pub max_gap: f64,
    /// Edge points whose normals differ between sides although the mesh's normals agree.
    pub different_normals: u64,
    pub folds: u64,
    /// The median times of all passes but the draw, and of the draw without marks.
    pub tessellation_ms: f64,
    pub draw_ms: f64,
}

/// The inputs with a factor at which the mesh makes no more than about [`MOST_TRIANGLES`]. A lowered factor is whole.
pub(super) fn affordable(inputs: &Inputs, scene: &Scene) -> Inputs {
    // The tessellator makes about 1.5 times the square of the factor triangles in a patch.
    let most = (MOST_TRIANGLES / (1.5 * scene.tessellator.topology().patches.len().max(1) as f32)).sqrt();
    debug_assert!(!inputs.tessellation.lod.follows_view());
    let own = inputs.tessellation;
    let factor = if own.factor > most { most.floor().max(1.0) } else { own.factor };
    Inputs { tessellation: Tessellation { factor, ..own }, ..*inputs }
}

/// Times and measures a tile, and draws it with overlays. Returns its picture and its results.
pub(super) fn draw_tile(
    engine: &Engine,
    target: &Target,
    camera: &Camera,
    (settings, overlays): (Settings, Overlays),
    loaded: &Loaded,
    scene: &mut Scene,
) -> Result<(RgbImage, TileResults), GpuError> {
    let view = camera.lod_view(target.viewport(), &scene.bounds);
    let inputs = affordable(&settings.inputs(view), scene);
    let settings = settings.with(Tessellation { factor: inputs.tessellation.factor, ..settings.tessellation });
    scene.set_lines(&engine.gpu, &[]);
    let passes = engine.time(scene, target, camera, view, &settings, Runs::default())?;
    // Points that patches agree on leave the surface that each patch has by itself, which the error is measured from.
    let is_shared = settings.tessellation.displacement.shares_heights();
    let wanted =
        Measurements { survey: true, screen_error: (!is_shared).then_some(&inputs), ..Measurements::default() };
    let MeasurementResults { survey, screen_error, .. } = engine.measure_all(scene, &wanted)?;
    let (measured, error_px) = (survey.unwrap_or_default(), screen_error.map(|worst| worst.value));
    let clip_from_object = camera.clip_from_object(target.viewport(), &scene.bounds);
    if overlays.cracks {
        let gap_px = |crack: &CrackedEdge| crack.gap_px(clip_from_object, target.viewport());
        scene.set_lines(&engine.gpu, &crack_lines(&measured, loaded, gap_px));
    }
    engine.draw(scene, target, camera, &Settings { overlays, ..settings }, &mut Timing::Off)?;
    let results = TileResults {
        factor: settings.tessellation.factor,
        triangles: scene.tessellator.totals().1,
        error_px,
        different_bits: measured.cracks.different_bits,
        max_gap_px: measured.cracks.max_gap_px(clip_from_object, target.viewport()),
        max_gap: measured.cracks.max_gap(),
        different_normals: measured.cracks.different_normals,
        folds: measured.folds,
        tessellation_ms: ms_of(&passes, false),
        draw_ms: ms_of(&passes, true),
    };
    Ok((DynamicImage::from(target.read(&engine.gpu)?).to_rgb8(), results))
}

/// The lines of cracked edges, in two classes. Visible cracks are drawn over narrower ones.
fn crack_lines(measured: &Measured, loaded: &Loaded, gap_px: impl Fn(&CrackedEdge) -> f64) -> Vec<LineSegment> {
    let color = |crack: &CrackedEdge| if gap_px(crack) < VISIBLE_PX { NARROW_COLOR } else { CRACK_COLOR };
    let mut lines = crack_lines_in(measured, &loaded.topology, color);
    let narrow = linear(NARROW_COLOR);
    lines.sort_by_key(|line| line.color != narrow);
    let [visible_width, narrow_width] = HALF_WIDTHS;
    lines.iter_mut().for_each(|line| line.half_width = if line.color == narrow { narrow_width } else { visible_width });
    lines
}
