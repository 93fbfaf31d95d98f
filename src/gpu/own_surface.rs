//! Control points from a function of the user's own, in place of those of a surface: the module that runs it, and its
//! pipelines.

use std::sync::Arc;

use super::compute_pipeline::{ComputePipeline, ShaderModule};
use super::own_functions::{OWN_WORK, OwnFunction, OwnPurpose, OwnShader, OwnText};
use super::wgsl::{CONTROL_POINTS, TYPES, WgslFile};

static SURFACE_CONTRACT: WgslFile = WgslFile::new("surface_contract", &[]);
static OWN_EDGE_POINTS: WgslFile = WgslFile::new("own_edge_points", &[&SURFACE_CONTRACT]);
pub(super) static PASS_OWN_SURFACE: WgslFile =
    WgslFile::new("pass_own_surface", &[&CONTROL_POINTS, &OWN_EDGE_POINTS, &OWN_WORK, &SURFACE_CONTRACT, &TYPES]);

pub static SURFACE_PURPOSE: OwnPurpose = OwnPurpose {
    name: "surface shader",
    contract: &SURFACE_CONTRACT,
    functions: &[OwnFunction {
        name: "edge_points",
        parameters: &["SurfaceEdge", "SurfaceTriangle"],
        result: "EdgePoints",
        signature: "fn edge_points(edge: SurfaceEdge, triangle: SurfaceTriangle) -> EdgePoints",
        stand_in: &OWN_EDGE_POINTS,
    }],
    pass: &PASS_OWN_SURFACE,
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

/// The pipelines of one user's function.
pub struct OwnSurfacePipelines {
    pub(super) start: ComputePipeline,
    pub(super) points: ComputePipeline,
    pub(super) finish: ComputePipeline,
}

impl OwnSurfacePipelines {
    /// Compiles nothing yet.
    pub(super) fn new(shader: &SurfaceShader) -> Self {
        let module = Arc::new(ShaderModule::of_text(PASS_OWN_SURFACE.name, shader.module_text()));
        Self {
            start: ComputePipeline::new(&module, "pnaen_own_surface_start_main"),
            points: ComputePipeline::new(&module, "pnaen_own_surface_points_main"),
            finish: ComputePipeline::new(&module, "pnaen_own_surface_finish_main"),
        }
    }

    /// Compiles them.
    ///
    /// # Errors
    /// The driver refuses them, out of memory, or a lost device.
    pub fn prepare(&self, gpu: &super::Gpu) -> Result<(), super::GpuError> {
        [&self.start, &self.points, &self.finish].iter().try_for_each(|one| one.get(gpu).map(|_| ()))
    }
}
