//! Keeps the compiler's version for pages that say where something was measured.

use std::process::Command;

fn main() {
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let version = Command::new(compiler).arg("--version").output().ok();
    let version = version.and_then(|output| String::from_utf8(output.stdout).ok());
    emit(&format!("cargo:rustc-env=TEETER_RUSTC={}", version.as_deref().unwrap_or("unknown").trim()));
    emit("cargo:rerun-if-changed=build.rs");
}

/// Cargo listens on standard output.
#[allow(clippy::print_stdout)]
fn emit(line: &str) {
    println!("{line}");
}
