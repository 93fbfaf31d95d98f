//! `pnaen stability`: cases that break tessellators, and whether what this program promises holds on them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::builder::PossibleValuesParser;

use super::tessellate::Device;
use super::{AdapterOption, CliError, WeldOption, file_error, to_json, write_text};
use crate::engine::Engine;
use crate::files::file_reason;
use crate::load::Source;
use crate::stability::{
    CASES, Case, Effort, LEGEND, PAGE, Row, Section, Subject, Verdict, lines, page, picture, run as run_case, table,
};

#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Meshes to run as well, after the cases chosen with --case; without --case, only these
    #[arg(value_parser = super::options::source())]
    pub files: Vec<Source>,
    /// For the files; cases have tolerances of their own
    #[command(flatten)]
    pub weld: WeldOption,
    /// Run only this case; may be given several times
    #[arg(long = "case", value_name = "NAME", value_parser = PossibleValuesParser::new(CASES.map(|case| case.name)))]
    pub cases: Vec<String>,
    /// Where to tessellate: cpu or gpu; without it, both
    #[arg(long, value_enum)]
    pub device: Option<Device>,
    /// Number of views for adaptive LOD and clipping: from all around, near, far and inside
    #[arg(long, value_name = "N", default_value_t = Effort::default().cameras, value_parser = clap::value_parser!(u32).range(0..=100_000))]
    pub cameras: u32,
    /// Print every measurement as JSON in place of the table
    #[arg(long)]
    pub json: bool,
    /// Folder for a picture of each case (if the GPU runs), and a page that explains them, stability.md; made if it isn't there
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub adapter: AdapterOption,
}

impl Args {
    fn cases(&self) -> impl Iterator<Item = Subject> {
        let all = self.cases.is_empty() && self.files.is_empty();
        let chosen = CASES.iter().filter(move |case| all || self.cases.iter().any(|name| name == case.name));
        chosen.map(Case::subject)
    }

    /// The chosen cases, then the files as cases of their own. All are loaded before the first one runs.
    fn subjects(&self) -> Result<Vec<Subject>, CliError> {
        let mut subjects: Vec<_> = self.cases().collect();
        for source in &self.files {
            let loaded = super::load(source, &self.weld.preparation())?;
            let name = free_name(&source.title(), &subjects);
            // With a crease band the mesh is welded already.
            let weld = if loaded.crease_band.width > 0.0 { 0.0 } else { self.weld.weld };
            subjects.push(Subject::new(name, Arc::unwrap_or_clone(loaded.mesh), weld));
        }
        Ok(subjects)
    }
}

pub(super) fn run(args: &Args) -> Result<(), CliError> {
    args.adapter.check(args.device == Some(Device::Cpu))?;
    let subjects = args.subjects()?;
    let engine = if args.device == Some(Device::Cpu) { None } else { Some(Engine::chosen(&args.adapter.choice())?) };
    let effort = Effort { cameras: args.cameras, cpu: args.device != Some(Device::Gpu), ..Effort::default() };
    if let Some(folder) = &args.output {
        std::fs::create_dir_all(folder).map_err(|error| file_error(folder, "made", &file_reason(&error)))?;
    }
    let (mut rows, mut sections) = (Vec::new(), Vec::new());
    for subject in subjects {
        let own = run_case(&subject, engine.as_ref(), &effort)?;
        if !args.json {
            let text = table(&lines(&own));
            // The heading is printed only once.
            let rest = text.split_once('\n').map_or("", |(_, rest)| rest);
            write_text("-".as_ref(), if rows.is_empty() { &text } else { rest })?;
        }
        let mut file = None;
        if let (Some(folder), Some(engine)) = (&args.output, &engine) {
            let drawn = picture(&subject, engine, effort.sweep_to)?;
            let name = file_name(&subject.name);
            super::write_picture(&folder.join(&name), &drawn.into())?;
            file = Some(name);
        }
        sections.push(Section { name: subject.name, about: subject.about, picture: file });
        rows.extend(own);
    }
    if let Some(folder) = &args.output {
        write_text(&folder.join(PAGE), &page(&sections, &rows))?;
    }
    if args.json {
        write_text("-".as_ref(), &to_json(&rows)?)?;
    } else {
        write_text("-".as_ref(), &format!("\n{LEGEND}\n"))?;
    }
    judge(&rows)
}

/// Returns the title, with a number added if another subject, or its picture, has that name already.
fn free_name(title: &str, taken: &[Subject]) -> String {
    let is_free = |name: &String| taken.iter().all(|subject| file_name(&subject.name) != file_name(name));
    let numbered = (2..).map(|number| {
        let (stem, extension) = title.rsplit_once('.').map_or((title, None), |(stem, rest)| (stem, Some(rest)));
        extension.map_or(format!("{stem} ({number})"), |extension| format!("{stem} ({number}).{extension}"))
    });
    std::iter::once(title.to_owned()).chain(numbered).find(is_free).unwrap_or_default()
}

/// Returns the name of a subject's picture, with hyphens for characters that file names may not have.
fn file_name(name: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '-' };
    let stem: String = name.chars().map(plain).collect();
    format!("{}.png", Path::new(&stem).file_stem().unwrap_or_default().to_string_lossy())
}

/// Fails if a promise doesn't hold.
fn judge(rows: &[Row]) -> Result<(), CliError> {
    let broken: Vec<_> = lines(rows).into_iter().filter(|line| line.verdict == Verdict::BreaksPromise).collect();
    match broken.first() {
        None => Ok(()),
        Some(line) => Err(CliError::Promise { count: broken.len(), case: line.case.clone(), method: line.method }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Mesh;

    #[test]
    fn names_and_pictures_are_unique() {
        let mut taken = vec![CASES[0].subject()];
        for name in ["split-normals.glb", "a.glb", "a.glb", "a.gltf", "a", "a"] {
            let name = free_name(name, &taken);
            taken.push(Subject::new(name, Mesh::default(), 0.0));
        }
        let names: Vec<_> = taken.iter().map(|subject| subject.name.as_str()).collect();
        let expected = ["split-normals (2).glb", "a.glb", "a (2).glb", "a (3).gltf", "a (4)", "a (5)"];
        assert_eq!(names[1..], expected);
    }

    #[test]
    fn pictures_have_plain_names() {
        assert_eq!(file_name("split-normals"), "split-normals.png");
        assert_eq!(file_name("Cube, split normals"), "Cube--split-normals.png");
        assert_eq!(file_name("Fox.glb"), "Fox.png");
    }
}
