//! Reads the polygons of all meshes that a scene shows.

use glam::{Vec2, Vec3, Vec4};
use ufbx::{Face, Mesh, Node, SubdivisionBoundary, SubdivisionDisplayMode, VertexVec2};

use super::convert::{at_corner, vec2, vec4};
use super::materials::{self, Materials, Resolved};
use super::nodes::Placed;
use super::nurbs::{Meshes, Polygons};
use super::skin::Skin;
use super::vertices::{PosedCorner, Vertices};
use crate::cage_faces::CageFaces;
use crate::face_builder::{FaceBuilder, MAX_CORNERS, NumberedCorner};
use crate::import::{Subdivide, Subdivision};
use crate::memory_budget::{Budget, edge_bytes};
use crate::model_file::ModelFile;
use crate::notes::{Notes, counted, counts};
use crate::parts::node_path;
use crate::read_error::{FilePosition, ReadError};
use crate::rig_builder::{NodeBinder, PER_DELTA, RigBuilder, UndeformedVertex, VertexFrame};
use crate::selection::Selection;
use crate::uri::Files;
use geometry::casts::{to_f32, to_u32, to_usize};
use geometry::mesh::detail_table::DetailTable;
use geometry::mesh::rig::Delta;
use geometry::mesh::subdivision::Boundary;
use geometry::mesh::{Borrowed, CornerDetail, PartStyle};
use geometry::progress::Progress;

/// How many polygons are read before the job asks whether it was cancelled.
const POLYGONS: usize = 4096;

/// Memory for a corner while the mesh is built, in bytes.
const PER_CORNER: u64 = 32;

/// Collects polygons.
pub(super) struct Surfaces<'s, 'a> {
    meshes: &'s Meshes<'s>,
    placed: &'s Placed,
    budget: &'a Budget,
    materials: Materials<'a>,
    faces: FaceBuilder<'a>,
    /// None if no material needs details of corners.
    details: Option<DetailTable>,
    /// None if nothing is animated.
    binder: Option<RigBuilder>,
    without_normals: usize,
    found: Counts,
}

counts! {
    struct Counts {
        holes => "polygons that are holes, left out";
        bad_uvs => "uvs that aren't finite or don't exist, replaced by (0, 0)";
        bad_colors => "colours of corners that aren't finite or don't exist, replaced by white";
        cages => "meshes that are meant to be subdivided, shown as their control cage";
        many_joints => "corners that more than four joints move, of which the four with the largest weights are used";
    }
}

impl<'s, 'a> Surfaces<'s, 'a> {
    /// # Errors
    /// [`ReadError::TooLarge`].
    pub(super) fn new(
        meshes: &'s Meshes<'s>,
        placed: &'s Placed,
        file: &ModelFile,
        files: &'a Files<'a>,
        binder: Option<RigBuilder>,
    ) -> Result<Self, ReadError> {
        let budget = files.budget;
        let scene = meshes.scene;
        let shown = || {
            let nodes = placed.shown.iter().map(|&node| &scene.nodes[node]);
            nodes.filter_map(|node| Some((node, meshes.of(node)?)))
        };
        let is_detailed = materials::need_details(shown());
        let mut faces = FaceBuilder::new(file, budget);
        let triangles = shown().fold(0_usize, |sum, (_, mesh)| sum.saturating_add(mesh.num_triangles));
        // Many copies of a mesh are refused before any is read.
        let memory = (triangles as u64).saturating_mul(12);
        budget.check(memory)?;
        faces.expect(triangles, 0);
        // Placed nodes are in metres, unless another unit was chosen.
        let unit = if file.selected.import.unit.is_none() { scene.settings.unit_meters } else { 1.0 };
        let mut materials = Materials::new(files, to_f32(unit));
        let corners = shown().fold(0_u64, |sum, (_, mesh)| sum.saturating_add(mesh.num_indices as u64));
        let details = if is_detailed { DetailTable::bytes_for(to_usize(corners)) } else { 0 };
        // What the parsed file takes has been freed when the edges are made.
        let parsed = scene.metadata.result_memory_used as u64;
        let edges = edge_bytes(corners, triangles as u64).saturating_sub(parsed);
        let ahead = corners.saturating_mul(PER_CORNER).saturating_add(memory);
        materials.read_images(shown(), ahead.max(edges).saturating_add(details))?;
        Ok(Self {
            meshes,
            placed,
            budget,
            materials,
            faces,
            details: is_detailed.then(DetailTable::default),
            binder,
            without_normals: 0,
            found: Counts::default(),
        })
    }

    /// Adds the polygons of a node's mesh. Returns whether any are shown.
    pub(super) fn add(&mut self, index: usize, selected: &Selection, progress: &Progress) -> Result<bool, ReadError> {
        let (meshes, placed) = (self.meshes, self.placed);
        let nodes = &meshes.scene.nodes;
        let node = &nodes[index];
        let Some(mesh) = meshes.of(node) else { return Ok(false) };
        let before = self.faces.triangles;
        let _scope = Borrowed::from(self.budget);
        let global = &placed.global;
        let skin = Skin::new(node, mesh, global);
        let above = std::iter::successors(Some(index), |&node| placed.scene.parents[node]);
        let own = |node: usize| (&*nodes[node].element.name, false);
        let named = |node: usize| placed.levels.get(&node).map_or_else(|| own(node), |level| (level.as_str(), true));
        // The scene's root isn't one of the file's nodes.
        let (path, level) = node_path(above.filter(|&node| !nodes[node].is_root).map(named));
        self.faces.enter_part(path.as_bytes(), level)?;
        let mut vertices = Vertices::new(node, mesh, global[index], skin.as_ref(), selected, self.budget)?;
        vertices.surface = meshes.surface(node);
        let own = self.faces.parts.style(self.faces.parts.current(), PartStyle::default());
        let is_told = self.faces.import.makes_normals_of(own) || own.crease_angle.is_some();
        let misses_normals = !mesh.vertex_normal.exists && vertices.made.is_none() && !is_told;
        let mut rig = self.binder.take();
        let binder = rig.as_mut().map(|binder| {
            let binder = binder.node(index, skin.as_ref().map(|skin| &skin.joints));
            Binder::new(binder, &vertices)
        });
        let moves = binder.is_some();
        let (resolved, influences, deltas) = (Vec::new(), Vec::new(), Vec::new());
        let mut reader = MeshReader { all: self, node, mesh, vertices, binder, resolved, influences, deltas };
        let subdivision = reader.subdivision();
        reader.all.without_normals += usize::from(misses_normals && subdivision.is_none());
        reader.all.faces.cage = subdivision.map(|own| CageFaces::new(own).of_vertices(moves));
        let mut corners = Vec::new();
        for (i, face) in mesh.faces.iter().enumerate() {
            if i % POLYGONS == 0 {
                progress.check()?;
            }
            reader.face(i, *face, &mut corners)?;
        }
        if subdivision.is_some() {
            reader.creases()?;
        }
        self.faces.is_hole = false;
        self.faces.end_cage(self.details.as_mut(), rig.as_mut(), progress)?;
        self.binder = rig;
        Ok(self.faces.triangles > before)
    }

    /// Returns what was collected; `notes` gets what was repaired or left out.
    pub(super) fn into_parts(self, notes: &mut Notes) -> (FaceBuilder<'a>, Option<DetailTable>, Option<RigBuilder>) {
        notes.append(self.materials.into_notes());
        notes.extend(counted([self.faces.import.lacking_normals(self.without_normals, "meshes without normals")]));
        notes.extend(self.found.sentences());
        (self.faces, self.details, self.binder)
    }
}

/// Reads the polygons of one mesh.
struct MeshReader<'a, 'b, 's, 'f> {
    /// All meshes; the binder is lent to this one.
    all: &'b mut Surfaces<'s, 'f>,
    node: &'a Node,
    mesh: &'a Mesh,
    vertices: Vertices<'a>,
    binder: Option<Binder<'b>>,
    /// The mesh's materials, once they are used.
    resolved: Vec<Option<Resolved>>,
    /// The joints of the corner that is being read, and its displacements.
    influences: Vec<(usize, f64)>,
    deltas: Vec<Delta>,
}

impl MeshReader<'_, '_, '_, '_> {
    /// How the mesh is refined. One that joints move in part isn't: the rest of it isn't in the same space.
    fn subdivision(&mut self) -> Option<Subdivision> {
        let (import, mesh) = (self.all.faces.import, self.mesh);
        let mode = mesh.subdivision_display_mode;
        let is_smooth = matches!(mode, SubdivisionDisplayMode::HullAndSmooth | SubdivisionDisplayMode::Smooth);
        let is_marked = is_smooth && mesh.subdivision_preview_levels > 0;
        let is_wanted = match import.subdivide {
            Subdivide::Off => false,
            Subdivide::File => is_marked,
            Subdivide::CatmullClark | Subdivide::Loop | Subdivide::Butterfly => true,
        };
        if !is_wanted || self.moves_in_part() {
            if is_wanted || is_marked {
                self.all.found.cages += 1;
                self.all.faces.is_refined = Some(false);
            }
            return None;
        }
        let boundary = match mesh.subdivision_boundary {
            SubdivisionBoundary::SharpNone => Boundary::Edges,
            _ => Boundary::EdgesAndCorners,
        };
        let levels = import.levels_or(if is_marked { mesh.subdivision_preview_levels } else { 2 });
        // ufbx reads no rule for texture coordinates.
        let face_varying = import.subdivide_uvs.unwrap_or_default();
        Some(Subdivision { levels, boundary, face_varying, ..import.subdivision().unwrap_or_default() })
    }

    /// Whether clips move the mesh, and joints some of its vertices but not all.
    fn moves_in_part(&mut self) -> bool {
        let Some(skin) = self.vertices.skin.filter(|_| self.binder.is_some()) else { return false };
        let mut is_moved = |vertex| {
            skin.influences(vertex, &mut self.influences);
            !self.influences.is_empty()
        };
        let moved = (0..self.mesh.vertices.len()).filter(|vertex| is_moved(*vertex)).count();
        moved > 0 && moved < self.mesh.vertices.len()
    }

    /// Tells which edges are creases, and which points are sharp. FBX files have a sharpness of 10 as 1.
    fn creases(&mut self) -> Result<(), ReadError> {
        let sharp = self.mesh.edges.iter().zip(self.mesh.edge_crease.iter()).filter(|(_, crease)| **crease > 0.0);
        let mut sharp: Vec<_> = sharp.map(|(edge, crease)| ([edge.a, edge.b], to_f32(10.0 * crease))).collect();
        let points = &self.mesh.vertex_crease;
        for (corner, index) in (0..).zip(points.indices.iter()) {
            let crease = points.values.get(*index as usize).copied().unwrap_or_default();
            sharp.extend((crease > 0.0).then_some(([corner; 2], to_f32(10.0 * crease))));
        }
        for ([a, b], sharpness) in sharp {
            let places = [self.posed(a as usize)?, self.posed(b as usize)?];
            let places = places.map(|(vertex, posed, _)| (posed.corner.position, vertex));
            self.all.faces.cage.iter_mut().for_each(|cage| cage.sharpen(places, sharpness));
        }
        Ok(())
    }

    fn face(&mut self, i: usize, face: Face, corners: &mut Vec<NumberedCorner>) -> Result<(), ReadError> {
        self.all.faces.is_hole = self.mesh.face_hole.get(i) == Some(&true);
        self.all.found.holes += usize::from(self.all.faces.is_hole);
        if self.all.faces.is_hole && self.all.faces.cage.is_none() {
            return Ok(());
        }
        if face.num_indices as usize > MAX_CORNERS {
            let reason = format!("a polygon has more than {MAX_CORNERS} corners");
            return Err(FilePosition::Everywhere.error(reason));
        }
        let material = self.material(i)?;
        self.vertices.makes_normals = self.all.faces.import.makes_normals_of(self.all.faces.style(material.index));
        corners.clear();
        let mut is_mirrored = false;
        for corner in (face.index_begin as usize..).take(face.num_indices as usize) {
            let (read, mirrored) = self.corner(corner, &material)?;
            corners.push(read);
            is_mirrored = mirrored;
        }
        if is_mirrored != self.vertices.surface.is_some_and(Polygons::is_turned) {
            corners.reverse();
        }
        self.all.faces.add(material.index, corners, FilePosition::Everywhere)
    }

    fn material(&mut self, face: usize) -> Result<Resolved, ReadError> {
        let index = self.mesh.face_material.get(face).copied().unwrap_or(0);
        // Lists of materials are short, but indices may be anything.
        let slot = (index as usize).min(self.mesh.materials.len().max(self.node.materials.len()));
        if slot >= self.resolved.len() {
            self.resolved.resize(slot + 1, None);
        }
        if let Some(resolved) = self.resolved[slot] {
            return Ok(resolved);
        }
        let resolved = self.all.materials.resolve(to_u32(slot), self.node, self.mesh, &mut self.all.faces)?;
        self.resolved[slot] = Some(resolved);
        Ok(resolved)
    }

    /// Puts a corner into its rest pose. Returns its vertex too, and whether more joints move it than are used.
    fn posed(&mut self, corner: usize) -> Result<(u32, PosedCorner, bool), ReadError> {
        let vertex = self.vertices.vertex(corner)?;
        self.vertices.morphs.of(vertex, &mut self.deltas);
        self.influences.clear();
        let has_more = self.vertices.skin.is_some_and(|skin| skin.influences(vertex, &mut self.influences));
        Ok((to_u32(vertex), self.vertices.posed(corner, vertex, &self.influences, &self.deltas), has_more))
    }

    /// Reads a corner. Also returns whether its transform mirrors.
    fn corner(&mut self, corner: usize, material: &Resolved) -> Result<(NumberedCorner, bool), ReadError> {
        let (vertex, mut posed, has_more) = self.posed(corner)?;
        self.all.found.many_joints += usize::from(has_more);
        posed.corner.uv = material.own.apply(self.uv(material.own.set, corner));
        let mut number = 0;
        if let Some(binder) = &mut self.binder {
            // Blend shapes are at rest, unless a clip weighs them.
            let start = if binder.first_weight.is_some() { posed.undeformed } else { posed.morphed };
            let at = (start, &posed.corner);
            number = binder.bind(at, &self.influences, &mut self.deltas, self.all.budget)?;
        }
        let detail = self.all.details.is_some().then(|| self.detail(corner, material));
        if let Some((table, detail)) = self.all.details.as_mut().zip(detail) {
            number = table.number(detail, number, self.all.budget)?;
        }
        // Where it isn't refined, a vertex may have several corners.
        let vertex = self.all.faces.cage.is_some().then_some([vertex, 0, 0]);
        Ok((NumberedCorner { corner: posed.corner, number, vertex }, posed.linear.determinant() < 0.0))
    }

    /// Returns the texture coordinates of a set, counted from the top.
    fn uv(&mut self, set: usize, corner: usize) -> Vec2 {
        let list: &VertexVec2 = match self.mesh.uv_sets.get(set) {
            Some(set) if set.vertex_uv.exists => &set.vertex_uv,
            _ => return Vec2::ZERO,
        };
        let uv = at_corner(&list.values, &list.indices, corner).map(vec2);
        let uv = uv.map(|uv| self.vertices.surface.map_or(uv, |surface| surface.uv(uv)).as_vec2());
        let uv = uv.filter(|uv| uv.is_finite());
        self.all.found.bad_uvs += usize::from(uv.is_none());
        uv.map_or(Vec2::ZERO, |uv| Vec2::new(uv.x, 1.0 - uv.y))
    }

    fn detail(&mut self, corner: usize, material: &Resolved) -> CornerDetail {
        let uvs = [0, 1].map(|set| if material.sets[set] { self.uv(set, corner) } else { Vec2::ZERO });
        CornerDetail { uvs, color: self.color(corner), ..CornerDetail::default() }
    }

    fn color(&mut self, corner: usize) -> Vec4 {
        let list = &self.mesh.vertex_color;
        if !list.exists {
            return Vec4::ONE;
        }
        let color = at_corner(&list.values, &list.indices, corner);
        let color = color.map(|color| vec4(color).as_vec4()).filter(|color| color.is_finite());
        self.all.found.bad_colors += usize::from(color.is_none());
        color.map_or(Vec4::ONE, |color| color.clamp(Vec4::ZERO, Vec4::ONE))
    }
}

/// Binds the corners of one mesh to joints and morph targets.
struct Binder<'b> {
    node: NodeBinder<'b>,
    skinned: VertexFrame,
    /// For corners that no joint moves.
    rigid: VertexFrame,
    /// Where the node's weights start, if a clip changes them.
    first_weight: Option<u32>,
}

impl<'b> Binder<'b> {
    fn new(mut node: NodeBinder<'b>, vertices: &Vertices) -> Self {
        let (skinned, rigid) = (node.frame(true, vertices.to_node), node.frame(false, vertices.to_node));
        let first_weight = node.first_weight().filter(|_| !vertices.morphs.shapes.is_empty());
        Self { node, skinned, rigid, first_weight }
    }

    /// Returns the number of a corner's binding.
    fn bind(
        &mut self,
        ((position, normal), corner): ((Vec3, Option<Vec3>), &geometry::mesh::mesh_builder::InputCorner),
        influences: &[(usize, f64)],
        deltas: &mut Vec<Delta>,
        budget: &Budget,
    ) -> Result<u32, ReadError> {
        match self.first_weight {
            Some(first) => deltas.iter_mut().for_each(|delta| delta.weight += first),
            None => deltas.clear(),
        }
        let (frame, influences) = match influences.is_empty() {
            true => (&self.rigid, None),
            false => (&self.skinned, Some(influences)),
        };
        let memory = deltas.len() as u64 * PER_DELTA;
        budget.hold(memory)?;
        let before = self.node.deltas();
        let normal = normal.unwrap_or_default();
        let vertex = UndeformedVertex { position, normal, influences, deltas, tangent: None };
        let number = self.node.bind(frame, vertex, corner);
        if self.node.deltas() == before {
            // Another corner has the same.
            budget.release(memory);
        }
        Ok(number)
    }
}
