//! Whether this compiler knows AVX-512's instructions: the lowest one that the package is built with does not.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    autocfg::emit_possibility("avx512");
    if autocfg::new().probe_rustc_version(1, 89) {
        autocfg::emit("avx512");
    }
}
