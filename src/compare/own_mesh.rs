//! What we emit for each patch, to hold another program's triangles against.

use std::collections::HashMap;
use std::ops::Range;

use glam::{DVec3, Vec3};

use crate::tessellate::{FIXED_ONE, PatchFactors, Tessellated, point_count, triangle_count, unpack_normal};

/// Our tessellation, patch by patch.
pub(super) struct OwnMesh<'a> {
    tessellated: &'a Tessellated,
    /// The first vertex and the first triangle of each patch, and the ends.
    starts: Vec<[usize; 2]>,
}

/// What we emit for one patch.
pub(super) struct OwnPatch {
    pub positions: Vec<DVec3>,
    pub normals: Vec<DVec3>,
    /// The weights of the patch's corners 0 and 1.
    pub weights: Vec<[f64; 2]>,
    /// Indices of vertices. Of those that have the same position it is the first, and triangles with two of these are left out.
    pub triangles: Vec<[u32; 3]>,
    /// For each vertex the first one that has the same position.
    pub firsts: Vec<u32>,
}

impl<'a> OwnMesh<'a> {
    pub(super) fn new(tessellated: &'a Tessellated) -> Self {
        let mut starts = vec![[0, 0]];
        let mut end = [0, 0];
        for &factors in &tessellated.patch_factors {
            end = [end[0] + point_count(factors) as usize, end[1] + triangle_count(factors) as usize];
            starts.push(end);
        }
        Self { tessellated, starts }
    }

    pub(super) fn factors(&self, patch: u32) -> PatchFactors {
        self.tessellated.patch_factors[patch as usize]
    }

    /// The number of triangles that we emit for a patch.
    pub(super) fn count(&self, patch: u32) -> usize {
        self.range(patch, 1).len()
    }

    fn range(&self, patch: u32, of: usize) -> Range<usize> {
        self.starts[patch as usize][of]..self.starts[patch as usize + 1][of]
    }

    pub(super) fn patch(&self, patch: u32) -> OwnPatch {
        let vertices = &self.tessellated.vertices[self.range(patch, 0)];
        let base = self.range(patch, 0).start as u32;
        let positions: Vec<DVec3> = vertices.iter().map(|vertex| Vec3::from(vertex.position).as_dvec3()).collect();
        let mut known = HashMap::new();
        let first = |(index, position): (u32, &DVec3)| {
            *known.entry((*position + DVec3::ZERO).to_array().map(f64::to_bits)).or_insert(index)
        };
        let firsts: Vec<u32> = (0..).zip(&positions).map(first).collect();
        let own = self.tessellated.triangles[self.range(patch, 1)].iter();
        let triangles = own.map(|triangle| triangle.map(|vertex| firsts[(vertex - base) as usize]));
        OwnPatch {
            normals: vertices.iter().map(|vertex| unpack_normal(vertex.normal).as_dvec3()).collect(),
            weights: vertices
                .iter()
                .map(|vertex| vertex.domain().map(|weight| f64::from(weight) / f64::from(FIXED_ONE)))
                .collect(),
            triangles: triangles.filter(|[a, b, c]| a != b && b != c && c != a).collect(),
            positions,
            firsts,
        }
    }
}
