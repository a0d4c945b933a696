#!/usr/bin/env python3
"""A step of the source paper's scene by Siconos' kernel with a dense beam, and by teeter, in turn. README.md says how to read it."""

import argparse
import datetime
import json
import os
import platform
import subprocess
import sys
import time
from pathlib import Path
from statistics import median

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE.parent.parent)]
from folders import writable_folder  # noqa: E402
from programs import ROOT, Place, run, target_directory  # noqa: E402

WARM = 10  # steps before the clock starts: pages, caches, the factorisation
# Steps of 1e-4 s that are timed, by scene: a rocking block until 0.101 s, where the motions are compared; a free beam is the same in every step.
STEPS = {"rocking": 1000, "free": 200}
# How far the motions may differ. Of the rocking block: in φ, degrees, 1e-3 of its tilt; the two programs predict the contact at other places
# (theory.md §5), which makes a difference of first order in the step. Of the free beam, in w, m, of 1e-3: the same scheme and mesh, so rounding, which a thousand dofs magnify.
BOUNDS = {"rocking": ("phi", 5e-3), "free": ("w", 1e-9)}


class Program:
    """A program that prints a line of JSON; a turn of it is `repeats` processes."""

    def __init__(self, name, path, repeats):
        self.name, self.path, self.repeats = name, path, repeats

    def measure(self, scene, elements, place):
        command = [self.path, scene, elements, STEPS[scene], WARM]
        return [json.loads(run(command, place, 600)) for _ in range(self.repeats)]


def build_theirs():
    source, path = HERE / "theirs.cpp", target_directory() / "siconos" / "beam"
    newest = max(file.stat().st_mtime for file in (source, HERE / "scene.hpp"))
    if not path.exists() or path.stat().st_mtime < newest:
        path.parent.mkdir(parents=True, exist_ok=True)
        include = "/usr/include/siconos"
        folders = [f"-I{include}", f"-I{include}/kernel", f"-I{include}/numerics"]
        libraries = ["-lsiconos_kernel", "-lsiconos_numerics"]
        # -DNDEBUG: without it every access to a matrix of Siconos' linear algebra is checked.
        flags = ["-std=c++17", "-O3", "-DNDEBUG", "-Wall"]
        subprocess.run(["g++", *flags, str(source), *folders, "-o", str(path), *libraries], check=True)
    return path


def build_ours():
    command = ["cargo", "build", "--release", "--quiet", "--locked", "-p", "teeter-benches", "--example", "siconos_beam"]
    subprocess.run(command, cwd=ROOT, check=True)
    return target_directory() / "release" / "examples" / "siconos_beam"


def compare(scene, elements, programs, turns, place):
    """One row: all times of both programs, and where their motions got to."""
    answers = {program.name: [] for program in programs}
    for _ in range(turns):
        for program in programs:
            answers[program.name] += program.measure(scene, elements, place)
    times = {name: sorted(answer["us"] for answer in found) for name, found in answers.items()}
    quantity, bound = BOUNDS[scene]
    ends = {name: found[-1][quantity] for name, found in answers.items()}
    apart = abs(ends["siconos"] - ends["teeter"])
    return {"scene": scene, "elements": elements, "times": times, "ends": ends, "apart": apart, "agree": apart <= bound}


def cells(row):
    def spread(times):
        return f"{median(times):.4g} ({times[0]:.4g} … {times[-1]:.4g}; {len(times)})"

    theirs, ours = row["times"]["siconos"], row["times"]["teeter"]
    ends = [f"{row['ends'][name]:.8g}" for name in ("siconos", "teeter")]
    ratio = f"{median(theirs) / median(ours):.0f}"
    return [str(row["elements"]), spread(theirs), spread(ours), ratio, *ends, f"{row['apart']:.1e}" + ("" if row["agree"] else " **NO**")]


def said(*words):
    done = subprocess.run(words, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    return done.stdout.strip() or "unknown"


def page(rows, core, command, seconds):
    lines = Path("/proc/cpuinfo").read_text().splitlines() if Path("/proc/cpuinfo").exists() else []
    cpu = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), platform.machine())
    text = [
        "# The source paper's scene: a step of teeter, and of Siconos with a dense beam",
        "",
        "Both ran in turn on one core. µs a step: the median of all processes (least … most; how many). A ratio is Siconos' time over",
        "ours. What is modelled and how it was measured: `benches/siconos/beam/README.md`.",
        "",
        "|  |  |",
        "|---|---|",
        f"| date | {datetime.datetime.now():%Y-%m-%d %H:%M} |",
        f"| machine | {cpu}, {os.cpu_count()} cores, {platform.system()} {platform.release()} |",
        f"| load | {os.getloadavg()[0]:.2f} (mean of the last minute, when the run ended) |",
        f"| pinned to | core {core}; BLAS and OpenMP on one thread |",
        f"| Siconos | {said('dpkg-query', '-W', '-f', '${Version}', 'libsiconos-kernel7')} (Debian package libsiconos-kernel7) |",
        f"| BLAS | {said('readlink', '-f', '/etc/alternatives/libblas.so.3-x86_64-linux-gnu')} |",
        f"| teeter | commit {said('git', 'rev-parse', '--short', 'HEAD')}, {said('rustc', '--version')} |",
        f"| command | {command} |",
        f"| took | {seconds:.0f} s |",
    ]
    titles = {
        "rocking": ("The block rocks on the beam, until 0.101 s", "φ, deg"),
        "free": ("The beam alone, in its first mode", "w at midspan, m"),
    }
    for scene in dict.fromkeys(row["scene"] for row in rows):
        title, quantity = titles[scene]
        text += ["", f"## {title}", ""]
        head = ["elements", "Siconos, µs a step", "teeter, µs a step", "ratio", f"{quantity}: Siconos", "teeter", "apart"]
        text += ["| " + " | ".join(head) + " |", "|" + "---:|" * len(head)]
        text += ["| " + " | ".join(cells(row)) + " |" for row in rows if row["scene"] == scene]
    bounds = ", ".join(f"{scene}: {bound:g} in {quantity}" for scene, (quantity, bound) in BOUNDS.items())
    return "\n".join([*text, "", f"The motions have to agree, or the run fails ({bounds}).", ""])


def arguments():
    parse = argparse.ArgumentParser(description=__doc__)
    parse.add_argument("--elements", default="10,20,40,100,400")
    parse.add_argument("--scenes", default="rocking,free")
    parse.add_argument("--turns", type=int, default=3, help="how often the programs take turns")
    parse.add_argument("--repeats", type=int, default=9, help="processes of ours in a turn, for they are short; Siconos has one")
    parse.add_argument("--core", type=int, default=0, help="the core that everything runs on")
    parse.add_argument("--ahead", action="store_true", help="run both before the machine's other work (root only: nice -15)")
    parse.add_argument("--out", type=writable_folder, default=str(HERE.parent.parent / "results"), help="folder for the page")
    parse.add_argument("--name", default=f"siconos-beam-{datetime.date.today()}", help="stem of the page")
    return parse.parse_args()


def main():
    args = arguments()
    place = Place(args.core, args.ahead)
    programs = [Program("siconos", build_theirs(), 1), Program("teeter", build_ours(), args.repeats)]
    begin, rows = time.time(), []
    for scene in args.scenes.split(","):
        for elements in map(int, args.elements.split(",")):
            rows.append(compare(scene, elements, programs, args.turns, place))
            print(scene, *cells(rows[-1]), sep="  ", flush=True)
    path = args.out / f"{args.name}.md"
    command = " ".join(["compare.py", *sys.argv[1:]])
    path.write_text(page(rows, args.core, command, time.time() - begin))
    print(f"written to {path}")
    sys.exit(0 if all(row["agree"] for row in rows) else "the motions differ")


if __name__ == "__main__":
    main()
