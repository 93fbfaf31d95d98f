//! Links between pages: their files exist, and their anchors are headings.

use std::collections::BTreeMap;
use std::path::Path;

use super::{Page, all_pages, is_package, root};

/// Targets of the page's links and pictures, without those on the web.
fn targets(page: &Page) -> Vec<String> {
    let prose = without_code_spans(&page.prose().join("\n"));
    let targets = prose.split("](").skip(1).filter_map(|rest| rest.split_once(')'));
    let own = targets.map(|(target, _)| target.to_owned());
    own.filter(|target| !target.starts_with("http://") && !target.starts_with("https://")).collect()
}

/// Removes text between backticks, which is code and has no links.
fn without_code_spans(text: &str) -> String {
    text.split('`').step_by(2).collect::<Vec<_>>().join("code")
}

/// The anchors of a page's headings, as GitHub makes them.
fn anchors(page: &Page) -> Vec<String> {
    let mut times: BTreeMap<String, usize> = BTreeMap::new();
    let heading = |line: &str| {
        let text = line.trim_start_matches('#').strip_prefix(' ')?;
        line.starts_with('#').then(|| text.trim().to_owned())
    };
    let anchor = |text: String| {
        let kept = text.to_lowercase().replace(' ', "-");
        let anchor: String = kept.chars().filter(|c| c.is_alphanumeric() || matches!(c, '-' | '_')).collect();
        let before = times.entry(anchor.clone()).or_default();
        *before += 1;
        if *before == 1 { anchor } else { format!("{anchor}-{}", *before - 1) }
    };
    page.prose().into_iter().filter_map(heading).map(anchor).collect()
}

/// Says what is wrong with a link; none if it is valid.
fn fault(page: &Page, target: &str) -> Option<String> {
    let (path, anchor) = target.split_once('#').map_or((target, None), |(path, anchor)| (path, Some(anchor)));
    let file = page.resolve(path);
    if !path.is_empty() && !file.exists() {
        return (!is_left_out(&file)).then(|| format!("{}: there is no {path}", page.name));
    }
    let anchor = anchor?;
    let there = if path.is_empty() { anchors(page) } else { anchors(&Page::read_from(path, file)) };
    (!there.iter().any(|own| own == anchor)).then(|| format!("{}: no heading for {target}", page.name))
}

/// Whether a file isn't part of the package that the tests run in.
fn is_left_out(file: &Path) -> bool {
    is_package()
        && file.extension().is_some_and(|ending| ending == "png")
        && file.to_string_lossy().contains("stability")
}

#[test]
fn links_between_pages_are_valid() {
    let pages = all_pages();
    let links: Vec<_> = pages.iter().flat_map(|page| targets(page).into_iter().map(move |to| (page, to))).collect();
    assert!(links.len() > 200, "only {} links were found", links.len());
    let faults: Vec<_> = links.iter().filter_map(|(page, target)| fault(page, target)).collect();
    assert_eq!(faults, Vec::<String>::new());
}

#[test]
fn a_link_without_a_file_or_a_heading_is_found() {
    let text =
        "# A `b` c\n[x](LICENSE) [y](#a-b-c) [z](README.md#start)\n\n    [not](a-link)\n`[nor](this)`\n## A b c\n";
    let page = Page { name: "test".into(), path: root().join("test.md"), text: text.into() };
    assert_eq!(anchors(&page), ["a-b-c", "a-b-c-1"]);
    assert_eq!(targets(&page), ["LICENSE", "#a-b-c", "README.md#start"]);
    assert!(targets(&page).iter().all(|target| fault(&page, target).is_none()));
    for broken in ["LICENCE", "#a-b", "README.md#nowhere", "src/nothing.rs"] {
        assert!(fault(&page, broken).is_some(), "{broken}");
    }
}
