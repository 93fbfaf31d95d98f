//! From bytes to a document that the `gltf` crate can't stumble over.

use ::gltf::Document;
use ::gltf::binary::Glb;
use ::gltf::json::Root;
use serde_json::{Map, Value, json};

use super::Problem;

/// A validated document, the binary chunk of a `.glb`, and what was left out.
pub struct Parsed {
    pub document: Document,
    pub blob: Option<Vec<u8>>,
    /// As the document has them, not checked: see [`super::animations`].
    pub animations: Vec<Value>,
    pub warnings: Vec<String>,
}

/// Extensions that a document may require: quantised attributes are read, the others change neither shape nor colour
/// map so that ignoring them still shows the right surface.
const EXTENSIONS: [&str; 14] = [
    "KHR_mesh_quantization",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
];

/// What the crate reads of a document. The rest (cameras, extras, ...) is dropped before it is parsed further, so that
/// nothing in it can be the reason why a model doesn't load; animations are set aside for the same reason.
const KEPT: [&str; 12] = [
    "accessors",
    "asset",
    "buffers",
    "bufferViews",
    "images",
    "materials",
    "meshes",
    "nodes",
    "scene",
    "scenes",
    "skins",
    "textures",
];

/// Length of a `.glb`'s header, in bytes.
const GLB_HEADER: usize = 12;

/// Parses and validates a `.gltf` or `.glb`; which one, its first bytes tell.
///
/// # Errors
/// [`Problem::NotGltf`] and [`Problem::Extension`].
pub fn parse(bytes: &[u8]) -> Result<Parsed, Problem> {
    let (json, blob) = if bytes.starts_with(b"glTF") { split_glb(bytes)? } else { (bytes.to_vec(), None) };
    // A byte order mark is not JSON, but some editors write it.
    let json = json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&json);
    let mut value: Value = serde_json::from_slice(json).map_err(not_gltf)?;
    check_version(&value)?;
    check_extensions(&value)?;
    let animations = match value.get_mut("animations").map(Value::take) {
        Some(Value::Array(animations)) => animations,
        _ => Vec::new(),
    };
    let warnings = simplify(&mut value)?;
    let root: Root = serde_json::from_value(value).map_err(not_gltf)?;
    let document = Document::from_json(root).map_err(not_gltf)?;
    Ok(Parsed { document, blob, animations, warnings })
}

fn not_gltf(reason: impl ToString) -> Problem {
    Problem::NotGltf { reason: reason.to_string().trim_end_matches(';').to_owned() }
}

fn split_glb(bytes: &[u8]) -> Result<(Vec<u8>, Option<Vec<u8>>), Problem> {
    // The crate subtracts the header's length from what the file says: check that first.
    let said = bytes.get(8..GLB_HEADER).and_then(|length| length.try_into().ok()).map(u32::from_le_bytes);
    let said = said.ok_or_else(|| not_gltf("the file ends within its header"))? as usize;
    if said < GLB_HEADER || said > bytes.len() {
        return Err(not_gltf(format!("its header says {said} bytes, the file has {}", bytes.len())));
    }
    let glb = Glb::from_slice(&bytes[..said]).map_err(not_gltf)?;
    Ok((glb.json.into_owned(), glb.bin.map(|bin| bin.into_owned())))
}

fn check_version(value: &Value) -> Result<(), Problem> {
    let version = value.pointer("/asset/version").and_then(Value::as_str);
    match version {
        Some(version) if version.starts_with("2.") => Ok(()),
        Some(version) => Err(not_gltf(format!("its asset.version is {version}"))),
        None => Err(not_gltf("it has no asset.version")),
    }
}

fn check_extensions(value: &Value) -> Result<(), Problem> {
    let required = value.get("extensionsRequired").and_then(Value::as_array).into_iter().flatten();
    match required.filter_map(Value::as_str).find(|name| !EXTENSIONS.contains(name)) {
        Some(name) => Err(Problem::Extension { name: name.to_owned() }),
        None => Ok(()),
    }
}

/// Reduces the document to what is read of it.
fn simplify(value: &mut Value) -> Result<Vec<String>, Problem> {
    let Some(root) = value.as_object_mut() else { return Err(not_gltf("it is no JSON object")) };
    root.retain(|key, _| KEPT.contains(&key.as_str()));
    remove_everywhere(root);
    for node in objects(root, "nodes") {
        node.remove("camera");
    }
    for scene in objects(root, "scenes") {
        // A scene may be empty, but the crate wants to be told.
        scene.entry("nodes").or_insert_with(|| json!([]));
    }
    simplify_meshes(root)?;
    for material in objects(root, "materials") {
        material.retain(|key, _| ["name", "pbrMetallicRoughness"].contains(&key.as_str()));
        if let Some(Value::Object(pbr)) = material.get_mut("pbrMetallicRoughness") {
            pbr.retain(|key, _| ["baseColorFactor", "baseColorTexture"].contains(&key.as_str()));
        }
    }
    Ok(simplify_textures(root))
}

/// The objects in one of the document's lists.
fn objects<'a>(root: &'a mut Map<String, Value>, list: &str) -> impl Iterator<Item = &'a mut Map<String, Value>> {
    root.get_mut(list).and_then(Value::as_array_mut).into_iter().flatten().filter_map(Value::as_object_mut)
}

/// Drops `extensions` and `extras` of all objects in the document's lists.
fn remove_everywhere(root: &mut Map<String, Value>) {
    let mut open: Vec<&mut Value> = root.values_mut().collect();
    while let Some(value) = open.pop() {
        match value {
            Value::Array(values) => open.extend(values),
            Value::Object(map) => {
                map.remove("extensions");
                map.remove("extras");
                open.extend(map.values_mut());
            }
            _ => {}
        }
    }
}

/// Keeps the attributes that are read, and makes sure of what the crate's validation takes for granted.
fn simplify_meshes(root: &mut Map<String, Value>) -> Result<(), Problem> {
    let mut positions = Vec::new();
    for (i, mesh) in objects(root, "meshes").enumerate() {
        let primitives = mesh.get_mut("primitives").and_then(Value::as_array_mut).into_iter().flatten();
        for (k, primitive) in primitives.enumerate() {
            if let Some(Value::Object(attributes)) = primitive.get_mut("attributes") {
                attributes.retain(|key, _| is_read(key));
                positions.extend(attributes.get("POSITION").and_then(Value::as_u64).map(|index| (i, k, index)));
            }
            for target in primitive.get_mut("targets").and_then(Value::as_array_mut).into_iter().flatten() {
                if let Value::Object(target) = target {
                    target.retain(|key, _| ["POSITION", "NORMAL"].contains(&key.as_str()));
                }
            }
        }
    }
    let mut no_accessors = Vec::new();
    let accessors = root.get_mut("accessors").and_then(Value::as_array_mut).unwrap_or(&mut no_accessors);
    for (mesh, primitive, index) in positions {
        let count = accessors.len();
        let accessor = usize::try_from(index).ok().and_then(|index| accessors.get_mut(index));
        let Some(accessor) = accessor else {
            let primitive = format!("mesh {mesh}, primitive {primitive}");
            let reason = format!("names accessor {index} as its POSITION, but there are {count} accessors");
            return Err(Problem::Primitive { primitive, reason });
        };
        if let Value::Object(accessor) = accessor {
            // Required by the specification, forgotten by some exporters, and not used here.
            accessor.insert("min".to_owned(), json!([0.0, 0.0, 0.0]));
            accessor.insert("max".to_owned(), json!([0.0, 0.0, 0.0]));
        }
    }
    Ok(())
}

fn is_read(attribute: &str) -> bool {
    let known = ["POSITION", "NORMAL", "JOINTS_0", "WEIGHTS_0"].contains(&attribute);
    known || attribute.strip_prefix("TEXCOORD_").is_some_and(|set| set.parse::<u32>().is_ok())
}

/// A texture without a source (its image is in a format that an extension adds) stops the crate. Materials do without
/// it, with a warning, and the entry gets some source so that the others keep their indices.
fn simplify_textures(root: &mut Map<String, Value>) -> Vec<String> {
    let mut without = Vec::new();
    for (i, texture) in objects(root, "textures").enumerate() {
        texture.retain(|key, _| ["name", "source"].contains(&key.as_str()));
        if !texture.contains_key("source") {
            texture.insert("source".to_owned(), json!(0));
            without.push(i as u64);
        }
    }
    if without.is_empty() {
        return Vec::new();
    }
    if let Some(images) = root.entry("images").or_insert(json!([])).as_array_mut()
        && images.is_empty()
    {
        images.push(json!({ "uri": "" }));
    }
    for pbr in objects(root, "materials").filter_map(|m| m.get_mut("pbrMetallicRoughness")?.as_object_mut()) {
        let texture = pbr.get("baseColorTexture").and_then(|info| info.get("index")).and_then(Value::as_u64);
        if texture.is_some_and(|texture| without.contains(&texture)) {
            pbr.remove("baseColorTexture");
        }
    }
    without
        .iter()
        .map(|i| format!("texture {i} has no PNG or JPEG image; its materials are shown without it."))
        .collect()
}
