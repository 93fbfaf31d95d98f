//! Coordinates that are turned, scaled, mirrored or moved, and other spaces and views.

use super::*;

#[test]
fn other_spaces_are_named() {
    let scene = Scene::new(Shape::Bicubic, Tessellation { factor: 3.0, ..Tessellation::default() });
    let whole = Theirs::new(&scene.out).shuffled();
    let turn = Mat4::from_axis_angle(vec3(1.0, 2.0, 2.0) / 3.0, 0.5) * Mat4::from_translation(vec3(0.3, -0.2, 0.1));
    let text = scene.check(&whole.clone().moved(|p| turn.transform_point3(p)), &["coordinates"]);
    assert!(
        text.contains("turned by 28.6 degrees about (0.333, 0.667, 0.667), moved by (") && text.contains("Look "),
        "{text}"
    );
    let mirrored = whole.clone().moved(|p| turn.transform_point3(p * vec3(1.0, 1.0, -1.0)));
    assert!(scene.check(&mirrored, &["coordinates"]).contains("mirrored at the origin and turned by "));
    let clip = scene.inputs.view.clip_from_object;
    let divided = whole.clone().moved(|p| clip.project_point3(p));
    let text = scene.check(&divided, &["coordinates"]);
    assert!(text.contains("in clip space, by this camera's matrix, and divided by w"), "{text}");
    let text = scene.check(&whole.moved(|p| (clip * p.extend(1.0)).truncate()), &["coordinates"]);
    assert!(text.contains("in clip space, by this camera's matrix."), "{text}");
}

#[test]
fn another_view_is_told_from_moved_vertices() {
    // A few of the vertices lie where ours do.
    for partitioning in [Partitioning::Integer, Partitioning::FractionalOdd] {
        let own = Tessellation { pixels: 30.0, ..varied(partitioning) };
        let scene = Scene::new(Shape::Icosphere, own);
        let view =
            scene.inputs.view.seen_through(scene.inputs.view.clip_from_object, scene.inputs.view.half_viewport * 1.3);
        let theirs = tessellate(&scene.mesh, &scene.topology, &Inputs { view, ..scene.inputs }, None);
        let found = scene.compare(&Theirs::new(&theirs).shuffled());
        let kinds: Vec<_> = found.findings.iter().map(Finding::kind).collect();
        assert!(kinds.contains(&"factors") && !kinds.contains(&"moved_vertices"), "{partitioning:?}: {kinds:?}");
    }
}

#[test]
fn coordinates_that_are_turned_scaled_mirrored_or_moved_are_found_first() {
    // Nothing is symmetric about the bicubic vase.
    let scene = Scene::new(Shape::Bicubic, Tessellation { factor: 3.0, ..Tessellation::default() });
    let whole = Theirs::new(&scene.out).shuffled();
    for (theirs, said) in [
        (whole.clone().moved(|p| p * 100.0), "scaled (100 times ours)"),
        (whole.clone().moved(|p| vec3(p.x, -p.z, p.y)), "turned (its x, y, z are our x, -z, y)"),
        (
            whole.clone().moved(|p| vec3(p.x, -p.z, p.y) * 0.0254),
            "turned (its x, y, z are our x, -z, y) and scaled (0.0254",
        ),
        (whole.clone().moved(|p| vec3(p.x, p.y, -p.z)), "mirrored (its x, y, z are our x, y, -z)"),
        (whole.clone().moved(|p| p + vec3(5.0, 0.0, 0.0)), "moved (by (5, 0, 0))"),
    ] {
        let text = scene.compare(&theirs).findings.first().map(Finding::to_string).unwrap_or_default();
        assert!(text.contains(said), "{said}: {text}");
        let kinds: Vec<_> = scene.compare(&theirs).findings.iter().map(Finding::kind).collect();
        assert!(kinds.len() == 1 || kinds[1..] == ["rounding"], "{said}: {kinds:?}");
    }
    // Behind that, other mistakes are found as usual.
    let theirs =
        scene.theirs(|own| own.partitioning = Partitioning::FractionalEven).moved(|p| vec3(p.x, -p.z, p.y) * 100.0);
    assert!(scene.check(&theirs, &["coordinates", "partitioning"]).contains("fractional-even"));
}

#[test]
fn coordinates_of_a_symmetric_mesh_are_told_by_its_vertices() {
    // The torus looks nearly the same from eight sides and their opposites; LOD cuts each otherwise.
    let scene = torus(Partitioning::Integer);
    let whole = Theirs::new(&scene.out).shuffled();
    for (theirs, said) in [
        (
            whole.clone().moved(|p| vec3(p.x, -p.z, p.y) * 100.0),
            "turned (its x, y, z are our x, -z, y) and scaled (100 ",
        ),
        (whole.clone().moved(|p| -p), "mirrored (its x, y, z are our -x, -y, -z)."),
        (whole.clone().moved(|p| vec3(-p.x, p.y, p.z)), "mirrored (its x, y, z are our -x, y, z)."),
        (whole.clone().moved(|p| p * 1.03), "scaled (1.03 times ours)."),
    ] {
        let found: Vec<_> = scene.compare(&theirs).findings;
        let text = found.first().map(Finding::to_string).unwrap_or_default();
        assert!(text.contains(said), "{said}: {text}");
        let others: Vec<_> = found.iter().skip(1).map(Finding::kind).filter(|kind| *kind != "rounding").collect();
        assert!(others.is_empty(), "{said}: {others:?}");
    }
    // With other factors the surface alone tells, and of several ways to turn it the usual one is named.
    let theirs = scene.theirs(|own| own.partitioning = Partitioning::Pow2).moved(|p| vec3(p.x, -p.z, p.y));
    let text = scene.compare(&theirs).findings.first().map(Finding::to_string).unwrap_or_default();
    assert!(text.contains("its x, y, z are our x, -z, y"), "{text}");
}
