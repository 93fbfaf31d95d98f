//! Defects of a mesh as it was loaded that decide how it tessellates: where they are.

use std::collections::HashSet;

use glam::DVec3;

use geometry::casts::to_u32;
use geometry::mesh::{Bounds, Edge, EdgeKind, Mesh, Side, Topology};
use geometry::near::TriangleTree;

/// Open edges that another one is nearer to than this part of the bounding diagonal nearly meet it.
const NEAR: f32 = 1e-4;
/// The cosine of the largest angle between faces that share normals without being meant as a hard edge: 60 degrees.
const SMOOTH: f64 = 0.5;
/// The middle of a triangle that isn't inflated rises by less than this part of its longest edge.
const RISE: f64 = 0.02;

/// Where a defect is.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Defects {
    /// Edges of the topology.
    Edges(Vec<u32>),
    /// Triangles of the mesh.
    Triangles(Vec<u32>),
    /// Triangles of the mesh, and how far the middle of each rises, in object units.
    Inflated(Vec<(u32, f64)>),
}

impl Defects {
    pub(super) fn count(&self) -> usize {
        match self {
            Self::Edges(all) | Self::Triangles(all) => all.len(),
            Self::Inflated(all) => all.len(),
        }
    }

    /// Edges of two triangles wound opposite ways.
    pub(super) fn winding(_: &Mesh, topology: &Topology) -> Self {
        Self::edges(topology, |edge| matches!(topology.edge_sides(edge), [a, b] if a.reversed() == b.reversed()))
    }

    /// Open edges that nearly meet another one.
    pub(super) fn near_seam(_: &Mesh, topology: &Topology) -> Self {
        let is_near = near_another(topology);
        let are_near = |edge: &Edge| topology.edge_points(edge).iter().all(|point| is_near[*point as usize]);
        Self::edges(topology, |edge| edge.kind == EdgeKind::Boundary && are_near(edge))
    }

    /// Triangles with a corner whose normal points to the back of their face.
    pub(super) fn against_faces(mesh: &Mesh, topology: &Topology) -> Self {
        Self::patches(topology, |patch| {
            let face = face(topology, patch);
            let mut normals =
                topology.patch_corners(patch).into_iter().map(|corner| mesh.corners[corner as usize].normal);
            normals.any(|normal| normal.as_dvec3().dot(face) < 0.0)
        })
    }

    /// Triangles beside a sharp edge with smooth normals, whose middle PN triangles raise.
    pub(super) fn inflated(mesh: &Mesh, topology: &Topology) -> Self {
        let sharp = topology.edges.iter().filter(|edge| is_sharp_but_smooth(topology, edge));
        let mut patches: Vec<u32> = sharp.flat_map(|edge| topology.edge_sides(edge)).map(Side::patch).collect();
        patches.sort_unstable();
        patches.dedup();
        let rising = |patch: u32| {
            let (rise, longest) = rise(mesh, topology, patch);
            (rise > RISE * longest).then_some((topology.patches[patch as usize].triangle, rise))
        };
        Self::Inflated(patches.into_iter().filter_map(rising).collect())
    }

    /// Triangles with two corners on one point, and those with their corners in line.
    pub(super) fn without_area(mesh: &Mesh, topology: &Topology) -> Self {
        let mut has_area = vec![false; mesh.triangles.len()];
        for (patch, of) in topology.patches.iter().enumerate() {
            has_area[of.triangle as usize] = !topology.is_in_line(to_u32(patch));
        }
        Self::Triangles((0..to_u32(has_area.len())).filter(|triangle| !has_area[*triangle as usize]).collect())
    }

    /// Triangles with the same three points as one before them.
    pub(super) fn repeated(_: &Mesh, topology: &Topology) -> Self {
        let mut known = HashSet::with_capacity(topology.patches.len());
        Self::patches(topology, |patch| {
            let mut points = topology.patch_points(patch);
            points.sort_unstable();
            !known.insert(points)
        })
    }

    pub(super) fn edges(topology: &Topology, is_one: impl Fn(&Edge) -> bool) -> Self {
        let found = topology.edges.iter().enumerate().filter(|(_, edge)| is_one(edge));
        Self::Edges(found.map(|(index, _)| to_u32(index)).collect())
    }

    /// The triangles of patches.
    fn patches(topology: &Topology, mut is_one: impl FnMut(u32) -> bool) -> Self {
        let found = (0..to_u32(topology.patches.len())).filter(|patch| is_one(*patch));
        Self::Triangles(found.map(|patch| topology.patches[patch as usize].triangle).collect())
    }
}

/// The normal of a patch's face, at unit length.
fn face(topology: &Topology, patch: u32) -> DVec3 {
    let [a, b, c] = topology.patch_positions(patch).map(|corner| corner.as_dvec3());
    (b - a).cross(c - a).normalize_or_zero()
}

/// Whether two faces that meet at an edge share its normals, though the angle between them is that of a hard edge.
fn is_sharp_but_smooth(topology: &Topology, edge: &Edge) -> bool {
    let [a, b] = topology.edge_sides(edge) else { return false };
    let shares_normals = matches!(edge.kind, EdgeKind::Smooth | EdgeKind::Seam) && a.reversed() != b.reversed();
    shares_normals && face(topology, a.patch()).dot(face(topology, b.patch())) < SMOOTH - 1e-6
}

/// How far PN triangles raise a patch's middle above the flat triangle, and the triangle's longest edge, in object units. The
/// control points of edges lie at (2 a + b - ((b - a) . n) n) / 3, and the middle is their mean (Vlachos et al. 2001, section 3.1).
fn rise(mesh: &Mesh, topology: &Topology, patch: u32) -> (f64, f64) {
    let positions = topology.patch_positions(patch).map(|corner| corner.as_dvec3());
    let corners = topology.patch_corners(patch).map(|corner| mesh.corners[corner as usize].normal.as_dvec3());
    let face = face(topology, patch);
    let raised = |from: usize, to: usize| {
        let normal = corners[from].normalize_or_zero();
        (positions[from] - positions[to]).dot(normal) * normal.dot(face) / 18.0
    };
    let pairs = [(0, 1), (1, 2), (2, 0)];
    let rise = pairs.iter().map(|&(a, b)| raised(a, b) + raised(b, a)).sum();
    let longest = pairs.iter().map(|&(a, b)| positions[a].distance(positions[b])).fold(0.0, f64::max);
    (rise, longest)
}

/// For each point, whether it ends open edges, and one that ends others is nearer than [`NEAR`], which is less than half the
/// length of each of these edges.
fn near_another(topology: &Topology) -> Vec<bool> {
    let reach = f64::from(NEAR * Bounds::new(topology.points.iter().copied()).diagonal());
    let at = |point: u32| topology.points[point as usize];
    let mut shortest = vec![f64::INFINITY; topology.points.len()];
    for edge in topology.edges.iter().filter(|edge| edge.kind == EdgeKind::Boundary) {
        let [a, b] = topology.edge_points(edge);
        let length = at(a).as_dvec3().distance(at(b).as_dvec3());
        [a, b].iter().for_each(|end| shortest[*end as usize] = shortest[*end as usize].min(length));
    }
    let is_long = |point: u32| (2.0 * reach..f64::INFINITY).contains(&shortest[point as usize]);
    let points: Vec<u32> = (0..to_u32(topology.points.len())).filter(|point| is_long(*point)).collect();
    let mut is_near = vec![false; topology.points.len()];
    let Some(tree) = TriangleTree::new(points.iter().map(|point| [at(*point); 3])) else { return is_near };
    for &point in &points {
        let place = at(point).as_dvec3();
        is_near[point as usize] = tree.any_within(place, reach, |other| points[other as usize] != point);
    }
    is_near
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3, vec3};

    use super::super::{Facts, Found, Gate, GateKind, Judgement, Limit, judge};
    use super::*;
    use geometry::mesh::{Corner, Shape};

    /// A mesh of these triangles, each of which has corners of its own with one normal.
    fn mesh(triangles: &[[Vec3; 3]], normals: &[Vec3]) -> (Mesh, Topology) {
        let corners = triangles.iter().zip(normals.iter().cycle()).flat_map(|(triangle, normal)| {
            triangle.map(|position| Corner { position, normal: *normal, uv: Vec2::ZERO })
        });
        let indices: Vec<[u32; 3]> = (0..to_u32(triangles.len())).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let mesh = Mesh { corners: corners.collect(), triangles: indices.into(), ..Mesh::default() };
        let topology = Topology::new(&mesh);
        (mesh, topology)
    }

    fn counts(triangles: &[[Vec3; 3]], normals: &[Vec3]) -> Vec<(&'static str, usize)> {
        let (mesh, topology) = mesh(triangles, normals);
        let gates = GateKind::ALL.map(|kind| Gate { kind, limit: Limit::Count(0) });
        let judged = judge(&gates, &Facts { mesh: Some((&mesh, &topology)), ..Facts::from_mesh(&topology) });
        let count = |judged: &Judgement| match judged.found? {
            Found::Count(count) => Some((judged.gate, usize::try_from(count).ok()?)),
            Found::Length(_) | Found::Px(_) => None,
        };
        judged.iter().filter_map(count).filter(|(_, count)| *count > 0).collect()
    }

    const A: Vec3 = Vec3::ZERO;
    const B: Vec3 = Vec3::X;
    const C: Vec3 = Vec3::NEG_Z;

    #[test]
    fn each_defect_is_counted_where_it_is() {
        let d = vec3(1.0, 0.0, -1.0);
        assert_eq!(counts(&[[A, B, C]], &[Vec3::Y]), [("boundary", 3)]);
        assert_eq!(counts(&[[A, B, C], [B, d, C]], &[Vec3::Y]), [("boundary", 4)]);
        assert_eq!(
            counts(&[[A, B, C], [B, C, d]], &[Vec3::Y]),
            [("boundary", 4), ("winding", 1), ("normals-against-faces", 1)]
        );
        assert_eq!(
            counts(&[[A, B, C], [B, d, C]], &[Vec3::Y, vec3(0.1, 1.0, 0.0)]),
            [("boundary", 4), ("hard-edges", 1)]
        );
        let fin = vec3(0.5, 1.0, -0.5);
        let three = counts(&[[A, B, C], [B, d, C], [B, fin, C]], &[Vec3::Y, Vec3::Y, vec3(1.0, 0.0, 1.0)]);
        assert!(three.contains(&("non-manifold", 1)), "{three:?}");
        assert_eq!(counts(&[[A, B, C], [C, A, B]], &[Vec3::Y])[..1], [("winding", 3)]);
        assert!(counts(&[[A, B, C], [C, A, B]], &[Vec3::Y]).contains(&("duplicates", 1)));
        for thin in [[A, B, B], [A, A, A], [A, B / 2.0, B]] {
            assert!(counts(&[[A, B, C], thin], &[Vec3::Y]).contains(&("degenerate", 1)), "{thin:?}");
        }
    }

    #[test]
    fn a_box_with_smooth_normals_is_inflated_and_round_shapes_are_not() {
        for shape in Shape::ALL {
            let mesh = shape.build();
            let topology = Topology::new(&mesh);
            let Defects::Inflated(found) = Defects::inflated(&mesh, &topology) else { panic!("triangles that rise") };
            let expected = if shape == Shape::CubeSmooth { mesh.triangles.len() } else { 0 };
            assert_eq!(found.len(), expected, "{shape:?}");
            // Half of a face whose normals have parts of 1 / sqrt(3): legs count four times, and the diagonal as much.
            let rise = 8.0 * found.first().map_or(0.0, |(triangle, _)| leg(&mesh, *triangle)) / 3.0 / 18.0;
            assert!(found.iter().all(|(_, own)| (own - rise).abs() < 1e-6), "{shape:?}: {found:?} and {rise}");
        }
    }

    /// The shortest edge of a triangle.
    fn leg(mesh: &Mesh, triangle: u32) -> f64 {
        let [a, b, c] =
            mesh.triangles[triangle as usize].map(|corner| mesh.corners[corner as usize].position.as_dvec3());
        a.distance(b).min(b.distance(c)).min(c.distance(a))
    }

    #[test]
    fn seams_that_nearly_meet_are_found_and_small_triangles_are_not_one() {
        let gap = vec3(0.0, 5e-5, 0.0);
        let other = [B + gap, vec3(1.0, 0.0, -1.0), C + gap];
        assert!(counts(&[[A, B, C], other], &[Vec3::Y]).contains(&("near-seam", 2)));
        assert!(
            !counts(&[[A, B, C], other.map(|corner| corner + 10.0 * gap)], &[Vec3::Y])
                .iter()
                .any(|(name, _)| *name == "near-seam")
        );
        // The bounding box is that of the large one.
        let small = [A, B, C].map(|corner| 5e-5 * corner + 0.5);
        assert_eq!(counts(&[[A, B, C], small], &[Vec3::Y]), [("boundary", 6)]);
    }
}
