//! Clips: animations as values over time.
//!
//! Source: Khronos, glTF 2.0 specification, section 3.11 and appendix C (interpolation).

use glam::DQuat;

/// An animation.
#[derive(Clone, Debug, PartialEq)]
pub struct Clip {
    /// The name in the file, which may be empty.
    pub name: String,
    /// The time of the last key frame, in s.
    pub duration: f64,
    pub channels: Vec<Channel>,
}

/// The values of one property of one target over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Index into [`super::Rig::nodes`], or for weights into [`super::Rig::morphs`].
    pub target: u32,
    pub property: Property,
    pub keys: Keys,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Property {
    Translation,
    Rotation,
    Scale,
    Weights,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    Linear,
    Step,
    CubicSpline,
}

/// Key frames.
#[derive(Clone, Debug, PartialEq)]
pub struct Keys {
    /// In seconds. There is at least one, and each is later than the one before.
    pub times: Vec<f32>,
    /// `width` numbers for each key frame. Cubic splines have three times as many: in-tangent, value and out-tangent.
    pub values: Vec<f32>,
    pub width: usize,
    pub interpolation: Interpolation,
}

/// The key frames that a time lies between.
struct KeyInterval {
    /// The last key frame that isn't later, or the first one.
    key: usize,
    /// How far the time is from that key frame (0) to the next (1).
    part: f64,
    /// The time between the two, in s; 0 before the first key frame and from the last one on.
    step: f64,
}

impl Clip {
    /// Returns a time that starts again at 0 when it reaches the clip's end.
    pub fn looped(&self, time: f64) -> f64 {
        if self.duration > 0.0 { time.rem_euclid(self.duration) } else { 0.0 }
    }
}

impl Keys {
    /// Calls `take` with the index and value of each number at a time. Before its first and after its last key frame, a
    /// channel keeps the value of that key frame.
    pub fn sample(&self, time: f64, mut take: impl FnMut(usize, f64)) {
        let interval = self.interval(time);
        for i in 0..self.width {
            take(i, self.component(&interval, i));
        }
    }

    /// Returns a rotation at a time; it isn't normalised. Linear interpolation takes the shorter way between key
    /// frames.
    pub fn rotation(&self, time: f64) -> DQuat {
        let interval = self.interval(time);
        if self.interpolation == Interpolation::Linear && interval.step > 0.0 {
            let [from, to] = [interval.key, interval.key + 1]
                .map(|key| unit(DQuat::from_array([0, 1, 2, 3].map(|i| self.value(key, 1, i)))));
            return from.slerp(to, interval.part);
        }
        DQuat::from_array([0, 1, 2, 3].map(|i| self.component(&interval, i)))
    }

    fn interval(&self, time: f64) -> KeyInterval {
        let key = self.times.partition_point(|&key| f64::from(key) <= time).saturating_sub(1);
        let at = |key: usize| self.times.get(key).copied().map(f64::from);
        match (at(key), at(key + 1)) {
            (Some(from), Some(to)) if time > from => {
                KeyInterval { key, part: (time - from) / (to - from), step: to - from }
            }
            _ => KeyInterval { key, part: 0.0, step: 0.0 },
        }
    }

    /// Returns one number of a key frame; `which` is 0 for the in-tangent, 1 for the value and 2 for the out-tangent.
    fn value(&self, key: usize, which: usize, i: usize) -> f64 {
        let element = if self.interpolation == Interpolation::CubicSpline { 3 * key + which } else { key };
        self.values.get(element * self.width + i).copied().map_or(0.0, f64::from)
    }

    fn component(&self, &KeyInterval { key, part: t, step }: &KeyInterval, i: usize) -> f64 {
        let from = self.value(key, 1, i);
        if step == 0.0 {
            return from;
        }
        match self.interpolation {
            Interpolation::Step => from,
            Interpolation::Linear => from + (self.value(key + 1, 1, i) - from) * t,
            Interpolation::CubicSpline => {
                let (leaves, arrives) = (step * self.value(key, 2, i), step * self.value(key + 1, 0, i));
                let (t2, t3) = (t * t, t * t * t);
                (2.0 * t3 - 3.0 * t2 + 1.0) * from
                    + (t3 - 2.0 * t2 + t) * leaves
                    + (3.0 * t2 - 2.0 * t3) * self.value(key + 1, 1, i)
                    + (t3 - t2) * arrives
            }
        }
    }
}

/// Normalises a quaternion, since quaternions in f32 are only roughly of unit length. A zero quaternion becomes the
/// identity.
pub(super) fn unit(rotation: DQuat) -> DQuat {
    if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY }
}
