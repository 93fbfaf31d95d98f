//! What is collected of emitted vertices, and what is said.

use super::*;
use geometry::mesh::{Light, LightKind, Shape};
use geometry::progress::Progress;
use geometry::tessellate::{Inputs, LodView, Normals, Tessellation, tessellate};

fn exported(mesh: &Mesh, normals: Normals) -> (Vec<Vec3>, Tessellated) {
    let topology = Topology::build(mesh, &Progress::new()).expect("nobody cancels");
    let tessellation = Tessellation { normals, factor: 4.0, ..Tessellation::default() };
    let tessellated = tessellate(mesh, &topology, &Inputs::new(&tessellation, LodView::default()), None);
    (Exported::new(mesh, &topology, &tessellated).normals, tessellated)
}

#[test]
fn normals_are_those_that_were_emitted() {
    let mesh = Shape::CubeSmooth.build();
    for kind in [Normals::Linear, Normals::Quadratic, Normals::Surface] {
        let (normals, tessellated) = exported(&mesh, kind);
        for (normal, vertex) in normals.iter().zip(&tessellated.vertices) {
            let emitted = unpack_normal(vertex.normal);
            assert!(normal.cross(emitted).length() < PACKING_ERROR && normal.dot(emitted) > 0.0, "{normal} {emitted}");
        }
    }
}

#[test]
fn an_obj_file_says_what_it_cannot_hold() {
    let mut mesh = Shape::CubeSmooth.build();
    assert_eq!(obj::left_out(&mesh, "a.obj"), None);
    let (kind, place) = (LightKind::Directional, Vec3::ZERO);
    mesh.lights = vec![Light { kind, intensity: Vec3::ONE, place, direction: Vec3::NEG_Z }];
    let said = "a.obj: the mesh is written without its lights; a .glb file holds them.";
    assert_eq!(obj::left_out(&mesh, "a.obj").as_deref(), Some(said));
    let white = CornerDetail::default();
    mesh.details =
        Some(std::sync::Arc::new(vec![CornerDetail { color: 0.5 * white.color, ..white }; mesh.corners.len()]));
    mesh.materials.push(geometry::mesh::Material::plain("second", [1.0; 4]));
    let said = "without its materials, the colours of its vertices and its lights; a .glb file holds them.";
    assert!(obj::left_out(&mesh, "a.obj").is_some_and(|own| own.ends_with(said)));
}
