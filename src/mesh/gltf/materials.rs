//! Materials: base colour and its texture, each made when a primitive first uses it.

use std::borrow::Cow;
use std::collections::HashMap;
use std::io::Cursor;
use std::sync::Arc;

use ::gltf::Document;
use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits};

use super::Accessors;
use super::budget::Budget;
use super::extensions::UvTransform;
use super::uri::{self, Files};
use crate::mesh::jpeg::{coefficient_bytes, most_coefficient_bytes};
use crate::mesh::merge::MeshBuilder;
use crate::mesh::{Material, Texture};

/// The largest width and height of a texture, in px: what common GPUs take.
const MAX_SIZE: u32 = 16384;

/// The builder's index of a material, and the set of texture coordinates that goes with it.
#[derive(Clone, Copy)]
pub struct Resolved {
    pub index: usize,
    pub uvs: Uvs,
}

/// Which texture coordinates are read, and what becomes of them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Uvs {
    /// The n of TEXCOORD_n.
    pub set: u32,
    pub transform: Option<UvTransform>,
}

/// The materials in use so far.
pub struct Materials<'a> {
    document: &'a Document,
    accessors: &'a Accessors<'a>,
    files: &'a Files<'a>,
    transforms: &'a [Option<UvTransform>],
    budget: &'a Budget,
    /// By the document's index; none for the default material.
    resolved: HashMap<Option<usize>, Resolved>,
    /// By the document's index of the image; none for one that can't be read.
    textures: HashMap<usize, Option<Arc<Texture>>>,
    pub warnings: Vec<String>,
}

impl<'a> Materials<'a> {
    pub fn new(
        document: &'a Document,
        accessors: &'a Accessors<'a>,
        files: &'a Files<'a>,
        transforms: &'a [Option<UvTransform>],
        budget: &'a Budget,
    ) -> Self {
        let (resolved, textures) = (HashMap::new(), HashMap::new());
        Self { document, accessors, files, transforms, budget, resolved, textures, warnings: Vec::new() }
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
        let texture = self.read(image).and_then(|bytes| decode(&bytes, self.budget)).map(Arc::new);
        let texture = texture.map_err(|reason| {
            self.warnings.push(format!("the texture of material \"{material}\" is left out: {reason}."));
        });
        self.textures.insert(image, texture.clone().ok());
        texture.ok()
    }

    /// The bytes of an image file, wherever it is.
    fn read(&self, image: usize) -> Result<Cow<'_, [u8]>, String> {
        // From the document's JSON: the crate's own access panics on an image without a type.
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

/// Bytes that an image's profile and notes may take at most.
const MOST_BESIDE: u64 = 16 << 20;

/// What a PNG image may take beside its px, borrowed: a profile of its colours, which nobody here looks at, may unpack to a thousand
/// times its size.
pub fn beside_px(budget: &Budget) -> Limits {
    let mut limits = Limits::default();
    let bytes = (budget.left() / 8).min(MOST_BESIDE);
    // As it grows, old and new are both alive.
    limits.max_alloc = Some(if budget.borrow(bytes).is_ok() { bytes / 2 } else { 0 });
    limits
}

/// PNG or JPEG (its first bytes tell which) as RGBA, if it isn't too large by what it says of itself.
///
/// # Errors
/// A clause that says what is wrong.
pub fn decode(bytes: &[u8], budget: &Budget) -> Result<Texture, String> {
    let undecoded = |error: ImageError| format!("its image can't be decoded: {error}");
    let known = coefficient_bytes(&mut Cursor::new(bytes)).map_err(|error| error.to_string())?;
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|error| error.to_string())?;
    if reader.format() == Some(ImageFormat::Png) {
        reader.limits(beside_px(budget));
    }
    let is_jpeg = reader.format() == Some(ImageFormat::Jpeg);
    let mut decoder = reader.into_decoder().map_err(undecoded)?;
    let (width, height) = decoder.dimensions();
    if width.max(height) > MAX_SIZE {
        let advice = "scale it to 4096 px a side or less";
        return Err(format!("its image is {width} x {height} px large, and {MAX_SIZE} px a side are read; {advice}"));
    }
    let px = u64::from(width) * u64::from(height);
    let too_large = |reason| format!("its image of {width} x {height} px {reason}; scale it down");
    budget.borrow(decoder.total_bytes()).map_err(too_large)?;
    if is_jpeg {
        // Gone before the px are turned into RGBA.
        let coefficients = known.unwrap_or_else(|| most_coefficient_bytes([width, height]));
        budget.hold(coefficients).map_err(too_large)?;
        budget.release(coefficients);
    }
    budget.hold(px * 4).map_err(too_large)?;
    let mut limits = Limits::default();
    limits.max_alloc = Some(budget.left().max(1 << 20).saturating_add(decoder.total_bytes()));
    decoder.set_limits(limits).map_err(undecoded)?;
    let pixels = DynamicImage::from_decoder(decoder).map_err(undecoded)?.into_rgba8();
    Ok(Texture { size: pixels.dimensions().into(), rgba: pixels.into_raw() })
}
