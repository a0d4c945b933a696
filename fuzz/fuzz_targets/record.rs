//! Any bytes as an accelerogram. Nothing may panic, hang or take memory without bound; what is read can be measured, and
//! is the same when it is written as a table and read again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use teeter_record::Record;

fuzz_target!(|bytes: &[u8]| {
    for step in [None, Some(0.01)] {
        match Record::read_with_step(bytes, "any", step) {
            Err(error) => assert!(!error.to_string().is_empty()),
            Ok(record) => {
                assert!(record.arias_intensity() >= 0.0 && record.significant_duration() >= 0.0);
                let again = Record::read(record.to_table(), "any").expect("what is written can be read");
                assert_eq!((again.dt(), again.accelerations()), (record.dt(), record.accelerations()));
            }
        }
    }
});
