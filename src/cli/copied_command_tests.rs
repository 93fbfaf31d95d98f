//! The commands that the window copies are parsed as the command line parses them.

use std::ffi::OsString;
use std::path::Path;

use clap::Parser;
use geometry::mesh::PartStyle;
use geometry::tessellate::{Displacement, Surface, Tessellation};
use glam::{Vec2, Vec3};
use inspect::engine::Preparation;
use inspect::render::Camera;
use inspect::settings::{Colors, Lighting, Settings, options};
use inspect::shot::{CopiedCommand, ShotView, Turn, given};
use load::files::Limits;
use load::import::Subdivide;
use load::{HeightSource, MorphWeights, NormalSource, ShownParts, Source};
use proptest::prelude::*;

use crate::cli::options::Declared;
use crate::cli::{Cli, CliError, Command, render};
use geometry::mesh::Bounds;
use inspect::for_tests::random;
use inspect::settings::{Matcap, Overlays};
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
    let view = ShotView { camera: *camera, lod_camera: None, size: [640, 480], transparent: false, legend: false };
    CopiedCommand {
        source,
        preparation,
        settings,
        view,
        radius: 2.0,
        animation: None,
        left_animation: None,
        reference_shape: None,
        reference_subdivide: None,
        left_mesh: None,
        left_morphs: None,
        factors: None,
        lod_shader: None,
        surface_shader: None,
        matcap_image: None,
        environment: None,
        triangle: None,
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
    let line = shown(&source, &preparation, &Settings::usual(), &camera).line();
    let mesh = if cfg!(windows) { "\"my models/it's.glb\"" } else { r"'my models/it'\''s.glb'" };
    let picture = if cfg!(windows) { "\"it's-view.png\"" } else { r"'it'\''s-view.png'" };
    let view = "--size 640x480 --camera=-30,20,2.5 --target 0,0,0";
    assert_eq!(line, format!("pnaen render {mesh} -o {picture} {view}"));
}

#[test]
fn options_with_other_values_are_written() {
    let (source, reference_shape) = (Source::File("-x.glb".into()), Source::File("shape:y".into()));
    let limits = Limits { memory: 1 << 31, ..Limits::default() };
    let heights = Some(HeightSource::File("material".into()));
    let preparation = Preparation {
        weld: 1e-5,
        crease_band: 0.02,
        heights,
        variant: Some("-matte".to_owned()),
        scene: Some("Night sky".to_owned()),
        parts: ShownParts {
            hidden: vec!["-left door".to_owned(), "b, c".to_owned()],
            only: vec!["d".to_owned()],
            styles: vec![
                (
                    "-a:b".to_owned(),
                    PartStyle { surface: Some(Surface::PhongAen), detail: Some(0.25), ..PartStyle::default() },
                ),
                ("d".to_owned(), PartStyle { detail: Some(2.0), ..PartStyle::default() }),
                (
                    "material:a b".to_owned(),
                    PartStyle { normals: Some(NormalSource::Made), crease_angle: Some(22.5), ..PartStyle::default() },
                ),
            ],
            morphs: [("-a = b".to_owned(), -0.1), ("Smile".to_owned(), 0.7)].into(),
        },
        import: Import::default(),
        limits,
    };
    let settings = Settings::opening().with(Tessellation {
        displacement: Displacement::PerPatch,
        height_scale: -0.5,
        alpha: 0.5,
        ..Settings::opening().tessellation
    });
    let target = Vec3::new(-1.5, 0.0, 1e-7);
    let camera = Camera { orthographic: true, target, field_of_view: 25.5, roll: -12.25, ..camera() };
    let shown = CopiedCommand {
        reference_shape: Some(&reference_shape),
        reference_subdivide: Some(Subdivide::Loop),
        triangle: Some(7),
        ..shown(&source, &preparation, &settings, &camera)
    };
    let args = parsed(&shown.line());
    assert_eq!(args.file, Source::File("./-x.glb".into()));
    assert_eq!(args.shot.reference.reference_shape, Some(Source::File("./shape:y".into())));
    assert_eq!(args.shot.reference.reference_subdivide, Some(Subdivide::Loop));
    let heights = Some(HeightSource::File("./material".into()));
    assert_eq!(args.shot.surface.preparation(), Preparation { heights, ..preparation.clone() });
    assert_eq!(args.shot.surface.tessellation().alpha, 0.5, "a part is Phong's");
    assert_eq!((args.shot.select, args.shot.surface.view.orthographic), (Some(7), true));
    assert_eq!(args.shot.surface.view.target, Some(camera.target));
    assert_eq!((args.shot.surface.view.field_of_view, args.shot.surface.view.roll), (25.5, -12.25));
    assert_eq!(args.shot.surface.tessellation().height_scale, -0.5);
    let moving = CopiedCommand { animation: Some(("-run, fast", 0.1)), ..shown };
    let args = parsed(&moving.line());
    assert_eq!((args.shot.surface.animation.as_deref(), args.shot.surface.time), (Some("-run, fast"), 0.1));
    assert_eq!(args.shot.reference.reference_shape, None, "an animation has no reference surface");
    assert_eq!(args.shot.reference.reference_subdivide, None, "nor has it a cage of its own");
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
    let view = ShotView { transparent: true, legend: true, ..shown.view };
    let args = parsed(&CopiedCommand { view, output, ..shown }.line());
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
fn weights_of_the_left_half_are_written_while_there_is_one() {
    let (source, preparation) = ("shape:torus".parse().expect("a shape"), Preparation::default());
    let (settings, camera) = (Settings { split: Some(0.25), ..Settings::usual() }, camera());
    let weights: MorphWeights = [("-a = b".to_owned(), -0.1), ("Smile".to_owned(), 0.7)].into();
    let with = |settings| {
        let left_morphs = Some(&weights);
        CopiedCommand { left_morphs, ..shown(&source, &preparation, settings, &camera) }.line()
    };
    let written = parsed(&with(&settings)).shot.split_morph;
    assert_eq!(written, weights.clone().into_iter().collect::<Vec<_>>());
    let whole = with(&Settings { split: None, ..settings });
    assert!(!whole.contains("--split-morph"), "{whole}");
}

#[test]
fn a_turn_is_written_as_a_turntable() {
    let (source, preparation) = ("shape:torus".parse().expect("a shape"), Preparation::default());
    let (settings, camera) = (Settings::usual(), camera());
    let with = |turn| CopiedCommand { turn, ..shown(&source, &preparation, &settings, &camera) }.line();
    let usual = with(Some((Turn::default(), false)));
    assert!(usual.starts_with("pnaen turntable shape:torus -o torus-turntable --size 640x480"), "{usual}");
    let gif = with(Some((Turn { frames: 12, fps: 20 }, true)));
    let words = gif.split(' ').map(str::to_owned);
    let Ok(Some(Command::Turntable(args))) = Cli::try_parse_from(words).map(|cli| cli.command) else { panic!("{gif}") };
    assert_eq!((args.frames, args.fps, &*args.output), (12, 20, Path::new("torus-turntable.gif")));
    assert_eq!(args.shot.surface.size, [640, 480]);
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
    let with = |lod_camera: Option<(Camera, [f32; 2])>| {
        let shown = shown(&source, &preparation, &settings, &own);
        let lod_camera = lod_camera.map(|(camera, size)| (camera, Vec2::from(size)));
        CopiedCommand { view: ShotView { lod_camera, ..shown.view }, ..shown }.line()
    };
    let args = parsed(&with(Some((frozen, [320.0, 200.0]))));
    let Some(camera) = args.shot.lod.lod_camera else { panic!("it has an LOD camera") };
    assert_eq!((camera.azimuth, camera.elevation, camera.distance), (-7.5, own.elevation, Some(1.5)));
    assert_eq!(args.shot.lod.lod_target, Some(own.target));
    assert_eq!((args.shot.lod.lod_size, args.shot.lod.lod_orthographic), (Some([320, 200]), true));
    let args = parsed(&with(Some((frozen, [640.0, 480.0]))));
    assert!(args.shot.lod.lod_camera.is_some() && args.shot.lod.lod_size.is_none(), "its view has the picture's size");
    assert_eq!(with(Some((own, [640.0, 480.0]))), with(None));
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
        let Declared(picture) = args.shot.picture;
        prop_assert!(args.shot.surface.check(picture.left_surface()).is_ok());
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
