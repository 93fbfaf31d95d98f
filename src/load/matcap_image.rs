//! Reads pictures of lit spheres, whose colours a surface is shown in.

use std::path::{Path, PathBuf};

use super::images::decode_halved;
use super::memory_budget::Budget;
use crate::files::{FileError, Limits, read_file};
use geometry::mesh::Texture;
use geometry::mesh::mipmap::MipFilter;
use geometry::names::shown_path;
use geometry::progress::Progress;

/// Why a picture of a lit sphere could not be loaded.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the messages say what the fields are")]
pub enum MatcapError {
    /// The file can't be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// The file isn't an image, or takes too much memory.
    #[error("{} can't be used as a matcap: {reason}; choose a PNG, JPEG or WebP image", shown_path(path))]
    Image { path: PathBuf, reason: String },
}

/// Reads a PNG, JPEG or WebP image of a lit sphere, which fills it from border to border.
///
/// # Errors
/// [`MatcapError`].
pub fn load_matcap(path: &Path, limits: &Limits) -> Result<Texture, MatcapError> {
    let bytes = read_file::<FileError>(path, limits, |_| Ok(()), &Progress::new())?;
    let budget = Budget::new(bytes.len(), limits.memory);
    let decoded = decode_halved(&bytes, 0, MipFilter::Colors, &budget);
    decoded.map_err(|reason| MatcapError::Image { path: path.to_owned(), reason })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_image_is_read_and_anything_else_is_refused_with_its_name() {
        let folder = tempfile::tempdir().expect("a writable temporary folder");
        let path = |name: &str| folder.path().join(name);
        image::RgbaImage::from_pixel(3, 2, image::Rgba([9, 80, 200, 255])).save(path("blue.png")).expect("written");
        let read = load_matcap(&path("blue.png"), &Limits::default()).expect("an image");
        assert_eq!((read.size, &read.rgba[..4]), ([3, 2], &[9, 80, 200, 255][..]));
        std::fs::write(path("text.png"), "no image").expect("written");
        for name in ["text.png", "none.png", "."] {
            let said = load_matcap(&path(name), &Limits::default()).expect_err("no image").to_string();
            assert!(said.contains(name) && !said.contains('\n'), "{said}");
        }
        let small = Limits { memory: 100 << 10, ..Limits::default() };
        image::RgbaImage::new(400, 400).save(path("large.png")).expect("written");
        let said = load_matcap(&path("large.png"), &small).expect_err("too large").to_string();
        assert!(said.contains("400 x 400 px") && said.contains("scale it down"), "{said}");
    }
}
