//! The front example is written out in two pages, where no compiler looks: they have to be the one that the doc test runs.

use std::path::Path;

/// The lines of the first block of Rust after `fence`, without those that rustdoc hides.
fn example<'a>(lines: impl Iterator<Item = &'a str>, fence: &str) -> Vec<&'a str> {
    let code = lines.skip_while(|line| *line != fence).skip(1).take_while(|line| *line != "```");
    code.filter(|line| !line.starts_with("# ")).collect::<Vec<_>>()
}

fn trimmed<'a, 'b>(lines: &'b [&'a str]) -> &'b [&'a str] {
    let is_text = |line: &&str| !line.is_empty();
    let first = lines.iter().position(is_text).unwrap_or(0);
    let end = lines.iter().rposition(is_text).map_or(0, |last| last + 1);
    &lines[first..end]
}

#[test]
fn the_pages_show_the_example_that_runs() -> Result<(), Box<dyn std::error::Error>> {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let source = std::fs::read_to_string(package.join("src/lib.rs"))?;
    let docs = source.lines().filter_map(|line| line.strip_prefix("//!"));
    let tested = example(docs.map(|line| line.strip_prefix(' ').unwrap_or(line)), "```");
    let tested = trimmed(&tested);
    assert!(tested.len() > 10);
    for page in ["README.md", "../../README.md"] {
        let text = std::fs::read_to_string(package.join(page))?;
        assert_eq!(trimmed(&example(text.lines(), "```rust")), tested, "{page}");
    }
    Ok(())
}
