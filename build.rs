//! Whether this compiler knows AVX-512's instructions: the lowest one that the package is built with does not.
//!
//! To compare builds by, RUSTFLAGS may hold `--cfg tamias_lanes="avx2"`, which leaves AVX-512 out, or
//! `--cfg tamias_lanes="none"`, with which worlds are solved one contact after the other. No bit depends on it.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(tamias_lanes, values(\"avx2\", \"none\"))");
    autocfg::emit_possibility("avx512");
    let fewer = std::env::var_os("CARGO_CFG_TAMIAS_LANES").is_some();
    if !fewer && autocfg::new().probe_rustc_version(1, 89) {
        autocfg::emit("avx512");
    }
}
