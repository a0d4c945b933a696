"""Piles of stones in teeter and rapier, in one run: time a step, residual, penetration, and how still they lie.

    python3 benches/peers/piles.py [--seconds 4] [--tolerance 1e-4] [STONES ...]    # 100 300 1000 by default; minutes

The same stones from the same places (`benches/pile`), mu 0.5, e 0, 1 ms. rapier with its defaults and with 50 iterations.
Times are CPU time: "a step" over the whole run, "at rest" over its last tenth. The residual is that of docs/theory.md §6
at the end (of teeter the largest of the last tenth), "moves" the longest way of a stone in the last tenth (a turn by
1 rad counts as 1 m in teeter, and isn't counted in rapier).
"""

import argparse
import math
import os
import re
import subprocess
import tempfile
from pathlib import Path

import drivers

LINE = re.compile(r"t ([\d.]+) ([\d.]+) us/step.*residual (\S+), penetration (\S+), kinetic (\S+), moved (\S+)")


def parts(text):
    return [[float(number) for number in found.groups()] for found in LINE.finditer(text)]


def teeter(stones, seconds, tolerance, folder):
    words = ["cargo", "bench", "--quiet", "-p", "teeter-benches", "--bench", "pile", "--", str(stones)]
    settings = dict(os.environ, SECONDS_RUN=str(seconds), TOLERANCE=tolerance, WRITE=str(folder))
    return subprocess.run(words, cwd=drivers.ROOT, env=settings, capture_output=True, text=True, check=True).stdout


def rapier(stones, seconds, iterations, folder):
    program = drivers.build_rapier()[0].with_name("pile")
    words = [program, folder / f"pile-{stones}.txt", str(seconds), f"iterations={iterations}"]
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout


def exponent(times):
    """The slope of log time over log stones, by least squares."""
    points = [(math.log(stones), math.log(time)) for stones, time in times]
    x, y = (sum(column) / len(points) for column in zip(*points))
    return sum((a - x) * (b - y) for a, b in points) / sum((a - x) ** 2 for a, _ in points)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("stones", nargs="*", type=int, default=[100, 300, 1000])
    parser.add_argument("--seconds", type=float, default=4)
    parser.add_argument("--tolerance", default="1e-4")
    given = parser.parse_args()
    print("| stones | program | us a step | at rest | over rapier | residual | penetration, m | kinetic, J | moves, m |")
    print("|---|---|---|---|---|---|---|---|---|")
    times = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for stones in given.stones:
            runs = {f"teeter, {given.tolerance}": teeter(stones, given.seconds, given.tolerance, folder)}
            for iterations in (4, 50):
                runs[f"rapier, {iterations} iterations"] = rapier(stones, given.seconds, iterations, folder)
            rows = {program: parts(text) for program, text in runs.items()}
            base = rows["rapier, 4 iterations"][-1][1]
            for program, run in rows.items():
                mean = sum(part[1] for part in run) / len(run)
                _, rest, residual, penetration, kinetic, moved = run[-1]
                times.setdefault(program, []).append((stones, mean, rest))
                numbers = f"{residual:.1e} | {penetration:.1e} | {kinetic:.1e} | {moved:.1e}"
                print(f"| {stones} | {program} | {mean:.0f} | {rest:.0f} | {rest / base:.2f} | {numbers} |", flush=True)
    if len(given.stones) > 1:
        for program, rows in times.items():
            whole, rest = (exponent([(row[0], row[k]) for row in rows]) for k in (1, 2))
            print(f"\n{program}: time a step grows as n^{whole:.2f}, at rest as n^{rest:.2f}")


if __name__ == "__main__":
    main()
