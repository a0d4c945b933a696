//! Reading a file into a problem.

use crate::store::Store;
use crate::{FclibError, FclibProblem, Info, LocalProblem, Solution, matrix};
use std::io::Read;
use std::path::Path;
use teeter_contact::Vector;

/// Reads a file.
///
/// # Errors
/// If the file can't be read, isn't HDF5, or doesn't contain a valid local contact problem; see
/// [`FclibError`].
pub fn read(path: impl AsRef<Path>) -> Result<FclibProblem, FclibError> {
    let mut file = std::fs::File::open(path)?;
    // The signature is checked first, so that a huge file or an endless device isn't read in full.
    let mut bytes = Vec::new();
    file.by_ref().take(HEAD).read_to_end(&mut bytes)?;
    if hdf5_pure::is_hdf5_bytes(&bytes) {
        file.read_to_end(&mut bytes)?;
    }
    open(bytes)
}

/// Bytes within which the HDF5 signature is searched, unless a larger user block precedes it.
const HEAD: u64 = 1 << 20;

/// Reads a problem from the content of a file.
///
/// # Errors
/// As [`read`].
pub fn from_bytes(bytes: &[u8]) -> Result<FclibProblem, FclibError> {
    open(bytes.to_vec())
}

fn open(bytes: Vec<u8>) -> Result<FclibProblem, FclibError> {
    let store = Store::open(bytes)?;
    if !store.has_group("fclib_local")? {
        let global = store.has_group("fclib_global")?;
        return Err(if global { FclibError::GlobalProblem } else { FclibError::NoProblem });
    }
    match store.integer("fclib_local/spacedim")? {
        2 => Ok(FclibProblem::Plane(local(&store)?)),
        3 => Ok(FclibProblem::Space(local(&store)?)),
        other => Err(FclibError::SpaceDimension(other)),
    }
}

fn local<const D: usize>(store: &Store) -> Result<LocalProblem<D>, FclibError> {
    let rows = size_of_matrix::<D>(store)?;
    no_constraints(store)?;
    // The vectors are read first: they have as many entries as W has rows, so memory for W is only
    // allocated when the file is large enough to justify it.
    let q = contact_vectors(constant_vector(store)?, "fclib_local/vectors/q", rows)?;
    let mu = store.numbers("fclib_local/vectors/mu")?;
    expect("fclib_local/vectors/mu", mu.len(), rows / D)?;
    let h = matrix::read::<D>(store, rows)?;
    let mut problem = LocalProblem { h, q, mu, ..LocalProblem::default() };
    problem.problem()?;
    problem.info = info(store)?;
    problem.guesses = guesses(store, rows)?;
    if store.has_group("solution")? {
        problem.solution = Some(solution(store, "solution", rows)?);
    }
    Ok(problem)
}

/// The number of rows of W, checked to be square and a whole number of contacts.
fn size_of_matrix<const D: usize>(store: &Store) -> Result<usize, FclibError> {
    let (rows, columns) = (store.integer("fclib_local/W/m")?, store.integer("fclib_local/W/n")?);
    match u32::try_from(rows) {
        Ok(size) if rows == columns => {
            if !(size as usize).is_multiple_of(D) {
                return Err(FclibError::NotWholeContacts { rows, dimension: D });
            }
            Ok(size as usize)
        }
        _ => Err(FclibError::NotSquare { rows, columns }),
    }
}

fn no_constraints(store: &Store) -> Result<(), FclibError> {
    // R is p x p, V is m x p; p = 0 means no constraints.
    for (group, size) in [("fclib_local/R", "fclib_local/R/m"), ("fclib_local/V", "fclib_local/V/n")] {
        if store.has_group(group)? {
            let count = store.integer(size)?;
            if count != 0 {
                return Err(FclibError::EqualityConstraints(count));
            }
        }
    }
    match store.numbers_if_any("fclib_local/vectors/s")? {
        Some(s) if !s.is_empty() => Err(FclibError::EqualityConstraints(s.len() as i64)),
        _ => Ok(()),
    }
}

/// q; older versions of fclib wrote it as `a`.
fn constant_vector(store: &Store) -> Result<Vec<f64>, FclibError> {
    match store.numbers_if_any("fclib_local/vectors/q")? {
        Some(q) => Ok(q),
        None => match store.numbers_if_any("fclib_local/vectors/a")? {
            Some(q) => Ok(q),
            None => Err(FclibError::Missing { name: "fclib_local/vectors/q".to_owned() }),
        },
    }
}

fn info(store: &Store) -> Result<Info, FclibError> {
    Ok(Info {
        title: store.text_if_any("fclib_local/info/title")?,
        description: store.text_if_any("fclib_local/info/description")?,
        math_info: store.text_if_any("fclib_local/info/math_info")?,
    })
}

fn guesses<const D: usize>(store: &Store, rows: usize) -> Result<Vec<Solution<D>>, FclibError> {
    if !store.has_group("guesses")? {
        return Ok(Vec::new());
    }
    let count = store.integer("guesses/number_of_guesses")?;
    if count < 0 {
        return Err(FclibError::Guesses(count));
    }
    (1..=count).map(|k| solution(store, &format!("guesses/{k}"), rows)).collect()
}

fn solution<const D: usize>(store: &Store, group: &str, rows: usize) -> Result<Solution<D>, FclibError> {
    let vectors = |name: &str| {
        let name = format!("{group}/{name}");
        let vectors = contact_vectors::<D>(store.numbers(&name)?, &name, rows)?;
        for (contact, vector) in vectors.iter().enumerate() {
            if let Some(&value) = vector.iter().find(|c| !c.is_finite()) {
                return Err(FclibError::NotFinite { name, contact, value });
            }
        }
        Ok(vectors)
    };
    let others =
        |name: &str| Ok::<_, FclibError>(store.numbers_if_any(&format!("{group}/{name}"))?.unwrap_or_default());
    Ok(Solution { u: vectors("u")?, r: vectors("r")?, v: others("v")?, l: others("l")? })
}

fn contact_vectors<const D: usize>(values: Vec<f64>, name: &str, rows: usize) -> Result<Vec<Vector<D>>, FclibError> {
    expect(name, values.len(), rows)?;
    Ok(values.chunks_exact(D).map(Vector::<D>::from_column_slice).collect())
}

fn expect(name: &str, found: usize, expected: usize) -> Result<(), FclibError> {
    if found == expected {
        return Ok(());
    }
    Err(FclibError::Size { name: name.to_owned(), found: found as u64, expected: expected as u64 })
}
