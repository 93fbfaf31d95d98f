//! Single faces, and the cube that every format can describe.

use super::*;
use geometry::mesh::Mesh;
use geometry::mesh::shapes::Shape;
use geometry::mesh::topology::Topology;

/// The corners of a cube.
pub(crate) const POINTS: [[i8; 3]; 8] =
    [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]];

/// The sides of the cube, counter-clockwise seen from outside.
pub(crate) const SIDES: [[usize; 4]; 6] =
    [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [2, 3, 7, 6], [1, 2, 6, 5], [0, 4, 7, 3]];

/// Returns the triangles of the cube.
pub(crate) fn triangles() -> Vec<[usize; 3]> {
    SIDES.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect()
}

/// Checks that a mesh is the cube and has the topology of the cube that is made in code. Its normals may be from the
/// file or computed.
pub(crate) fn assert_cube(mesh: &Mesh) {
    let topology = |mesh: &Mesh| Topology::build(mesh, &Progress::new()).unwrap();
    let (expected, found) = (topology(&Shape::CubeSplit.build()), topology(mesh));
    assert_eq!((found.patches.len(), found.points.len(), found.degenerate), (12, 8, 0));
    assert_eq!(found.edge_counts(), expected.edge_counts());
    assert_eq!((mesh.bounds().min, mesh.bounds().max), (Vec3::NEG_ONE, Vec3::ONE));
    for &[a, b, c] in mesh.triangles.iter() {
        let [a, b, c] = [a, b, c].map(|corner| mesh.corners[corner as usize]);
        let face = (b.position - a.position).cross(c.position - a.position).normalize();
        assert!(face.dot(a.position) > 0.0, "wound inward");
        assert!([a, b, c].iter().all(|corner| corner.normal.distance(face) < 1e-6));
    }
}

fn corners(places: &[[f32; 2]]) -> Vec<NumberedCorner> {
    let corner = |&[x, y]: &[f32; 2]| InputCorner { position: Vec3::new(x, y, 0.0), normal: None, uv: Vec2::ZERO };
    places.iter().map(|place| NumberedCorner { corner: corner(place), number: 0, vertex: None }).collect()
}

fn added(places: &[&[[f32; 2]]]) -> Result<LoadedMesh, ReadError> {
    let (budget, progress) = (Budget::unlimited(), Progress::new());
    let mut faces = FaceBuilder::new(&ModelFile::from_test("faces", &progress), &budget);
    let material = faces.material(Material::plain("default", [1.0; 4]))?;
    for places in places {
        faces.add(material, &mut corners(places), FilePosition::Line(7))?;
    }
    faces.notes.push("said first.".to_owned());
    faces.finish("faces", "nothing".to_owned(), &progress)
}

#[test]
fn corners_on_one_place_are_left_out_of_polygons_and_kept_in_triangles() {
    let [a, b, c, d] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mesh = added(&[&[a, a, b, c, c, d, a], &[a, a, b]]).unwrap();
    assert_eq!(mesh.triangles.len(), 3);
    assert_eq!(
        mesh.warnings,
        ["said first.", "corners of polygons at the position of the corner before, left out: 3."]
    );
}

#[test]
fn vertices_at_one_place_are_points_of_a_cage_that_has_vertices() {
    let (budget, progress) = (Budget::unlimited(), Progress::new());
    let [a, b, c, d, e] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [2.0, 0.0], [2.0, 1.0]];
    for (by_vertex, quads) in [(true, 8), (false, 7)] {
        let mut faces = FaceBuilder::new(&ModelFile::from_test("faces", &progress), &budget);
        let material = faces.material(Material::plain("default", [1.0; 4])).unwrap();
        let cage = CageFaces::new(crate::import::Subdivision { levels: 1, ..Default::default() });
        faces.cage = Some(if by_vertex { cage.of_vertices(false) } else { cage });
        // The first face has the vertices 1 and 5 at one place, and shares the edge from 5 to 2 with the second one.
        for (places, vertices) in [([a, b, b, c], [0, 1, 5, 2]), ([b, d, e, c], [5, 3, 4, 2])] {
            let mut own = corners(&places);
            own.iter_mut().zip(vertices).for_each(|(at, vertex)| at.vertex = Some([vertex, 0, 0]));
            faces.add(material, &mut own, FilePosition::Everywhere).unwrap();
        }
        assert_eq!(faces.found.repeated, usize::from(!by_vertex));
        let mesh = faces.finish("faces", String::new(), &progress).unwrap();
        assert_eq!((mesh.triangles.len(), mesh.is_refined), (2 * quads, true), "{:?}", mesh.warnings);
    }
}

#[test]
fn faces_with_fewer_than_three_corners_are_left_out() {
    let [a, b, c] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]];
    let mesh = added(&[&[], &[a], &[a, b], &[a, b, b, a], &[a, b, c]]).unwrap();
    assert_eq!(mesh.triangles.len(), 1);
    assert!(mesh.warnings.contains(&"faces of fewer than 3 corners, left out: 4.".to_owned()));
    let message = added(&[&[a, b]]).unwrap_err().to_string();
    assert_eq!(message, "no triangles: nothing, and 1 faces of fewer than 3 corners");
}

#[test]
fn faces_at_impossible_positions_are_left_out() {
    let whole: &[[f32; 2]] = &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let unfit = "1 faces with a position that isn't a number or lies beyond 1e37, the first at line 7";
    for x in [f32::NAN, f32::NEG_INFINITY, -1.1e37] {
        let wrong: &[[f32; 2]] = &[[0.0, 0.0], [x, 0.0], [0.0, 1.0]];
        let mesh = added(&[whole, wrong]).unwrap();
        assert_eq!((mesh.triangles.len(), mesh.warnings[1].as_str()), (1, &*format!("{unfit}; they are left out.")));
        assert_eq!(added(&[wrong]).unwrap_err().to_string(), format!("no triangles: nothing, and {unfit}"));
    }
}

#[test]
fn corners_keep_their_colours() {
    let (budget, progress) = (Budget::unlimited(), Progress::new());
    let mut faces = FaceBuilder::new(&ModelFile::from_test("faces", &progress), &budget);
    let material = faces.material(Material::plain("default", [1.0; 4])).unwrap();
    faces.color().expect("memory");
    let square = corners(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    let colors = [[255, 0, 0, 255], [0, 188, 0, 128], [0, 0, 0, 255], [255, 255, 255, 255]].map(linear_color);
    // The same corners in other colours are other corners.
    for colors in [colors, [Vec4::ONE; 4]] {
        let numbers = colors.map(|color| faces.number(color).unwrap());
        let numbered = square.iter().zip(numbers).map(|(&at, number)| NumberedCorner { number, ..at });
        faces.add(material, &mut numbered.collect(), FilePosition::Everywhere).unwrap();
    }
    let mesh = faces.finish("faces", String::new(), &progress).unwrap();
    let details = mesh.details.as_ref().expect("it has colours");
    assert_eq!((mesh.corners.len(), details.len()), (7, 7), "the white corner is shared");
    for (corner, detail) in mesh.corners.iter().zip(details.iter()).take(4) {
        let at = square.iter().position(|at| at.corner.position == corner.position).unwrap();
        assert_eq!(detail.color, colors[at]);
    }
    assert!((colors[1].y - 0.503).abs() < 0.001, "sRGB is decoded: {}", colors[1].y);
}
