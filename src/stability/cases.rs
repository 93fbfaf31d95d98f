//! The cases: what each is, why it breaks tessellators, and what is looked at.

use super::{Subject, meshes};
use crate::mesh::{Mesh, Shape};

/// A mesh that breaks tessellators, and what is measured on it.
#[derive(Clone, Copy)]
pub(crate) struct Case {
    pub name: &'static str,
    /// What it is, and what becomes of it: a paragraph.
    pub about: &'static str,
    pub mesh: fn() -> Mesh,
    /// Within which part of the diagonal points are welded.
    pub weld: f32,
    pub probe: Probe,
    /// How its picture is taken.
    pub look: Look,
}

impl Case {
    /// The case, ready to run.
    pub(crate) fn subject(&self) -> Subject {
        let Self { name, about, mesh, weld, probe, look } = *self;
        Subject { name: name.to_owned(), about: about.to_owned(), mesh: mesh(), weld, probe, look }
    }
}

/// What is measured besides the agreement of edges, which is measured on every case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Probe {
    /// Nothing more.
    Edges,
    /// Triangles that the control nets turn over.
    Folds,
    /// How far the surface jumps as the factor grows.
    Sweep,
    /// How long segments get, and what clipping takes away, where [`Look`] looks from.
    View,
    /// Whether as many T-junctions are found as there are.
    TJunctions(u32),
    /// Open edges that the exact weld leaves, and that the case's tolerance leaves.
    Weld,
}

/// Where the picture of a case is taken from, and with what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Look {
    /// Degrees.
    pub azimuth: f32,
    pub elevation: f32,
    /// In bounding radii from the target; 0 for as far as shows all.
    pub distance: f32,
    /// The target, in bounding radii from the middle.
    pub target: [f32; 3],
    /// The tessellation factor of the picture.
    pub factor: f32,
}

/// From the front, the right and above, as the window does.
pub(crate) const LOOK: Look = Look { azimuth: 30.0, elevation: 20.0, distance: 0.0, target: [0.0; 3], factor: 5.0 };

const CASE: Case = Case { name: "", about: "", mesh: Mesh::default, weld: 0.0, probe: Probe::Edges, look: LOOK };

/// Every case, in the order of the documentation.
pub(crate) const CASES: [Case; 34] = [
    Case {
        name: "split-normals",
        about: "A cube whose faces have normals of their own. Under PN each face follows its own normals, and all twelve \
                edges tear. PN-AEN takes the mean of both sides' control points, and they close; as published up to \
                the last bits, by edge to the bit.",
        mesh: || Shape::CubeSplit.build(),
        ..CASE
    },
    Case {
        name: "smooth-torus",
        about: "A torus with smooth normals: nothing is wrong with it. Yet as published about half of all edge points \
                and a quarter of all edge LODs differ in their last bits, since the two patches add the same numbers \
                up in opposite orders. An edge that is computed once, in its own direction, has one answer.",
        mesh: || Shape::Torus.build(),
        ..CASE
    },
    Case {
        name: "non-manifold",
        about: "Five half-planes around one edge. The paper's index buffer has room for one neighbour across an edge, so \
                as published these are left as PN leaves them, torn. By edge, the control points are the mean over all \
                five sides.",
        mesh: meshes::fins,
        look: Look { azimuth: 20.0, elevation: 35.0, ..LOOK },
        ..CASE
    },
    Case {
        name: "reversed-neighbours",
        about: "An icosphere of whose triangles every third is wound the other way. The edge has its own direction, \
                so it makes no difference which way its sides run.",
        mesh: meshes::reversed_neighbours,
        ..CASE
    },
    Case {
        name: "moebius",
        about: "A strip with half a twist: at its join, neighbours run the shared edge in the same direction, and \
                normals flip. Control points are even in the normal, so opposite normals agree on them.",
        mesh: || Shape::Moebius.build(),
        look: Look { elevation: 35.0, ..LOOK },
        ..CASE
    },
    Case {
        name: "duplicates",
        about: "A torus with every other triangle twice, some once more the other way round, and triangles of two \
                corners among them. Edges get up to five sides, which all share one curve; triangles without three \
                distinct points are left out and counted.",
        mesh: meshes::duplicates,
        ..CASE
    },
    Case {
        name: "slivers",
        about: "A cube drawn out to a needle, with triangles a million times longer than wide.",
        mesh: meshes::slivers,
        look: Look { azimuth: 60.0, distance: 1.2, ..LOOK },
        ..CASE
    },
    Case {
        name: "signed-zeros",
        about: "A saddle in which every other triangle writes zero as -0. The two are one place and one normal: points \
                and corners are compared by value, and stored with +0.",
        mesh: meshes::signed_zeros,
        ..CASE
    },
    Case {
        name: "mirrored",
        about: "Half a torus and its mirror image, as a mirrored instance makes it: the halves share the points \
                between them, where coordinates differ in the sign of zero.",
        mesh: meshes::mirrored,
        ..CASE
    },
    Case {
        name: "borders",
        about: "An open sheet: edges of one side are plain PN, and no neighbour can differ from them.",
        mesh: || Shape::Saddle.build(),
        ..CASE
    },
    Case {
        name: "zero-normals",
        about: "A third of the corners has a normal of length zero, which says nothing: those get smooth normals \
                (angle-weighted over faces within 60 degrees), and `info` counts them.",
        mesh: meshes::zero_normals,
        ..CASE
    },
    Case {
        name: "nan-normals",
        about: "Half of the corners has a normal that holds NaN or infinity: treated as zero normals are.",
        mesh: meshes::nan_normals,
        ..CASE
    },
    Case {
        name: "long-normals",
        about: "Normals of lengths from 1e-30 to 1e30 are brought to length 1 in double precision, and counted.",
        mesh: meshes::long_normals,
        ..CASE
    },
    Case {
        name: "opposite-normals",
        about: "Every other triangle has its normals the other way, so that normals oppose each other across its edges. \
                Control points are even in the normal and stay; shading flips, as the file asks; nothing cancels to \
                NaN. `info` counts such edges.",
        mesh: meshes::opposite_normals,
        ..CASE
    },
    Case {
        name: "edge-normals",
        about: "Normals that run along an edge. The tangent plane is then perpendicular to the edge, and the control \
                point falls onto the corner: degenerate, but finite and shared. `info` counts such corners.",
        mesh: meshes::edge_normals,
        ..CASE
    },
    Case {
        name: "inward-normals",
        about: "Normals that point against their faces. The surface is the same, since control points are even in the \
                normal; it is shaded as the file asks. `info` counts such corners.",
        mesh: meshes::inward_normals,
        ..CASE
    },
    Case {
        name: "huge",
        about: "A torus with coordinates of 1e7, where one unit in the last place is a whole unit.",
        mesh: meshes::huge,
        ..CASE
    },
    Case { name: "tiny", about: "A torus with coordinates of 1e-7.", mesh: meshes::tiny, ..CASE },
    Case {
        name: "far-away",
        about: "A torus of one unit's radius, eight thousand units from the origin: its last bits are a thousandth of \
                it, so what differs as published is seen.",
        mesh: meshes::far_away,
        ..CASE
    },
    Case {
        name: "denormals",
        about: "A saddle with coordinates below the least normal number of f32. A device may take them for zero, and \
                another may not: they become 0 when a mesh is made, and are counted.",
        mesh: meshes::denormals,
        ..CASE
    },
    Case {
        name: "near-seam",
        about: "A torus cut in two, one half moved by a millionth of its size. Welded exactly it stays open; within a \
                tolerance (`--weld 1e-5`, here) it closes, and to the bit.",
        mesh: meshes::near_seam,
        weld: 1e-5,
        probe: Probe::Weld,
        ..CASE
    },
    Case {
        name: "t-junction",
        about: "A large quad beside four small ones, which lie beside eight smaller ones: three points lie on the first \
                edge, and four where the surface curves away beside the next ones. No tessellation closes that, as an \
                edge is cut without knowing of the points. They are found, listed and highlighted instead.",
        mesh: meshes::t_junction,
        probe: Probe::TJunctions(meshes::T_JUNCTIONS),
        look: Look { azimuth: 40.0, elevation: 50.0, ..LOOK },
        ..CASE
    },
    Case {
        name: "folds",
        about: "A star whose corners' normals lie nearly in its plane, as normals averaged or baked at tight corners do. \
                There the control nets turn over (the white paper's negative curvature): triangles that face away from \
                the side their patch faces are counted and highlighted. That is the surface, not a crack; only other \
                normals help.",
        mesh: meshes::star,
        probe: Probe::Folds,
        look: Look { azimuth: -90.0, elevation: 20.0, distance: 0.3, target: [-0.3, 0.0, 0.3], factor: 14.0 },
        ..CASE
    },
    Case {
        name: "inflection",
        about: "A level sheet whose normals all lean one way, some a little more than others. PN and Phong tessellation make a \
                gentle swell of it. Nagata's edges are the flattest parabolas that keep both normals, which no flat parabola \
                does where both ends rise: between planes that are nearly parallel they reach many edge lengths away, and the \
                sheet folds. The guard at 0.1 degrees leaves only what is worse than this straight.",
        mesh: meshes::inflection,
        probe: Probe::Folds,
        look: Look { azimuth: 20.0, elevation: 50.0, ..LOOK },
        ..CASE
    },
    Case {
        name: "dart",
        about: "A crease that ends within a sheet: along its last edge the sides' normals differ at one end only. Surfaces that \
                go by each side's own normals tear up to that end. PN crease starts along the line that both tangent planes \
                share where there are two of them, and as PN does where there is one.",
        mesh: meshes::dart,
        look: Look { azimuth: 60.0, elevation: 35.0, ..LOOK },
        ..CASE
    },
    Case {
        name: "height-seams",
        about: "A torus displaced by waves, every other quarter of which has its texture elsewhere, so that heights on both \
                sides of a seam have nothing in common. A dominant side speaks for an edge, and a dominant corner for a \
                point: all sides move by the same height, to the bit.",
        mesh: meshes::height_seams,
        look: Look { elevation: 50.0, factor: 12.0, ..LOOK },
        ..CASE
    },
    Case {
        name: "height-splits",
        about: "A cube displaced by waves, whose faces have normals and textures of their own. With dominance alone, as \
                published, each face moves along its own normals, and the cube bursts; moved along one direction a point, it \
                holds.",
        mesh: meshes::height_splits,
        look: Look { factor: 12.0, ..LOOK },
        ..CASE
    },
    Case {
        name: "moving",
        about: "A cylinder that bends and swells, at as many times as there are trials, by two joints and a morph target. A \
                point is deformed once, whatever meets there, and then its edges' control points are made: what agrees at rest \
                agrees in every pose.",
        mesh: meshes::moving,
        ..CASE
    },
    Case {
        name: "sweep",
        about: "The factor grows from 1 to 64 in steps of 1/64. Under fractional partitioning every surface point moves \
                a little; under the others new points appear in the middle of edges, and the surface pops.",
        mesh: meshes::roof,
        probe: Probe::Sweep,
        ..CASE
    },
    Case {
        name: "eye-inside",
        about: "The eye is inside a sphere. Some control points lie behind it: the paper's clip test finds every control \
                point outside on some side, and drops patches that fill the view; its LOD divides by w and mirrors \
                what is behind. Each plane of the view on its own, and depths that stay positive, have neither fault.",
        mesh: || Shape::Icosahedron.build(),
        probe: Probe::View,
        look: Look { azimuth: 30.0, elevation: 20.0, distance: 0.1, target: [-0.3, -0.35, -0.75], factor: 0.0 },
        ..CASE
    },
    Case {
        name: "near-plane",
        about: "Two large triangles under the eye, which reach behind it: every edge in view crosses the near plane.",
        mesh: meshes::ground,
        probe: Probe::View,
        look: Look { azimuth: 20.0, elevation: 35.0, distance: 0.12, target: [0.1, 0.0, 0.3], factor: 0.0 },
        ..CASE
    },
    Case {
        name: "behind-eye",
        about: "The eye stands just above the end of a long edge, which runs on beneath and far behind it. Dividing by w \
                mirrors what is behind back onto the near end, so that the edge seems short: as published it gets a few \
                segments, of which a single one crosses the picture. The robust form sees an edge that touches the \
                eye, and cuts it as finely as it can.",
        mesh: meshes::ground,
        probe: Probe::View,
        look: Look { azimuth: 186.0, elevation: 9.0, distance: 0.05, target: [0.7, 0.0, 0.7], factor: 0.0 },
        ..CASE
    },
    Case {
        name: "soup",
        about: "Sixty random triangles over fourteen points: edges with many sides wound either way, triangles on top of \
                each other, random normals, zero and NaN among them.",
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
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
        std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    #[test]
    fn the_documentation_has_every_case_and_no_other() {
        let page = text("docs/stability/stability.md");
        let headings: Vec<_> = page.lines().filter_map(|line| line.strip_prefix("## ")).collect();
        assert_eq!(headings, CASES.map(|case| case.name));
        for case in CASES {
            assert!(page.contains(case.about), "`pnaen stability -o docs/stability` after a change of {}", case.name);
        }
        let manual = text("docs/manual/measuring.md");
        let linked = |case: &Case| manual.contains(&format!("| [{0}](../stability/stability.md#{0}) |", case.name));
        assert_eq!(CASES.iter().find(|case| !linked(case)).map(|case| case.name), None, "not in the manual's table");
    }

    #[test]
    fn every_case_has_a_picture_and_every_picture_a_case() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        // A package made by cargo keeps the original manifest, and has no room for these pictures.
        if root.join("Cargo.toml.orig").exists() {
            return;
        }
        let files = std::fs::read_dir(root.join("docs/stability")).expect("a folder");
        let files = files.map(|entry| entry.expect("an entry").file_name());
        let pictures: BTreeSet<_> = CASES.iter().map(|case| format!("{}.png", case.name).into()).collect();
        assert_eq!(files.filter(|name| *name != PAGE).collect::<BTreeSet<_>>(), pictures);
    }
}
