//! Finds the crack that is seen at a place of a picture.

use glam::{Vec2, Vec3};

use super::Measured;
use geometry::mesh::Topology;
use geometry::view::{ScreenView, project};

/// A place at which the emitted mesh is torn open, as a picture shows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenCrack {
    /// Index in [`Topology::edges`].
    pub edge: u32,
    /// The place on a side of the edge that comes closest to the place of the picture, in object units.
    pub at: Vec3,
    /// How far apart the two are on screen, in px.
    pub px: f32,
    /// How wide the crack is on screen, in px, where it is widest.
    pub gap_px: f32,
}

impl Measured {
    /// The crack that comes closest to a place of a picture, in px from its top left, whatever hides it. Where patches are out of
    /// view, the edges around the hole count as cracks. None if nothing before the eye is torn.
    pub fn crack_seen_at(&self, topology: &Topology, view: &ScreenView, px: Vec2) -> Option<SeenCrack> {
        let torn = self.cracks.edges.iter().filter(|crack| crack.gap > 0.0);
        let torn = torn.map(|crack| (crack.edge, crack.gap_px(view.clip_from_object, view.viewport) as f32));
        let around_holes = self.edges_around_holes(topology).map(|edge| (edge, 0.0));
        let seen = |(edge, gap_px): (u32, f32)| {
            let (at, px) = self.seen_on_edge(topology, edge, view, px)?;
            Some(SeenCrack { edge, at, px, gap_px })
        };
        torn.chain(around_holes).filter_map(seen).min_by(|a, b| a.px.total_cmp(&b.px))
    }

    /// The edges that some of their sides emitted nothing for, and others did.
    fn edges_around_holes(&self, topology: &Topology) -> impl Iterator<Item = u32> {
        // Patches that face away are emitted to look for leaks.
        let has_holes = self.culled.out_of_view > 0;
        let shared = has_holes.then(|| self.outlines.shared_edges(topology)).into_iter().flatten();
        shared.filter_map(move |(index, sides)| {
            let all = topology.edge_sides(&topology.edges[index as usize]).len();
            (!sides.is_empty() && sides.len() < all).then_some(index)
        })
    }

    /// The place on an edge's sides that comes closest to a place of a picture, in object units, and how far apart the two are, in
    /// px.
    fn seen_on_edge(&self, topology: &Topology, edge: u32, view: &ScreenView, px: Vec2) -> Option<(Vec3, f32)> {
        let on_screen = |place: Vec3| Some((place, project(view.clip_from_object, view.viewport, place)?));
        let mut closest: Option<(Vec3, f32)> = None;
        for side in self.outlines.edge(topology, edge) {
            let points: Vec<(Vec3, Vec2)> = side.positions().filter_map(on_screen).collect();
            for ends in points.windows(2) {
                let [(start, start_px), (end, end_px)] = [ends[0], ends[1]];
                let along = end_px - start_px;
                let t = (px - start_px).dot(along) / along.length_squared().max(f32::MIN_POSITIVE);
                let t = t.clamp(0.0, 1.0);
                let apart = px.distance(start_px + along * t);
                if closest.is_none_or(|(_, least)| apart < least) {
                    // Segments are short on screen, so that perspective hardly moves the place along them.
                    closest = Some((start.lerp(end, t), apart));
                }
            }
        }
        closest
    }
}

#[cfg(test)]
mod tests {
    use glam::{Mat4, vec2, vec3};

    use super::*;
    use crate::measure::RequestedFactors;
    use geometry::mesh::Shape;
    use geometry::tessellate::{Inputs, LodView, Surface, Tessellation, tessellate};

    #[test]
    fn the_torn_edge_that_comes_closest_on_screen_is_found() {
        let mesh = Shape::CubeSplit.build();
        let topology = Topology::new(&mesh);
        let found = |surface| {
            let tessellation = Tessellation { surface, factor: 4.0, ..Tessellation::default() };
            let inputs = Inputs::new(&tessellation, LodView::new(Mat4::IDENTITY, Vec2::ONE));
            let out = tessellate(&mesh, &topology, &inputs, None);
            let requested =
                RequestedFactors::new(tessellation.edges, tessellation.convention, out.edge_factors.clone());
            Measured::new(&mesh, &topology, requested, &out)
        };
        // The cube's corners are at 0.577 along each axis, 57.7 px from the middle of a picture that is seen along -Z.
        let view = ScreenView { clip_from_object: Mat4::from_scale(vec3(0.5, 0.5, 1.0)), viewport: vec2(400.0, 400.0) };
        let (torn, beside) = (found(Surface::Pn), vec2(264.0, 190.0));
        let seen = torn.crack_seen_at(&topology, &view, beside).expect("a crack");
        assert!(seen.at.x > 0.57 && (seen.at.y - 0.1).abs() < 0.05, "on the edge on the right: {seen:?}");
        assert!(torn.cracks.edges.iter().any(|crack| crack.edge == seen.edge && crack.gap > 0.0));
        assert!(seen.px < 8.0 && seen.gap_px > 1.0, "{seen:?}");
        assert_eq!(found(Surface::PnAen).crack_seen_at(&topology, &view, beside), None);
    }
}
