//! Finds the model in an archive, and reads its parts.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::path::Path;
use std::rc::Rc;

use super::archive::Archive;
use super::model::{Geometry, ModelReader, Part, Placed, UNREAD};
use super::{broken, xml};
use crate::format::Format;
use crate::memory_budget::Budget;
use crate::notes::Notes;
use crate::read_error::ReadError;
use geometry::names::shown;
use geometry::progress::Progress;

/// The type of the relationship to the model (core specification, appendix C.2).
const MODEL: &str = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";

/// Where the archive's relationships are.
const RELATIONSHIPS: &str = "_rels/.rels";

/// All parts of a model.
pub(super) struct Document {
    /// The first has the build.
    pub parts: Vec<Part>,
    pub geometry: Geometry,
    /// The numbers of parts by name. None for parts that aren't in the archive.
    numbers: HashMap<String, Option<usize>>,
}

/// Where an object is: the number of its part, and its own.
pub(super) type ObjectAt = (usize, u32);

impl Document {
    /// Reads the model, and the parts that it names (production extension). The budget holds its memory.
    pub(super) fn read(
        archive: &Archive,
        budget: &Budget,
        progress: &Progress,
        notes: &mut Notes,
    ) -> Result<Self, ReadError> {
        let root = root(archive, notes)?;
        let mut document = Self { parts: Vec::new(), geometry: Geometry::default(), numbers: HashMap::new() };
        let (all, mut before) = (archive.model_bytes().max(1) as f32, 0);
        // The parts that are named, each once, as those that name them come.
        let mut paths: Vec<Rc<str>> = vec![root.into()];
        document.numbers.insert(key(&paths[0]), None);
        let mut next = 0;
        while let Some(path) = paths.get(next).cloned() {
            next += 1;
            let Some(bytes) = archive.open(&path)? else {
                if next == 1 {
                    return Err(broken(&path, "the archive's relationships name it, but it isn't there"));
                }
                notes.push(format!("{} isn't in the archive, so its objects are left out.", shown(&path)));
                continue;
            };
            let mut reader = ModelReader::new(&path, &mut document.geometry, budget, notes);
            let (mut tags, mut end) = (0_u64, 0);
            xml::walk(&path, bytes, |tag, at| {
                progress.step(tags, || (before + at) as f32 / all)?;
                (tags, end) = (tags + 1, at);
                reader.take(tag)
            })?;
            before += end;
            let part = reader.finish()?;
            document.numbers.insert(key(&path), Some(document.parts.len()));
            for path in part.paths() {
                if let Entry::Vacant(unknown) = document.numbers.entry(key(path)) {
                    unknown.insert(None);
                    paths.push(path.clone());
                }
            }
            document.parts.push(part);
        }
        Ok(document)
    }

    /// Returns where an object is that a part places, if it is anywhere.
    pub(super) fn find(&self, part: usize, placed: &Placed) -> Option<ObjectAt> {
        let part = match &placed.path {
            Some(path) => self.numbers.get(&key(path)).copied().flatten()?,
            None => part,
        };
        self.parts[part].objects.contains_key(&placed.object).then_some((part, placed.object))
    }

    /// Says what it holds in case it has no triangles.
    pub(super) fn holds(&self) -> String {
        let objects: usize = self.parts.iter().map(|part| part.objects.len()).sum();
        let items = self.parts.first().map_or(0, |part| part.items.len());
        let triangles = self.geometry.triangles.len();
        let all: Vec<_> = self.parts.iter().flat_map(|part| part.objects.values()).collect();
        let count = |unread: usize| all.iter().filter(|object| object.unread[unread]).count();
        let others = UNREAD.iter().enumerate().map(|(unread, (what, _))| (count(unread), what));
        let others = others.filter(|(count, _)| *count > 0);
        let others: String = others.map(|(count, what)| format!(", {count} {what} (export them as meshes)")).collect();
        format!("it holds {objects} objects with {triangles} triangles{others}, and its build has {items} items")
    }
}

impl Part {
    /// The paths of other parts that it names.
    fn paths(&self) -> impl Iterator<Item = &Rc<str>> {
        let components = self.order.iter().filter_map(|id| self.objects.get(id)).flat_map(|object| &object.components);
        self.items.iter().chain(components).filter_map(|placed| placed.path.as_ref())
    }
}

/// A part's name as others may write it.
fn key(path: &str) -> String {
    path.trim_start_matches('/').to_ascii_lowercase()
}

/// Returns the name of the part with the build.
fn root(archive: &Archive, notes: &mut Notes) -> Result<String, ReadError> {
    let mut target = None;
    if let Some(relationships) = archive.open(RELATIONSHIPS)? {
        let read = xml::walk(RELATIONSHIPS, relationships, |tag, _| {
            if let Some(element) = tag
                && target.is_none()
                && element.text(b"Type").is_some_and(|kind| kind.trim() == MODEL)
            {
                target = element.text(b"Target");
            }
            Ok(())
        });
        notes.extend(read.err().map(|error| error.to_string()));
    }
    if let Some(target) = target.take_if(|target| archive.entry(target).is_some()) {
        return Ok(target);
    }
    let model = archive.names().find(|name| name.to_ascii_lowercase().ends_with(".model"));
    if let Some(name) = model {
        let said = match &target {
            Some(target) => format!("says that its model is {}, which isn't there", shown(target)),
            None => "doesn't say which part is its model".to_owned(),
        };
        notes.push(format!("The archive {said}, so {} is shown.", shown(name)));
        return Ok(name.to_owned());
    }
    if let Some(target) = target {
        return Ok(target);
    }
    let known = archive.names().find(|name| Format::from_name(Path::new(name)).is_some());
    let first = known.or(archive.names().find(|name| !name.ends_with('/'))).unwrap_or("none");
    Err(ReadError::NoModel { count: archive.names().len(), first: shown(first) })
}
