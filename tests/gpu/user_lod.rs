//! Functions of the user's own in place of LOD, on the device.

use std::sync::Arc;

use geometry::mesh::Shape;
use geometry::tessellate::{
    Convention, Edges, HullFactors, Inputs, Lod, Partitioning, Surface, Tessellation, hull_factors,
};
use gpu::{Given, GpuError, LodShader, Timing};
use inspect::engine::Loaded;
use inspect::measure::{Agreement, Measured};
use inspect::render::{Camera, Scene};
use inspect::settings::Settings;
use inspect::user_shader::compile;

use super::{engine, scene};

fn shader(text: &str) -> Arc<LodShader> {
    Arc::new(compile(text).unwrap_or_else(|fault| panic!("{fault}\n{text}")))
}

/// A file whose function for edges has this body.
fn edge(body: &str) -> String {
    format!("fn edge_factor(edge: Edge, triangle: Triangle, view: View) -> f32 {{ {body} }}")
}

/// Settings whose LOD is replaced, and their inputs for a view from near by.
fn inputs(scene: &Scene, tessellation: Tessellation) -> Inputs {
    let viewport = glam::vec2(640.0, 480.0);
    let camera = Camera { azimuth: 25.0, elevation: 15.0, ..Camera::framing(&scene.bounds, viewport) };
    Settings::from(tessellation).inputs(camera.lod_view(viewport, &scene.bounds))
}

/// What functions give every patch, as the passes have written it.
fn given(scene: &mut Scene, text: &str, inputs: &Inputs) -> Vec<HullFactors> {
    scene.tessellator.give(Some(Given::Shader(shader(text)))).expect("a small mesh");
    engine().count(scene, inputs, &mut Timing::Off).expect("counts");
    engine().user_factors(scene).expect("a readback")
}

/// What LOD gives on the CPU.
fn of_lod(loaded: &Loaded, inputs: &Inputs, lod: Lod) -> Vec<HullFactors> {
    let tessellation = Tessellation { lod, pixels: 8.0, factor: 16.0, near: 2.0, far: 10.0, ..inputs.tessellation };
    hull_factors(&loaded.mesh, &loaded.topology, &Inputs { tessellation, ..*inputs })
}

fn measured(scene: &mut Scene) -> Measured {
    engine().measure(scene).expect("a readback")
}

fn bits(factors: &[HullFactors]) -> Vec<u32> {
    bytemuck::cast_slice(factors).to_vec()
}

/// The largest difference between factors, relative to the larger one.
fn difference(a: &[HullFactors], b: &[HullFactors]) -> f32 {
    let (a, b): (&[f32], &[f32]) = (bytemuck::cast_slice(a), bytemuck::cast_slice(b));
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs() / a.abs().max(b.abs())).fold(0.0, f32::max)
}

#[test]
fn the_examples_give_the_factors_of_the_lods_that_they_are() {
    let (distance, length) =
        (include_str!("../../assets/lod/distance.wgsl"), include_str!("../../assets/lod/screen-length.wgsl"));
    for shape in [Shape::Torus, Shape::CubeSplit] {
        let (loaded, mut scene) = scene(shape);
        for convention in [Convention::D3d11, Convention::AmdPn, Convention::EdgeOrder] {
            let inputs = inputs(&scene, Tessellation { convention, ..Tessellation::default() });
            // The device may round square roots, quotients and sums of products otherwise than the CPU, by a few units in the last
            // place of numbers that are then subtracted from ones ten times as large.
            for (text, lod) in [(distance, Lod::Distance), (length, Lod::Paper)] {
                let own = given(&mut scene, text, &inputs);
                let off = difference(&own, &of_lod(&loaded, &inputs, lod));
                assert!(off < 2e-5, "{shape:?} {convention:?} {lod:?}: {off}");
                assert!(own.iter().any(|patch| patch.edges[0] > 2.0), "{own:?}");
                let agreement = Agreement::new(&loaded.topology, &own, convention);
                assert_eq!(agreement.edges.len(), 0, "{shape:?} {convention:?} {lod:?}");
                assert_eq!(measured(&mut scene).cracks.different_factors, 0);
            }
        }
    }
}

#[test]
fn curvature_gives_flat_edges_one_segment_and_bent_ones_more() {
    let curvature = include_str!("../../assets/lod/curvature.wgsl");
    let (loaded, mut scene) = scene(Shape::Torus);
    let inputs_of = |scene: &Scene, surface| inputs(scene, Tessellation { surface, ..Tessellation::default() });
    let flat = inputs_of(&scene, Surface::Flat);
    let flat = given(&mut scene, curvature, &flat);
    assert!(flat.iter().all(|patch| patch.edges == [1.0; 3] && patch.inside == 2.0), "{flat:?}");
    let bent = inputs_of(&scene, Surface::PnAen);
    let bent = given(&mut scene, curvature, &bent);
    assert!(bent.iter().all(|patch| patch.edges.iter().all(|factor| (1.0..=64.0).contains(factor))));
    assert!(bent.iter().filter(|patch| patch.edges.iter().any(|&factor| factor > 3.0)).count() > 100);
    assert!(bent.iter().all(|patch| patch.inside == patch.edges.into_iter().fold(0.0, f32::max) + 1.0));
    assert_eq!(Agreement::new(&loaded.topology, &bent, Convention::D3d11).edges.len(), 0);
}

#[test]
fn what_is_not_symmetric_tears_where_it_says() {
    let (loaded, mut scene) = scene(Shape::Torus);
    let inputs = inputs(&scene, Tessellation::default());
    let of_start = edge("return 3.0 + 4.0 * distance(edge.a, view.eye) / view.radius - 4.0;");
    let own = given(&mut scene, &of_start, &inputs);
    let agreement = Agreement::new(&loaded.topology, &own, Convention::D3d11);
    assert!(agreement.edges.len() > 300, "{} edges", agreement.edges.len());
    let measured = measured(&mut scene);
    assert_eq!(measured.cracks.different_factors, agreement.edges.len() as u64, "each of them is a crack");
    assert!(measured.cracks.max_gap() > 1e-4);
    // One triangle alone requests more.
    let odd = edge("return select(4.0, 9.0, triangle.index == 7u && edge.side == 1u);");
    let own = given(&mut scene, &odd, &inputs);
    let agreement = Agreement::new(&loaded.topology, &own, Convention::D3d11);
    let side = loaded.topology.patches[7].sides[1];
    assert_eq!(agreement.edges.len(), 1);
    assert_eq!(agreement.edges[0].edge, loaded.topology.sides[side as usize].edge);
}

#[test]
fn a_function_for_insides_gets_the_factors_of_the_sides() {
    let (_, mut scene) = scene(Shape::Icosahedron);
    let text = edge("return 2.0 + f32(edge.side);")
        + "fn inside_factor(triangle: Triangle, factors: vec3<f32>, view: View) -> f32 {\n\
           return factors.x + 10.0 * factors.y + 100.0 * factors.z + f32(triangle.index) * 1000.0; }";
    for (convention, edges) in [
        (Convention::D3d11, [3.0, 4.0, 2.0]),
        (Convention::AmdPn, [4.0, 2.0, 3.0]),
        (Convention::EdgeOrder, [2.0, 3.0, 4.0]),
    ] {
        let inputs = inputs(&scene, Tessellation { convention, ..Tessellation::default() });
        let own = given(&mut scene, &text, &inputs);
        for (index, patch) in own.iter().enumerate() {
            assert_eq!((patch.edges, patch.inside), (edges, 432.0 + 1000.0 * index as f32), "{convention:?}");
        }
    }
    // Without one it is the largest; under rows it says which edge is the base, as with factors of LOD.
    for partitioning in [Partitioning::Integer, Partitioning::Rows, Partitioning::Pow2] {
        let inputs = inputs(&scene, Tessellation { partitioning, ..Tessellation::default() });
        let own = given(&mut scene, &edge("return 2.0 + f32(edge.side);"), &inputs);
        let expected = if partitioning == Partitioning::Rows { 2.0 } else { 4.0 };
        let inside: Vec<_> = own.iter().map(|patch| patch.inside).collect();
        assert!(inside.iter().all(|&inside| inside >= expected && inside <= 4.0), "{partitioning:?}: {inside:?}");
    }
}

#[test]
fn the_contract_holds_on_every_side() {
    let (_, mut scene) = scene(Shape::Torus);
    let inputs = inputs(&scene, Tessellation::default());
    // 1 if everything is as the manual says, else 2 to 6.
    let text = edge(
        "let next = (edge.side + 1u) % 3u;
         if any(edge.a != triangle.corners[edge.side]) || any(edge.b != triangle.corners[next]) { return 2.0; }
         if any(edge.normal_a != triangle.normals[edge.side]) || abs(length(edge.normal_b) - 1.0) > 1e-5 { return 3.0; }
         if distance(edge.a, edge.ab) > distance(edge.a, edge.ba) { return 4.0; }
         if any(view.viewport != vec2<f32>(640.0, 480.0)) || view.reach != 0.0 { return 5.0; }
         let eye = view.clip_from_object * vec4<f32>(view.eye, 1.0);
         if abs(eye.w) > 1e-4 * view.radius || view.radius <= 0.0 { return 6.0; }
         return 1.0;",
    );
    let own = given(&mut scene, &text, &inputs);
    assert!(own.iter().all(|patch| patch.edges == [1.0; 3]), "{own:?}");
}

#[test]
fn factors_follow_the_view_and_are_the_same_bits_again() {
    let (_, mut scene) = scene(Shape::Torus);
    let text = include_str!("../../assets/lod/screen-length.wgsl");
    let far = inputs(&scene, Tessellation::default());
    let first = given(&mut scene, text, &far);
    let near = Inputs { view: far.view.seen_through(far.view.clip_from_object, far.view.half_viewport * 2.0), ..far };
    engine().count(&mut scene, &near, &mut Timing::Off).expect("counts");
    let second = engine().user_factors(&scene).expect("a readback");
    assert!(difference(&first, &second) > 0.4, "the picture is twice as large");
    engine().count(&mut scene, &far, &mut Timing::Off).expect("counts");
    assert_eq!(bits(&engine().user_factors(&scene).expect("a readback")), bits(&first));
    // Taken away, LOD is as before.
    scene.tessellator.give(None).expect("small");
    engine().count(&mut scene, &far, &mut Timing::Off).expect("counts");
    assert!(
        engine().user_factors(&scene).expect("nothing").is_empty() && scene.tessellator.user_lod_report().is_none()
    );
}

#[test]
fn loops_without_end_are_stopped_and_said() {
    let (_, mut scene) = scene(Shape::Torus);
    let inputs = inputs(&scene, Tessellation::default());
    let helper =
        "fn spin(start: u32) -> u32 { var n = start; loop { n = n * 3u + 1u; if n == 0u { break; } } return n; }";
    for text in [
        edge("var n = 0.0; loop { n += 1.0; } return n;"),
        edge("var n = 1.0; while n > 0.0 { n += 1.0; if n > 9.0 { n = 1.0; } } return n;"),
        edge("var n = 1u; for (;;) { n++; if n == 0u { n = 2u; } } return f32(n);"),
        helper.to_owned() + &edge("return f32(spin(1u));"),
        helper.to_owned() + &edge("var n = 0u; for (var i = 1u; i > 0u; i += 2u) { n += spin(i); } return f32(n);"),
        // One side alone.
        edge(
            "var n = 1.0; while triangle.index == 200u && edge.side == 2u { n *= 1.5; if n > 99.0 { n = 1.0; } } return n;",
        ),
        edge("return 3.0;")
            + "fn inside_factor(triangle: Triangle, factors: vec3<f32>, view: View) -> f32 { loop { } return 1.0; }",
    ] {
        scene.tessellator.give(Some(Given::Shader(shader(&text)))).expect("small");
        let stopped = engine().count(&mut scene, &inputs, &mut Timing::Off);
        assert!(matches!(stopped, Err(GpuError::UserShaderTimedOut("LOD shader"))), "{text}: {stopped:?}");
        let own = engine().user_factors(&scene).expect("a readback");
        assert!(own.iter().all(|patch| patch.edges == [1.0; 3] && patch.inside == 1.0), "{text}");
    }
    // Loops of a hundred thousand turns are none of these.
    let long = edge("var n = 0u; for (var i = 0u; i < 60000u; i++) { n += i & 1u; } return f32(n) / 10000.0;");
    let own = given(&mut scene, &long, &inputs);
    assert!(own.iter().all(|patch| patch.edges == [3.0; 3]), "{own:?}");
}

#[test]
fn factors_that_are_no_numbers_are_counted_and_cull_as_direct3d_says() {
    let (_, mut scene) = scene(Shape::Torus);
    let inputs = inputs(&scene, Tessellation::default());
    // The compiler doesn't know that this is the root of a negative number.
    let text = edge(
        "let root = sqrt(-view.radius * view.radius); return select(4.0, root, triangle.index < 3u && edge.side == 0u);",
    );
    let own = given(&mut scene, &text, &inputs);
    assert_eq!(own.iter().filter(|patch| patch.edges.iter().any(|factor| factor.is_nan())).count(), 3);
    let report = scene.tessellator.user_lod_report().expect("it ran");
    assert!(report.stopped == 0 && (3..=6).contains(&report.not_numbers), "insides may be NaN as well: {report:?}");
    assert_eq!(measured(&mut scene).culled.by_factors, 3);
    let text = edge("return select(4.0, -1.0, triangle.index < 5u);");
    given(&mut scene, &text, &inputs);
    assert_eq!(scene.tessellator.user_lod_report().expect("it ran").not_numbers, 0);
    assert_eq!(measured(&mut scene).culled.by_factors, 5);
}

#[test]
fn indices_beyond_an_array_stay_within_it() {
    let (_, mut scene) = scene(Shape::Torus);
    let inputs = inputs(&scene, Tessellation::default());
    let text = "var<private> table: array<f32, 4>;".to_owned()
        + &edge(
            "table[triangle.index * 1000003u] = 5.0; let far = triangle.corners[triangle.index * 77777u]; return 2.0 + 0.0 * far.x + 0.0 * table[edge.side + 999999u];",
        );
    let own = given(&mut scene, &text, &inputs);
    assert!(own.iter().all(|patch| patch.edges == [2.0; 3]), "{own:?}");
}

#[test]
fn expressions_as_long_as_they_may_be_compile_on_a_usual_stack() {
    let (_, mut scene) = scene(Shape::Icosahedron);
    let inputs = inputs(&scene, Tessellation::default());
    let sum = edge(&format!("return 2.0{};", " + 0.0 * view.radius".repeat(140)));
    assert!(given(&mut scene, &sum, &inputs).iter().all(|patch| patch.edges == [2.0; 3]));
    let sum = edge(&format!("return 2.0{};", "+0.0".repeat(500)));
    assert!(given(&mut scene, &sum, &inputs).iter().all(|patch| patch.edges == [2.0; 3]));
    let nested = edge(&format!("var a = 2.0; {} a += 0.0; {} return a;", "if a > 1.0 { ".repeat(60), "}".repeat(60)));
    assert!(given(&mut scene, &nested, &inputs).iter().all(|patch| patch.edges == [2.0; 3]));
}

#[test]
fn sides_as_published_have_a_function_each_and_displacement_follows_the_factors() {
    let (loaded, mut scene) = scene(Shape::Torus);
    let text = include_str!("../../assets/lod/distance.wgsl");
    let published = inputs(&scene, Tessellation { edges: Edges::AsPublished, ..Tessellation::default() });
    let own = given(&mut scene, text, &published);
    assert!(difference(&own, &of_lod(&loaded, &published, Lod::Distance)) < 2e-5);
    // A scene beside it has the same functions.
    let mut beside = scene.sibling(1 << 22)().expect("small");
    engine().count(&mut beside, &published, &mut Timing::Off).expect("counts");
    assert_eq!(bits(&engine().user_factors(&beside).expect("a readback")), bits(&own));
    assert_eq!(beside.tessellator.totals(), scene.tessellator.totals());
    // LOD by error is measured without them, and they are there again.
    let compared = engine().triangles_by_error(&mut scene, &published, 0.5).expect("counts");
    assert!(compared.is_some());
    assert_eq!(bits(&engine().user_factors(&scene).expect("a readback")), bits(&own));
}
