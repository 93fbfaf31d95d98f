// Stands for the user's own function where pass_user_lod.wgsl is checked without one.
fn edge_factor(edge: Edge, triangle: Triangle, view: View) -> f32 {
    return 1.0;
}
