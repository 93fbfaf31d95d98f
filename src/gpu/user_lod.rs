//! Factors from functions of the user's own, in place of those of LOD.

use std::sync::Arc;

use super::user_functions::{UserFunction, UserPurpose, UserShader, UserText};
use super::wgsl::WgslModule;
use geometry::tessellate::HullFactors;

pub static LOD_PURPOSE: UserPurpose = UserPurpose {
    name: "LOD shader",
    contract: "lod_contract",
    functions: &[
        UserFunction {
            name: "edge_factor",
            parameters: &["Edge", "Triangle", "View"],
            result: "f32",
            signature: "fn edge_factor(edge: Edge, triangle: Triangle, view: View) -> f32",
            stand_in: "user_edge_factor",
        },
        UserFunction {
            name: "inside_factor",
            parameters: &["Triangle", "vec3", "View"],
            result: "f32",
            signature: "fn inside_factor(triangle: Triangle, factors: vec3<f32>, view: View) -> f32",
            stand_in: "user_inside_factor",
        },
    ],
    module: WgslModule("pass_user_lod"),
    entry_points: &[
        "pnaen_user_start_main",
        "pnaen_user_edges_main",
        "pnaen_user_insides_main",
        "pnaen_user_finish_main",
    ],
};

/// Functions of the user's own for factors.
#[derive(Debug, PartialEq, Eq)]
pub struct LodShader(UserText);

impl UserShader for LodShader {
    const PURPOSE: &'static UserPurpose = &LOD_PURPOSE;

    fn new(own: UserText) -> Self {
        Self(own)
    }

    fn own(&self) -> &UserText {
        &self.0
    }
}

/// What takes the place of LOD's factors.
#[derive(Clone, Debug, PartialEq)]
pub enum Given {
    /// What a hull shader wrote, one for each patch.
    Factors(Vec<HullFactors>),
    /// Functions that compute it, for every view anew.
    Shader(Arc<LodShader>),
}

impl From<Vec<HullFactors>> for Given {
    fn from(factors: Vec<HullFactors>) -> Self {
        Self::Factors(factors)
    }
}
