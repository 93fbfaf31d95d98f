//! Usual mistakes in the control points of a patch: each makes another control net of ours.

use glam::Vec3;

use geometry::tessellate::{ControlNet, center_control_point};

/// A mistake in control points. E is the mean of a patch's edge control points, and V that of its corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NetMistake {
    /// The one in the middle is E + x (E - V) with this x, and not with 1/2.
    Center(f32),
    /// Those of edges lie beside this share of their edge, and this many times as far from it as ours.
    Edges { share: f32, bend: f32 },
    /// Those of edges are ours times this.
    Times(f32),
    /// Those of edges near the start and near the end of every side are exchanged.
    Swapped,
    /// Of those of edges this one and the next around the patch are exchanged, in the order of [`EDGE_NAMES`].
    Exchanged(usize),
}

/// The names of a patch's edge control points, in their order around it.
pub(super) const EDGE_NAMES: [&str; 6] = ["b210", "b120", "b021", "b012", "b102", "b201"];

/// 1/3, where a cubic edge has its first control point.
pub(super) const THIRD: f32 = 1.0 / 3.0;

impl NetMistake {
    /// Those without a number that must be found, the simplest first.
    pub(super) fn usual() -> impl Iterator<Item = Self> {
        let centers = [0.0, -1.0, 1.0, -0.5].map(Self::Center);
        let edges = [[0.5, 1.5], [2.0 * THIRD, 1.0], [THIRD, -1.0], [THIRD, 0.0], [THIRD, 3.0], [THIRD, 1.5]];
        let edges = edges.map(|[share, bend]| Self::Edges { share, bend });
        let others = [Self::Times(1.5), Self::Times(3.0), Self::Swapped];
        centers.into_iter().chain(edges).chain(others).chain((0..6).map(Self::Exchanged))
    }

    /// Returns the net that has the mistake.
    pub(super) fn apply(self, net: ControlNet) -> ControlNet {
        let (corners, mut edges) = (net.corners, net.edges);
        match self {
            Self::Center(x) => {
                let mean = |points: &[Vec3]| points.iter().sum::<Vec3>() / points.len() as f32;
                let (e, v) = (mean(&edges), mean(&corners));
                return ControlNet { center: e + (e - v) * x, ..net };
            }
            Self::Edges { share, bend } => {
                for (k, edge) in edges.iter_mut().enumerate() {
                    let side = k / 2;
                    let [start, end] = [corners[side], corners[(side + 1) % 3]];
                    let [near, far] = if k.is_multiple_of(2) { [start, end] } else { [end, start] };
                    let beside = *edge - near.lerp(far, THIRD);
                    *edge = near.lerp(far, share) + beside * bend;
                }
            }
            Self::Times(times) => edges.iter_mut().for_each(|edge| *edge *= times),
            Self::Swapped => (0..3).for_each(|side| edges.swap(2 * side, 2 * side + 1)),
            Self::Exchanged(first) => edges.swap(first, (first + 1) % 6),
        }
        ControlNet { corners, edges, center: center_control_point(corners, edges) }
    }

    /// What it is, and what to look at: a sentence's end, and another sentence.
    pub(super) fn text(self) -> [String; 2] {
        let center = "Look at how b111 is computed.".to_owned();
        let look = |text: &str| format!("Look {text}.");
        match self {
            Self::Center(0.0) => {
                ["whose middle control point is E alone, the mean of the edges' control points".into(), center]
            }
            Self::Center(-1.0) => ["whose middle control point is V, the mean of the corners".into(), center],
            Self::Center(x) => {
                [format!("whose middle control point is E + {x} (E - V), and not E + 1/2 (E - V)"), center]
            }
            Self::Edges { share: 0.5, .. } => [
                "whose edge control points lie at 1/2 of the edge, and not at 1/3".into(),
                look("whether (2 P1 + P2 - w N) / 3 has become (P1 + P2 - w N) / 2"),
            ],
            Self::Edges { share, .. } if share != THIRD => [
                "whose edge control points lie at 2/3 of the edge, and not at 1/3".into(),
                look("at the weights of P1 and P2 in (2 P1 + P2 - w N) / 3: they are exchanged"),
            ],
            Self::Edges { bend: -1.0, .. } => [
                "whose edge control points lie on the other side of the edge".into(),
                look("at the sign of w N in (2 P1 + P2 - w N) / 3, where w is (P2 - P1) . N"),
            ],
            Self::Edges { bend: 0.0, .. } => [
                "whose edges are straight".into(),
                look(
                    "whether w N reaches (2 P1 + P2 - w N) / 3, and whether normals are 0 or perpendicular to the edges",
                ),
            ],
            Self::Edges { bend: 3.0, .. } => [
                "whose edge control points lie 3 times as far beside the edge".into(),
                look("whether all of (2 P1 + P2 - w N) is divided by 3, and not 2 P1 + P2 alone"),
            ],
            Self::Edges { bend, .. } => [
                format!(
                    "whose edge control points lie {bend:.3} times as far beside the edge, as with normals of length {:.3}",
                    bend.max(0.0).sqrt()
                ),
                look("whether normals have length 1 where control points are computed"),
            ],
            Self::Times(times) => [
                format!("whose edge control points are {times} times ours"),
                look("at what the sum (2 P1 + P2 - w N) is divided by: it must be 3"),
            ],
            Self::Swapped => [
                "whose control points near the start and near the end of every side are exchanged".into(),
                look("at their order in the hull shader and in the domain shader"),
            ],
            Self::Exchanged(first) => [
                format!("whose control points {} and {} are exchanged", EDGE_NAMES[first], EDGE_NAMES[(first + 1) % 6]),
                look("at their order in the hull shader and in the domain shader"),
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;

    fn net() -> ControlNet {
        let corners = [Vec3::ZERO, vec3(3.0, 0.0, 0.0), vec3(0.0, 3.0, 0.0)];
        let edges = [[1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 2.0], [0.0, 2.0], [0.0, 1.0]];
        let edges = edges.map(|[x, y]| vec3(x, y, 0.6));
        ControlNet { corners, edges, center: center_control_point(corners, edges) }
    }

    #[test]
    fn mistakes_make_the_nets_that_they_say() {
        assert!(NetMistake::Center(0.5).apply(net()).center.distance(net().center) < 1e-6);
        assert!(NetMistake::Center(-1.0).apply(net()).center.distance(vec3(1.0, 1.0, 0.0)) < 1e-6);
        let half = NetMistake::Edges { share: 0.5, bend: 1.5 }.apply(net());
        assert!(half.edges[0].distance(vec3(1.5, 0.0, 0.9)) < 1e-6 && half.edges[1].distance(half.edges[0]) < 1e-6);
        let weights = NetMistake::Edges { share: 2.0 * THIRD, bend: 1.0 }.apply(net());
        assert!(weights.edges[0].distance(vec3(2.0, 0.0, 0.6)) < 1e-6, "{}", weights.edges[0]);
        let exchanged = NetMistake::Exchanged(5).apply(net());
        assert_eq!([exchanged.edges[5], exchanged.edges[0]], [net().edges[0], net().edges[5]]);
        assert_eq!(NetMistake::Swapped.apply(net()).edges[2], net().edges[3]);
    }
}
