//! A reference surface as triangles that are near it.

use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::Surface;
use geometry::casts::to_u32;
use geometry::near::{Soup, TriangleTree};

/// Triangles that are a reference surface, or within a known distance of it.
#[derive(Clone)]
pub struct Facets {
    pub tree: Arc<TriangleTree>,
    positions: Arc<[Vec3]>,
    triangles: Arc<Vec<[u32; 3]>>,
    /// No point of the surface is farther from the triangles, and none of theirs from the surface, in object units.
    pub sag: f64,
}

impl Facets {
    /// Takes the triangles of a mesh. `None` if there is none.
    pub(super) fn from_mesh(positions: Arc<[Vec3]>, triangles: Arc<Vec<[u32; 3]>>) -> Option<Self> {
        let corners = triangles.iter().map(|triangle| triangle.map(|corner| positions[corner as usize]));
        let tree = Arc::new(TriangleTree::new(corners)?);
        Some(Self { tree, positions, triangles, sag: 0.0 })
    }

    /// Cuts an exact surface into triangles that are at most `sag` away from it, or farther if they would be more than
    /// about `most`.
    pub(super) fn new(surface: &dyn Surface, sag: f64, most: u64) -> Self {
        let grids: Vec<Grid> = (0..surface.charts()).map(|chart| Grid::new(surface.bends(chart), sag)).collect();
        let count: f64 = grids.iter().map(Grid::triangles).sum();
        let coarser = (count / most as f64).max(1.0).sqrt();
        let grids: Vec<Grid> = grids.into_iter().map(|grid| grid.coarser(coarser)).collect();
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        for (chart, grid) in grids.iter().enumerate() {
            grid.add(|s, t| surface.at(chart, s, t).0.point, &mut positions, &mut triangles);
        }
        let [min, max] = surface.extent();
        // Positions are rounded to f32.
        let rounding = DVec3::ONE.length() * min.abs().max(max.abs()).max_element() * f64::from(f32::EPSILON) / 2.0;
        let sag = grids.iter().map(Grid::sag).fold(0.0, f64::max) + rounding;
        let facets = Self::from_mesh(positions.into(), Arc::new(triangles));
        Self { sag, ..facets.expect("every chart has a triangle") }
    }

    pub(crate) fn soup(&self) -> Soup<'_> {
        Soup { positions: &self.positions, triangles: &self.triangles }
    }
}

/// How a chart is cut: the number of segments along both parameters.
struct Grid {
    segments: [f64; 2],
    /// The largest lengths of the second derivatives by s twice, by s and t, and by t twice.
    bends: [f64; 3],
}

impl Grid {
    fn new(bends: [f64; 3], sag: f64) -> Self {
        // Both parameters get half of the sag; the derivative by both may need more.
        let segments = [bends[0], bends[2]].map(|bend| (bend / (4.0 * sag)).sqrt().max(1.0));
        let grid = Self { segments, bends };
        let finer = (grid.sag() / sag).max(1.0).sqrt();
        grid.coarser(1.0 / finer)
    }

    fn coarser(self, by: f64) -> Self {
        Self { segments: self.segments.map(|count| (count / by).ceil().max(1.0)), ..self }
    }

    fn triangles(&self) -> f64 {
        2.0 * self.segments[0] * self.segments[1]
    }

    /// How far the triangles are from the surface. Between the corners of a triangle, what is linear misses a function by at
    /// most half of its second derivative along each way to a corner, weighted as the corners are (Taylor's theorem); over
    /// the halves of a cell this is an eighth of the sum below.
    fn sag(&self) -> f64 {
        let ([s, t], [ss, st, tt]) = (self.segments.map(f64::recip), self.bends);
        (ss * s * s + 2.0 * st * s * t + tt * t * t) / 8.0
    }

    fn add(&self, at: impl Fn(f64, f64) -> DVec3, positions: &mut Vec<Vec3>, triangles: &mut Vec<[u32; 3]>) {
        let [columns, rows] = self.segments.map(|count| count as u32);
        let first = to_u32(positions.len());
        for i in 0..=columns {
            let s = f64::from(i) / f64::from(columns);
            positions.extend((0..=rows).map(|j| at(s, f64::from(j) / f64::from(rows)).as_vec3()));
        }
        for i in 0..columns {
            for j in 0..rows {
                let a = first + i * (rows + 1) + j;
                let [b, c, d] = [a + 1, a + rows + 1, a + rows + 2];
                triangles.extend([[a, c, d], [a, d, b]]);
            }
        }
    }
}
