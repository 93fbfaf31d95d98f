//! Pops: how far points of the surface jump on screen where one tessellation of a mesh takes the place of another.

use glam::Vec3;

use super::screen_error::Screen;
use super::sweep::Places;
use geometry::cores::in_ranges;
use geometry::tessellate::{LodView, Tessellated, Vertex};

/// The farthest jump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pop {
    pub px: f64,
    pub patch: u32,
    /// Where the point was before, in object units.
    pub at: Vec3,
}

/// Finds the farthest jump between two tessellations of a mesh, both seen in `view`; none if no point in view moved. Points are
/// compared where either tessellation has a vertex; patches that one of them left out are not.
pub fn farthest_pop(before: &Tessellated, after: &Tessellated, view: &LodView) -> Option<Pop> {
    let screen = Screen::new(view);
    let [old, new] = [before, after].map(emitted);
    let jump = |new: &Emitted| {
        let same = old.binary_search_by_key(&new.patch(), Emitted::patch).ok()?;
        new.jump_from(&old[same], &screen)
    };
    let found = in_ranges(new.len(), 1, |range| new[range].iter().filter_map(jump).reduce(Pop::farther));
    found.into_iter().flatten().reduce(Pop::farther)
}

impl Pop {
    pub(crate) fn farther(self, other: Self) -> Self {
        if other.px > self.px { other } else { self }
    }
}

/// What a patch emitted.
struct Emitted<'a> {
    vertices: &'a [Vertex],
    /// Indices into all vertices.
    triangles: &'a [[u32; 3]],
    /// The index of the first of its vertices.
    first: u32,
}

/// What each patch emitted, in the order of the patches.
fn emitted(all: &Tessellated) -> Vec<Emitted<'_>> {
    let patch = |triangle: &[u32; 3]| all.vertices[triangle[0] as usize].patch();
    let vertices = all.vertices.chunk_by(|a, b| a.patch() == b.patch());
    let triangles = all.triangles.chunk_by(|a, b| patch(a) == patch(b));
    let mut first = 0;
    let emitted = vertices.zip(triangles).map(|(vertices, triangles)| {
        let own = Emitted { vertices, triangles, first };
        first += vertices.len() as u32;
        own
    });
    emitted.collect()
}

impl Emitted<'_> {
    fn patch(&self) -> u32 {
        self.vertices[0].patch()
    }

    /// The farthest jump of a point since `old`, which the same patch emitted.
    fn jump_from(&self, old: &Self, screen: &Screen) -> Option<Pop> {
        if self.vertices == old.vertices {
            return None;
        }
        let domains = |own: &Self| own.vertices.iter().map(Vertex::domain).collect::<Vec<_>>();
        let own = |own: &Self| own.triangles.iter().map(|triangle| triangle.map(|i| i - own.first)).collect::<Vec<_>>();
        let [from, to] = [old, self].map(domains);
        let places = Places::new([&from[..], &to].concat());
        let [from, to] = [places.locate(&from, &own(old)), places.locate(&to, &own(self))];
        let jumps = from.into_iter().zip(to).filter_map(|(from, to)| {
            let (from, to) = (from?.position(old.vertices), to?.position(self.vertices));
            let px = screen.distance_px(from, to)?;
            Some(Pop { px, patch: self.patch(), at: from.as_vec3() })
        });
        jumps.filter(|jump| jump.px > 0.0).reduce(Pop::farther)
    }
}

#[cfg(test)]
mod tests {
    use super::super::sweep;
    use super::*;
    use crate::settings::Settings;
    use geometry::mesh::{Shape, Topology};
    use geometry::tessellate::{Partitioning, Surface, Tessellation, tessellate};
    use glam::{Mat4, Vec2};

    #[test]
    fn a_pop_is_as_long_as_the_jump_of_a_sweep_and_nothing_jumps_where_nothing_changes() {
        let mesh = Shape::CubeSmooth.build();
        let topology = Topology::new(&mesh);
        let view = LodView::new(Mat4::IDENTITY, Vec2::splat(100.0));
        let inputs = |factor| {
            let usual =
                Tessellation { surface: Surface::Pn, partitioning: Partitioning::Integer, ..Default::default() };
            Settings::from(usual.with_one_factor(factor)).inputs(view)
        };
        let [one, two, four] = [1.0, 2.0, 4.0].map(|factor| tessellate(&mesh, &topology, &inputs(factor), None));
        let pop = |before, after| farthest_pop(before, after, &view).map_or(0.0, |pop| pop.px);
        // The farthest is that of a diagonal's middle, at right angles to its face: across the view for some faces.
        let jump = sweep(&mesh, &topology, &inputs(1.0), 1.0..=2.0, 1.0).largest().expect("a step").jump;
        let px_per_unit = f64::from(view.half_viewport.x);
        assert!((pop(&one, &two) - jump * px_per_unit).abs() < 1e-3, "{} {jump}", pop(&one, &two));
        assert!(pop(&two, &four) > 0.0 && pop(&two, &four) < pop(&one, &two));
        assert_eq!(farthest_pop(&two, &two, &view), None);
        assert!((pop(&two, &one) - pop(&one, &two)).abs() < 1e-9, "it is as far back");
    }

    #[test]
    fn patches_that_one_tessellation_left_out_are_no_jump() {
        let mesh = Shape::Icosahedron.build();
        let topology = Topology::new(&mesh);
        let view = LodView::new(Mat4::IDENTITY, Vec2::splat(100.0));
        let inputs = Settings::from(Tessellation::default().with_one_factor(3.0)).inputs(view);
        let whole = tessellate(&mesh, &topology, &inputs, None);
        let mut part = whole.clone();
        part.triangles.retain(|triangle| whole.vertices[triangle[0] as usize].patch() != 4);
        let (first, kept) = (part.vertices.partition_point(|vertex| vertex.patch() < 4) as u32, whole.vertices.len());
        part.vertices.retain(|vertex| vertex.patch() != 4);
        let gone = (kept - part.vertices.len()) as u32;
        for index in part.triangles.iter_mut().flatten().filter(|index| **index >= first) {
            *index -= gone;
        }
        assert_eq!((farthest_pop(&whole, &part, &view), farthest_pop(&part, &whole, &view)), (None, None));
    }
}
