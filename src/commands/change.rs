//! Changes of settings that are commands.

use geometry::tessellate::{Edges, Lod, Surface};
use inspect::settings::options::{self, FACTOR_RANGE};
use inspect::settings::{Colors, Overlay, Settings, Value};

/// A change of settings. Its result depends on the settings alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    FactorUp,
    FactorDown,
    /// Between adaptive LOD and one factor everywhere.
    AdaptiveLod,
    ToggleEdges,
    CullBackFaces,
    MaterialColors,
    Overlay(Overlay),
    /// The surface left of the split; none for the untessellated mesh.
    LeftSurface(Option<Surface>),
    /// Exchanges what is left and right of the split.
    SwapHalves,
    /// Shows one half in all of the picture, and then the other one.
    BlinkHalves,
    /// The option with this name gets the value with this name, or none.
    Option(&'static str, Option<&'static str>),
}

impl Change {
    pub fn apply(self, settings: &mut Settings) {
        let factor = |factor: f32| factor.clamp(FACTOR_RANGE.least, FACTOR_RANGE.most);
        match self {
            Self::FactorUp => settings.tessellation.factor = factor(settings.tessellation.factor + 1.0),
            Self::FactorDown => settings.tessellation.factor = factor(settings.tessellation.factor - 1.0),
            Self::AdaptiveLod => {
                let own = &mut settings.tessellation;
                own.lod = match (own.lod, own.edges) {
                    (Lod::Uniform, Edges::AsPublished) => Lod::Paper,
                    (Lod::Uniform, Edges::PerEdge) => Lod::Error,
                    _ => Lod::Uniform,
                };
            }
            Self::ToggleEdges => {
                let is_shared = settings.tessellation.edges == Edges::PerEdge;
                settings.tessellation.edges = if is_shared { Edges::AsPublished } else { Edges::PerEdge };
            }
            Self::CullBackFaces => settings.tessellation.cull_back_faces = !settings.tessellation.cull_back_faces,
            Self::MaterialColors => settings.overlays.colors = Colors::default(),
            Self::Overlay(overlay) => settings.overlays.toggle(overlay),
            Self::LeftSurface(surface) => settings.set_left_surface(surface),
            Self::BlinkHalves => {
                settings.split = settings.split.map(|split| if split < 1.0 { 1.0 } else { 0.0 });
            }
            Self::SwapHalves => settings.swap_halves(),
            Self::Option(name, value) => {
                if let Some(option) = options::all().find(|option| option.name == name) {
                    option.set(settings, value.map_or(Value::Unset, Value::Name));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::tessellate::Tessellation;

    fn changed(settings: Settings, change: Change) -> Settings {
        let mut settings = settings;
        change.apply(&mut settings);
        settings
    }

    #[test]
    fn the_factor_stays_in_its_range() {
        let of = |factor| Settings::from(Tessellation { factor, ..Tessellation::default() });
        assert_eq!(changed(of(3.5), Change::FactorUp).tessellation.factor, 4.5);
        assert_eq!(changed(of(63.5), Change::FactorUp).tessellation.factor, 64.0);
        assert_eq!(changed(of(1.5), Change::FactorDown).tessellation.factor, 1.0);
    }

    #[test]
    fn adaptive_lod_depends_on_how_edges_are_computed() {
        let settings = Settings::default();
        assert_eq!(changed(settings, Change::AdaptiveLod).tessellation.lod, Lod::Error);
        let published = changed(settings, Change::ToggleEdges);
        assert_eq!(published.tessellation.edges, Edges::AsPublished);
        let adaptive = changed(published, Change::AdaptiveLod);
        assert_eq!(adaptive.tessellation.lod, Lod::Paper);
        assert_eq!(changed(adaptive, Change::AdaptiveLod), published);
    }

    #[test]
    fn giving_a_colouring_again_goes_back_to_the_material() {
        let factors = changed(Settings::default(), Change::Overlay(Overlay::Factors));
        assert_eq!(factors.overlays.colors, Colors::Factors);
        assert_eq!(changed(factors, Change::Overlay(Overlay::Factors)), Settings::default());
        assert_eq!(changed(factors, Change::MaterialColors), Settings::default());
    }
}
