//! Patterns of quantities: a number, and a known unit.
//!
//! A unit of one symbol must have the expected dimension. The dimension of a product or quotient of
//! units is a sum of exponents, which a pattern can't check; but its symbols must be known. There
//! is no look-around, so any engine can use these patterns.

use teeter_scenario::dimension::Dimension;
use teeter_scenario::keys::{Bound, Range};
use teeter_scenario::measure::AllowedUnit;
use teeter_scenario::units::UNITS;

/// Digits with or without a point, and with or without an exponent.
const DIGITS: &str = "([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][-+]?[0-9]+)?";
/// The same, not all of them zero.
const NOT_ZERO: &str = "(0*[1-9][0-9]*\\.?[0-9]*|[0-9]*\\.0*[1-9][0-9]*)([eE][-+]?[0-9]+)?";
const ZERO: &str = "(0+\\.?0*|\\.0+)([eE][-+]?[0-9]+)?";
/// The hyphen and the sign.
const MINUS: &str = "[-−]";
const EXPONENT: &str = "(\\s*\\^\\s*[-+−]?[0-9]+|[0-9]+|[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+)";
const BETWEEN: &str = "(\\s*[*·⋅×/]\\s*|\\s+)";

/// The numbers that a range allows, checked only by sign.
fn number(range: &Range) -> String {
    match range.low {
        Bound::Open(low) if low >= 0.0 => format!("\\+?{NOT_ZERO}"),
        Bound::Closed(low) if low >= 0.0 => format!("(\\+?{DIGITS}|{MINUS}{ZERO})"),
        _ => format!("[-+−]?{DIGITS}"),
    }
}

/// Symbols as alternatives, the longest first; micro in all its forms.
fn symbols(of: impl Fn(Dimension) -> bool) -> String {
    let mut symbols: Vec<String> =
        UNITS.iter().filter(|unit| of(unit.dimension)).map(|unit| unit.symbol.replacen('u', "[uµμ]", 1)).collect();
    symbols.sort_by_key(|symbol| std::cmp::Reverse(symbol.len()));
    symbols.join("|")
}

/// A unit: one symbol of the dimension, or an expression of known symbols.
fn unit(dimension: Dimension) -> String {
    let (own, all) = (symbols(|of| dimension.accepts(of)), symbols(|_| true));
    let factor = format!("\\(*\\s*({all}){EXPONENT}?(\\s*\\)+{EXPONENT}?)?");
    let more = format!("({BETWEEN}{factor})");
    let over = "([*·⋅×]\\s*)?1?\\s*/\\s*";
    // With an exponent, parentheses, a division, or several factors.
    let made = format!(
        "{over}{factor}{more}*|{factor}{more}+|({all}){EXPONENT}|\\(+\\s*({all}){EXPONENT}?\\s*\\)+{EXPONENT}?"
    );
    if own.is_empty() { format!("({made})") } else { format!("({own}|{made})") }
}

/// A quantity of a dimension in a range.
pub(super) fn quantity(dimension: Dimension, range: &Range) -> String {
    format!("^\\s*{}\\s*{}\\s*$", number(range), unit(dimension))
}

/// A quantity in one of several units, some of which may be divided by any power of the metre.
pub(super) fn measure(units: &[AllowedUnit], range: &Range) -> String {
    let of = |of: &AllowedUnit| unit(of.dimension) + if of.any_power { "\\s*/m\\^\\s*[0-9.]+" } else { "" };
    let units: Vec<String> = units.iter().map(of).collect();
    format!("^\\s*{}\\s*({})\\s*$", number(range), units.join("|"))
}
