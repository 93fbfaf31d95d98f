//! Tessellation on the CPU: the reference implementation that the shaders are compared with.
//!
//! `shaders/X.wgsl` is the twin of `X.rs`: it has the same functions in the same order, with the same formulas.
//! `control_nets.rs`, `mesh_factors.rs`, `mesh_displacement.rs` and `mesh_tessellation.rs` do for a whole mesh what the
//! passes in `shaders/pass_*.wgsl` do.

mod connectivity;
pub(crate) mod connectivity_table;
mod control_nets;
mod control_points;
mod convention;
#[cfg_attr(
    not(test),
    allow(dead_code, reason = "the passes need the view alone; tests need the rest, which they follow")
)]
mod coverage;
mod cull;
#[cfg(test)]
mod curvature;
mod deform;
mod displace;
mod displacement_factor;
pub(crate) mod domain;
mod domain_row;
mod explained_patch;
pub(crate) mod factors;
mod flat_patch;
mod height_list;
pub(crate) mod hull_factors;
mod inputs;
mod least_factors;
mod least_rows;
mod limit_surface;
mod lod;
pub(crate) mod mesh_displacement;
mod mesh_factors;
mod mesh_tessellation;
mod normal;
mod octahedral_normal;
mod patch_bounds;
mod piece_error;
mod posed_mesh;
mod quotients;
mod rings;
mod rows;
mod solid;
mod subtriangulation;
mod surface;
mod texel_lengths;
mod triangle_budget;
mod vertex;

pub use convention::Convention;
pub use cull::Clip;
pub use displace::Displacement;
pub use factors::{Partitioning, PatchFactors};
pub use inputs::{Edges, Inputs, Tessellation};
pub use lod::{Lod, LodView};
pub use mesh_tessellation::{Tessellated, tessellate};
pub use normal::Normals;
pub use octahedral_normal::unpack_normal;
pub use surface::Surface;
pub use vertex::Vertex;

#[cfg(test)]
pub(crate) use control_points::edge_control_point;
pub(crate) use control_points::{
    DistinctNormals, add_normal, center_control_point, crease_control_point, side_control_points,
    straight_control_point,
};
pub(crate) use convention::{corner_weights, domain_side, factor_side, weight_corner};
pub(crate) use coverage::CoverageView;
#[cfg(test)]
pub(crate) use coverage::{covers_nothing, screen_corner};
pub(crate) use cull::{FACING_AWAY, NOT_CULLED, OUT_OF_VIEW, cull_reason, planes_outside};
#[cfg(test)]
pub(crate) use curvature::{mean_curvature, patch_second_derivatives};
pub(crate) use displacement_factor::SURFACE_SHARE;
pub(crate) use domain::{domain_plan, domain_point, domain_triangle};
#[cfg(test)]
pub(crate) use explained_patch::own_least_triangles;
pub(crate) use explained_patch::{
    DecidedBy, ExplainedEdge, ExplainedPatch, explain_patch, inside_cut, is_enough, own_least_inputs,
};
#[cfg(test)]
pub(crate) use factors::FACTOR_ODD;
pub(crate) use factors::{
    FACTOR_VALUE, FIXED_ONE, outer_count, patch_is_culled, patch_is_low, point_count, process, round_pow2, segments,
    triangle_count,
};
pub(crate) use hull_factors::{HullFactors, RowChoice};
pub(crate) use inputs::{own_sharing, sharing};
pub(crate) use limit_surface::LimitSurface;
pub(crate) use lod::{beyond_near, distance_factor, edge_length_factor, paper_edge_factor};
pub(crate) use mesh_displacement::{displaced_corners, displacement_reach, displacing_heights, height_units};
pub(crate) use mesh_factors::rounds;
#[cfg(test)]
pub(crate) use mesh_tessellation::edge_factors;
pub(crate) use mesh_tessellation::{given_totals, hull_factors, tessellate_given, totals};
pub(crate) use normal::{edge_normal, linear_normal, quadratic_edge_normal, quadratic_normal, surface_normal};
pub(crate) use octahedral_normal::pack_normal;
pub(crate) use piece_error::{SeenPatch, piece_error};
#[cfg(test)]
pub(crate) use posed_mesh::deform;
pub(crate) use posed_mesh::{Deformed, PosedMesh, bounds_through};
pub(crate) use solid::{Solid, is_beyond_near};
#[cfg(test)]
pub(crate) use surface::patch_tangents;
pub(crate) use surface::{ControlNet, edge_position, edge_uv, linear_uv, outline_place, patch_position};
pub(crate) use texel_lengths::{TexelLength, map_number, texel_lengths};
pub(crate) use triangle_budget::tolerance_within_budget;
#[cfg(test)]
pub(crate) use vertex::pack_key;

/// The constants of the mathematics that the shaders have too, for the test that compares them.
#[cfg(test)]
pub(crate) mod shared_constants {
    pub(crate) use super::connectivity_table::{PATTERN_HALVES, PATTERN_STEPS};
    pub(crate) use super::control_points::PARALLEL;
    pub(crate) use super::coverage::ROW_SAMPLES;
    pub(crate) use super::cull::{
        FACING_AWAY, FACING_MARGIN, FACING_ROUNDING, NOT_CULLED, OUT_OF_VIEW, POLAR_INDICES, POLAR_WEIGHTS,
    };
    pub(crate) use super::curvature::FLAT_ANGLE;
    pub(crate) use super::displacement_factor::{DETAIL_SHARE, SURFACE_SHARE, TURN_SHARE};
    pub(crate) use super::domain::FIXED_TWO_THIRDS;
    pub(crate) use super::factors::{
        BITS_63, BITS_64, BITS_896, BITS_INFINITY, BITS_ONE, BITS_ONE_AND_HALF_STEP, BITS_ONE_AND_STEP, BITS_TWO,
        FACTOR_ODD, FACTOR_VALUE, FIXED_HALF, FIXED_ONE, ROW_BASE_SHIFT, ROW_BASE_STEP, ROW_FLIP_SHIFT, ROWS,
        SUBTRIANGULATED,
    };
    pub(crate) use super::flat_patch::{AGREEING, TWO_POINTS};
    pub(crate) use super::least_factors::{BEYOND_LAST, BOUND_SHARE, ROW_REACH, SPREAD, TOGETHER};
    pub(crate) use super::least_rows::{ASKED_SEGMENT, LESSENINGS};
    pub(crate) use super::normal::CANCELLED;
    pub(crate) use super::piece_error::{FINEST_GRID, PARTIAL_STEPS};
    pub(crate) use super::surface::UNIT;
}
