//! The command that draws what a window shows: "Copy as command". Options that have their default values, or no effect, are
//! left out.

use std::fmt::{Display, Write};

use crate::engine::Preparation;
use crate::files::Limits;
use crate::load::{HeightSource, Source};
use crate::render::Camera;
use crate::settings::{Settings, Value, options};
use crate::tessellate::{Displacement, Tessellation};

/// What a window shows, and from where.
pub(crate) struct CopiedCommand<'a> {
    pub source: &'a Source,
    pub preparation: &'a Preparation,
    pub settings: &'a Settings,
    pub camera: &'a Camera,
    /// The bounding radius of what is drawn, in object units. The command has the camera's distance in bounding radii.
    pub radius: f32,
    /// The view's width and height, in px.
    pub size: [u32; 2],
    /// A clip's name, and the time in it in s.
    pub animation: Option<(&'a str, f64)>,
    pub truth: Option<&'a Source>,
    /// The selected triangle's number in the mesh, from 0.
    pub triangle: Option<u32>,
}

impl CopiedCommand<'_> {
    /// The command on one line, quoted for a shell. The picture is named after the mesh.
    pub(crate) fn line(&self) -> String {
        let name = match self.source {
            Source::File(path) => path.file_stem().map_or("mesh".into(), |stem| stem.to_string_lossy().into_owned()),
            Source::Shape(shape) | Source::FineShape(shape, _) => shape.to_string(),
            Source::Vase => "vase".to_owned(),
        };
        // A texture beside the mesh may have the mesh's name.
        let picture = Source::File(format!("{name}-view.png").into());
        let mut line = Line(format!("pnaen render {} -o {}", word(&named(self.source)), word(&named(&picture))));
        self.mesh(&mut line);
        self.settings(&mut line);
        self.view(&mut line);
        line.0
    }

    /// Writes the options for loading and preparing the mesh.
    fn mesh(&self, line: &mut Line) {
        let Preparation { weld, crease_band, heights, limits } = self.preparation;
        let Limits { file, memory } = Limits::default();
        line.changed("--weld", weld, &0.0);
        line.changed("--crease-band", crease_band, &0.0);
        line.changed("--max-size", &limits.file, &file);
        line.changed("--max-memory", &limits.memory, &memory);
        let Some(heights) = heights else { return };
        match heights {
            HeightSource::Materials => line.option("--height", "material"),
            HeightSource::File(path) => line.option("--height", named(&Source::File(path.clone()))),
        }
    }

    /// Writes every setting that has an effect and isn't at its default.
    fn settings(&self, line: &mut Line) {
        let displaced = |displacement, of: &Settings| of.with(Tessellation { displacement, ..of.tessellation });
        let (own, usual) = match self.preparation.heights {
            // With --height the surface is displaced unless --displacement says otherwise.
            Some(_) => (*self.settings, displaced(Displacement::On, &Settings::default())),
            None => (displaced(Displacement::Off, self.settings), Settings::default()),
        };
        for option in options::all().filter(|option| (option.no_effect)(&own).is_none()) {
            let (name, value) = (format!("--{}", option.name), option.get(&own));
            match value {
                _ if value == option.get(&usual) => {}
                Value::Switch(is_on) => line.switch(&name, is_on),
                value => line.option(&name, value),
            }
        }
    }

    /// Writes the reference surface, the selection, the pose and the camera.
    fn view(&self, line: &mut Line) {
        if let (Some(truth), None) = (self.truth, self.animation) {
            line.option("--truth", named(truth));
        }
        self.triangle.into_iter().for_each(|triangle| line.option("--select", triangle));
        if let Some((name, time)) = self.animation {
            line.option("--animation", name);
            line.changed("--time", &time, &0.0);
        }
        line.option("--size", format!("{}x{}", self.size[0], self.size[1]));
        let Camera { target, azimuth, elevation, distance, orthographic } = self.camera;
        line.option("--camera", format!("{azimuth},{elevation},{}", distance / self.radius));
        line.option("--target", format!("{},{},{}", target.x, target.y, target.z));
        line.switch("--orthographic", *orthographic);
    }
}

/// A command line that options are appended to.
struct Line(String);

impl Line {
    fn option(&mut self, name: &str, value: impl Display) {
        let value = value.to_string();
        // A value that begins with a dash would be taken for an option.
        let _ = match value.starts_with('-') {
            true => write!(self.0, " {}", word(&format!("{name}={value}"))),
            false => write!(self.0, " {name} {}", word(&value)),
        };
    }

    fn switch(&mut self, name: &str, is_on: bool) {
        if is_on {
            let _ = write!(self.0, " {name}");
        }
    }

    fn changed<T: Display + PartialEq + ?Sized>(&mut self, name: &str, own: &T, usual: &T) {
        if own != usual {
            self.option(name, own);
        }
    }
}

/// Formats a source as an argument. A file that would be taken for an option, a shape or `material` gets `./` in front.
fn named(source: &Source) -> String {
    let text = source.to_string();
    let is_misread = text.starts_with('-') || text == "material" || text.starts_with("shape:");
    if is_misread && matches!(source, Source::File(_)) { format!("./{text}") } else { text }
}

/// Quotes a text as one word for the shell: cmd.exe on Windows, elsewhere POSIX (Shell Command Language, section 2.2.2).
fn word(text: &(impl Display + ?Sized)) -> String {
    let text = text.to_string();
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_=+,.:/@%".contains(c) || (cfg!(windows) && c == '\\');
    match text.chars().all(plain) && !text.is_empty() {
        true => text,
        false if cfg!(windows) => format!("\"{text}\""),
        false => format!("'{}'", text.replace('\'', r"'\''")),
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;
    use glam::{Vec2, Vec3};
    use proptest::prelude::*;

    use super::*;
    use crate::cli::options::PictureOptions;
    use crate::cli::{Cli, Command, render};
    use crate::mesh::Bounds;
    use crate::settings::random;

    /// Splits a line into words as a shell does.
    fn words(line: &str) -> Vec<String> {
        let script = format!("for word in {line}; do printf '%s\\n' \"$word\"; done");
        let output = std::process::Command::new("sh").args(["-c", &script]).output().expect("a shell");
        String::from_utf8_lossy(&output.stdout).lines().map(str::to_owned).collect()
    }

    fn parsed(line: &str) -> render::Args {
        let words = if cfg!(unix) { words(line) } else { line.split(' ').map(str::to_owned).collect() };
        match Cli::try_parse_from(words).map(|cli| cli.command) {
            Ok(Some(Command::Render(args))) => args,
            other => panic!("{line}: {other:?}"),
        }
    }

    fn shown<'a>(
        source: &'a Source,
        preparation: &'a Preparation,
        settings: &'a Settings,
        camera: &'a Camera,
    ) -> CopiedCommand<'a> {
        let (size, radius) = ([640, 480], 2.0);
        CopiedCommand {
            source,
            preparation,
            settings,
            camera,
            radius,
            size,
            animation: None,
            truth: None,
            triangle: None,
        }
    }

    fn camera() -> Camera {
        Camera::framing(&Bounds::default(), Vec2::ONE)
    }

    #[test]
    fn options_with_default_values_are_left_out() {
        let (source, preparation) = (Source::File("my models/it's.glb".into()), Preparation::default());
        let camera = Camera { azimuth: -30.0, distance: 5.0, ..camera() };
        let line = shown(&source, &preparation, &Settings::default(), &camera).line();
        let mesh = if cfg!(windows) { "\"my models/it's.glb\"" } else { r"'my models/it'\''s.glb'" };
        let picture = if cfg!(windows) { "\"it's-view.png\"" } else { r"'it'\''s-view.png'" };
        let view = "--size 640x480 --camera=-30,20,2.5 --target 0,0,0";
        assert_eq!(line, format!("pnaen render {mesh} -o {picture} {view}"));
    }

    #[test]
    fn options_with_other_values_are_written() {
        let (source, truth) = (Source::File("-x.glb".into()), Source::File("shape:y".into()));
        let limits = Limits { memory: 1 << 31, ..Limits::default() };
        let heights = Some(HeightSource::File("material".into()));
        let preparation = Preparation { weld: 1e-5, crease_band: 0.02, heights, limits };
        let settings = Settings::opening().with(Tessellation {
            displacement: Displacement::PerPatch,
            height_scale: -0.5,
            ..Settings::opening().tessellation
        });
        let camera = Camera { orthographic: true, target: Vec3::new(-1.5, 0.0, 1e-7), ..camera() };
        let shown = CopiedCommand {
            truth: Some(&truth),
            triangle: Some(7),
            ..shown(&source, &preparation, &settings, &camera)
        };
        let args = parsed(&shown.line());
        assert_eq!(args.file, Source::File("./-x.glb".into()));
        assert_eq!(args.truth.truth, Some(Source::File("./shape:y".into())));
        let heights = Some(HeightSource::File("./material".into()));
        assert_eq!(args.surface.preparation(), Preparation { heights, ..preparation.clone() });
        assert_eq!((args.select, args.surface.orthographic), (Some(7), true));
        assert_eq!(args.surface.target.map(|place| place.0), Some(camera.target));
        assert_eq!(args.surface.tessellation().height_scale, -0.5);
        let moving = CopiedCommand { animation: Some(("-run, fast", 0.1)), ..shown };
        let args = parsed(&moving.line());
        assert_eq!(
            (args.surface.animation.animation.as_deref(), args.surface.animation.time),
            (Some("-run, fast"), 0.1)
        );
        assert_eq!(args.truth.truth, None, "an animation has no reference surface");
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

        #[test]
        fn parsing_a_command_gives_back_its_settings(settings in random::settings(), has_heights in any::<bool>()) {
            let heights = has_heights.then_some(HeightSource::Materials);
            let displacement = if has_heights { Displacement::AsPublished } else { Displacement::Off };
            let settings = settings.with(Tessellation { displacement, ..settings.tessellation });
            let preparation = Preparation { heights, ..Preparation::default() };
            let (source, camera) = ("shape:torus@2".parse().expect("a shape"), camera());
            let args = parsed(&shown(&source, &preparation, &settings, &camera).line());
            let PictureOptions(picture) = args.picture;
            prop_assert!(args.surface.check_with(picture.split_surface).is_ok());
            prop_assert_eq!(args.surface.preparation(), preparation);
            // Options without effect may have any value. Which they are, `unused_options_have_no_effect` holds.
            let used = |settings: Settings| {
                let mut used = settings;
                for option in options::all().filter(|option| (option.no_effect)(&settings).is_some()) {
                    assert!(option.set(&mut used, option.default()), "{}", option.name);
                }
                used
            };
            prop_assert_eq!(used(picture.with(args.surface.tessellation())), used(settings));
        }
    }
}
