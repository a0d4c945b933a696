//! Any bytes as a table of measured motion, after a line `===` with a layout before it. Nothing may panic, hang or take memory without
//! bound; what is read ascends in time and has a value or a gap in each row.
#![no_main]

use libfuzzer_sys::fuzz_target;
use teeter_study::measured::{ColumnLayout, Measured, Sign};

fuzz_target!(|bytes: &[u8]| {
    let mark = b"\n===\n";
    let (layout, table) = match bytes.windows(mark.len()).position(|part| part == mark) {
        Some(at) => match ColumnLayout::read(&String::from_utf8_lossy(&bytes[..at]), "columns.toml") {
            Ok(layout) => (layout, &bytes[at + mark.len()..]),
            Err(_) => return,
        },
        None => (ColumnLayout::default(), bytes),
    };
    match Measured::read(table, &layout, "rocker") {
        Err(error) => assert!(!error.to_string().is_empty()),
        Ok(measured) => {
            let motion = measured.motion(Sign::Reversed);
            assert!(motion.t.windows(2).all(|t| t[0] < t[1]) && motion.interval() > 0.0);
            let values = motion.values(motion.leading()).expect("it leads");
            assert!(values.len() == motion.t.len() && values.iter().all(|value| !value.is_infinite()));
        }
    }
});
