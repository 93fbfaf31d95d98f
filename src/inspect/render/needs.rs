//! What the shader that lights a mesh's materials must have.

use crate::settings::{ColorSource, FileLights, Settings};
use geometry::mesh::{Alpha, Look, MOST_LIGHTS, Material, Mesh, Slot};

/// The bit of [`Needs::maps`] for the picture of what is behind; the same in `shaders/draw_material.wgsl`.
pub(super) const BEHIND: usize = Slot::COUNT;

/// The switch of a part of materials, and which have it.
type Part = (&'static str, fn(&Look) -> bool);

/// What shaders have for looks that need it: the name of the constant that says whether they do, and which looks do.
const PARTS: [Part; 5] = [
    ("HAS_COAT", |look| look.clearcoat > 0.0),
    // Places where there is no surface that hides what is behind, by alpha.
    ("HAS_MASK", |look| look.alpha != Alpha::Opaque),
    ("HAS_TRANSMISSION", Look::transmits),
    ("HAS_SHEEN", Look::has_sheen),
    ("HAS_ANISOTROPY", Look::has_anisotropy),
];

/// What a mesh's materials need of the shader that lights them. What they don't need is left out of it when its pipeline is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Needs {
    /// Bits of the images beside that of the base colour, by [`Slot`]; and [`BEHIND`] for what is behind a look that
    /// distorts it. The shader has a place for each of them, in this order.
    pub maps: u32,
    /// Details of corners: colours, tangents, or further texture coordinates.
    pub details: bool,
    /// Bits of what else some material has, by its place in [`PARTS`].
    pub parts: u32,
    /// How many lights of the file shine.
    pub lights: usize,
    /// Whether a pixel's samples are masked one by one: see [`Self::own`].
    pub masked_samples: bool,
    /// Whether it is for drafts: see [`Target::draft`](super::Target::draft).
    pub draft: bool,
}

impl Needs {
    /// Everything that any mesh needs.
    pub(super) const ALL: Self = Self {
        maps: (1 << Look::MOST_IMAGES) - 1,
        details: true,
        parts: (1 << PARTS.len()) - 1,
        lights: MOST_LIGHTS,
        masked_samples: false,
        draft: false,
    };

    /// What a material of a mesh needs of its shader with these settings; or, where materials share a shader, what all of the mesh's
    /// materials need together.
    pub(super) fn new(mesh: &Mesh, material: &Material, settings: &Settings, kind: PictureKind) -> Self {
        let of = |materials: &[Material]| Self::together(materials, mesh, settings);
        let has_places = |needs: &Self| needs.maps.count_ones() as usize <= Look::MOST_IMAGES;
        let shared = Some(of(&mesh.materials)).filter(|shared| kind.shares_shaders && has_places(shared));
        let mut needs = shared.unwrap_or_else(|| of(std::slice::from_ref(material)));
        if !settings.draws_normal_map(mesh, material) {
            needs.maps &= !(1 << Slot::Normal as u32);
        }
        while !has_places(&needs) {
            needs.maps &= !(1 << (needs.maps & !(1 << BEHIND)).ilog2());
        }
        needs
    }

    /// What some of a mesh's materials need together.
    fn together(materials: &[Material], mesh: &Mesh, settings: &Settings) -> Self {
        let lights = if settings.lights == FileLights::On { mesh.lights.len().min(MOST_LIGHTS) } else { 0 };
        let details = mesh.details.is_some();
        let mut needs = Self { maps: 0, parts: 0, details, lights, ..Self::ALL };
        for look in materials.iter().map(|material| &material.look) {
            let maps = Slot::ALL.into_iter().filter(|slot| look.maps[*slot as usize].is_some());
            needs.maps |= maps.map(|slot| 1 << slot as u32).sum::<u32>();
            needs.maps |= u32::from(look.distorts()) << BEHIND;
            needs.parts |= (0..).zip(PARTS).map(|(bit, (_, has))| u32::from(has(look)) << bit).sum::<u32>();
        }
        needs
    }

    /// The needs of the pipeline that draws a material where it hides what is behind it. The border of a mask covers only some of a
    /// pixel's samples, so these are masked one by one. Layers need no such masks, since they are drawn sample by sample.
    pub(super) fn own(self, material: &Material, kind: PictureKind) -> Self {
        let has_border = matches!(material.look.alpha, Alpha::Mask(_)) && !material.shows_behind();
        let masked_samples = has_border && kind.samples > 1 && !kind.is_draft;
        Self { masked_samples, draft: kind.is_draft, ..self }
    }

    /// The values of the constants of `shaders/draw_material.wgsl`.
    pub(super) fn constants(self) -> Vec<(&'static str, f64)> {
        let switch = |is_needed| f64::from(u8::from(is_needed));
        let parts = (0..).zip(PARTS).map(|(bit, (name, _))| (name, f64::from(self.parts >> bit & 1)));
        let others = [
            ("MAPS", f64::from(self.maps)),
            ("HAS_DETAILS", switch(self.details)),
            ("IS_DRAFT", switch(self.draft)),
            ("LIGHT_COUNT", self.lights as f64),
        ];
        parts.chain(others).collect()
    }
}

/// What a pipeline knows of the pictures that it draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PictureKind {
    /// Samples a pixel.
    pub samples: u32,
    /// See [`Target::draft`](super::Target::draft).
    pub is_draft: bool,
    /// Whether all materials of a mesh have the shader that any of them needs: see [`Renderer`](super::Renderer).
    pub shares_shaders: bool,
}

/// How a mask cuts a surface that the lights at the camera shine on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Cut {
    /// Whether corners have details, whose colours have an alpha too.
    pub details: bool,
    /// Whether a pixel's samples are cut one by one.
    pub samples: bool,
}

impl Cut {
    /// How one of a mesh's materials is cut under these settings, in such pictures; none if it isn't, or if it is lit from all around.
    pub(super) fn new(settings: &Settings, mesh: &Mesh, material: &Material, kind: PictureKind) -> Option<Self> {
        let is_seen = settings.overlays.colors.source() == ColorSource::Materials && !settings.shows_materials();
        let is_cut = is_seen && matches!(material.look.alpha, Alpha::Mask(_));
        is_cut.then_some(Self { details: mesh.details.is_some(), samples: kind.samples > 1 })
    }
}

/// Whether a mesh has materials that are drawn in layers.
pub(super) fn has_layers(mesh: &Mesh) -> bool {
    mesh.materials.iter().any(Material::shows_behind)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Vec3;

    use super::*;
    use geometry::mesh::{Light, LightKind, Map, MapUv, Sampling, Shape, Texture};

    const NOTHING: Needs = Needs { maps: 0, details: false, parts: 0, lights: 0, masked_samples: false, draft: false };

    /// What shaders with these of [`PARTS`] need.
    fn parts(names: &[&str]) -> Needs {
        let bits = (0..).zip(PARTS).filter(|(_, (name, _))| names.contains(name)).map(|(bit, _)| 1_u32 << bit);
        Needs { parts: bits.sum(), ..NOTHING }
    }

    fn kind(samples: u32, is_draft: bool) -> PictureKind {
        PictureKind { samples, is_draft, shares_shaders: true }
    }

    /// What the materials of a mesh need together.
    fn needs(mesh: &Mesh, settings: &Settings) -> Needs {
        Needs::new(mesh, &mesh.materials[0], settings, kind(4, false))
    }

    #[test]
    fn a_mesh_needs_what_any_of_its_materials_does() {
        let mut mesh = Shape::CubeSplit.build();
        let settings = Settings::default();
        assert_eq!(needs(&mesh, &settings), NOTHING);
        let mut coated = Material::plain("coated", [1.0; 4]);
        coated.look.clearcoat = 0.5;
        mesh.materials.push(coated);
        assert_eq!(needs(&mesh, &settings), parts(&["HAS_COAT"]));
        let mut leaves = Material::plain("leaves", [1.0; 4]);
        leaves.look.alpha = Alpha::Mask(0.5);
        mesh.materials.push(leaves);
        assert_eq!(needs(&mesh, &settings), parts(&["HAS_COAT", "HAS_MASK"]));
        let own = |kind| mesh.materials.iter().map(move |own| NOTHING.own(own, kind).masked_samples);
        assert!(own(kind(4, false)).eq([false, false, true]));
        assert!(own(kind(1, false)).eq([false; 3]) && own(kind(4, true)).eq([false; 3]));
        assert!(!has_layers(&mesh));
        let mut glass = Material::plain("glass", [1.0; 4]);
        (glass.look.transmission, glass.look.roughness) = (1.0, 0.0);
        let mut painted = glass.clone();
        painted.look.unlit = true;
        mesh.materials = vec![painted];
        assert_eq!((needs(&mesh, &settings), has_layers(&mesh)), (NOTHING, false));
        mesh.materials.push(glass);
        assert_eq!((needs(&mesh, &settings), has_layers(&mesh)), (parts(&["HAS_TRANSMISSION"]), true));
        // What is behind a rough one comes from a picture.
        mesh.materials[1].look.roughness = 0.1;
        assert_eq!(needs(&mesh, &settings), Needs { maps: 1 << BEHIND, ..parts(&["HAS_TRANSMISSION"]) });
        mesh.materials[1].look = Look { alpha: Alpha::Blend, ..Look::default() };
        assert_eq!((needs(&mesh, &settings), has_layers(&mesh)), (parts(&["HAS_MASK"]), true));
        let mut velvet = Material::plain("velvet", [1.0; 4]);
        velvet.look.sheen_color = [0.0, 0.1, 0.0];
        mesh.materials = vec![velvet.clone()];
        assert_eq!(needs(&mesh, &settings), parts(&["HAS_SHEEN"]));
        velvet.look.unlit = true;
        mesh.materials = vec![velvet];
        assert_eq!(needs(&mesh, &settings), NOTHING);
        let mut brushed = Material::plain("brushed", [1.0; 4]);
        brushed.look.anisotropy = 0.5;
        let mut gem = Material::plain("gem", [1.0; 4]);
        gem.look.thickness = 1.0;
        mesh.materials = vec![brushed, gem];
        assert_eq!((needs(&mesh, &settings), has_layers(&mesh)), (parts(&["HAS_ANISOTROPY"]), false));
        mesh.materials[1].look.transmission = 1.0;
        let both = Needs { maps: 1 << BEHIND, ..parts(&["HAS_TRANSMISSION", "HAS_ANISOTROPY"]) };
        assert_eq!(needs(&mesh, &settings), both);
        let sun =
            Light { kind: LightKind::Directional, intensity: Vec3::ONE, place: Vec3::ZERO, direction: Vec3::NEG_Y };
        mesh.lights = vec![sun; 3];
        assert_eq!(needs(&mesh, &settings).lights, 3);
        assert_eq!(needs(&mesh, &Settings { lights: FileLights::Off, ..settings }).lights, 0);
    }

    /// A material with these maps.
    fn mapped(slots: &[Slot]) -> Material {
        let mut material = Material::plain("mapped", [1.0; 4]);
        for &slot in slots {
            let texture = Arc::new(Texture { size: [1; 2], rgba: vec![255; 4] });
            let map = Map { texture, uv: MapUv::Own, sampling: Sampling::default() };
            material.look.maps[slot as usize] = Some(map);
        }
        material
    }

    #[test]
    fn shaders_are_shared_while_they_have_places_for_all_images() {
        let bits = |slots: &[Slot]| slots.iter().map(|slot| 1_u32 << *slot as u32).sum::<u32>();
        let mut mesh = Shape::CubeSplit.build();
        let (first, rest) = Slot::ALL.split_at(6);
        mesh.materials = vec![mapped(first), mapped(&rest[..6])];
        let maps = |mesh: &Mesh| {
            let of = |own: &Material| Needs::new(mesh, own, &Settings::default(), kind(4, false)).maps;
            mesh.materials.iter().map(of).collect::<Vec<_>>()
        };
        assert_eq!(maps(&mesh), [bits(&Slot::ALL[..12]); 2]);
        mesh.materials[1] = mapped(rest);
        assert_eq!(maps(&mesh), [bits(first), bits(rest)]);
        // What is behind a body has a place whatever else there is.
        let mut all = mapped(&Slot::ALL);
        mesh.materials = vec![all.clone()];
        assert_eq!(maps(&mesh), [bits(&Slot::ALL[..12])]);
        (all.look.transmission, all.look.thickness) = (1.0, 1.0);
        mesh.materials = vec![all];
        assert_eq!(maps(&mesh), [bits(&Slot::ALL[..11]) | 1 << BEHIND]);
    }

    #[test]
    fn a_material_with_a_shader_of_its_own_needs_nothing_that_only_others_do() {
        let mut mesh = Shape::CubeSplit.build();
        let mut coated = Material::plain("coated", [1.0; 4]);
        coated.look.clearcoat = 0.5;
        let mut velvet = Material::plain("velvet", [1.0; 4]);
        velvet.look.sheen_color = [0.1; 3];
        mesh.materials.extend([coated, velvet]);
        let kind = PictureKind { shares_shaders: false, ..kind(4, false) };
        let own = mesh.materials.iter().map(|own| Needs::new(&mesh, own, &Settings::default(), kind));
        assert!(own.eq([NOTHING, parts(&["HAS_COAT"]), parts(&["HAS_SHEEN"])]));
    }
}
