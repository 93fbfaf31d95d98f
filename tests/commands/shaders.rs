//! `pnaen shaders`: which files it writes, and what it refuses.

use crate::{Folder, failure, output};

/// The files of each language.
const FILES: [(&str, &[&str]); 3] =
    [("glsl", &["patch.vert", "patch.tesc", "patch.tese"]), ("hlsl", &["patch.hlsl"]), ("wgsl", &["tessellate.wgsl"])];

#[test]
fn every_language_has_its_files_with_command_licence_and_layout() {
    let folder = Folder::new();
    for (language, names) in FILES {
        let out = folder.path(language);
        output(&["shaders", "--language", language, "--lod", "edge-length", "--pixels", "12", "-o", &out]);
        let mut there: Vec<_> = std::fs::read_dir(&out)
            .expect("the folder")
            .map(|entry| entry.expect("an entry").file_name().into_string().expect("UTF-8"))
            .collect();
        there.sort();
        let mut expected: Vec<_> = names.iter().map(ToString::to_string).chain(["README.md".to_owned()]).collect();
        expected.sort();
        assert_eq!(there, expected);
        for name in there {
            let text = std::fs::read_to_string(format!("{out}/{name}")).expect("a file");
            assert!(text.contains("MIT OR Apache-2.0"), "{name} has no licence");
            assert!(text.contains(&format!("--language {language} --lod edge-length")), "{name} has no command");
            assert!(text.contains("here 12: the length of a segment"), "{name} has no constants");
            assert!(!text.contains('@') || language == "wgsl", "{name} has something left to fill in");
        }
    }
}

#[test]
fn what_cant_be_exported_is_refused_before_anything_is_written() {
    let folder = Folder::new();
    let out = folder.path("out");
    for (options, words) in [
        (&["--lod", "error"][..], "choose --lod uniform"),
        (&["--partitioning", "rows"], "choose --language wgsl"),
        (&["--displacement", "on", "--lod", "error"], "choose --lod uniform, distance, edge-length or paper"),
    ] {
        let said = failure(&[&["shaders", "--language", "hlsl", "-o", &out], options].concat(), 2);
        assert!(said.contains(words), "{said}");
        assert!(!std::path::Path::new(&out).exists());
    }
}

#[test]
fn shaders_that_displace_say_what_they_take_besides() {
    let folder = Folder::new();
    for (language, names) in FILES {
        let out = folder.path(language);
        let options = ["--displacement", "as-published", "--height-scale", "0.125", "--midlevel", "0.25"];
        output(&[&["shaders", "--language", language, "-o", &out], &options[..]].concat());
        for name in names.iter().chain(&["README.md"]) {
            let text = std::fs::read_to_string(format!("{out}/{name}")).expect("a file");
            for said in
                ["displacement as-published", "18 a patch", "40 bytes a corner", "here 0.125 times", "here 0.25:"]
            {
                // Long lines are wrapped.
                let words = text.replace("\n//", "").split_whitespace().collect::<Vec<_>>().join(" ");
                assert!(words.contains(said), "{name} doesn't say {said:?}");
            }
            assert!(!text.contains("@D@") && !text.contains("@N@"), "{name} has something left to choose");
        }
    }
}

#[test]
fn shaders_that_displace_by_the_view_say_what_finds_levels_at_points() {
    let folder = Folder::new();
    for (language, names, levels) in [
        ("glsl", FILES[0].1, Some("levels.comp")),
        ("hlsl", FILES[1].1, Some("levels.hlsl")),
        // The passes themselves do it.
        ("wgsl", FILES[2].1, None),
    ] {
        let out = folder.path(language);
        output(&["shaders", "--language", language, "--displacement", "on", "--lod", "distance", "-o", &out]);
        let mut there: Vec<_> = std::fs::read_dir(&out)
            .expect("the folder")
            .map(|entry| entry.expect("an entry").file_name().into_string().expect("UTF-8"))
            .collect();
        there.sort();
        let mut expected: Vec<_> = names.iter().copied().chain(levels).chain(["README.md"]).collect();
        expected.sort_unstable();
        assert_eq!(there, expected);
        let readme = std::fs::read_to_string(format!("{out}/README.md")).expect("a file");
        let said = levels.unwrap_or("`kept_levels`");
        assert!(readme.contains(said) && readme.contains("zeros"), "README.md doesn't say {said}");
        assert!(readme.contains("styles of `--part` aren't exported"), "{readme}");
        for name in there {
            let text = std::fs::read_to_string(format!("{out}/{name}")).expect("a file");
            assert!(["@D@", "@N@", "@U@", "@V@"].iter().all(|mark| !text.contains(mark)), "{name} has a mark left");
        }
    }
}
