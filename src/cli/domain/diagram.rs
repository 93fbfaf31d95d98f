//! Draws a domain pattern as an SVG file.

use geometry::tessellate::DomainKind;

/// The length of a side, and the space around the pattern, in px.
const SIDE: f64 = 480.0;
const AROUND: [f64; 2] = [150.0, 60.0];

/// A grey that is legible on white and on dark pages.
const COLOR: &str = "#7b7b7b";

/// Draws the outlines of what joins points, the points as dots, and the factors beside what they cut.
pub(super) fn svg(kind: DomainKind, factors: &[f32], points: &[[u32; 2]], joined: &[impl AsRef<[u32]>]) -> String {
    let height = match kind {
        DomainKind::Tri => 0.75_f64.sqrt() * SIDE,
        DomainKind::Quad | DomainKind::Isoline => SIDE,
    };
    let place = |[x, y]: [f64; 2]| [AROUND[0] + SIDE * x, AROUND[1] + height * y];
    let places: Vec<_> = points.iter().map(|&point| place(kind.place(point))).collect();
    let outlines = joined.iter().map(|own| {
        let corners = own.as_ref().iter().filter_map(|&point| places.get(point as usize));
        let corners: String = corners.map(|[x, y]| format!("{x:.2},{y:.2} ")).collect();
        format!("<path d=\"M{}z\"/>\n", corners.trim_end())
    });
    let dots = places.iter().map(|[x, y]| format!("<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"2.5\"/>\n"));
    let texts = labels(kind).iter().zip(factors).map(|(&(name, at, anchor), factor)| {
        let [x, y] = place(at);
        format!("<text x=\"{x:.2}\" y=\"{y:.2}\" text-anchor=\"{anchor}\">{name}: {factor}</text>\n")
    });
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0}\" height=\"{:.0}\">\n\
         <g fill=\"none\" stroke=\"{COLOR}\">\n{}</g>\n\
         <g fill=\"{COLOR}\" font-family=\"sans-serif\" font-size=\"14\">\n{}{}</g>\n</svg>\n",
        SIDE + 2.0 * AROUND[0],
        height + 2.0 * AROUND[1],
        outlines.collect::<String>(),
        dots.collect::<String>(),
        texts.collect::<String>(),
    )
}

/// Returns for each factor of a kind of patch what it cuts, where that is written in the square of [`DomainKind::place`], and
/// which part of the text lies there.
fn labels(kind: DomainKind) -> &'static [(&'static str, [f64; 2], &'static str)] {
    match kind {
        DomainKind::Tri => &[
            ("u = 0", [0.5, 1.05], "middle"),
            ("v = 0", [0.78, 0.5], "start"),
            ("w = 0", [0.22, 0.5], "end"),
            ("inside", [0.5, 1.1], "middle"),
        ],
        DomainKind::Quad => &[
            ("u = 0", [-0.02, 0.5], "end"),
            ("v = 0", [0.5, -0.03], "middle"),
            ("u = 1", [1.02, 0.5], "start"),
            ("v = 1", [0.5, 1.04], "middle"),
            ("inside along u", [0.0, 1.09], "start"),
            ("inside along v", [1.0, 1.09], "end"),
        ],
        DomainKind::Isoline => &[("u = 0, isolines", [-0.02, 0.5], "end"), ("v = 0, segments", [0.5, -0.03], "middle")],
    }
}
