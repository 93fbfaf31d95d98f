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
        /// How many times as fine as the rest LOD makes it, [`Self::LEAST`] to [`Self::MOST`] in steps of that least: it multiplies
        /// lengths and errors in px, and the factors of uniform LOD and of LOD by distance. None for 1.
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
        // A NaN becomes the least.
        let steps = |detail: f32| (detail / Self::LEAST).round().max(1.0);
        Self { detail: self.detail.map(|detail| (steps(detail) * Self::LEAST).min(Self::MOST)), ..self }
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
        part.and_then(|part| self.part_styles.get(part as usize)).copied().unwrap_or_default().rounded()
    }
}

/// What of the styles of a mesh's parts counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StylesUsed {
    #[default]
    Nothing,
    /// Details alone: something else makes the surface.
    Details,
    /// Surfaces and details, where parts without a surface of their own have this one.
    All(Surface),
}

/// What the parts beside a curve have in place of what the tessellation says for all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveStyle {
    pub surface: Surface,
    /// As [`PartStyle::detail`].
    pub detail: f32,
}

impl Topology {
    /// How many times as fine as others LOD makes a patch.
    pub fn detail_of(&self, mesh: &Mesh, patch: u32) -> f32 {
        mesh.style_of(self.patches[patch as usize].triangle).detail.unwrap_or(1.0)
    }

    /// The surface of a patch and its detail.
    pub(super) fn patch_style(&self, mesh: &Mesh, patch: u32, surface: Surface) -> CurveStyle {
        let own = mesh.style_of(self.patches[patch as usize].triangle);
        CurveStyle { surface: own.surface.unwrap_or(surface), detail: own.detail.unwrap_or(1.0) }
    }

    /// What all sides of an edge take: of different surfaces the one that comes first in [`Surface::ALL`], so that flat parts stay
    /// flat, and the finest detail. Then whether parts with different surfaces meet there.
    pub(super) fn edge_style(&self, mesh: &Mesh, edge: &super::Edge, surface: Surface) -> (CurveStyle, bool) {
        let styles = self.edge_sides(edge).iter().map(|side| self.patch_style(mesh, side.patch(), surface));
        let meets = |(edge, differs): (CurveStyle, bool), own: CurveStyle| {
            let met = CurveStyle { surface: edge.surface.min(own.surface), detail: edge.detail.max(own.detail) };
            (met, differs || own.surface != edge.surface)
        };
        let first = styles.clone().next().unwrap_or(CurveStyle { surface, detail: 1.0 });
        styles.fold((first, false), meets)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Curves, PartRange, Shape, Sharing};

    /// A torus whose first half is a part of this style.
    fn half(style: PartStyle) -> (Mesh, Topology) {
        let mut mesh = Shape::Torus.build();
        mesh.part_ranges = vec![PartRange { triangles: 0..mesh.triangles.len() as u32 / 2, part: 0 }];
        mesh.part_styles = vec![style];
        let topology = Topology::new(&mesh);
        (mesh, topology)
    }

    #[test]
    fn styles_are_read_as_they_are_written() {
        for surface in Surface::ALL.map(Some).into_iter().chain([None]) {
            for detail in [None, Some(PartStyle::LEAST), Some(0.5), Some(1.0), Some(3.25), Some(PartStyle::MOST)] {
                let style = PartStyle { surface, detail };
                let is_written = style != PartStyle::default();
                assert!(!is_written || style.to_string().parse() == Ok(style), "{style}");
            }
        }
        for text in ["", "flat", "surface=", "surface=round", "detail=0", "detail=nan", "detail=17", "size=2"] {
            assert!(text.parse::<PartStyle>().is_err(), "{text}");
        }
    }

    #[test]
    fn a_program_that_embeds_may_give_any_detail() {
        let least = PartStyle::LEAST;
        for (given, expected) in [(f32::NAN, least), (-1.0, least), (0.0, least), (0.51, 33.0 * least), (1e9, 16.0)] {
            let (mesh, _) = half(PartStyle { surface: None, detail: Some(given) });
            assert_eq!(mesh.style_of(0).detail, Some(expected));
        }
    }

    #[test]
    fn details_alone_change_no_group_and_as_published_each_side_follows_its_own_surface() {
        let (mesh, topology) = half(PartStyle { surface: Some(Surface::Pn), detail: Some(2.0) });
        for sharing in [Sharing::EachSide, Sharing::NoneAveraged] {
            let (plain, own) = (
                Curves::build(&mesh, &topology, sharing),
                Curves::styled(&mesh, &topology, sharing, StylesUsed::Details),
            );
            assert_eq!((&own.sides, &own.curves), (&plain.sides, &plain.curves), "{sharing:?}");
            assert_eq!(own.styles.len(), own.curves.len());
        }
        let own = Curves::styled(&mesh, &topology, Sharing::NoneAveraged, StylesUsed::All(Surface::PnAen));
        for (side, curve) in topology.sides.iter().zip(&own.side_curves) {
            let style = own.styles[*curve as usize];
            let is_in_part = mesh.part_of(topology.patches[side.patch() as usize].triangle).is_some();
            assert_eq!(style.surface, if is_in_part { Surface::Pn } else { Surface::PnAen });
            assert_eq!(own.curves[*curve as usize].side_count, if is_in_part { 1 } else { 2 });
        }
    }
}
