//! Layers: surfaces that show what is behind them, composited in the order of their depths, whatever the order of their triangles.
//!
//! Depth peeling (Everitt 2001) finds them one after another, at every sample. It goes away from the eye first, to find where the
//! nearest [`LAYERS`] end, and then back toward the eye. Each layer that is found on the way back is composited at once. So only
//! depths are kept, in two textures: one has the layer that was found last, and the other gets the next one.

/// As many layers are composited at every sample. What is behind them, but not hidden by anything, is left out.
pub(super) const LAYERS: usize = 8;

/// One pass over all layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LayerPass {
    /// Sets the depths of the last layer to that of the near plane, where the search begins.
    Begin,
    /// Finds the next layer away from the eye. The number counts all passes but the first.
    Away { number: usize },
    /// Composites the layer that the pass before found on the way back, and finds the next one toward the eye. The first of these
    /// passes has nothing to composite, and the last one nothing to find.
    Back { number: usize, composites: bool, finds: bool },
}

impl LayerPass {
    /// All passes of a picture, in order.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        // One more than are composited: the others lie in front of it.
        let away = (0..=LAYERS).map(|number| Self::Away { number });
        let (first, last) = (LAYERS + 1, 2 * LAYERS + 1);
        let back =
            (first..=last).map(move |number| Self::Back { number, composites: number > first, finds: number < last });
        std::iter::once(Self::Begin).chain(away).chain(back)
    }

    /// The texture with the depths of the layer that was found last: 0 or 1.
    pub(super) fn passed(self) -> usize {
        match self {
            Self::Begin => 1,
            Self::Away { number } | Self::Back { number, .. } => number % 2,
        }
    }

    /// The texture that gets depths.
    pub(super) fn found(self) -> usize {
        1 - self.passed()
    }

    /// What these depths are where nothing is found. `None` for the pass that finds nothing.
    pub(super) fn nothing(self) -> Option<f32> {
        match self {
            Self::Begin | Self::Back { finds: true, .. } => Some(1.0),
            Self::Away { .. } => Some(0.0),
            Self::Back { finds: false, .. } => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The passes at a sample, on the depths of layers there. Returns those that are composited, in order.
    fn composited(depths: &[f32]) -> Vec<f32> {
        let mut textures = [f32::NAN; 2];
        let mut composited = Vec::new();
        for pass in LayerPass::all() {
            let passed = textures[pass.passed()];
            if let LayerPass::Back { composites: true, .. } = pass {
                composited.extend(depths.iter().filter(|depth| **depth == passed && passed < 1.0));
            }
            let next = match pass {
                LayerPass::Begin | LayerPass::Back { finds: false, .. } => None,
                LayerPass::Away { .. } => depths.iter().copied().filter(|depth| *depth < passed).reduce(f32::max),
                LayerPass::Back { .. } => depths.iter().copied().filter(|depth| *depth > passed).reduce(f32::min),
            };
            if let Some(depth) = next.or(pass.nothing()) {
                textures[pass.found()] = depth;
            }
        }
        composited
    }

    #[test]
    fn the_nearest_layers_are_composited_from_the_farthest_on() {
        assert_eq!(composited(&[]), [0.0; 0]);
        assert_eq!(composited(&[0.5]), [0.5]);
        assert_eq!(composited(&[0.5, 0.25, 0.75]), [0.25, 0.5, 0.75]);
        let many: Vec<f32> = (1..=12).map(|depth| depth as f32 / 16.0).collect();
        assert_eq!(composited(&many), many[12 - LAYERS..]);
        assert_eq!(composited(&many[..LAYERS]), many[..LAYERS]);
    }
}
