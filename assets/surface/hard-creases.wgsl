// As pn-aen.wgsl, but straight towards an end where the normals of the two sides are more than DEGREES apart, so that the hard edges
// of machines and buildings stay straight. Elsewhere BULGE says how far control points are from the straight edge: 0 is flat, 1 is
// PN-AEN. The dot product of two normals doesn't depend on their order, so both sides decide alike.

const DEGREES = 30.0;
const BULGE = 1.0;

// Three times the control point near `a` under PN: see pn-aen.wgsl.
fn thrice_near(a: vec3<f32>, b: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    return (a * 2.0 + b) - normal * dot(b - a, normal);
}

fn point_near(a: vec3<f32>, b: vec3<f32>, normal: vec3<f32>, adjacent: vec3<f32>) -> vec3<f32> {
    let straight = (a * 2.0 + b) * (1.0 / 3.0);
    if dot(normal, adjacent) < cos(radians(DEGREES)) {
        return straight;
    }
    let mean = (thrice_near(a, b, normal) + thrice_near(a, b, adjacent)) * (1.0 / 6.0);
    return mix(straight, mean, BULGE);
}

fn edge_points(edge: SurfaceEdge, triangle: SurfaceTriangle) -> EdgePoints {
    return EdgePoints(
        point_near(edge.a, edge.b, edge.normal_a, edge.adjacent_normal_a),
        point_near(edge.b, edge.a, edge.normal_b, edge.adjacent_normal_b),
    );
}
