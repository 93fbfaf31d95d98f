//! Small glTF documents, each about one part of materials, which tests write and then read. Other viewers can read them too.

use std::f32::consts::{PI, TAU};
use std::io::Cursor;

use image::{ImageFormat, Rgba, RgbaImage};
use serde_json::{Value, json};

/// A document as a .glb file.
pub struct MaterialScene {
    /// What it is about.
    pub name: &'static str,
    pub glb: Vec<u8>,
}

/// Adds to a document what its scene is about.
type Feature = fn(&mut Document);

/// All of them.
pub fn material_scenes() -> Vec<MaterialScene> {
    let all: [(&str, Feature); 15] = [
        ("alpha-modes", alpha_modes),
        ("mirrored-normals", mirrored_normals),
        ("two-uv-sets", two_uv_sets),
        ("clear-coat", clear_coat),
        ("transmission", transmission),
        ("emissive-strength", emissive_strength),
        ("texture-transform", texture_transform),
        ("vertex-colours", vertex_colors),
        ("double-sided", double_sided),
        ("unlit", unlit),
        ("specular-ior", specular_and_ior),
        ("metal-and-roughness", metal_and_roughness),
        ("specular-glossiness", specular_and_glossiness),
        ("coat-and-specular-maps", coat_and_specular_maps),
        ("floor", floor),
    ];
    let made = all.into_iter().map(|(name, fill)| {
        let mut document = Document::default();
        fill(&mut document);
        MaterialScene { name, glb: document.finish() }
    });
    made.collect()
}

/// A panorama as a Radiance file: three lamps in grey surroundings of radiance 0.5.
pub fn three_lamps() -> Vec<u8> {
    const SIZE: [u32; 2] = [256, 128];
    /// Columns and rows of a lamp, and the mantissa and the exponent of its radiance: 8, 4 and 6.
    const LAMPS: [([u32; 4], [u8; 2]); 3] =
        [([100, 140, 16, 36], [128, 132]), ([30, 50, 40, 70], [128, 131]), ([200, 230, 50, 60], [192, 131])];
    let mut file = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", SIZE[1], SIZE[0]).into_bytes();
    for (y, x) in (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (y, x))) {
        let holds = |[left, right, top, bottom]: [u32; 4]| (left..right).contains(&x) && (top..bottom).contains(&y);
        let lamp = LAMPS.into_iter().find(|(place, _)| holds(*place));
        let [mantissa, exponent] = lamp.map_or([128, 128], |(_, radiance)| radiance);
        file.extend([mantissa, mantissa, mantissa, exponent]);
    }
    file
}

/// A document that is being made. Every shape is a mesh of its own at the scene's root.
#[derive(Default)]
struct Document {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    images: Vec<Value>,
    materials: Vec<Value>,
    meshes: Vec<Value>,
}

/// The corners of a shape, and its triangles.
#[derive(Default)]
struct Corners {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    /// Up to two sets of texture coordinates.
    uvs: Vec<Vec<[f32; 2]>>,
    triangles: Vec<[u16; 3]>,
}

impl Document {
    fn view(&mut self, bytes: &[u8]) -> usize {
        let offset = self.bytes.len();
        self.bytes.extend_from_slice(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() }));
        self.views.len() - 1
    }

    fn floats<const N: usize>(&mut self, kind: &str, values: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = values.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
        let view = self.view(&bytes);
        let mut accessor = json!({ "bufferView": view, "componentType": 5126, "type": kind, "count": values.len() });
        if N == 3 {
            let ends = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
                (0..N).map(|axis| values.iter().map(|value| value[axis]).reduce(pick).unwrap_or(0.0)).collect()
            };
            accessor["min"] = json!(ends(f32::min));
            accessor["max"] = json!(ends(f32::max));
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Adds a texture with an image of this size, and returns its index.
    fn texture(&mut self, size: [u32; 2], texel: impl Fn(u32, u32) -> [u8; 4]) -> usize {
        let picture = RgbaImage::from_fn(size[0], size[1], |x, y| Rgba(texel(x, y)));
        let mut png = Cursor::new(Vec::new());
        picture.write_to(&mut png, ImageFormat::Png).expect("memory takes what is written");
        let view = self.view(png.get_ref());
        self.images.push(json!({ "bufferView": view, "mimeType": "image/png" }));
        self.images.len() - 1
    }

    /// Adds a material, and returns its index.
    fn material(&mut self, material: Value) -> usize {
        self.materials.push(material);
        self.materials.len() - 1
    }

    /// Adds a shape. `more` are further attributes of its corners: their names, and their accessors.
    fn shape(&mut self, corners: &Corners, material: usize, more: &[(&str, usize)]) {
        let mut attributes = json!({
            "POSITION": self.floats("VEC3", &corners.positions),
            "NORMAL": self.floats("VEC3", &corners.normals),
        });
        for (set, uvs) in corners.uvs.iter().enumerate() {
            attributes[format!("TEXCOORD_{set}")] = json!(self.floats("VEC2", uvs));
        }
        for (name, accessor) in more {
            attributes[*name] = json!(accessor);
        }
        let indices: Vec<u8> = corners.triangles.iter().flatten().flat_map(|index| index.to_le_bytes()).collect();
        let view = self.view(&indices);
        let count = 3 * corners.triangles.len();
        self.accessors.push(json!({ "bufferView": view, "componentType": 5123, "type": "SCALAR", "count": count }));
        let indices = self.accessors.len() - 1;
        let primitive = json!({ "attributes": attributes, "indices": indices, "material": material });
        self.meshes.push(json!({ "primitives": [primitive] }));
    }

    fn finish(mut self) -> Vec<u8> {
        let nodes: Vec<Value> = (0..self.meshes.len()).map(|mesh| json!({ "mesh": mesh })).collect();
        let all: Vec<usize> = (0..nodes.len()).collect();
        let textures: Vec<Value> =
            (0..self.images.len()).map(|source| json!({ "source": source, "sampler": 0 })).collect();
        let mut root = json!({
            "asset": { "version": "2.0" },
            "scene": 0,
            "scenes": [{ "nodes": all }],
            "nodes": nodes,
            "meshes": self.meshes,
            "materials": self.materials,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{ "byteLength": self.bytes.len() }],
        });
        if !textures.is_empty() {
            root["textures"] = json!(textures);
            root["images"] = json!(self.images);
            root["samplers"] = json!([{ "magFilter": 9729, "minFilter": 9987 }]);
        }
        let used = extensions(&root);
        if !used.is_empty() {
            root["extensionsUsed"] = json!(used);
        }
        glb(&root, std::mem::take(&mut self.bytes))
    }
}

/// The names of all extensions in a document.
fn extensions(value: &Value) -> Vec<String> {
    let mut names: Vec<String> = match value {
        Value::Object(members) => {
            let own = members.get("extensions").and_then(Value::as_object);
            let own = own.into_iter().flat_map(|own| own.keys().cloned());
            own.chain(members.values().flat_map(extensions)).collect()
        }
        Value::Array(values) => values.iter().flat_map(extensions).collect(),
        _ => Vec::new(),
    };
    names.sort();
    names.dedup();
    names
}

fn glb(root: &Value, bytes: Vec<u8>) -> Vec<u8> {
    let mut json = root.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let length = |bytes: &[u8]| (bytes.len() as u32).to_le_bytes();
    let total = (12 + 8 + json.len() + 8 + bytes.len()) as u32;
    let header = [&b"glTF"[..], &2_u32.to_le_bytes(), &total.to_le_bytes()].concat();
    [&header, &length(&json)[..], b"JSON", &json, &length(&bytes), b"BIN\0", &bytes].concat()
}

/// A ball of radius 1, with texture coordinates by longitude and latitude.
fn ball(middle: [f32; 3]) -> Corners {
    const AROUND: u16 = 32;
    const DOWN: u16 = 16;
    let mut ball = Corners { uvs: vec![Vec::new()], ..Corners::default() };
    for row in 0..=DOWN {
        for column in 0..=AROUND {
            let [u, v] = [f32::from(column) / f32::from(AROUND), f32::from(row) / f32::from(DOWN)];
            let ((sin, cos), (level, height)) = ((TAU * u).sin_cos(), (PI * v).sin_cos());
            let normal = [-sin * level, height, -cos * level];
            ball.normals.push(normal);
            ball.positions.push([0, 1, 2].map(|axis| middle[axis] + normal[axis]));
            ball.uvs[0].push([u, v]);
        }
    }
    for row in 0..DOWN {
        for column in 0..AROUND {
            let first = row * (AROUND + 1) + column;
            let below = first + AROUND + 1;
            // At each pole, one of a quad's triangles would have no area.
            if row > 0 {
                ball.triangles.push([first, below + 1, first + 1]);
            }
            if row + 1 < DOWN {
                ball.triangles.push([first, below, below + 1]);
            }
        }
    }
    ball
}

/// A flat rectangle across z, which faces +z; `extent` are its least and largest x and y. u goes right and v down, from 0 to 1.
fn sheet([left, bottom, right, top]: [f32; 4], z: f32) -> Corners {
    Corners {
        positions: vec![[left, bottom, z], [right, bottom, z], [right, top, z], [left, top, z]],
        normals: vec![[0.0, 0.0, 1.0]; 4],
        uvs: vec![vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }
}

/// A material of one colour with these numbers.
fn plain(color: [f32; 4], metallic: f32, roughness: f32) -> Value {
    json!({ "pbrMetallicRoughness": { "baseColorFactor": color, "metallicFactor": metallic, "roughnessFactor": roughness } })
}

/// A material with a base colour texture.
fn textured(texture: usize) -> Value {
    json!({ "pbrMetallicRoughness": {
        "baseColorTexture": { "index": texture }, "metallicFactor": 0.0, "roughnessFactor": 0.8
    } })
}

/// The same material with one more extension.
fn extended(mut material: Value, extension: &str, members: Value) -> Value {
    material["extensions"][extension] = members;
    material
}

const GRAY: [f32; 4] = [0.5, 0.5, 0.5, 1.0];

/// A gray wall, two blended sheets before it that overlap, and a masked one whose texture has holes.
fn alpha_modes(document: &mut Document) {
    let wall = document.material(plain(GRAY, 0.0, 0.8));
    document.shape(&sheet([-2.0, -1.5, 2.0, 1.5], 0.0), wall, &[]);
    // The nearer one comes first, so that a viewer has to sort them.
    for (color, extent, z) in
        [([0.1, 0.2, 0.9, 0.5], [-0.9, -1.2, 0.7, 0.4], 0.6), ([0.9, 0.1, 0.1, 0.5], [-1.7, -0.5, 0.0, 1.2], 0.3)]
    {
        let mut blended = plain(color, 0.0, 0.8);
        blended["alphaMode"] = json!("BLEND");
        let blended = document.material(blended);
        document.shape(&sheet(extent, z), blended, &[]);
    }
    let holes = document.texture([64, 64], |x, y| {
        let is_hole = (x / 16 + y / 16) % 2 == 0;
        [60, 200, 80, if is_hole { 0 } else { 255 }]
    });
    let mut masked = textured(holes);
    masked["alphaMode"] = json!("MASK");
    masked["alphaCutoff"] = json!(0.5);
    let masked = document.material(masked);
    document.shape(&sheet([0.5, -0.3, 1.8, 1.2], 0.3), masked, &[]);
}

/// Pyramids that stand out, as a normal map: on the left as the texture has them, on the right mirrored by texture coordinates. The
/// upper sheets leave their tangents to the reader, and the lower ones have tangents of their own. Light from above brightens the
/// upper sides of all pyramids.
fn mirrored_normals(document: &mut Document) {
    let bumps = document.texture([128, 128], |x, y| {
        let [across, up] = [(x % 64) as f32 - 31.5, 31.5 - (y % 64) as f32];
        let slope = 0.6;
        let normal = if across.abs().max(up.abs()) > 24.0 {
            [0.0, 0.0, 1.0]
        } else if across.abs() > up.abs() {
            [slope * across.signum(), 0.0, 1.0]
        } else {
            [0.0, slope * up.signum(), 1.0]
        };
        let length = (normal[0].powi(2) + normal[1].powi(2) + 1.0).sqrt();
        let [r, g, b] = normal.map(|part| (127.5 + 127.5 * part / length).round() as u8);
        [r, g, b, 255]
    });
    let mut bumpy = plain([0.7, 0.6, 0.5, 1.0], 0.0, 0.5);
    bumpy["normalTexture"] = json!({ "index": bumps });
    let bumpy = document.material(bumpy);
    for (row, has_tangents) in [false, true].into_iter().enumerate() {
        for (column, is_mirrored) in [false, true].into_iter().enumerate() {
            let [left, bottom] = [2.2 * column as f32, -2.2 * row as f32];
            let mut sheet = sheet([left, bottom, left + 2.0, bottom + 2.0], 0.0);
            // The tangent points where u grows, and with its sign and the normal it gives where v falls.
            let mut sign = 1.0;
            if is_mirrored {
                sheet.uvs[0].iter_mut().for_each(|uv| uv[0] = 1.0 - uv[0]);
                sign = -1.0;
            }
            let tangents = has_tangents.then(|| document.floats("VEC4", &[[sign, 0.0, 0.0, sign]; 4]));
            let more: Vec<_> = tangents.into_iter().map(|accessor| ("TANGENT", accessor)).collect();
            document.shape(&sheet, bumpy, &more);
        }
    }
}

/// A checker at the first texture coordinates, and at the second ones occlusion that darkens the lower half.
fn two_uv_sets(document: &mut Document) {
    let checker =
        document.texture([8, 8], |x, y| if (x + y) % 2 == 0 { [230, 200, 60, 255] } else { [60, 90, 200, 255] });
    let shade = document.texture([1, 64], |_, y| [if y < 32 { 255 } else { 40 }, 255, 0, 255]);
    let mut material = textured(checker);
    material["occlusionTexture"] = json!({ "index": shade, "texCoord": 1 });
    let material = document.material(material);
    let mut sheet = sheet([-1.5, -1.0, 1.5, 1.0], 0.0);
    let second = sheet.uvs[0].clone();
    sheet.uvs[0].iter_mut().for_each(|uv| uv[0] *= 1.5);
    sheet.uvs.push(second);
    document.shape(&sheet, material, &[]);
}

/// Rough red balls: without a coat, with a smooth and with a rough one, and with half of a smooth one.
fn clear_coat(document: &mut Document) {
    let coats = [
        json!({ "clearcoatFactor": 0.0 }),
        json!({ "clearcoatFactor": 1.0 }),
        json!({ "clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.5 }),
        json!({ "clearcoatFactor": 0.5 }),
    ];
    for (place, coat) in coats.into_iter().enumerate() {
        let base = plain([0.6, 0.05, 0.03, 1.0], 0.0, 0.9);
        let material = document.material(extended(base, "KHR_materials_clearcoat", coat));
        document.shape(&ball([2.2 * place as f32, 0.0, 0.0]), material, &[]);
    }
}

/// A checkered wall, seen through a clear and an amber ball.
fn transmission(document: &mut Document) {
    let checker =
        document.texture([16, 8], |x, y| if (x + y) % 2 == 0 { [220, 220, 220, 255] } else { [40, 40, 40, 255] });
    let wall = document.material(textured(checker));
    document.shape(&sheet([-2.4, -1.2, 2.4, 1.2], -1.5), wall, &[]);
    for (x, color) in [(-1.1, [1.0; 4]), (1.1, [0.9, 0.5, 0.1, 1.0])] {
        let glass =
            extended(plain(color, 0.0, 0.0), "KHR_materials_transmission", json!({ "transmissionFactor": 1.0 }));
        let glass = document.material(glass);
        document.shape(&ball([x, 0.0, 0.0]), glass, &[]);
    }
}

/// Black balls that emit orange light: none, a half, all, and four times as much.
fn emissive_strength(document: &mut Document) {
    for (place, strength) in [0.0, 0.5, 1.0, 4.0].into_iter().enumerate() {
        let mut material = plain([0.0, 0.0, 0.0, 1.0], 0.0, 1.0);
        material["emissiveFactor"] = json!([0.8, 0.3, 0.05]);
        let strength = json!({ "emissiveStrength": strength });
        let material = document.material(extended(material, "KHR_materials_emissive_strength", strength));
        document.shape(&ball([2.2 * place as f32, 0.0, 0.0]), material, &[]);
    }
}

/// A texture with a corner of its own colour on four sheets: as it is, moved, turned by a quarter, and scaled.
fn texture_transform(document: &mut Document) {
    let corners = document.texture([64, 64], |x, y| match (x < 32, y < 32) {
        (true, true) => [220, 40, 40, 255],
        (false, true) => [40, 180, 60, 255],
        (true, false) => [50, 90, 220, 255],
        (false, false) => [235, 220, 60, 255],
    });
    let transforms = [
        json!({}),
        json!({ "offset": [0.25, 0.0] }),
        json!({ "rotation": PI / 2.0, "offset": [0.0, 1.0] }),
        json!({ "scale": [2.0, 3.0] }),
    ];
    for (place, transform) in transforms.into_iter().enumerate() {
        let mut material = textured(corners);
        let info = &mut material["pbrMetallicRoughness"]["baseColorTexture"];
        *info = extended(info.take(), "KHR_texture_transform", transform);
        let material = document.material(material);
        let left = 2.1 * place as f32;
        document.shape(&sheet([left, -1.0, left + 2.0, 1.0], 0.0), material, &[]);
    }
}

/// Colours of vertices, which are linear: half red beside a material of half red; a gradient from black to white; and one of bytes.
fn vertex_colors(document: &mut Document) {
    let unlit = |document: &mut Document, color| {
        document.material(extended(plain(color, 0.0, 1.0), "KHR_materials_unlit", json!({})))
    };
    let (white, red) = (unlit(document, [1.0; 4]), unlit(document, [0.5, 0.0, 0.0, 1.0]));
    let half_red = document.floats("VEC4", &[[0.5, 0.0, 0.0, 1.0]; 4]);
    document.shape(&sheet([-2.0, 0.1, -1.05, 1.0], 0.0), white, &[("COLOR_0", half_red)]);
    document.shape(&sheet([-0.95, 0.1, 0.0, 1.0], 0.0), red, &[]);
    let [black, light] = [[0.0, 0.0, 0.0, 1.0], [1.0; 4]];
    let gradient = document.floats("VEC4", &[black, light, light, black]);
    document.shape(&sheet([-2.0, -1.0, 2.0, -0.1], 0.0), white, &[("COLOR_0", gradient)]);
    let bytes = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [255, 255, 255, 255_u8]].concat();
    let view = document.view(&bytes);
    document.accessors.push(json!({
        "bufferView": view, "componentType": 5121, "normalized": true, "type": "VEC4", "count": 4
    }));
    let colors = document.accessors.len() - 1;
    let lit = document.material(plain([1.0; 4], 0.0, 1.0));
    document.shape(&sheet([0.1, 0.1, 2.0, 1.0], 0.0), lit, &[("COLOR_0", colors)]);
}

/// Tilted sheets from the front and from behind, single-sided on the left and double-sided on the right.
fn double_sided(document: &mut Document) {
    for (place, is_double) in [false, true].into_iter().enumerate() {
        for (row, is_turned) in [false, true].into_iter().enumerate() {
            let mut material = plain([0.2, 0.5, 0.7, 1.0], 0.0, 0.4);
            material["doubleSided"] = json!(is_double);
            let material = document.material(material);
            let [left, bottom] = [2.2 * place as f32, -1.7 * row as f32];
            let mut sheet = sheet([left, bottom, left + 2.0, bottom + 1.5], 0.0);
            // The upper border leans away from the viewer.
            let (sin, cos) = 0.5_f32.sin_cos();
            sheet.positions.iter_mut().for_each(|place| place[2] = -(place[1] - bottom) * sin / cos);
            sheet.normals = vec![[0.0, sin, cos]; 4];
            if is_turned {
                sheet.normals = vec![[0.0, -sin, -cos]; 4];
                sheet.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
            }
            document.shape(&sheet, material, &[]);
        }
    }
}

/// A ball that is lit, and one of the same colour that isn't.
fn unlit(document: &mut Document) {
    let color = [0.3, 0.6, 0.2, 1.0];
    let lit = document.material(plain(color, 0.0, 0.5));
    document.shape(&ball([0.0; 3]), lit, &[]);
    let unlit = document.material(extended(plain(color, 0.0, 0.5), "KHR_materials_unlit", json!({})));
    document.shape(&ball([2.2, 0.0, 0.0]), unlit, &[]);
}

/// Dark smooth balls: an index of refraction of 1, 1.5 and 2.4; and specular of strength 0, and in red.
fn specular_and_ior(document: &mut Document) {
    let base = || plain([0.05, 0.05, 0.08, 1.0], 0.0, 0.15);
    let with_ior = |ior: f32| extended(base(), "KHR_materials_ior", json!({ "ior": ior }));
    let with_specular = |members| extended(base(), "KHR_materials_specular", members);
    let all = [
        with_ior(1.0),
        with_ior(1.5),
        with_ior(2.4),
        with_specular(json!({ "specularFactor": 0.0 })),
        with_specular(json!({ "specularColorFactor": [1.0, 0.1, 0.1] })),
    ];
    for (place, material) in all.into_iter().enumerate() {
        let material = document.material(material);
        document.shape(&ball([2.2 * place as f32, 0.0, 0.0]), material, &[]);
    }
}

/// Gold balls that are not metal, half metal and all metal, in rows; smooth to rough from left to right.
fn metal_and_roughness(document: &mut Document) {
    for (row, metallic) in [0.0, 0.5, 1.0].into_iter().enumerate() {
        for (column, roughness) in [0.0, 0.25, 0.5, 1.0].into_iter().enumerate() {
            let material = document.material(plain([1.0, 0.77, 0.34, 1.0], metallic, roughness));
            document.shape(&ball([2.2 * column as f32, -2.2 * row as f32, 0.0]), material, &[]);
        }
    }
}

/// Balls by specular and glossiness: of numbers alone; and with an image whose colour is the specular one, around the ball, and whose alpha
/// is the glossiness, from the top down; and with half of that glossiness.
fn specular_and_glossiness(document: &mut Document) {
    let both = document.texture([64, 64], |x, y| {
        let [r, g, b] = [[240, 190, 90], [60, 60, 60], [200, 60, 60], [150, 170, 220]][x as usize / 16];
        [r, g, b, (4 * (63 - y)) as u8]
    });
    for (place, glossy) in [
        json!({ "specularFactor": [0.6, 0.5, 0.2], "glossinessFactor": 0.6 }),
        json!({ "specularGlossinessTexture": { "index": both } }),
        json!({ "specularGlossinessTexture": { "index": both }, "glossinessFactor": 0.5 }),
    ]
    .into_iter()
    .enumerate()
    {
        let mut glossy = glossy;
        glossy["diffuseFactor"] = json!([0.1, 0.2, 0.3, 1.0]);
        let glossy = extended(json!({}), "KHR_materials_pbrSpecularGlossiness", glossy);
        let glossy = document.material(glossy);
        document.shape(&ball([2.2 * place as f32, 0.0, 0.0]), glossy, &[]);
    }
}

/// Balls with maps: a coat in stripes, a coat whose roughness grows from the top down, a coat with waves of its own, a specular strength in
/// stripes, and a specular colour around the ball.
fn coat_and_specular_maps(document: &mut Document) {
    let stripes = document.texture([32, 4], |x, _| if x / 2 % 2 == 0 { [255; 4] } else { [0, 0, 0, 0] });
    let rough = document.texture([4, 64], |_, y| [9, (4 * y) as u8, 9, 255]);
    let waves = document.texture([256, 4], |x, _| {
        let slope = 0.5 * (TAU * x as f32 / 16.0).cos();
        let length = (1.0 + slope * slope).sqrt();
        [(127.5 + 127.5 * slope / length).round() as u8, 128, (127.5 + 127.5 / length).round() as u8, 255]
    });
    let colors =
        document.texture([4, 4], |x, _| [[255, 60, 60, 9], [255; 4], [60, 255, 60, 9], [60, 60, 255, 9]][x as usize]);
    let info = |texture: usize| json!({ "index": texture });
    let coats = [
        json!({ "clearcoatFactor": 1.0, "clearcoatTexture": info(stripes) }),
        json!({ "clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 1.0, "clearcoatRoughnessTexture": info(rough) }),
        json!({ "clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.1, "clearcoatNormalTexture": info(waves) }),
    ];
    let coats = coats.map(|coat| extended(plain([0.3, 0.03, 0.02, 1.0], 0.0, 0.9), "KHR_materials_clearcoat", coat));
    let smooth = || extended(plain([0.05, 0.05, 0.08, 1.0], 0.0, 0.15), "KHR_materials_ior", json!({ "ior": 2.4 }));
    let speculars = [json!({ "specularTexture": info(stripes) }), json!({ "specularColorTexture": info(colors) })];
    let speculars = speculars.map(|members| extended(smooth(), "KHR_materials_specular", members));
    for (place, material) in coats.into_iter().chain(speculars).enumerate() {
        let material = document.material(material);
        document.shape(&ball([2.2 * place as f32, 0.0, 0.0]), material, &[]);
    }
}

/// A checkered floor of which the far end is seen nearly from the side: on the left with an image of 64 x 64 px, on the right one of 63 x 63,
/// both repeated by a transform.
fn floor(document: &mut Document) {
    for (place, size) in [64, 63].into_iter().enumerate() {
        let checker = document.texture([size; 2], |x, y| match (8 * x / size + 8 * y / size) % 2 {
            0 => [230, 230, 230, 255],
            _ => [30, 60, 140, 255],
        });
        let mut material = textured(checker);
        let info = &mut material["pbrMetallicRoughness"]["baseColorTexture"];
        *info = extended(info.take(), "KHR_texture_transform", json!({ "scale": [1.0, 12.0] }));
        let material = document.material(material);
        let left = 1.05 * place as f32;
        let mut sheet = sheet([left, 0.0, left + 1.0, 12.0], 0.0);
        for corner in &mut sheet.positions {
            *corner = [corner[0], 0.25 * corner[1] / 12.0, -corner[1]];
        }
        let length = 12.0_f32.hypot(0.25);
        sheet.normals = vec![[0.0, 12.0 / length, 0.25 / length]; 4];
        document.shape(&sheet, material, &[]);
    }
}
