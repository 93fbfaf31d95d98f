//! The faces of a cage, collected until they are refined as a subdivision surface.

use std::collections::HashMap;

use glam::{DVec2, DVec3, Vec2, Vec3};

use super::import::Subdivision;
use super::recent_corners::NumberedCorner;
use geometry::casts::to_u32;
use geometry::mesh::build_limits::{Budget, MAX_TRIANGLES, MemoryRefused};
use geometry::mesh::mesh_builder::InputCorner;
use geometry::mesh::polygon::{WorkBudget, triangulate};
use geometry::mesh::subdivision::{Cage, CageError, Refinement, Scheme};

/// Memory in bytes: for a corner of a cage, with its point; for a refined point, also while limits are computed; for a
/// refined corner, which has a normal; and for its texture coordinates.
const PER_CORNER: u64 = 200;
const PER_POINT: u64 = 12;
const PER_POINT_MEANWHILE: u64 = 48;
const PER_NORMAL: u64 = 12;
const PER_UV: u64 = 32;

/// What a face has beside its corners.
#[derive(Clone, Copy)]
pub(super) struct OfFace {
    pub material: usize,
    pub part: Option<u32>,
}

/// A cage whose points are the distinct positions of corners.
pub(super) struct CageFaces {
    subdivision: Subdivision,
    numbers: HashMap<[u32; 3], u32>,
    positions: Vec<Vec3>,
    starts: Vec<u32>,
    points: Vec<u32>,
    corners: Vec<NumberedCorner>,
    faces: Vec<OfFace>,
    creases: Vec<([u32; 2], f32)>,
    sharp_points: Vec<(u32, f32)>,
    /// Whether refined corners get the normals of the limit surface.
    has_normals: bool,
    held: u64,
}

impl CageFaces {
    pub(super) fn new(subdivision: Subdivision, has_normals: bool) -> Self {
        Self {
            subdivision,
            numbers: HashMap::new(),
            positions: Vec::new(),
            starts: vec![0],
            points: Vec::new(),
            corners: Vec::new(),
            faces: Vec::new(),
            creases: Vec::new(),
            sharp_points: Vec::new(),
            has_normals,
            held: 0,
        }
    }

    /// Adds a face of three or more corners. Loop's scheme gets its triangles.
    ///
    /// # Errors
    /// [`MemoryRefused`].
    pub(super) fn add(
        &mut self,
        corners: &[NumberedCorner],
        face: OfFace,
        work: &mut WorkBudget,
        budget: &Budget,
    ) -> Result<(), MemoryRefused> {
        // A polygon of n corners has n - 2 triangles.
        let stored = if self.subdivision.scheme == Scheme::Loop { 3 * (corners.len() - 2) } else { corners.len() };
        let bytes = PER_CORNER * stored as u64;
        budget.hold(bytes)?;
        self.held += bytes;
        let (whole, mut triangles) = ((0..corners.len()).collect::<Vec<_>>(), Vec::new());
        if self.subdivision.scheme == Scheme::Loop {
            let outline: Vec<Vec3> = corners.iter().map(|at| at.corner.position).collect();
            triangulate(&outline, work, &mut triangles);
        }
        let parts = triangles.iter().map(|triangle| &triangle[..]);
        for part in parts.chain((self.subdivision.scheme != Scheme::Loop).then_some(&whole[..])) {
            for &corner in part {
                let point = self.point(corners[corner].corner.position);
                self.points.push(point);
                self.corners.push(corners[corner]);
            }
            self.starts.push(to_u32(self.points.len()));
            self.faces.push(face);
        }
        Ok(())
    }

    /// Makes the edge between two positions a crease, or the point sharp that is both.
    pub(super) fn crease(&mut self, ends: [Vec3; 2], sharpness: f32) {
        match ends.map(|end| self.point(end)) {
            [a, b] if a == b => self.sharp_points.push((a, sharpness)),
            ends => self.creases.push((ends, sharpness)),
        }
    }

    fn point(&mut self, position: Vec3) -> u32 {
        let key = position.to_array().map(|coordinate| (coordinate + 0.0).to_bits());
        *self.numbers.entry(key).or_insert_with(|| {
            self.positions.push(position);
            to_u32(self.positions.len() - 1)
        })
    }

    /// Refines the cage, and gives the corners of each refined face to `add`, with points and normals of the limit surface. A cage that
    /// can't be refined stays as it is, and the reason is returned.
    ///
    /// # Errors
    /// Those of `add`, and [`MemoryRefused`].
    pub(super) fn refine<E: From<MemoryRefused>>(
        self,
        budget: &Budget,
        mut add: impl FnMut(&mut Vec<NumberedCorner>, OfFace) -> Result<(), E>,
    ) -> Result<Option<CageError>, E> {
        let Subdivision { scheme, levels, boundary } = self.subdivision;
        let (points, creases, sharp_points) = (self.positions.len(), &self.creases[..], &self.sharp_points[..]);
        let own = Cage {
            points,
            starts: &self.starts,
            corners: &self.points,
            scheme,
            boundary,
            creases,
            sharp_points,
            holes: &[],
        };
        let size = own.size_at_most(levels);
        let has_uvs = self.corners.iter().any(|at| at.corner.uv != Vec2::ZERO);
        let per_corner = PER_NORMAL + if has_uvs { PER_UV } else { 0 };
        // All levels together have at most four thirds of the elements of the last one.
        let counted = [(size.bytes(), 4, 3), (size.points, PER_POINT, 1), (size.corners, per_corner, 1)];
        let memory = counted
            .into_iter()
            .fold(0_u64, |sum, (count, each, part)| sum.saturating_add(count.saturating_mul(each) / part));
        let meanwhile = size.points.saturating_mul(PER_POINT_MEANWHILE);
        budget.hold(memory)?;
        budget.check(meanwhile)?;
        let (refinement, why_not) = match Refinement::new(&own, levels, MAX_TRIANGLES) {
            Ok(refinement) => (Some(refinement), None),
            Err(error) => (None, Some(error)),
        };
        let mut corners = Vec::new();
        match refinement {
            Some(refinement) => self.refined(&refinement, has_uvs, |face, own| {
                corners.clear();
                corners.extend(face);
                add(&mut corners, own)
            })?,
            None => {
                for (own, ends) in self.faces.iter().zip(self.starts.array_windows()) {
                    let [start, end] = ends.map(|end| end as usize);
                    corners.clear();
                    corners.extend_from_slice(&self.corners[start..end]);
                    add(&mut corners, *own)?;
                }
            }
        }
        budget.release(self.held.saturating_add(memory));
        Ok(why_not)
    }

    fn refined<E>(
        &self,
        refinement: &Refinement,
        has_uvs: bool,
        mut add: impl FnMut(&mut dyn Iterator<Item = NumberedCorner>, OfFace) -> Result<(), E>,
    ) -> Result<(), E> {
        let (places, normals) = self.limit(refinement);
        let uvs: Vec<DVec2> = self.corners.iter().map(|at| at.corner.uv.as_dvec2()).filter(|_| has_uvs).collect();
        let uvs = if has_uvs { refinement.refine_corners(&uvs) } else { uvs };
        // Parts of a face of the cage follow one another, those nearest to its first corner first.
        let mut nth = (u32::MAX, 0);
        for face in refinement.faces() {
            nth = if nth.0 == face.cage_face { (nth.0, nth.1 + 1) } else { (face.cage_face, 0) };
            let nearest = self.nearest_corner(face.cage_face as usize, nth.1);
            let mut corners = face.corners.map(|k| NumberedCorner {
                corner: InputCorner {
                    position: places[refinement.corners()[k] as usize],
                    normal: Some(normals[k]).filter(|_| self.has_normals),
                    uv: uvs.get(k).map_or(Vec2::ZERO, |uv| uv.as_vec2()),
                },
                number: nearest.number,
                vertex: None,
            });
            add(&mut corners, self.faces[face.cage_face as usize])?;
        }
        Ok(())
    }

    /// The points of the limit surface, and its normals at the corners of faces.
    fn limit(&self, refinement: &Refinement) -> (Vec<Vec3>, Vec<Vec3>) {
        let positions: Vec<DVec3> = self.positions.iter().map(|position| position.as_dvec3()).collect();
        let refined = refinement.refine(&positions);
        let limit = refinement.limit(&refined);
        (limit.values().into_iter().map(DVec3::as_vec3).collect(), limit.normals())
    }

    /// The corner of a face that is nearest to its refined part number `nth`.
    fn nearest_corner(&self, face: usize, nth: usize) -> &NumberedCorner {
        let [start, end] = [self.starts[face], self.starts[face + 1]].map(|end| end as usize);
        // Both schemes divide the parts of the first level into four.
        let each = 1 << (2 * self.subdivision.levels.saturating_sub(1));
        &self.corners[(start + nth / each).min(end - 1)]
    }
}
