//! Decompresses primitives that are compressed with Draco (`KHR_draco_mesh_compression`), with the crate `draco-core`,
//! before anything else reads them.
//!
//! The crate can limit the number of faces and the size of the result, but not the memory that it takes meanwhile. So [`memory`]
//! bounds that by what the data says about itself, and nothing is decoded that the budget has no room for.
//!
//! Source: Khronos, `KHR_draco_mesh_compression`,
//! <https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos/KHR_draco_mesh_compression>.

mod header;
mod memory;
mod tables;

use std::collections::HashMap;

use ::gltf::accessor::{Accessor, DataType as Component};
use ::gltf::mesh::Mode;
use ::gltf::{Document, Primitive, Semantic};
use draco_core::{DataType, DecodeLimits, DecoderBuffer, ErrorKind, Mesh, MeshDecoder, PointAttribute, PointIndex};

use super::accessor::{DataError, DecompressedPrimitive, component};
use super::extensions::DracoExtension;
use super::nodes::Placed;
use super::schema::{DRACO, is_detail};
use super::{Accessors, GltfError};
use crate::memory_budget::Budget;
use geometry::casts::{to_u32, to_usize};
use geometry::mesh::{Borrowed, MemoryRefused};
use geometry::progress::Progress;

use header::Header;
use memory::decoding_bytes;

/// Decompresses the primitives that are shown, by mesh and primitive.
///
/// # Errors
/// [`GltfError::Document`] or [`GltfError::Draco`] for the first primitive that can't be decompressed, and
/// [`GltfError::Cancelled`].
pub(super) fn unpack(
    accessors: &Accessors,
    document: &Document,
    placed: &Placed,
    packed: &[Vec<Option<DracoExtension>>],
    progress: &Progress,
) -> Result<HashMap<[usize; 2], DecompressedPrimitive>, GltfError> {
    let mut unpacked = HashMap::new();
    for mesh in placed.meshes(document) {
        for (primitive, packed) in mesh.primitives().zip(packed.get(mesh.index()).into_iter().flatten()) {
            let Some(packed) = packed else { continue };
            progress.check()?;
            let place = [mesh.index(), primitive.index()];
            let pointer = format!("/meshes/{}/primitives/{}/extensions/{DRACO}", place[0], place[1]);
            let stream = Stream { accessors, primitive: &primitive, packed, pointer: &pointer };
            let made = stream.unpack().map_err(|error| match error {
                DataError::Here(reason) => GltfError::Document { pointer: pointer.clone(), reason },
                DataError::Elsewhere(error) => error,
            })?;
            unpacked.insert(place, made);
        }
    }
    Ok(unpacked)
}

/// The compressed data of one primitive.
struct Stream<'a> {
    accessors: &'a Accessors<'a>,
    primitive: &'a Primitive<'a>,
    packed: &'a DracoExtension,
    /// Its place in the document.
    pointer: &'a str,
}

impl Stream<'_> {
    fn unpack(&self) -> Result<DecompressedPrimitive, DataError> {
        let [vertices, indices] = self.counts()?;
        let view = self.accessors.view(self.packed.view).ok_or_else(|| "has no buffer view".to_owned())?;
        let bytes = self.accessors.view_bytes(&view)?;
        let header = Header::read(bytes)?;
        header.check(vertices, indices)?;
        let attributes = self.attributes()?;
        let kept = attributes.iter().map(|(_, accessor)| 4 * width(accessor) as u64).sum::<u64>();
        // An attribute that isn't read has at most four numbers.
        let passed_over = 16 * (self.packed.len() - attributes.len()) as u64;
        let most = (kept + passed_over).saturating_mul(vertices);
        let walked = tables::walk(bytes, &header);
        let own = kept.saturating_mul(vertices).saturating_add(indices.saturating_mul(4));
        // The decoder frees all but the result before this is copied.
        let peak = decoding_bytes(&header, &walked, bytes.len() as u64, vertices, most).max(own);
        let budget = self.accessors.budget;
        let decoding_memory = Borrowed::from(budget);
        budget.borrow(peak).map_err(|refused| self.too_large(too_much(refused, budget)))?;
        let stride = walked.attributes.map(|all| all.iter().map(|coded| coded.components * coded.size).sum::<u64>());
        let most = stride.map_or(most, |stride| most.min(stride.saturating_mul(vertices)));
        let limits = DecodeLimits::default().with_max_points(vertices).with_max_faces(indices / 3);
        let mut buffer = DecoderBuffer::new(bytes).with_limits(limits.with_max_decoded_bytes(most));
        let mut mesh = Mesh::new();
        MeshDecoder::new().decode(&mut buffer, &mut mesh).map_err(|error| match error.kind() {
            ErrorKind::LimitExceeded => format!("decompresses to more than {vertices} vertices"),
            _ => format!("can't be decompressed: its {} bytes aren't complete Draco data", bytes.len()),
        })?;
        let unpacked = taken(&mesh, &attributes, self.packed, [to_usize(vertices), to_usize(indices) / 3])?;
        drop(mesh);
        drop(decoding_memory);
        budget.hold(unpacked.bytes()).map_err(|refused| self.too_large(refused.into()))?;
        Ok(unpacked)
    }

    fn too_large(&self, reason: String) -> GltfError {
        GltfError::Draco { pointer: self.pointer.to_owned(), reason }
    }

    /// Returns the numbers of vertices and indices in the accessors.
    fn counts(&self) -> Result<[u64; 2], DataError> {
        if self.primitive.mode() != Mode::Triangles {
            let reason = "belongs to a strip or a fan, but only compressed lists of triangles are read";
            return Err(reason.to_owned().into());
        }
        let lacks = |what: &str| format!("belongs to a primitive without {what}");
        let indices = self.primitive.indices().ok_or_else(|| lacks("indices, which Draco needs"))?;
        let positions = self.primitive.get(&Semantic::Positions).ok_or_else(|| lacks("positions"))?;
        self.accessors.check_sound(&positions)?;
        self.accessors.check_sound(&indices)?;
        Ok([positions.count() as u64, indices.count() as u64])
    }

    /// Returns the attributes that are read from the compressed data.
    fn attributes(&self) -> Result<Vec<(String, Accessor<'_>)>, DataError> {
        let named = self.primitive.attributes().map(|(semantic, accessor)| (semantic.to_string(), accessor));
        let found: Vec<_> = named.filter(|(name, _)| self.packed.id(name).is_some()).collect();
        if !found.iter().any(|(name, _)| name == "POSITION") {
            return Err("names no POSITION among its attributes".to_owned().into());
        }
        for (name, accessor) in found.iter().filter(|(name, _)| !is_detail(name)) {
            self.accessors.check_sound(accessor)?;
            // An accessor with zero sparse values isn't sparse.
            if accessor.sparse().is_some_and(|sparse| sparse.count() > 0) {
                return Err(format!("holds {name}, but its accessor is sparse").into());
            }
        }
        Ok(found)
    }
}

/// Says how much memory decompressing takes at most, and which option allows that much, as a clause.
fn too_much(refused: MemoryRefused, budget: &Budget) -> String {
    let [needed, option] = [refused.needed, budget.option_for(refused.needed)].map(|bytes| bytes.div_ceil(1 << 20));
    let allowed = refused.allowed >> 20;
    format!(
        "may take {needed} MiB of memory, but files of this size may take only {allowed} MiB (--max-memory {option}MiB allows it)"
    )
}

/// Returns how many numbers an element has.
fn width(accessor: &Accessor) -> usize {
    accessor.dimensions().multiplicity()
}

/// Copies the indices and the attributes that are read from a decoded mesh, which must have these numbers of vertices
/// and triangles.
fn taken(
    mesh: &Mesh,
    attributes: &[(String, Accessor)],
    packed: &DracoExtension,
    [vertices, triangles]: [usize; 2],
) -> Result<DecompressedPrimitive, String> {
    if [mesh.num_points(), mesh.num_faces()] != [vertices, triangles] {
        let (points, faces) = (mesh.num_points(), mesh.num_faces());
        return Err(format!(
            "holds {points} vertices and {faces} triangles, but its accessors have {vertices} and {triangles}"
        ));
    }
    let read = |name: &str, accessor: &Accessor| {
        let id = packed.id(name).unwrap_or_default();
        let from = mesh.attribute_by_unique_id(id);
        let from = from.ok_or_else(|| format!("says that {name} is attribute {id}, which its data doesn't have"))?;
        values(name, from, accessor, vertices)
    };
    let mut read_attributes = HashMap::new();
    for (name, accessor) in attributes {
        let values = read(name, accessor);
        if let (Err(reason), false) = (&values, is_detail(name)) {
            return Err(reason.clone());
        }
        read_attributes.insert(name.clone(), values);
    }
    let indices = mesh.faces().as_flattened().iter().map(|point| point.0).collect();
    Ok(DecompressedPrimitive { indices, attributes: read_attributes })
}

/// Converts an attribute's numbers, vertex by vertex, to what its accessor says that they mean.
fn values(name: &str, from: &PointAttribute, accessor: &Accessor, vertices: usize) -> Result<Vec<f32>, String> {
    let (has, width) = (usize::from(from.num_components()), width(accessor));
    if has != width {
        return Err(format!("holds {has} numbers a vertex for {name}, but its accessor has {width}"));
    }
    let (kind, normalized) = (accessor.data_type(), accessor.normalized());
    let own = match from.data_type() {
        DataType::Int8 => Component::I8,
        DataType::Uint8 => Component::U8,
        DataType::Int16 => Component::I16,
        DataType::Uint16 => Component::U16,
        DataType::Uint32 => Component::U32,
        DataType::Float32 => Component::F32,
        other => return Err(format!("holds {name} as {other:?}, which no accessor supports")),
    };
    // Integers may be stored with more bits than the accessor says; but the value of a normalised integer depends on
    // its number of bits.
    if own != kind && (normalized || own == Component::F32) {
        return Err(format!("holds {name} as {own:?}, but its accessor has {kind:?}"));
    }
    let (size, data) = (own.size(), from.buffer().data());
    let mut values = Vec::with_capacity(vertices * width);
    for vertex in 0..vertices {
        let start = (from.mapped_index(PointIndex(to_u32(vertex))).0 as usize).checked_mul(width * size);
        let element = start.and_then(|start| data.get(start..)?.get(..width * size));
        let element = element.ok_or_else(|| format!("holds no {name} for vertex {vertex}"))?;
        values.extend(element.chunks_exact(size).map(|bytes| component(bytes, own, normalized)));
    }
    Ok(values)
}
