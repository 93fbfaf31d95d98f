//! Control points from a function of the user's own, in place of those of a surface.

use super::own_functions::{OwnFunction, OwnPurpose, OwnShader, OwnText};
use super::wgsl::WgslModule;

pub static SURFACE_PURPOSE: OwnPurpose = OwnPurpose {
    name: "surface shader",
    contract: "surface_contract",
    functions: &[OwnFunction {
        name: "edge_points",
        parameters: &["SurfaceEdge", "SurfaceTriangle"],
        result: "EdgePoints",
        signature: "fn edge_points(edge: SurfaceEdge, triangle: SurfaceTriangle) -> EdgePoints",
        stand_in: "own_edge_points",
    }],
    module: WgslModule("pass_own_surface"),
    entry_points: &["pnaen_own_surface_start_main", "pnaen_own_surface_points_main", "pnaen_own_surface_finish_main"],
};

/// A function of the user's own for control points.
#[derive(Debug, PartialEq, Eq)]
pub struct SurfaceShader(OwnText);

impl OwnShader for SurfaceShader {
    fn purpose() -> &'static OwnPurpose {
        &SURFACE_PURPOSE
    }

    fn new(own: OwnText) -> Self {
        Self(own)
    }

    fn own(&self) -> &OwnText {
        &self.0
    }
}
