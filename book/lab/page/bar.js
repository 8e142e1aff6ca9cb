// Pictures of the bar: along it, over position and time, and of histories.
"use strict";

LAB.bar = (() => {
  const { css, axes, open, ticks, label, shade } = LAB.pen;
  const $ = (name) => document.querySelector(`#lab [data-lab="${name}"]`);
  const scaled = (values, unit) => values.map((x) => x / unit);
  const unitOf = { v: 1, s: 1e6 }, nameOf = { v: "velocity", s: "stress" };

  // An axis reaches to all that was computed, up to four times the exact peak.
  const room = (run, field) => {
    const peak = LAB.exact.field().most[field];
    return 1.08 * Math.min(4 * peak, Math.max(peak, run.most[field]));
  };

  function along(run, frame) {
    for (const field of ["v", "s"]) {
      const unit = unitOf[field], most = room(run, field) / unit;
      const picture = axes($(field), 190, { x: [0, run.length], y: [-most, most], name: "x (m)" });
      if (!run.t.length) continue;
      const exact = LAB.exact.moment(run.t[frame]), x = run.at("x", frame);
      picture.line(exact.x, scaled(exact[field], unit), css("--lab-grey"), 3);
      picture.dots(x, scaled(run.at(field, frame), unit), css("--lab-blue"));
      const p = pointed(run);
      picture.dots([x[p]], [run.at(field, frame)[p] / unit], css("--lab-orange"), 4);
      $(field).setAttribute("aria-label", `${nameOf[field]} of ${run.count} particles along the bar at ${LAB.seconds(run.t[frame])}, over the exact one`);
    }
  }

  // The particle at the point that the reader drags, and where it was at the start.
  const pointed = (run) => Math.min(run.count - 1, Math.floor(LAB.state.point * run.count));
  const material = (run) => { const p = pointed(run); return run.at("x", 0)[p] - run.at("u", 0)[p]; };

  const WIDE = 240, HIGH = 160;
  // Paints rows of time from below; `row` gives places and values, or nothing yet.
  function sheet(run, peak, row) {
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [WIDE, HIGH];
    const pen = canvas.getContext("2d"), image = pen.createImageData(WIDE, HIGH);
    const pixels = new Uint32Array(image.data.buffer);
    const column = (x) => Math.max(0, Math.min(WIDE, Math.round((x / run.length) * WIDE)));
    for (let j = 0; j < HIGH; j++) {
      const seen = row(((j + 0.5) / HIGH) * run.end);
      if (!seen) continue;
      const { x, value } = seen, last = x.length - 1;
      for (let p = 0; p <= last; p++) {
        const from = p ? (x[p - 1] + x[p]) / 2 : last ? x[0] - (x[1] - x[0]) / 2 : 0;
        const to = p < last ? (x[p] + x[p + 1]) / 2 : p ? x[p] + (x[p] - x[p - 1]) / 2 : run.length;
        pixels.fill(shade(value[p] / peak), (HIGH - 1 - j) * WIDE + column(from), (HIGH - 1 - j) * WIDE + column(to));
      }
    }
    pen.putImageData(image, 0, 0);
    return canvas;
  }
  const kept = {};
  function painted(name, key, paint) {
    if (!kept[name] || kept[name].key !== key) kept[name] = { key, canvas: paint() };
    return kept[name].canvas;
  }
  function sheets(run) {
    const name = LAB.state.field, exact = LAB.exact.field(), peak = exact.most[name];
    const key = `${name} ${css("--bg")} ${run.end}`, own = name === "v" ? 1 : 2;
    const computed = painted("computed", `${key} ${run.began} ${run.t.length}`, () => sheet(run, peak, (t) => {
      if (!run.t.length || t > run.t[run.t.length - 1] + run.end / HIGH) return null;
      const k = run.nearest(t);
      return { x: run.at("x", k), value: run.at(name, k) };
    }));
    const true_ = painted("exact", `${key} ${exact.key}`, () => sheet(run, peak, (t) => {
      const k = Math.min(exact.rows - 1, Math.round((t / LAB.endOf(run)) * (exact.rows - 1))) * exact.samples;
      const of = (field) => Float64Array.from({ length: exact.samples }, (_, i) => exact.values[3 * (k + i) + field]);
      return { x: of(0), value: of(own) };
    }));
    return { computed, exact: true_ };
  }
  // The end of the scene; a run that broke down may have ended before.
  LAB.endOf = (run) => run.sizes[3] || run.end;

  // Position and time, as computed and exact, with the point that the reader drags.
  function map(run, frame) {
    const canvas = $("map"), narrow = canvas.clientWidth < 560;
    const [pen, width, height] = open(canvas, narrow ? 330 : 400);
    if (!run.t.length) return;
    const top = 18, bottom = height - 34, gap = 14, from = 50, half = (width - from - 14 - gap) / 2;
    const Y = (t) => bottom - (t / run.end) * (bottom - top), { computed, exact } = sheets(run);
    pen.imageSmoothingEnabled = false;
    pen.lineWidth = 1;
    [pen.fillStyle, pen.strokeStyle, pen.textAlign] = [css("--fg"), css("--lab-line"), "right"];
    for (const t of ticks(0, run.end, 4)) pen.fillText(label(t), from - 5, Y(t) + 4);
    const x = run.historyOf(pointed(run), "x");
    for (const [name, image, left] of [["computed", computed, from], ["exact", exact, from + half + gap]]) {
      const X = (x) => left + (x / run.length) * half;
      pen.textAlign = "center";
      pen.drawImage(image, left, top, half, bottom - top);
      pen.strokeStyle = css("--lab-line");
      pen.strokeRect(left, top, half, bottom - top);
      pen.fillStyle = css("--fg");
      pen.fillText(name, left + half / 2, 12);
      pen.fillText("0", left + 4, bottom + 14); pen.fillText(String(run.length), left + half - 16, bottom + 14);
      pen.fillText("x (m)", left + half / 2, bottom + 14);
      if (name === "exact" && run.motion === "thrown") LAB.regions(pen, run, { left, top, half, bottom });
      path(pen, x.map(X), run.t.map(Y), frame, name === "computed");
    }
    pen.strokeStyle = css("--fg"); pen.setLineDash([4, 3]); pen.beginPath(); pen.moveTo(from, Y(run.t[frame])); pen.lineTo(width - 14, Y(run.t[frame])); pen.stroke(); pen.setLineDash([]);
    canvas.lab = { top, bottom, half, lefts: [from, from + half + gap] };
    tellMap(canvas, run, frame);
  }
  // The way of the dragged point through time, and where it is now.
  function path(pen, xs, ys, frame, isComputed) {
    pen.strokeStyle = css("--fg"); pen.lineWidth = 1.5; pen.setLineDash(isComputed ? [] : [2, 3]); pen.beginPath();
    for (let k = 0; k < xs.length; k++) pen[k ? "lineTo" : "moveTo"](xs[k], ys[k]);
    pen.stroke(); pen.setLineDash([]); pen.lineWidth = 1;
    pen.fillStyle = css("--bg"); pen.beginPath(); pen.arc(xs[frame], ys[frame], 6, 0, 7); pen.fill(); pen.stroke();
    pen.fillStyle = css("--fg"); pen.beginPath(); pen.arc(xs[frame], ys[frame], 3, 0, 7); pen.fill();
  }
  function tellMap(canvas, run, frame) {
    canvas.setAttribute("aria-valuenow", pointed(run));
    canvas.setAttribute("aria-valuemax", run.count - 1);
    canvas.setAttribute("aria-valuetext", `material point at ${LAB.round(material(run))} m, ${LAB.seconds(run.t[frame])}`);
    const p = pointed(run), exact = LAB.exact.history(material(run)), MPa = (s) => LAB.round(s / 1e6) + 0;
    let k = 0;
    while (k < exact.t.length - 1 && exact.t[k] < run.t[frame]) k++;
    $("point-words").textContent = `At the point: v = ${LAB.round(run.at("v", frame)[p])} m/s and σ = ${MPa(run.at("s", frame)[p])} MPa computed, ${LAB.round(exact.v[k]) + 0} m/s and ${MPa(exact.s[k])} MPa exact.`;
  }

  // What the picture of the probe shows: values, exact values, and a unit.
  function probed(run) {
    const own = LAB.state.probe;
    if (!run.plane && own >= run.probes.length) {
      const field = LAB.state.field, exact = LAB.exact.history(material(run));
      return { t: run.t, value: run.historyOf(pointed(run), field), exactT: exact.t, exact: exact[field], name: nameOf[field] };
    }
    const name = run.probes[Math.min(own, run.probes.length - 1)];
    return { t: run.history.t, value: run.history[name], exactT: run.history.t, exact: run.history[`${name}_exact`], name };
  }
  function probe(run, frame) {
    if (!run.columns.length) return;
    const { t, value, exactT, exact, name } = probed(run);
    let most = 0;
    for (const x of exact || value) most = Math.max(most, Math.abs(x));
    const cap = 4 * most;
    for (const x of value) most = Math.max(most, Math.min(cap, Math.abs(x)));
    const unit = /stress/.test(name) && most > 1e4 ? 1e6 : /displacement/.test(name) ? 1e-3 : 1;
    most = (1.08 * (most || 1)) / unit;
    const picture = axes($("probe"), 220, { x: [0, run.end], y: [-most, most], name: "t (s)" });
    if (exact) picture.line(exactT, scaled(exact, unit), css("--lab-grey"), 3);
    picture.line(t, scaled(value, unit), css("--lab-blue"));
    picture.cursor(run.t[frame]);
    const units = { 1e6: "MPa", 1e-3: "mm" };
    $("probe-unit").textContent = `(${units[unit] || (/stress/.test(name) ? "Pa" : /angular/.test(name) ? "kg m²/s" : /momentum/.test(name) ? "kg m/s" : "m/s")})`;
    $("probe-exact").hidden = !exact;
    $("probe").setAttribute("aria-label", `History of ${name.replace(/_/g, " ")}${exact ? ", computed and exact" : ""}`);
  }

  function energy(run, frame) {
    if (!run.columns.length) return;
    const { t, kinetic_energy: kinetic, strain_energy: strain, work } = run.history;
    const total = kinetic.map((x, i) => x + strain[i] - (work ? work[i] : 0)), cap = 3 * (kinetic[0] + strain[0] || Infinity);
    let most = 0, least = 0;
    for (let i = 0; i < t.length; i++) {
      most = Math.max(most, Math.min(cap, Math.max(kinetic[i], strain[i], total[i])));
      least = Math.min(least, Math.max(-cap, total[i]));
    }
    const unit = most > 0 && (most >= 1e4 || most < 1e-2) ? 10 ** (3 * Math.floor(Math.log10(most) / 3)) : 1;
    const picture = axes($("energy"), 220, { x: [0, run.end], y: [least / unit, (1.08 * (most || 1)) / unit], name: "t (s)" });
    picture.line(t, scaled(kinetic, unit), css("--lab-blue"));
    picture.line(t, scaled(strain, unit), css("--lab-orange"), 1.6, [6, 3]);
    picture.line(t, scaled(total, unit), css("--lab-green"), 2.2);
    picture.cursor(run.t[frame]);
    $("energy-unit").textContent = `(${unit === 1 ? "" : label(unit) + " "}J)`;
    $("energy-total").textContent = work ? "both, less the work of the load" : "both";
  }
  return { along, map, probe, energy, pointed, material };
})();

// Names the regions of the exact solution of the thrown bar, in each of which v and σ are constant.
LAB.regions = (() => {
  let key = "", found = [];

  // Numbers connected places of the same values.
  function numbered({ values, rows, samples }) {
    const of = new Int32Array(rows * samples).fill(-1), regions = [];
    const same = (a, b) => Math.abs(values[3 * a + 1] - values[3 * b + 1]) + 1e-8 * Math.abs(values[3 * a + 2] - values[3 * b + 2]) < 1e-6;
    for (let start = 0; start < of.length; start++) {
      if (of[start] >= 0) continue;
      const region = regions.length, places = [start];
      of[start] = region;
      for (let n = 0; n < places.length; n++) {
        const at = places[n], i = at % samples;
        for (const next of [i ? at - 1 : -1, i < samples - 1 ? at + 1 : -1, at - samples, at + samples]) {
          if (next >= 0 && next < of.length && of[next] < 0 && same(at, next)) { of[next] = region; places.push(next); }
        }
      }
      regions.push({ places, v: values[3 * start + 1], s: values[3 * start + 2] });
    }
    return { of, regions };
  }

  // Finds for each region the place nearest to its middle where a label fits, in one line or in two.
  function placed(field, wide, high) {
    const { rows, samples } = field, { of, regions } = numbered(field), out = [];
    for (const { places, v, s } of regions) {
      const mean = (f) => places.reduce((sum, at) => sum + f(at), 0) / places.length;
      const [middle, level] = [mean((at) => at % samples), mean((at) => Math.floor(at / samples))];
      const nearest = (wide, high, lines) => {
        let best = null, least = Infinity;
        for (const at of places) {
          const [i, j] = [at % samples, Math.floor(at / samples)], far = ((i - middle) / samples) ** 2 + ((j - level) / rows) ** 2;
          if (far < least && fits(of, of[at], i, j, wide, high, samples, rows)) [best, least] = [{ i, j, v, s, lines }, far];
        }
        return best;
      };
      const best = nearest(wide, high, 1) || nearest(0.55 * wide, 1.9 * high, 2);
      if (best) out.push(best);
    }
    return out;
  }
  function fits(of, own, i, j, wide, high, samples, rows) {
    for (const di of [-wide, -wide / 2, 0, wide / 2, wide]) for (const dj of [-high, high]) {
      const [x, y] = [Math.round(i + di), Math.round(j + dj)];
      if (x < 0 || y < 0 || x >= samples || y >= rows || of[y * samples + x] !== own) return false;
    }
    return true;
  }

  return function draw(pen, run, { left, top, half, bottom }) {
    const field = LAB.exact.field(), texts = ({ v, s }) => [LAB.round(v) + 0, LAB.round(s / 1e6) + 0].map(LAB.pen.label);
    const wide = (26 / half) * field.samples, high = (7 / (bottom - top)) * field.rows * (run.end / LAB.endOf(run));
    const asked = `${field.key} ${wide} ${high}`;
    if (key !== asked) [key, found] = [asked, placed(field, wide, high)];
    pen.save();
    pen.font = "10.5px sans-serif"; pen.textAlign = "center"; pen.textBaseline = "middle";
    for (const region of found) {
      const x = left + (region.i / (field.samples - 1)) * half, t = (region.j / (field.rows - 1)) * LAB.endOf(run);
      const y = bottom - (t / run.end) * (bottom - top), [v, s] = texts(region);
      if (t > run.end) continue;
      if (region.lines === 1) pen.fillText(`${v}, ${s}`, x, y);
      else { pen.fillText(`${v},`, x, y - 6); pen.fillText(s, x, y + 6); }
    }
    pen.restore();
    return found;
  };
})();
