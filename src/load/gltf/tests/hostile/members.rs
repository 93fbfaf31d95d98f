//! Members that are missing, or aren't what they should be.

use super::*;

/// Two to the power of 62.
const HUGE: u64 = 1 << 62;

fn without(name: &'static str, pointer: &str, sentence: &str) -> Case {
    Case::with(name, pointer, Value::Null, sentence)
}

/// A triangle with materials, textures, images and a skin.
fn dressed() -> Draft {
    let mut draft = triangle();
    draft.root["materials"] = json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    draft.root["textures"] = json!([{ "source": 0 }]);
    draft.root["images"] = json!([{ "uri": "" }]);
    draft.root["skins"] = json!([{ "joints": [0] }]);
    draft
}

fn with(name: &'static str, pointer: &str, value: Value, sentence: &str) -> Case {
    let mut draft = dressed();
    set(&mut draft.root, pointer, value);
    Case::refused(name, draft.document().to_string(), sentence)
}

pub fn cases() -> Vec<Case> {
    let sparse =
        json!({ "count": 1, "indices": { "bufferView": 0, "componentType": 5126 }, "values": { "bufferView": 1 } });
    vec![
        Case::with(
            "nodes that are an object",
            "/nodes",
            json!({}),
            "/nodes should be a list and is an object; export the model again",
        ),
        Case::with(
            "a node that is text",
            "/nodes/0",
            json!("root"),
            "/nodes/0 should be an object and is \"root\"; export the model again",
        ),
        Case::with(
            "a mesh that isn't there",
            "/nodes/0/mesh",
            json!(5),
            "/nodes/0/mesh is 5, and /meshes has 1; export the model again",
        ),
        Case::with(
            "a mesh before the first",
            "/nodes/0/mesh",
            json!(-1),
            "/nodes/0/mesh should be a whole number and is -1; export the model again",
        ),
        Case::with(
            "half a mesh",
            "/nodes/0/mesh",
            json!(0.5),
            "/nodes/0/mesh should be a whole number and is 0.5; export the model again",
        ),
        Case::with(
            "a mesh beyond 32 bits",
            "/nodes/0/mesh",
            json!(1_u64 << 32),
            "/nodes/0/mesh is 4294967296, and /meshes has 1; export the model again",
        ),
        Case::with(
            "a child that isn't there",
            "/nodes/0/children",
            json!([HUGE]),
            "/nodes/0/children/0 is 4611686018427387904, and /nodes has 1; export the model again",
        ),
        Case::with(
            "a matrix of three numbers",
            "/nodes/0/matrix",
            json!([1, 0, 0]),
            "/nodes/0/matrix should be 16 numbers and has 3; export the model again",
        ),
        Case::with(
            "a translation beyond f32",
            "/nodes/0/translation",
            json!([0, 1e308, 0]),
            "/nodes/0/translation/1 is 1e+308, and 3.4028235e38 is the most; export the model again",
        ),
        Case::with(
            "a rotation that is too long",
            "/nodes/0/rotation",
            json!([0, 0, 0, 2]),
            "/nodes/0/rotation/3 is 2, and 1.0 is the most; export the model again",
        ),
        Case::with(
            "weights that are text",
            "/nodes/0/weights",
            json!(["a\nb"]),
            "/nodes/0/weights/0 should be a number and is \"a�b\"; export the model again",
        ),
        Case::with(
            "a scene that isn't there",
            "/scene",
            json!(1),
            "/scene is 1, and /scenes has 1; export the model again",
        ),
        Case::with(
            "a scene's node that isn't there",
            "/scenes/0/nodes",
            json!([0, 1]),
            "/scenes/0/nodes/1 is 1, and /nodes has 1; export the model again",
        ),
        without("no primitives", "/meshes/0/primitives", "/meshes/0/primitives is missing; export the model again"),
        without(
            "no attributes",
            "/meshes/0/primitives/0/attributes",
            "/meshes/0/primitives/0/attributes is missing; export the model again",
        ),
        Case::with(
            "a mode that there isn't",
            "/meshes/0/primitives/0/mode",
            json!(7),
            "/meshes/0/primitives/0/mode should be 0, 1, 2, 3, 4, 5 or 6 and is 7; export the model again",
        ),
        Case::with(
            "a material that isn't there",
            "/meshes/0/primitives/0/material",
            json!(0),
            "/meshes/0/primitives/0/material is 0, and /materials has 0; export the model again",
        ),
        Case::with(
            "positions that aren't there",
            "/meshes/0/primitives/0/attributes/POSITION",
            json!(77),
            "/meshes/0/primitives/0/attributes/POSITION is 77, and /accessors has 2; export the model again",
        ),
        Case::with(
            "targets that are a number",
            "/meshes/0/primitives/0/targets",
            json!(3),
            "/meshes/0/primitives/0/targets should be a list and is 3; export the model again",
        ),
        without(
            "no component type",
            "/accessors/0/componentType",
            "/accessors/0/componentType is missing; export the model again",
        ),
        Case::with(
            "signed 32-bit integers",
            "/accessors/0/componentType",
            json!(5124),
            "/accessors/0/componentType should be 5120, 5121, 5122, 5123, 5125 or 5126 and is 5124; export the model again",
        ),
        Case::with(
            "five numbers an element",
            "/accessors/0/type",
            json!("VEC5"),
            "/accessors/0/type should be SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4 and is \"VEC5\"; export the model again",
        ),
        without("no count", "/accessors/0/count", "/accessors/0/count is missing; export the model again"),
        Case::with(
            "a count below 0",
            "/accessors/0/count",
            json!(-1),
            "/accessors/0/count should be a whole number and is -1; export the model again",
        ),
        Case::with(
            "a count of 1e308",
            "/accessors/0/count",
            json!(1e308),
            "/accessors/0/count should be a whole number and is 1e+308; export the model again",
        ),
        Case { gets: Gets::Read, ..without("neither view nor sparse values: zeros", "/accessors/0/bufferView", "") },
        Case::with(
            "a view that isn't there",
            "/accessors/1/bufferView",
            json!(2_u64 << 30),
            "/accessors/1/bufferView is 2147483648, and /bufferViews has 2; export the model again",
        ),
        Case::with(
            "sparse places that are no integers",
            "/accessors/0/sparse",
            sparse,
            "/accessors/0/sparse/indices/componentType should be 5121, 5123 or 5125 and is 5126; export the model again",
        ),
        Case::with(
            "a stride below 4",
            "/bufferViews/0/byteStride",
            json!(3),
            "/bufferViews/0/byteStride is 3, and 4 is the least; export the model again",
        ),
        Case::with(
            "a stride beyond 252",
            "/bufferViews/0/byteStride",
            json!(256),
            "/bufferViews/0/byteStride is 256, and 252 is the most; export the model again",
        ),
        without(
            "a view of no buffer",
            "/bufferViews/0/buffer",
            "/bufferViews/0/buffer is missing; export the model again",
        ),
        with(
            "texture coordinates beyond 32 bits",
            "/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord",
            json!(HUGE),
            "/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord is 4611686018427387904, and 4294967295 is the most; export the model again",
        ),
        with(
            "a colour beyond 1",
            "/materials/0/pbrMetallicRoughness/baseColorFactor",
            json!([1, 1, 1, 1.5]),
            "/materials/0/pbrMetallicRoughness/baseColorFactor/3 is 1.5, and 1.0 is the most; export the model again",
        ),
        with(
            "sides that are text",
            "/materials/0/doubleSided",
            json!("yes"),
            "/materials/0/doubleSided should be true or false and is \"yes\"; export the model again",
        ),
        with(
            "a texture that isn't there",
            "/materials/0/pbrMetallicRoughness/baseColorTexture/index",
            json!(1),
            "/materials/0/pbrMetallicRoughness/baseColorTexture/index is 1, and /textures has 1; export the model again",
        ),
        with(
            "an image that isn't there",
            "/textures/0/source",
            json!(9),
            "/textures/0/source is 9, and /images has 1; export the model again",
        ),
        with(
            "a path that is a number",
            "/images/0/uri",
            json!(5),
            "/images/0/uri should be text and is 5; export the model again",
        ),
        with(
            "a joint that isn't there",
            "/skins/0/joints",
            json!([0, 9]),
            "/skins/0/joints/1 is 9, and /nodes has 1; export the model again",
        ),
        Case::with(
            "a scale of nothing",
            "/nodes/0/scale",
            json!([null, 1, 1]),
            "/nodes/0/scale/0 should be a number and is null; export the model again",
        ),
        Case::with(
            "an extension that nobody knows",
            "/extensionsRequired",
            json!(["EXT_unknown"]),
            "/extensionsRequired/0 is EXT_unknown, which isn't supported; export the model without it",
        ),
        Case::draft(
            "Draco without anything that it compressed",
            &{
                let mut draft = triangle();
                draft.root["extensionsRequired"] = json!(["KHR_mesh_quantization", "KHR_draco_mesh_compression"]);
                draft
            },
            Gets::Read,
        ),
        Case::with("a node without a mesh", "/nodes/0", json!({}), "no triangles: no node of its scene has a mesh"),
        Case::draft(
            "a name that is no text, and an unknown extension",
            &{
                let mut draft = triangle();
                draft.root["meshes"][0]["name"] = json!([1]);
                draft.root["extensionsUsed"] = json!(["EXT_unknown"]);
                draft.root["nodes"][0]["extensions"] = json!({ "EXT_unknown": [[[]]] });
                draft
            },
            Gets::Read,
        ),
    ]
}
