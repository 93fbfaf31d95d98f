//! What hangs in the gallery.

use crate::mesh::{HeightMap, Heights, Mesh, Shape};
use crate::settings::{Choice, Description, Overlays, Settings};
use crate::tessellate::{Displacement, Normals, Partitioning, Surface, Tessellation};

/// One question, and a tile for every answer.
#[derive(Clone, Debug)]
pub(crate) struct Exhibit {
    /// Of its picture's file.
    pub name: &'static str,
    pub title: &'static str,
    pub about: &'static str,
    /// What it is shown on, where no mesh is named.
    pub shape: Shape,
    pub overlays: Overlays,
    pub tiles: Vec<Tile>,
}

/// One technique.
#[derive(Clone, Debug)]
pub(crate) struct Tile {
    /// As the command line has it.
    pub name: String,
    /// What it is, and whose: a sentence.
    pub about: String,
    pub settings: Settings,
    /// Where not everybody's is meant.
    pub factor: Option<f32>,
    /// Of the bounding diagonal.
    pub crease_band: f32,
}

impl Tile {
    /// A technique that is a value of an option: its name and explanation are the option's.
    fn of(value: impl Choice, tessellation: Tessellation) -> Self {
        let Description { name, text, .. } = value.description();
        Self {
            name: name.to_owned(),
            about: text.to_owned(),
            settings: tessellation.into(),
            factor: None,
            crease_band: 0.0,
        }
    }

    fn named(self, name: &str, about: &str) -> Self {
        Self { name: name.to_owned(), about: about.to_owned(), ..self }
    }
}

/// All of them, in the order in which a patch is made: surface, creases, normals, pattern, heights.
pub(crate) fn exhibits() -> [Exhibit; 5] {
    [surfaces(), creases(), normals(), patterns(), heights()]
}

fn usual() -> Tessellation {
    Tessellation { partitioning: Partitioning::Integer, ..Tessellation::default() }
}

fn surfaces() -> Exhibit {
    let of = |surface| Tile::of(surface, Tessellation { surface, ..usual() });
    Exhibit {
        name: "surfaces",
        title: "Surfaces",
        about: "What each triangle becomes, from its corners' positions and normals alone. Where normals are split, surfaces \
                that go by each side's own tear (red); those that agree on an edge's control points don't.",
        shape: Shape::CubeSplit,
        overlays: Overlays { cracks: true, ..Overlays::default() },
        tiles: Surface::ALL.map(of).to_vec(),
    }
}

fn creases() -> Exhibit {
    let of = |surface| Tile::of(surface, Tessellation { surface, ..usual() });
    let band = Tile { crease_band: 0.02, ..of(Surface::Pn) };
    Exhibit {
        name: "creases",
        title: "Creases",
        about: "What becomes of an edge whose sides have different normals: nothing, so that it tears; the mean of both sides' \
                control points; the line that both tangent planes share; or a band of small triangles with one normal on the \
                crease, made before.",
        shape: Shape::Cylinder,
        overlays: Overlays { cracks: true, ..Overlays::default() },
        tiles: vec![
            of(Surface::Pn),
            band.named("pn --rim 0.02", "A crease band, for PN triangles (Vlachos et al. 2001)."),
            of(Surface::PnCrease),
            of(Surface::PnAen),
        ],
    }
}

fn normals() -> Exhibit {
    let of = |normals| Tile::of(normals, Tessellation { normals, ..usual() });
    Exhibit {
        name: "normals",
        title: "Shading normals",
        about: "Which normals the same surface is shaded with. Its own have a step wherever patches meet at an angle, which \
                they do almost everywhere; quadratic ones follow edges that bend back, and bulge where authors' normals \
                don't mean a curve; linear ones say what the author said.",
        shape: Shape::CubeSmooth,
        overlays: Overlays::default(),
        tiles: Normals::ALL.iter().map(|&normals| of(normals)).collect(),
    }
}

fn patterns() -> Exhibit {
    let of = |partitioning| {
        let tile = Tile::of(partitioning, Tessellation { partitioning, ..usual() });
        Tile { factor: Some(5.4), ..tile }
    };
    Exhibit {
        name: "patterns",
        title: "Patterns",
        about: "How one factor between two whole numbers becomes triangles.",
        shape: Shape::Icosahedron,
        overlays: Overlays { wireframe: true, patches: true, ..Overlays::default() },
        tiles: Partitioning::ALL.map(of).to_vec(),
    }
}

fn heights() -> Exhibit {
    let of = |displacement| {
        let tile = Tile::of(displacement, Tessellation { displacement, ..usual() });
        Tile { factor: Some(24.0), ..tile }
    };
    Exhibit {
        name: "displacement",
        title: "Displacement",
        about: "One height image over patches whose texture coordinates and normals don't agree where they meet. Dominant edges \
                and vertices close seams, and one direction a point closes the rest.",
        shape: Shape::CubeSplit,
        overlays: Overlays { cracks: true, ..Overlays::default() },
        tiles: Displacement::ALL.iter().map(|&displacement| of(displacement)).collect(),
    }
}

/// A height image for shapes made in code: waves that repeat with it.
pub(super) fn waves(mesh: &Mesh) -> Heights {
    const SIZE: u32 = 128;
    let height = |i: u32| {
        let [x, y] = [i % SIZE, i / SIZE].map(|x| std::f32::consts::TAU * (x as f32 + 0.5) / SIZE as f32);
        0.5 + 0.25 * (3.0 * x).sin() * (2.0 * y).cos() + 0.2 * (x + 2.0 * y).cos()
    };
    Heights::everywhere(mesh, HeightMap::new([SIZE, SIZE], (0..SIZE * SIZE).map(height).collect()))
}
