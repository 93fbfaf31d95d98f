//! Tags of subdivision surfaces (the statement `t`): creases, sharp points, holes, and rules for boundaries. They count where
//! polygons are taken as a cage.
//!
//! Source: the shapes of OpenSubdiv's regression tests (`regression/common`, `shape_utils.h` and `vtr_utils.h`). After its name a
//! tag says how many integers, floats and strings follow, as in `2/1/0`. Vertices and faces count from 0. As in RenderMan, a crease
//! is a chain of vertices, with a sharpness for all of its edges or for each.

use glam::Vec3;

use crate::face_builder::FaceBuilder;
use crate::memory_budget::Budget;
use crate::notes::counts;
use crate::text_lines::{number_or_nan, parsed, words};
use geometry::mesh::MemoryRefused;
use geometry::mesh::chunked_vec::ChunkedVec;
use geometry::mesh::subdivision::{Boundary, FaceVarying};

/// The number of what isn't in the file.
const ABSENT: u32 = u32::MAX;

/// Memory for what is made of a byte, in bytes: lists of edges with their sharpness grow here and in the cage.
const PER_BYTE: u64 = 36;

#[derive(Default)]
pub(super) struct Tags {
    /// Edges by their two vertices, and points by one vertex twice, with their sharpness.
    sharp: Vec<([u32; 2], f32)>,
    /// Faces, in growing order once all are known.
    pub holes: Vec<u32>,
    boundary: Option<Boundary>,
    face_varying: Option<FaceVarying>,
    flaws: TagFlaws,
    /// The memory that they and the cage take for them, in bytes.
    held: u64,
}

counts! {
    struct TagFlaws {
        unknown => "subdivision tags other than creases, corners, holes and known rules for boundaries, left out";
        dull => "creases and sharp points whose sharpness is negative or not a number, left out";
        absent => "creases, sharp points and holes with the number of a vertex or face that isn't in the file, left out";
    }
}

impl Tags {
    /// Takes what follows the first word of a statement.
    ///
    /// # Errors
    /// [`MemoryRefused`].
    pub(super) fn take(&mut self, text: &[u8], budget: &Budget) -> Result<(), MemoryRefused> {
        let memory = PER_BYTE * text.len() as u64;
        budget.hold(memory)?;
        self.held += memory;
        self.flaws.unknown += usize::from(self.read(text).is_none());
        Ok(())
    }

    fn read(&mut self, text: &[u8]) -> Option<()> {
        let mut words = words(text);
        let name = words.next()?;
        let mut counts = words.next()?.split(|byte| *byte == b'/').map(parsed::<usize>);
        let [whole, floats, strings] = [counts.next()??, counts.next()??, counts.next()??];
        // Negative ones name nothing.
        let integer = |word| parsed::<i64>(word).map(|number| u32::try_from(number).unwrap_or(ABSENT));
        let integers: Vec<u32> = words.by_ref().take(whole).map_while(integer).collect();
        let numbers: Vec<f32> = words.by_ref().take(floats).map(number_or_nan).collect();
        if integers.len() != whole || numbers.len() != floats || words.count() != strings {
            return None;
        }
        match (name, &integers[..]) {
            (b"crease", chain) => {
                // An edge has two ends.
                let edge = |&[a, b]: &[u32; 2]| if a == b { [a, ABSENT] } else { [a, b] };
                self.sharpen(chain.array_windows().map(edge), &numbers)?;
            }
            (b"corner", points) => self.sharpen(points.iter().map(|&point| [point; 2]), &numbers)?,
            (b"hole", faces) => self.holes.extend(faces),
            (b"interpolateboundary", [1]) => self.boundary = Some(Boundary::EdgesAndCorners),
            (b"interpolateboundary", [2]) => self.boundary = Some(Boundary::Edges),
            (b"facevaryinginterpolateboundary", [rule]) => {
                self.face_varying = Some(*FaceVarying::ALL.get(*rule as usize)?);
            }
            _ => return None,
        }
        Some(())
    }

    fn sharpen(&mut self, places: impl ExactSizeIterator<Item = [u32; 2]>, sharpness: &[f32]) -> Option<()> {
        let is_known = sharpness.len() == 1 || sharpness.len() == places.len();
        is_known.then(|| self.sharp.extend(places.zip(sharpness.iter().copied().cycle())))
    }

    /// Says all but the holes to the cage of so many faces, if there is one, and what was left out to its notes.
    pub(super) fn apply(&self, builder: &mut FaceBuilder, positions: &ChunkedVec<Vec3>, faces: usize) {
        let Some(cage) = &mut builder.cage else { return };
        cage.held += self.held;
        let mut flaws = self.flaws;
        let end = |vertex: u32| positions.get(vertex as usize).map(|position| (*position, vertex));
        for &([a, b], sharpness) in &self.sharp {
            match end(a).zip(end(b)) {
                _ if !(0.0..=f32::INFINITY).contains(&sharpness) => flaws.dull += 1,
                Some((a, b)) => cage.sharpen([a, b], sharpness),
                None => flaws.absent += 1,
            }
        }
        flaws.absent += self.holes.iter().filter(|face| **face as usize >= faces).count();
        let own = &mut cage.subdivision;
        own.boundary = self.boundary.unwrap_or(own.boundary);
        own.face_varying = builder.import.subdivide_uvs.or(self.face_varying).unwrap_or_default();
        builder.notes.extend(flaws.sentences());
    }
}
