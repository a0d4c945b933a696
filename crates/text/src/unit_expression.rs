//! Unit expressions: products and quotients of powers of units, `N s/m^2`.

use crate::diagnostic::printable;
use crate::dimension::Dimension;
use crate::quantity::QuantityError;
use crate::units;

/// Product of powers of units so far.
pub(crate) struct Product {
    powers: [i32; 5],
    /// Power of ten of its size.
    pub(crate) shift: i32,
    /// The rest of its size is `above` / `below`.
    pub(crate) above: f64,
    pub(crate) below: f64,
}

impl Product {
    fn one() -> Self {
        Self { powers: [0; 5], shift: 0, above: 1.0, below: 1.0 }
    }

    /// Multiplies by `other`^`exponent`; absurd exponents saturate and are refused by
    /// [`Product::dimension`].
    fn times(&mut self, other: &Self, exponent: i32) {
        for (power, of_other) in self.powers.iter_mut().zip(other.powers) {
            *power = power.saturating_add(of_other.saturating_mul(exponent));
        }
        self.shift = self.shift.saturating_add(other.shift.saturating_mul(exponent));
        let (above, below) = if exponent < 0 { (other.below, other.above) } else { (other.above, other.below) };
        self.above *= above.powi(exponent.abs());
        self.below *= below.powi(exponent.abs());
    }

    pub(crate) fn dimension(&self) -> Result<Dimension, QuantityError> {
        let [kg, m, s, rad, kelvin] = self.powers.map(i8::try_from);
        match (kg, m, s, rad, kelvin) {
            (Ok(kg), Ok(m), Ok(s), Ok(rad), Ok(kelvin)) => Ok(Dimension::new(kg, m, s, rad, kelvin)),
            _ => Err(QuantityError::Syntax { unit: String::new(), reason: "the exponents are too large" }),
        }
    }
}

/// Reads a unit expression, left to right.
///
/// # Errors
/// If a symbol is unknown, or the text is not a product of powers.
pub(crate) fn read(text: &str) -> Result<Product, QuantityError> {
    Reader { text, rest: text, depth: 0, factors: 0 }.read()
}

struct Reader<'a> {
    text: &'a str,
    rest: &'a str,
    depth: u32,
    factors: u32,
}

/// Limits that no real unit reaches; they bound recursion and work.
const DEEPEST: u32 = 3;
const MOST_FACTORS: u32 = 32;
const LARGEST_EXPONENT: i32 = 99;

impl Reader<'_> {
    fn read(mut self) -> Result<Product, QuantityError> {
        let _ = self.take(TIMES);
        let product = self.product()?;
        if self.rest.is_empty() { Ok(product) } else { Err(self.fail("there is an extra closing parenthesis")) }
    }

    fn product(&mut self) -> Result<Product, QuantityError> {
        let mut product = Product::one();
        let mut sign = 1;
        self.skip_blanks();
        if let Some(rest) = self.rest.strip_prefix('1') {
            self.rest = rest;
            self.skip_blanks();
            if !self.rest.starts_with('/') {
                return Err(self.fail("a 1 is allowed only before a `/`"));
            }
        }
        if self.take(&['/']) {
            sign = -1;
        }
        loop {
            let (factor, exponent) = self.factor()?;
            self.factors += 1;
            if self.factors > MOST_FACTORS {
                return Err(self.fail("too many factors"));
            }
            product.times(&factor, sign * exponent);
            self.skip_blanks();
            if self.rest.is_empty() || self.rest.starts_with(')') {
                return Ok(product);
            }
            sign = if self.take(&['/']) { -1 } else { 1 };
            if sign == 1 {
                let _ = self.take(TIMES);
            }
        }
    }

    fn factor(&mut self) -> Result<(Product, i32), QuantityError> {
        self.skip_blanks();
        let factor = if self.take(&['(']) {
            self.depth += 1;
            if self.depth > DEEPEST {
                return Err(self.fail("parentheses are nested too deeply"));
            }
            let inner = self.product()?;
            if !self.take(&[')']) {
                return Err(self.fail("a closing parenthesis is missing"));
            }
            self.depth -= 1;
            inner
        } else {
            let end = self
                .rest
                .find(|c: char| {
                    c.is_whitespace()
                        || c.is_ascii_digit()
                        || "^*/·⋅×().,+-\u{2212}".contains(c)
                        || superscript(c).is_some()
                })
                .unwrap_or(self.rest.len());
            let (symbol, rest) = self.rest.split_at(end);
            if symbol.is_empty() {
                return Err(self.fail("a unit is missing or a sign is misplaced"));
            }
            let unit = units::find(symbol).ok_or_else(|| QuantityError::UnknownUnit {
                symbol: printable(symbol),
                suggestion: units::suggest(symbol, |_| true),
            })?;
            self.rest = rest;
            let Dimension { kg, m, s, rad, kelvin } = unit.dimension;
            Product {
                powers: [kg, m, s, rad, kelvin].map(i32::from),
                shift: unit.shift,
                above: unit.factor,
                below: 1.0,
            }
        };
        let exponent = self.exponent()?;
        Ok((factor, exponent))
    }

    /// `^2`, `^-1`, `²`, `⁻¹`, or the bare `2` of `m2`; 1 if there is none.
    fn exponent(&mut self) -> Result<i32, QuantityError> {
        let caret = self.rest.trim_start().starts_with('^') && self.take(&['^']);
        if caret {
            self.skip_blanks();
        }
        let mut digits = String::new();
        let mut length = 0;
        for c in self.rest.chars() {
            let plain = match c {
                '\u{2212}' | '-' if caret => '-',
                '+' if caret => '+',
                '0'..='9' => c,
                _ => match superscript(c) {
                    Some(plain) if !caret => plain,
                    _ => break,
                },
            };
            digits.push(plain);
            length += c.len_utf8();
        }
        if digits.is_empty() && !caret {
            return Ok(1);
        }
        self.rest = self.rest.get(length..).unwrap_or_default();
        match digits.parse::<i32>() {
            Ok(exponent) if exponent.abs() <= LARGEST_EXPONENT => Ok(exponent),
            Ok(_) => Err(self.fail("the exponents are too large")),
            Err(_) => Err(self.fail("an exponent must be a whole number")),
        }
    }

    fn skip_blanks(&mut self) {
        self.rest = self.rest.trim_start();
    }

    fn take(&mut self, signs: &[char]) -> bool {
        self.skip_blanks();
        match self.rest.strip_prefix(signs) {
            Some(rest) => {
                self.rest = rest;
                true
            }
            None => false,
        }
    }

    fn fail(&self, reason: &'static str) -> QuantityError {
        QuantityError::Syntax { unit: printable(self.text), reason }
    }
}

const TIMES: &[char] = &['*', '·', '⋅', '×'];

fn superscript(c: char) -> Option<char> {
    Some(match c {
        '⁰' => '0',
        '¹' => '1',
        '²' => '2',
        '³' => '3',
        '⁴' => '4',
        '⁵' => '5',
        '⁶' => '6',
        '⁷' => '7',
        '⁸' => '8',
        '⁹' => '9',
        '⁻' => '-',
        _ => return None,
    })
}
