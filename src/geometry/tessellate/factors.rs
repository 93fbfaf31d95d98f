//! Tessellation factors: from the numbers that a hull shader writes to the fixed-point words that the fixed-function
//! tessellator works with, and the numbers of points and triangles that they give.
//!
//! Everything here is integer arithmetic, on the bits of `f32` numbers too. So CPU and GPU agree to the last bit,
//! whatever the GPU's compiler assumes about NaN, infinity and denormals. Twin: `shaders/factors.wgsl`.
//!
//! Source: D3D11.3 Functional Specification, sections 10.10 and 11.7.3 to 11.7.14.

use bytemuck::{Pod, Zeroable};

use super::quotients::common_divisor;
use crate::choice::choices;

/// 1.0 in 16.16 fixed point.
pub const FIXED_ONE: u32 = 0x1_0000;
/// 0.5 in 16.16 fixed point.
pub const FIXED_HALF: u32 = 0x8000;
/// The bit of a factor's word that marks odd parity: a row with an odd number of segments.
pub const FACTOR_ODD: u32 = 0x8000_0000;

/// The bits of a factor's word that hold the factor, in 16.16 fixed point.
pub const FACTOR_VALUE: u32 = 0x7f_ffff;
/// The bit of an inside factor's word that marks a subtriangulated patch: see `subtriangulation.rs`.
pub const SUBTRIANGULATED: u32 = 0x4000_0000;
/// The bit of an inside factor's word that marks a patch of rows: see `rows.rs`. The factor is the rows' width, the two bits
/// from [`ROW_BASE_SHIFT`] on say which edge is the base, and the bit after them is 1 if diagonals are flipped.
pub const ROWS: u32 = 0x2000_0000;
pub const ROW_BASE_SHIFT: u32 = 24;
pub const ROW_FLIP_SHIFT: u32 = 26;

/// Under rows the inside factor is the width and this times 1, 2 or 3 if the base is the edge U == 0, V == 0 or W == 0; or times
/// 4, 5 or 6 if diagonals are flipped, too. Without that the factors of the edges choose the base.
pub const ROW_BASE_STEP: u32 = 256;
/// The most segments that an edge or a row has under rows. More would not fit what `quotients.rs` can divide.
pub const MOST_ROWS: u32 = 127;

/// Bit patterns of `f32` numbers. Those of positive numbers are in the order of the numbers; those of NaN and of
/// negative numbers are greater than all of them.
pub const BITS_ONE: u32 = 0x3f80_0000;
pub const BITS_TWO: u32 = 0x4000_0000;
pub const BITS_63: u32 = 0x427c_0000;
pub const BITS_64: u32 = 0x4280_0000;
/// [`MOST_ROWS`].
pub const BITS_127: u32 = 0x42fe_0000;
/// 1792, or 7 times [`ROW_BASE_STEP`], from which on inside factors under rows name no base.
pub const BITS_1792: u32 = 0x44e0_0000;
pub const BITS_INFINITY: u32 = 0x7f80_0000;
/// 1 + 2^-17, the largest edge factor that rounds to 1 in fixed point.
pub const BITS_ONE_AND_HALF_STEP: u32 = 0x3f80_0040;
/// 1 + 2^-16, the next factor after 1 in fixed point.
pub const BITS_ONE_AND_STEP: u32 = 0x3f80_0080;

choices! {
    /// How a factor between two whole numbers becomes segments.
    #[derive(Default, Hash)]
    #[repr(u32)]
    pub enum Partitioning {
        #[default]
        Integer => "integer", "Integer",
            "Rounds factors up to whole numbers. All segments of an edge have the same length, and the pattern changes \
             in steps (Direct3D 11.3, section 11.7).";
        Pow2 => "pow2", "Power of two",
            "Rounds factors up to 1, 2, 4, 8, 16, 32 or 64, so that segments are only ever halved (Direct3D 11.3, \
             section 11.7).";
        FractionalOdd => "fractional-odd", "Fractional odd",
            "An odd number of segments, two of which grow from nothing, so that the pattern never jumps (Direct3D 11.3, \
             section 11.7).";
        FractionalEven => "fractional-even", "Fractional even",
            "An even number of segments, at least 2, two of which grow from nothing, so that the pattern never jumps \
             (Direct3D 11.3, section 11.7).";
        Subtriangulation => "subtriangulation", "Subtriangulation",
            "Rounds the factor up to n and cuts every patch into n x n equal triangles (Vlachos et al. 2001, figure 4, \
             where this is level of detail n - 1). Direct3D doesn't have it. All edges have the same factor, so that LOD \
             is uniform.";
        Rows => "rows", "Rows",
            "Rounds factors up to whole numbers and cuts every patch into strips beside one of its edges. LOD by error \
             takes about 0.6 times the triangles that Direct3D's patterns need. Hardware tessellators can't make it; \
             compute and mesh shaders can.";
    }
}

impl Partitioning {
    /// Whether all edges have the same number of segments, so that LOD is uniform.
    pub fn has_one_factor(self) -> bool {
        self == Self::Subtriangulation
    }

    /// Whether patches are cut into rows.
    pub fn has_rows(self) -> bool {
        self == Self::Rows
    }

    /// Whether segments grow from nothing, so that the pattern never jumps.
    pub fn is_fractional(self) -> bool {
        matches!(self, Self::FractionalOdd | Self::FractionalEven)
    }

    /// Whether an edge may have this number of segments: up to 64 as Direct3D has them, and in rows more.
    pub fn has_segments(self, segments: u32) -> bool {
        match self {
            Self::Integer | Self::Subtriangulation | Self::Rows => segments > 0,
            Self::Pow2 => segments.is_power_of_two(),
            Self::FractionalOdd => segments % 2 == 1,
            Self::FractionalEven => segments > 0 && segments.is_multiple_of(2),
        }
    }

    /// Itself, or integer where that has the same patterns but a factor for each edge.
    pub fn with_factors_of_edges(self) -> Self {
        if self.has_one_factor() { Self::Integer } else { self }
    }

    /// Returns the factor that reaches the tessellator: under pow2 a hull shader rounds it up to a power of two.
    pub fn hull_factor(self, factor: f32) -> f32 {
        if self == Self::Pow2 { round_pow2(factor) } else { factor }
    }

    /// Those that Direct3D 11's tessellator has, which give every edge a factor of its own.
    pub const DIRECT3D: [Self; 4] = [Self::Integer, Self::Pow2, Self::FractionalOdd, Self::FractionalEven];
}

/// A patch's factors as the tessellator uses them. Each word is a factor of 1 to 64 (of rows 127) in 16.16 fixed point, clamped and
/// rounded, with bit 31 set if its parity is odd.
///
/// In a culled patch the edges' words are 0, and the inside's word says why (see `cull.rs`): 0 if its own factors cull
/// it. In a subtriangulated patch all four are the same number, and the inside's word has bit 30 set. In a patch of rows it
/// has bit 29 set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Pod, Zeroable)]
#[repr(C)]
pub struct PatchFactors {
    /// The words of the edges U == 0, V == 0 and W == 0.
    pub outside: [u32; 3],
    /// The word of the inside.
    pub inside: u32,
}

/// Returns whether an `f32` with these bits is greater than zero. Denormals are; NaN isn't.
pub(super) fn positive_bits(bits: u32) -> bool {
    bits.wrapping_sub(1) < BITS_INFINITY
}

/// Returns the smallest factor of a partitioning, as `f32` bits.
pub(super) fn factor_lower_bound(partitioning: Partitioning) -> u32 {
    if partitioning == Partitioning::FractionalEven { BITS_TWO } else { BITS_ONE }
}

/// Returns the largest factor of a partitioning, as `f32` bits.
pub(super) fn factor_upper_bound(partitioning: Partitioning) -> u32 {
    match partitioning {
        Partitioning::FractionalOdd => BITS_63,
        Partitioning::Rows => BITS_127,
        _ => BITS_64,
    }
}

/// Returns the largest factor of a partitioning.
pub fn last_factor(partitioning: Partitioning) -> f32 {
    f32::from_bits(factor_upper_bound(partitioning))
}

/// Returns the word of a factor of at least 1, given as `f32` bits. The factor is rounded up to a whole number or, in the
/// fractional partitionings, to the nearest 1/65536 with ties to even. Its parity is that of the partitioning, or of
/// the whole number.
pub(super) fn factor_word(partitioning: Partitioning, bits: u32) -> u32 {
    let exponent = (bits >> 23) - 127;
    let mantissa = (bits & 0x7f_ffff) | 0x80_0000;
    if !partitioning.is_fractional() {
        let shift = 23 - exponent;
        let whole = (mantissa + (1 << shift) - 1) >> shift;
        return (whole << 16) | (whole << 31);
    }
    let shift = 7 - exponent;
    let tie_to_even = (mantissa >> shift) & 1;
    let fixed = (mantissa + (1 << (shift - 1)) - 1 + tie_to_even) >> shift;
    fixed | if partitioning == Partitioning::FractionalOdd { FACTOR_ODD } else { 0 }
}

/// Returns the word of an inside factor: as [`factor_word`], but a whole 1 counts as even, since it acts as 2.
pub(super) fn inside_word(partitioning: Partitioning, bits: u32) -> u32 {
    let word = factor_word(partitioning, bits);
    let even_one = partitioning != Partitioning::FractionalOdd && word == (FACTOR_ODD | FIXED_ONE);
    if even_one { FIXED_ONE } else { word }
}

/// Returns what the tessellator makes of a patch's factors (sections 11.7.3 to 11.7.10). `edges` are the factors of the
/// edges U == 0, V == 0 and W == 0.
///
/// The patch is culled if an edge's factor isn't greater than zero. Factors are clamped to what the partitioning allows
/// and rounded to fixed point. The inside factor never culls: NaN and too small numbers act as the smallest factor.
/// Under subtriangulation the largest edge factor is used for everything, and the inside factor is ignored.
pub fn process(partitioning: Partitioning, edges: [f32; 3], inside: f32) -> PatchFactors {
    let bits = edges.map(f32::to_bits);
    if !(positive_bits(bits[0]) && positive_bits(bits[1]) && positive_bits(bits[2])) {
        return PatchFactors::default();
    }
    let low = factor_lower_bound(partitioning);
    let high = factor_upper_bound(partitioning);
    let clamped = bits.map(|b| b.clamp(low, high));

    let largest = clamped[0].max(clamped[1]).max(clamped[2]);
    if partitioning.has_one_factor() {
        let word = factor_word(partitioning, largest);
        return PatchFactors { outside: [word; 3], inside: word | SUBTRIANGULATED };
    }
    if partitioning.has_rows() {
        return process_rows(clamped.map(|b| factor_word(partitioning, b)), inside.to_bits());
    }
    // An odd patch with a divided edge needs a ring inside, though it may have collapsed to a point.
    let splits = partitioning == Partitioning::FractionalOdd && largest > BITS_ONE_AND_HALF_STEP;
    let inside_low = if splits { BITS_ONE_AND_STEP } else { low };
    let inside_bits = if positive_bits(inside.to_bits()) { inside.to_bits() } else { 0 };
    PatchFactors {
        outside: clamped.map(|b| factor_word(partitioning, b)),
        inside: inside_word(partitioning, inside_bits.clamp(inside_low, high)),
    }
}

/// Returns what becomes of the words of a patch's edges and its inside factor under rows. The smallest width is 1, and the
/// largest [`MOST_ROWS`].
fn process_rows(outside: [u32; 3], inside: u32) -> PatchFactors {
    let positive = if positive_bits(inside) { inside.max(BITS_ONE) } else { BITS_ONE };
    let rounded = factor_word(Partitioning::Rows, positive.min(BITS_1792)) >> 16 & 0x7fff;
    let (mut step, mut width) = (rounded / ROW_BASE_STEP, (rounded % ROW_BASE_STEP).clamp(1, MOST_ROWS));
    if step > 6 {
        (step, width) = (0, MOST_ROWS);
    }
    let base = if step == 0 { base_by_edges(outside) } else { (step - 1) % 3 };
    let chosen = base << ROW_BASE_SHIFT | u32::from(step > 3) << ROW_FLIP_SHIFT;
    PatchFactors { outside, inside: width << 16 | width << 31 | ROWS | chosen }
}

/// Returns which edge is the base of rows if nothing else says so: the one whose neighbours have the most similar numbers of
/// segments, so that the fewest rows share points; of several the one with the fewest segments, or the first.
pub(crate) fn base_by_edges(outside: [u32; 3]) -> u32 {
    let [u, v, w] = outside.map(segments);
    // Numbers of segments are below 128.
    let unlike = [v.abs_diff(w) * 128 + u, w.abs_diff(u) * 128 + v, u.abs_diff(v) * 128 + w];
    let least = unlike[0].min(unlike[1]).min(unlike[2]);
    u32::from(unlike[0] != least) + u32::from(unlike[0] != least && unlike[1] != least)
}

/// Returns the factor of the edge that `base_by_edges` makes the base: the rows then widen to what the base has.
pub fn base_factor(edges: [f32; 3]) -> f32 {
    let factors = process(Partitioning::Rows, edges, 1.0);
    if patch_is_culled(factors) { edges[0] } else { edges[row_base(factors) as usize] }
}

/// Returns the factor that a shader compiler passes to the tessellator under pow2: clamped to 1 to 64, then rounded up
/// to a power of two. Factors that cull a patch (NaN, zero, negative numbers) are returned unchanged.
pub fn round_pow2(factor: f32) -> f32 {
    let bits = factor.to_bits();
    if !positive_bits(bits) {
        return factor;
    }
    let clamped = bits.clamp(BITS_ONE, BITS_64);
    // The sum carries from the mantissa into the exponent.
    f32::from_bits((clamped + 0x7f_ffff) & 0x7f80_0000)
}

/// Returns whether the patch is culled: it has no points and no triangles.
pub fn patch_is_culled(factors: PatchFactors) -> bool {
    factors.outside[0] == 0
}

/// Returns whether the patch is cut by uniform subtriangulation instead of Direct3D's tessellator.
pub fn patch_is_subtriangulated(factors: PatchFactors) -> bool {
    !patch_is_culled(factors) && factors.inside & SUBTRIANGULATED != 0
}

/// Returns whether the patch is cut into rows.
pub fn patch_has_rows(factors: PatchFactors) -> bool {
    !patch_is_culled(factors) && factors.inside & ROWS != 0
}

/// Returns which edge is the base of a patch's rows: 0, 1 or 2 for U == 0, V == 0 or W == 0.
pub fn row_base(factors: PatchFactors) -> u32 {
    factors.inside >> ROW_BASE_SHIFT & 3
}

/// Returns 1 if the diagonals of a patch's rows are flipped, else 0.
pub fn row_flip(factors: PatchFactors) -> u32 {
    factors.inside >> ROW_FLIP_SHIFT & 1
}

/// Returns the number of rows of a patch: the larger number of segments of the edges beside the base.
pub fn row_count(factors: PatchFactors) -> u32 {
    let [u, v, w] = factors.outside.map(segments);
    match row_base(factors) {
        0 => v.max(w),
        1 => w.max(u),
        _ => u.max(v),
    }
}

/// Returns the number of segments to which a patch's rows widen.
pub(crate) fn row_width(factors: PatchFactors) -> u32 {
    (factors.inside & FACTOR_VALUE) >> 16
}

/// Returns the inside factor in 16.16 fixed point, which says how far apart points inside are; of rows the lesser of their number
/// and their width.
pub(crate) fn inside_value(factors: PatchFactors) -> u32 {
    let width = factors.inside & FACTOR_VALUE;
    if patch_has_rows(factors) { width.min(row_count(factors) << 16) } else { width }
}

/// Returns the number of points inside a patch with so many rows of some width. `divisor` is the [`common_divisor`] of both.
///
/// Rows j and n - j together have one segment more than the width; one less where both are whole without rounding, which are
/// `divisor - 1` rows. Each row has one point less than segments.
pub(super) fn points_in_rows(rows: u32, width: u32, divisor: u32) -> u32 {
    ((rows - 1) * (width - 1) + 1 - divisor) >> 1
}

/// Returns the number of points inside a patch of rows.
fn row_points(factors: PatchFactors) -> u32 {
    let (rows, width) = (row_count(factors), row_width(factors));
    points_in_rows(rows, width, common_divisor(rows, width))
}

/// Returns whether all factors are 1, so that the patch is one triangle.
pub(crate) fn patch_is_minimal(factors: PatchFactors) -> bool {
    let edges_are_one = factors.outside == [FACTOR_ODD | FIXED_ONE; 3];
    edges_are_one && (factors.inside & FACTOR_VALUE) == FIXED_ONE
}

/// Returns whether the patch is drawn and all its factors are below 2: without tessellation it would look nearly the
/// same.
pub fn patch_is_low(factors: PatchFactors) -> bool {
    let low = |word: u32| word & FACTOR_VALUE < 2 * FIXED_ONE;
    !patch_is_culled(factors) && factors.outside.into_iter().all(low) && low(factors.inside)
}

/// Returns 1 if the word's parity is odd, else 0.
pub(crate) fn odd_parity(word: u32) -> u32 {
    word >> 31
}

/// Returns the number of segments from an end of a row to its middle, in 16.16 fixed point. The fraction is how far the
/// newest segment has grown. The middle segment of an odd row counts as a whole one.
pub(crate) fn half_factor(word: u32) -> u32 {
    let half = ((word & FACTOR_VALUE) + 1) >> 1;
    let rounds_up = odd_parity(word) == 1 || half == FIXED_HALF;
    if rounds_up { half + FIXED_HALF } else { half }
}

/// Returns [`half_factor`] rounded up: the segments of half a row, with the middle one of an odd row.
pub(crate) fn half_segments(word: u32) -> u32 {
    (half_factor(word) + (FIXED_ONE - 1)) >> 16
}

/// Returns the number of segments of an edge: one less than its points.
pub fn segments(word: u32) -> u32 {
    2 * half_segments(word) - odd_parity(word)
}

/// Returns the number of segments inside: at least 3 if odd, at least 2 if even.
pub(crate) fn inside_segments(word: u32) -> u32 {
    segments(word).max(2 + odd_parity(word))
}

/// Returns the number of points on the patch's outline.
pub fn outer_count(factors: PatchFactors) -> u32 {
    segments(factors.outside[0]) + segments(factors.outside[1]) + segments(factors.outside[2])
}

/// Returns the number of domain points of the patch.
pub fn point_count(factors: PatchFactors) -> u32 {
    if patch_is_culled(factors) {
        return 0;
    }
    if patch_is_minimal(factors) {
        return 3;
    }
    if patch_is_subtriangulated(factors) {
        let n = segments(factors.inside);
        return ((n + 1) * (n + 2)) >> 1;
    }
    if patch_has_rows(factors) {
        return outer_count(factors) + row_points(factors);
    }
    // With R = (n - 1) / 2 rounded down, the rings inside have 3 R^2 points if n is odd, and 3 R (R + 1) + 1 if it is even.
    let n = inside_segments(factors.inside);
    outer_count(factors) + ((3 * (n - 1) * (n - 1) + 1) >> 2)
}

/// Returns the number of triangles of the patch.
pub fn triangle_count(factors: PatchFactors) -> u32 {
    if patch_is_culled(factors) {
        return 0;
    }
    if patch_is_minimal(factors) {
        return 1;
    }
    if patch_is_subtriangulated(factors) {
        let n = segments(factors.inside);
        return n * n;
    }
    if patch_has_rows(factors) {
        // By Euler's formula.
        return outer_count(factors) + 2 * row_points(factors) - 2;
    }
    let inner = inside_segments(factors.inside) - 2;
    outer_count(factors) + 3 * inner + ((3 * inner * inner) >> 1)
}

#[cfg(test)]
mod tests;
