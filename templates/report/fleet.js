const body = document.querySelector("#units tbody"), heads = [...document.querySelectorAll("#units th")];
const value = (row, k) => row.cells[k].dataset.sort ?? row.cells[k].textContent.trim();
function sort(k) {
  const up = heads[k].getAttribute("aria-sort") !== "ascending";
  heads.forEach(h => h.setAttribute("aria-sort", "none"));
  heads[k].setAttribute("aria-sort", up ? "ascending" : "descending");
  const number = "number" in heads[k].dataset;
  const order = (a, b) => {
    const x = value(a, k), y = value(b, k);
    if (x === "" || y === "") return (x === "") - (y === "");  // what is missing comes last
    const d = number ? x - y : x.localeCompare(y, "en", {numeric: true});
    return up ? d : -d;
  };
  body.append(...[...body.rows].sort(order));
}
heads.forEach((h, k) => h.querySelector("button").addEventListener("click", () => sort(k)));
const filter = document.getElementById("filter"), shown = document.getElementById("shown");
filter.addEventListener("input", () => {
  const words = filter.value.toLowerCase().split(/\s+/);
  let n = 0;
  for (const row of body.rows) {
    const hit = words.every(w => row.textContent.toLowerCase().includes(w));
    row.hidden = !hit;
    n += hit;
  }
  shown.textContent = filter.value ? `${n} of ${body.rows.length}` : "";
});
