//! `pnaen adapters` and `--adapter`, and the commands that work without an adapter.

use crate::{Folder, command, failure, output, sentence};

#[test]
fn adapters_are_listed_and_one_can_be_chosen() {
    let text = output(&["adapters"]);
    let taken: Vec<_> = text.lines().filter_map(|line| line.strip_prefix("* ")).collect();
    assert_eq!(taken.len(), 2, "the best adapter, and the line that explains the star: {text}");
    let name = taken[0].split(':').next().expect("a name").to_uppercase();
    let points = output(&["domain", "--partitioning", "integer", "--factors", "2,2,2,2"]);
    let chosen = output(&["domain", "--partitioning", "integer", "--factors", "2,2,2,2", "--adapter", &name]);
    assert_eq!(chosen, points, "its name in capitals chooses the adapter");
    let domain = |adapter| ["domain", "--partitioning", "integer", "--factors", "2,2,2,2", "--adapter", adapter];
    sentence(
        &domain("No \x1b[2Jsuch\nthing"),
        &["has \"No \u{fffd}[2Jsuch\u{fffd}thing\" in its name", "pnaen adapters"],
    );
    let software = |word| command(&domain(word)).output().expect("the program starts");
    let (small, large) = (software("software"), software("SOFTWARE"));
    assert_eq!((small.status, small.stdout, small.stderr), (large.status, large.stdout, large.stderr));
    assert!(failure(&domain(""), 2).contains("it has no name"));
}

#[test]
fn commands_that_need_no_adapter_work_without_one() {
    let folder = Folder::new();
    let [obj, indices] = ["out.obj", "out.json"].map(|name| folder.path(name));
    let without = |arguments: &[&str]| {
        let mut command = command(arguments);
        // The Vulkan loader finds no driver.
        for name in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
            command.env(name, "nowhere.json");
        }
        let output = command.output().expect("the program starts");
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    for arguments in [
        &["info", "shape:torus"][..],
        &["domain", "--partitioning", "pow2", "--factors", "3,3,3,3", "--device", "cpu"],
        &["adjacency", "shape:torus", "-o", &indices],
        &["tessellate", "shape:torus", "-o", &obj, "--device", "cpu"],
    ] {
        let (code, said) = without(arguments);
        assert_eq!(code, Some(0), "{arguments:?}: {said}");
    }
    // Direct3D and Metal need no driver file, so elsewhere an adapter may be found.
    if cfg!(target_os = "linux") {
        for arguments in [&["adapters"][..], &["render", "shape:torus", "-o", &folder.path("out.png")]] {
            let (code, said) = without(arguments);
            assert_eq!(code, Some(1), "{arguments:?}: {said}");
            assert!(said.contains("no graphics adapter was found"), "{said}");
            assert_eq!(said.lines().count(), 1, "{said}");
        }
    }
    assert!(failure(&["adapters", "surplus"], 2).contains("surplus"));
}

/// Limits the memory of the process, from which the software driver takes the device's memory.
#[cfg(target_os = "linux")]
#[test]
fn a_driver_that_is_out_of_memory_is_an_error_of_one_line() {
    let folder = Folder::new();
    let picture = folder.path("out.png");
    // The limit is in KiB. The picture takes 2.5 GiB, everything else less than 1 GiB.
    let limited = r#"ulimit -v 2000000; exec "$0" "$@""#;
    let render = |size: &str| {
        let mut command = std::process::Command::new("sh");
        command.args(["-c", limited, env!("CARGO_BIN_EXE_pnaen"), "render", "shape:torus", "-o", &picture]);
        command.args(["--adapter", "software", "--factor", "4", "--size", size]);
        // Fewer threads take less memory.
        let output = command.env("LP_NUM_THREADS", "1").env("MALLOC_ARENA_MAX", "1").output().expect("a shell");
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    assert_eq!(render("800x600").0, Some(0));
    std::fs::remove_file(&picture).expect("a picture");
    let (code, said) = render("8000x8000");
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("out of memory") && said.contains("smaller picture") && said.lines().count() == 1, "{said}");
    assert!(!std::path::Path::new(&picture).exists(), "nothing is written");
}
