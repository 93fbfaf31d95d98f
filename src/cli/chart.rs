//! `pnaen chart`: speed against accuracy.

mod report;

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::options::{CameraOption, ReferenceOption, whole_from};
use super::{
    AdapterOption, CliError, ProgressPrinter, SurfaceOptions, WeldOption, file_error, file_of, keep_apart, load_apart,
    make_folder, options, refuse, stop_on_interrupt, write_text,
};
use geometry::tessellate::{Normals, Partitioning, Surface, Tessellation};
use inspect::engine::{Engine, Loaded};
use inspect::measure::AccuracyOptions;
use inspect::reference_shape::ReferenceShape;
use inspect::render::Target;
use inspect::settings::options::{FACTOR, PIXELS, TOLERANCE};
use inspect::settings::{ARENA_BYTES, Settings};
use lab::chart::report::{LeftOut, Part, TABLE};
use lab::chart::{Bench, Effort, LodKind, Plan, Setting, Subject, columns, has_converged, save};
use load::Source;
use load::files::file_reason;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Mesh files, or shapes made in code such as shape:torus, or
    /// shape:torus@2 (finer); with --report, by default seven shapes, and assets/vase.glb where there is one
    #[arg(value_parser = options::source(), required_unless_present = "report")]
    pub files: Vec<Source>,
    #[command(flatten)]
    pub reference: ReferenceOption,
    #[command(flatten)]
    pub weld: WeldOption,
    /// Surfaces to try
    #[arg(long, value_parser = options::choice::<Surface>(), value_delimiter = ',', value_name = "SURFACE,..", default_values = ["flat", "pn-aen", "phong-aen", "nagata-aen"])]
    pub surfaces: Vec<Surface>,
    /// Normals to shade with
    #[arg(long, value_parser = options::choice::<Normals>(), value_delimiter = ',', value_name = "NORMALS,..", default_values = ["linear"])]
    pub normals: Vec<Normals>,
    /// Partitionings to try; by default integer under LOD by error, else fractional-odd. Subtriangulation has uniform LOD only
    #[arg(long, value_delimiter = ',', value_name = "P,..", value_parser = options::choice::<Partitioning>())]
    pub partitionings: Vec<Partitioning>,
    /// Kinds of LOD to try. They are one factor everywhere, the white paper's by lengths of edges, or by error on screen
    #[arg(long, value_parser = options::choice::<LodKind>(), value_delimiter = ',', value_name = "LOD,..", default_values = ["uniform", "paper", "error", "error-rows"])]
    pub lods: Vec<LodKind>,
    /// Factors to try under uniform LOD, each 1 to 64
    #[arg(long, value_delimiter = ',', value_name = "F,..", default_value = "1,2,3,4,6,8,12,16,24,32,48,64", value_parser = options::number_of(&FACTOR))]
    pub factors: Vec<f32>,
    /// Lengths of a segment on screen to try under the white paper's LOD, in px, each 1 to 256
    #[arg(long, value_delimiter = ',', value_name = "PX,..", default_value = "32,16,8,4,2,1", value_parser = options::number_of(&PIXELS))]
    pub pixels: Vec<f32>,
    /// Tolerances to try under LOD by error, in px, each 0.01 to 100
    #[arg(long, value_delimiter = ',', value_name = "PX,..", default_value = "8,4,2,1,0.5,0.25,0.125", value_parser = options::number_of(&TOLERANCE))]
    pub tolerances: Vec<f32>,
    /// Try every setting, even where finer factors no longer reduce a method's error
    #[arg(long)]
    pub all: bool,
    /// Leave out settings with more triangles than this; standard error tells how many
    #[arg(long, value_name = "N", default_value_t = Effort::default().most_triangles, value_parser = whole_from(1_u64))]
    pub max_triangles: u64,
    /// Points of the reference surface that root mean squares and angles are sampled at; about as many are taken on the emitted
    /// triangles
    #[arg(long, value_name = "N", default_value_t = AccuracyOptions::default().samples, value_parser = options::whole(100..=10_000_000_usize))]
    pub samples: usize,
    /// Width and height of the view, in px
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = options::size)]
    pub size: [u32; 2],
    /// Where the camera is: degrees from the front to the right, degrees upwards, and the distance from the centre in
    /// bounding radii (by default far enough to show everything)
    #[arg(long, value_name = "AZIMUTH,ELEVATION[,DISTANCE]", default_value = "30,20", allow_hyphen_values = true)]
    pub camera: CameraOption,
    /// Picture to write, an SVG or PNG file, with a diagram for each mesh
    #[arg(short, long, value_name = "OUT.svg|OUT.png", value_parser = options::ending_in(&["svg", "png"], "charts are SVG or PNG files: name it .svg or .png"), required_unless_present_any = ["csv", "report"])]
    pub output: Option<PathBuf>,
    /// Table to write (- for standard output); each line is written as soon as its setting is done
    #[arg(long, value_name = "OUT.csv")]
    pub csv: Option<PathBuf>,
    /// Folder for a report; made if it isn't there. It has results.md (which method to use when), a picture for each mesh, and
    /// the table results.csv
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    #[command(flatten)]
    pub adapter: AdapterOption,
}

impl Args {
    fn settings(&self) -> Result<Vec<Setting>, CliError> {
        let is_unclear = self.reference.reference_shape.is_some() && self.files.len() != 1;
        refuse(is_unclear, "--reference-surface takes one mesh: chart the others on their own")?;
        let settings = self.plan().settings();
        refuse(settings.is_empty(), "subtriangulation has uniform LOD only: add uniform to --lods")?;
        Ok(settings)
    }

    fn plan(&self) -> Plan {
        Plan {
            surfaces: self.surfaces.clone(),
            normals: self.normals.clone(),
            partitionings: self.partitionings.clone(),
            lods: self.lods.clone(),
            factors: self.factors.clone(),
            pixels: self.pixels.clone(),
            tolerances: self.tolerances.clone(),
        }
    }

    fn effort(&self) -> Effort {
        let usual = Effort::default();
        let accuracy = AccuracyOptions { samples: self.samples, ..usual.accuracy };
        Effort { accuracy, most_triangles: self.max_triangles, ..usual }
    }
}

/// A mesh to be charted, and its reference surface with a name.
type Loading = (Loaded, Option<(String, ReferenceShape)>);

pub(super) fn run(args: &Args) -> Result<(), CliError> {
    let settings = args.settings()?;
    let read = args.files.iter().chain(&args.reference.reference_shape).map(file_of);
    keep_apart(read, [args.output.as_deref(), args.csv.as_deref()])?;
    let load_one = |source: &Source| {
        let written = [args.output.as_deref(), args.csv.as_deref()];
        let loaded = load_apart(source, &args.weld.preparation(), &written)?;
        // The reference surface that was chosen, or else the exact surface of a shape.
        let chosen = args.reference.load(source, &args.weld.preparation(), Source::title)?;
        let exact = || Some(("the exact surface".to_owned(), ReferenceShape::from_shape(source.shape()?)?));
        Ok((loaded, chosen.or_else(exact)))
    };
    let sources = if args.files.is_empty() { report::usual() } else { args.files.clone() };
    let meshes: Vec<Loading> = sources.iter().map(load_one).collect::<Result<_, CliError>>()?;
    // Before anything is measured, so that a command that takes minutes doesn't fail at its end.
    args.report.as_deref().map_or(Ok(()), make_folder)?;
    let engine = Engine::chosen(&args.adapter.choice())?;
    let tables = args.csv.iter().cloned().chain(args.report.as_ref().map(|folder| folder.join(TABLE)));
    let mut session = Session {
        target: Target::new(&engine.gpu, args.size)?,
        engine,
        tables: tables.map(|path| Table::new(&path)).collect::<Result<_, CliError>>()?,
        stop: stop_on_interrupt("setting"),
        progress_printer: ProgressPrinter::new(),
        done: 0,
        all: settings.len() * meshes.len(),
    };
    let mut parts = Vec::new();
    for (mesh, picture) in meshes.iter().zip(report::pictures(&sources)) {
        let (subject, left_out) = session.subject(args, mesh, &settings)?;
        let topology = &mesh.0.topology;
        let (patches, split_edges) = (topology.patches.len() as u64, topology.edge_counts().split.into());
        let part = Part { subject, patches, split_edges, picture, left_out };
        parts.extend((!part.subject.rows.is_empty()).then_some(part));
    }
    if let Some(folder) = &args.report {
        report::write(folder, &report::occasion(&session.engine.gpu), &parts)?;
    }
    let subjects: Vec<Subject> = parts.into_iter().map(|part| part.subject).collect();
    publish(args, &subjects)?;
    if session.stop.load(Ordering::Relaxed) && session.done < session.all {
        return Err(CliError::Interrupted { done: session.done, all: session.all, what: "settings" });
    }
    Ok(())
}

/// What all meshes share.
struct Session {
    engine: Engine,
    target: Target,
    tables: Vec<Table>,
    stop: Arc<AtomicBool>,
    progress_printer: ProgressPrinter,
    /// How many settings are done, of `all`.
    done: usize,
    all: usize,
}

impl Session {
    /// Tries all settings on a mesh, until Ctrl-C is pressed.
    fn subject(&mut self, args: &Args, mesh: &Loading, settings: &[Setting]) -> Result<(Subject, LeftOut), CliError> {
        let (loaded, reference_shape) = mesh;
        let title = loaded.source.title();
        let scene = self.engine.scene(loaded, ARENA_BYTES)?;
        let mut view = SurfaceOptions { size: args.size, ..SurfaceOptions::default() };
        view.view.camera = args.camera;
        let mut bench = Bench {
            engine: &self.engine,
            mesh: loaded.source.to_string(),
            camera: view.view.camera(&view, (&loaded.mesh, None, &scene.bounds), view.viewport())?,
            scene,
            target: &self.target,
            reference_shape: reference_shape.as_ref().map(|(_, reference_shape)| reference_shape),
            base: Settings::from(Tessellation::default()),
            effort: args.effort(),
        };
        let mut rows = Vec::new();
        let mut left_out = LeftOut { most_triangles: args.max_triangles, ..LeftOut::default() };
        for (index, setting) in settings.iter().enumerate() {
            if self.stop.load(Ordering::Relaxed) {
                left_out.interrupted = settings.len() - index;
                break;
            }
            let number = self.done + 1;
            if !args.all && has_converged(&rows, setting.method) {
                left_out.converged += 1;
                self.done = number;
                continue;
            }
            self.progress_printer.print(|| format!("{title}, {number} of {}: {}, {setting}", self.all, setting.method));
            match bench.measure(setting)? {
                Some(row) => {
                    self.tables.iter_mut().try_for_each(|table| table.add(&row.record()))?;
                    rows.push(row);
                }
                None => left_out.too_large += 1,
            }
            self.done = number;
        }
        let LeftOut { too_large, most_triangles, .. } = left_out;
        if too_large > 0 {
            let of = format!("{title}: {too_large} of {} settings", settings.len());
            super::warn(&[format!("{of} have more than {most_triangles} triangles and are left out.")]);
        }
        let reference_shape = reference_shape.as_ref().map(|(words, _)| words.clone());
        let adapter = self.engine.gpu.info.name.clone();
        Ok((Subject { title, reference_shape, adapter, size: args.size, rows }, left_out))
    }
}

/// Writes the picture, and prints its sentences unless the table goes to standard output.
fn publish(args: &Args, subjects: &[Subject]) -> Result<(), CliError> {
    args.output.as_deref().map_or(Ok(()), |path| save(path, subjects))?;
    if args.csv.as_deref() == Some(Path::new("-")) {
        return Ok(());
    }
    let mut text = String::new();
    for subject in subjects {
        text += &format!("{}\n", subject.title);
        text.extend(subject.sentences().iter().map(|sentence| format!("  {sentence}\n")));
    }
    Ok(write_text("-".as_ref(), &text)?)
}

/// A CSV file that is flushed after each line, so that an interrupted command leaves whole lines.
struct Table {
    path: PathBuf,
    writer: csv::Writer<Box<dyn Write>>,
}

impl Table {
    fn new(path: &Path) -> Result<Self, CliError> {
        let out: Box<dyn Write> = if path.as_os_str() == "-" {
            Box::new(std::io::stdout())
        } else {
            Box::new(File::create(path).map_err(|error| file_error(path, "written", &file_reason(&error)))?)
        };
        let mut table = Self { path: path.to_owned(), writer: csv::Writer::from_writer(out) };
        table.add(&columns())?;
        Ok(table)
    }

    fn add<T: AsRef<[u8]>>(&mut self, record: &[T]) -> Result<(), CliError> {
        let written = self.writer.write_record(record).map_err(std::io::Error::from);
        written.and_then(|()| self.writer.flush()).map_err(|error| match self.path.as_os_str() == "-" {
            true => CliError::Output(error),
            false => file_error(&self.path, "written", &error).into(),
        })
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(clap::Parser)]
    struct Line {
        #[command(flatten)]
        args: Args,
    }

    #[test]
    fn by_default_it_tries_what_the_window_tries() {
        let line = Line::try_parse_from(["chart", "shape:torus", "--csv", "-"]).expect("it is valid");
        assert_eq!(line.args.plan(), Plan::default());
        assert_eq!(line.args.effort().accuracy, Effort::default().accuracy);
    }
}
