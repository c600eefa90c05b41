"use strict";
// The camera: parallel projection, up against gravity.

class View {
  constructor(up) {
    this.z = unit(up);
    // The picture's horizontal axes follow the world's where gravity does.
    const seed = Math.abs(this.z[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
    this.x = unit(difference(seed, times(dot(seed, this.z), this.z)));
    this.y = cross(this.z, this.x);
    this.centre = [0, 0, 0];
    this.scale = 100; // pixels per m
    this.width = this.height = 100;
    this.look(-1.0, 0.35);
  }

  look(azimuth, elevation) {
    this.azimuth = azimuth;
    this.elevation = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, elevation));
    const [sa, ca] = sineCosine(azimuth), [se, ce] = sineCosine(this.elevation);
    const world = (a, b, c) => sum(sum(times(a, this.x), times(b, this.y)), times(c, this.z));
    this.right = world(-sa, ca, 0);
    this.up = world(-se * ca, -se * sa, ce);
    this.near = world(ce * ca, ce * sa, se); // towards the eye
  }

  // [right, down, nearness] in pixels.
  project(p) {
    const v = difference(p, this.centre);
    return [
      this.width / 2 + this.scale * dot(v, this.right),
      this.height / 2 - this.scale * dot(v, this.up),
      this.scale * dot(v, this.near),
    ];
  }

  // A direction of length in m, in pixels.
  direction(v) {
    return [this.scale * dot(v, this.right), -this.scale * dot(v, this.up), this.scale * dot(v, this.near)];
  }

  // Seen so that the points fill the picture. margin: pixels at each side; top: more of them there.
  fit(points, margin, top) {
    const along = (axis) => points.map((p) => dot(p, axis));
    const range = (values) => [Math.min(...values), Math.max(...values)];
    const [l, r] = range(along(this.right)), [b, t] = range(along(this.up)), [n, f] = range(along(this.near));
    const mix = (a, c, axis) => times((a + c) / 2, axis);
    this.centre = sum(sum(mix(l, r, this.right), mix(b, t, this.up)), mix(n, f, this.near));
    const size = Math.max(r - l, t - b, 1e-6);
    const room = (pixels) => Math.max(pixels - 2 * margin, 40);
    this.scale = Math.min(room(this.width) / Math.max(r - l, size / 20), room(this.height - top) / Math.max(t - b, size / 20));
    this.pan(0, top / 2);
  }

  // The azimuth from which the points spread most, a quarter of a right angle off their plane.
  oblique(points) {
    const mean = times(1 / points.length, points.reduce(sum));
    let best = [-1, 0];
    for (let k = 0; k < 16; k++) {
      const angle = -Math.PI / 2 + (k * Math.PI) / 8;
      const right = sum(times(-Math.sin(angle), this.x), times(Math.cos(angle), this.y));
      const spread = points.reduce((t, p) => t + dot(difference(p, mean), right) ** 2, 0);
      if (spread > best[0] * 1.02 + 1e-12) best = [spread, angle];
    }
    return best[1] + 0.42;
  }

  pan(dx, dy) {
    this.centre = sum(this.centre, sum(times(-dx / this.scale, this.right), times(dy / this.scale, this.up)));
  }

  zoom(factor, x, y) {
    const dx = x - this.width / 2, dy = y - this.height / 2;
    this.pan(-dx, -dy);
    this.scale *= factor;
    this.pan(dx, dy);
  }
}
