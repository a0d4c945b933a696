//! Every bad value is refused by an error that names its field and value.

use teeter_beam::{Beam, BeamError, BeamSpec, MAX_ELEMENTS, Section, Support};

const PINNED: [Support; 2] = [Support::Pinned; 2];

#[test]
fn a_bad_spec_is_refused_by_field_and_value() {
    type Spoil = fn(&mut BeamSpec, f64);
    let reals: [(&str, Spoil, &[f64]); 6] = [
        ("span", |s, x| s.span = x, &[0.0, -0.36, f64::NAN, f64::INFINITY, 1e-300, 1e200]),
        ("section.bending_stiffness", |s, x| s.section.bending_stiffness = x, &[0.0, -1.0, f64::NAN, f64::INFINITY]),
        ("section.mass_per_length", |s, x| s.section.mass_per_length = x, &[0.0, -1.0, f64::NAN, f64::INFINITY]),
        ("damping.viscous", |s, x| s.damping.viscous = x, &[-0.1, f64::NAN, f64::INFINITY]),
        ("damping.rayleigh_mass", |s, x| s.damping.rayleigh_mass = x, &[-0.1, f64::NAN, f64::INFINITY]),
        ("damping.rayleigh_stiffness", |s, x| s.damping.rayleigh_stiffness = x, &[-0.1, f64::NAN, f64::INFINITY]),
    ];
    for (field, spoil, values) in reals {
        for &value in values {
            let mut spec = super::spec(20, PINNED);
            spoil(&mut spec, value);
            let text = Beam::new(spec).unwrap_err().to_string();
            assert!(text.starts_with(&format!("{field} = {value}: must be ")), "{text}");
        }
    }
    for (elements, supports) in
        [(0, PINNED), (MAX_ELEMENTS + 1, PINNED), (usize::MAX, PINNED), (1, [Support::Clamped; 2])]
    {
        let text = Beam::new(super::spec(elements, supports)).unwrap_err().to_string();
        assert!(text.starts_with(&format!("elements = {elements}: must be ")), "{text}");
    }
}

#[test]
fn the_smallest_and_the_finest_mesh_are_taken() {
    assert_eq!(super::beam(1, PINNED).free_dofs(), 2);
    assert_eq!(super::beam(MAX_ELEMENTS, PINNED).free_dofs(), 2 * MAX_ELEMENTS);
}

#[test]
fn a_bad_section_is_refused_by_argument_and_value() {
    let good = [0.03, 0.0015, 69e9, 2700.0];
    for (i, name) in ["width", "thickness", "youngs_modulus", "density"].into_iter().enumerate() {
        for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let mut v = good;
            v[i] = value;
            let text = Section::rectangle(v[0], v[1], v[2], v[3]).unwrap_err().to_string();
            assert!(text.starts_with(&format!("{name} = {value}: must be ")), "{text}");
        }
    }
    assert!(matches!(Section::new(1.0, -2.0), Err(BeamError::Value { value: -2.0, .. })));
    // Each number is good, their product is none.
    assert!(Section::rectangle(1e200, 1e200, 1.0, 1.0).is_err());
}

#[test]
fn a_bad_frequency_is_refused_before_a_beam_is_made() {
    let mut spec = super::spec(20, PINNED);
    assert!(spec.circular_frequency(0).unwrap_err().to_string().starts_with("mode = 0"));
    assert!(spec.viscous_for_ratio(1, -0.1).unwrap_err().to_string().starts_with("ratio = -0.1"));
    spec.span = f64::NAN;
    assert!(spec.circular_frequency(1).unwrap_err().to_string().starts_with("span = NaN"));
}

#[test]
fn a_shape_that_breaks_a_support_is_refused_by_node_and_component() {
    let beam = super::beam(2, [Support::Clamped, Support::Pinned]);
    let good = [[0.0, 0.0], [1e-3, 0.1], [0.0, -0.2]];
    let table = [
        (0, 0, 1e-4, "nodal[0][0] = 0.0001: must be 0, the support there is clamped"),
        (0, 1, 0.1, "nodal[0][1] = 0.1: must be 0, the support there is clamped"),
        (2, 0, -1e-4, "nodal[2][0] = -0.0001: must be 0, the support there is pinned"),
        (1, 0, f64::NAN, "nodal = NaN: must be finite"),
    ];
    for (node, component, value, expected) in table {
        let mut nodes = good;
        nodes[node][component] = value;
        assert_eq!(beam.from_nodes(&nodes).unwrap_err().to_string(), expected);
    }
    assert_eq!(beam.from_nodes(&good[..2]).unwrap_err().to_string(), "nodal: has 2 entries, must have 3");
    // Rounding at a support is no motion.
    let mut nodes = good;
    nodes[2][0] = 1.2e-19;
    assert!(beam.from_nodes(&nodes).is_ok());
}
