//! Control points by a function of the user's own, on the device.

use std::sync::Arc;

use geometry::mesh::Shape;
use geometry::tessellate::{Edges, Inputs, Lod, Partitioning, Surface, Tessellated, Tessellation};
use glam::Vec3;
use gpu::layout::CurveNet;
use gpu::{Given, GpuError, LodShader, SurfaceShader, Timing, read_buffer};
use inspect::engine::Loaded;
use inspect::measure::Measured;
use inspect::render::{Camera, Scene};
use inspect::settings::Settings;
use inspect::user_shader::compile;

use super::{engine, scene};

const EXAMPLES: [&str; 3] = [
    include_str!("../../assets/surface/pn.wgsl"),
    include_str!("../../assets/surface/pn-aen.wgsl"),
    include_str!("../../assets/surface/hard-creases.wgsl"),
];
/// Of [`EXAMPLES`].
const PN: usize = 0;
const PN_AEN: usize = 1;
const HARD_CREASES: usize = 2;

fn shader(text: &str) -> Arc<SurfaceShader> {
    Arc::new(compile(text).unwrap_or_else(|fault| panic!("{fault}\n{text}")))
}

/// A file whose function has this body.
fn points(body: &str) -> String {
    format!("fn edge_points(edge: SurfaceEdge, triangle: SurfaceTriangle) -> EdgePoints {{ {body} }}")
}

/// A file whose function gives the straight edge's control points, moved by these vectors.
fn straight_and(ab: &str, ba: &str) -> String {
    points(&format!(
        "let along = (edge.b - edge.a) / 3.0; return EdgePoints(edge.a + along + {ab}, edge.b - along + {ba});"
    ))
}

fn inputs(scene: &Scene, tessellation: Tessellation) -> Inputs {
    let viewport = glam::vec2(640.0, 480.0);
    let camera = Camera { azimuth: 25.0, elevation: 15.0, ..Camera::framing(&scene.bounds, viewport) };
    Settings::from(tessellation).inputs(camera.lod_view(viewport, &scene.bounds))
}

/// What is emitted with the inputs, with a function or the surface's own.
fn emitted(scene: &mut Scene, text: Option<&str>, inputs: &Inputs) -> Tessellated {
    scene.tessellator.set_surface_shader(text.map(shader)).expect("a small mesh");
    engine().count(scene, inputs, &mut Timing::Off).expect("counts");
    engine().read_tessellated(scene).expect("a readback")
}

fn measured(scene: &mut Scene) -> Measured {
    engine().measure(scene).expect("a readback")
}

/// What the function gave each side of the topology, in the direction of its edge.
fn nets(loaded: &Loaded, scene: &Scene) -> Vec<[Vec3; 2]> {
    let buffers = scene.tessellator.buffers();
    let bytes = u64::from(buffers.curve_count) * size_of::<CurveNet>() as u64;
    let bytes = read_buffer(&engine().gpu, &buffers.curve_nets, 0, bytes).expect("a readback");
    let nets: Vec<CurveNet> = bytemuck::pod_collect_to_vec(&bytes);
    let curves = buffers.grouping.curves(&loaded.mesh, &loaded.topology);
    curves.side_curves.iter().map(|&curve| [nets[curve as usize].ab, nets[curve as usize].ba].map(Vec3::from)).collect()
}

/// The largest distance between vertices of two tessellations of the same pattern.
fn apart(a: &Tessellated, b: &Tessellated) -> f32 {
    assert!(a.triangles == b.triangles && a.vertices.len() == b.vertices.len() && !a.vertices.is_empty());
    let distance = |a: [f32; 3], b: [f32; 3]| Vec3::from(a).distance(Vec3::from(b));
    a.vertices.iter().zip(&b.vertices).map(|(a, b)| distance(a.position, b.position)).fold(0.0, f32::max)
}

/// A driver may round sums of products otherwise in the user's function than in ours: by a few units in the last place of coordinates
/// of these shapes, which are at most 2.
const ROUNDING: f32 = 2e-6;

#[test]
fn the_examples_make_the_surfaces_that_they_are() {
    for shape in [Shape::Torus, Shape::CubeSplit, Shape::CubeSmooth, Shape::Moebius] {
        let (_, mut scene) = scene(shape);
        for edges in [Edges::PerEdge, Edges::AsPublished] {
            for (example, surface) in [(PN, Surface::Pn), (PN_AEN, Surface::PnAen)] {
                let inputs = inputs(&scene, Tessellation { surface, edges, ..Tessellation::default() });
                let own = emitted(&mut scene, Some(EXAMPLES[example]), &inputs);
                let ours = emitted(&mut scene, None, &inputs);
                let apart = apart(&own, &ours);
                assert!(apart <= ROUNDING, "{shape:?} {edges:?} {surface:?}: {apart}");
            }
        }
    }
}

#[test]
fn examples_crack_exactly_where_their_surfaces_do() {
    for shape in Shape::ALL {
        let (_, mut scene) = scene(shape);
        let inputs = inputs(&scene, Tessellation { surface: Surface::Pn, ..Tessellation::default() });
        for (example, text) in EXAMPLES.iter().enumerate() {
            emitted(&mut scene, Some(text), &inputs);
            let own = measured(&mut scene).cracks;
            let agreement = engine().user_points_agreement(&scene).expect("a readback").expect("a shader");
            assert_eq!(agreement.edges_compared, own.edges_compared);
            if example != PN {
                assert_eq!((own.edges.len(), agreement.edges.len()), (0, 0), "{shape:?} {example}");
                continue;
            }
            emitted(&mut scene, None, &inputs);
            let ours = measured(&mut scene).cracks;
            let edges = |cracks: &inspect::measure::Cracks| {
                let mut edges: Vec<_> = cracks.edges.iter().map(|crack| crack.edge).collect();
                edges.sort_unstable();
                edges
            };
            assert_eq!(edges(&own), edges(&ours), "{shape:?}");
            assert!((own.max_gap() - ours.max_gap()).abs() <= f64::from(ROUNDING), "{shape:?}");
            assert_eq!(agreement.edges.len(), ours.edges.len(), "{shape:?}");
        }
    }
}

#[test]
fn hard_creases_are_straight_and_the_rest_is_pn_aen() {
    let straight = |loaded: &Loaded, scene: &Scene| {
        let own = nets(loaded, scene);
        let is_straight = |(index, [ab, ba]): (usize, [Vec3; 2])| {
            let edge = &loaded.topology.edges[loaded.topology.sides[index].edge as usize];
            let [a, b] = loaded.topology.edge_points(edge).map(|point| loaded.topology.points[point as usize]);
            ab.distance(a.lerp(b, 1.0 / 3.0)) + ba.distance(b.lerp(a, 1.0 / 3.0)) < ROUNDING
        };
        own.into_iter().enumerate().filter(|&own| is_straight(own)).count()
    };
    let (cube, mut scene_of_cube) = scene(Shape::CubeSplit);
    let inputs_of_cube = inputs(&scene_of_cube, Tessellation::default());
    emitted(&mut scene_of_cube, Some(EXAMPLES[HARD_CREASES]), &inputs_of_cube);
    assert_eq!(straight(&cube, &scene_of_cube), 24, "both sides of the cube's own edges, not of its faces' diagonals");
    let (_, mut scene_of_torus) = scene(Shape::Torus);
    let inputs_of_torus = inputs(&scene_of_torus, Tessellation::default());
    let own = emitted(&mut scene_of_torus, Some(EXAMPLES[HARD_CREASES]), &inputs_of_torus);
    let ours = emitted(&mut scene_of_torus, None, &inputs_of_torus);
    assert!(apart(&own, &ours) <= ROUNDING);
}

#[test]
fn the_contract_holds_on_every_side() {
    // 1 if everything is as the manual says, else 2 to 5.
    let text = points(
        "let next = (edge.side + 1u) % 3u; var found = 1.0;
         if any(edge.a != triangle.corners[edge.side]) || any(edge.b != triangle.corners[next]) { found = 2.0; }
         if any(edge.normal_a != triangle.normals[edge.side]) || any(edge.normal_b != triangle.normals[next]) { found = 3.0; }
         if abs(length(edge.adjacent_normal_a) - 1.0) > 1e-5 || abs(length(edge.adjacent_normal_b) - 1.0) > 1e-5 { found = 4.0; }
         let is_own = all(edge.normal_a == edge.adjacent_normal_a) && all(edge.normal_b == edge.adjacent_normal_b);
         if !edge.has_adjacent && !is_own { found = 5.0; }
         return EdgePoints(vec3<f32>(found, f32(triangle.index), f32(edge.side)), vec3<f32>(f32(edge.has_adjacent)));",
    );
    for shape in [Shape::CubeSplit, Shape::Torus, Shape::Saddle, Shape::Moebius] {
        let (loaded, mut scene) = scene(shape);
        let inputs = inputs(&scene, Tessellation::default());
        emitted(&mut scene, Some(&text), &inputs);
        for (side, [ab, ba]) in loaded.topology.sides.iter().zip(nets(&loaded, &scene)) {
            let [found, about] = if side.reversed() { [ba, ab] } else { [ab, ba] };
            let edge = &loaded.topology.edges[side.edge as usize];
            assert_eq!(found.to_array(), [1.0, side.patch() as f32, side.index() as f32], "{shape:?}");
            assert_eq!(about.x == 1.0, loaded.topology.edge_sides(edge).len() == 2, "{shape:?}");
        }
    }
}

#[test]
fn a_side_gets_the_normals_across_its_edge() {
    let text = points("return EdgePoints(edge.adjacent_normal_a, edge.adjacent_normal_b);");
    for shape in [Shape::CubeSplit, Shape::Cylinder, Shape::Saddle] {
        let (loaded, mut scene) = scene(shape);
        for edges in [Edges::PerEdge, Edges::AsPublished] {
            let inputs = inputs(&scene, Tessellation { edges, ..Tessellation::default() });
            emitted(&mut scene, Some(&text), &inputs);
            let (topology, nets) = (&loaded.topology, nets(&loaded, &scene));
            for (index, side) in (0..).zip(&topology.sides) {
                let sides = topology.side_range(&topology.edges[side.edge as usize]);
                let across = sides.clone().find(|&other| other != index).filter(|_| sides.len() == 2).unwrap_or(index);
                let corners = topology.side_corners(&topology.sides[across as usize]);
                let [a, b] = corners.map(|corner| loaded.mesh.corners[corner as usize].normal);
                // As published, a curve runs as its patch does.
                let is_turned = edges == Edges::AsPublished && side.reversed();
                assert_eq!(
                    nets[index as usize],
                    if is_turned { [b, a] } else { [a, b] },
                    "{shape:?} {edges:?} {index}"
                );
            }
        }
    }
}

#[test]
fn what_is_not_symmetric_tears_where_it_says() {
    let (loaded, mut scene) = scene(Shape::Torus);
    let inputs = inputs(&scene, Tessellation::default());
    // Nearer to the start than to the end.
    let text = points("return EdgePoints(mix(edge.a, edge.b, 0.4), mix(edge.b, edge.a, 1.0 / 3.0));");
    emitted(&mut scene, Some(&text), &inputs);
    let cracks = measured(&mut scene).cracks;
    assert_eq!(cracks.cracked().len() as u64, cracks.edges_compared, "every edge");
    assert_eq!(engine().user_points_agreement(&scene).expect("a readback").expect("a shader").edges.len(), 384);
    assert!(cracks.different_factors == 0 && cracks.max_gap() > 1e-3, "{}", cracks.max_gap());
    // One side of one triangle alone, by a known distance.
    let text = straight_and(
        "select(vec3<f32>(0.0), vec3<f32>(0.0, 0.25, 0.0), triangle.index == 7u && edge.side == 1u)",
        "vec3<f32>(0.0)",
    );
    emitted(&mut scene, Some(&text), &inputs);
    let cracks = measured(&mut scene).cracks;
    let widest = cracks.edges[0];
    let side = loaded.topology.patches[7].sides[1];
    assert_eq!(widest.edge, loaded.topology.sides[side as usize].edge);
    // The Bernstein polynomial of that control point is 4/9 at most, at a third of the edge.
    assert!((0.09..=0.25 * 4.0 / 9.0 + 1e-6).contains(&widest.gap), "{}", widest.gap);
    let agreement = engine().user_points_agreement(&scene).expect("a readback").expect("a shader");
    assert!(agreement.edges[0].edge == widest.edge && (agreement.max_distance() - 0.25).abs() < 1e-6);
    assert!(agreement.edges[0].triangles.contains(&loaded.topology.patches[7].triangle));
}

#[test]
fn points_that_are_no_numbers_are_counted_and_their_sides_are_straight() {
    let (loaded, mut scene) = scene(Shape::Torus);
    let inputs = inputs(&scene, Tessellation::default());
    // The compiler knows neither the root of a negative number nor the quotient.
    let nan =
        "vec3<f32>(select(0.0, sqrt(-dot(edge.normal_a, edge.normal_a)), triangle.index < 3u && edge.side == 0u))";
    let infinite = "vec3<f32>(0.0, select(0.0, 3e38 * dot(triangle.normals[0], triangle.normals[0]) * 9.0, triangle.index == 9u), 0.0)";
    let text = straight_and(nan, infinite);
    let own = emitted(&mut scene, Some(&text), &inputs);
    let report = scene.tessellator.user_surface_report().expect("it ran");
    assert_eq!((report.stopped, report.not_numbers), (0, 6), "three sides, and all of one triangle");
    assert!(own.vertices.iter().all(|vertex| vertex.position.iter().all(|x| x.is_finite())));
    let flat = inputs_with(&inputs, Surface::Flat);
    let flat = emitted(&mut scene, None, &flat);
    assert!(apart(&own, &flat) < 1e-5, "all edges are straight");
    // A version without these counts none.
    emitted(&mut scene, Some(EXAMPLES[PN_AEN]), &inputs);
    assert_eq!(scene.tessellator.user_surface_report().expect("it ran").not_numbers, 0);
    assert_eq!(nets(&loaded, &scene).len(), loaded.topology.sides.len());
}

fn inputs_with(inputs: &Inputs, surface: Surface) -> Inputs {
    Inputs { tessellation: Tessellation { surface, ..inputs.tessellation }, ..*inputs }
}

#[test]
fn loops_without_end_are_stopped_and_said() {
    let (_, mut scene) = scene(Shape::Torus);
    let inputs = inputs(&scene, Tessellation::default());
    for text in [
        points("var p = edge.a; loop { p += edge.b; } return EdgePoints(p, p);"),
        points(
            "var n = 1.0; while triangle.index == 200u && edge.side == 2u { n *= 1.5; if n > 99.0 { n = 1.0; } } return EdgePoints(edge.a * n, edge.b);",
        ),
    ] {
        scene.tessellator.set_surface_shader(Some(shader(&text))).expect("small");
        let stopped = engine().count(&mut scene, &inputs, &mut Timing::Off);
        assert!(matches!(stopped, Err(GpuError::UserShaderTimedOut("surface shader"))), "{text}: {stopped:?}");
        let own = engine().read_tessellated(&mut scene).expect("a readback");
        scene.tessellator.set_surface_shader(None).expect("small");
        let flat = emitted(&mut scene, None, &inputs_with(&inputs, Surface::Flat));
        assert!(apart(&own, &flat) < 1e-5, "{text}");
    }
    // A loop of many turns is none of these.
    let long = points(
        "var n = 0.0; for (var i = 0u; i < 5000u; i++) { n += 0.0; } return EdgePoints(edge.a + n, edge.b + n);",
    );
    emitted(&mut scene, Some(&long), &inputs);
}

#[test]
fn the_function_is_taken_back_and_shared_like_all_that_is_given() {
    let (_, mut scene) = scene(Shape::Torus);
    let inputs = inputs(&scene, Tessellation::default());
    let positions = |made: &Tessellated| made.vertices.iter().map(|vertex| vertex.position).collect::<Vec<_>>();
    let ours = emitted(&mut scene, None, &inputs);
    let own = emitted(&mut scene, Some(EXAMPLES[HARD_CREASES]), &inputs);
    assert!(scene.tessellator.user_surface_report().is_some());
    // A scene beside it has it too, and the same bits.
    let mut beside = scene.sibling(1 << 22)().expect("small");
    engine().count(&mut beside, &inputs, &mut Timing::Off).expect("counts");
    let beside = engine().read_tessellated(&mut beside).expect("a readback");
    assert_eq!(positions(&beside), positions(&own));
    let again = emitted(&mut scene, None, &inputs);
    assert!(positions(&again) == positions(&ours) && scene.tessellator.user_surface_report().is_none());
    assert!(engine().user_points_agreement(&scene).expect("nothing to read").is_none());
}

#[test]
fn lod_and_factors_of_ones_own_follow_the_control_points() {
    let (_, mut scene) = scene(Shape::Icosahedron);
    for partitioning in [Partitioning::Integer, Partitioning::Rows] {
        let inputs = |scene: &Scene, surface| {
            let own =
                Tessellation { surface, lod: Lod::Error, tolerance: 0.5, partitioning, ..Tessellation::default() };
            inputs(scene, own)
        };
        let (cubic, flat) = (inputs(&scene, Surface::PnAen), inputs(&scene, Surface::Flat));
        // Straight edges are found to be flat.
        let own = emitted(&mut scene, Some(&straight_and("vec3<f32>(0.0)", "vec3<f32>(0.0)")), &cubic);
        let of_flat = emitted(&mut scene, None, &flat);
        assert!(own.triangles.len() <= 2 * of_flat.triangles.len(), "{partitioning:?}: {}", own.triangles.len());
        let own = emitted(&mut scene, Some(EXAMPLES[PN_AEN]), &cubic);
        let ours = emitted(&mut scene, None, &cubic);
        let (own, ours) = (own.triangles.len() as f64, ours.triangles.len() as f64);
        // Rounding may change a factor that was about to change.
        assert!(own > 200.0 && (own / ours - 1.0).abs() < 0.05, "{partitioning:?}: {own} and {ours}");
    }
    // Functions for factors see the control points, and both report.
    let lod = compile::<LodShader>(
        "fn edge_factor(edge: Edge, triangle: Triangle, view: View) -> f32 { return 1.0 + round(9.0 * distance(edge.ab, edge.ba)); }",
    );
    let lod = Arc::new(lod.unwrap_or_else(|fault| panic!("{fault}")));
    let uniform = inputs(&scene, Tessellation::default());
    let factors = |scene: &mut Scene, text: &str| {
        scene.tessellator.give(Some(Given::Shader(lod.clone()))).expect("small");
        emitted(scene, Some(text), &uniform);
        assert!(scene.tessellator.user_lod_report().is_some() && scene.tessellator.user_surface_report().is_some());
        engine().user_factors(scene).expect("a readback")
    };
    let near = factors(&mut scene, &points("return EdgePoints(edge.a, edge.b);"));
    let far = factors(&mut scene, &points("return EdgePoints(edge.a * 0.5 + edge.b * 0.5, edge.b);"));
    assert!(near.iter().zip(&far).all(|(near, far)| near.edges[0] > far.edges[0]), "{near:?} {far:?}");
}

#[test]
fn backs_are_drawn_since_they_may_be_seen() {
    let (_, mut scene) = scene(Shape::Torus);
    let inputs = inputs(&scene, Tessellation { cull_back_faces: true, ..Tessellation::default() });
    // Backs are drawn, since control points of the user's own may turn anything outside.
    emitted(&mut scene, Some(EXAMPLES[PN_AEN]), &inputs);
    assert_eq!(measured(&mut scene).culled.total(), 0);
    assert!(!scene.tessellator.shows_fronts_only(inputs.view.clip_from_object));
    emitted(&mut scene, None, &inputs);
    assert!(measured(&mut scene).culled.facing_away > 0);
}
