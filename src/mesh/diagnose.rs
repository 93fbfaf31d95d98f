//! What a person should know about a mesh before tessellating it.

use std::collections::HashMap;
use std::fmt;

use glam::{DVec3, Vec3};
use serde::Serialize;

use super::{EdgeCounts, EdgeKind, Mesh, Topology};

/// Ends closer than this share of the diagonal nearly meet.
const NEAR: f64 = 1e-5;

/// Two open edges whose ends nearly meet: a seam that isn't quite closed. Indices of [`Topology::edges`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NearMiss {
    pub edges: [u32; 2],
}

/// Open edges whose ends lie within 1e-5 of the diagonal of another open edge's ends. Near linear, unless very many lie
/// in one place.
pub fn near_misses(mesh: &Mesh, topology: &Topology) -> Vec<NearMiss> {
    let reach = NEAR * f64::from(mesh.bounds().diagonal());
    if !(reach > 0.0 && reach.is_finite()) {
        return Vec::new();
    }
    let open: Vec<u32> = (0..)
        .zip(&topology.edges)
        .filter(|(_, edge)| edge.kind == EdgeKind::Boundary)
        .map(|(index, _)| index)
        .collect();
    let ends = |edge: u32| topology.edges[edge as usize].points.map(|p| topology.points[p as usize].as_dvec3());
    // Middles of edges whose ends are within reach are within reach too: they lie in neighbouring cells.
    let cell = |middle: DVec3| (middle / reach).floor().as_i64vec3();
    let middle = |edge: u32| (ends(edge)[0] + ends(edge)[1]) * 0.5;
    let mut cells: HashMap<_, Vec<u32>> = HashMap::new();
    let mut found = Vec::new();
    for &edge in &open {
        let home = cell(middle(edge));
        for offset in 0..27 {
            let at = home + glam::i64vec3(offset % 3 - 1, offset / 3 % 3 - 1, offset / 9 - 1);
            let near = cells.get(&at).into_iter().flatten();
            let meet = near.filter(|&&other| ends_meet(ends(edge), ends(other), reach));
            found.extend(meet.map(|&other| NearMiss { edges: [other, edge] }));
        }
        cells.entry(home).or_default().push(edge);
    }
    found
}

fn ends_meet([a, b]: [DVec3; 2], [c, d]: [DVec3; 2], reach: f64) -> bool {
    let within = |x: DVec3, y: DVec3| x.distance(y) <= reach;
    (within(a, c) && within(b, d)) || (within(a, d) && within(b, c))
}

/// What `pnaen info` says.
#[derive(Clone, Debug, Serialize)]
pub struct Info {
    pub name: String,
    pub triangles: usize,
    pub degenerate: u32,
    pub patches: usize,
    pub points: usize,
    pub corners: usize,
    pub edges: EdgeCounts,
    /// No edge with one side.
    pub closed: bool,
    /// Points - edges + patches.
    pub euler_characteristic: i64,
    pub near_misses: usize,
    /// Object units.
    pub min: [f32; 3],
    pub max: [f32; 3],
    pub diagonal: f32,
    pub materials: Vec<MaterialInfo>,
    pub warnings: Vec<String>,
}

#[derive(Clone, Debug, Serialize)]
pub struct MaterialInfo {
    pub name: String,
    pub triangles: u32,
    /// Linear RGBA.
    pub base_color: [f32; 4],
    /// Width and height in px.
    pub texture: Option<[u32; 2]>,
}

impl Info {
    pub fn of(mesh: &Mesh, topology: &Topology) -> Self {
        let bounds = mesh.bounds();
        let [points, edges, patches] = [topology.points.len(), topology.edges.len(), topology.patches.len()];
        let counts = topology.edge_counts();
        let materials = mesh.materials.iter().map(|material| MaterialInfo {
            name: material.name.clone(),
            triangles: material.triangles.end - material.triangles.start,
            base_color: material.base_color,
            texture: material.texture.as_ref().map(|texture| texture.size),
        });
        Self {
            name: mesh.name.clone(),
            triangles: mesh.triangles.len(),
            degenerate: topology.degenerate,
            patches,
            points,
            corners: mesh.corners.len(),
            edges: counts,
            closed: counts.boundary == 0 && edges > 0,
            euler_characteristic: points as i64 - edges as i64 + patches as i64,
            near_misses: near_misses(mesh, topology).len(),
            min: bounds.min.to_array(),
            max: bounds.max.to_array(),
            diagonal: bounds.diagonal(),
            materials: materials.collect(),
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
        writeln!(f, "edges         {}", smooth + split + seam + boundary + non_manifold)?;
        writeln!(f, "  smooth        {smooth}")?;
        writeln!(f, "  split normal  {split}")?;
        writeln!(f, "  uv seam       {seam}")?;
        writeln!(f, "  boundary      {boundary}")?;
        writeln!(f, "  non-manifold  {non_manifold}")?;
        let closed = if self.closed { "closed" } else { "open" };
        writeln!(f, "surface       {closed}, Euler characteristic {}", self.euler_characteristic)?;
        writeln!(f, "near misses   {} (pairs of open edges that nearly meet)", self.near_misses)?;
        let [min, max] = [self.min, self.max].map(Vec3::from);
        writeln!(f, "box           {min} to {max}, diagonal {} object units", self.diagonal)?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Corner, Progress, Shape, merge};
    use glam::{Vec2, vec3};

    fn near(gap: f32) -> usize {
        let corner = |position| Corner { position, normal: Vec3::Y, uv: Vec2::ZERO };
        let left = [Vec3::ZERO, Vec3::Z, -Vec3::X].map(corner);
        let right = [vec3(gap, 0.0, 0.0), vec3(1.0, 0.0, 0.0), vec3(gap, 0.0, 1.0)].map(corner);
        let mesh = merge::from_triangles("two", [left, right].into_iter());
        let topology = Topology::build(&mesh, &Progress::default()).expect("nobody cancels");
        near_misses(&mesh, &topology).len()
    }

    #[test]
    fn edges_that_nearly_meet_are_found_and_others_are_not() {
        // The diagonal is about the square root of 5.
        assert_eq!([near(0.0), near(1e-6), near(2.2e-5), near(2.4e-5), near(0.1)], [0, 1, 1, 0, 0]);
    }

    #[test]
    fn shapes_are_described() {
        let mesh = Shape::Torus.build();
        let topology = Topology::build(&mesh, &Progress::default()).expect("nobody cancels");
        let info = Info::of(&mesh, &topology);
        assert_eq!((info.closed, info.euler_characteristic, info.near_misses), (true, 0, 0));
        assert_eq!((info.points, info.edges.seam), (128, 24));
        let text = info.to_string();
        assert!(text.contains("uv seam       24") && text.contains("closed, Euler characteristic 0"), "{text}");
    }
}
