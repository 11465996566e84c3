#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| {
    zstrip_fuzz::shapes::run(input);
});
