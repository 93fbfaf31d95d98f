//! The steps of a picture: what each render pass draws, and in which half.

use std::ops::Range;

use super::Scene;
use super::layers::LayerPass;
use super::needs::has_layers;
use crate::settings::{Settings, SplitSide};

/// What one render pass of a picture draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// Only the background, and what is drawn over surfaces.
    Over,
    /// The triangles of a half's chunk, where they hide what is behind them.
    Surface(SplitSide, usize),
    /// Triangles that show what is behind them.
    Layer(LayerStep),
    /// The normals of a half's chunk.
    Normals(SplitSide, usize),
    /// Keeps the picture of the left half, which is whole, and begins another one.
    Keep,
    /// Shows how that differs from the one that was kept, and what is drawn over surfaces.
    Difference,
}

/// What a render pass does with layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct LayerStep {
    pub pass: LayerPass,
    /// The half and its chunk whose triangles are drawn; none for a pass that only clears.
    pub part: Option<(SplitSide, usize)>,
    /// Whether it is the first step of its pass.
    pub is_first: bool,
}

impl Step {
    /// The half and its chunk that it draws, if it draws one.
    pub(super) fn part(&self) -> Option<(SplitSide, usize)> {
        match self {
            Self::Surface(half, chunk) | Self::Normals(half, chunk) => Some((*half, *chunk)),
            Self::Layer(LayerStep { part, .. }) => *part,
            Self::Over | Self::Keep | Self::Difference => None,
        }
    }

    pub(super) fn half(&self) -> SplitSide {
        self.part().map_or(SplitSide::Right, |(half, _)| half)
    }
}

/// All steps of a picture, in order.
pub(super) fn steps(scene: &Scene, settings: &Settings) -> Vec<Step> {
    if settings.shows_difference() && scene.half(SplitSide::Left).is_some() {
        let [left, right] = SplitSide::BOTH.map(|half| steps_of(scene, settings, &[half]));
        return [left, vec![Step::Keep], right, vec![Step::Difference]].concat();
    }
    steps_of(scene, settings, &SplitSide::BOTH)
}

/// The steps of one picture of these halves.
fn steps_of(scene: &Scene, settings: &Settings, halves: &[SplitSide]) -> Vec<Step> {
    // The chunks of halves that show this.
    let parts = |shows: fn(&Settings, &Scene) -> bool| -> Vec<_> {
        let drawn = |half: &SplitSide| Some((*half, settings.half(*half)?, scene.half(*half)?));
        let shown = halves.iter().filter_map(drawn).filter(|(_, settings, own)| shows(settings, own));
        shown.flat_map(|(half, _, own)| (0..own.tessellator.chunk_count()).map(move |chunk| (half, chunk))).collect()
    };
    let surfaces = parts(|_, _| true).into_iter().map(|(half, chunk)| Step::Surface(half, chunk));
    let layered = parts(|settings, own| settings.shows_materials() && has_layers(own.tessellator.mesh()));
    let normals = parts(|settings, _| settings.overlays.normals).into_iter();
    let mut steps: Vec<_> = surfaces.chain(layer_steps(&layered)).collect();
    steps.extend(normals.map(|(half, chunk)| Step::Normals(half, chunk)));
    if matches!(steps.last(), None | Some(Step::Layer(_))) {
        steps.push(Step::Over);
    }
    steps
}

fn layer_steps(parts: &[(SplitSide, usize)]) -> impl Iterator<Item = Step> {
    let passes = LayerPass::all().filter(|_| !parts.is_empty());
    passes.flat_map(|pass| {
        let first = match pass {
            LayerPass::Begin => None,
            _ => parts.first().copied(),
        };
        let rest = if first.is_some() { &parts[1..] } else { &[] };
        let step = move |part, is_first| Step::Layer(LayerStep { pass, part, is_first });
        std::iter::once(step(first, true)).chain(rest.iter().map(move |&part| step(Some(part), false)))
    })
}

/// The runs of steps that a device gets at once. A step begins a run if it may have to emit a chunk, or draws one for the first
/// time.
pub(super) fn runs(scene: &Scene, steps: &[Step]) -> Vec<Range<usize>> {
    let has_many = |half| scene.half(half).is_some_and(|half| half.tessellator.chunk_count() > 1);
    let begins = |index: &usize| match &steps[*index] {
        Step::Surface(..) | Step::Normals(..) => true,
        step @ Step::Layer(_) => *index == 0 || (step.part().is_some() && has_many(step.half())),
        Step::Over | Step::Keep | Step::Difference => *index == 0,
    };
    let starts: Vec<_> = (0..steps.len()).filter(begins).collect();
    let ends = starts.iter().skip(1).copied().chain([steps.len()]);
    starts.iter().zip(ends).map(|(&start, end)| start..end).collect()
}
