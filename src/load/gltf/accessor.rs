//! Reads accessors: typed lists in buffers, sparse or not, normalised or not. Every range is checked first.

use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;

use ::gltf::accessor::sparse::{IndexType, Sparse};
use ::gltf::accessor::{Accessor, DataType, Dimensions};
use ::gltf::{Document, buffer};

use super::GltfError;
use super::decompressed_primitive::DecompressedPrimitive;
use super::extensions::{Extensions, MeshoptExtension, MeshoptMode};
use super::meshopt::{Decompressed, decompress};
use super::notes::Notes;
use super::reach::Use;
use super::repair::Faults;
use crate::memory_budget::Budget;

/// The greatest number of elements of an accessor without a buffer view (zeros except for sparse values), since no
/// file's size limits those.
const MAX_ZEROS: usize = 1 << 24;

/// Reads the accessors of one document.
pub(crate) struct Accessors<'a> {
    document: &'a Document,
    buffers: &'a [Vec<u8>],
    /// For each buffer view, its decompressed bytes and their stride, if it is compressed.
    decompressed: Vec<Option<(Decompressed, usize)>>,
    /// The buffers with copies of data that can't be decompressed, by number.
    copies: HashMap<usize, Vec<u8>>,
    /// By mesh and primitive, the data that Draco compressed.
    pub unpacked: HashMap<[usize; 2], DecompressedPrimitive>,
    /// What can't be read, because it is broken and only details use it.
    faults: Faults,
    pub budget: &'a Budget,
}

/// Converts the bytes of an element into its value.
type Decode<'a, T> = Box<dyn Fn(&[u8]) -> T + 'a>;

/// Appends the values of many elements: a call for all of them takes a fraction of the time of a call for each.
type DecodeAll<'a, T> = Box<dyn Fn(Elements, &mut Vec<T>) + 'a>;

/// The values of an accessor. Values that lie in a buffer stay there, and are decoded when they are read.
pub(crate) struct List<'a, T: Clone> {
    elements: Elements<'a>,
    decode: Decode<'a, T>,
    decode_all: DecodeAll<'a, T>,
    /// Values that were decoded before: those of a sparse accessor, or without a buffer view, or of compressed data.
    decoded: Option<Cow<'a, [T]>>,
    zero: T,
}

impl<'a, T: Copy + 'a> List<'a, T> {
    /// Makes a list of values that were decoded before.
    pub(crate) fn of(values: &'a [T], zero: T) -> Self {
        Self::decoded(Cow::Borrowed(values), zero)
    }

    fn decoded(values: Cow<'a, [T]>, zero: T) -> Self {
        let list = Self::in_buffer(Elements::default(), move |_| zero, zero);
        Self { decoded: Some(values), ..list }
    }

    fn in_buffer(elements: Elements<'a>, decode: impl Fn(&[u8]) -> T + Copy + 'a, zero: T) -> Self {
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
    /// Decompresses the compressed buffer views. One that can't be is read from its uncompressed copy, if the document has one:
    /// `read_copy` reads a buffer that is only a copy. Otherwise, if only details use it, it becomes a fault.
    ///
    /// # Errors
    /// [`GltfError::Document`] for a view that can't be decompressed.
    pub(crate) fn new(
        document: &'a Document,
        extensions: &Extensions,
        (buffers, faults, views): (&'a [Vec<u8>], Faults, &[Use]),
        (budget, notes): (&'a Budget, &mut Notes),
        read_copy: impl Fn(usize) -> Result<Vec<u8>, String>,
    ) -> Result<Self, GltfError> {
        let (decompressed, copies, unpacked) = (Vec::new(), HashMap::new(), HashMap::new());
        let mut accessors = Self { document, buffers, decompressed, copies, unpacked, faults, budget };
        for (view, compressed) in document.views().zip(&extensions.compressed) {
            let made = compressed.as_ref().map(|compressed| accessors.decompress(&view, compressed)).transpose();
            let made = match made {
                Ok(made) => made,
                Err(reason) => {
                    let i = view.index();
                    let name = compressed.as_ref().map_or("", |own| own.name);
                    let pointer = format!("/bufferViews/{i}/extensions/{name}");
                    let has_copy = compressed.as_ref().is_some_and(|own| accessors.has_copy(&view, own, &read_copy));
                    match views.get(i) {
                        _ if has_copy => {
                            notes.push(format!("{pointer} {reason}; its uncompressed copy is read instead."));
                        }
                        Some(Use::Shape) => return Err(GltfError::Document { pointer, reason }),
                        _ => _ = accessors.faults.views.insert(i, format!("can't be used: {pointer} {reason}")),
                    }
                    None
                }
            };
            accessors.decompressed.push(made);
        }
        Ok(accessors)
    }

    /// Returns whether there is an uncompressed copy of a compressed view: its own bytes, in another place than the compressed ones.
    fn has_copy(
        &mut self,
        view: &buffer::View,
        compressed: &MeshoptExtension,
        read_copy: impl Fn(usize) -> Result<Vec<u8>, String>,
    ) -> bool {
        let (buffer, offset, length) = (view.buffer().index(), view.offset() as u64, view.length() as u64);
        let is_before = |[start, length]: [u64; 2], next: u64| start.saturating_add(length) <= next;
        let (own, other) = ([offset, length], [compressed.offset, compressed.length]);
        if buffer == compressed.buffer && !is_before(own, other[0]) && !is_before(other, own[0]) {
            return false;
        }
        if self.buffers.get(buffer).is_some_and(Vec::is_empty) && !self.copies.contains_key(&buffer) {
            let Ok(bytes) = read_copy(buffer) else { return false };
            self.copies.insert(buffer, bytes);
        }
        self.range(buffer, offset, length).is_ok()
    }

    /// # Errors
    /// [`GltfError::Accessor`] for one that is broken and that only details use.
    pub(crate) fn check_sound(&self, accessor: &Accessor, role: &str) -> Result<(), GltfError> {
        let fault = self.faults.accessors.get(&accessor.index()).cloned();
        let fail = |reason| Err(GltfError::Accessor { accessor: accessor.index(), role: role.to_owned(), reason });
        fault.map_or(Ok(()), fail)
    }

    fn decompress(&self, view: &buffer::View, compressed: &MeshoptExtension) -> Result<(Decompressed, usize), String> {
        let MeshoptExtension { buffer, offset, length, stride, count, mode, .. } = *compressed;
        let made = decompress(compressed, self.range(buffer, offset, length)?, self.budget)?;
        let (said, has) = (view.length(), made.bytes().len());
        if said != has {
            return Err(format!(
                "has {count} elements of {stride} bytes, which are {has} bytes, but its view's byteLength is {said}"
            ));
        }
        // Indices are packed tightly. Attributes have the view's stride, or else that of the compressed data.
        let stride = if mode == MeshoptMode::Attributes { stride } else { 0 };
        Ok((made, stride))
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
        let fail = |reason| GltfError::Accessor { accessor: accessor.index(), role: role.to_owned(), reason };
        self.budget
            .borrow((list.elements.count * size_of::<[f32; N]>()) as u64)
            .map_err(|refused| fail(refused.into()))?;
        let mut values = Vec::with_capacity(list.elements.count);
        list.append(0..list.elements.count, &mut values);
        Ok(values)
    }

    /// Returns a list of the same elements as [`numbers`](Self::numbers), which are decoded when they are read.
    ///
    /// # Errors
    /// The same as [`numbers`](Self::numbers)'.
    pub(crate) fn list<const N: usize>(
        &self,
        accessor: &Accessor,
        role: &str,
    ) -> Result<List<'_, [f32; N]>, GltfError> {
        let fail = |reason| GltfError::Accessor { accessor: accessor.index(), role: role.to_owned(), reason };
        self.check_sound(accessor, role)?;
        if accessor.dimensions().multiplicity() != N {
            return Err(fail(format!(
                "has {:?} elements, but {N} numbers an element are needed",
                accessor.dimensions()
            )));
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
        list.map_err(fail)
    }

    /// Returns a list of single unsigned integers.
    ///
    /// # Errors
    /// [`GltfError::Accessor`] if the elements are anything else, or if the data isn't in its buffer.
    pub(crate) fn indices(&self, accessor: &Accessor, role: &str) -> Result<List<'_, u32>, GltfError> {
        let fail = |reason| GltfError::Accessor { accessor: accessor.index(), role: role.to_owned(), reason };
        let unsigned = matches!(accessor.data_type(), DataType::U8 | DataType::U16 | DataType::U32);
        if accessor.dimensions() != Dimensions::Scalar || !unsigned {
            let (dimensions, kind) = (accessor.dimensions(), accessor.data_type());
            return Err(fail(format!(
                "has {dimensions:?} elements of {kind:?}, but single unsigned integers are needed"
            )));
        }
        let list = match accessor.data_type() {
            DataType::U32 => self.read(accessor, 0, word),
            _ => self.read(accessor, 0, unsigned_integer),
        };
        list.map_err(fail)
    }

    /// Returns the size of all buffers and decompressed data, in bytes.
    pub(crate) fn buffer_bytes(&self) -> u64 {
        let decompressed =
            self.decompressed.iter().flatten().map(|(decompressed, _)| decompressed.bytes().len() as u64);
        let unpacked = self.unpacked.values().map(DecompressedPrimitive::bytes);
        let buffers = self.buffers.iter().chain(self.copies.values()).map(|buffer| buffer.len() as u64);
        buffers.chain(decompressed).chain(unpacked).sum()
    }

    /// Returns the bytes of a buffer view.
    ///
    /// # Errors
    /// A clause that names the view if its buffer is too short.
    pub(crate) fn view_bytes(&self, view: &buffer::View) -> Result<&[u8], String> {
        let i = view.index();
        if let Some(fault) = self.faults.views.get(&i) {
            return Err(format!("uses /bufferViews/{i}, which {fault}"));
        }
        if let Some(Some((decompressed, _))) = self.decompressed.get(i) {
            return Ok(decompressed.bytes());
        }
        let bytes = self.range(view.buffer().index(), view.offset() as u64, view.length() as u64);
        bytes.map_err(|reason| format!("uses /bufferViews/{i}, which {reason}"))
    }

    /// # Errors
    /// A clause if the buffer is too short.
    fn range(&self, buffer: usize, offset: u64, length: u64) -> Result<&[u8], String> {
        let bytes = self.copies.get(&buffer).or(self.buffers.get(buffer)).map_or(&[][..], Vec::as_slice);
        let start = usize::try_from(offset).ok();
        let end = start.zip(usize::try_from(length).ok()).and_then(|(start, length)| start.checked_add(length));
        let range = start.zip(end).and_then(|(start, end)| bytes.get(start..end));
        range.ok_or_else(|| {
            format!("takes {length} bytes from byte {offset} of /buffers/{buffer}, which has {} bytes", bytes.len())
        })
    }

    /// Checks that the accessor's elements lie within its buffer view. Types and sparse values are checked when they
    /// are read.
    ///
    /// # Errors
    /// The same as [`Self::numbers`]'.
    pub(crate) fn check(&self, accessor: &Accessor, role: &str) -> Result<(), GltfError> {
        let found = match accessor.view() {
            Some(view) => self.elements(&view, accessor.offset(), accessor.size(), accessor.count()).map(|_| ()),
            None => zeros(accessor.count()),
        };
        let fail = |reason| GltfError::Accessor { accessor: accessor.index(), role: role.to_owned(), reason };
        found.map_err(fail)
    }

    /// Returns the view with this index, if there is one.
    pub(crate) fn view(&self, index: usize) -> Option<buffer::View<'a>> {
        self.document.views().nth(index)
    }

    fn read<'b, T: Copy + 'b>(
        &'b self,
        accessor: &Accessor,
        zero: T,
        decode: impl Fn(&[u8]) -> T + Copy + 'b,
    ) -> Result<List<'b, T>, String> {
        let (size, count) = (accessor.size(), accessor.count());
        let elements = match accessor.view() {
            Some(view) => Some(self.elements(&view, accessor.offset(), size, count)?),
            None => {
                zeros(count)?;
                None
            }
        };
        if let (Some(elements), None) = (elements, accessor.sparse()) {
            return Ok(List::in_buffer(elements, decode, zero));
        }
        self.budget.borrow((count as u64).saturating_mul(size_of::<T>() as u64))?;
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
    ) -> Result<(), String> {
        let (indices, new) = (sparse.indices(), sparse.values());
        let index_size = match indices.index_type() {
            IndexType::U8 => 1,
            IndexType::U16 => 2,
            IndexType::U32 => 4,
        };
        let places = self.elements(&indices.view(), indices.offset(), index_size, sparse.count())?;
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
    fn elements(&self, view: &buffer::View, offset: usize, size: usize, count: usize) -> Result<Elements<'_>, String> {
        let bytes = self.view_bytes(view)?;
        let compressed = self.decompressed.get(view.index()).and_then(Option::as_ref);
        let stride = view.stride().or(compressed.map(|(_, stride)| *stride).filter(|stride| *stride > 0));
        let stride = stride.unwrap_or(size);
        if stride < size {
            let i = view.index();
            return Err(format!("has elements of {size} bytes, but in /bufferViews/{i} they are {stride} bytes apart"));
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
                Err(format!("needs {needed} bytes of /bufferViews/{}, which has {}", view.index(), bytes.len()))
            }
        }
    }
}

/// Checks the number of elements of an accessor without data.
fn zeros(count: usize) -> Result<(), String> {
    match count {
        0..=MAX_ZEROS => Ok(()),
        _ => Err(format!("has {count} elements without data, but at most {MAX_ZEROS} such elements are read")),
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

/// Decodes an integer of four bytes.
fn word(bytes: &[u8]) -> u32 {
    bytes.first_chunk().map_or(0, |own| u32::from_le_bytes(*own))
}

fn unsigned_integer(bytes: &[u8]) -> u32 {
    if let Ok(word) = bytes.try_into() {
        return u32::from_le_bytes(word);
    }
    bytes.iter().rev().fold(0, |value, &byte| (value << 8) | u32::from(byte))
}

/// Decodes one number by the specification's sections 3.6.2.2 (data types) and 3.11 (normalised integers).
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
