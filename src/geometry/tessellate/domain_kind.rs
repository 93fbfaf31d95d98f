//! The shapes of a patch that Direct3D's tessellator knows, and its patterns as lists.

use super::domain::{domain_plan, domain_point, domain_triangle};
use super::factors::{FIXED_ONE, PatchFactors, point_count, triangle_count};
use crate::choice::choices;

choices! {
    /// What a patch is before it is tessellated: the domain of its points (Direct3D 11.3, section 11.7).
    #[derive(Default, Hash)]
    pub enum DomainKind {
        #[default]
        Tri => "tri", "Triangle",
            "A triangle, whose points have the weights u, v and 1 - u - v of its corners.";
        Quad => "quad", "Quad",
            "The unit square, whose points have the places u and v, from 0 to 1.";
        Isoline => "isoline", "Isolines",
            "Lines along u at equal distances in v, of which that at v = 1 is left out.";
    }
}

impl DomainKind {
    /// Returns where a domain point, in 16.16 fixed point, is drawn in a unit square whose second axis points down. A triangle
    /// has U = 1 at the middle of the top, V = 1 at the lower left and W = 1 at the lower right.
    pub fn place(self, point: [u32; 2]) -> [f64; 2] {
        let [u, v] = point.map(|x| f64::from(x) / f64::from(FIXED_ONE));
        match self {
            DomainKind::Tri => [1.0 - v - 0.5 * u, 1.0 - u],
            DomainKind::Quad | DomainKind::Isoline => [u, v],
        }
    }
}

impl PatchFactors {
    /// Returns (U, V) of all domain points of a triangle, in 16.16 fixed point and in the tessellator's order.
    pub fn points(self) -> Vec<[u32; 2]> {
        let plan = domain_plan(self);
        (0..point_count(self)).map(|i| domain_point(&plan, i)).collect()
    }

    /// Returns the corners of all triangles, as point numbers, clockwise, in the tessellator's order.
    pub fn triangles(self) -> Vec<[u32; 3]> {
        let plan = domain_plan(self);
        (0..triangle_count(self)).map(|t| domain_triangle(&plan, t)).collect()
    }
}
