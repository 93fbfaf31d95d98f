//! Calls ufbx: the one place where a file's bytes reach its C code.

use ufbx::{
    AllocatorOpts, CoordinateAxes, ErrorType, FileFormat, IndexErrorHandling, InheritModeHandling, LoadOpts, MirrorAxis,
};
use ufbx::{ProgressCb, ProgressResult, SceneRoot};

use crate::import::Import;
use crate::memory_budget::Budget;
use crate::read_error::{FilePosition, ReadError};
use geometry::progress::{Cancelled, Progress};

/// How deep nodes may be nested.
const MAX_DEPTH: u32 = 1 << 12;

/// Parses a file. What `import` says of axis and unit takes the place of what the file says. The budget holds the memory of the result, which is `metadata.result_memory_used`.
///
/// # Errors
/// [`ReadError::Broken`], [`ReadError::TooLarge`] and [`ReadError::Cancelled`].
pub(super) fn scene(
    bytes: &[u8],
    import: &Import,
    budget: &Budget,
    progress: &Progress,
) -> Result<SceneRoot, ReadError> {
    let mut watch = |at: &ufbx::Progress| {
        progress.set(at.bytes_read as f32 / at.bytes_total.max(1) as f32);
        if progress.check().is_ok() { ProgressResult::Continue } else { ProgressResult::Cancel }
    };
    let options = LoadOpts {
        temp_allocator: half(budget),
        result_allocator: half(budget),
        file_format: FileFormat::Fbx,
        // A wrong index becomes one that no list has, and is refused or repaired where it is used.
        index_error_handling: IndexErrorHandling::NoIndex,
        inherit_mode_handling: InheritModeHandling::HelperNodes,
        handedness_conversion_axis: if import.up.is_none() { MirrorAxis::X } else { MirrorAxis::None },
        // Without a target nothing is converted.
        target_axes: if import.up.is_none() { ufbx::axes_right_handed_y_up() } else { CoordinateAxes::default() },
        target_unit_meters: if import.unit.is_none() { 1.0 } else { 0.0 },
        clean_skin_weights: true,
        skip_mesh_parts: true,
        use_blender_pbr_material: true,
        node_depth_limit: MAX_DEPTH,
        progress_cb: ProgressCb::Mut(&mut watch),
        ..LoadOpts::default()
    };
    // Editors of text add a byte order mark, which ufbx doesn't know.
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let scene = ufbx::load_memory(bytes, options).map_err(|error| match error.type_ {
        ErrorType::TruncatedFile if !is_fbx(bytes) => no_fbx(),
        _ => refused(&error, budget),
    })?;
    budget.hold(scene.metadata.result_memory_used as u64)?;
    Ok(scene)
}

/// Whether a file says that it is FBX: binary ones begin so, and texts say it in their first entries.
fn is_fbx(bytes: &[u8]) -> bool {
    const START: usize = 4096;
    bytes.is_empty() || memchr::memmem::find(&bytes[..bytes.len().min(START)], b"FBX").is_some()
}

fn no_fbx() -> ReadError {
    FilePosition::Everywhere.error("it isn't an FBX file, neither a binary one nor a text")
}

/// Allows half of the memory that is left: ufbx takes memory for its work, and for its result. It uses Rust's allocator.
pub(super) fn half(budget: &Budget) -> AllocatorOpts {
    // 0 would mean that there is no limit.
    let memory_limit = usize::try_from(budget.left() / 2).unwrap_or(usize::MAX).max(1);
    AllocatorOpts { memory_limit, ..AllocatorOpts::default() }
}

/// Returns what an error of ufbx means.
pub(super) fn refused(error: &ufbx::Error, budget: &Budget) -> ReadError {
    let everywhere = |reason: &str| FilePosition::Everywhere.error(reason);
    match error.type_ {
        ErrorType::Cancelled => Cancelled.into(),
        ErrorType::MemoryLimit | ErrorType::AllocationLimit | ErrorType::OutOfMemory => {
            match budget.hold(budget.left().saturating_add(1 << 20)) {
                Err(refused) => refused.into(),
                Ok(()) => everywhere("there isn't enough memory to read it"),
            }
        }
        ErrorType::EmptyFile | ErrorType::TruncatedFile | ErrorType::Io => everywhere("the file ends too early"),
        ErrorType::UnrecognizedFileFormat => no_fbx(),
        ErrorType::UnsupportedVersion => everywhere("it has a version of FBX that isn't read"),
        ErrorType::NodeDepthLimit => everywhere(&format!("its nodes are nested more than {MAX_DEPTH} deep")),
        ErrorType::BadIndex => everywhere("it has an index of something that doesn't exist"),
        ErrorType::InvalidUtf8 => everywhere("it has a text that isn't UTF-8"),
        // ufbx says no more about these.
        _ => everywhere("an entry breaks the format: its type, its length or an index in it is wrong"),
    }
}
