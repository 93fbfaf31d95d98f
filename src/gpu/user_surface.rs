//! Control points from a function of the user's own, in place of those of a surface.

use super::user_functions::{UserFunction, UserPurpose, UserShader, UserText};
use super::wgsl::WgslModule;

pub static SURFACE_PURPOSE: UserPurpose = UserPurpose {
    name: "surface shader",
    contract: "surface_contract",
    functions: &[UserFunction {
        name: "edge_points",
        parameters: &["SurfaceEdge", "SurfaceTriangle"],
        result: "EdgePoints",
        signature: "fn edge_points(edge: SurfaceEdge, triangle: SurfaceTriangle) -> EdgePoints",
        stand_in: "user_edge_points",
    }],
    module: WgslModule("pass_user_surface"),
    entry_points: &[
        "pnaen_user_surface_start_main",
        "pnaen_user_surface_points_main",
        "pnaen_user_surface_finish_main",
    ],
};

/// A function of the user's own for control points.
#[derive(Debug, PartialEq, Eq)]
pub struct SurfaceShader(UserText);

impl UserShader for SurfaceShader {
    const PURPOSE: &'static UserPurpose = &SURFACE_PURPOSE;

    fn new(own: UserText) -> Self {
        Self(own)
    }

    fn own(&self) -> &UserText {
        &self.0
    }
}
