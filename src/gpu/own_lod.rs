//! Factors from functions of the user's own, in place of those of LOD: the module that runs them, and its pipelines.

use std::sync::Arc;

use super::compute_pipeline::{ComputePipeline, ShaderModule};
use super::own_functions::{OWN_WORK, OwnFunction, OwnPurpose, OwnShader, OwnText};
use super::wgsl::{CONVENTION, FACTORS, LOAD_NET, LOADS, TYPES, WgslFile};
use geometry::tessellate::HullFactors;

static LOD_CONTRACT: WgslFile = WgslFile::new("lod_contract", &[]);
static OWN_EDGE_FACTOR: WgslFile = WgslFile::new("own_edge_factor", &[&LOD_CONTRACT]);
static OWN_INSIDE_FACTOR: WgslFile =
    WgslFile::new("own_inside_factor", &[&CONVENTION, &FACTORS, &LOD_CONTRACT, &TYPES]);
pub(super) static PASS_OWN_LOD: WgslFile = WgslFile::new(
    "pass_own_lod",
    &[&CONVENTION, &LOAD_NET, &LOADS, &LOD_CONTRACT, &OWN_EDGE_FACTOR, &OWN_INSIDE_FACTOR, &OWN_WORK, &TYPES],
);

pub static LOD_PURPOSE: OwnPurpose = OwnPurpose {
    name: "LOD shader",
    contract: &LOD_CONTRACT,
    functions: &[
        OwnFunction {
            name: "edge_factor",
            parameters: &["Edge", "Triangle", "View"],
            result: "f32",
            signature: "fn edge_factor(edge: Edge, triangle: Triangle, view: View) -> f32",
            stand_in: &OWN_EDGE_FACTOR,
        },
        OwnFunction {
            name: "inside_factor",
            parameters: &["Triangle", "vec3", "View"],
            result: "f32",
            signature: "fn inside_factor(triangle: Triangle, factors: vec3<f32>, view: View) -> f32",
            stand_in: &OWN_INSIDE_FACTOR,
        },
    ],
    pass: &PASS_OWN_LOD,
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

/// The pipelines of one user's functions.
pub struct OwnLodPipelines {
    pub(super) start: ComputePipeline,
    pub(super) edges: ComputePipeline,
    pub(super) insides: ComputePipeline,
    pub(super) finish: ComputePipeline,
}

impl OwnLodPipelines {
    /// Compiles nothing yet.
    pub(super) fn new(shader: &LodShader) -> Self {
        let module = Arc::new(ShaderModule::of_text(PASS_OWN_LOD.name, shader.module_text()));
        Self {
            start: ComputePipeline::new(&module, "pnaen_own_start_main"),
            edges: ComputePipeline::new(&module, "pnaen_own_edges_main"),
            insides: ComputePipeline::new(&module, "pnaen_own_insides_main"),
            finish: ComputePipeline::new(&module, "pnaen_own_finish_main"),
        }
    }

    /// Compiles them.
    ///
    /// # Errors
    /// The driver refuses them, out of memory, or a lost device.
    pub fn prepare(&self, gpu: &super::Gpu) -> Result<(), super::GpuError> {
        [&self.start, &self.edges, &self.insides, &self.finish].iter().try_for_each(|one| one.get(gpu).map(|_| ()))
    }
}
