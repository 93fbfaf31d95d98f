//! What `pnaen info` says about materials.

use std::fmt;

use serde::Serialize;

use geometry::choice::Choice;
use geometry::mesh::{Alpha, Look, Map, MapUv, Material, Slot};
use geometry::names::shown;
use geometry::numbers::exact;

/// A material in numbers.
#[derive(Clone, Debug, Serialize)]
pub(super) struct MaterialInfo {
    pub name: String,
    pub triangles: u32,
    /// Width and height in px of the base colour's image, where there is one.
    pub texture: Option<[u32; 2]>,
    /// Linear RGBA.
    pub base_color: [f32; 4],
    #[serde(flatten)]
    pub look: Look,
    /// `opaque`, `mask` or `blend`.
    pub alpha: &'static str,
    /// Below this alpha there is no surface.
    pub alpha_cutoff: Option<f32>,
    pub double_sided: bool,
    pub maps: Vec<MapInfo>,
}

/// An image beside that of the base colour.
#[derive(Clone, Debug, Serialize)]
pub(super) struct MapInfo {
    /// The name of a [`Slot`].
    pub slot: &'static str,
    /// Width and height in px.
    pub size: [u32; 2],
    /// The n of TEXCOORD_n; none for the base colour's own texture coordinates.
    pub uv_set: Option<usize>,
    /// Factor of the normals' first two components, or how much of the occlusion counts.
    pub strength: Option<f32>,
}

impl MaterialInfo {
    pub(super) fn new(material: &Material) -> Self {
        let (alpha, alpha_cutoff) = match material.look.alpha {
            Alpha::Opaque => ("opaque", None),
            Alpha::Mask(cutoff) => ("mask", Some(cutoff)),
            Alpha::Blend => ("blend", None),
        };
        let map = |slot| Some(map(slot, material.look.maps[slot as usize].as_ref()?, &material.look));
        Self {
            name: material.name.clone(),
            triangles: material.triangles.len() as u32,
            texture: material.texture.as_ref().map(|texture| texture.size),
            base_color: material.base_color,
            look: material.look.clone(),
            alpha,
            alpha_cutoff,
            double_sided: material.double_sided,
            maps: Slot::ALL.into_iter().filter_map(map).collect(),
        }
    }

    /// What is told about all materials, and what differs from a plain one.
    fn parts(&self) -> Vec<String> {
        let (look, usual) = (&self.look, Look::default());
        let mut parts = vec![format!("metallic {}, roughness {}", look.metallic, look.roughness)];
        let mut add = |is_told: bool, part: String| parts.extend(is_told.then_some(part));
        add(self.base_color != [1.0; 4], format!("base colour {}", numbers(&self.base_color)));
        add(look.emissive != usual.emissive, format!("emits {}", numbers(&look.emissive)));
        add(look.ior != usual.ior, format!("index of refraction {}", look.ior));
        add(look.specular != usual.specular, format!("specular {}", look.specular));
        let color = look.specular_color;
        add(color != usual.specular_color, format!("specular colour {}", numbers(&color)));
        add(look.clearcoat > 0.0, format!("clear coat {} of roughness {}", look.clearcoat, look.clearcoat_roughness));
        add(look.transmission > 0.0, format!("transmission {}", look.transmission));
        let sheen = numbers(&look.sheen_color);
        add(look.sheen_color != usual.sheen_color, format!("sheen {sheen} of roughness {}", look.sheen_roughness));
        let (stretch, angle) = (look.anisotropy, look.anisotropy_rotation.to_degrees());
        add(stretch > 0.0, format!("highlights longer by {stretch} at {angle} degrees from the tangent"));
        let color = numbers(&look.attenuation_color);
        let absorbs = look.attenuation_color != usual.attenuation_color && look.attenuation_distance.is_finite();
        let left = format!(", which leaves {color} of light in {} object units", look.attenuation_distance);
        let left = if absorbs { left } else { String::new() };
        add(look.thickness > 0.0, format!("{} object units thick{left}", look.thickness));
        add(self.alpha == "blend", "blended".to_owned());
        let cutoff = self.alpha_cutoff;
        add(cutoff.is_some(), format!("cut out below alpha {}", cutoff.unwrap_or_default()));
        add(look.unlit, "unlit".to_owned());
        add(self.double_sided, "double-sided".to_owned());
        parts
    }
}

fn map(slot: Slot, map: &Map, look: &Look) -> MapInfo {
    let own_numbers = [
        (Slot::Normal, look.normal_scale),
        (Slot::Occlusion, look.occlusion_strength),
        (Slot::ClearcoatNormal, look.clearcoat_normal_scale),
    ];
    let strength = own_numbers.into_iter().find(|(own, _)| *own == slot).map(|(_, number)| number);
    let uv_set = match map.uv {
        MapUv::Own => None,
        MapUv::Set(set, _) => Some(set),
    };
    MapInfo { slot: slot.name(), size: map.texture.size, uv_set, strength }
}

/// Numbers of a colour or a place, separated by spaces.
pub(super) fn numbers(all: &[f32]) -> String {
    all.iter().copied().map(exact).collect::<Vec<_>>().join(" ")
}

impl fmt::Display for MaterialInfo {
    /// Writes a line with name and size, a line with how it looks, and a line for each map.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let texture = self.texture.map_or_else(String::new, |[w, h]| format!(", texture {w} x {h} px"));
        writeln!(f, "material      {}: {} triangles{texture}", shown(&self.name), self.triangles)?;
        writeln!(f, "  look          {}", self.parts().join(", "))?;
        for MapInfo { slot, size: [w, h], uv_set, strength } in &self.maps {
            let set = uv_set.map_or_else(String::new, |set| format!(", on TEXCOORD_{set}"));
            let strength = strength.filter(|strength| *strength != 1.0);
            let strength = strength.map_or_else(String::new, |strength| format!(", strength {strength}"));
            writeln!(f, "  map           {slot} {w} x {h} px{set}{strength}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use geometry::mesh::{Sampling, Texture};

    #[test]
    fn a_plain_material_has_two_lines() {
        let text = MaterialInfo::new(&Material::plain("clay", [1.0; 4])).to_string();
        assert_eq!(text, "material      clay: 0 triangles\n  look          metallic 0, roughness 0.5\n");
    }

    #[test]
    fn everything_that_a_material_has_is_told() {
        let texture = Arc::new(Texture { size: [2, 1], rgba: vec![255; 8] });
        let mut material = Material::plain("paint", [0.5, 0.25, 0.0, 1.0]);
        let uv = MapUv::Set(1, [1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        let look = &mut material.look;
        look.maps[Slot::Normal as usize] = Some(Map { texture, uv, sampling: Sampling::default() });
        (look.normal_scale, look.clearcoat, look.alpha, look.unlit) = (0.5, 1.0, Alpha::Mask(0.25), true);
        look.transmission = 0.75;
        (look.sheen_color, look.sheen_roughness) = ([0.5, 0.0, 1.0], 0.25);
        (look.anisotropy, look.anisotropy_rotation) = (0.5, std::f32::consts::PI);
        (look.thickness, look.attenuation_distance, look.attenuation_color) = (2.0, 0.5, [1.0, 0.5, 0.25]);
        let info = MaterialInfo::new(&material);
        let text = info.to_string();
        let look = "metallic 0, roughness 0.5, base colour 0.5 0.25 0 1, clear coat 1 of roughness 0, transmission 0.75, sheen 0.5 0 1 of roughness 0.25, highlights longer by 0.5 at 180 degrees from the tangent, 2 object units thick, which leaves 1 0.5 0.25 of light in 0.5 object units, cut out below alpha 0.25, unlit";
        assert!(text.contains(&format!("\n  look          {look}\n")), "{text}");
        assert!(text.ends_with("\n  map           normal 2 x 1 px, on TEXCOORD_1, strength 0.5\n"), "{text}");
        let json = serde_json::to_value(&info).unwrap();
        assert_eq!((&json["alpha"], &json["alpha_cutoff"]), (&"mask".into(), &0.25.into()));
        assert_eq!(json["transmission"], 0.75);
        assert_eq!((&json["maps"][0]["slot"], &json["maps"][0]["uv_set"]), (&"normal".into(), &1.into()));
    }
}
