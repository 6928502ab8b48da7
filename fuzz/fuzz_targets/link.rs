#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| interwell_fuzz::promises::link(bytes));
