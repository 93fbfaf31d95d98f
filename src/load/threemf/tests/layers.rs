//! Layers and mixtures of properties.

use super::*;
use geometry::mesh::mipmap::encoded;
use glam::{Vec2, Vec4, vec4};

/// Materials, colours, and two textures of two texels: `/a.png`, and `/b.png` with the same coordinates and others.
const RESOURCES: &str = "<basematerials id=\"1\"><base name=\"PLA\" displaycolor=\"#FF0000\"/><base name=\"ABS\" \
     displaycolor=\"#0000FF\"/></basematerials><m:colorgroup id=\"2\"><m:color color=\"#00FF0080\"/>\
     <m:color color=\"#0000FF80\"/><m:color color=\"#FFFFFF00\"/></m:colorgroup>\
     <m:texture2d id=\"3\" path=\"/a.png\"/><m:texture2dgroup id=\"4\" texid=\"3\"><m:tex2coord u=\"0\" v=\"0\"/>\
     <m:tex2coord u=\"1\" v=\"0\"/><m:tex2coord u=\"0\" v=\"1\"/></m:texture2dgroup>\
     <m:texture2d id=\"5\" path=\"/b.png\"/><m:texture2dgroup id=\"6\" texid=\"5\"><m:tex2coord u=\"0\" v=\"0\"/>\
     <m:tex2coord u=\"1\" v=\"0\"/><m:tex2coord u=\"0\" v=\"1\"/><m:tex2coord u=\"7\" v=\"7\"/></m:texture2dgroup>\
     <m:colorgroup id=\"7\"><m:color color=\"#800000\"/></m:colorgroup>";

/// A file with a triangle whose corners have the entries 0, 1 and 2 of these layers, and these two images.
fn layered(attributes: &str, entries: [&str; 3], images: [[[u8; 4]; 2]; 2]) -> Vec<u8> {
    let entries = entries.map(|entry| format!("<m:multi pindices=\"{entry}\"/>")).concat();
    with_group(&format!("<m:multiproperties id=\"9\" {attributes}>{entries}</m:multiproperties>"), images)
}

/// A file with a triangle whose corners have the entries 0, 1 and 2 of group 9, which is these resources.
fn with_group(group: &str, images: [[[u8; 4]; 2]; 2]) -> Vec<u8> {
    let triangle = mesh([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[0, 1, 2]]);
    let triangle = triangle.replace("v3=\"2\"", "v3=\"2\" pid=\"9\" p1=\"0\" p2=\"1\" p3=\"2\"");
    let model = model(&format!("{RESOURCES}{group}<object id=\"10\">{triangle}</object>"), "<item objectid=\"10\"/>");
    zip(&[
        Entry::stored("_rels/.rels", relationships().as_bytes()),
        Entry::stored(MODEL, model.as_bytes()),
        Entry::stored("a.png", &png(images[0])),
        Entry::stored("b.png", &png(images[1])),
    ])
}

const OPAQUE: [[u8; 4]; 2] = [[255, 0, 0, 255], [0, 255, 0, 255]];
const CLEAR: [[u8; 4]; 2] = [[255, 255, 255, 0], [0, 255, 0, 128]];

/// The colours of the corners, in the order of their positions: linear RGBA.
fn corners(mesh: &LoadedMesh) -> [Vec4; 3] {
    let details = mesh.details.as_ref().expect("colours");
    let mut found: Vec<_> =
        mesh.corners.iter().enumerate().map(|(i, corner)| (corner.position.to_array(), details[i].color)).collect();
    // The first vertex, the second one to its right, and the third one behind.
    found.sort_by(|a, b| (-a.0[2], a.0[0]).partial_cmp(&(-b.0[2], b.0[0])).expect("numbers"));
    found.into_iter().map(|(_, color)| color).collect::<Vec<_>>().try_into().expect("three corners")
}

fn texels(mesh: &LoadedMesh) -> Vec<u8> {
    mesh.materials[0].texture.as_ref().expect("an image").rgba.clone()
}

fn assert_near(found: [Vec4; 3], expected: [Vec4; 3]) {
    let is_near = |(a, b): (Vec4, Vec4)| a.distance(b) < 1e-5;
    assert!(found.into_iter().zip(expected).all(is_near), "{found:?} instead of {expected:?}");
}

#[test]
fn colours_over_a_material_are_blended_at_each_corner() {
    let half = 128.0 / 255.0;
    let mesh = read(&layered("pids=\"1 2\"", ["0 0", "0 1", "1 2"], [OPAQUE; 2]));
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    // A material is that of the whole triangle.
    let expected = [vec4(1.0 - half, half, 0.0, 1.0), vec4(1.0 - half, 0.0, half, 1.0), vec4(1.0, 0.0, 0.0, 1.0)];
    assert_near(corners(&mesh), expected);
    assert_eq!((mesh.materials.len(), mesh.materials[0].look.alpha), (1, Alpha::Opaque));
    // Missing numbers are 0, those that are too many don't count, and without a method layers mix.
    let same = read(&layered("pids=\"1 2\" blendmethods=\"mix\"", ["", "0 1 5", "0 2"], [OPAQUE; 2]));
    assert!(same.warnings.is_empty(), "{:?}", same.warnings);
    assert_near(corners(&same), expected);
    let multiplied = read(&layered("pids=\"7 2\" blendmethods=\"multiply\"", ["0 0", "0 0", "0 2"], [OPAQUE; 2]));
    let dark = linear_color([128, 0, 0, 255]);
    assert_near(corners(&multiplied), [vec4(0.0, 0.0, 0.0, 1.0), vec4(0.0, 0.0, 0.0, 1.0), dark]);
}

#[test]
fn a_material_alone_keeps_its_name() {
    let mesh = read(&layered("pids=\"1\"", ["1", "0", "0"], [OPAQUE; 2]));
    assert_eq!((mesh.materials[0].name.as_str(), mesh.materials[0].base_color), ("ABS", [0.0, 0.0, 1.0, 1.0]));
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
}

#[test]
fn colours_multiply_a_texture_at_each_corner() {
    for (pids, entries) in [("2 4", ["0 0", "1 1", "2 2"]), ("4 2", ["0 0", "1 1", "2 2"])] {
        let attributes = format!("pids=\"{pids}\" blendmethods=\"multiply\"");
        let mesh = read(&layered(&attributes, entries, [CLEAR, OPAQUE]));
        assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
        assert_near(corners(&mesh), [vec4(0.0, 1.0, 0.0, 1.0), vec4(0.0, 0.0, 1.0, 1.0), Vec4::ONE]);
        // Without a material below, layers are opaque.
        assert_eq!((mesh.materials[0].name.as_str(), mesh.materials[0].look.alpha), ("a.png", Alpha::Opaque));
        assert_eq!(texels(&mesh), CLEAR.as_flattened());
    }
}

#[test]
fn a_texture_that_hides_the_layers_below_is_shown_as_it_is() {
    let mesh = read(&layered("pids=\"1 2 4\"", ["0 0 0", "0 1 1", "0 2 2"], [OPAQUE; 2]));
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    assert_eq!((mesh.materials[0].name.as_str(), texels(&mesh)), ("a.png", OPAQUE.as_flattened().to_vec()));
    assert_near(corners(&mesh), [Vec4::ONE; 3]);
    assert!(mesh.corners.iter().any(|corner| corner.uv == Vec2::new(1.0, 1.0)), "{:?}", mesh.corners);
}

#[test]
fn a_translucent_texture_shows_the_material_below() {
    let mesh = read(&layered("pids=\"1 4\"", ["0 0", "0 1", "0 2"], [CLEAR, OPAQUE]));
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    let half = 128.0 / 255.0;
    let blended = encoded(vec4(1.0 - half, half, 0.0, 1.0).truncate()).to_array().map(|channel| channel as u8);
    assert_eq!(texels(&mesh), [&[255, 0, 0, 255][..], &blended, &[255]].concat());
    assert_eq!((mesh.materials[0].name.as_str(), mesh.materials[0].look.alpha), ("a.png, layered", Alpha::Opaque));
    // Two triangles with the same layers share an image.
    let both = layered("pids=\"1 4\"", ["0 0", "0 1", "0 2"], [CLEAR, OPAQUE]);
    assert_eq!(read(&both).materials.len(), 1);
}

#[test]
fn textures_with_the_same_coordinates_are_blended_and_others_by_their_mean() {
    let mesh = read(&layered("pids=\"6 4\"", ["0 0", "1 1", "2 2"], [CLEAR, OPAQUE]));
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    // The first texel shows the one below, and both are green in the second.
    assert_eq!(texels(&mesh), OPAQUE.as_flattened());
    let mesh = read(&layered("pids=\"6 4\"", ["3 0", "1 1", "2 2"], [CLEAR, OPAQUE]));
    // The mean of red and green.
    let mean = encoded(vec4(0.5, 0.5, 0.0, 1.0).truncate()).to_array().map(|channel| channel as u8);
    assert_eq!(texels(&mesh)[..3], mean);
    assert_eq!(
        mesh.warnings,
        [
            "triangles with several textures at different texture coordinates, shown with the mean colours of all but the uppermost: 1."
        ]
    );
}

#[test]
fn a_colour_below_a_translucent_texture_counts_with_its_mean() {
    let mesh = read(&layered("pids=\"2 4\"", ["0 0", "1 1", "2 2"], [CLEAR, OPAQUE]));
    // Green, blue and white.
    let mean = encoded(glam::Vec3::new(1.0, 2.0, 2.0) / 3.0).to_array().map(|channel| channel as u8);
    assert_eq!(texels(&mesh)[..3], mean);
    assert_eq!(mesh.warnings.len(), 1);
    assert!(mesh.warnings[0].starts_with("triangles with a colour above or below a texture"), "{:?}", mesh.warnings);
}

#[test]
fn mixtures_have_the_mean_of_their_materials() {
    let group = |values: [&str; 3]| {
        let values = values.map(|values| format!("<m:composite values=\"{values}\"/>")).concat();
        format!("<m:compositematerials id=\"9\" matid=\"1\" matindices=\"0 1\">{values}</m:compositematerials>")
    };
    let mesh = read(&with_group(&group(["3 1", "0 0", "0.5"]), [OPAQUE; 2]));
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    let expected = [vec4(0.75, 0.0, 0.25, 1.0), vec4(0.5, 0.0, 0.5, 1.0), vec4(1.0, 0.0, 0.0, 1.0)];
    assert_near(corners(&mesh), expected);
    // Large shares, and more of them than materials.
    let mesh = read(&with_group(&group(["3e38 3e38", "1 1 9 9", "1e-30 0"]), [OPAQUE; 2]));
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    assert_near(corners(&mesh), [expected[1], expected[1], expected[2]]);
    let mesh = read(&with_group(&group(["1 1", "-2 1", "x"]), [OPAQUE; 2]));
    assert_near(corners(&mesh), [expected[1], vec4(0.0, 0.0, 1.0, 1.0), expected[1]]);
    assert_eq!(mesh.warnings, ["shares of materials in mixtures that aren't numbers from 0 on, replaced by 0: 2."]);
}

/// Each triangle has another colour below the texture.
pub(crate) fn many_layers(count: usize) -> Vec<u8> {
    let colors: String = (0..count).map(|i| format!("<m:color color=\"#{i:06X}\"/>")).collect();
    let entries: String = (0..count).map(|i| format!("<m:multi pindices=\"{i} 0\"/>")).collect();
    let triangles: String =
        (0..count).map(|i| format!("<triangle v1=\"0\" v2=\"1\" v3=\"2\" pid=\"9\" p1=\"{i}\"/>")).collect();
    let whole = mesh([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], []);
    let whole = whole.replace("<triangles>", &format!("<triangles>{triangles}"));
    let resources = format!(
        "{RESOURCES}<m:colorgroup id=\"8\">{colors}</m:colorgroup><m:multiproperties id=\"9\" pids=\"8 4\">{entries}\
         </m:multiproperties><object id=\"10\">{whole}</object>"
    );
    zip(&[
        Entry::stored("_rels/.rels", relationships().as_bytes()),
        Entry::stored(MODEL, model(&resources, "<item objectid=\"10\"/>").as_bytes()),
        Entry::stored("a.png", &png(CLEAR)),
    ])
}

#[test]
fn only_so_many_images_are_made_of_layers() {
    let mesh = read(&many_layers(70));
    assert_eq!((mesh.triangles.len(), mesh.materials.len()), (70, 65));
    assert_eq!(
        mesh.warnings,
        ["triangles whose layers would need more than 64 images, shown with the uppermost texture alone: 6."]
    );
}
