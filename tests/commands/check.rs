//! `pnaen check`: a folder with an asset for each thing that can be wrong, its reports, its page and its cache.

use std::path::Path;

use serde_json::Value;

use crate::{Folder, assert_says, command, failure, output, run, sentence, vase, write_corners};

/// The configuration of [`assets`]: each file that fails has a section of its own.
const CONFIG: &str = r#"
fail-on = ["cracks", "factors", "leaks", "folds", "t-junctions"]

[options]
size = "160x120"
lighting = "camera"
partitioning = "integer"
factor = 3

[[files]]
path = "torn.glb"
[files.options]
surface = "pn"

[[files]]
path = "factors.glb"
fail-on = ["factors"]
[files.options]
edges = "as-published"
lod = "paper"
pixels = 4

[[files]]
path = "coarse.glb"
fail-on = ["above-tolerance", "triangles:100", "bytes:100"]
[files.options]
factor = 1
tolerance = 0.5
[files.cameras.front]
camera = [0, 10]
[files.cameras.near]
camera = [30, 20, 1.5]
field-of-view = 30

[[files]]
path = "triangles.gltf" # It is open, so that leaks mean nothing.
fail-on = ["cracks", "factors", "folds", "t-junctions"]
[files.options]
factor = 8

[[files]]
path = "open.obj"
fail-on = ["leaks"]

[[files]]
path = "assets/odd/"
fail-on = ["warnings:1", "t-junctions"]
"#;

/// Writes a sound asset, one that fails each gate, and one that is broken.
fn assets(folder: &Folder) {
    std::fs::create_dir_all(folder.path("assets/odd")).expect("a writable folder");
    std::fs::copy(vase(), folder.path("assets/good.glb")).expect("a copy");
    for (shape, name) in [("shape:cube-split", "torn"), ("shape:torus", "factors"), ("shape:torus", "coarse")] {
        let path = folder.path(&format!("assets/{name}.glb"));
        let options = ["--surface", "flat", "--factor", "1", "--partitioning", "integer", "--device", "cpu"];
        output(&[&["tessellate", shape, "-o", &path], &options[..]].concat());
    }
    let junction = "v 0 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 0.5 0.5 0\nf 1 2 3\nf 1 4 5\nf 5 4 2\nf 1 2 99\n";
    std::fs::write(folder.path("assets/odd/junction.obj"), junction).expect("a writable folder");
    std::fs::write(folder.path("assets/open.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("a writable folder");
    std::fs::write(folder.path("assets/broken.glb"), "no mesh").expect("a writable folder");
    std::fs::write(folder.path("assets/notes.txt"), "no asset").expect("a writable folder");
    let positions = [[0.0, 0.0, 0.0], [0.28, 0.0, 0.2], [1.0, 0.0, 0.0]];
    let leaning = [[0.0, 1.0, 0.0], [-0.77, 0.32, -0.56], [0.84, 0.28, 0.45]];
    write_corners(folder, &[0, 1, 2].map(|k| (positions[k], leaning[k])));
    for name in ["triangles.gltf", "data.bin"] {
        std::fs::rename(folder.path(name), folder.path(&format!("assets/{name}"))).expect("a writable folder");
    }
    std::fs::write(folder.path("pnaen.toml"), CONFIG).expect("a writable folder");
}

/// Runs the check in a folder. Returns the exit code, standard output and standard error.
fn check(folder: &Folder, arguments: &[&str]) -> (Option<i32>, String, String) {
    let [assets, config] = ["assets", "pnaen.toml"].map(|name| folder.path(name));
    let all = [&["check", &assets, "--config", &config], arguments].concat();
    let ran = run(&all);
    let [out, errors] = [ran.stdout, ran.stderr].map(|text| String::from_utf8(text).expect("UTF-8"));
    assert!(!errors.contains("panicked"), "{errors}");
    (ran.status.code(), out, errors)
}

/// What failed: for each asset its name, and the gates with their views.
fn failed(report: &Value) -> Vec<(String, Vec<String>)> {
    let text = |value: &Value| value.as_str().expect("a text").to_owned();
    let assets = report["assets"].as_array().expect("an array").iter();
    let of_asset = |asset: &Value| {
        let mut gates = Vec::new();
        for view in asset["views"].as_array().expect("an array") {
            let failed = view["gates"].as_array().expect("an array").iter().filter(|gate| gate["passed"] == false);
            gates.extend(failed.map(|gate| format!("{}{}", text(&view["name"]), text(&gate["name"]))));
        }
        let path = text(&asset["path"]);
        (Path::new(&path).file_name().expect("a name").to_string_lossy().into_owned(), gates)
    };
    assets.map(of_asset).collect()
}

#[test]
fn each_asset_fails_what_it_is_about_and_the_reports_agree() {
    let folder = Folder::new();
    assets(&folder);
    let page = folder.path("page");
    let (code, json, errors) = check(&folder, &["--format", "json", "--page", &page, "--jobs", "3"]);
    assert_eq!(code, Some(1), "{errors}");
    assert!(errors.contains("8 assets: 1 passed, 6 failed, 1 broken"), "{errors}");
    let report: Value = serde_json::from_str(&json).expect("JSON");
    let expected: [(&str, &[&str]); 8] = [
        ("broken.glb", &[]),
        (
            "coarse.glb",
            &[
                "frontabove-tolerance",
                "fronttriangles",
                "frontbytes",
                "nearabove-tolerance",
                "neartriangles",
                "nearbytes",
            ],
        ),
        ("factors.glb", &["factors"]),
        ("good.glb", &[]),
        ("junction.obj", &["warnings", "t-junctions"]),
        ("open.obj", &["leaks"]),
        ("torn.glb", &["cracks", "leaks"]),
        ("triangles.gltf", &["folds"]),
    ];
    let expected =
        expected.map(|(name, gates)| (name.to_owned(), gates.iter().map(|&gate| gate.to_owned()).collect::<Vec<_>>()));
    assert_eq!(failed(&report), expected);
    assert_eq!(report["assets"][0]["status"], "broken");
    assert!(report["assets"][0]["error"].as_str().is_some_and(|error| error.contains("broken.glb")));
    assert_eq!(report["assets"][3]["status"], "passed");
    assert!(report["assets"][4]["warnings"].as_array().is_some_and(|warnings| warnings.len() == 2), "{report}");

    let html = std::fs::read_to_string(Path::new(&page).join("index.html")).expect("a page");
    assert_eq!(html.matches("<section").count(), 8);
    // A picture for each view, and one for each failed gate that has a place.
    let (views, evidence) = (8, ["coarse", "coarse", "factors", "junction", "cracks", "leaks", "folds"].len());
    let shown: Vec<_> = html.split("src=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert_eq!(shown.len(), views + evidence);
    for picture in shown {
        image::open(Path::new(&page).join(picture)).expect("a picture beside the page");
    }
    assert!(html.contains("type=\"search\"") && html.len() < 100_000, "{}", html.len());
    assert!(!html.contains("src=\"h") && html.contains("prefers-color-scheme: dark"));

    // One thread gives the same, and the other formats have as many failures.
    let (_, alone, _) = check(&folder, &["--format", "json", "--jobs", "1"]);
    assert_eq!(alone, json);
    let (code, sarif, _) = check(&folder, &["--format", "sarif"]);
    let sarif: Value = serde_json::from_str(&sarif).expect("JSON");
    let count = expected.iter().map(|(_, gates)| gates.len()).sum::<usize>();
    assert_eq!((code, sarif["runs"][0]["results"].as_array().map(Vec::len)), (Some(1), Some(count + 1)));
    let path = folder.path("junit.xml");
    let (code, out, _) = check(&folder, &["--format", "junit", "-o", &path]);
    let junit = std::fs::read_to_string(path).expect("a file");
    assert_eq!((code, out.as_str(), junit.matches("<failure ").count()), (Some(1), "", count));
    assert_eq!(junit.matches("<testsuite ").count(), 8);
    let times: Vec<f64> = junit
        .split(" time=\"")
        .skip(1)
        .map(|rest| rest.split('"').next().expect("an end").parse().expect("s"))
        .collect();
    assert_eq!(times.len(), 1 + 8 + junit.matches("<testcase ").count());
    assert!(times[0] > 0.0 && times.iter().all(|time| *time >= 0.0), "{junit}");
    let why = "leaks can be counted only in a closed mesh, and this one is open: leave this gate out for it";
    assert!(junit.contains(&format!("<failure message=\"{why}\">{why}</failure>")), "{junit}");
    let results = sarif["runs"][0]["results"].as_array().expect("results");
    assert!(results.iter().any(|result| result["message"]["text"] == format!("leaks: {why}")), "{sarif}");
    let (_, text, _) = check(&folder, &[]);
    assert!(text.contains(&format!("        leaks: {why}\n")), "{text}");
}

#[test]
fn an_unchanged_asset_is_not_measured_again() {
    let folder = Folder::new();
    assets(&folder);
    let cache = folder.path("cache");
    let unchanged = |arguments: &[&str]| {
        let (code, json, errors) = check(&folder, &[&["--format", "json", "--cache", &cache], arguments].concat());
        assert_eq!(code, Some(1), "{errors}");
        let report: Value = serde_json::from_str(&json).expect("JSON");
        let names = report["assets"].as_array().expect("an array").iter().filter(|asset| asset["unchanged"] == true);
        let names: Vec<String> = names
            .map(|asset| asset["path"].as_str().and_then(|path| path.rsplit('/').next()).expect("a path").to_owned())
            .collect();
        (names, failed(&report))
    };
    let (none, first) = unchanged(&[]);
    assert_eq!(none, Vec::<String>::new());
    let (all, second) = unchanged(&[]);
    assert_eq!(
        all,
        ["coarse.glb", "factors.glb", "good.glb", "junction.obj", "open.obj", "torn.glb", "triangles.gltf"]
    );
    assert_eq!(first, second);
    // The buffer that the document names counts as well.
    let buffer = folder.path("assets/data.bin");
    let mut bytes = std::fs::read(&buffer).expect("a buffer");
    bytes[12] ^= 1;
    std::fs::write(&buffer, bytes).expect("a writable folder");
    assert!(!unchanged(&[]).0.contains(&"triangles.gltf".to_owned()));
    assert_eq!(unchanged(&["--fail-on", "triangles:1"]).0, Vec::<String>::new(), "other gates");
    let page = folder.path("page");
    assert_eq!(unchanged(&["--page", &page]).0, Vec::<String>::new(), "pictures were not drawn before");
    assert_eq!(unchanged(&["--page", &page]).0.len(), 7);
    let html = std::fs::read_to_string(Path::new(&page).join("index.html")).expect("a page");
    assert!(html.contains("unchanged, not measured again") && html.matches("src=\"pictures/").count() > 10);
}

#[test]
fn views_are_compared_with_golden_pictures_that_an_option_writes() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("assets")).expect("a writable folder");
    std::fs::copy(vase(), folder.path("assets/good.glb")).expect("a copy");
    let configure = |golden: &str, surface: &str| {
        let options =
            format!("[options]\nsize = \"160x120\"\nlighting = \"camera\"\nfactor = 3\nsurface = \"{surface}\"\n");
        let text = format!("{golden}\n{options}[cameras.front]\ncamera = [0, 10]\n[cameras.side]\ncamera = [90, 0]\n");
        std::fs::write(folder.path("pnaen.toml"), text).expect("a writable folder");
    };
    let run = |arguments: &[&str]| {
        let (code, out, errors) = check(&folder, arguments);
        (code, out + &errors)
    };
    configure("golden = \"kept\"", "pn-aen");
    let (code, said) = run(&[]);
    assert_eq!(code, Some(1), "{said}");
    assert_says(&said, &["golden (front): there is no golden picture", "front.png; write it with --update-golden"]);
    assert_eq!(run(&["--update-golden"]).0, Some(0));
    assert!(
        ["front", "side"]
            .iter()
            .all(|view| Path::new(&folder.path(&format!("kept/assets/good.glb/{view}.png"))).is_file())
    );
    let cache = ["--cache", &folder.path("cache")];
    assert_eq!(run(&cache).0, Some(0));
    assert_says(&run(&cache).1, &["1 unchanged"]);
    std::fs::remove_file(folder.path("kept/assets/good.glb/side.png")).expect("a picture");
    assert_says(&run(&cache).1, &["golden (side): there is no golden picture", "1 failed"]);
    configure("", "flat");
    let kept = folder.path("kept");
    let (code, said) = run(&["--golden", &kept, "--page", &folder.path("page"), "--format", "sarif"]);
    assert_eq!(code, Some(1), "{said}");
    assert_says(&said, &["\"ruleId\": \"golden\"", "it differs from ", "px differ, by up to", "none may since"]);
    let page = std::fs::read_to_string(folder.path("page/index.html")).expect("a page");
    assert_eq!(page.matches("<figcaption>golden (front)").count(), 1);
    let (code, _, errors) = check(&folder, &["--update-golden"]);
    assert!(code == Some(2) && errors.contains("give --golden"), "{errors}");
    std::fs::write(folder.path("pnaen.toml"), "[cameras.\"a/b\"]\ncamera = [0, 0]\n").expect("a writable folder");
    assert_says(&run(&["--golden", &kept]).1, &["a/b can't be the name of a file"]);
}

#[test]
fn a_wrong_configuration_is_one_sentence_with_its_line() {
    let folder = Folder::new();
    let config = folder.path("wrong.toml");
    for (text, words) in [
        ("[options]\ntolerence = 1", &["wrong.toml, line 2: ", "tolerence", "did you mean tolerance?"][..]),
        ("[options]\n\nlod = \"errors\"", &["wrong.toml, line 3: ", "errors", "distance"]),
        ("[options]\ntolerance = \"much\"", &["wrong.toml, line 2: ", "from 0.01 to 100"]),
        ("[options]\nstats = \"-\"", &["wrong.toml, line 2: ", "stats"]),
        ("[[files]]\npath = \"*.none\"\n[files.options]\nlod = \"errors\"", &["wrong.toml, line 4: ", "errors"]),
        ("[options]\nalpha = 0.5", &["wrong.toml: ", "--surface phong"]),
        ("[options]\nfactors = \"-\"", &["wrong.toml: ", "standard input"]),
        ("[cameras.a]\nfile-camera = 1\nroll = 3", &["wrong.toml: ", "file-camera", "roll"]),
        ("fail-on = [\"crack\"]", &["wrong.toml, line 1: ", "crack", "t-junctions"]),
        ("include = \"a.toml\"", &["wrong.toml, line 1: ", "no key include"]),
        ("[options]\nfail-on = [\"cracks\"]", &["wrong.toml, line 2: ", "write it above the line in brackets"]),
        ("[cameras.\"\"]\ncamera = [0, 0]", &["wrong.toml, line 1: ", "a camera needs a name"]),
        ("[cameras]\nfront = [0, 10]", &["wrong.toml, line 2: ", "[cameras.front] with camera = [0, 10]"]),
        ("[options]\nfactor = true", &["wrong.toml, line 2: ", "factor is no switch", "--factor"]),
        ("[options]\nfactor = false", &["wrong.toml, line 2: ", "factor is no switch"]),
        ("[options]\nlegend = \"on\"", &["wrong.toml, line 2: ", "legend is a switch: expected true or false"]),
        ("[options]\nsize = [640]", &["wrong.toml, line 2: ", "WIDTHxHEIGHT"]),
        ("[cameras.a]\ncamera = [nan, 0]", &["wrong.toml, line 2: ", "AZIMUTH,ELEVATION"]),
        (
            "[options]\n\nreference-surface = \"gone.glb\"",
            &["wrong.toml, line 3: ", "reference-surface: there is no file", "gone.glb"],
        ),
        (
            "[[files]]\npath = \"*.none\"\n[files.options]\nfactors = \"gone.csv\"",
            &["wrong.toml, line 4: ", "gone.csv"],
        ),
        ("a = ", &["wrong.toml, line 1: ", "no TOML"]),
    ] {
        std::fs::write(&config, text).expect("a writable folder");
        sentence(&["check", "shape:torus", "--config", &config], words);
    }
    std::fs::write(&config, vec![b'#'; 2 << 20]).expect("a writable folder");
    sentence(&["check", "shape:torus", "--config", &config], &["wrong.toml", "2097152 bytes"]);
    std::fs::write(&config, [0xff, 0xfe]).expect("a writable folder");
    sentence(&["check", "shape:torus", "--config", &config], &["wrong.toml", "isn't text in UTF-8"]);
    sentence(&["check", "shape:torus", "--config", &folder.path("none.toml")], &["none.toml", "no such file"]);
    sentence(&["check", "shape:torus", "--config", &folder.path("")], &["it is no file"]);
}

#[test]
fn patterns_are_seen_from_the_folder_of_the_configuration() {
    let folder = Folder::new();
    std::fs::create_dir_all(folder.path("assets/props/old")).expect("a writable folder");
    for name in ["assets/a.glb", "assets/props/b.glb", "assets/props/old/c.glb"] {
        std::fs::copy(vase(), folder.path(name)).expect("a copy");
    }
    // Which assets a pattern stands for: they alone fail its gate.
    let failing = |pattern: &str| {
        let config = format!(
            "[[files]]\npath = \"{pattern}\"\nfail-on = [\"triangles:1\"]\n\
             [options]\nsize = \"64x48\"\nlighting = \"camera\"\nfactor = 1\n"
        );
        std::fs::write(folder.path("pnaen.toml"), config).expect("a writable folder");
        let (_, json, errors) = check(&folder, &["--format", "json"]);
        let report: Value = serde_json::from_str(&json).expect("JSON");
        let names = failed(&report).into_iter().filter(|(_, gates)| !gates.is_empty()).map(|(name, _)| name);
        (names.collect::<Vec<_>>().join(" "), errors)
    };
    for (pattern, expected) in [
        ("*.glb", "a.glb b.glb c.glb"),
        ("assets/*.glb", "a.glb"),
        ("assets/props/*.glb", "b.glb"),
        ("assets/props/**/*.glb", "b.glb c.glb"),
        ("props/", "b.glb c.glb"),
        ("assets/props", "b.glb c.glb"),
        ("/a.glb", ""),
        ("props/*.glb", ""),
    ] {
        let (found, errors) = failing(pattern);
        assert_eq!(found, expected, "{pattern}");
        let unmatched = format!("pnaen.toml, line 2: no asset matches the path {pattern}");
        assert_eq!(errors.contains(&unmatched), expected.is_empty(), "{pattern}: {errors}");
    }
}

#[test]
fn a_section_may_hide_parts_that_only_some_of_its_assets_have() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("assets")).expect("a writable folder");
    let part = |name: &str| format!("o {name}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n");
    for (name, parts) in [("both.obj", part("body") + &part("collision")), ("one.obj", part("body"))] {
        std::fs::write(folder.path(&format!("assets/{name}")), parts).expect("a writable folder");
    }
    let config = "[options]\nfactor = 1\npartitioning = \"integer\"\nhide-part = [\"collision\", \"lod1\"]\n";
    std::fs::write(folder.path("pnaen.toml"), config).expect("a writable folder");
    let (code, json, errors) = check(&folder, &["--format", "json"]);
    assert_eq!(code, Some(0), "{errors}");
    assert!(
        errors.contains("pnaen.toml, line 4: no asset has the part lod1") && !errors.contains("collision"),
        "{errors}"
    );
    let report: Value = serde_json::from_str(&json).expect("JSON");
    for index in 0..2 {
        assert_eq!(report.pointer(&format!("/assets/{index}/views/0/numbers/triangles_in")), Some(&1.into()), "{json}");
    }
}

#[test]
fn a_section_may_give_styles_to_parts_and_weights_to_targets_that_only_some_of_its_assets_have() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("assets")).expect("a writable folder");
    let part = |name: &str| format!("o {name}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n");
    for (name, parts) in [("both.obj", part("body") + &part("screen")), ("one.obj", part("body"))] {
        std::fs::write(folder.path(&format!("assets/{name}")), parts).expect("a writable folder");
    }
    let config = "[options]\nfactor = 1\npartitioning = \"integer\"\npart = [\"screen:detail=2\", \"lamp:detail=2\"]\n\
                  morph = \"body=0.5\"\n";
    std::fs::write(folder.path("pnaen.toml"), config).expect("a writable folder");
    let (code, json, errors) = check(&folder, &["--format", "json"]);
    assert_eq!(code, Some(0), "{errors}");
    for said in
        ["pnaen.toml, line 4: no asset has the part lamp", "pnaen.toml, line 5: no asset has the morph target body"]
    {
        assert!(errors.contains(said), "{errors}");
    }
    assert!(!errors.contains("screen"), "{errors}");
    let report: Value = serde_json::from_str(&json).expect("JSON");
    for index in 0..2 {
        assert!(report.pointer(&format!("/assets/{index}/views/0/numbers/triangles_in")).is_some(), "{json}");
    }
}

#[test]
fn odd_arguments_are_said() {
    let folder = Folder::new();
    let path = |name: &str| folder.path(name);
    std::fs::create_dir(path("empty")).expect("a writable folder");
    std::fs::write(path("file"), "").expect("a writable folder");
    sentence(&["check", &path("empty")], &["nothing to check"]);
    sentence(&["check", "shape:torus", "--page", &path("file/page")], &["file/page", "could not be made"]);
    sentence(&["check", "shape:torus", "--cache", &path("file")], &["file", "there is a file of this name"]);
    sentence(&["check", "shape:torus", "-o", &path("empty")], &["empty", "it is a folder"]);
    failure(&["check", "shape:torus", "-o", ""], 2);
    sentence(&["check", "shape:torus", "-o", &path("none/report.json")], &["there is no folder"]);
    failure(&["check"], 2);
    failure(&["check", "shape:torus", "--jobs", "0"], 2);
    failure(&["check", "shape:torus", "--format", "xml"], 2);
    std::fs::copy(vase(), path("a.glb")).expect("a copy");
    let before = std::fs::read(path("a.glb")).expect("a file");
    sentence(&["check", &path("a.glb"), "-o", &path("a.glb")], &["a.glb is read by the same command"]);
    assert_eq!(std::fs::read(path("a.glb")).expect("a file"), before);
    // The configuration of the working folder is read, too.
    std::fs::write(path("pnaen.toml"), "[options]\nsize = [64, 48]\n").expect("a writable folder");
    let over = command(&["check", "a.glb", "-o", "pnaen.toml"]).current_dir(path("")).output().expect("it starts");
    let said = String::from_utf8_lossy(&over.stderr).into_owned();
    assert!(over.status.code() == Some(1) && said.contains("pnaen.toml is read by the same command"), "{said}");
    let kept = std::fs::read_to_string(path("pnaen.toml")).expect("a text");
    assert_eq!(kept, "[options]\nsize = [64, 48]\n");
    let text = output(&["check", &path("a.glb"), &path("a.glb"), &path("."), "--fail-on", "cracks, leaks"]);
    assert!(
        text.ends_with("1 asset: 1 passed, 0 failed, 0 broken\n"),
        "a file that is named three times is checked once: {text}"
    );
    let missing = failure(&["check", &path("missing.glb"), "shape:torus"], 1);
    assert!(missing.contains("2 assets: 1 passed, 0 failed, 1 broken"), "{missing}");
}

#[test]
fn assets_of_one_name_in_folders_of_any_name_are_told_apart() {
    let folder = Folder::new();
    let names = ["a/x.glb", "b/x.glb", "with blanks/\u{e4} \u{65e5}.glb"];
    for name in names {
        std::fs::create_dir_all(Path::new(&folder.path(name)).parent().expect("a folder")).expect("a writable folder");
        std::fs::copy(vase(), folder.path(name)).expect("a copy");
    }
    let (cache, page) = (folder.path("cache"), folder.path("page \u{e4}"));
    let ran = || {
        let text = output(&["check", &folder.path(""), "--cache", &cache, "--page", &page, "--fail-on", "cracks"]);
        names.map(|name| text.lines().filter(|line| line.contains(name)).count())
    };
    assert_eq!(ran(), [1; 3]);
    assert_eq!(std::fs::read_dir(&cache).expect("a folder").count(), 3, "each has a record of its own");
    assert_eq!(ran(), [1; 3]);
    let html = std::fs::read_to_string(Path::new(&page).join("index.html")).expect("a page");
    assert!(names.iter().all(|name| html.contains(name)));
}

#[cfg(unix)]
#[test]
fn an_interrupt_keeps_what_was_checked() {
    use std::process::Stdio;
    use std::time::{Duration, Instant};

    let folder = Folder::new();
    std::fs::create_dir(folder.path("assets")).expect("a writable folder");
    for index in 0..400 {
        std::fs::copy(vase(), folder.path(&format!("assets/{index:03}.glb"))).expect("a copy");
    }
    let [assets, cache, report] = ["assets", "cache", "report.json"].map(|name| folder.path(name));
    let options = ["--cache", &cache, "--format", "json", "-o", &report, "--fail-on", "cracks", "--jobs", "1"];
    let mut child = crate::command(&[&["check", &assets], &options[..]].concat())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let start = Instant::now();
    while std::fs::read_dir(&cache).map_or(0, Iterator::count) < 3 {
        assert!(start.elapsed() < Duration::from_secs(120), "nothing was checked");
        std::thread::sleep(Duration::from_millis(5));
    }
    let sent = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs");
    assert!(sent.success());
    assert_eq!(child.wait().expect("it ends").code(), Some(130));
    let report: Value = serde_json::from_slice(&std::fs::read(&report).expect("a report")).expect("JSON");
    let (done, left) = (report["passed"].as_u64().expect("a number"), report["left_out"].as_u64().expect("a number"));
    assert!(done >= 2 && left > 0 && done + left == 400, "{report}");
    let said = std::io::read_to_string(child.stderr.take().expect("piped")).expect("UTF-8");
    assert!(said.contains(&format!("interrupted after {done} of 400 assets")), "{said}");
}
