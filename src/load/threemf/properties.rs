//! Groups of properties: materials, colours, texture coordinates, mixtures of materials, and layers of all of these.
//!
//! Source: 3MF Materials and Properties Extension 1.2.1, chapters 2 to 5.

use glam::Vec4;

use super::layers::Method;
use super::xml::Element;
use crate::face_builder::linear_color;

/// How many layers are read. The specification allows one of materials and one of colours, and any number of textures.
const MAX_LAYERS: usize = 16;

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
    Composites(Composites),
    Layers(MultiProperties),
}

/// Mixtures of materials.
pub(super) struct Composites {
    /// The colours of the materials that are mixed, in linear RGBA; none for those that aren't in the file.
    constituents: Vec<Option<Vec4>>,
    /// The colours of the mixtures, in linear RGBA.
    pub colors: Vec<Vec4>,
}

impl Composites {
    /// Reads the element `compositematerials`. `materials` are those that it mixes.
    pub(super) fn of(element: &Element, materials: Option<&Group>) -> Self {
        let indices = element.text(b"matindices").unwrap_or_default();
        let color = |index: &str| match materials? {
            Group::Materials(materials) => Some(material_color(materials.get(index.parse::<usize>().ok()?)?.1)),
            _ => None,
        };
        Self { constituents: indices.split_ascii_whitespace().map(color).collect(), colors: Vec::new() }
    }

    /// How many of its materials aren't in the file.
    pub(super) fn absent(&self) -> usize {
        self.constituents.iter().filter(|color| color.is_none()).count()
    }

    /// Mixes the colours by the shares in a text. If all are 0, they are equal. Also returns how many shares aren't numbers from 0 on.
    pub(super) fn mixed(&self, shares: &str) -> (Vec4, usize) {
        let (mut sum, mut total, mut bad) = (Vec4::ZERO, 0.0_f64, 0);
        for (color, share) in self.constituents.iter().zip(shares.split_ascii_whitespace()) {
            let share = share.parse::<f32>().ok().filter(|share| share.is_finite() && *share >= 0.0);
            bad += usize::from(share.is_none());
            let Some((color, share)) = color.zip(share) else { continue };
            // A mean that moves stays within the colours, however large the shares are.
            total += f64::from(share);
            if total > 0.0 {
                sum += (color - sum) * (f64::from(share) / total) as f32;
            }
        }
        (if total > 0.0 { sum } else { self.even() }, bad)
    }

    /// The colour of equal shares.
    fn even(&self) -> Vec4 {
        let known = || self.constituents.iter().flatten();
        match known().count() {
            0 => Vec4::ONE,
            count => known().sum::<Vec4>() / count as f32,
        }
    }
}

/// Layers of other groups.
pub(super) struct MultiProperties {
    /// The groups, the lowest first, with how each is blended with those below.
    pub layers: Vec<(u32, Method)>,
    /// For each entry, those of all layers one after the other.
    entries: Vec<u32>,
}

/// What was wrong with layers.
#[derive(Default)]
pub(super) struct LayerFaults {
    /// Layers beyond those that are read.
    pub beyond: usize,
    /// Ways to blend that aren't known.
    pub methods: usize,
}

impl MultiProperties {
    /// Reads the element `multiproperties`.
    pub(super) fn of(element: &Element) -> (Self, LayerFaults) {
        let [groups, methods] = [&b"pids"[..], b"blendmethods"].map(|name| element.text(name).unwrap_or_default());
        let mut faults = LayerFaults::default();
        // The lowest layer has none.
        let mut methods = methods.split_ascii_whitespace();
        let mut layers = Vec::new();
        for (i, group) in groups.split_ascii_whitespace().enumerate() {
            if i >= MAX_LAYERS {
                faults.beyond += 1;
                continue;
            }
            let method = match if i > 0 { methods.next() } else { None } {
                Some("multiply") => Method::Multiply,
                None | Some("mix") => Method::Mix,
                Some(_) => {
                    faults.methods += 1;
                    Method::Mix
                }
            };
            // A group without a number is one that isn't there.
            layers.push((group.parse().unwrap_or(u32::MAX), method));
        }
        (Self { layers, entries: Vec::new() }, faults)
    }

    /// Adds an entry, whose numbers for the layers a text has. Those that are missing are 0.
    pub(super) fn push(&mut self, numbers: &str) {
        let numbers = numbers.split_ascii_whitespace().map(|number| number.parse().unwrap_or(u32::MAX));
        self.entries.extend(numbers.chain(std::iter::repeat(0)).take(self.layers.len()));
    }

    /// The numbers that an entry has for the layers; none if there is no such entry.
    pub(super) fn entry(&self, index: u32) -> Option<&[u32]> {
        let count = self.layers.len();
        let start = (index as usize).checked_mul(count)?;
        self.entries.get(start..start.checked_add(count)?).filter(|entry| !entry.is_empty())
    }
}

/// The colour of a material in linear RGBA. Some programs write the alpha 0 for materials that are meant to be seen.
pub(super) fn material_color(color: [u8; 4]) -> Vec4 {
    let color = linear_color(color);
    if color.w == 0.0 { color.with_w(1.0) } else { color }
}
