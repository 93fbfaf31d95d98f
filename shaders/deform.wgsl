// Linear blend skinning: a corner's position, normal and tangent are transformed by the weighted mean of its joints' matrices.
// Twin: src/geometry/tessellate/deform.rs.

// A corner at rest: what morph targets and joints are applied to.
struct Binding {
    position: vec3<f32>,
    // The corner's first element of `deltas`, of which it has `delta_count`.
    first_delta: u32,
    normal: vec3<f32>,
    delta_count: u32,
    joints: vec4<u32>,
    weights: vec4<f32>,
}

// What a morph target of weight 1 adds to a corner. `weight` is the index of the target's weight, and `tangent` that of what the target
// adds to the corner's tangent; 0 if the tangent turns along with the normal.
struct Delta {
    position: vec3<f32>,
    weight: u32,
    normal: vec3<f32>,
    tangent: u32,
}

// The first three rows of an affine matrix, whose fourth row is (0, 0, 0, 1).
struct JointMatrix {
    x: vec4<f32>,
    y: vec4<f32>,
    z: vec4<f32>,
}

// Returns the weighted sum of four matrices. The weights add up to 1.
fn blend(a: JointMatrix, b: JointMatrix, c: JointMatrix, d: JointMatrix, weights: vec4<f32>) -> JointMatrix {
    return JointMatrix(
        a.x * weights.x + b.x * weights.y + c.x * weights.z + d.x * weights.w,
        a.y * weights.x + b.y * weights.y + c.y * weights.z + d.y * weights.w,
        a.z * weights.x + b.z * weights.y + c.z * weights.z + d.z * weights.w,
    );
}

// Transforms a position.
fn deform_position(matrix: JointMatrix, position: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        dot(matrix.x.xyz, position) + matrix.x.w,
        dot(matrix.y.xyz, position) + matrix.y.w,
        dot(matrix.z.xyz, position) + matrix.z.w,
    );
}

// Transforms a unit normal by the cofactor matrix. If the result has no direction, returns `normal` itself.
fn deform_normal(matrix: JointMatrix, normal: vec3<f32>) -> vec3<f32> {
    let rows = scaled_rows(matrix);
    let x = rows[0];
    let y = rows[1];
    let z = rows[2];
    let turned = vec3<f32>(dot(cross(y, z), normal), dot(cross(z, x), normal), dot(cross(x, y), normal));
    return scaled_unit_or(turned * select(1.0, -1.0, dot(x, cross(y, z)) < 0.0), normal);
}

// Transforms a unit tangent, whose w is the sign of the bitangent: a matrix that mirrors turns that around. If the result has
// no direction, returns the tangent itself.
fn deform_tangent(matrix: JointMatrix, tangent: vec4<f32>) -> vec4<f32> {
    let rows = scaled_rows(matrix);
    let x = rows[0];
    let y = rows[1];
    let z = rows[2];
    let turned = vec3<f32>(dot(x, tangent.xyz), dot(y, tangent.xyz), dot(z, tangent.xyz));
    let sign = tangent.w * select(1.0, -1.0, dot(x, cross(y, z)) < 0.0);
    return vec4<f32>(scaled_unit_or(turned, tangent.xyz), sign);
}

// Turns a vector by the least rotation that takes one unit vector to another (Möller and Hughes 1999). Returns the vector itself if
// the two are opposite.
fn turn_along(vector: vec3<f32>, start: vec3<f32>, end: vec3<f32>) -> vec3<f32> {
    let axis = cross(start, end);
    let cosine = dot(start, end);
    if 1.0 + cosine < 1e-6 {
        return vector;
    }
    let across = cross(axis, vector);
    return vector + across + cross(axis, across) * (1.0 / (1.0 + cosine));
}

// Returns the rows of the linear part, scaled so that no product of two entries overflows or underflows.
fn scaled_rows(matrix: JointMatrix) -> array<vec3<f32>, 3> {
    let largest_xy = max(largest_component(matrix.x.xyz), largest_component(matrix.y.xyz));
    let scale = 1.0 / max(largest_xy, max(largest_component(matrix.z.xyz), 1e-30));
    return array<vec3<f32>, 3>(matrix.x.xyz * scale, matrix.y.xyz * scale, matrix.z.xyz * scale);
}

// Returns `vector` at unit length, or `otherwise` if it is zero. No square overflows or underflows.
fn scaled_unit_or(vector: vec3<f32>, otherwise: vec3<f32>) -> vec3<f32> {
    let length = largest_component(vector);
    return unit_or(vector * (1.0 / max(length, 1e-30)), otherwise);
}

// Returns the largest absolute value of the components.
fn largest_component(vector: vec3<f32>) -> f32 {
    return max(abs(vector.x), max(abs(vector.y), abs(vector.z)));
}
