//! Reads and writes files: limits on their size, reading a file whole, replacing a file so that a failure loses
//! nothing, and messages about file system errors that say what to do.

use std::ffi::OsString;
use std::fs::{File, Metadata};
use std::io::{self, ErrorKind, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use tempfile::{Builder, NamedTempFile, TempDir};

use geometry::defaults::with_defaults;
use geometry::names::shown_path;
use geometry::progress::{Cancelled, Progress};

with_defaults! {
    /// Limits on what a load may read and how much memory it may take.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Limits {
        /// The size of the largest file that is read, in bytes. It applies to the model's file and to each file that it
        /// names.
        pub file: u64 = 2 << 30,
        /// How much memory a load may take, in bytes, beyond four times the size of all its files.
        pub memory: u64 = 512 << 20,
    }
}

/// Why a file could not be read whole.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the messages say what the fields are")]
pub enum FileError {
    /// Reading was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The path leads to a folder, a device or a pipe.
    #[error("{} is not a file; choose a file", shown_path(path))]
    NotAFile { path: PathBuf },
    /// The file changed while it was read.
    #[error("{} changed while it was read; open it again once it is whole", shown_path(path))]
    Changed { path: PathBuf },
    /// The file system refused.
    #[error("{} can't be read: {}", shown_path(path), file_reason(source))]
    Io { path: PathBuf, source: io::Error },
    /// The file has more bytes than are read.
    #[error(
        "{} has {bytes} bytes, but at most {limit} are read; if you trust the file, allow more with --max-size",
        shown_path(path)
    )]
    TooLarge { path: PathBuf, bytes: u64, limit: u64 },
}

/// Returns why a file couldn't be read or written, as a clause that says what to do.
pub fn file_reason(error: &io::Error) -> String {
    match error.kind() {
        // An error that this program made has a reason already.
        _ if error.get_ref().is_some() => error.to_string(),
        ErrorKind::NotFound => "there is no such file or folder; check its path".to_owned(),
        ErrorKind::PermissionDenied => {
            "the system doesn't allow it; change its permissions, or choose another file".to_owned()
        }
        ErrorKind::ReadOnlyFilesystem => "nothing can be written there; choose another folder".to_owned(),
        ErrorKind::StorageFull => "there is no room left; delete something or choose another disk".to_owned(),
        ErrorKind::IsADirectory => "it is a folder; name a file".to_owned(),
        ErrorKind::AlreadyExists => "there is a file of this name; choose another one".to_owned(),
        ErrorKind::NotADirectory => "a part of its path isn't a folder; check its path".to_owned(),
        _ => error.to_string(),
    }
}

/// Opens a regular file for reading. Returns none for a folder, a device or a pipe, since opening those may block for
/// ever.
///
/// # Errors
/// The errors of the file system.
pub fn open_file(path: &Path) -> io::Result<Option<(File, Metadata)>> {
    if !std::fs::metadata(path)?.is_file() {
        return Ok(None);
    }
    let file = File::open(path)?;
    let about = file.metadata()?;
    // The file may have been replaced in between.
    Ok(about.is_file().then_some((file, about)))
}

/// A file's length and time of change. If one of them differs, the file was changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stamp {
    bytes: u64,
    /// None if the file system stores no times.
    modified: Option<SystemTime>,
}

impl Stamp {
    /// The stamp of the file at `path` as it is now; none if it isn't there.
    pub fn of(path: &Path) -> Option<Self> {
        std::fs::metadata(path).ok().map(|about| Self::new(&about))
    }

    pub(crate) fn new(about: &Metadata) -> Self {
        Self { bytes: about.len(), modified: about.modified().ok() }
    }

    /// Checks that the file at `path` hasn't changed since this stamp was taken. If it has, the files that it names may
    /// belong to another version of it.
    ///
    /// # Errors
    /// [`FileError::Changed`].
    pub(crate) fn check(&self, path: &Path) -> Result<(), FileError> {
        match std::fs::metadata(path) {
            Ok(about) if Self::new(&about) != *self => Err(FileError::Changed { path: path.to_owned() }),
            // A file that was removed had been read before.
            _ => Ok(()),
        }
    }
}

/// Reads a whole file, unless it is larger than `limits` allows, by its length or by what is read. The bytes all belong
/// to one version of the file: a file that changes while it is read is refused.
///
/// `check_start` gets the first bytes (at most 65,536) before the rest is read, and may refuse the file.
///
/// # Errors
/// [`FileError`], and the errors of `check_start`.
pub fn read_file<E: From<FileError>>(
    path: &Path,
    limits: &Limits,
    check_start: impl FnOnce(&[u8]) -> Result<(), E>,
    progress: &Progress,
) -> Result<Vec<u8>, E> {
    let io = |source| FileError::Io { path: path.to_owned(), source };
    let opened = open_file(path).map_err(io)?;
    let (mut file, about) = opened.ok_or_else(|| FileError::NotAFile { path: path.to_owned() })?;
    if about.len() <= limits.file {
        let mut start = Vec::new();
        Read::by_ref(&mut file).take(START).read_to_end(&mut start).map_err(io)?;
        check_start(&start)?;
        file.rewind().map_err(io)?;
    }
    Ok(read_whole(file, &about, path, limits, progress)?)
}

/// How many bytes at the start of a file are enough to recognise its format.
const START: u64 = 1 << 16;
/// How many bytes are read between two checks for cancellation.
const PIECE: u64 = 1 << 24;

fn read_whole(
    file: File,
    about: &Metadata,
    path: &Path,
    limits: &Limits,
    progress: &Progress,
) -> Result<Vec<u8>, FileError> {
    let io = |source| FileError::Io { path: path.to_owned(), source };
    let too_large = |bytes| FileError::TooLarge { path: path.to_owned(), bytes, limit: limits.file };
    let said = about.len();
    if said > limits.file {
        return Err(too_large(said));
    }
    let mut bytes = Vec::new();
    // Reserved at once: a list that grows may take up to twice as much.
    let room = usize::try_from(said).unwrap_or(usize::MAX).saturating_add(1);
    bytes.try_reserve_exact(room).map_err(|error| io(error.into()))?;
    let mut rest = file.take(limits.file.saturating_add(1));
    while rest.by_ref().take(PIECE).read_to_end(&mut bytes).map_err(io)? > 0 {
        progress.check()?;
    }
    let now = rest.into_inner().metadata().map_err(io)?;
    match bytes.len() as u64 {
        read if read > limits.file => Err(too_large(read)),
        _ if Stamp::new(&now) != Stamp::new(about) => Err(FileError::Changed { path: path.to_owned() }),
        _ => Ok(bytes),
    }
}

/// The greatest number of symbolic links that are followed to a file that doesn't exist yet.
const MAX_LINKS: usize = 40;

/// Writes a file: first under another name in the same folder, then renamed. So the old file stays whole if the disk is
/// full or the process is killed. A pipe or a device is written directly. A symbolic link stays a link, and permissions
/// are kept.
///
/// # Errors
/// The errors of the file system. An existing file that is read-only isn't replaced.
pub fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if path.exists() && !path.is_file() {
        return std::fs::OpenOptions::new().write(true).open(path)?.write_all(bytes);
    }
    let part = PartFile::create(path)?;
    part.file().write_all(bytes)?;
    part.finish()
}

/// A file that is written under another name in its folder, and takes its place once it is whole. What was there stays until
/// then, and if this is dropped before. A symbolic link stays a link, and permissions are kept.
pub struct PartFile {
    file: NamedTempFile,
    place: PathBuf,
    permissions: Option<std::fs::Permissions>,
}

impl PartFile {
    /// # Errors
    /// The errors of the file system. An existing file that is read-only isn't replaced.
    pub fn create(path: &Path) -> io::Result<Self> {
        let place = std::fs::canonicalize(path).unwrap_or_else(|_| end_of_links(path));
        let permissions = std::fs::metadata(&place).ok().map(|metadata| metadata.permissions());
        if permissions.as_ref().is_some_and(std::fs::Permissions::readonly) {
            return Err(io::Error::new(io::ErrorKind::PermissionDenied, "it is read-only"));
        }
        let (folder, prefix) = temporary_path(&place);
        // A temporary file of the crate's own could be read by nobody else, and this one stays.
        let file = Builder::new().prefix(&prefix).suffix(PART).make_in(folder, |path| File::create_new(path))?;
        Ok(Self { file, place, permissions })
    }

    /// What its bytes are written to.
    pub fn file(&self) -> &File {
        self.file.as_file()
    }

    /// Puts the file in its place.
    ///
    /// # Errors
    /// The errors of the file system.
    pub fn finish(self) -> io::Result<()> {
        // A network drive or a full disk may report its failure only now.
        self.file().sync_all()?;
        if let Some(permissions) = self.permissions {
            std::fs::set_permissions(&self.file, permissions)?;
        }
        self.file.persist(&self.place)?;
        Ok(())
    }
}

/// A folder whose files are written into another folder beside it, and come into it together once they are whole. Dropped
/// before, it changes nothing.
pub struct PartFolder {
    beside: TempDir,
    place: PathBuf,
    names: Vec<String>,
}

impl PartFolder {
    /// # Errors
    /// The errors of the file system.
    pub fn create(path: &Path) -> io::Result<Self> {
        let place = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        if place.exists() && !place.is_dir() {
            return Err(io::Error::new(ErrorKind::NotADirectory, "it is not a folder; choose another name"));
        }
        let (folder, prefix) = temporary_path(&place);
        let made = Builder::new().prefix(&prefix).suffix(PART).tempdir_in(folder);
        // The crate's own error has the path, which every message begins with.
        let beside = made.map_err(|error| error.kind())?;
        Ok(Self { beside, place, names: Vec::new() })
    }

    /// The path under which the file of this name is written.
    pub fn path(&mut self, name: String) -> PathBuf {
        let path = self.beside.path().join(&name);
        self.names.push(name);
        path
    }

    /// Puts the files in their places. The folder is made if it isn't there.
    ///
    /// # Errors
    /// The errors of the file system.
    pub fn finish(self) -> io::Result<()> {
        std::fs::create_dir_all(&self.place)?;
        self.names.iter().try_for_each(|name| std::fs::rename(self.beside.path().join(name), self.place.join(name)))
    }
}

/// How the name of something ends that isn't whole yet.
const PART: &str = ".part";

/// The folder in which something is written that isn't whole yet, and how its name begins there.
fn temporary_path(place: &Path) -> (&Path, OsString) {
    let mut prefix = place.file_name().unwrap_or_default().to_owned();
    prefix.push(".");
    (place.parent().unwrap_or(Path::new("")), prefix)
}

/// Follows symbolic links to the path of a file that doesn't exist yet.
fn end_of_links(path: &Path) -> PathBuf {
    let mut place = path.to_owned();
    for _ in 0..MAX_LINKS {
        let Ok(next) = std::fs::read_link(&place) else { break };
        // A relative link is relative to its own folder.
        place = place.parent().unwrap_or(Path::new("")).join(next);
    }
    place
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_errors_say_what_to_do() {
        let missing = std::fs::read("no/such/file").expect_err("it isn't there");
        assert_eq!(file_reason(&missing), "there is no such file or folder; check its path");
        assert_eq!(file_reason(&io::Error::other("it is a device")), "it is a device");
    }

    /// Files in /proc report a length of 0, since the system writes them while they are read.
    #[cfg(target_os = "linux")]
    #[test]
    fn files_larger_than_their_reported_length_are_refused() {
        let path = Path::new("/proc/self/status");
        assert_eq!(std::fs::metadata(path).unwrap().len(), 0);
        let read = |file| {
            read_file(path, &Limits { file, ..Limits::default() }, |_| Ok::<(), FileError>(()), &Progress::new())
        };
        let message = read(100).unwrap_err().to_string();
        assert!(message.contains("has 101 bytes, but at most 100 are read"), "{message}");
        assert!(read(1 << 20).is_ok_and(|bytes| bytes.len() > 100));
    }

    #[test]
    fn the_files_of_a_folder_come_together_or_not_at_all() {
        let parent = tempfile::tempdir().unwrap();
        let place = parent.path().join("out/");
        let names = |folder: &Path| {
            let mut names: Vec<_> = std::fs::read_dir(folder)
                .map(|all| all.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect())
                .unwrap_or_default();
            names.sort();
            names
        };
        let write = |text: &str, all: &[&str]| {
            let mut folder = PartFolder::create(&place).unwrap();
            for name in all {
                std::fs::write(folder.path((*name).to_owned()), text).unwrap();
            }
            folder
        };
        drop(write("dropped", &["a", "b"]));
        assert!(names(parent.path()).is_empty());
        write("first", &["a", "b"]).finish().unwrap();
        assert_eq!(
            (names(parent.path()), names(&place)),
            (vec!["out".to_owned()], vec!["a".to_owned(), "b".to_owned()])
        );
        drop(write("dropped", &["a", "c"]));
        assert_eq!(std::fs::read_to_string(place.join("a")).unwrap(), "first");
        write("second", &["b", "c"]).finish().unwrap();
        assert_eq!(
            (names(parent.path()), names(&place)),
            (vec!["out".to_owned()], ["a", "b", "c"].map(str::to_owned).to_vec())
        );
        assert_eq!(["a", "b"].map(|name| std::fs::read_to_string(place.join(name)).unwrap()), ["first", "second"]);
    }

    #[test]
    fn files_that_are_written_to_one_path_at_once_are_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bin");
        let [first, second] = [PartFile::create(&path).unwrap(), PartFile::create(&path).unwrap()];
        first.file().write_all(b"the first one").unwrap();
        second.file().write_all(b"another").unwrap();
        first.finish().unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"the first one");
        second.finish().unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"another");
        let texts = [b'a', b'b'].map(|letter| vec![letter; 10_000 * usize::from(letter - b'`')]);
        std::thread::scope(|scope| {
            for text in &texts {
                scope.spawn(|| {
                    for _ in 0..50 {
                        write_whole(&path, text).unwrap();
                        assert!(texts.contains(&std::fs::read(&path).unwrap()), "one of both, and whole");
                    }
                });
            }
        });
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing else stays");
    }

    #[cfg(unix)]
    #[test]
    fn a_new_file_has_usual_permissions_and_a_link_in_its_way_is_not_followed() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let [path, usual, other] = ["a.bin", "usual", "other"].map(|name| folder.path().join(name));
        std::fs::write(&other, "someone's").unwrap();
        for name in [format!("a.bin.{}.part", std::process::id()), "a.bin.part".to_owned()] {
            std::os::unix::fs::symlink(&other, folder.path().join(name)).unwrap();
        }
        write_whole(&path, b"bytes").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"bytes");
        assert_eq!(std::fs::read(&other).unwrap(), b"someone's");
        File::create(&usual).unwrap();
        let [mode, usual] = [path, usual].map(|path| std::fs::metadata(path).unwrap().permissions().mode());
        assert_eq!(mode, usual);
    }

    #[test]
    fn a_file_that_changes_while_it_is_read_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.stl");
        let write = |bytes: usize| std::fs::write(&path, vec![b' '; bytes]).unwrap();
        let opened = || open_file(&path).unwrap().expect("a file");
        let read = |(file, about): (File, Metadata)| {
            read_whole(file, &about, &path, &Limits { file: 1000, ..Limits::default() }, &Progress::new())
                .map_err(|error| error.to_string())
        };
        write(100);
        assert_eq!(read(opened()).map(|bytes| bytes.len()), Ok(100));
        for (bytes, expected) in
            [(90, "changed while it was read"), (110, "changed while it was read"), (2000, "has 1001 bytes")]
        {
            write(100);
            let before = opened();
            write(bytes);
            assert!(read(before).is_err_and(|error| error.contains(expected)), "{bytes}");
        }
        write(100);
        let before = opened();
        let later = SystemTime::now() + std::time::Duration::from_secs(2);
        File::options().write(true).open(&path).and_then(|file| file.set_modified(later)).unwrap();
        assert!(read(before).is_err_and(|error| error.contains("open it again")), "the same length, another time");
        let before = Stamp::new(&std::fs::metadata(&path).unwrap());
        assert!(before.check(&path).is_ok());
        write(100);
        assert!(before.check(&path).is_err_and(|error| error.to_string().contains("changed while it was read")));
        // A file that takes this file's name isn't the file that was opened.
        let before = opened();
        std::fs::remove_file(&path).unwrap();
        write(7);
        assert_eq!(read(before).map(|bytes| bytes.len()), Ok(100));
    }

    #[test]
    fn reading_stops_when_it_is_cancelled() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.stl");
        File::create(&path).and_then(|file| file.set_len(1 << 30)).unwrap();
        let progress = Progress::new();
        progress.cancel();
        let result = read_file(&path, &Limits::default(), |_| Ok::<(), FileError>(()), &progress);
        assert!(matches!(result, Err(FileError::Cancelled(_))));
    }
}
