//! Places labels beside points, as many as fit without covering each other.

/// A rectangle in px: its least and greatest coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rect {
    pub min: [f64; 2],
    pub max: [f64; 2],
}

/// A point that should have a label, and the label's size, in px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LabelRequest {
    pub at: [f64; 2],
    pub size: [f64; 2],
}

impl Rect {
    pub(super) fn around([x, y]: [f64; 2], half: f64) -> Self {
        Self { min: [x - half, y - half], max: [x + half, y + half] }
    }

    pub(super) fn overlaps(&self, other: &Self) -> bool {
        (0..2).all(|k| self.min[k] < other.max[k] && other.min[k] < self.max[k])
    }

    pub(super) fn contains(&self, other: &Self) -> bool {
        (0..2).all(|k| self.min[k] <= other.min[k] && other.max[k] <= self.max[k])
    }

    /// Whether a line from `a` to `b` crosses the rectangle.
    fn is_crossed(&self, a: [f64; 2], b: [f64; 2]) -> bool {
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for k in 0..2 {
            // Of a line along the other axis both are infinite, outside of the rectangle with the same sign.
            let along = b[k] - a[k];
            let [p, q] = [(self.min[k] - a[k]) / along, (self.max[k] - a[k]) / along];
            (enter, leave) = (enter.max(p.min(q)), leave.min(p.max(q)));
        }
        enter < leave
    }
}

/// The space between a point and its label, in px.
const GAP: f64 = 6.0;

/// Places labels inside `bounds` so that they cover no point, line or other label. Earlier labels have the first choice. A
/// label that fits nowhere gets `None`.
pub(super) fn place(
    wanted: &[LabelRequest],
    points: &[[f64; 2]],
    lines: &[[[f64; 2]; 2]],
    bounds: Rect,
) -> Vec<Option<Rect>> {
    let markers: Vec<Rect> = points.iter().map(|&point| Rect::around(point, 4.0)).collect();
    let mut placed: Vec<Option<Rect>> = Vec::new();
    for wish in wanted {
        let is_free = |rect: &Rect| {
            let taken = markers.iter().chain(placed.iter().flatten()).any(|other| rect.overlaps(other));
            bounds.contains(rect) && !taken && !lines.iter().any(|[a, b]| rect.is_crossed(*a, *b))
        };
        placed.push(places(wish).into_iter().find(is_free));
    }
    placed
}

/// The possible places of a label around its point, the best first.
fn places(&LabelRequest { at: [x, y], size: [width, height] }: &LabelRequest) -> [Rect; 8] {
    let slant = GAP * 0.6;
    let (left, middle, right) = (x - width, x - width / 2.0, x);
    let (above, level, below) = (y - height, y - height / 2.0, y);
    [
        [right + slant, above - slant],
        [left - slant, below + slant],
        [left - slant, above - slant],
        [right + slant, below + slant],
        [right + GAP, level],
        [left - GAP, level],
        [middle, above - GAP],
        [middle, below + GAP],
    ]
    .map(|min| Rect { min, max: [min[0] + width, min[1] + height] })
}
