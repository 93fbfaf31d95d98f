//! Exported shaders: those of tessellation stages run on the driver's own, and those of compute passes on a device of their own.

use std::rc::Rc;

use documents::assert_part_of_page;
use geometry::mesh::adjacency::Layout;
use geometry::mesh::{Mesh, Shape, Topology};
use geometry::progress::Progress;
use geometry::tessellate::{
    Clip, Convention, Edges, Lod, Normals, Partitioning, Surface, Tessellation, corner_weights, tessellate,
};
use inspect::settings::Choice;
use inspect::shader_files::{Language, shader_files};

use crate::engine;
use crate::vulkan::Vulkan;
use crate::vulkan::agreement::Agreement;
use crate::vulkan::exported::{LANGUAGES, Subject, rows, table};

// The example is a crate of its own.
#[allow(unreachable_pub)]
#[path = "../../examples/exported.rs"]
mod example;

use example::Passes;

pub(super) fn vulkan() -> Rc<Vulkan> {
    Vulkan::new(&engine().gpu.info).expect("a driver with tessellation stages")
}

/// Same factors, same triangles, positions within 4 ULP and normals within those of 32 bits: as our passes and the CPU.
fn assert_agrees(own: &Agreement, what: &str) {
    assert!(own.triangles > 0, "{what}: nothing came out");
    assert_eq!(own.other_triangles, 0, "{what}: {own:?}");
    // A few divisions, a matrix and a square root, each to within a few ULP.
    assert!(own.factors <= 1e-5, "{what}: {own:?}");
    // What is left after sums of up to ten products that one side may fuse and the other not.
    assert!(own.position_ulps <= 4.0, "{what}: {own:?}");
    // Ours have 32 bits.
    assert!(own.normals <= 2e-4, "{what}: {own:?}");
}

#[test]
fn every_surface_and_lod_agrees_with_our_passes_and_the_page_says_so() {
    let mut subject = Subject::new(engine(), &vulkan(), Shape::CubeSplit.build()).expect("a small mesh");
    let rows = rows(&mut subject).expect("shaders that run");
    for row in &rows {
        let what = format!("{:?} {:?} {:?}", row.surface, row.lod, row.language);
        assert_agrees(&row.agreement, &what);
        assert!(row.agreement.shared > 50, "{what}: {:?}", row.agreement);
        assert_eq!(row.agreement.torn > 0, row.surface.tears(), "{what}: {:?}", row.agreement);
    }
    assert_eq!(rows.len(), Surface::ALL.len() * (Lod::ALL.len() - 1) * LANGUAGES.len());
    assert_part_of_page("docs/results/shaders.md", "table of agreement", &table(&rows));
}

#[test]
fn partitionings_conventions_normals_and_culling_agree_too() {
    let near = Tessellation { lod: Lod::Distance, factor: 9.0, near: 2.0, far: 6.0, ..Tessellation::default() };
    let mut tried = Vec::new();
    for partitioning in Partitioning::DIRECT3D {
        tried.push(Tessellation { partitioning, ..near });
    }
    for convention in Convention::ALL {
        tried.push(Tessellation { convention, ..near });
    }
    for normals in [Normals::Quadratic, Normals::Surface] {
        tried.push(Tessellation { normals, ..near });
    }
    tried.push(Tessellation { edges: Edges::AsPublished, lod: Lod::Paper, pixels: 30.0, ..near });
    tried.push(Tessellation { cull_back_faces: true, clip: Clip::Frustum, ..near });
    tried.push(Tessellation { clip: Clip::Paper, ..near });
    let mut subject = Subject::new(engine(), &vulkan(), Shape::Torus.build()).expect("a small mesh");
    for own in tried {
        for language in LANGUAGES {
            let weights = |domain| corner_weights(own.convention, domain);
            let agreement = subject.agreement(language, &own, &weights).expect("shaders that run");
            let what = format!("{own:?} {language:?}");
            assert_agrees(&agreement, &what);
            let is_whole = own.edges == Edges::PerEdge && own.convention.is_consistent();
            assert!(!is_whole || agreement.torn == 0, "{what}: {agreement:?}");
        }
    }
}

/// The corners of a mesh as exported shaders read them: position, normal and texture coordinates.
pub(super) fn exported_corners(mesh: &Mesh, topology: &Topology) -> Vec<[f32; 8]> {
    let corners = mesh.corners.iter().zip(&topology.corner_points);
    let numbers = corners.map(|(corner, &point)| {
        let ([x, y, z], [a, b, c]) = (topology.points[point as usize].into(), corner.normal.into());
        [x, y, z, a, b, c, corner.uv.x, corner.uv.y]
    });
    numbers.collect()
}

/// Runs exported compute passes as the example does. Returns the vertices and the triangles.
fn run_passes(text: &str, mesh: &Mesh, topology: &Topology, own: &Tessellation) -> (Vec<[f32; 8]>, Vec<[u32; 3]>) {
    let corners = exported_corners(mesh, topology);
    let mut constants = [0.0f32; 48];
    constants[40..45].copy_from_slice(&[own.factor, own.pixels, own.near, own.far, own.alpha]);
    let passes = Passes::new(text, &corners, &Layout::Nine.indices(topology), [20_000, 40_000]).expect("pipelines");
    passes.run(&corners, &constants).expect("a readback")
}

#[test]
fn exported_compute_passes_make_our_triangles() {
    for shape in [Shape::CubeSplit, Shape::Moebius] {
        let mesh = shape.build();
        let topology = Topology::build(&mesh, &Progress::new()).expect("not cancelled");
        for partitioning in Partitioning::ALL {
            let surface = if shape == Shape::Moebius { Surface::PnCrease } else { Surface::PnAen };
            let own = Tessellation { surface, partitioning, factor: 5.3, ..Tessellation::default() };
            let files = shader_files(Language::Wgsl, &own, "a test").expect("WGSL of any pattern");
            let (vertices, triangles) = run_passes(&files[0].text, &mesh, &topology, &own);
            let view = geometry::tessellate::LodView::new(glam::Mat4::IDENTITY, glam::Vec2::ONE);
            let cpu = tessellate(&mesh, &topology, &geometry::tessellate::Inputs::new(&own, view), None);
            let what = format!("{shape:?} {partitioning:?}");
            assert!(triangles == cpu.triangles, "{what}: triangles");
            assert_eq!(vertices.len(), cpu.vertices.len(), "{what}");
            let bound = 4.0 * geometry::view::ulp(&topology);
            for (own, other) in vertices.iter().zip(&cpu.vertices) {
                for (x, y) in own.iter().zip(other.position) {
                    assert!(f64::from((x - y).abs()) <= bound, "{what}: {own:?} {other:?}");
                }
            }
        }
    }
}

#[test]
fn the_example_has_the_passes_that_are_exported_and_makes_its_moments() {
    let command = "pnaen shaders --language wgsl -o examples/exported";
    let files = shader_files(Language::Wgsl, &Tessellation::default(), command).expect("WGSL");
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/exported");
    for file in files {
        let path = folder.join(file.name);
        if std::env::var_os("PNAEN_UPDATE_PAGES").is_some() {
            std::fs::write(&path, &file.text).expect("the file can be written");
        }
        let there = std::fs::read_to_string(&path).expect("the file");
        assert!(there == file.text, "{} is out of date; PNAEN_UPDATE_PAGES=1 writes it", path.display());
    }
    let moments = example::moments().expect("the passes run");
    let heights = moments.iter().map(|(vertices, _)| vertices.iter().fold(0.0f32, |most, own| most.max(own[1])));
    let triangles: Vec<_> = moments.iter().map(|(_, triangles)| triangles.len()).collect();
    assert!(triangles[0] >= 8 * 4 && triangles.is_sorted() && triangles[3] > 8 * 150, "{triangles:?}");
    assert!(heights.zip([1.0, 1.2, 1.4, 1.6]).all(|(own, tip)| (own - tip).abs() < 1e-6), "the tip moves");
}

#[test]
fn what_hardware_has_no_equal_of_is_refused_with_what_can_be_exported() {
    let refused =
        |language, own: Tessellation| shader_files(language, &own, "a test").expect_err("refused").to_string();
    for language in Language::ALL {
        let by_error = refused(language, Tessellation { lod: Lod::Error, ..Tessellation::default() });
        assert!(by_error.contains("LOD by error") && by_error.contains("--lod uniform"), "{by_error}");
    }
    for partitioning in [Partitioning::Rows, Partitioning::Subtriangulation] {
        for language in LANGUAGES {
            let said = refused(language, Tessellation { partitioning, ..Tessellation::default() });
            assert!(said.contains(partitioning.name()) && said.contains("--language wgsl"), "{said}");
        }
    }
}
