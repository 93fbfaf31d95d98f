//! Reads animations. Curves of FBX move Euler angles and pivots, in layers; ufbx samples them, and what comes out are key frames
//! of translations, rotations and scales, which are interpolated linearly.

use std::collections::HashMap;

use ufbx::{
    AnimLayer, AnimOpts, AnimStack, BakeOpts, BakedAnim, BakedNode, BakedVec3, BlendChannel, ElementType, ErrorType,
    Scene,
};

use super::beyond::{Curves, Span, within};
use super::convert::{placement, quaternion, vec3};
use super::looks::name;
use super::morphs::{channels, rest_weight, shape_weights};
use super::nodes::{Placed, is_on, is_set};
use super::parse::{half, refused};
use crate::attachment::LocalTransform;
use crate::memory_budget::Budget;
use crate::notes::Notes;
use crate::read_error::ReadError;
use crate::selection::Selection;
use geometry::casts::{to_f32, to_u32};
use geometry::mesh::rig::{Channel, Clip, Interpolation, Keys, Placement, Property};
use geometry::progress::Progress;

/// The greatest number of numbers in all clips together.
const MAX_NUMBERS: usize = 1 << 26;
/// How often a curve is sampled that isn't a straight line, in 1/s. A turn about all three axes is followed within 7e-4 rad at 360
/// degrees a second, and within 6e-5 rad at 100.
const SAMPLES: f64 = 120.0;
/// Key frames that follow each other so fast, in 1/s, are samples of what another program showed at its frames. Rotations between
/// them take the shortest way, as in that program, since angles of neighbouring samples may differ by whole turns.
const FRAMES: f64 = 19.5;
/// How many samples all curves of a file may get beyond their key frames.
const MAX_BEYOND: usize = 1 << 17;
/// The greatest number of samples between two key frames.
const MAX_SEGMENTS: usize = 1 << 10;

/// Reads the clips of a scene, whose channels have its nodes as targets. Adds a warning for each that is left out.
///
/// # Errors
/// [`ReadError::TooLarge`] and [`ReadError::Cancelled`].
pub(super) fn read(
    scene: &Scene,
    placed: &Placed,
    selected: &Selection,
    budget: &Budget,
    progress: &Progress,
    notes: &mut Notes,
) -> Result<Vec<Clip>, ReadError> {
    let mut reader =
        Reader { scene, placed, selected, budget, numbers_left: MAX_NUMBERS, samples_left: MAX_BEYOND, hides: false };
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
    if reader.samples_left == 0 {
        notes.push(format!("curves that go on beyond their key frames, of which {MAX_BEYOND} samples are read."));
    }
    if reader.hides {
        notes.push("animations that show and hide nodes, which are shown as without a clip.".to_owned());
    }
    Ok(clips)
}

struct Reader<'a> {
    scene: &'a Scene,
    placed: &'a Placed,
    selected: &'a Selection<'a>,
    budget: &'a Budget,
    numbers_left: usize,
    /// How many samples beyond key frames may follow.
    samples_left: usize,
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
            resample_rate: SAMPLES,
            minimum_sample_rate: FRAMES,
            max_keyframe_segments: MAX_SEGMENTS,
            key_reduction_enabled: true,
            key_reduction_rotation: true,
            ..BakeOpts::default()
        };
        let playing = playing(stack);
        if playing.is_empty() {
            return Ok(Ok(Clip { name: name(&stack.element), duration: 0.0, channels: Vec::new() }));
        }
        let some = (playing.len() < stack.layers.len()).then(|| {
            let (layer_ids, result_allocator) = (playing.into(), half(self.budget));
            let some = ufbx::create_anim(self.scene, AnimOpts { layer_ids, result_allocator, ..AnimOpts::default() });
            some.map_err(|error| refused(&error, self.budget))
        });
        let some = some.transpose()?;
        let anim = some.as_deref().unwrap_or(&stack.anim);
        let baked = match ufbx::bake_anim(self.scene, anim, options) {
            Ok(baked) => baked,
            Err(ufbx::Error {
                type_: ErrorType::MemoryLimit | ErrorType::AllocationLimit | ErrorType::OutOfMemory,
                ..
            }) => {
                return Ok(Err("its samples take more memory than is left (--max-memory allows more)".to_owned()));
            }
            Err(error) => return Err(refused(&error, self.budget)),
        };
        let bytes = baked.metadata.result_memory_used as u64;
        self.budget.hold(bytes)?;
        let span = Span::new(&stack.anim, [baked.key_time_min, baked.key_time_max]);
        let mut curves = Curves::new(anim, span, SAMPLES, self.samples_left);
        let channels = self.channels(&baked, &mut curves);
        self.samples_left = curves.left;
        drop(baked);
        self.budget.release(bytes);
        Ok(channels.map(|channels| {
            let last = channels.iter().filter_map(|channel| channel.keys.times.last());
            let duration = last.fold(to_f32(span.end - span.begin), |a: f32, b| a.max(*b)).into();
            Clip { name: name(&stack.element), duration, channels }
        }))
    }

    /// # Errors
    /// A clause that says why the clip is left out.
    fn channels(&mut self, baked: &BakedAnim, curves: &mut Curves) -> Result<Vec<Channel>, String> {
        let mut channels = Vec::new();
        for node in &baked.nodes {
            self.node(node, curves, &mut channels)?;
        }
        let mut weights: HashMap<u32, &[BakedVec3]> = HashMap::new();
        for element in &baked.elements {
            for prop in &element.props {
                match prop.name.as_ref() {
                    "DeformPercent" => _ = weights.insert(element.element_id, &prop.keys),
                    "Visibility" => self.hides = self.hides || self.changes_visibility(element.element_id, &prop.keys),
                    _ => {}
                }
            }
        }
        if !weights.is_empty() {
            for (node, _) in &self.placed.scene.morphed {
                channels.extend(self.weights(*node, &weights, curves)?);
            }
        }
        Ok(channels)
    }

    /// Whether a clip shows or hides a node that has a mesh, on it or below it, unlike the file without a clip.
    fn changes_visibility(&self, element: u32, keys: &[BakedVec3]) -> bool {
        let element = self.scene.elements.get(element as usize).filter(|own| own.type_ == ElementType::Node);
        let carrying = element.filter(|own| self.placed.carries_mesh[own.typed_id as usize]);
        carrying.is_some_and(|own| keys.iter().any(|key| (key.value.x != 0.0) != is_on(own, "Visibility")))
    }

    /// Adds the channels of a node that change something.
    fn node(&mut self, baked: &BakedNode, curves: &mut Curves, channels: &mut Vec<Channel>) -> Result<(), String> {
        let index = baked.typed_id as usize;
        let (Some(LocalTransform::Placement(rest)), Some(node)) =
            (self.placed.scene.local.get(index).copied(), self.scene.nodes.get(index))
        else {
            return Ok(());
        };
        let (anim, span) = (curves.anim, curves.span);
        let at = |time| placement(&ufbx::evaluate_transform(anim, node, time));
        let samples: Vec<_> = curves.times(baked.element_id).into_iter().map(|time| (time, at(time))).collect();
        let target = baked.typed_id;
        let mut vectors = |keys: &[BakedVec3], property, rest: glam::DVec3, of: fn(&Placement) -> glam::DVec3| {
            let keys: Vec<_> = keys.iter().map(|key| (key.time, vec3(&key.value))).collect();
            let samples: Vec<_> = samples.iter().map(|(time, placed)| (*time, of(placed))).collect();
            let keys = within(&keys, &samples, span, |time| of(&at(time)));
            if keys.iter().all(|key| key.1 == rest) {
                return Ok(());
            }
            let keys = self.keys(span, keys.into_iter().map(|(time, value)| (time, value.to_array())))?;
            channels.push(Channel { target, property, keys });
            Ok::<_, String>(())
        };
        vectors(&baked.translation_keys, Property::Translation, rest.translation, |placed| placed.translation)?;
        vectors(&baked.scale_keys, Property::Scale, rest.scale, |placed| placed.scale)?;
        let keys: Vec<_> = baked.rotation_keys.iter().map(|key| (key.time, quaternion(&key.value))).collect();
        let samples: Vec<_> = samples.iter().map(|(time, placed)| (*time, placed.rotation)).collect();
        let keys = within(&keys, &samples, span, |time| at(time).rotation);
        if keys.iter().any(|key| key.1 != rest.rotation) {
            let keys = self.keys(span, keys.into_iter().map(|(time, value)| (time, value.to_array())))?;
            channels.push(Channel { target, property: Property::Rotation, keys });
        }
        Ok(())
    }

    /// Returns a channel with the weights of all morph targets of a node; none if the clip changes none of them.
    fn weights(
        &mut self,
        node: usize,
        baked: &HashMap<u32, &[BakedVec3]>,
        curves: &mut Curves,
    ) -> Result<Option<Channel>, String> {
        let Some(mesh) = self.scene.nodes.get(node).and_then(|node| node.mesh.as_ref()) else { return Ok(None) };
        let (anim, span) = (curves.anim, curves.span);
        let mut moved: Vec<(&BlendChannel, Vec<(f64, f64)>)> = Vec::new();
        let mut times: Vec<f64> = Vec::new();
        for channel in channels(mesh) {
            let id = channel.element.element_id;
            let weight = |time| ufbx::evaluate_blend_weight(anim, channel, time);
            let keys = baked.get(&id).into_iter().flat_map(|keys| keys.iter());
            let keys: Vec<_> = keys.map(|key| (key.time, key.value.x / 100.0)).collect();
            let samples: Vec<_> = curves.times(id).into_iter().map(|time| (time, weight(time))).collect();
            let keys = within(&keys, &samples, span, weight);
            times.extend(keys.iter().map(|key| key.0));
            times.extend(crossings(channel, &keys));
            self.left(times.len())?;
            moved.push((channel, keys));
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
            let at = to_f32(time - span.begin);
            if !at.is_finite() || keys.times.last().is_some_and(|&last| at <= last) {
                continue;
            }
            keys.times.push(at);
            for (channel, own) in &moved {
                let weight = interpolated(own, time).unwrap_or_else(|| rest_weight(channel, self.selected));
                shape_weights(channel, weight, &mut keys.values);
            }
        }
        Ok((!keys.times.is_empty()).then_some(Channel { target: to_u32(node), property: Property::Weights, keys }))
    }

    /// Returns key frames whose times grow from the clip's beginning; those that are too close for an f32 are left out.
    fn keys<const N: usize>(
        &mut self,
        span: Span,
        own: impl ExactSizeIterator<Item = (f64, [f64; N])>,
    ) -> Result<Keys, String> {
        self.take(own.len().saturating_mul(N + 1))?;
        let mut keys = Keys { times: Vec::new(), values: Vec::new(), width: N, interpolation: Interpolation::Linear };
        for (time, value) in own {
            let (time, value) = (to_f32(time - span.begin), value.map(to_f32));
            if !time.is_finite() || value.iter().any(|x| !x.is_finite()) {
                return Err("it has times or values that aren't finite".to_owned());
            }
            if keys.times.last().is_none_or(|&last| time > last) {
                keys.times.push(time);
                keys.values.extend(value);
            }
        }
        Ok(keys)
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

/// Returns the numbers of a clip's layers that aren't muted; if some are to play alone, of these.
fn playing(stack: &AnimStack) -> Vec<u32> {
    let is_on = |layer: &AnimLayer, name| is_set(&layer.element, name) == Some(true);
    let has_solo = stack.layers.into_iter().any(|layer| is_on(layer, "Solo"));
    let plays = |layer: &&AnimLayer| !is_on(layer, "Mute") && (!has_solo || is_on(layer, "Solo"));
    stack.layers.into_iter().filter(plays).map(|layer| layer.element.typed_id).collect()
}

/// Returns the value at a time between key frames, which are joined by lines. None without key frames.
fn interpolated(keys: &[(f64, f64)], time: f64) -> Option<f64> {
    let next = keys.partition_point(|key| key.0 <= time);
    let (from, to) = (keys.get(next.saturating_sub(1))?, keys.get(next).or_else(|| keys.last())?);
    let part = if to.0 > from.0 { ((time - from.0) / (to.0 - from.0)).clamp(0.0, 1.0) } else { 0.0 };
    Some(from.1 + part * (to.1 - from.1))
}

/// Returns the times at which a channel's weight passes that of a shape in between, where its shapes' weights have a bend.
fn crossings(channel: &BlendChannel, keys: &[(f64, f64)]) -> Vec<f64> {
    let mut times = Vec::new();
    // At 0 a channel bends too, if it has shapes on both sides.
    let bends = channel.keyframes.iter().map(|key| key.target_weight).chain([0.0]);
    let bends: Vec<f64> = if channel.keyframes.len() > 1 { bends.collect() } else { Vec::new() };
    for pair in keys.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        for bend in &bends {
            let part = (bend - from.1) / (to.1 - from.1);
            if part > 0.0 && part < 1.0 {
                times.push(from.0 + part * (to.0 - from.0));
            }
        }
    }
    times
}
