//! Lines over the surface: how they fade where they are dense, and where something hides them.

use geometry::mesh::{Bone, Mesh, Moment, Shape, TJunction};
use geometry::tessellate::{Edges, Partitioning, Surface, Tessellation};
use geometry::view::project;
use glam::{Vec2, Vec3};
use gpu::Timing;
use image::RgbaImage;
use inspect::render::layout::{CRACK_COLOR, T_JUNCTION_COLOR, linear};
use inspect::render::{
    Camera, LeftPose, Scene, Target, bone_lines, crack_lines, legend_side, lod_camera_lines, t_junction_lines,
};
use inspect::settings::{ARENA_BYTES, Overlay, Overlays, Settings, SplitSide, SplitView};
use inspect::shot::compare;

use crate::pictures::{SIZE, differing};
use crate::stability::seen;
use crate::{engine, loaded_mesh, scene};

/// A flat cube, its edges cut into `factor` segments, with one overlay.
fn flat(factor: f32, overlay: Option<Overlay>) -> Settings {
    let tessellation =
        Tessellation { surface: Surface::Flat, partitioning: Partitioning::Integer, factor, ..Tessellation::default() };
    let overlays = Overlays::new(overlay.as_slice()).expect("at most one overlay");
    Settings { overlays, ..Settings::from(tessellation) }
}

/// The mean of all channels, 0 to 255.
fn brightness(picture: &RgbaImage) -> f64 {
    let sum: f64 = picture.pixels().flat_map(|pixel| pixel.0[..3].to_vec()).map(f64::from).sum();
    sum / f64::from(3 * picture.width() * picture.height())
}

#[test]
fn wires_fade_to_nothing_where_they_are_dense() {
    let (_, mut cube) = scene(Shape::CubeSplit);
    let target = Target::new(&engine().gpu, [400, 400]).expect("a small picture");
    // The face fills the view.
    let camera = Camera {
        azimuth: 0.0,
        elevation: 0.0,
        distance: (cube.bounds.max.y - cube.bounds.min.y) / (2.0 * 20f32.to_radians().tan()),
        orthographic: true,
        ..Camera::framing(&cube.bounds, target.viewport())
    };
    let mut darker = |factor: f32, zoom: f32| {
        let camera = Camera { distance: camera.distance * zoom, ..camera };
        let [plain, wired] =
            [None, Some(Overlay::Wireframe)].map(|overlay| seen(&mut cube, &target, &flat(factor, overlay), &camera));
        brightness(&plain) - brightness(&wired)
    };
    // Rings of triangles are 29, 10, 4 and 1 px wide.
    let [sparse, middle] = [darker(8.0, 1.0), darker(24.0, 1.0)];
    assert!(sparse > 2.0 && middle > 2.0 * sparse, "lines that are far apart are drawn in full: {sparse}, {middle}");
    let dense = darker(64.0, 1.0);
    assert!(dense > 0.0 && dense < 0.5 * middle, "more lines are less dark: {dense} after {middle}");
    let none = darker(64.0, 4.0);
    assert!(none.abs() < 1e-9, "no line is left: {none}");
}

#[test]
fn borders_of_patches_fade_where_patches_are_small_but_seams_stay() {
    let (_, mut torus) = scene(Shape::Torus);
    let target = Target::new(&engine().gpu, [300, 300]).expect("a small picture");
    let near = Camera::framing(&torus.bounds, target.viewport());
    let far = Camera { distance: 24.0 * near.distance, ..near };
    let mut changed = |overlay, camera: &Camera| {
        let [plain, lined] =
            [None, Some(overlay)].map(|overlay| seen(&mut torus, &target, &flat(2.0, overlay), camera));
        let pixels = plain.pixels().zip(lined.pixels());
        pixels.filter(|(a, b)| (0..3).any(|c| a.0[c].abs_diff(b.0[c]) > 4)).count()
    };
    assert!(changed(Overlay::Patches, &near) > 2000);
    assert_eq!(changed(Overlay::Patches, &far), 0, "patches of about a px");
    let (_, mut cylinder) = scene(Shape::Cylinder);
    let far = Camera { distance: 8.0 * Camera::framing(&cylinder.bounds, target.viewport()).distance, ..near };
    let adjacent = seen(&mut cylinder, &target, &flat(2.0, Some(Overlay::Adjacency)), &far);
    let plain = seen(&mut cylinder, &target, &flat(2.0, None), &far);
    assert!(compare(&adjacent, &plain).expect("one size").worst_square > 10.0, "seams are few, and stay");
}

/// How opaque a line of this sRGB colour is at a place, from a picture with it and one without. The places around it are tried
/// too, since a line's middle may lie between pixels.
fn opacity([with, without]: [&RgbaImage; 2], color: [u8; 3], at: glam::Vec2) -> f32 {
    let red = |picture: &RgbaImage, x: u32, y: u32| {
        let [r, g, b, _] = picture.get_pixel(x, y).0;
        linear([r, g, b])[0]
    };
    let own = |x: u32, y: u32| {
        let (before, after) = (red(without, x, y), red(with, x, y));
        (after - before) / (linear(color)[0] - before)
    };
    let (x, y) = (at.x as u32, at.y as u32);
    (x - 1..=x + 1).flat_map(|x| (y - 1..=y + 1).map(move |y| own(x, y))).fold(0.0, f32::max)
}

/// Two pictures of what the camera sees of a scene: with these lines, and without.
fn with_and_without(scene: &mut Scene, settings: &Settings, camera: &Camera, target: &Target) -> [RgbaImage; 2] {
    let with = seen(scene, target, settings, camera);
    scene.set_lines(&engine().gpu, &[]);
    [with, seen(scene, target, settings, camera)]
}

#[test]
fn cracks_behind_the_surface_are_dim_however_many_segments_and_sides_they_have() {
    let (loaded, mut ball) = scene(Shape::Icosahedron);
    let target = Target::new(&engine().gpu, [400, 400]).expect("a small picture");
    let camera = Camera::framing(&ball.bounds, target.viewport());
    let clip = camera.clip_from_object(target.viewport(), &ball.bounds);
    for factor in [3.0, 63.0] {
        // Both sides of every edge are in one place, but for rounding.
        let tessellation = Tessellation { edges: Edges::AsPublished, factor, ..Tessellation::default() };
        let settings = Settings::from(tessellation);
        let inputs = settings.inputs(camera.lod_view(target.viewport(), &ball.bounds));
        engine().count(&mut ball, &inputs, &mut Timing::Off).expect("counts");
        let measured = engine().measure(&mut ball).expect("a readback");
        let topology = &loaded.topology;
        ball.set_lines(&engine().gpu, &crack_lines(&measured, topology));
        let [with, without] = with_and_without(&mut ball, &settings, &camera, &target);
        // How far towards the eye a place is, in radii.
        let [_, _, back] = camera.axes();
        let towards = |place: Vec3| place.dot(back) / ball.bounds.radius();
        let (mut hidden, mut shown) = (Vec::new(), Vec::new());
        for edge in measured.cracks.cracked() {
            let Some(side) = measured.outlines.edge(topology, edge.edge).into_iter().next() else { continue };
            let points: Vec<_> = side.positions().collect();
            for at in points.windows(2).map(|ends| ends[0].midpoint(ends[1])) {
                let depth = towards(at);
                let at = project(clip, target.viewport(), at).expect("in front of the eye");
                // The surface bulges out of the view.
                if at.min_element() < 2.0 || at.max_element() > 397.0 {
                    continue;
                }
                let own = opacity([&with, &without], CRACK_COLOR, at);
                hidden.extend((depth < -0.4).then_some(own));
                shown.extend((depth > 0.5).then_some(own));
            }
        }
        hidden.sort_by(f32::total_cmp);
        shown.sort_by(f32::total_cmp);
        assert!(hidden.len() >= 6 && shown.len() >= 6, "{} and {}", hidden.len(), shown.len());
        // Hidden lines cross some that are shown.
        let (typical, high) = (hidden[hidden.len() / 2], hidden[hidden.len() * 3 / 4]);
        assert!((0.25..0.36).contains(&typical) && high < 0.4, "{factor} segments: {typical}, {high}");
        assert!(shown[shown.len() / 4] > 0.95, "{factor} segments: {}", shown[shown.len() / 4]);
    }
}

#[test]
fn an_edge_with_many_t_junctions_has_one_line() {
    let (loaded, mut cube) = scene(Shape::CubeSplit);
    let topology = &loaded.topology;
    let junction = |edge, point| TJunction { edge, point, t: 0.5, distance: 0.0 };
    let lines = t_junction_lines(topology, &[junction(0, 1), junction(0, 2), junction(3, 4)]);
    let dots = lines.iter().filter(|line| line.start == line.end).count();
    assert_eq!((dots, lines.len() - dots), (3, 2));
    cube.set_lines(&engine().gpu, &lines);
    let target = Target::new(&engine().gpu, [200, 200]).expect("a small picture");
    let camera = Camera::framing(&cube.bounds, target.viewport());
    let [with, without] = with_and_without(&mut cube, &Settings::default(), &camera, &target);
    let differ = compare(&with, &without).expect("one size").worst_square;
    assert!(differ > 10.0, "{T_JUNCTION_COLOR:?} is drawn: {differ}");
}

#[test]
fn the_ground_and_an_lod_cameras_frustum_look_as_they_did() {
    let (_, mut torus) = scene(Shape::Torus);
    let target = Target::new(&engine().gpu, SIZE).expect("a small picture");
    let camera = Camera { elevation: 12.0, ..Camera::framing(&torus.bounds, target.viewport()) };
    let ground = seen(&mut torus, &target, &flat(1.0, Some(Overlay::Grid)), &camera);
    let seen_from = Camera { azimuth: 80.0, distance: 0.6 * camera.distance, ..camera };
    let bounds = torus.bounds;
    torus.set_lines(&engine().gpu, &lod_camera_lines(&seen_from, target.viewport(), &bounds));
    let camera = Camera { distance: 1.8 * camera.distance, ..camera };
    let frustum = seen(&mut torus, &target, &flat(1.0, None), &camera);
    let pictures = vec![("overlay-grid".to_owned(), ground), ("lod-camera".to_owned(), frustum)];
    assert_eq!(differing(pictures), Vec::<String>::new());
}

#[test]
fn bones_of_a_pose_are_drawn_where_its_joints_are_seen_and_nowhere_else() {
    let (moving, _) = crate::deforming::scene();
    let mut mesh = Mesh::clone(&moving.mesh);
    // The joints only turn about themselves, so that another one hangs on the second.
    let hung = Bone { node: mesh.bones[1].node, place: 2.0 * Vec3::Y, parent: Some(1), ..Bone::default() };
    mesh.bones.push(hung);
    let mut scene = engine().scene(&loaded_mesh(moving.source, mesh), ARENA_BYTES).expect("a small mesh");
    let target = Target::new(&engine().gpu, [320, 240]).expect("a small picture");
    let framed = Camera::framing(&scene.bounds, target.viewport());
    let camera = Camera { distance: 1.7 * framed.distance, ..framed };
    let clip = camera.clip_from_object(target.viewport(), &scene.bounds);
    let (sin, cos) = 80_f32.to_radians().sin_cos();
    // At rest, and bent by 80 degrees about Z.
    for (moment, bent) in [(None, Vec3::Y), (Some(Moment { clip: 0, time: 0.5 }), Vec3::new(-sin, cos, 0.0))] {
        scene.set_moment(moment).expect("a small rig");
        scene.set_lines(&engine().gpu, &bone_lines(&scene));
        let [with, without] = with_and_without(&mut scene, &flat(1.0, None), &camera, &target);
        let joints = [Vec3::ZERO, 2.0 * Vec3::Y, 2.0 * Vec3::Y + 2.0 * bent];
        let seen = joints.map(|joint| project(clip, target.viewport(), joint).expect("in front of the eye"));
        for at in seen {
            let [r, g, b, _] = with.get_pixel(at.x as u32, at.y as u32).0;
            let [r, _, b] = linear([r, g, b]);
            // Hardly anything of what is before them is left.
            assert!((0.7..=1.0).contains(&r) && (0.33..0.52).contains(&b), "{moment:?}, {at}: {r} {b}");
        }
        let apart = |at: Vec2, [a, b]: [Vec2; 2]| {
            let part = (at - a).dot(b - a) / (b - a).length_squared();
            at.distance(a.lerp(b, part.clamp(0.0, 1.0)))
        };
        let mut changed = 0;
        for (x, y, pixel) in with.enumerate_pixels().filter(|(x, y, own)| *own != without.get_pixel(*x, *y)) {
            let at = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
            let nearest = apart(at, [seen[0], seen[1]]).min(apart(at, [seen[1], seen[2]]));
            // Dots are squares of 3.5 + 1.25 px on each side of a joint.
            assert!(nearest < 8.5, "{moment:?}, {at}: {pixel:?} is {nearest} px away");
            changed += 1;
        }
        assert!(changed > 200, "{changed} px");
    }
    let bent = bone_lines(&scene);
    engine().split(&mut scene, &Settings { split: Some(0.5), ..flat(1.0, None) }, None).expect("a small mesh");
    scene.set_left_pose(LeftPose::Own(Some(Moment { clip: 0, time: 0.5 }))).expect("a small rig");
    scene.set_moment(None).expect("a small rig");
    assert_eq!(scene.half(SplitSide::Left).map(bone_lines).as_ref(), Some(&bent), "the left half keeps its own pose");
    assert_ne!(bone_lines(&scene), bent);
    let (_, torus) = self::scene(Shape::Torus);
    assert_eq!(bone_lines(&torus), []);
}

#[test]
fn a_target_keeps_no_pictures_of_halves_when_no_difference_is_shown() {
    let (_, mut cube) = scene(Shape::CubeSplit);
    let difference = Settings { split: Some(0.5), split_view: SplitView::Difference, ..flat(2.0, None) };
    let mut target = Target::new(&engine().gpu, [64, 48]).expect("a small picture");
    let camera = Camera::framing(&cube.bounds, target.viewport());
    let before = target.bytes();
    seen(&mut cube, &target, &difference, &camera);
    let both = before + 2 * 4 * 64 * 48;
    assert_eq!(target.bytes(), both);
    target.keep_only_for(&difference);
    assert_eq!(target.bytes(), both, "the next difference needs them again");
    target.keep_only_for(&flat(2.0, None));
    assert_eq!(target.bytes(), before);
    let again = seen(&mut cube, &target, &difference, &camera);
    assert!(again.pixels().any(|pixel| pixel.0 == [0, 0, 0, 255]), "they are made again");
}

#[test]
fn the_legend_is_on_the_left_only_where_the_mesh_is_on_the_right() {
    let (_, cube) = scene(Shape::CubeSplit);
    let size = [640, 480];
    let framed = Camera::framing(&cube.bounds, Vec2::new(640.0, 480.0));
    let side = |camera: &Camera| legend_side(&cube, camera, &Settings::default(), [size, [240, 80]]);
    assert_eq!(side(&framed), SplitSide::Right, "the mesh is in the middle");
    let [right, _, _] = framed.axes();
    let moved = |by: f32| Camera { target: framed.target + by * cube.bounds.radius() * right, ..framed };
    // A camera that moves to the left has the mesh on its right.
    assert_eq!((side(&moved(-1.0)), side(&moved(1.0))), (SplitSide::Left, SplitSide::Right));
    assert_eq!(side(&moved(-9.0)), SplitSide::Right, "the mesh is out of view");
}
