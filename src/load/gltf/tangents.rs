//! Computes tangents where a normal map needs them and the file has none, by MikkTSpace (glTF 2.0 specification, section
//! 3.7.2.1). Source: Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited".

use std::collections::HashMap;

use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::{Vec2, Vec3};

use crate::mesh::weld::weld;
use crate::mesh::{Corner, CornerDetails, MapUv, Material, MemoryAccount, Mesh, Slot};
use crate::progress::{Cancelled, Progress};

/// Memory for each triangle, in bytes: the crate's lists, and the results.
const PER_TRIANGLE: u64 = 700;
/// Memory for each corner, in bytes, while triangles around points are counted.
const PER_CORNER: u64 = 48;
/// The most triangles around a point: the crate's depth of recursion.
const MAX_FAN: u64 = 4096;
/// The most pairs of triangles around a point, summed over all points, besides [`PAIRS_A_TRIANGLE`]: the crate looks at each.
const MAX_PAIRS: u64 = 1 << 24;
const PAIRS_A_TRIANGLE: u64 = 100;

/// A mesh that is being finished: its corners' details, and their bindings to joints.
pub(super) struct DetailedMesh<'a> {
    pub mesh: &'a mut Mesh,
    pub details: &'a mut CornerDetails,
    pub bindings: &'a mut Vec<u32>,
}

/// Gives tangents to the corners of normal-mapped triangles that have none. A corner that gets several becomes several corners,
/// which differ in nothing else. Returns a warning if there are none for some materials.
///
/// # Errors
/// [`Cancelled`].
pub(super) fn complete(
    mut detailed: DetailedMesh,
    budget: &dyn MemoryAccount,
    progress: &Progress,
) -> Result<Vec<String>, Cancelled> {
    let mut warnings = Vec::new();
    for material in detailed.mesh.materials.clone() {
        progress.check()?;
        let Some(normal_map) = &material.look.maps[Slot::Normal as usize] else { continue };
        let faces = detailed.faces_without(&material);
        if faces.is_empty() {
            continue;
        }
        let borrowed = budget.borrowed();
        let bytes = PER_TRIANGLE * faces.len() as u64 + PER_CORNER * detailed.mesh.corners.len() as u64;
        let afforded = budget.borrow(bytes).map_err(|refused| refused.to_string());
        match afforded.and_then(|()| detailed.check_fans(&faces)) {
            Ok(()) => detailed.add(&faces, normal_map.uv),
            Err(reason) => warnings.push(format!(
                "the normal map of material \"{}\" isn't drawn, since its mesh has no tangents, and computing them {reason}.",
                crate::load::uri::shown(&material.name)
            )),
        }
        budget.give_back_to(borrowed);
    }
    Ok(warnings)
}

impl DetailedMesh<'_> {
    /// Returns the triangles of a material of which some corner has no tangent.
    fn faces_without(&self, material: &Material) -> Vec<u32> {
        let has_none = |face: &u32| {
            let corners = self.mesh.triangles[*face as usize];
            corners.iter().any(|&corner| self.details[corner as usize].tangent == Vec3::ZERO)
        };
        material.triangles.clone().filter(has_none).collect()
    }

    /// # Errors
    /// A clause if there are too many triangles around a point.
    fn check_fans(&self, faces: &[u32]) -> Result<(), String> {
        let (points, point_of) = weld(self.mesh.corners.iter().map(|corner| corner.position));
        let mut counts = vec![0_u64; points.len()];
        for corner in faces.iter().flat_map(|&face| self.mesh.triangles[face as usize]) {
            counts[point_of[corner as usize] as usize] += 1;
        }
        let (most, pairs) = counts
            .iter()
            .fold((0, 0_u64), |(most, pairs), &count| (count.max(most), pairs.saturating_add(count * count)));
        if most > MAX_FAN || pairs > MAX_PAIRS + PAIRS_A_TRIANGLE * faces.len() as u64 {
            return Err(format!("takes too long, with up to {most} triangles around a point"));
        }
        Ok(())
    }

    /// Computes tangents on the texture coordinates of the normal map.
    fn add(&mut self, faces: &[u32], uv: MapUv) {
        let Self { mesh, details, bindings } = self;
        let uvs = |corner: usize| match uv {
            MapUv::Own => mesh.corners[corner].uv,
            MapUv::Set(set, [a, b, c, d, e, f]) => {
                let uv = details[corner].uvs[set];
                Vec2::new(a * uv.x + b * uv.y + c, d * uv.x + e * uv.y + f)
            }
        };
        let triangles = faces.iter().map(|&face| mesh.triangles[face as usize]).collect::<Vec<_>>();
        let corners = triangles.as_flattened().iter().map(|&corner| mesh.corners[corner as usize]);
        let corners =
            corners.zip(triangles.as_flattened()).map(|(corner, &i)| Corner { uv: uvs(i as usize), ..corner });
        let mut surface = Surface::new(corners.collect());
        // It has no errors to return.
        let _ = generate_tangents(&mut surface);
        let mut given = vec![false; mesh.corners.len()];
        let mut copies: HashMap<(u32, [u32; 4]), u32> = HashMap::new();
        let own_triangles = std::sync::Arc::make_mut(&mut mesh.triangles);
        for (slot, &corner) in triangles.as_flattened().iter().enumerate() {
            let (c, (tangent, sign)) = (corner as usize, surface.tangents[slot]);
            let is_known = details[c].tangent != Vec3::ZERO;
            if is_known && !given[c] || tangent == Vec3::ZERO {
                continue;
            }
            if !given[c] {
                (details[c].tangent, details[c].bitangent_sign, given[c]) = (tangent, sign, true);
            } else if (details[c].tangent, details[c].bitangent_sign) != (tangent, sign) {
                let key = (corner, tangent.extend(sign).to_array().map(f32::to_bits));
                let copy = *copies.entry(key).or_insert_with(|| {
                    mesh.corners.push(mesh.corners[c]);
                    bindings.push(bindings[c]);
                    details.push(crate::mesh::CornerDetail { tangent, bitangent_sign: sign, ..details[c] });
                    mesh.corners.len() as u32 - 1
                });
                own_triangles[faces[slot / 3] as usize][slot % 3] = copy;
            }
        }
    }
}

/// Triangles for MikkTSpace.
struct Surface {
    /// Three for each triangle.
    corners: Vec<Corner>,
    /// A factor that keeps squares of positions within f32.
    scale: f32,
    /// For each of them, its tangent and the sign of its bitangent; zero if there is none.
    tangents: Vec<(Vec3, f32)>,
}

impl Surface {
    fn new(corners: Vec<Corner>) -> Self {
        let largest = corners.iter().map(|corner| corner.position.abs().max_element()).fold(0.0, f32::max);
        // A power of two changes no digits.
        let scale = if largest > 0.0 { (-largest.log2().floor()).clamp(-100.0, 100.0).exp2() } else { 1.0 };
        let tangents = vec![(Vec3::ZERO, 1.0); corners.len()];
        Self { corners, scale, tangents }
    }
}

impl Geometry for Surface {
    fn num_faces(&self) -> usize {
        self.corners.len() / 3
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, vert: usize) -> [f32; 3] {
        (self.corners[3 * face + vert].position * self.scale).to_array()
    }

    fn normal(&self, face: usize, vert: usize) -> [f32; 3] {
        self.corners[3 * face + vert].normal.to_array()
    }

    fn tex_coord(&self, face: usize, vert: usize) -> [f32; 2] {
        self.corners[3 * face + vert].uv.to_array()
    }

    /// glTF's v points down, and a normal map's second component up: the bitangent is opposite to MikkTSpace's.
    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, vert: usize) {
        let Some([x, y, z, sign]) = space.map(|space| space.tangent_encoded()) else { return };
        if let Some(tangent) = Vec3::new(x, y, z).try_normalize() {
            self.tangents[3 * face + vert] = (tangent, -sign);
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn tangents(corners: Vec<Corner>) -> Vec<(Vec3, f32)> {
        let mut surface = Surface::new(corners);
        assert!(generate_tangents(&mut surface).is_ok());
        surface.tangents
    }

    #[test]
    fn large_and_small_triangles_have_the_same_tangents() {
        let places = [Vec2::ZERO, Vec2::X, Vec2::Y];
        let of = |size: f32| {
            places.map(|uv| Corner { position: size * Vec3::new(uv.x, uv.x + uv.y, 0.0), normal: Vec3::Z, uv }).to_vec()
        };
        let usual = tangents(of(1.0));
        assert!(
            usual.iter().all(|(tangent, sign)| {
                tangent.distance(Vec3::new(1.0, 1.0, 0.0).normalize()) < 1e-6 && *sign == -1.0
            })
        );
        for size in [1e-30, 1e-9, 1e9, 1e36] {
            for ((tangent, sign), (other, other_sign)) in tangents(of(size)).into_iter().zip(&usual) {
                assert!(tangent.distance(*other) < 1e-6 && sign == *other_sign, "{size}: {tangent}");
            }
        }
    }

    /// Numbers of few values, so that corners meet and triangles are degenerate, and some that are extreme.
    fn number() -> impl Strategy<Value = f32> {
        prop_oneof![8 => (-2..3).prop_map(|i| i as f32), 1 => prop_oneof![Just(1e37), Just(-1e37), Just(1e-37), Just(1e18)]]
    }

    fn corner() -> impl Strategy<Value = Corner> {
        let normals = prop_oneof![Just(Vec3::X), Just(Vec3::NEG_X), Just(Vec3::Z)];
        (number(), number(), number(), normals, number(), number()).prop_map(|(x, y, z, normal, u, v)| Corner {
            position: Vec3::new(x, y, z),
            normal,
            uv: Vec2::new(u, v),
        })
    }

    proptest! {
        #[test]
        fn whatever_the_triangles_tangents_are_unit_vectors_or_unknown(
            palette in prop::collection::vec(corner(), 1..12),
            picks in prop::collection::vec(any::<prop::sample::Index>(), 3..120),
        ) {
            let whole = picks.len() / 3 * 3;
            let corners: Vec<Corner> = picks[..whole].iter().map(|pick| *pick.get(&palette)).collect();
            for (tangent, sign) in tangents(corners) {
                prop_assert!(tangent == Vec3::ZERO || (tangent.length() - 1.0).abs() < 1e-5, "{tangent}");
                prop_assert!(sign.abs() == 1.0);
            }
        }
    }
}
