//! `pnaen adapters`, `--adapter`, and what works without any.

use crate::{Folder, command, failure, output, sentence};

#[test]
fn adapters_are_listed_and_one_of_them_is_taken() {
    let text = output(&["adapters"]);
    let taken: Vec<_> = text.lines().filter_map(|line| line.strip_prefix("* ")).collect();
    assert_eq!(taken.len(), 2, "an adapter, and what the star means: {text}");
    let name = taken[0].split(':').next().expect("a name").to_uppercase();
    let points = output(&["domain", "--partitioning", "integer", "--factors", "2,2,2,2"]);
    let chosen = output(&["domain", "--partitioning", "integer", "--factors", "2,2,2,2", "--adapter", &name]);
    assert_eq!(chosen, points, "by its name in capitals");
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
fn without_an_adapter_what_needs_none_still_works() {
    let folder = Folder::new("no-adapter");
    let [obj, indices] = ["out.obj", "out.json"].map(|name| folder.path(name));
    let without = |arguments: &[&str]| {
        let mut command = command(arguments);
        // No driver is there for any loader.
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
    // Direct3D and Metal are there without a driver's file.
    if cfg!(target_os = "linux") {
        for arguments in [&["adapters"][..], &["render", "shape:torus", "-o", &folder.path("out.png")]] {
            let (code, said) = without(arguments);
            assert_eq!(code, Some(1), "{arguments:?}: {said}");
            assert!(said.contains("no graphics adapter was found: install a Vulkan driver"), "{said}");
            assert_eq!(said.lines().count(), 1, "{said}");
        }
    }
    assert!(failure(&["adapters", "surplus"], 2).contains("surplus"));
}

/// The driver itself has no memory left, as far as this process may have any: the software one takes its own from it.
#[cfg(target_os = "linux")]
#[test]
fn a_driver_that_is_out_of_memory_is_said_in_a_sentence() {
    let folder = Folder::new("out-of-memory");
    let picture = folder.path("out.png");
    // In KiB; the picture takes two and a half GiB, all else less than one.
    let limited = r#"ulimit -v 2000000; exec "$0" "$@""#;
    let render = |size: &str| {
        let mut command = std::process::Command::new("sh");
        command.args(["-c", limited, env!("CARGO_BIN_EXE_pnaen"), "render", "shape:torus", "-o", &picture]);
        command.args(["--adapter", "software", "--factor", "4", "--size", size]);
        // Threads take memory, and there are as many as processors.
        let output = command.env("LP_NUM_THREADS", "1").env("MALLOC_ARENA_MAX", "1").output().expect("a shell");
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    assert_eq!(render("800x600").0, Some(0));
    std::fs::remove_file(&picture).expect("a picture");
    let (code, said) = render("8000x8000");
    assert_eq!(code, Some(1), "{said}");
    assert_eq!(
        said.trim_end(),
        "pnaen: the graphics device is out of memory: ask for a smaller picture, or open a smaller mesh"
    );
    assert!(!std::path::Path::new(&picture).exists(), "nothing is written");
}
