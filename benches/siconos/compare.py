#!/usr/bin/env python3
"""teeter and Siconos on the same contact problems, in turn, on this machine. README.md says how to read it."""

import argparse
import csv
import datetime
import math
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import page  # noqa: E402
import siconos  # noqa: E402
from folders import writable_folder  # noqa: E402
from programs import HERE, ROOT, Crash, Driver, Place, Teeter, middle  # noqa: E402

# The methods of the same name: ours, theirs, and the dimensions in which both have it.
PAIRS = [
    ("pgs", "NSGS", (2, 3)),
    ("newton", "NSN_AC", (3,)),
    ("admm", "ADMM", (3,)),
    ("prox", "PROX", (3,)),
    ("vi-eg", "VI_EG", (3,)),
    ("lemke", "LEMKE", (2,)),
    ("enumeration", "ENUM", (2,)),
]
# As `teeter solve` does: a solve is repeated until this time has gone into it, or so often.
RUNS, BUDGET = 51, 0.1
FIELDS = [
    "program",
    "solver",
    "used",
    "file",
    "dimension",
    "contacts",
    "tolerance",
    "outcome",
    "residual",
    "iterations",
    "time_ms",
    "runs",
    "solver_tolerance",
    "cap",
    "note",
]


class SiconosEntry:
    """One of Siconos' solvers with the settings that it needs at this tolerance."""

    def __init__(self, settled, protocol):
        self.settled, self.protocol = settled, protocol
        self.samples, self.over = [], not settled.solved

    def measure(self, problem):
        s = self.settled
        try:
            # It has solved this one before: a machine that is slower today shall not fail it.
            answer = self.protocol.drive(problem, s.solver, s.own_tolerance, s.cap, limit=3 * self.protocol.limit)
        except Crash as crash:
            self.settled = siconos.Settled(
                s.solver, s.tolerance, f"crash ({crash})", own_tolerance=s.own_tolerance, cap=s.cap
            )
            self.over = True
            return
        now = self.protocol.read(s.solver, s.tolerance, s.own_tolerance, s.cap, answer)
        now.note = s.note
        self.settled, self.over = now, not now.solved
        self.samples.append((now.time_ms, now.runs))

    def row(self):
        s = self.settled
        return {
            "program": "siconos",
            "solver": s.solver,
            "used": s.solver,
            "outcome": s.outcome,
            "residual": s.residual,
            "iterations": s.iterations,
            "solver_tolerance": s.own_tolerance,
            "cap": s.cap,
            "note": s.note,
            "time_ms": middle_of_rounds(self.samples, s.time_ms),
            "runs": sum(n for _, n in self.samples) or s.runs,
        }


class TeeterEntry:
    """One of our solvers at its default settings."""

    def __init__(self, teeter, solver, tolerance, protocol, scratch):
        self.teeter, self.solver, self.tolerance = teeter, solver, tolerance
        self.limit, self.scratch = protocol.limit, scratch
        self.samples, self.over, self.answer, self.crash = [], False, None, ""

    def measure(self, problem):
        try:
            self.answer = self.teeter.solve(problem, self.solver, self.tolerance, self.limit, self.scratch)
        except Crash as crash:
            self.crash, self.over = str(crash), True
            return
        self.samples.append((self.answer["time_ms"], 1))
        self.over = not self.solved()

    def solved(self):
        return not self.crash and self.answer["residual"] <= self.tolerance

    def row(self):
        if self.crash:
            return {
                "program": "teeter",
                "solver": self.solver,
                "used": "",
                "outcome": f"crash ({self.crash})",
                "residual": math.nan,
                "note": "",
                "iterations": "",
                "time_ms": math.nan,
                "runs": 0,
            }
        a = self.answer
        outcome, note = ("solved", "") if self.solved() else (a["outcome"], "")
        if self.solved() != (a["outcome"] == "converged"):
            note = f"says {a['outcome']}, with {a['own_residual']}"
            outcome = outcome if self.solved() else "says converged, judge not"
        return {
            "program": "teeter",
            "solver": self.solver,
            "used": a["used"],
            "outcome": outcome,
            "residual": a["residual"],
            "iterations": a["iterations"],
            "note": note,
            "time_ms": middle_of_rounds(self.samples, math.nan),
            "runs": sum(n for _, n in self.samples),
        }


def middle_of_rounds(samples, otherwise):
    times = sorted(t for t, _ in samples)
    if not times:
        return otherwise
    half = len(times) // 2
    return times[half] if len(times) % 2 else (times[half - 1] + times[half]) / 2


def problems_in(places):
    """(name, path): a file of a folder by its path in it."""
    for place in places:
        place = Path(place)
        if place.is_file():
            yield place.name, place
        elif place.is_dir():
            yield from ((str(f.relative_to(place)), f) for f in sorted(place.rglob("*.hdf5")))
        else:
            sys.exit(f"compare.py: {place}: no such file or folder")


def previous_settings(path):
    """What an earlier run found for Siconos: by problem, the settings of each solver and tolerance."""
    kept = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            if row.get("program", "siconos") == "siconos":
                kept.setdefault(Path(row["file"]).stem, []).append(siconos.from_row(row))
    return {stem: [s for s in settings if s] for stem, settings in kept.items()}


def wanted(settings, tolerance, pairs_with, best):
    """The `best` fastest at a tolerance, none of them 4 times slower than the fastest, and those that we pair with ours."""
    here = sorted((s for s in settings if math.isclose(s.tolerance, tolerance, rel_tol=1e-6)), key=lambda s: s.time_ms)
    chosen = []
    for group in (
        [s for s in here if siconos.by_the_rule(s.solver)],
        [s for s in here if not siconos.by_the_rule(s.solver)],
    ):
        for k, s in enumerate(group):
            if best is None or s.solver in pairs_with or (k < best and s.time_ms <= 4 * here[0].time_ms):
                chosen.append(s)
    return chosen


def arguments():
    parse = argparse.ArgumentParser(description=__doc__)
    parse.add_argument(
        "problems",
        nargs="*",
        help="folders or files of FCLIB problems (default: ../shared/problems and benches/problems)",
    )
    parse.add_argument("--tolerances", default="1e-4,1e-8,1e-12")
    parse.add_argument(
        "--solvers",
        help="of teeter, with commas (default: auto, and without --quick those that Siconos has by the same name)",
    )
    parse.add_argument(
        "--quick", action="store_true", help="of Siconos run only the two best by an earlier run, and fewer repetitions"
    )
    parse.add_argument(
        "--previous",
        help="that earlier run (default: the newest siconos-*.csv kept, else siconos_baseline.csv beside the problems)",
    )
    parse.add_argument("--siconos-only", action="store_true")
    parse.add_argument("--above", type=int, default=0, help="only problems of more contacts than this")
    parse.add_argument("--out", type=writable_folder, default=str(HERE.parent / "results"), help="folder for the table and the page")
    parse.add_argument("--name", default=f"siconos-{datetime.date.today()}", help="stem of the two files")
    parse.add_argument("--teeter", help="the program (default: builds this workspace's)")
    parse.add_argument("--core", type=int, default=0, help="the core that everything runs on")
    parse.add_argument(
        "--ahead", action="store_true", help="run both programs before the machine's other work (root only: nice -15)"
    )
    parse.add_argument(
        "--limit", type=float, default=10.0, help="CPU seconds a solve may take (half of it for PROX and VI_EG)"
    )
    parse.add_argument("--rounds", type=int, help="how often the programs take turns on a problem")
    return parse.parse_args()


def default_previous(out, places):
    kept = sorted(Path(out).glob("siconos-*.csv")) + [Path(p) / "siconos_baseline.csv" for p in places]
    dated = [k for k in kept if k.exists()]
    return max(dated, key=lambda k: (k.name != "siconos_baseline.csv", k.stat().st_mtime)) if dated else None


def main():
    args = arguments()
    places = args.problems or [p for p in (ROOT.parent / "shared" / "problems", HERE.parent / "problems") if p.is_dir()]
    tolerances = sorted((float(t) for t in args.tolerances.split(",")), reverse=True)
    rounds, enough = (2, 300) if args.quick else (3, 4000)  # turns, and the ms after which one has had enough of them

    place = Place(args.core, args.ahead)
    driver = Driver(place, "cpu" if args.siconos_only else "wall")
    driver.build()
    teeter = None if args.siconos_only else Teeter(place, driver, args.teeter)
    ours = []
    if teeter:
        teeter.build()
        known = teeter.solvers()
        ours = args.solvers.split(",") if args.solvers else ["auto"] + ([] if args.quick else [p[0] for p in PAIRS])
        for absent in [o for o in ours if o not in known]:
            print(f"teeter has no solver {absent}: left out", file=sys.stderr)
        ours = [o for o in ours if o in known]
    protocol = siconos.Protocol(driver, RUNS, BUDGET, args.limit)
    previous = args.previous or (default_previous(args.out, places) if args.quick else None)
    settings = previous_settings(previous) if previous else {}

    problems = []
    for name, path in problems_in(places):
        try:
            problems.append((name, path, *driver.describe(path)))
        except Crash as crash:
            print(f"{path}: no local FCLIB problem, left out ({crash})", file=sys.stderr)
    problems = sorted((p for p in problems if p[3] > args.above), key=lambda p: p[3])
    begin, rows = time.time(), []
    with tempfile.TemporaryDirectory() as scratch:
        for number, (name, path, dimension, contacts, storage) in enumerate(problems, 1):
            theirs = settings.get(path.stem)
            if theirs is None:  # every solver, every tolerance: what each needs
                theirs = [
                    s
                    for solver in siconos.solvers(dimension, contacts, storage)
                    for s in protocol.settle(path, solver, tolerances)
                ]
            for tolerance in tolerances:
                mine = [o for o in ours if o == "auto" or not any(o == a and dimension not in d for a, _, d in PAIRS)]
                pairs_with = {b for a, b, _ in PAIRS if a in mine}
                entries = [
                    SiconosEntry(s, protocol) for s in wanted(theirs, tolerance, pairs_with, 2 if args.quick else None)
                ]
                entries += [TeeterEntry(teeter, o, tolerance, protocol, scratch) for o in mine]
                take_turns(entries, path, args.rounds or rounds, enough)
                shared = {"file": name, "dimension": dimension, "contacts": contacts, "tolerance": tolerance}
                rows += [{**shared, **entry.row()} for entry in entries]
            print(f"{number}/{len(problems)} {name}: {time.time() - begin:.0f} s so far", file=sys.stderr)

    out = args.out
    out.mkdir(parents=True, exist_ok=True)
    with open(out / f"{args.name}.csv", "w", newline="") as file:
        table = csv.DictWriter(file, FIELDS, lineterminator="\n")
        table.writeheader()
        table.writerows({k: written(v) for k, v in row.items()} for row in rows)
    about = page.machine(args.core, ["compare.py"] + sys.argv[1:], teeter, time.time() - begin, previous)
    (out / f"{args.name}.md").write_text(page.page(rows, tolerances, PAIRS, about, args.name))
    print(page.summary(rows, tolerances))


def take_turns(entries, path, rounds, enough):
    """One turn each, round after round; whoever has failed or has taken long enough is done."""
    for _ in range(rounds):
        for entry in entries:
            if not entry.over:
                entry.measure(path)
                entry.over = entry.over or sum(t * n for t, n in entry.samples) > enough


def written(value):
    return f"{value:.4g}" if isinstance(value, float) else value


if __name__ == "__main__":
    main()
