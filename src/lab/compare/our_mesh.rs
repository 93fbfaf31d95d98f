//! What we emit for each patch, to hold another program's triangles against.

use std::collections::HashMap;
use std::ops::Range;

use glam::{DVec3, Vec3};

use geometry::mesh::weld::weld_alike;
use geometry::tessellate::{Tessellated, Vertex, point_count, triangle_count, unpack_normal};

/// Our tessellation, patch by patch.
pub(super) struct OurMesh<'a> {
    pub tessellated: &'a Tessellated,
    /// For each vertex the number of its point. Vertices that can't be told apart have the same.
    points: Vec<u32>,
    /// The first vertex and the first triangle of each patch, and the ends.
    starts: Vec<[usize; 2]>,
}

/// What we emit for one patch.
pub(super) struct OurPatch {
    pub positions: Vec<DVec3>,
    pub normals: Vec<DVec3>,
    /// The weights of the patch's corners 0 and 1.
    pub weights: Vec<[f64; 2]>,
    /// Indices of vertices. Of those that can't be told apart it is the first, and triangles with two of these are left out.
    pub triangles: Vec<[u32; 3]>,
    /// For each vertex the first one that it can't be told apart from.
    pub firsts: Vec<u32>,
}

impl OurPatch {
    /// How far positions move at most for a change of a weight, in object units: over the longest way along a triangle's side.
    pub(super) fn stretch(&self) -> f64 {
        let of_side = |[a, b]: [u32; 2]| {
            let [a, b] = [a as usize, b as usize];
            let [u, v] = [0, 1].map(|k| (self.weights[a][k] - self.weights[b][k]).abs());
            self.positions[a].distance(self.positions[b]) / u.max(v)
        };
        let sides = self.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        sides.map(of_side).filter(|stretch| stretch.is_finite()).fold(0.0, f64::max)
    }
}

/// Whether two of a triangle's corners can't be told apart.
pub(super) fn is_thin<T: PartialEq>([a, b, c]: [T; 3]) -> bool {
    a == b || b == c || c == a
}

/// A triangle without the order of its corners.
pub(super) fn sorted<T: Ord>(mut triangle: [T; 3]) -> [T; 3] {
    triangle.sort_unstable();
    triangle
}

impl<'a> OurMesh<'a> {
    /// Positions within `tolerance` object units can't be told apart.
    pub(super) fn new(tessellated: &'a Tessellated, tolerance: f64) -> Self {
        let vertices = &tessellated.vertices;
        let (_, points) = weld_alike(vertices.len(), |i| (vertices[i].position.into(), 0), tolerance);
        let mut starts = vec![[0, 0]];
        let mut end = [0, 0];
        for &factors in &tessellated.patch_factors {
            end = [end[0] + point_count(factors) as usize, end[1] + triangle_count(factors) as usize];
            starts.push(end);
        }
        Self { tessellated, points, starts }
    }

    /// Whether we emit triangles for a patch whose corners can be told apart.
    pub(super) fn emits(&self, patch: u32) -> bool {
        let is_seen = |triangle: &[u32; 3]| !is_thin(triangle.map(|vertex| self.points[vertex as usize]));
        self.tessellated.triangles[self.range(patch, 1)].iter().any(is_seen)
    }

    fn range(&self, patch: u32, of: usize) -> Range<usize> {
        self.starts[patch as usize][of]..self.starts[patch as usize + 1][of]
    }

    pub(super) fn patch(&self, patch: u32) -> OurPatch {
        let vertices = &self.tessellated.vertices[self.range(patch, 0)];
        let base = self.range(patch, 0).start as u32;
        let positions: Vec<DVec3> = vertices.iter().map(|vertex| Vec3::from(vertex.position).as_dvec3()).collect();
        let mut known = HashMap::new();
        let first = |(index, point): (u32, &u32)| *known.entry(*point).or_insert(index);
        let firsts: Vec<u32> = (0..).zip(&self.points[self.range(patch, 0)]).map(first).collect();
        let own = self.tessellated.triangles[self.range(patch, 1)].iter();
        let triangles = own.map(|triangle| triangle.map(|vertex| firsts[(vertex - base) as usize]));
        OurPatch {
            normals: vertices.iter().map(|vertex| unpack_normal(vertex.normal).as_dvec3()).collect(),
            weights: vertices.iter().map(Vertex::exact_domain).collect(),
            triangles: triangles.filter(|triangle| !is_thin(*triangle)).collect(),
            positions,
            firsts,
        }
    }
}
