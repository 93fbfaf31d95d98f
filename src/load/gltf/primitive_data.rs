//! The source of a primitive's attributes.

use ::gltf::accessor::Accessor;
use ::gltf::{Primitive, Semantic};

use super::accessor::List;
use super::decompressed_primitive::DecompressedPrimitive;
use super::{Accessors, GltfError};

/// The displacements by a morph target at weight 1.
pub(super) struct MorphTarget<'a> {
    pub positions: Option<List<'a, [f32; 3]>>,
    pub normals: Option<List<'a, [f32; 3]>>,
}

/// The source of a primitive's attributes.
#[derive(Clone, Copy)]
pub(super) struct PrimitiveData<'a> {
    pub primitive: &'a Primitive<'a>,
    /// The primitive's place in the document, for messages.
    pub name: &'a str,
    pub accessors: &'a Accessors<'a>,
    /// The decompressed data, if Draco compressed the primitive.
    pub unpacked: Option<&'a DecompressedPrimitive>,
}

impl<'a> PrimitiveData<'a> {
    pub(super) fn problem(&self, reason: impl Into<String>) -> GltfError {
        GltfError::Primitive { primitive: self.name.to_owned(), reason: reason.into() }
    }

    /// # Errors
    /// [`GltfError::Accessor`].
    pub(super) fn target(
        &self,
        target: &::gltf::mesh::MorphTarget,
        count: usize,
    ) -> Result<MorphTarget<'a>, GltfError> {
        let list = |accessor: Option<Accessor>, attribute| {
            accessor.map(|accessor| self.list(&accessor, attribute, count)).transpose()
        };
        Ok(MorphTarget {
            positions: list(target.positions(), "POSITION of a morph target")?,
            normals: list(target.normals(), "NORMAL of a morph target")?,
        })
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
        if accessor.count() != count {
            let reason = format!("has {} elements for {count} vertices", accessor.count());
            return Err(GltfError::Accessor { accessor: accessor.index(), role, reason });
        }
        match self.unpacked.and_then(|unpacked| unpacked.values(attribute)) {
            Some(values) => Ok(List::of(values, [0.0; N])),
            // Draco data without it, where the accessor has no other data.
            None if self.unpacked.is_some_and(|unpacked| unpacked.lacks(attribute)) => {
                let reason = "isn't in the compressed data".to_owned();
                Err(GltfError::Accessor { accessor: accessor.index(), role, reason })
            }
            None => self.accessors.list(accessor, &role),
        }
    }
}
