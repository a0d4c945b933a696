//! What is worth a plot: the one rule that keeps rounding off the page.
//!
//! A quantity is drawn if it becomes larger than [`ROUNDING`] of its own scale: what it would be if the motion, the force or the
//! energy were one that counts in this scene. The scales, by kind:
//!
//! | quantity | is measured by | scale |
//! |---|---|---|
//! | x, y of a body, with its velocity | how far it goes from where it began | the largest distance from its mass centre to its outline |
//! | φ of a body, with its velocity | how far it turns from where it began | 1 rad |
//! | slip of a contact | its largest value | 100 times that of its block, 10 000 times where it never slips by its state: rounding adds up over the steps |
//! | deflection of a beam | its largest value | a thousandth of the span |
//! | force in contacts, or in beams | its largest value | the largest force of the contacts, or of the beams |
//! | moment or couple in a beam | its largest value | the largest force of the beams times the span, or the largest moment |
//! | stress | its largest value | the largest stress |
//! | energy, work | its largest value | what lifts every block by its size, Σ m g R, or the largest energy |
//!
//! What is left out is said on the page, with its largest value.

/// The part of its scale below which a quantity is nothing but rounding: a hundred times the tolerance to which contacts are
/// solved by default, 1e-10, whose errors add up over a run.
pub(crate) const ROUNDING: f64 = 1e-8;

/// Whether a quantity that becomes as large as `largest` is more than rounding. Without a scale anything but zero is.
pub(crate) fn holds(largest: f64, scale: f64) -> bool {
    largest > ROUNDING * scale.max(0.0)
}

/// The largest absolute value of the finite ones; 0 without any.
pub(crate) fn largest<'a>(values: impl IntoIterator<Item = &'a f64>) -> f64 {
    values.into_iter().filter(|x| x.is_finite()).fold(0.0, |most: f64, x| most.max(x.abs()))
}

/// How far a quantity goes from where it began.
pub(crate) fn travel(values: &[f64]) -> f64 {
    let first = values.first().copied().unwrap_or(0.0);
    values.iter().map(|x| (x - first).abs()).filter(|x| x.is_finite()).fold(0.0, f64::max)
}

/// A quantity that isn't drawn.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LeftOut {
    /// What it is, with the word before what has it: `φ of`.
    pub(crate) what: &'static str,
    /// What has it, empty for a quantity of the whole scene, and what these are called together: without a word for that each is
    /// named.
    pub(crate) of: Vec<String>,
    pub(crate) together: &'static str,
    /// How large it becomes, in this unit, and from where on it is drawn.
    pub(crate) largest: f64,
    pub(crate) bound: f64,
    pub(crate) unit: &'static str,
}

/// More of one kind than this are counted, not named.
const NAMED: usize = 3;

impl LeftOut {
    fn told(&self) -> String {
        let size = if self.largest == 0.0 {
            "0".to_owned()
        } else {
            format!("{} {}, drawn from {} on", power_of_ten(self.largest), self.unit, power_of_ten(self.bound))
        };
        let of = match self.of.len() {
            // The name of the quantity alone: `force`, not `force of`.
            0 => return format!("{} ({size})", self.what.trim_end_matches(" of")),
            few if few <= NAMED || self.together.is_empty() => format!(" {}", self.of.join(", ")),
            many => format!(" {many} {}", self.together),
        };
        let bound = if self.of.len() > 1 && self.largest > 0.0 { "at most " } else { "" };
        format!("{}{of} ({bound}{size})", self.what)
    }
}

/// A sentence on what isn't drawn; empty if all is.
pub(crate) fn told(left_out: &[LeftOut]) -> String {
    if left_out.is_empty() {
        return String::new();
    }
    let list: Vec<String> = left_out.iter().map(LeftOut::told).collect();
    format!("Not drawn, because rounding alone could add up to as much: {}.", list.join("; "))
}

/// A number with one digit as a power of ten: `3 × 10⁻¹²`.
pub(crate) fn power_of_ten(x: f64) -> String {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let text = format!("{x:.0e}");
    let Some((digit, power)) = text.split_once('e').filter(|(_, power)| *power != "0") else {
        return text.trim_end_matches("e0").to_owned();
    };
    let raised = power.chars().map(|c| c.to_digit(10).map_or('⁻', |digit| RAISED[digit as usize]));
    let times = if digit == "1" { String::new() } else { format!("{digit} × ") };
    format!("{times}10{}", raised.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_is_measured_by_the_scale() {
        // The energy of a block that rests on an incline, of some 10 g and 10 cm.
        assert!(!holds(1e-36, 0.01 * 9.81 * 0.1));
        // An arch of 1 t: 1e-12 J is no motion.
        assert!(!holds(1e-12, 1e3 * 9.81));
        // The moment at a free end.
        assert!(!holds(1e-13, 2.5));
        assert!(holds(1e-3, 2.5) && holds(1e-7, 1.0) && !holds(1e-9, 1.0));
        assert!(!holds(0.0, 0.0) && holds(1e-300, 0.0), "without a scale only zero is nothing");
    }

    #[test]
    fn a_body_that_stands_on_a_slope_has_not_turned() {
        assert_eq!(travel(&[0.35, 0.35, 0.35]), 0.0);
        assert_eq!(travel(&[1.0, 3.0, f64::NAN, -2.0]), 3.0);
        assert_eq!(travel(&[]), 0.0);
        assert_eq!(largest(&[1.0, -3.0, f64::INFINITY]), 3.0);
    }

    #[test]
    fn what_is_left_out_is_told() {
        assert_eq!(told(&[]), "");
        assert_eq!([1e-11, 3e-8, 1.0, 2.0].map(power_of_ten), ["10⁻¹¹", "3 × 10⁻⁸", "1", "2"]);
        let left_out = |what, of: usize, largest| LeftOut {
            what,
            of: (0..of).map(|k| format!("b{k}")).collect(),
            together: "blocks",
            largest,
            bound: 1e-8,
            unit: "rad",
        };
        let text = told(&[left_out("φ of", 1, 3e-12), left_out("slip of", 0, 0.0)]);
        assert!(text.ends_with("add up to as much: φ of b0 (3 × 10⁻¹² rad, drawn from 10⁻⁸ on); slip (0)."), "{text}");
        let text = told(&[left_out("φ of", 2, 3e-12), left_out("x of", 15, 4e-12)]);
        assert!(
            text.ends_with(
                "φ of b0, b1 (at most 3 × 10⁻¹² rad, drawn from 10⁻⁸ on); x of 15 blocks (at most 4 × 10⁻¹² rad, drawn from 10⁻⁸ on)."
            ),
            "{text}"
        );
    }
}
