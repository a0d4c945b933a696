"""The protocol and the figures, on made-up solvers: python3 -m unittest discover benches/siconos"""

import argparse
import math
import tempfile
import unittest
from pathlib import Path

import compare
import folders
import page
import siconos


class MadeUp:
    """A driver whose solver needs `needed` iterations a digit and stops by a criterion of its own, `slack` times the judge's."""

    def __init__(self, slack=1.0, own_floor=0.0, floor=0.0):
        self.slack, self.own_floor, self.floor, self.calls = slack, own_floor, floor, []

    def solve(self, problem, solver, own_tolerance, cap, runs, budget, limit):
        self.calls.append((own_tolerance, cap))
        wanted = math.ceil(-100 * math.log10(own_tolerance))
        met = own_tolerance >= self.own_floor
        steps = min(wanted, cap) if met else cap
        residual = max(self.slack * 10 ** (-steps / 100), self.floor) if steps < 1e6 else self.floor
        ended = "returned" if met or cap < 1e6 else "timeout"
        time = 1000 * limit if ended == "timeout" else float(steps)
        return {
            "ended": ended,
            "info": 0 if met and steps == wanted else 1,
            "iterations": steps,
            "residual": residual,
            "times_ms": [time],
        }


def settle(driver, tolerances=(1e-4, 1e-8)):
    return siconos.Protocol(driver, 1, 0.1, 10.0).settle("problem", "NSGS", tolerances)


class TheProtocol(unittest.TestCase):
    def test_a_laxer_criterion_is_tightened_until_the_judge_is_content(self):
        loose, tight = settle(MadeUp(slack=50.0))
        self.assertEqual((loose.outcome, tight.outcome), ("solved", "solved"))
        self.assertAlmostEqual(loose.own_tolerance, 1e-6)
        self.assertAlmostEqual(tight.own_tolerance, 1e-10)

    def test_three_tenths_are_all_it_gets(self):
        result = settle(MadeUp(slack=1e5))[0]
        self.assertEqual(result.outcome, "own criterion met, judge not")
        self.assertAlmostEqual(result.own_tolerance, 1e-7)

    def test_a_criterion_that_is_never_met_costs_the_smallest_cap_that_will_do(self):
        loose, tight = settle(MadeUp(own_floor=1.0))
        self.assertEqual((loose.cap, tight.cap), (512, 1024))
        self.assertTrue(loose.solved and tight.solved)

    def test_a_slow_failure_isnt_tried_again_tighter(self):
        driver = MadeUp(own_floor=1e-6, floor=1e-6)
        results = settle(driver, (1e-4, 1e-8, 1e-12))
        self.assertEqual([r.outcome.split(" (")[0] for r in results], ["solved", "time limit", "not run"])
        self.assertEqual(len(driver.calls), 2)

    def test_settings_come_back_from_a_table(self):
        row = {
            "solver": "NSGS",
            "outcome": "solved",
            "tolerance": "1e-08",
            "solver_tolerance": "1e-09",
            "cap": "512",
            "time_ms": "3",
        }
        kept = siconos.from_row(row)
        self.assertEqual((kept.own_tolerance, kept.cap, kept.time_ms), (1e-9, 512, 3.0))
        self.assertIsNone(siconos.from_row({**row, "outcome": "time limit"}))
        listed = {**row, "outcome": "", "solved": "1", "cap": "", "iterations": "152716", "status": "solved"}
        self.assertEqual(siconos.from_row(listed).cap, siconos.NO_CAP)
        self.assertEqual(siconos.from_row({**listed, "status": "solved (own criterion not met)"}).cap, 152716)


def row(program, solver, file, time, outcome="solved", contacts=20):
    return {
        "program": program,
        "solver": solver,
        "used": solver,
        "file": file,
        "dimension": 3,
        "contacts": contacts,
        "tolerance": 1e-8,
        "outcome": outcome,
        "residual": 1e-9,
        "time_ms": time,
        "note": "",
    }


class TheFigures(unittest.TestCase):
    rows = [
        row("siconos", "NSGS", "a", 8.0),
        row("siconos", "PROX", "a", 4.0),
        row("teeter", "auto", "a", 1.0),
        row("siconos", "NSGS", "b", 1.0),
        row("siconos", "PROX", "b", 0.1, "crash"),
        row("teeter", "auto", "b", 2.0),
        row("siconos", "NSGS", "c", 1.0),
        row("teeter", "auto", "c", 0.1, "stalled"),
        row("siconos", "NSGS", "d", 1.0, "time limit"),
        row("teeter", "auto", "d", 5.0),
        row("siconos", "NSGS", "small", 9.0, contacts=3),
        row("teeter", "auto", "small", 1.0, contacts=3),
    ]

    def test_the_best_is_the_fastest_that_solved_and_failures_are_lost(self):
        found = page.AgainstBest(self.rows, 1e-8, 10)
        self.assertEqual(found.ratios, [4.0, 0.5])
        self.assertEqual((found.faster, found.count), (2, 4))
        self.assertAlmostEqual(found.mean, math.sqrt(2.0))
        self.assertEqual([m[0] for m in found.missed], ["c"])
        self.assertEqual([l[0] for l in found.lost], ["b"])

    def test_the_other_storage_counts_only_where_it_is_asked_for(self):
        rows = self.rows + [row("siconos", "PROX dense", "a", 0.5)]
        self.assertEqual(page.AgainstBest(rows, 1e-8, 10).ratios, [4.0, 0.5])
        self.assertEqual(page.AgainstBest(rows, 1e-8, 10, any_storage=True).ratios, [0.5, 0.5])
        self.assertNotIn("that suits Siconos best", page.page(self.rows, [1e-8], compare.PAIRS, [], "name"))
        self.assertIn("that suits Siconos best", page.page(rows, [1e-8], compare.PAIRS, [], "name"))
        self.assertIn("NSGS dense", siconos.solvers(3, 20, "blocks"))
        self.assertEqual(siconos.solvers(3, 20, "dense"), siconos.SPACE)

    def test_a_pair_is_compared_where_both_solve(self):
        rows = [{**r, "solver": "pgs"} if r["program"] == "teeter" else r for r in self.rows]
        pair = page.Pair(rows, 1e-8, "pgs", "NSGS")
        self.assertEqual(sorted(pair.ratios), [0.5, 8.0, 9.0])
        self.assertEqual(([s[0] for s in pair.slower], pair.only_ours, pair.only_theirs), (["b"], ["d"], ["c"]))

    def test_the_page_holds_the_figures(self):
        text = page.page(self.rows, [1e-8], compare.PAIRS, [("date", "today")], "name")
        self.assertIn("| above 10 contacts | 1e-08 | 2 of 4 (50 %) | 1.41 | 1 | 1 | 0 |", text)

    def test_the_two_fastest_are_taken_unless_far_behind(self):
        at = [
            siconos.Settled(s, 1e-8, "solved", time_ms=t)
            for s, t in (("NSGS", 1.0), ("PROX", 3.0), ("ADMM", 3.5), ("VI_EG", 50.0))
        ]
        self.assertEqual([s.solver for s in compare.wanted(at, 1e-8, {"VI_EG"}, 2)], ["NSGS", "PROX", "VI_EG"])
        self.assertEqual(len(compare.wanted(at, 1e-8, set(), None)), 4)


class TheFolderOfResults(unittest.TestCase):
    def test_it_is_made_or_refused_before_anything_is_measured(self):
        with tempfile.TemporaryDirectory() as place:
            self.assertTrue(folders.writable_folder(f"{place}/new/one").is_dir())
            (Path(place) / "file").write_text("")
            for taken in ("file", "file/below"):
                with self.assertRaises(argparse.ArgumentTypeError):
                    folders.writable_folder(f"{place}/{taken}")


if __name__ == "__main__":
    unittest.main()
