//! Computes normals for corners without one. A corner may get different normals from different triangles, and is then
//! split.

use glam::Vec3;

use super::Corner;
use super::build_limits::BuildError;
use super::chunked_vec::ChunkedVec;
use super::normals::{Face, fan_normals};
use super::weld::{plus_zero3, weld};
use crate::mesh::build_limits::MemoryAccount;
use crate::progress::Progress;

/// Memory for each face of the largest fan, in bytes.
const PER_FACE: u64 = 160;

/// A mesh that is being built. Missing normals are NaN.
#[derive(Default)]
pub(crate) struct UnfinishedMesh {
    pub corners: Vec<Corner>,
    /// The binding of each corner; empty if all are 0.
    pub bindings: Vec<u32>,
    pub triangles: Vec<[u32; 3]>,
}

/// Gives every corner without a normal one, computed from the faces around its point with a crease angle in degrees. Corners with exactly equal
/// positions lie on one point. Some corners may be left without a use. Takes time linear in the number of triangles,
/// times the logarithm of the largest fan's faces where those give different normals.
///
/// # Errors
/// [`BuildError`].
pub(crate) fn generate_normals(
    mesh: &mut UnfinishedMesh,
    crease_angle: f32,
    budget: &dyn MemoryAccount,
    progress: &Progress,
) -> Result<(), BuildError> {
    let borrowed = budget.borrowed();
    let points = CornerPoints::of(mesh, budget)?;
    let mut around = CornersByPoint::new(mesh, &points, budget)?;
    let mut added = AddedCorners { made: ChunkedVec::default(), first: mesh.corners.len() as u32, budget };
    let mut fan = Fan::default();
    for point in 0..around.ends.len() {
        if point % 4096 == 0 {
            progress.check()?;
        }
        fan.fill(mesh, around.of(point), crease_angle);
        fan.number(mesh, &mut added)?;
        around.of(point).copy_from_slice(&fan.ids);
    }
    around.hand_out(mesh, &points);
    drop((around, points));
    added.append_to(mesh)?;
    budget.give_back_to(borrowed);
    Ok(())
}

/// The point of each corner.
enum CornerPoints {
    /// Every corner has a point of its own.
    Corners,
    /// The point of each corner, and the number of points.
    Welded(Vec<u32>, usize),
}

impl CornerPoints {
    fn of(mesh: &UnfinishedMesh, budget: &dyn MemoryAccount) -> Result<Self, BuildError> {
        // Corners that are nothing but positions differ in their positions.
        let plain = |corner: &Corner| corner.normal.x.is_nan() && corner.uv == glam::Vec2::ZERO;
        if mesh.bindings.is_empty() && mesh.corners.iter().all(plain) {
            return Ok(Self::Corners);
        }
        budget.borrow(mesh.corners.len() as u64 * 40)?;
        let (points, point_of) = weld(mesh.corners.iter().map(|corner| corner.position));
        Ok(Self::Welded(point_of, points.len()))
    }

    fn at(&self, corner: u32) -> usize {
        match self {
            Self::Corners => corner as usize,
            Self::Welded(point_of, _) => point_of[corner as usize] as usize,
        }
    }
}

/// The corners of triangles (3 * triangle + k), sorted by point, then by number.
struct CornersByPoint {
    /// Where the corners of each point end in `list`; they start where those of the point before end.
    ends: Vec<u32>,
    list: Vec<u32>,
}

impl CornersByPoint {
    fn new(mesh: &UnfinishedMesh, points: &CornerPoints, budget: &dyn MemoryAccount) -> Result<Self, BuildError> {
        let count = match points {
            CornerPoints::Corners => mesh.corners.len(),
            CornerPoints::Welded(_, count) => *count,
        };
        let corners = mesh.triangles.as_flattened();
        let bytes = 4 * (count as u64 + corners.len() as u64);
        budget.borrow(bytes)?;
        let mut ends = vec![0_u32; count];
        corners.iter().for_each(|&corner| ends[points.at(corner)] += 1);
        let largest = ends.iter().copied().max().unwrap_or_default();
        budget.borrow(PER_FACE * u64::from(largest))?;
        let mut start = 0;
        for end in &mut ends {
            start += std::mem::replace(end, start);
        }
        let mut list = vec![0; corners.len()];
        for (i, &corner) in (0..).zip(corners) {
            let end = &mut ends[points.at(corner)];
            list[*end as usize] = i;
            *end += 1;
        }
        Ok(Self { ends, list })
    }

    fn of(&mut self, point: usize) -> &mut [u32] {
        let start = if point == 0 { 0 } else { self.ends[point - 1] };
        &mut self.list[start as usize..self.ends[point] as usize]
    }

    /// Replaces the corners of triangles by those that the list now has in the places of their numbers.
    fn hand_out(&mut self, mesh: &mut UnfinishedMesh, points: &CornerPoints) {
        for corner in mesh.triangles.as_flattened_mut().iter_mut().rev() {
            // Goes backwards, so that the end of each point's part is where its next corner is.
            let end = &mut self.ends[points.at(*corner)];
            *end -= 1;
            *corner = self.list[*end as usize];
        }
    }
}

/// Corners that are added: the number of the corner that each is a copy of, and its normal.
struct AddedCorners<'a> {
    made: ChunkedVec<(u32, Vec3)>,
    /// The number of the first added corner.
    first: u32,
    budget: &'a dyn MemoryAccount,
}

impl AddedCorners<'_> {
    fn add(&mut self, like: u32, normal: Vec3) -> Result<u32, BuildError> {
        let id = self.first + self.made.len() as u32;
        self.budget.borrow(self.made.next_bytes())?;
        self.made.push((like, normal));
        Ok(id)
    }

    fn append_to(self, mesh: &mut UnfinishedMesh) -> Result<(), BuildError> {
        let (count, capacity, more) = (mesh.corners.len(), mesh.corners.capacity(), self.made.len());
        if capacity - count < more {
            let [old, new] = [capacity, count + more].map(|corners| corners as u64 * 32);
            self.budget.exchange(old, new)?;
            mesh.corners.reserve_exact(more);
        }
        if !mesh.bindings.is_empty() {
            mesh.bindings.reserve_exact(more);
        }
        for (like, normal) in self.made {
            mesh.corners.push(Corner { normal, ..mesh.corners[like as usize] });
            if let Some(&binding) = mesh.bindings.get(like as usize) {
                mesh.bindings.push(binding);
            }
        }
        Ok(())
    }
}

/// The faces around one point.
#[derive(Default)]
struct Fan {
    faces: Vec<Face>,
    normals: Vec<Vec3>,
    /// For each face, its corner on the point.
    ids: Vec<u32>,
    /// Indices of faces, sorted by the corner that they will use.
    order: Vec<u32>,
}

impl Fan {
    /// Collects the faces of some corners of triangles (3 * triangle + k), and the normal that each gets. A corner with
    /// a normal keeps it.
    fn fill(&mut self, mesh: &UnfinishedMesh, corners: &[u32], crease_angle: f32) {
        self.faces.clear();
        self.ids.clear();
        for &corner in corners {
            let (triangle, k) = (mesh.triangles[corner as usize / 3], corner as usize % 3);
            self.faces.push(Face::new(triangle.map(|id| mesh.corners[id as usize].position), k));
            self.ids.push(triangle[k]);
        }
        fan_normals(&self.faces, crease_angle, &mut self.normals);
        for (normal, &id) in self.normals.iter_mut().zip(&self.ids) {
            let given = mesh.corners[id as usize].normal;
            *normal = if given.x.is_nan() { plus_zero3(*normal) } else { given };
        }
    }

    /// Chooses a corner for each face's normal: one with that normal, one without a normal, or a new one.
    fn number(&mut self, mesh: &mut UnfinishedMesh, added: &mut AddedCorners) -> Result<(), BuildError> {
        let Self { normals, ids, order, .. } = self;
        let key = |i: u32, ids: &[u32], mesh: &UnfinishedMesh| {
            let (id, normal) = (ids[i as usize], normals[i as usize]);
            let uv = mesh.corners[id as usize].uv.to_array().map(f32::to_bits);
            (uv, mesh.bindings.get(id as usize).copied(), normal.to_array().map(f32::to_bits))
        };
        order.clear();
        order.extend(0..ids.len() as u32);
        let first = |i: &u32| ids[*i as usize] == ids[0] && normals[*i as usize] == normals[0];
        if !order.iter().all(first) {
            order.sort_unstable_by_key(|&i| (key(i, ids, mesh), i));
        }
        let mut start = 0;
        while start < order.len() {
            let own = key(order[start], ids, mesh);
            let length = order[start..].iter().take_while(|&&i| key(i, ids, mesh) == own).count();
            let alike = &order[start..start + length];
            let (like, normal) = (ids[alike[0] as usize], normals[alike[0] as usize]);
            let normal_of = |i: &&u32| mesh.corners[ids[**i as usize] as usize].normal;
            let found = alike.iter().find(|i| normal_of(i) == normal);
            let found = found.or_else(|| alike.iter().find(|i| normal_of(i).x.is_nan())).map(|&i| ids[i as usize]);
            let id = match found {
                Some(id) => {
                    mesh.corners[id as usize].normal = normal;
                    id
                }
                None => added.add(like, normal)?,
            };
            alike.iter().for_each(|&i| ids[i as usize] = id);
            start += length;
        }
        Ok(())
    }
}
