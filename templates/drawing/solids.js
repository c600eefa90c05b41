"use strict";
// Solid parts, shaded, painted from far to near.

const grey = (c) => `rgb(${c.map((x) => Math.round(Math.max(0, Math.min(255, x)))).join(",")})`;
const mixed = (a, b, t) => a.map((x, k) => x + t * (b[k] - x));
const lighter = (c, t) => grey(mixed(c, [255, 255, 255], t));
const darker = (c, t) => grey(mixed(c, [0, 0, 0], t));

class Solids {
  // piece: length [m] of the pieces that bars are painted in.
  constructor(view, piece) {
    this.view = view;
    this.piecesOf = piece;
    this.parts = [];
  }

  paint(pen) {
    this.parts.sort((a, b) => a.depth - b.depth);
    for (const part of this.parts) part.paint(pen);
  }

  // A round bar between two points; in pieces, so that other parts are before or behind it where they should be.
  tube(from, to, radius, colour, round = true) {
    const { view } = this, r = radius * view.scale;
    const length = norm(difference(to, from));
    const count = Math.max(1, Math.min(80, Math.ceil(length / this.piecesOf)));
    const start = view.project(from);
    for (let k = 0; k < count; k++) {
      const a = view.project(sum(from, times(k / count, difference(to, from))));
      const b = view.project(sum(from, times((k + 1) / count, difference(to, from))));
      this.parts.push({ depth: (a[2] + b[2]) / 2, paint: (pen) => this.piece(pen, a, b, r, colour, start) });
    }
    if (round) for (const end of [from, to]) this.ball(end, radius, colour);
  }

  // start: a point of the bar's middle line; all pieces have one shading.
  piece(pen, a, b, r, colour, start) {
    const dx = b[0] - a[0], dy = b[1] - a[1], length = Math.hypot(dx, dy);
    if (length < 0.3) return;
    const nx = (-dy / length) * r, ny = (dx / length) * r;
    const ex = (dx / length) * 0.4, ey = (dy / length) * 0.4; // no seams between pieces
    pen.fillStyle = this.across(pen, start, nx, ny, colour);
    pen.beginPath();
    pen.moveTo(a[0] + nx - ex, a[1] + ny - ey);
    pen.lineTo(b[0] + nx + ex, b[1] + ny + ey);
    pen.lineTo(b[0] - nx + ex, b[1] - ny + ey);
    pen.lineTo(a[0] - nx - ex, a[1] - ny - ey);
    pen.fill();
  }

  // Light from the upper left.
  across(pen, a, nx, ny, colour) {
    const flip = nx + ny > 0 ? -1 : 1;
    const g = pen.createLinearGradient(a[0] + flip * nx, a[1] + flip * ny, a[0] - flip * nx, a[1] - flip * ny);
    g.addColorStop(0, darker(colour, 0.18));
    g.addColorStop(0.3, lighter(colour, 0.28));
    g.addColorStop(0.6, grey(colour));
    g.addColorStop(1, darker(colour, 0.42));
    return g;
  }

  ball(at, radius, colour) {
    const p = this.view.project(at), r = radius * this.view.scale;
    this.parts.push({
      depth: p[2],
      paint: (pen) => {
        const g = pen.createRadialGradient(p[0] - 0.35 * r, p[1] - 0.35 * r, 0.05 * r, p[0], p[1], r);
        g.addColorStop(0, lighter(colour, 0.3));
        g.addColorStop(0.6, grey(colour));
        g.addColorStop(1, darker(colour, 0.38));
        pen.fillStyle = g;
        pen.beginPath();
        pen.arc(p[0], p[1], r, 0, 7);
        pen.fill();
      },
    });
  }

  // A drum about an axis (unit vector), `half` of its length to each side.
  drum(at, axis, half, radius, colour) {
    const { view } = this;
    const near = dot(axis, view.near) < 0 ? -1 : 1;
    const a = view.project(sum(at, times(-near * half, axis))), b = view.project(sum(at, times(near * half, axis)));
    const r = radius * view.scale, flat = Math.abs(dot(axis, view.near)) * r;
    const tilt = Math.atan2(b[1] - a[1], b[0] - a[0]) + Math.PI / 2;
    const cap = (pen, p) => {
      pen.beginPath();
      pen.ellipse(p[0], p[1], r, flat, tilt, 0, 7);
      pen.fill();
    };
    this.parts.push({
      depth: view.project(at)[2] + 0.5 * r,
      paint: (pen) => {
        const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
        pen.fillStyle = this.across(pen, a, (-(b[1] - a[1]) / length) * r, ((b[0] - a[0]) / length) * r, colour);
        cap(pen, a);
        this.piece(pen, a, b, r, colour, a);
        pen.fillStyle = lighter(colour, 0.22);
        cap(pen, b);
        pen.strokeStyle = darker(colour, 0.45);
        pen.lineWidth = 0.8;
        pen.stroke();
      },
    });
  }

  // A box about a point; half: three vectors from its middle to its faces [m].
  box(at, half, colour) {
    const { view } = this, light = unit(sum(sum(view.near, times(0.7, view.up)), times(-0.5, view.right)));
    const faces = [];
    for (let k = 0; k < 3; k++) {
      for (const side of [1, -1]) {
        const normal = times(side, half[k]);
        if (dot(normal, view.near) <= 0) continue;
        const [u, v] = [half[(k + 1) % 3], half[(k + 2) % 3]];
        const corners = [[1, 1], [-1, 1], [-1, -1], [1, -1]].map(([s, t]) =>
          view.project(sum(sum(at, normal), sum(times(s, u), times(t, v)))));
        faces.push([corners, Math.max(0, dot(unit(normal), light))]);
      }
    }
    this.parts.push({
      depth: view.project(at)[2] + 0.5 * view.scale * Math.min(...half.map(norm)),
      paint: (pen) => {
        for (const [corners, bright] of faces) {
          pen.fillStyle = grey(mixed(mixed(colour, [0, 0, 0], 0.4), mixed(colour, [255, 255, 255], 0.3), bright));
          pen.strokeStyle = darker(colour, 0.45);
          pen.lineWidth = 0.8;
          pen.beginPath();
          corners.forEach((c, k) => (k ? pen.lineTo(c[0], c[1]) : pen.moveTo(c[0], c[1])));
          pen.closePath();
          pen.fill();
          pen.stroke();
        }
      },
    });
  }

  // A thin translucent triangle.
  plate(points, colour) {
    const ps = points.map((p) => this.view.project(p));
    this.parts.push({
      depth: ps.reduce((t, p) => t + p[2], 0) / ps.length,
      paint: (pen) => {
        pen.globalAlpha = 0.22;
        pen.fillStyle = grey(colour);
        pen.beginPath();
        ps.forEach((p, k) => (k ? pen.lineTo(p[0], p[1]) : pen.moveTo(p[0], p[1])));
        pen.fill();
        pen.globalAlpha = 1;
      },
    });
  }
}
