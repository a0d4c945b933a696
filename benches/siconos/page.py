"""The comparison in figures, and the Markdown page of it."""

import datetime
import math
import platform
import subprocess
from collections import defaultdict
from pathlib import Path

from siconos import by_the_rule


def solved(row):
    return row["outcome"] == "solved"


def geometric_mean(values):
    values = [v for v in values if v > 0]
    return math.exp(sum(map(math.log, values)) / len(values)) if values else math.nan


def by_problem(rows, tolerance):
    """(file, contacts) → {(program, solver): row}."""
    table = defaultdict(dict)
    for row in rows:
        if row["tolerance"] == tolerance:
            table[row["file"], row["contacts"]][row["program"], row["solver"]] = row
    return table


def virtual_best(entries, any_storage=False):
    """Siconos' fastest solver that solved, or none; by the rule for the storage of W, or by the better storage."""
    found = [
        row
        for (program, solver), row in entries.items()
        if program == "siconos" and solved(row) and (any_storage or by_the_rule(solver))
    ]
    return min(found, key=lambda r: r["time_ms"], default=None)


class AgainstBest:
    """`auto` against Siconos' virtual best at one tolerance, over the problems above so many contacts.

    The share counts every problem that either solves: one that only `auto` solves is won, one that it fails is lost.
    The mean is over those that both solve."""

    def __init__(self, rows, tolerance, above, any_storage=False):
        self.ratios, self.lost, self.missed, self.extra, self.neither = [], [], [], [], []
        for (file, contacts), entries in sorted(by_problem(rows, tolerance).items(), key=lambda e: e[0][1]):
            mine, best = entries.get(("teeter", "auto")), virtual_best(entries, any_storage)
            if mine is None or contacts <= above:
                continue
            if best and solved(mine):
                ratio = best["time_ms"] / mine["time_ms"]
                self.ratios.append(ratio)
                if ratio <= 1:
                    self.lost.append((file, contacts, mine, best, ratio))
            elif best:
                self.missed.append((file, contacts, mine, best))
            elif solved(mine):
                self.extra.append((file, contacts, mine))
            else:
                self.neither.append((file, contacts, mine))

    @property
    def count(self):
        return len(self.ratios) + len(self.missed) + len(self.extra)

    @property
    def faster(self):
        return len(self.ratios) - len(self.lost) + len(self.extra)

    @property
    def share(self):
        return 100 * self.faster / self.count if self.count else math.nan

    @property
    def mean(self):
        return geometric_mean(self.ratios)


class Pair:
    """One of ours against Siconos' of the same name: ratio over the problems that both solve."""

    def __init__(self, rows, tolerance, ours, theirs):
        self.ratios, self.slower, self.only_ours, self.only_theirs = [], [], [], []
        for (file, contacts), entries in by_problem(rows, tolerance).items():
            a, b = entries.get(("teeter", ours)), entries.get(("siconos", theirs))
            if a is None or b is None:
                continue
            if solved(a) and solved(b):
                ratio = b["time_ms"] / a["time_ms"]
                self.ratios.append(ratio)
                if ratio < 1 / 1.1:
                    self.slower.append((file, contacts, a, b, ratio))
            elif solved(a):
                self.only_ours.append(file)
            elif solved(b):
                self.only_theirs.append(file)


def summary(rows, tolerances):
    lines = []
    for tolerance in tolerances:
        s = AgainstBest(rows, tolerance, 10)
        if s.count:
            lines.append(
                f"{tolerance:g}, above 10 contacts: auto faster on {s.faster} of {s.count} ({s.share:.0f} %), "
                f"{s.mean:.2f}x in geometric mean; Siconos solves and auto doesn't: {len(s.missed)}"
            )
            any_storage = AgainstBest(rows, tolerance, 10, any_storage=True)
            if any_storage.ratios != s.ratios:
                lines.append(f"    with the better storage: {any_storage.share:.0f} %, {any_storage.mean:.2f}x")
        for file, _, mine, best, ratio in s.lost:
            lines.append(
                f"    loses {file}: {mine['used']} {ms(mine)} against {best['solver']} {ms(best)} (x{ratio:.2f})"
            )
        for file, _, mine, best in s.missed:
            lines.append(
                f"    misses {file}: {mine['outcome']} at {number(mine['residual'])}; {best['solver']} {ms(best)}"
            )
    return "\n".join(lines)


def ms(row):
    return f"{row['time_ms']:.3g} ms"


def number(value):
    return f"{value:.2g}"


def machine(core, command, teeter, seconds, previous):
    def said(*words):
        try:
            return subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout.strip()
        except OSError:
            return ""

    cpu = next(
        (line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")),
        platform.machine(),
    )
    cores = said("nproc")
    siconos = said("dpkg-query", "-W", "-f", "${Version}", "libsiconos-numerics7") or "unknown"
    about = [
        ("date", f"{datetime.datetime.now():%Y-%m-%d %H:%M}"),
        ("machine", f"{cpu}, {cores} cores, {platform.system()} {platform.release()}"),
        ("load", f"{open('/proc/loadavg').read().split()[0]} (mean of the last minute, when the run ended)"),
        ("pinned to", f"core {core}; BLAS and OpenMP on one thread"),
        ("Siconos", f"{siconos} (Debian package libsiconos-numerics7), default options, r = 0"),
        ("command", " ".join(command)),
        ("took", f"{seconds:.0f} s"),
    ]
    if teeter:
        about.insert(
            5,
            (
                "teeter",
                f"{said(str(teeter.path), '--version')}, commit {said('git', 'rev-parse', '--short', 'HEAD')}, "
                f"{said('rustc', '--version')}",
            ),
        )
    if previous:
        about.append(
            (
                "Siconos' solvers and settings",
                f"the fastest by {Path(previous).name} only: the counts of single Siconos solvers below say nothing",
            )
        )
    return about


def table(head, rows):
    if not rows:
        return ["none", ""]
    return [
        "| " + " | ".join(head) + " |",
        "|" + "---|" * len(head),
        *("| " + " | ".join(map(str, r)) + " |" for r in rows),
        "",
    ]


def against_best(rows, tolerances, any_storage):
    lines = []
    for above in (10, 0):
        for t in tolerances:
            s = AgainstBest(rows, t, above, any_storage)
            if s.count:
                what = f"above {above} contacts" if above else "all"
                faster = f"{s.faster} of {s.count} ({s.share:.0f} %)"
                lines.append([what, f"{t:g}", faster, f"{s.mean:.2f}", len(s.missed), len(s.extra), len(s.neither)])
    head = ["problems", "tolerance", "faster on", "geometric mean of the ratio"]
    out = table(head + ["only Siconos solves", "only auto solves", "nobody solves"], lines)
    lists = [
        ("Slower than Siconos' best", "lost"),
        ("Solved by a Siconos solver, not by auto", "missed"),
        ("Solved by auto, by no Siconos solver", "extra"),
        ("Solved by nobody", "neither"),
    ]
    head = ["problem", "contacts", "tolerance", "auto used", "outcome", "residual", "time", "Siconos' best", "ratio"]
    for title, what in lists[:1] if any_storage else lists:
        lines = []
        for t in tolerances:
            for file, contacts, mine, *rest in getattr(AgainstBest(rows, t, 0, any_storage), what):
                best = f"{rest[0]['solver']} {ms(rest[0])}" if rest else ""
                ratio = f"{rest[1]:.2f}" if len(rest) > 1 else ""
                outcome = [mine["used"], mine["outcome"], number(mine["residual"]), ms(mine)]
                lines.append([file, contacts, f"{t:g}", *outcome, best, ratio])
        out += [f"### {title}", ""] + table(head, lines)
    return out


def page(rows, tolerances, pairs, about, name):
    out = [
        "# teeter and Siconos on the same problems",
        "",
        "Both ran in turn on one core, problem by problem; every answer was judged by the same formula, computed apart",
        f"from both programs. All rows are in `{name}.csv`. How it was measured: `benches/siconos/README.md`. A ratio is",
        "Siconos' time over ours: above 1 we are faster.",
        "",
    ]
    out += table(["", ""], about)

    out += ["## Solved", ""]
    programs = sorted(
        {(r["program"], r["solver"]) for r in rows}, key=lambda p: (p[0] == "siconos", p[1] != "auto", p[1])
    )
    counts = []
    for dimension in sorted({r["dimension"] for r in rows}):
        here = [r for r in rows if r["dimension"] == dimension]
        for program, solver in programs:
            own = [r for r in here if (r["program"], r["solver"]) == (program, solver)]
            if own:
                counts.append(
                    [f"{dimension}D", program, solver]
                    + [
                        f"{sum(solved(r) for r in own if r['tolerance'] == t)} / {sum(r['tolerance'] == t for r in own)}"
                        for t in tolerances
                    ]
                )
        union = [by_problem(here, t) for t in tolerances]
        counts.append(
            [f"{dimension}D", "siconos", "any of them"]
            + [f"{sum(virtual_best(e) is not None for e in u.values())} / {len(u)}" for u in union]
        )
    out += table(["", "program", "solver", *(f"{t:g}" for t in tolerances)], counts)

    out += ["## `auto` against the best Siconos solver of each problem", ""]
    out += [
        "The best one is chosen per problem and tolerance, after the fact. Faster: of all problems that either solves.",
        "",
    ]
    out += against_best(rows, tolerances, any_storage=False)
    if any(r["program"] == "siconos" and not by_the_rule(r["solver"]) for r in rows):
        out += ["## The same, with the storage of W that suits Siconos best", ""]
        out += [
            "Above, Siconos is given W dense where at least half of it is filled, else in blocks. Here the faster of"
        ]
        out += ["the two counts, chosen after the fact as well.", ""]
        out += against_best(rows, tolerances, any_storage=True)

    out += ["## Methods of the same name", "", "Over the problems that both solve. Slower: by more than 10 %.", ""]
    found = [(t, a, b, Pair(rows, t, a, b)) for a, b, _ in pairs for t in tolerances]
    found = [f for f in found if f[3].ratios or f[3].only_ours or f[3].only_theirs]
    out += table(
        [
            "ours",
            "Siconos",
            "tolerance",
            "both solve",
            "geometric mean of the ratio",
            "slower on",
            "only ours solves",
            "only theirs solves",
        ],
        [
            [
                a,
                b,
                f"{t:g}",
                len(p.ratios),
                f"{geometric_mean(p.ratios):.2f}",
                len(p.slower),
                len(p.only_ours),
                len(p.only_theirs),
            ]
            for t, a, b, p in found
        ],
    )
    out += ["### Where ours is slower", ""]
    out += table(
        ["ours", "tolerance", "problem", "contacts", "time", "Siconos", "ratio"],
        [
            [a, f"{t:g}", file, contacts, ms(mine), ms(theirs), f"{ratio:.2f}"]
            for t, a, _, p in found
            for file, contacts, mine, theirs, ratio in p.slower
        ],
    )

    claims = [r for r in rows if r["program"] == "teeter" and r["note"]] if any("note" in r for r in rows) else []
    out += ["## Where the program and the judge disagree", ""]
    out += table(
        ["solver", "problem", "tolerance", "outcome", "judged", "program"],
        [
            [r["solver"], r["file"], f"{r['tolerance']:g}", r["outcome"], number(r["residual"]), r["note"]]
            for r in claims
        ],
    )
    return "\n".join(out).rstrip() + "\n"
