#!/usr/bin/env python3
"""Writes the meshes of configs/meshes: floors for the validation scenes, and the terrain of demo 15.

    meshes.py [FOLDER]   default: configs/meshes
"""
import math
import random
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def grid(columns, rows, place, flip=lambda i, j: (i + j) % 2 == 0):
    """Returns vertices and triangles of columns x rows cells; place(i, j) gives the position of a vertex, and flip(i, j) the diagonal of a cell."""
    vertices = [place(i, j) for j in range(rows + 1) for i in range(columns + 1)]
    at = lambda i, j: j * (columns + 1) + i
    triangles = []
    for j in range(rows):
        for i in range(columns):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            triangles += [(a, b, c), (a, c, d)] if flip(i, j) else [(a, b, d), (b, c, d)]
    return vertices, triangles


def write(path, about, vertices, triangles, digits=17):
    lines = [f"# {about}", "# Written by scripts/meshes.py."]
    lines += ["v " + " ".join(f"{x:.{digits}g}" for x in v) for v in vertices]
    lines += ["f " + " ".join(str(k + 1) for k in t) for t in triangles]
    path.write_text("\n".join(lines) + "\n")
    print(f"{path}: {len(triangles)} triangles, {path.stat().st_size / 1000:.0f} kB")


def floor():
    """Makes a floor of 20 x 4 m about the origin. Corners of its cells of 0.25 m are moved at random, so that no two edges inside are in line."""
    draw = random.Random(3)
    columns, rows, cell = 80, 16, 0.25

    def place(i, j):
        inner = 0 < i < columns and 0 < j < rows
        dx, dy = (draw.uniform(-0.3, 0.3) * cell if inner else 0 for _ in range(2))
        return (i - columns / 2) * cell + dx, (j - rows / 2) * cell + dy, 0.0

    return grid(columns, rows, place, lambda i, j: draw.random() < 0.5)


def bent(slope_before, slope_after):
    """Makes two planes that meet in the y axis; slopes are dz/dx."""
    columns, rows, cell = 32, 8, 0.25

    def place(i, j):
        x = (i - columns / 2) * cell
        return x, (j - rows / 2) * cell, x * (slope_before if x < 0 else slope_after)

    return grid(columns, rows, place)


def pyramid():
    """Makes a pyramid with its top at the origin, over a square; its faces have a slope of 1/2."""
    base = [(-1, -1, -0.5), (1, -1, -0.5), (1, 1, -0.5), (-1, 1, -0.5)]
    return [(0, 0, 0)] + base, [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 1)]


class Noise:
    """Value noise: random numbers on a lattice, blended smoothly."""

    def __init__(self, seed):
        draw = random.Random(seed)
        self.values = [[draw.uniform(-1, 1) for _ in range(64)] for _ in range(64)]

    def __call__(self, x, y):
        i, j = math.floor(x), math.floor(y)
        u, v = x - i, y - j
        u, v = u * u * (3 - 2 * u), v * v * (3 - 2 * v)
        at = lambda a, b: self.values[(i + a) % 64][(j + b) % 64]
        return (at(0, 0) * (1 - u) + at(1, 0) * u) * (1 - v) + (at(0, 1) * (1 - u) + at(1, 1) * u) * v


def terrain():
    """Makes a gully that comes down from a steep flank, bends, and fans out on a plain; 44 x 30 m."""
    noise = Noise(8)
    columns, rows = 88, 60

    def height(x, y):
        # x goes from the top of the flank (0 m) to the plain (44 m).
        flank = 17 * (1 - math.tanh((x - 9) / 9.5)) / 2 + 3.5 * max(0, 1 - x / 24)
        middle = 2.6 * math.sin(x / 6.5) * math.exp(-((x - 16) / 14) ** 2)
        open_ = 1 / (1 + math.exp((x - 27) / 2.5))
        aside = abs(y - middle)
        gully = 3.4 * open_ * (1 - math.exp(-((aside / 4.2) ** 2.2))) + 0.10 * open_ * max(0.0, aside - 5)
        rough = 0.55 * noise(0.28 * x + 3, 0.28 * y + 9) + 0.22 * noise(0.75 * x, 0.75 * y) + 0.09 * noise(1.7 * x, 1.7 * y)
        berm = 2.2 * math.exp(-(((x - 40.5) / 1.6) ** 2))
        return flank + gully + rough * (0.35 + 0.65 * open_ + 0.5 * min(1, aside / 8) * open_) + berm

    draw = random.Random(5)

    def place(i, j):
        inner = 0 < i < columns and 0 < j < rows
        x = 0.5 * i + (draw.uniform(-0.13, 0.13) if inner else 0)
        y = 0.5 * (j - rows / 2) + (draw.uniform(-0.13, 0.13) if inner else 0)
        return x, y, height(x, y)

    return grid(columns, rows, place, lambda i, j: draw.random() < 0.5)


def bowl():
    """Makes a bowl of revolution, 0.75 m deep and 1.25 m to its rim, with a wall that gets steep."""
    around, up = 64, 22

    def place(i, j):
        r = 1.25 * (j / up) ** 0.8
        angle = 2 * math.pi * (i + 0.5 * (j % 2)) / around
        return r * math.cos(angle), r * math.sin(angle), 0.75 * (r / 1.25) ** 2.6

    vertices = [(0.0, 0.0, 0.0)]
    triangles = []
    for j in range(1, up + 1):
        vertices += [place(i, j) for i in range(around)]
    at = lambda i, j: 0 if j == 0 else 1 + (j - 1) * around + i % around
    for j in range(up):
        for i in range(around):
            shift = j % 2
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            if j == 0:
                triangles.append((0, d, c))
            elif shift:
                triangles += [(a, b, c), (a, c, d)]
            else:
                triangles += [(a, b, d), (b, c, d)]
    return vertices, triangles


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "configs/meshes"
    folder.mkdir(parents=True, exist_ok=True)
    write(folder / "floor.obj", "A level floor of uneven triangles.", *floor())
    write(folder / "ridge.obj", "Two slopes of 1 in 5 that meet in a ridge along y.", *bent(0.2, -0.2))
    write(folder / "rise.obj", "A level floor, and from x = 0 on a slope of 3 in 4.", *bent(0.0, 0.75))
    write(folder / "pyramid.obj", "Four triangles with their top at the origin.", *pyramid())
    write(folder / "bowl.obj", "A bowl.", *bowl(), digits=7)
    write(folder / "terrain.obj", "A gully between slopes.", *terrain(), digits=6)


if __name__ == "__main__":
    main()
