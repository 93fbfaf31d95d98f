//! PLY files as programs write them, in all three encodings.

use std::path::Path;

use header::{Encoding, Scalar};

use super::*;
use crate::face_builder::tests::{POINTS, SIDES, assert_cube};
use geometry::progress::Progress;

fn read(bytes: &[u8]) -> LoadedMesh {
    read_in(Path::new("nowhere"), bytes)
}

fn read_in(folder: &Path, bytes: &[u8]) -> LoadedMesh {
    super::read(bytes.to_vec(), &ModelFile { folder, ..ModelFile::from_test("cube", &Progress::new()) }).unwrap()
}

/// Writes numbers in one of the encodings.
struct Writer {
    encoding: Encoding,
    bytes: Vec<u8>,
}

impl Writer {
    fn put(&mut self, scalar: Scalar, x: f64) {
        let little = match scalar {
            Scalar::I8 => (x as i8).to_le_bytes().to_vec(),
            Scalar::U8 => (x as u8).to_le_bytes().to_vec(),
            Scalar::I16 => (x as i16).to_le_bytes().to_vec(),
            Scalar::U16 => (x as u16).to_le_bytes().to_vec(),
            Scalar::I32 => (x as i32).to_le_bytes().to_vec(),
            Scalar::U32 => (x as u32).to_le_bytes().to_vec(),
            Scalar::F32 => (x as f32).to_le_bytes().to_vec(),
            Scalar::F64 => x.to_le_bytes().to_vec(),
            Scalar::I64 => (x as i64).to_le_bytes().to_vec(),
            Scalar::U64 => (x as u64).to_le_bytes().to_vec(),
        };
        match self.encoding {
            Encoding::Text => self.bytes.extend(format!("{x} ").bytes()),
            Encoding::LittleEndian => self.bytes.extend(little),
            Encoding::BigEndian => self.bytes.extend(little.iter().rev()),
        }
    }

    fn end(&mut self) {
        if self.encoding == Encoding::Text {
            self.bytes.extend(b"\n");
        }
    }
}

const ENCODINGS: [(Encoding, &str); 3] = [
    (Encoding::Text, "ascii"),
    (Encoding::LittleEndian, "binary_little_endian"),
    (Encoding::BigEndian, "binary_big_endian"),
];

const SCALARS: [(Scalar, &str); 10] = [
    (Scalar::I8, "char"),
    (Scalar::U8, "uint8"),
    (Scalar::I16, "short"),
    (Scalar::U16, "uint16"),
    (Scalar::I32, "int"),
    (Scalar::U32, "uint32"),
    (Scalar::F32, "float"),
    (Scalar::F64, "float64"),
    (Scalar::I64, "int64"),
    (Scalar::U64, "ulong"),
];

/// A cube of quads, with other elements and properties that a file may have.
pub(crate) fn cube(encoding: usize, position: usize, index: usize) -> Vec<u8> {
    let ((encoding, format), (position, of_position), (index, of_index)) =
        (ENCODINGS[encoding], SCALARS[position], SCALARS[index]);
    let header = format!(
        "ply\nformat {format} 1.0\ncomment made by a test\nobj_info none\nelement range 1\nproperty list uchar int what\n\
         element vertex 8\nproperty uchar red\nproperty {of_position} x\nproperty {of_position} y\nproperty {of_position} z\n\
         property list uchar short more\nelement nothing 4611686018427387904\nelement face 6\nproperty float quality\n\
         property list {of_index} {of_index} vertex_indices\nend_header\n"
    );
    let mut writer = Writer { encoding, bytes: header.into_bytes() };
    [2.0, 8.0, 9.0].iter().zip([Scalar::U8, Scalar::I32, Scalar::I32]).for_each(|(x, scalar)| writer.put(scalar, *x));
    writer.end();
    for point in POINTS {
        writer.put(Scalar::U8, 255.0);
        point.iter().for_each(|x| writer.put(position, f64::from(*x)));
        [1.0, 5.0].iter().zip([Scalar::U8, Scalar::I16]).for_each(|(x, scalar)| writer.put(scalar, *x));
        writer.end();
    }
    for side in SIDES {
        writer.put(Scalar::F32, 0.5);
        writer.put(index, 4.0);
        side.iter().for_each(|&point| writer.put(index, point as f64));
        writer.end();
    }
    writer.bytes
}

#[test]
fn every_encoding_and_every_type_is_the_same_cube() {
    for encoding in 0..3 {
        for (position, index) in [(0, 0), (2, 1), (4, 2), (6, 3), (7, 4), (6, 5), (8, 9), (0, 8)] {
            let mesh = read(&cube(encoding, position, index));
            assert_cube(&mesh);
            let expected = "vertices without normals, which are smoothed below 60 degrees: 8.";
            assert_eq!(mesh.warnings, [expected]);
        }
    }
}

#[test]
fn text_is_forgiven_its_ends_of_lines() {
    let text = String::from_utf8(cube(0, 6, 4)).unwrap();
    for text in [text.replace('\n', "\r\n"), text.replace('\n', "\r"), text.replace(" \n", "\n\n")] {
        assert_cube(&read(text.as_bytes()));
    }
    let crlf = cube(1, 6, 4);
    let end = crlf.windows(11).position(|window| window == b"end_header\n").unwrap() + 11;
    let header = String::from_utf8_lossy(&crlf[..end]).replace('\n', "\r\n").into_bytes();
    assert_cube(&read(&[&header, &crlf[end..]].concat()));
}

const TRIANGLE: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
     property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\nelement face 1\n\
     property list uchar int vertex_index\nend_header\n0 0 0 0 0 2 0 0\n1 0 0 0 0 2 1 0\n0 1 0 0 0 2 0 1\n3 0 1 2\n";

#[test]
fn normals_and_texture_coordinates_of_every_name_are_read() {
    for (u, v) in [("s", "t"), ("u", "v"), ("texture_u", "texture_v")] {
        let text = TRIANGLE.replace("float s\n", &format!("float {u}\n")).replace("float t\n", &format!("float {v}\n"));
        let mesh = read(text.as_bytes());
        let uvs: Vec<_> = mesh.corners.iter().map(|corner| corner.uv).collect();
        assert_eq!(uvs, [Vec2::Y, Vec2::ONE, Vec2::ZERO], "v upwards in the file");
        assert!(mesh.corners.iter().all(|corner| corner.normal == Vec3::Z));
        assert_eq!(mesh.warnings, ["normals whose length wasn't 1, scaled to it: 3."]);
    }
    // Two coordinates don't make a normal.
    let mesh = read(TRIANGLE.replace("float nz", "float confidence").as_bytes());
    assert_eq!(mesh.repairs.normals_made, 3);
}

#[test]
fn faces_may_come_before_their_vertices() {
    let (head, body) = TRIANGLE.split_once("end_header\n").unwrap();
    let (vertices, face) = head.split_once("element face").unwrap();
    let (format, vertices) = vertices.split_once("element vertex").unwrap();
    let (rows, last) = body.split_at(body.rfind("3 0 1 2").unwrap());
    let text = format!("{format}element face{face}element vertex{vertices}end_header\n{last}{rows}");
    assert_eq!(**read(text.as_bytes()).triangles, [[0, 1, 2]]);
}

/// Six vertices in two rows, and triangle strips of them.
pub(crate) fn strip(indices: &str) -> String {
    let count = indices.split(' ').count();
    format!(
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty int x\nproperty int y\nproperty int z\nelement tristrips 1\n\
         property list int int vertex_indices\nend_header\n0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n2 1 0\n{count} {indices}\n"
    )
}

#[test]
fn strips_alternate_begin_anew_and_are_stitched() {
    let triangles = |indices: &str| {
        let mesh = read(strip(indices).as_bytes());
        let vertex = |corner: u32| {
            let place = mesh.corners[corner as usize].position;
            (2.0 * place.x + place.y) as u32
        };
        mesh.triangles.iter().map(|triangle| triangle.map(vertex)).collect::<Vec<_>>()
    };
    assert_eq!(triangles("0 1 2 3 4"), [[0, 1, 2], [2, 1, 3], [2, 3, 4]]);
    assert_eq!(triangles("0 1 2 -1 3 4 5"), [[0, 1, 2], [3, 4, 5]]);
    assert_eq!(triangles("0 1 2 2 3 3 4 5"), [[0, 1, 2], [4, 3, 5]]);
}

#[test]
fn cancelling_stops_the_work() {
    let progress = Progress::new();
    progress.cancel();
    assert!(matches!(super::read(cube(1, 6, 4), &ModelFile::from_test("", &progress)), Err(ReadError::Cancelled(_))));
}

#[test]
fn vertices_may_have_colours_and_faces_texture_coordinates_of_their_own() {
    for (kind, [red, half]) in [("uchar", ["255", "128"]), ("float", ["1", "0.50196"]), ("ushort", ["65535", "32896"])]
    {
        let text = format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             property {kind} red\nproperty {kind} green\nproperty {kind} blue\nelement face 1\n\
             property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n\
             0 0 0 {red} 0 0\n1 0 0 0 {half} 0\n0 1 0 0 0 0\n3 0 1 2 6 0 0 1 0 0 0.25\n"
        );
        let mesh = read(text.as_bytes());
        let colors: Vec<_> = mesh.details.as_ref().expect("it has colours").iter().map(|detail| detail.color).collect();
        assert_eq!((colors[0], colors[2]), (Vec4::new(1.0, 0.0, 0.0, 1.0), Vec4::W), "{kind}");
        assert!((colors[1] - Vec4::new(0.0, 0.2159, 0.0, 1.0)).abs().max_element() < 1e-3, "{kind}");
        let uvs: Vec<_> = mesh.corners.iter().map(|corner| corner.uv).collect();
        assert_eq!(uvs, [Vec2::Y, Vec2::ONE, Vec2::new(0.0, 0.75)]);
    }
}

/// The colours of a mesh, without repetitions.
fn colors(mesh: &LoadedMesh) -> Vec<[f32; 4]> {
    let details = mesh.details.as_ref();
    let mut found: Vec<_> =
        details.map_or(Vec::new(), |all| all.iter().map(|detail| detail.color.to_array()).collect());
    found.sort_unstable_by(|a, b| a.partial_cmp(b).expect("numbers"));
    found.dedup();
    found
}

/// Two triangles of a square, with an element for each row.
fn square(header: &str, vertices: [&str; 4], faces: [&str; 2]) -> String {
    let at = ["0 0 0", "1 0 0", "1 1 0", "0 1 0"];
    let vertices: String = at.iter().zip(vertices).map(|(at, own)| format!("{at} {own}\n")).collect();
    let faces: String = ["3 0 1 2", "3 0 2 3"].iter().zip(faces).map(|(face, own)| format!("{face} {own}\n")).collect();
    let (images, properties) = header.split_once('|').unwrap_or(("", header));
    let (of_vertices, of_faces) = properties.split_once('|').unwrap_or(("", properties));
    format!(
        "ply\nformat ascii 1.0\n{images}element vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
         {of_vertices}element face 2\nproperty list uchar int vertex_indices\n{of_faces}end_header\n{vertices}{faces}"
    )
}

#[test]
fn faces_may_have_colours_where_vertices_have_none() {
    for (kind, [red, green]) in [("uchar", ["255 0 0", "0 255 0"]), ("float", ["1 0 0", "0 1.0 0"])] {
        let of_faces = format!("property {kind} red\nproperty {kind} green\nproperty {kind} blue\n");
        let mesh = read(square(&of_faces, [""; 4], [red, green]).as_bytes());
        assert_eq!((mesh.triangles.len(), mesh.corners.len()), (2, 6));
        assert_eq!(colors(&mesh), [[0.0, 1.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0]], "{kind}");
        let alpha = format!("{of_faces}property {kind} alpha\n");
        let mesh = read(square(&alpha, [""; 4], [&format!("{red} 0"), &format!("{green} 0")]).as_bytes());
        assert_eq!(colors(&mesh), [[0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]], "{kind}");
        let both = format!("|property {kind} red\nproperty {kind} green\nproperty {kind} blue\n|{of_faces}");
        let mesh = read(square(&both, [green; 4], [red; 2]).as_bytes());
        assert_eq!(colors(&mesh), [[0.0, 1.0, 0.0, 1.0]], "those of vertices count");
    }
}

/// A PNG image of one colour.
fn image_of(color: [u8; 3]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::RgbImage::from_pixel(1, 1, image::Rgb(color)).write_to(&mut bytes, image::ImageFormat::Png).expect("a PNG");
    bytes.into_inner()
}

#[test]
fn images_that_comments_name_are_shown() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("red rock.png"), image_of([255, 0, 0])).expect("a file");
    std::fs::write(folder.path().join("b.png"), image_of([0, 0, 255])).expect("a file");
    let wedge = "property list uchar float texcoord\n";
    let uvs = "6 0 0 1 0 1 1";
    let one = format!("comment TextureFile red rock.png\ncomment red\n||{wedge}");
    let mesh = read_in(folder.path(), square(&one, [""; 4], [uvs; 2]).as_bytes());
    let shown: Vec<_> =
        mesh.materials.iter().map(|own| (own.name.as_str(), own.triangles.len(), own.texture.is_some())).collect();
    assert_eq!(shown, [("red rock.png", 2, true)]);
    assert_eq!(mesh.files.len(), 1, "{:?}", mesh.files);
    // Each face has the number of its image, and colours count only where there is none.
    let rgb = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    let two = format!(
        "comment TextureFile C:\\scans\\red rock.png\ncomment TextureFile b.png\n|{rgb}|{wedge}property int texnumber\n"
    );
    let faces = [format!("{uvs} 1"), format!("{uvs} -1")];
    let mesh = read_in(folder.path(), square(&two, ["255 0 0"; 4], [&faces[0], &faces[1]]).as_bytes());
    let mut shown: Vec<_> =
        mesh.materials.iter().map(|own| (own.name.as_str(), own.triangles.len(), own.texture.is_some())).collect();
    shown.retain(|(_, triangles, _)| *triangles > 0);
    shown.sort_unstable();
    assert_eq!(shown, [("b.png", 1, true), ("default", 1, false)]);
    assert_eq!(colors(&mesh), [[1.0, 0.0, 0.0, 1.0], [1.0; 4]]);
    // Texture coordinates of vertices show the first one.
    let of_vertices = "comment TextureFile b.png\n|property float s\nproperty float t\n|";
    let mesh = read_in(folder.path(), square(of_vertices, ["0 0"; 4], [""; 2]).as_bytes());
    assert!(mesh.materials.iter().any(|own| own.texture.is_some()), "{:?}", mesh.materials);
}

#[test]
fn an_image_that_is_missing_costs_a_warning_and_one_without_coordinates_nothing() {
    let missing = "comment TextureFile none.png\n||property list uchar float texcoord\n";
    let mesh = read(square(missing, [""; 4], ["6 0 0 1 0 1 1"; 2]).as_bytes());
    assert_eq!(mesh.triangles.len(), 2);
    assert!(
        mesh.warnings.iter().any(|said| said.starts_with("the texture \"none.png\" is left out: ")),
        "{:?}",
        mesh.warnings
    );
    let mesh = read(square("comment TextureFile none.png\n||", [""; 4], [""; 2]).as_bytes());
    assert_eq!(mesh.warnings.len(), 1, "{:?}", mesh.warnings);
}

/// A file of `triangles` triangles and a few quads, some of whose vertices can't be used as they are: with numbers that the file
/// doesn't have, without a position, or with the coordinates of others.
fn flawed(encoding: usize, triangles: usize) -> Vec<u8> {
    let mut random = fastrand::Rng::with_seed(triangles as u64);
    let (encoding, format) = ENCODINGS[encoding];
    let (vertices, faces) = (triangles / 2 + 3, triangles + triangles / 500);
    let header = format!(
        "ply\nformat {format} 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
         property float u\nproperty float v\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n\
         element face {faces}\nproperty uchar flags\nproperty list uchar int vertex_indices\nproperty short mark\n\
         end_header\n"
    );
    let mut writer = Writer { encoding, bytes: header.into_bytes() };
    for i in 0..vertices {
        let bad = |random: &mut fastrand::Rng, number: f64| if random.u32(..400) == 0 { f64::NAN } else { number };
        let [x, y] = [i % 40, i / 40].map(|at| bad(&mut random, at as f64));
        let z = random.u32(..3).into();
        let [u, v] = [x, y].map(|at| bad(&mut random, at / 64.0));
        [x, y, z, u, v].into_iter().for_each(|number| writer.put(Scalar::F32, number));
        (0..3).for_each(|k| writer.put(Scalar::U8, (i % (7 + k)) as f64));
        writer.end();
    }
    for i in 0..faces {
        let corners = if i % 500 == 499 { 4 } else { 3 };
        writer.put(Scalar::U8, 0.0);
        writer.put(Scalar::U8, f64::from(corners));
        for _ in 0..corners {
            let near = (i / 2 + random.usize(..50)) % vertices;
            let far = if random.u32(..2000) == 0 { vertices } else { near };
            writer.put(Scalar::I32, far as f64);
        }
        writer.put(Scalar::I16, 5.0);
        writer.end();
    }
    writer.bytes
}

#[test]
fn triangles_that_are_read_together_are_those_that_are_read_one_by_one() {
    // Faces of a text are read one by one.
    for triangles in [1, 511, 4096, 4097, 20_000] {
        let [one_by_one, little, big] = [0, 1, 2].map(|encoding| read(&flawed(encoding, triangles)));
        for together in [little, big] {
            assert_eq!(together.mesh.triangles, one_by_one.mesh.triangles, "{triangles}");
            assert_eq!(together.mesh.corners, one_by_one.mesh.corners, "{triangles}");
            let counts = |loaded: &LoadedMesh| -> Vec<String> {
                let before = |warning: &String| warning.split(", the first").next().unwrap_or_default().to_owned();
                loaded.warnings.iter().map(before).collect()
            };
            assert_eq!(counts(&together), counts(&one_by_one), "but for the place of the first");
        }
    }
}
