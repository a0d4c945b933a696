//! The published problems beside the repository, where they are: all are read, and are what their
//! table says.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::path::{Path, PathBuf};
use teeter_fclib::{FclibProblem, LocalProblem};

fn published() -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/problems");
    if root.join("problems.csv").is_file() {
        return Some(root);
    }
    println!("skipped: {} is missing", root.display());
    None
}

#[test]
fn every_published_problem_is_read_with_the_size_and_asymmetry_of_the_table() {
    let Some(root) = published() else { return };
    let table = std::fs::read_to_string(root.join("problems.csv")).unwrap();
    let mut lines = table.lines();
    let header: Vec<_> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|h| *h == name).unwrap();
    let (file, dimension, contacts) = (column("file"), column("dimension"), column("contacts"));
    let (norm_q, table_asymmetry, entries) = (column("norm_q"), column("asymmetry"), column("nnz"));
    let mut read = 0;
    for line in lines {
        let cells: Vec<_> = line.split(',').collect();
        let problem = teeter_fclib::read(root.join(cells[file])).unwrap_or_else(|e| panic!("{}: {e}", cells[file]));
        assert_eq!(problem.dimension().to_string(), cells[dimension], "{}", cells[file]);
        assert_eq!(problem.contacts().to_string(), cells[contacts], "{}", cells[file]);
        assert!(problem.info().title.is_some());
        let (asymmetry, norm, stored) = match &problem {
            FclibProblem::Plane(local) => measured(local),
            FclibProblem::Space(local) => measured(local),
        };
        let given = |k: usize| cells[k].parse::<f64>().unwrap();
        // The table prints three and seven digits.
        assert!((asymmetry - given(table_asymmetry)).abs() <= 6e-3 * asymmetry + 1e-15, "{}: {asymmetry}", cells[file]);
        assert!((norm - given(norm_q)).abs() <= 1e-6 * norm, "{}: {norm}", cells[file]);
        assert_eq!(stored, cells[entries].parse::<usize>().unwrap(), "{}", cells[file]);
        read += 1;
    }
    assert_eq!(read, 45);
}

fn measured<const D: usize>(local: &LocalProblem<D>) -> (f64, f64, usize) {
    let norm = local.q.iter().map(|q| q.norm_squared()).sum::<f64>().sqrt();
    let stored = local.h.blocks().iter().flat_map(|b| b.iter()).filter(|c| c.to_bits() != 0).count();
    (local.problem().unwrap().asymmetry(), norm, stored)
}
