//! An adapter and its device, with or without a window.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use super::GpuError;
use super::adapters::{AdapterChoice, adapters, best_adapter};

/// A device, and what is known of its adapter. Cheap to clone; clones are the same device.
#[derive(Clone, Debug)]
pub struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    /// None if the device was borrowed from a host program.
    adapter: Option<wgpu::Adapter>,
    /// Name, driver and kind of the adapter.
    pub info: wgpu::AdapterInfo,
    reported: Reported,
    /// Samples a pixel that render targets have at most: see [`Self::samples`].
    pub most_samples: u32,
    /// The rasteriser rounds corners to a grid whose spacing is 1 px divided by 2 to the power of this.
    pub subpixel_bits: u32,
    made: Arc<AtomicU64>,
}

/// What is requested of a device: WebGPU's default limits, but buffers and textures as large as the adapter has them, and
/// timestamps if the adapter has them. The timestamps of software drivers are wrong for compute passes, so they aren't used.
pub fn device_descriptor(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
    let has = adapter.limits();
    let mut limits = wgpu::Limits::default();
    limits.max_buffer_size = limits.max_buffer_size.max(has.max_buffer_size.min(1 << 32));
    limits.max_storage_buffer_binding_size =
        limits.max_storage_buffer_binding_size.max(has.max_storage_buffer_binding_size.min(1 << 31));
    limits.max_texture_dimension_2d = has.max_texture_dimension_2d;
    let software = adapter.get_info().device_type == wgpu::DeviceType::Cpu;
    let timestamps = if software { wgpu::Features::empty() } else { wgpu::Features::TIMESTAMP_QUERY };
    wgpu::DeviceDescriptor {
        label: Some("pnaen"),
        required_features: adapter.features() & timestamps,
        required_limits: limits,
        ..Default::default()
    }
}

/// Every Vulkan adapter has at least this many (Vulkan specification, required limits).
const LEAST_SUBPIXEL_BITS: u32 = 4;

/// The number of fractional bits, in px, of the positions that an adapter rasterises.
fn subpixel_bits(adapter: &wgpu::Adapter) -> u32 {
    let info = adapter.get_info();
    match info.backend {
        // lavapipe claims 8, but it covers samples that thin triangles miss by 1/100 px.
        _ if info.device_type == wgpu::DeviceType::Cpu => LEAST_SUBPIXEL_BITS,
        // Direct3D 11.3 functional specification, 3.4.4.1.
        wgpu::Backend::Dx12 => 8,
        _ => vulkan_subpixel_bits(adapter).unwrap_or(LEAST_SUBPIXEL_BITS),
    }
}

#[cfg(any(windows, target_os = "linux"))]
#[allow(unsafe_code, reason = "wgpu offers this limit nowhere else")]
fn vulkan_subpixel_bits(adapter: &wgpu::Adapter) -> Option<u32> {
    // SAFETY: wgpu offers this limit nowhere else. Nothing is made or destroyed: this reads a property of the physical device,
    // which lives as long as the instance, and the borrowed adapter keeps that alive.
    unsafe {
        let adapter = adapter.as_hal::<wgpu::hal::api::Vulkan>()?;
        let instance = adapter.shared_instance().raw_instance();
        Some(instance.get_physical_device_properties(adapter.raw_physical_device()).limits.sub_pixel_precision_bits)
    }
}

#[cfg(not(any(windows, target_os = "linux")))]
fn vulkan_subpixel_bits(_: &wgpu::Adapter) -> Option<u32> {
    None
}

/// What a device has reported outside any error scope.
#[derive(Clone, Debug, Default)]
struct Reported {
    /// The first error since [`Gpu::check`] was last called.
    problem: Arc<Mutex<Option<GpuError>>>,
    /// Why the device was lost, if it was; a lost device stays lost.
    lost: Arc<OnceLock<String>>,
}

impl Reported {
    fn problem(&self) -> MutexGuard<'_, Option<GpuError>> {
        // What is behind the lock is whole even if a thread panicked while it held it.
        self.problem.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn note(&self, error: GpuError) {
        self.problem().get_or_insert(error);
    }
}

/// Installs handlers that keep what the device reports. wgpu's own handler panics.
fn watch(device: &wgpu::Device) -> Reported {
    let reported = Reported::default();
    let noted = reported.clone();
    device.on_uncaptured_error(Arc::new(move |error| {
        if !is_of_busy_surface(&error) {
            noted.note(in_words(error));
        }
    }));
    let lost = reported.lost.clone();
    device.set_device_lost_callback(move |reason, message| {
        let destroyed = reason == wgpu::DeviceLostReason::Destroyed;
        // A device that the program itself destroys comes with no message.
        let _ = lost.set(if destroyed { "it was destroyed".into() } else { message.replace('\n', " ") });
    });
    reported
}

/// Whether a window's surface couldn't be made anew because another thread gave the device work while wgpu waited for it to be idle. The
/// surface stays as it was, and the next frame tries again.
fn is_of_busy_surface(error: &wgpu::Error) -> bool {
    // wgpu has no type for it that can be named.
    error.to_string().contains("Failed to wait for GPU to come idle before reconfiguring the Surface")
}

fn in_words(error: wgpu::Error) -> GpuError {
    match error {
        wgpu::Error::OutOfMemory { .. } => GpuError::OutOfMemory,
        error => GpuError::Refused(error.to_string().replace('\n', " ")),
    }
}

impl Gpu {
    /// A device on the machine's best adapter, without a window.
    ///
    /// # Errors
    /// No adapter, or one that gives no device.
    pub fn headless() -> Result<Self, GpuError> {
        Self::on(&best_adapter()?)
    }

    /// A device on the adapter that was requested, without a window.
    ///
    /// # Errors
    /// There is none such, or it gives no device.
    pub fn chosen(choice: &AdapterChoice) -> Result<Self, GpuError> {
        match choice {
            AdapterChoice::Best => Self::headless(),
            choice => Self::on(choice.among_able(&adapters(), |_| true)?),
        }
    }

    /// A new device on an adapter, which may have others: waiting for one of them doesn't wait for another.
    ///
    /// # Errors
    /// The adapter gives none.
    pub fn on(adapter: &wgpu::Adapter) -> Result<Self, GpuError> {
        let (device, queue) = pollster::block_on(adapter.request_device(&device_descriptor(adapter)))
            .map_err(|error| GpuError::NoDevice { adapter: adapter.get_info().name, reason: error.to_string() })?;
        Ok(Self::new(adapter, device, queue))
    }

    /// Takes over a device that exists already, such as a window's, and installs handlers for its errors.
    pub fn new(adapter: &wgpu::Adapter, device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let reported = watch(&device);
        Self {
            device,
            queue,
            info: adapter.get_info(),
            adapter: Some(adapter.clone()),
            reported,
            most_samples: 4,
            subpixel_bits: subpixel_bits(adapter),
            made: Arc::default(),
        }
    }

    /// Borrows the device of a host program. No error handlers are installed and no limits are requested: what the device
    /// refuses outside of [`Self::attempt`] reaches the host's own handlers.
    pub fn borrowed(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        Self {
            device: device.clone(),
            queue: queue.clone(),
            info: device.adapter_info(),
            adapter: None,
            reported: Reported::default(),
            most_samples: 1,
            subpixel_bits: LEAST_SUBPIXEL_BITS,
            made: Arc::default(),
        }
    }

    /// Samples a pixel of render targets in these formats: 4 where the adapter has that for all of them and
    /// [`Self::most_samples`] allows it, else 1.
    pub fn samples(&self, formats: &[wgpu::TextureFormat]) -> u32 {
        let four = wgpu::TextureFormatFeatureFlags::MULTISAMPLE_X4;
        let has_four = |format: &wgpu::TextureFormat| {
            let features = self.adapter.as_ref().map(|adapter| adapter.get_texture_format_features(*format));
            features.is_some_and(|features| features.flags.contains(four))
        };
        if self.most_samples >= 4 && formats.iter().all(has_four) { 4 } else { 1 }
    }

    /// What the device has reported since the last call, if anything. Commands don't fail where they are given, but later. Once
    /// the device is lost, every call says so.
    ///
    /// # Errors
    /// Out of memory, a refused command, or a lost device.
    pub fn check(&self) -> Result<(), GpuError> {
        if let Some(why) = self.lost() {
            return Err(GpuError::Lost(why.to_owned()));
        }
        self.reported.problem().take().map_or(Ok(()), Err)
    }

    /// Runs the callbacks of what the device has finished. wgpu panics if the driver says right then that the device is lost;
    /// that panic alone is caught, since [`Self::lost`] knows of it by then. [`Self::check`] tells what else fails.
    pub fn poll(&self, how: wgpu::PollType) {
        match catch_unwind(AssertUnwindSafe(|| self.device.poll(how))) {
            Ok(Ok(_)) => {}
            Ok(Err(error)) => self.reported.note(GpuError::Refused(error.to_string())),
            Err(_) if self.lost().is_some() => {}
            Err(panic) => resume_unwind(panic),
        }
    }

    /// Waits until the device has done all that was submitted. If it is lost meanwhile, this returns, and [`Self::check`] says
    /// so.
    pub fn wait(&self) {
        self.poll(wgpu::PollType::wait_indefinitely());
    }

    /// Why the device was lost, if it was.
    pub fn lost(&self) -> Option<&str> {
        self.reported.lost.get().map(String::as_str)
    }

    /// Runs `make` on this thread, and returns what it made unless the device has refused one of its commands. Such an error is
    /// returned here and reported nowhere else.
    ///
    /// # Errors
    /// Out of memory, a refused command, or a lost device.
    pub fn attempt<T>(&self, make: impl FnOnce() -> T) -> Result<T, GpuError> {
        let filters = [wgpu::ErrorFilter::Internal, wgpu::ErrorFilter::Validation, wgpu::ErrorFilter::OutOfMemory];
        let scopes = filters.map(|filter| self.device.push_error_scope(filter));
        let made = make();
        let mut refused = None;
        // Scopes are popped in the reverse of the order in which they were pushed.
        for scope in scopes.into_iter().rev() {
            refused = refused.or(pollster::block_on(scope.pop()));
        }
        match (self.lost(), refused) {
            (Some(why), _) => Err(GpuError::Lost(why.to_owned())),
            (None, Some(error)) => Err(in_words(error)),
            (None, None) => Ok(made),
        }
    }

    /// How many pipelines and other things have been made on the device when they were first needed.
    pub fn made_when_needed(&self) -> u64 {
        self.made.load(Ordering::Relaxed)
    }

    pub(super) fn note_made(&self) {
        self.made.fetch_add(1, Ordering::Relaxed);
    }

    /// Whether the adapter runs on the CPU.
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Whether the GPU's own clock can time passes.
    pub fn has_timestamps(&self) -> bool {
        self.device.features().contains(wgpu::Features::TIMESTAMP_QUERY)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_surface_that_couldnt_wait_for_a_busy_device_is_no_error() {
        let error = |text: &str| {
            let source = Box::from(text);
            wgpu::Error::Validation {
                source,
                description: format!("Validation Error Caused by: In Surface::configure {text}"),
            }
        };
        assert!(is_of_busy_surface(&error("Failed to wait for GPU to come idle before reconfiguring the Surface")));
        assert!(!is_of_busy_surface(&error("Invalid surface")));
    }

    #[test]
    fn a_panic_of_a_callback_isnt_swallowed() {
        let gpu = Gpu::headless().expect("an adapter");
        let (usage, mapped_at_creation) = (wgpu::BufferUsages::MAP_READ, false);
        let descriptor = wgpu::BufferDescriptor { label: None, size: 4, usage, mapped_at_creation };
        let buffer = gpu.device.create_buffer(&descriptor);
        buffer.map_async(wgpu::MapMode::Read, .., |_| panic!("this callback fails on purpose"));
        assert!(catch_unwind(AssertUnwindSafe(|| gpu.wait())).is_err());
    }
}
