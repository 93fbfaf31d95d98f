//! Writes materials with their images, and all of their numbers.
//!
//! Sources: glTF 2.0 specification, section 3.9; Khronos' extensions KHR_materials_emissive_strength, KHR_materials_unlit and
//! KHR_texture_transform, and those of [`EXTENSIONS`].

use std::io::Cursor;
use std::sync::Arc;

use serde_json::{Value, json};

use super::Writer;
use crate::export::ExportError;
use geometry::mesh::{Alpha, Look, Map, MapUv, Material, Sampling, Slot, Texture};
use geometry::names;
use load::material_members::{EXTENSIONS, MAGNIFY, MAPS, METALLIC_ROUGHNESS, MINIFY, Member, Members, WRAPS};

const TRANSFORM: &str = "KHR_texture_transform";

/// How far, relative to its largest number, an affine map may be from a scale and a rotation.
const LEAST_SHEAR: f32 = 1e-4;

/// Texture coordinates of vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum UvSet {
    /// Those of the base colour.
    Own,
    /// One of the file's sets, as it was there.
    File(usize),
}

/// The texture coordinates that a material's primitive gets. Readers may know two sets only (specification, section 3.7.2.1), so
/// that sets without use are left out.
pub(super) struct UvSets {
    /// In the order of TEXCOORD_n.
    sets: Vec<UvSet>,
    /// Whether those of the base colour are those of the file's first set.
    own_is_first: bool,
}

impl UvSets {
    pub(super) fn new(material: &Material) -> Self {
        // Without an image of the base colour, corners have the first set themselves.
        let own_is_first = material.texture.is_none();
        let [first, second] = material.look.uv_sets();
        let sets = match [first && !own_is_first, second] {
            [false, false] => vec![UvSet::Own],
            [true, false] => vec![UvSet::Own, UvSet::File(0)],
            [false, true] => vec![UvSet::Own, UvSet::File(1)],
            // This program reads any set for the base colour, and the first two for other maps.
            [true, true] => vec![UvSet::File(0), UvSet::File(1), UvSet::Own],
        };
        Self { sets, own_is_first }
    }

    /// Those that are written, in the order of TEXCOORD_n.
    pub(super) fn written(&self) -> impl Iterator<Item = UvSet> {
        self.sets.iter().copied()
    }

    /// The n of TEXCOORD_n.
    fn number(&self, set: UvSet) -> usize {
        let set = if self.own_is_first && set == UvSet::File(0) { UvSet::Own } else { set };
        self.sets.iter().position(|written| *written == set).unwrap_or(0)
    }
}

impl Writer {
    /// Returns the index of a material.
    ///
    /// # Errors
    /// An image can't be encoded.
    pub(super) fn material(&mut self, material: &Material, sets: &UvSets) -> Result<usize, ExportError> {
        let mut parts = LookParts { look: material.look.clone(), maps: Default::default() };
        for (map, info) in material.look.maps.iter().zip(&mut parts.maps) {
            if let Some(map) = map {
                *info = self.map(map, material, sets)?;
            }
        }
        let mut rough = json!({ "baseColorFactor": material.base_color });
        if let Some(image) = &material.texture {
            let index = self.texture(image, material.sampling)?;
            rough["baseColorTexture"] = json!({ "index": index, "texCoord": sets.number(UvSet::Own) });
        }
        parts.write(METALLIC_ROUGHNESS, &mut rough);
        let mut written = json!({
            "name": material.name,
            "pbrMetallicRoughness": rough,
            "doubleSided": material.double_sided,
        });
        parts.write(MAPS, &mut written);
        written["alphaMode"] = json!(match material.look.alpha {
            Alpha::Opaque => "OPAQUE",
            Alpha::Mask(_) => "MASK",
            Alpha::Blend => "BLEND",
        });
        if let Alpha::Mask(cutoff) = material.look.alpha {
            written["alphaCutoff"] = json!(cutoff);
        }
        self.emission(&material.look, &mut written);
        if material.look.unlit {
            self.extend(&mut written, "KHR_materials_unlit", json!({}));
        }
        for (name, matters, members) in EXTENSIONS {
            if matters(&material.look) && parts.differ(members) {
                let mut object = json!({});
                parts.write(members, &mut object);
                self.extend(&mut written, name, object);
            }
        }
        Ok(self.push("materials", written))
    }

    /// Adds what a material emits. A factor is 1 at most; what is beyond needs an extension.
    fn emission(&mut self, look: &Look, written: &mut Value) {
        let brightest = look.emissive.into_iter().fold(1.0_f32, f32::max);
        written["emissiveFactor"] = json!(look.emissive.map(|channel| (channel / brightest).clamp(0.0, 1.0)));
        if brightest > 1.0 {
            let members = json!({ "emissiveStrength": brightest });
            self.extend(written, "KHR_materials_emissive_strength", members);
        }
    }

    /// Returns where a map is and how it is placed; none, with a warning, for one that glTF can't place so.
    fn map(&mut self, map: &Map, material: &Material, sets: &UvSets) -> Result<Option<Value>, ExportError> {
        let (set, affine) = match map.uv {
            MapUv::Own => (UvSet::Own, [1.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
            MapUv::Set(set, affine) => (UvSet::File(set), affine),
        };
        let Some(transform) = transform(affine) else {
            let (path, name) = (&self.path, names::shown(&material.name));
            self.warnings.push(format!(
                "{path}: a map of material \"{name}\" is left out, because glTF can't shear texture coordinates."
            ));
            return Ok(None);
        };
        let index = self.texture(&map.texture, map.sampling)?;
        let mut info = json!({ "index": index, "texCoord": sets.number(set) });
        if let Some(transform) = transform {
            self.extend(&mut info, TRANSFORM, transform);
        }
        Ok(Some(info))
    }

    /// Returns the texture for an image that is sampled in a way.
    fn texture(&mut self, image: &Arc<Texture>, sampling: Sampling) -> Result<usize, ExportError> {
        let source = match self.written.iter().position(|own| *own == Arc::as_ptr(image)) {
            Some(index) => index,
            None => self.image(image)?,
        };
        let sampler = self.shared("samplers", sampler(sampling));
        Ok(self.shared("textures", json!({ "source": source, "sampler": sampler })))
    }

    /// Writes an image as PNG.
    fn image(&mut self, texture: &Texture) -> Result<usize, ExportError> {
        self.written.push(texture);
        let ([width, height], mut png) = (texture.size, Cursor::new(Vec::new()));
        let (color, format) = (image::ExtendedColorType::Rgba8, image::ImageFormat::Png);
        image::write_buffer_with_format(&mut png, &texture.rgba, width, height, color, format)
            .map_err(|reason| ExportError::Texture { path: self.path.clone(), reason: reason.to_string() })?;
        let view = self.view(png.get_ref(), None);
        Ok(self.push("images", json!({ "bufferView": view, "mimeType": "image/png" })))
    }
}

/// A look that is being written.
struct LookParts {
    look: Look,
    /// Where its maps are, and how they are placed. Each is taken when it is written.
    maps: [Option<Value>; Slot::COUNT],
}

impl LookParts {
    /// Whether any of these members has a value that says something.
    fn differ(&mut self, members: &Members) -> bool {
        let usual = &mut Look::default();
        members.iter().any(|(_, member)| match member {
            Member::Number(number, _) => number(&mut self.look) != number(usual),
            Member::Color(color, _) => color(&mut self.look) != color(usual),
            Member::Map(slot) | Member::ScaledMap(slot, ..) => self.maps[*slot as usize].is_some(),
        })
    }

    /// Sets members of an object: all numbers that are finite, and the maps that there are.
    fn write(&mut self, members: &Members, object: &mut Value) {
        for (name, member) in members {
            match member {
                Member::Number(number, _) => {
                    let own = Some(*number(&mut self.look)).filter(|own| own.is_finite());
                    own.into_iter().for_each(|own| object[*name] = json!(own));
                }
                Member::Color(color, _) => object[*name] = json!(*color(&mut self.look)),
                Member::Map(slot) | Member::ScaledMap(slot, ..) => {
                    let Some(mut info) = self.maps[*slot as usize].take() else { continue };
                    if let Member::ScaledMap(_, factor, number, _) = member {
                        info[*factor] = json!(*number(&mut self.look));
                    }
                    object[*name] = info;
                }
            }
        }
    }
}

/// Returns the members of KHR_texture_transform for an affine map of texture coordinates (see [`MapUv`]), which scales, turns and
/// then moves: none if it changes nothing, and `None` if there are no such members because it shears.
fn transform([a, b, c, d, e, f]: [f32; 6]) -> Option<Option<Value>> {
    if [a, b, c, d, e, f] == [1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
        return Some(None);
    }
    // The columns are (cos, -sin) times the first scale, and (sin, cos) times the second one.
    let (first, second) = (a.hypot(d), b.hypot(e));
    let [cos, sin] = match (first > 0.0, second > 0.0) {
        (true, _) => [a / first, -d / first],
        (false, true) => [e / second, b / second],
        (false, false) => [1.0, 0.0],
    };
    let scale = [first, b * sin + e * cos];
    let shear = (b * cos - e * sin).abs();
    if shear > LEAST_SHEAR * second {
        return None;
    }
    Some(Some(json!({ "offset": [c, f], "rotation": sin.atan2(cos), "scale": scale })))
}

fn sampler(sampling: Sampling) -> Value {
    json!({
        "magFilter": code(&MAGNIFY, sampling.magnify_linear),
        "minFilter": code(&MINIFY, (sampling.minify_linear, sampling.mip_linear)),
        "wrapS": code(&WRAPS, sampling.wrap[0]),
        "wrapT": code(&WRAPS, sampling.wrap[1]),
    })
}

/// The code of a value, of which each has one.
fn code<T: PartialEq>(codes: &[(u64, T)], value: T) -> Option<u64> {
    codes.iter().find(|(_, own)| *own == value).map(|(code, _)| *code)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the members say, as six numbers: the formula of KHR_texture_transform.
    fn affine(members: &Value) -> [f32; 6] {
        let number = |value: &Value| value.as_f64().expect("a number") as f32;
        let [x, y] = [0, 1].map(|i| number(&members["scale"][i]));
        let (sin, cos) = number(&members["rotation"]).sin_cos();
        let [c, f] = [0, 1].map(|i| number(&members["offset"][i]));
        [cos * x, sin * y, c, -sin * x, cos * y, f]
    }

    #[test]
    fn an_affine_map_becomes_a_transform_and_back() {
        assert_eq!(transform([1.0, 0.0, 0.0, 0.0, 1.0, 0.0]), Some(None));
        for rotation in [0.0_f32, 0.3, 2.0, -1.5, std::f32::consts::PI] {
            for [x, y] in [[1.0, 1.0], [2.0, 0.5], [-2.0, 3.0], [0.0, 2.0], [2.0, 0.0], [-1.0, -1.0]] {
                let (sin, cos) = rotation.sin_cos();
                let given = [cos * x, sin * y, 0.25, -sin * x, cos * y, -7.0];
                let members = transform(given).expect("it doesn't shear");
                let Some(members) = members else { continue };
                let got = affine(&members);
                let is_same = given.iter().zip(got).all(|(given, got)| (given - got).abs() < 1e-5);
                assert!(is_same, "{given:?} became {got:?}");
            }
        }
        assert_eq!(transform([1.0, 0.5, 0.0, 0.0, 1.0, 0.0]), None);
    }
}
