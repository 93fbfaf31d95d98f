//! 3MF files as slicers and modelling programs write them.

pub(crate) mod layers;

use glam::Vec3;

use super::*;
use crate::face_builder::linear_color;
use crate::face_builder::tests::{POINTS, assert_cube, triangles};
use documents::package::{self, Entry, MODEL, mesh, model, relationships, zip};
use geometry::mesh::{Alpha, Sampling, Wrap};
use geometry::progress::Progress;

fn read(bytes: &[u8]) -> LoadedMesh {
    super::read(bytes.to_vec(), &ModelFile::from_test("cube", &Progress::new())).unwrap()
}

/// The mesh of a cube.
fn cube_mesh() -> String {
    mesh(POINTS.map(|point| point.map(f32::from)), triangles())
}

/// A file with one object.
fn of_object(object: &str, build: &str) -> Vec<u8> {
    package::package(&model(&format!("<object id=\"1\" {object}</object>"), build))
}

pub(crate) fn cube() -> Vec<u8> {
    of_object(&format!("type=\"model\">{}", cube_mesh()), "<item objectid=\"1\"/>")
}

/// The resources of [`everything`]: a painted cube, and an assembly of two of them.
fn painted() -> String {
    let painted = cube_mesh().replacen("v3=\"2\"/>", "v3=\"2\" pid=\"5\" p1=\"0\" p2=\"1\" p3=\"2\"/>", 1).replacen(
        "v3=\"1\"/>",
        "v3=\"1\" p1=\"1\"/>",
        1,
    );
    format!(
        "<basematerials id=\"4\"><base name=\"PLA\" displaycolor=\"#FF0000\"/><base name=\"Glass\" displaycolor=\"#0000FF80\"/>\
         </basematerials><m:colorgroup id=\"5\"><m:color color=\"#800000\"/><m:color color=\"#008000\"/>\
         <m:color color=\"#000080FF\"/></m:colorgroup><object id=\"1\" pid=\"4\" pindex=\"0\">{painted}</object>\
         <object id=\"2\"><components><component objectid=\"1\"/>\
         <component objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 8 0 0\"/></components></object>"
    )
}

/// A PNG image of two texels side by side, in these colours.
pub(crate) fn png(colors: [[u8; 4]; 2]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = image::RgbaImage::from_fn(2, 1, |x, _| image::Rgba(colors[x as usize]));
    image.write_to(&mut bytes, image::ImageFormat::Png).expect("an image in memory");
    bytes.into_inner()
}

/// A file with a triangle of a texture, whose element `texture2d` has these attributes, and an image.
pub(crate) fn textured(attributes: &str, image: Entry) -> Vec<u8> {
    let triangle = mesh([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[0, 1, 2]]);
    let triangle = triangle.replace("v3=\"2\"", "v3=\"2\" pid=\"4\" p1=\"0\" p2=\"1\" p3=\"2\"");
    let resources = format!(
        "<m:texture2d id=\"3\" {attributes}/><m:texture2dgroup id=\"4\" texid=\"3\"><m:tex2coord u=\"0.25\" v=\"0\"/>\
         <m:tex2coord u=\"1.5\" v=\"0.25\"/><m:tex2coord u=\"0\" v=\"1\"/></m:texture2dgroup><object id=\"1\">{triangle}</object>"
    );
    zip(&[
        Entry::stored("_rels/.rels", relationships().as_bytes()),
        Entry::stored(MODEL, model(&resources, "<item objectid=\"1\"/>").as_bytes()),
        image,
    ])
}

/// The same with an opaque image.
pub(crate) fn with_texture() -> Vec<u8> {
    let image = png([[255, 0, 0, 255], [0, 0, 255, 255]]);
    textured("path=\"/3D/Textures/a.png\" contenttype=\"image/png\"", Entry::deflated("3D/Textures/a.png", &image))
}

/// A file with a part beside the model, materials, colours, components, a mirrored one, and what isn't read.
pub(crate) fn everything() -> Vec<u8> {
    let beside = model(&painted(), "");
    let own =
        "<object id=\"7\"><components><component p:path=\"/3D/Objects/a.model\" objectid=\"2\"/></components></object>";
    let root = model(own, "<item objectid=\"7\" transform=\"1 0 0 0 1 0 0 0 1 0 0 10\"/>");
    zip(&[
        Entry::stored("[Content_Types].xml", b"<Types/>"),
        Entry::stored("_rels/.rels", relationships().as_bytes()),
        Entry::stored(MODEL, root.as_bytes()),
        Entry::deflated("3D/Objects/a.model", beside.as_bytes()),
    ])
}

fn colors(mesh: &LoadedMesh) -> Vec<[f32; 4]> {
    let details = mesh.details.as_ref();
    let mut colors: Vec<_> =
        details.map_or(Vec::new(), |details| (0..details.len()).map(|i| details[i].color.to_array()).collect());
    colors.sort_unstable_by(|a, b| b.partial_cmp(a).expect("numbers"));
    colors.dedup();
    colors
}

#[test]
fn a_cube_gets_normals_and_no_warnings() {
    let deflated = zip(&[
        Entry::deflated("_rels/.rels", relationships().as_bytes()),
        Entry::deflated(
            MODEL,
            model(&format!("<object id=\"1\">{}</object>", cube_mesh()), "<item objectid=\"1\"/>").as_bytes(),
        ),
    ]);
    for bytes in [cube(), deflated] {
        let mesh = read(&bytes);
        assert_cube(&mesh);
        assert_eq!((mesh.name.as_str(), mesh.repairs.normals_made), ("cube", 36));
        assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
        assert_eq!((mesh.materials.len(), mesh.file_bytes), (1, bytes.len() as u64));
    }
}

#[test]
fn y_points_up_and_lengths_are_in_metres() {
    let triangle = mesh([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [0.0, 20.0, 30.0]], [[0, 1, 2]]);
    let text = model(&format!("<object id=\"1\">{triangle}</object>"), "<item objectid=\"1\"/>");
    let units = [
        ("", 0.001),
        ("unit=\"millimeter\"", 0.001),
        ("unit=\"micron\"", 1e-6),
        ("unit=\"centimeter\"", 0.01),
        ("unit=\"inch\"", 0.0254),
        ("unit=\"foot\"", 0.3048),
        ("unit=\"meter\"", 1.0),
    ];
    for (unit, metres) in units {
        let mesh = read(&package::package(&text.replace("unit=\"meter\"", unit)));
        let bounds = mesh.bounds();
        assert!(bounds.max.distance(metres * Vec3::new(10.0, 30.0, 0.0)) <= 1e-5 * metres, "{unit}: {bounds:?}");
        assert!(bounds.min.distance(metres * Vec3::new(0.0, 0.0, -20.0)) <= 1e-5 * metres, "{unit}: {bounds:?}");
    }
    let mesh = read(&package::package(&text.replace("unit=\"meter\"", "unit=\"mile\"")));
    assert_eq!(mesh.warnings, ["The unit \"mile\" isn't one of 3MF, so lengths count as millimetres."]);
}

#[test]
fn components_are_placed_and_mirrored_ones_wound_outward() {
    let mesh = read(&everything());
    assert_eq!(mesh.triangles.len(), 24);
    // Eight to the right of the other one, both ten up.
    assert_eq!((mesh.bounds().min, mesh.bounds().max), (Vec3::new(-1.0, 9.0, -1.0), Vec3::new(9.0, 11.0, 1.0)));
    for triangle in mesh.triangles.iter() {
        let [a, b, c] = triangle.map(|corner| mesh.corners[corner as usize].position);
        let middle = Vec3::new(if a.x > 4.0 { 8.0 } else { 0.0 }, 10.0, 0.0);
        assert!((b - a).cross(c - a).dot(a - middle) > 0.0, "wound inward");
    }
}

#[test]
fn materials_and_colours_are_those_of_triangles_or_else_of_the_object() {
    let mesh = read(&everything());
    let materials: Vec<_> = mesh
        .materials
        .iter()
        .map(|material| (material.name.as_str(), material.triangles.len(), material.look.alpha))
        .collect();
    // Two cubes with one triangle of colours and one of glass each.
    let expected = [("PLA", 20, Alpha::Opaque), ("default", 2, Alpha::Opaque), ("Glass", 2, Alpha::Blend)];
    let mut found = materials.clone();
    found.sort_unstable_by_key(|(name, ..)| expected.iter().position(|(other, ..)| other == name));
    assert_eq!(found, expected, "{materials:?}");
    let of = |name: &str| mesh.materials.iter().find(|material| material.name == name).expect("a material").base_color;
    assert_eq!([of("PLA"), of("default")], [[1.0, 0.0, 0.0, 1.0], [1.0; 4]]);
    assert_eq!(of("Glass"), [0.0, 0.0, 1.0, 128.0 / 255.0]);
    let half = linear_color([128, 0, 0, 255]).x;
    assert_eq!(colors(&mesh), [[1.0; 4], [half, 0.0, 0.0, 1.0], [0.0, half, 0.0, 1.0], [0.0, 0.0, half, 1.0]]);
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
}

#[test]
fn textures_have_coordinates_from_the_bottom_and_are_sampled_as_they_say() {
    let mesh = read(&with_texture());
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    let [material] = &mesh.materials[..] else { panic!("{:?}", mesh.materials) };
    let texture = material.texture.as_ref().expect("a texture");
    assert_eq!((texture.size, &texture.rgba[..]), ([2, 1], &[255, 0, 0, 255, 0, 0, 255, 255][..]));
    assert_eq!((material.name.as_str(), material.base_color, material.look.alpha), ("a.png", [1.0; 4], Alpha::Opaque));
    assert_eq!(material.sampling, Sampling::default());
    let mut uvs: Vec<_> = mesh.corners.iter().map(|corner| (corner.position, corner.uv.to_array())).collect();
    uvs.sort_by(|a, b| a.0.to_array().partial_cmp(&b.0.to_array()).expect("numbers"));
    // The second vertex of the file is that on the x axis, and the third one lies behind.
    assert_eq!(uvs.iter().map(|(_, uv)| *uv).collect::<Vec<_>>(), [[0.0, 0.0], [0.25, 1.0], [1.5, 0.75]]);
    let clear = || Entry::stored("a.png", &png([[255; 4], [9, 9, 9, 128]]));
    let mesh = read(&textured("path=\"a.png\" tilestyleu=\"mirror\" tilestylev=\"none\" filter=\"nearest\"", clear()));
    let material = &mesh.materials[0];
    let wrap = [Wrap::Mirror, Wrap::Clamp];
    let expected = Sampling { wrap, magnify_linear: false, minify_linear: false, mip_linear: None };
    assert_eq!((material.sampling, material.look.alpha), (expected, Alpha::Blend));
    assert!(mesh.warnings.is_empty(), "v stays within the image: {:?}", mesh.warnings);
    let mesh = read(&textured("path=\"/A.PNG\" tilestyleu=\"none\"", clear()));
    assert!(mesh.materials[0].texture.is_some(), "names have any case");
    let expected = "triangles that go on where their texture ends (tile style none), which show its border there: 1.";
    assert_eq!(mesh.warnings.len(), 1);
    assert!(mesh.warnings[0].to_lowercase().ends_with(expected), "{:?}", mesh.warnings);
}

/// Two textures of one image share it, and have the sampling of their own.
#[test]
fn an_image_is_decoded_once() {
    let triangle = |group: u32| {
        let mesh = mesh([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[0, 1, 2]]);
        format!("<object id=\"{}\" pid=\"{group}\" pindex=\"0\">{mesh}</object>", group + 10)
    };
    let texture = |id: u32, style: &str| {
        format!(
            "<m:texture2d id=\"{id}\" path=\"/a.png\" tilestyleu=\"{style}\"/><m:texture2dgroup id=\"{}\" texid=\"{id}\">\
             <m:tex2coord u=\"0.5\" v=\"0.5\"/></m:texture2dgroup>",
            id + 2
        )
    };
    let resources = [texture(1, "wrap"), texture(2, "clamp"), triangle(3), triangle(4)].concat();
    let model = model(&resources, "<item objectid=\"13\"/><item objectid=\"14\"/>");
    let mesh = read(&zip(&[
        Entry::stored("_rels/.rels", relationships().as_bytes()),
        Entry::stored(MODEL, model.as_bytes()),
        Entry::stored("a.png", &png([[1; 4], [2; 4]])),
    ]));
    let [a, b] = &mesh.materials[..] else { panic!("{:?}", mesh.materials) };
    let [one, other] = [a, b].map(|material| material.texture.clone().expect("a texture"));
    assert!(std::sync::Arc::ptr_eq(&one, &other));
    assert_ne!(a.sampling.wrap, b.sampling.wrap);
}

#[test]
fn a_library_shows_its_objects_but_not_their_parts_alone() {
    let mesh = read(&package::package(&model(&painted(), "")));
    assert_eq!(mesh.triangles.len(), 24);
    assert_eq!(mesh.warnings, ["The build has no items, so all objects are shown."]);
}

#[test]
fn prefixes_of_namespaces_are_free() {
    let text = model(&format!("<object id=\"1\">{}</object>", cube_mesh()), "<item objectid=\"1\"/>");
    let mut own = String::new();
    for (i, part) in text.split('<').enumerate() {
        match part.chars().next() {
            Some('?') => own += &format!("<{part}"),
            Some('/') => own += &format!("</c:{}", &part[1..]),
            Some(_) if i > 0 => own += &format!("<c:{part}"),
            _ => {}
        }
    }
    let own = own.replace("xmlns=", "xmlns:c=");
    assert_cube(&read(&package::package(&format!("\u{feff}{own}"))));
}

#[test]
fn the_directory_may_be_one_for_large_archives_and_offsets_may_be_off() {
    let plain = cube();
    let end = plain.len() - 22;
    let [length, start] = [12, 16].map(|at| {
        let number: [u8; 4] = plain[end + at..end + at + 4].try_into().expect("4 bytes");
        u64::from(u32::from_le_bytes(number))
    });
    // What APPNOTE.TXT 4.3.14 to 4.3.16 ask for: the large record, where it is, and a small one without numbers.
    let mut large = plain[..end].to_vec();
    large.extend([&b"PK\x06\x06"[..], &44_u64.to_le_bytes(), &[45, 0, 45, 0], &[0; 8]].concat());
    large.extend([2, 2, length, start].into_iter().flat_map(u64::to_le_bytes));
    large.extend([&b"PK\x06\x07\0\0\0\0"[..], &(end as u64).to_le_bytes(), &1_u32.to_le_bytes()].concat());
    large.extend([&b"PK\x05\x06\0\0\0\0"[..], &[0xff; 12], &[0; 2]].concat());
    assert_cube(&read(&large));
    let mut commented = plain;
    commented[end + 20..].copy_from_slice(&5_u16.to_le_bytes());
    commented.extend(b"hello");
    assert_cube(&read(&commented));
}

#[test]
fn a_beam_lattice_alone_is_said_with_what_helps() {
    let beams = "<beamlattice minlength=\"1\" radius=\"1\"><beams><beam v1=\"0\" v2=\"1\"/></beams></beamlattice>";
    let vertices = "<vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/></vertices>";
    let object = format!("<object id=\"1\"><mesh>{vertices}{beams}</mesh></object>");
    let file = package::package(&model(&object, "<item objectid=\"1\"/>"));
    let read = super::read(file, &ModelFile::from_test("", &Progress::new()));
    let said = read.expect_err("it has no triangles").to_string();
    assert!(said.contains("1 objects with 0 triangles, 1 beam lattices (export them as meshes)"), "{said}");
}

#[test]
fn cancelling_stops_the_work() {
    let progress = Progress::new();
    progress.cancel();
    assert!(matches!(super::read(cube(), &ModelFile::from_test("", &progress)), Err(ReadError::Cancelled(_))));
}

#[test]
fn objects_with_triangles_are_parts_by_their_names() {
    let object = |id: u32, name: &str| format!("<object id=\"{id}\"{name} type=\"model\">{}</object>", cube_mesh());
    let objects = [object(1, " name=\"lid &amp; rim\""), object(2, ""), object(3, " name=\"lid &amp; rim\"")].concat();
    let build: String = [3, 2, 1].map(|id| format!("<item objectid=\"{id}\"/>")).concat();
    let bytes = package::package(&model(&objects, &build));
    let loaded = read(&bytes);
    let parts: Vec<_> = loaded.contents.parts.iter().map(|part| (part.name.as_str(), part.triangles)).collect();
    assert_eq!(parts, [("lid & rim", 24), ("default", 12)]);
    assert_eq!([0, 12, 24].map(|triangle| loaded.part_of(triangle)), [Some(0), Some(1), Some(0)]);
}

#[test]
fn components_lie_in_the_objects_that_have_them() {
    let object =
        |id: u32, name: &str, content: &str| format!("<object id=\"{id}\"{name} type=\"model\">{content}</object>");
    let component = |id: u32| format!("<components><component objectid=\"{id}\"/></components>");
    let objects = [
        object(1, " name=\"bolt\"", &cube_mesh()),
        object(2, " name=\"hinge\"", &component(1)),
        object(3, "", &component(2)),
        object(4, " name=\"door\"", &component(3)),
    ];
    let build = "<item objectid=\"4\"/><item objectid=\"1\"/>";
    let loaded = read(&package::package(&model(&objects.concat(), build)));
    let parts: Vec<_> = loaded.contents.parts.iter().map(|part| (part.name.as_str(), part.triangles)).collect();
    assert_eq!(parts, [("door/hinge/bolt", 12), ("bolt", 12)]);
}
