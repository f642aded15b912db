//! Has the linker keep one of several equal functions, if it can: the package is 2 % smaller.

use std::env;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

const OPTION: &str = "-Wl,--icf=all";

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    if knows_option().unwrap_or(false) {
        println!("cargo:rustc-cdylib-link-arg={OPTION}");
    }
}

/// Returns whether the linker takes the option: links an empty library with it.
fn knows_option() -> Option<bool> {
    let folder = PathBuf::from(env::var_os("OUT_DIR")?);
    let source = folder.join("empty.rs");
    fs::write(&source, "").ok()?;
    let mut rustc = Command::new(env::var_os("RUSTC")?);
    rustc.args(["--crate-type=cdylib", "--target", &env::var("TARGET").ok()?, &format!("-Clink-arg={OPTION}")]);
    let linked = rustc.arg("-o").arg(folder.join("empty")).arg(source).output().ok()?;
    Some(linked.status.success())
}
