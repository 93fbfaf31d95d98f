// The factor FACTOR up to NEAR bounding radii from the eye, 1 from FAR bounding radii on, and linear between. An edge takes the
// mean of its ends. Both sides of an edge add the same two numbers, in either order, so their factors are equal.

const FACTOR = 16.0;
const NEAR = 2.0;
const FAR = 10.0;

fn factor_at(point: vec3<f32>, view: View) -> f32 {
    let part = (FAR - distance(point, view.eye) / view.radius) / (FAR - NEAR);
    return 1.0 + (FACTOR - 1.0) * clamp(part, 0.0, 1.0);
}

fn edge_factor(edge: Edge, triangle: Triangle, view: View) -> f32 {
    return max(1.0, 0.5 * (factor_at(edge.a, view) + factor_at(edge.b, view)));
}
