//! The options of cameras: ours, one of the file, or the matrix of an engine's frame; and another one that LOD is computed for.

use clap::{Args, ValueEnum};
use glam::{DMat4, Vec2, Vec3};

use super::values::{angle, field_of_view, position, size};
use super::{CameraOption, SurfaceOptions, choice, file_camera};
use crate::cli::CliError;
use geometry::mesh::{Bounds, Mesh, Moment};
use inspect::render::Camera;
use inspect::render::camera::FIELD_OF_VIEW;
use inspect::render::view_projection::{ClipY, DepthRange, ViewProjection};
use inspect::settings::Choice;

/// A mesh, a moment of one of its clips, and its bounds.
pub(crate) type MeshAt<'a> = (&'a Mesh, Option<Moment>, &'a Bounds);

/// Where the mesh is seen from.
#[derive(Clone, Debug, PartialEq, Args)]
pub struct ViewOptions {
    /// Where the camera is: degrees from the front to the right, degrees upwards, and the distance from the centre in
    /// bounding radii (by default far enough to show everything)
    #[arg(long, value_name = "AZIMUTH,ELEVATION[,DISTANCE]", default_value = "30,20", allow_hyphen_values = true)]
    pub camera: CameraOption,
    /// The point that the camera looks at, in object units (by default the centre of everything that is shown)
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = position)]
    pub target: Option<Vec3>,
    /// Orthographic projection, without perspective
    #[arg(long)]
    pub orthographic: bool,
    /// Vertical field of view in degrees, 0.1 to 170. An orthographic view is as high as a perspective one is at its target
    #[arg(long, value_name = "DEGREES", default_value_t = FIELD_OF_VIEW, value_parser = field_of_view)]
    pub field_of_view: f32,
    /// Turn the camera about its direction of view, counterclockwise by so many degrees
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, value_parser = angle, allow_hyphen_values = true)]
    pub roll: f32,
    /// Look through a camera of the glTF file, by its name or its number from 0; `info` lists them. The picture has the camera's
    /// height, whatever its width
    #[arg(
        long,
        value_name = "NAME|N",
        allow_hyphen_values = true,
        conflicts_with_all = ["camera", "target", "orthographic", "field_of_view", "roll"]
    )]
    pub file_camera: Option<String>,
    /// The matrix of an engine's frame, from object units to clip space, in place of a camera: 16 numbers. --size is the
    /// engine's viewport
    #[arg(
        long,
        value_name = "16 NUMBERS",
        allow_hyphen_values = true,
        value_parser = matrix_numbers,
        conflicts_with_all = ["camera", "target", "orthographic", "field_of_view", "roll", "file_camera"]
    )]
    pub view_projection: Option<[f64; 16]>,
    /// How the 16 numbers are listed, of the matrix that multiplies column vectors (M * v). Engines with row vectors (v * M) that
    /// list rows have them column-major
    #[arg(long, value_enum, default_value_t = MatrixOrder::ColumnMajor, requires = "view_projection")]
    pub matrix_order: MatrixOrder,
    /// The depth that the matrix gives the near plane and what is far away
    #[arg(long, value_parser = choice::<DepthRange>(), default_value = DepthRange::ZeroToOne.name(), requires = "view_projection")]
    pub depth: DepthRange,
    /// Where the matrix has +y on the screen
    #[arg(long, value_parser = choice::<ClipY>(), default_value = ClipY::Up.name(), requires = "view_projection")]
    pub clip_y: ClipY,
}

/// Parses the numbers of a matrix. They may be separated by commas, blanks and lines, and be in brackets, as programs print
/// arrays.
fn matrix_numbers(text: &str) -> Result<[f64; 16], String> {
    let is_between = |c: char| c.is_whitespace() || matches!(c, ',' | ';' | '[' | ']' | '(' | ')' | '{' | '}');
    let words = text.split(is_between).filter(|word| !word.is_empty());
    let numbers = words.enumerate().map(|(index, word)| {
        let number = word.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| format!("expected 16 numbers, and number {} is {word}", index + 1))
    });
    let numbers: Vec<f64> = numbers.collect::<Result<_, _>>()?;
    numbers.try_into().map_err(|found: Vec<f64>| format!("expected 16 numbers, found {}", found.len()))
}

/// How the 16 numbers of a matrix that multiplies column vectors are listed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MatrixOrder {
    /// Row after row: M * v as it is written on paper (Unity, Blender, NumPy)
    RowMajor,
    /// Column after column: OpenGL, glTF, glm, three.js, Bevy and Godot; also row after row of a matrix for row vectors, v * M
    /// (DirectXMath, Unreal Engine)
    ColumnMajor,
}

impl ViewOptions {
    /// Returns the camera of these options for a mesh. Without a distance it shows everything that is drawn as `surface` says in the middle
    /// `size` px of the picture.
    pub fn camera(
        &self,
        surface: &SurfaceOptions,
        (mesh, moment, bounds): MeshAt,
        size: Vec2,
    ) -> Result<Camera, CliError> {
        if let Some(matrix) = self.matrix() {
            return Ok(Camera::from_matrix(&matrix, bounds)?);
        }
        if let Some(wanted) = &self.file_camera {
            let cameras = mesh.cameras_at(moment);
            return file_camera(&mesh.name, &cameras, wanted).map(|camera| Camera::from_file(camera, bounds));
        }
        let mut camera = Camera { field_of_view: self.field_of_view, roll: self.roll, ..Camera::default() };
        camera.frame(&bounds.grown(surface.settings().reach(mesh)), size);
        (camera.azimuth, camera.elevation) = (self.camera.azimuth, self.camera.elevation.clamp(-90.0, 90.0));
        if let Some(radii) = self.camera.distance {
            camera.distance = radii * bounds.radius();
        }
        camera.target = self.target.unwrap_or(camera.target);
        camera.orthographic = self.orthographic;
        Ok(camera)
    }

    /// The matrix of an engine's frame, if there is one.
    pub(in crate::cli) fn matrix(&self) -> Option<ViewProjection> {
        let listed = DMat4::from_cols_array(&self.view_projection?);
        let clip_from_object = match self.matrix_order {
            MatrixOrder::ColumnMajor => listed,
            MatrixOrder::RowMajor => listed.transpose(),
        };
        Some(ViewProjection { clip_from_object, depth: self.depth, y: self.clip_y })
    }
}

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_programs_print_them_and_others_are_refused() {
        let numbers: Vec<String> = (1..=16).map(|number| number.to_string()).collect();
        let expected = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16].map(f64::from);
        for text in [numbers.join(","), numbers.join(" "), format!("[\n  {}\n]", numbers.join(",\n  "))] {
            assert_eq!(matrix_numbers(&text), Ok(expected), "{text}");
        }
        let refused = |text: String| matrix_numbers(&text).expect_err("no matrix");
        assert_eq!(refused(numbers[1..].join(" ")), "expected 16 numbers, found 15");
        assert_eq!(refused(numbers.join(" ").replace("16", "NaN")), "expected 16 numbers, and number 16 is NaN");
        assert_eq!(refused(numbers.join(" ").replace("2 3", "2 x")), "expected 16 numbers, and number 3 is x");
    }
}
