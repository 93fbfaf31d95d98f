//! The outline of the triangles on screen, held against those of the source mesh and of the surface that the triangles
//! approximate.

use glam::{DVec2, dvec2};

use super::distance_transform::DistanceTransform;

/// What has an outline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum OutlineOf {
    /// What was emitted.
    Triangles,
    /// The mesh's own triangles.
    Source,
    /// The curved surface that was tessellated.
    Surface,
}

impl OutlineOf {
    pub(crate) const ALL: [Self; 3] = [Self::Triangles, Self::Source, Self::Surface];

    const fn bit(self) -> u8 {
        1 << self as u8
    }
}

/// How far the source mesh and the surface are known beyond the picture's border, in px: outlines that leave the picture at
/// different places are compared also there.
const MARGIN: u32 = 32;

/// Most samples of a grid with several samples a px.
const MOST_SAMPLES: u64 = 1 << 24;

/// The samples at which coverage is known: evenly spaced over a picture and its margin, in the middles of squares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SampleGrid {
    /// Width and height in px, without the margin.
    pub picture: [u32; 2],
    /// Samples along a side of a px.
    pub per_px: u32,
}

impl SampleGrid {
    /// The grid for a picture of this width and height in px, where a texture has at most `limit` texels along a side: two samples
    /// along a side of a px, or one for a large picture.
    pub fn new(picture: [u32; 2], limit: u32) -> Self {
        let fine = Self { picture, per_px: 2 };
        let [width, height] = fine.size();
        let fits = width.max(height) <= limit && u64::from(width) * u64::from(height) <= MOST_SAMPLES;
        if fits { fine } else { Self { per_px: 1, ..fine } }
    }

    /// Width and height of the picture with its margin, in px.
    pub fn padded(&self) -> [u32; 2] {
        self.picture.map(|side| side.saturating_add(2 * MARGIN))
    }

    /// Samples along the width and the height, with the margin.
    pub fn size(&self) -> [u32; 2] {
        self.padded().map(|side| side.saturating_mul(self.per_px))
    }

    /// Where a sample lies, in px from the picture's top left.
    fn place(&self, x: usize, y: usize) -> DVec2 {
        (dvec2(x as f64, y as f64) + 0.5) / f64::from(self.per_px) - f64::from(MARGIN)
    }

    /// The first and last samples along x and y that lie within a margin of the picture of so many px.
    fn within(&self, margin: u32) -> Area {
        let least = (MARGIN - margin) * self.per_px;
        let most = self.size().map(|side| (side - 1).saturating_sub(least) as usize);
        Area { least: [least as usize; 2], most }
    }
}

/// A rectangle of samples, with its first and last ones along x and y.
#[derive(Clone, Copy)]
struct Area {
    least: [usize; 2],
    most: [usize; 2],
}

impl Area {
    fn has(&self, at: [usize; 2]) -> bool {
        (0..2).all(|axis| (self.least[axis]..=self.most[axis]).contains(&at[axis]))
    }

    /// How many samples one that lies inside is from the nearest border.
    fn border_distance(&self, at: [usize; 2]) -> u64 {
        let to = |axis: usize| (at[axis] - self.least[axis]).min(self.most[axis] - at[axis]);
        to(0).min(to(1)) as u64
    }
}

/// The largest distance between two outlines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutlineDistance {
    pub px: f64,
    /// The place on one of the outlines that is farthest from the other one, in px from the picture's top left.
    pub at: DVec2,
}

/// How far the triangles' outline is from the others; none where the picture doesn't show both outlines.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OutlineDistances {
    pub from_source: Option<OutlineDistance>,
    pub from_surface: Option<OutlineDistance>,
}

/// The outlines in a picture. An outline is the set of samples beside which lies one that is covered where they aren't, or the
/// reverse.
#[derive(Clone, Debug, PartialEq)]
pub struct Silhouette {
    pub grid: SampleGrid,
    pub distances: OutlineDistances,
    /// Which part of each px belongs to each outline, in the order of [`OutlineOf::ALL`], row by row: 0 to 1.
    pub lines: Vec<[f32; 3]>,
}

impl Silhouette {
    /// Compares outlines. `texels` has four bytes for each sample of the grid, row by row: the first three are above 0 where the
    /// triangles, the source mesh and the surface cover it. The triangles need to be known in the picture alone.
    pub fn find(grid: SampleGrid, texels: &[u8]) -> Self {
        let outlines = Outlines::find(grid, texels);
        let from = |other| outlines.distance(OutlineOf::Triangles, other);
        let distances =
            OutlineDistances { from_source: from(OutlineOf::Source), from_surface: from(OutlineOf::Surface) };
        Self { grid, distances, lines: outlines.lines() }
    }
}

/// The square of a distance in samples, and where a sample is along x and y.
type Sample = (u64, [usize; 2]);

/// The outlines' samples.
struct Outlines {
    grid: SampleGrid,
    width: usize,
    height: usize,
    /// Bits of [`OutlineOf::bit`], row by row.
    samples: Vec<u8>,
}

impl Outlines {
    fn find(grid: SampleGrid, texels: &[u8]) -> Self {
        let [width, height] = grid.size().map(|side| side as usize);
        let bits = |texel: &[u8]| OutlineOf::ALL.map(|of| u8::from(texel[of as usize] > 0) * of.bit()).iter().sum();
        let covered: Vec<u8> = texels.chunks_exact(4).map(bits).collect();
        let mut found = Self { grid, width, height, samples: vec![0; covered.len()] };
        let picture = grid.within(0);
        for y in 0..height {
            for x in 0..width {
                let own = y * width + x;
                let right = (x + 1 < width).then_some(([x + 1, y], own + 1));
                let below = (y + 1 < height).then_some(([x, y + 1], own + width));
                for (at, other) in [right, below].into_iter().flatten() {
                    let mut differ = covered[own] ^ covered[other];
                    if differ != 0 && !(picture.has([x, y]) && picture.has(at)) {
                        differ &= !OutlineOf::Triangles.bit();
                    }
                    found.samples[own] |= differ;
                    found.samples[other] |= differ;
                }
            }
        }
        found
    }

    /// The largest distance between two outlines in the picture: the Hausdorff distance.
    fn distance(&self, a: OutlineOf, b: OutlineOf) -> Option<OutlineDistance> {
        let [to_a, to_b] = [a, b]
            .map(|of| DistanceTransform::new(self.width, self.height, |sample| self.samples[sample] & of.bit() != 0));
        let found = [self.farthest(a, b, &to_b)?, self.farthest(b, a, &to_a)?];
        let worst = found.into_iter().flatten().max_by_key(|(squared, _)| *squared);
        worst.map(|(squared, [x, y])| OutlineDistance {
            px: (squared as f64).sqrt() / f64::from(self.grid.per_px),
            at: self.grid.place(x, y),
        })
    }

    /// The sample of one outline in the picture that is farthest from another outline, with the square of its distance in samples.
    /// Inside it is none if the picture has nothing of the one, and it is none at all if there is nothing of the other.
    ///
    /// The other outline may go on where it isn't known, so no distance counts for more than that to the nearest such place.
    fn farthest(&self, of: OutlineOf, to: OutlineOf, transform: &DistanceTransform) -> Option<Option<Sample>> {
        let picture = self.grid.within(0);
        let known = if to == OutlineOf::Triangles { picture } else { self.grid.within(MARGIN) };
        transform.row(picture.least[1])?;
        let mut worst: Option<Sample> = None;
        for y in picture.least[1]..=picture.most[1] {
            let row = &self.samples[y * self.width..(y + 1) * self.width];
            let is_on = |x: &usize| row[*x] & of.bit() != 0;
            let mut on_row = (picture.least[0]..=picture.most[0]).filter(is_on).peekable();
            if on_row.peek().is_none() {
                continue;
            }
            let squared = transform.row(y)?;
            for x in on_row {
                let own = squared[x].min(known.border_distance([x, y]).pow(2));
                if worst.is_none_or(|(most, _)| own > most) {
                    worst = Some((own, [x, y]));
                }
            }
        }
        Some(worst)
    }

    /// See [`Silhouette::lines`].
    fn lines(&self) -> Vec<[f32; 3]> {
        let [columns, rows] = self.grid.picture.map(|side| side as usize);
        let per_px = self.grid.per_px as usize;
        let picture = self.grid.within(0);
        let mut lines = vec![[0.0; 3]; columns * rows];
        let share = 1.0 / (per_px * per_px) as f32;
        for y in 0..rows * per_px {
            let first = (picture.least[1] + y) * self.width + picture.least[0];
            for (x, bits) in
                self.samples[first..first + columns * per_px].iter().enumerate().filter(|(_, bits)| **bits != 0)
            {
                let line = &mut lines[y / per_px * columns + x / per_px];
                for of in OutlineOf::ALL.into_iter().filter(|of| bits & of.bit() != 0) {
                    line[of as usize] += share;
                }
            }
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is compared where each of three shapes covers the places, in px from the picture's top left, that it says.
    fn silhouette(picture: [u32; 2], per_px: u32, shapes: [&dyn Fn(DVec2) -> bool; 3]) -> Silhouette {
        let grid = SampleGrid { picture, per_px };
        let [width, height] = grid.size().map(|side| side as usize);
        let texel = |(x, y)| {
            let covers = shapes.map(|shape| u8::from(shape(grid.place(x, y))) * 255);
            [covers[0], covers[1], covers[2], 0]
        };
        let texels: Vec<u8> = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).flat_map(texel).collect();
        Silhouette::find(grid, &texels)
    }

    fn disc(middle: DVec2, radius: f64) -> impl Fn(DVec2) -> bool {
        move |place| place.distance(middle) < radius
    }

    fn px(distance: Option<OutlineDistance>) -> f64 {
        distance.expect("both are in view").px
    }

    #[test]
    fn discs_are_as_far_apart_as_their_radii_say() {
        let middle = dvec2(50.3, 39.8);
        for per_px in [1, 2] {
            let found = silhouette([100, 80], per_px, [&disc(middle, 30.0), &disc(middle, 24.0), &disc(middle, 30.4)])
                .distances;
            assert!((px(found.from_source) - 6.0).abs() <= 1.0 / f64::from(per_px), "{found:?}");
            assert!(px(found.from_surface) <= 1.5 / f64::from(per_px), "{found:?}");
        }
    }

    #[test]
    fn a_regular_polygon_is_its_sagitta_away_from_its_circle() {
        let (middle, radius) = (dvec2(120.2, 119.9), 110.0);
        for sides in [3_u32, 5, 8, 12, 32] {
            let half = std::f64::consts::PI / f64::from(sides);
            // Whether a place is nearer to the middle than the line through the two corners on either side.
            let polygon = |place: DVec2| {
                let away = place - middle;
                let turn = (away.to_angle() + 0.3).rem_euclid(2.0 * half) - half;
                away.length() * turn.cos() < radius * half.cos()
            };
            let circle = disc(middle, radius);
            let expected = radius * (1.0 - half.cos());
            for (shapes, what) in
                [([&polygon as &dyn Fn(DVec2) -> bool, &circle, &polygon], "out"), ([&circle, &polygon, &circle], "in")]
            {
                let found = silhouette([240, 240], 2, shapes).distances;
                assert!(
                    (px(found.from_source) - expected).abs() < 1.0,
                    "{sides} sides {what}: {found:?}, not {expected}"
                );
                assert_eq!(px(found.from_surface), 0.0);
            }
        }
    }

    #[test]
    fn the_place_is_where_one_outline_alone_has_a_bump() {
        let (middle, bump) = (dvec2(50.0, 40.0), dvec2(72.0, 40.0));
        let plain = disc(middle, 20.0);
        let bumped = |place| disc(middle, 20.0)(place) || disc(bump, 5.0)(place);
        // A bump of the triangles' and one of the source's are as far from the other outline.
        let out = silhouette([100, 80], 2, [&bumped, &plain, &bumped]).distances;
        let back = silhouette([100, 80], 2, [&plain, &bumped, &plain]).distances;
        for found in [out, back] {
            let worst = found.from_source.expect("both are in view");
            assert!((worst.px - 7.0).abs() < 0.75 && worst.at.distance(dvec2(77.0, 40.0)) < 2.0, "{worst:?}");
            assert_eq!(px(found.from_surface), 0.0);
        }
    }

    #[test]
    fn an_outline_that_leaves_the_picture_is_compared_beyond_its_border() {
        // The edge of the source runs inside the picture's lower border, those of the others outside of it.
        let above = |y: f64| move |place: DVec2| place.y < y;
        let found = silhouette([60, 50], 2, [&above(53.0), &above(47.0), &above(53.0)]).distances;
        assert_eq!(found.from_source, None, "the picture shows no outline of the triangles");
        let found = silhouette([60, 50], 2, [&above(47.0), &above(53.0), &above(90.0)]).distances;
        assert!((px(found.from_source) - 6.0).abs() < 0.1, "{found:?}");
        assert_eq!(found.from_surface, None, "nothing of the surface's outline is known");
        let tilted = |y: f64| move |place: DVec2| place.y < y + 0.02 * place.x;
        let found = silhouette([60, 50], 2, [&tilted(48.8), &tilted(49.4), &tilted(48.8)]).distances;
        assert!(px(found.from_source) < 1.2, "{found:?}");
    }

    #[test]
    fn lines_are_a_px_wide_and_where_nothing_is_there_is_no_distance() {
        let left = |place: DVec2| place.x < 20.0;
        let nothing = |_| false;
        let found = silhouette([40, 10], 2, [&left, &left, &nothing]);
        assert_eq!((px(found.distances.from_source), found.distances.from_surface), (0.0, None));
        let row: Vec<_> = found.lines[5 * 40..6 * 40].iter().map(|line| line[0]).collect();
        assert_eq!((row[19], row[20], row.iter().sum::<f32>()), (0.5, 0.5, 1.0));
    }

    #[test]
    fn large_pictures_have_one_sample_a_px() {
        assert_eq!(SampleGrid::new([1600, 1000], 8192).per_px, 2);
        assert_eq!(SampleGrid::new([3840, 2160], 8192).per_px, 1);
        assert_eq!(SampleGrid::new([8100, 10], 8192).size(), [8164, 74]);
        assert_eq!(SampleGrid::new([5000, 10], 8192).per_px, 1);
    }
}
