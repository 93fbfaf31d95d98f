//! Meshes that only some techniques fail on: creases that end, normals that lean, height images and poses.

use std::sync::Arc;

use glam::{DMat4, Vec2, Vec3, vec3};

use super::{corner, mesh, triangles};
use geometry::mesh::mesh_builder::InputCorner;
use geometry::mesh::rig::{
    AnimatedNode, Binding, Channel, Clip, Delta, Interpolation, Joint, Keys, Morph, Placement, Property, Reach,
};
use geometry::mesh::{Corner, Heights, Mesh, Rig, Shape};

/// A level sheet whose normals all lean one way, each a little more or less than the next. Along an edge in that direction
/// the tangents at both ends rise, and the tangent planes are nearly parallel.
pub(crate) fn inflection() -> Mesh {
    let at = |x: i32, z: i32| {
        let lean = vec3(0.6 + 0.02 * (x * x - z) as f32, 1.0, 0.01 * (x * z) as f32);
        corner(vec3(x as f32, 0.0, z as f32) * 0.5, lean.normalize())
    };
    let squares = (-2..2).flat_map(|x| (-2..2).map(move |z| (x, z)));
    mesh(squares.flat_map(|(x, z)| {
        let [a, b, c, d] = [at(x, z + 1), at(x + 1, z + 1), at(x + 1, z), at(x, z)];
        [[a, b, c], [a, c, d]]
    }))
}

/// A sheet with a crease of two edges that ends within it. The sides' normals differ at both ends of the first edge, at one
/// end of the second, and nowhere beyond it.
pub(crate) fn dart() -> Mesh {
    let normal = |x: f32, z: f32| vec3(0.3 * x, 1.0, 0.3 * z).normalize();
    let at = |x: i32, z: i32, side: f32| {
        let (x, z) = (x as f32, z as f32);
        let lean = if z == 0.0 && x < 0.5 { vec3(0.0, 0.0, 0.8 * side) } else { Vec3::ZERO };
        let height = if z == 0.0 && x < 0.5 { 0.35 } else { 0.1 };
        corner(vec3(x, height - 0.15 * (x * x + z * z), z), (normal(x, z) + lean).normalize())
    };
    let squares = (-2..2).flat_map(|x| [(x, 0, 1.0), (x, -1, -1.0)]);
    mesh(squares.flat_map(|(x, z, side)| {
        let [a, b, c, d] = [(x, z + 1), (x + 1, z + 1), (x + 1, z), (x, z)].map(|(x, z)| at(x, z, side));
        [[a, b, c], [a, c, d]]
    }))
}

/// A mesh displaced by waves.
pub(crate) fn displaced(mut mesh: Mesh) -> Mesh {
    mesh.heights = Some(Arc::new(Heights::waves(&mesh, 32, [2.0, 1.0])));
    mesh
}

/// A torus displaced by waves. Every other quarter of it reads another part of the height image, so that the heights on
/// both sides of a seam have nothing in common.
pub(crate) fn height_seams() -> Mesh {
    let quarter = |c: &Corner| (c.uv.x * 4.0 - 0.01).floor() as i32;
    let triangles = triangles(Shape::Torus).into_iter().map(|(_, corners)| {
        let shift =
            if corners.iter().map(quarter).max().unwrap_or(0) % 2 == 0 { Vec2::ZERO } else { Vec2::new(0.37, 0.21) };
        corners.map(|c| InputCorner { uv: c.uv + shift, ..InputCorner::from(c) })
    });
    displaced(mesh(triangles))
}

/// A cylinder that bends about its middle and swells in a clip of two seconds. It has two joints, whose weights change along
/// it, and a morph target, which applies before the joints. Normals are split between its caps and its side, and its side
/// has a seam.
pub(crate) fn moving() -> Mesh {
    let mut mesh = Shape::Cylinder.build();
    let bounds = mesh.bounds();
    let mut rig = Rig { joints: Vec::new(), ..Rig::default() };
    for (index, corner) in (0..).zip(&mesh.corners) {
        let up = (corner.position.y - bounds.min.y) / (bounds.max.y - bounds.min.y);
        let upper = up * up * (3.0 - 2.0 * up);
        rig.bindings.push(Binding {
            position: corner.position.to_array(),
            first_delta: index,
            normal: corner.normal.to_array(),
            delta_count: 1,
            joints: [0, 1, 0, 0],
            weights: [1.0 - upper, upper, 0.0, 0.0],
        });
        let swell = vec3(corner.position.x, 0.0, corner.position.z) * (4.0 * up * (1.0 - up));
        rig.deltas.push(Delta { position: swell.to_array(), weight: 0, ..Delta::default() });
        rig.alike.push(0);
    }
    let node = |parent| AnimatedNode { parent, between: DMat4::IDENTITY, rest: Placement::default(), is_joint: true };
    rig.nodes = vec![node(None), node(Some(0))];
    rig.joints = [0, 1].map(|node| Joint { node: Some(node), ..Joint::default() }).to_vec();
    rig.morphs = vec![Morph { first_weight: 0, rest: vec![0.0] }];
    let keys = |values: &[f32], width| Keys {
        times: vec![0.0, 1.0, 2.0],
        values: values.to_vec(),
        width,
        interpolation: Interpolation::Linear,
    };
    let bend = [0.0, 0.0, 0.0, 1.0, 0.5, 0.1, 0.0, 0.86, 0.0, 0.3, 0.3, 0.9];
    let rotation = Channel { target: 1, property: Property::Rotation, keys: keys(&bend, 4) };
    let weights = Channel { target: 0, property: Property::Weights, keys: keys(&[0.0, 1.0, -0.5], 1) };
    rig.clips = vec![Clip { name: "bend".to_owned(), duration: 2.0, channels: vec![rotation, weights] }];
    rig.reach = Reach::new(&rig.bindings, &rig.deltas, &[]);
    mesh.rig = Some(Arc::new(rig));
    mesh
}
