//! A logarithmic axis: the place of each value, and its ticks.

use std::ops::Range;

use geometry::numbers::grouped;
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};

/// A logarithmic axis. Places on it are logarithms to the base 10.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    low: f64,
    pub high: f64,
    /// The place of values that count as 0; none if there are no such values.
    zero: Option<f64>,
}

/// A marked place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick {
    pub place: f64,
    /// Whether the value is written beside the axis.
    pub named: bool,
}

/// How far axes go beyond the outermost values, and how far below them values that count as 0 are drawn, in decades.
const SLACK: f64 = 0.1;
const ZERO: f64 = 0.35;

impl Axis {
    /// An axis for these values. Those that aren't above `floor` count as 0.
    pub fn around(values: impl Iterator<Item = f64>, floor: f64) -> Self {
        let (mut low, mut high, mut has_zero) = (f64::INFINITY, f64::NEG_INFINITY, false);
        for value in values {
            if value > floor {
                (low, high) = (low.min(value.log10()), high.max(value.log10()));
            } else {
                has_zero = true;
            }
        }
        // Without values the axis still has a range.
        if low > high {
            (low, high) = (-1.0, 1.0);
        }
        let low = low - SLACK;
        Self { low, high: high + SLACK, zero: has_zero.then_some(low - ZERO) }
    }

    pub fn place(&self, value: f64) -> f64 {
        let log = value.log10();
        self.zero.filter(|_| log < self.low).unwrap_or(log)
    }

    pub fn start(&self) -> f64 {
        self.zero.map_or(self.low, |zero| zero - SLACK)
    }

    /// The ticks between two places. Powers of ten are named; on short axes, digits between them are named too.
    pub fn ticks(&self, [from, to]: [f64; 2]) -> Vec<Tick> {
        let from = from.max(self.low);
        let decades = to - from;
        let named: &[u32] = match decades {
            d if d > 2.2 => &[1],
            d if d > 0.9 => &[1, 2, 5],
            _ => &[1, 2, 3, 4, 5, 6, 8],
        };
        let mut ticks: Vec<_> = self.zero.map(|place| Tick { place, named: true }).into_iter().collect();
        for decade in from.floor() as i32..=to.ceil() as i32 {
            for digit in 1..10 {
                let place = f64::from(decade) + f64::from(digit).log10();
                if (from..=to).contains(&place) && (decades < 6.0 || digit == 1) {
                    ticks.push(Tick { place, named: named.contains(&digit) });
                }
            }
        }
        ticks
    }

    /// The value at a place as short text.
    pub fn text(&self, place: f64) -> String {
        let value = 10f64.powf(place);
        match value {
            _ if self.zero.is_some_and(|zero| place < zero + 1e-9) => "0".to_owned(),
            _ if value >= 0.999e6 => format!("{} M", grouped((value / 1e6).round() as u64)),
            _ if value >= 0.999 => grouped(value.round() as u64),
            _ => super::words::plain(value),
        }
    }
}

/// An axis of the plotting library, whose coordinates are the values.
impl Ranged for Axis {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (from, to): (i32, i32)) -> i32 {
        let along = (self.place(*value) - self.start()) / (self.high - self.start());
        from + (along * f64::from(to - from)).round() as i32
    }

    /// Named ticks are bold, and others are light.
    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        let is_named = !hint.weight().allow_light_points();
        let ticks = self.ticks([self.start(), self.high]).into_iter();
        ticks.filter(|tick| tick.named == is_named).map(|tick| 10f64.powf(tick.place)).collect()
    }

    fn range(&self) -> Range<f64> {
        10f64.powf(self.start())..10f64.powf(self.high)
    }
}
