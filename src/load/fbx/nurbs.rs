//! Makes polygons of NURBS surfaces, which are then read as meshes are. ufbx evaluates a surface, and cuts each of its spans into
//! as many pieces as it is told; how many are needed is measured here.

use std::collections::HashMap;

use glam::{DVec2, DVec3, Vec3};
use ufbx::{
    AllocatorOpts, Connection, ElementType, Mesh, MeshRoot, MirrorAxis, Node, NurbsBasis, NurbsSurface, NurbsTopology,
    Scene,
};

use super::convert::{at_corner, vec3, vec4};
use super::{looks, parse};
use crate::memory_budget::Budget;
use crate::notes::{Notes, counted};
use crate::read_error::ReadError;
use geometry::casts::to_usize;
use geometry::near::closest_on_triangle;
use geometry::progress::{Cancelled, Progress};

/// The greatest distance between a surface and its polygons, as a share of the diagonal of the box around it.
const TOLERANCE: f64 = 0.001;

/// Points of a surface's outline that are nearer to each other, in units of the file, become one in ufbx.
const JOINED: f64 = 3.2e-4;

/// The greatest order, which is the degree plus 1. A point takes as many control points as the product of both orders.
const MAX_ORDER: u32 = 16;

/// How many points the polygons of all surfaces may get to be within the tolerance, besides one for each byte of the file.
const MOST_POINTS: u64 = 1 << 16;

/// The memory of a surface's polygons in bytes: for each point, and for lists of less than a block, which ufbx puts into blocks.
const PER_POINT: u64 = 256;
const BLOCK: usize = 1024;
const BLOCKS: u64 = 14;

/// The meshes of nodes: those of the file, and the polygons of NURBS surfaces.
pub(super) struct Meshes<'s> {
    pub scene: &'s Scene,
    /// By the number of the object that nodes have.
    surfaces: HashMap<u32, Polygons<'s>>,
    /// What the polygons take of the budget, in bytes.
    pub memory: u64,
}

/// A NURBS surface and its polygons.
pub(super) struct Polygons<'s> {
    surface: &'s NurbsSurface,
    mesh: MeshRoot,
    is_mirrored: bool,
}

impl<'s> Meshes<'s> {
    /// Cuts the surfaces that nodes have; trimmed ones are cut whole.
    ///
    /// # Errors
    /// [`ReadError::TooLarge`] and [`ReadError::Cancelled`]. A surface that can't be evaluated causes a warning.
    pub(super) fn new(
        scene: &'s Scene,
        budget: &Budget,
        progress: &Progress,
        notes: &mut Notes,
    ) -> Result<Self, ReadError> {
        let whole = scene.nurbs_surfaces.into_iter().map(|surface| (&surface.element, surface));
        let trimmed = scene.nurbs_trim_surfaces.into_iter().filter_map(|own| {
            let surface = own.element.connections_dst.iter().find_map(|link| ufbx::as_nurbs_surface(&link.src))?;
            Some((&own.element, surface))
        });
        let used: Vec<_> = whole.chain(trimmed).filter(|(owner, _)| !owner.instances.is_empty()).collect();
        let uses: u64 = used.iter().map(|(owner, _)| owner.instances.len() as u64).sum();
        let share = MOST_POINTS.saturating_add(budget.files()) / uses.max(1);
        let mut meshes = Self { scene, surfaces: HashMap::new(), memory: 0 };
        let (mut trimmed, mut still, mut worst) = (0, 0, TOLERANCE);
        let moves =
            |link: &Connection| matches!(link.src.type_, ElementType::SkinDeformer | ElementType::BlendDeformer);
        for (owner, surface) in used {
            match Cut::refined(surface, share, budget, progress)? {
                Ok((cut, off)) => {
                    meshes.surfaces.insert(owner.element_id, cut.tessellated(scene, budget)?);
                    meshes.memory += cut.memory();
                    still += usize::from(surface.element.connections_dst.iter().any(moves));
                    trimmed += usize::from(owner.element_id != surface.element.element_id);
                    worst = worst.max(off);
                }
                Err(reason) => {
                    let name = owner.instances.first().map(|node| looks::name(&node.element)).unwrap_or_default();
                    notes.push(format!("the NURBS surface of \"{name}\" is left out: {reason}."));
                }
            }
        }
        let made = format!("NURBS surfaces, made polygons that differ from them by up to {worst:.3} of their size");
        notes.extend(counted([
            (meshes.surfaces.len(), &*made),
            (trimmed, "NURBS surfaces whose trimming isn't read"),
            (still, "NURBS surfaces that skins or blend shapes would move, shown without them"),
        ]));
        Ok(meshes)
    }

    /// Returns the mesh of a node, or the polygons of its surface.
    pub(super) fn of<'n>(&'n self, node: &'n Node) -> Option<&'n Mesh> {
        node.mesh.as_deref().or_else(|| Some(&*self.surface(node)?.mesh))
    }

    /// Returns the polygons of a node's surface.
    pub(super) fn surface(&self, node: &Node) -> Option<&Polygons<'s>> {
        let own = node.attrib.as_ref().filter(|_| node.mesh.is_none())?;
        self.surfaces.get(&own.element_id)
    }
}

impl Polygons<'_> {
    /// Whether the front of the surface is the polygons' back.
    pub(super) fn is_turned(&self) -> bool {
        self.surface.flip_normals != self.is_mirrored
    }

    /// Returns a corner's normal: the surface's, or the polygons' where a derivative is 0 but for rounding, as at a pole.
    pub(super) fn normal(&self, corner: usize) -> Vec3 {
        let lists = [&self.mesh.vertex_tangent, &self.mesh.vertex_bitangent, &self.mesh.vertex_normal];
        let [along_u, along_v, polygons] =
            lists.map(|list| at_corner(&list.values, &list.indices, corner).map_or(DVec3::ZERO, vec3));
        let turned = |normal: DVec3, is_turned: bool| if is_turned { -normal } else { normal };
        let exact = turned(along_u.cross(along_v).normalize_or_zero(), self.surface.flip_normals);
        turned(if exact.dot(polygons) > 0.95 { exact } else { polygons }, self.is_mirrored).as_vec3()
    }

    /// Returns the texture coordinates at u and v, which run from 0 to 1 over the whole surface.
    pub(super) fn uv(&self, place: DVec2) -> DVec2 {
        let [u, v] = [&self.surface.basis_u, &self.surface.basis_v];
        let least = DVec2::new(u.t_min, v.t_min);
        (place - least) / (DVec2::new(u.t_max, v.t_max) - least)
    }
}

/// A surface, and how many pieces each of its spans along u and v is cut into.
#[derive(Clone, Copy)]
struct Cut<'s> {
    surface: &'s NurbsSurface,
    pieces: [usize; 2],
}

impl<'s> Cut<'s> {
    /// Cuts each span into as many pieces as its degree, so that no bend lies between the places that are measured.
    ///
    /// # Errors
    /// A clause that says why the surface can't be evaluated.
    fn new(surface: &'s NurbsSurface) -> Result<Self, &'static str> {
        let [u, v] = [&surface.basis_u, &surface.basis_v];
        let fit = knots_fit(u, surface.num_control_points_u) && knots_fit(v, surface.num_control_points_v);
        let are_finite = surface.control_points.iter().all(|point| vec4(point).is_finite());
        let checks = [
            (!surface.control_points.is_empty(), "it has no control points"),
            (u.order.min(v.order) >= 2 && u.order.max(v.order) <= MAX_ORDER, "its degree isn't between 1 and 15"),
            (fit, "its knots don't ascend, or don't fit its degree and control points"),
            (are_finite, "a control point, or its weight, isn't a finite number"),
        ];
        match checks.into_iter().find(|(is_right, _)| !is_right) {
            Some((_, reason)) => Err(reason),
            // Of a single polygon, if it is a triangle, ufbx would have too few texture coordinates.
            None => Ok(Self { surface, pieces: [u.order as usize - 1, v.order.max(3) as usize - 1] }),
        }
    }

    /// How many polygons there are along u and v.
    fn polygons(&self) -> [usize; 2] {
        let spans = [&self.surface.basis_u, &self.surface.basis_v].map(|basis| basis.spans.len() - 1);
        [0, 1].map(|i| spans[i].saturating_mul(self.pieces[i]))
    }

    fn points(&self) -> u64 {
        let [columns, rows] = self.polygons().map(|polygons| polygons as u64 + 1);
        columns.saturating_mul(rows)
    }

    fn memory(&self) -> u64 {
        self.points().saturating_mul(PER_POINT).saturating_add(BLOCKS * BLOCK as u64)
    }

    /// Cuts a surface so that the polygons are within the tolerance, or have its share of points. Also returns by which share of
    /// its size they then differ from it; the inner error says why the surface is left out.
    ///
    /// # Errors
    /// [`ReadError::TooLarge`] and [`ReadError::Cancelled`].
    fn refined(
        surface: &'s NurbsSurface,
        share: u64,
        budget: &Budget,
        progress: &Progress,
    ) -> Result<Result<(Self, f64), &'static str>, ReadError> {
        let mut cut = match Self::new(surface) {
            Ok(cut) => cut,
            Err(reason) => return Ok(Err(reason)),
        };
        while cut.points() > share && cut.pieces != [1, 1] {
            cut.pieces = cut.pieces.map(|pieces| pieces.div_ceil(2));
        }
        budget.check(cut.memory())?;
        loop {
            let Some((off, size)) = cut.measured(progress)? else {
                return Ok(Err("its weights add up to 0, or all of it is one point"));
            };
            let [u, v, inside] = off.map(|off| off > TOLERANCE);
            let is_twisted = inside && !u && !v;
            let [along_u, along_v] = cut.pieces;
            let doubled = |pieces, is_off| if is_off || is_twisted { 2 * pieces } else { pieces };
            let finer = Self { surface, pieces: [doubled(along_u, u), doubled(along_v, v)] };
            // The mesh that is made of the polygons takes memory, too.
            let is_too_much = finer.points() > share || finer.memory() > budget.left() / 4;
            if finer.pieces == cut.pieces || is_too_much {
                return Ok(Ok((cut, off.into_iter().fold(0.0, f64::max) + JOINED / size)));
            }
            cut = finer;
        }
    }

    /// Measures how far the surface is from its polygons at the middles of their sides along u, of those along v, and of the
    /// polygons: the largest distances, as shares of its size, and its size. Returns none if a point of it isn't finite, or all
    /// are one.
    fn measured(&self, progress: &Progress) -> Result<Option<([f64; 3], f64)>, Cancelled> {
        let mut off = [0.0_f64; 3];
        let mut extent = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        let [columns, rows] = self.polygons();
        for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
            progress.check()?;
            let points = [0, 1, 2].map(|y| [0, 1, 2].map(|x| self.point([2 * column + x, 2 * row + y])));
            if !points.as_flattened().iter().all(|point| point.as_vec3().is_finite()) {
                return Ok(None);
            }
            let [[a, below, b], [left, middle, right], [d, above, c]] = points;
            extent = [a, b, c, d].into_iter().fold(extent, |[least, most], point| [least.min(point), most.max(point)]);
            // A side is a triangle without area, and either diagonal may cut the polygon.
            for (kind, point, triangles) in [
                (0, below, [[a, b, b]; 2]),
                (0, above, [[d, c, c]; 2]),
                (1, left, [[a, d, d]; 2]),
                (1, right, [[b, c, c]; 2]),
                (2, middle, [[a, b, c], [c, d, a]]),
                (2, middle, [[b, c, d], [d, a, b]]),
            ] {
                let [one, other] = triangles.map(|triangle| closest_on_triangle(triangle, point).1.distance(point));
                off[kind] = off[kind].max(one.min(other));
            }
        }
        let size = extent[0].distance(extent[1]);
        Ok((size > 0.0).then(|| (off.map(|off| off / size), size)))
    }

    /// Returns the point at so many halves of pieces along u and v. Where a surface closes, ufbx takes its first points as the last.
    fn point(&self, halves: [usize; 2]) -> DVec3 {
        let bases = [&self.surface.basis_u, &self.surface.basis_v];
        let [u, v] = [0, 1].map(|i| {
            let (spans, steps) = (&bases[i].spans, 2 * self.pieces[i]);
            let (span, part) = (halves[i] / steps, (halves[i] % steps) as f64 / steps as f64);
            match spans.get(span + 1) {
                Some(next) => spans[span] * (1.0 - part) + next * part,
                None if bases[i].topology == NurbsTopology::Open => spans[span],
                None => spans[0],
            }
        });
        let point = ufbx::evaluate_nurbs_surface(self.surface, u, v);
        if point.valid { vec3(&point.position) } else { DVec3::NAN }
    }

    /// Lets ufbx make the polygons, in memory that is held before.
    fn tessellated(&self, scene: &Scene, budget: &Budget) -> Result<Polygons<'s>, ReadError> {
        budget.hold(self.memory())?;
        let memory_limit = to_usize(self.memory());
        let allocator = || AllocatorOpts { memory_limit, max_chunk_size: BLOCK, ..AllocatorOpts::default() };
        let options = ufbx::TessellateSurfaceOpts {
            temp_allocator: allocator(),
            result_allocator: allocator(),
            span_subdivision_u: self.pieces[0],
            span_subdivision_v: self.pieces[1],
            skip_mesh_parts: true,
        };
        let mesh = ufbx::tessellate_nurbs_surface(self.surface, options);
        let mesh = mesh.map_err(|error| parse::refused(&error, budget))?;
        Ok(Polygons { surface: self.surface, mesh, is_mirrored: scene.metadata.mirror_axis != MirrorAxis::None })
    }
}

/// Whether a surface can be evaluated with these knots: ufbx lets pass those that aren't finite, and those that are all the same.
fn knots_fit(basis: &NurbsBasis, points: usize) -> bool {
    let used = basis.knot_vector.len().saturating_sub(basis.order as usize);
    let is_all = match basis.topology {
        NurbsTopology::Open => used == points,
        NurbsTopology::Closed | NurbsTopology::Periodic => used <= points + basis.num_wrap_control_points,
    };
    is_all && basis.valid && basis.spans.len() > 1 && basis.knot_vector.iter().all(|knot| knot.is_finite())
}
