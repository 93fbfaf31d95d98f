//! Views through the cameras of a file, and through those of engines' frames.

use glam::Vec3;

use super::Camera;
use super::camera::{FIELD_OF_VIEW, FIELDS_OF_VIEW};
use super::view_projection::{ViewProjection, ViewProjectionError};
use geometry::mesh::{Bounds, FileCamera, Projection};

/// The least distance between eye and target, in bounding radii.
const LEAST_DISTANCE: f32 = 1e-3;

impl Camera {
    /// The view through a camera of a file, of a mesh with these bounds. The target is where the camera's axis passes the middle of
    /// the mesh. Its height is the camera's in pictures of any shape. Nothing far away is cut off, and of a perspective view only what
    /// is nearer than a thousandth of the distance to the target.
    pub fn from_file(file: &FileCamera, bounds: &Bounds) -> Self {
        let [right, _, back] = file.axes.map(Vec3::as_dvec3);
        // Straight up or down all azimuths are the same, and the roll has the rest.
        let across = back.x.hypot(back.z);
        let azimuth = if across > 0.0 { back.x.atan2(back.z) } else { 0.0 };
        let elevation = back.y.atan2(across);
        let level = glam::dvec3(azimuth.cos(), 0.0, -azimuth.sin());
        let roll = right.dot(back.cross(level)).atan2(right.dot(level));
        let depth = (file.eye - bounds.center()).as_dvec3().dot(back) as f32;
        let radius = if bounds.radius() > 0.0 { bounds.radius() } else { 1.0 };
        // The middle of the mesh may be behind the camera.
        let depth = if depth > LEAST_DISTANCE * radius { depth } else { radius };
        let target = (file.eye.as_dvec3() - back * f64::from(depth)).as_vec3();
        let view = Self {
            target,
            azimuth: azimuth.to_degrees() as f32,
            elevation: elevation.to_degrees() as f32,
            distance: depth,
            roll: roll.to_degrees() as f32,
            ..Self::default()
        };
        match file.projection {
            Projection::Perspective(angle) => {
                let [least, most] = [*FIELDS_OF_VIEW.start(), *FIELDS_OF_VIEW.end()];
                Self { field_of_view: angle.to_degrees().clamp(least, most), ..view }
            }
            Projection::Orthographic(half) => {
                let distance = half / (0.5 * FIELD_OF_VIEW).to_radians().tan();
                Self { orthographic: true, distance: distance.clamp(1e-30, 1e30), ..view }
            }
        }
    }

    /// The camera of an engine's frame, of a mesh with these bounds. Its angles and its distance are those of the nearest camera of
    /// ours: they turn the lights of the camera, and say how large a px is.
    ///
    /// # Errors
    /// The matrix isn't that of a view.
    pub fn from_matrix(matrix: &ViewProjection, bounds: &Bounds) -> Result<Self, ViewProjectionError> {
        let rows = matrix.rows()?;
        let axes = rows.axes();
        let (eye, projection) = match rows.eye {
            Some(eye) => (eye, Projection::Perspective(2.0 * rows.half_height().atan())),
            None => {
                let middle = rows.middle_beside(bounds.center()).ok_or(ViewProjectionError::Singular)?;
                let eye = middle + axes[2] * bounds.radius().max(f32::MIN_POSITIVE);
                (eye, Projection::Orthographic(rows.half_height()))
            }
        };
        let file = FileCamera { name: String::new(), eye, axes, projection };
        let camera = Self { rows: Some(rows), ..Self::from_file(&file, bounds) };
        if camera.is_sound() { Ok(camera) } else { Err(ViewProjectionError::TooFar) }
    }
}

#[cfg(test)]
mod engine_tests;

#[cfg(test)]
mod tests {
    use std::path::Path;

    use glam::{DMat4, DQuat, DVec2, DVec3, dvec2, dvec3, dvec4, vec2};
    use serde_json::json;

    use super::*;
    use geometry::progress::Progress;
    use geometry::view::project;
    use load::files::Limits;
    use load::format::Format;
    use load::mesh_file::read;

    /// A triangle, and a node with a camera below a node that turns and moves it.
    fn seen_through(
        camera: &serde_json::Value,
        parent: [DVec3; 2],
        rotation: DQuat,
        place: DVec3,
    ) -> (FileCamera, DMat4) {
        let [turn, shift] = parent;
        let turn = DQuat::from_euler(glam::EulerRot::YXZ, turn.x, turn.y, turn.z);
        let positions: Vec<u8> = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.5_f32]]
            .into_iter()
            .flatten()
            .flat_map(f32::to_le_bytes)
            .collect();
        use base64::prelude::{BASE64_STANDARD, Engine};
        let uri = format!("data:application/octet-stream;base64,{}", BASE64_STANDARD.encode(positions));
        let document = json!({
            "asset": { "version": "2.0" },
            "nodes": [
                { "mesh": 0 },
                { "children": [2], "rotation": turn.to_array(), "translation": shift.to_array(), "scale": [2, 2, 2] },
                { "name": "Shot", "camera": 0, "rotation": rotation.to_array(), "translation": place.to_array() },
            ],
            "cameras": [camera],
            "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
            "accessors": [{ "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3 }],
            "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
            "buffers": [{ "byteLength": 36, "uri": uri }],
        });
        let bytes = document.to_string().into_bytes();
        let loaded =
            read(Format::Gltf, bytes, Path::new("a.gltf"), Default::default(), &Limits::default(), &Progress::new());
        let loaded = loaded.expect("a triangle with a camera");
        let about_cameras = loaded.warnings.iter().filter(|warning| !warning.starts_with("primitives without normals"));
        assert_eq!(about_cameras.count(), 0, "{:?}", loaded.warnings);
        let [camera] = &loaded.mesh.cameras[..] else { panic!("{:?}", loaded.mesh.cameras) };
        // The scale isn't part of a camera's own transform: only where it stands.
        let eye = turn * (2.0 * place) + shift;
        (camera.clone(), DMat4::from_rotation_translation(turn * rotation, eye))
    }

    /// The pixel of a position by the matrices of the specification (section 3.10.3), in a picture of `size` px.
    fn expected(projection: DMat4, view: DMat4, size: DVec2, position: Vec3) -> DVec2 {
        let clip = projection * view.inverse() * position.as_dvec3().extend(1.0);
        assert!(clip.w > 0.0, "in front of the eye");
        (dvec2(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * size
    }

    #[test]
    fn corners_of_a_cube_are_where_the_specification_puts_them() {
        let corners = (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 2.0 - 1.0);
        let corners: Vec<_> = corners.collect();
        let bounds = Bounds::new(corners.iter().copied());
        let [near, far] = [0.01_f64, 100.0];
        for (size, yfov) in [([1280.0, 720.0], 0.4), ([300.0, 900.0], 1.2), ([1000.0, 1000.0], 0.9)] {
            for (turn, tilt, roll) in
                [(0.3, -0.4, 0.0), (-2.0, 0.5, 0.9), (3.0, -1.2, -2.5), (0.0, -std::f64::consts::FRAC_PI_2, 0.7)]
            {
                // Turned and tilted towards the cube, from a distance.
                let rotation = DQuat::from_euler(glam::EulerRot::YXZ, turn, tilt, roll);
                let parent = [dvec3(0.2, 0.1, -0.3), dvec3(0.5, 0.25, -1.0)];
                let around = DQuat::from_euler(glam::EulerRot::YXZ, parent[0].x, parent[0].y, parent[0].z);
                let eye = around * rotation * dvec3(0.2, -0.1, 9.0);
                let place = around.inverse() * (eye - parent[1]) / 2.0;
                let aspect = size[0] / size[1];
                let perspective = {
                    let f = 1.0 / f64::tan(0.5 * yfov);
                    let [a, b] = [(far + near) / (near - far), 2.0 * far * near / (near - far)];
                    let column = |x, y, z, w| dvec4(x, y, z, w);
                    DMat4::from_cols(
                        column(f / aspect, 0.0, 0.0, 0.0),
                        column(0.0, f, 0.0, 0.0),
                        column(0.0, 0.0, a, -1.0),
                        column(0.0, 0.0, b, 0.0),
                    )
                };
                let ymag = 2.5;
                let orthographic =
                    DMat4::from_diagonal(dvec4(1.0 / (ymag * aspect), 1.0 / ymag, 2.0 / (near - far), 1.0));
                for (camera, projection) in [
                    (
                        json!({ "type": "perspective", "perspective": { "yfov": yfov, "znear": near, "zfar": far } }),
                        perspective,
                    ),
                    (
                        json!({ "type": "orthographic",
                                "orthographic": { "xmag": 1, "ymag": ymag, "znear": near, "zfar": far } }),
                        orthographic,
                    ),
                ] {
                    let (file, view) = seen_through(&camera, parent, rotation, place);
                    assert_eq!(file.name, "Shot");
                    let viewport = vec2(size[0] as f32, size[1] as f32);
                    let own = Camera::from_file(&file, &bounds);
                    assert!(own.is_sound(), "{own:?}");
                    let clip = own.clip_from_object(viewport, &bounds);
                    for &corner in &corners {
                        let found = project(clip, viewport, corner).expect("in front of the eye").as_dvec2();
                        let expected = expected(projection, view, size.into(), corner);
                        assert!(found.distance(expected) < 0.01, "{corner}: {found}, not {expected}, of {camera}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_camera_within_or_behind_the_mesh_gives_a_valid_view() {
        let bounds = Bounds::new([Vec3::NEG_ONE, Vec3::ONE].into_iter());
        for eye in [Vec3::ZERO, Vec3::Z * -50.0, Vec3::ONE * 1e9] {
            for projection in [Projection::Perspective(3.1), Projection::Orthographic(1e-10)] {
                let file = FileCamera { name: String::new(), eye, axes: [Vec3::X, Vec3::Y, Vec3::Z], projection };
                let view = Camera::from_file(&file, &bounds);
                assert!(view.is_sound(), "{view:?}");
                assert!(view.orthographic || view.eye().distance(eye) <= 1e-6 * (1.0 + eye.length()), "{view:?}");
            }
        }
        let view = Camera::from_file(
            &FileCamera {
                name: String::new(),
                eye: Vec3::Y,
                axes: [Vec3::X, Vec3::NEG_Z, Vec3::Y],
                projection: Projection::Perspective(0.7),
            },
            &Bounds::new(std::iter::once(Vec3::ZERO)),
        );
        assert!(view.is_sound(), "a mesh of one point");
    }
}
