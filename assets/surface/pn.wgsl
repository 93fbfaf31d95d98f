// PN triangles (Vlachos et al. 2001, section 3.1), as --surface pn: a control point is the point one third of the way along the edge,
// projected into the tangent plane at the near end. Where the two sides have different normals there, their points differ, and the
// edge tears.

fn point_near(a: vec3<f32>, b: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    return (a * 2.0 + b - normal * dot(b - a, normal)) * (1.0 / 3.0);
}

fn edge_points(edge: SurfaceEdge, triangle: SurfaceTriangle) -> EdgePoints {
    return EdgePoints(point_near(edge.a, edge.b, edge.normal_a), point_near(edge.b, edge.a, edge.normal_b));
}
