//! Wording of messages: that of every document, and of beams and loads.

use crate::scene::{BeamScene, LoadKind, Scene};
use teeter_beam::{BeamSpec, Hold, Support};
use teeter_integrator::WBackend;
use teeter_text::readable::{with_mass, with_unit};

pub use teeter_text::wording::{bytes, duration, expected};

/// The word of a beam support.
#[must_use]
pub fn support(support: Support) -> &'static str {
    match support {
        Support::Pinned => "pinned",
        Support::Clamped => "clamped",
        Support::Guided => "guided",
        Support::Elastic { .. } => "elastic",
        _ => "free",
    }
}

/// How a support holds a beam: its word, or its springs and dashpots; "free" where these are all zero.
#[must_use]
pub fn held(of: Support) -> String {
    let Support::Elastic { deflection, rotation } = of else { return support(of).to_owned() };
    let parts = [
        (deflection, "held", "", ["N/m", "N s/m"]),
        (rotation, "no rotation", "rotational ", ["N m/rad", "N m s/rad"]),
    ];
    let told = parts.into_iter().flat_map(|(hold, fixed, kind, units)| match hold {
        Hold::Fixed => vec![fixed.to_owned()],
        Hold::Spring { stiffness, damping } => {
            let sizes = [("spring", stiffness), ("dashpot", damping)].into_iter().zip(units);
            let given = sizes.filter(|((_, size), _)| *size != 0.0);
            given.map(|((what, size), unit)| format!("{kind}{what} of {}", with_unit(size, unit))).collect()
        }
        _ => Vec::new(),
    });
    let told: Vec<String> = told.collect();
    if told.is_empty() { support(Support::Free).to_owned() } else { told.join(" and ") }
}

/// What a beam rests on between its ends and what it carries, each in words.
#[must_use]
pub fn furniture(spec: &BeamSpec) -> Vec<String> {
    let at = |x: f64| with_unit(x, "m");
    let inner = spec.inner_supports.iter().map(|inner| format!("{} at {}", held(inner.support), at(inner.x)));
    let foundations = spec.foundations.iter().map(|of| {
        let damping =
            if of.damping == 0.0 { String::new() } else { format!(" and {}", with_unit(of.damping, "N s/m²")) };
        let stiffness = with_unit(of.stiffness, "N/m²");
        format!("foundation of {stiffness}{damping} from {} to {}", at(of.from), at(of.to))
    });
    let masses = spec.lumps.iter().map(|lump| format!("mass of {} at {}", with_mass(lump.mass), at(lump.x)));
    inner.chain(foundations).chain(masses).collect()
}

/// How the matrices of a beam are factorised, in words.
#[must_use]
pub fn backend(beam: &BeamScene) -> &'static str {
    match beam.backend {
        _ if beam.reduction.is_some() => "diagonal",
        WBackend::Sparse => "sparse Cholesky, factorised once",
        WBackend::CachedColumns => "banded Cholesky, factorised once, with stored columns of W",
        _ => "banded Cholesky, factorised once",
    }
}

/// So many loads are told of.
const MOST_LOADS: usize = 12;

/// The forces on blocks and the loads on beams, each with what it acts on and its size, which its signal multiplies.
#[must_use]
pub fn loads(scene: &Scene) -> Vec<String> {
    let upwards = |size: f64, unit: &'static str| (size, unit, ["upwards", "downwards"]);
    let turning = |couple: f64| (couple, "N m", ["counter-clockwise", "clockwise"]);
    let named = |sizes: &[(f64, &'static str, [&'static str; 2])]| {
        let given = sizes.iter().filter(|(size, ..)| *size != 0.0);
        let told = given.map(|(size, unit, [positive, negative])| {
            let way = if *size > 0.0 { positive } else { negative };
            format!("{} {way}", with_unit(size.abs(), unit))
        });
        told.collect::<Vec<_>>().join(" and ")
    };
    let forces = scene.forces.iter().map(|force| {
        let ([x, y], on) = (force.force, &scene.blocks[force.block].name);
        let sizes = [(x, "N", ["to the right", "to the left"]), upwards(y, "N"), turning(force.couple)];
        format!("{} on {on}: {}", force.name, named(&sizes))
    });
    let loads = scene.loads.iter().map(|load| {
        let size = match load.kind {
            LoadKind::Point { at, force, couple } => {
                format!("{} at {}", named(&[upwards(force, "N"), turning(couple)]), with_unit(at, "m"))
            }
            LoadKind::Distributed { load, from, to } => {
                let [from, to] = [from, to].map(|place| with_unit(place, "m"));
                format!("{}, from {from} to {to}", named(&[upwards(load, "N/m")]))
            }
            LoadKind::Moving { force, at, speed } => {
                let moves = format!("at {} at first, then by {}", with_unit(at, "m"), with_unit(speed, "m/s"));
                format!("{}, {moves}", named(&[upwards(force, "N")]))
            }
        };
        format!("{} on {}: {size}", load.name, scene.beams[load.beam].name)
    });
    let mut told: Vec<String> = forces.chain(loads).collect();
    if told.len() > MOST_LOADS {
        let others = told.split_off(MOST_LOADS).len();
        told.push(format!("and {others} more"));
    }
    told
}

/// The theory of a beam, as in a scene.
#[must_use]
pub fn theory(beam: &BeamScene) -> &'static str {
    if beam.is_sheared() { "timoshenko" } else { "euler-bernoulli" }
}

/// A time with so many digits, in a unit that suits and that a scene takes: `100 us`.
#[must_use]
pub fn seconds(t: f64, digits: usize) -> String {
    let digits = digits.max(1) - 1;
    let rounded: f64 = format!("{t:.digits$e}").parse().unwrap_or(t);
    let units = [(1.0, 0, "s"), (1e-3, 3, "ms"), (1e-6, 6, "us")];
    let unit = units.into_iter().find(|(least, ..)| rounded.abs() >= *least * (1.0 - 1e-9));
    match unit {
        Some((_, power, unit)) if rounded.abs() < 1e6 => {
            // Parsed with its exponent, so that no product is rounded.
            let text = format!("{t:.digits$e}");
            let scaled = text.split_once('e').and_then(|(mantissa, exponent)| {
                format!("{mantissa}e{}", exponent.parse::<i32>().ok()? + power).parse::<f64>().ok()
            });
            format!("{} {unit}", scaled.unwrap_or(rounded))
        }
        // Shorter than any step, or longer than any run.
        _ => format!("{rounded:e} s"),
    }
}

/// A part of something, for sentences: "45 % of", and of what is more than twice the whole "7.1 times".
#[must_use]
pub fn share_of(part: f64) -> String {
    if part <= 2.0 { format!("{:.0} % of", 100.0 * part) } else { format!("{} times", whole_or_two_digits(part)) }
}

fn whole_or_two_digits(x: f64) -> f64 {
    format!("{x:.1e}").parse().unwrap_or(x)
}

/// "1/68 of its span".
#[must_use]
pub fn part_of(sag: f64, span: f64) -> String {
    match span / sag {
        f64::INFINITY => "nothing of its span".to_owned(),
        ratio if ratio >= 9.5 => format!("1/{ratio:.0} of its span"),
        ratio if ratio >= 1.0 => format!("1/{ratio:.1} of its span"),
        _ => format!("{} times its span", whole_or_two_digits(sag / span)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_in_a_unit_that_suits() {
        let told = [1e-4, 0.000_123_456, 0.25, 5.0, 1234.5, 3e-9, 9.999_9e-4, 0.0].map(|t| seconds(t, 3));
        assert_eq!(told, ["100 us", "123 us", "250 ms", "5 s", "1230 s", "3e-9 s", "1 ms", "0e0 s"]);
        assert_eq!((seconds(2.4e-5, 1), seconds(7e-7, 2)), ("20 us".to_owned(), "7e-7 s".to_owned()));
    }

    #[test]
    fn an_elastic_support_without_springs_and_dashpots_is_free() {
        let spring = |stiffness: f64| Hold::Spring { stiffness, damping: 0.0 };
        let told = |deflection, rotation| held(Support::Elastic { deflection, rotation });
        assert_eq!([told(spring(0.0), spring(0.0)), told(Hold::Free, Hold::Free)], ["free"; 2]);
        assert_eq!(told(Hold::Free, spring(5.0)), "rotational spring of 5 N m/rad");
    }

    #[test]
    fn more_than_the_whole_is_told_by_how_many_times() {
        assert_eq!([0.454, 1.0, 7.07, 707.1].map(share_of), ["45 % of", "100 % of", "7.1 times", "710 times"]);
    }
}
