"use strict";
// Text in the picture: each label beside its point, none over another.

class Labels {
  constructor(view, font) {
    this.view = view;
    this.font = font;
    this.wanted = [];
    this.taken = [];
  }

  // at: [x, y] in pixels. important: placed first. near: left out where it has no room at its point.
  add(at, text, colour, { important = 0, size = 12, bold = false, near = false } = {}) {
    this.wanted.push({ at, text, colour, important, size, bold, near });
  }

  // Keeps labels off a point.
  avoid(p, r) {
    this.taken.push([p[0] - r, p[1] - r, p[0] + r, p[1] + r]);
  }

  paint(pen, halo) {
    this.wanted.sort((a, b) => b.important - a.important);
    for (const label of this.wanted) {
      pen.font = `${label.bold ? "600 " : ""}${label.size}px ${this.font}`;
      const w = pen.measureText(label.text).width, h = label.size;
      const [x, y] = label.at;
      if (x < -20 || y < -20 || x > this.view.width + 20 || y > this.view.height + 20) continue;
      const box = this.place(x, y, w, h, label.near ? [3, 7] : [9, 16, 26, 40, 58, 80]);
      if (!box) continue;
      this.taken.push(box);
      const cx = Math.max(box[0], Math.min(box[2], x)), cy = Math.max(box[1], Math.min(box[3], y));
      if (Math.hypot(cx - x, cy - y) > 16) {
        pen.strokeStyle = label.colour;
        pen.globalAlpha = 0.6;
        pen.lineWidth = 1;
        pen.beginPath();
        pen.moveTo(x, y);
        pen.lineTo(cx, cy);
        pen.stroke();
        pen.globalAlpha = 1;
      }
      pen.textBaseline = "top";
      pen.lineJoin = "round";
      pen.lineWidth = 3.5;
      pen.strokeStyle = halo;
      pen.strokeText(label.text, box[0], box[1]);
      pen.fillStyle = label.colour;
      pen.fillText(label.text, box[0], box[1]);
    }
  }

  // The nearest free box about the point, null where there is none.
  place(x, y, w, h, distances) {
    for (const distance of distances) {
      for (let k = 0; k < 12; k++) {
        const angle = (-2 + (k % 2 ? (k + 1) / 2 : -k / 2)) * (Math.PI / 6);
        const cx = x + Math.cos(angle) * (distance + w / 2), cy = y + Math.sin(angle) * (distance + h / 2);
        const box = [cx - w / 2, cy - h / 2, cx + w / 2, cy + h / 2];
        if (box[0] < 2 || box[1] < 2 || box[2] > this.view.width - 2 || box[3] > this.view.height - 2) continue;
        if (this.taken.every((t) => box[2] + 5 < t[0] || t[2] + 5 < box[0] || box[3] + 1 < t[1] || t[3] + 1 < box[1])) return box;
      }
    }
    return null;
  }
}
