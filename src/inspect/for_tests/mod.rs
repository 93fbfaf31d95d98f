//! What only tests need, those of other crates too: the light of the shaders on the CPU, and settings at random.

pub mod environment;
pub mod prefiltered;
pub mod punctual;
pub mod random;
pub mod reflectance;
pub mod sunlit;
pub mod tone;
