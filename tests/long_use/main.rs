//! Uses one window for long: loads many meshes, changes many settings and sizes. Its memory must level off, nothing may go wrong,
//! and it must show the same picture as a new window. This test is a program of its own, so that no other memory is counted.
//!
//! With `PNAEN_LONG_USE=FOLDER` there are 500 meshes, 2,000 settings and 100 sizes, and the memory is written to that folder, as
//! a table and as a picture.

#[path = "../counting/mod.rs"]
mod counting;
#[path = "../window/driver.rs"]
mod driver;
mod figures;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{AccessKitNode, By, NodeT, Queryable};
use fastrand::Rng;
use geometry::mesh::Topology;
use geometry::mesh::shapes::Shape;
use geometry::tessellate::Tessellation;
use glam::Vec3;
use image::RgbaImage;
use inspect::render::LineSegment;
use inspect::settings::{Choice, Colors, Lighting, NormalsAt, Overlays, Settings};
use load::Limits;
use load::source::Source;
use pnaen::app::App;
use pnaen::app::persistence::Persistence;
use pnaen::commands::{Action, all};

use driver::settle;
use figures::Part;

/// Width and height of the window, in points.
const SIZE: [f32; 2] = [1000.0, 700.0];
/// Controls that belong to the mesh or the moment. A new window has their defaults.
const NOT_KEPT: [&str; 3] = ["Freeze LOD camera", "Weld", "Height map"];

/// The number of steps of each part, and after how many of them the window is compared with a new one.
struct Effort {
    loads: usize,
    settings: usize,
    sizes: usize,
    compared: usize,
}

/// Writes a file into a folder.
fn file(folder: &Path, name: &str, bytes: &[u8]) -> Source {
    let path = folder.join(name);
    std::fs::write(&path, bytes).expect("a writable temporary folder");
    Source::File(path)
}

fn window(kept: &Path, source: Option<Source>, [width, height]: [f32; 2]) -> Harness<'static, App> {
    let kept = kept.to_owned();
    let mut harness = Harness::builder().with_size([width, height]).wgpu().build_eframe(move |context| {
        let mut app = App::new(context, source, Limits::default()).expect("these tests need a graphics adapter");
        app.resume(&context.egui_ctx, Persistence::read(Some(&kept)));
        app
    });
    settle(&mut harness);
    harness
}

fn picture(harness: &Harness<App>) -> RgbaImage {
    harness.state().read_picture().expect("a readback").expect("a picture")
}

/// Checks that the window shows the same picture as a new window of the same size with the same settings and mesh, both with the
/// whole mesh in view.
fn shows_what_a_new_window_does(harness: &mut Harness<App>, kept: &Path, size: [f32; 2]) {
    eframe::App::on_exit(harness.state_mut());
    let source = harness.state().source().cloned();
    let mut fresh = window(kept, source.clone(), size);
    for window in [&mut *harness, &mut fresh] {
        window.key_press(egui::Key::F);
        settle(window);
    }
    assert_eq!(fresh.state().settings(), harness.state().settings());
    let is_same = picture(&fresh) == picture(harness);
    assert!(is_same, "{source:?} with {:?}", harness.state().settings());
}

fn loads(harness: &mut Harness<App>, folder: &Path, effort: &Effort) -> Part {
    let vase = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/vase.glb")).expect("it is there");
    let sources = [
        file(folder, "vase.glb", &vase),
        Source::Shape(Shape::Torus),
        file(folder, "cut.glb", &vase[..vase.len() / 2]),
        file(folder, "square.obj", b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"),
        Source::Shape(Shape::Icosphere),
        Source::File(folder.join("nowhere.ply")),
        Source::Shape(Shape::Bicubic),
    ];
    let mut part = Part { what: "loads", taken: Vec::new() };
    let context = harness.ctx.clone();
    for step in 0..effort.loads {
        let source = &sources[step % sources.len()];
        harness.state_mut().open(&context, source.clone());
        settle(harness);
        let refused =
            harness.query_by_label_contains(&source.title()).is_some_and(|_| harness.state().source() != Some(source));
        assert!(harness.state().source() == Some(source) || refused, "{source:?}");
        if step % effort.compared == effort.compared - 1 {
            shows_what_a_new_window_does(harness, folder, SIZE);
        }
        part.taken.push(figures::now(harness.state()));
    }
    part
}

/// How many settings are changed before all are reset.
const CHANGES: usize = 3;

/// The keys of overlays that are in a list, not among the controls.
const OVERLAY_KEYS: [egui::Key; 7] = {
    use egui::Key::{A, K, N, O, P, T, Y};
    [P, A, O, T, K, N, Y]
};

/// All controls that can be used now.
fn controls(harness: &Harness<App>) -> Vec<(Role, String)> {
    let kinds = [Role::CheckBox, Role::ComboBox, Role::Slider];
    let usable = By::new().predicate(|node| kinds.contains(&node.role()) && !node.is_disabled());
    let named = harness.query_all(usable).filter_map(|node| {
        let node = node.accesskit_node();
        Some((node.role(), node.label()?))
    });
    named.filter(|(_, name)| !NOT_KEPT.contains(&name.as_str())).collect()
}

/// Changes a random control to a random value.
fn change(harness: &mut Harness<App>, random: &mut Rng) {
    let all = controls(harness);
    let chosen = random.usize(..all.len() + OVERLAY_KEYS.len());
    let Some((role, name)) = all.get(chosen) else {
        harness.key_press(OVERLAY_KEYS[chosen - all.len()]);
        return settle(harness);
    };
    // A list opens only where it is in sight, and not all rows fit the window.
    harness.get_by_role_and_label(*role, name).scroll_to_me();
    settle(harness);
    let control = harness.get_by_role_and_label(*role, name);
    match role {
        Role::Slider => {
            let node = control.accesskit_node();
            let range = node.min_numeric_value().zip(node.max_numeric_value());
            let (least, most) = range.expect("a slider has ends");
            control.set_value_accesskit(least + (most - least) * (f64::from(random.u32(0..1001)) / 1000.0));
        }
        Role::ComboBox => {
            control.click();
            settle(harness);
            let in_list = |node: &AccessKitNode| {
                let mut above = std::iter::successors(node.parent(), AccessKitNode::parent);
                node.role() == Role::Button && above.any(|node| node.role() == Role::ListBox)
            };
            let entries: Vec<_> = harness.query_all(By::new().predicate(in_list)).collect();
            entries[random.usize(..entries.len())].click();
        }
        _ => control.click(),
    }
    settle(harness);
}

/// Settings for all pipelines that pictures of one mesh can need.
fn settings_for_pipelines() -> impl Iterator<Item = Settings> {
    let of_colors = |&colors| {
        [[false, false], [true, false], [false, true]].map(|[wireframe, patches]| Overlays {
            colors,
            wireframe,
            patches,
            normals: true,
            grid: true,
            ..Overlays::default()
        })
    };
    let overlays = Colors::ALL.iter().flat_map(of_colors);
    let lit = overlays.flat_map(|overlays| Lighting::ALL.map(|lighting| (overlays, lighting)));
    let culled = lit.flat_map(|lit| [false, true].map(|cull_back_faces| (lit, cull_back_faces)));
    culled.flat_map(|((overlays, lighting), cull_back_faces)| {
        let tessellation = Tessellation { cull_back_faces, ..Settings::usual().tessellation };
        NormalsAt::ALL.map(|normals_at| Settings {
            tessellation,
            overlays,
            lighting,
            normals_at,
            environment_background: true,
            ..Settings::usual()
        })
    })
}

/// Makes all pipelines that the settings can need, so that their memory doesn't count as growth. They are made when they are
/// first needed, and are kept.
fn need_every_pipeline(harness: &mut Harness<App>) {
    let engine = harness.state().engine();
    let mesh = Arc::new(Shape::CubeSplit.build());
    let topology = Arc::new(Topology::new(&mesh));
    let mut scene = engine.scene_of(mesh, topology, 1 << 20).expect("a small mesh");
    scene.set_lines(&engine.gpu, &[LineSegment::new(Vec3::ZERO, Vec3::X, [0; 3])]);
    settings_for_pipelines().for_each(|settings| engine.renderer.prepare(&scene, &settings).expect("pipelines"));
    for normals in ["Quadratic normals", "Surface normals", "Linear normals"] {
        harness.get_by_role_and_label(Role::ComboBox, "Shading").click();
        settle(harness);
        harness.query_all_by_label(normals).last().expect("an entry of the list").click();
        settle(harness);
    }
}

fn settings(harness: &mut Harness<App>, folder: &Path, effort: &Effort) -> Part {
    let context = harness.ctx.clone();
    harness.state_mut().open(&context, Source::Shape(Shape::CubeSplit));
    settle(harness);
    for section in ["Displacement", "Look", "Advanced"] {
        harness.get_by_role_and_label(Role::DisclosureTriangle, section).click();
        settle(harness);
    }
    need_every_pipeline(harness);
    let (mut part, mut random) = (Part { what: "settings", taken: Vec::new() }, Rng::with_seed(5));
    let all = all(&harness.state().availability());
    let reset = all.iter().find(|command| command.action == Action::ResetSettings).expect("a command");
    for step in 0..effort.settings {
        change(harness, &mut random);
        if step % effort.compared == effort.compared - 1 {
            shows_what_a_new_window_does(harness, folder, SIZE);
        }
        // What some settings need is theirs: memory is compared with the same settings.
        if step % CHANGES == CHANGES - 1 {
            harness.state_mut().give(&context, reset);
            settle(harness);
            part.taken.push(figures::now(harness.state()));
        }
    }
    part
}

fn sizes(harness: &mut Harness<App>, folder: &Path, effort: &Effort) -> Part {
    let mut part = Part { what: "sizes", taken: Vec::new() };
    for step in 0..effort.sizes {
        // The same ten sizes again and again, large and small in turn.
        let size = [760 + 97 * (step % 10), 480 + 61 * (3 * step % 10)].map(|side| side as f32);
        harness.set_size(size.into());
        settle(harness);
        if step % effort.compared == effort.compared - 1 {
            shows_what_a_new_window_does(harness, folder, size);
        }
        part.taken.push(figures::now(harness.state()));
    }
    part
}

#[test]
fn memory_of_a_window_used_for_long_levels_off_and_its_picture_stays_right() {
    let written = std::env::var_os("PNAEN_LONG_USE").map(PathBuf::from);
    let effort = match written {
        Some(_) => Effort { loads: 500, settings: 2000, sizes: 100, compared: 50 },
        None => Effort { loads: 50, settings: 60, sizes: 20, compared: 20 },
    };
    let temporary = tempfile::tempdir().expect("a writable temporary folder");
    let folder = temporary.path();
    let mut harness = window(folder, None, SIZE);
    let parts = [
        loads(&mut harness, folder, &effort),
        settings(&mut harness, folder, &effort),
        sizes(&mut harness, folder, &effort),
    ];
    if let Some(written) = &written {
        figures::write(written, &parts);
    }
    parts.iter().for_each(Part::levels_off);
}
