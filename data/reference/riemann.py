#!/usr/bin/env python3
"""Reference values for the elastic bar: d'Alembert by images, 60 digits.

Independent of src/method/exact/riemann.rs: no characteristic is followed. The initial
velocity is continued over the ends (odd at a fixed end, even at a free one) and

    v = (V(x - ct) + V(x + ct)) / 2,   s = Z (V(x + ct) - V(x - ct)) / 2,
    u = 1/(2c) * integral of V from x - ct to x + ct.

Inputs are binary64 numbers, written in the shortest decimal form. Points nearer
than 1e-9 L to a front are left out. Writes riemann_bars.csv and riemann.csv
beside this file. Needs mpmath (1.3 or later):  python3 riemann.py
"""
import csv
import os
import random

from mpmath import floor, mp, mpf, sqrt

mp.dps = 60
HERE = os.path.dirname(os.path.abspath(__file__))

# name, L, rho, E, left, right, patches (from, to, velocity)
BARS = [
    ("dyka", 0.1333, 7833.0, 200e9, "fixed", "free", [(0.099975, 0.1333, 5.0)]),
    ("fixed-fixed", 1.0, 1.0, 1.0, "fixed", "fixed", [(0.0, 0.3, 2.0), (0.5, 0.7, -1.25)]),
    ("free-free", 2.5, 1000.0, 7e6, "free", "free", [(0.4, 1.1, 3.0), (1.9, 2.5, 1.0)]),
    ("free-fixed", 3.7, 2.2, 9.1, "free", "fixed", [(1.3, 3.7, -0.8)]),
]


class Bar:
    def __init__(self, L, rho, E, left, right, patches):
        self.L, self.rho, self.E = mpf(L), mpf(rho), mpf(E)
        self.c, self.Z = sqrt(self.E / self.rho), sqrt(self.E * self.rho)
        self.left = -1 if left == "fixed" else 1
        self.right = -1 if right == "fixed" else 1
        self.patches = [(mpf(a), mpf(b), mpf(v)) for a, b, v in patches]
        self.once = self.integral_once(2 * self.L)

    def inside(self, x):
        return sum((v for a, b, v in self.patches if a <= x < b), mpf(0))

    def reduce(self, x):
        """x = 2L n + rest, and the sign of the n-th image."""
        n = int(floor(x / (2 * self.L)))
        sign = self.left * self.right
        return n, x - 2 * self.L * n, sign ** (n % 2)

    def V(self, x):
        _, rest, sign = self.reduce(x)
        if rest <= self.L:
            return sign * self.inside(rest)
        return sign * self.right * self.inside(2 * self.L - rest)

    def integral_once(self, x):
        """Integral of V from 0 to x, 0 <= x <= 2L."""
        total = mpf(0)
        for a, b, v in self.patches:
            total += v * max(mpf(0), min(x, b) - a)
            total += v * self.right * max(mpf(0), min(x, 2 * self.L - a) - (2 * self.L - b))
        return total

    def integral(self, x):
        n, rest, sign = self.reduce(x)
        whole = n if self.left * self.right == 1 else n % 2
        return whole * self.once + sign * self.integral_once(rest)

    def at(self, x, t):
        x, s = mpf(x), self.c * mpf(t)
        back, ahead = self.V(x - s), self.V(x + s)
        u = (self.integral(x + s) - self.integral(x - s)) / (2 * self.c)
        return (back + ahead) / 2, self.Z * (ahead - back) / 2, u

    def near_front(self, x, t):
        x, s = mpf(x), self.c * mpf(t)
        edges = [e for a, b, _ in self.patches for e in (a, b)] + [mpf(0), self.L]
        for foot in (x - s, x + s):
            _, rest, _ = self.reduce(foot)
            rest = min(rest, 2 * self.L - rest)
            if any(abs(rest - e) < self.L * mpf(10) ** -9 for e in edges):
                return True
        return False


def main():
    rng = random.Random(1995)
    with open(os.path.join(HERE, "riemann_bars.csv"), "w", newline="") as bars_file, open(
        os.path.join(HERE, "riemann.csv"), "w", newline=""
    ) as points_file:
        bars = csv.writer(bars_file, lineterminator="\n")
        points = csv.writer(points_file, lineterminator="\n")
        bars.writerow(["bar", "length", "density", "modulus", "left", "right", "patches"])
        points.writerow(["bar", "x", "t", "velocity", "stress", "displacement"])
        for name, L, rho, E, left, right, patches in BARS:
            text = ";".join(":".join(repr(number) for number in patch) for patch in patches)
            bars.writerow([name, repr(L), repr(rho), repr(E), left, right, text])
            bar = Bar(L, rho, E, left, right, patches)
            transit = L / float(bar.c)
            for longest in (1.0, 4.0, 40.0, 1e3, 1e4, 1e9, 2.0**44, 2.0**50):
                written = 0
                while written < 12:
                    x = rng.choice([0.0, L, rng.uniform(0.0, L), rng.uniform(0.0, L)])
                    t = rng.uniform(0.0, longest) * transit
                    if bar.near_front(x, t):
                        continue
                    v, s, u = bar.at(x, t)
                    points.writerow([name, repr(x), repr(t)] + [mp.nstr(y, 25) for y in (v, s, u)])
                    written += 1


if __name__ == "__main__":
    main()
