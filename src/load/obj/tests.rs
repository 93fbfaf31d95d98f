//! OBJ files as programs and people write them.

use glam::{Vec2, Vec3};

use super::*;
use crate::face_builder::tests::{POINTS, SIDES, assert_cube};
use crate::import::{Import, Subdivide};
use crate::selection::{Selection, ShownParts};
use geometry::mesh::subdivision::FaceVarying;
use geometry::progress::Progress;

fn read(text: &str) -> LoadedMesh {
    super::read(text.as_bytes().to_vec(), &ModelFile::from_test("cube", &Progress::new())).unwrap()
}

/// A cube of quads without normals.
pub(crate) fn cube() -> String {
    let vertices: String = POINTS.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
    let face = |side: &[usize; 4]| format!("f {} {} {} {}\n", side[0] + 1, side[1] + 1, side[2] + 1, side[3] + 1);
    format!("# made by a test\no cube\n{vertices}g sides\ns off\n{}", SIDES.iter().map(face).collect::<String>())
}

/// A strip of squares, of which each follows its vertices, in several pieces of the file. `number` writes the number of a vertex:
/// its own from 0 on, and how many are above.
fn strip(squares: usize, number: impl Fn(usize, usize) -> String) -> String {
    let mut text = "v 0 0 0\nv 0 1 0\n".to_owned();
    for i in 1..=squares {
        let above = 2 * i + 2;
        let [a, b, c, d] = [2 * i - 2, 2 * i, 2 * i + 1, 2 * i - 1].map(|vertex| number(vertex, above));
        let face =
            if i % 2 == 0 { format!("f {a} {b} \\\n  {c} {d}\n") } else { format!("f {a} {b} {c}\nf {a} {c} {d}\n") };
        text += &format!("v {i} 0 0\nv {i} 1 {:.3} # {i}\n{face}", (i % 7) as f32 / 9.0);
    }
    text
}

#[test]
fn a_file_of_many_pieces_is_read_as_one() {
    const SQUARES: usize = 6_000;
    let forward = strip(SQUARES, |vertex, _| format!("{}", vertex + 1));
    let backward = strip(SQUARES, |vertex, above| format!("-{}", above - vertex));
    let pieces = |text: &str| pieces::Piece::all(text.as_bytes()).len();
    assert!(pieces(&forward) > 4 && pieces(&backward) > 4);
    let (forward, backward) = (read(&forward), read(&backward));
    assert_eq!(forward.triangles.len(), 2 * SQUARES);
    assert_eq!(forward.corners.len(), 2 * SQUARES + 2);
    let is_same = |other: &LoadedMesh| other.corners == forward.corners && other.triangles == forward.triangles;
    assert!(is_same(&backward) && forward.warnings == backward.warnings);
    // Faces before their vertices refer to the same ones.
    let (faces, vertices): (Vec<_>, Vec<_>) = strip(SQUARES, |vertex, _| format!("{}", vertex + 1))
        .split_inclusive('\n')
        .map(str::to_owned)
        .partition(|line| !line.starts_with('v'));
    assert!(is_same(&read(&(faces.concat() + &vertices.concat()))));
}

#[test]
fn a_fault_in_a_late_piece_has_its_line() {
    let text = strip(6_000, |vertex, _| format!("{}", vertex + 1));
    let lines = text.lines().count();
    let fault = |end: &str| {
        let bytes = (text.clone() + end).into_bytes();
        let read = super::read(bytes, &ModelFile::from_test("", &Progress::new()));
        read.map(|loaded| loaded.warnings).map_err(|fault| fault.to_string())
    };
    assert!(fault("f 1 2 x\nf y\n").expect_err("no index").starts_with(&format!("line {}: \"x\"", lines + 1)));
    let long = "#".repeat(5 << 20);
    assert!(fault(&long).expect_err("too long").starts_with(&format!("line {}: the line has", lines + 1)));
    let warnings = fault("f 1 2 99999\n").expect("all but one face");
    let first = format!("the first at line {}", lines + 1);
    assert!(warnings.iter().any(|warning| warning.contains(&first)), "{warnings:?}");
}

const WITHOUT_NORMALS: &str = "faces without normals, or with some missing, which are smoothed below 60 degrees";

#[test]
fn a_cube_of_quadrilaterals_is_a_cube() {
    let mesh = read(&cube());
    assert_cube(&mesh);
    assert_eq!((mesh.name.as_str(), mesh.materials[0].name.as_str()), ("cube", "default"));
    assert_eq!(mesh.warnings, [format!("{WITHOUT_NORMALS}: 6.")]);
}

#[test]
fn objects_and_groups_are_parts_and_hidden_ones_are_left_out() {
    let faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no car\nf 1 2 3\ng wheel left\nf 1 2 3\nf 3 2 1\no car\ng\nf 2 3 1\n\
                 o empty\no bike\ng bike\nf 1 2 3\n";
    let hiding = |hidden: &[&str]| {
        let hidden = hidden.iter().map(|name| (*name).to_owned()).collect();
        let shown = ShownParts { hidden, ..ShownParts::default() };
        let selected = Selection { parts: Some(&shown), ..Selection::default() };
        super::read(faces.as_bytes().to_vec(), &ModelFile { selected, ..ModelFile::from_test("", &Progress::new()) })
    };
    let parts = |loaded: &LoadedMesh| -> Vec<(String, u32, bool)> {
        loaded.contents.parts.iter().map(|part| (part.name.clone(), part.triangles, part.is_hidden)).collect()
    };
    let named = |hidden: bool| {
        [("default", 1, false), ("car", 2, false), ("car/wheel left", 2, hidden), ("bike", 1, false)]
            .map(|(name, triangles, is_hidden)| (name.to_owned(), triangles, is_hidden))
    };
    let whole = hiding(&[]).expect("triangles");
    assert_eq!((whole.triangles.len(), parts(&whole)), (6, named(false).to_vec()));
    let some = hiding(&["car/wheel left"]).expect("triangles");
    assert_eq!((some.triangles.len(), parts(&some)), (4, named(true).to_vec()));
    let none = hiding(&["default", "car", "car/wheel left", "bike"]).map(|_| ()).expect_err("all are hidden");
    assert!(
        matches!(&none, ReadError::Empty { holds } if holds.contains("and its parts are hidden; choose one of ")),
        "{none:?}"
    );
}

#[test]
fn materials_are_parts_too_if_there_are_several() {
    let faces =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\no car\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 2 3\nf 3 2 1\no bike\nf 2 3 1\n";
    let read = |hidden: &[&str], only: &[&str]| {
        let [hidden, only] =
            [hidden, only].map(|names| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>());
        let shown = ShownParts { hidden, only, ..ShownParts::default() };
        let selected = Selection { parts: Some(&shown), ..Selection::default() };
        super::read(faces.as_bytes().to_vec(), &ModelFile { selected, ..ModelFile::from_test("", &Progress::new()) })
    };
    let whole = read(&[], &[]).expect("triangles");
    let parts: Vec<_> = whole.contents.parts.iter().map(|part| (part.name.as_str(), part.triangles)).collect();
    assert_eq!(parts, [("car", 3), ("bike", 1), ("material:red", 1), ("material:blue", 3)]);
    assert_eq!(whole.part_of(0), Some(0), "a triangle belongs to the part that isn't a material");
    let blue = read(&[], &["material:blue"]).expect("triangles");
    assert_eq!((blue.triangles.len(), blue.materials.len()), (3, 1));
    assert_eq!((0..3).map(|triangle| blue.part_of(triangle)).collect::<Vec<_>>(), [Some(0), Some(0), Some(1)]);
    let both = read(&["material:red"], &["car"]).expect("triangles");
    assert_eq!(both.triangles.len(), 2, "of the car, what isn't red");
    let none = read(&["material:red", "material:blue"], &[]).map(|_| ()).expect_err("all are hidden");
    assert!(none.to_string().contains("its parts are hidden"), "{none}");
}

#[test]
fn text_is_forgiven_its_spaces_its_comments_and_its_ends_of_lines() {
    let cube = cube();
    let (vertices, faces) = cube.split_at(cube.find("g sides").unwrap());
    for text in [
        cube.replace('\n', "\r\n"),
        cube.replace('\n', "\r"),
        cube.replace(' ', "\t "),
        cube.replace('\n', " # c:\\\n\n"),
        cube.replace("f ", "  f \\\n").replace("v ", "v\\\r\n\\\n"),
        format!("\u{feff}{cube}"),
        format!("{faces}{vertices}"),
        cube.replace("# made by a test", "# ends with a folder \\"),
        cube.replace("\nf ", "\nfo "),
        vertices.replace('\n', " 1 0.5 0.5\n") + faces,
    ] {
        assert_cube(&read(&text));
    }
}

#[test]
fn corners_are_given_in_four_ways_and_from_either_end() {
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.25 0.25\nvt 1\nvn 0 0 1\nvn 0 1 0\n";
    for (face, uv, normal) in [
        ("f 1 2 3", Vec2::ZERO, Vec3::Z),
        ("f 1/1 2/1 3/1", Vec2::new(0.25, 0.75), Vec3::Z),
        ("f 1//2 2//2 3//2", Vec2::ZERO, Vec3::Y),
        ("f 1/2/2 2/2/2 3/2/2", Vec2::ONE, Vec3::Y),
        ("f -3/-2/-1 -2/-2/-1 -1/-2/-1", Vec2::new(0.25, 0.75), Vec3::Y),
        ("f 1/1/ 2/1/ 3/1/", Vec2::new(0.25, 0.75), Vec3::Z),
    ] {
        let mesh = read(&format!("{vertices}{face}\nv 9 9 9\nvn 1 0 0\n"));
        assert_eq!(**mesh.triangles, [[0, 1, 2]], "{face}");
        assert!(mesh.corners.iter().all(|corner| (corner.uv, corner.normal) == (uv, normal)), "{face}");
    }
}

#[test]
fn only_missing_normals_are_made() {
    let mesh = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 1 0\nf 1//1 2 3\nf 1//1 2//1 3//1\n");
    let normals = |t: usize| mesh.triangles[t].map(|corner| mesh.corners[corner as usize].normal);
    assert_eq!((normals(0), normals(1)), ([Vec3::Y, Vec3::Z, Vec3::Z], [Vec3::Y; 3]));
    assert_eq!(mesh.repairs.normals_made, 2);
    assert_eq!(mesh.warnings, [format!("{WITHOUT_NORMALS}: 1.")]);
}

#[test]
fn concave_polygons_are_cut_inside() {
    // An L-shaped polygon, starting at a corner from which a fan would reach outside.
    let mesh = read("v 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\nf 1 2 3 4 5 6\n");
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|corner| mesh.corners[corner as usize].position);
        (b - a).cross(c - a).z / 2.0
    };
    let areas: Vec<f32> = mesh.triangles.iter().map(area).collect();
    assert!(areas.len() == 4 && areas.iter().all(|area| *area > 0.0), "{areas:?}");
    assert_eq!(areas.iter().sum::<f32>(), 3.0);
}

#[test]
fn small_faces_and_other_elements_are_left_out_and_counted() {
    let mesh = read(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2\np 3\nl 1 2 3\ncurv 0 1 1 2\nsurf 0 1 0 1 1 2 3\ncall a.obj 1\ncsh ls\nfrob 1\nf 1 2 3\n",
    );
    let expected = [
        &format!("{WITHOUT_NORMALS}: 1."),
        "points (p), left out: 3.",
        "lines (l), left out: 1.",
        "free-form curves and surfaces (curv, curv2, surf), which aren't read: 2.",
        "calls of other files and of programs (call, csh), left out: 2.",
        "statements that OBJ doesn't have, left out: 1.",
    ];
    assert_eq!(mesh.warnings, expected);
}

#[test]
fn cancelling_stops_the_work() {
    let progress = Progress::new();
    progress.cancel();
    assert!(matches!(
        super::read(b"v 0 0 0\n".to_vec(), &ModelFile::from_test("", &progress)),
        Err(ReadError::Cancelled(_))
    ));
}

#[test]
fn smoothing_groups_make_the_normals_that_are_missing() {
    // A roof of two squares with an edge of 90 degrees, and the ground under it.
    let points = "v 0 0 0\nv 1 1 0\nv 2 0 0\nv 0 0 1\nv 1 1 1\nv 2 0 1\n";
    let normals = |groups: [&str; 3]| {
        let [a, b, c] = groups;
        let mesh = read(&format!("{points}s {a}\nf 1 4 5 2\ns {b}\nf 2 5 6 3\ns {c}\nf 1 3 6 4\n"));
        let ridge = mesh.corners.iter().filter(|corner| corner.position == Vec3::new(1.0, 1.0, 0.0));
        (ridge.map(|corner| corner.normal).collect::<Vec<_>>(), mesh.warnings)
    };
    let smoothed =
        "faces without normals, or with some missing, which got those of their smoothing groups: 3.".to_owned();
    let (smooth, warnings) = normals(["1", "1", "off"]);
    assert_eq!((smooth.len(), warnings), (1, vec![smoothed.clone()]));
    assert!(smooth[0].distance(Vec3::Y) < 1e-6, "{smooth:?}");
    let (creased, warnings) = normals(["1", "2", "0"]);
    assert_eq!((creased.len(), warnings), (2, vec![smoothed]));
    let half = std::f32::consts::FRAC_1_SQRT_2;
    assert!(creased[0].distance(Vec3::new(-half, half, 0.0)) < 1e-6, "{creased:?}");
    // Many programs write "s off" whatever they mean, so alone it says nothing.
    assert_eq!(normals(["off", "off", "off"]).1, [format!("{WITHOUT_NORMALS}: 3.")]);
}

#[test]
fn vertices_may_have_colours() {
    let mesh = read("v 0 0 0\nv 1 0 0 0 0.5 1\nv 0 1 0 1 0 255 0\nv 1 1 0 1\nf 1 2 3\nf 2 4 3\n");
    let color = |x: f32, y: f32| {
        let corner = mesh.corners.iter().position(|corner| corner.position == Vec3::new(x, y, 0.0)).unwrap();
        mesh.details.as_ref().expect("it has colours")[corner].color
    };
    assert_eq!((color(0.0, 0.0), color(1.0, 1.0)), (Vec4::ONE, Vec4::ONE), "the last number is a weight");
    assert_eq!(color(0.0, 1.0), Vec4::new(0.0, 1.0, 0.0, 1.0), "after a weight, from 0 to 255");
    assert!((color(1.0, 0.0) - Vec4::new(0.0, 0.2159, 1.0, 1.0)).abs().max_element() < 1e-3);
    assert!(read(&cube()).details.is_none());
}

#[test]
fn triangles_that_are_taken_together_are_those_that_are_taken_one_by_one() {
    let mut random = fastrand::Rng::with_seed(3);
    let mut vertices = String::new();
    for i in 0..3_000 {
        let bad = |random: &mut fastrand::Rng, number: usize| match random.u32(..400) {
            0 => "nan".to_owned(),
            _ => number.to_string(),
        };
        let [x, y, u, v] = [i % 40, i / 40, i % 3, i % 4].map(|number| bad(&mut random, number));
        vertices += &format!("v {x} {y} {}\nvt {u} {v}\nvn 0 {} 1\n", i % 5, i % 2);
    }
    // Faces that are continued in the next line need a closer look, and are taken one by one.
    let [mut together, mut one_by_one] = [vertices.clone(), vertices];
    for i in 0..12_000 {
        if random.u32(..300) == 0 {
            let statement =
                ["s 1", "s off", "s 2", "usemtl red", "usemtl blue", "g a", "g b", "p 1"][random.usize(..8)];
            [&mut together, &mut one_by_one].into_iter().for_each(|text| *text += &format!("{statement}\n"));
        }
        let corners = if i % 500 == 499 { 4 } else { 3 };
        let corners: Vec<String> = (0..corners)
            .map(|_| {
                let vertex = 1 + (i / 4 + random.usize(..30)) % 3_000;
                match random.u32(..200) {
                    0 => format!("{vertex}/{vertex}"),
                    1 => "4000".to_owned(),
                    _ => format!("{vertex}/{vertex}/{vertex}"),
                }
            })
            .collect();
        together += &format!("f {}\n", corners.join(" "));
        one_by_one += &format!("f {}\n", corners.join(" \\\n"));
    }
    let shown = ShownParts { hidden: vec!["b".to_owned()], ..ShownParts::default() };
    for selection in [Selection::default(), Selection { parts: Some(&shown), ..Selection::default() }] {
        let read = |text: &String| {
            let bytes = text.as_bytes().to_vec();
            super::read(bytes, &ModelFile { selected: selection, ..ModelFile::from_test("", &Progress::new()) })
                .unwrap()
        };
        let [together, one_by_one] = [&together, &one_by_one].map(read);
        assert_eq!(together.mesh.triangles, one_by_one.mesh.triangles);
        assert_eq!(together.mesh.corners, one_by_one.mesh.corners);
        assert_eq!(together.contents.parts, one_by_one.contents.parts);
        let counts = |loaded: &LoadedMesh| -> Vec<String> {
            let before = |warning: &String| warning.split(", the first").next().unwrap_or_default().to_owned();
            loaded.warnings.iter().map(before).collect()
        };
        assert_eq!(counts(&together), counts(&one_by_one), "but for the line of the first");
    }
}

/// Four squares, whose middle is 1 high.
const TENT: &str = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 1\nv 2 1 0\nv 0 2 0\nv 1 2 0\nv 2 2 0\n\
                    f 1 2 5 4\nf 2 3 6 5\nf 4 5 8 7\nf 5 6 9 8\n";

/// Takes the faces as the cage of a Catmull-Clark surface, whose limit their corners get.
fn refined(text: &str, import: Import) -> LoadedMesh {
    let import = Import { subdivide: Subdivide::CatmullClark, ..import };
    let (selected, progress) = (Selection { import, ..Selection::default() }, Progress::new());
    let file = ModelFile { selected, ..ModelFile::from_test("cage", &progress) };
    super::read(text.as_bytes().to_vec(), &file).expect("a mesh")
}

/// Without refining it.
fn limit() -> Import {
    Import { levels: Some(0.0), ..Import::default() }
}

#[test]
fn tags_say_creases_sharp_points_holes_and_rules() {
    let height = |tags: &str| {
        let mesh = refined(&format!("{tags}{TENT}"), limit());
        assert_eq!(mesh.warnings, [] as [String; 0], "{tags}");
        let after = refined(&format!("{TENT}{tags}"), limit());
        assert_eq!(after.corners, mesh.corners, "tags may come last");
        mesh.corners.iter().map(|corner| corner.position.z).fold(0.0, f32::max)
    };
    let near = |a: f32, b: f32| assert!((a - b).abs() < 1e-6, "{a} is not {b}");
    // (12 of itself, and 4 of each face's center) / 36; along a crease 2/3 of itself; at a sharp point all of itself.
    near(height(""), 4.0 / 9.0);
    near(height("t crease 3/1/0 1 4 7 10\n"), 2.0 / 3.0);
    near(height("t crease 2/1/0 1 4 10\nt crease 2/1/0 7 4 9e9\n"), 2.0 / 3.0);
    near(height("t crease 3/2/0 1 4 7 10 0\n"), 4.0 / 9.0);
    near(height("t corner 2/1/0 4 0 inf # sharp\n"), 1.0);
    // An open mesh has corners unless the file says that it hasn't.
    let corner = |rule: &str| {
        let mesh = refined(&format!("{TENT}t interpolateboundary 1/0/0 {rule}\n"), limit());
        mesh.corners.iter().map(|corner| corner.position.x).fold(9.0, f32::min)
    };
    near(corner("1"), 0.0);
    assert!(corner("2") == 0.0, "the middle of a side stays on it");
    let inside = |rule: &str| {
        let mesh = refined(&format!("{TENT}t interpolateboundary 1/0/0 {rule}\n"), limit());
        mesh.corners.iter().map(|corner| corner.position.truncate().length()).fold(9.0, f32::min)
    };
    near(inside("1"), 0.0);
    near(inside("2"), 2.0_f32.sqrt() / 6.0);
    // A hole shapes the faces beside it.
    let [whole, holed] = ["", "t hole 1/0/0 3\n"].map(|tag| refined(&format!("{TENT}{tag}"), limit()));
    assert_eq!((whole.triangles.len(), holed.triangles.len()), (8, 6));
    assert!(holed.corners.iter().all(|corner| whole.corners.contains(corner)));
}

#[test]
fn flawed_tags_are_left_out_and_counted() {
    let flawed = "t crease 2/1/0 1 4 -1\nt corner 1/1/0 4 nan\nt crease 2/1/0 1 99 2\nt corner 1/1/0 -1 2\n\
                  t crease 2/1/0 4 4 1\nt hole 1/0/0 4\nt crease 2/1/0 0 8 2\nt crease 3/1/0 1 4\n\
                  t crease 2/3/0 1 4 1 1 1\nt crease\nt\nt corner a/b/c\nt hole 99999999999999999999/0/0\n\
                  t interpolateboundary 1/0/0 0\nt facevaryinginterpolateboundary 1/0/0 6\nt smoothtriangles 0/0/1 smooth\n";
    let mesh = refined(&format!("{TENT}{flawed}"), limit());
    assert_eq!(mesh.corners, refined(TENT, limit()).corners);
    let expected = [
        "and known rules for boundaries, left out: 9.",
        "whose sharpness is negative or not a number, left out: 2.",
        "of a vertex or face that isn't in the file, left out: 4.",
        "creases and sharp points that no face has, left out: 1.",
    ];
    assert_eq!(mesh.warnings.len(), 4, "{:?}", mesh.warnings);
    for (warning, expected) in mesh.warnings.iter().zip(expected) {
        assert!(warning.ends_with(expected), "{warning}");
    }
    // Where nothing is refined, they say nothing.
    assert_eq!(read(&format!("{TENT}{flawed}")).warnings, [format!("{WITHOUT_NORMALS}: 4.")]);
}

#[test]
fn texture_coordinates_follow_the_files_rule_or_that_which_was_chosen_and_move_no_point() {
    // The coordinates are x and y, but 9 and 0 in the middle.
    let coordinates = "vt 0 0\nvt 1 0\nvt 2 0\nvt 0 1\nvt 9 0\nvt 2 1\nvt 0 2\nvt 1 2\nvt 2 2\n";
    let (vertices, _) = TENT.split_at(TENT.find('f').expect("faces"));
    let faces = "f 1/1 2/2 5/5 4/4\nf 2/2 3/3 6/6 5/5\nf 4/4 5/5 8/8 7/7\nf 5/5 6/6 9/9 8/8\n";
    let text = format!("{vertices}{coordinates}{faces}");
    let middle = |mesh: &LoadedMesh| {
        let middle = mesh.corners.iter().find(|corner| corner.position.truncate() == Vec2::ONE);
        middle.expect("a middle").uv.x
    };
    let plain = refined(&text, limit());
    assert_eq!(middle(&plain), 9.0);
    // 12 of itself, 2 of each neighbour and 1 of each corner: (16 * 9 + 4 * 4 * 1 + 4 * 1) / 36.
    let smooth = (16.0 * 9.0 + 4.0 * 4.0 + 4.0) / 36.0;
    let chosen = |rule, tag: u32| {
        let import = Import { subdivide_uvs: rule, ..limit() };
        let mesh = refined(&format!("{text}t facevaryinginterpolateboundary 1/0/0 {tag}\n"), import);
        assert_eq!(mesh.warnings, [] as [String; 0]);
        let points = |mesh: &LoadedMesh| mesh.corners.iter().map(|own| (own.position, own.normal)).collect::<Vec<_>>();
        assert_eq!(points(&mesh), points(&plain));
        middle(&mesh)
    };
    let near = |a: f32, b: f32| assert!((a - b).abs() < 1e-5, "{a} is not {b}");
    for tag in 0..5 {
        near(chosen(None, tag), smooth);
        assert_eq!(chosen(Some(FaceVarying::Linear), tag), 9.0);
    }
    assert_eq!(chosen(None, 5), 9.0);
    near(chosen(Some(FaceVarying::Boundaries), 5), smooth);
}
