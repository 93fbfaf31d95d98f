//! Runs the target that the environment variable `PNAEN_FUZZ` names.
#![no_main]

#[path = "../../fuzzed/bodies.rs"]
mod bodies;

use load::format::Format;

macro_rules! run {
    ($($name:ident $copies:literal $body:expr;)+) => {
        fn run(target: &str, data: &[u8]) -> bool {
            match target {
                $(stringify!($name) => ($body)(data, bodies::NOWHERE),)+
                other => panic!("PNAEN_FUZZ names no target: {other:?}"),
            }
        }
    };
}

bodies::targets!(run);

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    run(&std::env::var("PNAEN_FUZZ").unwrap_or_default(), data);
});
