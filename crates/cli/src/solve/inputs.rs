//! Selects problems and solvers, before anything runs.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use teeter_fclib::FclibProblem;
use teeter_scenario::suggest::nearest;
use teeter_solvers::{SOLVERS, SolverInfo};

/// A problem with the name of its file.
pub(super) struct Input {
    pub(super) file: String,
    /// The file's name without its ending.
    pub(super) stem: String,
    pub(super) problem: FclibProblem,
    pub(super) asymmetry: f64,
}

/// The files among `paths`: a folder stands for all `*.hdf5` below it, sorted. All errors are
/// reported at once.
pub(super) fn files(paths: &[PathBuf]) -> Result<Vec<PathBuf>, String> {
    let (mut files, mut faults) = (Vec::new(), Vec::new());
    for path in paths {
        if !path.is_dir() {
            files.push(path.clone());
            continue;
        }
        let mut below = Vec::new();
        match collect(path, &mut below) {
            Ok(()) if below.is_empty() => faults.push(format!("error: {}: no *.hdf5 in this folder", path.display())),
            Ok(()) => {
                below.sort();
                files.append(&mut below);
            }
            Err(error) => faults.push(format!("error: {}: {error}", path.display())),
        }
    }
    let mut seen = std::collections::BTreeSet::new();
    files.retain(|file| seen.insert(file.clone()));
    if faults.is_empty() { Ok(files) } else { Err(faults.join("\n")) }
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let path = entry.path();
        // A link to a folder is not followed, as it may form a cycle.
        if entry.file_type()?.is_dir() {
            collect(&path, files)?;
        } else if path.extension().is_some_and(|ending| ending == "hdf5") {
            files.push(path);
        }
    }
    Ok(())
}

/// Reads all files; all errors are reported at once.
pub(super) fn read(files: &[PathBuf]) -> Result<Vec<Input>, String> {
    let (mut inputs, mut faults) = (Vec::new(), Vec::new());
    for path in files {
        let file = path.display().to_string();
        match read_one(path) {
            Ok((problem, asymmetry)) => {
                let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                inputs.push(Input { file, stem, problem, asymmetry });
            }
            Err(why) => faults.push(format!("error: {file}: {why}")),
        }
    }
    if faults.is_empty() { Ok(inputs) } else { Err(faults.join("\n")) }
}

fn read_one(path: &Path) -> Result<(FclibProblem, f64), String> {
    let problem = teeter_fclib::read(path).map_err(|error| match &error {
        teeter_fclib::FclibError::Io(io) if io.kind() == std::io::ErrorKind::NotFound => "no such file".to_owned(),
        _ => error.to_string(),
    })?;
    let asymmetry = match &problem {
        FclibProblem::Plane(local) => local.problem().map(|problem| problem.asymmetry()),
        FclibProblem::Space(local) => local.problem().map(|problem| problem.asymmetry()),
    };
    Ok((problem, asymmetry.map_err(|error| error.to_string())?))
}

/// The solvers selected by `--solver`.
#[derive(Clone, Debug)]
pub(super) enum Choice {
    /// Every solver, on every problem that it supports.
    All,
    /// These, on every problem.
    Named(Vec<&'static SolverInfo>),
}

impl Choice {
    /// The solvers for problems of that dimension.
    pub(super) fn of_dimension(&self, dimension: usize) -> Vec<&'static SolverInfo> {
        match self {
            Self::All => SOLVERS.iter().filter(|info| info.dimensions.contains(&dimension)).collect(),
            Self::Named(infos) => infos.clone(),
        }
    }
}

impl Choice {
    /// Whether a solver should try a problem: with `all` only if it takes that many contacts,
    /// otherwise always.
    pub(super) fn can_solve(&self, info: &SolverInfo, input: &Input) -> bool {
        match self {
            Self::All => info.most_contacts.is_none_or(|most| input.problem.contacts() <= most),
            Self::Named(_) => true,
        }
    }
}

/// Interprets the names after `--solver`. These may include files, as in
/// `solve --solver pgs problem.hdf5`: a name that is not a solver but exists on disk is added to
/// `paths`.
pub(super) fn choose(names: &[String], paths: &mut Vec<PathBuf>) -> Result<Choice, String> {
    let (mut chosen, mut all) = (Vec::new(), false);
    for name in names {
        let known = SOLVERS.iter().find(|info| info.name == name);
        match known {
            Some(info) if chosen.iter().any(|other: &&SolverInfo| other.name == info.name) => {}
            Some(info) => chosen.push(info),
            None if name == "all" => all = true,
            None if Path::new(name).exists() => paths.push(PathBuf::from(name)),
            None => {
                let known = SOLVERS.iter().map(|info| info.name).chain(["all"]);
                let hint = match nearest(name, known.clone()) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => format!("there are {}", known.collect::<Vec<_>>().join(", ")),
                };
                return Err(format!("error: there is no solver `{name}`; {hint}"));
            }
        }
    }
    if all {
        return Ok(Choice::All);
    }
    if chosen.is_empty() {
        chosen.extend(SOLVERS.iter().find(|info| info.name == teeter_solvers::Auto::<2>::NAME));
    }
    Ok(Choice::Named(chosen))
}

/// Refuses a solver requested by name that doesn't support one of the problems.
pub(super) fn check_dimensions(choice: &Choice, inputs: &[Input]) -> Result<(), String> {
    let Choice::Named(infos) = choice else { return Ok(()) };
    let mut faults = Vec::new();
    for info in infos {
        let unfit: Vec<_> =
            inputs.iter().filter(|input| !info.dimensions.contains(&input.problem.dimension())).collect();
        if let Some(first) = unfit.first() {
            let taken: Vec<_> = info.dimensions.iter().map(|d| format!("{d}D")).collect();
            let others = if unfit.len() > 1 { format!(" (and {} more)", unfit.len() - 1) } else { String::new() };
            faults.push(format!(
                "error: solver `{}` takes {} problems only, but {}{others} is {}D",
                info.name,
                taken.join(" and "),
                first.file,
                first.problem.dimension()
            ));
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults.join("\n")) }
}

/// Refuses two problems with the same name, whose solutions would have the same file.
pub(super) fn check_stems(inputs: &[Input]) -> Result<(), String> {
    let mut seen = BTreeMap::new();
    for input in inputs {
        if let Some(first) = seen.insert(&input.stem, &input.file) {
            return Err(format!(
                "error: {first} and {} have the same name: their solutions would go to the same file",
                input.file
            ));
        }
    }
    Ok(())
}
