//! What a part of a mesh has in place of what its tessellation says for all.

use std::fmt;
use std::str::FromStr;

use super::{Mesh, Topology};
use crate::choice::Choice;
use crate::defaults::with_defaults;
use crate::surface_kind::Surface;

with_defaults! {
    /// What a part of a mesh has in place of what its tessellation says for all.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct PartStyle {
        /// Its surface; none for that of the tessellation.
        pub surface: Option<Surface> = None,
        /// How many times as fine as the rest LOD makes it, [`Self::LEAST`] to [`Self::MOST`] in steps of that least: by so much its
        /// lengths and errors in px count, and given factors are multiplied. None for 1.
        pub detail: Option<f32> = None,
    }
}

impl PartStyle {
    /// The coarsest detail, and its step.
    pub const LEAST: f32 = 1.0 / 64.0;
    /// The finest detail.
    pub const MOST: f32 = 16.0;

    /// This style, and what it doesn't say of another one.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self { surface: self.surface.or(other.surface), detail: self.detail.or(other.detail) }
    }

    /// This style with the nearest detail that there is.
    #[must_use]
    pub fn rounded(self) -> Self {
        let nearest = |detail: f32| (detail / Self::LEAST).round().clamp(1.0, Self::MOST / Self::LEAST) * Self::LEAST;
        Self { detail: self.detail.map(nearest), ..self }
    }
}

/// As the command line has it: `surface=flat,detail=2`.
impl fmt::Display for PartStyle {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let surface = self.surface.map(|surface| format!("surface={}", surface.name()));
        let detail = self.detail.map(|detail| format!("detail={detail}"));
        f.write_str(&Vec::from_iter(surface.into_iter().chain(detail)).join(","))
    }
}

impl FromStr for PartStyle {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut own = Self::default();
        for (key, value) in text.split(',').map(|pair| pair.split_once('=').unwrap_or((pair, ""))) {
            match key.trim() {
                "surface" => {
                    let names = || Surface::ALL.map(Choice::name).join(", ");
                    let named = Surface::named(value.trim());
                    own.surface =
                        Some(named.ok_or_else(|| format!("no surface is named {value:?}: choose one of {}", names()))?);
                }
                "detail" => {
                    let detail = value.trim().parse().ok().filter(|detail| (Self::LEAST..=Self::MOST).contains(detail));
                    let reason = "a part's detail is a number from 1/64 (0.015625) to 16, such as detail=2";
                    own.detail = Some(detail.ok_or(reason)?);
                }
                _ => return Err("a part has surface=NAME or detail=NUMBER or both, joined by a comma".to_owned()),
            }
        }
        Ok(own.rounded())
    }
}

impl Mesh {
    /// What the part of a triangle has in place of what the tessellation says for all.
    pub fn style_of(&self, triangle: u32) -> PartStyle {
        if self.part_styles.is_empty() {
            return PartStyle::default();
        }
        let part = self.part_of(triangle);
        part.and_then(|part| self.part_styles.get(part as usize)).copied().unwrap_or_default()
    }

    /// The surfaces of its patches, if those of parts without one of their own have `surface`.
    pub fn surfaces(&self, surface: Surface) -> impl Iterator<Item = Surface> {
        std::iter::once(surface).chain(self.part_styles.iter().filter_map(|style| style.surface))
    }

    /// The surface as which all patches are evaluated: flat only if all of them are. The control points of flat ones among others
    /// lie in their planes.
    pub fn evaluated_surface(&self, surface: Surface) -> Surface {
        self.surfaces(surface).find(|own| !own.is_flat()).unwrap_or(surface)
    }
}

impl Topology {
    /// The surface of a patch and its detail, if parts without a surface of their own have `surface`.
    pub(super) fn patch_style(&self, mesh: &Mesh, patch: u32, surface: Surface) -> (Surface, f32) {
        let own = mesh.style_of(self.patches[patch as usize].triangle);
        (own.surface.unwrap_or(surface), own.detail.unwrap_or(1.0))
    }

    /// The surface of an edge and its detail, which all of its sides take, if those of parts without one of their own have
    /// `surface`: of different surfaces the one that comes first in [`Surface::ALL`], so that flat parts stay flat, and the finest
    /// detail. Then whether parts with different surfaces meet there.
    pub(super) fn edge_style(&self, mesh: &Mesh, edge: &super::Edge, surface: Surface) -> (Surface, f32, bool) {
        let styles = self.edge_sides(edge).iter().map(|side| self.patch_style(mesh, side.patch(), surface));
        let meets = |(least, finest, differs): (Surface, f32, bool), (own, detail): (Surface, f32)| {
            (least.min(own), finest.max(detail), differs || own != least)
        };
        let first = styles.clone().next().map_or((surface, 1.0, false), |(own, detail)| (own, detail, false));
        styles.fold(first, meets)
    }
}
