//! The picture of a case: every method side by side, or the chart of a sweep.

use std::sync::Arc;

use glam::Vec2;
use image::{DynamicImage, RgbImage};

use super::sweep_chart::sweep_chart;
use super::{Method, Probe, Subject, views};
use geometry::mesh::{Moment, Topology, t_junctions};
use geometry::progress::Progress;
use geometry::tessellate::{LodView, Partitioning, Surface};
use gpu::{GpuError, Timing};
use inspect::engine::Engine;
use inspect::measure::{SWEEP_STEP, sweep};
use inspect::plot::contact_sheet;
use inspect::render::{LineSegment, Target, crack_lines, t_junction_lines};
use inspect::settings::{ARENA_BYTES, Overlays, Settings};
use inspect::shot::ShotError;

/// The width and height of each method's picture, in px.
const PART: [u32; 2] = [300, 240];
/// Half the width of cracks' lines, in px: in so small a picture they only say where cracks are.
const CRACK_HALF_WIDTH: f32 = 2.0;
/// The pictures in a row.
const COLUMNS: u32 = 3;
/// The height of captions in px.
const TEXT: u32 = 18;

/// Draws the methods in rows of three, each under its name: 916 by 808 px. For a sweep, draws the chart of PN-AEN, with
/// factors up to `sweep_to`: 960 by 600 px.
pub fn picture(case: &Subject, engine: &Engine, sweep_to: f32) -> Result<RgbImage, ShotError> {
    if case.probe == Probe::Sweep {
        return chart(case, sweep_to);
    }
    let names: Vec<_> = Method::all().into_iter().map(|method| method.name().to_owned()).collect();
    let parts: Vec<_> = names.into_iter().zip(parts(case, engine)?).collect();
    Ok(contact_sheet(&parts, COLUMNS, TEXT)?)
}

fn parts(case: &Subject, engine: &Engine) -> Result<Vec<RgbImage>, GpuError> {
    let mesh = Arc::new(case.mesh.clone());
    // Nobody else holds these handles, so nobody can cancel.
    let topology = Arc::new(Topology::build_within(&mesh, case.weld, &Progress::new()).unwrap_or_default());
    let junctions = t_junctions(&topology, &Progress::new()).unwrap_or_default();
    let mut scene = engine.scene_of(mesh, topology.clone(), ARENA_BYTES)?;
    if let Some(rig) = &case.mesh.rig {
        // At this time of its first clip the mesh is well out of its rest pose.
        let time = rig.clips.first().map_or(0.0, |clip| 0.4 * clip.duration);
        scene.tessellator.set_pose(Some(Arc::new(rig.pose(Moment { clip: 0, time }))))?;
    }
    let target = Target::new(&engine.gpu, PART)?;
    let viewport = Vec2::from(PART.map(|side| side as f32));
    let camera = views::camera(&scene.bounds, &case.view, viewport);
    let overlays = Overlays { wireframe: true, cracks: true, folds: true, t_junctions: true, ..Overlays::default() };
    let part = |method: Method| {
        let settings = if case.probe == Probe::View {
            method.adaptive(Partitioning::FractionalOdd, 8.0)
        } else {
            method.settings(Partitioning::FractionalOdd, case.view.factor)
        };
        let settings = Settings { overlays, ..method.displacing(&case.mesh, settings) };
        let inputs = settings.inputs(camera.lod_view(viewport, &scene.bounds));
        engine.count(&mut scene, &inputs, &mut Timing::Off)?;
        let (_, posed) = scene.tessellator.posed().deformed();
        let cracks = crack_lines(&engine.measure(&mut scene)?, &posed).into_iter();
        let mut lines: Vec<_> = cracks.map(|line| LineSegment { half_width: CRACK_HALF_WIDTH, ..line }).collect();
        lines.extend(t_junction_lines(&topology, &junctions));
        scene.set_lines(&engine.gpu, &lines);
        engine.draw(&mut scene, &target, &camera, &settings, &mut Timing::Off)?;
        Ok(DynamicImage::from(target.read(&engine.gpu)?).to_rgb8())
    };
    Method::all().into_iter().map(part).collect()
}

fn chart(case: &Subject, sweep_to: f32) -> Result<RgbImage, ShotError> {
    let topology = Topology::build_within(&case.mesh, case.weld, &Progress::new()).unwrap_or_default();
    let view = LodView::new(glam::Mat4::IDENTITY, Vec2::ONE);
    let swept = Partitioning::ALL.map(|partitioning| {
        let inputs = Method::Surface(Surface::PnAen).settings(partitioning, 1.0).inputs(view);
        sweep(&case.mesh, &topology, &inputs, 1.0..=sweep_to, SWEEP_STEP)
    });
    Ok(sweep_chart(&swept, case.mesh.bounds().diagonal().into(), [960, 600])?)
}
