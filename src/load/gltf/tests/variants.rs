//! Material variants.

use super::*;
use crate::{LoadError, Source};

/// Two triangles of the material `own`. The first one has others for the variants `day` and `night`, and the third variant has no
/// name.
fn draft() -> Draft {
    let mut draft = triangle();
    let mappings = json!([{ "material": 1, "variants": [0] }, { "material": 2, "variants": [1, 2] }]);
    let primitive = &mut draft.root["meshes"][0]["primitives"][0];
    primitive["material"] = json!(0);
    let mut other = primitive.clone();
    primitive["extensions"] = json!({ "KHR_materials_variants": { "mappings": mappings } });
    other["extensions"] = json!({ "KHR_materials_variants": { "mappings": [{ "material": 99, "variants": [2] }] } });
    draft.primitive(other);
    draft.root["materials"] = json!([{ "name": "own" }, { "name": "bright" }, { "name": "dark" }]);
    let names = json!([{ "name": "day" }, { "name": "night" }, {}]);
    draft.root["extensions"] = json!({ "KHR_materials_variants": { "variants": names } });
    draft
}

fn loaded(draft: &Draft, variant: Option<&str>) -> LoadedMesh {
    let bytes = draft.document().to_string().into_bytes();
    read(
        bytes,
        &ModelFile {
            selected: Selection { variant, ..Selection::default() },
            ..ModelFile::from_test("draft", &Progress::new())
        },
    )
    .expect("triangles")
}

#[test]
fn primitives_have_the_materials_of_the_variant() {
    let cases = [
        (None, &["own"][..]),
        (Some("day"), &["bright", "own"]),
        (Some("night"), &["dark", "own"]),
        (Some("dusk"), &["own"]),
    ];
    for (variant, expected) in cases {
        let loaded = loaded(&draft(), variant);
        let names: Vec<_> = loaded.mesh.materials.iter().map(|material| material.name.as_str()).collect();
        assert_eq!(names, expected, "{variant:?}");
        assert_eq!(
            (&loaded.contents.variants[..], loaded.warnings.len()),
            (&["day", "night", "variant 2"].map(str::to_owned)[..], 0)
        );
    }
}

#[test]
fn faults_of_variants_are_repaired_and_told() {
    let with_fault = loaded(&draft(), Some("variant 2"));
    assert!(with_fault.warnings[0].contains("/meshes/0/primitives/1/material isn't one of the 3"), "{with_fault:?}");
    let mut none = draft();
    none.root["extensions"]["KHR_materials_variants"]["variants"] = json!("many");
    let loaded = loaded(&none, Some("day"));
    assert!(
        loaded.contents.variants.is_empty() && loaded.warnings[0].contains("variants isn't a list"),
        "{:?}",
        loaded.warnings
    );
}

#[test]
fn a_variant_that_is_not_there_is_an_error_with_the_names() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("lamp.gltf");
    std::fs::write(&path, draft().document().to_string()).expect("a writable temporary folder");
    let load = |source: Source, name| {
        source.load_selected(
            Selection { variant: Some(name), ..Selection::default() },
            &Limits::default(),
            &Progress::new(),
        )
    };
    assert_eq!(load(Source::File(path.clone()), "night").expect("a variant").mesh.materials.len(), 2);
    let error = load(Source::File(path), "Night").expect_err("another name");
    assert!(matches!(error, LoadError::Absent { what: "material variant", .. }));
    let said = error.to_string();
    assert!(said.ends_with("lamp.gltf has no material variant Night; choose one of day, night, variant 2"), "{said}");
    for source in [Source::Vase, "shape:torus".parse().expect("a shape")] {
        let said = load(source, "day").expect_err("it has none").to_string();
        assert!(said.ends_with("has no material variant day; it has no variants, so omit --variant"), "{said}");
    }
}
