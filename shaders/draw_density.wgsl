// Lines that a pixel shader draws, which fade where they are dense.

// Px between parallel lines: at DENSE they have faded, and from SPARSE on they are drawn in full.
const DENSE: f32 = 2.0;
const SPARSE: f32 = 8.0;

// How much of a pixel, `distance` px from the middle of a line, the line covers.
fn line_coverage(distance: f32, half_width: f32) -> f32 {
    return 1.0 - smoothstep(half_width - 0.5, half_width + 0.5, distance);
}

// The opacity that is left of lines which are `spacing` px apart: all of it where they are far apart, and none where they would
// cover the surface or make moire patterns.
fn left_by_density(spacing: f32) -> f32 {
    return smoothstep(DENSE, SPARSE, spacing);
}
