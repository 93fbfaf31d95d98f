//! Clips: values over time.
//!
//! Source: Khronos, glTF 2.0 specification, section 3.11 and appendix C (interpolation).

use glam::DQuat;

/// An animation.
#[derive(Clone, Debug, PartialEq)]
pub struct Clip {
    pub name: String,
    /// The last key's time, in s.
    pub duration: f64,
    pub channels: Vec<Channel>,
}

/// What one property of one target is over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Index into [`super::Rig::movers`], or for weights into [`super::Rig::morphs`].
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
    /// s; at least one, each later than the one before.
    pub times: Vec<f32>,
    /// `width` numbers a key; cubic splines have in-tangent, value and out-tangent, so three times as many.
    pub values: Vec<f32>,
    pub width: usize,
    pub interpolation: Interpolation,
}

/// Between which keys a time lies.
struct Place {
    /// The last key that isn't later, or the first.
    key: usize,
    /// From that key (0) to the next (1).
    part: f64,
    /// Between the two, in s; 0 before the first and from the last key on, where there is no next.
    step: f64,
}

impl Clip {
    /// A time that goes round: after the end comes the start.
    pub fn looped(&self, time: f64) -> f64 {
        if self.duration > 0.0 { time.rem_euclid(self.duration) } else { 0.0 }
    }
}

impl Keys {
    /// Each number at a time, by itself, with its index. What lies before the first or after the last key has its value.
    pub fn sample(&self, time: f64, mut take: impl FnMut(usize, f64)) {
        let place = self.place(time);
        for i in 0..self.width {
            take(i, self.component(&place, i));
        }
    }

    /// A rotation at a time: along the shorter way between keys that are interpolated linearly. Of any length.
    pub fn rotation(&self, time: f64) -> DQuat {
        let place = self.place(time);
        if self.interpolation == Interpolation::Linear && place.step > 0.0 {
            let [from, to] = [place.key, place.key + 1]
                .map(|key| unit(DQuat::from_array([0, 1, 2, 3].map(|i| self.value(key, 1, i)))));
            return from.slerp(to, place.part);
        }
        DQuat::from_array([0, 1, 2, 3].map(|i| self.component(&place, i)))
    }

    fn place(&self, time: f64) -> Place {
        let key = self.times.partition_point(|&key| f64::from(key) <= time).saturating_sub(1);
        let at = |key: usize| self.times.get(key).copied().map(f64::from);
        match (at(key), at(key + 1)) {
            (Some(from), Some(to)) if time > from => Place { key, part: (time - from) / (to - from), step: to - from },
            _ => Place { key, part: 0.0, step: 0.0 },
        }
    }

    /// One number of a key: `which` is 0 for the in-tangent, 1 for the value and 2 for the out-tangent.
    fn value(&self, key: usize, which: usize, i: usize) -> f64 {
        let element = if self.interpolation == Interpolation::CubicSpline { 3 * key + which } else { key };
        self.values.get(element * self.width + i).copied().map_or(0.0, f64::from)
    }

    fn component(&self, &Place { key, part: t, step }: &Place, i: usize) -> f64 {
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

/// Normalised, because f32 quaternions are of unit length only roughly; a zero one turns nothing.
pub(super) fn unit(rotation: DQuat) -> DQuat {
    if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY }
}
