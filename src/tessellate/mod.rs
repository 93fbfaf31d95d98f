//! The mathematics on the CPU: the reference that the shaders are held against. `shaders/X.wgsl` is the twin of `X.rs`.

pub mod domain;
pub mod factors;
