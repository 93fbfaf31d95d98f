//! Tessellation on the CPU: the reference implementation that the shaders are compared with.
//!
//! `shaders/X.wgsl` is the twin of `X.rs`: it has the same functions in the same order, with the same formulas.
//! `control_nets.rs`, `mesh_factors.rs`, `mesh_displacement.rs` and `mesh_tessellation.rs` do for a whole mesh what the
//! passes in `shaders/pass_*.wgsl` do.

mod connectivity;
pub mod connectivity_table;
mod control_nets;
mod control_points;
mod convention;
mod coverage;
mod cull;
mod curvature;
mod deform;
mod displace;
pub mod domain;
mod domain_kind;
mod domain_row;
mod explained_patch;
pub mod factors;
mod flat_patch;
mod height_list;
pub mod hull_factors;
mod inputs;
mod isoline;
mod least_factors;
mod least_rows;
mod limit_surface;
mod lod;
pub mod mesh_displacement;
mod mesh_factors;
mod mesh_tessellation;
mod normal;
mod octahedral_normal;
mod patch_bounds;
mod piece_error;
mod posed_mesh;
mod quad;
mod quotients;
mod relief;
mod rings;
mod rows;
mod solid;
mod subtriangulation;
mod surface;
mod triangle_budget;
mod vertex;

pub use crate::surface_kind::{Surface, SurfaceFamily};
pub use crate::view::DepthRange;
pub use convention::Convention;
pub use cull::Clip;
pub use curvature::CurvatureKind;
pub use displace::Displacement;
pub use domain_kind::DomainKind;
pub use factors::{Partitioning, PatchFactors};
pub use inputs::{Edges, Inputs, Tessellation};
pub use isoline::IsolineFactors;
pub use lod::{Lod, LodReads, LodView};
pub use mesh_tessellation::{Tessellated, tessellate};
pub use normal::Normals;
pub use octahedral_normal::unpack_normal;
pub use quad::QuadFactors;
pub use vertex::Vertex;

pub use control_nets::patch_net;
#[cfg(test)]
pub(crate) use control_points::edge_control_point;
pub(crate) use control_points::{DistinctNormals, add_normal, crease_control_point, side_control_points};
pub use control_points::{center_control_point, straight_control_point};
pub use convention::{corner_weights, domain_side, factor_side, weight_corner};
pub use coverage::{CoverageView, covers_nothing, screen_corner};
pub use cull::{FACING_AWAY, NOT_CULLED, OUT_OF_VIEW, cull_reason, planes_outside};
pub use curvature::patch_curvature;
pub use domain::{domain_plan, domain_point, domain_triangle};
pub use explained_patch::minimum_triangles;
pub use explained_patch::{
    DecidedBy, EdgeFormula, ExplainedEdge, ExplainedPatch, explain_patch, inside_cut, is_enough, minimum_inputs,
};
pub use factors::FACTOR_ODD;
pub use factors::{
    FACTOR_VALUE, FIXED_ONE, MOST_ROWS, last_factor, outer_count, patch_has_rows, patch_is_culled, patch_is_low,
    point_count, process, round_pow2, segments, triangle_count,
};
pub use hull_factors::{HullFactors, RowChoice, largest_patch};
pub use inputs::{sharing, user_sharing};
pub use limit_surface::LimitSurface;
pub use lod::beyond_near;
pub(crate) use lod::{distance_factor, edge_length_factor, paper_edge_factor};
pub use mesh_displacement::{displaced_corners, displacement_reach, displacing_heights, usual_amount};
pub use mesh_factors::rounds;
pub use mesh_tessellation::{edge_factors, given_totals, hull_factors, tessellate_given, totals};
pub use normal::{edge_normal, linear_normal};
pub(crate) use normal::{quadratic_edge_normal, quadratic_normal, surface_normal};
pub use octahedral_normal::pack_normal;
pub use piece_error::{SeenPatch, piece_error};
pub use posed_mesh::{Deformed, PosedMesh, bounds_through, deform};
pub use solid::{Solid, is_beyond_near};
pub use surface::{ControlNet, edge_position, edge_uv, linear_uv, outline_place, patch_position, patch_tangents};
pub use triangle_budget::tolerance_within_budget;
pub use vertex::pack_key;

/// The constants of the mathematics that the shaders have too, for the test that compares them.
pub mod shared_constants {
    pub use super::connectivity_table::{PATTERN_HALVES, PATTERN_STEPS};
    pub use super::control_points::PARALLEL;
    pub use super::coverage::ROW_SAMPLES;
    pub use super::cull::{
        FACING_AWAY, FACING_MARGIN, FACING_ROUNDING, NOT_CULLED, OUT_OF_VIEW, POLAR_INDICES, POLAR_WEIGHTS,
    };
    pub use super::curvature::FLAT_ANGLE;
    pub use super::domain::FIXED_TWO_THIRDS;
    pub use super::factors::{
        BITS_63, BITS_64, BITS_127, BITS_1792, BITS_INFINITY, BITS_ONE, BITS_ONE_AND_HALF_STEP, BITS_ONE_AND_STEP,
        BITS_TWO, FACTOR_ODD, FACTOR_VALUE, FIXED_HALF, FIXED_ONE, MOST_ROWS, ROW_BASE_SHIFT, ROW_BASE_STEP,
        ROW_FLIP_SHIFT, ROWS, SUBTRIANGULATED,
    };
    pub use super::flat_patch::{AGREEING, TWO_POINTS};
    pub use super::least_factors::{BEYOND_LAST, BOUND_SHARE, ROW_REACH, SPREAD, TOGETHER};
    pub use super::least_rows::{LESSENINGS, REQUESTED_SEGMENT};
    pub use super::normal::CANCELLED;
    pub use super::piece_error::{FINEST_GRID, PARTIAL_STEPS};
    pub use super::relief::{DIRECTION_ROUNDING, NEEDED_SHARE};
    pub use super::surface::UNIT;
}
