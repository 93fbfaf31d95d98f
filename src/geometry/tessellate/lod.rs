//! Level of detail: the tessellation factor of an edge, by its length on screen or its distance from the eye. Twin:
//! `shaders/lod.wgsl`. LOD by error is in `least_factors.rs`.

use glam::{Mat4, Vec2, Vec3, Vec4, vec4};

use super::factors::Partitioning;
use crate::choice::choices;
use crate::view::DepthRange;

choices! {
    /// Where edge factors come from.
    #[derive(Hash)]
    #[repr(u32)]
    pub enum Lod {
        Uniform => "uniform", "Uniform", "All edges have the same factor.";
        Error => "error", "Screen error",
            "About the fewest triangles that stay within a tolerance, in px, of the surface (bounds on second \
             derivatives: Filip et al. 1986). Flat places stay untessellated.";
        EdgeLength => "edge-length", "Edge length",
            "The edge's length on screen, divided by the length of a segment. Edges that reach near or behind the eye \
             are measured where they come nearest to it.";
        Distance => "distance", "Distance",
            "The full factor up to a near distance from the eye, 1 beyond a far distance, linear in between. An edge \
             gets the mean of its two ends, as engines commonly do (Unity's `UnityDistanceBasedTess`, for example).";
        Paper => "paper", "White paper",
            "The length of the edge's control polygon on screen, divided by the length of a segment (McDonald and \
             Kilgard 2010). Edges that reach near or behind the eye get wrong factors.";
    }
}

/// What a LOD reads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LodReads {
    /// The view: factors follow the camera.
    pub view: bool,
    /// The control points of edges.
    pub control_points: bool,
    /// [`Tessellation::factor`](super::Tessellation::factor).
    pub factor: bool,
    /// [`Tessellation::pixels`](super::Tessellation::pixels).
    pub pixels: bool,
    /// [`Tessellation::tolerance`](super::Tessellation::tolerance): each patch searches for factors that keep it, also for its inside.
    pub tolerance: bool,
    /// [`Tessellation::near`](super::Tessellation::near) and [`far`](super::Tessellation::far).
    pub distances: bool,
}

impl Lod {
    pub fn reads(self) -> LodReads {
        let nothing = LodReads::default();
        match self {
            Self::Uniform => LodReads { factor: true, ..nothing },
            Self::Error => LodReads { view: true, control_points: true, tolerance: true, ..nothing },
            Self::EdgeLength | Self::Paper => LodReads { view: true, control_points: true, pixels: true, ..nothing },
            Self::Distance => LodReads { view: true, factor: true, distances: true, ..nothing },
        }
    }

    /// Whether factors follow the camera.
    pub fn follows_view(self) -> bool {
        self.reads().view
    }

    /// Whether patches search for the fewest triangles that keep a tolerance.
    pub fn is_by_error(self) -> bool {
        self.reads().tolerance
    }

    /// The partitioning that is usual with it: the one with the fewest triangles, or Direct3D's one without jumps.
    pub fn usual_partitioning(self) -> Partitioning {
        if self.is_by_error() { Partitioning::Rows } else { Partitioning::FractionalOdd }
    }
}

/// The view that LOD and clipping are computed for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LodView {
    /// The matrix from object units to clip space, with reversed depth: 1 at the near plane. The far plane may be anywhere.
    /// [`Self::from_camera`] takes matrices with another range of depth.
    pub clip_from_object: Mat4,
    /// Half the viewport's width and height, in px.
    pub half_viewport: Vec2,
    /// The largest distance in object units by which displacement moves a point: tessellation finds it.
    pub(super) reach: f32,
    /// The position of the eye in object units. Only LOD by distance and LOD shaders read it.
    pub eye: Vec3,
    /// The mesh's bounding radius in object units, in which LOD by distance counts.
    pub radius: f32,
}

impl Default for LodView {
    /// A view that shows nothing in particular, for a tessellation that depends on none: uniform factors without clipping.
    fn default() -> Self {
        Self::new(Mat4::IDENTITY, Vec2::ONE)
    }
}

impl LodView {
    /// Builds the view of a mesh of bounding radius 1 without displacement. The eye is at the origin.
    pub const fn new(clip_from_object: Mat4, half_viewport: Vec2) -> Self {
        Self { clip_from_object, half_viewport, reach: 0.0, eye: Vec3::ZERO, radius: 1.0 }
    }

    /// Builds the view of a camera from the matrices that a program draws with: from object units to clip space (it multiplies
    /// column vectors), its range of depth, the viewport's width and height in px, and the mesh's bounding radius in object units.
    ///
    /// The eye is where the rows x, y and w of the matrix are 0. An orthographic view has none; there it is so far away that LOD by
    /// distance gives a factor of 1.
    pub fn from_camera(clip_from_object: Mat4, depth: DepthRange, viewport: Vec2, radius: f32) -> Self {
        let matrix = clip_from_object.as_dmat4();
        let [x, y, z, w] = [0, 1, 2, 3].map(|row| matrix.row(row));
        let reversed = (w - depth.near_plane(z, w)).as_vec4();
        let [x_axis, y_axis, w_axis] = [x, y, w].map(|row| row.truncate());
        let towards = y_axis.cross(w_axis) * x.w + w_axis.cross(x_axis) * y.w + x_axis.cross(y_axis) * w.w;
        let volume = x_axis.dot(y_axis.cross(w_axis));
        let eye = (towards / -volume).as_vec3();
        // Squares of distances to it are still numbers of 32 bits.
        let far = Vec3::splat(f32::MAX.sqrt() * 1e-3);
        let columns = [0, 1, 2, 3].map(|column| {
            let own = clip_from_object.col(column);
            vec4(own.x, own.y, reversed[column], own.w)
        });
        Self {
            clip_from_object: Mat4::from_cols(columns[0], columns[1], columns[2], columns[3]),
            half_viewport: viewport * 0.5,
            reach: 0.0,
            eye: if eye.is_finite() { eye } else { far },
            radius,
        }
    }

    /// The same eye's view with another matrix, with reversed depth, and another half of a viewport in px.
    #[must_use]
    pub fn seen_through(self, clip_from_object: Mat4, half_viewport: Vec2) -> Self {
        Self { clip_from_object, half_viewport, ..self }
    }

    /// The view from another eye, of a mesh with another bounding radius, both in object units.
    #[must_use]
    pub fn seen_from(self, eye: Vec3, radius: f32) -> Self {
        Self { eye, radius, ..self }
    }

    /// The view in which lengths are so many times as many px. Twin: `magnified` in `shaders/patch_traits.wgsl`.
    #[must_use]
    pub(super) fn magnified(&self, times: f32) -> Self {
        Self { half_viewport: self.half_viewport * times, ..*self }
    }

    /// The largest distance in object units by which displacement moves a point.
    pub fn reach(&self) -> f32 {
        self.reach
    }

    /// The view of a surface that displacement moves by at most `reach` object units.
    #[must_use]
    pub fn with_reach(self, reach: f32) -> Self {
        Self { reach, ..self }
    }
}

/// Returns a position on screen, from the middle of the view, in segments of `pixels_per_segment` px.
///
/// Like the white paper, it divides by w, so points behind the eye are mirrored.
pub(crate) fn project_and_scale(view: &LodView, pixels_per_segment: f32, position: Vec3) -> Vec2 {
    let clip = view.clip_from_object * position.extend(1.0);
    glam::vec2(clip.x, clip.y) / clip.w * view.half_viewport / pixels_per_segment
}

/// Returns `length`, but 1 if it is less than 1 or NaN. The length of an edge through the eye's plane may be NaN.
///
/// NaN is recognised by its bits, since a shader's `max` with NaN may return either argument.
pub(crate) fn max_with_one(length: f32) -> f32 {
    let is_nan = length.to_bits() & 0x7fff_ffff > 0x7f80_0000;
    if is_nan || length < 1.0 { 1.0 } else { length }
}

/// Returns the white paper's factor of an edge with these four control points (`ComputeEdgeLOD` of McDonald and Kilgard
/// 2010): the length of its control polygon on screen, in segments. The points must be in the edge's own direction.
pub(crate) fn paper_edge_factor(view: &LodView, pixels_per_segment: f32, control_points: [Vec3; 4]) -> f32 {
    let [a, ab, ba, b] = control_points.map(|p| project_and_scale(view, pixels_per_segment, p));
    max_with_one(a.distance(ab) + ab.distance(ba) + ba.distance(b))
}

/// Returns whether a clip-space position lies on the near plane or beyond. Depth is reversed: z = w on the near plane.
pub fn beyond_near(clip: Vec4) -> bool {
    clip.z <= clip.w
}

/// Returns the gradient of a clip-space coordinate (0 to 3 for x, y, z, w) in object space.
pub(super) fn clip_row(view: &LodView, row: usize) -> Vec3 {
    view.clip_from_object.row(row).truncate()
}

/// Returns how many px an object unit across the view covers at depth w = 1.
pub(super) fn pixels_per_unit(view: &LodView) -> f32 {
    (clip_row(view, 0).length() * view.half_viewport.x).max(clip_row(view, 1).length() * view.half_viewport.y)
}

/// Returns the factor of an edge that isn't completely beyond the near plane: the length of its control polygon in
/// segments, as if it lay across the view at the nearest depth of a sphere around the control points. If the whole
/// sphere is nearer than the near plane, the factor is 1.
pub(crate) fn near_edge_factor(view: &LodView, pixels_per_segment: f32, [a, ab, ba, b]: [Vec3; 4]) -> f32 {
    let center = (a + b) * 0.5;
    let radius = a.distance(center).max(ab.distance(center)).max(ba.distance(center)) + view.reach;
    let clip = view.clip_from_object * center.extend(1.0);
    let depth = clip_row(view, 3);
    let past_near = depth - clip_row(view, 2);
    if clip.w - clip.z + radius * past_near.length() < 0.0 {
        return 1.0;
    }
    let nearest = (clip.w - radius * depth.length()).max(clip.z);
    let length = a.distance(ab) + ab.distance(ba) + ba.distance(b);
    max_with_one(length * pixels_per_unit(view) / nearest / pixels_per_segment)
}

/// Returns [`paper_edge_factor`] if all four control points lie beyond the near plane, otherwise [`near_edge_factor`].
pub(crate) fn edge_length_factor(view: &LodView, pixels_per_segment: f32, control_points: [Vec3; 4]) -> f32 {
    let beyond = |p: Vec3| beyond_near(view.clip_from_object * p.extend(1.0));
    if control_points.into_iter().all(beyond) {
        return paper_edge_factor(view, pixels_per_segment, control_points);
    }
    near_edge_factor(view, pixels_per_segment, control_points)
}

/// Returns the factor of a point `p` in object units: `factor` up to a distance of `near` bounding radii from the eye,
/// 1 from `far` bounding radii on, and linear between.
pub(super) fn point_distance_factor(view: &LodView, factor: f32, near: f32, far: f32, p: Vec3) -> f32 {
    let part = (far - p.distance(view.eye) / view.radius) / (far - near);
    1.0 + (factor - 1.0) * part.clamp(0.0, 1.0)
}

/// Returns the factor of an edge under LOD by distance: the mean of the factors at its ends.
pub(crate) fn distance_factor(view: &LodView, factor: f32, near: f32, far: f32, [a, _, _, b]: [Vec3; 4]) -> f32 {
    max_with_one(
        0.5 * (point_distance_factor(view, factor, near, far, a) + point_distance_factor(view, factor, near, far, b)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_fall_linearly_with_distance_and_are_the_mean_of_the_ends() {
        let view = LodView { radius: 2.0, ..LodView::new(Mat4::IDENTITY, Vec2::ONE) };
        let at = |distance: f32| point_distance_factor(&view, 9.0, 1.0, 5.0, Vec3::X * distance);
        assert_eq!([0.0, 2.0, 4.0, 6.0, 10.0, 1e6].map(at), [9.0, 9.0, 7.0, 5.0, 1.0, 1.0]);
        let edge = [Vec3::X * 4.0, Vec3::ONE, Vec3::ONE, Vec3::X * 6.0];
        assert_eq!(distance_factor(&view, 9.0, 1.0, 5.0, edge), 6.0);
    }
    use glam::vec3;

    #[test]
    fn a_straight_edge_gets_its_length_on_screen_over_the_length_of_a_segment() {
        let view = LodView::new(Mat4::IDENTITY, Vec2::new(400.0, 300.0));
        let points = [0.0, 0.1, 0.2, 0.3].map(|x| vec3(x, 0.0, 0.0));
        assert!((paper_edge_factor(&view, 8.0, points) - 15.0).abs() < 1e-4, "0.3 of 400 px, in segments of 8");
        assert_eq!(paper_edge_factor(&view, 500.0, points), 1.0, "never less than 1");
    }

    #[test]
    fn nan_and_factors_below_1_become_1() {
        assert_eq!([f32::NAN, -f32::NAN, 0.3, -2.0].map(max_with_one), [1.0; 4]);
        assert_eq!([1.5, f32::INFINITY].map(max_with_one), [1.5, f32::INFINITY]);
        let view = LodView::new(Mat4::ZERO, Vec2::ONE);
        assert_eq!(paper_edge_factor(&view, 1.0, [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z]), 1.0);
    }

    /// Looks along -Z from the origin. Half the viewport is 1 unit at depth 1, and the near plane is at depth 0.1.
    #[test]
    fn a_camera_is_the_same_in_every_range_of_depth() {
        use glam::camera::rh::proj::{directx, opengl};
        let (eye, viewport) = (Vec3::new(1.0, 2.0, 4.0), Vec2::new(640.0, 480.0));
        let looks = glam::camera::rh::view::look_at_mat4(eye, Vec3::ZERO, Vec3::Y);
        let seen = |projection: Mat4, depth| LodView::from_camera(projection * looks, depth, viewport, 1.5);
        let views = [
            seen(directx::perspective(0.7, 4.0 / 3.0, 0.1, 100.0), DepthRange::ZeroToOne),
            seen(directx::perspective_infinite_reverse(0.7, 4.0 / 3.0, 0.1), DepthRange::Reversed),
            seen(opengl::perspective(0.7, 4.0 / 3.0, 0.1, 100.0), DepthRange::MinusOneToOne),
        ];
        let near = looks.inverse().transform_point3(Vec3::new(0.01, 0.02, -0.1));
        for view in views {
            assert!(
                view.eye.distance(eye) < 1e-4 && view.half_viewport == viewport * 0.5 && view.radius == 1.5,
                "{view:?}"
            );
            let clip = view.clip_from_object * near.extend(1.0);
            assert!((clip.z - clip.w).abs() < 1e-5 * clip.w.max(1.0), "the near plane: {clip}");
            assert!(beyond_near(view.clip_from_object * Vec4::W), "the origin is in view");
            let at = project_and_scale(&view, 1.0, Vec3::X);
            let expected = project_and_scale(&views[0], 1.0, Vec3::X);
            assert!(at.distance(expected) < 1e-2, "{at} and {expected}");
        }
        let flat = seen(directx::orthographic(-2.0, 2.0, -1.5, 1.5, 0.1, 9.0), DepthRange::ZeroToOne);
        assert!(flat.eye.is_finite());
        assert_eq!(distance_factor(&flat, 8.0, 2.0, 10.0, [Vec3::ZERO; 4]), 1.0, "an eye that is far away");
    }

    fn perspective() -> LodView {
        let clip_from_object = Mat4::from_cols_array_2d(&[
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, -1.0],
            [0.0, 0.0, 0.1, 0.0],
        ]);
        LodView::new(clip_from_object, Vec2::splat(100.0))
    }

    fn straight(a: Vec3, b: Vec3) -> [Vec3; 4] {
        [a, a.lerp(b, 1.0 / 3.0), a.lerp(b, 2.0 / 3.0), b]
    }

    #[test]
    fn beyond_the_near_plane_both_factors_agree_to_the_bit() {
        let edge = straight(vec3(-1.0, 0.0, -2.0), vec3(0.5, 1.0, -0.2));
        let factors = [paper_edge_factor, edge_length_factor].map(|form| form(&perspective(), 8.0, edge));
        assert_eq!(factors[0].to_bits(), factors[1].to_bits());
    }

    #[test]
    fn an_edge_through_the_eyes_plane_is_measured_where_it_is_nearest() {
        // The edge runs from in front of the eye to behind it. The white paper would mirror its far end.
        let edge = straight(vec3(0.5, 0.0, -1.0), vec3(0.5, 0.0, 1.0));
        let near = edge_length_factor(&perspective(), 8.0, edge);
        assert!((near - 2.0 * 100.0 / 0.1 / 8.0).abs() < 1e-1, "{near}: 2 units at depth 0.1");
        let passing = straight(vec3(-3.0, 0.0, -0.05), vec3(3.0, 0.0, -0.05));
        assert!(edge_length_factor(&perspective(), 8.0, passing) > 64.0);
    }

    #[test]
    fn an_edge_behind_the_eye_needs_no_segments() {
        let behind = straight(vec3(-1.0, 0.0, 2.0), vec3(1.0, 0.0, 2.0));
        assert_eq!(edge_length_factor(&perspective(), 1.0, behind), 1.0);
        assert!(paper_edge_factor(&perspective(), 1.0, behind) > 90.0, "the white paper mirrors it to the front");
    }
}
