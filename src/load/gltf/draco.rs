//! Primitives that Draco compressed (`KHR_draco_mesh_compression`), decompressed by `draco-core` before anything is read of them.
//!
//! That library lets a caller say how many points and faces a stream may become. What it takes meanwhile it doesn't let one
//! say, so [`Header`] reads as much of a stream as tells, and nothing is decoded that the budget has no room for.
//!
//! Source: Khronos, `KHR_draco_mesh_compression`,
//! <https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos/KHR_draco_mesh_compression>.

mod header;

use std::collections::HashMap;

use ::gltf::accessor::{Accessor, DataType as Component};
use ::gltf::mesh::Mode;
use ::gltf::{Document, Primitive, Semantic};
use draco_core::{DataType, DecodeLimits, DecoderBuffer, ErrorKind, Mesh, MeshDecoder, PointAttribute, PointIndex};

use super::accessor::component;
use super::extensions::Packed;
use super::nodes::Placed;
use super::schema::DRACO;
use super::unpacked::{Attribute, Unpacked};
use super::{Accessors, Problem};
use crate::mesh::MemoryAccount;
use crate::progress::Progress;

use header::Header;

/// Why something isn't decompressed, as a clause.
enum DecodeError {
    /// It isn't what it should be.
    Wrong(String),
    /// There is no room for it.
    TooMuch(String),
}

impl From<String> for DecodeError {
    fn from(reason: String) -> Self {
        Self::Wrong(reason)
    }
}

/// Decompresses what is shown, by mesh and primitive.
///
/// # Errors
/// [`Problem::Document`] and [`Problem::Packed`] for the first that can't be, and [`Problem::Cancelled`].
pub fn unpack(
    accessors: &Accessors,
    document: &Document,
    placed: &Placed,
    packed: &[Vec<Option<Packed>>],
    progress: &Progress,
) -> Result<HashMap<[usize; 2], Unpacked>, Problem> {
    let mut unpacked = HashMap::new();
    let shown = placed.shown.iter().filter_map(|&node| document.nodes().nth(node)?.mesh());
    for (mesh, primitive) in shown.flat_map(|mesh| mesh.primitives().map(move |primitive| (mesh.index(), primitive))) {
        let place = [mesh, primitive.index()];
        let Some(packed) = packed.get(mesh).and_then(|mesh| mesh.get(place[1])?.as_ref()) else { continue };
        let is_read = !matches!(primitive.mode(), Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip);
        if !is_read || unpacked.contains_key(&place) {
            continue;
        }
        progress.check()?;
        let pointer = || format!("/meshes/{mesh}/primitives/{}/extensions/{DRACO}", place[1]);
        let made = Stream { accessors, primitive: &primitive, packed }.unpack().map_err(|fault| match fault {
            DecodeError::Wrong(reason) => Problem::Document { pointer: pointer(), reason },
            DecodeError::TooMuch(reason) => Problem::Packed { pointer: pointer(), reason },
        })?;
        unpacked.insert(place, made);
    }
    Ok(unpacked)
}

/// One primitive's data, compressed.
struct Stream<'a> {
    accessors: &'a Accessors<'a>,
    primitive: &'a Primitive<'a>,
    packed: &'a Packed,
}

impl Stream<'_> {
    fn unpack(&self) -> Result<Unpacked, DecodeError> {
        let [vertices, indices] = self.counts()?;
        let view = self.accessors.view(self.packed.view).ok_or_else(|| "has no buffer view".to_owned())?;
        let bytes = self.accessors.view_bytes(&view)?;
        let header = Header::read(bytes)?;
        header.check(vertices, indices)?;
        let attributes = self.attributes()?;
        let kept = attributes.iter().map(|(_, accessor)| 4 * width(accessor) as u64).sum::<u64>();
        // One that isn't read has four numbers at most.
        let passed_over = 16 * (self.packed.ids.len() - attributes.len() + self.packed.others) as u64;
        let most = (kept + passed_over).saturating_mul(vertices);
        let (budget, passing) = (self.accessors.budget, self.accessors.budget.borrowed());
        let room = budget.hold(kept.saturating_mul(vertices).saturating_add(indices.saturating_mul(4)));
        room.and_then(|()| budget.borrow(header.memory(bytes, most)))
            .map_err(|refused| DecodeError::TooMuch(refused.into()))?;
        let limits = DecodeLimits::default().with_max_points(vertices).with_max_faces(indices / 3);
        let mut buffer = DecoderBuffer::new(bytes).with_limits(limits.with_max_decoded_bytes(most));
        let mut mesh = Mesh::new();
        MeshDecoder::new().decode(&mut buffer, &mut mesh).map_err(|error| match error.kind() {
            ErrorKind::LimitExceeded => format!("becomes more than {vertices} vertices with the attributes it names"),
            _ => format!("can't be decompressed: its {} bytes aren't whole Draco data", bytes.len()),
        })?;
        let unpacked = taken(&mesh, &attributes, self.packed, [vertices as usize, indices as usize / 3])?;
        drop(mesh);
        budget.give_back_to(passing);
        Ok(unpacked)
    }

    /// How many vertices and indices the accessors say.
    fn counts(&self) -> Result<[u64; 2], String> {
        if self.primitive.mode() != Mode::Triangles {
            return Err("is of a strip or a fan, and only lists of triangles are read from there".to_owned());
        }
        let indices = self.primitive.indices().ok_or("is of a primitive without indices, which it always has")?;
        let positions = self.primitive.get(&Semantic::Positions).ok_or("is of a primitive without positions")?;
        Ok([positions.count() as u64, indices.count() as u64])
    }

    /// Those that are read from there.
    fn attributes(&self) -> Result<Vec<(String, Accessor<'_>)>, String> {
        let named = self.primitive.attributes().map(|(semantic, accessor)| (semantic.to_string(), accessor));
        let found: Vec<_> = named.filter(|(name, _)| self.packed.ids.contains_key(name)).collect();
        if !found.iter().any(|(name, _)| name == "POSITION") {
            return Err("names no POSITION among its attributes".to_owned());
        }
        // Without any, it stands for what the crate misses (see `document`).
        match found.iter().find(|(_, accessor)| accessor.sparse().is_some_and(|sparse| sparse.count() > 0)) {
            Some((name, _)) => Err(format!("holds {name}, whose accessor is sparse")),
            None => Ok(found),
        }
    }
}

/// Numbers of an element.
fn width(accessor: &Accessor) -> usize {
    accessor.dimensions().multiplicity()
}

/// What is read of a mesh, which must be of so many vertices and triangles.
fn taken(
    mesh: &Mesh,
    attributes: &[(String, Accessor)],
    packed: &Packed,
    [vertices, triangles]: [usize; 2],
) -> Result<Unpacked, String> {
    if [mesh.num_points(), mesh.num_faces()] != [vertices, triangles] {
        let (points, faces) = (mesh.num_points(), mesh.num_faces());
        return Err(format!(
            "holds {points} vertices and {faces} triangles, and its accessors say {vertices} and {triangles}"
        ));
    }
    let attribute = |(name, accessor): &(String, Accessor)| {
        let id = packed.ids[name];
        let from = mesh.attribute_by_unique_id(id);
        let from = from.ok_or_else(|| format!("says that {name} is attribute {id}, which its data doesn't have"))?;
        Ok(Attribute { name: name.clone(), width: width(accessor), values: values(name, from, accessor, vertices)? })
    };
    Ok(Unpacked {
        indices: mesh.faces().as_flattened().iter().map(|point| point.0).collect(),
        attributes: attributes.iter().map(attribute).collect::<Result<_, String>>()?,
    })
}

/// An attribute's numbers, one vertex after another, as its accessor says they are meant.
fn values(name: &str, from: &PointAttribute, accessor: &Accessor, vertices: usize) -> Result<Vec<f32>, String> {
    let (has, width) = (usize::from(from.num_components()), width(accessor));
    if has != width {
        return Err(format!("holds {has} numbers a vertex for {name}, and its accessor says {width}"));
    }
    let (kind, normalized) = (accessor.data_type(), accessor.normalized());
    let own = match from.data_type() {
        DataType::Int8 => Component::I8,
        DataType::Uint8 => Component::U8,
        DataType::Int16 => Component::I16,
        DataType::Uint16 => Component::U16,
        DataType::Uint32 => Component::U32,
        DataType::Float32 => Component::F32,
        other => return Err(format!("holds {name} as {other:?}, which no accessor can say")),
    };
    // Whole numbers may be stored wider than the accessor has them, but what a normalised one means depends on its width.
    if own != kind && (normalized || own == Component::F32) {
        return Err(format!("holds {name} as {own:?}, and its accessor says {kind:?}"));
    }
    let (size, data) = (own.size(), from.buffer().data());
    let mut values = Vec::with_capacity(vertices * width);
    for vertex in 0..vertices {
        let start = (from.mapped_index(PointIndex(vertex as u32)).0 as usize).checked_mul(width * size);
        let element = start.and_then(|start| data.get(start..)?.get(..width * size));
        let element = element.ok_or_else(|| format!("holds no {name} for vertex {vertex}"))?;
        values.extend(element.chunks_exact(size).map(|bytes| component(bytes, own, normalized)));
    }
    Ok(values)
}
