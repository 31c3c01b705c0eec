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

    def shape(self, tag, fill="none", stroke=None, width=1.5, dash=None, opacity=None, **places):
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
        self.shape("path", d=way, stroke=stroke, **style)

    def rect(self, x, y, w, h, rx=0, **style):
        self.shape("rect", x=x, y=y, width=w, height=h, rx=rx, **{("w" if k == "width" else k): v for k, v in style.items()})

    def disc(self, x, y, r, fill=INK, **style):
        self.shape("circle", cx=x, cy=y, r=r, fill=fill, **style)

    def arrow(self, a, b, stroke=INK, width=2, head=9, both=False, **style):
        length = math.dist(a, b)
        inner = [along(a, b, 0.7 * head / length) if both else a, along(b, a, 0.7 * head / length)]
        self.line(*inner, stroke=stroke, width=width, **style)
        for tip, tail in ([(b, a), (a, b)] if both else [(b, a)]):
            foot = along(tip, tail, head / length)
            side = ((tail[1] - tip[1]) / length * 0.38 * head, (tip[0] - tail[0]) / length * 0.38 * head)
            self.line(tip, (foot[0] + side[0], foot[1] + side[1]), (foot[0] - side[0], foot[1] - side[1]), closed=True, fill=stroke, stroke=None)

    def text(self, x, y, *rows, color=INK, size=13, anchor="start", bold=False, leading=17):
        """Rows of words, in which _m is a subscript and ^+ a superscript, or _{...} and ^{...}."""
        style = f'font-size="{size}" fill="{color}"' + (f' text-anchor="{anchor}"' if anchor != "start" else "") + (' font-weight="bold"' if bold else "")
        for k, row in enumerate(rows):
            row = row.replace("&", "&amp;").replace("<", "&lt;")
            self.parts.append(f'<text x="{number(x)}" y="{number(y + k * leading)}" {style}>{raised(row)}</text>')

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
            fig.text(straight[0] + 8, straight[1] + 6, "(h/2) h g", color=ORANGE)
            fig.text(x[0] - 8, x[1] - 6, "x", anchor="end")
            fig.text(x_m[0], x_m[1] - 12, "x_m", anchor="middle")
            fig.text(after[0] - 8, after[1] + 18, "x^+", anchor="end")
        fig.disc(*x_m, 4.5, fill=PAPER, stroke=INK)
        for end in (x, after):
            fig.disc(*end, 5)
    fig.text(62, 338, "All places x lie on one parabola (grey).", "The two halves of a substep are its tangents at", "both ends, and they meet at x_m.", color=GREY)

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
    fig.text(v_end[0] + 8, v_end[1] + 24, "h g", color=ORANGE)
    fig.text(sum_end[0] + 16, sum_end[1] + 50, "M^{-1} Σ p", color=RED)
    fig.text(sum_end[0] + 8, sum_end[1] + 1, "v^+ along the floor", color=GREEN)

    fig.line((16, 390), (704, 390), stroke=EDGE, width=1)
    for k, (formula, words, color) in enumerate((("x_m = x + (h/2) v", "half a flight to the midpoint", BLUE),
                                                 ("v^+ = v + h g + M^{-1} Σ p", "gravity and impulses at x_m", RED),
                                                 ("x^+ = x_m + (h/2) v^+", "half a flight to the end", GREEN))):
        middle = 128 + 232 * k
        fig.text(middle, 414, formula, anchor="middle", color=color, size=15)
        fig.text(middle, 435, words, anchor="middle", color=GREY)
    fig.save()


# 1a. Prescribed paths

def rate_between(before, time_before, after, time_after):
    """Fritsch and Butland's weighted harmonic mean of two rates, or 0 where they differ in sign."""
    if before * after <= 0:
        return 0.0
    share = (time_before + 2 * time_after) / (3 * (time_before + time_after))
    return before * after / (share * after + (1 - share) * before)


def keyframe_path(keys):
    """The path as a function of time, cubic between keyframes (time, place); and the rates at these."""
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
    fig = Figure("prescribed_paths", 548, "Prescribed paths, gravity that turns, servos")
    fig.line((360, 16), (360, 532), stroke=EDGE, width=1)
    fig.line((16, 282), (704, 282), stroke=EDGE, width=1)

    fig.text(24, 32, "Keyframes: a smooth, monotone path", bold=True, size=14)
    keys = [(0, 0.0), (1, 0.25), (2, 1.3), (3.1, 1.55), (4.2, 0.8), (5, 0.8)]
    place = keyframe_path(keys)
    screen = lambda t, y: (48 + 56 * t, 190 - 76 * y)
    fig.line((48, 52), (48, 206), (342, 206), stroke=GREY, width=1)
    fig.text(340, 222, "time", color=GREY, anchor="end")
    fig.text(54, 62, "place", color=GREY)
    fig.line(*(screen(*key) for key in keys), stroke=GREY, dash="3 4", width=1)
    fig.line(*samples(lambda t: screen(t, place(t)), 0, 4.9999, 60), stroke=BLUE, width=2.5)
    for key in keys:
        fig.disc(*screen(*key), 5, fill=ORANGE)
    top = screen(*keys[3])
    fig.text(top[0], top[1] - 12, "rate 0 where it turns round", color=ORANGE, anchor="middle")
    fig.text(58, 222, "at rest", color=ORANGE)
    fig.text(screen(*keys[5])[0] + 8, screen(*keys[5])[1] + 22, "at rest", color=ORANGE, anchor="end")
    fig.text(24, 248, "The path goes through all keyframes (dots), and", "between two of them never beyond either.", color=GREY)

    fig.text(376, 32, "In a substep: a straight line", bold=True, size=14)
    begin, h, bend = 396, 140, 0.0052  # V' in px
    path = lambda x: (x, 196 - 1.24 * (x - begin) + bend / 2 * (x - begin) ** 2)
    slope = lambda x: -1.24 + bend * (x - begin)
    for k in range(3):
        fig.line((begin + k * h, 56), (begin + k * h, 214), stroke=FAINT, width=1)
    fig.line(*samples(path, begin, begin + 2 * h, 40), stroke=BLUE, width=2.5)
    for k in range(2):
        x_m = begin + (k + 0.5) * h
        ends = [(x, path(x_m)[1] + slope(x_m) * (x - x_m)) for x in (x_m - h / 2, x_m + h / 2)]
        fig.line(*ends, stroke=ORANGE, width=2)
        fig.disc(*path(x_m), 4.5, fill=PAPER, stroke=INK)
        fig.text(x_m, 230, f"substep {k + 1}", color=GREY, anchor="middle")
    joint, line_there = path(begin + h), (begin + h, path(begin + h)[1] + bend * h * h / 8)
    fig.arrow(joint, line_there, both=True, head=5, width=1.2)
    fig.arrow((joint[0] + 64, joint[1] - 26), (joint[0] + 5, (joint[1] + line_there[1]) / 2), stroke=GREY, width=1, head=7)
    fig.text(joint[0] + 66, joint[1] - 32, "V' h^2 / 8", anchor="middle")
    fig.text(408, 68, "path", color=BLUE)
    fig.text(636, 190, "line", color=ORANGE, anchor="middle")
    fig.text(376, 248, "Lines touch the path at midpoints (circles). At their", "ends they are off by the same, so nothing jumps.", color=GREY)

    fig.text(24, 308, "Gravity that turns: steps of its own", bold=True, size=14)
    wave = lambda x: (x, 412 - 58 * math.sin(2 * math.pi * (x - 48) / 300))
    fig.line((48, 412), (342, 412), stroke=GREY, width=1)
    fig.line((48, 340), (48, 484), stroke=GREY, width=1)
    fig.text(56, 346, "g along x", color=GREY)
    fig.text(340, 428, "time", color=GREY, anchor="end")
    fig.line(*samples(wave, 48, 348, 48), stroke=BLUE, width=2)
    width = 300 / 8
    for k in range(8):
        x, y = wave(48 + (k + 0.5) * width)
        fig.line((x - width / 2, y), (x + width / 2, y), stroke=ORANGE, width=2.5)
        fig.disc(x, y, 3.5, fill=PAPER, stroke=INK)
    fig.text(222, 356, "g(t + h/2), constant", "in each substep", color=ORANGE)
    fig.text(24, 510, "Between two substeps U changes where bodies", "are: this is the work of what turns gravity.", color=GREY)

    fig.text(376, 308, "Servo: a free body on a line", bold=True, size=14)
    fig.line((424, 326), (424, 484), stroke=GREY, width=4)
    fig.line((520, 326), (520, 484), stroke=GREY, width=4)
    fig.rect(430, 370, 84, 46, fill=PALE[BLUE], stroke=BLUE, rx=3)
    for x in (449, 495):
        fig.disc(x, 439, 22, fill=PALE[GREY], stroke=GREY)
    for x in (427, 472, 517):
        fig.disc(x, 477, 7, fill=PALE[GREY], stroke=GREY) if x == 472 else None
    fig.arrow((472, 330), (472, 368), stroke=RED, width=2.5)
    fig.text(482, 350, "F a", color=RED)
    fig.text(412, 354, "guide", color=GREY, anchor="end")
    at, v = (584, 352), (66, 86)
    fig.arrow(at, (at[0] + v[0], at[1] + v[1]), stroke=GREY)
    fig.arrow(at, (at[0], at[1] + v[1]), stroke=BLUE, width=2.5)
    fig.line((at[0] + 3, at[1] + v[1]), (at[0] + v[0], at[1] + v[1]), stroke=RED, dash="4 4")
    fig.disc(*at, 3.5)
    fig.text(at[0] + 44, at[1] + 40, "v after a sweep", color=GREY)
    fig.text(at[0] - 8, at[1] + 48, "(a·v) a", color=BLUE, anchor="end")
    fig.text(at[0] + 34, at[1] + v[1] + 18, "the guide takes this", color=RED, anchor="middle")
    fig.text(376, 510, "After each sweep only the velocity along the axis a", "is kept. The guide does no work.", color=GREY)
    fig.save()
