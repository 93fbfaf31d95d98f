//! The meshes beside the one that is open: those of its folder, or those that were dropped with it.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::companion_files::absolute_path;
use super::job_list::Work;
use crate::app::App;
use geometry::progress::{Cancelled, Progress};
use load::Source;
use load::format::Format;

/// Where a mesh is in the list of meshes that it belongs to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Neighbours {
    list: Arc<[PathBuf]>,
    /// An index into the list, as is the next one.
    place: usize,
    /// The mesh that was asked for last. It may still be loaded, or can't be.
    asked: usize,
}

impl Neighbours {
    /// Finds a mesh in a list. None if it isn't there, or is alone.
    fn new(path: &Path, list: Arc<[PathBuf]>) -> Option<Self> {
        let place = list.iter().position(|other| other == path).filter(|_| list.len() > 1)?;
        Some(Self { list, place, asked: place })
    }

    /// The mesh's number, from 1 on, and how many there are.
    pub(crate) fn numbers(&self) -> [usize; 2] {
        [self.place + 1, self.list.len()]
    }

    /// Where another mesh is in the same list.
    pub(crate) fn of(self, path: &Path) -> Option<Self> {
        Self::new(path, self.list)
    }

    /// The mesh after the one that was asked for last, or before it. The list goes round.
    fn step(&mut self, forward: bool) -> PathBuf {
        self.asked = (self.asked + if forward { 1 } else { self.list.len() - 1 }) % self.list.len();
        self.list[self.asked].clone()
    }
}

/// The meshes of a folder in the order of their names, without regard to case. Empty if the folder can't be read.
fn meshes_of(folder: &Path, progress: &Progress) -> Result<Vec<PathBuf>, Cancelled> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        progress.check()?;
        let path = entry.path();
        if Format::from_name(&path).is_some() {
            found.push(path);
        }
    }
    found.sort_by_cached_key(|path| (path.to_string_lossy().to_lowercase(), path.clone()));
    Ok(found)
}

impl App {
    /// Finds the meshes beside the one that is open.
    pub(in crate::app) fn find_neighbours(&mut self, context: &egui::Context) {
        let Some(Source::File(path)) = self.source() else { return };
        let path = absolute_path(path.clone());
        let dropped = self.dropped.contains(&path).then(|| self.dropped.clone());
        let find = move |progress: &Progress| {
            let list = dropped.map_or_else(|| meshes_of(path.parent().unwrap_or(Path::new(".")), progress), Ok)?;
            Ok::<_, Cancelled>(Neighbours::new(&path, list.into()))
        };
        self.jobs.start(context, Work::Folder, String::new(), find, |app, _, found| {
            if let (Some(document), Ok(Ok(neighbours))) = (&mut app.document, found) {
                document.neighbours = neighbours;
            }
        });
    }

    /// Opens the mesh after the one that is open, or before it: one further, if that is being loaded or can't be.
    pub(in crate::app) fn open_neighbour(&mut self, context: &egui::Context, forward: bool) {
        if let Some(neighbours) = self.document.as_mut().and_then(|document| document.neighbours.as_mut()) {
            let path = neighbours.step(forward);
            self.open(context, Source::File(path));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_goes_round() {
        let list: Arc<[PathBuf]> = ["a.obj", "b.glb", "c.stl"].map(PathBuf::from).into();
        let of = |name: &str| Neighbours::new(Path::new(name), list.clone());
        let mut own = of("a.obj").expect("it is there");
        assert_eq!(own.numbers(), [1, 3]);
        let steps = [true, true, true, false, false].map(|forward| own.step(forward));
        assert_eq!(steps, ["b.glb", "c.stl", "a.obj", "c.stl", "b.glb"].map(PathBuf::from));
        assert_eq!(own.clone().of(Path::new("c.stl")), of("c.stl"));
        assert_eq!(of("d.obj"), None);
        assert_eq!(Neighbours::new(Path::new("a.obj"), list[..1].into()), None, "it is alone");
    }

    #[test]
    fn a_folder_has_its_meshes_in_order_and_one_that_is_gone_has_none() {
        let folder = tempfile::tempdir().expect("a writable temporary folder");
        for name in ["b.OBJ", "A.glb", "c.stl", "notes.txt", "a.png"] {
            std::fs::write(folder.path().join(name), "").expect("a writable temporary folder");
        }
        let names = |path: &Path| -> Vec<String> {
            let meshes = meshes_of(path, &Progress::new()).expect("not cancelled");
            meshes.iter().map(|path| path.file_name().unwrap().to_string_lossy().into_owned()).collect()
        };
        assert_eq!(names(folder.path()), ["A.glb", "b.OBJ", "c.stl"]);
        assert_eq!(names(&folder.path().join("none")), [""; 0]);
    }
}
