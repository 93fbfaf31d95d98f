// One segment for every PIXELS px that the edge's control polygon is long on screen. Sums of three numbers depend on their order,
// so the outer two are added first: then both sides of an edge get the same bits.

const PIXELS = 8.0;

fn on_screen(point: vec3<f32>, view: View) -> vec2<f32> {
    let clip = view.clip_from_object * vec4<f32>(point, 1.0);
    return clip.xy / clip.w * (view.viewport * 0.5) / PIXELS;
}

fn edge_factor(edge: Edge, triangle: Triangle, view: View) -> f32 {
    let a = on_screen(edge.a, view);
    let ab = on_screen(edge.ab, view);
    let ba = on_screen(edge.ba, view);
    let b = on_screen(edge.b, view);
    return max(1.0, (distance(a, ab) + distance(ba, b)) + distance(ab, ba));
}
