//! Pictures of every surface, partitioning and overlay, against references made on the software driver. Run with
//! PNAEN_UPDATE_IMAGES=1 to make them again; look at what changed before keeping it.

mod colours;
mod marks;

use std::path::{Path, PathBuf};

use geometry::mesh::Shape;
use geometry::progress::Progress;
use geometry::tessellate::{Displacement, Lod, Normals, Partitioning, Surface, Tessellation};
use image::RgbaImage;
use inspect::engine::{Preparation, load};
use inspect::settings::{ARENA_BYTES, Choice, Colors, Matcap, NormalsAt, Overlay, Overlays, Settings};
use inspect::shot::{BETWEEN_DRIVERS, Reference, compare, write_drawn};
use load::Source;

use crate::displacement::wavy;
use crate::{engine, picture, scene};

pub(super) const SIZE: [u32; 2] = [200, 160];

fn reference(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/images").join(format!("{name}.png"))
}

/// Names of pictures that differ from their references, with how much. It is decided as `render --reference` does.
pub(super) fn differing(pictures: Vec<(String, RgbaImage)>) -> Vec<String> {
    let update = std::env::var_os("PNAEN_UPDATE_IMAGES").is_some();
    assert!(engine().gpu.is_software() || !update, "references are made on the software driver");
    let mut differing = Vec::new();
    for (name, picture) in pictures {
        let path = reference(&name);
        let adapter = &engine().gpu.info;
        if update {
            write_drawn(&path, &picture, adapter, &[]).expect("the folder is there");
            continue;
        }
        let reference = Reference::read(&path, None).unwrap_or_else(|error| panic!("{name}: {error}"));
        let verdict = reference.compare(&picture, adapter).expect("one size");
        if !verdict.is_same() {
            let folder = std::env::temp_dir();
            picture.save(folder.join(format!("pnaen-{name}.png"))).expect("a writable temporary folder");
            differing.push(format!("{name}, {verdict:?}: see {}", folder.display()));
        }
    }
    differing
}

/// PN triangles, which crack at split normals, under an overlay.
fn pn_under(overlay: Overlay) -> Settings {
    let tessellation = Tessellation { surface: Surface::Pn, ..Tessellation::default() };
    Settings { tessellation, overlays: Overlays::new(&[overlay]).expect("one overlay"), ..Settings::default() }
}

#[test]
fn surfaces_look_as_they_did() {
    let (_, mut scene) = scene(Shape::CubeSplit);
    let pictures = Surface::ALL.map(|surface| {
        let settings = Settings::from(Tessellation { surface, factor: 12.0, ..Tessellation::default() });
        (format!("surface-{}", surface.name()), picture(&mut scene, &settings, SIZE))
    });
    assert_eq!(differing(pictures.into()), Vec::<String>::new());
}

#[test]
fn normals_look_as_they_did() {
    let (_, mut scene) = scene(Shape::CubeSmooth);
    let all = [("linear", Normals::Linear), ("quadratic", Normals::Quadratic), ("surface", Normals::Surface)];
    let pictures = all.map(|(name, normals)| {
        let settings = Settings::from(Tessellation { normals, factor: 16.0, ..Tessellation::default() });
        (format!("normals-{name}"), picture(&mut scene, &settings, SIZE))
    });
    assert_eq!(differing(pictures.into()), Vec::<String>::new());
}

#[test]
fn normals_at_pixels_look_as_they_did() {
    // Beside normals-quadratic: with 4 segments an edge in place of 16, the outline differs and the shading doesn't.
    let (_, mut scene) = scene(Shape::CubeSmooth);
    let tessellation = Tessellation { normals: Normals::Quadratic, factor: 4.0, ..Tessellation::default() };
    let settings = Settings { normals_at: NormalsAt::Pixels, ..Settings::from(tessellation) };
    let picture = picture(&mut scene, &settings, SIZE);
    assert_eq!(differing(vec![("normals-at-pixels".to_owned(), picture)]), Vec::<String>::new());
}

#[test]
fn a_crease_band_looks_as_it_did() {
    // Beside surface-pn and surface-pn-aen: closed as the one is not, round where the other has its crease.
    let loaded = load(
        &Source::Shape(Shape::CubeSplit),
        &Preparation { crease_band: 0.04, ..Preparation::default() },
        &Progress::new(),
    )
    .expect("shapes always load");
    let mut scene = engine().scene(&loaded, ARENA_BYTES).expect("shapes are small");
    let settings = Settings::from(Tessellation { surface: Surface::Pn, factor: 12.0, ..Tessellation::default() });
    let picture = picture(&mut scene, &settings, SIZE);
    assert_eq!(differing(vec![("surface-pn-crease-band".to_owned(), picture)]), Vec::<String>::new());
}

#[test]
fn displaced_surfaces_look_as_they_did() {
    let (_, mut scene) = wavy(Shape::CubeSplit);
    let all = [("on", Displacement::On), ("as-published", Displacement::AsPublished)];
    let pictures = all.map(|(name, displacement)| {
        let settings =
            Settings::from(Tessellation { displacement, height_scale: 0.15, factor: 32.0, ..Tessellation::default() });
        (format!("displacement-{name}"), picture(&mut scene, &settings, SIZE))
    });
    assert_eq!(differing(pictures.into()), Vec::<String>::new());
}

#[test]
fn partitionings_look_as_they_did() {
    let (_, mut scene) = scene(Shape::Icosahedron);
    let overlays = Overlays { wireframe: true, patches: true, ..Overlays::default() };
    let pictures = Partitioning::ALL.map(|partitioning| {
        let settings = Settings {
            tessellation: Tessellation { partitioning, factor: 4.6, ..Tessellation::default() },
            overlays,
            ..Settings::default()
        };
        (format!("partitioning-{}", partitioning.name()), picture(&mut scene, &settings, SIZE))
    });
    assert_eq!(differing(pictures.into()), Vec::<String>::new());
}

#[test]
fn overlays_look_as_they_did() {
    let mut pictures = Vec::new();
    for (name, shape, overlay) in [
        ("wireframe", Shape::Icosahedron, Overlay::Wireframe),
        ("patches", Shape::Torus, Overlay::Patches),
        ("barycentric", Shape::CubeSplit, Overlay::Barycentric),
        ("adjacency-cylinder", Shape::Cylinder, Overlay::Adjacency),
        ("adjacency-moebius", Shape::Moebius, Overlay::Adjacency),
        ("cracks", Shape::CubeSplit, Overlay::Cracks),
        ("normals", Shape::CubeSplit, Overlay::Normals),
    ] {
        let (_, mut scene) = scene(shape);
        let settings = pn_under(overlay);
        pictures.push((format!("overlay-{name}"), picture(&mut scene, &settings, SIZE)));
    }
    assert_eq!(differing(pictures), Vec::<String>::new());
}

#[test]
fn colours_look_as_they_did() {
    let mut pictures = Vec::new();
    for (name, shape, colors, settings) in [
        (
            "factors",
            Shape::Torus,
            Colors::Factors,
            Settings::from(Tessellation { lod: Lod::Error, ..Tessellation::default() }),
        ),
        (
            "triangle-size",
            Shape::Torus,
            Colors::TriangleSize,
            Settings::from(Tessellation { lod: Lod::EdgeLength, ..Tessellation::default() }),
        ),
        (
            "low-factors",
            Shape::Torus,
            Colors::LowFactors,
            Settings::from(Tessellation { lod: Lod::EdgeLength, ..Tessellation::default() }),
        ),
        (
            "excess",
            Shape::Torus,
            Colors::Excess,
            Settings::from(Tessellation { lod: Lod::EdgeLength, tolerance: 1.0, ..Tessellation::default() }),
        ),
        ("clay", Shape::Bicubic, Colors::Clay, Settings::default()),
        ("zebra", Shape::Bicubic, Colors::Zebra, Settings { normals_at: NormalsAt::Pixels, ..Settings::default() }),
        ("shading-normals", Shape::CubeSplit, Colors::ShadingNormals, Settings::default()),
        ("matcap-red-clay", Shape::Bicubic, Colors::Matcap, Settings::default()),
        ("matcap-chrome", Shape::Bicubic, Colors::Matcap, Settings { matcap: Matcap::Chrome, ..Settings::default() }),
        ("matcap-pearl", Shape::Bicubic, Colors::Matcap, Settings { matcap: Matcap::Pearl, ..Settings::default() }),
        (
            "matcap-two-tone",
            Shape::Bicubic,
            Colors::Matcap,
            Settings { matcap: Matcap::TwoTone, ..Settings::default() },
        ),
        ("texel-density", Shape::Torus, Colors::TexelDensity, Settings::default()),
        (
            "surface-normals",
            Shape::Icosphere,
            Colors::SurfaceNormals,
            Settings { split: Some(0.5), ..Settings::default() },
        ),
        ("curvature", Shape::Torus, Colors::Curvature, Settings { split: Some(0.5), ..Settings::default() }),
        ("uv-checker", Shape::Torus, Colors::UvChecker, Settings { split: Some(0.5), ..Settings::default() }),
    ] {
        let (_, mut scene) = scene(shape);
        let settings = Settings {
            tessellation: Tessellation { pixels: 12.0, ..settings.tessellation },
            overlays: Overlays { colors, ..Overlays::default() },
            ..settings
        };
        pictures.push((format!("colours-{name}"), picture(&mut scene, &settings, SIZE)));
    }
    assert_eq!(differing(pictures), Vec::<String>::new());
}

#[test]
fn adaptive_lod_and_the_split_look_as_they_did() {
    let (_, mut scene) = scene(Shape::Cone);
    let overlays = Overlays { wireframe: true, ..Overlays::default() };
    let adaptive = Settings {
        tessellation: Tessellation { lod: Lod::Paper, pixels: 32.0, ..Tessellation::default() },
        overlays,
        ..Settings::default()
    };
    let few = Settings::from(Tessellation { factor: 3.0, ..Tessellation::default() });
    let split = Settings { split: Some(0.5), overlays, ..few };
    let pictures = [("lod-paper", adaptive), ("split", split)];
    let pictures = pictures.map(|(name, settings)| (name.to_owned(), picture(&mut scene, &settings, SIZE)));
    assert_eq!(differing(pictures.into()), Vec::<String>::new());
}

#[test]
fn a_change_that_matters_is_far_beyond_what_drivers_differ_by() {
    let (_, mut scene) = scene(Shape::CubeSplit);
    let base = Settings::from(Tessellation { factor: 12.0, ..Tessellation::default() });
    let wireframe = Overlays { wireframe: true, ..Overlays::default() };
    let expected = picture(&mut scene, &base, SIZE);
    for changed in [
        base.with(Tessellation { surface: Surface::Pn, ..base.tessellation }),
        Settings { overlays: wireframe, ..base },
        Settings { split: Some(0.4), ..base },
    ] {
        let comparison = compare(&picture(&mut scene, &changed, SIZE), &expected).expect("one size");
        assert!(comparison.worst_square > 10.0 * f64::from(BETWEEN_DRIVERS), "{comparison:?}: {changed:?}");
    }
}

/// How many px have an sRGB colour, within what rounding from it to linear light, in three digits, and back can do.
fn pixels_of(picture: &RgbaImage, color: [u8; 3]) -> usize {
    let near = |pixel: &image::Rgba<u8>| (0..3).all(|c| pixel.0[c].abs_diff(color[c]) <= 2);
    picture.pixels().filter(|pixel| near(pixel)).count()
}
