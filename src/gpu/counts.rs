//! Chunk tables on their way to the host.

use std::sync::mpsc::{Receiver, TryRecvError, channel};

use super::GpuError;
use super::layout::Chunk;
use super::recorder::mapped_bytes;

/// A copy of the tables of all slabs.
pub struct PendingCounts {
    staging: wgpu::Buffer,
    /// Once they have been asked for.
    mapped: Option<Receiver<Result<(), wgpu::BufferAsyncError>>>,
}

impl PendingCounts {
    /// What will be copied into `staging`, which can be mapped.
    pub fn new(staging: wgpu::Buffer) -> Self {
        Self { staging, mapped: None }
    }

    /// Asks for them, once the copy was submitted.
    pub fn request(&mut self) {
        if self.mapped.is_none() {
            let (sender, receiver) = channel();
            self.staging.map_async(wgpu::MapMode::Read, .., move |result| {
                let _ = sender.send(result);
            });
            self.mapped = Some(receiver);
        }
    }

    /// The tables, if they are here.
    ///
    /// # Errors
    /// The device was lost.
    pub fn poll(&self) -> Result<Option<Vec<Chunk>>, GpuError> {
        let Some(mapped) = &self.mapped else { return Ok(None) };
        match mapped.try_recv() {
            Err(TryRecvError::Empty) => Ok(None),
            Err(error @ TryRecvError::Disconnected) => Err(GpuError::Readback(error.to_string())),
            Ok(result) => self.take(result).map(Some),
        }
    }

    /// The tables, if they were asked for, once the device has finished them: another thread that polls may still be
    /// running the callback.
    ///
    /// # Errors
    /// The device was lost.
    pub fn wait(&self) -> Result<Option<Vec<Chunk>>, GpuError> {
        let Some(mapped) = &self.mapped else { return Ok(None) };
        match mapped.recv() {
            Ok(result) => self.take(result).map(Some),
            Err(error) => Err(GpuError::Readback(error.to_string())),
        }
    }

    fn take(&self, mapped: Result<(), wgpu::BufferAsyncError>) -> Result<Vec<Chunk>, GpuError> {
        mapped.map_err(|error| GpuError::Readback(error.to_string()))?;
        Ok(bytemuck::pod_collect_to_vec(&mapped_bytes(&self.staging)?))
    }
}
