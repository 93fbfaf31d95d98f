//! How the mesh's own materials are lit, how bright light becomes a picture, and lit spheres in place of both.

use super::choices;

choices! {
    /// The light that the mesh's own materials are seen in.
    #[derive(Default)]
    pub enum Lighting {
        #[default]
        Studio => "studio", "Studio",
            "Soft light from all around, made in code. It stays with the mesh, and materials reflect it as glTF 2.0 \
             says: metal, roughness, normal maps, occlusion, emission and clear coats are seen.";
        Environment => "environment", "Environment file",
            "The light of a place, from a panorama in a Radiance (.hdr) or OpenEXR (.exr) file. Materials reflect it \
             as they reflect the studio.";
        Camera => "camera", "Camera",
            "Two lights that move with the camera. Of materials only the base colour is seen, so that pictures of \
             different tessellations are easy to compare.";
    }
}

choices! {
    /// Whether the lights that a file has shine on its mesh.
    #[derive(Default)]
    pub enum FileLights {
        #[default]
        On => "on", "On",
            "The lights of the glTF file (KHR_lights_punctual) shine together with the light from all around.";
        Off => "off", "Off", "Only the light from all around shines.";
    }
}

choices! {
    /// Whether normal maps tilt the normals of a surface that heights displace, which has the slopes of its relief already.
    #[derive(Default)]
    pub enum NormalMaps {
        #[default]
        Auto => "auto", "With a height image",
            "Left out where the heights come from the material's own image, which mostly has the relief of its \
             normal map; drawn where they come from a height image.";
        On => "on", "On", "Drawn over the displaced surface: for finer relief than the heights have.";
        Off => "off", "Off", "Left out while the surface is displaced.";
    }
}

choices! {
    /// How light that is brighter than a picture can show becomes colours of a picture.
    #[derive(Default)]
    pub enum ToneCurve {
        #[default]
        Neutral => "pbr-neutral", "PBR neutral",
            "Keeps base colours as they are, and compresses highlights without a change of hue (Khronos PBR Neutral \
             Tone Mapper, 2024).";
        None => "none", "None", "Colours are shown as they are, and what is brighter than white is white.";
    }
}

choices! {
    /// A matcap: a picture of a lit sphere, from which every place of a surface takes the colour that the sphere has at the same
    /// normal (Sloan et al., The Lit Sphere, 2001).
    #[derive(Default, Hash)]
    pub enum Matcap {
        #[default]
        RedClay => "red-clay", "Red clay",
            "Dark red clay with a soft sheen, as in sculpting programs. It shows fine relief.";
        Chrome => "chrome", "Chrome",
            "A mirror under a bright sky, with a sharp horizon and lamps. Their reflections show dents and kinks.";
        Pearl => "pearl", "Pearl",
            "Pale and smooth, with colours that change towards the outline. It shows soft changes of form.";
        TwoTone => "two-tone", "Two-tone",
            "Warm light from the left and cool light from the right, which meet in a soft line. It shows the large \
             form.";
    }
}
