//! Golden pictures: what the views of an asset must look like.

use std::path::{Path, PathBuf};

use image::{DynamicImage, RgbaImage};

use crate::cli::{CliError, make_folder};
use geometry::names::shown_path;
use inspect::shot::{Reference, write_drawn};

/// The golden pictures of an asset.
#[derive(Clone, Debug)]
pub(super) struct Golden {
    /// Where they lie: a folder with one for each named view; with `.png` behind it, that of the only view.
    place: PathBuf,
    /// Whether they are written in place of compared with.
    is_written: bool,
}

/// How a view compares with its golden picture.
pub(super) struct Compared {
    pub is_same: bool,
    /// How they differ, in a sentence without its end.
    pub text: String,
    pub difference: Option<DynamicImage>,
}

impl Golden {
    /// Those in a folder of an asset that lies at `place`, with `/` between folders.
    pub(super) fn new(folder: &Path, place: &str, is_written: bool) -> Self {
        // That of a shape, which Windows has in no name of a file.
        Self { place: folder.join(place.replace(':', "-")), is_written }
    }

    /// The picture of a view; the only one has no name.
    fn path(&self, view: &str) -> PathBuf {
        if !view.is_empty() {
            return self.place.join(format!("{view}.png"));
        }
        let mut path = self.place.clone().into_os_string();
        path.push(".png");
        path.into()
    }

    /// The pictures of these views; none if one isn't there, or they are to be written.
    pub(super) fn files<'a>(&self, views: impl Iterator<Item = &'a str>) -> Option<Vec<PathBuf>> {
        let there = |view| Some(self.path(view)).filter(|path| path.is_file());
        if self.is_written { None } else { views.map(there).collect() }
    }

    /// Compares a view that this adapter has drawn with its golden picture, or writes that.
    pub(super) fn compare(
        &self,
        view: &str,
        drawn: &RgbaImage,
        adapter: &wgpu::AdapterInfo,
    ) -> Result<Compared, CliError> {
        let path = self.path(view);
        let shown = shown_path(&path);
        let without = |is_same, text| Ok(Compared { is_same, text, difference: None });
        if self.is_written {
            path.parent().map_or(Ok(()), make_folder)?;
            write_drawn(&path, drawn, adapter, &[])?;
            return without(true, format!("{shown} was written"));
        }
        if !path.is_file() {
            return without(false, format!("there is no golden picture {shown}; write it with --update-golden"));
        }
        let reference = Reference::read(&path, None)?;
        Ok(match reference.compare(drawn, adapter) {
            Err(other_size) => return without(false, format!("{shown}: {other_size}")),
            Ok(verdict) => {
                let is_same = verdict.is_same();
                let difference = (!is_same).then(|| reference.difference(drawn, &verdict).into());
                let text = if is_same {
                    verdict.in_words()
                } else {
                    format!("it differs from {shown}: {}", verdict.in_words())
                };
                Compared { is_same, text, difference }
            }
        })
    }
}
