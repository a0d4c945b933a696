//! The list of solvers, for programs that let users choose.

#[cfg(feature = "sparse")]
use crate::Admm;
#[cfg(feature = "clarabel")]
use crate::{AcaryCadoux, Socp};
use crate::{Apgd, Auto, Enumeration, Lemke, Newton, Pgs, Prox, Smoothing, ViEg};
use teeter_contact::{ContactSolver, Law};

/// Description of a solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct SolverInfo {
    /// The name by which users choose it.
    pub name: &'static str,
    /// The dimensions that it supports.
    pub dimensions: &'static [usize],
    /// The contact law of its results.
    pub law: Law,
    /// Largest number of contacts; `None` if unlimited.
    pub most_contacts: Option<usize>,
    /// A one-line description.
    pub summary: &'static str,
    /// The paper of the method.
    pub reference: &'static str,
}

/// All solvers of this crate.
pub const SOLVERS: &[SolverInfo] = &[
    SolverInfo {
        name: Auto::<2>::NAME,
        dimensions: &[2, 3],
        law: Law::Exact,
        most_contacts: None,
        summary: "automatic: enumeration for few plane contacts, else pgs, admm, newton, smoothing, prox until one succeeds",
        reference: "",
    },
    SolverInfo {
        name: Enumeration::NAME,
        dimensions: &[2],
        law: Law::Exact,
        most_contacts: Some(Enumeration::MAX_CONTACTS),
        summary: "exact enumeration of contact states; up to five contacts",
        reference: "Klarbring 1990, doi 10.1007/BF00534316",
    },
    SolverInfo {
        name: Pgs::<2>::NAME,
        dimensions: &[2, 3],
        law: Law::Exact,
        most_contacts: None,
        summary: "Gauss-Seidel over contacts with an exact local solve",
        reference: "Jean 1999, doi 10.1016/S0045-7825(98)00383-1",
    },
    SolverInfo {
        name: Newton::<2>::NAME,
        dimensions: &[2, 3],
        law: Law::Exact,
        most_contacts: None,
        summary: "semi-smooth Newton with sparse LU and sweeps of pgs",
        reference: "Alart and Curnier 1991, doi 10.1016/0045-7825(91)90022-X",
    },
    SolverInfo {
        name: Smoothing::<2>::NAME,
        dimensions: &[2, 3],
        law: Law::Exact,
        most_contacts: None,
        summary: "Newton along the central path of the smoothed law, for degenerate problems",
        reference: "Hayashi, Yamashita and Fukushima 2005, doi 10.1137/S1052623403421516",
    },
    SolverInfo {
        name: Prox::<2>::NAME,
        dimensions: &[2, 3],
        law: Law::Exact,
        most_contacts: None,
        summary: "proximal point method around newton, for singular H",
        reference: "Acary, Bremond and Huber 2018, doi 10.1007/978-3-319-75972-2_10",
    },
    SolverInfo {
        name: Lemke::NAME,
        dimensions: &[2],
        law: Law::Exact,
        most_contacts: Some(Lemke::MAX_CONTACTS),
        summary: "pivoting on the linear complementarity problem; up to 1000 contacts",
        reference: "Klarbring 1986, doi 10.1016/0045-7825(86)90074-8",
    },
    #[cfg(feature = "clarabel")]
    SolverInfo {
        name: AcaryCadoux::<2>::NAME,
        dimensions: &[2, 3],
        law: Law::Exact,
        most_contacts: None,
        summary: "fixed point over cone programs, with refinement",
        reference: "Acary, Cadoux, Lemarechal, Malick 2011, doi 10.1002/zamm.201000073",
    },
    #[cfg(feature = "sparse")]
    SolverInfo {
        name: Admm::<2>::NAME,
        dimensions: &[2, 3],
        law: Law::Exact,
        most_contacts: None,
        summary: "alternating directions (ADMM) with one factorisation, accelerated",
        reference: "Boyd et al. 2011, doi 10.1561/2200000016",
    },
    SolverInfo {
        name: Apgd::<2>::NAME,
        dimensions: &[2, 3],
        law: Law::Exact,
        most_contacts: None,
        summary: "accelerated projected gradients with an outer loop for the exact law",
        reference: "Mazhar, Heyn, Negrut, Tasora 2015, doi 10.1145/2735627",
    },
    #[cfg(feature = "clarabel")]
    SolverInfo {
        name: Socp::<2>::NAME,
        dimensions: &[2, 3],
        law: Law::Convex,
        most_contacts: None,
        summary: "associated law as a cone program: a sliding contact separates",
        reference: "Anitescu 2006, doi 10.1007/s10107-005-0590-7",
    },
    SolverInfo {
        name: ViEg::<2>::NAME,
        dimensions: &[2, 3],
        law: Law::Exact,
        most_contacts: None,
        summary: "projections with an adaptive step",
        reference: "Khobotov 1987, doi 10.1016/0041-5553(87)90058-9",
    },
];

/// The plane solver with this name; `None` if it is unknown.
///
/// ```
/// assert_eq!(teeter_solvers::plane_solver("pgs").unwrap().name(), "pgs");
/// assert!(teeter_solvers::plane_solver("magic").is_none());
/// ```
#[must_use]
pub fn plane_solver(name: &str) -> Option<Box<dyn ContactSolver<2>>> {
    match name {
        Auto::<2>::NAME => Some(Box::new(Auto::<2>::new())),
        Newton::<2>::NAME => Some(Box::new(Newton::<2>::new())),
        Smoothing::<2>::NAME => Some(Box::new(Smoothing::<2>::new())),
        Prox::<2>::NAME => Some(Box::new(Prox::<2>::new())),
        Enumeration::NAME => Some(Box::new(Enumeration)),
        Lemke::NAME => Some(Box::new(Lemke::new())),
        Pgs::<2>::NAME => Some(Box::new(Pgs::<2>::new())),
        #[cfg(feature = "clarabel")]
        AcaryCadoux::<2>::NAME => Some(Box::new(AcaryCadoux::<2>::new())),
        #[cfg(feature = "sparse")]
        Admm::<2>::NAME => Some(Box::new(Admm::<2>::new())),
        Apgd::<2>::NAME => Some(Box::new(Apgd::<2>::new())),
        #[cfg(feature = "clarabel")]
        Socp::<2>::NAME => Some(Box::new(Socp::<2>::new())),
        ViEg::<2>::NAME => Some(Box::new(ViEg::<2>::new())),
        _ => None,
    }
}

/// The solver with this name for contacts in space; `None` if it is unknown or supports only the
/// plane.
///
/// ```
/// assert_eq!(teeter_solvers::space_solver("pgs").unwrap().name(), "pgs");
/// assert!(teeter_solvers::space_solver("enumeration").is_none());
/// ```
#[must_use]
pub fn space_solver(name: &str) -> Option<Box<dyn ContactSolver<3>>> {
    match name {
        Auto::<3>::NAME => Some(Box::new(Auto::<3>::new())),
        Newton::<3>::NAME => Some(Box::new(Newton::<3>::new())),
        Smoothing::<3>::NAME => Some(Box::new(Smoothing::<3>::new())),
        Prox::<3>::NAME => Some(Box::new(Prox::<3>::new())),
        Pgs::<3>::NAME => Some(Box::new(Pgs::<3>::new())),
        #[cfg(feature = "clarabel")]
        AcaryCadoux::<3>::NAME => Some(Box::new(AcaryCadoux::<3>::new())),
        #[cfg(feature = "sparse")]
        Admm::<3>::NAME => Some(Box::new(Admm::<3>::new())),
        Apgd::<3>::NAME => Some(Box::new(Apgd::<3>::new())),
        #[cfg(feature = "clarabel")]
        Socp::<3>::NAME => Some(Box::new(Socp::<3>::new())),
        ViEg::<3>::NAME => Some(Box::new(ViEg::<3>::new())),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_listed_solver_matches_its_entry() {
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
