//! `pnaen render --overlay deviation` and `--reference-surface`: distances against closed forms, and errors.

use serde_json::Value;

use crate::{Folder, failure, number, output, sentence, stats};

/// The distance between the inscribed and the circumscribed sphere of a regular icosahedron; the latter has radius 1.
const GAP: f64 = 0.205_345_527;

fn near(value: f64, expected: f64, tolerance: f64) -> bool {
    (value - expected).abs() <= tolerance
}

#[test]
fn a_flat_icosahedron_is_a_fifth_of_its_radius_off_the_sphere() {
    let flat = ["shape:icosahedron", "--surface", "flat", "--factor", "1", "--overlay", "deviation,wireframe"];
    let stats = stats(&flat);
    for max in ["/accuracy/to_reference/max", "/accuracy/from_reference/max", "/deviation/max"] {
        let [least, most] = ["at_least", "at_most"].map(|end| number(&stats, &format!("{max}/{end}")));
        assert!(least <= GAP + 1e-7 && GAP - 1e-7 <= most && most - least <= 0.011 * GAP, "{max}: {stats}");
    }
    // The worst place of the first two is one of a face's middle and the point of the sphere above it.
    let place = |end: &str| [0, 1, 2].map(|i| number(&stats, &format!("/accuracy/to_reference/worst/{end}/{i}")));
    let length = |place: [f64; 3]| place.map(|x| x * x).iter().sum::<f64>().sqrt();
    assert!(near(length(place("reference_surface")), 1.0, 1e-6) && near(length(place("emitted")), 1.0 - GAP, 2e-3));
    let diagonal = 2.0 * 3.0_f64.sqrt();
    assert!(near(number(&stats, "/accuracy/diagonal"), diagonal, 1e-9));
    assert!(near(number(&stats, "/accuracy/to_reference/max_of_diagonal/at_least"), GAP / diagonal, 1e-3));
    let error = number(&stats, "/accuracy/to_reference/rms/error");
    assert!(error > 0.0 && error < 1e-3, "{stats}");
    let rms = ["/accuracy/to_reference/rms/value", "/deviation/rms"].map(|rms| number(&stats, rms));
    assert!(near(rms[0], rms[1], 1e-3) && rms[0] < GAP && rms[0] > 0.5 * GAP, "{rms:?}");
    assert_eq!(stats["deviation"]["scale"], serde_json::json!([0.0025, 0.25]));
    assert!(number(&stats, "/accuracy/max_px") > 10.0 && number(&stats, "/accuracy/normals/max") < 0.1, "{stats}");
    assert_eq!(stats["accuracy"]["reference_surface"], "shape:icosahedron");
}

#[test]
fn both_halves_of_a_split_are_measured_and_share_a_scale() {
    let split = ["--split", "0.5", "--split-left", "flat", "--overlay", "deviation,wireframe,cracks"];
    let drawn = |split: &[&str]| {
        let options = ["shape:icosahedron", "--surface", "pn-aen", "--factor", "32", "--partitioning", "integer"];
        stats(&[&options[..], split].concat())
    };
    let both = drawn(&split);
    let (left, right) = (number(&both, "/left/deviation/max/at_least"), number(&both, "/deviation/max/at_least"));
    // Flat triangles stay on the face, however finely it is cut. A patch's middle is the mean of its edges' control points,
    // (4 - c) / 3 times the face's, where c is the cosine between two corners.
    let curved = 1.0 - (4.0 - 0.2_f64.sqrt()) / 3.0 * (1.0 - GAP);
    assert!(near(left, GAP, 2e-6) && near(right, curved, 3e-4), "{left} and {right}, not {GAP} and {curved}");
    assert!(near(number(&both, "/left/accuracy/to_reference/max/at_most"), GAP, 0.011 * GAP), "{both}");
    assert_eq!(
        (&both["left"]["settings"]["surface"], &both["settings"]["surface"]),
        (&"flat".into(), &"pn-aen".into())
    );
    for scale in [&both["deviation"]["scale"], &both["left"]["deviation"]["scale"]] {
        assert_eq!(*scale, serde_json::json!([0.0025, 0.25]), "the scale of the larger deviation");
    }
    for equal in ["patches", "patches_culled", "triangles_out", "vertices_out"] {
        assert_eq!(both["left"][equal], both[equal], "the same factors");
    }
    assert_eq!(number(&both, "/left/cracks/edges"), 0.0);
    assert_eq!((number(&both, "/patches"), number(&both, "/left/folds")), (20.0, 0.0));
    let in_view = number(&both, "/left/triangles_in_view");
    assert!(in_view > 0.0 && in_view >= number(&both, "/left/triangles_below_3_px"), "{both}");
    assert!(["/left/ms/draw", "/ms/draw"].map(|ms| number(&both, ms)).iter().all(|ms| *ms > 0.0), "{both}");
    // The right half has the same numbers as without a split.
    let alone = drawn(&["--overlay", "deviation"]);
    assert_eq!(alone["left"], Value::Null);
    for same in ["max", "rms", "worst"] {
        assert_eq!(alone["deviation"][same], both["deviation"][same], "{same}");
    }
    assert_ne!(alone["deviation"]["scale"], both["deviation"]["scale"], "alone it has a scale of its own");
}

#[test]
fn without_a_reference_surface_both_halves_are_compared_with_the_right_ones_limit() {
    let smooth = ["shape:cube-smooth", "--factor", "8", "--overlay", "deviation", "--split", "0.5"];
    let of = |surfaces: [&str; 2]| {
        let both = stats(&[&smooth[..], &["--split-left", surfaces[0], "--surface", surfaces[1]]].concat());
        ["/left/deviation/max/at_least", "/deviation/max/at_least"].map(|max| number(&both, max))
    };
    let [flat, curved] = of(["flat", "pn-aen"]);
    assert!(flat > 10.0 * curved && curved > 1e-4, "{flat} and {curved}");
    let [curved, flat_alone] = of(["pn-aen", "flat"]);
    assert!(flat_alone < 1e-6 && curved > 0.5 * flat, "flat triangles are their own limit: {flat_alone} and {curved}");
}

#[test]
fn another_surface_needs_a_split() {
    let folder = Folder::new();
    let out = folder.path("out.png");
    let without = ["render", "shape:torus", "-o", &out, "--split-left", "flat"];
    assert!(failure(&without, 2).contains("--split"), "the error names the missing option");
    let strength = ["render", "shape:torus", "-o", &out, "--size", "60x40", "--split", "0.5", "--alpha", "0.5"];
    failure(&strength, 2);
    output(&[&strength[..], &["--split-left", "phong"]].concat());
}

#[test]
fn deviation_is_measured_against_a_given_mesh_or_the_limit_surface() {
    let folder = Folder::new();
    let high = folder.path("high.glb");
    output(&["tessellate", "shape:cube-smooth", "--surface", "pn", "--factor", "16", "-o", &high]);
    let against = |reference_shape: &[&str]| {
        let options = ["shape:cube-smooth", "--surface", "pn", "--factor", "4", "--overlay", "deviation"];
        stats(&[&options[..], reference_shape].concat())
    };
    let (mesh, limit) = (against(&["--reference-surface", &high]), against(&[]));
    assert_eq!(mesh["accuracy"]["reference_surface"], high.as_str());
    assert_eq!(limit["accuracy"], Value::Null, "a limit surface gives no accuracy");
    let of_accuracy = |key: &str| number(&mesh, &format!("/accuracy/{key}"));
    assert!(of_accuracy("to_reference/max/at_most") >= number(&mesh, "/deviation/max/at_least"), "{mesh}");
    assert!(of_accuracy("samples") > 200_000.0, "{mesh}");
    assert_eq!(limit["deviation"]["max"]["at_most"], Value::Null, "distances to a limit surface are sampled");
    let [mesh, limit] = [mesh, limit].map(|stats| number(&stats, "/deviation/max/at_least"));
    // The nearest point of the given mesh is no farther than the limit's point at the same domain point.
    assert!(mesh > 1e-4 && mesh < 1.1 * limit, "{mesh} and {limit}");
}

#[test]
fn accuracy_is_null_unless_asked_for_and_one_way_only_if_patches_are_left_out() {
    let plain = stats(&["shape:icosphere"]);
    assert_eq!((&plain["accuracy"], &plain["deviation"]), (&Value::Null, &Value::Null));
    let culled = stats(&["shape:icosphere", "--cull-back-faces", "--reference-surface", "shape:icosphere"]);
    assert!(number(&culled, "/patches_facing_away") > 0.0);
    assert_eq!(culled["accuracy"]["from_reference"], Value::Null);
    assert!(number(&culled, "/accuracy/to_reference/max/at_least") > 0.0);
}

#[test]
fn a_reference_surface_that_cannot_be_read_is_named() {
    let folder = Folder::new();
    let out = folder.path("out.png");
    let with = |reference_shape: &'static str| {
        ["render", "shape:torus", "-o", &out, "--size", "60x40", "--reference-surface", reference_shape]
            .map(str::to_owned)
    };
    let missing = with("nowhere.glb");
    sentence(&missing.each_ref().map(String::as_str), &["nowhere.glb"]);
    let unit = ["render", "shape:torus", "-o", &out, "--deviation-in", "miles"];
    assert!(failure(&unit, 2).contains("units, px"), "clap lists them");
}

#[test]
fn either_half_of_a_split_is_what_its_options_draw_alone() {
    let folder = Folder::new();
    let draw = |name: &str, options: &[&str]| {
        let path = folder.path(name);
        let usual = ["render", "shape:cube-smooth", "--overlay", "wireframe", "--size", "160x120", "-o", &path];
        output(&[&usual[..], options].concat());
        image::open(&path).expect("a picture").to_rgba8()
    };
    let right = ["--surface", "phong", "--lod", "error", "--tolerance", "2"];
    let left = "nagata,lod=distance,factor=7,distances=1,6,partitioning=integer,displacement=off";
    let both = draw("both.png", &[&right[..], &["--split", "0.5", "--split-left", left]].concat());
    let said = stats(&[&["shape:cube-smooth", "--split", "0.5", "--split-left", left], &right[..]].concat());
    assert_eq!((&said["left"]["settings"]["lod"], &said["settings"]["lod"]), (&"distance".into(), &"error".into()));
    let alone = draw("right.png", &right);
    let options = ["--lod", "distance", "--factor", "7", "--distances", "1,6", "--partitioning", "integer"];
    let left = draw("left.png", &[&["--surface", "nagata"], &options[..]].concat());
    assert!(left != alone);
    for (x, y, pixel) in both.enumerate_pixels() {
        let expected = if x < 80 { left.get_pixel(x, y) } else { alone.get_pixel(x, y) };
        assert_eq!(pixel, expected, "{x}, {y}");
    }
    let refused = ["render", "shape:torus", "-o", "a.png", "--split", "0.5", "--split-left"];
    for (left, said) in
        [("nowhere", "expected flat, pn"), ("pn,lod=none", "as lod"), ("pn,size=1", "expected a value of surface")]
    {
        assert!(failure(&[&refused[..], &[left]].concat(), 2).contains(said), "{left}");
    }
}

#[test]
fn the_left_half_of_a_split_may_look_otherwise() {
    let folder = Folder::new();
    let draw = |options: &[&str]| {
        let path = folder.path("picture.png");
        let usual = ["render", "shape:cube-smooth", "--factor", "5", "--size", "160x120", "-o", &*path];
        output(&[&usual[..], options].concat());
        image::open(&path).expect("a picture").to_rgba8()
    };
    let split = ["--overlay", "wireframe", "--split", "0.5", "--split-left", "pn-aen"];
    let (right, same) = (draw(&split[..2]), draw(&split));
    let alone: [(&str, &[&str]); 4] = [
        ("zebra,wireframe,zebra-stripes=40", &["--overlay", "zebra,wireframe", "--zebra-stripes", "40"]),
        ("factors,grid", &["--overlay", "factors,grid"]),
        ("overlay=", &[]),
        ("overlay=,lighting=camera", &["--lighting", "camera"]),
    ];
    for (looks, alone) in alone {
        let (both, left) = (draw(&[&split[..], &["--split-looks", looks]].concat()), draw(alone));
        assert!(both != same, "{looks}");
        // But for the last column: the software driver lets a sample of the right half in there.
        for (x, y, pixel) in both.enumerate_pixels().filter(|(x, ..)| *x != 79) {
            let expected = if x < 80 { left.get_pixel(x, y) } else { right.get_pixel(x, y) };
            assert_eq!(pixel, expected, "{looks}: {x}, {y}");
        }
    }
    assert_eq!(same, draw(&[&split[..], &["--split-looks", "wireframe"]].concat()));
    let difference = [&split[..], &["--split-view", "difference"]].concat();
    assert!(draw(&difference) != draw(&[&difference[..], &["--split-looks", "clay"]].concat()));
    let refused = ["render", "shape:torus", "-o", "a.png", "--split", "0.5", "--split-looks"];
    for (looks, said) in [
        ("odd", "expected wireframe, patches"),
        ("zebra,clay", "each of these colours the whole surface"),
        ("zebra,size=1", "expected a value of overlay"),
        ("", "expected a value of overlay"),
    ] {
        assert!(failure(&[&refused[..], &[looks]].concat(), 2).contains(said), "{looks}");
    }
}

#[test]
fn halves_side_by_side_show_the_middle_of_their_view_and_a_difference_what_differs() {
    let folder = Folder::new();
    let draw = |options: &[&str]| {
        let path = folder.path("picture.png");
        let camera = ["--camera", "20,15,6"];
        // Stripes that are reflected depend on the direction to the eye at each pixel.
        let usual =
            ["render", "shape:icosahedron", "--partitioning", "integer", "--overlay", "zebra", "--size", "160x120"];
        let usual = [&usual[..], &["-o", &*path]].concat();
        output(&[&usual[..], &camera, options].concat());
        image::open(&path).expect("a picture").to_rgba8()
    };
    let alone = ["1", "0"].map(|at| draw(&["--factor", "5", "--split", at]));
    let split = ["--factor", "5", "--split"];
    let beside = |at: &str| draw(&[&split[..], &[at, "--split-view", "beside"]].concat());
    let apart = |a: [u8; 4], b: [u8; 4]| a.iter().zip(b).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0);
    // The middle of the left 80 columns shows that of all, column 80; and likewise in unlike halves. Moved triangles are rounded
    // otherwise, and the software driver lets a sample of the right half into the last column of the left one.
    for (at, columns, shifts) in [("0.5", 80, [-40, 40]), ("0.25", 40, [-60, 20])] {
        let unlike = beside(at)
            .enumerate_pixels()
            .filter(|(x, y, pixel)| {
                let half = usize::from(*x >= columns);
                apart(alone[half].get_pixel(x.saturating_add_signed(-shifts[half]), *y).0, pixel.0) > 8
            })
            .count();
        assert!(unlike <= 120, "{unlike} px differ");
    }
    let difference = draw(&[&split[..], &["0.3", "--split-view", "difference"]].concat());
    for (x, y, pixel) in difference.enumerate_pixels() {
        let [a, b] = alone.each_ref().map(|own| own.get_pixel(x, y).0);
        let most = apart(a, b);
        let expected = if most == 0 { 0 } else { most.saturating_add(64) };
        assert_eq!(pixel.0, [expected, expected, expected, 255], "{x}, {y}: {a:?} and {b:?}");
    }
    let is_dark = |pixel: &&image::Rgba<u8>| pixel.0[0] == 0;
    let dark = difference.pixels().filter(is_dark).count();
    assert!((9600..19_000).contains(&dark), "{dark} of 19200 px are alike");
}

/// The difference between a cube as it is and a tessellation of it.
fn difference(tessellation: &[&str], more: &[&str]) -> image::RgbaImage {
    let folder = Folder::new();
    let path = folder.path("picture.png");
    let cube = ["render", "shape:cube-split", "--lod", "uniform"];
    let split = ["--split", "0.5", "--split-view", "difference", "--size", "160x120", "-o", &*path];
    output(&[&cube[..], tessellation, &split, more].concat());
    image::open(&path).expect("a picture").to_rgba8()
}

#[test]
fn lines_are_drawn_over_a_difference_and_change_nothing_beside_them() {
    let draw = |overlay: &[&str]| difference(&["--surface", "pn", "--factor", "4"], overlay);
    let [without, with] = [draw(&[]), draw(&["--overlay", "cracks"])];
    let is_grey = |[red, green, blue, alpha]: [u8; 4]| red == green && green == blue && alpha == 255;
    assert!(without.pixels().all(|pixel| is_grey(pixel.0)));
    let pairs = with.pixels().zip(without.pixels());
    let drawn: Vec<_> = pairs.filter(|(with, without)| with != without).map(|(with, _)| with.0).collect();
    assert!((150..10_000).contains(&drawn.len()), "{} px of lines", drawn.len());
    assert!(drawn.iter().all(|[red, green, blue, alpha]| red >= green && red >= blue && *alpha == 255));
    let red = drawn.iter().filter(|[red, green, _, _]| *red > 200 && *green < 120).count();
    assert!(red > 50, "{red} px have the colour of cracks");
}

#[test]
fn the_wireframes_of_both_halves_are_over_their_difference_in_a_colour_each() {
    let draw = |more: &[&str]| difference(&["--surface", "flat", "--factor", "2"], more);
    let (without, with) = (draw(&[]), draw(&["--overlay", "wireframe"]));
    assert_eq!(draw(&["--overlay", "wireframe", "--transparent"]), with, "nothing of it is transparent");
    let (mut right, mut both) = (0, 0);
    for (own, before) in with.pixels().zip(without.pixels()).filter(|(own, before)| own != before) {
        let [[r, g, b, alpha], [grey, ..]] = [own.0, before.0];
        assert_eq!((alpha, before.0), (255, [grey, grey, grey, 255]));
        // Blue is the right half's, and with the left half's orange it is a greenish grey.
        right += usize::from(b > 100 && b.saturating_sub(r) > 60);
        both += usize::from(g > 80 && r.saturating_sub(b) > 15);
    }
    // The left half has the cube's own edges alone.
    assert!(right > 60 && both > 25, "{right} px of the right half's lines, and {both} of both");
}

#[test]
fn another_mesh_left_of_a_split_is_drawn_and_counted_as_it_is_alone() {
    let folder = Folder::new();
    // The same bounding box, so that one camera sees both alike.
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    let [old, new] = [("old.obj", "f 1 2 3\n"), ("new.obj", "f 1 2 3 4\n")].map(|(name, faces)| {
        let path = folder.path(name);
        std::fs::write(&path, [square, faces].concat()).expect("a writable folder");
        path
    });
    let draw = |mesh: &str, options: &[&str]| {
        let path = folder.path("picture.png");
        let usual = ["render", mesh, "--overlay", "wireframe", "--partitioning", "integer", "--size", "160x120"];
        output(&[&usual[..], &["-o", &path], options].concat());
        image::open(&path).expect("a picture").to_rgba8()
    };
    let alone = [draw(&old, &["--factor", "1"]), draw(&old, &["--factor", "3"]), draw(&new, &["--factor", "5"])];
    let with = ["--factor", "5", "--split", "0.5", "--split-with", &old];
    let left = ["--split-left", "pn-aen,factor=3"];
    let pictures = [draw(&new, &with), draw(&new, &[&with[..], &left].concat())];
    for (both, left) in pictures.iter().zip(&alone) {
        // But for the last column: the software driver lets a sample of the right half in there.
        for (x, y, pixel) in both.enumerate_pixels().filter(|(x, ..)| *x != 79) {
            let expected = if x < 80 { left.get_pixel(x, y) } else { alone[2].get_pixel(x, y) };
            assert_eq!(pixel, expected, "{x}, {y}");
        }
    }
    let said = stats(&[&[&*new][..], &with].concat());
    let counted = ["triangles_in", "triangles_out"].map(|name| number(&said["left"], &format!("/{name}")));
    assert_eq!((said["left"]["mesh"].as_str(), counted), (Some(&*old), [1.0, 1.0]));
    assert_eq!(number(&said, "/triangles_in"), 2.0);
    // With the legend come a divider and the titles of both halves beside it.
    let titled = draw(&new, &[&with[..], &["--legend"]].concat());
    let plates = [10, 150]
        .map(|y| [-12, 11].map(|aside| titled.get_pixel((80 + aside) as u32, y.min(119)).0 == [24, 24, 24, 255]));
    assert_eq!((titled.get_pixel(80, 60).0, plates[0]), ([190, 190, 190, 255], [true, true]));
    let refused = failure(&["render", &new, "-o", "a.png", "--split-with", &old], 2);
    assert!(refused.contains("--split-with needs --split"), "{refused}");
    let missing = folder.path("missing.obj");
    let said = failure(&["render", &new, "-o", "a.png", "--split", "0.5", "--split-with", &missing], 1);
    assert!(said.contains("missing.obj can't be read"), "{said}");
}
