//! Cameras of a document.

use glam::Vec3;

use super::*;
use geometry::mesh::{FileCamera, Projection};

/// A triangle, and nodes with these cameras: the first is shown, turned by half a turn and a half, and scaled; the second isn't.
pub(super) fn with_cameras(cameras: &Value, nodes: &Value) -> Draft {
    let mut draft = triangle();
    draft.root["cameras"] = cameras.clone();
    let mut all = vec![json!({ "mesh": 0 })];
    all.extend(nodes.as_array().expect("a list").iter().cloned());
    draft.root["scenes"] = json!([{ "nodes": (0..all.len()).collect::<Vec<_>>() }]);
    draft.root["scene"] = json!(0);
    draft.root["nodes"] = json!(all);
    draft
}

fn read(draft: &Draft) -> (Vec<FileCamera>, Vec<String>) {
    let loaded = draft.read().expect("a triangle");
    (loaded.mesh.cameras, loaded.warnings)
}

fn perspective() -> Value {
    json!({ "name": "lens", "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.1 } })
}

#[test]
fn cameras_have_the_names_places_and_directions_of_their_nodes() {
    let orthographic =
        json!({ "type": "orthographic", "orthographic": { "xmag": 3, "ymag": 2, "znear": 0, "zfar": 9 } });
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let nodes = json!([
        { "name": "Shot", "camera": 0, "translation": [1, 2, 3], "rotation": [0, half, 0, half], "scale": [2, 3, -4] },
        { "camera": 0 },
        { "camera": 1, "translation": [0, 0, 5] },
    ]);
    let (cameras, warnings) = read(&with_cameras(&json!([perspective(), orthographic]), &nodes));
    assert_eq!(warnings, Vec::<String>::new());
    let names: Vec<_> = cameras.iter().map(|camera| (&*camera.name, camera.projection)).collect();
    let lens = Projection::Perspective(0.5);
    assert_eq!(names, [("Shot", lens), ("lens", lens), ("camera 1", Projection::Orthographic(2.0))]);
    assert_eq!((cameras[0].eye, cameras[2].eye), (Vec3::new(1.0, 2.0, 3.0), Vec3::Z * 5.0));
    // A mirror turns what is back around; the axes stay right-handed.
    let [right, up, back] = cameras[0].axes;
    assert!(up.distance(Vec3::Y) < 1e-6 && right.cross(up).distance(back) < 1e-6, "{:?}", cameras[0].axes);
    assert_eq!(cameras[1].axes, [Vec3::X, Vec3::Y, Vec3::Z]);
}

#[test]
fn cameras_that_are_not_shown_are_not_listed() {
    let mut draft = with_cameras(&json!([perspective()]), &json!([{ "camera": 0 }]));
    draft.root["scenes"] = json!([{ "nodes": [0] }]);
    assert_eq!(read(&draft), (Vec::new(), Vec::new()));
    assert_eq!(read(&triangle()), (Vec::new(), Vec::new()));
}

#[test]
fn broken_cameras_cost_a_warning() {
    let node = json!([{ "camera": 0 }]);
    for (camera, expected) in [
        (json!(7), "/cameras/0 is 7, not an object; it is left out."),
        (json!({}), "/cameras/0 isn't a perspective or an orthographic camera; it is left out."),
        (json!({ "type": "fisheye" }), "/cameras/0 isn't a perspective or an orthographic camera; it is left out."),
        (json!({ "type": "perspective" }), "/cameras/0 has no field of view or height; it is left out."),
        (
            json!({ "type": "perspective", "perspective": {} }),
            "/cameras/0 has no field of view or height; it is left out.",
        ),
        (
            json!({ "type": "orthographic", "orthographic": { "xmag": 1, "ymag": 0 } }),
            "/cameras/0 has no field of view or height; it is left out.",
        ),
    ] {
        assert_eq!(read(&with_cameras(&json!([camera]), &node)), (Vec::new(), vec![expected.to_owned()]), "{camera}");
    }
    let wide = json!({ "type": "perspective", "perspective": { "yfov": 40 } });
    let (cameras, warnings) = read(&with_cameras(&json!([wide]), &node));
    assert_eq!(cameras[0].projection, Projection::Perspective(170_f32.to_radians()));
    assert!(warnings.len() == 1 && warnings[0].starts_with("/cameras/0/perspective/yfov is 40"), "{warnings:?}");
    for (cameras, node, expected) in [
        (json!({}), json!({ "camera": 0 }), "/cameras is an object, not a list"),
        (json!([perspective()]), json!({ "camera": 1 }), "/nodes/1/camera is 1, but /cameras has 1"),
        (json!([perspective()]), json!({ "camera": "x" }), "/nodes/1/camera is"),
        (json!([perspective()]), json!({ "camera": 0, "scale": [0, 0, 0] }), "/nodes/1 has a camera without"),
    ] {
        let (found, warnings) = read(&with_cameras(&cameras, &json!([node])));
        assert!(found.is_empty() && warnings[0].starts_with(expected), "{node}: {warnings:?}");
    }
}

#[test]
fn only_so_many_cameras_are_listed() {
    let nodes: Vec<_> = (0..300).map(|_| json!({ "camera": 0 })).collect();
    let (cameras, warnings) = read(&with_cameras(&json!([perspective()]), &json!(nodes)));
    assert_eq!(cameras.len(), 256);
    assert_eq!(warnings, ["The scene has 300 cameras, of which the first 256 are listed."]);
}
