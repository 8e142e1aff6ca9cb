#!/usr/bin/env python3
"""Reference values of local max-ent shape functions, 60 digits and more.

For a node set, a point x, gamma and the spacing h it minimises log Z over lambda
with plain Newton steps in high precision, raising gamma from a small value, and
stops when |r| < 1e-50. All inputs are binary64 numbers; they are written as
shortest decimals and as hexadecimal floats. A point exactly on the hull is
replaced by one 1e-45 h further inside: its values are the limit.

The sets slanted2 and slanted3 are a triangle and a tetrahedron. Their nodes stand at
dyadic places, so that those on a side are exactly on it; a point is made from a place
on a side, an edge or in a corner, and a distance along a direction inwards.

Writes beside this file
  lme_nodes.csv   set,node,x,y,z,x_hex,y_hex,z_hex
  lme_points.csv  point,set,domain,gamma,spacing,x,y,z,x_hex,y_hex,z_hex,
                  lambda_x,lambda_y,lambda_z
  lme_values.csv  point,node,N,dN_dx,dN_dy,dN_dz   (N above 1e-25)
Needs mpmath 1.3 or later:  python3 lme.py
"""
import csv
import os
import random

from mpmath import exp, log, matrix, mp, mpf, lu_solve, inverse, sqrt

mp.dps = 110
HERE = os.path.dirname(os.path.abspath(__file__))
GAMMAS = [1e-3, 1e-2, 0.1, 0.8, 1.8, 4.0, 6.0, 10.0, 30.0, 100.0, 300.0, 1000.0]
rng = random.Random(2006)


def grid(dimension, counts, h, origin=0.0):
    nodes = [[]]
    for n in counts:
        nodes = [node + [origin + i * h] for i in range(n) for node in nodes]
    # The first axis runs fastest, as in the program.
    return sorted(nodes, key=lambda node: node[::-1])


def scattered(counts, h, jitter):
    nodes = grid(len(counts), counts, h)
    out = []
    for node in nodes:
        place = []
        for x, n in zip(node, counts):
            edge = x == 0.0 or x == (n - 1) * h
            place.append(x if edge else x + rng.uniform(-jitter, jitter) * h)
        out.append(place)
    return out


def simplex(corners, n):
    """All lattice places of the simplex; inner ones are moved towards its last corner."""
    d, out = len(corners[0]), []

    def fill(counts, left):
        if len(counts) == d:
            counts = counts + [left]
            place = [sum(k * c[i] for k, c in zip(counts, corners)) / n for i in range(d)]
            if min(counts) > 0:
                part = (counts[1] - counts[0]) / 8
                place = [x + part * (c - x) for x, c in zip(place, corners[-1])]
            out.append(place)
            return
        for k in range(left + 1):
            fill(counts + [k], left - k)

    fill([], n)
    return out


CORNERS2 = [[0.0, 0.0], [4.0, 2.0], [1.0, 3.0]]
CORNERS3 = [[0.0, 0.0, 0.0], [4.0, 1.0, -1.0], [1.0, 4.0, 1.0], [-1.0, 1.0, 4.0]]
# A place on the hull and a direction inwards.
SLANTED = {
    "slanted2": [([1.625, 0.8125], [-1, 2]), ([0.0, 0.0], [1, 1])],
    "slanted3": [
        ([1.375, 1.75, 0.125], [-1, 1, 4]),
        ([1.5, 0.375, -0.375], [0, 1, 1]),
        ([0.0, 0.0, 0.0], [1, 2, 1]),
    ],
}

SETS = {
    "line": (grid(1, [13], 0.1), 0.1),
    "grid2": (grid(2, [7, 6], 0.1), 0.1),
    "grid3": (grid(3, [5, 4, 4], 0.1), 0.1),
    "scattered2": (scattered([7, 7], 0.1, 0.3), 0.1),
    "scattered3": (scattered([4, 4, 4], 0.1, 0.25), 0.1),
    "far": (grid(1, [13], 0.125, float(2**37)), 0.125),
    "huge": (grid(1, [13], 2.0**300), 2.0**300),
    "tiny": (grid(1, [13], 2.0**-300), 2.0**-300),
    "slanted2": (simplex(CORNERS2, 4), 1.0),
    "slanted3": (simplex(CORNERS3, 4), 1.0),
}


def moments(a, lam, gamma):
    f = [-gamma * sum(x * x for x in v) + sum(l * x for l, x in zip(lam, v)) for v in a]
    top = max(f)
    w = [exp(y - top) for y in f]
    Z = sum(w)
    p = [y / Z for y in w]
    d = len(lam)
    r = [sum(q * v[i] for q, v in zip(p, a)) for i in range(d)]
    J = matrix(d, d)
    for i in range(d):
        for j in range(d):
            J[i, j] = sum(q * (v[i] - r[i]) * (v[j] - r[j]) for q, v in zip(p, a))
    return p, r, J, top + log(Z)


def solve(a, gamma):
    """lambda (times h) with r = 0; `a` holds (x - x_I)/h."""
    d = len(a[0])
    lam = [mpf(0)] * d
    reached = min(gamma, mpf(1) / 4)
    while True:
        for _ in range(500):
            p, r, J, value = moments(a, lam, gamma=reached)
            step = lu_solve(J, -matrix(r))
            change = max(abs(sum(step[i] * (v[i] - r[i]) for i in range(d))) for v in a)
            if change < mpf(10) ** -50:
                break
            t = mpf(1)
            while change * t > mpf(1) / 2:
                trial = [lam[i] + t * step[i] for i in range(d)]
                if moments(a, trial, reached)[3] <= value:
                    break
                t /= 2
            lam = [lam[i] + t * step[i] for i in range(d)]
        else:
            raise RuntimeError("no solution")
        if reached == gamma:
            return lam, p, J
        following = min(gamma, 2 * reached)
        lam = [l * following / reached for l in lam]
        reached = following


def evaluate(nodes, x, gamma, h, inwards=()):
    h, gamma = mpf(h), mpf(gamma)
    d = len(x)
    place = [mpf(y) for y in x]
    for i in range(d):
        low, high = min(n[i] for n in nodes), max(n[i] for n in nodes)
        inside = mpf(10) ** -45 * h
        place[i] += inside if x[i] == low else -inside if x[i] == high else 0
    place = [y + inside * e for y, e in zip(place, inwards)] if inwards else place
    a = [[(place[i] - mpf(n[i])) / h for i in range(d)] for n in nodes]
    lam, p, J = solve(a, gamma)
    Jinv = inverse(J)
    grads = [[-q * sum(Jinv[i, j] * v[j] for j in range(d)) / h for i in range(d)] for q, v in zip(p, a)]
    return [l / h for l in lam], p, grads


def points():
    """(set, domain, gamma, x)"""
    for gamma in GAMMAS:
        for name in ("line", "grid2", "grid3", "scattered2", "scattered3"):
            nodes, h = SETS[name]
            d = len(nodes[0])
            low = [min(n[i] for n in nodes) for i in range(d)]
            high = [max(n[i] for n in nodes) for i in range(d)]
            few = 1 if d == 3 else 2
            for _ in range(few):
                x = [rng.uniform(low[i] + 0.3 * h, high[i] - 0.3 * h) for i in range(d)]
                yield name, "interior", gamma, x
            if not name.startswith("scattered"):
                inner = [n for n in nodes if all(low[i] < n[i] < high[i] for i in range(d))]
                yield name, "on a node", gamma, list(rng.choice(inner))
                middle = [n + 0.5 * h for n in rng.choice(inner)]
                yield name, "middle of a cell", gamma, middle
    for gamma in (1e-3, 0.8, 4.0, 30.0, 1000.0):
        for k in range(1, 17):
            yield "line", "near the hull", gamma, [10.0**-k * 0.1]
        for k in (1, 2, 4, 8, 12, 16):
            yield "grid2", "near the hull", gamma, [rng.uniform(0.15, 0.45), 10.0**-k * 0.1]
            yield "grid2", "near the hull", gamma, [10.0**-k * 0.1, 10.0**-k * 0.2]
        for k in (1, 4, 16):
            yield "grid3", "near the hull", gamma, [rng.uniform(0.1, 0.3), 0.17, 10.0**-k * 0.1]
            yield "scattered2", "near the hull", gamma, [rng.uniform(0.15, 0.45), 10.0**-k * 0.1]
        yield "line", "on the hull", gamma, [0.0]
        yield "line", "on the hull", gamma, [SETS["line"][0][-1][0]]
        yield "grid2", "on the hull", gamma, [rng.uniform(0.15, 0.45), 0.0]
        yield "grid2", "on the hull", gamma, [0.0, 0.0]
        yield "grid3", "on the hull", gamma, [rng.uniform(0.1, 0.3), 0.17, 0.0]
        for name in ("far", "huge", "tiny"):
            nodes, h = SETS[name]
            x = nodes[0][0] + rng.uniform(0.5, 11.5) * h
            yield name, {"far": "2^40 h away"}.get(name, "h = 2^±300"), gamma, [x]


def slanted():
    """The same, and a direction inwards where the point is exactly on the hull."""
    for name, places in SLANTED.items():
        for n, (place, inwards) in enumerate(places):
            length = sqrt(sum(mpf(e) ** 2 for e in inwards))
            for k in (0.3, 1e-3, 1e-6, 1e-8, 1e-10, 1e-12, 1e-15, 0):
                if k == 0 and place[0] == 0:
                    continue  # in a corner the limit depends on the direction
                x = [float(mpf(y) + mpf(k) * e / length) for y, e in zip(place, inwards)]
                domain = ("near a slanted side" if k else "on a slanted side")
                yield name, domain, (0.8, 1.8, 4.0)[n], x, () if k else inwards


def pad(values, n=3):
    return list(values) + [""] * (n - len(values))


def main():
    def writer(name):
        stream = open(os.path.join(HERE, name), "w", newline="")
        return stream, csv.writer(stream, lineterminator="\n")

    (nodes_file, nodes_csv), (points_file, points_csv), (values_file, values_csv) = map(
        writer, ("lme_nodes.csv", "lme_points.csv", "lme_values.csv")
    )
    nodes_csv.writerow("set,node,x,y,z,x_hex,y_hex,z_hex".split(","))
    for name, (nodes, _) in SETS.items():
        for n, node in enumerate(nodes):
            row = pad([repr(float(x)) for x in node]) + pad([float(x).hex() for x in node])
            nodes_csv.writerow([name, n] + row)
    points_csv.writerow(
        "point,set,domain,gamma,spacing,x,y,z,x_hex,y_hex,z_hex,lambda_x,lambda_y,lambda_z".split(",")
    )
    values_csv.writerow("point,node,N,dN_dx,dN_dy,dN_dz".split(","))
    for n, (name, domain, gamma, x, *inwards) in enumerate([*points(), *slanted()]):
        nodes, h = SETS[name]
        lam, p, grads = evaluate(nodes, x, gamma, h, *inwards)
        digits = lambda y: mp.nstr(y, 25)
        infinite = domain.startswith("on ") and domain != "on a node"
        points_csv.writerow(
            [n, name, domain, repr(gamma), repr(h)]
            + pad([repr(float(y)) for y in x])
            + pad([float(y).hex() for y in x])
            + pad(["" if infinite else digits(l) for l in lam])
        )
        for node, (N, g) in enumerate(zip(p, grads)):
            if N > mpf(10) ** -25 or max(abs(y) for y in g) * mpf(h) > mpf(10) ** -25:
                values_csv.writerow([n, node, digits(N)] + pad([digits(y) for y in g]))
    for stream in (nodes_file, points_file, values_file):
        stream.close()


if __name__ == "__main__":
    main()
