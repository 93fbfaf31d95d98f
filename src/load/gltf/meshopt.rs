//! Compressed buffer views, decompressed by meshoptimizer, whose decoders are made for input that nobody vouches for.
//!
//! Source: Khronos, `EXT_meshopt_compression`,
//! <https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor/EXT_meshopt_compression>.

use meshopt::ffi;

use super::extensions::{Compressed, Filter, Mode};
use crate::load::memory_budget::Budget;
use crate::mesh::MemoryAccount;

/// What a compressed view becomes, aligned for whatever its elements are.
pub struct Decompressed {
    words: Vec<u32>,
    length: usize,
}

impl Decompressed {
    pub fn bytes(&self) -> &[u8] {
        &bytemuck::cast_slice(&self.words)[..self.length]
    }
}

/// Decompresses the bytes of one view.
///
/// # Errors
/// A clause: its sizes don't fit its mode or filter, it would take too much memory, or it can't be decompressed.
pub fn decompress(view: &Compressed, bytes: &[u8], budget: &Budget) -> Result<Decompressed, String> {
    check(view)?;
    let length = view.count.saturating_mul(view.stride as u64);
    budget.hold(length)?;
    // Within the budget, which no memory's size exceeds.
    let (count, length) = (view.count as usize, length as usize);
    let mut words = vec![0_u32; length.div_ceil(4)];
    let to = words.as_mut_ptr();
    let code = match view.mode {
        // SAFETY: `words` has room for `count` elements of `stride` bytes, which `check` found to be of a size that the
        // decoders take; they read no more than the bytes given.
        Mode::Attributes => unsafe {
            ffi::meshopt_decodeVertexBuffer(to.cast(), count, view.stride, bytes.as_ptr(), bytes.len())
        },
        // SAFETY: the same.
        Mode::Triangles => unsafe {
            ffi::meshopt_decodeIndexBuffer(to.cast(), count, view.stride, bytes.as_ptr(), bytes.len())
        },
        // SAFETY: the same.
        Mode::Indices => unsafe {
            ffi::meshopt_decodeIndexSequence(to.cast(), count, view.stride, bytes.as_ptr(), bytes.len())
        },
    };
    if code != 0 {
        let (held, mode) = (bytes.len(), view.mode);
        return Err(format!("can't be decompressed: {held} bytes aren't {count} elements in mode {mode:?}"));
    }
    // SAFETY: `words` holds `count` elements of `stride` bytes, of a size that `check` found the filter to take.
    unsafe {
        match view.filter {
            Filter::None => {}
            Filter::Octahedral => ffi::meshopt_decodeFilterOct(to.cast(), count, view.stride),
            Filter::Quaternion => ffi::meshopt_decodeFilterQuat(to.cast(), count, view.stride),
            Filter::Exponential => ffi::meshopt_decodeFilterExp(to.cast(), count, view.stride),
        }
    }
    Ok(Decompressed { words, length })
}

/// What the decoders take for granted.
fn check(view: &Compressed) -> Result<(), String> {
    let stride = view.stride;
    let fits = match view.mode {
        Mode::Attributes => stride.is_multiple_of(4) && (4..=256).contains(&stride),
        Mode::Triangles | Mode::Indices => stride == 2 || stride == 4,
    };
    if !fits {
        return Err(format!("has a byteStride of {stride}, which mode {:?} doesn't have", view.mode));
    }
    if view.mode == Mode::Triangles && !view.count.is_multiple_of(3) {
        return Err(format!("has a count of {}, which is no multiple of 3", view.count));
    }
    let fits = match view.filter {
        Filter::None => true,
        _ if view.mode != Mode::Attributes => false,
        Filter::Octahedral => stride == 4 || stride == 8,
        Filter::Quaternion => stride == 8,
        Filter::Exponential => true,
    };
    if !fits {
        let (filter, mode) = (view.filter, view.mode);
        return Err(format!(
            "has the filter {filter:?}, which mode {mode:?} with a byteStride of {stride} doesn't have"
        ));
    }
    Ok(())
}
