"""The page and the figures of a run of compare.py."""

import datetime
import math
import os
import platform
import subprocess
from pathlib import Path

import drivers
import figure
from front import cheapest, front

TITLES = {"teeter": "teeter", drivers.TUNED: drivers.TUNED, "siconos": "Siconos", "mujoco": "MuJoCo", "rapier": "rapier2d-f64"}
TARGETS = [1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4]
WANTED = {20: 50, 400: 500}  # elements → how many times faster than Siconos a step of ours is to be


def said(*words):
    """What a command prints, or why not."""
    try:
        return subprocess.run([str(w) for w in words], capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def table(head, rows):
    out = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    out += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    return out + [""]


def number(x, digits=3):
    return "–" if x is None or not math.isfinite(x) else f"{x:.{digits}g}"


def small(x):
    return "–" if x is None or not math.isfinite(x) else f"{x:.1e}"


def name_of(job):
    return (job.label or " ".join(job.settings)) + f", {job.step:g} s"


def by_series(rows):
    """The rows that tell something, by front: those that ran to their end and whose error is less than the release itself."""
    good = [row for row in rows if "failed" not in row and row["angle"] < 1]
    found = {name: [row for row in good if row["job"].series == name] for name in drivers.SERIES}
    return {name: many for name, many in found.items() if many}


def figures(tables, reference):
    out = {}
    for which, title in (
        ("ground", "Rocking block on rigid ground, 0.9 s"),
        ("beam", "Rocking block on the paper's beam, 20 elements, 0.2 s"),
    ):
        many = by_series(tables[which])
        series = {name: [(row["ms"], row["angle"]) for row in rows if row["angle"] > 0] for name, rows in many.items()}
        fronts = {name: [(row["ms"], row["angle"]) for row in front(rows) if row["angle"] > 0] for name, rows in many.items()}
        floor = uncertainty(reference) if which == "beam" else None
        out[which] = figure.figure(title, series, fronts, "CPU time of the run, ms", "largest error of φ, relative to the release", floor)
    return out


def uncertainty(reference):
    """How far our two schemes are from each other at the smallest step: what the reference is good for, at least."""
    return reference["apart"]["teeter", "moreau-jean", 1e-6]


def targets(rows):
    """For each accuracy the cheapest setting of each front, and how many times ours is faster than the best peer: by its defaults, and tuned."""
    fronts = by_series(rows)
    found = []
    for target in TARGETS:
        best = {name: cheapest(many, target) for name, many in fronts.items()}
        peers = [row["ms"] for name, row in best.items() if name in drivers.NAMES[1:] and row]
        ours = [best.get("teeter"), best.get(drivers.TUNED)]
        found.append((target, best, [min(peers) / mine["ms"] if peers and mine else None for mine in ours]))
    return found


def target_table(rows):
    names, found = list(by_series(rows)), targets(rows)
    lines = []
    for target, best, ratios in found:
        cells = [f"{number(best[p]['ms'])} ({name_of(best[p]['job'])})" if best[p] else "not reached" for p in names]
        lines.append([f"{target:g}", *cells, " / ".join(number(ratio, 2) for ratio in ratios)])
    return table(["angle error ≤", *[f"{TITLES[p]}, ms" for p in names], "best peer over teeter / tuned"], lines)


def front_table(rows, ground):
    lines = []
    for name, many in by_series(rows).items():
        for row in front(many):
            job = row["job"]
            extra = [small(row["peaks"]), small(row["impact"]), small(row["penetration"])] if ground else []
            lines.append([TITLES[name], f"{job.step:g}", job.label or " ".join(job.settings), number(row["us"]), number(row["ms"]), small(row["angle"]), *extra])
    extra = ["worst of six peaks", "first impact, s", "penetration, m"] if ground else []
    return table(["program", "step, s", "settings", "µs a step", "ms", "angle", *extra], lines)


def cost_rows(rows):
    """By number of elements: Siconos' µs a step, and ours by each setting."""
    found = {}
    for row in rows:
        if "failed" not in row:
            who = "siconos" if row["job"].program == "siconos" else row["job"].label
            found.setdefault(row["job"].elements, {})[who] = row
    return found


def cost_table(rows):
    found = cost_rows(rows)
    ours = ["moreau-jean", "moreau-jean-closed", "moreau-jean, modes", "moreau-jean-closed, modes"]
    lines = []
    for elements, many in sorted(found.items()):
        theirs = many.get("siconos")
        cells = [f"{number(theirs['us'])} ({number(1e3 * theirs['spread'][0] / theirs['job'].steps)} … {number(1e3 * theirs['spread'][1] / theirs['job'].steps)})" if theirs else "–"]
        for who in ours:
            mine = many[who]
            ratio = f" ({theirs['us'] / mine['us']:.0f} ×)" if theirs else ""
            cells.append(f"{number(mine['us'])}{ratio}")
        lines.append([elements, *cells])
    return table(["elements", "Siconos (least … most)", *ours], lines)


def verdict(rows):
    """The sentences of the aim: so many times a step of Siconos."""
    found, out = cost_rows(rows), []
    for elements, wanted in WANTED.items():
        many = found.get(elements, {})
        if "siconos" in many:
            ratio = many["siconos"]["us"] / many["moreau-jean"]["us"]
            reached = "reached" if ratio >= wanted else "**not reached**"
            out.append(f"- {elements} elements, the same scheme and the full model: {ratio:.0f} × Siconos (aim: {wanted} ×, {reached}).")
    return out


def who_leads(rows, which):
    """Where ours is the cheapest, and where not: from the targets, in words."""
    ahead, behind, alone = [], [], []
    for target, best, (ratio, _) in targets(rows):
        if best.get("teeter") and ratio is None:
            alone.append(f"{target:g}")
        elif ratio is not None and ratio >= 1:
            ahead.append(f"{target:g} ({ratio:.1f} ×)")
        else:
            peers = [(row["ms"], TITLES[name]) for name, row in best.items() if row and name in drivers.NAMES[1:]]
            if peers:
                behind.append(f"{target:g} ({min(peers)[1]}{f', {1 / ratio:.1f} ×' if ratio else ''})")
    out = [f"- {which}, cheapest for an angle error of: " + (", ".join(ahead) or "none") + "."]
    if alone:
        out.append(f"- {which}, the only one that gets there: " + ", ".join(alone) + ".")
    if behind:
        out.append(f"- {which}, behind at: " + ", ".join(behind) + ".")
    return out


def coarse(rows):
    """The best angle error of each program at each step of the ladder: what a step is worth, whatever it costs."""
    programs = by_series(rows)
    steps = sorted({row["job"].step for many in programs.values() for row in many}, reverse=True)
    lines = []
    for step in steps:
        best = {p: min((row["angle"] for row in many if row["job"].step == step), default=None) for p, many in programs.items()}
        lines.append([f"{step:g}", *[small(best[p]) for p in programs]])
    return table(["step, s", *[TITLES[p] for p in programs]], lines)


def reference_table(reference):
    rows = [[TITLES[program], label, f"{step:g}", small(value)] for (program, label, step), value in reference["apart"].items()]
    out = table(["program", "settings", "step, s", "from moreau-jean-closed at 1e-06 s"], rows)
    if reference["chains"] is not None:
        out += [f"The two chains of rigid links are {small(reference['chains'])} from each other: they agree on another motion than the beam's (see Why).", ""]
    return out


def about_table(about):
    version = "import mujoco; print(mujoco.__version__)"
    lock = Path(drivers.HERE / "rapier" / "Cargo.lock").read_text().split('name = "rapier2d-f64"\nversion = "')
    siconos = said("dpkg-query", "-W", "-f=${Version}", "libsiconos-kernel-dev")
    mujoco = said(about["mujoco"][0], "-c", version) if about.get("mujoco") else "not run"
    commit = said("git", "-C", drivers.ROOT, "rev-parse", "--short", "HEAD")
    return table(
        ["", ""],
        [
            ["date", datetime.datetime.now().strftime("%Y-%m-%d %H:%M")],
            ["machine", f"{cpu()}, {os.cpu_count()} cores, {platform.system()} {platform.release().split('-')[0]}"],
            ["load", f"{os.getloadavg()[0]:.2f} (mean of the last minute, when the run ended)"],
            ["pinned to", f"core {about['core']}; BLAS and OpenMP on one thread"],
            ["teeter", f"commit {commit}, {said('rustc', '--version')}"],
            ["Siconos", f"{siconos} (Debian package libsiconos-kernel-dev), g++ {said('g++', '-dumpfullversion')}, -O3 -DNDEBUG"],
            ["MuJoCo", f"{mujoco} (Python package mujoco)"],
            ["rapier2d-f64", f"{lock[1].split(chr(34))[0] if len(lock) > 1 else 'unknown'} (crate)"],
            ["command", f"`{about['command']}`"],
            ["took", f"{about['took']:.0f} s, without building"],
        ],
    )


def cpu():
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        return next(line.split(":")[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.machine()


WHY = """
- **Siconos** does the same step (Moreau–Jean, the same law), so it has the same error a step as our `moreau-jean`; what differs is the price: it
  builds its contact problem through graphs of shared objects and allocates in every step, and its beam is a dense matrix, n² a step
  where the band of a beam is n. Its sparse storage was tried on this scene (`sparse=1`) and is slower than the dense one up to 400 elements.
  Its Newton loop is off (`SICONOS_TS_LINEAR`), which gives the same motion in two thirds of the time.
- **MuJoCo**'s Runge–Kutta integrator is of fourth order between impacts: it has the smallest error *a step* at coarse steps on the ground. A contact is
  a spring and damper of some steps' length there, so an impact takes that long, and the error is of first order in the step as everybody's; a step costs four evaluations.
- **rapier** makes the cheapest step of the peers, but its integrator is semi-implicit Euler in every substep and its contacts are springs
  too: first order with a large factor. It is made for many bodies at once, which these scenes don't show: nothing here measures a crowd.
- **The beam by MuJoCo and rapier** is a chain of rigid links with springs in the hinges, the natural attempt. Three things keep it from this scene's
  answer. The links can't stretch, so the right end moves in when the beam sags; the paper's beam is linear and keeps its length in plan, which
  is worth some 3 % of φ at 0.05 s (`docs/theory.md` §8: at this sag the chain may even be the better physics, but it is another model). It has no
  beam element, so it needs many links where one cubic element does. And springs in hinges are integrated explicitly by MuJoCo
  (`implicitfast` treats only damping implicitly): past the stability limit of the stiffest mode, some 7e-5 s with 20 links, the run diverges,
  where Moreau–Jean with θ = 1/2 is stable at every step. Neither can model an elastic Euler–Bernoulli beam in contact as such.
- **What this doesn't say**: one block, one or two contacts. Nothing here is said of piles, of three dimensions, of parallel or batched runs (MuJoCo's and
  rapier's field), nor of friction-dominated motion. Every program got its best settings by a search on the ground's scene with hindsight (`--search`), ours the
  defaults.
"""


def page(tables, reference, about):
    name = about["name"]
    out = ["# teeter and its peers: accuracy against CPU time", ""]
    out += [
        "Two scenes by four programs in one run, in turn on one core. A time is the CPU time of the whole run, output off, set-up left out: the median of all turns.",
        "An angle error is the largest |φ − reference| at multiples of 10 ms, over the release's 5°. What is modelled and how it was measured: `benches/peers/README.md`;",
        f"every row, also those off the fronts: `{name}.csv`.",
        "",
    ]
    out += about_table(about)
    out += ["## In short", ""]
    out += who_leads(tables["ground"], "Rigid ground") + who_leads(tables["beam"], "The paper's beam") + verdict(tables["cost"])
    out += ["", "## Scene R: rigid ground, 0.9 s", ""]
    out += ["The reference is exact (Housner's block, `accuracy.py`); the angle's error is taken over the first five impacts, to 0.73 s.", ""]
    out += [f"![fronts on rigid ground]({name}-ground.svg)", ""]
    out += ["The cheapest way to each accuracy:", ""] + target_table(tables["ground"])
    out += ["The best angle error of each program with a step, whatever it costs:", ""] + coarse(tables["ground"])
    out += ["The fronts:", ""] + front_table(tables["ground"], True)
    out += ["## Scene B: the paper's beam, 0.2 s", ""]
    out += [
        "The reference is `moreau-jean-closed` at 1 µs on the same mesh. How far the others are from it, each with its own convention for where a contact is",
        "looked for; that Siconos comes ever closer says that both have the same limit:",
        "",
    ]
    out += reference_table(reference)
    out += [f"![fronts on the beam]({name}-beam.svg)", ""]
    out += ["The cheapest way to each accuracy:", ""] + target_table(tables["beam"])
    out += ["The best angle error of each program with a step:", ""] + coarse(tables["beam"])
    out += ["The fronts:", ""] + front_table(tables["beam"], False)
    failed = [row for row in tables["beam"] + tables["ground"] if "failed" in row]
    if failed:
        out += ["Runs that failed:", ""]
        out += table(["program", "scene", "run", "why"], [[TITLES[r["job"].program], r["job"].scene, name_of(r["job"]), r["failed"]] for r in failed])
    out += ["## The paper's beam: µs a step, by number of elements", ""]
    out += ["At 1e-4 s, from the release on; in brackets how many times faster than Siconos' step.", ""] + cost_table(tables["cost"])
    out += ["## Why", "", WHY.strip(), ""]
    return "\n".join(out)
