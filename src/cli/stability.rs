//! `pnaen stability`: cases that break tessellators, and whether what this program promises holds on them.

mod evidence;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use super::gate_options::GateOptions;
use super::options::{named, whole};
use super::tessellate::Device;
use super::{AdapterOption, CliError, WeldOption, make_folder, refuse, to_json, write_text};
use geometry::mesh::{Topology, t_junctions};
use geometry::progress::Progress;
use inspect::engine::Engine;
use inspect::gates::{Facts, GateKind, judge};
use inspect::render::Leaks;
use lab::stability::{
    CASES, Case, Effort, Failure, LEGEND, Line, Method, PAGE, Row, Subject, Verdict, are_judged, failures, lines, page,
    picture, run as run_case, table,
};
use load::Source;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Meshes to run as well, after the cases chosen with --case; without --case, only these
    #[arg(value_parser = super::options::source())]
    pub files: Vec<Source>,
    /// Weld tolerance for the given files (built-in cases use their own)
    #[command(flatten)]
    pub weld: WeldOption,
    /// Run only this case; may be given several times
    #[arg(long = "case", value_name = "NAME", value_parser = PossibleValuesParser::new(CASES.map(|case| case.name)))]
    pub cases: Vec<String>,
    /// Run only this method; may be given several times
    #[arg(long = "method", value_name = "METHOD", value_parser = method())]
    pub methods: Vec<Method>,
    /// Where to tessellate: cpu or gpu; without it, both
    #[arg(long, value_enum)]
    pub device: Option<Device>,
    /// Number of views for adaptive LOD and clipping: from all around, near, far and inside
    #[arg(long, value_name = "N", default_value_t = Effort::default().cameras, value_parser = whole(0..=100_000_u32))]
    pub cameras: u32,
    /// Print every measurement as JSON in place of the table
    #[arg(long)]
    pub json: bool,
    /// Folder for a picture of each case (if the GPU runs), and a page that explains them, stability.md; made if it isn't there
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub gates: GateOptions,
    #[command(flatten)]
    pub adapter: AdapterOption,
}

/// Parses a method's name.
fn method() -> impl TypedValueParser<Value = Method> {
    let find = |name: &str| Method::all().into_iter().find(|method| method.option() == name);
    named(Method::all().into_iter().map(|method| PossibleValue::new(method.option())), find)
}

impl Args {
    /// Refuses gates that judge one tessellation, and what needs a device that isn't used.
    fn check(&self) -> Result<(), CliError> {
        self.adapter.check(self.device == Some(Device::Cpu))?;
        refuse(
            GateKind::ALL
                .into_iter()
                .any(|kind| !kind.is_of_mesh() && !kind.needs_survey() && self.gates.gates.has(kind)),
            "--fail-on above-tolerance, self-intersections, deviation, pops, triangles and bytes judge one tessellation, and stability runs many: use \
             render or tessellate",
        )?;
        self.gates.check(self.device == Some(Device::Cpu))
    }

    /// The chosen cases, then the files as cases of their own. All are loaded before the first one runs.
    fn subjects(&self) -> Result<Vec<Subject>, CliError> {
        let all = self.cases.is_empty() && self.files.is_empty();
        let chosen = CASES.iter().filter(|case| all || self.cases.iter().any(|name| name == case.name));
        let mut subjects: Vec<_> = chosen.map(Case::subject).collect();
        for source in &self.files {
            let loaded = super::load(source, &self.weld.preparation())?;
            let name = free_name(&source.title(), &subjects);
            // With a crease band the mesh is welded already.
            let weld = if loaded.crease_band.width > 0.0 { 0.0 } else { self.weld.weld };
            let own = Subject::new(name, Arc::unwrap_or_clone(loaded.mesh), weld);
            subjects.push(Subject { warnings: loaded.warnings, ..own });
        }
        Ok(subjects)
    }

    fn effort(&self) -> Effort {
        let mut effort = Effort { cameras: self.cameras, cpu: self.device != Some(Device::Gpu), ..Effort::default() };
        if !self.methods.is_empty() {
            effort.methods.clone_from(&self.methods);
        }
        effort.folds = self.gates.gates.has(GateKind::Folds);
        effort
    }

    /// Judges a mesh by the gates that its rows don't judge: those that are about the mesh itself, and those that could be judged in no
    /// view. Returns those that fail.
    fn judge_mesh(&self, subject: &Subject, effort: &Effort, rows: &[Row]) -> Result<Vec<Failure>, CliError> {
        let mut gates = self.gates.gates.fail_on.clone();
        gates.retain(|gate| !are_judged(gate.kind, &effort.methods, rows));
        if gates.is_empty() {
            return Ok(Vec::new());
        }
        let topology = Topology::build_within(&subject.mesh, subject.weld, &Progress::new())?;
        let junctions = t_junctions(&topology, &Progress::new())?;
        let leaks = Leaks::uncounted(&topology).unwrap_or(Leaks::InNoView);
        let facts = Facts {
            mesh: Some((&subject.mesh, &topology)),
            junctions: Some(&junctions),
            warnings: Some(&subject.warnings),
            leaks: Some(&leaks),
            ..Facts::from_mesh(&topology)
        };
        let judged = judge(&gates, &facts);
        let failed = judged.iter().filter(|judgement| !judgement.passed);
        let failure = failed.map(|judgement| Failure {
            kind: judgement.kind,
            case: subject.name.clone(),
            sentence: judgement.sentence_of(&subject.name),
            tried: None,
        });
        Ok(failure.collect())
    }

    /// Draws the picture of a subject into the folder of `-o`, if there are one and a device. Returns the file's name.
    fn picture(&self, subject: &Subject, engine: Option<&Engine>, effort: &Effort) -> Result<Option<String>, CliError> {
        let Some((folder, engine)) = self.output.as_ref().zip(engine) else { return Ok(None) };
        let name = file_name(&subject.name);
        inspect::shot::write_picture(&folder.join(&name), &picture(subject, engine, effort.sweep_to)?.into())?;
        Ok(Some(name))
    }
}

pub(super) fn run(args: &Args) -> Result<(), CliError> {
    args.check()?;
    let subjects = args.subjects()?;
    let engine = if args.device == Some(Device::Cpu) { None } else { Some(Engine::chosen(&args.adapter.choice())?) };
    let effort = args.effort();
    args.output.as_deref().map_or(Ok(()), make_folder)?;
    let (mut rows, mut sections, mut failed) = (Vec::new(), Vec::new(), Vec::new());
    for subject in &subjects {
        let own = run_case(subject, engine.as_ref(), &effort)?;
        failed.extend(args.judge_mesh(subject, &effort, &own)?);
        if !args.json {
            let text = table(&lines(&own));
            // The heading is printed only once.
            let rest = text.split_once('\n').map_or("", |(_, rest)| rest);
            write_text("-".as_ref(), if rows.is_empty() { &text } else { rest })?;
        }
        sections.push((subject, args.picture(subject, engine.as_ref(), &effort)?));
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
    failed.extend(failures(&args.gates.gates.fail_on, &rows));
    if let Some(engine) = engine.as_ref().filter(|_| args.gates.evidence.is_some()) {
        evidence::write(&args.gates, engine, &subjects, &failed)?;
    }
    let mut said: Vec<String> = failed.into_iter().map(|failure| failure.sentence).collect();
    said.extend(broken_promises(&rows));
    if said.is_empty() { Ok(()) } else { Err(CliError::Gates(said)) }
}

/// Returns the title, with a number added if another subject, or its picture, has that name already.
fn free_name(title: &str, taken: &[Subject]) -> String {
    let is_free = |name: &String| taken.iter().all(|other| file_name(&other.name) != file_name(name));
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

/// Says which promises don't hold.
fn broken_promises(rows: &[Row]) -> Option<String> {
    let broken: Vec<_> = lines(rows).into_iter().filter(|line| line.verdict == Verdict::BreaksPromise).collect();
    let (count, Line { case, method, .. }) = (broken.len(), broken.first()?);
    Some(format!("{count} of the table's lines break a promise; the first is {method} on {case}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::mesh::Mesh;

    #[test]
    fn leaks_of_a_closed_mesh_that_no_view_could_count_fail_with_that_reason() {
        #[derive(clap::Parser)]
        struct Command {
            #[command(flatten)]
            args: Args,
        }
        let Command { args } = clap::Parser::parse_from(["stability", "--fail-on", "leaks"]);
        let subject = Subject::new("torus".into(), geometry::mesh::Shape::Torus.build(), 0.0);
        let failed = args.judge_mesh(&subject, &args.effort(), &[]).expect("a judgement");
        let [Failure { sentence, .. }] = &failed[..] else { panic!("{} failures", failed.len()) };
        assert!(
            sentence.starts_with("torus fails the gate leaks: leaks could be counted in none of the views"),
            "{sentence}"
        );
    }

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
