"use strict";
// The page: state, what is painted, what the pointer does.

const arm = JSON.parse(document.getElementById("data").textContent);
const canvas = document.getElementById("view"), pen = canvas.getContext("2d"), tip = document.getElementById("tip");
const dark = matchMedia("(prefers-color-scheme: dark)");
const units = new Units();
const PARTS = [
  ["links", "links", true], ["names", "names", true], ["frames", "frames", true], ["axes", "joint axes", true],
  ["levers", "levers", true], ["masses", "centres of mass", true], ["inertias", "inertias", true],
  ["dimensions", "dimensions", false], ["tools", "tools", true], ["floor", "grid and gravity", true],
];
if (arm.motion) PARTS.push(["trace", "way of the end", true]);
const show = Object.fromEntries(PARTS.map(([key, , on]) => [key, on]));
if (arm.motion) show.inertias = false;
const directions = linkageDirections(arm);
const up = (() => {
  const g = arm.base ? turn(arm.base, arm.gravity) : arm.gravity;
  return norm(g) > 0 ? times(-1, g) : [0, 0, 1];
})();
const view = new View(up);
const state = { arm, q: arm.q.slice(), units };

arm.joints.forEach((joint, i) => { joint.index = i; });
// Sizes of what has none in the description, from the arm's own. They stay while it moves.
const first = skeleton(arm, arm.q, directions, 0), base = arm.base || IDENTITY;
const reach = (() => {
  const points = extent(arm, first), middle = times(1 / points.length, points.reduce(sum));
  return Math.max(...points.map((p) => norm(difference(p, middle)))) || 0.1;
})();
const thick = 0.026 * reach, frameLength = 0.17 * reach, gridStep = roundStep(reach / 2.5);
for (const joint of arm.joints) {
  const wide = joint.type === "prismatic" ? reach : Math.PI;
  joint.ends = joint.range || [-wide, wide];
}
// Frames at one place are drawn smaller one after the other, so that each is seen.
const shrink = first.frames.map((f, i) => 0.8 ** first.frames.slice(0, i).filter((e) => norm(difference(origin(e.link), origin(f.link))) < 1e-6 * reach).length);

let hits = [], hovered = null, pending = false, current = first;
let touched = false; // the view is the user's: it is not fitted again

function colours() { return COLOURS[dark.matches ? "dark" : "light"]; }

function redraw() {
  if (pending) return;
  pending = true;
  requestAnimationFrame(() => { pending = false; paint(); });
}

const carrierColour = (c, i) => (i < 0 ? c.base : c.links[i % 2]);

function paintSolids(c, s) {
  const solids = new Solids(view, 1.1 * thick);
  if (show.links) {
    solids.box(sum(origin(base), times(-0.5 * thick, view.z)), [times(2.6 * thick, view.x), times(2.6 * thick, view.y), times(0.5 * thick, view.z)], c.base);
    for (const part of s.segments) {
      const radius = part.kind === "tool" ? 0.6 * thick : part.kind === "r" && arm.joints[part.joint].type === "prismatic" ? 0.7 * thick : thick;
      solids.tube(part.from, part.to, radius, carrierColour(c, part.link));
    }
    for (const part of s.tips) solids.tube(part.from, part.to, 0.75 * thick, carrierColour(c, part.link));
    arm.joints.forEach((joint, i) => {
      const f = s.frames[i], z = axis(f.link, 2), k = shrink[i];
      if (joint.type === "prismatic") {
        const half = [times(1.7 * thick, axis(f.foot, 0)), times(1.7 * thick, axis(f.foot, 1)), times(2.4 * thick, z)];
        solids.box(origin(f.foot), half, joint.coordinate < 0 ? c.fixed : c.prismatic);
        solids.drum(origin(f.link), z, 0.5 * thick, 1.5 * thick, carrierColour(c, i));
      } else if (joint.type === "revolute") {
        solids.drum(origin(f.link), z, 2.1 * thick * (1 + 0.9 * (1 - k)), 1.75 * thick * k, joint.coordinate < 0 ? c.fixed : c.revolute);
      }
    });
  }
  if (show.levers) paintLevers(solids, c, s);
  solids.paint(pen);
}

const lift = 2.8 * thick; // linkages beside their links

function paintLevers(solids, c, s) {
  for (const { bar, joint, from, to, length, beside } of s.bars) {
    const z = axis(s.frames[joint].link, 2);
    const foot = times(-beside, z);
    if (bar.carrier !== "between") {
      // between the actuator's plane and the link's, held by a bolt at each end
      solids.tube(sum(from, times(0.4, foot)), sum(to, times(0.4, foot)), 0.45 * thick, c.lever);
      for (const end of [from, to]) solids.tube(sum(end, foot), end, 0.3 * thick, c.fixed, false);
    } else if (bar.telescopes) {
      const shortest = shortestOf(arm.joints[joint], bar), along = times(1 / length, difference(to, from));
      const barrel = sum(from, times(Math.min(0.92 * shortest, length), along));
      solids.tube(from, barrel, 0.8 * thick, c.body);
      solids.tube(barrel, to, 0.42 * thick, c.rod);
    } else solids.tube(from, to, 0.5 * thick, c.rod);
    for (const end of [from, to]) solids.drum(end, z, 0.9 * thick, 0.75 * thick, c.fixed);
  }
  arm.joints.forEach((joint, i) => {
    const pins = s.bars.filter((b) => b.joint === i).flatMap((b) => [b.from, b.to]);
    const corners = pins.filter((p, k) => pins.findIndex((o) => norm(difference(o, p)) < NOTHING) === k);
    if (corners.length === 3) solids.plate(corners, c.lever);
  });
}

// The shortest that a bar is within the joint's range [m].
function shortestOf(joint, bar) {
  if (bar.shortest === undefined) {
    const [low, high] = joint.ends;
    bar.shortest = Infinity;
    for (let k = 0; k <= 40; k++) {
      const [x0, y0, x1, y1] = run(bar.pins, joint.coordinate < 0 ? joint.locked || 0 : low + (k / 40) * (high - low));
      bar.shortest = Math.min(bar.shortest, Math.hypot(x1 - x0, y1 - y0));
    }
  }
  return bar.shortest;
}

function paint() {
  const c = colours(), ratio = window.devicePixelRatio || 1;
  const values = motors(arm, state.q);
  current = skeleton(arm, state.q, directions, lift);
  const s = current, labels = new Labels(view, getComputedStyle(document.body).fontFamily);
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.fillStyle = c.paper;
  pen.fillRect(0, 0, view.width, view.height);
  pen.lineCap = "round";
  hits = [];
  if (show.floor) drawGrid(pen, view, origin(base), 1.3 * reach, gridStep, c.grid);
  paintSolids(c, s);
  if (show.inertias) {
    for (const m of s.masses) {
      const half = [0, 1, 2].map((k) => times(m.body.half[k], principalAxis(m, k)));
      if (m.body.real) drawEllipsoid(pen, view, m.at, half, c.mass, hovered === `mass ${m.joint}`);
    }
  }
  if (show.axes) {
    arm.joints.forEach((joint, i) => {
      if (joint.type === "fixed") return;
      const z = axis(s.frames[i].link, 2), at = origin(s.frames[i].link), long = 1.7 * frameLength;
      stroke(pen, [sum(at, times(-long, z)), sum(at, times(long, z))].map((p) => view.project(p)), c.chain, 1.1, [14, 4, 2, 4]);
    });
  }
  if (show.axes) for (const part of s.travels) paintTravel(c, part);
  paintTrace(c);
  paintFrames(c, s, labels);
  if (show.masses) {
    for (const m of s.masses) {
      const p = view.project(m.at), o = view.project(origin(s.frames[m.joint].link));
      stroke(pen, [o, p], c.mass, 0.9, [2, 3]);
      drawCentre(pen, p, 6, c.mass, c.paper);
      labels.avoid(p, 7);
    }
  }
  if (show.floor) paintGravity(c, labels);
  paintNames(c, s, labels);
  collectHits(s, values);
  const marked = hits.find((h) => h.key === hovered);
  for (const part of s.segments) {
    if (part.kind === "tool") continue;
    const strong = hovered === `segment ${part.kind} ${part.joint}`;
    if (show.dimensions || strong) {
      const joint = arm.joints[part.joint], slides = joint.type === "prismatic" && part.kind === "r";
      const text = `${part.kind}${slides ? " + q" : ""} = ${units.showLength(part.kind === "r" && slides ? joint.r + coordinate(joint, state.q) : joint[part.kind])}`;
      drawDimension(pen, labels, view.project(part.from), view.project(part.to), text, c.dimension, strong ? 5 : 0);
    }
  }
  if (show.dimensions) for (const b of s.bars) labels.add(middleOf(b), `${b.bar.name} ${units.showLength(b.length)}`, c.dimension, { size: 11 });
  if (marked && marked.line) {
    pen.globalAlpha = 0.35;
    stroke(pen, marked.line, c.dimension, 9);
    pen.globalAlpha = 1;
  }
  labels.paint(pen, c.paper);
  document.getElementById("scale").textContent = show.floor ? `squares of ${units.showLength(gridStep)}` : "";
  refreshPanel(values, s);
}

// Where a prismatic joint's frame may be: a line with a bar at either end.
function paintTravel(c, part) {
  const [a, b] = [view.project(part.from), view.project(part.to)], length = Math.hypot(b[0] - a[0], b[1] - a[1]);
  if (length < 4) return;
  const nx = (-(b[1] - a[1]) / length) * 8, ny = ((b[0] - a[0]) / length) * 8;
  stroke(pen, [a, b], c.chain, 2);
  for (const p of [a, b]) stroke(pen, [[p[0] - nx, p[1] - ny], [p[0] + nx, p[1] + ny]], c.chain, 2.4);
}

const principalAxis = (m, k) => turn(m.pose, m.body.axes.map((row) => row[k]));

const middleOf = (part) => {
  const [a, b] = [view.project(part.from), view.project(part.to)];
  return [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
};

function paintFrames(c, s, labels) {
  if (show.frames) {
    drawFrame(pen, view, labels, base, 1.15 * frameLength, true, c);
    if (arm.base) drawFrame(pen, view, labels, IDENTITY, frameLength, true, c);
    s.frames.forEach((f, i) => {
      const apart = norm(difference(origin(f.link), origin(base))) > 0.2 * frameLength;
      drawFrame(pen, view, labels, f.link, frameLength * shrink[i], apart && shrink[i] === 1, c);
    });
  }
  if (show.tools) {
    s.tools.forEach((pose) => {
      drawFrame(pen, view, labels, pose, 0.8 * frameLength, false, c);
      const p = view.project(origin(pose));
      pen.strokeStyle = c.tool;
      pen.lineWidth = 1.6;
      pen.strokeRect(p[0] - 4.5, p[1] - 4.5, 9, 9);
    });
  }
}

function paintNames(c, s, labels) {
  if (!show.names) return;
  const small = view.width < 560;
  const name = (pose, text, colour, important) => labels.add(view.project(origin(pose)), text, colour, { important, bold: true, size: small ? 12 : 13 });
  name(base, "base", c.quiet, 2);
  if (arm.base) name(IDENTITY, "world", c.quiet, 1);
  s.frames.forEach((f, i) => name(f.link, arm.joints[i].name, c.ink, 3));
  if (show.tools) s.tools.forEach((pose, k) => name(pose, arm.tools[k].name, c.tool, 2));
}

// In a corner: it is the same everywhere.
function paintGravity(c, labels) {
  const size = norm(arm.gravity), [x, y] = [view.width - 46, 44];
  if (!size) return;
  const along = times(-26 / view.scale, view.z), v = view.direction(along);
  if (Math.hypot(v[0], v[1]) > 6) arrow(pen, [x - v[0], y - v[1]], [x + v[0], y + v[1]], c.gravity, 2.6, 11);
  else {
    // towards the eye a dot, away from it a cross
    pen.strokeStyle = pen.fillStyle = c.gravity;
    pen.lineWidth = 2;
    pen.beginPath();
    pen.arc(x, y, 10, 0, 7);
    pen.stroke();
    if (v[2] > 0) { pen.beginPath(); pen.arc(x, y, 3, 0, 7); pen.fill(); }
    else for (const k of [-1, 1]) stroke(pen, [[x - 7, y - 7 * k], [x + 7, y + 7 * k]], c.gravity, 2);
  }
  labels.avoid([x, y], 28);
  labels.add([x, y + 28], `g ${digits(size, 4)} m/s²`, c.gravity, { important: 4 });
}

// What is under the pointer, and what is said of it.
function collectHits(s, values) {
  const line = (key, part, rank, text) => {
    const ends = [view.project(part.from), view.project(part.to)];
    hits.push({ key, rank, line: ends, distance: (x, y) => toSegment(x, y, ends[0], ends[1]) - 4, text });
  };
  const point = (key, p, r, rank, text) => {
    const at = view.project(p);
    hits.push({ key, rank, distance: (x, y) => Math.hypot(x - at[0], y - at[1]) - r, text });
  };
  const xyz = (p) => p.map((v) => digits(v * (units.millimetres ? 1000 : 1), 5)).join(", ");
  const ground = arm.base ? "world" : "base";
  const linkName = (i) => (i < 0 ? "the base" : `link ${arm.joints[i].name}`);
  if (show.links) {
    for (const part of s.segments) {
      if (part.kind === "tool") continue;
      const joint = arm.joints[part.joint], slides = part.kind === "r" && joint.type === "prismatic";
      const where = { b: `along z of ${joint.antecedent < 0 ? "the base" : arm.joints[joint.antecedent].name}`, d: "along x, between the axes", r: `along z of ${joint.name}` };
      line(`segment ${part.kind} ${part.joint}`, part, 1, () => [
        `${joint.name}: ${part.kind} = ${units.showLength(joint[part.kind])}${joint.expressions[part.kind] ? ` (${joint.expressions[part.kind]})` : ""}`,
        `${where[part.kind]}; of ${linkName(part.link)}`, ...(slides ? [`r + q = ${units.showLength(joint.r + coordinate(joint, state.q))}`] : [])]);
    }
    arm.joints.forEach((joint, i) => point(`joint ${i}`, origin(joint.type === "prismatic" ? s.frames[i].foot : s.frames[i].link), Math.max(6, 1.6 * thick * view.scale * shrink[i]), 2, () => jointText(joint, i, values)));
  }
  s.frames.forEach((f, i) => point(`frame ${i}`, origin(f.link), 5, 2.5, () => [...jointText(arm.joints[i], i, values), `origin in the ${ground}: ${xyz(origin(f.link))} ${units.length}`]));
  if (show.levers) {
    for (const b of s.bars) {
      const joint = arm.joints[b.joint];
      line(`bar ${b.bar.name} ${b.joint}`, b, 3, () => [`${joint.name}: ${b.bar.name} ${units.showLength(b.length)}`,
        ...(b.bar.telescopes && joint.coordinate >= 0 ? [`motor ${motorText(joint, values[joint.coordinate])}`] : []),
        ...(b.bar.telescopes ? [joint.drive.title] : [b.bar.carrier === "own" ? `of link ${joint.name}` : b.bar.carrier === "before" ? `of ${linkName(joint.antecedent)}` : joint.drive.title])]);
    }
  }
  if (show.masses || show.inertias) {
    for (const m of s.masses) {
      point(`mass ${m.joint}`, m.at, 7, 4, () => [`link ${arm.joints[m.joint].name}: ${digits(m.link.mass)} kg`,
        `centre of mass ${xyz(m.link.com)} ${units.length}`, `inertia about it ${m.link.inertia.map((v) => digits(v, 4)).join(", ")} kg m²`,
        m.body.real ? `even ellipsoid of half axes ${m.body.half.map((v) => units.showLength(Number(v.toPrecision(3)))).join(", ")}` : "no body has this inertia: a principal moment is more than the other two"]);
    }
  }
  if (show.tools) s.tools.forEach((pose, k) => point(`tool ${k}`, origin(pose), 6, 5, () => [`tool ${arm.tools[k].name} on link ${arm.joints[arm.tools[k].link].name}`, `origin in the ${ground}: ${xyz(origin(pose))} ${units.length}`]));
}

function jointText(joint, i, values) {
  if (joint.type === "fixed") return [`${joint.name}: fixed`];
  if (joint.coordinate < 0) return [`${joint.name}: ${joint.type}, held at ${units.show(joint, joint.locked)}`];
  const n = joint.coordinate, lines = [`${joint.name}: ${joint.type}, q${n + 1} = ${units.show(joint, state.q[n])}`];
  lines.push(joint.range ? `range ${units.show(joint, joint.range[0])} to ${units.show(joint, joint.range[1])}` : "no limits given");
  const slides = joint.type === "prismatic", { velocity, acceleration, effort } = joint.limits;
  const most = [velocity && `${units.show(joint, velocity)}/s`, acceleration && `${units.show(joint, acceleration)}/s²`, effort && `${digits(effort)} ${slides ? "N" : "N m"}`].filter(Boolean);
  if (most.length) lines.push(`at most ${most.join(", ")}`);
  lines.push(joint.drive.driven ? `${joint.drive.title}, motor ${motorText(joint, values[n])}` : "undriven");
  return lines;
}

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
        for (const side of [-1, 1]) points.push(sum(m.at, times(side * far, axis)));
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

const bodies = new Map(first.masses.map((m) => [m.joint, m.body]));
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
    box.append(element("div", { class: "scroll" }));
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

function begin() {
  buildPanel();
  if (motion) buildPlayer();
  for (const button of document.querySelectorAll("#views button")) button.addEventListener("click", () => look(button.dataset.view));
  dark.addEventListener("change", redraw);
  new ResizeObserver(resize).observe(canvas.parentElement);
  resize();
  look("oblique");
}
