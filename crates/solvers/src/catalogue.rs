//! The solvers by name, for programs that let their users choose.

use crate::{Auto, Enumeration, Pgs};
use teeter_contact::{ContactSolver, Law};

/// What a user wants to know of a solver before choosing it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct SolverInfo {
    /// The name by which it is chosen.
    pub name: &'static str,
    /// The dimensions that it solves.
    pub dimensions: &'static [usize],
    /// The law of its results.
    pub law: Law,
    /// What it does, in a line.
    pub summary: &'static str,
    /// The paper that it comes from.
    pub reference: &'static str,
}

/// All solvers of this crate.
pub const SOLVERS: &[SolverInfo] = &[
    SolverInfo {
        name: Auto::NAME,
        dimensions: &[2],
        law: Law::Exact,
        summary: "contacts that couple together: enumeration up to three, pgs above and where enumeration fails",
        reference: "",
    },
    SolverInfo {
        name: Enumeration::NAME,
        dimensions: &[2],
        law: Law::Exact,
        summary: "all contact states, exactly; up to three contacts",
        reference: "Klarbring 1990, doi 10.1007/BF00534316",
    },
    SolverInfo {
        name: Pgs::<2>::NAME,
        dimensions: &[2, 3],
        law: Law::Exact,
        summary: "Gauss-Seidel over contacts with an exact local solve",
        reference: "Jean 1999, doi 10.1016/S0045-7825(98)00383-1",
    },
];

/// The plane solver of that name; `None` for an unknown one.
///
/// ```
/// assert_eq!(teeter_solvers::plane_solver("pgs").unwrap().name(), "pgs");
/// assert!(teeter_solvers::plane_solver("magic").is_none());
/// ```
#[must_use]
pub fn plane_solver(name: &str) -> Option<Box<dyn ContactSolver<2>>> {
    match name {
        Auto::NAME => Some(Box::new(Auto::new())),
        Enumeration::NAME => Some(Box::new(Enumeration)),
        Pgs::<2>::NAME => Some(Box::new(Pgs::<2>::new())),
        _ => None,
    }
}

/// The solver of that name for contacts in space; `None` for an unknown one, and for one that knows the plane only.
///
/// ```
/// assert_eq!(teeter_solvers::space_solver("pgs").unwrap().name(), "pgs");
/// assert!(teeter_solvers::space_solver("enumeration").is_none());
/// ```
#[must_use]
pub fn space_solver(name: &str) -> Option<Box<dyn ContactSolver<3>>> {
    match name {
        Pgs::<3>::NAME => Some(Box::new(Pgs::<3>::new())),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_listed_solver_can_be_made_and_agrees_with_its_entry() {
        for info in SOLVERS {
            assert_eq!(info.dimensions.contains(&2), plane_solver(info.name).is_some());
            assert_eq!(info.dimensions.contains(&3), space_solver(info.name).is_some());
            if let Some(solver) = plane_solver(info.name) {
                assert_eq!((solver.name(), solver.law()), (info.name, info.law));
                assert_eq!(solver.fork().name(), info.name);
            }
            if let Some(solver) = space_solver(info.name) {
                assert_eq!((solver.name(), solver.law()), (info.name, info.law));
                assert_eq!(solver.fork().name(), info.name);
            }
        }
    }
}
