//! The options `--animation` and `--time`, which choose a pose.

use clap::Args;

use super::{CliError, note};
use geometry::mesh::Moment;
use inspect::engine::Loaded;

/// The options that choose a pose.
#[derive(Clone, Debug, Default, Args)]
pub struct AnimationOption {
    /// Show the mesh in a pose of this animation; `pnaen info` lists the animations
    #[arg(long, value_name = "NAME")]
    pub animation: Option<String>,
    /// Time in the animation, in s; after its end the pose is that of the end
    #[arg(long, value_name = "SECONDS", requires = "animation", value_parser = seconds, default_value_t = 0.0, allow_hyphen_values = true)]
    pub time: f64,
}

impl AnimationOption {
    /// Returns the chosen moment, or none at rest. Warns on standard error about a time beyond the end.
    pub fn moment(&self, loaded: &Loaded) -> Result<Option<Moment>, CliError> {
        let Some(name) = &self.animation else { return Ok(None) };
        let rig = loaded.mesh.rig.as_deref();
        let found = rig.and_then(|rig| rig.clip(name).map(|clip| (clip, rig.clips[clip].duration)));
        let Some((clip, duration)) = found else {
            let (file, name) = (loaded.source.to_string(), name.clone());
            let clips: Vec<_> = rig.iter().flat_map(|rig| &rig.clips).map(|clip| clip.name.clone()).collect();
            let has = if clips.is_empty() { "none".to_owned() } else { clips.join(", ") };
            return Err(CliError::NoAnimation { file, name, has });
        };
        if self.time > duration {
            // Files have times in f32: an f64 would print digits that the file doesn't have.
            let end = duration as f32;
            note(&format!("{name} ends at {end} s; the pose at its end is shown"));
        }
        Ok(Some(Moment { clip, time: self.time.min(duration) }))
    }
}

/// Parses a time that is finite and not negative.
fn seconds(text: &str) -> Result<f64, String> {
    let time = text.trim().parse().ok().filter(|time: &f64| time.is_finite() && *time >= 0.0);
    time.ok_or_else(|| "expected a number of seconds, 0 or more".to_owned())
}
