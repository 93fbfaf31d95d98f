//! How the mesh's own materials are lit, and how bright light becomes a picture.

use super::{Choice, Description};
use geometry::names::every;

/// The light that the mesh's own materials are seen in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lighting {
    /// Light from all around, as in a photographer's studio, which materials reflect as glTF says.
    #[default]
    Studio,
    /// Light from all around, from a file: a panorama of a place. Without such a file it is the studio's.
    Environment,
    /// Two lights that move with the camera. Of materials only the base colour is seen.
    Camera,
}

impl Choice for Lighting {
    const ALL: &'static [Self] = &every![Lighting: Studio, Environment, Camera];

    fn description(self) -> Description {
        match self {
            Self::Studio => Description::new(
                "studio",
                "Studio",
                "Soft light from all around, made in code. It stays with the mesh, and materials reflect it as glTF 2.0 says: \
                 metal, roughness, normal maps, occlusion, emission and clear coats are seen.",
            ),
            Self::Environment => Description::new(
                "environment",
                "Environment file",
                "The light of a place, from a panorama in a Radiance (.hdr) or OpenEXR (.exr) file. Materials reflect it as they \
                 reflect the studio.",
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

/// Whether the lights that a file has shine on its mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FileLights {
    #[default]
    On,
    Off,
}

impl Choice for FileLights {
    const ALL: &'static [Self] = &every![FileLights: On, Off];

    fn description(self) -> Description {
        match self {
            Self::On => Description::new(
                "on",
                "On",
                "The lights of the glTF file (KHR_lights_punctual) shine together with the light from all around.",
            ),
            Self::Off => Description::new("off", "Off", "Only the light from all around shines."),
        }
    }
}

/// Whether normal maps tilt the normals of a surface that heights displace, which has the slopes of its relief already.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NormalMaps {
    /// Unless the heights come from the same material.
    #[default]
    Auto,
    On,
    Off,
}

impl Choice for NormalMaps {
    const ALL: &'static [Self] = &every![NormalMaps: Auto, On, Off];

    fn description(self) -> Description {
        let (name, label, text) = match self {
            Self::Auto => (
                "auto",
                "With a height image",
                "Left out where the heights come from the material's own image, which mostly has the relief of its normal map; \
                 drawn where they come from a height image.",
            ),
            Self::On => ("on", "On", "Drawn over the displaced surface: for finer relief than the heights have."),
            Self::Off => ("off", "Off", "Left out while the surface is displaced."),
        };
        Description::new(name, label, text)
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
