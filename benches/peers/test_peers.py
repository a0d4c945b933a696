"""The arithmetic of the comparison: python3 -m unittest discover benches/peers"""

import json
import math
import unittest
from array import array

import accuracy
import compare
import figure
import page
import search
from drivers import Job, middle
from front import cheapest, front, thinned

# Thirty digits of an independent computation, rounded: the impacts and peaks of Housner's block (s; degrees).
IMPACTS = [
    0.1065102494257787,
    0.2924883786209590,
    0.4575369613794153,
    0.6055805824371352,
    0.7393648085500958,
    0.8609261793512886,
]
PEAKS = [5.0, -4.143612418601134, 3.4683697087566774, -2.922929838949477, 2.475357949574953, -2.1040476397216907]


class TheExactBlock(unittest.TestCase):
    def test_impacts_and_peaks_are_those_of_the_independent_computation(self):
        exact = accuracy.exact()
        for found, wanted in zip(exact.impacts, IMPACTS, strict=True):
            self.assertAlmostEqual(found, wanted, delta=1e-12)
        for found, wanted in zip(exact.peaks, PEAKS, strict=True):
            self.assertAlmostEqual(math.degrees(found), wanted, delta=1e-11)

    def test_half_the_step_gives_the_same_samples(self):
        for a, b in zip(accuracy.exact(50).samples, accuracy.exact(100).samples, strict=True):
            self.assertAlmostEqual(a, b, delta=1e-12)

    def test_samples_known_from_elsewhere(self):
        samples = accuracy.exact().samples
        for time, phi in ((0.02, 0.08446832526615237), (0.15, -0.052898471685387714), (0.7, 0.03611897291021429)):
            self.assertAlmostEqual(samples[round(time / accuracy.SAMPLE)], phi, delta=1e-11)


class WhatATrackIsWorth(unittest.TestCase):
    def test_a_crossing_is_linear_between_steps_and_a_zero_counts_once(self):
        self.assertEqual(
            accuracy.crossings([2.0, 1.0, -1.0, -2.0, 1.0], 0.1), [0.15000000000000002, 0.3666666666666667]
        )
        self.assertEqual(len(accuracy.crossings([1.0, 0.0, -1.0], 0.1)), 1)

    def test_peaks_begin_with_the_release_and_leave_the_unfinished_one_out(self):
        self.assertEqual(accuracy.peaks([5.0, 1.0, -3.0, -4.0, -1.0, 2.0, 9.0]), [5.0, -4.0])

    def test_penetration_is_that_of_the_lower_corner(self):
        self.assertEqual(accuracy.penetration([accuracy.HEIGHT / 2], [0.0]), 0.0)
        upright = accuracy.penetration([accuracy.HEIGHT / 2 - 1e-4], [0.0])
        self.assertAlmostEqual(upright, 1e-4, delta=1e-15)
        for phi in (0.1, -0.1):
            height = accuracy.RADIUS * math.cos(accuracy.ALPHA - 0.1)  # one corner exactly on the ground
            self.assertAlmostEqual(accuracy.penetration([height - 2e-5], [phi]), 2e-5, delta=1e-15)

    def test_the_exact_motion_has_no_error_and_a_shifted_one_has_its_shift(self):
        phi, truth = accuracy.exact(50).samples, accuracy.exact().samples
        self.assertLess(accuracy.angle_error(phi, accuracy.SAMPLE, truth, accuracy.FIRST_FIVE), 1e-11)
        shifted = array("d", (x + 1e-3 * accuracy.TILT for x in phi))
        self.assertAlmostEqual(accuracy.angle_error(shifted, accuracy.SAMPLE, truth, 0.7), 1e-3, delta=1e-10)

    def test_a_block_that_never_comes_back_has_no_peaks_to_compare(self):
        n = round(accuracy.END / 1e-2)
        errors = accuracy.housner_errors((array("d"), array("d", [1.0] * (n + 1)), array("d", [0.1] * (n + 1))), 1e-2)
        self.assertTrue(math.isnan(errors["peaks"]) and math.isnan(errors["impact"]))
        self.assertGreater(errors["angle"], 1)

    def test_all_steps_of_the_ladder_meet_the_samples(self):
        for step in compare.STEPS + compare.FINER:
            self.assertAlmostEqual(round(accuracy.SAMPLE / step) * step, accuracy.SAMPLE, delta=1e-15)
            self.assertAlmostEqual(round(accuracy.END / step) * step, accuracy.END, delta=1e-12)


class TheFront(unittest.TestCase):
    POINTS = [
        {"ms": 3.0, "angle": 1e-3},
        {"ms": 1.0, "angle": 1e-1},
        {"ms": 2.0, "angle": 2e-1},
        {"ms": 3.5, "angle": 0.99e-3},
        {"ms": 0.1, "angle": math.nan},
    ]

    def test_only_what_nothing_beats_is_on_it(self):
        self.assertEqual([p["ms"] for p in front(self.POINTS)], [1.0, 3.0, 3.5])

    def test_a_search_keeps_no_point_that_is_hardly_better(self):
        self.assertEqual([p["ms"] for p in thinned(self.POINTS)], [1.0, 3.0])

    def test_the_cheapest_way_to_an_accuracy(self):
        self.assertEqual(cheapest(self.POINTS, 1e-1)["ms"], 1.0)
        self.assertEqual(cheapest(self.POINTS, 5e-3)["ms"], 3.0)
        self.assertIsNone(cheapest(self.POINTS, 1e-5))


def row(program, ms, angle, elements=20, label="x", step=1e-4, steps=1000):
    job = Job(program, "beam", elements, step, steps, (), label)
    return {
        "job": job,
        "ms": ms,
        "spread": (ms, ms),
        "us": 1e3 * ms / steps,
        "angle": angle,
        "peaks": angle,
        "impact": angle,
        "penetration": 0.0,
    }


class ThePage(unittest.TestCase):
    def test_a_target_is_ours_where_we_are_cheaper_and_said_so_where_not(self):
        rows = [
            row("teeter", 1.0, 5e-2),
            row("teeter", 10.0, 5e-4),
            row("mujoco", 20.0, 5e-2),
            row("rapier", 4.0, 8e-4),
        ]
        said = page.who_leads(rows, "Here")
        self.assertIn("0.1 (4.0 ×)", said[0])
        self.assertIn("0.001 (rapier2d-f64, 2.5 ×)", said[-1])
        self.assertNotIn("0.001", said[0])

    def test_the_ratio_is_against_the_best_peer(self):
        rows = [row("teeter", 2.0, 1e-3), row("mujoco", 20.0, 1e-3), row("siconos", 8.0, 1e-3)]
        ratios = {target: ratio for target, _, (ratio, _) in page.targets(rows)}
        self.assertEqual(ratios[1e-3], 4.0)
        self.assertIsNone(ratios[1e-4])

    def test_our_tuned_runs_are_no_peer_and_do_not_pass_for_our_defaults(self):
        tuned = row("teeter", 1.0, 1e-3)
        tuned["job"] = Job("teeter", "beam", 20, 1e-4, 1000, (), "x", tuned=True)
        rows = [tuned, row("teeter", 10.0, 1e-3), row("mujoco", 20.0, 1e-3)]
        self.assertEqual({target: ratios for target, _, ratios in page.targets(rows)}[1e-3], [2.0, 20.0])

    def test_a_run_that_is_off_by_the_release_itself_tells_nothing(self):
        self.assertEqual(page.targets([row("teeter", 1.0, 1.5)])[0][1], {})

    def test_an_aim_that_is_missed_is_said_to_be(self):
        many = [row("siconos", 60.0, 0, label="full"), row("teeter", 1.0, 0, label="moreau-jean")]
        many += [row("siconos", 499.0, 0, 400, "full"), row("teeter", 1.0, 0, 400, "moreau-jean")]
        first, second = page.verdict(many)
        self.assertIn("60 × Siconos (aim: 50 ×, reached)", first)
        self.assertIn("**not reached**", second)

    def test_failures_of_one_setting_are_one_row(self):
        failed = [{"job": Job("mujoco", "beam", 20, step, 1, (), "x"), "failed": "died"} for step in (1e-3, 1e-4)]
        lines = page.failed_table([*failed, row("teeter", 1.0, 1e-3)])
        self.assertEqual([line for line in lines if "died" in line], ["| MuJoCo | beam | x | 0.001, 0.0001 | died |"])
        self.assertEqual(page.failed_table([row("teeter", 1.0, 1e-3)]), [])

    def test_a_figure_is_one_well_formed_picture(self):
        from xml.dom.minidom import parseString

        series = {"teeter": [(1.0, 1e-2), (10.0, 1e-4)], "mujoco": [(5.0, 1e-1)]}
        svg = figure.figure("a < b", series, series, {"teeter": "t", "mujoco": "<m>"}, "x", "y", floor=1e-5)
        picture = parseString(svg)
        self.assertEqual(len(picture.getElementsByTagName("polyline")), 2)
        self.assertEqual(svg.count('r="3.2"'), 3)  # two points and the legend's


class TheSettings(unittest.TestCase):
    def test_a_job_is_one_line_of_words(self):
        line = Job("mujoco", "ground", 0, 1e-4, 9000, ("a=1", "b=2"), "label").line(0.05, "/tmp/x")
        self.assertEqual(line, "ground 0 0.0001 9000 0.05 /tmp/x a=1 b=2\n")

    def test_the_first_of_many_times_is_left_out(self):
        self.assertEqual(middle([9.0, 1.0, 3.0]), 2.0)
        self.assertEqual(middle([4.0, 2.0]), 3.0)

    def test_a_grid_names_every_setting_once_and_leaves_none_out(self):
        words = list(search.combinations({"a": ["1", None], "b": ["2", "3"]}))
        self.assertEqual(words, [("a=1", "b=2"), ("a=1", "b=3"), ("b=2",), ("b=3",)])

    def test_kept_settings_are_of_the_grid_that_was_searched(self):
        table = json.loads(search.KEPT.read_text())
        self.assertEqual(sorted(table), sorted(search.GRIDS))
        for name, steps in table.items():
            grid = set(search.combinations(search.GRIDS[name]))
            for settings in steps.values():
                self.assertTrue(settings)
                for words in settings:
                    self.assertIn(tuple(words), grid)

    def test_a_step_between_takes_the_settings_of_the_nearest(self):
        self.assertEqual(search.kept("mujoco", 2e-3), search.kept("mujoco", 1e-3))


if __name__ == "__main__":
    unittest.main()
