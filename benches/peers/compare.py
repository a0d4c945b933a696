#!/usr/bin/env python3
"""teeter, Siconos, MuJoCo and rapier on the same two scenes, in turn, on one core: accuracy against CPU time. README.md says how to read it."""

import argparse
import csv
import datetime
import os
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
import accuracy  # noqa: E402
import drivers  # noqa: E402
import page  # noqa: E402
import search  # noqa: E402
from drivers import Job, Refused, middle  # noqa: E402
from folders import writable_folder  # noqa: E402


STEPS = [1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5]
FINER = [5e-6, 2e-6, 1e-6]
BEAM_END = 0.2  # s: past the first impacts of the scene, well before its horizon
REFERENCE = ("event-driven", 1e-3)  # every closure of the chatter located; its step is only that of the output
FINE = 5e-7  # s
MESHES = [10, 20, 40, 100, 400]
MESH = 20
COST_STEP = 1e-4
OURS = {name: (f'time.scheme="{name}"',) for name in ("moreau-jean", "moreau-jean-closed", "moreau-jean-located")}
ON_BEAMS = {**OURS, "resolved": ('time.scheme="resolved"',)}
CHAIN = "chain of 20 links"
MODES = ('beam.table.model="modes"',)


def label(job):
    """The settings, short: what a reader would type."""
    return job.label or " ".join(job.settings)


def ground_jobs(names):
    """Scene R: every program's ladder with the settings that the search kept for a step, and ours with its defaults."""
    for step in STEPS + FINER:
        steps = round(accuracy.END / step)
        if "teeter" in names:
            for scheme, words in OURS.items():
                yield Job("teeter", "ground", 0, step, steps, words, scheme)
        for name in names:
            if name == "teeter" or step >= STEPS[-1]:
                for words in search.kept(name, step):
                    yield Job(name, "ground", 0, step, steps, words, tuned=True)


def beam_jobs(names):
    """Scene B with 20 elements, or links."""
    for step in STEPS[3:] + FINER:
        steps = round(BEAM_END / step)
        if "teeter" in names:
            for scheme, words in ON_BEAMS.items():
                yield Job("teeter", "beam", MESH, step, steps, words, scheme)
                yield Job("teeter", "beam", MESH, step, steps, words + MODES, f"{scheme}, modes")
        if "siconos" in names and step >= STEPS[-1]:
            yield Job("siconos", "beam", MESH, step, steps, (), "theta=0.5")
            yield Job("siconos", "beam", MESH, step, steps, ("theta=0.5", "gamma=0"))
            for modes in (10, 20):
                yield Job("siconos", "beam", MESH, step, steps, (f"modes={modes}",), f"{modes} modes")
        if "mujoco" in names and step >= STEPS[-1]:
            for links in (10, MESH):
                for integrator in ("implicitfast", "RK4"):
                    yield Job(
                        "mujoco",
                        "beam",
                        links,
                        step,
                        steps,
                        (f"integrator={integrator}",),
                        f"{links} links, {integrator}",
                    )
        if "rapier" in names and step >= 5e-5:
            for links, iterations in ((10, 1), (10, 8), (MESH, 1), (MESH, 8)):
                words = (
                    f"iterations={iterations}",
                    "sweeps=4",
                    "frequency=1e5",
                    "damping=1",
                    "stabilisation=0",
                    "unit=0.01",
                    "recycle=0",
                )
                yield Job("rapier", "beam", links, step, steps, words, f"{links} links, {iterations} iterations")


def reference_jobs(names, quick):
    """The motion on the beam with its events located, and by fixed steps of ours and of Siconos that are small; and by the two chains."""
    scheme, step = REFERENCE
    yield Job("teeter", "beam", MESH, step, round(BEAM_END / step), (f'time.scheme="{scheme}"',), scheme)
    for scheme, words in OURS.items():
        yield Job("teeter", "beam", MESH, FINE, round(BEAM_END / FINE), words, scheme)
    if "siconos" in names:
        for step in (1e-5, 5e-6) if quick else (1e-5, 5e-6, 2e-6, 1e-6):
            yield Job("siconos", "beam", MESH, step, round(BEAM_END / step), (), "theta=0.5")
    if "mujoco" in names:
        yield Job("mujoco", "beam", MESH, 2e-5, round(BEAM_END / 2e-5), ("integrator=RK4",), CHAIN)
    if "rapier" in names:
        words = ("iterations=8", "sweeps=4", "frequency=1e7", "damping=1", "stabilisation=0", "unit=0.01", "recycle=0")
        yield Job("rapier", "beam", MESH, 1e-4, round(BEAM_END / 1e-4), words, CHAIN)


def cost_jobs(names):
    """Scene B at 1e-4 s, by number of elements: µs a step."""
    for elements in MESHES:
        steps = 1000 if elements <= 40 else 400 if elements <= 100 else 200
        if "siconos" in names:
            yield Job("siconos", "beam", elements, COST_STEP, steps, (), "full")
            yield Job("siconos", "beam", elements, COST_STEP, 1000, ("modes=20",), "20 modes")
        for scheme, words in OURS.items():
            yield Job("teeter", "beam", elements, COST_STEP, 1000, words, scheme)
            yield Job("teeter", "beam", elements, COST_STEP, 1000, words + MODES, f"{scheme}, modes")


class Bench:
    def __init__(self, running, turns, budget, once, say):
        self.running, self.turns, self.budget, self.once, self.say = running, turns, budget, once, say

    def measure(self, jobs, judge):
        """A row for each job: what `judge` says of its track, and the median of its CPU times over all turns, in ms. The turns go round the
        programs, so that a machine that slows down slows all of them; a job that takes longer than `once` seconds has one."""
        rows, times = [], {}
        for turn in range(self.turns):
            for job in jobs:
                if turn and (job not in times or times[job][0] > self.once):
                    continue
                try:
                    spent, track = self.running[job.program].run(job, self.budget)
                except Refused as refused:
                    if not turn:
                        self.say(f"  {job.program}, step {job.step:g}, {label(job)}: {refused}")
                        rows.append({"job": job, "failed": str(refused)})
                    continue
                if not turn:
                    rows.append({"job": job, **judge(job, track)})
                times.setdefault(job, []).append(middle(spent))
        for row in rows:
            if "failed" not in row:
                found = sorted(times[row["job"]])
                row["ms"] = 1e3 * drivers.median(found)
                row["spread"] = (1e3 * found[0], 1e3 * found[-1])
                row["us"] = 1e3 * row["ms"] / row["job"].steps
        return rows


def samples(track, step):
    every = round(accuracy.SAMPLE / step)
    return list(track[2][::every])


def apart(a, b):
    """The largest difference of two motions' φ, relative to the release."""
    return max(abs(x - y) for x, y in zip(a, b)) / accuracy.TILT


def beam_reference(bench, names, quick):
    """Our motion by `event-driven`; how far ours at 0.5 µs, Siconos' and the chains are from it, and the two chains from each other."""
    motions = {}
    for job in reference_jobs(names, quick):
        try:
            _, track = bench.running[job.program].run(job, 0.0)
            motions[job.program, job.label, job.step] = samples(track, job.step)
        except Refused as refused:
            bench.say(f"  {job.program}, step {job.step:g}, {label(job)}: {refused}")
    ours = motions["teeter", *REFERENCE]
    chains = [motion for (_, label, _), motion in motions.items() if label == CHAIN]
    return {
        "samples": ours,
        "apart": {key: apart(motion, ours) for key, motion in motions.items() if motion is not ours},
        "uncertainty": min(apart(motions["teeter", scheme, FINE], ours) for scheme in OURS),
        "chains": apart(*chains) if len(chains) == 2 else None,
    }


COLUMNS = (
    "table program elements step_s steps settings cpu_ms cpu_ms_least cpu_ms_most us_a_step "
    "angle_error peak_error first_impact_error_s penetration_m failed"
)


def write_csv(path, tables):
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(COLUMNS.split())
        for name, rows in tables.items():
            for row in rows:
                job, spread = row["job"], row.get("spread", ("", ""))
                found = [row.get(key, "") for key in ("us", "angle", "peaks", "impact", "penetration", "failed")]
                values = [row.get("ms", ""), *spread, *found]
                writer.writerow(
                    [name, job.program, job.elements, f"{job.step:g}", job.steps, label(job)]
                    + [f"{v:.6g}" if isinstance(v, float) else v for v in values]
                )


def arguments():
    today = datetime.date.today().isoformat()
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--programs", default=",".join(drivers.NAMES), help="which of them (teeter always)")
    parser.add_argument("--quick", action="store_true", help="one turn, no step under 1e-4 s for the peers: a minute")
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--core", type=int, default=os.cpu_count() - 1, help="the core on which all of it runs")
    parser.add_argument("--python", help="a Python that has MuJoCo; else one is made for it")
    parser.add_argument(
        "--search", metavar="NAMES", help="tune these programs anew first (settings.json): ten minutes for all"
    )
    parser.add_argument("--out", type=writable_folder, default=str(drivers.ROOT / "benches" / "results"), help="folder of the results")
    parser.add_argument("--name", default=f"peers-{today}")
    return parser.parse_args()


def told(args):
    """The command, without what is of this machine only."""
    words = ["python3 benches/peers/compare.py"]
    words += ["--quick"] if args.quick else [f"--turns {args.turns}"]
    words += [f"--programs {args.programs}"] if args.programs != ",".join(drivers.NAMES) else []
    words += [f"--search {args.search}"] if args.search else []
    return " ".join(words)


def main():
    args = arguments()
    begin = time.time()

    def say(text):
        print(f"{time.time() - begin:6.1f} s  {text}", flush=True)

    commands = {}
    for name in ["teeter"] + [name for name in args.programs.split(",") if name != "teeter"]:
        try:
            commands[name] = drivers.command(name, args.python)
        except (OSError, subprocess.CalledProcessError) as error:
            if name == "teeter":
                raise
            say(f"{name} is left out, for it can't be built: {error}")
    names = list(commands)
    say("built")
    began = time.time()
    running = {name: drivers.Driver(name, words, args.core) for name, words in commands.items()}
    if args.search:
        search.search(running, args.search.split(","), say)
        began = time.time()
    bench = Bench(running, 1 if args.quick else args.turns, 0.02 if args.quick else 0.05, 1.5, say)
    slow = 1e-4 if args.quick else 0.0

    def wanted(jobs):
        return [job for job in jobs if job.program == "teeter" or job.step >= slow]

    ground = bench.measure(wanted(ground_jobs(names)), lambda job, track: accuracy.housner_errors(track, job.step))
    say(f"scene R: {len(ground)} rows")
    reference = beam_reference(bench, names, args.quick)
    say("the beam's reference")
    beam = bench.measure(
        wanted(beam_jobs(names)),
        lambda job, track: {"angle": accuracy.angle_error(track[2], job.step, reference["samples"], BEAM_END)},
    )
    say(f"scene B: {len(beam)} rows")
    cost = bench.measure(list(cost_jobs(names)), lambda job, track: {})
    say("cost by mesh")
    for driver in running.values():
        driver.stop()

    out = args.out
    tables = {"ground": ground, "beam": beam, "cost": cost}
    write_csv(out / f"{args.name}.csv", tables)
    figures = page.figures(tables, reference)
    for which, svg in figures.items():
        (out / f"{args.name}-{which}.svg").write_text(svg)
    about = {
        "command": told(args),
        "took": time.time() - began,
        "core": args.core,
        "commands": commands,
        "name": args.name,
    }
    (out / f"{args.name}.md").write_text(page.page(tables, reference, about))
    say(f"written to {out / args.name}.md, .csv and two figures; measuring took {time.time() - began:.0f} s")


if __name__ == "__main__":
    main()
