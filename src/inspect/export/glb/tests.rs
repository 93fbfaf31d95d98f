//! What is written is read back.

use std::sync::Arc;

use glam::{Vec2, Vec3, Vec4};

use super::super::Exported;
use super::encode;
use geometry::mesh::{
    Alpha, CornerDetail, Light, LightKind, Look, Map, MapUv, Material, Mesh, Sampling, Shape, Slot, Texture, Wrap,
};
use geometry::progress::Progress;
use load::files::Limits;
use load::mesh_file::load;

/// A mesh as it is, as if every factor were 1.
fn untessellated(mesh: &Mesh) -> Exported<'_> {
    let triangles = mesh.materials.iter().map(|material| {
        let range = material.triangles.start as usize..material.triangles.end as usize;
        mesh.triangles[range].to_vec()
    });
    Exported {
        mesh,
        positions: mesh.corners.iter().map(|corner| corner.position).collect(),
        normals: mesh.corners.iter().map(|corner| corner.normal).collect(),
        uvs: mesh.corners.iter().map(|corner| corner.uv).collect(),
        details: mesh.details.as_ref().map(|details| details.to_vec()).unwrap_or_default(),
        triangles: triangles.collect(),
    }
}

fn read_back(mesh: &Mesh) -> Mesh {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("mesh.glb");
    let (bytes, warnings) = encode(&untessellated(mesh), "mesh.glb").expect("a small mesh");
    assert_eq!(warnings, [""; 0]);
    std::fs::write(&path, bytes).expect("a writable folder");
    let loaded = load(&path, &Limits::default(), &Progress::new()).expect("a valid file");
    assert_eq!(loaded.warnings, [""; 0]);
    loaded.mesh
}

#[test]
fn a_material_comes_back_with_its_numbers_and_maps() {
    let mut mesh = Shape::Torus.build();
    let image = |byte| Arc::new(Texture { size: [1, 1], rgba: vec![byte; 4] });
    let sampling =
        Sampling { wrap: [Wrap::Clamp, Wrap::Mirror], magnify_linear: false, minify_linear: true, mip_linear: None };
    let (normals, numbers) = (image(130), image(77));
    let own = |texture: &Arc<Texture>, sampling| Some(Map { texture: texture.clone(), uv: MapUv::Own, sampling });
    let triangles = mesh.materials[0].triangles.clone();
    mesh.materials[0] = Material {
        texture: Some(numbers.clone()),
        sampling,
        double_sided: true,
        look: Look {
            metallic: 0.25,
            roughness: 0.75,
            emissive: [0.5, 0.0, 1.0],
            normal_scale: 2.0,
            occlusion_strength: 0.5,
            alpha: Alpha::Mask(0.375),
            clearcoat: 0.5,
            clearcoat_normal_scale: 0.25,
            sheen_color: [1.0; 3],
            anisotropy: 1.0,
            maps: Slot::ALL.map(|slot| match slot {
                Slot::Normal | Slot::ClearcoatNormal => own(&normals, sampling),
                Slot::Transmission | Slot::Thickness => None,
                _ => own(&numbers, Sampling::default()),
            }),
            ..Look::default()
        },
        triangles,
        ..Material::plain("leather", [0.5, 0.25, 0.125, 1.0])
    };
    let read = read_back(&mesh);
    let [given, got] = [&mesh.materials[0], &read.materials[0]];
    assert_eq!((&got.name, got.base_color, got.double_sided), (&given.name, given.base_color, true));
    assert_eq!(got.sampling, sampling);
    let numbers_of = |look: &Look| {
        let scales = [look.normal_scale, look.clearcoat_normal_scale];
        (look.metallic, look.roughness, look.emissive, scales, look.occlusion_strength, look.alpha)
    };
    assert_eq!(numbers_of(&got.look), numbers_of(&given.look));
    for slot in Slot::ALL {
        let [given, got] = [given, got].map(|material| material.look.maps[slot as usize].as_ref());
        let parts = |map: &Map| (map.texture.rgba.clone(), map.uv, map.sampling);
        assert_eq!(got.map(parts), given.map(parts), "{slot:?}");
    }
    let shared =
        [got.texture.as_ref(), got.look.maps[0].as_ref().map(|map| &map.texture)].map(|image| image.map(Arc::as_ptr));
    assert_eq!(shared[0], shared[1], "an image is written once");
}

#[test]
fn what_blends_and_what_transmits_light_come_back() {
    let mut mesh = Shape::Torus.build();
    mesh.materials[0].look.alpha = Alpha::Blend;
    mesh.materials[0].base_color = [0.25, 0.5, 0.75, 0.5];
    let read = read_back(&mesh);
    assert_eq!((read.materials[0].look.alpha, read.materials[0].base_color), (Alpha::Blend, [0.25, 0.5, 0.75, 0.5]));
    assert_eq!(read.materials[0].look.transmission, 0.0);
    let image = Arc::new(Texture { size: [1, 1], rgba: vec![77; 4] });
    let map = Map { texture: image, uv: MapUv::Own, sampling: Sampling::default() };
    let mut look = Look { transmission: 0.625, roughness: 0.0, ..Look::default() };
    look.maps[Slot::Transmission as usize] = Some(map);
    mesh.materials[0].look = look;
    let read = read_back(&mesh).materials.remove(0).look;
    assert_eq!((read.alpha, read.transmission), (Alpha::Opaque, 0.625));
    let map = read.maps[Slot::Transmission as usize].as_ref().expect("a map");
    assert_eq!((&map.texture.rgba, map.uv), (&vec![77; 4], MapUv::Own));
    // A body that absorbs nothing has no distance, which JSON couldn't hold.
    for attenuation_distance in [0.75, f32::INFINITY] {
        let look = &mut mesh.materials[0].look;
        (look.thickness, look.attenuation_distance, look.attenuation_color) = (2.5, attenuation_distance, [0.5; 3]);
        let read = read_back(&mesh).materials.remove(0).look;
        let found = (read.thickness, read.attenuation_distance, read.attenuation_color);
        assert_eq!(found, (2.5, attenuation_distance, [0.5; 3]));
    }
}

#[test]
fn numbers_of_extensions_come_back() {
    let mut mesh = Shape::Torus.build();
    let look = Look {
        emissive: [0.0, 3.0, 6.0],
        ior: 1.25,
        specular: 0.75,
        specular_color: [1.0, 0.5, 2.0],
        clearcoat: 0.5,
        clearcoat_roughness: 0.25,
        sheen_color: [0.25, 0.5, 0.0],
        sheen_roughness: 0.375,
        anisotropy: 0.75,
        anisotropy_rotation: -2.0,
        ..Look::default()
    };
    mesh.materials[0].look = look.clone();
    let read = read_back(&mesh).materials.remove(0).look;
    let numbers = |look: &Look| {
        let colors = [look.emissive, look.specular_color, look.sheen_color];
        let coat = [look.clearcoat, look.clearcoat_roughness];
        let long = [look.anisotropy, look.anisotropy_rotation];
        (colors, coat, long, [look.ior, look.specular, look.sheen_roughness], look.unlit)
    };
    assert_eq!(numbers(&read), numbers(&look));
    mesh.materials[0].look = Look { unlit: true, ..Look::default() };
    let read = read_back(&mesh).materials.remove(0).look;
    assert_eq!((read.unlit, read.ior, read.has_sheen(), read.clearcoat), (true, 1.5, false, 0.0));
}

/// Details that differ at every corner: both sets of texture coordinates, a colour, and a tangent.
fn detailed(mesh: &mut Mesh) {
    let detail = |(i, corner): (usize, &geometry::mesh::Corner)| CornerDetail {
        uvs: [Vec2::new(i as f32, 0.25), Vec2::new(0.5, -(i as f32))],
        color: Vec4::new(0.5, 0.25, i as f32 / 4096.0, 1.0),
        tangent: corner.normal.any_orthonormal_vector(),
        bitangent_sign: if i.is_multiple_of(2) { 1.0 } else { -1.0 },
    };
    mesh.details = Some(Arc::new(mesh.corners.iter().enumerate().map(detail).collect()));
}

/// What the corners of each triangle have.
fn at_triangles(mesh: &Mesh) -> Vec<CornerDetail> {
    let details = mesh.details.as_ref().expect("it has details");
    mesh.triangles.iter().flatten().map(|corner| details[*corner as usize]).collect()
}

#[test]
fn further_texture_coordinates_colours_and_tangents_come_back() {
    let image = Arc::new(Texture { size: [1, 1], rgba: vec![128; 4] });
    let map = |uv| Some(Map { texture: image.clone(), uv, sampling: Sampling::default() });
    let [still, moved] = [[1.0, 0.0, 0.0, 0.0, 1.0, 0.0], [2.0, 0.0, 0.5, 0.0, 3.0, 0.25]];
    // With an image of the base colour, corners have its transformed texture coordinates, and each set may be used beside it.
    let cases = [
        (true, [(Slot::Normal, MapUv::Set(0, still)), (Slot::Occlusion, MapUv::Set(1, moved))]),
        (true, [(Slot::Normal, MapUv::Own), (Slot::Occlusion, MapUv::Set(1, moved))]),
        (false, [(Slot::Normal, MapUv::Own), (Slot::Occlusion, MapUv::Set(1, still))]),
    ];
    for (has_base, maps) in cases {
        let mut mesh = Shape::CubeSplit.build();
        detailed(&mut mesh);
        mesh.materials[0].texture = has_base.then(|| image.clone());
        for (slot, uv) in maps {
            mesh.materials[0].look.maps[slot as usize] = map(uv);
        }
        let read = read_back(&mesh);
        let corner_uvs = |mesh: &Mesh| -> Vec<Vec2> {
            mesh.triangles.iter().flatten().map(|corner| mesh.corners[*corner as usize].uv).collect()
        };
        assert_eq!(corner_uvs(&read), corner_uvs(&mesh));
        for (given, got) in at_triangles(&mesh).into_iter().zip(at_triangles(&read)) {
            assert_eq!((got.color, got.bitangent_sign), (given.color, given.bitangent_sign));
            assert!(got.tangent.abs_diff_eq(given.tangent, 1e-6), "{} became {}", given.tangent, got.tangent);
        }
        let placed = |mesh: &Mesh, set: usize| -> Vec<Vec2> {
            at_triangles(mesh).iter().map(|detail| detail.uvs[set]).collect()
        };
        for (slot, given) in maps {
            let got = read.materials[0].look.maps[slot as usize].as_ref().expect("a map").uv;
            let (MapUv::Set(from, given), MapUv::Set(set, got)) = (given, got) else {
                assert_eq!(given, got, "{slot:?}");
                continue;
            };
            assert!(given.iter().zip(got).all(|(given, got)| (given - got).abs() < 1e-6), "{slot:?}: {got:?}");
            assert_eq!(placed(&read, set), placed(&mesh, from), "{slot:?}");
        }
    }
}

#[test]
fn lights_come_back() {
    let mut mesh = Shape::Icosahedron.build();
    let direction = Vec3::new(1.0, -2.0, 0.5).normalize();
    let light = |kind, intensity| Light { kind, intensity, place: Vec3::new(1.0, 2.0, -3.0), direction };
    mesh.lights = vec![
        light(LightKind::Directional, Vec3::new(4.0, 2.0, 1.0)),
        light(LightKind::Point { range: Some(5.0) }, Vec3::splat(0.5)),
        light(LightKind::Spot { range: None, inner: 0.25, outer: 0.5 }, Vec3::ZERO),
    ];
    let read = read_back(&mesh).lights;
    assert_eq!(read.len(), 3);
    for (given, got) in mesh.lights.iter().zip(&read) {
        assert_eq!((got.kind, got.intensity, got.place), (given.kind, given.intensity, given.place));
        assert!(got.direction.abs_diff_eq(direction, 1e-6), "{}", got.direction);
    }
}

#[test]
fn a_map_that_is_sheared_is_left_out_with_a_warning() {
    let mut mesh = Shape::Icosahedron.build();
    mesh.details = Some(Arc::new(vec![CornerDetail::default(); mesh.corners.len()]));
    let texture = Arc::new(Texture { size: [1, 1], rgba: vec![128; 4] });
    let uv = MapUv::Set(1, [1.0, 0.5, 0.0, 0.0, 1.0, 0.0]);
    mesh.materials[0].look.maps[Slot::Occlusion as usize] = Some(Map { texture, uv, sampling: Sampling::default() });
    let (_, warnings) = encode(&untessellated(&mesh), "mesh.glb").expect("a small mesh");
    assert!(matches!(&warnings[..], [warning] if warning.contains("can't shear")), "{warnings:?}");
}
