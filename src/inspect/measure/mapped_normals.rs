//! The normals that normal maps make of shading normals, on a side of an edge: what is drawn, without mip levels.
//!
//! Source: glTF 2.0 specification, section 3.9.3. `mapped_normal` in `shaders/draw_material.wgsl` does the same.

use glam::{Vec2, Vec3, Vec4, vec2};

use geometry::mesh::{CornerDetail, Map, MapUv, Mesh, Slot, Topology, Wrap};
use geometry::tessellate::edge_uv;

/// Shorter tangents, squared, say nothing about a direction; the same in `shaders/draw_material.wgsl`.
const LEAST_TANGENT: f32 = 1e-12;

/// The whole length of an edge in the fixed point of its weights.
const WHOLE: f32 = 65536.0;

/// The normal map along a side of an edge.
pub(super) struct MappedSide<'a> {
    map: &'a Map,
    /// Factor of the map's first two components.
    scale: f32,
    /// At the edge's start and at its end.
    uvs: [Vec2; 2],
    details: [CornerDetail; 2],
}

impl<'a> MappedSide<'a> {
    /// The normal map of a side, an index in [`Topology::sides`]; none if its material has none, or if tangents aren't known.
    pub(super) fn new(mesh: &'a Mesh, topology: &Topology, side: u32) -> Option<Self> {
        let details = mesh.details.as_ref()?;
        let side = &topology.sides[side as usize];
        let look = &mesh.materials[topology.material_of(side.patch())].look;
        let map = look.maps[Slot::Normal as usize].as_ref()?;
        let corners = topology.side_corners(side).map(|corner| corner as usize);
        let details = corners.map(|corner| details[corner]);
        let uvs = match map.uv {
            MapUv::Own => corners.map(|corner| mesh.corners[corner].uv),
            MapUv::Set(set, [a, b, c, d, e, f]) => details.each_ref().map(|detail| {
                let uv = detail.uvs[set];
                vec2(a * uv.x + b * uv.y + c, d * uv.x + e * uv.y + f)
            }),
        };
        Some(Self { map, scale: look.normal_scale, uvs, details })
    }

    /// Returns what the map makes of a unit shading normal at `t` (16.16 fixed point) along the edge.
    pub(super) fn normal(&self, shading: Vec3, t: u32) -> Vec3 {
        let [start, end] = &self.details;
        let end_weight = t as f32 / WHOLE;
        let tangent = start.tangent.lerp(end.tangent, end_weight);
        let along = tangent - shading * tangent.dot(shading);
        if along.length_squared() < LEAST_TANGENT {
            return shading;
        }
        let texel = sample(self.map, edge_uv(self.uvs[0], self.uvs[1], t));
        let [x, y, z] = (texel.truncate() * 2.0 - 1.0).to_array();
        let tangent = along.normalize();
        let bitangent = start.bitangent_sign * shading.cross(tangent);
        let mapped = tangent * (x * self.scale) + bitangent * (y * self.scale) + shading * z;
        mapped.try_normalize().unwrap_or(shading)
    }
}

/// Returns the texel at a place of the map, 0 to 1, bilinear if the map is magnified so.
fn sample(map: &Map, uv: Vec2) -> Vec4 {
    let [width, height] = map.texture.size;
    let at = uv * vec2(width as f32, height as f32);
    let texel = |x: f32, y: f32| {
        let [x, y] = [wrapped(x, width, map.sampling.wrap[0]), wrapped(y, height, map.sampling.wrap[1])];
        let first = 4 * (y as usize * width as usize + x as usize);
        Vec4::from_array(std::array::from_fn(|i| f32::from(map.texture.rgba[first + i]) / 255.0))
    };
    if !map.sampling.magnify_linear {
        let Vec2 { x, y } = at.floor();
        return texel(x, y);
    }
    let corner = (at - 0.5).floor();
    let Vec2 { x: right, y: below } = at - 0.5 - corner;
    let row = |y| texel(corner.x, y).lerp(texel(corner.x + 1.0, y), right);
    row(corner.y).lerp(row(corner.y + 1.0), below)
}

/// Returns the texel that is shown at a whole place along one axis of an image.
fn wrapped(place: f32, size: u32, wrap: Wrap) -> u32 {
    let (place, size) = (place as i64, i64::from(size));
    let inside = match wrap {
        Wrap::Repeat => place.rem_euclid(size),
        Wrap::Clamp => place.clamp(0, size - 1),
        Wrap::Mirror => {
            let twice = place.rem_euclid(2 * size);
            twice.min(2 * size - 1 - twice)
        }
    };
    inside as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_go_on_beyond_their_borders() {
        let along = |wrap| [-5.0, -1.0, 0.0, 3.0, 4.0, 8.0].map(|place| wrapped(place, 4, wrap));
        assert_eq!(along(Wrap::Repeat), [3, 3, 0, 3, 0, 0]);
        assert_eq!(along(Wrap::Clamp), [0, 0, 0, 3, 3, 3]);
        assert_eq!(along(Wrap::Mirror), [3, 0, 0, 3, 3, 0]);
    }
}
