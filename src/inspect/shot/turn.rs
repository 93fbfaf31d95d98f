//! One turn of the camera: numbered PNG files, or an animated GIF.

use std::path::{Path, PathBuf};

use image::codecs::gif::{GifEncoder, Repeat};
use image::{Delay, Frame};

use super::files::file_error;
use super::{Shot, ShotError};
use crate::export::ending;
use crate::render::Camera;
use geometry::defaults::with_defaults;
use geometry::progress::Progress;
use load::files::{PartFile, PartFolder, file_reason};

pub const FRAMES: std::ops::RangeInclusive<u32> = 2..=3600;

/// GIF files count in hundredths of a second, and viewers play those of 1 more slowly.
pub const FPS: std::ops::RangeInclusive<u32> = 1..=50;

with_defaults! {
    /// One turn of the camera around the vertical axis through the point that it looks at.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Turn {
        pub frames: u32 = 36,
        /// Pictures a second in a GIF.
        pub fps: u32 = 12,
    }
}

impl Turn {
    /// Draws the pictures and writes them. `command` returns the command that the PNG file of a number holds, and `say` gets
    /// each number before its picture is drawn. If something fails or `progress` is cancelled, nothing is written.
    ///
    /// # Errors
    /// The device was lost, a file can't be written, or `progress` was cancelled.
    pub fn write(
        &self,
        shot: &mut Shot,
        command: impl Fn(u32) -> String,
        path: &Path,
        progress: &Progress,
        say: &mut dyn FnMut(u32),
    ) -> Result<(), ShotError> {
        let start = *shot.camera();
        let failed = |error: std::io::Error| file_error(path, "written", &file_reason(&error));
        let mut draw = |shot: &mut Shot, frame: u32| {
            say(frame);
            shot.look_from(self.camera(&start, frame))?;
            shot.picture(None, &progress.part(self.part(frame), self.part(frame + 1)))
        };
        if ending(path) == "gif" {
            let part = PartFile::create(path).map_err(failed)?;
            let mut gif = GifEncoder::new_with_speed(part.file(), QUANTISING);
            gif.set_repeat(Repeat::Infinite).map_err(|error| file_error(path, "encoded", &error))?;
            for frame in 0..self.frames {
                let mut picture = draw(shot, frame)?;
                // GIF files have nothing between opaque and clear px.
                picture.pixels_mut().for_each(|pixel| pixel.0[3] = if pixel.0[3] < 128 { 0 } else { 255 });
                let frame = Frame::from_parts(picture, 0, 0, Delay::from_numer_denom_ms(1000, self.fps));
                gif.encode_frame(frame).map_err(|error| file_error(path, "encoded", &error))?;
            }
            // It writes the end of the file.
            drop(gif);
            progress.check()?;
            return part.finish().map_err(failed);
        }
        let mut folder = PartFolder::create(path).map_err(failed)?;
        for frame in 0..self.frames {
            let picture = draw(shot, frame)?;
            shot.write(&folder.path(frame_name(frame)), &picture, &command(frame))?;
        }
        progress.check()?;
        folder.finish().map_err(failed)
    }

    fn part(&self, frame: u32) -> f32 {
        frame as f32 / self.frames as f32
    }

    /// The camera of a picture.
    pub fn camera(&self, start: &Camera, frame: u32) -> Camera {
        Camera { azimuth: start.azimuth + 360.0 * self.part(frame), ..*start }
    }

    /// The files that are written, as far as they can be there already.
    pub fn files(&self, output: &Path) -> Vec<PathBuf> {
        match output.is_dir() {
            true => (0..self.frames).map(|frame| output.join(frame_name(frame))).collect(),
            false => vec![output.to_owned()],
        }
    }
}

/// The name of a picture's file.
pub fn frame_name(frame: u32) -> String {
    format!("frame-{frame:04}.png")
}

/// How fast the 256 colours of a GIF are chosen, 1 to 30; faster ones fit less well.
const QUANTISING: i32 = 10;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_evenly_around_and_the_last_is_before_the_first() {
        let turn = Turn { frames: 8, fps: 10 };
        let start = Camera { azimuth: 30.0, ..Camera::framing(&Default::default(), glam::Vec2::ONE) };
        let azimuths: Vec<f32> = (0..8).map(|frame| turn.camera(&start, frame).azimuth).collect();
        assert_eq!(azimuths, [30.0, 75.0, 120.0, 165.0, 210.0, 255.0, 300.0, 345.0]);
        assert_eq!(Camera { azimuth: 30.0, ..turn.camera(&start, 5) }, start, "nothing else moves");
    }
}
