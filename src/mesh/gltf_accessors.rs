//! Accessors, checked before the `gltf` crate's readers touch them: those trust what a document says of itself.

use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::Data;

/// What is wrong with an accessor, as the end of a sentence.
pub type Problem = String;

/// Whether the accessor holds one of these types, and all its elements lie inside its buffer views.
///
/// # Errors
/// A type that the glTF specification doesn't allow here (section 3.7.2.1), or elements outside.
pub fn check(
    accessor: &gltf::Accessor,
    buffers: &[Data],
    types: &[DataType],
    dimensions: Dimensions,
) -> Result<(), Problem> {
    let index = accessor.index();
    if !types.contains(&accessor.data_type()) || accessor.dimensions() != dimensions {
        let (found, shape) = (accessor.data_type(), accessor.dimensions());
        return Err(format!("has accessor {index} of {found:?} {shape:?} where {types:?} {dimensions:?} belong"));
    }
    if accessor.count() == 0 {
        return Err(format!("has accessor {index} without elements"));
    }
    if let Some(view) = accessor.view() {
        check_view(index, &view, buffers, accessor.offset(), accessor.count(), accessor.size())?;
    }
    if let Some(sparse) = accessor.sparse() {
        let indices = sparse.indices();
        let size = match indices.index_type() {
            gltf::accessor::sparse::IndexType::U8 => 1,
            gltf::accessor::sparse::IndexType::U16 => 2,
            gltf::accessor::sparse::IndexType::U32 => 4,
        };
        check_view(index, &indices.view(), buffers, indices.offset(), sparse.count(), size)?;
        let values = sparse.values();
        check_view(index, &values.view(), buffers, values.offset(), sparse.count(), accessor.size())?;
    }
    Ok(())
}

/// Whether `count` elements of `size` bytes from `offset` on lie inside the view, and the view inside its buffer.
fn check_view(
    accessor: usize,
    view: &gltf::buffer::View,
    buffers: &[Data],
    offset: usize,
    count: usize,
    size: usize,
) -> Result<(), Problem> {
    let stride = view.stride().unwrap_or(size);
    let outside = |needed: Option<usize>, length: usize, of: String| {
        let needed = needed.map_or_else(|| "more".to_owned(), |bytes| bytes.to_string());
        Err(format!("has accessor {accessor}, which needs {needed} bytes of {of} that has {length}"))
    };
    let needed = count.checked_sub(1).map_or(Some(0), |last| {
        last.checked_mul(stride).and_then(|start| start.checked_add(size)).and_then(|end| end.checked_add(offset))
    });
    if needed.is_none_or(|end| end > view.length()) {
        return outside(needed, view.length(), format!("buffer view {}", view.index()));
    }
    let end = view.offset().checked_add(view.length());
    let buffer = view.buffer().index();
    let length = buffers.get(buffer).map_or(0, |data| data.len());
    if end.is_none_or(|end| end > length) {
        return outside(end, length, format!("buffer {buffer}"));
    }
    Ok(())
}
