//! Reads PLY, in text and in binary of either byte order: vertices, polygons and triangle strips.
//!
//! The crate `ply-rs-bw` isn't used. It never ends on a large number of elements without properties, takes ten bytes of
//! memory for each byte of a long line, and refuses comments that aren't UTF-8.
//!
//! Source: Turk 1994, "The PLY Polygon File Format".

mod header;
mod values;

use glam::{Vec2, Vec3};

use super::face_builder::{FaceBuilder, MAX_CORNERS, counted};
use super::loaded_mesh::LoadedMesh;
use super::memory_budget::Budget;
use super::read_error::{FilePosition, ReadError};
use super::text_lines::shown;
use crate::files::Limits;
use crate::mesh::mesh_builder::InputCorner;
use crate::mesh::{Material, MemoryAccount};
use crate::progress::Progress;

use header::{Element, Property, PropertyKind};
use values::{Values, plain};

/// The properties of a vertex that are read, and the attribute that each sets. Texture coordinates have three names.
const ATTRIBUTES: [(&[u8], usize); 12] = [
    (b"x", 0),
    (b"y", 1),
    (b"z", 2),
    (b"nx", 3),
    (b"ny", 4),
    (b"nz", 5),
    (b"u", 6),
    (b"v", 7),
    (b"s", 6),
    (b"t", 7),
    (b"texture_u", 6),
    (b"texture_v", 7),
];

/// Builds a mesh called `name` from a file's bytes.
///
/// # Errors
/// [`ReadError`].
pub(super) fn read(bytes: Vec<u8>, name: &str, limits: &Limits, progress: &Progress) -> Result<LoadedMesh, ReadError> {
    let budget = Budget::new(bytes.len(), limits);
    let (faces, holds, warnings) = gather(&bytes, &budget, progress)?;
    budget.release(bytes.len() as u64);
    drop(bytes);
    faces.finish(name, holds, warnings, &progress.part(0.5, 1.0))
}

/// Reads all faces. Also returns what the file holds in case it has no triangles, and warnings.
fn gather<'a>(
    bytes: &[u8],
    budget: &'a Budget,
    progress: &'a Progress,
) -> Result<(FaceBuilder<'a>, String, Vec<String>), ReadError> {
    let header = header::read(bytes)?;
    let mut faces = FaceBuilder::new(bytes.len(), budget);
    let material = faces.material(Material::plain("default", [1.0; 4]))?;
    let mut reader = Reader { faces, material, vertices: None, corners: Vec::new(), budget, progress };
    let mut values = Values::new(&header, bytes.len());
    let mut before_vertices = Vec::new();
    for element in &header.elements {
        values.check(element)?;
        match (element.name, &reader.vertices) {
            (b"vertex", None) => reader.vertices = Some(reader.read_vertices(element, &mut values)?),
            (b"vertex", Some(_)) => return Err(values.place().error("the header has two elements named \"vertex\"")),
            (b"face" | b"tristrips", Some(_)) => reader.read_lists(element, &mut values)?,
            (name, _) => {
                if matches!(name, b"face" | b"tristrips") {
                    before_vertices.push((element, values.clone()));
                }
                values.skip(element, |values, i| reader.at(values, i))?;
            }
        }
    }
    for (element, mut values) in before_vertices {
        reader.read_lists(element, &mut values)?;
    }
    Ok(reader.finish(&header.elements, values.left_over()))
}

/// The attributes of the vertices. Normals or uvs are empty if the file has none.
#[derive(Default)]
struct Vertices {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
}

impl Vertices {
    fn corner(&self, index: f64, place: FilePosition) -> Result<InputCorner, ReadError> {
        let vertex = index as usize;
        // The conversion changes an index that is negative, not whole or not finite.
        let position = self.positions.get(vertex).filter(|_| vertex as f64 == index).ok_or_else(|| {
            let (index, count) = (plain(index), self.positions.len());
            place.error(format!("the face uses vertex {index}, but the file has {count}, counted from 0"))
        })?;
        let uv = self.uvs.get(vertex).copied().unwrap_or_default();
        Ok(InputCorner { position: *position, normal: self.normals.get(vertex).copied(), uv })
    }
}

struct Reader<'a> {
    faces: FaceBuilder<'a>,
    material: usize,
    vertices: Option<Vertices>,
    /// The corners of the face that is being read.
    corners: Vec<InputCorner>,
    budget: &'a Budget,
    progress: &'a Progress,
}

impl<'a> Reader<'a> {
    fn read_vertices(&self, element: &Element, values: &mut Values) -> Result<Vertices, ReadError> {
        let slots: Vec<Option<usize>> = element.properties.iter().map(slot).collect();
        let has = |slot: usize| slots.contains(&Some(slot));
        if !(has(0) && has(1) && has(2)) {
            return Err(values.place().error("the vertices have no x, y and z"));
        }
        let (has_normals, has_uvs) = ((3..6).all(has), (6..8).all(has));
        // `values.check` has compared the count with the remaining bytes.
        let count = usize::try_from(element.count).unwrap_or_default();
        let bytes = count as u64 * (12 + 12 * u64::from(has_normals) + 8 * u64::from(has_uvs));
        self.budget.hold(bytes).map_err(|refused| ReadError::TooLarge { reason: refused.into() })?;
        let room = |has: bool| if has { count } else { 0 };
        let mut vertices = Vertices {
            positions: Vec::with_capacity(count),
            normals: Vec::with_capacity(room(has_normals)),
            uvs: Vec::with_capacity(room(has_uvs)),
        };
        for i in 0..element.count {
            self.at(values, i)?;
            values.begin(element, i)?;
            let mut found = [0.0; 8];
            for (property, slot) in element.properties.iter().zip(&slots) {
                match (property.kind, slot) {
                    (PropertyKind::One(scalar), Some(slot)) => found[*slot] = values.next(scalar)? as f32,
                    (kind, _) => values.skip_one(kind)?,
                }
            }
            values.end(element)?;
            let [x, y, z, nx, ny, nz, u, v] = found;
            vertices.positions.push(Vec3::new(x, y, z));
            if has_normals {
                vertices.normals.push(Vec3::new(nx, ny, nz));
            }
            if has_uvs {
                // The file's v points upwards, the mesh's downwards.
                vertices.uvs.push(Vec2::new(u, 1.0 - v));
            }
        }
        Ok(vertices)
    }

    /// Reads an element of faces or of triangle strips.
    fn read_lists(&mut self, element: &Element, values: &mut Values) -> Result<(), ReadError> {
        let vertices = self.vertices.take().unwrap_or_default();
        let is_list = |property: &Property| {
            matches!(property.name, b"vertex_indices" | b"vertex_index")
                && matches!(property.kind, PropertyKind::List { .. })
        };
        let Some(list) = element.properties.iter().position(is_list) else {
            let reason = format!("the element {} has no list named \"vertex_indices\"", shown(element.name));
            return Err(values.place().error(reason));
        };
        // Both counts have been compared with the remaining bytes.
        let faces = usize::try_from(element.count).unwrap_or_default();
        self.faces.expect(faces, vertices.positions.len().min(faces.saturating_mul(4)));
        for i in 0..element.count {
            self.at(values, i)?;
            values.begin(element, i)?;
            for (k, property) in element.properties.iter().enumerate() {
                match property.kind {
                    PropertyKind::List { count, item } if k == list => {
                        let place = values.place();
                        let mut left = values.count(count, item)?;
                        let next = || {
                            let Some(less) = left.checked_sub(1) else { return Ok(None) };
                            left = less;
                            values.next(item).map(Some)
                        };
                        match element.name {
                            b"face" => self.face(next, &vertices, place)?,
                            _ => self.strip(next, &vertices, place)?,
                        }
                    }
                    kind => values.skip_one(kind)?,
                }
            }
            values.end(element)?;
        }
        self.vertices = Some(vertices);
        Ok(())
    }

    fn face(
        &mut self,
        mut next: impl FnMut() -> Result<Option<f64>, ReadError>,
        vertices: &Vertices,
        place: FilePosition,
    ) -> Result<(), ReadError> {
        self.corners.clear();
        while let Some(index) = next()? {
            if self.corners.len() == MAX_CORNERS {
                return Err(place.error(format!("the face has more than {MAX_CORNERS} corners")));
            }
            self.corners.push(vertices.corner(index, place)?);
        }
        self.faces.add(self.material, &mut self.corners, place)
    }

    /// Reads a triangle strip. Each vertex makes a triangle with the two vertices before it, with alternating winding;
    /// -1 starts a new strip. A triangle that uses a vertex twice only continues the strip and is left out.
    fn strip(
        &mut self,
        mut next: impl FnMut() -> Result<Option<f64>, ReadError>,
        vertices: &Vertices,
        place: FilePosition,
    ) -> Result<(), ReadError> {
        let (mut last, mut length) = ([0.0; 2], 0);
        while let Some(index) = next()? {
            if index == -1.0 {
                length = 0;
                continue;
            }
            length += 1;
            let [a, b] = last;
            last = [b, index];
            if length < 3 || a == b || b == index || index == a {
                continue;
            }
            let triangle = if length % 2 == 1 { [a, b, index] } else { [b, a, index] };
            self.corners.clear();
            for index in triangle {
                self.corners.push(vertices.corner(index, place)?);
            }
            self.faces.add(self.material, &mut self.corners, place)?;
        }
        Ok(())
    }

    /// Sets the progress, once every 4,096 elements.
    fn at(&self, values: &Values, i: u64) -> Result<(), ReadError> {
        if i.is_multiple_of(4096) {
            self.progress.set(0.5 * values.fraction());
            self.progress.check()?;
        }
        Ok(())
    }

    fn finish(self, elements: &[Element], left_over: usize) -> (FaceBuilder<'a>, String, Vec<String>) {
        let count =
            |name: &[u8]| elements.iter().filter(|element| element.name == name).map(|element| element.count).sum();
        let [vertices, faces, strips]: [u64; 3] = [b"vertex" as &[u8], b"face", b"tristrips"].map(count);
        let holds = format!("it holds {vertices} vertices, {faces} faces and {strips} strips of triangles");
        let read = self.vertices.unwrap_or_default();
        let without_normals = if read.normals.is_empty() { read.positions.len() } else { 0 };
        let warnings = counted([
            (without_normals, "vertices without normals, which got ones that are smooth within 60 degrees"),
            (left_over, "bytes after the last element, left out"),
        ]);
        self.budget
            .release((12 * read.positions.capacity() + 12 * read.normals.capacity() + 8 * read.uvs.capacity()) as u64);
        (self.faces, holds, warnings.collect())
    }
}

/// Returns which attribute a property of a vertex sets, if any.
fn slot(property: &Property) -> Option<usize> {
    let known = ATTRIBUTES.iter().find(|(name, _)| *name == property.name);
    known.filter(|_| matches!(property.kind, PropertyKind::One(_))).map(|(_, slot)| *slot)
}

#[cfg(test)]
pub(super) mod tests;
