//! Pictures: each is what the command in the comment above it draws. `PNAEN_UPDATE_IMAGES=1` draws them again, on the software
//! driver; look at each before keeping it.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::{Path, PathBuf};

use image::RgbImage;

use super::{Page, root, user_pages};
use crate::picture_file::{ADAPTER, texts};
use crate::{Folder, command};

/// How long a frame of a moving picture is shown, and the last frame, in ms.
const FRAME_MS: u16 = 350;
const LAST_FRAME_MS: u16 = 1800;

/// A picture of a page, and the command that draws it.
struct Picture {
    page: String,
    image: PathBuf,
    /// The words after `pnaen`, without `-o` and its value.
    arguments: Vec<String>,
    /// The value of `{}` in each frame; empty for a still picture.
    frames: Vec<String>,
}

impl Picture {
    /// The page's pictures, each of which follows a comment `<!-- picture: pnaen ... -o NAME -->`, or
    /// `<!-- frames VALUE ..: pnaen ... {} ... -o NAME -->`.
    fn from_page(page: &Page) -> Vec<Self> {
        let lines: Vec<_> = page.text.lines().collect();
        let pairs = lines.windows(2).filter_map(|pair| Some((pair[0].strip_prefix("<!-- ")?, pair[1])));
        pairs.filter_map(|(comment, image)| Self::parse(page, comment, image)).collect()
    }

    fn parse(page: &Page, comment: &str, image: &str) -> Option<Self> {
        let (kind, rest) = comment.strip_suffix(" -->")?.split_once(": pnaen ")?;
        let frames = match kind.split_once(' ') {
            None if kind == "picture" => Vec::new(),
            Some(("frames", values)) => values.split(' ').map(str::to_owned).collect(),
            _ => return None,
        };
        let (arguments, name) = rest.rsplit_once(" -o ").unwrap_or_else(|| panic!("{}: no -o: {rest}", page.name));
        let target = image.split_once("](").and_then(|(_, rest)| rest.split_once(')'));
        let (target, _) = target.unwrap_or_else(|| panic!("{}: no picture below {comment}", page.name));
        assert!(Path::new(target).file_name().is_some_and(|own| own == name), "{}: {target} isn't {name}", page.name);
        let arguments = arguments.split(' ').map(str::to_owned).collect();
        Some(Self { page: page.name.clone(), image: page.resolve(target), arguments, frames })
    }

    /// Draws the picture into a file, with this value for `{}`; compares it with `reference`.
    ///
    /// # Errors
    /// Standard error of the program if the picture differs.
    fn draw(&self, value: &str, output: &str, reference: Option<&str>) -> Result<(), String> {
        let own = self.arguments.iter().map(|word| word.replace("{}", value));
        let mut arguments: Vec<_> = own.chain(["-o", output].map(str::to_owned)).collect();
        match reference {
            Some(reference) => arguments.extend(["--reference", reference].map(str::to_owned)),
            None => arguments.extend(["--adapter", "software"].map(str::to_owned)),
        }
        let words: Vec<_> = arguments.iter().map(String::as_str).collect();
        let run = command(&words).current_dir(root()).output().expect("the program starts");
        if run.status.success() { Ok(()) } else { Err(String::from_utf8_lossy(&run.stderr).into_owned()) }
    }

    /// Compares the picture with the committed one.
    fn check(&self, folder: &Folder) -> Result<(), String> {
        if self.frames.is_empty() {
            return self.draw("", &folder.path("picture.png"), self.image.to_str());
        }
        let (committed, adapter) = (read_frames(&self.image), adapter_of(&self.image));
        assert_eq!(committed.len(), self.frames.len(), "frames of {}", self.image.display());
        for (value, frame) in self.frames.iter().zip(committed) {
            let reference = folder.path("reference.png");
            write_frames(Path::new(&reference), &[frame], adapter.as_deref());
            self.draw(value, &folder.path("frame.png"), Some(&reference))?;
        }
        Ok(())
    }

    fn update(&self, folder: &Folder) -> Result<(), String> {
        if self.frames.is_empty() {
            // The file holds the command that drew it, which must not name a folder of this machine.
            let image = self.image.strip_prefix(root()).unwrap_or(&self.image);
            return self.draw("", image.to_str().expect("a path in UTF-8"), None);
        }
        let path = folder.path("frame.png");
        let drawn = self.frames.iter().map(|value| {
            self.draw(value, &path, None)?;
            Ok(image::open(&path).expect("a picture").to_rgb8())
        });
        let drawn = drawn.collect::<Result<Vec<_>, String>>()?;
        write_frames(&self.image, &drawn, adapter_of(Path::new(&path)).as_deref());
        Ok(())
    }

    fn run(&self) -> Result<(), String> {
        let name = self.image.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let folder = Folder::new();
        let is_update = std::env::var_os("PNAEN_UPDATE_IMAGES").is_some();
        let result = if is_update { self.update(&folder) } else { self.check(&folder) };
        result.map_err(|said| format!("{}: {name}: {said}", self.page))
    }
}

/// What drew a picture, if its file says so.
fn adapter_of(path: &Path) -> Option<String> {
    let all = texts(path.to_str().expect("a path in UTF-8"));
    all.into_iter().find(|(keyword, ..)| keyword == ADAPTER).map(|(_, text, _)| text)
}

/// Writes a moving picture that repeats for ever: an APNG file, which says what drew it.
fn write_frames(path: &Path, frames: &[RgbImage], adapter: Option<&str>) {
    let (width, height) = frames[0].dimensions();
    let file = BufWriter::new(File::create(path).expect("a writable folder"));
    let mut encoder = png::Encoder::new(file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    encoder.set_animated(frames.len() as u32, 0).expect("more than no frames");
    encoder.set_frame_delay(FRAME_MS, 1000).expect("a moving picture");
    if let Some(adapter) = adapter {
        encoder.add_text_chunk(ADAPTER.to_owned(), adapter.to_owned()).expect("before the header");
    }
    let mut writer = encoder.write_header().expect("a header");
    for (i, frame) in frames.iter().enumerate() {
        if i + 1 == frames.len() {
            writer.set_frame_delay(LAST_FRAME_MS, 1000).expect("a moving picture");
        }
        writer.write_image_data(frame.as_raw()).expect("frames of one size");
    }
    writer.finish().expect("all frames");
}

/// The frames that [`write_frames`] wrote.
fn read_frames(path: &Path) -> Vec<RgbImage> {
    let file = File::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut reader = png::Decoder::new(BufReader::new(file)).read_info().expect("a PNG file");
    let count = reader.info().animation_control().expect("a moving picture").num_frames;
    let (width, height) = reader.info().size();
    let mut next = || {
        let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
        reader.next_frame(&mut bytes).expect("a frame");
        RgbImage::from_raw(width, height, bytes).expect("an RGB frame")
    };
    (0..count).map(|_| next()).collect()
}

fn all() -> Vec<Picture> {
    user_pages().iter().flat_map(Picture::from_page).collect()
}

#[test]
fn still_pictures_are_what_their_commands_draw() {
    let stills: Vec<_> = all().into_iter().filter(|picture| picture.frames.is_empty()).collect();
    assert!(stills.len() > 10, "only {} pictures were found", stills.len());
    let faults: Vec<_> = stills.iter().filter_map(|picture| picture.run().err()).collect();
    assert_eq!(faults, Vec::<String>::new());
}

#[test]
fn moving_pictures_are_what_their_commands_draw() {
    let moving: Vec<_> = all().into_iter().filter(|picture| !picture.frames.is_empty()).collect();
    assert!(!moving.is_empty());
    let faults: Vec<_> = moving.iter().filter_map(|picture| picture.run().err()).collect();
    assert_eq!(faults, Vec::<String>::new());
    for picture in moving {
        let bytes = picture.image.metadata().expect("a picture").len();
        assert!(bytes < 700 << 10, "{} has {bytes} bytes", picture.image.display());
    }
}

#[test]
fn every_page_of_the_manual_has_a_picture_and_every_picture_a_command() {
    // Tests write these pages, which have no pictures.
    let written = ["docs/manual/keys.md", "docs/manual/tasks.md"];
    for page in user_pages().into_iter().filter(|page| written.iter().all(|name| page.name != *name)) {
        assert!(!Picture::from_page(&page).is_empty(), "{} has no picture with a command", page.name);
    }
    let made: BTreeSet<_> = all().iter().map(|picture| picture.image.file_name().map(ToOwned::to_owned)).collect();
    let folder = std::fs::read_dir(root().join("docs/manual/images")).expect("a folder of pictures");
    let there: BTreeSet<_> = folder.map(|entry| Some(entry.expect("a file").file_name())).collect();
    assert_eq!(there, made, "the pictures in docs/manual/images");
}
