// The map of outcomes over two keys: filled in while it is computed; each cell leads to its run.

import { Refused, fetchMap } from "./api.js";
import { AxisFields, usualAxis, withAxis } from "./axis-fields.js";
import {
  CIVIDIS,
  axisWords,
  cellOf,
  cividis,
  crosshair,
  drawCellAxes,
  frameOf,
  outline,
  outlineBox,
  paintCells,
  rangeOf,
} from "./cells.js";
import { $, setProperties } from "./dom.js";
import { mapCsv, sweepLine } from "./map-files.js";
import { mapPicture } from "./map-picture.js";
import { FramedPicture, prepare } from "./plot.js";
import { copy, save } from "./export.js";
import { endColour } from "./theme.js";
import { number, unitText, withSymbols, reasonText } from "./formatting.js";

/** An open map is computed again this long after the last change of values. */
const REST_MS = 500;
/** Values that span more than this factor are coloured by their logarithms. */
const DECADES = 100;

export class SweepMap {
  constructor(state, { colours, own, onPick }) {
    this.state = state;
    this.colours = colours;
    this.own = own;
    this.picture = new FramedPicture(() => this.#paint());
    this.onPick = onPick;
    this.cells = null;
    this.controller = null;
    this.timer = null;
    this.cursor = [0, 0];
    this.question = "";
    this.box = $("map-box");
    this.canvas = $("map");
    this.numeric = state.schema.keys.filter((key) => key.kind.type === "number");
    this.axes = Object.entries({ x: "Horizontal", y: "Vertical" }).map(
      ([side, legend]) =>
        new AxisFields(`map-${side}`, this.numeric, {
          legend,
          value: own,
          currentAxis: () => state.map[side],
          onChange: (axis) => state.set({ map: withAxis(state.map, side, axis) }),
          onInvalid: (words) => ($("map-message").textContent = words),
        }),
    );
    for (const column of state.schema.map.filter(({ name, kind }) => name === "reason" || kind === "number")) {
      const unit = column.unit ? ` [${column.unit}]` : "";
      $("map-colour").append(new Option(withSymbols(column.meaning) + unit, column.name));
    }
    $("map-colour").addEventListener("change", () =>
      state.set({ map: { ...state.map, colour: $("map-colour").value } }),
    );
    $("map-run").addEventListener("click", () => this.compute());
    $("map-stop").addEventListener("click", () => this.stop("stopped"));
    $("map-wider").addEventListener("click", () => this.#zoomOut());
    $("map-png").addEventListener("click", () => this.cells && this.#savePicture());
    $("map-csv").addEventListener("click", () => this.cells && save(mapCsv(this.cells, this.columns), "map.csv"));
    $("map-sweep").addEventListener("click", () => copy($("map-sweep"), sweepLine(state)));
    this.box.addEventListener("toggle", () => {
      if (this.box.open === (state.map !== null)) return;
      state.set({ map: this.box.open ? this.#usualMap() : null });
      if (this.box.open) this.canvas.scrollIntoView({ block: "nearest" });
    });
    this.#listen();
  }

  #usualMap() {
    return { x: usualAxis(this.numeric, "f_o", 51), y: usualAxis(this.numeric, "e", 41), colour: "reason" };
  }

  toggle() {
    this.state.set({ map: this.state.map ? null : this.#usualMap() });
    if (this.state.map) this.canvas.focus();
  }

  /** Follows the state: opens, closes, and computes the map again if its values have changed. */
  follow() {
    const { map } = this.state;
    this.box.open = map !== null;
    if (!map) return this.stop("");
    $("map-colour").value = map.colour;
    if (this.cells && this.pointed) $("map-message").textContent = this.#words(this.pointed);
    for (const axis of this.axes) axis.show();
    const question = this.#ask();
    if (JSON.stringify(question) !== this.question) {
      clearTimeout(this.timer);
      this.timer = setTimeout(() => this.compute(), this.question ? REST_MS : 0);
    }
    this.draw();
  }

  /** The request of the map: the values of the axes' keys are left out. */
  #ask() {
    const { x, y } = this.state.map;
    const values = { ...this.state.values };
    delete values[x.key];
    delete values[y.key];
    return { values, x, y };
  }

  async compute() {
    this.stop("");
    const question = this.#ask();
    this.question = JSON.stringify(question);
    const { x, y } = question;
    const count = x.count * y.count;
    this.columns = [...this.state.schema.map.map(({ name }) => name), "error"];
    this.cells = Object.fromEntries(this.columns.map((name) => [name, new Array(count).fill(null)]));
    Object.assign(this.cells, { x, y, xs: spaced(x), ys: spaced(y), done: 0, count });
    const own = this.#place();
    this.cursor = [nearest(this.cells.xs, own[0]), nearest(this.cells.ys, own[1])];
    if (this.pointed) this.#point(this.cursor);
    const controller = (this.controller = new AbortController());
    this.#progress(`0 of ${count} runs`);
    $("map-bar").value = 0;
    this.#running(true);
    try {
      for await (const line of fetchMap(question, controller.signal)) this.#fill(line);
      this.#progress(`${count} runs`);
    } catch (error) {
      if (error.name === "AbortError") return;
      this.#progress(
        error instanceof Refused ? error.message : "The map is incomplete. Is snapload explore still running?",
      );
    } finally {
      if (this.controller === controller) {
        this.controller = null;
        this.#running(false);
      }
    }
    this.draw();
  }

  stop(word) {
    clearTimeout(this.timer);
    this.controller?.abort();
    this.controller = null;
    this.#running(false);
    if (word) {
      this.#progress(`${word} at ${this.cells?.done ?? 0} of ${this.cells?.count ?? 0} runs`);
    }
    if (!this.state.map) this.question = "";
  }

  #running(running) {
    for (const id of ["map-stop", "map-bar"]) setProperties($(id), { hidden: !running });
  }

  /** The position of the current run. */
  #place() {
    return [this.cells.x, this.cells.y].map(({ key }) => this.own(key));
  }

  /** Takes a new run, on which its position may depend. */
  runChanged() {
    if (this.cells && String(this.#place()) !== this.placed) this.draw();
  }

  #fill(line) {
    const { cells } = this;
    if (line.x && line.y) Object.assign(cells, { xs: line.x, ys: line.y });
    if (!line.reason) return;
    line.reason.forEach((_, k) => {
      const i = line.cells ? line.cells[k] : line.first + k;
      for (const name of this.columns) cells[name][i] = line[name][k];
    });
    cells.done += line.reason.length;
    this.#progress(`${Math.min(cells.done, cells.count)} of ${cells.count} runs`);
    $("map-bar").value = cells.done / cells.count;
    this.draw();
  }

  #progress(text) {
    $("map-progress").textContent = text;
  }

  #listen() {
    const cellAt = (event) => (this.cells && this.frame ? cellOf(event, this.frame, this.cells) : null);
    this.canvas.addEventListener("pointermove", (event) => this.#point(cellAt(event)));
    const focused = () => document.activeElement === this.canvas;
    this.canvas.addEventListener("pointerleave", () => this.#point(focused() ? this.cursor : null));
    this.canvas.addEventListener("pointerdown", (event) => {
      const cell = cellAt(event);
      // A press focuses the map, which shows the cursor at the pressed cell.
      this.cursor = cell ?? this.cursor;
      this.drawn = cell && event.pointerType === "mouse" ? { from: cell, to: cell } : null;
      if (this.drawn) this.canvas.setPointerCapture(event.pointerId);
    });
    this.canvas.addEventListener("pointermove", (event) => {
      const cell = this.drawn && cellAt(event);
      if (cell) this.drawn.to = cell;
    });
    this.canvas.addEventListener("pointerup", (event) => {
      const box = this.drawn;
      this.drawn = null;
      if (box && box.from.join() !== box.to.join()) this.#zoomTo(box);
      else this.#pick(cellAt(event));
    });
    this.canvas.addEventListener("pointercancel", () => (this.drawn = null));
    this.canvas.addEventListener("keydown", (event) => this.#key(event));
    this.canvas.addEventListener("focus", () => this.#point(this.cursor));
    this.canvas.addEventListener("blur", () => this.#point(null));
  }

  /** Zooms in to a selection box, with the same number of cells. */
  #zoomTo({ from, to }) {
    const axis = (side, values, k) => {
      const [low, high] = [values[from[k]], values[to[k]]].sort((a, b) => a - b);
      const now = this.state.map[side];
      return high > low ? { ...now, low, high } : now;
    };
    const { xs, ys } = this.cells;
    this.state.set({ map: { ...this.state.map, x: axis("x", xs, 0), y: axis("y", ys, 1) } });
  }

  /** Doubles the range of both keys, within their bounds. */
  #zoomOut() {
    const axis = (now) => {
      const { kind } = this.numeric.find((one) => one.name === now.key);
      const [middle, half] = [0.5 * (now.low + now.high), now.high - now.low];
      const round = (value) => Number(value.toPrecision(6));
      return { ...now, low: round(Math.max(middle - half, kind.low)), high: round(Math.min(middle + half, kind.high)) };
    };
    const { x, y } = this.state.map;
    this.state.set({ map: { ...this.state.map, x: axis(x), y: axis(y) } });
  }

  #key(event) {
    if (!this.cells) return;
    const [i, j] = this.cursor;
    const { x, y } = this.cells;
    const stepSize = event.shiftKey ? 5 : 1;
    const to = {
      ArrowLeft: [i - stepSize, j],
      ArrowRight: [i + stepSize, j],
      ArrowUp: [i, j + stepSize],
      ArrowDown: [i, j - stepSize],
      Home: [0, j],
      End: [x.count - 1, j],
      PageUp: [i, y.count - 1],
      PageDown: [i, 0],
    }[event.key];
    if (to) {
      this.cursor = [Math.min(Math.max(to[0], 0), x.count - 1), Math.min(Math.max(to[1], 0), y.count - 1)];
      this.#point(this.cursor);
    } else if (event.key === "Enter" || event.key === " ") this.#pick(this.cursor);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  #point(cell) {
    if (!this.cells) return;
    this.pointed = cell;
    $("map-message").textContent = cell ? this.#words(cell) : "";
    this.draw();
  }

  #pick(cell) {
    if (!cell) return;
    this.cursor = cell;
    this.#point(cell);
    const { x, y, xs, ys } = this.cells;
    this.onPick({ [x.key]: xs[cell[0]], [y.key]: ys[cell[1]] });
  }

  #words([i, j]) {
    const { cells } = this;
    const k = j * cells.x.count + i;
    const place = `${cells.x.key} = ${number(cells.xs[i], 6)}, ${cells.y.key} = ${number(cells.ys[j], 6)}: `;
    if (cells.error[k]) return place + cells.error[k];
    if (cells.reason[k] === null) return `${place}not computed yet`;
    const { colour } = this.state.map;
    const sure = this.#uncertain(k) ? ", not certain" : "";
    const more = ["reason", "t", "impacts"].includes(colour)
      ? ""
      : `, ${withSymbols(this.#column(colour).meaning)} ${number(cells[colour][k])}`;
    return `${place}${reasonText(cells.reason[k])} at t = ${number(cells.t[k])}, ${cells.impacts[k]} impacts${more}${sure}`;
  }

  draw() {
    if (this.box.open) this.picture.request();
  }

  #paint() {
    const { cells, state } = this;
    if (!cells || !state.map) return;
    const colours = this.colours();
    const { context, width, height } = prepare(this.canvas);
    const { x, y } = cells;
    const frame = (this.frame = frameOf(width, height, cells));
    this.placed = String(this.#place());
    this.#paintMap(context, frame, colours);
    if (this.drawn) outlineBox(context, frame, cells, this.drawn, colours);
    if (this.pointed) outline(context, frame, cells, this.pointed, colours);
    this.#legend(colours);
    this.canvas.setAttribute(
      "aria-label",
      `Map of ${withSymbols(this.#column(state.map.colour).meaning)} over ${x.key} and ${y.key}, ${cells.done} of ${cells.count} runs computed. ` +
        "Arrow keys move, Enter runs the cell.",
    );
  }

  /** The cells with their axes, and the current run. */
  #paintMap(context, frame, colours) {
    const { cells } = this;
    paintCells(context, frame, cells, this.#paintOf(colours), (k) => this.#uncertain(k));
    drawCellAxes(context, frame, cells, colours, [this.#axisWords(cells.x), this.#axisWords(cells.y)]);
    crosshair(context, frame, this.#place());
  }

  /** The map in the size of the page, with its legend. */
  async #savePicture() {
    // An exported picture always has the light theme.
    const colours = this.colours("light");
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const frame = frameOf(width, height, this.cells);
    const entries = this.#legendEntries(colours);
    const { meaning, unit } = this.#column(this.state.map.colour);
    const words = withSymbols(meaning) + (unitText(unit) ? ` [${unitText(unit)}]` : "");
    // On the page the field of the colour says what the numbers are.
    if (entries.some(({ from }) => from)) entries.unshift({ words });
    const paint = (context) => this.#paintMap(context, frame, colours);
    save(await mapPicture({ width, height, colours, entries, paint }), "map.png");
  }

  #column(name) {
    return this.state.schema.map.find((column) => column.name === name);
  }

  #axisWords({ key }) {
    return axisWords(this.numeric, key);
  }

  /** The colour of a cell, by its index; nothing if it is not computed yet. */
  #paintOf(colours) {
    const { cells } = this;
    const { colour } = this.state.map;
    const other = (k) => (cells.error[k] ? colours.faint : null);
    if (colour === "reason") return (k) => (cells.reason[k] ? endColour(colours, cells.reason[k]) : other(k));
    const { low, high, log } = this.#scale(colour);
    const along = (value) => (log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low || 1));
    return (k) => {
      const value = cells[colour][k];
      // A logarithmic scale has no zero.
      return value === null ? other(k) : log && value === 0 ? colours.rule : cividis(along(value));
    };
  }

  /** The range of all values; logarithmic if they span several decades. */
  #scale(colour) {
    const [low, high] = rangeOf(this.cells[colour]);
    const [least] = rangeOf(this.cells[colour].map((value) => (value > 0 ? value : null)));
    const log = low >= 0 && least > 0 && high > DECADES * least;
    return { low: log ? least : low, high, log };
  }

  /** Whether rounding may decide the end of a run: past its horizon, or without one, as for long runs. */
  #uncertain(k) {
    return this.cells.reason[k] !== null && this.cells.certain[k] !== true;
  }

  #legend(colours) {
    const html = this.#legendEntries(colours)
      .map(({ from, hatched, fill, words }) => {
        if (from) {
          const shades = `linear-gradient(90deg,${CIVIDIS.join()})`;
          return `<span>${from}</span><i class="bar-key" style="background:${shades}"></i><span>${words}</span>`;
        }
        if (hatched) return `<span><i class="swatch hatched"></i>${words}</span>`;
        return `<span>${fill ? `<i class="swatch" style="background:${fill}"></i>` : ""}${words}</span>`;
      })
      .join("");
    if ($("map-legend").innerHTML !== html) $("map-legend").innerHTML = html;
  }

  /**
   * What the colours and the hatching mean: words, and before them a `fill`, hatching, or the bar of numbers, with the
   * least of them, `from`, before it.
   * @returns {{ words: string, fill?: string, hatched?: boolean, from?: string }[]}
   */
  #legendEntries(colours) {
    const { cells } = this;
    const { colour } = this.state.map;
    const refused = cells.error.filter(Boolean).length;
    /** @type {{ words: string, fill?: string, hatched?: boolean, from?: string }[]} */
    const parts = refused ? [{ fill: colours.faint, words: `not allowed (${refused})` }] : [];
    if (colour === "reason") {
      const counts = this.state.schema.stops.map((reason) => [reason, cells.reason.filter((one) => one === reason).length]);
      const there = counts.filter(([, n]) => n);
      parts.unshift(
        ...there.map(([reason, n]) => ({ fill: endColour(colours, reason), words: `${reasonText(reason)} (${n})` })),
      );
    } else {
      const { low, high, log } = this.#scale(colour);
      const zeros = log ? cells[colour].filter((value) => value === 0).length : 0;
      if (zeros) parts.unshift({ fill: colours.rule, words: `0 (${zeros})` });
      const known = cells[colour].some((value) => value !== null);
      if (known) parts.unshift({ from: number(low, 3), words: `${number(high, 3)}${log ? ", logarithmic" : ""}` });
    }
    const unsure = cells.reason.filter((_, k) => this.#uncertain(k)).length;
    if (unsure) parts.push({ hatched: true, words: `not certain: rounding may decide how they end (${unsure})` });
    return parts;
  }
}

/** The values of an axis as short decimals. */
function spaced({ low, high, count }) {
  return Array.from({ length: count }, (_, i) => Number((low + ((high - low) * i) / (count - 1)).toPrecision(12)));
}

function nearest(values, wanted) {
  return values.reduce((best, value, i) => (Math.abs(value - wanted) < Math.abs(values[best] - wanted) ? i : best), 0);
}
