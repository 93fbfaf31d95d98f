//! The command that draws what a window shows: `pnaen render`, the other way round. Options that are as they would be anyway
//! are left out.

use std::fmt::{Display, Write};

use crate::engine::Preparation;
use crate::files::Limits;
use crate::load::{HeightSource, Source};
use crate::render::Camera;
use crate::settings::{Settings, option_name};
use crate::tessellate::{Displacement, Lod, Surface};

/// What a window shows, and from where.
pub struct Shown<'a> {
    pub source: &'a Source,
    pub preparation: &'a Preparation,
    pub settings: &'a Settings,
    pub camera: &'a Camera,
    /// The bounding radius of what is drawn, in object units: the camera's distance is written in it.
    pub radius: f32,
    /// The view's width and height, in px.
    pub size: [u32; 2],
    /// A clip's name, and the time in it in s.
    pub animation: Option<(&'a str, f64)>,
    pub truth: Option<&'a Source>,
    /// Of the mesh, from 0.
    pub triangle: Option<u32>,
}

impl Shown<'_> {
    /// As a shell takes it, on one line. The picture is called after the mesh.
    pub fn command(&self) -> String {
        let name = match self.source {
            Source::File(path) => path.file_stem().map_or("mesh".into(), |stem| stem.to_string_lossy().into_owned()),
            Source::Shape(shape) | Source::FineShape(shape, _) => shape.to_string(),
        };
        // Not the name alone: a texture may have that.
        let picture = Source::File(format!("{name}-view.png").into());
        let mut line = Line(format!("pnaen render {} -o {}", word(&named(self.source)), word(&named(&picture))));
        self.mesh(&mut line);
        self.surface(&mut line);
        self.lod(&mut line);
        self.view(&mut line);
        line.0
    }

    /// What is read, and what becomes of it before it is tessellated.
    fn mesh(&self, line: &mut Line) {
        let Preparation { weld, crease_band, heights, limits } = self.preparation;
        let Limits { file, memory } = Limits::default();
        line.changed("--weld", weld, &0.0);
        line.changed("--rim", crease_band, &0.0);
        line.changed("--max-size", &limits.file, &file);
        line.changed("--max-memory", &limits.memory, &memory);
        let Some(heights) = heights else { return };
        let (own, usual) = (self.settings, Settings::default());
        match heights {
            HeightSource::Materials => line.option("--height", "material"),
            HeightSource::File(path) => line.option("--height", named(&Source::File(path.clone()))),
        }
        line.chosen("--displacement", own.displacement, Displacement::On);
        line.changed("--height-scale", &own.height_scale, &usual.height_scale);
        line.changed("--midlevel", &own.midlevel, &usual.midlevel);
    }

    fn surface(&self, line: &mut Line) {
        let (own, usual) = (self.settings, Settings::default());
        line.chosen("--surface", own.surface, usual.surface);
        let surfaces = [Some(own.surface), own.split_surface.filter(|_| own.split.is_some())];
        if surfaces.into_iter().flatten().any(Surface::is_phong) {
            line.changed("--alpha", &own.alpha, &usual.alpha);
        }
        line.chosen("--normals", own.normals, usual.normals);
        line.chosen("--edges", own.edges, usual.edges);
        line.changed("--partitioning", own.partitioning.name(), usual.partitioning.name());
    }

    /// Only what the LOD that is used looks at.
    fn lod(&self, line: &mut Line) {
        let (own, usual) = (self.settings, Settings::default());
        let lod = own.used_lod();
        line.chosen("--lod", lod, usual.lod);
        match lod {
            Lod::Uniform => line.changed("--factor", &own.factor, &usual.factor),
            Lod::Distance => {
                line.changed("--factor", &own.factor, &usual.factor);
                let distances = |of: &Settings| format!("{},{}", of.near, of.far);
                line.changed("--distances", &distances(own), &distances(&usual));
            }
            Lod::Paper | Lod::EdgeLength => line.changed("--pixels", &own.pixels, &usual.pixels),
            Lod::Error => line.changed("--tolerance", &own.tolerance, &usual.tolerance),
        }
        line.chosen("--clip", own.clip, usual.clip);
        line.switch("--cull-back-faces", own.cull_back_faces);
        line.chosen("--convention", own.convention, usual.convention);
    }

    /// What is drawn over it, and from where.
    fn view(&self, line: &mut Line) {
        let (own, usual) = (self.settings, Settings::default());
        let overlays = own.overlays.on().map(option_name).collect::<Vec<_>>().join(",");
        line.changed("--overlay", &*overlays, "");
        if let (Some(truth), None) = (self.truth, self.animation) {
            line.option("--truth", named(truth));
        }
        line.chosen("--deviation-in", own.deviation_in, usual.deviation_in);
        if let Some(split) = own.split {
            line.option("--split", split);
            own.split_surface.into_iter().for_each(|surface| line.option("--split-surface", option_name(surface)));
        }
        self.triangle.into_iter().for_each(|triangle| line.option("--select", triangle));
        if let Some((name, time)) = self.animation {
            line.option("--animation", name);
            line.changed("--time", &time, &0.0);
        }
        let color = |[r, g, b]: [u8; 3]| format!("{r:02x}{g:02x}{b:02x}");
        line.changed("--background", &color(own.background), &color(usual.background));
        line.option("--size", format!("{}x{}", self.size[0], self.size[1]));
        let Camera { target, azimuth, elevation, distance, orthographic } = self.camera;
        line.option("--camera", format!("{azimuth},{elevation},{}", distance / self.radius));
        line.option("--target", format!("{},{},{}", target.x, target.y, target.z));
        line.switch("--orthographic", *orthographic);
    }
}

/// A command in the making.
struct Line(String);

impl Line {
    fn option(&mut self, name: &str, value: impl Display) {
        let value = value.to_string();
        // What begins with a dash would be taken for an option.
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

    fn chosen<T: clap::ValueEnum + PartialEq>(&mut self, name: &str, own: T, usual: T) {
        if own != usual {
            self.option(name, option_name(own));
        }
    }
}

/// A source as an argument: a file whose name begins with a dash, or as a shape's does, is found in its folder.
fn named(source: &Source) -> String {
    let text = source.to_string();
    let is_misread = text.starts_with('-') || text == "material" || text.starts_with("shape:");
    if is_misread && matches!(source, Source::File(_)) { format!("./{text}") } else { text }
}

/// A text as one word of a shell's: of cmd.exe on Windows, elsewhere of POSIX (Shell Command Language, section 2.2.2).
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
    use glam::{Mat4, Vec2, Vec3};
    use proptest::prelude::*;

    use super::*;
    use crate::cli::{Cli, Command, render};
    use crate::mesh::Bounds;
    use crate::settings::{Overlays, random};
    use crate::tessellate::LodView;

    /// What a shell makes of a line.
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
    ) -> Shown<'a> {
        let (size, radius) = ([640, 480], 2.0);
        Shown { source, preparation, settings, camera, radius, size, animation: None, truth: None, triangle: None }
    }

    fn camera() -> Camera {
        Camera::framing(&Bounds::default(), Vec2::ONE)
    }

    #[test]
    fn what_is_as_usual_is_left_out() {
        let (source, preparation) = (Source::File("my models/it's.glb".into()), Preparation::default());
        let camera = Camera { azimuth: -30.0, distance: 5.0, ..camera() };
        let line = shown(&source, &preparation, &Settings::default(), &camera).command();
        let mesh = if cfg!(windows) { "\"my models/it's.glb\"" } else { r"'my models/it'\''s.glb'" };
        let picture = if cfg!(windows) { "\"it's-view.png\"" } else { r"'it'\''s-view.png'" };
        let view = "--size 640x480 --camera=-30,20,2.5 --target 0,0,0";
        assert_eq!(line, format!("pnaen render {mesh} -o {picture} {view}"));
    }

    #[test]
    fn everything_else_is_written() {
        let (source, truth) = (Source::File("-x.glb".into()), Source::File("shape:y".into()));
        let limits = Limits { memory: 1 << 31, ..Limits::default() };
        let heights = Some(HeightSource::File("material".into()));
        let preparation = Preparation { weld: 1e-5, crease_band: 0.02, heights, limits };
        let settings = Settings { displacement: Displacement::PerPatch, height_scale: -0.5, ..Settings::opening() };
        let camera = Camera { orthographic: true, target: Vec3::new(-1.5, 0.0, 1e-7), ..camera() };
        let shown =
            Shown { truth: Some(&truth), triangle: Some(7), ..shown(&source, &preparation, &settings, &camera) };
        let args = parsed(&shown.command());
        assert_eq!(args.file, Source::File("./-x.glb".into()));
        assert_eq!(args.truth.truth, Some(Source::File("./shape:y".into())));
        let heights = Some(HeightSource::File("./material".into()));
        assert_eq!(args.surface.preparation(), Preparation { heights, ..preparation.clone() });
        assert_eq!((args.select, args.surface.orthographic), (Some(7), true));
        assert_eq!(args.surface.target.map(|place| place.0), Some(camera.target));
        assert_eq!(args.surface.settings().height_scale, -0.5);
        let moving = Shown { animation: Some(("-run, fast", 0.1)), ..shown };
        let args = parsed(&moving.command());
        assert_eq!(
            (args.surface.animation.animation.as_deref(), args.surface.animation.time),
            (Some("-run, fast"), 0.1)
        );
        assert_eq!(args.truth.truth, None, "an animation has none");
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

        #[test]
        fn commands_are_read_as_what_was_shown(settings in random::settings(), has_heights in any::<bool>()) {
            let heights = has_heights.then_some(HeightSource::Materials);
            let displacement = if has_heights { Displacement::AsPublished } else { Displacement::Off };
            let settings = Settings { displacement, ..settings };
            let preparation = Preparation { heights, ..Preparation::default() };
            let (source, camera) = ("shape:torus@2".parse().expect("a shape"), camera());
            let args = parsed(&shown(&source, &preparation, &settings, &camera).command());
            prop_assert!(args.surface.check_with(args.split.split_surface).is_ok());
            prop_assert_eq!(args.surface.preparation(), preparation);
            // What LOD doesn't look at, and what moves no heights, may be as it likes.
            let view = LodView::new(Mat4::IDENTITY, Vec2::ONE);
            let used = |settings: &Settings| {
                let Settings { lod: _, factor, pixels, tolerance, near, far, .. } = *settings;
                let lod = settings.used_lod();
                let is_phong = [Some(settings.surface), settings.split_surface].into_iter().flatten().any(Surface::is_phong);
                let mut inputs = settings.inputs(view);
                inputs.factor = if matches!(lod, Lod::Uniform | Lod::Distance) { factor } else { 0.0 };
                inputs.pixels = if matches!(lod, Lod::Paper | Lod::EdgeLength) { pixels } else { 0.0 };
                inputs.tolerance = if lod == Lod::Error { tolerance } else { 0.0 };
                [inputs.near, inputs.far] = if lod == Lod::Distance { [near, far] } else { [0.0; 2] };
                inputs.alpha = if is_phong { settings.alpha } else { 0.0 };
                [inputs.height_scale, inputs.midlevel] =
                    if has_heights { [settings.height_scale, settings.midlevel] } else { [0.0; 2] };
                inputs
            };
            let split_surface = settings.split_surface.filter(|_| settings.split.is_some());
            let expected = Settings { split_surface, ..settings };
            let read = Settings {
                split: args.split.split, split_surface: args.split.split_surface, ..args.surface.settings()
            };
            prop_assert_eq!(used(&read), used(&expected));
            prop_assert_eq!((read.split, read.split_surface), (expected.split, expected.split_surface));
            prop_assert_eq!(Overlays::of(&args.overlay), Some(settings.overlays));
            prop_assert_eq!((args.background, args.truth.deviation_in), (settings.background, settings.deviation_in));
        }
    }
}
