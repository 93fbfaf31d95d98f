//! The mathematics on the CPU: the reference that the shaders are held against. `shaders/X.wgsl` is the twin of `X.rs`;
//! `mesh.rs` does for a whole mesh what `shaders/pass_*.wgsl` do, and is their twin.

mod budget;
mod convention;
mod cull;
mod deform;
pub mod domain;
mod error;
pub mod factors;
mod hull;
mod lod;
mod mesh;
mod posed;
mod solid;
mod surface;

pub use budget::fit_budget;
pub use convention::{Convention, corner_weights, domain_side, factor_side, weight_corner};
pub use cull::{
    Clip, FACING_AWAY, OUT_OF_VIEW, SEEN, faces_away, is_clipped, patch_is_outside, planes_outside, unseen,
};
pub use domain::{domain_point, domain_triangle};
pub use error::{EDGE_SHARE, edge_error_factor, inside_error_factor, level};
pub use factors::{
    FACTOR_ODD, FIXED_ONE, Partitioning, PatchFactors, UnknownPartitioning, outer_count, patch_is_culled, patch_is_low,
    point_count, process, round_pow2, segments, triangle_count,
};
pub use hull::HullFactors;
pub use lod::{
    Lod, LodView, at_least_one, beyond_near, distance_factor, edge_length_factor, near_edge_factor, paper_edge_factor,
    project_and_scale,
};
pub use mesh::{
    Edges, Inputs, Limit, Tessellated, Vertex, edge_factors, given_totals, hull_factors, pack_key, sharing, tessellate,
    tessellate_given, totals,
};
pub use posed::{Deformed, Posed, bounds_through, deform};
pub use solid::{Solid, is_beyond_near};
pub use surface::{
    ControlNet, Surface, center_control_point, edge_control_point, edge_normal, edge_position, edge_uv, linear_normal,
    linear_uv, pack_normal, patch_position, straight_control_point, unpack_normal,
};
