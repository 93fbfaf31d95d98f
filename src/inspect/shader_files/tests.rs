//! What texts of exported shaders have, and what they leave out.

use super::*;
use geometry::tessellate::{Clip, Displacement, Lod, Surface};

/// All texts of the files that run on tessellation stages.
fn text(language: Language, own: &Tessellation) -> String {
    let files = shader_files(language, own, "a test").expect("it can be exported");
    files.into_iter().filter(|file| file.name != "README.md").map(|file| file.text).collect()
}

#[test]
fn what_is_off_is_left_out() {
    for language in Language::ALL {
        let culling = |clip, cull_back_faces| {
            let own = text(language, &Tessellation { clip, cull_back_faces, ..Tessellation::default() });
            ["patch_is_clipped(", "patch_is_outside(", "faces_away("].map(|name| own.contains(name))
        };
        assert_eq!(culling(Clip::Off, false), [false; 3], "{language:?}");
        assert_eq!(culling(Clip::Paper, false), [true, false, false], "{language:?}");
        assert_eq!(culling(Clip::Frustum, false), [false, true, false], "{language:?}");
        assert_eq!(culling(Clip::Off, true), [false, false, true], "{language:?}");
        assert_eq!(culling(Clip::Frustum, true), [false, true, true], "{language:?}");
    }
}

#[test]
fn nothing_has_a_name_that_says_nothing() {
    for language in [Language::Glsl, Language::Hlsl] {
        for surface in Surface::ALL {
            for lod in Lod::ALL.into_iter().filter(|lod| !lod.is_by_error()) {
                for displacement in [Displacement::Off, Displacement::On] {
                    let clip = Clip::Frustum;
                    let own = Tessellation {
                        surface,
                        lod,
                        displacement,
                        clip,
                        cull_back_faces: true,
                        ..Tessellation::default()
                    };
                    let own = text(language, &own);
                    let temporary = own.split("_e").skip(1).find(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
                    assert_eq!(
                        temporary.map(|rest| &rest[..rest.len().min(60)]),
                        None,
                        "{language:?} {surface:?} {lod:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn every_side_is_computed_by_an_invocation_of_its_own() {
    let own = text(Language::Hlsl, &Tessellation::default());
    let (_, after) = own.split_once("HullOutput hs_patch(").expect("the patch constant function");
    let (of_patch, of_corner) = after.split_once("HullCorner hs_main(").expect("the function of a control point");
    assert!(!of_patch.contains("hull_corner(") && !of_patch.contains("hull_side("), "{of_patch}");
    assert!(of_corner.contains("return hull_corner(corners, k);"), "{of_corner}");
}

#[test]
fn every_lod_that_can_be_exported_has_its_own_factor() {
    let of = |lod: Lod| shader_files(Language::Wgsl, &Tessellation { lod, ..Tessellation::default() }, "a test").ok();
    let factor = |lod| {
        let text = of(lod)?.into_iter().find(|file| file.name == "tessellate.wgsl")?.text;
        let (_, body) = text.split_once("fn edge_curve_factor(")?;
        Some(body.split_once("\n}")?.0.to_owned())
    };
    let factors: Vec<String> = Lod::ALL.iter().filter_map(|lod| factor(*lod)).collect();
    assert_eq!(factors.len(), Lod::ALL.len() - 1, "LOD by error can't be exported");
    for (i, own) in factors.iter().enumerate() {
        assert!(!factors[..i].contains(own) && !own.contains("return 0.0"), "{own}");
    }
}
