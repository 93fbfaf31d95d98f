//! Materials and parts with images of their own.

use std::ops::Range;
use std::sync::Arc;

use geometry::mesh::{HeightAmount, HeightMap, Heights, Material, PartRange, Shape, Texture, Wrap};
use geometry::progress::Progress;
use geometry::tessellate::{
    Displacement, Edges, Lod, Normals, PatchFactors, Surface, Tessellation, Vertex, tessellate, triangle_count,
};
use inspect::engine::Loaded;
use inspect::render::Scene;
use inspect::settings::Settings;
use load::{Budget, HeightSource};

use super::{measured, on_device, waves};
use crate::passes::{edge_factors, inputs, on_gpu};

/// A torus in two halves of a material each, under these images; a row of edges between the halves twice.
fn halves(images: [&Arc<Texture>; 2]) -> (Loaded, Scene) {
    let mut mesh = Shape::Torus.build();
    let count = mesh.triangles.len() as u32;
    let half = |texture: &Arc<Texture>, triangles| Material {
        texture: Some(texture.clone()),
        triangles,
        ..mesh.materials[0].clone()
    };
    mesh.materials = vec![half(images[0], 0..count / 2), half(images[1], count / 2..count)];
    mesh.heights = Some(Arc::new(
        HeightSource::Materials
            .load(&mesh, &[], &mut Vec::new(), &Budget::unlimited(), &Progress::new())
            .expect("images"),
    ));
    on_device(Shape::Torus, mesh)
}

/// A torus in two halves of a material each, with images of their own or none.
fn halves_under(own: &[Option<HeightMap>; 2]) -> (Loaded, Scene) {
    parts_under(2, &[], own)
}

/// A torus in so many pieces of a material each, with parts of these numbers: first the materials and then the parts have images
/// of their own or none.
fn parts_under(materials: u32, parts: &[(Range<u32>, u32)], own: &[Option<HeightMap>]) -> (Loaded, Scene) {
    let mut mesh = Shape::Torus.build();
    let piece = mesh.triangles.len() as u32 / materials;
    let of = |first| Material { triangles: first * piece..(first + 1) * piece, ..mesh.materials[0].clone() };
    mesh.materials = (0..materials).map(of).collect();
    let range = |(triangles, part): &(Range<u32>, u32)| PartRange { triangles: triangles.clone(), part: *part };
    mesh.part_ranges = parts.iter().map(range).collect();
    let heights = Heights::of_materials(&mesh, own, &Progress::new()).expect("not cancelled").expect("few maps");
    mesh.heights = Some(Arc::new(heights));
    on_device(Shape::Torus, mesh)
}

/// Holds the device against the CPU, and checks that nothing cracks, in three ways to tessellate.
fn assert_without_cracks((loaded, scene): &mut (Loaded, Scene), what: &str) {
    let size = loaded.mesh.bounds().radius();
    for (lod, normals) in
        [(Lod::Uniform, Normals::Linear), (Lod::EdgeLength, Normals::Surface), (Lod::Error, Normals::Quadratic)]
    {
        let settings = Settings::from(Tessellation {
            displacement: Displacement::On,
            height_scale: 0.1,
            factor: 5.3,
            lod,
            normals,
            ..Tessellation::default()
        });
        let inputs = inputs(loaded, &settings);
        let gpu = on_gpu(scene, &inputs);
        // The device may compute factors in other last bits.
        let given = (lod != Lod::Uniform).then(|| edge_factors(scene));
        let cpu = tessellate(&loaded.mesh, &loaded.topology, &inputs, given.as_deref());
        let what = format!("{what} {lod:?} {normals:?}");
        assert!(gpu.patch_factors == cpu.patch_factors && gpu.vertices.len() == cpu.vertices.len(), "{what}");
        for (a, b) in gpu.vertices.iter().zip(&cpu.vertices) {
            let [p, q] = [a.position, b.position].map(glam::Vec3::from);
            assert!(p.distance(q) <= 1e-5 * size, "{what}: {p} {q}");
        }
        let measured = measured(scene, loaded, &settings);
        assert_eq!((measured.cracks.different_bits, measured.not_finite), (0, 0), "{what}");
    }
}

#[test]
fn materials_with_images_of_their_own_meet_without_cracks() {
    let amount = HeightAmount::from_factor(0.15, -0.05);
    let [deep, usual] = [waves(16).with_amount(amount), waves(64)];
    let same_pixels = usual.with_amount(amount);
    for own in [
        [Some(deep.clone()), Some(usual.clone())],
        [Some(usual.clone()), Some(same_pixels)],
        [Some(deep.clone()), None],
        [None, Some(usual)],
        [None, Some(deep)],
    ] {
        let amounts = own.each_ref().map(|map| map.as_ref().map(|map| map.amount));
        assert_without_cracks(&mut halves_under(&own), &format!("{amounts:?}"));
    }
}

#[test]
fn parts_with_images_of_their_own_meet_without_cracks_across_materials() {
    let amount = HeightAmount::from_factor(0.15, -0.05);
    let [deep, usual, fine] = [waves(16).with_amount(amount), waves(64), waves(32).with_amount(amount)].map(Some);
    // Both parts cross the materials' border at 128, and lie in several pieces.
    let parts = [(9..40, 0), (40..57, 1), (100..128, 0), (128..150, 0), (150..171, 1), (171..180, 2), (201..255, 1)];
    for own in [
        [usual.clone(), None, deep.clone(), fine.clone()],
        [None, fine, None, usual.clone()],
        [deep.clone(), usual.clone(), usual.clone(), None],
    ] {
        let amounts = own.each_ref().map(|map| map.as_ref().map(|map| map.amount));
        assert_without_cracks(&mut parts_under(2, &parts, &own), &format!("{amounts:?}"));
    }
    // Parts without materials of their own are displaced as materials are.
    let mut of_materials = halves_under(&[deep.clone(), usual.clone()]);
    let mut of_parts = parts_under(1, &[(0..128, 1), (128..256, 0)], &[None, usual, deep]);
    let displacement = Displacement::On;
    for lod in [Lod::Uniform, Lod::Error] {
        let settings = Settings::from(Tessellation { displacement, lod, ..Tessellation::default() });
        let [a, b] =
            [&mut of_materials, &mut of_parts].map(|(loaded, scene)| on_gpu(scene, &inputs(loaded, &settings)));
        let bits = |vertex: &Vertex| vertex.position.map(f32::to_bits);
        assert!(a.vertices.iter().map(bits).eq(b.vertices.iter().map(bits)), "{lod:?}");
        assert!(a.patch_factors == b.patch_factors, "{lod:?}");
    }
}

#[test]
fn an_amount_of_an_image_counts_as_that_of_the_settings_does() {
    let radius = Shape::Torus.build().bounds().radius();
    let own = waves(32).with_amount(Some(HeightAmount { scale: 0.05 * radius, midlevel: 0.25 }));
    let (said, mut of_settings) = halves_under(&[Some(waves(32)), Some(waves(32))]);
    let (_, mut of_image) = halves_under(&[Some(own.clone()), Some(own)]);
    for lod in [Lod::Uniform, Lod::Error] {
        let tessellation = |height_scale, midlevel| {
            let displacement = Displacement::On;
            let own = Tessellation { displacement, height_scale, midlevel, lod, ..Tessellation::default() };
            inputs(&said, &Settings::from(own))
        };
        let expected = on_gpu(&mut of_settings, &tessellation(0.05, 0.25));
        let made = on_gpu(&mut of_image, &tessellation(-0.7, 0.9));
        assert!(expected.patch_factors == made.patch_factors, "{lod:?}");
        let bits = |vertex: &Vertex| vertex.position.map(f32::to_bits);
        assert!(expected.vertices.iter().map(bits).eq(made.vertices.iter().map(bits)), "{lod:?}");
    }
}

#[test]
fn images_go_on_beyond_their_border_on_the_device_as_on_the_cpu() {
    let mut all = Vec::new();
    for wrap in [[Wrap::Clamp; 2], [Wrap::Mirror; 2], [Wrap::Repeat, Wrap::Clamp], [Wrap::Mirror, Wrap::Repeat]] {
        let mut mesh = Shape::Saddle.build();
        mesh.corners.iter_mut().for_each(|corner| corner.uv = corner.uv * 3.0 - 1.0);
        // Opposite borders differ.
        let ramp = HeightMap::new([16; 2], (0..256).map(|i| (i % 16 + 2 * (i / 16)) as f32 / 48.0).collect());
        mesh.heights = Some(Arc::new(Heights::everywhere(&mesh, ramp.with_wrap(wrap))));
        let (loaded, mut scene) = on_device(Shape::Saddle, mesh);
        let own =
            Tessellation { displacement: Displacement::On, height_scale: 0.1, factor: 7.0, ..Tessellation::default() };
        let inputs = inputs(&loaded, &Settings::from(own));
        let gpu = on_gpu(&mut scene, &inputs);
        let cpu = tessellate(&loaded.mesh, &loaded.topology, &inputs, None);
        assert_eq!(gpu.vertices.len(), cpu.vertices.len());
        for (a, b) in gpu.vertices.iter().zip(&cpu.vertices) {
            let [p, q] = [a.position, b.position].map(glam::Vec3::from);
            assert!(p.distance(q) <= 1e-5 * loaded.mesh.bounds().radius(), "{wrap:?}: {p} {q}");
        }
        all.push(gpu.vertices.iter().map(|vertex| vertex.position.map(f32::to_bits)).collect::<Vec<_>>());
    }
    assert!((0..4).all(|i| all[i + 1..].iter().all(|other| *other != all[i])), "each is another surface");
}

#[test]
fn maps_that_share_heights_are_on_the_device_once() {
    let own = waves(128);
    let bytes = |other: HeightMap| halves_under(&[Some(own.clone()), Some(other)]).1.tessellator.work_bytes();
    let one = bytes(own.clone());
    assert_eq!(bytes(own.with_amount(HeightAmount::from_factor(2.0, 0.0))), one);
    assert!(bytes(waves(128)) >= one + 4 * own.heights.len() as u64, "the same heights in two lists");
}

#[test]
fn lod_by_error_takes_the_amount_of_each_image() {
    let [deep, low] = [0.3, 0.02].map(|scale| waves(64).with_amount(HeightAmount::from_factor(scale, 0.0)));
    for own in [[&deep, &low], [&low, &deep]] {
        let (loaded, mut scene) = halves_under(&own.map(|map| Some(map.clone())));
        let settings = Settings::from(Tessellation {
            displacement: Displacement::On,
            lod: Lod::Error,
            tolerance: 2.0,
            ..Tessellation::default()
        });
        let inputs = inputs(&loaded, &settings);
        let device = on_gpu(&mut scene, &inputs);
        let host = tessellate(&loaded.mesh, &loaded.topology, &inputs, None);
        assert!(device.patch_factors == host.patch_factors, "CPU and GPU disagree");
        let halves = host.patch_factors.split_at(host.patch_factors.len() / 2);
        let [first, second] = [halves.0, halves.1]
            .map(|half: &[PatchFactors]| half.iter().map(|&own| u64::from(triangle_count(own))).sum::<u64>());
        assert_eq!(first > second, own[0] == &deep, "{first} and {second} triangles");
    }
}

#[test]
fn a_noisy_image_refines_its_own_patches_alone() {
    let image = |gray: &dyn Fn(u32) -> u32| {
        let rgba = (0..256 * 256).flat_map(|i| [gray(i) as u8, gray(i) as u8, gray(i) as u8, 255]).collect();
        Arc::new(Texture { size: [256, 256], rgba })
    };
    let slope = image(&|i| i % 256);
    let noise = image(&|i| if i < 256 { i } else { i.wrapping_mul(2_654_435_769) >> 24 });
    let own = Settings::from(Tessellation {
        displacement: Displacement::On,
        height_scale: 0.1,
        lod: Lod::Error,
        ..Tessellation::default()
    });
    for (surface, edges) in [(Surface::PnAen, Edges::PerEdge), (Surface::Flat, Edges::AsPublished)] {
        let settings = own.with(Tessellation { surface, edges, tolerance: 2.0, ..own.tessellation });
        let [(loaded, both), (_, smooth), (_, noisy)] =
            [[&noise, &slope], [&slope, &slope], [&noise, &noise]].map(|images| {
                let (loaded, mut scene) = halves(images);
                let inputs = inputs(&loaded, &settings);
                let device = on_gpu(&mut scene, &inputs);
                let host = tessellate(&loaded.mesh, &loaded.topology, &inputs, None);
                assert!(device.patch_factors == host.patch_factors, "{surface:?}: CPU and GPU disagree");
                (loaded, device.patch_factors)
            });
        let (mut alone, mut shared) = (0, 0);
        let (patches, half) = (&loaded.topology.patches, both.len() / 2);
        // Whether a patch has an edge with one of the other image.
        let is_beside_other = |index: usize| {
            let edge = |side: &u32| loaded.topology.sides[*side as usize].edge;
            let others = if index < half { &patches[half..] } else { &patches[..half] };
            let is_shared = |side| others.iter().flat_map(|patch| &patch.sides).any(|other| edge(other) == edge(side));
            patches[index].sides.iter().any(is_shared)
        };
        for index in half..both.len() {
            assert!(both[index].inside == smooth[index].inside, "{surface:?}: inside a patch of the smooth image");
            match is_beside_other(index) {
                true => shared += 1,
                false => alone += u32::from(both[index] == smooth[index]),
            }
        }
        assert_eq!(alone + shared, half as u32, "{surface:?}: as few as under the smooth image alone");
        assert!(
            shared > 0 && alone > 0,
            "{surface:?}: {shared} patches with an edge between materials, {alone} without"
        );
        for index in (0..half).filter(|index| !is_beside_other(*index)) {
            assert!(both[index] == noisy[index], "{surface:?}: as many as under the noisy image alone");
        }
        let triangles = |all: &[PatchFactors]| all.iter().map(|&own| u64::from(triangle_count(own))).sum::<u64>();
        let (noise_requests, slope_requests) = (triangles(&noisy), triangles(&smooth));
        assert!(noise_requests > 2 * slope_requests, "{surface:?}: {noise_requests} and {slope_requests}");
    }
}
