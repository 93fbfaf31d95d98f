//! Makes polygons of NURBS surfaces, which are then read as meshes are. ufbx cuts each span of a surface into as many pieces
//! as it is told; how many are needed is measured here.

use std::collections::HashMap;

use glam::{DVec2, DVec3, Vec3};
use ufbx::{
    AllocatorOpts, Connection, ElementType, Mesh, MeshRoot, MirrorAxis, Node, NurbsBasis, NurbsSurface, Scene,
    TessellateSurfaceOpts,
};

use super::convert::{at_corner, vec3};
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
        // The mesh that is made of the polygons takes memory, too.
        let share = MOST_POINTS.saturating_add(budget.files()).min(budget.left() / (4 * PER_POINT)) / uses.max(1);
        let mut meshes = Self { scene, surfaces: HashMap::new(), memory: budget.left() };
        let (mut trimmed, mut still, mut worst) = (0, 0, TOLERANCE);
        let moves =
            |link: &Connection| matches!(link.src.type_, ElementType::SkinDeformer | ElementType::BlendDeformer);
        for (owner, surface) in used {
            match Polygons::cut(surface, share, budget, progress)? {
                Ok((polygons, off)) => {
                    meshes.surfaces.insert(owner.element_id, polygons);
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
        meshes.memory -= budget.left();
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

/// A NURBS surface and its polygons.
pub(super) struct Polygons<'s> {
    surface: &'s NurbsSurface,
    mesh: MeshRoot,
}

impl<'s> Polygons<'s> {
    /// Cuts a surface so that the polygons are within the tolerance, or have its share of points. Also returns by which share of
    /// its size they then differ from it; the inner error says why the surface is left out.
    ///
    /// # Errors
    /// [`ReadError::TooLarge`] and [`ReadError::Cancelled`].
    fn cut(
        surface: &'s NurbsSurface,
        share: u64,
        budget: &Budget,
        progress: &Progress,
    ) -> Result<Result<(Self, f64), &'static str>, ReadError> {
        let [u, v] = [&surface.basis_u, &surface.basis_v];
        if u.order.min(v.order) < 2 || u.order.max(v.order) > MAX_ORDER {
            return Ok(Err("its degree isn't between 1 and 15"));
        }
        if !knots_fit(u, surface.num_control_points_u) || !knots_fit(v, surface.num_control_points_v) {
            return Ok(Err("its knots don't ascend, or don't fit its degree and control points"));
        }
        // As many pieces as the degree, so that no bend lies between the places that are measured. Of a single polygon, if it
        // is a triangle, ufbx would have too few texture coordinates.
        let mut pieces = [u.order as usize - 1, v.order.max(3) as usize - 1];
        while points(surface, pieces) > share && pieces != [1, 1] {
            pieces = pieces.map(|pieces| pieces.div_ceil(2));
        }
        budget.check(points(surface, pieces).saturating_mul(PER_POINT))?;
        loop {
            let Some((off, size)) = measured(surface, pieces, progress)? else {
                return Ok(Err(
                    "a control point, or its weight, isn't a finite number, its weights add up to 0, or all of it is one point",
                ));
            };
            let [off_u, off_v, inside] = off.map(|off| off > TOLERANCE);
            let is_twisted = inside && !off_u && !off_v;
            let doubled = |pieces, is_off| if is_off || is_twisted { 2 * pieces } else { pieces };
            let finer = [doubled(pieces[0], off_u), doubled(pieces[1], off_v)];
            if finer == pieces || points(surface, finer) > share {
                let mesh = tessellated(surface, pieces, budget)?;
                return Ok(Ok((Self { surface, mesh }, off.into_iter().fold(0.0, f64::max) + JOINED / size)));
            }
            pieces = finer;
        }
    }

    /// Whether the file's axes were mirrored, so that polygons show their backs.
    fn is_mirrored(&self) -> bool {
        self.surface.element.scene.metadata.mirror_axis != MirrorAxis::None
    }

    /// Whether the front of the surface is the polygons' back.
    pub(super) fn is_turned(&self) -> bool {
        self.surface.flip_normals != self.is_mirrored()
    }

    /// Returns a corner's normal: the surface's, or the polygons' where a derivative is 0 but for rounding, as at a pole.
    pub(super) fn normal(&self, corner: usize) -> Vec3 {
        let lists = [&self.mesh.vertex_tangent, &self.mesh.vertex_bitangent, &self.mesh.vertex_normal];
        let [along_u, along_v, polygons] =
            lists.map(|list| at_corner(&list.values, &list.indices, corner).map_or(DVec3::ZERO, vec3));
        let exact = along_u.cross(along_v).normalize_or_zero();
        let cos = exact.dot(polygons);
        let normal = if cos.abs() > 0.95 { exact * cos.signum() } else { polygons };
        (if self.is_mirrored() { -normal } else { normal }).as_vec3()
    }

    /// Returns the texture coordinates at u and v, which run from 0 to 1 over the whole surface.
    pub(super) fn uv(&self, place: DVec2) -> DVec2 {
        let [u, v] = [&self.surface.basis_u, &self.surface.basis_v];
        let least = DVec2::new(u.t_min, v.t_min);
        (place - least) / (DVec2::new(u.t_max, v.t_max) - least)
    }
}

/// How many points there are if each span along u and v is cut into so many pieces.
fn points(surface: &NurbsSurface, pieces: [usize; 2]) -> u64 {
    let along = |basis: &NurbsBasis, pieces: usize| (basis.spans.len() as u64 - 1) * pieces as u64 + 1;
    along(&surface.basis_u, pieces[0]).saturating_mul(along(&surface.basis_v, pieces[1]))
}

/// Measures how far a surface is from its polygons at the middles of their sides along u, of those along v, and of the polygons:
/// the largest distances, as shares of its size, and its size. Returns none if a point of it isn't finite, or all are one.
fn measured(
    surface: &NurbsSurface,
    pieces: [usize; 2],
    progress: &Progress,
) -> Result<Option<([f64; 3], f64)>, Cancelled> {
    let (all_u, all_v) = (places(&surface.basis_u, pieces[0]), places(&surface.basis_v, pieces[1]));
    let point = |u: f64, v: f64| vec3(&ufbx::evaluate_nurbs_surface(surface, u, v).position);
    let (mut off, mut least, mut most) = ([0.0_f64; 3], DVec3::INFINITY, DVec3::NEG_INFINITY);
    let polygons = all_v.array_windows().step_by(2).flat_map(|v| all_u.array_windows().step_by(2).map(move |u| (u, v)));
    for (u, v) in polygons {
        progress.check()?;
        let points = v.map(|v| u.map(|u| point(u, v)));
        for point in points.as_flattened() {
            if !point.as_vec3().is_finite() {
                return Ok(None);
            }
            (least, most) = (least.min(*point), most.max(*point));
        }
        let [[a, below, b], [left, middle, right], [d, above, c]] = points;
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
    let size = least.distance(most);
    Ok((size > 0.0).then(|| (off.map(|off| off / size), size)))
}

/// Returns where a direction is evaluated: at the ends of so many pieces of each span, and halfway between them.
fn places(basis: &NurbsBasis, pieces: usize) -> Vec<f64> {
    let parts = (0..2 * pieces).map(|i| i as f64 / (2 * pieces) as f64);
    let within = |[from, to]: &[f64; 2]| parts.clone().map(|part| from + (to - from) * part).collect::<Vec<_>>();
    basis.spans.array_windows().flat_map(within).chain(basis.spans.last().copied()).collect()
}

/// Lets ufbx make the polygons, in memory that is held before.
fn tessellated(surface: &NurbsSurface, pieces: [usize; 2], budget: &Budget) -> Result<MeshRoot, ReadError> {
    let memory = points(surface, pieces).saturating_mul(PER_POINT).saturating_add(BLOCKS * BLOCK as u64);
    budget.hold(memory)?;
    let memory_limit = to_usize(memory);
    let allocator = || AllocatorOpts { memory_limit, max_chunk_size: BLOCK, ..AllocatorOpts::default() };
    let options = TessellateSurfaceOpts {
        temp_allocator: allocator(),
        result_allocator: allocator(),
        span_subdivision_u: pieces[0],
        span_subdivision_v: pieces[1],
        skip_mesh_parts: true,
    };
    ufbx::tessellate_nurbs_surface(surface, options).map_err(|error| parse::refused(&error, budget))
}

/// Whether a surface can be evaluated with these knots: ufbx lets pass those that aren't finite, and those that are all the same.
fn knots_fit(basis: &NurbsBasis, points: usize) -> bool {
    let (used, wrap) = (basis.knot_vector.len().saturating_sub(basis.order as usize), basis.num_wrap_control_points);
    let is_all = used == points || wrap > 0 && used <= points + wrap;
    is_all && basis.valid && basis.spans.len() > 1 && basis.knot_vector.iter().all(|knot| knot.is_finite())
}
