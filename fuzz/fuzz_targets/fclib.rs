//! Any bytes as an FCLIB file. Nothing may panic, hang or take memory without bound; what is read can be written, and is
//! the same when read again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use teeter_fclib::{FclibProblem, from_bytes};

fuzz_target!(|bytes: &[u8]| {
    match from_bytes(bytes) {
        Err(error) => assert!(!error.to_string().is_empty()),
        Ok(problem) => {
            match &problem {
                FclibProblem::Plane(local) => assert!(local.problem().is_ok()),
                FclibProblem::Space(local) => assert!(local.problem().is_ok()),
            }
            let again = problem.to_bytes().expect("what is read can be written");
            assert_eq!(from_bytes(&again).expect("what is written can be read"), problem);
        }
    }
});
