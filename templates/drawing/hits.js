"use strict";
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
        m.body.real ? `even ellipsoid of half axes ${m.body.half.map((v) => units.showLength(Number(v.toPrecision(3)))).join(", ")}${tooLarge(m.body) ? ": larger than the arm" : ""}` : "no body has this inertia: a principal moment is more than the other two"]);
    }
  }
  if (show.tools) s.tools.forEach((pose, k) => point(`tool ${k}`, origin(pose), 6, 5, () => [`tool ${arm.tools[k].name} on link ${arm.joints[arm.tools[k].link].name}`, `origin in the ${ground}: ${xyz(origin(pose))} ${units.length}`]));
}

function jointText(joint, i, values) {
  if (joint.type === "fixed") return [`${joint.name}: fixed`];
  if (joint.coordinate < 0) return [`${joint.name}: ${joint.type}, held at ${units.show(joint, joint.locked)}`];
  const n = joint.coordinate, lines = [`${joint.name}: ${joint.type}, q${n + 1} = ${units.show(joint, state.q[n])}`];
  if (joint.mark) lines.push(joint.mark);
  lines.push(joint.range ? `range ${units.show(joint, joint.range[0])} to ${units.show(joint, joint.range[1])}` : "no limits given");
  const slides = joint.type === "prismatic", { velocity, acceleration, effort } = joint.limits;
  const most = [velocity && `${units.show(joint, velocity)}/s`, acceleration && `${units.show(joint, acceleration)}/s²`, effort && `${digits(effort)} ${slides ? "N" : "N m"}`].filter(Boolean);
  if (most.length) lines.push(`at most ${most.join(", ")}`);
  lines.push(joint.drive.driven ? `${joint.drive.title}, motor ${motorText(joint, values[n])}` : "undriven");
  return lines;
}
