//! Reads animations as clips whose channels move nodes of the document. An animation with an error is left out, with a
//! warning.
//!
//! They aren't read by the `gltf` crate, for which one wrong index invalidates the whole document.

use std::collections::HashMap;

use ::gltf::Document;
use serde::Deserialize;
use serde_json::Value;

use super::notes::Notes;
use super::{Accessors, nodes};
use crate::attachment::LocalTransform;
use geometry::casts::to_u32;
use geometry::mesh::borrowing;
use geometry::mesh::rig::{Channel, Clip, Interpolation, Keys, Property};

/// The greatest number of numbers in all clips together: more than any model has, and little enough for any memory.
const MAX_NUMBERS: usize = 1 << 26;

#[derive(Deserialize)]
struct Animation {
    #[serde(default)]
    channels: Vec<ChannelEntry>,
    #[serde(default)]
    samplers: Vec<Sampler>,
}

#[derive(Deserialize)]
struct ChannelEntry {
    sampler: usize,
    target: ChannelTarget,
}

#[derive(Deserialize)]
struct ChannelTarget {
    node: Option<usize>,
    path: String,
}

#[derive(Deserialize)]
struct Sampler {
    input: usize,
    output: usize,
    interpolation: Option<String>,
}

/// Reads the document's clips, whose channels have nodes of the document as targets. Adds a warning for each that is
/// left out.
pub(super) fn read(animations: Vec<Value>, document: &Document, accessors: &Accessors, notes: &mut Notes) -> Vec<Clip> {
    let target_counts = HashMap::new();
    let mut reader = Reader { document, accessors, numbers_left: MAX_NUMBERS, target_counts, pointers: 0 };
    let mut clips = Vec::new();
    for (i, value) in animations.into_iter().enumerate() {
        let own_name = own_name(&value);
        let quoted = own_name.as_ref().map_or_else(String::new, |name| format!(" \"{name}\""));
        match reader.clip(own_name.unwrap_or_else(|| format!("animation {i}")), value) {
            Ok(clip) => {
                if reader.pointers > 0 {
                    let (count, said) = (reader.pointers, "which aren't read; the others are played");
                    notes.push(format!("animation {i}{quoted} has {count} channels of KHR_animation_pointer, {said}."));
                }
                clips.push(clip);
            }
            Err(reason) => notes.push(format!("animation {i}{quoted} is left out: {reason}.")),
        }
    }
    clips
}

/// Returns an animation's name on one line, if it has one.
fn own_name(animation: &Value) -> Option<String> {
    let name = animation.get("name")?.as_str()?.replace(char::is_control, " ");
    (!name.trim().is_empty()).then_some(name)
}

struct Reader<'a> {
    document: &'a Document,
    accessors: &'a Accessors<'a>,
    numbers_left: usize,
    /// The number of morph targets of each node.
    target_counts: HashMap<usize, usize>,
    /// How many channels of the animation that was read last move something else than nodes (KHR_animation_pointer).
    pointers: usize,
}

impl Reader<'_> {
    /// # Errors
    /// A clause that says what is wrong.
    fn clip(&mut self, name: String, value: Value) -> Result<Clip, String> {
        let animation: Animation =
            serde_json::from_value(value).map_err(|error| format!("it can't be read ({error})"))?;
        let mut channels: Vec<Channel> = Vec::new();
        self.pointers = animation.channels.iter().filter(|entry| entry.target.path == "pointer").count();
        for (i, entry) in animation.channels.iter().enumerate() {
            let channel = self.channel(entry, &animation.samplers).map_err(|reason| format!("channel {i} {reason}"))?;
            channels.extend(channel);
        }
        let last = channels.iter().filter_map(|channel| channel.keys.times.last()).fold(0.0, |a: f32, b| a.max(*b));
        Ok(Clip { name, duration: last.into(), channels })
    }

    /// Reads a channel. Returns none if an extension defines what it animates.
    fn channel(&mut self, entry: &ChannelEntry, samplers: &[Sampler]) -> Result<Option<Channel>, String> {
        let Some(index) = entry.target.node else { return Ok(None) };
        let node = self.document.nodes().nth(index);
        let node = node.ok_or_else(|| {
            let count = self.document.nodes().len();
            format!("moves node {index}, but /nodes has {count}")
        })?;
        // A channel of a node without a mesh, or whose mesh isn't shown, moves nothing.
        if entry.target.path == "weights" && node.mesh().is_none() {
            return Ok(None);
        }
        let (property, width) = match entry.target.path.as_str() {
            "translation" => (Property::Translation, 3),
            "rotation" => (Property::Rotation, 4),
            "scale" => (Property::Scale, 3),
            "weights" => {
                (Property::Weights, *self.target_counts.entry(index).or_insert_with(|| nodes::target_count(&node)))
            }
            _ => return Ok(None),
        };
        if width == 0 {
            return Err(format!("changes weights of morph targets of node {index}, which has none"));
        }
        if property != Property::Weights && matches!(nodes::local(&node), LocalTransform::Matrix(_)) {
            return Err(format!("moves node {index}, whose transform is a matrix"));
        }
        let sampler = samplers.get(entry.sampler);
        let sampler = sampler
            .ok_or_else(|| format!("uses sampler {}, but the animation has {}", entry.sampler, samplers.len()))?;
        let keys = self.keys(sampler, property, width)?;
        Ok(Some(Channel { target: to_u32(index), property, keys }))
    }

    fn keys(&mut self, sampler: &Sampler, property: Property, width: usize) -> Result<Keys, String> {
        let interpolation = match sampler.interpolation.as_deref() {
            None | Some("LINEAR") => Interpolation::Linear,
            Some("STEP") => Interpolation::Step,
            Some("CUBICSPLINE") => Interpolation::CubicSpline,
            Some(other) => return Err(format!("has the unknown interpolation {other:?}")),
        };
        let times = self.numbers::<1>(sampler.input, "times")?;
        let values = match property {
            Property::Translation | Property::Scale => self.numbers::<3>(sampler.output, "values")?,
            Property::Rotation => self.numbers::<4>(sampler.output, "values")?,
            Property::Weights => self.numbers::<1>(sampler.output, "values")?,
        };
        let later = |pair: &[f32]| pair[0] < pair[1];
        if times.first().is_none_or(|first| *first < 0.0) || !times.windows(2).all(later) {
            return Err("has times that are negative or don't increase".to_owned());
        }
        let elements = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        // Neither product overflows, since both lists are in memory.
        if values.len() != times.len() * elements * width {
            return Err(format!("has {} numbers for {} key frames of {}", values.len(), times.len(), elements * width));
        }
        Ok(Keys { times, values, width, interpolation })
    }

    /// Returns all numbers of an accessor; they are finite.
    fn numbers<const N: usize>(&mut self, index: usize, role: &str) -> Result<Vec<f32>, String> {
        let accessor = self.document.accessors().nth(index);
        let accessor = accessor.ok_or_else(|| {
            let count = self.document.accessors().len();
            format!("names accessor {index}, but /accessors has {count}")
        })?;
        let left = accessor.count().checked_mul(N).and_then(|count| self.numbers_left.checked_sub(count));
        self.numbers_left =
            left.ok_or_else(|| format!("brings the document above the limit of {MAX_NUMBERS} animated numbers"))?;
        let budget = self.accessors.budget;
        let numbers = borrowing(budget, || self.accessors.numbers::<N>(&accessor, role));
        let numbers =
            numbers.map_err(|error| format!("has {role} in /accessors/{index}, which {}", error.into_clause()))?;
        let numbers = numbers.into_flattened();
        // They stay in memory as long as the mesh.
        let kept = budget.hold(size_of_val(&numbers[..]) as u64);
        kept.map_err(|reason| format!("has {role} in /accessors/{index}, which {reason}"))?;
        if numbers.iter().any(|number| !number.is_finite()) {
            return Err(format!("has {role} that aren't finite"));
        }
        Ok(numbers)
    }
}
