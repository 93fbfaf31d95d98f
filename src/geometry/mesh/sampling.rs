//! How images are sampled, and what is beyond them.

use crate::defaults::with_defaults;

with_defaults! {
    /// How an image is sampled, in the words of WebGPU.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct Sampling {
        /// Beyond the image, along u and v.
        pub wrap: [Wrap; 2] = [Wrap::Repeat; 2],
        /// Whether texels are blended where they are larger than pixels.
        pub magnify_linear: bool = true,
        /// The same where they are smaller.
        pub minify_linear: bool = true,
        /// Whether mip levels are used, and blended (`Some(true)`).
        pub mip_linear: Option<bool> = Some(true),
    }
}

/// What is beyond an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// Its border.
    Clamp,
    /// The image again.
    Repeat,
    /// The image again, mirrored every other time.
    Mirror,
}
