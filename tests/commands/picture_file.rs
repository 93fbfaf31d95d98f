//! What is in the pictures that `pnaen render` writes: texts, transparency and the legend.

use std::fs::File;
use std::io::BufReader;

use image::RgbaImage;

use crate::{Folder, failure, output, simple, vase};

/// The keyword of the text that says what drew a picture.
pub(crate) const ADAPTER: &str = "pnaen adapter";

/// The texts of a PNG file: keywords and texts, and which of them are UTF-8.
pub(crate) fn texts(path: &str) -> Vec<(String, String, bool)> {
    let file = BufReader::new(File::open(path).expect("a file"));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG file");
    reader.finish().expect("a whole file");
    let info = reader.info();
    let latin_1 = info.uncompressed_latin1_text.iter();
    let latin_1 = latin_1.map(|chunk| (chunk.keyword.clone(), chunk.text.clone(), false));
    let utf_8 = info.utf8_text.iter().map(|chunk| (chunk.keyword.clone(), chunk.get_text().expect("UTF-8"), true));
    latin_1.chain(utf_8).collect()
}

fn text(path: &str, keyword: &str) -> (String, bool) {
    let all = texts(path);
    let found = all.iter().find(|(key, ..)| key == keyword);
    found.map(|(_, text, is_utf_8)| (text.clone(), *is_utf_8)).unwrap_or_else(|| panic!("no {keyword} in {all:?}"))
}

/// Draws a [`simple`] picture. Its options are the last of the command.
fn drawn(arguments: &[&str], path: &str) -> RgbaImage {
    output(&[&["render"], &simple(arguments)[..], &["--size", "320x240", "-o", path], arguments].concat());
    image::open(path).expect("a PNG file").to_rgba8()
}

#[test]
fn a_picture_says_what_drew_it() {
    let folder = Folder::new();
    let path = folder.path("it's.png");
    drawn(&["shape:torus", "--factor", "3", "--overlay", "wireframe,cracks"], &path);
    let version = concat!("pnaen ", env!("CARGO_PKG_VERSION"));
    assert_eq!(text(&path, "Software"), (version.to_owned(), false));
    let (adapter, _) = text(&path, ADAPTER);
    let known = output(&["adapters"]);
    let used = known.lines().find_map(|line| line.strip_prefix("* ")).expect("an adapter");
    let (name, rest) = used.split_once(": ").expect("a name");
    let driver = rest.split_once("Vulkan, ").and_then(|(_, rest)| rest.split_once(';')).expect("a driver").0;
    assert!(adapter.starts_with(&format!("{name}, {driver}")), "{adapter} is not {used}");
    let (command, _) = text(&path, "pnaen command");
    let begins = "pnaen render --lighting camera --size 320x240 -o ";
    assert!(command.starts_with(begins), "{command}");
    assert!(command.ends_with(" shape:torus --factor 3 --overlay wireframe,cracks"), "{command}");
    let (settings, _) = text(&path, "pnaen settings");
    for line in ["surface: pn-aen", "factor: 3", "overlay: wireframe,cracks", "split: none", "cull-back-faces: off"] {
        assert!(settings.lines().any(|own| own == line), "{line} is not in {settings}");
    }
    assert!(!settings.contains("tolerance"), "it has no effect under uniform LOD: {settings}");
}

#[test]
fn a_name_beyond_latin_1_is_written_in_utf_8() {
    let folder = Folder::new();
    let path = folder.path("\u{26ab} ring \u{e4}.png");
    drawn(&["shape:torus"], &path);
    let (command, is_utf_8) = text(&path, "pnaen command");
    assert!(is_utf_8 && command.contains("\u{26ab} ring \u{e4}.png"), "{command}");
    let latin_1 = folder.path("ring \u{e4}.png");
    drawn(&["shape:torus"], &latin_1);
    let (command, is_utf_8) = text(&latin_1, "pnaen command");
    assert!(!is_utf_8 && command.contains("ring \u{e4}.png"), "{command}");
}

/// A pixel's channel over a background, mixed in linear light as the device does.
fn over(channel: u8, alpha: u8, background: u8) -> f32 {
    let linear = |byte: u8| (f32::from(byte) / 255.0).powf(2.2);
    let alpha = f32::from(alpha) / 255.0;
    (linear(channel) * alpha + linear(background) * (1.0 - alpha)).powf(1.0 / 2.2) * 255.0
}

#[test]
fn a_transparent_picture_over_a_colour_is_the_picture_on_that_colour() {
    let folder = Folder::new();
    let path = folder.path("out.png");
    let options = [vase(), "--overlay", "wireframe,grid", "--camera", "30,10"];
    let clear = drawn(&[&options[..], &["--transparent"]].concat(), &path);
    let opaque = drawn(&[&options[..], &["--background", "3264c8"]].concat(), &path);
    let alphas = |want: fn(u8) -> bool| clear.pixels().filter(|pixel| want(pixel.0[3])).count();
    let (none, full, part) = (alphas(|a| a == 0), alphas(|a| a == 255), alphas(|a| a > 0 && a < 255));
    assert!(none > 20_000 && full > 5_000 && part > 500, "{none} {full} {part}");
    assert_eq!(clear.get_pixel(1, 1).0, [0; 4]);
    assert!(opaque.pixels().all(|pixel| pixel.0[3] == 255));
    let mut largest = 0.0_f32;
    for (own, other) in clear.pixels().zip(opaque.pixels()) {
        for (channel, background) in [0x32, 0x64, 0xc8].into_iter().enumerate() {
            let mixed = over(own.0[channel], own.0[3], background);
            largest = largest.max((mixed - f32::from(other.0[channel])).abs());
        }
    }
    assert!(largest < 6.0, "{largest} of 255");
    let said = failure(&["render", vase(), "-o", &path, "--transparent", "--background", "ffffff"], 2);
    assert!(said.contains("--transparent") && said.contains("--background"), "{said}");
}

/// The smallest rectangle in which two pictures differ: least and greatest coordinates.
fn difference(a: &RgbaImage, b: &RgbaImage) -> Option<[[u32; 2]; 2]> {
    let different = a.enumerate_pixels().zip(b.pixels()).filter(|((.., own), other)| own != other);
    different.map(|((x, y, _), _)| [x, y]).fold(None, |found, [x, y]| {
        let [least, most] = found.unwrap_or([[x, y]; 2]);
        Some([[least[0].min(x), least[1].min(y)], [most[0].max(x), most[1].max(y)]])
    })
}

/// What every legend looks like, and in which pictures there is one, is tested in one process: `tests/gpu/legends.rs`.
#[test]
fn the_legend_is_in_the_lower_right_corner_if_it_is_asked_for() {
    let folder = Folder::new();
    let path = folder.path("out.png");
    let options = ["shape:torus", "--overlay", "factors"];
    let (plain, with) = (drawn(&options, &path), drawn(&[&options[..], &["--legend"]].concat(), &path));
    let [least, most] = difference(&plain, &with).expect("a legend");
    // The margin is 10 points, and a point 1 px in so small a picture.
    assert_eq!(most, [309, 229]);
    assert!(least[0] > 30 && least[1] > 130, "{least:?}");
}

#[test]
fn a_matcap_of_a_file_colours_the_surface() {
    let folder = Folder::new();
    let [path, sphere, none] = ["out.png", "sphere.png", "none.png"].map(|name| folder.path(name));
    let blue = image::Rgba([9, 80, 200, 255]);
    RgbaImage::from_pixel(8, 8, blue).save(&sphere).expect("a writable folder");
    let colors = ["shape:torus", "--overlay", "matcap"];
    let picture = drawn(&[&colors[..], &["--matcap-image", &sphere]].concat(), &path);
    let count = picture.pixels().filter(|pixel| **pixel == blue).count();
    assert!(count > 5000, "{count} px");
    assert!(drawn(&colors, &path).pixels().all(|pixel| *pixel != blue), "the usual one is made in code");
    let said = failure(&["render", "shape:torus", "-o", &path, "--matcap-image", &sphere], 2);
    assert!(said.contains("--overlay matcap"), "{said}");
    let of = |image: &str, more: &[&str], code: i32| {
        let own = ["render", "-o", &path, "--matcap-image", image];
        failure(&[&own[..], &colors, more].concat(), code)
    };
    let said = of(&sphere, &["--matcap", "pearl"], 2);
    assert!(said.contains("--matcap"), "{said}");
    let said = of(&none, &[], 1);
    assert!(said.contains("none.png") && said.contains("there is no such file"), "{said}");
    let said = of(&path, &[], 1);
    assert!(said.contains("isn't overwritten"), "{said}");
}
