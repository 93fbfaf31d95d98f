//! What is odd about a mesh, and the numbers that `pnaen info` prints.

use std::fmt;

use glam::DVec3;
use serde::Serialize;

use super::Mesh;
use super::bounds::Bounds;
use super::grid::Grid;
use super::topology::{EdgeCounts, EdgeKind, Topology};

/// How near ends must be to count as a near miss, as a part of the bounding diagonal.
const NEAR: f64 = 1e-5;

/// Edges tried against one edge at most. More than that within one tolerance is noise, and trying all would be quadratic.
const TRIES: usize = 256;

/// Two boundary edges that look welded and aren't: a crack before any tessellation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct NearMiss {
    /// Indices into [`Topology::edges`], the lower one first.
    pub edges: [u32; 2],
    /// The second edge's own direction runs against the first's.
    pub reversed: bool,
    /// The larger of the two distances between ends, in object units.
    pub distance: f32,
}

/// A boundary edge on the grid of middles.
struct Open {
    edge: u32,
    ends: [DVec3; 2],
}

/// Pairs of boundary edges whose ends lie within 1e-5 of the bounding diagonal of each other's, in either direction,
/// though they aren't the same points. Edges shorter than twice that are left out. In the order of the first edge.
///
/// Near linear: middles are hashed on a grid, and an edge is compared with the first 256 edges of each grid cell around it.
pub fn near_misses(topology: &Topology) -> Vec<NearMiss> {
    let tolerance = Bounds::of(topology.points.iter().copied()).part(NEAR);
    let mut misses = Vec::new();
    let mut grid: Grid<Open> = Grid::new(tolerance);
    let long = |open: &Open| open.ends[0].distance(open.ends[1]) > 2.0 * tolerance;
    for open in boundary(topology).filter(long) {
        let middle = open.ends[0].midpoint(open.ends[1]);
        for near in grid.near(middle) {
            let found = near.iter().take(TRIES).filter_map(|earlier| compare(earlier, &open, tolerance));
            misses.extend(found);
        }
        grid.at(middle).push(open);
    }
    misses.sort_by_key(|miss| miss.edges);
    misses
}

fn boundary(topology: &Topology) -> impl Iterator<Item = Open> {
    let edges = topology.edges.iter().enumerate().filter(|(_, edge)| edge.kind == EdgeKind::Boundary);
    edges.map(|(i, edge)| {
        let ends = edge.points.map(|point| topology.points[point as usize].as_dvec3());
        Open { edge: i as u32, ends }
    })
}

fn compare(a: &Open, b: &Open, tolerance: f64) -> Option<NearMiss> {
    let apart = |x: usize, y: usize| a.ends[0].distance(b.ends[x]).max(a.ends[1].distance(b.ends[y]));
    let (along, against) = (apart(0, 1), apart(1, 0));
    let reversed = against < along;
    let distance = along.min(against);
    (distance <= tolerance).then_some(NearMiss { edges: [a.edge, b.edge], reversed, distance: distance as f32 })
}

/// A mesh in numbers.
#[derive(Clone, Debug, Serialize)]
pub struct Info {
    pub name: String,
    pub triangles: u32,
    /// Triangles left out because two corners lie on one point.
    pub degenerate: u32,
    pub corners: u32,
    pub points: u32,
    pub materials: Vec<MaterialInfo>,
    pub edges: EdgeCounts,
    /// See [`near_misses`].
    pub near_misses: u32,
    pub bounds: BoundsInfo,
    /// Points in use - edges + patches.
    pub euler_characteristic: i64,
    /// Every edge has exactly two sides.
    pub closed: bool,
    pub warnings: Vec<String>,
}

/// A material in numbers.
#[derive(Clone, Debug, Serialize)]
pub struct MaterialInfo {
    pub name: String,
    pub triangles: u32,
    /// Width and height in px, where there is a texture.
    pub texture: Option<[u32; 2]>,
}

/// The bounding box, in object units.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct BoundsInfo {
    pub min: [f32; 3],
    pub max: [f32; 3],
    pub diagonal: f32,
}

impl Info {
    /// Gathers the numbers of a mesh and of the topology built from it.
    pub fn of(mesh: &Mesh, topology: &Topology) -> Self {
        let edges = topology.edge_counts();
        let bounds = mesh.bounds();
        Self {
            name: mesh.name.clone(),
            triangles: mesh.triangles.len() as u32,
            degenerate: topology.degenerate,
            corners: mesh.corners.len() as u32,
            points: topology.points.len() as u32,
            materials: mesh.materials.iter().map(material).collect(),
            edges,
            near_misses: near_misses(topology).len() as u32,
            bounds: BoundsInfo { min: bounds.min.into(), max: bounds.max.into(), diagonal: bounds.diagonal() },
            euler_characteristic: euler_characteristic(topology),
            closed: edges.total() > 0 && edges.boundary == 0 && edges.non_manifold == 0,
            warnings: mesh.warnings.clone(),
        }
    }
}

impl fmt::Display for Info {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let EdgeCounts { smooth, split, seam, boundary, non_manifold } = self.edges;
        writeln!(f, "{}", self.name)?;
        writeln!(f, "triangles     {} ({} degenerate, left out)", self.triangles, self.degenerate)?;
        writeln!(f, "points        {}", self.points)?;
        writeln!(f, "corners       {}", self.corners)?;
        writeln!(f, "edges         {}", self.edges.total())?;
        writeln!(f, "  smooth        {smooth}")?;
        writeln!(f, "  split normal  {split}")?;
        writeln!(f, "  uv seam       {seam}")?;
        writeln!(f, "  boundary      {boundary}")?;
        writeln!(f, "  non-manifold  {non_manifold}")?;
        let closed = if self.closed { "closed" } else { "open" };
        writeln!(f, "surface       {closed}, Euler characteristic {}", self.euler_characteristic)?;
        writeln!(f, "near misses   {} (pairs of open edges that nearly meet)", self.near_misses)?;
        let [x, y, z] = self.bounds.min;
        let [to_x, to_y, to_z] = self.bounds.max;
        writeln!(f, "from          {x} {y} {z} (object units)")?;
        writeln!(f, "to            {to_x} {to_y} {to_z}, diagonal {}", self.bounds.diagonal)?;
        for material in &self.materials {
            let texture = material.texture.map_or_else(String::new, |[w, h]| format!(", texture {w} x {h} px"));
            writeln!(f, "material      {}: {} triangles{texture}", material.name, material.triangles)?;
        }
        for warning in &self.warnings {
            writeln!(f, "warning       {warning}")?;
        }
        Ok(())
    }
}

fn material(material: &super::Material) -> MaterialInfo {
    MaterialInfo {
        name: material.name.clone(),
        triangles: material.triangles.len() as u32,
        texture: material.texture.as_ref().map(|texture| texture.size),
    }
}

/// Points in use - edges + patches: 2 for whatever is like a sphere, 0 for a torus.
fn euler_characteristic(topology: &Topology) -> i64 {
    let mut used = vec![false; topology.points.len()];
    for edge in &topology.edges {
        for point in edge.points {
            used[point as usize] = true;
        }
    }
    let points = used.iter().filter(|used| **used).count();
    points as i64 - topology.edges.len() as i64 + topology.patches.len() as i64
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::mesh::Progress;
    use crate::mesh::shapes::Shape;

    /// A saddle cut in two along x = 0, the right half moved by `offset`.
    fn cut_saddle(offset: Vec3) -> Topology {
        let mut mesh = Shape::Saddle.build();
        let corners = mesh.corners.clone();
        for triangle in &mut mesh.triangles {
            if triangle.iter().all(|&c| corners[c as usize].position.x > -0.01) {
                for c in triangle {
                    let mut corner = corners[*c as usize];
                    corner.position += offset;
                    *c = mesh.corners.len() as u32;
                    mesh.corners.push(corner);
                }
            }
        }
        Topology::build(&mesh, &Progress::new()).unwrap()
    }

    #[test]
    fn a_hairline_cut_is_found() {
        let misses = near_misses(&cut_saddle(Vec3::X * 4e-6));
        assert_eq!(misses.len(), 6, "{misses:?}");
        assert!(misses.iter().all(|miss| miss.distance < 1e-5 && miss.edges[0] < miss.edges[1]));
    }

    #[test]
    fn a_wide_cut_and_no_cut_are_not() {
        assert_eq!(near_misses(&cut_saddle(Vec3::X * 1e-3)), []);
        assert_eq!(near_misses(&cut_saddle(Vec3::ZERO)), []);
        assert_eq!(near_misses(&Topology::default()), []);
    }

    #[test]
    fn info_of_a_torus() {
        let mesh = Shape::Torus.build();
        let info = Info::of(&mesh, &Topology::build(&mesh, &Progress::new()).unwrap());
        assert_eq!((info.triangles, info.points, info.euler_characteristic, info.closed), (256, 128, 0, true));
        assert_eq!((info.materials.len(), info.materials[0].triangles), (1, 256));
        let json = serde_json::to_value(&info).unwrap();
        assert_eq!(json["edges"]["seam"], 24);
    }

    #[test]
    fn info_of_nothing() {
        let info = Info::of(&Mesh::default(), &Topology::default());
        assert_eq!((info.triangles, info.euler_characteristic, info.closed), (0, 0, false));
    }
}
