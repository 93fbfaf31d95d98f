//! The textures that a part of a model declares: where their images are, and how they are sampled.
//!
//! Source: 3MF Materials and Properties Extension 1.2.1, sections 5 and 6.

use super::xml::Element;
use geometry::mesh::{Sampling, Wrap};

/// An image in the archive, and how it is sampled.
#[derive(Clone, Debug)]
pub(super) struct Texture2d {
    /// The image's name in the archive.
    pub path: String,
    pub sampling: Sampling,
    /// Whether nothing is beyond the image along u and v (the tile style `none`). Its border is shown there.
    pub ends: [bool; 2],
}

impl Texture2d {
    /// Reads the element `texture2d`.
    pub(super) fn of(element: &Element) -> Self {
        let styles = [&b"tilestyleu"[..], b"tilestylev"].map(|name| element.text(name).unwrap_or_default());
        let wrap = |style: &String| match style.trim() {
            "mirror" => Wrap::Mirror,
            "clamp" | "none" => Wrap::Clamp,
            _ => Wrap::Repeat,
        };
        let own = Sampling { wrap: styles.each_ref().map(wrap), ..Sampling::default() };
        let is_nearest = element.text(b"filter").is_some_and(|filter| filter.trim() == "nearest");
        let sampling = match is_nearest {
            true => Sampling { magnify_linear: false, minify_linear: false, mip_linear: None, ..own },
            false => own,
        };
        let ends = styles.each_ref().map(|style| style.trim() == "none");
        Self { path: element.text(b"path").unwrap_or_default(), sampling, ends }
    }

    /// Whether texture coordinates lead to where nothing is.
    pub(super) fn leaves(&self, uv: [f32; 2]) -> bool {
        self.ends.iter().zip(uv).any(|(ends, x)| *ends && !(0.0..=1.0).contains(&x))
    }

    /// The image's name without its folder.
    pub(super) fn name(&self) -> &str {
        self.path.rsplit('/').next().unwrap_or_default()
    }
}
