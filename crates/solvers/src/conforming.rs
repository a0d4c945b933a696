//! The conformance run of methods that don't solve a block whose diagonal spans 13 powers of ten,
//! and report this.

use teeter_contact::conformance::{plane_cases, run, space_cases};
use teeter_contact::{ContactSolver, Stop, Vector, judge};

/// All cases must be solved to 1e-12 except those of uneven scales, for which the reported outcome
/// must be correct.
pub(crate) fn conforms_but_for_uneven_scales(plane: &mut dyn ContactSolver<2>, space: &mut dyn ContactSolver<3>) {
    run(plane, &plane_cases(), 1e-12).unwrap();
    let (uneven, even): (Vec<_>, Vec<_>) =
        space_cases().into_iter().partition(|case| case.name.contains("uneven scales"));
    run(space, &even, 1e-12).unwrap();
    for case in &uneven {
        let mut p = vec![Vector::<3>::zeros(); case.q.len()];
        let outcome = space.fork().solve(&case.problem().unwrap(), &Stop::default(), &mut p);
        let judged = judge(&case.problem().unwrap(), &p).global;
        assert!(judged <= 1.0 && outcome.converged() == (judged <= Stop::default().tolerance), "{outcome:?}");
    }
}
