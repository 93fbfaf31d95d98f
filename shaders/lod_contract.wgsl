// What functions of the user's own get: see docs/manual/own-shaders.md. Lengths are in object units, normals are unit vectors.

// An edge as one of its sides has it, from corner `side` of its triangle to the next.
struct Edge {
    // Its ends.
    a: vec3<f32>,
    b: vec3<f32>,
    // The two inner control points of its curve, near a and near b.
    ab: vec3<f32>,
    ba: vec3<f32>,
    // The triangle's own normals at the ends.
    normal_a: vec3<f32>,
    normal_b: vec3<f32>,
    // 0, 1 or 2.
    side: u32,
}

// A triangle, and the control points of its patch.
struct Triangle {
    // The number of its patch: that of the triangle, less one for each degenerate triangle before it.
    index: u32,
    corners: array<vec3<f32>, 3>,
    normals: array<vec3<f32>, 3>,
    // Near the start and near the end of side 0, then of sides 1 and 2.
    edges: array<vec3<f32>, 6>,
    center: vec3<f32>,
}

// From where factors are computed.
struct View {
    // To clip space. Depth is reversed: z = w on the near plane.
    clip_from_object: mat4x4<f32>,
    // Width and height in px.
    viewport: vec2<f32>,
    eye: vec3<f32>,
    // The bounding radius of the mesh.
    radius: f32,
    // The largest distance by which displacement moves a point.
    reach: f32,
}
