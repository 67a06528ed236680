//! Telegrams of SINAMICS S120; see `stillpoint_tests::fuzz`.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    stillpoint_tests::fuzz::run("telegram", data);
});
