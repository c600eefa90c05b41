"use strict";
// What is drawn over the solids: frames, axes, centres of mass, inertias, dimensions, gravity, the floor's grid.

const COLOURS = {
  light: {
    paper: "#fbfcfc", ink: "#1d2833", quiet: "#5d6873", grid: "#e2e6ea", chain: "#9a5b33", mass: "#6b2fb3",
    gravity: "#3c4752", x: "#d12f2f", y: "#1d8a34", z: "#2463d1", tool: "#a3148c", dimension: "#0f766e",
    links: [[110, 129, 150], [158, 170, 182]], base: [128, 130, 134], revolute: [228, 128, 48], marked: [200, 30, 60],
    prismatic: [30, 148, 140], fixed: [140, 143, 147], lever: [150, 118, 44], body: [72, 120, 84], rod: [186, 194, 190],
  },
  dark: {
    paper: "#14191e", ink: "#e6ebef", quiet: "#9aa6b1", grid: "#29323a", chain: "#d39a70", mass: "#c39bf5",
    gravity: "#c3ccd4", x: "#ff6b6b", y: "#5fce74", z: "#74a7ff", tool: "#f08ad8", dimension: "#5ad0c4",
    links: [[104, 124, 146], [142, 156, 170]], base: [112, 116, 122], revolute: [222, 128, 56], marked: [255, 92, 116],
    prismatic: [36, 150, 142], fixed: [122, 126, 132], lever: [176, 142, 64], body: [84, 138, 98], rod: [176, 186, 181],
  },
};

function stroke(pen, points, colour, width, dash = []) {
  pen.strokeStyle = colour;
  pen.lineWidth = width;
  pen.setLineDash(dash);
  pen.beginPath();
  points.forEach((p, k) => (k ? pen.lineTo(p[0], p[1]) : pen.moveTo(p[0], p[1])));
  pen.stroke();
  pen.setLineDash([]);
}

function arrowhead(pen, from, to, size, colour) {
  const dx = to[0] - from[0], dy = to[1] - from[1], length = Math.hypot(dx, dy);
  if (length < 1) return;
  const ux = (dx / length) * size, uy = (dy / length) * size;
  pen.fillStyle = colour;
  pen.beginPath();
  pen.moveTo(to[0], to[1]);
  pen.lineTo(to[0] - ux - 0.42 * uy, to[1] - uy + 0.42 * ux);
  pen.lineTo(to[0] - ux + 0.42 * uy, to[1] - uy - 0.42 * ux);
  pen.fill();
}

function arrow(pen, from, to, colour, width, head) {
  const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
  const size = Math.min(head, length);
  const stop = length > 0 ? 1 - (0.8 * size) / length : 0;
  stroke(pen, [from, [from[0] + stop * (to[0] - from[0]), from[1] + stop * (to[1] - from[1])]], colour, width);
  arrowhead(pen, from, to, size, colour);
}

function drawFrame(pen, view, labels, pose, length, letters, colours) {
  const at = view.project(origin(pose));
  // The axis that points away is drawn first.
  const order = [0, 1, 2].sort((a, b) => dot(axis(pose, a), view.near) - dot(axis(pose, b), view.near));
  for (const k of order) {
    const tip = view.project(sum(origin(pose), times(length, axis(pose, k))));
    arrow(pen, at, tip, colours["xyz"[k]], 2, 8);
    if (letters && Math.hypot(tip[0] - at[0], tip[1] - at[1]) > 14) {
      const d = Math.hypot(tip[0] - at[0], tip[1] - at[1]);
      const out = [tip[0] + ((tip[0] - at[0]) / d) * 4, tip[1] + ((tip[1] - at[1]) / d) * 4];
      labels.add(out, "xyz"[k], colours["xyz"[k]], { size: 11, important: -1, near: true });
    }
  }
  labels.avoid(at, 5);
}

// The drawing office's sign of a centre of mass.
function drawCentre(pen, p, r, colour, paper) {
  pen.fillStyle = paper;
  pen.beginPath();
  pen.arc(p[0], p[1], r, 0, 7);
  pen.fill();
  pen.fillStyle = colour;
  for (const start of [0, Math.PI]) {
    pen.beginPath();
    pen.moveTo(p[0], p[1]);
    pen.arc(p[0], p[1], r, start, start + Math.PI / 2);
    pen.fill();
  }
  pen.strokeStyle = colour;
  pen.lineWidth = 1.2;
  pen.beginPath();
  pen.arc(p[0], p[1], r, 0, 7);
  pen.stroke();
}

// Outline and principal sections of an ellipsoid about `at`; half: three vectors [m]. hollow: not filled.
function drawEllipsoid(pen, view, at, half, colour, strong, hollow) {
  const c = view.project(at), d = half.map((v) => view.direction(v));
  const ring = (u, v) => Array.from({ length: 49 }, (_, k) => {
    const t = (k * Math.PI) / 24;
    return [c[0] + Math.cos(t) * u[0] + Math.sin(t) * v[0], c[1] + Math.cos(t) * u[1] + Math.sin(t) * v[1]];
  });
  // The outline of a sphere's image under the matrix M has the axes of M M^T.
  const xx = d.reduce((t, v) => t + v[0] * v[0], 0), xy = d.reduce((t, v) => t + v[0] * v[1], 0);
  const yy = d.reduce((t, v) => t + v[1] * v[1], 0), tilt = Math.atan2(2 * xy, xx - yy) / 2;
  const root = Math.hypot((xx - yy) / 2, xy);
  const a = Math.sqrt((xx + yy) / 2 + root), b = Math.sqrt(Math.max(0, (xx + yy) / 2 - root));
  pen.beginPath();
  pen.ellipse(c[0], c[1], a, b, tilt, 0, 7);
  pen.fillStyle = pen.strokeStyle = colour;
  pen.globalAlpha = strong ? 0.22 : 0.06;
  if (!hollow) pen.fill();
  pen.globalAlpha = strong ? 1 : 0.4;
  pen.lineWidth = 1;
  pen.stroke();
  pen.globalAlpha = strong ? 0.7 : 0.16;
  for (const [i, j] of [[0, 1], [0, 2], [1, 2]]) stroke(pen, ring(d[i], d[j]), colour, 0.8);
  pen.globalAlpha = 1;
}

// A dimension beside the line from a to b, in pixels.
function drawDimension(pen, labels, a, b, text, colour, important) {
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
  if (length < 12) {
    labels.add([(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], text, colour, { important });
    return;
  }
  const side = b[0] - a[0] > 0.01 || (Math.abs(b[0] - a[0]) <= 0.01 && b[1] > a[1]) ? 1 : -1; // below the line, or left of it
  const nx = (-(b[1] - a[1]) / length) * side, ny = ((b[0] - a[0]) / length) * side, off = 20;
  const [c, d] = [a, b].map((p) => [p[0] + off * nx, p[1] + off * ny]);
  for (const [p, e] of [[a, c], [b, d]]) stroke(pen, [[p[0] + 4 * nx, p[1] + 4 * ny], [e[0] + 4 * nx, e[1] + 4 * ny]], colour, 0.9);
  stroke(pen, [c, d], colour, 1.1);
  arrowhead(pen, d, c, 7, colour);
  arrowhead(pen, c, d, 7, colour);
  labels.add([(c[0] + d[0]) / 2, (c[1] + d[1]) / 2], text, colour, { important });
}

// A step of 1, 2 or 5 by a power of ten near a length.
function roundStep(length) {
  const power = 10 ** Math.floor(Math.log10(length)), share = length / power;
  return (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10) * power;
}

// Squares across gravity, at the height of the base.
function drawGrid(pen, view, middle, size, step, colour) {
  const h = dot(middle, view.z), n = Math.ceil(size / step);
  const round = (axis) => Math.round(dot(middle, axis) / step);
  const [i0, j0] = [round(view.x), round(view.y)];
  const at = (i, j) => view.project(sum(sum(times(i * step, view.x), times(j * step, view.y)), times(h, view.z)));
  for (let k = -n; k <= n; k++) {
    stroke(pen, [at(i0 + k, j0 - n), at(i0 + k, j0 + n)], colour, 1);
    stroke(pen, [at(i0 - n, j0 + k), at(i0 + n, j0 + k)], colour, 1);
  }
}

function toSegment(x, y, a, b) {
  const dx = b[0] - a[0], dy = b[1] - a[1], square = dx * dx + dy * dy;
  const t = square > 0 ? Math.max(0, Math.min(1, ((x - a[0]) * dx + (y - a[1]) * dy) / square)) : 0;
  return Math.hypot(x - a[0] - t * dx, y - a[1] - t * dy);
}
