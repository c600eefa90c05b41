"use strict";
// A pen that writes SVG: as much of a canvas as the drawing uses, with widths of letters that do not depend on a font.

class SvgPen {
  constructor(width, height) {
    this.width = width;
    this.height = height;
    this.parts = [];
    this.gradients = new Map();
    this.globalAlpha = 1;
    this.dash = [];
    this.d = "";
  }

  n(v) { return String(Number(v.toFixed(1)) || 0); }
  beginPath() { this.d = ""; this.last = null; }
  moveTo(x, y) { this.d += `M${this.n(x)} ${this.n(y)}`; this.last = [x, y]; }
  lineTo(x, y) { this.d += `L${this.n(x)} ${this.n(y)}`; this.last = [x, y]; }
  closePath() { this.d += "Z"; }
  setLineDash(dash) { this.dash = dash; }
  arc(x, y, r, from, to) { this.ellipse(x, y, r, r, 0, from, to); }

  ellipse(x, y, rx, ry, tilt, from, to) {
    const at = (t) => {
      const [a, b] = [rx * Math.cos(t), ry * Math.sin(t)];
      return [x + a * Math.cos(tilt) - b * Math.sin(tilt), y + a * Math.sin(tilt) + b * Math.cos(tilt)];
    };
    const whole = to - from >= 2 * Math.PI, middle = from + (whole ? Math.PI : (to - from) / 2);
    const end = whole ? from + 2 * Math.PI : to;
    const start = at(from);
    if (this.last) this.lineTo(...start);
    else this.moveTo(...start);
    const bow = (p) => `A${this.n(rx)} ${this.n(ry)} ${this.n((tilt * 180) / Math.PI)} 0 1 ${this.n(p[0])} ${this.n(p[1])}`;
    this.d += bow(at(middle)) + bow(at(end));
    this.last = at(end);
  }

  gradient(tag, places) {
    const stops = [];
    const where = Object.entries(places).map(([name, v]) => `${name}="${this.n(v)}"`).join(" ");
    return { tag, where, stops, addColorStop: (t, colour) => stops.push([t, colour]) };
  }

  createLinearGradient(x1, y1, x2, y2) { return this.gradient("linearGradient", { x1, y1, x2, y2 }); }
  createRadialGradient(fx, fy, _, cx, cy, r) { return this.gradient("radialGradient", { cx, cy, r, fx, fy }); }

  // A paint as SVG has it; gradients are kept once.
  paintOf(style) {
    if (typeof style === "string") return style;
    const stops = style.stops.map(([t, colour]) => `<stop offset="${t}" stop-color="${colour}"/>`).join("");
    const key = `${style.tag} gradientUnits="userSpaceOnUse" ${style.where}>${stops}`;
    if (!this.gradients.has(key)) this.gradients.set(key, `g${this.gradients.size + 1}`);
    return `url(#${this.gradients.get(key)})`;
  }

  add(what) { this.parts.push(this.globalAlpha < 1 ? what.replace(/\/>$|>/, (end) => ` opacity="${this.globalAlpha}"${end}`) : what); }
  fill() { this.add(`<path d="${this.d}" fill="${this.paintOf(this.fillStyle)}"/>`); }

  stroke() {
    const dash = this.dash.length ? ` stroke-dasharray="${this.dash.join(" ")}"` : "";
    this.add(`<path d="${this.d}" fill="none" stroke="${this.paintOf(this.strokeStyle)}" stroke-width="${this.n(this.lineWidth)}"${dash}/>`);
  }

  rectangle(x, y, w, h, how) { this.add(`<rect x="${this.n(x)}" y="${this.n(y)}" width="${this.n(w)}" height="${this.n(h)}" ${how}/>`); }
  fillRect(x, y, w, h) { this.rectangle(x, y, w, h, `fill="${this.paintOf(this.fillStyle)}"`); }
  strokeRect(x, y, w, h) { this.rectangle(x, y, w, h, `fill="none" stroke="${this.strokeStyle}" stroke-width="${this.n(this.lineWidth)}"`); }

  get letters() {
    const [, bold, size] = /^(600 )?([0-9.]+)px/.exec(this.font);
    return { bold: Boolean(bold), size: Number(size) };
  }

  measureText(text) {
    const { bold, size } = this.letters;
    const widths = Array.from(text, (c) => (/[ijl.,:;|' ]/.test(c) ? 0.32 : /[mwMW]/.test(c) ? 0.85 : 0.58));
    return { width: size * (bold ? 1.06 : 1) * widths.reduce((a, b) => a + b, 0) };
  }

  text(text, x, y, how) {
    const { bold, size } = this.letters, plain = text.replace(/&/g, "&amp;").replace(/</g, "&lt;");
    this.add(`<text x="${this.n(x)}" y="${this.n(y + 0.82 * size)}" font-size="${size}"${bold ? ' font-weight="600"' : ""} ${how}>${plain}</text>`);
  }

  fillText(text, x, y) { this.text(text, x, y, `fill="${this.fillStyle}"`); }
  strokeText(text, x, y) { this.text(text, x, y, `fill="none" stroke="${this.strokeStyle}" stroke-width="${this.lineWidth}" stroke-linejoin="round"`); }
  setTransform() {}

  document(title) {
    const defs = Array.from(this.gradients, ([key, id]) => `<${key.replace(" ", ` id="${id}" `)}</${key.split(" ")[0]}>`).join("\n");
    const size = `width="${this.width}" height="${this.height}" viewBox="0 0 ${this.width} ${this.height}"`;
    const name = title.replace(/&/g, "&amp;").replace(/</g, "&lt;");
    return `<svg xmlns="http://www.w3.org/2000/svg" ${size} font-family="system-ui, sans-serif" stroke-linecap="round">\n<title>${name}</title>\n<defs>\n${defs}\n</defs>\n${this.parts.join("\n")}\n</svg>\n`;
  }
}
