//! What documents call the numbers and maps of a material, and ways of sampling. The reader and the writer follow these tables.
//!
//! Sources: glTF 2.0 specification, section 3.9; Khronos' extensions KHR_materials_anisotropy, KHR_materials_clearcoat,
//! KHR_materials_ior, KHR_materials_sheen, KHR_materials_specular, KHR_materials_transmission and KHR_materials_volume.

use Member::{Color, Map, Number as One, ScaledMap};
use geometry::mesh::{Look, Slot, Wrap};

/// What a member of an object is.
pub enum Member {
    /// A number of a look, and its least and its greatest value.
    Number(Number, [f32; 2]),
    /// Three numbers.
    Color(fn(&mut Look) -> &mut [f32; 3], [f32; 2]),
    /// A map.
    Map(Slot),
    /// A map with a number of its own, which has this name.
    ScaledMap(Slot, &'static str, Number, [f32; 2]),
}

/// Where a look has a number.
type Number = fn(&mut Look) -> &mut f32;

/// Members of an object, by name. Maps come after the numbers that say whether they matter.
pub type Members = [(&'static str, Member)];

/// An extension of materials: its name, whether anything of it can be seen, and what its object has.
pub type Extension = (&'static str, fn(&Look) -> bool, &'static Members);

/// From 0 to 1.
pub const UNIT: [f32; 2] = [0.0, 1.0];
/// From 0 to what any number of a material may be at most: products of two are finite.
pub const POSITIVE: [f32; 2] = [0.0, 1e18];
/// As far below 0 as above.
pub const ANY: [f32; 2] = [-1e18, 1e18];

/// The maps that a material has itself.
pub const MAPS: &Members = &[
    ("normalTexture", ScaledMap(Slot::Normal, "scale", |look| &mut look.normal_scale, ANY)),
    ("occlusionTexture", ScaledMap(Slot::Occlusion, "strength", |look| &mut look.occlusion_strength, UNIT)),
    ("emissiveTexture", Map(Slot::Emissive)),
];

/// What `pbrMetallicRoughness` has besides the base colour.
pub const METALLIC_ROUGHNESS: &Members = &[
    ("metallicFactor", One(|look| &mut look.metallic, UNIT)),
    ("roughnessFactor", One(|look| &mut look.roughness, UNIT)),
    ("metallicRoughnessTexture", Map(Slot::MetallicRoughness)),
];

/// Extensions whose members are numbers and maps of a look. They have the values of [`Look::default`] unless they say
/// otherwise. Images of a coat that isn't there needn't be read.
pub const EXTENSIONS: [Extension; 7] = [
    ("KHR_materials_ior", |_| true, &[("ior", One(|look| &mut look.ior, POSITIVE))]),
    ("KHR_materials_specular", |_| true, SPECULAR),
    ("KHR_materials_clearcoat", |look| look.clearcoat > 0.0, CLEARCOAT),
    ("KHR_materials_transmission", |look| look.transmission > 0.0, TRANSMISSION),
    ("KHR_materials_sheen", Look::has_sheen, SHEEN),
    ("KHR_materials_anisotropy", Look::has_anisotropy, ANISOTROPY),
    ("KHR_materials_volume", |look| look.thickness > 0.0, VOLUME),
];

const SPECULAR: &Members = &[
    ("specularFactor", One(|look| &mut look.specular, UNIT)),
    ("specularColorFactor", Color(|look| &mut look.specular_color, POSITIVE)),
    ("specularTexture", Map(Slot::Specular)),
    ("specularColorTexture", Map(Slot::SpecularColor)),
];

const CLEARCOAT: &Members = &[
    ("clearcoatFactor", One(|look| &mut look.clearcoat, UNIT)),
    ("clearcoatRoughnessFactor", One(|look| &mut look.clearcoat_roughness, UNIT)),
    ("clearcoatTexture", Map(Slot::Clearcoat)),
    ("clearcoatRoughnessTexture", Map(Slot::ClearcoatRoughness)),
    ("clearcoatNormalTexture", ScaledMap(Slot::ClearcoatNormal, "scale", |look| &mut look.clearcoat_normal_scale, ANY)),
];

const TRANSMISSION: &Members = &[
    ("transmissionFactor", One(|look| &mut look.transmission, UNIT)),
    ("transmissionTexture", Map(Slot::Transmission)),
];

const SHEEN: &Members = &[
    ("sheenColorFactor", Color(|look| &mut look.sheen_color, UNIT)),
    ("sheenRoughnessFactor", One(|look| &mut look.sheen_roughness, UNIT)),
    ("sheenColorTexture", Map(Slot::SheenColor)),
    ("sheenRoughnessTexture", Map(Slot::SheenRoughness)),
];

const ANISOTROPY: &Members = &[
    ("anisotropyStrength", One(|look| &mut look.anisotropy, UNIT)),
    ("anisotropyRotation", One(|look| &mut look.anisotropy_rotation, ANY)),
    ("anisotropyTexture", Map(Slot::Anisotropy)),
];

const VOLUME: &Members = &[
    ("thicknessFactor", One(|look| &mut look.thickness, POSITIVE)),
    ("attenuationDistance", One(|look| &mut look.attenuation_distance, POSITIVE)),
    ("attenuationColor", Color(|look| &mut look.attenuation_color, UNIT)),
    ("thicknessTexture", Map(Slot::Thickness)),
];

/// What is beyond an image, by the codes of samplers, which are OpenGL's.
pub const WRAPS: [(u64, Wrap); 3] = [(10497, Wrap::Repeat), (33071, Wrap::Clamp), (33648, Wrap::Mirror)];
/// Whether texels are blended where they are larger than pixels, by code.
pub const MAGNIFY: [(u64, bool); 2] = [(9728, false), (9729, true)];
/// Whether they are where they are smaller, and whether mip levels are.
pub const MINIFY: [(u64, (bool, Option<bool>)); 6] = [
    (9728, (false, None)),
    (9729, (true, None)),
    (9984, (false, Some(false))),
    (9985, (true, Some(false))),
    (9986, (false, Some(true))),
    (9987, (true, Some(true))),
];
