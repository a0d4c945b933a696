//! The library from outside: runs to a folder that end, are cancelled and resumed, or are refused.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use teeter_run::{
    EndedWord, ExistingResults, ExportWhen, Extent, Hooks, LoadError, PROGRESS_STEPS, PrepareError, Prepared, Progress,
    RunError, RunJob, RunStart, SceneSource, StateDump,
};

/// A folder of a test's own, which doesn't exist yet and goes with it.
struct Place(PathBuf);

impl Place {
    fn new(test: &str) -> Self {
        let place = Path::new(env!("CARGO_TARGET_TMPDIR")).join("runs").join(test);
        let _ = std::fs::remove_dir_all(&place);
        Self(place)
    }

    fn at(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A scenario of this repository that rocks on a beam for 5000 steps.
fn rocking() -> RunJob {
    scenario("free-rocking-on-beam")
}

fn scenario(name: &str) -> RunJob {
    let scenarios = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios");
    RunJob::new(SceneSource::file(scenarios.join(format!("{name}.toml"))))
}

/// Two contacts that one sweep of Gauss–Seidel doesn't solve.
fn unsolved() -> RunJob {
    scenario("sliding")
        .set("time.end", "20 ms")
        .set("solver.method", "pgs")
        .set("solver.max_iterations", "1")
        .set("solver.tolerance", "1e-14")
}

/// All files below a folder, but for the two numbers in the summary that the clock decides.
fn results(folder: &Path) -> BTreeMap<PathBuf, String> {
    let mut files = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(inner) = folders.pop() {
        for entry in std::fs::read_dir(inner).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let text = String::from_utf8_lossy(&std::fs::read(&path).unwrap()).into_owned();
            let timing = |line: &&str| !line.contains("\"wall_seconds\"") && !line.contains("\"us_per_step\"");
            let text = text.split('\n').filter(timing).collect::<Vec<_>>().join("\n");
            files.insert(path.strip_prefix(folder).unwrap().to_owned(), text);
        }
    }
    files
}

fn prepare_error(job: RunJob) -> PrepareError {
    match job.prepare() {
        Err(error) => error,
        Ok(prepared) => panic!("it was to be refused: {prepared:?}"),
    }
}

#[test]
fn a_job_and_a_prepared_run_may_go_to_another_thread() {
    fn goes<T: Send>() {}
    goes::<RunJob>();
    goes::<Prepared>();
}

#[test]
fn a_scene_in_memory_runs_to_a_folder() {
    let place = Place::new("memory");
    let scene = std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/sliding.toml")).unwrap();
    let job = RunJob::new(SceneSource::bytes(scene, "<memory>", "sliding")).folder(place.at("out"));
    let prepared = job.prepare().unwrap();
    assert_eq!((prepared.start(), prepared.folder()), (RunStart::Beginning, place.at("out").as_path()));
    assert!(!place.0.exists(), "nothing is written before it runs");
    let done = prepared.run(Hooks::new()).unwrap();
    assert_eq!((done.ended(), &done.folder), (EndedWord::Complete, &place.at("out")));
    assert_eq!((&done.exported, &done.dump), (&None, &None));
    let files = results(&done.folder);
    for file in ["scene.toml", "trajectory.csv", "contacts.csv", "impacts.csv", "energy.csv", "report.html"] {
        assert!(files.contains_key(Path::new(file)), "{file}");
    }
    let summary = done.summary.to_json().unwrap();
    assert_eq!(std::fs::read_to_string(place.at("out/summary.json")).unwrap(), summary);
    // By default results have a folder of the scene's name, where the process is.
    let job = RunJob::new(SceneSource::bytes("", "<memory>", "sliding"));
    assert_eq!(job.results_folder(), Path::new("runs/sliding"));
}

/// Progress of a job that is cancelled at or after a step.
fn watched(job: RunJob, cancel_at: u64) -> (EndedWord, Vec<Progress>) {
    let (cancel, seen) = (Arc::new(AtomicBool::new(false)), RefCell::new(Vec::new()));
    let hooks = Hooks::new().cancelled_by(&cancel).on_progress(|progress| {
        seen.borrow_mut().push(progress);
        cancel.store(progress.step >= cancel_at, Ordering::Relaxed);
    });
    let done = job.prepare().unwrap().run(hooks).unwrap();
    let seen = seen.into_inner();
    assert_eq!(seen.last().map(|last| last.step), Some(done.summary.steps), "it ends at the last step");
    assert_eq!(seen.last().map(|last| last.t), Some(done.summary.t));
    assert!(seen.windows(2).all(|pair| pair[0].step < pair[1].step && pair[0].t < pair[1].t), "{seen:?}");
    assert!(seen.iter().all(|progress| progress.of == 5000 && progress.step <= progress.of));
    (done.ended(), seen)
}

#[test]
fn a_cancelled_run_goes_on_to_the_bytes_of_one_that_was_left_alone() {
    let place = Place::new("cancel");
    let (ended, seen) = watched(rocking().folder(place.at("alone")), u64::MAX);
    assert_eq!((ended, seen[0].step, seen.len() as u64), (EndedWord::Complete, 0, 5000 / PROGRESS_STEPS + 2));

    // No checkpoint is due before the end: there is one of the moment of each cancellation.
    let job = rocking().folder(place.at("parts")).checkpoint_every(10.0).existing(ExistingResults::Resume);
    assert_eq!(job.clone().prepare().unwrap().start(), RunStart::NothingToResume);
    let mut begin = 0;
    for cancel_at in [1000, 3000] {
        let (ended, seen) = watched(job.clone(), cancel_at);
        assert_eq!((ended, seen[0].step), (EndedWord::Interrupted, begin));
        // The flag is set when the step has been written: the next one, with contacts, is abandoned.
        begin = cancel_at.next_multiple_of(PROGRESS_STEPS);
        assert_eq!(seen.last().unwrap().step, begin);
        assert!(place.at("parts/checkpoint.bin").exists());
    }
    let prepared = job.clone().prepare().unwrap();
    assert_eq!((prepared.first_step(), prepared.steps()), (begin, 5000));
    assert_eq!(prepared.start(), RunStart::Checkpoint { t: begin as f64 * 1e-4 });
    assert_eq!(watched(job.clone(), u64::MAX).0, EndedWord::Complete);
    let (alone, parts) = (results(&place.at("alone")), results(&place.at("parts")));
    assert_eq!(alone.keys().collect::<Vec<_>>(), parts.keys().collect::<Vec<_>>());
    for (file, text) in &alone {
        assert!(parts[file] == *text, "{} differs", file.display());
    }

    // As a run leaves it that is killed when all but this is done.
    std::fs::write(place.at("parts/checkpoint.bin"), "left over").unwrap();
    match prepare_error(job) {
        PrepareError::AlreadyEnded { folder, ended } => {
            assert_eq!((folder, ended), (place.at("parts"), EndedWord::Complete));
        }
        other => panic!("{other}"),
    }
    assert!(results(&place.at("parts")) == alone, "nothing but the checkpoint is gone");
}

#[test]
fn a_checkpoint_belongs_to_its_program_scene_and_options() {
    let place = Place::new("identity");
    let job =
        rocking().folder(place.at("out")).checkpoint_every(0.01).existing(ExistingResults::Resume).program([1; 32]);
    assert_eq!(watched(job.clone(), 1000).0, EndedWord::Interrupted);
    let before = results(&place.0);
    let others =
        [job.clone().program([2; 32]), job.clone().set("time.step", "50 us"), job.clone().extent(Extent::Full)];
    for other in others {
        let error = prepare_error(other);
        assert!(matches!(error, PrepareError::Resume(_)), "{error}");
    }
    assert!(results(&place.0) == before);
    assert_eq!(job.prepare().unwrap().first_step(), 1024);
}

#[test]
fn bad_input_is_found_before_anything_is_written() {
    let place = Place::new("bad");
    let job = || rocking().folder(place.at("out"));
    // Findings point into the text that comes with them.
    let text = "time = { end = \"1 s\", step = \"0 s\" }\nground = 7\n";
    let scene = RunJob::new(SceneSource::bytes(text, "scene.toml", "scene")).folder(place.at("out"));
    match prepare_error(scene) {
        PrepareError::Load(LoadError::Invalid { text: kept, found }) => {
            assert_eq!((kept.as_str(), found.iter().count()), (text, 2));
            let step = found.iter().find(|found| found.path == "time.step").unwrap();
            assert_eq!((&text[step.span.clone().unwrap()], step.position), ("\"0 s\"", Some((1, 30))));
        }
        other => panic!("{other}"),
    }
    // This one reads well, but has no start.
    match prepare_error(job().set("block.rocker.at", "1 km")) {
        PrepareError::Load(LoadError::Invalid { text, found }) => {
            assert!(text.contains("[block.rocker]") && found.has_errors(), "{found}");
        }
        other => panic!("{other}"),
    }
    for text in [&b"\xff\xfe"[..], b"", b"a = "] {
        let error = prepare_error(RunJob::new(SceneSource::bytes(text, "text", "text")).folder(place.at("out")));
        assert!(matches!(&error, PrepareError::Load(LoadError::Invalid { .. })), "{error}");
    }
    let nowhere = RunJob::new(SceneSource::file(place.at("nowhere.toml"))).folder(place.at("out"));
    assert!(matches!(prepare_error(nowhere), PrepareError::Load(LoadError::Unreadable { .. })));
    for seconds in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(prepare_error(job().checkpoint_every(seconds)), PrepareError::Interval(_)), "{seconds}");
    }
    let error = prepare_error(job().from_state(place.at("nowhere.bin")));
    assert!(matches!(error, PrepareError::State(_)), "{error}");
    let error = prepare_error(job().dump_unconverged(place.at("nowhere/state.bin")));
    assert!(matches!(error, PrepareError::NoFolder(_)), "{error}");
    assert!(!place.0.exists(), "nothing is written");

    // Neither is anything changed that is there.
    std::fs::create_dir_all(place.at("out")).unwrap();
    let error = prepare_error(job().dump_unconverged(place.at("out")));
    assert!(matches!(error, PrepareError::FileIsFolder { .. }), "{error}");
    std::fs::write(place.at("out/trajectory.csv"), "t\n").unwrap();
    let error = prepare_error(job().export_problems(place.at("problems"), ExportWhen::Hard));
    assert!(matches!(error, PrepareError::Folder(_)), "{error}");
    let error = prepare_error(job().folder(place.at("out/trajectory.csv")));
    assert!(matches!(error, PrepareError::Folder(_)), "{error}");
    // Nobody knows of which scene the table is.
    let error = prepare_error(job().existing(ExistingResults::Resume));
    assert!(matches!(error, PrepareError::Resume(_)), "{error}");
    let left = BTreeMap::from([(PathBuf::from("out/trajectory.csv"), "t\n".to_owned())]);
    assert_eq!(results(&place.0), left);
    // Replacing it is fine.
    let done =
        job().set("time.end", "1 ms").existing(ExistingResults::Replace).prepare().unwrap().run(Hooks::new()).unwrap();
    assert_eq!(done.ended(), EndedWord::Complete);
}

#[test]
fn what_the_run_reads_is_never_replaced() {
    let place = Place::new("reads");
    let done = unsolved().folder(place.at("out")).prepare().unwrap().run(Hooks::new()).unwrap();
    let scene = done.folder.join("scene.toml");
    let before = results(&place.0);
    let again = RunJob::new(SceneSource::file(scene)).folder(&done.folder).existing(ExistingResults::Replace);
    let error = prepare_error(again);
    assert!(matches!(error, PrepareError::Folder(_)), "{error}");
    assert!(results(&place.0) == before);
}

#[test]
fn a_folder_has_one_run_at_a_time() {
    let place = Place::new("one");
    let other = Cell::new(None);
    let job = rocking().set("time.end", "1 ms").folder(place.at("out")).existing(ExistingResults::Replace);
    let prepared = job.clone().prepare().unwrap();
    // The folder is ours when the hook is called, and not before.
    job.clone().prepare().unwrap().run(Hooks::new().on_start(|| other.set(Some(prepared.run(Hooks::new()))))).unwrap();
    assert!(matches!(other.take(), Some(Err(RunError::Folder(_)))));
    assert_eq!(job.prepare().unwrap().run(Hooks::new()).unwrap().ended(), EndedWord::Complete);
}

#[test]
fn warnings_come_as_they_are_met_and_the_state_before_the_first_is_kept() {
    let place = Place::new("warnings");
    let warnings = RefCell::new(Vec::new());
    let job = unsolved().folder(place.at("out")).dump_unconverged(place.at("out/state.bin"));
    // Its folder must be there.
    std::fs::create_dir_all(place.at("out")).unwrap();
    let hooks = Hooks::new().on_warning(|text| warnings.borrow_mut().push(text.to_owned()));
    let done = job.prepare().unwrap().run(hooks).unwrap();
    let state = place.at("out/state.bin");
    assert_eq!(done.dump, Some(StateDump::Written(state.clone())));
    let unsolved_steps = done.summary.contact.unconverged_steps;
    let told = warnings.borrow().iter().filter(|text| text.contains("was not solved")).count() as u64;
    assert!(told >= 3 && told < unsolved_steps, "{told} of {unsolved_steps}");

    let again = |sets: fn(RunJob) -> RunJob, folder: &str| {
        let job = sets(unsolved().folder(place.at(folder)).from_state(&state));
        let prepared = job.dump_unconverged(place.at("none.bin")).prepare().unwrap();
        let first = prepared.first_step();
        (first, prepared.run(Hooks::new()).unwrap())
    };
    let (_, solved) = again(|job| job.set("solver.max_iterations", "1000").set("solver.tolerance", "1e-10"), "solved");
    assert_eq!(solved.dump, Some(StateDump::NotNeeded(place.at("none.bin"))));
    assert!(!place.at("none.bin").exists());
    // The first step of the run is the one that was not solved.
    let (first, strict) = again(|job| job.set("solver.require_convergence", "true"), "strict");
    assert_eq!((strict.ended(), strict.summary.steps), (EndedWord::Unconverged, first + 1));
}

#[test]
fn contact_problems_are_saved_and_counted() {
    let place = Place::new("problems");
    let job = rocking().set("time.end", "20 ms").folder(place.at("out"));
    let job = job.export_problems(place.at("problems"), ExportWhen::Every(50));
    let done = job.prepare().unwrap().run(Hooks::new()).unwrap();
    let exported = done.exported.unwrap();
    assert_eq!(exported.folder, place.at("problems"));
    let names: Vec<_> = results(&exported.folder).into_keys().collect();
    assert!(exported.count > 0 && names.len() as u64 == exported.count, "{names:?}");
    assert!(names.iter().all(|name| name.to_string_lossy().starts_with("free-rocking-on-beam-step")), "{names:?}");
}

/// A block that stands on its edge falls, to a side that nobody knows; one that rocks is known to
/// the end.
#[test]
fn the_horizon_is_found_on_demand() {
    let place = Place::new("horizon");
    let run =
        |job: RunJob, name: &str| job.folder(place.at(name)).prepare().unwrap().run(Hooks::new()).unwrap().summary;
    let rocking = || scenario("free-rocking-on-ground").set("time.step", "1 ms");
    assert_eq!(run(rocking(), "unasked").horizon, None);
    let known = run(rocking().horizon(), "known");
    assert_eq!(known.horizon, Some(1.0));
    assert!(known.warnings.iter().all(|warning| warning.code != "horizon"));
    // tan α = 3 cm/13.5 cm, to the last digit.
    let balanced = rocking().set("block.rocker.tilt", "12.528807709151511 deg").set("time.end", "5 s").horizon();
    let fallen = run(balanced, "balanced");
    // e^(pt) of 1e-12 rad is 1 % of the fall after some 20/p.
    let horizon = fallen.horizon.unwrap();
    assert!((1.0..4.5).contains(&horizon), "{horizon}");
    let told = fallen.warnings.iter().find(|warning| warning.code == "horizon").unwrap();
    assert!(told.text.contains("the motion is that sensitive there"), "{}", told.text);
    assert_eq!(told.first_t, Some(horizon));
}

/// A block that falls beside so many that stay.
fn falling_beside(fixed: usize) -> RunJob {
    let scene = format!(
        "[time]\nend = '0.3 s'\nstep = '1 ms'\n[output]\nevery = '50 ms'\n[ground]\n\
         [block.post]\ndensity = '2000 kg/m^3'\nwidth = '10 cm'\nheight = '10 cm'\ndepth = '10 cm'\nposition = ['1 m', '5 cm']\n\
         fixed = true\nrepeat = {{ count = {fixed}, shift = ['20 cm', '0 cm'] }}\n\
         [block.stone]\ndensity = '2000 kg/m^3'\nwidth = '10 cm'\nheight = '10 cm'\ndepth = '10 cm'\nposition = ['0 m', '15 cm']\n\
         [contact.floor]\nbetween = ['stone', 'ground']\nfriction = 0.5\n"
    );
    RunJob::new(SceneSource::bytes(scene, "<memory>", "falling")).without_report()
}

/// The names of the columns of a table, and its rows.
fn table(text: &str) -> (Vec<&str>, Vec<Vec<&str>>) {
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    (lines.next().unwrap(), lines.collect())
}

/// 30 000 columns are of no use to anyone: beyond 2000 blocks each has a row at each time, with the numbers of the columns that
/// can be asked for.
#[test]
fn very_many_blocks_have_rows_instead_of_columns() {
    let place = Place::new("rows");
    let run = |name: &str, job: RunJob| {
        let done = job.folder(place.at(name)).prepare().unwrap().run(Hooks::new()).unwrap();
        assert_eq!(done.ended(), EndedWord::Complete);
        results(&done.folder)
    };
    let text = |files: &BTreeMap<PathBuf, String>, name: &str| files.get(Path::new(name)).cloned();
    let (few, many) = (run("few", falling_beside(1999)), run("many", falling_beside(2000)));
    assert_eq!((text(&few, "blocks.csv"), table(&text(&few, "trajectory.csv").unwrap()).0.len()), (None, 1 + 6 * 2000));
    let trajectory = text(&many, "trajectory.csv").unwrap();
    assert_eq!(table(&trajectory).0, ["t"]);
    let all = run("all", falling_beside(2000).set("output.blocks", "[\"*\"]"));
    assert_eq!(text(&all, "blocks.csv"), None);
    let (rows, columns) = (text(&many, "blocks.csv").unwrap(), text(&all, "trajectory.csv").unwrap());
    let ((heading, rows), (_, columns)) = (table(&rows), table(&columns));
    assert_eq!(heading, ["t", "block", "x", "y", "phi", "vx", "vy", "omega"]);
    assert_eq!((rows.len(), columns.len()), (2001 * 7, 7));
    for (at, row) in rows.iter().enumerate() {
        let (time, block) = (&columns[at / 2001], at % 2001);
        let name = if block == 2000 { "stone".to_owned() } else { format!("post-{}", block + 1) };
        assert_eq!((row[0], row[1]), (time[0], name.as_str()));
        assert_eq!(row[2..], time[1 + 6 * block..7 + 6 * block]);
    }
    // The units of these columns, too, and only of tables that there are.
    let units = |files| serde_json::from_str::<serde_json::Value>(&text(files, "columns.json").unwrap()).unwrap();
    assert_eq!(units(&many)["blocks.csv"][1], serde_json::json!(["block", ""]));
    assert_eq!(units(&many)["trajectory.csv"], serde_json::json!([["t", "s"]]));
    assert!(units(&all)["blocks.csv"].is_null());
    let written = text(&many, "scene.toml").unwrap();
    assert!(!written.contains("blocks = "), "{written}");
}

#[test]
fn blocks_that_the_scene_names_have_columns_and_others_are_in_no_table() {
    let place = Place::new("chosen");
    for fixed in [3, 2001] {
        let job =
            falling_beside(fixed).set("output.blocks", "[\"post-2\", \"s*\"]").folder(place.at(&fixed.to_string()));
        let files = results(&job.prepare().unwrap().run(Hooks::new()).unwrap().folder);
        let (heading, rows) = table(&files[Path::new("trajectory.csv")]);
        let wanted = ["post-2", "stone"]
            .iter()
            .flat_map(|block| ["x", "y", "phi", "vx", "vy", "omega"].map(|of| format!("{block}.{of}")));
        assert_eq!(heading, ["t".to_owned()].into_iter().chain(wanted).collect::<Vec<_>>());
        assert_eq!((rows.len(), rows[0][1], rows[0][8]), (7, "1.2", "0.15"));
        assert!(!files.contains_key(Path::new("blocks.csv")));
        assert!(files[Path::new("scene.toml")].contains("blocks = [\"post-2\", \"s*\"]"));
    }
}

#[test]
fn a_run_of_very_many_blocks_goes_on_to_the_same_bytes() {
    let place = Place::new("many");
    let job = || falling_beside(2000).checkpoint_every(10.0).existing(ExistingResults::Resume);
    let alone = job().folder(place.at("alone")).prepare().unwrap().run(Hooks::new()).unwrap();
    let cancel = Arc::new(AtomicBool::new(false));
    let stop = |progress: Progress| cancel.store(progress.step >= PROGRESS_STEPS, Ordering::Relaxed);
    let hooks = Hooks::new().cancelled_by(&cancel).on_progress(stop);
    let part = job().folder(place.at("parts")).prepare().unwrap().run(hooks).unwrap();
    assert_eq!(part.ended(), EndedWord::Interrupted);
    let prepared = job().folder(place.at("parts")).prepare().unwrap();
    assert!(matches!(prepared.start(), RunStart::Checkpoint { .. }), "{:?}", prepared.start());
    prepared.run(Hooks::new()).unwrap();
    assert!(results(&place.at("parts")) == results(&alone.folder));
    assert!(place.at("parts/blocks.csv").exists());
}
