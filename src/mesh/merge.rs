//! From loose triangles to a [`Mesh`]: grouped by material, every distinct corner once.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::fmt;
use std::hash::BuildHasher;

use foldhash::fast::RandomState;

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

/// Collects triangles, material by material, and makes a mesh of them. Each distinct corner is kept once: what it holds
/// grows with them, and with 12 bytes a triangle.
#[derive(Debug, Default)]
pub struct MeshBuilder {
    groups: Vec<(Material, Vec<[u32; 3]>)>,
    distinct: Distinct,
    /// What has been mended.
    repairs: Repairs,
}

impl MeshBuilder {
    pub fn new() -> Self {
        Self::default()
    }

    /// Makes room for so many distinct corners at once: growing bit by bit would take half as much again.
    pub fn reserve(&mut self, corners: usize) {
        self.distinct.corners.reserve_exact(corners);
        self.distinct.bindings.reserve_exact(corners);
        self.distinct.ids.reserve(corners);
    }

    /// The same for so many triangles of one material.
    ///
    /// # Panics
    /// As [`triangle`](Self::triangle).
    pub fn reserve_triangles(&mut self, material: usize, triangles: usize) {
        self.groups[material].1.reserve(triangles);
    }

    /// Adds a material (its `triangles` are set at the end) and returns its index for [`triangle`](Self::triangle).
    /// The mesh has its materials in the order of these calls.
    pub fn material(&mut self, material: Material) -> usize {
        self.groups.push((material, Vec::new()));
        self.groups.len() - 1
    }

    /// Adds a triangle, counter-clockwise seen from outside.
    ///
    /// # Panics
    /// When `material` isn't an index that [`material`](Self::material) gave.
    pub fn triangle(&mut self, material: usize, corners: [LooseCorner; 3]) {
        self.bound_triangle(material, corners, [0; 3]);
    }

    /// Adds a triangle whose corners are told apart by what they are bound to as well: those with different numbers aren't
    /// merged.
    ///
    /// # Panics
    /// As [`triangle`](Self::triangle).
    pub fn bound_triangle(&mut self, material: usize, corners: [LooseCorner; 3], bindings: [u32; 3]) {
        let ids = [0, 1, 2].map(|k| {
            let corner = repaired(corners[k], &mut self.repairs);
            self.distinct.id(corner, bindings[k])
        });
        self.groups[material].1.push(ids);
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

    /// The same, and the number of each corner's binding (see [`bound_triangle`](Self::bound_triangle)).
    ///
    /// # Errors
    /// [`Cancelled`] when `progress` says so.
    pub fn finish_bound(mut self, name: String, progress: &Progress) -> Result<(Mesh, Vec<u32>), Cancelled> {
        if self.distinct.corners.iter().any(|corner| corner.normal.is_none()) {
            self.make_missing_normals(progress)?;
        }
        let repairs = self.repairs;
        let mut mesh = Mesh { name, repairs, warnings: repairs.warnings(), ..Mesh::default() };
        let Distinct { corners, bindings, ids } = self.distinct;
        drop(ids);
        let mut numbers = vec![u32::MAX; corners.len()];
        let mut corner_bindings = Vec::with_capacity(corners.len());
        mesh.corners.reserve_exact(corners.len());
        mesh.triangles.reserve_exact(self.groups.iter().map(|(_, triangles)| triangles.len()).sum());
        for (mut material, triangles) in self.groups {
            progress.check()?;
            if triangles.is_empty() {
                continue;
            }
            let first = mesh.triangles.len() as u32;
            for triangle in triangles {
                mesh.triangles.push(triangle.map(|id| {
                    let number = &mut numbers[id as usize];
                    if *number == u32::MAX {
                        *number = mesh.corners.len() as u32;
                        let LooseCorner { position, normal, uv } = corners[id as usize];
                        mesh.corners.push(Corner { position, normal: normal.unwrap_or(Vec3::Z), uv });
                        corner_bindings.push(bindings[id as usize]);
                    }
                    *number
                }));
            }
            material.triangles = first..mesh.triangles.len() as u32;
            mesh.materials.push(material);
        }
        Ok((mesh, corner_bindings))
    }

    /// Gives normals to corners without: each triangle its own, so that a corner may become several.
    fn make_missing_normals(&mut self, progress: &Progress) -> Result<(), Cancelled> {
        let Distinct { corners, bindings, .. } = std::mem::take(&mut self.distinct);
        let triangles = || self.groups.iter().flat_map(|(_, triangles)| triangles);
        let positions: Vec<_> = triangles().map(|t| t.map(|id| corners[id as usize].position)).collect();
        let made = normals::smooth(&positions, progress)?;
        drop(positions);
        let triangles = self.groups.iter_mut().flat_map(|(_, triangles)| triangles);
        for (triangle, made) in triangles.zip(made) {
            for (id, made) in triangle.iter_mut().zip(made) {
                let corner = corners[*id as usize];
                let normal = corner.normal.unwrap_or(plus_zero3(made));
                *id = self.distinct.id(LooseCorner { normal: Some(normal), ..corner }, bindings[*id as usize]);
            }
        }
        Ok(())
    }
}

/// A corner with a position and a normal that are fit for use: a normal without a direction is none afterwards.
fn repaired(corner: LooseCorner, repairs: &mut Repairs) -> LooseCorner {
    let position = Vec3::from(corner.position.to_array().map(|x| if x.is_subnormal() { 0.0 } else { x }));
    repairs.denormals += u32::from(position != corner.position);
    let given = corner.normal.map(Given::new);
    match given {
        None => repairs.normals_made += 1,
        Some(Given::None) => repairs.normals_replaced += 1,
        Some(Given::Rescaled(_)) => repairs.normals_rescaled += 1,
        Some(Given::Unit(_)) => {}
    }
    let normal = given.and_then(Given::unit).map(plus_zero3);
    LooseCorner { position: plus_zero3(position), normal, uv: plus_zero2(corner.uv) }
}

/// Corners that differ in some bit, or in what they are bound to, in the order of their first appearance.
#[derive(Default)]
struct Distinct {
    corners: Vec<LooseCorner>,
    bindings: Vec<u32>,
    /// By a hash of all of it, or the next free number after that: a third of the memory that keys of their own would take.
    ids: HashMap<u64, u32, RandomState>,
}

impl Distinct {
    fn id(&mut self, corner: LooseCorner, binding: u32) -> u32 {
        let bits = bits(&corner);
        let [a, b, c, d] = bits;
        let mut hash = self.ids.hasher().hash_one((a, b, c, d, binding));
        loop {
            match self.ids.entry(hash) {
                Entry::Vacant(vacant) => {
                    let id = self.corners.len() as u32;
                    vacant.insert(id);
                    self.corners.push(corner);
                    self.bindings.push(binding);
                    return id;
                }
                Entry::Occupied(occupied) => {
                    let id = *occupied.get() as usize;
                    if self.bindings[id] == binding && self::bits(&self.corners[id]) == bits {
                        return id as u32;
                    }
                    hash = hash.wrapping_add(1);
                }
            }
        }
    }
}

impl fmt::Debug for Distinct {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} corners", self.corners.len())
    }
}

/// All of a corner; no normal is what no number is.
fn bits(corner: &LooseCorner) -> [u64; 4] {
    let pair = |a: f32, b: f32| u64::from(a.to_bits()) << 32 | u64::from(b.to_bits());
    let LooseCorner { position: p, normal, uv } = corner;
    let n = normal.unwrap_or(Vec3::NAN);
    [pair(p.x, p.y), pair(p.z, n.x), pair(n.y, n.z), pair(uv.x, uv.y)]
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
