//! What a picture depends on besides the mesh and the camera. The window edits it, and commands parse into it.
//!
//! [`options`] declares each option once. The command line, saved settings, "Copy as command", random settings in tests and
//! the window's rows are made from these declarations.

pub mod light;
pub mod options;
mod overlays;
mod value;

use glam::{Mat4, Vec2, Vec3};

use geometry::defaults::with_defaults;
use geometry::mesh::{Heights, Material, Mesh};
use geometry::tessellate::{Clip, CurvatureKind, Inputs, Lod, LodView, Surface, Tessellation, displacement_reach};
use load::Import;

pub(crate) use geometry::choice::choices;
pub use geometry::choice::{Choice, Description, descriptions};
pub use light::{FileLights, Lighting, Matcap, NormalMaps, ToneCurve};
pub use overlays::{ColorSource, Colors, Control, Overlay, Overlays};
pub use value::{Access, Declaration, Kind, Range, Value};

/// Memory for a tessellation's output, in bytes.
pub const ARENA_BYTES: u64 = 256 << 20;

/// sRGB colours behind the mesh in a dark and in a light theme. Both are neutral, and the usual grey of a mesh stands out from
/// both.
const DARK_BACKGROUND: [u8; 3] = [0x2b, 0x2e, 0x33];
pub const LIGHT_BACKGROUND: [u8; 3] = [0xe4, 0xe6, 0xe9];

with_defaults! {
    /// What is shown and how, apart from mesh and camera.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Settings {
        pub tessellation: Tessellation = Tessellation::default(),
        /// Where shading normals are evaluated; a displaced surface has them at vertices. See [`Self::used_normals_at`].
        pub normals_at: NormalsAt = NormalsAt::Vertices,
        /// Whether normal maps tilt the normals of a displaced surface. See [`Self::draws_normal_map`].
        pub normal_maps: NormalMaps = NormalMaps::default(),
        pub overlays: Overlays = Overlays::default(),
        /// The light that the mesh's own materials are seen in.
        pub lighting: Lighting = Lighting::default(),
        /// Whether the lights of the file shine, if it has some. Not under [`Lighting::Camera`], as what follows.
        pub lights: FileLights = FileLights::default(),
        /// How bright the light from all around is beside emission and the lights of the file, in EV: each step doubles it.
        pub environment_brightness: f32 = 0.0,
        /// Whether the light from all around is seen behind the mesh.
        pub environment_background: bool = false,
        /// How bright the picture is, in EV: each step doubles the light.
        pub exposure: f32 = 0.0,
        /// How light becomes colours of the picture.
        pub tone_curve: ToneCurve = ToneCurve::default(),
        /// How far the light is turned about the vertical axis, in degrees.
        pub light_rotation: f32 = 0.0,
        /// The unit of the distances that the deviation overlay colours.
        pub deviation_in: SurfaceUnit = SurfaceUnit::Units,
        /// Which curvature the curvature overlay shows.
        pub curvature_kind: CurvatureKind = CurvatureKind::default(),
        /// The curvature at the ends of that overlay's scale, in 1 / bounding radius; none for what suits the mesh. That of
        /// Gaussian curvature is its square.
        pub curvature_scale: Option<f32> = None,
        /// How many stripes the zebra overlay has over half a turn of the normal.
        pub zebra_stripes: f32 = 24.0,
        /// The direction along the zebra's stripes in the view, in degrees: 0 is to the right, and 90 up.
        // Askew, since most meshes have edges that lie level or upright: on stripes along an edge one wouldn't see a kink.
        pub zebra_direction: f32 = 36.87,
        /// How many squares the checker has in one unit of u and v.
        pub checker_squares: f32 = 8.0,
        /// The unit along which texel density is counted.
        pub texel_density_per: SurfaceUnit = SurfaceUnit::Px,
        /// The lit sphere that the matcap overlay shows.
        pub matcap: Matcap = Matcap::default(),
        /// Where the picture is split, as a fraction of its width from the left; none if it isn't.
        pub split: Option<f32> = None,
        /// How the halves of a split picture are shown.
        pub split_view: SplitView = SplitView::default(),
        /// The tessellation left of the split.
        pub left: Tessellation = Tessellation::untessellated(),
        /// How the left half looks; none if as the right one does. All other settings are the same.
        pub left_looks: Option<Looks> = None,
        /// The side of a section that is drawn; none for all of the mesh.
        pub section: Option<SectionAxis> = None,
        /// Where the section is between the least (0) and the largest (1) coordinate of the bounding box.
        pub section_at: f32 = 0.5,
        /// sRGB colour behind the mesh; none for that of the window's theme, and in commands [`DARK_BACKGROUND`].
        pub background: Option<[u8; 3]> = None,
        /// How the geometry of the mesh's file is taken. The mesh is read again when it changes.
        pub import: Import = Import::default(),
    }
}

/// Declares those settings of a picture that its halves may differ in, beside the tessellation.
macro_rules! looks {
    ($($field:ident: $kind:ty),+ $(,)?) => {
        /// How a half of a picture looks: the settings of [`options::LOOKS`].
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Looks {
            $($field: $kind),+
        }

        impl Settings {
            fn looks(&self) -> Looks {
                Looks { $($field: self.$field),+ }
            }

            fn with_looks(&self, looks: Looks) -> Self {
                Self { $($field: looks.$field,)+ ..*self }
            }
        }
    };
}

looks! {
    normals_at: NormalsAt, normal_maps: NormalMaps, overlays: Overlays, lighting: Lighting, lights: FileLights,
    environment_brightness: f32, environment_background: bool, exposure: f32, tone_curve: ToneCurve, light_rotation: f32,
    deviation_in: SurfaceUnit, curvature_kind: CurvatureKind, curvature_scale: Option<f32>, zebra_stripes: f32,
    zebra_direction: f32, checker_squares: f32, texel_density_per: SurfaceUnit, matcap: Matcap,
}

/// The settings of what measures or compares tessellations: lit by the camera's lights, so that pictures depend on nothing but
/// the surface and its base colours.
impl From<Tessellation> for Settings {
    fn from(tessellation: Tessellation) -> Self {
        Self { tessellation, lighting: Lighting::Camera, ..Self::default() }
    }
}

/// A half of a split picture. A picture that isn't split is all right half.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SplitSide {
    Left,
    #[default]
    Right,
}

impl SplitSide {
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];
}

choices! {
    /// How the halves of a split picture are shown.
    #[derive(Default, Hash)]
    pub enum SplitView {
        #[default]
        Divider => "divider", "Divider", "One view, of which each half shows its side of the divider.";
        Beside => "beside", "Side by side", "Each half shows the middle of the view, from the same camera.";
        Difference => "difference", "Difference",
            "How far the colours of both halves are apart at each pixel: black where they are equal, brighter where they differ \
             by more steps. Lines over the surface are drawn over it.";
    }
}

choices! {
    /// Where the normals that a surface is shaded with are evaluated.
    #[derive(Default, Hash)]
    pub enum NormalsAt {
        #[default]
        Vertices => "vertices", "Vertices",
            "Normals are evaluated at vertices and interpolated in every triangle, so that shading depends on the \
             triangles.";
        Pixels => "pixels", "Pixels",
            "The pixel shader evaluates the patch's normal at every pixel, so that shading stays the same however \
             few triangles a patch has.";
    }
}

choices! {
    /// The axis along which pictures are cut, and the side that stays.
    pub enum SectionAxis {
        X => "x", "X", "What has a larger X than the plane is drawn.";
        NegX => "-x", "-X", "What has a smaller X than the plane is drawn.";
        Y => "y", "Y", "What has a larger Y than the plane is drawn.";
        NegY => "-y", "-Y", "What has a smaller Y than the plane is drawn.";
        Z => "z", "Z", "What has a larger Z than the plane is drawn.";
        NegZ => "-z", "-Z", "What has a smaller Z than the plane is drawn.";
    }
}

impl SectionAxis {
    /// The unit vector into what is drawn.
    pub fn direction(self) -> Vec3 {
        match self {
            Self::X => Vec3::X,
            Self::NegX => Vec3::NEG_X,
            Self::Y => Vec3::Y,
            Self::NegY => Vec3::NEG_Y,
            Self::Z => Vec3::Z,
            Self::NegZ => Vec3::NEG_Z,
        }
    }
}

choices! {
    /// The unit of lengths on the surface.
    #[derive(Default)]
    pub enum SurfaceUnit {
        #[default]
        Units => "units", "Object units", "Object units, which don't depend on the view.";
        Px => "px", "Px", "The length on screen, in px, of what lies across the view.";
    }
}

impl Settings {
    /// The settings of commands without options: LOD by error with the fewest triangles, which rows have.
    pub fn usual() -> Self {
        Self::default().under(Lod::Error)
    }

    /// The settings of the window's first start: the usual ones, with patches that can't be seen left out. Commands keep these,
    /// since a written mesh is to be whole.
    pub fn opening() -> Self {
        let usual = Self::usual();
        usual.with(Tessellation { clip: Clip::Frustum, cull_back_faces: true, ..usual.tessellation })
    }

    /// Returns the settings of the window's first start, which show at once what tessellation does: the mesh as it came beside
    /// the tessellated one, both with the borders of the mesh's own triangles.
    pub fn greeting() -> Self {
        let overlays = Overlays { patches: true, ..Overlays::default() };
        Self { split: Some(0.5), overlays, ..Self::opening() }
    }

    /// The sRGB colour behind the mesh.
    pub fn background_color(&self) -> [u8; 3] {
        self.background.unwrap_or(DARK_BACKGROUND)
    }

    /// These settings under another LOD, with the partitioning that is usual there.
    pub fn under(&self, lod: Lod) -> Self {
        self.with(Tessellation { lod, partitioning: lod.usual_partitioning(), ..self.tessellation })
    }

    /// These settings with another tessellation.
    pub fn with(&self, tessellation: Tessellation) -> Self {
        Self { tessellation, ..*self }
    }

    /// Where a mesh's shading normals are evaluated. Those of a displaced surface follow its triangles, so they are at vertices.
    pub fn used_normals_at(&self, mesh: &Mesh) -> NormalsAt {
        if self.displacing(mesh).is_some() { NormalsAt::Vertices } else { self.normals_at }
    }

    /// Whether the normal map of one of a mesh's materials is drawn. Where the surface is displaced by the same relief, its slopes would
    /// count twice.
    pub(crate) fn draws_normal_map(&self, mesh: &Mesh, material: &Material) -> bool {
        self.displacing(mesh).is_none_or(|heights| match self.normal_maps {
            NormalMaps::Auto => !heights.are_of_colors || material.texture.is_none(),
            NormalMaps::On => true,
            NormalMaps::Off => false,
        })
    }

    /// The heights that displace a mesh.
    fn displacing<'a>(&self, mesh: &'a Mesh) -> Option<&'a Heights> {
        mesh.heights.as_deref().filter(|_| self.tessellation.displacement.is_on())
    }

    /// Whether materials are drawn as glTF describes them, in light from all around.
    pub fn shows_materials(&self) -> bool {
        self.lighting != Lighting::Camera && self.overlays.colors.source() == ColorSource::Materials
    }

    /// Whether the light from all around is drawn behind the mesh.
    pub fn shows_environment(&self) -> bool {
        self.environment_background && self.shows_materials()
    }

    /// The settings of one half of the picture; none where that half doesn't exist.
    pub fn half(&self, half: SplitSide) -> Option<Self> {
        match half {
            SplitSide::Left => {
                self.split.map(|_| self.with(self.left).with_looks(self.left_looks.unwrap_or(self.looks())))
            }
            SplitSide::Right => Some(*self),
        }
    }

    /// The settings of all halves that the picture has, the left one first.
    pub fn halves(&self) -> impl DoubleEndedIterator<Item = Self> {
        SplitSide::BOTH.into_iter().filter_map(|half| self.half(half))
    }

    /// Whether colours of a half come from this source.
    pub fn any_half_shows(&self, source: ColorSource) -> bool {
        self.halves().any(|own| own.overlays.colors.source() == source)
    }

    /// Exchanges what is left and right of the split.
    pub fn swap_halves(&mut self) {
        std::mem::swap(&mut self.left, &mut self.tessellation);
        self.swap_looks();
    }

    /// Makes the left half a copy of the right one, and splits a picture that isn't. Looks that both share go on being shared.
    pub fn keep_on_left(&mut self, at: f32) {
        self.left = self.tessellation;
        self.left_looks = self.left_looks.map(|_| self.looks());
        self.split.get_or_insert(at);
    }

    fn swap_looks(&mut self) {
        if let Some(left) = self.left_looks {
            *self = Self { left_looks: Some(self.looks()), ..self.with_looks(left) };
        }
    }

    /// Changes how both halves look.
    pub fn change_looks(&mut self, change: impl Fn(&mut Self)) {
        change(self);
        if self.left_looks.is_some() {
            self.swap_looks();
            change(self);
            self.swap_looks();
        }
    }

    /// Changes settings; what it changes of how the picture looks is of this half, if the halves look otherwise.
    pub fn change_half_looks(&mut self, half: SplitSide, change: impl FnOnce(&mut Self)) {
        if half == SplitSide::Right || self.split.is_none() {
            return change(self);
        }
        self.swap_looks();
        change(self);
        self.swap_looks();
    }

    /// Whether the picture is the difference between both halves.
    pub fn shows_difference(&self) -> bool {
        self.split.is_some() && self.split_view == SplitView::Difference
    }

    /// Whether the halves are shown elsewhere than where the view has them, or not at all.
    pub fn moves_halves(&self) -> bool {
        self.split.is_some() && self.split_view != SplitView::Divider
    }

    /// Whether the left half of a split view is another tessellation than the mesh as it is.
    pub fn has_left_tessellation(&self) -> bool {
        self.left != Tessellation::untessellated()
    }

    /// The surface left of the split; none for the mesh without tessellation.
    pub fn left_surface(&self) -> Option<Surface> {
        self.has_left_tessellation().then_some(self.left.surface)
    }

    /// Shows this surface left of the split, with all else as it is there, or as it is on the right if the left half was untessellated; or
    /// without a surface, shows the mesh without tessellation.
    pub fn set_left_surface(&mut self, surface: Option<Surface>) {
        let before = if self.has_left_tessellation() { self.left } else { self.tessellation };
        self.left = surface.map_or_else(Tessellation::untessellated, |surface| Tessellation { surface, ..before });
    }

    /// The settings of what is drawn: a section shows the backs of faces in one colour, which fills a closed mesh.
    #[must_use]
    pub(crate) fn drawn(&self) -> Self {
        let mut drawn = *self;
        drawn.change_looks(|own| own.overlays.back_faces |= own.section.is_some());
        drawn
    }

    /// How far heights move any point of a mesh at most, in object units.
    pub fn reach(&self, mesh: &Mesh) -> f32 {
        displacement_reach(mesh, &self.inputs(LodView::new(Mat4::IDENTITY, Vec2::ONE)))
    }

    /// What the tessellation depends on, seen from `view`.
    pub fn inputs(&self, view: LodView) -> Inputs {
        // A section shows what faces away.
        let cull_back_faces = self.tessellation.cull_back_faces && self.section.is_none();
        Inputs::new(&Tessellation { cull_back_faces, ..self.tessellation }, view)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::mesh::UpAxis;
    use geometry::mesh::subdivision::FaceVarying;
    use geometry::tessellate::{Convention, Displacement, Edges, Normals, Partitioning};
    use load::{LengthUnit, NormalSource};

    #[test]
    fn subtriangulation_uses_uniform_lod_and_keeps_the_chosen_one() {
        let view = LodView::new(glam::Mat4::IDENTITY, glam::Vec2::ONE);
        for partitioning in Partitioning::ALL {
            for lod in Lod::ALL {
                let tessellation = Tessellation { partitioning, lod, ..Tessellation::default() };
                let used = if partitioning == Partitioning::Subtriangulation { Lod::Uniform } else { lod };
                let inputs = Settings::from(tessellation).inputs(view).tessellation;
                assert_eq!((tessellation.used_lod(), inputs.lod), (used, used), "{partitioning:?} {lod:?}");
            }
        }
    }

    fn check<T: Choice + std::fmt::Debug>() {
        for (index, value) in T::ALL.iter().copied().enumerate() {
            let Description { name, label, text } = value.description();
            assert!(!T::ALL[..index].contains(&value), "{value:?} is listed twice");
            assert_eq!(T::named(name), Some(value), "{value:?}");
            let hlsl = value.description().hlsl_name();
            assert!(hlsl.is_none_or(|hlsl| T::named(&hlsl) == Some(value)), "{value:?}");
            assert!(T::ALL[..index].iter().all(|other| other.label() != label), "{label} is there twice");
            assert!(text.ends_with('.') && text.len() > 10, "{value:?}: {text}");
            assert_eq!(label.trim(), label);
        }
        assert_eq!(T::named("odd"), None);
        assert_eq!(T::named(""), None);
    }

    #[test]
    fn every_value_is_found_by_its_name_and_has_a_text() {
        check::<Surface>();
        check::<Normals>();
        check::<Edges>();
        check::<Partitioning>();
        check::<Lod>();
        check::<Clip>();
        check::<Convention>();
        check::<Displacement>();
        check::<SurfaceUnit>();
        check::<CurvatureKind>();
        check::<NormalsAt>();
        check::<Lighting>();
        check::<ToneCurve>();
        check::<Overlay>();
        check::<Colors>();
        check::<NormalSource>();
        check::<UpAxis>();
        check::<FaceVarying>();
        check::<LengthUnit>();
    }
}
