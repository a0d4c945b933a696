"""Stacks of boxes in teeter, Siconos and rapier, in one run: time a step, and how far the top box moves.

    python3 benches/peers/stacks.py [BOXES ...]       # 10 20 50 by default; minutes

Boxes of 0.1 m and 700 kg/m^3, exactly on each other, mu 0.5, 1 ms, 1 s; once all equal, once the top one 1000 times
heavier. teeter and rapier run with their defaults, Siconos with its Moreau-Jean scheme, theta 0.5 and each of its
plane solvers that serves at 1e-10. Times are CPU time on one core, the median of three turns.
"""

import sys
from statistics import median

import drivers
from drivers import Driver, Job, Refused, middle

STEP, STEPS = 1e-3, 1000
KINDS = [
    ("teeter", ()),
    ("siconos", ("solver=NSGS",)),
    ("siconos", ("solver=NSGS", "tolerance=1e-6")),
    ("siconos", ("solver=LEMKE",)),
    ("rapier", ()),
    ("rapier", ("iterations=50",)),
]


def measure(servers, job, turns):
    times, track = [], None
    for _ in range(turns):
        spent, track = servers[job.program].run(job, 0.5)
        times.append(middle(spent))
        if times[-1] > 5:
            break
    moved = max(abs(place - row[0]) for row in track[:2] for place in row)
    return median(times) / STEPS, moved


def main():
    counts = [int(word) for word in sys.argv[1:]] or [10, 20, 50]
    names = sorted({name for name, _ in KINDS})
    servers = {name: Driver(name, drivers.command(name), 1, patience=240) for name in names}
    print("| boxes | top | program | settings | us a step | over teeter | top box moves, m |")
    print("|---|---|---|---|---|---|---|")
    for boxes in counts:
        for top in (1, 1000):
            own = None
            for name, settings in KINDS:
                job = Job(name, "stack", boxes, STEP, STEPS, (*settings, f"top={top}"))
                try:
                    time, moved = measure(servers, job, 3)
                except Refused as why:
                    print(f"| {boxes} | {top} | {name} | {' '.join(settings)} | {why} | | |", flush=True)
                    continue
                own = own or time
                row = f"{1e6 * time:.1f} | {time / own:.1f} | {moved:.1e}"
                print(f"| {boxes} | {top} | {name} | {' '.join(settings)} | {row} |", flush=True)
    for server in servers.values():
        server.stop()


if __name__ == "__main__":
    main()
