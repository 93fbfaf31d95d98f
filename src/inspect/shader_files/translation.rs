//! WGSL functions in GLSL and HLSL, by naga, with the comments of the originals.

use std::collections::{BTreeSet, HashMap};

use naga::back::{glsl, hlsl};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use thiserror::Error;

use super::declarations::{Declaration, needed, words};

/// Why functions can't be translated: an error in our own shaders.
#[derive(Debug, Error)]
#[error("the shaders could not be translated ({0})")]
pub struct TranslationError(String);

/// The languages that stages are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StageLanguage {
    Glsl,
    Hlsl,
}

/// An entry point, which naga's writers want, and which is cut off again.
const ENTRY: &str = "@compute @workgroup_size(1)\nfn entry_of_translation() {\n}\n";

/// Returns structs, constants and functions in another language. Functions that `precise_roots` need are `precise`: no compiler
/// may fuse or reorder their operations.
///
/// # Errors
/// naga doesn't take them, which is an error in our own shaders.
pub(super) fn translated(
    language: StageLanguage,
    all: &[Declaration],
    precise_roots: &[&str],
) -> Result<String, TranslationError> {
    let source: String = all.iter().map(|declaration| declaration.text() + "\n").chain([ENTRY.to_owned()]).collect();
    let fault = |error: &dyn std::fmt::Display| TranslationError(error.to_string());
    let module = naga::front::wgsl::parse_str(&source).map_err(|error| fault(&error.emit_to_string(&source)))?;
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::default());
    let info = validator.validate(&module).map_err(|error| fault(&error.emit_to_string(&source)))?;
    let text = match language {
        StageLanguage::Glsl => glsl_text(&module, &info).map_err(|error| fault(&error))?,
        StageLanguage::Hlsl => hlsl_text(&module, &info).map_err(|error| fault(&error))?,
    };
    let text = without_temporaries(&text);
    let precise = needed(all, precise_roots).into_iter().filter(|own| own.is_function);
    Ok(annotated(declared_part(&text), all, &precise.map(|own| own.name).collect()))
}

fn glsl_text(module: &naga::Module, info: &naga::valid::ModuleInfo) -> Result<String, glsl::Error> {
    let options = glsl::Options {
        version: glsl::Version::Desktop(450),
        writer_flags: glsl::WriterFlags::empty(),
        ..glsl::Options::default()
    };
    let entry = glsl::PipelineOptions {
        shader_stage: naga::ShaderStage::Compute,
        entry_point: "entry_of_translation".to_owned(),
        multiview: None,
    };
    let mut text = String::new();
    let policies = naga::proc::BoundsCheckPolicies::default();
    glsl::Writer::new(&mut text, module, info, &options, &entry, policies)?.write()?;
    Ok(text)
}

fn hlsl_text(module: &naga::Module, info: &naga::valid::ModuleInfo) -> Result<String, hlsl::Error> {
    let options = hlsl::Options {
        shader_model: hlsl::ShaderModel::V5_0,
        restrict_indexing: false,
        force_loop_bounding: false,
        ..hlsl::Options::default()
    };
    let mut text = String::new();
    hlsl::Writer::new(&mut text, &options, &hlsl::PipelineOptions::default()).write(module, info, None)?;
    Ok(text)
}

/// Returns what lies between the header of naga's text and its entry point.
fn declared_part(text: &str) -> &str {
    let first = ["struct ", "const ", "static const "].iter().filter_map(|start| text.find(start)).min().unwrap_or(0);
    let entry = ["void main()", "[numthreads("].iter().filter_map(|start| text.find(start)).min().unwrap_or(text.len());
    text[first..entry].trim_end()
}

/// Names naga's temporaries, such as `_e68`, after the function whose result or the variable whose value each is.
fn without_temporaries(text: &str) -> String {
    let (mut names, mut counts) = (HashMap::<String, String>::new(), HashMap::<String, u32>::new());
    let mut named = String::new();
    for line in text.lines() {
        if line.starts_with('}') {
            names.clear();
            counts.clear();
        }
        if let Some((temporary, base)) = temporary(line) {
            let count = counts.entry(base.to_owned()).or_default();
            *count += 1;
            let number = if *count == 1 { String::new() } else { count.to_string() };
            names.insert(temporary.to_owned(), format!("{base}_value{number}"));
        }
        let mut rest = line;
        for (word, _) in words(line) {
            let (before, after) = rest.split_once(word).unwrap_or((rest, ""));
            named += before;
            named += names.get(word).map_or(word, String::as_str);
            rest = after;
        }
        named += rest;
        named.push('\n');
    }
    named
}

/// The temporary of naga's that a line declares, and the name of what it is made of.
fn temporary(line: &str) -> Option<(&str, &str)> {
    let (declared, value) = line.split_once(" = ")?;
    let is_temporary = |word: &&str| {
        let number = word.strip_prefix("_e").unwrap_or_default();
        !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())
    };
    // A type and a name: what is assigned to may have a temporary as its index.
    let names: Vec<&str> = words(declared.split('[').next()?).map(|(word, _)| word).collect();
    let temporary = names.last().copied().filter(|name| names.len() > 1 && is_temporary(name))?;
    let made_of = value.split(['(', '[']).find(|part| words(part).next().is_some())?;
    let is_name = |word: &&str| !word.starts_with(|c: char| c.is_ascii_digit());
    let base = words(made_of).map(|(word, _)| word).filter(is_name).last().unwrap_or("number");
    Some((temporary, base.trim_end_matches('_')))
}

/// naga's text with the comments of ours, and with `precise` in the functions of these names.
fn annotated(text: &str, all: &[Declaration], precise_names: &BTreeSet<String>) -> String {
    let mut lines: Vec<String> = Vec::new();
    let mut current: Option<&Declaration> = None;
    for line in text.lines().map(str::trim_end) {
        let line = &zeroed_array(line).or_else(|| constant_array(line)).unwrap_or_else(|| line.to_owned());
        let starts = line.starts_with(|c: char| c.is_ascii_alphabetic());
        if starts {
            current = declared(line, all);
            if line.starts_with("struct ") && lines.last().is_some_and(|last| !last.is_empty()) {
                lines.push(String::new());
            }
            lines.extend(current.iter().flat_map(|own| own.comment.clone()));
        }
        let is_blank_twice = line.is_empty() && lines.last().is_some_and(String::is_empty);
        // A member that only fills a struct up.
        let is_padding = ["int _pad", "int _end_pad"].iter().any(|start| line.trim_start().starts_with(start));
        if is_blank_twice || is_padding && current.is_none_or(|own| !UNIFORMS.contains(&own.name.as_str())) {
            continue;
        }
        match current {
            Some(own) if own.is_function && precise_names.contains(&own.name) => lines.push(precise(line)),
            Some(own) if !own.is_function && starts => lines.push(named_value(own, line)),
            Some(own) if !own.is_function => {
                lines.extend(member_comment(own, line).cloned());
                lines.push(line.to_owned());
            }
            _ => lines.push(line.to_owned()),
        }
    }
    lines.join("\n") + "\n"
}

/// The declaration that a line of naga's text begins: its struct, constant or function has the same name, except that names
/// that would be taken otherwise end in an underscore.
fn declared<'a>(line: &str, all: &'a [Declaration]) -> Option<&'a Declaration> {
    let names: Vec<_> = words(line).collect();
    let name = match names.first()?.0 {
        "struct" => names.get(1)?.0,
        "const" | "static" => words(line.split(" = ").next()?).last()?.0,
        _ => names.iter().find(|(_, is_called)| *is_called)?.0,
    };
    all.iter().find(|own| own.name == name || own.name == name.trim_end_matches('_'))
}

/// Returns a line of naga's HLSL that fills an array with zeros as one with an initializer list: glslang doesn't know the cast.
fn zeroed_array(line: &str) -> Option<String> {
    let (declared, cast) = line.split_once(" = (")?;
    let (element, count) = cast.strip_suffix("])0;")?.split_once('[')?;
    let zeros = vec![format!("({element})0"); count.parse().ok()?];
    Some(format!("{declared} = {{ {} }};", zeros.join(", ")))
}

/// Returns a line of naga's HLSL that declares a constant array as one with an initializer list: a global may call no function in
/// glslang.
fn constant_array(line: &str) -> Option<String> {
    let (declared, call) = line.strip_prefix("static const ")?.split_once(" = Constructarray")?;
    let (_, items) = call.strip_suffix(");")?.split_once('(')?;
    Some(format!("static const {declared} = {{ {items} }};"))
}

/// The structs that lie in a constant buffer, where HLSL needs naga's padding.
const UNIFORMS: [&str; 3] = ["HeightConstants", "LodView", "StageConstants"];

/// Returns a line of a constant with the name of its value, where ours has one: naga writes the number.
fn named_value(own: &Declaration, line: &str) -> String {
    let value = own.lines.first().and_then(|line| line.split_once(" = ")?.1.strip_suffix(';'));
    let value = value.filter(|value| value.starts_with(|c: char| c.is_ascii_uppercase()));
    match (value, line.split_once(" = ")) {
        (Some(value), Some((before, _))) => {
            let end = if value.ends_with(|c: char| c.is_ascii_digit()) { "_" } else { "" };
            format!("{before} = {value}{end};")
        }
        _ => line.to_owned(),
    }
}

/// The comment above a member of a struct, whose line in naga's text this is.
fn member_comment<'a>(own: &'a Declaration, line: &str) -> impl Iterator<Item = &'a String> {
    let name = line
        .trim()
        .strip_suffix(';')
        .and_then(|line| words(line).filter(|(word, _)| word.parse::<u32>().is_err()).last());
    let at = name.and_then(|(name, _)| {
        let start = format!("{}:", name.trim_end_matches('_'));
        own.lines.iter().position(|line| line.trim_start().starts_with(&start))
    });
    let before = &own.lines[..at.unwrap_or(0)];
    let count = before.iter().rev().take_while(|line| line.trim_start().starts_with("//")).count();
    before[before.len() - count..].iter()
}

/// Types whose computation may be fused.
const FLOATS: [&str; 9] = ["float", "vec2", "vec3", "vec4", "float2", "float3", "float4", "CurveNet", "HeightPlace"];

/// Returns a line that declares a number, or a function that returns one, as `precise`.
fn precise(line: &str) -> String {
    let code = line.trim_start();
    let (is_const, declared) = code.strip_prefix("const ").map_or((false, code), |rest| (true, rest));
    let is_float = |word: &str| FLOATS.contains(&word) || word.starts_with("ret_");
    let declares = words(declared).next().is_some_and(|(word, is_called)| is_float(word) && !is_called);
    if !declares {
        return line.to_owned();
    }
    let indent = &line[..line.len() - code.len()];
    format!("{indent}precise {}{declared}", if is_const { "const " } else { "" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn temporaries_are_named_after_what_they_are_made_of() {
        let text = "float f(float x)\n{\n    const float _e1 = g(x);\n    float _e22 = g(_e1);\n    vec3 _e3 = net.corners[0];\n    \
                    net.corners[_e1] = _e22;\n    return h(_e1, _e22) + _e3;\n}\nfloat g(float _e1x)\n{\n    const float _e1 = h(_e1x);\n    return _e1;\n}\n";
        let named = "float f(float x)\n{\n    const float g_value = g(x);\n    float g_value2 = g(g_value);\n    vec3 corners_value = \
                     net.corners[0];\n    net.corners[g_value] = g_value2;\n    return h(g_value, g_value2) + corners_value;\n}\nfloat g(float _e1x)\n{\n    const float \
                     h_value = h(_e1x);\n    return h_value;\n}\n";
        assert_eq!(without_temporaries(text), named);
    }
}
