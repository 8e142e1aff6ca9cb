#!/usr/bin/env python3
"""The Dyka and Ingel bar once more, in plain Python, written from the equations.

Linear basis, lumped mass, two particles per cell, c dt / h = 1/2, up to 4 L/c.
Shares nothing with the Rust code: positions are absolute, each particle looks
up its own cell, a node sums over its particles, and the exact solution is
d'Alembert's formula with mirror images. Writes bar.csv beside this file: errors
of velocity at L and stress at 3L/4, as the root of the mean square over all
steps, relative to v0 and Z v0 / 2. Standard library only:  python3 bar.py
"""
import csv
import math
import os

HERE = os.path.dirname(os.path.abspath(__file__))
L, RHO, E, V0 = 0.1333, 7833.0, 200e9, 5.0
C, Z = math.sqrt(E / RHO), math.sqrt(E * RHO)


def thrown(x):
    """Initial velocity, continued over the ends: odd at 0, even at L."""
    x = math.fmod(x, 4 * L)
    x += 4 * L if x < 0 else 0
    sign = -1.0 if x > 2 * L else 1.0
    x = x - 2 * L if x > 2 * L else x
    x = 2 * L - x if x > L else x
    return sign * (V0 if x >= 0.75 * L else 0.0)


def exact(x, t):
    back, ahead = thrown(x - C * t), thrown(x + C * t)
    return 0.5 * (back + ahead), 0.5 * Z * (ahead - back)


class Bar:
    def __init__(self, cells):
        self.cells, self.h = cells, L / cells
        self.X = [(i + 0.25 + 0.5 * j) * self.h for i in range(cells) for j in (0, 1)]
        self.x = list(self.X)
        self.m = [RHO * self.h / 2] * len(self.x)
        self.volume = [self.h / 2] * len(self.x)
        self.v = [V0 if x >= 0.75 * L else 0.0 for x in self.x]
        self.a = [0.0] * len(self.x)
        self.s = [0.0] * len(self.x)

    def locate(self):
        """For each particle: its left node and the weights of both."""
        self.at = []
        for x in self.x:
            i = int(x / self.h)
            right = x / self.h - i
            self.at.append((i, 1.0 - right, right))

    def to_nodes(self, values):
        nodes = [0.0] * (self.cells + 2)
        for (i, left, right), value in zip(self.at, values):
            nodes[i] += left * value
            nodes[i + 1] += right * value
        return nodes

    def to_particles(self, nodes):
        return [left * nodes[i] + right * nodes[i + 1] for i, left, right in self.at]

    def mean(self, values):
        """A particle quantity at the nodes, weighted by mass; 0 at the wall."""
        total = self.to_nodes([m * q for m, q in zip(self.m, values)])
        nodes = [t / m if m > 0 else 0.0 for t, m in zip(total, self.mass)]
        nodes[0] = 0.0
        return nodes

    def acceleration(self):
        force = [0.0] * (self.cells + 2)
        for (i, _, _), s, volume in zip(self.at, self.s, self.volume):
            force[i] += s * volume / self.h
            force[i + 1] -= s * volume / self.h
        force[0] = 0.0
        return [f / m if m > 0 else 0.0 for f, m in zip(force, self.mass)]

    def strain(self, nodes, dt):
        for p, (i, _, _) in enumerate(self.at):
            d = dt * (nodes[i + 1] - nodes[i]) / self.h
            self.s[p] += E * d
            self.volume[p] *= 1.0 + d

    def tabulate(self):
        self.locate()
        self.mass = self.to_nodes(self.m)

    def move(self, dx, dv):
        self.x = [x + d for x, d in zip(self.x, self.to_particles(dx))]
        self.v = [v + d for v, d in zip(self.v, self.to_particles(dv))]


def newmark(bar, dt, old):
    """`old`: nodal velocity and acceleration of the last step."""
    if old is None:
        bar.tabulate()
        old = bar.mean(bar.v), bar.acceleration()
    v, a = old
    bar.move([dt * q + dt * dt / 2 * r for q, r in zip(v, a)], [dt / 2 * r for r in a])
    bar.tabulate()
    v = bar.mean(bar.v)
    bar.strain(v, dt)
    a = bar.acceleration()
    bar.v = [q + dt / 2 * r for q, r in zip(bar.v, bar.to_particles(a))]
    return [q + dt / 2 * r for q, r in zip(v, a)], a


def stress_last(bar, dt, _):
    bar.tabulate()
    v, a = bar.mean(bar.v), bar.acceleration()
    v = [q + dt * r for q, r in zip(v, a)]
    bar.move([dt * q for q in v], [dt * r for r in a])
    bar.strain(v, dt)


def generalized_alpha(bar, dt, _, rho=0.8):
    alpha = (2 * rho - 1) / (1 + rho)
    beta = (5 - 3 * rho) / ((1 + rho) ** 2 * (2 - rho))
    gamma = 1.5 - alpha
    bar.tabulate()
    v, old = bar.mean(bar.v), bar.mean(bar.a)
    new = [(f - alpha * o) / (1 - alpha) for f, o in zip(bar.acceleration(), old)]
    u = [dt * q + dt * dt * ((0.5 - beta) * o + beta * n) for q, o, n in zip(v, old, new)]
    bar.move(u, [dt * ((1 - gamma) * o + gamma * n) for o, n in zip(old, new)])
    bar.a = bar.to_particles(new)
    bar.strain([q / dt for q in u], dt)


def errors(scheme, cells):
    bar, steps, old = Bar(cells), 8 * cells, None
    dt = 4 * L / C / steps
    end, quarter = len(bar.x) - 1, 2 * cells * 3 // 4 - 1
    sums = [0.0, 0.0]
    for k in range(steps + 1):
        if k > 0:
            old = scheme(bar, dt, old)
        v, _ = exact(bar.X[end], k * dt)
        _, s = exact(bar.X[quarter], k * dt)
        sums[0] += (bar.v[end] - v) ** 2
        sums[1] += (bar.s[quarter] - s) ** 2
    rms = [math.sqrt(total / (steps + 1)) for total in sums]
    return rms[0] / V0, rms[1] / (Z * V0 / 2)


def main():
    schemes = [
        ("newmark", newmark),
        ("euler (last)", stress_last),
        ("generalized-α (0.8)", generalized_alpha),
    ]
    with open(os.path.join(HERE, "bar.csv"), "w", newline="", encoding="utf-8") as stream:
        out = csv.writer(stream, lineterminator="\n")
        out.writerow(["scheme", "cells", "velocity", "stress"])
        for name, scheme in schemes:
            for cells in (40, 160):
                rv, rs = errors(scheme, cells)
                out.writerow([name, cells, repr(rv), repr(rs)])


if __name__ == "__main__":
    main()
