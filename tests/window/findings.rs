//! The findings of the panel on the right: what they count, and the places that they lead to.

use egui::Key;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use geometry::mesh::{EdgeKind, Shape};
use geometry::view::project;
use glam::{Vec2, vec2};
use inspect::render::layout::{CRACK_COLOR, FOLD_COLOR, OUTLINE_COLOR, SIDE_COLORS};
use load::Source;
use pnaen::app::App;
use tempfile::TempDir;

use crate::{choose, click, press, resumed, scroll_to, settle, window};

/// The text of the first button that looks like this.
pub(super) fn button(harness: &Harness<App>, looks: impl Fn(&str) -> bool) -> String {
    let mut texts = harness.query_all_by_role(Role::Button).filter_map(|node| node.accesskit_node().label());
    texts.find(|text| looks(text)).expect("a button")
}

fn opened(folder: &TempDir, text: &str) -> Harness<'static, App> {
    let path = folder.path().join("mesh.obj");
    std::fs::write(&path, text).expect("a writable temporary folder");
    window(Some(Source::File(path)))
}

/// A triangle that folds, under a roof that is much larger.
fn roofed() -> String {
    let leaning = "v 0 0 0\nv 0.28 0 0.2\nv 1 0 0\nvn 0 1 0\nvn -0.77 0.32 -0.56\nvn 0.84 0.28 0.45\n";
    let roof = "v -3 0.6 -3\nv -3 0.6 3\nv 4 0.6 3\nv 4 0.6 -3\nvn 0 1 0\n";
    format!("{leaning}{roof}f 1//1 2//2 3//3\nf 4//4 5//4 6//4\nf 4//4 6//4 7//4\n")
}

/// How many px of the picture have this colour.
fn px_of(harness: &Harness<App>, color: [u8; 3]) -> usize {
    let picture = harness.state().read_picture().expect("a device").expect("a picture");
    picture.pixels().filter(|pixel| (0..3).all(|c| pixel.0[c].abs_diff(color[c]) < 12)).count()
}

#[test]
fn a_click_on_the_folds_shows_one_and_their_number_stays() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = opened(&folder, &roofed());
    let (finding, totals) = (button(&harness, |text| text.ends_with(" folds")), harness.state().totals());
    click(&mut harness, &finding);
    assert!(px_of(&harness, FOLD_COLOR) > 500, "{} px are of a fold", px_of(&harness, FOLD_COLOR));
    assert_eq!((button(&harness, |text| text.ends_with(" folds")), harness.state().totals()), (finding, totals));
    harness.get_by_label("LOD camera frozen");
    let thaw = button(&harness, |text| text.starts_with("LOD is frozen"));
    click(&mut harness, &thaw);
    assert!(harness.query_by_label("LOD camera frozen").is_none());
}

/// The rounded edges of a plate's two corners: needles, of which PN-AEN turns all of what it emits over.
fn needles() -> String {
    let first = "v -0.0952 0.00003 0.1966\nv -0.1396 0.0001 0.2\nv -0.1589 0.0001 0.2\n\
                 vn 0.0003 -0.9999 0.0118\nvn 0.0002 -0.2872 0.9579\nvn -0.7175 -0.2665 0.6436\n";
    let second = "v 0.0935 0.0808 0.1966\nv 0.1375 0.0808 0.2\nv 0.1589 0.0808 0.2\n\
                  vn 0 0.7623 0.6472\nvn 0 0.2894 0.9572\nvn 0.6834 0.2693 0.6786\n";
    let back = "v -0.16 0 -0.2\nv 0.16 0 -0.2\nv 0.16 0.08 -0.2\nvn 0 0 -1\n";
    format!("{first}{second}{back}f 1//1 2//2 3//3\nf 4//4 5//5 6//6\nf 7//7 9//7 8//7\n")
}

#[test]
fn a_fold_that_is_a_needle_is_wide_enough_to_be_seen_beside_the_lines_of_the_selection() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = opened(&folder, &needles());
    let finding = button(&harness, |text| text.ends_with(" folds"));
    click(&mut harness, &finding);
    assert!(harness.state().selected_triangle().is_some());
    assert!(px_of(&harness, FOLD_COLOR) > 2000, "{} px are of a fold", px_of(&harness, FOLD_COLOR));
    click(&mut harness, "Frame");
    assert!(px_of(&harness, FOLD_COLOR) > 1000, "{} px are of the framed patch", px_of(&harness, FOLD_COLOR));
}

#[test]
fn a_framed_patch_is_what_is_seen_in_the_middle() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = opened(&folder, &roofed());
    harness.state_mut().select_triangle(Some(0));
    settle(&mut harness);
    let totals = harness.state().totals();
    click(&mut harness, "Frame");
    assert_eq!(harness.state().totals(), totals, "LOD is frozen");
    let place = harness.get_by_role_and_label(Role::Image, "Viewport").rect().center();
    harness.hover_at(place);
    harness.drag_at(place);
    harness.run_steps(1);
    harness.drop_at(place);
    settle(&mut harness);
    assert_eq!(harness.state().selected_triangle(), Some(0), "the roof hides it from its front");
}

/// Two pairs of triangles with a split edge, which PN tears open. The second is larger and farther away from the front.
fn torn() -> String {
    let pair = |x: f32, z: f32, size: f32| {
        let at = |[a, b, c]: [f32; 3]| format!("v {} {} {}\n", x + size * a, size * b, z + size * c);
        [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.5, -0.6], [1.0, 0.5, -0.6]].map(at).concat()
    };
    let normals = "vn -0.5 -0.3 0.8\nvn 0.5 0.3 0.8\nvn -0.5 0.3 0.8\nvn 0.5 -0.3 0.8\n";
    let faces = "f 1//1 2//3 3//3\nf 2//2 1//4 4//4\nf 5//1 6//3 7//3\nf 6//2 5//4 8//4\n";
    pair(-1.5, 6.0, 1.0) + &pair(1.5, -6.0, 1.3) + normals + faces
}

#[test]
fn the_worst_crack_is_that_of_the_headline_and_its_gap_is_seen() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = opened(&folder, &torn());
    choose(&mut harness, "Surface", "PN");
    press(&mut harness, Key::Num1);
    let app = harness.state();
    let bounds = app.loaded().expect("a mesh").mesh.bounds();
    let size = |harness: &Harness<App>| -> Vec2 {
        let picture = harness.state().read_picture().expect("a device").expect("a picture");
        vec2(picture.width() as f32, picture.height() as f32)
    };
    let viewport = size(&harness);
    let clip_from_object = app.camera().clip_from_object(viewport, &bounds);
    let cracks = app.cracks().expect("measured").cracked().to_vec();
    let px: Vec<f64> = cracks.iter().map(|crack| crack.gap_px(clip_from_object, viewport)).collect();
    assert!(cracks.len() == 2 && cracks[0].gap > cracks[1].gap && px[1] > px[0], "{cracks:?} {px:?}");
    let finding = button(&harness, |text| text.contains("cracked edges, widest"));
    click(&mut harness, &finding);
    assert_eq!(harness.state().selected_edge(), Some(cracks[1].edge), "the widest in px");
    assert_eq!(button(&harness, |text| text.contains("cracked edges, widest")), finding);
    // The lines of the selection leave the gap free.
    let picture = harness.state().read_picture().expect("a device").expect("a picture");
    let clip_from_object = harness.state().camera().clip_from_object(viewport, &bounds);
    let [a, b] = cracks[1].widest;
    let middle = project(clip_from_object, viewport, 0.5 * (a + b)).expect("in front of the eye");
    let gap = cracks[1].gap_px(clip_from_object, viewport);
    assert!(gap > 15.0 && middle.distance(0.5 * viewport) < 0.25 * viewport.min_element(), "{gap} px wide at {middle}");
    let pixel = picture.get_pixel(middle.x as u32, middle.y as u32).0;
    for color in SIDE_COLORS.into_iter().chain([CRACK_COLOR, OUTLINE_COLOR]) {
        assert!((0..3).any(|c| pixel[c].abs_diff(color[c]) > 12), "{pixel:?} in the gap");
    }
}

#[test]
fn the_gap_of_the_selected_edge_is_that_of_the_headline_while_lod_is_frozen() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = opened(&folder, &torn());
    choose(&mut harness, "Surface", "PN");
    let finding = button(&harness, |text| text.contains("cracked edges, widest"));
    click(&mut harness, &finding);
    harness.get_by_label_contains("LOD is frozen");
    let (_, px) = finding.split_once("widest ").expect("a width");
    // In the headline's facts, and in the selected edge's; the picture comes much nearer.
    assert_eq!(harness.get_all_by_label(px).count(), 2, "{px}");
}

#[test]
fn what_gates_find_in_the_mesh_has_lines_that_lead_to_the_worst_places() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = opened(&folder, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\nf 3 4 1\n");
    let open = |harness: &mut Harness<App>| {
        let button = harness.get_by_label_contains("In the mesh: ").accesskit_node().label().expect("a label");
        scroll_to(harness, &button);
        click(harness, &button);
    };
    open(&mut harness);
    click(&mut harness, "1 triangle repeats another one");
    assert_eq!(harness.state().selected_triangle(), Some(2));
    open(&mut harness);
    click(&mut harness, "1 edge has three triangles or more");
    let app = harness.state();
    let topology = &app.loaded().expect("a mesh").topology;
    let kind = |edge: u32| topology.edges[edge as usize].kind;
    assert_eq!(app.selected_edge().map(kind), Some(EdgeKind::NonManifold));
    open(&mut harness);
    click(&mut harness, "2 edges are open");
    open(&mut harness);
    for none in ["blown up", "no area"] {
        assert!(harness.query_by_label_contains(none).is_none(), "there is none");
    }
    let mut harness = window(Some(Source::Shape(Shape::CubeSmooth)));
    open(&mut harness);
    click(&mut harness, "12 triangles are blown up at hard edges");
    assert!(harness.state().selected_triangle().is_some());
    assert!(harness.query_by_label_contains("are open").is_none(), "it is closed");
}

#[test]
fn shading_seams_are_no_cracks() {
    let mut harness = window(Some(Source::Shape(Shape::CubeSmooth)));
    choose(&mut harness, "Shading", "Surface normals");
    let cracks = harness.state().cracks().expect("measured");
    let seams = cracks.edges.iter().filter(|edge| edge.different_normals > 0).count();
    assert!(seams > 3 && cracks.different_bits == 0, "{seams}");
    harness.get_by_label("No cracks");
    harness.get_by_label("cracks 0");
    let worst = cracks.edges.iter().map(|edge| edge.different_normals).max();
    let finding = button(&harness, |text| text == format!("{seams} shading seams"));
    click(&mut harness, &finding);
    let selected = harness.state().selected_edge();
    let cracks = harness.state().cracks().expect("measured");
    let shown = cracks.edges.iter().find(|edge| Some(edge.edge) == selected);
    assert_eq!(shown.map(|edge| edge.different_normals), worst);
    assert!(harness.query_by_label("Worst edges").is_none(), "none of them is cracked");
}

/// The numbers that the status line, the findings and the list of the worst edges show.
fn numbers(harness: &Harness<App>) -> Vec<String> {
    let texts = |role| {
        harness.query_all_by_role(role).filter_map(|node| {
            let node = node.accesskit_node();
            node.label().or(node.value())
        })
    };
    let counts =
        [" triangles", "cracks ", " patches", " vertices", "cracked edge", "split normal", "Folds", "Cracks", "olds"];
    let all = texts(Role::Label).chain(texts(Role::Button));
    all.filter(|text| counts.iter().any(|count| text.contains(count))).collect()
}

#[test]
fn all_numbers_change_together_once_another_view_is_measured() {
    let mut harness = window(Some(Source::Shape(Shape::CubeSplit)));
    choose(&mut harness, "Surface", "PN");
    scroll_to(&mut harness, "Worst edges");
    let before = numbers(&harness);
    assert!(before.iter().filter(|text| text.contains("split normal")).count() >= 5, "{before:?}");
    harness.key_press(Key::Num3);
    let start = std::time::Instant::now();
    let mut all = vec![before];
    let mut was_busy = false;
    loop {
        harness.step();
        let now = numbers(&harness);
        assert!(!now.iter().any(|text| text.contains('…')), "{now:?}");
        if *all.last().expect("one") != now {
            all.push(now);
        }
        if was_busy && !harness.state().is_busy() {
            break;
        }
        was_busy |= harness.state().is_busy();
        assert!(start.elapsed() < crate::PATIENCE, "the window is still busy");
    }
    assert_eq!(all.len(), 2, "those before and those after: {all:#?}");
}

/// The text of the first label or button that contains this.
fn said(harness: &Harness<App>, part: &str) -> String {
    let node = harness.get_by_label_contains(part).accesskit_node();
    node.label().or(node.value()).expect("a text")
}

#[test]
fn what_was_counted_in_the_frozen_view_stays_and_the_holes_in_the_mesh_are_explained() {
    let mut harness = window(Some(Source::Shape(Shape::Torus)));
    let checked = button(&harness, |text| text.starts_with("Checked: "));
    let (drawn, all) = checked["Checked: ".len()..].split_once(" of ").expect("two numbers");
    let number = |text: &str| text.trim_end_matches(" patches").replace(',', "").parse::<u32>().expect("a number");
    let left_out = number(all) - number(drawn);
    assert!(left_out > 0, "{checked}: some face away");
    let sizes = said(&harness, "% of triangles below 3 px");
    harness.state_mut().select_triangle(Some(0));
    settle(&mut harness);
    click(&mut harness, "Frame");
    assert_eq!(said(&harness, "% of triangles below 3 px"), sizes);
    assert_eq!(button(&harness, |text| text.starts_with("Checked: ")), checked);
    harness.get_by_label_contains(&format!("doesn't see them: {left_out} patches"));
    press(&mut harness, Key::Z);
    assert!(harness.query_by_label_contains("doesn't see them").is_none());
    assert_ne!(said(&harness, "% of triangles below 3 px"), sizes, "a single patch is in view");
}

#[test]
fn the_hover_text_of_a_finding_covers_no_other_finding() {
    let mut harness = window(None);
    let finding = harness.get_by_label("No cracks");
    let left = finding.rect().left();
    finding.hover();
    harness.run_steps(60);
    let hover = harness.get_by_label("Every shared edge of what is drawn matches bit for bit.").rect();
    assert!(hover.right() <= left, "{hover} ends right of {left}");
}

#[test]
fn a_row_that_selects_a_patch_stays_under_the_pointer() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = opened(&folder, &roofed());
    let finding = button(&harness, |text| text.ends_with(" folds"));
    click(&mut harness, &finding);
    press(&mut harness, Key::Escape);
    assert_eq!(harness.state().selected_triangle(), None);
    scroll_to(&mut harness, "Folded patches");
    let row = button(&harness, |text| text.starts_with("0    "));
    let place = |harness: &Harness<App>| harness.get_by_label(&row).rect().center();
    let before = place(&harness);
    click(&mut harness, &row);
    assert_eq!(harness.state().selected_triangle(), Some(0));
    assert!(place(&harness).distance(before) < 1.0, "{before} {}", place(&harness));
}

/// A tetrahedron whose first corner is at this x.
fn tetrahedron(x: f32, size: f32) -> String {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let line = |[a, b, c]: [f32; 3]| format!("v {} {} {}\n", x + size * a, size * b, size * c);
    corners.map(line).concat() + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
}

const NOTHING: &str = "Nothing of the mesh is in view.";

#[test]
fn a_picture_of_nothing_says_so_and_offers_to_frame_the_mesh() {
    let mut harness = window(Some(Source::Shape(Shape::CubeSplit)));
    assert!(harness.query_by_label(NOTHING).is_none());
    for _ in 0..60 {
        harness.key_press_modifiers(egui::Modifiers::SHIFT, Key::ArrowRight);
        harness.step();
    }
    settle(&mut harness);
    harness.get_by_label(NOTHING);
    harness.get_by_label("Checked: 0 of 12 patches");
    click(&mut harness, "Frame the mesh");
    assert!(harness.query_by_label(NOTHING).is_none());
    assert!(harness.state().totals().is_some_and(|(_, triangles)| triangles > 0));
}

#[test]
fn a_camera_that_sees_nothing_of_a_file_frames_it() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("moved.obj");
    let write = |x: f32, size: f32| std::fs::write(&path, tetrahedron(x, size)).expect("a writable temporary folder");
    let open = || resumed(&folder.path().join("kept"), [1200.0, 800.0], Some(Source::File(path.clone())));
    let target = |harness: &Harness<App>| harness.state().camera().target.x;
    write(0.0, 1.0);
    let mut harness = open();
    assert!((0.0..1.0).contains(&target(&harness)));
    // Loaded again, far away, and so small that it is less than a px.
    for (x, size) in [(100.0, 1.0), (0.0, 1.0), (0.0, 1e-4)] {
        write(x, size);
        press(&mut harness, Key::R);
        assert!((x..x + size).contains(&target(&harness)), "{x}: {}", target(&harness));
        assert!(harness.query_by_label(NOTHING).is_none());
    }
    write(0.0, 1.0);
    press(&mut harness, Key::F);
    press(&mut harness, Key::R);
    press(&mut harness, Key::F);
    eframe::App::on_exit(harness.state_mut());
    drop(harness);
    // Opened anew with the camera of the last time.
    write(100.0, 1.0);
    let harness = open();
    assert!((100.0..101.0).contains(&target(&harness)), "{}", target(&harness));
}

#[test]
fn a_finding_leads_from_its_worst_place_to_the_next_and_to_the_one_before() {
    let mut harness = window(None);
    choose(&mut harness, "Surface", "PN");
    assert!(harness.query_by_label("Next place").is_none(), "no finding is shown");
    let finding = button(&harness, |text| text.contains("cracked edges, widest"));
    click(&mut harness, &finding);
    let first = harness.state().selected_edge().expect("the worst");
    let mut seen = vec![first];
    for place in 2..=3 {
        click(&mut harness, "Next place");
        harness.get_by_label(&format!("{place}/12"));
        let edge = harness.state().selected_edge().expect("another edge");
        assert!(!seen.contains(&edge), "{edge} was shown before");
        seen.push(edge);
    }
    assert_eq!(button(&harness, |text| text.contains("cracked edges, widest")), finding, "the numbers stay true");
    press(&mut harness, egui::Key::F8);
    harness.get_by_label("4/12");
    harness.key_press_modifiers(egui::Modifiers::SHIFT, egui::Key::F8);
    settle(&mut harness);
    assert_eq!(harness.state().selected_edge(), Some(seen[2]));
    click(&mut harness, &finding);
    assert_eq!(harness.state().selected_edge(), Some(first), "the finding itself is its worst place");
    click(&mut harness, "Previous place");
    harness.get_by_label("12/12");
}

/// A tetrahedron whose faces have normals of their own, so that all of its edges are split.
const FACETED: &str = "v 1 1 1\nv -1 -1 1\nv -1 1 -1\nv 1 -1 -1\nvn 1 1 -1\nvn 1 -1 1\nvn -1 1 1\nvn -1 -1 -1\n\
                       f 1//1 4//1 3//1\nf 1//2 2//2 4//2\nf 1//3 3//3 2//3\nf 2//4 3//4 4//4\n";

#[test]
fn normals_are_made_anew_with_a_click_where_all_edges_are_split() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = opened(&folder, FACETED);
    let split = |harness: &Harness<App>| harness.state().loaded().map(|loaded| loaded.topology.edge_counts().split);
    assert_eq!(split(&harness), Some(6));
    click(&mut harness, "All 6 edges are split");
    // The faces meet at more than 60 degrees: what is smooth is chosen below.
    harness.get_by_role_and_label(Role::Slider, "Crease angle").set_value_accesskit(180.0);
    settle(&mut harness);
    assert_eq!(split(&harness), Some(0));
    assert!(harness.query_by_label_contains("edges are split").is_none());
}

#[test]
fn wires_that_are_too_dense_are_said_to_be() {
    let mut harness = crate::uniform(Some(Source::Shape(Shape::Icosphere)));
    harness.get_by_role_and_label(Role::Slider, "Factor").set_value_accesskit(64.0);
    settle(&mut harness);
    assert!(harness.query_by_label_contains("Wires too dense: ").is_none());
    press(&mut harness, Key::W);
    harness.get_by_label_contains("Wires too dense: ");
}

#[test]
fn colours_have_a_number_under_the_pointer_while_it_rests() {
    let mut harness = crate::uniform(Some(Source::Shape(Shape::Icosphere)));
    let place = harness.get_by_role_and_label(Role::Image, "Viewport").rect().center();
    harness.hover_at(place);
    settle(&mut harness);
    assert!(harness.query_by_label_contains("Factors 8.00").is_none(), "the material has no numbers");
    choose(&mut harness, "Colours", "Factors");
    harness.hover_at(place);
    settle(&mut harness);
    harness.get_by_label("Factors 8.00, 8.00, 8.00");
    choose(&mut harness, "Colours", "Triangle size");
    harness.hover_at(place);
    settle(&mut harness);
    let px = last_label(&harness, |text| text.ends_with(" px") && text.split(' ').count() == 2);
    assert!(px.is_some_and(|text| text.trim_end_matches(" px").parse::<f64>().is_ok_and(|px| px > 1.0 && px < 60.0)));
    choose(&mut harness, "Colours", "Curvature");
    harness.hover_at(place);
    settle(&mut harness);
    let radius = harness.state().loaded().expect("a mesh").mesh.bounds().radius();
    let curvature = |harness: &Harness<App>, end: &str| -> f32 {
        let found = last_label(harness, |text| text.ends_with(end));
        found.and_then(|text| text.trim_end_matches(end).parse().ok()).expect("a curvature")
    };
    let mean = curvature(&harness, " / unit");
    assert!((0.7..1.3).contains(&(mean * radius)), "{mean}, as the sphere has");
    choose(&mut harness, "Kind of curvature", "Gaussian");
    harness.hover_at(place);
    settle(&mut harness);
    let gaussian = curvature(&harness, " / unit²");
    assert!((0.5..1.03).contains(&(gaussian / (mean * mean))), "{gaussian}, at most the square of {mean}");
    choose(&mut harness, "Colours", "Deviation");
    choose(&mut harness, "Surface", "Flat");
    harness.hover_at(place);
    settle(&mut harness);
    let largest = harness.state().deviation(inspect::settings::SplitSide::Right).expect("measured");
    let found = last_label(&harness, |text| text.ends_with(" units") && text.split(' ').count() == 2);
    let found: f64 = found.and_then(|text| text.trim_end_matches(" units").parse().ok()).expect("a distance");
    assert!(found <= 1.001 * largest, "{found} of {largest}");
    // In px it is as long as it would be across the view, where the sphere is.
    choose(&mut harness, "Distances in", "Px");
    harness.hover_at(place);
    settle(&mut harness);
    let px = last_label(&harness, |text| text.ends_with(" px") && text.split(' ').count() == 2);
    let px: f64 = px.and_then(|text| text.trim_end_matches(" px").parse().ok()).expect("a distance");
    let camera = harness.state().camera();
    let bounds = harness.state().loaded().expect("a mesh").mesh.bounds();
    let height = harness.get_by_role_and_label(Role::Image, "Viewport").rect().height();
    let nearest = camera.distance - 0.5 * (bounds.max - bounds.min).max_element();
    let expected = found * f64::from(camera.distance / camera.units_per_pixel(height) / nearest);
    assert!((px / expected - 1.0).abs() < 0.1, "{px} and {expected} px");
    // A pointer that goes on before anything is found leaves nothing under way.
    let start = harness.state().pictures();
    harness.hover_at(place + egui::vec2(9.0, 0.0));
    harness.step();
    harness.hover_at(egui::pos2(2.0, 2.0));
    harness.run_steps(4);
    assert!(!harness.state().is_busy() && harness.state().pictures() == start);
}

#[test]
fn texel_density_has_a_number_under_the_pointer_while_it_rests() {
    let mut harness = crate::uniform(Some(Source::Shape(Shape::Torus)));
    choose(&mut harness, "Colours", "Texel density");
    let middle = harness.get_by_role_and_label(Role::Image, "Viewport").rect().center();
    let found = |harness: &mut Harness<App>, end: &str| -> Option<f64> {
        // The middle may be the hole.
        let label = (0..10_u8).find_map(|step| {
            harness.hover_at(middle + egui::vec2(20.0 * f32::from(step), 0.0));
            settle(harness);
            last_label(harness, |text| text.ends_with(end))
        });
        label?.trim_end_matches(end).parse().ok()
    };
    let in_px = found(&mut harness, " texels / px").expect("a density");
    assert!(in_px > 0.01 && in_px < 100.0, "{in_px}");
    choose(&mut harness, "Texels per", "Object units");
    let along_unit = found(&mut harness, " texels / unit").expect("a density");
    assert!(along_unit > 10.0 && along_unit < 1e5, "{along_unit}");
}

/// The last label that looks like this: tooltips come after all else.
fn last_label(harness: &Harness<App>, looks: impl Fn(&str) -> bool) -> Option<String> {
    let texts = harness.query_all_by_role(Role::Label).filter_map(|node| node.accesskit_node().value());
    texts.filter(|text| looks(text)).last()
}
