//! Scenes on the window's device.

use gpu::GpuError;
use inspect::engine::{Engine, Loaded};
use inspect::render::Scene;
use inspect::settings::ARENA_BYTES;

/// Memory for a tessellation's output, in bytes. A software adapter gets less, so that each step of a picture is short.
pub(crate) fn arena_bytes(engine: &Engine) -> u64 {
    if engine.gpu.is_software() { ARENA_BYTES / 8 } else { ARENA_BYTES }
}

/// A mesh on the device, unless the device has no room for it.
///
/// # Errors
/// The mesh needs a larger buffer than the adapter can bind, the device is out of memory, or it was lost.
pub(crate) fn scene_of(engine: &Engine, loaded: &Loaded) -> Result<Scene, GpuError> {
    engine.gpu.attempt(|| engine.scene(loaded, arena_bytes(engine)))?
}
