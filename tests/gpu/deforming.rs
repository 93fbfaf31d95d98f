//! Poses, deformed on the device: held against the CPU's reference, against themselves, and for cracks.

use std::sync::Arc;

use geometry::mesh::{CornerDetail, Mesh, Moment, Rig};
use geometry::progress::Progress;
use geometry::tessellate::{Edges, Lod, Partitioning, Surface, Tessellation, tessellate};
use geometry::view::ulp;
use gpu::{Timing, read_buffer, take_times};
use inspect::engine::{Loaded, Preparation, Runs, load};
use inspect::render::{Camera, Scene, Target};
use inspect::settings::{ARENA_BYTES, Settings};
use load::Source;

use crate::engine;
use crate::passes::{assert_agree, inputs, on_gpu};
use documents::moving::{CLIPS, moving};

pub(super) fn scene() -> (Loaded, Scene) {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("moving.glb");
    std::fs::write(&path, moving()).expect("a writable temporary folder");
    let loaded =
        load(&Source::File(path), &Preparation::default(), &Progress::default()).expect("what was just written");
    let scene = engine().scene(&loaded, ARENA_BYTES).expect("a small mesh");
    (loaded, scene)
}

fn rig(mesh: &Mesh) -> &Rig {
    mesh.rig.as_deref().expect("a document with clips")
}

/// Every clip at some of its times.
fn moments(mesh: &Mesh, count: u32) -> Vec<Moment> {
    let clips = rig(mesh).clips.iter().enumerate();
    let times = |(clip, duration): (usize, f64)| {
        (0..count).map(move |i| Moment { clip, time: duration * f64::from(i) / f64::from(count - 1) })
    };
    clips.map(|(clip, found)| (clip, found.duration)).flat_map(times).collect()
}

/// Points and corners' normals on the device.
fn deformed(scene: &Scene) -> (Vec<[f32; 4]>, Vec<[f32; 8]>) {
    let buffers = scene.tessellator.buffers();
    let read = |buffer: &wgpu::Buffer| read_buffer(&engine().gpu, buffer, 0, buffer.size()).expect("a readback");
    let points: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&read(&buffers.points));
    (points[..buffers.point_count as usize].to_vec(), bytemuck::pod_collect_to_vec(&read(&buffers.corners)))
}

/// Each coordinate is a sum of 16 products and as many of morph targets, which one side may fuse and the other not.
#[test]
fn the_device_deforms_as_the_cpu_does() {
    let (loaded, mut scene) = scene();
    let settings = Settings::default();
    for moment in moments(&loaded.mesh, 7) {
        scene.set_moment(Some(moment)).expect("a small rig");
        engine().count(&mut scene, &inputs(&loaded, &settings), &mut Timing::Off).expect("counts");
        let (points, corners) = deformed(&scene);
        let posed = loaded.posed(Some(moment));
        let bound = 4.0 * ulp(&posed.topology);
        for (own, other) in points.iter().zip(&posed.topology.points) {
            let apart = glam::Vec3::from_slice(own).distance(*other);
            assert!(f64::from(apart) <= bound, "{moment:?}: {own:?} {other}");
        }
        for (own, other) in corners.iter().zip(&posed.mesh.corners) {
            let apart = glam::Vec3::from_slice(own).distance(other.normal);
            assert!(apart < 2e-6, "{moment:?}: {own:?} {}", other.normal);
        }
    }
}

#[test]
fn the_device_deforms_tangents_as_the_cpu_does() {
    let (loaded, _) = scene();
    let mut mesh = Mesh::clone(&loaded.mesh);
    let of = |(i, corner): (usize, &geometry::mesh::Corner)| CornerDetail {
        tangent: corner.normal.any_orthonormal_vector(),
        bitangent_sign: if i % 2 == 0 { 1.0 } else { -1.0 },
        uvs: [corner.uv, glam::Vec2::splat(i as f32)],
        ..CornerDetail::default()
    };
    let details: Vec<CornerDetail> = mesh.corners.iter().enumerate().map(of).collect();
    let rig = Arc::make_mut(mesh.rig.as_mut().expect("a document with clips"));
    rig.tangents = details.iter().map(|detail| detail.tangent.extend(detail.bitangent_sign).to_array()).collect();
    // Half of the corners that morph targets move have displacements of their tangents; the others turn them along.
    let displaced: Vec<_> = rig.bindings.iter().filter(|bound| bound.first_delta % 2 == 0).copied().collect();
    for bound in displaced.into_iter().filter(|bound| bound.delta_count > 0) {
        for delta in &mut rig.deltas[bound.first_delta as usize..][..bound.delta_count as usize] {
            let [x, y, z] = delta.position;
            delta.tangent = rig.tangents.len() as u32;
            rig.tangents.push([0.5 - z, x + 0.25, y, 0.0]);
        }
    }
    assert!(rig.deltas.iter().any(|delta| delta.tangent > 0) && rig.deltas.iter().any(|delta| delta.tangent == 0));
    mesh.details = Some(Arc::new(details));
    let loaded = Loaded { mesh: Arc::new(mesh), ..loaded };
    let mut scene = engine().scene(&loaded, ARENA_BYTES).expect("a small mesh");
    for moment in moments(&loaded.mesh, 3) {
        scene.set_moment(Some(moment)).expect("a small rig");
        engine().count(&mut scene, &inputs(&loaded, &Settings::default()), &mut Timing::Off).expect("counts");
        let buffer = &scene.tessellator.buffers().corner_details;
        let bytes = read_buffer(&engine().gpu, buffer, 0, buffer.size()).expect("a readback");
        let on_device: Vec<[f32; 12]> = bytemuck::pod_collect_to_vec(&bytes);
        let posed = loaded.posed(Some(moment));
        let on_host = posed.mesh.details.as_ref().expect("they stay");
        assert_eq!(on_device.len(), on_host.len());
        for (own, other) in on_device.iter().zip(on_host.iter()) {
            let [u, v, w, z] = [own[0], own[1], own[2], own[3]];
            assert_eq!([u, v, w, z], [other.uvs[0].x, other.uvs[0].y, other.uvs[1].x, other.uvs[1].y]);
            assert_eq!(own[4..8], [1.0; 4]);
            assert!(
                glam::Vec3::from_slice(&own[8..11]).distance(other.tangent) < 2e-6,
                "{moment:?}: {own:?} {other:?}"
            );
            assert_eq!(own[11], other.bitangent_sign, "{moment:?}");
        }
    }
}

#[test]
fn what_is_emitted_in_a_pose_is_what_the_cpu_emits() {
    let (loaded, mut scene) = scene();
    for surface in [Surface::Flat, Surface::Pn, Surface::PnAen] {
        for moment in moments(&loaded.mesh, 3) {
            let settings = Settings::from(Tessellation { surface, factor: 5.3, ..Tessellation::default() });
            scene.set_moment(Some(moment)).expect("a small rig");
            let posed = loaded.posed(Some(moment));
            let inputs = inputs(&posed, &settings);
            let gpu = on_gpu(&mut scene, &inputs);
            let cpu = tessellate(&posed.mesh, &posed.topology, &inputs, None);
            assert_agree(&posed, &gpu, &cpu, &format!("{surface:?} {moment:?}"));
        }
    }
}

#[test]
fn nothing_cracks_however_it_moves() {
    let (loaded, mut scene) = scene();
    assert!(loaded.topology.is_closed_and_oriented(), "a beam of faces that share nothing but positions");
    let counts = loaded.topology.edge_counts();
    assert!(counts.split > 0 && counts.boundary == 0, "{counts:?}");
    for moment in moments(&loaded.mesh, 9) {
        for lod in [Lod::Uniform, Lod::EdgeLength, Lod::Error] {
            let partitioning = if lod == Lod::Error { Partitioning::Integer } else { Partitioning::FractionalEven };
            let settings = Settings::from(Tessellation {
                surface: Surface::PnAen,
                lod,
                partitioning,
                factor: 6.7,
                ..Tessellation::default()
            });
            scene.set_moment(Some(moment)).expect("a small rig");
            let inputs = inputs(&loaded.posed(Some(moment)), &settings);
            engine().count(&mut scene, &inputs, &mut Timing::Off).expect("counts");
            let measured = engine().measure(&mut scene).expect("a readback");
            assert!(measured.cracks.edge_points > 100, "{moment:?} {lod:?}");
            assert_eq!(measured.cracks.different_bits, 0, "{moment:?} {lod:?}");
            assert_eq!(measured.cracks.different_factors, 0, "{moment:?} {lod:?}");
            assert_eq!(measured.not_finite, 0, "{moment:?} {lod:?}");
        }
    }
    // What measures sees the pose: PN tears split normals in it.
    let torn = Settings::from(Tessellation { surface: Surface::Pn, ..Tessellation::default() });
    engine().count(&mut scene, &inputs(&loaded, &torn), &mut Timing::Off).expect("counts");
    assert!(engine().measure(&mut scene).expect("a readback").cracks.different_bits > 0);
}

#[test]
fn the_same_pose_recomputes_nothing_and_rest_is_as_before() {
    let (loaded, mut scene) = scene();
    let settings = Settings::default();
    let inputs = inputs(&loaded, &settings);
    let at_rest = on_gpu(&mut scene, &inputs);
    let moment = Moment { clip: 3, time: 0.6 };
    let passes = |scene: &mut Scene| {
        let mut timing = Timing::on(&engine().gpu);
        engine().count(scene, &inputs, &mut timing).expect("counts");
        let times = take_times(&engine().gpu, &mut timing);
        times.into_iter().map(|time| time.pass).filter(|pass| ["deform", "nets"].contains(pass)).collect::<Vec<_>>()
    };
    scene.set_moment(Some(moment)).expect("a small rig");
    assert_eq!(passes(&mut scene), ["deform", "nets"]);
    let generation = scene.tessellator.generation();
    let bent = on_gpu(&mut scene, &inputs);
    assert!(bent != at_rest);
    scene.set_moment(Some(moment)).expect("a small rig");
    assert_eq!(passes(&mut scene), [""; 0], "nothing has changed");
    assert_eq!(scene.tessellator.generation(), generation);
    // Another surface makes other nets of the same pose, also where sides share other curves.
    let pn = settings
        .with(Tessellation { surface: Surface::Pn, edges: Edges::AsPublished, ..settings.tessellation })
        .inputs(inputs.view);
    assert!(on_gpu(&mut scene, &pn) != bent);
    assert!(on_gpu(&mut scene, &inputs) == bent, "back to the bit");
    scene.set_moment(None).expect("rest");
    assert!(on_gpu(&mut scene, &inputs) == at_rest, "back to the bit");
}

#[test]
fn the_pass_is_timed_where_something_is_deformed() {
    let (_, mut scene) = scene();
    scene.set_moment(Some(Moment { clip: 0, time: 0.3 })).expect("a small rig");
    let target = Target::new(&engine().gpu, [64, 64]).expect("a small picture");
    let camera = Camera::framing(&scene.bounds, target.viewport());
    let view = camera.lod_view(target.viewport(), &scene.bounds);
    let times =
        engine().time(&mut scene, &target, &camera, view, &Settings::default(), Runs::default()).expect("a draw");
    // Triangles that cover nothing are left out where the device is faster for it.
    let passes: Vec<_> = times.iter().map(|time| time.pass).filter(|&pass| pass != "coverage").collect();
    assert_eq!((passes[0], &passes[1..]), ("deform", &crate::passes::RIGID_PASSES[..]));
}

#[test]
fn backs_stay_in_a_pose() {
    let (loaded, mut scene) = scene();
    assert!(scene.tessellator.is_solid());
    let settings = Settings::from(Tessellation { cull_back_faces: true, ..Tessellation::default() });
    let inputs = inputs(&loaded, &settings);
    engine().count(&mut scene, &inputs, &mut Timing::Off).expect("counts");
    assert!(engine().measure(&mut scene).expect("a readback").culled.facing_away > 0);
    scene.set_moment(Some(Moment { clip: 0, time: 0.3 })).expect("a small rig");
    engine().count(&mut scene, &inputs, &mut Timing::Off).expect("counts");
    let measured = engine().measure(&mut scene).expect("a readback");
    assert_eq!(measured.culled.total(), 0);
    assert!(!scene.tessellator.shows_fronts_only(inputs.view.clip_from_object));
    let target = Target::new(&engine().gpu, [320, 240]).expect("a small picture");
    let camera = Camera::framing(&scene.bounds, target.viewport());
    engine().draw(&mut scene, &target, &camera, &settings, &mut Timing::Off).expect("a draw");
    assert_eq!(engine().leaks(&mut scene, &measured, target.size, &camera).expect("a readback"), Some(0));
}

#[test]
fn a_clip_is_framed_all_through() {
    let (loaded, mut scene) = scene();
    let at_rest = scene.bounds;
    assert_eq!(at_rest, loaded.mesh.bounds());
    for (clip, name) in CLIPS.iter().enumerate() {
        assert_eq!(rig(&loaded.mesh).clip(name), Some(clip));
        scene.frame_clip(Some(clip));
        let slack = 0.05 * scene.bounds.radius();
        for moment in moments(&loaded.mesh, 23).into_iter().filter(|moment| moment.clip == clip) {
            let posed = loaded.posed(Some(moment)).mesh.bounds();
            let is_inside = posed.min.cmpge(scene.bounds.min - slack) & posed.max.cmple(scene.bounds.max + slack);
            assert!(is_inside.all(), "{name} {moment:?}");
        }
    }
    scene.frame_clip(None);
    assert_eq!(scene.bounds, at_rest);
}

#[test]
fn a_mesh_that_cannot_move_takes_no_pose() {
    let (loaded, mut scene) = crate::scene(geometry::mesh::Shape::Torus);
    let inputs = inputs(&loaded, &Settings::default());
    let before = on_gpu(&mut scene, &inputs);
    scene.set_moment(Some(Moment { clip: 0, time: 1.0 })).expect("nothing to upload");
    scene.tessellator.set_pose(Some(Arc::default())).expect("nothing to upload");
    assert!(on_gpu(&mut scene, &inputs) == before);
}

#[test]
fn both_halves_of_a_split_are_in_one_pose() {
    let (loaded, mut scene) = scene();
    scene.frame_clip(Some(0));
    let target = Target::new(&engine().gpu, [240, 160]).expect("a small picture");
    let camera = Camera::framing(&scene.bounds, target.viewport());
    let right = Settings::from(Tessellation { surface: Surface::Flat, ..Tessellation::default() });
    let split =
        Settings { split: Some(0.5), left: Tessellation { surface: Surface::Flat, ..right.tessellation }, ..right };
    for moment in moments(&loaded.mesh, 3).into_iter().map(Some).chain([None]) {
        scene.set_moment(moment).expect("a small rig");
        let [both, alone] = [split, right].map(|settings| {
            engine().draw(&mut scene, &target, &camera, &settings, &mut Timing::Off).expect("a draw");
            target.read(&engine().gpu).expect("a readback")
        });
        assert!(both == alone, "{moment:?}: one surface on both sides is no split");
    }
}
