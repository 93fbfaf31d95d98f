//! What is made on a device when it is first needed.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Mutex, OnceLock, PoisonError};

use super::{Gpu, GpuError};

/// Something that is made on a device when it is first needed, once, and then kept: a pipeline, say, whose shaders the driver
/// takes a while to compile.
#[derive(Debug)]
pub struct Lazy<T> {
    made: OnceLock<T>,
    /// Held by the thread that makes it.
    making: Mutex<()>,
}

impl<T> Default for Lazy<T> {
    fn default() -> Self {
        Self { made: OnceLock::new(), making: Mutex::new(()) }
    }
}

impl<T> Lazy<T> {
    /// What was made before, or else what `make` makes now. Threads that ask at the same time wait for the one that makes it.
    ///
    /// What the device refuses while it is made is an error of this call and is reported nowhere else, whatever error scopes
    /// the caller has open. Nothing is kept then, so the next call tries again.
    ///
    /// # Errors
    /// Out of memory, a refused command, or a lost device.
    pub fn get_or_make(&self, gpu: &Gpu, make: impl FnOnce() -> T) -> Result<&T, GpuError> {
        if let Some(made) = self.made.get() {
            return Ok(made);
        }
        self.get_or_try_make(|| {
            let made = gpu.attempt(make)?;
            gpu.note_made();
            Ok(made)
        })
    }

    /// The same for what says itself whether it could be made.
    ///
    /// # Errors
    /// Those of `make`. Nothing is kept then, so the next call tries again.
    pub fn get_or_try_make(&self, make: impl FnOnce() -> Result<T, GpuError>) -> Result<&T, GpuError> {
        // There is nothing that a thread could have left half done when it panicked.
        let _making = self.making.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(made) = self.made.get() {
            return Ok(made);
        }
        let made = make()?;
        Ok(self.made.get_or_init(|| made))
    }

    /// Whether it was made.
    pub fn is_made(&self) -> bool {
        self.made.get().is_some()
    }
}

/// What a list has for a key: what was made before, or else what `make` makes now while others wait.
pub fn made_once<K: Eq + Hash, T: Clone>(made: &Mutex<HashMap<K, T>>, key: K, make: impl FnOnce() -> T) -> T {
    // What is behind the lock is whole even if a thread panicked while it held it.
    let mut made = made.lock().unwrap_or_else(PoisonError::into_inner);
    made.entry(key).or_insert_with(make).clone()
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    fn gpu() -> Gpu {
        Gpu::headless().expect("these tests need a graphics adapter: run ./setup.sh")
    }

    #[test]
    fn threads_that_ask_at_once_get_one_thing_made_once() {
        let (gpu, lazy, made) = (gpu(), Lazy::default(), AtomicUsize::new(0));
        let make = || {
            std::thread::sleep(std::time::Duration::from_millis(20));
            made.fetch_add(1, Ordering::SeqCst)
        };
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| assert_eq!(lazy.get_or_make(&gpu, make).ok(), Some(&0)));
            }
        });
        assert_eq!(made.into_inner(), 1);
    }

    #[test]
    fn what_is_refused_is_the_error_of_that_call_alone_and_is_tried_again() {
        let (gpu, lazy) = (gpu(), Lazy::default());
        // Nothing can be mapped to be read and to be written.
        let buffer = |usage| {
            let descriptor = wgpu::BufferDescriptor { label: None, size: 4, usage, mapped_at_creation: false };
            gpu.device.create_buffer(&descriptor)
        };
        let outer = gpu.attempt(|| {
            let refused =
                lazy.get_or_make(&gpu, || buffer(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::MAP_WRITE));
            assert!(matches!(refused, Err(GpuError::Refused(_))), "{refused:?}");
        });
        assert!(outer.is_ok(), "the scope around it hears nothing of it");
        assert!(gpu.check().is_ok(), "and neither does who asks for what nobody has asked for");
        assert!(!lazy.is_made());
        assert!(lazy.get_or_make(&gpu, || buffer(wgpu::BufferUsages::MAP_READ)).is_ok() && lazy.is_made());
    }

    #[test]
    fn a_lost_device_makes_nothing() {
        let (gpu, lazy) = (gpu(), Lazy::default());
        gpu.device.destroy();
        gpu.wait();
        let lost = lazy.get_or_make(&gpu, || ());
        assert!(matches!(lost, Err(GpuError::Lost(_))), "{lost:?}");
        assert!(!lazy.is_made());
    }
}
