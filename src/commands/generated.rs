//! Commands that are made from lists: the values of settings, weld tolerances, clips and recent files.

use std::path::PathBuf;

use egui::{Key, KeyboardShortcut};

use super::fixed::declared;
use super::{
    Action, Availability, CameraAction, Change, Command, FileAction, MOST_BOOKMARKS, Need, Preparing, Submenu, alt,
    plain, shift,
};
use geometry::mesh::weld_preview::TOLERANCES;
use geometry::names::shortened;
use geometry::tessellate::Surface;
use inspect::settings::{Choice, ColorSource, Colors, Control, Declaration, Overlay, Overlays, options};
use load::{HeightSource, Source};

/// The greatest number of clips that are listed.
const CLIPS: usize = 1000;
/// The width of the crease band that is switched on by a command, as a part of the bounding diagonal.
const CREASE_BAND: f32 = 0.02;

pub(super) fn commands(now: &Availability) -> Vec<Command> {
    let all = [settings(), colors_and_overlays(), mesh(), clips(now), recent(now), bookmarks(now), file_cameras(now)];
    all.into_iter().flatten().collect()
}

/// A command for each value of an option, with the option's label in its name.
fn values(option: &'static Declaration, needs: &'static [Need]) -> Vec<Command> {
    let label = option.label;
    let unset = option.unset.iter().map(|unset| (None, unset.label, unset.text));
    let values = option.kind.descriptions();
    let values = values.iter().map(|value| (Some(value.name), value.label, value.text));
    let command = |(value, name, text): (Option<&'static str>, &'static str, &'static str)| Command {
        needs,
        ..Command::new(Change::Option(option.name, value), format!("{label}: {name}"), text)
    };
    unset.chain(values).map(command).collect()
}

fn settings() -> Vec<Command> {
    let all = [
        values(&options::SURFACE, &[Need::Surface]),
        left_surfaces(),
        values(&options::NORMALS, &[]),
        values(&options::NORMALS_AT, &[Need::NormalsAt]),
        values(&options::PARTITIONING, &[]),
        values(&options::EDGES, &[]),
        values(&options::LOD, &[Need::Lod]),
        values(&options::CLIP, &[]),
        values(&options::SECTION, &[]),
        values(&options::CONVENTION, &[]),
        values(&options::DISPLACEMENT, &[Need::Heights]),
        values(&options::DEVIATION_IN, &[Need::Deviation]),
        values(&options::MESH_NORMALS, &[]),
        values(&options::UP, &[Need::Document, Need::File]),
        values(&options::UNIT, &[Need::Document, Need::File]),
    ];
    all.concat()
}

/// A command for each surface that the left half can show, and those for both halves.
fn left_surfaces() -> Vec<Command> {
    let unset = options::SPLIT_LEFT.unset.iter().map(|unset| (None, unset.label, unset.text));
    let surfaces = Surface::ALL.iter().map(|surface| (Some(*surface), surface.label(), surface.text()));
    let command = |(surface, name, text): (_, &str, &'static str)| {
        let name = format!("Left of the split: {name}");
        Command { needs: &[Need::Split], ..Command::new(Change::LeftSurface(surface), name, text) }
    };
    let both = declared! {
        "Swap left and right" needs Split => Change::SwapHalves,
            "Exchanges what both halves show: their files, tessellations, and looks, poses and weights that differ. An earlier \
             version of the mesh stays on the left.";
        "Keep the right half on the left" [shift(Key::J)] needs Document Surface => Action::KeepOnLeft,
            "Makes the left half of the split view a copy of the right one, with its mesh, settings and moment of a clip, to \
             compare what you change then.";
        "Blink left and right" [plain(Key::J)] needs Split => Change::BlinkHalves,
            "Shows the left half in all of the picture, and then the right one. S brings the divider back.";
    };
    unset.chain(surfaces).map(command).chain(both).collect()
}

/// The key that switches an overlay. Those that look at the surface by itself, and bones, have Shift and a letter, the zebra
/// that of its stripes.
fn overlay_key(overlay: Overlay) -> KeyboardShortcut {
    plain(match overlay {
        Overlay::Clay => return shift(Key::C),
        Overlay::Matcap => return shift(Key::M),
        Overlay::Zebra => return shift(Key::S),
        Overlay::ShadingNormals => return shift(Key::N),
        Overlay::SurfaceNormals => return shift(Key::G),
        Overlay::Curvature => return shift(Key::K),
        Overlay::UvChecker => return shift(Key::U),
        Overlay::TexelDensity => return shift(Key::T),
        Overlay::Silhouette => return shift(Key::O),
        Overlay::Wireframe => Key::W,
        Overlay::Patches => Key::P,
        Overlay::Barycentric => Key::B,
        Overlay::Adjacency => Key::A,
        Overlay::Cracks => Key::C,
        Overlay::Folds => Key::O,
        Overlay::TJunctions => Key::T,
        Overlay::Bones => return shift(Key::B),
        Overlay::BackFaces => Key::K,
        Overlay::Factors => Key::H,
        Overlay::TriangleSize => Key::X,
        Overlay::LowFactors => Key::U,
        Overlay::Excess => Key::M,
        Overlay::Normals => Key::N,
        Overlay::Grid => Key::Y,
        Overlay::Deviation => Key::V,
    })
}

/// Commands for colours and overlays. Each but the one for the material's colours is a switch: given again, it switches
/// off.
fn colors_and_overlays() -> Vec<Command> {
    let (material, colors) = (Colors::default(), "Colours");
    let own = format!("{colors}: {}", material.label());
    let mut all = vec![Command::new(Change::MaterialColors, own, material.text())];
    all.extend(Overlay::ALL.iter().map(|&overlay| {
        let mut overlays = Overlays::default();
        let (name, source) = match overlays.control(overlay) {
            Control::Colors(_, given) => (format!("{colors}: {}", given.label()), Some(given.source())),
            Control::Switch(_) => (format!("Overlay: {}", overlay.label()), None),
        };
        let needs: &[Need] = match (overlay == Overlay::Bones, source == Some(ColorSource::TextureCoordinates)) {
            (true, _) => &[Need::Bones],
            (false, true) => &[Need::TextureCoordinates],
            (false, false) => &[],
        };
        let keys = vec![overlay_key(overlay)];
        Command { keys, needs, ..Command::new(Change::Overlay(overlay), name, overlay.text()) }
    }));
    all
}

/// Commands that change the mesh's preparation and load it again.
fn mesh() -> Vec<Command> {
    let mut all = declared! {
        "Weld: Exact" needs Document => Preparing::Weld(0.0), "Joins corners whose positions are exactly equal.";
    };
    all.extend(TOLERANCES.map(|tolerance| {
        let text = format!("Joins positions within {tolerance:e} of the bounding diagonal.");
        let name = format!("Weld: {tolerance:e}");
        Command { needs: &[Need::Document], ..Command::new(Preparing::Weld(tolerance), name, text) }
    }));
    let on = format!("Makes a band of small triangles along creases, {CREASE_BAND} of the bounding diagonal wide.");
    all.extend(declared! {
        "Crease band: On" needs Document => Preparing::CreaseBand(CREASE_BAND), on;
        "Crease band: Off" needs Document => Preparing::CreaseBand(0.0), "Leaves creases as the mesh has them.";
        "Height map: None" needs Document => Preparing::Heights(None),
            "Removes the height map; those of the file stay.";
        "Height map: Material" needs Document => Preparing::Heights(Some(HeightSource::Materials)),
            "Displaces the mesh by the brightness of each material's base colour image.";
    });
    all
}

fn clips(now: &Availability) -> Vec<Command> {
    let mut all = declared! {
        "Animation: Rest pose" needs Clips => Action::AnimationClip(None), "Shows the mesh as it is without any clip.";
    };
    all.extend(now.clips.iter().take(CLIPS).enumerate().map(|(i, clip)| {
        let name = format!("Animation: {}", shortened(clip, 40));
        let action = Action::AnimationClip(Some(i));
        Command { needs: &[Need::Clips], ..Command::new(action, name, "Shows this clip from its start.") }
    }));
    all
}

fn recent(now: &Availability) -> Vec<Command> {
    let open = |path: &PathBuf| {
        let name = format!("Recent: {}", path.file_name().unwrap_or_default().to_string_lossy());
        let text = format!("Opens {}.", path.display());
        Command::below(Submenu::OpenRecent, FileAction::OpenSource(Source::File(path.clone())), name, text)
    };
    now.recent.iter().map(open).collect()
}

fn file_cameras(now: &Availability) -> Vec<Command> {
    let go = |(index, name): (usize, &String)| {
        let text = "Looks through this camera of the file: with its place, direction and height of view.";
        let name = format!("Camera: {}", shortened(name, 40));
        Command::below(Submenu::FileCameras, CameraAction::OfFile(index), name, text)
    };
    now.file_cameras.iter().enumerate().map(go).collect()
}

const BOOKMARK_KEYS: [Key; MOST_BOOKMARKS] =
    [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6, Key::Num7, Key::Num8, Key::Num9];

fn bookmarks(now: &Availability) -> Vec<Command> {
    let go = |(index, key): (usize, Key)| {
        let (name, text) = (format!("Bookmark {}", index + 1), format!("Goes to the view of bookmark {}.", index + 1));
        Command {
            keys: vec![alt(key)],
            ..Command::below(Submenu::Bookmarks, CameraAction::Bookmark(index), name, text)
        }
    };
    BOOKMARK_KEYS.into_iter().enumerate().take(now.bookmarks).map(go).collect()
}
