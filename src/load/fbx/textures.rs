//! Reads the images of textures: embedded ones, or files beside the model.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use crate::images::{decode_halved, texture_size};
use crate::memory_budget::Budget;
use crate::notes::Notes;
use crate::texture_room::{Scaling, TextureRoom};
use crate::uri::{Files, shown};
use geometry::mesh::mipmap::MipFilter;
use geometry::mesh::{Sampling, Texture, Wrap, borrowing};

/// Images by texture.
pub(super) struct Textures<'a> {
    files: &'a Files<'a>,
    budget: &'a Budget,
    /// By the number of the file, the image; none for one that can't be read.
    images: HashMap<u32, Option<Arc<Texture>>>,
    /// How images that don't fit are scaled down, likewise.
    planned: HashMap<u32, Planned>,
}

/// What is known of an image before it is read.
struct Planned {
    /// In px.
    size: [u32; 2],
    filter: MipFilter,
    scaling: Scaling,
}

impl<'a> Textures<'a> {
    pub(super) fn new(files: &'a Files<'a>, budget: &'a Budget) -> Self {
        Self { files, budget, images: HashMap::new(), planned: HashMap::new() }
    }

    /// Looks how large the images of these textures are, and plans to scale the largest down until all fit. `reserved` is the memory
    /// that the rest of the load takes, in bytes.
    pub(super) fn plan<'t>(&mut self, used: impl Iterator<Item = (&'t ufbx::Texture, MipFilter)>, reserved: u64) {
        let (mut found, mut seen) = (Vec::new(), HashSet::new());
        for (file, filter) in used.filter_map(|(texture, filter)| Some((of_file(texture)?, filter))) {
            if !seen.insert(file.file_index) {
                continue;
            }
            let read = || self.with_bytes(file, |bytes| Ok(texture_size(bytes))).ok().flatten();
            let size = borrowing(self.budget, read);
            found.extend(size.map(|size| (file.file_index, size, filter)));
        }
        let sizes: Vec<_> = found.iter().map(|(_, size, _)| *size).collect();
        let scalings = TextureRoom::of(self.budget, reserved).scalings(&sizes);
        let planned = found.into_iter().zip(scalings);
        self.planned =
            planned.map(|((file, size, filter), scaling)| (file, Planned { size, filter, scaling })).collect();
    }

    /// Reads the image of a texture. One that is missing or broken causes a warning, which begins with `what`.
    pub(super) fn image(&mut self, texture: &ufbx::Texture, what: &str, notes: &mut Notes) -> Option<Arc<Texture>> {
        let Some(file) = of_file(texture) else {
            notes.push(format!("{what} is left out: it is computed by another program."));
            return None;
        };
        if let Some(image) = self.images.get(&file.file_index) {
            return image.clone();
        }
        let planned = self.planned.get(&file.file_index);
        let (halvings, filter) = planned.map_or((0, MipFilter::Colors), |own| (own.scaling.halvings, own.filter));
        let read = || self.with_bytes(file, |bytes| decode_halved(bytes, halvings, filter, self.budget));
        let image = borrowing(self.budget, read).map(Arc::new);
        let said = planned.zip(image.as_ref().ok()).and_then(|(own, image)| own.scaling.said(own.size, Ok(image.size)));
        notes.extend(said.map(|said| format!("{what} {said}")));
        let image = image.map_err(|reason| notes.push(format!("{what} is left out: {reason}.")));
        self.images.insert(file.file_index, image.clone().ok());
        image.ok()
    }

    /// Hands the bytes of an image to `read`.
    ///
    /// # Errors
    /// Those of `read`, and a clause that says why there are no bytes.
    fn with_bytes<T>(
        &self,
        texture: &ufbx::Texture,
        read: impl FnOnce(&[u8]) -> Result<T, String>,
    ) -> Result<T, String> {
        if !texture.content.is_empty() {
            return read(&texture.content);
        }
        let mut problem = "it names no file; export the model again".to_owned();
        for name in names(texture) {
            // The name isn't a URI, so a % is a letter.
            match self.files.read(&name.replace('%', "%25"), false) {
                Ok(bytes) => return read(&bytes),
                Err(reason) => problem = format!("\"{}\" can't be read: {reason}", shown(&name)),
            }
        }
        Err(problem)
    }
}

/// Returns the texture that has a file: of several layers the first.
pub(super) fn of_file(texture: &ufbx::Texture) -> Option<&ufbx::Texture> {
    let first = || texture.file_textures.into_iter().next();
    if texture.has_file { Some(texture) } else { first().filter(|first| first.has_file) }
}

/// Returns where a texture's file may be, below the model's folder: at its relative path, or beside the model. Paths are mostly
/// those of the machine that wrote the file.
fn names(texture: &ufbx::Texture) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for path in [&texture.relative_filename, &texture.filename, &texture.absolute_filename] {
        let path = path.as_ref().replace('\\', "/");
        let last = path.rsplit('/').next().unwrap_or_default().to_owned();
        let is_below = !path.starts_with('/') && !path.contains(':') && !path.split('/').any(|part| part == "..");
        let candidates = [Some(path).filter(|_| is_below), Some(last)];
        for name in candidates.into_iter().flatten().filter(|name| !name.is_empty()) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
    }
    names
}

/// Returns how a texture is sampled.
pub(super) fn sampling(texture: &ufbx::Texture) -> Sampling {
    let wrap = |mode| match mode {
        ufbx::WrapMode::Repeat => Wrap::Repeat,
        ufbx::WrapMode::Clamp => Wrap::Clamp,
    };
    Sampling { wrap: [wrap(texture.wrap_u), wrap(texture.wrap_v)], ..Sampling::default() }
}
