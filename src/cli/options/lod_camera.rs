//! The options of the camera that LOD is computed for.

use clap::Args;
use glam::{Vec2, Vec3};

use super::values::{angle, field_of_view, position, size};
use super::{CameraOption, SurfaceOptions, ViewOptions};
use crate::cli::CliError;
use geometry::mesh::{Bounds, Mesh};
use inspect::render::Camera;
use inspect::render::camera::FIELD_OF_VIEW;

/// A camera that LOD, clipping and culling are computed for, in place of the picture's.
#[derive(Clone, Copy, Debug, Args)]
pub struct LodCameraOption {
    /// Compute LOD, clipping and culling for this camera in place of the picture's, and draw its frustum as lines; the numbers are
    /// those of --camera
    #[arg(long, value_name = "AZIMUTH,ELEVATION[,DISTANCE]", allow_hyphen_values = true)]
    pub lod_camera: Option<CameraOption>,
    /// The point that the LOD camera looks at, in object units (by default the centre of everything that is shown)
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = position, requires = "lod_camera")]
    pub lod_target: Option<Vec3>,
    /// Width and height of the LOD camera's view, in px (by default those of --size)
    #[arg(long, value_name = "WxH", value_parser = size, requires = "lod_camera")]
    pub lod_size: Option<[u32; 2]>,
    /// Orthographic projection for the LOD camera
    #[arg(long, requires = "lod_camera")]
    pub lod_orthographic: bool,
    /// Vertical field of view of the LOD camera in degrees, 0.1 to 170
    #[arg(long, value_name = "DEGREES", default_value_t = FIELD_OF_VIEW, value_parser = field_of_view, requires = "lod_camera")]
    pub lod_field_of_view: f32,
    /// Turn the LOD camera about its direction of view, counterclockwise by so many degrees
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, value_parser = angle, allow_hyphen_values = true, requires = "lod_camera")]
    pub lod_roll: f32,
}

impl LodCameraOption {
    /// The LOD camera and its view's size in px, if it isn't the picture's. `own` are the options of the picture's camera.
    pub fn camera(
        &self,
        own: &SurfaceOptions,
        mesh: &Mesh,
        bounds: &Bounds,
    ) -> Result<Option<(Camera, Vec2)>, CliError> {
        let Some(camera) = self.lod_camera else { return Ok(None) };
        let view = ViewOptions {
            camera,
            target: self.lod_target,
            orthographic: self.lod_orthographic,
            field_of_view: self.lod_field_of_view,
            roll: self.lod_roll,
            file_camera: None,
            view_projection: None,
            ..own.view.clone()
        };
        let options = SurfaceOptions { view, size: self.lod_size.unwrap_or(own.size), ..own.clone() };
        Ok(Some((options.view.camera(&options, (mesh, None, bounds), options.viewport())?, options.viewport())))
    }
}
