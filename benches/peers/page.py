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

TITLES = {
    "teeter": "teeter",
    drivers.TUNED: drivers.TUNED,
    "siconos": "Siconos",
    "mujoco": "MuJoCo",
    "rapier": "rapier2d-f64",
}
TARGETS = [0.5, 0.3, 1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5, 1e-6]
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
        fronts = {
            name: [(row["ms"], row["angle"]) for row in front(rows) if row["angle"] > 0] for name, rows in many.items()
        }
        floor = reference["uncertainty"] if which == "beam" else None
        out[which] = figure.figure(
            title,
            series,
            fronts,
            TITLES,
            "CPU time of the run, ms",
            "largest error of φ, relative to the release",
            floor,
        )
    return out


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
        cells = [f"{number(best[p]['ms'])} ({best[p]['job'].step:g})" if best[p] else "not reached" for p in names]
        lines.append(
            [
                f"{target:g}",
                *cells,
                " / ".join(number(ratio, 2) for ratio in (ratios if drivers.TUNED in names else ratios[:1])),
            ]
        )
    last = "best peer over teeter" + (" / tuned" if drivers.TUNED in names else "")
    return table(["angle error ≤", *[f"{TITLES[p]}, ms (step, s)" for p in names], last], lines)


def front_table(rows, ground):
    lines = []
    for name, many in by_series(rows).items():
        for row in front(many):
            job = row["job"]
            extra = [small(row["peaks"]), small(row["impact"]), small(row["penetration"])] if ground else []
            lines.append(
                [
                    TITLES[name],
                    f"{job.step:g}",
                    job.label or " ".join(job.settings),
                    number(row["us"]),
                    number(row["ms"]),
                    small(row["angle"]),
                    *extra,
                ]
            )
    extra = ["worst of six peaks", "first impact, s", "penetration, m"] if ground else []
    return table(["program", "step, s", "settings", "µs a step", "ms", "angle", *extra], lines)


FULL, MODES = ("siconos", "full"), ("siconos", "20 modes")
# Our settings, and Siconos' beam that each is compared with.
OURS = {
    ("teeter", scheme + model): peer
    for model, peer in (("", FULL), (", modes", MODES))
    for scheme in ("moreau-jean", "moreau-jean-closed", "moreau-jean-located")
}


def cost_rows(rows):
    """By number of elements: the row of each program and setting."""
    found = {}
    for row in rows:
        if "failed" not in row:
            found.setdefault(row["job"].elements, {})[row["job"].program, row["job"].label] = row
    return found


def cost_table(rows):
    lines = []
    for elements, many in sorted(cost_rows(rows).items()):
        cells = []
        for who in (FULL, MODES):
            least, most = (1e3 * ms / many[who]["job"].steps for ms in many[who]["spread"]) if who in many else (0, 0)
            cells.append(f"{number(many[who]['us'])} ({number(least)} … {number(most)})" if who in many else "–")
        for who, peer in OURS.items():
            ratio = f" ({many[peer]['us'] / many[who]['us']:.0f} ×)" if peer in many else ""
            cells.append(number(many[who]["us"]) + ratio)
        lines.append([elements, *cells])
    head = ["elements", "Siconos (least … most)", "Siconos, 20 modes (least … most)", *[label for _, label in OURS]]
    return table(head, lines)


def verdict(rows):
    """The sentences of the aim: so many times a step of Siconos."""
    found, out = cost_rows(rows), []
    for elements, wanted in WANTED.items():
        many = found.get(elements, {})
        if FULL in many:
            ratio = many[FULL]["us"] / many["teeter", "moreau-jean"]["us"]
            reached = "reached" if ratio >= wanted else "**not reached**"
            said = f"{ratio:.0f} × Siconos (aim: {wanted} ×, {reached})"
            out.append(f"- A step with {elements} elements, the same scheme and the full model: {said}.")
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
        best = {
            p: min((row["angle"] for row in many if row["job"].step == step), default=None)
            for p, many in programs.items()
        }
        lines.append([f"{step:g}", *[small(best[p]) for p in programs]])
    return table(["step, s", *[TITLES[p] for p in programs]], lines)


def reference_table(reference):
    rows = [
        [TITLES[program], label, f"{step:g}", small(value)]
        for (program, label, step), value in reference["apart"].items()
    ]
    out = table(["program", "settings", "step, s", "from the reference"], rows)
    if reference["chains"] is not None:
        out += [
            f"The two chains of rigid links are {small(reference['chains'])} from each other: they agree on another motion than the beam's (see Why).",
            "",
        ]
    return out


def versions(commands):
    """What ran, by program."""
    lock = (drivers.HERE / "rapier" / "Cargo.lock").read_text().split('name = "rapier2d-f64"\nversion = "')
    found = {
        "teeter": f"commit {said('git', '-C', drivers.ROOT, 'describe', '--always', '--dirty')}, {said('rustc', '--version')}",
        "siconos": f"{said('dpkg-query', '-W', '-f=${Version}', 'libsiconos-kernel-dev')} (Debian package "
        f"libsiconos-kernel-dev), g++ {said('g++', '-dumpfullversion')}, -O3 -DNDEBUG",
        "rapier": f"{lock[1].split(chr(34))[0]} (crate), default features",
    }
    if "mujoco" in commands:
        version = said(commands["mujoco"][0], "-c", "import mujoco; print(mujoco.__version__)")
        found["mujoco"] = f"{version} (Python package mujoco)"
    return [[TITLES[name], found[name] if name in commands else "not run"] for name in drivers.NAMES]


def about_table(about):
    return table(
        ["", ""],
        [
            ["date", datetime.datetime.now().strftime("%Y-%m-%d %H:%M")],
            ["machine", f"{cpu()}, {os.cpu_count()} cores, {platform.system()} {platform.release().split('-')[0]}"],
            ["load", f"{os.getloadavg()[0]:.2f} (mean of the last minute, when the run ended)"],
            ["pinned to", f"core {about['core']}; BLAS and OpenMP on one thread"],
            *versions(about["commands"]),
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
- **On the ground teeter locates impacts**, and is of second order through them; every peer is of first order there, MuJoCo's Runge–Kutta integrator (fourth order between impacts) too, as its
  impacts are a spring and damper over some steps. So the lead grows with the accuracy, and 1e-3 is beyond the peers at the steps tried.
- **Where teeter isn't ahead: penetration on the ground.** rapier's tuned contacts leave some 1e-15 m from 1e-4 s on; ours leave 2e-10 m there by default (1e-15 m with `moreau-jean-projected`, at another scheme's accuracy).
- **"moreau-jean, tuned"** is the scheme that Siconos has, too, with θ, activation and tolerance searched as those of the peers: what remains is what the program costs.
- **Siconos** does the same step (Moreau–Jean, the same law), with the Jacobian at another predicted place: with its defaults about our error on the ground, more
  on the beam, both of first order. What differs is the price: it builds each step's contact problem through graphs of shared objects and
  allocates, and its beam is a dense matrix, n² a step where the band of a beam is n. Its sparse storage (`sparse=1`) was tried on this scene and is slower than
  the dense one up to 400 elements. Who puts the beam into its lowest modes beforehand (`modes=20`, sines here) is rid of
  the n²: then a step costs what so many dofs cost, and the ratio at 400 elements is that of our modes to it. Its Newton loop is off (`SICONOS_TS_LINEAR`), which gives the same motion in two thirds of the time.
- **rapier** is among the cheapest of the peers a step, and as accurate as any at 1e-2 s; its integrator is semi-implicit Euler in every substep,
  so accuracy comes in proportion to substeps. It is made for many bodies at once, which these scenes don't show.
- **The beam by MuJoCo and rapier** is a chain of rigid links with springs in the hinges, the natural attempt; neither has an elastic Euler–Bernoulli beam. Both chains
  agree with each other and stay 5 % from the beam however small the step: links can't stretch, so the right end moves in as the beam sags, where
  the paper's linear beam keeps its length in plan (`docs/theory.md` §8 puts that at 3 % of φ at 0.05 s). At such a sag the chain may be the better physics, but it
  is another model than the scene's. For an error over that, rapier's chain is cheap: its hinge springs are implicit and it is stable at 1e-3 s.
  MuJoCo integrates springs explicitly (`implicitfast` treats only damping implicitly), so with 20 links Runge–Kutta diverges from 1e-4 s on, `implicitfast`
  from 5e-5 s.
- **Luck.** After impacts the error falls irregularly with the step, for every program: one run in a ladder may be ten times better than its neighbours, and a front
  takes it. At 1e-2 s, ten to twenty steps from impact to impact, little else is left. Ratios at one accuracy may be off by a factor of two or three for that alone; the picture and the ladder tables say more than one row.
- **What this doesn't say**: one block, one or two contacts. Nothing here is said of piles, of three dimensions, of parallel or batched runs (MuJoCo's and
  rapier's field), nor of motion ruled by friction. The peers' settings, and those of "moreau-jean, tuned", were searched on the ground's scene with hindsight.
"""


def failed_table(rows):
    """The runs that failed: a row for each setting, with all steps at which it did."""
    found = {}
    for row in rows:
        if "failed" in row:
            job = row["job"]
            key = TITLES[job.program], job.scene, job.label or " ".join(job.settings), row["failed"]
            found.setdefault(key, []).append(f"{job.step:g}")
    lines = [[*key[:3], ", ".join(steps), key[3]] for key, steps in found.items()]
    head = ["program", "scene", "settings", "steps, s", "why"]
    return ["Runs that failed:", "", *table(head, lines)] if lines else []


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
    out += (
        who_leads(tables["ground"], "Rigid ground")
        + who_leads(tables["beam"], "The paper's beam")
        + verdict(tables["cost"])
    )
    out += ["", "## Scene R: rigid ground, 0.9 s", ""]
    out += [
        "The reference is exact (Housner's block, `accuracy.py`); the angle's error is taken over the first five impacts, to 0.73 s.",
        "",
    ]
    out += [f"![fronts on rigid ground]({name}-ground.svg)", ""]
    out += ["The cheapest way to each accuracy:", ""] + target_table(tables["ground"])
    out += ["The best angle error of each program with a step, whatever it costs:", ""] + coarse(tables["ground"])
    out += ["The fronts:", ""] + front_table(tables["ground"], True)
    out += ["## Scene B: the paper's beam, 0.2 s", ""]
    out += [
        "The reference is `event-driven` on the same mesh, which locates every closure; what it is good for is its distance from our fixed steps of 0.5 µs and from",
        "Siconos, which predicts contacts at another place; that it comes ever closer says that all have the same limit:",
        "",
    ]
    out += reference_table(reference)
    out += [f"![fronts on the beam]({name}-beam.svg)", ""]
    out += ["The cheapest way to each accuracy:", ""] + target_table(tables["beam"])
    out += ["The best angle error of each program with a step:", ""] + coarse(tables["beam"])
    out += ["The fronts:", ""] + front_table(tables["beam"], False)
    out += failed_table(tables["ground"] + tables["beam"])
    out += ["## The paper's beam: µs a step, by number of elements", ""]
    out += [
        "At 1e-4 s, from the release on; in brackets how many times faster than Siconos' step, ours in modes over Siconos' in modes.",
        "",
    ] + cost_table(tables["cost"])
    out += ["## Why", "", WHY.strip(), ""]
    return "\n".join(out)
