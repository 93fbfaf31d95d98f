//! Decompresses buffer views with meshoptimizer, whose decoders are made for untrusted input.
//!
//! Sources: Khronos, `EXT_meshopt_compression` and `KHR_meshopt_compression`, whose attributes have a second version and whose filters
//! are one more, <https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos/KHR_meshopt_compression>.

use meshopt::ffi;

use super::extensions::{MeshoptExtension, MeshoptFilter, MeshoptMode};
use crate::memory_budget::Budget;
use geometry::casts::to_usize;

/// The data of a decompressed view, aligned to 4 bytes for its elements.
pub(super) struct Decompressed {
    words: Vec<u32>,
    length: usize,
    /// The number of bytes from one element to the next; none if they are packed tightly, as indices are.
    pub stride: Option<usize>,
}

impl Decompressed {
    pub(super) fn bytes(&self) -> &[u8] {
        &bytemuck::cast_slice(&self.words)[..self.length]
    }
}

/// Decompresses the bytes of one view.
///
/// # Errors
/// A clause if its sizes don't fit its mode or filter, if it would take too much memory, or if it can't be
/// decompressed.
#[allow(unsafe_code, reason = "the decoders are C++, and their crate hides those that check what they read")]
pub(super) fn decompress(view: &MeshoptExtension, bytes: &[u8], budget: &Budget) -> Result<Decompressed, String> {
    check(view)?;
    let length = view.count.saturating_mul(view.stride as u64);
    budget.hold(length)?;
    // Both fit, since the budget has accepted them.
    let (count, length) = (to_usize(view.count), to_usize(length));
    let mut words = vec![0_u32; length.div_ceil(4)];
    let to = words.as_mut_ptr();
    let decode = match view.mode {
        MeshoptMode::Attributes => ffi::meshopt_decodeVertexBuffer,
        MeshoptMode::Triangles => ffi::meshopt_decodeIndexBuffer,
        MeshoptMode::Indices => ffi::meshopt_decodeIndexSequence,
    };
    // SAFETY: `words` has room for `count` elements of `stride` bytes, which `check` found to be of a size that the
    // decoders take; they read no more than the bytes given.
    let code = unsafe { decode(to.cast(), count, view.stride, bytes.as_ptr(), bytes.len()) };
    if code != 0 {
        let (held, mode) = (bytes.len(), view.mode);
        return Err(format!("can't be decompressed: {held} bytes aren't {count} elements in mode {mode:?}"));
    }
    // SAFETY: `words` holds `count` elements of `stride` bytes, of a size that `check` found the filter to take.
    unsafe {
        match view.filter {
            MeshoptFilter::None => {}
            MeshoptFilter::Octahedral => ffi::meshopt_decodeFilterOct(to.cast(), count, view.stride),
            MeshoptFilter::Quaternion => ffi::meshopt_decodeFilterQuat(to.cast(), count, view.stride),
            MeshoptFilter::Exponential => ffi::meshopt_decodeFilterExp(to.cast(), count, view.stride),
            MeshoptFilter::Color => ffi::meshopt_decodeFilterColor(to.cast(), count, view.stride),
        }
    }
    let stride = (view.mode == MeshoptMode::Attributes).then_some(view.stride);
    Ok(Decompressed { words, length, stride })
}

/// Checks the sizes that the decoders require.
fn check(view: &MeshoptExtension) -> Result<(), String> {
    let stride = view.stride;
    let fits = match view.mode {
        MeshoptMode::Attributes => stride.is_multiple_of(4) && (4..=256).contains(&stride),
        MeshoptMode::Triangles | MeshoptMode::Indices => stride == 2 || stride == 4,
    };
    if !fits {
        return Err(format!("has a byteStride of {stride}, which mode {:?} doesn't allow", view.mode));
    }
    if view.mode == MeshoptMode::Triangles && !view.count.is_multiple_of(3) {
        return Err(format!("has a count of {}, which isn't a multiple of 3", view.count));
    }
    let fits = match view.filter {
        MeshoptFilter::None => true,
        _ if view.mode != MeshoptMode::Attributes => false,
        MeshoptFilter::Octahedral | MeshoptFilter::Color => stride == 4 || stride == 8,
        MeshoptFilter::Quaternion => stride == 8,
        MeshoptFilter::Exponential => true,
    };
    if !fits {
        let (filter, mode) = (view.filter, view.mode);
        return Err(format!(
            "has the filter {filter:?}, which mode {mode:?} with a byteStride of {stride} doesn't allow"
        ));
    }
    Ok(())
}
