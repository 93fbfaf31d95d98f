//! Factors from functions of the user's own, in place of those of LOD: the module that runs them, and its pipelines.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use super::compute_pipeline::{ComputePipeline, ShaderModule};
use super::wgsl::{CONVENTION, FACTORS, LOAD_NET, LOADS, TYPES, WgslFile, joined, wgsl};
use super::wgsl_tokens::{declared, tokens};
use crate::tessellate::HullFactors;

/// The structs that the functions get.
pub(crate) static LOD_CONTRACT: WgslFile = wgsl!("lod_contract");
static OWN_EDGE_FACTOR: WgslFile = wgsl!("own_edge_factor", LOD_CONTRACT);
static OWN_INSIDE_FACTOR: WgslFile = wgsl!("own_inside_factor", CONVENTION, FACTORS, LOD_CONTRACT, TYPES);
pub(super) static PASS_OWN_LOD: WgslFile =
    wgsl!("pass_own_lod", CONVENTION, LOAD_NET, LOADS, LOD_CONTRACT, OWN_EDGE_FACTOR, OWN_INSIDE_FACTOR, TYPES);

/// What stands before every name of this program in a module that has functions of the user's own.
pub(crate) const OWN_PREFIX: &str = "pnaen_";

/// The names of the functions that a user's file may have. The first one it must have.
pub(crate) const LOD_FUNCTIONS: [&str; 2] = ["edge_factor", "inside_factor"];

/// Functions of the user's own, checked and bounded, as `crate::lod_shader` makes them.
#[derive(Debug, PartialEq, Eq)]
pub struct LodShader {
    /// The text of the file, in which every loop calls `pnaen_spend`.
    functions: String,
    /// Whether there is a function for inside factors.
    has_inside: bool,
}

impl LodShader {
    #[cfg(any(test, feature = "cli"))]
    pub(crate) fn new(functions: String, has_inside: bool) -> Self {
        Self { functions, has_inside }
    }

    /// The text of the module that runs them. It begins with the user's file, so that lines are those of the file.
    pub(crate) fn module_text(&self) -> String {
        let is_ours = |file: &&WgslFile| {
            let is_default = file.name == OWN_INSIDE_FACTOR.name && !self.has_inside;
            is_default || ![LOD_CONTRACT.name, OWN_EDGE_FACTOR.name, OWN_INSIDE_FACTOR.name].contains(&file.name)
        };
        let ours: Vec<_> = PASS_OWN_LOD.module_files().into_iter().filter(is_ours).collect();
        format!("{}\n{}\n{}", self.functions, LOD_CONTRACT.text, prefixed(&joined(&ours)))
    }
}

/// Puts the prefix before every name that a text declares, but not before those of the user's functions.
fn prefixed(text: &str) -> String {
    let all = tokens(text);
    let names: std::collections::HashSet<_> = declared(&all).iter().map(|name| name.text).collect();
    let (mut out, mut copied) = (String::with_capacity(text.len() * 5 / 4), 0);
    for token in all.iter().filter(|token| names.contains(token.text) && !LOD_FUNCTIONS.contains(&token.text)) {
        out += &text[copied..token.at];
        out += OWN_PREFIX;
        copied = token.at;
    }
    out + &text[copied..]
}

/// The names that a user's file mustn't declare: the structs of the contract, and functions and types of WGSL that the rest of
/// the module needs. WGSL lets a file declare those anew.
#[cfg(any(test, feature = "cli"))]
pub(crate) fn needed_names() -> std::collections::HashSet<String> {
    let text = LodShader::new(String::new(), false).module_text();
    let all = tokens(&text);
    let scalars = ["bool", "f32", "i32", "u32"].into_iter().map(str::to_owned);
    let used = all.windows(2).filter(|pair| pair[0].is_word() && ["(", "<"].contains(&pair[1].text));
    let used =
        used.map(|pair| pair[0].text).chain(declared(&tokens(LOD_CONTRACT.text)).into_iter().map(|name| name.text));
    used.filter(|name| !LOD_FUNCTIONS.contains(name)).map(str::to_owned).chain(scalars).collect()
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

/// What is known after functions of the user's own ran for all patches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct LodReport {
    work: u32,
    /// 1 if their loops took too long. All factors are 1 then.
    pub stopped: u32,
    /// Factors that are NaN.
    pub not_numbers: u32,
}

/// The pipelines of one user's functions.
pub(crate) struct OwnLodPipelines {
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
    #[cfg(any(test, feature = "cli"))]
    pub(crate) fn prepare(&self, gpu: &super::Gpu) -> Result<(), super::GpuError> {
        [&self.start, &self.edges, &self.insides, &self.finish].iter().try_for_each(|one| one.get(gpu).map(|_| ()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_ours_get_a_prefix_and_the_rest_stays() {
        let text =
            "struct A { b: u32 }\nfn c(a: A) -> u32 { return a.b + c2; } // A\nconst c2 = 1u;\nfn edge_factor() {}";
        let renamed = "struct pnaen_A { b: u32 }\nfn pnaen_c(a: pnaen_A) -> u32 { return a.b + pnaen_c2; } // A\n\
                       const pnaen_c2 = 1u;\nfn edge_factor() {}";
        assert_eq!(prefixed(text), renamed);
    }
}
