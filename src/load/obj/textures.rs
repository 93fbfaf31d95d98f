//! What the images of materials are for.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use crate::face_builder::FaceBuilder;
use crate::memory_budget::Budget;
use crate::packing::{metallic_roughness, with_opacity};
use geometry::mesh::mipmap::MipFilter;
use geometry::mesh::{Alpha, Map, MapUv, Material, Slot, Texture};

/// What an image is for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum TextureUse {
    BaseColor,
    Emissive,
    /// Normals in tangent space, and the factor of their slopes.
    Normal(f32),
    Opacity,
    /// Roughness, and the factor of it.
    Roughness(f32),
    /// How much of a metal it is, and the factor of it.
    Metalness(f32),
}

impl TextureUse {
    /// How the image is halved.
    pub(super) fn filter(self) -> MipFilter {
        match self {
            Self::BaseColor | Self::Emissive => MipFilter::Colors,
            Self::Normal(_) => MipFilter::Normals,
            Self::Opacity | Self::Roughness(_) | Self::Metalness(_) => MipFilter::Numbers,
        }
    }
}

/// The images of a material that are joined with others.
#[derive(Default)]
struct Parts {
    opacity: Option<Arc<Texture>>,
    roughness: Option<Arc<Texture>>,
    metalness: Option<Arc<Texture>>,
}

/// Gives images to materials. Images of opacity, roughness and metalness are joined with others at the end.
#[derive(Default)]
pub(super) struct Giving(BTreeMap<usize, Parts>);

impl Giving {
    /// Gives an image to a material of this index.
    pub(super) fn give(&mut self, faces: &mut FaceBuilder, index: usize, kind: TextureUse, texture: &Arc<Texture>) {
        let (material, texture) = (faces.material_mut(index), texture.clone());
        match kind {
            TextureUse::BaseColor => material.texture = Some(texture),
            TextureUse::Emissive => {
                // A texture alone shines as it is.
                if material.look.emissive == [0.0; 3] {
                    material.look.emissive = [1.0; 3];
                }
                set_map(material, Slot::Emissive, texture);
            }
            TextureUse::Normal(strength) => {
                material.look.normal_scale = strength;
                set_map(material, Slot::Normal, texture);
            }
            TextureUse::Opacity => self.0.entry(index).or_default().opacity = Some(texture),
            TextureUse::Roughness(factor) => {
                material.look.roughness = factor;
                self.0.entry(index).or_default().roughness = Some(texture);
            }
            TextureUse::Metalness(factor) => {
                material.look.metallic = factor;
                self.0.entry(index).or_default().metalness = Some(texture);
            }
        }
    }

    /// Joins images: opacity becomes the alpha of the base colour, and roughness and metalness become one image. Returns a clause for
    /// each material whose images take too much memory.
    pub(super) fn finish(self, faces: &mut FaceBuilder, budget: &Budget) -> Vec<String> {
        let mut problems = Vec::new();
        // Materials that join the same images share the result.
        let mut known: HashMap<(&str, [Option<*const Texture>; 2]), Arc<Texture>> = HashMap::new();
        let mut joined = |what, images: [&Option<Arc<Texture>>; 2], join: &dyn Fn() -> Result<Texture, String>| {
            let key = (what, images.map(|image| image.as_ref().map(Arc::as_ptr)));
            if let Some(texture) = known.get(&key) {
                return Ok(texture.clone());
            }
            join().map(|texture| known.entry(key).or_insert(Arc::new(texture)).clone())
        };
        for (index, Parts { opacity, roughness, metalness }) in &self.0 {
            let material = faces.material_mut(*index);
            let mut warn = |what: &str, reason: String| {
                problems.push(format!("{what} of material \"{}\" is left out: {reason}.", material.name));
            };
            let mut looks = (None, None);
            if let Some(image) = opacity {
                let color = material.texture.clone();
                let join = || with_opacity(color.as_deref(), image, budget);
                looks.0 =
                    joined("opacity", [&color, opacity], &join).map_err(|reason| warn("the opacity", reason)).ok();
            }
            if roughness.is_some() || metalness.is_some() {
                let join = || metallic_roughness(roughness.as_deref(), false, metalness.as_deref(), budget);
                let texture = joined("roughness and metalness", [roughness, metalness], &join);
                looks.1 = texture.map_err(|reason| warn("the texture of roughness and metalness", reason)).ok();
            }
            if let Some(texture) = looks.0 {
                (material.texture, material.look.alpha) = (Some(texture), Alpha::Blend);
            }
            if let Some(texture) = looks.1 {
                set_map(material, Slot::MetallicRoughness, texture);
            }
        }
        problems
    }
}

fn set_map(material: &mut Material, slot: Slot, texture: Arc<Texture>) {
    material.look.maps[slot as usize] = Some(Map { texture, uv: MapUv::Own, sampling: material.sampling });
}
