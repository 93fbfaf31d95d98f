//! Lights of documents: where they are, how they shine, and what is wrong with some.

use super::*;
use geometry::mesh::{Light, LightKind, Moment};

/// A triangle with these lights, each on a node of its own.
pub(super) fn lit(lights: Value, nodes: &[Value]) -> Draft {
    let mut draft = triangle();
    draft.root["extensions"] = json!({ "KHR_lights_punctual": { "lights": lights } });
    let first = draft.root["nodes"].as_array().expect("nodes").len();
    let all = draft.root["nodes"].as_array_mut().expect("nodes");
    all.extend(nodes.iter().cloned());
    let count = all.len();
    if let Some(shown) = draft.root["scenes"][0]["nodes"].as_array_mut() {
        shown.extend((first..count).map(|node| json!(node)));
    }
    draft
}

/// A node with a light.
fn node(light: usize, more: Value) -> Value {
    let mut node = json!({ "extensions": { "KHR_lights_punctual": { "light": light } } });
    more.as_object().expect("members").iter().for_each(|(name, value)| node[name] = value.clone());
    node
}

/// A document with a light of each kind.
pub(super) fn of_every_kind() -> Draft {
    let lights = json!([
        { "type": "directional", "color": [1, 0.5, 0], "intensity": 4, "name": "sun" },
        { "type": "point", "intensity": 10, "range": 3 },
        { "type": "spot", "spot": { "innerConeAngle": 0.25, "outerConeAngle": 0.5 } },
    ]);
    let turned = json!({ "rotation": [-0.707_106_77, 0, 0, 0.707_106_77], "scale": [1, 2, 3] });
    let placed = json!({ "translation": [1, 2, 3], "scale": [5, 5, 5] });
    lit(lights, &[node(0, turned), node(1, placed), node(2, json!({}))])
}

#[test]
fn lights_have_the_place_and_the_direction_of_their_nodes() {
    let loaded = of_every_kind().read().expect("a mesh");
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    let [sun, bulb, spot] = &loaded.mesh.lights[..] else { panic!("{:?}", loaded.mesh.lights) };
    assert_eq!((sun.kind, sun.intensity), (LightKind::Directional, Vec3::new(4.0, 2.0, 0.0)));
    assert!(sun.direction.distance(Vec3::NEG_Y) < 1e-6, "{}", sun.direction);
    let expected = Light {
        kind: LightKind::Point { range: Some(3.0) },
        intensity: Vec3::splat(10.0),
        place: Vec3::new(1.0, 2.0, 3.0),
        direction: Vec3::NEG_Z,
    };
    assert_eq!(*bulb, expected);
    assert_eq!(spot.kind, LightKind::Spot { range: None, inner: 0.25, outer: 0.5 });
    assert_eq!((spot.intensity, spot.direction), (Vec3::ONE, Vec3::NEG_Z));
}

#[test]
fn a_document_without_lights_or_with_lights_on_no_node_has_none() {
    assert_eq!(triangle().read().expect("a mesh").mesh.lights, []);
    let unused = lit(json!([{ "type": "point" }]), &[]).read().expect("a mesh");
    assert_eq!((unused.mesh.lights, unused.warnings), (Vec::new(), Vec::new()));
}

/// The lights of a triangle with this light, and the warnings.
fn read_one(light: Value) -> (Vec<Light>, Vec<String>) {
    let loaded = lit(json!([light]), &[node(0, json!({}))]).read().expect("lights never keep a mesh from loading");
    (loaded.mesh.lights, loaded.warnings)
}

#[test]
fn faults_cost_a_light_or_a_number_and_never_the_mesh() {
    let none: [(Value, &str); 3] = [
        (json!({ "type": "area" }), "lights/0 isn't a directional, a point or a spot light; it is left out."),
        (json!({}), "isn't a directional"),
        (json!(7), "lights/0 is 7, not an object; it is left out."),
    ];
    for (light, said) in none {
        let (lights, warnings) = read_one(light);
        assert!(lights.is_empty() && warnings.iter().any(|warning| warning.contains(said)), "{warnings:?}");
    }
    let mended = [
        (json!({ "type": "point", "intensity": -3 }), "intensity is -3, but must be at least 0.0; 0 is used."),
        (json!({ "type": "point", "color": [2, 1, 1] }), "color/0 is 2, but must be at most 1.0; 1 is used."),
        (json!({ "type": "point", "range": "far" }), "range is \"far\", not a number; 1 is used."),
        (
            json!({ "type": "spot", "spot": { "innerConeAngle": 0.5, "outerConeAngle": 0.25 } }),
            "lights/0 has an inner cone that is wider than the outer one; the outer one is used for both.",
        ),
    ];
    for (light, said) in mended {
        let (lights, warnings) = read_one(light);
        assert!(lights.len() == 1 && warnings.iter().any(|warning| warning.contains(said)), "{warnings:?}");
    }
    let mut missing = lit(json!([{ "type": "point" }]), &[node(3, json!({}))]);
    let loaded = missing.read().expect("a mesh");
    let said = "/nodes/1/extensions/KHR_lights_punctual/light is 3, but /extensions/KHR_lights_punctual/lights has 1";
    assert!(loaded.mesh.lights.is_empty() && loaded.warnings[0].starts_with(said), "{:?}", loaded.warnings);
    missing.root["extensions"]["KHR_lights_punctual"]["lights"] = json!(5);
    assert!(missing.read().expect("a mesh").warnings[0].contains("lights isn't a list; there are no lights."));
}

#[test]
fn of_many_lights_the_first_sixteen_shine() {
    let nodes: Vec<Value> = (0..40).map(|x| node(0, json!({ "translation": [x, 0, 0] }))).collect();
    let loaded = lit(json!([{ "type": "point" }]), &nodes).read().expect("a mesh");
    assert_eq!(loaded.mesh.lights.iter().map(|light| light.place.x).sum::<f32>(), 120.0);
    assert_eq!(loaded.warnings, ["The scene has 40 lights, of which only the first 16 shine."]);
}

/// A document with two lights and a camera. A clip moves a light, turns the camera, and moves their parent, but neither the other light nor
/// the triangle.
fn moving() -> Draft {
    let lights = json!([{ "type": "point", "intensity": 10 }, { "type": "spot" }]);
    let camera = json!({ "camera": 0, "name": "Shot" });
    let mut draft = lit(lights, &[node(0, json!({})), node(1, json!({ "translation": [0, 0, 1] })), camera]);
    draft.root["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.1 } }]);
    let nodes = draft.root["nodes"].as_array_mut().expect("nodes");
    let first = nodes.len() - 3;
    nodes.push(json!({ "children": [first, first + 2], "scale": [2, 2, 2] }));
    let parent = nodes.len() - 1;
    draft.root["scenes"][0]["nodes"] = json!([0, first + 1, parent]);
    let times = draft.floats("SCALAR", &[0.0, 1.0]);
    draft.root["accessors"][times]["min"] = json!([0.0]);
    draft.root["accessors"][times]["max"] = json!([1.0]);
    let places = draft.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 2.0, 3.0]);
    let turns = draft.floats("VEC4", &[0.0, 0.0, 0.0, 1.0, -0.707_106_77, 0.0, 0.0, 0.707_106_77]);
    let sampler = |output: usize| json!({ "input": times, "output": output });
    let channel = |node: usize, path: &str, sampler: usize| json!({ "sampler": sampler, "target": { "node": node, "path": path } });
    draft.root["animations"] = json!([{
        "samplers": [sampler(places), sampler(turns)],
        "channels": [
            channel(first, "translation", 0),
            channel(first + 2, "rotation", 1),
            channel(parent, "translation", 0),
        ],
    }]);
    draft
}

#[test]
fn lights_and_cameras_move_with_their_nodes() {
    let loaded = moving().read().expect("a mesh");
    assert_eq!(loaded.warnings, Vec::<String>::new());
    let mesh = &loaded.mesh;
    let rig = mesh.rig.as_ref().expect("a clip moves something that is shown");
    let at = |time| rig.pose(Moment { clip: 0, time });
    assert_eq!((mesh.lights_in(&at(0.0)), mesh.cameras_in(&at(0.0))), (mesh.lights.clone(), mesh.cameras.clone()));
    let [bulb, still] = mesh.lights_in(&at(1.0))[..] else { panic!("two lights") };
    // The node moves by (1, 2, 3), scaled by two, and so does its parent, in the scene.
    assert_eq!((bulb.place, bulb.intensity), (Vec3::new(3.0, 6.0, 9.0), Vec3::splat(10.0)));
    assert_eq!((still, still.place), (mesh.lights[1], Vec3::Z));
    let [camera] = &mesh.cameras_in(&at(1.0))[..] else { panic!("one camera") };
    assert_eq!((camera.eye, &*camera.name), (Vec3::new(1.0, 2.0, 3.0), "Shot"));
    let [right, up, back] = camera.axes;
    assert!(right.abs_diff_eq(Vec3::X, 1e-6) && up.abs_diff_eq(Vec3::NEG_Z, 1e-6), "{right} {up}");
    assert!(back.abs_diff_eq(Vec3::Y, 1e-6), "it looks down: {back}");
    assert_eq!(mesh.cameras_at(Some(Moment { clip: 0, time: 1.0 })), mesh.cameras_in(&at(1.0)));
}

/// Vertices without data in the file take memory that the file's size doesn't pay for.
#[test]
fn a_mesh_that_leaves_no_room_for_a_rig_loads_without_the_motion_of_its_lights() {
    let mut draft = moving();
    let zeros = draft.push("accessors", json!({ "componentType": 5126, "type": "VEC3", "count": 2_400_000 }));
    draft.primitive(json!({ "attributes": { "POSITION": zeros } }));
    let loaded = draft.read().expect("it fits without a rig");
    assert!(loaded.mesh.rig.is_none() && loaded.mesh.lights.len() == 2);
    assert!(loaded.warnings.iter().any(|said| said.contains("move only lights and cameras")), "{:?}", loaded.warnings);
}
