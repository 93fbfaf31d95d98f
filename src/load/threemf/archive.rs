//! Finds and unpacks the parts of a zip archive, within limits: what an archive says about itself is checked before anything is
//! allocated or unpacked.
//! The crate `zip` isn't used: it reserves memory for as many files as an archive says that it has.
//!
//! Source: PKWARE, APPNOTE.TXT 6.3.10, sections 4.3 and 4.5.3.

use std::cell::Cell;
use std::io::{self, Read};

use flate2::Crc;
use flate2::bufread::DeflateDecoder;

use super::broken;
use crate::memory_budget::Budget;
use crate::read_error::{FilePosition, ReadError};

/// The greatest number of files in an archive.
const MAX_ENTRIES: usize = 1 << 16;

/// Files that unpack to fewer bytes may do so from any number of packed ones.
const ANY_RATIO: u64 = 16 << 20;
/// The largest ratio of the sizes of other files, unpacked and packed. Models in XML reach about 20.
const MAX_RATIO: u64 = 200;

const LOCAL: &[u8] = b"PK\x03\x04";
const ENTRY: &[u8] = b"PK\x01\x02";
const END: &[u8] = b"PK\x05\x06";
const END_64: &[u8] = b"PK\x06\x06";
const LOCATOR_64: &[u8] = b"PK\x06\x07";

/// The sizes of these records without what their lengths vary by, in bytes.
const LOCAL_SIZE: usize = 30;
const ENTRY_SIZE: usize = 46;
const END_SIZE: usize = 22;
const LOCATOR_SIZE: usize = 20;

/// An archive whose bytes are in memory.
pub(super) struct Archive<'a> {
    bytes: &'a [u8],
    entries: Vec<Entry>,
    /// How many bytes all parts together may unpack to.
    most: u64,
    /// How many bytes the parts that were opened unpack to.
    unpacked: Cell<u64>,
    /// How many parts had another checksum than the archive says.
    wrong_sums: Cell<usize>,
}

/// A file in the archive.
struct Entry {
    name: String,
    flags: u16,
    method: u16,
    crc: u32,
    packed: u64,
    unpacked: u64,
    /// Where its own header is.
    header: u64,
}

impl<'a> Archive<'a> {
    /// Reads the archive's directory, whose memory the budget holds.
    ///
    /// # Errors
    /// [`ReadError::Broken`], [`ReadError::TooMany`] and [`ReadError::TooLarge`].
    pub(super) fn new(bytes: &'a [u8], budget: &Budget) -> Result<Self, ReadError> {
        let directory = directory(bytes).ok_or_else(|| {
            FilePosition::Everywhere.error("it isn't a whole zip archive: it has no directory at its end")
        })?;
        let (mut entries, mut rest) = (Vec::new(), directory);
        while rest.starts_with(ENTRY) {
            if entries.len() == MAX_ENTRIES {
                return Err(ReadError::TooMany { limit: MAX_ENTRIES as u64, what: "files in its archive" });
            }
            let (entry, tail) = Entry::read(rest).ok_or_else(|| {
                FilePosition::Byte(bytes.len() - rest.len()).error("the archive's directory is damaged")
            })?;
            // A list that grows may take three times its size.
            budget.hold((3 * size_of::<Entry>() + entry.name.len()) as u64)?;
            entries.push(entry);
            rest = tail;
        }
        let (unpacked, wrong_sums) = (Cell::default(), Cell::default());
        Ok(Self { bytes, entries, most: budget.allowed(), unpacked, wrong_sums })
    }

    /// The names of the files, in the archive's order.
    pub(super) fn names(&self) -> impl ExactSizeIterator<Item = &str> {
        self.entries.iter().map(|entry| entry.name.as_str())
    }

    /// How many bytes all models of the archive unpack to, by what it says.
    pub(super) fn model_bytes(&self) -> u64 {
        let models = self.entries.iter().filter(|entry| entry.name.to_ascii_lowercase().ends_with(".model"));
        models.fold(0, |sum, entry| sum.saturating_add(entry.unpacked))
    }

    /// Whether there is a part of this name, as [`open`](Self::open) finds it.
    pub(super) fn has(&self, name: &str) -> bool {
        self.entry(name.trim_start_matches('/')).is_some()
    }

    fn entry(&self, name: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.name.eq_ignore_ascii_case(name))
    }

    /// Opens a part by its name, whatever its case, with or without the slash that it begins with. Returns none if there is none of
    /// this name.
    ///
    /// # Errors
    /// [`ReadError::Broken`], and [`ReadError::TooLarge`] for one that would unpack to too much.
    pub(super) fn open(&self, name: &str) -> Result<Option<Unpacked<'_>>, ReadError> {
        let name = name.trim_start_matches('/');
        let Some(entry) = self.entry(name) else { return Ok(None) };
        let total = self.unpacked.get().saturating_add(entry.unpacked);
        if total > self.most {
            let (total, most) = (total.div_ceil(1 << 20), self.most >> 20);
            let reason = format!(
                "unpacks to {total} MiB, but files of this size may unpack only to {most} MiB (--max-memory allows more)"
            );
            return Err(ReadError::TooLarge { reason });
        }
        if entry.unpacked > ANY_RATIO && entry.unpacked / MAX_RATIO > entry.packed {
            let Entry { packed, unpacked, .. } = entry;
            let reason = format!("its {packed} bytes unpack to {unpacked}, as those of no model or image do");
            return Err(broken(name, reason));
        }
        self.unpacked.set(total);
        let data = self.data(entry).map_err(|reason| broken(name, reason))?;
        let packed = match entry.method {
            0 => Packed::Stored(data),
            8 => Packed::Deflated(Box::new(DeflateDecoder::new(data))),
            method => {
                return Err(broken(name, format!("it is compressed by method {method}, but only 0 and 8 are read")));
            }
        };
        let (left, sum, wrong_sums) = (entry.unpacked, entry.crc, &self.wrong_sums);
        Ok(Some(Unpacked { packed, left, crc: Crc::new(), sum, wrong_sums }))
    }

    /// Returns a part's packed bytes.
    fn data(&self, entry: &Entry) -> Result<&'a [u8], &'static str> {
        if entry.flags & 1 != 0 {
            return Err("it is encrypted, and can't be read");
        }
        let beyond = "the archive says that it lies beyond the file's end";
        let header = usize::try_from(entry.header).ok().and_then(|start| self.bytes.get(start..)).ok_or(beyond)?;
        if !header.starts_with(LOCAL) || header.len() < LOCAL_SIZE {
            return Err("it isn't where the archive says");
        }
        let start = LOCAL_SIZE + usize::from(u16_at(header, 26)) + usize::from(u16_at(header, 28));
        let packed = usize::try_from(entry.packed).ok();
        packed.and_then(|packed| header.get(start..start.checked_add(packed)?)).ok_or(beyond)
    }

    /// A warning about parts with a wrong checksum, if there are any.
    pub(super) fn warning(&self) -> Option<String> {
        let count = self.wrong_sums.get();
        (count > 0).then(|| format!("parts whose checksum isn't the archive's, so that they may be damaged: {count}."))
    }
}

impl Entry {
    /// Reads an entry of the directory. Also returns what follows it.
    fn read(bytes: &[u8]) -> Option<(Self, &[u8])> {
        let (fixed, rest) = bytes.split_at_checked(ENTRY_SIZE)?;
        let [name, extra, comment] = [28, 30, 32].map(|at| usize::from(u16_at(fixed, at)));
        let (name, rest) = rest.split_at_checked(name)?;
        let (extra, rest) = rest.split_at_checked(extra)?;
        let rest = rest.get(comment..)?;
        let mut entry = Self {
            name: String::from_utf8_lossy(name).replace('\\', "/"),
            flags: u16_at(fixed, 8),
            method: u16_at(fixed, 10),
            crc: u32_at(fixed, 16),
            packed: u32_at(fixed, 20).into(),
            unpacked: u32_at(fixed, 24).into(),
            header: u32_at(fixed, 42).into(),
        };
        entry.widen(extra);
        Some((entry, rest))
    }

    /// Replaces numbers that don't fit 32 bits by those of the extra field for them.
    fn widen(&mut self, mut extra: &[u8]) {
        const WIDE: u16 = 1;
        while let Some((head, tail)) = extra.split_at_checked(4) {
            let (kind, length) = (u16_at(head, 0), usize::from(u16_at(head, 2)));
            let Some((field, rest)) = tail.split_at_checked(length) else { return };
            if kind == WIDE {
                let mut numbers = field.as_chunks::<8>().0.iter().map(|number| u64::from_le_bytes(*number));
                let wide = [&mut self.unpacked, &mut self.packed, &mut self.header];
                for number in wide.into_iter().filter(|number| **number == u64::from(u32::MAX)) {
                    *number = numbers.next().unwrap_or(*number);
                }
                return;
            }
            extra = rest;
        }
    }
}

/// Returns the bytes from the directory's start on, if the archive has one.
fn directory(bytes: &[u8]) -> Option<&[u8]> {
    let first = bytes.len().saturating_sub(END_SIZE + usize::from(u16::MAX));
    let is_end = |at: &usize| {
        let record = &bytes[*at..];
        record.len() >= END_SIZE && usize::from(u16_at(record, 20)) <= record.len() - END_SIZE
    };
    let end = memchr::memmem::rfind_iter(&bytes[first..], END).map(|at| first + at).find(is_end)?;
    let record = &bytes[end..];
    let (mut start, mut length, mut after) = (u64::from(u32_at(record, 16)), u64::from(u32_at(record, 12)), end);
    let locator = end.checked_sub(LOCATOR_SIZE).map(|at| &bytes[at..]).filter(|record| record.starts_with(LOCATOR_64));
    let wide = locator.and_then(|locator| {
        let at = usize::try_from(u64_at(locator, 8)).ok()?;
        let record = bytes.get(at..).filter(|record| record.starts_with(END_64) && record.len() >= 56)?;
        Some((at, record))
    });
    if let Some((at, record)) = wide {
        (start, length, after) = (u64_at(record, 48), u64_at(record, 40), at);
    }
    let from = |start: u64| bytes.get(usize::try_from(start).ok()?..);
    // Something may stand before the archive that its offsets don't count.
    let before_end = || (after as u64).checked_sub(length).and_then(from);
    from(start).filter(|rest| rest.starts_with(ENTRY)).or_else(before_end)
}

/// The bytes of a part, unpacked while they are read.
pub(super) struct Unpacked<'a> {
    packed: Packed<'a>,
    /// How many bytes are missing, by what the archive says.
    pub left: u64,
    crc: Crc,
    /// The checksum that the archive says.
    sum: u32,
    wrong_sums: &'a Cell<usize>,
}

enum Packed<'a> {
    Stored(&'a [u8]),
    Deflated(Box<DeflateDecoder<&'a [u8]>>),
}

impl Read for Unpacked<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = match &mut self.packed {
            Packed::Stored(data) => data.read(buffer)?,
            Packed::Deflated(decoder) => {
                decoder.read(buffer).map_err(|_| io::Error::other("its compressed data is damaged"))?
            }
        };
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

fn u16_at(bytes: &[u8], at: usize) -> u16 {
    bytes.get(at..at + 2).and_then(|bytes| bytes.try_into().ok()).map_or(0, u16::from_le_bytes)
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    bytes.get(at..at + 4).and_then(|bytes| bytes.try_into().ok()).map_or(0, u32::from_le_bytes)
}

fn u64_at(bytes: &[u8], at: usize) -> u64 {
    bytes.get(at..at + 8).and_then(|bytes| bytes.try_into().ok()).map_or(0, u64::from_le_bytes)
}
