//! Parts with surfaces and details of their own: what they share is still computed once.

use std::sync::Arc;

use geometry::mesh::{HeightAmount, HeightMap, Heights, Material, Mesh, PartRange, PartStyle, Shape};
use geometry::progress::Progress;
use geometry::tessellate::{
    Displacement, Edges, Inputs, Lod, Partitioning, Surface, Tessellation, edge_factors as factors_on_cpu, tessellate,
};
use inspect::engine::Loaded;
use inspect::measure::{EmittedChunk, ScreenErrorMeasurement, Visitor};
use inspect::settings::{ARENA_BYTES, Settings};
use load::Source;

use crate::passes::{assert_agree, edge_factors, inputs, on_gpu};
use crate::{engine, loaded_mesh};

/// A shape of three parts of the same size, of which the last has no style.
fn three_parts(shape: Shape, styles: [PartStyle; 2]) -> Loaded {
    let count = shape.build().triangles.len() as u32;
    parts(shape, [0, count / 3, 2 * count / 3, count], styles)
}

/// A shape whose parts lie between these triangles.
fn parts(shape: Shape, ends: [u32; 4], styles: [PartStyle; 2]) -> Loaded {
    let mesh = shape.build();
    let ranges = (0..).zip(ends.windows(2)).map(|(part, ends)| PartRange { triangles: ends[0]..ends[1], part });
    loaded_mesh(Source::Shape(shape), Mesh { part_ranges: ranges.collect(), part_styles: styles.to_vec(), ..mesh })
}

fn style(surface: Surface, detail: f32) -> PartStyle {
    PartStyle { surface: Some(surface), detail: Some(detail), ..PartStyle::default() }
}

fn triangles_of(loaded: &Loaded, part: u32, out: &geometry::tessellate::Tessellated) -> usize {
    let factors = (0..).zip(&out.patch_factors);
    let of_part = factors
        .filter(|(patch, _)| loaded.mesh.part_of(loaded.topology.patches[*patch as usize].triangle) == Some(part));
    of_part.map(|(_, factors)| geometry::tessellate::triangle_count(*factors) as usize).sum()
}

#[test]
fn parts_of_all_pairs_of_surfaces_and_details_meet_without_cracks() {
    for (number, surface) in Surface::ALL.into_iter().enumerate() {
        let others = [Surface::ALL[(number + 1) % 8], Surface::ALL[(number + 3) % 8]];
        let loaded = three_parts(Shape::Torus, [style(others[0], 0.5), style(others[1], 2.0)]);
        let mut scene = engine().scene(&loaded, ARENA_BYTES).expect("a small mesh");
        for (lod, partitioning) in [
            (Lod::Uniform, Partitioning::FractionalOdd),
            (Lod::Uniform, Partitioning::Subtriangulation),
            (Lod::EdgeLength, Partitioning::Pow2),
            (Lod::Paper, Partitioning::FractionalEven),
            (Lod::Distance, Partitioning::Integer),
            (Lod::Error, Partitioning::Rows),
            (Lod::Error, Partitioning::FractionalOdd),
        ] {
            let own = Tessellation { surface, lod, partitioning, factor: 3.0, ..Tessellation::default() };
            let inputs = inputs(&loaded, &Settings::from(own));
            let gpu = on_gpu(&mut scene, &inputs);
            let what = format!("{surface:?} beside {others:?}, {lod:?}, {partitioning:?}");
            let cracks = engine().measure(&mut scene).expect("a readback").cracks;
            assert_eq!((cracks.different_bits, cracks.different_factors), (0, 0), "{what}");
            let factors = edge_factors(&scene);
            if lod == Lod::Uniform {
                assert_eq!(factors, factors_on_cpu(&loaded.mesh, &loaded.topology, &inputs), "{what}");
            }
            if lod != Lod::Error {
                let cpu = tessellate(&loaded.mesh, &loaded.topology, &inputs, Some(&factors));
                assert_agree(&loaded, &gpu, &cpu, &what);
            }
        }
    }
}

#[test]
fn factors_are_multiplied_and_an_edge_between_parts_takes_the_finest() {
    let loaded = three_parts(Shape::Torus, [style(Surface::Flat, 0.5), style(Surface::Phong, 4.0)]);
    let own = Tessellation { factor: 4.0, ..Tessellation::default() };
    let inputs = Inputs::new(&own, inputs(&loaded, &Settings::from(own)).view);
    let topology = &loaded.topology;
    for (edge, factor) in topology.edges.iter().zip(factors_on_cpu(&loaded.mesh, topology, &inputs)) {
        let finest = topology.edge_sides(edge).iter().map(|side| {
            match loaded.mesh.part_of(topology.patches[side.patch() as usize].triangle) {
                Some(0) => 2.0,
                Some(1) => 16.0,
                _ => 4.0,
            }
        });
        assert_eq!(factor, finest.fold(0.0, f32::max));
    }
}

#[test]
fn a_flat_part_stays_flat_beside_curved_ones() {
    let loaded = three_parts(Shape::Torus, [style(Surface::Flat, 1.0), PartStyle::default()]);
    let mut scene = engine().scene(&loaded, ARENA_BYTES).expect("a small mesh");
    let own = Tessellation { factor: 6.0, ..Tessellation::default() };
    let out = on_gpu(&mut scene, &inputs(&loaded, &Settings::from(own)));
    let (mut flat, mut curved) = (0.0f32, 0.0f32);
    for vertex in &out.vertices {
        let patch = vertex.patch();
        let [a, b, c] = loaded.topology.patch_positions(patch);
        let normal = (b - a).cross(c - a).normalize();
        let off = (glam::Vec3::from(vertex.position) - a).dot(normal).abs();
        let part = loaded.mesh.part_of(loaded.topology.patches[patch as usize].triangle);
        let largest = if part == Some(0) { &mut flat } else { &mut curved };
        *largest = largest.max(off);
    }
    assert!(flat < 1e-6 && curved > 1e-3, "{flat} {curved}");
}

#[test]
fn sides_of_a_tearing_surface_share_what_borders_another_part() {
    let loaded = parts(Shape::CubeSplit, [0, 9, 11, 12], [style(Surface::Pn, 1.0), style(Surface::PhongAen, 1.0)]);
    let mut scene = engine().scene(&loaded, ARENA_BYTES).expect("a small mesh");
    let own = Tessellation { surface: Surface::Nagata, ..Tessellation::default() };
    on_gpu(&mut scene, &inputs(&loaded, &Settings::from(own)));
    let part = |patch: u32| loaded.mesh.part_of(loaded.topology.patches[patch as usize].triangle);
    let cracked: Vec<u32> =
        engine().measure(&mut scene).expect("a readback").cracks.edges.iter().map(|edge| edge.edge).collect();
    assert!(!cracked.is_empty(), "PN triangles tear within their part");
    for edge in cracked {
        let sides = loaded.topology.edge_sides(&loaded.topology.edges[edge as usize]);
        let [one, other] = [part(sides[0].patch()), part(sides[1].patch())];
        assert!(one == other && one != Some(1), "edge {edge} between {one:?} and {other:?}");
    }
}

#[test]
fn details_scale_the_tolerance_and_edges_as_published_keep_each_patch_its_own() {
    let styles = |detail| [PartStyle { detail: Some(detail), ..PartStyle::default() }, PartStyle::default()];
    let own = Tessellation { tolerance: 0.5, ..Tessellation::default() }.by_error(0.5);
    let made = [0.25, 1.0, 4.0].map(|detail| {
        let loaded = three_parts(Shape::Torus, styles(detail));
        let mut scene = engine().scene(&loaded, ARENA_BYTES).expect("a small mesh");
        let inputs = inputs(&loaded, &Settings::from(own));
        let out = on_gpu(&mut scene, &inputs);
        let mut measured =
            ScreenErrorMeasurement::new(&loaded.mesh, &loaded.topology, &inputs, out.triangles.len() as u64);
        measured.take(&EmittedChunk::whole(&out.vertices, &out.triangles));
        let worst = measured.worst().expect("triangles").value;
        assert!(worst <= f64::from(0.5 / detail.min(1.0)) + 1e-3, "{detail}: {worst} px");
        let published = Settings::from(Tessellation { edges: Edges::AsPublished, ..own });
        let alone = on_gpu(&mut scene, &crate::passes::inputs(&loaded, &published));
        [triangles_of(&loaded, 0, &out), triangles_of(&loaded, 2, &alone)]
    });
    assert!(made[0][0] < made[1][0] && made[1][0] < made[2][0], "{made:?}");
    assert!(made[0][1] == made[1][1] && made[1][1] == made[2][1], "nothing is shared: {made:?}");
}

#[test]
fn parts_with_details_are_displaced_by_the_images_of_their_materials() {
    let styled = three_parts(Shape::Torus, [style(Surface::Flat, 0.5), style(Surface::Phong, 2.0)]);
    let mut mesh = Mesh::clone(&styled.mesh);
    let half = mesh.triangles.len() as u32 / 2;
    let of = |triangles| Material { triangles, ..mesh.materials[0].clone() };
    mesh.materials = vec![of(0..half), of(half..2 * half)];
    let image = |side: u32| {
        let height = |i: u32| 0.5 + 0.4 * (std::f32::consts::TAU * (i % side) as f32 / side as f32).sin();
        HeightMap::new([side; 2], (0..side * side).map(height).collect())
    };
    let own = [Some(image(16).with_amount(HeightAmount::from_factor(0.2, -0.1))), Some(image(32))];
    mesh.heights =
        Some(Arc::new(Heights::of_materials(&mesh, &own, &Progress::new()).expect("not cancelled").expect("few maps")));
    let loaded = loaded_mesh(Source::Shape(Shape::Torus), mesh);
    let (size, patches) = (loaded.mesh.bounds().radius(), loaded.topology.patches.len());
    let mut scene = engine().scene(&loaded, ARENA_BYTES).expect("a small mesh");
    for lod in [Lod::Uniform, Lod::EdgeLength, Lod::Error] {
        let displacement = Displacement::On;
        let own = Tessellation { displacement, height_scale: 0.05, factor: 3.0, lod, ..Tessellation::default() };
        let inputs = inputs(&loaded, &Settings::from(own));
        let gpu = on_gpu(&mut scene, &inputs);
        let cracks = engine().measure(&mut scene).expect("a readback").cracks;
        assert_eq!((cracks.different_bits, cracks.different_factors), (0, 0), "{lod:?}");
        if lod == Lod::Error {
            let cpu = tessellate(&loaded.mesh, &loaded.topology, &inputs, None);
            let different = gpu.patch_factors.iter().zip(&cpu.patch_factors).filter(|(a, b)| a != b).count();
            assert!(50 * different <= patches, "{different} of {patches}");
            continue;
        }
        let cpu = tessellate(&loaded.mesh, &loaded.topology, &inputs, Some(&edge_factors(&scene)));
        assert_eq!(gpu.vertices.len(), cpu.vertices.len(), "{lod:?}");
        for (a, b) in gpu.vertices.iter().zip(&cpu.vertices) {
            let [p, q] = [a.position, b.position].map(glam::Vec3::from);
            assert!(p.distance(q) <= 1e-5 * size, "{lod:?}: {p} {q}");
        }
    }
}

#[test]
fn the_mesh_as_it_is_has_no_styles() {
    let loaded = three_parts(Shape::Torus, [style(Surface::Pn, 4.0), style(Surface::Phong, 2.0)]);
    let mut scene = engine().scene(&loaded, ARENA_BYTES).expect("a small mesh");
    let out = on_gpu(&mut scene, &inputs(&loaded, &Settings::from(Tessellation::untessellated())));
    assert_eq!(out.triangles.len(), loaded.topology.patches.len());
    let corners: Vec<_> = (0..loaded.topology.patches.len() as u32)
        .flat_map(|patch| loaded.topology.patch_positions(patch).map(|place| place.to_array().map(f32::to_bits)))
        .collect();
    let found = |place: [f32; 3]| corners.contains(&place.map(f32::to_bits));
    assert!(out.vertices.iter().all(|vertex| found(vertex.position)));
    let own = Tessellation { factor: 2.0, ..Tessellation::untessellated() };
    let out = on_gpu(&mut scene, &inputs(&loaded, &Settings::from(own)));
    assert!(out.triangles.len() > 4 * loaded.topology.patches.len(), "its parts have their details again");
}

#[test]
fn a_part_may_be_as_far_off_as_its_detail_allows() {
    let loaded = three_parts(Shape::Torus, [PartStyle { detail: Some(0.25), ..PartStyle::default() }; 2]);
    let mut scene = engine().scene(&loaded, ARENA_BYTES).expect("a small mesh");
    let inputs = inputs(&loaded, &Settings::from(Tessellation::default().by_error(0.5)));
    on_gpu(&mut scene, &inputs);
    let above = engine().patches_above(&mut scene, &inputs, 0.5).expect("a readback");
    let worst = above.worst.expect("triangles").value;
    assert!(above.patches == 0 && worst > 0.5, "{above:?}");
}
