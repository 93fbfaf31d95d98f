// Conventions between hull and domain shader: which edge each tessellation factor is for, and which corner each
// barycentric weight belongs to. Twin: src/geometry/tessellate/convention.rs. Side k of a patch runs from corner k to corner k +
// 1.

// Returns the side (0 to 2) whose factor the hull shader writes as factor `i` (0 to 2).
fn factor_side(convention: u32, i: u32) -> u32 {
    if convention == CONVENTION_D3D11 {
        return (i + 1u) % 3u;
    }
    if convention == CONVENTION_AMD_PN {
        return (i + 2u) % 3u;
    }
    if convention == CONVENTION_MIRRORED {
        return (5u - i) % 3u;
    }
    return i;
}

// Returns the corner (0 to 2) that the domain shader multiplies by weight `i` (0, 1, 2 for u, v, w).
fn weight_corner(convention: u32, i: u32) -> u32 {
    if convention == CONVENTION_AMD_PN {
        return (i + 1u) % 3u;
    }
    if convention == CONVENTION_EDGE_ORDER {
        return (i + 2u) % 3u;
    }
    return i;
}

// Returns the side that the tessellator cuts by factor `i` in the domain shader's order: the side opposite the corner
// that weight `i` belongs to.
fn domain_side(convention: u32, i: u32) -> u32 {
    return (weight_corner(convention, i) + 1u) % 3u;
}

// Returns the weights of corners 0 and 1 for a domain point that the tessellator gives as U and V. All are 16.16 fixed
// point; the weight of corner 2 is the rest of 1.
fn corner_weights(convention: u32, domain: vec2<u32>) -> vec2<u32> {
    let w = FIXED_ONE - domain.x - domain.y;
    if convention == CONVENTION_AMD_PN {
        return vec2<u32>(w, domain.x);
    }
    if convention == CONVENTION_EDGE_ORDER {
        return vec2<u32>(domain.y, w);
    }
    return domain;
}
