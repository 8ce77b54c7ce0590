//! See `gz_tests::fuzz::build_tree`.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| gz_tests::fuzz::build_tree(data));
