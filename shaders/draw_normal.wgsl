// Normals that draws evaluate at pixels, from the formula that gave vertices theirs: see pass_emit.wgsl.

@group(0) @binding(1) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> corners: array<Corner>;
@group(0) @binding(3) var<storage, read> patches: array<Patch>;
@group(0) @binding(7) var<storage, read> curve_nets: array<CurveNet>;
// What the passes were given. A software driver compiles the shader for each surface and kind of normals.
@group(0) @binding(8) var<uniform> params: Params;

// Whether normals are evaluated at pixels, where vertices have some.
override NORMALS_AT_PIXELS: bool = false;

// Returns weights u and v from 0 to 1 in 16.16 fixed point. At a triangle's border the middle of a pixel may lie outside the
// patch. The nearest place on its border is returned there.
fn patch_place(weights: vec2<f32>) -> vec2<u32> {
    let inside = max(vec3<f32>(weights, 1.0 - weights.x - weights.y), vec3<f32>(0.0));
    let scaled = inside.xy / (inside.x + inside.y + inside.z) * f32(FIXED_ONE);
    let u = min(u32(scaled.x + 0.5), FIXED_ONE);
    return vec2<u32>(u, min(u32(scaled.y + 0.5), FIXED_ONE - u));
}

// Returns the unit normal of a patch that isn't displaced, at weights u and v from 0 to 1.
fn pixel_normal(patch_index: u32, weights: vec2<f32>) -> vec3<f32> {
    let place = patch_place(weights);
    let u = place.x;
    let v = place.y;
    let own = patches[patch_index];
    let normals = array<vec3<f32>, 3>(
        corners[own.corners[0]].normal,
        corners[own.corners[1]].normal,
        corners[own.corners[2]].normal,
    );
    if params.normals == NORMALS_QUADRATIC {
        let at =
            array<vec3<f32>, 3>(points[own.points[0]].xyz, points[own.points[1]].xyz, points[own.points[2]].xyz);
        return quadratic_normal(at, normals, u, v);
    }
    let linear = linear_normal(normals, u, v);
    if params.normals == NORMALS_SURFACE {
        return surface_normal(params.surface, load_net(patch_index), u, v, linear);
    }
    return linear;
}

// The normal of a pixel, of which vertices gave `own`.
fn drawn_normal(own: vec3<f32>, patch_index: u32, weights: vec2<f32>) -> vec3<f32> {
    if NORMALS_AT_PIXELS {
        return pixel_normal(patch_index, weights);
    }
    return own;
}
