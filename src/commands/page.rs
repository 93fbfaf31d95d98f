//! The manual's page of keys and commands, `docs/manual/keys.md`. `PNAEN_UPDATE_PAGES=1` writes it again.

use std::path::Path;

use super::{Availability, Command, GESTURES, Place, all, key_names};
use load::markdown::{plain, table};

/// The page: what the pointer does, the commands with keys, and those without.
fn page() -> String {
    let gestures = GESTURES.map(|(gesture, text)| vec![gesture.to_owned(), text.to_owned()]);
    let (with_keys, without): (Vec<_>, Vec<_>) =
        all(&Availability::default()).into_iter().partition(|command| !command.keys.is_empty());
    format!(
        "# Keys and commands\n\n\
         Ctrl is Cmd on macOS. The window lists the keys under Help > Keys, and finds every command by its name with Ctrl+P.\n\n\
         ## In the picture\n\n{}\n\
         ## Keys\n\n{}\n\
         ## Commands without a key\n\n\
         Besides these, recent files and the mesh's animation clips are found by their names.\n\n{}",
        table(&["pointer", "what it does"], &[0, 1], &gestures),
        table(
            &["key", "command", "menu", "what it does"],
            &[0, 1, 2, 3],
            &with_keys.iter().map(keyed).collect::<Vec<_>>()
        ),
        table(&["command", "menu", "what it does"], &[0, 1, 2], &without.iter().map(row).collect::<Vec<_>>()),
    )
}

fn keyed(command: &Command) -> Vec<String> {
    [vec![plain(&key_names(&command.keys))], row(command)].concat()
}

fn row(command: &Command) -> Vec<String> {
    let menu = match command.place {
        Some(Place::Menu(menu, _)) => menu.name().to_owned(),
        Some(Place::Submenu(submenu)) => submenu.name().to_owned(),
        None => String::new(),
    };
    vec![plain(&command.name), menu, plain(&command.text)]
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
