//! Our shaders as files for other programs: vertex, hull and domain shaders in HLSL, their equals in GLSL, and compute passes in
//! WGSL.
//!
//! They are made from the files in `shaders/`: the functions that the options need, without the branches that the options never
//! take. What differs between languages, the inputs and outputs of the stages, is in `templates/`.

mod branches;
mod declarations;
mod displaced;
mod readme;
#[cfg(test)]
mod tests;
mod translation;

use thiserror::Error;

use geometry::tessellate::{Edges, Partitioning, Tessellation};
use gpu::WgslModule;

use crate::settings::{Choice, choices};
use branches::{Known, without_dead_branches};
use declarations::{Declaration, declarations, needed};
use displaced::{Relief, with_fetch, without_fetch};

use translation::{StageLanguage, TranslationError, translated};

/// What stages have in common, and the compute passes.
const STAGES: WgslModule = WgslModule("stage_displaced");
const PASSES: WgslModule = WgslModule("pass_exported");

choices! {
    /// A shading language.
    pub enum Language {
        Hlsl => "hlsl", "HLSL", "Vertex, hull and domain shader for Direct3D 11 and 12: patch.hlsl.";
        Glsl => "glsl", "GLSL", "The same stages for Vulkan and OpenGL: patch.vert, patch.tesc and patch.tese.";
        Wgsl => "wgsl", "WGSL", "Compute passes for WebGPU, which has no tessellation stages: tessellate.wgsl.";
    }
}

/// A file of an export.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShaderFile {
    pub name: &'static str,
    pub text: String,
}

/// Why a tessellation can't be exported.
#[derive(Debug, Error)]
pub enum ShaderError {
    /// The tessellator that the shaders run on can't do it.
    #[error("{what} can't be exported: {why}; choose {instead}")]
    Unexportable { what: &'static str, why: &'static str, instead: &'static str },
    /// An error in our own shaders.
    #[error(transparent)]
    Translation(#[from] TranslationError),
}

/// Returns the files of a tessellation's shaders in a language. `command` is the line that asks for them, which the files name.
///
/// # Errors
/// The language, or the hardware that it runs on, has no equal of the tessellation.
pub fn shader_files(
    language: Language,
    tessellation: &Tessellation,
    command: &str,
) -> Result<Vec<ShaderFile>, ShaderError> {
    check(language, tessellation)?;
    let export = Export { language, tessellation, command };
    let mut files = match language {
        Language::Glsl => export.glsl()?,
        Language::Hlsl => export.hlsl()?,
        Language::Wgsl => export.wgsl(),
    };
    files.push(ShaderFile { name: "README.md", text: readme::text(&export) });
    Ok(files)
}

/// Returns the number of indices that a patch of these shaders has: 3, 9 or 18.
pub fn indices_per_patch(language: Language, tessellation: &Tessellation) -> usize {
    if tessellation.displacement.is_on() {
        return 18;
    }
    let surface = tessellation.surface;
    // Where a surface tears, the sides of an edge have curves of different lengths, of which both take the longer one's factor.
    let takes_both = tessellation.edges == Edges::PerEdge && tessellation.used_lod().reads().control_points;
    let looks_across = if surface.tears() { takes_both } else { !surface.is_flat() };
    if looks_across || language == Language::Wgsl { 9 } else { 3 }
}

fn check(language: Language, tessellation: &Tessellation) -> Result<(), ShaderError> {
    let refuse = |what, why, instead| Err(ShaderError::Unexportable { what, why, instead });
    if tessellation.used_lod().is_by_error() {
        return refuse(
            "LOD by error",
            "it searches over all patches that share an edge",
            "--lod uniform, distance, edge-length or paper",
        );
    }
    let partitioning = tessellation.partitioning;
    if language == Language::Wgsl || Partitioning::DIRECT3D.contains(&partitioning) {
        return Ok(());
    }
    refuse(
        partitioning.name(),
        "hardware tessellators don't have the pattern",
        "--language wgsl, or --partitioning integer, pow2, fractional-odd or fractional-even",
    )
}

/// Returns the constants that a tessellation decides, each with the name of its value, as the shaders have them.
fn choices_of(own: &Tessellation) -> [(&'static str, String); 11] {
    fn constant(kind: &str, value: impl Choice) -> String {
        format!("{kind}_{}", value.name()).to_uppercase().replace('-', "_")
    }
    let is_displaced = own.displacement.is_on();
    // Displaced patches may show their fronts where the surface shows its back, so they are never culled.
    let culling = if own.cull_back_faces && !is_displaced { "CULLING_ON" } else { "CULLING_OFF" };
    [
        ("CHOSEN_SURFACE", constant("surface", own.surface)),
        ("CHOSEN_TEARING", if own.surface.tears() { "TEARING_ON" } else { "TEARING_OFF" }.to_owned()),
        ("CHOSEN_EDGES", constant("edges", own.edges)),
        ("CHOSEN_LOD", constant("lod", own.used_lod())),
        ("CHOSEN_PARTITIONING", constant("partitioning", own.partitioning)),
        ("CHOSEN_CLIP", constant("clip", own.clip)),
        ("CHOSEN_CULLING", culling.to_owned()),
        ("CHOSEN_CONVENTION", constant("convention", own.convention)),
        ("CHOSEN_NORMALS", constant("normals", own.normals)),
        ("CHOSEN_DISPLACEMENT", constant("displacement", own.displacement)),
        ("PATCH_INDICES", if is_displaced { "18u" } else { "9u" }.to_owned()),
    ]
}

/// What is exported.
struct Export<'a> {
    language: Language,
    tessellation: &'a Tessellation,
    command: &'a str,
}

/// The functions that a GLSL or HLSL stage calls.
const HULL_ROOTS: [&str; 5] =
    ["StageConstants", "ControlNet", "hull_side", "center_control_point", "tessellation_factors"];
const DOMAIN_ROOTS: [&str; 3] = ["StageConstants", "stage_vertex", "fixed_location"];
/// The functions that must give both sides of an edge the same bits.
const PRECISE_ROOTS: [&str; 8] = [
    "hull_side",
    "edge_position",
    "side_level",
    "corner_level",
    "shared_place",
    "moving_direction",
    "height_offset",
    "moved",
];
/// The functions that stages of a displaced surface call besides.
const DISPLACED_HULL_ROOTS: [&str; 4] = ["HeightConstants", "side_level", "level_inside", "segments_inside"];
const DISPLACED_DOMAIN_ROOTS: [&str; 2] = ["HeightConstants", "displaced_vertex"];
/// The functions that the compute shader calls which finds the levels at points.
const LEVELS_ROOTS: [&str; 5] = ["StageConstants", "HeightConstants", "hull_side", "side_level", "kept_level"];

impl Export<'_> {
    /// All declarations of our shaders with the choices made, and without the branches that they never take.
    fn declarations(&self, module: WgslModule) -> Vec<Declaration> {
        let choices = choices_of(self.tessellation);
        let of = |name: &str| choices.iter().find(|(own, _)| *own == name).map_or("", |(_, value)| value);
        let mut values: Vec<(&str, &str)> = choices.iter().map(|(name, value)| (*name, value.as_str())).collect();
        values.extend([
            ("surface", of("CHOSEN_SURFACE")),
            ("partitioning", of("CHOSEN_PARTITIONING")),
            ("convention", of("CHOSEN_CONVENTION")),
        ]);
        let mut false_conditions = Vec::new();
        if self.tessellation.partitioning != Partitioning::Rows {
            false_conditions.extend(["patch_has_rows(factors)", "plan.kind == PATTERN_ROWS"]);
        }
        if self.tessellation.partitioning != Partitioning::Subtriangulation {
            false_conditions.extend(["patch_is_subtriangulated(factors)", "plan.kind == PATTERN_SUBTRIANGULATED"]);
        }
        let known = Known { values: &values, false_conditions: &false_conditions };
        let mut all = declarations(&module.text());
        for own in &mut all {
            if own.is_function {
                own.lines = without_dead_branches(&own.lines, &known);
            } else if let Some((name, value)) = choices.iter().find(|(name, _)| own.name == *name) {
                own.lines = vec![format!("const {name}: u32 = {value};")];
                own.comment.clear();
            }
        }
        all
    }

    /// The functions that a file needs, in its language.
    fn functions(&self, language: StageLanguage, roots: &[&str]) -> Result<String, TranslationError> {
        let all = needed(&self.declarations(STAGES), roots);
        Ok(with_fetch(language, &translated(language, &without_fetch(all), &PRECISE_ROOTS)?))
    }

    /// The functions that the hull shader calls.
    fn hull_roots(&self) -> Vec<&'static str> {
        // How it gets the level at a point.
        let of_points: &[&str] = match self.relief() {
            Relief::Off => return HULL_ROOTS.to_vec(),
            Relief::UniformLod => &["corner_level"],
            Relief::LodByView => &["level_of"],
        };
        [&HULL_ROOTS[..], &DISPLACED_HULL_ROOTS, of_points].concat()
    }

    /// The functions that the domain shader calls.
    fn domain_roots(&self) -> Vec<&'static str> {
        let displaced = if self.relief() == Relief::Off { &[][..] } else { &DISPLACED_DOMAIN_ROOTS };
        [&DOMAIN_ROOTS[..], displaced].concat()
    }

    /// How both languages call the partitioning, which has this name if it isn't fractional.
    fn spacing(&self, whole: &'static str) -> &'static str {
        match self.tessellation.partitioning {
            Partitioning::FractionalOdd => "fractional_odd",
            Partitioning::FractionalEven => "fractional_even",
            // `written_factor` has rounded the factors of pow2 already, and no stages have the patterns of our own.
            Partitioning::Integer | Partitioning::Pow2 | Partitioning::Subtriangulation | Partitioning::Rows => whole,
        }
    }

    fn relief(&self) -> Relief {
        Relief::new(self.tessellation)
    }

    fn glsl(&self) -> Result<Vec<ShaderFile>, TranslationError> {
        let functions = |roots: &[&str]| self.functions(StageLanguage::Glsl, roots);
        let across = match self.indices() {
            3 => "own",
            _ => "SideNormals(vertex_normal[3 + 2 * k], vertex_normal[4 + 2 * k])",
        };
        let control = self.filled(include_str!("templates/patch.tesc"), &functions(&self.hull_roots())?);
        let evaluation = self.filled(include_str!("templates/patch.tese"), &functions(&self.domain_roots())?);
        let mut files = vec![
            ShaderFile { name: "patch.vert", text: self.filled(include_str!("templates/patch.vert"), "") },
            ShaderFile { name: "patch.tesc", text: control.replace("@ACROSS@", across) },
            ShaderFile { name: "patch.tese", text: evaluation.replace("@SPACING@", self.spacing("equal")) },
        ];
        if self.relief() == Relief::LodByView {
            let text = self.filled(include_str!("templates/levels.comp"), &functions(&LEVELS_ROOTS)?);
            files.push(ShaderFile { name: "levels.comp", text });
        }
        Ok(files)
    }

    fn hlsl(&self) -> Result<Vec<ShaderFile>, TranslationError> {
        let functions = |roots: &[&str]| self.functions(StageLanguage::Hlsl, roots);
        let (at_a, at_b) = match self.indices() {
            3 => ("own.at_a", "own.at_b"),
            _ => ("corners[3 + 2 * k].normal", "corners[4 + 2 * k].normal"),
        };
        let roots = [self.hull_roots(), self.domain_roots()].concat();
        let text = self
            .filled(include_str!("templates/patch.hlsl"), &functions(&roots)?)
            .replace("@PARTITIONING@", self.spacing("integer"))
            .replace("@ACROSS_A@", at_a)
            .replace("@ACROSS_B@", at_b);
        let mut files = vec![ShaderFile { name: "patch.hlsl", text }];
        if self.relief() == Relief::LodByView {
            let text = self.filled(include_str!("templates/levels.hlsl"), &functions(&LEVELS_ROOTS)?);
            files.push(ShaderFile { name: "levels.hlsl", text });
        }
        Ok(files)
    }

    fn wgsl(&self) -> Vec<ShaderFile> {
        let texts = needed(&self.declarations(PASSES), &["hull_main", "offsets_main", "emit_main"]);
        let mut text = readme::header(self);
        let mut before: Option<&Declaration> = None;
        for own in &texts {
            // Constants without comments stand together.
            let is_list = before.is_some_and(|before| [before, own].iter().all(|own| own.text().lines().count() == 1));
            text += if is_list { "" } else { "\n" };
            text += &own.text();
            before = Some(own);
        }
        vec![ShaderFile { name: "tessellate.wgsl", text }]
    }

    fn filled(&self, template: &str, functions: &str) -> String {
        self.relief()
            .chosen_lines(template)
            .replace("@HEADER@", readme::header(self).trim_end())
            .replace("@FUNCTIONS@", functions.trim_end())
            .replace("@INDICES@", &self.indices().to_string())
    }

    fn indices(&self) -> usize {
        indices_per_patch(self.language, self.tessellation)
    }
}
