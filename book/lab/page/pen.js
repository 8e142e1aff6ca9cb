// Canvases: axes, lines, dots and colours.
"use strict";

LAB.pen = (() => {
  // Colours are asked for often, and change with the theme only.
  let known = new Map();
  function css(name) {
    if (!known.has(name)) known.set(name, getComputedStyle(document.getElementById("lab")).getPropertyValue(name).trim());
    return known.get(name);
  }
  const forget = () => { known = new Map(); shades = null; };

  function ticks(least, most, about) {
    const raw = (most - least) / about, power = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].find((n) => n * power >= raw) * power, out = [];
    if (!(step > 0)) return out;
    for (let n = Math.ceil(least / step - 1e-9); n * step <= most + 1e-9 * step; n++) out.push(n * step);
    return out;
  }
  const label = (x) => (Math.abs(x) < 1e-300 ? "0" : Math.abs(x) >= 1e4 || Math.abs(x) < 1e-3 ? x.toExponential(0) : String(Number(x.toPrecision(4)))).replace("-", "−");

  // Makes a canvas sharp, and gives its context and size.
  function open(canvas, height) {
    const width = canvas.clientWidth, scale = window.devicePixelRatio || 1;
    const [wide, high] = [Math.round(width * scale), Math.round(height * scale)];
    if (canvas.width !== wide || canvas.height !== high) {
      canvas.style.height = `${height}px`;
      [canvas.width, canvas.height] = [wide, high];
    }
    const pen = canvas.getContext("2d");
    pen.setTransform(scale, 0, 0, scale, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.font = "12px sans-serif";
    return [pen, width, height];
  }

  // The grid of lines and its numbers.
  function frame(pen, width, height, box, place) {
    const { X, Y, left, right, top, bottom } = place;
    pen.fillStyle = css("--fg");
    pen.strokeStyle = css("--lab-line");
    pen.lineWidth = 1;
    pen.textAlign = "center";
    pen.globalAlpha = 0.5;
    pen.beginPath();
    const xs = ticks(...box.x, Math.max(2, width / 110)), ys = ticks(...box.y, 4);
    for (const x of xs) { pen.moveTo(X(x), top); pen.lineTo(X(x), bottom); }
    for (const y of ys) { pen.moveTo(left, Y(y)); pen.lineTo(right, Y(y)); }
    pen.stroke();
    pen.globalAlpha = 1;
    for (const x of xs) pen.fillText(label(x), X(x), bottom + 14);
    pen.textAlign = "right";
    for (const y of ys) pen.fillText(label(y), left - 5, Y(y) + 4);
    pen.fillText(box.name, right, height - 4);
  }

  // Draws axes and gives what draws over them.
  function axes(canvas, height, box) {
    const [pen, width] = open(canvas, height);
    const left = 50, right = width - 14, top = 8, bottom = height - 32;
    const X = (x) => left + ((x - box.x[0]) / (box.x[1] - box.x[0])) * (right - left);
    const Y = (y) => bottom - ((y - box.y[0]) / (box.y[1] - box.y[0])) * (bottom - top);
    frame(pen, width, height, box, { X, Y, left, right, top, bottom });
    canvas.lab = { X, Y, left, right, top, bottom, box };
    const near = (y) => Math.max(-1e4, Math.min(1e4, Y(y)));
    const inside = (paint) => {
      pen.save(); pen.beginPath(); pen.rect(left, top, right - left, bottom - top); pen.clip(); paint(); pen.restore();
    };
    const line = (xs, ys, colour, thick = 1.6, dashes = []) => inside(() => {
      pen.strokeStyle = colour; pen.lineWidth = thick; pen.lineJoin = "round"; pen.setLineDash(dashes); pen.beginPath();
      for (let i = 0; i < xs.length; i++) pen[i ? "lineTo" : "moveTo"](X(xs[i]), near(ys[i]));
      pen.stroke();
    });
    const dots = (xs, ys, colour, size = 2.2) => inside(() => {
      pen.fillStyle = colour;
      for (let i = 0; i < xs.length; i++) { pen.beginPath(); pen.arc(X(xs[i]), near(ys[i]), size, 0, 7); pen.fill(); }
    });
    const cursor = (x) => line([x, x], box.y, css("--fg"), 1, [4, 3]);
    return { pen, X, Y, left, right, top, bottom, line, dots, cursor, inside };
  }

  // Shades of a value from −1 to 1 as pixels: blue below, orange above, the ground between.
  let shades = null;
  function shade(value) {
    if (!shades) {
      const dot = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
      const rgb = (text) => { dot.fillStyle = text; dot.fillRect(0, 0, 1, 1); return dot.getImageData(0, 0, 1, 1).data; };
      const [ground, low, high] = [css("--bg"), css("--lab-blue"), css("--lab-orange")].map(rgb);
      shades = new Uint32Array(401);
      for (let i = -200; i <= 200; i++) {
        const end = i < 0 ? low : high, part = Math.abs(i) / 200;
        const mix = (c) => Math.round(ground[c] + (end[c] - ground[c]) * part);
        shades[i + 200] = 0xff000000 + mix(0) + 256 * mix(1) + 65536 * mix(2);
      }
    }
    return shades[200 + Math.max(-200, Math.min(200, Math.round(200 * value)))];
  }
  const shadeText = (value) => { const n = shade(value); return `rgb(${n & 255},${(n >> 8) & 255},${(n >> 16) & 255})`; };
  return { css, forget, ticks, label, open, axes, shade, shadeText };
})();
