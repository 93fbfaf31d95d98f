//! Passes that go over the part of a picture where layers are, against those that go over all of it.

use std::sync::Arc;

use geometry::mesh::{Alpha, Heights, Mesh, Moment};
use geometry::tessellate::{Displacement, Surface, Tessellation};
use gpu::Timing;
use inspect::engine::Engine;
use inspect::render::{Camera, Renderer, Target};
use inspect::settings::{Overlays, Settings, ToneCurve};

use super::{ball_in_ball, blended_ball};
use crate::displacement::waves;
use crate::materials::of_picture;
use crate::stability::scene_of;
use crate::{deforming, engine};

/// An engine on the same device whose passes over layers go over whole pictures.
fn peeling_everywhere() -> Engine {
    let mut renderer = Renderer::new(&engine().gpu);
    renderer.peels_everywhere = true;
    let mut engine = engine().clone();
    engine.renderer = Arc::new(renderer);
    engine
}

/// Cameras that see all of a scene, a part of it, nothing, and its middle from within.
fn cameras(scene: &inspect::render::Scene, target: &Target) -> [Camera; 6] {
    let framed = Camera { azimuth: 20.0, elevation: 15.0, ..Camera::framing(&scene.bounds, target.viewport()) };
    let beside = |by: f32| framed.target + framed.axes()[0] * (by * scene.bounds.radius());
    [
        framed,
        Camera { distance: 0.4 * framed.distance, target: beside(1.2), ..framed },
        Camera { target: beside(9.0), ..framed },
        Camera { target: framed.target + framed.axes()[2] * (9.0 * scene.bounds.radius()), ..framed },
        Camera { distance: 0.05 * framed.distance, ..framed },
        Camera { orthographic: true, target: beside(-1.0), ..framed },
    ]
}

/// Checks that pictures are the same whether or not passes go over all of them.
fn assert_same_everywhere(scene: &mut inspect::render::Scene, everywhere: &Engine, settings: &Settings, what: &str) {
    let target = Target::new(&engine().gpu, [120, 90]).expect("a small picture");
    for camera in cameras(scene, &target) {
        let [part, whole] = [engine(), everywhere].map(|engine| {
            engine.draw(scene, &target, &camera, settings, &mut Timing::Off).expect("a draw");
            target.read(&engine.gpu).expect("a readback")
        });
        assert!(part == whole, "{what}, {settings:?}, {camera:?}");
    }
}

#[test]
fn passes_over_a_part_of_a_picture_find_all_layers() {
    let everywhere = peeling_everywhere();
    let settings = of_picture(ToneCurve::Neutral);
    let mut mesh = ball_in_ball(blended_ball());
    mesh.heights = Some(Arc::new(Heights::everywhere(&mesh, waves(16))));
    let mut scene = scene_of(mesh, 0.0);
    for surface in Surface::ALL {
        for displacement in [Displacement::Off, Displacement::On] {
            let own = Tessellation { surface, displacement, factor: 3.0, height_scale: 0.4, ..settings.tessellation };
            assert_same_everywhere(&mut scene, &everywhere, &settings.with(own), "ball");
        }
    }
    let flat = Settings { split: Some(0.4), ..settings };
    let wires = Overlays { wireframe: true, ..Overlays::default() };
    for split in [flat, Settings { overlays: wires, ..flat }] {
        assert_same_everywhere(&mut scene, &everywhere, &split, "beside the mesh without tessellation");
    }
}

#[test]
fn passes_over_a_part_of_a_picture_find_the_layers_of_every_pose() {
    let everywhere = peeling_everywhere();
    let (loaded, _) = deforming::scene();
    let mut mesh = Mesh::clone(&loaded.mesh);
    mesh.materials.iter_mut().for_each(|own| own.look.alpha = Alpha::Blend);
    mesh.materials.iter_mut().for_each(|own| own.base_color[3] = 0.5);
    let clips: Vec<_> = mesh.rig.as_ref().expect("a rig").clips.iter().map(|clip| clip.duration).collect();
    let mut scene = engine().scene_of(Arc::new(mesh), loaded.topology.clone(), 8 << 20).expect("a small mesh");
    for (clip, duration) in clips.into_iter().enumerate() {
        for part in [0.0, 0.3, 0.9] {
            let moment = Moment { clip, time: duration * part };
            scene.set_moment(Some(moment)).expect("a small rig");
            let settings = of_picture(ToneCurve::Neutral);
            let settings = settings.with(Tessellation { factor: 3.0, ..settings.tessellation });
            assert_same_everywhere(&mut scene, &everywhere, &settings, &format!("{moment:?}"));
        }
    }
}
