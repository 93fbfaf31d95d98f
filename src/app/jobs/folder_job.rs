//! The meshes beside the one that is open: those of its folder, or those that were dropped with it.

use std::path::{Path, PathBuf};

use super::companion_files::absolute_path;
use super::job_list::Work;
use crate::app::App;
use geometry::progress::{Cancelled, Progress};
use load::Source;
use load::format::Format;

/// Where a mesh is in the list of meshes that it belongs to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Neighbours {
    /// Its number, from 1 on.
    pub number: usize,
    pub count: usize,
    /// The mesh before it; that of the first one is the last one.
    pub before: PathBuf,
    pub after: PathBuf,
}

impl Neighbours {
    /// Finds a mesh in a list. None if it isn't there, or is alone.
    fn new(path: &Path, list: &[PathBuf]) -> Option<Self> {
        let count = list.len();
        let place = list.iter().position(|other| other == path).filter(|_| count > 1)?;
        let beside = |steps: usize| list[(place + steps) % count].clone();
        Some(Self { number: place + 1, count, before: beside(count - 1), after: beside(1) })
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
            Ok::<_, Cancelled>(Neighbours::new(&path, &list))
        };
        self.jobs.start(context, Work::Folder, String::new(), find, |app, _, found| {
            if let (Some(document), Ok(Ok(neighbours))) = (&mut app.document, found) {
                document.neighbours = neighbours;
            }
        });
    }

    /// Opens the mesh before or after the one that is open.
    pub(in crate::app) fn open_neighbour(
        &mut self,
        context: &egui::Context,
        which: impl FnOnce(Neighbours) -> PathBuf,
    ) {
        if let Some(neighbours) = self.document.as_ref().and_then(|document| document.neighbours.clone()) {
            self.open(context, Source::File(which(neighbours)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_goes_round() {
        let list = ["a.obj", "b.glb", "c.stl"].map(PathBuf::from);
        let of = |name: &str| Neighbours::new(Path::new(name), &list);
        let found = |number, before: &str, after: &str| {
            Some(Neighbours { number, count: 3, before: before.into(), after: after.into() })
        };
        assert_eq!(of("a.obj"), found(1, "c.stl", "b.glb"));
        assert_eq!(of("c.stl"), found(3, "b.glb", "a.obj"));
        assert_eq!(of("d.obj"), None);
        assert_eq!(Neighbours::new(Path::new("a.obj"), &list[..1]), None, "it is alone");
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
