//! Polygons, units and axes, normals, texture coordinates, and materials.

use glam::Vec3;

use super::documents::{
    Link, document, geometry, image, layer, model, prism, smoothed_prism, square_textured_as, textured_square,
};
use super::tree::{Entry, one, text};
use super::{loaded, near, read};
use crate::fbx::{read as read_on_a_thread, read_here};
use crate::files::Limits;
use crate::loaded_mesh::LoadedMesh;
use crate::model_file::ModelFile;
use crate::read_error::ReadError;
use geometry::mesh::{Alpha, HeightAmount, Wrap};
use geometry::progress::Progress;

#[test]
fn polygons_are_cut_and_centimetres_with_z_up_become_metres_with_y_up() {
    let loaded = loaded(&smoothed_prism());
    assert_eq!((loaded.triangles.len(), loaded.warnings.len()), (2 * 4 + 6 * 2, 0), "{:?}", loaded.warnings);
    for corner in &loaded.corners {
        let [x, y, z] = corner.position.to_array();
        assert!((x.hypot(z) - 1.0).abs() < 1e-6 && (y.abs() < 1e-6 || (y - 0.5).abs() < 1e-6), "{}", corner.position);
    }
    let volume: f32 = loaded
        .triangles
        .iter()
        .map(|triangle| {
            let [a, b, c] = triangle.map(|corner| loaded.corners[corner as usize].position);
            a.dot(b.cross(c)) / 6.0
        })
        .sum();
    // The area of a hexagon of radius 1, times the height; positive if triangles are counter-clockwise from outside.
    assert!((volume - 1.5 * 3.0_f32.sqrt() * 0.5).abs() < 1e-5, "{volume}");
}

#[test]
fn smoothing_makes_normals_where_the_file_has_none() {
    let smooth = loaded(&smoothed_prism());
    let (mut sides, mut caps) = (0, 0);
    for corner in &smooth.corners {
        let radial = Vec3::new(corner.position.x, 0.0, corner.position.z);
        match corner.normal {
            normal if (normal - radial).length() < 1e-5 => sides += 1,
            normal if (normal.abs() - Vec3::Y).length() < 1e-5 => caps += 1,
            normal => panic!("{normal} at {}", corner.position),
        }
    }
    assert_eq!((sides, caps), (12, 12));
    // The same by edges: those of the hexagons are hard, and those between squares smooth. An edge is named by a corner.
    let edges: Vec<i32> = (0..6).chain((0..6).map(|i| 12 + 4 * i + 1)).collect();
    let smoothing =
        layer("LayerElementSmoothing", "ByEdge", vec![one("Smoothing", [[0; 6], [1; 6]].as_flattened().to_vec())]);
    let objects = vec![prism(vec![one("Edges", edges), smoothing]), model(20, "prism", "Mesh", &[])];
    let by_edges = loaded(&document(true, 1.0, objects, &[Link(20, 0, ""), Link(10, 20, "")]));
    assert_eq!(by_edges.corners, smooth.corners);
    // Without smoothing the angles decide: the sides of a hexagon meet at 60 degrees.
    let plain = vec![prism(Vec::new()), model(20, "prism", "Mesh", &[])];
    let plain = loaded(&document(true, 1.0, plain, &[Link(20, 0, ""), Link(10, 20, "")]));
    assert!(
        plain.warnings[0].contains("meshes without normals") && plain.warnings[0].contains(": 1."),
        "{:?}",
        plain.warnings
    );
}

#[test]
fn normals_of_every_mapping_are_read() {
    let square = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    let tilted = [0.0, 0.6, 0.8, 0.0, 0.0, 1.0];
    let four =
        |indices: [usize; 4]| indices.iter().flat_map(|&i| tilted[3 * i..3 * i + 3].to_vec()).collect::<Vec<f64>>();
    let normals = |mapping: &str, lists| {
        let entry = layer("LayerElementNormal", mapping, lists);
        let objects = vec![geometry(10, &square, &[&[0, 1, 2, 3]], vec![entry]), model(20, "square", "Mesh", &[])];
        loaded(&document(false, 100.0, objects, &[Link(20, 0, ""), Link(10, 20, "")])).mesh
    };
    let by_corner = normals("ByPolygonVertex", vec![one("Normals", four([0, 1, 1, 0]))]);
    let by_index =
        normals("ByPolygonVertex", vec![one("Normals", tilted.to_vec()), one("NormalsIndex", vec![0, 1, 1, 0])]);
    let by_vertex = normals("ByVertice", vec![one("Normals", four([0, 1, 1, 0]))]);
    for mesh in [by_corner, by_index, by_vertex] {
        for corner in &mesh.corners {
            let expected = if corner.position.x == 0.0 { Vec3::new(0.0, 0.6, 0.8) } else { Vec3::Z };
            assert!(near(corner.normal.to_array(), expected.to_array()), "{} at {}", corner.normal, corner.position);
        }
    }
    for mesh in [
        normals("ByPolygon", vec![one("Normals", tilted[..3].to_vec())]),
        normals("AllSame", vec![one("Normals", tilted[..3].to_vec())]),
    ] {
        assert!(mesh.corners.iter().all(|corner| near(corner.normal.to_array(), [0.0, 0.6, 0.8])));
    }
}

#[test]
fn pivots_geometric_transforms_and_mirrors_place_instances() {
    let square = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    let objects = vec![
        geometry(10, &square, &[&[0, 1, 2, 3]], Vec::new()),
        // A quarter turn about Z around the pivot (1, 0, 0).
        model(
            20,
            "turned",
            "Mesh",
            &[("RotationPivot", "Vector3D", &[1.0, 0.0, 0.0]), ("Lcl Rotation", "Lcl Rotation", &[0.0, 0.0, 90.0])],
        ),
        // A geometric translation moves the mesh but not what is below the node.
        model(
            21,
            "moved",
            "Mesh",
            &[
                ("GeometricTranslation", "Vector3D", &[0.0, 0.0, 5.0]),
                ("Lcl Translation", "Lcl Translation", &[10.0, 0.0, 0.0]),
            ],
        ),
        model(22, "mirrored", "Mesh", &[("Lcl Scaling", "Lcl Scaling", &[-1.0, 1.0, 1.0])]),
        model(23, "hidden", "Mesh", &[("Visibility", "Visibility", &[0.0])]),
    ];
    let links = [
        Link(20, 0, ""),
        Link(21, 0, ""),
        Link(22, 21, ""),
        Link(23, 0, ""),
        Link(10, 20, ""),
        Link(10, 21, ""),
        Link(10, 22, ""),
        Link(10, 23, ""),
    ];
    let loaded = loaded(&document(false, 100.0, objects, &links));
    assert_eq!(loaded.triangles.len(), 3 * 2);
    assert!(
        loaded
            .warnings
            .iter()
            .any(|warning| warning == "meshes that the file hides, left out (--show-hidden shows them): 1."),
        "{:?}",
        loaded.warnings
    );
    let corners = |first: usize| -> Vec<[f32; 3]> {
        let triangles = loaded.triangles[first..first + 2].as_flattened().iter();
        let mut at: Vec<_> =
            triangles.map(|&corner| loaded.corners[corner as usize].position.round().to_array()).collect();
        at.sort_by(|a, b| a.partial_cmp(b).expect("they are finite"));
        at.dedup();
        at.iter_mut().flatten().for_each(|x| *x += 0.0);
        at
    };
    assert_eq!(
        corners(0),
        [[0.0, -1.0, 0.0], [0.0, 0.0, 0.0], [1.0, -1.0, 0.0], [1.0, 0.0, 0.0]].map(|[x, y, z]: [f32; 3]| [x, y, z])
    );
    assert_eq!(corners(2), [[10.0, 0.0, 5.0], [10.0, 1.0, 5.0], [11.0, 0.0, 5.0], [11.0, 1.0, 5.0]]);
    assert_eq!(corners(4), [[9.0, 0.0, 0.0], [9.0, 1.0, 0.0], [10.0, 0.0, 0.0], [10.0, 1.0, 0.0]]);
    // All three still show their fronts to +Z.
    for triangle in loaded.triangles.iter() {
        let [a, b, c] = triangle.map(|corner| loaded.corners[corner as usize]);
        assert!((b.position - a.position).cross(c.position - a.position).z > 0.0 && a.normal.z > 0.99);
    }
}

#[test]
fn a_phong_material_with_an_embedded_image_is_read() {
    let png = image();
    let loaded = loaded(&textured_square(Ok(&png)));
    assert_eq!(loaded.warnings, [] as [String; 0]);
    let material = &loaded.materials[0];
    assert_eq!((material.name.as_str(), material.look.alpha), ("paint", Alpha::Blend));
    // The image replaces the diffuse colour, not its factor.
    assert!(near(material.base_color, [0.5, 0.5, 0.5, 0.75]), "{:?}", material.base_color);
    assert!(near(material.look.emissive, [0.2, 0.0, 0.6]), "{:?}", material.look.emissive);
    let texture = material.texture.as_ref().expect("an image");
    assert_eq!((texture.size, &texture.rgba[..]), ([1, 2], &[255, 0, 0, 255, 0, 0, 255, 255][..]));
    assert_eq!(material.sampling.wrap, [Wrap::Clamp, Wrap::Repeat]);
    let details = loaded.details.as_ref().expect("colours");
    assert!(details.iter().all(|detail| near(detail.color.to_array(), [1.0, 0.5, 0.25, 1.0])));
    for corner in &loaded.corners {
        let [x, y, _] = corner.position.to_array();
        assert_eq!(corner.normal, Vec3::Z);
        // A texture scaled by 2 is twice as large: coordinates halve; v counts from the top.
        assert!(near(corner.uv.to_array(), [x / 2.0, 1.0 - y / 3.0]), "{} at {}", corner.uv, corner.position);
    }
}

#[test]
fn a_displacement_map_is_a_height_image_in_units_of_the_file() {
    let loaded = loaded(&square_textured_as("DisplacementColor", Ok(&image()), 1.0));
    assert_eq!(loaded.warnings, [] as [String; 0]);
    let map = loaded.materials[0].height.as_ref().expect("a height image");
    assert_eq!((map.size, map.amount), ([1, 2], HeightAmount::from_factor(0.01, 0.0)));
    assert_eq!(map.wrap, [Wrap::Clamp, Wrap::Repeat]);
    let broken = text(&square_textured_as("DisplacementColor", Ok(b"no image"), 1.0));
    let broken = read(&broken).expect("a mesh");
    let start = "the height image of material \"paint\" is left out: \"wood\" can't be read as a height image: ";
    assert!(broken.materials[0].height.is_none() && broken.warnings[0].starts_with(start), "{:?}", broken.warnings);
}

#[test]
fn images_are_looked_for_beside_the_model_and_nowhere_else() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let inner = folder.path().join("inner");
    std::fs::create_dir_all(inner.join("maps")).expect("a folder");
    std::fs::write(inner.join("wood.png"), image()).expect("a file");
    std::fs::write(inner.join("maps/oak 50%25.png"), image()).expect("a file");
    std::fs::write(folder.path().join("outside.png"), image()).expect("a file");
    let read = |path: &str| {
        let bytes = text(&textured_square(Err(path)));
        let progress = Progress::new();
        let file = ModelFile { folder: &inner, ..ModelFile::from_test("test", &progress) };
        let read = read_here(bytes, &file).expect("a mesh");
        (read.materials[0].texture.is_some(), read.warnings.join("\n"), read.files.len())
    };
    for path in ["C:\\\\work\\\\wood.png", "wood.png", "/elsewhere/wood.png", "..\\\\wood.png", "maps\\\\oak 50%25.png"]
    {
        let path = path.replace("\\\\", "\\");
        assert_eq!(read(&path), (true, String::new(), 1), "{path}");
    }
    for path in ["../outside.png", "D:/outside.png", "missing.png", "maps"] {
        let (has_texture, warning, files) = read(path);
        assert!(!has_texture && files == 0, "{path}");
        assert!(warning.starts_with("the texture of material \"paint\" is left out: "), "{warning}");
    }
}

#[test]
fn images_that_do_not_fit_are_halved() {
    let read = |size: [u32; 2], memory| {
        let mut png = std::io::Cursor::new(Vec::new());
        let gray = image::GrayImage::from_pixel(size[0], size[1], image::Luma([128]));
        gray.write_to(&mut png, image::ImageFormat::Png).expect("an image in memory");
        let bytes = text(&textured_square(Ok(png.get_ref())));
        let limits = Limits { memory, ..Limits::default() };
        let progress = Progress::new();
        let file = ModelFile { limits, ..ModelFile::from_test("test", &progress) };
        let read = read_here(bytes, &file).expect("a mesh, whatever its textures are");
        (read.materials[0].texture.as_ref().map(|texture| texture.size), read.warnings.join("\n"))
    };
    assert_eq!(read([2048, 2048], 64 << 20), (Some([2048; 2]), String::new()));
    // Decoded it has 16 MiB.
    let (size, said) = read([2048, 2048], 12 << 20);
    assert_eq!(size, Some([1024; 2]), "{said}");
    let expected = "the texture of material \"paint\" is scaled down from 2048 x 2048 px to 1024 x 1024 px: ";
    assert!(said.starts_with(expected) && said.contains("--max-memory"), "{said}");
    let (size, said) = read([16384, 4], 64 << 20);
    assert_eq!(size, Some([8192, 2]), "{said}");
    assert!(said.ends_with("at most 8192 px a side are shown."), "{said}");
}

#[test]
fn what_is_not_read_is_named() {
    let attribute = |id, kind: &str| {
        super::tree::object("NodeAttribute", id, "NodeAttribute::x", kind, vec![one("TypeFlags", kind)])
    };
    let objects = vec![
        prism(Vec::new()),
        model(20, "prism", "Mesh", &[]),
        model(21, "camera", "Camera", &[]),
        model(22, "lamp", "Light", &[]),
        attribute(71, "Camera"),
        attribute(72, "Light"),
        super::tree::object("Constraint", 73, "Constraint::aim", "Aim", vec![one("Type", "Aim")]),
    ];
    let links =
        [Link(20, 0, ""), Link(21, 0, ""), Link(22, 0, ""), Link(10, 20, ""), Link(71, 21, ""), Link(72, 22, "")];
    let warnings = loaded(&document(true, 1.0, objects, &links)).warnings;
    for expected in ["cameras, which aren't read: 1.", "lights, which aren't read: 1.", "constraints, left out; "] {
        assert!(warnings.iter().any(|warning| warning.starts_with(expected)), "{expected}: {warnings:?}");
    }
}

#[test]
fn a_load_can_be_cancelled_and_runs_within_its_memory() {
    let bytes = text(&smoothed_prism());
    let progress = Progress::new();
    progress.cancel();
    let cancelled = read_on_a_thread(bytes.clone(), &ModelFile::from_test("test", &progress));
    assert!(matches!(cancelled, Err(ReadError::Cancelled(_))), "{cancelled:?}");
    let limits = Limits { memory: 0, ..Limits::default() };
    let progress = Progress::new();
    let refused = read_here(bytes, &ModelFile { limits, ..ModelFile::from_test("test", &progress) });
    let said = refused.map(|_| ()).expect_err("a parser needs more than that").to_string();
    assert!(
        said.contains(" of memory, but files of this size may take only ") && said.contains("--max-memory"),
        "{said}"
    );
}

#[test]
fn files_without_triangles_say_what_they_hold() {
    let objects = vec![prism(Vec::new()), model(20, "prism", "Mesh", &[("Visibility", "Visibility", &[0.0])])];
    let bytes = text(&document(true, 1.0, objects, &[Link(20, 0, ""), Link(10, 20, "")]));
    let said = read(&bytes).map(|_| ()).expect_err("all is hidden").to_string();
    assert!(
        said.contains("it holds 2 nodes, 1 meshes, 1 nodes with meshes that it hides (--show-hidden shows them)"),
        "{said}"
    );
}

#[test]
fn what_is_marked_as_a_subdivision_surface_is_refined_with_its_creases() {
    let marked = |more: Vec<Entry>| {
        let levels = vec![one("Smoothness", 2), one("PreviewDivisionLevels", 2)];
        let objects = vec![prism([levels, more].concat()), model(20, "prism", "Mesh", &[])];
        loaded(&document(true, 1.0, objects, &[Link(20, 0, ""), Link(10, 20, "")]))
    };
    let heights = |mesh: &LoadedMesh| {
        let heights = mesh.corners.iter().map(|corner| corner.position.y);
        heights.fold([f32::MAX, f32::MIN], |[least, most], y| [least.min(y), most.max(y)])
    };
    let smooth = marked(Vec::new());
    // Each corner of the prism's faces becomes a quadrilateral, and each of these four, of two triangles.
    assert_eq!((smooth.triangles.len(), smooth.warnings.len()), (36 * 4 * 2, 0), "{:?}", smooth.warnings);
    let [low, high] = heights(&smooth);
    assert!(low > 0.01 && high < 0.49, "{low} to {high}");
    // The edges of both hexagons, which are named by a corner.
    let creases = layer("LayerElementEdgeCrease", "ByEdge", vec![one("EdgeCrease", vec![1.0; 12])]);
    let sharp = marked(vec![one("Edges", (0..12).collect::<Vec<i32>>()), creases]);
    let [low, high] = heights(&sharp);
    assert!(low.abs() < 1e-6 && (high - 0.5).abs() < 1e-6, "{low} to {high}");
    // Shared corners of smooth points have one normal, and those of creases one for each side.
    assert!(sharp.corners.len() > smooth.corners.len());
}

#[test]
fn vertices_of_a_cage_at_one_place_stay_apart() {
    // Two squares that touch along an edge, whose ends are vertices of each.
    let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [1, 0, 0], [1, 0, 1], [1, 1, 1], [1, 1, 0]];
    let corners: Vec<f64> = corners.into_iter().flatten().map(f64::from).collect();
    let marks = vec![one("Smoothness", 2), one("PreviewDivisionLevels", 2)];
    let squares = geometry(10, &corners, &[&[0, 1, 2, 3], &[4, 5, 6, 7]], marks);
    let objects = vec![squares, model(20, "squares", "Mesh", &[])];
    let mesh = loaded(&document(true, 1.0, objects, &[Link(20, 0, ""), Link(10, 20, "")]));
    assert_eq!(mesh.triangles.len(), 2 * 16 * 2);
    let edge = mesh.corners.iter().map(|corner| corner.position.x).fold(0.0, f32::max);
    let bent = mesh.corners.iter().filter(|corner| corner.position.y > 1e-6 && corner.position.x < edge - 1e-6);
    assert_eq!(bent.count(), 0, "each square stays in its plane");
}

#[test]
fn a_cage_that_takes_too_much_memory_stays_and_says_so() {
    let marked = prism(vec![one("Smoothness", 2), one("PreviewDivisionLevels", 10)]);
    let objects = vec![marked, model(20, "prism", "Mesh", &[])];
    let bytes = document(true, 1.0, objects, &[Link(20, 0, ""), Link(10, 20, "")]);
    let (limits, progress) = (Limits { memory: 1 << 20, ..Limits::default() }, Progress::new());
    let mesh =
        read_here(text(&bytes), &ModelFile { limits, ..ModelFile::from_test("test", &progress) }).expect("the cage");
    assert_eq!(mesh.triangles.len(), 20);
    let said = mesh.why_not_refined();
    assert!(said.starts_with("A subdivision surface is shown as its control cage: "), "{said}");
}

#[test]
fn a_cage_that_the_file_shows_as_such_stays() {
    for (mode, levels, triangles) in [(1, 2, 20), (2, 2, 36 * 4 * 2), (3, 1, 36 * 2), (3, 0, 20)] {
        let marked = prism(vec![one("Smoothness", mode), one("PreviewDivisionLevels", levels)]);
        let objects = vec![marked, model(20, "prism", "Mesh", &[])];
        let mesh = loaded(&document(true, 1.0, objects, &[Link(20, 0, ""), Link(10, 20, "")]));
        assert_eq!((mesh.triangles.len(), mesh.is_refined), (triangles, triangles > 20), "{mode} {levels}");
    }
}
