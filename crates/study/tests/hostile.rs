//! Any bytes are a table of measured motion or an error.
#![allow(clippy::unwrap_used)] // a test

use std::path::Path;
use teeter_study::measured::{Channel, ColumnLayout, Measured, Sign};

/// Bytes that mean something in tables.
const SIGNS: &[u8] = b"0123456789.-+eE,;\t \n\r\"#[]tNa\xff\0";

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

/// A file of the corpus: a table, after a line `===` where a layout stands before it.
fn parts(bytes: &[u8]) -> (Option<ColumnLayout>, &[u8]) {
    let mark = b"\n===\n";
    match bytes.windows(mark.len()).position(|part| part == mark) {
        Some(at) => {
            let layout = ColumnLayout::read(&String::from_utf8_lossy(&bytes[..at]), "columns.toml");
            (layout.ok(), &bytes[at + mark.len()..])
        }
        None => (Some(ColumnLayout::default()), bytes),
    }
}

/// Reads, and asks all that can be asked of a motion; whether it is one.
fn read(bytes: &[u8]) -> bool {
    let (layout, table) = parts(bytes);
    let mut numbered = ColumnLayout { rate: Some(165.0), ..ColumnLayout::default() };
    numbered.set_column("phi", "1").unwrap();
    let mut any = false;
    for layout in layout.into_iter().chain([numbered]) {
        match Measured::read(table, &layout, "rocker") {
            Err(error) => assert!(!error.to_string().is_empty()),
            Ok(measured) => {
                any = true;
                let motion = measured.motion(Sign::Reversed);
                assert!(motion.t.windows(2).all(|t| t[0] < t[1]) && motion.interval() > 0.0);
                let values = motion.values(motion.leading()).unwrap();
                assert!(values.len() == motion.t.len() && values.iter().all(|value| !value.is_infinite()));
                assert!(motion.values(Channel::Phi).is_none_or(|phi| phi.len() == motion.t.len()));
            }
        }
    }
    any
}

#[test]
fn the_corpus_is_read_whole_cut_short_and_changed() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus/measured");
    let mut numbers = Numbers(0x2545_F491_4F6C_DD1D);
    let (mut files, mut changed_motions) = (0, 0);
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let whole = std::fs::read(&path).unwrap();
        assert!(read(&whole), "{}", path.display());
        (0..whole.len()).for_each(|end| _ = read(&whole[..end]));
        for _ in 0..2000 {
            let mut changed = whole.clone();
            for _ in 0..=numbers.below(4) {
                let at = numbers.below(changed.len());
                changed[at] = SIGNS[numbers.below(SIGNS.len())];
            }
            changed_motions += usize::from(read(&changed));
        }
        files += 1;
    }
    assert!(files >= 8, "{files} files of the corpus");
    // Changes that no reader accepts would say little of what is done with values.
    assert!(changed_motions > 100, "{changed_motions}");
}
