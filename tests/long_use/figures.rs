//! The memory that a window took after each step: checks that it levels off, and writes it as a table and a picture.

use std::fmt::Write as _;
use std::path::Path;

use inspect::plot::{BLUE, FONT, INK, use_font};
use plotters::prelude::*;
use pnaen::app::App;

use crate::counting::taken;

const MIB: f64 = 1024.0 * 1024.0;

/// The kinds of memory, and the part by which the mean over the last quarter of the steps may exceed that over the second. The
/// device's memory depends on the settings. The process holds pages that its allocators keep, and code that a software driver
/// compiles, so it levels off only after hundreds of steps.
const KINDS: [(&str, f64); 3] = [("heap", 0.02), ("graphics device", 0.1), ("process", 0.1)];
/// The memory of the process is checked from this number of steps on.
const MANY: usize = 100;

/// The MiB of each of [`KINDS`]; `None` if the system doesn't report it.
pub(crate) type Taken = [Option<f64>; KINDS.len()];

/// The memory that is taken now, in MiB.
pub(crate) fn now(app: &App) -> Taken {
    let report = app.engine().gpu.device.generate_allocator_report();
    let device = report.map(|report| report.total_allocated_bytes as f64 / MIB);
    [Some(taken() as f64 / MIB), device, resident()]
}

/// The resident memory of this process in MiB; `None` if the system doesn't report it.
fn resident() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok()? / 1024.0)
}

/// One part of the test: what was done, and the memory after each step.
pub(crate) struct Part {
    pub what: &'static str,
    pub taken: Vec<Taken>,
}

impl Part {
    /// Checks that the memory levels off.
    ///
    /// # Panics
    /// The last quarter of the steps takes more than the second.
    pub(crate) fn levels_off(&self) {
        let quarter = self.taken.len() / 4;
        for (kind, (name, noise)) in KINDS.into_iter().enumerate() {
            let mean = |rows: &[Taken]| {
                rows.iter().map(|row| row[kind]).sum::<Option<f64>>().map(|sum| sum / rows.len() as f64)
            };
            let Some((second, last)) = mean(&self.taken[quarter..2 * quarter]).zip(mean(&self.taken[3 * quarter..]))
            else {
                continue;
            };
            println!(
                "{} {}: {name} {second:.2} MiB in the second quarter, {last:.2} in the last",
                self.taken.len(),
                self.what
            );
            let is_held = name != "process" || self.taken.len() >= MANY;
            assert!(!is_held || last <= second * (1.0 + noise), "{}: {name} grows", self.what);
        }
    }
}

/// Writes `long-use.csv` and `long-use.svg` into a folder.
pub(crate) fn write(folder: &Path, parts: &[Part]) {
    let mut table = "part,step".to_owned();
    for (name, _) in KINDS {
        let _ = write!(table, ",{}_mib", name.replace(' ', "_"));
    }
    for part in parts {
        for (step, taken) in part.taken.iter().enumerate() {
            let _ = write!(table, "\n{},{}", part.what, step + 1);
            for mib in taken {
                let _ = write!(table, ",{}", mib.map_or(String::new(), |mib| format!("{mib:.2}")));
            }
        }
    }
    table.push('\n');
    std::fs::write(folder.join("long-use.csv"), table).expect("a writable folder");
    draw(&folder.join("long-use.svg"), parts).expect("a writable folder");
}

fn draw(path: &Path, parts: &[Part]) -> Result<(), Box<dyn std::error::Error>> {
    use_font()?;
    let area = SVGBackend::new(path, (1000, 200 * KINDS.len() as u32)).into_drawing_area();
    area.fill(&WHITE)?;
    let steps: usize = parts.iter().map(|part| part.taken.len()).sum();
    for (kind, panel) in area.split_evenly((KINDS.len(), 1)).iter().enumerate() {
        let all = || parts.iter().flat_map(|part| &part.taken).filter_map(|taken| taken[kind]);
        let most = all().fold(1.0, f64::max);
        let caption = format!("{}, MiB", KINDS[kind].0);
        let mut chart = ChartBuilder::on(panel)
            .caption(caption, (FONT, 16).into_font().color(&INK))
            .margin(8)
            .margin_right(60)
            .x_label_area_size(24)
            .y_label_area_size(56)
            .build_cartesian_2d(0..steps, 0.0..most * 1.1)?;
        chart.configure_mesh().light_line_style(TRANSPARENT).max_light_lines(1).draw()?;
        let mut start = 0;
        for part in parts {
            let line = (start..).zip(&part.taken).filter_map(|(step, taken)| Some((step, taken[kind]?)));
            chart.draw_series(LineSeries::new(line, BLUE.stroke_width(1)))?;
            let words = Text::new(
                format!("{} {}", part.taken.len(), part.what),
                (start, most * 1.08),
                (FONT, 13).into_font().color(&INK),
            );
            chart.draw_series([words])?;
            start += part.taken.len();
            chart.draw_series([PathElement::new([(start, 0.0), (start, most * 1.1)], INK.mix(0.3))])?;
        }
    }
    area.present()?;
    Ok(())
}
