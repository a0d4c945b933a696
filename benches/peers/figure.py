"""A figure of fronts, as SVG: error over time, both axes logarithmic."""

import math
from html import escape

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 760, 470, 80, 190, 46, 56
COLOURS = {
    "teeter": "#0b6e99",
    "moreau-jean, tuned": "#5fb0d3",
    "siconos": "#c2410c",
    "mujoco": "#4d7c0f",
    "rapier": "#7e22ce",
}
MARKS = {"teeter": "circle", "moreau-jean, tuned": "circle", "siconos": "square", "mujoco": "diamond", "rapier": "triangle"}


def _mark(kind, x, y, colour, faint):
    style = f'fill="{"none" if faint else colour}" stroke="{colour}"'
    if kind == "square":
        return f'<rect x="{x - 3:.1f}" y="{y - 3:.1f}" width="6" height="6" {style}/>'
    if kind == "diamond":
        return f'<path d="M{x:.1f} {y - 4.5:.1f}l4.5 4.5l-4.5 4.5l-4.5 -4.5z" {style}/>'
    if kind == "triangle":
        return f'<path d="M{x:.1f} {y - 4:.1f}l4 7h-8z" {style}/>'
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.2" {style}/>'


def _decades(values):
    low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
    return low, max(high, low + 1)


def _power(exponent):
    return f'10<tspan dy="-5" font-size="9">{exponent}</tspan>'


def figure(title, series, fronts, names, x_label, y_label, floor=None):
    """`series`: key of a front → all its points (x, y); `fronts`: the same → those that are joined; `names`: the same → what to call it. `floor`: a level below which
    errors aren't known."""
    points = [p for many in series.values() for p in many] + ([(None, floor)] if floor else [])
    x0, x1 = _decades([x for x, _ in points if x])
    y0, y1 = _decades([y for _, y in points])

    def across(x):
        return LEFT + (math.log10(x) - x0) / (x1 - x0) * (WIDTH - LEFT - RIGHT)

    def down(y):
        return HEIGHT - BOTTOM - (math.log10(y) - y0) / (y1 - y0) * (HEIGHT - TOP - BOTTOM)

    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
        f'<text x="{LEFT}" y="24" font-size="15">{escape(title)}</text>',
    ]
    right, foot = WIDTH - RIGHT, HEIGHT - BOTTOM
    for k in range(x0, x1 + 1):
        x = across(10.0**k)
        out.append(
            f'<path d="M{x:.1f} {TOP}V{foot}" stroke="#ddd"/><text x="{x:.1f}" y="{foot + 18}" text-anchor="middle">{_power(k)}</text>'
        )
    for k in range(y0, y1 + 1):
        y = down(10.0**k)
        out.append(
            f'<path d="M{LEFT} {y:.1f}H{right}" stroke="#ddd"/><text x="{LEFT - 8}" y="{y + 4:.1f}" text-anchor="end">{_power(k)}</text>'
        )
    if floor:
        y = down(floor)
        out.append(
            f'<path d="M{LEFT} {y:.1f}H{right}" stroke="#666" stroke-dasharray="4 4"/>'
            f'<text x="{right + 12}" y="{y + 4:.1f}" fill="#666">uncertainty of</text>'
            f'<text x="{right + 12}" y="{y + 18:.1f}" fill="#666">the reference</text>'
        )
    for number, (name, many) in enumerate(series.items()):
        colour, kind = COLOURS[name], MARKS[name]
        line = " ".join(f"{across(x):.1f},{down(y):.1f}" for x, y in fronts[name])
        out.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="1.6"/>')
        out += [_mark(kind, across(x), down(y), colour, (x, y) not in fronts[name]) for x, y in many]
        y = TOP + 14 + 20 * number
        out.append(
            _mark(kind, right + 18, y - 4, colour, False)
            + f'<text x="{right + 30}" y="{y}">{escape(names[name])}</text>'
        )
    out.append(f'<text x="{(LEFT + right) / 2}" y="{HEIGHT - 14}" text-anchor="middle">{escape(x_label)}</text>')
    middle = (TOP + foot) / 2
    out.append(f'<text transform="translate(22 {middle}) rotate(-90)" text-anchor="middle">{escape(y_label)}</text>')
    return "\n".join([*out, "</svg>"]) + "\n"
