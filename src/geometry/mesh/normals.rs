//! Checks the normals that a mesh comes with, and computes normals where there is no usable one: smooth between faces
//! that meet at up to the crease angle, creased elsewhere.

use crate::casts::to_u32;
use crate::choice::choices;
use std::collections::HashMap;

use glam::{DVec3, Vec3};

choices! {
    /// Whose normals the corners of a mesh have.
    #[derive(Default, Hash)]
    pub enum NormalSource {
        #[default]
        File => "file", "Of the file",
            "Corners have the normals of the file. Where it has none, or one without a direction, they are made.";
        Made => "made", "Made anew",
            "All normals are made from the triangles around each point, weighted by angle, as if the file had none. Its \
             smoothing groups and tangents aren't used then.";
    }
}

/// The crease angle unless another one is chosen, in degrees.
pub const CREASE_ANGLE: f32 = 60.0;

/// Room for rounding, in radians: faces that meet at exactly the crease angle count as smooth.
const ROOM: f64 = 1.1547e-5;

/// Around a point with more faces than this, faces are first grouped by direction, which keeps the work linear.
pub(super) const FAN_LIMIT: usize = 256;

/// Numbers of cells along each axis of the grid of directions that groups such faces. The first cells are about 1.3
/// degrees wide; the coarser ones are used where faces point in very different directions.
const CELLS: [f64; 4] = [45.0, 23.0, 12.0, 6.0];

/// The width of the first cells, in degrees. Below such a crease angle, faces of a large fan would be smoothed by the cells alone.
const CELL_ANGLE: f32 = 1.3;

/// The greatest number of cells in a grid, unless the grid is the coarsest one.
const MAX_CELLS: usize = 1024;

/// How far a normal's length may be from 1 without counting as rescaled: as far as the rounding of 8-bit normals takes
/// it.
const LENGTH_TOLERANCE: f64 = 1e-2;

/// How far the square of a normal's length may be from 1 for the normal to keep its bits: a little more than rounding
/// to f32.
const ROUNDING: f64 = 1e-6;

/// A normal from a file or a caller, checked and of unit length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GivenNormal {
    /// The normal was zero or not finite; it counts as missing.
    None,
    /// The normal was of unit length to within 1e-2, and now is to within rounding.
    Unit(Vec3),
    /// The normal had another length, and has been scaled to unit length.
    Rescaled(Vec3),
}

impl GivenNormal {
    /// Checks a normal. If its length is 1 to within half a millionth, it keeps its bits; others are normalised in f64,
    /// in which neither 1e-45 nor 1e38 is out of range.
    pub fn new(normal: Vec3) -> Self {
        let wide = normal.as_dvec3();
        let square = wide.length_squared();
        // Most normals are, and need no root.
        if (square - 1.0).abs() < ROUNDING {
            return Self::Unit(normal);
        }
        let Some(unit) = wide.try_normalize().filter(|_| normal.is_finite()) else { return Self::None };
        if (square.sqrt() - 1.0).abs() <= LENGTH_TOLERANCE {
            Self::Unit(unit.as_vec3())
        } else {
            Self::Rescaled(unit.as_vec3())
        }
    }

    /// Returns the unit normal, if there is one.
    pub fn unit(self) -> Option<Vec3> {
        match self {
            Self::None => None,
            Self::Unit(normal) | Self::Rescaled(normal) => Some(normal),
        }
    }
}

/// A triangle as one of the faces around a point.
#[derive(Clone, Copy, Debug, Default)]
pub struct Face {
    /// The unit surface normal; zero for a triangle without area.
    normal: DVec3,
    /// The triangle's angle at the point, in radians.
    angle: f64,
}

impl Face {
    /// Makes a triangle the face around its corner k. Computed in f64, where products of differences of f32 numbers
    /// neither overflow nor underflow.
    pub fn new(triangle: [Vec3; 3], k: usize) -> Self {
        let (normal, angle) = faces_of(triangle);
        Self { normal, angle: angle(k) }
    }
}

/// Returns the surface normal of the faces that a triangle is around its corners, and what gives their angles: see [`Face`].
pub(super) fn faces_of(triangle: [Vec3; 3]) -> (DVec3, impl Fn(usize) -> f64) {
    let p = triangle.map(Vec3::as_dvec3);
    let cross = (p[1] - p[0]).cross(p[2] - p[0]);
    let length = cross.length();
    let angle = move |k: usize| length.atan2((p[(k + 1) % 3] - p[k]).dot(p[(k + 2) % 3] - p[k]));
    (cross.try_normalize().unwrap_or(DVec3::ZERO), angle)
}

/// The cosine of a crease angle in degrees.
pub(super) fn limit_of(crease_angle: f32) -> f64 {
    (f64::from(crease_angle).to_radians() + ROOM).min(std::f64::consts::PI).cos()
}

/// The mean normal of faces, of which this is the weighted sum; none if that has no direction.
pub(super) fn unit_mean(sum: DVec3) -> Option<Vec3> {
    sum.try_normalize().map(rounded)
}

/// Rounds a direction to a unit normal; +Z if it has none.
fn rounded(direction: DVec3) -> Vec3 {
    direction.try_normalize().unwrap_or(DVec3::Z).as_vec3()
}

/// Computes a unit normal for each face around a point.
///
/// The normal of face f is the mean of the surface normals of all faces g around the point (f among them) that lie
/// within the crease angle (in degrees, 0 to 180) of f's, each weighted by g's angle at the point. Faces without area have
/// weight 0; their own normals are the mean over all faces, or +Z if no face has area. If there are more than 256 faces, they
/// are first grouped in cells of directions, about 1.3 degrees wide (up to 10 where they point in very different directions),
/// and the mean normal of a cell is used for each of its faces. With a crease angle below 1.3 degrees such faces keep their own
/// normals.
///
/// Takes time linear in the number of faces, except in fans of up to 256 faces. Source of the weights: Thürmer and
/// Wüthrich 1998, "Computing vertex normals from polygonal facets".
pub(crate) fn fan_normals(fan: &[Face], crease_angle: f32, normals: &mut Vec<Vec3>) {
    normals.clear();
    let limit = limit_of(crease_angle);
    if fan.len() <= FAN_LIMIT {
        normals.extend(averages(fan, limit));
        return;
    }
    if crease_angle < CELL_ANGLE {
        let all: DVec3 = fan.iter().map(|face| face.angle * face.normal).sum();
        let mean = all.try_normalize().unwrap_or(DVec3::Z);
        normals.extend(fan.iter().map(|face| face.normal.try_normalize().unwrap_or(mean).as_vec3()));
        return;
    }
    let (mut cells, mut cell_of) = gather(fan, CELLS[0]);
    for &along in &CELLS[1..] {
        if cells.len() > MAX_CELLS {
            (cells, cell_of) = gather(fan, along);
        }
    }
    let of_cells: Vec<Vec3> = averages(&cells, limit).collect();
    normals.extend(cell_of.iter().map(|&cell| of_cells[cell as usize]));
}

/// Returns the mean normals of faces. `limit` is the cosine of the crease angle.
fn averages(fan: &[Face], limit: f64) -> impl Iterator<Item = Vec3> {
    // In most fans all faces lie near each other, and have the same mean: the last one, and which faces it is the mean of.
    let mut last: Option<(u64, Vec3)> = None;
    let are_near = are_near(fan, limit);
    fan.iter().map(move |own| {
        let lone = own.normal == DVec3::ZERO;
        let is_near = |g: &&Face| are_near || lone || own.normal.dot(g.normal) >= limit;
        let bits = || if are_near { 0 } else { fan.iter().fold(0, |bits, g| bits << 1 | u64::from(is_near(&g))) };
        let near = (fan.len() <= u64::BITS as usize).then(bits);
        if let Some((_, normal)) = last.filter(|(same, _)| Some(*same) == near) {
            return normal;
        }
        let sum: DVec3 = fan.iter().filter(is_near).map(|g| g.angle * g.normal).sum();
        let mean = unit_mean(sum);
        let normal = mean.unwrap_or_else(|| rounded(own.normal));
        // Faces whose sum has no direction keep their own normals.
        last = near.filter(|_| mean.is_some()).map(|near| (near, normal));
        normal
    })
}

/// Whether each face surely lies within the crease angle of each other one: if all lie within half of it of one of them. False says
/// nothing. `limit` is the cosine of the crease angle.
fn are_near(fan: &[Face], limit: f64) -> bool {
    let Some(first) = fan.first() else { return true };
    // The cosine of half the angle (the half-angle formula), and a little more for rounding.
    let half = (0.5 + 0.5 * limit).max(0.0).sqrt() + 1e-12;
    fan.iter().all(|face| first.normal.dot(face.normal) >= half)
}

/// Groups faces by direction, in a grid with `along` cells for each unit of an axis. Returns each cell as one face
/// (mean normal, total angle), and the cell of each face.
#[expect(
    clippy::cast_possible_truncation,
    reason = "whole numbers; those too large meet at the ends, which only merges cells"
)]
fn gather(fan: &[Face], along: f64) -> (Vec<Face>, Vec<u32>) {
    let mut ids: HashMap<[i64; 3], u32> = HashMap::new();
    let mut sums: Vec<(DVec3, f64)> = Vec::new();
    let mut cell_of = Vec::with_capacity(fan.len());
    for face in fan {
        let key = (face.normal * along).round().to_array().map(|x| x as i64);
        let cell = *ids.entry(key).or_insert(to_u32(sums.len()));
        if cell as usize == sums.len() {
            sums.push((DVec3::ZERO, 0.0));
        }
        sums[cell as usize].0 += face.angle * face.normal;
        sums[cell as usize].1 += face.angle;
        cell_of.push(cell);
    }
    let as_face = |&(sum, angle): &(DVec3, f64)| Face { normal: sum.try_normalize().unwrap_or(DVec3::ZERO), angle };
    (sums.iter().map(as_face).collect(), cell_of)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Material;
    use crate::mesh::mesh_builder::{InputCorner, MeshBuilder};
    use crate::mesh::shapes::Shape;
    use crate::progress::{Cancelled, Progress};
    use glam::Vec2;

    /// Returns the normals that triangles get, corner by corner.
    fn smooth(triangles: &[[Vec3; 3]], progress: &Progress) -> Result<Vec<[Vec3; 3]>, Cancelled> {
        creased(triangles, CREASE_ANGLE, progress)
    }

    fn creased(triangles: &[[Vec3; 3]], degrees: f32, progress: &Progress) -> Result<Vec<[Vec3; 3]>, Cancelled> {
        let mut builder = MeshBuilder::with_crease_angle(degrees);
        let material = builder.material(Material::plain("plain", [1.0; 4]));
        for triangle in triangles {
            let corner = |position| InputCorner { position, normal: None, uv: Vec2::ZERO };
            builder.triangle(material, triangle.map(corner));
        }
        let mesh = builder.finish(String::new(), progress)?;
        Ok(mesh.triangles.iter().map(|corners| corners.map(|c| mesh.corners[c as usize].normal)).collect())
    }

    fn made(shape: Shape) -> (Vec<[Vec3; 3]>, Vec<[Vec3; 3]>) {
        let mesh = shape.build();
        let at = |&c: &u32| mesh.corners[c as usize].position;
        let triangles: Vec<[Vec3; 3]> = mesh.triangles.iter().map(|t| [at(&t[0]), at(&t[1]), at(&t[2])]).collect();
        let normals = smooth(&triangles, &Progress::new()).unwrap();
        (triangles, normals)
    }

    #[test]
    fn faces_of_a_large_fan_that_are_far_apart_keep_their_normals() {
        // 85 degrees apart, but in the same third of each axis.
        let directions = [DVec3::new(0.48, 0.48, 0.734), DVec3::new(-0.48, -0.48, 0.734)].map(DVec3::normalize);
        let face = |i: usize| Face { normal: directions[i % 2], angle: 0.5 + i as f64 / 100.0 };
        let fan: Vec<Face> = (0..=FAN_LIMIT).map(face).collect();
        let mut normals = Vec::new();
        fan_normals(&fan, CREASE_ANGLE, &mut normals);
        assert_eq!(normals.len(), fan.len());
        for (normal, face) in normals.iter().zip(&fan) {
            assert!(normal.as_dvec3().distance(face.normal) < 1e-6, "{normal}, not {}", face.normal);
        }
    }

    #[test]
    fn faces_that_surely_lie_near_each_other_do() {
        let mut random = fastrand::Rng::with_seed(1);
        let mut surely = 0;
        for i in 0..20_000 {
            let degrees = f64::from(i % 181);
            let limit = (degrees.to_radians() + ROOM).min(std::f64::consts::PI).cos();
            let spread = degrees.to_radians() * random.f64();
            let fan: Vec<Face> = (0..6)
                .map(|_| {
                    let around = random.f64() * std::f64::consts::TAU;
                    let (sin, cos) = (spread * random.f64()).sin_cos();
                    Face { normal: DVec3::new(sin * around.cos(), sin * around.sin(), cos), angle: 1.0 }
                })
                .collect();
            if are_near(&fan, limit) {
                surely += 1;
                let is_near = |(a, b): (&Face, &Face)| a.normal.dot(b.normal) >= limit;
                assert!(fan.iter().all(|a| fan.iter().all(|b| is_near((a, b)))), "{fan:?} within {degrees} degrees");
            }
        }
        assert!(surely > 2000, "only {surely} fans are");
    }

    #[test]
    fn normals_of_any_length_keep_their_direction() {
        for scale in [1e-45, 1e-30, 1e-3, 0.98, 1.02, 1e30, f32::MAX] {
            assert_eq!(GivenNormal::new(Vec3::NEG_Y * scale), GivenNormal::Rescaled(Vec3::NEG_Y), "{scale}");
        }
        let GivenNormal::Rescaled(unit) = GivenNormal::new(Vec3::MAX) else {
            panic!("the longest of all has a direction")
        };
        assert!(unit.distance(Vec3::splat(3_f32.sqrt().recip())) < 1e-6);
    }

    #[test]
    fn normals_without_a_direction_are_none() {
        let bad = [Vec3::ZERO, -Vec3::ZERO, Vec3::NAN, Vec3::INFINITY, Vec3::new(1.0, 0.0, f32::NEG_INFINITY)];
        for normal in bad.into_iter().chain([Vec3::new(f32::NAN, 1.0, 0.0)]) {
            assert_eq!(
                (GivenNormal::new(normal), GivenNormal::new(normal).unit()),
                (GivenNormal::None, None),
                "{normal}"
            );
        }
    }

    #[test]
    fn lengths_near_1_are_not_counted() {
        let slant = Vec3::new(0.6, 0.0, 0.8);
        for (length, given) in
            [(1.0, 1.0), (1.0 + 4e-7, 1.0 + 4e-7), (1.0 - 4e-7, 1.0 - 4e-7), (1.009, 1.0), (0.991, 1.0)]
        {
            assert_eq!(GivenNormal::new(Vec3::X * length), GivenNormal::Unit(Vec3::X * given));
        }
        assert!(matches!(GivenNormal::new(slant * 1.011), GivenNormal::Rescaled(unit) if unit.distance(slant) < 1e-7));
        assert!(matches!(GivenNormal::new(slant * 0.989), GivenNormal::Rescaled(unit) if unit.distance(slant) < 1e-7));
    }

    #[test]
    fn a_cube_stays_split() {
        let (triangles, normals) = made(Shape::CubeSmooth);
        for (p, n) in triangles.iter().zip(&normals) {
            let face = (p[1] - p[0]).cross(p[2] - p[0]).normalize();
            assert!(n.iter().all(|n| n.distance(face) < 1e-6), "{n:?} is not the face's {face}");
        }
    }

    #[test]
    fn an_icosphere_becomes_smooth() {
        let (triangles, normals) = made(Shape::Icosphere);
        let mut of_point = HashMap::new();
        for (p, n) in triangles.iter().flatten().zip(normals.iter().flatten()) {
            let first = *of_point.entry(p.to_array().map(f32::to_bits)).or_insert(*n);
            assert_eq!(first, *n, "one point, two normals");
            assert!(n.dot(p.normalize()) > 0.999);
        }
    }

    /// Returns a cone of n sides, its apex above the origin. It is flat if the height is small.
    fn cone(n: usize, height: f32) -> Vec<[Vec3; 3]> {
        let base = |i: usize| {
            let angle = std::f32::consts::TAU * (i % n) as f32 / n as f32;
            Vec3::new(angle.cos(), angle.sin(), 0.0)
        };
        (0..n).map(|i| [base(i), base(i + 1), Vec3::new(0.0, 0.0, height)]).collect()
    }

    #[test]
    fn a_huge_fan_is_gathered_and_points_up() {
        let flat = smooth(&cone(60_000, 0.1), &Progress::new()).unwrap();
        assert!(flat.iter().all(|n| n[2].dot(Vec3::Z) > 0.999), "every face lies within 60 degrees of every other");
        let steep = smooth(&cone(5_000, 10.0), &Progress::new()).unwrap();
        assert!(steep.iter().all(|n| n[2].z < 0.2 && n[2].is_normalized()), "opposite faces don't mix");
    }

    /// A regular pyramid of n sides, whose side i is cut from the apex into `pieces(i)` triangles of different sizes.
    fn cut_cone(n: usize, height: f32, pieces: impl Fn(usize) -> usize) -> Vec<[Vec3; 3]> {
        let cut = |(side, [a, b, apex]): (usize, [Vec3; 3])| {
            let count = pieces(side);
            // Squares of equal steps: the first piece is the smallest.
            let at = move |k: usize| a.lerp(b, (k as f32 / count as f32).powi(2));
            (0..count).map(move |k| [at(k), at(k + 1), apex])
        };
        cone(n, height).into_iter().enumerate().flat_map(cut).collect()
    }

    #[test]
    fn the_normal_of_a_point_does_not_depend_on_how_its_faces_are_cut_into_triangles() {
        // A pyramid's apex looks along its axis. Of more than 256 faces, those of one side are gathered first.
        for (sides, height, most) in [(3, 0.2, 5), (4, 0.3, 7), (7, 0.3, 4), (60, 0.5, 13)] {
            let triangles = cut_cone(sides, height, |side| 1 + side * side % most);
            assert!(triangles.len() > sides, "some side is cut");
            let normals = smooth(&triangles, &Progress::new()).unwrap();
            for normal in normals.iter().map(|corners| corners[2]) {
                assert!(normal.distance(Vec3::Z) < 1e-5, "{sides} sides in {} triangles: {normal}", triangles.len());
            }
        }
    }

    #[test]
    fn faces_count_by_their_angles_and_not_by_their_number_or_area() {
        // Two faces that meet in an edge along y at 40 degrees, one with 30 degrees at the origin and one with 90.
        let slant = 20.0_f64.to_radians();
        let [right, left] = [1.0, -1.0].map(|side| DVec3::new(side * slant.cos(), 0.0, -slant.sin()));
        let within = |across: DVec3, degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            (DVec3::Y * cos + across * sin).as_vec3()
        };
        for [short, long] in [[1.0, 1.0], [0.1, 8.0], [8.0, 0.1]] {
            let triangles =
                [[Vec3::ZERO, within(right, 30.0) * short, Vec3::Y], [Vec3::ZERO, Vec3::Y, within(left, 90.0) * long]];
            let normals = smooth(&triangles, &Progress::new()).unwrap();
            let [right_up, left_up] = [right.cross(DVec3::Y), DVec3::Y.cross(left)];
            let expected = (30.0 * right_up + 90.0 * left_up).normalize().as_vec3();
            for normal in normals.iter().map(|corners| corners[0]) {
                assert!(normal.distance(expected) < 1e-6, "{normal} and not {expected}");
            }
        }
    }

    fn normal_of(p: &[Vec3; 3]) -> Vec3 {
        (p[1] - p[0]).cross(p[2] - p[0]).normalize()
    }

    #[test]
    fn faces_are_smooth_up_to_the_crease_angle_and_creased_beyond_it() {
        // Two squares that share the edge along y, the second one bent by an angle.
        for bend in [0.1_f32, 1.0, 29.0, 60.0, 89.0, 91.0, 150.0, 179.0] {
            let (sin, cos) = bend.to_radians().sin_cos();
            let triangles = [[Vec3::ZERO, Vec3::Y, Vec3::NEG_X], [Vec3::Y, Vec3::ZERO, Vec3::new(cos, 0.0, -sin)]];
            for (crease, is_smooth) in [(bend - 0.05, false), (bend, true), (bend + 0.05, true)] {
                let normals = creased(&triangles, crease, &Progress::new()).unwrap();
                let joined = normals[0][0].distance(normals[1][1]) < 1e-6;
                assert_eq!(joined, is_smooth, "bent by {bend} degrees with a crease angle of {crease}");
            }
        }
    }

    #[test]
    fn with_a_crease_angle_of_0_everything_is_flat_and_with_180_every_point_has_one_normal() {
        // The last one is a fan of more faces than are compared with each other.
        for triangles in [made(Shape::Icosphere).0, made(Shape::CubeSmooth).0, cone(5_000, 1.0)] {
            let flat = creased(&triangles, 0.0, &Progress::new()).unwrap();
            for (p, normals) in triangles.iter().zip(&flat) {
                assert!(normals.iter().all(|n| n.distance(normal_of(p)) < 2e-5), "{normals:?}, not {}", normal_of(p));
            }
            let smooth = creased(&triangles, 180.0, &Progress::new()).unwrap();
            let mut of_point = HashMap::new();
            for (p, n) in triangles.iter().flatten().zip(smooth.iter().flatten()) {
                let first = *of_point.entry(p.to_array().map(|x| (x + 0.0).to_bits())).or_insert(*n);
                assert!(first.distance(*n) < 1e-5, "{first} and {n} at {p}");
            }
        }
    }

    #[test]
    fn triangles_without_area_still_get_unit_normals() {
        let p = Vec3::new(1.0, 2.0, 3.0);
        let normals = smooth(&[[p, p, p], [p, p + Vec3::X, p + Vec3::X * 2.0]], &Progress::new()).unwrap();
        assert!(normals.iter().flatten().all(|n| n.is_normalized()));
    }

    #[test]
    fn tiny_and_huge_triangles_keep_their_direction() {
        for scale in [1e-30, 1e30] {
            let normals = smooth(&[[Vec3::ZERO, Vec3::X * scale, Vec3::Y * scale]], &Progress::new()).unwrap();
            assert_eq!(normals, [[Vec3::Z; 3]]);
        }
    }

    #[test]
    fn cancelling_stops_the_work() {
        let progress = Progress::new();
        progress.cancel();
        assert_eq!(smooth(&cone(5, 1.0), &progress), Err(Cancelled));
    }
}
