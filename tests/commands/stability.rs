//! `pnaen stability`: cases, files, the table and the page.

use std::collections::HashSet;
use std::path::Path;

use serde_json::Value;

use crate::{Folder, assert_says, failure, number, output, sentence, write_corners, write_seam};

/// The rows of `pnaen stability --json` on the CPU.
fn stability(arguments: &[&str]) -> Vec<Value> {
    let text = output(&[&["stability", "--device", "cpu", "--json"], arguments].concat());
    serde_json::from_str(&text).expect("a JSON array")
}

/// Text in a row of `pnaen stability --json`.
fn word<'a>(row: &'a Value, key: &str) -> &'a str {
    row[key].as_str().unwrap_or_else(|| panic!("no {key}: {row}"))
}

/// The cases that rows belong to, in their order.
fn cases(rows: &[Value]) -> Vec<&str> {
    let mut cases: Vec<_> = rows.iter().map(|row| word(row, "case")).collect();
    cases.dedup();
    cases
}

const METHODS: [&str; 9] =
    ["flat", "PN", "PN-AEN as published", "PN-AEN", "PN crease", "Phong", "Phong AEN", "Nagata", "Nagata AEN"];

/// Whether a method tears where normals are split.
fn tears(method: &str) -> bool {
    ["PN", "PN-AEN as published", "Phong", "Nagata"].contains(&method)
}

#[test]
fn stability_measures_every_method_in_every_partitioning() {
    let rows = stability(&["--case", "split-normals", "--cameras", "1"]);
    let keys = ["case", "method", "device", "partitioning", "measured", "unit", "promised", "holds"];
    let units =
        ["edge points that differ", "edges whose factors differ", "edge normals that differ", "vertices not finite"];
    let mut expected = HashSet::new();
    for method in METHODS {
        for partitioning in ["integer", "pow2", "fractional-odd", "fractional-even", "subtriangulation", "rows"] {
            expected.extend(units.map(|unit| (method, partitioning, unit)));
        }
    }
    let found: HashSet<_> =
        rows.iter().map(|row| ["method", "partitioning", "unit"].map(|key| word(row, key))).collect();
    let expected: HashSet<_> =
        expected.iter().map(|&(method, partitioning, unit)| [method, partitioning, unit]).collect();
    // Not assert_eq, which would print two hundred rows.
    assert!(found == expected, "{:?}", found.symmetric_difference(&expected).next());
    assert_eq!(rows.len(), expected.len(), "each row occurs once");
    for row in &rows {
        let own: HashSet<_> = row.as_object().expect("an object").keys().map(String::as_str).collect();
        assert_eq!(own, HashSet::from(keys));
        assert_eq!((word(row, "case"), word(row, "device")), ("split-normals", "cpu"));
        let (measured, holds) = (number(row, "/measured"), row["holds"].as_bool().expect("a boolean"));
        assert_eq!(holds, measured == 0.0, "{row}");
        let promised = row["promised"].as_bool().expect("a boolean");
        assert!(holds || !promised, "{row}");
        match (word(row, "method"), word(row, "unit")) {
            (method, _) if !tears(method) => assert!(promised, "{row}"),
            (_, "edge points that differ") => assert!(!holds, "{row}"),
            _ => {}
        }
    }
    // Uniform factors agree on both sides, so factors can differ only under views with adaptive LOD.
    let factors = |rows: &[Value]| rows.iter().any(|row| word(row, "unit") == units[1] && row["holds"] == false);
    assert!(factors(&rows) && !factors(&stability(&["--case", "split-normals", "--cameras", "0"])));
}

#[test]
fn cases_run_in_a_fixed_order() {
    let run = |names: &[&str]| {
        let options = names.iter().flat_map(|name| ["--case", name]);
        stability(&["--cameras", "0"].into_iter().chain(options).collect::<Vec<_>>())
    };
    let rows = run(&["split-normals", "t-junction"]);
    assert_eq!(cases(&rows), ["split-normals", "t-junction"]);
    assert!(rows == run(&["t-junction", "split-normals", "t-junction"]), "the same rows in the same order");
}

#[test]
fn an_unknown_case_is_answered_with_those_there_are() {
    let said = failure(&["stability", "--case", "teapot", "--device", "cpu", "--json"], 2);
    assert_says(&said, &["teapot", "split-normals", "smooth-torus", "near-seam", "shared-apex"]);
}

#[test]
fn stability_prints_a_table_with_verdicts() {
    let text =
        output(&["stability", "--case", "smooth-torus", "--case", "t-junction", "--device", "cpu", "--cameras", "0"]);
    let table: Vec<Vec<&str>> =
        text.lines().map(|line| line.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect()).collect();
    assert_eq!(table[0][..3], ["case", "method", "points"], "{text}");
    assert_eq!(text.matches("verdict").count(), 1, "{text}");
    assert_eq!((table[1][0], table[10][..2].to_vec()), ("smooth-torus", vec!["t-junction", "search"]), "{text}");
    for (method, line) in METHODS.iter().zip(&table[1..10]) {
        let cells = &line[line.len() - 7..];
        assert_eq!(cells[0], *method, "{text}");
        if *method == "PN-AEN as published" {
            assert!(cells[1].parse::<u32>().is_ok_and(|points| points > 0), "{text}");
            assert_eq!(cells[6], "fails", "{text}");
        } else {
            assert_eq!(cells[1..], ["0", "0", "0", "0", "-", "holds"], "{text}");
        }
    }
    assert_eq!(table[10].last(), Some(&"holds; 0 T-junctions missed"), "{text}");
    let legend = text.lines().last().expect("lines");
    assert!(legend.starts_with("Points: ") && legend.contains("factors: "), "{text}");
}

#[test]
fn stability_draws_its_cases_and_writes_a_page() {
    let folder = Folder::new();
    let pages = folder.path("made/on/the/way");
    output(&["stability", "--case", "split-normals", "--cameras", "0", "-o", &pages]);
    let mut files: Vec<_> =
        std::fs::read_dir(&pages).expect("a folder").map(|file| file.expect("a file").file_name()).collect();
    files.sort();
    assert_eq!(files, ["split-normals.png", "stability.md"]);

    let picture = image::open(Path::new(&pages).join("split-normals.png")).expect("a PNG file").to_rgb8();
    // Nine methods in rows of three, with their cracks in red.
    let (width, height) = (picture.width() / 3, picture.height() / 3);
    let part = |k: u32| image::imageops::crop_imm(&picture, k % 3 * width, k / 3 * height, width, height).to_image();
    let parts: Vec<_> = (0..9).map(part).collect();
    let colors: Vec<_> = parts.iter().map(|part| part.pixels().collect::<HashSet<_>>().len()).collect();
    assert!(colors.iter().all(|&count| count > 20), "{colors:?} colours");
    for (method, part) in METHODS.into_iter().zip(parts) {
        let red = part.pixels().filter(|p| p.0[0] > 200 && p.0[1] < 100 && p.0[2] < 80).count();
        assert!(if tears(method) { red > 100 } else { red == 0 }, "{method}: {red} red px");
    }

    let page = std::fs::read_to_string(Path::new(&pages).join("stability.md")).expect("a page");
    assert!(page.contains("\n## split-normals\n") && page.contains("](split-normals.png)"), "{page}");
    // The first two lines are the headings and the rule below them.
    let lines = page.lines().filter(|line| line.starts_with("| ")).skip(2);
    let lines: Vec<_> =
        lines.map(|line| line.trim_matches('|').split('|').map(str::trim).collect::<Vec<_>>()).collect();
    let verdicts: Vec<_> = lines.iter().map(|cells| (cells[0], cells[cells.len() - 1])).collect();
    let expected = METHODS.map(|method| (method, if tears(method) { "fails" } else { "holds" }));
    assert_eq!(verdicts, expected, "{page}");

    let file = Path::new(&pages).join("stability.md/below");
    let below = file.to_str().expect("a path in UTF-8");
    let arguments = ["stability", "--case", "split-normals", "--device", "cpu", "-o", below];
    sentence(&arguments, &[below, "could not be made"]);
}

#[test]
fn stability_runs_files() {
    let folder = Folder::new();
    // Two sides of a roof, each with its own normal.
    let [left, right] = [[-0.48, 0.6, 0.64], [0.48, 0.6, 0.64]];
    let [front, back] = [[0.0, -1.0, 1.0], [0.0, 1.0, 1.0]];
    let roof = [
        ([-1.0, 0.0, 0.0], left),
        (front, left),
        (back, left),
        ([1.0, 0.0, 0.0], right),
        (back, right),
        (front, right),
    ];
    let path = write_corners(&folder, &roof);
    let rows = stability(&[&path, "--cameras", "0"]);
    assert_eq!(cases(&rows), ["triangles.gltf"]);
    for method in METHODS {
        let torn = rows.iter().filter(|row| word(row, "method") == method && row["holds"] == false).count();
        // Equal normals at both ends make an edge of Phong and Nagata straight, so it doesn't tear.
        assert_eq!(torn > 0, tears(method) && method.starts_with("PN"), "{method}");
    }
    assert_eq!(cases(&stability(&[&path, "--case", "t-junction", "--cameras", "0"])), ["t-junction", "triangles.gltf"]);
    sentence(&["stability", "nowhere.glb", "--device", "cpu"], &["nowhere.glb", "can't be read"]);

    // Files have a picture and a section like a case. The second file of the same name gets names of its own.
    let pages = folder.path("pages");
    output(&["stability", &path, &path, "--cameras", "0", "--device", "gpu", "-o", &pages]);
    let page = std::fs::read_to_string(Path::new(&pages).join("stability.md")).expect("a page");
    for (name, picture) in [("triangles.gltf", "triangles.png"), ("triangles (2).gltf", "triangles--2-.png")] {
        let section = format!("\n## {name}\n\n![{name}]({picture})\n\n| method |");
        assert!(page.contains(&section) && Path::new(&pages).join(picture).exists(), "{page}");
    }
    assert!(!page.contains("cpu"), "{page}");

    // A file that can't be loaded fails before anything runs.
    let unmade = folder.path("unmade");
    sentence(&["stability", "--case", "soup", "nowhere.glb", "-o", &unmade], &["nowhere.glb"]);
    assert!(!Path::new(&unmade).exists());
}

#[test]
fn leaks_are_counted_for_a_file_that_a_weld_tolerance_closes() {
    let folder = Folder::new();
    let path = write_seam(&folder);
    let leaks = |options: &[&str]| {
        let text = output(&[&["stability", &path, "--json", "--cameras", "0", "--device", "gpu"], options].concat());
        let rows: Vec<Value> = serde_json::from_str(&text).expect("a JSON array");
        assert!(rows.iter().all(|row| word(row, "device") != "cpu"), "{text}");
        rows.iter()
            .filter(|row| word(row, "unit") == "px leaking")
            .map(|row| number(row, "/measured"))
            .collect::<Vec<_>>()
    };
    assert_eq!(leaks(&[]), [0.0; 0], "an open mesh has none");
    assert_eq!(leaks(&["--weld", "1e-3"]), [0.0; 54], "nine methods in six partitionings");
}

#[test]
fn with_a_crease_band_pn_does_not_tear_a_file() {
    let differing = |options: &[&str]| {
        let arguments = ["stability", "shape:cube-split", "--json", "--cameras", "0", "--device", "cpu"];
        let text = output(&[&arguments, options].concat());
        let rows: Vec<Value> = serde_json::from_str(&text).expect("a JSON array");
        let points = |row: &&Value| word(row, "method") == "PN" && word(row, "unit") == "edge points that differ";
        let all = rows.iter().filter(points).map(|row| number(row, "/measured"));
        all.collect::<Vec<_>>()
    };
    assert!(differing(&[]).iter().all(|points| *points > 0.0));
    assert_eq!(differing(&["--crease-band", "0.02"]), [0.0; 6], "in six partitionings");
}
