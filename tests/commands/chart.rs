use std::process::Stdio;
use std::time::{Duration, Instant};

use super::{Folder, command, failure, output, run, sentence};

/// The largest error of a row with this surface and setting.
fn error(csv: &str, surface: &str, setting: &str) -> f64 {
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let records: Vec<_> = reader.records().map(|record| record.expect("a whole row")).collect();
    let row = records.iter().find(|row| &row[2] == surface && &row[6] == setting);
    row.expect("this setting was tried")[13].parse().expect("a number")
}

const QUICK: [&str; 6] = ["--samples", "2000", "--size", "64x48", "--lods", "uniform"];

#[test]
fn a_chart_measures_errors_against_the_exact_surface() {
    let folder = Folder::new();
    let (svg, csv) = (folder.path("out.svg"), folder.path("out.csv"));
    let options = ["chart", "shape:icosahedron", "--surfaces", "flat,pn-aen", "--factors", "1,4", "-o", &svg];
    let said = output(&[&options[..], &QUICK, &["--csv", &csv]].concat());
    assert!(said.contains("Icosahedron") && said.contains("% of the diagonal pn-aen by uniform LOD"), "{said}");
    let table = std::fs::read_to_string(&csv).expect("a table");
    assert_eq!(table.lines().count(), 5, "a header and four settings");
    // A face of the icosahedron is 0.7947 from its middle, and its corners 1; the sphere's diagonal is 2 sqrt(3).
    let face = 1.0 - ((5.0 + 2.0 * 5.0_f64.sqrt()) / 15.0).sqrt();
    let flat = error(&table, "flat", "factor 1");
    assert!((flat - face / 12.0_f64.sqrt()).abs() < 1e-6, "{flat}");
    assert!(error(&table, "pn-aen", "factor 4") < 0.5 * error(&table, "flat", "factor 4"));
    let picture = std::fs::read_to_string(&svg).expect("a picture");
    assert!(picture.contains("<svg") && picture.contains("Icosahedron") && picture.contains("pn-aen"));
}

#[test]
fn errors_are_measured_against_a_given_mesh_or_the_limit_surface() {
    let folder = Folder::new();
    let png = folder.path("out.png");
    let options = ["chart", "shape:cube-smooth", "--surfaces", "pn-aen", "--factors", "1,4", "--csv", "-", "-o", &png];
    let own = output(&[&options[..], &QUICK].concat());
    let line = own.lines().last().expect("a row");
    let fields: Vec<_> = line.rsplit(',').collect();
    let [most, by_error, normals, px, rms, largest] = fields[..6] else { panic!("{line}") };
    assert_eq!([most, normals, rms, largest], [""; 4], "without a reference surface, those errors are empty: {line}");
    assert!(px.parse::<f64>().is_ok_and(|px| px > 0.0) && by_error.parse::<u64>().is_ok_and(|by| by > 12), "{line}");
    let picture = image::open(&png).expect("a picture").to_rgb8();
    assert_eq!(picture.width(), 960);
    let held = output(&[&options[..], &QUICK, &["--reference-surface", "shape:cube-smooth"]].concat());
    assert!(error(&held, "pn-aen", "factor 1") < 1e-6, "factor 1 gives the mesh itself");
    assert!(error(&held, "pn-aen", "factor 4") > 0.01, "a cube is not round");
}

#[test]
fn a_report_has_a_page_a_table_and_a_picture_for_every_mesh() {
    let folder = Folder::new();
    let into = folder.path("made/here");
    let options =
        ["chart", "shape:icosahedron", "shape:cube-smooth", "--surfaces", "flat,pn-aen", "--factors", "1,2,8"];
    let said = run(&[&options[..], &QUICK, &["--report", &into]].concat());
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    let read = |name: &str| std::fs::read_to_string(format!("{into}/{name}")).expect("it was written");
    let (page, table) = (read("results.md"), read("results.csv"));
    let adapter =
        csv::Reader::from_reader(table.as_bytes()).records().next().expect("a row").expect("whole")[1].to_owned();
    assert!(page.contains(&format!("Measured on {adapter} (")), "{page}");
    assert!(page.contains("\n    pnaen chart shape:icosahedron shape:cube-smooth --surfaces flat,pn-aen"), "{page}");
    for name in ["icosahedron.svg", "cube-smooth.svg"] {
        assert!(page.contains(&format!("]({name})")) && read(name).contains("</svg>"), "{name}");
    }
    // A face of the icosahedron lies 5.93 % of the sphere's diagonal below it; PN-AEN comes nearer. A cube has no exact surface.
    assert!(page.contains("`flat` comes no closer than 5.93 % (Icosahedron)"), "{page}");
    assert!(page.contains("- Cube, smooth normals: no reference surface is known"), "{page}");
    assert!(page.contains("\n| Icosahedron | 5.93 | "), "{page}");
    let rows = |start: &str| table.lines().filter(|line| line.starts_with(start)).count();
    assert_eq!(rows("shape:icosahedron,"), 5, "flat at factor 8 is flat at factor 2: {table}");
    assert!(page.contains("Left out are settings: 1 whose method came as close"), "{page}");
}

#[test]
fn wrong_usage_of_a_chart_names_the_option() {
    let usage = |arguments: &[&str], word: &str| {
        let said = failure(&[&["chart"], arguments].concat(), 2);
        assert!(said.contains(word), "{said}");
    };
    usage(&["shape:torus", "shape:cone", "--reference-surface", "shape:torus", "--csv", "-"], "one mesh");
    usage(&["shape:torus", "--partitionings", "subtriangulation", "--lods", "error", "--csv", "-"], "subtriangulation");
    usage(&["shape:torus", "-o", "out.jpg"], ".svg or .png");
    usage(&["shape:torus"], "--output");
    usage(&["--csv", "-"], "FILES");
    usage(&["--report", "out", "--reference-surface", "shape:torus"], "one mesh");
    usage(&["shape:torus", "--csv", "-", "--factors", "0.5"], "1 to 64");
    usage(&["shape:torus", "--csv", "-", "--samples", "1"], "100 to");
    sentence(
        &["chart", "shape:torus", "--csv", "/nowhere/at/all.csv"],
        &["/nowhere/at/all.csv", "there is no folder /nowhere/at to write it in"],
    );
    sentence(&["chart", "shape:torus", "--reference-surface", "README.md", "--csv", "-"], &["README.md"]);
}

#[test]
fn settings_with_too_many_triangles_are_left_out_and_counted() {
    let options = ["chart", "shape:icosahedron", "--surfaces", "flat", "--factors", "1,64", "--max-triangles", "1000"];
    let run = run(&[&options[..], &QUICK, &["--csv", "-"]].concat());
    assert!(run.status.success());
    assert_eq!(String::from_utf8_lossy(&run.stdout).lines().count(), 2);
    let said = String::from_utf8_lossy(&run.stderr);
    assert!(said.contains("Icosahedron: 1 of 2 settings have more than 1000 triangles"), "{said}");
}

#[cfg(unix)]
#[test]
fn an_interrupt_keeps_what_is_done() {
    let folder = Folder::new();
    let (svg, csv) = (folder.path("out.svg"), folder.path("out.csv"));
    // Thousands of settings take longer than the test waits.
    let factors: Vec<String> = (0..4000).map(|k| format!("{}", 1.0 + f64::from(k) / 64.0 / 4.0)).collect();
    let factors = factors.join(",");
    let options =
        ["chart", "shape:icosahedron", "--surfaces", "flat", "--all", "--factors", &factors, "-o", &svg, "--csv", &csv];
    let mut child = command(&[&options[..], &QUICK].concat())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let start = Instant::now();
    while std::fs::read_to_string(&csv).map_or(0, |table| table.lines().count()) < 3 {
        assert!(start.elapsed() < Duration::from_secs(120), "nothing was measured");
        std::thread::sleep(Duration::from_millis(20));
    }
    let sent = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs");
    assert!(sent.success());
    assert_eq!(child.wait().expect("it ends").code(), Some(130));
    let table = std::fs::read_to_string(&csv).expect("a table");
    assert!(table.ends_with('\n'));
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let rows = reader.records().map(|record| record.expect("a whole row").len()).collect::<Vec<_>>();
    assert!((2..4000).contains(&rows.len()) && rows.iter().all(|fields| *fields == 19), "{}", rows.len());
    assert!(std::fs::read_to_string(&svg).expect("a picture of what was done").contains("</svg>"));
    let said = std::io::read_to_string(child.stderr.take().expect("piped")).expect("UTF-8");
    assert!(said.contains(&format!("interrupted after {} of 4000 settings", rows.len())), "{said}");
}
