//! `pnaen adapters`: what there is to compute and draw on.

use std::io::Write;

use super::CliError;
use crate::gpu::{AdapterChoice, GpuError, adapters, best_adapter, kind};

#[derive(Debug, clap::Args)]
pub(crate) struct Args {}

/// One line an adapter.
pub(super) fn run(_: &Args) -> Result<(), CliError> {
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
        let driver = [info.driver, info.driver_info].join(" ");
        let timestamps = adapter.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let timestamps = timestamps && info.device_type != wgpu::DeviceType::Cpu;
        writeln!(
            out,
            "{} {}: {}, {:?}, {}; buffers of {} MiB, pictures of {} px a side{}",
            if is_best { "*" } else { " " },
            info.name,
            kind(info.device_type),
            info.backend,
            driver.trim(),
            limits.max_storage_buffer_binding_size.min(limits.max_buffer_size) >> 20,
            limits.max_texture_dimension_2d,
            if timestamps { "; times passes by its own clock" } else { "" },
        )
        .map_err(CliError::Output)?;
    }
    writeln!(out, "* is what is taken unless --adapter says otherwise.").map_err(CliError::Output)
}

/// Where to compute and draw.
#[derive(Clone, Debug, Default, clap::Args)]
pub(crate) struct AdapterOption {
    /// Graphics adapter: part of its name as `pnaen adapters` lists it, or `software`; by default the fastest
    #[arg(long, value_name = "NAME|software")]
    pub adapter: Option<AdapterChoice>,
}

impl AdapterOption {
    /// Refuses an adapter where nothing runs on one.
    ///
    /// # Errors
    /// There is one, and `is_cpu` is set.
    pub(crate) fn check(&self, is_cpu: bool) -> Result<(), CliError> {
        match is_cpu && self.adapter.is_some() {
            true => Err(CliError::Usage(
                "--adapter says which graphics adapter computes, and --device cpu that none does: leave one of them out",
            )),
            false => Ok(()),
        }
    }

    pub(crate) fn choice(&self) -> AdapterChoice {
        self.adapter.clone().unwrap_or_default()
    }
}
