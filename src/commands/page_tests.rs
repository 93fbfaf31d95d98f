//! The manual's page of keys and commands, `docs/manual/keys.md`. `PNAEN_UPDATE_PAGES=1` writes it again.

use std::collections::BTreeMap;
use std::path::Path;

use super::{Availability, Command, GESTURES, Place, all, key_names};
use load::markdown::{plain, table};

/// The page: what the pointer does, the commands with keys, and the names of those without.
fn page() -> String {
    let gestures = GESTURES.map(|(gesture, text)| vec![gesture.to_owned(), text.to_owned()]);
    let (with_keys, without): (Vec<_>, Vec<_>) =
        all(&Availability::default()).into_iter().partition(|command| !command.keys.is_empty());
    let keyed =
        |command: &Command| vec![plain(&key_names(&command.keys)), plain(&command.name), menu(command).to_owned()];
    let mut by_menu: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for command in &without {
        by_menu.entry(menu(command)).or_default().push(plain(&command.name));
    }
    let listed = by_menu.into_iter().map(|(menu, names)| {
        let place = if menu.is_empty() { "found by name alone" } else { menu };
        format!("- **{place}**: {}\n", joined(&names))
    });
    format!(
        "# Keys and commands\n\n\
         Ctrl is Cmd on macOS. In the window, Help > Keys lists the keys, and Ctrl+P finds \
         every command by its name and says what it does.\n\n\
         ## In the picture\n\n{}\n\
         ## Keys\n\n{}\n\
         ## Commands without a key\n\n\
         By menu. Ctrl+P also finds recent files and the mesh's animation clips by their names.\n\n{}",
        table(&["pointer", "what it does"], &[0, 1], &gestures),
        table(&["key", "command", "menu"], &[0, 1, 2], &with_keys.iter().map(keyed).collect::<Vec<_>>()),
        listed.collect::<String>(),
    )
}

/// All names in their order; the values of an option, which begin alike up to a colon, as one.
fn joined(names: &[String]) -> String {
    let beginning = |name: &String| name.split_once(": ").map(|(beginning, _)| beginning.to_owned());
    let groups = names.chunk_by(|a, b| beginning(a).is_some() && beginning(a) == beginning(b));
    let said = |group: &[String]| match group {
        [one] => one.clone(),
        several => format!("{}: each value", several.first().and_then(beginning).unwrap_or_default()),
    };
    groups.map(said).collect::<Vec<_>>().join("; ")
}

/// The menu that a command is in; empty if it is in none.
fn menu(command: &Command) -> &'static str {
    match command.place {
        Some(Place::Menu(menu, _)) => menu.name(),
        Some(Place::Submenu(submenu)) => submenu.name(),
        None => "",
    }
}

#[test]
fn the_manuals_page_of_keys_is_the_table() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/manual/keys.md");
    let page = page();
    if std::env::var_os("PNAEN_UPDATE_PAGES").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, &page).unwrap();
    }
    assert!(
        std::fs::read_to_string(&path).is_ok_and(|kept| kept == page),
        "keys.md is out of date; PNAEN_UPDATE_PAGES=1 writes it"
    );
}
