//! Lit spheres that a surface can be shown with.

use super::choices;

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
