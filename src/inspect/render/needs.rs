//! What the shader that lights a mesh's materials must have.

use crate::settings::{ColorSource, FileLights, Settings};
use geometry::mesh::{Alpha, MOST_LIGHTS, Material, Mesh, Slot};

/// What a mesh's materials need of the shader that lights them. What they don't need is left out of it when its pipeline is made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct Needs {
    /// Bits of the images beside that of the base colour, by [`Slot`].
    pub maps: u32,
    /// Details of corners: colours, tangents, or further texture coordinates.
    pub details: bool,
    /// A clear coat.
    pub coat: bool,
    /// Places where there is no surface that hides what is behind, by alpha.
    pub mask: bool,
    /// Light that goes through.
    pub transmission: bool,
    /// A sheen.
    pub sheen: bool,
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
        maps: (1 << Slot::COUNT) - 1,
        details: true,
        coat: true,
        mask: true,
        transmission: true,
        sheen: true,
        lights: MOST_LIGHTS,
        masked_samples: false,
        draft: false,
    };

    /// What a material of a mesh needs of its shader with these settings; or, where materials share a shader, what all of the mesh's
    /// materials need together.
    pub(super) fn new(mesh: &Mesh, material: &Material, settings: &Settings, kind: PictureKind) -> Self {
        let own = if kind.shares_shaders { &mesh.materials } else { std::slice::from_ref(material) };
        let lights = if settings.lights == FileLights::On { mesh.lights.len().min(MOST_LIGHTS) } else { 0 };
        let details = mesh.details.is_some();
        let mut needs = Self { details, lights, ..Self::default() };
        for look in own.iter().map(|material| &material.look) {
            let maps = Slot::ALL.into_iter().filter(|slot| look.maps[*slot as usize].is_some());
            needs.maps |= maps.map(|slot| 1 << slot as u32).sum::<u32>();
            needs.coat |= look.clearcoat > 0.0;
            needs.mask |= look.alpha != Alpha::Opaque;
            needs.transmission |= look.transmits();
            needs.sheen |= look.has_sheen();
        }
        if !settings.draws_normal_map(mesh, material) {
            needs.maps &= !(1 << Slot::Normal as u32);
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
    pub(super) fn constants(self) -> [(&'static str, f64); 8] {
        let switch = |is_needed| f64::from(u8::from(is_needed));
        [
            ("MAPS", f64::from(self.maps)),
            ("HAS_DETAILS", switch(self.details)),
            ("HAS_COAT", switch(self.coat)),
            ("HAS_MASK", switch(self.mask)),
            ("HAS_TRANSMISSION", switch(self.transmission)),
            ("HAS_SHEEN", switch(self.sheen)),
            ("IS_DRAFT", switch(self.draft)),
            ("LIGHT_COUNT", self.lights as f64),
        ]
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
    pub(super) fn from_settings(
        settings: &Settings,
        mesh: &Mesh,
        material: &Material,
        kind: PictureKind,
    ) -> Option<Self> {
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
    use glam::Vec3;

    use super::*;
    use geometry::mesh::{Light, LightKind, Look, Shape};

    const NOTHING: Needs = Needs {
        maps: 0,
        details: false,
        coat: false,
        mask: false,
        transmission: false,
        sheen: false,
        lights: 0,
        masked_samples: false,
        draft: false,
    };

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
        assert_eq!(needs(&mesh, &settings), Needs { coat: true, ..NOTHING });
        let mut leaves = Material::plain("leaves", [1.0; 4]);
        leaves.look.alpha = Alpha::Mask(0.5);
        mesh.materials.push(leaves);
        assert_eq!(needs(&mesh, &settings), Needs { coat: true, mask: true, ..NOTHING });
        let own = |kind| mesh.materials.iter().map(move |own| NOTHING.own(own, kind).masked_samples);
        assert!(own(kind(4, false)).eq([false, false, true]));
        assert!(own(kind(1, false)).eq([false; 3]) && own(kind(4, true)).eq([false; 3]));
        assert!(!has_layers(&mesh));
        let mut glass = Material::plain("glass", [1.0; 4]);
        glass.look.transmission = 1.0;
        let mut painted = glass.clone();
        painted.look.unlit = true;
        mesh.materials = vec![painted];
        assert_eq!((needs(&mesh, &settings), has_layers(&mesh)), (NOTHING, false));
        mesh.materials.push(glass);
        assert_eq!((needs(&mesh, &settings), has_layers(&mesh)), (Needs { transmission: true, ..NOTHING }, true));
        mesh.materials[1].look = Look { alpha: Alpha::Blend, ..Look::default() };
        assert_eq!((needs(&mesh, &settings), has_layers(&mesh)), (Needs { mask: true, ..NOTHING }, true));
        let mut velvet = Material::plain("velvet", [1.0; 4]);
        velvet.look.sheen_color = [0.0, 0.1, 0.0];
        mesh.materials = vec![velvet.clone()];
        assert_eq!(needs(&mesh, &settings), Needs { sheen: true, ..NOTHING });
        velvet.look.unlit = true;
        mesh.materials = vec![velvet];
        assert_eq!(needs(&mesh, &settings), NOTHING);
        let sun =
            Light { kind: LightKind::Directional, intensity: Vec3::ONE, place: Vec3::ZERO, direction: Vec3::NEG_Y };
        mesh.lights = vec![sun; 3];
        assert_eq!(needs(&mesh, &settings).lights, 3);
        assert_eq!(needs(&mesh, &Settings { lights: FileLights::Off, ..settings }).lights, 0);
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
        assert!(own.eq([NOTHING, Needs { coat: true, ..NOTHING }, Needs { sheen: true, ..NOTHING }]));
    }
}
