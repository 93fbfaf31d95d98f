//! The options of the camera that LOD is computed for.

use clap::Args;
use glam::Vec2;

use super::{CameraOption, Position, Size, SurfaceOptions};
use crate::mesh::{Bounds, Mesh};
use crate::render::Camera;

/// A camera that LOD, clipping and culling are computed for, in place of the picture's.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(crate) struct LodCameraOption {
    /// Compute LOD, clipping and culling for this camera in place of the picture's, and draw its frustum as lines; the numbers are
    /// those of --camera
    #[arg(long, value_name = "AZIMUTH,ELEVATION[,DISTANCE]", allow_hyphen_values = true)]
    pub lod_camera: Option<CameraOption>,
    /// The point that the LOD camera looks at, in object units (by default the centre of everything that is shown)
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, requires = "lod_camera")]
    pub lod_target: Option<Position>,
    /// Width and height of the LOD camera's view, in px (by default those of --size)
    #[arg(long, value_name = "WxH", requires = "lod_camera")]
    pub lod_size: Option<Size>,
    /// Orthographic projection for the LOD camera
    #[arg(long, requires = "lod_camera")]
    pub lod_orthographic: bool,
}

impl LodCameraOption {
    /// The LOD camera and its view's size in px, if it isn't the picture's. `own` are the options of the picture's camera.
    pub(crate) fn camera(&self, own: &SurfaceOptions, mesh: &Mesh, bounds: &Bounds) -> Option<(Camera, Vec2)> {
        let options = SurfaceOptions {
            camera: self.lod_camera?,
            target: self.lod_target,
            size: self.lod_size.unwrap_or(own.size),
            orthographic: self.lod_orthographic,
            ..own.clone()
        };
        Some((options.camera(mesh, bounds), options.viewport()))
    }
}
