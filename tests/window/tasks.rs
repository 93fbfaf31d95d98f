//! What people come for, from a first start: how many clicks each task takes. The manual's page of tasks,
//! `docs/manual/tasks.md`, is made of them; `PNAEN_UPDATE_PAGES=1` writes it again.

use std::path::Path;

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{AccessKitNode, By, Queryable};
use geometry::tessellate::{Lod, Partitioning, Surface, Tessellation};
use inspect::settings::{Colors, SplitView};
use load::markdown::table;
use load::{NormalSource, Source};
use pnaen::app::App;

use super::layout::first_start;
use super::saving::wait;
use super::{copy_vase, run_command, settle};
use documents::moving::moving;

/// One thing that a hand does. All but typing and keys counts as a click.
#[derive(Clone, Copy)]
enum Step {
    /// A control whose name begins like this. It must be in sight.
    Click(&'static str),
    /// A menu, whose name a section may have as well.
    Menu(&'static str),
    /// A list, and an entry of it.
    List(&'static str, &'static str),
    /// The middle of the picture's right half.
    Picture,
    /// A slider, to a value.
    Slide(&'static str, f64),
    /// Types the path of a file in a temporary folder, and presses Enter.
    Type(&'static str),
}

use Step::{Click, List, Menu, Picture, Slide, Type};

struct Task {
    what: &'static str,
    steps: &'static [Step],
    done: fn(&Harness<App>, &Path) -> bool,
}

/// The number of clicks that no task exceeds.
const MOST_CLICKS: usize = 3;

fn is_written(folder: &Path, name: &str) -> bool {
    std::fs::metadata(folder.join(name)).is_ok_and(|file| file.len() > 0)
}

const TASKS: [Task; 31] = [
    Task {
        what: "open a mesh",
        steps: &[Click("File"), Click("Open…"), Type("other.glb")],
        done: |window, folder| window.state().source() == Some(&Source::File(folder.join("other.glb"))),
    },
    Task {
        what: "see the tessellated mesh alone",
        steps: &[Click("Split view")],
        done: |window, _| window.state().settings().split.is_none(),
    },
    Task {
        what: "see the triangles",
        steps: &[Click("Wireframe")],
        done: |window, _| window.state().settings().overlays.wireframe,
    },
    Task {
        what: "change the surface",
        steps: &[List("Surface", "Phong")],
        done: |window, _| window.state().settings().tessellation.surface == Surface::Phong,
    },
    Task {
        what: "find the worst crack of PN triangles",
        steps: &[List("Surface", "PN"), Click("#cracked edge")],
        // Another view has other factors, so that another crack may be the widest there.
        done: |window, _| {
            let cracks = window.state().cracks().map(|cracks| cracks.edges.as_slice()).unwrap_or_default();
            let selected = window.state().selected_edge();
            cracks.iter().any(|crack| Some(crack.edge) == selected && crack.gap > 0.0)
        },
    },
    Task {
        what: "compare two surfaces",
        steps: &[List("Left", "PN")],
        done: |window, _| window.state().settings().has_left_tessellation(),
    },
    Task {
        what: "see both halves side by side",
        steps: &[List("Shown as", "Side by side")],
        done: |window, _| window.state().settings().split_view == SplitView::Beside,
    },
    Task {
        what: "see where both halves differ",
        steps: &[List("Shown as", "Difference")],
        done: |window, _| window.state().settings().split_view == SplitView::Difference,
    },
    Task { what: "see all of the mesh", steps: &[Click("Frame all")], done: |window, _| window.state().is_framed() },
    Task {
        what: "compare with another file",
        steps: &[List("Left mesh", "Another file…"), Type("other.glb")],
        done: |window, _| window.query_by_label_contains("Left: other.glb").is_some(),
    },
    Task {
        what: "exchange both halves",
        steps: &[Click("Swap")],
        done: |window, _| window.state().settings().tessellation == Tessellation::untessellated(),
    },
    Task {
        what: "compare a change with what was before",
        steps: &[Click("Keep the right half on the left"), List("Surface", "Phong")],
        done: |window, _| {
            let settings = window.state().settings();
            (settings.left.surface, settings.tessellation.surface) == (Surface::PnAen, Surface::Phong)
        },
    },
    Task {
        what: "see triangles that fold over",
        steps: &[Click("Overlays"), Click("Folds")],
        done: |window, _| window.state().settings().overlays.folds,
    },
    Task {
        what: "make the normals anew",
        steps: &[List("Normals", "Made anew")],
        done: |window, _| window.state().settings().import.normals == NormalSource::Made,
    },
    Task {
        what: "look from above",
        steps: &[Click("Look from the top")],
        done: |window, _| window.state().camera().elevation > 89.0,
    },
    Task {
        what: "measure a distance",
        steps: &[Menu("View"), Click("Measure distance")],
        done: |window, _| window.state().ruler().is_some(),
    },
    Task {
        what: "read the factors of an edge",
        steps: &[Picture],
        done: |window, _| window.state().selected_edge().is_some() && window.state().selected_triangle().is_some(),
    },
    Task {
        what: "give every edge the same factor",
        steps: &[List("LOD", "Uniform"), Slide("Factor", 8.0)],
        done: |window, _| {
            window.state().settings().tessellation.lod == Lod::Uniform
                && window.state().settings().tessellation.factor == 8.0
        },
    },
    Task {
        what: "change the partitioning",
        steps: &[List("Partitioning", "Rows")],
        done: |window, _| window.state().settings().tessellation.partitioning == Partitioning::Rows,
    },
    Task {
        what: "see which triangles are too small",
        steps: &[List("Colours", "Triangle size")],
        done: |window, _| window.state().settings().overlays.colors == Colors::TriangleSize,
    },
    Task {
        what: "see how far the picture is from the exact surface",
        steps: &[List("Colours", "Deviation")],
        done: |window, _| window.state().settings().overlays.colors == Colors::Deviation,
    },
    Task {
        what: "look at a fixed LOD from elsewhere",
        steps: &[Click("Freeze LOD camera")],
        done: |window, _| window.query_by_label("LOD camera frozen").is_some(),
    },
    Task {
        what: "load the factors of another engine",
        steps: &[Click("File"), Click("Factors of a file…"), Type("factors.csv")],
        done: |window, folder| window.state().factors_file() == Some(&folder.join("factors.csv")),
    },
    Task { what: "play an animation", steps: &[Click("Play or pause")], done: |window, _| window.state().is_playing() },
    Task {
        what: "save the picture",
        steps: &[Click("Save picture"), Click("Save…"), Type("picture.png")],
        done: |_, folder| is_written(folder, "picture.png"),
    },
    Task {
        what: "write a report",
        steps: &[Click("Save picture"), Click("Save…"), Type("report.html")],
        done: |_, folder| is_written(folder, "report.html"),
    },
    Task {
        what: "export the tessellated mesh",
        steps: &[Click("File"), Click("Export mesh…"), Type("mesh.glb")],
        done: |_, folder| is_written(folder, "mesh.glb"),
    },
    Task {
        what: "save the numbers of what is shown",
        steps: &[Click("File"), Click("Save stats…"), Type("stats.json")],
        done: |_, folder| is_written(folder, "stats.json"),
    },
    Task {
        what: "get the command that draws this picture",
        steps: &[Menu("Edit"), Click("Copy as command")],
        done: |window, _| window.query_all_by_label("Copied").next().is_some(),
    },
    Task {
        what: "chart speed against accuracy",
        steps: &[Menu("View"), Click("Chart")],
        done: |window, _| window.query_by_label("Methods").is_some(),
    },
    Task {
        what: "undo a change",
        steps: &[Click("Wireframe"), Menu("Edit"), Click("Undo")],
        done: |window, _| !window.state().settings().overlays.wireframe,
    },
];

/// Whether a control that is in sight can be clicked and has this name, perhaps followed by a key. A name after # may be anywhere
/// in the label.
fn is_called(node: &AccessKitNode, name: &str) -> bool {
    let kinds = [Role::Button, Role::CheckBox, Role::ComboBox, Role::DisclosureTriangle];
    let Some(label) = node.label().filter(|_| kinds.contains(&node.role()) && !node.is_disabled()) else {
        return false;
    };
    match name.strip_prefix('#') {
        Some(part) => label.contains(part),
        None => label
            .strip_prefix(name)
            .is_some_and(|rest| !rest.starts_with(|next: char| next.is_alphanumeric() || next == '-')),
    }
}

fn clicks(task: &Task) -> usize {
    let clicks = |step: &Step| match step {
        Type(_) => 0,
        List(..) => 2,
        Click(_) | Menu(_) | Picture | Slide(..) => 1,
    };
    task.steps.iter().map(clicks).sum()
}

fn assert_in_sight(harness: &Harness<App>, name: &str, place: egui::Rect) {
    assert!(harness.ctx.content_rect().contains_rect(place), "{name} is out of sight at {place}");
}

/// Does what a hand would do.
fn act(harness: &mut Harness<App>, step: Step, folder: &Path) {
    match step {
        Click(name) => {
            let found = harness.query_all(By::new().predicate(move |node| is_called(node, name))).last().expect(name);
            assert_in_sight(harness, name, found.rect());
            found.click();
        }
        Menu(name) => harness.get_by_role_and_label(Role::Button, name).click(),
        List(name, entry) => {
            let list = harness.get_by_role_and_label(Role::ComboBox, name);
            assert_in_sight(harness, name, list.rect());
            list.click();
            settle(harness);
            harness.get_by_label(entry).click();
        }
        Picture => {
            let picture = harness.get_by_role_and_label(Role::Image, "Viewport").rect();
            let place = picture.lerp_inside(egui::vec2(0.7, 0.5));
            harness.hover_at(place);
            harness.drag_at(place);
            harness.run_steps(1);
            harness.drop_at(place);
        }
        Slide(name, value) => harness.get_by_role_and_label(Role::Slider, name).set_value_accesskit(value),
        Type(name) => {
            // Whether there is a file dialog is asked beside the window.
            wait(harness, |app| app.path_asked_for().is_some());
            harness.run_steps(2);
            harness.get_by_role(Role::TextInput).type_text(&folder.join(name).display().to_string());
            harness.run_steps(2);
            harness.key_press(egui::Key::Enter);
            harness.run_steps(3);
            wait(harness, |app| !app.is_writing());
        }
    }
    // A click takes effect within two frames. What plays never rests.
    harness.run_steps(3);
    match harness.state().is_playing() {
        true => harness.run_steps(3),
        false => settle(harness),
    }
}

/// A step as the page says it.
fn words(step: &Step) -> String {
    match step {
        Click(name) => format!("**{}**", name.trim_start_matches('#')),
        Menu(name) => format!("**{name}**"),
        List(name, entry) => format!("the list **{name}**, **{entry}**"),
        Picture => "the edge in the picture".to_owned(),
        Slide(name, _) => format!("the slider **{name}**"),
        Type(_) => "(the file)".to_owned(),
    }
}

fn page() -> String {
    let rows = TASKS.map(|task| {
        let steps = task.steps.iter().map(words).collect::<Vec<_>>().join(", ");
        vec![task.what.to_owned(), steps, clicks(&task).to_string()]
    });
    format!(
        "# Where to click\n\n\
         These are the clicks for common tasks, counted from the first start, when the vase is open in a split view. Ctrl+P \
         finds every command by its name, and most have a [key](keys.md).\n\n{}",
        table(&["to", "click", "clicks"], &[0, 1], &rows)
    )
}

#[test]
fn the_manuals_page_of_tasks_is_the_table() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/manual/tasks.md");
    let page = page();
    if std::env::var_os("PNAEN_UPDATE_PAGES").is_some() {
        std::fs::write(&path, &page).expect("a writable folder");
    }
    let is_same = std::fs::read_to_string(&path).is_ok_and(|kept| kept == page);
    assert!(is_same, "tasks.md is out of date; PNAEN_UPDATE_PAGES=1 writes it");
}

#[test]
fn no_task_takes_more_than_three_clicks_from_a_first_start() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    copy_vase(&folder, "other.glb");
    run_command(["factors", "assets/vase.glb", "--factor", "3"], &folder.path().join("factors.csv"));
    let moving_file = folder.path().join("moving.glb");
    std::fs::write(&moving_file, moving()).expect("a writable temporary folder");
    for task in &TASKS {
        // Tells which one a failure below is of.
        println!("{}", task.what);
        let source = (task.what == "play an animation").then(|| Source::File(moving_file.clone()));
        let mut harness = first_start([1280.0, 720.0], source);
        for step in task.steps {
            act(&mut harness, *step, folder.path());
        }
        assert!((task.done)(&harness, folder.path()), "{} isn't done: {:?}", task.what, harness.state().settings());
        assert!(clicks(task) <= MOST_CLICKS, "{}", task.what);
    }
}
