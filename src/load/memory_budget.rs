//! How much memory a load takes: a small file can't ask for much, and a large one gets by with what it brings.
//!
//! At most [`PER_BYTE`] times the files' size, and [`Limits::memory`]. What counts is what is alive at one time. Of a file of `F` bytes that
//! becomes `T` triangles with `V` distinct corners and `P` points, in bytes, beside textures and what moves:
//!
//! - while it is read, `F + 32 V + 5 S + 12 T`: the bytes as they are, corners, the table that tells them apart (`S` is the next
//!   power of two from `8 V / 7` on), triangles. For each vertex of the one glTF primitive that is read 5 more, and for each
//!   one of an OBJ or a PLY file what it is made of. Where nobody knows beforehand how many corners there will be, they grow
//!   by half, and old and new are both alive: `80 V`.
//! - where normals are made, when the file's bytes are gone: `32 V + 24 T + 4 P`, and 16 for each corner that a crease adds.
//! - at the end `36 V + 12 T`, or `24 T` where triangles came in several runs.
//! - with its topology `32 V + 12 T`, and beside it first `32 V` for points, then `16 P + 4 V + 40 T` for patches and sides, and
//!   8 for each edge; of a closed mesh that is 92 for each triangle in all.

use std::cell::Cell;
use std::sync::Arc;

use crate::files::Limits;
use crate::mesh::build_limits::{MemoryAccount, MemoryRefused};
use crate::mesh::{Material, Mesh};

/// What each byte of a file allows, in bytes, beyond what is allowed whatever the files' size ([`Limits::memory`]).
pub const PER_BYTE: u64 = 4;

/// Counts what is about to be taken, before it is.
pub struct Budget {
    /// Allowed whatever the files' size.
    free: u64,
    /// Bytes of all files.
    files: Cell<u64>,
    /// Taken until the end.
    held: Cell<u64>,
    /// Given back soon.
    passing: Cell<u64>,
}

impl Budget {
    /// For a document's own file of so many bytes, which are held.
    pub fn new(file: usize, limits: &Limits) -> Self {
        let file = file as u64;
        Self { free: limits.memory, files: Cell::new(file), held: Cell::new(file), passing: Cell::new(0) }
    }

    /// For what is made of a mesh, which is held. `file_bytes` are those of all files that it was read from.
    pub fn of_mesh(mesh: &Mesh, file_bytes: u64, limits: &Limits) -> Self {
        let (files, held) = (Cell::new(file_bytes), Cell::new(bytes_of(mesh)));
        Self { free: limits.memory, files, held, passing: Cell::new(0) }
    }

    /// Allows everything: for meshes that no file asks for.
    pub fn unlimited() -> Self {
        Self { free: u64::MAX, files: Cell::new(0), held: Cell::new(0), passing: Cell::new(0) }
    }

    /// There is another file of so many bytes.
    pub fn allow(&self, file: u64) {
        self.files.set(self.files.get().saturating_add(file));
    }

    /// Bytes of all files.
    pub fn files(&self) -> u64 {
        self.files.get()
    }

    /// What may be taken in all.
    fn allowed(&self) -> u64 {
        self.free.saturating_add(self.files.get().saturating_mul(PER_BYTE))
    }

    /// What may still be taken.
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

    fn give_back_to(&self, borrowed: u64) {
        self.passing.set(borrowed);
    }
}

/// What a mesh takes, in bytes: textures that materials share count once.
fn bytes_of(mesh: &Mesh) -> u64 {
    let mut textures: Vec<_> = mesh.materials.iter().filter_map(|material| material.texture.as_ref()).collect();
    textures.sort_unstable_by_key(|texture| Arc::as_ptr(texture));
    textures.dedup_by_key(|texture| Arc::as_ptr(texture));
    let textures: usize = textures.iter().map(|texture| texture.rgba.capacity()).sum();
    let materials: usize = mesh.materials.iter().map(|material| size_of::<Material>() + material.name.capacity()).sum();
    let rig = mesh.rig.as_ref().map_or(0, |rig| rig.bytes());
    let [corners, triangles] = [mesh.corners.capacity() * 32, mesh.triangles.capacity() * 12];
    (corners + triangles + textures + materials + rig) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_bring_their_allowance() {
        let free = Limits::default().memory;
        let budget = Budget::new(1 << 20, &Limits::default());
        assert_eq!(budget.left(), free + (3 << 20));
        budget.allow(10 << 20);
        assert_eq!(budget.left(), free + (43 << 20));
        assert!(budget.borrow(free).is_ok() && budget.hold(43 << 20).is_ok());
        let said = budget.hold(1).unwrap_err().to_string();
        assert!(
            said.contains("would take at least 301 MiB of memory, and files of this size may take 300 MiB"),
            "{said}"
        );
        budget.give_back_to(0);
        assert_eq!(budget.left(), free);
        assert!(budget.hold(u64::MAX).is_err());
    }
}
