//! Reads one part of a model: its objects, groups of properties, and build.

mod groups;

use std::collections::HashMap;
use std::ops::Range;
use std::rc::Rc;

use glam::{DAffine3, DMat3, DVec3, Vec3};

use super::broken;
use super::properties::{Group, Texture2d};
use super::xml::Element;
use crate::memory_budget::Budget;
use crate::notes::{Notes, counts};
use crate::read_error::ReadError;
use crate::text_lines::{numbers, parsed, shown};
use geometry::casts::to_u32;
use geometry::mesh::chunked_vec::ChunkedVec;
use geometry::names;

/// Memory for an object or for a group besides what it holds, in bytes; maps grow to twice what they need.
const PER_ENTRY: u64 = 400;

/// What extensions are called in messages, by a part of their namespaces, and whether they are read.
const EXTENSIONS: [(&str, &str, bool); 8] = [
    ("3dmanufacturing/production", "production", true),
    ("3dmanufacturing/material", "materials and properties", true),
    ("3dmanufacturing/trianglesets", "triangle sets", true),
    ("3dmanufacturing/beamlattice", "beam lattice", false),
    ("3dmanufacturing/slice", "slices", false),
    ("3dmanufacturing/displacement", "displacement", false),
    ("3dmanufacturing/volumetric", "volumetric data", false),
    ("3dmanufacturing/securecontent", "secure content", false),
];

/// Where the elements of resources are.
const RESOURCES: &[u8] = b"/model/resources/";

/// The vertices and triangles of all objects. Each object has a range of both.
#[derive(Default)]
pub(super) struct Geometry {
    pub vertices: ChunkedVec<Vec3>,
    pub triangles: ChunkedVec<Triangle>,
    /// The distinct properties of triangles.
    pub looks: Vec<TriangleLook>,
    numbers: HashMap<TriangleLook, u32>,
}

/// A triangle of an object.
#[derive(Clone, Copy)]
pub(super) struct Triangle {
    /// Its corners in the object's vertices.
    pub corners: [u32; 3],
    /// Its properties in [`Geometry::looks`], counted from 1; 0 if it has none.
    pub look: u32,
}

/// A triangle's properties: its own group, or else the object's, and which of its entries each corner has.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct TriangleLook {
    pub group: Option<u32>,
    pub entries: [Option<u32>; 3],
}

impl TriangleLook {
    /// The entries of the corners, of which the first is this one. Without all three, it counts for the whole triangle.
    pub(super) fn of_corners(&self, first: u32) -> [u32; 3] {
        match self.entries {
            [Some(_), Some(second), Some(third)] => [first, second, third],
            _ => [first; 3],
        }
    }
}

impl Geometry {
    /// Returns the number of properties for [`Triangle::look`].
    fn look(&mut self, look: TriangleLook, budget: &Budget) -> Result<u32, ReadError> {
        if let Some(number) = self.numbers.get(&look) {
            return Ok(*number);
        }
        // The list grows by half, and the map to twice its size.
        budget.hold(6 * size_of::<TriangleLook>() as u64)?;
        self.looks.push(look);
        let number = to_u32(self.looks.len());
        self.numbers.insert(look, number);
        Ok(number)
    }
}

/// One part of a model.
#[derive(Default)]
pub(super) struct Part {
    /// Its name in the archive.
    pub name: String,
    /// The length of its unit in metres.
    pub unit: f64,
    pub objects: HashMap<u32, Object>,
    /// The numbers of its objects, in the file's order.
    pub order: Vec<u32>,
    pub groups: HashMap<u32, Group>,
    pub textures: HashMap<u32, Texture2d>,
    /// What its build places.
    pub items: Vec<Placed>,
}

/// An object: a mesh, or components.
#[derive(Default)]
pub(super) struct Object {
    /// Empty if it has none.
    pub name: String,
    pub vertices: Range<usize>,
    pub triangles: Range<usize>,
    /// The group of properties that triangles have which name none, and the entry.
    pub group: Option<u32>,
    pub entry: Option<u32>,
    pub components: Vec<Placed>,
    /// Which of [`UNREAD`] it has.
    pub unread: [bool; UNREAD.len()],
}

/// What an object may have that isn't read: in general, and in an object of the build.
pub(super) const UNREAD: [(&str, &str); 3] = [
    ("beam lattices", "beams (beam lattice extension)"),
    ("stacks of slices", "slices (slice extension)"),
    ("other shapes", "a shape that is neither a mesh nor components"),
];
const BEAMS: usize = 0;
const SLICES: usize = 1;
const SHAPE: usize = 2;

/// An object at a place.
#[derive(Clone)]
pub(super) struct Placed {
    pub object: u32,
    /// The part that has the object; none for the same part.
    pub path: Option<Rc<str>>,
    pub transform: DAffine3,
}

counts! {
    struct Counts {
        repeated => "objects with the id of another, left out";
        bad_colors => "colours that aren't #RRGGBB or #RRGGBBAA, replaced by white";
    }
}

/// Collects what a part has from its tags.
pub(super) struct ModelReader<'a> {
    part: Part,
    geometry: &'a mut Geometry,
    budget: &'a Budget,
    /// The names of the elements that are open, each behind a slash.
    open: Vec<u8>,
    /// The object that is open, with its number.
    object: Option<(u32, Object)>,
    group: Option<(u32, Group)>,
    paths: HashMap<String, Rc<str>>,
    is_model: bool,
    found: Counts,
    notes: &'a mut Notes,
}

impl<'a> ModelReader<'a> {
    pub(super) fn new(name: &str, geometry: &'a mut Geometry, budget: &'a Budget, notes: &'a mut Notes) -> Self {
        let part = Part { name: name.to_owned(), unit: 1e-3, ..Part::default() };
        Self {
            part,
            geometry,
            budget,
            open: Vec::new(),
            object: None,
            group: None,
            paths: HashMap::new(),
            is_model: false,
            found: Counts::default(),
            notes,
        }
    }

    /// Takes an opening tag, or none for a closing one.
    ///
    /// # Errors
    /// [`ReadError::Broken`] and [`ReadError::TooLarge`].
    pub(super) fn take(&mut self, tag: Option<Element>) -> Result<(), ReadError> {
        match tag {
            Some(element) => {
                self.open.push(b'/');
                // Elements that mean something have short names.
                let is_short = element.name().len() < 40 && !element.name().contains(&b'/');
                self.open.extend(if is_short { element.name() } else { b"?" });
                let path = std::mem::take(&mut self.open);
                let entered = self.enter(&path, &element);
                self.open = path;
                entered
            }
            None => {
                match self.open.as_slice() {
                    b"/model/resources/object" => self.end_object(),
                    path if path.strip_prefix(RESOURCES).is_some_and(|name| !name.contains(&b'/')) => self.end_group(),
                    _ => {}
                }
                self.open.truncate(memchr::memrchr(b'/', &self.open).unwrap_or(0));
                Ok(())
            }
        }
    }

    /// Reads an element, which means something by where it stands.
    fn enter(&mut self, path: &[u8], element: &Element) -> Result<(), ReadError> {
        match path {
            b"/model/resources/object/mesh/vertices/vertex" => self.vertex(element)?,
            b"/model/resources/object/mesh/triangles/triangle" => self.triangle(element)?,
            b"/model/resources/texture2dgroup/tex2coord" => self.coordinate(element)?,
            b"/model/resources/basematerials/base" | b"/model/resources/colorgroup/color" => self.entry(element)?,
            b"/model/resources/compositematerials/composite" | b"/model/resources/multiproperties/multi" => {
                self.combined(element)?;
            }
            b"/model" => self.model(element),
            b"/model/build/item" => {
                let item = self.placed(element)?;
                self.part.items.push(item);
            }
            b"/model/resources/object" => self.begin_object(element)?,
            b"/model/resources/object/components/component" => {
                let component = self.placed(element)?;
                self.object.iter_mut().for_each(|(_, object)| object.components.push(component.clone()));
            }
            b"/model/resources/object/mesh/beamlattice" => self.unread(BEAMS),
            b"/model/resources/object/mesh"
            | b"/model/resources/object/components"
            | b"/model/resources/object/metadatagroup" => {}
            b"/model/resources/basematerials" => self.begin_group(element, Group::Materials(Vec::new()))?,
            b"/model/resources/colorgroup" => self.begin_group(element, Group::Colors(Vec::new()))?,
            b"/model/resources/compositematerials" | b"/model/resources/multiproperties" => {
                self.begin_combined(element)?;
            }
            b"/model/resources/texture2d" => self.texture(element)?,
            b"/model/resources/texture2dgroup" => {
                // A texture without a number is one that isn't there.
                let texture = element.number(b"texid").unwrap_or(u32::MAX);
                self.begin_group(element, Group::Texture { texture, coordinates: Vec::new() })?;
            }
            _ => {
                let in_object = path.strip_prefix(b"/model/resources/object/");
                if in_object.is_some_and(|name| !name.contains(&b'/')) {
                    self.unread(SHAPE);
                }
            }
        }
        Ok(())
    }

    fn broken(&self, reason: impl std::fmt::Display) -> ReadError {
        broken(&self.part.name, reason)
    }

    fn unread(&mut self, what: usize) {
        self.object.iter_mut().for_each(|(_, object)| object.unread[what] = true);
    }

    fn model(&mut self, element: &Element) {
        self.is_model = true;
        let unit = element.text(b"unit").unwrap_or_default();
        self.part.unit = match unit.trim() {
            "micron" => 1e-6,
            "" | "millimeter" => 1e-3,
            "centimeter" => 1e-2,
            "inch" => 0.0254,
            "foot" => 0.3048,
            "meter" => 1.0,
            other => {
                let unit = shown(other.as_bytes());
                self.notes.push_once(format!("The unit {unit} isn't one of 3MF, so lengths count as millimetres."));
                1e-3
            }
        };
        let required = element.text(b"requiredextensions").unwrap_or_default();
        for prefix in required.split_ascii_whitespace() {
            let declared = [b"xmlns:", prefix.as_bytes()].concat();
            let namespace = element.attributes().find(|(key, _)| *key == declared).map(|(_, value)| value);
            let namespace = String::from_utf8_lossy(namespace.as_deref().unwrap_or(prefix.as_bytes())).into_owned();
            let known = EXTENSIONS.iter().find(|(part, ..)| namespace.contains(part));
            let name = match known {
                Some((.., true)) => continue,
                Some((_, name, false)) => (*name).to_owned(),
                None => names::shown(&namespace),
            };
            self.notes
                .push_once(format!("The file requires an extension that isn't read, so it may lack a part: {name}."));
        }
    }

    fn begin_object(&mut self, element: &Element) -> Result<(), ReadError> {
        let id = self.id(element, "object")?;
        self.budget.hold(PER_ENTRY)?;
        let (vertices, triangles) = (self.geometry.vertices.len(), self.geometry.triangles.len());
        let name = element.text(b"name").unwrap_or_default();
        self.budget.hold(name.len() as u64)?;
        let mut object = Object {
            name,
            vertices: vertices..vertices,
            triangles: triangles..triangles,
            group: element.number(b"pid"),
            entry: element.number(b"pindex"),
            ..Object::default()
        };
        object.unread[SLICES] = element.attribute(b"slicestackid").is_some();
        self.object = Some((id, object));
        Ok(())
    }

    fn end_object(&mut self) {
        let Some((id, mut object)) = self.object.take() else { return };
        object.vertices.end = self.geometry.vertices.len();
        object.triangles.end = self.geometry.triangles.len();
        if self.part.objects.contains_key(&id) {
            self.found.repeated += 1;
            return;
        }
        self.part.order.push(id);
        self.part.objects.insert(id, object);
    }

    fn id(&self, element: &Element, what: &str) -> Result<u32, ReadError> {
        element.number(b"id").ok_or_else(|| self.broken(format!("one of its elements {what} has no number as its id")))
    }

    /// What isn't a number becomes NaN, and leaves the faces out that use it.
    fn vertex(&mut self, element: &Element) -> Result<(), ReadError> {
        let mut position = Vec3::NAN;
        for (key, value) in element.attributes() {
            let axis = match key {
                b"x" => &mut position.x,
                b"y" => &mut position.y,
                b"z" => &mut position.z,
                _ => continue,
            };
            *axis = parsed(value.trim_ascii()).unwrap_or(f32::NAN);
        }
        self.budget.hold(self.geometry.vertices.next_bytes())?;
        self.geometry.vertices.push(position);
        Ok(())
    }

    fn triangle(&mut self, element: &Element) -> Result<(), ReadError> {
        let mut corners = [None; 3];
        let mut look = TriangleLook { group: None, entries: [None; 3] };
        for (key, value) in element.attributes() {
            let slot = match key {
                b"v1" => &mut corners[0],
                b"v2" => &mut corners[1],
                b"v3" => &mut corners[2],
                b"pid" => &mut look.group,
                b"p1" => &mut look.entries[0],
                b"p2" => &mut look.entries[1],
                b"p3" => &mut look.entries[2],
                _ => continue,
            };
            *slot = parsed(value.trim_ascii());
        }
        let [Some(a), Some(b), Some(c)] = corners else {
            let (id, first) = self.object.as_ref().map_or((0, 0), |(id, object)| (*id, object.triangles.start));
            let triangle = self.geometry.triangles.len() - first;
            return Err(
                self.broken(format!("triangle {triangle} of object {id} doesn't have the numbers of three vertices"))
            );
        };
        let is_plain = look.entries[0].is_none();
        let look = if is_plain { 0 } else { self.geometry.look(look, self.budget)? };
        self.budget.hold(self.geometry.triangles.next_bytes())?;
        self.geometry.triangles.push(Triangle { corners: [a, b, c], look });
        Ok(())
    }

    /// Reads an item of the build, or a component of an object.
    fn placed(&mut self, element: &Element) -> Result<Placed, ReadError> {
        self.budget.hold(2 * size_of::<Placed>() as u64)?;
        let object =
            element.number(b"objectid").ok_or_else(|| self.broken("a component or an item has no objectid"))?;
        let path = match element.text(b"path") {
            Some(path) => Some(self.path(path)?),
            None => None,
        };
        let transform = match element.attribute(b"transform") {
            Some(text) => self.transform(&text, object)?,
            None => DAffine3::IDENTITY,
        };
        Ok(Placed { object, path, transform })
    }

    /// Returns a path, which those that are equal share.
    fn path(&mut self, path: String) -> Result<Rc<str>, ReadError> {
        if let Some(known) = self.paths.get(&path) {
            return Ok(known.clone());
        }
        self.budget.hold(PER_ENTRY + 2 * path.len() as u64)?;
        let shared: Rc<str> = Rc::from(path.as_str());
        self.paths.insert(path, shared.clone());
        Ok(shared)
    }

    /// Parses the rows of a matrix that stands behind a row vector (core specification, section 3.3).
    fn transform(&self, text: &[u8], object: u32) -> Result<DAffine3, ReadError> {
        let (numbers, count) = numbers::<_, 12>(text, |word| parsed(word).unwrap_or(f64::NAN));
        if count != 12 || !numbers.iter().all(|number| number.is_finite()) {
            let text = shown(text);
            return Err(self.broken(format!("the transform {text} of object {object} isn't 12 finite numbers")));
        }
        let [a, b, c, d] = [0, 3, 6, 9].map(|i| DVec3::from_slice(&numbers[i..i + 3]));
        Ok(DAffine3::from_mat3_translation(DMat3::from_cols(a, b, c), d))
    }

    /// Returns the part, and says what was left out.
    ///
    /// # Errors
    /// [`ReadError::Broken`] if it isn't the part of a model.
    pub(super) fn finish(self) -> Result<Part, ReadError> {
        if !self.is_model {
            return Err(self.broken("it isn't a 3MF model: its first element isn't called \"model\""));
        }
        self.notes.extend(self.found.sentences());
        Ok(self.part)
    }
}
