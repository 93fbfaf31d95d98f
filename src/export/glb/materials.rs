//! Writes materials with their images. Vertices have the texture coordinates of the base colour alone, so that maps with others are left
//! out, and so are colours of vertices and the numbers of extensions other than KHR_materials_transmission.

use std::io::Cursor;
use std::sync::Arc;

use gltf::json::validation::Checked::Valid;
use gltf::json::{self, Index};

use super::Writer;
use crate::export::ExportError;
use crate::mesh::{Alpha, Look, Map, MapUv, Material, Sampling, Slot, Texture, Wrap};

/// The images, samplers and textures that were written so far. Materials share them.
#[derive(Default)]
pub(super) struct Written {
    images: Vec<(*const Texture, Index<json::Image>)>,
    samplers: Vec<(Sampling, Index<json::texture::Sampler>)>,
    textures: Vec<((u32, u32), Index<json::Texture>)>,
}

impl Writer {
    /// Returns the index of a material.
    ///
    /// # Errors
    /// An image can't be encoded.
    pub(super) fn material(
        &mut self,
        material: &Material,
        written: &mut Written,
        path: &str,
    ) -> Result<Index<json::Material>, ExportError> {
        let look = &material.look;
        let mut texture = |image: &Arc<Texture>, sampling| self.texture(image, sampling, written, path);
        let base = material.texture.as_ref().map(|image| texture(image, material.sampling)).transpose()?;
        let mut maps: [Option<Index<json::Texture>>; Slot::COUNT] = [None; Slot::COUNT];
        for (map, index) in look.maps.iter().zip(&mut maps) {
            *index = map.as_ref().filter(has_own_uv).map(|map| texture(&map.texture, map.sampling)).transpose()?;
        }
        let [metallic_roughness, normal, occlusion, emissive, transmission, ..] = maps;
        let extensions = look.transmits().then(|| self.transmission(look, transmission));
        Ok(self.root.push(json::Material {
            name: Some(material.name.clone()),
            double_sided: material.double_sided,
            alpha_mode: Valid(alpha_mode(look)),
            alpha_cutoff: match look.alpha {
                Alpha::Mask(cutoff) => Some(json::material::AlphaCutoff(cutoff)),
                Alpha::Opaque | Alpha::Blend => None,
            },
            pbr_metallic_roughness: json::material::PbrMetallicRoughness {
                base_color_factor: json::material::PbrBaseColorFactor(material.base_color),
                base_color_texture: base.map(info),
                metallic_factor: json::material::StrengthFactor(look.metallic),
                roughness_factor: json::material::StrengthFactor(look.roughness),
                metallic_roughness_texture: metallic_roughness.map(info),
                ..Default::default()
            },
            normal_texture: normal.map(|index| json::material::NormalTexture {
                index,
                scale: look.normal_scale,
                tex_coord: 0,
                extensions: None,
                extras: Default::default(),
            }),
            occlusion_texture: occlusion.map(|index| json::material::OcclusionTexture {
                index,
                strength: json::material::StrengthFactor(look.occlusion_strength),
                tex_coord: 0,
                extensions: None,
                extras: Default::default(),
            }),
            emissive_texture: emissive.map(info),
            // What is beyond 1 would need an extension.
            emissive_factor: json::material::EmissiveFactor(look.emissive.map(|part| part.clamp(0.0, 1.0))),
            extensions,
            ..Default::default()
        }))
    }

    /// Returns the extension for light that goes through, and names it in the document.
    fn transmission(
        &mut self,
        look: &Look,
        texture: Option<Index<json::Texture>>,
    ) -> json::extensions::material::Material {
        let name = "KHR_materials_transmission";
        if !self.root.extensions_used.iter().any(|used| used == name) {
            self.root.extensions_used.push(name.to_owned());
        }
        let transmission = json::extensions::material::Transmission {
            transmission_factor: json::extensions::material::TransmissionFactor(look.transmission),
            transmission_texture: texture.map(info),
            extras: Default::default(),
        };
        json::extensions::material::Material { transmission: Some(transmission) }
    }

    /// Returns the texture for an image that is sampled in a way.
    fn texture(
        &mut self,
        image: &Arc<Texture>,
        sampling: Sampling,
        written: &mut Written,
        path: &str,
    ) -> Result<Index<json::Texture>, ExportError> {
        let source = match written.images.iter().find(|(known, _)| *known == Arc::as_ptr(image)) {
            Some((_, index)) => *index,
            None => {
                let index = self.image(image, path)?;
                written.images.push((Arc::as_ptr(image), index));
                index
            }
        };
        let sampler = match written.samplers.iter().find(|(known, _)| *known == sampling) {
            Some((_, index)) => *index,
            None => {
                let index = self.root.push(sampler(sampling));
                written.samplers.push((sampling, index));
                index
            }
        };
        let key = (source.value() as u32, sampler.value() as u32);
        if let Some((_, index)) = written.textures.iter().find(|(known, _)| *known == key) {
            return Ok(*index);
        }
        let (name, extensions, extras) = (None, None, Default::default());
        let index = self.root.push(json::Texture { name, sampler: Some(sampler), source, extensions, extras });
        written.textures.push((key, index));
        Ok(index)
    }

    /// Writes an image as PNG.
    fn image(&mut self, texture: &Texture, path: &str) -> Result<Index<json::Image>, ExportError> {
        let ([width, height], mut png) = (texture.size, Cursor::new(Vec::new()));
        let (color, format) = (image::ExtendedColorType::Rgba8, image::ImageFormat::Png);
        image::write_buffer_with_format(&mut png, &texture.rgba, width, height, color, format)
            .map_err(|reason| ExportError::Texture { path: path.to_owned(), reason: reason.to_string() })?;
        let view = self.view(png.get_ref(), None);
        Ok(self.root.push(json::Image {
            buffer_view: Some(view),
            mime_type: Some(json::image::MimeType("image/png".into())),
            name: None,
            uri: None,
            extensions: None,
            extras: Default::default(),
        }))
    }
}

fn has_own_uv(map: &&Map) -> bool {
    map.uv == MapUv::Own
}

fn info(index: Index<json::Texture>) -> json::texture::Info {
    json::texture::Info { index, tex_coord: 0, extensions: None, extras: Default::default() }
}

fn alpha_mode(look: &Look) -> json::material::AlphaMode {
    match look.alpha {
        Alpha::Opaque => json::material::AlphaMode::Opaque,
        Alpha::Mask(_) => json::material::AlphaMode::Mask,
        Alpha::Blend => json::material::AlphaMode::Blend,
    }
}

fn sampler(sampling: Sampling) -> json::texture::Sampler {
    use json::texture::{MagFilter, MinFilter, WrappingMode};
    let wrap = |wrap| match wrap {
        Wrap::Repeat => WrappingMode::Repeat,
        Wrap::Mirror => WrappingMode::MirroredRepeat,
        Wrap::Clamp => WrappingMode::ClampToEdge,
    };
    let minify = match (sampling.minify_linear, sampling.mip_linear) {
        (false, None) => MinFilter::Nearest,
        (true, None) => MinFilter::Linear,
        (false, Some(false)) => MinFilter::NearestMipmapNearest,
        (true, Some(false)) => MinFilter::LinearMipmapNearest,
        (false, Some(true)) => MinFilter::NearestMipmapLinear,
        (true, Some(true)) => MinFilter::LinearMipmapLinear,
    };
    json::texture::Sampler {
        mag_filter: Some(Valid(if sampling.magnify_linear { MagFilter::Linear } else { MagFilter::Nearest })),
        min_filter: Some(Valid(minify)),
        wrap_s: Valid(wrap(sampling.wrap[0])),
        wrap_t: Valid(wrap(sampling.wrap[1])),
        ..Default::default()
    }
}
