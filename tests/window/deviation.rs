//! The deviation overlay, its section, and reference surfaces.

use documents::cages::cube;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use geometry::mesh::Shape;
use geometry::tessellate::{Partitioning, Surface};
use glam::Vec3;
use inspect::render::layout::CRACK_COLOR;
use inspect::settings::{Colors, Lighting, Settings, SplitSide, SurfaceUnit};
use load::Source;
use pnaen::app::App;
use pnaen::commands::{Action, FileAction, all};

use crate::editing::{assert_draws, copied};
use crate::environment::panorama;
use crate::{choose, click, open_list, press, settle, uniform, uniform_of, vase, window};

#[test]
fn deviation_has_numbers_and_a_legend_and_a_click_frames_the_worst_point() {
    let mut harness = uniform(Some(Source::Shape(Shape::Icosahedron)));
    choose(&mut harness, "Surface", "Flat");
    assert!(harness.query_by_label("Legend: Deviation, units").is_none());
    choose(&mut harness, "Colours", "Deviation");
    assert_eq!(harness.state().settings().overlays.colors, Colors::Deviation);
    assert!(harness.query_by_label("Legend: Deviation, units").is_some());
    // The distance between the inscribed and the circumscribed sphere.
    let largest = harness.state().deviation(SplitSide::Right).expect("measured");
    assert!((largest - 0.205_345_5).abs() < 1e-6, "{largest}");
    for text in ["exact icosahedron", "0.205 units", "At most"] {
        assert!(harness.query_all_by_label(text).next().is_some(), "{text}");
    }
    let at_most = harness.state().deviation_at_most(SplitSide::Right).expect("measured");
    assert!(at_most >= largest && at_most < 1.011 * largest, "{at_most}");
    let before = *harness.state().camera();
    harness.get_by_label_contains("Worst point in patch").click();
    settle(&mut harness);
    let after = *harness.state().camera();
    assert_ne!(after, before);
    // The worst point is the middle of a face, seen from above the face.
    assert!((after.target.length() - 0.794_654_5).abs() < 1e-5, "{}", after.target);
    assert!(after.axes()[2].distance(after.target.normalize()) < 1e-3);
    assert_eq!(harness.state().deviation(SplitSide::Right), Some(largest), "the tessellation stays the same");
    choose(&mut harness, "Distances in", "Px");
    assert_eq!(harness.state().settings().deviation_in, SurfaceUnit::Px);
    assert!(harness.query_by_label("Legend: Deviation, px").is_some());
    press(&mut harness, egui::Key::V);
    assert_eq!(harness.state().settings().overlays.colors, Colors::Material);
    assert!(harness.query_by_label("Legend: Deviation, px").is_none());
}

#[test]
fn framing_the_worst_point_keeps_the_tessellation_and_another_surface_is_measured_anew() {
    let mut harness = window(Some(Source::Shape(Shape::Icosahedron)));
    press(&mut harness, egui::Key::V);
    let adaptive = harness.state().deviation(SplitSide::Right).expect("measured");
    harness.get_by_label_contains("Worst point in patch").click();
    settle(&mut harness);
    assert_eq!(harness.state().deviation(SplitSide::Right), Some(adaptive), "LOD and clipping stay as they are");
    choose(&mut harness, "Surface", "Flat");
    let flat = harness.state().deviation(SplitSide::Right).expect("measured anew");
    assert!(flat > 1.2 * adaptive, "{flat} and {adaptive}");
}

#[test]
fn a_reference_surface_is_loaded_and_stays_if_the_next_one_fails() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSmooth)));
    press(&mut harness, egui::Key::V);
    assert!(harness.query_by_label("limit surface").is_some());
    assert!(harness.query_by_label("unknown").is_some(), "distances to a limit surface are sampled");
    let limit = harness.state().deviation(SplitSide::Right).expect("measured");
    let context = harness.ctx.clone();
    harness.state_mut().open_reference_shape(&context, Source::Shape(Shape::CubeSplit));
    settle(&mut harness);
    // The flat cube: the corners of the rounded one stay there, and its faces bulge.
    assert_eq!(harness.state().reference_shape(), Some(&Source::Shape(Shape::CubeSplit)));
    let bulge = harness.state().deviation(SplitSide::Right).expect("measured");
    assert!(bulge > 10.0 * limit && bulge < Vec3::ONE.length().into(), "{bulge} and {limit}");
    harness.state_mut().open_reference_shape(&context, Source::File("nowhere.glb".into()));
    settle(&mut harness);
    assert!(harness.query_by_label_contains("nowhere.glb").is_some(), "the error names the file");
    assert_eq!(harness.state().deviation(SplitSide::Right), Some(bulge), "the reference surface before it stays");
    click(&mut harness, "Close");
    click(&mut harness, "File");
    click(&mut harness, "Forget reference surface");
    assert_eq!((harness.state().reference_shape(), harness.state().deviation(SplitSide::Right)), (None, Some(limit)));
}

#[test]
fn a_mesh_is_compared_with_its_own_subdivision_limit() {
    let (folder, mut harness) = uniform_of("cube.obj", cube());
    choose(&mut harness, "Surface", "Flat");
    let context = harness.ctx.clone();
    let compare = "Compare with its subdivision limit";
    click(&mut harness, "File");
    click(&mut harness, compare);
    assert!(harness.state().has_own_limit() && harness.state().reference_shape().is_none());
    assert_eq!(harness.state().settings().overlays.colors, Colors::Deviation);
    assert!(
        harness.query_by_label("subdivision limit").is_some() && harness.query_by_label("Last refinement").is_some()
    );
    // A corner of the cage is twice as far from the middle as that of the limit.
    let corner = 0.75_f64.sqrt();
    let largest = harness.state().deviation(SplitSide::Right).expect("measured");
    assert!((largest - corner).abs() < 0.01, "{largest}");
    let command = copied(&mut harness);
    assert!(
        command.contains("--reference-subdivide catmull-clark") && !command.contains("--reference-surface"),
        "{command}"
    );
    harness.state_mut().undo(&context);
    settle(&mut harness);
    assert!(!harness.state().has_own_limit());
    harness.state_mut().redo(&context);
    settle(&mut harness);
    assert!(harness.state().has_own_limit());
    // Undo that reads the limit again leaves the colours.
    press(&mut harness, egui::Key::V);
    click(&mut harness, "File");
    click(&mut harness, "Forget reference surface");
    harness.state_mut().undo(&context);
    settle(&mut harness);
    assert!(harness.state().has_own_limit());
    assert_eq!(harness.state().settings().overlays.colors, Colors::Material);
    press(&mut harness, egui::Key::V);
    // The file is written anew, longer on one side.
    std::fs::write(folder.path().join("cube.obj"), cube().replace("v -1", "v -1.5")).expect("a writable folder");
    harness.state_mut().reload(&context);
    settle(&mut harness);
    let longer = harness.state().deviation(SplitSide::Right).expect("measured");
    assert!(longer > corner + 0.03, "{longer}");
    click(&mut harness, "File");
    click(&mut harness, "Forget reference surface");
    assert!(!harness.state().has_own_limit());
    // A shape and a glTF file have no polygons of their own.
    let why_not = |harness: &Harness<App>| {
        let availability = harness.state().availability();
        let command = all(&availability).into_iter().find(|command| command.name == compare).expect("a command");
        command.why_not(&availability)
    };
    assert_eq!(why_not(&harness), None);
    for source in [Source::Shape(Shape::Torus), vase()] {
        harness.state_mut().open(&context, source);
        settle(&mut harness);
        assert!(why_not(&harness).is_some_and(|why| why.contains("no polygons to subdivide")));
    }
}

#[test]
fn a_limit_that_is_read_while_the_mesh_is_prepared_anew_is_that_of_the_new_mesh() {
    // Reading its limit takes longer than preparing the cube.
    const SIDE: usize = 32;
    let points = (0..=SIDE).flat_map(|y| (0..=SIDE).map(move |x| format!("v {} {y} 0\n", 100 + x)));
    let faces = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| 9 + y * (SIDE + 1) + x));
    let faces = faces.map(|first| format!("f {first} {} {} {}\n", first + 1, first + SIDE + 2, first + SIDE + 1));
    let sheet: String = points.chain(faces).collect();
    let (_folder, mut harness) = uniform_of("parts.obj", format!("o cube\n{}o sheet\n{sheet}", cube()));
    choose(&mut harness, "Surface", "Flat");
    let context = harness.ctx.clone();
    let hide = |harness: &mut Harness<App>, part: &str| {
        harness.state_mut().prepare(&context, |own| own.parts.hidden = vec![part.to_owned()]);
    };
    hide(&mut harness, "cube");
    settle(&mut harness);
    let compare = Action::File(FileAction::CompareWithOwnLimit);
    let commands = all(&harness.state().availability());
    let compare = commands.iter().find(|command| command.action == compare).expect("a command");
    harness.state_mut().give(&context, compare);
    hide(&mut harness, "sheet");
    settle(&mut harness);
    assert!(harness.state().has_own_limit());
    assert_eq!(harness.state().settings().overlays.colors, Colors::Deviation);
    // The cube's own limit, and not that of the sheet, which is 100 units away.
    let largest = harness.state().deviation(SplitSide::Right).expect("measured");
    assert!((largest - 0.75_f64.sqrt()).abs() < 0.01, "{largest}");
}

/// The distance between the inscribed and the circumscribed sphere of an icosahedron, of radius 1.
const GAP: f64 = 0.205_345_5;

#[test]
fn both_halves_of_a_split_show_their_surface_and_deviation() {
    let mut harness = uniform(Some(Source::Shape(Shape::Icosahedron)));
    assert!(harness.query_by_role_and_label(Role::ComboBox, "Left").is_none(), "the view isn't split");
    let memory = |harness: &Harness<App>| {
        let label = harness.get_by_label_contains("MiB");
        let node = label.accesskit_node();
        node.value().or(node.label()).expect("a number")
    };
    let alone = memory(&harness);
    press(&mut harness, egui::Key::S);
    choose(&mut harness, "Left", "Flat");
    assert_eq!(harness.state().settings().left_surface(), Some(Surface::Flat));
    assert!(
        harness.query_by_label_contains("Left: Flat").is_some()
            && harness.query_by_label_contains("Right: PN-AEN").is_some()
    );
    assert_ne!(memory(&harness), alone, "the left half takes memory");
    press(&mut harness, egui::Key::V);
    let [flat, curved] = SplitSide::BOTH.map(|half| harness.state().deviation(half).expect("measured"));
    assert!((flat - GAP).abs() < 1e-6 && curved < 0.35 * GAP, "{flat} and {curved}");
    assert!(harness.query_by_label_contains("Left: Flat: 0.205 units").is_some());
    assert!(harness.query_by_label_contains("Right: PN-AEN: 0.06").is_some());
    harness.get_by_label_contains("Left Worst point in patch").click();
    settle(&mut harness);
    // The middle of a flat face is in the middle of the left half: a quarter of the view's width left of the target.
    let (camera, area) = (*harness.state().camera(), harness.get_by_role_and_label(Role::Image, "Viewport").rect());
    let quarter = camera.axes()[0] * (camera.units_per_pixel(area.height()) * area.width() / 4.0);
    let worst = (camera.target - quarter).length();
    assert!((f64::from(worst) - (1.0 - GAP)).abs() < 1e-4, "{worst}");
    let pictures = harness.state().pictures();
    harness.run_steps(20);
    assert_eq!(harness.state().pictures(), pictures, "nothing is drawn when nothing changed");
    choose(&mut harness, "Surface", "PN");
    assert_eq!(harness.state().deviation(SplitSide::Left), Some(flat), "the left half isn't measured again");
    open_list(&mut harness, "Left");
    // The statistics have a text "PN" as well, so the entry is looked up by its role.
    harness.get_by_role_and_label(Role::Button, "PN").click();
    settle(&mut harness);
    let [left, right] = SplitSide::BOTH.map(|half| harness.state().deviation(half).expect("measured"));
    assert_eq!(left, right, "the same surface");
    press(&mut harness, egui::Key::S);
    assert_eq!(harness.state().deviation(SplitSide::Left), None);
    assert_eq!(memory(&harness), alone, "the left half's memory is freed");
    assert!(harness.query_by_label_contains("Left: PN").is_none());
    press(&mut harness, egui::Key::S);
    assert_eq!(harness.state().deviation(SplitSide::Left), Some(right), "the left half is made again");
    choose(&mut harness, "Left", "Untessellated");
    assert!(harness.query_by_label_contains("Left: untessellated").is_some());
}

/// Counts pixels of the picture in the colour of cracks, left and right of its middle.
fn cracked(harness: &mut Harness<App>) -> [usize; 2] {
    // The last measurement is marked in the next picture.
    settle(harness);
    let area = harness.get_by_role_and_label(Role::Image, "Viewport").rect();
    let picture = harness.render().expect("a picture of the window");
    let mut count = [0; 2];
    for (x, y, pixel) in picture.enumerate_pixels() {
        let place = egui::pos2(x as f32, y as f32);
        let is_red = pixel.0[..3].iter().zip(CRACK_COLOR).all(|(shown, color)| shown.abs_diff(color) < 12);
        if is_red && area.contains(place) {
            count[usize::from(place.x > area.center().x)] += 1;
        }
    }
    count
}

#[test]
fn each_half_has_its_own_cracks_and_a_click_in_either_selects() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    press(&mut harness, egui::Key::S);
    choose(&mut harness, "Left", "PN");
    press(&mut harness, egui::Key::C);
    let [left, right] = cracked(&mut harness);
    assert!(left > 100 && right == 0, "{left} and {right} px: PN tears and PN-AEN doesn't");
    assert_eq!(
        harness.state().cracks().map(|cracks| cracks.edges.len()),
        Some(0),
        "statistics are about the right half"
    );
    press(&mut harness, egui::Key::C);
    assert_eq!(cracked(&mut harness), [0, 0]);
    for (offset, emitted) in [(-60.0, false), (60.0, true)] {
        let place = harness.get_by_role_and_label(Role::Image, "Viewport").rect().center() + egui::vec2(offset, 0.0);
        harness.hover_at(place);
        harness.drag_at(place);
        harness.run_steps(1);
        harness.drop_at(place);
        settle(&mut harness);
        let app = harness.state();
        assert!(app.selected_triangle().is_some() && app.selected_edge().is_some());
        assert_eq!(app.hit().is_some(), emitted, "{offset} points from the divider");
    }
    press(&mut harness, egui::Key::V);
    // This shape has no exact surface.
    assert!(harness.query_by_label("limit of PN-AEN").is_some());
    let against = |harness: &Harness<App>| harness.state().deviation(SplitSide::Left).expect("measured");
    let other = against(&harness);
    choose(&mut harness, "Surface", "Flat");
    assert!(harness.query_by_label("limit of Flat").is_some() && against(&harness) != other, "measured anew");
    choose(&mut harness, "Surface", "PN-AEN");
    assert_eq!(against(&harness), other);
    // Another mesh is shown in the same split.
    let context = harness.ctx.clone();
    harness.state_mut().open(&context, Source::Shape(Shape::Icosahedron));
    settle(&mut harness);
    let [left, right] = SplitSide::BOTH.map(|half| harness.state().deviation(half).expect("measured"));
    assert!((left - right).abs() < 1e-6 && left > 0.01, "{left} and {right}: no normals are split there");
}

#[test]
fn either_half_of_a_split_is_a_whole_tessellation_that_is_edited_and_exchanged() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    press(&mut harness, egui::Key::S);
    choose(&mut harness, "Left", "PN");
    let right = harness.state().settings().tessellation;
    click(&mut harness, "Edit left (A)");
    choose(&mut harness, "Partitioning", "Integer");
    harness.get_by_role_and_label(Role::Slider, "Factor").set_value_accesskit(3.0);
    settle(&mut harness);
    let left = harness.state().settings().left;
    assert_eq!((left.surface, left.partitioning, left.factor), (Surface::Pn, Partitioning::Integer, 3.0));
    assert_eq!(harness.state().settings().tessellation, right, "the right half stays as it was");
    // Both are counted, beside each other: 12 patches of 13 triangles on the left.
    harness.get_by_label("Left: PN\nFactor 3, Partitioning Integer\n156 triangles, 12 cracked edges");
    harness.get_by_label_contains("0 cracked edges");
    click(&mut harness, "Swap");
    assert_eq!(*harness.state().settings(), Settings { left: right, ..harness.state().settings().with(left) });
    harness.get_by_label_contains("Right: PN\nFactor 3");
    let command = copied(&mut harness);
    assert!(command.contains("--split-left surface=pn-aen,factor="), "{command}");
    assert_draws(&harness, &command, "cube-split-view");
    click(&mut harness, "Edit right (B)");
    assert_eq!(harness.get_by_role_and_label(Role::Slider, "Factor").accesskit_node().numeric_value(), Some(3.0));
}

#[test]
fn either_half_of_a_split_looks_as_its_own_settings_say() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    press(&mut harness, egui::Key::S);
    choose(&mut harness, "Left looks", "Its own");
    click(&mut harness, "Edit left (A)");
    choose(&mut harness, "Colours", "Zebra");
    let colors = |harness: &Harness<App>| {
        SplitSide::BOTH.map(|half| harness.state().settings().half(half).expect("it is split").overlays.colors)
    };
    assert_eq!(colors(&harness), [Colors::Zebra, Colors::Material]);
    harness.get_by_label_contains("Left: untessellated\nOverlays zebra");
    harness.get_by_label_contains("Right: PN-AEN\nOverlays none");
    let command = copied(&mut harness);
    assert!(command.contains(" --split-looks overlay=zebra"), "{command}");
    assert_draws(&harness, &command, "cube-split-view");
    click(&mut harness, "Swap");
    assert_eq!(colors(&harness), [Colors::Material, Colors::Zebra]);
    let context = harness.ctx.clone();
    harness.state_mut().undo(&context);
    settle(&mut harness);
    assert_eq!(colors(&harness), [Colors::Zebra, Colors::Material]);
    click(&mut harness, "Edit right (B)");
    choose(&mut harness, "Colours", "Clay");
    assert_eq!(colors(&harness), [Colors::Zebra, Colors::Clay]);
    // Keys, the toolbar and files follow the half that is edited.
    click(&mut harness, "Edit left (A)");
    harness.key_press_modifiers(egui::Modifiers::SHIFT, egui::Key::C);
    settle(&mut harness);
    assert_eq!(colors(&harness), [Colors::Clay, Colors::Clay]);
    let wireframes = |harness: &Harness<App>| {
        SplitSide::BOTH.map(|half| harness.state().settings().half(half).expect("it is split").overlays.wireframe)
    };
    let [left, right] = wireframes(&harness);
    press(&mut harness, egui::Key::W);
    assert_eq!(wireframes(&harness), [!left, right]);
    let toggled = harness.get_by_role_and_label(Role::CheckBox, "Wireframe").accesskit_node().toggled();
    assert_eq!(toggled == Some(egui::accesskit::Toggled::True), !left, "the toolbar shows the left half's");
    click(&mut harness, "Wireframe");
    assert_eq!(wireframes(&harness), [left, right]);
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    harness.key_press_modifiers(egui::Modifiers::SHIFT, egui::Key::C);
    settle(&mut harness);
    assert_eq!(colors(&harness), [Colors::Material, Colors::Clay]);
    let studio = harness.state().read_picture().expect("a device").expect("a picture");
    harness.state_mut().open_environment(&context, panorama(&folder, "sky.hdr"));
    settle(&mut harness);
    let lighting = |half| harness.state().settings().half(half).expect("it is split").lighting;
    assert_eq!(lighting(SplitSide::Left), Lighting::Environment);
    assert_ne!(lighting(SplitSide::Right), Lighting::Environment);
    let lit = harness.state().read_picture().expect("a device").expect("a picture");
    assert_ne!(lit, studio, "the light of the file is seen on the left");
}

#[test]
fn halves_side_by_side_show_the_same_place_in_their_middles_and_are_framed_in_half_the_width() {
    let mut harness = uniform(Some(Source::Shape(Shape::Icosahedron)));
    press(&mut harness, egui::Key::F);
    let whole = harness.state().camera().distance;
    press(&mut harness, egui::Key::S);
    choose(&mut harness, "Shown as", "Side by side");
    let camera = *harness.state().camera();
    assert!(camera.distance >= whole, "{} and {whole}: all of it is seen in half the width", camera.distance);
    let picture = harness.get_by_role_and_label(Role::Image, "Viewport").rect();
    let picked = [0.25, 0.75].map(|across| {
        let place = picture.lerp_inside(egui::vec2(across, 0.55));
        harness.hover_at(place);
        harness.drag_at(place);
        harness.run_steps(1);
        harness.drop_at(place);
        settle(&mut harness);
        harness.state().selected_triangle()
    });
    assert!(picked[0].is_some() && picked[0] == picked[1], "{picked:?}");
    choose(&mut harness, "Shown as", "Difference");
    assert!(harness.query_by_role_and_label(Role::Slider, "Split divider").is_none());
    harness.get_by_label_contains("Left: untessellated");
    choose(&mut harness, "Shown as", "Divider");
    harness.get_by_role_and_label(Role::Slider, "Split divider");
}
