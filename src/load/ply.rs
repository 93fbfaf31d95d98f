//! Reads PLY, in text and in binary of either byte order: vertices, polygons and triangle strips.
//!
//! The crate `ply-rs-bw` isn't used. It never ends on a large number of elements without properties, takes ten bytes of
//! memory for each byte of a long line, and refuses comments that aren't UTF-8.
//!
//! Source: Turk 1994, "The PLY Polygon File Format".

mod header;
mod textures;
mod values;

use glam::{Vec2, Vec3, Vec4};

use super::face_builder::{FaceBuilder, Gathered, MAX_CORNERS, NumberedCorner, linear_color, read_faces};
use super::loaded_mesh::LoadedMesh;
use super::model_file::ModelFile;
use super::notes::counted;
use super::read_error::{FilePosition, ReadError};
use super::text_lines::shown;
use super::uri::Files;
use geometry::casts::{to_byte, to_f32};
use geometry::mesh::Material;
use geometry::mesh::mesh_builder::InputCorner;

use header::{Element, Header, Property, PropertyKind, Scalar};
use textures::Textures;
use values::Values;

/// The names that the property of each attribute of a vertex may have.
const ATTRIBUTES: [&[&[u8]]; 12] = [
    &[b"x"],
    &[b"y"],
    &[b"z"],
    &[b"nx"],
    &[b"ny"],
    &[b"nz"],
    &[b"u", b"s", b"texture_u"],
    &[b"v", b"t", b"texture_v"],
    &[b"red", b"diffuse_red"],
    &[b"green", b"diffuse_green"],
    &[b"blue", b"diffuse_blue"],
    &[b"alpha"],
];
/// The first attribute of colours.
const RED: usize = 8;

/// Builds a mesh from a file's bytes.
///
/// # Errors
/// [`ReadError`]. An image that is missing isn't an error but a warning.
pub(super) fn read(bytes: Vec<u8>, file: &ModelFile) -> Result<LoadedMesh, ReadError> {
    read_faces(bytes, file, gather)
}

/// Reads all faces.
fn gather<'a>(bytes: &[u8], files: &'a Files<'a>, mut faces: FaceBuilder<'a>) -> Gathered<'a> {
    let header = header::read(bytes)?;
    let material = faces.material(Material::plain("default", [1.0; 4]))?;
    let mut reader = Reader {
        faces,
        plain: material,
        material,
        textures: Textures::new(&header.images),
        vertices: None,
        corners: Vec::new(),
        wedges: Vec::new(),
        cut_short: None,
        files,
    };
    let mut values = Values::new(&header, bytes.len());
    let mut before_vertices = Vec::new();
    for element in &header.elements {
        match (element.name, &reader.vertices) {
            (b"vertex", None) => {
                values.check(element)?;
                reader.vertices = Some(reader.read_vertices(element, &mut values)?);
            }
            (b"vertex", Some(_)) => return Err(values.place().error("the header has two elements named \"vertex\"")),
            (b"face" | b"tristrips", Some(_)) => reader.read_lists(element, &mut values)?,
            (name, vertices) => {
                let is_needed = vertices.is_none();
                if matches!(name, b"face" | b"tristrips") {
                    before_vertices.push((element, values.clone()));
                }
                let skipped = values.check(element).and_then(|()| values.skip(element, files.progress));
                // What comes after the faces isn't shown.
                skipped.or_else(|error| if is_needed { Err(error) } else { reader.cut(&values, element, error) })?;
            }
        }
        if reader.cut_short.is_some() {
            break;
        }
    }
    for (element, mut values) in before_vertices {
        reader.read_lists(element, &mut values)?;
    }
    let freed = bytes.len() as u64 + reader.vertices.as_ref().map_or(0, Vertices::bytes);
    let problems = reader.textures.give(&mut reader.faces, files, freed)?;
    Ok(reader.finish(&header, &values, problems))
}

/// The attributes of the vertices. Normals, uvs or colours are empty if the file has none.
#[derive(Default)]
struct Vertices {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    /// Bytes of red, green and blue, encoded as sRGB, and of alpha.
    colors: Vec<[u8; 4]>,
}

impl Vertices {
    /// Returns the number of a vertex, its corner, and its colour: linear RGBA. None if there is no such vertex.
    #[expect(clippy::cast_possible_truncation, reason = "one that is changed names no vertex or image")]
    fn corner(&self, index: f64) -> Option<(usize, InputCorner, Vec4)> {
        let vertex = index as usize;
        // The conversion changes an index that is negative, not whole or not finite.
        let position = self.positions.get(vertex).filter(|_| vertex as f64 == index)?;
        let uv = self.uvs.get(vertex).copied().unwrap_or_default();
        let corner = InputCorner { position: *position, normal: self.normals.get(vertex).copied(), uv };
        let color = self.colors.get(vertex).map_or(Vec4::ONE, |&color| linear_color(color));
        Some((vertex, corner, color))
    }

    /// Returns the size in memory, in bytes.
    fn bytes(&self) -> u64 {
        let beside = 12 * self.normals.capacity() + 8 * self.uvs.capacity() + 4 * self.colors.capacity();
        (12 * self.positions.capacity() + beside) as u64
    }
}

/// Which properties of an element are read.
#[derive(Clone, Copy)]
struct FaceProperties {
    /// The list of vertices.
    vertices: usize,
    /// The list of texture coordinates, if there is one.
    wedges: Option<usize>,
    /// The number of the image, if there are several.
    image: Option<usize>,
    /// Red, green and blue, and alpha if there is one, of a face whose vertices have no colours; and what makes them lie from 0 to 1.
    color: Option<([Option<usize>; 4], f32)>,
}

impl FaceProperties {
    /// Which channel of the colour a property is, if any.
    fn channel(&self, property: usize) -> Option<usize> {
        self.color?.0.iter().position(|place| *place == Some(property))
    }
}

struct Reader<'a, 'h> {
    faces: FaceBuilder<'a>,
    /// The material of faces without an image.
    plain: usize,
    /// The material of the next faces.
    material: usize,
    textures: Textures<'h>,
    vertices: Option<Vertices>,
    /// The corners of the face that is being read.
    corners: Vec<NumberedCorner>,
    /// Its own texture coordinates, u and v in turn; empty if it has none.
    wedges: Vec<f32>,
    /// A warning about a file that ends too early.
    cut_short: Option<String>,
    files: &'a Files<'a>,
}

impl<'a> Reader<'a, '_> {
    fn read_vertices(&self, element: &Element, values: &mut Values) -> Result<Vertices, ReadError> {
        let slots: Vec<Option<usize>> = element.properties.iter().map(slot).collect();
        let has = |slot: usize| slots.contains(&Some(slot));
        if !(has(0) && has(1) && has(2)) {
            return Err(values.place().error("the vertices have no x, y and z"));
        }
        let (has_normals, has_uvs, has_colors) = ((3..6).all(has), (6..8).all(has), (8..11).all(has));
        let scale = color_scale(element, &slots);
        // `values.check` has compared the count with the remaining bytes.
        let count = usize::try_from(element.count).unwrap_or_default();
        let beside = 12 * u64::from(has_normals) + 8 * u64::from(has_uvs) + 4 * u64::from(has_colors);
        let bytes = count as u64 * (12 + beside);
        self.files.budget.hold(bytes)?;
        let room = |has: bool| if has { count } else { 0 };
        let mut vertices = Vertices {
            positions: Vec::with_capacity(count),
            normals: Vec::with_capacity(room(has_normals)),
            uvs: Vec::with_capacity(room(has_uvs)),
            colors: Vec::with_capacity(room(has_colors)),
        };
        for i in 0..element.count {
            self.files.progress.step(i, || 0.5 * values.fraction())?;
            let mut found = [0.0; ATTRIBUTES.len()];
            // Alpha, where there is none.
            found[11] = 1.0 / scale;
            values.begin(element, i)?;
            for (property, slot) in element.properties.iter().zip(&slots) {
                match (property.kind, slot) {
                    (PropertyKind::One(scalar), Some(slot)) => found[*slot] = to_f32(values.next(scalar)?),
                    (kind, _) => values.skip_one(kind)?,
                }
            }
            values.end();
            let [x, y, z, nx, ny, nz, u, v, color @ ..] = found;
            vertices.positions.push(Vec3::new(x, y, z));
            if has_normals {
                vertices.normals.push(Vec3::new(nx, ny, nz));
            }
            if has_uvs {
                // The file's v points upwards, the mesh's downwards.
                vertices.uvs.push(Vec2::new(u, 1.0 - v));
            }
            if has_colors {
                // The conversion takes NaN for 0.
                vertices.colors.push(color.map(|channel| to_byte(channel * scale * 255.0)));
            }
        }
        Ok(vertices)
    }

    /// Reads an element of faces or of triangle strips, as far as the file goes.
    fn read_lists(&mut self, element: &Element, values: &mut Values) -> Result<(), ReadError> {
        let vertices = self.vertices.take().unwrap_or_default();
        let read = self.read_whole_lists(element, values, &vertices);
        self.vertices = Some(vertices);
        read.or_else(|error| self.cut(values, element, error))
    }

    /// Turns an error into a warning, if it is that the file ends too early.
    fn cut(&mut self, values: &Values, element: &Element, error: ReadError) -> Result<(), ReadError> {
        if !values.ends {
            return Err(error);
        }
        let Element { name, count, .. } = element;
        let name = shown(name);
        self.cut_short = Some(format!(
            "The file was cut short within its {count} elements {name}. What comes before its end is shown."
        ));
        Ok(())
    }

    fn read_whole_lists(
        &mut self,
        element: &Element,
        values: &mut Values,
        vertices: &Vertices,
    ) -> Result<(), ReadError> {
        let is_list = |property: &Property| {
            matches!(property.name, b"vertex_indices" | b"vertex_index")
                && matches!(property.kind, PropertyKind::List { .. })
        };
        let Some(list) = element.properties.iter().position(is_list) else {
            let reason = format!("the element {} has no list named \"vertex_indices\"", shown(element.name));
            return Err(values.place().error(reason));
        };
        let of_face = self.begin_faces(element, list, vertices)?;
        let faces = usize::try_from(values.most(element)).unwrap_or_default();
        self.faces.expect(faces, vertices.positions.len().min(faces.saturating_mul(4)));
        for i in 0..element.count {
            self.files.progress.step(i, || 0.5 * values.fraction())?;
            self.read_list(element, i, of_face, values, vertices)?;
        }
        Ok(())
    }

    /// Finds what an element of faces or of triangle strips has besides its list of vertices, and the material that it begins with.
    fn begin_faces(
        &mut self,
        element: &Element,
        list: usize,
        vertices: &Vertices,
    ) -> Result<FaceProperties, ReadError> {
        let named = |name: &[u8]| element.properties.iter().position(|property| property.name == name);
        let wedges = named(b"texcoord");
        let slots: Vec<_> = element.properties.iter().map(slot).collect();
        let places = [0, 1, 2, 3].map(|channel| slots.iter().position(|slot| *slot == Some(RED + channel)));
        let is_colored = vertices.colors.is_empty() && places[..3].iter().all(Option::is_some);
        let has_uvs = wedges.is_some() || !vertices.uvs.is_empty();
        let first = if has_uvs { self.textures.material(&mut self.faces, 0)? } else { None };
        self.material = first.unwrap_or(self.plain);
        let image = named(b"texnumber").filter(|_| first.is_some() && self.textures.names.len() > 1);
        // Where there is an image, colours count for nothing: scans have both.
        let is_uncolored = first.is_some() && image.is_none();
        let is_colored = is_colored && !is_uncolored && element.name == b"face";
        let color = is_colored.then(|| (places, color_scale(element, &slots)));
        if color.is_some() || !is_uncolored && !vertices.colors.is_empty() {
            self.faces.color()?;
        }
        Ok(FaceProperties { vertices: list, wedges, image, color })
    }

    /// Reads element number `i` of faces or of triangle strips.
    fn read_list(
        &mut self,
        element: &Element,
        i: u64,
        of_face: FaceProperties,
        values: &mut Values,
        vertices: &Vertices,
    ) -> Result<(), ReadError> {
        values.begin(element, i)?;
        let place = values.place();
        self.wedges.clear();
        // Alpha, where there is none, is the largest number.
        let opaque = of_face.color.map_or(1.0, |(_, scale)| 1.0 / scale);
        let (mut is_whole, mut image, mut color) = (true, 0.0, [0.0, 0.0, 0.0, opaque]);
        for (k, property) in element.properties.iter().enumerate() {
            match property.kind {
                PropertyKind::List { count, item } if k == of_face.vertices => {
                    let mut left = values.count(count, item)?;
                    let next = || {
                        let Some(less) = left.checked_sub(1) else { return Ok(None) };
                        left = less;
                        values.next(item).map(Some)
                    };
                    match element.name {
                        b"face" => is_whole = self.face(next, vertices, place)?,
                        _ => self.strip(next, vertices, place)?,
                    }
                }
                PropertyKind::List { count, item } if Some(k) == of_face.wedges => {
                    let length = values.count(count, item)?;
                    for i in 0..length {
                        let value = to_f32(values.next(item)?);
                        if i < 2 * MAX_CORNERS {
                            self.wedges.push(value);
                        }
                    }
                }
                PropertyKind::One(scalar) if Some(k) == of_face.image => image = values.next(scalar)?,
                PropertyKind::One(scalar) if let Some(channel) = of_face.channel(k) => {
                    color[channel] = to_f32(values.next(scalar)?);
                }
                kind => values.skip_one(kind)?,
            }
        }
        values.end();
        match element.name {
            b"face" if is_whole => {
                let color = self.look(of_face, image, color)?;
                self.add_face(color, place)?;
            }
            b"face" => self.faces.leave_out(place),
            _ => {}
        }
        Ok(())
    }

    /// Finds the material of a face by the number of its image. Returns the colour that it has in place of those of its vertices.
    #[expect(clippy::cast_possible_truncation, reason = "one that is changed names no vertex or image")]
    fn look(&mut self, of_face: FaceProperties, image: f64, color: [f32; 4]) -> Result<Option<Vec4>, ReadError> {
        if of_face.image.is_some() {
            // The conversion would take a negative number for 0.
            let image = if image >= 0.0 { image as usize } else { usize::MAX };
            self.material = self.textures.material(&mut self.faces, image)?.unwrap_or(self.plain);
            if self.material != self.plain {
                return Ok(Some(Vec4::ONE));
            }
        }
        let encoded = |scale: f32| color.map(|channel| to_byte(channel * scale * 255.0));
        Ok(of_face.color.map(|(_, scale)| linear_color(encoded(scale))))
    }

    /// Adds the face that was read, which may have a colour.
    fn add_face(&mut self, color: Option<Vec4>, place: FilePosition) -> Result<(), ReadError> {
        if let Some(color) = color {
            let number = self.faces.number(color)?;
            self.corners.iter_mut().for_each(|at| (at.number, at.vertex) = (number, None));
        }
        let wedges = self.wedges.as_chunks::<2>().0;
        if wedges.len() == self.corners.len() {
            for (at, &[u, v]) in self.corners.iter_mut().zip(wedges) {
                at.corner.uv = Vec2::new(u, 1.0 - v);
                at.vertex = None;
            }
        }
        self.faces.add(self.material, &mut self.corners, place)
    }

    /// Reads the corners of a face. Returns whether the file has all of its vertices.
    fn face(
        &mut self,
        mut next: impl FnMut() -> Result<Option<f64>, ReadError>,
        vertices: &Vertices,
        place: FilePosition,
    ) -> Result<bool, ReadError> {
        self.corners.clear();
        let mut is_whole = true;
        while let Some(index) = next()? {
            if self.corners.len() == MAX_CORNERS {
                return Err(place.error(format!("the face has more than {MAX_CORNERS} corners")));
            }
            match vertices.corner(index) {
                Some(corner) => self.push(corner)?,
                None => is_whole = false,
            }
        }
        Ok(is_whole)
    }

    fn push(&mut self, (vertex, corner, color): (usize, InputCorner, Vec4)) -> Result<(), ReadError> {
        let number = self.faces.number(color)?;
        let vertex = u32::try_from(vertex).ok().map(|vertex| [vertex, 0, 0]);
        self.corners.push(NumberedCorner { corner, number, vertex });
        Ok(())
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
            let [Some(a), Some(b), Some(c)] = triangle.map(|index| vertices.corner(index)) else {
                self.faces.leave_out(place);
                continue;
            };
            self.corners.clear();
            for corner in [a, b, c] {
                self.push(corner)?;
            }
            self.faces.add(self.material, &mut self.corners, place)?;
        }
        Ok(())
    }

    fn finish(self, header: &Header, values: &Values, problems: Vec<String>) -> (FaceBuilder<'a>, String) {
        let count = |name: &[u8]| {
            let own = header.elements.iter().filter(|element| element.name == name);
            own.map(|element| element.count).fold(0, u64::saturating_add)
        };
        let [vertices, faces, strips]: [u64; 3] = [b"vertex" as &[u8], b"face", b"tristrips"].map(count);
        let cut = if self.cut_short.is_some() { ", but it was cut short" } else { "" };
        let holds = format!("it holds {vertices} vertices, {faces} faces and {strips} strips of triangles{cut}");
        let read = self.vertices.unwrap_or_default();
        let without_normals = if read.normals.is_empty() { read.positions.len() } else { 0 };
        let mut faces = self.faces;
        faces.notes.extend(self.cut_short);
        let (without_normals, made) = faces.lacking_normals(without_normals, "vertices without normals");
        faces.notes.extend(counted([
            (header.other_lines, "lines of the header that aren't part of the format, left out"),
            (without_normals, made.as_str()),
            (values.long_lines, "lines with more numbers than their element has, left out"),
            (values.left_over(), "bytes after the last element, left out"),
            (header.images.len() - self.textures.names.len(), "images beyond the first 256, left out"),
        ]));
        faces.notes.extend(problems);
        self.files.budget.release(read.bytes());
        (faces, holds)
    }
}

/// Returns what colours are multiplied by to lie from 0 to 1. Whole numbers go up to the largest of their type.
fn color_scale(element: &Element, slots: &[Option<usize>]) -> f32 {
    let of_red = element.properties.iter().zip(slots).find(|(_, slot)| **slot == Some(RED));
    match of_red.map(|(property, _)| property.kind) {
        Some(PropertyKind::One(Scalar::F32 | Scalar::F64)) => 1.0,
        Some(PropertyKind::One(Scalar::U16)) => 1.0 / 65535.0,
        _ => 1.0 / 255.0,
    }
}

/// Returns which attribute a property of a vertex sets, if any.
fn slot(property: &Property) -> Option<usize> {
    let known = ATTRIBUTES.iter().position(|names| names.contains(&property.name));
    known.filter(|_| matches!(property.kind, PropertyKind::One(_)))
}

#[cfg(test)]
pub(super) mod tests;
