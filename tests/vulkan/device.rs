//! The engine's device, opened once more with tessellation stages, its memory, and timed submissions.
//!
//! `unsafe`, here and in the files beside it: ash's functions require that handles are alive, come from this device and are used
//! by one thread. That holds, since all handles are made from one [`Vulkan`], their owners keep it alive, and every submission is
//! waited for before anything else happens.

use std::ffi::CStr;
use std::rc::Rc;
use std::time::Instant;

use ash::vk;
use thiserror::Error;

/// Why there is no peer here.
#[derive(Debug, Error)]
pub(crate) enum VulkanError {
    #[error("Vulkan can't be loaded here ({0})")]
    Loader(#[from] ash::LoadingError),
    #[error("{0} is not among Vulkan's devices")]
    NoDevice(String),
    #[error("{0} has no tessellation stages under Vulkan")]
    NoTessellation(String),
    #[error("{0} has no memory of the kind that {1} needs")]
    NoMemory(String, &'static str),
    #[error("a shader can't be read ({0})")]
    Shader(#[from] std::io::Error),
    #[error("Vulkan reports {0}")]
    Refused(#[from] vk::Result),
}

/// The time of one submission in ms: by the GPU's clock if that is reliable (else the same as `wall`), and by the host's clock
/// from recording to completion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Took {
    pub gpu: f64,
    pub wall: f64,
}

/// What the pipeline counted: invocations of the domain shader, and triangles that left the tessellation stages.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Counted {
    pub evaluations: u64,
    pub triangles: u64,
}

/// A device with tessellation stages.
pub(crate) struct Vulkan {
    /// Keeps the loader's library open.
    _entry: ash::Entry,
    instance: ash::Instance,
    pub device: ash::Device,
    name: String,
    memory: vk::PhysicalDeviceMemoryProperties,
    queue: vk::Queue,
    commands: vk::CommandPool,
    command_buffer: vk::CommandBuffer,
    done: vk::Fence,
    timestamps: vk::QueryPool,
    /// `None` if the driver doesn't count.
    statistics: Option<vk::QueryPool>,
    /// The ns per tick; `None` if timestamps aren't reliable.
    tick_ns: Option<f64>,
}

impl Vulkan {
    /// Opens the device of wgpu's adapter.
    ///
    /// # Errors
    /// There is no Vulkan, no such device, or it has no tessellation stages.
    pub(crate) fn new(adapter: &wgpu::AdapterInfo) -> Result<Rc<Self>, VulkanError> {
        unsafe {
            let entry = ash::Entry::load()?;
            let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_1);
            let instance =
                entry.create_instance(&vk::InstanceCreateInfo::default().application_info(&application), None)?;
            match Self::open(entry, instance.clone(), adapter) {
                Ok(vulkan) => Ok(Rc::new(vulkan)),
                Err(error) => {
                    instance.destroy_instance(None);
                    Err(error)
                }
            }
        }
    }

    unsafe fn open(
        entry: ash::Entry,
        instance: ash::Instance,
        adapter: &wgpu::AdapterInfo,
    ) -> Result<Self, VulkanError> {
        unsafe {
            let physical = find(&instance, adapter)?;
            let has = instance.get_physical_device_features(physical);
            if has.tessellation_shader == vk::FALSE {
                return Err(VulkanError::NoTessellation(adapter.name.clone()));
            }
            let family = family(&instance, physical).ok_or_else(|| VulkanError::NoDevice(adapter.name.clone()))?;
            let features = vk::PhysicalDeviceFeatures {
                tessellation_shader: vk::TRUE,
                pipeline_statistics_query: has.pipeline_statistics_query,
                geometry_shader: has.geometry_shader,
                vertex_pipeline_stores_and_atomics: has.vertex_pipeline_stores_and_atomics,
                ..Default::default()
            };
            let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&[1.0])];
            let info = vk::DeviceCreateInfo::default().queue_create_infos(&queues).enabled_features(&features);
            let device = instance.create_device(physical, &info, None)?;
            let software = adapter.device_type == wgpu::DeviceType::Cpu;
            let ns = instance.get_physical_device_properties(physical).limits.timestamp_period;
            let commands = device.create_command_pool(
                &vk::CommandPoolCreateInfo::default()
                    .queue_family_index(family)
                    .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER),
                None,
            )?;
            let allocate = vk::CommandBufferAllocateInfo::default().command_pool(commands).command_buffer_count(1);
            let two = vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::TIMESTAMP).query_count(2);
            let counted = vk::QueryPoolCreateInfo::default()
                .query_type(vk::QueryType::PIPELINE_STATISTICS)
                .query_count(1)
                .pipeline_statistics(COUNTED);
            let counts = has.pipeline_statistics_query == vk::TRUE;
            Ok(Self {
                memory: instance.get_physical_device_memory_properties(physical),
                queue: device.get_device_queue(family, 0),
                commands,
                command_buffer: device.allocate_command_buffers(&allocate)?[0],
                done: device.create_fence(&vk::FenceCreateInfo::default(), None)?,
                timestamps: device.create_query_pool(&two, None)?,
                statistics: counts.then(|| device.create_query_pool(&counted, None)).transpose()?,
                tick_ns: (!software).then_some(f64::from(ns)),
                name: adapter.name.clone(),
                device,
                instance,
                _entry: entry,
            })
        }
    }

    /// Records commands, submits them, and waits for them.
    ///
    /// # Errors
    /// The device was lost.
    pub(crate) fn run(&self, record: impl FnOnce(vk::CommandBuffer)) -> Result<Took, VulkanError> {
        let start = Instant::now();
        let commands = self.command_buffer;
        unsafe {
            let device = &self.device;
            let once = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
            device.begin_command_buffer(commands, &once)?;
            device.cmd_reset_query_pool(commands, self.timestamps, 0, 2);
            device.cmd_write_timestamp(commands, vk::PipelineStageFlags::TOP_OF_PIPE, self.timestamps, 0);
            record(commands);
            device.cmd_write_timestamp(commands, vk::PipelineStageFlags::BOTTOM_OF_PIPE, self.timestamps, 1);
            device.end_command_buffer(commands)?;
            device.queue_submit(self.queue, &[vk::SubmitInfo::default().command_buffers(&[commands])], self.done)?;
            device.wait_for_fences(&[self.done], true, u64::MAX)?;
            let wall = start.elapsed().as_secs_f64() * 1e3;
            device.reset_fences(&[self.done])?;
            let mut ticks = [0u64; 2];
            let wait = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
            device.get_query_pool_results(self.timestamps, 0, &mut ticks, wait)?;
            let gpu = self.tick_ns.map(|ns| ticks[1].saturating_sub(ticks[0]) as f64 * ns * 1e-6);
            Ok(Took { gpu: gpu.unwrap_or(wall), wall })
        }
    }

    /// Runs a submission once and returns what its pipelines counted; `None` if the driver doesn't count.
    ///
    /// # Errors
    /// The device was lost.
    pub(crate) fn count(&self, record: impl FnOnce(vk::CommandBuffer)) -> Result<Option<Counted>, VulkanError> {
        let Some(pool) = self.statistics else { return Ok(None) };
        let device = &self.device;
        self.run(|commands| unsafe {
            device.cmd_reset_query_pool(commands, pool, 0, 1);
            device.cmd_begin_query(commands, pool, 0, vk::QueryControlFlags::empty());
            record(commands);
            device.cmd_end_query(commands, pool, 0);
        })?;
        // Results are in the order of the flags' bits: triangles that reach clipping, then domain shader invocations.
        let mut counted = [[0u64; 2]];
        let wait = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
        unsafe { device.get_query_pool_results(pool, 0, &mut counted, wait)? };
        Ok(Some(Counted { triangles: counted[0][0], evaluations: counted[0][1] }))
    }

    /// The index of a memory type for a resource.
    fn memory_type(&self, bits: u32, flags: vk::MemoryPropertyFlags) -> Option<u32> {
        let types = self.memory.memory_types_as_slice();
        (0..).zip(types).find(|(i, own)| bits & 1 << i != 0 && own.property_flags.contains(flags)).map(|(i, _)| i)
    }

    /// Allocates memory; `what` names its use in messages.
    ///
    /// # Errors
    /// The device has no such memory, or not enough.
    pub(crate) fn allocate(
        &self,
        needs: vk::MemoryRequirements,
        flags: vk::MemoryPropertyFlags,
        what: &'static str,
    ) -> Result<vk::DeviceMemory, VulkanError> {
        let kind = self.memory_type(needs.memory_type_bits, flags);
        let kind = kind.ok_or_else(|| VulkanError::NoMemory(self.name.clone(), what))?;
        let info = vk::MemoryAllocateInfo::default().allocation_size(needs.size).memory_type_index(kind);
        Ok(unsafe { self.device.allocate_memory(&info, None)? })
    }
}

impl Drop for Vulkan {
    fn drop(&mut self) {
        unsafe {
            // Waiting for a lost device fails, but it is destroyed all the same.
            let _ = self.device.device_wait_idle();
            self.device.destroy_query_pool(self.timestamps, None);
            if let Some(pool) = self.statistics {
                self.device.destroy_query_pool(pool, None);
            }
            self.device.destroy_fence(self.done, None);
            self.device.destroy_command_pool(self.commands, None);
            self.device.destroy_device(None);
            self.instance.destroy_instance(None);
        }
    }
}

/// The statistics that [`Vulkan::count`] reads.
const COUNTED: vk::QueryPipelineStatisticFlags = vk::QueryPipelineStatisticFlags::from_raw(
    vk::QueryPipelineStatisticFlags::CLIPPING_INVOCATIONS.as_raw()
        | vk::QueryPipelineStatisticFlags::TESSELLATION_EVALUATION_SHADER_INVOCATIONS.as_raw(),
);

/// Finds the physical device of wgpu's adapter, by vendor, device and name.
unsafe fn find(instance: &ash::Instance, adapter: &wgpu::AdapterInfo) -> Result<vk::PhysicalDevice, VulkanError> {
    let is_it = |physical: &vk::PhysicalDevice| {
        let own = unsafe { instance.get_physical_device_properties(*physical) };
        let name = own.device_name_as_c_str().map(CStr::to_string_lossy).unwrap_or_default();
        own.vendor_id == adapter.vendor && own.device_id == adapter.device && name == adapter.name
    };
    let found = unsafe { instance.enumerate_physical_devices()? }.into_iter().find(is_it);
    found.ok_or_else(|| VulkanError::NoDevice(adapter.name.clone()))
}

/// Finds a queue family that can draw and compute.
unsafe fn family(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Option<u32> {
    let both = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
    let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
    (0..).zip(families).find(|(_, own)| own.queue_flags.contains(both)).map(|(index, _)| index)
}
