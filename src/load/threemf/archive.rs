//! Finds and unpacks the parts of a zip archive, within limits: what an archive says about itself is checked before anything is
//! allocated or unpacked. The crate `rawzip` reads the directory, whose records it gives one by one.

use std::cell::Cell;
use std::io::{self, Read};

use flate2::Crc;
use flate2::bufread::DeflateDecoder;
use rawzip::{
    CompressionMethod, ErrorKind, ZipArchive, ZipArchiveEntryWayfinder, ZipFileHeaderRecord, ZipSliceArchive,
};

use super::broken;
use crate::memory_budget::Budget;
use crate::read_error::{FilePosition, ReadError};
use geometry::casts::to_usize;

/// The greatest number of files in an archive.
const MAX_ENTRIES: usize = 1 << 16;

/// Files that unpack to fewer bytes may do so from any number of packed ones.
const ANY_RATIO: u64 = 16 << 20;
/// The largest ratio of the sizes of other files, unpacked and packed. Models in XML reach about 20.
const MAX_RATIO: u64 = 200;

/// An archive whose bytes are in memory.
pub(super) struct Archive<'a> {
    zip: ZipSliceArchive<&'a [u8]>,
    entries: Vec<Entry>,
    /// How many bytes all parts together may unpack to.
    most: u64,
    /// How many bytes the parts that were opened unpack to.
    unpacked: Cell<u64>,
    /// How many parts had another checksum than the archive says.
    wrong_sums: Cell<usize>,
}

/// A file in the archive.
pub(super) struct Entry {
    name: String,
    is_encrypted: bool,
    method: CompressionMethod,
    place: ZipArchiveEntryWayfinder,
}

impl<'a> Archive<'a> {
    /// Reads the archive's directory, whose memory the budget holds.
    ///
    /// # Errors
    /// [`ReadError::Broken`], [`ReadError::TooMany`] and [`ReadError::TooLarge`].
    pub(super) fn new(bytes: &'a [u8], budget: &Budget) -> Result<Self, ReadError> {
        let zip = ZipArchive::from_slice(bytes).map_err(|_| {
            FilePosition::Everywhere.error("it isn't a whole zip archive: it has no directory at its end")
        })?;
        let mut entries = Vec::new();
        for record in zip.entries() {
            let entry = match record {
                Ok(record) => Entry::new(&record),
                // Something else may follow the last record.
                Err(_) if entries.len() as u64 >= zip.entries_hint() => break,
                Err(error) if matches!(error.kind(), ErrorKind::InvalidSignature { .. }) => break,
                Err(_) => {
                    let start = FilePosition::Byte(to_usize(zip.directory_offset()));
                    return Err(start.error("the archive's directory is damaged"));
                }
            };
            if entries.len() == MAX_ENTRIES {
                return Err(ReadError::TooMany { limit: MAX_ENTRIES as u64, what: "files in its archive" });
            }
            // A list that grows may take three times its size.
            budget.hold((3 * size_of::<Entry>() + entry.name.len()) as u64)?;
            entries.push(entry);
        }
        let (unpacked, wrong_sums) = (Cell::default(), Cell::default());
        Ok(Self { zip, entries, most: budget.allowed(), unpacked, wrong_sums })
    }

    /// The names of the files, in the archive's order.
    pub(super) fn names(&self) -> impl ExactSizeIterator<Item = &str> {
        self.entries.iter().map(|entry| entry.name.as_str())
    }

    /// How many bytes all models of the archive unpack to, by what it says.
    pub(super) fn model_bytes(&self) -> u64 {
        let models = self.entries.iter().filter(|entry| entry.name.to_ascii_lowercase().ends_with(".model"));
        models.fold(0, |sum, entry| sum.saturating_add(entry.place.uncompressed_size_hint()))
    }

    /// Finds a part by its name, whatever its case, with or without the slash that it begins with.
    pub(super) fn entry(&self, name: &str) -> Option<&Entry> {
        let name = name.trim_start_matches('/');
        self.entries.iter().find(|entry| entry.name.eq_ignore_ascii_case(name))
    }

    /// Opens a part, as [`entry`](Self::entry) finds it. Returns none if there is none of this name.
    ///
    /// # Errors
    /// [`ReadError::Broken`], and [`ReadError::TooLarge`] for one that would unpack to too much.
    pub(super) fn open(&self, name: &str) -> Result<Option<Unpacked<'_>>, ReadError> {
        let Some(entry) = self.entry(name) else { return Ok(None) };
        let name = name.trim_start_matches('/');
        let (packed, unpacked) = (entry.place.compressed_size_hint(), entry.place.uncompressed_size_hint());
        let total = self.unpacked.get().saturating_add(unpacked);
        if total > self.most {
            let (total, most) = (total.div_ceil(1 << 20), self.most >> 20);
            let reason = format!(
                "unpacks to {total} MiB, but files of this size may unpack only to {most} MiB (--max-memory allows more)"
            );
            return Err(ReadError::TooLarge { reason });
        }
        if unpacked > ANY_RATIO && unpacked / MAX_RATIO > packed {
            let reason = format!("its {packed} bytes unpack to {unpacked}, as those of no model or image do");
            return Err(broken(name, reason));
        }
        self.unpacked.set(total);
        if entry.is_encrypted {
            return Err(broken(name, "it is encrypted, and can't be read"));
        }
        let own = self.zip.get_entry(entry.place).map_err(|error| match error.kind() {
            ErrorKind::InvalidSignature { .. } => broken(name, "it isn't where the archive says"),
            _ => broken(name, "the archive says that it lies beyond the file's end"),
        })?;
        let data: Box<dyn Read> = match entry.method {
            CompressionMethod::STORE => Box::new(own.data()),
            CompressionMethod::DEFLATE => Box::new(DeflateDecoder::new(own.data())),
            method => {
                let method = method.as_u16();
                return Err(broken(name, format!("it is compressed by method {method}, but only 0 and 8 are read")));
            }
        };
        let (sum, wrong_sums) = (own.claim_verifier().crc, &self.wrong_sums);
        Ok(Some(Unpacked { data, left: unpacked, crc: Crc::new(), sum, wrong_sums }))
    }

    /// A warning about parts with a wrong checksum, if there are any.
    pub(super) fn warning(&self) -> Option<String> {
        let count = self.wrong_sums.get();
        (count > 0).then(|| format!("parts whose checksum isn't the archive's, so that they may be damaged: {count}."))
    }
}

impl Entry {
    fn new(record: &ZipFileHeaderRecord) -> Self {
        Self {
            name: String::from_utf8_lossy(record.file_path().as_ref()).replace('\\', "/"),
            is_encrypted: record.flags().is_encrypted(),
            method: record.compression_method(),
            place: record.wayfinder(),
        }
    }
}

/// The bytes of a part, unpacked while they are read.
pub(super) struct Unpacked<'a> {
    data: Box<dyn Read + 'a>,
    /// How many bytes are missing, by what the archive says.
    pub left: u64,
    crc: Crc,
    /// The checksum that the archive says.
    sum: u32,
    wrong_sums: &'a Cell<usize>,
}

impl Read for Unpacked<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.data.read(buffer).map_err(|_| io::Error::other("its compressed data is damaged"))?;
        let Some(left) = self.left.checked_sub(count as u64) else {
            return Err(io::Error::other("it unpacks to more than the archive says"));
        };
        self.left = left;
        self.crc.update(&buffer[..count]);
        if count == 0 && !buffer.is_empty() {
            if self.left > 0 {
                return Err(io::Error::other("it unpacks to less than the archive says"));
            }
            // Counted once, however often the end is read.
            let is_wrong = self.crc.sum() != std::mem::replace(&mut self.sum, self.crc.sum());
            self.wrong_sums.set(self.wrong_sums.get() + usize::from(is_wrong));
        }
        Ok(count)
    }
}
