//! A drive of SINAMICS S120 on its bus; see `stillpoint_tests::fuzz`.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    stillpoint_tests::fuzz::run("drive", data);
});
