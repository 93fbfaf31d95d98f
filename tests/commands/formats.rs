//! OBJ, STL, PLY, OFF and 3MF files: they open like glTF files, and broken ones are refused; so are files of formats that aren't read.

use documents::package;
use serde_json::Value;

use crate::{Folder, assert_says, output, read_obj, sentence};

fn info(path: &str) -> Value {
    serde_json::from_str(&output(&["info", path, "--json"])).expect("JSON")
}

/// Triangles as bits of their positions, rotated to a common first corner.
fn triangles(obj: &str) -> Vec<[[u32; 3]; 3]> {
    let (positions, faces) = read_obj(obj);
    let from_the_least = |mut triangle: [[u32; 3]; 3]| {
        let least = (0..3).min_by_key(|&k| triangle[k]).unwrap_or_default();
        triangle.rotate_left(least);
        triangle
    };
    faces.iter().map(|face| from_the_least(face.map(|point| positions[point]))).collect()
}

/// The triangles of an OBJ file as STL in text, and as PLY, OFF and 3MF with three vertices each.
fn rewrite(folder: &Folder, obj: &str) -> [String; 4] {
    let triangles: Vec<_> = triangles(obj).into_iter().map(|t| t.map(|p| p.map(f32::from_bits))).collect();
    let (mut stl, mut rows, mut faces) = ("solid a\n".to_owned(), String::new(), String::new());
    for (i, triangle) in triangles.iter().enumerate() {
        stl += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in triangle {
            stl += &format!("vertex {x} {y} {z}\n");
            rows += &format!("{x} {y} {z}\n");
        }
        stl += "endloop\nendfacet\n";
        faces += &format!("3 {} {} {}\n", 3 * i, 3 * i + 1, 3 * i + 2);
    }
    let ply = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\nelement face {}\n\
         property list uchar int vertex_indices\nend_header\n{rows}{faces}",
        3 * triangles.len(),
        triangles.len()
    );
    let off = format!("OFF\n{} {} 0\n{rows}{faces}", 3 * triangles.len(), triangles.len());
    // In 3MF files Z points up.
    let vertices = triangles.iter().flatten().map(|[x, y, z]| [*x, -z, *y]);
    let mesh = package::mesh(vertices, (0..triangles.len()).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]));
    let model = package::model(&format!("<object id=\"1\">{mesh}</object>"), "<item objectid=\"1\"/>");
    let texts =
        [("a.STL", stl + "endsolid a\n"), ("a.Ply", ply), ("a.off", off)].map(|(name, text)| (name, text.into_bytes()));
    let [stl, ply, off] = texts;
    [stl, ply, off, ("a.3MF", package::package(&model))].map(|(name, bytes)| {
        std::fs::write(folder.path(name), bytes).expect("a writable folder");
        folder.path(name)
    })
}

#[test]
fn one_mesh_is_the_same_in_every_format() {
    let folder = Folder::new();
    let [glb, obj] = ["a.glb", "a.obj"].map(|name| folder.path(name));
    let tessellate = ["tessellate", "shape:cube-split", "--surface", "flat", "--factor", "1", "--device", "cpu", "-o"];
    for path in [&glb, &obj] {
        output(&[&tessellate[..], &[path]].concat());
    }
    let expected = info(&glb);
    assert_eq!((&expected["triangles"], &expected["points"]), (&12.into(), &8.into()));
    let [stl, ply, off, threemf] = rewrite(&folder, &obj);
    for path in [&obj, &stl, &ply, &off, &threemf] {
        let found = info(path);
        for key in ["triangles", "points", "edges", "closed", "euler_characteristic", "bounds", "degenerate"] {
            assert_eq!(found[key], expected[key], "{key} of {path}");
        }
    }
}

#[test]
fn an_exported_obj_file_loads_with_the_same_triangles() {
    let folder = Folder::new();
    let [first, second] = ["first.obj", "second.obj"].map(|name| folder.path(name));
    output(&["tessellate", "shape:torus", "--factor", "3", "--device", "cpu", "-o", &first]);
    let again = ["tessellate", &first, "--surface", "flat", "--factor", "1", "--device", "cpu", "-o", &second];
    output(&again);
    let expected = triangles(&first);
    assert!(expected.len() > 1000);
    assert!(triangles(&second) == expected, "same order, same bits");
    let info = info(&first);
    assert_eq!((&info["closed"], &info["warnings"]), (&true.into(), &Value::Array(Vec::new())));
}

#[test]
fn broken_files_are_refused_with_place_and_numbers() {
    let folder = Folder::new();
    let cases: [(&str, &[u8], &[&str]); 6] = [
        (
            "a.obj",
            b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n",
            &["a.obj has no triangles", "3 positions", "1 faces", "isn't in the file", "line 4"],
        ),
        ("points.OBJ", b"v 0 0 0\np 1\n", &["points.OBJ has no triangles", "1 positions, 1 points"]),
        ("a.stl", &[0; 100], &["a.stl has no triangles", "0 triangles"]),
        ("cut.stl", &[1; 100], &["cut.stl has no triangles", "16843009 triangles", "none is whole"]),
        (
            "a.ply",
            b"ply\nformat ascii 1.0\nelement vertex 4611686018427387904\nproperty float x\nend_header\n",
            &["a.ply: line 5", "header"],
        ),
        ("empty.ply", b"", &["empty.ply is empty"]),
    ];
    for (name, bytes, expected) in cases {
        std::fs::write(folder.path(name), bytes).expect("a writable folder");
        sentence(&["info", &folder.path(name)], expected);
        sentence(&["render", &folder.path(name), "-o", &folder.path("out.png")], expected);
    }
}

#[test]
fn a_file_opens_by_its_content_whatever_its_name() {
    let folder = Folder::new();
    let [glb, obj] = ["a.glb", "a.obj"].map(|name| folder.path(name));
    for path in [&glb, &obj] {
        output(&[
            "tessellate",
            "shape:cube-split",
            "--surface",
            "flat",
            "--factor",
            "1",
            "--device",
            "cpu",
            "-o",
            path,
        ]);
    }
    for (from, name, said) in [
        (&glb, "b.obj", "The file's name ends in .obj, but its content is glTF, so it was read as glTF."),
        (&obj, "b.txt", "The file's name ends in .txt, but its content is OBJ, so it was read as OBJ."),
        (&obj, "b", "The file's name has no extension. Its content is OBJ, so it was read as OBJ."),
    ] {
        std::fs::copy(from, folder.path(name)).expect("a writable folder");
        let found = info(&folder.path(name));
        assert_eq!((&found["triangles"], &found["warnings"]), (&12.into(), &serde_json::json!([said])), "{name}");
    }
}

#[test]
fn formats_that_are_not_read_are_named_with_a_converter() {
    let folder = Folder::new();
    let archive = package::zip(&[package::Entry::stored("scene.gltf", b"{}")]);
    let cases: [(&str, &[u8], &[&str]); 4] = [
        (
            "a.blend",
            b"BLENDER-v405",
            &["a.blend is a Blender file, which isn't read", "blender --background FILE.blend"],
        ),
        ("a.usda", b"#usda 1.0\n", &["a.usda is a USD file", "usd2gltf -i FILE.usd -o FILE.glb"]),
        ("a.obj", b"ISO-10303-21;\n", &["a.obj is a STEP file", "gmsh"]),
        ("a.zip", &archive, &["a.zip: it is a zip archive without a 3MF model", "such as scene.gltf"]),
    ];
    for (name, bytes, expected) in cases {
        std::fs::write(folder.path(name), bytes).expect("a writable folder");
        sentence(&["info", &folder.path(name)], expected);
    }
}

#[test]
fn materials_of_an_obj_file_are_read_and_missing_ones_reported() {
    let folder = Folder::new();
    let text = "mtllib colours.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\nusemtl lost\nf 3 2 1\n";
    std::fs::write(folder.path("a.obj"), text).expect("a writable folder");
    std::fs::write(folder.path("colours.mtl"), "newmtl red\nKd 1 0 0\nmap_Kd lost.png\n").expect("a writable folder");
    let said = output(&["info", &folder.path("a.obj")]);
    assert_says(
        &said,
        &[
            "material      red: 1 triangles\n",
            "material      lost: 1 triangles\n",
            "\"lost.png\" of material \"red\" is left out: ",
            "materials that no material file describes",
        ],
    );
}
