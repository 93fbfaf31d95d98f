// PN triangles with adjacent edge normals (McDonald and Kilgard 2010), as --surface pn-aen: the mean of the control points that both
// sides have under PN. Both sides add the same two numbers, in either order, so their points are equal.

// Three times the control point near `a` under PN. The sum of two of these is multiplied at the end: a compiler may round a sum of
// products otherwise from one side than from the other, but not a sum of sums.
fn thrice_near(a: vec3<f32>, b: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    return (a * 2.0 + b) - normal * dot(b - a, normal);
}

fn mean_near(a: vec3<f32>, b: vec3<f32>, normal: vec3<f32>, adjacent: vec3<f32>) -> vec3<f32> {
    return (thrice_near(a, b, normal) + thrice_near(a, b, adjacent)) * (1.0 / 6.0);
}

fn edge_points(edge: SurfaceEdge, triangle: SurfaceTriangle) -> EdgePoints {
    return EdgePoints(
        mean_near(edge.a, edge.b, edge.normal_a, edge.adjacent_normal_a),
        mean_near(edge.b, edge.a, edge.normal_b, edge.adjacent_normal_b),
    );
}
