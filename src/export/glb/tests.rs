//! What is written is read back.

use std::sync::Arc;

use super::super::Exported;
use super::encode;
use crate::files::Limits;
use crate::load::mesh_file::load;
use crate::mesh::{Alpha, Look, Map, MapUv, Material, Mesh, Sampling, Shape, Slot, Texture, Wrap};
use crate::progress::Progress;

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
        triangles: triangles.collect(),
    }
}

fn read_back(mesh: &Mesh) -> Mesh {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("mesh.glb");
    std::fs::write(&path, encode(&untessellated(mesh), "mesh.glb").expect("a small mesh")).expect("a writable folder");
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
            maps: [
                own(&numbers, Sampling::default()),
                own(&normals, sampling),
                own(&numbers, Sampling::default()),
                None,
                None,
                None,
                None,
            ],
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
        (look.metallic, look.roughness, look.emissive, look.normal_scale, look.occlusion_strength, look.alpha)
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
}
