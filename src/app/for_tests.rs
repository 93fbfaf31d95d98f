//! What only tests ask the window, and what they start without its dialogs.

use std::path::{Path, PathBuf};

use glam::Vec3;

use super::App;
use super::dialogs::purpose::AskedFile;
use super::jobs::job_list::Work;
use crate::commands::{Action, CompanionFile, Written};
use inspect::engine::{Engine, Loaded};
use inspect::measure::{Cracks, Sizes};
use inspect::render::Camera;
use inspect::settings::{Settings, SplitSide};
use inspect::shot::ShotError;
use lab::chart::{Effort, Plan, Probe, save};
use load::Source;

impl App {
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    pub fn camera(&self) -> &Camera {
        &self.viewport.camera
    }

    /// Cracks of what is shown, once they are measured.
    pub fn cracks(&self) -> Option<&Cracks> {
        self.found(SplitSide::Right).map(|found| &found.cracks)
    }

    pub fn loaded(&self) -> Option<&Loaded> {
        self.document.as_ref().map(|document| &document.loaded)
    }

    /// The engine that everything is made and drawn with.
    pub fn engine(&self) -> &Engine {
        &self.engine
    }

    /// How many pictures have been drawn.
    pub fn pictures(&self) -> u64 {
        self.viewport.picture.pictures
    }

    /// The ends of the distance that is measured, in object units.
    pub fn ruler(&self) -> Option<[Option<Vec3>; 2]> {
        self.viewport.ruler.map(|ruler| ruler.ends)
    }

    /// The largest distance of a half from the reference surface, once it is known.
    pub fn deviation(&self, half: SplitSide) -> Option<f64> {
        Some(self.known_deviation(half)?.worst?.value)
    }

    pub fn last_action(&self) -> Option<&Action> {
        self.commands.last.as_ref()
    }

    /// Starts to draw the picture as was last chosen, and to write it as a PNG file, or a report on it as a page.
    ///
    /// # Errors
    /// The path doesn't end in .png or .html; as a sentence.
    pub fn save_picture(&mut self, context: &egui::Context, path: PathBuf) -> Result<(), String> {
        self.write_as(context, Written::Picture, path)
    }

    /// Starts to draw a turntable as was last chosen, and to write its folder or GIF file.
    ///
    /// # Errors
    /// The path ends as a file of another kind; as a sentence.
    pub fn save_turntable(&mut self, context: &egui::Context, path: PathBuf) -> Result<(), String> {
        let written = if self.dialogs.turntable.is_gif { Written::Gif } else { Written::Folder };
        self.write_as(context, written, path)
    }

    /// Starts to write the mesh that is emitted for this view, or for the frozen one, as a .glb or .obj file.
    ///
    /// # Errors
    /// The path has another ending; as a sentence.
    pub fn export_mesh(&mut self, context: &egui::Context, path: PathBuf) -> Result<(), String> {
        self.write_as(context, Written::Mesh, path)
    }

    /// The title of the window in which a path is typed, and why it is shown if a dialog was asked for.
    pub fn path_asked_for(&self) -> Option<(&'static str, Option<&'static str>)> {
        self.dialogs.typed_path.as_ref().map(|typed| (AskedFile::new(typed.purpose).title, typed.why))
    }

    /// Changes the settings that the chart tries, and its effort.
    pub fn chart_with(&mut self, plan: Plan, effort: Effort) {
        (self.panels.chart.plan, self.panels.chart.effort) = (plan, effort);
    }

    /// The measurement of the window's settings, if the chart doesn't list them.
    pub fn chart_current(&self) -> Option<Probe> {
        self.panels.chart.charted.as_ref()?.current?.1
    }

    /// Writes the chart as an SVG, PNG or CSV file.
    ///
    /// # Errors
    /// The path has another ending, or can't be written. Without a chart nothing is written.
    pub fn save_chart(&self, path: &Path) -> Result<(), ShotError> {
        self.panels.chart.charted.as_ref().map_or(Ok(()), |charted| save(path, std::slice::from_ref(&charted.subject)))
    }

    /// A number that no distance of a half exceeds for certain, once it is known; infinite against a limit surface.
    pub fn deviation_at_most(&self, half: SplitSide) -> Option<f64> {
        Some(self.known_deviation(half)?.largest.at_most)
    }

    /// How many previews have been drawn while the camera moved.
    pub fn previews(&self) -> u64 {
        self.viewport.preview.drawings
    }

    /// Whether the line of help of a first start is over the picture.
    pub fn greets(&self) -> bool {
        self.viewport.greets
    }

    /// Starts to load a reference surface. Until it is loaded, the one before it stays.
    pub fn open_reference_shape(&mut self, context: &egui::Context, source: Source) {
        self.open_companion(context, CompanionFile::ReferenceShape, source);
    }

    /// Starts to read the light of a file, which then shines on the mesh. Until it is read, the light before it stays.
    pub fn open_environment(&mut self, context: &egui::Context, path: PathBuf) {
        self.open_companion(context, CompanionFile::Environment, Source::File(path));
    }

    /// Opens a file with functions of the user's own, which take the place of LOD once they can be used, and watches it.
    pub fn open_lod_shader(&mut self, context: &egui::Context, path: PathBuf) {
        self.open_companion(context, CompanionFile::LodShader, Source::File(path));
    }

    /// The same for a function that takes the place of the surface.
    pub fn open_surface_shader(&mut self, context: &egui::Context, path: PathBuf) {
        self.open_companion(context, CompanionFile::SurfaceShader, Source::File(path));
    }

    /// Why the newest version of the LOD shader can't be used, in a sentence.
    pub fn lod_shader_error(&self) -> Option<&str> {
        self.lod_shader.as_ref()?.error.as_deref()
    }

    /// Why the newest version of the surface shader can't be used, in a sentence.
    pub fn surface_shader_error(&self) -> Option<&str> {
        self.surface_shader.as_ref()?.error.as_deref()
    }

    /// Sizes of the triangles shown, if they were measured for the present view, or for the frozen one if there is one.
    pub fn sizes_shown(&self) -> Option<&Sizes> {
        let document = self.document.as_ref()?;
        let frozen = self.viewport.frozen.map(|frozen| frozen.screen_view(&document.scene.bounds));
        let seen_from = frozen.or(self.viewport.picture.seen_from())?;
        document.right().measure.last().map(|results| &results.sizes).filter(|sizes| sizes.view == seen_from)
    }

    /// How many previews have been drawn out of sight, before the camera moved.
    pub fn warm_ups(&self) -> u64 {
        self.viewport.warm_up.drawings
    }

    /// Whether such a preview is being drawn.
    pub fn is_warming_up(&self) -> bool {
        self.viewport.warm_up.is_busy()
    }

    /// Whether the mesh is still being checked. The checks' results don't change the picture by themselves.
    pub fn is_checking(&self) -> bool {
        self.jobs.has(Work::Checks)
    }

    /// The message of the screen that is shown if a lost device isn't replaced.
    pub fn fatal_message(&self) -> Option<&str> {
        self.window.fatal_screen.as_ref().map(|screen| &*screen.why)
    }
}
