//! Structs and constants that draws share. `shaders/draw_types.wgsl` has the same; tests compare them.

use bytemuck::{Pod, Zeroable};

use super::Scale;
use crate::settings::Overlays;
use geometry::mesh::{EdgeKind, Slot};
use gpu::layout::Vertex;

/// The constants of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Frame {
    pub clip_from_object: [[f32; 4]; 4],
    /// Unit directions in object space towards the two lights, which move with the camera.
    pub key_light: [f32; 4],
    pub fill_light: [f32; 4],
    /// The eye's position (w = 1), or the direction towards it when the projection is orthographic (w = 0).
    pub eye: [f32; 4],
    /// Width and height in px.
    pub viewport: [f32; 2],
    /// From [`overlay_bits`].
    pub overlays: u32,
    /// One unit in the last place of the mesh's largest coordinate, in object units.
    pub ulp: f32,
    /// A [`geometry::tessellate::Convention`]: which side each of a patch's factors is for.
    pub convention: u32,
    /// The ends of the colour scale, if the surface's colours stand for numbers.
    pub scale_least: f32,
    pub scale_most: f32,
    /// If deviations are shown in px, the px per object unit where w is 1; else 0.
    pub px_per_unit: f32,
    /// From [`super::ground::Ground`]: its middle, and how far apart its lines are, in object units.
    pub ground: [f32; 4],
    /// The scale's colours in sRGB, 0 to 1; the fourth component is unused.
    pub scale: [[f32; 4]; Scale::STOPS],
    /// The first column of pixels of the half that is drawn, in px.
    pub left: f32,
    /// Px of the full picture that one px stands for, along each axis: more than 1 in coarse previews.
    pub coarseness: f32,
    /// By how many columns all that is drawn is moved to the right.
    pub shift: f32,
    /// The kind of the numbers that colours stand for: a [`geometry::tessellate::CurvatureKind`], or under texel density a
    /// [`crate::settings::SurfaceUnit`].
    pub kind: u32,
    /// The unit direction along the zebra's stripes, to the right and up in the view.
    pub zebra_axis: [f32; 2],
    /// Stripes over half a turn of the normal.
    pub zebra_stripes: f32,
    /// Squares of the checker in one unit of u or v.
    pub checker_squares: f32,
}

/// A material's constants.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Material {
    /// Linear RGBA.
    pub base_color: [f32; 4],
    /// Linear RGB that it emits.
    pub emissive: [f32; 3],
    pub metallic: f32,
    /// Linear RGB, with the strength below: how a dielectric reflects.
    pub specular_color: [f32; 3],
    /// Perceptual roughness, as that of the coat.
    pub roughness: f32,
    pub ior: f32,
    pub specular: f32,
    /// How much of the surface a clear coat covers.
    pub coat: f32,
    pub coat_roughness: f32,
    /// 0 without a normal map.
    pub normal_scale: f32,
    pub occlusion_strength: f32,
    /// With less alpha there is no surface, or if it blends, none that hides what is behind.
    pub cutoff: f32,
    /// 1 if the base colour is shown as it is.
    pub unlit: f32,
    /// 1 if alpha says how much of a place the surface covers.
    pub blends: f32,
    /// How much of a dielectric's light goes through it.
    pub transmission: f32,
    /// 0 without a normal map of the coat.
    pub coat_normal_scale: f32,
    /// How much longer highlights are along a direction than across it.
    pub anisotropy: f32,
    /// Linear RGB of the sheen; 0 without one.
    pub sheen_color: [f32; 3],
    pub sheen_roughness: f32,
    /// What the body behind the surface absorbs in an object unit.
    pub absorption: [f32; 3],
    /// How far light goes through that body, in object units.
    pub thickness: f32,
    /// The direction of long highlights: along the tangent, and along the bitangent.
    pub anisotropy_direction: [f32; 2],
    pub _pad: [f32; 2],
    /// In the order of [`Slot::ALL`].
    pub maps: [MapPlace; Slot::COUNT],
}

/// Less of what is behind a place can't be seen: it is half a step of a picture's channels.
pub(crate) const LEAST_SEEN: f32 = 1.0 / 512.0;

/// Where an image is read: u' = `u[0]` u + `u[1]` v + `u[2]`, and v' likewise. `u[3]` is 0 for the texture coordinates of the base
/// colour, and 1 or 2 for the first or second of the corners' details.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct MapPlace {
    pub u: [f32; 4],
    pub v: [f32; 4],
}

/// The result of picking: what is in front at a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Pick {
    /// The triangle's vertices as they were emitted; zero for an input triangle.
    pub vertices: [Vertex; 3],
    /// [`FOUND_EMITTED`] for an emitted triangle, another number but 0 for an input triangle, 0 for nothing.
    pub found: u32,
    pub patch_index: u32,
    /// The index of the emitted triangle in its patch.
    pub triangle: u32,
    /// The weight (0 u, 1 v, 2 w) of the nearest edge of the triangle on screen.
    pub weight: u32,
}

/// [`Pick::found`] for an emitted triangle; the same in `shaders/draw_types.wgsl`.
pub(crate) const FOUND_EMITTED: u32 = 1;

/// The overlays that the surface's shader draws, as the bits `OVERLAY_*`. Cracks, T-junctions, bones and normals are drawn as
/// lines instead, and the ground has a shader of its own.
pub(crate) fn overlay_bits(overlays: &Overlays) -> u32 {
    let Overlays { colors, wireframe, patches, adjacency, folds, back_faces, .. } = *overlays;
    // Colours have a bit each above those, but for the mesh's own, which are the first.
    let colors = (1_u32 << colors as u32) & !1;
    let switches = [wireframe, patches, adjacency, folds, back_faces];
    (0..).zip(switches).fold(colors << (switches.len() - 1), |bits, (bit, is_on)| bits | u32::from(is_on) << bit)
}

/// sRGB colour of an edge kind, for legends; `edge_color` in `shaders/draw_surface_color.wgsl` has the same in linear light.
/// People with any colour vision can tell them apart (Okabe and Ito 2008). Smooth edges have an inconspicuous grey.
pub fn edge_color(kind: EdgeKind) -> [u8; 3] {
    match kind {
        EdgeKind::Smooth => [170, 175, 183],
        EdgeKind::Split => [230, 159, 0],
        EdgeKind::Seam => [0, 158, 115],
        EdgeKind::Boundary => [86, 180, 233],
        EdgeKind::NonManifold => [204, 121, 167],
    }
}

/// sRGB colour of a crack.
pub const CRACK_COLOR: [u8; 3] = [255, 60, 25];

/// sRGB colour of a T-junction.
pub const T_JUNCTION_COLOR: [u8; 3] = [240, 228, 66];

/// sRGB colour of a fold; `FOLD_COLOR` in `shaders/draw_surface_color.wgsl` has the same in linear light.
pub const FOLD_COLOR: [u8; 3] = [190, 70, 255];

#[cfg(test)]
/// sRGB colour of a face seen from behind, before it is lit; `BACK_FACE_COLOR` in `shaders/draw_surface_color.wgsl` has the same
/// in linear light.
pub(crate) const BACK_FACE_COLOR: [u8; 3] = [225, 30, 110];

/// sRGB colour of the backs of faces that a section shows; `SECTION_COLOR` there is the same in linear light.
#[cfg(test)]
pub(crate) const SECTION_COLOR: [u8; 3] = [176, 150, 120];

/// The bit of a picture with a section among those of [`overlay_bits`].
pub(crate) const SECTION_BIT: u32 = 1 << 20;

/// The bit of pictures that are compared, whose wireframe is drawn over their difference.
pub(crate) const COMPARED_BIT: u32 = 1 << 21;

/// sRGB colour of waste: triangles that are too small, and patches whose factors are too low. `WASTE_COLOR` in
/// `shaders/draw_overlays.wgsl` has the same in linear light. It is vermilion (Okabe and Ito 2008).
pub const WASTE_COLOR: [u8; 3] = [213, 94, 0];

/// sRGB colour of the place that is farthest from the reference surface. It isn't in the scale, and [`OUTLINE_COLOR`] sets it
/// off.
pub const WORST_COLOR: [u8; 3] = [120, 255, 245];

/// sRGB colour of a normal; `NORMAL_COLOR` in `shaders/draw_lines.wgsl` has the same in linear light.
pub const NORMAL_COLOR: [u8; 3] = [60, 215, 255];

/// sRGB colour of bones, which [`OUTLINE_COLOR`] sets off from any background.
pub const BONE_COLOR: [u8; 3] = [250, 228, 180];

/// sRGB colour of the frustum of the camera that LOD is computed for, where the picture is seen from another one.
pub const LOD_CAMERA_COLOR: [u8; 3] = [30, 205, 110];

/// Colours of the checker in linear light: its light squares, and by what these and the dark ones are multiplied where u, or v,
/// comes to the next whole number. `shaders/draw_looks.wgsl` has the same.
pub(crate) const CHECKER_LIGHT: f32 = 0.62;
pub(crate) const CHECKER_U: [f32; 3] = [1.15, 0.6, 0.55];
pub(crate) const CHECKER_V: [f32; 3] = [0.6, 1.1, 0.55];
/// sRGB colour of the lines around whole units of u and v; `CHECKER_LINE` in `shaders/draw_looks.wgsl` has the same in linear
/// light.
pub(crate) const CHECKER_LINE: [u8; 3] = [32, 64, 160];

/// The sides in px of the image that texel density is counted in where a material has none; the same in
/// `shaders/draw_looks.wgsl`.
pub(crate) const TEXELS_WITHOUT_IMAGE: f32 = 1024.0;

/// sRGB colours of the axes x, y and z.
pub const AXIS_COLORS: [[u8; 3]; 3] = [[232, 82, 92], [122, 184, 58], [84, 140, 240]];

/// sRGB colours of the sides of the selected edge, in turn, and of the outline that sets them off.
pub const SIDE_COLORS: [[u8; 3]; 2] = [[255, 255, 255], [0, 235, 255]];
pub const OUTLINE_COLOR: [u8; 3] = [15, 15, 18];

/// sRGB colours of the edges of a selected patch that factors 0, 1 and 2 cut: paler versions of the barycentric colours of u,
/// v and w.
pub const FACTOR_COLORS: [[u8; 3]; 3] = [[240, 90, 130], [120, 185, 40], [90, 125, 255]];

/// Converts sRGB bytes to linear light, from 0 to 1.
pub fn linear(srgb: [u8; 3]) -> [f32; 3] {
    srgb.map(|byte| {
        let x = f32::from(byte) / 255.0;
        if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
    })
}

/// The byte that sRGB encodes a linear colour's channel as.
pub fn srgb(linear: f32) -> u8 {
    let encoded = if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (encoded.clamp(0.0, 1.0) * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_decoded_and_encoded_without_loss() {
        for byte in 0..=255 {
            assert_eq!(srgb(linear([byte; 3])[0]), byte);
        }
    }
}
