//! Folds: emitted triangles that face away from the side that their patch faces. They show where a control net turns
//! over: the white paper's "negative curvature", and the puffing of PN triangles at tight corners.

use glam::{DVec3, Vec3};

use super::visitor::LEAST;
use geometry::cores::in_ranges;
use geometry::mesh::Topology;
use geometry::tessellate::Vertex;

/// A triangle with a height of fewer ULP counts as a line, which faces nowhere.
const LEAST_HEIGHT_ULP: f64 = 8.0;

/// The direction that a triangle faces, with twice its area as length.
fn facing([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// Whether an emitted triangle faces away from `patch_facing` by more than rounding can cause. `ulp` is one unit in the last
/// place of the mesh's largest coordinate.
fn is_folded(patch_facing: DVec3, triangle: [DVec3; 3], ulp: f64) -> bool {
    let [a, b, c] = triangle;
    let own = facing(triangle);
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    own.dot(patch_facing) < 0.0 && own.length() > LEAST_HEIGHT_ULP * ulp * longest
}

/// Twice the area of a triangle in the domain, in units of 2^-32; positive if its winding is that of its patch. In 16.16 fixed
/// point, the tessellator's rows run back by a few 2^-16 where a new point has just appeared. The pattern turns such a triangle
/// over, not the surface.
fn domain_area([a, b, c]: [[u32; 2]; 3]) -> i64 {
    let from_a = |p: [u32; 2]| [0, 1].map(|k| i64::from(p[k]) - i64::from(a[k]));
    let (ab, ac) = (from_a(b), from_a(c));
    ab[0] * ac[1] - ab[1] * ac[0]
}

/// The folds of a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoldedPatch {
    pub patch: u32,
    pub folds: u32,
    /// The area of these triangles together, in square object units.
    pub area: f64,
    /// The corners of the largest of them, in the order in which it faces the side that the patch faces.
    pub largest: [Vec3; 3],
    /// Its area, by which the largest is found.
    largest_area: f64,
}

impl FoldedPatch {
    fn new(patch: u32) -> Self {
        Self { patch, folds: 0, area: 0.0, largest: [Vec3::ZERO; 3], largest_area: 0.0 }
    }

    fn add(&mut self, triangle: [DVec3; 3]) {
        let area = 0.5 * facing(triangle).length();
        self.folds += 1;
        self.area += area;
        if area > self.largest_area {
            self.largest_area = area;
            let [a, b, c] = triangle.map(|corner| corner.as_vec3());
            self.largest = [a, c, b];
        }
    }

    /// The middle of the largest.
    pub fn place(&self) -> Vec3 {
        self.largest.iter().map(|corner| corner / 3.0).sum()
    }
}

/// Returns the patches with folds among triangles, which are indices into `vertices` and come patch after patch.
pub(super) fn find(
    topology: &Topology,
    ulp: f64,
    vertices: &[Vertex],
    triangles: &[[u32; 3]],
) -> impl Iterator<Item = FoldedPatch> {
    let patch = |i: usize| vertices[triangles[i][0] as usize].patch();
    // Where a patch begins or all triangles end, from `i` on.
    let begins =
        |i: usize| (i..triangles.len()).find(|&i| i == 0 || patch(i) != patch(i - 1)).unwrap_or(triangles.len());
    in_ranges(triangles.len(), LEAST, |range| {
        of_whole_patches(topology, ulp, vertices, &triangles[begins(range.start)..begins(range.end)])
    })
    .into_iter()
    .flatten()
}

/// The same for fewer triangles.
fn of_whole_patches(topology: &Topology, ulp: f64, vertices: &[Vertex], triangles: &[[u32; 3]]) -> Vec<FoldedPatch> {
    let at = |index: u32| Vec3::from(vertices[index as usize].position).as_dvec3();
    let mut found: Vec<FoldedPatch> = Vec::new();
    let (mut patch, mut patch_facing) = (u32::MAX, DVec3::ZERO);
    for triangle in triangles {
        let own = vertices[triangle[0] as usize].patch();
        if own != patch {
            (patch, patch_facing) = (own, facing(topology.patch_positions(own).map(|corner| corner.as_dvec3())));
        }
        let domain = triangle.map(|index| vertices[index as usize].domain());
        let places = triangle.map(at);
        if is_folded(patch_facing, places, ulp) && domain_area(domain) > 0 {
            if found.last().is_none_or(|last| last.patch != own) {
                found.push(FoldedPatch::new(own));
            }
            if let Some(last) = found.last_mut() {
                last.add(places);
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;
    use geometry::mesh::Shape;
    use geometry::progress::Progress;
    use geometry::tessellate::{LodView, Partitioning, Surface, Tessellation, pack_key, tessellate};
    use glam::{Mat4, Vec2};

    fn found(topology: &Topology, vertices: &[Vertex], triangles: &[[u32; 3]]) -> Vec<FoldedPatch> {
        find(topology, 1e-9, vertices, triangles).collect()
    }

    #[test]
    fn triangles_that_face_away_are_folded_unless_they_are_lines() {
        let up = DVec3::Z;
        let [o, x, y] = [DVec3::ZERO, DVec3::X, DVec3::Y];
        assert!(!is_folded(up, [o, x, y], 1e-7));
        assert!(is_folded(up, [o, y, x], 1e-7));
        let flat = [o, 1e-7 * y, x];
        assert!(is_folded(up, flat, 1e-9) && !is_folded(up, flat, 1e-7), "1 ULP high");
    }

    #[test]
    fn a_triangle_that_the_pattern_turns_over_is_no_fold() {
        let mesh = Shape::Icosahedron.build();
        let topology = Topology::build(&mesh, &Progress::new()).expect("nobody cancels");
        // Just above 21, the points that have just appeared lie 2^-16 behind the ones that they come from.
        let factor = 21.0 + 3.0 / 65536.0;
        let settings = Settings::from(Tessellation {
            surface: Surface::Flat,
            partitioning: Partitioning::FractionalOdd,
            factor,
            ..Tessellation::default()
        });
        let view = LodView::new(Mat4::IDENTITY, Vec2::ONE);
        let out = tessellate(&mesh, &topology, &settings.inputs(view), None);
        let domains = out.triangles.iter().map(|triangle| triangle.map(|index| out.vertices[index as usize].domain()));
        assert!(domains.map(domain_area).any(|area| area < 0), "the pattern should turn a triangle over at {factor}");
        assert_eq!(found(&topology, &out.vertices, &out.triangles), []);
    }

    #[test]
    fn the_longest_side_decides_what_is_a_line_wherever_it_is() {
        // A unit long and 1e-7 high: at most a line where the least height is 1.2e-7.
        let flat = [DVec3::ZERO, DVec3::new(0.5, 1e-7, 0.0), DVec3::X];
        for first in 0..3 {
            let turned = [0, 1, 2].map(|k| flat[(first + k) % 3]);
            assert!(is_folded(DVec3::Z, turned, 1.1e-8) && !is_folded(DVec3::Z, turned, 1.5e-8), "from corner {first}");
        }
    }

    #[test]
    fn every_folded_triangle_is_counted_against_its_own_patch() {
        let mesh = Shape::Icosahedron.build();
        let topology = Topology::build(&mesh, &Progress::new()).expect("nobody cancels");
        let corner = |patch: u32, at: usize, domain: [u32; 2]| Vertex {
            position: topology.patch_positions(patch)[at].to_array(),
            key: pack_key(patch, domain),
            ..bytemuck::Zeroable::zeroed()
        };
        // Two patches as they are, and the second once more with two of its corners exchanged.
        let as_is =
            |patch| [(0, [65536, 0]), (1, [0, 65536]), (2, [0, 0])].map(|(at, domain)| corner(patch, at, domain));
        let turned = [(1, [65536, 0]), (0, [0, 65536]), (2, [0, 0])].map(|(at, domain)| corner(1, at, domain));
        let vertices = [as_is(0), as_is(1), turned].concat();
        assert_eq!(found(&topology, &vertices, &[[0, 1, 2], [3, 4, 5]]), []);
        let folded = found(&topology, &vertices, &[[0, 1, 2], [6, 7, 8], [3, 4, 5], [6, 7, 8]]);
        let [folded] = folded[..] else { panic!("one patch is folded: {folded:?}") };
        assert_eq!((folded.patch, folded.folds), (1, 2));
        let [a, b, c] = topology.patch_positions(1).map(|corner| corner.as_dvec3());
        assert!((folded.area - (b - a).cross(c - a).length()).abs() < 1e-6, "twice the patch: {}", folded.area);
        assert!(folded.place().distance(((a + b + c) / 3.0).as_vec3()) < 1e-6, "{:?}", folded.largest);
        let front = facing(folded.largest.map(Vec3::as_dvec3));
        assert!(front.dot((b - a).cross(c - a)) > 0.0, "it faces the side of its patch: {:?}", folded.largest);
    }
}
