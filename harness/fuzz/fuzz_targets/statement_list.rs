//! Statement lists; see `stillpoint_tests::fuzz`.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    stillpoint_tests::fuzz::run("statement_list", data);
});
