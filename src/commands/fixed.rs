//! Commands that don't depend on the window's state.

use egui::{Key, ThemePreference};

use super::availability as when;
use super::{
    Action, CameraAction, Change, Command, Direction, FileAction, Menu, QUIT, Submenu, ctrl, ctrl_shift, plain, shift,
};
use geometry::mesh::Shape;
use inspect::render::Standpoint;

/// What displacing by a height image does.
pub(crate) const HEIGHT_IMAGE: &str =
    "Displaces the mesh by the brightness of a PNG, JPEG or WebP image, which covers all materials.";

/// All of them, in the order of the menus.
pub(super) fn commands() -> Vec<Command> {
    [file(), edit(), view(), standpoints(), camera(), look(), tessellation(), help()].into_iter().flatten().collect()
}

/// What a picture of a lit sphere is for.
pub(crate) const MATCAP_IMAGE: &str =
    "Opens a PNG, JPEG or WebP image of a lit sphere, and shows the surface in its colours.";

/// What a file of factors is for.
const FACTORS: &str = "Opens the tessellation factors that another engine wrote, in place of those of LOD, and lists where they disagree.";

/// What functions of the user's own are for.
const LOD_SHADER: &str =
    "Opens a WGSL file with your own function for factors in place of LOD, and follows its changes.";

/// What a function of the user's own for control points is for.
const SURFACE_SHADER: &str = "Opens a WGSL file with your own function for the control points of edges in place of a surface, and follows its changes.";

/// What a file of light is for.
pub const ENVIRONMENT: &str =
    "Opens a panorama (.hdr or .exr) whose light shines on the mesh in place of the studio's.";

const TRUTH: &str = "Opens the mesh that deviation and charts compare with, such as the high-poly original.";
const PICTURE: &str = "Writes the picture as a PNG file, in any size, with or without background, overlays and legend.";
const MESH: &str = "Writes the tessellated mesh as a .glb or .obj file, as it is emitted for this view.";

fn file() -> Vec<Command> {
    use Menu::File;
    let mut commands = vec![
        Command::new(Action::File(FileAction::Open), "Open…", "Opens a mesh file.").keys([ctrl(Key::O)]).menu(File, 0),
        Command::new(
            Action::File(FileAction::OpenPath),
            "Open path…",
            "Opens a mesh file, a shape, a height image or an environment by its typed path.",
        )
        .keys([ctrl(Key::L)])
        .menu(File, 0),
        Command::new(Action::File(FileAction::HeightImage), "Height image…", HEIGHT_IMAGE)
            .menu(File, 1)
            .unless(when::document),
        Command::new(Action::File(FileAction::Matcap), "Matcap image…", MATCAP_IMAGE)
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
            "Forget reference surface",
            "Goes back to the exact surface of a shape, or to the limit surface of the tessellation.",
        )
        .menu(File, 2)
        .unless(when::truth),
        Command::new(Action::File(FileAction::Factors), "Factors of a file…", FACTORS)
            .menu(File, 2)
            .unless(when::document),
        Command::new(
            Action::File(FileAction::FactorsPath),
            "Factors path…",
            "Opens a file of factors by its typed path.",
        )
        .menu(File, 2)
        .unless(when::document),
        Command::new(
            Action::File(FileAction::ForgetFactors),
            "Close the factors file",
            "Closes the file of factors. LOD computes them again.",
        )
        .menu(File, 2)
        .unless(when::factors),
        Command::new(Action::File(FileAction::LodShader), "LOD shader…", LOD_SHADER)
            .menu(Menu::Edit, 2)
            .unless(when::document),
        Command::new(
            Action::File(FileAction::LodShaderPath),
            "LOD shader path…",
            "Opens an LOD shader by its typed path.",
        )
        .menu(Menu::Edit, 2)
        .unless(when::document),
        Command::new(
            Action::File(FileAction::CloseLodShader),
            "Close the LOD shader",
            "Closes the LOD shader. LOD computes factors again.",
        )
        .menu(Menu::Edit, 2)
        .unless(when::lod_shader),
        Command::new(Action::File(FileAction::SurfaceShader), "Surface shader…", SURFACE_SHADER)
            .menu(Menu::Edit, 2)
            .unless(when::document),
        Command::new(
            Action::File(FileAction::SurfaceShaderPath),
            "Surface shader path…",
            "Opens a surface shader by its typed path.",
        )
        .menu(Menu::Edit, 2)
        .unless(when::document),
        Command::new(
            Action::File(FileAction::CloseSurfaceShader),
            "Close the surface shader",
            "Closes the surface shader. The surface that was chosen before is back.",
        )
        .menu(Menu::Edit, 2)
        .unless(when::surface_shader),
        Command::new(Action::File(FileAction::Environment), "Open environment…", ENVIRONMENT).menu(File, 2),
        Command::new(
            Action::File(FileAction::EnvironmentPath),
            "Environment path…",
            "Opens a panorama of light by its typed path.",
        )
        .menu(File, 2),
        Command::new(
            Action::File(FileAction::CloseEnvironment),
            "Close environment",
            "Closes the panorama of light. The studio shines again.",
        )
        .menu(File, 2)
        .unless(when::environment),
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
fn writing() -> [Command; 9] {
    use Menu::File;
    [
        Command::new(Action::File(FileAction::SavePicture), "Save picture…", PICTURE)
            .keys([ctrl(Key::S)])
            .menu(File, 4)
            .unless(when::saved_picture),
        Command::new(
            Action::File(FileAction::SavePicturePath),
            "Save picture path…",
            "Saves the picture as a PNG file at a typed path, as was last chosen under \u{201c}Save picture\u{201d}.",
        )
        .menu(File, 4)
        .unless(when::saved_picture),
        Command::new(
            Action::File(FileAction::SaveTurntable),
            "Save turntable…",
            "Draws pictures from all around, and writes them as numbered PNG files or as one animated GIF.",
        )
        .menu(File, 4)
        .unless(when::saved_picture),
        Command::new(
            Action::File(FileAction::SaveFactors),
            "Save factors…",
            "Writes the tessellation factors of every patch as CSV, as for this view.",
        )
        .menu(File, 4)
        .unless(when::export),
        Command::new(
            Action::File(FileAction::SaveAdjacency),
            "Save adjacency…",
            "Writes the index buffer of PN-AEN patches, with 9 indices a patch, as JSON or as bare indices (.bin).",
        )
        .menu(File, 4)
        .unless(when::export),
        Command::new(
            Action::File(FileAction::SaveStats),
            "Save stats…",
            "Measures and times what is shown, and writes the numbers as JSON.",
        )
        .menu(File, 4)
        .unless(when::saved_picture),
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
        Command::new(Action::Undo, "Undo", "Takes back the last change of settings, or of the files beside the mesh.")
            .keys([ctrl(Key::Z)])
            .menu(Edit, 0)
            .unless(when::undo),
        Command::new(Action::Redo, "Redo", "Does again what was undone.")
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
    let theme =
        |theme, name: &'static str, text: &'static str| Command::new(Action::Theme(theme), name, text).menu(View, 3);
    vec![
        Command::new(Action::Camera(CameraAction::Frame), "Frame", "Shows all of the mesh, upright and with the usual field of view.")
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
        Command::new(
            Action::Camera(CameraAction::Orthographic),
            "Orthographic",
            "Switches between perspective and orthographic projection.",
        )
        .keys([plain(Key::Num5)])
        .menu(View, 0),
        Command::new(
            Action::Camera(CameraAction::Before),
            "Previous view",
            "Goes back to the view before the camera last moved. Undo leaves the view as it is.",
        )
        .keys([plain(Key::OpenBracket)])
        .menu(View, 0)
        .unless(when::view_before),
        Command::new(
            Action::Camera(CameraAction::After),
            "Next view",
            "Goes forward again, to the view that \u{201c}Previous view\u{201d} left.",
        )
        .keys([plain(Key::CloseBracket)])
        .menu(View, 0)
        .unless(when::view_after),
        Command::new(
            Action::AddBookmark,
            "Bookmark this view",
            "Keeps this view among the file's bookmarks, which are there again when the file is opened the next time.",
        )
        .keys([ctrl(Key::D)])
        .submenu(Submenu::Bookmarks)
        .unless(when::room_for_bookmarks),
        Command::new(Action::ForgetBookmarks, "Forget bookmarks", "Forgets all bookmarks of this file.")
            .submenu(Submenu::Bookmarks)
            .unless(when::bookmarks),
        Command::new(
            Action::Ruler,
            "Measure distance",
            "Shows the distance between two places that you click on, in object units. The key, or Escape, ends it.",
        )
        .keys([shift(Key::D)])
        .menu(View, 1)
        .unless(when::document),
        Command::new(
            Action::Previews,
            "Preview while the camera moves",
            "Draws a cheaper picture while the camera moves, if the full one would be late. Switch it off to judge LOD in \
             motion.",
        )
        .menu(View, 1),
        Command::new(
            Action::Chart,
            "Chart",
            "Shows or hides the chart of speed against accuracy for this mesh in this view.",
        )
        .keys([plain(Key::G)])
        .menu(View, 1),
        Command::new(Action::MeasureChart, "Measure chart", "Measures the settings that are missing from the chart.")
            .unless(when::measure_chart),
        Command::new(
            Action::WidestCrack,
            "Go to the widest crack",
            "Shows the cracks, and turns the camera to the worst one: the edge whose gap is the widest on screen.",
        )
        .unless(when::document),
        Command::new(Action::HidePanels, "Hide panels", "Hides the panels on both sides, or shows them again. While a control has the focus, Tab goes to the next one.")
            .keys([plain(Key::Tab), ctrl(Key::B)])
            .menu(View, 1),
        Command::new(
            Action::FocusControls,
            "Go to the controls",
            "Moves the keyboard's focus to the first control. Tab and Shift+Tab then go from one to the next, and Escape gives the \
             keyboard back to the picture.",
        )
        .keys([plain(Key::F6)])
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

/// The six standard views.
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
        let action = Action::Camera(CameraAction::LookFrom(standpoint));
        Command::new(action, format!("Look from: {name}"), text).keys([key]).submenu(Submenu::LookFrom)
    };
    all.map(look).into()
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
            "Closes the windows over the picture. If there are none, stops what is under way: loading, writing a file, or \
             a long drawing. If nothing is, deselects.",
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
        Command::new(
            Action::Camera(CameraAction::ThroughFrozen),
            "Look through frozen LOD camera",
            "Moves the camera back to where LOD and clipping were frozen.",
        )
        .keys([shift(Key::Z)])
        .menu(Menu::View, 0)
        .unless(when::frozen),
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
