//! Undo of everything that can be set or opened: afterwards all is as before, and after redo as it was then.

use std::path::{Path, PathBuf};

use egui_kittest::Harness;
use geometry::mesh::Shape;
use inspect::engine::Preparation;
use inspect::settings::Settings;
use load::{HeightSource, Source};
use pnaen::app::App;
use pnaen::commands::{Action, Change, FileAction, all};
use tempfile::TempDir;

use crate::environment::panorama;
use crate::lod_shader::write as write_lod;
use crate::{run_command, settle, uniform, uniform_of, vase};
use documents::lamp::LAMP;

/// All that undo brings back.
fn state(app: &App) -> (Settings, Preparation, Option<Source>, [Option<PathBuf>; 5]) {
    let files = [
        app.environment_file(),
        app.matcap_image(),
        app.factors_file(),
        app.lod_shader_file(),
        app.surface_shader_file(),
    ];
    let preparation = app.loaded().expect("a mesh").preparation.clone();
    (*app.settings(), preparation, app.reference_shape().cloned(), files.map(|file| file.map(Path::to_owned)))
}

/// Makes a change, undoes it and redoes it, and lets the window take each.
fn change_with(
    harness: &mut Harness<App>,
    what: &str,
    take: fn(&mut Harness<App>),
    change: impl FnOnce(&mut App, &egui::Context),
) {
    let before = state(harness.state());
    let context = harness.ctx.clone();
    change(harness.state_mut(), &context);
    take(harness);
    let after = state(harness.state());
    if after == before {
        return;
    }
    harness.state_mut().undo(&context);
    take(harness);
    assert_eq!(state(harness.state()), before, "{what} is undone");
    harness.state_mut().redo(&context);
    take(harness);
    assert_eq!(state(harness.state()), after, "{what} is redone");
}

fn change(harness: &mut Harness<App>, what: &str, change: impl FnOnce(&mut App, &egui::Context)) {
    change_with(harness, what, settle, change);
}

#[test]
fn every_command_for_a_setting_is_undone_and_redone() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    let is_setting =
        |action: &Action| matches!(action, Action::Setting(_) | Action::Prepare(_) | Action::ResetSettings);
    let mut count = 0;
    for command in all(&harness.state().availability()).into_iter().filter(|command| is_setting(&command.action)) {
        // Settings are there at once; only what loads the mesh again takes a while.
        let loads = matches!(command.action, Action::Prepare(_) | Action::Setting(Change::Option("mesh-normals", _)));
        let take: fn(&mut Harness<App>) = if loads { settle } else { |harness| harness.run_steps(3) };
        change_with(&mut harness, &command.name, take, |app, context| app.give(context, &command));
        count += 1;
    }
    assert!(count > 60, "only {count} commands");
}

fn heights(folder: &TempDir, name: &str) -> PathBuf {
    let path = folder.path().join(name);
    let image = image::GrayImage::from_fn(16, 16, |x, y| image::Luma([(x * 13 + y * 7) as u8]));
    image.save(&path).expect("a writable temporary folder");
    path
}

#[test]
fn every_file_beside_the_mesh_is_undone_and_redone() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = uniform(Some(vase()));
    let (bumps, ball, sky) =
        (heights(&folder, "bumps.png"), heights(&folder, "ball.png"), panorama(&folder, "sky.hdr"));
    let factors = folder.path().join("factors.csv");
    let Source::File(mesh) = vase() else { unreachable!("it is a file") };
    run_command(["factors", mesh.to_str().expect("UTF-8"), "--lod", "uniform", "--factor", "3"], &factors);
    let [lod, surface] = ["lod.wgsl", "surface.wgsl"].map(|name| folder.path().join(name));
    write_lod(&lod, "5.0");
    std::fs::write(&surface, include_str!("../../assets/surface/pn.wgsl")).expect("a writable temporary folder");
    let images = [Some(HeightSource::File(bumps)), Some(HeightSource::Materials), None];
    for image in images {
        change(&mut harness, &format!("{image:?}"), |app, context| app.displace(context, image));
    }
    change(&mut harness, "the environment", |app, context| app.open_environment(context, sky));
    change(&mut harness, "the matcap", |app, context| app.open_matcap(context, ball));
    change(&mut harness, "the reference", |app, context| {
        app.open_reference_shape(context, Source::Shape(Shape::CubeSplit))
    });
    change(&mut harness, "the factors", |app, context| app.open_factors(context, factors));
    change(&mut harness, "the LOD shader", |app, context| app.open_lod_shader(context, lod));
    change(&mut harness, "the surface shader", |app, context| app.open_surface_shader(context, surface));
    let closing = |action: &Action| matches!(action, Action::File(FileAction::Close(_)));
    let mut closed = Vec::new();
    for command in all(&harness.state().availability()).into_iter().filter(|command| closing(&command.action)) {
        change(&mut harness, &command.name, |app, context| app.give(context, &command));
        closed.push(format!("{:?}", command.action));
    }
    assert!(closed.len() >= 4, "{closed:?}");
    let (.., reference_shape, files) = state(harness.state());
    assert_eq!(
        (reference_shape, files.iter().flatten().count()),
        (None, 1),
        "but for the matcap, all are closed: {files:?}"
    );
}

#[test]
fn every_way_to_prepare_the_mesh_is_undone_and_redone() {
    let (folder, mut harness) = uniform_of("lamp.gltf", LAMP);
    change(&mut harness, "weld", |app, context| app.prepare(context, |own| own.weld = 1e-3));
    change(&mut harness, "the crease band", |app, context| app.prepare(context, |own| own.crease_band = 0.02));
    change(&mut harness, "the variant", |app, context| app.prepare(context, |own| own.variant = Some("Night".into())));
    let heights = heights(&folder, "bumps.png");
    change(&mut harness, "the heights", |app, context| app.displace(context, Some(HeightSource::File(heights))));
    // What is taken back while it is read never was.
    let before = state(harness.state());
    let context = harness.ctx.clone();
    harness.state_mut().displace(&context, None);
    harness.state_mut().undo(&context);
    settle(&mut harness);
    assert_eq!(state(harness.state()), before);
}

#[test]
fn what_is_set_while_undo_reads_files_again_stays_and_is_a_step() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut harness = uniform(Some(vase()));
    let context = harness.ctx.clone();
    harness.state_mut().open_matcap(&context, heights(&folder, "ball.png"));
    settle(&mut harness);
    let opened = state(harness.state());
    harness.state_mut().undo(&context);
    settle(&mut harness);
    harness.state_mut().redo(&context);
    let command = all(&harness.state().availability()).into_iter().find(|command| command.name == "Overlay: Cracks");
    harness.state_mut().give(&context, &command.expect("a command"));
    assert!(harness.state().matcap_image().is_none(), "it is being read");
    settle(&mut harness);
    let set = state(harness.state());
    assert!(set.0.overlays.cracks != opened.0.overlays.cracks);
    assert_eq!((set.0.overlays.colors, &set.3), (opened.0.overlays.colors, &opened.3));
    harness.state_mut().undo(&context);
    settle(&mut harness);
    assert_eq!(state(harness.state()), opened);
    harness.state_mut().redo(&context);
    settle(&mut harness);
    assert_eq!(state(harness.state()), set);
}
