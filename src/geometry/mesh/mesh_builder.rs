//! Builds a [`Mesh`] from single triangles: groups them by material, and merges equal corners.

mod distinct_corners;

use std::ops::Range;
use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::build_limits::{Borrowed, Budget, BuildError, MemoryRefused, borrowing};
use super::generate_normals::{CreaseAngles, generate_normals};
use super::normals::{CREASE_ANGLE, GivenNormal};
use super::unfinished_mesh::UnfinishedMesh;
use super::weld::plus_zero3;
use super::{Corner, Material, Mesh, PartRange, PartStyle, Repairs};
use crate::casts::to_u32;
use crate::cores::{in_ranges, ranges};
use crate::progress::{Cancelled, Progress};

use distinct_corners::DistinctCorners;

/// The greatest number of triangles in one list while they are collected. A list that is full isn't copied into a
/// larger one.
const MAX_RUN: usize = 1 << 16;

/// A corner from a file or a shape. Its normal may be missing or unusable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InputCorner {
    pub position: Vec3,
    /// The normal, of any length, or none. [`MeshBuilder::finish`] scales it to unit length, or computes one if this
    /// has no direction (see [`GivenNormal`]).
    pub normal: Option<Vec3>,
    pub uv: Vec2,
}

impl From<Corner> for InputCorner {
    fn from(corner: Corner) -> Self {
        Self { position: corner.position, normal: Some(corner.normal), uv: corner.uv }
    }
}

/// Collects triangles and builds a mesh. Equal corners are stored once: the memory that a builder takes grows with the
/// number of distinct corners, plus 12 bytes a triangle (the formula is in `load::memory_budget`).
#[derive(Default)]
pub struct MeshBuilder {
    groups: Vec<Group>,
    distinct: DistinctCorners,
    triangles: usize,
    /// How many corners have been added.
    offered: usize,
    /// How many corners will have been added in the end, and how many distinct ones, if that is known; otherwise 0.
    expected: [usize; 2],
    /// Counts of the repairs so far.
    repairs: Repairs,
    /// The part of the file that the next triangles belong to.
    part: Option<u32>,
    /// The angle up to which faces are smooth where normals are made, in degrees; none for [`CREASE_ANGLE`].
    crease_angle: Option<f32>,
    /// What parts have in place of what is said for all, by the numbers that they are [entered](Self::enter_part) with.
    pub part_styles: Vec<PartStyle>,
}

/// Triangles, the materials that have some, and their parts.
type Gathered = (Vec<[u32; 3]>, Vec<Material>, Vec<PartRange>);

/// The triangles of one material.
struct Group {
    material: Material,
    /// Lists of triangles, of which all but the last are full.
    runs: Vec<Vec<[u32; 3]>>,
    triangles: u32,
    /// The parts that triangles belong to, each with the first triangle of the group that does.
    parts: Vec<(u32, Option<u32>)>,
}

impl Group {
    /// Counts triangles of a part.
    fn count(&mut self, triangles: usize, part: Option<u32>) {
        if triangles > 0 && self.parts.last().map_or(part.is_some(), |(_, last)| *last != part) {
            self.parts.push((self.triangles, part));
        }
        self.triangles += to_u32(triangles);
    }

    /// The parts of the triangles, of which the first one becomes that of this number.
    fn ranges(&self, first: u32) -> impl Iterator<Item = PartRange> {
        let ends = self.parts.iter().skip(1).map(|(next, _)| *next).chain([self.triangles]);
        let ranges = self.parts.iter().zip(ends);
        ranges.filter_map(move |(&(start, part), end)| {
            Some(PartRange { triangles: first + start..first + end, part: part? })
        })
    }

    /// Returns how many more triangles fit into the last list.
    fn room(&self) -> usize {
        self.runs.last().map_or(0, |run| run.capacity() - run.len())
    }

    /// Returns the length of the next list: as long as all lists before it together, but limited.
    fn next_run(&self) -> usize {
        (4 << self.runs.len().min(20)).min(MAX_RUN)
    }
}

/// The least number of corners of triangles that are worth a thread.
const LEAST: usize = 1 << 16;

/// How many corners are looked up one right after the other.
const BATCH: usize = 32;

/// How many corners at once are worth several cores.
const MANY: usize = 1 << 11;

impl MeshBuilder {
    pub fn new() -> Self {
        Self::default()
    }

    /// Starts a mesh whose missing normals are smooth where faces meet at up to this angle, in degrees from 0 to 180.
    pub fn with_crease_angle(crease_angle: f32) -> Self {
        Self { crease_angle: Some(crease_angle), ..Self::default() }
    }

    /// Announces that about `offered` more corners will be added, and that about `distinct` of them will be distinct.
    pub fn expect(&mut self, offered: usize, distinct: usize) {
        self.expected = [self.offered + offered, self.distinct.corners.len() + distinct];
    }

    /// Makes room for `corners` more distinct corners, within the budget. If there is too little, it makes room for as
    /// many as the ratio of distinct corners so far suggests; or for half as many again if the total isn't known.
    ///
    /// # Errors
    /// [`MemoryRefused`].
    pub fn make_room(&mut self, corners: usize, budget: &Budget) -> Result<(), MemoryRefused> {
        if self.distinct.room() >= corners {
            return Ok(());
        }
        let count = self.distinct.corners.len();
        let [offered, distinct] = self.expected;
        let likely = match self.offered {
            // And a few more: corners that turn out not to be distinct need room while they are looked up.
            _ if count < distinct => distinct + corners.max(64),
            so_far if so_far < offered => {
                let all = (count as u128 * offered as u128 / so_far.max(1) as u128) as usize;
                (all + all / 16).min(offered)
            }
            _ => (count + count / 2).max(64),
        };
        self.distinct.make_room(corners.max(likely.saturating_sub(count)), budget)
    }

    /// Returns how many more distinct corners there is room for.
    pub fn room(&self) -> usize {
        self.distinct.room()
    }

    /// Makes room for `triangles` more triangles of one material, within the budget.
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
        budget: &Budget,
    ) -> Result<(), MemoryRefused> {
        // If there is a single material, its triangles needn't be copied into one list in the end.
        let is_single = self.groups.len() == 1 && self.is_empty();
        let all = if is_single { self.expected[0] / 3 } else { 0 };
        let group = &mut self.groups[material];
        if group.room() < triangles {
            let least = triangles.max(group.next_run());
            let held = [all.max(least), least].into_iter().find(|&count| budget.hold(count as u64 * 12).is_ok());
            let Some(count) = held else { return budget.hold(least as u64 * 12) };
            group.runs.push(Vec::with_capacity(count));
        }
        Ok(())
    }

    /// Adds a material and returns its index for [`triangle`](Self::triangle). The material's `triangles` are set at
    /// the end. The mesh has its materials in the order of these calls.
    pub fn material(&mut self, material: Material) -> usize {
        self.groups.push(Group { material, runs: Vec::new(), triangles: 0, parts: Vec::new() });
        self.groups.len() - 1
    }

    /// Says which part of the file the next triangles belong to.
    pub fn enter_part(&mut self, part: Option<u32>) {
        self.part = part;
    }

    /// Returns how many materials have triangles.
    pub fn used_materials(&self) -> usize {
        self.groups.iter().filter(|group| group.triangles > 0).count()
    }

    /// Removes the triangles of each material for which `is_left_out`, which gets its name and their number, says so.
    ///
    /// # Errors
    /// Those of `is_left_out`.
    pub fn leave_out<E>(&mut self, mut is_left_out: impl FnMut(&str, u32) -> Result<bool, E>) -> Result<(), E> {
        for group in self.groups.iter_mut().filter(|group| group.triangles > 0) {
            if is_left_out(&group.material.name, group.triangles)? {
                self.triangles -= group.triangles as usize;
                (group.runs, group.parts, group.triangles) = Default::default();
            }
        }
        Ok(())
    }

    /// A material that was added.
    ///
    /// # Panics
    /// If `material` isn't an index that [`material`](Self::material) returned.
    pub fn material_mut(&mut self, material: usize) -> &mut Material {
        &mut self.groups[material].material
    }

    /// The number of distinct corners so far.
    pub fn distinct_corners(&self) -> usize {
        self.distinct.corners.len()
    }

    /// Adds a triangle; its corners are counter-clockwise seen from outside.
    ///
    /// # Panics
    /// If `material` isn't an index that [`material`](Self::material) returned.
    pub fn triangle(&mut self, material: usize, corners: [InputCorner; 3]) {
        let kept = corners.map(|corner| self.corner(corner, 0));
        self.stored_triangle(material, kept);
    }

    /// Stores a corner for [`stored_triangle`](Self::stored_triangle). Corners with different bindings (numbers of the
    /// caller's, for animation) aren't merged.
    pub fn corner(&mut self, corner: InputCorner, binding: u32) -> StoredCorner {
        let (corner, repairs) = repaired(corner);
        self.offered += 1;
        let hash = self.distinct.hash(&corner, binding);
        StoredCorner { id: self.distinct.id_of(hash, corner, binding), repairs }
    }

    /// Stores corners with their bindings as [`corner`](Self::corner) does, and appends what is stored to `stored`. Many are looked up on all
    /// cores.
    pub fn corners(&mut self, corners: &[(InputCorner, u32)], stored: &mut Vec<StoredCorner>) {
        self.offered += corners.len();
        if corners.len() < MANY || rayon::current_num_threads() == 1 {
            return self.few_corners(corners, stored);
        }
        let (offered, repairs): (Vec<_>, Vec<_>) = corners
            .par_iter()
            .map(|&(corner, binding)| {
                let (corner, repairs) = repaired(corner);
                ((corner, binding), repairs)
            })
            .unzip();
        let ids = self.distinct.ids(&offered);
        stored.extend(ids.into_iter().zip(repairs).map(|(id, repairs)| StoredCorner { id, repairs }));
    }

    /// Equal corners are looked up one right after the other: the processor then waits for memory once for several of them.
    fn few_corners(&mut self, corners: &[(InputCorner, u32)], stored: &mut Vec<StoredCorner>) {
        for some in corners.chunks(BATCH) {
            let none = Corner { position: Vec3::ZERO, normal: Vec3::ZERO, uv: Vec2::ZERO };
            let mut own = [(none, CornerRepairs::default(), 0, 0); BATCH];
            for (own, &(corner, binding)) in own.iter_mut().zip(some) {
                let (corner, repairs) = repaired(corner);
                *own = (corner, repairs, binding, self.distinct.hash(&corner, binding));
            }
            own[..some.len()].iter().for_each(|&(.., hash)| self.distinct.approach(hash));
            for &(corner, repairs, binding, hash) in &own[..some.len()] {
                stored.push(StoredCorner { id: self.distinct.id_of(hash, corner, binding), repairs });
            }
        }
    }

    /// Adds a triangle of stored corners.
    ///
    /// # Panics
    /// As [`triangle`](Self::triangle).
    pub fn stored_triangle(&mut self, material: usize, corners: [StoredCorner; 3]) {
        corners.iter().for_each(|corner| corner.repairs.count(&mut self.repairs));
        self.keep(material, &[corners.map(|corner| corner.id)]);
    }

    /// Adds triangles of stored corners as [`stored_triangle`](Self::stored_triangle) does: the corners' numbers, and the repairs of
    /// them all.
    ///
    /// # Panics
    /// As [`triangle`](Self::triangle).
    pub fn stored_triangles(&mut self, material: usize, triangles: &[[u32; 3]], repairs: &Repairs) {
        self.repairs.add(repairs);
        self.keep(material, triangles);
    }

    fn keep(&mut self, material: usize, mut triangles: &[[u32; 3]]) {
        self.triangles += triangles.len();
        let group = &mut self.groups[material];
        group.count(triangles.len(), self.part);
        while !triangles.is_empty() {
            if group.room() == 0 {
                let count = group.next_run();
                group.runs.push(Vec::with_capacity(count));
            }
            let (now, later) = triangles.split_at(group.room().min(triangles.len()));
            group.runs.last_mut().into_iter().for_each(|run| run.extend_from_slice(now));
            triangles = later;
        }
    }

    /// Returns how many triangles have been added.
    pub fn len(&self) -> usize {
        self.triangles
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Builds the mesh. Triangles are grouped by material and keep their order otherwise. Corners with the same bits
    /// (-0 counts as 0) are merged, in the order of first use. Materials without triangles are left out. Normals that
    /// are missing or have no direction are computed (see `normals::fan_normals`); others are scaled to unit
    /// length (see [`GivenNormal`]). Coordinates of positions that are nearer to 0 than f32's least normal number
    /// become 0, since devices may treat them as 0. The mesh's `repairs` counts these changes. Takes time linear in the
    /// number of triangles.
    ///
    /// # Errors
    /// [`Cancelled`] when `progress` says so.
    pub fn finish(self, name: String, progress: &Progress) -> Result<Mesh, Cancelled> {
        match self.finish_bound(name, &Budget::unlimited(), progress) {
            Ok((mesh, _)) => Ok(mesh),
            // Memory is unlimited, so cancellation is the only possible error.
            Err(_) => Err(Cancelled),
        }
    }

    /// Builds the mesh as [`finish`](Self::finish) does, within a budget, and returns each corner's binding too (see
    /// [`corner`](Self::corner)).
    ///
    /// # Errors
    /// [`BuildError`].
    pub fn finish_bound(
        mut self,
        name: String,
        budget: &Budget,
        progress: &Progress,
    ) -> Result<(Mesh, Vec<u32>), BuildError> {
        self.distinct.close(budget);
        let (triangles, materials, part_ranges) = borrowing(budget, || self.gathered(budget))?;
        progress.check()?;
        let DistinctCorners { corners, bindings, .. } = self.distinct;
        let mut mesh = UnfinishedMesh { corners, bindings, triangles };
        let (repairs, part_styles) = (self.repairs, self.part_styles);
        let made = Mesh { name, materials, part_ranges, part_styles, repairs, ..Mesh::default() };
        if mesh.corners.iter().any(|corner| corner.normal.x.is_nan()) {
            let angles = CreaseAngles::new(self.crease_angle.unwrap_or(CREASE_ANGLE), &made);
            generate_normals(&mut mesh, &angles, budget, progress)?;
        }
        let _scope = Borrowed::from(budget);
        budget.borrow(mesh.corners.len() as u64 * 4)?;
        renumber(&mut mesh, budget);
        progress.check()?;
        let UnfinishedMesh { mut corners, mut bindings, triangles } = mesh;
        bindings.resize(corners.len(), 0);
        if corners.capacity() > corners.len() + corners.len() / 8 {
            budget.borrow(corners.len() as u64 * 32)?;
            corners.shrink_to_fit();
        }
        Ok((Mesh { corners, triangles: triangles.into(), ..made }, bindings))
    }

    /// Joins all triangles into one list, and returns it with the materials that have triangles, and with the parts.
    fn gathered(&mut self, budget: &Budget) -> Result<Gathered, BuildError> {
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
        let mut parts = Vec::new();
        for group in groups {
            let first = if is_whole { 0 } else { to_u32(triangles.len()) };
            parts.extend(group.ranges(first));
            let Group { mut material, runs, .. } = group;
            runs.into_iter().for_each(|run| triangles.extend(run));
            material.triangles = Range { start: first, end: to_u32(triangles.len()) };
            materials.push(material);
        }
        Ok((triangles, materials, parts))
    }
}

/// Puts corners in the order of first use, and removes those that no triangle uses. 4 bytes for each corner were borrowed for it.
fn renumber(UnfinishedMesh { corners, bindings, triangles }: &mut UnfinishedMesh, budget: &Budget) {
    if are_in_order(corners.len(), triangles) {
        return;
    }
    let (numbers, used) = numbers_by_first_use(corners.len(), triangles.as_flattened());
    let number = |corner: u32| numbers[corner as usize].load(Relaxed);
    triangles.par_iter_mut().for_each(|triangle| *triangle = triangle.map(number));
    if budget.borrow(corners.len() as u64 * 12).is_ok() {
        let order: Vec<AtomicU32> = (0..used).map(|_| AtomicU32::new(0)).collect();
        numbers.par_iter().enumerate().for_each(|(corner, number)| {
            if let Some(place) = order.get(number.load(Relaxed) as usize) {
                place.store(to_u32(corner), Relaxed);
            }
        });
        drop(numbers);
        let from: Vec<u32> = order.into_iter().map(AtomicU32::into_inner).collect();
        // Lists of single attributes can be filled by all cores, and are short beside the corners.
        reorder(corners, &from, |corner| corner.position, |corner, position| corner.position = position);
        reorder(corners, &from, |corner| corner.normal, |corner, normal| corner.normal = normal);
        reorder(corners, &from, |corner| corner.uv, |corner, uv| corner.uv = uv);
        if !bindings.is_empty() {
            reorder(bindings, &from, |binding| *binding, |binding, own| *binding = own);
        }
    } else {
        swap_into_order(corners, bindings, numbers.into_iter().map(AtomicU32::into_inner).collect());
    }
    corners.truncate(used);
    bindings.truncate(used);
}

/// Gives each of the first items an attribute of the item that `from` names for it.
fn reorder<T: Send + Sync, A: Send>(
    items: &mut [T],
    from: &[u32],
    attribute: impl Fn(&T) -> A + Sync,
    set: impl Fn(&mut T, A) + Sync,
) {
    let new: Vec<A> = from.par_iter().map(|&item| attribute(&items[item as usize])).collect();
    items.par_iter_mut().zip(new).for_each(|(item, own)| set(item, own));
}

/// Numbers `count` corners in the order in which `uses` names them first; those that it doesn't name have the number `u32::MAX`. Returns
/// the numbers, and how many corners are named.
fn numbers_by_first_use(count: usize, uses: &[u32]) -> (Vec<AtomicU32>, usize) {
    // First, the first place in `uses` that names each corner.
    let numbers: Vec<_> = (0..count).map(|_| AtomicU32::new(u32::MAX)).collect();
    let number_at = |place: usize| &numbers[uses[place] as usize];
    in_ranges(uses.len(), LEAST, |range| {
        // Most places are later ones, which only read.
        for place in range.filter(|&place| to_u32(place) < number_at(place).load(Relaxed)) {
            number_at(place).fetch_min(to_u32(place), Relaxed);
        }
    });
    let is_first = |place: &usize| number_at(*place).load(Relaxed) == to_u32(*place);
    let counts = in_ranges(uses.len(), LEAST, |range| range.filter(is_first).count());
    let mut used = 0;
    let starts = counts.into_iter().map(|count| {
        used += count;
        used - count
    });
    let parts: Vec<_> = ranges(uses.len(), LEAST).zip(starts).collect();
    // A number isn't above the place that it replaces, so that no later place takes it for its own.
    parts.into_par_iter().for_each(|(range, start)| {
        range.filter(is_first).zip(start..).for_each(|(place, number)| number_at(place).store(to_u32(number), Relaxed));
    });
    (numbers, used)
}

/// Puts corners where their numbers say, in place. Those without a number come last.
fn swap_into_order(corners: &mut [Corner], bindings: &mut [u32], mut numbers: Vec<u32>) {
    let used = numbers.iter().filter(|number| **number != u32::MAX).count();
    let unnumbered = numbers.iter_mut().filter(|number| **number == u32::MAX);
    unnumbered.zip(to_u32(used)..).for_each(|(number, next)| *number = next);
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
}

/// Whether all corners are used, in the order of their first use.
fn are_in_order(corners: usize, triangles: &[[u32; 3]]) -> bool {
    let mut next = 0;
    let is_next = |&corner: &u32| {
        next += u32::from(corner == next);
        corner < next
    };
    triangles.as_flattened().iter().all(is_next) && next as usize == corners
}

/// A corner that a builder stores: its number, and its repairs, which count for every triangle that uses it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StoredCorner {
    pub id: u32,
    pub repairs: CornerRepairs,
}

/// How a corner was repaired, one bit for each kind of repair.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CornerRepairs(pub u8);

impl CornerRepairs {
    const DENORMAL: u8 = 1;
    const MADE: u8 = 2;
    const REPLACED: u8 = 4;
    const RESCALED: u8 = 8;
    /// How many bits are used; callers may use the others.
    pub const BITS: u32 = 4;

    /// Counts the repairs of a corner.
    pub fn count(self, repairs: &mut Repairs) {
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

/// Returns a corner with a usable position and normal, and what was repaired. The normal is NaN if it is missing or has
/// no direction.
fn repaired(corner: InputCorner) -> (Corner, CornerRepairs) {
    let position = Vec3::from(corner.position.to_array().map(|x| if x.is_subnormal() { 0.0 } else { x }));
    let mut repairs = if position == corner.position { 0 } else { CornerRepairs::DENORMAL };
    let given = corner.normal.map(GivenNormal::new);
    repairs |= match given {
        None => CornerRepairs::MADE,
        Some(GivenNormal::None) => CornerRepairs::REPLACED,
        Some(GivenNormal::Rescaled(_)) => CornerRepairs::RESCALED,
        Some(GivenNormal::Unit(_)) => 0,
    };
    let normal = given.and_then(GivenNormal::unit).map_or(Vec3::NAN, plus_zero3);
    (Corner { position: plus_zero3(position), normal, uv: corner.uv + Vec2::ZERO }, CornerRepairs(repairs))
}

#[cfg(test)]
mod tests;
