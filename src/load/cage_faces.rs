//! The faces of a cage, collected until they are refined as a subdivision surface.

use std::collections::HashMap;

use glam::{DVec2, DVec4, Vec2, Vec3, swizzles::Vec4Swizzles};

use super::import::Subdivision;
use super::recent_corners::NumberedCorner;
use super::rig_builder::RigBuilder;
use geometry::casts::to_u32;
use geometry::mesh::CornerDetail;
use geometry::mesh::build_limits::{Budget, MAX_TRIANGLES, MemoryRefused};
use geometry::mesh::detail_table::DetailTable;
use geometry::mesh::mesh_builder::InputCorner;
use geometry::mesh::subdivision::{Cage, FaceVarying, Refinement, Scheme, Size};
use geometry::progress::{Cancelled, Progress};

/// Memory in bytes: of a corner of a cage with its point; of a refined point, and beside it while limits are computed; of a refined
/// corner with its normal, its texture coordinates, and its details.
const PER_CORNER: u64 = 200;
const PER_POINT: u64 = 12;
const PER_POINT_MEANWHILE: u64 = 48;
const PER_NORMAL: u64 = 12;
const PER_UV: u64 = 64;
const PER_DETAIL: u64 = 128;
/// Of a distinct value while values at corners are smoothed.
const PER_VALUE: u64 = 128;
/// Of a refined point that a clip may move, with its joints and their weights.
const PER_BINDING: u64 = 400;

/// What a face has beside its corners.
#[derive(Clone, Copy)]
pub(super) struct OfFace {
    pub material: usize,
    pub part: Option<u32>,
    /// Whether it is left out, and only shapes its neighbours.
    pub is_hole: bool,
}

/// A cage whose points are the distinct positions of corners; or their vertices, where the format has such.
#[derive(Default)]
pub(super) struct CageFaces {
    pub subdivision: Subdivision,
    /// Whether vertices at one position are points of their own, as in modelling programs.
    pub by_vertex: bool,
    /// Whether clips may move it.
    moves: bool,
    numbers: HashMap<([u32; 3], u32), u32>,
    positions: Vec<Vec3>,
    starts: Vec<u32>,
    points: Vec<u32>,
    corners: Vec<NumberedCorner>,
    faces: Vec<OfFace>,
    creases: Vec<([u32; 2], f32)>,
    sharp_points: Vec<(u32, f32)>,
    holes: Vec<u32>,
    /// How many creases and sharp points are where no face is.
    lone_creases: usize,
    /// The memory that is given back once it is refined, in bytes.
    pub held: u64,
}

impl CageFaces {
    pub(super) fn new(subdivision: Subdivision) -> Self {
        Self { subdivision, starts: vec![0], ..Self::default() }
    }

    /// The same with vertices as points, which clips may move.
    pub(super) fn of_vertices(self, moves: bool) -> Self {
        Self { by_vertex: true, moves, ..self }
    }

    /// Adds a face of three or more corners. Schemes for triangles get its triangles. Returns how many faces have a point twice:
    /// these are left out.
    ///
    /// # Errors
    /// [`MemoryRefused`].
    pub(super) fn add(
        &mut self,
        corners: &[NumberedCorner],
        face: OfFace,
        triangles: &[[usize; 3]],
        budget: &Budget,
    ) -> Result<usize, MemoryRefused> {
        let whole: Vec<usize> = (0..corners.len()).collect();
        let parts: Vec<&[usize]> = match self.subdivision.scheme {
            Scheme::CatmullClark => vec![&whole],
            Scheme::Loop | Scheme::Butterfly => triangles.iter().map(|triangle| &triangle[..]).collect(),
        };
        let bytes = PER_CORNER * parts.iter().map(|part| part.len() as u64).sum::<u64>();
        budget.hold(bytes)?;
        self.held += bytes;
        let mut left_out = 0;
        for part in parts {
            let start = self.points.len();
            for &corner in part {
                let NumberedCorner { corner, vertex, .. } = corners[corner];
                let point = self.point(corner.position, vertex.map_or(0, |[vertex, ..]| vertex));
                self.points.push(point);
            }
            let mut sorted = self.points[start..].to_vec();
            sorted.sort_unstable();
            // A point that it has twice.
            if sorted.array_windows().any(|[a, b]| a == b) {
                self.points.truncate(start);
                left_out += 1;
                continue;
            }
            self.corners.extend(part.iter().map(|&corner| corners[corner]));
            self.holes.extend(face.is_hole.then_some(to_u32(self.faces.len())));
            self.starts.push(to_u32(self.points.len()));
            self.faces.push(face);
        }
        Ok(left_out)
    }

    /// Makes the edge between two positions, with the vertices there, a crease; or the point sharp, if they are the same vertex.
    pub(super) fn sharpen(&mut self, ends: [(Vec3, u32); 2], sharpness: f32) {
        let [(first, a), (second, b)] = ends;
        match [self.key(first, a), self.key(second, b)].map(|key| self.numbers.get(&key).copied()) {
            [Some(point), Some(_)] if a == b => self.sharp_points.push((point, sharpness)),
            [Some(a), Some(b)] => self.creases.extend((a != b).then_some(([a, b], sharpness))),
            [None, _] | [_, None] => self.lone_creases += 1,
        }
    }

    fn key(&self, position: Vec3, vertex: u32) -> ([u32; 3], u32) {
        let place = position.to_array().map(|coordinate| (coordinate + 0.0).to_bits());
        (place, if self.by_vertex { vertex } else { 0 })
    }

    fn point(&mut self, position: Vec3, vertex: u32) -> u32 {
        *self.numbers.entry(self.key(position, vertex)).or_insert_with(|| {
            self.positions.push(position);
            to_u32(self.positions.len() - 1)
        })
    }

    /// Refines the cage, and gives the corners of each refined face to `add`, with points and normals of the limit surface. `details` are
    /// those that corners have by their numbers; what clips move is bound to `rig`. A cage that can't be refined stays as it is, and
    /// the reason is returned; otherwise, how many creases and sharp points aren't in faces.
    ///
    /// # Errors
    /// Those of `add`, [`MemoryRefused`] and [`Cancelled`].
    pub(super) fn refine<E: From<MemoryRefused> + From<Cancelled>>(
        self,
        (budget, progress): (&Budget, &Progress),
        details: Option<&mut DetailTable>,
        rig: Option<&mut RigBuilder>,
        mut add: impl FnMut(&mut Vec<NumberedCorner>, OfFace) -> Result<(), E>,
    ) -> Result<Result<usize, String>, E> {
        let Subdivision { scheme, levels, boundary, face_varying } = self.subdivision;
        let cage = Cage {
            points: self.positions.len(),
            starts: &self.starts,
            corners: &self.points,
            scheme,
            boundary,
            creases: &self.creases,
            sharp_points: &self.sharp_points,
            holes: &self.holes,
        };
        let size = cage.size_at_most(levels);
        let memory = self.memory(size, details.is_some());
        let most = if scheme == Scheme::CatmullClark { MAX_TRIANGLES / 2 } else { MAX_TRIANGLES };
        let mut meanwhile = memory.saturating_add(size.points.saturating_mul(PER_POINT_MEANWHILE));
        if face_varying != FaceVarying::Linear && (details.is_some() || self.has_uvs()) {
            // The values are the points of another cage.
            let values = Cage { points: self.points.len(), ..cage }.size_at_most(levels);
            let lists = values.bytes().saturating_mul(4) / 3;
            meanwhile = meanwhile.saturating_add(lists).saturating_add(values.points.saturating_mul(PER_VALUE));
        }
        let refinement = match budget.check(meanwhile).and_then(|()| budget.hold(memory)) {
            Ok(()) => Refinement::new(&cage, levels, most).map_err(|error| (error.to_string(), memory)),
            Err(refused) => Err((format!("refined, it {refused}"), 0)),
        };
        let (refined, held) = match refinement {
            Ok(refinement) => {
                self.refined(&refinement, details, rig, (budget, progress), add)?;
                (Ok(refinement.lone_creases + self.lone_creases), memory)
            }
            Err((why_not, held)) => {
                for (own, ends) in self.faces.iter().zip(self.starts.array_windows()).filter(|(own, _)| !own.is_hole) {
                    let [start, end] = ends.map(|end| end as usize);
                    add(&mut self.corners[start..end].to_vec(), *own)?;
                }
                (Err(why_not), held)
            }
        };
        budget.release(self.held.saturating_add(held));
        Ok(refined)
    }

    /// How much memory refining takes at most, in bytes.
    fn memory(&self, size: Size, has_details: bool) -> u64 {
        let per_corner =
            PER_NORMAL + if self.has_uvs() { PER_UV } else { 0 } + if has_details { PER_DETAIL } else { 0 };
        // All levels together have at most four thirds of the elements of the last one.
        let per_point = PER_POINT + if self.moves { PER_BINDING } else { 0 };
        let counted = [(size.bytes(), 4, 3), (size.points, per_point, 1), (size.corners, per_corner, 1)];
        counted
            .into_iter()
            .fold(0, |sum: u64, (count, each, part)| sum.saturating_add(count.saturating_mul(each) / part))
    }

    fn has_uvs(&self) -> bool {
        self.corners.iter().any(|at| at.corner.uv != Vec2::ZERO)
    }

    fn refined<E: From<MemoryRefused> + From<Cancelled>>(
        &self,
        refinement: &Refinement,
        mut details: Option<&mut DetailTable>,
        rig: Option<&mut RigBuilder>,
        (budget, progress): (&Budget, &Progress),
        mut add: impl FnMut(&mut Vec<NumberedCorner>, OfFace) -> Result<(), E>,
    ) -> Result<(), E> {
        let refined = refinement.refine(&self.positions.iter().map(|position| position.as_dvec3()).collect::<Vec<_>>());
        let limit = refinement.limit(&refined);
        let (places, normals) = (limit.values(), limit.normals());
        let at_corners = |has: bool, rule: FaceVarying, value: &dyn Fn(&NumberedCorner) -> DVec4| {
            let values: Vec<DVec4> = self.corners.iter().filter(|_| has).map(value).collect();
            if has { refinement.refine_face_varying(&values, rule) } else { values }
        };
        let rule = self.subdivision.face_varying;
        let uvs = at_corners(self.has_uvs(), rule, &|at| at.corner.uv.as_dvec2().extend(0.0).extend(0.0));
        let detail =
            |at: &NumberedCorner| details.as_ref().map_or_else(CornerDetail::default, |all| all.detail(at.number));
        let colors = at_corners(details.is_some(), FaceVarying::Linear, &|at| detail(at).color.as_dvec4());
        let more_uvs = at_corners(details.is_some(), rule, &|at| {
            let [a, b] = detail(at).uvs.map(Vec2::as_dvec2);
            DVec4::new(a.x, a.y, b.x, b.y)
        });
        let bind = |rig: &mut RigBuilder| {
            rig.bind_refined::<E>(refinement, &self.bindings(details.as_deref()), budget, progress)
        };
        let bound = rig.map(bind).transpose()?;
        let mut corners = Vec::new();
        for face in refinement.faces() {
            corners.clear();
            for k in face.corners {
                let point = refinement.corners()[k] as usize;
                let binding = bound.as_ref().map_or(0, |bound| bound[point]);
                let number = match &mut details {
                    Some(details) => {
                        let [a, b] = [more_uvs[k].xy(), more_uvs[k].zw()].map(DVec2::as_vec2);
                        let own = CornerDetail { uvs: [a, b], color: colors[k].as_vec4(), ..CornerDetail::default() };
                        details.number(own, binding, budget)?
                    }
                    None => binding,
                };
                let position = places[point].as_vec3();
                let normal = Some(normals[k]);
                let uv = uvs.get(k).map_or(Vec2::ZERO, |uv| uv.xy().as_vec2());
                corners.push(NumberedCorner { corner: InputCorner { position, normal, uv }, number, vertex: None });
            }
            add(&mut corners, self.faces[face.cage_face as usize])?;
        }
        Ok(())
    }

    /// What each point is bound to: what its first corner is, since others differ from that in their normals alone. A point that is
    /// in no face is bound to nothing.
    fn bindings(&self, details: Option<&DetailTable>) -> Vec<u32> {
        let mut bindings = vec![u32::MAX; self.positions.len()];
        for (&point, at) in self.points.iter().zip(&self.corners).rev() {
            bindings[point as usize] = details.map_or(at.number, |details| details.binding(at.number));
        }
        bindings
    }
}
