//! `pnaen domain`: the tessellator's points and triangles.

use std::collections::HashSet;
use std::io::Write;
use std::process::Stdio;

use crate::{Folder, command, failure, output, sentence};

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
