//! Materials with shaders of their own look as with the one that all share.

use std::sync::Arc;

use geometry::mesh::{Alpha, Look, Material, Shape};
use gpu::Timing;
use inspect::engine::Engine;
use inspect::render::{Camera, Renderer, Target};

use crate::engine;
use crate::materials::{every_way, studio};
use crate::stability::scene_of;

/// A ball whose materials need different parts of the shader, each in a part of its triangles.
fn ball() -> geometry::mesh::Mesh {
    let mut ball = Shape::Icosphere.build();
    let looks = [
        Look { roughness: 0.4, ..Look::default() },
        Look { clearcoat: 1.0, clearcoat_roughness: 0.1, ..Look::default() },
        Look { sheen_color: [0.5, 0.3, 0.2], sheen_roughness: 0.4, ..Look::default() },
        Look { transmission: 0.6, ..Look::default() },
        Look { alpha: Alpha::Blend, ..Look::default() },
    ];
    let (count, parts) = (ball.triangles.len() as u32, looks.len() as u32);
    let material = |(index, look): (u32, Look)| Material {
        look,
        triangles: count * index / parts..count * (index + 1) / parts,
        ..Material::plain("part", [0.7, 0.5, 0.3, 0.6])
    };
    ball.materials = (0..).zip(looks).map(material).collect();
    ball
}

fn with_shaders(shared: bool) -> Engine {
    let mut renderer = Renderer::new(&engine().gpu);
    renderer.shares_shaders = shared;
    let mut engine = engine().clone();
    engine.renderer = Arc::new(renderer);
    engine
}

#[test]
fn materials_look_the_same_whether_or_not_they_share_a_shader() {
    let target = Target::new(&engine().gpu, [96; 2]).expect("a small picture");
    let engines = [true, false].map(with_shaders);
    let mut scene = scene_of(ball(), 0.0);
    let camera = Camera { azimuth: 20.0, elevation: 15.0, ..Camera::framing(&scene.bounds, target.viewport()) };
    for settings in every_way(studio()) {
        let [shared, own] = engines.each_ref().map(|engine| {
            engine.draw(&mut scene, &target, &camera, &settings, &mut Timing::Off).expect("a draw");
            target.read(&engine.gpu).expect("a readback")
        });
        // What is left out adds 0 or multiplies by 1. A compiler may round sums in another order then, and each of several layers
        // may be off by a step.
        let most = shared.iter().zip(own.iter()).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(most <= Some(2), "{most:?} with {settings:?}");
    }
}
