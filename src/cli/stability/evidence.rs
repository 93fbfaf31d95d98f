//! The pictures of `--evidence`: the worst place of each gate that failed, in the tessellation in which it was found.

use std::sync::Arc;

use super::file_name;
use crate::cli::CliError;
use crate::cli::gate_options::GateOptions;
use geometry::mesh::Topology;
use geometry::progress::Progress;
use inspect::engine::{Engine, Loaded};
use inspect::gates::{Gate, Limit};
use inspect::settings::ARENA_BYTES;
use inspect::shot::{Shot, ShotView, Subject as ShotSubject};
use lab::stability::{Failure, Subject, Tried, viewport};

/// A px of the run is this many px wide here. The middle of its middle px is its own middle, so that what leaked there leaks here.
const ENLARGED: u32 = 3;

/// Draws the worst place of each gate that failed.
pub(super) fn write(gates: &GateOptions, engine: &Engine, all: &[Subject], failed: &[Failure]) -> Result<(), CliError> {
    for failure in failed {
        let Some(own) = all.iter().find(|own| own.name == failure.case) else { continue };
        let tried = failure.tried.unwrap_or_else(|| Tried::from_mesh(own));
        let mut shot = shot(engine, own, tried)?;
        // The sentence has the numbers of the run; here only the place counts, which is the worst for any limit.
        let gate = Gate { kind: failure.kind, limit: Limit::Count(0) };
        let tolerance = tried.settings.tessellation.tolerance;
        let judged = shot.judge(&[gate], tolerance, &Progress::new())?;
        gates.write_evidence(&mut shot, &judged, file_name(&own.name).as_ref())?;
    }
    Ok(())
}

/// What was tried, to be drawn.
fn shot(engine: &Engine, subject: &Subject, tried: Tried) -> Result<Shot, CliError> {
    let Subject { mesh, weld, warnings, .. } = subject;
    let mesh = Arc::new(mesh.clone());
    let topology = Arc::new(Topology::build_within(&mesh, *weld, &Progress::new())?);
    let loaded = Loaded { warnings: warnings.clone(), ..Loaded::from_mesh(mesh, topology) };
    let Tried { settings, camera, moment } = tried;
    let shown = ShotSubject { moment, ..ShotSubject::new(loaded, settings) };
    let mut scene = engine.scene(&shown.loaded, ARENA_BYTES)?;
    shown.apply_to_scene(engine, &mut scene)?;
    let size = viewport().to_array().map(|side| side as u32 * ENLARGED);
    let lod_camera = Some((camera, viewport()));
    let view = ShotView { camera, lod_camera, size, transparent: false, legend: false };
    Ok(Shot::new(engine.clone(), scene, shown, view)?)
}
