"""The settings with which each program is at its best: a grid of each, kept in settings.json. Ours runs by its defaults too, as users have it."""

import itertools
import json
import math
from pathlib import Path

import accuracy
from drivers import Job, Refused, middle
from front import thinned

KEPT = Path(__file__).resolve().parent / "settings.json"
GRIDS = {
    "teeter": {
        "time.theta": ["0.5", "0.51", "0.6", "1.0"],
        "time.activation_gamma": ["0.0", "0.25", "0.5", "1.0"],
        "time.gap_tolerance": ['"1e-12m"', '"1e-8m"', '"1e-6m"'],
    },
    "siconos": {
        "theta": ["0.5", "0.51", "0.6", "1"],
        "gamma": [None, "0", "0.5", "1"],
        "threshold": ["0", "1e-8", "1e-6"],
        "projection": ["0", "1"],
    },
    "mujoco": {
        "integrator": ["RK4", "implicitfast", "Euler"],
        "timeconst": ["2", "3", "5"],
        "dampratio": ["0.5", "1", "2"],
        "impedance": ["0.9", "0.99", "0.9999"],
        "impratio": ["1", "10", "100"],
        "feet": ["points", "box"],
    },
    "rapier": {
        "iterations": ["1", "2", "4", "8", "16", "32"],
        "sweeps": ["1", "4"],
        "stabilisation": ["0", "1"],
        "frequency": ["30", "1e3", "1e5", "1e7"],
        "damping": ["1", "10"],
        "unit": ["1", "0.01"],
        "recycle": ["0"],
        "bias": ["1"],
    },
}
# The whole grid at coarse steps; at a fine one only what was best at the step before it.
FULL, FINE, KEEP = [1e-2, 1e-3], [1e-4, 1e-5], 24


def combinations(grid):
    for values in itertools.product(*grid.values()):
        yield tuple(f"{key}={value}" for key, value in zip(grid, values) if value is not None)


def tried(driver, settings, step):
    """All settings at one step on the ground: dicts with `settings`, `ms`, `angle`."""
    found = []
    for words in settings:
        try:
            times, track = driver.run(Job(driver.name, "ground", 0, step, round(accuracy.END / step), words), 0.0)
        except Refused:
            continue
        angle = accuracy.housner_errors(track, step)["angle"]
        if math.isfinite(angle):
            found.append({"settings": words, "ms": 1e3 * middle(times), "angle": angle})
    return found


def search(drivers, names, say):
    """For each of these programs and each step the settings on its front, written to settings.json."""
    table = json.loads(KEPT.read_text()) if KEPT.exists() else {}
    for name in names:
        table[name], settings, good = {}, list(combinations(GRIDS[name])), []
        for step in FULL + FINE:
            found = tried(drivers[name], settings if step in FULL else good, step)
            best = thinned(found)
            table[name][f"{step:g}"] = [list(point["settings"]) for point in best]
            say(
                f"{name}, step {step:g}: {len(found)} settings ran, {len(best)} kept; angle error down to {best[-1]['angle']:.1e}"
            )
            accurate = sorted(found, key=lambda point: point["angle"])[:KEEP]
            good = list(dict.fromkeys(point["settings"] for point in best + accurate))
    KEPT.write_text(json.dumps(table, indent=1) + "\n")


def kept(name, step):
    """The settings kept for the step nearest to this one, in the scale of powers."""
    table = json.loads(KEPT.read_text())[name]
    nearest = min(table, key=lambda known: abs(math.log(float(known) / step)))
    return [tuple(words) for words in table[nearest]]
