#!/usr/bin/env python3
"""The motion across cells once more, with two kinds of B-splines at the walls, in numpy.

Shares nothing with the Rust code. "centred" are the B-splines of the program: centred at the
nodes, with the function that is missing at a wall carried by linear extrapolation. "open" are
those of an open knot vector, whose pieces end with the cells. Everything else is the same: the
Algorithm with either mass matrix, forces by the sum over the particles, or by three Gauss points
in each cell and a stress that is fitted by least squares, in each cell or about each point.

Writes walls.csv beside this file: errors of velocity, stress and displacement, as the root of
the mean square over particles and steps, relative to A omega, E A k and A; "ends" where the velocity has grown a hundredfold.
Some minutes; needs
numpy:  python3 walls.py
"""
import csv
import os

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
CELLS, LENGTH, RHO, E, A, END = 160, 1.0, 1000.0, 1e7, 0.0625, 0.02
H, C, K = LENGTH / CELLS, 100.0, np.pi
OMEGA = C * K


def exact(X, t):
    """v, sigma, u and the body force of u = A sin(kX) sin(omega t)."""
    F = 1 + A * K * np.cos(K * X) * np.sin(OMEGA * t)
    u = A * np.sin(K * X) * np.sin(OMEGA * t)
    v = A * OMEGA * np.sin(K * X) * np.cos(OMEGA * t)
    return v, E * np.log(F), u, u * ((K * C) ** 2 / F - OMEGA**2)


def knots(degree, kind):
    """Knots in units of a cell: with the cells and repeated at the walls, or half a function to
    either side of every node and of one beyond each wall."""
    if kind == "open":
        return np.concatenate(([0] * degree, np.arange(CELLS + 1.0), [CELLS] * degree))
    half = (degree + 1) / 2
    return np.arange(-1 - half, CELLS + 1.5 + half)


def cox_de_boor(t, degree, x):
    """All functions and slopes at x (in cells) as two arrays, by the recurrence."""
    N = ((t[:-1] <= x[:, None]) & (x[:, None] < t[1:])).astype(float)
    for p in range(1, degree + 1):
        left, right = t[p:-1] - t[: -p - 1], t[p + 1 :] - t[1:-p]
        a = np.divide(1, left, out=np.zeros_like(left), where=left > 0)
        b = np.divide(1, right, out=np.zeros_like(right), where=right > 0)
        slope = p * (N[:, :-1] * a - N[:, 1:] * b)
        N = (x[:, None] - t[: -p - 1]) * a * N[:, :-1] + (t[p + 1 :] - x[:, None]) * b * N[:, 1:]
    return N, slope


def basis(x, degree, kind):
    """N and dN/dx (1/m) of all functions at the places x (m)."""
    place = np.clip(x / H, 0, CELLS * (1 - 1e-15))
    tables = cox_de_boor(knots(degree, kind), degree, place)
    if kind == "open":
        return tables[0], tables[1] / H
    for table in tables:
        for beyond, end, inner in ((0, 1, 2), (-1, -2, -3)):
            table[:, end] += 2 * table[:, beyond]
            table[:, inner] -= table[:, beyond]
    return tables[0][:, 1:-1], tables[1][:, 1:-1] / H


def hat(s):
    """The quadratic B-spline of width 1."""
    s = np.abs(s)
    return np.where(s <= 0.5, 0.75 - s * s, np.where(s < 1.5, 0.5 * (1.5 - s) ** 2, 0))


def fitted(rule, points, x, sigma):
    """The stress at Gauss's points: degree 2 about each, or degree 1 in each cell."""
    order = np.argsort(x)
    x, sigma = x[order], sigma[order]
    if rule == "MLS 2":
        low, high = (np.searchsorted(x, points + side * H) for side in (-1.5, 1.5))
        at = np.zeros(len(points))
    else:
        cell = np.floor(points / H)
        low, high = np.searchsorted(x, cell * H), np.searchsorted(x, (cell + 1) * H)
        at = (points - (cell + 0.5) * H) / H
    near = low[:, None] + np.arange(max(high - low))
    here = near < high[:, None]
    near = np.minimum(near, len(x) - 1)
    if rule == "MLS 2":
        s, powers = (x[near] - points[:, None]) / H, 3
        w = np.where(here, hat(s), 0)
    else:
        s, powers = (x[near] - (np.floor(points / H)[:, None] + 0.5) * H) / H, 2
        w = here.astype(float)
    P = np.stack([s**n for n in range(powers)], -1)
    M = np.einsum("gm,gma,gmb->gab", w, P, P)
    b = np.einsum("gm,gma,gm->ga", w, P, sigma[near])
    few = high - low < powers  # a cell with one particle has no slope
    M[few, 1:, :], M[few, :, 1:], b[few, 1:] = 0, 0, 0
    M[few] += np.diag([0] + [1] * (powers - 1))
    a = np.linalg.solve(M, b[..., None])[..., 0]
    return sum(a[:, n] * at**n for n in range(powers))


def gauss(kind):
    """Places (m) and weights (m): three to a cell, or two to each half."""
    if kind == "open":
        local = 0.5 + 0.5 * np.array([-np.sqrt(0.6), 0, np.sqrt(0.6)])
        weights = np.array([5, 8, 5]) / 18
    else:
        pair = 0.25 * np.array([-1, 1]) / np.sqrt(3)
        local = np.concatenate((0.25 + pair, 0.75 + pair))
        weights = np.full(4, 0.25)
    return (np.arange(CELLS)[:, None] + local).ravel() * H, np.tile(weights * H, CELLS)


def divided(q, mass):
    """M^-1 q between the walls, where it is 0."""
    inner = q[1:-1] / mass[1:-1] if mass.ndim == 1 else np.linalg.solve(mass[1:-1, 1:-1], q[1:-1])
    return np.concatenate(([0], inner, [0]))


def errors(degree, kind, rule, consistent, per_cell):
    X = (np.arange(CELLS * per_cell) + 0.5) * H / per_cell
    m = np.full(len(X), RHO * H / per_cell)
    x, v, sigma = X.copy(), exact(X, 0)[0], np.zeros(len(X))
    rho, a = np.full(len(X), RHO), np.zeros(len(X))
    steps = round(END * C / (H * (0.1 if consistent else 0.2)))
    if rule in ("TLS 1", "MLS 2"):
        points, weights = gauss(kind)
        slopes = basis(points, degree, kind)[1]
    sums = np.zeros(3)
    for k in range(steps + 1):
        t, dt = END * k / steps, END / steps if k else 0.0
        if k:
            x = x + dt * (N @ v_I) + 0.5 * dt * dt * a
            v = v + 0.5 * dt * a
        N, G = basis(x, degree, kind)
        mass = N.T @ (m[:, None] * N) if consistent else N.T @ m
        v_I = divided(N.T @ (m * v), mass)
        strain = dt * (G @ v_I)
        rho, sigma = rho / (1 + strain), sigma + E * strain
        if rule == "null-space":
            cell = np.clip((x / H).astype(int), 0, CELLS - 1)
            V, S = (np.bincount(cell, m / rho * q, CELLS) for q in (np.ones(len(x)), sigma))
            sigma = S[cell] / V[cell]
        if rule in ("TLS 1", "MLS 2"):
            f = -slopes.T @ (weights * fitted(rule, points, x, sigma))
        else:
            f = -G.T @ (m / rho * sigma)
        right = exact(X, t)
        a_I = divided(f + N.T @ (m * right[3]), mass)
        v_I, a = v_I + 0.5 * dt * a_I, N @ a_I
        v = v + 0.5 * dt * a
        if not np.max(np.abs(v)) < 100 * A * OMEGA:
            return None
        if k:
            off = [(v - right[0]) / (A * OMEGA), (sigma - right[1]) / (E * A * K), (x - X - right[2]) / A]
            sums += [np.mean(d * d) for d in off]
    return np.sqrt(sums / steps)


ROWS = [
    (2, "sum", True, 2),
    (2, "sum", True, 4),
    (3, "sum", True, 2),
    (3, "sum", True, 4),
    (2, "null-space", False, 2),
    (2, "null-space", False, 4),
    (2, "TLS 1", False, 2),
    (2, "TLS 1", False, 4),
    (2, "MLS 2", False, 2),
    (2, "MLS 2", False, 4),
    (2, "MLS 2", True, 2),
]

if __name__ == "__main__":
    with open(os.path.join(HERE, "walls.csv"), "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow("degree,forces,mass,per_cell,walls,velocity,stress,displacement".split(","))
        for degree, rule, consistent, per_cell in ROWS:
            for kind in ("centred", "open"):
                found = errors(degree, kind, rule, consistent, per_cell)
                mass = "consistent" if consistent else "lumped"
                numbers = ["ends"] * 3 if found is None else [f"{error:.2e}" for error in found]
                row = [degree, rule, mass, per_cell, kind] + numbers
                out.writerow(row)
                print(*row, flush=True)
