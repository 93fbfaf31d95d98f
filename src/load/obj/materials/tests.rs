//! Material files and textures in a model's folder, and missing ones.

use tempfile::TempDir;

use crate::files::Limits;
use crate::{LoadedMesh, load};
use geometry::mesh::{Alpha, HeightAmount, Material, Slot, Wrap};
use geometry::progress::Progress;

/// A folder with a folder of textures in it.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("maps")).unwrap();
    folder
}

fn write(folder: &TempDir, name: &str, bytes: &[u8]) {
    std::fs::write(folder.path().join(name), bytes).unwrap();
}

/// Writes a file with this start and a triangle for each material into a folder, and reads it.
fn read(folder: &TempDir, start: &str, materials: &[&str]) -> LoadedMesh {
    let faces: String = materials.iter().map(|name| format!("usemtl {name}\nf 1/1/1 2/1/1 3/1/1\n")).collect();
    let text = format!("{start}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n{faces}");
    write(folder, "model.OBJ", text.as_bytes());
    load(&folder.path().join("model.OBJ"), &Limits::default(), &Progress::new()).unwrap()
}

fn png() -> Vec<u8> {
    let pixels = image::RgbaImage::from_raw(2, 1, vec![255, 0, 0, 255, 0, 0, 255, 128]).unwrap();
    let mut bytes = std::io::Cursor::new(Vec::new());
    pixels.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

#[test]
fn colours_and_textures_come_from_files_in_the_folder() {
    let folder = folder();
    write(
        &folder,
        "my colours.mtl",
        b"newmtl red\nKd 1 0 0\nnewmtl skin\nKd 0.5 0.5 0.5\nmap_Kd -s 1 1 maps\\100%.png\n",
    );
    write(&folder, "more.mtl", b"newmtl red\nKd 0 1 0\nnewmtl twin\nmap_Kd maps\\100%.png\n");
    write(&folder, "maps/100%.png", &png());
    let mesh = read(&folder, "mtllib my colours.mtl more.mtl", &["skin", "red", "twin", "skin", "absent"]);
    let names: Vec<_> = mesh.materials.iter().map(|m| (m.name.as_str(), m.base_color, m.triangles.len())).collect();
    let expected = [
        ("skin", [0.5, 0.5, 0.5, 1.0], 2),
        ("red", [1.0, 0.0, 0.0, 1.0], 1),
        ("twin", [1.0; 4], 1),
        ("absent", [1.0; 4], 1),
    ];
    assert_eq!(names, expected);
    let textures = [0, 2].map(|i| mesh.materials[i].texture.clone().expect("a texture"));
    assert_eq!(textures[0].size, [2, 1]);
    assert!(std::sync::Arc::ptr_eq(&textures[0], &textures[1]), "one image, read once");
    assert_eq!(mesh.warnings, ["materials that no material file describes, shown white: 1."]);
}

#[test]
fn missing_and_broken_files_cause_warnings() {
    let folder = folder();
    write(&folder, "m.mtl", b"newmtl a\nKd x\nmap_Kd ../up.png\nnewmtl b\nmap_Kd maps/b.png\nnewmtl c\nmap_Kd c.png\n");
    write(&folder, "c.png", b"no image");
    let libraries = "mtllib m.mtl\nmtllib /etc/passwd\nmtllib ../m.mtl\nmtllib gone.mtl\nmtllib maps";
    let mesh = read(&folder, libraries, &["a", "b", "c"]);
    assert!(mesh.materials.iter().all(|material| material.texture.is_none()));
    let expected = [
        ("the material file \"/etc/passwd\" is left out: there is no such file; put it ", "(and 1 more like it)"),
        ("the material file \"../m.mtl\" is left out: ", "with .."),
        ("the material file \"maps\" is left out: ", "is not a file"),
        ("the texture \"../up.png\" of material \"a\" is left out: ", "with .."),
        ("the texture \"maps/b.png\" of material \"b\" is left out: ", "b.png"),
        ("the texture \"c.png\" of material \"c\" is left out: ", "can't be decoded"),
        ("numbers in material files that can't be read, left out: 1.", ""),
    ];
    assert_eq!(mesh.warnings.len(), expected.len(), "{:?}", mesh.warnings);
    for (warning, (start, word)) in mesh.warnings.iter().zip(expected) {
        assert!(warning.starts_with(start) && warning.contains(word), "{warning}");
    }
}

/// A square that lies in its texture coordinates, with a material.
const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nusemtl m\n\
                      f 1/1/1 2/2/1 3/3/1 4/4/1\n";

fn square(folder: &TempDir, materials: &str) -> LoadedMesh {
    write(folder, "m.mtl", format!("newmtl m\n{materials}").as_bytes());
    write(folder, "w.png", &png());
    write(folder, "square.obj", format!("mtllib m.mtl\n{SQUARE}").as_bytes());
    load(&folder.path().join("square.obj"), &Limits::default(), &Progress::new()).unwrap()
}

#[test]
fn normal_maps_have_tangents_along_their_texture_coordinates() {
    let mesh = square(&folder(), "norm -bm 0.5 w.png\nmap_Bump w.png\n");
    let look = &mesh.materials[0].look;
    assert!(look.maps[Slot::Normal as usize].is_some() && look.normal_scale == 0.5);
    let details = mesh.details.as_ref().expect("tangents");
    assert_eq!(details.len(), 4);
    for detail in details.iter() {
        assert!(detail.tangent.distance(glam::Vec3::X) < 1e-6, "u grows along x, and not along {}", detail.tangent);
        // The bitangent points where the image's rows go up.
        assert_eq!(detail.bitangent_sign, 1.0);
    }
    assert!(mesh.warnings.len() == 1 && mesh.warnings[0].contains("bump map"), "{:?}", mesh.warnings);
    assert!(square(&folder(), "Kd 1 1 1\n").details.is_none(), "nothing needs tangents");
}

#[test]
fn opacity_roughness_and_metalness_come_from_images() {
    let mesh = square(&folder(), "map_Kd w.png\nmap_d w.png\nmap_Pr w.png\nPm 0.5\nmap_Pm w.png\n");
    let material = &mesh.materials[0];
    assert_eq!((material.look.alpha, material.look.roughness, material.look.metallic), (Alpha::Blend, 1.0, 0.5));
    let texture = material.texture.as_ref().expect("a base colour");
    assert_eq!(texture.rgba, [255, 0, 0, 255, 0, 0, 255, 128], "its alpha is that of the opacity map");
    let map = material.look.maps[Slot::MetallicRoughness as usize].as_ref().expect("roughness and metalness");
    assert_eq!(map.texture.rgba, [255, 0, 0, 255, 255, 0, 255, 255], "green of one, and blue of the other");
    let mesh = square(&folder(), "map_Pm gone.png\nmap_d gone.png\n");
    let look = &mesh.materials[0].look;
    assert_eq!((look.metallic, look.alpha, mesh.warnings.len()), (0.0, Alpha::Opaque, 1), "{:?}", mesh.warnings);
}

#[test]
fn height_images_displace_as_the_file_says() {
    let height = |statement: &str| {
        let mut mesh = square(&folder(), statement);
        (mesh.mesh.materials[0].height.take(), mesh.warnings)
    };
    for statement in ["disp", "map_disp", "map_Kd w.png\nmap_Disp"] {
        let (map, warnings) = height(&format!("{statement} -mm -0.5 2 w.png\n"));
        let map = map.expect("a height image");
        assert_eq!((map.size, map.amount), ([2, 1], Some(HeightAmount { scale: 2.0, midlevel: 0.25 })));
        assert_eq!(map.heights[..2], [0.2126, 0.0722], "the brightness of red and of blue");
        assert_eq!((map.wrap, warnings), ([Wrap::Repeat; 2], Vec::new()));
    }
    for clamped in ["disp -clamp on w.png\n", "map_Kd -clamp on w.png\ndisp w.png\n"] {
        assert_eq!(height(clamped).0.map(|map| map.wrap), Some([Wrap::Clamp; 2]), "{clamped}");
    }
    let (map, _) = height("disp w.png\n");
    assert_eq!(map.map(|map| map.amount), Some(None), "the file doesn't say how far");
    for (file, reason) in [("gone.png", "there is no such file"), ("m.mtl", "choose a "), ("../up.png", "with ..")] {
        let (map, warnings) = height(&format!("disp {file}\n"));
        let start =
            format!("the height image of material \"m\" is left out: \"{file}\" can't be read as a height image: ");
        let is_said = warnings.len() == 1 && warnings[0].starts_with(&start) && warnings[0].contains(reason);
        assert!(map.is_none() && is_said, "{warnings:?}");
    }
}

#[test]
fn textures_take_the_room_that_heights_leave() {
    let folder = folder();
    for (name, side) in [("color.png", 1024), ("height.png", 512)] {
        let gray = image::GrayImage::from_pixel(side, side, image::Luma([128]));
        gray.save(folder.path().join(name)).unwrap();
    }
    square(&folder, "map_Kd color.png\ndisp height.png\n");
    // The texture takes 4 MiB, on the graphics card a third more; and the heights 1.6 MiB.
    let limits = Limits { memory: 5_700_000, ..Limits::default() };
    let mesh = load(&folder.path().join("square.obj"), &limits, &Progress::new()).unwrap();
    let material = &mesh.materials[0];
    assert_eq!(material.height.as_ref().map(|map| map.size), Some([512; 2]), "{:?}", mesh.warnings);
    assert_eq!(material.texture.as_ref().map(|texture| texture.size), Some([512; 2]), "{:?}", mesh.warnings);
}

#[test]
fn only_64_material_files_are_read() {
    let folder = folder();
    let libraries: String = (0..1000).map(|i| format!("mtllib {}.mtl\n", i % 100)).collect();
    let warnings = read(&folder, &libraries, &["a"]).warnings;
    assert!(warnings.len() == 3 && warnings[0].ends_with(" (and 63 more like it)."), "{warnings:?}");
    assert!(warnings[1].starts_with("material files beyond the first 64, left out: "), "{}", warnings[1]);
}

#[test]
fn absolute_paths_of_another_machine_are_looked_for_beside_the_model() {
    let folder = folder();
    write(&folder, "m.mtl", b"newmtl a\nmap_Kd C:\\art\\wood.png\nnewmtl b\nmap_Kd /home/artist/wood.png\n");
    write(&folder, "wood.png", &png());
    let mesh = read(&folder, "mtllib D:\\scenes\\m.mtl", &["a", "b"]);
    assert!(mesh.materials.iter().all(|material| material.texture.is_some()), "{:?}", mesh.warnings);
}

#[test]
fn materials_shine_are_transparent_and_repeat_their_images_as_the_file_says() {
    let folder = folder();
    write(
        &folder,
        "m.mtl",
        b"newmtl glass\nd 0.25\nPr 0.125\nPm 0\nnewmtl lamp\nKe 4 2 1\nnewmtl screen\nmap_Ke -clamp on w.png\nnewmtl tiles\n\
          map_Kd -s 2 4 -o 0.5 0 w.png\nnewmtl odd\nd 0\nnewmtl thin\nd 1\nTr 0.75\nnewmtl full\nTr 1\n",
    );
    write(&folder, "w.png", &png());
    let mesh = read(&folder, "mtllib m.mtl", &["glass", "lamp", "screen", "tiles", "odd", "thin", "full"]);
    let [glass, lamp, screen, tiles, odd, thin, full] = &mesh.materials[..] else { panic!("{:?}", mesh.materials) };
    assert_eq!((glass.base_color[3], glass.look.alpha, glass.look.roughness), (0.25, Alpha::Blend, 0.125));
    assert_eq!((lamp.look.emissive, odd.look.alpha, odd.base_color), ([4.0, 2.0, 1.0], Alpha::Opaque, [1.0; 4]));
    assert_eq!((thin.base_color[3], thin.look.alpha, full.look.alpha), (0.25, Alpha::Blend, Alpha::Opaque));
    let glow = screen.look.maps[Slot::Emissive as usize].as_ref().expect("a texture that shines");
    assert_eq!((screen.look.emissive, glow.sampling.wrap), ([1.0; 3], [Wrap::Clamp; 2]));
    // The file's texture coordinates are (0, 0), and its v points upwards.
    let uv =
        |material: &Material| mesh.corners[mesh.triangles[material.triangles.start as usize][0] as usize].uv.to_array();
    assert_eq!((uv(tiles), uv(lamp)), ([0.5, 1.0], [0.0, 1.0]));
    assert!(tiles.texture.is_some() && mesh.warnings.is_empty(), "{:?}", mesh.warnings);
}

/// A triangle whose material has an image of normals as its bump map, as Blender writes it.
#[test]
fn a_bump_map_of_normals_is_a_normal_map() {
    let folder = folder();
    let image = |texel: [u8; 4]| {
        let pixels = image::RgbaImage::from_pixel(8, 8, image::Rgba(texel));
        let mut bytes = std::io::Cursor::new(Vec::new());
        pixels.write_to(&mut bytes, image::ImageFormat::Png).expect("memory");
        bytes.into_inner()
    };
    write(&folder, "maps/normal.png", &image([140, 120, 254, 255]));
    write(&folder, "maps/height.png", &image([90, 90, 90, 255]));
    let bump = |name: &str, rest: &str| format!("newmtl {name}\nmap_Bump -bm 0.5 maps/{rest}.png\n");
    let library =
        bump("normals", "normal") + &bump("heights", "height") + &bump("unused", "normal") + &bump("gone", "nowhere");
    write(&folder, "a.mtl", library.as_bytes());
    let mesh = read(&folder, "mtllib a.mtl", &["normals", "heights", "gone"]);
    let looks: Vec<_> = mesh.materials.iter().map(|material| &material.look).collect();
    let has_map = |i: usize| looks[i].maps[Slot::Normal as usize].is_some();
    assert_eq!([0, 1, 2].map(has_map), [true, false, false]);
    assert_eq!(looks[0].normal_scale, 0.5);
    assert!(mesh.details.is_some(), "its corners have tangents");
    assert!(mesh.warnings.iter().any(|warning| warning.ends_with("an image of normals, drawn as a normal map: 1.")));
    assert!(
        mesh.warnings.iter().any(|warning| warning.ends_with("norm names a normal map: 2.")),
        "{:?}",
        mesh.warnings
    );
}
