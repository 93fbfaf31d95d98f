//! FBX.

use super::Gets::{Refused, Repaired};
use super::{Case, Gets};
use crate::Format::Fbx;
use crate::fbx::tests::documents::{
    Link, curves, document, geometry, image, layer, model, morphed_square, skinned_strip, stack, textured_square,
};
use crate::fbx::tests::tree::{Arrays, Entry, Value, binary, list, object, one, text, zlib_zeros};

const SQUARE: [f64; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];

/// A mesh on a node.
fn square(vertices: &[f64], polygons: &[&[i32]], more: Vec<Entry>) -> Vec<Entry> {
    let objects = vec![geometry(10, vertices, polygons, more), model(20, "square", "Mesh", &[])];
    document(false, 100.0, objects, &[Link(20, 0, ""), Link(10, 20, "")])
}

fn plain() -> Vec<Entry> {
    square(&SQUARE, &[&[0, 1, 2, 3]], Vec::new())
}

fn of_text(entries: &[Entry], gets: Gets) -> Case {
    (Fbx, text(entries).into(), gets)
}

/// A text with a part replaced.
fn replaced(entries: &[Entry], from: &str, to: &str, gets: Gets) -> Case {
    let own = String::from_utf8(text(entries)).expect("a text");
    assert!(own.contains(from), "{from}");
    (Fbx, own.replace(from, to).into_bytes().into(), gets)
}

/// A binary file whose vertices are an array of so many numbers, in this zlib stream.
fn inflated(count: u32, stream: &[u8], gets: Gets) -> Case {
    let array = [&b"d"[..], &count.to_le_bytes(), &1_u32.to_le_bytes(), &(stream.len() as u32).to_le_bytes(), stream];
    let mut entries = plain();
    entries[2].children[0].children[0].values = vec![Value::Raw(array.concat())];
    (Fbx, binary(&entries, Arrays::Plain).into(), gets)
}

/// Nodes of which each is the child of the one before, with a mesh on the last.
fn chain(count: i64) -> Vec<Entry> {
    let mut objects = vec![geometry(10, &SQUARE, &[&[0, 1, 2, 3]], Vec::new())];
    objects.extend((0..count).map(|i| model(1000 + i, "link", "Null", &[])));
    let links: Vec<Link> = (0..count).map(|i| Link(1000 + i, if i == 0 { 0 } else { 999 + i }, "")).collect();
    let last = [Link(10, 999 + count, "")];
    document(false, 100.0, objects, &links.into_iter().chain(last).collect::<Vec<_>>())
}

/// Nodes that share a mesh, whose shape moves so many vertices that it doesn't have.
fn copies(nodes: i64, offsets: i32) -> Vec<Entry> {
    let shape =
        vec![one("Indexes", (4..4 + offsets).collect::<Vec<i32>>()), one("Vertices", vec![0.0; 3 * offsets as usize])];
    let mut objects = vec![
        geometry(10, &SQUARE, &[&[0, 1, 2, 3]], Vec::new()),
        object("Deformer", 40, "Deformer::shapes", "BlendShape", Vec::new()),
        object("Deformer", 41, "SubDeformer::many", "BlendShapeChannel", vec![one("FullWeights", vec![100.0])]),
        object("Geometry", 42, "Geometry::shape", "Shape", shape),
    ];
    objects.extend((0..nodes).map(|i| model(1000 + i, "copy", "Mesh", &[])));
    let mut links = vec![Link(40, 10, ""), Link(41, 40, ""), Link(42, 41, "")];
    links.extend((0..nodes).flat_map(|i| [Link(1000 + i, 0, ""), Link(10, 1000 + i, "")]));
    document(false, 100.0, objects, &links)
}

/// A square that moves along X by these keys.
fn moving(keys: &[(f64, f64)]) -> Vec<Entry> {
    let mut objects = vec![geometry(10, &SQUARE, &[&[0, 1, 2, 3]], Vec::new()), model(20, "square", "Mesh", &[])];
    let mut links = vec![Link(20, 0, ""), Link(10, 20, "")];
    for (more, joined) in [stack("move", 1.0), curves(50, (20, "Lcl Translation"), &[("d|X", keys)], 4)] {
        objects.extend(more);
        links.extend(joined);
    }
    document(false, 100.0, objects, &links)
}

/// The cases, with what is wrong with each.
pub(super) fn cases() -> Vec<(&'static str, Case)> {
    [contents(), meshes(), scenes(), looks()].into_iter().flatten().collect()
}

/// Files whose structure is broken.
fn contents() -> Vec<(&'static str, Case)> {
    let whole = binary(&plain(), Arrays::Zlib);
    let cut = whole[..whole.len() / 2].to_vec();
    let version = |version: u32| [&whole[..23], &version.to_le_bytes(), &whole[27..]].concat();
    let nested = |depth: usize| (0..depth).fold(one("a", 1), |inner, _| list("a", vec![inner]));
    let mut long = whole.clone();
    long[27..31].copy_from_slice(&u32::MAX.to_le_bytes());
    let raw = |array: &[u8]| {
        let mut entries = plain();
        entries[2].children[0].children[0].values = vec![Value::Raw(array.to_vec())];
        binary(&entries, Arrays::Plain)
    };
    vec![
        ("nothing", (Fbx, b"".into(), Refused("Broken | ends too early"))),
        ("a text of another format", (Fbx, b"solid cube\n".into(), Refused("Broken"))),
        ("a binary file without entries", (Fbx, whole[..27].to_vec().into(), Refused("Broken"))),
        ("half of a binary file", (Fbx, cut.into(), Refused("Broken"))),
        ("a binary file of version 1000", (Fbx, version(1000).into(), Refused("Empty | 0 meshes"))),
        ("a binary file of version 4294967295", (Fbx, version(u32::MAX).into(), Refused("Broken"))),
        ("a first entry that ends beyond the file", (Fbx, long.into(), Repaired(2, "meshes without normals"))),
        (
            "an array of 4294967295 numbers in as many bytes",
            (Fbx, raw(&[&b"d"[..], &[255; 4], &[0; 4], &[255; 4]].concat()).into(), Refused("TooLarge | 512 MiB")),
        ),
        (
            "a compressed array of 4294967295 numbers in 4 bytes",
            (
                Fbx,
                raw(&[&b"d"[..], &[255; 4], &[1, 0, 0, 0], &[4, 0, 0, 0], b"abcd"].concat()).into(),
                Refused("TooLarge"),
            ),
        ),
        ("a value of an unknown type", (Fbx, raw(b"?").into(), Refused("Broken"))),
        ("a zlib stream with an unknown block", inflated(12, b"x\x01\xff\xff\xff\xff", Refused("Broken"))),
        ("a zlib stream that ends in its first block", inflated(12, &zlib_zeros(96)[..9], Refused("Broken"))),
        (
            "a compressed array of 67108864 numbers that unpacks to 1 MiB",
            inflated(1 << 26, &zlib_zeros(1 << 20), Refused("TooLarge")),
        ),
        (
            "vertices that unpack from 155 KiB to 24 MiB, all at one place",
            inflated(3 << 20, &zlib_zeros(24 << 20), Refused("Empty | fewer than 3 corners")),
        ),
        ("a text with entries nested 100 deep", of_text(&[nested(100)], Refused("Broken"))),
        (
            "a binary file with entries nested 100 deep",
            (Fbx, binary(&[nested(100)], Arrays::Plain).into(), Refused("Broken")),
        ),
        (
            "a text with 1000000 open braces",
            (
                Fbx,
                [b"; FBX 7.4.0 project file\n".to_vec(), b"a: {".repeat(1_000_000)].concat().into(),
                Refused("Broken"),
            ),
        ),
        (
            "a text with a string of 1 MiB that doesn't end",
            (
                Fbx,
                [b"; FBX 7.4.0 project file\na: \"".to_vec(), vec![b'b'; 1 << 20]].concat().into(),
                Refused("Broken"),
            ),
        ),
        (
            "a text whose array says that it has 4000000000 numbers",
            replaced(&plain(), "*12 {", "*4000000000 {", Repaired(2, "meshes without normals")),
        ),
        (
            "a text whose array says that it has -1 numbers",
            replaced(&plain(), "*12 {", "*-1 {", Repaired(2, "meshes without normals")),
        ),
        ("a text without entries", of_text(&[], Refused("Broken | ends too early"))),
    ]
}

/// Meshes with wrong numbers.
fn meshes() -> Vec<(&'static str, Case)> {
    let with = |x: f64| {
        let mut vertices = SQUARE;
        vertices[3] = x;
        (Fbx, binary(&square(&vertices, &[&[0, 1, 2, 3], &[0, 2, 3]], Vec::new()), Arrays::Plain))
    };
    let [nan, infinite, far] = [f64::NAN, 1e300, 1e38].map(|x| with(x).1);
    let fan: Vec<i32> = (0..600_000).map(|i| i % 4).collect();
    let uvs = |indices: Vec<i32>| {
        layer("LayerElementUV", "ByPolygonVertex", vec![one("UV", vec![0.0, 0.0]), one("UVIndex", indices)])
    };
    let normals = |all: Vec<f64>| layer("LayerElementNormal", "ByPolygonVertex", vec![one("Normals", all)]);
    let material = layer("LayerElementMaterial", "ByPolygon", vec![one("Materials", vec![-7])]);
    let bad_normals = [f64::NAN; 12].to_vec();
    vec![
        (
            "a polygon with vertex 99 of 4",
            of_text(&square(&SQUARE, &[&[0, 1, 2, 99]], Vec::new()), Refused("Broken | entry")),
        ),
        (
            "a polygon with vertex 2147483647",
            of_text(&square(&SQUARE, &[&[0, 1, i32::MAX]], Vec::new()), Refused("Broken | entry")),
        ),
        (
            "a polygon with vertex -2147483648",
            of_text(&square(&SQUARE, &[&[i32::MIN, 1, 2]], Vec::new()), Refused("Broken")),
        ),
        ("a polygon of two corners", of_text(&square(&SQUARE, &[&[0, 1]], Vec::new()), Refused("Empty"))),
        ("vertices that are not triples", of_text(&square(&SQUARE[..4], &[&[0, 0, 0]], Vec::new()), Refused("Broken"))),
        ("a mesh without vertices", of_text(&square(&[], &[], Vec::new()), Refused("Empty"))),
        (
            "a polygon of 600000 corners",
            of_text(&square(&SQUARE, &[&fan], Vec::new()), Refused("Broken | 524288 | corners")),
        ),
        ("a coordinate that is NaN", (Fbx, nan.into(), Repaired(1, "1 faces | a number | 1e37 | left out"))),
        ("a coordinate of 1e300", (Fbx, infinite.into(), Repaired(1, "1 faces | 1e37 | left out"))),
        ("a coordinate of 1e38", (Fbx, far.into(), Repaired(1, "1 faces | 1e37 | left out"))),
        (
            "indices of texture coordinates that don't exist",
            of_text(&square(&SQUARE, &[&[0, 1, 2, 3]], vec![uvs(vec![0, 0, 9, -5])]), Repaired(2, "uvs | 2")),
        ),
        (
            "fewer indices of texture coordinates than corners",
            of_text(&square(&SQUARE, &[&[0, 1, 2, 3]], vec![uvs(vec![0])]), Repaired(2, "meshes without normals")),
        ),
        (
            "normals that are NaN",
            (
                Fbx,
                binary(&square(&SQUARE, &[&[0, 1, 2, 3]], vec![normals(bad_normals)]), Arrays::Plain).into(),
                Repaired(2, "normals without a direction"),
            ),
        ),
        (
            "a polygon with material -7",
            of_text(&square(&SQUARE, &[&[0, 1, 2, 3]], vec![material]), Repaired(2, "meshes without normals")),
        ),
        (
            "edges that don't exist",
            of_text(
                &square(&SQUARE, &[&[0, 1, 2, 3]], vec![one("Edges", vec![0, 99, -4])]),
                Repaired(2, "meshes without normals"),
            ),
        ),
    ]
}

/// Nodes, skins, shapes and curves.
fn scenes() -> Vec<(&'static str, Case)> {
    let circle = {
        let objects = vec![model(20, "a", "Null", &[]), model(21, "b", "Null", &[])];
        document(false, 100.0, objects, &[Link(20, 21, ""), Link(21, 20, "")])
    };
    let unit = |unit| document(false, unit, plain()[2].children.clone(), &[Link(20, 0, ""), Link(10, 20, "")]);
    let flat = {
        let objects = vec![
            geometry(10, &SQUARE, &[&[0, 1, 2, 3]], Vec::new()),
            model(20, "flat", "Mesh", &[("Lcl Scaling", "Lcl Scaling", &[0.0, 0.0, 0.0])]),
        ];
        document(false, 100.0, objects, &[Link(20, 0, ""), Link(10, 20, "")])
    };
    let curve = |from: &str, to: &str, gets| replaced(&moving(&[(0.0, 0.0), (1.0, 5.0)]), from, to, gets);
    vec![
        ("nodes that are each other's parent", of_text(&circle, Refused("Broken"))),
        ("5000 nodes, each the child of the one before", of_text(&chain(5000), Refused("Broken | nested | 4096"))),
        ("2000 nodes, each the child of the one before", of_text(&chain(2000), Repaired(2, "normals"))),
        (
            "4000 nodes that share a mesh with 50000 offsets of a shape",
            (Fbx, binary(&copies(4000, 50_000), Arrays::Plain).into(), Refused("TooMany | copies of meshes")),
        ),
        ("a unit of 0 cm", of_text(&unit(0.0), Repaired(2, "meshes without normals"))),
        (
            "a unit that is NaN",
            (Fbx, binary(&unit(f64::NAN), Arrays::Plain).into(), Refused("Empty | 1 faces | a number")),
        ),
        ("a unit of 1e300 cm", of_text(&unit(1e300), Refused("Empty | 1 faces | 1e37"))),
        ("a node with scale 0", of_text(&flat, Refused("Empty | fewer than 3 corners"))),
        (
            "a joint that moves vertices that don't exist",
            replaced(
                &skinned_strip(),
                "Indexes: *6 { a: 0,1,2,3,4,5 }",
                "Indexes: *6 { a: 0,1,2,3,99,-5 }",
                Repaired(8, "meshes without normals"),
            ),
        ),
        (
            "a joint with weights -1 and 1e300",
            replaced(
                &skinned_strip(),
                "Weights: *6 { a: 1.0,1.0",
                "Weights: *6 { a: -1.0,1e300",
                Repaired(8, "meshes without normals"),
            ),
        ),
        (
            "a joint with a matrix of 15 numbers, one of them 1e308",
            replaced(&skinned_strip(), "*16 { a: 1.0", "*15 { a: 1e308", Refused("Empty | 4 faces | a number | 1e37")),
        ),
        (
            "a shape of vertices that don't exist",
            replaced(
                &morphed_square(),
                "Indexes: *1 { a: 2 }",
                "Indexes: *1 { a: -2 }",
                Repaired(2, "meshes without normals"),
            ),
        ),
        (
            "shapes whose weights are all 0",
            replaced(
                &morphed_square(),
                "FullWeights: *2 { a: 50.0,100.0 }",
                "FullWeights: *2 { a: 0.0,0.0 }",
                Repaired(2, "meshes without normals"),
            ),
        ),
        (
            "key frames in the wrong order",
            curve(
                "KeyTime: *2 { a: 0,46186158000 }",
                "KeyTime: *2 { a: 46186158000,0 }",
                Repaired(2, "meshes without normals"),
            ),
        ),
        (
            "key frames at the first and the last time that there is",
            curve("0,46186158000", "-9223372036854775807,9223372036854775807", Repaired(2, "meshes without normals")),
        ),
        (
            "fewer values than key frames",
            curve("KeyValueFloat: *2 { a: 0.0,5.0 }", "KeyValueFloat: *1 { a: 1e300 }", Refused("Broken | entry")),
        ),
        (
            "attributes for 2000000000 key frames",
            curve(
                "KeyAttrRefCount: *1 { a: 2 }",
                "KeyAttrRefCount: *1 { a: 2000000000 }",
                Repaired(2, "meshes without normals"),
            ),
        ),
    ]
}

/// Materials and textures.
fn looks() -> Vec<(&'static str, Case)> {
    let png = image();
    let textured = textured_square(Ok(&png));
    let broken = textured_square(Ok(&png[..30]));
    let outside = textured_square(Err("../../secret.png"));
    vec![
        ("an embedded image that is cut", of_text(&broken, Repaired(2, "\"paint\" | left out"))),
        ("a texture outside the folder", of_text(&outside, Repaired(2, "\"paint\" | secret.png"))),
        (
            "an embedded image that isn't base64",
            replaced(&textured, "Content: , \"", "Content: , \"!", Repaired(2, "left out")),
        ),
    ]
}
