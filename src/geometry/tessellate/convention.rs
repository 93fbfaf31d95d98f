//! Conventions between hull and domain shader: which edge each tessellation factor is for, and which corner each
//! barycentric weight belongs to. Twin: `shaders/convention.wgsl`.
//!
//! The tessellator knows neither edges nor corners. Its factor i cuts the edge on which weight i is 0. A hull shader
//! decides which side's factor it writes as factor i, and a domain shader decides which corner it multiplies by weight
//! i. Every order works if both shaders use the same one. Otherwise edges get the factors of other edges, and the mesh
//! cracks.
//!
//! Side k of a patch runs from corner k to corner k + 1 (modulo 3).

use crate::choice::choices;

choices! {
    /// What a hull shader and a domain shader take factors and weights for.
    #[derive(Default, Hash)]
    #[repr(u32)]
    pub enum Convention {
        #[default]
        D3d11 => "d3d11", "Direct3D 11",
            "As in Direct3D 11, Vulkan and the white paper: weights u, v, w belong to corners 0, 1, 2, and \
             TessFactor[0..2] to the edges opposite them.";
        AmdPn => "amd-pn", "AMD PN sample",
            "As in AMD's PN triangles sample for Direct3D 11: weights w, u, v belong to corners 0, 1, 2, and \
             TessFactor[0..2] to the edges opposite u, v and w.";
        EdgeOrder => "edge-order", "Edge order",
            "TessFactor[0..2] belong to the edges (0, 1), (1, 2), (2, 0), and weights v, w, u to corners 0, 1, 2.";
        Rotated => "rotated", "Rotated (mistake)",
            "Factors in edge order, but weights as in Direct3D 11. Every edge gets the factor of another edge, and \
             adaptive LOD cracks.";
        Mirrored => "mirrored", "Mirrored (mistake)",
            "As in Direct3D 11, but with the first two factors exchanged, as if triangles were wound the other way. \
             Adaptive LOD cracks.";
    }
}

impl Convention {
    /// Returns whether both shaders agree, so that every edge gets its own factor.
    pub fn is_consistent(self) -> bool {
        (0..3).all(|i| factor_side(self, i) == domain_side(self, i))
    }

    /// Inverts [`corner_weights`]: returns the tessellator's U and V for the weights of corners 0 and 1, in 16.16 fixed
    /// point.
    pub fn domain_weights(self, [a, b]: [u32; 2]) -> [u32; 2] {
        let on_corners = [a, b, super::FIXED_ONE - a - b];
        [0, 1].map(|i| on_corners[weight_corner(self, i) as usize])
    }
}

/// Returns the side (0 to 2) whose factor the hull shader writes as factor `i` (0 to 2).
pub fn factor_side(convention: Convention, i: u32) -> u32 {
    match convention {
        Convention::D3d11 => (i + 1) % 3,
        Convention::AmdPn => (i + 2) % 3,
        Convention::EdgeOrder | Convention::Rotated => i,
        Convention::Mirrored => (5 - i) % 3,
    }
}

/// Returns the corner (0 to 2) that the domain shader multiplies by weight `i` (0, 1, 2 for u, v, w).
pub fn weight_corner(convention: Convention, i: u32) -> u32 {
    match convention {
        Convention::AmdPn => (i + 1) % 3,
        Convention::EdgeOrder => (i + 2) % 3,
        Convention::D3d11 | Convention::Rotated | Convention::Mirrored => i,
    }
}

/// Returns the side that the tessellator cuts by factor `i` in the domain shader's order: the side opposite the corner
/// that weight `i` belongs to.
pub fn domain_side(convention: Convention, i: u32) -> u32 {
    (weight_corner(convention, i) + 1) % 3
}

/// Returns the weights of corners 0 and 1 for a domain point that the tessellator gives as U and V. All are 16.16 fixed
/// point; the weight of corner 2 is the rest of 1.
pub fn corner_weights(convention: Convention, [u, v]: [u32; 2]) -> [u32; 2] {
    let w = super::FIXED_ONE - u - v;
    match convention {
        Convention::AmdPn => [w, u],
        Convention::EdgeOrder => [v, w],
        Convention::D3d11 | Convention::Rotated | Convention::Mirrored => [u, v],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn consistent_conventions_give_every_edge_its_own_factor_and_the_two_mistakes_do_not() {
        assert_eq!(Convention::ALL.map(Convention::is_consistent), [true, true, true, false, false]);
    }

    #[test]
    fn every_side_and_every_corner_is_used_once() {
        for convention in Convention::ALL {
            let mut sides = [0, 1, 2].map(|i| factor_side(convention, i));
            let mut corners = [0, 1, 2].map(|i| weight_corner(convention, i));
            sides.sort_unstable();
            corners.sort_unstable();
            assert_eq!((sides, corners), ([0, 1, 2], [0, 1, 2]), "{convention:?}");
        }
    }

    #[test]
    fn corner_weights_follow_weight_corner() {
        for convention in Convention::ALL {
            let weights = [1, 2, crate::tessellate::FIXED_ONE - 3];
            let mut on_corners = [0; 3];
            for i in 0..3 {
                on_corners[weight_corner(convention, i as u32) as usize] = weights[i];
            }
            assert_eq!(corner_weights(convention, [1, 2]), on_corners[..2], "{convention:?}");
        }
    }

    #[test]
    fn domain_weights_invert_corner_weights() {
        for convention in Convention::ALL {
            for domain in [[0, 0], [65536, 0], [1, 2], [20000, 30000]] {
                assert_eq!(convention.domain_weights(corner_weights(convention, domain)), domain, "{convention:?}");
            }
        }
    }

    #[test]
    fn direct3d_and_amd_conventions_are_as_their_documentation_says() {
        // Sides 0, 1, 2 are the edges (0, 1), (1, 2), (2, 0).
        assert_eq!([0, 1, 2].map(|i| factor_side(Convention::D3d11, i)), [1, 2, 0]);
        assert_eq!([0, 1, 2].map(|i| factor_side(Convention::AmdPn, i)), [2, 0, 1]);
        assert_eq!(corner_weights(Convention::AmdPn, [1, 2]), [65533, 1], "w on corner 0, u on 1, v on 2");
        assert_eq!(corner_weights(Convention::D3d11, [1, 2]), [1, 2]);
    }
}
