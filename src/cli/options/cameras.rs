//! The option `--cameras`: many views of one mesh.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::{Args, Parser};
use serde_json::{Map, Value};

use super::{CameraOption, ViewOptions};
use crate::cli::{CliError, file_error, read_text, refuse};
use geometry::names::{on_one_line, shown};

/// The most views.
const MOST: usize = 3600;

/// Views of one mesh, for each of which a command writes a file.
#[derive(Clone, Debug, Default, Args)]
pub struct CamerasOption {
    /// Write a file for each of many views: N from evenly around the mesh, or those of a file. It has a name and camera options
    /// for each, as JSON or on a line
    #[arg(
        long,
        value_name = "N|FILE",
        conflicts_with_all = ["camera", "file_camera", "view_projection", "max_triangles"]
    )]
    pub cameras: Option<Cameras>,
}

/// Where the views come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Cameras {
    /// So many, evenly around the mesh.
    Around(u32),
    File(PathBuf),
}

impl FromStr for Cameras {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.parse() {
            Ok(count) if (1..=MOST as u32).contains(&count) => Ok(Self::Around(count)),
            Ok(_) => Err(format!("expected 1 to {MOST} views, or a file")),
            Err(_) => Ok(Self::File(text.into())),
        }
    }
}

/// A view with its name, which its files have.
#[derive(Clone, Debug, Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
pub struct NamedView {
    /// What files of this view are called
    pub name: String,
    #[command(flatten)]
    pub view: ViewOptions,
}

impl CamerasOption {
    /// The file that the views are read from.
    pub fn file(&self) -> Option<&Path> {
        match self.cameras.as_ref()? {
            Cameras::File(path) => Some(path),
            Cameras::Around(_) => None,
        }
    }

    /// The views, each with a name of its own; none if the command works for a single one. `view` has the options that stand beside
    /// `--cameras`.
    pub fn views(&self, view: &ViewOptions) -> Result<Option<Vec<NamedView>>, CliError> {
        let Some(cameras) = &self.cameras else { return Ok(None) };
        match cameras {
            Cameras::Around(count) => Ok(Some((0..*count).map(|index| around(index, *count, view)).collect())),
            Cameras::File(path) => {
                refuse(
                    *view != ViewOptions::default(),
                    "--cameras FILE has each camera's options: write --target, --orthographic, --field-of-view and \
                         --roll into the file",
                )?;
                read(path).map(Some)
            }
        }
    }
}

/// View `index` of `count` evenly around the mesh: the direction of the spherical Fibonacci point set (Keinert et al. 2015,
/// "Spherical Fibonacci Mapping"), whose heights are in the middles of `count` slices of one area, and whose azimuths are
/// a golden angle apart.
fn around(index: u32, count: u32, view: &ViewOptions) -> NamedView {
    const GOLDEN_ANGLE: f64 = 137.507_764_050_037_85;
    let height = 1.0 - (2.0 * f64::from(index) + 1.0) / f64::from(count);
    let azimuth = (f64::from(index) * GOLDEN_ANGLE) % 360.0;
    let camera = CameraOption { azimuth: azimuth as f32, elevation: height.asin().to_degrees() as f32, distance: None };
    let digits = (count - 1).to_string().len();
    NamedView { name: format!("view-{index:0digits$}"), view: ViewOptions { camera, ..view.clone() } }
}

/// Reads a file of cameras.
fn read(path: &Path) -> Result<Vec<NamedView>, CliError> {
    let text = read_text(path)?;
    let fail = |reason: String| CliError::from(file_error(path, "read", &reason));
    let is_json = text.trim_start().starts_with(['[', '{']);
    let views = if is_json { parse_json(&text) } else { parse_lines(&text) }.map_err(fail)?;
    if views.is_empty() || views.len() > MOST {
        return Err(fail(format!("it has {} cameras; a command takes 1 to {MOST}", views.len())));
    }
    for (index, own) in views.iter().enumerate() {
        let name = own.name.to_lowercase();
        if views[..index].iter().any(|other| other.name.to_lowercase() == name) {
            return Err(fail(format!("two cameras are called {}; give each a name of its own", shown(&own.name))));
        }
    }
    Ok(views)
}

/// Reads a camera from its words: its name and then its options.
fn parse_words(words: Vec<String>) -> Result<NamedView, String> {
    let own = NamedView::try_parse_from(words).map_err(|error| said(&error))?;
    check_view_name(&own.name)?;
    Ok(own)
}

/// What an error of the command line says, in one line, without how the command line is used.
pub(crate) fn said(error: &clap::Error) -> String {
    let text = error.to_string();
    let lines = text.lines().take_while(|line| !line.trim().is_empty());
    let line = lines.map(str::trim).collect::<Vec<_>>().join(" ");
    on_one_line(line.strip_prefix("error: ").unwrap_or(&line))
}

/// Refuses the name of a view that its files can't have.
pub(crate) fn check_view_name(name: &str) -> Result<(), String> {
    let is_part = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.' | ' ');
    if name.is_empty() || name.starts_with(['.', ' ']) || !name.chars().all(is_part) {
        return Err(format!(
            "{} can't be the name of a file; use letters, digits, and - _ . between them",
            shown(name)
        ));
    }
    Ok(())
}

/// Reads one camera a line: its name and then its options, as on the command line. Lines that begin with # say nothing.
fn parse_lines(text: &str) -> Result<Vec<NamedView>, String> {
    let lines = text.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
    let lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    lines
        .map(|(number, line)| words(line).and_then(parse_words).map_err(|reason| format!("line {number}: {reason}")))
        .collect()
}

/// Splits a line at blanks, but not within quotes.
fn words(line: &str) -> Result<Vec<String>, String> {
    let (mut words, mut word, mut quote) = (Vec::new(), None::<String>, None);
    for c in line.chars() {
        match (quote, c) {
            (Some(open), c) if c == open => quote = None,
            (None, '"' | '\'') => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            (None, c) if c.is_whitespace() => words.extend(word.take()),
            (_, c) => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    if quote.is_some() { Err("a quote isn't closed".to_owned()) } else { Ok(words) }
}

/// Reads an array of objects, whose fields are `name` and camera options with underscores in place of hyphens.
fn parse_json(text: &str) -> Result<Vec<NamedView>, String> {
    let cameras: Vec<Map<_, _>> =
        serde_json::from_str(text).map_err(|error| format!("it is no JSON, or no array of objects: {error}"))?;
    let read = |(index, camera)| parse_object(camera).map_err(|reason| format!("camera {index}: {reason}"));
    cameras.iter().enumerate().map(read).collect()
}

fn parse_object(fields: &Map<String, Value>) -> Result<NamedView, String> {
    let Some(Value::String(name)) = fields.get("name") else { return Err("it has no name, a string".to_owned()) };
    let mut words = Vec::new();
    for (field, value) in fields.iter().filter(|(field, _)| *field != "name") {
        if field.is_empty() || !field.chars().all(|c| c.is_ascii_lowercase() || c == '_') {
            return Err(format!("unknown field {}", shown(field)));
        }
        let option = field.replace('_', "-");
        match (value, text_of(value)) {
            (Value::Bool(true), _) => words.push(format!("--{option}")),
            (Value::Bool(false), _) => {}
            (_, Some(text)) => words.push(format!("--{option}={text}")),
            _ => return Err(format!("{field} is no text, number, list of numbers, true or false")),
        }
    }
    parse_words([words, vec!["--".to_owned(), name.clone()]].concat())
}

/// A value as it stands on the command line.
fn text_of(value: &Value) -> Option<String> {
    match value {
        Value::String(text) => Some(text.clone()),
        Value::Number(number) => Some(number.to_string()),
        Value::Array(numbers) => {
            let numbers = numbers.iter().map(|number| number.as_number().map(ToString::to_string));
            numbers.collect::<Option<Vec<_>>>().map(|numbers| numbers.join(","))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn direction(view: &NamedView) -> glam::Vec3 {
        let CameraOption { azimuth, elevation, .. } = view.view.camera;
        let (azimuth, elevation) = (azimuth.to_radians(), elevation.to_radians());
        glam::vec3(azimuth.sin() * elevation.cos(), elevation.sin(), azimuth.cos() * elevation.cos())
    }

    #[test]
    fn views_are_evenly_around() {
        let usual = ViewOptions::default();
        for count in [1, 2, 8, 100] {
            let all: Vec<_> = (0..count).map(|index| around(index, count, &usual)).collect();
            let middle: glam::Vec3 = all.iter().map(direction).sum::<glam::Vec3>() / count as f32;
            assert!(count < 8 || middle.length() < 1.0 / count as f32, "{count}: {middle}");
            // Caps of one area each would have this radius; neighbours are at least 0.7 of that apart.
            let apart = 2.0 / (count as f32).sqrt();
            for (i, own) in all.iter().enumerate() {
                let near = all[..i].iter().any(|other| direction(own).distance(direction(other)) < 0.7 * apart);
                assert!(!near, "{count}: {}", own.name);
            }
        }
        assert_eq!(around(3, 100, &usual).name, "view-03");
    }

    #[test]
    fn lines_and_json_give_the_same_cameras() {
        let lines = parse_lines(
            "# a comment\nfront --camera 0,0\n\n'from above' --camera=10,80,3 --orthographic --target 0,1,0\nwide --field-of-view 90\n",
        );
        let json = parse_json(
            r#"[{"name": "front", "camera": [0, 0]},
                {"name": "from above", "camera": "10,80,3", "orthographic": true, "target": [0, 1, 0]},
                {"field_of_view": 90, "name": "wide", "orthographic": false}]"#,
        );
        let (lines, json) = (lines.expect("lines"), json.expect("JSON"));
        assert_eq!(lines.len(), 3);
        for (a, b) in lines.iter().zip(&json) {
            assert_eq!((&a.name, &a.view), (&b.name, &b.view));
        }
    }

    #[test]
    fn what_is_no_camera_is_refused_with_its_place() {
        let refused = |text: &str| {
            let read = if text.starts_with('[') { parse_json(text) } else { parse_lines(text) };
            read.expect_err("no cameras")
        };
        for (text, words) in [
            ("a --camera 0,0\nb --zoom 3", &["line 2", "--zoom"][..]),
            ("a --camera 0", &["line 1", "AZIMUTH,ELEVATION"]),
            ("--camera 0,0", &["line 1", "required"]),
            ("../a --camera 0,0", &["line 1", "../a can't be the name of a file"]),
            ("a 'b", &["line 1", "quote"]),
            ("a --camera 0,0 --file-camera x", &["line 1", "cannot be used with"]),
            (r#"[{"name": "a", "zoom": 3}]"#, &["camera 0", "zoom"]),
            (r#"[{"name": "a", "camera": null}]"#, &["camera 0", "camera is no text"]),
            (r#"[{"camera": [0, 0]}]"#, &["camera 0", "no name"]),
            (r#"[{"name": "a", "output=x": 3}]"#, &["camera 0", "unknown field output=x"]),
            ("[{}", &["EOF"]),
        ] {
            let said = refused(text);
            assert!(words.iter().all(|word| said.contains(word)), "{text}: {said}");
            assert_eq!(said.lines().count(), 1, "{said}");
        }
    }
}
