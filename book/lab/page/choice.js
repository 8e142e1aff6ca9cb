// What the reader chooses: presets, sliders, the address, and the command that does the same.
"use strict";

// The controls. A slider goes from `least` to `most`, by equal factors where it is `log`.
LAB.sliders = {
  gamma: { least: 0.3, most: 10, log: true },
  rho_b: { least: 0, most: 1 },
  cells: { least: 8, most: 120, whole: true },
  ppc: { least: 1, most: 4, whole: true },
  cfl: { least: 0.05, most: 6, log: true },
  throw: { least: 0.5, most: 500, log: true },
  swing: { least: 0.001, most: 0.3, log: true },
  hit: { least: 0.02, most: 0.4, log: true },
  spin: { least: 0.1, most: 1, log: true },
};
LAB.selects = ["motion", "method", "basis", "mass", "integrator", "stress", "law"];

LAB.start = {
  motion: "thrown", method: "mpm", basis: "linear", gamma: 0.8, mass: "lumped",
  integrator: "newmark", stress: "first", rho_b: 0.8, cells: 40, ppc: 2, cfl: 0.5,
  blowup: false, throw: 5, swing: 0.0625, hit: 0.1, spin: 0.6, law: "rate", probe: 0,
  field: "v", point: 1, colour: "material",
};

// The scenes that ship, and what of them the controls begin with.
LAB.motions = {
  thrown: { scene: "dyka", length: 0.1333, basis: "linear", cells: 40, start: 40 },
  kept: { scene: "manufactured", length: 1, basis: "lme", cells: 160, start: 40 },
  discs: { scene: "colliding-discs", plane: true, middle: [0.5, 0.5], reach: 0.56, basis: "linear", cells: 20, start: 16 },
  spin: { scene: "spinning-bar", plane: true, middle: [0.5, 0.125], reach: 0.58, basis: "bspline", cells: 16, start: 16 },
};

LAB.presets = {
  dispersion: {
    name: "Dispersion", set: {}, link: ["linear.html#first-disease-dispersion", "The linear basis and its two diseases"],
    words: "A front is a jump, and the grid carries its short waves more slowly than its long ones. So a train of waves trails behind every front, and gets longer with every way through the bar.",
  },
  lumping: {
    name: "Lumping filters", set: { basis: "bspline" }, link: ["comparison.html#what-came-out", "What wins where"],
    words: "A smooth basis with the lumped mass matrix is worse than the linear one: each step multiplies the velocity by the inverse of the lumped matrix times the consistent one, which takes short waves away. Choose the consistent mass and watch the front become steep.",
  },
  smooth: {
    name: "A smooth basis, a sharp gain", set: { basis: "lme", gamma: 0.8, mass: "consistent", cfl: 0.2 },
    link: ["comparison.html#what-came-out", "What wins where"],
    words: "With the consistent matrix local max-ent at γ = 0.8 has less than a third of the velocity error of any lumped run on this grid. It is a spike: move γ by a tenth to either side, and the error grows by more than two thirds.",
  },
  limit: {
    name: "One percent above √3", set: { cfl: 1.75, blowup: true },
    link: ["stability.html#while-particles-move", "Stability"],
    words: "The linear basis with two particles in a cell and the lumped mass bears a Courant number of √3, and this run has a little more. A wave of some three cells grows by a factor in every step, until its energy is a thousand times that of the throw; switch off \u201crun what must blow up\u201d, and the program refuses beforehand.",
  },
  crossing: {
    name: "Cells are crossed", set: { motion: "kept", cfl: 0.2, swing: 0.0625, probe: 1 },
    link: ["crossing.html#what-came-out", "What converges when particles cross"],
    words: "The bar swings between two walls by two and a half cells, and at each node that a particle crosses the gradient of the linear basis jumps. The stress is lost in noise; choose local max-ent at γ = 0.8, whose gradients are smooth, and it comes back.",
  },
  light: {
    name: "A light node", set: { basis: "lme", gamma: 1.8, mass: "consistent", cfl: 0.2, x: 1 },
    link: ["weak-form.html#the-consistent-mass-matrix", "Weak form and particles"],
    words: "Local max-ent reaches a node beyond the free end, which sees the body from afar only: in the consistent matrix its diagonal is a small part of its mass, and its own frequency would bound the time step. Such nodes are lumped, so the limit on the slider stays where the rest of the bar has it.",
  },
  otm: {
    name: "OTM at Courant one", set: { method: "otm", ppc: 1, cfl: 1 }, link: ["otm.html#what-came-out", "OTM: nodes that move"],
    words: "With the linear basis and one point in a cell OTM is linear finite elements, and at a Courant number of one the central difference is exact in one dimension. Displacements are right to five digits and fronts as sharp as the grid; take a tenth off the Courant number, and waves trail behind them again.",
  },
  rotation: {
    name: "Rotation", set: { motion: "discs", cells: 16, cfl: 0.2, probe: 2, jump: 1 },
    link: ["extremes.html#when-a-result-is-not-to-be-trusted", "At the extremes"],
    words: "Two discs meet off centre and turn about each other; momentum is kept to its last digits, and angular momentum is not, since the trip to the nodes and back smears it. The rate law does not turn the stress with the material, so the program warns of it or stops; choose the neo-Hookean law, which does.",
  },
  spin: {
    name: "A spinning bar", set: { motion: "spin", basis: "bspline", cells: 16, cfl: 0.2, jump: 1, probe: 2 },
    link: ["finite-strain.html#what-came-out", "Finite strain"],
    words: "A free bar turns once about its middle, and turning stretches it along its axis. The rate law leaves that tension where it was in space while the bar turns on, which shears the bar; the neo-Hookean law takes the tension along, and the bar stays nearly straight.",
  },
};

LAB.fresh = () => ({ ...LAB.start, x: 0.4, jump: 0.3 });
LAB.state = { ...LAB.fresh(), preset: "dispersion" };
LAB.motion = () => LAB.motions[LAB.state.motion];
LAB.plane = () => Boolean(LAB.motion().plane);
LAB.round = (x) => Number(x.toPrecision(3));
LAB.seconds = (t) => `${t === 0 || t >= 0.01 ? LAB.round(t) : t.toExponential(2).replace("-", "−")} s`;

// What is set of the motion alone; on it the exact solution depends.
LAB.setsOfMotion = function () {
  const s = LAB.state, out = [];
  if (s.motion === "kept") out.push(`manufactured.amplitude=${s.swing}`);
  else if (s.motion === "discs") {
    const side = LAB.round(0.6 * s.hit);
    out.push(`initial_velocity.0.velocity=[${s.hit},${side}]`, `initial_velocity.1.velocity=[${-s.hit},${-side}]`);
  } else if (s.motion === "spin") {
    // One turn, whatever its speed.
    if (s.spin !== 0.6) out.push(`initial_velocity.0.spin=${s.spin}`, `time.end=${Number((2 * Math.PI / s.spin).toPrecision(6))}`);
  } else if (s.throw !== 5) out.push(`initial_velocity.0.velocity=${s.throw}`);
  return out;
};

// Cells along each axis, and those that the spinning bar needs to turn in.
LAB.setsOfGrid = function () {
  const s = LAB.state, shipped = LAB.motion(), out = [];
  const high = Math.max(1, Math.round(s.cells / 4));
  if (s.cells !== shipped.cells) {
    out.push(`grid.cells=${s.motion === "spin" ? `[${4 * high},${high}]` : shipped.plane ? `[${s.cells},${s.cells}]` : s.cells}`);
    if (s.motion === "spin" && s.method !== "otm") out.push(`grid.beyond={ left = ${Math.ceil(high / 2)}, right = ${Math.ceil(high / 2)}, bottom = ${2 * high}, top = ${2 * high} }`);
  }
  if (s.motion === "spin" && s.method === "otm") out.push("grid.beyond=");
  if (s.ppc !== 2) out.push(`grid.particles_per_cell=${shipped.plane ? `[${s.ppc},${s.ppc}]` : s.ppc}`);
  return out;
};

// The basis, where the scene that ships has another.
LAB.setsOfBasis = function (shipped) {
  const s = LAB.state, out = [], [kind, degree] = s.basis === "bspline3" ? ["bspline", 3] : [s.basis, 2];
  if (kind !== shipped) out.push(`basis.kind=${kind}`);
  if (degree === 3) out.push("basis.degree=3");
  if (kind === "lme") out.push(`basis.gamma=${s.gamma}`);
  else if (shipped === "lme") out.push("basis.gamma=");
  return out;
};

// What is set beside the scene that ships, in the order of the controls.
LAB.sets = function () {
  const s = LAB.state, shipped = LAB.motion(), out = [];
  const put = (key, value) => out.push(`${key}=${value}`);
  if (s.method !== "mpm") put("method", s.method);
  out.push(...LAB.setsOfBasis(shipped.basis));
  if (s.mass !== "lumped") put("mass", s.mass);
  if (s.integrator !== "newmark") put("time.integrator", s.integrator);
  if (s.integrator === "forward-euler") put("time.stress_update", s.stress);
  if (s.integrator === "generalized-alpha") put("time.rho_b", s.rho_b);
  out.push(...LAB.setsOfGrid());
  if (shipped.plane && s.law !== "rate") put("body.law", s.law);
  put("time.cfl", s.cfl);
  if (s.blowup) { put("time.allow_unstable", true); put("check.energy", 1e6); }
  return out.concat(LAB.setsOfMotion());
};

LAB.command = () =>
  `lme-mpm run data/scenes/${LAB.motion().scene}.toml` +
  LAB.sets().map((set) => ` --set ${/[^\w.=+-]/.test(set) ? `'${set}'` : set}`).join("");

// The address holds all that differs from the start.
LAB.write = function () {
  const parts = Object.entries(LAB.state).filter(([name, value]) => name in LAB.start && value !== LAB.start[name]);
  if (LAB.state.preset) parts.unshift(["preset", LAB.state.preset]);
  const hash = parts.map(([name, value]) => `${name}=${encodeURIComponent(value)}`).join("&");
  history.replaceState(null, "", `#${hash}`);
};

// Reads the address; false where it says nothing. `options` lists the words of a control.
LAB.read = function (options) {
  const given = new URLSearchParams(location.hash.slice(1)), preset = LAB.presets[given.get("preset")];
  if (![...given.values()].some(Boolean)) return false;
  const state = { ...LAB.fresh(), ...(preset ? preset.set : {}), preset: preset ? given.get("preset") : "" };
  for (const [name, value] of given) {
    if (!(name in LAB.start)) continue;
    const old = LAB.start[name];
    if (typeof old === "boolean") state[name] = value === "true";
    else if (typeof old === "number") { if (Number.isFinite(Number(value))) state[name] = Number(value); }
    else if (options(name).includes(value)) state[name] = value;
  }
  for (const [name, { least, most }] of Object.entries(LAB.sliders)) state[name] = Math.min(most, Math.max(least, state[name]));
  state.point = Math.min(1, Math.max(0, state.point));
  LAB.state = state;
  return true;
};
