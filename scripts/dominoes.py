#!/usr/bin/env python3
"""dominoes.py > configs/11_dominoes.csv: prints a body file of scree with dominoes along a curve, each across it.

The curve is a spiral of Archimedes: its arm grows by PITCH a turn. Sizes are those of a real domino, in metres.
"""

import math

SIZE = (0.0075, 0.024, 0.048)  # thickness along the curve, width, height
GAP = 0.024  # between centres along the curve
INNER, PITCH, TURNS = 0.12, 0.075, 4.25


def curve(angle):
    """Returns point and direction (rad) of the spiral at an angle, and the arc length per radian."""
    radius = INNER + PITCH * angle / (2 * math.pi)
    slope = PITCH / (2 * math.pi)
    x, y = radius * math.cos(angle), radius * math.sin(angle)
    dx = slope * math.cos(angle) - y
    dy = slope * math.sin(angle) + x
    return x, y, math.atan2(dy, dx), math.hypot(dx, dy)


def main():
    print("shape,size_x,size_y,size_z,x,y,z,qw,qx,qy,qz")
    angle = 0.0
    while angle < 2 * math.pi * TURNS:
        x, y, heading, speed = curve(angle)
        turn = (math.cos(heading / 2), 0, 0, math.sin(heading / 2))
        row = (*SIZE, x, y, SIZE[2] / 2, *turn)
        print("box," + ",".join(f"{value:.9g}" for value in row))
        angle += GAP / speed


if __name__ == "__main__":
    main()
