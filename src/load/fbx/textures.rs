//! Reads the images of textures: embedded ones, or files beside the model.

use std::collections::HashMap;
use std::sync::Arc;

use crate::load::images::decode_texture;
use crate::load::memory_budget::Budget;
use crate::load::notes::Notes;
use crate::load::uri::Files;
use crate::mesh::{MemoryAccount, Sampling, Texture, Wrap};

/// Images by texture.
pub(super) struct Textures<'a> {
    files: &'a Files<'a>,
    budget: &'a Budget,
    /// By the number of the file, the image; none for one that can't be read.
    images: HashMap<u32, Option<Arc<Texture>>>,
}

impl<'a> Textures<'a> {
    pub(super) fn new(files: &'a Files<'a>, budget: &'a Budget) -> Self {
        Self { files, budget, images: HashMap::new() }
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
        let borrowed = self.budget.borrowed();
        let image = self.read(file).map(Arc::new);
        self.budget.give_back_to(borrowed);
        let image = image.map_err(|reason| notes.push(format!("{what} is left out: {reason}.")));
        self.images.insert(file.file_index, image.clone().ok());
        image.ok()
    }

    /// # Errors
    /// A clause that says what is wrong.
    fn read(&self, texture: &ufbx::Texture) -> Result<Texture, String> {
        if !texture.content.is_empty() {
            return decode_texture(&texture.content, self.budget);
        }
        let mut problem = "it names no file; export the model again".to_owned();
        for name in names(texture) {
            // The name isn't a URI, so a % is a letter.
            match self.files.read(&name.replace('%', "%25"), false) {
                Ok(bytes) => return decode_texture(&bytes, self.budget),
                Err(reason) => problem = reason,
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
