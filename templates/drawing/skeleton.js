"use strict";
// Where everything of the arm is in the world [m] at given coordinates.

const sum = (a, b) => a.map((x, k) => x + b[k]);
const difference = (a, b) => a.map((x, k) => x - b[k]);
const times = (s, a) => a.map((x) => s * x);
const dot = (a, b) => a.reduce((t, x, k) => t + x * b[k], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = (a) => Math.sqrt(dot(a, a));
const unit = (a) => times(1 / (norm(a) || 1), a);
const NOTHING = 1e-9; // [m] lengths below are none

// Links without a joint behind them.
const lastLinks = (arm) => arm.joints.map((_, i) => i).filter((i) => !arm.joints.some((j) => j.antecedent === i));

// lift: how far linkages are drawn beside their links [m], on this side or the other from joint to joint.
function skeleton(arm, q, directions, lift) {
  const { frames, tools } = forward(arm, q);
  const segments = [], bars = [], masses = [], tips = [], travels = [];
  const add = (kind, link, joint, from, to) => {
    const length = norm(difference(to, from));
    if (length > NOTHING) segments.push({ kind, link, joint, from, to, length });
  };
  arm.joints.forEach((joint, i) => {
    const f = frames[i], before = joint.antecedent;
    add("b", before, i, origin(f.start), origin(f.branch));
    add("d", before, i, origin(f.branch), origin(f.foot));
    add("r", joint.type === "prismatic" ? i : before, i, origin(f.foot), origin(f.link));
    if (joint.type === "prismatic" && joint.range) {
      const [from, to] = joint.range.map((end) => place(f.foot, [0, 0, joint.r + end]));
      travels.push({ joint: i, from, to });
    }
    const value = coordinate(joint, q);
    if (joint.drive.bars.length) {
      const plane = multiply(f.foot, aboutZ(directions[i], joint.r)), beside = i % 2 ? -lift : lift;
      for (const bar of joint.drive.bars) {
        const [x0, y0, x1, y1] = run(bar.pins, value);
        const from = place(plane, [x0, y0, beside]), to = place(plane, [x1, y1, beside]);
        bars.push({ bar, joint: i, from, to, length: norm(difference(to, from)), beside });
      }
    }
    if (joint.link && joint.link.mass > 0) {
      masses.push({ joint: i, link: joint.link, at: place(f.link, joint.link.com), pose: f.link, body: ellipsoid(joint.link) });
    }
  });
  tools.forEach((pose, k) => add("tool", arm.tools[k].link, k, origin(frames[arm.tools[k].link].link), origin(pose)));
  for (const i of lastLinks(arm)) {
    if (arm.tools.some((tool) => tool.link === i)) continue;
    const link = arm.joints[i].link;
    if (!link || norm(link.com) < NOTHING) continue;
    tips.push({ link: i, from: origin(frames[i].link), to: place(frames[i].link, times(2, link.com)) });
  }
  return { frames, tools, segments, bars, masses, tips, travels };
}

// Directions [rad] of the drives' linkages about their joints' axes, against x of the frame before the joint.
// The description gives the triangle alone, unless an effect says more: the longest bar is laid along its link.
function linkageDirections(arm) {
  return arm.joints.map((joint, i) => {
    if (!joint.drive.bars.length) return 0;
    if (joint.drive.direction !== null) return joint.drive.direction;
    const q = arm.joints.filter((j) => j.coordinate >= 0).map((j) => (j.range ? (j.range[0] + j.range[1]) / 2 : 0));
    const { frames, tools } = forward(arm, q);
    const f = frames[i], here = origin(f.link);
    const angle = (v) => {
      const x = dot(axis(f.foot, 0), v), y = dot(axis(f.foot, 1), v);
      return Math.hypot(x, y) > 1e-3 * norm(v) && norm(v) > NOTHING ? Math.atan2(y, x) : null;
    };
    const towards = (points) => points.map((p) => angle(difference(p, here))).find((a) => a !== null);
    const ahead = towards([
      ...arm.joints.flatMap((j, k) => (j.antecedent === i ? [origin(frames[k].foot), origin(frames[k].link)] : [])),
      ...arm.tools.flatMap((tool, k) => (tool.link === i ? [origin(tools[k])] : [])),
      ...(joint.link ? [place(f.link, joint.link.com)] : []),
    ]);
    const before = joint.antecedent < 0 ? null : frames[joint.antecedent];
    const behind = towards([origin(f.start), ...(before ? [origin(before.foot)] : [])]); // the latter on its axis
    const fixed = joint.drive.bars.filter((bar) => bar.carrier !== "between").map((bar) => {
      const [x0, y0, x1, y1] = run(bar.pins, coordinate(joint, q));
      const x = (x0 + x1) / 2, y = (y0 + y1) / 2;
      return { own: bar.carrier === "own", length: Math.hypot(x1 - x0, y1 - y0), angle: Math.atan2(y, x) };
    });
    fixed.sort((a, b) => b.length - a.length);
    for (const bar of fixed) {
      const target = bar.own ? ahead : behind;
      if (target !== undefined) return target - bar.angle;
    }
    const base = fixed.find((bar) => !bar.own);
    return ahead !== undefined && base ? ahead + Math.PI - base.angle : 0;
  });
}

// Points that a picture must hold.
function extent(arm, s) {
  const points = [arm.base ? origin(arm.base) : [0, 0, 0]];
  for (const part of [...s.segments, ...s.bars, ...s.tips, ...s.travels]) points.push(part.from, part.to);
  for (const f of s.frames) points.push(origin(f.link));
  for (const m of s.masses) points.push(m.at);
  return points;
}
