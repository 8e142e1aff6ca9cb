"""A port of the bar in plain Python: 1D, linear or local max-ent basis, lumped mass,
Newmark's predictor-corrector. It prints the columns that `lme-mpm check` reads:

    python3 port.py trace CELLS PARTICLES_PER_CELL CFL STEPS linear|GAMMA [NAME=VALUE ...]
    python3 port.py errors CELLS PARTICLES_PER_CELL CFL STEPS linear|GAMMA
    python3 port.py basis FILE LENGTH CELLS linear|GAMMA
    python3 port.py law|measure|exact FILE

The first runs the bar, with other numbers where they are given; the second measures the
errors of its two histories; the others answer a file of level 0 of the conformance kit,
of which they read what is given, its step 0. With `bug=NAME` at the end it makes one
mistake on purpose, of those that ports make; the names are in the code, each where it
is made.
"""
import csv
import math
import sys

what, *arguments = sys.argv[1:]
given = dict(word.split("=") for word in arguments if "=" in word)
arguments = [word for word in arguments if "=" not in word]
bug = given.pop("bug", "")

# The bar: fixed at x = 0 (or not), free at x = L, one cell of the grid beyond; thrown to
# the right from three quarters of it on.
bar = {"length": 0.1333, "density": 7833.0, "modulus": 200e9, "poisson": 0.0, "speed": 5.0}
bar |= {"from": 0.75 * 0.1333, "end": 1.05521074812570e-4, "fixed": 1.0}
bar |= {name: float(value) for name, value in given.items()}
L, rho0, v0 = bar["length"], bar["density"], bar["speed"]


def lame(young, nu):
    """Both constants of (3)."""
    twice = 1 if bug == "plane-stress" else 2
    return young * nu / ((1 + nu) * (1 - twice * nu)), young / (2 * (1 + nu))


# Uniaxial strain: its modulus is lambda + 2 mu.
M = lame(bar["modulus"], bar["poisson"])[0] + 2 * lame(bar["modulus"], bar["poisson"])[1]
c, Z = math.sqrt(M / rho0), math.sqrt(M * rho0)


def row(k, step, symbol, index, node, component, value):
    if what != "errors":
        print(f"{k},{step},{symbol},{index},{node},{component},{value!r}")


def show(k, step, symbol, values):
    for n, value in enumerate(values):
        row(k, step, symbol, n, "", 0, value)


def show_shapes(k, tables):
    """Tables of (node, N, dN/dx), one for each particle."""
    for symbol, part in (("N_Ip", 1), ("grad_N_Ip", 2)):
        for p, table in enumerate(tables):
            for entry in table:
                row(k, 2, symbol, p, entry[0], 0, entry[part])


# --- Shape functions: [(node, N, dN/dx), ...], and lambda of local max-ent ---


def linear(x, h, nodes):
    """N and dN/dx of the two nodes of the cell."""
    i = min(int(x / h), nodes - 2)
    s = x / h - i
    slope = 1.0 if bug == "gradient-without-h" else 1.0 / h
    if bug == "node-off-by-one":
        i += 1
    return [(i, 1 - s, -slope), (i + 1, s, slope)], None


def local_max_ent(x, h, nodes, gamma):
    """(31) to (37) with xi = (x - x_I)/h, so that gamma = beta h^2."""
    g = gamma * h**4 if bug == "gamma-is-beta-over-h2" else gamma
    reach = math.sqrt(-math.log(1e-6) / gamma)
    i = min(int(x / h), nodes - 2)
    near = [I for I in range(nodes) if abs(x / h - I) <= reach or I in (i, i + 1)]
    xi = [x / h - I for I in near]
    lam = 0.0
    for _ in range(100):
        f = [-g * s * s + lam * s for s in xi]
        top = max(f)
        w = [math.exp(a - top) for a in f]
        Z = sum(w)
        p = [a / Z for a in w]
        r = sum(a * s for a, s in zip(p, xi))
        J = sum(a * (s - r) ** 2 for a, s in zip(p, xi))
        step = r / J if J > 0 else 0.0
        # Damped: no weight may change by more than a half at once.
        most = max(abs(step * (s - r)) for s in xi)
        lam -= step / max(1.0, 2 * most)
        if abs(r) < 1e-15:
            break
    if bug == "cut-after-solving":
        keep = [n for n, s in enumerate(xi) if abs(s) <= 0.6 * reach]
        near, xi, p = [near[n] for n in keep], [xi[n] for n in keep], [p[n] for n in keep]
    square = sum(a * s * s for a, s in zip(p, xi))
    slope = 1.0 if bug == "gradient-without-h" else 1.0 / h
    shift = 1 if bug == "node-off-by-one" else 0
    return [(I + shift, a, -a * s / square * slope) for I, a, s in zip(near, p, xi)], lam / h


def shape_of(x, h, nodes, basis):
    if basis == "linear":
        return linear(x, h, nodes)
    return local_max_ent(x, h, nodes, float(basis))


# --- Level 0: each answers what a file gives, {case: {symbol: {index: [components]}}} ---


def law(given):
    """(3) from no stress, (17) from rho = 1, and the strain energy; in one dimension
    uniaxial strain, in two plane strain."""
    for k, case in given.items():
        (first, mu), strain = lame(case["E"][0][0], case["nu"][0][0]), case["d_eps_p"][0]
        diagonal = (0,) if len(strain) == 1 else (0, 3)
        trace = sum(strain[i] for i in diagonal)
        sigma = [2 * mu * e + (first * trace if i in diagonal else 0) for i, e in enumerate(strain)]
        row(k, 6, "rho_p", 0, "", 0, 1 / (1 + trace))
        for i, value in enumerate(sigma):
            row(k, 6, "sigma_p", 0, "", i, value)
        energy = 0.5 * sum(s * e for s, e in zip(sigma, strain))
        row(k, 6, "W_p", 0, "", 0, energy)


def rms(pairs):
    """(39) with its square."""
    off = [phi - phi_exact for phi, phi_exact in pairs]
    squares = off if bug == "missing-square" else [a * a for a in off]
    return math.sqrt(abs(sum(squares)) / len(off))


def measure(given):
    for k, case in given.items():
        pairs = [(case["phi"][n][0], case["phi_exact"][n][0]) for n in case["phi"]]
        show(k, 1, "rms", [rms(pairs)])


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


def exact_bar(x, t):
    """Appendix A: velocity, stress and displacement of the bar."""
    (one, way_one), (two, way_two) = invariant(1, x, c * t), invariant(2, x, c * t)
    return one + two, Z * (two - one), (way_one + way_two) / c


def exact(given):
    places, times = given["0"]["x"], given["0"]["t"]
    fields = [exact_bar(places[n][0], times[n][0]) for n in places]
    for n, symbol in enumerate(("v", "sigma", "u")):
        show(0, 1, symbol, [field[n] for field in fields])


def basis_values(given, length, cells, basis):
    h, nodes = float(length) / int(cells), int(cells) + 2
    tables = [shape_of(x[0], h, nodes, basis) for x in given["0"]["x_p"].values()]
    show_shapes(0, [table for table, _ in tables])
    if basis != "linear":
        show(0, 2, "lambda", [found for _, found in tables])


def given_in(file):
    given = {}
    with open(file, newline="") as table:
        for line in csv.DictReader(table):
            if line["step"] == "0":
                case = given.setdefault(line["k"], {}).setdefault(line["symbol"], {})
                case.setdefault(int(line["index"]), []).append(float(line["value"]))
    return given


# --- Levels 1 to 3: the bar ---


def run(cells, per_cell, cfl, steps, basis):
    """Prints every intermediate; yields, at the end of each time step, the velocity of
    the last particle and the stress of the one nearest to 3L/4, each with its exact value.
    """
    h, nodes = L / cells, cells + 2
    dt = bar["end"] / max(1, math.ceil(bar["end"] * c / (cfl * h) * (1 - 1e-9)))
    x = [(n // per_cell + (n % per_cell + 0.5) / per_cell) * h for n in range(cells * per_cell)]
    m = [rho0 * (h if bug == "mass-of-the-whole-cell" else h / per_cell)] * len(x)
    v = [v0 if bar["from"] <= y else 0.0 for y in x]
    rho = [rho0] * len(x)
    sigma = [0.0] * len(x)
    d_eps = [0.0] * len(x)
    P = range(len(x))
    start, middle = x[:], min(P, key=lambda p: round(abs(x[p] - 0.75 * L) / h, 9))

    shapes = [[] for _ in P]
    room = nodes + 1  # one more, for a node numbered wrongly
    mI, pI, fI = [0.0] * room, [0.0] * room, [0.0] * room
    for symbol, values in (("dt", [dt]), ("E", [bar["modulus"]]), ("nu", [bar["poisson"]]),
                           ("h", [h]), ("m_p", m), ("x_p", x), ("v_p", v),
                           ("rho_p", rho), ("sigma_p", sigma)):
        show(0, 0, symbol, values)
    if basis != "linear":
        show(0, 0, "gamma", [float(basis)])
    for k in range(steps + 1):
        step = dt if k else 0.0
        # 1: predictor, with N, f_I and the advanced p_I of the step before.
        for p in P:
            vel = sum(pI[I] / mI[I] * N for I, N, _ in shapes[p] if mI[I] > 0)
            acc = sum(fI[I] / mI[I] * N for I, N, _ in shapes[p] if mI[I] > 0)
            x[p] += step * vel + (0.0 if bug == "no-half-dt2" else 0.5 * step * step * acc)
            v[p] += (1.0 if bug == "whole-predictor" else 0.5) * step * acc
        show(k, 1, "x_p", x)
        show(k, 1, "v_p", v)
        # 2: nodal values are forgotten, shape functions made anew.
        old_shapes = shapes
        tables = [shape_of(y, h, nodes, basis) for y in x]
        shapes = [table[0] for table in tables]
        show_shapes(k, shapes)
        if basis != "linear":
            show(k, 2, "lambda", [table[1] for table in tables])
        # 3: mass and momentum to the nodes.
        mI, pI = [0.0] * room, [0.0] * room
        for p in P:
            for I, N, _ in shapes[p]:
                mI[I] += m[p] * N
                pI[I] += m[p] * v[p] * N
        show(k, 3, "m_I", mI[:nodes])
        show(k, 3, "p_I", pI[:nodes])
        # 4: the fixed node, and nodal velocities.
        if bar["fixed"] and bug != "fixed-node-moves":
            pI[0] = 0.0
        vI = [q / mass if mass > 0 else 0.0 for q, mass in zip(pI, mI)]
        show(k, 4, "v_I", vI[:nodes])
        # 5 and 6: strain, density, stress.
        before = d_eps[:]
        for p in P:
            # A node without mass moves with the others: their velocity is taken off.
            moving = [(I, slope) for I, _, slope in shapes[p] if mI[I] > 0]
            rest = vI[moving[0][0]]
            if bug == "node-without-mass-stands":
                moving, rest = [(I, slope) for I, _, slope in shapes[p]], 0.0
            d_eps[p] = step * sum((vI[I] - rest) * slope for I, slope in moving)
        show(k, 5, "d_eps_p", d_eps)
        for p in P:
            rho[p] /= 1 + (before[p] if bug == "density-before-strain" else d_eps[p])
        show(k, 6, "rho_p", rho)
        old_sigma = sigma[:]
        for p in P:
            if bug == "stress-of-this-step":
                sigma[p] = 0.0
            sigma[p] += (bar["modulus"] if bug == "modulus-is-E" else M) * d_eps[p]
        show(k, 6, "sigma_p", sigma)
        # 7: forces.
        used = old_sigma if bug == "old-stress" else sigma
        fI = [0.0] * room
        for p in P:
            for I, _, slope in shapes[p]:
                density = rho0 if bug == "first-density" else rho[p]
                fI[I] -= (-1 if bug == "sign-of-force" else 1) * used[p] * slope * m[p] / density
        show(k, 7, "f_int_I", fI[:nodes])
        if bar["fixed"] and bug != "force-on-fixed-node":
            fI[0] = 0.0
        show(k, 7, "f_I", fI[:nodes])
        # 8: nodal momentum at the end of the step, for the next predictor.
        mapped = pI[:]
        for I in range(room):
            pI[I] += (1.0 if bug == "step-8-as-printed" else 0.5) * fI[I] * step
        show(k, 8, "p_I_advanced", pI[:nodes])
        if bug == "predictor-takes-mapped-momentum":
            pI = mapped
        # 9: corrector, with the particle's acceleration.
        a = [0.0] * len(x)
        for p in P:
            table = old_shapes[p] if bug == "old-N-in-corrector" and k else shapes[p]
            a[p] = sum(fI[I] / mI[I] * N for I, N, _ in table if mI[I] > 0)
            v[p] += 0.5 * step * a[p]
        show(k, 9, "a_p", a)
        show(k, 9, "v_p", v)
        velocity, stress = exact_bar(start[-1], k * dt)[0], exact_bar(start[middle], k * dt)[1]
        yield (v[-1], velocity), (sigma[middle], stress)


if what != "errors":
    print("k,step,symbol,index,node,component,value")
if what in ("trace", "errors"):
    cells, per_cell, cfl, steps, basis = arguments
    histories = list(run(int(cells), int(per_cell), float(cfl), int(steps), basis))
    if what == "errors":
        velocity, stress = zip(*histories)
        print("velocity_end", rms(velocity) / v0)
        print("stress_three_quarter", rms(stress) / (Z * v0 / 2))
else:
    kernels = {"basis": basis_values, "law": law, "measure": measure, "exact": exact}
    kernels[what](given_in(arguments[0]), *arguments[1:])
