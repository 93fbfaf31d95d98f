//! The gallery's exhibits: which techniques it shows, and on which meshes.

use geometry::mesh::Shape;
use geometry::tessellate::{Displacement, Normals, Partitioning, Surface, Tessellation};
use inspect::settings::{Choice, Description, Overlays, Settings};

/// One aspect of tessellation, with a tile for each technique.
#[derive(Clone, Debug)]
pub struct Exhibit {
    /// The name of its picture's file, without the ending.
    pub name: &'static str,
    pub title: &'static str,
    pub about: &'static str,
    /// The shape that it is shown on if no mesh is named; none for a cage.
    pub shape: Option<Shape>,
    pub overlays: Overlays,
    pub tiles: Vec<Tile>,
}

/// One technique of an exhibit.
#[derive(Clone, Debug)]
pub struct Tile {
    /// The name on the command line.
    pub name: String,
    /// A sentence that says what the technique is, and where it was published.
    pub about: String,
    pub settings: Settings,
    /// The tessellation factor, if it is another than [`super::GalleryOptions::factor`].
    pub factor: Option<f32>,
    pub own_mesh: OwnMesh,
}

/// How the mesh of a tile is prepared otherwise than the user said.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OwnMesh {
    /// The width of the crease band, as a part of the bounding diagonal; 0 for none.
    pub crease_band: f32,
    /// How often a cage is refined; none for as often as the user said.
    pub levels: Option<f32>,
}

impl Tile {
    /// A technique that is one value of an option. Its name and explanation are those of the value.
    fn new(value: impl Choice, tessellation: Tessellation) -> Self {
        let Description { name, text, .. } = value.description();
        Self {
            name: name.to_owned(),
            about: text.to_owned(),
            settings: tessellation.into(),
            factor: None,
            own_mesh: OwnMesh::default(),
        }
    }
}

/// All exhibits, in the order of the steps in which a patch is made: surface (also of cages), creases, normals, pattern, heights.
pub(super) fn exhibits() -> [Exhibit; 6] {
    [surfaces(), limits(), creases(), normals(), patterns(), heights()]
}

fn usual() -> Tessellation {
    Tessellation { partitioning: Partitioning::Integer, ..Tessellation::default() }
}

fn of_surface(surface: Surface) -> Tile {
    Tile::new(surface, Tessellation { surface, ..usual() })
}

fn surfaces() -> Exhibit {
    Exhibit {
        name: "surfaces",
        title: "Surfaces",
        about: "The patch that each technique makes of a triangle, from the positions and normals of its corners alone. Where \
                normals are split, surfaces that follow each side's own normals tear (red). Surfaces whose sides share the \
                control points of an edge don't.",
        shape: Some(Shape::CubeSplit),
        overlays: Overlays { cracks: true, ..Overlays::default() },
        tiles: Surface::ALL.map(of_surface).to_vec(),
    }
}

fn limits() -> Exhibit {
    let of = |levels: f32, surface: Surface| {
        let name = format!("{} --levels {levels}", surface.name());
        Tile { name, own_mesh: OwnMesh { levels: Some(levels), crease_band: 0.0 }, ..of_surface(surface) }
    };
    let about = "The cage refined so often that this is its limit, as nearly as can be seen.".to_owned();
    let limit = Tile { name: "limit".to_owned(), about, factor: Some(1.0), ..of(4.0, Surface::Flat) };
    let surfaces = [Surface::Flat, Surface::PhongAen, Surface::NagataAen, Surface::PnAen];
    Exhibit {
        name: "limits",
        title: "Cages and their limit",
        about: "What techniques make of the cage of a subdivision surface, whose corners were moved to the limit and have its \
                normals; what PN-AEN makes of the cage refined once; and the limit. The error is that from each technique's own \
                surface: `--reference-subdivide` measures how far that is from the limit.",
        shape: None,
        overlays: Overlays::default(),
        tiles: surfaces.map(|own| of(0.0, own)).into_iter().chain([of(1.0, Surface::PnAen), limit]).collect(),
    }
}

fn creases() -> Exhibit {
    let (name, about) = ("pn --crease-band 0.02", "A crease band, for PN triangles (Vlachos et al. 2001).");
    let own_mesh = OwnMesh { crease_band: 0.02, ..OwnMesh::default() };
    let band = Tile { name: name.to_owned(), about: about.to_owned(), own_mesh, ..of_surface(Surface::Pn) };
    Exhibit {
        name: "creases",
        title: "Creases",
        about: "Four ways to treat an edge whose sides have different normals: leave it as it is, so that it tears; first make a \
                band of small triangles along the crease, which gives all sides one normal; follow the line that both tangent \
                planes share; or take the mean of both sides' control points.",
        shape: Some(Shape::Cylinder),
        overlays: Overlays { cracks: true, ..Overlays::default() },
        tiles: vec![of_surface(Surface::Pn), band, of_surface(Surface::PnCrease), of_surface(Surface::PnAen)],
    }
}

fn normals() -> Exhibit {
    let of = |normals| Tile::new(normals, Tessellation { normals, ..usual() });
    Exhibit {
        name: "normals",
        title: "Shading normals",
        about: "The same surface shaded with different normals. Linear normals keep what the author's normals say. Quadratic \
                normals follow edges that bend back, and bulge where the author's normals don't mean a curve. The surface's \
                own normals have a step wherever patches meet at an angle, which they do almost everywhere.",
        shape: Some(Shape::CubeSmooth),
        overlays: Overlays::default(),
        tiles: Normals::ALL.iter().map(|&normals| of(normals)).collect(),
    }
}

fn patterns() -> Exhibit {
    let of = |partitioning| {
        let tile = Tile::new(partitioning, Tessellation { partitioning, ..usual() });
        Tile { factor: Some(5.4), ..tile }
    };
    Exhibit {
        name: "patterns",
        title: "Patterns",
        about: "The triangles that each partitioning makes of one factor between two whole numbers.",
        shape: Some(Shape::Icosahedron),
        overlays: Overlays { wireframe: true, patches: true, ..Overlays::default() },
        tiles: Partitioning::ALL.map(of).to_vec(),
    }
}

fn heights() -> Exhibit {
    let of = |displacement| {
        let tile = Tile::new(displacement, Tessellation { displacement, ..usual() });
        Tile { factor: Some(24.0), ..tile }
    };
    Exhibit {
        name: "displacement",
        title: "Displacement",
        about: "One height image over patches whose texture coordinates and normals differ where they meet. Dominant edges and \
                corners close seams, and moving each point along one direction closes the rest.",
        shape: Some(Shape::CubeSplit),
        overlays: Overlays { cracks: true, ..Overlays::default() },
        tiles: Displacement::ALL.iter().map(|&displacement| of(displacement)).collect(),
    }
}
