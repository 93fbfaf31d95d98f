//! The command that draws what a window shows: "Copy as command". Options that have their default values, or no effect, are
//! left out.

use std::ffi::OsString;
use std::fmt::{Display, Write};
use std::path::Path;

use super::ShotView;
use super::turn::Turn;
use crate::engine::Preparation;
use crate::render::Camera;
use crate::settings::{Choice, ColorSource, Declaration, Lighting, Settings, Value, options};
use geometry::tessellate::{Displacement, Tessellation};
use load::files::Limits;
use load::import::Subdivide;
use load::{HeightSource, MorphWeights, Source};

/// What stands for the pose without a clip where a clip is named.
pub const AT_REST: &str = "rest";

/// What a window shows, and from where.
pub struct CopiedCommand<'a> {
    pub source: &'a Source,
    pub preparation: &'a Preparation,
    pub settings: &'a Settings,
    pub view: ShotView,
    /// The bounding radius of what is drawn, in object units. The command has the camera's distance in bounding radii.
    pub radius: f32,
    /// A clip's name, and the time in it in s.
    pub animation: Option<(&'a str, f64)>,
    /// The same left of the split, if that has a pose of its own: [`AT_REST`] for none.
    pub left_animation: Option<(&'a str, f64)>,
    pub reference_shape: Option<&'a Source>,
    /// How the mesh's own cage is refined, if its limit is the reference surface.
    pub reference_subdivide: Option<Subdivide>,
    /// The mesh left of the split, if it is another one.
    pub left_mesh: Option<&'a Source>,
    /// The weights of morph targets that the left half has otherwise than the right one, or has of another mesh.
    pub left_morphs: Option<&'a MorphWeights>,
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
        let Preparation { weld, crease_band, heights, variant, scene, parts, import: _, limits } = self.preparation;
        let Limits { file, memory } = Limits::default();
        line.changed("--weld", weld, &0.0);
        line.changed("--crease-band", crease_band, &0.0);
        variant.iter().for_each(|name| line.option("--variant", name));
        scene.iter().for_each(|name| line.option("--scene", name));
        parts.hidden.iter().for_each(|name| line.option("--hide-part", name));
        parts.only.iter().for_each(|name| line.option("--show-part", name));
        parts.style_texts().for_each(|text| line.option("--part", text));
        parts.morphs.iter().for_each(|(name, weight)| line.option("--morph", format!("{name}={weight}")));
        line.changed("--max-size", &limits.file, &file);
        line.changed("--max-memory", &limits.memory, &memory);
        heights.iter().flat_map(HeightSource::texts).for_each(|text| line.option("--height", text));
    }

    /// Writes every setting that has an effect and isn't at its default. A transparent picture has no colour behind the mesh.
    fn settings(&self, line: &mut Line) {
        let background = self.settings.background.filter(|_| !self.view.transparent);
        // What takes the place of LOD takes none of its options.
        let Tessellation { lod, factor, .. } = Tessellation::default();
        let own = self.settings.tessellation;
        let has_lod = self.factors.is_none() && self.lod_shader.is_none();
        let tessellation = if has_lod { own } else { Tessellation { lod, factor, ..own } };
        let usual = Settings::default().under(tessellation.lod);
        let mut usual = if has_lod {
            usual.with(Tessellation { lod: Settings::usual().tessellation.lod, ..usual.tessellation })
        } else {
            usual
        };
        if self.light_file().is_some() && self.settings.lighting != Lighting::Environment {
            // The file is the light of both halves unless they say otherwise.
            usual.lighting = Lighting::Environment;
        }
        let shown = Settings { background, ..self.settings.with(tessellation) };
        let displaced = |displacement, of: &Settings| of.with(Tessellation { displacement, ..of.tessellation });
        let (own, usual) = match self.preparation.heights {
            // With --height the surface is displaced unless --displacement says otherwise.
            Some(_) => (shown, displaced(Displacement::On, &usual)),
            None => (displaced(Displacement::Off, &shown), usual),
        };
        let is_replaced = |name: &str| {
            (self.surface_shader.is_some() && name == options::SURFACE.name)
                || (self.matcap_image.is_some() && name == options::MATCAP.name)
        };
        let is_of_part = |name: &str| name == options::ALPHA.name && self.preparation.parts.has_phong();
        let written = |option: &&Declaration| {
            ((option.no_effect)(&own).is_none() || is_of_part(option.name)) && !is_replaced(option.name)
        };
        // The left half is said by what differs from the right one, as whoever reads the command gets that.
        let mut said = usual;
        let of_halves = || options::TESSELLATION.into_iter().chain(options::LOOKS);
        of_halves().filter(written).for_each(|option| _ = option.set(&mut said, option.get(&own)));
        let differs = |(name, value): &(&str, Value)| {
            let option = of_halves().find(|option| option.name == *name);
            // What these are without being said depends on others.
            let always =
                [&options::SURFACE, &options::LOD, &options::PARTITIONING, &options::OVERLAY].map(|own| own.name);
            always.contains(name) || option.is_none_or(|option| option.get(&said) != *value)
        };
        for option in options::all().filter(written) {
            let (name, value) = (format!("--{}", option.name), option.get(&own));
            match value {
                _ if value == option.get(&usual) => {}
                Value::Switch(is_on) => line.switch(&name, is_on),
                Value::Options(values) => {
                    line.option(&name, Value::Options(values.into_iter().filter(differs).collect()));
                }
                value => line.option(&name, value),
            }
        }
    }

    /// Writes the files of factors, of shaders, of a matcap and of light, the reference surface, the selection, the pose and the camera.
    fn view(&self, line: &mut Line) {
        let shows_matcap = self.settings.halves().any(|own| own.overlays.colors.source() == ColorSource::LitSphere);
        let files = [
            ("--factors", self.factors),
            ("--lod-shader", self.lod_shader),
            ("--surface-shader", self.surface_shader),
            ("--matcap-image", self.matcap_image.filter(|_| shows_matcap)),
            ("--environment", self.light_file()),
        ];
        for (name, path) in files.into_iter().filter_map(|(name, path)| Some((name, path?))) {
            line.option(name, named(&Source::File(path.to_owned())));
        }
        if self.settings.split.is_some() {
            self.left_mesh.iter().for_each(|left| line.option("--split-with", named(left)));
            for (name, weight) in self.left_morphs.into_iter().flatten() {
                line.option("--split-morph", format!("{name}={weight}"));
            }
        }
        if self.animation.is_none() && self.left_animation.is_none() {
            self.reference_shape.iter().for_each(|own| line.option("--reference-surface", named(own)));
            self.reference_subdivide.iter().for_each(|own| line.option("--reference-subdivide", own.name()));
        }
        self.triangle.into_iter().for_each(|triangle| line.option("--select", triangle));
        let animations = [("", self.animation), ("split-", self.left_animation)];
        for (prefix, (name, time)) in animations.into_iter().filter_map(|(prefix, own)| Some((prefix, own?))) {
            line.option(&format!("--{prefix}animation"), name);
            line.changed(&format!("--{prefix}time"), &time, &0.0);
        }
        line.switch("--transparent", self.view.transparent);
        line.switch("--legend", self.view.legend);
        line.option("--size", px(self.view.size));
        let ShotView { camera, lod_camera, size, .. } = &self.view;
        self.camera(line, "", camera);
        let lod_camera = lod_camera.map(|(camera, viewport)| (camera, viewport.to_array().map(|side| side as u32)));
        if let Some((lod_camera, lod_size)) = lod_camera.filter(|own| *own != (*camera, *size)) {
            self.camera(line, "lod-", &lod_camera);
            line.changed("--lod-size", &px(lod_size), &px(*size));
        }
    }

    /// The file of light, if it shines in a half, or is said to.
    fn light_file(&self) -> Option<&Path> {
        let is_said = self.settings.left_looks.is_some();
        let is_used = |own: Settings| own.lighting == Lighting::Environment && (own.shows_materials() || is_said);
        self.environment.filter(|_| self.settings.halves().any(is_used))
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
fn px([width, height]: [u32; 2]) -> String {
    format!("{width}x{height}")
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
pub fn given(arguments: impl IntoIterator<Item = OsString>) -> String {
    let words = arguments.into_iter().skip(1).map(|argument| word(&argument.to_string_lossy()));
    ["pnaen".to_owned()].into_iter().chain(words).collect::<Vec<_>>().join(" ")
}

/// Formats a source as an argument. A file that would be taken for an option or a shape gets `./` in front.
fn named(source: &Source) -> String {
    let text = source.to_string();
    let is_misread = text.starts_with('-') || text.starts_with("shape:");
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
