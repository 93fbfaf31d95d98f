//! The files of a command that takes `--cameras`: one, or one for each view with the view's name in its own.

use std::path::{Path, PathBuf};

use glam::Vec2;

use super::options::{CamerasOption, MeshAt, NamedView, SurfaceOptions};
use super::{CliError, make_folder, refuse};
use geometry::names::shown;
use inspect::export::ending;
use inspect::render::Camera;
use load::Source;

/// What stands for a view's name in names of files.
const NAME: &str = "{}";

/// Where a command writes.
#[derive(Clone, Copy, Debug)]
pub(super) struct ViewFiles<'a> {
    /// The file, or with several views a folder or a name with `{}` in it.
    place: &'a Path,
    /// The endings that its files may have; those in a folder have the first.
    endings: &'static [&'static str],
    has_views: bool,
}

/// A view that a command works for, and the file that it writes for it.
#[derive(Clone, Debug)]
pub(super) struct View {
    /// The view, if it isn't that of the command's own camera options.
    pub named: Option<NamedView>,
    pub file: PathBuf,
}

impl<'a> ViewFiles<'a> {
    /// A command's output, or a folder that is read like it. Its files may have these endings; those in a folder have the first.
    pub(super) fn new(place: &'a Path, endings: &'static [&'static str], cameras: &CamerasOption) -> Self {
        Self { place, endings, has_views: cameras.cameras.is_some() }
    }

    /// The views that a command works for. `several` says what to do where one file is named for several views.
    pub(super) fn views(
        &self,
        cameras: &CamerasOption,
        surface: &SurfaceOptions,
        several: &'static str,
    ) -> Result<Vec<View>, CliError> {
        refuse(self.has_views && self.names_one(), several)?;
        let view = |named: NamedView| View { file: self.of(Some(&named.name)), named: Some(named) };
        Ok(match cameras.views(&surface.view)? {
            Some(views) => views.into_iter().map(view).collect(),
            None => vec![View { named: None, file: self.of(None) }],
        })
    }

    /// The file of a view: in the folder, or where the name has `{}` in it.
    pub(super) fn of(&self, view: Option<&str>) -> PathBuf {
        let Some(view) = view else { return self.place.to_owned() };
        match pattern(self.place) {
            Some(pattern) => self.place.with_file_name(pattern.replace(NAME, view)),
            None => self.place.join(format!("{view}.{}", self.endings[0])),
        }
    }

    /// Whether it is one file, whatever views there are.
    fn names_one(&self) -> bool {
        let is_file = self.place.as_os_str() == "-" || self.endings.contains(&ending(self.place).as_str());
        pattern(self.place).is_none() && is_file
    }

    /// Whether it is a folder that is made if it isn't there.
    fn is_folder(&self) -> bool {
        self.has_views && pattern(self.place).is_none()
    }

    /// The files of these views that are to be checked before the command begins: in a folder that is yet to be made there are none.
    pub(super) fn checked<'b>(&self, views: &'b [View]) -> Vec<Option<&'b Path>> {
        match self.is_folder() && !self.place.is_dir() {
            true => Vec::new(),
            false => views.iter().map(|view| Some(view.file.as_path())).collect(),
        }
    }

    /// Makes the folder, if it is one and isn't there.
    pub(super) fn make_folder(&self) -> Result<(), CliError> {
        if self.is_folder() { make_folder(self.place) } else { Ok(()) }
    }
}

impl View {
    /// The mesh's name, with the view's if there are several.
    pub(super) fn name_of(&self, mesh: &Source) -> String {
        let mesh = shown(&mesh.to_string());
        match &self.named {
            Some(NamedView { name, .. }) => format!("{mesh} from {name}"),
            None => mesh,
        }
    }

    /// The view's camera, which shows all of the mesh in the middle `size` px if nothing else is said.
    pub(super) fn camera(&self, surface: &SurfaceOptions, mesh: MeshAt, size: Vec2) -> Result<Camera, CliError> {
        let Some(NamedView { name, view }) = &self.named else { return surface.view.camera(surface, mesh, size) };
        let of_view = |error: CliError| CliError::View { view: shown(name), error: Box::new(error) };
        view.camera(surface, mesh, size).map_err(of_view)
    }
}

/// A file name that has a place for views' names.
fn pattern(place: &Path) -> Option<&str> {
    place.file_name()?.to_str().filter(|own| own.contains(NAME))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn files(place: &Path) -> ViewFiles<'_> {
        ViewFiles { place, endings: &["csv", "tsv"], has_views: true }
    }

    #[test]
    fn views_have_files_of_their_own_names() {
        for (place, expected) in [
            ("views", "views/top.csv"),
            ("v1.2", "v1.2/top.csv"),
            ("out-{}.csv", "out-top.csv"),
            ("a/{}-x.csv", "a/top-x.csv"),
        ] {
            let files = files(place.as_ref());
            assert_eq!(files.of(Some("top")), Path::new(expected));
            assert!(!files.names_one(), "{place}");
        }
        for place in ["a/b.csv", "b.TSV", "-"] {
            let files = files(place.as_ref());
            assert!(files.names_one(), "{place}");
            assert_eq!(files.of(None), Path::new(place));
        }
    }

    #[test]
    fn files_of_a_folder_are_checked_if_it_is_there() {
        let folder = tempfile::tempdir().expect("a folder");
        let checked = |place: &Path| {
            let view = View { named: None, file: place.join("top.csv") };
            files(place).checked(std::slice::from_ref(&view)).len()
        };
        assert_eq!((checked(folder.path()), checked(&folder.path().join("new"))), (1, 0));
        assert_eq!(checked("missing/{}.csv".as_ref()), 1, "the folder of a name isn't made");
    }
}
