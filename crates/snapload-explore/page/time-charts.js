// Charts against time with one time cursor, for all pages of motions. A list of charts defines what is drawn.

import { Frame, drawAxes, inside, label, prepare, ticks } from "./plot.js";
import { number } from "./formatting.js";

const MARGIN = { left: 50, right: 10, top: 6 };
const NEAR_PX = 9;

/**
 * A chart: its `id`, `name`, `symbol` and `unit`; `range(run, seen, pins)` of y, `draw(context, frame, run, looks)`,
 * `read(run, moment)` as text, `words(run)` for screen readers; optionally `value(moment)`, the position of a dot, and
 * `marks(run)`, columns `t` and `y` of marks that can be hovered, with `markWords(run, i)`.
 */
export class TimeCharts {
  /** `onJump` receives the clicked time, `onHover` the hovered one, `onZoom` the time window to show. */
  constructor(root, charts, { colours, unit, onJump, onHover, onZoom }) {
    this.colours = colours;
    this.unit = unit;
    this.onJump = onJump;
    this.onHover = onHover;
    this.onZoom = onZoom;
    this.run = null;
    this.pins = [];
    this.parts = charts.map((chart) => this.#build(root, chart));
    this.frames = new Map();
    this.drag = null;
  }

  #build(root, chart) {
    const figure = document.createElement("figure");
    figure.className = "chart";
    figure.innerHTML = `<figcaption><span class="chart-name"><span>${chart.name}</span> <i>${chart.symbol}</i>
      <span class="unit">[${chart.unit}]</span></span><output class="reading"></output></figcaption>
      <div class="stack"><canvas class="base" role="img"></canvas><div class="over" aria-hidden="true">
        <div class="brush"></div><div class="upright hovered"></div><div class="upright"></div>
        <div class="dot"></div><div class="ring"></div></div></div>`;
    root.append(figure);
    const find = (selector) => figure.querySelector(selector);
    const part = {
      chart,
      base: find("canvas"),
      over: find(".over"),
      reading: find("output"),
      brush: find(".brush"),
      hovered: find(".hovered"),
      upright: find(".upright:not(.hovered)"),
      dot: find(".dot"),
      ring: find(".ring"),
    };
    part.reading.setAttribute("aria-live", "off");
    this.#listen(part);
    return part;
  }

  #listen(part) {
    const { over } = part;
    const timeAt = (event) => {
      const frame = this.frames.get(part.chart.id);
      const t = frame.atX(event.clientX - over.getBoundingClientRect().left);
      return Math.min(Math.max(t, frame.x0), Math.min(frame.x1, this.run.tEnd));
    };
    over.addEventListener("pointermove", (event) => {
      if (!this.run) return;
      const t = timeAt(event);
      if (this.drag?.zoom) this.drag.to = t;
      else if (this.drag) this.onJump(t);
      this.onHover(t, { part, x: event.offsetX, y: event.offsetY });
    });
    over.addEventListener("pointerdown", (event) => {
      if (!this.run || event.button !== 0) return;
      const t = timeAt(event);
      this.drag = { zoom: event.shiftKey, from: t, to: t };
      if (event.pointerType === "mouse") over.setPointerCapture(event.pointerId);
      if (!this.drag.zoom) this.onJump(this.#snapTo(part, event) ?? t);
    });
    over.addEventListener("pointerup", () => {
      const { drag } = this;
      this.drag = null;
      if (drag?.zoom && Math.abs(drag.to - drag.from) > 0) this.onZoom([drag.from, drag.to].sort((a, b) => a - b));
    });
    // A drag with shift selects a time window, and no text.
    over.addEventListener("mousedown", (event) => event.shiftKey && event.preventDefault());
    over.addEventListener("pointercancel", () => (this.drag = null));
    over.addEventListener("pointerleave", () => this.onHover(null));
  }

  /** The time of the mark that was clicked. */
  #snapTo(part, event) {
    const i = this.#nearest(part.chart, event.offsetX, event.offsetY);
    return i === null ? null : part.chart.marks(this.run).t[i];
  }

  /** The mark of a chart that is nearest to a point of it, within reach of a pointer. */
  #nearest(chart, x, y) {
    if (!chart.marks) return null;
    const frame = this.frames.get(chart.id);
    const marks = chart.marks(this.run);
    let best = [NEAR_PX, null];
    for (let i = 0; i < marks.t.length; i += 1) {
      const distance = Math.hypot(frame.x(marks.t[i]) - x, frame.y(marks.y[i]) - y);
      if (distance < best[0]) best = [distance, i];
    }
    return best[1];
  }

  /** Draws what does not depend on the time cursor. */
  draw(run, window, pins = []) {
    this.run = run;
    this.pins = pins;
    const range = window ?? [0, run.tEnd || 1];
    this.parts.forEach((part, i) => this.#drawBase(part, range, i === this.parts.length - 1));
  }

  #drawBase({ chart, base }, range, last) {
    const colours = this.colours();
    const { context, width, height } = prepare(base);
    const bottom = last ? 30 : 8;
    const seen = (columns, column) => column.slice(...rows(columns.t, range));
    const ys = chart.range(this.run, seen, this.pins);
    const frame = new Frame(inside(width, height, { ...MARGIN, bottom }), range, ys);
    this.frames.set(chart.id, frame);
    context.save();
    this.#shade(context, frame, colours);
    context.restore();
    drawAxes(context, frame, colours, {
      xLabels: last,
      xTicks: ticks(...range, frame.width / 70),
      yTicks: ticks(...ys, frame.height / 20),
    });
    if (last) label(context, colours, `t  [${this.unit}]`, frame.left + frame.width / 2, height - 3);
    context.save();
    frame.clip(context);
    context.lineWidth = 1.3;
    context.lineJoin = "round";
    chart.draw(context, frame, this.run, { colours, pins: this.pins });
    context.restore();
    const when = `against time from ${number(range[0])} to ${number(range[1])} ${this.unit}`;
    base.setAttribute("aria-label", `${chart.name} ${when}: ${chart.words(this.run)}. The page has a table of the events.`);
  }

  /** Shades the time past the horizon of trust. */
  #shade(context, frame, colours) {
    const { t } = this.run.horizon;
    if (t === null || t >= frame.x1) return;
    frame.clip(context);
    context.fillStyle = colours.shade;
    const x = Math.max(frame.x(t), frame.left);
    context.fillRect(x, frame.top, frame.left + frame.width - x, frame.height);
  }

  /** Shows the time cursor, the hovered mark, and the readings: elements that move over an unchanged chart. */
  cursor(t, hover) {
    if (!this.run) return;
    const read = this.run.at(this.run.nearest(hover?.t ?? t));
    for (const part of this.parts) {
      const frame = this.frames.get(part.chart.id);
      const drag = this.drag?.zoom ? this.drag : null;
      const upright = (mark, time) =>
        placeMark(mark, time !== undefined && frame.holdsX(time), frame.x(time), frame.top, 0, frame.height);
      upright(part.upright, t);
      upright(part.hovered, hover?.t);
      const [a, b] = drag ? [frame.x(drag.from), frame.x(drag.to)].sort((one, other) => one - other) : [0, 0];
      placeMark(part.brush, drag !== null, a, frame.top, b - a, frame.height);
      const value = part.chart.value?.(read);
      placeMark(part.dot, value !== undefined && frame.holdsX(read.t), frame.x(read.t), frame.y(value));
      const near = hover?.at?.part === part ? this.#nearest(part.chart, hover.at.x, hover.at.y) : null;
      const marks = near === null ? null : part.chart.marks(this.run);
      placeMark(part.ring, near !== null, frame.x(marks?.t[near]), frame.y(marks?.y[near]));
      const words = near === null ? part.chart.read(this.run, read) : part.chart.markWords(this.run, near);
      if (part.reading.value !== words) part.reading.value = words;
    }
  }
}

/**
 * A range that starts at zero.
 * @param {number[]} range
 */
export const above = ([, high]) => [0, high];

/**
 * The rows that show a range of time: one more on either side, so that lines leave the frame.
 * @param {number[]} t
 * @param {number[]} range
 * @returns {[number, number]}
 */
export function rows(t, [from, to]) {
  const first = t.findIndex((time) => time > from);
  const last = t.findIndex((time) => time > to);
  return [first < 0 ? Math.max(t.length - 1, 0) : Math.max(first - 1, 0), last < 0 ? t.length : last + 1];
}

/** Places a mark at a position of its chart, or hides it. */
function placeMark(mark, there, x, y, width, height) {
  mark.hidden = !there;
  if (!there) return;
  mark.style.transform = `translate(${x}px, ${y}px)`;
  if (width) mark.style.width = `${width}px`;
  if (height) mark.style.height = `${height}px`;
}
