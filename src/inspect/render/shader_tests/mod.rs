//! Tests what Rust and the shaders must agree on, and how shader modules are put together. No test here needs a device.

mod branches;
mod constants;
mod structs;

use std::collections::BTreeSet;
use std::sync::LazyLock;

use gpu;
use gpu::WgslModule;
use gpu::wgsl::joined;

/// Every shader module, parsed: those of files that no other file needs.
fn modules() -> &'static [(WgslModule, naga::Module)] {
    static MODULES: LazyLock<Vec<(WgslModule, naga::Module)>> = LazyLock::new(|| {
        let all = || shaders::TEXTS.iter().map(|&(name, _)| WgslModule(name));
        let needed: BTreeSet<_> =
            all().flat_map(|own| own.files().into_iter().filter(move |file| *file != own.0)).collect();
        let parse = |module: WgslModule| {
            let text = module.text();
            let error = |error: naga::front::wgsl::ParseError| panic!("{}: {}", module.0, error.emit_to_string(&text));
            (module, naga::front::wgsl::parse_str(&text).unwrap_or_else(error))
        };
        all().filter(|module| !needed.contains(module.0)).map(parse).collect()
    });
    &MODULES
}

#[test]
fn every_file_is_part_of_a_module_with_entry_points() {
    let without: Vec<_> = modules().iter().filter(|(_, parsed)| parsed.entry_points.is_empty()).collect();
    assert!(without.is_empty(), "{:?}", without.iter().map(|(module, _)| module).collect::<Vec<_>>());
    assert!(modules().len() > 20);
}

#[test]
fn every_module_is_valid_with_the_default_features_of_webgpu() {
    for (module, parsed) in modules() {
        let flags = naga::valid::ValidationFlags::all();
        let mut validator = naga::valid::Validator::new(flags, naga::valid::Capabilities::default());
        if let Err(error) = validator.validate(parsed) {
            panic!("{}: {}", module.0, error.emit_to_string(&module.text()));
        }
    }
}

#[test]
fn a_module_does_not_compile_without_any_of_its_files_or_lacks_entry_points() {
    for (module, whole) in modules() {
        let files = module.files();
        for left_out in files.iter().filter(|left_out| **left_out != module.0) {
            let others: Vec<_> = files.iter().copied().filter(|other| other != left_out).collect();
            let parsed = naga::front::wgsl::parse_str(&joined(&others));
            let is_whole = parsed.is_ok_and(|parsed| parsed.entry_points.len() == whole.entry_points.len());
            assert!(!is_whole, "{} compiles without {left_out}", module.0);
        }
    }
}
