//! `pnaen compare`: holds a tessellated mesh that another program emitted against ours.

mod picture;
mod report;

use std::path::{Path, PathBuf};

use super::posed::Posed;
use super::{
    AdapterOption, CliError, FactorsOption, SurfaceOptions, file_of, files_of_heights, keep_apart, options, refuse,
    to_json, warn, write_text,
};
use geometry::names::shown_path;
use geometry::progress::Progress;
use geometry::view::ulp;
use inspect::engine::Loaded;
use inspect::export::ending;
use lab::compare::{ForeignMesh, OurTessellation, Tolerances, compare};
use load::csv_vertices::{CsvVertices, read_vertices};
use load::files::Limits;
use load::selection::Selection;
use load::{Import, NormalSource, Source};

use report::Report;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// The tessellated mesh of the other program: a mesh file, or a .csv file of vertices as a frame debugger exports them, three
    /// lines a triangle
    #[arg(value_name = "THEIRS")]
    pub theirs: PathBuf,
    /// The mesh that both tessellate: a mesh file, or a shape made in code such
    /// as shape:cube-split, or shape:torus@2 (finer)
    #[arg(long, value_name = "FILE", value_parser = options::source())]
    pub mesh: Source,
    /// Picture to write, a PNG file: their triangles in the colours of their distance from ours, and what differs as lines
    #[arg(short, long, value_name = "OUT.png", value_parser = options::picture())]
    pub output: Option<PathBuf>,
    /// Distance within which vertices count as equal: object units, or ULP of the mesh's largest coordinate, such as 16ulp
    #[arg(long, value_name = "DISTANCE", default_value = "16ulp", value_parser = within, allow_negative_numbers = true)]
    pub within: Within,
    /// The columns of a .csv file that are the position, by their name without the component. It is position for position.x,
    /// position.y and position.z
    #[arg(long, value_name = "NAME")]
    pub position_column: Option<String>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub surface: SurfaceOptions,
    #[command(flatten)]
    pub given: FactorsOption,
    #[command(flatten)]
    pub adapter: AdapterOption,
}

/// A distance of the command line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Within {
    number: f64,
    /// Whether it is in units in the last place of the mesh's largest coordinate, and not in object units.
    in_ulp: bool,
}

impl Within {
    /// The distance in object units. `ulp` is one ULP in object units.
    fn units(self, ulp: f64) -> f64 {
        if self.in_ulp { self.number * ulp } else { self.number }
    }
}

/// Parses a distance in object units, or with the unit ulp.
fn within(text: &str) -> Result<Within, String> {
    let lower = text.trim().to_ascii_lowercase();
    let (number, in_ulp) = lower.strip_suffix("ulp").map_or((&*lower, false), |count| (count, true));
    let number = number.trim().parse().ok().filter(|number: &f64| number.is_finite() && *number >= 0.0);
    number.map(|number| Within { number, in_ulp }).ok_or_else(|| {
        "expected a distance that isn't negative, in object units such as 1e-5, or in ULP such as 16ulp".into()
    })
}

/// How many triangles of ours are held at most.
const MOST: u64 = 100_000_000;

pub(super) fn run(args: &Args) -> Result<(), CliError> {
    args.surface.check(None)?;
    let draws_nothing = args.adapter.adapter.is_some() && args.output.is_none();
    refuse(draws_nothing, "--adapter draws the picture of -o: give -o as well, or leave --adapter out")?;
    let is_csv = matches!(ending(&args.theirs).as_str(), "csv" | "tsv");
    let has_no_columns = args.position_column.is_some() && !is_csv;
    refuse(has_no_columns, "--position-column names a column of a .csv file, which THEIRS isn't")?;
    let read = [Some(&*args.theirs), file_of(&args.mesh), args.given.given.as_deref()];
    keep_apart(read.into_iter().chain(files_of_heights(&args.surface.height)), [args.output.as_deref()])?;
    let own = Posed::load(&args.surface, &args.mesh, &[args.output.as_deref()])?;
    let Loaded { mesh, topology, .. } = &own.posed;
    if topology.patches.is_empty() {
        return Err(CliError::NothingToCompare { file: args.mesh.to_string() });
    }
    let given = args.given.read(mesh, topology, &args.surface)?.map(|(factors, _)| factors);
    let camera = args.surface.view.camera(&args.surface, (mesh, own.moment, &own.bounds), args.surface.viewport())?;
    let inputs = own.inputs(own.lod_view(&camera))?;
    let tessellated = own.tessellated(&inputs, given.as_deref(), |_, triangles| match triangles > MOST {
        true => Err(CliError::TooFine { file: args.mesh.to_string(), triangles, most: MOST }),
        false => Ok(()),
    })?;
    let (theirs, resolution) = theirs(args, is_csv)?;
    let within = args.within.units(ulp(topology)).max(2.0 * resolution);
    let ours = OurTessellation {
        mesh,
        topology,
        inputs: &inputs,
        given: given.as_deref(),
        matrix: args.surface.view.matrix().map(|matrix| matrix.clip_from_object),
        tessellated: &tessellated,
    };
    let exactness = Tolerances { within, resolution };
    let comparison = compare(&ours, &theirs, exactness);
    let name = shown_path(&args.theirs);
    let report =
        Report { theirs: &name, mesh: &args.mesh.to_string(), ours: &ours, comparison: &comparison, exactness };
    let text = if args.json { to_json(&report.json())? } else { report.text() };
    write_text("-".as_ref(), &text)?;
    if let Some(path) = &args.output {
        picture::draw(args, path, &own.loaded, &camera, &ours, &theirs, &comparison)?;
    }
    match comparison.findings.len() {
        0 => Ok(()),
        count => Err(CliError::NotTheSame { theirs: name, count }),
    }
}

/// Reads the other program's triangles, and half a unit of their last decimal. Standard error tells what was left out.
fn theirs(args: &Args, is_csv: bool) -> Result<(ForeignMesh, f64), CliError> {
    let limits = args.surface.weld.limit.limits();
    let (mesh, resolution) = if is_csv { csv(args, &limits)? } else { (of_file(&args.theirs, &limits)?, 0.0) };
    if mesh.triangles.is_empty() {
        return Err(CliError::NothingToCompare { file: shown_path(&args.theirs) });
    }
    Ok((mesh, resolution))
}

fn csv(args: &Args, limits: &Limits) -> Result<(ForeignMesh, f64), CliError> {
    let read = read_vertices(&args.theirs, args.position_column.as_deref(), limits, &Progress::new())?;
    let CsvVertices { positions, resolution, warnings } = read;
    warn(&warnings);
    let count = positions.len() as u32 / 3;
    Ok((ForeignMesh::new(&positions, (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2])), resolution))
}

fn of_file(path: &Path, limits: &Limits) -> Result<ForeignMesh, CliError> {
    // Normals aren't compared, so that nothing need be said about those that the file lacks.
    let import = Import { normals: NormalSource::Made, ..Import::default() };
    let selected = Selection { import, ..Selection::default() };
    let loaded = Source::File(path.to_owned()).load_selected(selected, limits, &Progress::new())?;
    warn(&loaded.warnings);
    Ok(ForeignMesh::from_mesh(&loaded.mesh))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_in_object_units_or_in_ulp() {
        assert_eq!(within("16ulp"), Ok(Within { number: 16.0, in_ulp: true }));
        assert_eq!(within(" 0.5 ULP"), Ok(Within { number: 0.5, in_ulp: true }));
        assert_eq!(within("1e-5"), Ok(Within { number: 1e-5, in_ulp: false }));
        for text in ["", "ulp", "-1", "inf", "1m"] {
            assert!(within(text).is_err(), "{text}");
        }
        assert_eq!(Within { number: 4.0, in_ulp: true }.units(0.25), 1.0);
    }
}
