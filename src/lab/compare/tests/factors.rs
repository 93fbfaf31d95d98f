//! Other factors: their rule, the partitioning, the edges of a convention, and changes of single ones.

use super::*;

#[test]
fn another_factor_everywhere_is_named() {
    for (partitioning, factor) in [
        (Partitioning::Integer, 5.0),
        (Partitioning::FractionalOdd, 6.25),
        (Partitioning::FractionalEven, 3.0),
        (Partitioning::Subtriangulation, 3.0),
    ] {
        let scene = Scene::new(Shape::Torus, Tessellation { partitioning, ..Tessellation::default() });
        let text = scene.check(&scene.theirs(|own| own.factor = factor).shuffled(), &["factors"]);
        assert!(text.contains(&format!("All its factors are {factor}.")), "{partitioning:?}: {text}");
    }
}

#[test]
fn each_partitioning_is_told_from_each_other() {
    for ours in Partitioning::DIRECT3D {
        let scene = torus(ours);
        for theirs in Partitioning::DIRECT3D.into_iter().chain([Partitioning::Rows]).filter(|theirs| *theirs != ours) {
            let text = scene.check(&scene.theirs(|own| own.partitioning = theirs).shuffled(), &["partitioning"]);
            let said = format!("Its partitioning is {}, and ours is {}", theirs.name(), ours.name());
            assert!(text.contains(&said), "{text}");
        }
    }
}

#[test]
fn factors_of_other_edges_are_conventions_and_crack() {
    let scene = torus(Partitioning::FractionalOdd);
    for convention in [Convention::Rotated, Convention::Mirrored] {
        let theirs = scene.theirs(|own| own.convention = convention).shuffled();
        let text = scene.check(&theirs, &["order_of_factors", "cracks"]);
        assert!(text.contains(&format!("as under --convention {}", convention.name())), "{text}");
        assert!(!scene.compare(&theirs).sides.is_empty());
    }
    // Valid conventions give the same points on edges, and others inside only in the last bits.
    for convention in [Convention::AmdPn, Convention::EdgeOrder] {
        let text = scene.check(&scene.theirs(|own| own.convention = convention).shuffled(), &["convention"]);
        assert!(text.contains(&format!("those of --convention {}", convention.name())), "{text}");
    }
}

#[test]
fn changes_of_factors_are_named() {
    let scene = torus(Partitioning::Integer);
    let mean = |[a, b, c]: [f32; 3]| (a + b + c) / 3.0;
    let least = |[a, b, c]: [f32; 3]| a.min(b).min(c);
    for (theirs, said) in [
        (scene.theirs_with(|sides, inside| (sides.map(f32::floor), inside.floor())), "rounded down"),
        (scene.theirs_with(|sides, inside| (sides.map(f32::round), inside.round())), "rounded to the nearest"),
        (scene.theirs_with(|sides, _| (sides, least(sides))), "inside factors are the least"),
        (scene.theirs_with(|sides, _| (sides, mean(sides))), "inside factors are the mean"),
        (scene.theirs_with(|sides, inside| (sides.map(|factor| factor / 2.0), inside / 2.0)), "0.5 times ours"),
        (scene.theirs_with(|sides, inside| (sides.map(|factor| factor.min(8.0)), inside.min(8.0))), "limited to 8"),
    ] {
        let text = scene.check(&theirs.shuffled(), &["factors"]);
        assert!(text.contains(said), "{said}: {text}");
    }
}

#[test]
fn factors_without_a_rule_are_listed_by_side() {
    let scene = torus(Partitioning::Integer);
    // Both sides of an edge get the same.
    let theirs = scene.theirs_with(|sides, inside| (sides.map(|factor| factor + 1.0 + (factor * 7.0).sin()), inside));
    let text = scene.check(&theirs, &["factors"]);
    assert!(text.contains("have other points") && text.contains("suit our partitioning, integer"), "{text}");
    let found = scene.compare(&theirs);
    let first = &found.sides[0];
    let own = first.ours.segments as f64;
    assert!(first.theirs.segments != first.ours.segments && (first.ours.factor - own).abs() < 0.01, "{first:?}");
    assert!(found.sides.len() > 100 && found.different.len() > 50);
}
