//! Reads what triangles look like: textures, and groups of materials, colours and texture coordinates.

use super::{ModelReader, PER_ENTRY};
use crate::read_error::ReadError;
use crate::text_lines::{number_or_nan, parsed, words};
use crate::threemf::properties::{Group, Texture2d};
use crate::threemf::xml::Element;

impl ModelReader<'_> {
    pub(super) fn begin_group(&mut self, element: &Element, group: Group) -> Result<(), ReadError> {
        self.budget.hold(PER_ENTRY)?;
        self.group = Some((self.id(element, "of properties")?, group));
        Ok(())
    }

    pub(super) fn end_group(&mut self) {
        let Some((id, group)) = self.group.take() else { return };
        self.part.groups.entry(id).or_insert(group);
    }

    pub(super) fn texture(&mut self, element: &Element) -> Result<(), ReadError> {
        let (id, texture) = (self.id(element, "texture2d")?, Texture2d::new(element));
        self.budget.hold(PER_ENTRY + 2 * texture.path.len() as u64)?;
        self.part.textures.entry(id).or_insert(texture);
        Ok(())
    }

    /// Reads a pair of texture coordinates. What isn't a number becomes NaN, which counts as a repair of the corners that use it.
    pub(super) fn coordinate(&mut self, element: &Element) -> Result<(), ReadError> {
        let at = |name: &[u8]| element.attribute(name).map_or(f32::NAN, |value| number_or_nan(value.trim_ascii()));
        if let Some((_, Group::Texture { coordinates, .. })) = &mut self.group {
            // A list that grows may take three times its size.
            self.budget.hold(3 * size_of::<[f32; 2]>() as u64)?;
            coordinates.push([at(b"u"), at(b"v")]);
        }
        Ok(())
    }

    /// Reads an entry of a group.
    pub(super) fn entry(&mut self, element: &Element) -> Result<(), ReadError> {
        let names = [&b"displaycolor"[..], b"color"];
        let text = names.iter().find_map(|name| element.attribute(name));
        let color = text.as_deref().and_then(color);
        // A material may have none.
        self.found.bad_colors += usize::from(text.is_some() && color.is_none());
        let color = color.unwrap_or([255; 4]);
        match &mut self.group {
            Some((_, Group::Materials(materials))) => {
                let name = element.text(b"name").unwrap_or_default();
                self.budget.hold(3 * (size_of::<(String, [u8; 4])>() + name.len()) as u64)?;
                materials.push((name, color));
            }
            Some((_, Group::Colors(colors))) => {
                self.budget.hold(3 * size_of::<[u8; 4]>() as u64)?;
                colors.push(color);
            }
            _ => {}
        }
        Ok(())
    }

    /// Begins layers of groups, or mixtures of materials. A group that isn't named is one that isn't there.
    pub(super) fn begin_combined(&mut self, element: &Element) -> Result<(), ReadError> {
        let lowest = first_of(element, b"pids", first_of(element, b"matid", u32::MAX));
        let first = first_of(element, b"matindices", 0);
        self.begin_group(element, Group::Combined { lowest, first, entries: Vec::new() })
    }

    pub(super) fn combined(&mut self, element: &Element) -> Result<(), ReadError> {
        if let Some((_, Group::Combined { first, entries, .. })) = &mut self.group {
            self.budget.hold(3 * size_of::<u32>() as u64)?;
            entries.push(first_of(element, b"pindices", *first));
        }
        Ok(())
    }
}

/// The first number of an attribute; another one without any, and one that nothing has for what isn't a number.
fn first_of(element: &Element, name: &[u8], otherwise: u32) -> u32 {
    let text = element.attribute(name).unwrap_or_default();
    let Some(word) = words(&text).next() else { return otherwise };
    parsed(word).unwrap_or(u32::MAX)
}

/// Parses a colour: `#RRGGBB` or `#RRGGBBAA`.
fn color(text: &[u8]) -> Option<[u8; 4]> {
    let digits = std::str::from_utf8(text.trim_ascii().strip_prefix(b"#")?).ok()?;
    let is_hexadecimal = matches!(digits.len(), 6 | 8) && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    let bits = u32::from_str_radix(digits, 16).ok().filter(|_| is_hexadecimal)?;
    Some(if digits.len() == 6 { bits << 8 | 0xff } else { bits }.to_be_bytes())
}
