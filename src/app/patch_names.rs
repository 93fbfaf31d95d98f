//! The names of a patch's corners, weights, edges and factors under a convention.

use geometry::tessellate::{Convention, domain_side, factor_side, weight_corner};

pub(super) const LETTERS: [char; 3] = ['u', 'v', 'w'];

/// The weight that is 1 on corner `k`.
pub(super) fn letter(convention: Convention, k: u32) -> char {
    let found = (0..3).find(|&i| weight_corner(convention, i) == k);
    found.map_or(' ', |i| LETTERS[i as usize])
}

/// The name of a side: the corners that it runs between.
pub(super) fn ends_text(k: u32) -> String {
    format!("{k}-{}", (k + 1) % 3)
}

/// Says what goes wrong with factor `i` under a wrong convention.
pub(super) fn mistake(convention: Convention, i: u32) -> Option<String> {
    let (of, cuts) = (factor_side(convention, i), domain_side(convention, i));
    (of != cuts)
        .then(|| format!("TessFactor[{i}] is computed for edge {} but cuts edge {}.", ends_text(of), ends_text(cuts)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_convention_is_explained_with_both_edges() {
        for right in [Convention::D3d11, Convention::AmdPn, Convention::EdgeOrder] {
            assert_eq!([0, 1, 2].map(|i| mistake(right, i)), [None, None, None], "{right:?}");
        }
        assert_eq!(
            mistake(Convention::Rotated, 0).as_deref(),
            Some("TessFactor[0] is computed for edge 0-1 but cuts edge 1-2.")
        );
        assert_eq!(mistake(Convention::Mirrored, 2), None, "its third factor is right");
    }

    #[test]
    fn every_corner_has_its_weight() {
        let letters = |convention| [0, 1, 2].map(|k| letter(convention, k));
        assert_eq!(letters(Convention::D3d11), ['u', 'v', 'w']);
        assert_eq!(letters(Convention::AmdPn), ['w', 'u', 'v']);
        assert_eq!(letters(Convention::EdgeOrder), ['v', 'w', 'u']);
    }
}
