//! Meshes of files that were turned and scaled: what moves them, and what belongs to them, follows.

use geometry::mesh::{Moment, UpAxis};
use geometry::progress::Progress;
use glam::{Mat3, Vec3, vec3};
use gpu::Timing;
use inspect::engine::{Loaded, Preparation, load};
use inspect::settings::{ARENA_BYTES, Settings};
use load::{FileUnit, Import, LengthUnit, Source};

use crate::engine;
use crate::passes::inputs;
use documents::moving::{CLIPS, moving};

fn placed(import: Import) -> Loaded {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("moving.glb");
    std::fs::write(&path, moving()).expect("a writable temporary folder");
    let preparation = Preparation { import, ..Preparation::default() };
    load(&Source::File(path), &preparation, &Progress::default()).expect("what was just written")
}

/// Joints of a skin, a node that flies, and morph targets.
#[test]
fn every_pose_of_an_animated_file_is_turned_and_scaled() {
    let plain = placed(Import::default());
    let import = Import { up: Some(UpAxis::Z), unit: Some(FileUnit::Named(LengthUnit::Inch)), ..Import::default() };
    let turned = placed(import);
    // Z becomes up, as a matrix whose columns are where the axes go.
    let matrix = Mat3::from_cols(Vec3::X, Vec3::NEG_Z, Vec3::Y);
    let mut scene = engine().scene(&turned, ARENA_BYTES).expect("a small mesh");
    let size = plain.mesh.bounds().diagonal() * 0.0254;
    for clip in 0..CLIPS.len() {
        for time in [0.0, 0.3, 0.9] {
            let moment = Some(Moment { clip, time });
            let [own, other] = [&plain, &turned].map(|loaded| loaded.posed(moment).mesh);
            assert_eq!(own.corners.len(), other.corners.len());
            for (own, other) in own.corners.iter().zip(&other.corners) {
                let expected = matrix * own.position * 0.0254;
                assert!(other.position.distance(expected) < 1e-5 * size, "{} and not {expected}", other.position);
                assert!(other.normal.distance(matrix * own.normal) < 1e-5, "{} of {}", other.normal, own.normal);
            }
            scene.set_moment(moment).expect("a small rig");
            engine().count(&mut scene, &inputs(&turned, &Settings::default()), &mut Timing::Off).expect("counts");
        }
    }
}

#[test]
fn lights_and_cameras_stay_where_they_are_in_the_scene() {
    let document = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
        "nodes":[{"mesh":0},{"translation":[1,2,3],"camera":0,"extensions":{"KHR_lights_punctual":{"light":0}}}],
        "cameras":[{"type":"orthographic","orthographic":{"xmag":4,"ymag":4,"znear":0.1,"zfar":100}}],
        "extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","range":10}]}},
        "extensionsUsed":["KHR_lights_punctual"],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],"bufferViews":[{"buffer":0,"byteLength":36}],
        "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("lit.gltf");
    std::fs::write(&path, document).expect("a writable temporary folder");
    let import = Import { up: Some(UpAxis::Z), unit: Some(FileUnit::Metres(0.01)), ..Import::default() };
    let preparation = Preparation { import, ..Preparation::default() };
    let mesh = load(&Source::File(path), &preparation, &Progress::default()).expect("a triangle").mesh;
    let near = |a: Vec3, b: Vec3| assert!(a.distance(b) < 1e-6, "{a} and not {b}");
    near(mesh.lights[0].place, vec3(0.01, 0.03, -0.02));
    // A camera looks along -Z of its node, which points down now.
    near(mesh.lights[0].direction, Vec3::NEG_Y);
    assert_eq!(mesh.lights[0].kind, geometry::mesh::LightKind::Point { range: Some(0.1) });
    near(mesh.cameras[0].eye, vec3(0.01, 0.03, -0.02));
    assert_eq!(mesh.cameras[0].axes, [Vec3::X, Vec3::NEG_Z, Vec3::Y]);
    assert_eq!(mesh.cameras[0].projection, geometry::mesh::Projection::Orthographic(0.04));
}
