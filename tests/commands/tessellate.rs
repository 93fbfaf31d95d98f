//! `pnaen tessellate`: the meshes that it writes.

use std::collections::HashMap;

use serde_json::Value;

use crate::{Folder, output, read_obj, sentence, vase};

#[test]
fn a_tessellated_mesh_is_closed_to_the_last_bit() {
    let folder = Folder::new();
    let path = folder.path("out.obj");
    for device in ["gpu", "cpu"] {
        output(&["tessellate", "shape:cylinder", "-o", &path, "--device", device, "--factor", "5.5"]);
        let (positions, faces) = read_obj(&path);
        let mut edges: HashMap<_, i32> = HashMap::new();
        for face in faces {
            for k in 0..3 {
                let [a, b] = [face[k], face[(k + 1) % 3]].map(|i| positions[i]);
                if a != b {
                    *edges.entry((a, b)).or_default() += 1;
                    *edges.entry((b, a)).or_default() -= 1;
                }
            }
        }
        let open = edges.values().filter(|&&count| count != 0).count();
        assert_eq!(open, 0, "{device}: every edge is used once in each direction");
    }
}

#[test]
fn a_tessellated_mesh_can_be_opened_again() {
    let folder = Folder::new();
    let path = folder.path("out.glb");
    output(&["tessellate", vase(), "-o", &path, "--factor", "3", "--partitioning", "integer"]);
    let info: Value = serde_json::from_str(&output(&["info", &path, "--json"])).expect("JSON");
    assert_eq!(
        (&info["triangles"], &info["closed"], &info["euler_characteristic"]),
        (&(308 * 13).into(), &true.into(), &2.into())
    );
    assert_eq!(info["materials"][0]["texture"], serde_json::json!([64, 64]));
    assert_eq!(info["edges"]["non_manifold"], 0);
}

#[test]
fn a_mesh_of_degenerate_triangles_alone_is_refused_and_nothing_is_written() {
    let folder = Folder::new();
    let [degenerate, out] = ["degenerate.gltf", "out.glb"].map(|name| folder.path(name));
    // A triangle with all corners on one point is left out. The buffer has 36 zero bytes.
    let zeros = "A".repeat(48);
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[0,0,0]}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}}],
        "buffers":[{{"byteLength":36,"uri":"data:application/octet-stream;base64,{zeros}"}}]}}"#
    );
    std::fs::write(&degenerate, text).expect("a writable folder");
    sentence(&["tessellate", &degenerate, "-o", &out], &["degenerate.gltf", "no triangles to show", "on one point"]);
    assert!(!std::path::Path::new(&out).exists());
}

#[test]
fn a_mesh_too_large_for_its_format_is_refused_before_it_is_tessellated() {
    let folder = Folder::new();
    let [torus, out] = ["torus.glb", "out.glb"].map(|name| folder.path(name));
    output(&["tessellate", "shape:torus", "-o", &torus, "--factor", "20", "--partitioning", "integer"]);
    for device in ["gpu", "cpu"] {
        // About 150 thousand triangles, each of which becomes 6144.
        let arguments = ["tessellate", &torus, "-o", &out, "--factor", "64", "--device", device];
        sentence(
            &[&arguments[..], &["--partitioning", "integer"]].concat(),
            &["out.glb", "943718400 triangles", "lower the factor"],
        );
    }
}
