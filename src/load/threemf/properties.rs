//! Groups of properties: materials, colours, texture coordinates, and what is combined of these.
//!
//! Source: 3MF Materials and Properties Extension 1.2.1, chapters 2 to 5.

use glam::Vec4;

use crate::face_builder::linear_color;

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
