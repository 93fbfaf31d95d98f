//! The picture in the middle: the camera, what is drawn and what is selected in it.

mod axis_gizmo;
mod camera;
mod frozen_camera;
pub(super) mod highlight;
mod left_half;
pub(super) mod legend;
pub(super) mod pace;
pub(super) mod panel;
mod patch_labels;
pub(super) mod picture;
pub(super) mod place;
pub(super) mod playback;
pub(super) mod pointer_value;
pub(super) mod preview;
mod preview_pace;
mod ruler;
mod section_arrow;
pub(super) mod selection;
pub(super) mod warm_up;

use inspect::engine::Engine;
use inspect::render::Camera;
use inspect::settings::SplitSide;

use camera::FollowedCamera;
use frozen_camera::FrozenCamera;
use legend::PaintedLegend;
use pace::Pace;
use picture::Picture;
use playback::Playback;
use pointer_value::PointerValue;
use preview::Preview;
use ruler::Ruler;
use warm_up::WarmUp;

#[derive(Default)]
pub(super) struct Viewport {
    /// Where it was in the last frame, in points.
    pub rect: Option<egui::Rect>,
    pub camera: Camera,
    /// The camera as it was when it last framed the whole mesh.
    pub framed: Option<Camera>,
    /// The size in px that the picture, or half of it, had in the last frame.
    pub framed_size: glam::Vec2,
    /// The camera with which a mesh was opened, until its first picture is measured.
    pub opened: Option<Camera>,
    /// The camera of the file that is looked through, until the camera is moved otherwise.
    pub through: Option<FollowedCamera>,
    /// Views that are kept with the file.
    pub bookmarks: Vec<Camera>,
    /// The camera that LOD and clipping stay computed for, while they are frozen.
    pub frozen: Option<FrozenCamera>,
    /// The divider's place when the view was last split: 0 is the left edge, 1 the right one.
    pub last_split: f32,
    /// Whether a line of help is over the picture: at a first start, until anything is done.
    pub greets: bool,
    pub picture: Picture,
    pub legend: Option<PaintedLegend>,
    /// The half of the picture whose lower corner has it, if it isn't beside the picture.
    pub legend_side: SplitSide,
    pub pace: Pace,
    pub preview: Preview,
    pub warm_up: WarmUp,
    pub playback: Playback,
    /// Whether a list or a menu was open when a button of the pointer was pressed last.
    pub closes_list: bool,
    /// Measures distances between places that are clicked on, while it is in use.
    pub ruler: Option<Ruler>,
    /// Where the pointer rests, and what the colours stand for there.
    pub pointer: Option<PointerValue>,
}

impl Viewport {
    pub(super) fn new(engine: &Engine) -> Self {
        Self {
            camera: Camera::framing(&Default::default(), glam::Vec2::ONE),
            last_split: 0.5,
            picture: Picture::new(engine),
            preview: Preview::new(engine),
            ..Self::default()
        }
    }
}
