//! Commands that are made from lists: the values of settings, weld tolerances, clips and recent files.

use std::path::PathBuf;

use egui::{Key, KeyboardShortcut};

use super::{
    Action, Availability, CameraAction, Change, Command, FileAction, Preparing, Submenu, alt, availability as when,
    plain, shift,
};
use geometry::mesh::UpAxis;
use geometry::mesh::weld_preview::TOLERANCES;
use geometry::names::shortened;
use geometry::tessellate::{Clip, Convention, Displacement, Edges, Lod, Normals, Partitioning, Surface};
use inspect::settings::{Choice, Colors, Control, Declaration, DeviationUnit, NormalsAt, Overlay, Overlays, options};
use load::{LengthUnit, NormalSource};

/// The greatest number of clips that are listed.
const CLIPS: usize = 1000;
/// The width of the crease band that is switched on by a command, as a part of the bounding diagonal.
const CREASE_BAND: f32 = 0.02;

pub(super) fn commands(now: &Availability) -> Vec<Command> {
    let mut all = settings();
    all.extend(colors_and_overlays());
    all.extend(mesh());
    all.extend(clips(now));
    all.extend(recent(now));
    all.extend(bookmarks(now));
    all.extend(file_cameras(now));
    all
}

/// A command for each value of a setting, with the setting's label in its name.
fn values<T: Choice>(label: &str, change: impl Fn(T) -> Change, why_not: super::WhyNot) -> Vec<Command> {
    let command = |&value: &T| {
        Command::new(Action::Setting(change(value)), format!("{label}: {}", value.label()), value.text())
            .unless(why_not)
    };
    T::ALL.iter().map(command).collect()
}

/// The same for a setting of the mesh's file that may have no value.
fn values_or_none<T: Choice>(option: &Declaration, change: impl Fn(Option<T>) -> Change) -> Vec<Command> {
    let none = option.unset.iter().map(|unset| {
        Command::new(Action::Setting(change(None)), format!("{}: {}", option.label, unset.label), unset.text)
            .unless(when::file)
    });
    none.chain(values(option.label, |value| change(Some(value)), when::file)).collect()
}

fn settings() -> Vec<Command> {
    let always = when::always;
    let mut all = values::<Surface>(options::SURFACE.label, Change::Surface, when::surface);
    let left = "Left of the split";
    all.extend(options::SPLIT_SURFACE.unset.iter().map(|unset| {
        let name = format!("{left}: {}", unset.label);
        Command::new(Action::Setting(Change::LeftSurface(None)), name, unset.text).unless(when::split)
    }));
    all.extend(values::<Surface>(left, |surface| Change::LeftSurface(Some(surface)), when::split));
    all.extend(values::<Normals>(options::NORMALS.label, Change::Shading, always));
    all.extend(values::<NormalsAt>(options::NORMALS_AT.label, Change::NormalsAt, when::normals_at));
    all.extend(values::<Partitioning>(options::PARTITIONING.label, Change::Partitioning, always));
    all.extend(values::<Edges>(options::EDGES.label, Change::Edges, always));
    all.extend(values::<Lod>(options::LOD.label, Change::Lod, when::lod));
    all.extend(values::<Clip>(options::CLIP.label, Change::Clipping, always));
    all.extend(values::<Convention>(options::CONVENTION.label, Change::Convention, always));
    all.extend(values::<Displacement>(options::DISPLACEMENT.label, Change::Displacement, when::heights));
    all.extend(values::<DeviationUnit>(options::DEVIATION_IN.label, Change::DeviationIn, when::deviation));
    all.extend(values::<NormalSource>(options::MESH_NORMALS.label, Change::MeshNormals, always));
    all.extend(values_or_none::<UpAxis>(&options::UP, Change::Up));
    all.extend(values_or_none::<LengthUnit>(&options::UNIT, Change::Unit));
    all
}

/// The key that switches an overlay. Those that look at the surface by itself have Shift and a letter, the zebra that of its
/// stripes.
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
    let (material, colors) = (Colors::Material, "Colours");
    let own = format!("{colors}: {}", material.label());
    let mut all = vec![Command::new(Action::Setting(Change::MaterialColors), own, material.text())];
    all.extend(Overlay::ALL.iter().map(|&overlay| {
        let mut overlays = Overlays::default();
        let (name, needs_coordinates) = match overlays.control(overlay) {
            Control::Colors(_, given) => (format!("{colors}: {}", given.label()), given.are_of_texture_coordinates()),
            Control::Switch(_) => (format!("Overlay: {}", overlay.label()), false),
        };
        let why_not = if needs_coordinates { when::texture_coordinates } else { when::always };
        let command = Command::new(Action::Setting(Change::Overlay(overlay)), name, overlay.text());
        command.keys([overlay_key(overlay)]).unless(why_not)
    }));
    all
}

/// Commands that change the mesh's preparation and load it again.
fn mesh() -> Vec<Command> {
    let exact = "Joins corners whose positions are exactly equal.";
    let mut all =
        vec![Command::new(Action::Prepare(Preparing::Weld(0.0)), "Weld: Exact", exact).unless(when::document)];
    all.extend(TOLERANCES.map(|tolerance| {
        let text = format!("Joins positions within {tolerance:e} of the bounding diagonal.");
        Command::new(Action::Prepare(Preparing::Weld(tolerance)), format!("Weld: {tolerance:e}"), text)
            .unless(when::document)
    }));
    let on = format!("Makes a band of small triangles along creases, {CREASE_BAND} of the bounding diagonal wide.");
    all.extend([
        Command::new(Action::Prepare(Preparing::CreaseBand(CREASE_BAND)), "Crease band: On", on).unless(when::document),
        Command::new(
            Action::Prepare(Preparing::CreaseBand(0.0)),
            "Crease band: Off",
            "Leaves creases as the mesh has them.",
        )
        .unless(when::document),
        Command::new(Action::Prepare(Preparing::NoHeights), "Height map: None", "Removes the height map.")
            .unless(when::document),
        Command::new(
            Action::Prepare(Preparing::HeightsFromMaterials),
            "Height map: Material",
            "Displaces the mesh by the brightness of each material's base colour image.",
        )
        .unless(when::document),
    ]);
    all
}

fn clips(now: &Availability) -> Vec<Command> {
    let rest = "Shows the mesh as it is without any clip.";
    let mut all = vec![Command::new(Action::AnimationClip(None), "Animation: Rest pose", rest).unless(when::clips)];
    all.extend(now.clips.iter().take(CLIPS).enumerate().map(|(i, clip)| {
        let name = format!("Animation: {}", shortened(clip, 40));
        Command::new(Action::AnimationClip(Some(i)), name, "Shows this clip from its start.").unless(when::clips)
    }));
    all
}

fn recent(now: &Availability) -> Vec<Command> {
    let open = |path: &PathBuf| {
        let name = format!("Recent: {}", path.file_name().unwrap_or_default().to_string_lossy());
        let text = format!("Opens {}.", path.display());
        Command::new(Action::File(FileAction::OpenRecent(path.clone())), name, text).submenu(Submenu::OpenRecent)
    };
    now.recent.iter().map(open).collect()
}

fn file_cameras(now: &Availability) -> Vec<Command> {
    let go = |(index, name): (usize, &String)| {
        let text = "Looks through this camera of the file: with its place, direction and height of view.";
        Command::new(Action::Camera(CameraAction::OfFile(index)), format!("Camera: {}", shortened(name, 40)), text)
            .submenu(Submenu::FileCameras)
    };
    now.file_cameras.iter().enumerate().map(go).collect()
}

/// The keys of the bookmarks, from the first one on.
const BOOKMARK_KEYS: [Key; when::MOST_BOOKMARKS] =
    [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6, Key::Num7, Key::Num8, Key::Num9];

fn bookmarks(now: &Availability) -> Vec<Command> {
    let go = |(index, key): (usize, Key)| {
        let text = format!("Goes to the view of bookmark {}.", index + 1);
        Command::new(Action::Camera(CameraAction::Bookmark(index)), format!("Bookmark {}", index + 1), text)
            .keys([alt(key)])
            .submenu(Submenu::Bookmarks)
    };
    BOOKMARK_KEYS.into_iter().enumerate().take(now.bookmarks).map(go).collect()
}
