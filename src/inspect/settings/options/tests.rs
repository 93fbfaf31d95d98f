use std::collections::BTreeSet;

use proptest::prelude::*;

use super::*;
use crate::for_tests::random;
use crate::settings::Colors;
use load::Import;

/// Every field with its value. Patterns have no `..`, so a new field must be named here and then reached by a declaration.
fn fields(settings: &Settings) -> Vec<(&'static str, String)> {
    let Settings {
        tessellation,
        normals_at,
        normal_maps,
        overlays,
        lighting,
        lights,
        environment_brightness,
        environment_background,
        exposure,
        tone_curve,
        light_rotation,
        deviation_in,
        curvature_kind,
        curvature_scale,
        zebra_stripes,
        zebra_direction,
        checker_squares,
        texel_density_per,
        matcap,
        split,
        split_view,
        left,
        left_looks,
        section,
        section_at,
        background,
        import,
    } = settings;
    let Import { normals: mesh_normals, crease_angle, up, unit, show_hidden, subdivide, levels, subdivide_uvs } =
        import;
    let Tessellation {
        surface,
        alpha,
        normals,
        edges,
        factor,
        partitioning,
        lod,
        pixels,
        tolerance,
        near,
        far,
        clip,
        cull_back_faces,
        convention,
        displacement,
        height_scale,
        midlevel,
    } = tessellation;
    vec![
        ("surface", format!("{surface:?}")),
        ("alpha", format!("{alpha:?}")),
        ("normals", format!("{normals:?}")),
        ("edges", format!("{edges:?}")),
        ("factor", format!("{factor:?}")),
        ("partitioning", format!("{partitioning:?}")),
        ("lod", format!("{lod:?}")),
        ("pixels", format!("{pixels:?}")),
        ("tolerance", format!("{tolerance:?}")),
        ("near", format!("{near:?}")),
        ("far", format!("{far:?}")),
        ("clip", format!("{clip:?}")),
        ("cull_back_faces", format!("{cull_back_faces:?}")),
        ("convention", format!("{convention:?}")),
        ("displacement", format!("{displacement:?}")),
        ("height_scale", format!("{height_scale:?}")),
        ("midlevel", format!("{midlevel:?}")),
        ("normals_at", format!("{normals_at:?}")),
        ("normal_maps", format!("{normal_maps:?}")),
        ("overlays", format!("{overlays:?}")),
        ("lighting", format!("{lighting:?}")),
        ("lights", format!("{lights:?}")),
        ("environment_brightness", format!("{environment_brightness:?}")),
        ("environment_background", format!("{environment_background:?}")),
        ("exposure", format!("{exposure:?}")),
        ("tone_curve", format!("{tone_curve:?}")),
        ("light_rotation", format!("{light_rotation:?}")),
        ("deviation_in", format!("{deviation_in:?}")),
        ("curvature_kind", format!("{curvature_kind:?}")),
        ("curvature_scale", format!("{curvature_scale:?}")),
        ("zebra_stripes", format!("{zebra_stripes:?}")),
        ("zebra_direction", format!("{zebra_direction:?}")),
        ("checker_squares", format!("{checker_squares:?}")),
        ("texel_density_per", format!("{texel_density_per:?}")),
        ("matcap", format!("{matcap:?}")),
        ("split", format!("{split:?}")),
        ("split_view", format!("{split_view:?}")),
        ("split_left", format!("{left:?}")),
        ("split_looks", format!("{left_looks:?}")),
        ("section", format!("{section:?}")),
        ("section_at", format!("{section_at:?}")),
        ("background", format!("{background:?}")),
        ("mesh_normals", format!("{mesh_normals:?}")),
        ("crease_angle", format!("{crease_angle:?}")),
        ("up", format!("{up:?}")),
        ("unit", format!("{unit:?}")),
        ("show_hidden", format!("{show_hidden:?}")),
        ("subdivide", format!("{subdivide:?}")),
        ("levels", format!("{levels:?}")),
        ("subdivide_uvs", format!("{subdivide_uvs:?}")),
    ]
}

/// The fields that differ.
fn changed(a: &Settings, b: &Settings) -> Vec<&'static str> {
    fields(a).into_iter().zip(fields(b)).filter(|(a, b)| a != b).map(|(a, _)| a.0).collect()
}

/// A value that isn't the default.
fn another(declaration: &Declaration) -> Value {
    match &declaration.kind {
        Kind::Choice(all) => {
            let usual = declaration.default();
            all().iter().map(|value| Value::Name(value.name)).find(|value| *value != usual).expect("two values")
        }
        Kind::Several(all) => Value::Names(vec![all()[0].name]),
        Kind::Number(range) | Kind::NameOrNumber { range, .. } => Value::Number(range.most),
        Kind::Pair(range) => Value::Pair([range.least, range.most]),
        Kind::Switch => Value::Switch(declaration.default() == Value::Switch(false)),
        Kind::Color => Value::Color([1, 2, 3]),
        Kind::Options(all) => {
            Value::Options([0, 9].map(|place| all()[place]).map(|option| (option.name, another(option))).to_vec())
        }
    }
}

#[test]
fn every_field_is_reached_by_exactly_one_declaration() {
    let mut reached = Vec::new();
    for declaration in all() {
        let mut settings = Settings::usual();
        assert!(declaration.set(&mut settings, another(declaration)), "{}", declaration.name);
        let fields = changed(&settings, &Settings::usual());
        let expected = if matches!(declaration.kind, Kind::Pair(_)) { 2 } else { 1 };
        assert_eq!(fields.len(), expected, "{} sets {fields:?}", declaration.name);
        assert!(
            declaration.members().is_empty() || declaration.members() == fields,
            "saved settings call {} by its fields",
            declaration.name
        );
        reached.extend(fields);
    }
    let all: Vec<_> = fields(&Settings::default()).into_iter().map(|(name, _)| name).collect();
    assert_eq!(reached.iter().collect::<BTreeSet<_>>(), all.iter().collect());
    assert_eq!(reached.len(), all.len(), "each field once: {reached:?}");
}

#[test]
fn names_are_unique_and_texts_are_sentences() {
    let names: BTreeSet<_> = all().map(|declaration| declaration.name).collect();
    assert_eq!(names.len(), all().count());
    let labels: BTreeSet<_> = all().map(|declaration| declaration.label).collect();
    assert_eq!(labels.len(), all().count());
    for Declaration { name, label, text, kind, unset, placeholder, .. } in all() {
        assert!(text.ends_with('.') && text.contains(' '), "{name}: {text}");
        assert!(!name.contains('_') && !label.is_empty(), "{name}");
        assert_eq!(placeholder.is_empty(), matches!(kind, Kind::Switch), "{name}");
        assert!(unset.is_none_or(|unset| unset.text.ends_with('.')), "{name}");
    }
}

#[test]
fn defaults_are_valid_and_written_values_parse_back() {
    for declaration in all() {
        for settings in [Settings::default(), Settings::opening()] {
            let value = declaration.get(&settings);
            let mut same = settings;
            assert!(declaration.set(&mut same, value.clone()), "{}: {value:?}", declaration.name);
            assert_eq!(same, settings, "{}", declaration.name);
        }
        let other = another(declaration);
        assert_eq!(declaration.kind.parse(&other.to_string()), Ok(other), "{}", declaration.name);
    }
}

#[test]
fn invalid_values_change_nothing() {
    let nan_and_beyond = |range: &Range| [f32::NAN, range.least - 0.001, range.most * 1.001, f32::INFINITY];
    for declaration in all() {
        let mut settings = Settings::default();
        let mut bad = match &declaration.kind {
            Kind::Number(range) | Kind::NameOrNumber { range, .. } => nan_and_beyond(range).map(Value::Number).to_vec(),
            Kind::Pair(range) => {
                let mut bad = nan_and_beyond(range).map(|far| Value::Pair([range.least, far])).to_vec();
                bad.extend([Value::Pair([8.0, 2.0]), Value::Pair([2.0, 2.0])]);
                bad
            }
            Kind::Switch => vec![Value::Number(1.0)],
            _ => vec![Value::Switch(true), Value::Name("odd"), Value::Names(vec!["odd"])],
        };
        if declaration.unset.is_none() {
            bad.push(Value::Unset);
        }
        for value in bad {
            assert!(!declaration.set(&mut settings, value.clone()), "{}: {value:?}", declaration.name);
        }
        assert_eq!(settings, Settings::default());
        // The length of a unit may be as large as these numbers.
        let may_be_large = matches!(declaration.kind, Kind::NameOrNumber { .. });
        let large = if may_be_large { ["1e10", "-1", "0", "1e300"] } else { ["1e9", "12345", "1234567", "+12345"] };
        for text in ["", "odd", "nan", "1,2,3"].into_iter().chain(large) {
            assert!(declaration.kind.parse(text).is_err(), "{}: {text:?}", declaration.name);
        }
    }
    let clash = Value::Names(vec!["factors", "barycentric"]);
    assert!(!OVERLAY.set(&mut Settings::default(), clash), "both colour the surface");
}

#[test]
fn unused_options_have_no_effect() {
    let idle = |settings: &Settings| -> Vec<_> {
        all().filter(|option| (option.no_effect)(settings).is_some()).map(|option| option.name).collect()
    };
    let lod = |lod| Settings::from(Tessellation { lod, ..Tessellation::default() });
    let elsewhere = [
        "height-scale",
        "midlevel",
        "normal-maps",
        "lights",
        "environment-brightness",
        "environment-background",
        "exposure",
        "tone-curve",
        "light-rotation",
        "deviation-in",
        "curvature-kind",
        "curvature-scale",
        "zebra-stripes",
        "zebra-direction",
        "checker-squares",
        "texel-density-per",
        "matcap",
        "split-view",
        "split-left",
        "split-looks",
        "section-at",
    ];
    let with = |own: &[&'static str]| -> Vec<_> { own.iter().copied().chain(elsewhere).collect() };
    for value in Lod::ALL {
        let own: &[_] = match value {
            Lod::Uniform => &["alpha", "pixels", "tolerance", "distances"],
            Lod::Distance => &["alpha", "pixels", "tolerance"],
            Lod::Paper | Lod::EdgeLength => &["alpha", "factor", "tolerance", "distances"],
            Lod::Error => &["alpha", "factor", "pixels", "distances"],
        };
        assert_eq!(idle(&lod(value)), with(own), "{value:?}");
    }
    let mut excess = lod(Lod::Paper);
    excess.overlays.colors = Colors::Excess;
    let mut expected = with(&["alpha", "factor", "distances"]);
    expected.insert(6, "lighting");
    assert_eq!(idle(&excess), expected);
    let mut phong_left = lod(Lod::Uniform);
    phong_left.tessellation.displacement = Displacement::On;
    phong_left.tessellation.partitioning = Partitioning::Subtriangulation;
    phong_left.overlays.colors = Colors::Deviation;
    phong_left.set_left_surface(Some(Surface::Phong));
    let of_light = [
        "lighting",
        "lights",
        "environment-brightness",
        "environment-background",
        "exposure",
        "tone-curve",
        "light-rotation",
    ];
    let of_looks = [
        "curvature-kind",
        "curvature-scale",
        "zebra-stripes",
        "zebra-direction",
        "checker-squares",
        "texel-density-per",
        "matcap",
    ];
    let with_light = |before: &[&'static str], after: &[&'static str]| [before, &of_light, &of_looks, after].concat();
    assert_eq!(
        idle(&phong_left),
        with_light(
            &["alpha", "lod", "pixels", "tolerance", "distances", "normals-at", "normal-maps"],
            &["split-view", "split-left", "split-looks", "section-at"]
        )
    );
    phong_left.split = Some(0.5);
    assert_eq!(
        idle(&phong_left),
        with_light(&["alpha", "lod", "pixels", "tolerance", "distances", "normals-at", "normal-maps"], &["section-at"])
    );
    for (colors, used) in [
        (Colors::Curvature, &of_looks[..2]),
        (Colors::Zebra, &of_looks[2..4]),
        (Colors::UvChecker, &of_looks[4..5]),
        (Colors::TexelDensity, &of_looks[5..6]),
        (Colors::Matcap, &of_looks[6..]),
    ] {
        phong_left.overlays.colors = colors;
        let idle = idle(&phong_left);
        assert!(of_looks.iter().all(|name| idle.contains(name) != used.contains(name)), "{colors:?}: {idle:?}");
    }
    phong_left.overlays.colors = Colors::Material;
    for lighting in [Lighting::Studio, Lighting::Environment] {
        phong_left.lighting = lighting;
        assert!(idle(&phong_left).iter().all(|name| !of_light.contains(name)), "all are used in light from all around");
    }
}

#[test]
fn values_are_read_or_refused() {
    assert_eq!(BACKGROUND.kind.parse("#ff8000"), Ok(Value::Color([255, 128, 0])));
    for bad in ["", "12345", "1234567", "gggggg", "+12345"] {
        assert!(BACKGROUND.kind.parse(bad).is_err(), "{bad}");
    }
    assert_eq!(DISTANCES.kind.parse("1.5, 8"), Ok(Value::Pair([1.5, 8.0])));
    for bad in ["2", "8,2", "2,2", "0,5", "2,1001", "nan,3", "2,3,4"] {
        assert!(DISTANCES.kind.parse(bad).is_err(), "{bad}");
    }
    assert_eq!(FACTOR.kind.parse("64"), Ok(Value::Number(64.0)));
    for bad in ["nan", "65", "0.5", "", "1,2", "inf"] {
        assert!(FACTOR.kind.parse(bad).is_err(), "{bad}");
    }
    assert_eq!(PARTITIONING.kind.parse("fractional_odd"), Ok(Value::Name("fractional-odd")));
    assert!(PARTITIONING.kind.parse("odd").is_err());
    assert_eq!(OVERLAY.kind.parse("cracks,back-faces"), Ok(Value::Names(vec!["cracks", "back-faces"])));
    assert!(OVERLAY.kind.parse("cracks,shadows").is_err());
}

proptest! {
    #[test]
    fn settings_are_the_values_of_their_options(settings in random::settings()) {
        let mut copy = Settings::default();
        for declaration in all() {
            let value = declaration.get(&settings);
            let is_written = value != Value::Unset && value != Value::Names(Vec::new());
            if is_written {
                prop_assert_eq!(declaration.kind.parse(&value.to_string()), Ok(value.clone()), "{}", declaration.name);
            }
            prop_assert!(declaration.set(&mut copy, value), "{}", declaration.name);
        }
        prop_assert_eq!(copy, settings);
    }
}
