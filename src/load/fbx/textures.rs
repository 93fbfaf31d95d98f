//! Reads the images of textures: embedded ones, or files beside the model.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use crate::notes::Notes;
use crate::texture_room::{ReadImage, read_images};
use crate::uri::{Files, shown};
use geometry::mesh::mipmap::MipFilter;
use geometry::mesh::{Sampling, Texture, Wrap};
use geometry::progress::Cancelled;

/// Images by texture.
pub(super) struct Textures<'a> {
    files: &'a Files<'a>,
    /// By the number of the file.
    images: HashMap<u32, ReadImage>,
}

impl<'a> Textures<'a> {
    pub(super) fn new(files: &'a Files<'a>) -> Self {
        Self { files, images: HashMap::new() }
    }

    /// Reads the images of these textures. `reserved` is the memory that the rest of the load takes, in bytes.
    pub(super) fn read<'t>(
        &mut self,
        used: impl Iterator<Item = (&'t ufbx::Texture, MipFilter)>,
        reserved: u64,
    ) -> Result<(), Cancelled> {
        let mut seen = HashSet::new();
        let used = used.filter_map(|(texture, filter)| Some((of_file(texture)?, filter)));
        let used: Vec<_> = used.filter(|(file, _)| seen.insert(file.file_index)).collect();
        let bytes = |(file, filter)| Ok((self.bytes(file)?, filter));
        let read = read_images(&used, bytes, reserved, self.files.budget, self.files.progress)?;
        self.images = used.iter().map(|(file, _)| file.file_index).zip(read).collect();
        Ok(())
    }

    /// Returns the image of a texture. One that is missing or broken causes a warning, which begins with `what`.
    pub(super) fn image(&mut self, texture: &ufbx::Texture, what: &str, notes: &mut Notes) -> Option<Arc<Texture>> {
        let Some(file) = of_file(texture) else {
            notes.push(format!("{what} is left out: it is computed by another program."));
            return None;
        };
        let image = self.images.get_mut(&file.file_index)?;
        notes.extend(image.said.take().map(|said| format!("{what} {said}")));
        image.texture.clone()
    }

    /// Returns the bytes of an image.
    ///
    /// # Errors
    /// A clause that says why there are none.
    pub(super) fn bytes<'t>(&self, texture: &'t ufbx::Texture) -> Result<Cow<'t, [u8]>, String> {
        if !texture.content.is_empty() {
            return Ok(Cow::Borrowed(&texture.content));
        }
        let mut problem = "it names no file; export the model again".to_owned();
        for name in names(texture) {
            // The name isn't a URI, so a % is a letter.
            match self.files.read(&name.replace('%', "%25"), false) {
                Ok(bytes) => return Ok(bytes.into()),
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
    let paths = [&texture.relative_filename, &texture.filename, &texture.absolute_filename];
    let names = paths.into_iter().flat_map(|path| {
        let path = path.as_ref().replace('\\', "/");
        let last = path.rsplit('/').next().unwrap_or_default().to_owned();
        let is_below = !path.starts_with('/') && !path.contains(':') && !path.split('/').any(|part| part == "..");
        [Some(path).filter(|_| is_below), Some(last)]
    });
    names.flatten().filter(|name| !name.is_empty()).collect()
}

/// Returns how a texture is sampled.
pub(super) fn sampling(texture: &ufbx::Texture) -> Sampling {
    let wrap = |mode| match mode {
        ufbx::WrapMode::Repeat => Wrap::Repeat,
        ufbx::WrapMode::Clamp => Wrap::Clamp,
    };
    Sampling { wrap: [wrap(texture.wrap_u), wrap(texture.wrap_v)], ..Sampling::default() }
}
