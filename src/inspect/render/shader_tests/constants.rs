//! Tests that every constant in both Rust and WGSL has the same value in both. Those of enums are written from Rust:
//! `gpu::shader_constants`.

use std::collections::BTreeMap;

use super::modules;
use crate::for_tests::reflectance::{COAT_F0, LEAST_ALPHA};
use crate::for_tests::tone::{COMPRESSION_START, DESATURATION};
use crate::render::blur_levels::{ENVIRONMENT_LEVELS, IRRADIANCE_LEVEL};
use crate::render::camera::FIELD_OF_VIEW;
use crate::render::coverage::TILE;
use crate::render::dfg::DFG_SIZE;
use crate::render::draws::LayerDraw;
use crate::render::layout::{
    AXIS_COLORS, BACK_FACE_COLOR, CHECKER_LIGHT, CHECKER_LINE, CHECKER_U, CHECKER_V, COMPARED_BIT, FOLD_COLOR,
    FOUND_EMITTED, LEAST_SEEN, NORMAL_COLOR, SECTION_BIT, SECTION_COLOR, TEXELS_WITHOUT_IMAGE, WASTE_COLOR, edge_color,
    linear, overlay_bits,
};
use crate::render::matcap::MATCAP_REACH;
use crate::render::mipmap_pass::ALPHAS;
use crate::render::needs::BEHIND;
use crate::render::scale::Scale;
use crate::render::sheen::LEAST_SHEEN_ALPHA;
use crate::settings::{Colors, Overlays, ToneCurve};
use crate::shot::DIFFERENCE_FLOOR;
use geometry::mesh::{EdgeKind, HEIGHTS_ACROSS, MAX_MAPS, MOST_LIGHTS, PartStyle, RELIEF_STEPS, Slot};
use geometry::tessellate::shared_constants::{
    AGREEING, BEYOND_LAST, BITS_63, BITS_64, BITS_127, BITS_1792, BITS_INFINITY, BITS_ONE, BITS_ONE_AND_HALF_STEP,
    BITS_ONE_AND_STEP, BITS_TWO, BOUND_SHARE, CANCELLED, DIRECTION_ROUNDING, FACING_AWAY, FACING_MARGIN,
    FACING_ROUNDING, FACTOR_ODD, FACTOR_VALUE, FINEST_GRID, FIXED_HALF, FIXED_ONE, FIXED_TWO_THIRDS, FLAT_ANGLE,
    LESSENINGS, MOST_ROWS, NEEDED_SHARE, NOT_CULLED, OUT_OF_VIEW, PARALLEL, PARTIAL_STEPS, PATTERN_HALVES,
    PATTERN_STEPS, POLAR_INDICES, POLAR_WEIGHTS, REQUESTED_SEGMENT, ROW_BASE_SHIFT, ROW_BASE_STEP, ROW_FLIP_SHIFT,
    ROW_REACH, ROW_SAMPLES, ROWS, SPREAD, SUBTRIANGULATED, TOGETHER, TWO_POINTS, UNIT,
};
use gpu::domain::{DOMAIN_POINTS, DOMAIN_TRIANGLES};
use gpu::layout::LOD_GIVEN;
use gpu::shader_constants::enum_constants;
use gpu::{
    CURVE_SURFACE_STEP, DETAIL_STEP, GRID_WIDTH, MANY_PATCHES, MOST_WORKGROUPS, SEARCH_COUNTERS, TEXTURED, WORKGROUP,
};

/// Constants that only WGSL has, with the reason.
const WGSL_ALONE: &[(&[&str], &str)] = &[
    (
        &[
            "CHOSEN_SURFACE",
            "CHOSEN_TEARING",
            "CHOSEN_EDGES",
            "CHOSEN_LOD",
            "CHOSEN_PARTITIONING",
            "CHOSEN_CLIP",
            "CHOSEN_CULLING",
            "CHOSEN_CONVENTION",
            "CHOSEN_NORMALS",
            "CHOSEN_DISPLACEMENT",
            "PATCH_INDICES",
            "CULLING_OFF",
            "CULLING_ON",
            "TEARING_OFF",
            "TEARING_ON",
            "EXPORTED_WORKGROUP",
            "SCAN_WORKGROUP",
        ],
        "only exported shaders have them",
    ),
    (
        &["PATTERN_RINGS", "PATTERN_MINIMAL", "PATTERN_SUBTRIANGULATED", "PATTERN_ROWS"],
        "in Rust, an enum without numbers",
    ),
    (&["AT_CORNER", "ON_SIDE", "INSIDE"], "in Rust, an enum without numbers"),
    (&["GOAL_REQUESTS", "GOAL_MINIMUM", "GOAL_GIVEN"], "in Rust, an enum without numbers"),
    (&["FOUND_SOURCE"], "in Rust, any number other than 0 and FOUND_EMITTED means the same"),
    (&["NO_PATCH", "NO_MORE"], "markers within one pass, or within one word that no other pass reads"),
    (
        &["VERTEX_WORKGROUP", "TRIANGLE_WORKGROUP", "LANES"],
        "how one pass divides its work; it is dispatched indirectly",
    ),
    (
        &["WORK_PIECE", "MOST_WORK", "MOST_WORK_OF_ALL"],
        "how much work functions of the user's own may be, which only the device counts",
    ),
    (&["LEANS"], "how an integral is divided; tests compare it with the integral"),
    (&["LARGE"], "how one pass divides its work; no result depends on it"),
    (
        &[
            "LARGE_PATCHES",
            "LIST_COUNTERS",
            "REQUESTING",
            "GIVEN",
            "SMALL_PATCHES",
            "WORKGROUPS_DONE",
            "SEARCHES_OVER",
            "TRIANGLES",
            "NOT_TAKEN",
        ],
        "counters of passes",
    ),
    (&["TILE_WORDS", "ROUNDS"], "follow from TILE"),
    (
        &[
            "NEARER",
            "HIDDEN",
            "NORMAL_LENGTH",
            "NORMAL_HALF_WIDTH",
            "NORMAL_SPACING",
            "DENSE",
            "SPARSE",
            "WIRE_COLOR",
            "LEFT_WIRE_COLOR",
            "RIGHT_WIRE_COLOR",
        ],
        "how lines look",
    ),
    (
        &[
            "CLAY_COLOR",
            "CLAY_UNDER_OUTLINES",
            "ZEBRA_DARK",
            "ZEBRA_LIGHT",
            "CHECKER_DARK",
            "GLYPHS",
            "GLYPH_F",
            "SQUARE_CELLS",
        ],
        "how the surface looks",
    ),
    (&["LEAST_TANGENT"], "only draws read normal maps"),
    (&["SAMPLE_PLACES"], "only draws have samples"),
    (&["GROUND_REACH", "GROUND_FADES_FROM", "GROUND_COLOR", "GROUND_OPACITY"], "how the ground looks"),
];

/// The components of a constant, and by how much each may differ.
struct Expected(Vec<f64>, f64);

/// A single number, without tolerance.
fn number(value: impl Into<f64>) -> Expected {
    Expected(vec![value.into()], 0.0)
}

fn numbers<T: Into<f64>>(values: impl IntoIterator<Item = T>) -> Expected {
    Expected(values.into_iter().map(Into::into).collect(), 0.0)
}

/// An sRGB colour. WGSL has it in linear light with three decimals.
fn color(srgb: [u8; 3]) -> Expected {
    Expected(linear(srgb).map(f64::from).to_vec(), 0.0006)
}

fn overlay(overlays: Overlays) -> Expected {
    number(overlay_bits(&overlays))
}

fn colors(colors: Colors) -> Expected {
    overlay(Overlays { colors, ..Overlays::default() })
}

/// Every constant of both languages, with its name in WGSL and its value in Rust.
fn table() -> Vec<(&'static str, Expected)> {
    let none = Overlays::default();
    let mut table = of_the_mathematics();
    table.extend([
        ("LOD_GIVEN", number(LOD_GIVEN)),
        ("LAYER_OVER", number(LayerDraw::Over as u32)),
        ("LAYER_FILTER", number(LayerDraw::Filter as u32)),
        ("LAYER_ADD", number(LayerDraw::Add as u32)),
        ("MAP_COUNT", number(Slot::COUNT as u32)),
        ("BEHIND", number(BEHIND as u32)),
        ("MAX_MAPS", number(MAX_MAPS as u32)),
        ("WORKGROUP", number(WORKGROUP)),
        ("GRID_WIDTH", number(GRID_WIDTH)),
        ("HEIGHTS_ACROSS", number(HEIGHTS_ACROSS)),
        ("DOMAIN_POINTS", number(DOMAIN_POINTS as u32)),
        ("DOMAIN_TRIANGLES", number(DOMAIN_TRIANGLES as u32)),
        ("TILE", number(TILE)),
        ("PI", number(std::f32::consts::PI)),
        ("ENVIRONMENT_LEVELS", number(ENVIRONMENT_LEVELS)),
        ("IRRADIANCE_LEVEL", number(IRRADIANCE_LEVEL)),
        ("DFG_SIZE", number(DFG_SIZE)),
        ("MOST_LIGHTS", number(MOST_LIGHTS as u32)),
        ("HALF_VIEW", Expected(vec![f64::from(0.5 * FIELD_OF_VIEW).to_radians().tan()], 1e-7)),
        ("TONE_CURVE_NEUTRAL", number(ToneCurve::Neutral as u32)),
        ("TONE_CURVE_NONE", number(ToneCurve::None as u32)),
        ("COMPRESSION_START", number(COMPRESSION_START)),
        ("DESATURATION", number(DESATURATION)),
        ("COAT_F0", number(COAT_F0)),
        ("LEAST_ALPHA", number(LEAST_ALPHA)),
        ("LEAST_SHEEN_ALPHA", number(LEAST_SHEEN_ALPHA)),
        ("LEAST_SEEN", number(LEAST_SEEN)),
        ("ALPHAS", number(ALPHAS)),
        ("SCALE_STOPS", number(Scale::STOPS as u32)),
        ("FOUND_EMITTED", number(FOUND_EMITTED)),
        ("OVERLAY_WIREFRAME", overlay(Overlays { wireframe: true, ..none })),
        ("OVERLAY_PATCHES", overlay(Overlays { patches: true, ..none })),
        ("OVERLAY_ADJACENCY", overlay(Overlays { adjacency: true, ..none })),
        ("OVERLAY_FOLDS", overlay(Overlays { folds: true, ..none })),
        ("OVERLAY_BACK_FACES", overlay(Overlays { back_faces: true, ..none })),
        ("OVERLAY_SECTION", number(SECTION_BIT)),
        ("OVERLAY_COMPARED", number(COMPARED_BIT)),
        ("OVERLAY_BARYCENTRIC", colors(Colors::Barycentric)),
        ("OVERLAY_FACTORS", colors(Colors::Factors)),
        ("OVERLAY_TRIANGLE_SIZE", colors(Colors::TriangleSize)),
        ("OVERLAY_LOW_FACTORS", colors(Colors::LowFactors)),
        ("OVERLAY_EXCESS", colors(Colors::Excess)),
        ("OVERLAY_CLAY", colors(Colors::Clay)),
        ("OVERLAY_SILHOUETTE", colors(Colors::Silhouette)),
        ("OVERLAY_ZEBRA", colors(Colors::Zebra)),
        ("OVERLAY_SHADING_NORMALS", colors(Colors::ShadingNormals)),
        ("OVERLAY_UV_CHECKER", colors(Colors::UvChecker)),
        ("OVERLAY_DEVIATION", colors(Colors::Deviation)),
        ("LOOK_SURFACE_NORMALS", number(Colors::SurfaceNormals as u32)),
        ("LOOK_CURVATURE", number(Colors::Curvature as u32)),
        ("LOOK_MATCAP", number(Colors::Matcap as u32)),
        ("LOOK_TEXEL_DENSITY", number(Colors::TexelDensity as u32)),
        ("TEXELS_WITHOUT_IMAGE", number(TEXELS_WITHOUT_IMAGE)),
        ("MATCAP_REACH", number(MATCAP_REACH)),
        ("FOLD_COLOR", color(FOLD_COLOR)),
        ("BACK_FACE_COLOR", color(BACK_FACE_COLOR)),
        ("SECTION_COLOR", color(SECTION_COLOR)),
        ("WASTE_COLOR", color(WASTE_COLOR)),
        ("NORMAL_COLOR", color(NORMAL_COLOR)),
        ("CHECKER_LIGHT", number(CHECKER_LIGHT)),
        ("CHECKER_U", numbers(CHECKER_U)),
        ("CHECKER_V", numbers(CHECKER_V)),
        ("CHECKER_LINE", color(CHECKER_LINE)),
        ("X_AXIS_COLOR", color(AXIS_COLORS[0])),
        ("Z_AXIS_COLOR", color(AXIS_COLORS[2])),
        // WGSL has this grey with two decimals.
        ("SMOOTH_EDGE_COLOR", Expected(color(edge_color(EdgeKind::Smooth)).0, 0.005)),
        ("SPLIT_EDGE_COLOR", color(edge_color(EdgeKind::Split))),
        ("SEAM_EDGE_COLOR", color(edge_color(EdgeKind::Seam))),
        ("BOUNDARY_EDGE_COLOR", color(edge_color(EdgeKind::Boundary))),
        ("NON_MANIFOLD_EDGE_COLOR", color(edge_color(EdgeKind::NonManifold))),
    ]);
    table
}

fn of_the_mathematics() -> Vec<(&'static str, Expected)> {
    vec![
        ("PARALLEL", number(PARALLEL)),
        ("UNIT", number(UNIT)),
        ("CANCELLED", number(CANCELLED)),
        ("FLAT_ANGLE", number(FLAT_ANGLE)),
        ("ROW_SAMPLES", numbers(ROW_SAMPLES)),
        ("FACING_MARGIN", number(FACING_MARGIN)),
        ("FACING_ROUNDING", number(FACING_ROUNDING)),
        ("POLAR_INDICES", numbers(POLAR_INDICES.map(|index| index as u32))),
        ("POLAR_WEIGHTS", numbers(POLAR_WEIGHTS)),
        ("NOT_CULLED", number(NOT_CULLED)),
        ("OUT_OF_VIEW", number(OUT_OF_VIEW)),
        ("FACING_AWAY", number(FACING_AWAY)),
        ("AGREEING", number(AGREEING)),
        ("TWO_POINTS", number(TWO_POINTS)),
        ("BEYOND_LAST", number(BEYOND_LAST)),
        ("BOUND_SHARE", number(BOUND_SHARE)),
        ("ROW_REACH", number(ROW_REACH)),
        ("FINEST_GRID", number(FINEST_GRID)),
        ("PARTIAL_STEPS", number(PARTIAL_STEPS)),
        ("MANY_PATCHES", number(MANY_PATCHES)),
        ("MOST_WORKGROUPS", number(MOST_WORKGROUPS)),
        ("SEARCH_COUNTERS", number(SEARCH_COUNTERS)),
        ("SPREAD", number(SPREAD)),
        ("REQUESTED_SEGMENT", number(REQUESTED_SEGMENT)),
        ("LESSENINGS", number(LESSENINGS)),
        ("TOGETHER", number(TOGETHER)),
        ("DIRECTION_ROUNDING", number(DIRECTION_ROUNDING)),
        ("NEEDED_SHARE", number(NEEDED_SHARE)),
        ("RELIEF_STEPS", number(RELIEF_STEPS as u32)),
        ("TEXTURED", number(TEXTURED)),
        ("DETAIL_STEP", number(DETAIL_STEP)),
        ("LEAST_DETAIL", number(PartStyle::LEAST)),
        ("CURVE_SURFACE_STEP", number(CURVE_SURFACE_STEP)),
        ("FIXED_ONE", number(FIXED_ONE)),
        ("FIXED_HALF", number(FIXED_HALF)),
        ("FIXED_TWO_THIRDS", number(FIXED_TWO_THIRDS)),
        ("FACTOR_ODD", number(FACTOR_ODD)),
        ("FACTOR_VALUE", number(FACTOR_VALUE)),
        ("SUBTRIANGULATED", number(SUBTRIANGULATED)),
        ("ROWS", number(ROWS)),
        ("ROW_BASE_SHIFT", number(ROW_BASE_SHIFT)),
        ("ROW_BASE_STEP", number(ROW_BASE_STEP)),
        ("ROW_FLIP_SHIFT", number(ROW_FLIP_SHIFT)),
        ("BITS_127", number(BITS_127)),
        ("BITS_1792", number(BITS_1792)),
        ("MOST_ROWS", number(MOST_ROWS)),
        ("BITS_ONE", number(BITS_ONE)),
        ("BITS_TWO", number(BITS_TWO)),
        ("BITS_63", number(BITS_63)),
        ("BITS_64", number(BITS_64)),
        ("BITS_INFINITY", number(BITS_INFINITY)),
        ("BITS_ONE_AND_HALF_STEP", number(BITS_ONE_AND_HALF_STEP)),
        ("BITS_ONE_AND_STEP", number(BITS_ONE_AND_STEP)),
        ("PATTERN_HALVES", number(PATTERN_HALVES)),
        ("PATTERN_STEPS", number(PATTERN_STEPS)),
        ("DIFFERENCE_FLOOR", number(DIFFERENCE_FLOOR)),
    ]
}

/// Collects the components of a constant expression that naga has evaluated.
fn components(module: &naga::Module, value: naga::Handle<naga::Expression>, out: &mut Vec<f64>) {
    match &module.global_expressions[value] {
        naga::Expression::Literal(naga::Literal::F32(value)) => out.push((*value).into()),
        naga::Expression::Literal(naga::Literal::U32(value)) => out.push((*value).into()),
        naga::Expression::Literal(naga::Literal::I32(value)) => out.push((*value).into()),
        naga::Expression::Compose { components: parts, .. } => {
            parts.iter().for_each(|part| components(module, *part, out));
        }
        naga::Expression::Constant(constant) => components(module, module.constants[*constant].init, out),
        other => panic!("a constant of a kind that this test doesn't know: {other:?}"),
    }
}

/// The constants of all shaders by name, but for the enums' numbers, which are written from Rust.
fn wgsl_constants() -> BTreeMap<String, Vec<f64>> {
    let mut all = BTreeMap::new();
    let of_enums: String = shaders::TEXTS.iter().map(|(file, _)| enum_constants(file)).collect();
    for (file, module) in modules() {
        for (_, constant) in module.constants.iter() {
            let Some(name) = constant.name.clone() else { continue };
            if of_enums.contains(&format!("const {name}:")) {
                continue;
            }
            let mut values = Vec::new();
            components(module, constant.init, &mut values);
            let known = all.entry(name.clone()).or_insert_with(|| values.clone());
            assert_eq!(*known, values, "{name} in {}", file.0);
        }
    }
    all
}

#[test]
fn constants_of_both_languages_are_equal() {
    let wgsl = wgsl_constants();
    for (name, Expected(rust, tolerance)) in table() {
        let Some(found) = wgsl.get(name) else { panic!("no shader has {name}") };
        assert_eq!(found.len(), rust.len(), "components of {name}");
        let is_near = |(a, b): (&f64, &f64)| (a - b).abs() <= tolerance;
        assert!(found.iter().zip(&rust).all(is_near), "{name} is {found:?} in WGSL and {rust:?} in Rust");
    }
}

#[test]
fn every_constant_of_the_shaders_is_compared_or_listed() {
    let (wgsl, table) = (wgsl_constants(), table());
    let alone: Vec<_> = WGSL_ALONE.iter().flat_map(|(names, _)| names.iter().copied()).collect();
    for name in wgsl.keys() {
        let compared = table.iter().filter(|(known, _)| known == name).count();
        let listed = alone.iter().filter(|known| *known == name).count();
        assert_eq!(compared + listed, 1, "{name} must be either in the table or in WGSL_ALONE, once");
    }
    for name in alone {
        assert!(wgsl.contains_key(name), "no shader has {name}");
    }
    assert!(WGSL_ALONE.iter().all(|(_, why)| !why.is_empty()));
}
