//! Normals for corners that came without: each triangle gives its own, so that a corner may become several.

use glam::Vec3;

use super::Corner;
use super::build_limits::BuildError;
use super::chunked_vec::ChunkedVec;
use super::normals::{Face, fan_normals};
use super::weld::{plus_zero3, weld};
use crate::mesh::build_limits::MemoryAccount;
use crate::progress::Progress;

/// What a face of the largest fan takes meanwhile, in bytes.
const PER_FACE: u64 = 160;

/// A mesh in the making. A corner without a normal has NaN in its place.
#[derive(Default)]
pub struct Loose {
    pub corners: Vec<Corner>,
    /// What corners are bound to; none at all if all are 0.
    pub bindings: Vec<u32>,
    pub triangles: Vec<[u32; 3]>,
}

/// Gives a normal to every corner without one, by the faces around its point; points are welded by exact position. Corners that
/// nothing uses any more may be left. Linear in triangles, but for a logarithm of the largest fan's faces where those differ.
///
/// # Errors
/// [`BuildError`].
pub fn generate_normals(loose: &mut Loose, budget: &dyn MemoryAccount, progress: &Progress) -> Result<(), BuildError> {
    let borrowed = budget.borrowed();
    let points = Points::of(loose, budget)?;
    let mut around = Around::new(loose, &points, budget)?;
    let mut added = Added { made: ChunkedVec::default(), first: loose.corners.len() as u32, budget };
    let mut fan = Fan::default();
    for point in 0..around.ends.len() {
        if point % 4096 == 0 {
            progress.check()?;
        }
        fan.fill(loose, around.of(point));
        fan.number(loose, &mut added)?;
        around.of(point).copy_from_slice(&fan.ids);
    }
    around.hand_out(loose, &points);
    drop((around, points));
    added.append_to(loose)?;
    budget.give_back_to(borrowed);
    Ok(())
}

/// The point of each corner.
enum Points {
    /// Every corner is a point of its own.
    Corners,
    Welded(Vec<u32>, usize),
}

impl Points {
    fn of(loose: &Loose, budget: &dyn MemoryAccount) -> Result<Self, BuildError> {
        // Corners that have nothing but a position differ in it.
        let plain = |corner: &Corner| corner.normal.x.is_nan() && corner.uv == glam::Vec2::ZERO;
        if loose.bindings.is_empty() && loose.corners.iter().all(plain) {
            return Ok(Self::Corners);
        }
        budget.borrow(loose.corners.len() as u64 * 40)?;
        let (points, point_of) = weld(loose.corners.iter().map(|corner| corner.position));
        Ok(Self::Welded(point_of, points.len()))
    }

    fn at(&self, corner: u32) -> usize {
        match self {
            Self::Corners => corner as usize,
            Self::Welded(point_of, _) => point_of[corner as usize] as usize,
        }
    }
}

/// The corners of triangles (3 * triangle + k) by their points, then by number.
struct Around {
    /// Those of point p end before `ends[p]`, and begin where those of the point before end.
    ends: Vec<u32>,
    list: Vec<u32>,
}

impl Around {
    fn new(loose: &Loose, points: &Points, budget: &dyn MemoryAccount) -> Result<Self, BuildError> {
        let count = match points {
            Points::Corners => loose.corners.len(),
            Points::Welded(_, count) => *count,
        };
        let corners = loose.triangles.as_flattened();
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

    /// Gives triangles the corners that the list has in place of their numbers by now.
    fn hand_out(&mut self, loose: &mut Loose, points: &Points) {
        for corner in loose.triangles.as_flattened_mut().iter_mut().rev() {
            // Backwards, so that each point's end is where its next one is.
            let end = &mut self.ends[points.at(*corner)];
            *end -= 1;
            *corner = self.list[*end as usize];
        }
    }
}

/// Corners beyond those that there are: which one each is like, and its normal.
struct Added<'a> {
    made: ChunkedVec<(u32, Vec3)>,
    /// The number of the first.
    first: u32,
    budget: &'a dyn MemoryAccount,
}

impl Added<'_> {
    fn add(&mut self, like: u32, normal: Vec3) -> Result<u32, BuildError> {
        let id = self.first + self.made.len() as u32;
        self.budget.borrow(self.made.next_bytes())?;
        self.made.push((like, normal));
        Ok(id)
    }

    fn append_to(self, loose: &mut Loose) -> Result<(), BuildError> {
        let (count, capacity, more) = (loose.corners.len(), loose.corners.capacity(), self.made.len());
        if capacity - count < more {
            let [old, new] = [capacity, count + more].map(|corners| corners as u64 * 32);
            self.budget.exchange(old, new)?;
            loose.corners.reserve_exact(more);
        }
        if !loose.bindings.is_empty() {
            loose.bindings.reserve_exact(more);
        }
        for (like, normal) in self.made {
            loose.corners.push(Corner { normal, ..loose.corners[like as usize] });
            if let Some(&binding) = loose.bindings.get(like as usize) {
                loose.bindings.push(binding);
            }
        }
        Ok(())
    }
}

/// What lies around one point.
#[derive(Default)]
struct Fan {
    faces: Vec<Face>,
    normals: Vec<Vec3>,
    /// The corners that the faces have there.
    ids: Vec<u32>,
    /// Places among these, ordered by what the corners become.
    order: Vec<u32>,
}

impl Fan {
    /// The faces of these corners of triangles, and the normals that they get: given ones stay.
    fn fill(&mut self, loose: &Loose, corners: &[u32]) {
        self.faces.clear();
        self.ids.clear();
        for &corner in corners {
            let (triangle, k) = (loose.triangles[corner as usize / 3], corner as usize % 3);
            self.faces.push(Face::new(triangle.map(|id| loose.corners[id as usize].position), k));
            self.ids.push(triangle[k]);
        }
        fan_normals(&self.faces, &mut self.normals);
        for (normal, &id) in self.normals.iter_mut().zip(&self.ids) {
            let given = loose.corners[id as usize].normal;
            *normal = if given.x.is_nan() { plus_zero3(*normal) } else { given };
        }
    }

    /// Finds a corner for each of its normals: one that has it, or has none yet, or a new one.
    fn number(&mut self, loose: &mut Loose, added: &mut Added) -> Result<(), BuildError> {
        let Self { normals, ids, order, .. } = self;
        let key = |i: u32, ids: &[u32], loose: &Loose| {
            let (id, normal) = (ids[i as usize], normals[i as usize]);
            let uv = loose.corners[id as usize].uv.to_array().map(f32::to_bits);
            (uv, loose.bindings.get(id as usize).copied(), normal.to_array().map(f32::to_bits))
        };
        order.clear();
        order.extend(0..ids.len() as u32);
        let first = |i: &u32| ids[*i as usize] == ids[0] && normals[*i as usize] == normals[0];
        if !order.iter().all(first) {
            order.sort_unstable_by_key(|&i| (key(i, ids, loose), i));
        }
        let mut start = 0;
        while start < order.len() {
            let own = key(order[start], ids, loose);
            let length = order[start..].iter().take_while(|&&i| key(i, ids, loose) == own).count();
            let alike = &order[start..start + length];
            let (like, normal) = (ids[alike[0] as usize], normals[alike[0] as usize]);
            let normal_of = |i: &&u32| loose.corners[ids[**i as usize] as usize].normal;
            let found = alike.iter().find(|i| normal_of(i) == normal);
            let found = found.or_else(|| alike.iter().find(|i| normal_of(i).x.is_nan())).map(|&i| ids[i as usize]);
            let id = match found {
                Some(id) => {
                    loose.corners[id as usize].normal = normal;
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
