//! `pnaen check`: holds a folder of assets to gates, and reports what was found.

mod golden;
mod measuring;
mod plan;

use std::collections::BTreeMap;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use clap::ValueEnum;

use super::gate_options::FailOnOption;
use super::{
    AdapterOption, CliError, ProgressPrinter, file_error, file_of, keep_apart, make_folder, note, options,
    stop_on_interrupt, to_json, write_bytes, write_text,
};
use geometry::cores::in_ranges;
use inspect::engine::Engine;
use lab::check::{Asset, Cache, PICTURES, Report, junit, page, pictures, sarif};
use load::Source;

use plan::{Job, Named};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Meshes, shapes made in code, and folders, in and below which all meshes are checked
    #[arg(required = true, value_parser = options::source())]
    pub files: Vec<Source>,
    /// Configuration with gates, options of render, cameras, and sections for some of the files; by default pnaen.toml in the
    /// working folder, if it is there
    #[arg(long, value_name = "FILE")]
    pub config: Option<PathBuf>,
    /// Gates in place of those of the configuration
    #[command(flatten)]
    pub gates: FailOnOption,
    /// Format of the report
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t = Format::Text)]
    pub format: Format,
    /// File for the report (- for standard output)
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    pub output: PathBuf,
    /// Folder for a page with a picture of each asset and of the worst place of each failed gate; made if it isn't there
    #[arg(long, value_name = "DIR")]
    pub page: Option<PathBuf>,
    /// Folder that keeps what was found, so that an unchanged asset isn't measured again; made if it isn't there
    #[arg(long, value_name = "DIR")]
    pub cache: Option<PathBuf>,
    /// Folder of golden pictures in place of that of the configuration. Each view must be the same as ASSET.png, or if it has a
    /// name, ASSET/VIEW.png
    #[arg(long, value_name = "DIR")]
    pub golden: Option<PathBuf>,
    /// Write the golden pictures in place of comparing with them
    #[arg(long)]
    pub update_golden: bool,
    /// How many assets are loaded and measured at the same time; by default as many as there are cores, and at most 4
    #[arg(long, value_name = "N", value_parser = options::whole(1..=256_u16))]
    pub jobs: Option<u16>,
    #[command(flatten)]
    pub adapter: AdapterOption,
}

/// How the report is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Lines for people
    Text,
    /// Every number, limit and place
    Json,
    /// JUnit XML, which build servers show as test results
    Junit,
    /// SARIF 2.1.0, which code hosts show beside the files
    Sarif,
}

/// The page's file.
const PAGE: &str = "index.html";

pub(super) fn run(args: &Args) -> Result<(), CliError> {
    let jobs = plan::plan(args)?;
    let read = jobs.iter().map(|job| file_of(&job.source));
    keep_apart(read.chain([plan::config_path(args)]), [Some(&*args.output)])?;
    [&args.page, &args.cache].into_iter().flatten().try_for_each(|folder| make_folder(folder))?;
    let stop = stop_on_interrupt("asset");
    let report = checked(args, &jobs, &stop)?;
    if let Some(folder) = &args.page {
        write_page(folder, &report)?;
    }
    let text = match args.format {
        Format::Text => report.text(),
        Format::Json => to_json(&report.json())?,
        Format::Junit => junit(&report).map_err(CliError::Output)?,
        Format::Sarif => to_json(&sarif(&report))?,
    };
    write_text(&args.output, &text)?;
    match report.left_out {
        0 if report.passed() => Ok(()),
        0 => Err(CliError::Check(report.summary())),
        left_out => Err(CliError::Interrupted { done: jobs.len() - left_out, all: jobs.len(), what: "assets" }),
    }
}

/// Writes the page, and those of its pictures that aren't there from an earlier run.
fn write_page(folder: &Path, report: &Report) -> Result<(), CliError> {
    let into = folder.join(PICTURES);
    make_folder(&into)?;
    for (name, picture) in pictures(report) {
        let path = into.join(name);
        if !path.exists() {
            // The cache of an earlier run may be damaged.
            let bytes = STANDARD.decode(picture).map_err(|error| file_error(&path, "decoded", &error))?;
            write_bytes(&path, &bytes)?;
        }
    }
    Ok(write_text(&folder.join(PAGE), &page(report))?)
}

/// Checks all assets, or until `stop` is set.
fn checked(args: &Args, jobs: &[Job], stop: &AtomicBool) -> Result<Report, CliError> {
    let cache = args.cache.as_deref().map(Cache::new);
    let known = |job: &Job| cache.as_ref().filter(|_| job.is_kept)?.get(job.inputs());
    let kept = in_ranges(jobs.len(), 1, |range| jobs[range].iter().map(known).collect::<Vec<_>>());
    let mut found: BTreeMap<usize, Asset> =
        kept.into_iter().flatten().enumerate().filter_map(|(index, asset)| Some((index, asset?))).collect();
    let left: Vec<usize> = (0..jobs.len()).filter(|index| !found.contains_key(index)).collect();
    if !left.is_empty() {
        let engine = Engine::chosen(&args.adapter.choice())?;
        let measured = measured(args, jobs, &left, &engine, cache.as_ref(), stop);
        say_absent(jobs, &measured);
        found.extend(measured.into_iter().map(|(index, (asset, _))| (index, asset)));
    }
    let left_out = jobs.len() - found.len();
    Ok(Report { assets: found.into_values().collect(), left_out })
}

/// An asset, and what options name and it doesn't have, if that is known.
type Measured = (Asset, Option<Vec<Named>>);

/// Says on standard error which parts and morph targets are named and belong to none of the assets for which that holds.
fn say_absent(jobs: &[Job], measured: &BTreeMap<usize, Measured>) {
    let mut absent_everywhere: BTreeMap<&str, bool> = BTreeMap::new();
    for (index, job) in jobs.iter().enumerate() {
        let absent = measured.get(&index).and_then(|(_, absent)| absent.as_ref());
        for (named, said) in &job.named {
            let is_absent = absent.is_some_and(|absent| absent.contains(named));
            *absent_everywhere.entry(said).or_insert(true) &= is_absent;
        }
    }
    absent_everywhere.iter().filter(|(_, is_absent)| **is_absent).for_each(|(said, _)| note(said));
}

/// Loads and measures the assets with these indices, several at a time: while one is loaded or measured on the host, the device works
/// for another.
fn measured(
    args: &Args,
    jobs: &[Job],
    left: &[usize],
    engine: &Engine,
    cache: Option<&Cache>,
    stop: &AtomicBool,
) -> BTreeMap<usize, Measured> {
    let (next, done) = (AtomicUsize::new(0), Mutex::new((BTreeMap::new(), ProgressPrinter::new())));
    let work = || {
        while !stop.load(Ordering::Relaxed) {
            let Some(&index) = left.get(next.fetch_add(1, Ordering::Relaxed)) else { return };
            let measured = measuring::measured(&jobs[index], engine, args.page.is_some(), cache);
            let (found, progress_printer) = &mut *done.lock().unwrap_or_else(PoisonError::into_inner);
            found.insert(index, measured);
            progress_printer.print(|| format!("{} of {} assets are checked", found.len(), left.len()));
        }
    };
    let usual = thread::available_parallelism().map_or(1, NonZero::get).min(4);
    let workers = args.jobs.map_or(usual, usize::from).min(left.len());
    thread::scope(|scope| {
        // Where the system has no further thread, those that there are do the work.
        let others: Vec<_> =
            (1..workers).filter_map(|_| thread::Builder::new().spawn_scoped(scope, work).ok()).collect();
        work();
        drop(others);
    });
    done.into_inner().unwrap_or_else(PoisonError::into_inner).0
}
