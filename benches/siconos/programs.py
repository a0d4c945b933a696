"""How the two programs are run: one process a measurement, pinned to one core, BLAS on one thread."""

import json
import os
import shutil
import subprocess
from pathlib import Path
from statistics import median

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent

ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", MKL_NUM_THREADS="1")


class Crash(Exception):
    """The process ended otherwise than it should: by a signal, without a result, past every limit."""


def target_directory():
    return Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))


class Place:
    """Where both programs run: one core, and before the machine's other work if asked."""

    def __init__(self, core, ahead):
        self.prefix = ["taskset", "-c", str(core)] if shutil.which("taskset") else []
        self.prefix += ["nice", "-n", "-15"] if ahead else []


def run(command, place, patience):
    """Standard output of a command; a crash where it was killed or said nothing."""
    try:
        done = subprocess.run(
            place.prefix + [str(c) for c in command],
            env=ENVIRONMENT,
            timeout=patience,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
    except subprocess.TimeoutExpired:
        raise Crash(f"killed after {patience:.0f} s") from None
    if done.returncode != 0 or not done.stdout.strip():
        last = done.stderr.strip().splitlines()[-1:] or ["no output"]
        raise Crash(f"exit code {done.returncode}: {last[0].split(', but ')[0][:80]}")
    return done.stdout


class Driver:
    """The C++ driver beside this file, which calls Siconos' numerics and judges."""

    def __init__(self, place, clock="wall"):
        self.place, self.clock = (
            place,
            clock,
        )  # "wall": elapsed, as teeter says it; "cpu": CPU time, where Siconos runs alone
        self.path = target_directory() / "siconos" / "driver"

    def build(self):
        """Compiles it where the source is newer."""
        source = HERE / "driver.cpp"
        if self.path.exists() and self.path.stat().st_mtime > source.stat().st_mtime:
            return
        self.path.parent.mkdir(parents=True, exist_ok=True)
        flags = subprocess.run(
            ["pkg-config", "--cflags", "--libs", "fclib", "hdf5"], check=True, stdout=subprocess.PIPE, text=True
        ).stdout.split()
        include = "/usr/include/siconos"
        subprocess.run(
            [
                "g++",
                "-std=c++17",
                "-O2",
                "-Wall",
                str(source),
                f"-I{include}",
                f"-I{include}/numerics",
                "-o",
                str(self.path),
                "-lsiconos_numerics",
                *flags,
            ],
            check=True,
        )

    def describe(self, problem):
        """Dimension, number of contacts, and how Siconos is given W: "dense" or "blocks"."""
        dimension, contacts, storage = run([self.path, "describe", problem], self.place, 60).split()
        return int(dimension), int(contacts), storage

    def judge(self, problem, impulses):
        return float(run([self.path, "judge", problem, impulses], self.place, 60))

    def solve(self, problem, solver, own_tolerance, cap, runs, budget, limit):
        """One process: `runs` solves of a problem loaded anew each time, fewer once `budget` seconds are spent."""
        patience = 60 + 20 * (limit + budget)  # elapsed, on a machine that may be busy; the limit itself is of CPU time
        line = run(
            [self.path, "solve", problem, solver, repr(own_tolerance), cap, runs, budget, limit], self.place, patience
        )
        answer = json.loads(line)
        answer["times_ms"] = answer["cpu_ms"] if answer["ended"] == "timeout" else answer[f"{self.clock}_ms"]
        if answer["residual"] is None:
            answer["residual"] = float("nan")
        return answer


class Teeter:
    """`teeter solve --json`, judged by the driver."""

    def __init__(self, place, driver, path=None):
        self.place, self.driver = place, driver
        self.path = Path(path) if path else target_directory() / "release" / "teeter"
        self.given = path is not None

    def build(self):
        if not self.given:
            subprocess.run(["cargo", "build", "--release", "--quiet", "--locked", "-p", "teeter"], cwd=ROOT, check=True)

    def solvers(self):
        """The names it knows, so that a pair isn't tried where there is none."""
        lines = run([self.path, "solvers"], self.place, 60).splitlines()
        return {line.split()[0] for line in lines[1:] if line.strip()}

    def solve(self, problem, solver, tolerance, limit, solutions):
        """One process, which repeats a short solve by itself and says the median. The judge is the driver."""
        command = [self.path, "solve", problem, "--json", "--solver", solver, "--tolerance", repr(tolerance)]
        command += ["--time-limit", f"{limit:g} s", "--solutions", solutions]
        impulses = Path(solutions) / f"{Path(problem).stem}.{solver}.csv"
        impulses.unlink(missing_ok=True)
        answer = json.loads(run(command, self.place, 60 + 20 * limit))
        answer["own_residual"] = answer["residual"]
        answer["residual"] = self.driver.judge(problem, impulses)
        return answer


def middle(times):
    """The median; of two or more the first is left out, for it runs on cold caches and pages."""
    return median(times[1:] if len(times) > 2 else times)
