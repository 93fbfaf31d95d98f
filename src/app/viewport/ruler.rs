//! The distance between two places that are clicked on.

use glam::Vec3;

use crate::app::App;
use crate::app::text::short;
use geometry::view::seen_on_plane;
use inspect::render::{LineSegment, Picked, Pixel, outlined};
use inspect::settings::SplitSide;

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Ruler {
    /// The places that were clicked on, in object units. The second is none without the first.
    pub ends: [Option<Vec3>; 2],
}

impl Ruler {
    /// Takes a place: the first, the second, or the first of another distance.
    fn take(&mut self, place: Vec3) {
        self.ends = match self.ends {
            [Some(first), None] => [Some(first), Some(place)],
            _ => [Some(place), None],
        };
    }

    /// What to do next, or the distance.
    pub(crate) fn text(&self) -> String {
        match self.ends {
            [Some(a), Some(b)] => {
                let [x, y, z] = (b - a).abs().to_array().map(|length| short(length.into()));
                format!("Distance: {} units (x {x}, y {y}, z {z})", short(a.as_dvec3().distance(b.as_dvec3())))
            }
            [Some(_), None] => "Distance: click on the second place".to_owned(),
            _ => "Distance: click on two places of the mesh".to_owned(),
        }
    }
}

impl App {
    pub(in crate::app) fn ruler_lines(&self) -> Vec<LineSegment> {
        let Some(Ruler { ends }) = self.viewport.ruler else { return Vec::new() };
        let dots = ends.into_iter().flatten().map(|end| (end, end, 3.5));
        let between = ends[0].zip(ends[1]).into_iter().map(|(a, b)| (a, b, 1.0));
        outlined(&between.chain(dots).collect::<Vec<_>>(), [255; 3], 1.0)
    }

    /// Takes the place that was found at a pixel. Returns whether the ruler is in use.
    pub(in crate::app) fn measure_to(&mut self, half: SplitSide, pixel: &Pixel, found: Option<&Picked>) -> bool {
        let (Some(ruler), Some(document)) = (&mut self.viewport.ruler, &self.document) else { return false };
        let corners = found.map(|picked| match picked.triangle {
            Some(triangle) => triangle.vertices.map(|vertex| Vec3::from(vertex.position)),
            None => document.patch_positions(half, picked.patch),
        });
        let (view, middle) = pixel.seen();
        let place = corners.and_then(|corners| seen_on_plane(&view, middle, corners));
        place.into_iter().for_each(|place| ruler.take(place));
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_third_place_begins_another_distance() {
        let mut ruler = Ruler::default();
        for place in [Vec3::ZERO, Vec3::new(3.0, -4.0, 0.0)] {
            ruler.take(place);
        }
        let [five, three, four, zero] = [5.0, 3.0, 4.0, 0.0].map(short);
        assert_eq!(ruler.text(), format!("Distance: {five} units (x {three}, y {four}, z {zero})"));
        ruler.take(Vec3::X);
        assert_eq!(ruler.ends, [Some(Vec3::X), None]);
    }
}
