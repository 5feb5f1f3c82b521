// θ, v_n, tensions and energy against time, under one time cursor.

import { FONT, Frame, drawAxes, drawColumn, drawMark, inside, prepare, span, ticks } from "./plot.js";
import { fixed, number } from "./words.js";

const MARGIN = { left: 50, right: 10, top: 6 };
const NEAR_PX = 9;

const CHARTS = [
  { id: "theta", symbol: "θ", unit: "rad", name: "Rotation" },
  { id: "snaps", symbol: "vₙ", unit: "L/T", name: "Snap velocity" },
  { id: "tensions", symbol: "T", unit: "F", name: "Tensions" },
  { id: "energy", symbol: "E", unit: "F L", name: "Energy" },
];

const READ = {
  theta: (run, moment) => `${about(moment)}${fixed(moment.theta, 4)} rad`,
  snaps: (run, moment) => latestSnap(run, moment.t),
  tensions: (run, moment) => moment.tensions.map((T, i) => `T${"₁₂"[i]} ${number(T, 3)}`).join("  ") + " F",
  energy: (run, moment) => `${about(moment)}${fixed(moment.energy, 5)} F L`,
};

/** What is read between rows far apart is said to be so. */
export const about = (moment) => (moment.rough ? "about " : "");

function latestSnap(run, t) {
  const i = run.latestImpact(t);
  return i < 0 ? "none yet" : `${number(run.impacts.v_n[i], 4)} L/T, latest`;
}

/** Everything there is to say of an impact, in a line. */
export function impactWords(run, i) {
  const { cable, v_n, impulse, digits, t } = run.impacts;
  const known = Number.isFinite(digits[i]) ? ` · ${Math.max(0, Math.floor(digits[i]))} digits` : "";
  const when = `impact ${i + 1}, cable ${cable[i]} · t ${number(t[i], 6)}`;
  return `${when} · vₙ ${number(v_n[i])} · impulse ${number(impulse[i])}${known}`;
}

export class Charts {
  /** `onJump` is told where a chart was clicked, `onHover` what the pointer is over, `onZoom` which time to show. */
  constructor(root, { colours, onJump, onHover, onZoom }) {
    this.colours = colours;
    this.onJump = onJump;
    this.onHover = onHover;
    this.onZoom = onZoom;
    this.run = null;
    this.hover = null;
    this.parts = [];
    for (const chart of CHARTS) this.parts.push(this.#build(root, chart));
    this.frames = new Map();
    this.drag = null;
  }

  #build(root, chart) {
    const figure = document.createElement("figure");
    figure.className = "chart";
    figure.innerHTML = `<figcaption><span class="chart-name">${chart.name} <i>${chart.symbol}</i>
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
    // A drag with shift chooses time, and no text.
    over.addEventListener("mousedown", (event) => event.shiftKey && event.preventDefault());
    over.addEventListener("pointercancel", () => (this.drag = null));
    over.addEventListener("pointerleave", () => this.onHover(null));
  }

  /** The time of the impact whose mark was clicked. */
  #snapTo(part, event) {
    const i = part.chart.id === "snaps" ? this.nearest(event.offsetX, event.offsetY) : null;
    return i === null ? null : this.run.impacts.t[i];
  }

  /** The impact whose mark is nearest to a point of the chart of snaps, within reach of a pointer. */
  nearest(x, y) {
    const frame = this.frames.get("snaps");
    const { t, v_n } = this.run.impacts;
    let best = [NEAR_PX, null];
    for (let i = 0; i < t.length; i += 1) {
      const distance = Math.hypot(frame.x(t[i]) - x, frame.y(v_n[i]) - y);
      if (distance < best[0]) best = [distance, i];
    }
    return best[1];
  }

  /** Draws what does not depend on the time cursor. */
  draw(run, window, pins) {
    this.run = run;
    this.pins = pins;
    const range = window ?? [0, run.tEnd || 1];
    this.parts.forEach((part, i) => this.#drawBase(part, range, i === this.parts.length - 1));
  }

  #drawBase({ chart, base }, range, last) {
    const colours = this.colours();
    const { context, width, height } = prepare(base);
    const bottom = last ? 30 : 8;
    const run = this.run;
    const seen = (columns, name) => columns[name].slice(...rows(columns.t, range));
    const all = [run, ...this.pins.map((pin) => pin.run)];
    const ys = {
      theta: () => span(all.map((one) => seen(one.motion, "theta"))),
      snaps: () => above(span(all.map((one) => seen(one.impacts, "v_n")))),
      tensions: () => above(span(all.flatMap((one) => [seen(one.motion, "T1"), seen(one.motion, "T2")]))),
      energy: () => span(all.map((one) => seen(one.motion, "energy"))),
    }[chart.id]();
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
    if (last) label(context, colours, "t  [T]", frame.left + frame.width / 2, height - 3);
    context.save();
    frame.clip(context);
    context.lineWidth = 1.3;
    context.lineJoin = "round";
    this.#data(context, chart, frame, colours);
    context.restore();
    base.setAttribute("aria-label", this.#words(chart, range));
  }

  /** What lies past the horizon of trust. */
  #shade(context, frame, colours) {
    const { t } = this.run.horizon;
    if (t === null || t >= frame.x1) return;
    frame.clip(context);
    context.fillStyle = colours.shade;
    const x = Math.max(frame.x(t), frame.left);
    context.fillRect(x, frame.top, frame.left + frame.width - x, frame.height);
  }

  /** Runs that were kept, beneath the run that is shown. */
  #pinned(context, chart, frame) {
    for (const { run, colour } of this.pins) {
      context.strokeStyle = colour;
      if (chart.id === "snaps") {
        run.impacts.t.forEach((t, i) => {
          if (t < frame.x0 || t > frame.x1 || !(run.impacts.v_n[i] > 0)) return;
          drawMark(context, run.impacts.cable[i], frame.x(t), frame.y(run.impacts.v_n[i]), 2.2);
        });
      } else if (chart.id !== "tensions") {
        drawColumn(context, frame, run.motion.t, run.motion[chart.id], ...rows(run.motion.t, [frame.x0, frame.x1]));
      }
    }
  }

  #data(context, chart, frame, colours) {
    const { motion, impacts } = this.run;
    this.#pinned(context, chart, frame);
    const [from, to] = rows(motion.t, [frame.x0, frame.x1]);
    if (chart.id === "snaps") {
      impacts.t.forEach((t, i) => {
        if (t < frame.x0 || t > frame.x1 || !(impacts.v_n[i] > 0)) return;
        context.strokeStyle = colours[`cable-${impacts.cable[i]}`];
        drawMark(context, impacts.cable[i], frame.x(t), frame.y(impacts.v_n[i]), 2.8);
      });
    } else if (chart.id === "tensions") {
      if (!(this.run.timeTaut > 0)) {
        label(
          context,
          colours,
          "no cable stays taut in this run",
          frame.left + frame.width / 2,
          frame.top + frame.height / 2,
        );
      }
      for (const cable of [1, 2]) {
        context.strokeStyle = colours[`cable-${cable}`];
        context.lineWidth = 1.8;
        this.#tension(context, frame, cable, from, to);
      }
    } else {
      context.strokeStyle = colours.ink;
      drawColumn(context, frame, motion.t, motion[chart.id], from, to);
      this.#ghost(context, chart, frame, colours);
    }
  }

  #ghost(context, chart, frame, colours) {
    if (!this.run.ghost) return;
    const { motion } = this.run.ghost;
    context.strokeStyle = colours.ghost;
    context.setLineDash([5, 3]);
    drawColumn(context, frame, motion.t, motion[chart.id], ...rows(motion.t, [frame.x0, frame.x1]));
    context.setLineDash([]);
  }

  /** The tension of a cable while it is taut: slack is no line at zero but none. */
  #tension(context, frame, cable, from, to) {
    const { t } = this.run.motion;
    const T = this.run.motion[`T${cable}`];
    context.beginPath();
    let drawing = false;
    for (let i = from; i < to; i += 1) {
      const taut = T[i] > 0;
      if (taut && drawing) context.lineTo(frame.x(t[i]), frame.y(T[i]));
      else if (taut) context.moveTo(frame.x(t[i]), frame.y(T[i]));
      drawing = taut;
    }
    context.stroke();
  }

  /** Shows the time cursor, what is hovered over, and the readings: marks that move over a chart that stays. */
  cursor(t, hover) {
    if (!this.run) return;
    const read = this.run.at(Math.min(hover?.t ?? t, this.run.tEnd));
    for (const part of this.parts) {
      const frame = this.frames.get(part.chart.id);
      const drag = this.drag?.zoom ? this.drag : null;
      const upright = (mark, time) =>
        put(mark, time !== undefined && frame.holdsX(time), frame.x(time), frame.top, 0, frame.height);
      upright(part.upright, t);
      upright(part.hovered, hover?.t);
      const [a, b] = drag ? [frame.x(drag.from), frame.x(drag.to)].sort((one, other) => one - other) : [0, 0];
      put(part.brush, drag !== null, a, frame.top, b - a, frame.height);
      const value = { theta: read.theta, energy: read.energy }[part.chart.id];
      put(part.dot, value !== undefined && frame.holdsX(read.t), frame.x(read.t), frame.y(value));
      const near = part.chart.id === "snaps" && hover?.at?.part === part ? this.nearest(hover.at.x, hover.at.y) : null;
      put(part.ring, near !== null, frame.x(this.run.impacts.t[near]), frame.y(this.run.impacts.v_n[near]));
      const words = near === null ? READ[part.chart.id](this.run, read) : impactWords(this.run, near);
      if (part.reading.value !== words) part.reading.value = words;
    }
  }

  #words(chart, [from, to]) {
    const { run } = this;
    const when = `against time from ${number(from)} to ${number(to)} T`;
    const reach = (columns) =>
      span(columns, 0)
        .map((v) => number(v, 3))
        .join(" to ");
    const tell = {
      theta: () => `from ${reach([run.motion.theta])} rad`,
      snaps: () => `${run.impacts.t.length} snaps, the hardest ${number(run.norms.rho1)} L/T`,
      tensions: () => (run.timeTaut > 0 ? `at most ${number(run.mostTension, 3)} F` : "no cable stays taut"),
      energy: () => `from ${reach([run.motion.energy])} F L`,
    }[chart.id]();
    return `${chart.name} ${when}: ${tell}. The events are in the table below.`;
  }
}

/**
 * A range that stands on zero.
 * @param {number[]} range
 */
const above = ([, high]) => [0, high];

/**
 * The rows that show a range of time: one more on either side, so that lines leave the frame.
 * @param {number[]} t
 * @param {number[]} range
 */
function rows(t, [from, to]) {
  const first = t.findIndex((time) => time > from);
  const last = t.findIndex((time) => time > to);
  return [first < 0 ? Math.max(t.length - 1, 0) : Math.max(first - 1, 0), last < 0 ? t.length : last + 1];
}

/** Puts a mark at a place of its chart, or away. */
function put(mark, there, x, y, width, height) {
  mark.hidden = !there;
  if (!there) return;
  mark.style.transform = `translate(${x}px, ${y}px)`;
  if (width) mark.style.width = `${width}px`;
  if (height) mark.style.height = `${height}px`;
}

export function label(context, colours, text, x, y, angle = 0, font = FONT) {
  context.save();
  context.translate(x, y);
  context.rotate(angle);
  context.font = font;
  context.fillStyle = colours.muted;
  context.textAlign = "center";
  context.fillText(text, 0, 0);
  context.restore();
}
