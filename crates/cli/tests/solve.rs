//! `teeter solvers`, `teeter solve` and the problems that `teeter run` saves, from outside.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod running;

use running::teeter;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Output;
use teeter_contact::{Block, BlockSparse, Vector, judge};
use teeter_fclib::{FclibProblem, Info, LocalProblem};

/// An empty folder of this test's own.
fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("solve-{test}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// A row of contacts, each coupled to the next; pressed and pushed sideways.
fn chain<const D: usize>(contacts: usize) -> LocalProblem<D> {
    let coupling = Block::<D>::from_fn(|r, c| 0.2 / (1.0 + r as f64 + 2.0 * c as f64));
    let rows: Vec<_> = (0..contacts)
        .map(|i| {
            let mut row = Vec::new();
            if i > 0 {
                row.push((i - 1, coupling.transpose()));
            }
            row.push((i, Block::<D>::identity() * (1.0 + 0.1 * i as f64)));
            if i + 1 < contacts {
                row.push((i + 1, coupling));
            }
            row
        })
        .collect();
    LocalProblem {
        h: BlockSparse::from_rows(&rows).unwrap(),
        q: (0..contacts)
            .map(|i| Vector::<D>::from_fn(|r, _| if r == 0 { -1.0 } else { 0.3 * (i + r) as f64 }))
            .collect(),
        mu: vec![0.4; contacts],
        info: Info { title: Some("a chain".to_owned()), ..Info::default() },
        ..LocalProblem::default()
    }
}

fn rows(output: &Output) -> Vec<Value> {
    text(&output.stdout).lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// Refused before anything ran or was written; what was said.
fn refused(output: &Output) -> String {
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    assert!(output.stdout.is_empty(), "{}", text(&output.stdout));
    text(&output.stderr)
}

#[test]
fn solvers_are_listed_with_dimension_law_and_source() {
    let output = teeter(&folder("list"), &["solvers"]);
    assert!(output.status.success());
    let listed = text(&output.stdout);
    for info in teeter_solvers::SOLVERS {
        let line = listed.lines().find(|line| line.split_whitespace().next() == Some(info.name)).expect(info.name);
        let law = if info.law == teeter_contact::Law::Exact { " exact " } else { " convex " };
        assert!(line.contains(law) && line.contains(info.summary) && line.contains(info.reference), "{line}");
        assert!(info.dimensions.iter().all(|d| line.contains(&format!("{d}D"))), "{line}");
    }
    assert_eq!(listed.lines().count(), 1 + teeter_solvers::SOLVERS.len());
}

#[test]
fn a_table_has_a_row_for_each_file_and_solver() {
    let folder = folder("table");
    chain::<2>(2).write(folder.join("two.hdf5")).unwrap();
    let mut skew = chain::<2>(3);
    skew.h = BlockSparse::from_rows(&[
        vec![(0, Block::<2>::identity()), (1, Block::<2>::repeat(0.01))],
        vec![(1, Block::<2>::identity())],
        vec![(2, Block::<2>::identity())],
    ])
    .unwrap();
    skew.write(folder.join("skew.hdf5")).unwrap();
    let output = teeter(&folder, &["solve", "two.hdf5", "skew.hdf5", "--solver", "pgs", "enumeration"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let table = text(&output.stdout);
    let lines: Vec<Vec<&str>> = table.lines().map(|line| line.split_whitespace().collect()).collect();
    assert_eq!(lines[0].join(" "), "file solver contacts outcome residual iter. time asym.");
    let begin: Vec<_> = lines[1..].iter().map(|cells| cells[..5].join(" ")).collect();
    assert_eq!(
        begin,
        [
            "two.hdf5 pgs 2 2D converged",
            "two.hdf5 enumeration 2 2D converged",
            "skew.hdf5 pgs 3 2D converged",
            "skew.hdf5 enumeration 3 2D converged",
        ]
    );
    // ‖H − Hᵀ‖ / ‖H‖ = √(2 · 4 · 0.01²) / √(6 + 4 · 0.01²), for the asymmetric one only.
    assert_eq!((lines[1].len(), lines[3].len(), lines[3][8]), (8, 9, "1e-2"));
}

#[test]
fn json_lines_have_the_names_of_the_contract_in_their_order() {
    let folder = folder("json");
    chain::<2>(2).write(folder.join("two.hdf5")).unwrap();
    let output = teeter(&folder, &["solve", "two.hdf5", "--json", "--tolerance", "1e-9"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let line = text(&output.stdout);
    let names = [
        "file",
        "solver",
        "used",
        "dimension",
        "contacts",
        "tolerance",
        "outcome",
        "residual",
        "iterations",
        "time_ms",
    ];
    let places: Vec<_> = names.iter().map(|name| line.find(&format!("\"{name}\":")).expect(name)).collect();
    assert!(places.is_sorted(), "{line}");
    let row = &rows(&output)[0];
    assert_eq!(row.as_object().unwrap().len(), names.len());
    assert_eq!(
        (&row["file"], &row["solver"], &row["outcome"]),
        (&"two.hdf5".into(), &"auto".into(), &"converged".into())
    );
    assert_eq!((row["dimension"].as_u64(), row["contacts"].as_u64()), (Some(2), Some(2)));
    assert_eq!(row["tolerance"].as_f64(), Some(1e-9));
    assert!(row["residual"].as_f64().unwrap() <= 1e-9 && row["time_ms"].as_f64().unwrap() > 0.0);
}

#[test]
fn solutions_are_the_impulses_that_were_judged() {
    let folder = folder("solutions");
    let local = chain::<3>(4);
    local.write(folder.join("space.hdf5")).unwrap();
    let output = teeter(&folder, &["solve", "space.hdf5", "--solver", "pgs", "--json", "--solutions", "new/out"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let file = std::fs::read_to_string(folder.join("new/out/space.pgs.csv")).unwrap();
    let numbers: Vec<f64> = file.lines().map(|line| line.parse().unwrap()).collect();
    assert_eq!(numbers.len(), 12);
    let p: Vec<_> = numbers.chunks(3).map(Vector::<3>::from_column_slice).collect();
    let residual = judge(&local.problem().unwrap(), &p).global;
    assert_eq!(rows(&output)[0]["residual"].as_f64(), Some(residual), "to the bit");
    assert!(residual <= 1e-10);
}

#[test]
fn a_folder_stands_for_all_problems_below_it_and_all_for_the_solvers_that_take_them() {
    let folder = folder("tree");
    std::fs::create_dir_all(folder.join("set/b/deep")).unwrap();
    chain::<2>(1).write(folder.join("set/z.hdf5")).unwrap();
    chain::<3>(1).write(folder.join("set/b/deep/y.hdf5")).unwrap();
    chain::<2>(1).write(folder.join("set/b/x.hdf5")).unwrap();
    std::fs::write(folder.join("set/b/note.txt"), "no problem").unwrap();
    // A file may follow the solvers' names.
    let output = teeter(&folder, &["solve", "--json", "--solver", "all", "set"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let told: Vec<_> = rows(&output)
        .iter()
        .map(|row| (row["file"].as_str().unwrap().replace('\\', "/"), row["solver"].as_str().unwrap().to_owned()))
        .collect();
    let mut wanted = Vec::new();
    for (file, dimension) in [("set/b/deep/y.hdf5", 3), ("set/b/x.hdf5", 2), ("set/z.hdf5", 2)] {
        for info in teeter_solvers::SOLVERS.iter().filter(|info| info.dimensions.contains(&dimension)) {
            wanted.push((file.to_owned(), info.name.to_owned()));
        }
    }
    assert_eq!(told, wanted);
}

#[test]
fn all_bad_files_are_told_at_once_and_nothing_runs() {
    let folder = folder("bad");
    chain::<2>(1).write(folder.join("good.hdf5")).unwrap();
    std::fs::write(folder.join("foreign.hdf5"), "not HDF5").unwrap();
    let good = std::fs::read(folder.join("good.hdf5")).unwrap();
    std::fs::write(folder.join("cut.hdf5"), &good[..good.len() / 2]).unwrap();
    let arguments = ["solve", "good.hdf5", "foreign.hdf5", "cut.hdf5", "missing.hdf5", "--solutions", "out"];
    let said = refused(&teeter(&folder, &arguments));
    assert!(said.contains("foreign.hdf5: not a readable HDF5 file"), "{said}");
    assert!(said.contains("cut.hdf5: ") && said.contains("missing.hdf5: no such file"), "{said}");
    assert!(!folder.join("out").exists());
    std::fs::create_dir(folder.join("empty")).unwrap();
    assert!(refused(&teeter(&folder, &["solve", "empty"])).contains("empty: no *.hdf5"));
    assert!(refused(&teeter(&folder, &["solve"])).contains("no problem is given"));
}

#[test]
fn wrong_words_are_refused_with_what_would_be_right() {
    let folder = folder("words");
    chain::<2>(1).write(folder.join("plane.hdf5")).unwrap();
    chain::<3>(1).write(folder.join("space.hdf5")).unwrap();
    let refused = |arguments: &[&str]| refused(&teeter(&folder, &[&["solve", "plane.hdf5"], arguments].concat()));
    assert!(refused(&["--solver", "pqs"]).contains("there is no solver `pqs`; did you mean `pgs`?"));
    let said = refused(&["space.hdf5", "--solver", "enumeration"]);
    assert!(said.contains("solver `enumeration` takes 2D problems only, but space.hdf5 is 3D"), "{said}");
    assert!(refused(&["--tolerance", "0"]).contains("greater than 0"));
    assert!(refused(&["--tolerance", "NaN"]).contains("greater than 0"));
    assert!(refused(&["--time-limit", "10"]).contains("--time-limit"));
    assert!(refused(&["--time-limit", "10 m"]).contains("time (s)"));
    assert!(refused(&["--time-limit", "0 s"]).contains("greater than 0"));
    assert!(refused(&["--profile", "p", "--tolerance", "1e-3"]).contains("--tolerance"));
    std::fs::create_dir(folder.join("other")).unwrap();
    chain::<2>(2).write(folder.join("other/plane.hdf5")).unwrap();
    assert!(refused(&["other/plane.hdf5", "--solutions", "out"]).contains("have the same name"));
}

#[test]
fn a_solver_that_fails_is_a_row_and_no_failure_of_the_program() {
    let folder = folder("row");
    chain::<2>(4).write(folder.join("four.hdf5")).unwrap();
    chain::<2>(6).write(folder.join("six.hdf5")).unwrap();
    let arguments = ["solve", "six.hdf5", "--json", "--time-limit", "200 ms", "--solver", "enumeration", "pgs"];
    let output = teeter(&folder, &arguments);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let rows = rows(&output);
    // Enumeration takes up to five contacts.
    assert_eq!((&rows[0]["outcome"], &rows[1]["outcome"]), (&"breakdown".into(), &"converged".into()));
    let said = text(&output.stderr);
    assert!(said.contains("it takes up to 5 contacts, and the problem has 6"), "{said}");
    // Among all of them it is left out, with a note instead of a row.
    let arguments = ["solve", "six.hdf5", "--json", "--time-limit", "200 ms", "--solver", "all"];
    let output = teeter(&folder, &arguments);
    let said = text(&output.stderr);
    assert!(said.contains("`enumeration` is left out: it takes up to 5 contacts"), "{said}");
    let all = self::rows(&output);
    assert!(all.iter().all(|row| row["solver"] != "enumeration" && row["outcome"] != "breakdown"), "{all:?}");
    assert!(all.iter().any(|row| row["solver"] == "lemke"));
    // A tolerance that no double reaches: stalled, out of time, but never converged.
    let output = teeter(
        &folder,
        &["solve", "four.hdf5", "--json", "--time-limit", "200 ms", "--solver", "pgs", "--tolerance", "1e-200"],
    );
    let row = &self::rows(&output)[0];
    let outcome = row["outcome"].as_str().unwrap();
    assert!(output.status.success() && (outcome != "converged" || row["residual"] == 0.0), "{row}");
    assert!(row["time_ms"].as_f64().unwrap() < 5000.0);
}

#[test]
fn a_profile_is_a_table_a_page_and_figures() {
    let folder = folder("profile");
    chain::<2>(1).write(folder.join("a.hdf5")).unwrap();
    chain::<2>(5).write(folder.join("b.hdf5")).unwrap();
    chain::<3>(2).write(folder.join("c.hdf5")).unwrap();
    let output = teeter(&folder, &["solve", ".", "--solver", "all", "--profile", "out", "--time-limit", "1 s"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let solvers =
        |dimension| teeter_solvers::SOLVERS.iter().filter(|info| info.dimensions.contains(&dimension)).count();
    let count = 3 * (2 * solvers(2) + solvers(3));
    assert_eq!(text(&output.stdout).lines().count(), 1 + count);
    let table = std::fs::read_to_string(folder.join("out/table.csv")).unwrap();
    assert_eq!(table.lines().count(), 1 + count);
    let page = std::fs::read_to_string(folder.join("out/profile.md")).unwrap();
    for words in [
        "| processor |",
        "| rustc | rustc 1.",
        "| command | `teeter solve . --solver all",
        "| pgs | 2 / 2 |",
        "| pgs | 1 / 1 |",
    ] {
        assert!(page.contains(words), "«{words}» in {page}");
    }
    for dimension in ["2d", "3d"] {
        for tolerance in ["1e-04", "1e-08", "1e-12"] {
            let name = format!("profile-{dimension}-{tolerance}.svg");
            let figure = std::fs::read_to_string(folder.join("out").join(&name)).unwrap();
            assert!(figure.starts_with("<svg") && figure.contains("pgs ("), "{name}");
            assert!(page.contains(&name));
        }
    }
}

#[test]
fn a_run_saves_its_contact_problems_and_they_solve_to_what_it_found() {
    let folder = folder("export");
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/sliding.toml");
    let scene = scene.to_str().unwrap();
    let run = |more: &[&str]| {
        let arguments = ["run", scene, "--quiet", "--set", "time.end=4 ms", "--set", "time.step=100us"];
        teeter(&folder, &[&arguments, more].concat())
    };
    let every = ["--out", "a", "--export-problems", "problems", "--export-when", "every:10"];
    let output = run(&every);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let names = |folder: &Path| {
        let mut names: Vec<_> =
            std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    };
    let problems = folder.join("problems");
    assert_eq!(
        names(&problems),
        ["sliding-step10.hdf5", "sliding-step20.hdf5", "sliding-step30.hdf5", "sliding-step40.hdf5"]
    );
    let FclibProblem::Plane(local) = teeter_fclib::read(problems.join("sliding-step20.hdf5")).unwrap() else {
        panic!("3D")
    };
    let problem = local.problem().unwrap();
    assert!(local.info.title.as_ref().is_some_and(|title| title.ends_with("step 20, t = 0.002 s")), "{:?}", local.info);
    let (guess, solution) = (&local.guesses[0], local.solution.as_ref().unwrap());
    assert!(judge(&problem, &solution.r).global <= 1e-10);
    for found in [guess, solution] {
        assert_eq!(found.u[1], problem.velocity(1, &found.r));
    }
    let output = teeter(&folder, &["solve", "problems", "--json"]);
    assert!(rows(&output).iter().all(|row| row["outcome"] == "converged"), "{}", text(&output.stdout));

    // The same run again: not over what is there, but for --force.
    assert_eq!(run(&["--out", "b", "--export-problems", "problems"]).status.code(), Some(2));
    assert!(!folder.join("b").exists());
    // A scene that slides on two feet has no hard problem.
    assert!(run(&["--out", "b", "--export-problems", "problems", "--force"]).status.success());
    assert_eq!(names(&problems), [""; 0]);
    // Watching changes nothing.
    assert!(run(&["--out", "c"]).status.success());
    let rows = |run: &str| std::fs::read(folder.join(run).join("trajectory.csv")).unwrap();
    assert_eq!(rows("a"), rows("c"));
    let wrong = run(&["--out", "d", "--export-problems", "p", "--export-when", "every:0"]);
    assert!(wrong.status.code() == Some(2) && text(&wrong.stderr).contains("hard, or every:N"));
    assert_eq!(run(&["--out", "d", "--export-when", "hard"]).status.code(), Some(2), "needs --export-problems");
}

#[test]
fn the_kept_problems_of_our_own_scenes_are_small_and_can_be_solved() {
    let problems = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../benches/problems");
    let arguments = ["solve", problems.to_str().unwrap(), "--json", "--tolerance", "1e-4", "--time-limit", "2 s"];
    let output = teeter(&folder("kept"), &arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let rows = rows(&output);
    let bytes: u64 = rows.iter().map(|row| std::fs::metadata(row["file"].as_str().unwrap()).unwrap().len()).sum();
    assert!(rows.len() >= 25 && bytes <= 300_000, "{} files, {bytes} bytes", rows.len());
    for row in &rows {
        assert_eq!(row["outcome"], "converged", "{row}");
    }
}
