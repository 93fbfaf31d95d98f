//! Places the objects of a build: their triangles, transformed, with their materials and colours.

use std::collections::HashMap;

use glam::{DAffine3, DMat3, DVec3};

use super::broken;
use super::document::{Document, ObjectAt};
use super::looks::{Faults, Looks, Resolved};
use super::model::{Object, Placed, Triangle, UNREAD};
use super::properties::Group;
use crate::face_builder::{FaceBuilder, NumberedCorner};
use crate::import::Import;
use crate::memory_budget::{Budget, edge_bytes};
use crate::notes::{Notes, counted};
use crate::parts::node_path;
use crate::read_error::{FilePosition, ReadError};
use geometry::mesh::build_limits::MAX_TRIANGLES;
use geometry::mesh::mesh_builder::InputCorner;
use geometry::progress::Progress;

/// How deep components may be nested.
const MAX_NESTING: usize = 64;

/// Places everything that the build has, or all objects if it has nothing. Returns which materials show images, and their names.
pub(super) fn place(
    document: &Document,
    faces: &mut FaceBuilder,
    budget: &Budget,
    progress: &Progress,
) -> Result<Vec<(usize, String)>, ReadError> {
    let items = items(document, &mut faces.notes);
    let mut counter = Counter { document, counted: HashMap::new(), missing: 0 };
    let mut total = 0_u64;
    for item in &items {
        total = total.saturating_add(counter.placed(0, item, 0)?);
    }
    if total > MAX_TRIANGLES {
        return Err(ReadError::TooMany { limit: MAX_TRIANGLES, what: "triangles" });
    }
    // Many copies of an object are refused before any is made.
    budget.check(edge_bytes(0, total))?;
    faces.expect(usize::try_from(total).unwrap_or(usize::MAX), document.geometry.vertices.len());
    let colors = |group: &Group| matches!(group, Group::Colors(colors) if !colors.is_empty());
    if document.parts.iter().any(|part| part.groups.values().any(colors)) {
        faces.color()?;
    }
    let root = of_file(document, &faces.import);
    let mut placer = Placer {
        document,
        counted: &counter.counted,
        faces,
        looks: Looks::new(document),
        names: Vec::new(),
        corners: Vec::new(),
        found: Faults::default(),
        progress,
        done: 0,
        total,
    };
    for item in &items {
        placer.placed(0, item, root)?;
    }
    let Placer { faces, looks, found, .. } = placer;
    faces.notes.extend(counted([(counter.missing, "components and items whose object isn't in the file, left out")]));
    faces.notes.extend(unread(document, &counter.counted));
    faces.notes.extend(found.sentences());
    Ok(looks.textured)
}

/// Turns axes so that Y points up in place of Z, and scales the file's unit to metres, unless another axis or unit was chosen.
fn of_file(document: &Document, import: &Import) -> DAffine3 {
    let turn = match import.up {
        None => DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y),
        Some(_) => DMat3::IDENTITY,
    };
    let unit = document.parts.first().map_or(1.0, |part| part.unit);
    DAffine3::from_mat3(turn * if import.unit.is_none() { unit } else { 1.0 })
}

/// What is shown: the items of the build. A library of objects has none, so all objects are that aren't components.
fn items(document: &Document, notes: &mut Notes) -> Vec<Placed> {
    let Some(root) = document.parts.first() else { return Vec::new() };
    if !root.items.is_empty() || root.objects.is_empty() {
        return root.items.clone();
    }
    notes.push("The build has no items, so all objects are shown.".to_owned());
    let components = || root.objects.values().flat_map(|object| &object.components);
    let within: std::collections::HashSet<u32> = components().map(|component| component.object).collect();
    let alone = root.order.iter().filter(|id| !within.contains(id));
    alone.map(|&object| Placed { object, path: None, transform: DAffine3::IDENTITY }).collect()
}

/// Counts triangles, and checks that no object is among its own components.
struct Counter<'d> {
    document: &'d Document,
    /// The triangles of each object with its components; none while they are being counted.
    counted: HashMap<ObjectAt, Option<u64>>,
    missing: usize,
}

impl Counter<'_> {
    fn placed(&mut self, part: usize, placed: &Placed, nesting: usize) -> Result<u64, ReadError> {
        let Some(at) = self.document.find(part, placed) else {
            self.missing += 1;
            return Ok(0);
        };
        let wrong = |reason: String| {
            let part = &self.document.parts[at.0].name;
            Err(broken(part, format!("object {} {reason}", at.1)))
        };
        match self.counted.get(&at) {
            Some(Some(count)) => return Ok(*count),
            Some(None) => return wrong("is among its own components".to_owned()),
            None => {}
        }
        if nesting == MAX_NESTING {
            return wrong(format!("is a component of others, nested more than {MAX_NESTING} deep"));
        }
        self.counted.insert(at, None);
        let object = &self.document.parts[at.0].objects[&at.1];
        let mut count = object.triangles.len() as u64;
        for component in &object.components {
            count = count.saturating_add(self.placed(at.0, component, nesting + 1)?);
        }
        self.counted.insert(at, Some(count));
        Ok(count)
    }
}

/// Says what isn't read of these objects.
fn unread<T>(document: &Document, shown: &HashMap<ObjectAt, T>) -> Vec<String> {
    let shown: Vec<_> = shown.keys().map(|(part, id)| &document.parts[*part].objects[id]).collect();
    let count = |unread: usize| shown.iter().filter(|object| object.unread[unread]).count();
    let kinds = UNREAD.iter().enumerate();
    let said = kinds.map(|(i, (_, what))| (count(i), format!("objects of the build with {what}, which aren't read")));
    counted(said).collect()
}

struct Placer<'d, 'a> {
    document: &'d Document,
    counted: &'d HashMap<ObjectAt, Option<u64>>,
    faces: &'d mut FaceBuilder<'a>,
    looks: Looks<'d>,
    /// The names of the object that is being placed, and of those that it is a component of.
    names: Vec<&'d str>,
    corners: Vec<NumberedCorner>,
    found: Faults,
    progress: &'d Progress,
    done: u64,
    total: u64,
}

impl Placer<'_, '_> {
    fn placed(&mut self, part: usize, placed: &Placed, outer: DAffine3) -> Result<(), ReadError> {
        let Some(at) = self.document.find(part, placed) else { return Ok(()) };
        // Components without triangles may be very many.
        if self.counted.get(&at).copied().flatten().unwrap_or(0) == 0 {
            return Ok(());
        }
        let transform = outer * placed.transform;
        let object = &self.document.parts[at.0].objects[&at.1];
        self.names.push(&object.name);
        self.mesh(at, object, transform)?;
        object.components.iter().try_for_each(|component| self.placed(at.0, component, transform))?;
        self.names.pop();
        Ok(())
    }

    fn mesh(&mut self, at: ObjectAt, object: &Object, transform: DAffine3) -> Result<(), ReadError> {
        let (path, _) = node_path(self.names.iter().rev().map(|name| (*name, false)));
        self.faces.enter_part(path.as_bytes(), 0)?;
        let is_mirrored = transform.matrix3.determinant() < 0.0;
        let mut last: Option<(u32, Resolved)> = None;
        for i in object.triangles.clone() {
            self.progress.step(self.done, || self.done as f32 / self.total.max(1) as f32)?;
            self.done += 1;
            let Some(&Triangle { corners, look }) = self.document.geometry.triangles.get(i) else { continue };
            let resolved = match last {
                Some((number, resolved)) if number == look => resolved,
                _ => self.looks.resolve(self.faces, at.0, object, look)?,
            };
            last = Some((look, resolved));
            self.found += resolved.faults;
            self.corners.clear();
            for ((corner, number), uv) in corners.into_iter().zip(resolved.numbers).zip(resolved.uvs) {
                let vertex = object.vertices.clone().nth(corner as usize);
                let position =
                    vertex.and_then(|vertex| self.document.geometry.vertices.get(vertex)).ok_or_else(|| {
                        let (part, triangle) = (&self.document.parts[at.0].name, i - object.triangles.start);
                        let (id, count) = (at.1, object.vertices.len());
                        broken(
                            part,
                            format!("triangle {triangle} of object {id} uses vertex {corner}, but it has {count}"),
                        )
                    })?;
                let position = transform.transform_point3(position.as_dvec3()).as_vec3();
                let corner = InputCorner { position, normal: None, uv };
                self.corners.push(NumberedCorner { corner, number, vertex: None });
            }
            if is_mirrored {
                self.corners.reverse();
            }
            self.faces.add(resolved.material, &mut self.corners, FilePosition::Everywhere)?;
        }
        Ok(())
    }
}
