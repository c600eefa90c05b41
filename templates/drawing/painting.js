"use strict";
// The state of the page, and the drawing of it.

const arm = JSON.parse(document.getElementById("data").textContent);
const canvas = document.getElementById("view"), tip = document.getElementById("tip");
let pen = canvas.getContext("2d");
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
// Many joints are drawn finer, so that they do not hide each other.
const crowd = Math.min(1, (9 / arm.joints.length) ** 0.45);
const thick = 0.026 * reach * crowd, frameLength = 0.17 * reach * crowd, gridStep = roundStep(reach / 2.5);
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

const jointColour = (c, joint) => (joint.mark ? c.marked : joint.coordinate < 0 ? c.fixed : joint.type === "prismatic" ? c.prismatic : c.revolute);

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
        solids.box(origin(f.foot), half, jointColour(c, joint));
        solids.drum(origin(f.link), z, 0.5 * thick, 1.5 * thick, carrierColour(c, i));
      } else if (joint.type === "revolute") {
        solids.drum(origin(f.link), z, 2.1 * thick * (1 + 0.9 * (1 - k)), 1.75 * thick * k, jointColour(c, joint));
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
  const ratio = window.devicePixelRatio || 1;
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  draw(colours());
  document.getElementById("scale").textContent = show.floor ? `squares of ${units.showLength(gridStep)}` : "";
  refreshPanel(motors(arm, state.q));
}

// The picture as SVG, as it is seen or of another size [pixels].
function svgPicture(width = view.width, height = view.height) {
  const kept = [pen, view.width, view.height, hovered];
  [pen, view.width, view.height, hovered] = [new SvgPen(width, height), width, height, null];
  draw(colours());
  const found = pen.document(arm.name);
  [pen, view.width, view.height, hovered] = kept;
  redraw();
  return found;
}

function draw(c) {
  const values = motors(arm, state.q);
  current = skeleton(arm, state.q, directions, lift);
  const s = current, labels = new Labels(view, getComputedStyle(document.body).fontFamily);
  pen.fillStyle = c.paper;
  pen.fillRect(0, 0, view.width, view.height);
  pen.lineCap = "round";
  hits = [];
  if (show.floor) drawGrid(pen, view, origin(base), 1.3 * reach, gridStep, c.grid);
  paintSolids(c, s);
  if (show.inertias) {
    for (const m of s.masses) {
      const half = [0, 1, 2].map((k) => times(m.body.half[k], principalAxis(m, k)));
      if (m.body.real) drawEllipsoid(pen, view, m.at, half, c.mass, hovered === `mass ${m.joint}`, tooLarge(m.body));
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
}

// Where a prismatic joint's frame may be: a line with a bar at either end.
function paintTravel(c, part) {
  const [a, b] = [view.project(part.from), view.project(part.to)], length = Math.hypot(b[0] - a[0], b[1] - a[1]);
  if (length < 4) return;
  const nx = (-(b[1] - a[1]) / length) * 8, ny = ((b[0] - a[0]) / length) * 8;
  stroke(pen, [a, b], c.chain, 2);
  for (const p of [a, b]) stroke(pen, [[p[0] - nx, p[1] - ny], [p[0] + nx, p[1] + ny]], c.chain, 2.4);
}

// An inertia of a body that would be larger than the arm: a slip in its units, mostly.
const tooLarge = (body) => body.real && Math.max(...body.half) > reach;

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
      drawFrame(pen, view, labels, f.link, frameLength * shrink[i], apart && shrink[i] === 1 && crowd > 0.8, c);
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
  const small = view.width < 560, size = (small ? 12 : 13) - (crowd < 0.8 ? 1.5 : 0);
  const name = (pose, text, colour, important) => labels.add(view.project(origin(pose)), text, colour, { important, bold: crowd > 0.8, size });
  name(base, "base", c.quiet, 2);
  if (arm.base) name(IDENTITY, "world", c.quiet, 1);
  s.frames.forEach((f, i) => {
    const { mark, name: text } = arm.joints[i];
    name(f.link, mark ? `${text}: ${mark}` : text, mark ? grey(c.marked) : c.ink, mark ? 6 : 3);
  });
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
