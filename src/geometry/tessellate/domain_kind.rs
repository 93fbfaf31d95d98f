//! The shapes of a patch that Direct3D's tessellator knows.

use crate::choice::choices;

choices! {
    /// What a patch is before it is tessellated: the domain of its points (Direct3D 11.3, section 11.7).
    #[derive(Default, Hash)]
    pub enum DomainKind {
        #[default]
        Tri => "tri", "Triangle",
            "A triangle, whose points have the weights u, v and 1 - u - v of its corners.";
        Quad => "quad", "Quad",
            "The unit square, whose points have the places u and v, from 0 to 1.";
        Isoline => "isoline", "Isolines",
            "Lines along u at equal distances in v, of which that at v = 1 is left out.";
    }
}
