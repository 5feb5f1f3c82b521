// The same structure in regular waves of other heights and periods, as a table with arrow-key navigation.

import { fetchLong } from "./api.js";
import { $, isWaiting, setWaiting } from "./dom.js";
import { fixed, number, ratio } from "./formatting.js";

export class StructureWaves {
  /** `onPick` receives a wave that is to be run. */
  constructor(state, { onPick }) {
    this.state = state;
    this.onPick = onPick;
    this.abort = null;
    $("waves-run").addEventListener("click", () => this.compute());
    const table = $("waves");
    table.addEventListener("click", (event) => this.#pick(event.target.closest("td")));
    table.addEventListener("keydown", (event) => this.#step(event));
  }

  /** Takes changed values, which need another table; the old one stays until then. */
  follow() {
    $("waves-box").hidden = this.state.waterNow !== "wave";
    const stale = this.asked !== undefined && this.asked !== this.#key;
    setWaiting($("waves-run"), this.abort !== null);
    $("waves-stale").hidden = !stale;
    $("waves").classList.toggle("stale", stale);
    $("waves-run").textContent = this.asked === undefined ? "Compute" : "Compute again";
    for (const cell of document.querySelectorAll("#waves td")) {
      const { height, period } = /** @type {HTMLElement} */ (cell).dataset;
      const here = Number(height) === this.#value("height") && Number(period) === this.#value("period");
      if (here) cell.setAttribute("aria-current", "true");
      else cell.removeAttribute("aria-current");
    }
  }

  #value(key) {
    return Number(this.state.value(`wave.${key}`));
  }

  /** The case of the table without its wave, which varies in it. */
  get #key() {
    const { set, ...rest } = this.state.asked;
    return JSON.stringify([rest, set.filter((change) => !/^wave\.(height|period)=/.test(change))]);
  }

  async compute() {
    if (isWaiting($("waves-run"))) return;
    const asked = this.#key;
    this.abort = new AbortController();
    $("waves-message").textContent = "computing a hundred waves…";
    this.follow();
    try {
      const answer = await fetchLong("api/structure/waves", { case: this.state.asked }, this.abort.signal);
      this.asked = asked;
      this.#show(answer);
    } catch (error) {
      $("waves-message").textContent = error.message;
    }
    this.abort = null;
    this.follow();
  }

  #show({ periods_s, heights_m, cells, utilisation, length }) {
    const what = utilisation ? "Largest utilisation" : "Fastest snap [m/s]";
    const marks = { fails: "×", "not judged": "–", "at least": "≥ ", known: "" };
    const meaning = { "not judged": "–: nothing is judged", "at least": "≥: the run stopped at the largest number of snaps" };
    const occurring = Object.keys(meaning).filter((kind) => cells.some((cell) => cell.kind === kind));
    const colours = utilisation ? ["amber: half of the breaking load or more", "red: a line breaks, or ×"] : ["red: ×"];
    const legend = ["×: the body turns over or touches the floor", ...occurring.map((kind) => meaning[kind]), ...colours];
    $("waves-message").textContent =
      `${what} in waves run for ${length} periods each and judged after ten, or after a run.transient that is given (at most half of the run); ${legend.join("; ")}. ` +
      "Motions are chaotic, so that single cells may differ from those beside them. Click a cell to run its wave for the duration of the case.";
    const cell = (i, j) => {
      const { value, kind } = cells[i * heights_m.length + j];
      const wave = `data-height="${heights_m[j]}" data-period="${periods_s[i]}"`;
      const colour = kind === "fails" ? "fails" : !utilisation ? "" : value >= 1 ? "breaks" : value >= 0.5 ? "near" : "";
      const text = value === null ? "" : utilisation ? ratio(value) : fixed(value, 2);
      return `<td tabindex="-1" class="${colour}" ${wave}>${marks[kind]}${text}</td>`;
    };
    const rows = heights_m.map((height, j) => {
      const row = periods_s.map((_, i) => cell(i, j)).join("");
      return `<tr><th scope="row">${number(height, 3)}</th>${row}</tr>`;
    });
    const head = periods_s.map((period) => `<th scope="col">${number(period, 3)}</th>`).join("");
    $("waves").innerHTML = `<thead><tr><th scope="col">H [m] \\<br>T [s]</th>${head}</tr></thead><tbody>${rows.reverse().join("")}</tbody>`;
    $("waves").querySelector("td").tabIndex = 0;
    const box = $("waves").parentElement;
    if (box.scrollWidth > box.clientWidth) $("waves-message").textContent += " The table can be scrolled sideways.";
  }

  #pick(cell) {
    if (!cell) return;
    const { height, period } = cell.dataset;
    this.onPick({ "wave.height": Number(height), "wave.period": Number(period) });
  }

  /** One cell is in the tab order; the arrow keys move from cell to cell, Enter runs one. */
  #step(event) {
    const cell = event.target.closest("td");
    if (!cell) return;
    if (event.key === "Enter") return this.#pick(cell);
    const [across, down] = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowDown: [0, 1], ArrowUp: [0, -1] }[event.key] ?? [];
    if (across === undefined) return;
    event.preventDefault();
    const row = cell.parentElement;
    const next = $("waves").rows[row.rowIndex + down]?.cells[cell.cellIndex + across];
    if (!next || next.tagName !== "TD") return;
    cell.tabIndex = -1;
    next.tabIndex = 0;
    next.focus();
  }
}
