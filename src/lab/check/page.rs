//! The report as a page: an HTML file, and the pictures that it shows, which a browser loads as they are scrolled to.

use std::fmt::Write;

use super::report::{Asset, Report, Status, View, gate_title};
use geometry::numbers::{counted, grouped};
use inspect::html::{END, begin, escaped};

/// What this page has besides what all pages have.
const STYLE: &str = "
body { background: var(--back); }
h1 { font-size: 1.5rem; } h2 { font-size: 1.1rem; margin: 0; overflow-wrap: anywhere; }
.asset { background: var(--card); border: 1px solid var(--line); border-radius: 6px; margin: 1rem 0; padding: 1rem; }
.view { display: flex; flex-wrap: wrap; gap: 1rem; margin-top: 0.75rem; }
.view > div { flex: 1 1 18rem; } figcaption { font-size: 0.9rem; }
img { display: block; max-width: 100%; width: 22rem; border-radius: 4px; }
table { border-collapse: collapse; } td.number { text-align: right; }
ul { margin: 0.5rem 0; padding-left: 1.2rem; } .dim { color: var(--dim); }
.filter { font: inherit; width: min(100%, 22rem); padding: 0.3rem 0.5rem; color: inherit; background: var(--card);
  border: 1px solid var(--dim); border-radius: 4px; } [hidden] { display: none; }
.broken { color: var(--bad); } .status { font-weight: 600; }
";

/// Hides the assets that don't have all words of the filter. Without it, the page shows them all.
const FILTER: &str = "
<p><label>Show only <input class=\"filter\" type=\"search\" placeholder=\"words of a path, a gate or failed\"></label>
<output class=\"dim\"></output></p>
<script>
addEventListener('DOMContentLoaded', () => {
  const all = [...document.querySelectorAll('.asset')].map(asset => [asset, asset.textContent.toLowerCase()]);
  const input = document.querySelector('.filter');
  input.addEventListener('input', () => {
    const words = input.value.toLowerCase().split(/\\s+/).filter(Boolean);
    let shown = 0;
    for (const [asset, text] of all) {
      asset.hidden = !words.every(word => text.includes(word));
      shown += !asset.hidden;
    }
    document.querySelector('output').value = words.length ? `${shown} of ${all.length}` : '';
  });
});
</script>
";

/// The folder of the pictures, beside the page.
pub const PICTURES: &str = "pictures";

/// The pictures that the page shows: the name of each in [`PICTURES`], and the PNG file in base64. Equal pictures have one name.
pub fn pictures(report: &Report) -> impl Iterator<Item = (String, &str)> {
    let views = report.assets.iter().flat_map(|asset| &asset.views);
    let all = views.flat_map(|view| view.picture.iter().chain(view.gates.iter().flat_map(|gate| &gate.evidence)));
    all.map(|picture| (file_name(picture), picture.as_str()))
}

fn file_name(picture: &str) -> String {
    format!("{}.png", &blake3::hash(picture.as_bytes()).to_hex()[..32])
}

/// Writes the page. What failed comes first.
pub fn page(report: &Report) -> String {
    let mut text = begin("pnaen check", STYLE);
    let _ = write!(text, "<h1>pnaen check</h1>\n<p>{}.</p>{FILTER}\n", escaped(&report.summary()));
    for status in Status::ALL.into_iter().rev() {
        report.assets.iter().filter(|asset| asset.status() == status).for_each(|asset| text += &section(asset));
    }
    text + END
}

fn section(asset: &Asset) -> String {
    let status = asset.status().name();
    let mut text = format!("<section class=\"asset\">\n<h2>{}</h2>\n", escaped(&asset.path));
    let unchanged = if asset.unchanged { " <span class=\"dim\">unchanged, not measured again</span>" } else { "" };
    let _ = writeln!(text, "<div class=\"status {status}\">{status}{unchanged}</div>");
    text.extend(asset.error.iter().map(|error| format!("<p>{}</p>\n", escaped(error))));
    asset.views.iter().for_each(|view| text += &of_view(asset, view));
    if !asset.warnings.is_empty() {
        let _ = writeln!(
            text,
            "<details><summary>{} of loading</summary>\n<ul>",
            counted(asset.warnings.len() as u64, "warning")
        );
        text.extend(asset.warnings.iter().map(|warning| format!("<li>{}</li>\n", escaped(warning))));
        text += "</ul></details>\n";
    }
    text + "</section>\n"
}

fn of_view(asset: &Asset, view: &View) -> String {
    let mut text = String::from("<div class=\"view\">\n");
    let name = if view.name.is_empty() { &asset.path } else { &view.name };
    if let Some(picture) = &view.picture {
        let caption = if view.name.is_empty() { "" } else { &view.name };
        text += &figure(picture, &format!("Picture of {name}"), caption);
    }
    text += "<div>\n<table>\n";
    let numbers = view.numbers;
    for (label, number) in [
        ("triangles of the mesh", numbers.triangles_in),
        ("patches", numbers.patches),
        ("emitted triangles", numbers.triangles_out),
        ("emitted vertices", numbers.vertices_out),
    ] {
        let _ = writeln!(text, "<tr><th>{label}</th><td class=\"number\">{}</td></tr>", grouped(number));
    }
    text += "</table>\n<ul>\n";
    for gate in &view.gates {
        // The words say what the colours say.
        let (class, how) = if gate.passed { ("passed", "") } else { ("failed", " failed") };
        let (gate, words) = (escaped(&gate.name), escaped(&gate.text));
        let _ = writeln!(text, "<li><span class=\"{class}\">{gate}{how}</span>: {words}</li>");
    }
    text += "</ul>\n</div>\n";
    for gate in &view.gates {
        let caption = gate_title(&view.name, &gate.name);
        let of = |evidence: &String| figure(evidence, &format!("What {caption} found in {name}"), &caption);
        text.extend(gate.evidence.as_ref().map(of));
    }
    text + "</div>\n"
}

/// A picture, whose PNG file in base64 names it.
fn figure(picture: &str, alternative: &str, caption: &str) -> String {
    let caption =
        if caption.is_empty() { String::new() } else { format!("<figcaption>{}</figcaption>", escaped(caption)) };
    let alternative = escaped(alternative);
    let name = file_name(picture);
    format!("<figure><img loading=\"lazy\" src=\"{PICTURES}/{name}\" alt=\"{alternative}\">{caption}</figure>\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::report::sample;

    #[test]
    fn the_page_needs_no_other_file_than_its_pictures_and_closes_what_it_opens() {
        let report = sample();
        let text = page(&report);
        assert_eq!(text.matches("<section").count(), 3);
        assert_eq!(text.matches("<img loading=\"lazy\"").count(), 4, "three views and one piece of evidence");
        assert_eq!(pictures(&report).count(), 4);
        for (name, _) in pictures(&report) {
            assert!(text.contains(&format!("src=\"pictures/{name}\"")), "{name}");
        }
        assert!(!text.contains("http") && !text.contains("src=\"/"), "{text}");
        assert!(text.contains("torn&lt;&amp;&quot;&gt;.glb") && !text.contains("torn<"), "{text}");
        for element in
            ["html", "head", "body", "style", "section", "div", "table", "ul", "figure", "tr", "td", "th", "li"]
        {
            let opened = text.matches(&format!("<{element}>")).count() + text.matches(&format!("<{element} ")).count();
            assert_eq!(opened, text.matches(&format!("</{element}>")).count(), "{element}");
        }
        assert!(
            text.contains(">cracks failed</span>: 12 edges") && text.contains(">leaks failed</span>: the mesh is open"),
            "{text}"
        );
        let order = ["broken.obj", "torn&lt;", "a b/good.glb"].map(|name| text.find(name).expect("it is on the page"));
        assert!(order.is_sorted(), "what failed comes first");
        assert_eq!(text.matches("alt=\"").count(), 4);
    }
}
