//! Files that are no scenes: missing, foreign, cut off, absurdly large. Their messages are not kept
//! word for word where they depend on the system.

use crate::{base, check_refusal, folder, stderr, teeter};
use std::time::Instant;

#[track_caller]
fn refused(what: &str, bytes: &[u8], says: &[&str]) -> String {
    let folder = folder(what);
    std::fs::write(folder.join("scene.toml"), bytes).unwrap();
    let clock = Instant::now();
    let output = teeter(&folder, &["run", "scene.toml"]);
    let message = check_refusal(what, &folder, &output, clock.elapsed());
    for part in says.iter().chain(&["scene.toml"]) {
        assert!(message.contains(part), "{what}: «{part}» is missing in\n{message}");
    }
    message
}

/// Row 40.
#[test]
fn binary_files_are_not_printed() {
    refused("png", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\xff\xfe", &["not a text file in UTF-8", "byte 0"]);
    refused("zeros", &[0; 1000], &["not a text file", "byte 0 is zero"]);
    let mut state = 1_u32;
    let mut noise = || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        state
    };
    let random: Vec<u8> = (0..1_000_000).map(|_| noise().to_le_bytes()[0]).collect();
    refused("random", &random, &["not a text file in UTF-8"]);
}

/// Row 41: the reverse test.
#[test]
fn byte_order_mark_and_windows_line_ends_work() {
    let folder = folder("windows");
    let text = format!("\u{feff}{}", base().replace('\n', "\r\n"));
    std::fs::write(folder.join("scene.toml"), &text).unwrap();
    let output = teeter(&folder, &["check", "scene.toml"]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stderr(&output).contains("--> scene.toml:22:17"), "places hold: {}", stderr(&output));
}

/// Row 42.
#[test]
fn a_file_cut_off_anywhere_is_refused_at_a_place() {
    let text = base();
    refused("cut in a string", &text.as_bytes()[..text.find("cm\"").unwrap()], &["scene.toml:20:"]);
    refused("cut in a header", &text.as_bytes()[..text.find("able]").unwrap()], &["scene.toml:18:"]);
    refused("cut in a key", &text.as_bytes()[..text.find("ickness").unwrap()], &["scene.toml:22:"]);
}

/// Row 43.
#[test]
fn files_that_can_not_be_read_say_why() {
    let folder = folder("unreadable");
    for (path, why) in [("nowhere.toml", "no such file"), (".", "is a folder")] {
        let output = teeter(&folder, &["run", path]);
        assert_eq!(output.status.code(), Some(2));
        let message = stderr(&output);
        assert!(message.contains(why) && message.contains(path), "{message}");
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let file = folder.join("scene.toml");
        std::fs::write(&file, base()).unwrap();
        std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o000)).unwrap();
        // The superuser may read everything.
        if std::fs::File::open(&file).is_err() {
            let output = teeter(&folder, &["run", "scene.toml"]);
            assert_eq!(output.status.code(), Some(2));
            assert!(stderr(&output).contains("no permission to read it"), "{}", stderr(&output));
        }
    }
}

/// Row 50.
#[test]
fn absurd_sizes_are_refused_fast() {
    let deep = 100_000;
    refused("deep arrays", format!("x = {}", "[".repeat(deep)).as_bytes(), &["scene.toml:1:"]);
    refused(
        "deep closed arrays",
        format!("x = {}{}", "[".repeat(deep), "]".repeat(deep)).as_bytes(),
        &["scene.toml:1:"],
    );
    refused("deep tables", format!("x = {}", "{a=".repeat(deep)).as_bytes(), &["scene.toml:1:"]);
    refused("deep header", format!("[{}]", vec!["a"; deep].join(".")).as_bytes(), &["scene.toml:1:"]);
    refused("deep key", format!("{} = 1", vec!["a"; deep].join(".")).as_bytes(), &["scene.toml:1:"]);
    refused("long line", &vec![b'x'; 100_000_000], &["larger than 4 MB"]);
    refused("long key", format!("{} = 1", "k".repeat(1_000_000)).as_bytes(), &["scene.toml:1:1", "unknown key"]);
    refused("long name", format!("[block.{}]", "k".repeat(1_000_000)).as_bytes(), &["at most 64 characters"]);
    refused("many keys", "k = 1\n".repeat(100_000).as_bytes(), &["more"]);
    let value = base().replace("\"36 cm\"", &format!("\"{} cm\"", "3".repeat(1_000_000)));
    refused("long value", value.as_bytes(), &["scene.toml:20:", "beam.table.span"]);
}

/// Rows 47 and 48; the rest of what concerns results is tested with them.
#[test]
fn results_that_can_not_be_written_are_refused_before_the_run() {
    let folder = folder("results");
    std::fs::write(folder.join("scene.toml"), base()).unwrap();
    std::fs::write(folder.join("file"), "").unwrap();
    let output = teeter(&folder, &["run", "scene.toml", "--out", "file"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("file"), "{}", stderr(&output));
    let short = ["run", "scene.toml", "--out", "out", "--set", "time.end=1 ms"];
    assert!(teeter(&folder, &short).status.success());
    let again = teeter(&folder, &short);
    assert_eq!(again.status.code(), Some(2));
    assert!(stderr(&again).contains("--force"), "{}", stderr(&again));
}

/// Row 52.
#[test]
fn usage_errors_say_how_it_is_used() {
    let folder = folder("usage");
    for (arguments, says) in [
        (&["run", "a.toml", "b.toml"][..], "b.toml"),
        (&["run", "a.toml", "--fast"], "--fast"),
        (&["run", "a.toml", "--out"], "--out"),
        (&["run", "a.toml", "--set", "time.step"], "KEY=VALUE"),
        (&["check"], "SCENE"),
    ] {
        let output = teeter(&folder, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let message = stderr(&output);
        assert!(message.contains(says) && message.lines().count() <= 8, "{arguments:?}: {message}");
    }
}

/// A pipe that nobody writes to would be waited for without end.
#[cfg(unix)]
#[test]
#[allow(clippy::print_stderr)] // a test that is skipped says so
fn a_pipe_as_a_signal_is_refused() {
    let folder = folder("pipe");
    let made = std::process::Command::new("mkfifo").arg(folder.join("push.csv")).status();
    if !made.is_ok_and(|status| status.success()) {
        eprintln!("skipped: no pipe can be made here");
        return;
    }
    let signal = "[force.push]\non = \"rocker\"\nforce = [\"1 N\", \"0 N\"]\nsignal = \"s\"\n\
                  [signal.s]\nshape = \"table\"\nfile = \"push.csv\"\n";
    let start = base().replace("start         = \"static\"", "start = { file = \"push.csv\" }");
    for text in [format!("{}\n{signal}", base()), start] {
        std::fs::write(folder.join("scene.toml"), text).unwrap();
        let output = teeter(&folder, &["check", "scene.toml"]);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(stderr(&output).contains("is a pipe or a device"), "{}", stderr(&output));
    }
}
