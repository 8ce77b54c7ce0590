//! See `gz_tests::fuzz::filter_soundness`.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| gz_tests::fuzz::filter_soundness(data));
