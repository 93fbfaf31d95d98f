//! Computes tangents where a normal map needs them and the file has none, by MikkTSpace (glTF 2.0 specification, section
//! 3.7.2.1). Source: Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited".

use std::collections::HashMap;
use std::sync::Arc;

use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::Vec3;

use super::map_uvs::MapUvs;
use super::notes::Notes;
use geometry::casts::to_u32;
use geometry::mesh::build_limits::BuildError;
use geometry::mesh::detail_table::DetailTable;
use geometry::mesh::weld::weld;
use geometry::mesh::{Borrowed, Budget, Corner, CornerDetail, CornerDetails, MapUv, Material, Mesh};
use geometry::progress::{Cancelled, Progress};

/// How many triangles get their tangents together. The tangents of a corner depend on the triangles around it alone, so that a
/// large mesh needn't be in the crate's lists at once.
const BATCH: usize = 1 << 16;
/// Memory for each triangle of a batch or around it, in bytes: the crate's lists, and the results.
const PER_TRIANGLE: u64 = 1000;
/// Memory for each corner, in bytes: its point, while points are found, and marks.
const PER_CORNER: u64 = 56;
/// The most triangles around a point: the crate's depth of recursion.
const MAX_FAN: u64 = 4096;
/// The most pairs of triangles around a point, summed over all points, besides [`PAIRS_A_TRIANGLE`]: the crate looks at each.
const MAX_PAIRS: u64 = 1 << 24;
const PAIRS_A_TRIANGLE: u64 = 100;

/// Gives a mesh the details of its corners, whose numbers in the table these are, with tangents. Returns their bindings to joints;
/// `notes` gets a warning for each material that gets no tangents.
///
/// # Errors
/// [`BuildError::Memory`] and [`BuildError::Cancelled`].
pub(super) fn with_details(
    mesh: &mut Mesh,
    table: DetailTable,
    numbers: &[u32],
    notes: &mut Notes,
    budget: &Budget,
    progress: &Progress,
) -> Result<Vec<u32>, BuildError> {
    let (mut details, mut bindings) = table.into_lists(numbers, budget)?;
    let detailed = DetailedMesh { mesh, details: &mut details, bindings: &mut bindings };
    notes.extend(complete(BATCH, detailed, budget, progress)?);
    mesh.details = Some(Arc::new(details));
    Ok(bindings)
}

/// A mesh that is being finished: its corners' details, and their bindings to joints.
struct DetailedMesh<'a> {
    mesh: &'a mut Mesh,
    details: &'a mut CornerDetails,
    bindings: &'a mut Vec<u32>,
}

/// Gives tangents to the corners of normal-mapped triangles that have none, so many triangles at a time. A corner that gets several becomes
/// several corners, which differ in nothing else. Returns a warning for each material that gets none.
fn complete(
    batch: usize,
    mut detailed: DetailedMesh,
    budget: &Budget,
    progress: &Progress,
) -> Result<Vec<String>, Cancelled> {
    let mapped = detailed.mesh.materials.iter().filter_map(|material| detailed.mapped(material)).collect::<Vec<_>>();
    if mapped.is_empty() {
        return Ok(Vec::new());
    }
    let _scope = Borrowed::from(budget);
    let mut warnings = Vec::new();
    let mut warn = |name: &str, reason: String| {
        let name = crate::uri::shown(name);
        let why = "since its mesh has no tangents, and computing them";
        warnings.push(format!("the normal map of material \"{name}\" isn't drawn, {why} {reason}."));
    };
    if let Err(refused) = budget.borrow(PER_CORNER * detailed.mesh.corners.len() as u64) {
        mapped.iter().for_each(|mapped| warn(&mapped.name, refused.to_string()));
        return Ok(warnings);
    }
    let mut around = Around::new(detailed.mesh);
    for Mapped { name, faces, uv } in &mapped {
        if let Err(reason) = around.check_fans(detailed.mesh, faces) {
            warn(name, reason);
            continue;
        }
        for batch in faces.chunks(batch) {
            progress.check()?;
            let _scope = Borrowed::from(budget);
            let near = around.near(detailed.mesh, faces, batch);
            if let Err(refused) = budget.borrow(PER_TRIANGLE * near.len() as u64) {
                warn(name, refused.to_string());
                break;
            }
            detailed.add(&near, *uv, &mut around);
        }
    }
    Ok(warnings)
}

/// What a material needs tangents for.
struct Mapped {
    name: String,
    /// Its triangles of which some corner has no tangent.
    faces: Vec<u32>,
    uv: MapUv,
}

/// What is known of corners.
struct Around {
    /// The point of each corner.
    point_of: Vec<u32>,
    /// For each point, whether a triangle of the batch touches it.
    touched: Vec<bool>,
    /// For each corner that the mesh had, whether it got its tangent here.
    given: Vec<bool>,
    /// By a corner and the bits of another tangent, the corner that has this one.
    copies: HashMap<(u32, [u32; 4]), u32>,
}

impl Around {
    fn new(mesh: &Mesh) -> Self {
        let (points, point_of) = weld(mesh.corners.len(), |corner| mesh.corners[corner].position);
        let (touched, given) = (vec![false; points.len()], vec![false; point_of.len()]);
        Self { point_of, touched, given, copies: HashMap::new() }
    }

    /// Returns the points of a triangle.
    fn points(&self, mesh: &Mesh, face: u32) -> [usize; 3] {
        mesh.triangles[face as usize].map(|corner| self.point_of[corner as usize] as usize)
    }

    /// # Errors
    /// A clause if there are too many triangles around a point.
    fn check_fans(&self, mesh: &Mesh, faces: &[u32]) -> Result<(), String> {
        let mut counts = vec![0_u64; self.touched.len()];
        for point in faces.iter().flat_map(|&face| self.points(mesh, face)) {
            counts[point] += 1;
        }
        let (most, pairs) = counts
            .iter()
            .fold((0, 0_u64), |(most, pairs), &count| (count.max(most), pairs.saturating_add(count * count)));
        if most > MAX_FAN || pairs > MAX_PAIRS + PAIRS_A_TRIANGLE * faces.len() as u64 {
            return Err(format!("takes too long, with up to {most} triangles around a point"));
        }
        Ok(())
    }

    /// Returns the triangles of a batch, and those that share a point with one of them. Says of each whether it is in the batch.
    fn near(&mut self, mesh: &Mesh, faces: &[u32], batch: &[u32]) -> Vec<(u32, bool)> {
        if faces.len() == batch.len() {
            return batch.iter().map(|&face| (face, true)).collect();
        }
        self.touched.fill(false);
        for &face in batch {
            self.points(mesh, face).into_iter().for_each(|point| self.touched[point] = true);
        }
        let mut near = Vec::with_capacity(2 * batch.len());
        for &face in faces {
            if self.points(mesh, face).iter().any(|&point| self.touched[point]) {
                // The triangles of a material are in order.
                near.push((face, batch.binary_search(&face).is_ok()));
            }
        }
        near
    }
}

impl DetailedMesh<'_> {
    fn mapped(&self, material: &Material) -> Option<Mapped> {
        let uv = material.look.tangent_uv()?;
        let has_none = |face: &u32| {
            let corners = self.mesh.triangles[*face as usize];
            corners.iter().any(|&corner| self.details[corner as usize].tangent == Vec3::ZERO)
        };
        let faces: Vec<u32> = material.triangles.clone().filter(has_none).collect();
        (!faces.is_empty()).then(|| Mapped { name: material.name.clone(), faces, uv })
    }

    /// Computes tangents for the triangles of a batch on the texture coordinates of the normal map, from them and those near them.
    fn add(&mut self, near: &[(u32, bool)], uv: MapUv, around: &mut Around) {
        let Self { mesh, details, bindings } = self;
        let uvs = |corner: usize| match uv {
            MapUv::Own => mesh.corners[corner].uv,
            MapUv::Set(set, transform) => MapUvs { set, transform }.apply(details[corner].uvs[set]),
        };
        let corner = |corner: u32| Corner { uv: uvs(corner as usize), ..mesh.corners[corner as usize] };
        let mut surface =
            Surface::new(near.iter().flat_map(|near| mesh.triangles[near.0 as usize]).map(corner).collect());
        // It has no errors to return.
        let _ = generate_tangents(&mut surface);
        let triangles = Arc::make_mut(&mut mesh.triangles);
        let own = near.iter().zip(surface.tangents.as_chunks::<3>().0).filter(|(near, _)| near.1);
        for (&(face, _), tangents) in own {
            for (corner, &(tangent, sign)) in triangles[face as usize].iter_mut().zip(tangents) {
                let c = *corner as usize;
                let own = details[c];
                if tangent == Vec3::ZERO || own.tangent != Vec3::ZERO && !around.given[c] {
                    continue;
                }
                if !around.given[c] {
                    (details[c].tangent, details[c].bitangent_sign, around.given[c]) = (tangent, sign, true);
                } else if (own.tangent, own.bitangent_sign) != (tangent, sign) {
                    let key = (*corner, tangent.extend(sign).to_array().map(f32::to_bits));
                    *corner = *around.copies.entry(key).or_insert_with(|| {
                        mesh.corners.push(mesh.corners[c]);
                        bindings.push(bindings[c]);
                        details.push(CornerDetail { tangent, bitangent_sign: sign, ..own });
                        around.point_of.push(around.point_of[c]);
                        to_u32(mesh.corners.len()) - 1
                    });
                }
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
    use glam::Vec2;
    use proptest::prelude::*;

    use super::*;
    use geometry::mesh::{Budget, Map, Sampling, Shape, Slot, Texture};

    fn tangents(corners: Vec<Corner>) -> Vec<(Vec3, f32)> {
        let mut surface = Surface::new(corners);
        assert!(generate_tangents(&mut surface).is_ok());
        surface.tangents
    }

    /// Tangents don't depend on how many triangles are looked at together.
    #[test]
    fn batches_have_the_tangents_of_the_whole() {
        let mut torus = Shape::Torus.build();
        let texture = Arc::new(Texture { size: [1, 1], rgba: vec![255; 4] });
        let map = Map { texture, uv: MapUv::Own, sampling: Sampling::default() };
        torus.materials[0].look.maps[Slot::Normal as usize] = Some(map);
        let of = |batch: usize| {
            let (mut mesh, count) = (torus.clone(), torus.corners.len());
            let (mut details, mut bindings) = (vec![CornerDetail::default(); count], vec![0; count]);
            let detailed = DetailedMesh { mesh: &mut mesh, details: &mut details, bindings: &mut bindings };
            let warnings = complete(batch, detailed, &Budget::unlimited(), &Progress::new()).expect("nobody cancels");
            assert!(warnings.is_empty(), "{warnings:?}");
            let all = mesh.triangles.as_flattened().iter().map(|&corner| details[corner as usize]).collect::<Vec<_>>();
            assert!(all.iter().all(|detail| (detail.tangent.length() - 1.0).abs() < 1e-5));
            all
        };
        let whole = of(1 << 16);
        for batch in [1, 7, 100] {
            for (own, other) in of(batch).iter().zip(&whole) {
                assert!(own.tangent.distance(other.tangent) < 1e-5, "{batch}: {own:?} {other:?}");
                assert_eq!(own.bitangent_sign, other.bitangent_sign);
            }
        }
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
