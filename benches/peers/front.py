"""Pareto fronts: of points (time, error), those that nothing else beats in both."""

import math


def front(points, time="ms", error="angle"):
    """The points in order of time, each more accurate than all cheaper ones; those without a number are left out."""
    found, best = [], math.inf
    for point in sorted((p for p in points if math.isfinite(p[error])), key=lambda p: (p[time], p[error])):
        if point[error] < best:
            found.append(point)
            best = point[error]
    return found


def cheapest(points, target, time="ms", error="angle"):
    """The cheapest point with an error of at most `target`; None where there is none."""
    good = [p for p in points if p[error] <= target]
    return min(good, key=lambda p: p[time]) if good else None


def thinned(points, gain=1.1, time="ms", error="angle"):
    """A front without the points that are hardly better than the one before: what a search keeps."""
    kept = []
    for point in front(points, time, error):
        if not kept or kept[-1][error] >= gain * point[error]:
            kept.append(point)
    return kept
