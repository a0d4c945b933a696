//! Numbers for people: rounded to what is meaningful, in a unit that suits.

/// Prefixes of units, the largest first.
const PREFIXES: [(i32, &str); 8] = [(9, "G"), (6, "M"), (3, "k"), (0, ""), (-3, "m"), (-6, "µ"), (-9, "n"), (-12, "p")];

/// A number with at most so many significant digits, without zeros at its end.
#[must_use]
pub fn shortest(x: f64, digits: usize) -> String {
    let rounded: f64 = format!("{x:.*e}", digits.max(1) - 1).parse().unwrap_or(x);
    let size = rounded.abs();
    if size != 0.0 && !(1e-4..1e6).contains(&size) { format!("{rounded:e}") } else { rounded.to_string() }
}

/// A quantity with four digits and the prefix that suits, such as `473.9 µs`; beyond the prefixes with a power of ten. Times over a second stay
/// in seconds.
#[must_use]
pub fn with_unit(x: f64, unit: &str) -> String {
    with_digits(x, unit, 4)
}

/// A quantity with four digits in the unit that suits a `larger` one: two that are compared have the same.
#[must_use]
pub fn like(x: f64, larger: f64, unit: &str) -> String {
    let own = with_unit(larger, unit);
    let prefix = own.rsplit_once(' ').and_then(|(_, own)| own.strip_suffix(unit));
    match PREFIXES.iter().find(|(_, of)| Some(*of) == prefix) {
        Some((power, prefix)) if larger != 0.0 => format!("{} {prefix}{unit}", shortest(x / 10_f64.powi(*power), 4)),
        _ => with_unit(x, unit),
    }
}

/// As [`with_unit`], with so many digits, one or more.
#[must_use]
pub fn with_digits(x: f64, unit: &str, digits: usize) -> String {
    let rounded: f64 = format!("{x:.*e}", digits - 1).parse().unwrap_or(x);
    if rounded == 0.0 || !rounded.is_finite() {
        return format!("{} {unit}", rounded.abs());
    }
    let exponent = rounded.abs().log10().floor() as i32;
    // Nobody counts kiloseconds.
    let largest = if unit == "s" { 0 } else { 9 };
    let suits = |(power, _): &&(i32, &str)| {
        *power <= largest && exponent >= *power && (exponent < power + 3 || *power == largest)
    };
    match PREFIXES.iter().find(suits) {
        // Parsed with its exponent, so that no product is rounded.
        Some((power, prefix)) => {
            let scaled: f64 = format!("{x:.*e}", digits - 1)
                .split_once('e')
                .and_then(|(mantissa, exponent)| {
                    format!("{mantissa}e{}", exponent.parse::<i32>().ok()? - power).parse().ok()
                })
                .unwrap_or(rounded);
            format!("{scaled} {prefix}{unit}")
        }
        None => format!("{rounded:e} {unit}"),
    }
}

/// A mass (kg) with four digits: below a kilogram in grams or less, so that it has one to three digits before its point, as other quantities have.
#[must_use]
pub fn with_mass(mass: f64) -> String {
    let shown = with_unit(1e3 * mass, "g");
    if mass.abs() < 1.0 && !shown.ends_with(" kg") { shown } else { format!("{} kg", shortest(mass, 4)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masses_are_in_kilograms_or_less() {
        let masses = [0.006_451_2, 0.328_05, 0.999_99, 1.0, 48.0, 5.28e3, 2.5e-6, 0.0];
        let told = ["6.451 g", "328.1 g", "1 kg", "1 kg", "48 kg", "5280 kg", "2.5 mg", "0 g"];
        assert_eq!(masses.map(with_mass), told);
    }

    #[test]
    fn prose_has_four_digits_and_a_prefix() {
        for (x, unit, wanted) in [
            (4.739_336_492_890_995_4e-4, "s", "473.9 µs"),
            (1.199_999_999_999_999_9e-11, "m", "12 pm"),
            (9.9999e-4, "m", "1 mm"),
            (0.412_345, "s", "412.3 ms"),
            (1234.4, "s", "1234 s"),
            (0.0, "m", "0 m"),
            (-0.0321, "m", "-32.1 mm"),
            (1.1e10, "Pa", "11 GPa"),
            (3e-20, "m", "3e-20 m"),
        ] {
            assert_eq!(with_unit(x, unit), wanted);
        }
        assert_eq!(
            (shortest(0.4321, 3), shortest(7.0, 3), shortest(1e-9, 3)),
            ("0.432".into(), "7".into(), "1e-9".into())
        );
    }
}
