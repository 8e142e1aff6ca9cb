#!/usr/bin/env python3
"""Reference values for a manufactured motion of the bar at large strain, 60 digits.

    u = A f(kX) sin(wt),  w = c k,  c = sqrt(E/rho),  F = 1 + du/dX,  stress = E ln F,
    rho u_tt = d(stress)/dX + rho b,

with X and rho those of the bar at rest. f is sin if the left end is fixed and cos
if it is free; kL = n pi for like ends and (n - 1/2) pi for fixed-free. The body
force b comes from numerical derivatives of u and of the stress, not from the
closed form, which is then asserted:

    b = A f(kX) sin(wt) (c^2 k^2 / F - w^2).

Inputs are binary64 numbers, written in the shortest decimal form. Writes
manufactured.csv beside this file. Needs mpmath (1.3 or later):
python3 manufactured.py
"""
import csv
import math
import os
import random

from mpmath import cos, diff, log, mp, mpf, pi, sin, sqrt

mp.dps = 60
HERE = os.path.dirname(os.path.abspath(__file__))

# L, rho, E
BARS = [(0.1333, 7833.0, 200e9), (2.5, 3.0, 7.0)]
# left, right, mode
MODES = [("fixed", "fixed", 1), ("fixed", "fixed", 2), ("fixed", "free", 1), ("free", "free", 1)]
# A k and where the points lie
STRAINS = [(0.05, ["in"]), (0.3, ["in"]), (0.8, ["in", "left", "right"])]


def close(a, b, size, digits):
    return abs(a - b) <= size * mpf(10) ** -digits


def values(L, rho, E, left, right, mode, A, X, t):
    """v, stress, u, b."""
    L, rho, E, A, X, t = [mpf(y) for y in (L, rho, E, A, X, t)]
    c = sqrt(E / rho)
    k = (mode if left == right else mode - mpf(0.5)) * pi / L
    w = c * k

    def f(y):
        return sin(y) if left == "fixed" else cos(y)

    def u(X, t):
        return A * f(k * X) * sin(w * t)

    # Arguments kX and wt, so that the differencing step suits any size of bar.
    def stress(y):
        return E * log(1 + k * diff(lambda z: u(z / k, t), y))

    v = w * diff(lambda y: u(X, y / w), w * t)
    u_tt = w**2 * diff(lambda y: u(X, y / w), w * t, 2)
    s = stress(k * X)
    b = u_tt - k * diff(stress, k * X) / rho

    slope = A * k * (cos(k * X) if left == "fixed" else -sin(k * X)) * sin(w * t)
    closed = A * f(k * X) * sin(w * t) * (c**2 * k**2 / (1 + slope) - w**2)
    assert close(b, closed, A * w**2, 40)
    assert close(b, closed, abs(closed), 30) or close(closed, 0, A * w**2, 40)
    assert close(s, E * log(1 + slope), E * A * k, 40)
    assert close(v, A * w * f(k * X) * cos(w * t), A * w, 40)
    if X in (0, L):
        fixed = (left if X == 0 else right) == "fixed"
        assert close(u(X, t), 0, A, 40) if fixed else close(s, 0, E * A * k, 40)
    sizes = [A * w, E * A * k, A, A * w**2]
    return [mpf(0) if close(y, 0, size, 40) else y for y, size in zip([v, s, u(X, t), b], sizes)]


def main():
    rng = random.Random(1995)
    with open(os.path.join(HERE, "manufactured.csv"), "w", newline="") as points_file:
        points = csv.writer(points_file, lineterminator="\n")
        names = "length,density,modulus,left,right,mode,amplitude,x,t,velocity,stress,displacement,body_force"
        points.writerow(names.split(","))
        for L, rho, E in BARS:
            for left, right, mode in MODES:
                k = (mode if left == right else mode - 0.5) * math.pi / L
                period = 2 * math.pi / (k * math.sqrt(E / rho))
                for strain, places in STRAINS:
                    A = strain / k
                    for where in places:
                        x = {"left": 0.0, "right": L, "in": rng.uniform(0.02, 0.98) * L}[where]
                        t = rng.uniform(0.0, 2.5) * period
                        row = [repr(L), repr(rho), repr(E), left, right, mode, repr(A), repr(x), repr(t)]
                        found = values(L, rho, E, left, right, mode, A, x, t)
                        points.writerow(row + [mp.nstr(y, 25) for y in found])


if __name__ == "__main__":
    main()
