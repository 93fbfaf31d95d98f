//! An adapter and its device, with or without a window.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use super::GpuError;
use super::adapters::{AdapterChoice, adapters, best_adapter};

/// A device that tessellates and draws.
#[derive(Clone, Debug)]
pub struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    /// Name, driver and kind of the adapter.
    pub info: wgpu::AdapterInfo,
    reported: Reported,
    /// Samples a px that the viewport is drawn with: 4 where the adapter has it, else 1.
    pub samples: u32,
    /// The rasteriser rounds corners to a grid of one px by 2 to the power of this.
    pub subpixel_bits: u32,
}

/// How the viewport's texture is drawn into and resolved to: sRGB-encoded 8-bit RGBA.
pub const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// What is asked of a device: WebGPU's defaults, larger buffers and timestamps where the adapter has them. Software
/// drivers' timestamps are wrong for compute, so they are not asked for theirs.
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

/// How finely an adapter rasterises, in bits of a px.
fn subpixel_bits(adapter: &wgpu::Adapter) -> u32 {
    // Vulkan has none that is coarser (Vulkan specification, required limits).
    const LEAST: u32 = 4;
    let info = adapter.get_info();
    match info.backend {
        // lavapipe says 8, and covers samples that slivers miss by 1/100 px.
        _ if info.device_type == wgpu::DeviceType::Cpu => LEAST,
        // Direct3D 11.3 functional specification, 3.4.4.1.
        wgpu::Backend::Dx12 => 8,
        _ => vulkan_subpixel_bits(adapter).unwrap_or(LEAST),
    }
}

#[cfg(any(windows, target_os = "linux"))]
fn vulkan_subpixel_bits(adapter: &wgpu::Adapter) -> Option<u32> {
    // SAFETY: wgpu has this limit nowhere else. Nothing is made or destroyed: a property of the physical device, which lives
    // as long as the instance and so as long as what is borrowed here, is read.
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

/// What a device has reported.
#[derive(Clone, Debug, Default)]
struct Reported {
    /// The first problem that nobody has asked for yet.
    problem: Arc<Mutex<Option<GpuError>>>,
    /// Why it was lost, for good.
    lost: Arc<OnceLock<String>>,
}

/// Keeps what the device reports, in place of wgpu's own panic.
fn watch(device: &wgpu::Device) -> Reported {
    let reported = Reported::default();
    let problem = reported.problem.clone();
    device.on_uncaptured_error(Arc::new(move |error| {
        problem.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(in_words(error));
    }));
    let lost = reported.lost.clone();
    device.set_device_lost_callback(move |reason, message| {
        let destroyed = reason == wgpu::DeviceLostReason::Destroyed;
        // Nobody hears of one that the program has let go of; wgpu has no words for one that it destroys.
        let _ = lost.set(if destroyed { "it was destroyed".into() } else { message.replace('\n', " ") });
    });
    reported
}

fn in_words(error: wgpu::Error) -> GpuError {
    match error {
        wgpu::Error::OutOfMemory { .. } => GpuError::OutOfMemory,
        error => GpuError::Refused(error.to_string().replace('\n', " ")),
    }
}

impl Gpu {
    /// The machine's best adapter, without a window.
    ///
    /// # Errors
    /// No adapter, or one that gives no device.
    pub fn headless() -> Result<Self, GpuError> {
        Self::on(&best_adapter()?)
    }

    /// The adapter that was asked for, without a window.
    ///
    /// # Errors
    /// There is none such, or it gives no device.
    pub fn chosen(choice: &AdapterChoice) -> Result<Self, GpuError> {
        match choice {
            AdapterChoice::Best => Self::headless(),
            choice => Self::on(choice.among(&adapters())?),
        }
    }

    /// A device of its own on an adapter, beside others there: what waits for one doesn't make another wait.
    ///
    /// # Errors
    /// The adapter gives none.
    pub fn on(adapter: &wgpu::Adapter) -> Result<Self, GpuError> {
        let (device, queue) = pollster::block_on(adapter.request_device(&device_descriptor(adapter)))
            .map_err(|error| GpuError::NoDevice { adapter: adapter.get_info().name, reason: error.to_string() })?;
        Ok(Self::new(adapter, device, queue))
    }

    /// Takes over a device that a window already has.
    pub fn new(adapter: &wgpu::Adapter, device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let flags = |format: wgpu::TextureFormat| adapter.get_texture_format_features(format).flags;
        let four = wgpu::TextureFormatFeatureFlags::MULTISAMPLE_X4;
        let multisampled = flags(COLOR_FORMAT).contains(four) && flags(DEPTH_FORMAT).contains(four);
        let reported = watch(&device);
        let samples = if multisampled { 4 } else { 1 };
        Self { device, queue, info: adapter.get_info(), reported, samples, subpixel_bits: subpixel_bits(adapter) }
    }

    /// What the device has reported since the last call, if anything: commands don't fail where they are given. A lost device
    /// is so for good.
    ///
    /// # Errors
    /// Out of memory, a refused command, or a lost device.
    pub fn check(&self) -> Result<(), GpuError> {
        if let Some(why) = self.lost() {
            return Err(GpuError::Lost(why.to_owned()));
        }
        // A thread that panicked while it held the lock leaves text that is still whole.
        match self.reported.problem.lock().unwrap_or_else(PoisonError::into_inner).take() {
            Some(problem) => Err(problem),
            None => Ok(()),
        }
    }

    /// Lets what the device has finished be known. wgpu panics where a driver says that the device is lost right then; that
    /// is known from [`Self::lost`] by that time.
    pub fn poll(&self, how: wgpu::PollType) {
        let _ = catch_unwind(AssertUnwindSafe(|| self.device.poll(how)));
    }

    /// Why the device was lost, if it was.
    pub fn lost(&self) -> Option<&str> {
        self.reported.lost.get().map(String::as_str)
    }

    /// What `make` makes on this thread; what the device refuses of it is its own error, and reported nowhere else.
    ///
    /// # Errors
    /// Out of memory, a refused command, or a lost device.
    pub fn attempt<T>(&self, make: impl FnOnce() -> T) -> Result<T, GpuError> {
        let filters = [wgpu::ErrorFilter::Internal, wgpu::ErrorFilter::Validation, wgpu::ErrorFilter::OutOfMemory];
        let scopes = filters.map(|filter| self.device.push_error_scope(filter));
        let made = make();
        let mut refused = None;
        // The last one pushed goes first.
        for scope in scopes.into_iter().rev() {
            refused = refused.or(pollster::block_on(scope.pop()));
        }
        match (self.lost(), refused) {
            (Some(why), _) => Err(GpuError::Lost(why.to_owned())),
            (None, Some(error)) => Err(in_words(error)),
            (None, None) => Ok(made),
        }
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
