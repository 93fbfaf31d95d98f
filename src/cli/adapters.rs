//! `pnaen adapters`: lists the graphics adapters.

use std::io::Write;

use super::{CliError, refuse};
use gpu::{AdapterChoice, GpuError, adapters, best_adapter, driver, kind};

/// Prints a line for each adapter.
pub(super) fn run() -> Result<(), CliError> {
    let all = adapters();
    if all.is_empty() {
        return Err(GpuError::NoAdapter.into());
    }
    let best = best_adapter().ok().map(|adapter| adapter.get_info());
    let mut out = std::io::stdout().lock();
    for adapter in &all {
        let info = adapter.get_info();
        let limits = adapter.limits();
        let is_best = best.as_ref() == Some(&info);
        let timestamps = adapter.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let timestamps = timestamps && info.device_type != wgpu::DeviceType::Cpu;
        writeln!(
            out,
            "{} {}: {}, {:?}, {}; buffers up to {} MiB, pictures up to {} px a side{}",
            if is_best { "*" } else { " " },
            info.name,
            kind(info.device_type),
            info.backend,
            driver(&info),
            limits.max_storage_buffer_binding_size.min(limits.max_buffer_size) >> 20,
            limits.max_texture_dimension_2d,
            if timestamps { "; timestamps" } else { "" },
        )
        .map_err(CliError::Output)?;
    }
    writeln!(out, "* marks the adapter that is used unless --adapter names another.").map_err(CliError::Output)
}

/// The option `--adapter`.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct AdapterOption {
    /// Graphics adapter: part of its name as `pnaen adapters` lists it, or `software`; by default the fastest
    #[arg(long, value_name = "NAME|software")]
    pub adapter: Option<AdapterChoice>,
}

impl AdapterOption {
    /// Refuses --adapter where the CPU computes.
    pub fn check(&self, is_cpu: bool) -> Result<(), CliError> {
        let has_both = is_cpu && self.adapter.is_some();
        refuse(has_both, "--adapter chooses a graphics adapter, but --device cpu uses none: leave one of them out")
    }

    pub fn choice(&self) -> AdapterChoice {
        self.adapter.clone().unwrap_or_default()
    }
}
