//! `pnaen gallery`: its page, its pictures and its errors.

use documents::cages::{CUBE, QUADS, cube};
use image::GenericImageView;

use crate::{Folder, both, failure, output, sentence};

#[test]
fn the_gallery_has_a_page_and_a_picture_of_every_exhibit() {
    let folder = Folder::new();
    let into = folder.path("made/here");
    output(&["gallery", "shape:cube-split", "-o", &into, "--factor", "3"]);
    let page = std::fs::read_to_string(folder.path("made/here/gallery.md")).expect("a page");
    for name in ["surfaces", "creases", "normals", "patterns", "displacement"] {
        assert!(page.contains(&format!("]({name}.png)")), "{name}");
        image::open(folder.path(&format!("made/here/{name}.png"))).expect("a picture");
    }
    assert!(!page.contains("limits.png"), "a shape made in code is no cage");
    // The table has gaps for the techniques that tear, and zeros for the others.
    let row =
        |name: &str| page.lines().find(|line| line.starts_with(&format!("| `{name}` |"))).expect("a row").to_owned();
    // The cells: name, factor, triangles, error, points, gaps in px and units, normals, folds, ms twice.
    let cells = |name: &str| row(name).split('|').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
    assert!(page.contains("- `pn`: PN triangles (Vlachos et al. 2001)"));
    assert_eq!(cells("pn")[2..4], ["3", "156"], "12 patches of 13 triangles");
    for whole in ["flat", "pn-aen", "pn-crease", "phong-aen", "nagata-aen", "on", "pn --crease-band 0.02"] {
        assert_eq!(cells(whole)[5..8], ["0"; 3], "{whole}");
    }
    for torn in ["pn", "phong", "nagata", "as-published", "per-patch"] {
        assert!(cells(torn)[5..8].iter().all(|cell| cell != "0"), "{torn}");
    }
    assert_eq!(cells("on")[4], "-", "displacement has no error, since it has no surface to compare with");
    assert_ne!(cells("surface")[8], "0", "surface normals differ across edges");
}

#[test]
fn a_cage_is_shown_beside_its_limit() {
    let folder = Folder::new();
    let cage = folder.write("cage.obj", cube());
    let named = [&*cage, "--subdivide", "catmull-clark", "--levels", "0"];
    for mesh in [&[] as &[&str], &named] {
        let into = folder.path("out");
        output(&[&["gallery", "-o", &into, "--factor", "3"][..], mesh].concat());
        let page = std::fs::read_to_string(folder.path("out/gallery.md")).expect("a page");
        let triangles = |name: &str| {
            let row = page.lines().find(|line| line.starts_with(&format!("| `{name}` |"))).expect("a row");
            row.split('|').nth(3).expect("a cell").trim().to_owned()
        };
        // 6 squares are 12 patches of 13 triangles. Each refinement makes 4 of each.
        let all = ["flat --levels 0", "pn-aen --levels 0", "pn-aen --levels 1", "limit"].map(triangles);
        assert_eq!(all, ["156", "156", "624", "3,072"], "{mesh:?}");
        let picture = image::open(folder.path("out/limits.png")).expect("a picture").to_rgb8();
        // Tiles of 300 by 240 px in two rows of three, under captions of 32 px, with 4 px between them.
        let drawn = |column: u32, row: u32| {
            let tile = picture.view(4 + 304 * column, 36 + 276 * row, 300, 240);
            let background = tile.get_pixel(0, 0);
            tile.pixels().filter(|(.., px)| *px != background).count()
        };
        let [flat, refined, limit] = [drawn(0, 0), drawn(1, 1), drawn(2, 1)];
        // The limit is round, and all of a cube with corners on it is inside.
        assert!(flat > 5000 && 11 * flat < 10 * limit, "{mesh:?}: {flat} px of {limit}");
        assert!(refined.abs_diff(limit) < limit / 20, "{mesh:?}: {refined} px of {limit}");
        std::fs::remove_dir_all(&into).expect("a folder");
    }
}

#[test]
fn tiles_of_cages_that_cannot_be_refined_are_left_out() {
    let folder = Folder::new();
    let made = |mesh: &str, options: &[&str]| {
        let into = folder.path("out");
        let named = ["gallery", mesh, "-o", &into, "--factor", "2", "--subdivide", "catmull-clark"];
        let (_, errors) = both(&[&named[..], options].concat());
        (std::fs::read_to_string(folder.path("out/gallery.md")).expect("a page"), errors)
    };
    // Three faces at one edge have no limit at any level.
    let fin = folder.write("fin.obj", [CUBE, QUADS, "v 3 0 0\nf 1 2 9\n"].concat());
    let (page, errors) = made(&fin, &[]);
    assert!(page.contains("](surfaces.png)") && !page.contains("limits.png"), "{page}");
    assert!(errors.contains("\"limit\" is left out: not all of the mesh can be refined so often."), "{errors}");
    // 64 squares take more than 1 MiB when each becomes 256, but not when it becomes 4.
    let points = (0..81).map(|i| format!("v {} {} 0\n", i % 9, i / 9));
    let squares = (0..64).map(|i| i / 8 * 9 + i % 8 + 1).map(|a| format!("f {} {} {} {}\n", a, a + 1, a + 10, a + 9));
    let grid = folder.write("grid.obj", points.chain(squares).collect::<String>());
    let (page, errors) = made(&grid, &["--levels", "0", "--max-memory", "1MiB"]);
    assert!(page.contains("| `pn-aen --levels 1` |") && !page.contains("| `limit` |"), "{page}");
    assert!(errors.contains("would take") && errors.contains("\"limit\" is left out"), "{errors}");
}

#[test]
fn files_that_are_no_mesh_or_image_are_named() {
    let folder = Folder::new();
    sentence(&["gallery", "nowhere.glb", "-o", &folder.path("out")], &["nowhere.glb", "can't be read"]);
    sentence(&["gallery", "-o", &folder.path("out"), "--height", "nowhere.png"], &["nowhere.png", "height image"]);
    sentence(
        &["gallery", "shape:torus", "-o", &folder.path("out"), "--height", "material"],
        &["no image to displace by"],
    );
    let usage = failure(&["gallery", "-o", &folder.path("out"), "--camera", "30,20,9"], 2);
    assert!(usage.contains("AZIMUTH,ELEVATION"), "{usage}");
}
