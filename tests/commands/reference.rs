//! `pnaen render --reference`: when two pictures are the same, and what it says.

use image::RgbaImage;
use serde_json::Value;

use crate::picture_file::{ADAPTER, texts};
use crate::{Folder, assert_says, both, command, failure, number};

const SCENE: [&str; 6] = ["render", "shape:torus", "--size", "160x120", "--factor", "3"];

/// Draws the scene with more options, and returns what is said of it. It fails or doesn't, as it must.
fn compared(folder: &Folder, reference: &str, more: &[&str], is_same: bool) -> String {
    let now = folder.path("now.png");
    let arguments = [&SCENE[..], &["-o", &now, "--reference", reference], more].concat();
    let said = if is_same { both(&arguments).1 } else { failure(&arguments, 1) };
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.contains(if is_same { " is the same as " } else { " differs from " }), "{said}");
    said
}

fn draw(path: &str) -> RgbaImage {
    both(&[&SCENE[..], &["-o", path]].concat());
    image::open(path).expect("a PNG file").to_rgba8()
}

/// Writes a picture as another adapter would, or as a program that says nothing of itself.
fn save(path: &str, picture: &RgbaImage, adapter: Option<&str>) {
    let file = std::fs::File::create(path).expect("a writable folder");
    let mut encoder = png::Encoder::new(file, picture.width(), picture.height());
    encoder.set_color(png::ColorType::Rgba);
    if let Some(adapter) = adapter {
        encoder.add_itxt_chunk(ADAPTER.to_owned(), adapter.to_owned()).expect("before the header");
    }
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(picture.as_raw()).expect("its size");
}

/// The text that says what drew the pictures of this machine.
fn adapter(path: &str) -> String {
    texts(path).into_iter().find(|(keyword, ..)| keyword == ADAPTER).expect("a known adapter").1
}

#[test]
fn all_px_must_be_equal_where_the_same_driver_drew_both() {
    let folder = Folder::new();
    let golden = folder.path("golden.png");
    let mut picture = draw(&golden);
    let said = compared(&folder, &golden, &[], true);
    assert!(said.contains("all px are equal") && said.contains("the same adapter, driver and processor"), "{said}");
    assert!(!folder.0.path().join("now-diff.png").exists());
    let own = adapter(&golden);
    picture.get_pixel_mut(80, 60)[1] ^= 1;
    save(&golden, &picture, Some(&own));
    let said = compared(&folder, &golden, &[], false);
    assert_says(
        &said,
        &[
            "1 px differ, by up to 1 steps of 255",
            "none may since the same",
            "now-diff.png shows where",
            "draw the reference again",
        ],
    );
    let map = image::open(folder.path("now-diff.png")).expect("a PNG file").to_luma8();
    let bright: Vec<_> = map.enumerate_pixels().filter(|(.., pixel)| pixel[0] > 0).map(|(x, y, _)| (x, y)).collect();
    assert_eq!(bright, [(80, 60)]);
    compared(&folder, &golden, &["--light-rotation", "2"], false);
}

#[test]
fn pictures_of_other_drivers_and_of_unknown_ones_may_differ_a_little() {
    let folder = Folder::new();
    let golden = folder.path("golden.png");
    let mut picture = draw(&golden);
    let own = adapter(&golden);
    picture.pixels_mut().step_by(2).for_each(|pixel| pixel[1] = pixel[1].saturating_add(2));
    for (text, why) in [
        (Some("NVIDIA H200, NVIDIA 580.159.04"), "another adapter, driver or processor drew the reference"),
        (Some("a \u{26ab} card"), "another adapter, driver or processor drew the reference"),
        (None, "the reference doesn't say what drew it"),
    ] {
        save(&golden, &picture, text);
        let said = compared(&folder, &golden, &[], true);
        assert!(
            said.contains("differs by 1.00 steps on average, and 1.5 are allowed since") && said.contains(why),
            "{said}"
        );
        let said = compared(&folder, &golden, &["--light-rotation", "10"], false);
        assert!(said.contains(" on average, and 1.5 are allowed since") && said.contains(why), "{said}");
    }
    // A threshold that is given holds whatever drew the reference.
    save(&golden, &picture, Some(&own));
    compared(&folder, &golden, &[], false);
    for (threshold, is_same) in [("1", true), ("0.99", false)] {
        let said = compared(&folder, &golden, &["--threshold", threshold], is_same);
        assert!(said.contains(&format!("{threshold} are allowed since --threshold says so")), "{said}");
    }
}

#[test]
fn another_vector_width_is_another_adapter() {
    let folder = Folder::new();
    let golden = folder.path("golden.png");
    let draw = |width: &str, more: &[&str]| {
        let arguments = [&SCENE[..], &["--adapter", "software"], more].concat();
        let mut command = command(&arguments);
        // Mesa's cache doesn't tell the code of one width from that of another.
        command.env("LP_NATIVE_VECTOR_WIDTH", width).env("MESA_SHADER_CACHE_DISABLE", "true");
        let output = command.output().expect("the program starts");
        (output.status.success(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let (is_drawn, said) = draw("128", &["-o", &golden]);
    if !is_drawn || !adapter(&golden).contains("llvmpipe") {
        println!("there is no software driver whose width can be chosen: {said}");
        return;
    }
    assert!(adapter(&golden).contains("128 bits"), "{}", adapter(&golden));
    let now = folder.path("now.png");
    let again = ["-o", &now, "--reference", &golden];
    let (is_same, said) = draw("256", &again);
    assert!(is_same && said.contains("another adapter, driver or processor drew the reference"), "{said}");
    let (is_same, said) = draw("128", &again);
    assert!(is_same && said.contains("all px are equal"), "{said}");
}

#[test]
fn stats_say_which_comparison_was_made() {
    let folder = Folder::new();
    let [golden, now] = ["golden.png", "now.png"].map(|name| folder.path(name));
    draw(&golden);
    let reference = |more: &[&str]| {
        let own = ["-o", &now, "--reference", &golden, "--stats", "-", "--measure-error", "false"];
        let output = command(&[&SCENE[..], &own, more].concat()).output().expect("the program starts");
        let stats: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!(stats["reference"]["is_same"], output.status.success(), "{stats}");
        stats["reference"].clone()
    };
    let exact = reference(&["--exposure", "0.2"]);
    assert_eq!((&exact["comparison"], &exact["threshold"]), (&"exact".into(), &Value::Null));
    assert!(number(&exact, "/px_different") > 1000.0 && number(&exact, "/largest_step") > 5.0, "{exact}");
    let tolerant = reference(&["--threshold", "2.5"]);
    assert_eq!((&tolerant["comparison"], number(&tolerant, "/threshold")), (&"tolerant".into(), 2.5));
    assert_eq!(["/px_different", "/largest_step", "/worst_square"].map(|path| number(&tolerant, path)), [0.0; 3]);
}
