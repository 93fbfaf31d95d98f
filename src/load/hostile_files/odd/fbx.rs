//! FBX.

use super::Odd;
use crate::Format::Fbx;
use crate::fbx::tests::documents::{Link, document, geometry, layer, model, prism};
use crate::fbx::tests::tree::{Arrays, Entry, binary, entry, list, one, text};

const SQUARE: [f64; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];

/// A cube as FBX 6.1 has it: a mesh is part of its model, and connections are by name.
const OLD: &str = r#"; FBX 6.1.0 project file
; Copyright (C) 1997-2007
FBXHeaderExtension:  {
    FBXHeaderVersion: 1003
    FBXVersion: 6100
    Creator: "made by hand"
}
Definitions:  {
    Version: 100
    Count: 1
    ObjectType: "Model" {
        Count: 1
    }
}
Objects:  {
    Model: "Model::Cube", "Mesh" {
        Version: 232
        Properties60:  {
            Property: "QuaternionInterpolate", "bool", "",0
            Property: "Lcl Translation", "Lcl Translation", "A+",0,0,0
            Property: "Lcl Scaling", "Lcl Scaling", "A+",1,1,1
        }
        MultiLayer: 0
        Shading: Y
        Culling: "CullingOff"
        Vertices: 0,0,0,1,0,0,1,1,0,0,1,0
        ,0,0,1,1,0,1,1,1,1,0,1,1
        PolygonVertexIndex: 3,2,1,-1,4,5,6,-8,0,1,5,-5
        ,1,2,6,-6,2,3,7,-7,3,0,4,-8
        GeometryVersion: 124
    }
}
Relations:  {
    Model: "Model::Cube", "Mesh" {
    }
}
Connections:  {
    Connect: "OO", "Model::Cube", "Model::Scene"
}
"#;

fn of(name: &'static str, bytes: impl Into<Vec<u8>>, triangles: usize, warning: &'static str) -> Odd {
    Odd { name, format: Fbx, bytes: bytes.into(), triangles, warning }
}

/// A square on a node, with more entries of its mesh, and properties of the node.
fn square(more: Vec<Entry>, properties: &[(&str, &str, &[f64])], links: &[Link]) -> Vec<Entry> {
    let objects = vec![geometry(10, &SQUARE, &[&[0, 1, 2, 3]], more), model(20, "square", "Mesh", properties)];
    document(false, 100.0, objects, links)
}

fn plain() -> Vec<Entry> {
    square(Vec::new(), &[], &[Link(20, 0, ""), Link(10, 20, "")])
}

pub(super) fn files() -> Vec<Odd> {
    [texts(), scenes(), meshes()].into_iter().flatten().collect()
}

/// Oddities of the text.
fn texts() -> Vec<Odd> {
    let own = String::from_utf8(text(&plain())).expect("a text");
    let whole = binary(&plain(), Arrays::Zlib);
    let of_version = |version: u32| [&whole[..23], &version.to_le_bytes(), &whole[27..]].concat();
    vec![
        of("text of version 6100", OLD, 12, ""),
        of("text of version 6100 with line ends of Windows", OLD.replace('\n', "\r\n"), 12, ""),
        of("text with line ends of Windows", own.replace('\n', "\r\n"), 2, ""),
        of("text with a byte order mark", format!("\u{feff}{own}"), 2, ""),
        of("text with comments", own.replace("Objects:", "; ----\n; Objects\n;\n\nObjects:"), 2, ""),
        of(
            "text without its first comment",
            own.lines().skip(1).map(|line| format!("{line}\n")).collect::<String>(),
            2,
            "",
        ),
        of("text with line ends within arrays", own.replace(",1.0", ",\n\t\t\t1.0"), 2, ""),
        of("text without an end of the last line", own.trim_end(), 2, ""),
        of("binary of version 7100", of_version(7100), 2, ""),
        of("binary with bytes after its end", [whole, vec![0; 200]].concat(), 2, ""),
        of(
            "a name that isn't UTF-8",
            [own.replace("square", "caf~").into_bytes()]
                .concat()
                .into_iter()
                .map(|byte| if byte == b'~' { 0xe9 } else { byte })
                .collect::<Vec<_>>(),
            2,
            "names that aren't UTF-8 | 1",
        ),
    ]
}

/// Oddities of the scene.
fn scenes() -> Vec<Odd> {
    let links = || [Link(20, 0, ""), Link(10, 20, "")];
    let mut no_settings = plain();
    no_settings.retain(|entry| entry.name != "GlobalSettings");
    let mut takes = plain();
    takes.push(list("Takes", vec![one("Current", "")]));
    let mut unknown = plain();
    unknown.push(list("AcmeSparkles", vec![one("Count", 7_i64), entry("Empty", Vec::new())]));
    vec![
        of("no settings of axes and units", text(&no_settings), 2, ""),
        of("a list of takes without any", text(&takes), 2, ""),
        of("entries of another program", text(&unknown), 2, ""),
        of("a node that isn't below the root", text(&square(Vec::new(), &[], &[Link(10, 20, "")])), 2, ""),
        of(
            "a connection of something that isn't there",
            text(&square(Vec::new(), &[], &[Link(20, 0, ""), Link(10, 20, ""), Link(77, 20, "")])),
            2,
            "",
        ),
        of(
            "the same connection twice",
            text(&square(Vec::new(), &[], &[Link(20, 0, ""), Link(10, 20, ""), Link(10, 20, "")])),
            2,
            "connections that the file has twice | 1",
        ),
        of(
            "a node that mirrors",
            text(&square(Vec::new(), &[("Lcl Scaling", "Lcl Scaling", &[-1.0, 1.0, 1.0])], &links())),
            2,
            "",
        ),
        of(
            "a property of another program",
            text(&square(Vec::new(), &[("acme_heat", "Number", &[1.0])], &links())),
            2,
            "",
        ),
        of(
            "a unit of inches",
            text(&document(true, 2.54, vec![prism(Vec::new()), model(20, "prism", "Mesh", &[])], &links())),
            20,
            "",
        ),
    ]
}

/// Oddities of meshes.
fn meshes() -> Vec<Odd> {
    let with = |more: Vec<Entry>| text(&square(more, &[], &[Link(20, 0, ""), Link(10, 20, "")]));
    let normals = |mapping: &str, numbers: usize| {
        layer("LayerElementNormal", mapping, vec![one("Normals", [0.0, 0.0, 1.0].repeat(numbers))])
    };
    let indexed = layer(
        "LayerElementNormal",
        "ByPolygonVertex",
        vec![one("Normals", vec![0.0, 0.0, 1.0]), one("NormalsIndex", vec![0; 4])],
    );
    let uvs = |index: i64| {
        let mut layer = layer(
            "LayerElementUV",
            "ByPolygonVertex",
            vec![one("UV", vec![0.0, 0.0, 1.0, 1.0]), one("UVIndex", vec![0, 1, 1, 0])],
        );
        layer.values = vec![index.into()];
        layer
    };
    vec![
        of("normals of vertices", with(vec![normals("ByVertice", 4)]), 2, ""),
        of("normals of polygons", with(vec![normals("ByPolygon", 1)]), 2, ""),
        of("one normal for all", with(vec![normals("AllSame", 1)]), 2, ""),
        of("normals with indices", with(vec![indexed]), 2, ""),
        of(
            "normals that are mapped in a way that isn't known",
            with(vec![normals("ByWish", 4)]),
            2,
            "one was guessed | 1",
        ),
        of("fewer normals than corners", with(vec![normals("ByPolygonVertex", 2)]), 2, ""),
        of("two sets of texture coordinates", with(vec![uvs(0), uvs(1)]), 2, ""),
        of("edges that are listed", with(vec![one("Edges", vec![0, 1, 2, 3])]), 2, ""),
        of(
            "materials that aren't there",
            with(vec![layer("LayerElementMaterial", "ByPolygon", vec![one("Materials", vec![5])])]),
            2,
            "",
        ),
    ]
}
