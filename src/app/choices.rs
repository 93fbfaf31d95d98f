//! The overlays' keys, and which overlays have a switch of their own.

use super::option_rows::with_note;
use crate::settings::{Choice, Colors, Control, Overlay, Overlays};

/// The key that turns an overlay on and off.
const fn overlay_key(overlay: Overlay) -> &'static str {
    match overlay {
        Overlay::Wireframe => "W",
        Overlay::Patches => "P",
        Overlay::Barycentric => "B",
        Overlay::Adjacency => "A",
        Overlay::Cracks => "C",
        Overlay::Folds => "O",
        Overlay::TJunctions => "T",
        Overlay::BackFaces => "K",
        Overlay::Factors => "H",
        Overlay::TriangleSize => "X",
        Overlay::LowFactors => "U",
        Overlay::Normals => "N",
        Overlay::Deviation => "V",
    }
}

/// What an overlay shows, and its key.
pub fn overlay_hover(overlay: Overlay) -> String {
    with_note(overlay.text(), overlay_key(overlay))
}

/// What the surface's colours mean, and the key of the overlay that gives them.
pub fn colors_hover(colors: Colors) -> String {
    let overlays = Overlays { colors, ..Overlays::default() };
    overlays.on().next().map_or_else(|| colors.text().to_owned(), overlay_hover)
}

/// Overlays with a switch of their own; the others give the surface its colours.
pub fn switched_overlays() -> impl Iterator<Item = Overlay> {
    let is_switch = |overlay: &Overlay| matches!(Overlays::default().control(*overlay), Control::Switch(_));
    Overlay::ALL.into_iter().filter(is_switch)
}
