//! Any bytes are a record or an error, and what is written is read as it was.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::path::Path;

use proptest::prelude::*;
use teeter_record::Record;

/// Bytes such as a record has, so that readers are got into.
fn nearly_a_record() -> impl Strategy<Value = String> {
    let word = prop_oneof![
        Just("NPTS=  3, DT= .01 SEC"),
        Just("3 .01 NPTS, DT"),
        Just("NPTS=="),
        Just("ACCELERATION TIME HISTORY IN UNITS OF G"),
        Just("IN UNITS OF"),
        Just("NDATA: 3"),
        Just("SAMPLING_INTERVAL_S: 0.01"),
        Just("UNITS: cm/s^2"),
        Just("UNITS:"),
        Just("Corrected acceleration (Format v01.20 with 2 text lines)"),
        Just("(Format v1.2 with 99999999 text lines)"),
        Just("2 Integer-header values follow, Format=(3I4)"),
        Just("99999999 Real-header values, Format=(10I999)"),
        Just("0 Comment lines"),
        Just("3 acceleration pts, units=cm/sec2(04),Format=(8F10.5)"),
        Just("   1   1   4"),
        Just(".1-.2-.3"),
        Just("1e999"),
        Just("0.1E-010.2"),
        Just("-"),
        Just("t [s], a [m/s^2]"),
        Just("t (ms);a"),
        Just("0,1"),
        Just("0.5,2"),
        Just("1,5;3"),
        Just("1 2"),
        Just("End-of-data"),
        Just("# c"),
        Just("é\u{feff}"),
        Just(""),
    ];
    proptest::collection::vec(word, 0..12).prop_map(|lines| lines.join("\n"))
}

/// Reads, and asks all that can be asked of a record.
fn read(bytes: &[u8], step: Option<f64>) {
    match Record::read_with_step(bytes, "any", step) {
        Err(error) => assert!(!error.to_string().is_empty()),
        Ok(record) => {
            assert!(record.len() >= 2 && record.accelerations().iter().all(|a| a.is_finite()));
            let measures = [
                record.arias_intensity(),
                record.significant_duration(),
                record.velocity_peak().size,
                record.displacement_peak().size,
            ];
            assert!(measures.iter().all(|measure| *measure >= 0.0), "{measures:?}");
        }
    }
}

/// Bytes that mean something in records.
const SIGNS: &[u8] = b"0123456789.-+eE,; \n\r():=#GFN\xff\0";

/// A generator of equally likely numbers (Marsaglia's xorshift), the same in each run.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from(self.0 % end as u64).unwrap_or(0)
    }
}

#[test]
fn the_corpus_is_read_whole_cut_short_and_changed() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus/record");
    let mut numbers = Numbers(0x2545_F491_4F6C_DD1D);
    let mut files = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let whole = std::fs::read(&path).unwrap();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let step = (name == "accelerations-alone").then_some(0.01);
        assert_eq!(Record::read_with_step(&whole, "any", step).is_ok(), name != "peer-velocity", "{name}");
        for end in 0..whole.len() {
            read(&whole[..end], step);
        }
        for _ in 0..2000 {
            let mut changed = whole.clone();
            for _ in 0..=numbers.below(4) {
                let at = numbers.below(changed.len());
                changed[at] = SIGNS[numbers.below(SIGNS.len())];
            }
            read(&changed, step);
        }
        files += 1;
    }
    assert!(files >= 8, "{files} files of the corpus");
}

proptest! {
    #[test]
    fn any_bytes_are_a_record_or_an_error(bytes in proptest::collection::vec(any::<u8>(), 0..400), step in any::<Option<f64>>()) {
        read(&bytes, step);
    }

    #[test]
    fn parts_of_records_are_a_record_or_an_error(text in nearly_a_record(), step in proptest::option::of(1e-3..1.0)) {
        read(text.as_bytes(), step);
    }

    #[test]
    fn what_is_written_is_read_as_it_was(
        dt in prop_oneof![1e-9..1e6_f64, Just(0.005), Just(0.00244), Just(1.0 / 256.0), Just(0.02)],
        values in proptest::collection::vec(-1e12..1e12_f64, 2..300),
    ) {
        let record = Record::new("R", dt, values).unwrap();
        prop_assert_eq!(Record::read(record.to_table(), "R").unwrap(), record);
    }

    #[test]
    fn corrections_refuse_or_give_records(
        values in proptest::collection::vec(-10.0..10.0_f64, 2..60),
        number in any::<f64>(),
        other in any::<f64>(),
        degree in 0..8_usize,
    ) {
        let record = Record::new("R", 0.01, values).unwrap();
        for made in [
            record.scaled(number),
            record.scaled_to_peak(number),
            record.cut(number, other),
            record.tapered(number),
            record.baseline_corrected(degree),
        ].into_iter().flatten() {
            prop_assert!(made.len() >= 2 && made.accelerations().iter().all(|a| a.is_finite()));
        }
        let _ = record.spectrum(number, &[other]);
    }
}
