//! Turns the results of the last `cargo bench` into a page to keep: command, versions, machine, medians.

use serde_json::Value;
use std::error::Error;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

fn main() -> Result<()> {
    let folder = std::env::args().nth(1).map_or_else(default_folder, PathBuf::from);
    let mut medians = Vec::new();
    collect(&folder, &mut medians)?;
    if medians.is_empty() {
        return Err(format!("no results in {}: run `cargo bench -p teeter-benches` first", folder.display()).into());
    }
    medians.sort_by(|a, b| a.name.cmp(&b.name));
    let mut out = std::io::stdout().lock();
    writeln!(out, "# Times measured by `cargo bench -p teeter-benches`\n")?;
    writeln!(out, "- commit: {}", first_line("git", &["rev-parse", "--short", "HEAD"]))?;
    writeln!(out, "- compiler: {}", first_line("rustc", &["--version"]))?;
    writeln!(out, "- machine: {}, shared with other work: times vary by some ten per cent and more", machine())?;
    writeln!(out, "- a row is the median over criterion's samples, with its 95 % interval; steps are per step\n")?;
    writeln!(out, "| what | median | low | high |\n|---|---:|---:|---:|")?;
    for Median { name, ns, low, high } in &medians {
        writeln!(out, "| {name} | {} | {} | {} |", time(*ns), time(*low), time(*high))?;
    }
    Ok(())
}

/// A measured time per element, ns.
struct Median {
    name: String,
    ns: f64,
    low: f64,
    high: f64,
}

/// `target/criterion`, wherever cargo was told to put `target`.
fn default_folder() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| PathBuf::from("target"), PathBuf::from);
    target.join("criterion")
}

/// Reads every `new/` folder below `folder`.
fn collect(folder: &Path, medians: &mut Vec<Median>) -> Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.ends_with("new") {
            medians.push(read(&path)?);
        } else if path.is_dir() {
            collect(&path, medians)?;
        }
    }
    Ok(())
}

fn read(folder: &Path) -> Result<Median> {
    let json = |file: &str| -> Result<Value> { Ok(serde_json::from_str(&fs::read_to_string(folder.join(file))?)?) };
    let (estimates, benchmark) = (json("estimates.json")?, json("benchmark.json")?);
    let name = benchmark["full_id"].as_str().ok_or("a benchmark without a name")?.to_owned();
    let elements = benchmark["throughput"]["Elements"].as_f64().unwrap_or(1.0);
    let median = &estimates["median"];
    let interval = &median["confidence_interval"];
    let number = |value: &Value| value.as_f64().map(|ns| ns / elements).ok_or("an estimate without a number");
    Ok(Median {
        name,
        ns: number(&median["point_estimate"])?,
        low: number(&interval["lower_bound"])?,
        high: number(&interval["upper_bound"])?,
    })
}

/// What a program says of itself; unknown where it isn't there.
fn first_line(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output().ok().filter(|output| output.status.success());
    let text = output.and_then(|output| String::from_utf8(output.stdout).ok()).unwrap_or_default();
    text.lines().next().unwrap_or("unknown").to_owned()
}

/// Model and number of the processors; unknown where the system doesn't say.
fn machine() -> String {
    let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let of = |key: &str| info.lines().filter(|line| line.starts_with(key)).collect::<Vec<_>>();
    let model =
        of("model name").first().and_then(|line| line.split_once(": ")).map_or("unknown processor", |(_, name)| name);
    format!("{model}, {} cores", of("processor").len())
}

fn time(ns: f64) -> String {
    if ns < 1000.0 { format!("{ns:.1} ns") } else { format!("{:.3} µs", ns / 1000.0) }
}
