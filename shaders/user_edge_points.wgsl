// Stands for the user's own function where pass_user_surface.wgsl is checked without one.
fn edge_points(edge: SurfaceEdge, triangle: SurfaceTriangle) -> EdgePoints {
    return EdgePoints(edge.a, edge.b);
}
