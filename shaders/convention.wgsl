// Which edge each factor belongs to, and which corner each weight. Twin: src/tessellate/convention.rs.

const CONVENTION_D3D11: u32 = 0u;
const CONVENTION_AMD_PN: u32 = 1u;
const CONVENTION_EDGE_ORDER: u32 = 2u;
const CONVENTION_ROTATED: u32 = 3u;
const CONVENTION_MIRRORED: u32 = 4u;

// The side (k runs from corner k to corner k + 1) whose factor the hull shader writes as factor i.
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

// The corner that the domain shader weighs with weight i: u, v, w.
fn weight_corner(convention: u32, i: u32) -> u32 {
    if convention == CONVENTION_AMD_PN {
        return (i + 1u) % 3u;
    }
    if convention == CONVENTION_EDGE_ORDER {
        return (i + 2u) % 3u;
    }
    return i;
}

// The side on which the domain shader puts the edge that the tessellator cuts by factor i.
fn domain_side(convention: u32, i: u32) -> u32 {
    return (weight_corner(convention, i) + 1u) % 3u;
}

// U and V on corners 0 and 1 of what the tessellator gives as U and V.
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
