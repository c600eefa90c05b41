"use strict";
// What the pointer, the keys and the panel do.

function hover(x, y, slack) {
  let best = null;
  for (const hit of hits) {
    const d = hit.distance(x, y);
    if (d <= slack && (!best || hit.rank - 0.2 * Math.max(0, d) > best.rank - 0.2 * Math.max(0, best.at))) best = Object.assign(hit, { at: d });
  }
  const key = best ? best.key : null;
  if (key !== hovered) { hovered = key; redraw(); }
  tip.hidden = !best;
  for (const row of document.querySelectorAll(".row")) row.classList.toggle("marked", Boolean(key) && /^(joint|frame) /.test(key) && key.split(" ")[1] === row.dataset.joint);
  if (!best) return;
  tip.replaceChildren(...best.text().map((line, k) => element(k ? "div" : "b", {}, line)));
  const w = tip.offsetWidth, h = tip.offsetHeight;
  tip.style.left = `${Math.max(4, Math.min(view.width - w - 4, x + 16))}px`;
  tip.style.top = `${y + 18 + h < view.height ? y + 18 : Math.max(4, y - h - 12)}px`;
}

function resize() {
  const box = canvas.parentElement.getBoundingClientRect(), ratio = window.devicePixelRatio || 1;
  const factor = Math.min(box.width, box.height) / Math.min(view.width, view.height);
  view.width = box.width;
  view.height = box.height;
  canvas.width = Math.round(box.width * ratio);
  canvas.height = Math.round(box.height * ratio);
  if (touched) view.scale *= factor;
  else fit();
  paint(); // at once: a canvas of another size is empty
}

function fit() {
  view.fit(picture(), Math.min(90, 0.1 * Math.min(view.width, view.height)), 34);
  touched = false;
  redraw();
}

// What has to be seen: the arm with its frames' arrows, all along a motion.
function picture() {
  return seen().flatMap(pictureAt);
}

function pictureAt(q) {
  const s = skeleton(arm, q, directions, lift), points = extent(arm, s);
  if (show.inertias) {
    for (const m of s.masses) {
      // how far the ellipsoid reaches along the picture's axes
      for (const axis of [view.right, view.up]) {
        const far = Math.sqrt([0, 1, 2].reduce((t, k) => t + (m.body.half[k] * dot(axis, principalAxis(m, k))) ** 2, 0));
        // one that is larger than the arm may be cut off: the arm is to be seen
        for (const side of [-1, 1]) points.push(sum(m.at, times(side * Math.min(far, 0.4 * reach), axis)));
      }
    }
  }
  for (const f of [...s.frames.map((x) => x.link), ...s.tools, base]) {
    for (const k of [0, 1, 2]) points.push(sum(origin(f), times(frameLength, axis(f, k))));
  }
  return points;
}

function look(name) {
  const views = { oblique: () => [view.oblique(picture()), 0.35], front: () => [-Math.PI / 2, 0], side: () => [0, 0], top: () => [-Math.PI / 2, Math.PI / 2] };
  if (views[name]) view.look(...views[name]());
  fit();
}

// Turn with one pointer, pan with the right button, shift or two fingers, zoom with wheel or fingers.
const pointers = new Map();
let moved = 0;
canvas.addEventListener("pointerdown", (e) => {
  canvas.setPointerCapture(e.pointerId);
  pointers.set(e.pointerId, [e.offsetX, e.offsetY]);
  moved = 0;
});
canvas.addEventListener("pointermove", (e) => {
  const before = pointers.get(e.pointerId), now = [e.offsetX, e.offsetY];
  if (!before) { if (e.pointerType === "mouse") hover(now[0], now[1], 5); return; }
  const dx = now[0] - before[0], dy = now[1] - before[1];
  moved += Math.abs(dx) + Math.abs(dy);
  touched = true;
  if (pointers.size === 2) {
    const other = [...pointers].find(([id]) => id !== e.pointerId)[1];
    const spread = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
    view.pan(dx / 2, dy / 2);
    view.zoom(spread(now) / spread(before), (now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
  } else if (e.shiftKey || e.buttons & 6) view.pan(dx, dy);
  else view.look(view.azimuth - dx / 140, view.elevation + dy / 140);
  pointers.set(e.pointerId, now);
  tip.hidden = true;
  redraw();
});
const lifted = (e) => {
  pointers.delete(e.pointerId);
  if (moved < 6 && e.type === "pointerup") hover(e.offsetX, e.offsetY, e.pointerType === "mouse" ? 5 : 14);
};
canvas.addEventListener("pointerup", lifted);
canvas.addEventListener("pointercancel", lifted);
canvas.addEventListener("pointerleave", () => { if (!pointers.size) hover(-1e6, 0, 0); });
canvas.addEventListener("contextmenu", (e) => e.preventDefault());
canvas.addEventListener("dblclick", fit);
canvas.addEventListener("wheel", (e) => {
  e.preventDefault();
  touched = true;
  view.zoom(Math.exp(-e.deltaY * (e.deltaMode ? 0.05 : 0.0015)), e.offsetX, e.offsetY);
  redraw();
}, { passive: false });
canvas.addEventListener("keydown", (e) => {
  const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[e.key];
  if (step && e.shiftKey) view.pan(20 * step[0], 20 * step[1]);
  else if (step) view.look(view.azimuth - 0.1 * step[0], view.elevation + 0.1 * step[1]);
  else if (e.key === "+" || e.key === "=") view.zoom(1.15, view.width / 2, view.height / 2);
  else if (e.key === "-") view.zoom(1 / 1.15, view.width / 2, view.height / 2);
  else if (e.key === "0") fit();
  else return;
  touched = e.key !== "0";
  e.preventDefault();
  redraw();
});

// -- the panel ---------------------------------------------------------------------------

const bodies = new Map(first.masses.map((m) => [m.joint, Object.assign(m.body, { large: tooLarge(m.body) })]));
const tables = {
  table: () => parameterTable(arm, units),
  masses: () => linkTable(arm, bodies, units),
  pose: () => matrixTable(chosenPose(), units),
};
const frameChoice = element("select", { "aria-label": "frame" });
[...arm.joints.map((j, i) => [`frame ${i}`, `link ${j.name}`]), ...arm.tools.map((t, k) => [`tool ${k}`, `tool ${t.name}`])]
  .forEach(([value, text]) => frameChoice.append(element("option", { value }, text)));
frameChoice.value = arm.tools.length ? "tool 0" : `frame ${arm.order[arm.order.length - 1]}`;
frameChoice.addEventListener("change", redraw);

function chosenPose() {
  const [kind, k] = frameChoice.value.split(" ");
  return kind === "tool" ? current.tools[k] : current.frames[k].link;
}

// The user has moved a joint: a motion stops.
function takenOver() {
  if (player.stop) player.stop();
  redraw();
}

const refreshCoordinates = coordinatePanel(document.getElementById("coordinates"), state, takenOver);

function refreshPanel(values) {
  refreshCoordinates(values);
  for (const [id, make] of Object.entries(tables)) {
    const box = document.getElementById(id);
    if (box.open) box.querySelector(".scroll").replaceChildren(make());
  }
}

function buildPanel() {
  const buttons = element("div", { class: "buttons" },
    element("button", { onclick: () => { state.q = arm.q.slice(); takenOver(); } }, "back to start"),
    element("button", { onclick: () => { state.q = state.q.map((v, n) => { const j = arm.joints.find((x) => x.coordinate === n); return Math.max(j.ends[0], Math.min(j.ends[1], 0)); }); takenOver(); } }, "all to zero"));
  const unitButton = (label, flip) => element("button", { onclick: (e) => { flip(); e.target.textContent = label(); redraw(); } }, label());
  buttons.append(unitButton(() => `angles in ${units.angle}`, () => { units.degrees = !units.degrees; }), unitButton(() => `lengths in ${units.length}`, () => { units.millimetres = !units.millimetres; }));
  document.getElementById("coordinates").prepend(buttons);
  const present = { levers: first.bars.length, masses: first.masses.length, inertias: first.masses.length, tools: arm.tools.length };
  const parts = PARTS.filter(([key]) => present[key] === undefined || present[key]);
  document.getElementById("shown").append(...parts.map(([key, text]) => {
    const box = element("input", { type: "checkbox", checked: show[key], onchange: (e) => { show[key] = e.target.checked; redraw(); } });
    return element("label", {}, box, ` ${text}`);
  }));
  for (const id of Object.keys(tables)) {
    const box = document.getElementById(id);
    if (id === "pose") box.append(frameChoice, element("p", { class: "quiet" }, `Axes and origin in the ${arm.base ? "world" : "base frame"}.`));
    // wide tables scroll on a phone: with the keys as well, once they have the focus
    box.append(element("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": box.querySelector("summary").textContent }));
    box.addEventListener("toggle", redraw);
  }
  if (!arm.joints.some((j) => j.link)) document.getElementById("masses").remove(), delete tables.masses;
  const said = [
    "Lines follow the parameters: b along z of the link before, d along x, r along the joint's own z. Orange drums turn, teal boxes slide, grey ones are held or fixed. Arrows: x red, y green, z blue.",
    ...(first.masses.length ? ["The ellipsoids are even bodies with the mass and the inertia of their links."] : []),
    ...(first.bars.length ? ["The description gives the triangle of a lever, not how it is turned about the axis: its longest side is laid along the link, beside it."] : []),
    "Drag to turn; right button, shift or two fingers to pan; wheel or two fingers to zoom; double click to fit. Point at a part for its figures.",
    ...arm.notes.map((note) => `Note: ${note}`),
  ];
  document.getElementById("notes").append(...said.map((text) => element("p", {}, text)));
}

// The picture as a file.
function save() {
  const url = URL.createObjectURL(new Blob([svgPicture()], { type: "image/svg+xml" }));
  element("a", { href: url, download: `${arm.name}.svg` }).click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

function begin() {
  buildPanel();
  if (motion) buildPlayer();
  for (const button of document.querySelectorAll("#views button")) button.addEventListener("click", () => (button.dataset.view === "save" ? save() : look(button.dataset.view)));
  dark.addEventListener("change", redraw);
  new ResizeObserver(resize).observe(canvas.parentElement);
  resize();
  look("oblique");
}
