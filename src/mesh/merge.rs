//! From loose triangles to a [`Mesh`]: grouped by material, every distinct corner once.

use std::collections::HashMap;

use super::normals::{self, Given};
use super::weld::{plus_zero2, plus_zero3};
use super::{Corner, Material, Mesh, Progress, Repairs};
use crate::mesh::progress::Cancelled;
use glam::{Vec2, Vec3};

/// A corner as a file or a shape gives it: the normal may be missing, or not fit for use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LooseCorner {
    pub position: Vec3,
    /// Of any length, or none. [`MeshBuilder::finish`] brings it to unit length, or makes one where this has no
    /// direction (see [`Given`]).
    pub normal: Option<Vec3>,
    pub uv: Vec2,
}

impl From<Corner> for LooseCorner {
    fn from(corner: Corner) -> Self {
        Self { position: corner.position, normal: Some(corner.normal), uv: corner.uv }
    }
}

/// Collects triangles, material by material, and makes a mesh of them.
#[derive(Debug, Default)]
pub struct MeshBuilder {
    groups: Vec<(Material, Vec<[LooseCorner; 3]>)>,
    /// A group's, as many as it has triangles; or none at all, which are all 0.
    bindings: Vec<Vec<[u32; 3]>>,
}

impl MeshBuilder {
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a material (its `triangles` are set at the end) and returns its index for [`triangle`](Self::triangle).
    /// The mesh has its materials in the order of these calls.
    pub fn material(&mut self, material: Material) -> usize {
        self.groups.push((material, Vec::new()));
        self.bindings.push(Vec::new());
        self.groups.len() - 1
    }

    /// Adds a triangle, counter-clockwise seen from outside.
    ///
    /// # Panics
    /// When `material` isn't an index that [`material`](Self::material) gave.
    pub fn triangle(&mut self, material: usize, corners: [LooseCorner; 3]) {
        self.groups[material].1.push(corners);
    }

    /// Tells corners of one material's next triangles apart by what they are bound to: those with different numbers aren't
    /// merged. For all triangles or for none.
    ///
    /// # Panics
    /// As [`triangle`](Self::triangle).
    pub fn bind(&mut self, material: usize, bindings: Vec<[u32; 3]>) {
        self.bindings[material].extend(bindings);
    }

    /// How many triangles there are so far.
    pub fn len(&self) -> usize {
        self.groups.iter().map(|(_, triangles)| triangles.len()).sum()
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The mesh: triangles grouped by material, in the order they came; corners with the same bits (-0 counts as 0)
    /// merged, in the order of first use; materials without triangles left out. Normals that are missing or have no
    /// direction are made (see [`normals::smooth`]), others brought to unit length (see [`Given`]); coordinates of
    /// positions nearer to 0 than f32's least normal number become 0, since devices may take them for it. All that is
    /// counted in the mesh's `repairs`, and said in its `warnings`. Linear in triangles.
    ///
    /// # Errors
    /// [`Cancelled`] when `progress` says so.
    pub fn finish(self, name: String, progress: &Progress) -> Result<Mesh, Cancelled> {
        Ok(self.finish_bound(name, progress)?.0)
    }

    /// The same, and the number of each corner's binding (see [`bind`](Self::bind)).
    ///
    /// # Errors
    /// [`Cancelled`] when `progress` says so.
    pub fn finish_bound(mut self, name: String, progress: &Progress) -> Result<(Mesh, Vec<u32>), Cancelled> {
        let bindings = std::mem::take(&mut self.bindings);
        let mut corner_bindings = Vec::new();
        let repairs = self.repair();
        self.make_missing_normals(progress)?;
        let mut mesh = Mesh { name, repairs, warnings: repairs.warnings(), ..Mesh::default() };
        let mut ids = HashMap::new();
        for ((mut material, triangles), bindings) in self.groups.into_iter().zip(bindings) {
            progress.check()?;
            if triangles.is_empty() {
                continue;
            }
            let first = mesh.triangles.len() as u32;
            for (triangle, corners) in triangles.into_iter().enumerate() {
                let bound = bindings.get(triangle).copied().unwrap_or_default();
                mesh.triangles.push([0, 1, 2].map(|k| {
                    let corner = corner_id(&mut ids, &mut mesh.corners, corners[k], bound[k]);
                    corner_bindings.resize(mesh.corners.len(), bound[k]);
                    corner
                }));
            }
            material.triangles = first..mesh.triangles.len() as u32;
            mesh.materials.push(material);
        }
        Ok((mesh, corner_bindings))
    }

    /// Makes positions and normals fit for use. Normals without a direction are none afterwards.
    fn repair(&mut self) -> Repairs {
        let mut repairs = Repairs::default();
        for corner in self.groups.iter_mut().flat_map(|(_, triangles)| triangles).flatten() {
            let flushed = Vec3::from(corner.position.to_array().map(|x| if x.is_subnormal() { 0.0 } else { x }));
            repairs.denormals += u32::from(flushed != corner.position);
            corner.position = flushed;
            let given = corner.normal.map(Given::new);
            match given {
                None => repairs.normals_made += 1,
                Some(Given::None) => repairs.normals_replaced += 1,
                Some(Given::Rescaled(_)) => repairs.normals_rescaled += 1,
                Some(Given::Unit(_)) => {}
            }
            corner.normal = given.and_then(Given::unit);
        }
        repairs
    }

    fn make_missing_normals(&mut self, progress: &Progress) -> Result<(), Cancelled> {
        let triangles = || self.groups.iter().flat_map(|(_, triangles)| triangles);
        if triangles().flatten().all(|corner| corner.normal.is_some()) {
            return Ok(());
        }
        let positions: Vec<_> = triangles().map(|triangle| triangle.map(|corner| corner.position)).collect();
        let made = normals::smooth(&positions, progress)?;
        let corners = self.groups.iter_mut().flat_map(|(_, triangles)| triangles).flatten();
        for (corner, normal) in corners.zip(made.into_iter().flatten()) {
            corner.normal.get_or_insert(normal);
        }
        Ok(())
    }
}

fn corner_id(ids: &mut HashMap<[u32; 9], u32>, corners: &mut Vec<Corner>, loose: LooseCorner, binding: u32) -> u32 {
    let position = plus_zero3(loose.position);
    let normal = plus_zero3(loose.normal.unwrap_or(Vec3::Z));
    let uv = plus_zero2(loose.uv);
    let [[x, y, z], [a, b, c]] = [position, normal].map(|v| v.to_array().map(f32::to_bits));
    *ids.entry([x, y, z, a, b, c, uv.x.to_bits(), uv.y.to_bits(), binding]).or_insert_with(|| {
        corners.push(Corner { position, normal, uv });
        corners.len() as u32 - 1
    })
}

impl Material {
    /// A material of one colour (linear RGBA), without triangles yet.
    pub fn plain(name: &str, base_color: [f32; 4]) -> Self {
        Self { name: name.to_owned(), base_color, texture: None, double_sided: false, triangles: 0..0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(x: f32, y: f32) -> LooseCorner {
        LooseCorner { position: Vec3::new(x, y, 0.0), normal: Some(Vec3::Z), uv: Vec2::ZERO }
    }

    #[test]
    fn triangles_are_grouped_and_corners_shared() {
        let mut builder = MeshBuilder::new();
        let red = builder.material(Material::plain("red", [1.0, 0.0, 0.0, 1.0]));
        let unused = builder.material(Material::plain("unused", [1.0; 4]));
        let blue = builder.material(Material::plain("blue", [0.0, 0.0, 1.0, 1.0]));
        assert_eq!([red, unused, blue], [0, 1, 2]);
        builder.triangle(blue, [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0)]);
        builder.triangle(red, [corner(-0.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)]);
        builder.triangle(blue, [corner(1.0, 0.0), corner(2.0, 0.0), corner(1.0, 1.0)]);
        let mesh = builder.finish("two".to_owned(), &Progress::new()).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 3, 1], [3, 4, 1]]);
        assert_eq!(mesh.corners.len(), 5);
        let ranges: Vec<_> = mesh.materials.iter().map(|m| (m.name.as_str(), m.triangles.clone())).collect();
        assert_eq!(ranges, [("red", 0..1), ("blue", 1..3)]);
    }

    #[test]
    fn only_missing_normals_are_made() {
        let mut builder = MeshBuilder::new();
        let material = builder.material(Material::plain("plain", [1.0; 4]));
        let mut corners = [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0)];
        corners[0].normal = Some(Vec3::X);
        corners[1].normal = None;
        builder.triangle(material, corners);
        let mesh = builder.finish(String::new(), &Progress::new()).unwrap();
        let normals: Vec<_> = mesh.corners.iter().map(|c| c.normal).collect();
        assert_eq!(normals, [Vec3::X, Vec3::Z, Vec3::Z]);
        assert_eq!(mesh.repairs, Repairs { normals_made: 1, ..Repairs::default() });
        assert!(mesh.warnings.is_empty());
    }

    fn one(corners: [LooseCorner; 3]) -> Mesh {
        let mut builder = MeshBuilder::new();
        let material = builder.material(Material::plain("plain", [1.0; 4]));
        builder.triangle(material, corners);
        builder.finish(String::new(), &Progress::new()).unwrap()
    }

    #[test]
    fn bad_normals_are_mended_and_counted() {
        let mut corners = [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0)];
        let bad = [[0.0, -1e-30, 0.0], [f32::NAN, 0.0, 0.0], [0.0, 0.0, 0.0]];
        for (corner, normal) in corners.iter_mut().zip(bad) {
            corner.normal = Some(normal.into());
        }
        let mesh = one(corners);
        assert_eq!(mesh.corners.iter().map(|c| c.normal).collect::<Vec<_>>(), [Vec3::NEG_Y, Vec3::Z, Vec3::Z]);
        assert_eq!(mesh.repairs, Repairs { normals_replaced: 2, normals_rescaled: 1, ..Repairs::default() });
        assert_eq!(mesh.warnings, mesh.repairs.warnings());
    }

    #[test]
    fn coordinates_that_devices_drop_are_dropped_here_too() {
        let least = f32::MIN_POSITIVE;
        let mesh = one([corner(least.next_down(), -1e-45), corner(least, 1.0), corner(-least, 0.0)]);
        let positions: Vec<_> = mesh.corners.iter().map(|c| [c.position.x, c.position.y].map(f32::to_bits)).collect();
        assert_eq!(positions, [[0.0, 0.0], [least, 1.0], [-least, 0.0]].map(|xy| xy.map(f32::to_bits)));
        assert_eq!(mesh.repairs, Repairs { denormals: 1, ..Repairs::default() });
        assert_eq!(mesh.warnings.len(), 1);
    }
}
