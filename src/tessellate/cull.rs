//! Which patches emit nothing. Twin: `shaders/cull.wgsl`.

use clap::ValueEnum;
use glam::{Vec3, Vec4};

use super::lod::LodView;
use super::surface::ControlNet;

/// Whether patches that cannot be seen are left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, ValueEnum)]
#[repr(u32)]
pub enum Clip {
    /// Every patch is drawn.
    Off = 0,
    /// A patch goes when each of its ten control points lies outside the view volume, whichever plane each is outside
    /// of (McDonald and Kilgard 2010): it can drop patches that cross the view.
    Paper = 1,
}

/// Whether a clip-space position lies outside the paper's view volume, -w <= x, y, z <= w (`IsClipped`).
pub fn is_clipped(clip: Vec4) -> bool {
    let inside = clip.x.abs() <= clip.w && clip.y.abs() <= clip.w && clip.z.abs() <= clip.w;
    !inside
}

/// Whether a position in object units lies outside the view volume.
pub fn outside_view(view: &LodView, position: Vec3) -> bool {
    is_clipped(view.clip_from_object * position.extend(1.0))
}

/// The paper's test of a whole patch.
pub fn patch_is_clipped(view: &LodView, net: &ControlNet) -> bool {
    let outside = |p: &Vec3| outside_view(view, *p);
    net.corners.iter().all(outside) && net.edges.iter().all(outside) && outside(&net.center)
}
