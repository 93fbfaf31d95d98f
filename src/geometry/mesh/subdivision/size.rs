//! How large a refinement becomes, in closed form.

use super::Scheme;

/// How many points, edges, faces and corners a cage or its refinement has. What doesn't fit into 64 bits is
/// [`u64::MAX`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    pub points: u64,
    pub edges: u64,
    pub faces: u64,
    /// Of all faces together.
    pub corners: u64,
}

impl Size {
    /// The size one level finer. Catmull and Clark 1978 divide each face into one for each of its corners, Loop 1987 and the
    /// butterfly scheme each triangle into four.
    #[must_use]
    pub fn refined(self, scheme: Scheme) -> Self {
        let Self { points, edges, faces, corners } = self;
        let (centers, faces) = match scheme {
            Scheme::CatmullClark => (faces, corners),
            Scheme::Loop | Scheme::Butterfly => (0, faces.saturating_mul(4)),
        };
        let points = points.saturating_add(edges).saturating_add(centers);
        let edges = edges.saturating_mul(2).saturating_add(corners);
        Self { points, edges, faces, corners: corners.saturating_mul(4) }
    }

    /// The size so many levels finer.
    #[must_use]
    pub fn after(self, levels: u8, scheme: Scheme) -> Self {
        (0..levels).fold(self, |size, _| size.refined(scheme))
    }

    /// The most memory that the connectivity of this level takes, in bytes.
    pub fn bytes(self) -> u64 {
        let sizes = [(self.corners, 12), (self.edges, 12), (self.points, 8), (self.faces, 4)];
        sizes.into_iter().fold(0, |sum: u64, (count, bytes)| sum.saturating_add(count.saturating_mul(bytes)))
    }

    /// Whether all of them can be numbered with 32 bits.
    pub(super) fn is_numbered(self) -> bool {
        self.points.max(self.edges).max(self.corners) < u64::from(u32::MAX)
    }
}
