//! What surfaces are made of, as glTF 2.0 describes it (specification, section 3.9 and appendix B).

use std::ops::Range;
use std::sync::Arc;

use serde::Serialize;

use super::{HeightMap, PartStyle, Sampling};
use crate::choice::choices;
use crate::defaults::with_defaults;

with_defaults! {
    /// The look of some of a mesh's patches; by default white, neither metal nor glossy.
    #[derive(Clone, Debug)]
    pub struct Material {
        /// The name in the file.
        pub name: String = String::new(),
        /// Linear RGBA, 0 to 1.
        pub base_color: [f32; 4] = [1.0; 4],
        /// The image that multiplies the base colour, at the corners' own texture coordinates. Materials that use the same image
        /// share it.
        pub texture: Option<Arc<Texture>> = None,
        /// How the base colour's image is sampled.
        pub sampling: Sampling = Sampling::default(),
        /// Whether its triangles are also meant to be seen from behind.
        pub double_sided: bool = false,
        /// How it reflects light.
        pub look: Look = Look::default(),
        /// The height image that the file gives it, at the corners' own texture coordinates.
        pub height: Option<HeightMap> = None,
        /// The mesh's triangles of this material.
        pub triangles: Range<u32> = 0..0,
        /// What these have in place of what is said for all, where their part says nothing.
        pub style: PartStyle = PartStyle::default(),
    }
}

impl Material {
    /// Returns a material of one colour (linear RGBA), neither metal nor glossy, without triangles.
    pub fn plain(name: &str, base_color: [f32; 4]) -> Self {
        Self { name: name.to_owned(), base_color, ..Self::default() }
    }

    /// Whether one may see what is behind its triangles: it blends, or it transmits light.
    pub fn shows_behind(&self) -> bool {
        self.look.alpha == Alpha::Blend || self.look.transmits()
    }
}

/// An 8-bit image with straight alpha, stored row by row from the top. Colours are sRGB; the numbers of normal maps and of the
/// other maps that aren't colours are linear.
#[derive(Clone, Debug)]
pub struct Texture {
    /// Width and height in px.
    pub size: [u32; 2],
    /// Red, green, blue and alpha: 4 bytes a pixel.
    pub rgba: Vec<u8>,
}

with_defaults! {
    /// How a material reflects and emits light. As JSON it has the numbers that need no explanation.
    #[derive(Clone, Debug, Serialize)]
    pub struct Look {
        /// 0 for dielectrics, 1 for metals.
        pub metallic: f32 = 0.0,
        /// Perceptual roughness, 0 (a mirror) to 1.
        pub roughness: f32 = 0.5,
        /// Linear RGB that the surface emits, its strength included.
        pub emissive: [f32; 3] = [0.0; 3],
        /// Factor of the first two components of the normal map's normals.
        #[serde(skip)]
        pub normal_scale: f32 = 1.0,
        /// How much of the occlusion map counts, 0 to 1.
        #[serde(skip)]
        pub occlusion_strength: f32 = 1.0,
        /// What the base colour's alpha does.
        #[serde(skip)]
        pub alpha: Alpha = Alpha::Opaque,
        /// Whether the base colour is shown as it is, without light (KHR_materials_unlit).
        pub unlit: bool = false,
        /// Index of refraction of a dielectric (KHR_materials_ior).
        pub ior: f32 = 1.5,
        /// Strength of a dielectric's reflection, 0 to 1 (KHR_materials_specular).
        pub specular: f32 = 1.0,
        /// Linear RGB of a dielectric's reflection seen head-on (KHR_materials_specular).
        pub specular_color: [f32; 3] = [1.0; 3],
        /// How much of the surface a clear coat covers, 0 to 1 (KHR_materials_clearcoat).
        pub clearcoat: f32 = 0.0,
        /// Perceptual roughness of the coat.
        pub clearcoat_roughness: f32 = 0.0,
        /// Factor of the first two components of the normals that the coat's own map has.
        #[serde(skip)]
        pub clearcoat_normal_scale: f32 = 1.0,
        /// How much of a dielectric's light goes through it in place of being scattered, 0 to 1 (KHR_materials_transmission).
        pub transmission: f32 = 0.0,
        /// Linear RGB of the light that fibres over the surface reflect, as those of cloth do; 0 without (KHR_materials_sheen).
        pub sheen_color: [f32; 3] = [0.0; 3],
        /// Perceptual roughness of the fibres, 0 (they stand upright) to 1.
        pub sheen_roughness: f32 = 0.0,
        /// How much longer highlights are along a direction than across it, 0 to 1 (KHR_materials_anisotropy).
        pub anisotropy: f32 = 0.0,
        /// The angle of that direction, in radians from the tangent towards the bitangent.
        pub anisotropy_rotation: f32 = 0.0,
        /// How far light goes through the body behind the surface, in object units; 0 for a thin surface, which bends no light
        /// (KHR_materials_volume).
        pub thickness: f32 = 0.0,
        /// After how many object units the body leaves `attenuation_color` of white light; infinitely many if it absorbs none.
        pub attenuation_distance: f32 = f32::INFINITY,
        /// Linear RGB.
        pub attenuation_color: [f32; 3] = [1.0; 3],
        /// The images beside that of the base colour, by [`Slot`].
        #[serde(skip)]
        pub maps: [Option<Map>; Slot::COUNT] = Default::default(),
    }
}

impl Look {
    /// How many images pictures show of a material beside that of the base colour. Where more are needed, the last slots' are
    /// left out. What [distorts](Self::distorts) needs one more, of what is behind it.
    pub const MOST_IMAGES: usize = 12;

    /// The maps whose texture coordinates tangents go along: those of the first one that there is.
    pub const TANGENT_SLOTS: [Slot; 3] = [Slot::Normal, Slot::ClearcoatNormal, Slot::Anisotropy];

    /// The texture coordinates that tangents go along, if any are needed: see [`Self::TANGENT_SLOTS`]. Without such a map, long
    /// highlights go along those of the base colour.
    pub fn tangent_uv(&self) -> Option<MapUv> {
        let map = Self::TANGENT_SLOTS.iter().find_map(|slot| self.maps[*slot as usize].as_ref());
        map.map(|map| map.uv).or_else(|| self.has_anisotropy().then_some(MapUv::Own))
    }

    /// Which of the file's sets of texture coordinates its maps use: see [`MapUv::Set`].
    pub fn uv_sets(&self) -> [bool; 2] {
        let uses = |set| self.maps.iter().flatten().any(|map| matches!(map.uv, MapUv::Set(own, _) if own == set));
        [uses(0), uses(1)]
    }

    /// Whether light goes through it. None does where it is unlit.
    pub fn transmits(&self) -> bool {
        self.transmission > 0.0 && !self.unlit
    }

    /// Whether light that goes through it is bent, and absorbed behind the surface.
    pub fn refracts(&self) -> bool {
        self.transmits() && self.thickness > 0.0
    }

    /// Whether what is behind it is seen elsewhere or blurred: by a body that refracts light, or a rough surface.
    pub fn distorts(&self) -> bool {
        self.distorts_with(self.maps[Slot::MetallicRoughness as usize].is_some())
    }

    /// The same, if it is to have a metallic-roughness map or not. No light goes through what is metallic everywhere.
    pub fn distorts_with(&self, has_metallic_map: bool) -> bool {
        let lets_through = self.transmits() && (self.metallic < 1.0 || has_metallic_map);
        lets_through && (self.thickness > 0.0 || self.roughness > 0.0)
    }

    /// The part of light that the body absorbs in an object unit, for short ways, as linear RGB (Beer and Lambert's coefficient).
    pub fn absorption(&self) -> [f32; 3] {
        self.attenuation_color.map(|left| -left.max(f32::MIN_POSITIVE).ln() / self.attenuation_distance)
    }

    /// Whether highlights are longer along a direction than across it.
    pub fn has_anisotropy(&self) -> bool {
        self.anisotropy > 0.0 && !self.unlit
    }

    /// Whether fibres over the surface reflect light. None do where it is unlit.
    pub fn has_sheen(&self) -> bool {
        self.sheen_color.iter().any(|channel| *channel > 0.0) && !self.unlit
    }
}

/// What the base colour's alpha does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Alpha {
    /// Nothing.
    #[default]
    Opaque,
    /// Below this number there is no surface.
    Mask(f32),
    /// How opaque the surface is.
    Blend,
}

choices! {
    /// What an image of a material says. Messages call it by its label.
    pub enum Slot {
        MetallicRoughness => "metallic-roughness", "metallic-roughness map",
            "Roughness in green and metalness in blue, linear.";
        Normal => "normal", "normal map", "Normals in tangent space, linear.";
        Occlusion => "occlusion", "occlusion map", "Occlusion of light from all around in red, linear.";
        Emissive => "emissive", "emissive map", "Emitted colour, sRGB.";
        Transmission => "transmission", "transmission map", "How much light goes through in red, linear.";
        SheenColor => "sheen-color", "sheen colour map", "Colour of the sheen, sRGB.";
        SheenRoughness => "sheen-roughness", "sheen roughness map", "Roughness of the sheen in alpha, linear.";
        Clearcoat => "clearcoat", "clear coat map", "How much of the surface the clear coat covers in red, linear.";
        ClearcoatRoughness => "clearcoat-roughness", "clear coat roughness map", "Roughness of the coat in green, linear.";
        ClearcoatNormal => "clearcoat-normal", "clear coat normal map", "Normals of the coat in tangent space, linear.";
        Specular => "specular", "specular map", "Strength of a dielectric's reflection in alpha, linear.";
        SpecularColor => "specular-color", "specular colour map", "Colour of a dielectric's reflection seen head-on, sRGB.";
        Anisotropy => "anisotropy", "anisotropy map", "Direction of long highlights in red and green, strength in blue, linear.";
        Thickness => "thickness", "thickness map", "Thickness of the body behind the surface in green, linear.";
    }
}

impl Slot {
    /// How many there are. [`Look::maps`] has them in the order of [`Self::ALL`].
    pub const COUNT: usize = Self::ALL.len();
}

/// An image on a surface.
#[derive(Clone, Debug)]
pub struct Map {
    /// The image.
    pub texture: Arc<Texture>,
    /// Where on the image a corner is.
    pub uv: MapUv,
    /// How the image is sampled.
    pub sampling: Sampling,
}

/// Texture coordinates of a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MapUv {
    /// Those of the base colour, which corners have themselves.
    Own,
    /// One of the sets that [`CornerDetails`](super::CornerDetails) has as they are in the file, 0 or 1, then an affine map:
    /// u' = a u + b v + c and v' = d u + e v + f, as `[a, b, c, d, e, f]` (KHR_texture_transform).
    Set(usize, [f32; 6]),
}
