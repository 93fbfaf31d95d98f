//! PN-AEN index buffers as files: JSON that lists what the indices refer to, or the bare indices.

use std::fmt;
use std::path::Path;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use geometry::mesh::adjacency::Layout;
use geometry::mesh::{Mesh, Topology};

use crate::settings::choices;

choices! {
    /// The format of a file of indices.
    pub enum Format {
        Json => "json", "JSON", "The indices, the corners that they refer to, and the triangle of each patch.";
        Bin => "bin", "Binary", "Only the indices: 32-bit unsigned integers, little-endian.";
    }
}

impl Format {
    /// Returns the format that is written into a file of this name: bare indices for .bin, otherwise JSON.
    pub fn from_name(path: &Path) -> Self {
        if ends_in(path, "bin") { Self::Bin } else { Self::Json }
    }

    /// Returns the format of a file that is read. Text has no zero bytes, and bare indices have some unless all of them
    /// are beyond 16 million.
    fn from_file(path: &Path, bytes: &[u8]) -> Self {
        let is_text = bytes.trim_ascii_start().starts_with(b"{") && !bytes.contains(&0);
        if is_text || ends_in(path, "json") { Self::Json } else { Self::Bin }
    }
}

fn ends_in(path: &Path, ending: &str) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(ending))
}

/// Why a file isn't an index buffer of the mesh.
#[derive(Debug, PartialEq, Eq, Error)]
pub enum IndicesFault {
    #[error("this is not JSON as the adjacency command writes it ({0})")]
    Json(String),
    #[error("it has {given} indices per patch, but --indices asks for {computed}")]
    Layout { given: usize, computed: usize },
    #[error("it has {bytes} bytes, but {patches} patches of {per_patch} indices, 4 bytes each, take {expected}{hint}")]
    Size { bytes: usize, expected: usize, patches: usize, per_patch: usize, hint: Hint },
    #[error("it has {given} patches, but the mesh has {patches}{hint}")]
    Patches { given: usize, patches: usize, hint: Hint },
    #[error(
        "its {list} differ from the mesh's, first at index {at}: it was written for another mesh, or with another --weld"
    )]
    List { list: &'static str, at: usize },
    #[error("patch {patch} has {count} indices instead of {per_patch}")]
    Length { patch: usize, count: usize, per_patch: usize },
    #[error(
        "patch {patch} has index {index}, but the mesh's corners are 0 to {last}; indices refer to its distinct \
         corners, which the JSON lists"
    )]
    Range { patch: usize, index: u32, last: usize },
}

/// A possible reason for a wrong size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hint {
    None,
    /// The size is that of another layout.
    Layout(Layout),
    /// There are as many patches as triangles, although some triangles are degenerate and have no patch.
    Degenerate,
}

impl fmt::Display for Hint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => Ok(()),
            Self::Layout(layout) => write!(f, " (--indices {} would fit)", layout.per_patch()),
            Self::Degenerate => write!(f, " (degenerate triangles have no patch, and must be left out)"),
        }
    }
}

/// The JSON document. Lists that a file leaves out are not compared with the mesh.
#[derive(Debug, Serialize, Deserialize)]
struct Document {
    indices_per_patch: usize,
    /// The position of each corner's point, in object units. Indices refer to corners.
    positions: Option<Vec<[f32; 3]>>,
    normals: Option<Vec<[f32; 3]>>,
    uvs: Option<Vec<[f32; 2]>>,
    /// The mesh's own index buffer: the corners of every triangle, with degenerate ones.
    triangles: Option<Vec<[u32; 3]>>,
    /// The index of each patch's triangle. Degenerate triangles have no patch.
    patch_triangles: Option<Vec<u32>>,
    patches: Vec<Vec<u32>>,
}

impl Document {
    fn new(mesh: &Mesh, topology: &Topology, layout: Layout, indices: &[u32]) -> Self {
        // A weld tolerance moves corners to their points, and the points are what is tessellated.
        let position = |&point: &u32| topology.points[point as usize].to_array();
        Self {
            indices_per_patch: layout.per_patch(),
            positions: Some(topology.corner_points.iter().map(position).collect()),
            normals: Some(mesh.corners.iter().map(|corner| corner.normal.to_array()).collect()),
            uvs: Some(mesh.corners.iter().map(|corner| corner.uv.to_array()).collect()),
            triangles: Some(mesh.triangles.to_vec()),
            patch_triangles: Some(topology.patches.iter().map(|patch| patch.triangle).collect()),
            patches: indices.chunks(layout.per_patch()).map(<[u32]>::to_vec).collect(),
        }
    }

    /// Compares the lists with the mesh's.
    ///
    /// # Errors
    /// A list differs.
    fn check_lists(&self, mesh: &Mesh, topology: &Topology, layout: Layout) -> Result<(), IndicesFault> {
        let own = Self::new(mesh, topology, layout, &[]);
        same("positions", &self.positions, &own.positions)?;
        same("normals", &self.normals, &own.normals)?;
        same("uvs", &self.uvs, &own.uvs)?;
        same("triangles", &self.triangles, &own.triangles)?;
        same("patch_triangles", &self.patch_triangles, &own.patch_triangles)
    }
}

fn same<T: PartialEq>(list: &'static str, given: &Option<Vec<T>>, own: &Option<Vec<T>>) -> Result<(), IndicesFault> {
    let (Some(given), Some(own)) = (given, own) else { return Ok(()) };
    if given == own {
        return Ok(());
    }
    let at = given.iter().zip(own).take_while(|(given, own)| given == own).count();
    Err(IndicesFault::List { list, at })
}

/// Returns a JSON document of a mesh's indices, with a line end. Numbers are written so that they read back exactly.
///
/// # Errors
/// None occur: every key is a plain name.
pub fn to_json(mesh: &Mesh, topology: &Topology, layout: Layout, indices: &[u32]) -> serde_json::Result<String> {
    let text = serde_json::to_string(&Document::new(mesh, topology, layout, indices))?;
    Ok(text + "\n")
}

/// Returns the bare indices.
pub fn to_bin(indices: &[u32]) -> Vec<u8> {
    indices.iter().flat_map(|index| index.to_le_bytes()).collect()
}

/// Reads the indices of a mesh's patches from a file's bytes. The file is JSON if its name ends in .json or its text
/// starts with a brace, otherwise bare indices.
///
/// # Errors
/// The file doesn't hold the indices of this mesh's patches in this layout.
pub fn read(
    path: &Path,
    bytes: &[u8],
    mesh: &Mesh,
    topology: &Topology,
    layout: Layout,
) -> Result<Vec<u32>, IndicesFault> {
    let indices = match Format::from_file(path, bytes) {
        Format::Json => read_json(bytes, mesh, topology, layout)?,
        Format::Bin => read_bin(bytes, mesh, topology, layout)?,
    };
    let corners = mesh.corners.len();
    if let Some(place) = indices.iter().position(|&index| index as usize >= corners) {
        let (patch, index) = (place / layout.per_patch(), indices[place]);
        return Err(IndicesFault::Range { patch, index, last: corners.saturating_sub(1) });
    }
    Ok(indices)
}

fn read_json(bytes: &[u8], mesh: &Mesh, topology: &Topology, layout: Layout) -> Result<Vec<u32>, IndicesFault> {
    let document: Document = serde_json::from_slice(bytes).map_err(|error| IndicesFault::Json(error.to_string()))?;
    let per_patch = layout.per_patch();
    if document.indices_per_patch != per_patch {
        return Err(IndicesFault::Layout { given: document.indices_per_patch, computed: per_patch });
    }
    let (given, patches) = (document.patches.len(), topology.patches.len());
    if given != patches {
        let hint = if given == mesh.triangles.len() { Hint::Degenerate } else { Hint::None };
        return Err(IndicesFault::Patches { given, patches, hint });
    }
    document.check_lists(mesh, topology, layout)?;
    if let Some(patch) = document.patches.iter().position(|patch| patch.len() != per_patch) {
        return Err(IndicesFault::Length { patch, count: document.patches[patch].len(), per_patch });
    }
    Ok(document.patches.concat())
}

fn read_bin(bytes: &[u8], mesh: &Mesh, topology: &Topology, layout: Layout) -> Result<Vec<u32>, IndicesFault> {
    let (patches, per_patch) = (topology.patches.len(), layout.per_patch());
    let expected = 4 * per_patch * patches;
    if bytes.len() != expected {
        let fits = |other: &Layout| 4 * other.per_patch() * patches == bytes.len();
        let hint = match Layout::ALL.into_iter().find(fits) {
            Some(other) => Hint::Layout(other),
            None if bytes.len() == 4 * per_patch * mesh.triangles.len() => Hint::Degenerate,
            None => Hint::None,
        };
        return Err(IndicesFault::Size { bytes: bytes.len(), expected, patches, per_patch, hint });
    }
    let index = |bytes: &[u8]| bytes.try_into().map_or(0, u32::from_le_bytes);
    Ok(bytes.chunks_exact(4).map(index).collect())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::measure::index_differences;
    use geometry::mesh::adjacency::Part;
    use geometry::mesh::{Corner, Shape};
    use geometry::progress::Progress;

    fn shape(shape: Shape) -> (Mesh, Topology) {
        let mesh = shape.build();
        let topology = Topology::build(&mesh, &Progress::new()).unwrap();
        (mesh, topology)
    }

    /// Three triangles, the middle one of which is degenerate.
    fn with_degenerate() -> (Mesh, Topology) {
        let at =
            |x: f32, y: f32| Corner { position: glam::vec3(x, y, 0.0), normal: glam::Vec3::Z, uv: glam::Vec2::ZERO };
        let corners = vec![at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0), at(1.0, 1.0)];
        let mesh = Mesh { corners, triangles: vec![[0, 1, 2], [1, 1, 2], [1, 3, 2]].into(), ..Mesh::default() };
        let topology = Topology::build(&mesh, &Progress::new()).unwrap();
        (mesh, topology)
    }

    #[test]
    fn indices_are_read_back() {
        for (mesh, topology) in Shape::ALL.map(shape) {
            for layout in Layout::ALL {
                let indices = layout.indices(&topology);
                let json = to_json(&mesh, &topology, layout, &indices).unwrap();
                let bin = to_bin(&indices);
                assert_eq!(bin.len(), 4 * layout.per_patch() * topology.patches.len());
                for (name, bytes) in [("a.json", json.as_bytes()), ("a", json.as_bytes()), ("a.bin", &bin), ("-", &bin)]
                {
                    let read = read(name.as_ref(), bytes, &mesh, &topology, layout);
                    assert_eq!(read.as_ref(), Ok(&indices), "{} {layout:?} {name}", mesh.name);
                }
            }
        }
    }

    #[test]
    fn bare_indices_are_little_endian() {
        assert_eq!(to_bin(&[1, 0x0403_0201]), [1, 0, 0, 0, 1, 2, 3, 4]);
    }

    /// Byte 123 is an opening brace.
    #[test]
    fn bare_indices_that_start_with_a_brace_are_not_taken_for_json() {
        let bin = to_bin(&[123, 5, 6]);
        assert_eq!(Format::from_file("indices".as_ref(), &bin), Format::Bin);
        assert_eq!(Format::from_file("indices".as_ref(), b" {\"patches\": []}"), Format::Json);
        assert_eq!(Format::from_file("INDICES.JSON".as_ref(), b"text"), Format::Json);
        assert_eq!(Format::from_file("indices.bin".as_ref(), b""), Format::Bin);
    }

    /// Compares with a file of meshoptimizer's indices. Where the Möbius strip is joined, neighbours run along their edge in
    /// the same direction, which meshoptimizer takes for a boundary, so the indices differ there.
    #[test]
    fn meshoptimizers_indices_are_equal_where_neighbours_are_wound_alike() {
        for source in Shape::ALL {
            let (mesh, topology) = shape(source);
            let positions: Vec<u8> =
                mesh.corners.iter().flat_map(|c| c.position.to_array()).flat_map(f32::to_ne_bytes).collect();
            let vertices = meshopt::VertexDataAdapter::new(&positions, 12, 0).unwrap();
            let theirs = meshopt::generate_tessellation_indices(mesh.triangles.as_flattened(), &vertices);
            let read = read("theirs".as_ref(), &to_bin(&theirs), &mesh, &topology, Layout::Twelve).unwrap();
            let computed = Layout::Twelve.indices(&topology);
            let differences = index_differences(&mesh, &topology, Layout::Twelve, &read, &computed);
            // The join consists of two edges, each with two sides.
            let expected = if source == Shape::Moebius { 4 } else { 0 };
            assert_eq!(differences.len(), expected, "{}: {differences:?}", source.name());
            assert!(differences.iter().all(|difference| matches!(difference.part, Part::Side(_))), "{differences:?}");
        }
    }

    #[test]
    fn a_document_lists_the_triangle_of_each_patch() {
        let (mesh, topology) = with_degenerate();
        let indices = Layout::Six.indices(&topology);
        let json: serde_json::Value =
            serde_json::from_str(&to_json(&mesh, &topology, Layout::Six, &indices).unwrap()).unwrap();
        assert_eq!(json["triangles"], serde_json::json!([[0, 1, 2], [1, 1, 2], [1, 3, 2]]));
        assert_eq!(json["patch_triangles"], serde_json::json!([0, 2]));
        assert_eq!(json["patches"], serde_json::json!([[0, 1, 1, 2, 2, 0], [1, 3, 3, 2, 2, 1]]));
        assert_eq!(json["positions"][3], serde_json::json!([1.0, 1.0, 0.0]));
        assert_eq!(["normals", "uvs"].map(|list| json[list].as_array().map(Vec::len)), [Some(4), Some(4)]);
    }

    #[test]
    fn positions_are_those_of_points_under_a_weld_tolerance() {
        let (mut mesh, _) = with_degenerate();
        Arc::make_mut(&mut mesh.triangles)[2] = [4, 3, 2];
        mesh.corners.push(Corner { position: glam::vec3(1.0, 1e-4, 0.0), ..mesh.corners[1] });
        let topology = Topology::build_within(&mesh, 1e-3, &Progress::new()).unwrap();
        let document = Document::new(&mesh, &topology, Layout::Six, &[]);
        assert_eq!(document.positions.map(|positions| positions[4]), Some([1.0, 0.0, 0.0]));
    }

    #[test]
    fn every_fault_has_its_error() {
        let (mesh, topology) = with_degenerate();
        let fault = |bytes: &[u8], layout| read("file".as_ref(), bytes, &mesh, &topology, layout).unwrap_err();
        let size = |bytes, hint| IndicesFault::Size { bytes, expected: 72, patches: 2, per_patch: 9, hint };
        for (bytes, hint) in [
            (0, Hint::None),
            (71, Hint::None),
            (96, Hint::Layout(Layout::Twelve)),
            (48, Hint::Layout(Layout::Six)),
            (108, Hint::Degenerate),
            (144, Hint::Layout(Layout::Eighteen)),
            (148, Hint::None),
        ] {
            assert_eq!(fault(&vec![0; bytes], Layout::Nine), size(bytes, hint));
        }
        let mut indices = Layout::Nine.indices(&topology);
        indices[10] = 4;
        assert_eq!(fault(&to_bin(&indices), Layout::Nine), IndicesFault::Range { patch: 1, index: 4, last: 3 });

        let text = |patches: &str| format!("{{\"indices_per_patch\": 6, \"patches\": [{patches}]}}").into_bytes();
        let two = "[0, 1, 1, 2, 2, 0], [1, 3, 3, 2, 2, 1]";
        assert_eq!(fault(&text(two), Layout::Nine), IndicesFault::Layout { given: 6, computed: 9 });
        assert!(read("file".as_ref(), &text(two), &mesh, &topology, Layout::Six).is_ok(), "lists may be left out");
        let patches = |given, hint| IndicesFault::Patches { given, patches: 2, hint };
        assert_eq!(fault(&text("[]"), Layout::Six), patches(1, Hint::None));
        assert_eq!(fault(&text("[], [], []"), Layout::Six), patches(3, Hint::Degenerate));
        let short = IndicesFault::Length { patch: 1, count: 5, per_patch: 6 };
        assert_eq!(fault(&text("[0, 1, 1, 2, 2, 0], [1, 3, 3, 2, 2]"), Layout::Six), short);
        for text in [&b"{}"[..], b"{\"indices_per_patch\": -6}", b"{\"indices_per_patch\": 6, \"patches\": [[0.5]]}"] {
            assert!(matches!(fault(text, Layout::Six), IndicesFault::Json(_)));
        }
    }

    #[test]
    fn a_document_of_another_mesh_is_recognised_by_its_lists() {
        let (mesh, topology) = with_degenerate();
        let indices = Layout::Nine.indices(&topology);
        let json = to_json(&mesh, &topology, Layout::Nine, &indices).unwrap();
        for (old, new, list, at) in [
            ("[1.0,1.0,0.0]", "[1.0,2.0,0.0]", "positions", 3),
            (",[0.0,0.0,1.0]],\"uvs\"", "],\"uvs\"", "normals", 3),
            ("\"uvs\":[[0.0,0.0]", "\"uvs\":[[0.0,1.0]", "uvs", 0),
            ("[1,1,2],", "", "triangles", 1),
            ("\"patch_triangles\":[0,2]", "\"patch_triangles\":[0,1]", "patch_triangles", 1),
        ] {
            assert!(json.contains(old), "{old} is not in {json}");
            let read = read("a.json".as_ref(), json.replace(old, new).as_bytes(), &mesh, &topology, Layout::Nine);
            assert_eq!(read, Err(IndicesFault::List { list, at }));
        }
    }
}
