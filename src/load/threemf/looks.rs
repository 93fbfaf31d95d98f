//! Finds the material, the colours and the texture coordinates of triangles.

use std::collections::HashMap;

use glam::{Vec2, Vec4};

use super::document::Document;
use super::model::{Object, TriangleLook};
use super::properties::{Group, Texture2d, material_color};
use crate::face_builder::{FaceBuilder, linear_color};
use crate::notes::counts;
use crate::read_error::ReadError;
use geometry::mesh::{Alpha, Look, Material};
use geometry::names::shown;

/// The material of a triangle, the numbers of its corners' colours, and their texture coordinates.
#[derive(Clone, Copy)]
pub(super) struct Resolved {
    pub material: usize,
    pub numbers: [u32; 3],
    pub uvs: [Vec2; 3],
    /// Why it isn't shown as the file means it: at most one of these.
    pub faults: Faults,
}

counts! {
    /// Numbers of triangles that aren't shown as the file means them.
    #[derive(PartialEq, Eq)]
    pub(super) struct Faults {
        absent => "triangles whose material, colour or texture coordinates aren't in the file, shown without";
        beyond => "triangles that go on where their texture ends (tile style none), which show its border there";
        combined =>
            "triangles with layers (multiproperties) or mixtures (compositematerials), shown with the lowest layer or the first \
             material alone";
    }
}

/// What tells materials apart.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum MaterialKey {
    /// That of triangles without one, opaque or translucent.
    Plain(bool),
    /// By part, group and entry.
    Named(usize, u32, u32),
    /// By part and texture.
    Textured(usize, u32),
}

/// The materials that have been needed so far.
pub(super) struct Looks<'d> {
    document: &'d Document,
    materials: HashMap<MaterialKey, usize>,
    /// Which materials show images, by their indices in the face builder, and the images' names in the archive.
    pub textured: Vec<(usize, String)>,
}

impl<'d> Looks<'d> {
    pub(super) fn new(document: &'d Document) -> Self {
        Self { document, materials: HashMap::new(), textured: Vec::new() }
    }

    /// Finds a triangle's material and colours (core specification, section 4.1.4.1).
    pub(super) fn resolve(
        &mut self,
        faces: &mut FaceBuilder,
        part: usize,
        object: &Object,
        look: u32,
    ) -> Result<Resolved, ReadError> {
        let own = (look as usize).checked_sub(1).and_then(|look| self.document.geometry.looks.get(look));
        let own = own.copied().unwrap_or(TriangleLook { group: None, entries: [None; 3] });
        // The group counts for nothing without the first entry.
        let (group, first) = match own.entries[0] {
            Some(first) => (own.group.or(object.group), Some(first)),
            None => (object.group, object.entry),
        };
        let Some((group, first)) = group.zip(first) else { return self.colored(faces, [Vec4::ONE; 3]) };
        let corners = own.of_corners(first);
        let Some(Group::Combined { lowest, entries, .. }) = self.document.parts[part].groups.get(&group) else {
            return self.painted(faces, part, group, corners);
        };
        let corners = corners.map(|corner| entries.get(corner as usize).copied().unwrap_or(u32::MAX));
        let mut resolved = self.painted(faces, part, *lowest, corners)?;
        resolved.faults.combined = usize::from(resolved.faults == Faults::default());
        Ok(resolved)
    }

    /// A triangle with entries of a group.
    fn painted(
        &mut self,
        faces: &mut FaceBuilder,
        part: usize,
        group: u32,
        corners: [u32; 3],
    ) -> Result<Resolved, ReadError> {
        let document: &'d Document = self.document;
        let part_of = &document.parts[part];
        match part_of.groups.get(&group) {
            Some(Group::Materials(materials)) => {
                // A material is that of the whole triangle.
                let entry = corners[0];
                if let Some((name, color)) = materials.get(entry as usize) {
                    let color = material_color(*color);
                    let name = || if name.is_empty() { format!("material {entry}") } else { shown(name) };
                    let make = || Material { look: look(color.w < 1.0), ..Material::plain(&name(), color.to_array()) };
                    return self.material(faces, MaterialKey::Named(part, group, entry), make);
                }
            }
            Some(Group::Colors(colors)) => {
                let own = corners.map(|corner| colors.get(corner as usize).map(|color| linear_color(*color)));
                if let [Some(a), Some(b), Some(c)] = own {
                    return self.colored(faces, [a, b, c]);
                }
            }
            Some(Group::Texture { texture, coordinates }) => {
                let uvs = corners.map(|corner| coordinates.get(corner as usize).copied());
                if let (Some(shown), [Some(a), Some(b), Some(c)]) = (part_of.textures.get(texture), uvs) {
                    return self.textured(faces, part, *texture, shown, [a, b, c]);
                }
            }
            Some(Group::Combined { .. }) | None => {}
        }
        let faults = Faults { absent: 1, ..Faults::default() };
        Ok(Resolved { faults, ..self.colored(faces, [Vec4::ONE; 3])? })
    }

    /// A triangle with colours at its corners, in linear RGBA.
    fn colored(&mut self, faces: &mut FaceBuilder, colors: [Vec4; 3]) -> Result<Resolved, ReadError> {
        let is_translucent = colors.iter().any(|color| color.w < 1.0);
        let name = if is_translucent { "translucent" } else { "default" };
        let make = || Material { look: look(is_translucent), ..Material::plain(name, [1.0; 4]) };
        let mut resolved = self.material(faces, MaterialKey::Plain(is_translucent), make)?;
        for (number, color) in resolved.numbers.iter_mut().zip(colors) {
            *number = faces.number(color)?;
        }
        Ok(resolved)
    }

    /// A triangle with a texture at these texture coordinates, whose v counts from the bottom.
    fn textured(
        &mut self,
        faces: &mut FaceBuilder,
        part: usize,
        id: u32,
        texture: &Texture2d,
        uvs: [[f32; 2]; 3],
    ) -> Result<Resolved, ReadError> {
        let known = self.materials.len();
        let name = || if texture.name().is_empty() { format!("texture {id}") } else { shown(texture.name()) };
        let make = || Material { sampling: texture.sampling, ..Material::plain(&name(), [1.0; 4]) };
        let resolved = self.material(faces, MaterialKey::Textured(part, id), make)?;
        if self.materials.len() > known {
            self.textured.push((resolved.material, texture.path.clone()));
        }
        let beyond = usize::from(uvs.iter().any(|uv| texture.leaves(*uv)));
        let faults = Faults { beyond, ..Faults::default() };
        Ok(Resolved { uvs: uvs.map(|[u, v]| Vec2::new(u, 1.0 - v)), faults, ..resolved })
    }

    /// A white triangle of a material, which `make` makes when it is first needed.
    fn material(
        &mut self,
        faces: &mut FaceBuilder,
        key: MaterialKey,
        make: impl FnOnce() -> Material,
    ) -> Result<Resolved, ReadError> {
        let material = match self.materials.get(&key) {
            Some(known) => *known,
            None => *self.materials.entry(key).or_insert(faces.material(make())?),
        };
        let number = faces.number(Vec4::ONE)?;
        Ok(Resolved { material, numbers: [number; 3], uvs: [Vec2::ZERO; 3], faults: Faults::default() })
    }
}

fn look(is_translucent: bool) -> Look {
    Look { alpha: if is_translucent { Alpha::Blend } else { Alpha::Opaque }, ..Look::default() }
}
