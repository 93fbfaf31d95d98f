//! Options: the manual's page of commands lists every option of `--help`, and no page names an unknown one.

use std::collections::{BTreeMap, BTreeSet};

use super::{Page, user_pages};
use crate::output;

type Options = BTreeSet<String>;

const COMMANDS: [&str; 14] = [
    "render",
    "turntable",
    "tessellate",
    "factors",
    "adjacency",
    "check",
    "shaders",
    "compare",
    "domain",
    "info",
    "stability",
    "gallery",
    "chart",
    "adapters",
];

/// The options that a command prints with `--help`. An empty name stands for the window.
fn options_in_help(command: &str) -> Options {
    let arguments: Vec<_> = [command, "--help"].into_iter().filter(|argument| !argument.is_empty()).collect();
    let help = output(&arguments);
    let lines = help.lines().filter_map(|line| {
        let line = line.trim_start();
        let long = line.split_once(", ").filter(|(short, _)| short.len() == 2).map_or(line, |(_, long)| long);
        let name = long.strip_prefix("--")?;
        Some(format!("--{}", name.split([' ', '=']).next()?))
    });
    lines.filter(|option| option != "--help" && option != "--version").collect()
}

/// Names of options in a text, such as `--weld` in "`--weld TOLERANCE`".
fn options_in(text: &str) -> Options {
    let is_part = |c: char| c.is_ascii_lowercase() || c == '-';
    let words = text.split(|c: char| !is_part(c));
    let names = words.filter(|word| word.starts_with("--") && word.len() > 2 && !word.starts_with("---"));
    names.map(str::to_owned).collect()
}

/// The page's sections by their headings' anchors.
fn sections(page: &Page) -> BTreeMap<String, String> {
    let sections = page.text.split("\n## ").skip(1).filter_map(|section| section.split_once('\n'));
    sections.map(|(heading, text)| (heading.to_lowercase().replace(' ', "-"), text.to_owned())).collect()
}

/// Options in the first cells of a section's tables.
fn options_in_tables(section: &str) -> Options {
    let first = section.lines().filter_map(|line| line.strip_prefix("| `-")?.split(" | ").next());
    first.flat_map(|cell| options_in(&format!("-{cell}"))).collect()
}

/// Options that the manual lists for a command: in its section, and in those that its sentence "Takes the ..." links to.
fn options_in_manual(sections: &BTreeMap<String, String>, command: &str) -> Options {
    let heading = if command.is_empty() { "opening-the-window" } else { command };
    let section = sections.get(heading).unwrap_or_else(|| panic!("no section {heading}"));
    let takes = section.split("\n\n").filter(|part| part.trim_start().starts_with("Takes the "));
    let linked = takes.flat_map(|part| part.split("](#").skip(1)).filter_map(|rest| rest.split_once(')'));
    let shared = linked.flat_map(|(anchor, _)| options_in_tables(&sections[anchor]));
    options_in_tables(section).into_iter().chain(shared).collect()
}

#[test]
fn the_manual_lists_the_options_of_every_command() {
    let sections = sections(&Page::read("docs/manual/commands.md"));
    let help = output(&["--help"]);
    let names = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let names: BTreeSet<_> = names.filter_map(|line| line.split_whitespace().next()).collect();
    let known: BTreeSet<_> = COMMANDS.into_iter().chain(["help"]).collect();
    assert_eq!(names, known, "the commands of --help");
    for command in COMMANDS.into_iter().chain([""]) {
        assert_eq!(options_in_manual(&sections, command), options_in_help(command), "of {command:?}");
    }
}

#[test]
fn pages_name_only_existing_options() {
    let by_command: BTreeMap<_, _> = COMMANDS.into_iter().map(|command| (command, options_in_help(command))).collect();
    let all: Options = by_command.values().flatten().cloned().chain(["--help".into(), "--version".into()]).collect();
    let mut commands = 0;
    for page in user_pages() {
        for span in page.text.split('`').skip(1).step_by(2).filter(|span| span.starts_with("--")) {
            let unknown: Vec<_> = options_in(span).difference(&all).cloned().collect();
            assert_eq!(unknown, Vec::<String>::new(), "{} has `{span}`", page.name);
        }
        for line in page.text.lines().map(|line| line.trim_start().trim_start_matches("$ ")) {
            let Some(rest) = line.strip_prefix("pnaen ") else { continue };
            let command = rest.split_whitespace().next().unwrap_or_default();
            let Some(options) = by_command.get(command) else { continue };
            commands += 1;
            let unknown: Vec<_> =
                options_in(rest.split('#').next().unwrap_or(rest)).difference(options).cloned().collect();
            assert_eq!(unknown, Vec::<String>::new(), "{} has {line:?}", page.name);
        }
    }
    assert!(commands > 10, "only {commands} lines with commands were found");
}
