//! The view-projection matrix of an engine's frame, in the conventions of engines.
//!
//! Only the rows x, y and w of such a matrix decide where a point lands on the screen. They are kept as they are. The depth that
//! we draw with is made of w and of the near plane: see [`ClipRows::clip_from_object`]. Whether the engine's view space is left- or
//! right-handed can't be seen in the product of its matrices, and doesn't matter.

use glam::{DMat3, DMat4, DVec3, DVec4, Mat4, Vec3, Vec4, vec4};
use thiserror::Error;

use geometry::choice::choices;
pub use geometry::view::DepthRange;

choices! {
    /// Where +y of a clip space is on the screen.
    pub enum ClipY {
        Up => "up", "Up", "Direct3D, Metal, WebGPU, OpenGL.";
        Down => "down", "Down", "Vulkan.";
    }
}

/// The matrix of an engine's frame, from object units to its clip space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewProjection {
    /// It multiplies column vectors.
    pub clip_from_object: DMat4,
    pub depth: DepthRange,
    pub y: ClipY,
}

/// Why a matrix is no camera.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum ViewProjectionError {
    #[error(
        "the view-projection matrix is singular: its rows x, y and w must be independent, as those of a view with a width, a \
         height and a direction are; check its 16 numbers"
    )]
    Singular,
    #[error(
        "the near plane of the view-projection matrix isn't parallel to the picture: check --matrix-order, or leave out the \
         oblique clip plane"
    )]
    Oblique,
    #[error(
        "the near plane of the view-projection matrix isn't in front of its eye: check --depth (zero-to-one, reversed or \
         minus-one-to-one) and --matrix-order"
    )]
    Near,
    #[error(
        "w isn't above 0 anywhere under the view-projection matrix, so that it shows nothing; check --matrix-order"
    )]
    Behind,
    #[error(
        "depth is the same everywhere under the view-projection matrix, so that it has no direction; check its 16 numbers"
    )]
    Flat,
    #[error("the eye or the near plane of the view-projection matrix is too far away for numbers of 32 bits")]
    TooFar,
}

/// The rows x, y and w of a view-projection matrix, with y upwards, and with x mirrored if the matrix mirrors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClipRows {
    x: Vec4,
    y: Vec4,
    w: Vec4,
    /// The position of the eye in object units; none if it is infinitely far away.
    pub(super) eye: Option<Vec3>,
    /// Towards the eye, of length 1.
    back: Vec3,
    /// What w is on the near plane of a perspective view.
    pub(super) near: f32,
    /// Whether the matrix shows the mesh as in a mirror. What is drawn with these rows is the mirror image of the engine's frame.
    pub is_mirrored: bool,
}

/// How much of a row's length rounding may have made, in numbers of 32 bits.
const ROUNDING: f64 = 1e-4;
/// The length of w's gradient, in that of y's, below which a view is orthographic: a field of view of 0.00001 degrees.
const PARALLEL: f64 = 1e-7;
/// The slowest growth of depth with w. A matrix that is read with another range of depth than it was made for has hardly any, or
/// a negative one.
const LEAST_SLOPE: f64 = 0.01;
/// The nearest near plane, in distances between the eye and the object's origin, that numbers of 32 bits tell from the eye.
const LEAST_NEAR: f64 = 1e-6;

impl ViewProjection {
    /// The rows that decide where points land.
    ///
    /// # Errors
    /// The matrix isn't that of a view.
    pub fn rows(&self) -> Result<ClipRows, ViewProjectionError> {
        let [mut x, mut y, mut z, mut w] = [0, 1, 2, 3].map(|row| self.clip_from_object.row(row));
        if self.y == ClipY::Down {
            y = -y;
        }
        let scale = w.truncate().length();
        let size = x.truncate().length().max(y.truncate().length());
        if scale <= PARALLEL * size {
            return self.parallel_rows([x, y, z], w.w);
        }
        // Rows of any common length land points at the same places. With this one, w is the depth in object units.
        if (scale - 1.0).abs() > 1e-5 {
            [x, y, z, w] = [x, y, z, w].map(|row| row / scale);
        }
        let [across, up, ahead] = [x, y, w].map(DVec4::truncate);
        let volume = across.dot(up.cross(ahead));
        if !is_volume(volume, [across, up, ahead]) {
            return Err(ViewProjectionError::Singular);
        }
        let eye = solved([x, y, w], DVec3::ZERO).ok_or(ViewProjectionError::Singular)?;
        let near = self.near(z, w)?;
        let is_mirrored = volume > 0.0;
        let x = if is_mirrored { -x } else { x };
        let (near, eye) = (near as f32, eye.as_vec3());
        if !(eye.is_finite() && near.is_normal()) {
            return Err(ViewProjectionError::TooFar);
        }
        let back = -ahead.normalize().as_vec3();
        let [x, y, w] = [x, y, w].map(|row| row.as_vec4());
        Ok(ClipRows { x, y, w, eye: Some(eye), back, near, is_mirrored })
    }

    /// What w is on the near plane of a perspective view, where w's gradient has the length 1.
    fn near(&self, z: DVec4, w: DVec4) -> Result<f64, ViewProjectionError> {
        let plane = self.depth.near_plane(z, w);
        let ahead = w.truncate();
        let slope = plane.truncate().dot(ahead) / ahead.length_squared();
        if (plane.truncate() - ahead * slope).length() > ROUNDING * (1.0 + z.truncate().length()) {
            return Err(ViewProjectionError::Oblique);
        }
        // Beyond the near plane, what is 0 on it grows as w does, or twice as fast.
        if slope < LEAST_SLOPE {
            return Err(ViewProjectionError::Near);
        }
        let near = w.w - plane.w / slope;
        // Rounding may have moved a very near plane behind the eye.
        let least = LEAST_NEAR * w.w.abs();
        let near = if near.abs() < least { least } else { near };
        if near > 0.0 { Ok(near) } else { Err(ViewProjectionError::Near) }
    }

    /// The rows of an orthographic view, whose w is the same everywhere.
    fn parallel_rows(&self, rows: [DVec4; 3], w: f64) -> Result<ClipRows, ViewProjectionError> {
        if w <= 0.0 {
            return Err(ViewProjectionError::Behind);
        }
        let [x, y, z] = rows.map(|row| row / w);
        let [across, up] = [x, y].map(DVec4::truncate);
        // What all points of a line of sight have in common is that x and y don't change along it.
        let line = across.cross(up);
        if !is_volume(line.length_squared(), [across, up, line]) {
            return Err(ViewProjectionError::Singular);
        }
        let line = line.normalize();
        let grows = self.depth.near_plane(z, DVec4::ZERO).truncate().dot(line);
        if grows == 0.0 {
            return Err(ViewProjectionError::Flat);
        }
        // As in a perspective view, the volume of right, up and ahead is negative unless the matrix mirrors.
        let is_mirrored = grows > 0.0;
        let back = if is_mirrored { -line } else { line };
        let x = if is_mirrored { -x } else { x };
        let [x, y] = [x, y].map(|row| row.as_vec4());
        if !(x.is_finite() && y.is_finite()) {
            return Err(ViewProjectionError::TooFar);
        }
        Ok(ClipRows { x, y, w: Vec4::W, eye: None, back: back.as_vec3(), near: 0.0, is_mirrored })
    }
}

/// Whether three vectors, whose triple product is `volume`, span a volume.
fn is_volume(volume: f64, vectors: [DVec3; 3]) -> bool {
    let lengths: f64 = vectors.iter().map(|vector| vector.length()).product();
    volume.is_finite() && lengths > 0.0 && volume.abs() > 1e-9 * lengths
}

/// The point whose products with three rows are `values`; none if there isn't just one.
fn solved(rows: [DVec4; 3], values: DVec3) -> Option<DVec3> {
    let matrix = DMat3::from_cols_array_2d(&rows.map(|row| row.truncate().to_array())).transpose();
    let point = matrix.inverse() * (values - DVec3::from(rows.map(|row| row.w)));
    point.is_finite().then_some(point)
}

impl ClipRows {
    /// The matrix to our clip space. Depth is reversed. In a perspective view it is the near plane's w over w, and so 1 on the
    /// engine's near plane and 0 at infinity. In an orthographic view it falls evenly along the view, and the whole of
    /// `reach` object units around `middle` is in its range.
    pub(super) fn clip_from_object(&self, middle: Vec3, reach: f32) -> Mat4 {
        let z = match self.eye {
            Some(_) => vec4(0.0, 0.0, 0.0, self.near),
            None => {
                let half = 0.5 / reach.max(f32::MIN_POSITIVE);
                (self.back * half).extend(0.5 - half * self.back.dot(middle))
            }
        };
        Mat4::from_cols(self.x, self.y, z, self.w).transpose()
    }

    /// How many px an object unit across the view is where w is 1, in a view that is `height` px high.
    pub(super) fn px_where_w_is_1(&self, height: f32) -> f32 {
        0.5 * height * self.upright().length()
    }

    /// The gradient of y / w in the middle of the view, across the direction of view.
    fn upright(&self) -> Vec3 {
        self.y.truncate().reject_from_normalized(self.back)
    }

    /// The unit vectors to the right, up, and back towards the eye.
    pub(super) fn axes(&self) -> [Vec3; 3] {
        let right = self.x.truncate().reject_from_normalized(self.back).normalize();
        [right, self.back.cross(right), self.back]
    }

    /// Half the height of the view where w is 1, in object units.
    pub(super) fn half_height(&self) -> f32 {
        1.0 / self.upright().length()
    }

    /// Where the middle of an orthographic view passes `place`; none if rounding has made the view singular.
    pub(super) fn middle_beside(&self, place: Vec3) -> Option<Vec3> {
        let depth = self.back.as_dvec3().extend(-f64::from(self.back.dot(place)));
        solved([self.x.as_dvec4(), self.y.as_dvec4(), depth], DVec3::ZERO).map(|middle| middle.as_vec3())
    }

    /// The corners of the plane of the view where w has a value, or in an orthographic view of the plane through `place`, in
    /// object units, around from the lower left.
    pub(super) fn corners(&self, w: f32, place: Vec3) -> [Vec3; 4] {
        let rows = [self.x, self.y].map(|row| row.as_dvec4());
        let depth = match self.eye {
            Some(_) => self.w.as_dvec4(),
            None => self.back.as_dvec3().extend(1.0 - f64::from(self.back.dot(place))),
        };
        let w = f64::from(if self.eye.is_some() { w } else { 1.0 });
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| solved([rows[0], rows[1], depth], DVec3::new(x * w, y * w, w)).unwrap_or_default().as_vec3())
    }
}
