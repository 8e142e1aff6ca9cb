// The lab: controls, time, and when what is computed and drawn. No library, no network.
"use strict";
(() => {
  const lab = document.getElementById("lab");
  // The page for print shows the static picture.
  if (!lab || /print\.html$/.test(location.pathname)) return;

  const $ = (name) => lab.querySelector(`[data-lab="${name}"]`);
  const percent = (x) => (x >= 10 ? Math.round(x) + " times" : 100 * x < 0.01 ? (100 * x).toExponential(1) : (100 * x).toPrecision(3)) + (x >= 10 ? "" : " %");
  const began = performance.now();
  // What is shown, what is being computed, and which of its moments is shown.
  let seen = null, coming = null, frame = 0, playing = false, isHeld = false, isEarly = false;

  // For whoever looks on: what is shown.
  LAB.shown = () => ({ run: seen, frame });

  // --- Runs ------------------------------------------------------------------------------

  // A run that takes longer than this is shown while it is computed (ms).
  const PATIENCE = 150;
  // After this it is shown as soon as it has passed the moment that is looked at (ms).
  const HASTE = 20;
  // So many numbers of particles are kept at most.
  const KEPT = 8e6;

  function compute() {
    const s = LAB.state, run = new LAB.Run();
    $("command").textContent = LAB.command();
    coming = run;
    isHeld = isEarly = false;
    const particles = (s.cells * s.ppc) ** (run.plane ? 2 : 1);
    const moments = Math.max(20, Math.min(160, Math.floor(KEPT / (7 * particles))));
    LAB.program.begin(moments, LAB.motion().scene, LAB.sets(), (parts) => { run.hear(parts); heard(run); });
    setTimeout(busy, PATIENCE);
    LAB.shape.ask();
    LAB.steps.draw();
  }

  // Something new is known of the run that is coming.
  function heard(run) {
    if (run !== coming) return;
    const age = performance.now() - run.began, isLong = age > PATIENCE || run.plane;
    if (run.done) finish(run);
    else if (run !== seen && !isLong && age > HASTE && run.t[run.t.length - 1] > sought(run)) {
      isEarly = true;
      exchange(run);
      draw();
    }
    else if (run !== seen && isLong && run.t.length > 1) exchange(run);
    else if (run === seen) soon();
  }
  function finish(run) {
    coming = null;
    mark(run.limit[1]);
    $("error").textContent = run.error || (run.broken ? `the run broke down: ${run.broken}` : "");
    lab.classList.toggle("lab-stale", Boolean(run.error));
    busy();
    if (run.error) { lab.classList.toggle("lab-plane", LAB.plane()); return ready(); }
    const wasLive = run === seen;
    exchange(run);
    if (wasLive && !isHeld && !isEarly && !playing) frame = run.t.length - 1;
    if (LAB.state.jump !== undefined && !(wasLive && isHeld)) frame = Math.round(LAB.state.jump * (run.t.length - 1));
    delete LAB.state.jump;
    figures();
    draw();
    ready();
  }
  // The moment at which another run will be looked at; at the end it stays at the end.
  function sought(run) {
    if (LAB.state.jump !== undefined) return LAB.state.jump * run.end;
    return !seen || frame >= seen.t.length - 1 ? Infinity : (seen.t[frame] / seen.end) * run.end;
  }
  // Shows another run.
  function exchange(run) {
    if (run !== seen) {
      const time = sought(run);
      seen = run;
      lab.classList.toggle("lab-plane", run.plane);
      lab.classList.remove("lab-stale");
      $("error").textContent = run.error || (run.broken ? `the run broke down: ${run.broken}` : "");
      frame = run.t.length ? run.nearest(time) : 0;
      fillProbes();
    }
    $("frame").max = Math.max(run.t.length - 1, 0);
    soon();
  }

  // While a run is under way it says so, and can be stopped.
  function busy() {
    const run = coming, isLong = run && performance.now() - run.began >= PATIENCE - 1;
    $("running").hidden = !isLong;
    lab.classList.toggle("lab-waits", Boolean(isLong) && run !== seen);
    if (!isLong) return;
    const share = run.sizes.length ? Math.round((100 * run.steps) / run.sizes[2]) : 0;
    $("progress").textContent = run.sizes.length ? `running: ${share} % of ${run.sizes[2]} steps` : "running: the limit of the time step is predicted";
    setTimeout(busy, 200);
  }
  function halt() {
    if (!coming) return;
    const run = coming;
    LAB.program.stop();
    run.broken = `stopped here after ${run.steps} steps`;
    run.done = true;
    run.took = performance.now() - run.began;
    coming = null;
    busy();
    if (run.t.length) exchange(run);
    $("error").textContent = run.broken;
    figures();
    draw();
  }
  function ready() {
    lab.dataset.done = Number(lab.dataset.done || 0) + 1;
    if (lab.dataset.ready === undefined) lab.dataset.ready = Math.round(performance.now() - began);
  }

  function figures() {
    if (!seen) return;
    const s = seen.summary, words = [], own = LAB.state.probe;
    const probe = seen.probes[Math.min(own, seen.probes.length - 1)] || "";
    const say = (name, text) => { if (s[name] !== undefined) words.push(text(s[name])); };
    say(`${probe}_rms_relative`, (x) => `error of ${probe.replace(/_/g, " ")} ${percent(x)}`);
    say("velocity_field_rms_relative", (x) => `of v at the end ${percent(x)}`);
    say("stress_field_rms_relative", (x) => `of σ ${percent(x)}`);
    say("displacement_field_rms_relative", (x) => `of u ${percent(x)}`);
    say("energy_drift", (x) => `energy ${x < 0 ? "−" : "+"}${percent(Math.abs(x))}`);
    words.push(`${seen.count} particles, ${seen.steps} steps`);
    if (seen.limit.length && isFinite(seen.limit[1])) words.push(`limit of c Δt/h ${seen.limit[1].toPrecision(4)}`);
    if (seen.took !== undefined) words.push(`computed here in ${seen.took.toFixed(0)} ms`);
    $("figures").textContent = `${words.join("; ")}.`;
    $("warning").textContent = seen.warnings.replace(/^/gm, seen.warnings && "Warning: ");
  }

  // --- Drawing ---------------------------------------------------------------------------

  let drawing = 0;
  function soon() {
    if (!drawing) drawing = requestAnimationFrame(draw);
  }
  function draw() {
    cancelAnimationFrame(drawing);
    drawing = 0;
    if (!seen) return;
    const last = Math.max(seen.t.length - 1, 0);
    if (seen === coming && !isHeld && !isEarly && !playing) frame = last;
    frame = Math.min(frame, last);
    $("frame").max = last;
    $("frame").value = frame;
    $("now").textContent = seen.t.length ? `t = ${LAB.seconds(seen.t[frame])}` : "";
    $("frame").setAttribute("aria-valuetext", $("now").textContent);
    if (!seen.t.length) return;
    // What is seen may still be that of another motion, while this one is refused or computed.
    if (seen.motion !== LAB.state.motion) return;
    if (seen.plane) LAB.drawPlane(seen, frame);
    else { LAB.bar.along(seen, frame); LAB.bar.map(seen, frame); LAB.shape.draw(); }
    LAB.bar.probe(seen, frame);
    LAB.bar.energy(seen, frame);
    if (seen.drawn === undefined) seen.drawn = performance.now() - seen.began;
  }

  // --- Controls --------------------------------------------------------------------------

  const toSlider = (name, value) => {
    const { least, most, log } = LAB.sliders[name];
    return log ? (1000 * Math.log(value / least)) / Math.log(most / least) : value;
  };
  const fromSlider = (name, place) => {
    const { least, most, log } = LAB.sliders[name];
    return log ? LAB.round(least * (most / least) ** (place / 1000)) : Number(place);
  };
  // Marks the limit on the slider of the Courant number, and what lies beyond it.
  function mark(limit) {
    const isKnown = limit > 0 && isFinite(limit), place = isKnown ? toSlider("cfl", limit) / 1000 : 2, sign = $("mark");
    sign.hidden = place > 1 || place < 0;
    // A thumb is 16 px wide, and its middle does not reach the ends.
    sign.style.left = $("beyond").style.left = `calc(8px + ${Math.min(1, Math.max(0, place))} * (100% - 16px))`;
    $("beyond").hidden = sign.hidden;
    $("limit").textContent = isKnown ? `c Δt/h: the limit is ${limit.toPrecision(4)}${LAB.state.cfl > limit ? ", and this is beyond it" : ""}` : "no limit is known";
  }

  function show() {
    const s = LAB.state, preset = LAB.presets[s.preset];
    for (const name in LAB.sliders) {
      $(name).value = toSlider(name, s[name]);
      $(`${name}-out`).textContent = s[name];
      $(name).setAttribute("aria-valuetext", s[name]);
    }
    for (const name of [...LAB.selects, "field", "colour"]) $(name).value = s[name];
    lab.querySelector(".lab-thrown").hidden = s.motion !== "thrown";
    $("blowup").checked = s.blowup;
    $("x").value = s.x * 480;
    const showRow = (name, on) => ($(name).closest(".lab-row").hidden = !on);
    const rows = { gamma: s.basis === "lme", rho_b: s.integrator === "generalized-alpha", stress: s.integrator === "forward-euler" };
    Object.assign(rows, { throw: s.motion === "thrown", swing: s.motion === "kept", hit: s.motion === "discs", spin: s.motion === "spin", law: LAB.plane() });
    for (const name in rows) showRow(name, rows[name]);
    for (const button of $("presets").children) button.setAttribute("aria-pressed", button.value === s.preset);
    $("words").replaceChildren();
    if (!preset) { $("words").textContent = "A configuration of your own. The presets above lead back to what the book tells of."; return; }
    const link = document.createElement("a");
    [link.href, link.textContent] = preset.link;
    $("words").append(`${preset.words} More in `, link, ".");
  }
  function fillProbes() {
    if (!seen) return;
    const select = $("probe-name"), names = seen.probes.map((name) => name.replace(/_/g, " "));
    if (!seen.plane) names.push(`${LAB.state.field === "v" ? "velocity" : "stress"} of the point in the picture`);
    select.replaceChildren(...names.map((name, i) => new Option(name, i)));
    select.value = Math.min(LAB.state.probe, Math.max(0, names.length - 1));
  }

  function change() {
    show(); LAB.write(); compute();
  }
  function set(name, value) {
    LAB.state[name] = value;
    if (name === "motion") Object.assign(LAB.state, { cells: LAB.motion().start, basis: LAB.motion().plane ? LAB.motion().basis : LAB.state.basis, probe: 0 });
    LAB.state.preset = "";
    change();
  }
  const choose = (name) => () => {
    LAB.state = { ...LAB.fresh(), ...LAB.presets[name].set, preset: name, field: LAB.state.field };
    stop();
    change();
  };

  function build() {
    for (const [name, preset] of Object.entries(LAB.presets)) {
      const button = document.createElement("button");
      [button.type, button.value, button.textContent] = ["button", name, preset.name];
      button.addEventListener("click", choose(name));
      $("presets").append(button);
    }
    for (const name in LAB.sliders) {
      const { least, most, log, whole } = LAB.sliders[name], input = $(name);
      Object.assign(input, log ? { min: 0, max: 1000, step: 1 } : { min: least, max: most, step: whole ? 1 : 0.05 });
      input.addEventListener("input", () => set(name, fromSlider(name, input.value)));
    }
    for (const name of LAB.selects) $(name).addEventListener("change", () => set(name, $(name).value));
    $("blowup").addEventListener("change", () => set("blowup", $("blowup").checked));
    $("probe-name").addEventListener("change", () => { LAB.state.probe = Number($("probe-name").value); LAB.write(); figures(); draw(); });
    for (const name of ["field", "colour"]) $(name).addEventListener("change", () => { LAB.state[name] = $(name).value; LAB.write(); fillProbes(); draw(); });
    $("x").addEventListener("input", () => { LAB.state.x = $("x").value / 480; LAB.shape.draw(); });
    $("copy").addEventListener("click", () => { copy(LAB.command()).then((done) => tell(done ? "The command is copied." : "The command stands below the pictures.")); });
    $("link").addEventListener("click", () => { LAB.write(); copy(location.href).then((done) => tell(done ? "The address is copied." : "The address is in the address bar.")); });
    $("download").addEventListener("click", download);
    $("halt").addEventListener("click", halt);
    LAB.steps.build();
    buildTime();
    buildDrags();
  }
  const tell = (words) => ($("told").textContent = words);
  async function copy(words) {
    try { await navigator.clipboard.writeText(words); return true; } catch { return false; }
  }
  function download() {
    const answer = LAB.program.ask("history", 0, LAB.motion().scene, LAB.sets());
    if (!answer.csv) return tell(LAB.text(answer.error) || LAB.text(answer["csv.error"]));
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([answer.csv], { type: "text/csv" }));
    link.download = answer.broken ? "history.failed.csv" : "history.csv";
    link.click();
    URL.revokeObjectURL(link.href);
    tell(`${link.download} has every step, as the command writes it.`);
  }

  // --- Time, and what is dragged ---------------------------------------------------------

  function to(k) { stop(); isHeld = true; frame = Math.max(0, Math.min(seen.t.length - 1, k)); draw(); }
  function stop() { playing = false; $("play").textContent = "Play"; }
  function play() {
    playing = true; $("play").textContent = "Pause";
    if (frame >= seen.t.length - 1) frame = 0;
    let last = 0;
    const tick = (now) => {
      if (!playing) return;
      if (now - last > 33) { last = now; frame++; draw(); }
      if (frame >= seen.t.length - 1 && seen !== coming) return stop();
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }
  function buildTime() {
    $("frame").addEventListener("input", () => to(Number($("frame").value)));
    $("play").addEventListener("click", () => (playing ? stop() : play()));
    $("back").addEventListener("click", () => to(frame - 1));
    $("on").addEventListener("click", () => to(frame + 1));
  }

  function drag(canvas, follow) {
    const on = (event) => {
      if (!canvas.lab || (event.type === "pointermove" && !(event.buttons & 1))) return;
      const box = canvas.getBoundingClientRect();
      follow(canvas.lab, event.clientX - box.left, event.clientY - box.top);
    };
    canvas.addEventListener("pointerdown", (event) => { try { canvas.setPointerCapture(event.pointerId); } catch {} on(event); });
    canvas.addEventListener("pointermove", on);
  }
  // Moves the point in the picture over position and time, and shows its history.
  function pointTo(point) {
    LAB.state.point = Math.min(1, Math.max(0, Number(point.toFixed(4))));
    LAB.state.probe = seen.probes.length;
    LAB.write(); fillProbes(); figures();
  }
  function buildDrags() {
    for (const name of ["probe", "energy"]) drag($(name), (place, x) => to(seen.nearest(((x - place.left) / (place.right - place.left)) * seen.end)));
    drag($("map"), ({ top, bottom, half, lefts }, x, y) => {
      const left = x < lefts[1] - 7 ? lefts[0] : lefts[1], k = seen.nearest(((bottom - y) / (bottom - top)) * seen.end);
      const at = ((x - left) / half) * seen.length, places = seen.at("x", k);
      let p = 0;
      places.forEach((place, n) => { if (Math.abs(place - at) < Math.abs(places[p] - at)) p = n; });
      pointTo((p + 0.5) / seen.count);
      to(k);
    });
    $("map").addEventListener("keydown", (event) => {
      const p = LAB.bar.pointed(seen), last = seen.count - 1;
      const places = { ArrowLeft: p - 1, ArrowRight: p + 1, Home: 0, End: last, PageDown: p - 10, PageUp: p + 10 };
      const times = { ArrowUp: 1, ArrowDown: -1 }[event.key];
      if (event.key in places) pointTo((Math.max(0, Math.min(last, places[event.key])) + 0.5) / seen.count);
      else if (!times) return;
      event.preventDefault();
      event.stopPropagation(); // The book turns its pages by the same keys.
      to(frame + (times || 0));
    });
    for (const name of ["N", "slope", "force"]) drag($(name), (place, x) => {
      const [from, end] = place.box.x;
      LAB.state.x = Math.min(1, Math.max(0, (from + ((x - place.left) / (place.right - place.left)) * (end - from)) / 8));
      $("x").value = LAB.state.x * 480;
      LAB.shape.draw();
    });
  }

  // The solver is a script of its own, so that only this page loads it, from a disk, too.
  function begin() {
    build();
    const options = (name) => ($(name) && $(name).options ? [...$(name).options].map((option) => option.value) : []);
    if (!LAB.read(options)) LAB.state = { ...LAB.fresh(), preset: "dispersion" };
    lab.classList.add("lab-on");
    lab.classList.toggle("lab-plane", LAB.plane());
    show();
    compute();
    let width = 0;
    new ResizeObserver(() => { if (lab.clientWidth !== width) { width = lab.clientWidth; draw(); LAB.steps.draw(); } }).observe(lab);
    new MutationObserver(() => { LAB.pen.forget(); draw(); LAB.steps.draw(); }).observe(document.documentElement, { attributes: true, attributeFilter: ["class"] });
    addEventListener("hashchange", () => { if (LAB.read(options)) change(); });
  }
  const script = document.createElement("script");
  script.src = lab.dataset.solver;
  script.onload = begin;
  document.head.append(script);
})();
