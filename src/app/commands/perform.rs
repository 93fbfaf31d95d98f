//! What each command does, and the state that decides which commands are possible.

use egui::{Context, OpenUrl, ViewportCommand, gui_zoom};

use crate::app::App;
use crate::app::dialogs::Forgetting;
use crate::app::jobs::picture_job::PictureChoices;
use crate::app::panels::destinations::{Destination, Step};
use crate::commands::{Action, Availability, Change, Command, FileAction, MOST_BOOKMARKS, Need, Preparing, Purpose};
use geometry::tessellate::Tessellation;
use inspect::settings::{ColorSource, Declaration, Settings, SplitSide, options};
use load::format::Format;
use load::{Import, Source};

const WHITE_PAPER: &str = "https://developer.download.nvidia.com/whitepapers/2010/PN-AEN-Triangles-Whitepaper.pdf";

impl App {
    /// The state that decides which commands are possible.
    pub fn availability(&self) -> Availability {
        let has_effect = |option: &Declaration| (option.no_effect)(&self.settings).is_none();
        let lets_lod = self.given.is_none() && !self.uses_lod_shader();
        let document = self.document.as_ref();
        let (bookmarks, clips) = (self.viewport.bookmarks.len(), self.clip_names());
        let has_cage =
            matches!(self.source(), Some(Source::File(path)) if Format::from_name(path) != Some(Format::Gltf));
        let scenes = SplitSide::BOTH.into_iter().filter_map(|half| document?.scene.half(half));
        let has_bones = scenes.map(|own| own.tessellator.mesh()).any(|mesh| !mesh.bones.is_empty());
        let cameras = document.map(|document| &document.loaded.mesh.cameras);
        let needs = [
            (Need::Document, document.is_some()),
            (Need::File, self.source().is_some_and(|source| source.shape().is_none())),
            (Need::Cage, has_cage),
            (Need::Neighbours, document.is_some_and(|document| document.neighbours.is_some())),
            (Need::Picture, self.viewport.picture.drawn.is_some()),
            (Need::NoWriting, !self.is_writing()),
            (Need::ReferenceShape, self.reference_shape.is_some()),
            (Need::LeftMesh, self.other_left().is_some()),
            (Need::Before, document.is_some_and(|document| document.before.is_some())),
            (Need::Factors, self.given.is_some()),
            (Need::LodShader, self.lod_shader.is_some()),
            (Need::SurfaceShader, self.surface_shader.is_some()),
            (Need::Surface, !self.uses_surface_shader()),
            (Need::Environment, self.environment.is_some()),
            (Need::Undo, !self.history.past.is_empty() || self.is_opening()),
            (Need::Redo, !self.history.future.is_empty()),
            (Need::ViewBefore, !self.view_history.views.past.is_empty()),
            (Need::ViewAfter, !self.view_history.views.future.is_empty()),
            (Need::Bookmarks, bookmarks > 0),
            (Need::RoomForBookmarks, bookmarks < MOST_BOOKMARKS),
            (Need::Selection, self.selected_edge().is_some() || self.selected_triangle().is_some()),
            (Need::SelectedPatch, self.selected_patch().is_some()),
            (Need::Heights, self.has_heights()),
            (Need::TextureCoordinates, document.is_some_and(|document| document.has_texture_coordinates)),
            (Need::Bones, has_bones),
            (Need::NormalsAt, has_effect(&options::NORMALS_AT)),
            (Need::Factor, has_effect(&options::FACTOR) && lets_lod),
            (Need::Lod, has_effect(&options::LOD) && lets_lod),
            (Need::Culling, self.can_cull_back_faces()),
            (Need::Split, self.settings.split.is_some()),
            (Need::Frozen, self.viewport.frozen.is_some()),
            (Need::Deviation, self.settings.any_half_shows(ColorSource::ReferenceSurface)),
            (Need::MeasurableChart, self.can_measure_chart()),
            (Need::Chart, !self.chart_rows().is_empty()),
            (Need::Clips, !clips.is_empty()),
        ];
        Availability {
            has: needs.into_iter().filter(|(_, holds)| *holds).map(|(need, _)| need).collect(),
            bookmarks,
            file_cameras: cameras.into_iter().flatten().map(|camera| camera.name.clone()).collect(),
            clips,
            recent: self.persistence.recent().map(Into::into).collect(),
        }
    }

    pub fn give(&mut self, context: &Context, command: &Command) {
        if command.why_not(&self.availability()).is_none() {
            self.perform(context, &command.action);
            self.commands.last = Some(command.action.clone());
        }
    }

    fn perform(&mut self, context: &Context, action: &Action) {
        match action {
            Action::File(action) => self.perform_on_files(context, action),
            Action::Camera(action) => self.move_camera_by(context, *action),
            Action::Setting(Change::SwapHalves) => self.swap_halves(context),
            Action::Setting(change) => self.settings.change_half_looks(self.panels.edited, |own| change.apply(own)),
            Action::Prepare(preparing) => self.prepare(context, |own| match preparing.clone() {
                Preparing::Heights(heights) => own.heights = heights,
                Preparing::Weld(tolerance) => own.weld = tolerance,
                Preparing::CreaseBand(width) => own.crease_band = width,
            }),
            Action::Undo => self.undo(context),
            Action::Redo => self.redo(context),
            Action::CopyAsCommand => self.copy_command(context, &PictureChoices::default(), None),
            Action::CopyPicture => self.copy_picture(context),
            Action::ResetSettings => self.reset_settings(),
            Action::ForgetEverything => self.dialogs.asks_to_forget = Some(Forgetting::Everything),
            Action::SplitView => self.toggle_split(),
            Action::KeepOnLeft => self.keep_on_left(),
            Action::HidePanels => self.panels.are_hidden = !self.panels.are_hidden,
            Action::FocusControls => context.memory_mut(|memory| memory.move_focus(egui::FocusDirection::Next)),
            Action::OpenAllSections => self.panels.open.set_all(true),
            Action::FoldAllSections => self.panels.open.set_all(false),
            Action::Warnings => self.dialogs.shows_warnings = true,
            Action::FreezeLodCamera => self.toggle_frozen(),
            // Clicks take places until it is stopped.
            Action::Ruler => self.viewport.ruler = self.viewport.ruler.is_none().then(Default::default),
            Action::Previews => self.switch_previews(),
            Action::AddBookmark if self.viewport.bookmarks.contains(&self.viewport.camera) => {}
            Action::AddBookmark => self.viewport.bookmarks.push(self.viewport.camera),
            Action::ForgetBookmarks => self.dialogs.asks_to_forget = Some(Forgetting::Bookmarks),
            Action::Background => self.dialogs.chooses_background = true,
            Action::Chart => self.toggle_chart(),
            Action::MeasureChart => self.measure_chart(context),
            Action::WidestCrack => self.follow(Destination::Cracks, Step::Worst),
            Action::NextPlace => self.step_through_finding(Step::Next),
            Action::PreviousPlace => self.step_through_finding(Step::Previous),
            Action::Theme(theme) => context.set_theme(*theme),
            Action::LargerText => gui_zoom::zoom_in(context),
            Action::SmallerText => gui_zoom::zoom_out(context),
            Action::UsualText => context.set_zoom_factor(1.0),
            Action::ToggleDisplacement => self.toggle_displacement(),
            Action::PlayOrPause => self.toggle_playing(context),
            Action::AnimationClip(clip) => self.choose_clip(*clip),
            Action::Deselect => self.deselect(),
            Action::Cancel => self.cancel(),
            Action::SearchCommands => self.search_commands(),
            Action::Keys => self.commands.shows_keys = true,
            Action::WhitePaper => context.open_url(OpenUrl::new_tab(WHITE_PAPER)),
        }
    }

    fn perform_on_files(&mut self, context: &Context, action: &FileAction) {
        match action {
            FileAction::Ask(purpose) => self.ask_for(context, *purpose),
            FileAction::OpenPath => self.type_path(Purpose::Open),
            FileAction::OpenSource(source) => self.open(context, source.clone()),
            FileAction::Reload => self.reload(context),
            FileAction::CompareWithBefore => self.compare_with_before(),
            FileAction::CompareWithOwnLimit => self.read_reference(context, None, true),
            FileAction::NextMesh => self.open_neighbour(context, true),
            FileAction::PreviousMesh => self.open_neighbour(context, false),
            FileAction::Close(beside) => self.close_companion(*beside),
            FileAction::SavePicture => self.dialogs.picture.is_open = true,
            FileAction::SaveTurntable => self.dialogs.turntable.is_open = true,
            FileAction::Quit => context.send_viewport_cmd(ViewportCommand::Close),
        }
    }

    /// Goes back to the settings of a first start. Whether displacement is on depends on the mesh, and so do axis and unit: they stay.
    pub(in crate::app) fn reset_settings(&mut self) {
        let Settings { tessellation: Tessellation { displacement, .. }, import, .. } = self.settings;
        let usual = Settings::opening();
        let import = Import { up: import.up, unit: import.unit, ..usual.import };
        self.put_settings(Settings { import, ..usual.with(Tessellation { displacement, ..usual.tessellation }) });
    }

    /// Closes the windows over the picture; or if there are none, stops what is under way; or if nothing is, ends the measuring of
    /// a distance, or clears the selection.
    fn cancel(&mut self) {
        let (dialogs, commands) = (&mut self.dialogs, &mut self.commands);
        let notice = dialogs.notice.take();
        let was_open = notice.is_some_and(|notice| notice.for_window().is_some())
            | dialogs.error.take().is_some()
            | dialogs.typed_path.take().is_some()
            | dialogs.asks_to_forget.take().is_some()
            | std::mem::take(&mut dialogs.chooses_background)
            | std::mem::take(&mut dialogs.picture.is_open)
            | std::mem::take(&mut dialogs.turntable.is_open)
            | std::mem::take(&mut dialogs.shows_warnings)
            | std::mem::take(&mut commands.shows_keys)
            | commands.palette.take().is_some()
            | commands.copied.take().is_some();
        if was_open {
            return;
        }
        if let Some(under_way) = self.under_way() {
            return self.stop(&under_way);
        }
        if self.viewport.ruler.take().is_none() {
            self.deselect();
        }
    }
}
