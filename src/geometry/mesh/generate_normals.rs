//! Computes normals for corners without one. A corner may get different normals from different triangles, and is then
//! split.

use std::ops::Range;

use glam::Vec3;

use super::build_limits::{Borrowed, Budget, BuildError, borrowing};
use super::chunked_vec::ChunkedVec;
use super::normals::{Face, fan_normals};
use super::smooth_points::give_normals;
use super::unfinished_mesh::{CornerPoints, UnfinishedMesh};
use super::weld::plus_zero3;
use super::{Corner, Mesh};
use crate::casts::to_u32;
use crate::cores::in_ranges;
use crate::progress::Progress;

/// Memory for each face of the largest fan, in bytes.
const PER_FACE: u64 = 160;

/// How many corners of triangles a block of fans has at most, unless it is a single fan. The normals of a block are
/// computed on all cores.
const BLOCK: usize = 1 << 15;

/// Memory for each corner of a block, in bytes: its normal, and what the threads use.
const PER_BLOCK_CORNER: u64 = 20;

/// The least number of fans that are worth a thread.
const LEAST: usize = 1 << 9;

/// The greatest number of faces of a fan whose block is divided among threads: larger fans take more memory, which is
/// counted for one of them.
const SMALL_FAN: usize = 256;

/// The crease angles of triangles, in degrees.
pub(crate) struct CreaseAngles<'a> {
    all: f32,
    least: f32,
    /// The mesh, if parts or materials of it have angles of their own.
    styled: Option<&'a Mesh>,
}

impl<'a> CreaseAngles<'a> {
    /// That of all, and those of a mesh's parts and materials. It needn't have its triangles yet.
    pub(crate) fn new(all: f32, mesh: &'a Mesh) -> Self {
        let own = || mesh.styles().filter_map(|own| own.crease_angle);
        Self { all, least: own().fold(all, f32::min), styled: own().next().map(|_| mesh) }
    }
}

/// Gives every corner without a normal one, computed from the faces around its point, whatever their parts, that are within the
/// crease angle of its own triangle. Corners with exactly equal positions lie on one point. Some corners may be left without a use.
/// Takes time linear in the number of triangles, times the logarithm of the largest fan's faces where those give different normals.
///
/// # Errors
/// [`BuildError`].
pub(crate) fn generate_normals(
    mesh: &mut UnfinishedMesh,
    angles: &CreaseAngles,
    budget: &Budget,
    progress: &Progress,
) -> Result<(), BuildError> {
    let _scope = Borrowed::from(budget);
    let points = CornerPoints::new(mesh, budget)?;
    let done = borrowing(budget, || give_normals(mesh, &points, angles.least, budget, progress))?;
    if done.is_empty() || done.contains(&false) {
        budget.borrow(done.len() as u64)?;
        with_fans(mesh, &points, &done, angles, budget, progress)?;
    }
    Ok(())
}

/// Does the same for points that aren't done yet, with lists of the faces around them. `done` says for each
/// point whether it is, and is empty if that is none.
fn with_fans(
    mesh: &mut UnfinishedMesh,
    points: &CornerPoints,
    done: &[bool],
    angles: &CreaseAngles,
    budget: &Budget,
    progress: &Progress,
) -> Result<(), BuildError> {
    // The point of a corner, unless it is done.
    let undone = |corner: u32| Some(points.at(corner)).filter(|point| done.get(*point) != Some(&true));
    let mut around = CornersByPoint::new(mesh, points.count(mesh), undone, budget)?;
    let mut added = AddedCorners { made: ChunkedVec::default(), first: to_u32(mesh.corners.len()), budget };
    let (mut fan, mut next) = (Fan::default(), 0);
    while next < around.ends.len() {
        progress.check()?;
        let block = around.block(next);
        next = block.end;
        for (points, normals) in normals_of(mesh, &around, block, angles) {
            let mut normals = normals.as_slice();
            for point in points {
                let place = around.start(point)..around.ends[point] as usize;
                let corners = &mut around.list[place];
                let (own, others) = normals.split_at(corners.len());
                normals = others;
                fan.number(mesh, corners, own, &mut added)?;
            }
        }
    }
    around.hand_out(mesh, undone);
    drop(around);
    added.append_to(mesh)
}

/// The corners of triangles (3 * triangle + k) on points that aren't done, sorted by point, then by number.
struct CornersByPoint {
    /// Where the corners of each point end in `list`; they start where those of the point before end.
    ends: Vec<u32>,
    list: Vec<u32>,
}

impl CornersByPoint {
    /// Of so many points. `undone` tells the point of a corner, unless it is done.
    fn new(
        mesh: &UnfinishedMesh,
        count: usize,
        undone: impl Fn(u32) -> Option<usize>,
        budget: &Budget,
    ) -> Result<Self, BuildError> {
        let corners = mesh.triangles.as_flattened();
        budget.borrow(4 * count as u64)?;
        let mut ends = vec![0_u32; count];
        corners.iter().filter_map(|&corner| undone(corner)).for_each(|point| ends[point] += 1);
        let largest = ends.iter().copied().max().unwrap_or_default();
        let listed = ends.iter().map(|&count| count as usize).sum::<usize>();
        budget
            .borrow(4 * listed as u64 + PER_FACE * u64::from(largest) + PER_BLOCK_CORNER * listed.min(BLOCK) as u64)?;
        let mut start = 0;
        for end in &mut ends {
            start += std::mem::replace(end, start);
        }
        let mut list = vec![0; listed];
        for (i, &corner) in (0..).zip(corners) {
            let Some(point) = undone(corner) else { continue };
            let end = &mut ends[point];
            list[*end as usize] = i;
            *end += 1;
        }
        Ok(Self { ends, list })
    }

    fn of(&self, point: usize) -> &[u32] {
        &self.list[self.start(point)..self.ends[point] as usize]
    }

    fn start(&self, point: usize) -> usize {
        if point == 0 { 0 } else { self.ends[point - 1] as usize }
    }

    /// Returns the block of points that begins with a point.
    fn block(&self, first: usize) -> Range<usize> {
        let most = self.start(first) + BLOCK;
        let count = self.ends[first..].partition_point(|end| *end as usize <= most);
        first..first + count.max(1)
    }

    /// Replaces the corners of triangles by those that the list now has in the places of their numbers.
    fn hand_out(&mut self, mesh: &mut UnfinishedMesh, undone: impl Fn(u32) -> Option<usize>) {
        for corner in mesh.triangles.as_flattened_mut().iter_mut().rev() {
            let Some(point) = undone(*corner) else { continue };
            // Goes backwards, so that the end of each point's part is where its next corner is.
            let end = &mut self.ends[point];
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
    budget: &'a Budget,
}

impl AddedCorners<'_> {
    fn add(&mut self, like: u32, normal: Vec3) -> Result<u32, BuildError> {
        let id = self.first + to_u32(self.made.len());
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

/// Computes the normals of a block's points on all cores: parts of the block, and for each corner of a triangle on their
/// points the normal that it gets. A corner with a normal keeps it.
fn normals_of(
    mesh: &UnfinishedMesh,
    around: &CornersByPoint,
    block: Range<usize>,
    angles: &CreaseAngles,
) -> Vec<(Range<usize>, Vec<Vec3>)> {
    let largest = block.clone().map(|point| around.of(point).len()).max().unwrap_or_default();
    let least = if largest <= SMALL_FAN { LEAST } else { block.len() };
    in_ranges(block.len(), least, |range| {
        let points = block.start + range.start..block.start + range.end;
        let count = points.clone().map(|point| around.of(point).len()).sum();
        let (mut all, mut faces, mut made) = (Vec::with_capacity(count), Vec::new(), Vec::new());
        for point in points.clone() {
            let corners = around.of(point);
            faces.clear();
            faces.extend(corners.iter().map(|&corner| {
                let triangle = mesh.triangles[corner as usize / 3];
                Face::new(triangle.map(|id| mesh.corners[id as usize].position), corner as usize % 3)
            }));
            creased(&faces, corners, angles, &mut made);
            let given = corners.iter().map(|&corner| mesh.corners[mesh.corner(corner) as usize].normal);
            let normals = made.iter().zip(given);
            all.extend(normals.map(|(made, given)| if given.x.is_nan() { plus_zero3(*made) } else { given }));
        }
        (points, all)
    })
}

/// Computes the normals of a fan's faces, each with the crease angle of its own triangle. `corners` are theirs on the point.
fn creased(faces: &[Face], corners: &[u32], angles: &CreaseAngles, normals: &mut Vec<Vec3>) {
    fan_normals(faces, angles.all, normals);
    let Some(mesh) = angles.styled else { return };
    let own = |corner: &u32| mesh.style_of(corner / 3).crease_angle.unwrap_or(angles.all);
    let own: Vec<f32> = corners.iter().map(own).collect();
    let mut made = Vec::new();
    let mut distinct = own.clone();
    distinct.sort_unstable_by(f32::total_cmp);
    distinct.dedup();
    for angle in distinct {
        fan_normals(faces, angle, &mut made);
        let of_faces = normals.iter_mut().zip(&made).zip(&own).filter(|(_, other)| **other == angle);
        of_faces.for_each(|((normal, made), _)| *normal = *made);
    }
}

/// The faces around one point.
#[derive(Default)]
struct Fan {
    /// For each face, its corner on the point.
    ids: Vec<u32>,
    /// Indices of faces, sorted by the corner that they will use.
    order: Vec<u32>,
}

impl Fan {
    /// Chooses a corner for the normal of each of a fan's faces: one with that normal, one without a normal, or a new one.
    /// It replaces the corners of triangles (3 * triangle + k).
    fn number(
        &mut self,
        mesh: &mut UnfinishedMesh,
        corners: &mut [u32],
        normals: &[Vec3],
        added: &mut AddedCorners,
    ) -> Result<(), BuildError> {
        let Self { ids, order } = self;
        ids.clear();
        ids.extend(corners.iter().map(|&corner| mesh.corner(corner)));
        order.clear();
        order.extend(0..to_u32(ids.len()));
        let key = |i: u32, ids: &[u32], mesh: &UnfinishedMesh| {
            let (id, normal) = (ids[i as usize], normals[i as usize]);
            let uv = mesh.corners[id as usize].uv.to_array().map(f32::to_bits);
            (uv, mesh.bindings.get(id as usize).copied(), normal.to_array().map(f32::to_bits))
        };
        let is_first = |i: &u32| ids[*i as usize] == ids[0] && normals[*i as usize] == normals[0];
        let is_smooth = order.iter().all(is_first);
        if !is_smooth {
            order.sort_unstable_by_key(|&i| (key(i, ids, mesh), i));
        }
        let mut start = 0;
        while start < order.len() {
            let length = if is_smooth {
                order.len()
            } else {
                let own = key(order[start], ids, mesh);
                order[start..].iter().take_while(|&&i| key(i, ids, mesh) == own).count()
            };
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
        corners.copy_from_slice(ids);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;
    use proptest::prelude::*;

    use super::*;
    use crate::cores::on_threads;
    use crate::mesh::build_limits::Budget;
    use crate::mesh::shapes::Shape;
    use crate::mesh::{PartRange, PartStyle};

    fn without_normals(corners: impl Iterator<Item = Corner>, triangles: &[[u32; 3]]) -> UnfinishedMesh {
        let corners = corners.map(|corner| Corner { normal: Vec3::NAN, ..corner }).collect();
        UnfinishedMesh { corners, bindings: Vec::new(), triangles: triangles.to_vec() }
    }

    /// The triangles' corners, with the bits of their numbers, and the triangles. Corners without a triangle are left out later.
    fn bits(mesh: &UnfinishedMesh) -> (Vec<[u32; 8]>, Vec<[u32; 3]>) {
        let corner = |&id: &u32| {
            let corner = &mesh.corners[id as usize];
            let ([x, y, z], [nx, ny, nz], [u, v]) =
                (corner.position.to_array(), corner.normal.to_array(), corner.uv.to_array());
            [x, y, z, nx, ny, nz, u, v].map(f32::to_bits)
        };
        (mesh.triangles.as_flattened().iter().map(corner).collect(), mesh.triangles.clone())
    }

    /// The meshes that both ways make.
    fn both(mesh: impl Fn() -> UnfinishedMesh, angles: &CreaseAngles) -> [UnfinishedMesh; 2] {
        let (mut fast, mut slow) = (mesh(), mesh());
        generate_normals(&mut fast, angles, &Budget::unlimited(), &Progress::new()).unwrap();
        let points = CornerPoints::new(&slow, &Budget::unlimited()).unwrap();
        with_fans(&mut slow, &points, &[], angles, &Budget::unlimited(), &Progress::new()).unwrap();
        [fast, slow]
    }

    proptest! {
        #[test]
        fn one_pass_and_lists_of_faces_give_the_same_bits(
            places in prop::collection::vec((prop::array::uniform2(-4_i8..4), -2_i8..3), 4..40),
            used in prop::collection::vec(prop::array::uniform3(any::<prop::sample::Index>()), 1..60),
            bend in 0.0_f32..1.0,
            crease_angle in prop::sample::select(vec![0.0_f32, 1.0, 30.0, 60.0, 90.0, 180.0]),
            own in prop::option::of(prop::sample::select(vec![0.0_f32, 45.0, 180.0])),
            has_seams in any::<bool>(),
        ) {
            let corner = |(i, ([x, y], z)): (usize, &([i8; 2], i8))| Corner {
                position: Vec3::new(f32::from(*x), f32::from(*y), bend * f32::from(*z)),
                normal: Vec3::NAN,
                uv: if has_seams { Vec2::new((i % 2) as f32, 0.0) } else { Vec2::ZERO },
            };
            let mut corners: Vec<Corner> = places.iter().enumerate().map(corner).collect();
            // A builder has merged equal corners.
            corners.sort_by_key(|corner| (corner.position.to_array().map(f32::to_bits), corner.uv.x.to_bits()));
            corners.dedup_by_key(|corner| (corner.position, corner.uv));
            let count = corners.len();
            let triangles: Vec<_> = used.iter().map(|at| at.map(|at| at.index(count) as u32)).collect();
            // The first half of the triangles is a part.
            let part_ranges = vec![PartRange { triangles: 0..triangles.len() as u32 / 2, part: 0 }];
            let part_styles = vec![PartStyle { crease_angle: own, ..PartStyle::default() }];
            let parts = Mesh { part_ranges, part_styles, ..Mesh::default() };
            let angles = CreaseAngles::new(crease_angle, &parts);
            let [fast, slow] = both(|| without_normals(corners.iter().copied(), &triangles), &angles);
            prop_assert_eq!(bits(&fast), bits(&slow));
        }
    }

    #[test]
    fn smooth_shapes_need_no_lists_and_creased_ones_do() {
        for (shape, is_smooth) in [(Shape::Icosphere, true), (Shape::Torus, true), (Shape::CubeSmooth, false)] {
            let made = shape.build();
            let whole =
                || without_normals(made.corners.iter().map(|c| Corner { uv: Vec2::ZERO, ..*c }), &made.triangles);
            let mut mesh = whole();
            let points = CornerPoints::new(&mesh, &Budget::unlimited()).unwrap();
            let done = give_normals(&mut mesh, &points, 60.0, &Budget::unlimited(), &Progress::new()).unwrap();
            assert_eq!(done.iter().all(|done| *done), is_smooth, "{shape:?}");
            let [fast, slow] = both(whole, &CreaseAngles::new(60.0, &Mesh::default()));
            assert_eq!(bits(&fast), bits(&slow), "{shape:?}");
        }
    }

    #[test]
    fn any_number_of_cores_makes_the_same_normals() {
        let side = 150;
        let bump = |i: u32| Vec3::new((i % side) as f32, (i / side) as f32, (i.wrapping_mul(i) % 97) as f32 * 0.02);
        let corner = |i| Corner { position: bump(i), normal: Vec3::NAN, uv: Vec2::ZERO };
        let squares = (0..side * side).filter(|i| i % side + 1 < side && i / side + 1 < side);
        let triangles: Vec<_> = squares.flat_map(|i| [[i, i + 1, i + side], [i + side, i + 1, i + side + 1]]).collect();
        let made = |cores| {
            let mut mesh = without_normals((0..side * side).map(corner), &triangles);
            let none = Mesh::default();
            let angles = CreaseAngles::new(60.0, &none);
            let make = || generate_normals(&mut mesh, &angles, &Budget::unlimited(), &Progress::new());
            on_threads(cores, make).unwrap().unwrap();
            bits(&mesh)
        };
        assert_eq!(made(1), made(5));
    }
}
