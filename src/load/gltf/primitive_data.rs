//! The source of a primitive's attributes.

use ::gltf::accessor::Accessor;
use ::gltf::{Primitive, Semantic};

use super::accessor::{DecompressedPrimitive, List};
use super::notes::Notes;
use super::{Accessors, GltfError};

/// The source of a primitive's attributes.
#[derive(Clone, Copy)]
pub(super) struct PrimitiveData<'a> {
    pub primitive: &'a Primitive<'a>,
    /// The primitive's place in the document, for messages.
    pub name: &'a str,
    pub accessors: &'a Accessors<'a>,
    /// The decompressed data, if Draco compressed the primitive.
    pub unpacked: Option<&'a DecompressedPrimitive>,
    /// Whether all normals are made, as if the primitive had none.
    pub makes_normals: bool,
}

impl<'a> PrimitiveData<'a> {
    pub(super) fn problem(&self, reason: impl Into<String>) -> GltfError {
        GltfError::Primitive { primitive: self.name.to_owned(), reason: reason.into() }
    }

    /// # Errors
    /// [`GltfError::Accessor`].
    pub(super) fn attribute<const N: usize>(
        &self,
        semantic: Semantic,
        count: usize,
    ) -> Result<Option<List<'a, [f32; N]>>, GltfError> {
        let accessor = self.primitive.get(&semantic);
        accessor.map(|accessor| self.list(&accessor, &semantic.to_string(), count)).transpose()
    }

    /// Returns the normals that are used; none if they are made. Those of another number of vertices are left out with a note,
    /// since it isn't known which vertices they belong to.
    ///
    /// # Errors
    /// [`GltfError::Accessor`].
    pub(super) fn normals(&self, count: usize, notes: &mut Notes) -> Result<Option<List<'a, [f32; 3]>>, GltfError> {
        let Some(accessor) = self.primitive.get(&Semantic::Normals).filter(|_| !self.makes_normals) else {
            return Ok(None);
        };
        self.accessors.check_sound(&accessor)?;
        if accessor.count() == count {
            return self.list(&accessor, &Semantic::Normals.to_string(), count).map(Some);
        }
        let (i, has) = (accessor.index(), accessor.count());
        let said = format!("has {has} elements for {count} vertices; it is left out, and normals are made.");
        notes.push_once(format!("/accessors/{i} (NORMAL of {}) {said}", self.name));
        Ok(None)
    }

    /// Whether the primitive's own normals are used.
    pub(super) fn has_normals(&self, count: usize) -> bool {
        !self.makes_normals && self.primitive.get(&Semantic::Normals).is_some_and(|normals| normals.count() == count)
    }

    /// Returns an attribute that the primitive can do without. If it can't be read, it is left out with a note.
    pub(super) fn detail<const N: usize>(
        &self,
        semantic: Semantic,
        count: usize,
        notes: &mut Notes,
    ) -> Option<List<'a, [f32; N]>> {
        self.optional(&self.primitive.get(&semantic)?, &semantic.to_string(), count, notes)
    }

    /// Returns the values of an accessor that the primitive can do without. If they can't be read, they are left out with a note.
    pub(super) fn optional<const N: usize>(
        &self,
        accessor: &Accessor,
        attribute: &str,
        count: usize,
        notes: &mut Notes,
    ) -> Option<List<'a, [f32; N]>> {
        let list = self.list(accessor, attribute, count);
        let left_out = |error: GltfError| {
            let (i, reason) = (accessor.index(), error.into_clause());
            notes.push_once(format!("/accessors/{i} ({attribute} of {}) {reason}; it is left out.", self.name));
        };
        list.map_err(left_out).ok()
    }

    /// Returns an attribute's values, of which there must be as many as vertices.
    ///
    /// # Errors
    /// [`GltfError::Accessor`].
    pub(super) fn list<const N: usize>(
        &self,
        accessor: &Accessor,
        attribute: &str,
        count: usize,
    ) -> Result<List<'a, [f32; N]>, GltfError> {
        let role = format!("{attribute} of {}", self.name);
        self.accessors.check_count(accessor, &role, count, "vertices")?;
        match self.unpacked.and_then(|unpacked| unpacked.attributes.get(attribute)) {
            Some(Ok(values)) if accessor.dimensions().multiplicity() == N => {
                Ok(List::new(values.as_chunks().0, [0.0; N]))
            }
            // The accessor has no other data.
            Some(Err(reason)) => {
                let reason = format!("can't be decompressed, since its primitive {reason}");
                Err(GltfError::Accessor { accessor: accessor.index(), role, reason })
            }
            _ => self.accessors.list(accessor, &role),
        }
    }
}
