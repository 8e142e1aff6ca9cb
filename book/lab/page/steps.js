// One time step after the other, step by step, beside the listing that does it.
"use strict";

LAB.steps = (() => {
  const { css, open, shadeText } = LAB.pen;
  const $ = (name) => document.querySelector(`#lab [data-lab="${name}"]`);
  const NAMES = [
    "before the time step", "the predictor: particles move", "the nodes forget, the particles look around",
    "mass and momentum to the nodes", "the held node, and velocities", "the strain increment", "density and stress",
    "forces on the nodes", "the nodes' momentum", "the corrector: particles take over the change",
  ];
  const OF_PARTICLES = [["x_p", "mm", 1e3], ["v_p", "m/s", 1], ["d_eps_p", "10⁻⁴", 1e4], ["rho_p", "kg/m³", 1], ["sigma_p", "MPa", 1e-6]];
  const OF_NODES = [["m_I", "kg", 1], ["p_I", "kg m/s", 1], ["v_I", "m/s", 1], ["f_I", "MN", 1e-6]];
  const SHOWN = { x_p: "x_p", v_p: "v_p", d_eps_p: "Δε_p", rho_p: "ρ_p", sigma_p: "σ_p", m_I: "m_I", p_I: "p_I", v_I: "v_I", f_I: "f_I" };
  // Step 0 is before the first.
  let step = 1, k = 1, seen = null, key = "", lines = null;

  // The bar has four cells, and the basis and the Courant number of the controls.
  function ask() {
    const s = LAB.state, sets = ["grid.cells=4", ...LAB.setsOfBasis("linear"), `time.cfl=${s.cfl}`];
    const asked = `${k} ${sets}`;
    if (key === asked) return;
    key = asked;
    const answer = LAB.program.ask("steps", k, "dyka", sets);
    seen = { error: LAB.text(answer.error || answer.broken) };
    if (seen.error) return;
    for (const name in answer) seen[name] = LAB.list(answer[name]);
    k = seen.k[0];
    seen.nodes = seen.x_I.length;
    seen.particles = seen.x_p.length / (NAMES.length);
  }
  const of = (name, n) => {
    const count = name.endsWith("_I") ? seen.nodes : seen.particles;
    return seen[name].subarray(n * count, (n + 1) * count);
  };

  // Splits the listing into lines, and finds by its own comments which step each of them belongs to.
  function listing() {
    if (lines) return lines;
    const pre = document.querySelector("#lab pre.listing"), place = pre.querySelector(".place");
    const html = pre.innerHTML.slice(place.outerHTML.length).replace(/^\n/, "").trimEnd();
    pre.innerHTML = html.split("\n").map((line) => `<span class="lab-line">${line || " "}</span>`).join("");
    pre.prepend(place);
    lines = { pre, all: [...pre.querySelectorAll(".lab-line")], of: [] };
    let own = 0;
    for (const line of lines.all) {
      const comment = /\/\/ Step (\d)/.exec(line.textContent);
      if (comment) own = Number(comment[1]);
      if (own === 9 && /is_finite/.test(line.textContent)) own = 0;
      lines.of.push(own);
    }
    return lines;
  }
  function light() {
    const { pre, all, of } = listing();
    all.forEach((line, n) => line.classList.toggle("lab-lit", step > 0 && of[n] === step));
    const first = all[Math.max(0, of.indexOf(step))];
    pre.scrollTop = Math.max(0, first.offsetTop - 40);
  }

  // The values after this step; what it has changed stands out.
  function fill(table, rows, title) {
    const cell = (name, text, isNew) => { const td = document.createElement(name); td.textContent = text; if (isNew) td.className = "lab-new"; return td; };
    const count = of(rows[0][0], 0).length, head = document.createElement("tr"), body = [head];
    head.append(cell("th", title), ...Array.from({ length: count }, (_, i) => cell("th", i)));
    for (const [name, unit, factor] of rows) {
      const now = of(name, step), before = of(name, Math.max(0, step - 1)), row = document.createElement("tr"), first = cell("th", `${SHOWN[name]} (${unit})`);
      first.scope = "row";
      row.append(first, ...Array.from(now, (x, i) => cell("td", Number((x * factor).toPrecision(4)).toString().replace("-", "−"), !Object.is(x, before[i]) && x !== before[i])));
      body.push(row);
    }
    for (const th of head.children) th.scope = "col";
    table.replaceChildren(...body);
  }

  // Particles above, nodes below, and who gives to whom.
  function picture() {
    const [pen, width, height] = open($("step-picture"), 170), h = seen.x_I[1] - seen.x_I[0];
    const X = (x) => 34 + (x / (h * (seen.nodes - 1))) * (width - 60), top = 60, bottom = 128;
    const x = of("x_p", step), v = of("v_p", step), sigma = of("sigma_p", step), m = of("m_I", step), f = of("f_I", step);
    const way = { 1: "up", 2: "down", 3: "down", 5: "up", 7: "down", 9: "up" }[step];
    const table = seen[`table${step}`], peak = (list) => Math.max(1e-300, ...list.map(Math.abs));
    for (let i = 0; i < table.length; i += 4) {
      const [I, p, N] = table.slice(i, i + 3);
      if (N < 1e-3) continue;
      pen.strokeStyle = css(way === "down" ? "--lab-blue" : way === "up" ? "--lab-orange" : "--lab-line");
      pen.globalAlpha = way ? Math.max(0.12, N) : 0.5; pen.lineWidth = 1 + 2 * N;
      pen.beginPath(); pen.moveTo(X(x[p]), top); pen.lineTo(X(seen.x_I[I]), bottom); pen.stroke();
    }
    pen.globalAlpha = 1; pen.lineWidth = 1.5;
    const arrow = (from, y, long) => {
      if (Math.abs(long) < 1) return;
      const to = from + long, back = Math.sign(long) * 5;
      pen.beginPath(); pen.moveTo(from, y); pen.lineTo(to, y); pen.lineTo(to - back, y - 4); pen.moveTo(to, y); pen.lineTo(to - back, y + 4); pen.stroke();
    };
    const most = { v: peak(seen.v_p), s: peak(seen.sigma_p), m: peak(seen.m_I), f: peak(seen.f_I) };
    for (let p = 0; p < x.length; p++) {
      pen.fillStyle = shadeText(sigma[p] / most.s); pen.strokeStyle = css("--fg");
      pen.beginPath(); pen.arc(X(x[p]), top, 8, 0, 7); pen.fill(); pen.stroke();
      arrow(X(x[p]), top - 20, (26 * v[p]) / most.v);
    }
    for (let I = 0; I < seen.nodes; I++) {
      const side = 4 + 10 * Math.sqrt(m[I] / most.m);
      pen.fillStyle = css("--fg"); pen.fillRect(X(seen.x_I[I]) - side / 2, bottom - side / 2, side, side);
      arrow(X(seen.x_I[I]), bottom + 22, (30 * f[I]) / most.f);
    }
    pen.fillText("particles and v_p", 4, 14); pen.fillText("nodes and f_I", 4, height - 4);
  }

  function draw() {
    if (!$("steps").open) return;
    ask();
    $("step-error").textContent = seen.error || "";
    if (seen.error) return;
    $("step-name").textContent = step ? `Step ${step}: ${NAMES[step]}` : `Before time step ${k}`;
    $("step-k").max = seen.k[1]; $("step-k").value = k;
    $("step-k-out").textContent = `k = ${k}, t = ${LAB.seconds(k * seen.dt[0])}`;
    light();
    fill($("step-particles"), OF_PARTICLES, "particle p");
    fill($("step-nodes"), OF_NODES, "node I");
    picture();
  }
  // After the ninth step the next time step begins.
  function go(by) {
    step += by;
    if (step > 9) { if (k < seen.k[1]) { k += 1; step = 1; } else step = 9; }
    if (step < 0) { if (k > 1) { k -= 1; step = 9; } else step = 0; }
    draw();
  }
  function build() {
    $("steps").addEventListener("toggle", draw);
    $("step-back").addEventListener("click", () => go(-1));
    $("step-on").addEventListener("click", () => go(1));
    $("step-k").addEventListener("input", () => { k = Number($("step-k").value); draw(); });
  }
  return { build, draw };
})();
