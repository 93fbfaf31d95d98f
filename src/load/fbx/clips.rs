//! Reads animations. Curves of FBX move Euler angles and pivots, in layers; ufbx samples them, and what comes out are key frames
//! of translations, rotations and scales, which are interpolated linearly.

use std::collections::HashMap;

use ufbx::{AnimStack, BakeOpts, BakedAnim, BakedNode, BakedVec3, BlendChannel, Scene};

use super::convert::{quaternion, vec3};
use super::looks::name;
use super::morphs::{channels, shape_weights};
use super::nodes::Placed;
use super::parse::{half, refused};
use super::too_large;
use crate::load::attachment::LocalTransform;
use crate::load::memory_budget::Budget;
use crate::load::notes::Notes;
use crate::load::read_error::ReadError;
use crate::mesh::MemoryAccount;
use crate::mesh::rig::{Channel, Clip, Interpolation, Keys, Placement, Property};
use crate::progress::Progress;

/// The greatest number of numbers in all clips together.
const MAX_NUMBERS: usize = 1 << 26;
/// How often a curve is sampled that isn't a straight line, in 1/s.
const SAMPLES: f64 = 60.0;
/// The greatest number of samples between two key frames.
const MAX_SEGMENTS: usize = 1 << 10;

/// Reads the clips of a scene, whose channels have its nodes as targets. Adds a warning for each that is left out.
///
/// # Errors
/// [`ReadError::TooLarge`] and [`ReadError::Cancelled`].
pub(super) fn read(
    scene: &Scene,
    placed: &Placed,
    (budget, progress): (&Budget, &Progress),
    notes: &mut Notes,
) -> Result<Vec<Clip>, ReadError> {
    let mut reader = Reader { scene, placed, budget, numbers_left: MAX_NUMBERS, hides: false };
    let mut clips = Vec::new();
    for (i, stack) in scene.anim_stacks.into_iter().enumerate() {
        progress.set(i as f32 / scene.anim_stacks.len() as f32);
        progress.check()?;
        match reader.clip(stack)? {
            Ok(clip) if clip.channels.is_empty() => {}
            Ok(clip) => clips.push(clip),
            Err(reason) => notes.push(format!("animation \"{}\" is left out: {reason}.", name(&stack.element))),
        }
    }
    if reader.hides {
        notes.push("animations that show and hide nodes, which are shown as without a clip.".to_owned());
    }
    Ok(clips)
}

struct Reader<'a> {
    scene: &'a Scene,
    placed: &'a Placed,
    budget: &'a Budget,
    numbers_left: usize,
    /// Whether a clip changes the visibility of a node.
    hides: bool,
}

impl Reader<'_> {
    /// Reads a clip. The inner error is a clause that says why it is left out.
    ///
    /// # Errors
    /// [`ReadError::TooLarge`] and [`ReadError::Cancelled`].
    fn clip(&mut self, stack: &AnimStack) -> Result<Result<Clip, String>, ReadError> {
        let options = BakeOpts {
            temp_allocator: half(self.budget),
            result_allocator: half(self.budget),
            trim_start_time: true,
            resample_rate: SAMPLES,
            max_keyframe_segments: MAX_SEGMENTS,
            key_reduction_enabled: true,
            key_reduction_rotation: true,
            ..BakeOpts::default()
        };
        let baked = ufbx::bake_anim(self.scene, &stack.anim, options).map_err(|error| refused(&error, self.budget))?;
        let bytes = baked.metadata.result_memory_used as u64;
        self.budget.hold(bytes).map_err(too_large)?;
        let channels = self.channels(&baked);
        drop(baked);
        self.budget.release(bytes);
        Ok(channels.map(|channels| {
            let last = channels.iter().filter_map(|channel| channel.keys.times.last());
            let duration = last.fold(0.0, |a: f32, b| a.max(*b)).into();
            Clip { name: name(&stack.element), duration, channels }
        }))
    }

    /// # Errors
    /// A clause that says why the clip is left out.
    fn channels(&mut self, baked: &BakedAnim) -> Result<Vec<Channel>, String> {
        let mut channels = Vec::new();
        for node in &baked.nodes {
            self.node(node, &mut channels)?;
        }
        let mut weights: HashMap<u32, &[BakedVec3]> = HashMap::new();
        for element in &baked.elements {
            for prop in &element.props {
                match prop.name.as_ref() {
                    "DeformPercent" => _ = weights.insert(element.element_id, &prop.keys),
                    "Visibility" => self.hides = true,
                    _ => {}
                }
            }
        }
        if !weights.is_empty() {
            for (node, _) in &self.placed.scene.morphed {
                channels.extend(self.weights(*node, &weights)?);
            }
        }
        Ok(channels)
    }

    /// Adds the channels of a node that change something.
    fn node(&mut self, baked: &BakedNode, channels: &mut Vec<Channel>) -> Result<(), String> {
        let index = baked.typed_id as usize;
        let Some(LocalTransform::Placement(rest)) = self.placed.scene.local.get(index).copied() else { return Ok(()) };
        let Placement { translation, rotation, scale } = rest;
        let target = baked.typed_id;
        let mut vectors = |keys: &[BakedVec3], property, rest: glam::DVec3| {
            if keys.iter().all(|key| vec3(&key.value) == rest) {
                return Ok(());
            }
            let keys = self.keys(keys.iter().map(|key| (key.time, vec3(&key.value).to_array())))?;
            channels.push(Channel { target, property, keys });
            Ok::<_, String>(())
        };
        vectors(&baked.translation_keys, Property::Translation, translation)?;
        vectors(&baked.scale_keys, Property::Scale, scale)?;
        if baked.rotation_keys.iter().any(|key| quaternion(&key.value) != rotation) {
            let keys = baked.rotation_keys.iter().map(|key| (key.time, quaternion(&key.value).to_array()));
            let keys = self.keys(keys)?;
            channels.push(Channel { target, property: Property::Rotation, keys });
        }
        Ok(())
    }

    /// Returns a channel with the weights of all morph targets of a node; none if the clip changes none of them.
    fn weights(&mut self, node: usize, baked: &HashMap<u32, &[BakedVec3]>) -> Result<Option<Channel>, String> {
        let Some(mesh) = self.scene.nodes.get(node).and_then(|node| node.mesh.as_ref()) else { return Ok(None) };
        let moved: Vec<(&BlendChannel, Option<&[BakedVec3]>)> =
            channels(mesh).map(|channel| (channel, baked.get(&channel.element.element_id).copied())).collect();
        let mut times: Vec<f64> = Vec::new();
        for (channel, keys) in &moved {
            let keys = keys.unwrap_or_default();
            times.extend(keys.iter().map(|key| key.time));
            times.extend(crossings(channel, keys));
            self.left(times.len())?;
        }
        if times.is_empty() {
            return Ok(None);
        }
        times.sort_by(f64::total_cmp);
        times.dedup();
        let width = moved.iter().map(|(channel, _)| channel.keyframes.len()).sum();
        let mut keys = Keys { times: Vec::new(), values: Vec::new(), width, interpolation: Interpolation::Linear };
        self.take(times.len().saturating_mul(width + 1))?;
        for time in times {
            let at = time as f32;
            if !at.is_finite() || at < 0.0 || keys.times.last().is_some_and(|&last| at <= last) {
                continue;
            }
            keys.times.push(at);
            for (channel, own) in &moved {
                let weight = own.map_or(channel.weight, |own| ufbx::evaluate_baked_vec3(own, time).x / 100.0);
                shape_weights(channel, weight, &mut keys.values);
            }
        }
        Ok((!keys.times.is_empty()).then_some(Channel { target: node as u32, property: Property::Weights, keys }))
    }

    /// Returns key frames whose times grow; those that are too close for an f32 are left out.
    fn keys<const N: usize>(&mut self, baked: impl ExactSizeIterator<Item = (f64, [f64; N])>) -> Result<Keys, String> {
        self.take(baked.len().saturating_mul(N + 1))?;
        let mut keys = Keys { times: Vec::new(), values: Vec::new(), width: N, interpolation: Interpolation::Linear };
        for (time, value) in baked {
            let (time, value) = (time as f32, value.map(|x| x as f32));
            if !time.is_finite() || value.iter().any(|x| !x.is_finite()) {
                return Err("it has times or values that aren't finite".to_owned());
            }
            if time >= 0.0 && keys.times.last().is_none_or(|&last| time > last) {
                keys.times.push(time);
                keys.values.extend(value);
            }
        }
        if keys.times.is_empty() { Err("it has no time that isn't negative".to_owned()) } else { Ok(keys) }
    }

    /// Checks whether so many numbers may follow.
    fn left(&self, numbers: usize) -> Result<usize, String> {
        let left = self.numbers_left.checked_sub(numbers);
        left.ok_or_else(|| format!("it brings the file above the limit of {MAX_NUMBERS} animated numbers"))
    }

    /// Holds the memory of so many numbers, which stay as long as the mesh.
    fn take(&mut self, numbers: usize) -> Result<(), String> {
        self.numbers_left = self.left(numbers)?;
        self.budget.hold(numbers as u64 * 4).map_err(|refused| format!("it {}", String::from(refused)))
    }
}

/// Returns the times at which a channel's weight passes that of a shape in between, where its shapes' weights have a bend.
fn crossings(channel: &BlendChannel, keys: &[BakedVec3]) -> Vec<f64> {
    let mut times = Vec::new();
    // At 0 a channel bends too, if it has shapes on both sides.
    let bends = channel.keyframes.iter().map(|key| key.target_weight).chain([0.0]);
    let bends: Vec<f64> = if channel.keyframes.len() > 1 { bends.collect() } else { Vec::new() };
    for pair in keys.windows(2) {
        let [from, to] = [&pair[0], &pair[1]];
        for bend in &bends {
            let part = (100.0 * bend - from.value.x) / (to.value.x - from.value.x);
            if part > 0.0 && part < 1.0 {
                times.push(from.time + part * (to.time - from.time));
            }
        }
    }
    times
}
