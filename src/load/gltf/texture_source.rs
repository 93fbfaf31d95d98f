//! Reads what a document says about textures, and their samplers and images. These and the materials are taken out of it before it is
//! checked, since their faults don't keep the model from loading.
//!
//! Sources: glTF 2.0 specification, section 3.8; the extensions KHR_texture_basisu and EXT_texture_webp.

use std::borrow::Cow;
use std::cell::RefCell;

use serde_json::{Map, Value};

use super::accessor::DataError;
use super::lenient::{Members, take_list};
use super::material_members::{MAGNIFY, MINIFY, WRAPS};
use super::notes::Notes;
use super::schema::{BASISU, WEBP};
use super::{Accessors, json};
use crate::uri::{self, Files};
use geometry::mesh::{Sampling, Wrap};

/// The document's lists, as they are.
#[derive(Debug, Default)]
pub(super) struct MaterialLists {
    pub materials: Vec<Value>,
    pub textures: Vec<Value>,
    samplers: Vec<Value>,
    images: Vec<Value>,
}

/// A texture of a document.
#[derive(Clone)]
pub(super) struct TextureSource {
    /// The indices of its images. The first one that can be read is used.
    pub images: Vec<usize>,
    pub sampling: Sampling,
}

impl MaterialLists {
    /// Takes the lists, and leaves one of as many materials, which have only their indices.
    pub(super) fn take(root: &mut Map<String, Value>, notes: &RefCell<Notes>) -> Self {
        let list = |name| take_list(root, name, "it is left out", notes);
        let [materials, textures, samplers, images] = ["materials", "textures", "samplers", "images"].map(list);
        if !materials.is_empty() {
            root.insert("materials".to_owned(), materials.iter().map(|_| Value::Object(Map::new())).collect());
        }
        Self { materials, textures, samplers, images }
    }

    /// Returns the memory of the lists, in bytes.
    pub(super) fn bytes(&self) -> u64 {
        let lists = [&self.materials, &self.textures, &self.samplers, &self.images];
        lists.into_iter().flatten().map(json::bytes).sum()
    }

    /// Reads a texture; none if it has no image that is read.
    pub(super) fn texture(&self, index: usize, notes: &RefCell<Notes>) -> Option<TextureSource> {
        let members = Members::new(self.textures.get(index)?, format!("/textures/{index}"), notes)?;
        let source = |members: &Members| members.index("source", "images", self.images.len());
        let extensions = members.inside("extensions");
        let extended = |name| source(&extensions.as_ref()?.inside(name)?);
        let has_any = extensions.as_ref().is_some_and(|own| own.has(BASISU) || own.has(WEBP));
        if !members.has("source") && !has_any {
            let said =
                format!("texture {index} has no PNG, JPEG, WebP or KTX2 image; its materials are shown without it.");
            notes.borrow_mut().push(said);
            return None;
        }
        let images: Vec<_> = [extended(BASISU), extended(WEBP), source(&members)].into_iter().flatten().collect();
        if images.is_empty() {
            return None;
        }
        let sampler = members.index("sampler", "samplers", self.samplers.len());
        let sampling = sampler.and_then(|sampler| {
            let members = Members::new(&self.samplers[sampler], format!("/samplers/{sampler}"), notes)?;
            Some(sampling(&members))
        });
        Some(TextureSource { images, sampling: sampling.unwrap_or_default() })
    }

    /// Returns the bytes of an image.
    ///
    /// # Errors
    /// A clause that says what is wrong.
    pub(super) fn image<'a>(
        &self,
        index: usize,
        accessors: &'a Accessors,
        files: &Files,
    ) -> Result<Cow<'a, [u8]>, String> {
        let image = self.images.get(index);
        let member = |name: &str| image.and_then(|image| image.get(name)).filter(|value| !value.is_null());
        if let Some(view) = member("bufferView") {
            let view = view.as_u64().and_then(|view| accessors.view(usize::try_from(view).ok()?));
            let missing = || format!("/images/{index}/bufferView isn't one of the document's buffer views");
            let view = view.ok_or_else(missing)?;
            return accessors.view_bytes(&view).map(Cow::Borrowed).map_err(|error| match error {
                DataError::Here(reason) => format!("/images/{index} {reason}"),
                DataError::Elsewhere(error) => {
                    format!("/images/{index} uses /bufferViews/{}, which {}", view.index(), error.into_clause())
                }
            });
        }
        match member("uri").map(Value::as_str) {
            Some(Some(uri)) => files
                .read(uri, false)
                .map(Cow::Owned)
                .map_err(|reason| format!("\"{}\" can't be read: {reason}", uri::shown(uri))),
            Some(None) => Err(format!("/images/{index}/uri isn't text")),
            None => Err(format!("/images/{index} has neither a file nor a buffer view")),
        }
    }
}

/// Reads a sampler.
fn sampling(members: &Members) -> Sampling {
    let default = Sampling::default();
    let (minify_linear, mip_linear) = members.code("minFilter", &MINIFY, (default.minify_linear, default.mip_linear));
    Sampling {
        wrap: ["wrapS", "wrapT"].map(|name| members.code(name, &WRAPS, Wrap::Repeat)),
        magnify_linear: members.code("magFilter", &MAGNIFY, default.magnify_linear),
        minify_linear,
        mip_linear,
    }
}
