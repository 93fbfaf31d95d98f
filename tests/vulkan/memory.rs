//! Buffers and pictures on the device.

use std::rc::Rc;

use ash::vk;

use super::device::{Vulkan, VulkanError};

/// A buffer with memory of its own.
pub(crate) struct Buffer {
    vulkan: Rc<Vulkan>,
    pub handle: vk::Buffer,
    memory: vk::DeviceMemory,
    pub bytes: u64,
}

impl Buffer {
    /// Makes a buffer on the device, for storage and copies.
    ///
    /// # Errors
    /// No memory.
    pub(crate) fn on_device(vulkan: &Rc<Vulkan>, bytes: u64) -> Result<Self, VulkanError> {
        Self::new(vulkan, bytes, vk::MemoryPropertyFlags::DEVICE_LOCAL, "a buffer")
    }

    /// Makes a buffer on the device that holds `items`.
    ///
    /// # Errors
    /// No memory, or a lost device.
    pub(crate) fn filled<T: bytemuck::NoUninit>(vulkan: &Rc<Vulkan>, items: &[T]) -> Result<Self, VulkanError> {
        let contents: &[u8] = bytemuck::cast_slice(items);
        let staging = Self::for_host(vulkan, contents.len() as u64)?;
        staging.with_host(|to| to.copy_from_slice(contents))?;
        let buffer = Self::on_device(vulkan, contents.len() as u64)?;
        buffer.copy_from(&staging)?;
        Ok(buffer)
    }

    /// Makes a buffer that the host can read and write.
    ///
    /// # Errors
    /// No memory.
    pub(crate) fn for_host(vulkan: &Rc<Vulkan>, bytes: u64) -> Result<Self, VulkanError> {
        let flags = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        Self::new(vulkan, bytes, flags, "reading back")
    }

    fn new(
        vulkan: &Rc<Vulkan>,
        bytes: u64,
        flags: vk::MemoryPropertyFlags,
        what: &'static str,
    ) -> Result<Self, VulkanError> {
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::TRANSFER_SRC
            | vk::BufferUsageFlags::TRANSFER_DST
            | vk::BufferUsageFlags::UNIFORM_BUFFER
            | vk::BufferUsageFlags::VERTEX_BUFFER
            | vk::BufferUsageFlags::INDEX_BUFFER;
        unsafe {
            let info = vk::BufferCreateInfo::default().size(bytes.max(4)).usage(usage);
            let handle = vulkan.device.create_buffer(&info, None)?;
            let memory = vulkan.allocate(vulkan.device.get_buffer_memory_requirements(handle), flags, what)?;
            vulkan.device.bind_buffer_memory(handle, memory, 0)?;
            Ok(Self { vulkan: vulkan.clone(), handle, memory, bytes })
        }
    }

    /// Copies all of another buffer of the same size into this one, and waits.
    ///
    /// # Errors
    /// The device was lost.
    pub(crate) fn copy_from(&self, from: &Self) -> Result<super::device::Took, VulkanError> {
        let region = [vk::BufferCopy::default().size(self.bytes)];
        self.vulkan.run(|commands| unsafe {
            self.vulkan.device.cmd_copy_buffer(commands, from.handle, self.handle, &region);
        })
    }

    /// Calls `look` with the bytes of a buffer that the host can access.
    ///
    /// # Errors
    /// The host can't access the buffer.
    pub(crate) fn with_host<R>(&self, look: impl FnOnce(&mut [u8]) -> R) -> Result<R, VulkanError> {
        unsafe {
            let device = &self.vulkan.device;
            let at = device.map_memory(self.memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty())?;
            let looked = look(std::slice::from_raw_parts_mut(at.cast(), self.bytes as usize));
            device.unmap_memory(self.memory);
            Ok(looked)
        }
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        unsafe {
            self.vulkan.device.destroy_buffer(self.handle, None);
            self.vulkan.device.free_memory(self.memory, None);
        }
    }
}

/// A picture to draw into, with its own memory and view.
pub(crate) struct Picture {
    vulkan: Rc<Vulkan>,
    pub image: vk::Image,
    pub view: vk::ImageView,
    memory: vk::DeviceMemory,
}

impl Picture {
    /// Makes a picture of this width and height in px.
    ///
    /// # Errors
    /// No memory.
    pub(crate) fn new(
        vulkan: &Rc<Vulkan>,
        size: [u32; 2],
        format: vk::Format,
        samples: vk::SampleCountFlags,
        usage: vk::ImageUsageFlags,
    ) -> Result<Self, VulkanError> {
        Self::with_levels(vulkan, size, 1, format, samples, usage)
    }

    /// Makes a picture with so many mip levels.
    ///
    /// # Errors
    /// No memory.
    pub(crate) fn with_levels(
        vulkan: &Rc<Vulkan>,
        [width, height]: [u32; 2],
        levels: u32,
        format: vk::Format,
        samples: vk::SampleCountFlags,
        usage: vk::ImageUsageFlags,
    ) -> Result<Self, VulkanError> {
        let is_depth = usage.contains(vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT);
        let aspect = if is_depth { vk::ImageAspectFlags::DEPTH } else { vk::ImageAspectFlags::COLOR };
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(vk::Extent3D { width, height, depth: 1 })
            .mip_levels(levels)
            .array_layers(1)
            .samples(samples)
            .usage(usage);
        let range = vk::ImageSubresourceRange::default().aspect_mask(aspect).level_count(levels).layer_count(1);
        unsafe {
            let image = vulkan.device.create_image(&info, None)?;
            let needs = vulkan.device.get_image_memory_requirements(image);
            let memory = vulkan.allocate(needs, vk::MemoryPropertyFlags::DEVICE_LOCAL, "a picture")?;
            vulkan.device.bind_image_memory(image, memory, 0)?;
            let view = vk::ImageViewCreateInfo::default()
                .image(image)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(format)
                .subresource_range(range);
            let view = vulkan.device.create_image_view(&view, None)?;
            Ok(Self { vulkan: vulkan.clone(), image, view, memory })
        }
    }
}

impl Drop for Picture {
    fn drop(&mut self) {
        unsafe {
            self.vulkan.device.destroy_image_view(self.view, None);
            self.vulkan.device.destroy_image(self.image, None);
            self.vulkan.device.free_memory(self.memory, None);
        }
    }
}

/// Any other handle of the device, with the function that destroys it.
pub(crate) struct Owned<T: Copy> {
    vulkan: Rc<Vulkan>,
    pub handle: T,
    destroy: unsafe fn(&ash::Device, T),
}

impl<T: Copy> Owned<T> {
    pub(crate) fn new(vulkan: &Rc<Vulkan>, handle: T, destroy: unsafe fn(&ash::Device, T)) -> Self {
        Self { vulkan: vulkan.clone(), handle, destroy }
    }
}

impl<T: Copy> Drop for Owned<T> {
    fn drop(&mut self) {
        unsafe { (self.destroy)(&self.vulkan.device, self.handle) };
    }
}
