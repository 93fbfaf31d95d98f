//! Where the halves of a split picture are.

use glam::{Vec2, vec2};

use super::covered_area::{Area, intersection, is_empty};
use crate::settings::{Settings, SplitSide, SplitView};

/// The part of a picture that shows one half.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HalfPlace {
    /// Width and height of the picture in px.
    size: [u32; 2],
    pub(super) area: Area,
    /// By how many columns all that the half shows is moved to the right.
    pub shift: i32,
}

impl HalfPlace {
    /// The columns of a half from `start` to `end`.
    fn new(size: [u32; 2], [start, end]: [u32; 2], is_centered: bool) -> Self {
        let shift = if is_centered { (start + end) as i32 / 2 - size[0] as i32 / 2 } else { 0 };
        Self { size, area: [start, 0, end - start, size[1]], shift }
    }

    /// The place of a part of the half: `covered` are px of the picture that all of the view would fill.
    pub(super) fn part(&self, covered: Area) -> Self {
        let [x, y, width, height] = self.area;
        let [x, y, width, height] = intersection(covered, [x.saturating_add_signed(-self.shift), y, width, height]);
        Self { area: [x.saturating_add_signed(self.shift), y, width, height], ..*self }
    }

    /// Confines draws to it. Returns false if nothing is in it.
    pub(super) fn confine(&self, pass: &mut wgpu::RenderPass) -> bool {
        let ([x, y, width, height], size) = (self.area, self.size.map(|side| side as f32));
        if !is_empty(self.area) {
            pass.set_scissor_rect(x, y, width, height);
            pass.set_viewport(self.shift as f32, 0.0, size[0], size[1], 0.0, 1.0);
        }
        !is_empty(self.area)
    }

    /// The middle of what the half shows in px, from the middle of the view.
    pub fn middle(&self) -> Vec2 {
        let [x, _, width, _] = self.area;
        vec2(x as f32 + 0.5 * width as f32 - self.shift as f32 - 0.5 * self.size[0] as f32, 0.0)
    }
}

/// The left and the right half of a picture of `size` px.
pub fn half_places(size: [u32; 2], settings: &Settings) -> [HalfPlace; 2] {
    let width = size[0];
    let at = settings.split.map_or(0, |split| (split.clamp(0.0, 1.0) * width as f32).round() as u32);
    match (settings.split, settings.split_view) {
        (Some(_), SplitView::Difference) => [HalfPlace::new(size, [0, width], false); 2],
        (_, view) => [[0, at], [at, width]].map(|columns| HalfPlace::new(size, columns, view == SplitView::Beside)),
    }
}

/// Width and height in px of the part of a view that both halves show, if it is moved to their middles. A half that is hidden, or nearly,
/// doesn't count.
pub fn framed_size(size: Vec2, settings: &Settings) -> Vec2 {
    let narrower = settings.split.map(|split| split.min(1.0 - split)).filter(|part| *part > 0.05);
    match narrower.filter(|_| settings.split_view == SplitView::Beside) {
        Some(part) => size * vec2(part, 1.0),
        None => size,
    }
}

/// The half of a picture of `size` px in which a pixel lies, and the same pixel where all of the picture shows that half.
pub fn half_at([x, y]: [u32; 2], size: [u32; 2], settings: &Settings) -> (SplitSide, [u32; 2]) {
    let [left, right] = half_places(size, settings);
    let is_left = right.area[0] > x;
    let (half, place) = if is_left { (SplitSide::Left, left) } else { (SplitSide::Right, right) };
    (half, [x.saturating_add_signed(-place.shift), y])
}
