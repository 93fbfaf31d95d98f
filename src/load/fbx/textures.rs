//! The files of textures: embedded ones, or files beside the model.

use std::borrow::Cow;

use crate::uri::{Files, shown};
use geometry::mesh::{Sampling, Wrap};

/// Returns the bytes of an image.
///
/// # Errors
/// A clause that says why there are none.
pub(super) fn bytes<'t>(texture: &'t ufbx::Texture, files: &Files) -> Result<Cow<'t, [u8]>, String> {
    if !texture.content.is_empty() {
        return Ok(Cow::Borrowed(&texture.content));
    }
    let mut problem = "it names no file; export the model again".to_owned();
    for name in names(texture) {
        // The name isn't a URI, so a % is a letter.
        match files.read(&name.replace('%', "%25"), false) {
            Ok(bytes) => return Ok(bytes.into()),
            Err(reason) => problem = format!("\"{}\" can't be read: {reason}", shown(&name)),
        }
    }
    Err(problem)
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
