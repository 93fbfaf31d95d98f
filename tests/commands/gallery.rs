//! `pnaen gallery`.

use crate::{Folder, output, sentence};

#[test]
fn a_page_and_a_picture_of_every_exhibit() {
    let folder = Folder::new("gallery");
    let into = folder.path("made/here");
    output(&["gallery", "shape:cube-split", "-o", &into, "--factor", "3"]);
    let page = std::fs::read_to_string(folder.path("made/here/gallery.md")).expect("a page");
    for name in ["surfaces", "creases", "normals", "patterns", "displacement"] {
        assert!(page.contains(&format!("]({name}.png)")), "{name}");
        image::open(folder.path(&format!("made/here/{name}.png"))).expect("a picture");
    }
    // What tears says so, and what doesn't.
    let row =
        |name: &str| page.lines().find(|line| line.starts_with(&format!("| `{name}` |"))).expect("a row").to_owned();
    let cells = |name: &str| row(name).split('|').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
    assert!(row("pn").contains("Vlachos et al. 2001") && cells("pn")[4] != "0");
    for whole in ["flat", "pn-aen", "pn-crease", "phong-aen", "nagata-aen", "on", "pn --rim 0.02"] {
        assert_eq!(cells(whole)[4], "0", "{whole}");
    }
    for torn in ["phong", "nagata", "as-published", "per-patch"] {
        assert_ne!(cells(torn)[4], "0", "{torn}");
    }
    assert_ne!(cells("surface")[6], "0", "normals of the surface have steps");
}

#[test]
fn what_is_no_mesh_or_image_is_a_sentence() {
    let folder = Folder::new("no-gallery");
    sentence(&["gallery", "nowhere.glb", "-o", &folder.path("out")], &["nowhere.glb", "can't be read"]);
    sentence(
        &["gallery", "-o", &folder.path("out"), "--height", "nowhere.png"],
        &["nowhere.png can't be read as a height image"],
    );
    sentence(
        &["gallery", "shape:torus", "-o", &folder.path("out"), "--height", "material"],
        &["no image to displace by"],
    );
}
