//! Bytes from the device to the host. This is the one place that copies for the host, maps, and waits for what was mapped.

use std::ops::Range;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use super::{Gpu, GpuError};

/// How long [`Readback::wait`] waits for a callback once the device has done its work: others' callbacks may run before it.
const PATIENCE: Duration = Duration::from_secs(60);

/// Bytes on their way to the host: a copy in a buffer that can be mapped.
///
/// 1. [`Self::from_buffers`] or [`Self::from_texture`] records the copy.
/// 2. Once the encoder was submitted, [`Self::request`] requests the bytes.
/// 3. [`Self::poll`] tells whether they are here, without waiting; then [`Self::bytes`] gives them. Or [`Self::wait`] waits.
pub struct Readback {
    staging: wgpu::Buffer,
    /// How many bytes of each row of the copy are asked for, and how many bytes apart rows start.
    rows: [usize; 2],
    state: State,
}

enum State {
    Recorded,
    /// The mutex makes what holds a readback `Sync`, which a receiver alone isn't.
    Requested(Mutex<Receiver<Result<(), wgpu::BufferAsyncError>>>),
    Mapped,
}

impl Readback {
    /// Records copies of ranges of bytes of buffers, which will come one after another. Their bounds are multiples of 4.
    pub fn from_buffers<'a>(
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        parts: impl IntoIterator<Item = (&'a wgpu::Buffer, Range<u64>)>,
    ) -> Self {
        let parts: Vec<_> = parts.into_iter().filter(|(_, bytes)| !bytes.is_empty()).collect();
        let total: u64 = parts.iter().map(|(_, bytes)| bytes.end - bytes.start).sum();
        let staging = staging_buffer(gpu, total);
        let mut offset = 0;
        for (buffer, bytes) in parts {
            let length = bytes.end - bytes.start;
            encoder.copy_buffer_to_buffer(buffer, bytes.start, &staging, offset, length);
            offset += length;
        }
        let rows = [total, staging.size()].map(|bytes| bytes as usize);
        Self { staging, rows, state: State::Recorded }
    }

    /// Records a copy of a texture's texels, which will come row by row without gaps. The texture has one layer, one mip level
    /// and a format that isn't compressed.
    pub fn from_texture(gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, texture: &wgpu::Texture) -> Self {
        let size = texture.size();
        let used = size.width * texture.format().block_copy_size(None).unwrap_or(0);
        let stride = used.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let staging = staging_buffer(gpu, u64::from(stride) * u64::from(size.height));
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(stride), rows_per_image: None };
        let to = wgpu::TexelCopyBufferInfo { buffer: &staging, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), to, size);
        Self { staging, rows: [used, stride].map(|bytes| bytes as usize), state: State::Recorded }
    }

    /// Copies ranges of bytes of buffers in a submission of its own, and requests them.
    pub fn start<'a>(gpu: &Gpu, parts: impl IntoIterator<Item = (&'a wgpu::Buffer, Range<u64>)>) -> Self {
        Self::submitted(gpu, |encoder| Self::from_buffers(gpu, encoder, parts))
    }

    fn submitted(gpu: &Gpu, record: impl FnOnce(&mut wgpu::CommandEncoder) -> Self) -> Self {
        let descriptor = wgpu::CommandEncoderDescriptor { label: Some("readback") };
        let mut encoder = gpu.device.create_command_encoder(&descriptor);
        let mut readback = record(&mut encoder);
        gpu.queue.submit([encoder.finish()]);
        readback.request();
        readback
    }

    /// Asks for the bytes, once the encoder that the copy was recorded into was submitted. Asking again does nothing.
    pub fn request(&mut self) {
        if matches!(self.state, State::Recorded) {
            let (sender, receiver) = channel();
            self.staging.map_async(wgpu::MapMode::Read, .., move |result| {
                // Nobody waits for a readback that was dropped.
                let _ = sender.send(result);
            });
            self.state = State::Requested(Mutex::new(receiver));
        }
    }

    /// Whether the bytes are here. The device must be polled by someone for that to change: see [`Gpu::poll`].
    ///
    /// # Errors
    /// The device was lost.
    pub fn poll(&mut self) -> Result<bool, GpuError> {
        let State::Requested(receiver) = &mut self.state else { return Ok(matches!(self.state, State::Mapped)) };
        match receiver.get_mut().unwrap_or_else(PoisonError::into_inner).try_recv() {
            Err(TryRecvError::Empty) => Ok(false),
            Err(error @ TryRecvError::Disconnected) => Err(failed(error)),
            Ok(mapped) => self.mapped(mapped).map(|()| true),
        }
    }

    /// The bytes, waiting for all that was submitted. They are requested if they weren't yet.
    ///
    /// # Errors
    /// The device was lost, or it has refused a command that nobody was told of yet.
    pub fn wait(&mut self, gpu: &Gpu) -> Result<Vec<u8>, GpuError> {
        self.arrive(gpu)?;
        self.bytes()
    }

    /// Waits for the bytes as [`Self::wait`] does, and leaves them where they are.
    ///
    /// # Errors
    /// The same.
    pub fn arrive(&mut self, gpu: &Gpu) -> Result<(), GpuError> {
        self.arrive_within(gpu, PATIENCE)
    }

    /// The same, if the bytes come before `patience` has passed once the device has done all that was submitted.
    fn arrive_within(&mut self, gpu: &Gpu, patience: Duration) -> Result<(), GpuError> {
        self.request();
        gpu.wait();
        // A command that was refused explains more than the mapping that failed because of it.
        gpu.check()?;
        if let State::Requested(receiver) = &mut self.state {
            // Another thread that polls the device may still be running the callback, so this waits for it.
            let receiver = receiver.get_mut().unwrap_or_else(PoisonError::into_inner);
            let received = receiver.recv_timeout(patience).map_err(failed);
            // The device may have been lost meanwhile.
            gpu.check()?;
            self.mapped(received?)?;
        }
        Ok(())
    }

    fn mapped(&mut self, result: Result<(), wgpu::BufferAsyncError>) -> Result<(), GpuError> {
        result.map_err(failed)?;
        self.state = State::Mapped;
        Ok(())
    }

    /// A copy of the bytes, which must be here. It may be made on another thread than the one that polled.
    ///
    /// # Errors
    /// The bytes aren't here, or the device was lost.
    pub fn bytes(&self) -> Result<Vec<u8>, GpuError> {
        self.with_bytes(<[u8]>::to_vec)
    }

    /// Gives the bytes, which must be here, to `take`, without a copy of those of buffers. They are aligned to 8 bytes. It may be
    /// called on another thread than the one that polled.
    ///
    /// # Errors
    /// The bytes aren't here, or the device was lost.
    pub fn with_bytes<R>(&self, take: impl FnOnce(&[u8]) -> R) -> Result<R, GpuError> {
        let view = self.staging.get_mapped_range(..).map_err(failed)?;
        let [used, stride] = self.rows;
        if used == stride {
            return Ok(take(&view));
        }
        let rows = view.chunks_exact(stride).flat_map(|row| &row[..used]);
        Ok(take(&rows.copied().collect::<Vec<_>>()))
    }
}

/// Reads `bytes` bytes of a buffer from `offset` on, waiting for them. Both are multiples of 4.
///
/// # Errors
/// The device was lost.
pub fn read_buffer(gpu: &Gpu, buffer: &wgpu::Buffer, offset: u64, bytes: u64) -> Result<Vec<u8>, GpuError> {
    read_buffers(gpu, [(buffer, offset..offset + bytes)])
}

/// Reads ranges of bytes of buffers, one after another, waiting for them. Their bounds are multiples of 4.
///
/// # Errors
/// The device was lost.
pub fn read_buffers<'a>(
    gpu: &Gpu,
    parts: impl IntoIterator<Item = (&'a wgpu::Buffer, Range<u64>)>,
) -> Result<Vec<u8>, GpuError> {
    let parts: Vec<_> = parts.into_iter().filter(|(_, bytes)| !bytes.is_empty()).collect();
    if parts.is_empty() { Ok(Vec::new()) } else { Readback::start(gpu, parts).wait(gpu) }
}

/// Reads a texture's texels row by row, waiting for them: see [`Readback::from_texture`].
///
/// # Errors
/// The device was lost.
pub fn read_texture(gpu: &Gpu, texture: &wgpu::Texture) -> Result<Vec<u8>, GpuError> {
    Readback::submitted(gpu, |encoder| Readback::from_texture(gpu, encoder, texture)).wait(gpu)
}

/// A buffer that copies are written into and that the host maps. It has at least one word, since an empty one can't be mapped.
fn staging_buffer(gpu: &Gpu, bytes: u64) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("readback"),
        size: bytes.max(4),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    })
}

fn failed(error: impl std::error::Error) -> GpuError {
    GpuError::Readback(error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_callback_that_never_comes_is_an_error() {
        let gpu = Gpu::headless().expect("an adapter");
        let staging = staging_buffer(&gpu, 4);
        let (sender, receiver) = channel();
        let state = State::Requested(Mutex::new(receiver));
        let mut readback = Readback { staging, rows: [4; 2], state };
        let read = readback.arrive_within(&gpu, Duration::from_millis(1));
        assert!(matches!(read, Err(GpuError::Readback(_))), "{read:?}");
        drop(sender);
    }
}
