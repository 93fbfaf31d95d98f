//! Reads what a document says about a material, without its images.
//!
//! Sources: glTF 2.0 specification, section 3.9; Khronos' extensions KHR_materials_emissive_strength, KHR_materials_unlit and
//! KHR_materials_pbrSpecularGlossiness, and those of [`EXTENSIONS`]; the draft KHR_materials_displacement,
//! <https://github.com/KhronosGroup/glTF/issues/948>.

use super::lenient::Members;
use super::material_members::{self, ANY, EXTENSIONS, MAPS, METALLIC_ROUGHNESS, Member, POSITIVE, UNIT};
use super::schema::TRANSFORM;
use crate::map_uvs::{MapUvs, affine};
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
    /// Those of TEXCOORD_n, with the set n.
    pub uvs: MapUvs,
}

/// Extensions that aren't drawn, and the number of each that is 0 where it changes nothing.
const STRENGTHS: [(&str, &str); 3] = [
    ("KHR_materials_diffuse_transmission", "diffuseTransmissionFactor"),
    ("KHR_materials_dispersion", "dispersion"),
    ("KHR_materials_iridescence", "iridescenceFactor"),
];

const UNLIT: &str = "KHR_materials_unlit";
const EMISSIVE_STRENGTH: &str = "KHR_materials_emissive_strength";
const GLOSSINESS: &str = "KHR_materials_pbrSpecularGlossiness";
const DISPLACEMENT: &str = "KHR_materials_displacement";

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
            source.base_map = MapSource::new(&rough, "baseColorTexture", textures);
            source.read(&rough, METALLIC_ROUGHNESS, |_| true, textures);
        }
        source.look.emissive = members.numbers("emissiveFactor", [0.0; 3], UNIT);
        source.read(members, MAPS, |_| true, textures);
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

    /// Reads members of an object: maps only where they matter to the look that was read so far.
    fn read(
        &mut self,
        object: &Members,
        members: &material_members::Members,
        matters: fn(&Look) -> bool,
        textures: usize,
    ) {
        for (name, member) in members {
            match member {
                Member::Number(number, range) => {
                    let own = number(&mut self.look);
                    *own = object.number(name, *own, *range);
                }
                Member::Color(color, range) => {
                    let own = color(&mut self.look);
                    *own = object.numbers(name, *own, *range);
                }
                Member::Map(_) | Member::ScaledMap(..) if !matters(&self.look) => {}
                Member::Map(slot) => self.maps[*slot as usize] = MapSource::new(object, name, textures),
                Member::ScaledMap(slot, factor, number, range) => {
                    if let Some(info) = object.inside(name) {
                        let own = number(&mut self.look);
                        *own = info.number(factor, *own, *range);
                        self.maps[*slot as usize] = MapSource::inside(&info, textures);
                    }
                }
            }
        }
    }

    /// Applies extensions.
    fn extend(&mut self, extensions: &Members, textures: usize) {
        if let Some(emissive) = extensions.inside(EMISSIVE_STRENGTH) {
            let strength = emissive.number("emissiveStrength", 1.0, POSITIVE);
            self.look.emissive = self.look.emissive.map(|factor| factor * strength);
        }
        self.look.unlit = extensions.has(UNLIT);
        for (name, matters, members) in EXTENSIONS {
            if let Some(object) = extensions.inside(name) {
                self.read(&object, members, matters, textures);
                self.correct(&object);
            }
        }
        if let Some(glossy) = extensions.inside(GLOSSINESS) {
            self.glossy(&glossy, textures);
        }
        if let Some(displacement) = extensions.inside(DISPLACEMENT) {
            self.height = height(&displacement, textures);
        }
        self.note_undrawn(extensions);
    }

    /// Replaces numbers that mean nothing of the extension that was read last.
    fn correct(&mut self, extension: &Members) {
        // 0 stands for an infinite index.
        let Look { ior, attenuation_distance, .. } = &mut self.look;
        if *ior > 0.0 && *ior < 1.0 {
            extension.say(&format!("has the index of refraction {ior}, below that of a vacuum; 1 is used"));
            *ior = 1.0;
        }
        if *attenuation_distance == 0.0 {
            extension.say("has the attenuation distance 0, after which there is no light left; nothing is absorbed");
            *attenuation_distance = f32::INFINITY;
        }
    }

    /// Converts the older description by diffuse and specular colours, which replaces the other: a dielectric whose reflection
    /// seen head-on is the specular colour itself. KHR_materials_ior has the index 0 for this.
    fn glossy(&mut self, glossy: &Members, textures: usize) {
        self.base_color = glossy.numbers("diffuseFactor", [1.0; 4], UNIT);
        self.base_map = MapSource::new(glossy, "diffuseTexture", textures);
        self.maps[Slot::MetallicRoughness as usize] = None;
        self.maps[Slot::Specular as usize] = None;
        self.maps[Slot::SpecularColor as usize] = MapSource::new(glossy, "specularGlossinessTexture", textures);
        let glossiness = glossy.number("glossinessFactor", 1.0, UNIT);
        self.glossiness = Some(glossiness);
        let look = &mut self.look;
        (look.metallic, look.ior, look.specular) = (0.0, 0.0, 1.0);
        look.roughness = 1.0 - glossiness;
        look.specular_color = glossy.numbers("specularFactor", [1.0; 3], UNIT);
    }

    /// Notes extensions that aren't drawn, where they would change something, and other parts of the material that aren't.
    fn note_undrawn(&mut self, extensions: &Members) {
        let is_drawn = |name| {
            [UNLIT, EMISSIVE_STRENGTH, GLOSSINESS, DISPLACEMENT].contains(&name)
                || EXTENSIONS.iter().any(|(own, ..)| *own == name)
        };
        for name in extensions.names().filter(|name| !is_drawn(name)) {
            let strength = STRENGTHS.iter().find(|(extension, _)| *extension == name);
            let strength = strength.and_then(|(_, number)| Some((number, extensions.inside(name)?)));
            if strength.is_none_or(|(number, members)| members.number(number, 0.0, POSITIVE) > 0.0) {
                self.undrawn.push(crate::uri::shown(name));
            }
        }
        let distorts = self.look.distorts_with(self.maps[Slot::MetallicRoughness as usize].is_some());
        let most_maps = Look::MOST_IMAGES - usize::from(distorts);
        if self.maps.iter().flatten().count() > most_maps {
            self.undrawn.push(format!("a map beyond the first {most_maps}"));
        }
    }

    /// Returns the texture coordinates that corners have themselves.
    pub(super) fn own_uvs(&self) -> MapUvs {
        let height = self.height.as_ref().map(|(map, _)| *map);
        self.base_map.or(height).map_or_else(MapUvs::default, |map| map.uvs)
    }

    /// Returns whether corners need more than position, normal and texture coordinates.
    pub(super) fn needs_details(&self) -> bool {
        let others = self.maps.iter().flatten().any(|map| map.uvs != self.own_uvs());
        let is_mapped = Look::TANGENT_SLOTS.iter().any(|slot| self.maps[*slot as usize].is_some());
        others || is_mapped || self.look.has_anisotropy()
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
        let mut uvs = MapUvs { set: info.uv_set("texCoord").unwrap_or(0), ..MapUvs::default() };
        if let Some(own) = info.inside("extensions").and_then(|extensions| extensions.inside(TRANSFORM)) {
            uvs.set = own.uv_set("texCoord").unwrap_or(uvs.set);
            let (offset, angle) = (own.numbers("offset", [0.0; 2], ANY), own.number("rotation", 0.0, ANY));
            uvs.transform = affine(own.numbers("scale", [1.0; 2], ANY), angle, offset);
        }
        Some(Self { texture, uvs })
    }
}
