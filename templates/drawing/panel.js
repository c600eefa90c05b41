"use strict";
// Units, and the side panel.

class Units {
  constructor() {
    this.degrees = true;
    this.millimetres = false;
  }

  get angle() { return this.degrees ? "deg" : "rad"; }
  get length() { return this.millimetres ? "mm" : "m"; }
  // The unit of a joint's coordinate, and the value in it.
  of(joint) { return joint.type === "prismatic" ? this.length : this.angle; }
  factor(joint) { return joint.type === "prismatic" ? (this.millimetres ? 1000 : 1) : this.degrees ? 180 / Math.PI : 1; }
  showLength(v) { return `${digits(v * (this.millimetres ? 1000 : 1))} ${this.length}`; }
  showAngle(v) { return this.degrees ? `${digits((v * 180) / Math.PI)}°` : `${digits(v)} rad`; }
  show(joint, v) { return joint.type === "prismatic" ? this.showLength(v) : this.showAngle(v); }
}

// Six digits at most, with a real minus.
function digits(v, count = 5) {
  if (!Number.isFinite(v)) return "–";
  const text = Math.abs(v) >= 1e5 && Number.isInteger(v) ? String(v) : String(Number(v.toPrecision(count)));
  return text.replace("-", "−");
}

function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else if (value !== false) made.setAttribute(key, value === true ? "" : value);
  }
  made.append(...children);
  return made;
}

function motorText(joint, value) {
  const { unit, range } = joint.drive;
  const ends = range ? ` (${digits(range[0])} to ${digits(range[1])})` : "";
  return `${digits(value, 6)} ${unit || "units"}${ends}`;
}

// Sliders, one a coordinate. state: {arm, q, units}; changed: called after a slider moved.
function coordinatePanel(host, state, changed) {
  const rows = [];
  state.arm.joints.forEach((joint) => {
    if (joint.coordinate < 0) return;
    const n = joint.coordinate, [low, high] = joint.ends;
    const slider = element("input", { type: "range", min: low, max: high, step: "any", "aria-label": joint.name });
    const number = element("input", { type: "number", step: "any", "aria-label": `${joint.name} in numbers` });
    const unit = element("span", { class: "unit" }), ends = element("span", { class: "ends quiet" });
    const motor = element("div", { class: "motor quiet" });
    const set = (value) => {
      state.q[n] = Math.max(low, Math.min(high, value));
      changed();
    };
    slider.addEventListener("input", () => set(Number(slider.value)));
    number.addEventListener("change", () => {
      if (number.value.trim() !== "" && Number.isFinite(Number(number.value))) set(Number(number.value) / state.units.factor(joint));
      else changed();
    });
    const row = element("div", { class: "row", "data-joint": joint.index },
      element("div", { class: "line" }, element("b", {}, joint.name), ends, element("span", { class: "value" }, number, unit)), slider, motor);
    host.append(row);
    rows.push({ joint, n, slider, number, unit, ends, motor });
  });
  return function refresh(values) {
    for (const { joint, n, slider, number, unit, ends, motor } of rows) {
      const factor = state.units.factor(joint), q = state.q[n];
      slider.value = q;
      if (document.activeElement !== number || Number(number.value) !== q * factor) number.value = Number((q * factor).toPrecision(6));
      unit.textContent = state.units.of(joint);
      ends.textContent = `${digits(joint.ends[0] * factor, 4)} to ${digits(joint.ends[1] * factor, 4)}${joint.range ? "" : ", no limits"}`;
      if (!joint.drive.driven) { motor.textContent = "undriven"; continue; }
      const bar = joint.drive.bars.find((b) => b.telescopes);
      const [x0, y0, x1, y1] = bar ? run(bar.pins, q) : [0, 0, 0, 0];
      motor.textContent = `motor ${motorText(joint, values[n])}` + (bar ? ` · ${bar.name} ${state.units.showLength(Math.hypot(x1 - x0, y1 - y0))}` : "");
    }
  };
}

function matrixTable(pose, units) {
  const table = element("table", { class: "matrix" });
  const head = ["x", "y", "z", `origin [${units.length}]`].map((t) => element("th", {}, t));
  table.append(element("tr", {}, ...head));
  for (let i = 0; i < 12; i += 4) {
    const cells = pose.slice(i, i + 4).map((v, k) => {
      const shown = k === 3 ? v * (units.millimetres ? 1000 : 1) : v;
      const text = Math.abs(shown) < 5e-10 ? "0" : k === 3 ? digits(shown, 6) : digits(Number(shown.toFixed(5)), 5);
      return element("td", {}, text);
    });
    table.append(element("tr", {}, ...cells));
  }
  return table;
}

function figure(joint, name, units) {
  const angle = ["alpha", "theta", "gamma"].includes(name), v = joint[name];
  return v === 0 ? "0" : angle ? units.showAngle(v) : digits(v * (units.millimetres ? 1000 : 1));
}

// The parameters as the description has them.
function parameterTable(arm, units) {
  const branched = arm.joints.some((j) => j.gamma !== 0 || j.b !== 0);
  const names = [...(branched ? ["gamma", "b"] : []), "alpha", "d", "theta", "r"];
  const chain = arm.joints.every((j, i) => j.antecedent === i - 1);
  const table = element("table", {});
  table.append(element("tr", {}, ...["joint", ...(chain ? [] : ["after"]), ...names.map((n) => (["b", "d", "r"].includes(n) ? `${n} [${units.length}]` : n))]
    .map((t) => element("th", {}, t))));
  for (const joint of arm.joints) {
    const slides = joint.type === "prismatic", q = joint.coordinate >= 0 ? `q${joint.coordinate + 1}` : joint.locked === null ? "" : `${units.show(joint, joint.locked)} (held)`;
    const cell = (name) => {
      const moves = q && joint.type !== "fixed" && name === (slides ? "r" : "theta");
      const own = figure(joint, name, units);
      const text = !moves ? own : own === "0" ? q : `${own} + ${q}`;
      return element("td", {}, joint.expressions[name] ? `${text} = ${joint.expressions[name]}` : text);
    };
    const after = joint.antecedent < 0 ? "base" : arm.joints[joint.antecedent].name;
    table.append(element("tr", {}, element("td", {}, joint.name), ...(chain ? [] : [element("td", {}, after)]), ...names.map(cell)));
  }
  return table;
}

// Of the even ellipsoid, the longest last; one that is larger than the arm is marked.
function halfAxes(body, factor) {
  if (!body || !body.real) return element("td", {}, "–");
  const text = [...body.half].sort((a, b) => a - b).map((v) => digits(v * factor, 3)).join(", ");
  return element("td", {}, text, body.large ? element("span", { class: "wrong" }, " larger than the arm") : "");
}

function linkTable(arm, bodies, units) {
  const table = element("table", {});
  table.append(element("tr", {}, ...["link", "mass [kg]", `centre [${units.length}]`, "principal moments [kg m²]", `half axes [${units.length}]`].map((t) => element("th", {}, t))));
  for (const joint of arm.joints) {
    const cells = [element("td", {}, joint.name)];
    if (joint.link) {
      const body = bodies.get(joint.index), factor = units.millimetres ? 1000 : 1;
      const moments = body ? [...body.moments].sort((a, b) => a - b).map((m) => digits(m, 4)).join(", ") : "–";
      cells.push(element("td", {}, digits(joint.link.mass)), element("td", {}, joint.link.com.map((v) => digits(v * factor, 4)).join(", ")),
        element("td", {}, moments, body && !body.real ? element("span", { class: "wrong" }, " no body has these") : ""),
        halfAxes(body, factor));
    } else cells.push(element("td", { colspan: 4, class: "quiet" }, "not given"));
    table.append(element("tr", {}, ...cells));
  }
  return table;
}
