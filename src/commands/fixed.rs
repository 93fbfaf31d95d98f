//! Commands that don't depend on the window's state.

use egui::{Key, ThemePreference};
use glam::IVec2;

use super::{
    Action, CameraAction, Change, Command, CompanionFile, FileAction, Menu, Need, Place, Purpose, QUIT, Submenu,
    Written, ctrl, ctrl_shift, plain, shift,
};
use geometry::mesh::Shape;
use inspect::render::Standpoint;
use inspect::settings::Choice;
use load::Source;

pub(crate) const HEIGHT_IMAGE: &str = "Displaces the mesh by the brightness of a PNG, JPEG, WebP, TGA, KTX2, TIFF or EXR image, \
                                       which covers all materials.";

/// All of them, in the order of the menus.
pub(super) fn commands() -> Vec<Command> {
    [file(), edit(), view(), standpoints(), camera(), look(), tessellation(), help()].into_iter().flatten().collect()
}

/// What a picture of a lit sphere is for.
pub(crate) const MATCAP_IMAGE: &str =
    "Opens a PNG, JPEG or WebP image of a lit sphere, and shows the surface in its colours.";

pub const ENVIRONMENT: &str =
    "Opens a panorama (.hdr or .exr) whose light shines on the mesh in place of the studio's.";

pub(crate) const CLOSE_LOD_SHADER: &str = "Closes the LOD shader. LOD computes factors again.";
pub(crate) const CLOSE_SURFACE_SHADER: &str = "Closes the surface shader. The surface that was chosen before is back.";
pub(crate) const CLOSE_ENVIRONMENT: &str = "Close the environment map; studio light is used again.";
pub(crate) const LEFT_MESH: &str = "The mesh left of the split: the same one, or that of another file, such as an earlier export or the high-poly original.";

/// Declares commands: each with its name, its keys, the menu and the group or the submenu that it is in, and what it needs, as far as
/// it has these; what it does in the window; and its text.
macro_rules! declared {
    ($(
        $name:literal $([$($key:expr),+])? $(in $menu:ident $group:literal)? $(below $submenu:ident)?
        $(needs $($need:ident)+)? => $action:expr, $text:expr;
    )+) => {
        vec![$(
            Command {
                $(keys: vec![$($key),+],)?
                $(place: Some(Place::Menu(Menu::$menu, $group)),)?
                $(place: Some(Place::Submenu(Submenu::$submenu)),)?
                $(needs: &[$(Need::$need),+],)?
                ..Command::new($action, $name, $text)
            }
        ),+]
    };
}
pub(super) use declared;

fn file() -> Vec<Command> {
    let beside = |file| FileAction::Ask(Purpose::CompanionFile(file));
    let mut commands = declared! {
        "Open…" [ctrl(Key::O)] in File 0 => FileAction::Ask(Purpose::Open), "Opens a mesh file.";
        "Open path…" [ctrl(Key::L)] in File 0 => FileAction::OpenPath,
            "Opens a mesh file, a shape, a height image or an environment by its typed path.";
        "Height image…" in File 1 needs Document => FileAction::Ask(Purpose::Heights), HEIGHT_IMAGE;
        "Matcap image…" in File 1 needs Document => beside(CompanionFile::Matcap), MATCAP_IMAGE;
        "Reload" [plain(Key::R)] in File 1 needs Document => FileAction::Reload,
            "Loads the file again; settings and camera stay.";
        "Next mesh" [ctrl(Key::PageDown)] in File 0 needs Neighbours => FileAction::NextMesh,
            "Opens the next mesh of the folder, or of the files that were dropped together. After the last one comes the first.";
        "Previous mesh" [ctrl(Key::PageUp)] in File 0 needs Neighbours => FileAction::PreviousMesh,
            "Opens the mesh before this one in the folder, or among the files that were dropped together.";
        "Reference surface…" in File 2 => beside(CompanionFile::ReferenceShape),
            "Opens the mesh that deviation and charts compare with, such as the high-poly original.";
        "Compare with its subdivision limit" in File 2 needs Document Cage => FileAction::CompareWithOwnLimit,
            "Takes the polygons of the mesh's file as the cage of a subdivision surface, and its limit as reference surface.";
        "Forget reference surface" in File 2 needs ReferenceShape => FileAction::Close(CompanionFile::ReferenceShape),
            "Goes back to the exact surface of a shape, or to the limit surface of the tessellation.";
        "Mesh left of the split…" needs Document => beside(CompanionFile::LeftMesh), LEFT_MESH;
        "The same mesh left of the split" needs LeftMesh => FileAction::Close(CompanionFile::LeftMesh),
            "Shows the mesh that is open in both halves, with the same weights.";
        "Compare with before the change" needs Before => FileAction::CompareWithBefore,
            "Shows the mesh as it was before its file changed left of the split, tessellated as the new one is.";
        "Factors of a file…" in File 2 needs Document => beside(CompanionFile::Factors),
            "Opens the tessellation factors that another engine wrote, in place of those of LOD, and lists where they \
             disagree.";
        "Close the factors file" in File 2 needs Factors => FileAction::Close(CompanionFile::Factors),
            "Closes the file of factors. LOD computes them again.";
        "LOD shader…" in Edit 2 needs Document => beside(CompanionFile::LodShader),
            "Opens a WGSL file with your own function for factors in place of LOD, and follows its changes.";
        "Close the LOD shader" in Edit 2 needs LodShader => FileAction::Close(CompanionFile::LodShader), CLOSE_LOD_SHADER;
        "Surface shader…" in Edit 2 needs Document => beside(CompanionFile::SurfaceShader),
            "Opens a WGSL file with your own function for the control points of edges in place of a surface, and follows \
             its changes.";
        "Close the surface shader" in Edit 2 needs SurfaceShader => FileAction::Close(CompanionFile::SurfaceShader),
            CLOSE_SURFACE_SHADER;
        "Open environment…" in File 2 => beside(CompanionFile::Environment), ENVIRONMENT;
        "Close environment" in File 2 needs Environment => FileAction::Close(CompanionFile::Environment), CLOSE_ENVIRONMENT;
    };
    commands.extend(Shape::ALL.map(|shape| {
        let text = format!("Opens the shape {}, made in code.", shape.name());
        let (open, name) = (FileAction::OpenSource(Source::Shape(shape)), format!("Shape: {}", shape.title()));
        Command::below(Submenu::Shapes, open, name, text)
    }));
    commands.extend(writing());
    commands
}

/// The rest of the menu File.
fn writing() -> Vec<Command> {
    let write = |what| FileAction::Ask(Purpose::Write(what));
    declared! {
        "Shape: Vase" below Shapes => FileAction::OpenSource(Source::Vase),
            "Opens the painted vase that the window opens at a first start.";
        "Save picture…" [ctrl(Key::S)] in File 4 needs Picture NoWriting => FileAction::SavePicture,
            "Writes the picture as a PNG file, or a report on it as a page, in any size, with or without background, overlays \
             and legend.";
        "Save turntable…" in File 4 needs Picture NoWriting => FileAction::SaveTurntable,
            "Draws pictures from all around, and writes them as numbered PNG files or as one animated GIF.";
        "Save factors…" in File 4 needs Document NoWriting => write(Written::Factors),
            "Writes the tessellation factors of every patch as CSV, as for this view.";
        "Save adjacency…" in File 4 needs Document NoWriting => write(Written::Adjacency),
            "Writes the index buffer of PN-AEN patches, with 9 indices a patch, as JSON or as bare indices (.bin).";
        "Save stats…" in File 4 needs Picture NoWriting => write(Written::Stats),
            "Measures and times what is shown, and writes the numbers as JSON.";
        "Export mesh…" [ctrl(Key::E)] in File 4 needs Document NoWriting => write(Written::Mesh),
            "Writes the tessellated mesh as a .glb or .obj file, as it is emitted for this view.";
        // The chart's own panel has a button for it.
        "Save chart…" needs Chart NoWriting => write(Written::Chart),
            "Writes the chart as a picture (.svg, .png) or a table (.csv).";
        "Forget all settings…" in File 5 => Action::ForgetEverything,
            "Resets settings, theme and window size, and forgets recent files and their cameras. The mesh stays open.";
        "Quit" [QUIT] in File 6 => FileAction::Quit, "Closes the window.";
    }
}

fn edit() -> Vec<Command> {
    declared! {
        "Undo" [ctrl(Key::Z)] in Edit 0 needs Undo => Action::Undo,
            "Takes back the last change of settings, or of the files beside the mesh.";
        "Redo" [ctrl_shift(Key::Z)] in Edit 0 needs Redo => Action::Redo, "Does again what was undone.";
        "Copy as command" [ctrl(Key::K)] in Edit 1 needs Document => Action::CopyAsCommand,
            "Copies the pnaen command that draws this picture without a window.";
        "Copy picture" [ctrl(Key::I)] in Edit 1 needs Picture => Action::CopyPicture,
            "Copies the picture as it is in the window, without labels, for another program to paste.";
        "Reset settings" in Edit 2 => Action::ResetSettings,
            "Sets every setting to its value at the first start. This can be undone.";
    }
}

fn view() -> Vec<Command> {
    declared! {
        "Frame" [plain(Key::F), plain(Key::Home)] in View 0 => CameraAction::Frame,
            "Shows all of the mesh, upright and with the usual field of view.";
        "Frame patch" [shift(Key::F)] in View 0 needs SelectedPatch => CameraAction::FramePatch,
            "Turns the camera to the selected patch.";
        "Orthographic" [plain(Key::Num5)] in View 0 => CameraAction::Orthographic,
            "Switches between perspective and orthographic projection.";
        "Previous view" [plain(Key::OpenBracket)] in View 0 needs ViewBefore => CameraAction::Before,
            "Goes back to the view before the camera last moved. Undo leaves the view as it is.";
        "Next view" [plain(Key::CloseBracket)] in View 0 needs ViewAfter => CameraAction::After,
            "Goes forward again, to the view that \u{201c}Previous view\u{201d} left.";
        "Bookmark this view" [ctrl(Key::D)] below Bookmarks needs Document RoomForBookmarks => Action::AddBookmark,
            "Keeps this view among the file's bookmarks, which are there again when the file is opened the next time.";
        "Forget bookmarks" below Bookmarks needs Bookmarks => Action::ForgetBookmarks,
            "Forgets all bookmarks of this file.";
        "Measure distance" [shift(Key::D)] in View 1 needs Document => Action::Ruler,
            "Shows the distance between two places that you click on, in object units. The key, or Escape, ends it.";
        "Preview while the camera moves" in View 1 => Action::Previews,
            "Draws a cheaper picture while the camera moves, if the full one would be late. Switch it off to judge LOD in \
             motion.";
        "Chart" [plain(Key::G)] in View 1 => Action::Chart,
            "Shows or hides the chart of speed against accuracy for this mesh in this view.";
        "Measure chart" needs MeasurableChart => Action::MeasureChart,
            "Measures the settings that are missing from the chart.";
        "Go to the widest crack" needs Document => Action::WidestCrack,
            "Shows the cracks, and turns the camera to the worst one: the edge whose gap is the widest on screen.";
        "Next place" [plain(Key::F8)] needs Document => Action::NextPlace,
            "Shows the next place of the finding that is shown, or the worst place of the first finding.";
        "Previous place" [shift(Key::F8)] needs Document => Action::PreviousPlace,
            "Shows the place before in the finding that is shown.";
        "Hide panels" [plain(Key::Tab), ctrl(Key::B)] in View 1 => Action::HidePanels,
            "Hides the panels on both sides, or shows them again. While a control has the focus, Tab goes to the next one.";
        "Go to the controls" [plain(Key::F6)] in View 1 => Action::FocusControls,
            "Moves the keyboard's focus to the first control. Tab and Shift+Tab then go from one to the next, and Escape \
             gives the keyboard back to the picture.";
        "Open all sections" in View 1 => Action::OpenAllSections, "Opens every section of both panels.";
        "Fold all sections" in View 1 => Action::FoldAllSections, "Folds every section of both panels.";
        "Warnings…" in View 1 needs Document => Action::Warnings,
            "Lists what was repaired or left out when the file was read.";
        "Larger text" [ctrl(Key::Plus), ctrl(Key::Equals)] in View 2 => Action::LargerText,
            "Makes everything in the window larger.";
        "Smaller text" [ctrl(Key::Minus)] in View 2 => Action::SmallerText, "Makes everything in the window smaller.";
        "Usual text size" [ctrl(Key::Num0)] in View 2 => Action::UsualText,
            "Makes everything in the window as large as usual.";
        "Theme of the system" in View 3 => Action::Theme(ThemePreference::System),
            "Follows the desktop's theme, light or dark.";
        "Light theme" in View 3 => Action::Theme(ThemePreference::Light), "Draws the window dark on light.";
        "Dark theme" in View 3 => Action::Theme(ThemePreference::Dark), "Draws the window light on dark.";
    }
}

fn standpoints() -> Vec<Command> {
    use Standpoint::{Back, Bottom, Front, Left, Right, Top};
    declared! {
        "Look from: Front" [plain(Key::Num1)] below LookFrom => CameraAction::LookFrom(Front), Front.text();
        "Look from: Back" [ctrl(Key::Num1)] below LookFrom => CameraAction::LookFrom(Back), Back.text();
        "Look from: Right" [plain(Key::Num3)] below LookFrom => CameraAction::LookFrom(Right), Right.text();
        "Look from: Left" [ctrl(Key::Num3)] below LookFrom => CameraAction::LookFrom(Left), Left.text();
        "Look from: Top" [plain(Key::Num7)] below LookFrom => CameraAction::LookFrom(Top), Top.text();
        "Look from: Bottom" [ctrl(Key::Num7)] below LookFrom => CameraAction::LookFrom(Bottom), Bottom.text();
    }
}

fn camera() -> Vec<Command> {
    use CameraAction::{Orbit, Pan};
    let [left, right, up, down] = [IVec2::NEG_X, IVec2::X, IVec2::Y, IVec2::NEG_Y];
    let (orbits, pans) = ("Turns the camera around the mesh by 7.5 degrees.", "Moves the camera by 40 points.");
    declared! {
        "Orbit left" [plain(Key::ArrowLeft)] => Orbit(left), orbits;
        "Pan left" [shift(Key::ArrowLeft)] => Pan(left), pans;
        "Orbit right" [plain(Key::ArrowRight)] => Orbit(right), orbits;
        "Pan right" [shift(Key::ArrowRight)] => Pan(right), pans;
        "Orbit up" [plain(Key::ArrowUp)] => Orbit(up), orbits;
        "Pan up" [shift(Key::ArrowUp)] => Pan(up), pans;
        "Orbit down" [plain(Key::ArrowDown)] => Orbit(down), orbits;
        "Pan down" [shift(Key::ArrowDown)] => Pan(down), pans;
        "Zoom in" [plain(Key::PageUp)] => CameraAction::ZoomIn, "Moves the camera closer.";
        "Zoom out" [plain(Key::PageDown)] => CameraAction::ZoomOut, "Moves the camera away.";
    }
}

/// Commands about the picture and the selection.
fn look() -> Vec<Command> {
    declared! {
        "Split view" [plain(Key::S)] => Action::SplitView,
            "Shows the untessellated mesh, another tessellation or another mesh left of a divider, from the same camera.";
        "Background colour…" => Action::Background, "Chooses the colour behind the mesh.";
        "Play or pause" [plain(Key::Space)] needs Clips => Action::PlayOrPause,
            "Plays the animation clip, the first one if none is chosen, or pauses it.";
        "Deselect" needs Selection => Action::Deselect, "Clears the selection.";
        "Cancel" [plain(Key::Escape)] => Action::Cancel,
            "Closes the windows over the picture. If there are none, stops what is under way: loading, writing a file, or a \
             long drawing. If nothing is, deselects.";
    }
}

fn tessellation() -> Vec<Command> {
    declared! {
        "Factor up" [plain(Key::Plus), plain(Key::Equals)] needs Factor => Change::FactorUp,
            "Makes the tessellation factor larger by 1.";
        "Factor down" [plain(Key::Minus)] needs Factor => Change::FactorDown,
            "Makes the tessellation factor smaller by 1.";
        "Adaptive LOD" [plain(Key::L)] needs Lod => Change::AdaptiveLod,
            "Switches between adaptive LOD and one factor everywhere.";
        "Edges as published or shared" [plain(Key::E)] => Change::ToggleEdges,
            "Switches between computing shared edges once (watertight) and by each patch (as published).";
        "Cull back faces" needs Culling => Change::CullBackFaces,
            "Switches whether patches that show only their backs are left out.";
        "Freeze LOD camera" [plain(Key::Z)] needs Picture => Action::FreezeLodCamera,
            "Keeps LOD and clipping as they are for this camera while you look from elsewhere.";
        "Look through frozen LOD camera" [shift(Key::Z)] in View 0 needs Frozen => CameraAction::ThroughFrozen,
            "Moves the camera back to where LOD and clipping were frozen.";
        "Displacement" [plain(Key::D)] needs Heights => Action::ToggleDisplacement,
            "Switches displacement by heights on or off.";
    }
}

fn help() -> Vec<Command> {
    declared! {
        "Search commands…" [ctrl(Key::P)] in Help 0 => Action::SearchCommands, "Finds any command by its name.";
        "Keys…" in Help 0 => Action::Keys, "Lists every key and what it does.";
        "The PN-AEN white paper" in Help 0 => Action::WhitePaper,
            "Opens McDonald and Kilgard's paper of 2010 in the web browser.";
    }
}
