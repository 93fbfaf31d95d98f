//! The saved state as JSON. Each field is read on its own: one that is missing, unknown or out of range gets its value of a
//! first start, so that older and newer versions can read each other's files.

use std::ops::RangeInclusive;
use std::path::Path;

use egui::ThemePreference;
use glam::Vec3;
use serde_json::{Value, json};

use super::saved_settings::{read_settings, written_settings};
use crate::app::sections::{OpenSections, Section};
use crate::commands::{CompanionFile, MOST_BOOKMARKS};
use geometry::defaults::with_defaults;
use geometry::mesh::UpAxis;
use inspect::render::Camera;
use inspect::settings::{Choice, Settings};
use load::{FileUnit, Import, LengthUnit};

/// The greatest number of files that are saved with their cameras.
pub(super) const MAX_FILES: usize = 50;
/// The smallest width and height, and the largest side of a window, in points.
pub(crate) const LEAST_SIZE: [f32; 2] = [760.0, 480.0];
const LARGEST_SIDE: f32 = 16384.0;
/// The range of the window's zoom; 1 is the usual size.
const ZOOM_RANGE: RangeInclusive<f32> = 0.2..=5.0;
const FINITE: RangeInclusive<f32> = f32::MIN..=f32::MAX;
/// The range of a mesh's size, relative to the size when its camera was saved, in which that camera is still used.
const SAME_SIZE: RangeInclusive<f32> = 0.5..=2.0;
/// What is open beside the mesh and is opened again in the next window, each with its name in the file.
pub(super) const KEPT: [(CompanionFile, &str); 3] = [
    (CompanionFile::Environment, "environment"),
    (CompanionFile::LodShader, "lod_shader"),
    (CompanionFile::SurfaceShader, "surface_shader"),
];
const THEMES: [(ThemePreference, &str); 3] =
    [(ThemePreference::System, "system"), (ThemePreference::Light, "light"), (ThemePreference::Dark, "dark")];

with_defaults! {
    #[derive(Clone, Debug, PartialEq)]
    pub(super) struct SavedState {
        /// Without displacement, axis and unit, which depend on the mesh.
        pub settings: Settings = Settings::opening(),
        pub frame: WindowGeometry = WindowGeometry::default(),
        pub open: OpenSections = OpenSections::default(),
        /// The absolute paths of the files of [`KEPT`] that are open.
        pub companions: [Option<String>; KEPT.len()] = Default::default(),
        /// The file that was opened last comes first.
        pub files: Vec<SavedFile> = Vec::new(),
    }
}

with_defaults! {
    /// The window's size, theme and zoom.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct WindowGeometry {
        /// Width and height while it isn't maximised, in points without zoom.
        pub size: [f32; 2] = [1400.0, 860.0],
        pub is_maximized: bool = false,
        pub theme: ThemePreference = ThemePreference::System,
        pub zoom: f32 = 1.0,
    }
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct SavedFile {
    /// The absolute path.
    pub path: String,
    /// Which of its axes points up and what its unit is, if that was chosen: the names of these options' values, or the unit's length in
    /// metres.
    pub placement: Placement,
    pub seen: Option<SavedCamera>,
    pub bookmarks: Vec<SavedCamera>,
    /// Whether the file was missing when it was last opened. It isn't listed until it can be loaded again.
    pub is_gone: bool,
}

/// Which axis of a file points up, and what its unit is, if that was chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Placement {
    pub up: Option<UpAxis>,
    pub unit: Option<FileUnit>,
}

/// The camera that a mesh was last seen with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SavedCamera {
    pub camera: Camera,
    /// The mesh's bounding diagonal, in object units.
    pub diagonal: f32,
}

impl SavedCamera {
    /// Returns the camera, unless the mesh's size has changed too much.
    pub(super) fn camera_for(&self, diagonal: f32) -> Option<Camera> {
        SAME_SIZE.contains(&(diagonal / self.diagonal)).then_some(self.camera)
    }
}

impl SavedState {
    /// Parses a saved state. Returns none if it isn't a JSON object.
    pub(super) fn read(bytes: &[u8]) -> Option<Self> {
        let all: Value = serde_json::from_slice(bytes).ok()?;
        all.is_object().then(|| {
            let mut files: Vec<SavedFile> = Vec::new();
            for file in all["files"].as_array().into_iter().flatten().filter_map(SavedFile::read) {
                if files.len() < MAX_FILES && files.iter().all(|other| other.path != file.path) {
                    files.push(file);
                }
            }
            Self {
                settings: read_settings(&all["settings"]),
                frame: WindowGeometry::read(&all["window"]),
                open: read_open(&all["sections"]),
                companions: KEPT.map(|(_, name)| absolute(&all[name])),
                files,
            }
        })
    }

    /// Returns the JSON text, with a line end.
    pub(super) fn written(&self) -> String {
        let files: Vec<Value> = self.files.iter().map(SavedFile::written).collect();
        let is_open = |&section: &Section| (section.title().to_owned(), Value::from(self.open.has(section)));
        let mut written = json!({
            "settings": written_settings(&self.settings),
            "window": self.frame.written(),
            "sections": Section::ALL.iter().map(is_open).collect::<Value>(),
            "files": files,
        });
        KEPT.iter().zip(&self.companions).for_each(|((_, name), path)| written[*name] = json!(path));
        format!("{written:#}\n")
    }

    /// Takes settings, without displacement, axis and unit, which depend on the mesh.
    pub(super) fn take_settings(&mut self, settings: &Settings) {
        let own = settings.with(settings.tessellation.undisplaced());
        self.settings = Settings { import: Import { up: None, unit: None, ..own.import }, ..own };
    }
}

fn absolute(value: &Value) -> Option<String> {
    value.as_str().filter(|path| Path::new(path).is_absolute()).map(str::to_owned)
}

/// Reads a unit: its name, or its length in metres.
fn read_unit(value: &Value) -> Option<FileUnit> {
    match value {
        Value::String(name) => LengthUnit::named(name).map(FileUnit::Named),
        _ => FileUnit::from_metres(value.as_f64()? as f32),
    }
}

/// Reads which sections are open, by their titles.
fn read_open(value: &Value) -> OpenSections {
    let mut open = OpenSections::default();
    for section in Section::ALL {
        open.set(section, value[section.title()].as_bool().unwrap_or(open.has(section)));
    }
    open
}

impl WindowGeometry {
    fn read(value: &Value) -> Self {
        let opening = Self::default();
        let side = |name: &str, i: usize| number(&value[name], LEAST_SIZE[i]..=LARGEST_SIDE).unwrap_or(opening.size[i]);
        let theme = THEMES.iter().find(|(_, name)| value["theme"].as_str() == Some(name));
        Self {
            size: [side("width", 0), side("height", 1)],
            is_maximized: value["maximized"].as_bool().unwrap_or(opening.is_maximized),
            theme: theme.map_or(opening.theme, |(theme, _)| *theme),
            zoom: number(&value["zoom"], ZOOM_RANGE).unwrap_or(opening.zoom),
        }
    }

    fn written(&self) -> Value {
        let Self { size: [width, height], is_maximized, theme, zoom } = self;
        let theme = THEMES.iter().find(|(choice, _)| choice == theme).map(|(_, name)| name);
        json!({ "width": width, "height": height, "maximized": is_maximized, "theme": theme, "zoom": zoom })
    }
}

impl SavedFile {
    /// A file of which nothing is known but its path.
    pub(super) fn new(path: String) -> Self {
        Self { path, placement: Placement::default(), seen: None, bookmarks: Vec::new(), is_gone: false }
    }

    fn read(value: &Value) -> Option<Self> {
        let path = absolute(&value["path"])?;
        let is_gone = value["gone"].as_bool().unwrap_or(false);
        let bookmarks = value["bookmarks"].as_array().into_iter().flatten().filter_map(SavedCamera::read);
        let bookmarks = bookmarks.take(MOST_BOOKMARKS).collect();
        let placement = Placement { up: value["up"].as_str().and_then(UpAxis::named), unit: read_unit(&value["unit"]) };
        Some(Self { path, placement, seen: SavedCamera::read(value), bookmarks, is_gone })
    }

    fn written(&self) -> Value {
        let Placement { up, unit } = self.placement;
        let unit = unit.map(|unit| match unit {
            FileUnit::Named(unit) => json!(unit.name()),
            FileUnit::Metres(_) => json!(unit.metres()),
        });
        let seen = self.seen.as_ref().map(SavedCamera::written).unwrap_or_default();
        json!({
            "path": self.path,
            "gone": self.is_gone,
            "up": up.map(Choice::name),
            "unit": unit,
            "camera": seen["camera"],
            "diagonal": seen["diagonal"],
            "bookmarks": self.bookmarks.iter().map(SavedCamera::written).collect::<Value>(),
        })
    }
}

impl SavedCamera {
    /// The members that it has in the object of a file or of a bookmark.
    fn written(&self) -> Value {
        let mut camera = self.camera;
        let mut written: Value = numbers(&mut camera).into_iter().map(|(name, number)| (name, json!(number))).collect();
        written["target"] = json!(camera.target.to_array());
        written["orthographic"] = json!(camera.orthographic);
        json!({ "camera": written, "diagonal": self.diagonal })
    }

    fn read(file: &Value) -> Option<Self> {
        let all = &file["camera"];
        let target = Vec3::from_array(serde_json::from_value(all["target"].clone()).ok()?);
        let mut camera = Camera { target, orthographic: all["orthographic"].as_bool()?, ..Camera::default() };
        for (name, own) in numbers(&mut camera) {
            // Files of earlier versions don't have all of them.
            *own = all.get(name).map_or(Some(*own), |value| number(value, FINITE))?;
        }
        camera.is_sound().then_some(Self { camera, diagonal: number(&file["diagonal"], FINITE)? })
    }
}

/// A camera's numbers with their names. The window has no cameras of matrices.
fn numbers(camera: &mut Camera) -> [(&'static str, &mut f32); 5] {
    let Camera { target: _, azimuth, elevation, distance, orthographic: _, field_of_view, roll, rows: _ } = camera;
    [
        ("azimuth", azimuth),
        ("elevation", elevation),
        ("distance", distance),
        ("field_of_view", field_of_view),
        ("roll", roll),
    ]
}

/// Reads a number in a range.
fn number(value: &Value, range: RangeInclusive<f32>) -> Option<f32> {
    value.as_f64().map(|number| number as f32).filter(|number| range.contains(number))
}
