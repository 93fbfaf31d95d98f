//! The steps of a picture: what each render pass draws, and in which half.

use super::Scene;
use crate::settings::{Settings, SplitSide};

/// What one render pass of a picture draws.
pub(super) enum Step {
    /// Only the background, since nothing is emitted.
    Nothing,
    /// The triangles of a half's chunk.
    Surface(SplitSide, usize),
    /// The normals of a half's chunk.
    Normals(SplitSide, usize),
}

impl Step {
    pub(super) fn half(&self) -> SplitSide {
        match self {
            Self::Nothing => SplitSide::Right,
            Self::Surface(half, _) | Self::Normals(half, _) => *half,
        }
    }

    pub(super) fn chunk(&self) -> Option<usize> {
        match self {
            Self::Nothing => None,
            Self::Surface(_, chunk) | Self::Normals(_, chunk) => Some(*chunk),
        }
    }
}

/// All steps of a picture, in order.
pub(super) fn steps(scene: &Scene, settings: &Settings) -> Vec<Step> {
    let chunks = |half| {
        let drawn = settings.half(half).and(scene.half(half));
        (0..drawn.map_or(0, |drawn| drawn.tessellator.chunk_count())).map(move |chunk| (half, chunk))
    };
    let all: Vec<_> = SplitSide::BOTH.into_iter().flat_map(chunks).collect();
    if all.is_empty() {
        return vec![Step::Nothing];
    }
    let with_normals = if settings.overlays.normals { all.len() } else { 0 };
    let surfaces = all.iter().map(|&(half, chunk)| Step::Surface(half, chunk));
    surfaces.chain(all[..with_normals].iter().map(|&(half, chunk)| Step::Normals(half, chunk))).collect()
}

/// The rectangles left and right of the split: x, y, width and height in px.
pub(super) fn halves([width, height]: [u32; 2], split: Option<f32>) -> [[u32; 4]; 2] {
    let at = split.map_or(0, |split| (split.clamp(0.0, 1.0) * width as f32).round() as u32);
    [[0, 0, at, height], [at, 0, width - at, height]]
}
