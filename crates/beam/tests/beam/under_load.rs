//! The deflection between nodes under loads that lie there, against closed forms.

use super::beam;
use teeter_beam::{Beam, BeamSpec, Section, SpanLoad, Support};

const SPAN: f64 = 0.36;
const EI: f64 = 0.5821875;

/// Deflection and slope at x of a cantilever (clamped at 0) under a unit force at a; `soft` is 1/GA_s.
fn by_force(a: f64, x: f64, soft: f64) -> [f64; 2] {
    let (near, far) = (a.min(x), a.max(x));
    let w = near * near * (3.0 * far - near) / (6.0 * EI) + soft * near;
    let slope = if x < a { x * (2.0 * a - x) / (2.0 * EI) + soft } else { a * a / (2.0 * EI) };
    [w, slope]
}

/// The same under a unit couple at a.
fn by_couple(a: f64, x: f64) -> [f64; 2] {
    let near = a.min(x);
    [near * (x - 0.5 * near) / EI, near / EI]
}

const GAUSS: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];

/// The same under a load of 1 N/m from one place to another: forces added up, exactly, left and right of x.
fn by_load(from: f64, to: f64, x: f64, soft: f64) -> [f64; 2] {
    let cut = x.clamp(from, to);
    let mut sum = [0.0; 2];
    for (left, right) in [(from, cut), (cut, to)] {
        for (s, weight) in GAUSS {
            let half = 0.5 * (right - left);
            let one = by_force(left + half * (1.0 + s), x, soft);
            (0..2).for_each(|i| sum[i] += weight * half * one[i]);
        }
    }
    sum
}

/// Numbers in [0, 1), the same in every run.
struct Dice(u64);

impl Dice {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn cantilever(elements: usize, section: Section) -> Beam {
    Beam::new(BeamSpec::new(SPAN, elements, section).supported([Support::Clamped, Support::Free])).unwrap()
}

/// Loads anywhere on meshes from one element on, looked at anywhere, with and without shear.
#[test]
fn a_cantilever_is_exact_between_its_nodes_too() {
    let mut dice = Dice(3);
    let mut without = 0.0_f64;
    for soft in [0.0, 2e-3] {
        for elements in [1, 2, 3, 7, 20] {
            let mut section = Section::new(EI, 0.1215).unwrap();
            if soft > 0.0 {
                section = section.with_shear(1.0 / soft, 1e-6).unwrap();
            }
            let beam = cantilever(elements, section);
            for _ in 0..20 {
                let [a, c, from, to] = [(); 4].map(|()| SPAN * dice.unit());
                let (from, to) = (from.min(to), from.max(to));
                let [force, couple, load, gravity] = [(); 4].map(|()| 2.0 * dice.unit() - 1.0);
                let (couple, load) = (0.1 * couple, 5.0 * load);
                let loads = [
                    SpanLoad::Point { x: a, force, couple: 0.0 },
                    SpanLoad::Point { x: c, force: 0.0, couple },
                    SpanLoad::Uniform { from, to, load },
                    SpanLoad::Weight { gravity },
                ];
                let mut q = vec![0.0; beam.dofs()];
                beam.add_point_load(a, force, &mut q).unwrap();
                beam.add_point_couple(c, couple, &mut q).unwrap();
                beam.add_partial_load([from, to], load, &mut q).unwrap();
                beam.add_self_weight(gravity, &mut q).unwrap();
                beam.solve_static(&mut q).unwrap();
                let exact = |x: f64| {
                    let parts = [
                        (force, by_force(a, x, soft)),
                        (couple, by_couple(c, x)),
                        (load, by_load(from, to, x, soft)),
                        (gravity * 0.1215, by_load(0.0, SPAN, x, soft)),
                    ];
                    [0, 1].map(|i| parts.iter().map(|(size, one)| size * one[i]).sum::<f64>())
                };
                let size = force.abs() * by_force(a, SPAN, soft)[0]
                    + couple.abs() * by_couple(c, SPAN)[0]
                    + load.abs() * by_load(from, to, SPAN, soft)[0];
                for x in (0..=40).map(|k| SPAN * f64::from(k) / 40.0).chain([a, c, from, to]) {
                    let (d, [w, slope]) = (beam.deflection_under(&q, &loads, x).unwrap(), exact(x));
                    assert!((d.w - w).abs() < 1e-12 * size, "{elements} {soft} w({x}): {} {w}", d.w);
                    // There it jumps by the shear force's.
                    let smooth = x != a || soft == 0.0;
                    assert!(
                        !smooth || (d.slope - slope).abs() < 1e-11 * size / SPAN,
                        "{elements} {soft} w'({x}): {} {slope}",
                        d.slope
                    );
                    without = without.max((beam.deflection_at(&q, x).unwrap().w - w).abs() / size);
                }
            }
        }
    }
    assert!(without > 1e-2, "the shape functions alone leave something out: {without:e}");
}

/// The case that was reported: pinned, 20 elements, a force in the middle of one.
#[test]
fn a_force_inside_an_element_of_twenty() {
    let beam = beam(20, [Support::Pinned; 2]);
    let (a, b) = (0.189, SPAN - 0.189);
    let mut q = vec![0.0; beam.dofs()];
    beam.add_point_load(a, -1.0, &mut q).unwrap();
    beam.solve_static(&mut q).unwrap();
    let exact = -a * a * b * b / (3.0 * EI * SPAN);
    let loads = [SpanLoad::Point { x: a, force: -1.0, couple: 0.0 }];
    assert!((beam.deflection_under(&q, &loads, a).unwrap().w / exact - 1.0).abs() < 1e-13);
    let off = (beam.deflection_at(&q, a).unwrap().w / exact - 1.0).abs();
    assert!((3e-5..6e-5).contains(&off), "{off:e}");
}

#[test]
fn what_is_off_the_beam_is_refused() {
    let beam = beam(2, [Support::Pinned; 2]);
    let q = vec![0.0; beam.dofs()];
    let point = |x, force| SpanLoad::Point { x, force, couple: 0.0 };
    for (load, x) in [(point(0.1, 1.0), 0.4), (point(0.4, 1.0), 0.1), (point(0.1, f64::NAN), 0.1)] {
        assert!(beam.deflection_under(&q, &[load], x).is_err(), "{load:?} {x}");
    }
    let beyond = SpanLoad::Uniform { from: -0.1, to: 0.2, load: 1.0 };
    assert!(beam.deflection_under(&q, &[beyond], 0.1).is_err());
}
