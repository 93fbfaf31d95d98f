//! Building meshes: corners are merged, repaired and put in order.

use super::*;
use crate::cores::on_threads;

fn corner(x: f32, y: f32) -> InputCorner {
    InputCorner { position: Vec3::new(x, y, 0.0), normal: Some(Vec3::Z), uv: Vec2::ZERO }
}

#[test]
fn triangles_are_grouped_and_corners_shared() {
    let mut builder = MeshBuilder::new();
    let red = builder.material(Material::plain("red", [1.0, 0.0, 0.0, 1.0]));
    let unused = builder.material(Material::plain("unused", [1.0; 4]));
    let blue = builder.material(Material::plain("blue", [0.0, 0.0, 1.0, 1.0]));
    assert_eq!([red, unused, blue], [0, 1, 2]);
    builder.triangle(blue, [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0)]);
    builder.triangle(red, [corner(-0.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)]);
    builder.triangle(blue, [corner(1.0, 0.0), corner(2.0, 0.0), corner(1.0, 1.0)]);
    let mesh = builder.finish("two".to_owned(), &Progress::new()).unwrap();
    assert_eq!(**mesh.triangles, [[0, 1, 2], [0, 3, 1], [3, 4, 1]]);
    assert_eq!(mesh.corners.len(), 5);
    let ranges: Vec<_> = mesh.materials.iter().map(|m| (m.name.as_str(), m.triangles.clone())).collect();
    assert_eq!(ranges, [("red", 0..1), ("blue", 1..3)]);
}

#[test]
fn only_missing_normals_are_made() {
    let mut builder = MeshBuilder::new();
    let material = builder.material(Material::plain("plain", [1.0; 4]));
    let mut corners = [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0)];
    corners[0].normal = Some(Vec3::X);
    corners[1].normal = None;
    builder.triangle(material, corners);
    let mesh = builder.finish(String::new(), &Progress::new()).unwrap();
    let normals: Vec<_> = mesh.corners.iter().map(|c| c.normal).collect();
    assert_eq!(normals, [Vec3::X, Vec3::Z, Vec3::Z]);
    assert_eq!(mesh.repairs, Repairs { normals_made: 1, ..Repairs::default() });
}

fn one(corners: [InputCorner; 3]) -> Mesh {
    let mut builder = MeshBuilder::new();
    let material = builder.material(Material::plain("plain", [1.0; 4]));
    builder.triangle(material, corners);
    builder.finish(String::new(), &Progress::new()).unwrap()
}

#[test]
fn bad_normals_are_mended_and_counted() {
    let mut corners = [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0)];
    let bad = [[0.0, -1e-30, 0.0], [f32::NAN, 0.0, 0.0], [0.0, 0.0, 0.0]];
    for (corner, normal) in corners.iter_mut().zip(bad) {
        corner.normal = Some(normal.into());
    }
    let mesh = one(corners);
    assert_eq!(mesh.corners.iter().map(|c| c.normal).collect::<Vec<_>>(), [Vec3::NEG_Y, Vec3::Z, Vec3::Z]);
    assert_eq!(mesh.repairs, Repairs { normals_replaced: 2, normals_rescaled: 1, ..Repairs::default() });
}

#[test]
fn coordinates_that_devices_drop_are_dropped_here_too() {
    let least = f32::MIN_POSITIVE;
    let mesh = one([corner(least.next_down(), -1e-45), corner(least, 1.0), corner(-least, 0.0)]);
    let positions: Vec<_> = mesh.corners.iter().map(|c| [c.position.x, c.position.y].map(f32::to_bits)).collect();
    assert_eq!(positions, [[0.0, 0.0], [least, 1.0], [-least, 0.0]].map(|xy| xy.map(f32::to_bits)));
    assert_eq!(mesh.repairs, Repairs { denormals: 1, ..Repairs::default() });
}

#[test]
fn room_for_corners_grows_by_half_where_nothing_is_known() {
    let (mut builder, budget) = (MeshBuilder::new(), Budget::unlimited());
    for x in 0..1000_u16 {
        builder.corner(corner(x.into(), 0.0), 0);
    }
    let more = builder.distinct.room() + 1;
    assert!(more <= 500);
    builder.make_room(more, &budget).unwrap();
    assert_eq!(builder.distinct.corners.capacity(), 1500);
}

/// Adds a strip of 98 triangles over 100 corners.
fn add_strip(builder: &mut MeshBuilder) {
    let material = builder.material(Material::plain("plain", [1.0; 4]));
    for i in 0..98_u16 {
        builder.triangle(material, [i, i + 1, i + 2].map(|k| corner(k.into(), (k % 2).into())));
    }
}

#[test]
fn lists_of_triangles_are_full_before_the_next_is_twice_as_long() {
    let mut builder = MeshBuilder::new();
    add_strip(&mut builder);
    let lists: Vec<_> = builder.groups[0].runs.iter().map(|run| (run.len(), run.capacity())).collect();
    assert_eq!(lists, [(4, 4), (8, 8), (16, 16), (32, 32), (38, 64)]);
}

#[test]
fn what_a_caller_has_borrowed_stays_borrowed_until_it_gives_it_back() {
    let budget = Budget::unlimited();
    budget.borrow(7).unwrap();
    let mut builder = MeshBuilder::new();
    add_strip(&mut builder);
    builder.finish_bound(String::new(), &budget, &Progress::new()).unwrap();
    assert_eq!(budget.borrowed(), 7);
}

#[test]
fn room_that_was_not_needed_is_returned_and_the_copy_is_accounted_for() {
    let built = |room: usize, bytes: u64| {
        let mut builder = MeshBuilder::new();
        builder.make_room(room, &Budget::unlimited()).unwrap();
        add_strip(&mut builder);
        let finished = builder.finish_bound(String::new(), &Budget::new(0, bytes), &Progress::new());
        finished.map(|(mesh, _)| (mesh.corners.len(), mesh.corners.capacity()))
    };
    // The triangles are joined; later the corners get new numbers, and are copied if there is much more room than they need.
    let (joined, copied) = (98 * 12, 100 * (4 + size_of::<Corner>() as u64));
    assert_eq!([built(100, joined), built(500, copied)], [Ok((100, 100)); 2]);
    assert!(built(100, joined - 1).is_err() && built(500, copied - 1).is_err());
}

#[test]
fn any_number_of_cores_and_any_memory_put_corners_in_the_same_order() {
    let count = 50_000_u32;
    // Some corners are used often, and some never.
    let triangles: Vec<_> =
        (0..70_000_u32).map(|i| [7919, 104_729, 15].map(|k| i.wrapping_mul(k) % (count + 11 * (k % 3)))).collect();
    let mesh = || {
        let corners = (0..count + 50).map(|i| repaired(corner(i as f32, 0.0)).0).collect();
        UnfinishedMesh { corners, bindings: (0..count + 50).collect(), triangles: triangles.clone() }
    };
    let ordered = |cores, memory| {
        let (mut mesh, budget) = (mesh(), || Budget::new(0, memory));
        on_threads(cores, || renumber(&mut mesh, &budget())).expect("threads");
        (mesh.corners, mesh.bindings, mesh.triangles)
    };
    let (mut order, mut is_named) = (Vec::new(), vec![false; count as usize + 50]);
    for &corner in triangles.as_flattened() {
        if !std::mem::replace(&mut is_named[corner as usize], true) {
            order.push(corner);
        }
    }
    for (cores, memory) in [(1, u64::MAX), (7, u64::MAX), (1, 0), (7, 0)] {
        let (corners, bindings, numbered) = ordered(cores, memory);
        assert_eq!(bindings, order, "{cores} cores, {memory} bytes");
        assert!(corners.iter().zip(&order).all(|(corner, old)| corner.position.x == *old as f32));
        assert!(
            numbered.as_flattened().iter().zip(triangles.as_flattened()).all(|(new, old)| order[*new as usize] == *old)
        );
        assert_eq!(corners.len(), order.len());
    }
}

#[test]
fn many_corners_at_once_get_the_numbers_of_one_after_another() {
    let offered: Vec<_> = (0..30_000_u32)
        .map(|i| (corner((i.wrapping_mul(i) % 9001) as f32, (i % 2) as f32), if i > 10_000 { i % 3 / 2 } else { 0 }))
        .collect();
    let stored = |cores, at_once| {
        let store = || {
            let (mut builder, mut stored) = (MeshBuilder::new(), Vec::new());
            offered.chunks(at_once).for_each(|some| builder.corners(some, &mut stored));
            (stored, builder.distinct.corners, builder.distinct.bindings)
        };
        on_threads(cores, store).expect("threads")
    };
    let expected = stored(1, 100);
    assert!(expected.1.len() > 9_000 && expected.1.len() < 30_000, "some are equal, and some aren't");
    for (cores, at_once) in [(2, 30_000), (7, 30_000), (7, 5_000)] {
        assert_eq!(stored(cores, at_once), expected, "{cores} cores, {at_once} at once");
    }
}

#[test]
fn triangles_keep_their_parts_among_several_materials() {
    let mut builder = MeshBuilder::new();
    let materials = ["a", "b"].map(|name| builder.material(Material::plain(name, [1.0; 4])));
    for (i, (part, material)) in
        [(Some(3), 0), (Some(3), 1), (None, 1), (Some(5), 1), (Some(5), 0), (Some(3), 0)].into_iter().enumerate()
    {
        builder.enter_part(part);
        let x = i as f32;
        builder.triangle(materials[material], [corner(x, 0.0), corner(x + 1.0, 0.0), corner(x, 1.0)]);
    }
    let mesh = builder.finish(String::new(), &Progress::new()).expect("not cancelled");
    let of_each: Vec<_> = (0..7).map(|triangle| mesh.part_of(triangle)).collect();
    assert_eq!(of_each, [Some(3), Some(5), Some(3), Some(3), None, Some(5), None], "the last one isn't there");
    let bounds_of = |part: u32| {
        let ranges = mesh.part_ranges.iter().filter(move |range| range.part == part);
        mesh.bounds_of(ranges.flat_map(|range| range.triangles.clone()))
    };
    let bounds = bounds_of(5).expect("a part with triangles");
    assert_eq!((bounds.min.x, bounds.max.x), (3.0, 5.0));
    assert_eq!(bounds_of(4), None);
}

#[test]
fn triangles_of_a_material_are_left_out_with_their_corners() {
    let mut builder = MeshBuilder::new();
    let materials = ["a", "b", "unused"].map(|name| builder.material(Material::plain(name, [1.0; 4])));
    for (i, material) in [0, 1, 1].into_iter().enumerate() {
        builder.enter_part(Some(i as u32));
        let x = 3.0 * i as f32;
        builder.triangle(materials[material], [corner(x, 0.0), corner(x + 1.0, 0.0), corner(x, 1.0)]);
    }
    assert_eq!(builder.used_materials(), 2);
    let mut asked = Vec::new();
    let left_out = builder.leave_out(|name, triangles| {
        asked.push((name.to_owned(), triangles));
        Ok::<_, std::convert::Infallible>(name == "b")
    });
    assert_eq!((left_out, asked), (Ok(()), vec![("a".to_owned(), 1), ("b".to_owned(), 2)]));
    assert_eq!((builder.len(), builder.used_materials()), (1, 1));
    let mesh = builder.finish(String::new(), &Progress::new()).expect("not cancelled");
    assert_eq!((mesh.triangles.len(), mesh.corners.len(), mesh.materials.len()), (1, 3, 1));
    assert_eq!(mesh.part_ranges.iter().map(|range| range.part).collect::<Vec<_>>(), [0]);
}
