//! A logarithmic axis: the position of each value, and its ticks.

use geometry::numbers::grouped;

/// A logarithmic axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// The least and the greatest value.
    pub values: [f64; 2],
    /// Where the axis starts and ends, in px of the chart.
    pub px: [f64; 2],
    /// The space at the low end for values that count as 0, in px; 0 if there are none.
    pub zero_px: f64,
}

/// A marked value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick {
    pub value: f64,
    /// Whether the value is written beside the axis.
    pub named: bool,
}

/// By which factor the axis goes beyond the outermost values.
const SLACK: f64 = 1.25;

impl Axis {
    /// An axis that holds all values above `floor`. Smaller ones count as 0.
    pub fn around(values: impl Iterator<Item = f64>, floor: f64, px: [f64; 2]) -> Self {
        let (mut least, mut most, mut has_zero) = (f64::INFINITY, 0.0_f64, false);
        for value in values {
            if value > floor {
                (least, most) = (least.min(value), most.max(value));
            } else {
                has_zero = true;
            }
        }
        // Without values, the axis shows some range.
        let values = if most > 0.0 { [least / SLACK, most * SLACK] } else { [0.1, 10.0] };
        Self { values, px, zero_px: if has_zero { 22.0 } else { 0.0 } }
    }

    /// The position of a value in px. Values below the axis are at its zero.
    pub fn place(&self, value: f64) -> f64 {
        let [from, to] = self.px;
        let zero = from + self.zero_px * (to - from).signum();
        if value < self.values[0] {
            return from + 0.4 * (zero - from);
        }
        let [low, high] = self.values.map(f64::log10);
        zero + (value.log10() - low) / (high - low) * (to - zero)
    }

    /// The ticks. Powers of ten are named; on short axes, digits between them are named too.
    pub fn ticks(&self) -> Vec<Tick> {
        let [low, high] = self.values;
        let decades = (high / low).log10();
        let named: &[u32] = match decades {
            d if d > 2.2 => &[1],
            d if d > 0.9 => &[1, 2, 5],
            _ => &[1, 2, 3, 4, 5, 6, 8],
        };
        let mut ticks = Vec::new();
        for decade in low.log10().floor() as i32..=high.log10().ceil() as i32 {
            for digit in 1..10 {
                let value = f64::from(digit) * 10f64.powi(decade);
                if (low..=high).contains(&value) && (decades < 6.0 || digit == 1) {
                    ticks.push(Tick { value, named: named.contains(&digit) });
                }
            }
        }
        ticks
    }
}

/// A tick's value as short text.
pub fn tick_text(value: f64) -> String {
    if value >= 0.999e6 {
        format!("{} M", grouped((value / 1e6).round() as u64))
    } else if value >= 0.999 {
        grouped(value.round() as u64)
    } else {
        super::words::plain(value)
    }
}
