//! 3MF.

use super::Gets::{Refused, Repaired};
use super::{Case, Gets};
use crate::Format::ThreeMf;
use crate::threemf::tests::layers::many_layers;
use crate::threemf::tests::{png, textured};
use documents::package::{Entry, MODEL, model, package, relationships, zip};

const TRIANGLE: &str = "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>\
     <vertex x=\"0\" y=\"1\" z=\"0\"/></vertices><triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh>";

const ITEM: &str = "<item objectid=\"1\"/>";

/// A file with a triangle as its object 1, before these resources.
fn beside(resources: &str, build: &str) -> Vec<u8> {
    package(&model(&format!("<object id=\"1\">{TRIANGLE}</object>{resources}"), build))
}

/// A file with a triangle in which a text is replaced.
fn replaced(from: &str, to: &str) -> Vec<u8> {
    let text = model(&format!("<object id=\"1\">{TRIANGLE}</object>"), ITEM);
    assert!(text.contains(from), "{from}");
    package(&text.replace(from, to))
}

/// A file whose model is this entry.
fn with_model(model: Entry) -> Vec<u8> {
    zip(&[Entry::stored("_rels/.rels", relationships().as_bytes()), model])
}

/// Objects each of which has so many times the one before as its components.
fn towers(objects: usize, times: usize, last: &str) -> Vec<u8> {
    let object = |i: usize| {
        let components = format!("<component objectid=\"{}\"/>", i - 1).repeat(times);
        format!("<object id=\"{i}\"><components>{components}</components></object>")
    };
    let all: String = (2..=objects).map(object).collect();
    package(&model(&format!("<object id=\"1\">{last}</object>{all}"), &format!("<item objectid=\"{objects}\"/>")))
}

pub(super) fn cases() -> Vec<(&'static str, Case)> {
    let case = |name, bytes: Vec<u8>, gets: Gets| (name, (ThreeMf, bytes.into(), gets));
    let text = model(&format!("<object id=\"1\">{TRIANGLE}</object>"), ITEM);
    let whole = package(&text);
    let own = || Entry::deflated(MODEL, text.as_bytes());
    let stored = |text: &str| Entry::stored(MODEL, text.as_bytes());
    let mut cases = vec![
        case("nothing", Vec::new(), Refused("Broken | directory")),
        case("half of an archive", whole[..whole.len() / 2].to_vec(), Refused("Broken | directory")),
        case("an archive without its last byte", whole[..whole.len() - 1].to_vec(), Refused("Broken | directory")),
        case(
            "an archive with a glTF file",
            zip(&[Entry::stored("license.txt", b"free"), Entry::stored("a/scene.gltf", b"{}")]),
            Refused("NoModel | 2 files | a/scene.gltf"),
        ),
        case("an empty archive", zip(&[]), Refused("NoModel | 0 files")),
        case(
            "relationships to a part that isn't there",
            zip(&[Entry::stored("_rels/.rels", relationships().as_bytes())]),
            Refused("Broken | 3D/3dmodel.model | isn't there"),
        ),
        case(
            "relationships to a part that isn't there, beside a model",
            zip(&[
                Entry::stored("_rels/.rels", relationships().replace("/3D/", "./3D/").as_bytes()),
                Entry::stored(MODEL, model(&format!("<object id=\"1\">{TRIANGLE}</object>"), ITEM).as_bytes()),
            ]),
            Repaired(1, "its model is ./3D/3dmodel.model | 3D/3dmodel.model is shown"),
        ),
        case("a method of 2006", with_model(Entry { method: 12, ..own() }), Refused("Broken | method 12")),
        case("damaged data", with_model(Entry { packed: vec![0xff; 100], ..own() }), Refused("Broken | damaged")),
        case(
            "a part cut short",
            with_model(Entry { packed: own().packed[..99].to_vec(), ..own() }),
            Refused("Broken | 3D/3dmodel.model"),
        ),
        case("a part longer than it says", with_model(Entry { unpacked: 99, ..own() }), Refused("Broken | more than")),
        case(
            "a part shorter than it says",
            with_model(Entry { unpacked: 9999, ..own() }),
            Refused("Broken | less than"),
        ),
        case("a wrong checksum", with_model(Entry { crc: 7, ..own() }), Repaired(1, "checksum | 1")),
        case(
            "4 GiB of nothing",
            with_model(Entry { unpacked: u32::MAX - 1, ..own() }),
            Refused("TooLarge | 4097 MiB | 512"),
        ),
        case(
            "200 MiB of nothing",
            with_model(Entry { unpacked: 200 << 20, ..own() }),
            Refused("Broken | 209715200 | no model"),
        ),
        case(
            "15 MB of spaces",
            with_model(Entry::deflated(MODEL, format!("{}{text}", " ".repeat(15_000_000)).as_bytes())),
            Refused("Broken | more than 4194304 bytes"),
        ),
        case("no XML", with_model(stored("\0\0\0\0")), Refused("Broken | 3MF model | \"model\"")),
        case(
            "a page of the web",
            with_model(stored("<html><body/></html>")),
            Refused("Broken | 3MF model | \"model\""),
        ),
        case("UTF-16", with_model(Entry::stored(MODEL, b"\xff\xfe<\0")), Refused("Broken | UTF-16")),
        case(
            "elements that cross",
            replaced("</triangles></mesh>", "</mesh></triangles>"),
            Refused("Broken | well-formed"),
        ),
        case("a model without its end", replaced("</build></model>", ""), Refused("Broken | within an element")),
        case(
            "300 elements within each other",
            replaced("<build>", &format!("{}<build>", "<a>".repeat(300))),
            Refused("Broken | more than 256 deep"),
        ),
        case(
            "entities that grow",
            replaced(
                "<model unit=\"meter\"",
                "<!DOCTYPE model [<!ENTITY a \"ha\"><!ENTITY b \"&a;&a;\">]><model unit=\"&b;\"",
            ),
            Repaired(1, "unit | &b; | millimetres"),
        ),
        case(
            "an object that is its own component",
            beside(
                "<object id=\"2\"><components><component objectid=\"2\"/></components></object>",
                "<item objectid=\"2\"/>",
            ),
            Refused("Broken | object 2 | its own components"),
        ),
        case(
            "parts that place each other",
            {
                let other = model(
                    "<object id=\"3\"><components><component objectid=\"2\" p:path=\"/3D/3dmodel.model\"/></components></object>",
                    "",
                );
                let root = model(
                    "<object id=\"2\"><components><component objectid=\"3\" p:path=\"/other.model\"/></components></object>",
                    "<item objectid=\"2\"/>",
                );
                zip(&[
                    Entry::stored("_rels/.rels", relationships().as_bytes()),
                    Entry::stored(MODEL, root.as_bytes()),
                    Entry::stored("other.model", other.as_bytes()),
                ])
            },
            Refused("Broken | object 2 | its own components"),
        ),
        case("10 components each, 60 times", towers(60, 10, TRIANGLE), Refused("TooMany | triangles")),
        case("the same of an empty object", towers(60, 10, "<mesh/>"), Refused("Empty | 60 objects | 0 triangles")),
        case("10,000,000 copies of a triangle", towers(8, 10, TRIANGLE), Refused("TooLarge | MiB")),
        case("100 components within each other", towers(100, 1, TRIANGLE), Refused("Broken | more than 64 deep")),
    ];
    cases.extend(shapes());
    cases.extend(textures());
    cases.extend(layers());
    cases
}

/// What is wrong with a shape, or isn't read of it.
fn shapes() -> Vec<(&'static str, Case)> {
    let case = |name, bytes: Vec<u8>, gets: Gets| (name, (ThreeMf, bytes.into(), gets));
    vec![
        case(
            "a vertex that isn't there",
            replaced("v3=\"2\"", "v3=\"3\""),
            Refused("Broken | triangle 0 | object 1 | vertex 3"),
        ),
        case("a triangle of two vertices", replaced("v3=\"2\"", ""), Refused("Broken | triangle 0 | object 1")),
        case("a negative vertex", replaced("v3=\"2\"", "v3=\"-1\""), Refused("Broken | triangle 0 | object 1")),
        case(
            "a coordinate that isn't a number",
            replaced("x=\"1\"", "x=\"1,5\""),
            Refused("Empty | 1 faces | a number"),
        ),
        case("a coordinate that is missing", replaced("x=\"1\"", ""), Refused("Empty | 1 faces | a number")),
        case(
            "a transform of 11 numbers",
            replaced("<item", "<item transform=\"1 0 0 0 1 0 0 0 1 0 0\""),
            Refused("Broken | object 1 | 12 finite"),
        ),
        case(
            "a transform that isn't finite",
            replaced("<item", "<item transform=\"1 0 0 0 1 0 0 0 1 0 0 inf\""),
            Refused("Broken | object 1 | 12 finite"),
        ),
        case("an object without a number", replaced("<object id=\"1\"", "<object id=\"one\""), Refused("Broken | id")),
        case("an item of nothing", replaced("<item objectid=\"1\"", "<item"), Refused("Broken | objectid")),
        case(
            "an item that isn't there",
            beside("", "<item objectid=\"1\"/><item objectid=\"9\"/>"),
            Repaired(1, "object isn't in the file | 1"),
        ),
        case(
            "a part that isn't there",
            beside("", "<item objectid=\"1\"/><item objectid=\"1\" p:path=\"/../../etc/passwd\"/>"),
            Repaired(1, "/../../etc/passwd | isn't in the archive"),
        ),
        case(
            "two objects of one number",
            beside("<object id=\"1\"><mesh/></object>", ITEM),
            Repaired(1, "id of another | 1"),
        ),
        case("a build without items", beside("", ""), Repaired(1, "build has no items")),
        case(
            "a material that isn't there",
            replaced("v3=\"2\"", "v3=\"2\" pid=\"4\" p1=\"0\""),
            Repaired(1, "material, colour or texture coordinates | 1"),
        ),
        case(
            "a colour that isn't there",
            replaced(
                "<object",
                "<m:colorgroup id=\"4\"><m:color color=\"#FFFFFF\"/></m:colorgroup><object pid=\"4\" pindex=\"1\"",
            ),
            Repaired(1, "material, colour or texture coordinates | 1"),
        ),
        case(
            "a colour that isn't one",
            replaced("<object", "<m:colorgroup id=\"4\"><m:color color=\"red\"/></m:colorgroup><object"),
            Repaired(1, "#RRGGBB | white | 1"),
        ),
        case(
            "a texture that isn't there",
            replaced(
                "<object",
                "<m:texture2dgroup id=\"4\" texid=\"3\"><m:tex2coord u=\"0\" v=\"0\"/></m:texture2dgroup>\
                 <object pid=\"4\" pindex=\"0\"",
            ),
            Repaired(1, "texture coordinates | 1"),
        ),
        case("beams", replaced("</mesh>", "<b:beamlattice/></mesh>"), Repaired(1, "beams | 1")),
        case("slices", replaced("<object", "<object slicestackid=\"7\""), Repaired(1, "slices | 1")),
        case(
            "an extension that is required",
            replaced("<model", "<model requiredextensions=\"x\" xmlns:x=\"http://example.com/fog\""),
            Repaired(1, "requires an extension | http://example.com/fog"),
        ),
        case(
            "no relationships",
            zip(&[Entry::stored("a.MODEL", model(&format!("<object id=\"1\">{TRIANGLE}</object>"), ITEM).as_bytes())]),
            Repaired(1, "which part is its model | a.MODEL"),
        ),
    ]
}

/// What is wrong with a texture. The model is shown without it.
fn textures() -> Vec<(&'static str, Case)> {
    let case = |name, bytes: Vec<u8>, gets: Gets| (name, (ThreeMf, bytes.into(), gets));
    let image = png([[255; 4], [0, 0, 0, 255]]);
    let of = |image: Entry| textured("path=\"/a.png\" contenttype=\"image/png\"", image);
    let whole = || Entry::deflated("a.png", &image);
    // The header says 16384 x 16384 px, with a wrong checksum.
    let mut large = image.clone();
    large[16..24].copy_from_slice(&[0, 0, 0x40, 0, 0, 0, 0x40, 0]);
    vec![
        case(
            "an image that isn't there",
            of(Entry { name: "b.png", ..whole() }),
            Repaired(1, "/a.png | isn't in the archive"),
        ),
        case("a texture without a path", textured("", whole()), Repaired(1, "texture | isn't in the archive")),
        case(
            "an image cut short",
            of(Entry::stored("a.png", &image[..image.len() / 2])),
            Repaired(1, "/a.png | decoded"),
        ),
        case(
            "an image whose packed data is cut short",
            of(Entry { packed: whole().packed[..20].to_vec(), ..whole() }),
            Repaired(1, "/a.png | left out"),
        ),
        case("an image that is a text", of(Entry::stored("a.png", b"a picture")), Repaired(1, "/a.png | decoded")),
        case(
            "an image that is a model",
            textured("path=\"/3D/3dmodel.model\"", whole()),
            Repaired(1, "3dmodel.model | decoded"),
        ),
        case(
            "an image longer than it says",
            of(Entry { unpacked: 9, ..whole() }),
            Repaired(1, "/a.png | unpacks to more"),
        ),
        case(
            "an image of 4 GiB of nothing",
            of(Entry { unpacked: u32::MAX - 1, ..whole() }),
            Repaired(1, "/a.png | 4097 MiB | 512"),
        ),
        case("an image of 16384 px without data", of(Entry::stored("a.png", &large)), Repaired(1, "/a.png | left out")),
        case(
            "texture coordinates that aren't there",
            replaced(
                "<object",
                "<m:texture2d id=\"3\" path=\"/a.png\"/><m:texture2dgroup id=\"4\" texid=\"3\"/><object pid=\"4\" pindex=\"7\"",
            ),
            Repaired(1, "texture coordinates | 1"),
        ),
        case(
            "texture coordinates that aren't numbers",
            replaced(
                "<object",
                "<m:texture2d id=\"3\" path=\"/a.png\"/><m:texture2dgroup id=\"4\" texid=\"3\">\
                 <m:tex2coord u=\"nan\" v=\"one\"/></m:texture2dgroup><object pid=\"4\" pindex=\"0\"",
            ),
            Repaired(1, "uvs that aren't finite | 3"),
        ),
    ]
}

/// What is wrong with layers and mixtures, of which the lowest or the first is shown.
fn layers() -> Vec<(&'static str, Case)> {
    let painted = |resources: &str| {
        let object = "<object pid=\"9\" pindex=\"0\"";
        replaced(
            "<object",
            &format!(
                "<basematerials id=\"1\"><base name=\"PLA\" displaycolor=\"#FF0000\"/></basematerials>\
                 <m:colorgroup id=\"2\"><m:color color=\"#00FF0080\"/></m:colorgroup>{resources}{object}"
            ),
        )
    };
    let of = |attributes: &str| {
        painted(&format!("<m:multiproperties id=\"9\" {attributes}><m:multi pindices=\"0 0\"/></m:multiproperties>"))
    };
    let mixed = |attributes: &str| {
        painted(&format!(
            "<m:compositematerials id=\"9\" {attributes}><m:composite values=\"0.5 0.5\"/></m:compositematerials>"
        ))
    };
    let absent = "material, colour or texture coordinates | 1";
    let alone = "the lowest layer or the first material alone | 1";
    let entry = |numbers: &str| {
        let entry = format!("<m:multi pindices=\"{numbers}\"/>");
        painted(&format!("<m:multiproperties id=\"9\" pids=\"1 2\">{entry}</m:multiproperties>"))
    };
    let rows = [
        ("layers without an entry", painted("<m:multiproperties id=\"9\" pids=\"1 2\"/>"), absent),
        ("an entry without layers", of(""), absent),
        ("a lowest layer that isn't there", of("pids=\"7 1\""), absent),
        ("a lowest layer that isn't a number", of("pids=\"two 1\""), absent),
        ("an entry of a layer that isn't there", entry("5 0"), absent),
        ("a negative entry of a layer", entry("-1 0"), absent),
        ("layers that have themselves as a layer", of("pids=\"9 9\""), absent),
        ("1,000,000 layers", of(&format!("pids=\"{}\"", "2 ".repeat(1_000_000))), alone),
        ("10,000 colours below a translucent texture", many_layers(10_000), "first material alone | 10000"),
        ("a mixture of a group that isn't there", mixed("matid=\"7\" matindices=\"0 0\""), absent),
        ("a mixture of a material that isn't there", mixed("matid=\"1\" matindices=\"4 0\""), absent),
        (
            "a mixture that isn't there",
            painted("<m:compositematerials id=\"9\" matid=\"1\" matindices=\"0\"/>"),
            absent,
        ),
    ];
    let triangles = |name: &str| if name.starts_with("10,000") { 10_000 } else { 1 };
    rows.into_iter()
        .map(|(name, bytes, parts)| (name, (ThreeMf, bytes.into(), Repaired(triangles(name), parts))))
        .collect()
}
