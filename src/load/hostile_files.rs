//! OBJ, STL and PLY files that are broken or meant to do harm: what each gets, and that nothing takes long.

mod mutated;
pub mod page;
mod seeds;
mod table;

use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::time::{Duration, Instant};

use super::{ReadError, obj, ply, stl};
use crate::files::Limits;
use crate::load::LoadedMesh;
use crate::progress::Progress;

/// Xorshift, 64 bits, from a seed that isn't 0 (Marsaglia 2003).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    pub fn below(&mut self, end: usize) -> usize {
        (self.next() % end.max(1) as u64) as usize
    }
}

/// What no file of a test may take longer than, of this thread's own time.
const LIMIT: Duration = Duration::from_secs(1);

/// This thread's own time: tests beside this one, on a busy machine, take nothing of it. Where there is no such clock, time as
/// it passes.
pub fn time() -> Duration {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    let said = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = said.and_then(|said| said.split(' ').next()?.parse().ok());
    nanoseconds.map_or_else(|| START.elapsed(), Duration::from_nanos)
}

/// The files that `PNAEN_MUTATE` names, as `a.glb:b.obj`.
pub fn named_files() -> Vec<PathBuf> {
    let named = std::env::var("PNAEN_MUTATE").unwrap_or_default();
    named.split(':').filter(|path| !path.is_empty()).map(PathBuf::from).collect()
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Obj,
    Stl,
    Ply,
}

fn read(format: Format, bytes: &[u8]) -> Result<LoadedMesh, ReadError> {
    let start = time();
    let progress = Progress::new();
    let loaded = match format {
        Format::Obj => obj::read(bytes.to_vec(), Path::new("nowhere"), "broken", &Limits::default(), &progress),
        Format::Stl => stl::read(bytes.to_vec(), "broken", &Limits::default(), &progress),
        Format::Ply => ply::read(bytes.to_vec(), "broken", &Limits::default(), &progress),
    };
    let (took, length) = (time() - start, bytes.len());
    assert!(took < LIMIT, "{format:?} of {length} bytes took {took:?}");
    loaded
}
