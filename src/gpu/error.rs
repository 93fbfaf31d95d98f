//! What can go wrong between here and the graphics driver.

use thiserror::Error;

/// Why something could not be done on the device. The message says what to do.
#[derive(Clone, Debug, Error)]
#[non_exhaustive]
#[allow(missing_docs, reason = "the messages say what the fields are")]
pub enum GpuError {
    /// The machine has no adapter that the passes run on.
    #[error(
        "no graphics adapter was found: install a Vulkan driver (the software one is in Debian's mesa-vulkan-drivers)"
    )]
    NoAdapter,
    /// No adapter has the name that was requested.
    #[error("no graphics adapter has \"{name}\" in its name: there are {has} (pnaen adapters)")]
    NoSuchAdapter { name: String, has: String },
    /// No adapter runs in software.
    #[error(
        "no graphics adapter runs in software: there are {has}; install a driver that does (Debian's mesa-vulkan-drivers)"
    )]
    NoSoftwareAdapter { has: String },
    /// The adapter can't show a window.
    #[error(
        "the adapter {name} can't show a window on this display: choose another (pnaen adapters), or use the commands (pnaen --help)"
    )]
    NoWindow { name: String },
    /// The adapter gave no device.
    #[error("the adapter {adapter} gave no device ({reason}): update its driver, or choose another adapter")]
    NoDevice { adapter: String, reason: String },
    /// A buffer would be larger than the device binds, in bytes.
    #[error(
        "the mesh's {what} take {bytes} bytes and the adapter binds at most {limit}: use a mesh with fewer triangles or another adapter"
    )]
    TooLarge { what: &'static str, bytes: u64, limit: u64 },
    /// The mesh has more patches than one scan covers.
    #[error("the mesh has {patches} patches, and at most {limit} can be tessellated in a single run: split the mesh")]
    TooManyPatches { patches: u64, limit: u64 },
    /// The pose was made with another rig than the mesh's.
    #[error("the pose has {has} {what}, and the mesh's rig has {needs}: make the pose with that rig (Mesh::rig)")]
    OtherRig { what: &'static str, has: usize, needs: usize },
    /// The mesh has fewer materials.
    #[error("the mesh has no material {material}: it has {has}, which are numbered from 0 on (Mesh::materials)")]
    NoSuchMaterial { material: u32, has: usize },
    /// The device was made with lower limits than the passes need.
    #[error("the device allows {has} of {what}, and the passes need {needs}: request wgpu's default limits")]
    Limits { what: &'static str, has: u64, needs: u64 },
    /// A picture is larger than the device allows, in px.
    #[error("a picture of {width} x {height} px is larger than the adapter's {limit} px a side: ask for a smaller one")]
    PictureTooLarge { width: u32, height: u32, limit: u32 },
    /// Loops of functions of the user's own took too long.
    #[error(
        "the loops of the {0} took too long, for one edge or for all together, so it was stopped: bound the loops more tightly"
    )]
    UserShaderTimedOut(&'static str),
    /// The device has no memory left.
    #[error("the graphics device is out of memory: ask for a smaller picture, or open a smaller mesh")]
    OutOfMemory,
    /// The device refused a command, which is an error in this crate or in the driver.
    #[error(
        "the graphics device refused a command ({0}): this is an error in pnaen or in the driver; please report it"
    )]
    Refused(String),
    /// The device was lost.
    #[error("the graphics device was lost ({0}): try again, or update its driver")]
    Lost(String),
    /// Nothing could be read back.
    #[error("reading back from the graphics device failed ({0}): the device may have been lost; try again")]
    Readback(String),
}
