//! Shader modules and compute pipelines, each made when it is first needed.

use std::borrow::Cow;
use std::sync::Arc;

use super::lazy::Lazy;
use super::wgsl::WgslFile;
use super::{Gpu, GpuError};

/// A shader module, made when it is first needed.
pub struct ShaderModule {
    name: &'static str,
    text: ModuleText,
    made: Lazy<wgpu::ShaderModule>,
}

/// Where a module's text comes from.
enum ModuleText {
    /// The file with its entry points, and the files that it needs.
    File(&'static WgslFile),
    Made(String),
}

impl ShaderModule {
    /// The module whose entry points are in `file`.
    pub fn new(file: &'static WgslFile) -> Self {
        Self { name: file.name, text: ModuleText::File(file), made: Lazy::default() }
    }

    /// The module with this text.
    pub(super) fn of_text(name: &'static str, text: String) -> Self {
        Self { name, text: ModuleText::Made(text), made: Lazy::default() }
    }

    /// The module on the device, which is the same at every call.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn get(&self, gpu: &Gpu) -> Result<&wgpu::ShaderModule, GpuError> {
        self.made.get_or_make(gpu, || {
            let text = match &self.text {
                ModuleText::File(file) => Cow::Owned(file.module_text()),
                ModuleText::Made(text) => Cow::Borrowed(&**text),
            };
            gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(self.name),
                source: wgpu::ShaderSource::Wgsl(text),
            })
        })
    }
}

/// A compute pipeline whose bind group layouts are what its entry point uses, made when it is first needed.
pub struct ComputePipeline {
    module: Arc<ShaderModule>,
    entry_point: &'static str,
    /// Values of the module's `override` constants, by name.
    constants: Vec<(&'static str, f64)>,
    made: Lazy<wgpu::ComputePipeline>,
}

impl ComputePipeline {
    pub fn new(module: &Arc<ShaderModule>, entry_point: &'static str) -> Self {
        Self { module: module.clone(), entry_point, constants: Vec::new(), made: Lazy::default() }
    }

    /// The same with a value for one of the module's `override` constants.
    pub(super) fn with(mut self, constant: &'static str, value: u32) -> Self {
        self.constants.push((constant, value.into()));
        self
    }

    pub fn entry_point(&self) -> &'static str {
        self.entry_point
    }

    /// The pipeline on the device, which is the same at every call.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn get(&self, gpu: &Gpu) -> Result<&wgpu::ComputePipeline, GpuError> {
        let module = self.module.get(gpu)?;
        self.made.get_or_make(gpu, || {
            gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(self.entry_point),
                layout: None,
                module,
                entry_point: Some(self.entry_point),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &self.constants,
                    ..Default::default()
                },
                cache: None,
            })
        })
    }
}
