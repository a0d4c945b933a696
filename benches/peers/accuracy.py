"""What a motion is worth: a track of (X, Y, φ) a step against the exact rocking block, or against a finer track."""

import math
from array import array
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

WIDTH, HEIGHT, GRAVITY, TILT = 0.03, 0.135, 9.81, math.radians(5)
ALPHA = math.atan2(WIDTH, HEIGHT)
RADIUS = 0.5 * math.hypot(WIDTH, HEIGHT)
RESTITUTION = 1 - 1.5 * math.sin(ALPHA) ** 2  # of the angular velocity, at an impact

SAMPLE = 0.01  # s; all steps of the ladder divide it
END = 0.9  # s: past the sixth impact, so that six peaks are complete
FIRST_FIVE = 0.73  # s: the last sample before the fifth impact, at 0.7394 s


@dataclass
class Exact:
    """Housner's block without slip and bounce (docs/theory.md §9): (4/3) R φ̈ = −g sin(α − φ) for φ > 0, mirrored for φ < 0."""

    samples: list  # φ at every SAMPLE, the first at 0
    impacts: list
    peaks: list


def _accelerate(phi, side):
    return -side * GRAVITY * math.sin(ALPHA - side * phi) / (4 / 3 * RADIUS)


def _advance(phi, omega, h, side):
    """One step of the classical Runge–Kutta method."""
    k1 = omega, _accelerate(phi, side)
    k2 = omega + h / 2 * k1[1], _accelerate(phi + h / 2 * k1[0], side)
    k3 = omega + h / 2 * k2[1], _accelerate(phi + h / 2 * k2[0], side)
    k4 = omega + h * k3[1], _accelerate(phi + h * k3[0], side)
    return tuple(x + h / 6 * (a + 2 * b + 2 * c + d) for x, a, b, c, d in zip((phi, omega), k1, k2, k3, k4))


def _root(function, low, high):
    """Where a function changes its sign, by bisection to the last bit."""
    below = function(low) > 0
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if (function(middle) > 0) == below else (low, middle)
    return 0.5 * (low + high)


@cache
def exact(per_sample=100):
    """The exact motion up to END: Runge–Kutta steps of SAMPLE/per_sample, cut at impacts; 1e-4 s are good to 1e-13."""
    h = SAMPLE / per_sample
    phi, omega, side = TILT, 0.0, 1
    samples, impacts, peaks = [phi], [], [TILT]
    for step in range(round(END / SAMPLE) * per_sample):
        start, left = (phi, omega, side), h
        after = _advance(phi, omega, left, side)
        if side * phi > 0 > side * after[0]:
            part = _root(lambda t, at=start: _advance(*at[:2], t, at[2])[0], 0.0, h)
            omega = RESTITUTION * _advance(phi, omega, part, side)[1]
            impacts.append(step * h + part)
            phi, left, side = 0.0, h - part, -side
            after = _advance(phi, omega, left, side)
        elif omega * after[1] < 0:
            part = _root(lambda t, at=start: _advance(*at[:2], t, at[2])[1], 0.0, h)
            peaks.append(_advance(phi, omega, part, side)[0])
        phi, omega = after
        if (step + 1) % per_sample == 0:
            samples.append(phi)
    return Exact(samples, impacts, peaks)


def load(path):
    """A track that a driver left: three columns."""
    values = array("d")
    with open(path, "rb") as file:
        values.frombytes(file.read())
    return values[0::3], values[1::3], values[2::3]


def crossings(phi, step):
    """When φ passes zero, linear between steps."""
    return [(k + a / (a - b)) * step for k, (a, b) in enumerate(pairwise(phi)) if a != 0 and (a > 0) != (b > 0)]


def peaks(phi):
    """The largest |φ| between two crossings, with its sign; the first is the release, an unfinished one at the end is left out."""
    found, best = [], phi[0]
    for a, b in pairwise(phi):
        if a != 0 and (a > 0) != (b > 0):
            found.append(best)
            best = b
        elif abs(b) > abs(best):
            best = b
    return found


def penetration(y, phi):
    """The deepest place of a lower corner under y = 0, m."""
    deepest = 0.0
    for height, angle in zip(y, phi):
        deepest = max(deepest, abs(math.sin(angle)) * WIDTH / 2 + math.cos(angle) * HEIGHT / 2 - height)
    return deepest


def angle_error(phi, step, samples, until):
    """The largest |φ − φ_reference| at multiples of SAMPLE up to a time, relative to the release."""
    every, last = round(SAMPLE / step), round(until / SAMPLE)
    return max(abs(phi[k * every] - samples[k]) for k in range(1, last + 1)) / TILT


def housner_errors(track, step):
    """Errors of a track on the ground: angle, worst of six peaks (relative), first impact (s), deepest penetration (m)."""
    _, y, phi = track
    truth, when, tops = exact(), crossings(phi, step), peaks(phi)
    worst = math.nan
    if len(tops) >= 6:
        worst = max(abs(a - b) / abs(b) for a, b in zip(tops[:6], truth.peaks))
    return {
        "angle": angle_error(phi, step, truth.samples, FIRST_FIVE),
        "peaks": worst,
        "impact": abs(when[0] - truth.impacts[0]) if when else math.nan,
        "penetration": penetration(y, phi),
    }
