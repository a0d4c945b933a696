"""The four programs as servers: a job a line in, an answer a line out (README.md). One core, BLAS on one thread."""

import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import accuracy

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", MKL_NUM_THREADS="1")
NAMES = ["teeter", "siconos", "mujoco", "rapier"]
TUNED = "moreau-jean, tuned"  # ours by the scheme that Siconos has, too, with settings searched as the peers' are
SERIES = ["teeter", TUNED, *NAMES[1:]]


@dataclass(frozen=True)
class Job:
    """One way to compute a scene: the settings are the driver's own KEY=VALUE words, after `label` for people."""

    program: str
    scene: str
    elements: int
    step: float
    steps: int
    settings: tuple = ()
    label: str = ""
    tuned: bool = False

    @property
    def series(self):
        """The front that it belongs to: the program, ours by its defaults apart from ours tuned."""
        return TUNED if self.tuned and self.program == "teeter" else self.program

    def line(self, budget, file):
        words = [self.scene, self.elements, repr(self.step), self.steps, budget, file, *self.settings]
        return " ".join(str(word) for word in words) + "\n"


class Refused(Exception):
    """The driver said that a job failed, or died of it."""


def middle(times):
    """The median; of more than two the first is left out, for it runs on cold caches and pages."""
    return median(times[1:] if len(times) > 2 else times)


def target_directory():
    return Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))


def _cargo(*words, cwd=ROOT):
    subprocess.run(["cargo", "build", "--release", "--quiet", "--locked", *words], cwd=cwd, check=True)


def build_teeter():
    _cargo("-p", "teeter-benches", "--example", "peers_teeter")
    return [target_directory() / "release" / "examples" / "peers_teeter"]


def build_rapier():
    _cargo("--target-dir", HERE / "rapier" / "target", cwd=HERE / "rapier")
    return [HERE / "rapier" / "target" / "release" / "peers-rapier"]


def build_siconos():
    sources = [HERE / "siconos.cpp", ROOT / "benches" / "siconos" / "beam" / "scene.hpp"]
    path = target_directory() / "siconos" / "peers"
    if not path.exists() or any(path.stat().st_mtime < source.stat().st_mtime for source in sources):
        path.parent.mkdir(parents=True, exist_ok=True)
        include = "/usr/include/siconos"
        folders = [f"-I{include}", f"-I{include}/kernel", f"-I{include}/numerics"]
        # -DNDEBUG: without it every access to a matrix of Siconos' linear algebra is checked.
        flags = ["-std=c++17", "-O3", "-DNDEBUG", "-Wall"]
        libraries = ["-lsiconos_kernel", "-lsiconos_numerics"]
        subprocess.run(["g++", *flags, str(sources[0]), *folders, "-o", str(path), *libraries], check=True)
    return [path]


def mujoco_python(given=None):
    """A Python that has MuJoCo: the one given, this one, or that of an environment made for it beside the build."""
    if given:
        return given
    if subprocess.run([sys.executable, "-c", "import mujoco"], capture_output=True, check=False).returncode == 0:
        return sys.executable
    place = target_directory() / "mujoco"
    python = place / "bin" / "python"
    if not python.exists():
        subprocess.run([sys.executable, "-m", "venv", place], check=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", "mujoco==4.0.0"], check=True)
    return python


def command(name, python=None):
    """Builds what is needed, and says how to start the driver."""
    if name == "mujoco":
        return [mujoco_python(python), HERE / "mujoco_driver.py"]
    return {"teeter": build_teeter, "siconos": build_siconos, "rapier": build_rapier}[name]()


class Driver:
    """A running driver; it is started again where a job killed it."""

    def __init__(self, name, words, core, patience=600):
        pin = ["taskset", "-c", str(core)] if shutil.which("taskset") else []
        self.name, self.words, self.patience = name, pin + [str(word) for word in words], patience
        self.folder = tempfile.TemporaryDirectory()
        self.process = None

    def _start(self):
        self.process = subprocess.Popen(
            self.words,
            env=ENVIRONMENT,
            cwd=self.folder.name,  # MuJoCo writes a log where it is
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )

    def stop(self):
        if self.process:
            self.process.kill()
            self.process.wait()
            self.process.stdin.close()
            self.process.stdout.close()
            self.process = None

    def run(self, job, budget):
        """CPU seconds of each repetition, and the track."""
        if self.process is None:
            self._start()
        file = Path(self.folder.name) / "track"
        try:
            self.process.stdin.write(job.line(budget, file))
            self.process.stdin.flush()
            ready, _, _ = select.select([self.process.stdout], [], [], self.patience)
            line = self.process.stdout.readline() if ready else ""
        except BrokenPipeError:
            line, ready = "", True
        if not line:
            self.stop()
            raise Refused("died" if ready else f"took over {self.patience} s")
        answer = json.loads(line)
        if "error" in answer:
            raise Refused(answer["error"].splitlines()[0][:120])
        return answer["cpu_s"], accuracy.load(file)
