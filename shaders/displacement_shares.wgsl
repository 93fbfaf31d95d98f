// Reads what patches share where they are displaced. The module declares the buffers `params`, `points`, `patches`,
// `corners` and `shares`; see Share in types.wgsl.

// Returns the dominant side and the mip level of a factor's edge.
fn share_of_factor(index: u32) -> Share {
    return shares[params.point_count + index];
}

// Returns the gradient of texture coordinate 0 or 1 at a corner.
fn corner_gradient(corner: u32, coordinate: u32) -> vec3<f32> {
    return shares[params.point_count + params.factor_count + 2u * corner + coordinate].direction;
}

// Returns the texture coordinates of a patch's corners.
fn patch_uvs(patch_index: u32) -> array<vec2<f32>, 3> {
    let at = patches[patch_index].corners;
    return array<vec2<f32>, 3>(corners[at[0]].uv, corners[at[1]].uv, corners[at[2]].uv);
}

// The directions in which a patch's corners move: those of their points, or as published the corners' own normals.
fn corner_directions(patch_index: u32) -> array<vec3<f32>, 3> {
    let own = patches[patch_index];
    if params.displacement == DISPLACEMENT_ON {
        return array<vec3<f32>, 3>(
            shares[own.points[0]].direction,
            shares[own.points[1]].direction,
            shares[own.points[2]].direction,
        );
    }
    return array<vec3<f32>, 3>(
        corners[own.corners[0]].normal,
        corners[own.corners[1]].normal,
        corners[own.corners[2]].normal,
    );
}
