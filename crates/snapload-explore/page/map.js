// How runs end over two keys: filled in while it is computed; each cell leads to its run.

import { Refused, fetchMap } from "./api.js";
import { CIVIDIS, cividis, hatch, outline, outlineBox, rangeOf } from "./cells.js";
import { $ } from "./dom.js";
import { mapCsv, sweepLine } from "./map-files.js";
import { Frame, drawAxes, fontOf, inside, label, prepare, ticks } from "./plot.js";
import { MOST_CELLS, readValue } from "./state.js";
import { copy, save } from "./take.js";
import { number, plain, prose, reasonText, unitText } from "./words.js";

const MARGIN = { left: 56, right: 12, top: 10, bottom: 40 };
/** Larger than beside the small charts. */
const [NUMBERS, LETTERS] = [fontOf(13), fontOf(14)];
/** Values that change while the map is open set it going again after so long a rest. */
const REST_MS = 500;
/** Values that span this are coloured by their logarithms. */
const DECADES = 100;

export class SweepMap {
  constructor(state, { colours, onPick }) {
    this.state = state;
    this.colours = colours;
    this.onPick = onPick;
    this.cells = null;
    this.controller = null;
    this.timer = null;
    this.cursor = [0, 0];
    this.question = "";
    this.box = $("map-box");
    this.canvas = $("map");
    this.numeric = state.schema.keys.filter((key) => key.kind.type === "number");
    for (const side of ["x", "y"]) this.#axisFields(side);
    for (const column of state.schema.map.filter(({ name, kind }) => name === "reason" || kind === "number")) {
      const unit = column.unit ? ` [${column.unit}]` : "";
      $("map-colour").append(new Option(prose(column.meaning) + unit, column.name));
    }
    $("map-colour").addEventListener("change", () =>
      state.set({ map: { ...state.map, colour: $("map-colour").value } }),
    );
    $("map-run").addEventListener("click", () => this.compute());
    $("map-stop").addEventListener("click", () => this.stop("stopped"));
    $("map-wider").addEventListener("click", () => this.#zoomOut());
    $("map-png").addEventListener("click", () => this.canvas.toBlob((blob) => save(blob, "map.png"), "image/png"));
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
    const axis = (name, count) => {
      const { usual } = this.numeric.find((key) => key.name === name);
      return { key: name, low: usual.low, high: usual.high, count };
    };
    return { x: axis("f_o", 51), y: axis("e", 41), colour: "reason" };
  }

  #axisFields(side) {
    const key = $(`map-${side}-key`);
    for (const one of this.numeric) key.append(new Option(one.name, one.name));
    key.addEventListener("change", () => {
      const { usual } = this.numeric.find((one) => one.name === key.value);
      const value = this.state.value(key.value) ?? 1;
      const range = usual ?? { low: value * 0.5, high: value * 2 || 1 };
      const axis = { ...this.state.map[side], key: key.value, ...range };
      const other = side === "x" ? "y" : "x";
      const swapped = this.state.map[other].key === key.value ? { [other]: this.state.map[side] } : {};
      this.state.set({ map: { ...this.state.map, [side]: axis, ...swapped } });
    });
    for (const name of ["low", "high", "count"]) {
      const field = $(`map-${side}-${name}`);
      field.addEventListener("change", () => this.#takeAxis(side, name, field));
    }
  }

  #takeAxis(side, name, field) {
    const value = readValue({ kind: { type: "number" } }, field.value);
    const axis = { ...this.state.map[side], [name]: value };
    const legal =
      value !== undefined &&
      axis.high > axis.low &&
      Number.isInteger(axis.count) &&
      axis.count >= 2 &&
      axis.count <= MOST_CELLS;
    field.setAttribute("aria-invalid", String(!legal));
    $("map-said").textContent = legal ? "" : `${side}: from a lower to a higher value, in 2 to ${MOST_CELLS} cells`;
    if (legal) this.state.set({ map: { ...this.state.map, [side]: axis } });
  }

  toggle() {
    this.state.set({ map: this.state.map ? null : this.#usualMap() });
    if (this.state.map) this.canvas.focus();
  }

  /** Follows the state: opens, closes, computes again where what it shows has changed. */
  follow() {
    const { map } = this.state;
    this.box.open = map !== null;
    if (!map) return this.stop("");
    $("map-colour").value = map.colour;
    for (const side of ["x", "y"]) {
      for (const name of ["key", "low", "high", "count"]) {
        const field = $(`map-${side}-${name}`);
        if (document.activeElement !== field || name === "key") field.value = plain(map[side][name]);
      }
    }
    const question = this.#ask();
    if (JSON.stringify(question) !== this.question) {
      clearTimeout(this.timer);
      this.timer = setTimeout(() => this.compute(), this.question ? REST_MS : 0);
    }
    this.draw();
  }

  /** The question of the map: values other than those of its axes do not matter along them. */
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
    this.cursor = [nearest(this.cells.xs, this.#own(x.key)), nearest(this.cells.ys, this.#own(y.key))];
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
        error instanceof Refused ? error.message : "The map ended early. Is snapload explore still running?",
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
    $("map-stop").hidden = $("map-bar").hidden = !running;
  }

  #own(name) {
    return this.state.value(name) ?? 0;
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
    const cellAt = (event) => {
      if (!this.cells || !this.frame) return null;
      const { x, y } = this.cells;
      const i = Math.floor(((event.offsetX - this.frame.left) / this.frame.width) * x.count);
      const j = Math.floor(((this.frame.top + this.frame.height - event.offsetY) / this.frame.height) * y.count);
      return i >= 0 && i < x.count && j >= 0 && j < y.count ? [i, j] : null;
    };
    this.canvas.addEventListener("pointermove", (event) => this.#point(cellAt(event)));
    const focused = () => document.activeElement === this.canvas;
    this.canvas.addEventListener("pointerleave", () => this.#point(focused() ? this.cursor : null));
    this.canvas.addEventListener("pointerdown", (event) => {
      const cell = cellAt(event);
      // A press focuses the map, which shows the cursor: it is where the press was before that.
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

  /** A box that was drawn becomes the whole map, in as many cells. */
  #zoomTo({ from, to }) {
    const axis = (side, values, k) => {
      const [low, high] = [values[from[k]], values[to[k]]].sort((a, b) => a - b);
      const now = this.state.map[side];
      return high > low ? { ...now, low, high } : now;
    };
    const { xs, ys } = this.cells;
    this.state.set({ map: { ...this.state.map, x: axis("x", xs, 0), y: axis("y", ys, 1) } });
  }

  /** Twice the range of both keys, as far as they go. */
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
    const leap = event.shiftKey ? 5 : 1;
    const to = {
      ArrowLeft: [i - leap, j],
      ArrowRight: [i + leap, j],
      ArrowUp: [i, j + leap],
      ArrowDown: [i, j - leap],
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
    $("map-said").textContent = cell ? this.#words(cell) : "";
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
      : `, ${prose(this.#column(colour).meaning)} ${number(cells[colour][k])}`;
    return `${place}${reasonText(cells.reason[k])} at t = ${number(cells.t[k])}, ${cells.impacts[k]} impacts${more}${sure}`;
  }

  draw() {
    if (!this.box.open || this.framed) return;
    this.framed = requestAnimationFrame(() => {
      this.framed = null;
      if (this.cells && this.state.map) this.#paint();
    });
  }

  #paint() {
    const { cells, state } = this;
    const colours = this.colours();
    const { context, width, height } = prepare(this.canvas);
    const { x, y } = cells;
    const half = (axis) => (0.5 * (axis.high - axis.low)) / (axis.count - 1);
    const frame = new Frame(
      inside(width, height, MARGIN),
      [x.low - half(x), x.high + half(x)],
      [y.low - half(y), y.high + half(y)],
    );
    this.frame = frame;
    const paint = this.#paintOf(colours);
    const [w, h] = [frame.width / x.count, frame.height / y.count];
    const edge = (k, size) => Math.round(k * size);
    for (let j = 0; j < y.count; j += 1) {
      for (let i = 0; i < x.count; i += 1) {
        const k = j * x.count + i;
        const fill = paint(k);
        if (!fill) continue;
        const [left, top] = [edge(i, w), edge(y.count - 1 - j, h)];
        /** @type {[number, number, number, number]} */
        const cell = [frame.left + left, frame.top + top, edge(i + 1, w) - left, edge(y.count - j, h) - top];
        context.fillStyle = fill;
        context.fillRect(...cell);
        if (!this.#uncertain(k)) continue;
        context.fillStyle = hatch(context);
        context.fillRect(...cell);
      }
    }
    const bare = { ...colours, rule: "transparent" };
    drawAxes(context, frame, bare, {
      font: NUMBERS,
      xTicks: ticks(x.low, x.high, frame.width / 70),
      yTicks: ticks(y.low, y.high, frame.height / 40),
    });
    label(context, colours, this.#axisWords(x), frame.left + frame.width / 2, height - 8, 0, LETTERS);
    label(context, colours, this.#axisWords(y), 14, frame.top + frame.height / 2, -Math.PI / 2, LETTERS);
    this.#crosshair(context, frame, [this.#own(x.key), this.#own(y.key)]);
    if (this.drawn) outlineBox(context, frame, cells, this.drawn, colours);
    if (this.pointed) outline(context, frame, cells, this.pointed, colours);
    this.#legend(colours);
    this.canvas.setAttribute(
      "aria-label",
      `Map of ${prose(this.#column(state.map.colour).meaning)} over ${x.key} and ${y.key}, ${cells.done} of ${cells.count} runs. ` +
        "Arrow keys move, Enter runs the cell.",
    );
  }

  #column(name) {
    return this.state.schema.map.find((column) => column.name === name);
  }

  #axisWords({ key }) {
    const { symbol, unit } = this.numeric.find((one) => one.name === key);
    return unitText(unit) ? `${prose(symbol)}  [${unitText(unit)}]` : symbol;
  }

  /** What a cell is painted with, by its index; nothing where there is nothing yet. */
  #paintOf(colours) {
    const { cells } = this;
    const { colour } = this.state.map;
    const other = (k) => (cells.error[k] ? colours.faint : null);
    if (colour === "reason") return (k) => (cells.reason[k] ? colours[`end-${cells.reason[k]}`] : other(k));
    const { low, high, log } = this.#scale(colour);
    const along = log ? (value) => Math.log(Math.max(value, low) / low) / Math.log(high / low) : null;
    const linear = (value) => (value - low) / (high - low || 1);
    return (k) => (cells[colour][k] === null ? other(k) : cividis((along ?? linear)(cells[colour][k])));
  }

  /** From the lowest to the highest value that there is; by decades where the values span some. */
  #scale(colour) {
    const [low, high] = rangeOf(this.cells[colour]);
    const [least] = rangeOf(this.cells[colour].map((value) => (value > 0 ? value : null)));
    const log = low >= 0 && high > DECADES * least;
    return { low: log ? least : low, high, log };
  }

  /** What rounding may decide: the run is not known to its end, or that was not asked, as of a long one. */
  #uncertain(k) {
    return this.cells.reason[k] !== null && this.cells.certain[k] !== true;
  }

  #legend(colours) {
    const { cells } = this;
    const { colour } = this.state.map;
    const swatch = (paint, words) => `<span><i class="swatch" style="background:${paint}"></i>${words}</span>`;
    const refused = cells.error.filter(Boolean).length;
    const parts = refused ? [swatch(colours.faint, `not allowed (${refused})`)] : [];
    if (colour === "reason") {
      const counts = this.state.schema.stops.map((reason) => [reason, cells.reason.filter((one) => one === reason).length]);
      parts.unshift(
        ...counts
          .filter(([, n]) => n)
          .map(([reason, n]) => swatch(colours[`end-${reason}`], `${reasonText(reason)} (${n})`)),
      );
    } else {
      const { low, high, log } = this.#scale(colour);
      parts.unshift(
        `<span>${number(low, 3)}</span>`,
        `<i class="bar-key" style="background:linear-gradient(90deg,${CIVIDIS.join()})"></i>`,
        `<span>${number(high, 3)}${log ? ", by decades" : ""}</span>`,
      );
    }
    const unsure = cells.reason.filter((_, k) => this.#uncertain(k)).length;
    if (unsure) parts.push(`<span><i class="swatch hatched"></i>not certain, as rounding may decide (${unsure})</span>`);
    const html = parts.join("");
    if ($("map-legend").innerHTML !== html) $("map-legend").innerHTML = html;
  }

  /** Where the run that is shown lies. */
  #crosshair(context, frame, [vx, vy]) {
    const inside = vx >= frame.x0 && vx <= frame.x1 && vy >= frame.y0 && vy <= frame.y1;
    if (!inside) return;
    const [x, y] = [frame.x(vx), frame.y(vy)];
    for (const [colour, lineWidth] of [
      ["#fff", 4.5],
      ["#000", 2],
    ]) {
      Object.assign(context, { strokeStyle: colour, lineWidth });
      context.beginPath();
      context.arc(x, y, 6, 0, 2 * Math.PI);
      context.stroke();
    }
  }
}

/** The values of an axis as decimals that one would write. */
function spaced({ low, high, count }) {
  return Array.from({ length: count }, (_, i) => Number((low + ((high - low) * i) / (count - 1)).toPrecision(12)));
}

function nearest(values, wanted) {
  return values.reduce((best, value, i) => (Math.abs(value - wanted) < Math.abs(values[best] - wanted) ? i : best), 0);
}
