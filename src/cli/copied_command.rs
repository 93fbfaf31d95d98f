//! The command that draws what a window shows: "Copy as command". Options that have their default values, or no effect, are
//! left out.

use std::ffi::OsString;
use std::fmt::{Display, Write};
use std::path::Path;

use super::turntable::Turn;
use geometry::tessellate::{Displacement, Tessellation};
use inspect::engine::Preparation;
use inspect::render::Camera;
use inspect::settings::{Colors, Declaration, Lighting, Settings, Value, options};
use load::files::Limits;
use load::{HeightSource, Source};

/// What a window shows, and from where.
pub(crate) struct CopiedCommand<'a> {
    pub source: &'a Source,
    pub preparation: &'a Preparation,
    pub settings: &'a Settings,
    pub camera: &'a Camera,
    /// The camera that LOD and clipping are frozen for and its view's width and height in px, if they are.
    pub lod_camera: Option<(&'a Camera, [u32; 2])>,
    /// The bounding radius of what is drawn, in object units. The command has the camera's distance in bounding radii.
    pub radius: f32,
    /// The view's width and height, in px.
    pub size: [u32; 2],
    /// A clip's name, and the time in it in s.
    pub animation: Option<(&'a str, f64)>,
    pub truth: Option<&'a Source>,
    /// The file whose factors take the place of those of LOD.
    pub factors: Option<&'a Path>,
    /// The file whose functions take the place of LOD.
    pub lod_shader: Option<&'a Path>,
    /// The file whose function takes the place of the surface.
    pub surface_shader: Option<&'a Path>,
    /// The picture of a lit sphere that takes the place of that of the settings.
    pub matcap_image: Option<&'a Path>,
    /// The file that the light comes from.
    pub environment: Option<&'a Path>,
    /// The selected triangle's number in the mesh, from 0.
    pub triangle: Option<u32>,
    /// Whether nothing is behind the mesh, rather than the background's colour.
    pub transparent: bool,
    /// Whether the legend is drawn into the picture.
    pub legend: bool,
    /// The file to write; without one, it is named after the mesh.
    pub output: Option<&'a Path>,
    /// The turn of a turntable, and whether it is a GIF; none for one picture.
    pub turn: Option<(Turn, bool)>,
}

impl CopiedCommand<'_> {
    /// The command on one line, quoted for a shell. The picture is named after the mesh.
    pub fn line(&self) -> String {
        let name = if self.turn.is_some() { "turntable" } else { "render" };
        let [file, output] = [self.source, &self.output()].map(|source| word(&named(source)));
        let mut line = Line(format!("pnaen {name} {file} -o {output}"));
        if let Some((turn, is_gif)) = self.turn {
            let usual = Turn::default();
            line.changed("--frames", &turn.frames, &usual.frames);
            line.changed("--fps", if is_gif { &turn.fps } else { &usual.fps }, &usual.fps);
        }
        self.mesh(&mut line);
        self.settings(&mut line);
        self.view(&mut line);
        line.0
    }

    /// The file to write.
    fn output(&self) -> Source {
        if let Some(path) = self.output {
            return Source::File(path.to_owned());
        }
        let name = match self.source {
            Source::File(path) => path.file_stem().map_or("mesh".into(), |stem| stem.to_string_lossy().into_owned()),
            Source::Shape(shape) | Source::FineShape(shape, _) => shape.to_string(),
            Source::Vase => "vase".to_owned(),
        };
        // A texture beside the mesh may have the mesh's name.
        let ending = match self.turn {
            None => "-view.png",
            Some((_, true)) => "-turntable.gif",
            Some((_, false)) => "-turntable",
        };
        Source::File(format!("{name}{ending}").into())
    }

    /// Writes the options for loading and preparing the mesh.
    fn mesh(&self, line: &mut Line) {
        // How the geometry is taken is among the settings.
        let Preparation { weld, crease_band, heights, variant, scene, hidden, import: _, limits } = self.preparation;
        let Limits { file, memory } = Limits::default();
        line.changed("--weld", weld, &0.0);
        line.changed("--crease-band", crease_band, &0.0);
        variant.iter().for_each(|name| line.option("--variant", name));
        scene.iter().for_each(|name| line.option("--scene", name));
        hidden.iter().for_each(|name| line.option("--hide-part", name));
        line.changed("--max-size", &limits.file, &file);
        line.changed("--max-memory", &limits.memory, &memory);
        let Some(heights) = heights else { return };
        match heights {
            HeightSource::Materials => line.option("--height", "material"),
            HeightSource::File(path) => line.option("--height", named(&Source::File(path.clone()))),
        }
    }

    /// Writes every setting that has an effect and isn't at its default. A transparent picture has no colour behind the mesh.
    fn settings(&self, line: &mut Line) {
        let background = self.settings.background.filter(|_| !self.transparent);
        // What takes the place of LOD takes none of its options.
        let Tessellation { lod, factor, .. } = Tessellation::default();
        let own = self.settings.tessellation;
        let has_lod = self.factors.is_none() && self.lod_shader.is_none();
        let tessellation = if has_lod { own } else { Tessellation { lod, factor, ..own } };
        let shown = Settings { background, ..self.settings.with(tessellation) };
        let displaced = |displacement, of: &Settings| of.with(Tessellation { displacement, ..of.tessellation });
        let (own, usual) = match self.preparation.heights {
            // With --height the surface is displaced unless --displacement says otherwise.
            Some(_) => (shown, displaced(Displacement::On, &Settings::default())),
            None => (displaced(Displacement::Off, &shown), Settings::default()),
        };
        let is_replaced = |name: &str| {
            (self.surface_shader.is_some() && name == options::SURFACE.name)
                || (self.matcap_image.is_some() && name == options::MATCAP.name)
        };
        let written = |option: &&Declaration| (option.no_effect)(&own).is_none() && !is_replaced(option.name);
        for option in options::all().filter(written) {
            let (name, value) = (format!("--{}", option.name), option.get(&own));
            match value {
                _ if value == option.get(&usual) => {}
                Value::Switch(is_on) => line.switch(&name, is_on),
                value => line.option(&name, value),
            }
        }
    }

    /// Writes the files of factors, of shaders, of a matcap and of light, the reference surface, the selection, the pose and the camera.
    fn view(&self, line: &mut Line) {
        if let Some(path) = self.factors {
            line.option("--factors", named(&Source::File(path.to_owned())));
        }
        if let Some(path) = self.lod_shader {
            line.option("--lod-shader", named(&Source::File(path.to_owned())));
        }
        if let Some(path) = self.surface_shader {
            line.option("--surface-shader", named(&Source::File(path.to_owned())));
        }
        if let Some(path) = self.matcap_image.filter(|_| self.settings.overlays.colors == Colors::Matcap) {
            line.option("--matcap-image", named(&Source::File(path.to_owned())));
        }
        let uses_file = self.settings.lighting == Lighting::Environment && self.settings.shows_materials();
        if let Some(path) = self.environment.filter(|_| uses_file) {
            line.option("--environment", named(&Source::File(path.to_owned())));
        }
        if let (Some(truth), None) = (self.truth, self.animation) {
            line.option("--truth", named(truth));
        }
        self.triangle.into_iter().for_each(|triangle| line.option("--select", triangle));
        if let Some((name, time)) = self.animation {
            line.option("--animation", name);
            line.changed("--time", &time, &0.0);
        }
        line.switch("--transparent", self.transparent);
        line.switch("--legend", self.legend);
        line.option("--size", Px(self.size));
        self.camera(line, "", self.camera);
        if let Some((camera, size)) = self.lod_camera.filter(|own| *own != (self.camera, self.size)) {
            self.camera(line, "lod-", camera);
            line.changed("--lod-size", &Px(size), &Px(self.size));
        }
    }

    /// Writes the options of a camera, whose names begin with `prefix`.
    fn camera(&self, line: &mut Line, prefix: &str, camera: &Camera) {
        // The window has no cameras of matrices.
        let Camera { target, azimuth, elevation, distance, orthographic, field_of_view, roll, rows: _ } = camera;
        line.option(&format!("--{prefix}camera"), format!("{azimuth},{elevation},{}", distance / self.radius));
        line.option(&format!("--{prefix}target"), format!("{},{},{}", target.x, target.y, target.z));
        line.switch(&format!("--{prefix}orthographic"), *orthographic);
        line.changed(&format!("--{prefix}field-of-view"), field_of_view, &Camera::default().field_of_view);
        line.changed(&format!("--{prefix}roll"), roll, &0.0);
    }
}

/// Width and height in px, as the command line takes them.
#[derive(PartialEq)]
struct Px([u32; 2]);

impl Display for Px {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}x{}", self.0[0], self.0[1])
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

/// The command that this process was started with, on one line, quoted for a shell.
pub(super) fn given(arguments: impl IntoIterator<Item = OsString>) -> String {
    let words = arguments.into_iter().skip(1).map(|argument| word(&argument.to_string_lossy()));
    ["pnaen".to_owned()].into_iter().chain(words).collect::<Vec<_>>().join(" ")
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
    use crate::cli::{Cli, CliError, Command, render};
    use geometry::mesh::Bounds;
    use inspect::settings::{Matcap, Overlays, random};
    use load::Import;

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
            lod_camera: None,
            radius,
            size,
            animation: None,
            truth: None,
            factors: None,
            lod_shader: None,
            surface_shader: None,
            matcap_image: None,
            environment: None,
            triangle: None,
            transparent: false,
            legend: false,
            output: None,
            turn: None,
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
        let preparation = Preparation {
            weld: 1e-5,
            crease_band: 0.02,
            heights,
            variant: Some("-matte".to_owned()),
            scene: Some("Night sky".to_owned()),
            hidden: vec!["-left door".to_owned(), "b, c".to_owned()],
            import: Import::default(),
            limits,
        };
        let settings = Settings::opening().with(Tessellation {
            displacement: Displacement::PerPatch,
            height_scale: -0.5,
            ..Settings::opening().tessellation
        });
        let target = Vec3::new(-1.5, 0.0, 1e-7);
        let camera = Camera { orthographic: true, target, field_of_view: 25.5, roll: -12.25, ..camera() };
        let shown = CopiedCommand {
            truth: Some(&truth),
            triangle: Some(7),
            ..shown(&source, &preparation, &settings, &camera)
        };
        let args = parsed(&shown.line());
        assert_eq!(args.file, Source::File("./-x.glb".into()));
        assert_eq!(args.shot.truth.truth, Some(Source::File("./shape:y".into())));
        let heights = Some(HeightSource::File("./material".into()));
        assert_eq!(args.shot.surface.preparation(), Preparation { heights, ..preparation.clone() });
        assert_eq!((args.shot.select, args.shot.surface.view.orthographic), (Some(7), true));
        assert_eq!(args.shot.surface.view.target.map(|place| place.0), Some(camera.target));
        assert_eq!((args.shot.surface.view.field_of_view, args.shot.surface.view.roll), (25.5, -12.25));
        assert_eq!(args.shot.surface.tessellation().height_scale, -0.5);
        let moving = CopiedCommand { animation: Some(("-run, fast", 0.1)), ..shown };
        let args = parsed(&moving.line());
        assert_eq!(
            (args.shot.surface.animation.animation.as_deref(), args.shot.surface.animation.time),
            (Some("-run, fast"), 0.1)
        );
        assert_eq!(args.shot.truth.truth, None, "an animation has no reference surface");
    }

    #[test]
    fn a_transparent_picture_with_a_legend_is_written_without_a_background() {
        let (source, preparation) = ("shape:torus".parse().expect("a shape"), Preparation::default());
        let settings = Settings { background: Some([1, 2, 3]), ..Settings::default() };
        let camera = camera();
        let shown = shown(&source, &preparation, &settings, &camera);
        let plain = parsed(&shown.line());
        assert_eq!((plain.shot.transparent, plain.shot.legend), (false, false));
        assert_eq!(plain.shot.picture.0.background, Some([1, 2, 3]));
        let output = Some(Path::new("-odd name.png"));
        let args = parsed(&CopiedCommand { transparent: true, legend: true, output, ..shown }.line());
        assert_eq!((args.shot.transparent, args.shot.legend, args.shot.picture.0.background), (true, true, None));
        assert_eq!(args.output, Path::new("./-odd name.png"));
    }

    #[test]
    fn a_matcap_of_a_file_is_written_in_place_of_the_one_that_is_made_in_code() {
        let (source, preparation) = ("shape:torus".parse().expect("a shape"), Preparation::default());
        let overlays = Overlays { colors: Colors::Matcap, ..Overlays::default() };
        let settings = Settings { overlays, matcap: Matcap::Pearl, ..Settings::default() };
        let camera = camera();
        let shown = |settings, matcap_image| {
            let shown = CopiedCommand { matcap_image, ..shown(&source, &preparation, settings, &camera) };
            parsed(&shown.line())
        };
        let args = shown(&settings, None);
        assert_eq!((args.shot.picture.0.matcap, args.shot.matcap_image), (Matcap::Pearl, None));
        let path = Path::new("-a sphere.png");
        let args = shown(&settings, Some(path));
        assert_eq!(args.shot.matcap_image.as_deref(), Some(Path::new("./-a sphere.png")));
        assert_eq!(args.shot.picture.0.overlays, overlays);
        assert_eq!(shown(&Settings::default(), Some(path)).shot.matcap_image, None, "it isn't shown");
    }

    #[test]
    fn the_file_of_the_light_is_written_while_it_is_used() {
        let (source, preparation) = ("shape:torus".parse().expect("a shape"), Preparation::default());
        let (settings, camera) = (Settings { lighting: Lighting::Environment, ..Settings::default() }, camera());
        let environment = Some(Path::new("-sky.hdr"));
        let shown = CopiedCommand { environment, ..shown(&source, &preparation, &settings, &camera) };
        let args = parsed(&shown.line());
        assert_eq!(args.shot.environment.as_deref(), Some(Path::new("./-sky.hdr")));
        assert_eq!(args.shot.picture.0.lighting, Lighting::Environment);
        let settings = Settings { lighting: Lighting::Studio, ..settings };
        let line = CopiedCommand { settings: &settings, ..shown }.line();
        assert!(!line.contains("--environment"), "{line}");
        let implied = parsed("pnaen render shape:torus -o a.png --environment sky.hdr").shot;
        assert_eq!(implied.picture.0.lighting, Lighting::Environment);
        let other = parsed("pnaen render shape:torus -o a.png --environment sky.hdr --lighting studio").shot;
        assert!(other.check(&source, &[], &[]).is_err_and(|error| matches!(error, CliError::Usage(_))));
    }

    #[test]
    fn a_turn_is_written_as_a_turntable() {
        let (source, preparation) = ("shape:torus".parse().expect("a shape"), Preparation::default());
        let (settings, camera) = (Settings::default(), camera());
        let with = |turn| CopiedCommand { turn, ..shown(&source, &preparation, &settings, &camera) }.line();
        let usual = with(Some((Turn::default(), false)));
        assert!(usual.starts_with("pnaen turntable shape:torus -o torus-turntable --size 640x480"), "{usual}");
        let gif = with(Some((Turn { frames: 12, fps: 20 }, true)));
        let words = gif.split(' ').map(str::to_owned);
        let Ok(Some(Command::Turntable(args))) = Cli::try_parse_from(words).map(|cli| cli.command) else {
            panic!("{gif}")
        };
        assert_eq!((args.frames, args.fps, &*args.output), (12, 20, Path::new("torus-turntable.gif")));
        assert_eq!(args.shot.surface.size.0, [640, 480]);
    }

    #[test]
    fn the_given_command_is_quoted() {
        let words = ["/usr/bin/pnaen", "render", "it's.glb", "-o", "a b.png"].map(OsString::from);
        let expected = if cfg!(windows) {
            "pnaen render \"it's.glb\" -o \"a b.png\""
        } else {
            r"pnaen render 'it'\''s.glb' -o 'a b.png'"
        };
        assert_eq!(given(words), expected);
    }

    #[test]
    fn a_frozen_lod_camera_is_written_unless_it_is_the_pictures() {
        let (source, preparation, settings) =
            ("shape:torus".parse().expect("a shape"), Preparation::default(), Settings::default());
        let own = camera();
        let frozen = Camera { azimuth: -7.5, distance: 3.0, orthographic: true, ..own };
        let with = |lod_camera| CopiedCommand { lod_camera, ..shown(&source, &preparation, &settings, &own) }.line();
        let args = parsed(&with(Some((&frozen, [320, 200]))));
        let Some(camera) = args.shot.lod.lod_camera else { panic!("it has an LOD camera") };
        assert_eq!((camera.azimuth, camera.elevation, camera.distance), (-7.5, own.elevation, Some(1.5)));
        assert_eq!(args.shot.lod.lod_target.map(|place| place.0), Some(own.target));
        assert_eq!(
            (args.shot.lod.lod_size.map(|size| size.0), args.shot.lod.lod_orthographic),
            (Some([320, 200]), true)
        );
        let args = parsed(&with(Some((&frozen, [640, 480]))));
        assert!(
            args.shot.lod.lod_camera.is_some() && args.shot.lod.lod_size.is_none(),
            "its view has the picture's size"
        );
        assert_eq!(with(Some((&own, [640, 480]))), with(None));
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

        #[test]
        fn parsing_a_command_gives_back_its_settings(settings in random::settings(), has_heights in any::<bool>()) {
            let heights = has_heights.then_some(HeightSource::Materials);
            let displacement = if has_heights { Displacement::AsPublished } else { Displacement::Off };
            let settings = settings.with(Tessellation { displacement, ..settings.tessellation });
            let preparation = Preparation { heights, import: settings.import, ..Preparation::default() };
            let (source, camera) = ("shape:torus@2".parse().expect("a shape"), camera());
            let args = parsed(&shown(&source, &preparation, &settings, &camera).line());
            let PictureOptions(picture) = args.shot.picture;
            prop_assert!(args.shot.surface.check_with(picture.split_surface).is_ok());
            prop_assert_eq!(args.shot.surface.preparation(), preparation);
            // Options without effect may have any value. Which they are, `unused_options_have_no_effect` holds.
            let used = |settings: Settings| {
                let mut used = settings;
                for option in options::all().filter(|option| (option.no_effect)(&settings).is_some()) {
                    assert!(option.set(&mut used, option.default()), "{}", option.name);
                }
                used
            };
            prop_assert_eq!(used(args.shot.surface.settings_of(&picture)), used(settings));
        }
    }
}
