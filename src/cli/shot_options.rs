//! The options of commands that draw pictures: what a picture shows, and from where.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::Vec2;

use super::options::{LodCameraOption, PictureOptions, ReferenceOption, morph, seconds, whole_from};
use super::{
    CliError, FactorsOption, LodShaderOption, SurfaceOptions, SurfaceShaderOption, file_of, files_of_heights,
    keep_apart, load, load_apart, note, options, refuse, warn,
};
use geometry::mesh::Moment;
use geometry::progress::Progress;
use gpu::Given;
use inspect::engine::{self, ClipFinding, Engine, Loaded, worst_moment};
use inspect::gates::{Gate, GateKind};
use inspect::reference_shape::ReferenceShape;
use inspect::render::environment::Environment;
use inspect::render::{Camera, LeftPose, Scene, framed_size};
use inspect::settings::{Choice, ColorSource, Lighting, Settings};
use inspect::shot::{AT_REST, FactorsFile, Shot, ShotError, ShotView, Subject};
use load::environment_file::EnvironmentFile;
use load::panorama::Panorama;
use load::{MorphWeights, Source, load_matcap};

#[derive(Clone, Debug, Default, clap::Args)]
pub struct ShotOptions {
    #[command(flatten)]
    pub surface: SurfaceOptions,
    #[command(flatten)]
    pub lod: LodCameraOption,
    #[command(flatten)]
    pub given: FactorsOption,
    #[command(flatten)]
    pub user_lod: LodShaderOption,
    #[command(flatten)]
    pub user_surface: SurfaceShaderOption,
    #[command(flatten)]
    pub picture: PictureOptions,
    /// Panorama whose light shines in place of the studio's: a Radiance (.hdr) or OpenEXR (.exr) file. It has longitude across
    /// and latitude down, with -Z in its middle
    #[arg(long, value_name = "FILE")]
    pub environment: Option<PathBuf>,
    #[command(flatten)]
    pub reference: ReferenceOption,
    /// Another mesh for the left of the split, such as the high-poly original: a mesh file, or a shape
    #[arg(long, value_name = "FILE", value_parser = options::source())]
    pub split_with: Option<Source>,
    /// Give a morph target this weight left of the split, as --morph does; may be given several times. Others weigh there as on
    /// the right, or with --split-with as its file says
    #[arg(long, value_name = "NAME=WEIGHT", requires = "split", value_parser = morph, allow_hyphen_values = true)]
    pub split_morph: Vec<(String, f32)>,
    /// Show the mesh left of the split in a pose of this animation, or at `rest`
    #[arg(long, value_name = "NAME", requires = "split", allow_hyphen_values = true)]
    pub split_animation: Option<String>,
    /// Time in that animation, or without it in --animation, in s
    #[arg(long, value_name = "SECONDS", requires = "split", value_parser = seconds, allow_hyphen_values = true)]
    pub split_time: Option<f64>,
    /// Outline the patch of this triangle (its number in the mesh, from 0); the edges of factors 0, 1 and 2 are red, green
    /// and blue
    #[arg(long, value_name = "TRIANGLE", value_parser = whole_from(0_u32))]
    pub select: Option<u32>,
    /// PNG, JPEG or WebP image of a lit sphere for the matcap overlay, in place of that of --matcap
    #[arg(long, value_name = "IMAGE", conflicts_with = "matcap")]
    pub matcap_image: Option<PathBuf>,
    /// Show the moment of --animation with the most of these, in place of --time
    #[arg(long, value_name = "FINDING", requires = "animation", conflicts_with = "time", value_parser = options::choice::<ClipFinding>())]
    pub worst: Option<ClipFinding>,
    /// Transparent background
    #[arg(long, conflicts_with = "background")]
    pub transparent: bool,
    /// Draw the legend of the surface's colours into a lower corner, and in a split picture the divider and what its halves show
    #[arg(long)]
    pub legend: bool,
}

impl ShotOptions {
    /// Checks the options, and that no file to be written is one that is read. `read` are files that the command reads besides
    /// those of these options.
    pub(super) fn check(
        &self,
        file: &Source,
        read: &[Option<&Path>],
        written: &[Option<&Path>],
    ) -> Result<(), CliError> {
        self.surface.check(self.picture.0.left_surface())?;
        self.user_lod.check_alone(&self.given)?;
        refuse(
            self.matcap_image.is_some() && !self.shows(|own| own.overlays.colors.source() == ColorSource::LitSphere),
            "--matcap-image needs --overlay matcap, which shows it",
        )?;
        let (has_file, needs_file) =
            (self.environment.is_some(), self.shows(|own| own.lighting == Lighting::Environment));
        refuse(has_file && !needs_file, "--environment is the light of --lighting environment: choose one light")?;
        refuse(needs_file && !has_file, "--lighting environment needs --environment, the file that has the light")?;
        let is_hidden = self.split_with.is_some() && self.picture.0.split.is_none();
        refuse(is_hidden, "--split-with needs --split, which shows it")?;
        let is_of_none = self.split_animation.is_none() && self.surface.animation.is_none();
        refuse(self.split_time.is_some() && is_of_none, "--split-time needs --split-animation, or --animation")?;
        let reference_shape = self.reference.reference_shape.as_ref().and_then(file_of);
        let left = self.split_with.as_ref().and_then(file_of);
        let (factors, matcap) = (self.given.given.as_deref(), self.matcap_image.as_deref());
        let shaders = [self.user_lod.lod_shader.as_deref(), self.user_surface.surface_shader.as_deref()];
        let own = [file_of(file), reference_shape, left, factors, matcap, self.environment.as_deref()];
        let own = own.into_iter().chain(files_of_heights(&self.surface.height));
        keep_apart(own.chain(shaders).chain(read.iter().copied()), written.iter().copied())
    }

    /// Whether a half of the picture has settings like this.
    fn shows(&self, is_shown: impl Fn(&Settings) -> bool) -> bool {
        self.picture.0.halves().any(|own| is_shown(&own))
    }

    /// Width and height in px of the middle of the picture that shows all of the mesh.
    pub(super) fn framed_size(&self) -> Vec2 {
        framed_size(self.surface.viewport(), &self.picture.0)
    }

    /// Refuses gates that these options leave nothing to judge.
    pub(super) fn check_gates(&self, gates: &[Gate]) -> Result<(), CliError> {
        self.user_surface.check(false, gates)?;
        let stays = self.lod.lod_camera.is_some() || self.surface.view.view_projection.is_some();
        refuse(
            stays && gates.iter().any(|gate| gate.kind == GateKind::Pops),
            "--fail-on pops flies the camera, which LOD doesn't follow with --lod-camera, and which --view-projection keeps \
             where it is: leave them out",
        )
    }

    /// Checks a camera that isn't known before the mesh is.
    pub(super) fn check_camera(&self, camera: &Camera) -> Result<(), CliError> {
        refuse(
            camera.is_mirrored() && self.picture.0.split.is_some(),
            "--split can't be combined with a --view-projection that mirrors: its halves would change places",
        )
    }

    /// Reads the mesh and all other files. Returns what is drawn, and what was found about a file of factors.
    pub(super) fn subject(
        &self,
        file: &Source,
        written: &[Option<&Path>],
    ) -> Result<(Subject, Option<FactorsFile>), CliError> {
        self.subject_of(load_apart(file, &self.surface.preparation(), written)?)
    }

    /// Like [`Self::subject`], for a mesh that was loaded as these options say.
    pub(super) fn subject_of(&self, loaded: Loaded) -> Result<(Subject, Option<FactorsFile>), CliError> {
        let limits = self.surface.weld.limit.limits();
        let user_lod = self.user_lod.read(&self.surface)?;
        let surface_shader = self.user_surface.read(&self.surface.weld.parts)?;
        let matcap = self.matcap_image.as_ref().map(|path| load_matcap(path, &limits)).transpose()?;
        let given = self.given.read(&loaded.mesh, &loaded.topology, &self.surface)?;
        let morphs: MorphWeights = self.split_morph.iter().cloned().collect();
        let preparation = loaded.preparation.of_left(self.split_with.is_some(), &morphs);
        let left = match &self.split_with {
            Some(source) => Some(load(source, &preparation)?),
            None if morphs.is_empty() => None,
            // What is said of it was said of the right one.
            None => Some(engine::load(&loaded.source, &preparation, &Progress::new())?),
        };
        let has_bones = left.iter().chain([&loaded]).any(|own| !own.mesh.bones.is_empty());
        if self.shows(|own| own.overlays.bones) && !has_bones {
            note("--overlay bones has no effect: no skin moves the mesh");
        }
        let selected = self.select.map(|triangle| selected_patch(&loaded, triangle)).transpose()?;
        let environment = self.environment.as_deref().map(|path| self.environment(path)).transpose()?;
        let (given, factors_file) = given.unzip();
        let left_pose = self.left_pose(left.as_ref().unwrap_or(&loaded))?;
        let moves = self.surface.animation.is_some() || matches!(left_pose, LeftPose::Own(Some(_)));
        let reference_surface = self.reference_surface(&loaded, moves)?;
        let mut settings = self.surface.settings_of(&self.picture.0);
        // A pose may turn a part inside out.
        settings.left.cull_back_faces &= left_pose == LeftPose::Same;
        let subject = Subject {
            left,
            left_pose,
            moment: self.surface.moment(&loaded)?,
            given: given.map(Given::from).or(user_lod),
            surface_shader,
            matcap: matcap.map(Arc::new),
            environment,
            reference_surface,
            selected,
            arena_bytes: self.surface.arena_bytes(),
            ..Subject::new(loaded, settings)
        };
        Ok((subject, factors_file))
    }

    /// The pose of the mesh left of the split.
    fn left_pose(&self, left: &Loaded) -> Result<LeftPose, CliError> {
        let of_right = self.surface.animation.as_ref().filter(|_| self.split_time.is_some());
        let Some(name) = self.split_animation.as_ref().or(of_right) else { return Ok(LeftPose::Same) };
        let has_clip = left.mesh.rig.as_ref().is_some_and(|rig| rig.clip(name).is_some());
        let animation = Some(name.clone()).filter(|name| name != AT_REST || has_clip);
        let time = self.split_time.unwrap_or(0.0);
        Ok(LeftPose::Own(SurfaceOptions { animation, time, ..self.surface.clone() }.moment(left)?))
    }

    /// The surface to compare with, and its name: the one that was chosen, or if the overlay is shown the exact surface; none for
    /// the limit surface.
    fn reference_surface(&self, mesh: &Loaded, moves: bool) -> Result<Option<(String, Arc<ReferenceShape>)>, CliError> {
        let Self { surface, reference, .. } = self;
        let chosen = reference.load(&mesh.source, &mesh.preparation, Source::to_string)?;
        refuse(
            moves && chosen.is_some(),
            "--reference-surface and --reference-subdivide don't move, so leave out --animation and --split-animation",
        )?;
        if chosen.is_some() || !self.shows(|own| own.overlays.colors.source() == ColorSource::ReferenceSurface) {
            return Ok(chosen.map(|(name, chosen)| (name, Arc::new(chosen))));
        }
        let is_plain = !moves && !surface.tessellation().displacement.is_on();
        let exact = mesh.source.shape().filter(|_| is_plain).and_then(ReferenceShape::from_shape);
        refuse(
            exact.is_none() && self.user_surface.surface_shader.is_some(),
            "--overlay deviation compares with the surface on the CPU, where that of --surface-shader isn't known: name another \
             one with --reference-surface",
        )?;
        Ok(exact.map(|exact| (mesh.source.to_string(), Arc::new(exact))))
    }

    /// Reads the light of a file. Standard error tells what was repaired.
    fn environment(&self, path: &Path) -> Result<Panorama, CliError> {
        let EnvironmentFile { panorama, warnings } =
            EnvironmentFile::load(path, &self.surface.weld.limit.limits(), &Progress::new())?;
        warn(&warnings);
        Ok(panorama)
    }

    /// Uploads the subject, and tessellates it as these options say, within the budget of triangles.
    pub(super) fn shot(&self, engine: Engine, mut subject: Subject) -> Result<Shot, CliError> {
        let mut scene = engine.scene(&subject.loaded, subject.arena_bytes)?;
        subject.apply_to_scene(&engine, &mut scene)?;
        if let Some(panorama) = subject.environment.take() {
            scene.environment = Some(Arc::new(Environment::from_panorama(&engine.gpu, panorama)?));
        }
        let mut view = self.view(&subject, &scene)?;
        let lod_view = view.lod_view(&scene);
        let within = self.surface.within_budget_on(&engine, &mut scene, lod_view)?;
        subject.settings = subject.settings.with(within.tessellation);
        if let Some((finding, moment)) = self.worst.zip(subject.moment) {
            let lod_view = view.lod_view(&scene);
            let found = engine.survey_clip(&mut scene, &subject.settings, lod_view, moment.clip, &Progress::new())?;
            if let Some(worst) = worst_moment(&found.map_err(ShotError::from)?, finding) {
                let count = worst.counts[finding as usize];
                note(&format!("the most {} are at {} s: {count}", finding.label(), worst.time as f32));
                subject.moment = Some(Moment { time: worst.time, ..moment });
                subject.apply_to_scene(&engine, &mut scene)?;
                view = self.view(&subject, &scene)?;
            }
        }
        Ok(Shot::new(engine, scene, subject, view)?)
    }

    /// From where the subject is seen at its moment.
    fn view(&self, subject: &Subject, scene: &Scene) -> Result<ShotView, CliError> {
        let mesh = &subject.loaded.mesh;
        let view = ShotView {
            camera: self.surface.view.camera(
                &self.surface,
                (mesh, subject.moment, &scene.bounds),
                self.framed_size(),
            )?,
            lod_camera: self.lod.camera(&self.surface, mesh, &scene.bounds)?,
            size: self.surface.size,
            transparent: self.transparent,
            legend: self.legend,
        };
        self.check_camera(&view.camera)?;
        Ok(view)
    }
}

/// The patch of a triangle of the mesh.
fn selected_patch(loaded: &Loaded, triangle: u32) -> Result<u32, CliError> {
    let (file, count) = (loaded.source.to_string(), loaded.mesh.triangles.len());
    if triangle as usize >= count {
        return Err(CliError::NoTriangle { file, last: count.saturating_sub(1), triangle });
    }
    loaded.topology.patch_of(triangle).ok_or(CliError::NoPatch { file, triangle })
}
