//! `--animation` and `--time`: what moves, and where it is.

use std::io::Write;

use clap::Args;

use super::CliError;
use crate::engine::Loaded;
use crate::mesh::Moment;

/// What moves, and where it is.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct AnimationOption {
    /// Show the mesh as this animation has it; `pnaen info` lists them
    #[arg(long, value_name = "NAME")]
    pub animation: Option<String>,
    /// Time in the animation, in s from 0 on; after its end is at its end
    #[arg(long, value_name = "SECONDS", requires = "animation", value_parser = seconds, default_value_t = 0.0, allow_hyphen_values = true)]
    pub time: f64,
}

impl AnimationOption {
    /// Where the mesh is, if not at rest. A time beyond the end is said on standard error.
    ///
    /// # Errors
    /// There is no animation of that name.
    pub(crate) fn moment(&self, loaded: &Loaded) -> Result<Option<Moment>, CliError> {
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
            // As the file has it: in f32.
            let end = duration as f32;
            let _ = writeln!(std::io::stderr(), "pnaen: {name} ends at {end} s, and is shown as it is then");
        }
        Ok(Some(Moment { clip, time: self.time.min(duration) }))
    }
}

/// A time that is finite and not before 0.
fn seconds(text: &str) -> Result<f64, String> {
    let time = text.trim().parse().ok().filter(|time: &f64| time.is_finite() && *time >= 0.0);
    time.ok_or_else(|| "not a number of seconds from 0 on".to_owned())
}
