#![no_main]

#[path = "../../fuzzed/bodies.rs"]
mod bodies;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    bodies::gltf(data, bodies::NOWHERE);
});
