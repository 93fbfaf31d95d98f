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
    /// Finds the next layer. The number counts these passes.
    Find { number: usize, toward_eye: bool },
    /// Composites what the pass of this number has found.
    Composite { number: usize },
}

impl LayerPass {
    /// All passes of a picture, in order.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        // One more than are composited: the others lie in front of it.
        let away = (0..=LAYERS).map(|number| Self::Find { number, toward_eye: false });
        let back = (LAYERS + 1..2 * LAYERS + 1)
            .flat_map(|number| [Self::Find { number, toward_eye: true }, Self::Composite { number }]);
        std::iter::once(Self::Begin).chain(away).chain(back)
    }

    /// The texture with the depths of the layer that was found last: 0 or 1.
    pub(super) fn passed(self) -> usize {
        match self {
            Self::Begin => 1,
            Self::Find { number, .. } => number % 2,
            Self::Composite { number } => (number + 1) % 2,
        }
    }

    /// The texture that gets depths, if any does, and what they are where nothing is found.
    pub(super) fn found(self) -> Option<(usize, f32)> {
        let other = 1 - self.passed();
        match self {
            Self::Begin | Self::Find { toward_eye: true, .. } => Some((other, 1.0)),
            Self::Find { toward_eye: false, .. } => Some((other, 0.0)),
            Self::Composite { .. } => None,
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
            match pass {
                LayerPass::Begin => {}
                LayerPass::Composite { .. } => {
                    composited.extend(depths.iter().filter(|depth| **depth == passed && passed < 1.0));
                }
                LayerPass::Find { toward_eye, .. } => {
                    let is_beyond = |depth: &&f32| if toward_eye { **depth > passed } else { **depth < passed };
                    let beyond = depths.iter().filter(is_beyond).copied();
                    let next = if toward_eye { beyond.reduce(f32::min) } else { beyond.reduce(f32::max) };
                    let (texture, nothing) = pass.found().expect("depths");
                    textures[texture] = next.unwrap_or(nothing);
                    continue;
                }
            }
            if let Some((texture, nothing)) = pass.found() {
                textures[texture] = nothing;
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
