//! Differences between pictures by their px: those that structural similarity, which is a mean over the whole picture, hides.

use image::RgbImage;

/// The side of a tile, in px. Tiles overlap by half, so that a small defect isn't cut in two.
const TILE: u32 = 8;
/// How much the 3 x 3 px around a px may differ, in steps of 255, for it to count as inside a surface. Others are at edges.
const EDGE: u8 = 16;
/// How many px that touch each other are no accident at an edge.
const GROUP: usize = 4;
/// The part of the contrast nearby by which a px at an edge may differ: two of its four samples.
const SAMPLES: f32 = 0.5;

/// How two pictures of one size differ, px by px.
pub(super) struct PixelDifferences {
    /// The largest mean of the differences of a tile of 8 x 8 px, in steps of 255; signs cancel, and px at edges count as equal.
    pub largest_tile: f64,
    /// Whether a px differs by more than the step, row by row.
    pub is_beyond: Vec<bool>,
}

impl PixelDifferences {
    /// Compares pictures, which must have one size.
    pub(super) fn new(picture: &RgbImage, reference: &RgbImage, step: f32) -> Self {
        let [own, other] = [picture, reference].map(Neighbourhoods::new);
        let mut is_beyond: Vec<_> = (0..own.nearest.len())
            .map(|i| {
                let (a, b) = (colour(picture, i), colour(reference, i));
                other.distance(i, a) > step || own.distance(i, b) > step
            })
            .collect();
        drop_sparks(&mut is_beyond, [&own, &other], picture.width() as usize);
        Self { largest_tile: largest_tile(picture, reference, [&own, &other]), is_beyond }
    }
}

fn colour(picture: &RgbImage, index: usize) -> [u8; 3] {
    [0, 1, 2].map(|channel| picture.as_raw()[3 * index + channel])
}

/// The least and the largest value of each channel around each px.
struct Neighbourhoods {
    /// In 3 x 3 px.
    nearest: Vec<Range>,
    /// In 5 x 5 px.
    near: Vec<Range>,
}

#[derive(Clone, Copy)]
struct Range {
    least: [u8; 3],
    most: [u8; 3],
}

impl Range {
    fn join(self, other: Self) -> Self {
        let join = |own: [u8; 3], other: [u8; 3], of: fn(u8, u8) -> u8| [0, 1, 2].map(|c| of(own[c], other[c]));
        Self { least: join(self.least, other.least, u8::min), most: join(self.most, other.most, u8::max) }
    }

    /// The largest difference in a channel.
    fn contrast(&self) -> u8 {
        [0, 1, 2].map(|c| self.most[c] - self.least[c]).into_iter().fold(0, u8::max)
    }
}

impl Neighbourhoods {
    fn new(picture: &RgbImage) -> Self {
        let own: Vec<_> = picture.pixels().map(|pixel| Range { least: pixel.0, most: pixel.0 }).collect();
        let (width, height) = (picture.width() as usize, picture.height() as usize);
        let nearest = grown(&own, width, height);
        let near = grown(&nearest, width, height);
        Self { nearest, near }
    }

    /// How far a colour is outside what the picture has around a px, in steps of 255, beyond what two samples at an edge make. The
    /// rasterisers of two drivers may give a px at an edge to different sides, and its colour is then one of those nearby.
    fn distance(&self, index: usize, colour: [u8; 3]) -> f32 {
        let (nearest, near) = (&self.nearest[index], &self.near[index]);
        let of = |c: usize| {
            let outside = nearest.least[c].saturating_sub(colour[c]).max(colour[c].saturating_sub(nearest.most[c]));
            f32::from(outside) - SAMPLES * f32::from(near.most[c] - near.least[c])
        };
        [0, 1, 2].map(of).into_iter().fold(0.0, f32::max)
    }

    /// Whether a px is at an edge.
    fn is_edge(&self, index: usize) -> bool {
        self.nearest[index].contrast() > EDGE
    }
}

/// Joins the range of each px with those of the eight around it.
fn grown(ranges: &[Range], width: usize, height: usize) -> Vec<Range> {
    let mut rows = ranges.to_vec();
    for (row, own) in rows.chunks_exact_mut(width.max(1)).zip(ranges.chunks_exact(width.max(1))) {
        for x in 0..width {
            let around = &own[x.saturating_sub(1)..(x + 2).min(width)];
            row[x] = around.iter().fold(own[x], |range, other| range.join(*other));
        }
    }
    let joined = |i: usize| {
        let (x, y) = (i % width, i / width);
        (y.saturating_sub(1)..(y + 2).min(height)).fold(rows[i], |range, y| range.join(rows[y * width + x]))
    };
    (0..ranges.len()).map(joined).collect()
}

/// Takes out groups of fewer than [`GROUP`] px that touch each other and all lie beside an edge. There a driver may extrapolate
/// a normal beyond the triangle, which makes single px bright.
fn drop_sparks(is_beyond: &mut [bool], pictures: [&Neighbourhoods; 2], width: usize) {
    let height = is_beyond.len() / width.max(1);
    let mut is_seen = vec![false; is_beyond.len()];
    for first in 0..is_beyond.len() {
        if !is_beyond[first] || is_seen[first] {
            continue;
        }
        let mut group = vec![first];
        is_seen[first] = true;
        let mut next = 0;
        while let Some(&i) = group.get(next) {
            next += 1;
            let (x, y) = (i % width, i / width);
            for y in y.saturating_sub(1)..(y + 2).min(height) {
                for i in (x.saturating_sub(1)..(x + 2).min(width)).map(|x| y * width + x) {
                    if is_beyond[i] && !is_seen[i] {
                        is_seen[i] = true;
                        group.push(i);
                    }
                }
            }
        }
        // A defect in the one picture makes contrast there, but none in the other.
        let is_at_edge = |i: &usize| pictures.iter().all(|picture| picture.near[*i].contrast() > EDGE);
        if group.len() < GROUP && group.iter().all(is_at_edge) {
            group.into_iter().for_each(|i| is_beyond[i] = false);
        }
    }
}

fn largest_tile(picture: &RgbImage, reference: &RgbImage, pictures: [&Neighbourhoods; 2]) -> f64 {
    let (width, height) = picture.dimensions();
    let starts = |length: u32| (0..length.saturating_sub(TILE / 2).max(1)).step_by(TILE as usize / 2);
    let tile = |left: u32, top: u32| {
        let mut sums = [0_i64; 3];
        for y in top..(top + TILE).min(height) {
            for x in left..(left + TILE).min(width) {
                let i = (y * width + x) as usize;
                // A px that is inside a surface in one of the pictures isn't one that drivers cover differently.
                if pictures.iter().all(|picture| picture.is_edge(i)) {
                    continue;
                }
                let (a, b) = (colour(picture, i), colour(reference, i));
                (0..3).for_each(|c| sums[c] += i64::from(a[c]) - i64::from(b[c]));
            }
        }
        sums.map(i64::abs).into_iter().fold(0, i64::max) as f64 / f64::from(TILE * TILE)
    };
    starts(height).flat_map(|top| starts(width).map(move |left| tile(left, top))).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use image::Rgb;

    use super::*;

    /// A bright disc on a dark ground, with a soft shade on it.
    fn disc() -> RgbImage {
        RgbImage::from_fn(64, 48, |x, y| {
            let inside = (x as i32 - 32).pow(2) + (y as i32 - 24).pow(2) < 400;
            if inside { Rgb([150 + x as u8 / 4, 140, 130]) } else { Rgb([40, 42, 46]) }
        })
    }

    fn compared(changed: &RgbImage) -> (f64, usize) {
        let differences = PixelDifferences::new(changed, &disc(), 4.0);
        (differences.largest_tile, differences.is_beyond.iter().filter(|is_beyond| **is_beyond).count())
    }

    #[test]
    fn a_hole_of_one_px_and_a_quarter_of_one_are_beyond_the_step() {
        assert_eq!(compared(&disc()), (0.0, 0));
        for part in [1.0, 0.25] {
            let mut hole = disc();
            let pixel = hole.get_pixel_mut(30, 22);
            *pixel = Rgb(pixel.0.map(|own| (f32::from(own) * (1.0 - part) + 42.0 * part) as u8));
            assert_eq!(compared(&hole).1, 1, "{part}");
            let other = PixelDifferences::new(&disc(), &hole, 4.0);
            assert_eq!(other.is_beyond.iter().filter(|is_beyond| **is_beyond).count(), 1, "the other way around");
        }
    }

    #[test]
    fn an_outline_that_moves_by_a_px_is_not() {
        let moved = RgbImage::from_fn(64, 48, |x, y| *disc().get_pixel(x.saturating_sub(1), y));
        assert_eq!(compared(&moved).1, 0);
    }

    #[test]
    fn three_px_beside_an_edge_are_not_but_four_are() {
        let mut picture = disc();
        // The disc's border is at x = 13 in these rows.
        for (y, expected) in [(24, 0), (25, 0), (26, 0), (23, 4)] {
            picture.put_pixel(13, y, Rgb([255, 255, 255]));
            assert_eq!(compared(&picture).1, expected, "{y}");
        }
    }

    #[test]
    fn a_tile_counts_what_all_of_its_px_have_in_common_and_no_noise() {
        let brighter = |by: fn(u32, u32) -> u8| {
            let mut picture = disc();
            picture.enumerate_pixels_mut().for_each(|(x, y, pixel)| pixel.0 = pixel.0.map(|own| own + by(x, y)));
            compared(&picture).0
        };
        assert_eq!(brighter(|_, _| 3), 3.0);
        assert!(brighter(|x, y| 2 * ((x + y) % 2) as u8) <= 1.1);
    }

    #[test]
    fn pictures_of_any_size_are_compared() {
        for size in [[1, 1], [3, 2], [8, 8], [9, 31]] {
            let [own, other] = [10, 200].map(|level| RgbImage::from_pixel(size[0], size[1], Rgb([level; 3])));
            let differences = PixelDifferences::new(&own, &other, 4.0);
            assert!(differences.largest_tile > 0.0);
            assert!(differences.is_beyond.iter().all(|is_beyond| *is_beyond));
        }
    }
}
