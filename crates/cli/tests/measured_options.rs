//! Options of `teeter fit` and `teeter compare` that can't be meant: each is refused with what would be right.

#![allow(clippy::unwrap_used)] // a test

use std::path::Path;
use std::process::Command;

#[test]
fn what_an_option_cannot_mean_is_told_with_what_it_could() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("measured-options");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/free-rocking-on-ground.toml");
    std::fs::copy(scene, folder.join("scene.toml")).unwrap();
    let rows: String = (0..20).map(|k| format!("{},{},{k}\n", 0.01 * f64::from(k), 20 - k)).collect();
    std::fs::write(folder.join("seen.csv"), format!("t,phi [deg],x\n{rows}")).unwrap();
    for (options, says) in [
        (&["--column", "phi"][..], "write NAME=COLUMN, such as phi=\"Angle\" or phi=2"),
        (&["--unit", "phi"], "write NAME=UNIT, such as phi=deg"),
        (
            &["--column", "phi=2", "--column", "phi=3"],
            "--column: phi is given twice, as `2` and as `3`: keep one of the two",
        ),
        (&["--unit", "x=mm", "--unit", "x=cm"], "--unit: x is given twice, as `mm` and as `cm`: keep one of the two"),
        (&["--column", "x=2", "--unit", "x=mm"], "column 2 (`phi [deg]`) is read both as phi and as x"),
        (&["--unit", "phi=mm"], "the unit `mm` of phi"),
        (&["--seed", "-1"], "a whole number from 0 to 18446744073709551615 is expected"),
        (&["--samples", "many"], "a whole number from 1 to 65535 is expected"),
        (&["--jobs", "0"], "a whole number from 1 to 65535 is expected"),
        (&["--skip", "-1"], "a number of lines is expected, such as 3"),
        (&["--skip", "9999"], "all of its 21 lines are skipped"),
        (
            &["--window", "99"],
            "--window: 99 rows, but the table has phi in 20 rows, so that no row has a complete window: 19 at most",
        ),
        (&["--rate", "100 Hz", "--unit", "t=ms"], "leave out the unit of t, or the rate"),
    ] {
        let vary = ["--vary", "contact.feet.friction=0.2..0.9", "--out", "out"];
        let arguments = [&["fit", "scene.toml", "seen.csv"], options, &vary].concat();
        let output = Command::new(env!("CARGO_BIN_EXE_teeter")).current_dir(&folder).args(&arguments).output().unwrap();
        let told = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{options:?}: {told}");
        assert!(told.contains(says), "{options:?}: {told}");
        assert!(!folder.join("out").exists());
    }
}
