//! Reads materials: the base colour and its texture. Each is made when a primitive first uses it.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use ::gltf::Document;

use super::Accessors;
use super::extensions::UvTransform;
use crate::load::images::decode_texture;
use crate::load::memory_budget::Budget;
use crate::load::uri::{self, Files};
use crate::mesh::mesh_builder::MeshBuilder;
use crate::mesh::{Material, Texture};

/// A material's index in the builder, and its texture coordinates.
#[derive(Clone, Copy)]
pub(super) struct Resolved {
    pub index: usize,
    pub uvs: Uvs,
}

/// Which texture coordinates a material uses, and how they are transformed.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Uvs {
    /// The n of TEXCOORD_n.
    pub set: u32,
    pub transform: Option<UvTransform>,
}

/// The materials that have been used so far.
pub(super) struct Materials<'a> {
    document: &'a Document,
    accessors: &'a Accessors<'a>,
    files: &'a Files<'a>,
    transforms: &'a [Option<UvTransform>],
    budget: &'a Budget,
    /// By the index in the document; none for the default material.
    resolved: HashMap<Option<usize>, Resolved>,
    /// By the image's index in the document; none for an image that can't be read.
    textures: HashMap<usize, Option<Arc<Texture>>>,
    pub warnings: Vec<String>,
}

impl<'a> Materials<'a> {
    pub(super) fn new(
        document: &'a Document,
        accessors: &'a Accessors<'a>,
        files: &'a Files<'a>,
        transforms: &'a [Option<UvTransform>],
        budget: &'a Budget,
    ) -> Self {
        let (resolved, textures) = (HashMap::new(), HashMap::new());
        Self { document, accessors, files, transforms, budget, resolved, textures, warnings: Vec::new() }
    }

    /// Finds a material, or adds it to the builder. A texture that is missing or broken causes a warning.
    pub(super) fn resolve(&mut self, material: &::gltf::Material, builder: &mut MeshBuilder) -> Resolved {
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
        let transform = material.index().and_then(|index| *self.transforms.get(index)?);
        let own_set = info.map_or(0, |info| info.tex_coord());
        let set = transform.and_then(|transform| transform.uv_set).unwrap_or(own_set);
        let double_sided = material.double_sided();
        let plain = Material::plain(&name, pbr.base_color_factor());
        let index = builder.material(Material { texture, double_sided, ..plain });
        let resolved = Resolved { index, uvs: Uvs { set, transform } };
        self.resolved.insert(material.index(), resolved);
        resolved
    }

    fn texture(&mut self, image: usize, material: &str) -> Option<Arc<Texture>> {
        if let Some(texture) = self.textures.get(&image) {
            return texture.clone();
        }
        let texture = self.read(image).and_then(|bytes| decode_texture(&bytes, self.budget)).map(Arc::new);
        let texture = texture.map_err(|reason| {
            self.warnings.push(format!("the texture of material \"{material}\" is left out: {reason}."));
        });
        self.textures.insert(image, texture.clone().ok());
        texture.ok()
    }

    /// Returns the bytes of an image.
    fn read(&self, image: usize) -> Result<Cow<'_, [u8]>, String> {
        // Reads the document's JSON, since the crate's own access panics on an image without a type.
        let Some(json) = self.document.as_json().images.get(image) else {
            return Err(format!("there is no /images/{image}"));
        };
        if let Some(view) = json.buffer_view.and_then(|view| self.accessors.view(view.value())) {
            let bytes = self.accessors.view_bytes(&view).map(Cow::Borrowed);
            return bytes.map_err(|reason| format!("/images/{image} {reason}"));
        }
        match &json.uri {
            Some(uri) => self
                .files
                .read(uri, false)
                .map(Cow::Owned)
                .map_err(|reason| format!("/images/{image} ({}) can't be read: {reason}", uri::shown(uri))),
            None => Err(format!("/images/{image} has neither a file nor a buffer view")),
        }
    }
}
