// The lab: controls, pictures, and the program itself as WebAssembly. No library, no network.
"use strict";
(() => {
  const lab = document.getElementById("lab");
  // The page for print shows the static picture.
  if (!lab || /print\.html$/.test(location.pathname)) return;

  const $ = (name) => lab.querySelector(`[data-lab="${name}"]`);
  const css = (name) => getComputedStyle(lab).getPropertyValue(name).trim();
  const round = (x) => Number(x.toPrecision(3));
  const text = (bytes) => (bytes ? new TextDecoder().decode(bytes) : "");
  const list = (bytes) => (bytes ? new Float64Array(bytes) : new Float64Array(0));
  const percent = (x) => (x >= 10 ? Math.round(x) + " times" : 100 * x < 0.01 ? (100 * x).toExponential(1) : (100 * x).toPrecision(3)) + (x >= 10 ? "" : " %");

  // The controls. A slider goes from `least` to `most`, by equal factors where it is `log`.
  const sliders = {
    gamma: { least: 0.3, most: 10, log: true },
    rho_b: { least: 0, most: 1 },
    cells: { least: 8, most: 120, whole: true },
    ppc: { least: 1, most: 4, whole: true },
    cfl: { least: 0.05, most: 6, log: true },
    throw: { least: 0.5, most: 500, log: true },
    swing: { least: 0.001, most: 0.3, log: true },
    hit: { least: 0.02, most: 0.4, log: true },
  };
  const start = {
    motion: "thrown", method: "mpm", basis: "linear", gamma: 0.8, mass: "lumped",
    integrator: "newmark", stress: "first", rho_b: 0.8, cells: 40, ppc: 2, cfl: 0.5,
    blowup: false, throw: 5, swing: 0.0625, hit: 0.1, law: "rate", probe: 0, field: "v",
  };
  const presets = {
    dispersion: {
      name: "Dispersion", set: {}, link: ["dyka-bar.html#what-came-out", "The bar with the linear basis"],
      words: "A front is a jump, and the grid carries its short waves more slowly than its long ones. So a train of waves trails behind every front, and gets longer with every way through the bar.",
    },
    lumping: {
      name: "Lumping filters", set: { basis: "bspline" }, link: ["comparison.html#what-came-out", "What wins where"],
      words: "A smooth basis with the lumped mass matrix is worse than the linear one: each step multiplies the velocity by the inverse of the lumped matrix times the consistent one, which takes short waves away. Choose the consistent mass and watch the front become steep.",
    },
    smooth: {
      name: "A smooth basis, a sharp gain", set: { basis: "lme", gamma: 0.8, mass: "consistent", cfl: 0.2 },
      link: ["comparison.html#what-came-out", "What wins where"],
      words: "With the consistent matrix local max-ent at γ = 0.8 has less than a third of the velocity error of any lumped run on this grid. It is a spike: move γ by a tenth to either side, and the error doubles.",
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
      name: "OTM at Courant one", set: { method: "otm", ppc: 1, cfl: 1 }, link: ["otm.html#exercise", "OTM: nodes that move"],
      words: "With the linear basis and one point in a cell OTM is linear finite elements, and at a Courant number of one the central difference is exact in one dimension. Displacements are right to five digits and fronts as sharp as the grid; take a tenth off the Courant number, and waves trail behind them again.",
    },
    rotation: {
      name: "Rotation", set: { motion: "discs", cells: 16, cfl: 0.2, probe: 2, jump: 1 },
      link: ["extremes.html#when-a-result-is-not-to-be-trusted", "At the extremes"],
      words: "Two discs meet off centre and turn about each other; momentum is kept to its last digits, and angular momentum is not, since the trip to the nodes and back smears it. The rate law does not turn the stress with the material, so the program warns of it or stops; choose the neo-Hookean law, which does.",
    },
  };
  const scenes = { thrown: "dyka", kept: "manufactured", discs: "colliding-discs" };
  const plane = () => state.motion === "discs";

  let state = { ...start, preset: "dispersion", x: 0.4 };
  let frame = 0, playing = false, seen = null, shapes = null, began = performance.now();

  // --- The program -----------------------------------------------------------------------

  let program = null, compiled = null;
  function instantiate() {
    if (!compiled) {
      const binary = atob(window.LAB_SOLVER.wasm);
      const bytes = new Uint8Array(binary.length);
      for (let i = 0; i < bytes.length; i++) bytes[i] = binary.charCodeAt(i);
      compiled = new WebAssembly.Module(bytes);
    }
    program = new WebAssembly.Instance(compiled, {}).exports;
  }

  // Asks the program; the answer is an object of parts.
  function ask(name, number, sets) {
    if (!program) instantiate();
    const scene = window.LAB_SOLVER.scenes[scenes[state.motion]];
    const request = new TextEncoder().encode([number, scene, ...sets].join("\0"));
    try {
      const at = program.alloc(request.length);
      new Uint8Array(program.memory.buffer, at, request.length).set(request);
      const answer = program[name](at, request.length);
      const view = new DataView(program.memory.buffer);
      const end = answer + 4 + view.getUint32(answer, true);
      const parts = {};
      const piece = (at) => [at + 4, at + 4 + view.getUint32(at, true)];
      for (let at = answer + 4; at < end;) {
        const [nameFrom, nameTo] = piece(at);
        const [from, to] = piece(nameTo);
        parts[text(program.memory.buffer.slice(nameFrom, nameTo))] = program.memory.buffer.slice(from, to);
        at = to;
      }
      program.free(answer, end - answer);
      return parts;
    } catch (trap) {
      program = null; // Its memory cannot be trusted any more.
      return { error: new TextEncoder().encode(`the program stopped in the page: ${trap.message}`) };
    }
  }

  // What is set beside the scene that ships, in the order of the controls.
  function sets() {
    const s = state, out = [];
    const put = (key, value) => out.push(`${key}=${value}`);
    if (s.method !== "mpm") put("method", s.method);
    if (s.basis !== "linear" || s.motion === "kept") put("basis.kind", s.basis);
    if (s.basis === "lme") put("basis.gamma", s.gamma);
    else if (s.motion === "kept") put("basis.gamma", "");
    if (s.mass !== "lumped") put("mass", s.mass);
    if (s.integrator !== "newmark") put("time.integrator", s.integrator);
    if (s.integrator === "forward-euler") put("time.stress_update", s.stress);
    if (s.integrator === "generalized-alpha") put("time.rho_b", s.rho_b);
    const each = (n) => (plane() ? `[${n},${n}]` : n);
    if (s.cells !== 40 || s.motion !== "thrown") put("grid.cells", each(s.cells));
    if (s.ppc !== 2) put("grid.particles_per_cell", each(s.ppc));
    if (plane() && s.law !== "rate") put("body.law", s.law);
    put("time.cfl", s.cfl);
    if (s.blowup) { put("time.allow_unstable", true); put("check.energy", 1e6); }
    if (s.motion === "kept") put("manufactured.amplitude", s.swing);
    else if (plane()) {
      put("initial_velocity.0.velocity", `[${s.hit},${round(0.6 * s.hit)}]`);
      put("initial_velocity.1.velocity", `[${-s.hit},${-round(0.6 * s.hit)}]`);
    } else if (s.throw !== 5) put("initial_velocity.0.velocity", s.throw);
    return out;
  }
  const command = () =>
    `lme-mpm run data/scenes/${scenes[state.motion]}.toml` +
    sets().map((set) => ` --set ${/[[\]]/.test(set) ? `'${set}'` : set}`).join("");

  // --- From an answer to what is drawn ---------------------------------------------------

  function table(answer, name) {
    const columns = text(answer[`${name}.columns`]).split("\n");
    return { columns, values: list(answer[name]), width: columns.length };
  }
  function column(table, name) {
    const at = table.columns.indexOf(name);
    if (at < 0) return null;
    const out = new Float64Array(table.values.length / table.width);
    for (let i = 0; i < out.length; i++) out[i] = table.values[i * table.width + at];
    return out;
  }

  // Estimates the work of a run, in pairs of particles and nodes; a page bears some seconds.
  const MOST = 1e8;
  function work() {
    const s = state, axes = plane() ? 2 : 1;
    const steps = ({ thrown: 4, kept: 2, discs: 4.1 }[s.motion] * s.cells) / s.cfl;
    const along = s.basis === "linear" ? 2 : s.basis === "lme" ? 2 * Math.sqrt(13.8 / s.gamma) + 1 : 3;
    const nodes = (s.cells + 2) ** axes, band = 2 * along * (axes === 2 ? s.cells + 2 : 1);
    return steps * ((s.cells * s.ppc * along) ** axes + (s.mass === "consistent" ? (nodes * band * band) / 5 : 0));
  }

  function compute() {
    const before = performance.now();
    $("command").textContent = command();
    lab.classList.toggle("lab-plane", plane());
    if (work() > MOST) {
      $("error").textContent = "This run would hold up the page for long; the command below does it elsewhere. Fewer cells, or the lumped mass, take less.";
      lab.classList.add("lab-stale");
      return;
    }
    const limit = ask("limit", 0, sets());
    seen = seen || {};
    mark(list(limit.limit)[1]);
    const answer = ask("run", 160, sets());
    const took = performance.now() - before;
    const error = text(answer.error);
    $("error").textContent = error || (answer.broken ? `the run broke down: ${text(answer.broken)}` : "");
    lab.classList.toggle("lab-stale", Boolean(error));
    if (error) { draw(); return; }
    const atEnd = !seen.t || frame >= seen.t.length - 1;
    const history = table(answer, "history"), particles = table(answer, "particles");
    const t = list(answer.t), exact = list(answer.exact);
    const count = t.length ? particles.values.length / particles.width / t.length : 0;
    const names = text(answer["summary.names"]).split("\n"), values = list(answer.summary);
    seen = {
      t, exact, particles, history, count, took, sizes: list(limit.sizes), limit: list(answer.limit),
      samples: t.length ? exact.length / 3 / t.length : 0,
      summary: Object.fromEntries(names.map((name, i) => [name, values[i]])),
      warnings: text(answer.warnings), broken: Boolean(answer.broken),
      plane: plane(),
      end: t.length ? Math.max(t[t.length - 1], 1e-300) : 1,
    };
    const fixed = ["step", "t", "kinetic_energy", "strain_energy", "work", "momentum"];
    seen.probes = history.columns.filter((name) => !fixed.includes(name) && !name.endsWith("_exact"));
    seen.peak = { v: peak(1), s: peak(2) };
    seen.room = plane() ? null : [0, room("velocity", seen.peak.v), room("stress", seen.peak.s)];
    seen.map = null;
    frame = atEnd ? Math.max(t.length - 1, 0) : Math.min(frame, Math.max(t.length - 1, 0));
    if (state.jump !== undefined) { frame = Math.round(state.jump * (t.length - 1)); delete state.jump; }
    const range = $("frame");
    range.max = Math.max(t.length - 1, 0);
    shape();
    figures();
    draw();
  }

  // The functions are drawn on eight cells, where one can tell them apart.
  function shape() {
    if (plane()) { shapes = null; return; }
    const few = sets().filter((set) => !/^grid\.cells/.test(set)).concat("grid.cells=8");
    const answer = ask("shape", 481, few);
    shapes = answer.error ? { error: text(answer.error) } : {
      nodes: list(answer.nodes), x: list(answer.x), N: list(answer.N), slope: list(answer.slope),
    };
  }

  // The largest exact value of a field (1 velocity, 2 stress), or the computed one without.
  function peak(field) {
    let most = 0;
    for (let i = field; i < seen.exact.length; i += 3) most = Math.max(most, Math.abs(seen.exact[i]));
    return most || 1;
  }

  // How far an axis reaches: to all that was computed, up to four times the exact peak.
  function room(name, peak) {
    let most = 0;
    for (let k = 0; k < seen.t.length; k++) for (const x of at(name, k)) most = Math.max(most, Math.abs(x));
    return 1.08 * Math.min(4 * peak, Math.max(peak, most));
  }

  function figures() {
    const s = seen.summary, words = [];
    const probe = seen.probes[Math.min(state.probe, seen.probes.length - 1)];
    if (s[`${probe}_rms_relative`] !== undefined) words.push(`error of ${probe.replace(/_/g, " ")} ${percent(s[`${probe}_rms_relative`])}`);
    if (s.velocity_field_rms_relative !== undefined) words.push(`of v at the end ${percent(s.velocity_field_rms_relative)}`);
    if (s.stress_field_rms_relative !== undefined) words.push(`of σ ${percent(s.stress_field_rms_relative)}`);
    if (s.displacement_field_rms_relative !== undefined) words.push(`of u ${percent(s.displacement_field_rms_relative)}`);
    if (s.energy_drift !== undefined) words.push(`energy ${s.energy_drift < 0 ? "−" : "+"}${percent(Math.abs(s.energy_drift))}`);
    const [, , steps] = seen.sizes;
    words.push(`${seen.count} particles, ${steps} steps`);
    if (seen.limit.length && isFinite(seen.limit[1])) words.push(`limit of c Δt/h ${seen.limit[1].toPrecision(4)}`);
    words.push(`computed here in ${seen.took.toFixed(0)} ms`);
    $("figures").textContent = words.join("; ") + "." + (seen.warnings ? ` Warning: ${seen.warnings}` : "");
  }

  // --- Pictures --------------------------------------------------------------------------

  function ticks(least, most, about) {
    const raw = (most - least) / about, power = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].find((n) => n * power >= raw) * power;
    const out = [];
    for (let n = Math.ceil(least / step - 1e-9); n * step <= most + 1e-9 * step; n++) out.push(n * step);
    return out;
  }
  const label = (x) => (Math.abs(x) < 1e-300 ? "0" : Math.abs(x) >= 1e4 || Math.abs(x) < 1e-3 ? x.toExponential(0) : String(Number(x.toPrecision(4))));

  // Makes a canvas sharp, and gives its context and size.
  function open(canvas, height) {
    const width = canvas.clientWidth, scale = window.devicePixelRatio || 1;
    canvas.style.height = `${height}px`;
    canvas.width = Math.round(width * scale);
    canvas.height = Math.round(height * scale);
    const pen = canvas.getContext("2d");
    pen.setTransform(scale, 0, 0, scale, 0, 0);
    pen.font = "11px sans-serif";
    return [pen, width, height];
  }

  // Draws axes and gives the maps from values to pixels.
  function axes(canvas, height, box) {
    const [pen, width] = open(canvas, height);
    const left = 46, right = width - 14, top = 8, bottom = height - 30;
    const X = (x) => left + ((x - box.x[0]) / (box.x[1] - box.x[0])) * (right - left);
    const Y = (y) => bottom - ((y - box.y[0]) / (box.y[1] - box.y[0])) * (bottom - top);
    pen.fillStyle = css("--fg");
    pen.strokeStyle = css("--lab-line");
    pen.lineWidth = 1;
    pen.textAlign = "center";
    for (const x of ticks(...box.x, Math.max(2, width / 110))) {
      pen.beginPath(); pen.moveTo(X(x), top); pen.lineTo(X(x), bottom); pen.globalAlpha = 0.5; pen.stroke();
      pen.globalAlpha = 1; pen.fillText(label(x), X(x), bottom + 13);
    }
    pen.textAlign = "right";
    for (const y of ticks(...box.y, 4)) {
      pen.beginPath(); pen.moveTo(left, Y(y)); pen.lineTo(right, Y(y)); pen.globalAlpha = 0.5; pen.stroke();
      pen.globalAlpha = 1; pen.fillText(label(y), left - 5, Y(y) + 4);
    }
    pen.textAlign = "right";
    pen.fillText(box.name, right, height - 4);
    canvas.lab = { X, Y, left, right, box };
    const inside = (paint) => {
      pen.save(); pen.beginPath(); pen.rect(left, top, right - left, bottom - top); pen.clip(); paint(); pen.restore();
    };
    const line = (xs, ys, colour, thick = 1.6) => inside(() => {
      pen.strokeStyle = colour; pen.lineWidth = thick; pen.lineJoin = "round"; pen.beginPath();
      for (let i = 0; i < xs.length; i++) pen[i ? "lineTo" : "moveTo"](X(xs[i]), Math.max(-1e4, Math.min(1e4, Y(ys[i]))));
      pen.stroke();
    });
    const dots = (xs, ys, colour, size = 2.2) => inside(() => {
      pen.fillStyle = colour;
      for (let i = 0; i < xs.length; i++) { pen.beginPath(); pen.arc(X(xs[i]), Math.max(-99, Math.min(1e4, Y(ys[i]))), size, 0, 7); pen.fill(); }
    });
    const cursor = (x) => inside(() => {
      pen.strokeStyle = css("--fg"); pen.lineWidth = 1; pen.setLineDash([4, 3]); pen.beginPath();
      pen.moveTo(X(x), top); pen.lineTo(X(x), bottom); pen.stroke(); pen.setLineDash([]);
    });
    return { pen, X, Y, left, right, top, bottom, line, dots, cursor, inside };
  }

  // A column of the particles at one frame.
  function at(name, k) {
    const { particles, count } = seen, place = particles.columns.indexOf(name), out = new Float64Array(count);
    for (let p = 0; p < count; p++) out[p] = particles.values[(k * count + p) * particles.width + place];
    return out;
  }
  function exactAt(k, field) {
    const out = new Float64Array(seen.samples);
    for (let i = 0; i < out.length; i++) out[i] = seen.exact[3 * (k * seen.samples + i) + field];
    return out;
  }
  const length = () => (state.motion === "kept" ? 1 : 0.1333);

  // The discs; what was on one side of each stays in its colour, so that one sees them turn.
  function drawPlane() {
    const canvas = $("plane"), width = canvas.clientWidth;
    const [pen, , height] = open(canvas, Math.min(width, 460));
    const scale = height / 1.2, X = (x) => width / 2 + (x - 0.5) * scale, Y = (y) => height / 2 - (y - 0.5) * scale;
    pen.strokeStyle = css("--lab-line");
    pen.strokeRect(X(0), Y(1), scale, scale);
    if (!seen.t.length) return;
    const [x, y, u, v] = ["position_x", "position_y", "displacement_x", "displacement_y"].map((name) => at(name, frame));
    const size = Math.max(1.5, (0.32 * scale) / (state.cells * state.ppc));
    for (let p = 0; p < x.length; p++) {
      const [a, b] = [x[p] - u[p], y[p] - v[p]], middle = a + b < 1 ? 0.2 : 0.8;
      pen.fillStyle = css(a < middle === b < middle ? "--lab-blue" : "--lab-orange");
      pen.beginPath(); pen.arc(X(x[p]), Y(y[p]), size, 0, 7); pen.fill();
    }
    canvas.setAttribute("aria-label", `${x.length} particles of two discs at ${seen.t[frame].toPrecision(3)} s`);
  }

  function drawBar() {
    for (const [name, field, of] of [["v", 1, "velocity"], ["s", 2, "stress"]]) {
      const most = seen.room[field];
      const unit = name === "v" ? 1 : 1e6;
      const picture = axes($(name), 190, { x: [0, length()], y: [-most / unit, most / unit], name: "x (m)" });
      if (!seen.t.length) continue;
      picture.line(exactAt(frame, 0), exactAt(frame, field).map((x) => x / unit), css("--lab-grey"), 3);
      picture.dots(at("position", frame), at(of, frame).map((x) => x / unit), css("--lab-blue"));
      $(name).setAttribute("aria-label", `${of} of ${seen.count} particles along the bar at ${seen.t[frame].toExponential(2)} s, over the exact one`);
    }
  }

  // Colours of a value from −1 to 1: blue below, orange above, the page's ground between.
  function colours() {
    const rgb = (text) => { const n = document.createElement("canvas").getContext("2d"); n.fillStyle = text; n.fillRect(0, 0, 1, 1); return n.getImageData(0, 0, 1, 1).data; };
    const [ground, low, high] = [css("--bg"), css("--lab-blue"), css("--lab-orange")].map(rgb);
    return (value) => {
      const end = value < 0 ? low : high, part = Math.min(1, Math.abs(value));
      return [0, 1, 2].map((i) => ground[i] + (end[i] - ground[i]) * part);
    };
  }

  // Position and time, as computed and exact; painted once for a run, the cursor each time.
  function drawMap() {
    const field = state.field === "v" ? ["velocity", 1, seen.peak.v] : ["stress", 2, seen.peak.s];
    const [pen, width, height] = open($("map"), 250), rows = seen.t.length, wide = 200;
    if (!rows) return;
    const key = state.field + css("--bg");
    if (!seen.map || seen.map.key !== key) {
      const colour = colours(), sheet = () => { const c = document.createElement("canvas"); c.width = wide; c.height = rows; return c; };
      const paint = (xs, values) => {
        const canvas = sheet(), image = canvas.getContext("2d").createImageData(wide, rows);
        for (let k = 0; k < rows; k++) {
          const x = xs(k), value = values(k), last = x.length - 1;
          for (let p = 0; p <= last; p++) {
            const from = p ? (x[p - 1] + x[p]) / 2 : p < last ? x[0] - (x[1] - x[0]) / 2 : 0;
            const to = p < last ? (x[p] + x[p + 1]) / 2 : p ? x[p] + (x[p] - x[p - 1]) / 2 : length();
            const shade = colour(value[p] / field[2]);
            for (let i = Math.max(0, Math.round((from / length()) * wide)); i < Math.min(wide, Math.round((to / length()) * wide)); i++) {
              image.data.set([...shade, 255], 4 * ((rows - 1 - k) * wide + i));
            }
          }
        }
        canvas.getContext("2d").putImageData(image, 0, 0);
        return canvas;
      };
      seen.map = {
        key,
        computed: paint((k) => at("position", k), (k) => at(field[0], k)),
        exact: paint((k) => exactAt(k, 0), (k) => exactAt(k, field[1])),
      };
    }
    const top = 18, bottom = height - 22, gap = 12, half = (width - 46 - 14 - gap) / 2;
    pen.imageSmoothingEnabled = false;
    pen.fillStyle = css("--fg"); pen.strokeStyle = css("--lab-line");
    pen.textAlign = "right";
    for (const t of ticks(0, seen.end, 4)) pen.fillText(label(t), 41, bottom - (t / seen.end) * (bottom - top) + 4);
    pen.textAlign = "center";
    [["computed", 46], ["exact", 46 + half + gap]].forEach(([name, left]) => {
      pen.drawImage(seen.map[name], left, top, half, bottom - top);
      pen.strokeRect(left, top, half, bottom - top);
      pen.fillText(name, left + half / 2, 12);
      pen.fillText("0", left + 4, bottom + 14); pen.fillText("x (m)", left + half / 2, bottom + 14); pen.fillText(String(length()), left + half - 16, bottom + 14);
    });
    const y = bottom - (seen.t[frame] / seen.end) * (bottom - top);
    pen.strokeStyle = css("--fg"); pen.setLineDash([4, 3]); pen.beginPath(); pen.moveTo(46, y); pen.lineTo(width - 14, y); pen.stroke(); pen.setLineDash([]);
    $("map").lab = { top, bottom };
  }

  function drawProbe() {
    const probe = seen.probes[Math.min(state.probe, seen.probes.length - 1)];
    const value = column(seen.history, probe), exact = column(seen.history, `${probe}_exact`), t = column(seen.history, "t");
    let most = 0;
    for (const x of exact || value) most = Math.max(most, Math.abs(x));
    const cap = 4 * most;
    for (const x of value) most = Math.max(most, Math.min(cap, Math.abs(x)));
    const unit = /stress/.test(probe) && most > 1e4 ? 1e6 : /displacement/.test(probe) ? 1e-3 : 1;
    most = (1.08 * (most || 1)) / unit;
    const picture = axes($("probe"), 220, { x: [0, seen.end], y: [-most, most], name: "t (s)" });
    if (exact) picture.line(t, exact.map((x) => x / unit), css("--lab-grey"), 3);
    picture.line(t, value.map((x) => x / unit), css("--lab-blue"));
    picture.cursor(seen.t[frame]);
    $("probe-unit").textContent = unit === 1e6 ? "(MPa)" : unit === 1e-3 ? "(mm)" : /stress/.test(probe) ? "(Pa)" : /angular/.test(probe) ? "(kg m²/s)" : /momentum/.test(probe) ? "(kg m/s)" : "(m/s)";
  }

  function drawEnergy() {
    const [kinetic, strain, t] = ["kinetic_energy", "strain_energy", "t"].map((name) => column(seen.history, name));
    const work = column(seen.history, "work"), total = kinetic.map((x, i) => x + strain[i] - (work ? work[i] : 0));
    let most = 0;
    const cap = 3 * (kinetic[0] + strain[0] || Infinity);
    for (let i = 0; i < t.length; i++) most = Math.max(most, Math.min(cap, Math.max(kinetic[i], strain[i], total[i])));
    const unit = most > 0 && (most >= 1e4 || most < 1e-2) ? 10 ** (3 * Math.floor(Math.log10(most) / 3)) : 1;
    const picture = axes($("energy"), 220, { x: [0, seen.end], y: [Math.min(0, ...total) / unit, (1.08 * (most || 1)) / unit], name: "t (s)" });
    [[kinetic, "--lab-blue"], [strain, "--lab-orange"], [total, "--lab-green"]].forEach(([values, colour]) => picture.line(t, values.map((x) => x / unit), css(colour)));
    picture.cursor(seen.t[frame]);
    $("energy-unit").textContent = `(${unit === 1 ? "" : label(unit) + " "}J)`;
    $("energy-total").textContent = work ? "both, less the work of the load" : "both";
  }

  function drawShape() {
    if (!shapes || shapes.error) {
      $("shape-words").textContent = shapes ? shapes.error : "";
      for (const name of ["N", "slope"]) open($(name), 150);
      return;
    }
    const { nodes, x, N, slope } = shapes, count = nodes.length, L = x[x.length - 1], h = L / 8;
    const place = Math.round(state.x * (x.length - 1));
    const here = [];
    let sum = 0;
    for (const [name, values, unit] of [["N", N, 1], ["slope", slope, 1 / h]]) {
      let most = 0;
      for (const y of values) most = Math.max(most, Math.abs(y) / unit);
      const picture = axes($(name), name === "N" ? 160 : 150, { x: [Math.min(0, nodes[0]) / h, Math.max(L, nodes[count - 1]) / h], y: [name === "N" ? Math.min(0, -0.04) : -1.1 * most, 1.1 * most], name: "x/h" });
      const cells = x.map((x) => x / h);
      for (let I = 0; I < count; I++) {
        const of = (n) => values[n * count + I] / unit;
        const seenHere = Math.abs(N[place * count + I]) > 0;
        const ys = Float64Array.from(x, (_, n) => of(n));
        picture.line(cells, ys, css(seenHere ? (I % 2 ? "--lab-blue" : "--lab-orange") : "--lab-line"), seenHere ? 1.8 : 1);
        if (seenHere) picture.dots([cells[place]], [of(place)], css(I % 2 ? "--lab-blue" : "--lab-orange"), 3.4);
        if (seenHere && name === "N") { here.push(round(of(place))); sum += of(place); }
      }
      picture.cursor(cells[place]);
      if (name === "N") picture.dots(nodes.map((x) => x / h), nodes.map(() => 0), css("--fg"), 2);
    }
    $("shape-words").textContent = `At x/h = ${round(x[place] / h)} the bar sees ${here.length} nodes: N = ${here.join(", ")}; their sum is ${round(sum)}.`;
  }

  function draw() {
    if (!seen || !seen.t) return;
    $("frame").value = frame;
    $("now").textContent = seen.t.length ? `t = ${seen.t[frame].toExponential(2)} s` : "";
    $("frame").setAttribute("aria-valuetext", $("now").textContent);
    // What is seen may still be that of another motion, while this one is refused.
    if (seen.plane !== plane()) return;
    if (plane()) drawPlane();
    else { drawBar(); drawShape(); }
    if (seen.t.length) { if (!plane()) drawMap(); drawProbe(); drawEnergy(); }
  }

  // --- Controls --------------------------------------------------------------------------

  const toSlider = (name, value) => {
    const { least, most, log } = sliders[name];
    return log ? (1000 * Math.log(value / least)) / Math.log(most / least) : value;
  };
  const fromSlider = (name, place) => {
    const { least, most, log } = sliders[name];
    return log ? round(least * (most / least) ** (place / 1000)) : Number(place);
  };
  // Marks the limit on the slider of the Courant number.
  function mark(limit) {
    const place = limit > 0 && isFinite(limit) ? toSlider("cfl", limit) / 1000 : 2, sign = $("mark");
    sign.hidden = place > 1 || place < 0;
    // A thumb is 16 px wide, and its middle does not reach the ends.
    sign.style.left = `calc(8px + ${place} * (100% - 16px))`;
    $("cfl").setAttribute("aria-describedby", "lab-limit");
    $("limit").textContent = limit > 0 && isFinite(limit) ? `c Δt/h: the limit is ${limit.toPrecision(4)}` : "no limit is known";
  }
  function show() {
    for (const name in sliders) {
      $(name).value = toSlider(name, state[name]);
      $(`${name}-out`).textContent = state[name];
      $(name).setAttribute("aria-valuetext", state[name]);
    }
    for (const name of ["motion", "method", "basis", "mass", "integrator", "stress", "law", "field"]) $(name).value = state[name];
    $("blowup").checked = state.blowup;
    $("x").value = state.x * 480;
    const showRow = (name, on) => ($(name).closest(".lab-row").hidden = !on);
    showRow("gamma", state.basis === "lme");
    showRow("rho_b", state.integrator === "generalized-alpha");
    showRow("stress", state.integrator === "forward-euler");
    showRow("throw", state.motion === "thrown");
    showRow("swing", state.motion === "kept");
    showRow("hit", plane());
    showRow("law", plane());
    for (const button of $("presets").children) button.setAttribute("aria-pressed", button.value === state.preset);
    const preset = presets[state.preset];
    $("words").replaceChildren();
    if (preset) {
      const link = document.createElement("a");
      [link.href, link.textContent] = preset.link;
      $("words").append(`${preset.words} More in `, link, ".");
    } else $("words").textContent = "A configuration of your own. The presets above lead back to what the book tells of.";
    if (seen && seen.probes) fillProbes();
  }
  function fillProbes() {
    const select = $("probe-name");
    select.replaceChildren(...seen.probes.map((name, i) => new Option(name.replace(/_/g, " "), i)));
    select.value = Math.min(state.probe, seen.probes.length - 1);
  }

  // The address holds all that differs from the start.
  function write() {
    const parts = Object.entries(state).filter(([name, value]) => name in start && value !== start[name]);
    if (state.preset) parts.unshift(["preset", state.preset]);
    const hash = parts.map(([name, value]) => `${name}=${encodeURIComponent(value)}`).join("&");
    history.replaceState(null, "", `#${hash}`);
  }
  function read() {
    const given = new URLSearchParams(location.hash.slice(1));
    if (![...given.values()].some(Boolean)) return false;
    const preset = given.get("preset");
    state = { ...start, x: 0.4, jump: 0.3, ...(presets[preset] ? presets[preset].set : {}), preset: presets[preset] ? preset : "" };
    for (const [name, value] of given) {
      if (!(name in start)) continue;
      const old = start[name];
      if (typeof old === "boolean") state[name] = value === "true";
      else if (typeof old === "number") { if (Number.isFinite(Number(value))) state[name] = Number(value); }
      else if ($(name) && [...$(name).options].some((option) => option.value === value)) state[name] = value;
    }
    for (const name in sliders) state[name] = Math.min(sliders[name].most, Math.max(sliders[name].least, state[name]));
    return true;
  }

  let waiting = 0;
  // A run that takes longer than a picture should waits for the hand to rest.
  function change(now) {
    show(); write();
    clearTimeout(waiting);
    const rest = !now && seen && seen.took > 60 ? Math.min(400, seen.took) : 0;
    waiting = setTimeout(() => { compute(); show(); }, rest);
  }
  function set(name, value) {
    state[name] = value;
    if (name === "motion") Object.assign(state, { cells: value === "discs" ? 16 : 40, probe: 0 });
    if (!["field", "probe"].includes(name)) state.preset = "";
    change(false);
  }

  function build() {
    for (const [name, preset] of Object.entries(presets)) {
      const button = document.createElement("button");
      button.type = "button"; button.value = name; button.textContent = preset.name;
      button.addEventListener("click", () => { state = { ...start, x: 0.4, jump: 0.3, ...preset.set, preset: name, field: state.field }; change(true); });
      $("presets").append(button);
    }
    for (const name in sliders) {
      const { least, most, log } = sliders[name], input = $(name);
      Object.assign(input, log ? { min: 0, max: 1000, step: 1 } : { min: least, max: most, step: sliders[name].whole ? 1 : 0.05 });
      input.addEventListener("input", () => set(name, fromSlider(name, input.value)));
    }
    for (const name of ["motion", "method", "basis", "mass", "integrator", "stress", "law"]) $(name).addEventListener("change", () => set(name, $(name).value));
    $("blowup").addEventListener("change", () => set("blowup", $("blowup").checked));
    $("probe-name").addEventListener("change", () => { state.probe = Number($("probe-name").value); write(); figures(); draw(); });
    $("field").addEventListener("change", () => { state.field = $("field").value; write(); draw(); });
    $("x").addEventListener("input", () => { state.x = $("x").value / 480; drawShape(); });
    $("frame").addEventListener("input", () => { stop(); frame = Number($("frame").value); draw(); });
    $("play").addEventListener("click", () => (playing ? stop() : play()));
    $("back").addEventListener("click", () => step(-1));
    $("on").addEventListener("click", () => step(1));
    for (const name of ["probe", "energy", "map"]) drag($(name), (place, x, y) => {
      stop();
      const t = name === "map" ? (place.bottom - y) / (place.bottom - place.top) : (x - place.left) / (place.right - place.left);
      frame = nearest(t * seen.end); draw();
    });
    for (const name of ["N", "slope"]) drag($(name), (place, x) => {
      const [from, to] = place.box.x, L = 8;
      state.x = Math.min(1, Math.max(0, (from + ((x - place.left) / (place.right - place.left)) * (to - from)) / L));
      $("x").value = state.x * 480; drawShape();
    });
    $("copy").addEventListener("click", () => { copy(command()).then((done) => tell(done ? "The command is copied." : "The command stands below the pictures.")); });
    $("link").addEventListener("click", () => { write(); copy(location.href).then((done) => tell(done ? "The address is copied." : "The address is in the address bar.")); });
    $("download").addEventListener("click", download);
  }
  const tell = (words) => ($("told").textContent = words);
  async function copy(words) {
    try { await navigator.clipboard.writeText(words); return true; } catch { return false; }
  }
  function download() {
    const answer = ask("history", 0, sets());
    if (!answer.csv) return tell(text(answer.error) || text(answer["csv.error"]));
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([answer.csv], { type: "text/csv" }));
    link.download = answer.broken ? "history.failed.csv" : "history.csv";
    link.click();
    URL.revokeObjectURL(link.href);
    tell(`${link.download} has every step, as the command writes it.`);
  }

  function drag(canvas, follow) {
    const on = (event) => {
      if (!canvas.lab || (event.type === "pointermove" && !(event.buttons & 1))) return;
      const box = canvas.getBoundingClientRect();
      follow(canvas.lab, event.clientX - box.left, event.clientY - box.top);
    };
    canvas.addEventListener("pointerdown", on);
    canvas.addEventListener("pointermove", on);
  }
  function nearest(t) {
    let best = 0;
    seen.t.forEach((time, k) => { if (Math.abs(time - t) < Math.abs(seen.t[best] - t)) best = k; });
    return best;
  }
  function step(by) { stop(); frame = Math.max(0, Math.min(seen.t.length - 1, frame + by)); draw(); }
  function stop() { playing = false; $("play").textContent = "Play"; }
  function play() {
    playing = true; $("play").textContent = "Pause";
    if (frame >= seen.t.length - 1) frame = 0;
    let last = 0;
    const tick = (now) => {
      if (!playing) return;
      if (now - last > 33) { last = now; frame++; draw(); }
      if (frame >= seen.t.length - 1) return stop();
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  // The solver is a script of its own, so that only this page loads it, from a disk, too.
  const script = document.createElement("script");
  script.src = lab.dataset.solver;
  script.onload = () => {
    build();
    if (!read()) state = { ...start, x: 0.4, jump: 0.3, preset: "dispersion" };
    lab.classList.add("lab-on");
    compute(); show();
    lab.dataset.ready = Math.round(performance.now() - began);
    let width = 0;
    new ResizeObserver(() => { if (lab.clientWidth !== width) { width = lab.clientWidth; draw(); } }).observe(lab);
    new MutationObserver(() => draw()).observe(document.documentElement, { attributes: true, attributeFilter: ["class"] });
    addEventListener("hashchange", () => { if (read()) change(true); });
  };
  document.head.append(script);
})();
