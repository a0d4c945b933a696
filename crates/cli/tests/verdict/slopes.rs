//! Blocks on slopes.

use super::{FLOOR, HEAD, ROCKER, Ran, TIME, check_all, folder, scene, what, written};

#[test]
fn on_an_incline_it_overturns_downhill_sooner_than_uphill() {
    // Uphill to the right by 5°: 7.5° are left downhill, to the left, and 17.5° uphill.
    for (tilt, wanted) in [(8, "overturned"), (7, "rocks"), (-15, "other"), (-18, "overturned")] {
        let name = format!("incline-{tilt}");
        let text = format!("{TIME}[ground]\nincline = '5 deg'\n{ROCKER}tilt = '{tilt} deg'\n{FLOOR}");
        let ran = scene(&name, &text);
        let found = what(&ran);
        if tilt == -18 {
            assert_eq!(found, (wanted, Some("right")));
        } else if tilt == 8 {
            assert_eq!(found, (wanted, Some("left")));
        } else {
            check_all(&ran, &name);
            let part = ran.summary["max_phi_over_alpha"].as_f64().unwrap();
            // It begins within its point of no return, and comes back through upright.
            assert!(ran.column("b.phi").iter().any(|phi| (phi.to_degrees() - 5.0) * f64::from(tilt) < 0.0), "{tilt}");
            assert!(part > 0.8, "{part}");
        }
    }
}

#[test]
fn on_an_incline_beyond_alpha_what_stands_on_its_base_overturns() {
    // α is 12.5°: it is past the point of no return, and lies on its side in the end.
    for tilt in [0, -2] {
        let name = format!("steep-incline-{tilt}");
        let text = format!("{TIME}[ground]\nincline = '15 deg'\n{ROCKER}tilt = '{tilt} deg'\n{FLOOR}");
        let ran = scene(&name, &text);
        assert_eq!(what(&ran), ("overturned", Some("left")), "{tilt}: {}", ran.summary["headline"]);
        assert!(*ran.column("b.phi").last().unwrap() > 1.5, "{tilt}");
    }
}

#[test]
fn gravity_that_leans_is_the_same_as_an_incline() {
    // α is 12.5°, so that it begins past its critical angle on the second.
    for (degrees, tilt) in [(5.0_f64, 0), (5.0, 4), (5.0, -10), (15.0, 0), (15.0, -2)] {
        let lean = degrees.to_radians();
        // Downhill is to the left of a slope that rises to the right.
        let gravity = format!("['{} m/s^2', '{} m/s^2']", -9.81 * lean.sin(), -9.81 * lean.cos());
        let (head, name) = (HEAD.replace("'9.81 m/s^2'", &gravity), format!("{degrees}-{tilt}"));
        let rocker = format!("{ROCKER}tilt = '{tilt} deg'\n{FLOOR}");
        let slope = format!("{TIME}[ground]\nincline = '{degrees} deg'\n{rocker}");
        let incline = scene(&format!("slope-{name}"), &slope);
        let leaning = written(&folder(&format!("verdict-leaning-{name}")), &format!("{head}{TIME}[ground]\n{rocker}"));
        let part = |ran: &Ran| ran.verdict("b")["max_phi_over_alpha"].as_f64();
        match (part(&incline), part(&leaning)) {
            (Some(a), Some(b)) => assert!((a - b).abs() < 1e-6, "{name}: {a} {b}"),
            (a, b) => assert_eq!(a, b, "{name}"),
        }
        assert_eq!(what(&incline), what(&leaning), "{name}");
        assert_eq!(incline.verdict("b")["lies_on"], leaning.verdict("b")["lies_on"], "{name}");
    }
}
