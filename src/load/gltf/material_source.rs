//! Reads what a document says about a material, without its images.
//!
//! Sources: glTF 2.0 specification, section 3.9; Khronos' extensions KHR_materials_clearcoat, KHR_materials_emissive_strength,
//! KHR_materials_ior, KHR_materials_sheen, KHR_materials_specular, KHR_materials_transmission, KHR_materials_unlit and
//! KHR_materials_pbrSpecularGlossiness; the draft KHR_materials_displacement, <https://github.com/KhronosGroup/glTF/issues/948>.

use super::lenient::Members;
use super::schema::TRANSFORM;
use super::uv_transform::UvTransform;
use geometry::mesh::{Alpha, HeightAmount, Look, Slot};

/// A material of a document. Its images are still to be read.
#[derive(Clone, Debug, Default)]
pub(super) struct MaterialSource {
    /// None without a name.
    pub name: Option<String>,
    pub base_color: [f32; 4],
    pub base_map: Option<MapSource>,
    pub double_sided: bool,
    /// Without maps.
    pub look: Look,
    pub maps: [Option<MapSource>; Slot::COUNT],
    /// The height image, and how far it moves the surface.
    pub height: Option<(MapSource, Option<HeightAmount>)>,
    /// Factor of the glossiness that the specular colour's image has in alpha; none if it has none.
    pub glossiness: Option<f32>,
    /// Names of extensions, and of parts of extensions, that aren't drawn.
    pub undrawn: Vec<String>,
}

/// A texture of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MapSource {
    /// Index into the document's textures.
    pub texture: usize,
    pub uvs: Uvs,
}

/// Which texture coordinates a texture uses, and how they are transformed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Uvs {
    /// The n of TEXCOORD_n.
    pub set: u32,
    pub transform: Option<UvTransform>,
}

const TRANSMISSION: &str = "KHR_materials_transmission";
const DISPLACEMENT: &str = "KHR_materials_displacement";

/// Extensions that aren't drawn, and the number of each that is 0 where it changes nothing.
const STRENGTHS: [(&str, &str); 5] = [
    ("KHR_materials_anisotropy", "anisotropyStrength"),
    ("KHR_materials_diffuse_transmission", "diffuseTransmissionFactor"),
    ("KHR_materials_dispersion", "dispersion"),
    ("KHR_materials_iridescence", "iridescenceFactor"),
    ("KHR_materials_volume", "thicknessFactor"),
];

/// From 0 to 1.
const UNIT: [f32; 2] = [0.0, 1.0];
/// From 0 to what any number of a material may be at most: products of two are finite.
const POSITIVE: [f32; 2] = [0.0, 1e18];
const ANY: [f32; 2] = [-1e18, 1e18];

impl MaterialSource {
    /// Reads a material, or returns that of primitives without one. `textures` is how many the document has.
    pub(super) fn new(members: Option<&Members>, textures: usize) -> Self {
        // What glTF says about a material without members: it is a rough metal.
        let look = Look { metallic: 1.0, roughness: 1.0, ..Look::default() };
        let mut source = Self { base_color: [1.0; 4], look, ..Self::default() };
        let Some(members) = members else { return source };
        source.name = members.text("name").map(str::to_owned);
        source.double_sided = members.flag("doubleSided");
        if let Some(rough) = members.inside("pbrMetallicRoughness") {
            source.base_color = rough.numbers("baseColorFactor", [1.0; 4], UNIT);
            source.look.metallic = rough.number("metallicFactor", 1.0, UNIT);
            source.look.roughness = rough.number("roughnessFactor", 1.0, UNIT);
            source.base_map = MapSource::new(&rough, "baseColorTexture", textures);
            source.map(Slot::MetallicRoughness, MapSource::new(&rough, "metallicRoughnessTexture", textures));
        }
        if let Some(normal) = members.inside("normalTexture") {
            source.look.normal_scale = normal.number("scale", 1.0, ANY);
            source.map(Slot::Normal, MapSource::inside(&normal, textures));
        }
        if let Some(occlusion) = members.inside("occlusionTexture") {
            source.look.occlusion_strength = occlusion.number("strength", 1.0, UNIT);
            source.map(Slot::Occlusion, MapSource::inside(&occlusion, textures));
        }
        source.look.emissive = members.numbers("emissiveFactor", [0.0; 3], UNIT);
        source.map(Slot::Emissive, MapSource::new(members, "emissiveTexture", textures));
        let cutoff = members.number("alphaCutoff", 0.5, POSITIVE);
        source.look.alpha = match members.word("alphaMode", &["OPAQUE", "MASK", "BLEND"]) {
            "MASK" => Alpha::Mask(cutoff),
            "BLEND" => Alpha::Blend,
            _ => Alpha::Opaque,
        };
        if let Some(extensions) = members.inside("extensions") {
            source.extend(&extensions, textures);
        }
        source
    }

    fn map(&mut self, slot: Slot, map: Option<MapSource>) {
        self.maps[slot as usize] = map;
    }

    /// Applies extensions.
    fn extend(&mut self, extensions: &Members, textures: usize) {
        let look = &mut self.look;
        if let Some(emissive) = extensions.inside("KHR_materials_emissive_strength") {
            let strength = emissive.number("emissiveStrength", 1.0, POSITIVE);
            look.emissive = look.emissive.map(|factor| factor * strength);
        }
        if let Some(ior) = extensions.inside("KHR_materials_ior") {
            look.ior = index_of_refraction(&ior);
        }
        if let Some(specular) = extensions.inside("KHR_materials_specular") {
            look.specular = specular.number("specularFactor", 1.0, UNIT);
            look.specular_color = specular.numbers("specularColorFactor", [1.0; 3], POSITIVE);
            self.map(Slot::Specular, MapSource::new(&specular, "specularTexture", textures));
            self.map(Slot::SpecularColor, MapSource::new(&specular, "specularColorTexture", textures));
        }
        if let Some(coat) = extensions.inside("KHR_materials_clearcoat") {
            self.coat(&coat, textures);
        }
        self.look.unlit = extensions.has("KHR_materials_unlit");
        if let Some(transmission) = extensions.inside(TRANSMISSION) {
            self.look.transmission = transmission.number("transmissionFactor", 0.0, UNIT);
            self.map(Slot::Transmission, MapSource::new(&transmission, "transmissionTexture", textures));
        }
        if let Some(sheen) = extensions.inside("KHR_materials_sheen") {
            self.look.sheen_color = sheen.numbers("sheenColorFactor", [0.0; 3], UNIT);
            self.look.sheen_roughness = sheen.number("sheenRoughnessFactor", 0.0, UNIT);
            // Images of a sheen that isn't there needn't be read.
            if self.look.has_sheen() {
                self.map(Slot::SheenColor, MapSource::new(&sheen, "sheenColorTexture", textures));
                self.map(Slot::SheenRoughness, MapSource::new(&sheen, "sheenRoughnessTexture", textures));
            }
        }
        if let Some(glossy) = extensions.inside("KHR_materials_pbrSpecularGlossiness") {
            self.glossy(&glossy, textures);
        }
        if let Some(displacement) = extensions.inside(DISPLACEMENT) {
            self.height = height(&displacement, textures);
        }
        self.note_undrawn(extensions);
    }

    fn coat(&mut self, coat: &Members, textures: usize) {
        self.look.clearcoat = coat.number("clearcoatFactor", 0.0, UNIT);
        self.look.clearcoat_roughness = coat.number("clearcoatRoughnessFactor", 0.0, UNIT);
        // Images of a coat that isn't there needn't be read.
        if self.look.clearcoat > 0.0 {
            self.map(Slot::Clearcoat, MapSource::new(coat, "clearcoatTexture", textures));
            self.map(Slot::ClearcoatRoughness, MapSource::new(coat, "clearcoatRoughnessTexture", textures));
            if let Some(normal) = coat.inside("clearcoatNormalTexture") {
                self.look.clearcoat_normal_scale = normal.number("scale", 1.0, ANY);
                self.map(Slot::ClearcoatNormal, MapSource::inside(&normal, textures));
            }
        }
    }

    /// Converts the older description by diffuse and specular colours, which replaces the other: a dielectric whose reflection
    /// seen head-on is the specular colour itself. KHR_materials_ior has the index 0 for this.
    fn glossy(&mut self, glossy: &Members, textures: usize) {
        self.base_color = glossy.numbers("diffuseFactor", [1.0; 4], UNIT);
        self.base_map = MapSource::new(glossy, "diffuseTexture", textures);
        self.map(Slot::MetallicRoughness, None);
        self.map(Slot::Specular, None);
        self.map(Slot::SpecularColor, MapSource::new(glossy, "specularGlossinessTexture", textures));
        let glossiness = glossy.number("glossinessFactor", 1.0, UNIT);
        self.glossiness = Some(glossiness);
        let look = &mut self.look;
        (look.metallic, look.ior, look.specular) = (0.0, 0.0, 1.0);
        look.roughness = 1.0 - glossiness;
        look.specular_color = glossy.numbers("specularFactor", [1.0; 3], UNIT);
    }

    /// Notes extensions that aren't drawn, where they would change something.
    fn note_undrawn(&mut self, extensions: &Members) {
        for name in extensions.names() {
            match name {
                "KHR_materials_clearcoat" | "KHR_materials_specular" | "KHR_materials_pbrSpecularGlossiness" => {}
                "KHR_materials_emissive_strength" | "KHR_materials_ior" => {}
                "KHR_materials_sheen" | "KHR_materials_unlit" | DISPLACEMENT => {}
                TRANSMISSION => {
                    // Metal lets no light through.
                    let is_metal = self.look.metallic >= 1.0 && self.maps[Slot::MetallicRoughness as usize].is_none();
                    if self.look.transmits() && self.look.roughness > 0.0 && !is_metal {
                        self.undrawn.push(format!("blur of what is behind rough surfaces ({TRANSMISSION})"));
                    }
                }
                _ => {
                    let strength = STRENGTHS.iter().find(|(extension, _)| *extension == name);
                    let strength = strength.and_then(|(_, number)| Some((number, extensions.inside(name)?)));
                    if strength.is_none_or(|(number, members)| members.number(number, 0.0, POSITIVE) > 0.0) {
                        self.undrawn.push(crate::uri::shown(name));
                    }
                }
            }
        }
    }

    /// Returns the texture coordinates that corners have themselves.
    pub(super) fn own_uvs(&self) -> Uvs {
        let height = self.height.as_ref().map(|(map, _)| *map);
        self.base_map.or(height).map_or_else(Uvs::default, |map| map.uvs)
    }

    /// Returns whether corners need more than position, normal and texture coordinates.
    pub(super) fn needs_details(&self) -> bool {
        let others = self.maps.iter().flatten().any(|map| map.uvs != self.own_uvs());
        others || Look::TANGENT_SLOTS.iter().any(|slot| self.maps[*slot as usize].is_some())
    }
}

/// Reads a height image. Drafts of the extension name its members differently.
fn height(displacement: &Members, textures: usize) -> Option<(MapSource, Option<HeightAmount>)> {
    let [texture, factor, offset] = match displacement.has("displacementTexture") {
        true => ["displacementTexture", "displacementFactor", "displacementOffset"],
        false => ["displacementGeometryTexture", "displacementGeometryFactor", "displacementGeometryOffset"],
    };
    let map = MapSource::new(displacement, texture, textures)?;
    let (factor, offset) = (displacement.number(factor, 1.0, ANY), displacement.number(offset, 0.0, ANY));
    Some((map, HeightAmount::from_factor(factor, offset)))
}

/// Returns an index of refraction: from 1 on, or 0, which stands for an infinite one.
fn index_of_refraction(members: &Members) -> f32 {
    let ior = members.number("ior", 1.5, POSITIVE);
    if ior > 0.0 && ior < 1.0 {
        members.say(&format!("has the index of refraction {ior}, below that of a vacuum; 1 is used"));
        return 1.0;
    }
    ior
}

impl MapSource {
    /// Reads a texture in a member; none without one, or if the document doesn't have it.
    fn new(members: &Members, name: &str, textures: usize) -> Option<Self> {
        Self::inside(&members.inside(name)?, textures)
    }

    fn inside(info: &Members, textures: usize) -> Option<Self> {
        if !info.has("index") {
            info.say("has no index; it is left out");
        }
        let texture = info.index("index", "textures", textures)?;
        let set = info.uv_set("texCoord").unwrap_or(0);
        let transform = info.inside("extensions").and_then(|extensions| extensions.inside(TRANSFORM));
        Some(Self {
            texture,
            uvs: Uvs {
                set: transform.as_ref().and_then(|transform| transform.uv_set("texCoord")).unwrap_or(set),
                transform: transform.as_ref().and_then(UvTransform::new),
            },
        })
    }
}
