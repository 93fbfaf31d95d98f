//! LOD, conventions and colours, and pictures of many triangles.

use std::time::Instant;

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use geometry::mesh::Shape;
use geometry::tessellate::{Convention, CurvatureKind};
use inspect::settings::{Colors, Matcap};
use load::Source;
use pnaen::app::App;

use crate::editing::{assert_draws, copied, press_with};
use crate::{PATIENCE, STOP, choose, click, open_list, press, run_command, settle, uniform};

#[test]
fn only_one_colouring_is_shown_and_has_a_legend() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    let legends = [
        "Legend: Factor",
        "Legend: Triangle size, px",
        "Legend: Factors below 2",
        "Legend: Triangles / fewest needed",
        "Legend: Barycentric, weights in the patch",
        "Legend: Stripes break at creases",
        "Legend: Normal: x red, y green, z blue",
        "Legend: UV: a square is 1/8 of a unit",
        "Legend: Surface normal: x red, y green, z blue",
        "Legend: Mean curvature, 1/unit",
        "Legend: Texels per px",
    ];
    let shown = |harness: &Harness<App>| -> Vec<_> {
        (0..legends.len()).filter(|&legend| harness.query_by_label(legends[legend]).is_some()).collect()
    };
    assert_eq!(shown(&harness), Vec::<usize>::new());
    for (entry, colors, expected) in [
        ("Factors", Colors::Factors, Some(0)),
        ("Triangle size", Colors::TriangleSize, Some(1)),
        ("Clay", Colors::Clay, None),
        ("Matcap", Colors::Matcap, None),
        ("Factors below 2", Colors::LowFactors, Some(2)),
        ("Excess triangles", Colors::Excess, Some(3)),
        ("Barycentric", Colors::Barycentric, Some(4)),
        ("Zebra", Colors::Zebra, Some(5)),
        ("Shading normals", Colors::ShadingNormals, Some(6)),
        ("UV checker", Colors::UvChecker, Some(7)),
        ("Surface normals", Colors::SurfaceNormals, Some(8)),
        ("Curvature", Colors::Curvature, Some(9)),
        ("Texel density", Colors::TexelDensity, Some(10)),
        ("Material", Colors::Material, None),
    ] {
        let pictures = harness.state().pictures();
        choose(&mut harness, "Colours", entry);
        assert_eq!(harness.state().settings().overlays.colors, colors);
        assert_eq!(shown(&harness), Vec::from_iter(expected), "{entry}");
        assert!(harness.state().pictures() > pictures, "{entry} isn't drawn");
    }
    for (key, colors) in [
        (egui::Key::H, Colors::Factors),
        (egui::Key::X, Colors::TriangleSize),
        (egui::Key::U, Colors::LowFactors),
        (egui::Key::M, Colors::Excess),
        (egui::Key::B, Colors::Barycentric),
        (egui::Key::B, Colors::Material),
    ] {
        press(&mut harness, key);
        assert_eq!(harness.state().settings().overlays.colors, colors);
    }
    for (key, colors) in [
        (egui::Key::C, Colors::Clay),
        (egui::Key::M, Colors::Matcap),
        (egui::Key::S, Colors::Zebra),
        (egui::Key::N, Colors::ShadingNormals),
        (egui::Key::G, Colors::SurfaceNormals),
        (egui::Key::K, Colors::Curvature),
        (egui::Key::T, Colors::TexelDensity),
        (egui::Key::U, Colors::UvChecker),
        (egui::Key::U, Colors::Material),
    ] {
        press_with(&mut harness, egui::Modifiers::SHIFT, key);
        assert_eq!(harness.state().settings().overlays.colors, colors);
    }
    press(&mut harness, egui::Key::N);
    assert!(harness.state().settings().overlays.normals);
}

#[test]
fn an_image_of_a_lit_sphere_takes_the_place_of_those_that_are_made_in_code() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let [blue, text] = ["blue.png", "text.png"].map(|name| folder.path().join(name));
    image::RgbaImage::from_pixel(8, 8, image::Rgba([9, 80, 200, 255])).save(&blue).expect("written");
    std::fs::write(&text, "no image").expect("written");
    let blues = |harness: &Harness<App>| {
        let picture = harness.state().read_picture().expect("a device").expect("a picture");
        picture.pixels().filter(|pixel| pixel.0 == [9, 80, 200, 255]).count()
    };
    let open = |harness: &mut Harness<App>, path: &std::path::Path| {
        let context = harness.ctx.clone();
        harness.state_mut().open_matcap(&context, path.to_owned());
        settle(harness);
    };
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    open(&mut harness, &text);
    harness.get_by_label_contains("text.png can't be used as a matcap");
    assert_eq!(harness.state().settings().overlays.colors, Colors::Material, "all stays as it was");
    press(&mut harness, egui::Key::Escape);
    open(&mut harness, &blue);
    assert_eq!(harness.state().settings().overlays.colors, Colors::Matcap);
    assert_eq!(harness.state().matcap_image(), Some(&*blue));
    assert!(blues(&harness) > 10_000, "{}", blues(&harness));
    let command = copied(&mut harness);
    assert!(command.contains("--matcap-image ") && command.contains("--overlay matcap"), "{command}");
    assert_draws(&harness, &command, "torus-view");
    press(&mut harness, egui::Key::Escape);
    // The image stays with another mesh.
    let context = harness.ctx.clone();
    harness.state_mut().open(&context, Source::Shape(Shape::Icosphere));
    settle(&mut harness);
    assert!(blues(&harness) > 10_000, "{}", blues(&harness));
    choose(&mut harness, "Matcap", "Chrome");
    assert_eq!((harness.state().matcap_image(), harness.state().settings().matcap), (None, Matcap::Chrome));
    assert_eq!(blues(&harness), 0);
}

#[test]
fn the_scale_of_curvature_has_a_row_while_it_is_shown() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    assert!(harness.query_by_label("Curvature up to").is_none());
    choose(&mut harness, "Colours", "Curvature");
    let picture = harness.state().read_picture().expect("a device");
    assert!(harness.query_by_role_and_label(Role::Slider, "Curvature up to").is_none(), "it suits the mesh");
    choose(&mut harness, "Curvature up to", "A number");
    harness.get_by_role_and_label(Role::Slider, "Curvature up to").set_value_accesskit(20.0);
    settle(&mut harness);
    assert_eq!(harness.state().settings().curvature_scale, Some(20.0));
    assert!(harness.state().read_picture().expect("a device") != picture, "the colours are paler");
    choose(&mut harness, "Curvature up to", "As suits the mesh");
    assert_eq!(harness.state().settings().curvature_scale, None);
    assert!(harness.state().read_picture().expect("a device") == picture);
    choose(&mut harness, "Kind of curvature", "Gaussian");
    assert_eq!(harness.state().settings().curvature_kind, CurvatureKind::Gaussian);
    assert!(harness.state().read_picture().expect("a device") != picture, "another curvature");
    harness.get_by_label("Legend: Gaussian curvature, 1/unit²");
}

#[test]
fn colours_have_rows_for_their_options_while_they_are_shown() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    let rows = [
        ("Zebra", Role::Slider, "Stripes"),
        ("Zebra", Role::Slider, "Stripes run"),
        ("UV checker", Role::Slider, "Squares across"),
        ("Texel density", Role::ComboBox, "Texels per"),
    ];
    for colors in ["Zebra", "UV checker", "Texel density"] {
        choose(&mut harness, "Colours", colors);
        for (of, role, name) in rows {
            assert_eq!(harness.query_by_role_and_label(role, name).is_some(), of == colors, "{name} under {colors}");
        }
    }
    choose(&mut harness, "Texels per", "Object units");
    harness.get_by_label("Legend: Texels per unit");
    choose(&mut harness, "Colours", "UV checker");
    harness.get_by_role_and_label(Role::Slider, "Squares across").set_value_accesskit(32.0);
    settle(&mut harness);
    harness.get_by_label("Legend: UV: a square is 1/32 of a unit");
}

#[test]
fn a_mesh_without_texture_coordinates_has_no_checker() {
    for (shape, has_checker) in [(Shape::Icosphere, false), (Shape::Torus, true)] {
        let mut harness = uniform(Some(Source::Shape(shape)));
        open_list(&mut harness, "Colours");
        let is_disabled = |name| harness.get_by_label(name).accesskit_node().is_disabled();
        assert_eq!([is_disabled("UV checker"), is_disabled("Zebra")], [!has_checker, false], "{shape:?}");
        assert_eq!(is_disabled("Texel density"), !has_checker, "{shape:?}");
        press(&mut harness, egui::Key::Escape);
        press_with(&mut harness, egui::Modifiers::SHIFT, egui::Key::U);
        assert_eq!(harness.state().settings().overlays.colors == Colors::UvChecker, has_checker, "{shape:?}");
    }
}

#[test]
fn small_triangles_are_counted_for_every_view() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    let count = |harness: &Harness<App>| harness.state().sizes_shown().map(|sizes| (sizes.in_view, sizes.small));
    let (_, triangles) = harness.state().totals().expect("counted");
    let (in_view, small) = count(&harness).expect("measured");
    assert_eq!(in_view, triangles, "all triangles are in view");
    assert!(small > 0);
    // Zooming out changes no uniform tessellation, but all numbers are of the present view.
    press(&mut harness, egui::Key::PageDown);
    let (_, smaller) = count(&harness).expect("measured");
    assert!(smaller > small, "{smaller}, and {small} from nearer");
    press(&mut harness, egui::Key::PageDown);
    let (_, smallest) = count(&harness).expect("measured");
    assert!(smallest > smaller, "{smallest}, and {smaller} from nearer");
    assert!(harness.state().cracks().is_some(), "cracks don't depend on the view");
}

#[test]
fn wrong_conventions_crack_under_adaptive_lod() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    choose(&mut harness, "LOD", "Edge length");
    let cracked = |harness: &Harness<App>| harness.state().cracks().map(|cracks| cracks.different_factors);
    for (entry, convention) in [("AMD PN sample", Convention::AmdPn), ("Edge order", Convention::EdgeOrder)] {
        choose(&mut harness, "Convention", entry);
        assert_eq!((harness.state().settings().tessellation.convention, cracked(&harness)), (convention, Some(0)));
    }
    choose(&mut harness, "Convention", "Mirrored (mistake)");
    assert!(cracked(&harness) > Some(100), "{:?}", cracked(&harness));
    choose(&mut harness, "Convention", "Rotated (mistake)");
    assert!(cracked(&harness) > Some(100), "{:?}", cracked(&harness));
    choose(&mut harness, "LOD", "Uniform");
    assert_eq!(cracked(&harness), Some(0));
    choose(&mut harness, "Convention", "Direct3D 11");
    assert_eq!(harness.state().settings().tessellation.convention, Convention::D3d11);
}

#[test]
fn frozen_lod_stays_while_the_camera_moves() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    press(&mut harness, egui::Key::L);
    let sizes = |harness: &Harness<App>| {
        let sizes = harness.state().sizes_shown().expect("measured");
        (sizes.in_view, sizes.small)
    };
    let (before, sizes_before) = (harness.state().totals(), sizes(&harness));
    press(&mut harness, egui::Key::Z);
    press(&mut harness, egui::Key::PageUp);
    press(&mut harness, egui::Key::PageUp);
    assert_eq!((harness.state().totals(), sizes(&harness)), (before, sizes_before), "frozen");
    press(&mut harness, egui::Key::Z);
    assert!(harness.state().totals() > before, "nearer, so more triangles");
}

#[test]
fn a_picture_of_many_steps_can_be_cancelled_and_drawn_later() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("torus.glb");
    run_command(["tessellate", "shape:torus", "--factor", "3"], &path);
    let mut harness = uniform(Some(Source::File(path)));
    let (pictures, before) = (harness.state().pictures(), harness.state().totals());
    // About 20 million triangles, which take longer than the test waits.
    harness.get_by_role_and_label(Role::Slider, "Factor").set_value_accesskit(64.0);
    let start = Instant::now();
    while harness.query_by_label_contains("Drawing ").is_none() {
        assert!(start.elapsed() < PATIENCE, "nothing is being drawn");
        harness.step();
    }
    click(&mut harness, STOP);
    assert_eq!((harness.state().pictures(), harness.state().settings().tessellation.factor), (pictures, 64.0));
    assert!(!harness.state().is_busy());
    harness.get_by_label("cracks not measured");
    for what in ["Cracks", "Leaks", "Folds", "Triangles below 3 px", "Patches at the maximum factor"] {
        harness.get_by_label(&format!("{what}: not measured"));
    }
    // Selecting something doesn't draw the cancelled picture.
    harness.state_mut().select_triangle(Some(3));
    settle(&mut harness);
    assert_eq!(harness.state().pictures(), pictures);
    harness.get_by_label_contains("Not drawn: ");
    harness.get_by_label("Draw").click();
    harness.run_steps(3);
    harness.get_by_label_contains("Drawing ");
    press(&mut harness, egui::Key::Escape);
    harness.get_by_label_contains("Not drawn: ");
    harness.get_by_role_and_label(Role::Slider, "Factor").set_value_accesskit(8.0);
    settle(&mut harness);
    assert_eq!(harness.state().totals(), before);
    assert!(harness.state().pictures() > pictures, "the picture is drawn with the selection");
}
