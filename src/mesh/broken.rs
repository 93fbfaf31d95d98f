//! OBJ, STL and PLY files that are broken or meant to do harm: what each gets, and that nothing takes long.

mod hostile;
mod mutated;

use std::path::Path;
use std::time::{Duration, Instant};

use super::{Fault, Limits, Mesh, Progress, obj, ply, stl};

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

/// What no file of a test may take longer than; as a test runs beside others, twice what a person gets.
const LIMIT: Duration = Duration::from_secs(2);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Obj,
    Stl,
    Ply,
}

fn read(format: Format, bytes: &[u8]) -> Result<Mesh, Fault> {
    let start = Instant::now();
    let progress = Progress::new();
    let mesh = match format {
        Format::Obj => obj::read(bytes, Path::new("nowhere"), "broken", &Limits::default(), &progress),
        Format::Stl => stl::read(bytes, "broken", &progress),
        Format::Ply => ply::read(bytes, "broken", &progress),
    };
    let (took, length) = (start.elapsed(), bytes.len());
    assert!(took < LIMIT, "{format:?} of {length} bytes took {took:?}");
    mesh
}
