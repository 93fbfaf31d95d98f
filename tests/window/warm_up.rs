//! The preview that is drawn out of sight, so that the first drag doesn't wait for the driver's compiler.

use std::time::{Duration, Instant};

use egui_kittest::Harness;
use geometry::mesh::Shape;
use inspect::settings::Colors;
use load::Source;
use pnaen::app::App;

use crate::{PATIENCE, choose, open_alone, settle, vase};

/// A window whose pipelines nothing else makes.
fn start(source: Source) -> Harness<'static, App> {
    let mut harness = open_alone(Harness::builder().with_size([1600.0, 1000.0]), Some(source));
    settle(&mut harness);
    harness
}

/// Runs frames for so long while nothing is done, and until no preview is being drawn out of sight.
pub(super) fn wait(harness: &mut Harness<App>, time: Duration) {
    let start = Instant::now();
    while start.elapsed() < time || harness.state().is_warming_up() {
        assert!(start.elapsed() < PATIENCE, "a preview is still being drawn");
        std::thread::sleep(Duration::from_millis(5));
        harness.step();
    }
}

/// Runs frames until this many previews were drawn out of sight.
fn wait_for(harness: &mut Harness<App>, warm_ups: u64) {
    let start = Instant::now();
    while harness.state().warm_ups() < warm_ups {
        assert!(start.elapsed() < PATIENCE, "no preview is drawn out of sight");
        wait(harness, Duration::from_millis(50));
    }
    wait(harness, Duration::ZERO);
}

fn made(harness: &Harness<App>) -> u64 {
    harness.state().engine().gpu.made_when_needed()
}

/// Drags over the middle of the view until previews are shown.
fn drag(harness: &mut Harness<App>) {
    let (start, before) = (Instant::now(), harness.state().previews());
    let at = |frame: u32| egui::pos2(700.0 + 4.0 * (frame % 40) as f32, 500.0);
    harness.drag_at(at(0));
    harness.step();
    for frame in 1.. {
        harness.hover_at(at(frame));
        harness.step();
        if frame > 10 && harness.state().previews() > before + 1 {
            break;
        }
        assert!(start.elapsed() < PATIENCE, "no preview is shown");
    }
    harness.drop_at(at(0));
}

#[test]
fn a_drag_after_a_pause_builds_no_pipeline() {
    for source in [vase(), Source::Shape(Shape::Torus)] {
        let mut harness = start(source);
        let pictures = harness.state().pictures();
        wait_for(&mut harness, 1);
        let before = made(&harness);
        drag(&mut harness);
        assert!(harness.state().previews() > 0);
        assert_eq!(made(&harness), before, "all that a preview needs is there");
        assert_eq!((harness.state().pictures(), harness.state().warm_ups()), (pictures, 1));
    }
}

#[test]
fn a_preview_is_drawn_out_of_sight_once_for_the_same_pipelines() {
    let mut harness = start(vase());
    wait_for(&mut harness, 1);
    let (pictures, previews, totals) =
        (harness.state().pictures(), harness.state().previews(), harness.state().totals());
    let picture = harness.state().read_picture().expect("a device");
    wait(&mut harness, Duration::from_millis(800));
    assert_eq!(harness.state().warm_ups(), 1, "nothing is drawn when nothing changed");
    assert_eq!((harness.state().pictures(), harness.state().previews()), (pictures, previews));
    assert_eq!(harness.state().totals(), totals, "the picture's own triangles stay");
    assert!(harness.state().read_picture().expect("a device") == picture);
    // Other shaders are drawn with once, and those from before aren't again.
    let light = harness.state().settings().lighting;
    choose(&mut harness, "Colours", "Clay");
    wait(&mut harness, Duration::from_millis(800));
    let both = harness.state().warm_ups();
    assert!(both <= 2, "{both}");
    choose(&mut harness, "Colours", "Material");
    assert_eq!(
        (harness.state().settings().overlays.colors, harness.state().settings().lighting),
        (Colors::Material, light)
    );
    wait(&mut harness, Duration::from_millis(800));
    settle(&mut harness);
    assert_eq!(harness.state().warm_ups(), both);
}
