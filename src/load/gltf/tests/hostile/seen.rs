//! Cameras and lights, which never keep a mesh from loading.

use super::*;
use crate::gltf::tests::cameras::with_cameras;
use crate::gltf::tests::lights::lit;

/// So many nodes have a camera, or a light.
const MANY: usize = 150_000;

fn camera(name: &'static str, camera: Value, gets: Gets) -> Case {
    Case::draft(name, &with_cameras(&json!([camera]), &json!([{ "camera": 0 }])), gets)
}

fn perspective(name: &'static str, member: &str, value: Value, gets: Gets) -> Case {
    let mut lens = json!({ "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.1 } });
    lens["perspective"][member] = value;
    camera(name, lens, gets)
}

/// A light on a node with these members.
fn light(name: &'static str, light: Value, more: Value, gets: Gets) -> Case {
    let mut node = json!({ "extensions": { "KHR_lights_punctual": { "light": 0 } } });
    more.as_object().expect("members").iter().for_each(|(name, value)| node[name] = value.clone());
    Case::draft(name, &lit(json!([light]), &[node]), gets)
}

fn cameras() -> Vec<Case> {
    let lens = || json!({ "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.1 } });
    let mut no_list = with_cameras(&json!([]), &json!([{ "camera": 0 }]));
    no_list.root.as_object_mut().expect("an object").remove("cameras");
    let many: Vec<_> = (0..MANY).map(|_| json!({ "camera": 0 })).collect();
    let text = with_cameras(&json!([lens()]), &json!([{ "camera": 0 }])).document().to_string();
    let flat = json!([{ "camera": 0, "scale": [1, 0, 1] }]);
    vec![
        Case::refused("a field of view of NaN", text.replace("0.5", "NaN"), "NotGltf | JSON | 1"),
        perspective(
            "a field of view of 0",
            "yfov",
            json!(0),
            Gets::Repaired("/cameras/0/perspective/yfov | 0 | at least"),
        ),
        perspective(
            "a field of view beyond 32 bits",
            "yfov",
            json!(1e300),
            Gets::Repaired("/cameras/0/perspective/yfov | at most"),
        ),
        perspective(
            "a field of view that is text",
            "yfov",
            json!("wide"),
            Gets::Repaired("/cameras/0/perspective/yfov | \"wide\" | not a number"),
        ),
        perspective("a near plane behind the camera", "znear", json!(-5), Gets::Read),
        perspective("a camera without width", "aspectRatio", json!(0), Gets::Read),
        perspective("a far plane before the near one", "zfar", json!(0.01), Gets::Read),
        camera(
            "an orthographic camera without height",
            json!({ "type": "orthographic", "orthographic": { "xmag": 0, "ymag": 0 } }),
            Gets::Repaired("/cameras/0 | no field of view or height | left out"),
        ),
        camera(
            "a camera without a type",
            json!({ "perspective": { "yfov": 0.5 } }),
            Gets::Repaired("/cameras/0 | isn't a perspective or an orthographic camera"),
        ),
        Case::draft(
            "a node with a camera that isn't there",
            &with_cameras(&json!([lens()]), &json!([{ "camera": 7 }])),
            Gets::Repaired("/nodes/1/camera | 7 | /cameras | 1"),
        ),
        Case::draft(
            "a node with a camera in a file without cameras",
            &no_list,
            Gets::Repaired("/nodes/1/camera | 0 | /cameras"),
        ),
        Case::draft(
            "a camera that looks nowhere",
            &with_cameras(&json!([lens()]), &flat),
            Gets::Repaired("/nodes/1 | camera without a finite place and direction"),
        ),
        Case::draft(
            "cameras on 150,000 nodes",
            &with_cameras(&json!([lens()]), &json!(many)),
            Gets::Repaired("150000 cameras | first 256"),
        ),
    ]
}

fn lights() -> Vec<Case> {
    let own = json!({ "extensions": { "KHR_lights_punctual": { "light": 9 } } });
    let node = json!({ "extensions": { "KHR_lights_punctual": { "light": 0 } } });
    let spot = |inner: f64, outer: f64| json!({ "type": "spot", "spot": { "innerConeAngle": inner, "outerConeAngle": outer } });
    vec![
        light(
            "a light as bright as no number",
            json!({ "type": "point", "intensity": 1e300 }),
            json!({}),
            Gets::Repaired("/lights/0/intensity | at most"),
        ),
        light(
            "a light of negative colour",
            json!({ "type": "point", "color": [1, -1, 1] }),
            json!({}),
            Gets::Repaired("/lights/0/color/1 | -1 | at least"),
        ),
        light(
            "a light of range 0",
            json!({ "type": "point", "range": 0 }),
            json!({}),
            Gets::Repaired("/lights/0/range | 0 | at least"),
        ),
        light("a cone of no width", spot(0.0, 0.0), json!({}), Gets::Read),
        light(
            "a cone that is wider than all directions",
            spot(0.0, 7.0),
            json!({}),
            Gets::Repaired("/lights/0/spot/outerConeAngle | 7 | at most"),
        ),
        light("a light of an unknown kind", json!({ "type": 7 }), json!({}), Gets::Repaired("/lights/0 | left out")),
        light(
            "a light on a node without size",
            json!({ "type": "directional" }),
            json!({ "scale": [0, 0, 0] }),
            Gets::Read,
        ),
        Case::draft(
            "a node with a light that isn't there",
            &lit(json!([{ "type": "point" }]), &[own]),
            Gets::Repaired("/nodes/1/extensions/KHR_lights_punctual/light | 9 | 1"),
        ),
        Case::draft(
            "lights on 150,000 nodes",
            &lit(json!([{ "type": "point" }]), &vec![node; MANY]),
            Gets::Repaired("150000 lights | first 16"),
        ),
    ]
}

pub(super) fn cases() -> Vec<Case> {
    let mut cases = cameras();
    cases.extend(lights());
    cases
}
