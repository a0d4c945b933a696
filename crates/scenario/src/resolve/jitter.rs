//! Random numbers for the copies of a repeated block, the same on every machine.

/// Three numbers from -1 to 1 for a copy of a table, by the seed: all as likely, and independent of
/// those of other copies, tables and seeds.
pub(super) fn of_copy(seed: i64, table: &str, copy: usize) -> [f64; 3] {
    // FNV-1a over what they depend on, and from there on SplitMix64 (Steele, Lea, Flood 2014,
    // doi:10.1145/2660193.2660195).
    let numbers = seed.to_le_bytes().into_iter().chain((copy as u64).to_le_bytes());
    let hash = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    let mut state = numbers.chain(table.bytes()).fold(0xcbf2_9ce4_8422_2325, hash);
    [(); 3].map(|()| {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (state ^ state >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        // 53 bits, as many as a number has digits.
        ((z ^ z >> 31) >> 11) as f64 * (2.0 * 0.5_f64.powi(53)) - 1.0
    })
}

#[cfg(test)]
mod tests {
    use super::of_copy;

    #[test]
    fn numbers_fill_their_range_evenly_and_know_nothing_of_each_other() {
        const N: usize = 20_000;
        let all: Vec<[f64; 3]> = (0..N).map(|copy| of_copy(3, "stone", copy)).collect();
        let mean = |of: &dyn Fn(usize) -> f64| (0..N).map(of).sum::<f64>() / N as f64;
        // Standard deviations of these means are at most 0.6/sqrt(N) = 0.004.
        for axis in 0..3 {
            assert!(all.iter().all(|numbers| (-1.0..1.0).contains(&numbers[axis])));
            let (first, second) = (mean(&|i| all[i][axis]), mean(&|i| all[i][axis].powi(2)));
            assert!(first.abs() < 0.02 && (second - 1.0 / 3.0).abs() < 0.02, "{first} {second}");
            let other = (axis + 1) % 3;
            assert!(mean(&|i| all[i][axis] * all[i][other]).abs() < 0.02);
            assert!(mean(&|i| all[i][axis] * all[(i + 1) % N][axis]).abs() < 0.02);
        }
        assert_ne!(of_copy(3, "stone", 0), of_copy(4, "stone", 0));
        assert_ne!(of_copy(3, "stone", 0), of_copy(3, "brick", 0));
        // The same on every machine, and in every version: scenes rely on it.
        assert_eq!(of_copy(3, "stone", 0), [0.42053983683164353, 0.16136177911461003, 0.062472278470375064]);
    }
}
