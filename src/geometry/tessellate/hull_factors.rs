//! The tessellation factors that a hull shader writes for a patch.

use bytemuck::{Pod, Zeroable};

use super::factors::{MOST_ROWS, ROW_BASE_STEP, last_factor};
use super::{Convention, Partitioning, PatchFactors, domain_side, factor_side, patch_is_culled, process};

/// A patch's tessellation factors before the tessellator clamps and rounds them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct HullFactors {
    /// TessFactor[0..2]. Which side each one is for depends on the [`Convention`].
    pub edges: [f32; 3],
    /// InsideTessFactor. Under rows it is the width, and [`ROW_BASE_STEP`] times 1, 2 or 3 more if the base is the edge of
    /// factor 0, 1 or 2; or times 4, 5 or 6 more if diagonals are flipped, too.
    pub inside: f32,
}

impl HullFactors {
    /// Orders the factors of sides 0, 1 and 2 as a convention writes them.
    pub fn from_sides(convention: Convention, sides: [f32; 3], inside: f32) -> Self {
        Self { edges: [0, 1, 2].map(|i| sides[factor_side(convention, i) as usize]), inside }
    }

    /// The factors that cut sides 0, 1 and 2 of a patch under a convention.
    pub fn cutting(self, convention: Convention) -> [f32; 3] {
        let mut sides = [0.0; 3];
        for i in 0..3 {
            sides[domain_side(convention, i) as usize] = self.edges[i as usize];
        }
        sides
    }

    /// Returns the factors as a shader compiler passes them to the tessellator: under pow2 they are rounded up to
    /// powers of two.
    pub fn rounded(self, partitioning: Partitioning) -> Self {
        let rounded = |factor| partitioning.hull_factor(factor);
        Self { edges: self.edges.map(rounded), inside: rounded(self.inside) }
    }

    /// Returns the clamped and rounded factors that the tessellator works with.
    pub fn process(self, partitioning: Partitioning) -> PatchFactors {
        process(partitioning, self.edges, self.inside)
    }

    /// Returns whether subtriangulation can use the factors: all four are equal, or they cull the patch.
    pub fn is_uniform(self) -> bool {
        self.culls() || self.edges.into_iter().all(|factor| factor == self.inside)
    }

    /// Returns whether the inside factor requests more segments than a partitioning has, as where LOD by error found none that is
    /// enough.
    pub fn inside_is_capped(self, partitioning: Partitioning) -> bool {
        self.inside % ROW_BASE_STEP as f32 > last_factor(partitioning)
    }

    /// Returns whether any factor requests more segments than a partitioning has.
    pub fn is_capped(self, partitioning: Partitioning) -> bool {
        self.inside_is_capped(partitioning) || self.edges.iter().any(|&factor| factor > last_factor(partitioning))
    }

    /// Returns whether the tessellator culls the patch: the factor of an edge isn't greater than zero.
    pub fn culls(self) -> bool {
        patch_is_culled(self.process(Partitioning::Integer))
    }
}

/// Returns the factors of a patch that has as many points and triangles as any: 127 rows of 127 segments.
pub fn largest_patch() -> PatchFactors {
    process(Partitioning::Rows, [MOST_ROWS as f32; 3], MOST_ROWS as f32)
}

/// What an inside factor says under rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RowChoice {
    /// The edge that is the base, and whether diagonals are flipped; `None` if the factors of the edges choose.
    pub base: Option<(u32, bool)>,
    /// The width, as it was written.
    pub width: f32,
}

impl RowChoice {
    /// Returns what an inside factor says.
    pub fn new(inside: f32) -> Self {
        let step = (inside / ROW_BASE_STEP as f32) as u32;
        match step {
            1..=6 => {
                let width = inside - (ROW_BASE_STEP * step) as f32;
                Self { base: Some(((step - 1) % 3, step > 3)), width }
            }
            _ => Self { base: None, width: inside },
        }
    }

    /// Returns the inside factor that says this.
    pub fn inside(self) -> f32 {
        self.base.map_or(self.width, |(base, flips)| {
            let step = base + if flips { 4 } else { 1 };
            self.width + (ROW_BASE_STEP * step) as f32
        })
    }
}

/// Returns an inside factor under rows whose base is an edge in the order of a convention, for one whose base is the edge
/// U == 0, V == 0 or W == 0 as LOD takes them: each is the edge opposite corner 0, 1 or 2.
pub(crate) fn inside_of_base(convention: Convention, inside: f32) -> f32 {
    let choice = RowChoice::new(inside);
    let Some((base, flips)) = choice.base else { return inside };
    let written = (0..3).find(|&i| factor_side(convention, i) == (base + 1) % 3);
    RowChoice { base: written.map(|written| (written, flips)), ..choice }.inside()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_of_sides_are_written_in_the_order_of_the_convention() {
        let edges = |convention| HullFactors::from_sides(convention, [10.0, 11.0, 12.0], 0.0).edges;
        assert_eq!(edges(Convention::D3d11), [11.0, 12.0, 10.0]);
        assert_eq!(edges(Convention::AmdPn), [12.0, 10.0, 11.0]);
        assert_eq!(edges(Convention::EdgeOrder), [10.0, 11.0, 12.0]);
        assert_eq!(edges(Convention::Rotated), [10.0, 11.0, 12.0]);
        assert_eq!(edges(Convention::Mirrored), [12.0, 11.0, 10.0]);
    }

    #[test]
    fn what_an_inside_factor_says_under_rows_reads_back_to_the_bit() {
        for (inside, base, width) in [
            (7.5, None, 7.5),
            (259.0, Some((0, false)), 3.0),
            (512.0 + 64.0, Some((1, false)), 64.0),
            (768.25, Some((2, false)), 0.25),
            (1024.1, Some((0, true)), 1024.1 - 1024.0),
            (1791.0, Some((2, true)), 255.0),
            (1792.0, None, 1792.0),
            (f32::INFINITY, None, f32::INFINITY),
            (-3.0, None, -3.0),
        ] {
            let choice = RowChoice { base, width };
            assert_eq!((RowChoice::new(inside), choice.inside()), (choice, inside));
        }
        assert!(RowChoice::new(f32::NAN).inside().is_nan());
        // D3d11 writes side 1 as factor 0; edge order writes it as factor 1.
        assert_eq!([Convention::D3d11, Convention::EdgeOrder].map(|own| inside_of_base(own, 259.0)), [259.0, 515.0]);
        assert_eq!([Convention::D3d11, Convention::EdgeOrder].map(|own| inside_of_base(own, 1027.0)), [1027.0, 1283.0]);
        assert_eq!(inside_of_base(Convention::EdgeOrder, 3.0), 3.0);
    }

    #[test]
    fn factors_are_uniform_if_all_are_equal_or_the_patch_is_culled() {
        let is_uniform = |edges, inside| HullFactors { edges, inside }.is_uniform();
        assert!(is_uniform([3.5; 3], 3.5) && is_uniform([f32::INFINITY; 3], f32::INFINITY));
        assert!(is_uniform([f32::NAN; 3], 2.0) && is_uniform([1.0, 0.0, 7.0], f32::NAN));
        assert!(!is_uniform([3.5, 3.5, 3.0], 3.5) && !is_uniform([2.0; 3], 3.0) && !is_uniform([2.0; 3], f32::NAN));
    }

    #[test]
    fn rounding_changes_nothing_about_culling() {
        for (factor, culls) in [(0.0, true), (-1.0, true), (f32::NAN, true), (0.3, false), (f32::INFINITY, false)] {
            for at in 0..3 {
                let mut given = HullFactors { edges: [2.0; 3], inside: f32::NAN };
                given.edges[at] = factor;
                assert_eq!((given.culls(), given.rounded(Partitioning::Pow2).culls()), (culls, culls), "{factor}");
            }
        }
        let given = HullFactors { edges: [3.0, 0.3, 70.0], inside: 5.0 };
        assert_eq!(given.rounded(Partitioning::Integer), given);
        let rounded = HullFactors { edges: [4.0, 1.0, 64.0], inside: 8.0 };
        assert_eq!(given.rounded(Partitioning::Pow2), rounded);
    }
}
