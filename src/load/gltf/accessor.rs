//! Reads accessors: typed lists in buffers, sparse or not, normalised or not. Every range is checked first.

use std::borrow::Cow;
use std::cell::{OnceCell, RefCell};
use std::collections::HashMap;
use std::ops::Range;

use ::gltf::accessor::sparse::Sparse;
use ::gltf::accessor::{Accessor, DataType, Dimensions};
use ::gltf::{Document, buffer};

use super::GltfError;
use super::buffers::Buffers;
use super::extensions::MeshoptExtension;
use super::meshopt::{Decompressed, decompress};
use super::notes::Notes;
use super::schema_check::{Fault, Faults};
use crate::memory_budget::Budget;

/// The greatest number of elements of an accessor without a buffer view (zeros except for sparse values), since no
/// file's size limits those.
const MAX_ZEROS: usize = 1 << 24;

/// Reads the accessors of one document.
pub(crate) struct Accessors<'a> {
    document: &'a Document,
    buffers: Buffers<'a>,
    /// For each buffer view, how it is compressed, and its data once something needed it: none if its uncompressed copy is read.
    compressed: &'a [Option<MeshoptExtension>],
    decompressed: Vec<OnceCell<Result<Option<Decompressed>, Fault>>>,
    /// By mesh and primitive, the data that Draco compressed.
    pub unpacked: HashMap<[usize; 2], DecompressedPrimitive>,
    faults: &'a Faults,
    pub budget: &'a Budget,
    /// What was repaired.
    pub notes: RefCell<Notes>,
}

/// The data of a primitive that was compressed.
pub(crate) struct DecompressedPrimitive {
    /// The indices of vertices, three for each triangle.
    pub indices: Vec<u32>,
    /// By their names in glTF, the numbers of attributes, as many for each vertex as their accessors say; or why one that a primitive can
    /// do without can't be read, as a clause.
    pub attributes: HashMap<String, Result<Vec<f32>, String>>,
}

impl DecompressedPrimitive {
    /// Returns the size in memory, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let values: usize = self.attributes.values().flatten().map(Vec::len).sum();
        4 * (self.indices.len() + values) as u64
    }
}

/// Why data can't be read.
#[derive(Debug, thiserror::Error)]
pub(crate) enum DataError {
    /// A clause about what needs it.
    #[error("{0}")]
    Here(String),
    /// Something else in the document is wrong.
    #[error(transparent)]
    Elsewhere(#[from] GltfError),
}

impl From<String> for DataError {
    fn from(reason: String) -> Self {
        Self::Here(reason)
    }
}

impl DataError {
    /// The error of an accessor with this role.
    fn of(self, accessor: &Accessor, role: &str) -> GltfError {
        match self {
            Self::Here(reason) => GltfError::Accessor { accessor: accessor.index(), role: role.to_owned(), reason },
            Self::Elsewhere(error) => error,
        }
    }
}

/// Converts the bytes of an element into its value.
type Decode<'a, T> = Box<dyn Fn(&[u8]) -> T + Sync + 'a>;

/// Appends the values of many elements: a call for all of them takes a fraction of the time of a call for each.
type DecodeAll<'a, T> = Box<dyn Fn(Elements, &mut Vec<T>) + Sync + 'a>;

/// The values of an accessor. Values that lie in a buffer stay there, and are decoded when they are read.
pub(crate) struct List<'a, T: Clone> {
    elements: Elements<'a>,
    decode: Decode<'a, T>,
    decode_all: DecodeAll<'a, T>,
    /// Values that were decoded before: those of a sparse accessor, or without a buffer view, or of compressed data.
    decoded: Option<Cow<'a, [T]>>,
    zero: T,
}

impl<'a, T: Copy + Sync + 'a> List<'a, T> {
    /// Makes a list of values that were decoded before.
    pub(crate) fn new(values: &'a [T], zero: T) -> Self {
        Self::decoded(Cow::Borrowed(values), zero)
    }

    fn decoded(values: Cow<'a, [T]>, zero: T) -> Self {
        let list = Self::in_buffer(Elements::default(), move |_| zero, zero);
        Self { decoded: Some(values), ..list }
    }

    fn in_buffer(elements: Elements<'a>, decode: impl Fn(&[u8]) -> T + Copy + Sync + 'a, zero: T) -> Self {
        let all = move |elements: Elements, values: &mut Vec<T>| values.extend(elements.iter().map(decode));
        Self { elements, decode: Box::new(decode), decode_all: Box::new(all), decoded: None, zero }
    }

    /// Appends the elements of a range, which lies within the list.
    pub(crate) fn append(&self, range: Range<usize>, to: &mut Vec<T>) {
        match &self.decoded {
            Some(values) => to.extend_from_slice(&values[range]),
            None => (self.decode_all)(self.elements.part(range), to),
        }
    }

    /// Returns element `i`, or zero beyond the end.
    pub(crate) fn get(&self, i: usize) -> T {
        match &self.decoded {
            Some(values) => values.get(i).copied().unwrap_or(self.zero),
            None => self.elements.get(i).map_or(self.zero, &self.decode),
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.decoded.as_ref().map_or(self.elements.count, |values| values.len())
    }
}

/// Elements in a buffer view, `stride` bytes apart, whose range has been checked.
#[derive(Clone, Copy, Default)]
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
    count: usize,
}

impl<'a> Elements<'a> {
    fn get(&self, i: usize) -> Option<&'a [u8]> {
        self.bytes.get(i * self.stride..)?.get(..self.size)
    }

    fn iter(self) -> impl Iterator<Item = &'a [u8]> {
        (0..self.count).filter_map(move |i| self.get(i))
    }

    fn part(self, range: Range<usize>) -> Self {
        let bytes = self.bytes.get(range.start * self.stride..).unwrap_or_default();
        Self { bytes, count: range.len(), ..self }
    }
}

impl<'a> Accessors<'a> {
    pub(crate) fn new(
        document: &'a Document,
        buffers: Buffers<'a>,
        compressed: &'a [Option<MeshoptExtension>],
        faults: &'a Faults,
        budget: &'a Budget,
    ) -> Self {
        let decompressed = compressed.iter().map(|_| OnceCell::new()).collect();
        let (unpacked, notes) = (HashMap::new(), RefCell::default());
        Self { document, buffers, compressed, decompressed, unpacked, faults, budget, notes }
    }

    /// Returns the data of a view that is compressed; none if it isn't, or if its uncompressed copy is read since the compressed data is
    /// broken.
    fn decompressed(&self, view: &buffer::View) -> Result<Option<&Decompressed>, Fault> {
        let i = view.index();
        let Some(compressed) = self.compressed.get(i).and_then(Option::as_ref) else { return Ok(None) };
        let made = self.decompressed[i].get_or_init(|| match self.decompress(view, compressed) {
            Ok(made) => Ok(Some(made)),
            Err(reason) => {
                let pointer = format!("/bufferViews/{i}/extensions/{}", compressed.name);
                if !self.has_copy(view, compressed) {
                    return Err(Fault { pointer, reason });
                }
                self.notes.borrow_mut().push(format!("{pointer} {reason}; its uncompressed copy is read instead."));
                Ok(None)
            }
        });
        made.as_ref().map(Option::as_ref).map_err(Fault::clone)
    }

    /// Returns whether there is an uncompressed copy of a compressed view: its own bytes, in another place than the compressed ones.
    fn has_copy(&self, view: &buffer::View, compressed: &MeshoptExtension) -> bool {
        let (buffer, offset, length) = (view.buffer().index(), view.offset() as u64, view.length() as u64);
        let is_before = |[start, length]: [u64; 2], next: u64| start.saturating_add(length) <= next;
        let (own, other) = ([offset, length], [compressed.offset, compressed.length]);
        let is_apart = buffer != compressed.buffer || is_before(own, other[0]) || is_before(other, own[0]);
        is_apart && self.range(buffer, offset, length).is_ok()
    }

    /// # Errors
    /// [`GltfError::Document`] for an accessor that is wrong.
    pub(crate) fn check_sound(&self, accessor: &Accessor) -> Result<(), GltfError> {
        Ok(self.faults.check("accessors", accessor.index())?)
    }

    /// # Errors
    /// [`GltfError::Document`] for an accessor that is wrong, and [`GltfError::Accessor`] for one that hasn't as many elements as there
    /// are of `what`.
    pub(crate) fn check_count(
        &self,
        accessor: &Accessor,
        role: &str,
        count: usize,
        what: &str,
    ) -> Result<(), GltfError> {
        self.check_sound(accessor)?;
        match accessor.count() {
            has if has == count => Ok(()),
            has => Err(DataError::Here(format!("has {has} elements for {count} {what}")).of(accessor, role)),
        }
    }

    fn decompress(&self, view: &buffer::View, compressed: &MeshoptExtension) -> Result<Decompressed, String> {
        let MeshoptExtension { buffer, offset, length, stride, count, .. } = *compressed;
        let bytes = self.range(buffer, offset, length).map_err(|error| match error {
            DataError::Here(reason) => reason,
            DataError::Elsewhere(error) => error.into_clause(),
        })?;
        let made = decompress(compressed, bytes, self.budget)?;
        let (said, has) = (view.length(), made.bytes().len());
        if said != has {
            return Err(format!(
                "has {count} elements of {stride} bytes, which are {has} bytes, but its view's byteLength is {said}"
            ));
        }
        Ok(made)
    }

    /// Reads elements of N numbers; normalised integers become -1 to 1 or 0 to 1. `role` says what they are for, in
    /// messages.
    ///
    /// # Errors
    /// [`GltfError::Accessor`] if elements don't have N numbers, or if the data isn't in its buffer.
    pub(crate) fn numbers<const N: usize>(&self, accessor: &Accessor, role: &str) -> Result<Vec<[f32; N]>, GltfError> {
        let list = self.list::<N>(accessor, role)?;
        if let Some(values) = list.decoded {
            return Ok(values.into_owned());
        }
        let borrowed = self.budget.borrow((list.elements.count * size_of::<[f32; N]>()) as u64);
        borrowed.map_err(|refused| DataError::Here(refused.into()).of(accessor, role))?;
        let mut values = Vec::with_capacity(list.elements.count);
        list.append(0..list.elements.count, &mut values);
        Ok(values)
    }

    /// Returns a list of the same elements as [`numbers`](Self::numbers), which are decoded when they are read.
    pub(crate) fn list<const N: usize>(
        &self,
        accessor: &Accessor,
        role: &str,
    ) -> Result<List<'_, [f32; N]>, GltfError> {
        self.check_sound(accessor)?;
        let dimensions = accessor.dimensions();
        if dimensions.multiplicity() != N {
            let reason = format!("has {dimensions:?} elements, but {N} numbers an element are needed");
            return Err(DataError::Here(reason).of(accessor, role));
        }
        let (kind, normalized) = (accessor.data_type(), accessor.normalized());
        let decode = move |bytes: &[u8]| {
            let mut numbers = [0.0; N];
            for (number, bytes) in numbers.iter_mut().zip(bytes.chunks_exact(kind.size())) {
                *number = component(bytes, kind, normalized);
            }
            numbers
        };
        let list = match kind {
            DataType::F32 => self.read(accessor, [0.0; N], floats),
            _ => self.read(accessor, [0.0; N], decode),
        };
        list.map_err(|error| error.of(accessor, role))
    }

    /// Returns a list of single unsigned integers.
    ///
    /// # Errors
    /// [`GltfError::Accessor`] if the elements are anything else, or if the data isn't in its buffer.
    pub(crate) fn indices(&self, accessor: &Accessor, role: &str) -> Result<List<'_, u32>, GltfError> {
        self.check_sound(accessor)?;
        let (dimensions, kind) = (accessor.dimensions(), accessor.data_type());
        if dimensions != Dimensions::Scalar || !matches!(kind, DataType::U8 | DataType::U16 | DataType::U32) {
            let reason = format!("has {dimensions:?} elements of {kind:?}, but single unsigned integers are needed");
            return Err(DataError::Here(reason).of(accessor, role));
        }
        self.read(accessor, 0, unsigned_integer).map_err(|error| error.of(accessor, role))
    }

    /// Returns the size of all buffers and decompressed data, in bytes.
    pub(crate) fn buffer_bytes(&self) -> u64 {
        let made = self.decompressed.iter().filter_map(|made| made.get()?.as_ref().ok()?.as_ref());
        let made = made.map(|made| made.bytes().len() as u64);
        let unpacked = self.unpacked.values().map(DecompressedPrimitive::bytes);
        made.chain(unpacked).sum::<u64>() + self.buffers.size()
    }

    /// Returns the bytes of a buffer view.
    ///
    /// # Errors
    /// A clause that names the view if its buffer is too short.
    pub(crate) fn view_bytes(&self, view: &buffer::View) -> Result<&[u8], DataError> {
        let i = view.index();
        self.faults.check("bufferViews", i).map_err(GltfError::from)?;
        if let Some(made) = self.decompressed(view).map_err(GltfError::from)? {
            return Ok(made.bytes());
        }
        let bytes = self.range(view.buffer().index(), view.offset() as u64, view.length() as u64);
        bytes.map_err(|error| match error {
            DataError::Here(reason) => format!("uses /bufferViews/{i}, which {reason}").into(),
            other => other,
        })
    }

    /// # Errors
    /// A clause if the buffer is too short.
    fn range(&self, buffer: usize, offset: u64, length: u64) -> Result<&[u8], DataError> {
        let bytes = self.buffers.bytes(buffer)?;
        let start = usize::try_from(offset).ok();
        let end = start.zip(usize::try_from(length).ok()).and_then(|(start, length)| start.checked_add(length));
        let range = start.zip(end).and_then(|(start, end)| bytes.get(start..end));
        let has = bytes.len();
        range.ok_or_else(|| {
            format!("takes {length} bytes from byte {offset} of /buffers/{buffer}, which has {has} bytes").into()
        })
    }

    /// Checks that the accessor's elements lie within its buffer view. Types and sparse values are checked when they
    /// are read.
    pub(crate) fn check(&self, accessor: &Accessor, role: &str) -> Result<(), GltfError> {
        self.check_sound(accessor)?;
        self.stored(accessor).map(|_| ()).map_err(|error| error.of(accessor, role))
    }

    /// Returns the elements of an accessor without its sparse values; none if it has no buffer view, and all are zero.
    fn stored(&self, accessor: &Accessor) -> Result<Option<Elements<'_>>, DataError> {
        let count = accessor.count();
        match accessor.view() {
            Some(view) => self.elements(&view, accessor.offset(), accessor.size(), count).map(Some),
            None if count <= MAX_ZEROS => Ok(None),
            None => {
                Err(format!("has {count} elements without data, but at most {MAX_ZEROS} such elements are read").into())
            }
        }
    }

    /// Reads the data of an accessor's view, if it can be read, so that its memory counts.
    pub(crate) fn prepare(&self, accessor: &Accessor) {
        _ = accessor.view().map(|view| self.view_bytes(&view).is_ok());
    }

    /// Returns the view with this index, if there is one.
    pub(crate) fn view(&self, index: usize) -> Option<buffer::View<'a>> {
        self.document.views().nth(index)
    }

    fn read<'b, T: Copy + Sync + 'b>(
        &'b self,
        accessor: &Accessor,
        zero: T,
        decode: impl Fn(&[u8]) -> T + Copy + Sync + 'b,
    ) -> Result<List<'b, T>, DataError> {
        let (size, count) = (accessor.size(), accessor.count());
        let elements = self.stored(accessor)?;
        if let (Some(elements), None) = (elements, accessor.sparse()) {
            return Ok(List::in_buffer(elements, decode, zero));
        }
        self.budget.borrow((count as u64).saturating_mul(size_of::<T>() as u64)).map_err(String::from)?;
        let mut values = Vec::with_capacity(count);
        values.extend(elements.into_iter().flat_map(Elements::iter).map(decode));
        values.resize(count, zero);
        if let Some(sparse) = accessor.sparse() {
            self.replace(&mut values, &sparse, size, decode)?;
        }
        Ok(List::decoded(Cow::Owned(values), zero))
    }

    /// Replaces elements by an accessor's sparse values.
    fn replace<T>(
        &self,
        values: &mut [T],
        sparse: &Sparse,
        size: usize,
        decode: impl Fn(&[u8]) -> T,
    ) -> Result<(), DataError> {
        let (indices, new) = (sparse.indices(), sparse.values());
        let places = self.elements(&indices.view(), indices.offset(), indices.index_type().size(), sparse.count())?;
        let new = self.elements(&new.view(), new.offset(), size, sparse.count())?;
        let count = values.len();
        for (place, bytes) in places.iter().map(unsigned_integer).zip(new.iter()) {
            let value = values.get_mut(place as usize);
            *value.ok_or_else(|| format!("replaces element {place} by /sparse/indices, but has {count} elements"))? =
                decode(bytes);
        }
        Ok(())
    }

    /// Returns `count` elements of `size` bytes in a view, from a byte offset on.
    fn elements(
        &self,
        view: &buffer::View,
        offset: usize,
        size: usize,
        count: usize,
    ) -> Result<Elements<'_>, DataError> {
        let bytes = self.view_bytes(view)?;
        let made = self.decompressed(view).map_err(GltfError::from)?;
        // Compressed attributes have the view's stride, or else that of the compressed data.
        let stride = view.stride().or_else(|| made?.stride).unwrap_or(size);
        if stride < size {
            let i = view.index();
            let reason = format!("has elements of {size} bytes, but in /bufferViews/{i} they are {stride} bytes apart");
            return Err(reason.into());
        }
        let needed = match count {
            0 => Some(0),
            _ => stride.checked_mul(count - 1).and_then(|last| last.checked_add(size)?.checked_add(offset)),
        };
        match needed {
            Some(needed) if needed <= bytes.len() => {
                Ok(Elements { bytes: bytes.get(offset..).unwrap_or(&[]), stride, size, count })
            }
            _ => {
                let needed = needed.map_or("more than 2^64".to_owned(), |needed| needed.to_string());
                Err(format!("needs {needed} bytes of /bufferViews/{}, which has {}", view.index(), bytes.len()).into())
            }
        }
    }
}

/// Decodes an element of N floats, which most attributes consist of: without a look at their type, this takes a fraction of
/// the time.
fn floats<const N: usize>(bytes: &[u8]) -> [f32; N] {
    let mut numbers = [0.0; N];
    for (number, bytes) in numbers.iter_mut().zip(bytes.as_chunks::<4>().0) {
        *number = f32::from_le_bytes(*bytes);
    }
    numbers
}

fn unsigned_integer(bytes: &[u8]) -> u32 {
    if let Ok(word) = bytes.try_into() {
        return u32::from_le_bytes(word);
    }
    bytes.iter().rev().fold(0, |value, &byte| (value << 8) | u32::from(byte))
}

/// Decodes one number by the specification's sections 3.6.2.2 (data types) and 3.11 (normalised integers).
#[expect(clippy::cast_possible_truncation, reason = "the type says how many of the bits count")]
pub(super) fn component(bytes: &[u8], kind: DataType, normalized: bool) -> f32 {
    let bits = unsigned_integer(bytes);
    let (value, one) = match kind {
        DataType::F32 => return f32::from_bits(bits),
        DataType::I8 => (f32::from(bits as u8 as i8), 127.0),
        DataType::U8 => (f32::from(bits as u8), 255.0),
        DataType::I16 => (f32::from(bits as u16 as i16), 32767.0),
        DataType::U16 => (f32::from(bits as u16), 65535.0),
        DataType::U32 => (bits as f32, u32::MAX as f32),
    };
    if normalized { (value / one).max(-1.0) } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_of_all_types() {
        assert_eq!(component(&1.5_f32.to_le_bytes(), DataType::F32, false), 1.5);
        assert_eq!(component(&[0x80], DataType::I8, true), -1.0);
        assert_eq!(component(&[0x81], DataType::I8, true), -1.0);
        assert_eq!(component(&[255], DataType::U8, true), 1.0);
        assert_eq!(component(&[255], DataType::U8, false), 255.0);
        assert_eq!(component(&[0xfe, 0xff], DataType::I16, false), -2.0);
        assert_eq!(component(&[0xff, 0xff], DataType::U16, true), 1.0);
        assert_eq!(unsigned_integer(&[1, 2, 3, 4]), 0x0403_0201);
    }
}
