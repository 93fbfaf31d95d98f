//! Materials: base colour and its texture, each made when a primitive first uses it.

use std::collections::HashMap;
use std::io::Cursor;
use std::sync::Arc;

use ::gltf::Document;
use image::{ImageReader, Limits};

use super::Accessors;
use super::uri::{self, Files};
use crate::mesh::merge::MeshBuilder;
use crate::mesh::{Material, Texture};

/// The largest width and height of a texture, in px: what common GPUs take.
const MAX_SIZE: u32 = 16384;

/// The builder's index of a material, and the set of texture coordinates that goes with it.
#[derive(Clone, Copy)]
pub struct Resolved {
    pub index: usize,
    pub uv_set: u32,
}

/// The materials in use so far.
pub struct Materials<'a> {
    document: &'a Document,
    accessors: &'a Accessors<'a>,
    files: Files<'a>,
    /// By the document's index; none for the default material.
    resolved: HashMap<Option<usize>, Resolved>,
    /// By the document's index of the image; none for one that can't be read.
    textures: HashMap<usize, Option<Arc<Texture>>>,
    pub warnings: Vec<String>,
}

impl<'a> Materials<'a> {
    pub fn new(document: &'a Document, accessors: &'a Accessors<'a>, files: Files<'a>) -> Self {
        let (resolved, textures) = (HashMap::new(), HashMap::new());
        Self { document, accessors, files, resolved, textures, warnings: Vec::new() }
    }

    /// Finds a material, or adds it to the builder. A texture that is missing or broken becomes a warning.
    pub fn resolve(&mut self, material: &::gltf::Material, builder: &mut MeshBuilder) -> Resolved {
        if let Some(&resolved) = self.resolved.get(&material.index()) {
            return resolved;
        }
        let pbr = material.pbr_metallic_roughness();
        let name = match (material.name(), material.index()) {
            (Some(name), _) => name.to_owned(),
            (None, Some(index)) => format!("material {index}"),
            (None, None) => "default".to_owned(),
        };
        let info = pbr.base_color_texture();
        let texture = info.as_ref().and_then(|info| self.texture(info.texture().source().index(), &name));
        let uv_set = info.map_or(0, |info| info.tex_coord());
        let double_sided = material.double_sided();
        let plain = Material::plain(&name, pbr.base_color_factor());
        let index = builder.material(Material { texture, double_sided, ..plain });
        let resolved = Resolved { index, uv_set };
        self.resolved.insert(material.index(), resolved);
        resolved
    }

    fn texture(&mut self, image: usize, material: &str) -> Option<Arc<Texture>> {
        if let Some(texture) = self.textures.get(&image) {
            return texture.clone();
        }
        let texture = self.read(image).and_then(|bytes| decode(&bytes)).map(Arc::new);
        let texture = texture.map_err(|reason| {
            self.warnings.push(format!("the texture of material \"{material}\" is left out: {reason}."));
        });
        self.textures.insert(image, texture.clone().ok());
        texture.ok()
    }

    /// The bytes of an image file, wherever it is.
    fn read(&self, image: usize) -> Result<Vec<u8>, String> {
        // From the document's JSON: the crate's own access panics on an image without a type.
        let Some(json) = self.document.as_json().images.get(image) else {
            return Err(format!("there is no image {image}"));
        };
        if let Some(view) = json.buffer_view.and_then(|view| self.accessors.view(view.value())) {
            let bytes = self.accessors.view_bytes(&view).map(<[u8]>::to_vec);
            return bytes.map_err(|reason| format!("image {image} {reason}"));
        }
        match &json.uri {
            Some(uri) => self
                .files
                .read(uri)
                .map_err(|reason| format!("image {image} ({}) can't be read: {reason}", uri::shown(uri))),
            None => Err(format!("image {image} has neither a file nor a buffer view")),
        }
    }
}

/// PNG or JPEG (its first bytes tell which) as RGBA.
fn decode(bytes: &[u8]) -> Result<Texture, String> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|error| error.to_string())?;
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(MAX_SIZE), Some(MAX_SIZE));
    reader.limits(limits);
    let pixels = reader.decode().map_err(|error| format!("its image can't be decoded: {error}"))?.into_rgba8();
    Ok(Texture { size: pixels.dimensions().into(), rgba: pixels.into_raw() })
}
