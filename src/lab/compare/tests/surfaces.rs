//! Other surfaces, mistakes in their control points, and displacement.

use std::sync::Arc;

use super::*;
use geometry::mesh::{HeightMap, Heights};
use geometry::tessellate::unpack_normal;

#[test]
fn every_other_surface_is_named() {
    let scene = Scene::new(Shape::CubeSplit, Tessellation::default());
    for surface in Surface::ALL.into_iter().filter(|surface| *surface != Surface::PnAen) {
        let text = scene.check(&scene.theirs(|own| own.surface = surface).shuffled(), &["surface"]);
        assert!(text.contains(&format!("lie on that of --surface {}", surface.name())), "{surface:?}: {text}");
    }
    let text = scene.check(&scene.theirs(|own| (own.surface, own.alpha) = (Surface::PhongAen, 0.6)), &["surface"]);
    assert!(text.contains("--surface phong-aen --alpha 0.6"), "{text}");
    // Phong of another strength than ours, and other factors at the same time.
    let phong = Scene::new(Shape::Torus, Tessellation { surface: Surface::Phong, ..varied(Partitioning::Integer) });
    let theirs = phong.theirs(|own| (own.alpha, own.partitioning) = (1.0, Partitioning::Pow2));
    let text = phong.check(&theirs, &["surface", "partitioning"]);
    assert!(text.contains("--alpha 1") && text.contains("pow2"), "{text}");
}

/// What we emit if control points have a mistake.
fn with_mistake(scene: &Scene, mistake: NetMistake) -> Theirs {
    let surface = OurSurface { inputs: scene.inputs, mistake: Some(mistake) };
    Theirs {
        positions: surface.positions(&scene.mesh, &scene.topology, &scene.out.vertices),
        ..Theirs::new(&scene.out)
    }
}

#[test]
fn mistakes_in_control_points_are_named() {
    let edges = |share, bend| NetMistake::Edges { share, bend };
    let own = Tessellation { partitioning: Partitioning::Integer, factor: 5.0, ..Tessellation::default() };
    // Every fourth on the torus, whose patches have seams between them.
    for (shape, tried) in [(Shape::CubeSplit, 1), (Shape::Torus, 4)] {
        let scene = Scene::new(shape, own);
        let all = [
            (NetMistake::Center(0.0), "is E alone"),
            (NetMistake::Center(-1.0), "is V, the mean of the corners"),
            (NetMistake::Center(0.8), "E + 0.8 (E - V)"),
            (edges(0.5, 1.5), "at 1/2 of the edge, and not at 1/3"),
            (edges(2.0 * THIRD, 1.0), "at 2/3 of the edge"),
            (edges(THIRD, -1.0), "on the other side of the edge"),
            (edges(THIRD, 1.44), "as with normals of length 1.200"),
            (edges(THIRD, 0.5625), "as with normals of length 0.750"),
            (NetMistake::Times(1.5), "are 1.5 times ours"),
            (NetMistake::Swapped, "near the start and near the end of every side are exchanged"),
            (NetMistake::Exchanged(1), "b120 and b021 are exchanged"),
            (NetMistake::Exchanged(2), "b021 and b012 are exchanged"),
        ];
        for (mistake, said) in all.into_iter().step_by(tried) {
            let text = scene.check(&with_mistake(&scene, mistake).shuffled(), &["control_points"]);
            assert!(text.contains(said) && text.contains("Look "), "{shape}, {mistake:?}: {text}");
        }
    }
}

#[test]
fn displacement_along_normals_is_told_from_other_moves() {
    let scene =
        Scene::new(Shape::Torus, Tessellation { partitioning: Partitioning::Integer, ..Tessellation::default() });
    let mut theirs = Theirs::new(&scene.out);
    for (position, vertex) in theirs.positions.iter_mut().zip(&scene.out.vertices) {
        *position += unpack_normal(vertex.normal) * (0.02 + 0.01 * (position.x * 9.0).sin());
    }
    let text = scene.check(&theirs.shuffled(), &["displaced"]);
    assert!(text.contains("along the normals, by up to 0.0300 object units outward"), "{text}");
    // Their factors are ours, though some of their points seem to lie elsewhere.
    assert!(scene.compare(&theirs).sides.is_empty() && scene.compare(&theirs).different.is_empty());
    let wavy = Theirs::new(&scene.out).moved(|p| p + vec3(0.006 * (p.y * 5.0).cos(), 0.0, 0.0));
    let text = scene.check(&wavy, &["displaced"]);
    assert!(text.contains("not along the normals"), "{text}");
}

#[test]
fn a_displaced_surface_is_told_from_its_base() {
    let mut mesh = Shape::Torus.build();
    let height = |i: u32| 0.5 + 0.5 * ((i % 64) as f32 / 5.0).sin() * ((i / 64) as f32 / 7.0).cos();
    mesh.heights =
        Some(Arc::new(Heights::everywhere(&mesh, HeightMap::new([64, 64], (0..4096).map(height).collect()))));
    let scene =
        Scene::from_mesh(mesh, Tessellation { displacement: Displacement::On, ..varied(Partitioning::Integer) });
    scene.check(&Theirs::new(&scene.out).shuffled(), &[]);
    let flat = scene.theirs(|own| own.displacement = Displacement::Off);
    let text = scene.check(&flat.shuffled(), &["surface"]);
    assert!(text.contains("It isn't displaced"), "{text}");
    let more = scene.theirs(|own| own.height_scale *= 1.5);
    let text = scene.check(&more, &["displaced"]);
    assert!(text.contains("otherwise than ours"), "{text}");
}
