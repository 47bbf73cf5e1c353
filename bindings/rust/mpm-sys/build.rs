//! Finds libmpm: in the folder MPM_LIB_DIR, or where pkg-config says. With MPM_STATIC=1 it becomes part of the program.
use std::{env, process::Command};

fn main() {
    for name in ["MPM_LIB_DIR", "MPM_STATIC", "PKG_CONFIG", "PKG_CONFIG_PATH"] {
        println!("cargo:rerun-if-env-changed={name}");
    }
    let in_program = env::var("MPM_STATIC").map_or(false, |value| value == "1");
    match env::var("MPM_LIB_DIR") {
        Ok(folder) => link(&folder, in_program),
        Err(_) => by_pkg_config(in_program),
    }
    if in_program {
        println!("cargo:rustc-link-lib=m");
        println!("cargo:rustc-link-lib=pthread");
    }
}

fn link(folder: &str, in_program: bool) {
    println!("cargo:rustc-link-search=native={folder}");
    println!("cargo:rustc-link-lib={}=mpm", if in_program { "static" } else { "dylib" });
}

fn by_pkg_config(in_program: bool) {
    let tool = env::var("PKG_CONFIG").unwrap_or_else(|_| "pkg-config".into());
    let folder = Command::new(&tool).args(["--variable=libdir", "mpm"]).output();
    match folder {
        Ok(found) if found.status.success() => link(String::from_utf8_lossy(&found.stdout).trim(), in_program),
        _ => panic!("libmpm was not found: set MPM_LIB_DIR to the folder of the library, or PKG_CONFIG_PATH to that of mpm.pc"),
    }
}
