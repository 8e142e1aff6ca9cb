#!/usr/bin/env python3
"""Reference values for motions at finite strain in one to three dimensions, 40 digits.

Modes:   u_i = A sin(k_i X_i) sin(wt + q_i), k_i = n pi / L_i, in a box.
Vortex:  a point at the distance R of the centre turns by a = A sin(wt) q(R/R0),
         q(s) = 1 - 32 (s-1)^2 + 256 (s-1)^4 for 3/4 < s < 5/4.

Nothing but the motion is written down: F = 1 + du/dX, v and the acceleration by
numerical derivatives of u, the stress from F by its law,

    neo-hookean  J sigma = lam ln J 1 + mu (F F^T - 1),
    hencky       J sigma = lam ln J 1 + mu ln(F F^T),
    rate           sigma = lam ln J 1 + mu ln(F F^T)   (for diagonal F),

and b = u_tt - Div P / rho with P = J sigma F^-T by numerical derivatives again.
Writes moved.csv beside this file. Needs mpmath (1.3 or later): python3 moved.py
"""
import csv
import os
import random

from mpmath import atan2, cos, det, diff, eighe, hypot, inverse, log, matrix, mp, mpf, pi, sin

mp.dps = 40
HERE = os.path.dirname(os.path.abspath(__file__))
WORKING = 60  # digits while differentiating twice


def identity(d):
    return matrix([[mpf(i == j) for j in range(d)] for i in range(d)])


def log_of(b):
    """ln b of a symmetric matrix."""
    values, Q = eighe(b)
    d = b.rows
    return matrix([[sum(log(values[n]) * Q[i, n] * Q[j, n] for n in range(d)) for j in range(d)]
                   for i in range(d)])


def stress(law, lam, mu, F):
    J, b, one = det(F), F * F.T, identity(F.rows)
    shape = b - one if law == "neo-hookean" else log_of(b)
    return (lam * log(J) * one + mu * shape) / (1 if law == "rate" else J)


class Motion:
    def __init__(self, d, u, law, lam, mu, rho):
        self.d, self.u, self.law, self.lam, self.mu, self.rho = d, u, law, lam, mu, rho

    def F(self, X, t):
        rows = []
        for i in range(self.d):
            row = []
            for j in range(self.d):
                along = lambda y, j=j: self.u([*X[:j], y, *X[j + 1:]], t)[i]
                row.append(diff(along, X[j]) + (i == j))
            rows.append(row)
        return matrix(rows)

    def P(self, X, t):
        F = self.F(X, t)
        return det(F) * stress(self.law, self.lam, self.mu, F) * inverse(F).T

    def values(self, X, t):
        d = self.d
        F = self.F(X, t)
        sigma = stress(self.law, self.lam, self.mu, F)
        v = [diff(lambda s, i=i: self.u(X, s)[i], t) for i in range(d)]
        b = []
        for i in range(d):
            force = diff(lambda s: self.u(X, s)[i], t, 2)
            for j in range(d):
                along = lambda y: self.P([*X[:j], y, *X[j + 1:]], t)[i, j]
                force -= diff(along, X[j]) / self.rho
            b.append(force)
        return self.u(X, t), v, sigma, b


def modes(d, A, k, w, q):
    return lambda X, t: [A * sin(k[i] * X[i]) * sin(w * t + q[i]) for i in range(d)]


def vortex(A, R0, w, centre):
    def u(X, t):
        x, y = X[0] - centre[0], X[1] - centre[1]
        R = hypot(x, y)
        e = R / R0 - 1
        a = A * sin(w * t) * (1 - 32 * e**2 + 256 * e**4)
        theta = atan2(y, x) + a
        return [R * cos(theta) - x, R * sin(theta) - y]
    return u


def main():
    rng = random.Random(2008)
    names = ["case", "law", "dimension", "E", "nu", "density", "amplitude", "frequency"]
    names += [f"{n}_{a}" for n in ("length", "phase", "X") for a in "xyz"] + ["mode", "radius", "t"]
    names += [f"{n}_{a}" for n in "uvb" for a in "xyz"]
    names += [f"sigma_{a}{b}" for a, b in ("xx", "xy", "xz", "yy", "yz", "zz")]
    with open(os.path.join(HERE, "moved.csv"), "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(names)
        cases = [("modes", law, d) for d in (1, 2, 3) for law in ("rate", "neo-hookean", "hencky")]
        cases += [("vortex", "neo-hookean", 2)] * 4
        for case, law, d in cases:
            for _ in range(2):
                E, nu, rho, w = 7.0, 0.3, 1.5, 2.25
                length = [1.5, 1.0, 0.75][:d] if case == "modes" else [3.0, 3.25]
                t = rng.uniform(0.1, 2.0)
                mp.dps = WORKING
                lam = mpf(E) * mpf(nu) / ((1 + mpf(nu)) * (1 - 2 * mpf(nu)))
                mu = mpf(E) / (2 * (1 + mpf(nu)))
                if case == "modes":
                    A, n, phase = 0.0625, 1 + (d == 1), [0.0, 1.0, 2.5][:d]
                    X = [rng.uniform(0.05, 0.95) * L for L in length]
                    k = [n * pi / mpf(L) for L in length]
                    u, radius = modes(d, mpf(A), k, mpf(w), [mpf(q) for q in phase]), ""
                else:
                    A, n, radius, phase = 1.0, "", 1.125, ["", ""]
                    R, angle = rng.uniform(0.8, 1.2) * radius, rng.uniform(-3.0, 3.0)
                    X = [float(L / 2 + R * f(angle)) for L, f in zip(length, (cos, sin))]
                    u = vortex(mpf(A), mpf(radius), mpf(w), [mpf(L) / 2 for L in length])
                motion = Motion(d, u, law, lam, mu, mpf(rho))
                u_, v, sigma, b = motion.values([mpf(x) for x in X], mpf(t))
                pad = lambda a: [*a, *[""] * (3 - len(a))]
                text = lambda a: pad([mp.nstr(x, 25) for x in a])
                upper = [[0, 0], [0, 1], [0, 2], [1, 1], [1, 2], [2, 2]]
                tensor = [mp.nstr(sigma[i, j], 25) if j < d else "" for i, j in upper]
                given = [case, law, d, repr(E), repr(nu), repr(rho), repr(A), repr(w)]
                given += pad([repr(x) for x in length])
                given += pad([repr(q) if q != "" else "" for q in phase])
                given += pad([repr(x) for x in X]) + [n, repr(radius) if radius != "" else "", repr(t)]
                out.writerow(given + text(u_) + text(v) + text(b) + tensor)


if __name__ == "__main__":
    main()
