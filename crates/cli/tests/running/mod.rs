//! Runs the program in a folder.

#![allow(dead_code)] // each test takes what it needs of it

use std::path::Path;
use std::process::{Command, Output};

/// The program with these arguments in a folder.
pub(crate) fn teeter(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_teeter")).current_dir(folder).args(arguments).output().unwrap()
}

/// What it says where it ends well.
pub(crate) fn done(folder: &Path, arguments: &[&str]) -> String {
    let output = teeter(folder, arguments);
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{arguments:?}: {told}");
    told
}
