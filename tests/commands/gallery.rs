//! `pnaen gallery`: its page, its pictures and its errors.

use crate::{Folder, failure, output, sentence};

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
