//! Loads and measures one asset.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Instant, SystemTime};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use image::DynamicImage;
use image::imageops::FilterType;

use super::plan::{Job, Named};
use crate::cli::{CliError, file_error, file_of, note};
use geometry::names::on_one_line;
use geometry::progress::Progress;
use inspect::engine::{Engine, Loaded, Preparation};
use inspect::shot::png_bytes;
use lab::check::{Asset, Cache, GateResult, View};
use load::files::file_reason;
use load::selection::is_part_of;
use load::{LoadError, ShownParts};

/// The most px along a side of a picture on the page.
const MOST_PX: u32 = 704;

/// The files that were read of an asset, and what options name and it doesn't have.
type Read = (Vec<PathBuf>, Vec<Named>);

/// What is found about an asset, and what options name and it doesn't have, if that is known. An asset that can't be checked has the
/// reason; so has one at which the program panics.
pub(super) fn measured(
    job: &Job,
    engine: &Engine,
    pictures: bool,
    cache: Option<&Cache>,
) -> (Asset, Option<Vec<Named>>) {
    let (start, begun) = (SystemTime::now(), Instant::now());
    let mut asset = Asset { path: job.name.clone(), ..Asset::default() };
    let ended = catch_unwind(AssertUnwindSafe(|| measure(job, engine, pictures, &mut asset)));
    let read = match ended {
        Ok(read) => read.map_err(|error| on_one_line(&error.to_string())),
        Err(_) => Err(format!("{}: checking it stopped unexpectedly, which is an error of pnaen", job.name)),
    };
    let (files, absent) = read.map_err(|error| asset.error = Some(error)).ok().unzip();
    asset.seconds = begun.elapsed().as_secs_f64();
    if let Some((cache, files)) = cache.filter(|_| job.is_kept).zip(files)
        && let Err(error) = cache.put(job.inputs(), &files, start, &asset)
    {
        note(&format!("what was found can't be kept: {}", file_reason(&error)));
    }
    (asset, absent)
}

/// Fills in what is found. Returns what was read.
fn measure(job: &Job, engine: &Engine, pictures: bool, asset: &mut Asset) -> Result<Read, CliError> {
    let progress = Progress::new();
    let Some((_, first)) = job.views.first() else { return Ok(Read::default()) };
    let (loaded, absent) = load(job, first.surface.preparation(), &progress)?;
    asset.warnings.clone_from(&loaded.warnings);
    for (index, (name, options)) in job.views.iter().enumerate() {
        let (subject, _) = options.subject_of(loaded.clone())?;
        let mut shot = options.shot(engine.clone(), subject)?;
        let is_drawn = pictures || job.golden.is_some();
        let drawn = is_drawn.then(|| shot.picture(None, &progress)).transpose()?;
        // What is about the mesh itself is the same in all views.
        let wanted = job.gates.iter().copied().filter(|gate| index == 0 || !gate.kind.is_of_mesh());
        let tolerance = options.surface.tessellation().tolerance;
        let mut gates = Vec::new();
        if let Some((golden, drawn)) = job.golden.as_ref().zip(drawn.as_ref()) {
            let start = Instant::now();
            let (result, difference) = golden.compare(name, drawn, shot.adapter())?;
            let evidence = difference.filter(|_| pictures).map(|picture| encoded(job, picture)).transpose()?;
            gates.push(GateResult { evidence, seconds: start.elapsed().as_secs_f64(), ..result });
        }
        let picture = drawn.filter(|_| pictures).map(|drawn| encoded(job, drawn.into())).transpose()?;
        for gate in wanted {
            let start = Instant::now();
            for judgement in &shot.judge(&[gate], tolerance, &progress)? {
                // A gate that fails has a picture of its place.
                let shown = if pictures && !judgement.passed { shot.evidence(judgement, &progress)? } else { None };
                let evidence = shown.map(|picture| encoded(job, picture.into())).transpose()?;
                gates.push(GateResult::new(judgement, evidence, start.elapsed().as_secs_f64()));
            }
        }
        asset.views.push(View { name: name.clone(), numbers: shot.numbers(), gates, picture });
    }
    let own = file_of(&job.source).map(Path::to_owned);
    let files = own.into_iter().chain(loaded.files).chain(job.read.iter().cloned()).collect();
    Ok((files, absent))
}

/// Loads an asset. What the configuration hides, gives a style or weighs may be parts and morph targets of other assets: these are
/// returned too.
fn load(job: &Job, mut preparation: Preparation, progress: &Progress) -> Result<(Loaded, Vec<Named>), LoadError> {
    let mut absent = Vec::new();
    loop {
        let loaded = inspect::engine::load(&job.source, &preparation, progress);
        let before = absent.len();
        if let Err(LoadError::Absent { what, known, .. }) = &loaded {
            absent.extend(without_absent(&mut preparation.parts, what, known));
        }
        if absent.len() == before {
            return Ok((loaded?, absent));
        }
    }
}

/// Takes out of the parts or the morph targets those that aren't among the known ones.
fn without_absent(own: &mut ShownParts, what: &'static str, known: &[String]) -> Vec<Named> {
    let is_absent = |name: &str| !known.iter().any(|known| is_part_of(known, name));
    let names: Vec<String> = match what {
        "part" => {
            let styles = own.styles.extract_if(.., |(name, _)| is_absent(name)).map(|(name, _)| name);
            own.hidden.extract_if(.., |name| is_absent(name)).chain(styles).collect()
        }
        "morph target" => own.morphs.extract_if(.., |name, _| !known.contains(name)).map(|(name, _)| name).collect(),
        _ => Vec::new(),
    };
    names.into_iter().map(|name| (what, name)).collect()
}

/// A picture as it is on the page: no larger than it is shown there on a dense screen, a PNG file in base64.
fn encoded(job: &Job, mut picture: DynamicImage) -> Result<String, CliError> {
    if picture.width() > MOST_PX || picture.height() > MOST_PX {
        picture = picture.resize(MOST_PX, MOST_PX, FilterType::Triangle);
    }
    let bytes = png_bytes(&picture).map_err(|error| file_error(job.name.as_ref(), "encoded", &error))?;
    Ok(STANDARD.encode(bytes))
}
