// One segment for every DEGREES that the edge's curve turns, and one more inside a patch than on its edges. The curve's direction
// at its ends is that of its control polygon, so the factor is symmetric, also where the sides' normals differ.

const DEGREES = 6.0;

fn turn(along: vec3<f32>, next: vec3<f32>) -> f32 {
    return degrees(acos(clamp(dot(normalize(along), normalize(next)), -1.0, 1.0)));
}

fn edge_factor(edge: Edge, triangle: Triangle, view: View) -> f32 {
    let first = edge.ab - edge.a;
    let middle = edge.ba - edge.ab;
    let last = edge.b - edge.ba;
    // A curve without length has no direction.
    if min(min(length(first), length(middle)), length(last)) == 0.0 {
        return 1.0;
    }
    return clamp((turn(first, middle) + turn(middle, last)) / DEGREES, 1.0, 64.0);
}

fn inside_factor(triangle: Triangle, factors: vec3<f32>, view: View) -> f32 {
    return max(max(factors.x, factors.y), factors.z) + 1.0;
}
