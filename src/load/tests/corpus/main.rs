//! Reads every file of the corpus, and compares what it gets with `answers.txt` in its folder: what is read, with all warnings,
//! or the whole sentence of the error.
//!
//! `corpus/FORMAT` has `good` files, `odd` ones, which say what their mesh is in a way that few programs write, and `hostile` ones, which
//! are broken or were made to do harm. `PNAEN_UPDATE_CORPUS=1` writes the answers, and `PNAEN_CORPUS=FOLDER` writes all files there, whole, to
//! open them with other programs.

mod cases;

// The name that the crate has everywhere else.
extern crate pnaen_load as load;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Debug;
use std::path::Path;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use cases::cases;
use geometry::progress::Progress;
use load::environment_file::EnvironmentFile;
use load::format::Format;
use load::mesh_file::read;
use load::selection::Selection;
use load::{Limits, LoadError};

/// How long reading a file is waited for. No time is measured: files that would take quadratic time are so long that this comes to
/// hours, where a busy machine takes some seconds.
const PATIENCE: Duration = Duration::from_secs(100);

/// What the file gives, with its warnings; or the kind of error, and its sentence.
type Answer = Result<(String, Vec<String>), (String, String)>;

/// Reads the files of a format, each in its folder.
fn hold(format: &str) {
    let mut wrong = Vec::new();
    for kind in ["good", "odd", "hostile"] {
        let folder = format!("corpus/{format}/{kind}");
        let mut blocks = Vec::new();
        for case in cases(&folder) {
            let (name, bytes) = (&case.path[folder.len() + 1..], case.bytes());
            if let Some(copies) = std::env::var_os("PNAEN_CORPUS") {
                let copies = Path::new(&copies).join(format).join(kind);
                std::fs::create_dir_all(&copies).expect("a folder that can be made");
                std::fs::write(copies.join(name), &bytes).expect("a file that can be written");
            }
            let answer = answered_in_time(case.path.clone(), bytes);
            if kind != "hostile" && answer.is_err() {
                wrong.push(format!("{folder}/{name} is refused"));
            }
            blocks.push(block(name, answer));
        }
        let page = Path::new(env!("CARGO_MANIFEST_DIR")).join(&folder).join("answers.txt");
        if std::env::var_os("PNAEN_UPDATE_CORPUS").is_some() && !blocks.is_empty() {
            std::fs::write(&page, blocks.join("\n")).expect("a page that can be written");
        }
        let kept = std::fs::read_to_string(&page).unwrap_or_default().replace("\r\n", "\n");
        if kept != blocks.join("\n") {
            let kept: Vec<_> = kept.split("\n\n").map(str::trim_end).collect();
            wrong.extend(
                blocks.iter().map(|block| block.trim_end().to_owned()).filter(|block| !kept.contains(&&**block)),
            );
            wrong.push(format!("{folder}: {} answers instead of {}", blocks.len(), kept.len()));
        }
    }
    assert!(
        wrong.is_empty(),
        "other answers than in the corpus; PNAEN_UPDATE_CORPUS=1 writes these:\n{}",
        wrong.join("\n")
    );
}

/// Formats an answer for the page.
fn block(name: &str, answer: Answer) -> String {
    let lines = match answer {
        Ok((what, warnings)) => {
            [vec![what], warnings.into_iter().map(|said| format!("warning: {said}")).collect()].concat()
        }
        Err((kind, said)) => vec![format!("refused ({kind}): {said}")],
    };
    assert!(lines.iter().all(|line| line.len() < 1000 && !line.contains(char::is_control)), "{name}: {lines:?}");
    lines.into_iter().fold(format!("{name}\n"), |block, line| format!("{block}  {line}\n"))
}

/// Reads a file on a thread of its own, so that a reader that hangs fails the test.
///
/// # Panics
/// If the reader panics, or doesn't come to an end.
fn answered_in_time(path: String, bytes: Vec<u8>) -> Answer {
    let (sender, receiver) = channel();
    let own = path.clone();
    std::thread::spawn(move || sender.send(answer(&own, bytes)));
    receiver.recv_timeout(PATIENCE).unwrap_or_else(|fault| match fault {
        RecvTimeoutError::Timeout => panic!("reading {path} hasn't come to an end after {PATIENCE:?}"),
        RecvTimeoutError::Disconnected => panic!("reading {path} panics"),
    })
}

fn answer(path: &str, bytes: Vec<u8>) -> Answer {
    let (limits, progress) = (Limits::default(), Progress::new());
    let Some(format) = Format::from_name(Path::new(path)) else {
        let panorama = EnvironmentFile::read(&bytes, &limits, &progress);
        let file = panorama.map_err(|fault| (kind(&fault), fault.to_string()))?;
        let [width, height] = file.size();
        return Ok((format!("{width} x {height} px"), file.warnings));
    };
    let loaded = read(format, bytes, Path::new(path), Selection::default(), &limits, &progress).map_err(|error| {
        let kind = match &error {
            LoadError::Gltf { problem, .. } => kind(problem),
            LoadError::Broken { fault, .. } => kind(fault),
            error => kind(error),
        };
        (kind, error.to_string().replace(&format!("{path}: "), "").replace(path, "it"))
    })?;
    Ok((format!("triangles: {}", loaded.mesh.triangles.len()), loaded.warnings))
}

/// The name of an error's variant.
fn kind(error: &impl Debug) -> String {
    let own = format!("{error:?}");
    own.split(|letter: char| !letter.is_alphanumeric()).next().unwrap_or_default().to_owned()
}

/// A test for each folder of the corpus.
macro_rules! formats {
    ($($format:ident)*) => {
        const FORMATS: &[&str] = &[$(stringify!($format)),*];
        $(#[test]
        fn $format() {
            hold(stringify!($format));
        })*
    };
}

formats!(fbx glb gltf obj off panorama ply stl threemf);

#[test]
fn every_folder_is_read() {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    let entries = std::fs::read_dir(corpus).expect("the corpus").map(|entry| entry.expect("an entry").path());
    let folders = entries.filter(|entry| entry.is_dir());
    let found: BTreeSet<_> = folders.filter_map(|folder| Some(folder.file_name()?.to_str()?.to_owned())).collect();
    // Factors of the tessellator are no files; fuzzers begin with them.
    let known = FORMATS.iter().copied().chain(["factors"]).map(str::to_owned).collect();
    assert_eq!(found, known);
}

/// Files that are refused although at least two of trimesh 5.2.0, PyMeshLab 2025.7 and f3d 1.3.1 show triangles of them, by the reason. Of the others
/// that are refused, at most one of the three does. FBX files, which none of them reads, OFF and 3MF files, files above
/// 30 MB, and files beside a document were not tried.
#[test]
fn what_others_open_is_refused_for_a_reason() {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    let alone = std::fs::read(corpus.join("refused-alone.json")).expect("reasons");
    let alone: BTreeMap<String, Vec<String>> = serde_json::from_slice(&alone).expect("reasons and paths");
    for path in alone.values().flatten() {
        let (folder, name) = path.rsplit_once('/').expect("a folder");
        let answers = std::fs::read_to_string(corpus.join(folder).join("answers.txt")).expect("answers");
        let answers = format!("\n{}", answers.replace("\r\n", "\n"));
        assert!(answers.contains(&format!("\n{name}\n  refused (")), "{path} isn't refused");
    }
}
