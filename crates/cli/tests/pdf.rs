//! `teeter pdf`: every kind of figure becomes a PDF of its size, with its text in the embedded font.

#![cfg(feature = "pdf")]
#![allow(clippy::unwrap_used)] // a test

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn teeter(folder: &Path, words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_teeter")).current_dir(folder).args(words).output().unwrap()
}

fn place(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("pdf-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn done(folder: &Path, words: &[&str]) -> String {
    let output = teeter(folder, words);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{words:?}: {said}");
    said
}

fn scene(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(name).to_str().unwrap().to_owned()
}

/// The files of a folder with this ending.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|own| own == ending)).collect();
    files.sort();
    files
}

/// Width and height of the page, pt, after a look at the whole file: offsets of its objects, its font.
fn page(path: &Path) -> [f64; 2] {
    let bytes = std::fs::read(path).unwrap();
    // Byte by byte, so that offsets stay.
    let text: String = bytes.iter().map(|byte| *byte as char).collect();
    let at: usize = text.rsplit("startxref\n").next().unwrap().lines().next().unwrap().parse().unwrap();
    let mut table = text[text.char_indices().nth(at).unwrap().0..].lines();
    assert_eq!(table.next(), Some("xref"));
    let count: usize = table.next().unwrap().strip_prefix("0 ").unwrap().parse().unwrap();
    for number in 1..count {
        let entry = table.nth(usize::from(number == 1)).unwrap();
        let start: usize = entry[..10].parse().unwrap();
        assert!(bytes[start..].starts_with(format!("{number} 0 obj\n").as_bytes()), "{}: {number}", path.display());
    }
    assert!(text.contains("/FontFile2 8 0 R") && text.contains("/ToUnicode 9 0 R"));
    let (_, media) = text.split_once("/MediaBox [0 0 ").unwrap();
    let numbers: Vec<f64> = media.split(']').next().unwrap().split(' ').map(|number| number.parse().unwrap()).collect();
    [numbers[0], numbers[1]]
}

#[test]
fn figures_of_runs_and_records_become_pdf_of_the_width_of_a_column() {
    let folder = place("runs");
    let quick = ["--set", "time.step=1 ms", "--set", "time.end=50 ms", "--quiet"];
    for (width, scene_file) in [
        ("84", "free-rocking-on-beam.toml"),
        ("174", "rocking-under-earthquake.toml"),
        ("84", "masonry-arch.toml"),
        ("174", "held-beam.toml"),
    ] {
        let out = format!("{width}-{scene_file}");
        let set = format!("output.figure_width={width} mm");
        done(&folder, &[&["run", &scene(scene_file), "--out", &out, "--set", &set], &quick[..]].concat());
        done(&folder, &["pdf", &out]);
        let figures = files(&folder.join(&out).join("figures"), "svg");
        let pdfs = files(&folder.join(&out).join("figures"), "pdf");
        assert!(figures.len() > 4 && pdfs.len() == figures.len(), "{out}: {} of {}", pdfs.len(), figures.len());
        let points = width.parse::<f64>().unwrap() * 72.0 / 25.4;
        for pdf in pdfs {
            let [across, up] = page(&pdf);
            assert!((across - points).abs() < 0.01 && up > 50.0, "{}: {across} {up}", pdf.display());
        }
        // A run that replaces the figures doesn't leave the old ones as PDF.
        done(&folder, &[&["run", &scene(scene_file), "--out", &out, "--force", "--no-report"], &quick[..]].concat());
        assert!(files(&folder.join(&out).join("figures"), "pdf").is_empty(), "{out}");
    }
    let record = scene("rocking-under-earthquake.csv");
    done(&folder, &["record", &record, "--out", "record", "--figure-width", "84 mm"]);
    assert!(done(&folder, &["pdf", "record/figures/spectra.svg"]).contains("record/figures/spectra.pdf"));
    assert!((page(&folder.join("record/figures/spectra.pdf"))[0] - 84.0 * 72.0 / 25.4).abs() < 0.01);
}

#[test]
fn letters_that_the_font_lacks_are_named() {
    let folder = place("letters");
    let figure = |text: &str| {
        format!(
            "<svg width=\"60mm\" viewBox=\"0 0 240 40\"><text x=\"4\" y=\"20\" font-size=\"11\">{text}</text></svg>"
        )
    };
    std::fs::write(folder.join("known.svg"), figure("Блок ω Ångström ế")).unwrap();
    std::fs::write(folder.join("unknown.svg"), figure("石 Блок")).unwrap();
    let said = done(&folder, &["pdf", "known.svg"]);
    assert!(!said.contains("warning"), "{said}");
    let said = done(&folder, &["pdf", "unknown.svg"]);
    assert!(said.contains("warning") && said.contains("boxes stand for 石.") && !said.contains('Б'), "{said}");
    // The glyphs that are used, not the whole font.
    let bytes = std::fs::metadata(folder.join("known.pdf")).unwrap().len();
    assert!(bytes < 12_000, "{bytes} bytes");
}

#[test]
fn what_is_no_figure_is_refused_and_nothing_replaced_unasked() {
    let folder = place("refused");
    let refused = |words: &[&str], wanted: &str| {
        let output = teeter(&folder, words);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && said.contains(wanted), "{words:?}: {said}");
    };
    std::fs::write(folder.join("a.txt"), "text").unwrap();
    std::fs::write(folder.join("other.svg"), "<svg width=\"10mm\" viewBox=\"0 0 40 40\"><image/></svg>").unwrap();
    std::fs::create_dir(folder.join("empty")).unwrap();
    refused(&["pdf", "nowhere"], "there is no nowhere");
    refused(&["pdf", "a.txt"], "a.txt is no figure");
    refused(&["pdf", "empty"], "empty has no figures");
    refused(&["pdf", "other.svg"], "other.svg: this is no figure of this program: the element image");
    refused(&["pdf"], "PATH");
    refused(&["record", "a.txt", "--out", "o", "--figure-width", "30 mm"], "figures are 60 mm to 300 mm wide");
    let small = "<svg width=\"10mm\" viewBox=\"0 0 40 40\"><rect width=\"4\" height=\"4\"/></svg>";
    std::fs::write(folder.join("small.svg"), small).unwrap();
    std::fs::write(folder.join("small.pdf"), "mine").unwrap();
    refused(&["pdf", "small.svg"], "small.pdf already exists; --force replaces it");
    assert_eq!(std::fs::read(folder.join("small.pdf")).unwrap(), b"mine");
    done(&folder, &["pdf", "small.svg", "--force"]);
    assert!((page(&folder.join("small.pdf"))[1] - 28.346).abs() < 0.01);
}
