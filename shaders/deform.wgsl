// A corner's position and normal through the mean of its joints' matrices. Twin: src/tessellate/deform.rs.

// A corner before it is deformed.
struct Binding {
    position: vec3<f32>,
    // Its run of `deltas`.
    first_delta: u32,
    normal: vec3<f32>,
    delta_count: u32,
    joints: vec4<u32>,
    weights: vec4<f32>,
}

// What a morph target of weight 1 adds to a corner.
struct Delta {
    position: vec3<f32>,
    weight: u32,
    normal: vec3<f32>,
}

// The first three rows of a matrix, whose fourth is (0, 0, 0, 1).
struct JointMatrix {
    x: vec4<f32>,
    y: vec4<f32>,
    z: vec4<f32>,
}

// The mean of four matrices by weight.
fn blend(a: JointMatrix, b: JointMatrix, c: JointMatrix, d: JointMatrix, weights: vec4<f32>) -> JointMatrix {
    return JointMatrix(
        a.x * weights.x + b.x * weights.y + c.x * weights.z + d.x * weights.w,
        a.y * weights.x + b.y * weights.y + c.y * weights.z + d.y * weights.w,
        a.z * weights.x + b.z * weights.y + c.z * weights.z + d.z * weights.w,
    );
}

fn deform_position(matrix: JointMatrix, position: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        dot(matrix.x.xyz, position) + matrix.x.w,
        dot(matrix.y.xyz, position) + matrix.y.w,
        dot(matrix.z.xyz, position) + matrix.z.w,
    );
}

// Through the cofactors, which are the inverse transpose times the determinant, and exist where the inverse doesn't.
fn deform_normal(matrix: JointMatrix, normal: vec3<f32>) -> vec3<f32> {
    // Scaled, so that no product of two entries leaves f32.
    let scale = 1.0 / max(max(largest(matrix.x.xyz), largest(matrix.y.xyz)), max(largest(matrix.z.xyz), 1e-30));
    let x = matrix.x.xyz * scale;
    let y = matrix.y.xyz * scale;
    let z = matrix.z.xyz * scale;
    let turned = vec3<f32>(dot(cross(y, z), normal), dot(cross(z, x), normal), dot(cross(x, y), normal));
    return unit_of(turned * select(1.0, -1.0, dot(x, cross(y, z)) < 0.0), normal);
}

// At unit length; `otherwise` where there is no direction.
fn unit_of(vector: vec3<f32>, otherwise: vec3<f32>) -> vec3<f32> {
    let length = largest(vector);
    return unit_or(vector * (1.0 / max(length, 1e-30)), otherwise);
}

fn largest(vector: vec3<f32>) -> f32 {
    return max(abs(vector.x), max(abs(vector.y), abs(vector.z)));
}
