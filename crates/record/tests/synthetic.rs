//! The record of the scenario `rocking-under-earthquake` is the one that its example makes.
#![allow(clippy::unwrap_used)]

#[path = "../examples/synthetic_record.rs"]
#[allow(dead_code)] // its `main` writes what is compared here
mod synthetic_record;

use teeter_record::Record;

#[test]
fn the_stored_record_is_the_one_of_the_example() {
    let stored = include_str!("../../../scenarios/rocking-under-earthquake.csv");
    let stored = Record::read(stored, "synthetic").unwrap();
    let made = synthetic_record::synthetic().unwrap();
    assert_eq!((stored.dt(), stored.len()), (made.dt(), made.len()));
    // Logarithm and cosine of other platforms may differ in their last bit, and a value so by its
    // last decimal.
    for (k, (a, b)) in stored.accelerations().iter().zip(made.accelerations()).enumerate() {
        assert!((a - b).abs() < 1.5e-5, "{k}: {a} {b}");
    }
}

#[test]
fn it_ends_almost_at_rest_where_it_began() {
    let record = synthetic_record::synthetic().unwrap();
    let (velocities, displacements) = record.motion();
    let (v, d) = (velocities.last().unwrap().abs(), displacements.last().unwrap().abs());
    assert!(v < 0.05 * record.velocity_peak().size, "{v} of {}", record.velocity_peak().size);
    assert!(d < record.displacement_peak().size, "{d} of {}", record.displacement_peak().size);
    assert!((record.peak_acceleration() / teeter_record::STANDARD_GRAVITY - 0.35).abs() < 1e-5);
}
