//! Assigns a style to every method, and draws the legend that explains the styles.

use plotters::prelude::*;

use super::method_style::{Fill, MethodStyle, Shape, dash};
use super::pen::{Drawn, FRONT, LEFT, Pen};
use super::{LodKind, Method, Subject, distinct};
use geometry::tessellate::{Normals, Partitioning};
use inspect::plot::INK;
use inspect::settings::Choice;

/// An entry of the legend: a sample and its name.
#[derive(Clone)]
pub(super) struct Entry {
    sample: Sample,
    name: String,
}

#[derive(Clone)]
enum Sample {
    Marker(MethodStyle),
    /// Its colour, its width in px, and its dashes, if it has some.
    Line(RGBColor, f64, Option<[f64; 2]>),
}

/// The number of entries in a line of LODs, or of partitionings and normals.
const IN_A_LINE: usize = 3;

/// Every method of a subject, with its style.
pub fn method_styles(subject: &Subject) -> Vec<(Method, MethodStyle)> {
    let methods = subject.methods();
    let variants = variants(&methods);
    let variant = |method: &Method| variants.iter().position(|other| pair(other) == pair(method)).unwrap_or(0);
    methods.iter().map(|method| (*method, MethodStyle::new(*method, variant(method)))).collect()
}

/// One method for each pair of partitioning and normals; empty if every LOD has only one such pair, so that the pairs needn't
/// be told apart.
fn variants(methods: &[Method]) -> Vec<Method> {
    let first = |own| methods.iter().copied().find(|method| pair(method) == own);
    let all: Vec<Method> = distinct(methods.iter().map(pair)).into_iter().filter_map(first).collect();
    let one_each = |lod: LodKind| all.iter().filter(|method| method.lod == lod).count() <= 1;
    if LodKind::ALL.into_iter().all(one_each) { Vec::new() } else { all }
}

fn pair(method: &Method) -> (Partitioning, Normals) {
    (method.partitioning, method.normals)
}

/// The lines of the legend: those of surfaces, of LODs, and of partitionings and normals if there are several.
pub(super) fn legend(subjects: &[Subject]) -> Vec<Vec<Entry>> {
    let Some(subject) = subjects.iter().max_by_key(|subject| subject.methods().len()) else { return Vec::new() };
    let variants = variants(&subject.methods());
    let (mut surfaces, mut lods) = (Vec::new(), Vec::new());
    for (method, style) in method_styles(subject) {
        add(&mut surfaces, Sample::Marker(MethodStyle { fill: Fill::Full, ..style }), method.surface.name().to_owned());
        let mut name = match method.lod {
            LodKind::Uniform => "uniform factor".to_owned(),
            LodKind::Paper => "white paper's LOD, px a segment".to_owned(),
            LodKind::Error => "LOD by error, px".to_owned(),
            LodKind::ErrorRows => "LOD by error under rows, px".to_owned(),
        };
        if variants.is_empty() {
            name += &format!(" ({})", method.partitioning.name());
        }
        add(&mut lods, Sample::Line(INK, 1.4, dash(method.lod)), name);
    }
    add(&mut surfaces, Sample::Line(FRONT, 9.0, None), "nothing has less error at less cost".to_owned());
    let mut pairs = Vec::new();
    for (index, method) in variants.iter().enumerate() {
        let style = MethodStyle { color: INK, shape: Shape::Disc, ..MethodStyle::new(*method, index) };
        let name = format!("{}, {} normals", method.partitioning.name(), method.normals.name());
        add(&mut pairs, Sample::Marker(style), name);
    }
    let mut lines = vec![surfaces];
    lines.extend([lods, pairs].iter().flat_map(|entries| entries.chunks(IN_A_LINE)).map(<[_]>::to_vec));
    lines
}

/// Adds an entry, unless there is one with this name.
fn add(entries: &mut Vec<Entry>, sample: Sample, name: String) {
    if !entries.iter().any(|entry| entry.name == name) {
        entries.push(Entry { sample, name });
    }
}

/// Draws a line of entries from `at` on. `size` is the height of their text in px.
pub(super) fn draw_legend<DB: DrawingBackend>(pen: &Pen<DB>, entries: &[Entry], at: [f64; 2], size: i32) -> Drawn<DB> {
    let [mut x, y] = at;
    for Entry { sample, name } in entries {
        let long = match sample {
            Sample::Marker(style) => {
                pen.marker([x + 6.0, y], style)?;
                16.0
            }
            Sample::Line(color, thick, dash) => {
                pen.line(&[[x, y], [x + 32.0, y]], *color, *thick, *dash)?;
                38.0
            }
        };
        pen.text(name, [x + long, y], size, LEFT)?;
        x += long + pen.text_width(name, size) * 1.08 + 22.0;
    }
    Ok(())
}
