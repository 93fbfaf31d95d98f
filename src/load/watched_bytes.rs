//! Bytes that a decoder reads while a job watches it.

use std::io::{self, BufReader, Cursor, Read, Seek, SeekFrom};

use geometry::progress::Progress;

/// Bytes that can't be read any more once the job was cancelled, and that report how many of them were read.
pub(super) struct WatchedBytes<'a> {
    bytes: Cursor<&'a [u8]>,
    progress: Progress,
}

/// Returns bytes for a decoder.
pub(super) fn watched(bytes: &[u8], progress: Progress) -> BufReader<WatchedBytes<'_>> {
    BufReader::new(WatchedBytes { bytes: Cursor::new(bytes), progress })
}

impl Read for WatchedBytes<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.progress.check().map_err(io::Error::other)?;
        let count = self.bytes.read(buffer)?;
        self.progress.set(self.bytes.position() as f32 / self.bytes.get_ref().len().max(1) as f32);
        Ok(count)
    }
}

impl Seek for WatchedBytes<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.bytes.seek(to)
    }
}
