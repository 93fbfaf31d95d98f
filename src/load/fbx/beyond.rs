//! Curves that go on before their first key frame or after their last one: repeated, mirrored, or straight on.

use std::collections::HashMap;

use ufbx::{Anim, AnimCurve, Extrapolation, ExtrapolationMode};

/// The greatest number of samples of one range without key frames.
const MAX_SAMPLES: f64 = 65_536.0;
/// The longest clip whose length a file's own statement decides, in s.
const MAX_LENGTH: f64 = 86_400.0;

/// The part of a file's time that a clip shows, in s.
#[derive(Clone, Copy)]
pub(super) struct Span {
    pub begin: f64,
    pub end: f64,
}

impl Span {
    /// Returns what the clip itself says, or its key frames if it says nothing that can be.
    pub(super) fn new(anim: &Anim, key_times: [f64; 2]) -> Self {
        let Anim { time_begin: begin, time_end: end, .. } = *anim;
        let is_fit = begin < end && [begin, end].iter().all(|time| time.abs() <= MAX_LENGTH);
        if is_fit { Self { begin, end } } else { Self { begin: key_times[0].min(0.0), end: key_times[1] } }
    }
}

/// The curves of a clip, the part of them that it shows, and where they go on beyond their key frames.
pub(super) struct Curves<'a> {
    pub anim: &'a Anim,
    /// By an object's `element_id`, the time until which its curves go on from the clip's beginning, and the time from which they do
    /// until its end.
    edges: HashMap<u32, [Option<f64>; 2]>,
    pub span: Span,
    /// Samples per second.
    rate: f64,
    /// How many samples may still be taken in the whole file.
    pub left: usize,
}

impl<'a> Curves<'a> {
    pub(super) fn new(anim: &'a Anim, span: Span, rate: f64, left: usize) -> Self {
        let mut edges: HashMap<u32, [Option<f64>; 2]> = HashMap::new();
        for prop in anim.layers.into_iter().flat_map(|layer| &layer.anim_props) {
            for curve in prop.anim_value.curves.iter().flatten() {
                let [Some(first), Some(last)] = ends(curve) else { continue };
                let sides = [&curve.pre_extrapolation, &curve.post_extrapolation];
                // What goes on in the direction of an end isn't level even if all of its values are the same.
                let is_straight = sides.iter().any(|how| how.mode as u32 == ExtrapolationMode::Slope as u32);
                if curve.min_value == curve.max_value && !is_straight {
                    continue;
                }
                let [until, from] = edges.entry(prop.element.element_id).or_default();
                if goes_on(&curve.pre_extrapolation) && first > span.begin {
                    *until = Some(until.map_or(first, |time: f64| time.max(first)));
                }
                if goes_on(&curve.post_extrapolation) && last < span.end {
                    *from = Some(from.map_or(last, |time: f64| time.min(last)));
                }
            }
        }
        edges.retain(|_, edges| edges.iter().any(Option::is_some));
        Self { anim, edges, span, rate, left }
    }

    /// Returns the times in s at which an object is sampled beyond its key frames, in order; none if no curve of it goes on.
    #[expect(clippy::cast_possible_truncation, reason = "a whole number within limits")]
    pub(super) fn times(&mut self, element: u32) -> Vec<f64> {
        let Some([until, from]) = self.edges.get(&element).copied() else { return Vec::new() };
        let Span { begin, end } = self.span;
        let mut times = Vec::new();
        let ranges = [until.map(|until| [begin, until]), from.map(|from| [from, end])];
        for [begin, end] in ranges.into_iter().flatten() {
            let count = ((end - begin) * self.rate).ceil().clamp(1.0, MAX_SAMPLES) as usize;
            let count = count.min(self.left);
            self.left -= count;
            times.extend((0..=count).map(|i| begin + (end - begin) * i as f64 / count.max(1) as f64));
        }
        times
    }
}

/// The times of a curve's first and last key frame.
fn ends(curve: &AnimCurve) -> [Option<f64>; 2] {
    let keys = &curve.keyframes;
    [keys.first(), keys.last()].map(|key| key.map(|key| key.time))
}

fn goes_on(how: &Extrapolation) -> bool {
    how.mode as u32 != ExtrapolationMode::Constant as u32
}

/// Returns key frames within a span, in order: those there are, with samples between them, and with one at the beginning if the span
/// begins between two of them. Both are times with values.
pub(super) fn within<T: Copy>(
    keys: &[(f64, T)],
    samples: &[(f64, T)],
    span: Span,
    at: impl Fn(f64) -> T,
) -> Vec<(f64, T)> {
    if keys.is_empty() {
        return Vec::new();
    }
    let mut all = [keys, samples].concat();
    // A stable sort: of a key frame and a sample at the same time the key frame comes first.
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut start = all.partition_point(|key| key.0 < span.begin);
    if start > 0 && all.get(start).is_none_or(|key| key.0 > span.begin) {
        start -= 1;
        all[start] = (span.begin, at(span.begin));
    }
    all.split_off(start)
}
