//! What is to be checked, and how: the assets, each with what the configuration says about it.

use std::path::{Component, Path, PathBuf};

use clap::error::ErrorKind;
use clap::{Arg, ArgAction, Command, CommandFactory, Parser};

use super::Args;
use super::golden::Golden;
use crate::cli::options::{check_view_name, said};
use crate::cli::shot_options::ShotOptions;
use crate::cli::{CliError, note, refuse};
use geometry::names::{on_one_line, shown, shown_path};
use inspect::gates::Gate;
use lab::check::{Config, Inputs, OptionValue, Section, assets};
use load::Source;

/// The configuration that is read if there is one and none is named.
const CONFIG: &str = "pnaen.toml";
/// The option of the memory for output, and its value in MiB where the configuration has none. With much more, drivers get memory
/// from the system anew for each asset, which takes as long as all else.
const ARENA: [&str; 2] = ["arena", "32"];
/// The options of a camera: those that a named view may have.
const CAMERA: [&str; 6] = ["camera", "target", "orthographic", "field-of-view", "roll", "file-camera"];
/// The options whose values are paths, which are relative to the configuration's folder.
const PATHS: [&str; 7] =
    ["height", "environment", "reference-surface", "matcap-image", "factors", "lod-shader", "surface-shader"];

/// An asset, and how it is checked.
pub(super) struct Job {
    pub source: Source,
    /// Its path with `/` between folders.
    pub name: String,
    pub gates: Vec<Gate>,
    /// Named views; the only one has no name.
    pub views: Vec<(String, ShotOptions)>,
    /// Files that the options name.
    pub read: Vec<PathBuf>,
    /// The parts and morph targets that options name and only some assets may have, each with a sentence for the case that none has.
    pub named: Vec<(Named, String)>,
    pub golden: Option<Golden>,
    /// All of the configuration that holds for it, as text.
    configuration: String,
    /// Whether what is found may be kept.
    pub is_kept: bool,
}

/// A part or a morph target that an option names: which of them, and its name.
pub(super) type Named = (&'static str, String);

impl Job {
    pub(super) fn inputs(&self) -> Inputs<'_> {
        let path = if let Source::File(path) = &self.source { path } else { Path::new(&self.name) };
        (path, &self.configuration)
    }
}

/// All options of `render` that say what is drawn and from where.
#[derive(Clone, Debug, Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
struct Options {
    #[command(flatten)]
    shot: ShotOptions,
}

/// The configuration that is read, if there is one.
pub(super) fn config_path(args: &Args) -> Option<&Path> {
    let usual = Path::new(CONFIG);
    args.config.as_deref().or_else(|| usual.is_file().then_some(usual))
}

/// What is to be checked, in the order in which it is reported.
pub(super) fn plan(args: &Args) -> Result<Vec<Job>, CliError> {
    let path = config_path(args);
    let command = Options::command();
    let names: Vec<String> = command.get_arguments().filter_map(|arg| arg.get_long().map(str::to_owned)).collect();
    let config = path.map(|path| Config::read(path, &names, &CAMERA)).transpose()?.unwrap_or_default();
    let folder = path.and_then(Path::parent).unwrap_or(Path::new(""));
    check_options(&config, &command, folder)?;
    let found = assets(&args.files)?;
    if found.is_empty() {
        return Err(CliError::NoAssets);
    }
    let golden = args.golden.clone().or_else(|| config.golden.as_ref().map(|own| folder.join(own)));
    refuse(
        args.update_golden && golden.is_none(),
        "--update-golden needs the folder of golden pictures: give --golden, or golden in the configuration",
    )?;
    let golden = |place: &str| golden.as_deref().map(|folder| Golden::new(folder, place, args.update_golden));
    let places: Vec<String> = found.iter().map(|source| place(source, folder)).collect();
    config.unmatched(&places).iter().for_each(|said| note(said));
    let jobs = found.into_iter().zip(&places);
    jobs.map(|(source, place)| job(args, &config, folder, golden(place), (source, place))).collect()
}

/// Checks each value by itself, also those of sections that hold for no asset.
fn check_options(config: &Config, command: &Command, folder: &Path) -> Result<(), CliError> {
    for option in config.options() {
        let known = command.get_arguments().find(|arg| arg.get_long() == Some(&option.name));
        if let Some(reason) = known.and_then(|arg| other_type(arg, option)) {
            return Err(config.wrong(option, &reason).into());
        }
        match Options::try_parse_from(words(option)) {
            // An option that needs another one has it elsewhere.
            Err(wrong) if wrong.kind() != ErrorKind::MissingRequiredArgument => {
                return Err(config.wrong(option, &said(&wrong)).into());
            }
            _ => {}
        }
        if let Some(gone) = resolved(&mut option.clone(), folder).into_iter().find(|path| !path.exists()) {
            let reason = format!("{}: there is no file {}; check its path", option.name, shown_path(&gone));
            return Err(config.wrong(option, &reason).into());
        }
    }
    Ok(())
}

/// What is wrong if a switch has a value that is neither true nor false, or another option one of these.
fn other_type(arg: &Arg, option: &OptionValue) -> Option<String> {
    let OptionValue { name, values, .. } = option;
    let is_switch = !arg.get_action().takes_values();
    let takes_one = matches!(arg.get_action(), ArgAction::Set);
    if is_switch && values.iter().any(Option::is_some) {
        return Some(format!("{name} is a switch: expected true or false"));
    }
    let has_none = values.iter().any(Option::is_none) || takes_one && values.is_empty();
    (!is_switch && has_none)
        .then(|| format!("{name} is no switch: expected a value as `pnaen render --{name}` takes it"))
}

/// Where an asset lies, as patterns see it: its path below the configuration's folder, or all of the path of one that lies
/// elsewhere, with `/` between folders.
fn place(source: &Source, folder: &Path) -> String {
    let Source::File(path) = source else { return source.to_string() };
    let [own, folder] = [path, folder].map(plain);
    let below = own.strip_prefix(&folder).unwrap_or(&own).components();
    let names = below.filter(|part| matches!(part, Component::Normal(_)));
    names.map(|name| name.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/")
}

/// An absolute path without `.` and `..`. Links stay, since people write patterns of the paths that they see.
fn plain(path: &Path) -> PathBuf {
    let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
    let mut plain = PathBuf::new();
    for part in std::path::absolute(path).unwrap_or_else(|_| path.to_owned()).components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir => drop(plain.pop()),
            other => plain.push(other),
        }
    }
    plain
}

fn job(
    args: &Args,
    config: &Config,
    folder: &Path,
    golden: Option<Golden>,
    (source, place): (Source, &str),
) -> Result<Job, CliError> {
    let name = on_one_line(&source.to_string());
    let name = if cfg!(windows) { name.replace('\\', "/") } else { name };
    let Section { gates, mut options, cameras } = config.section(place);
    let gates = if args.gates.fail_on.is_empty() { gates.unwrap_or_default() } else { args.gates.fail_on.clone() };
    let mut read: Vec<PathBuf> = options.iter_mut().flat_map(|option| resolved(option, folder)).collect();
    if !options.iter().any(|option| option.name == ARENA[0]) {
        let [name, value] = ARENA.map(str::to_owned);
        options.push(OptionValue { name, values: vec![Some(value)], line: 0 });
    }
    let named = options.iter().flat_map(|option| named(config, option)).collect();
    let mut views = Vec::new();
    if cameras.is_empty() {
        views.push((String::new(), parsed(config, &options, &source)?));
    }
    for (name, camera) in cameras {
        if golden.is_some() {
            check_view_name(&name).map_err(|reason| config.clash(&reason))?;
        }
        let others = options.iter().filter(|option| !CAMERA.contains(&option.name.as_str()));
        let all: Vec<OptionValue> = others.chain(&camera).cloned().collect();
        views.push((name, parsed(config, &all, &source)?));
    }
    for (_, own) in &views {
        own.check_gates(&gates).map_err(|error| clash(config, error))?;
    }
    let of_views = golden.as_ref().map(|golden| golden.files(views.iter().map(|(name, _)| name.as_str())));
    read.extend(of_views.iter().flatten().flatten().cloned());
    // A reference surface that is a file may name other files, which aren't known here.
    let is_kept = matches!(source, Source::File(_))
        && of_views.is_none_or(|files| files.is_some())
        && views.iter().all(|(_, options)| !matches!(options.reference.reference_shape, Some(Source::File(_))));
    let pictures = args.page.is_some();
    let configuration = format!("{gates:?} {views:?} {pictures} {golden:?} {:?}", args.adapter.adapter);
    Ok(Job { source, name, gates, views, read, named, golden, configuration, is_kept })
}

/// The parts and morph targets that an option names and only some assets may have, each with a sentence for the case that none has.
fn named(config: &Config, option: &OptionValue) -> Vec<(Named, String)> {
    let (what, after) = match &*option.name {
        "hide-part" => ("part", None),
        "part" => ("part", Some(':')),
        "morph" => ("morph target", Some('=')),
        _ => return Vec::new(),
    };
    let name =
        |value: &str| after.and_then(|after| value.rsplit_once(after)).map_or(value, |(name, _)| name).to_owned();
    let said = |name: &str| config.wrong(option, &format!("no asset has the {what} {}", shown(name))).to_string();
    option.values.iter().flatten().map(|value| ((what, name(value)), said(&name(value)))).collect()
}

/// Makes the paths of an option relative to the configuration's folder. Returns the files; none of an option that names no files.
fn resolved(option: &mut OptionValue, folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    if !PATHS.contains(&option.name.as_str()) {
        return files;
    }
    for value in option.values.iter_mut().flatten() {
        let is_file = match option.name.as_str() {
            "reference-surface" => !value.starts_with("shape:"),
            "height" => value != "material",
            // Standard input, which is refused later.
            _ => value != "-",
        };
        if is_file {
            let path = folder.join(&*value);
            // Values of a TOML file are UTF-8, and a folder that isn't can't be part of one.
            *value = path.to_string_lossy().into_owned();
            files.push(path);
        }
    }
    files
}

/// An option as it stands on the command line.
fn words(option: &OptionValue) -> Vec<String> {
    let word = |value: &Option<String>| match value {
        Some(value) => format!("--{}={value}", option.name),
        None => format!("--{}", option.name),
    };
    option.values.iter().map(word).collect()
}

/// Reads options, each of which is right by itself, as the command line does.
fn parsed(config: &Config, options: &[OptionValue], source: &Source) -> Result<ShotOptions, CliError> {
    let own =
        Options::try_parse_from(options.iter().flat_map(words)).map_err(|error| config.clash(&said(&error)))?.shot;
    if own.given.given.as_deref() == Some("-".as_ref()) {
        return Err(config.clash("factors of a check can't come from standard input; name a file").into());
    }
    own.check(source, &[], &[]).map_err(|error| clash(config, error))?;
    Ok(own)
}

/// The error of options that can't be together, as one of the configuration.
fn clash(config: &Config, error: CliError) -> CliError {
    match error {
        CliError::Usage(reason) => config.clash(reason).into(),
        other => other,
    }
}
