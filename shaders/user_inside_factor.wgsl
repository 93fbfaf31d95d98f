// The inside factor where the user's file has no function for it: the same as with factors of LOD. The module declares the
// buffer `params`.
fn inside_factor(triangle: Triangle, factors: vec3<f32>, view: View) -> f32 {
    if params.partitioning == PARTITIONING_ROWS {
        return base_factor(vec3<f32>(
            factors[factor_side(params.convention, 0u)],
            factors[factor_side(params.convention, 1u)],
            factors[factor_side(params.convention, 2u)],
        ));
    }
    return max(max(factors.x, factors.y), factors.z);
}
