//! Numbers with units as written, between which axes interpolate.

use teeter_scenario::dimension::Dimension;
use teeter_scenario::keys::{Kind, PathTarget};

/// A number and the text of its unit, which is empty for a bare number.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct WrittenNumber {
    pub(crate) value: f64,
    pub(crate) unit: String,
}

impl WrittenNumber {
    /// Reads `0.3` or `5 deg`; `None` if the text doesn't start with a finite number.
    pub(crate) fn read(text: &str) -> Option<Self> {
        let text = text.trim();
        let digit = |c: char| c.is_ascii_digit() || matches!(c, '.' | '+' | '-' | '_');
        let mut end = text.find(|c: char| !digit(c)).unwrap_or(text.len());
        // An exponent: `1e-3 m`, but not the `e` of a unit.
        if text[end..].starts_with(['e', 'E']) {
            let rest = &text[end + 1..];
            let signed = rest.trim_start_matches(['+', '-']);
            let digits = signed.find(|c: char| !c.is_ascii_digit()).unwrap_or(signed.len());
            if digits > 0 {
                end += 1 + (rest.len() - signed.len()) + digits;
            }
        }
        let value: f64 = text[..end].replace('_', "").parse().ok()?;
        value.is_finite().then(|| Self { value, unit: text[end..].trim().to_owned() })
    }

    /// The text of another number in the same unit, for `--set`.
    pub(crate) fn text_of(&self, value: f64) -> String {
        // Keys that take whole numbers refuse `10.0`; all others take `10`.
        if self.unit.is_empty() && value.fract() == 0.0 && value.abs() < 1e15 {
            return format!("{value:.0}");
        }
        if self.unit.is_empty() { format!("{value:?}") } else { format!("{value:?} {}", self.unit) }
    }
}

/// The value of a key as a table of results holds it: a quantity in SI units, any other value as it
/// is written.
pub(crate) fn in_table(key: &str, written: &str) -> String {
    let quantity = |dimension: Dimension| teeter_scenario::quantity::parse(written, dimension).ok();
    let number = match teeter_scenario::keys::find(key) {
        Some(PathTarget::Key(_, found)) => match found.kind {
            Kind::Quantity(dimension, _) => quantity(dimension),
            Kind::Number(_) => written.trim().parse().ok(),
            // The key takes no `10.0`.
            Kind::Integer { .. } => {
                return whole(written).map_or_else(|| written.to_owned(), |value| value.to_string());
            }
            _ => None,
        },
        _ => None,
    };
    number.map_or_else(|| written.to_owned(), |value| format!("{value:?}"))
}

/// The whole number that a text is, as TOML writes it.
fn whole(written: &str) -> Option<i64> {
    written.trim().replace('_', "").parse().ok()
}

/// Whether a key takes whole numbers only.
#[cfg(feature = "parquet")]
pub(crate) fn is_whole(key: &str) -> bool {
    matches!(teeter_scenario::keys::find(key), Some(PathTarget::Key(_, found)) if matches!(found.kind, Kind::Integer { .. }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_unit() {
        let read = |text: &str| WrittenNumber::read(text).map(|number| (number.value, number.unit));
        assert_eq!(read("5 deg"), Some((5.0, "deg".into())));
        assert_eq!(read("-1.5e-3m/s^2"), Some((-1.5e-3, "m/s^2".into())));
        assert_eq!(read("0.3"), Some((0.3, String::new())));
        assert_eq!(read("3 eV"), Some((3.0, "eV".into())));
        assert_eq!(read("auto"), None);
        assert_eq!(WrittenNumber::read("2 mm").unwrap().text_of(0.25), "0.25 mm");
        let whole = WrittenNumber::read("10").unwrap();
        assert_eq!(
            (whole.text_of(20.0), whole.text_of(2.5), whole.text_of(1e300)),
            ("20".into(), "2.5".into(), "1e300".into())
        );
    }

    #[test]
    fn a_table_holds_si_units_where_the_key_is_a_quantity() {
        assert_eq!(in_table("block.b.width", "36 cm"), "0.36");
        assert_eq!(in_table("time.scheme", "event-driven"), "event-driven");
        assert_eq!(in_table("contact.feet.friction", "0.5"), "0.5");
        assert_eq!(in_table("contact.feet.friction", "1"), "1.0");
    }

    #[test]
    fn a_table_holds_whole_numbers_where_the_key_takes_nothing_else() {
        for (written, cell) in [("10", "10"), (" 20 ", "20"), ("1_000", "1000"), ("2.5", "2.5"), ("10.0", "10.0")] {
            assert_eq!(in_table("beam.table.elements", written), cell);
        }
    }
}
