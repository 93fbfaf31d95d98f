//! What triangles cover on screen, for their outline.

use glam::{Mat4, Vec3};

use super::adding::{Added, Adding};
use crate::measure::{OutlineOf, SampleGrid};
use gpu::{Gpu, GpuError};

/// Draws what triangles cover.
pub(crate) struct SilhouetteDrawer(Adding);

impl SilhouetteDrawer {
    /// Compiles nothing yet.
    pub(crate) fn new() -> Self {
        // A channel for each of `OutlineOf::ALL`, which stays at 1 however many triangles cover a sample.
        let (format, factor) = (wgpu::TextureFormat::Rgba8Unorm, wgpu::BlendFactor::Constant);
        Self(Adding::new("silhouette_fragment", format, factor, wgpu::ColorWrites::ALL))
    }

    /// Starts with nothing covered. `clip_from_object` is that of the picture without its margin.
    ///
    /// # Errors
    /// The picture is larger than the adapter draws, or the device was lost.
    pub(crate) fn start(&self, gpu: &Gpu, grid: SampleGrid, clip_from_object: Mat4) -> Result<Added, GpuError> {
        let limit = gpu.device.limits().max_texture_dimension_2d;
        let [width, height] = grid.size();
        if width > limit || height > limit {
            let ([width, height], [padded, _]) = (grid.picture, grid.padded());
            return Err(GpuError::PictureTooLarge { width, height, limit: limit.saturating_sub(padded - width) });
        }
        self.0.start(gpu, grid.size(), padded_clip(grid, clip_from_object))
    }
}

/// The matrix of a picture with its margin, in which a px is as large as without.
pub(crate) fn padded_clip(grid: SampleGrid, clip_from_object: Mat4) -> Mat4 {
    let [x, y] = [0, 1].map(|axis| grid.picture[axis] as f32 / grid.padded()[axis] as f32);
    Mat4::from_scale(Vec3::new(x, y, 1.0)) * clip_from_object
}

/// The blend constant that marks what is covered in the channel of one outline.
pub(crate) fn channel(of: OutlineOf) -> wgpu::Color {
    let [r, g, b] = OutlineOf::ALL.map(|other| f64::from(u8::from(other == of)));
    wgpu::Color { r, g, b, a: 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{vec2, vec3};

    #[test]
    fn a_px_of_the_padded_picture_is_one_of_the_picture() {
        let grid = SampleGrid { picture: [200, 100], per_px: 1 };
        let [width, height] = grid.padded().map(|side| side as f32);
        let corner = padded_clip(grid, Mat4::IDENTITY).transform_point3(vec3(1.0, 1.0, 0.5));
        let from_middle = 0.5 * vec2(corner.x * width, corner.y * height);
        assert!(from_middle.abs_diff_eq(vec2(100.0, 50.0), 1e-4), "{from_middle}");
    }
}
