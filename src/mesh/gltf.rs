//! glTF 2.0, as text and binary: every triangle of the default scene, at rest.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use glam::{Vec2, Vec3};
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::{Data, Source as BufferSource};
use gltf::mesh::Mode;

use super::gltf_accessors::{Problem, check};
use super::gltf_pose::{Placement, Pose, morph, skin_matrices};
use super::merge::Merge;
use super::normals::smooth_normals;
use super::{Corner, LoadError, Material, Mesh, Progress, Texture};

/// Extensions that a file may require: they change only how a surface is lit.
const HARMLESS: [&str; 2] = ["KHR_materials_", "KHR_lights_punctual"];

/// Loads a document. `folder` is where its other files are; `path` and `name` are for messages and for people.
///
/// # Errors
/// See [`LoadError`].
pub fn load(
    bytes: &[u8],
    folder: Option<&Path>,
    path: &str,
    name: String,
    progress: &Progress,
) -> Result<Mesh, LoadError> {
    let invalid = |reason: String| LoadError::Invalid { path: path.to_owned(), reason };
    let gltf::Gltf { document, blob } = parse(bytes).map_err(invalid)?;
    let buffers = load_buffers(&document, blob, folder, path, progress)?;
    let damaged = |place: String| {
        move |reason: Problem| LoadError::Damaged { path: path.to_owned(), place: place.clone(), reason }
    };
    let pose = Pose::new(&document).map_err(damaged("the scene's nodes".into()))?;
    let mut loader =
        Loader { buffers: &buffers, folder, soup: Soup::default(), materials: Materials::default(), other: 0 };
    let nodes = scene_nodes(&document);
    for (index, node) in nodes.iter().enumerate() {
        progress.set(0.2 + 0.5 * index as f32 / nodes.len() as f32);
        let Some(mesh) = node.mesh() else { continue };
        for primitive in mesh.primitives() {
            progress.check()?;
            let place = format!("primitive {} of mesh {}", primitive.index(), mesh.name().unwrap_or("without a name"));
            loader.primitive(&pose, node, &mesh, &primitive).map_err(damaged(place))?;
        }
    }
    if loader.soup.triangles.is_empty() {
        let instead = match loader.other {
            0 => String::new(),
            count => format!(", only {count} primitives of points or lines"),
        };
        return Err(LoadError::Empty { path: path.to_owned(), instead });
    }
    progress.set(0.7);
    progress.check()?;
    Ok(loader.finish(name))
}

/// The document, checked by the `gltf` crate but for extensions, which are checked here.
fn parse(bytes: &[u8]) -> Result<gltf::Gltf, String> {
    let gltf = gltf::Gltf::from_slice_without_validation(bytes).map_err(|error| error.to_string())?;
    let required = gltf.document.extensions_required();
    let unknown: Vec<&str> =
        required.filter(|name| !HARMLESS.iter().any(|harmless| name.starts_with(harmless))).collect();
    if !unknown.is_empty() {
        return Err(format!("it requires {}, which pnaen doesn't know", unknown.join(", ")));
    }
    let mut json = gltf.document.into_json();
    json.extensions_required.clear();
    let document = gltf::Document::from_json(json).map_err(|error| match error {
        gltf::Error::Validation(errors) => match errors.first() {
            Some((place, error)) => format!("{place}: {error}"),
            None => "it breaks its own rules".into(),
        },
        error => error.to_string(),
    })?;
    Ok(gltf::Gltf { document, blob: gltf.blob })
}

fn load_buffers(
    document: &gltf::Document,
    mut blob: Option<Vec<u8>>,
    folder: Option<&Path>,
    path: &str,
    progress: &Progress,
) -> Result<Vec<Data>, LoadError> {
    let mut buffers = Vec::new();
    for buffer in document.buffers() {
        progress.check()?;
        let problem = |reason: String| LoadError::Buffer { path: path.to_owned(), buffer: buffer.index(), reason };
        let source = buffer.source();
        let named = match source {
            BufferSource::Uri(uri) if !uri.starts_with("data:") => format!("{uri}: "),
            _ => String::new(),
        };
        let data = Data::from_source_and_blob(source, folder, &mut blob)
            .map_err(|error| problem(format!("{named}{error}")))?;
        if data.len() < buffer.length() {
            return Err(problem(format!("{named}it has {} bytes of {}", data.len(), buffer.length())));
        }
        buffers.push(data);
        progress.set(0.2 * buffers.len() as f32 / document.buffers().len() as f32);
    }
    Ok(buffers)
}

/// Nodes of the default scene, or of the first one; without scenes, all nodes.
fn scene_nodes(document: &gltf::Document) -> Vec<gltf::Node<'_>> {
    let Some(scene) = document.default_scene().or_else(|| document.scenes().next()) else {
        return document.nodes().collect();
    };
    let mut nodes = Vec::new();
    let mut stack: Vec<_> = scene.nodes().collect();
    stack.reverse();
    while let Some(node) = stack.pop() {
        let first = stack.len();
        stack.extend(node.children());
        stack[first..].reverse();
        nodes.push(node);
    }
    nodes
}

/// Triangles before normals are complete.
#[derive(Default)]
struct Soup {
    triangles: Vec<SoupTriangle>,
    /// Normals that were there but of no use.
    useless: usize,
}

struct SoupTriangle {
    material: usize,
    positions: [Vec3; 3],
    normals: [Option<Vec3>; 3],
    uvs: [Vec2; 3],
}

/// The materials in use, in order of first use, and the images they share.
#[derive(Default)]
struct Materials {
    used: Vec<Material>,
    known: HashMap<Option<usize>, usize>,
    images: HashMap<usize, Option<Arc<Texture>>>,
    warnings: Vec<String>,
}

struct Loader<'a> {
    buffers: &'a [Data],
    folder: Option<&'a Path>,
    soup: Soup,
    materials: Materials,
    /// Primitives of points and lines.
    other: usize,
}

impl Loader<'_> {
    fn primitive(
        &mut self,
        pose: &Pose,
        node: &gltf::Node,
        mesh: &gltf::Mesh,
        primitive: &gltf::Primitive,
    ) -> Result<(), Problem> {
        let triangles: fn(&[u32]) -> Vec<[u32; 3]> = match primitive.mode() {
            Mode::Triangles => list,
            Mode::TriangleStrip => strip,
            Mode::TriangleFan => fan,
            Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => {
                self.other += 1;
                return Ok(());
            }
        };
        let mut vertices = Vertices::read(primitive, self.buffers)?;
        let weights = node.weights().or_else(|| mesh.weights()).unwrap_or_default();
        morph(primitive, weights, &mut vertices.positions, vertices.normals.as_mut(), self.buffers)?;
        let placement = self.placement(pose, node, primitive, vertices.positions.len())?;
        vertices.place(&placement)?;
        let indices = read_indices(primitive, vertices.positions.len(), self.buffers)?;
        let material = self.materials.index(&primitive.material(), self.buffers, self.folder);
        for mut triangle in triangles(&indices) {
            if placement.mirrors() {
                triangle.swap(1, 2);
            }
            self.soup.push(material, &vertices, triangle);
        }
        Ok(())
    }

    fn placement(
        &self,
        pose: &Pose,
        node: &gltf::Node,
        primitive: &gltf::Primitive,
        count: usize,
    ) -> Result<Placement, Problem> {
        if let Some(skin) = node.skin() {
            let joints = pose.joint_matrices(&skin, self.buffers)?;
            if let Some(matrices) = skin_matrices(primitive, &joints, count, self.buffers)? {
                return Ok(Placement::Skin(matrices));
            }
        }
        Ok(Placement::Node(pose.global(node)))
    }

    fn finish(self, name: String) -> Mesh {
        let Self { soup, materials: Materials { used, mut warnings, .. }, other, .. } = self;
        if soup.useless > 0 {
            warnings.push(format!("{} normals were zero or not finite; smooth ones stand in for them", soup.useless));
        }
        if other > 0 {
            warnings.push(format!("{other} primitives of points or lines were left out"));
        }
        let missing = soup.triangles.iter().any(|triangle| triangle.normals.contains(&None));
        let positions: Vec<_> = soup.triangles.iter().map(|triangle| triangle.positions).collect();
        let smooth = if missing { smooth_normals(&positions) } else { Vec::new() };
        let mut merge = Merge::default();
        for (index, triangle) in soup.triangles.iter().enumerate() {
            let corner = |k: usize| Corner {
                position: triangle.positions[k],
                normal: triangle.normals[k].unwrap_or_else(|| smooth[index][k]),
                uv: triangle.uvs[k],
            };
            merge.push(triangle.material, [corner(0), corner(1), corner(2)]);
        }
        merge.finish(name, used, warnings)
    }
}

impl Soup {
    fn push(&mut self, material: usize, vertices: &Vertices, triangle: [u32; 3]) {
        let at = triangle.map(|index| index as usize);
        let normals = at.map(|index| {
            let given = vertices.normals.as_ref().map(|normals| normals[index])?;
            let unit = given.try_normalize();
            self.useless += usize::from(unit.is_none());
            unit
        });
        let uvs = at.map(|index| vertices.uvs.get(index).copied().unwrap_or_default());
        let positions = at.map(|index| vertices.positions[index]);
        self.triangles.push(SoupTriangle { material, positions, normals, uvs });
    }
}

/// A primitive's vertices.
struct Vertices {
    positions: Vec<Vec3>,
    normals: Option<Vec<Vec3>>,
    /// As many as there are positions, or none.
    uvs: Vec<Vec2>,
}

impl Vertices {
    fn read(primitive: &gltf::Primitive, buffers: &[Data]) -> Result<Self, Problem> {
        let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(|data| &data[..]));
        let accessor = primitive.get(&gltf::Semantic::Positions).ok_or("has no positions")?;
        check(&accessor, buffers, &[DataType::F32], Dimensions::Vec3)?;
        let positions: Vec<Vec3> = reader.read_positions().into_iter().flatten().map(Vec3::from).collect();
        let same_count = |what: &str, count: usize| {
            let expected = positions.len();
            if count == expected { Ok(()) } else { Err(format!("has {count} {what} for {expected} positions")) }
        };
        let normals = match primitive.get(&gltf::Semantic::Normals) {
            Some(accessor) => {
                check(&accessor, buffers, &[DataType::F32], Dimensions::Vec3)?;
                let normals: Vec<Vec3> = reader.read_normals().into_iter().flatten().map(Vec3::from).collect();
                same_count("normals", normals.len())?;
                Some(normals)
            }
            None => None,
        };
        let set = primitive.material().pbr_metallic_roughness().base_color_texture().map_or(0, |info| info.tex_coord());
        let uvs = match primitive.get(&gltf::Semantic::TexCoords(set)) {
            Some(accessor) => {
                let types = [DataType::F32, DataType::U8, DataType::U16];
                check(&accessor, buffers, &types, Dimensions::Vec2)?;
                let read = reader.read_tex_coords(set).map(|uvs| uvs.into_f32().map(Vec2::from).collect::<Vec<_>>());
                let uvs = read.unwrap_or_default();
                same_count("texture coordinates", uvs.len())?;
                // A texture coordinate that is not a number shows nothing anyway.
                uvs.into_iter().map(|uv| if uv.is_finite() { uv } else { Vec2::ZERO }).collect()
            }
            None => Vec::new(),
        };
        Ok(Self { positions, normals, uvs })
    }

    fn place(&mut self, placement: &Placement) -> Result<(), Problem> {
        for (vertex, position) in self.positions.iter_mut().enumerate() {
            *position = placement.position(vertex, *position);
            if !position.is_finite() {
                return Err(format!("has a position that is not finite (vertex {vertex})"));
            }
        }
        for (vertex, normal) in self.normals.iter_mut().flatten().enumerate() {
            *normal = placement.normal(vertex, *normal);
        }
        Ok(())
    }
}

/// A primitive's indices, or one for each vertex in turn.
fn read_indices(primitive: &gltf::Primitive, count: usize, buffers: &[Data]) -> Result<Vec<u32>, Problem> {
    let Some(accessor) = primitive.indices() else { return Ok((0..count as u32).collect()) };
    check(&accessor, buffers, &[DataType::U8, DataType::U16, DataType::U32], Dimensions::Scalar)?;
    let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(|data| &data[..]));
    let indices: Vec<u32> = reader.read_indices().into_iter().flat_map(|indices| indices.into_u32()).collect();
    match indices.iter().find(|&&index| index as usize >= count) {
        Some(index) => Err(format!("has index {index}, but only {count} vertices")),
        None => Ok(indices),
    }
}

fn list(indices: &[u32]) -> Vec<[u32; 3]> {
    indices.as_chunks().0.to_vec()
}

/// Every second triangle is turned, so that all are wound as the first (glTF 2.0, section 3.7.2.1).
fn strip(indices: &[u32]) -> Vec<[u32; 3]> {
    let turned = |(i, window): (usize, &[u32])| [window[0], window[1 + i % 2], window[2 - i % 2]];
    indices.windows(3).enumerate().map(turned).collect()
}

fn fan(indices: &[u32]) -> Vec<[u32; 3]> {
    let Some((&hub, rim)) = indices.split_first() else { return Vec::new() };
    rim.windows(2).map(|pair| [pair[0], pair[1], hub]).collect()
}

impl Materials {
    /// The place of a material among those in use.
    fn index(&mut self, material: &gltf::Material, buffers: &[Data], folder: Option<&Path>) -> usize {
        if let Some(&index) = self.known.get(&material.index()) {
            return index;
        }
        let name = material.name().map_or_else(
            || material.index().map_or_else(|| "default".to_owned(), |index| format!("material {index}")),
            str::to_owned,
        );
        let pbr = material.pbr_metallic_roughness();
        let texture = pbr.base_color_texture().and_then(|info| self.image(&info.texture().source(), buffers, folder));
        let base_color = pbr.base_color_factor();
        self.used.push(Material { name, base_color, texture, triangles: 0..0 });
        self.known.insert(material.index(), self.used.len() - 1);
        self.used.len() - 1
    }

    /// An image's pixels; one that can't be had is a warning.
    fn image(&mut self, image: &gltf::Image, buffers: &[Data], folder: Option<&Path>) -> Option<Arc<Texture>> {
        if let Some(known) = self.images.get(&image.index()) {
            return known.clone();
        }
        let decoded = match decode(image, buffers, folder) {
            Ok(texture) => Some(Arc::new(texture)),
            Err(problem) => {
                self.warnings.push(problem);
                None
            }
        };
        self.images.insert(image.index(), decoded.clone());
        decoded
    }
}

fn decode(image: &gltf::Image, buffers: &[Data], folder: Option<&Path>) -> Result<Texture, String> {
    let (name, bytes) = match image.source() {
        gltf::image::Source::View { view, .. } => {
            let data = buffers.get(view.buffer().index());
            let end = view.offset().checked_add(view.length());
            let bytes = data.zip(end).and_then(|(data, end)| data.get(view.offset()..end));
            (
                format!("image {}", image.index()),
                bytes.map(<[u8]>::to_vec).ok_or("it lies outside its buffer".to_owned()),
            )
        }
        gltf::image::Source::Uri { uri, .. } => {
            // Buffers and images name their files the same way.
            let data = Data::from_source_and_blob(BufferSource::Uri(uri), folder, &mut None);
            let name = if uri.starts_with("data:") { format!("image {}", image.index()) } else { uri.to_owned() };
            (name, data.map(|data| data.0).map_err(|error| error.to_string()))
        }
    };
    let missing =
        |reason: String| format!("texture {name} could not be read ({reason}); its material is shown without");
    let bytes = bytes.map_err(missing)?;
    let pixels = image::load_from_memory(&bytes).map_err(|error| missing(error.to_string()))?.to_rgba8();
    Ok(Texture { size: [pixels.width(), pixels.height()], rgba: pixels.into_raw() })
}

#[cfg(test)]
mod tests;
