//! What only tests need, those of other crates too.

pub mod random;
pub mod reflectance;
pub mod tone;
