//! Groups of properties: materials, colours, texture coordinates, and what is combined of these; and textures.
//!
//! Source: 3MF Materials and Properties Extension 1.2.1, chapters 2 to 6.

use glam::Vec4;

use super::xml::Element;
use crate::face_builder::linear_color;
use geometry::mesh::{Sampling, Wrap};

/// A group of properties. Entries are counted from 0.
pub(super) enum Group {
    /// Materials, with their names and colours.
    Materials(Vec<(String, [u8; 4])>),
    Colors(Vec<[u8; 4]>),
    /// Coordinates of a texture, with its number in the part; v counts from the bottom.
    Texture {
        texture: u32,
        coordinates: Vec<[f32; 2]>,
    },
    /// Layers of groups, of which only the lowest is read, or mixtures of materials, of which only the first is.
    Combined {
        /// The group of the lowest layer, or of the materials.
        lowest: u32,
        /// The entry there of those that name none: that of the first material.
        first: u32,
        entries: Vec<u32>,
    },
}

/// The colour of a material in linear RGBA. Some programs write the alpha 0 for materials that are meant to be seen.
pub(super) fn material_color(color: [u8; 4]) -> Vec4 {
    let color = linear_color(color);
    if color.w == 0.0 { color.with_w(1.0) } else { color }
}

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
    pub(super) fn new(element: &Element) -> Self {
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
