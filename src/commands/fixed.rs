//! Commands that don't depend on the window's state.

use egui::{Key, ThemePreference};

use super::availability as when;
use super::{
    Action, CameraAction, Change, Command, Direction, FileAction, Menu, QUIT, Submenu, ctrl, ctrl_shift, plain, shift,
};
use crate::mesh::Shape;
use crate::render::Standpoint;

/// What displacing by a height image does.
pub(crate) const HEIGHT_IMAGE: &str =
    "Displaces the mesh by the brightness of a PNG or JPEG image, which covers all materials.";

/// All of them, in the order of the menus.
pub(super) fn commands() -> Vec<Command> {
    [file(), edit(), view(), camera(), look(), tessellation(), help()].into_iter().flatten().collect()
}

const TRUTH: &str = "Opens the mesh that deviation and charts compare with, such as the high-poly original.";
const PICTURE: &str = "Writes the viewport's picture, at its size, as a PNG file.";
const MESH: &str = "Writes the tessellated mesh as a .glb or .obj file, as it is emitted for this view.";

fn file() -> Vec<Command> {
    use Menu::File;
    let mut commands = vec![
        Command::new(Action::File(FileAction::Open), "Open…", "Opens a mesh file.").keys([ctrl(Key::O)]).menu(File, 0),
        Command::new(
            Action::File(FileAction::OpenPath),
            "Open path…",
            "Opens a mesh file, a shape or a height image by its typed path.",
        )
        .keys([ctrl(Key::L)])
        .menu(File, 0),
        Command::new(Action::File(FileAction::HeightImage), "Height image…", HEIGHT_IMAGE)
            .menu(File, 1)
            .unless(when::document),
        Command::new(Action::File(FileAction::Reload), "Reload", "Loads the file again; settings and camera stay.")
            .keys([plain(Key::R)])
            .menu(File, 1)
            .unless(when::document),
        Command::new(Action::File(FileAction::Truth), "Reference surface…", TRUTH).menu(File, 2),
        Command::new(
            Action::File(FileAction::TruthPath),
            "Reference surface path…",
            "Opens a reference surface by its typed path.",
        )
        .menu(File, 2),
        Command::new(
            Action::File(FileAction::ForgetTruth),
            "No reference surface",
            "Goes back to the exact surface of a shape, or to the limit surface of the tessellation.",
        )
        .menu(File, 2)
        .unless(when::truth),
    ];
    commands.extend(Shape::ALL.map(|shape| {
        let text = format!("Opens the shape {}, made in code.", shape.name());
        Command::new(Action::File(FileAction::OpenShape(shape)), format!("Shape: {}", shape.title()), text)
            .submenu(Submenu::Shapes)
    }));
    commands.push(
        Command::new(
            Action::File(FileAction::OpenVase),
            "Shape: Vase",
            "Opens the painted vase that the window opens at a first start.",
        )
        .submenu(Submenu::Shapes),
    );
    commands.extend(writing());
    commands.push(
        Command::new(
            Action::ForgetEverything,
            "Forget all settings…",
            "Resets settings, theme and window size, and forgets recent files and their cameras. The mesh stays open.",
        )
        .menu(File, 5),
    );
    commands
        .push(Command::new(Action::File(FileAction::Quit), "Quit", "Closes the window.").keys([QUIT]).menu(File, 6));
    commands
}

/// Commands that write files.
fn writing() -> [Command; 5] {
    use Menu::File;
    [
        Command::new(Action::File(FileAction::SavePicture), "Save picture…", PICTURE)
            .keys([ctrl(Key::S)])
            .menu(File, 4)
            .unless(when::picture),
        Command::new(
            Action::File(FileAction::SavePicturePath),
            "Save picture path…",
            "Saves the picture as a PNG file at a typed path.",
        )
        .menu(File, 4)
        .unless(when::picture),
        Command::new(Action::File(FileAction::ExportMesh), "Export mesh…", MESH)
            .keys([ctrl(Key::E)])
            .menu(File, 4)
            .unless(when::export),
        Command::new(
            Action::File(FileAction::ExportMeshPath),
            "Export mesh path…",
            "Exports the tessellated mesh as a .glb or .obj file at a typed path.",
        )
        .menu(File, 4)
        .unless(when::export),
        Command::new(
            Action::File(FileAction::SaveChart),
            "Save chart…",
            "Writes the chart as a picture (.svg, .png) or a table (.csv).",
        )
        .unless(when::chart),
    ]
}

fn edit() -> Vec<Command> {
    use Menu::Edit;
    vec![
        Command::new(Action::Undo, "Undo", "Goes back to the settings before the last change.")
            .keys([ctrl(Key::Z)])
            .menu(Edit, 0)
            .unless(when::undo),
        Command::new(Action::Redo, "Redo", "Goes forward to the settings that were undone.")
            .keys([ctrl_shift(Key::Z)])
            .menu(Edit, 0)
            .unless(when::redo),
        Command::new(
            Action::CopyAsCommand,
            "Copy as command",
            "Copies the pnaen command that draws this picture without a window.",
        )
        .keys([ctrl(Key::K)])
        .menu(Edit, 1)
        .unless(when::document),
        Command::new(
            Action::ResetSettings,
            "Reset settings",
            "Sets every setting to its value at the first start. This can be undone.",
        )
        .menu(Edit, 2),
    ]
}

fn view() -> Vec<Command> {
    use Menu::View;
    let look = |standpoint, name: &'static str, text: &'static str, key| {
        Command::new(Action::Camera(CameraAction::LookFrom(standpoint)), name, text).keys([plain(key)]).menu(View, 0)
    };
    let theme =
        |theme, name: &'static str, text: &'static str| Command::new(Action::Theme(theme), name, text).menu(View, 3);
    vec![
        Command::new(Action::Camera(CameraAction::Frame), "Frame", "Shows all of the mesh.")
            .keys([plain(Key::F)])
            .menu(View, 0),
        Command::new(
            Action::Camera(CameraAction::FramePatch),
            "Frame patch",
            "Turns the camera to the selected patch.",
        )
        .keys([shift(Key::F)])
        .menu(View, 0)
        .unless(when::selected_patch),
        look(Standpoint::Front, "Front", "Looks from the front.", Key::Num1),
        look(Standpoint::Right, "Right", "Looks from the right.", Key::Num3),
        look(Standpoint::Top, "Top", "Looks from the top.", Key::Num7),
        Command::new(
            Action::Camera(CameraAction::Orthographic),
            "Orthographic",
            "Switches between perspective and orthographic projection.",
        )
        .keys([plain(Key::Num5)])
        .menu(View, 0),
        Command::new(
            Action::Chart,
            "Chart",
            "Shows or hides the chart of speed against accuracy for this mesh in this view.",
        )
        .keys([plain(Key::G)])
        .menu(View, 1),
        Command::new(Action::MeasureChart, "Measure chart", "Measures the settings that are missing from the chart.")
            .unless(when::measure_chart),
        Command::new(Action::HidePanels, "Hide panels", "Hides the panels on both sides, or shows them again.")
            .keys([ctrl(Key::B)])
            .menu(View, 1),
        Command::new(Action::OpenAllSections, "Open all sections", "Opens every section of both panels.").menu(View, 1),
        Command::new(Action::FoldAllSections, "Fold all sections", "Folds every section of both panels.").menu(View, 1),
        Command::new(Action::Warnings, "Warnings…", "Lists what was repaired or left out when the file was read.")
            .menu(View, 1)
            .unless(when::document),
        Command::new(Action::LargerText, "Larger text", "Makes everything in the window larger.")
            .keys([ctrl(Key::Plus), ctrl(Key::Equals)])
            .menu(View, 2),
        Command::new(Action::SmallerText, "Smaller text", "Makes everything in the window smaller.")
            .keys([ctrl(Key::Minus)])
            .menu(View, 2),
        Command::new(Action::UsualText, "Usual text size", "Makes everything in the window as large as usual.")
            .keys([ctrl(Key::Num0)])
            .menu(View, 2),
        theme(ThemePreference::System, "Theme of the system", "Follows the desktop's theme, light or dark."),
        theme(ThemePreference::Light, "Light theme", "Draws the window dark on light."),
        theme(ThemePreference::Dark, "Dark theme", "Draws the window light on dark."),
    ]
}

/// Commands that move the camera with keys.
fn camera() -> Vec<Command> {
    use Direction::{Down, Left, Right, Up};
    let mut commands = Vec::new();
    for (direction, orbit, pan, key) in [
        (Left, "Orbit left", "Pan left", Key::ArrowLeft),
        (Right, "Orbit right", "Pan right", Key::ArrowRight),
        (Up, "Orbit up", "Pan up", Key::ArrowUp),
        (Down, "Orbit down", "Pan down", Key::ArrowDown),
    ] {
        let turns = "Turns the camera around the mesh by 7.5 degrees.";
        commands.push(Command::new(Action::Camera(CameraAction::Orbit(direction)), orbit, turns).keys([plain(key)]));
        commands.push(
            Command::new(Action::Camera(CameraAction::Pan(direction)), pan, "Moves the camera by 40 points.")
                .keys([shift(key)]),
        );
    }
    commands.push(
        Command::new(Action::Camera(CameraAction::ZoomIn), "Zoom in", "Moves the camera closer.")
            .keys([plain(Key::PageUp)]),
    );
    commands.push(
        Command::new(Action::Camera(CameraAction::ZoomOut), "Zoom out", "Moves the camera away.")
            .keys([plain(Key::PageDown)]),
    );
    commands
}

/// Commands about the picture and the selection.
fn look() -> Vec<Command> {
    vec![
        Command::new(
            Action::SplitView,
            "Split view",
            "Shows the untessellated mesh or another surface left of a divider, from the same camera.",
        )
        .keys([plain(Key::S)]),
        Command::new(Action::Background, "Background colour…", "Chooses the colour behind the mesh."),
        Command::new(
            Action::PlayOrPause,
            "Play or pause",
            "Plays the animation clip, the first one if none is chosen, or pauses it.",
        )
        .keys([plain(Key::Space)])
        .unless(when::clips),
        Command::new(Action::Deselect, "Deselect", "Clears the selection.").unless(when::selection),
        Command::new(
            Action::Cancel,
            "Cancel",
            "Stops a drawing that takes long. If there is none, closes messages, cancels loading and exporting, and \
             deselects.",
        )
        .keys([plain(Key::Escape)]),
    ]
}

fn tessellation() -> Vec<Command> {
    vec![
        Command::new(Action::Setting(Change::FactorUp), "Factor up", "Makes the tessellation factor larger by 1.")
            .keys([plain(Key::Plus), plain(Key::Equals)])
            .unless(when::factor),
        Command::new(Action::Setting(Change::FactorDown), "Factor down", "Makes the tessellation factor smaller by 1.")
            .keys([plain(Key::Minus)])
            .unless(when::factor),
        Command::new(
            Action::Setting(Change::AdaptiveLod),
            "Adaptive LOD",
            "Switches between adaptive LOD and one factor everywhere.",
        )
        .keys([plain(Key::L)])
        .unless(when::lod),
        Command::new(
            Action::Setting(Change::ToggleEdges),
            "Edges as published or shared",
            "Switches between computing shared edges once (watertight) and by each patch (as published).",
        )
        .keys([plain(Key::E)]),
        Command::new(
            Action::Setting(Change::CullBackFaces),
            "Cull back faces",
            "Switches whether patches that show only their backs are left out.",
        )
        .unless(when::culling),
        Command::new(
            Action::FreezeLodCamera,
            "Freeze LOD camera",
            "Keeps LOD and clipping as they are for this camera while you look from elsewhere.",
        )
        .keys([plain(Key::Z)])
        .unless(when::picture),
        Command::new(Action::ToggleDisplacement, "Displacement", "Switches displacement by heights on or off.")
            .keys([plain(Key::D)])
            .unless(when::heights),
    ]
}

fn help() -> Vec<Command> {
    use Menu::Help;
    vec![
        Command::new(Action::SearchCommands, "Search commands…", "Finds any command by its name.")
            .keys([ctrl(Key::P)])
            .menu(Help, 0),
        Command::new(Action::Keys, "Keys…", "Lists every key and what it does.").menu(Help, 0),
        Command::new(
            Action::WhitePaper,
            "The PN-AEN white paper",
            "Opens McDonald and Kilgard's paper of 2010 in the web browser.",
        )
        .menu(Help, 0),
    ]
}
