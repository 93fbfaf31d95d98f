//! What was mended while a mesh was made.

use serde::Serialize;

/// How many of the triangles' corners, as they were given, had to be mended: a vertex that six triangles use counts six
/// times.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Repairs {
    /// Corners without a normal, which got a smooth one.
    pub normals_made: u32,
    /// Corners whose normal was zero or not finite, which got a smooth one.
    pub normals_replaced: u32,
    /// Corners whose normal was brought to unit length.
    pub normals_rescaled: u32,
    /// Corners of which a coordinate was nearer to 0 than f32's least normal number, and is 0 now.
    pub denormals: u32,
}

impl Repairs {
    /// What people should know of, one sentence each. That normals were made is none of it: it may well be meant.
    pub fn warnings(&self) -> Vec<String> {
        let sentences = [
            (self.normals_replaced, "normals of no direction, replaced by ones that are smooth within 60 degrees"),
            (self.normals_rescaled, "normals whose length isn't 1, brought to it"),
            (self.denormals, "positions with coordinates too small for some devices (below 1.2e-38), set to 0"),
        ];
        let found = sentences.into_iter().filter(|(count, _)| *count > 0);
        found.map(|(count, sentence)| format!("{sentence}: {count}.")).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warnings_say_how_many() {
        assert!(Repairs { normals_made: 3, ..Repairs::default() }.warnings().is_empty());
        let all = Repairs { normals_made: 1, normals_replaced: 2, normals_rescaled: 3, denormals: 4 }.warnings();
        assert_eq!(all.len(), 3);
        assert!(all.iter().zip(2..).all(|(sentence, count)| sentence.ends_with(&format!(": {count}."))), "{all:?}");
    }
}
