//! Accessors: typed lists in buffers, sparse or not, normalised or not, with every range checked first.

use ::gltf::accessor::sparse::{IndexType, Sparse};
use ::gltf::accessor::{Accessor, DataType, Dimensions};
use ::gltf::{Document, buffer};

use super::Problem;

/// The largest list without a buffer view behind it (all zeros but for its sparse values): nothing else bounds those.
const MAX_ZEROS: usize = 1 << 24;

/// Reads the accessors of one document.
pub struct Accessors<'a> {
    document: &'a Document,
    buffers: &'a [Vec<u8>],
}

/// Elements in a buffer view: `stride` bytes from one to the next, and all there.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
    count: usize,
}

impl<'a> Elements<'a> {
    fn iter(&self) -> impl Iterator<Item = &'a [u8]> {
        let (bytes, stride, size) = (self.bytes, self.stride, self.size);
        (0..self.count).filter_map(move |i| bytes.get(i * stride..)?.get(..size))
    }
}

impl<'a> Accessors<'a> {
    pub fn new(document: &'a Document, buffers: &'a [Vec<u8>]) -> Self {
        Self { document, buffers }
    }

    /// Lists of N numbers, normalised integers as -1 to 1 or 0 to 1. `role` says what for, in messages.
    ///
    /// # Errors
    /// [`Problem::Accessor`] when there aren't N numbers an element, or the data isn't where it should be.
    pub fn numbers<const N: usize>(&self, accessor: &Accessor, role: &str) -> Result<Vec<[f32; N]>, Problem> {
        let fail = |reason| Problem::Accessor { accessor: accessor.index(), role: role.to_owned(), reason };
        if accessor.dimensions().multiplicity() != N {
            return Err(fail(format!("has {:?} elements where {N} numbers are needed", accessor.dimensions())));
        }
        let (kind, normalized) = (accessor.data_type(), accessor.normalized());
        let decode = |bytes: &[u8]| {
            let mut numbers = [0.0; N];
            for (number, bytes) in numbers.iter_mut().zip(bytes.chunks_exact(kind.size())) {
                *number = component(bytes, kind, normalized);
            }
            numbers
        };
        self.read(accessor, [0.0; N], decode).map_err(fail)
    }

    /// Single unsigned integers, exactly.
    ///
    /// # Errors
    /// [`Problem::Accessor`] when it holds anything else, or the data isn't where it should be.
    pub fn indices(&self, accessor: &Accessor, role: &str) -> Result<Vec<u32>, Problem> {
        let fail = |reason| Problem::Accessor { accessor: accessor.index(), role: role.to_owned(), reason };
        let unsigned = matches!(accessor.data_type(), DataType::U8 | DataType::U16 | DataType::U32);
        if accessor.dimensions() != Dimensions::Scalar || !unsigned {
            let kind = (accessor.dimensions(), accessor.data_type());
            return Err(fail(format!("holds {kind:?} where unsigned integers are needed")));
        }
        self.read(accessor, 0, unsigned_integer).map_err(fail)
    }

    /// The bytes of a buffer view.
    ///
    /// # Errors
    /// A clause that names the view when its buffer is too short.
    pub fn view_bytes(&self, view: &buffer::View) -> Result<&'a [u8], String> {
        let buffer = self.buffers.get(view.buffer().index()).map_or(&[][..], Vec::as_slice);
        let end = view.offset().checked_add(view.length());
        let bytes = end.and_then(|end| buffer.get(view.offset()..end));
        bytes.ok_or_else(|| {
            let (i, offset, length, has) = (view.index(), view.offset(), view.length(), buffer.len());
            format!("uses buffer view {i}, which takes {length} bytes from byte {offset} of a buffer of {has}")
        })
    }

    /// The view with this index, if there is one.
    pub fn view(&self, index: usize) -> Option<buffer::View<'a>> {
        self.document.views().nth(index)
    }

    fn read<T: Clone>(&self, accessor: &Accessor, zero: T, decode: impl Fn(&[u8]) -> T) -> Result<Vec<T>, String> {
        let (size, count) = (accessor.size(), accessor.count());
        let mut values = match accessor.view() {
            Some(view) => self.elements(&view, accessor.offset(), size, count)?.iter().map(&decode).collect(),
            None if count > MAX_ZEROS => return Err(format!("has {count} elements but no data")),
            None => vec![zero; count],
        };
        if let Some(sparse) = accessor.sparse() {
            self.replace(&mut values, &sparse, size, decode)?;
        }
        Ok(values)
    }

    /// Puts an accessor's sparse values in their places.
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
            *value.ok_or_else(|| format!("replaces element {place} of {count}"))? = decode(bytes);
        }
        Ok(())
    }

    /// `count` elements of `size` bytes in a view, from a byte offset on.
    fn elements(&self, view: &buffer::View, offset: usize, size: usize, count: usize) -> Result<Elements<'a>, String> {
        let bytes = self.view_bytes(view)?;
        let stride = view.stride().unwrap_or(size);
        if stride < size {
            return Err(format!("has elements of {size} bytes, {stride} bytes apart"));
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
                let needed = needed.map_or("more than any memory".to_owned(), |needed| needed.to_string());
                Err(format!("needs {needed} bytes of buffer view {}, which has {}", view.index(), bytes.len()))
            }
        }
    }
}

fn unsigned_integer(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |value, &byte| (value << 8) | u32::from(byte))
}

/// One number, as the specification's section 3.6.2.2 (data types) and 3.11 (normalised integers) say.
fn component(bytes: &[u8], kind: DataType, normalized: bool) -> f32 {
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
