//! Tests what Rust and the shaders must agree on, and how shader modules are put together. No test here needs a device.

mod branches;
mod constants;
mod structs;

use std::sync::LazyLock;

use gpu;
use gpu::WgslFile;
use gpu::wgsl::joined;

/// Every shader module, parsed.
fn modules() -> &'static [(&'static WgslFile, naga::Module)] {
    static MODULES: LazyLock<Vec<(&WgslFile, naga::Module)>> = LazyLock::new(|| {
        let parse = |file: &'static WgslFile| {
            let text = file.module_text();
            let error = |error: naga::front::wgsl::ParseError| panic!("{}: {}", file.name, error.emit_to_string(&text));
            (file, naga::front::wgsl::parse_str(&text).unwrap_or_else(error))
        };
        gpu::MODULES.into_iter().chain(super::MODULES).chain(crate::shader_files::MODULES).map(parse).collect()
    });
    &MODULES
}

#[test]
fn every_module_is_valid_with_the_default_features_of_webgpu() {
    for (file, module) in modules() {
        let flags = naga::valid::ValidationFlags::all();
        let mut validator = naga::valid::Validator::new(flags, naga::valid::Capabilities::default());
        if let Err(error) = validator.validate(module) {
            panic!("{}: {}", file.name, error.emit_to_string(&file.module_text()));
        }
    }
}

#[test]
fn a_module_does_not_compile_without_any_of_its_files_or_lacks_entry_points() {
    for (file, module) in modules() {
        let files = file.module_files();
        for left_out in files.iter().filter(|left_out| left_out.name != file.name) {
            let others: Vec<_> = files.iter().copied().filter(|other| other.name != left_out.name).collect();
            let parsed = naga::front::wgsl::parse_str(&joined(&others));
            let is_whole = parsed.is_ok_and(|parsed| parsed.entry_points.len() == module.entry_points.len());
            assert!(!is_whole, "{} compiles without {}", file.name, left_out.name);
        }
    }
}

/// The names that a file declares for others. Every declaration in `shaders/` starts a line.
fn declared(file: &WgslFile) -> Vec<&'static str> {
    let name = |line: &'static str| {
        let rest = ["fn ", "struct ", "const ", "override ", "var<workgroup> "]
            .iter()
            .find_map(|start| line.strip_prefix(start));
        let rest = rest.or_else(|| line.strip_prefix("@group")?.split_once("> ").map(|(_, name)| name))?;
        rest.split(|c: char| !c.is_alphanumeric() && c != '_').next()
    };
    file.text.lines().filter_map(name).collect()
}

#[test]
fn a_file_lists_only_files_that_it_uses() {
    let files = modules().iter().flat_map(|(file, _)| file.module_files());
    for file in files {
        let code: Vec<_> = file.text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect();
        let uses = |name: &str| {
            code.iter().any(|line| line.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == name))
        };
        for needed in file.needs {
            // The file with the entry points may list a file that only other files of the module use.
            let mut rest = Vec::new();
            file.needs
                .iter()
                .filter(|other| other.name != needed.name)
                .for_each(|other| rest.extend(other.module_files()));
            let is_chosen = rest.iter().all(|other| other.name != needed.name);
            assert!(
                is_chosen || declared(needed).into_iter().any(uses),
                "{} uses nothing of {}",
                file.name,
                needed.name
            );
        }
    }
}

#[test]
fn every_file_is_part_of_a_module() {
    let used: Vec<_> = modules().iter().flat_map(|(file, _)| file.module_files()).map(|file| file.name).collect();
    for (name, _) in shaders::TEXTS {
        assert!(used.contains(name), "no module has {name}.wgsl");
    }
}

#[test]
fn every_file_name_is_used_once() {
    let mut files: Vec<_> = modules().iter().flat_map(|(file, _)| file.module_files()).collect();
    files.sort_by_key(|file| file.name);
    files.dedup_by(|a, b| std::ptr::eq(*a, *b));
    assert!(files.windows(2).all(|pair| pair[0].name != pair[1].name), "two statics have the same file");
}
