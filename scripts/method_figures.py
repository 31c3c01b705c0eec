#!/usr/bin/env python3
"""Draws the figures of docs/method.md.

    scripts/method_figures.py        writes docs/pictures/method/*.svg; the same bytes in every run

Curves, cells, contact points, rounds and colours are computed here, from the formulas of the section that a figure belongs to.
"""
import math
import re
from pathlib import Path

PICTURES = Path(__file__).resolve().parent.parent / "docs/pictures/method"
WIDTH = 720
PAPER, EDGE, INK, GREY, FAINT = "#fcfcfd", "#d0d7de", "#1f2933", "#66727f", "#cdd4db"
BLUE, ORANGE, GREEN, PURPLE, RED = "#2368a8", "#c8620a", "#1d7f58", "#7a4aa3", "#b3261e"
PALE = {BLUE: "#dce9f5", ORANGE: "#fbe5cf", GREEN: "#d8efe4", PURPLE: "#e9dff3", RED: "#f8dcd9", GREY: "#eceff2"}


def number(x):
    text = f"{x:.1f}"
    text = text[:-2] if text.endswith(".0") else text
    return "0" if text == "-0" else text


def along(a, b, share):
    return tuple(p + share * (q - p) for p, q in zip(a, b))


class Figure:
    """An SVG; y points down."""

    def __init__(self, name, height, title):
        self.name, self.height, self.parts = name, height, [f"<title>{title}</title>"]
        self.rect(0.5, 0.5, WIDTH - 1, height - 1, fill=PAPER, stroke=EDGE, width=1, rx=10)

    def shape(self, tag, places, fill="none", stroke=None, width=1.5, dash=None, opacity=None):
        words = [f'{key}="{value if isinstance(value, str) else number(value)}"' for key, value in places.items()]
        words.append(f'fill="{fill}"')
        if stroke:
            words.append(f'stroke="{stroke}" stroke-width="{number(width)}"')
        if dash:
            words.append(f'stroke-dasharray="{dash}"')
        if opacity:
            words.append(f'opacity="{opacity}"')
        self.parts.append(f"<{tag} {' '.join(words)}/>")

    def line(self, *points, stroke=INK, closed=False, **style):
        """A polygon if closed."""
        way = "M" + " ".join(f"{number(x)},{number(y)}" for x, y in points) + ("Z" if closed else "")
        self.shape("path", {"d": way}, stroke=stroke, **style)

    def rect(self, x, y, w, h, rx=0, **style):
        self.shape("rect", {"x": x, "y": y, "width": w, "height": h, "rx": rx}, **style)

    def disc(self, x, y, r, fill=INK, **style):
        self.shape("circle", {"cx": x, "cy": y, "r": r}, fill=fill, **style)

    def arrow(self, a, b, stroke=INK, width=2, head=9, both=False, **style):
        length = math.dist(a, b)
        inner = [along(a, b, 0.7 * head / length) if both else a, along(b, a, 0.7 * head / length)]
        self.line(*inner, stroke=stroke, width=width, **style)
        for tip, tail in ([(b, a), (a, b)] if both else [(b, a)]):
            foot = along(tip, tail, head / length)
            side = ((tail[1] - tip[1]) / length * 0.38 * head, (tip[0] - tail[0]) / length * 0.38 * head)
            wings = [(foot[0] + sign * side[0], foot[1] + sign * side[1]) for sign in (1, -1)]
            self.line(tip, *wings, closed=True, fill=stroke, stroke=None)

    def text(self, x, y, *rows, color=INK, size=13, anchor="start", bold=False, leading=17):
        """Rows of words, in which _m is a subscript and ^+ a superscript, or _{...} and ^{...}."""
        style = f'font-size="{size}" fill="{color}"'
        style += (f' text-anchor="{anchor}"' if anchor != "start" else "") + (' font-weight="bold"' if bold else "")
        for k, row in enumerate(rows):
            row = row.replace("&", "&amp;").replace("<", "&lt;")
            self.parts.append(f'<text x="{number(x)}" y="{number(y + k * leading)}" {style}>{raised(row)}</text>')

    def note(self, x, y, *rows, **style):
        self.text(x, y, *rows, color=GREY, **style)

    def save(self):
        head = (f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{self.height}" viewBox="0 0 {WIDTH} {self.height}" '
                'font-family="sans-serif" role="img">')
        (PICTURES / f"{self.name}.svg").write_text("\n".join([head, *self.parts, "</svg>"]) + "\n", encoding="utf-8")


def raised(row):
    """What follows _ or ^ in small letters, lower or higher; what comes next is back on the line."""
    words, back = "", 0
    for part in re.split(r"([_^](?:\{[^}]*\}|.))", row):
        shift = {"_": 4, "^": -5}.get(part[:1], 0) if len(part) > 1 else 0
        if shift:
            words += f'<tspan dy="{shift + back}" font-size="10">{part[1:].strip("{}")}</tspan>'
            back = -shift
        elif part:
            words += f'<tspan dy="{back}">{part}</tspan>' if back else part
            back = 0
    return words


def samples(f, begin, end, count):
    return [f(begin + (end - begin) * k / count) for k in range(count + 1)]


# 1. Time stepping

def time_stepping():
    fig = Figure("time_stepping", 452, "One substep: half a free flight, impulses at the midpoint, half a free flight")
    fig.text(24, 32, "Free flight: three substeps", bold=True, size=14)
    start, velocity, gravity, substeps = (46, 300), (112, -172), 112, 3  # in px and substeps

    def parabola(t):
        return start[0] + velocity[0] * t, start[1] + velocity[1] * t + gravity * t * t / 2

    fig.line(*samples(parabola, 0, substeps, 36), stroke=FAINT, width=7)
    for k in range(substeps):
        x, after = parabola(k), parabola(k + 1)
        v = (velocity[0], velocity[1] + gravity * k)
        x_m = (x[0] + v[0] / 2, x[1] + v[1] / 2)
        fig.line(x, x_m, stroke=BLUE, width=2.5)
        fig.line(x_m, after, stroke=GREEN, width=2.5)
        if k == 1:
            straight = (x[0] + v[0], x[1] + v[1])
            fig.line(x_m, straight, stroke=BLUE, dash="4 4")
            fig.arrow(straight, along(straight, after, 0.93), stroke=ORANGE)
            fig.text(straight[0] + 8, straight[1] + 6, "(h/2) h a", color=ORANGE)
            fig.text(x[0] - 8, x[1] - 6, "x", anchor="end")
            fig.text(x_m[0], x_m[1] - 12, "x_m", anchor="middle")
            fig.text(after[0] - 8, after[1] + 18, "x^+", anchor="end")
        fig.disc(*x_m, 4.5, fill=PAPER, stroke=INK)
        for end in (x, after):
            fig.disc(*end, 5)
    fig.note(62, 338, "All places x lie on one parabola (grey).", "The two halves of a substep are its tangents at",
             "both ends, and they meet at x_m.")

    fig.line((432, 20), (432, 376), stroke=EDGE, width=1)
    fig.text(448, 32, "A contact: impulses act at x_m", bold=True, size=14)
    floor, radius = 214, 26
    x, x_m, after = (480, 96), (552, floor - radius), (610, floor - radius)
    fig.line((448, floor), (700, floor), stroke=INK, width=2)
    for k in range(16):
        fig.line((452 + 16 * k, floor + 9), (461 + 16 * k, floor), stroke=FAINT)
    for place, color in ((x, BLUE), (after, GREEN), (x_m, INK)):
        fig.disc(*place, radius, fill=PALE.get(color, PAPER), stroke=color, opacity="0.85")
    fig.arrow(x, x_m, stroke=BLUE, width=2.5)
    fig.arrow(x_m, after, stroke=GREEN, width=2.5)
    fig.disc(*x, 4)
    fig.disc(*x_m, 4, fill=PAPER, stroke=INK)
    fig.disc(*after, 4)
    fig.text(x[0] - 34, x[1] - 14, "x", anchor="middle")
    fig.text(x_m[0] - 32, x_m[1] + 8, "x_m", anchor="end")
    fig.text(after[0] + 32, after[1] + 4, "x^+")
    at, v, kick = (462, 258), tuple(q - p for p, q in zip(x, x_m)), 28  # velocities, times h/2
    v_end = (at[0] + v[0], at[1] + v[1])
    kicked = (v_end[0], v_end[1] + kick)
    sum_end = (at[0] + after[0] - x_m[0], at[1])
    fig.arrow(at, v_end, stroke=BLUE)
    fig.arrow(v_end, kicked, stroke=ORANGE)
    fig.arrow(kicked, sum_end, stroke=RED)
    fig.arrow(at, sum_end, stroke=GREEN)
    fig.text(at[0] + 20, at[1] + 66, "v", color=BLUE, anchor="middle")
    fig.text(v_end[0] + 8, v_end[1] + 24, "h a", color=ORANGE)
    fig.text(sum_end[0] + 16, sum_end[1] + 50, "M^{-1} Σ p", color=RED)
    fig.text(sum_end[0] + 8, sum_end[1] + 1, "v^+ along the floor", color=GREEN)

    fig.line((16, 390), (704, 390), stroke=EDGE, width=1)
    for k, (formula, words, color) in enumerate((("x_m = x + (h/2) v", "half a flight to the midpoint", BLUE),
                                                 ("v^+ = v + h a + M^{-1} Σ p", "gravity and impulses at x_m", RED),
                                                 ("x^+ = x_m + (h/2) v^+", "half a flight to the end", GREEN))):
        middle = 128 + 232 * k
        fig.text(middle, 414, formula, anchor="middle", color=color, size=15)
        fig.note(middle, 435, words, anchor="middle")
    fig.save()


# 1a. Prescribed paths

def rate_between(before, time_before, after, time_after):
    """Fritsch and Butland's weighted harmonic mean of two rates, or 0 where they differ in sign."""
    if before * after <= 0:
        return 0.0
    share = (time_before + 2 * time_after) / (3 * (time_before + time_after))
    return before * after / (share * after + (1 - share) * before)


def keyframe_path(keys):
    """The place as a function of time: cubic between keyframes (time, place), at rest at the first and the last."""
    chord = [(b[1] - a[1]) / (b[0] - a[0]) for a, b in zip(keys, keys[1:])]
    length = [b[0] - a[0] for a, b in zip(keys, keys[1:])]
    rates = [0.0] + [rate_between(chord[k], length[k], chord[k + 1], length[k + 1]) for k in range(len(chord) - 1)] + [0.0]

    def place(t):
        k = max(i for i in range(len(chord)) if keys[i][0] <= t)
        u = (t - keys[k][0]) / length[k]
        step = keys[k + 1][1] - keys[k][1]
        return keys[k][1] + u * u * (3 - 2 * u) * step + length[k] * u * (1 - u) * ((1 - u) * rates[k] - u * rates[k + 1])
    return place


def prescribed_paths():
    fig = Figure("prescribed_paths", 556, "Prescribed paths, gravity that turns, servos")
    fig.line((360, 16), (360, 540), stroke=EDGE, width=1)
    fig.line((16, 294), (704, 294), stroke=EDGE, width=1)

    fig.text(24, 32, "Keyframes: a smooth, monotone path", bold=True, size=14)
    keys = [(0, 0.0), (1, 0.25), (2, 1.3), (3.1, 1.55), (4.2, 0.8), (5, 0.8)]
    place = keyframe_path(keys)
    screen = lambda t, y: (48 + 56 * t, 190 - 76 * y)
    fig.line((48, 52), (48, 206), (342, 206), stroke=GREY, width=1)
    fig.note(340, 222, "time", anchor="end")
    fig.note(54, 62, "place")
    fig.line(*(screen(*key) for key in keys), stroke=GREY, dash="3 4", width=1)
    fig.line(*samples(lambda t: screen(t, place(t)), 0, 4.9999, 60), stroke=BLUE, width=2.5)
    for key in keys:
        fig.disc(*screen(*key), 5, fill=ORANGE)
    top = screen(*keys[3])
    fig.text(top[0], top[1] - 12, "rate 0 where it turns round", color=ORANGE, anchor="middle")
    fig.text(58, 222, "at rest", color=ORANGE)
    fig.text(screen(*keys[5])[0] + 8, screen(*keys[5])[1] + 22, "at rest", color=ORANGE, anchor="end")
    fig.note(24, 250, "The path goes through all keyframes (dots), and", "between two of them goes beyond neither.")

    fig.text(376, 32, "In a substep: a straight line", bold=True, size=14)
    begin, h, bend = 396, 140, 0.0048
    path = lambda x: (x, 200 - 1.06 * (x - begin) + bend / 2 * (x - begin) ** 2)
    slope = lambda x: -1.06 + bend * (x - begin)
    for k in range(3):
        fig.line((begin + k * h, 56), (begin + k * h, 214), stroke=FAINT, width=1)
    fig.line(*samples(path, begin, begin + 2 * h, 40), stroke=BLUE, width=2.5)
    for k in range(2):
        x_m = begin + (k + 0.5) * h
        ends = [(x, path(x_m)[1] + slope(x_m) * (x - x_m)) for x in (x_m - h / 2, x_m + h / 2)]
        fig.line(*ends, stroke=ORANGE, width=2)
        fig.disc(*path(x_m), 4.5, fill=PAPER, stroke=INK)
        fig.note(x_m, 230, f"substep {k + 1}", anchor="middle")
    joint, line_there = path(begin + h), (begin + h, path(begin + h)[1] + bend * h * h / 8)
    fig.arrow(joint, line_there, both=True, head=5, width=1.2)
    fig.text(joint[0] + 8, joint[1] + 22, "off by V' h^2 / 8")
    fig.text(404, 74, "path", color=BLUE)
    fig.text(404, 92, "line in the substep", color=ORANGE)
    fig.note(376, 250, "Lines touch the path at midpoints (circles).", "Both are off by as much where they meet, so",
             "that nothing jumps.", leading=16)

    fig.text(24, 320, "Gravity that turns", bold=True, size=14)
    wave = lambda x: (x, 418 - 54 * math.sin(2 * math.pi * (x - 48) / 300))
    fig.line((48, 418), (348, 418), stroke=GREY, width=1)
    fig.line((48, 336), (48, 484), stroke=GREY, width=1)
    fig.note(56, 344, "g along x")
    fig.note(346, 410, "time", anchor="end")
    fig.line(*samples(wave, 48, 348, 48), stroke=BLUE, width=2)
    width = 300 / 8
    for k in range(8):
        x, y = wave(48 + (k + 0.5) * width)
        fig.line((x - width / 2, y), (x + width / 2, y), stroke=ORANGE, width=2.5)
        fig.disc(x, y, 3.5, fill=PAPER, stroke=INK)
    fig.text(204, 346, "g(t + h/2), constant", "in each substep", color=ORANGE)
    fig.note(24, 518, "Between two substeps U changes where bodies", "are: this is the work of what turns gravity.")

    fig.text(376, 320, "Servo: a free body on a line", bold=True, size=14)
    fig.line((424, 338), (424, 486), stroke=GREY, width=4)
    fig.line((520, 338), (520, 486), stroke=GREY, width=4)
    fig.rect(430, 384, 84, 46, fill=PALE[BLUE], stroke=BLUE, rx=3)
    for x in (451, 493):
        fig.disc(x, 451, 20.5, fill=PALE[GREY], stroke=GREY)
    fig.line((430, 473), (514, 473), stroke=INK, width=2)
    fig.arrow((472, 342), (472, 382), stroke=RED, width=2.5)
    fig.text(480, 362, "F s", color=RED)
    fig.note(416, 412, "guide", anchor="end")
    at, v = (592, 350), (58, 84)
    fig.arrow(at, (at[0] + v[0], at[1] + v[1]), stroke=GREY)
    fig.arrow(at, (at[0], at[1] + v[1]), stroke=BLUE, width=2.5)
    fig.line((at[0] + 3, at[1] + v[1]), (at[0] + v[0], at[1] + v[1]), stroke=RED, dash="4 4")
    fig.disc(*at, 3.5)
    fig.note(at[0] + 38, at[1] + 32, "v after", "a sweep")
    fig.text(at[0] - 8, at[1] + 50, "(s·v) s", color=BLUE, anchor="end")
    fig.text(at[0] + 30, at[1] + v[1] + 20, "the guide takes this", color=RED, anchor="middle")
    fig.note(376, 518, "After each sweep only the velocity along the", "axis s is kept. The guide does no work.")
    fig.save()


# 2. Rotation

def turned(momentum, axis, angle):
    """A momentum in the body's frame, after the body has turned about one of its axes."""
    a, b = (axis + 1) % 3, (axis + 2) % 3
    out = list(momentum)
    out[a] = math.cos(angle) * momentum[a] + math.sin(angle) * momentum[b]
    out[b] = math.cos(angle) * momentum[b] - math.sin(angle) * momentum[a]
    return out


SPLITTING = ((0, 0.5), (1, 0.5), (2, 1.0), (1, 0.5), (0, 0.5))  # axis by ascending moment, share of the step


def split(momentum, moments, h):
    for axis, share in SPLITTING:
        momentum = turned(momentum, axis, share * h * momentum[axis] / moments[axis])
    return momentum


def rotational_energy(momentum, moments):
    return sum(m * m / (2 * i) for m, i in zip(momentum, moments))


def restored(momentum, moments, energy):
    """Turned towards or away from the spin w, thus about w x L, until the energy is the one given."""
    for _ in range(20):
        spin = [m / i for m, i in zip(momentum, moments)]
        square = sum(m * m for m in momentum)
        away = [w - sum(p * q for p, q in zip(spin, momentum)) / square * m for w, m in zip(spin, momentum)]
        slope = sum(a * a for a in away)
        excess = rotational_energy(momentum, moments) - energy
        moved = [m - excess / slope * a for m, a in zip(momentum, away)]
        length = math.sqrt(square / sum(m * m for m in moved))
        momentum = [length * m for m in moved]
    return momentum


def energy_contour(energy, moments):
    """The two curves on the unit sphere of momenta, each by the angle about the axis around which it closes."""
    axis = 0 if 2 * energy * moments[1] > 1 else 2
    a, b = (axis + 1) % 3, (axis + 2) % 3
    curves = []
    for side in (1, -1):
        curve = []
        for k in range(81):
            angle = 2 * math.pi * k / 80
            turning = math.cos(angle) ** 2 / moments[a] + math.sin(angle) ** 2 / moments[b]
            across = math.sqrt((2 * energy - 1 / moments[axis]) / (turning - 1 / moments[axis]))
            point = {axis: side * math.sqrt(max(0.0, 1 - across * across)), a: across * math.cos(angle), b: across * math.sin(angle)}
            curve.append([point[0], point[1], point[2]])
        curves.append(curve)
    return curves


def runs(points, keeps):
    """The pieces of a curve that are kept."""
    piece = []
    for point in [*points, None]:
        if point is not None and keeps(point):
            piece.append(point)
            continue
        if len(piece) > 1:
            yield piece
        piece = []


def rotation():
    fig = Figure("rotation", 506, "Free rotation by five turns about the principal axes")
    dot = lambda a, b: sum(p * q for p, q in zip(a, b))
    moments, right, up, ahead = (1.0, 1.7, 2.6), (-0.63, 0.777, 0.0), (-0.36, -0.292, 0.886), (0.688, 0.558, 0.464)
    centre, radius = (176, 206), 142
    screen = lambda m: (centre[0] + radius * dot(m, right), centre[1] - radius * dot(m, up))
    window, corner, zoom = (104, 181), (398, 46), 2.5
    inset = lambda p: (corner[0] + zoom * (p[0] - window[0]), corner[1] + zoom * (p[1] - window[1]))
    width, height = 296, 206
    in_window = lambda p: 0 < p[0] - window[0] < width / zoom and 0 < p[1] - window[1] < height / zoom

    start = [0.85, 0.15, 0.5]
    start = [m / math.sqrt(dot(start, start)) for m in start]
    energy = rotational_energy(start, moments)
    fig.text(24, 32, "L as the body sees it keeps its length", bold=True, size=14)
    fig.disc(*centre, radius, fill=PALE[GREY], stroke=FAINT)
    fig.rect(*corner, width, height, rx=4, fill=PAPER, stroke=GREY, width=1)
    for y in (0, height):
        fig.line((window[0] + width / zoom, window[1] + y / zoom), (corner[0], corner[1] + y), stroke=FAINT, width=1)
    for level in (0.485, 0.45, 0.34, 0.255, 0.215, 0.197, energy):
        style = {"stroke": GREEN, "width": 2.5} if level == energy else {"stroke": "#b9c2cb", "width": 1}
        for curve in energy_contour(level, moments):
            for piece in runs(curve, lambda m: dot(m, ahead) > 0.02):
                fig.line(*map(screen, piece), **style)
                for part in runs([screen(m) for m in piece], in_window) if level == energy else ():
                    fig.line(*map(inset, part), stroke=GREEN, width=3)
    fig.rect(*window, width / zoom, height / zoom, stroke=GREY, width=1)
    for axis, (label, anchor, dx, dy) in enumerate((("axis 1", "middle", 0, 18), ("axis 2", "middle", 0, 18), ("axis 3", "middle", 0, -8))):
        x, y = screen([1.0 if k == axis else 0.0 for k in range(3)])
        fig.disc(x, y, 3, fill=GREY)
        fig.note(x + dx, y + dy, label, anchor=anchor)
    fig.note(centre[0], 374, "grey and green: curves of equal energy", anchor="middle")

    step, momentum = 2.4, start
    colors, at = (BLUE, ORANGE, PURPLE, ORANGE, BLUE), (0.42, 0.5, 0.22, 0.5, 0.6)
    for k, ((axis, share), color) in enumerate(zip(SPLITTING, colors)):
        angle, before = share * step * momentum[axis] / moments[axis], momentum
        arc = samples(lambda part: screen(turned(before, axis, part * angle)), 0, 1, 12)
        fig.line(*arc, stroke=color, width=1.5)
        fig.line(*map(inset, arc), stroke=color, width=2.5)
        momentum = turned(before, axis, angle)
        x, y = inset(screen(turned(before, axis, at[k] * angle)))
        fig.disc(x, y, 9, fill=PAPER, stroke=color, width=1.5)
        fig.text(x, y + 4.5, str(k + 1), color=color, anchor="middle", bold=True)
    back = restored(momentum, moments, energy)
    fig.line(inset(screen(momentum)), inset(screen(back)), stroke=RED, width=3)
    fig.text(inset(screen(back))[0] + 14, inset(screen(back))[1] - 12, "6: back to", "the energy", color=RED)
    fig.disc(*inset(screen(start)), 5)
    fig.disc(*inset(screen(back)), 5, fill=PAPER, stroke=INK, width=2)
    fig.note(corner[0] + 8, corner[1] - 8, "one step, drawn far too long")

    left, base, across, high = 414, 372, 280, 80
    fig.line((left, base - high - 10), (left, base + 12), stroke=GREY, width=1)
    fig.line((left, base), (left + across, base), stroke=GREEN, width=2.5)
    for turn, color in ((0.5, RED), (0.25, ORANGE)):
        length, momentum, points = turn / math.sqrt(sum((m / i) ** 2 for m, i in zip(start, moments))), start, [(left, base)]
        for k in range(1, int(15 / turn) + 1):
            momentum = split(momentum, moments, length)
            points.append((left + across * k * turn / 15, base - high * (rotational_energy(momentum, moments) / energy - 1) / 0.002))
        fig.line(*points, stroke=color, width=2)
    fig.note(left + 4, base - high - 14, "without turn 6, steps of")
    fig.note(left - 8, base - high + 4, "energy", anchor="end")
    fig.text(left + 170, base - high - 14, "0.5 rad,", color=RED)
    fig.text(left + 226, base - high - 14, "0.25 rad", color=ORANGE)
    fig.text(left + across, base + 18, "with turn 6", color=GREEN, anchor="end")

    fig.line((16, 402), (704, 402), stroke=EDGE, width=1)
    for x, head, rows in ((24, "Equal moments", ("Spheres and cubes turn with", "constant spin. This is exact.")),
                          (256, "Turns under 5e-6 rad", ("The body turns about its mean", "spin, as most in a heap do.")),
                          (488, "All other turns", ("Turns 1 to 6, in steps of half", "a radian at most."))):
        fig.text(x, 426, head, bold=True)
        fig.note(x, 446, *rows)
    fig.note(24, 488, "Axes are numbered by their moments of inertia, the least first.")
    fig.save()


# 3. Broad phase

DOMAIN, FINE, COARSE = 252, 28, 84
BALLS = ((38, 41, 30), (134, 64, 28), (214, 108, 32), (60, 196, 33), (196, 206, 30),  # place and radius
         (92, 83, 11), (132, 115, 10), (108, 109, 11), (166, 130, 10), (95, 132, 9), (131, 166, 10), (153, 158, 9), (161, 184, 10),
         (20, 108, 9), (226, 34, 10), (112, 216, 10), (138, 222, 11), (236, 164, 9), (24, 148, 8), (188, 40, 9), (54, 118, 10))


def box_of(ball):
    x, y, r = ball
    fat = r + 0.1 * r + 1.5
    return x - fat, y - fat, x + fat, y + fat


def overlap(a, b):
    return a[0] <= b[2] and b[0] <= a[2] and a[1] <= b[3] and b[1] <= a[3]


def broad_phase():
    fig = Figure("broad_phase", 428, "Fat boxes and the hierarchical grid")
    boxes = [box_of(ball) for ball in BALLS]
    width = lambda k: boxes[k][2] - boxes[k][0]
    low = [width(k) <= FINE for k in range(len(BALLS))]
    assert all(width(k) <= COARSE for k in range(len(BALLS)))
    pairs = [(i, j) for i in range(len(BALLS)) for j in range(i + 1, len(BALLS)) if overlap(boxes[i], boxes[j])]
    looks = 7  # the ball whose search is drawn
    x, y, _ = BALLS[looks]

    def draw(left, top, cell, on_level):
        fig.rect(left, top, DOMAIN, DOMAIN, fill="#ffffff", stroke=None)
        column, row = int(x // cell), int(y // cell)
        if on_level:
            cells = [(column + d, row + e) for d, e in ((0, 0), (1, 0), (-1, 1), (0, 1), (1, 1))]
        else:
            reach = [int((boxes[looks][k] + (-0.5 if k < 2 else 0.5) * cell) // cell) for k in range(4)]
            last = DOMAIN // cell - 1
            columns, rows = (range(max(reach[k], 0), min(reach[k + 2], last) + 1) for k in (0, 1))
            cells = [(c, r) for c in columns for r in rows]
        for c, r in cells:
            fig.rect(left + c * cell, top + r * cell, cell, cell, fill=PALE[ORANGE])
        for k in range(DOMAIN // cell + 1):
            fig.line((left + k * cell, top), (left + k * cell, top + DOMAIN), stroke=FAINT, width=1)
            fig.line((left, top + k * cell), (left + DOMAIN, top + k * cell), stroke=FAINT, width=1)
        for k, (bx, by, r) in enumerate(BALLS):
            mine = low[k] == on_level
            color = (GREEN if low[k] else BLUE) if mine else FAINT
            if k == looks:
                color = ORANGE
            x0, y0, x1, y1 = boxes[k]
            fig.disc(left + bx, top + by, r, fill=PALE.get(color, "none"), stroke=color, width=1.5 if mine or k == looks else 1)
            if mine or k == looks:
                fig.rect(left + x0, top + y0, x1 - x0, y1 - y0, stroke=color, width=1)
                fig.disc(left + bx, top + by, 1.8, fill=color)
        found = [(i, j) for i, j in pairs if (low[i] and low[j]) == on_level]
        for k in {k for pair in found for k in pair if low[k] != on_level and k != looks}:
            x0, y0, x1, y1 = boxes[k]
            fig.rect(left + x0, top + y0, x1 - x0, y1 - y0, stroke=GREY, width=1)
        for i, j in found:
            fig.line(*((left + BALLS[k][0], top + BALLS[k][1]) for k in (i, j)), stroke=RED, width=2.5)
        fig.rect(left, top, DOMAIN, DOMAIN, stroke=GREY, width=1)

    fig.text(20, 32, "A fat box", bold=True, size=14)
    cx, cy, r = 84, 190, 34
    fig.rect(cx - 60, cy - 60, 120, 120, stroke=GREEN, width=1.5, dash="5 3")
    fig.rect(cx - r, cy - r, 2 * r, 2 * r, stroke=FAINT, width=1)
    fig.disc(cx, cy, r, fill=PALE[GREEN], stroke=GREEN)
    fig.arrow((cx, cy), (cx + 20, cy - 12), stroke=BLUE)
    fig.text(cx + 8, cy + 12, "v", color=BLUE, anchor="middle")
    fig.arrow((cx + r, cy), (cx + 60, cy), stroke=INK, both=True, head=6, width=1.2)
    fig.note(20, 58, "It has room for the", "way in the step, and", "for a skin of 0.03 of", "the body's size.")
    fig.note(20, 276, "The pairs are kept", "as long as bodies", "stay in their boxes.")

    fig.text(172, 32, "Low level: small cells", bold=True, size=14)
    draw(172, 46, FINE, True)
    fig.text(172, 318, "An object stands in the cell that", "holds its centre. It looks into half", "of the cells around it (orange); from",
             "the other half others look at it.", color=GREY)
    fig.text(448, 32, "High level: wide cells", bold=True, size=14)
    draw(448, 46, COARSE, False)
    fig.note(448, 318, "It also looks into the other levels:", "into the cells (orange) that may hold", "the centre of what overlaps it. Or",
             "the large objects look down.")
    fig.line((172, 406), (194, 406), stroke=RED, width=2.5)
    fig.text(202, 410, "PCS: pairs of boxes that overlap, each found once")
    fig.save()


# 4. Narrow phase

def clipped(polygon, half):
    """Corners (u, w, height) of a polygon, cut to the rectangle |u| <= half[0], |w| <= half[1]."""
    for axis in (0, 1):
        for side in (-1, 1):
            out = []
            for p, q in zip(polygon, polygon[1:] + polygon[:1]):
                beyond = [side * c[axis] - half[axis] for c in (p, q)]
                if beyond[0] <= 0:
                    out.append(p)
                if (beyond[0] <= 0) != (beyond[1] <= 0):
                    out.append(along(p, q, beyond[0] / (beyond[0] - beyond[1])))
            polygon = out
    return polygon


def four_of(points):
    """The deepest, the one farthest from it, and the two that add most area (narrowphase/box_face.hpp)."""
    area = lambda a, b, c: (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    kept = [min(points, key=lambda c: c[2])]
    kept.append(max(points, key=lambda c: math.dist(c[:2], kept[0][:2])))
    kept.append(max(points, key=lambda c: abs(area(kept[0], kept[1], c))))
    a, b, c = kept
    turn = -1 if area(a, b, c) < 0 else 1
    kept.append(max(points, key=lambda d: max(-turn * area(a, b, d), -turn * area(b, c, d), -turn * area(c, a, d))))
    return kept


def narrow_phase():
    fig = Figure("narrow_phase", 420, "The contact of two boxes: normal, points and gaps")
    half, other, turn, shift, tilt = (84, 62), (66, 50), math.radians(27), (34, 14), (0.05, 0.02)
    corner = lambda a, b: (shift[0] + a * math.cos(turn) - b * math.sin(turn), shift[1] + a * math.sin(turn) + b * math.cos(turn))
    face = [corner(a * other[0], b * other[1]) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    face = [(u, w, -4 + tilt[0] * (u + 40) + tilt[1] * (w + 40)) for u, w in face]
    points = clipped(face, half)
    kept = four_of(points)

    fig.text(24, 32, "Two boxes and their contact", bold=True, size=14)
    screen = lambda u, w, z: (130 + 0.86 * u - 0.5 * w, 226 + 0.28 * u + 0.42 * w - z)
    base = [(-half[0], -half[1]), (half[0], -half[1]), (half[0], half[1]), (-half[0], half[1])]
    for k in (1, 2):
        a, b = base[k], base[(k + 1) % 4]
        fig.line(screen(*a, 0), screen(*b, 0), screen(*b, -52), screen(*a, -52), closed=True, fill=PALE[BLUE], stroke=BLUE)
    fig.line(*(screen(*p, 0) for p in base), closed=True, fill="#eaf2fa", stroke=BLUE)
    fig.line(*(screen(u, w, 0) for u, w, _ in points), closed=True, fill=PALE[GREEN], stroke=GREEN)
    height = 66
    for k in (0, 1, 2, 3):
        a, b = face[k], face[(k + 1) % 4]
        fig.line(screen(a[0], a[1], 0), screen(a[0], a[1], height), stroke=ORANGE, width=1.2, dash=None if k != 0 else "3 3")
        fig.line(screen(a[0], a[1], 0), screen(b[0], b[1], 0), stroke=ORANGE, width=1.2)
    fig.line(*(screen(u, w, height) for u, w, _ in face), closed=True, fill=PALE[ORANGE], stroke=ORANGE, opacity="0.8")
    for u, w, _ in kept:
        fig.disc(*screen(u, w, 0), 4.5, fill=GREEN)
    middle = (sum(p[0] for p in kept) / 4, sum(p[1] for p in kept) / 4)
    fig.arrow(screen(*middle, 0), screen(*middle, 118), stroke=RED, width=2.5)
    fig.text(screen(*middle, 0)[0] + 10, screen(*middle, 116)[1] + 4, "n", color=RED)
    fig.text(34, 274, "i", color=BLUE, size=15)
    fig.text(screen(*face[3][:2], height)[0] + 10, screen(*face[3][:2], height)[1] + 10, "j", color=ORANGE, size=15)
    fig.note(24, 372, "The normal n points from", "body i to body j. All points", "of the contact share it.")

    fig.line((260, 20), (260, 404), stroke=EDGE, width=1)
    fig.text(276, 32, "The face, clipped", bold=True, size=14)
    plan = lambda p: (362 + 0.82 * p[0], 178 + 0.82 * p[1])
    fig.line(*map(plan, base), closed=True, fill="#eaf2fa", stroke=BLUE)
    fig.line(*map(plan, face), closed=True, stroke=ORANGE)
    fig.line(*map(plan, points), closed=True, fill=PALE[GREEN], stroke=GREEN, width=2)
    for p in points:
        fig.disc(*plan(p), 4, fill=PAPER, stroke=GREEN)
    for k, p in enumerate(kept):
        fig.disc(*plan(p), 9, fill=GREEN)
        fig.text(plan(p)[0], plan(p)[1] + 4.5, str(k + 1), color=PAPER, anchor="middle", bold=True)
    fig.note(276, 58, "Seen along n")
    fig.text(288, 246, "face of i", color=BLUE)
    fig.text(420, 92, "face of j", color=ORANGE, anchor="middle")
    for k, words in enumerate(("the deepest point", "the farthest from it", "adds most area", "adds most area beyond")):
        fig.text(276, 290 + 19 * k, str(k + 1), color=GREEN, bold=True)
        fig.text(292, 290 + 19 * k, words)
    fig.note(276, 372, "At most four points stay.", "Each has a name, by which", "its impulse is found again.")

    fig.line((478, 20), (478, 404), stroke=EDGE, width=1)
    fig.text(494, 32, "Gaps, seen from the side", bold=True, size=14)
    top, left, right = 190, 496, 702
    under = lambda x: top + 22 - 0.24 * (x - left)
    fig.rect(left, top, right - left, 78, fill=PALE[BLUE], stroke=None)
    fig.line((left, top), (right, top), stroke=BLUE, width=2)
    fig.line((left, under(left)), (right, under(right)), (right, 84), (left, 84), closed=True, fill=PALE[ORANGE], stroke=None, opacity="0.75")
    fig.line((left, under(left)), (right, under(right)), stroke=ORANGE, width=2)
    fig.text(left + 10, top + 66, "i", color=BLUE, size=15)
    fig.text(left + 10, 106, "j", color=ORANGE, size=15)
    for x in (left + 22, right - 22):
        fig.line((x, top), (x, under(x)), stroke=INK, width=1.2)
        fig.disc(x, (top + under(x)) / 2, 4.5, fill=GREEN)
    fig.text(left + 22, top + 40, "gap < 0: bodies overlap")
    fig.text(right - 30, top - 40, "gap > 0", anchor="end")
    fig.arrow((left + 92, top), (left + 92, top - 64), stroke=RED, width=2.5)
    fig.text(left + 100, top - 58, "n", color=RED)
    fig.note(494, 304, "A point lies midway between", "the two surfaces. It is the same", "point for both bodies, so that",
             "angular momentum is kept.")
    fig.save()


# 5. Impacts

RADIUS = 9


class BallsOnLine:
    """Balls on a line that bounce with e = 1, without gravity; the substep lasts from 0 to 1. A ball of infinite mass is a wall."""

    def __init__(self, *balls):
        """Place at 0, velocity and mass of each, one after another on the line."""
        self.place, self.velocity, self.mass = ([ball[k] for ball in balls] for k in range(3))
        self.clock = [0.0] * len(balls)
        self.ways = [[(0.0, ball[0])] for ball in balls]
        self.impacts, self.waiting = [], []  # round, time, place, and the first of the two balls

    def at(self, ball, time):
        return self.place[ball] + self.velocity[ball] * (time - self.clock[ball])

    def meeting(self, i):
        """When a ball meets the next one; None: not in the substep."""
        j = i + 1
        closing = self.velocity[i] - self.velocity[j]
        time = max(self.clock[i], self.clock[j])
        gap = self.at(j, time) - self.at(i, time) - 2 * RADIUS
        return time + gap / closing if closing > 1e-9 and gap / closing <= 1 - time else None

    def resolve(self):
        """Round after round: of the predicted meetings those that are first for both balls, unless one of them waits for a neighbour."""
        turn = 0
        while True:
            turn += 1
            meetings = {i: time for i in range(len(self.place) - 1) if (time := self.meeting(i)) is not None}
            if not meetings:
                break
            first = {}
            for i, time in sorted(meetings.items(), key=lambda m: -m[1]):
                first[i] = first[i + 1] = (time, i)
            waits = set()
            for i in range(len(self.place) - 1):
                if i in first and i + 1 in first and math.inf not in self.mass[i:i + 2] and first[i] != first[i + 1]:
                    goes, waiting = sorted((i, i + 1), key=lambda ball: first[ball][0])
                    partner = 2 * first[goes][1] + 1 - goes
                    time = first[goes][0]
                    driven = abs(self.velocity[goes]) + 2 * abs(self.velocity[partner]) + abs(self.velocity[waiting])
                    if abs(self.at(i, time) - self.at(i + 1, time)) <= 2 * RADIUS + driven * (first[waiting][0] - time):
                        waits.add(waiting)
            for i, time in sorted(meetings.items()):
                two = [k for k in (i, i + 1) if self.mass[k] < math.inf]
                if any(first[k] != (time, i) for k in two):
                    continue
                if waits & set(two):
                    self.waiting.append((turn, time, self.at(i, time) + RADIUS, i))
                else:
                    self.impacts.append((turn, time, self.at(i, time) + RADIUS, i))
                    self.strike(i, time)
        for k, way in enumerate(self.ways):
            way.append((1.0, self.at(k, 1.0)))

    def strike(self, i, time):
        closing = self.velocity[i] - self.velocity[i + 1]
        mass = [self.mass[i], self.mass[i + 1]]
        impulse = 2 * closing / sum(1 / m for m in mass)
        for k, sign in ((i, -1), (i + 1, 1)):
            self.place[k], self.clock[k] = self.at(k, time), time
            self.velocity[k] += sign * impulse / self.mass[k]
            self.ways[k].append((time, self.place[k]))


def impacts():
    fig = Figure("impacts", 486, "Rounds of impacts in one substep")
    fig.text(24, 32, "Balls on a line: where they are during one substep", bold=True, size=14)
    left, across, colors = 64, 424, (None, BLUE, ORANGE, GREEN, PURPLE, RED)
    groups = (BallsOnLine((72, 190, 1), (132, 0, 1), (177, 0, 1), (244, -60, 2)), BallsOnLine((338, 100, 1), (382, 0, 1), (426, 0, math.inf)))
    names, struck = (("A", "B", "C", "D"), ("E", "F", "wall")), {}
    x = lambda time: left + across * time
    for time, label in ((0, "0"), (0.5, "h/2"), (1, "h")):
        fig.line((x(time), 48), (x(time), 442), stroke=FAINT, width=1)
        fig.note(x(time), 460, label, anchor="middle")
    fig.note(x(0.25), 460, "time in the substep", anchor="middle")
    for group, labels in zip(groups, names):
        start = [way[0][1] for way in group.ways]
        group.resolve()
        for turn, time, place, k in group.waiting[:1]:
            for ball in (k, k + 1):
                side = RADIUS if ball == k else -RADIUS
                fig.line((x(0), start[ball]), (x(time), place - side), stroke=GREY, dash="3 4", width=1.2)
            fig.disc(x(time), place, 9, fill=PAPER, stroke=GREY, dash="3 3")
            fig.note(x(time) + 4, place + 26, f"{labels[k]}–{labels[k + 1]} waits")
        for way, label, mass in zip(group.ways, labels, group.mass):
            if mass == math.inf:
                fig.rect(x(0), way[0][1] - RADIUS, across, 12, fill=FAINT)
                fig.text(x(0) - 10, way[0][1] + 3, label, anchor="end")
                continue
            for (t0, y0), (t1, y1) in zip(way, way[1:]):
                band = [(x(t), y + side) for side, ends in ((-RADIUS, ((t0, y0), (t1, y1))), (RADIUS, ((t1, y1), (t0, y0)))) for t, y in ends]
                fig.line(*band, closed=True, fill="#b9c7d6", stroke=None, opacity="0.55")
                fig.line((x(t0), y0), (x(t1), y1), stroke="#5d7288", width=1.2)
            fig.text(x(0) - 10, way[0][1] + 5, label, anchor="end")
        for turn, time, place, k in group.impacts:
            struck.setdefault(turn, []).append(f"{labels[k]}–{labels[k + 1]}")
            fig.disc(x(time), place, 10, fill=colors[turn])
            fig.text(x(time), place + 4.5, str(turn), color="#ffffff", anchor="middle", bold=True)
    fig.note(x(0) + 8, 276, "D has twice the mass of the others")
    fig.line((24, 298), (496, 298), stroke=EDGE, width=1, dash="6 4")
    fig.note(x(0.5) + 8, 318, "another place, far away")
    fig.line((506, 20), (506, 468), stroke=EDGE, width=1)
    fig.text(520, 32, "Rounds", bold=True, size=14)
    fig.note(520, 58, "In each round all impacts", "are resolved that are the", "first in their neighbourhood.")
    for turn, pairs in sorted(struck.items()):
        y = 91 + 27 * turn
        fig.disc(530, y, 10, fill=colors[turn])
        fig.text(530, y + 4.5, str(turn), color="#ffffff", anchor="middle", bold=True)
        fig.text(548, y + 4.5, " and ".join(pairs))
    fig.note(520, 274, "Places apart do not wait", "for each other.")
    fig.disc(530, 319, 9, fill=PAPER, stroke=GREY, dash="3 3")
    fig.note(548, 323.5, "C–D is predicted in")
    fig.note(520, 340.5, "round 1. It waits, since B", "may be driven into C before.")
    fig.note(520, 392, "After an impact, the next", "meetings of its two bodies", "are computed anew, so that", "chains run through.")
    fig.save()


# 6. Response

def pile(rows, radius, left, floor):
    """Balls in rows that lie in the gaps of the row below, not touching beside; contacts (place, i, j), the floor being -1."""
    spacing = 2.3 * radius
    rise = math.sqrt(4 * radius * radius - spacing * spacing / 4)
    balls = [(left + spacing * (c + r / 2), floor - radius - rise * r) for r in range(rows) for c in range(rows - r)]
    contacts = [((x, floor), k, -1) for k, (x, y) in enumerate(balls) if floor - y < 1.01 * radius]
    contacts += [(along(balls[i], balls[j], 0.5), i, j) for i in range(len(balls)) for j in range(i + 1, len(balls))
                 if math.dist(balls[i], balls[j]) < 2.01 * radius]
    return balls, contacts


def coloured(contacts):
    """The first colour of each contact that no contact of its free bodies has."""
    taken, colors = {}, []
    for _, *bodies in contacts:
        free = [body for body in bodies if body >= 0]
        color = next(c for c in range(99) if all((body, c) not in taken for body in free))
        taken.update({(body, color): True for body in free})
        colors.append(color)
    return colors


def response():
    fig = Figure("response", 548, "The contact law, Coulomb's cone, and sweeps over coloured contacts")
    fig.text(24, 32, "Along the normal", bold=True, size=14)
    x, y, target = 96, 196, 42
    fig.arrow((40, y), (220, y), stroke=GREY, width=1.2)
    fig.arrow((x, 216), (x, 56), stroke=GREY, width=1.2)
    fig.text(x + 8, 66, "p_n", size=14)
    fig.text(216, y + 20, "u_n", size=14, anchor="end")
    fig.line((x, 76), (x, y), (206, y), stroke=BLUE, width=3.5)
    fig.line((x - target, 76), (x - target, y), (x, y), stroke=ORANGE, width=2.5, dash="6 4")
    fig.text(x + 10, 104, "target 0:", "a closed contact", color=BLUE)
    fig.text(x - target, y + 20, "−gap/h", color=ORANGE, anchor="middle")
    fig.text(x + 10, 152, "an open one may", "close its gap", color=ORANGE)
    fig.note(24, 244, "Either the contact does not", "push, or its normal velocity", "is at the target.")

    fig.line((244, 20), (244, 290), stroke=EDGE, width=1)
    fig.text(258, 32, "Across it: Coulomb's cone", bold=True, size=14)
    tip, axis, slope = (352, 216), 136, 0.62
    rim = lambda angle: (tip[0] + slope * axis * math.cos(angle), tip[1] - axis + 0.28 * slope * axis * math.sin(angle))
    edge = math.asin(0.28 * slope)
    fig.line(rim(edge), tip, rim(math.pi - edge), stroke=BLUE, fill=PALE[BLUE], width=2)
    fig.line(*samples(rim, 0, 2 * math.pi, 40), stroke=BLUE, fill="#eaf2fa", width=2)
    fig.line((tip[0] - 84, tip[1] + 2), (tip[0] + 84, tip[1] + 2), stroke=INK, width=2)
    fig.arrow(tip, (tip[0], tip[1] - axis - 44), stroke=GREY, width=1.2)
    fig.text(tip[0] + 8, tip[1] - axis - 34, "n")
    slides, centre = rim(0.62), (tip[0], tip[1] - axis)
    fig.arrow(tip, along(tip, slides, 0.99), stroke=RED, width=2.5)
    fig.line(centre, slides, stroke=RED, dash="4 3")
    fig.text(slides[0] + 3, slides[1] + 34, "p where", "it slides", color=RED)
    sticks = (tip[0] - 26, tip[1] - 0.8 * axis)
    fig.arrow(tip, sticks, stroke=GREEN, width=2.5)
    fig.text(258, tip[1] - 44, "p where", "it sticks", color=GREEN)
    ut = (centre[0] - 0.5 * (slides[0] - centre[0]), centre[1] - 0.5 * (slides[1] - centre[1]))
    fig.arrow(centre, ut, stroke=ORANGE)
    fig.text(ut[0] - 4, ut[1] - 4, "u_t", color=ORANGE, anchor="end")
    fig.note(258, 244, "|p_t| is at most mu p_n. Where", "the contact slides, p_t is on the", "rim and opposite to u_t.")

    fig.line((484, 20), (484, 290), stroke=EDGE, width=1)
    fig.text(498, 32, "A visit to a contact", bold=True, size=14)
    for k, (rows, color) in enumerate(((("1  Try to stick: the impulse", "that gives u = target."), GREEN),
                                       (("2  If it leaves the cone: p_n", "that reaches the target, then", "one step of friction, cut to",
                                         "the disc |p_t| = mu p_n."), RED),
                                       (("3  Give the change to both", "bodies at once."), BLUE))):
        fig.text(498, (62, 110, 192)[k], *rows, color=color)
    fig.note(498, 244, "The next contact sees what", "this one has changed", "(Gauss-Seidel).")

    fig.line((16, 302), (704, 302), stroke=EDGE, width=1)
    colors = (BLUE, ORANGE, GREEN, PURPLE, RED)
    fig.text(24, 328, "Contacts have colours", bold=True, size=14)
    balls, contacts = pile(4, 23, 64, 504)
    numbers = coloured(contacts)
    fig.line((24, 504), (266, 504), stroke=INK, width=2)
    for ball in balls:
        fig.disc(*ball, 23, fill=PALE[GREY], stroke="#98a3ae", width=1.2)
    for (place, i, j), color in zip(contacts, numbers):
        a = balls[i]
        b = balls[j] if j >= 0 else (a[0], 2 * 504 - a[1])
        fig.line(along(a, b, 0.36), along(a, b, 0.64) if j >= 0 else place, stroke=colors[color], width=6)
    fig.note(24, 530, "The floor is not free, so its contacts may share a colour.")

    fig.text(292, 328, "A sweep visits all contacts, colour by colour", bold=True, size=14)
    count = max(numbers) + 1
    step = 372 / count
    for color in range(count):
        left = 300 + step * color
        fig.rect(left, 346, step - 26, 54, rx=6, fill=PALE[colors[color]], stroke=colors[color])
        of = numbers.count(color)
        for k in range(of):
            fig.line((left + 13 + 8.2 * k, 362), (left + 13 + 8.2 * k, 384), stroke=colors[color], width=5)
        fig.text(left + (step - 26) / 2, 418, f"{of} at once", color=colors[color], anchor="middle")
        if color + 1 < count:
            fig.arrow((left + step - 24, 373), (left + step - 2, 373), stroke=INK, width=1.5)
    last, first = 300 + step * count - 26, 300
    fig.line((last + 2, 373), (last + 16, 373), (last + 16, 438), (first - 14, 438), (first - 14, 373), stroke=INK)
    fig.arrow((first - 14, 373), (first - 1, 373), stroke=INK, width=1.5)
    fig.rect(388, 426, 196, 24, rx=12, fill=PAPER, stroke=INK)
    fig.text(486, 442.5, "again, until little changes", anchor="middle")
    fig.text(292, 476, "Contacts of one colour share no free body, so they are", "solved at once, with the same bits for any number of",
             "threads. The impulses start from those of the last substep.", color=GREY)
    fig.save()


# 7. Ledger

def ledger():
    """A ball that is dropped and bounces, in closed form, with all bounces. In units in which m g H and the time of the fall are 1."""
    fig = Figure("ledger", 536, "The energy of a bouncing ball, and where it went")
    e, left, base, across, high = 0.5, 60, 318, 392, 236
    end = (1 + e) / (1 - e)  # of the last of its endlessly many bounces
    last = 3.6
    fig.text(24, 32, "A dropped ball with e = 0.5, in closed form", bold=True, size=14)
    screen = lambda t, y: (left + across * t / last, base - high * y)

    def energies(t):
        """Potential, kinetic, and what restitution has taken; at a bounce, after it."""
        bounces, begin, flight = 0, 0.0, 1.0
        while t >= begin + flight - 1e-12 and bounces < 60:
            begin, bounces = begin + flight, bounces + 1
            flight = 2 * e ** bounces
        if bounces == 60 or t >= end:
            return 0.0, 0.0, 1.0
        total = e ** (2 * bounces)
        speed = e ** bounces - (t - begin) if bounces else -t  # upward, in units in which E = speed^2 on the floor
        kinetic = speed * speed
        return total - kinetic, kinetic, 1 - total

    times, instant = [], 0.0
    for bounce in range(8):
        flight = 1.0 if bounce == 0 else 2 * e ** bounce
        times += [instant + flight * k / (24 // (bounce + 1)) for k in range(24 // (bounce + 1))] + [instant + flight - 1e-9]
        instant += flight
    times += [end, last]
    bands = ((0, "U", BLUE), (1, "K", GREEN), (2, "restitution", ORANGE))
    lower = [0.0] * len(times)
    for part, _, color in bands:
        upper = [low + energies(t)[part] for low, t in zip(lower, times)]
        outline = [screen(t, y) for t, y in zip(times, upper)] + [screen(t, y) for t, y in zip(times[::-1], lower[::-1])]
        fig.line(*outline, closed=True, fill=PALE[color], stroke=color, width=1)
        lower = upper
    fig.line((left, base - high - 14), (left, base), (left + across + 8, base), stroke=GREY, width=1)
    fig.text(left - 8, base - high + 5, "E_0", anchor="end")
    fig.text(left - 8, base + 4, "0", anchor="end")
    for t, label in ((0, "t = 0"), (1, "1"), (2, "2"), (3, "3: at rest")):
        fig.line(screen(t, 0), (screen(t, 0)[0], base + 5), stroke=GREY, width=1)
        fig.note(screen(t, 0)[0], base + 20, label, anchor="middle")
    fig.text(left + 22, base - 150, "U", color=BLUE, size=15)
    fig.text(left + 78, base - 208, "K", color=GREEN, size=15)
    fig.text(screen(2.15, 0)[0], base - 160, "restitution", color=ORANGE, size=15, anchor="middle")
    fig.line(screen(1, 0.25), screen(1, 1), stroke=ORANGE, width=3)
    fig.text(screen(1, 0)[0] + 10, screen(1, 0.87)[1], "p (1 − e) u/2 = ¾ E_0", color=ORANGE)
    fig.note(left, base + 42, "The three parts sum to E_0 at every instant. Time is in", "units of the first fall.")

    fig.text(480, 32, "The first bounce", bold=True, size=14)
    floor = 150
    fig.line((486, floor), (700, floor), stroke=INK, width=2)
    for x, fill in ((540, PALE[BLUE]), (640, PALE[GREEN])):
        fig.disc(x, floor - 22, 22, fill=fill, stroke=GREY)
    fig.arrow((540, 62), (540, 126), stroke=BLUE, width=2.5)
    fig.arrow((640, floor - 24), (640, floor - 56), stroke=GREEN, width=2.5)
    fig.arrow((590, floor), (590, floor - 84), stroke=RED, width=2.5)
    fig.text(530, 70, "u^- = −u", color=BLUE, anchor="end")
    fig.text(650, 84, "u^+ = e u", color=GREEN)
    fig.text(598, 66, "p", color=RED)
    fig.text(480, 176, "p = (1 + e) m u", color=RED)
    fig.text(480, 198, "It moves the energy by exactly")
    fig.text(480, 220, "p (u^- + u^+)/2 = −p (1 − e) u/2", color=ORANGE)
    fig.note(480, 250, "u^- is the velocity before the", "kick of gravity: with it the sum", "is exact, and a body at rest", "loses nothing.")

    fig.line((16, 384), (704, 384), stroke=EDGE, width=1)
    fig.text(24, 410, "The ledger", bold=True, size=14)
    fig.text(24, 438, "E − E_0  =")
    for y, entries in ((438, ((None, "exchange", BLUE, 88), ("+", "work", BLUE, 54), ("+", "integration", BLUE, 96))),
                       (470, (("−", "restitution", ORANGE, 90), ("−", "friction", ORANGE, 70), ("−", "correction", ORANGE, 90),
                              ("+", "unexplained", RED, 102)))):
        x = 104
        for sign, word, color, width in entries:
            if sign:
                fig.text(x - 11, y, sign, anchor="middle")
            fig.rect(x, y - 16, width, 23, rx=5, fill=PALE[color], stroke=color, width=1)
            fig.text(x + width / 2, y, word, color=color, anchor="middle")
            x += width + 22
    fig.note(24, 502, "Each bucket is computed from its own definition. What they do not explain is unexplained; a step",
             "that leaves too much of it is taken again in smaller substeps.")
    fig.save()


# Periodic axes

def periodic_axes():
    fig = Figure("periodic_axes", 470, "The nearest image, and the images of boxes")
    fig.text(24, 32, "A space that repeats along x", bold=True, size=14)
    period, low, top, bottom = 212, 254, 64, 214
    for image in (-1, 0, 1):
        fig.rect(low + image * period, top, period, bottom - top, fill="#ffffff" if image == 0 else PALE[GREY], stroke=None)
    bodies = ((292, 146, 20, BLUE, "i"), (430, 112, 20, GREEN, "j"), (372, 186, 14, PURPLE, "k"))
    for image in (-1, 1, 0):
        for x, y, r, color, label in bodies:
            fig.disc(x + image * period, y, r, fill=PALE[color], stroke=color, opacity="0.4" if image else None)
    for image in range(-1, 3):
        style = {"width": 2} if image in (0, 1) else {"width": 1, "dash": "4 4"}
        fig.line((low + image * period, top), (low + image * period, bottom), stroke=GREY, **style)
    fig.text(low, top - 8, "low", anchor="middle")
    fig.text(low + period, top - 8, "high", anchor="middle")
    fig.arrow((low, bottom + 14), (low + period, bottom + 14), both=True, width=1.2, stroke=GREY)
    fig.note(low + period + 12, bottom + 19, "L")
    i, j, k = bodies
    d = (j[0] - i[0], j[1] - i[1])
    near = d[0] - period * round(d[0] / period)
    fig.arrow(i[:2], j[:2], stroke=GREY, dash="5 4", width=1.5)
    fig.note((i[0] + j[0]) / 2 + 4, (i[1] + j[1]) / 2 - 10, "d", anchor="middle")
    fig.arrow(i[:2], (i[0] + near, i[1] + d[1]), stroke=RED, width=2.5)
    fig.text(low - 12, 168, "d − L round(d/L)", color=RED, anchor="end")
    fig.text(i[0] + 24, i[1] + 18, "i", color=BLUE, bold=True)
    fig.text(j[0] - 24, j[1] + 22, "j", color=GREEN, bold=True, anchor="end")
    for x, y, *_ in (i, j):
        fig.disc(x, y, 3)
    fig.arrow((k[0] + 16, k[1]), (k[0] + period - 16, k[1]), stroke=PURPLE)
    fig.text(low + period + 12, k[1] + 17, "x counts on", color=PURPLE)
    fig.note(24, 258, "A pair, or an arm, is seen along the way to the nearest image (red).", "Nothing happens to a body that goes through an end.")

    fig.line((16, 290), (704, 290), stroke=EDGE, width=1)
    fig.text(24, 316, "Images of boxes in the broad phase", bold=True, size=14)
    low, period, top, bottom, highest = 60, 288, 334, 438, 360
    fig.rect(low, top, period, bottom - top, fill="#ffffff", stroke=None)
    for x, label in ((low, "low"), (low + period, "high")):
        fig.line((x, top), (x, bottom), stroke=GREY, width=2)
        fig.text(x, bottom + 17, label, anchor="middle")
    fig.line((highest, top), (highest, bottom), stroke=ORANGE, dash="4 3")
    fig.text(highest + 6, top - 2, "highest end", color=ORANGE)
    boxes = (("a", 44, 346, 42, 40, BLUE), ("b", 62, 374, 42, 40, GREEN), ("c", 314, 362, highest - 314, 42, PURPLE), ("e", 176, 362, 44, 44, GREY))
    for label, x, y, w, h, color in boxes:
        fig.rect(x, y, w, h, fill=PALE[color], stroke=color, opacity="0.85")
        fig.text(x + (10 if label in "abe" else 14), y + (14 if label == "a" else h - 8), label, color=color, bold=True)
        if x + period <= highest:
            fig.rect(x + period, y, w, h, stroke=color, dash="4 3", width=2)
            fig.text(x + period + w - 12, y + (14 if label == "a" else h - 8), label + "'", color=color, bold=True, anchor="middle")
    fig.note(452, 342, "A box that, moved up by L, still", "meets the highest end of a box has", "an image there (dashed): a', b'.")
    fig.text(452, 400, "(c, a'), (c, b'), (a, b): pairs", color=GREEN)
    fig.text(452, 420, "(a', b'): both moved, not counted", color=RED)
    fig.note(452, 440, "So each pair is found once.")
    fig.save()


# 8. Model plan

def model_plan():
    fig = Figure("model_plan", 466, "What a scene switches on")
    fig.text(24, 36, "What is computed", bold=True, size=14)
    columns = ((450, ("smooth balls", "of one size,", "no bounce")), (546, ("rough balls", "of one size,", "that bounce")),
               (646, ("balls that roll,", "and bricks,", "of many sizes")))
    fig.text(192, 36, "if the scene has", bold=True, size=14)
    for x, rows in columns:
        fig.text(x, 28, *rows, anchor="middle", leading=16)
    rows = (("tangential impulses", "friction", (0, 1, 1)),
            ("couples", "rolling friction, round bodies", (0, 0, 1)),
            ("impacts that bounce", "restitution", (0, 1, 1)),
            ("orientation of spheres", "spin, torque or friction", (0, 1, 1)),
            ("gyroscopic term", "bodies with unequal moments", (0, 0, 1)),
            ("continuous detection", "fast bodies in the substep", (0.5, 0.5, 0.5)),
            ("several grids", "sizes beyond an octave or two", (0, 0, 1)))
    for k, (feature, needs, states) in enumerate(rows):
        y = 90 + 44 * k
        if k % 2 == 0:
            fig.rect(16, y - 14, 688, 44, rx=6, fill=PALE[GREY])
        fig.text(24, y + 13, feature)
        fig.note(192, y + 13, needs)
        for (x, _), state in zip(columns, states):
            fig.disc(x, y + 8, 10, fill=GREEN if state == 1 else PAPER, stroke=GREEN if state else GREY)
            if state == 0.5:
                fig.shape("path", {"d": f"M{number(x)},{number(y - 2)}a10,10 0 0,0 0,20z"}, fill=GREEN)
    fig.disc(34, 420, 10, fill=GREEN, stroke=GREEN)
    fig.text(50, 424.5, "computed")
    fig.disc(154, 420, 10, fill=PAPER, stroke=GREEN)
    fig.shape("path", {"d": "M154,410a10,10 0 0,0 0,20z"}, fill=GREEN)
    fig.text(170, 424.5, "in substeps that need it")
    fig.disc(370, 420, 10, fill=PAPER, stroke=GREY)
    fig.text(386, 424.5, "left out, which changes no bit")
    fig.note(24, 452, "scree plan SCENE shows what a scene needs, and why.")
    fig.save()


if __name__ == "__main__":
    PICTURES.mkdir(parents=True, exist_ok=True)
    for draw in (time_stepping, prescribed_paths, rotation, broad_phase, narrow_phase, impacts, response, ledger, periodic_axes, model_plan):
        draw()
