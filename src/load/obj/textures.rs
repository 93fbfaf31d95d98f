//! What the images of materials are for.

use std::collections::HashMap;
use std::sync::Arc;

use super::mtl::MtlMap;
use crate::memory_budget::Budget;
use crate::packing::{metallic_roughness, with_opacity};
use geometry::mesh::{Alpha, Map, MapUv, Material, Slot, Texture};

/// How far the square of a normal's length may be from 1. Eight bits a number take it as far as 0.03; halving, and programs that
/// don't normalise, take it further.
const LENGTH_ROOM: f32 = 0.35;

/// Which part of the texels must be normals.
const LEAST_PART: f32 = 0.9;

/// A map of a material.
pub(super) struct UsedMap {
    pub map: MtlMap,
    /// What the image's numbers are multiplied by.
    pub factor: f32,
    pub file: String,
}

/// Gives images to materials. Those that join the same images share the result.
#[derive(Default)]
pub(super) struct Giving(HashMap<(&'static str, [Option<*const Texture>; 2]), Arc<Texture>>);

impl Giving {
    /// Gives images to a material, in the order of its maps: opacity becomes the alpha of the base colour, and roughness and metalness
    /// become one image. Returns a sentence for each that takes too much memory.
    pub(super) fn give(
        &mut self,
        material: &mut Material,
        images: &[(&UsedMap, &Arc<Texture>)],
        budget: &Budget,
    ) -> Vec<String> {
        let (mut problems, name) = (Vec::new(), material.name.clone());
        let mut warn = |what: &str, reason: String| {
            problems.push(format!("{what} of material \"{name}\" is left out: it {reason}."));
        };
        for &(&UsedMap { map, factor, .. }, texture) in images {
            match map {
                MtlMap::BaseColor => material.texture = Some(texture.clone()),
                MtlMap::Emissive => {
                    // A texture alone shines as it is.
                    if material.look.emissive == [0.0; 3] {
                        material.look.emissive = [1.0; 3];
                    }
                    set_map(material, Slot::Emissive, texture.clone());
                }
                MtlMap::Normal | MtlMap::Bump => {
                    material.look.normal_scale = factor;
                    set_map(material, Slot::Normal, texture.clone());
                }
                // Read apart from the others, with all its bits.
                MtlMap::Displacement => {}
                MtlMap::Opacity => {
                    let color = material.texture.as_ref();
                    let join = || with_opacity(color.map(|own| &**own), texture, budget);
                    match self.joined("opacity", [color, Some(texture)], join) {
                        Ok(texture) => (material.texture, material.look.alpha) = (Some(texture), Alpha::Blend),
                        Err(reason) => warn("the opacity", reason),
                    }
                }
                MtlMap::Roughness => material.look.roughness = factor,
                MtlMap::Metalness => material.look.metallic = factor,
            }
        }
        let image = |map| images.iter().find(|(own, _)| own.map == map).map(|(_, texture)| *texture);
        let both = [MtlMap::Roughness, MtlMap::Metalness].map(image);
        if both.iter().any(Option::is_some) {
            let [roughness, metalness] = both.map(|own| own.map(|own| &**own));
            let join = || metallic_roughness(roughness, false, metalness, budget);
            match self.joined("roughness and metalness", both, join) {
                Ok(texture) => set_map(material, Slot::MetallicRoughness, texture),
                Err(reason) => warn("the texture of roughness and metalness", reason),
            }
        }
        problems
    }

    fn joined(
        &mut self,
        what: &'static str,
        images: [Option<&Arc<Texture>>; 2],
        join: impl FnOnce() -> Result<Texture, String>,
    ) -> Result<Arc<Texture>, String> {
        let key = (what, images.map(|image| image.map(Arc::as_ptr)));
        if let Some(texture) = self.0.get(&key) {
            return Ok(texture.clone());
        }
        join().map(|texture| self.0.entry(key).or_insert(Arc::new(texture)).clone())
    }
}

fn set_map(material: &mut Material, slot: Slot, texture: Arc<Texture>) {
    material.look.maps[slot as usize] = Some(Map { texture, uv: MapUv::Own, sampling: material.sampling });
}

/// Whether nearly all texels are unit vectors that point away from the surface, and blue is the largest of the three on average.
pub(super) fn are_normals(texture: &Texture) -> bool {
    let texels = texture.rgba.as_chunks::<4>().0;
    let (mut sums, mut units) = ([0.0_f64; 3], 0_usize);
    for &[r, g, b, _] in texels {
        let normal = [r, g, b].map(|channel| f32::from(channel) / 127.5 - 1.0);
        let square: f32 = normal.iter().map(|x| x * x).sum();
        units += usize::from((square - 1.0).abs() < LENGTH_ROOM && normal[2] > 0.0);
        sums.iter_mut().zip([r, g, b]).for_each(|(sum, channel)| *sum += f64::from(channel));
    }
    let [r, g, b] = sums;
    !texels.is_empty() && units as f32 >= LEAST_PART * texels.len() as f32 && b > 1.2 * r.max(g)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texture(texel: impl Fn(u32, u32) -> [u8; 3]) -> Texture {
        let texels = (0..64 * 64).map(|i| texel(i % 64, i / 64));
        Texture { size: [64; 2], rgba: texels.flat_map(|[r, g, b]| [r, g, b, 255]).collect() }
    }

    /// Normals of waves that are so steep.
    fn waves(steep: f32) -> Texture {
        texture(|x, y| {
            let slope = [(x as f32 * 0.4).sin() * steep, (y as f32 * 0.3).cos() * steep];
            let normal = glam::Vec3::new(slope[0], slope[1], 1.0).normalize();
            (normal * 127.5 + 127.5).round().to_array().map(|channel| channel as u8)
        })
    }

    #[test]
    fn images_of_normals_are_told_from_heights_and_colours() {
        assert!([0.0, 0.3, 1.0].into_iter().all(|steep| are_normals(&waves(steep))));
        let heights = |from: u32, to: u32| texture(move |x, y| [(from + (x * y) % (to - from)) as u8; 3]);
        assert!(
            [(0, 255), (100, 140), (190, 210), (200, 203)]
                .into_iter()
                .all(|(from, to)| !are_normals(&heights(from, to)))
        );
        assert!(!are_normals(&texture(|x, y| [(x * 4) as u8, (y * 4) as u8, 255])), "blue alone isn't enough");
        assert!(!are_normals(&texture(|_, _| [20, 40, 255])), "a blue wall");
        assert!(!are_normals(&Texture { size: [0; 2], rgba: Vec::new() }));
    }
}
