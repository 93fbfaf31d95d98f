//! Which differences are rounding: of single floats, of 16 bits, and of few decimals.

use super::*;

#[test]
fn rounding_is_told_from_mistakes() {
    // Under most LOD the last bits of factors move points, too.
    for lod in [Lod::Uniform, Lod::Error] {
        let scene = Scene::new(Shape::Torus, Tessellation { factor: 5.5, lod, ..Tessellation::default() });
        let noise = |size: f32| {
            Theirs::new(&scene.out).moved(|p| p + vec3((p.x * 1e4).sin(), (p.y * 1e4).sin(), (p.z * 1e4).cos()) * size)
        };
        scene.check(&noise(1e-7), &[]);
        let text = scene.check(&noise(5e-6), &["rounding"]);
        assert!(text.contains("last digits") && text.contains("--within"), "{text}");
        let found = scene.compare(&noise(5e-6)).farthest.expect("the same points").distance;
        assert!((4e-6..9e-6).contains(&found), "{found}");
    }
}

#[test]
fn numbers_of_16_bits_are_named_beside_other_mistakes() {
    let unit = |x: f32| x.abs().max(1.0 / 16384.0).log2().floor().exp2() / 1024.0;
    let halves = |p: Vec3| p.map(|x| (x / unit(x)).round() * unit(x));
    for scene in [torus(Partitioning::FractionalOdd), torus(Partitioning::Integer)] {
        let text = scene.check(&Theirs::new(&scene.out).moved(halves), &["rounding"]);
        assert!(text.contains("rounded to 16-bit floating-point numbers") && text.contains("--within "), "{text}");
        let scaled = Theirs::new(&scene.out).moved(|p| halves(100.0 * p));
        scene.check(&scaled, &["coordinates", "rounding"]);
    }
    let scene =
        Scene::new(Shape::Torus, Tessellation { partitioning: Partitioning::Integer, ..Tessellation::default() });
    scene.check(&scene.theirs(|own| own.factor = 5.0).moved(halves), &["factors", "rounding"]);
    // Where our own numbers have as few bits, nothing was rounded.
    let mut mesh = Shape::CubeSplit.build();
    mesh.corners.iter_mut().for_each(|corner| corner.position = corner.position.signum() * 0.5);
    let tessellation = Tessellation {
        surface: Surface::Flat,
        partitioning: Partitioning::Integer,
        factor: 4.0,
        ..Tessellation::default()
    };
    let cube = Scene::from_mesh(mesh, tessellation);
    let own = Theirs::new(&cube.out);
    let inside = |p: &Vec3| p.x == 0.5 && p.y.abs() < 0.5 && p.z.abs() < 0.5;
    let inside = own.positions.iter().copied().find(inside).expect("a face has points inside");
    let lifted = own.moved(|p| if p == inside { p + Vec3::X / 1024.0 } else { p });
    cube.check(&lifted, &["moved_vertices"]);
}

#[test]
fn three_decimals_are_enough_where_points_are_farther_apart() {
    let (decimals, resolution) = (|p: Vec3| (p * 1000.0).round() / 1000.0, 0.0005);
    for (partitioning, factor) in [(Partitioning::Integer, 5.0), (Partitioning::Rows, 4.0), (Partitioning::Pow2, 8.0)] {
        let scene = Scene::new(Shape::Torus, Tessellation { partitioning, factor, ..Tessellation::default() });
        let kinds = |theirs: Theirs| {
            let found = scene.compare_to_decimals(&theirs.moved(decimals), resolution);
            found.findings.iter().map(Finding::kind).collect::<Vec<_>>()
        };
        assert_eq!(kinds(Theirs::new(&scene.out)), [""; 0], "{partitioning:?}");
        assert_eq!(kinds(scene.theirs(|own| own.factor = 2.0)), ["factors"], "{partitioning:?}");
    }
}
