"use strict";
// The arm's kinematics. A pose is a 3 x 4 matrix in rows: rotation beside translation [m].

const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0];

// A straight-line program: each step a number, "q", or an operation on steps before; ~k is minus step k.
const OPERATIONS = {
  add: (a, b) => a + b, mul: (a, b) => a * b, div: (a, b) => a / b,
  sin: Math.sin, cos: Math.cos, tan: Math.tan, asin: Math.asin, acos: Math.acos, atan: Math.atan,
  atan2: Math.atan2, sqrt: Math.sqrt, exp: Math.exp, log: Math.log, tanh: Math.tanh, abs: Math.abs,
  sign: Math.sign, pow: Math.pow, min: Math.min, max: Math.max, select: (c, a, b) => (c > 0 ? a : b),
};

function run(program, q) {
  const values = [];
  const at = (k) => (k < 0 ? -values[~k] : values[k]);
  for (const step of program.steps) {
    if (step === "q") values.push(q);
    else if (typeof step === "number") values.push(step);
    else values.push(OPERATIONS[step[0]](...step.slice(1).map(at)));
  }
  return program.results.map(at);
}

function multiply(a, b) {
  const c = new Array(12);
  for (let i = 0; i < 12; i += 4) {
    for (let j = 0; j < 4; j++) {
      c[i + j] = a[i] * b[j] + a[i + 1] * b[4 + j] + a[i + 2] * b[8 + j] + (j === 3 ? a[i + 3] : 0);
    }
  }
  return c;
}

function place(pose, p) {
  return [0, 4, 8].map((i) => pose[i] * p[0] + pose[i + 1] * p[1] + pose[i + 2] * p[2] + pose[i + 3]);
}

function turn(pose, v) {
  return [0, 4, 8].map((i) => pose[i] * v[0] + pose[i + 1] * v[1] + pose[i + 2] * v[2]);
}

const origin = (pose) => [pose[3], pose[7], pose[11]];
const axis = (pose, k) => [pose[k], pose[4 + k], pose[8 + k]];

// Sines and cosines of right angles are exact, as in the generated code.
function sineCosine(angle) {
  return [Math.sin(angle), Math.cos(angle)].map((x) => (Math.abs(x - Math.round(x)) < 1e-12 ? Math.round(x) : x));
}

function aboutZ(angle, along) {
  const [s, c] = sineCosine(angle);
  return [c, -s, 0, 0, s, c, 0, 0, 0, 0, 1, along];
}

function aboutX(angle, along) {
  const [s, c] = sineCosine(angle);
  return [1, 0, 0, along, 0, c, -s, 0, 0, s, c, 0];
}

// The coordinate of a joint: of the arm's where it moves, else the one that it is held at.
const coordinate = (joint, q) => (joint.coordinate >= 0 ? q[joint.coordinate] : joint.locked || 0);

// Frames on the way from the antecedent to a link: where b ends, d ends, before the joint, and the link.
// T = Rot(z, gamma) Trans(z, b) Rot(x, alpha) Trans(x, d) Rot(z, theta) Trans(z, r), Khalil and Kleinfinger 1986.
function steps(joint, value, start) {
  const slides = joint.type === "prismatic";
  const branch = multiply(start, aboutZ(joint.gamma, joint.b));
  const foot = multiply(branch, aboutX(joint.alpha, joint.d));
  const link = multiply(foot, aboutZ(joint.theta + (slides ? 0 : value), joint.r + (slides ? value : 0)));
  return { start, branch, foot, link };
}

// Frames of all joints and tools in the world, for the coordinates q [rad, m].
function forward(arm, q) {
  const found = new Array(arm.joints.length);
  for (const i of arm.order) {
    const joint = arm.joints[i];
    const start = joint.antecedent < 0 ? arm.base || IDENTITY : found[joint.antecedent].link;
    found[i] = steps(joint, coordinate(joint, q), start);
  }
  const tools = arm.tools.map((tool) => multiply(found[tool.link].link, tool.transform));
  return { frames: found, tools };
}

// Motor coordinates of the arm's coordinates, each in its drive's unit.
function motors(arm, q) {
  const found = new Array(q.length).fill(null);
  for (const joint of arm.joints) {
    if (joint.coordinate >= 0) found[joint.coordinate] = run(joint.drive.motor, q[joint.coordinate])[0];
  }
  return found;
}

// Principal moments and axes (columns) of a symmetric matrix [xx, xy, xz, yy, yz, zz]: Jacobi's rotations.
function principal(six) {
  const a = [[six[0], six[1], six[2]], [six[1], six[3], six[4]], [six[2], six[4], six[5]]];
  const v = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  for (let sweep = 0; sweep < 30; sweep++) {
    for (const [p, r] of [[0, 1], [0, 2], [1, 2]]) {
      if (a[p][r] === 0) continue;
      const t = (a[r][r] - a[p][p]) / (2 * a[p][r]);
      const tangent = (t >= 0 ? 1 : -1) / (Math.abs(t) + Math.sqrt(t * t + 1));
      const c = 1 / Math.sqrt(tangent * tangent + 1), s = tangent * c;
      for (let k = 0; k < 3; k++) [a[k][p], a[k][r]] = [c * a[k][p] - s * a[k][r], s * a[k][p] + c * a[k][r]];
      for (let k = 0; k < 3; k++) [a[p][k], a[r][k]] = [c * a[p][k] - s * a[r][k], s * a[p][k] + c * a[r][k]];
      for (let k = 0; k < 3; k++) [v[k][p], v[k][r]] = [c * v[k][p] - s * v[k][r], s * v[k][p] + c * v[k][r]];
    }
  }
  return { moments: [a[0][0], a[1][1], a[2][2]], axes: v };
}

// The solid ellipsoid of even density with the link's mass and inertia: semi-axes [m] and axes in its frame.
// `real` is false where no body has this inertia: a moment is more than the other two together.
function ellipsoid(link) {
  const { moments, axes } = principal(link.inertia);
  const sum = moments[0] + moments[1] + moments[2];
  const squares = moments.map((m) => (link.mass > 0 ? (5 * (sum / 2 - m)) / link.mass : 0));
  const real = squares.every((s) => s >= -1e-9 * Math.abs(sum / (link.mass || 1)));
  return { half: squares.map((s) => Math.sqrt(Math.max(0, s))), axes, moments, real };
}
