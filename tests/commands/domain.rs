//! `pnaen domain`: the tessellator's points, triangles and lines.

use std::collections::HashSet;
use std::io::Write;
use std::process::Stdio;

use crate::{Folder, assert_says, command, failure, output, sentence};

#[test]
fn both_devices_print_the_same_domain() {
    let folder = Folder::new();
    let sets = folder.path("sets.txt");
    let text = "1 1 1 1\n2.5 3 7.25 4\n\nnan 1 1 1\n0 1 1 1\n-1 2 3 4\ninf 1 1 inf\n1 1 1 3\n64 64 64 64\n";
    std::fs::write(&sets, text).expect("a writable folder");
    for partitioning in ["integer", "pow2", "fractional-odd", "fractional-even"] {
        let domain = |device| output(&["domain", "--partitioning", partitioning, "--input", &sets, "--device", device]);
        let (gpu, cpu) = (domain("gpu"), domain("cpu"));
        assert!(gpu == cpu, "{partitioning}: the devices differ");
        let numbers: HashSet<&str> = cpu.lines().filter_map(|line| line.split(',').next()).collect();
        assert_eq!(numbers, HashSet::from(["0", "1", "5", "6", "7"]), "culled sets print nothing, but are counted");
    }
}

#[test]
fn pow2_is_integer_to_the_tessellator_and_the_help_says_so() {
    let domain =
        |partitioning| output(&["domain", "--partitioning", partitioning, "--factors", "3,5,6.5,7", "--device", "cpu"]);
    assert_eq!(domain("pow2"), domain("integer"));
    let help = output(&["domain", "--help"]).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(help.contains("pow2 gives what integer gives"), "{help}");
}

#[test]
fn points_and_triangles_are_printed_in_order() {
    let text = output(&["domain", "--partitioning", "integer", "--factors", "1,1,1,2", "--device", "cpu"]);
    let expected = "point,0,0,65536\npoint,1,0,0\npoint,2,65536,0\npoint,3,21845,21845\n\
                    triangle,3,0,1\ntriangle,3,1,2\ntriangle,3,2,0\n";
    assert_eq!(text, expected);
    assert_eq!(output(&["domain", "--partitioning", "fractional_odd", "--factors", "-3,1,nan,2"]), "");
}

#[test]
fn subtriangulation_needs_four_equal_factors() {
    let folder = Folder::new();
    let sets = folder.path("sets.txt");
    let text = "1 1 1 1\n1.5 1.5 1.5 1.5\n0 1 2 3\nnan nan nan nan\ninf inf inf inf\n";
    std::fs::write(&sets, text).expect("a writable folder");
    let pattern = ["domain", "--partitioning", "subtriangulation"];
    let domain = |device| output(&[&pattern[..], &["--input", &sets, "--device", device]].concat());
    let (gpu, cpu) = (domain("gpu"), domain("cpu"));
    assert!(gpu == cpu, "the devices differ");
    let of = |prefix: &str| cpu.lines().filter(|line| line.starts_with(prefix)).count();
    let counts = [0, 1, 2, 3, 4].map(|set| [of(&format!("{set},point,")), of(&format!("{set},triangle,"))]);
    assert_eq!(counts, [[3, 1], [6, 4], [0, 0], [0, 0], [2145, 4096]]);

    let one = output(&[&pattern[..], &["--factors", "2,2,2,2", "--device", "cpu"]].concat());
    let expected = "point,0,0,65536\npoint,1,0,32768\npoint,2,0,0\npoint,3,32768,0\npoint,4,65536,0\n\
                    point,5,32768,32768\ntriangle,0,1,5\ntriangle,2,3,1\ntriangle,4,5,3\ntriangle,1,3,5\n";
    assert_eq!(one, expected);
    let said = failure(&[&pattern[..], &["--factors", "2,2,2,3"]].concat(), 2);
    assert!(said.contains("four equal factors"), "{said}");
    std::fs::write(&sets, "1 1 1 1\n\n2 2 3 2\n").expect("a writable folder");
    sentence(&[&pattern[..], &["--input", &sets]].concat(), &["sets.txt, line 3", "four equal factors"]);
}

#[test]
fn a_closed_pipe_is_no_failure() {
    let mut child = command(&["domain", "--partitioning", "integer", "--factors", "64,64,64,64", "--device", "cpu"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("the program ends");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn sets_of_factors_can_come_from_standard_input() {
    let mut child = command(&["domain", "--partitioning", "integer", "--input", "-", "--device", "cpu"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program starts");
    child.stdin.take().expect("a pipe").write_all(b"1 1 1 1\n").expect("it reads");
    let output = child.wait_with_output().expect("the program ends");
    assert_eq!(
        String::from_utf8_lossy(&output.stdout),
        "0,point,0,0,65536\n0,point,1,0,0\n0,point,2,65536,0\n0,triangle,0,1,2\n"
    );
}

#[test]
fn quads_and_isolines_are_printed_in_order() {
    let quad = ["domain", "--kind", "quad", "--partitioning"];
    let text = output(&[&quad[..], &["integer", "--factors", "1,1,1,1,1,2"]].concat());
    let expected = "point,0,0,65536\npoint,1,0,0\npoint,2,65536,0\npoint,3,65536,65536\npoint,4,32768,32768\n\
                    triangle,4,0,1\ntriangle,4,1,2\ntriangle,4,2,3\ntriangle,4,3,0\n";
    assert_eq!(text, expected);
    assert_eq!(output(&[&quad[..], &["fractional-even", "--factors", "2,2,nan,2,2,2"]].concat()), "");

    let folder = Folder::new();
    let sets = folder.path("sets.txt");
    std::fs::write(&sets, "1 1\n0 4\n4 nan\n2 2.5\n").expect("a writable folder");
    let text = output(&["domain", "--kind", "isoline", "--partitioning", "fractional_odd", "--input", &sets]);
    let expected = "0,point,0,0,0\n0,point,1,65536,0\n0,line,0,1\n\
                    3,point,0,0,0\n3,point,1,16384,0\n3,point,2,49152,0\n3,point,3,65536,0\n\
                    3,point,4,0,32768\n3,point,5,16384,32768\n3,point,6,49152,32768\n3,point,7,65536,32768\n\
                    3,line,0,1\n3,line,1,2\n3,line,2,3\n3,line,4,5\n3,line,5,6\n3,line,6,7\n";
    assert_eq!(text, expected);
}

#[test]
fn each_kind_takes_its_own_number_of_factors() {
    let folder = Folder::new();
    let sets = folder.path("sets.txt");
    std::fs::write(&sets, "1 1 1 1\n").expect("a writable folder");
    for (kind, factors, wanted) in [
        ("tri", "1,1,1", "four numbers"),
        ("quad", "1,1,1,1", "six numbers"),
        ("isoline", "1,1,1,1,1,1", "two numbers"),
    ] {
        let pattern = ["domain", "--kind", kind, "--partitioning", "integer"];
        let said = failure(&[&pattern[..], &["--factors", factors]].concat(), 2);
        assert!(said.contains(wanted), "{said}");
        if kind != "tri" {
            sentence(&[&pattern[..], &["--input", &sets]].concat(), &["sets.txt, line 1", wanted]);
        }
    }
    for options in
        [&["rows"][..], &["subtriangulation"], &["pow2", "--device", "gpu"], &["pow2", "--adapter", "software"]]
    {
        let isolines = ["domain", "--kind", "isoline", "--factors", "1,1", "--partitioning"];
        let said = failure(&[&isolines[..], options].concat(), 2);
        assert!(said.contains("quads and isolines"), "{said}");
    }
}

#[test]
fn a_pattern_of_each_kind_is_drawn_with_its_factors() {
    let folder = Folder::new();
    let file = folder.path("pattern.svg");
    for (kind, factors, [points, joined], texts) in [
        ("tri", "1,2.5,1,2", [6, 5], &["u = 0: 1<", "v = 0: 2.5<", "w = 0: 1<", "inside: 2<"][..]),
        ("quad", "1,1,1,1,1,2", [5, 4], &["u = 0: 1<", "v = 1: 1<", "inside along u: 1<", "inside along v: 2<"][..]),
        ("isoline", "2,3", [8, 6], &["u = 0, isolines: 2<", "v = 0, segments: 3<"][..]),
        ("tri", "nan,1,1,1", [0, 0], &["u = 0: NaN<"][..]),
    ] {
        let pattern = ["domain", "--kind", kind, "--partitioning", "integer", "--factors", factors, "-o", &file];
        let device = if kind == "tri" { &["--device", "cpu"][..] } else { &[] };
        assert_eq!(output(&[&pattern[..], device].concat()), "", "the picture takes the numbers' place");
        let drawn = std::fs::read_to_string(&file).expect("a picture");
        let of = |element: &str| drawn.matches(element).count();
        assert_eq!([of("<circle "), of("<path ")], [points, joined], "{kind} {factors}");
        assert!(drawn.starts_with("<svg ") && drawn.ends_with("</svg>\n"), "{drawn}");
        assert_says(&drawn, texts);
    }
}

#[test]
fn a_triangle_is_drawn_with_equal_sides_and_a_quad_as_a_square() {
    let folder = Folder::new();
    let file = folder.path("pattern.svg");
    for (kind, factors, sides) in [("tri", "1,1,1,1", [480.0; 3]), ("quad", "1,1,1,1,1,1", [480.0, 480.0, 678.8])] {
        let pattern = ["domain", "--kind", kind, "--partitioning", "integer", "--factors", factors, "-o", &file];
        let device = if kind == "tri" { &["--device", "cpu"][..] } else { &[] };
        output(&[&pattern[..], device].concat());
        let drawn = std::fs::read_to_string(&file).expect("a picture");
        let (_, rest) = drawn.split_once("<path d=\"M").expect("a triangle");
        let (corners, _) = rest.split_once('z').expect("its end");
        let corner = |text: &str| {
            let (x, y) = text.split_once(',').expect("two numbers");
            [x, y].map(|number| number.parse::<f64>().expect("a number"))
        };
        let corners: Vec<_> = corners.split(' ').map(corner).collect();
        let side = |i: usize, k: usize| (corners[i][0] - corners[k][0]).hypot(corners[i][1] - corners[k][1]);
        let mut drawn = [side(0, 1), side(1, 2), side(2, 0)];
        drawn.sort_by(f64::total_cmp);
        assert!(drawn.iter().zip(sides).all(|(drawn, side)| (drawn - side).abs() < 0.1), "{kind}: {drawn:?}");
    }
}

#[test]
fn a_diagram_that_cannot_be_written_says_why() {
    let folder = Folder::new();
    let pattern = ["domain", "--kind", "quad", "--partitioning", "integer"];
    let factors = ["--factors", "1,1,1,1,1,2"];
    let said = failure(&[&pattern[..], &factors, &["-o", "pattern.png"]].concat(), 2);
    assert!(said.contains("name it .svg"), "{said}");
    let nowhere = folder.path("nowhere/pattern.svg");
    sentence(&[&pattern[..], &factors, &["-o", &nowhere]].concat(), &["pattern.svg", "nowhere"]);
    let sets = folder.path("sets.txt");
    std::fs::write(&sets, "1 1 1 1 1 2\n").expect("a writable folder");
    let said = failure(&[&pattern[..], &["--input", &sets, "-o", "pattern.svg"]].concat(), 2);
    assert!(said.contains("cannot be used with"), "{said}");
}
