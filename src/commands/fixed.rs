//! Commands that don't depend on the window's state.

use egui::{Key, ThemePreference};

use super::{
    Action, CameraAction, Change, Command, CompanionFile, Direction, FileAction, Menu, Need, Purpose, QUIT, Submenu,
    Written, ctrl, ctrl_shift, plain, shift,
};
use geometry::mesh::Shape;
use inspect::render::Standpoint;

pub(crate) const HEIGHT_IMAGE: &str =
    "Displaces the mesh by the brightness of a PNG, JPEG or WebP image, which covers all materials.";

/// All of them, in the order of the menus.
pub(super) fn commands() -> Vec<Command> {
    [file(), edit(), view(), standpoints(), camera(), look(), tessellation(), help()].into_iter().flatten().collect()
}

/// What a picture of a lit sphere is for.
pub(crate) const MATCAP_IMAGE: &str =
    "Opens a PNG, JPEG or WebP image of a lit sphere, and shows the surface in its colours.";

const FACTORS: &str = "Opens the tessellation factors that another engine wrote, in place of those of LOD, and lists \
                       where they disagree.";

/// What functions of the user's own are for.
const LOD_SHADER: &str =
    "Opens a WGSL file with your own function for factors in place of LOD, and follows its changes.";

const SURFACE_SHADER: &str = "Opens a WGSL file with your own function for the control points of edges in place of a \
                              surface, and follows its changes.";

pub const ENVIRONMENT: &str =
    "Opens a panorama (.hdr or .exr) whose light shines on the mesh in place of the studio's.";

pub(crate) const CLOSE_LOD_SHADER: &str = "Closes the LOD shader. LOD computes factors again.";
pub(crate) const CLOSE_SURFACE_SHADER: &str = "Closes the surface shader. The surface that was chosen before is back.";
pub(crate) const CLOSE_ENVIRONMENT: &str = "Close the environment map; studio light is used again.";
pub(crate) const LEFT_MESH: &str = "The mesh left of the split: the same one, or that of another file, such as an earlier export or the high-poly original.";
const REFERENCE_SURFACE: &str =
    "Opens the mesh that deviation and charts compare with, such as the high-poly original.";
const PICTURE: &str = "Writes the picture as a PNG file, or a report on it as a page, in any size, with or without background, overlays and legend.";
const MESH: &str = "Writes the tessellated mesh as a .glb or .obj file, as it is emitted for this view.";

fn file() -> Vec<Command> {
    use Menu::{Edit, File};
    let document: &[Need] = &[Need::Document];
    let beside = |beside, name: &'static str, text: &'static str| ask(Purpose::CompanionFile(beside), name, text);
    let close = |beside, need: &'static [Need], name: &'static str, text: &'static str| {
        Command::new(FileAction::Close(beside), name).text(text).needs(need)
    };
    let usual_surface = "Goes back to the exact surface of a shape, or to the limit surface of the tessellation.";
    let same_mesh = "Shows the mesh that is open in both halves.";
    let lod_factors = "Closes the file of factors. LOD computes them again.";
    let path_text = "Opens a mesh file, a shape, a height image or an environment by its typed path.";
    let mut commands = vec![
        ask(Purpose::Open, "Open…", "Opens a mesh file.").keys([ctrl(Key::O)]).menu(File, 0),
        Command::new(FileAction::OpenPath, "Open path…").text(path_text).keys([ctrl(Key::L)]).menu(File, 0),
        ask(Purpose::Heights, "Height image…", HEIGHT_IMAGE).menu(File, 1).needs(document),
        beside(CompanionFile::Matcap, "Matcap image…", MATCAP_IMAGE).menu(File, 1).needs(document),
        Command::new(FileAction::Reload, "Reload")
            .text("Loads the file again; settings and camera stay.")
            .keys([plain(Key::R)])
            .menu(File, 1)
            .needs(document),
        Command::new(FileAction::NextMesh, "Next mesh")
            .text("Opens the next mesh of the folder, or of the files that were dropped together. After the last one comes the first.")
            .keys([ctrl(Key::PageDown)])
            .menu(File, 0)
            .needs(&[Need::Neighbours]),
        Command::new(FileAction::PreviousMesh, "Previous mesh")
            .text("Opens the mesh before this one in the folder, or among the files that were dropped together.")
            .keys([ctrl(Key::PageUp)])
            .menu(File, 0)
            .needs(&[Need::Neighbours]),
        beside(CompanionFile::ReferenceShape, "Reference surface…", REFERENCE_SURFACE).menu(File, 2),
        close(CompanionFile::ReferenceShape, &[Need::ReferenceShape], "Forget reference surface", usual_surface)
            .menu(File, 2),
        beside(CompanionFile::LeftMesh, "Mesh left of the split…", LEFT_MESH).needs(document),
        close(CompanionFile::LeftMesh, &[Need::LeftMesh], "The same mesh left of the split", same_mesh),
        Command::new(FileAction::CompareWithBefore, "Compare with before the change")
            .text("Shows the mesh as it was before its file changed left of the split, tessellated as the new one is.")
            .needs(&[Need::Before]),
        beside(CompanionFile::Factors, "Factors of a file…", FACTORS).menu(File, 2).needs(document),
        close(CompanionFile::Factors, &[Need::Factors], "Close the factors file", lod_factors).menu(File, 2),
        beside(CompanionFile::LodShader, "LOD shader…", LOD_SHADER).menu(Edit, 2).needs(document),
        close(CompanionFile::LodShader, &[Need::LodShader], "Close the LOD shader", CLOSE_LOD_SHADER).menu(Edit, 2),
        beside(CompanionFile::SurfaceShader, "Surface shader…", SURFACE_SHADER).menu(Edit, 2).needs(document),
        close(CompanionFile::SurfaceShader, &[Need::SurfaceShader], "Close the surface shader", CLOSE_SURFACE_SHADER)
            .menu(Edit, 2),
        beside(CompanionFile::Environment, "Open environment…", ENVIRONMENT).menu(File, 2),
        close(CompanionFile::Environment, &[Need::Environment], "Close environment", CLOSE_ENVIRONMENT).menu(File, 2),
    ];
    commands.extend(Shape::ALL.map(|shape| {
        let text = format!("Opens the shape {}, made in code.", shape.name());
        Command::new(FileAction::OpenShape(shape), format!("Shape: {}", shape.title()))
            .text(text)
            .submenu(Submenu::Shapes)
    }));
    let vase = "Opens the painted vase that the window opens at a first start.";
    commands.push(Command::new(FileAction::OpenVase, "Shape: Vase").text(vase).submenu(Submenu::Shapes));
    commands.extend(writing());
    commands.extend([
        Command::new(Action::ForgetEverything, "Forget all settings…")
            .text(
                "Resets settings, theme and window size, and forgets recent files and their cameras. The mesh \
                 stays open.",
            )
            .menu(File, 5),
        Command::new(FileAction::Quit, "Quit").text("Closes the window.").keys([QUIT]).menu(File, 6),
    ]);
    commands
}

fn ask(purpose: Purpose, name: &'static str, text: &'static str) -> Command {
    Command::new(FileAction::Ask(purpose), name).text(text)
}

fn writing() -> [Command; 7] {
    let (picture, document): (&[Need], &[Need]) =
        (&[Need::Picture, Need::NoWriting], &[Need::Document, Need::NoWriting]);
    let turntable = "Draws pictures from all around, and writes them as numbered PNG files or as one animated GIF.";
    let adjacency =
        "Writes the index buffer of PN-AEN patches, with 9 indices a patch, as JSON or as bare indices (.bin).";
    let write = |written, name: &'static str, text: &'static str| ask(Purpose::Write(written), name, text);
    let chart = "Writes the chart as a picture (.svg, .png) or a table (.csv).";
    let factors = "Writes the tessellation factors of every patch as CSV, as for this view.";
    let stats = "Measures and times what is shown, and writes the numbers as JSON.";
    [
        Command::new(FileAction::SavePicture, "Save picture…").text(PICTURE).keys([ctrl(Key::S)]).needs(picture),
        Command::new(FileAction::SaveTurntable, "Save turntable…").text(turntable).needs(picture),
        write(Written::Factors, "Save factors…", factors).needs(document),
        write(Written::Adjacency, "Save adjacency…", adjacency).needs(document),
        write(Written::Stats, "Save stats…", stats).needs(picture),
        write(Written::Mesh, "Export mesh…", MESH).keys([ctrl(Key::E)]).needs(document),
        write(Written::Chart, "Save chart…", chart).needs(&[Need::Chart, Need::NoWriting]),
    ]
    .map(|command| match command.action {
        // The chart's own panel has a button for it.
        Action::File(FileAction::Ask(Purpose::Write(Written::Chart))) => command,
        _ => command.menu(Menu::File, 4),
    })
}

fn edit() -> Vec<Command> {
    use Menu::Edit;
    vec![
        Command::new(Action::Undo, "Undo")
            .text("Takes back the last change of settings, or of the files beside the mesh.")
            .keys([ctrl(Key::Z)])
            .menu(Edit, 0)
            .needs(&[Need::Undo]),
        Command::new(Action::Redo, "Redo")
            .text("Does again what was undone.")
            .keys([ctrl_shift(Key::Z)])
            .menu(Edit, 0)
            .needs(&[Need::Redo]),
        Command::new(Action::CopyAsCommand, "Copy as command")
            .text("Copies the pnaen command that draws this picture without a window.")
            .keys([ctrl(Key::K)])
            .menu(Edit, 1)
            .needs(&[Need::Document]),
        Command::new(Action::CopyPicture, "Copy picture")
            .text("Copies the picture as it is in the window, without labels, for another program to paste.")
            .keys([ctrl(Key::I)])
            .menu(Edit, 1)
            .needs(&[Need::Picture]),
        Command::new(Action::ResetSettings, "Reset settings")
            .text("Sets every setting to its value at the first start. This can be undone.")
            .menu(Edit, 2),
    ]
}

fn view() -> Vec<Command> {
    use Menu::View;
    let theme = |theme, name: &'static str, text: &'static str| {
        Command::new(Action::Theme(theme), name).text(text).menu(View, 3)
    };
    vec![
        Command::new(CameraAction::Frame, "Frame")
            .text("Shows all of the mesh, upright and with the usual field of view.")
            .keys([plain(Key::F), plain(Key::Home)])
            .menu(View, 0),
        Command::new(CameraAction::FramePatch, "Frame patch")
            .text("Turns the camera to the selected patch.")
            .keys([shift(Key::F)])
            .menu(View, 0)
            .needs(&[Need::SelectedPatch]),
        Command::new(CameraAction::Orthographic, "Orthographic")
            .text("Switches between perspective and orthographic projection.")
            .keys([plain(Key::Num5)])
            .menu(View, 0),
        Command::new(CameraAction::Before, "Previous view")
            .text("Goes back to the view before the camera last moved. Undo leaves the view as it is.")
            .keys([plain(Key::OpenBracket)])
            .menu(View, 0)
            .needs(&[Need::ViewBefore]),
        Command::new(CameraAction::After, "Next view")
            .text("Goes forward again, to the view that \u{201c}Previous view\u{201d} left.")
            .keys([plain(Key::CloseBracket)])
            .menu(View, 0)
            .needs(&[Need::ViewAfter]),
        Command::new(Action::AddBookmark, "Bookmark this view")
            .text(
                "Keeps this view among the file's bookmarks, which are there again when the file is opened the \
                 next time.",
            )
            .keys([ctrl(Key::D)])
            .submenu(Submenu::Bookmarks)
            .needs(&[Need::Document, Need::RoomForBookmarks]),
        Command::new(Action::ForgetBookmarks, "Forget bookmarks")
            .text("Forgets all bookmarks of this file.")
            .submenu(Submenu::Bookmarks)
            .needs(&[Need::Bookmarks]),
        Command::new(Action::Ruler, "Measure distance")
            .text(
                "Shows the distance between two places that you click on, in object units. The key, or Escape, \
                 ends it.",
            )
            .keys([shift(Key::D)])
            .menu(View, 1)
            .needs(&[Need::Document]),
        Command::new(Action::Previews, "Preview while the camera moves")
            .text(
                "Draws a cheaper picture while the camera moves, if the full one would be late. Switch it off to judge \
                 LOD in motion.",
            )
            .menu(View, 1),
        Command::new(Action::Chart, "Chart")
            .text("Shows or hides the chart of speed against accuracy for this mesh in this view.")
            .keys([plain(Key::G)])
            .menu(View, 1),
        Command::new(Action::MeasureChart, "Measure chart")
            .text("Measures the settings that are missing from the chart.")
            .needs(&[Need::MeasurableChart]),
        Command::new(Action::WidestCrack, "Go to the widest crack")
            .text(
                "Shows the cracks, and turns the camera to the worst one: the edge whose gap is the widest on \
                 screen.",
            )
            .needs(&[Need::Document]),
        Command::new(Action::NextPlace, "Next place")
            .text("Shows the next place of the finding that is shown, or the worst place of the first finding.")
            .keys([plain(Key::F8)])
            .needs(&[Need::Document]),
        Command::new(Action::PreviousPlace, "Previous place")
            .text("Shows the place before in the finding that is shown.")
            .keys([shift(Key::F8)])
            .needs(&[Need::Document]),
        Command::new(Action::HidePanels, "Hide panels")
            .text(
                "Hides the panels on both sides, or shows them again. While a control has the focus, Tab goes to the \
                 next one.",
            )
            .keys([plain(Key::Tab), ctrl(Key::B)])
            .menu(View, 1),
        Command::new(Action::FocusControls, "Go to the controls")
            .text(
                "Moves the keyboard's focus to the first control. Tab and Shift+Tab then go from one to the next, and \
                 Escape gives the keyboard back to the picture.",
            )
            .keys([plain(Key::F6)])
            .menu(View, 1),
        Command::new(Action::OpenAllSections, "Open all sections")
            .text("Opens every section of both panels.")
            .menu(View, 1),
        Command::new(Action::FoldAllSections, "Fold all sections")
            .text("Folds every section of both panels.")
            .menu(View, 1),
        Command::new(Action::Warnings, "Warnings…")
            .text("Lists what was repaired or left out when the file was read.")
            .menu(View, 1)
            .needs(&[Need::Document]),
        Command::new(Action::LargerText, "Larger text")
            .text("Makes everything in the window larger.")
            .keys([ctrl(Key::Plus), ctrl(Key::Equals)])
            .menu(View, 2),
        Command::new(Action::SmallerText, "Smaller text")
            .text("Makes everything in the window smaller.")
            .keys([ctrl(Key::Minus)])
            .menu(View, 2),
        Command::new(Action::UsualText, "Usual text size")
            .text("Makes everything in the window as large as usual.")
            .keys([ctrl(Key::Num0)])
            .menu(View, 2),
        theme(ThemePreference::System, "Theme of the system", "Follows the desktop's theme, light or dark."),
        theme(ThemePreference::Light, "Light theme", "Draws the window dark on light."),
        theme(ThemePreference::Dark, "Dark theme", "Draws the window light on dark."),
    ]
}

fn standpoints() -> Vec<Command> {
    let all = [
        (Standpoint::Front, "Front", "Looks from the front.", plain(Key::Num1)),
        (Standpoint::Back, "Back", "Looks from the back.", ctrl(Key::Num1)),
        (Standpoint::Right, "Right", "Looks from the right.", plain(Key::Num3)),
        (Standpoint::Left, "Left", "Looks from the left.", ctrl(Key::Num3)),
        (Standpoint::Top, "Top", "Looks from the top.", plain(Key::Num7)),
        (Standpoint::Bottom, "Bottom", "Looks from the bottom.", ctrl(Key::Num7)),
    ];
    let look = |(standpoint, name, text, key)| {
        let action = CameraAction::LookFrom(standpoint);
        Command::new(action, format!("Look from: {name}")).text(text).keys([key]).submenu(Submenu::LookFrom)
    };
    all.map(look).into()
}

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
        commands.push(Command::new(CameraAction::Orbit(direction), orbit).text(turns).keys([plain(key)]));
        commands.push(
            Command::new(CameraAction::Pan(direction), pan).text("Moves the camera by 40 points.").keys([shift(key)]),
        );
    }
    commands.push(
        Command::new(CameraAction::ZoomIn, "Zoom in").text("Moves the camera closer.").keys([plain(Key::PageUp)]),
    );
    commands.push(
        Command::new(CameraAction::ZoomOut, "Zoom out").text("Moves the camera away.").keys([plain(Key::PageDown)]),
    );
    commands
}

/// Commands about the picture and the selection.
fn look() -> Vec<Command> {
    vec![
        Command::new(Action::SplitView, "Split view")
            .text("Shows the untessellated mesh, another tessellation or another mesh left of a divider, from the same camera.")
            .keys([plain(Key::S)]),
        Command::new(Action::Background, "Background colour…").text("Chooses the colour behind the mesh."),
        Command::new(Action::PlayOrPause, "Play or pause")
            .text("Plays the animation clip, the first one if none is chosen, or pauses it.")
            .keys([plain(Key::Space)])
            .needs(&[Need::Clips]),
        Command::new(Action::Deselect, "Deselect").text("Clears the selection.").needs(&[Need::Selection]),
        Command::new(Action::Cancel, "Cancel")
            .text(
                "Closes the windows over the picture. If there are none, stops what is under way: loading, writing a \
                 file, or a long drawing. If nothing is, deselects.",
            )
            .keys([plain(Key::Escape)]),
    ]
}

fn tessellation() -> Vec<Command> {
    vec![
        Command::new(Change::FactorUp, "Factor up")
            .text("Makes the tessellation factor larger by 1.")
            .keys([plain(Key::Plus), plain(Key::Equals)])
            .needs(&[Need::Factor]),
        Command::new(Change::FactorDown, "Factor down")
            .text("Makes the tessellation factor smaller by 1.")
            .keys([plain(Key::Minus)])
            .needs(&[Need::Factor]),
        Command::new(Change::AdaptiveLod, "Adaptive LOD")
            .text("Switches between adaptive LOD and one factor everywhere.")
            .keys([plain(Key::L)])
            .needs(&[Need::Lod]),
        Command::new(Change::ToggleEdges, "Edges as published or shared")
            .text("Switches between computing shared edges once (watertight) and by each patch (as published).")
            .keys([plain(Key::E)]),
        Command::new(Change::CullBackFaces, "Cull back faces")
            .text("Switches whether patches that show only their backs are left out.")
            .needs(&[Need::Culling]),
        Command::new(Action::FreezeLodCamera, "Freeze LOD camera")
            .text("Keeps LOD and clipping as they are for this camera while you look from elsewhere.")
            .keys([plain(Key::Z)])
            .needs(&[Need::Picture]),
        Command::new(CameraAction::ThroughFrozen, "Look through frozen LOD camera")
            .text("Moves the camera back to where LOD and clipping were frozen.")
            .keys([shift(Key::Z)])
            .menu(Menu::View, 0)
            .needs(&[Need::Frozen]),
        Command::new(Action::ToggleDisplacement, "Displacement")
            .text("Switches displacement by heights on or off.")
            .keys([plain(Key::D)])
            .needs(&[Need::Heights]),
    ]
}

fn help() -> Vec<Command> {
    use Menu::Help;
    vec![
        Command::new(Action::SearchCommands, "Search commands…")
            .text("Finds any command by its name.")
            .keys([ctrl(Key::P)])
            .menu(Help, 0),
        Command::new(Action::Keys, "Keys…").text("Lists every key and what it does.").menu(Help, 0),
        Command::new(Action::WhitePaper, "The PN-AEN white paper")
            .text("Opens McDonald and Kilgard's paper of 2010 in the web browser.")
            .menu(Help, 0),
    ]
}
