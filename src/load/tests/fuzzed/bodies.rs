//! The code that each fuzz target runs with its bytes, in a fuzzer or in the tests.
#![allow(dead_code, reason = "each target runs one of them")]

use std::collections::HashMap;
use std::path::Path;

use geometry::mesh::{Mesh, Topology};
use geometry::progress::Progress;
use geometry::tessellate::domain::{domain_plan, domain_point, domain_triangle};
use geometry::tessellate::factors::{outer_count, point_count, triangle_count};
use geometry::tessellate::hull_factors::HullFactors;
use geometry::tessellate::{Partitioning, PatchFactors};
use load::Limits;
use load::environment_file::EnvironmentFile;
use load::format::Format;
use load::mesh_file::read;
use load::selection::Selection;

/// The greatest number of triangles for which a topology is built; larger meshes take too long for a fuzzer.
const MOST_TRIANGLES: usize = 1 << 14;

/// The number 1 in the tessellator's fixed-point coordinates.
const ONE: i64 = 1 << 16;

/// The path that bytes are read with which aren't those of a file. No files are beside it.
pub(crate) const NOWHERE: &str = "nowhere/fuzzed";

/// Hands every target to a macro: its name, how many changed copies tests try, and what runs with the bytes of a file and its path.
macro_rules! targets {
    ($each:ident) => {
        $each! {
            gltf 10_000 |data: &[u8], path: &str| bodies::mesh(Format::Gltf, data, path);
            glb 10_000 bodies::glb;
            fbx 10_000 |data: &[u8], path: &str| bodies::mesh(Format::Fbx, data, path);
            obj 10_000 |data: &[u8], path: &str| bodies::mesh(Format::Obj, data, path);
            stl 10_000 |data: &[u8], path: &str| bodies::mesh(Format::Stl, data, path);
            ply 10_000 |data: &[u8], path: &str| bodies::mesh(Format::Ply, data, path);
            off 10_000 |data: &[u8], path: &str| bodies::mesh(Format::Off, data, path);
            threemf 10_000 |data: &[u8], path: &str| bodies::mesh(Format::ThreeMf, data, path);
            panorama 1000 bodies::panorama;
            factors 200 bodies::factors;
        }
    };
}
pub(crate) use targets;

/// Reads bytes as a `.glb`, whatever they start with.
pub(crate) fn glb(data: &[u8], path: &str) -> bool {
    let mut data = data.to_vec();
    data.iter_mut().zip(b"glTF").for_each(|(byte, own)| *byte = *own);
    mesh(Format::Gltf, &data, path)
}

/// Reads bytes as a file, which must give a valid mesh or an error. Returns whether it is a mesh.
pub(crate) fn mesh(format: Format, data: &[u8], path: &str) -> bool {
    let progress = Progress::new();
    let result = read(format, data.to_vec(), Path::new(path), Selection::default(), &Limits::default(), &progress);
    match &result {
        Ok(loaded) => assert_sound(&loaded.mesh, &progress),
        Err(error) => assert_short(&error.to_string().replace(path, "it")),
    }
    result.is_ok()
}

/// A message is one line, of a length that can be read.
fn assert_short(said: &str) {
    assert!(said.chars().count() < 500 && !said.contains(char::is_control), "{said:?}");
}

fn assert_sound(mesh: &Mesh, progress: &Progress) {
    let corners = mesh.corners.len() as u32;
    assert!(!mesh.triangles.is_empty() && mesh.triangles.as_flattened().iter().all(|&corner| corner < corners));
    let fit = |normal: glam::Vec3| (normal.as_dvec3().length() - 1.0).abs() < 1e-3;
    assert!(mesh.corners.iter().all(|corner| corner.position.is_finite() && corner.uv.is_finite()));
    assert!(mesh.corners.iter().all(|corner| fit(corner.normal)));
    let end = mesh.materials.iter().fold(0, |end, material| {
        assert_eq!(material.triangles.start, end);
        material.triangles.end
    });
    assert_eq!(end as usize, mesh.triangles.len());
    if mesh.triangles.len() <= MOST_TRIANGLES {
        let topology = Topology::build(mesh, progress).expect("nobody cancels");
        assert_eq!(topology.patches.len() + topology.degenerate as usize, mesh.triangles.len());
    }
}

/// Reads bytes as a panorama, which must give light or an error: its pixels are finite and not negative. Returns whether it is light.
pub(crate) fn panorama(data: &[u8], _: &str) -> bool {
    let result = EnvironmentFile::read(data, &Limits::default(), &Progress::new());
    match &result {
        Ok(file) => {
            let [width, height] = file.size();
            assert!(width > 0 && height > 0);
            assert!(file.radiance().all(|channel| channel.is_finite() && channel >= 0.0));
            file.warnings.iter().for_each(|said| assert_short(said));
        }
        Err(fault) => assert_short(&fault.to_string()),
    }
    result.is_ok()
}

/// Tessellates with four factors of any bits, in every partitioning, before and after the rounding of a shader
/// compiler. Returns whether there are four.
pub(crate) fn factors(data: &[u8], _: &str) -> bool {
    let Some((bits, _)) = data.split_first_chunk::<16>() else { return false };
    let [a, b, c, inside] = [0, 4, 8, 12].map(|i| f32::from_le_bytes([bits[i], bits[i + 1], bits[i + 2], bits[i + 3]]));
    for partitioning in Partitioning::ALL {
        let hull = HullFactors { edges: [a, b, c], inside };
        pattern(hull.process(partitioning));
        pattern(hull.rounded(partitioning).process(partitioning));
    }
    true
}

/// Checks that there are as many points and triangles as the formulas say, and that they form one disc that fills the
/// patch.
fn pattern(factors: PatchFactors) {
    let (points, triangles) = (point_count(factors), triangle_count(factors));
    if points == 0 {
        assert_eq!(triangles, 0);
        return;
    }
    let plan = domain_plan(factors);
    let at: Vec<[i64; 2]> = (0..points).map(|i| domain_point(&plan, i).map(i64::from)).collect();
    assert!(at.iter().all(|&[u, v]| u <= ONE && v <= ONE && u + v <= ONE), "{factors:?}");
    let mut sides: HashMap<[u32; 2], u32> = HashMap::new();
    let (mut area, mut used) = (0, vec![false; points as usize]);
    for t in 0..triangles {
        let triangle = domain_triangle(&plan, t);
        assert!(triangle.iter().all(|&point| point < points), "{factors:?}: {triangle:?} of {points}");
        triangle.iter().for_each(|&point| used[point as usize] = true);
        let [a, b, c] = triangle.map(|point| at[point as usize]);
        area += (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        for k in 0..3 {
            *sides.entry([triangle[k], triangle[(k + 1) % 3]]).or_default() += 1;
        }
    }
    assert!(used.iter().all(|used| *used), "{factors:?}: a point without a triangle");
    assert_eq!(area.abs(), ONE * ONE, "{factors:?}: twice the area of all triangles");
    let open = sides.keys().filter(|[a, b]| !sides.contains_key(&[*b, *a])).count() as u32;
    assert!(sides.values().all(|uses| *uses == 1), "{factors:?}: a side that two triangles run in one direction");
    assert_eq!(open, outer_count(factors), "{factors:?}: sides on the outline");
    // Euler's formula: a disc has two triangles for each point, minus a number that depends on its outline.
    assert_eq!(triangles + 2 + open, 2 * points, "{factors:?}");
}
