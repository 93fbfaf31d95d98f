// What a function of the user's own for control points gets and gives: see docs/manual/own-shaders.md. Lengths are in object
// units, normals are unit vectors.

// An edge as one of its sides has it, from corner `side` of its triangle to the next.
struct SurfaceEdge {
    // Its ends.
    a: vec3<f32>,
    b: vec3<f32>,
    // The triangle's own normals at the ends.
    normal_a: vec3<f32>,
    normal_b: vec3<f32>,
    // Those of the triangle across the edge; the triangle's own without one.
    adjacent_normal_a: vec3<f32>,
    adjacent_normal_b: vec3<f32>,
    // Whether there is a triangle across the edge: exactly two meet there.
    has_adjacent: bool,
    // 0, 1 or 2.
    side: u32,
}

// A triangle of the mesh.
struct SurfaceTriangle {
    // The number of its patch: that of the triangle, less one for each degenerate triangle before it.
    index: u32,
    corners: array<vec3<f32>, 3>,
    normals: array<vec3<f32>, 3>,
}

// The two inner control points of an edge's curve: the one near a, and the one near b.
struct EdgePoints {
    ab: vec3<f32>,
    ba: vec3<f32>,
}
