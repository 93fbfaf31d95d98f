//! `pnaen turntable`: its pictures, and that nothing half written stays.

use std::path::Path;

use image::codecs::gif::GifDecoder;
use image::{AnimationDecoder, RgbaImage};

use crate::{Folder, failure, output, sentence};

const SIZE: [&str; 2] = ["--size", "96x72"];

fn names(folder: &str) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut names: Vec<_> =
        entries.map(|entry| entry.expect("an entry").file_name().into_string().expect("UTF-8")).collect();
    names.sort();
    names
}

fn picture(path: &Path) -> RgbaImage {
    image::open(path).expect("a picture").to_rgba8()
}

/// How much two pictures differ on average, of 255.
fn difference(a: &RgbaImage, b: &RgbaImage) -> f64 {
    let all = a.as_raw().iter().zip(b.as_raw()).map(|(a, b)| f64::from(a.abs_diff(*b)));
    all.sum::<f64>() / a.as_raw().len() as f64
}

#[test]
fn numbered_pictures_are_those_of_render_from_all_around() {
    let folder = Folder::new();
    let [turn, cameras] = ["turn", "cameras.txt"].map(|name| folder.path(name));
    let options = ["shape:cube-split", "--lod", "error", "--tolerance", "2", "--clip", "frustum"];
    output(&[&["turntable", "--frames", "4", "--camera", "10,20", "-o", &turn], &options[..], &SIZE].concat());
    let expected = ["frame-0000.png", "frame-0001.png", "frame-0002.png", "frame-0003.png"];
    assert_eq!(names(&turn), expected);
    let azimuths = ["10", "100", "190", "280"];
    let lines = azimuths.map(|azimuth| format!("at-{azimuth} --camera {azimuth},20\n"));
    std::fs::write(&cameras, lines.concat()).expect("a writable folder");
    let singles = folder.path("{}.png");
    output(&[&["render", "-o", &singles, "--cameras", &cameras], &options[..], &SIZE].concat());
    for (azimuth, name) in azimuths.into_iter().zip(expected) {
        let own = picture(&Path::new(&turn).join(name));
        let single = singles.replace("{}", &format!("at-{azimuth}"));
        assert!(own == picture(Path::new(&single)), "{name} isn't the picture of {azimuth}");
    }
    let [first, opposite] = [0, 2].map(|frame: usize| picture(&Path::new(&turn).join(expected[frame])));
    assert!(first != opposite);
    // Other files of a folder stay.
    std::fs::write(Path::new(&turn).join("notes.txt"), "mine").expect("a writable folder");
    output(&[&["turntable", "shape:torus", "--factor", "3", "--frames", "2", "-o", &turn], &SIZE[..]].concat());
    assert_eq!(names(&turn), [&expected[..], &["notes.txt"]].concat());
    assert!(picture(&Path::new(&turn).join(expected[0])) != first);
    let all = ["at-10.png", "at-100.png", "at-190.png", "at-280.png", "cameras.txt", "turn"];
    assert_eq!(names(&folder.path("")), all, "nothing half written stays");
}

#[test]
fn a_gif_has_the_pictures_and_repeats() {
    let folder = Folder::new();
    let (gif, turn) = (folder.path("turn.gif"), folder.path("turn"));
    let options = ["shape:cube-split", "--factor", "4", "--frames", "3"];
    for place in [&gif, &turn] {
        output(&[&["turntable", "--fps", "10", "-o", place, "--transparent"], &options[..], &SIZE].concat());
    }
    let bytes = std::fs::read(&gif).expect("a file");
    assert!(bytes.windows(11).any(|window| window == b"NETSCAPE2.0"), "it repeats");
    let decoder = GifDecoder::new(std::io::Cursor::new(bytes)).expect("a GIF file");
    let frames = decoder.into_frames().collect_frames().expect("frames");
    assert_eq!(frames.len(), 3);
    for (number, frame) in frames.iter().enumerate() {
        assert_eq!(frame.delay().numer_denom_ms(), (100, 1));
        let mut own = picture(&Path::new(&turn).join(format!("frame-{number:04}.png")));
        own.pixels_mut().filter(|pixel| pixel.0[3] < 128).for_each(|pixel| pixel.0 = [0; 4]);
        own.pixels_mut().filter(|pixel| pixel.0[3] >= 128).for_each(|pixel| pixel.0[3] = 255);
        let clear = frame.buffer().pixels().filter(|pixel| pixel.0[3] == 0).count();
        assert!(clear > 500, "nothing is behind the mesh: {clear}");
        let shown = RgbaImage::from_fn(own.width(), own.height(), |x, y| {
            let pixel = *frame.buffer().get_pixel(x, y);
            if pixel.0[3] == 0 { image::Rgba([0; 4]) } else { pixel }
        });
        let difference = difference(&shown, &own);
        assert!(difference < 2.0, "picture {number} differs by {difference}");
    }
}

#[test]
fn lod_follows_the_camera_unless_it_has_its_own() {
    let folder = Folder::new();
    let turn = folder.path("turn");
    let options = ["shape:torus", "--lod", "error", "--clip", "frustum", "--overlay", "wireframe", "--frames", "2"];
    let opposite = |more: &[&str]| {
        output(&[&["turntable", "-o", &turn], &options[..], more, &SIZE].concat());
        picture(&Path::new(&turn).join("frame-0001.png"))
    };
    assert!(opposite(&[]) != opposite(&["--lod-camera", "30,20"]));
}

#[test]
fn what_cannot_be_written_is_said_and_leaves_nothing() {
    let folder = Folder::new();
    let usage = |arguments: &[&str], word: &str| {
        let said = failure(&[&["turntable", "shape:torus"], arguments].concat(), 2);
        assert!(said.contains(word), "{said}");
    };
    usage(&["-o", &folder.path("turn.mp4")], "not .mp4");
    usage(&["-o", &folder.path("turn"), "--frames", "1"], "from 2 to 3600");
    usage(&["-o", &folder.path("turn.gif"), "--fps", "100"], "from 1 to 50");
    sentence(&["turntable", "shape:torus", "-o", &folder.path("no/turn")], &["there is no folder"]);
    let missing = folder.path("no.csv");
    sentence(&["turntable", "shape:torus", "-o", &folder.path("turn"), "--factors", &missing], &["no.csv"]);
    let taken = folder.write("taken", "a file");
    let small = ["turntable", "shape:torus", "--factor", "1", "--frames", "2", "-o", &taken, "--size", "8x8"];
    sentence(&small, &["taken", "written"]);
    assert_eq!(names(&folder.path("")), ["taken"]);
}
