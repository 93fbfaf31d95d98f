//! Shader modules and compute pipelines, each made when it is first needed, and what pipelines are bound to.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock};

use wgpu::naga;

use super::lazy::{Lazy, made_once};
use super::wgsl::WgslModule;
use super::{Gpu, GpuError};

/// A shader module, made when it is first needed.
pub struct ShaderModule {
    name: &'static str,
    /// The text, if it was made; else it is that of the module's files.
    text: Option<String>,
    made: Lazy<wgpu::ShaderModule>,
    /// What each entry point uses of group 0: bindings and the names of their variables.
    variables: OnceLock<HashMap<String, Vec<(u32, String)>>>,
}

impl ShaderModule {
    /// The module whose entry points are in the file of this name.
    pub fn new(name: &'static str) -> Self {
        Self { name, text: None, made: Lazy::default(), variables: OnceLock::new() }
    }

    /// The module with this text.
    pub(super) fn from_text(name: &'static str, text: String) -> Self {
        Self { text: Some(text), ..Self::new(name) }
    }

    fn text(&self) -> Cow<'_, str> {
        self.text.as_deref().map_or_else(|| WgslModule(self.name).text().into(), Cow::from)
    }

    /// The module on the device, which is the same at every call.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    #[allow(unsafe_code, reason = "wgpu offers no other way to leave out a counter in every loop")]
    pub fn get(&self, gpu: &Gpu) -> Result<&wgpu::ShaderModule, GpuError> {
        // wgpu counts the turns of each loop, which is a quarter of the time of searches and of a software driver's compiler.
        let mut checks = wgpu::ShaderRuntimeChecks::checked();
        checks.force_loop_bounding = self.text.is_some();
        self.made.get_or_make(gpu, || {
            let source = wgpu::ShaderSource::Wgsl(self.text());
            let descriptor = wgpu::ShaderModuleDescriptor { label: Some(self.name), source };
            // SAFETY: all other checks stay, and every loop of the shader files ends. Texts that are made may have functions of
            // the user's own.
            unsafe { gpu.device.create_shader_module_trusted(descriptor, checks) }
        })
    }

    /// Binds what an entry point uses of group 0 to what each of its variables stands for, under the layout that wgpu makes of
    /// it.
    pub fn bind<'a>(
        &self,
        gpu: &Gpu,
        entry_point: &str,
        layout: &wgpu::BindGroupLayout,
        resource: impl Fn(&str) -> Option<wgpu::BindingResource<'a>>,
    ) -> wgpu::BindGroup {
        // A text that can't be read makes no pipeline either, which is reported.
        let variables = self.variables.get_or_init(|| variables(&self.text()).unwrap_or_default());
        let used = variables.get(entry_point).into_iter().flatten();
        let entry = |(binding, name): &(u32, String)| {
            Some(wgpu::BindGroupEntry { binding: *binding, resource: resource(name)? })
        };
        let entries: Vec<_> = used.filter_map(entry).collect();
        let descriptor = wgpu::BindGroupDescriptor { label: Some(entry_point), layout, entries: &entries };
        gpu.device.create_bind_group(&descriptor)
    }
}

/// Shader modules by the names of the files with their entry points.
#[derive(Default)]
pub struct ShaderModules(Mutex<HashMap<&'static str, Arc<ShaderModule>>>);

impl ShaderModules {
    /// The module of this name, which is the same at every call.
    pub fn get(&self, name: &'static str) -> Arc<ShaderModule> {
        made_once(&self.0, name, || Arc::new(ShaderModule::new(name)))
    }
}

/// The bindings and names of the variables of group 0 that each entry point of a module uses.
fn variables(text: &str) -> Option<HashMap<String, Vec<(u32, String)>>> {
    let module = naga::front::wgsl::parse_str(text).ok()?;
    // wgpu checks it.
    let unchecked = naga::valid::ValidationFlags::empty();
    let info = naga::valid::Validator::new(unchecked, naga::valid::Capabilities::all()).validate(&module).ok()?;
    let of = |(index, entry_point): (usize, &naga::EntryPoint)| {
        let used = info.get_entry_point(index);
        let variable = |(handle, variable): (naga::Handle<naga::GlobalVariable>, &naga::GlobalVariable)| {
            let binding = variable.binding.filter(|binding| binding.group == 0 && !used[handle].is_empty())?;
            Some((binding.binding, variable.name.clone()?))
        };
        (entry_point.name.clone(), module.global_variables.iter().filter_map(variable).collect())
    };
    Some(module.entry_points.iter().enumerate().map(of).collect())
}

/// Which pass a compute pipeline runs: an entry point, with values of its module's `override` constants.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Pass {
    pub(super) module: &'static str,
    entry_point: &'static str,
    constants: [Option<(&'static str, u32)>; 3],
}

impl Pass {
    pub(super) const fn new(module: &'static str, entry_point: &'static str) -> Self {
        Self { module, entry_point, constants: [None; 3] }
    }

    /// The same with a value for a constant. It has up to three.
    pub(super) fn with(self, constant: &'static str, value: u32) -> Self {
        let [first, second, third] = self.constants;
        assert!(third.is_none(), "{} would lose the value of a constant", self.entry_point);
        Self { constants: [Some((constant, value)), first, second], ..self }
    }
}

/// A compute pipeline whose bind group layouts are what its entry point uses, made when it is first needed.
pub struct ComputePipeline {
    module: Arc<ShaderModule>,
    pub(super) pass: Pass,
    made: Lazy<wgpu::ComputePipeline>,
}

impl ComputePipeline {
    pub fn new(module: &Arc<ShaderModule>, entry_point: &'static str) -> Self {
        Self::from_module(module, Pass::new(module.name, entry_point))
    }

    /// The pipeline of a pass of this module.
    pub(super) fn from_module(module: &Arc<ShaderModule>, pass: Pass) -> Self {
        Self { module: module.clone(), pass, made: Lazy::default() }
    }

    pub fn entry_point(&self) -> &'static str {
        self.pass.entry_point
    }

    /// The pipeline on the device, which is the same at every call.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn get(&self, gpu: &Gpu) -> Result<&wgpu::ComputePipeline, GpuError> {
        let module = self.module.get(gpu)?;
        let constants = self.pass.constants.iter().flatten().map(|&(name, value)| (name, f64::from(value)));
        let constants: Vec<_> = constants.collect();
        self.made.get_or_make(gpu, || {
            gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(self.pass.entry_point),
                layout: None,
                module,
                entry_point: Some(self.pass.entry_point),
                compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
                cache: None,
            })
        })
    }

    /// The pass with group 0 bound to what each of its variables stands for.
    ///
    /// # Errors
    /// The pipeline can't be made: out of memory, or a lost device.
    pub fn bind<'a>(
        &self,
        gpu: &Gpu,
        resource: impl Fn(&str) -> Option<wgpu::BindingResource<'a>>,
    ) -> Result<BoundPass, GpuError> {
        let pipeline = self.get(gpu)?.clone();
        let group = self.module.bind(gpu, self.pass.entry_point, &pipeline.get_bind_group_layout(0), resource);
        Ok(BoundPass { pipeline, group })
    }
}

/// A compute pipeline, and its bind group 0.
#[derive(Clone)]
pub struct BoundPass {
    pub pipeline: wgpu::ComputePipeline,
    pub group: wgpu::BindGroup,
}

impl BoundPass {
    /// Runs it over a grid of workgroups.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass, [x, y, z]: [u32; 3]) {
        self.set(pass);
        pass.dispatch_workgroups(x, y, z);
    }

    pub(crate) fn set(&self, pass: &mut wgpu::ComputePass) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
    }
}

/// A pass, and over how many workgroups it runs.
pub(crate) struct Step {
    pub bound: BoundPass,
    pub workgroups: Workgroups,
}

/// How many workgroups a pass has.
#[derive(Clone)]
pub(crate) enum Workgroups {
    Grid([u32; 3]),
    /// As many as this buffer says.
    Counted(wgpu::Buffer),
}

impl Step {
    pub(crate) fn run(&self, pass: &mut wgpu::ComputePass) {
        self.bound.set(pass);
        match &self.workgroups {
            Workgroups::Grid([x, y, z]) => pass.dispatch_workgroups(*x, *y, *z),
            Workgroups::Counted(buffer) => pass.dispatch_workgroups_indirect(buffer, 0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PASS: Pass = Pass::new("pass_requests", "search_patches_main");

    #[test]
    fn a_pass_keeps_all_of_its_constants() {
        let pass = PASS.with("A", 1).with("B", 2).with("C", 3);
        let mut kept: Vec<_> = pass.constants.into_iter().flatten().collect();
        kept.sort_unstable();
        assert_eq!(kept, [("A", 1), ("B", 2), ("C", 3)]);
    }

    #[test]
    #[should_panic(expected = "search_patches_main would lose the value of a constant")]
    fn a_constant_too_many_is_not_lost_in_silence() {
        let _ = PASS.with("A", 1).with("B", 2).with("C", 3).with("D", 4);
    }
}
