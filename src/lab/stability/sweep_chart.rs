//! The chart of factor sweeps: how far the surface jumps at each tessellation factor.

use std::ops::Range;

use image::RgbImage;
use plotters::backend::BitMapBackend;
use plotters::coord::Shift;
use plotters::coord::cartesian::Cartesian2d;
use plotters::coord::combinators::LogCoord;
use plotters::element::DashedPathElement;
use plotters::prelude::*;

use geometry::tessellate::Partitioning;
use inspect::measure::{Sweep, SweepStep};
use inspect::plot::{self, BLUE, BLUISH_GREEN, ChartError, DENSITY, INK, REDDISH_PURPLE, SKY_BLUE, VERMILION};
use inspect::settings::Choice;
use inspect::settings::options::FACTOR_RANGE;

type Picture<'a> = DrawingArea<BitMapBackend<'a>, Shift>;
type Chart<'a, 'b> = ChartContext<'a, BitMapBackend<'b>, Cartesian2d<LogCoord<f64>, LogCoord<f64>>>;
/// `C` are coordinates of the chart, or px.
type Element<'b, C> = DynElement<'static, BitMapBackend<'b>, C>;
type Drawn = Result<(), DrawingAreaErrorKind<<BitMapBackend<'static> as DrawingBackend>::ErrorType>>;

/// Draws the largest jump of each step over the factor, on logarithmic axes. A partitioning that pops has a stem for each
/// pop; fractional ones have lines. Jumps are shown as parts of `diagonal`, the mesh's in object units; a jump of 0 is at
/// the bottom. The last argument is the width and height in px.
pub(super) fn sweep_chart(sweeps: &[Sweep], diagonal: f64, size: [u32; 2]) -> Result<RgbImage, ChartError> {
    plot::bitmap(size, |picture| draw(picture, sweeps, diagonal))
}

/// Converts px of the chart to px drawn.
const fn px(length: i32) -> i32 {
    length * DENSITY as i32
}

fn draw(picture: &Picture, sweeps: &[Sweep], diagonal: f64) -> Drawn {
    picture.fill(&WHITE)?;
    let (low, high) = (f64::from(FACTOR_RANGE.least), f64::from(FACTOR_RANGE.most));
    let decades = decades(sweeps, diagonal);
    // Some room at the ends, so that rounding doesn't drop the last ticks.
    let mut chart = ChartBuilder::on(picture)
        .margin(px(12))
        .x_label_area_size(px(42))
        .y_label_area_size(px(62))
        .build_cartesian_2d(
            (low..high * 1.001).log_scale().base(2.0),
            (decades.start * 0.999..decades.end * 1.001).log_scale(),
        )?;
    axes(&mut chart, sweeps)?;
    for sweep in sweeps {
        let points = parts(sweep, diagonal, decades.start);
        let name = sweep.partitioning.name();
        let text = match sweep.largest() {
            Some(step) if step.jump > 0.0 => format!("{name}, up to {:.1e}", step.jump / diagonal),
            _ => format!("{name}, no jump"),
        };
        let (of, bottom) = (sweep.partitioning, decades.start);
        let elements = if of.is_fractional() {
            vec![path(of, highest_of_columns(&chart, &points))]
        } else {
            let pops = points.into_iter().filter(|(_, part)| *part > bottom);
            pops.flat_map(|top @ (factor, _)| [path(of, vec![(factor, bottom), top]), marker(of, top)]).collect()
        };
        chart.draw_series(elements)?.label(text).legend(move |at| sample(of, at));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .label_font(plot::font(px(14)))
        .legend_area_size(px(40))
        .margin(px(8))
        .background_style(WHITE.mix(0.9))
        .border_style(INK.mix(0.3))
        .draw()
}

/// The range between powers of ten that holds all jumps except 0, with some room at both ends.
fn decades(sweeps: &[Sweep], diagonal: f64) -> Range<f64> {
    let jumps = sweeps.iter().flat_map(|sweep| &sweep.steps).map(|step| step.jump / diagonal);
    let [least, most] = jumps
        .filter(|part| *part > 0.0 && part.is_finite())
        .fold([f64::INFINITY, 0.0], |[least, most], part| [least.min(part), most.max(part)]);
    if most == 0.0 {
        return 1e-9..1e-1;
    }
    let bottom = (least * 0.9).log10().floor();
    10f64.powf(bottom)..10f64.powf((most * 1.1).log10().ceil().max(bottom + 1.0))
}

fn axes(chart: &mut Chart, sweeps: &[Sweep]) -> Drawn {
    let jump = match sweeps.first() {
        Some(sweep) if sweep.step > 0.0 && sweep.step < 1.0 => {
            format!("Largest jump per step of 1/{}", 1.0 / sweep.step)
        }
        _ => "Largest jump per step".to_owned(),
    };
    chart
        .configure_mesh()
        .x_desc("Tessellation factor (segments an edge)")
        .y_desc(format!("{jump} (mesh diagonals)"))
        .axis_desc_style(plot::font(px(15)))
        .label_style(plot::font(px(14)))
        .x_labels(7)
        .y_labels(10)
        .x_label_formatter(&|factor| format!("{factor:.0}"))
        .y_label_formatter(&|part| format!("{part:.0e}"))
        .set_all_tick_mark_size(px(5))
        .max_light_lines(1)
        .bold_line_style(INK.mix(0.15).stroke_width(DENSITY))
        .light_line_style(TRANSPARENT)
        .axis_style(INK.stroke_width(DENSITY))
        .draw()
}

/// The points of the chart: for each step the factor, and the jump as a part of the diagonal.
fn parts(sweep: &Sweep, diagonal: f64, bottom: f64) -> Vec<(f64, f64)> {
    let point = |step: &SweepStep| (f64::from(step.factor), (step.jump / diagonal).max(bottom));
    sweep.steps.iter().map(point).collect()
}

/// The colour of a partitioning. Lines and markers tell it from the others, too.
fn color(partitioning: Partitioning) -> RGBColor {
    match partitioning {
        Partitioning::Integer => VERMILION,
        Partitioning::Pow2 => BLUE,
        Partitioning::FractionalOdd => BLUISH_GREEN,
        Partitioning::FractionalEven => BLACK,
        Partitioning::Subtriangulation => REDDISH_PURPLE,
        Partitioning::Rows => SKY_BLUE,
    }
}

/// A line along points, in px or in coordinates of the chart. Stems are thin and pale, so that lines stand out.
fn path<'b, C: Clone + 'static>(of: Partitioning, points: Vec<C>) -> Element<'b, C> {
    let thick = color(of).stroke_width(DENSITY * 2);
    match of {
        Partitioning::FractionalOdd => PathElement::new(points, thick).into_dyn(),
        Partitioning::FractionalEven => DashedPathElement::new(points, px(7), px(4), thick).into_dyn(),
        Partitioning::Integer | Partitioning::Pow2 | Partitioning::Subtriangulation | Partitioning::Rows => {
            PathElement::new(points, color(of).mix(0.4).stroke_width(DENSITY)).into_dyn()
        }
    }
}

/// The marker at the top of a stem.
fn marker<'b, C: Clone + 'static>(of: Partitioning, at: C) -> Element<'b, C> {
    match of {
        Partitioning::Pow2 => Cross::new(at, px(4), color(of).stroke_width(DENSITY * 2)).into_dyn(),
        Partitioning::Subtriangulation => TriangleMarker::new(at, px(4), color(of).filled()).into_dyn(),
        _ => Circle::new(at, px(3), color(of).filled()).into_dyn(),
    }
}

/// The sample for the legend, to the right of a px.
fn sample<'b>(of: Partitioning, (x, y): (i32, i32)) -> Element<'b, (i32, i32)> {
    if of.is_fractional() { path(of, vec![(x, y), (x + px(32), y)]) } else { marker(of, (x + px(16), y)) }
}

/// The highest point in each column of px. A line through all points would smear where steps are narrower than a px.
fn highest_of_columns(chart: &Chart, points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let column = |point: &(f64, f64)| chart.backend_coord(point).0 / DENSITY as i32;
    let columns = points.chunk_by(|a, b| column(a) == column(b));
    columns.filter_map(|points| points.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sweep with these jumps at these factors.
    fn sweep(partitioning: Partitioning, jumps: &[(f32, f64)]) -> Sweep {
        let step = |&(factor, jump): &(f32, f64)| SweepStep { factor, jump, patch: 0, place: [0, 0] };
        Sweep { partitioning, step: 1.0 / 64.0, steps: jumps.iter().map(step).collect() }
    }

    fn has(picture: &RgbImage, color: RGBColor) -> bool {
        picture.pixels().any(|pixel| pixel.0 == [color.0, color.1, color.2])
    }

    /// The centres of the discs to the left of the legend, in px from the upper left corner.
    fn discs(picture: &RgbImage) -> Vec<[f64; 2]> {
        let RGBColor(r, g, b) = color(Partitioning::Integer);
        let mut found: Vec<_> = picture.enumerate_pixels().filter(|(_, _, pixel)| pixel.0 == [r, g, b]).collect();
        found.retain(|(x, _, _)| *x < picture.width() * 6 / 10);
        found.sort_by_key(|(x, _, _)| *x);
        let mean = |disc: &[(u32, u32, &image::Rgb<u8>)]| {
            let count = disc.len() as f64;
            [
                disc.iter().map(|px| f64::from(px.0)).sum::<f64>() / count,
                disc.iter().map(|px| f64::from(px.1)).sum::<f64>() / count,
            ]
        };
        found.chunk_by(|a, b| b.0 - a.0 <= 1).map(mean).collect()
    }

    #[test]
    fn equal_ratios_are_equal_distances() {
        let pops = sweep(Partitioning::Integer, &[(2.0, 0.5), (3.0, 0.0), (4.0, 0.05), (8.0, 0.005)]);
        for size in [[640, 400], [960, 600]] {
            let picture = sweep_chart(std::slice::from_ref(&pops), 5.0, size).expect("it draws");
            assert_eq!(picture.dimensions(), size.into());
            let [a, b, c] = discs(&picture).try_into().expect("three discs");
            for axis in 0..2 {
                let [before, after] = [b[axis] - a[axis], c[axis] - b[axis]];
                assert!(before > 30.0 && (before - after).abs() <= 1.0, "{a:?} {b:?} {c:?}");
            }
        }
    }

    #[test]
    fn every_partitioning_has_its_colour() {
        let jumps = [(2.0, 0.5), (4.0, 0.05), (8.0, 0.1), (32.0, 0.01)];
        for shown in Partitioning::ALL {
            let picture = sweep_chart(&[sweep(shown, &jumps)], 1.0, [640, 400]).expect("it draws");
            for partitioning in Partitioning::ALL {
                assert_eq!(has(&picture, color(partitioning)), partitioning == shown, "{partitioning:?}");
            }
        }
    }

    #[test]
    fn a_chart_without_any_jump_is_drawn() {
        let still = sweep(Partitioning::FractionalEven, &[(1.5, 0.0), (2.0, 0.0)]);
        for sweeps in [&[][..], &[still]] {
            let picture = sweep_chart(sweeps, 0.0, [320, 320]).expect("it draws");
            assert!(has(&picture, WHITE) && picture.pixels().any(|pixel| pixel.0[0] < 100));
        }
    }
}
