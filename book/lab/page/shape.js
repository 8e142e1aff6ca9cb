// The shape functions, their gradients, and the force on one node while a particle crosses.
"use strict";

LAB.shape = (() => {
  const { css, axes, open } = LAB.pen;
  const $ = (name) => document.querySelector(`#lab [data-lab="${name}"]`);
  const CELLS = 8, PLACES = 60 * CELLS + 1;
  let shapes = null;

  // The functions are drawn on eight cells, where one can tell them apart.
  function ask() {
    if (LAB.plane()) { shapes = null; return; }
    const few = LAB.sets().filter((set) => !/^grid\.cells/.test(set)).concat(`grid.cells=${CELLS}`);
    const answer = LAB.program.ask("shape", PLACES, LAB.motion().scene, few);
    shapes = answer.error ? { error: LAB.text(answer.error) } : {
      nodes: LAB.list(answer.nodes), x: LAB.list(answer.x), N: LAB.list(answer.N), slope: LAB.list(answer.slope),
    };
  }

  function draw() {
    if (!shapes || shapes.error) {
      $("shape-words").textContent = shapes ? shapes.error : "";
      $("force-words").textContent = "";
      for (const name of ["N", "slope", "force"]) open($(name), 150);
      return;
    }
    functions();
    force();
  }

  function functions() {
    const { nodes, x, N, slope } = shapes, count = nodes.length, L = x[x.length - 1], h = L / CELLS;
    const place = Math.round(LAB.state.x * (x.length - 1)), cells = x.map((x) => x / h), here = [];
    let sum = 0;
    for (const [name, values, unit] of [["N", N, 1], ["slope", slope, 1 / h]]) {
      let most = 0;
      for (const y of values) most = Math.max(most, Math.abs(y) / unit);
      const box = { x: [Math.min(0, nodes[0]) / h, Math.max(L, nodes[count - 1]) / h], y: [name === "N" ? -0.04 : -1.1 * most, 1.1 * most], name: "x/h" };
      const picture = axes($(name), 160, box);
      for (let I = 0; I < count; I++) {
        const of = (n) => values[n * count + I] / unit, isSeen = Math.abs(N[place * count + I]) > 0;
        const colour = css(isSeen ? (I % 2 ? "--lab-blue" : "--lab-orange") : "--lab-line");
        picture.line(cells, Float64Array.from(x, (_, n) => of(n)), colour, isSeen ? 1.8 : 1, isSeen && I % 2 ? [6, 3] : []);
        if (isSeen) picture.dots([cells[place]], [of(place)], colour, 3.4);
        if (isSeen && name === "N") { here.push(LAB.round(of(place))); sum += of(place); }
      }
      picture.cursor(cells[place]);
      if (name === "N") picture.dots(nodes.map((x) => x / h), nodes.map(() => 0), css("--fg"), 2);
    }
    $("shape-words").textContent = `At x/h = ${LAB.round(cells[place])} the bar sees ${here.length} nodes: N = ${here.join(", ")}; their sum is ${LAB.round(sum)}.`;
  }

  // f_I = −V σ ∇N_I of one particle with σ = 1 Pa and V = h, for the node in the middle.
  function force() {
    const { nodes, x, slope } = shapes, count = nodes.length, h = x[x.length - 1] / CELLS;
    const I = nodes.findIndex((node) => Math.abs(node / h - CELLS / 2) < 0.01);
    const cells = Array.from(x, (x) => x / h), f = cells.map((_, n) => -h * slope[n * count + I]);
    const most = Math.max(...f.map(Math.abs)), place = Math.round(LAB.state.x * (x.length - 1));
    const picture = axes($("force"), 190, { x: [0, CELLS], y: [-1.15 * most, 1.15 * most], name: "x_p/h, where the particle is" });
    picture.line([0, CELLS], [0, 0], css("--fg"), 1);
    picture.line([CELLS / 2, CELLS / 2], [-2 * most, 2 * most], css("--lab-grey"), 2, [2, 4]);
    // A gap in the line is a jump: from one place to the next, a sixtieth of a cell on.
    let from = 0, largest = 0, at = 0;
    for (let n = 1; n <= f.length; n++) {
      const jump = n < f.length ? Math.abs(f[n] - f[n - 1]) : Infinity;
      if (n < f.length && jump > largest) [largest, at] = [jump, n];
      if (jump < 0.3 * most) continue;
      picture.line(cells.slice(from, n), f.slice(from, n), css("--lab-blue"), 2.2);
      if (n < f.length) picture.dots([cells[n - 1], cells[n]], [f[n - 1], f[n]], css("--lab-orange"), 4);
      from = n;
    }
    picture.cursor(cells[place]);
    picture.dots([cells[place]], [f[place]], css("--fg"), 4);
    const jumps = largest > 0.3 * most;
    $("force-words").textContent = `With the particle at x_p/h = ${LAB.round(cells[place])} the force is ${LAB.pen.label(LAB.round(f[place]))} N on each square metre. ` + (jumps
      ? `At x_p/h = ${Math.round(cells[at])} it jumps from ${LAB.pen.label(LAB.round(f[at - 1]))} N to ${LAB.pen.label(LAB.round(f[at]))} N: a particle that crosses this face kicks the node.`
      : `No jump: it changes by ${LAB.round(largest)} N at most over a sixtieth of a cell.`);
  }
  return { ask, draw };
})();
