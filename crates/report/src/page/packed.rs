//! Whole numbers as text: seven bits a byte with the lowest first, then base64. Differences of neighbours
//! are small, so most take one byte.

/// Whole numbers in a row.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Packed(Vec<u8>);

impl Packed {
    /// Appends a number that is not negative.
    pub(crate) fn push(&mut self, mut x: u64) {
        while x >= 0x80 {
            self.0.push((x as u8 & 0x7f) | 0x80);
            x >>= 7;
        }
        self.0.push(x as u8);
    }

    /// Appends a number of either sign: 0, −1, 1, −2 as 0, 1, 2, 3.
    pub(crate) fn push_signed(&mut self, x: i64) {
        self.push(unsigned(x));
    }

    /// The same, but 0 stays free for a number that is missing.
    pub(crate) fn push_after_null(&mut self, x: i64) {
        self.push(unsigned(x) + 1);
    }

    /// The text.
    pub(crate) fn text(&self) -> String {
        const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let mut text = String::with_capacity(4 * self.0.len().div_ceil(3));
        for three in self.0.chunks(3) {
            let byte = |k: usize| u32::from(three.get(k).copied().unwrap_or(0));
            let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
            for digit in 0..4 {
                let known = digit <= three.len();
                text.push(if known { char::from(DIGITS[(bits >> (18 - 6 * digit)) as usize & 63]) } else { '=' });
            }
        }
        text
    }
}

/// 0, −1, 1, −2 as 0, 1, 2, 3.
fn unsigned(x: i64) -> u64 {
    ((x << 1) ^ (x >> 63)) as u64
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// The whole numbers of a text.
    pub(crate) fn unpacked(text: &str) -> Vec<u64> {
        const DIGITS: &str = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let bits: Vec<u64> = text.chars().filter_map(|c| DIGITS.find(c)).map(|k| k as u64).collect();
        let bytes = bits.chunks(4).flat_map(|four| {
            let all = four.iter().fold(0, |all, bits| all << 6 | bits) << (6 * (4 - four.len()));
            (0..four.len() - 1).map(move |k| (all >> (16 - 8 * k) & 0xff) as u8)
        });
        let (mut numbers, mut number, mut place) = (Vec::new(), 0, 0);
        for byte in bytes {
            number |= u64::from(byte & 0x7f) << place;
            place += 7;
            if byte < 0x80 {
                numbers.push(number);
                (number, place) = (0, 0);
            }
        }
        numbers
    }

    #[test]
    fn the_text_is_that_of_the_standard() {
        // RFC 4648, section 10.
        for (bytes, text) in [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")] {
            assert_eq!(Packed(bytes.as_bytes().to_vec()).text(), text);
        }
    }

    #[test]
    fn small_numbers_are_short() {
        let mut packed = Packed::default();
        [0, -1, 1, 63, -64].into_iter().for_each(|x| packed.push_signed(x));
        assert_eq!(packed.0, [0, 1, 2, 126, 127]);
        packed.push_signed(64);
        packed.push(300);
        assert_eq!(packed.0[5..], [0x80, 1, 0xac, 2]);
        packed.push_signed(i64::MIN);
        assert_eq!(packed.0.len(), 9 + 10);
    }
}
