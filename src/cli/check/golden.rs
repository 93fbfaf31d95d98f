//! Golden pictures: what the views of an asset must look like.

use std::path::{Path, PathBuf};

use image::{DynamicImage, RgbaImage};

use crate::cli::{CliError, make_folder};
use geometry::names::shown_path;
use inspect::shot::{Reference, write_drawn};
use lab::check::{GOLDEN, GateResult};

/// The golden pictures of an asset.
#[derive(Clone, Debug)]
pub(super) struct Golden {
    /// Where they lie: a folder with one for each named view; with `.png` behind it, that of the only view.
    place: PathBuf,
    /// Whether they are written in place of compared with.
    is_written: bool,
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

    /// Compares a view that this adapter has drawn with its golden picture, or writes that. Returns the result, and a picture
    /// of how they differ.
    pub(super) fn compare(
        &self,
        view: &str,
        drawn: &RgbaImage,
        adapter: &wgpu::AdapterInfo,
    ) -> Result<(GateResult, Option<DynamicImage>), CliError> {
        let path = self.path(view);
        let shown = shown_path(&path);
        let judged = |passed, text| GateResult { name: GOLDEN[0].to_owned(), passed, text, ..GateResult::default() };
        if self.is_written {
            path.parent().map_or(Ok(()), make_folder)?;
            write_drawn(&path, drawn, adapter, &[])?;
            return Ok((judged(true, format!("{shown} was written")), None));
        }
        if !path.is_file() {
            let text = format!("there is no golden picture {shown}; write it with --update-golden");
            return Ok((judged(false, text), None));
        }
        let reference = Reference::read(&path, None)?;
        Ok(match reference.compare(drawn, adapter) {
            Err(other_size) => (judged(false, format!("{shown}: {other_size}")), None),
            Ok(verdict) if verdict.is_same() => (judged(true, verdict.in_words()), None),
            Ok(verdict) => {
                let text = format!("it differs from {shown}: {}", verdict.in_words());
                (judged(false, text), Some(reference.difference(drawn, &verdict).into()))
            }
        })
    }
}
