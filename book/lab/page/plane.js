// Bodies in the plane, particle by particle.
"use strict";

LAB.drawPlane = (() => {
  const { css, open, shadeText } = LAB.pen;

  // What was on one side of each body stays in its colour, so that one sees it turn.
  function isFirst(run, X, Y) {
    if (run.motion === "spin") return Math.floor(8 * X) % 2 === (Y < 0.125 ? 0 : 1);
    const middle = X + Y < 1 ? 0.2 : 0.8;
    return (X < middle) === (Y < middle);
  }
  function colour(run, frame, p) {
    const i = p * run.width, f = run.frames[frame];
    if (LAB.state.colour === "stress") return shadeText(f[i + 6] / (0.6 * run.most.s || 1));
    if (LAB.state.colour === "speed") return shadeText(Math.hypot(f[i + 4], f[i + 5]) / (1.2 * run.most.v || 1));
    return css(isFirst(run, f[i] - f[i + 2], f[i + 1] - f[i + 3]) ? "--lab-blue" : "--lab-orange");
  }

  return function draw(run, frame) {
    const canvas = document.querySelector('#lab [data-lab="plane"]'), width = canvas.clientWidth;
    const [pen, , height] = open(canvas, Math.min(width, 440));
    const { middle, reach } = LAB.motions[run.motion], scale = height / (2 * reach);
    const X = (x) => width / 2 + (x - middle[0]) * scale, Y = (y) => height / 2 - (y - middle[1]) * scale;
    pen.strokeStyle = css("--lab-line");
    pen.strokeRect(X(middle[0] - reach) + 1, 1, 2 * reach * scale - 2, height - 2);
    pen.fillStyle = css("--fg");
    pen.fillRect(X(middle[0] - reach) + 10, height - 14, 0.1 * scale, 2);
    pen.fillText("0.1 m", X(middle[0] - reach) + 10, height - 20);
    if (!run.t.length) return;
    const f = run.frames[frame], size = Math.max(1.5, 0.9 * spacing(run) * scale / 2);
    for (let p = 0; p < run.count; p++) {
      const [x, y] = [X(f[p * run.width]), Y(f[p * run.width + 1])];
      pen.fillStyle = colour(run, frame, p);
      pen.fillRect(x - size, y - size, 2 * size, 2 * size);
    }
    const what = run.motion === "spin" ? "a spinning bar" : "two discs";
    canvas.setAttribute("aria-label", `${run.count} particles of ${what} at ${LAB.seconds(run.t[frame])}`);
  };

  // The distance of two particles at the start (m).
  function spacing(run) {
    const f = run.frames[0], i = run.width;
    const X = (p) => f[p * i] - f[p * i + 2], Y = (p) => f[p * i + 1] - f[p * i + 3];
    return run.count > 1 ? Math.max(Math.abs(X(1) - X(0)), Math.abs(Y(1) - Y(0))) : 0.05;
  }
})();
