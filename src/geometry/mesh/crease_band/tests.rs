use std::collections::HashMap;

use glam::{DVec3, Vec2, Vec3};
use proptest::prelude::*;

use super::*;
use crate::mesh::{Budget, CornerDetail, EdgeCounts, Material, MemoryRefused, Shape, Side, weld};

fn topology(mesh: &Mesh) -> Topology {
    Topology::build(mesh, &Progress::new()).unwrap()
}

/// Returns a mesh with a crease band, after welding its points within a tolerance.
fn banded_within(mesh: &Mesh, weld: f32, width: f32) -> (Mesh, Topology, CreaseBand) {
    let progress = Progress::new();
    let before = Topology::build_within(mesh, weld, &progress).unwrap();
    let (made, after, band) = with_crease_band(mesh, &before, width, &Budget::unlimited(), &progress).unwrap();
    assert_eq!(after.edges, topology(&made).edges);
    for edge in &after.edges {
        let normals = |side: &Side| after.side_corners(side).map(|corner| made.corners[corner as usize].normal);
        let sides = after.edge_sides(edge);
        assert!(sides.iter().all(|side| normals(side) == normals(&sides[0])), "{} {width}: {edge:?}", mesh.name);
    }
    (made, after, band)
}

fn banded(mesh: &Mesh, width: f32) -> (Mesh, Topology, CreaseBand) {
    banded_within(mesh, 0.0, width)
}

fn mesh_of(triangles: impl IntoIterator<Item = [Corner; 3]>) -> Mesh {
    let mut builder = MeshBuilder::new();
    let material = builder.material(Material::plain("plain", [1.0; 4]));
    for triangle in triangles {
        builder.triangle(material, triangle.map(InputCorner::from));
    }
    builder.finish(String::new(), &Progress::new()).unwrap()
}

fn triangles(mesh: &Mesh) -> impl Iterator<Item = [Corner; 3]> {
    mesh.triangles.iter().map(|triangle| triangle.map(|corner| mesh.corners[corner as usize]))
}

fn places(triangle: [Corner; 3]) -> [DVec3; 3] {
    triangle.map(|corner| corner.position.as_dvec3())
}

fn area(triangle: [Corner; 3]) -> DVec3 {
    let [a, b, c] = places(triangle);
    (b - a).cross(c - a) / 2.0
}

fn areas(mesh: &Mesh) -> f64 {
    triangles(mesh).map(|triangle| area(triangle).length()).sum()
}

/// Six times the volume of a closed mesh, seen from `at`.
fn volume(mesh: &Mesh, at: DVec3) -> f64 {
    triangles(mesh).map(places).map(|[a, b, c]| (a - at).dot((b - at).cross(c - at))).sum()
}

fn euler(topology: &Topology) -> i64 {
    topology.points.len() as i64 - topology.edges.len() as i64 + topology.patches.len() as i64
}

#[test]
fn a_cube_gets_cells_at_its_points_and_strips_along_its_edges() {
    // With a width of 0.1, each face is a square of 1.2 around a square of 1.0, and each edge is cut 0.1 from both
    // ends.
    let cube = Shape::CubeSplit.build();
    let (mesh, topology, band) = banded(&cube, 0.1 / cube.bounds().diagonal());
    assert_eq!((band.creases, band.narrowed), (12, 0));
    // For each triangle (half a face): half of the middle square, and along each of two creases two triangles in the
    // strip and one at each end.
    assert_eq!((mesh.triangles.len(), topology.degenerate), (12 * 9, 0));
    // The cube's points, two on each edge, and four on each face.
    assert_eq!((topology.points.len(), euler(&topology)), (8 + 24 + 24, 2));
    let kinds = EdgeCounts { smooth: 162 - 36, seam: 36, ..EdgeCounts::default() };
    assert_eq!(topology.edge_counts(), kinds, "each of twelve creases is three edges with a uv square on either side");
    assert!(topology.is_closed_and_oriented());
    for point in &topology.points {
        for x in point.abs().to_array() {
            assert!((x - 0.6).abs() < 1e-6 || (x - 0.5).abs() < 1e-6, "{point}");
        }
    }
    for Corner { position, normal, .. } in &mesh.corners {
        assert!(normal.is_normalized());
        // The mean of the normals of all faces that meet there: equally steep towards each of them.
        let outward = (*normal * position.signum()).to_array();
        let faces: Vec<_> = (0..3).filter(|&axis| position[axis].abs() > 0.55).map(|axis| outward[axis]).collect();
        assert!(!faces.is_empty() && faces.iter().all(|x| (x - faces[0]).abs() < 1e-6), "{position} {normal}");
        assert!((0..3).all(|axis| position[axis].abs() > 0.55 || outward[axis] < faces[0]), "{position} {normal}");
    }
}

#[test]
fn a_cubes_uvs_are_those_of_its_faces() {
    let cube = Shape::CubeSplit.build();
    let (mesh, ..) = banded(&cube, 0.03);
    let per_area = |triangle: [Corner; 3]| {
        let [a, b, c] = triangle.map(|corner| corner.uv.as_dvec2());
        (b - a).perp_dot(c - a) / 2.0 / area(triangle).length()
    };
    let expected = per_area(triangles(&cube).next().unwrap());
    for triangle in triangles(&mesh) {
        assert!((per_area(triangle) / expected - 1.0).abs() < 1e-3);
        // A face's texture coordinates are linear in its positions, so its centre is the centre of the uv square.
        for Corner { position, uv, .. } in triangle {
            let out = position.abs().max_element();
            assert!((out - 0.6).abs() < 1e-6 && uv.min_element() >= 0.0 && uv.max_element() <= 1.0);
        }
    }
}

#[test]
fn triangles_beside_one_crease_and_at_a_crease_are_counted_by_hand() {
    // A triangle of the wall has a strip of two for its crease, two for what is left, and one where its corner touches
    // the other circle of creases. A triangle of a cap has a strip of two and the rest: on the circle only two faces
    // meet, so its other edges aren't cut.
    let (mesh, topology, band) = banded(&Shape::Cylinder.build(), 0.01);
    assert_eq!((mesh.triangles.len(), band.creases, band.narrowed), (24 * 5 + 24 * 3, 24, 0));
    assert_eq!((topology.edge_counts().split, euler(&topology), topology.is_closed_and_oriented()), (0, 2, true));
    let height = |corner: &Corner| corner.position.y.abs();
    let width = 0.01 * Shape::Cylinder.build().bounds().diagonal();
    let wall = mesh.corners.iter().filter(|corner| corner.normal.y == 0.0);
    let expected = 0.75 - width;
    assert!(wall.into_iter().all(|c| (height(c) - expected).abs() < 1e-6), "the wall's own normals begin in one line");
    // A triangle of the cone's slope is creased on all sides: its middle, a strip of two at the circle, and strips of
    // four at the two creases that are cut at both ends.
    let (mesh, topology, band) = banded(&Shape::Cone.build(), 0.01);
    assert_eq!((mesh.triangles.len(), band.creases), (12 * 11 + 12 * 3, 24));
    assert_eq!((topology.edge_counts().split, euler(&topology), topology.is_closed_and_oriented()), (0, 2, true));
    let apex: Vec<_> = mesh.corners.iter().filter(|corner| corner.position.y > 0.74).map(|c| c.normal).collect();
    assert!(!apex.is_empty() && apex.iter().all(|normal| normal.distance(Vec3::Y) < 1e-6));
}

#[test]
fn no_triangle_turns_over_however_wide_the_band() {
    for shape in Shape::ALL {
        let before = shape.build();
        for width in [1e-7, 1e-3, 0.02, WIDEST] {
            let (mesh, topology, _) = banded(&before, width);
            let name = format!("{shape:?} {width}");
            assert_eq!(topology.degenerate, 0, "{name}");
            assert!((areas(&mesh) / areas(&before) - 1.0).abs() < 1e-5, "{name}");
            // Triangles that turned over would count twice in the area, but not in the sum of a side's surface normals.
            for triangle in triangles(&mesh) {
                let face = area(triangle).normalize().as_vec3();
                let own = triangle.iter().map(|corner| corner.normal.dot(face)).sum::<f32>();
                assert!(own > 0.0 || shape == Shape::Moebius, "{name} {triangle:?}");
            }
        }
    }
}

#[test]
fn a_wide_band_is_narrowed_and_counted() {
    let (_, topology, band) = banded(&Shape::Cylinder.build(), 0.1);
    assert!(band.narrowed > 0 && topology.is_closed_and_oriented());
    assert_eq!(banded(&Shape::Cylinder.build(), 0.01).2.narrowed, 0);
}

#[test]
fn without_creases_a_mesh_stays_as_it_is() {
    for shape in [Shape::Torus, Shape::Icosphere, Shape::CubeSmooth, Shape::Saddle] {
        let before = shape.build();
        let (mesh, _, band) = banded(&before, 0.05);
        assert_eq!((&mesh.corners, &mesh.triangles, &mesh.name), (&before.corners, &before.triangles, &before.name));
        assert_eq!((band.creases, band.narrowed), (0, 0));
    }
}

/// Two triangles over the edge from the origin to (1, 0, 0), with normals of their own.
fn roof(left: [Vec3; 2], right: [Vec3; 2]) -> Mesh {
    let corner = |x: f32, y: f32, normal: Vec3| Corner { position: Vec3::new(x, y, 0.0), normal, uv: Vec2::ZERO };
    let (a, b) = (|n| corner(0.0, 0.0, n), |n| corner(1.0, 0.0, n));
    mesh_of([
        [a(left[0]), b(left[1]), corner(0.5, 1.0, Vec3::Z)],
        [b(right[1]), a(right[0]), corner(0.5, -1.0, Vec3::Z)],
    ])
}

#[test]
fn a_crease_may_end_at_a_point() {
    // The normals are split at the origin only, as at the end of a dart. At the other end the strip is one triangle.
    let slant = Vec3::new(0.0, 0.6, 0.8);
    let (mesh, topology, band) = banded(&roof([slant, Vec3::Z], [Vec3::Z; 2]), 0.05);
    assert_eq!((band.creases, mesh.triangles.len(), topology.points.len()), (1, 2 * 2, 6));
    let at = |position: Vec3| {
        let normals = mesh.corners.iter().filter(|c| c.position == position).map(|c| c.normal).collect::<Vec<_>>();
        assert_eq!(normals.len(), 1, "{normals:?} at {position}");
        normals[0]
    };
    assert!(at(Vec3::ZERO).distance((slant + Vec3::Z).normalize()) < 1e-6);
    assert_eq!(at(Vec3::X), Vec3::Z);
    let kinds = topology.edge_counts();
    assert_eq!((kinds.split, kinds.boundary), (0, 4 + 2), "two of the four open edges are cut near the origin");
}

#[test]
fn normals_that_cancel_leave_one_of_them() {
    let (mesh, topology, _) = banded(&roof([Vec3::Z; 2], [Vec3::NEG_Z; 2]), 0.05);
    assert_eq!(topology.edge_counts().split, 0);
    assert!(mesh.corners.iter().all(|corner| corner.normal.is_normalized()));
}

#[test]
fn parts_that_meet_in_a_point_have_nothing_to_tear() {
    let corner = |x: f32, y: f32, normal| Corner { position: Vec3::new(x, y, 0.0), normal, uv: Vec2::ZERO };
    let wing = |s: f32, n: Vec3| [corner(0.0, 0.0, n), corner(s, 0.0, n), corner(s, s, n)];
    let before = mesh_of([wing(1.0, Vec3::Z), wing(-1.0, Vec3::X)]);
    let (mesh, ..) = banded(&before, 0.05);
    assert_eq!((mesh.corners, mesh.triangles), (before.corners, before.triangles));
}

#[test]
fn the_two_sides_of_a_leaf_stay_separate() {
    let corner = |x: f32, y: f32, normal| Corner { position: Vec3::new(x, y, 0.0), normal, uv: Vec2::ZERO };
    let [a, b, c] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|[x, y]| move |normal| corner(x, y, normal));
    let [front, back] = [Vec3::Z, Vec3::NEG_Z];
    let (mesh, topology, band) = banded(&mesh_of([[a(front), b(front), c(front)], [b(back), a(back), c(back)]]), 0.02);
    assert!(topology.is_closed_and_oriented());
    assert_eq!((band.creases, mesh.triangles.len(), topology.points.len()), (3, 2 * 7, 3 + 2 * 3));
    for (point, normal) in mesh.corners.iter().map(|corner| (corner.position, corner.normal)) {
        let on_border = point.x == 0.0 || point.y == 0.0 || point.x + point.y > 0.999;
        assert!(on_border || normal == front || normal == back);
    }
    let inside = |normal| mesh.corners.iter().filter(|c| c.normal == normal && c.position.min_element() >= 0.0).count();
    assert!(inside(front) >= 3 && inside(back) >= 3);
}

#[test]
fn parts_that_lie_on_each_other_agree_where_their_cuts_meet() {
    let large = roof([Vec3::X; 2], [Vec3::Z; 2]);
    let small = mesh_of(
        triangles(&roof([Vec3::Y; 2], [Vec3::NEG_X; 2]))
            .map(|triangle| triangle.map(|corner| Corner { position: corner.position * 0.5, ..corner })),
    );
    let points = |mesh: &Mesh| banded(mesh, 0.02 / mesh.bounds().diagonal()).1.points.len();
    let both = mesh_of(triangles(&large).chain(triangles(&small)));
    // They share the origin and, on both open edges from there, the cuts near it.
    assert_eq!(points(&both), points(&large) + points(&small) - 3);
}

#[test]
fn materials_keep_their_triangles_together() {
    let cube = Shape::CubeSplit.build();
    let mut builder = MeshBuilder::new();
    let names = ["front", "back", "sides"];
    let materials = names.map(|name| builder.material(Material::plain(name, [1.0; 4])));
    for (i, triangle) in triangles(&cube).enumerate() {
        builder.triangle(materials[(i / 2).min(2)], triangle.map(InputCorner::from));
    }
    let before = builder.finish("cube".to_owned(), &Progress::new()).unwrap();
    let (mesh, ..) = banded(&before, 0.05);
    let ranges: Vec<_> = mesh.materials.iter().map(|m| (m.name.as_str(), m.triangles.clone())).collect();
    assert_eq!(ranges, [("front", 0..18), ("back", 18..36), ("sides", 36..108)]);
    assert_eq!(mesh.name, "cube");
}

/// A closed shape whose corners all have normals of their own, a few of them equal.
fn ragged(shape: Shape, picks: &[u8]) -> Mesh {
    let directions = [Vec3::X, Vec3::NEG_X, Vec3::new(0.6, 0.8, 0.0), Vec3::new(0.0, -0.6, 0.8)];
    let mut pick = picks.iter().cycle();
    mesh_of(triangles(&shape.build()).map(|triangle| {
        triangle.map(|corner| {
            let pick = usize::from(*pick.next().unwrap());
            Corner { normal: directions.get(pick).copied().unwrap_or(corner.normal), ..corner }
        })
    }))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn closed_meshes_stay_closed_whatever_their_normals(
        shape in prop::sample::select(vec![
            Shape::CubeSplit, Shape::Icosphere, Shape::Torus, Shape::Cylinder, Shape::Cone,
        ]),
        picks in prop::collection::vec(0_u8..40, 1..200),
        width in 1e-4_f32..0.1,
    ) {
        let before = ragged(shape, &picks);
        let old = topology(&before);
        let (mesh, new, _) = banded(&before, width);
        prop_assert!(new.is_closed_and_oriented());
        prop_assert_eq!((new.edge_counts().split, new.degenerate), (0, 0));
        prop_assert_eq!(euler(&new), euler(&old));
        let at = Vec3::splat(0.1).as_dvec3();
        prop_assert!((volume(&mesh, at) / volume(&before, at) - 1.0).abs() < 1e-5);
        prop_assert!((areas(&mesh) / areas(&before) - 1.0).abs() < 1e-5);
        // One normal on each point, since every point has one fan here.
        let mut normals = HashMap::new();
        let (_, points) = weld::weld(mesh.corners.len(), |corner| mesh.corners[corner].position);
        for (corner, point) in mesh.corners.iter().zip(points) {
            prop_assert_eq!(*normals.entry(point).or_insert(corner.normal), corner.normal);
        }
    }
}

#[test]
fn cancelling_stops_the_work() {
    let progress = Progress::new();
    let cube = Shape::CubeSplit.build();
    let topology = topology(&cube);
    progress.cancel();
    assert!(matches!(
        with_crease_band(&cube, &topology, 0.01, &Budget::unlimited(), &progress),
        Err(BuildError::Cancelled(_))
    ));
}

#[test]
fn the_account_is_asked_for_every_patch_and_every_edge() {
    let mesh = Shape::CubeSplit.build();
    let (before, none) = (topology(&mesh), Budget::new(0, 0));
    let refused = with_crease_band(&mesh, &before, 0.01, &none, &Progress::new()).err();
    let needed = (PER_PATCH * 12 + size_of::<EdgeCuts>() * 18) as u64;
    assert_eq!(refused, Some(BuildError::Memory(MemoryRefused { needed, allowed: 0 })));
}

#[test]
fn the_second_side_of_a_sheet_has_a_narrower_band() {
    let at = [Vec3::ZERO, Vec3::X * 4.0, Vec3::Y * 3.0];
    let side = |order: [usize; 3], normal: Vec3| order.map(|k| Corner { position: at[k], normal, uv: Vec2::ZERO });
    let mesh = mesh_of([side([0, 1, 2], Vec3::Z), side([0, 2, 1], Vec3::NEG_Z)]);
    // The bounding diagonal has a length of 5. What lies inside is as far from two sides as the band is wide.
    let (made, ..) = banded(&mesh, 0.02);
    let distance = |corner: &Corner| {
        let Vec3 { x, y, .. } = corner.position;
        x.min(y).min((12.0 - 3.0 * x - 4.0 * y) / 5.0)
    };
    let inside: Vec<f32> = made.corners.iter().map(distance).filter(|&distance| distance > 1e-3).collect();
    let wide = |&distance: &f32| (distance - 0.1).abs() < 1e-5;
    let narrow = |&distance: &f32| (distance - 0.1 / 1.125).abs() < 1e-5;
    assert!(inside.iter().any(wide) && inside.iter().any(narrow), "{inside:?}");
    assert!(inside.iter().all(|distance| wide(distance) || narrow(distance)), "{inside:?}");
}

/// Details that are linear in the position stay so in the band, and change nothing else.
#[test]
fn details_of_corners_are_interpolated() {
    let plain = Shape::CubeSplit.build();
    let mut detailed = plain.clone();
    let detail = |position: Vec3| CornerDetail {
        uvs: [position.truncate(), Vec2::splat(position.z)],
        color: position.extend(1.0),
        tangent: Vec3::X,
        bitangent_sign: -1.0,
    };
    detailed.details = Some(Arc::new(plain.corners.iter().map(|corner| detail(corner.position)).collect()));
    let [(plain, ..), (made, ..)] = [&plain, &detailed].map(|mesh| banded(mesh, 0.05));
    assert_eq!(triangles(&plain).collect::<Vec<_>>(), triangles(&made).collect::<Vec<_>>());
    let details = made.details.as_ref().expect("they stay");
    assert_eq!(details.len(), made.corners.len());
    assert!(made.corners.len() > detailed.corners.len());
    for (corner, own) in made.corners.iter().zip(details.iter()) {
        let expected = detail(corner.position);
        assert!(own.uvs[0].distance(expected.uvs[0]) < 1e-5 && own.uvs[1].distance(expected.uvs[1]) < 1e-5, "{own:?}");
        assert!(own.color.distance(expected.color) < 1e-5 && own.tangent.distance(Vec3::X) < 1e-5, "{own:?}");
        assert_eq!(own.bitangent_sign, -1.0);
    }
}
