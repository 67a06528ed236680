//! Programs in Structured Text; see `stillpoint_tests::fuzz`.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    stillpoint_tests::fuzz::run("safe_logic", data);
});
