"use strict";
// A motion that plays: positions at equal times, and the way of the last point.

const motion = arm.motion;
const player = { running: false, at: 0, before: null };

function buildPlayer() {
  const host = document.getElementById("player"), last = motion.t.length - 1;
  const span = motion.t[last] - motion.t[0];
  const button = element("button", { "aria-label": "play or pause" });
  const place = element("input", { type: "range", min: 0, max: last, step: 1, "aria-label": "time" });
  const time = element("span", { class: "time" });
  const speed = element("select", { "aria-label": "speed" }, ...[0.1, 0.25, 0.5, 1, 2, 5].map((s) => element("option", { value: s }, `× ${s}`)));
  speed.value = "1";
  host.append(button, place, time, speed);
  host.hidden = false;
  document.getElementById("scale").classList.add("raised");
  const at = (k) => {
    player.frame = k;
    state.q = motion.q[k].slice();
    place.value = k;
    time.textContent = `${motion.t[k].toFixed(2)} s`;
    redraw();
  };
  const run_ = (on) => {
    player.running = on;
    player.before = null;
    button.textContent = on ? "❚❚" : "▶";
    if (on) requestAnimationFrame(tick);
  };
  function tick(stamp) {
    if (!player.running) return;
    if (player.before !== null) {
      player.at += ((stamp - player.before) / 1000) * Number(speed.value);
      if (player.at > span) player.at = 0;
      at(Math.min(last, Math.round((player.at / (span || 1)) * last)));
    }
    player.before = stamp;
    requestAnimationFrame(tick);
  }
  button.addEventListener("click", () => run_(!player.running));
  place.addEventListener("input", () => {
    run_(false);
    player.at = (Number(place.value) / last) * span;
    at(Number(place.value));
  });
  player.stop = () => run_(false);
  at(0);
  run_(!matchMedia("(prefers-reduced-motion: reduce)").matches);
}

// The point whose way is shown: the first tool, else the last link's end.
function tracedPoint(q) {
  const { frames, tools } = forward(arm, q);
  if (tools.length) return origin(tools[0]);
  const i = lastLinks(arm)[0], link = arm.joints[i].link;
  return link ? place(frames[i].link, times(2, link.com)) : origin(frames[i].link);
}

const trace = motion ? motion.q.map(tracedPoint) : [];

function paintTrace(c) {
  if (!motion || !show.trace) return;
  pen.lineJoin = "round";
  stroke(pen, trace.map((p) => view.project(p)), c.quiet, 1, [2, 3]);
  stroke(pen, trace.slice(0, (player.frame || 0) + 1).map((p) => view.project(p)), c.quiet, 1.6);
}

// Coordinates at which the arm has to be in the picture.
const seen = () => (motion ? Array.from({ length: 13 }, (_, k) => motion.q[Math.round((k / 12) * (motion.q.length - 1))]) : [state.q]);
