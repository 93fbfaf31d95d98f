//! How the mesh's own materials are lit, and how bright light becomes a picture.

use super::{Choice, Description};
use crate::names::every;

/// The light that the mesh's own materials are seen in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lighting {
    /// Light from all around, as in a photographer's studio, which materials reflect as glTF says.
    #[default]
    Studio,
    /// Two lights that move with the camera. Of materials only the base colour is seen.
    Camera,
}

impl Choice for Lighting {
    const ALL: &'static [Self] = &every![Lighting: Studio, Camera];

    fn description(self) -> Description {
        match self {
            Self::Studio => Description::new(
                "studio",
                "Studio",
                "Soft light from all around, made in code. It stays with the mesh, and materials reflect it as glTF 2.0 says: \
                 metal, roughness, normal maps, occlusion, emission and clear coats are seen.",
            ),
            Self::Camera => Description::new(
                "camera",
                "Camera",
                "Two lights that move with the camera. Of materials only the base colour is seen, so that pictures of \
                 different tessellations are easy to compare.",
            ),
        }
    }
}

/// How light that is brighter than a picture can show becomes colours of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneCurve {
    /// The Khronos PBR neutral tone mapper.
    #[default]
    Neutral,
    /// Each channel is cut off at 1.
    None,
}

impl Choice for ToneCurve {
    const ALL: &'static [Self] = &every![ToneCurve: Neutral, None];

    fn description(self) -> Description {
        match self {
            Self::Neutral => Description::new(
                "pbr-neutral",
                "PBR neutral",
                "Keeps base colours as they are, and compresses highlights without a change of hue (Khronos PBR Neutral Tone \
                 Mapper, 2024).",
            ),
            Self::None => Description::new(
                "none",
                "None",
                "Colours are shown as they are, and what is brighter than white is white.",
            ),
        }
    }
}
