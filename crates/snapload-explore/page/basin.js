// Safe basins: the cells of a window of two keys that reach no limit, their share, and how it decreases along a third
// key.

import { fetchWithProgress } from "./api.js";
import { AxisFields, withAxis } from "./axis-fields.js";
import { axisWords, cellOf, crosshair, drawCellAxes, frameOf, outline, paintCells } from "./cells.js";
import { $, setProperties } from "./dom.js";
import { drawErosion } from "./erosion.js";
import { lines } from "./long-run.js";
import { rangeText, studyLine } from "./map-files.js";
import { FramedPicture, prepare } from "./plot.js";
import { same } from "./state.js";
import { copy } from "./export.js";
import { number, reasonText } from "./formatting.js";

/**
 * Starts at rest of the thesis's bodies, and the force that erodes their basin. At zero force many starts are
 * symmetric, and their outcome is not certain.
 */
const USUAL = {
  x: { key: "x", low: -0.4, high: 0.4, count: 41 },
  y: { key: "y", low: 0.02, high: 0.72, count: 36 },
  over: { key: "f_o", low: 0.03, high: 0.6, count: 20 },
};
/** The axes with their legends, and what is counted along each. */
const SIDES = { x: ["Horizontal", "cells"], y: ["Vertical", "cells"], over: ["Third key", "values"] };
const PATH = "api/basin";

export class SafeBasin {
  constructor(state, { colours, own, onPick }) {
    this.state = state;
    this.colours = colours;
    this.own = own;
    this.picture = new FramedPicture(() => this.#paintAll());
    this.onPick = onPick;
    this.answer = null;
    this.eroded = null;
    this.erosionDrawn = false;
    this.asking = null;
    this.cursor = [0, 0];
    this.pointed = null;
    this.box = $("basin-box");
    this.canvas = $("basin");
    this.numeric = state.schema.keys.filter((key) => key.kind.type === "number");
    this.axes = Object.entries(SIDES).map(
      ([side, [legend, counted]]) =>
        new AxisFields(`basin-${side}`, this.numeric, {
          legend,
          counted,
          value: own,
          currentAxis: () => state.basin[side],
          onChange: (axis) => state.set({ basin: withAxis(state.basin, side, axis) }),
          onInvalid: (words) => ($("basin-pointed").textContent = words),
        }),
    );
    this.box.addEventListener("toggle", () => {
      if (this.box.open === (state.basin !== null)) return;
      state.set({ basin: this.box.open ? USUAL : null });
    });
    $("basin-run").addEventListener("click", () => this.#compute(false));
    $("erosion-run").addEventListener("click", () => this.#compute(true));
    $("basin-stop").addEventListener("click", () => this.asking?.abort());
    $("basin-copy").addEventListener("click", () => copy($("basin-copy"), this.#line(false)));
    $("erosion-copy").addEventListener("click", () => copy($("erosion-copy"), this.#line(true)));
    this.#listen();
  }

  /** The request: the values of the axes' keys are left out. */
  #question(erodes) {
    const { x, y, over } = this.state.basin;
    const values = { ...this.state.values };
    for (const { key } of [x, y, ...(erodes ? [over] : [])]) delete values[key];
    return { values, x, y, ...(erodes ? { over } : {}) };
  }

  /** The command of the answer that is shown, even if the values have changed; without an answer, of the request. */
  #line(erodes) {
    const { values, x, y, over } = (erodes ? this.eroded : this.answer)?.question ?? this.#question(erodes);
    const more = erodes ? `--over ${rangeText(over)} --no-trust` : "--out basin.parquet";
    return studyLine(erodes ? "erosion" : "basin", values, [x, y], more);
  }

  /** Follows the state: opens and closes; results for other values are pale until they are computed again. */
  follow() {
    const { basin } = this.state;
    this.box.open = basin !== null;
    if (!basin) return this.asking?.abort();
    for (const axis of this.axes) axis.show();
    const other = (answer, erodes) => answer !== null && answer.asked !== JSON.stringify(this.#question(erodes));
    for (const [shown, words, answer, erodes] of [
      [["basin", "basin-legend", "basin-pointed", "basin-message"], "basin-run", this.answer, false],
      [["erosion", "erosion-message"], "erosion-run", this.eroded, true],
    ]) {
      for (const id of shown) $(id).classList.toggle("stale", other(answer, erodes));
      setProperties($(words), { textContent: `${erodes ? "Erosion" : "Compute"}${answer ? " again" : ""}` });
    }
    this.#repaint();
  }

  async #compute(erodes) {
    this.asking?.abort();
    const asking = (this.asking = new AbortController());
    const question = this.#question(erodes);
    this.#running(true);
    $("basin-bar").value = 0;
    $("basin-progress").textContent = "";
    try {
      const text = await fetchWithProgress(PATH, question, asking.signal, ({ doing, percent }) => {
        if (this.asking !== asking) return;
        $("basin-bar").value = percent / 100;
        $("basin-progress").textContent = `${doing}, ${percent} %`;
      });
      const answer = { ...JSON.parse(text), asked: JSON.stringify(question), question };
      if (erodes) Object.assign(this, { eroded: answer, erosionDrawn: false });
      else this.#setAnswer(answer);
      // The picture of an erosion shows the table of its text, which ends at an empty line.
      $(erodes ? "erosion-message" : "basin-message").textContent = lines(answer.words.split("\n\n").at(-1));
      if (this.asking === asking) $("basin-progress").textContent = "";
    } catch (error) {
      if (this.asking === asking) $("basin-progress").textContent = error.name === "AbortError" ? "stopped" : error.message;
    }
    if (this.asking !== asking) return;
    this.asking = null;
    this.#running(false);
    if (this.state.basin) this.follow();
  }

  /** Forgets the hovered cell of the previous basin, as a new one may have fewer cells. */
  #setAnswer(answer) {
    this.answer = answer;
    this.pointed = null;
    this.cursor = [0, 0];
    $("basin-pointed").textContent = "";
  }

  #running(running) {
    for (const id of ["basin-stop", "basin-bar"]) $(id).hidden = !running;
  }

  #listen() {
    const at = (event) => (this.answer && this.frame ? cellOf(event, this.frame, this.answer.question) : null);
    this.canvas.addEventListener("pointermove", (event) => this.#point(at(event)));
    this.canvas.addEventListener("pointerleave", () => this.#point(null));
    this.canvas.addEventListener("click", (event) => this.#pick(at(event)));
    this.canvas.addEventListener("focus", () => this.#point(this.cursor));
    this.canvas.addEventListener("blur", () => this.#point(null));
    this.canvas.addEventListener("keydown", (event) => this.#key(event));
  }

  #key(event) {
    if (!this.answer) return;
    const [i, j] = this.cursor;
    const { x, y } = this.answer.question;
    const [across, up] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key] ?? [];
    if (event.key === "Enter") this.#pick(this.cursor);
    else if (across === undefined) return;
    else this.#point([Math.min(Math.max(i + across, 0), x.count - 1), Math.min(Math.max(j + up, 0), y.count - 1)]);
    event.preventDefault();
    event.stopPropagation();
  }

  #point(cell) {
    if (!this.answer || same(cell, this.pointed)) return;
    this.pointed = cell;
    if (cell) this.cursor = cell;
    $("basin-pointed").textContent = cell ? this.#words(cell) : "";
    this.#repaint();
  }

  #pick(cell) {
    if (!cell || !this.answer) return;
    this.#point(cell);
    const { x, y, question } = this.answer;
    this.onPick({ [question.x.key]: x[cell[0]], [question.y.key]: y[cell[1]] });
  }

  #words([i, j]) {
    const { x, y, ends, escapes, cut, decided, question } = this.answer;
    const k = j * x.length + i;
    const place = `${question.x.key} = ${number(x[i], 6)}, ${question.y.key} = ${number(y[j], 6)}: `;
    if (ends[k] === null) return `${place}no legal start, as it is beyond the reach of a cable or beyond a limit`;
    if (cut[k]) return `${place}not known whether safe, as the run stopped early (${reasonText(ends[k])})`;
    const sure = decided[k] ? "" : `, undecided: some neighbours are ${escapes[k] ? "safe" : "not safe"}`;
    return `${place}${escapes[k] ? "not safe" : "safe"} (${reasonText(ends[k])})${sure}`;
  }

  /** Redraws everything, for example after a change of the theme or of the size. */
  draw() {
    this.erosionDrawn = false;
    this.#repaint();
  }

  /** The position of the current run. */
  #place() {
    const { x, y } = this.answer.question;
    return [x, y].map(({ key }) => this.own(key));
  }

  /** Takes a new run, on which its position may depend. */
  runChanged() {
    if (this.answer && String(this.#place()) !== this.placed) this.#repaint();
  }

  /** Draws the cells, and the erosion if it has changed. */
  #repaint() {
    if (this.box.open) this.picture.request();
  }

  #paintAll() {
    if (this.answer) this.#paint();
    if (!this.eroded || this.erosionDrawn) return;
    this.erosionDrawn = true;
    drawErosion($("erosion"), this.eroded, this.colours(), axisWords(this.numeric, this.eroded.over));
  }

  #paint() {
    const { ends, escapes, cut, decided, question, legal, safe, undecided, cut_short } = this.answer;
    const colours = this.colours();
    setProperties(this.canvas, { hidden: false });
    const { context, width, height } = prepare(this.canvas);
    const frame = (this.frame = frameOf(width, height, question));
    const known = (k) => (escapes[k] ? colours.escaped : colours.safe);
    const fill = (k) => (ends[k] === null || cut[k] ? colours.faint : known(k));
    paintCells(context, frame, question, fill, (k) => !decided[k]);
    const words = [question.x, question.y].map(({ key }) => axisWords(this.numeric, key));
    drawCellAxes(context, frame, question, colours, words);
    const own = this.#place();
    this.placed = String(own);
    crosshair(context, frame, own);
    if (this.pointed) outline(context, frame, question, this.pointed, colours);
    const swatch = (paint, text) => `<span><i class="swatch" style="background:${paint}"></i>${text}</span>`;
    const parts = [swatch(colours.safe, `safe (${safe})`), swatch(colours.escaped, `reaches a limit (${legal - safe - cut_short})`)];
    if (ends.length > legal) parts.push(swatch(colours.faint, `no legal start (${ends.length - legal})`));
    if (undecided) {
      const why = `some neighbours are safe, some not${cut_short ? ", or the run stops early" : ""}`;
      parts.push(`<span><i class="swatch hatched"></i>undecided: ${why} (${undecided})</span>`);
    }
    const html = parts.join("");
    if ($("basin-legend").innerHTML !== html) $("basin-legend").innerHTML = html;
    const over = `Safe basin over ${question.x.key} and ${question.y.key}: ${safe} of ${legal} legal cells are safe`;
    this.canvas.setAttribute("aria-label", `${over}. Arrow keys move, Enter starts a run there.`);
  }
}
