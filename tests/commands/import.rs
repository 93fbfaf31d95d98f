//! Whose normals a mesh has, which axis of its file points up, and what the file's unit is.

use serde_json::Value;

use crate::{Folder, both, failure, number, output, sentence, stats, vase};

/// A square in the ground plane of a file whose z axis points up, 2 wide and 3 deep in millimetres.
const GROUND: &str = "v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\nf 1 2 3 4\n";

fn info(arguments: &[&str]) -> Value {
    serde_json::from_str(&output(&[&["info", "--json"], arguments].concat())).expect("JSON")
}

#[test]
fn normals_are_made_with_the_crease_angle() {
    let corners = |arguments: &[&str]| number(&info(&[&[vase()], arguments].concat()), "/corners");
    let flat = corners(&["--mesh-normals", "made", "--crease-angle", "0"]);
    assert!(flat > corners(&["--mesh-normals", "made", "--crease-angle", "180"]), "flat triangles share no corners");
    assert_eq!(corners(&["--crease-angle", "0"]), corners(&[]), "the file has normals");
    let curved = stats(&[vase(), "--mesh-normals", "made", "--crease-angle", "0", "--surface", "pn"]);
    assert!(number(&curved, "/patches") > 0.0);
    let errors = failure(&["info", vase(), "--crease-angle", "181"], 2);
    assert!(errors.contains("from 0 to 180"), "{errors}");
    failure(&["info", vase(), "--mesh-normals", "smooth"], 2);
}

#[test]
fn styles_of_parts_that_have_no_effect_are_said() {
    let folder = Folder::new();
    let parts = folder.write("parts.obj", "v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\no door\nf 1 2 3\no window\nf 1 3 4\n");
    let [json, csv, out] = ["out.json", "out.csv", "out.obj"].map(|name| folder.path(name));
    let [lod, surface] =
        ["lod/distance", "surface/pn"].map(|name| format!("{}/assets/{name}.wgsl", env!("CARGO_MANIFEST_DIR")));
    let said = |arguments: &[&str], style: &str| {
        let part = format!("door:{style}");
        both(&[arguments, &["--part", &part]].concat()).1.contains("--part has no effect")
    };
    assert!(said(&["info", &parts], "surface=flat"));
    assert!(said(&["adjacency", &parts, "-o", &json], "detail=2"));
    let tessellate = ["tessellate", &parts, "-o", &out];
    let on_cpu = [&tessellate[..], &["--device", "cpu"]].concat();
    assert!(!said(&on_cpu, "surface=flat,detail=2"));
    let factors = ["factors", &parts, "-o", &csv, "--lod-shader", &lod];
    assert!(said(&factors, "detail=2") && !said(&factors, "surface=flat"));
    let given = [&on_cpu[..], &["--factors", &csv]].concat();
    assert!(said(&given, "detail=2") && !said(&given, "surface=flat"));
    let shaded = [&tessellate[..], &["--surface-shader", &surface]].concat();
    assert!(said(&shaded, "surface=flat") && !said(&shaded, "detail=2"));
}

/// A floor and a wall that meet in an edge at a right angle, without normals. The wall has two materials.
const BENT: &str = "v 0 0 0\nv 2 0 0\nv 2 0 3\nv 0 0 3\nv 0 1 0\nv 2 1 0\no floor\nusemtl red\nf 1 4 3 2\n\
                    o wall\nf 1 2 6\nusemtl blue\nf 1 6 5\n";

#[test]
fn parts_have_normals_and_crease_angles_of_their_own() {
    let folder = Folder::new();
    let bent = folder.write("bent.obj", BENT);
    let corners = |arguments: &[&str]| number(&info(&[&[&*bent], arguments].concat()), "/corners");
    assert_eq!(corners(&[]), 8.0, "both are flat");
    assert_eq!(corners(&["--crease-angle", "180"]), 6.0);
    assert_eq!(corners(&["--part", "wall:crease=180"]), 8.0, "only the wall is bent there");
    assert_eq!(corners(&["--part", "wall:crease=180", "--part", "floor:crease=90"]), 6.0);
    // A part may be named twice.
    let twice = ["--part", "wall:crease=0", "--part", "floor:crease=180", "--part", "wall:normals=made,crease=180"];
    assert_eq!(corners(&twice), 6.0);
    assert_eq!(corners(&["--crease-angle", "180", "--part", "wall:crease=0"]), 8.0);
    let said = both(&["info", &bent, "--part", "wall:crease=180"]).1;
    assert!(!said.contains("no effect"), "{said}");
    // What they share is still computed once.
    let smooth = ["--part", "wall:normals=made,crease=180", "--part", "material:blue:surface=flat", "--factor", "5"];
    let stats = stats(&[&[&*bent], &smooth[..]].concat());
    assert_eq!(number(&stats, "/cracks/different_bits"), 0.0, "{stats}");
    assert_eq!(number(&stats, "/edges/split"), 1.0, "{stats}");
    assert_eq!(stats["parts"], serde_json::json!(["wall:normals=made,crease=180", "material:blue:surface=flat"]));
    let split = [&[&*bent][..], &smooth[..], &["--split", "0.5", "--split-left", "flat"]].concat();
    assert_eq!(crate::stats(&split)["left"]["parts"], stats["parts"], "the left half has the same parts");
    let other = crate::stats(&[&split[..], &["--split-with", "shape:torus"]].concat());
    assert_eq!((&other["left"]["parts"], &other["parts"]), (&serde_json::json!([]), &stats["parts"]));
    for text in ["wall:normals=smooth", "wall:normals", "wall:crease=nan", "wall:crease=-1", "wall:crease=181"] {
        let errors = failure(&["info", &bent, "--part", text], 2);
        assert!(errors.contains("choose one of file, made") || errors.contains("from 0 to 180"), "{errors}");
    }
}

#[test]
fn a_material_has_a_style_whatever_parts_it_lies_in() {
    let folder = Folder::new();
    let bent = folder.write("bent.obj", BENT);
    let triangles = |arguments: &[&str]| {
        let uniform = ["--factor", "4", "--partitioning", "integer"];
        number(&stats(&[&[&*bent], &uniform[..], arguments].concat()), "/triangles_out")
    };
    let usual = triangles(&[]);
    let of_red = triangles(&["--part", "material:red:detail=2"]);
    let of_wall = triangles(&["--part", "wall:detail=2"]);
    assert!(
        usual < of_wall && of_wall < of_red,
        "{usual}, {of_wall}, {of_red}: three triangles are red, two of the wall"
    );
    let both = triangles(&["--part", "material:red:detail=2", "--part", "floor:detail=1"]);
    assert!(usual < both && both < of_red, "{both}: what the floor has counts before what its material has");
    sentence(&["info", &bent, "--part", "material:green:detail=2"], &["no part material:green", "material:red"]);
}

#[test]
fn parts_are_listed_and_left_out() {
    let folder = Folder::new();
    let parts = folder.path("parts.obj");
    let text = "v 0 0 0\nv 2 0 0\nv 2 3 0\no left door\nf 1 2 3\no -right\nf 3 2 1\nf 2 3 1\n";
    std::fs::write(&parts, text).expect("a writable folder");
    let json = info(&[&parts]);
    assert_eq!(json["parts"][1], serde_json::json!({ "name": "-right", "triangles": 2, "hidden": false }));
    assert!(output(&["info", &parts]).contains("part          left door: 1 triangles\n"));
    let json = info(&[&parts, "--hide-part", "-right"]);
    assert_eq!((number(&json, "/triangles"), &json["parts"][1]["hidden"]), (1.0, &Value::Bool(true)));
    let json = info(&[&parts, "--show-part", "-right"]);
    assert_eq!((number(&json, "/triangles"), &json["parts"][0]["hidden"]), (2.0, &Value::Bool(true)));
    sentence(&["info", &parts, "--show-part", "bonnet"], &["parts are hidden", "left door", "-right"]);
    sentence(&["info", &parts, "--hide-part", "bonnet"], &["bonnet", "left door", "-right"]);
    sentence(&["info", &parts, "--hide-part", "left door", "--hide-part=-right"], &["parts are hidden"]);
    let plain = folder.write("plain.off", "OFF\n3 1 0\n0 0 0\n2 0 0\n2 3 0\n3 0 1 2\n");
    sentence(&["info", &plain, "--hide-part", "left door"], &["no named parts"]);
    // A surface and a detail of its own.
    let styled =
        stats(&[&parts, "--part", "-right:surface=flat,detail=2", "--factor", "4", "--partitioning", "integer"]);
    let usual = stats(&[&parts, "--factor", "4", "--partitioning", "integer"]);
    assert!(number(&styled, "/triangles_out") > number(&usual, "/triangles_out"), "edges take the finest: {styled}");
    let as_it_is = ["--surface", "flat", "--factor", "1", "--partitioning", "integer", "--part", "-right:detail=4"];
    assert!(
        failure(&[&["render", &parts, "-o", &folder.path("a.png")][..], &as_it_is].concat(), 2).contains("as it is")
    );
    // Phong tessellation has its strength there too.
    let out = folder.path("out.obj");
    let phong = ["tessellate", &parts, "-o", &out, "--device", "cpu", "--factor", "2", "--alpha", "0.5", "--part"];
    let of_part = |style: &str, code| failure(&[&phong[..], &[style]].concat(), code);
    of_part("-right:surface=phong", 0);
    assert!(of_part("-right:detail=2", 2).contains("or a --part with such a surface"));
    sentence(&["info", &parts, "--part", "bonnet:detail=2"], &["bonnet", "left door", "-right"]);
    sentence(&["info", &plain, "--part", "a:surface=flat"], &["no named parts", "--part"]);
    for text in ["-right", "-right:", "-right:surface=round", "-right:detail=0", "-right:detail=nan", "-right:size=2"] {
        failure(&["info", &parts, "--part", text], 2);
    }
    let groups =
        folder.write("groups.obj", &*text.replace("o left door", "o body\ng left door").replace("o -right", "g right"));
    let listed = output(&["info", &groups]);
    assert!(
        listed.contains("group         body: 2 parts, 3 triangles\npart          body/left door: 1 triangles\n"),
        "{listed}"
    );
    for (name, shown) in [("body", 3.0), ("right", 2.0), ("body/right", 2.0), ("/body/left door/.", 1.0)] {
        assert_eq!(number(&info(&[&groups, "--show-part", name]), "/triangles"), shown, "{name}");
    }
    sentence(&["info", &groups, "--hide-part", "door"], &["no part door", "body/left door"]);
    // Named nodes of glTF files are parts.
    sentence(&["info", vase(), "--hide-part", "left door"], &["no part left door", "vase"]);
}

#[test]
fn materials_are_left_out_and_levels_of_detail_are_chosen() {
    let folder = Folder::new();
    folder.write("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
    let text = "mtllib a.mtl\nv 0 0 0\nv 2 0 0\nv 2 3 0\no car_LOD0\nusemtl red\nf 1 2 3\nusemtl blue\nf 3 2 1\nf 2 3 1\n\
                o car_LOD1\nusemtl red\nf 1 2 3\n";
    let file = folder.write("levels.obj", text);
    let triangles = |arguments: &[&str]| number(&info(&[&[&*file], arguments].concat()), "/triangles");
    assert_eq!(triangles(&[]), 3.0, "the first level");
    let said = output(&["info", &file]);
    assert!(said.contains("levels of detail") && said.contains("car_LOD1: 1 triangles, left out"), "{said}");
    assert_eq!(triangles(&["--show-part", "car_LOD1"]), 1.0);
    assert_eq!(triangles(&["--show-part", "material:blue"]), 2.0);
    assert_eq!(triangles(&["--hide-part", "material:blue"]), 1.0);
    let none_is_blue = ["--show-part", "car_LOD1", "--hide-part", "material:blue"];
    assert_eq!(triangles(&none_is_blue), 1.0, "materials of parts that are left out aren't asked for");
    assert_eq!(info(&[&file])["parts"].as_array().expect("a list").len(), 2, "materials have a list of their own");
    let plain = folder.write("plain.obj", text.replace("_LOD", " "));
    sentence(&["info", &plain, "--hide-part", "material:green"], &["no part material:green", "material:red"]);
}

#[test]
fn what_a_file_hides_is_loaded_if_asked() {
    let folder = Folder::new();
    let hidden = folder.path("hidden.gltf");
    let text = "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\
                \"nodes\":[{\"mesh\":0,\"extensions\":{\"KHR_node_visibility\":{\"visible\":false}}}],\
                \"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\
                \"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],\
                \"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\"uri\":\
                \"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";
    std::fs::write(&hidden, text).expect("a writable folder");
    sentence(&["info", &hidden], &["no triangles to show", "hides the 1 nodes", "--show-hidden"]);
    assert_eq!(number(&info(&[&hidden, "--show-hidden"]), "/triangles"), 1.0);
    output(&["render", &hidden, "--show-hidden", "--factor", "1", "--size", "64x64", "-o", &folder.path("shown.png")]);
}

#[test]
fn axis_and_unit_are_chosen_and_a_shape_has_its_own() {
    let folder = Folder::new();
    let ground = folder.write("ground.obj", GROUND);
    let out = folder.path("turned.obj");
    let positions = |options: &[&str]| {
        output(&[&["tessellate", &ground, "-o", &out, "--factor", "1", "--device", "cpu"], options].concat());
        let text = std::fs::read_to_string(&out).expect("what was written");
        let of_line = |line: &str| line.split(' ').skip(1).map(|word| word.parse::<f64>().expect("a number")).collect();
        let mut all: Vec<Vec<f64>> = text.lines().filter(|line| line.starts_with("v ")).map(of_line).collect();
        all.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
        all
    };
    assert_eq!(positions(&[]).last(), Some(&vec![2.0, 3.0, 0.0]));
    assert_eq!(positions(&["--up", "z"]).last(), Some(&vec![2.0, 0.0, 0.0]));
    assert_eq!(positions(&["--up", "z"])[0], [0.0, 0.0, -3.0]);
    assert_eq!(positions(&["--up", "-y"])[0], [0.0, -3.0, 0.0]);
    let metres = positions(&["--unit", "mm"]);
    let last = metres.last().expect("corners");
    assert!((last[1] - 0.003).abs() < 1e-9, "{metres:?}");
    sentence(&["info", "shape:torus", "--up", "z"], &["shape:torus", "Y up", "--up"]);
    assert_eq!(positions(&["--unit", "0.001"]), metres, "a unit may be given by its length");
    for wrong in ["yd", "0", "nan", "1e300"] {
        let said = failure(&["info", &ground, "--unit", wrong], 2);
        assert!(said.contains("expected mm, cm, m, in, ft, or a number: 0.000000001 to 1000000000 metres"), "{said}");
    }
    failure(&["info", &ground, "--unit", "-1"], 2);
}
