//! Factors from functions of the user's own, in place of those of LOD.

use std::sync::Arc;

use super::own_functions::{OwnFunction, OwnPurpose, OwnShader, OwnText};
use super::wgsl::WgslModule;
use geometry::tessellate::HullFactors;

pub static LOD_PURPOSE: OwnPurpose = OwnPurpose {
    name: "LOD shader",
    contract: "lod_contract",
    functions: &[
        OwnFunction {
            name: "edge_factor",
            parameters: &["Edge", "Triangle", "View"],
            result: "f32",
            signature: "fn edge_factor(edge: Edge, triangle: Triangle, view: View) -> f32",
            stand_in: "own_edge_factor",
        },
        OwnFunction {
            name: "inside_factor",
            parameters: &["Triangle", "vec3", "View"],
            result: "f32",
            signature: "fn inside_factor(triangle: Triangle, factors: vec3<f32>, view: View) -> f32",
            stand_in: "own_inside_factor",
        },
    ],
    module: WgslModule("pass_own_lod"),
    entry_points: &["pnaen_own_start_main", "pnaen_own_edges_main", "pnaen_own_insides_main", "pnaen_own_finish_main"],
};

/// Functions of the user's own for factors.
#[derive(Debug, PartialEq, Eq)]
pub struct LodShader(OwnText);

impl OwnShader for LodShader {
    fn purpose() -> &'static OwnPurpose {
        &LOD_PURPOSE
    }

    fn new(own: OwnText) -> Self {
        Self(own)
    }

    fn own(&self) -> &OwnText {
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
