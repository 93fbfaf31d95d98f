//! Limits the memory that a load takes by the size of its files: a small file can't ask for much, and a large file only
//! for a multiple of its size.
//!
//! A load may take [`PER_BYTE`] times the size of its files, plus [`Limits::memory`]. What counts is the memory in use
//! at one time. A file of `F` bytes that becomes `T` triangles with `V` distinct corners and `P` points takes, in
//! bytes, besides textures and animation data:
//!
//! - while it is read, `F + 32 V + 5 S + 12 T`: the file's bytes, corners, the table that finds equal corners (`S` is
//!   the first power of two from `8 V / 7` on), and triangles. Each vertex of the glTF primitive that is being read takes
//!   5 more, and each vertex of an OBJ, PLY, OFF or 3MF file takes its attributes. If the number of corners isn't known beforehand,
//!   their list grows by half, and the old and the new list exist at the same time: `80 V`.
//! - while normals are computed, after the file's bytes have been freed: `32 V + 12 T + 57 P`; then, for points at creases,
//!   `32 V + 24 T + 5 P`, and 16 for each corner that a crease adds.
//! - at the end `36 V + 12 T`, or `24 T` if triangles were collected in several lists.
//! - more if materials need details of corners ([`CornerDetail`]), of which `D` are distinct: up to `130 D` and the table's `8 S`
//!   while they are read, then `52 D + 52 V`, at the end `48 V`; and 1000 for each of about 65,536 triangles at a time whose
//!   tangents are computed.
//! - with its topology `32 V + 12 T`; in addition first `32 V` for points, then `16 P + 4 V + 40 T` for patches and
//!   sides, and 8 for each edge. For a closed mesh this is 92 for each triangle in all.

use std::cell::Cell;
use std::sync::Arc;

use crate::files::Limits;
#[cfg(doc)]
use geometry::mesh::CornerDetail;
use geometry::mesh::build_limits::{Borrowed, MemoryAccount, MemoryRefused};
use geometry::mesh::{Material, Mesh};

/// How many bytes of memory each byte of a file allows, in addition to [`Limits::memory`].
pub(crate) const PER_BYTE: u64 = 4;

/// Counts memory before it is allocated, and refuses what is too much.
pub struct Budget {
    /// How many bytes are allowed whatever the files' size.
    free: u64,
    /// The size of all files, in bytes.
    files: Cell<u64>,
    /// How many bytes are in use until they are released.
    held: Cell<u64>,
    /// How many bytes are borrowed.
    passing: Cell<u64>,
}

impl Budget {
    /// Makes a budget for a document whose own file has `file` bytes, which are held.
    pub fn new(file: usize, limits: &Limits) -> Self {
        let file = file as u64;
        Self { free: limits.memory, files: Cell::new(file), held: Cell::new(file), passing: Cell::new(0) }
    }

    /// Makes a budget for what is computed from a mesh, which is held. `file_bytes` is the size of all files that it
    /// was read from.
    pub fn of_mesh(mesh: &Mesh, file_bytes: u64, limits: &Limits) -> Self {
        let (files, held) = (Cell::new(file_bytes), Cell::new(bytes_of(mesh)));
        Self { free: limits.memory, files, held, passing: Cell::new(0) }
    }

    /// Makes a budget that allows everything, for meshes whose size no file determines.
    pub fn unlimited() -> Self {
        Self { free: u64::MAX, files: Cell::new(0), held: Cell::new(0), passing: Cell::new(0) }
    }

    /// Adds another file of `file` bytes, which allows more memory.
    pub fn allow(&self, file: u64) {
        self.files.set(self.files.get().saturating_add(file));
    }

    /// Returns the size of all files, in bytes.
    pub fn files(&self) -> u64 {
        self.files.get()
    }

    /// Returns how many bytes may be in use.
    pub(super) fn allowed(&self) -> u64 {
        self.free.saturating_add(self.files.get().saturating_mul(PER_BYTE))
    }

    /// Returns which value of [`Limits::memory`] allows so many bytes.
    pub(super) fn option_for(&self, bytes: u64) -> u64 {
        bytes.saturating_sub(self.files.get().saturating_mul(PER_BYTE))
    }

    /// Returns how many more bytes may be taken.
    pub fn left(&self) -> u64 {
        self.allowed().saturating_sub(self.held.get() + self.passing.get())
    }

    fn check(&self, bytes: u64) -> Result<(), MemoryRefused> {
        let needed = (self.held.get() + self.passing.get()).saturating_add(bytes);
        let allowed = self.allowed();
        if needed <= allowed { Ok(()) } else { Err(MemoryRefused { needed, allowed }) }
    }
}

impl MemoryAccount for Budget {
    fn hold(&self, bytes: u64) -> Result<(), MemoryRefused> {
        self.check(bytes)?;
        self.held.set(self.held.get() + bytes);
        Ok(())
    }

    fn release(&self, bytes: u64) {
        self.held.set(self.held.get().saturating_sub(bytes));
    }

    fn borrow(&self, bytes: u64) -> Result<(), MemoryRefused> {
        self.check(bytes)?;
        self.passing.set(self.passing.get() + bytes);
        Ok(())
    }

    fn borrowed(&self) -> u64 {
        self.passing.get()
    }

    fn give_back(&self, scope: &Borrowed) {
        self.passing.set(self.passing.get().min(scope.before()));
    }
}

/// Returns how much memory a mesh of so many corners and triangles takes until its topology is built, in bytes: see above. There are at
/// most as many points as corners, and an ordinary mesh has three edges for two triangles.
pub(super) fn edge_bytes(corners: u64, triangles: u64) -> u64 {
    corners.saturating_mul(32 + 32 + 16 + 4).saturating_add(triangles.saturating_mul(12 + 40 + 12))
}

/// Returns the size of a mesh in memory, in bytes. A texture that materials share counts once.
fn bytes_of(mesh: &Mesh) -> u64 {
    let maps = |material: &Material| material.look.maps.clone().into_iter().flatten().map(|map| map.texture);
    let mut textures: Vec<_> =
        mesh.materials.iter().flat_map(|material| material.texture.clone().into_iter().chain(maps(material))).collect();
    textures.sort_unstable_by_key(Arc::as_ptr);
    textures.dedup_by_key(|texture| Arc::as_ptr(texture));
    let textures: usize = textures.iter().map(|texture| texture.rgba.capacity()).sum();
    let materials: usize = mesh.materials.iter().map(|material| size_of::<Material>() + material.name.capacity()).sum();
    let rig = mesh.rig.as_ref().map_or(0, |rig| rig.bytes());
    let [corners, triangles] = [mesh.corners.capacity() * 32, mesh.triangles.capacity() * 12];
    let details = mesh.details.as_ref().map_or(0, |details| size_of_val(&details[..]));
    (corners + triangles + textures + materials + rig + details) as u64
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::mesh::borrowing;

    #[test]
    fn files_bring_their_allowance() {
        let free = Limits::default().memory;
        let budget = Budget::new(1 << 20, &Limits::default());
        assert_eq!(budget.left(), free + (3 << 20));
        budget.allow(10 << 20);
        assert_eq!(budget.left(), free + (43 << 20));
        let scope = Borrowed::from(&budget);
        assert!(budget.borrow(free).is_ok() && budget.hold(43 << 20).is_ok());
        let said = budget.hold(1).unwrap_err().to_string();
        assert!(
            said.contains("would take at least 557 MiB of memory, but files of this size may take only 556 MiB"),
            "{said}"
        );
        assert_eq!(budget.option_for(600 << 20), 556 << 20, "four times eleven MiB of files come to it");
        drop(scope);
        assert_eq!(budget.left(), free);
        assert!(budget.hold(u64::MAX).is_err());
    }

    #[test]
    fn a_scope_returns_what_was_borrowed_in_it_and_nothing_else() {
        let budget = Budget::unlimited();
        budget.borrow(5).unwrap();
        let outer = Borrowed::from(&budget);
        budget.borrow(10).unwrap();
        assert_eq!(borrowing(&budget, || budget.borrow(20).map(|()| budget.borrowed())), Ok(35));
        assert_eq!(budget.borrowed(), 15);
        drop(outer);
        assert_eq!(budget.borrowed(), 5);
    }
}
