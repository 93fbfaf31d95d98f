//! Equal error on screen: our LOD by error with culling, compared with the peer with the white paper's LOD and clipping.

use geometry::tessellate::{Clip, Lod, Partitioning, Tessellation};
use gpu::embed::GpuError;
use gpu::recorder::Timing;
use inspect::engine::Engine;
use inspect::engine::measurements::Measurements;
use inspect::settings::Settings;
use inspect::settings::options::TOLERANCE_RANGE;

use super::Scale;
use super::numbers::{ms, or_none, ratio, table, whole};
use super::ours::{OurTimes, Subject};
use super::peer::Peer;
use super::subjects::{subject, tori};
use super::versus::{BenchError, PeerTimes, Versus};

/// The px per segment that the white paper's LOD is asked for: coarse, fine enough that no edges are visible, and micropolygons.
pub(crate) const PAPER_PIXELS: [f32; 3] = [8.0, 2.0, 1.0];
/// How often the range of tolerances is halved, on a logarithmic scale.
const TRIES: u32 = 12;

/// The measurements of one scene.
pub(crate) struct EqualError {
    pub scene: String,
    /// The px per segment of the white paper's LOD.
    pub paper_pixels: f32,
    /// The triangles, and the largest errors in px: the white paper's, then ours.
    pub triangles: [u64; 2],
    pub px: [f64; 2],
    /// Our tolerance in px.
    pub tolerance: f32,
    pub ours: OurTimes,
    /// The time of drawing the mesh without tessellation, in ms: the least that clearing, shading and resolving take.
    pub least: f64,
    /// Our times with the white paper's LOD, for comparison.
    pub ours_paper: OurTimes,
    pub peer: Option<PeerTimes>,
}

impl EqualError {
    /// Their time divided by ours, each minus [`Self::least`].
    fn faster_beyond(&self) -> Option<f64> {
        let peer = self.peer.as_ref()?;
        let [theirs, ours] = [peer.frame.median, self.ours.frame.median].map(|ms| ms - self.least);
        (ours > 0.0).then_some(theirs / ours)
    }

    /// Their time divided by ours, by the GPU's clock and by the host's.
    pub(crate) fn faster(&self) -> Option<[f64; 2]> {
        let ratios =
            |peer: &PeerTimes| [peer.frame.median / self.ours.frame.median, peer.wall.median / self.ours.wall.median];
        self.peer.as_ref().map(ratios)
    }
}

/// Returns the table of all scenes.
pub(crate) fn table_of(scenes: &[EqualError]) -> String {
    let row = |scene: &EqualError| {
        let (ours, theirs) = (&scene.ours, scene.peer.as_ref());
        vec![
            scene.scene.clone(),
            scene.paper_pixels.to_string(),
            whole(scene.triangles[0]),
            whole(scene.triangles[1]),
            format!("{:.3}", scene.px[0]),
            format!("{:.3}", scene.px[1]),
            format!("{:.3}", scene.tolerance),
            or_none(theirs.map(|peer| peer.frame.to_string())),
            scene.ours_paper.frame.to_string(),
            ours.frame.to_string(),
            or_none(theirs.map(|peer| ratio(peer.frame.median, ours.frame.median))),
            ms(scene.least),
            or_none(scene.faster_beyond().map(|faster| format!("{faster:.2}"))),
            or_none(theirs.map(|peer| peer.wall.to_string())),
            ours.wall.to_string(),
            or_none(theirs.map(|peer| ratio(peer.wall.median, ours.wall.median))),
        ]
    };
    let head = "scene | theirs, px per segment | theirs, triangles | ours, triangles | theirs, px | ours, px | our tolerance, px \
                | theirs, GPU | ours with their LOD, GPU | ours, GPU | theirs / ours | without tessellation, GPU \
                | theirs / ours beyond that | theirs, host | ours, host | theirs / ours";
    table(head, &scenes.iter().map(row).collect::<Vec<_>>())
}

/// Measures all scenes.
///
/// # Errors
/// A device was lost, or has no memory.
pub(crate) fn measure(engine: &Engine, peer: Option<&Peer>, scale: &Scale) -> Result<Vec<EqualError>, BenchError> {
    let mut all = Vec::new();
    let field = scale.field;
    for (name, columns, side, nearer) in
        [("a torus", 16, 1, 1.0), ("a torus from near", 64, 1, 0.4), ("a field of tori", 16, field, 1.0)]
    {
        let mut subject = subject(engine, tori(columns, side), scale.size, scale.arena_bytes)?;
        subject.camera.distance *= nearer;
        let patches = u64::from(subject.scene.tessellator.buffers().patch_count);
        let scene = format!("{name}, {} patches", whole(patches));
        for paper_pixels in PAPER_PIXELS {
            all.push(equal(engine, peer, scale, &mut subject, (scene.clone(), paper_pixels))?);
        }
    }
    Ok(all)
}

fn equal(
    engine: &Engine,
    peer: Option<&Peer>,
    scale: &Scale,
    subject: &mut Subject,
    (scene, paper_pixels): (String, f32),
) -> Result<EqualError, BenchError> {
    subject.settings = Settings::from(Tessellation {
        lod: Lod::Paper,
        pixels: paper_pixels,
        clip: Clip::Paper,
        ..Tessellation::default()
    });
    let paper_px = deviation(engine, subject)?;
    let paper = Versus::measure(engine, peer, subject, scale.effort)?;
    subject.settings = Settings::from(Tessellation {
        lod: Lod::Error,
        partitioning: Partitioning::Integer,
        clip: Clip::Frustum,
        cull_back_faces: true,
        ..Tessellation::default()
    });
    let (tolerance, px) = largest_tolerance(engine, subject, paper_px)?;
    let ours = Versus::measure(engine, None, subject, scale.effort)?;
    let error = subject.settings;
    subject.settings = error.with(Tessellation { lod: Lod::Uniform, factor: 1.0, ..error.tessellation });
    let least = Versus::measure(engine, None, subject, scale.effort)?.ours.draw.median;
    subject.settings = error;
    Ok(EqualError {
        scene,
        paper_pixels,
        triangles: [paper.triangles, ours.triangles],
        px: [paper_px, px],
        tolerance,
        ours: ours.ours,
        least,
        ours_paper: paper.ours,
        peer: paper.peer,
    })
}

/// Finds a tolerance with a largest error of at most `most` px, and sets it. Returns the tolerance and its error. It may not be
/// the largest such tolerance, since errors don't grow with every step of the tolerance.
fn largest_tolerance(engine: &Engine, subject: &mut Subject, most: f64) -> Result<(f32, f64), GpuError> {
    let (mut low, mut high) = (TOLERANCE_RANGE.least, TOLERANCE_RANGE.most);
    for _ in 0..TRIES {
        subject.settings.tessellation.tolerance = (low * high).sqrt();
        if deviation(engine, subject)? <= most {
            low = subject.settings.tessellation.tolerance;
        } else {
            high = subject.settings.tessellation.tolerance;
        }
    }
    subject.settings.tessellation.tolerance = low;
    Ok((low, deviation(engine, subject)?))
}

/// The largest error of what is emitted, in px.
fn deviation(engine: &Engine, subject: &mut Subject) -> Result<f64, GpuError> {
    let view = subject.camera.lod_view(subject.target.viewport(), &subject.scene.bounds);
    let inputs = subject.settings.inputs(view);
    engine.count(&mut subject.scene, &inputs, &mut Timing::Off)?;
    let wanted = Measurements { screen_error: Some(&inputs), ..Measurements::default() };
    let results = engine.measure_all(&mut subject.scene, &wanted)?;
    Ok(results.screen_error.map_or(0.0, |worst| worst.value))
}
