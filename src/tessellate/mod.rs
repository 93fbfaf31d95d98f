//! The mathematics on the CPU: the reference that the shaders are held against. `shaders/X.wgsl` is the twin of `X.rs`;
//! `mesh.rs`, `nets.rs`,
//! `mesh_factors.rs` and `relief.rs` do for a whole mesh what `shaders/pass_*.wgsl` do, and are their twins.

mod budget;
mod connectivity;
mod control_points;
mod convention;
mod coverage;
mod cull;
mod deform;
mod displace;
pub mod domain;
mod error;
pub mod factors;
mod hull;
mod inputs;
mod limit;
mod lod;
mod mesh;
mod mesh_factors;
mod nets;
mod normal;
pub(crate) mod patterns;
mod posed;
mod relief;
mod rings;
mod solid;
mod spans;
mod subtriangulation;
mod surface;
mod vertex;

pub use budget::fit_budget;
pub use control_points::{
    Meeting, center_control_point, crease_control_point, edge_control_point, meet, nagata_control_point,
    phong_control_point, side_control_points, straight_control_point,
};
pub use convention::{Convention, corner_weights, domain_side, factor_side, weight_corner};
pub use coverage::{CoverageView, ScreenCorner, covers_nothing, screen_corner};
pub use cull::{
    Clip, FACING_AWAY, OUT_OF_VIEW, SEEN, faces_away, is_clipped, patch_is_outside, planes_outside, unseen,
};
pub use displace::{
    Displacement, bilinear_height, direction_slopes, height_at, height_slopes, raised_normal, segment_level,
    texel_length, uv_gradients,
};
pub use domain::{DomainPlan, domain_plan, domain_point, domain_triangle};
pub use error::{EDGE_SHARE, SURFACE_SHARE, edge_error_factor, inside_error_factor, level};
pub use factors::{
    FACTOR_ODD, FACTOR_VALUE, FIXED_ONE, Partitioning, PatchFactors, outer_count, patch_is_culled, patch_is_low,
    point_count, process, round_pow2, segments, triangle_count,
};
pub use hull::HullFactors;
pub use inputs::{Edges, Inputs, Tessellation, sharing};
pub use limit::Limit;
pub use lod::{
    Lod, LodView, at_least_one, beyond_near, distance_factor, edge_length_factor, near_edge_factor, paper_edge_factor,
    project_and_scale,
};
pub use mesh::{Tessellated, edge_factors, given_totals, hull_factors, tessellate, tessellate_given, totals};
pub use normal::{
    Normals, edge_normal, linear_normal, middle_normal, pack_normal, quadratic_edge_normal, quadratic_normal,
    surface_normal, unpack_normal,
};
pub use posed::{Deformed, Posed, bounds_through, deform};
pub use relief::{displacing, height_units, reach};
pub use solid::{Solid, is_beyond_near};
pub use spans::{Span, is_mixed, map_number, spans};
pub use surface::{ControlNet, Surface, edge_position, edge_uv, linear_uv, patch_position, patch_tangents, place};
pub use vertex::{Vertex, pack_key};

/// The constants of the mathematics that the shaders have too, for the test that compares them.
#[cfg(test)]
pub(crate) mod shared_constants {
    pub(crate) use super::control_points::PARALLEL;
    pub(crate) use super::coverage::ROW_SAMPLES;
    pub(crate) use super::cull::{
        FACING_AWAY, FACING_MARGIN, FACING_ROUNDING, OUT_OF_VIEW, POLAR_INDICES, POLAR_WEIGHTS, SEEN,
    };
    pub(crate) use super::domain::FIXED_TWO_THIRDS;
    pub(crate) use super::error::{DETAIL_SHARE, EDGE_SHARE, NESTING, SURFACE_SHARE, TURN_SHARE};
    pub(crate) use super::factors::{
        BITS_63, BITS_64, BITS_INFINITY, BITS_ONE, BITS_ONE_AND_HALF_STEP, BITS_ONE_AND_STEP, BITS_TWO, FACTOR_ODD,
        FACTOR_VALUE, FIXED_HALF, FIXED_ONE, SUBTRIANGULATED,
    };
    pub(crate) use super::normal::CANCELLED;
    pub(crate) use super::patterns::{PATTERN_HALVES, PATTERN_STEPS};
    pub(crate) use super::surface::UNIT;
}
