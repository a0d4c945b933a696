"""Siconos' solvers on one problem: which tolerance of its own each needs for the judge, and how long it then takes.

The protocol is that of `../shared/problems/README.md`: default options but for tolerance and iteration cap, from r = 0.
"""

from dataclasses import dataclass, replace
from math import nan

from programs import Crash, middle

PLANE = ["NSGS", "LEMKE", "CPG", "ENUM"]
SPACE = ["NSGS", "NSN_AC", "ADMM", "PROX", "VI_EG"]
NO_CAP = 100_000_000
SLOW = {"PROX", "VI_EG"}  # half the time limit: they would take most of the whole run
ENUM_CONTACTS = 6  # 2^n and more states
OTHER_STORAGE_CONTACTS = 100  # from 225 on, W in blocks is several times faster than dense with every solver
DENSE_CONTACTS = 3000  # LEMKE and CPG take W dense: 5 GB for the largest problem


def solvers(dimension, contacts, storage):
    """Their names; "NSGS dense" is NSGS with W given dense where the rule (at least half of it filled) gives it in blocks."""
    names = PLANE if dimension == 2 else SPACE
    if contacts > ENUM_CONTACTS:
        names = [n for n in names if n != "ENUM"]
    if contacts > DENSE_CONTACTS:
        names = [n for n in names if n not in ("LEMKE", "CPG")]
    if storage == "blocks" and contacts <= OTHER_STORAGE_CONTACTS:
        names = names + [f"{n} dense" for n in (["NSGS"] if dimension == 2 else SPACE)]
    return names


def by_the_rule(solver):
    return " " not in solver


@dataclass
class Settled:
    """A solver's result at one tolerance of the judge, and the settings that give it."""

    solver: str
    tolerance: float
    outcome: str  # "solved", or why not
    residual: float = nan
    iterations: int | None = None
    time_ms: float = nan
    runs: int = 0
    own_tolerance: float | None = None
    cap: int = 0
    info: int | None = None
    note: str = ""

    @property
    def solved(self):
        return self.outcome == "solved"


class Protocol:
    def __init__(self, driver, runs, budget, limit):
        self.driver, self.runs, self.budget, self.limit = driver, runs, budget, limit

    def limit_of(self, solver):
        return self.limit / 2 if solver.split()[0] in SLOW else self.limit

    def drive(self, problem, solver, own, cap, runs=None, limit=None):
        return self.driver.solve(
            problem, solver, own, cap, runs or self.runs, self.budget, limit or self.limit_of(solver)
        )

    def settle(self, problem, solver, tolerances):
        """All tolerances, the loosest first. Slow failures aren't repeated at tighter ones."""
        results, given_up = [], None
        for tolerance in sorted(tolerances, reverse=True):
            if given_up:
                results.append(Settled(solver, tolerance, f"not run ({given_up} at a looser tolerance)"))
                continue
            result = self.at(problem, solver, tolerance)
            results.append(result)
            if not result.solved and not result.time_ms <= 400 * self.limit_of(solver):
                given_up = result.outcome
        for k in reversed(
            range(len(results) - 1)
        ):  # what passes with the run made for a tighter tolerance counts with it
            tighter = results[k + 1]
            if not results[k].solved and tighter.solved:
                results[k] = replace(
                    tighter, tolerance=results[k].tolerance, note=f"by the run made for {tighter.tolerance:g}"
                )
        return results

    def at(self, problem, solver, tolerance):
        """Where the solver's criterion is met but not the judge's, its own tolerance is divided by 10, up to 3 times."""
        cap = 0 if solver == "ENUM" else NO_CAP
        result = None
        for step in range(4):
            own = tolerance / 10**step
            try:
                answer = self.drive(problem, solver, own, cap)
            except Crash as crash:
                return result if result and step else Settled(solver, tolerance, f"crash ({crash})", own_tolerance=own)
            result = self.read(solver, tolerance, own, cap, answer)
            if answer["ended"] == "timeout" or answer["info"] != 0:
                return self.smallest_cap(problem, result) if result.solved and solver != "ENUM" else result
            if result.solved:
                return result
        return result

    @staticmethod
    def read(solver, tolerance, own, cap, answer):
        passed = answer["residual"] <= tolerance
        if passed:
            outcome = "solved"
        elif answer["ended"] == "timeout":
            outcome = "time limit"
        else:
            outcome = "own criterion met, judge not" if answer["info"] == 0 else "own criterion not met"
        return Settled(
            solver,
            tolerance,
            outcome,
            answer["residual"],
            answer["iterations"],
            middle(answer["times_ms"]),
            len(answer["times_ms"]),
            own,
            cap,
            answer["info"],
        )

    def smallest_cap(self, problem, result):
        """The judge is content though the solver isn't: the time of the smallest cap (1, 2, 4, …) that contents it."""
        cap = 1
        while cap < NO_CAP:
            try:
                answer = self.drive(problem, result.solver, result.own_tolerance, cap)
            except Crash:
                break
            if answer["ended"] == "timeout":
                break
            if answer["residual"] <= result.tolerance:
                found = self.read(result.solver, result.tolerance, result.own_tolerance, cap, answer)
                return replace(found, note="own criterion never met; smallest cap of a ladder of 2 that passes")
            cap *= 2
        return replace(result, note="own criterion never met")


def from_row(row):
    """Settings kept by an earlier run: of this program, or the list beside the published problems."""
    solved = row.get("outcome", "") == "solved" or row.get("solved") == "1"
    if not solved or not row.get("solver_tolerance"):
        return None
    # Where its own criterion was never met, the iterations that contented the judge are the cap.
    status = row.get("status", "")
    never_met = "smallest iteration cap" in status or "own criterion not met" in status
    cap = row.get("cap") or (row["iterations"] if never_met and row["iterations"] != "0" else "")
    default = 0 if row["solver"] == "ENUM" else NO_CAP
    return Settled(
        row["solver"],
        float(row["tolerance"]),
        "solved",
        own_tolerance=float(row["solver_tolerance"]),
        cap=int(float(cap)) if cap else default,
        time_ms=float(row["time_ms"]),
    )
