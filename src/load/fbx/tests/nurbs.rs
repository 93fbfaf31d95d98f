//! NURBS surfaces.

use std::collections::HashSet;

use glam::Vec3;

use super::documents::{Link, Nurbs, document, model, prism, quarter_cylinder};
use super::tree::{Arrays, Entry, binary, object, one, properties, text};
use super::{loaded, near, read};
use crate::loaded_mesh::LoadedMesh;

/// A file in metres with a surface as a part.
fn with_surface(surface: &Nurbs) -> Vec<Entry> {
    document(
        false,
        100.0,
        vec![surface.entry(10), model(20, "part", "Mesh", &[])],
        &[Link(20, 0, ""), Link(10, 20, "")],
    )
}

/// A surface that is linear along u and v.
fn bilinear(corners: [[f64; 3]; 4]) -> Nurbs {
    Nurbs {
        orders: [2, 2],
        sizes: [2, 2],
        forms: ["Open", "Open"],
        points: corners.into_iter().flat_map(|[x, y, z]| [x, y, z, 1.0]).collect(),
        knots: [vec![0.0, 0.0, 1.0, 1.0], vec![0.0, 0.0, 1.0, 1.0]],
        flips: false,
    }
}

/// The surface at whose height x times y lies.
fn saddle() -> Nurbs {
    bilinear([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 1.0]])
}

fn made(share: &str) -> String {
    format!("NURBS surfaces, made polygons that differ from them by up to {share} of their size: 1.")
}

/// Checks that triangles show their fronts where their normals point.
fn assert_fronts(mesh: &LoadedMesh) {
    for triangle in mesh.triangles.iter() {
        let [a, b, c] = triangle.map(|corner| mesh.corners[corner as usize]);
        let front = (b.position - a.position).cross(c.position - a.position).normalize();
        assert!([a, b, c].iter().all(|corner| corner.normal.dot(front) > 0.7), "{front} at {}", a.position);
    }
}

/// How many places corners have.
fn places(mesh: &LoadedMesh) -> usize {
    mesh.corners
        .iter()
        .map(|corner| corner.position.to_array().map(|x| (x + 0.0).to_bits()))
        .collect::<HashSet<_>>()
        .len()
}

#[test]
fn a_bilinear_surface_is_a_mesh_with_its_material_normals_and_coordinates() {
    let mut entries = with_surface(&saddle());
    entries[2].children.push(object("Material", 60, "Material::paint", "", vec![one("ShadingModel", "phong")]));
    entries[3].children.push(Link(60, 20, "").entry());
    let mesh = loaded(&entries);
    assert_eq!(mesh.warnings, [made("0.001")]);
    // It is as twisted as it is large: 16 by 32 polygons are 0.0005 from it.
    assert_eq!((mesh.triangles.len(), mesh.materials[0].name.as_str()), (16 * 32 * 2, "paint"));
    assert_eq!(mesh.contents.parts.iter().map(|part| part.name.as_str()).collect::<Vec<_>>(), ["part"]);
    for corner in &mesh.corners {
        let [x, y, z] = corner.position.to_array();
        let normal = Vec3::new(-y, -x, 1.0).normalize();
        assert!((z - x * y).abs() < 1e-6 && near(corner.normal.to_array(), normal.to_array()), "{corner:?}");
        assert!(near(corner.uv.to_array(), [x, 1.0 - y]), "{corner:?}");
    }
    assert_fronts(&mesh);
    // A flat one needs no more polygons than the two it begins with.
    let flat = bilinear([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]]);
    assert_eq!(loaded(&with_surface(&flat)).triangles.len(), 4);
}

#[test]
fn a_rational_surface_lies_on_its_cylinder_within_the_tolerance_however_it_is_turned() {
    let turned = Nurbs { flips: true, ..quarter_cylinder() };
    for (surface, side) in [(quarter_cylinder(), 1.0), (turned, -1.0)] {
        for hand in [1.0, -1.0] {
            let mut entries = with_surface(&surface);
            let right = properties(&[("CoordAxisSign", "int", &[hand])]);
            entries[1].children[1].children[5] = right.children[0].clone();
            let mesh = loaded(&entries);
            assert_eq!((mesh.triangles.len(), &mesh.warnings), (16 * 2 * 2, &vec![made("0.001")]));
            for corner in &mesh.corners {
                let radial = corner.position.with_z(0.0);
                assert!((radial.length() - 1.0).abs() < 1e-6, "{corner:?}");
                assert!(near(corner.normal.to_array(), (radial * side).to_array()), "{corner:?}");
            }
            for triangle in mesh.triangles.iter() {
                let [a, b, c] = triangle.map(|corner| mesh.corners[corner as usize].position);
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    let middle = from.midpoint(to).with_z(0.0).length();
                    assert!(middle > 1.0 - 0.001 * 6.0_f32.sqrt(), "{middle}");
                }
            }
            assert_fronts(&mesh);
        }
    }
}

#[test]
fn copies_and_mirrors_of_a_surface_show_their_fronts() {
    let scaled = |id, x| model(id, "copy", "Mesh", &[("Lcl Scaling", "Lcl Scaling", &[x, 1.0, 1.0])]);
    let objects = vec![quarter_cylinder().entry(10), scaled(20, 1.0), scaled(21, -1.0)];
    let links = [Link(20, 0, ""), Link(21, 0, ""), Link(10, 20, ""), Link(10, 21, "")];
    let mesh = loaded(&document(false, 100.0, objects, &links));
    assert_eq!((mesh.triangles.len(), mesh.warnings.as_slice()), (2 * 64, &[made("0.001")][..]));
    assert!(mesh.corners.iter().all(|corner| corner.normal.dot(corner.position.with_z(0.0)) > 0.999));
    assert_fronts(&mesh);
}

#[test]
fn surfaces_that_close_have_no_seam() {
    let around = |count: u32| {
        let angle = move |i| f64::from(i) * std::f64::consts::TAU / f64::from(count);
        (0..count).map(|i| [angle(i).cos(), angle(i).sin(), 1.0]).collect::<Vec<_>>()
    };
    let uniform = (0..15).map(f64::from).collect();
    let tube = loaded(&with_surface(&Nurbs::extruded(4, "Periodic", &around(8), uniform, 2.0)));
    // Eight cubic spans, each in twice as many pieces as its degree.
    assert_eq!((tube.triangles.len(), places(&tube)), (48 * 2 * 2, 48 * 3));
    assert_eq!(tube.warnings, [made("0.001")]);
    for corner in &tube.corners {
        let radial = corner.position.with_z(0.0);
        // At its knots 0.9024, and between them 0.9013.
        assert!((radial.length() - 0.902).abs() < 1e-3 && corner.normal.dot(radial.normalize()) > 0.999, "{corner:?}");
    }
    assert_fronts(&tube);
    let knots = vec![0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 4.0];
    let square = loaded(&with_surface(&Nurbs::extruded(2, "Closed", &around(4), knots, 2.0)));
    assert_eq!((square.triangles.len(), places(&square)), (4 * 2 * 2, 4 * 3));
}

#[test]
fn a_pole_has_a_normal() {
    // A cone, whose second curve is one point.
    let mut cone = quarter_cylinder();
    cone.points[12..].chunks_mut(4).for_each(|point| point[..2].fill(0.0));
    let mesh = loaded(&with_surface(&cone));
    assert_eq!(mesh.warnings, [made("0.001")]);
    assert!(mesh.corners.iter().all(|corner| corner.normal.z > 0.4 && corner.normal.z < 0.95), "{:?}", mesh.corners);
    assert_fronts(&mesh);
}

#[test]
fn of_a_trimmed_surface_the_whole_is_read() {
    let objects = vec![
        quarter_cylinder().entry(10),
        object("Geometry", 11, "Geometry::trimmed", "TrimNurbsSurface", vec![one("Version", 100)]),
        model(20, "part", "Mesh", &[]),
    ];
    let mesh = loaded(&document(false, 100.0, objects, &[Link(20, 0, ""), Link(11, 20, ""), Link(10, 11, "")]));
    let trimmed = "NURBS surfaces whose trimming isn't read: 1.".to_owned();
    assert_eq!((mesh.triangles.len(), mesh.warnings), (64, vec![made("0.001"), trimmed]));
}

#[test]
fn a_surface_smaller_than_what_the_parser_joins_says_so() {
    let mut small = quarter_cylinder();
    small.points.chunks_mut(4).for_each(|point| point[..3].iter_mut().for_each(|x| *x *= 0.01));
    let warnings = loaded(&with_surface(&small)).warnings;
    // 0.0005, and 0.00032 of a diagonal of 0.0245.
    assert!(warnings.contains(&made("0.014")), "{warnings:?}");
}

#[test]
fn a_broken_surface_is_left_out_and_the_others_stay() {
    let of = |change: fn(&mut Nurbs)| {
        let mut broken = saddle();
        change(&mut broken);
        broken
    };
    let (knots, degree) = ("its knots don't ascend, or don't fit", "its degree isn't between 1 and 15");
    for (broken, reason) in [
        (of(|own| own.points[5] = f64::NAN), "a control point, or its weight, isn't a finite number"),
        (of(|own| own.points[7] = f64::INFINITY), "a control point, or its weight, isn't a finite number"),
        (of(|own| own.points.chunks_mut(4).for_each(|point| point[3] = 0.0)), "its weights add up to 0"),
        (of(|own| own.points.fill(1.0)), "or all of it is one point"),
        (of(|own| own.knots[0] = vec![0.0, 1.0]), knots),
        (of(|own| own.knots[0] = vec![0.0, 0.0, 0.0, 1.0, 1.0]), knots),
        (of(|own| own.knots[1] = vec![1.0, 1.0, 0.0, 0.0]), knots),
        (of(|own| own.knots[1].fill(1.0)), knots),
        (of(|own| own.knots[0][1] = f64::NAN), knots),
        (of(|own| own.knots[0].clear()), knots),
        (of(|own| own.orders[0] = 1), degree),
        (of(|own| own.orders[1] = 0), degree),
        (of(|own| own.orders[0] = 17), degree),
        (of(|own| own.orders = [i64::from(i32::MAX) / 4, 2]), degree),
        (of(|own| (own.sizes[0], own.points) = (0, Vec::new())), knots),
    ] {
        let file = |more: Vec<Entry>, linked: &[Link]| {
            let objects = [vec![broken.entry(10), model(20, "broken", "Mesh", &[])], more].concat();
            let links = linked.iter().map(|link| Link(link.0, link.1, "")).chain([Link(20, 0, ""), Link(10, 20, "")]);
            read(&binary(&document(false, 100.0, objects, &links.collect::<Vec<_>>()), Arrays::Plain))
        };
        let whole = vec![prism(Vec::new()), model(21, "prism", "Mesh", &[])].into_iter();
        let renumbered = whole.map(|mut entry| {
            if entry.name == "Geometry" {
                entry.values[0] = 11.into();
            }
            entry
        });
        let mesh = file(renumbered.collect(), &[Link(21, 0, ""), Link(11, 21, "")]).expect("a prism");
        let said: Vec<_> = mesh.warnings.iter().filter(|said| said.contains("NURBS")).collect();
        assert_eq!((mesh.triangles.len(), said.len()), (20, 1), "{reason}: {:?}", mesh.warnings);
        assert!(
            said[0].starts_with("the NURBS surface of \"broken\" is left out: ") && said[0].contains(reason),
            "{reason}: {}",
            said[0]
        );
        let alone = file(Vec::new(), &[]).map(|_| ()).expect_err("nothing is left").to_string();
        assert!(alone.contains("1 NURBS and procedural surfaces"), "{alone}");
    }
}

#[test]
fn changed_surfaces_are_read_or_refused() {
    let bytes = binary(&with_surface(&quarter_cylinder()), Arrays::Plain);
    let start = memchr::memmem::find(&bytes, b"NurbsSurfaceOrder").expect("the surface");
    let end = memchr::memmem::find(&bytes, b"FlipNormals").expect("its last entry");
    for at in start..end {
        for changed in [0xff, bytes[at] ^ 0x10, bytes[at] ^ 1] {
            let mut bytes = bytes.clone();
            bytes[at] = changed;
            if let Ok(mesh) = read(&bytes) {
                assert!(mesh.corners.iter().all(|corner| corner.position.is_finite()), "{at} {changed}");
            }
        }
    }
}

#[test]
fn many_copies_of_many_spans_are_cut_coarsely() {
    // Its 4096 spans are arcs of more than 130 degrees.
    let curve: Vec<_> = (0..4099).map(|i| f64::from(i) * 2.4).map(|angle| [angle.cos(), angle.sin(), 1.0]).collect();
    let coil = Nurbs::extruded(4, "Open", &curve, (0..4103).map(f64::from).collect(), 2.0);
    let nodes = (20..44).map(|id| model(id, "copy", "Mesh", &[]));
    let objects = [coil.entry(10)].into_iter().chain(nodes).collect();
    let links: Vec<_> = (20..44).flat_map(|id| [Link(id, 0, ""), Link(10, id, "")]).collect();
    let mesh = read(&text(&document(false, 100.0, objects, &links))).expect("a file without a fault");
    assert_eq!(mesh.triangles.len(), 24 * 4096 * 2 * 2);
    assert!(mesh.warnings[0].contains("made polygons") && !mesh.warnings[0].contains("0.001"), "{:?}", mesh.warnings);
}
