"use strict";
// A command breaks between its words alone, for options have hyphens, and a long path between its folders.
for (const code of document.querySelectorAll("pre code")) {
  code.replaceChildren(...code.textContent.split(/( +)/).map(word => {
    if (!word.trim()) return word;
    const span = document.createElement("span");
    span.className = "word";
    word.split(/(?<=\/)/).forEach((piece, k) => span.append(...(k ? [document.createElement("wbr")] : []), piece));
    return span;
  }));
}
// Copies a command.
for (const pre of document.querySelectorAll("pre")) {
  const button = document.createElement("button");
  button.type = "button";
  button.textContent = "Copy";
  button.addEventListener("click", async () => {
    const text = pre.querySelector("code").textContent;
    try {
      await navigator.clipboard.writeText(text);
    } catch {  // a page from a file may not
      const range = document.createRange();
      range.selectNodeContents(pre.querySelector("code"));
      getSelection().removeAllRanges();
      getSelection().addRange(range);
      document.execCommand("copy");
    }
    button.textContent = "Copied";
  });
  pre.append(button);
}

// What is folded away on the screen is on paper.
addEventListener("beforeprint", () => {
  for (const one of document.querySelectorAll("details:not(.screen)")) one.open = true;
});
// What has its place on a wide screen is folded away on a narrow one.
const narrow = matchMedia("screen and (max-width: 899px)");
function fit() {
  for (const one of document.querySelectorAll("details.narrow")) one.open = !narrow.matches;
}
narrow.addEventListener("change", fit);
fit();
// The figures of a mark are shown while it has the focus: a tap gives it, a second one takes it away.
const marked = ".marks button, .checks button";
let tapped = null;
document.addEventListener("pointerdown", e => {
  const button = e.target.closest(marked);
  tapped = button === document.activeElement ? button : null;
});
document.addEventListener("click", e => {
  const button = e.target.closest(marked);
  if (!button || !e.detail) return;  // a key keeps what the focus shows
  if (button === tapped) button.blur();
  else button.focus();  // which not every telephone does by itself
});
document.addEventListener("keydown", e => {
  if (e.key === "Escape" && document.activeElement.matches(marked)) document.activeElement.blur();
});

// Enlarges the abscissae of the charts that belong together.
function steps(low, high, about) {
  const rough = (high - low) / about, power = 10 ** Math.floor(Math.log10(rough));
  const count = s => Math.floor(high / s + 1e-9) - Math.ceil(low / s - 1e-9) + 1;
  const step = [10, 5, 2, 1, 0.5].map(m => m * power).find(s => count(s) >= 3 && s <= 2 * rough) ?? 0.5 * power;
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9)), found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) found.push([k * step, (k * step).toFixed(digits)]);
  return found;
}
for (const group of document.querySelectorAll(".zooming")) {
  const charts = [...group.querySelectorAll("svg[data-zoom]")].map(svg => {
    const [x0, x1, left, wide] = svg.dataset.zoom.split(" ").map(Number);
    return {svg, x0, x1, left, wide, axis: svg.querySelector(".abscissa"), curves: svg.querySelector(".curves")};
  });
  if (!charts.length) continue;
  const panel = group.querySelector(".zoom"), said = panel.querySelector("output");
  let from = 0, to = 1;
  function show() {
    for (const c of charts) {
      const scale = 1 / (to - from), low = c.x0 + from * (c.x1 - c.x0), high = c.x0 + to * (c.x1 - c.x0);
      c.curves.setAttribute("transform", `translate(${-from * scale * c.wide} 0) scale(${scale} 1)`);
      const grid = c.axis.querySelector(".grid"), tick = c.axis.querySelector(".tick");
      const lines = [], words = [];
      for (const [value, word] of steps(low, high, 6)) {
        const at = c.left + (value - low) / (high - low) * c.wide;
        const line = grid.cloneNode(), text = tick.cloneNode(true);
        line.setAttribute("d", line.getAttribute("d").replace(/^M[^ ]+/, `M${at.toFixed(1)}`));
        text.setAttribute("x", at.toFixed(1));
        text.textContent = word;
        lines.push(line);
        words.push(text);
      }
      if (lines.length) c.axis.replaceChildren(...lines, ...words);
    }
    const c = charts[0], at = share => (c.x0 + share * (c.x1 - c.x0)).toFixed(2);
    said.textContent = `${at(from)} to ${at(to)} s`;
  }
  function set(a, b) {
    const wide = Math.min(1, Math.max(b - a, 0.002));
    from = Math.min(Math.max(a, 0), 1 - wide);
    to = from + wide;
    show();
  }
  const actions = {
    in: () => set(from + (to - from) / 4, to - (to - from) / 4),
    out: () => set(from - (to - from) / 2, to + (to - from) / 2),
    back: () => set(from - (to - from) / 2, to - (to - from) / 2),
    on: () => set(from + (to - from) / 2, to + (to - from) / 2),
    all: () => set(0, 1),
  };
  for (const button of panel.querySelectorAll("button")) button.addEventListener("click", actions[button.value]);
  for (const c of charts) {
    let start = null;
    const share = e => {
      const box = c.svg.getBoundingClientRect(), x = (e.clientX - box.left) / box.width * c.svg.viewBox.baseVal.width;
      return from + Math.min(Math.max((x - c.left) / c.wide, 0), 1) * (to - from);
    };
    c.svg.addEventListener("pointerdown", e => { start = share(e); });
    c.svg.addEventListener("pointerup", e => {
      const end = share(e);
      if (start !== null && Math.abs(end - start) > 0.02 * (to - from)) set(Math.min(start, end), Math.max(start, end));
      start = null;
    });
    c.svg.addEventListener("pointercancel", () => { start = null; });
    c.svg.addEventListener("dblclick", actions.all);
  }
  panel.hidden = false;
  show();
}
