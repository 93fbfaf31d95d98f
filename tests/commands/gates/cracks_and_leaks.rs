//! Cracks and leaks: of meshes that are open or wound both ways, of patches that are left out, and without backs.

use serde_json::Value;

use super::drawn;
use crate::{Folder, failure, number, output};

/// Writes a torus without one of its triangles.
fn write_missing(folder: &Folder) -> String {
    let path = folder.path("missing.obj");
    let options = ["--surface", "flat", "--factor", "1", "--partitioning", "integer", "--device", "cpu"];
    output(&[&["tessellate", "shape:torus", "-o", &path], &options[..]].concat());
    let whole = std::fs::read_to_string(&path).expect("a mesh");
    let last = whole.rfind("\nf ").expect("a face");
    std::fs::write(&path, &whole[..=last]).expect("a writable folder");
    path
}

#[test]
fn a_gate_that_cannot_be_judged_fails_and_says_why() {
    let folder = Folder::new();
    let mesh = write_missing(&folder);
    let why = "missing.obj fails the gate leaks: leaks can be counted only in a closed mesh, and this one is open: leave this gate \
               out for it";
    let (code, said, gates) = drawn(&[&mesh, "--fail-on", "leaks,folds"]);
    assert_eq!((code, said.lines().count()), (Some(1), 1), "{said}");
    assert!(said.contains(why), "{said}");
    assert_eq!((&gates[0]["passed"], &gates[0]["found"]), (&false.into(), &Value::Null));
    assert_eq!((&gates[1]["passed"], &gates[1]["found"]), (&true.into(), &0.into()));
    let stability = ["stability", &mesh, "--method", "pn", "--method", "flat", "--device", "gpu", "--cameras", "1"];
    let said = failure(&[&stability[..], &["--fail-on", "leaks,cracks"]].concat(), 1);
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.contains(why), "{said}");
    output(&[&stability[..], &["--fail-on", "cracks"]].concat());
    // The eye is inside the mesh, and another view would do.
    let (code, said, gates) = drawn(&["shape:torus", "--camera", "0,0,0.01", "--fail-on", "leaks"]);
    assert_eq!((code, &gates[0]["passed"], &gates[0]["found"]), (Some(1), &false.into(), &Value::Null));
    assert!(said.contains("move the camera away"), "{said}");
}

#[test]
fn leaks_of_a_mesh_that_is_closed_and_wound_both_ways_are_not_those_of_an_open_one() {
    let folder = Folder::new();
    // A tetrahedron whose last face is wound the other way.
    let path = folder.write("both.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 4 3\n");
    assert!(output(&["info", &path]).contains("surface       closed, wound both ways"));
    let (code, said, _) = drawn(&[&path, "--fail-on", "leaks"]);
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("wound the same way") && !said.contains("open"), "{said}");
}

#[test]
fn a_patch_that_its_factors_leave_out_beside_one_that_is_drawn_is_a_crack() {
    let folder = Folder::new();
    let factors = folder.path("factors.csv");
    // A square of two triangles, with the diagonal as the edge of factor 0 of the first.
    let square = folder.write("square.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n");
    let judged = |second: &str, gates: &str| {
        std::fs::write(&factors, format!("patch,e0,e1,e2,inside\n0,3,3,3,3\n1,{second},3\n"))
            .expect("a writable folder");
        drawn(&[&square, "--factors", &factors, "--fail-on", gates])
    };
    let gates = "cracks,factors,folds";
    assert_eq!(judged("3,3,3", gates).0, Some(0));
    for discarding in ["nan", "0", "-1"] {
        // The edge of factor 2 is the diagonal, that of factor 0 is on the border.
        let (code, said, found) = judged(&format!("{discarding},3,3"), gates);
        assert_eq!(code, Some(1), "{said}");
        let words = [
            "1 edge is cracked",
            "the widest gap, 0.707 object units, is between triangles 0 and 1",
            "where the factors of triangle 1 leave it out",
        ];
        assert!(words.iter().all(|words| said.contains(words)), "{said}");
        assert_eq!((&found[0]["found"], &found[1]["found"], &found[2]["found"]), (&1.into(), &0.into(), &0.into()));
        let (_, said, found) = judged(&format!("3,3,{discarding}"), gates);
        assert_eq!((&found[0]["found"], &found[1]["found"], &found[2]["found"]), (&1.into(), &1.into(), &0.into()));
        assert!(said.contains("the factors differ most"), "{said}");
    }
    assert_eq!(judged("nan,3,3", "cracks:1").0, Some(0));
}

#[test]
fn leaks_are_judged_with_backs_left_out() {
    let torn = ["shape:cube-split", "--surface", "pn", "--fail-on", "leaks"];
    let (_, _, whole) = drawn(&torn);
    let (code, _, culled) = drawn(&[&torn[..], &["--cull-back-faces"]].concat());
    assert_eq!((code, number(&culled[0], "/found")), (Some(1), number(&whole[0], "/found")));
}
