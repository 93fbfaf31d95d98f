//! The cases: what each mesh is, why it breaks tessellators, and what is measured on it.

use glam::{Vec3, vec3};

use super::meshes::{scaled, with_normals};
use super::{Subject, meshes};
use geometry::mesh::{Mesh, Shape};

/// A mesh that breaks tessellators, and what is measured on it.
#[derive(Clone, Copy)]
pub struct Case {
    pub name: &'static str,
    /// What the mesh is, and what the methods make of it: a paragraph.
    pub about: &'static str,
    pub mesh: fn() -> Mesh,
    /// The weld tolerance, as a part of the bounding diagonal.
    pub weld: f32,
    pub probe: Probe,
    /// How its picture is taken.
    pub view: CaseView,
}

impl Case {
    /// A case that is welded exactly, on which nothing but edges is measured.
    const fn new(name: &'static str, mesh: fn() -> Mesh, about: &'static str) -> Self {
        Self { name, about, mesh, weld: 0.0, probe: Probe::Edges, view: DEFAULT_VIEW }
    }

    const fn probing(self, probe: Probe) -> Self {
        Self { probe, ..self }
    }

    const fn seen(self, view: CaseView) -> Self {
        Self { view, ..self }
    }

    /// The case, ready to run.
    pub fn subject(&self) -> Subject {
        let Self { name, about, mesh, weld, probe, view } = *self;
        Subject { about: about.to_owned(), probe, view, ..Subject::new(name.to_owned(), mesh(), weld) }
    }
}

/// What is measured besides the agreement of edges, which is measured on every case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Probe {
    /// Nothing else.
    Edges,
    /// Folds: triangles that face away from the side that their patch faces.
    Folds,
    /// The distance by which the surface jumps as the factor grows.
    Sweep,
    /// The length of segments on screen and the pixels that clipping changes, seen as [`CaseView`] says.
    View,
    /// Whether the T-junctions are found. Holds how many the mesh has.
    TJunctions(u32),
    /// The open edges that an exact weld leaves, and those that the case's tolerance leaves.
    Weld,
}

/// The camera and the factor for the picture of a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CaseView {
    /// In degrees, as in [`inspect::render::Camera`].
    pub azimuth: f32,
    pub elevation: f32,
    /// From the target to the eye, in bounding radii; 0 for the distance from which all of the mesh is in view.
    pub distance: f32,
    /// From the middle of the bounding box to the target, in bounding radii.
    pub target: [f32; 3],
    /// The tessellation factor of the picture.
    pub factor: f32,
}

/// From the front, the right and above, as the window opens a mesh.
pub(crate) const DEFAULT_VIEW: CaseView =
    CaseView { azimuth: 30.0, elevation: 20.0, distance: 0.0, target: [0.0; 3], factor: 5.0 };

/// Every case, in the order of the documentation.
pub const CASES: [Case; 35] = [
    Case::new(
        "split-normals",
        || Shape::CubeSplit.build(),
        "A cube whose faces have their own normals. Under PN each face follows its own normals, so that all twelve \
         edges tear. PN-AEN takes the mean of both sides' control points, which closes the edges: to the last bit \
         if each edge is computed once, and except for the last bits as published.",
    ),
    Case::new(
        "smooth-torus",
        || Shape::Torus.build(),
        "A torus with smooth normals, without any defect. Yet as published about half of all edge points and a \
         quarter of all factors of edges differ in their last bits, since the two patches add the same numbers in \
         opposite orders. An edge that is computed once, in its own direction, has one result.",
    ),
    Case::new(
        "non-manifold",
        meshes::fins,
        "Five half-planes around one edge. The white paper's index buffer has room for one neighbour across an \
         edge, so as published these patches stay as under PN, and tear. If the edge is computed once, its control \
         points are the mean over all five sides.",
    )
    .seen(CaseView { azimuth: 20.0, elevation: 35.0, ..DEFAULT_VIEW }),
    Case::new(
        "reversed-neighbours",
        meshes::reversed_neighbours,
        "An icosphere in which every third triangle is wound the other way. Each edge has a direction of its own, \
         so it makes no difference which way its sides run.",
    ),
    Case::new(
        "moebius",
        || Shape::Moebius.build(),
        "A strip with half a twist. At its join, neighbours run the shared edge in the same direction, and their \
         normals are opposite. A control point is the same for a normal and its opposite, so both sides agree.",
    )
    .seen(CaseView { elevation: 35.0, ..DEFAULT_VIEW }),
    Case::new(
        "duplicates",
        meshes::duplicates,
        "A torus in which every other triangle appears twice and every fifth once more with reversed winding, with \
         degenerate triangles among them. Edges have up to five sides, which all share one curve. Triangles without \
         three distinct points are left out and counted.",
    ),
    Case::new(
        "slivers",
        || scaled(Shape::CubeSplit, vec3(1.0, 1e-6, 1e-6), Vec3::ZERO),
        "A cube stretched to a needle, whose triangles are a million times longer than wide.",
    )
    .seen(CaseView { azimuth: 60.0, distance: 1.2, ..DEFAULT_VIEW }),
    Case::new(
        "signed-zeros",
        meshes::signed_zeros,
        "A saddle in which every other triangle writes zero as -0. Points and corners are compared by value and \
         stored with +0, so that 0 and -0 are the same point and the same normal.",
    ),
    Case::new(
        "mirrored",
        meshes::mirrored,
        "Half a torus and its mirror image, as a mirrored instance makes it. The halves share the points between \
         them, where coordinates differ in the sign of zero.",
    ),
    Case::new(
        "borders",
        || Shape::Saddle.build(),
        "An open sheet. Edges with one side are plain PN, and have no neighbour that could differ.",
    ),
    Case::new(
        "zero-normals",
        || with_normals(Shape::Icosphere, |t, k, c| if (t + k) % 3 == 0 { Vec3::ZERO } else { c.normal }),
        "A third of the corners have normals of length zero, which have no direction. They get smooth normals \
         instead (angle-weighted over faces within 60 degrees), and `info` counts them.",
    ),
    Case::new(
        "nan-normals",
        || {
            with_normals(Shape::Icosphere, |t, k, c| match (t + k) % 4 {
                0 => Vec3::NAN,
                1 => vec3(f32::INFINITY, 0.0, c.normal.z),
                _ => c.normal,
            })
        },
        "Half of the corners have normals that hold NaN or infinity. They are treated as zero normals are.",
    ),
    Case::new(
        "long-normals",
        || with_normals(Shape::Icosphere, |t, k, c| c.normal * [1e-30, 0.5, 1e30, 1.0][(t + k) % 4]),
        "Normals with lengths from 1e-30 to 1e30. They are brought to length 1 in double precision, and counted.",
    ),
    Case::new(
        "opposite-normals",
        || with_normals(Shape::Icosphere, |t, _, c| if t % 2 == 0 { c.normal } else { -c.normal }),
        "Every other triangle has its normals the other way, so that the normals on both sides of its edges are \
         opposite. The control points stay, since they are the same for a normal and its opposite; the shading \
         flips, as the file says; and nothing cancels to NaN. `info` counts such edges.",
    ),
    Case::new(
        "edge-normals",
        meshes::edge_normals,
        "Normals that run along an edge. The tangent plane is then perpendicular to the edge, and the control point \
         falls onto the corner: it is degenerate, but finite and shared. `info` counts such corners.",
    ),
    Case::new(
        "inward-normals",
        || with_normals(Shape::Icosphere, |_, _, c| -c.normal),
        "Normals that point against their faces. The surface stays, since control points are the same for a normal \
         and its opposite; it is shaded as the file says. `info` counts such corners.",
    ),
    Case::new(
        "huge",
        || scaled(Shape::Torus, Vec3::splat(1e7), Vec3::ZERO),
        "A torus with coordinates of 1e7, where one unit in the last place is 1.",
    ),
    Case::new("tiny", || scaled(Shape::Torus, Vec3::splat(1e-7), Vec3::ZERO), "A torus with coordinates of 1e-7."),
    Case::new(
        "far-away",
        || scaled(Shape::Torus, Vec3::ONE, vec3(4000.0, -7000.0, 2500.0)),
        "A torus with a radius of one unit, eight thousand units from the origin. The last bits of its coordinates \
         are a thousandth of its size, so that what differs as published can be seen.",
    ),
    Case::new(
        "denormals",
        meshes::denormals,
        "A saddle with coordinates below the least normal number of f32. Some devices take them for zero, and \
         others don't, so they become 0 when a mesh is made, and are counted.",
    ),
    Case {
        weld: 1e-5,
        probe: Probe::Weld,
        ..Case::new(
            "near-seam",
            meshes::near_seam,
            "A torus cut in two, with one half moved by a millionth of its size. Welded exactly it stays open. Within \
             a tolerance (here `--weld 1e-5`) it closes, to the last bit.",
        )
    },
    Case::new(
        "t-junction",
        meshes::t_junction,
        "A large quad beside four small ones, which lie beside eight smaller ones. Three points lie on the large \
         quad's edge, and four lie beside the next edges, where the surface curves away. No tessellation closes \
         that, since an edge is cut without knowing of these points. They are found, listed and highlighted \
         instead.",
    )
    .probing(Probe::TJunctions(meshes::T_JUNCTIONS))
    .seen(CaseView { azimuth: 40.0, elevation: 50.0, ..DEFAULT_VIEW }),
    Case::new(
        "folds",
        meshes::star,
        "A star whose corners' normals lie nearly in its plane, as normals that are averaged or baked at tight \
         corners do. There the control nets turn over (the white paper's negative curvature). Triangles that face \
         away from the side that their patch faces are counted and highlighted. They are part of the surface, not \
         cracks; only other normals help.",
    )
    .probing(Probe::Folds)
    .seen(CaseView { azimuth: -90.0, elevation: 20.0, distance: 0.3, target: [-0.3, 0.0, 0.3], factor: 14.0 }),
    Case::new(
        "inflection",
        meshes::inflection,
        "A level sheet whose normals all lean one way, some a little more than others. PN and Phong tessellation \
         make a gentle swell of it. Nagata's edges are the flattest parabolas that are perpendicular to both \
         normals. Where both ends rise, no flat parabola is: between planes that are nearly parallel, the parabolas \
         reach many edge lengths away, and the sheet folds. The guard at 0.1 degrees straightens only edges that \
         are worse than these.",
    )
    .probing(Probe::Folds)
    .seen(CaseView { azimuth: 20.0, elevation: 50.0, ..DEFAULT_VIEW }),
    Case::new(
        "dart",
        meshes::dart,
        "A crease that ends within a sheet: along its last edge the sides' normals differ at one end only. Surfaces \
         that follow each side's own normals tear up to that end. Under PN crease, an edge starts along the line \
         that both tangent planes share where there are two of them, and as under PN where there is one.",
    )
    .seen(CaseView { azimuth: 60.0, elevation: 35.0, ..DEFAULT_VIEW }),
    Case::new(
        "height-seams",
        meshes::height_seams,
        "A torus displaced by waves. Every other quarter of it reads another part of the height image, so that the \
         heights on both sides of a seam have nothing in common. A dominant side decides for an edge, and a \
         dominant corner for a point: all sides move by the same height, to the last bit.",
    )
    .seen(CaseView { elevation: 50.0, factor: 12.0, ..DEFAULT_VIEW }),
    Case::new(
        "height-splits",
        || meshes::displaced(Shape::CubeSplit.build()),
        "A cube displaced by waves, whose faces have their own normals and texture coordinates. With dominance \
         alone, as published, each face moves along its own normals, and the cube bursts. If each point moves along \
         one direction, it stays closed.",
    )
    .seen(CaseView { factor: 12.0, ..DEFAULT_VIEW }),
    Case::new(
        "moving",
        meshes::moving,
        "A cylinder that two joints and a morph target bend and swell, in as many poses as there are trials. Each \
         point is deformed once for all triangles that meet there, and the edges' control points are made \
         afterwards. So what agrees at rest agrees in every pose.",
    ),
    Case::new(
        "sweep",
        meshes::roof,
        "The factor grows from 1 to 64 in steps of 1/64. Under fractional partitioning every surface point moves a \
         little at each step. Under the others new points appear in the middle of edges, and the surface pops.",
    )
    .probing(Probe::Sweep),
    Case::new(
        "eye-inside",
        || Shape::Icosahedron.build(),
        "The eye is inside a sphere, and some control points lie behind it. The paper's clip test finds every \
         control point outside one side of the view or another, and drops patches that fill the view; its LOD \
         divides by w, which mirrors what is behind. Testing each plane of the view by itself, and keeping depths \
         positive, avoids both faults.",
    )
    .probing(Probe::View)
    .seen(CaseView { azimuth: 30.0, elevation: 20.0, distance: 0.1, target: [-0.3, -0.35, -0.75], factor: 0.0 }),
    Case::new(
        "near-plane",
        meshes::ground,
        "Two large triangles under the eye, which reach behind it. Every edge in view crosses the near plane.",
    )
    .probing(Probe::View)
    .seen(CaseView { azimuth: 20.0, elevation: 35.0, distance: 0.12, target: [0.1, 0.0, 0.3], factor: 0.0 }),
    Case::new(
        "behind-eye",
        meshes::ground,
        "The eye is just above the end of a long edge, which runs on below and far behind it. Dividing by w mirrors \
         what is behind back onto the near end, so that the edge seems short: as published it gets a few segments, \
         of which a single one crosses the picture. Robust LOD notices that the edge touches the eye, and cuts it \
         as finely as possible.",
    )
    .probing(Probe::View)
    .seen(CaseView { azimuth: 186.0, elevation: 9.0, distance: 0.05, target: [0.7, 0.0, 0.7], factor: 0.0 }),
    Case::new(
        "soup",
        || meshes::soup(1),
        "Sixty random triangles over fourteen points: edges with many sides of either winding, triangles on top of \
         each other, and random normals, some of them zero or NaN.",
    ),
    Case::new(
        "shared-apex",
        || Shape::Cone.build(),
        "A cone: twelve normals meet at its apex, and a crease runs around its cap.",
    ),
    Case::new(
        "parts",
        meshes::parts,
        "A torus whose parts have surfaces and details of their own, so that any two surfaces meet somewhere. An edge \
         that is computed once has one surface, of those beside it the one that comes first in the list, and the finest \
         detail. As published each patch follows its own part.",
    ),
];

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::Path;

    use super::super::PAGE;
    use super::*;

    fn text(path: &str) -> String {
        let path = documents::in_repository(path);
        std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    #[test]
    fn the_documentation_has_every_case_and_no_other() {
        let page = text("docs/stability/stability.md");
        let headings: Vec<_> = page.lines().filter_map(|line| line.strip_prefix("## ")).collect();
        assert_eq!(headings, CASES.map(|case| case.name));
        for case in CASES {
            assert!(page.contains(case.about), "{}: run `pnaen stability -o docs/stability`", case.name);
        }
    }

    #[test]
    fn every_case_has_a_picture_and_every_picture_a_case() {
        // A package made by `cargo package` has the original manifest beside its own, and lacks these pictures.
        if Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml.orig").exists() {
            return;
        }
        let files = std::fs::read_dir(documents::in_repository("docs/stability")).expect("a folder");
        let files = files.map(|entry| entry.expect("an entry").file_name());
        let pictures: BTreeSet<_> = CASES.iter().map(|case| format!("{}.png", case.name).into()).collect();
        assert_eq!(files.filter(|name| *name != PAGE).collect::<BTreeSet<_>>(), pictures);
    }
}
