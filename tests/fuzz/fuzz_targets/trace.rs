//! See `gz_tests::fuzz::trace`.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| gz_tests::fuzz::trace(data));
