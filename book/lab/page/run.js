// A run as the pictures see it, filled by the answers of the program as they come.
"use strict";

LAB.Run = class {
  constructor() {
    this.began = performance.now();
    this.plane = LAB.plane();
    this.motion = LAB.state.motion;
    this.length = LAB.motion().length;
    Object.assign(this, { t: [], frames: [], columns: [], history: {}, probes: [], summary: {}, warnings: "" });
    Object.assign(this, { error: "", broken: "", done: false, sizes: [], limit: [], count: 0, steps: 0, end: 1 });
    this.most = { v: 0, s: 0 };
  }

  // Takes an answer up.
  hear(parts) {
    if (parts.error) this.error = LAB.text(parts.error);
    if (parts.broken) this.broken = LAB.text(parts.broken);
    if (parts.limit) this.limit = LAB.list(parts.limit);
    if (parts.sizes) {
      this.sizes = LAB.list(parts.sizes);
      this.end = this.sizes[3] || 1;
    }
    if (parts.step) this.steps = LAB.list(parts.step)[0];
    if (parts.t) this.hearFrames(LAB.list(parts.t), LAB.list(parts.particles));
    if (parts.history) this.hearHistory(LAB.lines(parts["history.columns"]), LAB.list(parts.history));
    if (parts.summary) {
      const values = LAB.list(parts.summary);
      LAB.lines(parts["summary.names"]).forEach((name, i) => { this.summary[name] = values[i]; });
      this.warnings = LAB.text(parts.warnings);
    }
    if (!parts.done) return;
    this.done = true;
    this.took = performance.now() - this.began;
    if (this.broken && this.t.length) this.end = this.t[this.t.length - 1] || this.end;
  }

  hearFrames(t, particles) {
    if (!t.length) return;
    // Place, displacement and velocity along each axis, and a stress.
    const width = this.plane ? 7 : 4, each = particles.length / t.length;
    this.width = width;
    this.count = each / width;
    t.forEach((time, k) => {
      this.t.push(time);
      this.frames.push(particles.subarray(k * each, (k + 1) * each));
    });
    const v = width - 2, s = width - 1;
    for (let i = 0; i < particles.length; i += width) {
      this.most.v = Math.max(this.most.v, Math.abs(particles[i + v]));
      this.most.s = Math.max(this.most.s, Math.abs(particles[i + s]));
    }
  }

  hearHistory(columns, rows) {
    const width = columns.length;
    if (!this.columns.length) {
      this.columns = columns;
      for (const name of columns) this.history[name] = [];
      const fixed = ["step", "t", "kinetic_energy", "strain_energy", "work", "momentum"];
      this.probes = columns.filter((name) => !fixed.includes(name) && !name.endsWith("_exact"));
    }
    for (let i = 0; i < rows.length; i++) this.history[columns[i % width]].push(rows[i]);
  }

  // A column of the particles at one moment.
  at(name, k) {
    const places = this.plane ? { x: 0, y: 1, u: 2, w: 3, vx: 4, vy: 5, s: 6 } : { x: 0, u: 1, v: 2, s: 3 };
    const out = new Float64Array(this.count), frame = this.frames[k], place = places[name];
    for (let p = 0; p < this.count; p++) out[p] = frame[p * this.width + place];
    return out;
  }

  // The moment that is nearest to a time.
  nearest(t) {
    let low = 0, high = this.t.length - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.t[middle] < t) low = middle + 1;
      else high = middle;
    }
    return low > 0 && t - this.t[low - 1] < this.t[low] - t ? low - 1 : low;
  }

  // The history of one particle, moment by moment.
  historyOf(p, name) {
    const place = { x: 0, u: 1, v: 2, s: 3 }[name];
    return this.frames.map((frame) => frame[p * this.width + place]);
  }
};

// The exact solution of the bar depends on its motion alone, so it is asked for once for each.
LAB.exact = (() => {
  const ROWS = 160;
  let key = "", found = null, now = { key: "" }, point = { key: "" };
  const own = () => [LAB.motion().scene, ...LAB.setsOfMotion()].join(" ");
  const ask = (name, number) => LAB.list(LAB.program.ask(name, number, LAB.motion().scene, LAB.setsOfMotion()).exact);

  // x, v and σ at `rows` moments from the start to the end, and the largest v and σ.
  function field() {
    if (key === own()) return found;
    key = own();
    const values = ask("exact", ROWS), most = { v: 0, s: 0 };
    for (let i = 0; i < values.length; i += 3) {
      most.v = Math.max(most.v, Math.abs(values[i + 1]));
      most.s = Math.max(most.s, Math.abs(values[i + 2]));
    }
    found = { key, rows: ROWS, samples: values.length / 3 / ROWS, values, most: { v: most.v || 1, s: most.s || 1 } };
    return found;
  }
  // x, v and σ along the bar at one moment.
  function moment(t) {
    const asked = `${own()} ${t}`;
    if (now.key !== asked) {
      const values = ask("moment", t), of = (i) => values.filter((_, n) => n % 3 === i);
      now = { key: asked, x: of(0), v: of(1), s: of(2) };
    }
    return now;
  }
  // t, v and σ of one material point.
  function history(X) {
    const asked = `${own()} ${X}`;
    if (point.key !== asked) {
      const values = ask("point", X), of = (i) => values.filter((_, n) => n % 4 === i);
      point = { key: asked, t: of(0), v: of(1), s: of(2) };
    }
    return point;
  }
  return { field, moment, history };
})();
