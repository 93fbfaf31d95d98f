//! Functions of the user's own, for factors or for control points: reads a WGSL file, says at which line it can't be used, and bounds its loops,
//! since a driver that hangs can't be stopped. `docs/manual/own-shaders.md` says what such a file has.

mod bounded;
mod checked;
mod type_faults;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use thiserror::Error;

use geometry::names::shown_path;
use geometry::progress::Progress;
use gpu::UserShader;
use gpu::user_functions::UserText;
use load::files::{FileError, Limits, read_file};

/// The most bytes of a file.
const MOST_BYTES: u64 = 1 << 16;

/// Why a file can't be used.
#[derive(Debug, Error)]
pub enum UserShaderError {
    #[error(transparent)]
    File(FileError),
    #[error("{} has more than {MOST_BYTES} bytes, and such a file has a few thousand: leave out what they don't need", shown_path(.0))]
    TooLarge(PathBuf),
    #[error("{} isn't a text in UTF-8, as WGSL files are: save it in that encoding", shown_path(.0))]
    NotText(PathBuf),
    #[error("{}, {fault}", shown_path(path))]
    Fault { path: PathBuf, fault: Fault },
    #[error("{} could not be checked: {reason}", shown_path(path))]
    Unchecked { path: PathBuf, reason: String },
}

impl From<FileError> for UserShaderError {
    fn from(error: FileError) -> Self {
        match error {
            FileError::TooLarge { path, .. } => Self::TooLarge(path),
            other => Self::File(other),
        }
    }
}

/// What is wrong in a file, and where.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("line {line}: {kind}")]
pub struct Fault {
    /// Counted from 1.
    pub line: usize,
    pub kind: FaultKind,
}

/// What is wrong.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum FaultKind {
    #[error("{0}")]
    Language(String),
    #[error("there is no function {name}; write: {signature} {{ ... }}")]
    NoFunction { name: &'static str, signature: &'static str },
    #[error(
        "the file was opened as {opened}, but {function} is the function of another kind of file, {is}: open it as that"
    )]
    OtherPurpose { function: &'static str, is: &'static str, opened: &'static str },
    #[error("the function has other parameters or another result than it must have; write: {0} {{ ... }}")]
    Signature(&'static str),
    #[error("this bracket is never closed")]
    Unclosed,
    #[error("this bracket closes nothing")]
    Unopened,
    #[error("the name {0} begins with pnaen_, as the program's own names do: choose another")]
    Prefix(String),
    #[error(
        "the name {0} is declared by the program or by WGSL, and the program's own functions need it: choose another"
    )]
    Taken(String),
    #[error("entry points can't be used here: the program has them; write plain functions")]
    EntryPoint,
    #[error("{0} can't be used here: write a constant, or a variable in a function or in var<private>")]
    Binding(String),
    #[error("this statement can't be used here: it would touch what other invocations have")]
    Statement,
    #[error("this statement has more than {MOST_TOKENS} words and signs: divide it", MOST_TOKENS = bounded::MOST_TOKENS)]
    LongStatement,
    #[error("blocks are nested more than {MOST_DEPTH} deep here: put some into functions", MOST_DEPTH = checked::MOST_DEPTH)]
    Nested,
    #[error("variables take {0} bytes, and may take {MOST_MEMORY}: use smaller arrays", MOST_MEMORY = checked::MOST_MEMORY)]
    Memory(u64),
    #[error("a call of {name} goes through {work} words and signs, counting loops once, and may go through {MOST_WORK}: leave something out", MOST_WORK = bounded::MOST_WORK)]
    Work { name: &'static str, work: u64 },
}

/// Reads and checks a file for the purpose of `S`.
///
/// # Errors
/// It can't be read, or can't be used.
pub fn read_user_shader<S: UserShader>(path: &Path) -> Result<Arc<S>, UserShaderError> {
    let limits = Limits { file: MOST_BYTES, ..Limits::default() };
    let bytes = read_file(path, &limits, |_| Ok::<_, UserShaderError>(()), &Progress::new())?;
    let text = String::from_utf8(bytes).map_err(|_| UserShaderError::NotText(path.to_owned()))?;
    // A byte order mark is no WGSL.
    let text = text.strip_prefix('\u{feff}').map_or(text.clone(), str::to_owned);
    // The parser recurses, as deep as a text of this size asks for.
    let parsing = std::thread::Builder::new().stack_size(STACK).spawn(move || compile::<S>(&text));
    let unchecked = |reason: &str| UserShaderError::Unchecked { path: path.to_owned(), reason: reason.to_owned() };
    let parsed = parsing.map_err(|error| unchecked(&error.to_string()))?.join();
    match parsed.map_err(|_| unchecked("the compiler stopped unexpectedly; please report it, with the file"))? {
        Ok(shader) => Ok(Arc::new(shader)),
        Err(fault) => Err(UserShaderError::Fault { path: path.to_owned(), fault }),
    }
}

/// Bytes of stack for the parser.
const STACK: usize = 256 << 20;

/// Checks a text for the purpose of `S`, and bounds its loops.
///
/// # Errors
/// Where and why it can't be used.
pub fn compile<S: UserShader>(text: &str) -> Result<S, Fault> {
    let purpose = S::PURPOSE;
    let source = bounded::Source::new(text, purpose)?;
    let has = checked::check(text, &source, purpose)?;
    let functions = source.bounded(purpose)?;
    checked::check_loops(&functions, purpose)?;
    let shader = S::new(UserText { text: functions, has });
    checked::check_module(text, &shader.module_text())?;
    Ok(shader)
}

#[cfg(test)]
mod tests;
