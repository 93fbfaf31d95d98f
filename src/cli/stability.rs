//! `pnaen stability`: cases that break tessellators, and whether what this program promises holds on them.

use std::path::{Path, PathBuf};

use clap::builder::PossibleValuesParser;

use super::tessellate::Device;
use super::{CliError, WeldOption, file_error, to_json, write_text};
use crate::engine::Engine;
use crate::mesh::{Progress, Source};
use crate::stability::{
    CASES, Case, Effort, LEGEND, Row, Subject, Verdict, lines, page, picture, run as run_case, table,
};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Meshes to run as well, after the cases chosen with --case; without --case, only these
    #[arg(value_parser = super::options::source())]
    pub files: Vec<Source>,
    #[command(flatten)]
    pub weld: WeldOption,
    /// Run only this case; may be given several times
    #[arg(long = "case", value_name = "NAME", value_parser = PossibleValuesParser::new(CASES.map(|case| case.name)))]
    pub cases: Vec<String>,
    /// Where to tessellate; both unless one is named
    #[arg(long, value_enum)]
    pub device: Option<Device>,
    /// Views for adaptive LOD and clipping, from all around, near, far and inside
    #[arg(long, value_name = "N", default_value_t = Effort::default().cameras, value_parser = clap::value_parser!(u32).range(0..=100_000))]
    pub cameras: u32,
    /// Print every measurement as JSON in place of the table
    #[arg(long)]
    pub json: bool,
    /// Folder for a picture of each case, and a page that explains them; made if it isn't there
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

impl Args {
    fn cases(&self) -> Vec<&'static Case> {
        let all = self.cases.is_empty() && self.files.is_empty();
        CASES.iter().filter(|case| all || self.cases.iter().any(|name| name == case.name)).collect()
    }

    /// Files as cases of their own.
    fn subjects(&self) -> impl Iterator<Item = Result<Subject, CliError>> {
        let cases = self.cases().into_iter().map(|case| Ok(case.subject()));
        let files = self.files.iter().map(|source| {
            let mesh = source.load(&Progress::default())?;
            Ok(Subject::new(source.title(), mesh, self.weld.weld))
        });
        cases.chain(files)
    }
}

pub fn run(args: &Args) -> Result<(), CliError> {
    let engine = if args.device == Some(Device::Cpu) { None } else { Some(Engine::headless()?) };
    let effort = Effort { cameras: args.cameras, cpu: args.device != Some(Device::Gpu), ..Effort::default() };
    if let Some(folder) = &args.output {
        std::fs::create_dir_all(folder).map_err(|error| file_error(folder, "made", &error))?;
    }
    let mut rows = Vec::new();
    for subject in args.subjects() {
        let subject = subject?;
        let own = run_case(&subject, engine.as_ref(), &effort)?;
        if !args.json {
            let text = table(&lines(&own));
            // The heading once.
            let rest = text.split_once('\n').map_or("", |(_, rest)| rest);
            write_text("-".as_ref(), if rows.is_empty() { &text } else { rest })?;
        }
        if let (Some(folder), Some(engine)) = (&args.output, &engine) {
            let drawn = picture(&subject, engine, effort.sweep_to)?;
            super::write_picture(&folder.join(file_name(&subject.name)), &drawn.into())?;
        }
        rows.extend(own);
    }
    if let Some(folder) = &args.output {
        let adapter = engine.as_ref().map_or("no other device", |engine| engine.gpu.info.name.as_str());
        write_text(&folder.join("README.md"), &page(&args.cases(), &lines(&rows), adapter))?;
    }
    if args.json {
        write_text("-".as_ref(), &to_json(&rows)?)?;
    } else {
        write_text("-".as_ref(), &format!("\n{LEGEND}\n"))?;
    }
    judge(&rows)
}

/// A case's name as a picture's, whatever the mesh is called.
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

    #[test]
    fn pictures_have_plain_names() {
        assert_eq!(file_name("split-normals"), "split-normals.png");
        assert_eq!(file_name("Cube, split normals"), "Cube--split-normals.png");
        assert_eq!(file_name("Fox.glb"), "Fox.png");
    }
}
