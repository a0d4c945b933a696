//! Whether a file was cut within its last number.

/// Watches numbers as they are read. Where all but the last are written alike, as by a Fortran format, and the text of the last is only
/// the beginning of such a number, the file was cut there: `.1234E-0` and `.1234` are numbers, but far larger ones than `.1234E-03`.
#[derive(Default)]
pub(crate) struct CutWatch {
    /// How the first number is written.
    form: String,
    /// Numbers written like it; 0 once there is no telling, as there are several others.
    alike: usize,
    /// The only other one, with its line.
    other: Option<(usize, String)>,
}

/// So many numbers with exponents are taken for written by a format if they are written alike.
const ALIKE_WITH_EXPONENT: usize = 4;
/// So many without: where each has as many digits as it needs, every tenth is shorter, and a hundred are hardly ever of one length.
const ALIKE_WITHOUT: usize = 100;

impl CutWatch {
    pub(crate) fn add(&mut self, line: usize, number: &str) {
        if self.form.is_empty() {
            self.form = form(number).collect();
            self.alike = 1;
        } else if self.other.is_some() {
            self.alike = 0;
        } else if form(number).eq(self.form.chars()) {
            self.alike += 1;
        } else {
            self.other = Some((line, number.to_owned()));
        }
    }

    /// The last number with its line, if it was cut.
    pub(crate) fn cut(self) -> Option<(usize, String)> {
        let (line, number) = self.other?;
        let enough = if self.form.contains(['E', 'D']) { ALIKE_WITH_EXPONENT } else { ALIKE_WITHOUT };
        let begins = self.form.starts_with(&form(&number).collect::<String>());
        (self.alike >= enough && begins).then_some((line, number))
    }
}

/// How a number is written, without the sign in front: digits as 0, the sign of its exponent as +.
fn form(number: &str) -> impl Iterator<Item = char> {
    number.trim_start_matches(['+', '-']).chars().map(|c| match c {
        '0'..='9' => '0',
        '-' => '+',
        other => other.to_ascii_uppercase(),
    })
}
