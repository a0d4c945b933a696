//! What must hold of any scene, over random ones (`docs/properties.md`): symmetries of the motion,
//! and balances of each step.
//!
//! A scene that fails is shrunk, shown as TOML, and left for `teeter run` in
//! `target/tmp/PROPERTY.toml`; its seed goes to `proptest-regressions/`, and is tried first from
//! then on. `PROPTEST_CASES=10000` looks further than CI does, `PROPTEST_RNG_SEED` elsewhere.

mod balances;
mod drawn;
mod motion;
mod strategy;
mod symmetries;

use drawn::Drawn;
use motion::NoMotion;
use proptest::prelude::*;
use proptest::test_runner::{FileFailurePersistence, RngSeed, TestError, TestRunner};
use std::cell::Cell;
use std::path::Path;

/// Scenes of each property in CI.
const FEW: u32 = 64;

/// What a property found in one scene.
pub(crate) struct Checked {
    /// Rows, or steps, that could be judged.
    pub(crate) judged: usize,
    /// And those that there were.
    pub(crate) of: usize,
}

/// Tries a property on random scenes, each with a random choice of its own.
///
/// # Panics
/// If it fails for one; or if most scenes are refused, or most of the motion lies beyond the
/// horizon: it would show nothing.
pub(crate) fn check<C: std::fmt::Debug>(
    name: &str,
    regressions: &'static str,
    choice: impl Strategy<Value = C>,
    property: impl Fn(&Drawn, &C) -> Result<Result<Checked, String>, NoMotion>,
) {
    let mut config = ProptestConfig {
        failure_persistence: Some(Box::new(FileFailurePersistence::Direct(regressions))),
        max_shrink_iters: 4000,
        ..ProptestConfig::default()
    };
    if std::env::var_os("PROPTEST_CASES").is_none() {
        config.cases = FEW;
    }
    // The same scenes in every run: a build must not fail by chance.
    if config.rng_seed == RngSeed::Random {
        config.rng_seed = RngSeed::Fixed(1);
    }
    config.max_global_rejects = 4 * config.cases;
    let (judged, of) = (Cell::new(0), Cell::new(0));
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.toml"));
    let mut runner = TestRunner::new(config);
    let outcome = runner.run(&(strategy::scene(), choice), |(drawn, choice)| {
        let found = match property(&drawn, &choice) {
            Ok(Ok(checked)) => {
                judged.set(judged.get() + checked.judged);
                of.set(of.get() + checked.of);
                return Ok(());
            }
            Err(NoMotion::Refused(why)) => return Err(TestCaseError::reject(why)),
            Err(NoMotion::Failed(why)) | Ok(Err(why)) => why,
        };
        // Shrinking fails last with the scene that it ends with.
        std::fs::write(&file, drawn.to_toml()).map_err(|error| TestCaseError::fail(error.to_string()))?;
        Err(TestCaseError::fail(found))
    });
    match outcome {
        Ok(()) => {}
        Err(TestError::Fail(why, (drawn, choice))) => {
            panic!("{name}: {why}\nwith {choice:?}, in {}:\n{drawn:?}", file.display())
        }
        Err(TestError::Abort(why)) => panic!("{name}: {why}"),
    }
    let (judged, of) = (judged.get(), of.get());
    eprintln!("{name}: {judged} of {of} steps judged");
    assert!(2 * judged > of, "{name}: only {judged} of {of} steps could be judged");
}
