//! Spaces in which another program's coordinates may be: turned by any angle, seen from the camera, or in clip space.

use glam::{DMat3, DMat4, DVec3, Vec3};

use super::foreign::ForeignMesh;
use geometry::tessellate::LodView;

/// A space that coordinates of ours are brought into.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Space {
    pub kind: SpaceKind,
    /// The matrix back from theirs to ours; the result is divided by w.
    ours_from_theirs: DMat4,
}

/// How another program's coordinates follow from ours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alignment {
    /// For each of their axes, which of ours it is, and whether it points the other way.
    pub axes: [(usize, bool); 3],
    /// Their lengths are ours times this.
    pub scale: f64,
    /// What is then added, in their units.
    pub offset: DVec3,
}

/// Which one it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpaceKind {
    /// Axes are exchanged or turned, and everything is scaled and moved.
    Axes(Alignment),
    /// That of the camera: the view matrix was applied.
    View,
    /// Clip space: the view-projection matrix was applied.
    Clip,
    /// The same, divided by w.
    DividedClip,
    /// Turned about an axis by some degrees, scaled and then moved.
    Turned { axis: DVec3, degrees: f64, scale: f64, offset: DVec3, is_mirrored: bool },
}

/// How many of their largest triangles are sought among ours.
const TRIED: usize = 12;
/// How many triangles of ours are tried for each.
const MATCHES: usize = 32;
/// Lengths that differ by no more than this share may be the same.
const ALIKE: f64 = 1e-4;

impl Alignment {
    pub(super) const NONE: Self = Self { axes: [(0, false), (1, false), (2, false)], scale: 1.0, offset: DVec3::ZERO };

    /// Whether it mirrors, so that triangles are wound the other way.
    pub(super) fn mirrors(&self) -> bool {
        self.matrix().determinant() < 0.0
    }

    /// Whether axes are exchanged or turned.
    pub(super) fn turns(&self) -> bool {
        self.axes != Self::NONE.axes
    }

    /// The rotation or reflection from our axes to theirs.
    pub(super) fn matrix(&self) -> DMat3 {
        let row = |(axis, is_turned): (usize, bool)| DVec3::AXES[axis] * if is_turned { -1.0 } else { 1.0 };
        DMat3::from_cols_array_2d(&self.axes.map(|axis| row(axis).to_array())).transpose()
    }
}

impl From<Alignment> for Space {
    fn from(alignment: Alignment) -> Self {
        let turn_back = alignment.matrix().transpose() * alignment.scale.recip();
        let ours_from_theirs = DMat4::from_mat3(turn_back) * DMat4::from_translation(-alignment.offset);
        Self { kind: SpaceKind::Axes(alignment), ours_from_theirs }
    }
}

impl Space {
    fn new(kind: SpaceKind, theirs_from_ours: DMat4) -> Option<Self> {
        let ours_from_theirs = theirs_from_ours.inverse();
        ours_from_theirs.is_finite().then_some(Self { kind, ours_from_theirs })
    }

    #[cfg(test)]
    pub(super) fn from_kind(kind: SpaceKind) -> Self {
        Self { kind, ours_from_theirs: DMat4::IDENTITY }
    }

    /// Returns the place in our coordinates of a position in theirs.
    pub(super) fn ours(&self, theirs: DVec3) -> DVec3 {
        self.ours_from_theirs.project_point3(theirs)
    }

    /// Whether it mirrors, so that triangles are wound the other way.
    pub(super) fn mirrors(&self) -> bool {
        self.ours_from_theirs.determinant() < 0.0
    }

    /// How many times as far apart as in their coordinates places near a position are in ours.
    pub(super) fn stretch(&self, theirs: DVec3) -> f64 {
        let step = 1e-4 * theirs.length().max(1e-30);
        let apart = |axis: DVec3| self.ours(theirs + axis * step).distance(self.ours(theirs)) / step;
        DVec3::AXES.into_iter().map(apart).fold(0.0, f64::max)
    }

    /// The spaces of a camera. `matrix` is that of the other program, if it was given.
    pub(super) fn from_camera(view: &LodView, matrix: Option<DMat4>) -> Vec<Self> {
        let of_view = view_matrix(view).and_then(|matrix| Self::new(SpaceKind::View, matrix));
        let clips = matrix.into_iter().chain([view.clip_from_object.as_dmat4()]).flat_map(|clip| {
            let mut without_w = clip.transpose();
            without_w.w_axis = DVec3::ZERO.extend(1.0);
            [Self::new(SpaceKind::DividedClip, clip), Self::new(SpaceKind::Clip, without_w.transpose())]
        });
        of_view.into_iter().chain(clips.flatten()).collect()
    }

    /// The spaces that bring triangles of ours onto triangles of theirs: similar ones, of which the largest are tried. `emitted` are our
    /// positions, and `triangles` their indices.
    pub(super) fn from_triangles(
        theirs: &ForeignMesh,
        emitted: &[Vec3],
        triangles: &[[u32; 3]],
    ) -> impl Iterator<Item = Self> {
        let corners = |positions: &[Vec3], triangle: &[u32; 3]| {
            Congruent::new(triangle.map(|vertex| positions[vertex as usize].as_dvec3()))
        };
        let mut own: Vec<Congruent> = triangles.iter().filter_map(|triangle| corners(emitted, triangle)).collect();
        let mut others: Vec<Congruent> =
            theirs.triangles.iter().filter_map(|triangle| corners(&theirs.positions, triangle)).collect();
        let area = |all: &[Congruent]| all.iter().map(|own| own.area).sum::<f64>();
        let measured = (area(&others) / area(&own)).sqrt();
        let scale = if (measured - 1.0).abs() < 1e-3 { 1.0 } else { measured };
        own.sort_unstable_by(|a, b| a.sides[0].total_cmp(&b.sides[0]));
        others.sort_unstable_by(|a, b| b.area.total_cmp(&a.area));
        others.truncate(TRIED);
        others
            .into_iter()
            .flat_map(move |their| {
                let longest = their.sides[0] / scale;
                let first = own.partition_point(|own| own.sides[0] < longest * (1.0 - ALIKE));
                let alike = own[first..].iter().take_while(|own| own.sides[0] <= longest * (1.0 + ALIKE));
                let alike = alike.filter(|own| own.is_like(&their, scale)).take(MATCHES);
                alike
                    .flat_map(|own| [false, true].map(|is_mirrored| own.onto(&their, scale, is_mirrored)))
                    .collect::<Vec<_>>()
            })
            .flatten()
    }

    /// The same space with the turn and the offset that fit many vertices best; the scale stays (the orthogonal Procrustes problem,
    /// Schönemann 1966, by a polar decomposition). Each pair is a position of ours and the same in their coordinates.
    pub(super) fn settled(self, pairs: &[[DVec3; 2]]) -> Self {
        let SpaceKind::Turned { scale, .. } = self.kind else { return self };
        let middle = |k: usize| pairs.iter().map(|pair| pair[k]).sum::<DVec3>() / pairs.len().max(1) as f64;
        let [own, theirs] = [middle(0), middle(1)];
        let mut covariance = DMat3::ZERO;
        for pair in pairs {
            let (a, b) = (pair[0] - own, pair[1] - theirs);
            covariance += DMat3::from_cols(b * a.x, b * a.y, b * a.z);
        }
        const STEPS: usize = 60;
        let size = covariance.determinant().abs().cbrt();
        let mut turn = covariance * size.recip();
        for _ in 0..STEPS {
            turn = (turn + turn.inverse().transpose()) * 0.5;
        }
        // Vertices in a plane don't tell a turn from a mirror.
        let is_sound = turn.is_finite() && (turn.determinant().abs() - 1.0).abs() < 1e-9;
        if !is_sound || (turn.determinant() < 0.0) != self.mirrors() {
            return self;
        }
        let offset = theirs - turn * own * scale;
        let matrix = DMat4::from_translation(offset) * DMat4::from_mat3(turn * scale);
        Self::new(turned(turn, scale, offset), matrix).unwrap_or(self)
    }
}

/// The matrix from object units to the camera's space, in which it looks along -z. `None` for a view without a direction.
fn view_matrix(view: &LodView) -> Option<DMat4> {
    let rows = view.clip_from_object.as_dmat4().transpose();
    let [right, up] = [rows.x_axis, rows.y_axis].map(|row| row.truncate());
    // Parallel views have no depth in w.
    let ahead = if rows.w_axis.truncate() == DVec3::ZERO { up.cross(right) } else { rows.w_axis.truncate() };
    let back = -ahead.try_normalize()?;
    let right = right.reject_from_normalized(back).try_normalize()?;
    let turn = DMat3::from_cols(right, back.cross(right), back).transpose();
    Some(DMat4::from_mat3(turn) * DMat4::from_translation(-view.eye.as_dvec3()))
}

/// A triangle whose sides have different lengths, so that others tell which of their corners are the same.
#[derive(Clone, Copy)]
struct Congruent {
    /// The longest side first, from corner 0 to corner 1; then from 1 to 2, and from 2 to 0, which is the shorter one.
    corners: [DVec3; 3],
    sides: [f64; 3],
    area: f64,
}

impl Congruent {
    fn new([a, b, c]: [DVec3; 3]) -> Option<Self> {
        let orders = [[a, b, c], [b, c, a], [c, a, b], [b, a, c], [c, b, a], [a, c, b]];
        let sides = |[a, b, c]: [DVec3; 3]| [a.distance(b), b.distance(c), c.distance(a)];
        let falls = |order: &[DVec3; 3]| {
            let [x, y, z] = sides(*order);
            x > y && y > z && z > ALIKE * x
        };
        let place = orders.iter().position(falls)?;
        let area = (b - a).cross(c - a).length();
        Some(Self { corners: orders[place], sides: sides(orders[place]), area })
    }

    fn is_like(&self, theirs: &Self, scale: f64) -> bool {
        let alike = |(own, theirs): (f64, f64)| (own * scale / theirs - 1.0).abs() < ALIKE;
        self.sides.into_iter().zip(theirs.sides).all(alike)
    }

    /// Two of its sides and its normal, as unit vectors at right angles.
    fn frame(&self) -> Option<DMat3> {
        let [a, b, c] = self.corners;
        let along = (b - a).try_normalize()?;
        let up = along.cross(c - a).try_normalize()?;
        Some(DMat3::from_cols(along, up.cross(along), up))
    }

    /// The space that brings this triangle onto theirs.
    fn onto(&self, theirs: &Self, scale: f64, is_mirrored: bool) -> Option<Space> {
        let sign = if is_mirrored { -1.0 } else { 1.0 };
        let turn = theirs.frame()? * DMat3::from_diagonal(DVec3::new(1.0, 1.0, sign)) * self.frame()?.transpose();
        let middle = |own: &Self| own.corners.into_iter().sum::<DVec3>() / 3.0;
        let offset = middle(theirs) - turn * middle(self) * scale;
        Space::new(turned(turn, scale, offset), DMat4::from_translation(offset) * DMat4::from_mat3(turn * scale))
    }
}

/// What a turn is, which may mirror, with what follows it.
fn turned(turn: DMat3, scale: f64, offset: DVec3) -> SpaceKind {
    let is_mirrored = turn.determinant() < 0.0;
    // A mirrored turn is an inversion and a turn.
    let (axis, angle) = glam::DQuat::from_mat3(&(if is_mirrored { turn * -1.0 } else { turn })).to_axis_angle();
    SpaceKind::Turned { axis, degrees: angle.to_degrees(), scale, offset, is_mirrored }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Mat4, Vec2, vec3};

    #[test]
    fn a_triangle_is_brought_onto_another_one() {
        let own = [DVec3::ZERO, DVec3::X * 3.0, DVec3::new(0.5, 1.0, 0.2)];
        let turn = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 2.0) / 3.0, 0.7);
        for (mirror, size) in [(1.0, 2.5), (-1.0, 2.5), (1.0, 1e-6), (-1.0, 1e9)] {
            let moved = own.map(|p| (turn * (p * DVec3::new(1.0, 1.0, mirror)) + DVec3::new(1.0, -4.0, 9.0)) * size);
            let [a, b, c] = moved;
            let (own, theirs) = (Congruent::new(own).expect("scalene"), Congruent::new([b, c, a]).expect("scalene"));
            let space = own.onto(&theirs, size, mirror < 0.0).expect("a space");
            for (own, theirs) in own.corners.into_iter().zip(theirs.corners) {
                assert!(space.ours(theirs).distance(own) < 1e-9);
            }
            assert_eq!(space.mirrors(), mirror < 0.0);
            let SpaceKind::Turned { scale, is_mirrored, .. } = space.kind else { panic!("{space:?}") };
            assert_eq!((scale, is_mirrored), (size, mirror < 0.0));
        }
    }

    #[test]
    fn the_spaces_of_a_camera_are_undone() {
        use glam::camera::rh::proj::directx as proj;
        use glam::camera::rh::view as looking;
        let eye = vec3(1.0, 2.0, 4.0);
        let looks = looking::look_at_mat4(eye, Vec3::ZERO, Vec3::Y);
        let clip = proj::perspective(0.7, 1.5, 0.1, 20.0) * looks;
        let view = LodView::new(clip, Vec2::ONE).seen_from(eye, 1.0);
        let place = vec3(0.3, -0.2, 0.5);
        let [of_view, divided, of_clip] =
            [looks * place.extend(1.0), clip * place.extend(1.0), clip * place.extend(1.0)];
        let all = Space::from_camera(&view, Some(clip.as_dmat4()));
        let found = |kind: SpaceKind| *all.iter().find(|space| space.kind == kind).expect("a space");
        let near = |space: Space, theirs: Vec3| space.ours(theirs.as_dvec3()).distance(place.as_dvec3()) < 1e-4;
        assert!(near(found(SpaceKind::View), of_view.truncate()));
        assert!(near(found(SpaceKind::DividedClip), divided.truncate() / divided.w));
        assert!(near(found(SpaceKind::Clip), of_clip.truncate()));
        assert!(Space::from_camera(&LodView::new(Mat4::ZERO, Vec2::ONE), None).is_empty());
    }
}
