// The program itself, as WebAssembly: in the page for what takes a moment, and in a worker for runs.
"use strict";
window.LAB = window.LAB || {};

// Makes a speaker for the interface that `book/lab/src/lib.rs` tells of. It uses nothing from outside,
// since a worker gets it as text.
LAB.speaker = function (module) {
  let program = null;
  const words = (bytes) => new TextDecoder().decode(bytes);

  // Copies the parts of an answer out, and gives it back.
  function take(answer) {
    const memory = program.memory.buffer, view = new DataView(memory);
    const end = answer + 4 + view.getUint32(answer, true), parts = {};
    const piece = (at) => memory.slice(at + 4, at + 4 + view.getUint32(at, true));
    for (let at = answer + 4; at < end;) {
      const name = piece(at);
      at += 4 + name.byteLength;
      parts[words(name)] = piece(at);
      at += 4 + view.getUint32(at, true);
    }
    program.free(answer, end - answer);
    return parts;
  }

  function guarded(call) {
    try {
      program = program || new WebAssembly.Instance(module, {}).exports;
      return take(call());
    } catch (trap) {
      program = null; // Its memory cannot be trusted any more.
      const words = `the program stopped in the page: ${trap.message}`;
      return { error: new TextEncoder().encode(words).buffer, done: new ArrayBuffer(0) };
    }
  }

  return {
    ask(name, number, scene, sets) {
      const request = new TextEncoder().encode([number, scene, ...sets].join("\0"));
      return guarded(() => {
        const at = program.alloc(request.length);
        new Uint8Array(program.memory.buffer, at, request.length).set(request);
        return program[name](at, request.length);
      });
    },
    goOn: (steps) => guarded(() => program.go_on(steps)),
  };
};

// Makes a function that takes a run on in pieces, until it is over or another one begins. `hear`
// gets each answer; `later` lets the page, or the next message to a worker, have its turn.
LAB.marcher = function (speak, later) {
  const PIECE = 12; // ms
  let newest = 0;
  function march(number, scene, sets, hear) {
    const own = ++newest, begun = speak.ask("begin", number, scene, sets);
    if (begun.error) {
      hear({ ...speak.ask("limit", 0, scene, sets), ...begun, done: new ArrayBuffer(0) });
      return;
    }
    hear(begun);
    let steps = 16;
    const piece = () => {
      if (own !== newest) return;
      const start = performance.now();
      for (let before = start, now = start; now - start < PIECE; before = now) {
        const answer = speak.goOn(steps);
        hear(answer);
        if (answer.done) return;
        now = performance.now();
        const factor = (PIECE / 2) / Math.max(now - before, 0.05);
        steps = Math.max(1, Math.ceil(steps * Math.min(8, factor)));
      }
      later(piece);
    };
    piece();
  }
  march.stop = () => { newest++; };
  return march;
};

// What a worker does: it gets the compiled program, and then runs, each with a number of its own.
LAB.worker = function (speaker, marcher) {
  let march = null, next = null;
  const turn = new MessageChannel();
  turn.port1.onmessage = () => next();
  const later = (piece) => { next = piece; turn.port2.postMessage(0); };
  onmessage = ({ data }) => {
    if (data.module) { march = marcher(speaker(data.module), later); return; }
    const hear = (parts) => postMessage({ run: data.run, parts }, Object.values(parts));
    march(data.number, data.scene, data.sets, hear);
  };
};

LAB.program = (() => {
  let module = null, speak = null, worker = null, here = null, noWorker = false;
  // The number of the newest run, and who hears of it.
  let run = 0, heard = () => {}, last = null;
  // Since when a run has not been answered, and the one to follow it.
  let beginning = 0, waiting = null;

  function compiled() {
    if (module) return module;
    const binary = atob(window.LAB_SOLVER.wasm), bytes = new Uint8Array(binary.length);
    for (let i = 0; i < bytes.length; i++) bytes[i] = binary.charCodeAt(i);
    module = new WebAssembly.Module(bytes);
    return module;
  }

  // Asks for what takes a moment.
  function ask(name, number, scene, sets) {
    speak = speak || LAB.speaker(compiled());
    return speak.ask(name, number, window.LAB_SOLVER.scenes[scene], sets);
  }

  // A page from a disk may have no worker from a file, but one from its own text.
  function start() {
    const source = `(${LAB.worker})(${LAB.speaker}, ${LAB.marcher});`;
    const address = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
    worker = new Worker(address);
    worker.onerror = () => { stopWorker(); noWorker = true; send(last); };
    worker.onmessage = ({ data }) => {
      beginning = 0;
      const then = waiting;
      waiting = null;
      if (then) send(then);
      else if (data.run === run) heard(data.parts);
    };
    worker.postMessage({ module: compiled() });
  }
  function stopWorker() {
    if (worker) worker.terminate();
    [worker, beginning, waiting] = [null, 0, null];
  }

  function send(request) {
    last = request;
    try {
      if (noWorker) throw new Error("no worker");
      if (!worker) start();
      beginning = performance.now();
      worker.postMessage(request);
    } catch {
      // Without a worker the page itself computes, and has its turn after each piece.
      noWorker = true;
      stopWorker();
      here = here || LAB.marcher(LAB.speaker(compiled()), (piece) => setTimeout(piece, 0));
      here(request.number, request.scene, request.sets, (parts) => { if (request.run === run) heard(parts); });
    }
  }

  // Runs a scene; `hear` gets its answers. A run that is under way is dropped.
  function begin(number, scene, sets, hear) {
    run += 1;
    heard = hear;
    const request = { run, number, scene: window.LAB_SOLVER.scenes[scene], sets };
    if (worker && beginning && performance.now() - beginning > 400) stopWorker();
    if (worker && beginning) waiting = request;
    else send(request);
  }

  // Ends a run at once, whatever it does.
  function stop() {
    stopWorker();
    if (here) here.stop();
    heard = () => {};
    run += 1;
  }
  return { ask, begin, stop, isWorker: () => Boolean(worker) };
})();

// Answers are bytes.
LAB.text = (bytes) => (bytes ? new TextDecoder().decode(bytes) : "");
LAB.list = (bytes) => (bytes ? new Float64Array(bytes) : new Float64Array(0));
LAB.lines = (bytes) => { const all = LAB.text(bytes); return all ? all.split("\n") : []; };
