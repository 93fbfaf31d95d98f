// How a patch's surface curves, without displacement. Twin: src/geometry/tessellate/curvature.rs.

// Returns a curvature of a patch at weights `u` and `v` (16.16 fixed point; w = 1 - u - v): see principal_curvatures.
fn patch_curvature(kind: u32, surface: u32, net: ControlNet, u: u32, v: u32) -> f32 {
    let second = patch_second_derivatives(surface, net, u, v);
    let principal = principal_curvatures(patch_tangents(surface, net, u, v), second);
    if kind == CURVATURE_MEAN {
        return 0.5 * (principal.x + principal.y);
    }
    if kind == CURVATURE_GAUSSIAN {
        return principal.x * principal.y;
    }
    return select(principal.y, principal.x, kind == CURVATURE_LARGEST);
}

// Returns the second derivatives of a patch's position at weights `u` and `v` (16.16 fixed point; w = 1 - u - v), in
// object units: twice by u, by u and v, and twice by v. They are linear Bézier triangles of second differences of
// control points, times 6 (Farin, Triangular Bernstein-Bézier patches, 1986, section 1.4).
fn patch_second_derivatives(surface: u32, net: ControlNet, u: u32, v: u32) -> array<vec3<f32>, 3> {
    if surface == SURFACE_FLAT {
        return array<vec3<f32>, 3>(vec3<f32>(0.0), vec3<f32>(0.0), vec3<f32>(0.0));
    }
    let x = f32(u) * UNIT;
    let y = f32(v) * UNIT;
    let z = f32(FIXED_ONE - u - v) * UNIT;
    let b300 = net.corners[0];
    let b030 = net.corners[1];
    let b003 = net.corners[2];
    let b210 = net.edges[0];
    let b120 = net.edges[1];
    let b021 = net.edges[2];
    let b012 = net.edges[3];
    let b102 = net.edges[4];
    let b201 = net.edges[5];
    let b111 = net.center;
    let by_uu = ((b300 - b201) - (b201 - b102)) * x
        + ((b210 - b111) - (b111 - b012)) * y
        + ((b201 - b102) - (b102 - b003)) * z;
    let by_uv = ((b210 - b201) - (b111 - b102)) * x
        + ((b120 - b111) - (b021 - b012)) * y
        + ((b111 - b102) - (b012 - b003)) * z;
    let by_vv = ((b120 - b111) - (b111 - b102)) * x
        + ((b030 - b021) - (b021 - b012)) * y
        + ((b021 - b012) - (b012 - b003)) * z;
    return array<vec3<f32>, 3>(by_uu * 6.0, by_uv * 6.0, by_vv * 6.0);
}

// Returns the principal curvatures of a surface with these first and second derivatives, the larger one first, in
// 1 / object unit. Both are above 0 where the surface bulges towards the side that it faces, and 0 where it has no tangent
// plane.
//
// Their mean is (E N - 2 F M + G L) / (2 (E G - F²)) in the coefficients of both fundamental forms (do Carmo, Differential
// geometry of curves and surfaces, 1976, section 3-3). How far they are from it follows from the curvature L / E along the
// first tangent, and from the twist there: their squares add up as on Mohr's circle.
fn principal_curvatures(tangents: array<vec3<f32>, 2>, second: array<vec3<f32>, 3>) -> vec2<f32> {
    // At this size products of derivatives neither underflow nor overflow.
    let largest = max(abs(tangents[0]), abs(tangents[1]));
    let size = max(max(largest.x, largest.y), largest.z);
    if size == 0.0 {
        return vec2<f32>(0.0);
    }
    let scale = 1.0 / size;
    let along_u = tangents[0] * scale;
    let along_v = tangents[1] * scale;
    let across = cross(along_u, along_v);
    // E G - F², by Lagrange's identity.
    let area_squared = dot(across, across);
    if area_squared <= FLAT_ANGLE * FLAT_ANGLE {
        return vec2<f32>(0.0);
    }
    let area = sqrt(area_squared);
    let normal = across * (1.0 / area);
    let by_uu = dot(normal, second[0] * scale);
    let by_uv = dot(normal, second[1] * scale);
    let by_vv = dot(normal, second[2] * scale);
    let uu = dot(along_u, along_u);
    let uv = dot(along_u, along_v);
    let mean = (uu * by_vv - 2.0 * uv * by_uv + dot(along_v, along_v) * by_uu) / (2.0 * area_squared);
    let own = by_uu / uu;
    let aside = length(vec2<f32>(own - mean, (by_uv - uv * own) / area));
    // The normal of a sphere points away from where its derivatives do.
    return vec2<f32>(aside - mean, -(aside + mean)) * scale;
}

// Tangents that span less area, with the longer coordinate at 1, are parallel.
const FLAT_ANGLE: f32 = 1e-6;
