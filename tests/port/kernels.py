"""Level 0 of the conformance kit in plain Python: the error measure (39) and the exact
bar of Appendix A. Reads the kit's file and prints its own values, row by row.

    python3 kernels.py measure|exact FILE [BUG]

With BUG it makes one mistake on purpose; the names are in the code.
"""
import csv
import math
import sys

what, file = sys.argv[1:3]
bug = sys.argv[3] if len(sys.argv) > 3 else ""

L, rho, E, v0 = 0.1333, 7833.0, 200e9, 5.0
c, Z = math.sqrt(E / rho), math.sqrt(E * rho)


def rms(computed, exact):
    """(39) with its square."""
    off = [a - b for a, b in zip(computed, exact)]
    if bug == "missing-square":
        return math.sqrt(abs(sum(off)) / len(off))
    return math.sqrt(sum(a * a for a in off) / len(off))


def thrown(a, b):
    """Length of the part of [a, b] that was thrown."""
    return max(0.0, min(b, L) - max(a, 0.75 * L))


def invariant(family, x, s):
    """R at the end of the path s (m), and its integral along it (m m/s)."""
    sign, total = 1.0, 0.0
    while True:
        to_end = x if family == 1 else L - x
        part = min(s, to_end)
        a, b = (x - part, x) if family == 1 else (x, x + part)
        total += sign * 0.5 * v0 * thrown(a, b)
        if s <= to_end:
            foot = x - s if family == 1 else x + s
            return sign * 0.5 * (v0 if foot >= 0.75 * L else 0.0), total
        # Fixed at x = 0, free at x = L; the printed ends give half of it.
        turned = -1.0 if family == 1 else 1.0
        sign *= 0.5 * turned if bug == "half-reflection" else turned
        s, x, family = s - to_end, (0.0 if family == 1 else L), 3 - family


with open(file, newline="") as table:
    for row in csv.DictReader(table):
        if what == "measure":
            lists = ([float(x) for x in row[name].split()] for name in ("computed", "exact"))
            print(repr(rms(*lists)))
        else:
            x, s = float(row["x"]), c * float(row["t"])
            (one, u_one), (two, u_two) = invariant(1, x, s), invariant(2, x, s)
            print(repr(one + two), repr(Z * (two - one)), repr((u_one + u_two) / c))
