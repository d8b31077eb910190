//! Which lanes side by side the package is built with, besides those that a processor is asked for.
//!
//! `avx512`: this compiler knows AVX-512's instructions; the lowest one that the package is built with does not.
//!
//! `plain`: plain arrays, where a compiler makes vectors of them that are faster than one contact after the other: on aarch64, and
//! on WebAssembly if it is told of `simd128`. Not on 32-bit x86, nor on x86_64 without AVX2, which then lacks products and
//! comparisons of signed numbers.
//!
//! To compare builds by, RUSTFLAGS may hold `--cfg tamias_lanes="avx2"`, which leaves AVX-512 out, `"plain"`, with which there are
//! no others on any machine, or `"none"`, with which worlds are solved one contact after the other. No bit depends on it.

use std::env;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(tamias_lanes, values(\"avx2\", \"plain\", \"none\"))");
    autocfg::emit_possibility("avx512");
    autocfg::emit_possibility("plain");
    let told = env::var("CARGO_CFG_TAMIAS_LANES").ok();
    if told.is_none() && autocfg::new().probe_rustc_version(1, 89) {
        autocfg::emit("avx512");
    }
    let plain = match env::var("CARGO_CFG_TARGET_ARCH").as_deref() {
        Ok("aarch64") => true,
        Ok("wasm32") => {
            env::var("CARGO_CFG_TARGET_FEATURE").is_ok_and(|all| all.split(',').any(|one| one == "simd128"))
        }
        _ => false,
    };
    if told.as_deref() == Some("plain") || told.is_none() && plain {
        autocfg::emit("plain");
    }
}
