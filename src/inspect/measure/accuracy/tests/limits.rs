//! How far surfaces of a subdivision cage are from its limit, by level of the cage: tables of `docs/results/subdivision.md`.

use std::path::Path;

use super::*;
use documents::cages::cube;
use geometry::choice::Choice;
use geometry::numbers::short;
use load::import::{MOST_LEVELS, Subdivide};
use load::markdown;
use load::selection::Selection;
use load::{Import, Limits, Source};

/// The levels of the cage that are compared.
const LEVELS: usize = 4;

/// The tessellation factor of curved surfaces.
const FACTOR: f32 = 8.0;

/// Distances of which more than this part may be missing from the reference are only bounded.
const CERTAIN: f64 = 0.1;

/// The edges of the cube's front, infinitely sharp.
const SHARP_FRONT: &str = "t crease 5/1/0 4 5 6 7 4 10\n";

/// A cage as an OBJ file, and what it is called.
struct Cage {
    title: &'static str,
    obj: String,
    scheme: Subdivide,
}

/// The triangles of a shape as a cage.
fn triangles(mesh: &Mesh) -> String {
    let place = mesh.corners.iter().map(|corner| {
        let [x, y, z] = corner.position.to_array();
        format!("v {x} {y} {z}\n")
    });
    let face = mesh.triangles.iter().map(|triangle| {
        let [a, b, c] = triangle.map(|corner| corner + 1);
        format!("f {a} {b} {c}\n")
    });
    place.chain(face).collect()
}

fn cages() -> [Cage; 3] {
    let smooth = "A cube under Catmull-Clark";
    let creased = "The same cube with infinitely sharp edges around one face";
    let icosahedron = triangles(&Shape::Icosahedron.build());
    [
        Cage { title: smooth, obj: cube(), scheme: Subdivide::CatmullClark },
        Cage { title: "An icosahedron under Loop", obj: icosahedron, scheme: Subdivide::Loop },
        Cage { title: creased, obj: cube() + SHARP_FRONT, scheme: Subdivide::CatmullClark },
    ]
}

/// The cage of a file, refined so often. Its points and normals are those of the limit.
fn refined(file: &Path, subdivide: Subdivide, levels: u8) -> Mesh {
    let import = Import { subdivide, levels: Some(levels.into()), ..Import::default() };
    let selected = Selection { import, ..Selection::default() };
    let source = Source::File(file.to_owned());
    let loaded = source.load_selected(selected, &Limits::default(), &PROGRESS).expect("a mesh");
    assert!(loaded.is_refined && loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    loaded.mesh
}

/// What was measured of a surface at one level: the largest distance in percent of the limit's diagonal, and the largest angle in
/// degrees.
#[derive(Clone, Copy)]
struct Cell {
    distance: Interval,
    degrees: f64,
}

impl Cell {
    fn new(limit: &ReferenceShape, out: &Tessellated) -> Self {
        let narrow = Narrow { absolute: 1e-8, ..Narrow::default() };
        let accuracy = measured_with(limit, out, AccuracyOptions { narrow, ..options(2000) });
        let Interval { at_least, at_most } = accuracy.relative(accuracy.both_ways()).largest;
        let distance = Interval { at_least: 100.0 * at_least, at_most: 100.0 * at_most };
        // The interval contains the distance for certain, and is as narrow as was asked for.
        assert!(at_least > 0.0 && at_most <= 1.01 * at_least + 2e-8, "{distance:?}");
        Self { distance, degrees: accuracy.normals.largest }
    }
}

/// What was measured of a cage.
struct Compared {
    triangles: [usize; LEVELS],
    rows: Vec<(Surface, [Cell; LEVELS])>,
    has_creases: bool,
    /// How far the limit is from its reference, in percent: about a third of what the last refinement moved it, see
    /// [`ReferenceShape::step`].
    missing: f64,
}

impl Compared {
    fn new(cage: &Cage) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("cage.obj");
        std::fs::write(&file, &cage.obj).expect("a writable folder");
        let level = |levels| refined(&file, cage.scheme, levels);
        let limit = ReferenceShape::from_mesh(&level(MOST_LEVELS)).expect("triangles");
        let meshes: [Mesh; LEVELS] = std::array::from_fn(|levels| level(levels as u8));
        let row = |surface: Surface| {
            let factor = if surface.is_flat() { 1.0 } else { FACTOR };
            (surface, std::array::from_fn(|levels| Cell::new(&limit, &emitted(&meshes[levels], surface, factor))))
        };
        let has_creases = Topology::new(&meshes[0]).edge_counts().split > 0;
        let same = |a, b| {
            let [a, b] = [a, b].map(|surface| emitted(&meshes[0], surface, FACTOR).vertices);
            a.iter().zip(&b).all(|(a, b)| Vec3::from(a.position).distance(b.position.into()) < 1e-6)
        };
        let pairs =
            [(Surface::Pn, Surface::PnAen), (Surface::Phong, Surface::PhongAen), (Surface::Nagata, Surface::NagataAen)];
        assert!(pairs.into_iter().all(|(own, averaged)| same(own, averaged) != has_creases));
        // Where all sides of an edge have the same normals, nothing is there to be averaged.
        let is_shown = |surface: &Surface| has_creases || surface.is_flat() || surface.is_averaged();
        Self {
            triangles: std::array::from_fn(|levels| meshes[levels].triangles.len()),
            rows: Surface::ALL.into_iter().filter(is_shown).map(row).collect(),
            has_creases,
            missing: Cell::new(&limit, &as_it_is(&level(MOST_LEVELS - 1))).distance.at_most / 3.0,
        }
    }

    fn row(&self, surface: Surface) -> [Cell; LEVELS] {
        self.rows.iter().find(|row| row.0 == surface).expect("a row").1
    }

    fn cell(&self, Cell { distance, .. }: Cell) -> String {
        let most = distance.at_most;
        if self.missing > CERTAIN * most { short(most + self.missing) + " or less" } else { short(most) }
    }

    fn table(&self) -> String {
        let line = |name: String, cells: [String; LEVELS]| [vec![name], cells.to_vec()].concat();
        let distances = |(surface, cells): &(Surface, [Cell; LEVELS])| {
            line(format!("`{}`", surface.name()), cells.map(|cell| self.cell(cell)))
        };
        // Near a crease, the nearest point may be one beyond it.
        let normals = self.row(Surface::PnAen).map(|cell| short(cell.degrees));
        let normals = (!self.has_creases).then(|| line("normals of `pn-aen`, degrees".to_owned(), normals));
        let triangles = line("triangles of the cage".to_owned(), self.triangles.map(|count| count.to_string()));
        let rows: Vec<_> = self.rows.iter().map(distances).chain(normals).chain([triangles]).collect();
        markdown::table(&["", "level 0", "level 1", "level 2", "level 3"], &[0], &rows)
    }

    /// Checks what the page says of each surface.
    fn check(&self) {
        let distances = |surface| self.row(surface).map(|cell| cell.distance.at_most);
        let [flat, phong, averaged, nagata] =
            [Surface::Flat, Surface::PhongAen, Surface::PnAen, Surface::NagataAen].map(distances);
        let falls = |distances: [f64; LEVELS]| distances.array_windows().map(|[a, b]| a / b).collect::<Vec<f64>>();
        let fall = |distances: [f64; LEVELS], least: f64, most: f64| {
            let all = falls(distances);
            assert!(all.iter().all(|fall| (least..most).contains(fall)), "{all:?}");
        };
        fall(flat, 2.9, 4.5);
        assert!((0..LEVELS).all(|level| averaged[level] < 0.6 * flat[level]), "{averaged:?} of {flat:?}");
        // To second order, Phong tessellation rises 2 alpha times as high as the surface does: half of the height too far.
        assert!((0.4..0.6).contains(&(phong[3] / flat[3])), "{phong:?} of {flat:?}");
        let cubic = if self.has_creases { distances(Surface::PnCrease) } else { averaged };
        fall(cubic, 5.0, 12.0);
        assert!((2..LEVELS).all(|level| cubic[level] < 0.1 * flat[level]), "{cubic:?} of {flat:?}");
        if self.has_creases {
            fall(averaged, 3.0, 5.0);
            assert!((1..LEVELS).all(|level| cubic[level] < 0.5 * averaged[level]), "{cubic:?} of {averaged:?}");
        } else {
            assert!(falls(averaged)[..2].iter().all(|fall| *fall > 9.0), "{averaged:?}");
            assert!((0..3).all(|level| nagata[level] + self.missing < averaged[level]), "{nagata:?} of {averaged:?}");
        }
    }
}

#[test]
fn the_page_says_how_far_surfaces_of_a_cage_are_from_its_limit() {
    let mut page = String::new();
    for cage in cages() {
        let compared = Compared::new(&cage);
        compared.check();
        let (title, table, missing) = (cage.title, compared.table(), short(compared.missing));
        page += &format!("### {title}\n\n{table}\nAbout {missing} % is missing from the reference.\n\n");
    }
    documents::assert_part_of_page("docs/results/subdivision.md", "distances to the limit", &page);
}
