#!/usr/bin/env python3
"""Reference values for the loaded elastic bar: images about the static solution, 60 digits.

Follows no characteristic. For a load switched on at t = 0 and then held,

    u = p(x) + a t^2/2 + w,      M p'' = rho (a - b),

where p carries the body force b and the end tractions and a is the rigid
acceleration (zero unless both ends are free). w is the free vibration from
w = -p, continued over the ends (odd at a fixed end, even at a free one):

    w = (W(x - ct) + W(x + ct)) / 2.

The initial velocity patch is added as in riemann.py. A load that grows as
min(t/T, 1) is Duhamel's mean of the held-load answer over switch-on times,

    u = 1/T * integral of u_held(t - s), s from 0 to min(t, T),

split at the kinks. Every piece is a polynomial of degree 2 or less, so the
two-point Gauss rule gives it exactly.

Tractions act along +x: the stress is -traction_left at a free left end and
traction_right at a free right end. Ramp 0 means a held load. Inputs are
binary64 numbers, written in the shortest decimal form. Points nearer than
1e-3 L to a front or kink are left out. At t = 0 the load has just been put on:
the bar is unstressed. Each case is checked against the wave equation, the end
and starting conditions, and a modal series. Writes loads.csv beside this file.
Needs mpmath (1.3 or later):  python3 loads.py
"""
import csv
import math
import os
import random

from mpmath import floor, mp, mpf, sqrt

mp.dps = 60
HERE = os.path.dirname(os.path.abspath(__file__))
HELD = (0.0, 0.0)

# name, L, rho, M, then sizes: plain gravity, plain traction, and for the
# combined case gravity, traction and patch velocity
BARS = [
    ("dyka", 0.1333, 7833.0, 200e9, 9.81, 2.5e6, 1.2e5, 6e7, 5.0),
    ("odd", 2.5, 3.0, 7.0, -0.37, 0.9, 0.21, -1.3, 0.4),
]

# name, left, right, gravity, traction left, traction right (in the sizes above),
# ramps of gravity and traction (in L/c), patch from and to (in L) or None
CASES = [
    ("gravity-fixed-free", "fixed", "free", 1, 0, 0, HELD, None),
    ("gravity-free-fixed", "free", "fixed", 1, 0, 0, HELD, None),
    ("gravity-fixed-fixed", "fixed", "fixed", 1, 0, 0, HELD, None),
    ("gravity-free-free", "free", "free", 1, 0, 0, HELD, None),
    ("gravity-ramp-fixed-free", "fixed", "free", 1, 0, 0, (0.7, 0.0), None),
    ("gravity-ramp-fixed-fixed", "fixed", "fixed", 1, 0, 0, (3.3, 0.0), None),
    ("traction-fixed-free", "fixed", "free", 0, 0, 1, HELD, None),
    ("traction-free-fixed", "free", "fixed", 0, 1, 0, HELD, None),
    ("traction-ramp-fixed-free", "fixed", "free", 0, 0, 1, (0.0, 1.9), None),
    ("traction-free-free", "free", "free", 0, 0, 1, HELD, None),
    ("combined-fixed-free", "fixed", "free", 1, 0, 1, HELD, (0.31, 0.74)),
    ("combined-ramp-fixed-free", "fixed", "free", 1, 0, 1, (0.7, 1.9), (0.31, 0.74)),
]

COLUMNS = (
    "case,length,density,modulus,left,right,body_force,body_ramp,traction_left,"
    "traction_right,traction_ramp,patch_from,patch_to,patch_velocity,"
    "x,t,velocity,stress,displacement"
)


class Bar:
    def __init__(self, L, rho, M, left, right, body, body_ramp, pull_left, pull_right, pull_ramp, patch):
        self.L, self.rho, self.M = mpf(L), mpf(rho), mpf(M)
        self.c, self.Z = sqrt(self.M / self.rho), sqrt(self.M * self.rho)
        self.fixed_left, self.fixed_right = left == "fixed", right == "fixed"
        self.body, self.body_ramp = mpf(body), mpf(body_ramp)
        self.pull_left, self.pull_right, self.pull_ramp = mpf(pull_left), mpf(pull_right), mpf(pull_ramp)
        self.patch = [mpf(y) for y in patch]
        self.body_part = self.particular(self.body, mpf(0), mpf(0))
        self.pull_part = self.particular(mpf(0), self.pull_left, self.pull_right)

    def particular(self, b, left, right):
        """a and the coefficients of p = p0 + p1 x + p2 x^2."""
        free = not (self.fixed_left or self.fixed_right)
        a = b + (left + right) / (self.rho * self.L) if free else mpf(0)
        p2 = self.rho * (a - b) / (2 * self.M)
        if not self.fixed_left:
            p1 = -left / self.M
        elif not self.fixed_right:
            p1 = right / self.M - 2 * p2 * self.L
        else:
            p1 = -p2 * self.L
        p0 = -(p1 + p2 * self.L) * self.L if self.fixed_right else mpf(0)
        return a, p0, p1, p2

    def fold(self, y):
        """Image cell of y, sign of the value there, sign of dx/dy, and x in the bar."""
        j = int(floor(y / self.L))
        left, right = -1 if self.fixed_left else 1, -1 if self.fixed_right else 1
        sign = [1, right, right * left, left][j % 4]
        rest = y - j * self.L
        return (j, sign, 1, rest) if j % 2 == 0 else (j, sign, -1, self.L - rest)

    def held(self, part, x, t):
        """v, stress, u at time t of a load held from time 0."""
        a, p0, p1, p2 = part
        W, slope = [], []
        for y in (x - self.c * t, x + self.c * t):
            _, sign, turn, z = self.fold(y)
            W.append(-sign * (p0 + p1 * z + p2 * z * z))
            slope.append(-sign * turn * (p1 + 2 * p2 * z))
        v = a * t + self.c * (slope[1] - slope[0]) / 2
        strain = p1 + 2 * p2 * x + (slope[0] + slope[1]) / 2
        u = p0 + p1 * x + p2 * x * x + a * t * t / 2 + (W[0] + W[1]) / 2
        return [v, self.M * strain, u]

    def ramped(self, part, T, x, t):
        if T == 0:
            return self.held(part, x, t)
        first, total = max(t - T, mpf(0)), [mpf(0)] * 3
        count = int(self.c * t / self.L) + 3
        kinks = [(n * self.L + side * x) / self.c for n in range(-1, count) for side in (-1, 1)]
        cuts = [first] + sorted(k for k in kinks if first < k < t) + [t]
        for lo, hi in zip(cuts, cuts[1:]):
            half, middle = (hi - lo) / 2, (hi + lo) / 2
            for node in (-half / sqrt(mpf(3)), half / sqrt(mpf(3))):
                values = self.held(part, x, middle + node)
                total = [s + half * y for s, y in zip(total, values)]
        return [s / T for s in total]

    def start(self, x):
        lo, hi, v = self.patch
        return v if lo <= x < hi else mpf(0)

    def start_integral(self, y):
        """Integral of the continued initial velocity from 0 to y."""
        lo, hi, v = self.patch
        whole = v * (hi - lo)
        j, sign, turn, z = self.fold(y)
        part = v * min(max(z - lo, mpf(0)), hi - lo)
        total = sign * (part if turn == 1 else whole - part)
        for i in range(min(j, 0), max(j, 0)):
            total += (1 if j > 0 else -1) * whole * self.fold((i + mpf(0.5)) * self.L)[1]
        return total

    def thrown(self, x, t):
        """v, stress, u from the patch alone."""
        s = self.c * t
        back, ahead = [self.fold(y)[1] * self.start(self.fold(y)[3]) for y in (x - s, x + s)]
        u = (self.start_integral(x + s) - self.start_integral(x - s)) / (2 * self.c)
        return [(back + ahead) / 2, self.Z * (ahead - back) / 2, u]

    def at(self, x, t):
        x, t = mpf(x), mpf(t)
        parts = [
            self.ramped(self.body_part, self.body_ramp, x, t),
            self.ramped(self.pull_part, self.pull_ramp, x, t),
            self.thrown(x, t),
        ]
        return [sum(values) for values in zip(*parts)]

    def near_front(self, x, t):
        x, t = mpf(x), mpf(t)
        near = self.L * mpf(10) ** -3
        for since in {t, t - self.body_ramp, t - self.pull_ramp}:
            for y in (x - self.c * since, x + self.c * since):
                z = self.fold(y)[3]
                edges = self.patch[:2] + [mpf(0), self.L]
                if since >= 0 and any(abs(z - e) < near for e in edges):
                    return True
        return False

    def scales(self, t):
        """Sizes of v, stress and u, to tell rounding from a value."""
        stress = self.Z * abs(self.patch[2]) + abs(self.body) * self.rho * self.L
        stress += abs(self.pull_left) + abs(self.pull_right)
        rounds = 1 + mpf(t) * self.c / self.L
        return [rounds * y for y in (stress / self.Z, stress, rounds * stress * self.L / self.M)]


def grown(t, T):
    return min(mpf(t) / T, mpf(1)) if T > 0 else mpf(1)


def close(a, b, size, digits):
    return abs(a - b) <= size * mpf(10) ** -digits


def check_equation(bar, x, t):
    """Wave equation, v = u_t, stress = M u_x by differences; end and starting conditions."""
    sv, ss, su = bar.scales(t)
    pull = grown(t, bar.pull_ramp)
    for end, fixed, stress in (
        (mpf(0), bar.fixed_left, -bar.pull_left * pull),
        (bar.L, bar.fixed_right, bar.pull_right * pull),
    ):
        if t > 0:
            v, s, u = bar.at(end, t)
            if fixed:
                assert close(v, 0, sv, 40) and close(u, 0, su, 40)
            else:
                assert close(s, stress, ss, 40)
    x, t = mpf(x), mpf(t)
    v, s, u = bar.at(x, t)
    if t == 0:
        assert close(v, bar.start(x), sv, 40) and close(s, 0, ss, 40) and close(u, 0, su, 40)
        return
    h = bar.L * mpf(10) ** -15
    k = h / bar.c
    before, after = bar.at(x, t - k)[2], bar.at(x, t + k)[2]
    behind, ahead = bar.at(x - h, t)[2], bar.at(x + h, t)[2]
    assert close(v, (after - before) / (2 * k), sv, 25)
    assert close(s, bar.M * (ahead - behind) / (2 * h), ss, 25)
    push = bar.rho * (after - 2 * u + before) / k**2
    pull = bar.M * (ahead - 2 * u + behind) / h**2 + bar.rho * bar.body * grown(t, bar.body_ramp)
    assert close(push, pull, ss / bar.L, 20)


def modal(bar, x, t, terms=20000):
    """v, stress, u from the modes in binary64, faded smoothly to tame the slow tail."""
    L, rho, M, c = float(bar.L), float(bar.rho), float(bar.M), float(bar.c)
    lo, hi, thrown = [float(y) for y in bar.patch]
    shift = 0.5 if bar.fixed_left != bar.fixed_right else 0.0

    def answer(T, k):
        """q and q' of q'' + (c k)^2 q = min(t/T, 1)."""
        w = c * k

        def q(order, t):  # order 0: q' of the held load, 1: q, 2: its integral
            if k == 0:
                return t ** (order + 1) / math.factorial(order + 1)
            return [math.sin(w * t) / w, (1 - math.cos(w * t)) / w**2, (t - math.sin(w * t) / w) / w**2][order]

        if T == 0:
            return q(1, t), q(0, t)
        late = max(t - T, 0.0)
        return (q(2, t) - q(2, late)) / T, (q(1, t) - q(1, late)) / T

    v = s = u = 0.0
    for n in range(0 if not (bar.fixed_left or bar.fixed_right) else 1, terms):
        k = (n - shift) * math.pi / L
        if bar.fixed_left:
            shape, slope, end0, endL = math.sin(k * x), k * math.cos(k * x), 0.0, math.sin(k * L)
            integral = lambda a, b: (math.cos(k * a) - math.cos(k * b)) / k
        else:
            shape, slope, end0, endL = math.cos(k * x), -k * math.sin(k * x), 1.0, math.cos(k * L)
            integral = lambda a, b: (math.sin(k * b) - math.sin(k * a)) / k if k else b - a
        mass = rho * L * (0.5 if k else 1.0)
        fade = math.exp(-36 * (n / terms) ** 4) / mass
        q, qt = 0.0, 0.0
        for force, T in (
            (rho * float(bar.body) * integral(0.0, L), float(bar.body_ramp)),
            (float(bar.pull_left) * end0 + float(bar.pull_right) * endL, float(bar.pull_ramp)),
        ):
            if force:
                y, yt = answer(T, k)
                q, qt = q + force * y, qt + force * yt
        if thrown:
            push = rho * thrown * integral(lo, hi)
            q, qt = q + push * (math.sin(c * k * t) / (c * k) if k else t), qt + push * math.cos(c * k * t)
        v, s, u = v + fade * qt * shape, s + fade * M * q * slope, u + fade * q * shape
    return v, s, u


def check_modal(case, bar, x, t, values):
    """Six digits inside; four at an end, where the tail of the series may keep one sign."""
    at_end = x in (0.0, float(bar.L))
    free = at_end and not (bar.fixed_left if x == 0 else bar.fixed_right)
    for name, a, b, size in zip("vsu", values, modal(bar, x, t), bar.scales(0)):
        # The series has no slope at a free end; check_equation has the stress there.
        if not (name == "s" and free):
            assert close(a, mpf(b), max(size, abs(a)), 4 if at_end else 6), (case, name, x, t)


def main():
    rng = random.Random(1995)
    rows = []
    for bar_name, L, rho, M, g, pull, big_g, big_pull, thrown in BARS:
        transit = L / math.sqrt(M / rho)
        for case, left, right, body, pl, pr, ramps, patch in CASES:
            size_g, size_pull = (big_g, big_pull) if patch else (g, pull)
            numbers = [
                body * size_g, ramps[0] * transit, pl * size_pull, pr * size_pull, ramps[1] * transit
            ]
            patch = [patch[0] * L, patch[1] * L, thrown] if patch else [0.0, 0.0, 0.0]
            bar = Bar(L, rho, M, left, right, *numbers, patch)
            head = [f"{bar_name}-{case}", repr(L), repr(rho), repr(M), left, right]
            head += [repr(float(y)) for y in numbers + patch]
            # where and between which times, in L/c
            for where, lo, hi in [
                ("in", 0, 0), ("in", 0, 1), ("in", 0, 1), ("left", 0, 1), ("right", 0, 1), ("in", 1, 4),
                ("in", 1, 4), ("left", 1, 4), ("right", 1, 4), ("in", 4, 40), ("in", 4, 40),
                ("left", 4, 40), ("right", 4, 40), ("in", 39, 40),
            ]:
                while True:
                    x = {"left": 0.0, "right": L, "in": rng.uniform(0.02, 0.98) * L}[where]
                    t = rng.uniform(lo, hi) * transit
                    if not bar.near_front(x, t):
                        break
                values = bar.at(x, t)
                check_equation(bar, x, t)
                check_modal(case, bar, x, t, values)
                values = [mpf(0) if close(y, 0, s, 40) else y for y, s in zip(values, bar.scales(t))]
                rows.append(head + [repr(x), repr(t)] + [mp.nstr(y, 25) for y in values])
    with open(os.path.join(HERE, "loads.csv"), "w", newline="") as points_file:
        points = csv.writer(points_file, lineterminator="\n")
        points.writerow(COLUMNS.split(","))
        points.writerows(rows)


if __name__ == "__main__":
    main()
