#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    tamias2d_fuzz::snapshot::run(data);
});
