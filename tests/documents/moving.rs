//! A small animated glTF document, which tests write and then read. It has a square beam with split normals and uv seams, which
//! two joints bend and two morph targets swell, and beside it an octahedron that flies.

use serde_json::{Value, json};

/// The names of the clips.
pub const CLIPS: [&str; 4] = ["Bend", "Swell", "Fly", "All"];

/// The names of the morph targets, whose weights at rest are 0.25 and 0.
pub const TARGETS: [&str; 2] = ["Swell", "Lean"];

#[derive(Default)]
struct Writer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Writer {
    fn accessor(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        let offset = self.bytes.len();
        self.bytes.extend_from_slice(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() }));
        let view = self.views.len() - 1;
        self.accessors.push(json!({ "bufferView": view, "componentType": component, "type": kind, "count": count }));
        self.accessors.len() - 1
    }

    fn floats<const N: usize>(&mut self, kind: &str, values: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = values.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
        self.accessor(&bytes, 5126, kind, values.len())
    }

    fn sampler(&mut self, times: &[f32], output: usize, interpolation: &str) -> Value {
        let times: Vec<[f32; 1]> = times.iter().map(|&time| [time]).collect();
        json!({ "input": self.floats("SCALAR", &times), "output": output, "interpolation": interpolation })
    }
}

/// The whole document as a .glb file.
pub fn moving() -> Vec<u8> {
    let mut writer = Writer::default();
    let bending = json!({ "primitives": [beam(&mut writer)], "extras": { "targetNames": TARGETS } });
    let meshes = json!([bending, { "primitives": [octahedron(&mut writer)] }]);
    let animations = animations(&mut writer);
    let root = json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0, 1, 3] }],
        "nodes": [
            { "mesh": 0, "skin": 0, "weights": [0.25, 0.0] },
            { "children": [2] },
            { "name": "Tip", "translation": [0.0, 2.0, 0.0] },
            { "children": [4] },
            { "mesh": 1, "translation": [3.0, 1.0, 0.0], "scale": [1.0, 2.0, 0.5] },
        ],
        "meshes": meshes,
        "skins": [{ "joints": [1, 2], "inverseBindMatrices": inverse_binds(&mut writer) }],
        "animations": animations,
        "buffers": [{ "byteLength": writer.bytes.len() }],
        "bufferViews": writer.views,
        "accessors": writer.accessors,
    });
    glb(&root, writer.bytes)
}

fn glb(root: &Value, bytes: Vec<u8>) -> Vec<u8> {
    let mut json = root.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let length = |bytes: &[u8]| (bytes.len() as u32).to_le_bytes();
    let total = (12 + 8 + json.len() + 8 + bytes.len()) as u32;
    let header = [&b"glTF"[..], &2_u32.to_le_bytes(), &total.to_le_bytes()].concat();
    [&header, &length(&json)[..], b"JSON", &json, &length(&bytes), b"BIN\0", &bytes].concat()
}

/// The four corners of every face, which faces don't share.
fn faces() -> Vec<[[f32; 3]; 4]> {
    let ring = |y: f32| [[-0.5, y, -0.5], [0.5, y, -0.5], [0.5, y, 0.5], [-0.5, y, 0.5]];
    let mut faces = Vec::new();
    for level in 0..4 {
        let (low, high) = (ring(level as f32), ring(level as f32 + 1.0));
        faces.extend((0..4).map(|k| [low[k], high[k], high[(k + 1) % 4], low[(k + 1) % 4]]));
    }
    let ([a, b, c, d], [e, f, g, h]) = (ring(0.0), ring(4.0));
    faces.extend([[a, b, c, d], [h, g, f, e]]);
    faces
}

fn beam(writer: &mut Writer) -> Value {
    let faces = faces();
    let positions: Vec<[f32; 3]> = faces.iter().flatten().copied().collect();
    let facing = |[a, b, c, _]: &[[f32; 3]; 4]| {
        let [a, b, c] = [a, b, c].map(|p| glam::Vec3::from(*p));
        (b - a).cross(c - a).normalize().to_array()
    };
    let normals: Vec<[f32; 3]> = faces.iter().flat_map(|face| [facing(face); 4]).collect();
    let uvs = [[0.0, 1.0], [0.0, 0.0], [1.0, 0.0], [1.0, 1.0]].repeat(faces.len());
    let bend = |[_, y, _]: &[f32; 3]| ((y - 1.0) / 2.0).clamp(0.0, 1.0);
    let weights: Vec<[f32; 4]> = positions.iter().map(|p| [1.0 - bend(p), bend(p), 0.0, 0.0]).collect();
    let swell: Vec<[f32; 3]> = positions.iter().map(|[x, y, z]| [x * y * 0.2, 0.0, z * y * 0.2]).collect();
    let lean: Vec<[f32; 3]> = positions.iter().map(|[_, y, _]| [0.3 * y, 0.0, 0.0]).collect();
    let turn: Vec<[f32; 3]> = normals.iter().map(|[x, _, z]| [0.0, -0.3 * (x.abs() + z.abs()), 0.0]).collect();
    let indices: Vec<u8> = (0..faces.len() as u8).flat_map(|f| [0, 1, 2, 0, 2, 3].map(|k| 4 * f + k)).collect();
    json!({
        "attributes": {
            "POSITION": writer.floats("VEC3", &positions),
            "NORMAL": writer.floats("VEC3", &normals),
            "TEXCOORD_0": writer.floats("VEC2", &uvs),
            "JOINTS_0": writer.accessor(&[0, 1, 0, 0].repeat(positions.len()), 5121, "VEC4", positions.len()),
            "WEIGHTS_0": writer.floats("VEC4", &weights),
        },
        "indices": writer.accessor(&indices, 5121, "SCALAR", indices.len()),
        "targets": [
            { "POSITION": writer.floats("VEC3", &swell), "NORMAL": writer.floats("VEC3", &turn) },
            { "POSITION": writer.floats("VEC3", &lean) },
        ],
    })
}

/// A primitive without normals, which loading makes.
fn octahedron(writer: &mut Writer) -> Value {
    let axis = |i: usize, x: f32| std::array::from_fn(|k| if k == i { x } else { 0.0 });
    let positions: Vec<[f32; 3]> = [1.0, -1.0].into_iter().flat_map(|x| [axis(0, x), axis(1, x), axis(2, x)]).collect();
    let mut indices: Vec<u8> = Vec::new();
    for octant in 0..8 {
        let [x, y, z] = [0, 1, 2].map(|axis| if octant >> axis & 1 == 0 { axis } else { axis + 3 });
        let mirrored = (octant as u32).count_ones() % 2 == 1;
        indices.extend(if mirrored { [x, z, y] } else { [x, y, z] });
    }
    json!({
        "attributes": { "POSITION": writer.floats("VEC3", &positions) },
        "indices": writer.accessor(&indices, 5121, "SCALAR", indices.len()),
    })
}

fn inverse_binds(writer: &mut Writer) -> usize {
    let binds = [glam::Mat4::IDENTITY, glam::Mat4::from_translation(glam::vec3(0.0, -2.0, 0.0))];
    writer.floats("MAT4", &binds.map(|bind| bind.to_cols_array()))
}

fn animations(writer: &mut Writer) -> Value {
    let about = |axis: glam::Vec3, degrees: f32| glam::Quat::from_axis_angle(axis, degrees.to_radians()).to_array();
    let bent = about(glam::Vec3::Z, 80.0);
    // The last quaternion is the first with its signs reversed, which is the same rotation.
    let bend = writer.floats("VEC4", &[about(glam::Vec3::Z, 0.0), bent, [0.0, 0.0, 0.0, -1.0]]);
    // The in-tangent, value and out-tangent of both targets at two keys.
    let swell = [[0.0, 0.0], [0.0, 0.0], [2.0, 0.0], [0.0, 0.0], [1.0, -1.0], [0.0, 0.0]].as_flattened().to_vec();
    let swell = writer.floats("SCALAR", &swell.into_iter().map(|x: f32| [x]).collect::<Vec<_>>());
    let hop = writer.floats("VEC3", &[[0.0; 3], [0.0, 1.5, 0.0], [-1.0, 0.0, 2.0]]);
    let turn = writer.floats("VEC4", &[about(glam::Vec3::Y, 0.0), about(glam::Vec3::ONE.normalize(), 150.0)]);
    let grow = writer.floats("VEC3", &[[1.0; 3], [2.0, 0.5, 1.0]]);
    let bend = writer.sampler(&[0.0, 0.5, 1.0], bend, "LINEAR");
    let swell = writer.sampler(&[0.0, 1.5], swell, "CUBICSPLINE");
    let fly = [
        writer.sampler(&[0.0, 0.75, 2.0], hop, "STEP"),
        writer.sampler(&[0.25, 2.0], turn, "LINEAR"),
        writer.sampler(&[0.0, 2.0], grow, "LINEAR"),
    ];
    let channel =
        |sampler: usize, node: u32, path: &str| json!({ "sampler": sampler, "target": { "node": node, "path": path } });
    let flies = |first: usize| {
        [channel(first, 3, "translation"), channel(first + 1, 3, "rotation"), channel(first + 2, 3, "scale")].to_vec()
    };
    let all = [vec![bend.clone(), swell.clone()], fly.to_vec()].concat();
    let moves_all = [vec![channel(0, 2, "rotation"), channel(1, 0, "weights")], flies(2)].concat();
    json!([
        { "name": CLIPS[0], "samplers": [bend], "channels": [channel(0, 2, "rotation")] },
        { "name": CLIPS[1], "samplers": [swell], "channels": [channel(0, 0, "weights")] },
        { "name": CLIPS[2], "samplers": fly, "channels": flies(0) },
        { "name": CLIPS[3], "samplers": all, "channels": moves_all },
    ])
}
