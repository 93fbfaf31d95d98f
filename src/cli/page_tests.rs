//! The tables of options in the manual's page of commands, `docs/manual/commands.md`. `PNAEN_UPDATE_PAGES=1` writes them again.

use std::collections::BTreeSet;
use std::path::Path;

use clap::{Arg, Args, CommandFactory};

use super::Cli;
use super::adapters::AdapterOption;
use super::gate_options::GateOptions;
use super::options::{SurfaceOptions, WeldOption};
use super::shot_options::ShotOptions;
use inspect::gates::GateKind;
use load::markdown::{listed, table};

const BEGINS: &str = "<!-- options of ";
const ENDS: &str = "<!-- end of options -->";

/// Options that several commands have, with their heading.
struct Group {
    name: &'static str,
    options: Vec<Arg>,
}

fn options_of<T: Args>() -> Vec<Arg> {
    visible(&T::augment_args(clap::Command::new("pnaen")))
}

fn visible(command: &clap::Command) -> Vec<Arg> {
    let is_shown = |arg: &&Arg| {
        arg.get_long().is_some() && !arg.is_hide_set() && !["help", "version"].contains(&arg.get_id().as_str())
    };
    command.get_arguments().filter(is_shown).cloned().collect()
}

fn ids(options: &[Arg]) -> BTreeSet<&str> {
    options.iter().map(|arg| arg.get_id().as_str()).collect()
}

/// Those of `all` that aren't among `others`.
fn without(all: Vec<Arg>, others: &[Arg]) -> Vec<Arg> {
    let others = ids(others);
    all.into_iter().filter(|arg| !others.contains(arg.get_id().as_str())).collect()
}

fn groups() -> [Group; 5] {
    let (mesh, surface) = (options_of::<WeldOption>(), options_of::<SurfaceOptions>());
    let picture = without(options_of::<ShotOptions>(), &surface);
    [
        Group { name: "tessellation", options: without(surface, &mesh) },
        Group { name: "mesh", options: mesh },
        Group { name: "picture", options: picture },
        Group { name: "gate", options: options_of::<GateOptions>() },
        Group { name: "adapter", options: options_of::<AdapterOption>() },
    ]
}

fn row(arg: &Arg) -> Vec<String> {
    let value = match arg.get_action().takes_values() {
        true => arg.get_value_names().map_or(String::new(), |names| format!(" {}", names.join(" "))),
        false => String::new(),
    };
    let short = arg.get_short().map_or(String::new(), |short| format!("`-{short}`, "));
    let default: Vec<_> = arg.get_default_values().iter().map(|value| value.to_string_lossy().into_owned()).collect();
    let default = match (arg.is_required_set(), default.join(",")) {
        (true, _) => "required".to_owned(),
        (false, default) if default.is_empty() || !arg.get_action().takes_values() => String::new(),
        (false, default) => format!("`{default}`"),
    };
    let help = arg.get_help().map(ToString::to_string).unwrap_or_default().replace('\n', " ");
    // `--help` says the rest.
    let help = first_sentence(&help);
    let values: Vec<_> = arg.get_possible_values().iter().map(|value| format!("`{}`", value.get_name())).collect();
    let values = if values.is_empty() || !arg.get_action().takes_values() {
        String::new()
    } else {
        format!(": {}", values.join(", "))
    };
    let escaped = |text: &str| text.replace('|', "\\|").replace('<', "&lt;").replace('\n', " ");
    vec![
        format!("{short}`--{}{}`", arg.get_long().unwrap_or_default(), escaped(&value)),
        escaped(&default),
        escaped(help) + &values,
    ]
}

/// A text up to its first full stop that isn't one of "et al.".
fn first_sentence(text: &str) -> &str {
    let ends = text.match_indices(". ").map(|(at, _)| at).find(|at| !text[..*at].ends_with("et al"));
    ends.map_or(text, |end| &text[..end])
}

fn rows(options: &[Arg]) -> String {
    match options {
        [] => String::new(),
        _ => table(&["option", "default", "what it does"], &[0, 1, 2], &options.iter().map(row).collect::<Vec<_>>()),
    }
}

fn link(group: &Group) -> String {
    format!("[{0} options](#{0}-options)", group.name)
}

/// The options of a command: the groups that it has, and a table of all others.
fn of_command(command: &clap::Command) -> String {
    let (mut own, mut whole, mut parts) = (visible(command), Vec::new(), String::new());
    for group in groups() {
        let is_own = |arg: &&Arg| own.iter().any(|own| own.get_id() == arg.get_id() && row(own) == row(arg));
        let common: Vec<_> = group.options.iter().filter(is_own).collect();
        if common.len() == group.options.len() {
            whole.push(format!("the {}", link(&group)));
        } else if !common.is_empty() {
            let names: Vec<_> =
                common.iter().map(|arg| format!("`--{}`", arg.get_long().unwrap_or_default())).collect();
            parts += &format!("| {} | | See {}. |\n", names.join(", "), link(&group));
        } else {
            continue;
        }
        let common: Vec<_> = common.into_iter().cloned().collect();
        own = without(own, &common);
    }
    let whole = if whole.is_empty() { String::new() } else { format!("Takes {}.\n\n", listed(&whole)) };
    let table = if own.is_empty() && !parts.is_empty() {
        table(&["option", "default", "what it does"], &[0, 1, 2], &[])
    } else {
        rows(&own)
    };
    format!("{whole}{table}{parts}")
}

/// The text between the marks of a name.
fn generated(name: &str) -> String {
    if let Some(group) = groups().iter().find(|group| group.name == name) {
        return rows(&group.options);
    }
    let all = Cli::command();
    match name {
        "the window" => of_command(&all),
        _ => of_command(all.find_subcommand(name).unwrap_or_else(|| panic!("no command {name:?}"))),
    }
}

/// The page with its tables made anew.
fn with_tables(page: &str) -> String {
    let mut parts = page.split(BEGINS);
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (name, rest) = part.split_once(" -->").expect("a mark ends");
        let (_, after) = rest.split_once(ENDS).expect("a table ends");
        text += &format!("{BEGINS}{name} -->\n\n{}\n{ENDS}{after}", generated(name));
    }
    text
}

#[test]
fn the_manuals_tables_of_options_are_those_of_the_commands() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/manual/commands.md");
    let kept = std::fs::read_to_string(&path).unwrap();
    let page = with_tables(&kept);
    assert!(
        Cli::command().get_subcommands().all(|command| page.contains(&format!("{BEGINS}{} -->", command.get_name())))
    );
    if std::env::var_os("PNAEN_UPDATE_PAGES").is_some() {
        std::fs::write(&path, &page).unwrap();
    } else {
        assert!(kept == page, "commands.md is out of date; PNAEN_UPDATE_PAGES=1 writes it");
    }
}

#[test]
fn the_manuals_table_of_gates_has_each_gate_once() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/manual/measuring.md");
    let page = std::fs::read_to_string(&path).unwrap();
    let (_, section) = page.split_once("| gate | counts |\n| --- | --- |\n").expect("the table");
    let rows = section.lines().take_while(|line| line.starts_with('|'));
    let named = rows.filter_map(|row| row.split('|').nth(1)).flat_map(|cell| cell.split(", "));
    let named: Vec<_> = named.map(|gate| gate.trim().trim_matches('`').to_owned()).collect();
    assert_eq!(named, GateKind::ALL.map(GateKind::placeholder));
}
