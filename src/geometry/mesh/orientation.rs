//! Turns and scales a mesh, with everything that hangs on it, so that +Y points up and its unit is another.

use crate::choice::choices;
use std::sync::Arc;

use glam::{DMat3, DMat4, Vec3};

use super::{LightKind, Material, Mesh, Projection, Rig};
use crate::casts::to_f32;

choices! {
    /// An axis of a file's coordinates, which points up.
    #[derive(Default, Hash)]
    pub enum UpAxis {
        #[default]
        Y => "y", "Y", "The y axis points up.";
        Z => "z", "Z", "The z axis points up, as in most programs for construction, printing and maps.";
        X => "x", "X", "The x axis points up.";
        NegX => "-x", "-X", "The x axis points down.";
        NegY => "-y", "-Y", "The y axis points down.";
        NegZ => "-z", "-Z", "The z axis points down.";
    }
}

impl UpAxis {
    /// Turns a vector so that this axis becomes +Y: about the x axis, or about the z axis if this axis is along x. A quarter or a half
    /// turn is exact.
    pub fn turn(self, v: Vec3) -> Vec3 {
        let Vec3 { x, y, z } = v;
        let turned = match self {
            Self::X => [-y, x, z],
            Self::Y => return v,
            Self::Z => [x, z, -y],
            Self::NegX => [y, -x, z],
            Self::NegY => [x, -y, -z],
            Self::NegZ => [x, -z, y],
        };
        // The sum makes 0 of -0.
        Vec3::from(turned) + Vec3::ZERO
    }

    /// The same turn as a matrix.
    fn matrix(self) -> DMat3 {
        let [x, y, z] = Vec3::AXES.map(|axis| self.turn(axis).as_dvec3());
        DMat3::from_cols(x, y, z)
    }
}

/// Turns a mesh so that `up` becomes +Y, and multiplies all lengths by `scale`. Coordinates that become smaller than f32's least
/// normal number become 0, as those of files do. `scale` is above 0 and at most 1, so that no coordinate leaves f32.
pub fn reorient(mesh: &mut Mesh, up: UpAxis, scale: f64) {
    if up == UpAxis::Y && scale == 1.0 {
        return;
    }
    let length = |length: f32| {
        let scaled = to_f32(f64::from(length) * scale);
        if scaled.is_subnormal() { 0.0 } else { scaled }
    };
    let place = |v: Vec3| Vec3::from(up.turn(v).to_array().map(length)) + Vec3::ZERO;
    for corner in &mut mesh.corners {
        corner.position = place(corner.position);
        corner.normal = up.turn(corner.normal);
    }
    if let Some(details) = &mut mesh.details {
        Arc::make_mut(details).iter_mut().for_each(|detail| detail.tangent = up.turn(detail.tangent));
    }
    if let Some(rig) = &mut mesh.rig {
        reorient_rig(Arc::make_mut(rig), DMat4::from_mat3(up.matrix() * scale));
    }
    for Material { look, height, .. } in &mut mesh.materials {
        (look.thickness, look.attenuation_distance) = (length(look.thickness), length(look.attenuation_distance));
        if let Some(amount) = height.as_mut().and_then(|map| map.amount.as_mut()) {
            amount.scale = length(amount.scale);
        }
    }
    for light in &mut mesh.lights {
        (light.place, light.direction) = (place(light.place), up.turn(light.direction));
        if let LightKind::Point { range } | LightKind::Spot { range, .. } = &mut light.kind {
            *range = range.map(length);
        }
    }
    for camera in &mut mesh.cameras {
        camera.eye = place(camera.eye);
        camera.axes = camera.axes.map(|axis| up.turn(axis));
        if let Projection::Orthographic(half_height) = &mut camera.projection {
            *half_height = length(*half_height);
        }
    }
    let still = mesh.bones.iter_mut().filter(|bone| bone.node.is_none());
    still.for_each(|bone| bone.place = place(bone.place));
}

/// Puts a transform over all joints. Bindings are in the spaces of their joints, so they stay, and so do clips.
fn reorient_rig(rig: &mut Rig, transform: DMat4) {
    for node in rig.nodes.iter_mut().filter(|node| node.parent.is_none()) {
        node.between = transform * node.between;
    }
    let joints = rig.joints.iter_mut().chain(&mut rig.lights).chain(&mut rig.cameras);
    for joint in joints.filter(|joint| joint.node.is_none()) {
        joint.offset = transform * joint.offset;
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec2};
    use proptest::prelude::*;

    use super::*;
    use crate::mesh::rig::Joint;
    use crate::mesh::{Bone, Corner, HeightAmount, HeightMap};

    const ALL: [UpAxis; 6] = [UpAxis::X, UpAxis::Y, UpAxis::Z, UpAxis::NegX, UpAxis::NegY, UpAxis::NegZ];

    #[test]
    fn each_axis_becomes_up_by_a_rotation() {
        let axes = [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z];
        for (up, axis) in ALL.into_iter().zip(axes) {
            assert_eq!(up.turn(axis), Vec3::Y, "{up:?}");
            assert_eq!(up.matrix().determinant(), 1.0, "{up:?} mirrors nothing");
        }
        // Z up to Y up, as modelling programs export it.
        assert_eq!(UpAxis::Z.turn(Vec3::new(1.0, 2.0, 3.0)), Vec3::new(1.0, 3.0, -2.0));
    }

    #[test]
    fn what_becomes_zero_has_no_sign() {
        let position = Vec3::new(-0.0, -f32::MIN_POSITIVE, -1.0);
        let corner = Corner { position, normal: Vec3::Z, uv: Vec2::ZERO };
        let mut mesh = Mesh { corners: vec![corner], ..Mesh::default() };
        // Half of the least normal number is a subnormal one; a smaller part of it is rounded to -0.
        for scale in [0.5, 1e-10] {
            reorient(&mut mesh, UpAxis::Y, scale);
            let [x, y, _] = mesh.corners[0].position.to_array().map(f32::to_bits);
            assert_eq!([x, y], [0, 0], "{scale}");
            mesh.corners[0].position = position;
        }
    }

    #[test]
    fn what_no_clip_moves_is_turned_and_scaled_like_what_one_does() {
        let place = DVec3::new(0.0, 2.0, 4.0);
        let still = Joint { offset: DMat4::from_translation(place), ..Joint::default() };
        let rig = Rig { joints: vec![still], lights: vec![still], cameras: vec![still], ..Rig::default() };
        let bone = |node| Bone { node, place: place.as_vec3(), ..Bone::default() };
        let bones = vec![bone(None), bone(Some(0))];
        let mut mesh = Mesh { rig: Some(Arc::new(rig)), bones, ..Mesh::default() };
        reorient(&mut mesh, UpAxis::Z, 0.5);
        let pose = mesh.rig.as_ref().expect("it is kept").rest();
        let turned = Vec3::new(0.0, 2.0, -1.0);
        let places = [pose.lights[0], pose.cameras[0]].map(|own| own.w_axis.truncate().as_vec3());
        assert_eq!(places, [turned; 2]);
        assert_eq!(pose.palette[0].rows().map(|row| row[3]), turned.to_array());
        // The node moves what is in its own space.
        assert_eq!([mesh.bones[0].place, mesh.bones[1].place], [turned, place.as_vec3()]);
    }

    #[test]
    fn what_is_in_a_body_is_scaled_with_it() {
        let mut material = crate::mesh::Material::plain("body", [1.0; 4]);
        material.look.thickness = 4.0;
        let image = HeightMap::new([1, 1], vec![0.5]);
        material.height = Some(image.with_amount(HeightAmount::from_factor(4.0, -2.0)));
        let mut mesh = Mesh { materials: vec![material], ..Mesh::default() };
        for distance in [2.0, f32::INFINITY] {
            mesh.materials[0].look.attenuation_distance = distance;
            reorient(&mut mesh, UpAxis::Z, 0.5);
            assert_eq!(mesh.materials[0].look.attenuation_distance, 0.5 * distance);
        }
        assert_eq!(mesh.materials[0].look.thickness, 1.0);
        let amount = mesh.materials[0].height.as_ref().and_then(|map| map.amount);
        assert_eq!(amount, HeightAmount::from_factor(1.0, -0.5));
    }

    proptest! {
        #[test]
        fn the_turn_and_its_matrix_are_the_same_and_keep_lengths(v in prop::array::uniform3(-1e6_f32..1e6), up in 0..6_usize) {
            let (v, up) = (Vec3::from(v), ALL[up]);
            prop_assert_eq!((up.matrix() * v.as_dvec3()).as_vec3(), up.turn(v));
            let sorted = |v: Vec3| {
                let mut all = v.abs().to_array();
                all.sort_by(f32::total_cmp);
                all
            };
            prop_assert_eq!(sorted(up.turn(v)), sorted(v), "the numbers are the same to the bit");
        }
    }
}
