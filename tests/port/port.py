"""A port of the bar in plain Python: 1D, linear or local max-ent basis, lumped mass,
Newmark's predictor-corrector. It prints a trace for `lme-mpm check`.

    python3 port.py CELLS PARTICLES_PER_CELL CFL STEPS linear|GAMMA [BUG]

With BUG it makes one mistake on purpose, of those that ports make; the names are in
the code, each where it is made.
"""
import math
import sys

cells, per_cell, cfl, steps, basis = sys.argv[1:6]
cells, per_cell, cfl, steps = int(cells), int(per_cell), float(cfl), int(steps)
gamma = None if basis == "linear" else float(basis)
bug = sys.argv[6] if len(sys.argv) > 6 else ""

# The scene: fixed at x = 0, free at x = L, one cell beyond.
L, rho0, E, v0, end = 0.1333, 7833.0, 200e9, 5.0, 1.05521074812570e-4
h = L / cells
nodes = cells + 2
c = math.sqrt(E / rho0)
dt = end / max(1, math.ceil(end * c / (cfl * h) * (1 - 1e-9)))


def linear(x):
    """N and dN/dx of the two nodes of the cell."""
    i = min(int(x / h), nodes - 2)
    s = x / h - i
    slope = 1.0 if bug == "gradient-without-h" else 1.0 / h
    if bug == "node-off-by-one":
        i += 1
    return [(i, 1 - s, -slope), (i + 1, s, slope)], None


def local_max_ent(x):
    """(31) to (37) with xi = (x - x_I)/h, so that gamma = beta h^2."""
    g = gamma / h**4 if bug == "gamma-is-beta-over-h2" else gamma
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


shape_of = linear if gamma is None else local_max_ent
x = [(n // per_cell + (n % per_cell + 0.5) / per_cell) * h for n in range(cells * per_cell)]
m = [rho0 * (h if bug == "mass-of-the-whole-cell" else h / per_cell)] * len(x)
v = [v0 if 0.75 * L <= y else 0.0 for y in x]
rho = [rho0] * len(x)
sigma = [0.0] * len(x)
d_eps = [0.0] * len(x)
P = range(len(x))

print("k,step,symbol,index,node,component,value")


def show(k, step, symbol, values):
    for n, value in enumerate(values):
        print(f"{k},{step},{symbol},{n},,0,{value!r}")


shapes = [[] for _ in P]
room = nodes + 1  # one more, for a node numbered wrongly
mI, pI, fI = [0.0] * room, [0.0] * room, [0.0] * room
show(0, 0, "x_p", x)
show(0, 0, "v_p", v)
for k in range(steps + 1):
    step = dt if k else 0.0
    # 1: predictor, with the nodal values of the step before.
    for p in P:
        vel = sum(pI[I] / mI[I] * N for I, N, _ in shapes[p] if mI[I] > 0)
        acc = sum(fI[I] / mI[I] * N for I, N, _ in shapes[p] if mI[I] > 0)
        x[p] += step * vel + (0.0 if bug == "no-half-dt2" else 0.5 * step * step * acc)
        v[p] += (1.0 if bug == "whole-predictor" else 0.5) * step * acc
    show(k, 1, "x_p", x)
    show(k, 1, "v_p", v)
    # 2: nodal values are forgotten, shape functions made anew.
    old_shapes = shapes
    tables = [shape_of(y) for y in x]
    shapes = [table[0] for table in tables]
    for symbol, part in (("N_Ip", 1), ("grad_N_Ip", 2)):
        for p in P:
            for entry in shapes[p]:
                print(f"{k},2,{symbol},{p},{entry[0]},0,{entry[part]!r}")
    if gamma is not None:
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
    if bug != "fixed-node-moves":
        pI[0] = 0.0
    vI = [q / mass if mass > 0 else 0.0 for q, mass in zip(pI, mI)]
    show(k, 4, "v_I", vI[:nodes])
    # 5 and 6: strain, density, stress.
    before = d_eps[:]
    for p in P:
        d_eps[p] = step * sum(vI[I] * slope for I, _, slope in shapes[p])
    show(k, 5, "d_eps_p", d_eps)
    for p in P:
        rho[p] /= 1 + (before[p] if bug == "density-before-strain" else d_eps[p])
    show(k, 6, "rho_p", rho)
    old_sigma = sigma[:]
    for p in P:
        sigma[p] += E * d_eps[p]
    show(k, 6, "sigma_p", sigma)
    # 7: forces.
    used = old_sigma if bug == "old-stress" else sigma
    fI = [0.0] * room
    for p in P:
        for I, _, slope in shapes[p]:
            density = rho0 if bug == "first-density" else rho[p]
            fI[I] -= (-1 if bug == "sign-of-force" else 1) * used[p] * slope * m[p] / density
    show(k, 7, "f_int_I", fI[:nodes])
    if bug != "force-on-fixed-node":
        fI[0] = 0.0
    show(k, 7, "f_I", fI[:nodes])
    # 8: nodal momentum at the end of the step.
    for I in range(room):
        pI[I] += (1.0 if bug == "step-8-as-printed" else 0.5) * fI[I] * step
    show(k, 8, "p_I_advanced", pI[:nodes])
    # 9: corrector.
    for p in P:
        table = old_shapes[p] if bug == "old-N-in-corrector" and k else shapes[p]
        v[p] += 0.5 * step * sum(fI[I] / mI[I] * N for I, N, _ in table if mI[I] > 0)
    show(k, 9, "v_p", v)
