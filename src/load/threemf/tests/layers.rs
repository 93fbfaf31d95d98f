//! Layers and mixtures of properties, which aren't read: the lowest layer or the first material is shown.

use super::*;

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

const IMAGES: [[[u8; 4]; 2]; 2] = [[[255, 0, 0, 255], [0, 255, 0, 255]]; 2];

/// The only warning of a file with one triangle.
const WARNING: &str = "triangles with layers (multiproperties) or mixtures (compositematerials), shown with the lowest layer or the \
     first material alone: 1.";

#[test]
fn of_layers_the_lowest_is_shown() {
    let mesh = read(&layered("pids=\"1 2 4\" blendmethods=\"multiply mix\"", ["1 0 0", "0 1 1", "0 2 2"], IMAGES));
    let [material] = &mesh.materials[..] else { panic!("{:?}", mesh.materials) };
    // A material is that of the whole triangle.
    assert_eq!((material.name.as_str(), material.base_color), ("ABS", [0.0, 0.0, 1.0, 1.0]));
    assert_eq!(mesh.warnings, [WARNING]);
    // Missing numbers are 0.
    let mesh = read(&layered("pids=\"1 2\"", ["", " ", "0 2"], IMAGES));
    assert_eq!((mesh.materials[0].name.as_str(), &mesh.warnings[..]), ("PLA", &[WARNING.to_owned()][..]));
    let mesh = read(&layered("pids=\"2 4\"", ["0 0", "1 1", "2 2"], IMAGES));
    assert_eq!(colors(&mesh).len(), 3, "{:?}", colors(&mesh));
    assert_eq!((mesh.materials[0].texture.is_some(), &mesh.warnings[..]), (false, &[WARNING.to_owned()][..]));
    let mesh = read(&layered("pids=\"4 2\"", ["0 0", "1 1", "2 2"], IMAGES));
    assert_eq!((mesh.materials[0].texture.is_some(), &mesh.warnings[..]), (true, &[WARNING.to_owned()][..]));
}

#[test]
fn of_mixtures_the_first_material_is_shown() {
    let values = "<m:composite values=\"0.2 0.8\"/>".repeat(3);
    let group =
        format!("<m:compositematerials id=\"9\" matid=\"1\" matindices=\"1 0\">{values}</m:compositematerials>");
    let mesh = read(&with_group(&group, IMAGES));
    assert_eq!((mesh.materials[0].name.as_str(), mesh.materials.len()), ("ABS", 1));
    assert_eq!(mesh.warnings, [WARNING]);
}
