//! Surfaces, normals and displacement on the command line.

use serde_json::Value;

use crate::{Folder, SIMPLE_LIGHT, failure, number, output, sentence, stats};

/// A height image with a slope, a step and a single bright px, written into a folder.
fn height_image(folder: &Folder) -> String {
    let path = folder.path("heights.png");
    let image = image::GrayImage::from_fn(32, 32, |x, y| {
        image::Luma([if (x, y) == (20, 9) { 255 } else { (x * 4 + if y > 15 { 60 } else { 0 }) as u8 }])
    });
    image.save(&path).expect("a writable folder");
    path
}

fn text<'a>(stats: &'a Value, path: &str) -> &'a str {
    stats.pointer(path).and_then(Value::as_str).unwrap_or_default()
}

#[test]
fn stats_have_the_names_of_the_options_values() {
    let surfaces = ["flat", "pn", "pn-aen", "pn-crease", "phong", "phong-aen", "nagata", "nagata-aen"];
    let normals = ["linear", "quadratic", "surface"];
    for (index, surface) in surfaces.into_iter().enumerate() {
        let normals = normals[index % 3];
        let strength: &[&str] = if surface.starts_with("phong") { &["--alpha", "0.5"] } else { &[] };
        let stats = stats(&[&["shape:cube-split", "--surface", surface, "--normals", normals], strength].concat());
        assert_eq!((text(&stats, "/settings/surface"), text(&stats, "/settings/normals")), (surface, normals));
        let alpha = stats.pointer("/settings/alpha").and_then(Value::as_f64);
        assert_eq!(alpha, surface.starts_with("phong").then_some(0.5), "{surface}");
        let torn = number(&stats, "/cracks/different_bits") > 0.0;
        assert_eq!(torn, ["pn", "phong", "nagata"].contains(&surface), "{surface}");
    }
}

#[test]
fn an_image_displaces_any_surface_without_cracks() {
    let folder = Folder::new();
    let path = height_image(&folder);
    for surface in ["flat", "pn-aen", "phong-aen", "nagata-aen"] {
        let base =
            ["shape:cube-split", "--surface", surface, "--factor", "6", "--height", &path, "--height-scale", "0.2"];
        let on = stats(&base);
        assert_eq!(text(&on, "/settings/displacement"), "on", "{surface}");
        assert_eq!(number(&on, "/cracks/different_bits"), 0.0, "{surface}");
        assert_eq!(on.pointer("/leaks").and_then(Value::as_u64), Some(0), "{surface}");
        let torn = stats(&[&base[..], &["--displacement", "as-published"]].concat());
        assert!(number(&torn, "/cracks/different_bits") > 60.0, "{surface}");
    }
}

#[test]
fn a_displaced_mesh_stays_in_the_picture() {
    let folder = Folder::new();
    let (white, out) = (folder.path("white.png"), folder.path("out.png"));
    image::GrayImage::from_pixel(2, 2, image::Luma([255])).save(&white).expect("a folder of our own");
    let lift = ["--displacement", "on", "--height", &white, "--height-scale", "1", "--midlevel", "0"];
    output(
        &[&["render", "shape:icosphere", "--factor", "4", "-o", &out, "--size", "64x64"][..], &SIMPLE_LIGHT, &lift]
            .concat(),
    );
    let picture = image::open(&out).expect("a picture").to_rgba8();
    let background = picture[(0, 0)];
    let border = (0..64).flat_map(|i| [(i, 0), (i, 63), (0, i), (63, i)]);
    // The lifted sphere touches the border.
    let covered = border.filter(|&(x, y)| picture[(x, y)] != background).count();
    assert!(covered < 64 && picture[(32, 32)] != background, "{covered} of 256 px");
}

#[test]
fn both_devices_write_the_same_displaced_mesh() {
    let folder = Folder::new();
    let (image, [gpu, cpu]) = (height_image(&folder), ["gpu.obj", "cpu.obj"].map(|name| folder.path(name)));
    for (device, path) in [("gpu", &gpu), ("cpu", &cpu)] {
        let options = ["--height", &image, "--midlevel", "0.2", "--factor", "3", "--device", device];
        output(&[&["tessellate", "shape:torus", "-o", path][..], &options].concat());
    }
    let vertices = |path: &str| -> Vec<[f64; 3]> {
        let text = std::fs::read_to_string(path).expect("what was just written");
        let numbers = |line: &str| line.split(' ').map(|x| x.parse().expect("a number")).collect::<Vec<f64>>();
        let lines = text.lines().filter_map(|line| line.strip_prefix("v "));
        lines.map(|line| numbers(line)[..3].try_into().expect("three")).collect()
    };
    let (gpu, cpu) = (vertices(&gpu), vertices(&cpu));
    assert!(gpu.len() > 500 && gpu.len() == cpu.len());
    let apart = |(a, b): (&[f64; 3], &[f64; 3])| (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
    assert!(gpu.iter().zip(&cpu).map(apart).fold(0.0, f64::max) < 2e-5);
}

/// Two triangles of a material each, of which the first has a height image in its file.
fn two_materials(folder: &Folder) -> String {
    folder.write("two.mtl", "newmtl wall\ndisp -mm 0 0.25 white.png\nnewmtl roof\n");
    let white = image::GrayImage::from_pixel(2, 2, image::Luma([255]));
    white.save(folder.path("white.png")).expect("a folder of our own");
    let start = "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0.5 0.5\nvn 0 0 1\n";
    let faces = "usemtl wall\nf 1/1/1 2/1/1 3/1/1\nusemtl roof\nf 3/1/1 2/1/1 4/1/1\n";
    folder.write("two.obj", format!("{start}{faces}"))
}

/// The lowest and the highest z of a mesh as it is tessellated.
fn heights_of(folder: &Folder, mesh: &str, options: &[&str]) -> [f64; 2] {
    let path = folder.path("out.obj");
    let usual = ["tessellate", mesh, "-o", &path, "--lod", "uniform", "--factor", "2", "--device", "cpu"];
    output(&[&usual[..], options].concat());
    let text = std::fs::read_to_string(&path).expect("what was just written");
    let z = |line: &str| line.strip_prefix("v ")?.split(' ').nth(2)?.parse::<f64>().ok();
    text.lines().filter_map(z).fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], z| [a.min(z), b.max(z)])
}

#[test]
fn materials_are_displaced_as_the_file_and_the_options_say() {
    let folder = Folder::new();
    let mesh = two_materials(&folder);
    let white = folder.path("white.png");
    let roof = |amount: &str| format!("roof={white}{amount}");
    let [up, down, usual, wall] =
        [roof(",scale=0.5,midlevel=0"), roof(",scale=-0.5,midlevel=0.5"), roof(""), format!("wall={white},scale=1")];
    let on = ["--displacement", "on"];
    assert_eq!(heights_of(&folder, &mesh, &[]), [0.0, 0.0], "only if it is asked for");
    assert_eq!(heights_of(&folder, &mesh, &on), [0.0, 0.25]);
    assert_eq!(heights_of(&folder, &mesh, &["--height", "file"]), [0.0, 0.25]);
    assert_eq!(heights_of(&folder, &mesh, &["--height", &up]), [0.25, 0.5]);
    assert_eq!(heights_of(&folder, &mesh, &["--height", &down]), [-0.25, 0.25]);
    assert_eq!(heights_of(&folder, &mesh, &["--height", &up, "--height", &wall]), [0.5, 0.5]);
    // The bounding radius is half of the square root of 2.
    let [low, high] = heights_of(&folder, &mesh, &["--height", &usual, "--height-scale", "1", "--midlevel", "0"]);
    assert!(low == 0.25 && (high - 0.5_f64.sqrt()).abs() < 1e-6, "{low} {high}");
    let render = ["render", &mesh, "-o", "unused.png", "--height"];
    let with = |more: &[&'static str]| [&render[..], more].concat();
    sentence(&with(&["floor=a.png"]), &["no material \"floor\"", "\"wall\", \"roof\""]);
    for wrong in [&["wall=a.png,scale=x"][..], &["=a.png"], &["wall=a.png", "--height", "b.png"]] {
        failure(&with(wrong), 2);
    }
}

#[test]
fn parts_are_displaced_by_images_of_one_floating_point_channel() {
    let folder = Folder::new();
    // TIFF 6.0: numbers about one px, each with its tag, its type (3 for 16 bits), how many there are, and itself; then 0.25.
    let tags = [256, 257, 258, 259, 262, 273, 277, 278, 279, 284, 339];
    let values = [1, 1, 32, 1, 1, 146, 1, 1, 4, 1, 3];
    let mut bytes = b"II\x2a\0\x08\0\0\0\x0b\0".to_vec();
    for (tag, value) in tags.into_iter().zip(values) {
        bytes.extend([tag, 3, 1, 0, value, 0].map(u16::to_le_bytes).as_flattened());
    }
    bytes.extend([0; 4]);
    bytes.extend(0.25_f32.to_le_bytes());
    let image = folder.write("quarter.tif", bytes);
    let start = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 5 1 0\nvt 0.5 0.5\nvn 0 0 1\n";
    let mesh = folder.write("parts.obj", format!("{start}o near\nf 1/1/1 2/1/1 3/1/1\no far\nf 4/1/1 5/1/1 6/1/1\n"));
    let of = |name: &str, amount: &str| format!("{name}={image}{amount}");
    let [near, far] = [of("near", ",scale=2,midlevel=0"), of("far", ",scale=-1,midlevel=0")];
    assert_eq!(heights_of(&folder, &mesh, &["--height", &near]), [0.0, 0.5]);
    assert_eq!(heights_of(&folder, &mesh, &["--height", &near, "--height", &far]), [-0.25, 0.5]);
    sentence(
        &["render", &mesh, "-o", "unused.png", "--height", "no=a.png"],
        &["no material \"no\"", "\"near\"", "\"far\""],
    );
}

#[test]
fn bad_height_images_are_named_and_wrong_options_are_usage_errors() {
    let folder = Folder::new();
    let out = folder.path("out.png");
    let text = folder.write("notes.txt", "no image");
    let render = |options: &[&'static str]| [&["render", "shape:torus", "-o", "unused.png"][..], options].concat();
    sentence(&["render", "shape:torus", "-o", &out, "--height", "nowhere.png"], &["nowhere.png", "height image"]);
    sentence(&["render", "shape:torus", "-o", &out, "--height", &text], &["notes.txt", "height image"]);
    sentence(&["render", "shape:torus", "-o", &out, "--displacement", "on"], &["no material has a base colour image"]);
    for wrong in [
        &["--height-scale", "2"][..],
        &["--height-scale", "nan"],
        &["--midlevel", "1.5"],
        &["--alpha", "-0.1"],
        &["--normals", "flat"],
        &["--displacement", "maybe"],
        // These options have no effect without Phong or without heights.
        &["--alpha", "0.5"],
        &["--height-scale", "0.1"],
        &["--midlevel", "0.1"],
        &["--crease-band", "0.02", "--animation", "Walk"],
        &["--crease-band", "-1"],
    ] {
        failure(&render(wrong), 2);
    }
    assert!(!std::path::Path::new(&out).exists());
}

#[test]
fn help_names_the_source_of_every_technique() {
    let help = output(&["render", "--help"]);
    let said = |name: &str, words: &[&str]| {
        let line = help.lines().find(|line| line.trim_start().starts_with(&format!("- {name}:")));
        let line = line.unwrap_or_else(|| panic!("{name} isn't explained"));
        words.iter().for_each(|word| assert!(line.contains(word), "{line}"));
    };
    said("pn", &["Vlachos et al. 2001"]);
    said("pn-aen", &["McDonald and Kilgard 2010"]);
    said("pn-crease", &["Vlachos et al. 2001, section 3.4"]);
    said("phong", &["Boubekeur and Alexa 2008"]);
    said("nagata", &["Nagata 2005"]);
    said("quadratic", &["Vlachos et al. 2001, section 3.3"]);
    said("on", &["McDonald 2011"]);
    said("fractional-odd", &["Direct3D 11.3"]);
    said("subtriangulation", &["Vlachos et al. 2001, figure 4"]);
    said("error", &["Filip et al. 1986"]);
}
