//! What a part of a mesh, or a material, has in place of what is said for all.

use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

use super::normals::NormalSource;
use super::{Mesh, Topology};
use crate::choice::Choice;
use crate::defaults::with_defaults;
use crate::surface_kind::Surface;

with_defaults! {
    /// What a part of a mesh, or a material, has in place of what is said for all. Where both say something, the part does.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct PartStyle {
        /// Its surface; none for that of the tessellation.
        pub surface: Option<Surface> = None,
        /// How many times as fine as the rest LOD makes it, [`Self::LEAST`] to [`Self::MOST`] in steps of that least: it multiplies
        /// lengths and errors in px, and the factors of uniform LOD and of LOD by distance. None for 1.
        pub detail: Option<f32> = None,
        /// Whose normals its corners get when the file is read; none for those that are chosen for all.
        pub normals: Option<NormalSource> = None,
        /// The angle up to which its triangles are smooth where normals are made, in degrees from 0 to 180; none for that of all.
        pub crease_angle: Option<f32> = None,
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
        Self {
            surface: self.surface.or(other.surface),
            detail: self.detail.or(other.detail),
            normals: self.normals.or(other.normals),
            crease_angle: self.crease_angle.or(other.crease_angle),
        }
    }

    /// Whether it says anything of how a mesh is tessellated that was read.
    pub fn is_of_tessellation(&self) -> bool {
        self.surface.is_some() || self.detail.is_some()
    }

    /// This style with the nearest detail that there is.
    #[must_use]
    pub fn rounded(self) -> Self {
        // A NaN becomes the least.
        let steps = |detail: f32| (detail / Self::LEAST).round().max(1.0);
        Self { detail: self.detail.map(|detail| (steps(detail) * Self::LEAST).min(Self::MOST)), ..self }
    }
}

/// As the command line has it: `surface=flat,detail=2,normals=made,crease=30`.
impl fmt::Display for PartStyle {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let texts = [
            self.surface.map(|surface| format!("surface={}", surface.name())),
            self.detail.map(|detail| format!("detail={detail}")),
            self.normals.map(|normals| format!("normals={}", normals.name())),
            self.crease_angle.map(|angle| format!("crease={angle}")),
        ];
        f.write_str(&Vec::from_iter(texts.into_iter().flatten()).join(","))
    }
}

/// The value of that name.
fn named<T: Choice>(what: &str, name: &str) -> Result<Option<T>, String> {
    let names = || Vec::from_iter(T::ALL.iter().map(|value| value.name())).join(", ");
    T::named(name).map(Some).ok_or_else(|| format!("no {what} is named {name:?}: choose one of {}", names()))
}

/// The number that a text is, if it is in a range, which `reason` describes.
fn number(text: &str, range: RangeInclusive<f32>, reason: &str) -> Result<Option<f32>, String> {
    text.parse().ok().filter(|number| range.contains(number)).map(Some).ok_or_else(|| reason.to_owned())
}

impl FromStr for PartStyle {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut own = Self::default();
        let of_detail = "a part's detail is a number from 1/64 (0.015625) to 16, such as detail=2";
        let of_crease = "a part's crease angle is a number of degrees from 0 to 180, such as crease=30";
        for (key, value) in text.split(',').map(|pair| pair.split_once('=').unwrap_or((pair, ""))) {
            let value = value.trim();
            match key.trim() {
                "surface" => own.surface = named("surface", value)?,
                "detail" => own.detail = number(value, Self::LEAST..=Self::MOST, of_detail)?,
                "normals" => own.normals = named("source of normals", value)?,
                "crease" => own.crease_angle = number(value, 0.0..=180.0, of_crease)?,
                _ => return Err("a part has surface=, detail=, normals= or crease=, joined by commas".to_owned()),
            }
        }
        Ok(own.rounded())
    }
}

impl Mesh {
    /// What a triangle has in place of what is said for all: what its part says, then its material.
    pub fn style_of(&self, triangle: u32) -> PartStyle {
        let part = if self.part_styles.is_empty() { None } else { self.part_of(triangle) };
        let part = part.and_then(|part| self.part_styles.get(part as usize)).copied();
        let material = self.materials.partition_point(|material| material.triangles.end <= triangle);
        let material = self.materials.get(material).map(|material| material.style);
        part.unwrap_or_default().or(material.unwrap_or_default()).rounded()
    }

    /// The styles of parts and of materials.
    pub fn styles(&self) -> impl Iterator<Item = PartStyle> {
        self.part_styles.iter().copied().chain(self.materials.iter().map(|material| material.style))
    }

    /// Whether anything is tessellated otherwise than the tessellation says for all.
    pub fn has_styles(&self) -> bool {
        self.styles().any(|own| own.is_of_tessellation())
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
    use crate::mesh::{Curves, Material, PartRange, Shape, Sharing};

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
                for (normals, crease_angle) in [
                    (None, None),
                    (Some(NormalSource::File), Some(0.0)),
                    (Some(NormalSource::Made), Some(22.5)),
                    (None, Some(180.0)),
                ] {
                    let style = PartStyle { surface, detail, normals, crease_angle };
                    let is_written = style != PartStyle::default();
                    assert!(!is_written || style.to_string().parse() == Ok(style), "{style}");
                }
            }
        }
        let all = "surface=pn,detail=2,normals=made,crease=30";
        assert_eq!(all.parse::<PartStyle>().map(|own| own.to_string()), Ok(all.to_owned()));
        for text in ["", "flat", "surface=", "surface=round", "detail=0", "detail=nan", "detail=17", "size=2"] {
            assert!(text.parse::<PartStyle>().is_err(), "{text}");
        }
        for text in ["normals=", "normals=smooth", "crease=", "crease=nan", "crease=-1", "crease=181", "crease=inf"] {
            assert!(text.parse::<PartStyle>().is_err(), "{text}");
        }
    }

    #[test]
    fn a_program_that_embeds_may_give_any_detail() {
        let least = PartStyle::LEAST;
        for (given, expected) in [(f32::NAN, least), (-1.0, least), (0.0, least), (0.51, 33.0 * least), (1e9, 16.0)] {
            let (mesh, _) = half(PartStyle { detail: Some(given), ..PartStyle::default() });
            assert_eq!(mesh.style_of(0).detail, Some(expected));
        }
    }

    #[test]
    fn a_material_has_a_style_where_the_part_says_nothing() {
        let style = |text: &str| text.parse::<PartStyle>().expect("a style");
        let (mut mesh, _) = half(style("surface=pn"));
        let count = mesh.triangles.len() as u32;
        assert!(!mesh.materials[0].style.is_of_tessellation());
        // The materials' border is within the part.
        let first = mesh.materials[0].clone();
        mesh.materials = vec![
            Material { triangles: 0..count / 4, ..first.clone() },
            Material { triangles: count / 4..count, style: style("surface=flat,detail=2"), ..first },
        ];
        let styles = [0, count / 4 - 1, count / 4, count / 2 - 1, count / 2, count - 1].map(|own| mesh.style_of(own));
        let [plain, both, material] = ["surface=pn", "surface=pn,detail=2", "surface=flat,detail=2"].map(style);
        assert_eq!(styles, [plain, plain, both, both, material, material]);
        mesh.part_styles = vec![style("normals=made,crease=10")];
        assert!(mesh.has_styles(), "the material has one");
        mesh.materials.pop();
        assert!(!mesh.has_styles(), "normals are those of the file when it is read");
    }

    #[test]
    fn details_alone_change_no_group_and_as_published_each_side_follows_its_own_surface() {
        let style = PartStyle { surface: Some(Surface::Pn), detail: Some(2.0), ..PartStyle::default() };
        let (mesh, topology) = half(style);
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
