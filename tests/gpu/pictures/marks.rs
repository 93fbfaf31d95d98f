//! What overlays draw or mark: lines, normals, folds, faces seen from behind and T-junctions, and nothing else.

use geometry::mesh::{EdgeKind, Shape, t_junctions};
use geometry::progress::Progress;
use geometry::tessellate::{Surface, Tessellation};
use image::RgbaImage;
use inspect::render::layout::{CRACK_COLOR, FOLD_COLOR, NORMAL_COLOR, T_JUNCTION_COLOR, edge_color};
use inspect::render::{Camera, Scene, Target, t_junction_lines};
use inspect::settings::{ARENA_BYTES, Overlay, Overlays, Settings};
use inspect::shot::{BETWEEN_DRIVERS, compare};

use super::{SIZE, pixels_of, pn_under};
use crate::stability::{case, seen};
use crate::{engine, picture, scene};

#[test]
fn lines_have_the_colours_of_their_legend() {
    let legend = [
        (Shape::Cylinder, Overlay::Adjacency, edge_color(EdgeKind::Smooth)),
        (Shape::Cylinder, Overlay::Adjacency, edge_color(EdgeKind::Split)),
        (Shape::Cylinder, Overlay::Adjacency, edge_color(EdgeKind::Seam)),
        (Shape::Saddle, Overlay::Adjacency, edge_color(EdgeKind::Boundary)),
        (Shape::CubeSplit, Overlay::Cracks, CRACK_COLOR),
    ];
    for (shape, overlay, color) in legend {
        let (_, mut scene) = scene(shape);
        let settings = pn_under(overlay);
        let found = pixels_of(&picture(&mut scene, &settings, [640, 480]), color);
        assert!(found > 50, "{shape:?} {overlay:?}: {found} px of {color:?}");
    }
}

#[test]
fn normals_are_drawn_chunk_by_chunk_and_not_hidden_by_later_chunks() {
    let loaded = crate::loaded(Shape::Torus);
    let settings = Settings {
        tessellation: Tessellation { factor: 63.0, ..Tessellation::default() },
        overlays: Overlays { normals: true, ..Overlays::default() },
        ..Settings::default()
    };
    let [whole, pieces] = [ARENA_BYTES, 4 << 20].map(|arena| {
        let mut scene = engine().scene(&loaded, arena).expect("shapes are small");
        let drawn = picture(&mut scene, &settings, SIZE);
        (scene.tessellator.chunk_count(), drawn)
    });
    assert!(whole.0 == 1 && pieces.0 > 4, "{} chunks and {}", whole.0, pieces.0);
    assert!(pixels_of(&whole.1, NORMAL_COLOR) > 100);
    // Where lines lie on each other, the order in which they are blended is another.
    let comparison = compare(&whole.1, &pieces.1).expect("one size");
    assert!(comparison.px < 50 && comparison.worst_square < f64::from(BETWEEN_DRIVERS), "{comparison:?}");
}

#[test]
fn the_same_vertices_show_their_normals_when_they_move_a_little() {
    let (_, mut scene) = scene(Shape::CubeSplit);
    let overlays = Overlays { normals: true, ..Overlays::default() };
    let [shown, moved, coarser] = [(0.75, 16.0), (0.7501, 16.0), (0.75, 15.0)].map(|(alpha, factor)| {
        let settings = Settings {
            tessellation: Tessellation { surface: Surface::Phong, alpha, factor, ..Tessellation::default() },
            overlays,
            ..Settings::default()
        };
        picture(&mut scene, &settings, SIZE)
    });
    let worst = |other: &RgbaImage| compare(&shown, other).expect("one size").worst_square;
    let tolerance = f64::from(BETWEEN_DRIVERS);
    assert!(worst(&moved) < tolerance, "{}", worst(&moved));
    assert!(worst(&coarser) > 10.0 * tolerance, "other vertices are other ones: {}", worst(&coarser));
}

#[test]
fn folds_are_marked_and_nothing_else_is() {
    let target = Target::new(&engine().gpu, [640, 480]).expect("a small picture");
    let (mut star, camera) = case("folds");
    let marked = |scene: &mut Scene, camera: &Camera, surface, folds| {
        let overlays = Overlays { folds, ..Overlays::default() };
        let settings = Settings {
            tessellation: Tessellation { surface, factor: 14.0, ..Tessellation::default() },
            overlays,
            ..Settings::default()
        };
        pixels_of(&seen(scene, &target, &settings, camera), FOLD_COLOR)
    };
    for surface in [Surface::Pn, Surface::PnAen] {
        let pixels = marked(&mut star, &camera, surface, true);
        assert!(pixels > 1000, "{surface:?}: {pixels} px");
        assert_eq!(marked(&mut star, &camera, surface, false), 0, "{surface:?}, not asked for");
    }
    assert_eq!(marked(&mut star, &camera, Surface::Flat, true), 0, "what is flat has no folds");
    let (_, mut torus) = scene(Shape::Torus);
    let inside = Camera { target: glam::vec3(0.7, 0.0, 0.0), distance: 0.1, ..camera };
    for camera in [camera, inside] {
        let pixels = marked(&mut torus, &camera, Surface::PnAen, true);
        assert_eq!(pixels, 0, "a torus has none, though half of it faces away from the eye");
    }
}

#[test]
fn faces_seen_from_behind_are_marked_and_others_are_not() {
    let target = Target::new(&engine().gpu, [320, 240]).expect("a small picture");
    // How many px are three times as red as green: the mesh is grey, the background bluish.
    let red = |scene: &mut Scene, camera: &Camera, back_faces| {
        let overlays = Overlays { back_faces, ..Overlays::default() };
        let picture = seen(scene, &target, &Settings { overlays, ..Settings::default() }, camera);
        picture.pixels().filter(|pixel| pixel.0[0] > 40 && pixel.0[0] / 3 > pixel.0[1]).count()
    };
    let (_, mut saddle) = scene(Shape::Saddle);
    let above = Camera::framing(&saddle.bounds, target.viewport());
    let below = Camera { elevation: -40.0, ..above };
    assert!(red(&mut saddle, &below, true) > 2000, "an open sheet from below");
    assert_eq!(red(&mut saddle, &below, false), 0, "not asked for");
    assert_eq!(red(&mut saddle, &Camera { elevation: 60.0, ..above }, true), 0, "from above");
    let (_, mut torus) = scene(Shape::Torus);
    let around = Camera::framing(&torus.bounds, target.viewport());
    assert_eq!(red(&mut torus, &around, true), 0, "nobody sees a closed mesh from behind");
}

#[test]
fn t_junctions_are_marked_where_there_are_some() {
    let target = Target::new(&engine().gpu, [640, 480]).expect("a small picture");
    let marked = |scene: &mut Scene, camera: &Camera| {
        let topology = scene.tessellator.topology().clone();
        let junctions = t_junctions(&topology, &Progress::default()).expect("nobody cancels");
        scene.set_lines(&engine().gpu, &t_junction_lines(&topology, &junctions));
        let picture = seen(scene, &target, &Settings::default(), camera);
        (junctions.len(), pixels_of(&picture, T_JUNCTION_COLOR))
    };
    let (mut sheet, camera) = case("t-junction");
    let (found, pixels) = marked(&mut sheet, &camera);
    assert!(found == 7 && pixels > 200, "{pixels} px for {found} T-junctions");
    assert_eq!(marked(&mut scene(Shape::Saddle).1, &camera), (0, 0));
}
