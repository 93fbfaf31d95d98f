//! Light from files: `--environment`, `--lights`, and what `info` says of the lights of a glTF file.

use image::ExtendedColorType;
use image::codecs::hdr::HdrEncoder;
use image::codecs::openexr::OpenExrEncoder;
use serde_json::{Value, json};

use crate::{Folder, failure, output, run, sentence, write_triangles};

/// Writes a panorama that is red above and blue below, as a Radiance or an OpenEXR file.
fn panorama(folder: &Folder, name: &str, [width, height]: [usize; 2]) -> String {
    let half = width * height / 2;
    let pixels: Vec<[f32; 3]> =
        (0..width * height).map(|index| if index < half { [2.0, 0.0, 0.0] } else { [0.0, 0.0, 2.0] }).collect();
    let path = folder.path(name);
    let file = std::fs::File::create(&path).expect("a writable folder");
    if name.ends_with("hdr") {
        let pixels: Vec<_> = pixels.into_iter().map(image::Rgb).collect();
        HdrEncoder::new(file).encode(&pixels, width, height).expect("a file");
    } else {
        let bytes: Vec<u8> = pixels.as_flattened().iter().flat_map(|value| value.to_ne_bytes()).collect();
        let encoder = OpenExrEncoder::new(file);
        image::ImageEncoder::write_image(encoder, &bytes, width as u32, height as u32, ExtendedColorType::Rgb32F)
            .expect("a file");
    }
    path
}

fn picture(folder: &Folder, arguments: &[&str]) -> image::RgbaImage {
    let path = folder.path("out.png");
    output(&[&["render"], arguments, &["-o", &path, "--size", "120x90", "--factor", "4"]].concat());
    image::open(path).expect("a picture").to_rgba8()
}

#[test]
fn a_panorama_lights_the_mesh_and_is_its_background() {
    let folder = Folder::new();
    let studio = picture(&folder, &["shape:torus"]);
    let [radiance, open_exr] = ["sky.hdr", "sky.exr"].map(|name| {
        let path = panorama(&folder, name, [64, 32]);
        let with = |more: &[&str]| picture(&folder, &[&["shape:torus", "--environment", &path], more].concat());
        let seen = with(&[]);
        assert_ne!(seen, studio, "{name}");
        assert_eq!(with(&["--lighting", "environment"]), seen);
        let behind = with(&["--environment-background", "--camera", "0,0"]);
        let [above, below] = [behind.get_pixel(1, 1).0, behind.get_pixel(1, 88).0];
        assert!(above[0] > 200 && above[2] < 150 && below[2] > 200 && below[0] < 150, "{above:?} {below:?}");
        assert_eq!(with(&["--environment-background", "--transparent"]).get_pixel(1, 1).0, [0; 4]);
        seen
    });
    assert_eq!(radiance, open_exr, "2 and 0 are exact in both");
}

#[test]
fn files_that_are_no_panoramas_are_refused_with_a_sentence() {
    let folder = Folder::new();
    let render =
        |file: &str| ["render", "shape:torus", "-o", &folder.path("out.png"), "--environment", file].map(str::to_owned);
    let refused = |file: &str, words: &[&str]| {
        let arguments = render(file);
        sentence(&arguments.each_ref().map(String::as_str), words);
    };
    refused(&folder.path("none.hdr"), &["none.hdr can't be read: there is no such file"]);
    let other = folder.write("mesh.exr", "v 0 0 0\n");
    refused(&other, &["mesh.exr: it begins neither like a Radiance file"]);
    let whole = panorama(&folder, "cut.hdr", [64, 32]);
    let bytes = std::fs::read(&whole).expect("a file");
    std::fs::write(&whole, &bytes[..bytes.len() / 2]).expect("a writable folder");
    refused(&whole, &["cut.hdr: it ends too early"]);
    let large = folder.write("large.hdr", "#?RADIANCE\n\n-Y 8192 +X 16384\n");
    refused(&large, &["large.hdr: it has 16384 x 8192 px", "--max-memory"]);
    assert!(!std::path::Path::new(&folder.path("out.png")).exists());
}

#[test]
fn a_file_and_a_light_must_fit_and_odd_files_cost_a_warning() {
    let folder = Folder::new();
    let (sky, out) = (panorama(&folder, "sky.hdr", [16, 16]), folder.path("out.png"));
    let render = ["render", "shape:torus", "-o", &out];
    let said = failure(&[&render[..], &["--environment", &sky, "--lighting", "camera"]].concat(), 2);
    assert!(said.contains("--environment is the light of --lighting environment"), "{said}");
    let said = failure(&[&render[..], &["--lighting", "environment"]].concat(), 2);
    assert!(said.contains("--lighting environment needs --environment"), "{said}");
    let said = failure(&[&render[..], &["--stats", &sky, "--environment", &sky]].concat(), 1);
    assert!(said.contains("sky.hdr is read by the same command"), "{said}");
    let ran = run(&[&render[..], &["--environment", &sky, "--size", "16x16"]].concat());
    let said = String::from_utf8_lossy(&ran.stderr).into_owned();
    assert!(ran.status.success() && said.contains("pnaen: warning: sky.hdr: it has 16 x 16 px; a panorama"), "{said}");
}

#[test]
fn lights_of_a_file_shine_and_are_in_info() {
    let folder = Folder::new();
    let path = write_triangles(&folder, &[[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]], [0.0, 0.0, 1.0]);
    let mut document: Value = serde_json::from_str(&std::fs::read_to_string(&path).expect("a file")).expect("JSON");
    document["extensions"] = json!({ "KHR_lights_punctual": { "lights": [
        { "type": "spot", "color": [0, 1, 0], "intensity": 20, "range": 9, "spot": { "outerConeAngle": 0.5 } },
        { "type": "directional", "intensity": 0.5 },
    ] } });
    let node = |light: usize, z: f32| json!({ "translation": [0.25, 0.25, z], "extensions": { "KHR_lights_punctual": { "light": light } } });
    document["nodes"] = json!([{ "mesh": 0 }, node(0, 2.0), node(1, 0.0)]);
    document["scenes"] = json!([{ "nodes": [0, 1, 2] }]);
    std::fs::write(&path, document.to_string()).expect("a writable folder");
    let text = output(&["info", &path]);
    let spot = "\nlight         spot, 0 20 0 cd, at 0.25 0.25 2, towards 0 0 -1, up to 9, cone 0 to 28.647";
    assert!(
        text.contains(spot) && text.contains("\nlight         directional, 0.5 0.5 0.5 lx, towards 0 0 -1\n"),
        "{text}"
    );
    let json: Value = serde_json::from_str(&output(&["info", &path, "--json"])).expect("JSON");
    assert_eq!(json["lights"][0]["intensity"], json!([0.0, 20.0, 0.0]));
    assert_eq!((&json["lights"][1]["kind"], &json["lights"][1]["place"]), (&json!("directional"), &Value::Null));
    let middle = |lights: &str| {
        let seen = picture(&folder, &[&path, "--camera", "0,0", "--lights", lights, "--tone-curve", "none"]);
        seen.get_pixel(50, 50).0
    };
    let [on, off] = ["on", "off"].map(middle);
    assert!(on[1] > off[1] + 30 && on[0] > off[0], "{on:?} {off:?}");
    assert_eq!(picture(&folder, &["shape:torus"]), picture(&folder, &["shape:torus", "--lights", "off"]));
}
