//! From loose triangles to a [`Mesh`]: grouped by material, every distinct corner once.

mod distinct;

use std::ops::Range;

use glam::{Vec2, Vec3};

use super::build_limits::{BuildError, MemoryAccount, MemoryRefused, Unlimited};
use super::generate_normals::{Loose, generate_normals};
use super::normals::Given;
use super::weld::{plus_zero2, plus_zero3};
use super::{Corner, Material, Mesh, Repairs};
use crate::progress::{Cancelled, Progress};

use distinct::Distinct;

/// The most triangles that lie in one piece while they are gathered: what has been gathered isn't copied for more.
const RUN: usize = 1 << 16;

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
/// grows with them, and with 12 bytes a triangle (`budget` has the formula).
#[derive(Default)]
pub struct MeshBuilder {
    groups: Vec<Group>,
    distinct: Distinct,
    triangles: usize,
    /// How many corners have been offered; how many will be, and how many of them distinct, if that is known.
    offered: usize,
    expected: [usize; 2],
    /// What has been mended.
    repairs: Repairs,
}

/// The triangles of one material.
struct Group {
    material: Material,
    runs: Vec<Vec<[u32; 3]>>,
}

impl Group {
    /// How many triangles there is room for without another run.
    fn room(&self) -> usize {
        self.runs.last().map_or(0, |run| run.capacity() - run.len())
    }

    /// How long the next run is to be: as long as all others, but not too long.
    fn next_run(&self) -> usize {
        (4 << self.runs.len().min(20)).min(RUN)
    }
}

impl MeshBuilder {
    pub fn new() -> Self {
        Self::default()
    }

    /// About so many corners more will be offered, and so many of them will be distinct.
    pub fn expect(&mut self, offered: usize, distinct: usize) {
        self.expected = [self.offered + offered, self.distinct.corners.len() + distinct];
    }

    /// Makes room for so many more distinct corners, within the budget: if there are too few, for as many as there will be by
    /// those that there are, or half as many again where nobody knows.
    ///
    /// # Errors
    /// [`MemoryRefused`].
    pub fn make_room(&mut self, corners: usize, budget: &dyn MemoryAccount) -> Result<(), MemoryRefused> {
        if self.distinct.room() >= corners {
            return Ok(());
        }
        let count = self.distinct.corners.len();
        let [offered, distinct] = self.expected;
        let likely = match self.offered {
            // And a few, since corners that turn out to be there already need room too.
            _ if count < distinct => distinct + 64,
            so_far if so_far < offered => {
                let all = (count as u128 * offered as u128 / so_far.max(1) as u128) as usize;
                (all + all / 16).min(offered)
            }
            _ => (count + count / 2).max(64),
        };
        self.distinct.make_room(corners.max(likely.saturating_sub(count)), budget)
    }

    /// The same for so many more triangles of one material.
    ///
    /// # Errors
    /// As [`make_room`](Self::make_room).
    ///
    /// # Panics
    /// As [`triangle`](Self::triangle).
    pub fn make_room_for_triangles(
        &mut self,
        material: usize,
        triangles: usize,
        budget: &dyn MemoryAccount,
    ) -> Result<(), MemoryRefused> {
        let group = &mut self.groups[material];
        if group.room() < triangles {
            let count = triangles.max(group.next_run());
            budget.hold(count as u64 * 12)?;
            group.runs.push(Vec::with_capacity(count));
        }
        Ok(())
    }

    /// Adds a material (its `triangles` are set at the end) and returns its index for [`triangle`](Self::triangle).
    /// The mesh has its materials in the order of these calls.
    pub fn material(&mut self, material: Material) -> usize {
        self.groups.push(Group { material, runs: Vec::new() });
        self.groups.len() - 1
    }

    /// Adds a triangle, counter-clockwise seen from outside.
    ///
    /// # Panics
    /// When `material` isn't an index that [`material`](Self::material) gave.
    pub fn triangle(&mut self, material: usize, corners: [LooseCorner; 3]) {
        let kept = corners.map(|corner| self.corner(corner, 0));
        self.kept_triangle(material, kept);
    }

    /// Keeps a corner for [`kept_triangle`](Self::kept_triangle). Corners are told apart by what they are bound to as well: those
    /// with different numbers aren't merged.
    pub fn corner(&mut self, corner: LooseCorner, binding: u32) -> Kept {
        let (corner, mended) = repaired(corner);
        self.offered += 1;
        Kept { id: self.distinct.id(corner, binding), mended }
    }

    /// Adds a triangle of corners that are kept.
    ///
    /// # Panics
    /// As [`triangle`](Self::triangle).
    pub fn kept_triangle(&mut self, material: usize, corners: [Kept; 3]) {
        let group = &mut self.groups[material];
        if group.room() == 0 {
            let count = group.next_run();
            group.runs.push(Vec::with_capacity(count));
        }
        corners.iter().for_each(|corner| corner.mended.count(&mut self.repairs));
        if let Some(run) = group.runs.last_mut() {
            run.push(corners.map(|corner| corner.id));
        }
        self.triangles += 1;
    }

    /// How many triangles there are so far.
    pub fn len(&self) -> usize {
        self.triangles
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The mesh: triangles grouped by material, in the order they came; corners with the same bits (-0 counts as 0)
    /// merged, in the order of first use; materials without triangles left out. Normals that are missing or have no
    /// direction are made (see [`super::normals::fan_normals`]), others brought to unit length (see [`Given`]); coordinates of
    /// positions nearer to 0 than f32's least normal number become 0, since devices may take them for it. All that is
    /// counted in the mesh's `repairs`. Linear in triangles.
    ///
    /// # Errors
    /// [`Cancelled`] when `progress` says so.
    pub fn finish(self, name: String, progress: &Progress) -> Result<Mesh, Cancelled> {
        match self.finish_bound(name, &Unlimited, progress) {
            Ok((mesh, _)) => Ok(mesh),
            // Memory is unlimited, so that nothing but a cancellation ends it.
            Err(_) => Err(Cancelled),
        }
    }

    /// The same within a budget, and the number of each corner's binding (see [`corner`](Self::corner)).
    ///
    /// # Errors
    /// [`BuildError`].
    pub fn finish_bound(
        mut self,
        name: String,
        budget: &dyn MemoryAccount,
        progress: &Progress,
    ) -> Result<(Mesh, Vec<u32>), BuildError> {
        self.distinct.close(budget);
        let (triangles, materials) = self.gathered(budget)?;
        progress.check()?;
        let Distinct { corners, bindings, .. } = self.distinct;
        let mut loose = Loose { corners, bindings, triangles };
        if loose.corners.iter().any(|corner| corner.normal.x.is_nan()) {
            generate_normals(&mut loose, budget, progress)?;
        }
        budget.borrow(loose.corners.len() as u64 * 4)?;
        renumber(&mut loose);
        progress.check()?;
        let Loose { mut corners, mut bindings, triangles } = loose;
        bindings.resize(corners.len(), 0);
        if corners.capacity() > corners.len() + corners.len() / 8 {
            budget.borrow(corners.len() as u64 * 32)?;
            corners.shrink_to_fit();
        }
        let repairs = self.repairs;
        Ok((Mesh { name, corners, triangles: triangles.into(), materials, repairs, ..Mesh::default() }, bindings))
    }

    /// All triangles in one list, and the materials that own some.
    fn gathered(&mut self, budget: &dyn MemoryAccount) -> Result<(Vec<[u32; 3]>, Vec<Material>), BuildError> {
        let used = |group: &Group| group.runs.iter().any(|run| !run.is_empty());
        let mut groups: Vec<Group> = std::mem::take(&mut self.groups).into_iter().filter(used).collect();
        let is_full = |run: &Vec<[u32; 3]>| run.len() == run.capacity();
        let whole = match groups.as_mut_slice() {
            [Group { runs, .. }] if runs.len() == 1 => runs.pop_if(|run| is_full(run)),
            _ => None,
        };
        let is_whole = whole.is_some();
        let mut triangles = whole.unwrap_or_default();
        if !is_whole {
            budget.borrow(self.triangles as u64 * 12)?;
            triangles.reserve_exact(self.triangles);
        }
        let mut materials = Vec::with_capacity(groups.len());
        for Group { mut material, runs } in groups {
            let first = if is_whole { 0 } else { triangles.len() as u32 };
            runs.into_iter().for_each(|run| triangles.extend(run));
            material.triangles = Range { start: first, end: triangles.len() as u32 };
            materials.push(material);
        }
        budget.give_back_to(0);
        Ok((triangles, materials))
    }
}

/// Puts corners in the order of first use, in place; what nothing uses goes.
fn renumber(loose: &mut Loose) {
    let Loose { corners, bindings, triangles } = loose;
    let mut numbers = vec![u32::MAX; corners.len()];
    let mut next = 0;
    for corner in triangles.as_flattened_mut() {
        let number = &mut numbers[*corner as usize];
        if *number == u32::MAX {
            *number = next;
            next += 1;
        }
        *corner = *number;
    }
    let used = next as usize;
    for number in numbers.iter_mut().filter(|number| **number == u32::MAX) {
        *number = next;
        next += 1;
    }
    for i in 0..corners.len() {
        while numbers[i] as usize != i {
            let to = numbers[i] as usize;
            corners.swap(i, to);
            if !bindings.is_empty() {
                bindings.swap(i, to);
            }
            numbers.swap(i, to);
        }
    }
    corners.truncate(used);
    bindings.truncate(used);
}

/// A corner that a builder has: its number, and what had to be mended, which counts for every triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Kept {
    pub id: u32,
    pub mended: Mended,
}

/// What had to be mended of a corner, one bit each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mended(pub u8);

impl Mended {
    const DENORMAL: u8 = 1;
    const MADE: u8 = 2;
    const REPLACED: u8 = 4;
    const RESCALED: u8 = 8;
    /// How many bits it has: others may be used for something else.
    pub const BITS: u32 = 4;

    fn count(self, repairs: &mut Repairs) {
        if self.0 == 0 {
            return;
        }
        let has = |bit: u8| u32::from(self.0 & bit != 0);
        repairs.denormals += has(Self::DENORMAL);
        repairs.normals_made += has(Self::MADE);
        repairs.normals_replaced += has(Self::REPLACED);
        repairs.normals_rescaled += has(Self::RESCALED);
    }
}

/// A corner with a position and a normal that are fit for use: NaN in place of a normal that is missing or without a direction.
fn repaired(corner: LooseCorner) -> (Corner, Mended) {
    let position = Vec3::from(corner.position.to_array().map(|x| if x.is_subnormal() { 0.0 } else { x }));
    let mut mended = if position == corner.position { 0 } else { Mended::DENORMAL };
    let given = corner.normal.map(Given::new);
    mended |= match given {
        None => Mended::MADE,
        Some(Given::None) => Mended::REPLACED,
        Some(Given::Rescaled(_)) => Mended::RESCALED,
        Some(Given::Unit(_)) => 0,
    };
    let normal = given.and_then(Given::unit).map_or(Vec3::NAN, plus_zero3);
    (Corner { position: plus_zero3(position), normal, uv: plus_zero2(corner.uv) }, Mended(mended))
}

impl Material {
    /// A material of one colour (linear RGBA), without triangles yet.
    pub fn plain(name: &str, base_color: [f32; 4]) -> Self {
        Self { name: name.to_owned(), base_color, texture: None, double_sided: false, triangles: 0..0 }
    }
}

#[cfg(test)]
mod tests;
