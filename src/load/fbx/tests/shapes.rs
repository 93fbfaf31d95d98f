//! The weights of a channel's shapes.

use super::super::{morphs, parse};
use super::documents::morphed_square;
use super::tree::text;
use crate::import::Import;
use crate::memory_budget::Budget;
use geometry::progress::Progress;

#[test]
fn weights_are_linear_between_shapes_and_beyond_the_last() {
    let bytes = text(&morphed_square());
    let budget = Budget::new(bytes.len(), crate::Limits::default().memory);
    let scene = parse::scene(&bytes, &Import::default(), &budget, &Progress::new()).expect("a file without a fault");
    let channel = &scene.blend_channels[0];
    for (weight, expected) in [
        (0.0, [0.0, 0.0]),
        (0.25, [0.5, 0.0]),
        (0.5, [1.0, 0.0]),
        (0.75, [0.5, 0.5]),
        (1.0, [0.0, 1.0]),
        (1.25, [-0.5, 1.5]),
        (-0.5, [-1.0, 0.0]),
        (f64::NAN, [0.0, 0.0]),
    ] {
        let mut weights = vec![9.0];
        morphs::shape_weights(channel, weight, &mut weights);
        assert_eq!(weights, [9.0, expected[0], expected[1]], "at {weight}");
    }
}
