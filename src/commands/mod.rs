//! Everything that a person can do in the window, in one table. Menus, keys, the search for commands, Help > Keys and the
//! manual's page of keys are made from it; the window performs an [`Action`].

mod availability;
mod change;
mod fixed;
mod generated;
#[cfg(test)]
mod page_tests;

use std::borrow::Cow;
use std::sync::LazyLock;

use egui::{Key, KeyboardShortcut, Modifiers};
use glam::IVec2;

use geometry::choice::texts;
use geometry::names::every;
use inspect::render::Standpoint;
use load::{HeightSource, Source};

pub use availability::{Availability, Need};
pub(crate) use availability::{BACKS_ARE_SEEN, MADE_IN_CODE, MOST_BOOKMARKS};
pub use change::Change;
pub use fixed::ENVIRONMENT;
pub(crate) use fixed::{
    CLOSE_ENVIRONMENT, CLOSE_LOD_SHADER, CLOSE_SURFACE_SHADER, HEIGHT_IMAGE, LEFT_MESH, MATCAP_IMAGE,
};

/// What the window does when a command is given.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    File(FileAction),
    Camera(CameraAction),
    Setting(Change),
    Prepare(Preparing),
    Undo,
    Redo,
    CopyAsCommand,
    CopyPicture,
    ResetSettings,
    ForgetEverything,
    SplitView,
    KeepOnLeft,
    HidePanels,
    FocusControls,
    OpenAllSections,
    FoldAllSections,
    Warnings,
    FreezeLodCamera,
    Ruler,
    Previews,
    AddBookmark,
    ForgetBookmarks,
    Background,
    Chart,
    MeasureChart,
    WidestCrack,
    /// The next place of the finding that is shown.
    NextPlace,
    PreviousPlace,
    Theme(egui::ThemePreference),
    LargerText,
    SmallerText,
    UsualText,
    ToggleDisplacement,
    PlayOrPause,
    /// None is the mesh at rest; otherwise an index into the mesh's clips.
    AnimationClip(Option<usize>),
    Deselect,
    Cancel,
    SearchCommands,
    Keys,
    WhitePaper,
}

/// Lets commands name what they do without the variant of [`Action`] that holds it.
macro_rules! actions_from {
    ($($variant:ident($of:ty)),+) => {
        $(impl From<$of> for Action {
            fn from(of: $of) -> Self {
                Self::$variant(of)
            }
        })+
    };
}

actions_from!(File(FileAction), Camera(CameraAction), Setting(Change), Prepare(Preparing));

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileAction {
    /// With the desktop's dialog, or a typed path where there is none.
    Ask(Purpose),
    OpenPath,
    /// A shape, or a file that was opened before.
    OpenSource(Source),
    Reload,
    /// The next mesh of the folder, or of those that were dropped together.
    NextMesh,
    PreviousMesh,
    Close(CompanionFile),
    /// Shows the mesh before its file changed beside the new one.
    CompareWithBefore,
    /// Compares the mesh with the limit of its own cage.
    CompareWithOwnLimit,
    /// Opens the window that chooses how a picture is saved.
    SavePicture,
    SaveTurntable,
    Quit,
}

/// What can be open beside the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CompanionFile {
    /// The mesh left of the split.
    LeftMesh,
    /// The reference surface.
    ReferenceShape,
    Factors,
    LodShader,
    SurfaceShader,
    /// A picture of a lit sphere.
    Matcap,
    Environment,
}

impl CompanionFile {
    /// Those that their source says all about. What is left of the split is more.
    pub const BY_SOURCE: [Self; 6] = {
        let [_, others @ ..] =
            every![CompanionFile: LeftMesh, ReferenceShape, Factors, LodShader, SurfaceShader, Matcap, Environment];
        others
    };
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Written {
    Chart,
    Picture,
    /// A turntable as PNG files.
    Folder,
    Gif,
    Factors,
    Adjacency,
    Stats,
    /// The tessellated mesh.
    Mesh,
}

/// What the window asks a file for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    Open,
    Heights,
    /// The height image of the part that was chosen last.
    PartHeights,
    CompanionFile(CompanionFile),
    Write(Written),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraAction {
    Frame,
    FramePatch,
    LookFrom(Standpoint),
    /// The view before the last movement.
    Before,
    After,
    /// An index into the bookmarks.
    Bookmark(usize),
    /// Through a camera of the file: an index into the mesh's cameras.
    OfFile(usize),
    ThroughFrozen,
    Orthographic,
    /// By so many steps to the right and upwards.
    Orbit(IVec2),
    Pan(IVec2),
    ZoomIn,
    ZoomOut,
}

/// A change of how the mesh is prepared when it is loaded.
#[derive(Clone, Debug, PartialEq)]
pub enum Preparing {
    /// The height map; none for those of the file.
    Heights(Option<HeightSource>),
    /// As a part of the bounding diagonal; 0 joins equal positions only.
    Weld(f32),
    /// The width of the crease band as a part of the bounding diagonal; 0 is none.
    CreaseBand(f32),
}

texts! {
    /// A menu of the menu bar.
    pub enum Menu, fn name {
        File => "File",
        Edit => "Edit",
        View => "View",
        Help => "Help",
    }
}

impl Menu {
    /// The submenus of this menu, each with the number of its group.
    pub fn submenus(self) -> &'static [(u8, Submenu)] {
        match self {
            Self::File => &[(0, Submenu::OpenRecent), (3, Submenu::Shapes)],
            Self::View => &[(0, Submenu::LookFrom), (0, Submenu::FileCameras), (0, Submenu::Bookmarks)],
            _ => &[],
        }
    }
}

texts! {
    pub enum Submenu, fn name {
        OpenRecent => "Open recent",
        Shapes => "Shapes",
        Bookmarks => "Bookmarks",
        LookFrom => "Look from",
        FileCameras => "Cameras of the file",
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// In a menu, in its group of this number; lines separate the groups.
    Menu(Menu, u8),
    Submenu(Submenu),
}

/// Something that a person can do.
#[derive(Clone, Debug)]
pub struct Command {
    pub action: Action,
    /// Its name in menus and in the search. A value of a setting has the setting's name in front ("Surface: PN").
    pub name: Cow<'static, str>,
    /// What it does, in a sentence.
    pub text: Cow<'static, str>,
    /// Keys that do the same, the usual one first.
    pub keys: Vec<KeyboardShortcut>,
    pub place: Option<Place>,
    needs: &'static [Need],
}

impl Command {
    /// A command that is always possible, without keys, and in no menu.
    fn new(action: impl Into<Action>, name: impl Into<Cow<'static, str>>, text: impl Into<Cow<'static, str>>) -> Self {
        let (action, name, text) = (action.into(), name.into(), text.into());
        Self { action, name, text, keys: Vec::new(), place: None, needs: &[] }
    }

    fn below(submenu: Submenu, action: impl Into<Action>, name: String, text: impl Into<Cow<'static, str>>) -> Self {
        Self { place: Some(Place::Submenu(submenu)), ..Self::new(action, name, text) }
    }

    /// Why it is not possible now, in a sentence; none if it is.
    pub fn why_not(&self, now: &Availability) -> Option<&'static str> {
        now.why_not(self.needs)
    }

    /// The name without the setting's name in front: "PN" for "Surface: PN".
    pub fn value_name(&self) -> &str {
        self.name.split_once(": ").map_or(&self.name, |(_, value)| value)
    }

    /// Whether its keys work even while text is being typed or a window asks for something.
    pub fn works_while_typing(&self) -> bool {
        use Action::{Cancel, File, LargerText, SearchCommands, SmallerText, UsualText};
        use FileAction::{Ask, OpenPath, Quit};
        let is_of_text = matches!(self.action, LargerText | SmallerText | UsualText);
        is_of_text || matches!(self.action, File(Ask(Purpose::Open) | OpenPath | Quit) | Cancel | SearchCommands)
    }

    /// Whether its keys are left to a control that has the focus, which they move or press.
    pub fn yields_to_focus(&self) -> bool {
        use CameraAction::{Orbit, Pan, ZoomIn, ZoomOut};
        matches!(self.action, Action::Camera(Orbit(_) | Pan(_) | ZoomIn | ZoomOut) | Action::PlayOrPause)
    }
}

/// The keys of an action as hover texts name them; empty without any.
pub(crate) fn key_name(action: &Action) -> &'static str {
    static NAMES: LazyLock<Vec<(Action, String)>> = LazyLock::new(|| {
        let named = |command: Command| (command.action, key_names(&command.keys));
        all(&Availability::default()).into_iter().map(named).collect()
    });
    NAMES.iter().find(|(known, _)| known == action).map_or("", |(_, names)| names)
}

/// Appends the keys of an action, if it has some, to a sentence.
pub(crate) fn with_key(sentence: &str, action: &Action) -> String {
    with_note(sentence, key_name(action))
}

/// A sentence with a note in parentheses at its end, if there is one.
pub(crate) fn with_note(sentence: &str, note: &str) -> String {
    if note.is_empty() { sentence.to_owned() } else { format!("{} ({note}).", sentence.trim_end_matches('.')) }
}

/// The names of keys as on a PC, on any platform.
pub(crate) fn key_names(keys: &[KeyboardShortcut]) -> String {
    let name = |key: &KeyboardShortcut| with_symbols(key.format(&egui::ModifierNames::NAMES, false));
    keys.iter().map(name).collect::<Vec<_>>().join(", ")
}

/// The name of a key on this platform, as menus show it.
pub(crate) fn shown_key(context: &egui::Context, key: &KeyboardShortcut) -> String {
    with_symbols(context.format_shortcut(key))
}

/// egui has words for brackets, but keyboards have the brackets.
fn with_symbols(name: String) -> String {
    name.replace("OpenBracket", "[").replace("CloseBracket", "]")
}

pub fn all(now: &Availability) -> Vec<Command> {
    [fixed::commands(), generated::commands(now)].into_iter().flatten().collect()
}

/// The shortcut that closes the window, for a screen that has no other command.
pub(crate) const QUIT: KeyboardShortcut = ctrl(Key::Q);

/// What the pointer does in the picture. These aren't commands, but they are listed with the keys.
pub const GESTURES: [(&str, &str); 4] = [
    ("Click", "Selects the triangle, its patch and its nearest edge."),
    ("Left drag", "Orbits."),
    ("Middle drag, Shift+left drag", "Pans."),
    ("Wheel", "Zooms to the pointer."),
];

const fn plain(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::NONE, key)
}

const fn shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::SHIFT, key)
}

const fn alt(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::ALT, key)
}

const fn ctrl(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND, key)
}

const fn ctrl_shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), key)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_names_and_actions_are_unique() {
        let all = all(&Availability::default());
        for (i, command) in all.iter().enumerate() {
            for other in &all[..i] {
                assert_ne!(command.name, other.name);
                assert_ne!(command.action, other.action, "{}", command.name);
                let shared = command.keys.iter().find(|key| other.keys.contains(key));
                assert_eq!(shared, None, "{} and {}", command.name, other.name);
            }
        }
    }

    #[test]
    fn every_command_says_what_it_does_in_a_sentence() {
        for command in all(&Availability::default()) {
            assert!(command.text.ends_with('.') && command.text.len() > 8, "{}: {}", command.name, command.text);
        }
    }

    #[test]
    fn a_sentence_names_the_keys() {
        assert_eq!(with_key("Quits.", &Action::File(FileAction::Quit)), "Quits (Ctrl+Q).");
        assert_eq!(with_key("Resets.", &Action::ResetSettings), "Resets.");
    }

    #[test]
    fn reasons_are_sentences_and_every_command_is_possible_in_a_full_state() {
        let nothing = Availability::default();
        let everything = Availability::everything();
        for command in all(&everything) {
            let why_not = command.why_not(&nothing);
            assert!(why_not.is_none_or(|why| why.ends_with('.')), "{}: {why_not:?}", command.name);
            assert_eq!(command.why_not(&everything), None, "{}", command.name);
        }
        let possible = all(&nothing).iter().filter(|command| command.why_not(&nothing).is_none()).count();
        assert!(possible > 40 && possible < all(&nothing).len(), "{possible}");
    }
}
