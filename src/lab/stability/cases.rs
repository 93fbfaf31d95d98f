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
    /// The case, ready to run.
    pub fn subject(&self) -> Subject {
        let Self { name, about, mesh, weld, probe, view } = *self;
        Subject { name: name.to_owned(), about: about.to_owned(), mesh: mesh(), weld, probe, view }
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

const CASE: Case =
    Case { name: "", about: "", mesh: Mesh::default, weld: 0.0, probe: Probe::Edges, view: DEFAULT_VIEW };

/// Every case, in the order of the documentation.
pub const CASES: [Case; 34] = [
    Case {
        name: "split-normals",
        about: "A cube whose faces have their own normals. Under PN each face follows its own normals, so that all \
                twelve edges tear. PN-AEN takes the mean of both sides' control points, which closes the edges: to \
                the last bit if each edge is computed once, and except for the last bits as published.",
        mesh: || Shape::CubeSplit.build(),
        ..CASE
    },
    Case {
        name: "smooth-torus",
        about: "A torus with smooth normals, without any defect. Yet as published about half of all edge points and \
                a quarter of all factors of edges differ in their last bits, since the two patches add the same \
                numbers in opposite orders. An edge that is computed once, in its own direction, has one result.",
        mesh: || Shape::Torus.build(),
        ..CASE
    },
    Case {
        name: "non-manifold",
        about: "Five half-planes around one edge. The white paper's index buffer has room for one neighbour across \
                an edge, so as published these patches stay as under PN, and tear. If the edge is computed once, its \
                control points are the mean over all five sides.",
        mesh: meshes::fins,
        view: CaseView { azimuth: 20.0, elevation: 35.0, ..DEFAULT_VIEW },
        ..CASE
    },
    Case {
        name: "reversed-neighbours",
        about: "An icosphere in which every third triangle is wound the other way. Each edge has a direction of its \
                own, so it makes no difference which way its sides run.",
        mesh: meshes::reversed_neighbours,
        ..CASE
    },
    Case {
        name: "moebius",
        about: "A strip with half a twist. At its join, neighbours run the shared edge in the same direction, and \
                their normals are opposite. A control point is the same for a normal and its opposite, so both sides \
                agree.",
        mesh: || Shape::Moebius.build(),
        view: CaseView { elevation: 35.0, ..DEFAULT_VIEW },
        ..CASE
    },
    Case {
        name: "duplicates",
        about: "A torus in which every other triangle appears twice and every fifth once more with reversed winding, \
                with degenerate triangles among them. Edges have up to five sides, which all share one curve. \
                Triangles without three distinct points are left out and counted.",
        mesh: meshes::duplicates,
        ..CASE
    },
    Case {
        name: "slivers",
        about: "A cube stretched to a needle, whose triangles are a million times longer than wide.",
        mesh: || scaled(Shape::CubeSplit, vec3(1.0, 1e-6, 1e-6), Vec3::ZERO),
        view: CaseView { azimuth: 60.0, distance: 1.2, ..DEFAULT_VIEW },
        ..CASE
    },
    Case {
        name: "signed-zeros",
        about: "A saddle in which every other triangle writes zero as -0. Points and corners are compared by value \
                and stored with +0, so that 0 and -0 are the same point and the same normal.",
        mesh: meshes::signed_zeros,
        ..CASE
    },
    Case {
        name: "mirrored",
        about: "Half a torus and its mirror image, as a mirrored instance makes it. The halves share the points \
                between them, where coordinates differ in the sign of zero.",
        mesh: meshes::mirrored,
        ..CASE
    },
    Case {
        name: "borders",
        about: "An open sheet. Edges with one side are plain PN, and have no neighbour that could differ.",
        mesh: || Shape::Saddle.build(),
        ..CASE
    },
    Case {
        name: "zero-normals",
        about: "A third of the corners have normals of length zero, which have no direction. They get smooth normals \
                instead (angle-weighted over faces within 60 degrees), and `info` counts them.",
        mesh: || with_normals(Shape::Icosphere, |t, k, c| if (t + k) % 3 == 0 { Vec3::ZERO } else { c.normal }),
        ..CASE
    },
    Case {
        name: "nan-normals",
        about: "Half of the corners have normals that hold NaN or infinity. They are treated as zero normals are.",
        mesh: || {
            with_normals(Shape::Icosphere, |t, k, c| match (t + k) % 4 {
                0 => Vec3::NAN,
                1 => vec3(f32::INFINITY, 0.0, c.normal.z),
                _ => c.normal,
            })
        },
        ..CASE
    },
    Case {
        name: "long-normals",
        about: "Normals with lengths from 1e-30 to 1e30. They are brought to length 1 in double precision, and \
                counted.",
        mesh: || with_normals(Shape::Icosphere, |t, k, c| c.normal * [1e-30, 0.5, 1e30, 1.0][(t + k) % 4]),
        ..CASE
    },
    Case {
        name: "opposite-normals",
        about: "Every other triangle has its normals the other way, so that the normals on both sides of its edges \
                are opposite. The control points stay, since they are the same for a normal and its opposite; the \
                shading flips, as the file says; and nothing cancels to NaN. `info` counts such edges.",
        mesh: || with_normals(Shape::Icosphere, |t, _, c| if t % 2 == 0 { c.normal } else { -c.normal }),
        ..CASE
    },
    Case {
        name: "edge-normals",
        about: "Normals that run along an edge. The tangent plane is then perpendicular to the edge, and the control \
                point falls onto the corner: it is degenerate, but finite and shared. `info` counts such corners.",
        mesh: meshes::edge_normals,
        ..CASE
    },
    Case {
        name: "inward-normals",
        about: "Normals that point against their faces. The surface stays, since control points are the same for a \
                normal and its opposite; it is shaded as the file says. `info` counts such corners.",
        mesh: || with_normals(Shape::Icosphere, |_, _, c| -c.normal),
        ..CASE
    },
    Case {
        name: "huge",
        about: "A torus with coordinates of 1e7, where one unit in the last place is 1.",
        mesh: || scaled(Shape::Torus, Vec3::splat(1e7), Vec3::ZERO),
        ..CASE
    },
    Case {
        name: "tiny",
        about: "A torus with coordinates of 1e-7.",
        mesh: || scaled(Shape::Torus, Vec3::splat(1e-7), Vec3::ZERO),
        ..CASE
    },
    Case {
        name: "far-away",
        about: "A torus with a radius of one unit, eight thousand units from the origin. The last bits of its \
                coordinates are a thousandth of its size, so that what differs as published can be seen.",
        mesh: || scaled(Shape::Torus, Vec3::ONE, vec3(4000.0, -7000.0, 2500.0)),
        ..CASE
    },
    Case {
        name: "denormals",
        about: "A saddle with coordinates below the least normal number of f32. Some devices take them for zero, and \
                others don't, so they become 0 when a mesh is made, and are counted.",
        mesh: meshes::denormals,
        ..CASE
    },
    Case {
        name: "near-seam",
        about: "A torus cut in two, with one half moved by a millionth of its size. Welded exactly it stays open. \
                Within a tolerance (here `--weld 1e-5`) it closes, to the last bit.",
        mesh: meshes::near_seam,
        weld: 1e-5,
        probe: Probe::Weld,
        ..CASE
    },
    Case {
        name: "t-junction",
        about: "A large quad beside four small ones, which lie beside eight smaller ones. Three points lie on the \
                large quad's edge, and four lie beside the next edges, where the surface curves away. No \
                tessellation closes that, since an edge is cut without knowing of these points. They are found, \
                listed and highlighted instead.",
        mesh: meshes::t_junction,
        probe: Probe::TJunctions(meshes::T_JUNCTIONS),
        view: CaseView { azimuth: 40.0, elevation: 50.0, ..DEFAULT_VIEW },
        ..CASE
    },
    Case {
        name: "folds",
        about: "A star whose corners' normals lie nearly in its plane, as normals that are averaged or baked at \
                tight corners do. There the control nets turn over (the white paper's negative curvature). Triangles \
                that face away from the side that their patch faces are counted and highlighted. They are part of \
                the surface, not cracks; only other normals help.",
        mesh: meshes::star,
        probe: Probe::Folds,
        view: CaseView { azimuth: -90.0, elevation: 20.0, distance: 0.3, target: [-0.3, 0.0, 0.3], factor: 14.0 },
        ..CASE
    },
    Case {
        name: "inflection",
        about: "A level sheet whose normals all lean one way, some a little more than others. PN and Phong \
                tessellation make a gentle swell of it. Nagata's edges are the flattest parabolas that are \
                perpendicular to both normals. Where both ends rise, no flat parabola is: between planes that are \
                nearly parallel, the parabolas reach many edge lengths away, and the sheet folds. The guard at 0.1 \
                degrees straightens only edges that are worse than these.",
        mesh: meshes::inflection,
        probe: Probe::Folds,
        view: CaseView { azimuth: 20.0, elevation: 50.0, ..DEFAULT_VIEW },
        ..CASE
    },
    Case {
        name: "dart",
        about: "A crease that ends within a sheet: along its last edge the sides' normals differ at one end only. \
                Surfaces that follow each side's own normals tear up to that end. Under PN crease, an edge starts \
                along the line that both tangent planes share where there are two of them, and as under PN where \
                there is one.",
        mesh: meshes::dart,
        view: CaseView { azimuth: 60.0, elevation: 35.0, ..DEFAULT_VIEW },
        ..CASE
    },
    Case {
        name: "height-seams",
        about: "A torus displaced by waves. Every other quarter of it reads another part of the height image, so \
                that the heights on both sides of a seam have nothing in common. A dominant side decides for an \
                edge, and a dominant corner for a point: all sides move by the same height, to the last bit.",
        mesh: meshes::height_seams,
        view: CaseView { elevation: 50.0, factor: 12.0, ..DEFAULT_VIEW },
        ..CASE
    },
    Case {
        name: "height-splits",
        about: "A cube displaced by waves, whose faces have their own normals and texture coordinates. With \
                dominance alone, as published, each face moves along its own normals, and the cube bursts. If each \
                point moves along one direction, it stays closed.",
        mesh: || meshes::displaced(Shape::CubeSplit.build()),
        view: CaseView { factor: 12.0, ..DEFAULT_VIEW },
        ..CASE
    },
    Case {
        name: "moving",
        about: "A cylinder that two joints and a morph target bend and swell, in as many poses as there are trials. \
                Each point is deformed once for all triangles that meet there, and the edges' control points are \
                made afterwards. So what agrees at rest agrees in every pose.",
        mesh: meshes::moving,
        ..CASE
    },
    Case {
        name: "sweep",
        about: "The factor grows from 1 to 64 in steps of 1/64. Under fractional partitioning every surface point \
                moves a little at each step. Under the others new points appear in the middle of edges, and the \
                surface pops.",
        mesh: meshes::roof,
        probe: Probe::Sweep,
        ..CASE
    },
    Case {
        name: "eye-inside",
        about: "The eye is inside a sphere, and some control points lie behind it. The paper's clip test finds every \
                control point outside one side of the view or another, and drops patches that fill the view; its LOD \
                divides by w, which mirrors what is behind. Testing each plane of the view by itself, and keeping \
                depths positive, avoids both faults.",
        mesh: || Shape::Icosahedron.build(),
        probe: Probe::View,
        view: CaseView { azimuth: 30.0, elevation: 20.0, distance: 0.1, target: [-0.3, -0.35, -0.75], factor: 0.0 },
        ..CASE
    },
    Case {
        name: "near-plane",
        about: "Two large triangles under the eye, which reach behind it. Every edge in view crosses the near plane.",
        mesh: meshes::ground,
        probe: Probe::View,
        view: CaseView { azimuth: 20.0, elevation: 35.0, distance: 0.12, target: [0.1, 0.0, 0.3], factor: 0.0 },
        ..CASE
    },
    Case {
        name: "behind-eye",
        about: "The eye is just above the end of a long edge, which runs on below and far behind it. Dividing by w \
                mirrors what is behind back onto the near end, so that the edge seems short: as published it gets a \
                few segments, of which a single one crosses the picture. Robust LOD notices that the edge touches \
                the eye, and cuts it as finely as possible.",
        mesh: meshes::ground,
        probe: Probe::View,
        view: CaseView { azimuth: 186.0, elevation: 9.0, distance: 0.05, target: [0.7, 0.0, 0.7], factor: 0.0 },
        ..CASE
    },
    Case {
        name: "soup",
        about: "Sixty random triangles over fourteen points: edges with many sides of either winding, triangles on \
                top of each other, and random normals, some of them zero or NaN.",
        mesh: || meshes::soup(1),
        ..CASE
    },
    Case {
        name: "shared-apex",
        about: "A cone: twelve normals meet at its apex, and a crease runs around its cap.",
        mesh: || Shape::Cone.build(),
        ..CASE
    },
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
