//! Changes of settings that are commands.

use geometry::mesh::UpAxis;
use geometry::tessellate::{Clip, Convention, Displacement, Edges, Lod, Normals, Partitioning, Surface};
use inspect::settings::options::FACTOR_RANGE;
use inspect::settings::{Colors, DeviationUnit, NormalsAt, Overlay, Settings};
use load::{FileUnit, LengthUnit, NormalSource};

/// A change of settings. Its result depends on the settings alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    FactorUp,
    FactorDown,
    /// Between adaptive LOD and one factor everywhere.
    AdaptiveLod,
    ToggleEdges,
    CullBackFaces,
    Surface(Surface),
    /// None is the untessellated mesh.
    LeftSurface(Option<Surface>),
    Shading(Normals),
    NormalsAt(NormalsAt),
    Partitioning(Partitioning),
    Edges(Edges),
    Lod(Lod),
    Clipping(Clip),
    Convention(Convention),
    Displacement(Displacement),
    MaterialColors,
    DeviationIn(DeviationUnit),
    Overlay(Overlay),
    MeshNormals(NormalSource),
    /// None is the axis that the file says.
    Up(Option<UpAxis>),
    /// None is the unit that the file says.
    Unit(Option<LengthUnit>),
}

impl Change {
    pub fn apply(self, settings: &mut Settings) {
        let factor = |factor: f32| factor.clamp(FACTOR_RANGE.least, FACTOR_RANGE.most);
        match self {
            Self::FactorUp => settings.tessellation.factor = factor(settings.tessellation.factor + 1.0),
            Self::FactorDown => settings.tessellation.factor = factor(settings.tessellation.factor - 1.0),
            Self::AdaptiveLod => settings.tessellation.lod = switched_lod(settings),
            Self::ToggleEdges => {
                settings.tessellation.edges = match settings.tessellation.edges {
                    Edges::AsPublished => Edges::PerEdge,
                    Edges::PerEdge => Edges::AsPublished,
                }
            }
            Self::CullBackFaces => settings.tessellation.cull_back_faces = !settings.tessellation.cull_back_faces,
            Self::Surface(surface) => settings.tessellation.surface = surface,
            Self::LeftSurface(surface) => settings.split_surface = surface,
            Self::Shading(normals) => settings.tessellation.normals = normals,
            Self::NormalsAt(places) => settings.normals_at = places,
            Self::Partitioning(partitioning) => settings.tessellation.partitioning = partitioning,
            Self::Edges(edges) => settings.tessellation.edges = edges,
            Self::Lod(lod) => settings.tessellation.lod = lod,
            Self::Clipping(clip) => settings.tessellation.clip = clip,
            Self::Convention(convention) => settings.tessellation.convention = convention,
            Self::Displacement(displacement) => settings.tessellation.displacement = displacement,
            Self::MaterialColors => settings.overlays.colors = Colors::Material,
            Self::DeviationIn(unit) => settings.deviation_in = unit,
            Self::Overlay(overlay) => settings.overlays.toggle(overlay),
            Self::MeshNormals(normals) => settings.import.normals = normals,
            Self::Up(axis) => settings.import.up = axis,
            Self::Unit(unit) => settings.import.unit = unit.map(FileUnit::Named),
        }
    }
}

/// The LOD that follows when adaptive LOD is switched.
fn switched_lod(settings: &Settings) -> Lod {
    match (settings.tessellation.lod, settings.tessellation.edges) {
        (Lod::Uniform, Edges::AsPublished) => Lod::Paper,
        (Lod::Uniform, Edges::PerEdge) => Lod::Error,
        _ => Lod::Uniform,
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
