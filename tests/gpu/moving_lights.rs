//! Pictures in the light of lights that a clip moves.

use std::f64::consts::FRAC_PI_6;

use base64::prelude::{BASE64_STANDARD, Engine as _};
use geometry::mesh::{Light, LightKind, Moment};
use geometry::progress::Progress;
use geometry::tessellate::{Surface, Tessellation};
use glam::{DQuat, Vec3, vec3};
use gpu::Timing;
use inspect::engine::{Loaded, Preparation, load};
use inspect::render::Target;
use inspect::render::punctual::PunctualLight;
use inspect::settings::{ARENA_BYTES, Lighting, Settings, ToneCurve};
use load::Source;
use serde_json::{Value, json};

use crate::environment::{SIDE, assert_lit_by, before_a_square, unlit_engine};

/// Where the node that the point light hangs on is at 0 and at 1 s, and where the light is on it.
const PATH: [Vec3; 2] = [vec3(-0.5, 0.25, 0.0), vec3(0.5, -0.25, 0.25)];
const HUNG: Vec3 = vec3(0.0, 0.25, 0.5);
/// The place of a spot light, which the clip turns around Y from minus to plus this angle.
const SPOT: Vec3 = vec3(0.0, -0.5, 1.0);
const TURN: f64 = FRAC_PI_6;

/// A buffer that is being filled, and what describes it.
#[derive(Default)]
struct Lists {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Lists {
    fn floats(&mut self, kind: &str, count: usize, values: &[f32]) -> usize {
        let (offset, bytes) = (self.bytes.len(), bytemuck::cast_slice::<_, u8>(values));
        self.bytes.extend_from_slice(bytes);
        self.views.push(json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() }));
        let view = self.views.len() - 1;
        self.accessors.push(json!({ "bufferView": view, "componentType": 5126, "type": kind, "count": count }));
        self.accessors.len() - 1
    }
}

/// A matte square from -1 to 1 in the plane z = 0, a point light that a clip moves with the node above its own, and a spot light
/// that the clip turns.
fn document() -> Value {
    let mut lists = Lists::default();
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, -1.0], [1.0, 1.0], [-1.0, 1.0_f32]];
    let positions = lists.floats("VEC3", 6, corners.map(|[x, y]| [x, y, 0.0]).as_flattened());
    let normals = lists.floats("VEC3", 6, [[0.0, 0.0, 1.0]; 6].as_flattened());
    let times = lists.floats("SCALAR", 2, &[0.0, 1.0]);
    let path = lists.floats("VEC3", 2, PATH.map(|place| place.to_array()).as_flattened());
    let turns = [-TURN, TURN].map(|angle| DQuat::from_rotation_y(angle).as_quat().to_array());
    let turns = lists.floats("VEC4", 2, turns.as_flattened());
    let on_node = |light: usize| json!({ "KHR_lights_punctual": { "light": light } });
    json!({
        "asset": { "version": "2.0" },
        "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_specular"],
        "extensions": { "KHR_lights_punctual": { "lights": [
            { "type": "point", "intensity": 0.8, "color": [1.0, 0.5, 0.25] },
            { "type": "spot", "intensity": 2.0, "color": [0.0, 0.5, 1.0],
              "spot": { "innerConeAngle": 0.2, "outerConeAngle": 0.5 } },
        ] } },
        "scene": 0,
        "scenes": [{ "nodes": [0, 1, 3] }],
        "nodes": [
            { "mesh": 0 },
            { "children": [2] },
            { "translation": HUNG.to_array(), "extensions": on_node(0) },
            { "translation": SPOT.to_array(), "extensions": on_node(1) },
        ],
        "animations": [{
            "samplers": [{ "input": times, "output": path }, { "input": times, "output": turns }],
            "channels": [
                { "sampler": 0, "target": { "node": 1, "path": "translation" } },
                { "sampler": 1, "target": { "node": 3, "path": "rotation" } },
            ],
        }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": positions, "NORMAL": normals }, "material": 0 }] }],
        "materials": [{
            "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.5, 0.5, 1.0], "metallicFactor": 0.0 },
            "extensions": { "KHR_materials_specular": { "specularFactor": 0.0 } },
        }],
        "accessors": lists.accessors,
        "bufferViews": lists.views,
        "buffers": [{
            "byteLength": lists.bytes.len(),
            "uri": format!("data:application/octet-stream;base64,{}", BASE64_STANDARD.encode(&lists.bytes)),
        }],
    })
}

fn loaded() -> Loaded {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("lights.gltf");
    std::fs::write(&path, document().to_string()).expect("a writable temporary folder");
    let loaded = load(&Source::File(path), &Preparation::default(), &Progress::default()).expect("a square");
    assert_eq!(loaded.warnings, Vec::<String>::new());
    loaded
}

/// Both lights with the point light's node here, and the spot light turned around Y by an angle.
fn lights_at(node: Vec3, turn: f64) -> [PunctualLight; 2] {
    let spot = LightKind::Spot { range: None, inner: 0.2, outer: 0.5 };
    let direction = (DQuat::from_rotation_y(turn) * -glam::DVec3::Z).as_vec3();
    let light = |kind, intensity, place, direction| Light { kind, intensity, place, direction };
    [
        light(LightKind::Point { range: None }, 0.8 * vec3(1.0, 0.5, 0.25), node + HUNG, Vec3::NEG_Z),
        light(spot, 2.0 * vec3(0.0, 0.5, 1.0), SPOT, direction),
    ]
    .map(|light| PunctualLight::from(&light))
}

/// At each moment every pixel has the colour that the formula gives for lights where the clip's key frames have them.
#[test]
fn lights_shine_from_where_a_clip_has_them() {
    let (engine, loaded) = (unlit_engine(), loaded());
    let mut scene = engine.scene(&loaded, ARENA_BYTES).expect("a small mesh");
    let target = Target::new(&engine.gpu, [SIDE; 2]).expect("a small picture");
    let camera = before_a_square(&scene, &target, false);
    let tessellation = Tessellation { surface: Surface::Flat, factor: 3.0, ..Tessellation::default() };
    let settings = Settings { lighting: Lighting::Studio, tone_curve: ToneCurve::None, ..Settings::from(tessellation) };
    let mut brightest = Vec::new();
    for time in [None, Some(0.0), Some(0.25), Some(0.5), Some(1.0)] {
        scene.set_moment(time.map(|time| Moment { clip: 0, time })).expect("a small rig");
        engine.draw(&mut scene, &target, &camera, &settings, &mut Timing::Off).expect("a draw");
        let picture = target.read(&engine.gpu).expect("a readback");
        let lights = match time {
            Some(time) => lights_at(PATH[0].lerp(PATH[1], time as f32), TURN * (2.0 * time - 1.0)),
            None => lights_at(Vec3::ZERO, 0.0),
        };
        assert_lit_by(&picture, &lights, |_| false, &format!("{time:?} s"));
        let reddest = picture.enumerate_pixels().max_by_key(|(.., pixel)| pixel.0[0]);
        brightest.extend(reddest.map(|(x, ..)| x));
    }
    let [_, start, .., end] = brightest[..] else { panic!("{brightest:?}") };
    assert!(start < 24 && end > 40, "the point light goes from left to right: {brightest:?}");
}
